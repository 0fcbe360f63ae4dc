/* Integrators: orders, equivalences, error estimates, leapfrog, step control. */
#include "integrate_help.h"

#include "integrate/integrate_impl.h"

/* ---- orders ------------------------------------------------------------------------------ */

static double final_error(sph_context *ctx, sph_integrator_options o, int steps, double t_end) {
  double y[3], exact[3], error = 0.0, dt = t_end / steps;
  sph_integrator *it = make_with(ctx, o);
  smooth_solution(0.0, y);
  check_ok(sph_integrator_bind_array(it, y, 3));
  check_ok(sph_integrator_set_function(it, smooth_system, y));
  for (int n = 0; n < steps; ++n) check_ok(sph_integrator_step(it, NULL, n * dt, dt, NULL));
  smooth_solution(t_end, exact);
  for (int k = 0; k < 3; ++k) error = fmax(error, fabs(y[k] - exact[k]));
  sph_integrator_destroy(it);
  return error;
}

static void check_order(sph_integrator_options o, double order, double t_end) {
  sph_context *ctx = context_with(1);
  double coarse = final_error(ctx, o, 80, t_end), fine = final_error(ctx, o, 160, t_end);
  assert_true(fine > 1e-13); /* above rounding: the quotient means something */
  check_close(log2(coarse / fine), order, 0.15);
  sph_context_destroy(ctx);
}

static void test_orders(void **state) {
  static const double order[] = {1, 2, 2, 3, 4, 4, 2};
  (void)state;
  for (int32_t m = SPH_INTEGRATOR_EULER; m <= SPH_INTEGRATOR_BUTCHER; ++m)
    check_order(method_options(m), order[m - 1], 2.0);
}

static void test_orders_backwards(void **state) {
  static const double order[] = {1, 2, 2, 3, 4, 4, 2};
  (void)state;
  for (int32_t m = SPH_INTEGRATOR_EULER; m <= SPH_INTEGRATOR_BUTCHER; ++m)
    check_order(method_options(m), order[m - 1], -0.5);
}

static void test_rkc_orders(void **state) {
  static const int32_t stages[] = {2, 3, 4, 5, 8, 13};
  (void)state;
  for (size_t k = 0; k < sizeof stages / sizeof stages[0]; ++k)
    for (int32_t b1 = 1; b1 <= 2; ++b1) {
      sph_integrator_options o = method_options(SPH_INTEGRATOR_RKC);
      o.stages = stages[k];
      o.rkc_b1 = b1;
      check_order(o, 2.0, 2.0);
    }
}

/* One step of each method on y' = lambda y is the stability polynomial. */
static int32_t decay(void *user, double t, sph_particles *set, const sph_rate *rates,
                     int32_t count) {
  const double *y = (const double *)user;
  (void)t;
  (void)set;
  (void)count;
  rates[0].values[0] = -2.0 * y[0];
  return 0;
}

static void test_polynomials(void **state) {
  static const double z = -0.5;
  const double p2 = 1 + z + z * z / 2, p3 = p2 + z * z * z / 6, p4 = p3 + z * z * z * z / 24;
  const double want[] = {1 + z, p2, p2, p3, p4, p4, p2};
  sph_context *ctx = context_with(1);
  (void)state;
  for (int32_t m = SPH_INTEGRATOR_EULER; m <= SPH_INTEGRATOR_BUTCHER; ++m) {
    double y = 1.0;
    sph_integrator *it = make(ctx, m);
    check_ok(sph_integrator_bind_array(it, &y, 1));
    check_ok(sph_integrator_set_function(it, decay, &y));
    check_ok(sph_integrator_step(it, NULL, 0.0, 0.25, NULL));
    check_close(y, want[m - 1], 1e-15);
    check_close(sphi_butcher_amplification(&it->tableau, z, 0.0), fabs(want[m - 1]), 1e-15);
    sph_integrator_destroy(it);
  }
  sph_context_destroy(ctx);
}

