/* Stage rules of RKC, the power iteration behind them, and the warning on leaving the stable
 * range. */
#include "integrate_help.h"

enum { CELLS = 400 };

/* A bar of magnesium by central differences, in SI units: stress 1e7, velocity 1; eigenvalues
 * +-i c/dp sin(k), and down to -4 nu c/dp from the viscosity nu. */
typedef struct bar {
  double v[CELLS], stress[CELLS];
  double nu;
  int calls;
} bar;
static const double young = 45e9, density = 1738.0, spacing = 0.004;
static double wave_speed(void) { return sqrt(young / density); }

static int32_t bar_rates(void *user, double t, sph_particles *set, const sph_rate *rates,
                         int32_t count) {
  bar *b = (bar *)user;
  (void)t;
  (void)set;
  (void)count;
  ++b->calls;
  for (int i = 0; i < CELLS; ++i) {
    double vl = i > 0 ? b->v[i - 1] : b->v[i], vr = i < CELLS - 1 ? b->v[i + 1] : 0.0;
    double sl = i > 0 ? b->stress[i - 1] : -8.8e6;
    double sr = i < CELLS - 1 ? b->stress[i + 1] : b->stress[i];
    rates[0].values[i] = (sr - sl) / (2.0 * spacing * density) +
                         b->nu * wave_speed() / spacing * (vl - 2.0 * b->v[i] + vr);
    rates[1].values[i] = young * (vr - vl) / (2.0 * spacing);
  }
  return 0;
}

static sph_integrator *bar_integrator(sph_context *ctx, bar *b, sph_integrator_options o) {
  sph_integrator *it = make_with(ctx, o);
  check_ok(sph_integrator_bind_array(it, b->v, CELLS));
  check_ok(sph_integrator_bind_array(it, b->stress, CELLS));
  check_ok(sph_integrator_set_function(it, bar_rates, b));
  return it;
}

static sph_step_info fresh_info(void) {
  sph_step_info info;
  sph_step_info_init(&info);
  return info;
}

/* y' = A y, n at most 8, row-major. */
typedef struct matrix {
  int n;
  const double *a;
  double y[8];
} matrix;

static int32_t matrix_rates(void *user, double t, sph_particles *set, const sph_rate *rates,
                            int32_t count) {
  const matrix *m = (const matrix *)user;
  (void)t;
  (void)set;
  (void)count;
  for (int i = 0; i < m->n; ++i) {
    double sum = 0.0;
    for (int j = 0; j < m->n; ++j) sum += m->a[i * m->n + j] * m->y[j];
    rates[0].values[i] = sum;
  }
  return 0;
}

static sph_integrator_options power_options(void) {
  sph_integrator_options o = method_options(SPH_INTEGRATOR_RKC);
  o.stage_rule = SPH_STAGES_POWER;
  o.power_safety = 1.0;
  return o;
}

/* ---- known spectra ----------------------------------------------------------------------- */

static void check_matrix(int n, const double *a, double re, double im, double tolerance) {
  sph_context *ctx = context_with(1);
  matrix m = {n, a, {1, 2, 3, 4, 5, 6, 7, 8}};
  sph_step_info info = fresh_info();
  sph_integrator *it = make_with(ctx, power_options());
  double radius = hypot(re, im);
  check_ok(sph_integrator_bind_array(it, m.y, n));
  check_ok(sph_integrator_set_function(it, matrix_rates, &m));
  check_ok(sph_integrator_step(it, NULL, 0.0, 0.1 / radius, &info));
  check_close(info.radius, radius, tolerance * radius);
  check_close(info.eigen_re, re, tolerance * radius);
  check_close(info.eigen_im, im, tolerance * radius);
  assert_true(info.evaluations <= info.stages + 50);
  sph_integrator_destroy(it);
  sph_context_destroy(ctx);
}

static void test_known_matrices(void **state) {
  static const double real[] = {-7, 0, 0, 0, -3, 0, 0, 0, -1};
  static const double rotation[] = {0, 40, -40, 0};
  static const double units[] = {0, 1, -1e6, 0};
  static const double spiral[] = {-3, 5, 0, -5, -3, 0, 0, 0, -2};
  static const double nonnormal[] = {-1, 1000, 0, 0, -2, 1000, 0, 0, -3};
  static const double jordan[] = {-2, 1, 0, -2};
  static const double growing[] = {5, 1, 0, -1};
  static const double opposite[] = {4, 0, 0, -4};
  (void)state;
  check_matrix(3, real, -7, 0, 0.01);
  check_matrix(2, rotation, 0, 40, 0.01);
  check_matrix(2, units, 0, 1000, 0.01); /* x' = v, v' = -1e6 x: badly scaled */
  check_matrix(3, spiral, -3, 5, 0.01);
  check_matrix(3, nonnormal, -3, 0, 0.02);
  check_matrix(2, jordan, -2, 0, 0.2); /* defective: slow by nature */
  check_matrix(2, growing, 5, 0, 0.01);
  check_matrix(2, opposite, 4, 0, 1.0); /* +4 and -4: the radius is what counts, see below */
}

