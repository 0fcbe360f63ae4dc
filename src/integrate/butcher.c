/* One driver for every explicit Runge-Kutta method (T 4.15, with one dt: E17), the built-in
 * tableaux, order conditions and the stability polynomial. */
#include "integrate_impl.h"

#include <math.h>

/* ---- built-in tableaux ------------------------------------------------------------------- */

static const double one[] = {1.0};
static const double zero4[] = {0.0, 0.0, 0.0, 0.0};

/* T 4.5: U_h = U + dt/2 F(U), U_c = U + dt/2 F(U_h), U+ = 2 U_c - U, which is the explicit
 * midpoint rule. The embedded method is Euler. */
static const double pc2_a[] = {0.0, 0.0, 0.5, 0.0};
static const double pc2_b[] = {0.0, 1.0};
static const double pc2_c[] = {0.0, 0.5};
static const double euler_low[] = {1.0, 0.0};

/* T 4.12 */
static const double heun_a[] = {0.0, 0.0, 1.0, 0.0};
static const double heun_b[] = {0.5, 0.5};
static const double heun_c[] = {0.0, 1.0};

/* Shu and Osher's three convex Euler steps, multiplied out. The embedded method is Heun. */
static const double ssp3_a[] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.25, 0.25, 0.0};
static const double ssp3_b[] = {1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0};
static const double ssp3_c[] = {0.0, 1.0, 0.5};
static const double ssp3_low[] = {0.5, 0.5, 0.0};

/* T 4.13 */
static const double rk4_a[] = {0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0,
                               0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0};