static void test_order_conditions(void **state) {
  static const int32_t order[] = {1, 2, 2, 3, 4, 4};
  static const double classical[] = {0, 0, 0, 0, .5, 0, 0, 0, 0, .5, 0, 0, 0, 0, 1, 0};
  static const double c[] = {0, .5, .5, 1}, second[] = {.25, .25, .25, .25};
  static const double none[] = {.5, .5, .5, .5}, third[] = {.125, .375, .375, .125};
  sphi_tableau t = {4, classical, second, c, NULL, 0};
  (void)state;
  assert_int_equal(sphi_butcher_order(&t, none), 0);
  assert_int_equal(sphi_butcher_order(&t, second), 2);
  assert_int_equal(sphi_butcher_order(&t, third), 2); /* weights of another method */
  for (int32_t m = SPH_INTEGRATOR_EULER; m <= SPH_INTEGRATOR_RK38; ++m) {
    assert_true(sphi_butcher_builtin(m, &t));
    assert_int_equal(sphi_butcher_order(&t, t.b), order[m - 1]);
    for (int32_t i = 0; i < t.s; ++i) {
      double sum = 0.0;
      for (int32_t j = 0; j < i; ++j) sum += t.a[i * t.s + j];
      check_close(t.c[i], sum, 1e-15);
    }
  }
  assert_false(sphi_butcher_builtin(SPH_INTEGRATOR_RKC, &t));
}

/* Limits on the imaginary axis: SSPRK3 sqrt(3), RK4 sqrt(8); none for the others. */
static void test_imaginary_limits(void **state) {
  sphi_tableau t;
  (void)state;
  sphi_butcher_builtin(SPH_INTEGRATOR_SSPRK3, &t);
  assert_true(sphi_butcher_amplification(&t, 0.0, 1.732) < 1.0);
  assert_true(sphi_butcher_amplification(&t, 0.0, 1.7321) > 1.0);
  sphi_butcher_builtin(SPH_INTEGRATOR_RK4, &t);
  assert_true(sphi_butcher_amplification(&t, 0.0, 2.828) < 1.0);
  assert_true(sphi_butcher_amplification(&t, 0.0, 2.8285) > 1.0);
  assert_true(sphi_butcher_amplification(&t, -2.785, 0.0) < 1.0);
  assert_true(sphi_butcher_amplification(&t, -2.786, 0.0) > 1.0);
  sphi_butcher_builtin(SPH_INTEGRATOR_HEUN, &t);
  check_close((sphi_butcher_amplification(&t, 0.0, 0.05) - 1.0) / pow(0.05, 4), 0.125, 1e-3);
}

static void run_smooth(sph_context *ctx, sph_integrator_options o, double *y) {
  sph_integrator *it = make_with(ctx, o);
  smooth_solution(0.0, y);
  check_ok(sph_integrator_bind_array(it, y, 3));
  check_ok(sph_integrator_set_function(it, smooth_system, y));
  for (int n = 0; n < 50; ++n) check_ok(sph_integrator_step(it, NULL, 0.02 * n, 0.02, NULL));
  sph_integrator_destroy(it);
}

static void test_rkc_of_two_stages_is_heun(void **state) {
  sph_context *ctx = context_with(1);
  sph_integrator_options o = method_options(SPH_INTEGRATOR_RKC);
  double a[3], b[3];
  (void)state;
  o.stages = 2;
  run_smooth(ctx, o, a);
  run_smooth(ctx, method_options(SPH_INTEGRATOR_HEUN), b);
  for (int k = 0; k < 3; ++k) check_rel(a[k], b[k], 1e-14);
  sph_context_destroy(ctx);
}

