/* The ledger of the elastodynamics scheme: momentum closes to rounding, energy to the order of the
 * integrator, and what each form promises to keep is kept. */
#include "../solid_help.h"

static const int64_t sides[4][3] = {{0}, {40}, {9, 8}, {5, 4, 6}};

static sph_elastodynamics_options audited(int32_t dim, int32_t form) {
  sph_elastodynamics_options o = so_options(dim);
  o.momentum = form;
  o.audit = 1;
  return o;
}

/* A stirred free body after a time 4, by steps of dt. */
static sph_elastodynamics_ledger after(sph_context *ctx, const sph_elastodynamics_options *o,
                                       double dt, double *initial) {
  solid s = so_block(ctx, o->dim, sides[o->dim], 0.1);
  so_stir(&s, 0.02);
  so_start(&s, o);
  *initial = so_ledger(&s).kinetic;
  for (int k = 0; k < (int)lround(4.0 / dt); k++)
    check_ok(sph_elastodynamics_step(s.scheme, dt, NULL));
  const sph_elastodynamics_ledger l = so_ledger(&s);
  so_free(&s);
  return l;
}

static double largest(const double *x) { return fmax(fabs(x[0]), fmax(fabs(x[1]), fabs(x[2]))); }

/* Its pieces against sums of their own. */
static void test_sums(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  solid s = so_block(ctx, 3, sides[3], 0.1);
  sph_elastodynamics_options o = so_options(3);
  double kinetic = 0.0, moment_y = 0.0;
  so_stir(&s, 0.1);
  so_start(&s, &o);
  const double *x = so_field(&s, SPH_FIELD_X), *v = so_field(&s, SPH_FIELD_V);
  for (int64_t i = 0; i < s.n; i++) {
    const double *p = x + 3 * i, *u = v + 3 * i;
    kinetic += 0.5 * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    moment_y += p[2] * u[0] - p[0] * u[2];
  }
  const sph_elastodynamics_ledger l = so_ledger(&s);
  check_close(l.mass, (double)s.n, 0.0);
  check_rel(l.kinetic, kinetic, 1e-14);
  check_rel(l.angular_momentum[1], moment_y, 1e-12);
  assert_true(isnan(l.strain) && isnan(l.energy_error) && isnan(l.momentum_error)); /* no audit */
  so_free(&s);
  sph_context_destroy(ctx);
}

/* CONSERVATIVE: pairs add no momentum, and stress force and strain rate balance. */
static void test_conservative(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++) {
    const sph_elastodynamics_options o = audited(dim, SPH_STRESS_CONSERVATIVE);
    double initial;
    const sph_elastodynamics_ledger l = after(ctx, &o, 0.25, &initial);
    assert_true(l.viscous > 0.01 * initial && l.strain > 0.01 * initial);
    check_close(l.form, 0.0, 1e-13 * initial);
    check_close(largest(l.impulse_form), 0.0, 1e-13);
    check_close(l.momentum_error, 0.0, 1e-13);
    check_close(l.hooks + l.body, 0.0, 0.0);
    check_close(l.energy_error, 0.0, 0.02 * initial);
  }
  sph_context_destroy(ctx);
}

/* The others do not, and the ledger says so and closes all the same. */
static void test_not_conservative(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t form = SPH_STRESS_SUMMED; form <= SPH_STRESS_DIFFERENCE; form++) {
    const sph_elastodynamics_options o = audited(2, form);
    double initial;
    const sph_elastodynamics_ledger l = after(ctx, &o, 0.25, &initial);
    assert_true(fabs(l.form) > 1e-3 * initial);
    assert_true(largest(l.impulse_form) > 1e-5);
    check_close(l.momentum_error, 0.0, 1e-13);
    check_close(l.energy_error, 0.0, 0.05 * initial);
  }
  sph_context_destroy(ctx);
}

/* Uncorrected, SUMMED is the transpose, too. */
static void test_uncorrected(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++) {
    sph_elastodynamics_options o = audited(dim, SPH_STRESS_SUMMED);
    double initial;
    o.corrected = 0;
    const sph_elastodynamics_ledger l = after(ctx, &o, 0.25, &initial);
    check_close(l.form, 0.0, 1e-13 * initial);
    check_close(largest(l.impulse_form), 0.0, 1e-13);
  }
  sph_context_destroy(ctx);
}

/* What is left of the energy is of the integrator's order; without viscosity and artificial stress,
 * whose switches are not smooth. */
static void test_order(void **state) {
  (void)state;
  static const int32_t methods[] = {SPH_INTEGRATOR_RK4, SPH_INTEGRATOR_PC2};
  sph_context *ctx = rh_context(1);
  for (int k = 0; k < 2; k++) {
    sph_elastodynamics_options o = audited(2, SPH_STRESS_CONSERVATIVE);
    double initial;
    o.alpha = o.beta = o.artificial_stress = 0.0;
    o.kernel = SPH_KERNEL_WENDLAND_C6; /* the cubic spline has a kink that would show */
    o.integrator = methods[k];
    const double coarse = fabs(after(ctx, &o, 0.25, &initial).energy_error);
    const double fine = fabs(after(ctx, &o, 0.125, &initial).energy_error);
    assert_true(coarse > 1e-9 * initial);
    assert_true(log2(coarse / fine) > (k == 0 ? 3.5 : 1.8));
  }
  sph_context_destroy(ctx);
}