/* Two real eigenvalues of equal size and opposite sign still give the radius. */
static void test_opposite_pair(void **state) {
  static const double opposite[] = {4, 0, 0, -4};
  sph_context *ctx = context_with(1);
  matrix m = {2, opposite, {1, 2}};
  sph_step_info info = fresh_info();
  sph_integrator *it = make_with(ctx, power_options());
  (void)state;
  check_ok(sph_integrator_bind_array(it, m.y, 2));
  check_ok(sph_integrator_set_function(it, matrix_rates, &m));
  check_ok(sph_integrator_step(it, NULL, 0.0, 0.1, &info));
  check_rel(info.radius, 4.0, 0.01);
  sph_integrator_destroy(it);
  sph_context_destroy(ctx);
}

static int32_t constant(void *user, double t, sph_particles *set, const sph_rate *rates,
                        int32_t count) {
  (void)user;
  (void)t;
  (void)set;
  (void)count;
  rates[0].values[0] = 2.0;
  return 0;
}

static int32_t cubic(void *user, double t, sph_particles *set, const sph_rate *rates,
                     int32_t count) {
  double y = *(const double *)user;
  (void)t;
  (void)set;
  (void)count;
  rates[0].values[0] = -y * y * y;
  return 0;
}

static void test_scalars(void **state) {
  static const sph_rhs_fn fn[] = {constant, cubic, cubic};
  static const double start[] = {1.0, 2.0, 0.0}, radius[] = {0.0, 12.0, 0.0};
  sph_context *ctx = context_with(1);
  (void)state;
  for (int k = 0; k < 3; ++k) {
    double y = start[k];
    sph_step_info info = fresh_info();
    sph_integrator *it = make_with(ctx, power_options());
    check_ok(sph_integrator_bind_array(it, &y, 1));
    check_ok(sph_integrator_set_function(it, fn[k], &y));
    check_ok(sph_integrator_step(it, NULL, 0.0, 0.1, &info));
    check_close(info.radius, radius[k], 1e-6 * (1.0 + radius[k]));
    sph_integrator_destroy(it);
  }
  sph_context_destroy(ctx);
}

static int32_t nothing(void *user, double t, sph_particles *set, const sph_rate *rates,
                       int32_t count) {
  (void)user;
  (void)t;
  (void)set;
  (void)rates;
  (void)count;
  return 0;
}

static void test_empty_state(void **state) {
  sph_context *ctx = context_with(1);
  double y = 7.0;
  sph_step_info info = fresh_info();
  sph_integrator *it = make_with(ctx, power_options());
  (void)state;
  check_ok(sph_integrator_bind_array(it, &y, 0));
  check_ok(sph_integrator_set_function(it, nothing, NULL));
  check_ok(sph_integrator_step(it, NULL, 0.0, 0.1, &info));
  assert_int_equal(info.stages, 2);
  assert_true(y == 7.0);
  sph_integrator_destroy(it);
  sph_context_destroy(ctx);
}

/* From rest, where the stress has no size yet: wave, mixed and viscous spectra. */
static void test_bar_spectra(void **state) {
  static const double nu[] = {0.0, 0.1, 1.0, 2.0};
  static const double radius[] = {1.0, 0.995, 3.93, 7.93};
  (void)state;
  for (int k = 0; k < 4; ++k) {
    sph_context *ctx = context_with(1);
    bar b = {{0}, {0}, nu[k], 0};
    sph_step_info info = fresh_info();
    double unit = wave_speed() / spacing;
    sph_integrator *it = bar_integrator(ctx, &b, power_options());
    for (int n = 0; n < 60; ++n) check_ok(sph_integrator_step(it, NULL, 0.0, 0.1 / unit, &info));
    check_rel(info.radius, radius[k] * unit, 0.04);
    assert_true((info.eigen_im > 0.9 * unit) == (k < 2));
    sph_integrator_destroy(it);
    sph_context_destroy(ctx);
  }
}

