/* Return mappings of the yield criterion of von Mises: Simo, Hughes, Computational Inelasticity,
 * 1998, boxes 3.2 (radial) and 3.3 (plane stress). */
#include "plastic.h"

#include <math.h>
#include <sph/elastic.h>
#include <stddef.h>

/* What one particle accumulates; entries are NULL where nobody asks. */
typedef struct history {
  double *strain, *work;
} history;

static history history_at(double *strain, double *work, int64_t i) {
  return (history){strain != NULL ? strain + i : NULL, work != NULL ? work + i : NULL};
}

static double yield_now(const sphi_plastic *p, history h) {
  return h.strain != NULL ? p->yield + p->hardening * *h.strain : p->yield;
}

/* `y` is the yield stress before. Returns that after. */
static double accumulate(const sphi_plastic *p, history h, double y, double strain) {
  const double after = y + p->hardening * strain;
  if (h.strain != NULL) *h.strain += strain;
  if (h.work != NULL) *h.work += 0.5 * (y + after) * strain;
  return after;
}

/* The factor for a deviator of equivalent stress q; `modulus` is 3G, or E in uniaxial stress. */
static double radial(const sphi_plastic *p, double q, double modulus, history h) {
  const double y = yield_now(p, h);
  if (!(q > y)) return 1;
  return accumulate(p, h, y, (q - y) / (modulus + p->hardening)) / q;
}

/* ---- deviators ---- */

double sphi_deviator_square(int32_t dim, const double *s) {
  if (dim == 1) return 1.5 * s[0] * s[0];
  if (dim == 2) return s[0] * s[0] + s[1] * s[1] + (s[0] + s[1]) * (s[0] + s[1]) + 2 * s[2] * s[2];
  return s[0] * s[0] + s[1] * s[1] + s[2] * s[2] + 2 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]);
}

void sphi_plastic_return_deviator(const sphi_plastic *p, int32_t dim, int64_t n, double *deviator,
                                  double *plastic_strain, double *plastic_work) {
  const int32_t comps = dim * (dim + 1) / 2;
  for (int64_t i = 0; i < n; i++) {
    double *s = deviator + i * comps, q = sqrt(1.5 * sphi_deviator_square(dim, s));
    double factor = radial(p, q, 3 * p->shear, history_at(plastic_strain, plastic_work, i));
    for (int32_t c = 0; c < comps && factor < 1; c++) s[c] *= factor;
  }
}

/* ---- whole stresses ---- */

/* All 3x3: the stress across is state; in 3-D there is none. */
static void return_solid(const sphi_plastic *p, int32_t dim, double *s, double *across, history h) {
  const double aside = dim < 3 ? *across : 0;
  double trace = (3 - dim) * aside, square = 0;
  for (int32_t a = 0; a < dim; a++) trace += s[a];
  const double mean = trace / 3;
  for (int32_t c = 0; c < dim * (dim + 1) / 2; c++)
    square += c < dim ? (s[c] - mean) * (s[c] - mean) : 2 * s[c] * s[c];
  square += (3 - dim) * (aside - mean) * (aside - mean);
  const double factor = radial(p, sqrt(1.5 * square), 3 * p->shear, h);
  if (!(factor < 1)) return;
  for (int32_t a = 0; a < dim; a++) s[a] = mean + factor * (s[a] - mean);
  for (int32_t c = dim; c < dim * (dim + 1) / 2; c++) s[c] *= factor;
  if (dim < 3) *across = mean + factor * (aside - mean);
}

/* q = sqrt(A/u^2 + B/v^2), u = 1 + alpha x, v = 1 + beta x, equals yield + H (strain + 2/3 x q).
 * Their difference is convex and falls while it is positive: Newton's method from 0 rises to the
 * root and never passes it. */
static double multiplier(const sphi_plastic *p, double a, double alpha, double b, double beta,
                         double y) {
  enum { STEPS = 2000 }; /* it doubles u at least, over the range of doubles */
  double x = 0;
  for (int step = 0; step < STEPS; step++) {
    const double u = 1 + alpha * x, v = 1 + beta * x, q = sqrt(a / (u * u) + b / (v * v));
    const double dq = -(a * alpha / (u * u * u) + b * beta / (v * v * v)) / q;
    const double rest = 1 - 2.0 / 3 * p->hardening * x;
    const double next = x + (q * rest - y) / (2.0 / 3 * p->hardening * q - dq * rest);
    if (!(next > x)) break;
    x = next;
  }
  return x;
}

static void return_plane_stress(const sphi_plastic *p, double *s, history h) {
  const double sum = s[0] + s[1], difference = s[0] - s[1], y = yield_now(p, h);
  const double a = 0.25 * sum * sum, b = 0.75 * difference * difference + 3 * s[2] * s[2];
  const double alpha = p->young / (3 * (1 - p->poisson)), beta = 2 * p->shear;
  if (!(a + b > y * y)) return;
  const double x = multiplier(p, a, alpha, b, beta, y);
  const double u = 1 + alpha * x, v = 1 + beta * x;
  s[0] = 0.5 * (sum / u + difference / v);
  s[1] = 0.5 * (sum / u - difference / v);
  s[2] /= v;
  (void)accumulate(p, h, y, 2.0 / 3 * x * sqrt(a / (u * u) + b / (v * v)));
}

void sphi_plastic_return(const sphi_plastic *p, int32_t reduction, int64_t n, double *sigma,
                         double *across, double *plastic_strain, double *plastic_work) {
  for (int64_t i = 0; i < n; i++) {
    const history h = history_at(plastic_strain, plastic_work, i);
    double *aside = across != NULL ? across + i : NULL;
    if (reduction == SPH_UNIAXIAL_STRESS)
      sigma[i] *= radial(p, fabs(sigma[i]), p->young, h);
    else if (reduction == SPH_UNIAXIAL_STRAIN)
      return_solid(p, 1, sigma + i, aside, h);
    else if (reduction == SPH_PLANE_STRESS)
      return_plane_stress(p, sigma + 3 * i, h);
    else if (reduction == SPH_PLANE_STRAIN)
      return_solid(p, 2, sigma + 3 * i, aside, h);
    else
      return_solid(p, 3, sigma + 6 * i, NULL, h);
  }
}