/* U_h = U + dt/2 F(U), U_c = U + dt/2 F(U_h), U+ = 2 U_c - U (He 4.5) */
static void test_pc2_as_printed(void **state) {
  sph_context *ctx = context_with(1);
  double y[3], u[3], w[3], f[3], dt = 0.1;
  sph_rate rate = {-1, f};
  sph_integrator *it = make(ctx, SPH_INTEGRATOR_PC2);
  (void)state;
  smooth_solution(0.3, y);
  smooth_solution(0.3, u);
  check_ok(sph_integrator_bind_array(it, y, 3));
  check_ok(sph_integrator_set_function(it, smooth_system, y));
  check_ok(sph_integrator_step(it, NULL, 0.3, dt, NULL));
  smooth_system(u, 0.3, NULL, &rate, 1);
  for (int k = 0; k < 3; ++k) w[k] = u[k] + 0.5 * dt * f[k];
  smooth_system(w, 0.3 + 0.5 * dt, NULL, &rate, 1);
  for (int k = 0; k < 3; ++k) check_close(y[k], 2.0 * (u[k] + 0.5 * dt * f[k]) - u[k], 1e-15);
  sph_integrator_destroy(it);
  sph_context_destroy(ctx);
}

/* ---- error estimates --------------------------------------------------------------------- */

static sph_step_info one_step(sph_context *ctx, sph_integrator_options o, double t, double dt,
                              double *error) {
  double y[3], exact[3];
  sph_step_info info;
  sph_integrator *it = make_with(ctx, o);
  sph_step_info_init(&info);
  info.want_error = 1;
  smooth_solution(t, y);
  check_ok(sph_integrator_bind_array(it, y, 3));
  check_ok(sph_integrator_set_function(it, smooth_system, y));
  check_ok(sph_integrator_step(it, NULL, t, dt, &info));
  smooth_solution(t + dt, exact);
  *error = 0.0;
  for (int k = 0; k < 3; ++k) *error = fmax(*error, fabs(y[k] - exact[k]));
  sph_integrator_destroy(it);
  return info;
}

/* With atol 1 and rtol 0 the norm is the largest error itself; it falls as dt^(q + 1). */
static void test_error_orders(void **state) {
  static const struct {
    int32_t method, evaluations;
    double order;
  } row[] = {{SPH_INTEGRATOR_PC2, 2, 2},
             {SPH_INTEGRATOR_HEUN, 2, 2},
             {SPH_INTEGRATOR_SSPRK3, 3, 3},
             {SPH_INTEGRATOR_BUTCHER, 3, 3},
             {SPH_INTEGRATOR_RKC, 4, 3}};
  sph_context *ctx = context_with(1);
  (void)state;
  for (size_t m = 0; m < sizeof row / sizeof row[0]; ++m) {
    double error;
    sph_integrator_options o = method_options(row[m].method);
    o.atol = 1.0;
    o.rtol = 0.0;
    sph_step_info a = one_step(ctx, o, 0.4, 0.02, &error);
    sph_step_info b = one_step(ctx, o, 0.4, 0.01, &error);
    check_close(log2(a.error / b.error), row[m].order, 0.15);
    assert_int_equal(a.evaluations, row[m].evaluations);
    assert_int_equal(a.stages, row[m].method == SPH_INTEGRATOR_RKC ? 3 : row[m].evaluations);
    check_rel(b.suggested_dt, 0.01 * fmin(5.0, 0.8 * pow(b.error, -1.0 / row[m].order)), 1e-12);
  }
  sph_context_destroy(ctx);
}

/* RKC: between 1 and 2 times the true local error, for every number of stages. */
static void test_rkc_error_is_a_bound(void **state) {
  sph_context *ctx = context_with(1);
  (void)state;
  for (int32_t s = 2; s <= 40; s += 3)
    for (int32_t b1 = 1; b1 <= 2; ++b1) {
      double error, y = 1.0;
      sph_integrator_options o = method_options(SPH_INTEGRATOR_RKC);
      sph_step_info info;
      o.stages = s;
      o.rkc_b1 = b1;
      o.atol = 1.0;
      o.rtol = 0.0;
      sph_integrator *it = make_with(ctx, o);
      sph_step_info_init(&info);
      info.want_error = 1;
      check_ok(sph_integrator_bind_array(it, &y, 1));
      check_ok(sph_integrator_set_function(it, decay, &y));
      check_ok(sph_integrator_step(it, NULL, 0.0, 0.005, &info));
      error = fabs(y - exp(-0.01));
      assert_true(info.error > 1.1 * error && info.error < 1.9 * error);
      sph_integrator_destroy(it);
    }
  sph_context_destroy(ctx);
}