static const double rk4_b[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
static const double rk4_c[] = {0.0, 0.5, 0.5, 1.0};

/* T table 4.2 */
static const double rk38_a[] = {0.0,        0.0, 0.0, 0.0, 1.0 / 3.0, 0.0,  0.0, 0.0,
                                -1.0 / 3.0, 1.0, 0.0, 0.0, 1.0,       -1.0, 1.0, 0.0};
static const double rk38_b[] = {0.125, 0.375, 0.375, 0.125};
static const double rk38_c[] = {0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0};

int32_t sphi_butcher_builtin(int32_t method, sphi_tableau *tableau) {
  switch (method) {
  case SPH_INTEGRATOR_EULER:
    *tableau = (sphi_tableau){1, zero4, one, zero4, NULL, 0};
    return 1;
  case SPH_INTEGRATOR_PC2:
    *tableau = (sphi_tableau){2, pc2_a, pc2_b, pc2_c, euler_low, 0};
    return 1;
  case SPH_INTEGRATOR_HEUN:
    *tableau = (sphi_tableau){2, heun_a, heun_b, heun_c, euler_low, 0};
    return 1;
  case SPH_INTEGRATOR_SSPRK3:
    *tableau = (sphi_tableau){3, ssp3_a, ssp3_b, ssp3_c, ssp3_low, 0};
    return 1;
  case SPH_INTEGRATOR_RK4:
    *tableau = (sphi_tableau){4, rk4_a, rk4_b, rk4_c, NULL, 0};
    return 1;
  case SPH_INTEGRATOR_RK38:
    *tableau = (sphi_tableau){4, rk38_a, rk38_b, rk38_c, NULL, 0};
    return 1;
  default:
    return 0;
  }
}

/* ---- order conditions -------------------------------------------------------------------- */

static double dot(int32_t s, const double *x, const double *y) {
  double sum = 0.0;
  for (int32_t i = 0; i < s; ++i) sum += x[i] * y[i];
  return sum;
}

static void multiply(int32_t s, const double *a, const double *x, double *y) {
  for (int32_t i = 0; i < s; ++i) y[i] = dot(s, a + i * s, x);
}

static int32_t near(double x, double y) { return fabs(x - y) <= 1e-10; }

/* The eight conditions through order 4, one for each rooted tree. */
int32_t sphi_butcher_order(const sphi_tableau *tableau, const double *b) {
  int32_t s = tableau->s;
  const double *a = tableau->a, *c = tableau->c;
  double c2[SPHI_STAGES_MAX] = {0.0}, c3[SPHI_STAGES_MAX], cac[SPHI_STAGES_MAX];
  double ac[SPHI_STAGES_MAX], ac2[SPHI_STAGES_MAX], aac[SPHI_STAGES_MAX], sum = 0.0;
  multiply(s, a, c, ac);
  multiply(s, a, ac, aac);
  for (int32_t i = 0; i < s; ++i) {
    sum += b[i];
    c2[i] = c[i] * c[i];
    c3[i] = c2[i] * c[i];
    cac[i] = c[i] * ac[i];
  }
  multiply(s, a, c2, ac2);
  if (!near(sum, 1.0)) return 0;
  if (!near(dot(s, b, c), 1.0 / 2.0)) return 1;
  if (!near(dot(s, b, c2), 1.0 / 3.0) || !near(dot(s, b, ac), 1.0 / 6.0)) return 2;
  if (!near(dot(s, b, c3), 1.0 / 4.0) || !near(dot(s, b, cac), 1.0 / 8.0)) return 3;
  if (!near(dot(s, b, ac2), 1.0 / 12.0) || !near(dot(s, b, aac), 1.0 / 24.0)) return 3;
  return 4;
}

/* ---- stability polynomial ---------------------------------------------------------------- */

/* k_i = z (1 + sum a_ij k_j), P = 1 + sum b_i k_i, in real arithmetic. */
double sphi_butcher_amplification(const sphi_tableau *tableau, double re, double im) {
  double kr[SPHI_STAGES_MAX], ki[SPHI_STAGES_MAX];
  int32_t s = tableau->s;
  for (int32_t i = 0; i < s; ++i) {
    double yr = 1.0 + dot(i, tableau->a + i * s, kr);
    double yi = dot(i, tableau->a + i * s, ki);
    kr[i] = re * yr - im * yi;
    ki[i] = re * yi + im * yr;
  }
  return hypot(1.0 + dot(s, tableau->b, kr), dot(s, tableau->b, ki));
}

/* ---- the step ---------------------------------------------------------------------------- */

/* U + dt sum weight_j k_j */
static sphi_combination stage(const sphi_step *step, int32_t count, const double *weight) {
  sphi_combination c = {0, {0.0}, {NULL}};
  sphi_combination_add(&c, 1.0, sphi_vector(step->it, SPHI_VEC_START));
  for (int32_t j = 0; j < count; ++j)
    sphi_combination_add(&c, step->dt * weight[j], sphi_vector(step->it, SPHI_VEC_RATE + j));
  return c;
}

/* dt sum (b_j - b_low_j) k_j, left in the first rate, which is done with. */
static void estimate_error(sphi_step *step) {
  sph_integrator *it = step->it;
  const sphi_tableau *tab = &it->tableau;
  double *error = sphi_vector(it, SPHI_VEC_RATE);
  sphi_combination c = {0, {0.0}, {NULL}};
  if (!step->has_info || !tab->b_low) return;
  for (int32_t j = 0; j < tab->s; ++j)
    sphi_combination_add(&c, step->dt * (tab->b[j] - tab->b_low[j]),
                         sphi_vector(it, SPHI_VEC_RATE + j));
  sphi_state_combine(it, error, &c);
  step->info->error = sphi_error_norm(it, error);
  step->info->suggested_dt = sphi_suggest(step->dt, step->info->error, tab->low_order);
}

/* The first stage is the state as it stands: nothing is written, no list is disturbed. */
static sph_status first_rate(sphi_step *step) {
  sph_integrator *it = step->it;
  double *f0 = sphi_vector(it, SPHI_VEC_RATE);
  sph_status status = sphi_evaluate(it, step->set, step->t, f0);
  return status == SPH_OK ? sphi_stability_watch(step, f0, it->tableau.s) : status;
}

sph_status sphi_butcher_step(sphi_step *step) {
  sph_integrator *it = step->it;
  const sphi_tableau *tab = &it->tableau;
  sph_status status = first_rate(step);
  for (int32_t i = 1; i < tab->s && status == SPH_OK; ++i) {
    sphi_combination c = stage(step, i, tab->a + i * tab->s);
    const double t = step->t + tab->c[i] * step->dt;
    status = sphi_write_stage(step, &c, t, SPH_COPY_STAGE);
    if (status == SPH_OK)
      status = sphi_evaluate(it, step->set, t, sphi_vector(it, SPHI_VEC_RATE + i));
  }
  if (status != SPH_OK) return status;
  sphi_combination c = stage(step, tab->s, tab->b);
  status = sphi_write_stage(step, &c, step->t + step->dt, SPH_COPY_RESULT);
  if (status != SPH_OK) return status;
  estimate_error(step);
  step->info->stages = tab->s;
  return SPH_OK;
}
