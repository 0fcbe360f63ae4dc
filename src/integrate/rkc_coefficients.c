/* Runge-Kutta-Chebyshev: coefficients, real stability interval, amplification, stage counts. Pure.
 *
 * w0 > 1, where cos(k arccos w0) does not exist (E20): Chebyshev polynomials and their
 * derivatives come from the three-term recurrence. Section numbers: T = He 2015. */
#include "integrate_impl.h"

#include <math.h>

enum { RKC_STAGES_MAX = 1000 };
static const double damping = 2.0 / 13.0; /* eps of w0 = 1 + eps / s^2 */

/* T_k, T_k', T_k'' at one point and one index before. */
typedef struct chebyshev {
  double x;
  double t, dt, ddt;
  double t_old, dt_old, ddt_old;
} chebyshev;

static chebyshev chebyshev_first(double x) { return (chebyshev){x, x, 1.0, 0.0, 1.0, 0.0, 0.0}; }

static void chebyshev_next(chebyshev *p) {
  double t = 2.0 * p->x * p->t - p->t_old;
  double dt = 2.0 * p->t + 2.0 * p->x * p->dt - p->dt_old;
  double ddt = 4.0 * p->dt + 2.0 * p->x * p->ddt - p->ddt_old;
  *p = (chebyshev){p->x, t, dt, ddt, p->t, p->dt, p->ddt};
}

static chebyshev chebyshev_at(int32_t s, double x) {
  chebyshev p = chebyshev_first(x);
  for (int32_t k = 2; k <= s; ++k) chebyshev_next(&p);
  return p;
}

static double w0_of(int32_t s) { return 1.0 + damping / ((double)s * (double)s); }

static double w1_of(int32_t s) {
  chebyshev p = chebyshev_at(s, w0_of(s));
  return p.dt / p.ddt;
}

static int32_t stages_known(int32_t s) { return s >= 2 && s <= RKC_STAGES_MAX; }

/* ---- coefficients ------------------------------------------------------------------------ */

typedef struct rkc_row {
  double mu, nu, mu_t, gamma_t, c;
} rkc_row;

typedef struct rkc_arrays {
  double *mu, *nu, *mu_t, *gamma_t, *c;
} rkc_arrays;

static void put(double *array, int32_t k, double value) {
  if (array) array[k] = value;
}

static void put_row(const rkc_arrays *out, int32_t k, rkc_row row) {
  put(out->mu, k, row.mu);
  put(out->nu, k, row.nu);
  put(out->mu_t, k, row.mu_t);
  put(out->gamma_t, k, row.gamma_t);
  put(out->c, k, row.c);
}

/* b[0], b[1], b[2] = b_{k-2}, b_{k-1}, b_k; T_{k-1}(w0) = p->t_old. The minus sign of gamma~ is
 * mandatory (E18). */
static rkc_row stage_row(const chebyshev *p, const double b[3], double w1) {
  double mu_t = 2.0 * w1 * b[2] / b[1];
  rkc_row row = {2.0 * p->x * b[2] / b[1], -b[2] / b[0], mu_t, -(1.0 - b[1] * p->t_old) * mu_t,
                 w1 * p->ddt / p->dt};
  return row;
}

static void fill_rows(int32_t s, int32_t b1, const rkc_arrays *out) {
  double w0 = w0_of(s), w1 = w1_of(s);
  chebyshev p = chebyshev_first(w0);
  double b_2 = 1.0 / (4.0 * w0 * w0); /* T_2'' / T_2'^2, and b_0 */
  double b_1 = b1 == SPH_RKC_B1_INVERSE_W0 ? 1.0 / w0 : b_2;
  double b[3] = {0.0, b_2, b_1};
  put_row(out, 0, (rkc_row){0.0, 0.0, 0.0, 0.0, 0.0});
  put_row(out, 1, (rkc_row){0.0, 0.0, b_1 * w1, 0.0, b_1 * w1});
  for (int32_t k = 2; k <= s; ++k) {
    chebyshev_next(&p);
    b[0] = b[1];
    b[1] = b[2];
    b[2] = p.ddt / (p.dt * p.dt);
    put_row(out, k, stage_row(&p, b, w1));
  }
  put(out->c, s, 1.0); /* by the choice of w1; exact, so that the last stage ends the step */
}

sph_status sph_rkc_coefficients(int32_t s, int32_t b1, double *mu, double *nu, double *mu_t,
                                double *gamma_t, double *c) {
  if (!stages_known(s)) return SPH_ERR_ARG;
  if (b1 != SPH_RKC_B1_INVERSE_W0 && b1 != SPH_RKC_B1_EQUAL_B2) return SPH_ERR_ARG;
  rkc_arrays out = {mu, nu, mu_t, gamma_t, c};
  fill_rows(s, b1, &out);
  return SPH_OK;
}

/* ---- stability --------------------------------------------------------------------------- */

double sph_rkc_beta(int32_t s) {
  if (!stages_known(s)) return NAN;
  return (w0_of(s) + 1.0) / w1_of(s);
}

/* T_s at a complex point, by the recurrence in real and imaginary parts. */
static void chebyshev_complex(int32_t s, double xr, double xi, double *tr, double *ti) {
  double r0 = 1.0, i0 = 0.0, r1 = xr, i1 = xi;
  for (int32_t k = 2; k <= s; ++k) {
    double r2 = 2.0 * (xr * r1 - xi * i1) - r0;
    double i2 = 2.0 * (xr * i1 + xi * r1) - i0;
    r0 = r1;
    i0 = i1;
    r1 = r2;
    i1 = i2;
  }
  *tr = r1;
  *ti = i1;
}

/* P_s(z) = 1 - b_s T_s(w0) + b_s T_s(w0 + w1 z) */
double sph_rkc_amplification(int32_t s, double re, double im) {
  if (!stages_known(s)) return NAN;
  double w0 = w0_of(s), tr, ti;
  chebyshev p = chebyshev_at(s, w0);
  double w1 = p.dt / p.ddt, b = p.ddt / (p.dt * p.dt);
  chebyshev_complex(s, w0 + w1 * re, w1 * im, &tr, &ti);
  return hypot(1.0 - b * p.t + b * tr, b * ti);
}

/* ---- stage counts ------------------------------------------------------------------------ */

static int32_t not_negative(double x) { return isfinite(x) && x >= 0.0; }

/* s = 1 + floor(sqrt(1 + load)) */
static int32_t stages_for(double load) {
  double s = 1.0 + floor(sqrt(1.0 + load));
  return s <= 2147483647.0 ? (int32_t)s : -1; /* NaN and infinity also fail the comparison */
}

int32_t sph_rkc_stages_cfl(double dt, double wave_speed, double spacing) {
  if (!not_negative(dt) || !not_negative(wave_speed)) return -1;
  if (!isfinite(spacing) || spacing <= 0.0) return -1;
  return stages_for(dt * wave_speed / (0.131 * spacing));
}

int32_t sph_rkc_stages_radius(double dt, double radius) {
  if (!not_negative(dt) || !not_negative(radius)) return -1;
  return stages_for(dt * radius / 0.653);
}