static void test_no_estimate_is_nan(void **state) {
  static const int32_t method[] = {SPH_INTEGRATOR_EULER, SPH_INTEGRATOR_RK4, SPH_INTEGRATOR_RK38};
  sph_context *ctx = context_with(1);
  (void)state;
  for (int m = 0; m < 3; ++m) {
    double error;
    sph_step_info info = one_step(ctx, method_options(method[m]), 0.0, 0.1, &error);
    assert_true(isnan(info.error) && isnan(info.suggested_dt) && isnan(info.radius));
    assert_true(isnan(info.growth) && isnan(info.eigen_re));
  }
  sph_context_destroy(ctx);
}

/* The host's loop: reject above 1, restore, go on with the suggestion. */
static void test_adaptive_loop(void **state) {
  sph_context *ctx = context_with(1);
  sph_integrator_options o = method_options(SPH_INTEGRATOR_RKC);
  double y[3], exact[3], t = 0.0, dt = 1.0;
  int rejected = 0, taken = 0;
  (void)state;
  o.rtol = 1e-6;
  o.atol = 1e-9;
  o.stages = 4;
  sph_integrator *it = make_with(ctx, o);
  smooth_solution(0.0, y);
  check_ok(sph_integrator_bind_array(it, y, 3));
  check_ok(sph_integrator_set_function(it, smooth_system, y));
  while (t < 2.0 && taken + rejected < 5000) {
    sph_step_info info;
    sph_step_info_init(&info);
    info.want_error = 1;
    if (dt > 2.0 - t) dt = 2.0 - t;
    check_ok(sph_integrator_save(it, NULL));
    check_ok(sph_integrator_step(it, NULL, t, dt, &info));
    if (info.error > 1.0) {
      check_ok(sph_integrator_restore(it, NULL));
      ++rejected;
    } else {
      t += dt;
      ++taken;
    }
    dt = info.suggested_dt;
  }
  smooth_solution(2.0, exact);
  for (int k = 0; k < 3; ++k) check_close(y[k], exact[k], 2e-3);
  assert_true(rejected >= 1 && taken > 20 && taken < 2000);
  sph_integrator_destroy(it);
  sph_context_destroy(ctx);
}

/* ---- leapfrog ---------------------------------------------------------------------------- */

static sph_integrator *leapfrog(sph_context *ctx, sph_rhs_fn fn, void *user, int others) {
  sph_integrator *it = make(ctx, SPH_INTEGRATOR_LEAPFROG);
  check_ok(sph_integrator_bind_field(it, SPH_FIELD_V));
  if (others) check_ok(sph_integrator_bind_field(it, SPH_FIELD_E));
  check_ok(sph_integrator_bind_field(it, SPH_FIELD_X));
  check_ok(sph_integrator_set_function(it, fn, user));
  return it;
}

static void test_leapfrog_order(void **state) {
  sph_context *ctx = context_with(1);
  (void)state;
  for (int others = 0; others < 2; ++others) {
    double exact[3], a[3], b[3];
    run_tangle(ctx, SPH_INTEGRATOR_RK4, others, 4000, 0.0, exact);
    run_tangle(ctx, SPH_INTEGRATOR_LEAPFROG, others, 100, 0.0, a);
    run_tangle(ctx, SPH_INTEGRATOR_LEAPFROG, others, 200, 0.0, b);
    for (int k = 0; k < 2 + others; ++k)
      check_close(log2(fabs(a[k] - exact[k]) / fabs(b[k] - exact[k])), 2.0, 0.15);
  }
  sph_context_destroy(ctx);
}