/* ---- how many, how often ----------------------------------------------------------------- */

static void test_power_runs_stable(void **state) {
  sph_context *ctx = context_with(1);
  bar b = {{0}, {0}, 2.5, 0};
  sph_integrator_options o = power_options();
  sph_step_info info = fresh_info();
  double dt = 2.0 * spacing / wave_speed(), largest = 0.0;
  (void)state;
  o.power_safety = 1.1;
  sph_integrator *it = bar_integrator(ctx, &b, o);
  for (int n = 0; n < 150; ++n) check_ok(sph_integrator_step(it, NULL, n * dt, dt, &info));
  for (int i = 0; i < CELLS; ++i) largest = fmax(largest, fabs(b.v[i]));
  assert_true(largest > 0.9 && largest < 1.05); /* the step of 1 m/s that the load makes */
  assert_int_equal(info.stages, sph_rkc_stages_radius(dt, info.radius));
  assert_true(info.stages >= 6 && info.stages <= 7);
  assert_int_equal(book.warnings, 0);
  sph_integrator_destroy(it);
  sph_context_destroy(ctx);
}

/* Steps 0, 1, 3, 7, and from then on every fourth. */
static void test_interval(void **state) {
  static const int due[12] = {1, 1, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  sph_context *ctx = context_with(1);
  bar b = {{0}, {0}, 1.0, 0};
  sph_integrator_options o = power_options();
  (void)state;
  o.power_interval = 4;
  o.power_iterations = 12;
  sph_integrator *it = bar_integrator(ctx, &b, o);
  for (int n = 0; n < 12; ++n) {
    sph_step_info info = fresh_info();
    int before = b.calls;
    check_ok(sph_integrator_step(it, NULL, 0.0, 1e-7, &info));
    assert_int_equal(info.evaluations, b.calls - before);
    int64_t extra = info.evaluations - info.stages;
    assert_true(due[n] ? extra >= 3 && extra <= 12 : extra == 0);
  }
  sph_integrator_destroy(it);
  sph_context_destroy(ctx);
}

static double radius_answer;
static double host_radius(void *user, double t, sph_particles *set) {
  (void)user;
  (void)t;
  (void)set;
  return radius_answer;
}

static void test_radius_rule(void **state) {
  sph_context *ctx = context_with(1);
  bar b = {{0}, {0}, 1.0, 0}, start = b;
  sph_integrator_options o = method_options(SPH_INTEGRATOR_RKC);
  sph_step_info info = fresh_info();
  (void)state;
  o.stage_rule = SPH_STAGES_RADIUS;
  o.radius = host_radius;
  o.max_stages = 10;
  sph_integrator *it = bar_integrator(ctx, &b, o);
  radius_answer = 0.653 * 24.5 / 1e-8; /* between 5 and 6 stages' squares */
  check_ok(sph_integrator_step(it, NULL, 0.0, 1e-8, &info));
  assert_int_equal(info.stages, 6);
  assert_int_equal(info.evaluations, 6);
  check_rel(info.radius, radius_answer, 1e-15);
  b = start;
  for (int k = 0; k < 3; ++k) {
    radius_answer = k == 0 ? -1.0 : k == 1 ? NAN : INFINITY;
    check_status(sph_integrator_step(it, NULL, 0.0, 1e-8, NULL), SPH_ERR_CALLBACK);
  }
  assert_int_equal(b.calls, 0);
  assert_memory_equal(&b, &start, sizeof b);
  sph_integrator_destroy(it);
  sph_context_destroy(ctx);
}

/* Too many stages: SPH_RETRY, nothing changed, and the step it suggests fits. */
static void test_max_stages(void **state) {
  (void)state;
  for (int32_t rule = SPH_STAGES_CFL; rule <= SPH_STAGES_POWER; ++rule) {
    sph_context *ctx = context_with(1);
    bar b = {{0}, {0}, 1.0, 0}, start = b;
    sph_integrator_options o = method_options(SPH_INTEGRATOR_RKC);
    sph_step_info info = fresh_info();
    o.stage_rule = rule;
    o.max_stages = 5;
    o.wave_speed = wave_speed();
    o.spacing = spacing;
    o.radius = host_radius;
    radius_answer = 5.0 * wave_speed() / spacing;
    sph_integrator *it = bar_integrator(ctx, &b, o);
    check_status(sph_integrator_step(it, NULL, 0.0, 1e-5, &info), SPH_RETRY);
    assert_non_null(strstr(sph_context_last_error(ctx), "max_stages = 5"));
    b.calls = 0;
    assert_memory_equal(&b, &start, sizeof b);
    assert_true(info.stages > 5 && info.suggested_dt < 1e-5);
    check_ok(sph_integrator_step(it, NULL, 0.0, info.suggested_dt, &info));
    assert_int_equal(info.stages, 5);
    check_status(sph_integrator_step(it, NULL, 0.0, -1e-7, &info), SPH_ERR_ARG);
    sph_integrator_destroy(it);
    sph_context_destroy(ctx);
  }
}

static int32_t explode(void *user, double t, sph_particles *set, const sph_rate *rates,
                       int32_t count) {
  const double *y = (const double *)user;
  (void)t;
  (void)set;
  (void)count;
  rates[0].values[0] = y[0] > 1.0 || y[0] < 1.0 ? NAN : 0.0;
  return 0;
}

static void test_radius_not_finite(void **state) {
  sph_context *ctx = context_with(1);
  double y = 1.0;
  sph_integrator *it = make_with(ctx, power_options());
  (void)state;
  check_ok(sph_integrator_bind_array(it, &y, 1));
  check_ok(sph_integrator_set_function(it, explode, &y));
  check_status(sph_integrator_step(it, NULL, 0.0, 0.1, NULL), SPH_ERR_NUMERIC);
  assert_true(y == 1.0);
  sph_integrator_destroy(it);
  sph_context_destroy(ctx);
}

/* ---- warnings ---------------------------------------------------------------------------- */

static sph_step_info run_bar(double nu, sph_integrator_options o, double cfl, int steps) {
  sph_context *ctx = context_with(1);
  bar b = {{0}, {0}, nu, 0};
  sph_step_info info = fresh_info();
  double dt = cfl * spacing / wave_speed();
  sph_integrator *it = bar_integrator(ctx, &b, o);
  for (int n = 0; n < steps; ++n) check_ok(sph_integrator_step(it, NULL, n * dt, dt, &info));
  sph_integrator_destroy(it);
  sph_context_destroy(ctx);
  return info;
}

static sph_integrator_options cfl_options(void) {
  sph_integrator_options o = method_options(SPH_INTEGRATOR_RKC);
  o.stage_rule = SPH_STAGES_CFL;
  o.wave_speed = wave_speed();
  o.spacing = spacing;
  o.stability_check_interval = -1;
  return o;
}

/* Without viscosity RKC amplifies whatever the rule; said once, with the growth. */
static void test_inviscid_wave_warns(void **state) {
  (void)state;
  for (int32_t rule = SPH_STAGES_FIXED; rule <= SPH_STAGES_POWER; ++rule) {
    sph_integrator_options o = cfl_options();
    o.stage_rule = rule;
    o.stages = 4;
    o.radius = host_radius;
    o.power_interval = 5;
    radius_answer = 5.0 * wave_speed() / spacing;
    sph_step_info info = run_bar(0.0, o, 1.0, 230);
    assert_int_equal(book.warnings, 1);
    assert_non_null(strstr(book.last, "imaginary axis"));
    check_close(info.growth, sph_rkc_amplification(info.stages, 0.0, 1.0), 0.01);
  }
}

static void test_small_step_does_not_warn(void **state) {
  (void)state;
  run_bar(0.0, cfl_options(), 0.3, 10);
  assert_int_equal(book.warnings, 0);
}

static void test_viscous_bar_does_not_warn(void **state) {
  static const double cfl[] = {0.6, 1.2, 2.5};
  (void)state;
  for (int k = 0; k < 3; ++k) {
    sph_step_info info = run_bar(1.1, cfl_options(), cfl[k], 20); /* 4.4 c / dp, as published */
    assert_int_equal(book.warnings, 0);
    assert_true(info.growth < 1.0);
  }
}

/* More viscosity than the published rule has stages for. */
static void test_too_viscous_warns(void **state) {
  sph_context *ctx = context_with(1);
  bar b = {{0}, {0}, 1.8, 0};
  double dt = 2.5 * spacing / wave_speed();
  sph_integrator *it = bar_integrator(ctx, &b, cfl_options());
  (void)state;
  check_ok(sph_integrator_step(it, NULL, 0.0, dt, NULL));
  assert_int_equal(book.warnings, 1);
  assert_non_null(strstr(book.last, "stability interval"));
  sph_integrator_destroy(it);
  sph_context_destroy(ctx);
}

/* Other methods look only when asked to. */
static void test_other_methods(void **state) {
  static const struct {
    int32_t method;
    double nu, cfl;
    int warnings;
  } row[] = {{SPH_INTEGRATOR_EULER, 0.0, 0.5, 1},  {SPH_INTEGRATOR_HEUN, 0.0, 1.0, 1},
             {SPH_INTEGRATOR_RK4, 0.0, 2.5, 0},    {SPH_INTEGRATOR_RK4, 0.0, 3.2, 1},
             {SPH_INTEGRATOR_RK4, 1.1, 0.6, 0},    {SPH_INTEGRATOR_RK4, 1.1, 0.8, 1},
             {SPH_INTEGRATOR_SSPRK3, 0.0, 1.6, 0}, {SPH_INTEGRATOR_SSPRK3, 0.0, 2.0, 1}};
  (void)state;
  for (size_t k = 0; k < sizeof row / sizeof row[0]; ++k) {
    sph_integrator_options o = method_options(row[k].method);
    o.stability_check_interval = 3;
    run_bar(row[k].nu, o, row[k].cfl, 5);
    assert_int_equal(book.warnings, row[k].warnings);
    o.stability_check_interval = -1;
    sph_step_info info = run_bar(row[k].nu, o, row[k].cfl, 2);
    assert_int_equal(book.warnings, 0);
    assert_true(isnan(info.growth));
  }
}

/* At most 20 evaluations, in the first step, the tenth after it and then every 100th; none at 0. */
static void test_check_interval(void **state) {
  sph_context *ctx = context_with(1);
  bar b = {{0}, {0}, 1.1, 0};
  double dt = 0.5 * spacing / wave_speed();
  (void)state;
  for (int never = 0; never < 2; ++never) {
    sph_integrator_options o = cfl_options();
    if (never) o.stability_check_interval = 0;
    sph_integrator *it = bar_integrator(ctx, &b, o);
    for (int n = 0; n < 210; ++n) {
      sph_step_info info = fresh_info();
      check_ok(sph_integrator_step(it, NULL, n * dt, dt, &info));
      int64_t extra = info.evaluations - info.stages;
      assert_true((n == 0 || n % 100 == 10) && !never ? extra >= 3 && extra <= 20 : extra == 0);
    }
    sph_integrator_destroy(it);
  }
  sph_context_destroy(ctx);
}

/* The look leaves no trace in the result. */
static void test_check_changes_nothing(void **state) {
  (void)state;
  for (int32_t method = SPH_INTEGRATOR_EULER; method <= SPH_INTEGRATOR_RKC; ++method) {
    bar b[2] = {{{0}, {0}, 0.3, 0}, {{0}, {0}, 0.3, 0}};
    if (method == SPH_INTEGRATOR_LEAPFROG) continue;
    sph_context *ctx = context_with(1);
    for (int k = 0; k < 2; ++k) {
      sph_integrator_options o = method_options(method);
      o.stability_check_interval = k;
      sph_integrator *it = bar_integrator(ctx, &b[k], o);
      for (int n = 0; n < 7; ++n) check_ok(sph_integrator_step(it, NULL, 0.0, 2e-7, NULL));
      sph_integrator_destroy(it);
    }
    assert_memory_equal(b[0].v, b[1].v, sizeof b[0].v);
    assert_memory_equal(b[0].stress, b[1].stress, sizeof b[0].stress);
    sph_context_destroy(ctx);
  }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_known_matrices),
    cmocka_unit_test(test_opposite_pair),
    cmocka_unit_test(test_scalars),
    cmocka_unit_test(test_empty_state),
    cmocka_unit_test(test_bar_spectra),
    cmocka_unit_test(test_power_runs_stable),
    cmocka_unit_test(test_interval),
    cmocka_unit_test(test_radius_rule),
    cmocka_unit_test(test_max_stages),
    cmocka_unit_test(test_radius_not_finite),
    cmocka_unit_test(test_inviscid_wave_warns),
    cmocka_unit_test(test_small_step_does_not_warn),
    cmocka_unit_test(test_viscous_bar_does_not_warn),
    cmocka_unit_test(test_too_viscous_warns),
    cmocka_unit_test(test_other_methods),
    cmocka_unit_test(test_check_interval),
    cmocka_unit_test(test_check_changes_nothing),
};
SPH_TEST_MAIN(tests)
