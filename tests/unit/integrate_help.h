/* What the integrator tests share: contexts, integrators of each method, a log that counts. */
#ifndef SPH_TESTS_INTEGRATE_HELP_H
#define SPH_TESTS_INTEGRATE_HELP_H

#include "check.h"

#include <sph/context.h>
#include <sph/integrator.h>
#include <sph/particles.h>

typedef struct log_book {
  int warnings;
  char last[512];
} log_book;

static CHECK_UNUSED log_book book;

static CHECK_UNUSED void note(void *user, int32_t level, const char *text) {
  (void)user;
  if (level != SPH_LOG_WARNING) return;
  ++book.warnings;
  snprintf(book.last, sizeof book.last, "%s", text);
}

static CHECK_UNUSED sph_context *context_with(int32_t threads) {
  sph_context_options o;
  sph_context *ctx = NULL;
  sph_context_options_init(&o);
  o.threads = threads;
  o.log = note;
  memset(&book, 0, sizeof book);
  check_ok(sph_context_create(&o, &ctx));
  return ctx;
}

static CHECK_UNUSED sph_integrator_options method_options(int32_t method) {
  sph_integrator_options o;
  sph_integrator_options_init(&o);
  o.method = method;
  o.stability_check_interval = 0;
  if (method != SPH_INTEGRATOR_RKC) return o;
  o.stage_rule = SPH_STAGES_FIXED;
  o.stages = 3;
  return o;
}

/* Fehlberg's 2(3): three stages, b of order 2, b_low of order 3. */
static const double fehlberg_a[] = {0, 0, 0, 1, 0, 0, 0.25, 0.25, 0};
static const double fehlberg_b[] = {0.5, 0.5, 0};
static const double fehlberg_low[] = {1.0 / 6, 1.0 / 6, 4.0 / 6};

static CHECK_UNUSED sph_integrator *make_with(sph_context *ctx, sph_integrator_options o) {
  sph_integrator *it = NULL;
  if (o.method == SPH_INTEGRATOR_BUTCHER && !o.butcher_a) {
    o.butcher_stages = 3;
    o.butcher_a = fehlberg_a;
    o.butcher_b = fehlberg_b;
    o.butcher_b_low = fehlberg_low;
  }
  check_ok(sph_integrator_create(ctx, &o, &it));
  return it;
}

static CHECK_UNUSED sph_integrator *make(sph_context *ctx, int32_t method) {
  return make_with(ctx, method_options(method));
}

/* u = exp(sin t), v = cos t, w = 1 / (1 + t): nonlinear, coupled, depends on t. */
static CHECK_UNUSED int32_t smooth_system(void *user, double t, sph_particles *set,
                                          const sph_rate *rates, int32_t count) {
  const double *y = (const double *)user;
  double *f = rates[0].values, e = exp(sin(t));
  (void)set;
  (void)count;
  f[0] = y[0] * y[1];
  f[1] = -sin(t) + 0.5 * (y[0] * y[0] - e * e);
  f[2] = -y[2] * y[2] * y[0] / e + 0.3 * (y[1] - cos(t));
  return 0;
}

static CHECK_UNUSED void smooth_solution(double t, double *y) {
  y[0] = exp(sin(t));
  y[1] = cos(t);
  y[2] = 1.0 / (1.0 + t);
}

/* A set of n particles in `dim` dimensions with X and V filled from the index. */
static CHECK_UNUSED sph_particles *make_set(sph_context *ctx, int32_t dim, int64_t n) {
  sph_particles_options o;
  sph_particles *set = NULL;
  double *x, *v;
  sph_particles_options_init(&o);
  o.dim = dim;
  check_ok(sph_particles_create(ctx, &o, &set));
  check_ok(sph_particles_add(set, n, NULL));
  check_ok(sph_particles_field(set, SPH_FIELD_X, &x));
  check_ok(sph_particles_field(set, SPH_FIELD_V, &v));
  for (int64_t i = 0; i < n * dim; ++i) {
    x[i] = 1.0 + 0.37 * sin(1.7 * (double)i);
    v[i] = 0.3 * cos(0.9 * (double)i);
  }
  return set;
}

/* x' = v + drag of position, v' = -sin x - 0.1 v, others: y' = -y + cos t. Works for any binding.
 */
static CHECK_UNUSED int32_t pendulum(void *user, double t, sph_particles *set,
                                     const sph_rate *rates, int32_t count) {
  const double *x = sph_particles_field_const(set, SPH_FIELD_X);
  const double *v = sph_particles_field_const(set, SPH_FIELD_V);
  double drag = user ? *(const double *)user : 0.0;
  for (int32_t k = 0; k < count; ++k) {
    int32_t field = rates[k].field;
    const double *y = sph_particles_field_const(set, field);
    int64_t n = sph_particles_real_count(set) * sph_particles_components(set, field);
    for (int64_t i = 0; i < n; ++i) {
      if (field == SPH_FIELD_X)
        rates[k].values[i] = v[i];
      else if (field == SPH_FIELD_V)
        rates[k].values[i] = -sin(x[i]) - drag * v[i];
      else
        rates[k].values[i] = -y[i] + cos(t) + 0.1 * v[0];
    }
  }
  return 0;
}

/* Everything depends on everything; the rate of X has an XSPH-like part. */
static CHECK_UNUSED int32_t tangle(void *user, double t, sph_particles *set, const sph_rate *rates,
                                   int32_t count) {
  double x = sph_particles_field_const(set, SPH_FIELD_X)[0];
  double v = sph_particles_field_const(set, SPH_FIELD_V)[0], e = 0.7;
  (void)user;
  if (count == 3) e = sph_particles_field_const(set, SPH_FIELD_E)[0];
  for (int32_t k = 0; k < count; ++k) {
    double *f = rates[k].values;
    if (rates[k].field == SPH_FIELD_X)
      f[0] = v + 0.3 * sin(x + t);
    else if (rates[k].field == SPH_FIELD_V)
      f[0] = -e * sin(x) - 0.4 * v * v + cos(2.0 * t);
    else
      f[0] = -0.5 * e * v + 0.1 * x * x + 0.2 * sin(t);
  }
  return 0;
}

/* To t = 2; neighbouring steps differ by the factors 1 + uneven and 1 - uneven. */
static CHECK_UNUSED void run_tangle(sph_context *ctx, int32_t method, int others, int steps,
                                    double uneven, double *out) {
  static const int32_t field[] = {SPH_FIELD_X, SPH_FIELD_V, SPH_FIELD_E};
  sph_particles *set = make_set(ctx, 1, 1);
  sph_integrator *it = make(ctx, method);
  double *y[3] = {NULL, NULL, NULL};
  for (int k = 0; k < 2 + others; ++k) {
    check_ok(sph_particles_field(set, field[k], &y[k]));
    check_ok(sph_integrator_bind_field(it, field[k]));
    y[k][0] = 0.5 + 0.2 * k;
  }
  check_ok(sph_integrator_set_function(it, tangle, NULL));
  double t = 0.0;
  for (int n = 0; n < steps; ++n) {
    double dt = 2.0 / steps * (n % 2 ? 1.0 + uneven : 1.0 - uneven);
    check_ok(sph_integrator_step(it, set, t, dt, NULL));
    t += dt;
  }
  for (int k = 0; k < 2 + others; ++k) out[k] = y[k][0];
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
}

#endif