static void test_leapfrog_reversible(void **state) {
  sph_context *ctx = context_with(1);
  sph_particles *set = make_set(ctx, 2, 20);
  sph_integrator *it = leapfrog(ctx, pendulum, NULL, 0);
  double x0[40], v0[40], *x, *v;
  (void)state;
  check_ok(sph_particles_field(set, SPH_FIELD_X, &x));
  check_ok(sph_particles_field(set, SPH_FIELD_V, &v));
  memcpy(x0, x, sizeof x0);
  memcpy(v0, v, sizeof v0);
  for (int n = 0; n < 500; ++n) check_ok(sph_integrator_step(it, set, 0.1 * n, 0.1, NULL));
  assert_true(fabs(x[0] - x0[0]) > 1e-3);
  for (int n = 500; n > 0; --n) check_ok(sph_integrator_step(it, set, 0.1 * n, -0.1, NULL));
  for (int i = 0; i < 40; ++i) {
    check_close(x[i], x0[i], 1e-12);
    check_close(v[i], v0[i], 1e-12);
  }
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

/* The energy error neither grows nor exceeds O(dt^2) over many periods; two evaluations a step. */
static void test_leapfrog_energy(void **state) {
  sph_context *ctx = context_with(1);
  sph_particles *set = make_set(ctx, 1, 1);
  sph_integrator *it = leapfrog(ctx, pendulum, NULL, 0);
  double *x, *v, worst[2] = {0.0, 0.0};
  sph_step_info info;
  (void)state;
  sph_step_info_init(&info);
  check_ok(sph_particles_field(set, SPH_FIELD_X, &x));
  check_ok(sph_particles_field(set, SPH_FIELD_V, &v));
  double energy = 0.5 * v[0] * v[0] - cos(x[0]);
  for (int n = 0; n < 20000; ++n) {
    check_ok(sph_integrator_step(it, set, 0.0, 0.1, &info));
    double drift = fabs(0.5 * v[0] * v[0] - cos(x[0]) - energy);
    worst[n >= 10000] = fmax(worst[n >= 10000], drift);
  }
  assert_true(worst[0] < 2e-3);
  check_rel(worst[0], worst[1], 0.02);
  assert_int_equal(info.stages, 2);
  assert_int_equal(info.evaluations, 2);
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

/* A wave between V and another field (stress): stable for omega dt < 2, three evaluations. */
static int32_t spring(void *user, double t, sph_particles *set, const sph_rate *rates,
                      int32_t count) {
  double v = sph_particles_field_const(set, SPH_FIELD_V)[0];
  double s = sph_particles_field_const(set, SPH_FIELD_E)[0];
  (void)user;
  (void)t;
  for (int32_t k = 0; k < count; ++k)
    rates[k].values[0] = rates[k].field == SPH_FIELD_E ? v : rates[k].field == SPH_FIELD_V ? -s : v;
  return 0;
}

static double spring_size(sph_context *ctx, double dt, int steps, int32_t *stages) {
  sph_particles *set = make_set(ctx, 1, 1);
  sph_integrator *it = leapfrog(ctx, spring, NULL, 1);
  double *v, *s, largest = 0.0;
  sph_step_info info;
  sph_step_info_init(&info);
  check_ok(sph_particles_field(set, SPH_FIELD_V, &v));
  check_ok(sph_particles_field(set, SPH_FIELD_E, &s));
  v[0] = 1.0;
  for (int n = 0; n < steps; ++n) {
    check_ok(sph_integrator_step(it, set, 0.0, dt, &info));
    largest = fmax(largest, hypot(v[0], s[0]));
  }
  *stages = info.stages;
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  return largest;
}

static void test_leapfrog_wave(void **state) {
  sph_context *ctx = context_with(1);
  int32_t stages = 0;
  (void)state;
  assert_true(spring_size(ctx, 0.5, 100000, &stages) < 1.1);
  assert_int_equal(stages, 3);
  assert_true(spring_size(ctx, 1.9, 10000, &stages) < 5.0);
  assert_true(spring_size(ctx, 2.1, 200, &stages) > 1e10);
  sph_context_destroy(ctx);
}

/* ---- the CFL step ------------------------------------------------------------------------ */

static void test_cfl_step(void **state) {
  sph_context *ctx = context_with(2);
  sph_particles *set = make_set(ctx, 2, 1000);
  double *h, *c, *v, dt = 7.0;
  (void)state;
  check_status(sph_cfl_step(set, 0.5, &dt), SPH_ERR_ARG);
  check_ok(sph_particles_field(set, SPH_FIELD_H, &h));
  check_ok(sph_particles_field(set, SPH_FIELD_V, &v));
  for (int i = 0; i < 1000; ++i) h[i] = 0.1;
  memset(v, 0, 2000 * sizeof *v);
  check_status(sph_cfl_step(set, 0.5, &dt), SPH_ERR_NUMERIC);
  v[2 * 700] = 3.0;
  v[2 * 700 + 1] = -4.0;
  check_ok(sph_cfl_step(set, 0.5, &dt));
  check_rel(dt, 0.5 * 0.1 / 5.0, 1e-15);
  check_ok(sph_particles_field(set, SPH_FIELD_C, &c));
  for (int i = 0; i < 1000; ++i) c[i] = 10.0;
  check_ok(sph_cfl_step(set, 0.5, &dt));
  check_rel(dt, 0.5 * 0.1 / 15.0, 1e-15);
  c[123] = NAN;
  h[500] = 0.0;
  check_status(sph_cfl_step(set, 0.5, &dt), SPH_ERR_NUMERIC);
  assert_non_null(strstr(sph_context_last_error(ctx), "particle 123"));
  c[123] = 10.0;
  h[500] = 1e-300; /* the step is no number any more: never 0 */
  c[500] = 1e200;
  check_status(sph_cfl_step(set, 0.5, &dt), SPH_ERR_NUMERIC);
  assert_non_null(strstr(sph_context_last_error(ctx), "is no step"));
  c[500] = 1.0;
  check_ok(sph_cfl_step(set, 0.5, &dt));
  assert_true(dt > 0.0 && dt < 1e-299);
  h[500] = 0.1;
  check_ok(sph_cfl_step(set, 0.5, &dt));
  check_status(sph_cfl_step(set, 0.0, &dt), SPH_ERR_ARG);
  check_status(sph_cfl_step(set, NAN, &dt), SPH_ERR_ARG);
  check_status(sph_cfl_step(set, 1.0, NULL), SPH_ERR_ARG);
  check_rel(dt, 0.5 * 0.1 / 15.0, 1e-15);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_orders),
    cmocka_unit_test(test_orders_backwards),
    cmocka_unit_test(test_rkc_orders),
    cmocka_unit_test(test_polynomials),
    cmocka_unit_test(test_order_conditions),
    cmocka_unit_test(test_imaginary_limits),
    cmocka_unit_test(test_rkc_of_two_stages_is_heun),
    cmocka_unit_test(test_pc2_as_printed),
    cmocka_unit_test(test_error_orders),
    cmocka_unit_test(test_rkc_error_is_a_bound),
    cmocka_unit_test(test_no_estimate_is_nan),
    cmocka_unit_test(test_adaptive_loop),
    cmocka_unit_test(test_leapfrog_order),
    cmocka_unit_test(test_leapfrog_reversible),
    cmocka_unit_test(test_leapfrog_energy),
    cmocka_unit_test(test_leapfrog_wave),
    cmocka_unit_test(test_cfl_step),
};
SPH_TEST_MAIN(tests)