/* A wall pushes a bar: its work and impulse are those of the force on it, and all else follows. */
static void test_wall_work(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  solid s = so_block(ctx, 1, sides[1], 0.0);
  sph_elastodynamics_options o = audited(1, SPH_STRESS_CONSERVATIVE);
  const double pace = 1e-3;
  o.alpha = o.beta = o.artificial_stress = 0.0;
  o.integrator = SPH_INTEGRATOR_RK4;
  sph_particles_roles(s.set)[0] = SPH_ROLE_WALL;
  so_field(&s, SPH_FIELD_V)[0] = pace;
  so_start(&s, &o);
  for (int k = 0; k < 80; k++) check_ok(sph_elastodynamics_step(s.scheme, 0.25, NULL));
  const sph_elastodynamics_ledger l = so_ledger(&s);
  check_rel(l.hooks, pace * l.impulse_hooks[0], 1e-12); /* force times one velocity */
  check_rel(l.momentum[0], pace + l.impulse_hooks[0], 1e-12);
  check_rel(l.impulse_hooks[0], pace * 20.0, 0.1); /* rho c v t, before the wave is back */
  check_close(l.energy_error, 0.0, 1e-5 * l.kinetic);
  so_free(&s);
  sph_context_destroy(ctx);
}

static void test_body_force(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  solid s = so_block(ctx, 2, sides[2], 0.1);
  sph_elastodynamics_options o = audited(2, SPH_STRESS_CONSERVATIVE);
  o.body_force[0] = 0.5;
  so_start(&s, &o);
  for (int k = 0; k < 8; k++) check_ok(sph_elastodynamics_step(s.scheme, 0.25, NULL));
  const sph_elastodynamics_ledger l = so_ledger(&s);
  check_rel(l.impulse_body[0], (double)s.n, 1e-13); /* g t = 1 */
  check_rel(l.body, 0.5 * (double)s.n, 1e-12);      /* the body falls freely: kinetic energy */
  check_rel(l.kinetic, l.body, 1e-12);
  check_close(l.momentum_error, 0.0, 1e-12);
  so_free(&s);
  sph_context_destroy(ctx);
}

/* A step that fails adds nothing. */
static int32_t fail_late(void *user, double t, sph_particles *set, const sph_rate *rates,
                         int32_t count) {
  int *left = user;
  (void)t;
  (void)set;
  (void)rates;
  (void)count;
  return --*left < 0 ? -3 : 0;
}

static void test_failed_step(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  solid s = so_block(ctx, 2, sides[2], 0.1);
  sph_elastodynamics_options o = audited(2, SPH_STRESS_CONSERVATIVE);
  int left = 2;
  o.integrator = SPH_INTEGRATOR_RK4;
  so_stir(&s, 0.02);
  so_start(&s, &o);
  check_ok(sph_elastodynamics_step(s.scheme, 0.25, NULL));
  const sph_elastodynamics_ledger before = so_ledger(&s);
  check_ok(sph_elastodynamics_set_prepare(s.scheme, fail_late, &left));
  check_status(sph_elastodynamics_step(s.scheme, 0.25, NULL), SPH_ERR_CALLBACK);
  const sph_elastodynamics_ledger now = so_ledger(&s);
  assert_memory_equal(&before, &now, sizeof now);
  so_free(&s);
  sph_context_destroy(ctx);
}

/* A smaller struct of an older host is filled as far as it goes. */
static void test_small_struct(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  solid s = so_block(ctx, 1, sides[1], 0.0);
  sph_elastodynamics_options o = so_options(1);
  sph_elastodynamics_ledger l;
  so_start(&s, &o);
  memset(&l, 0x55, sizeof l);
  sph_elastodynamics_ledger_init_sized(&l, offsetof(sph_elastodynamics_ledger, kinetic));
  const double untouched = l.kinetic;
  check_ok(sph_elastodynamics_balance(s.scheme, &l));
  check_close(l.mass, 40.0, 0.0);
  assert_memory_equal(&untouched, &l.kinetic, sizeof untouched);
  l.size = 0;
  check_status(sph_elastodynamics_balance(s.scheme, &l), SPH_ERR_ARG);
  so_free(&s);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_sums),
    cmocka_unit_test(test_conservative),
    cmocka_unit_test(test_not_conservative),
    cmocka_unit_test(test_uncorrected),
    cmocka_unit_test(test_order),
    cmocka_unit_test(test_wall_work),
    cmocka_unit_test(test_body_force),
    cmocka_unit_test(test_failed_step),
    cmocka_unit_test(test_small_struct),
};
SPH_TEST_MAIN(tests)
