/* The ledger of the scheme total_lagrangian: what a free body keeps, what viscosity, gravity and a
 * clamp add, against sums taken by hand; failures and memory. */
#include "../oom.h"
#include "../total_lagrangian_help.h"

static sph_total_lagrangian_options audited(void) {
  sph_total_lagrangian_options o = defaults();
  o.audit = 1;
  return o;
}

static sph_total_lagrangian_ledger balance(const tl_body *b, double t) {
  sph_total_lagrangian_ledger l;
  sph_total_lagrangian_ledger_init(&l);
  check_ok(sph_total_lagrangian_balance(b->tl, b->set, t, &l));
  return l;
}

static void advance(tl_body *b, int from, int to, double dt) {
  for (int k = from; k < to; k++) check_ok(sph_total_lagrangian_step(b->tl, b->set, k * dt, dt));
}

static double largest_of(const double v[3]) {
  return fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
}

/* ---- what is kept ------------------------------------------------------------------------ */

/* Nothing from outside: every impulse and moment is rounding, the sums are those of the set, and
 * with half the step a quarter of the energy error is left. */
static void test_free_body(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++) {
    double error[2];
    for (int half = 0; half < 2; half++) {
      sph_total_lagrangian_options o = audited();
      tl_body b = make(ctx, dim, &o, 0.2);
      const double scale = 1.1 * pow(0.5 * SIDE, dim);
      advance(&b, 0, half ? 80 : 40, half ? 0.02 : 0.04);
      const sph_total_lagrangian_ledger l = balance(&b, 1.6);
      check_rel(l.mass, scale, 1e-13);
      check_rel(l.kinetic + l.strain + l.hourglass, total(&b, 1.6), 1e-13);
      assert_true(l.strain > 0.01 * l.kinetic && l.hourglass > 0.0);
      assert_true(largest_of(l.impulse_form) < 1e-13 * scale);
      assert_true(largest_of(l.moment_form) < 1e-12 * scale);
      assert_true(largest_of(l.impulse_hooks) < 1e-13 * scale && fabs(l.hooks) < 1e-13 * scale);
      assert_true(l.momentum_error < 1e-13 * scale && l.angular_momentum_error < 1e-12 * scale);
      assert_true(l.viscous == 0.0 && l.gravity == 0.0 && l.time == 1.6);
      error[half] = l.energy_error;
      unmake(&b);
    }
    assert_true(error[0] / error[1] > 3.0 && error[0] / error[1] < 5.0);
  }
  sph_context_destroy(ctx);
}

/* What viscosity takes grows from step to step, and is what the other energies lose. */
static void test_viscosity(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_total_lagrangian_options o = audited();
  o.alpha = o.beta = 1.0;
  tl_body b = make(ctx, 2, &o, 0.2);
  const double start = total(&b, 0.0);
  double before = 0.0;
  for (int k = 0; k < 20; k++) {
    advance(&b, k, k + 1, 0.02);
    const sph_total_lagrangian_ledger l = balance(&b, (k + 1) * 0.02);
    assert_true(l.viscous > before);
    check_close(total(&b, (k + 1) * 0.02) + l.viscous - start, l.energy_error, 1e-13);
    assert_true(fabs(l.energy_error) < 2e-4 * start);
    assert_true(largest_of(l.impulse_form) < 1e-13 && largest_of(l.moment_form) < 1e-12);
    before = l.viscous;
  }
  assert_true(before > 0.01 * start);
  unmake(&b);
  sph_context_destroy(ctx);
}

/* ---- from outside ------------------------------------------------------------------------ */

typedef struct clamp {
  const tl_body *body;
  double force[2], moment; /* of the last evaluation: what it takes to hold */
} clamp;

/* The first column is held; what its particles would have got is kept. */
static int32_t hold_column(void *user, double t, sph_particles *set, const sph_rate *rates,
                           int32_t count) {
  clamp *c = user;
  const double *m = values(c->body, SPH_FIELD_M), *x = values(c->body, SPH_FIELD_X);
  (void)t;
  (void)set;
  (void)count;
  double *a = rates[0].values;
  c->force[0] = c->force[1] = c->moment = 0.0;
  for (int i = 0; i < SIDE * SIDE; i += SIDE) {
    c->force[0] -= m[i] * a[2 * i];
    c->force[1] -= m[i] * a[2 * i + 1];
    c->moment -= m[i] * (x[2 * i] * a[2 * i + 1] - x[2 * i + 1] * a[2 * i]);
    a[2 * i] = a[2 * i + 1] = 0.0;
  }
  return 0;
}

/* A cantilever under gravity: the reaction of the clamp by the trapezoidal rule, which is that of
 * the leapfrog; a clamp does no work. */
static void test_clamp_and_gravity(void **state) {
  (void)state;
  enum { STEPS = 30 };
  sph_context *ctx = rh_context(1);
  sph_total_lagrangian_options o = audited();
  o.gravity[0] = 0.02;
  o.gravity[1] = -0.1;
  o.alpha = 0.5;
  tl_body b = make(ctx, 2, &o, 0.0);
  clamp c = {.body = &b};
  double force[2] = {0.0, 0.0}, moment = 0.0;
  const double dt = 0.03;
  check_ok(sph_rhs_set_finish(sph_total_lagrangian_rhs(b.tl), hold_column, &c));
  for (int k = 0; k < STEPS; k++) {
    (void)total(&b, k * dt); /* evaluates, where no step has */
    const clamp old = c;
    advance(&b, k, k + 1, dt);
    for (int a = 0; a < 2; a++) force[a] += 0.5 * dt * (old.force[a] + c.force[a]);
    moment += 0.5 * dt * (old.moment + c.moment);
  }
  const sph_total_lagrangian_ledger l = balance(&b, STEPS * dt);
  double fall = 0.0;
  const double *x = values(&b, SPH_FIELD_X), *X = values(&b, SPH_FIELD_X0);
  for (int k = 0; k < 2 * SIDE * SIDE; k++)
    fall += values(&b, SPH_FIELD_M)[k / 2] * o.gravity[k % 2] * (x[k] - X[k]);
  for (int a = 0; a < 2; a++) {
    check_rel(l.impulse_hooks[a], force[a], 1e-11);
    check_rel(l.impulse_gravity[a], l.mass * o.gravity[a] * STEPS * dt, 1e-12);
    check_rel(l.momentum[a], l.impulse_hooks[a] + l.impulse_gravity[a], 1e-11);
  }
  check_rel(l.moment_hooks[2], moment, 1e-11);
  check_rel(l.gravity, fall, 2e-3); /* gravity has a potential; the kicks end half a step apart */
  assert_true(fabs(l.hooks) < 1e-15);
  assert_true(l.momentum_error < 1e-13 && l.angular_momentum_error < 1e-13);
  assert_true(fabs(l.energy_error) < 2e-3 * l.gravity && l.gravity > 0.0);
  unmake(&b);
  sph_context_destroy(ctx);
}

/* What the host does to V between steps shows as an error, by its size. */
static void test_host_writes(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_total_lagrangian_options o = audited();
  tl_body b = make(ctx, 2, &o, 0.1);
  advance(&b, 0, 3, 0.02);
  values(&b, SPH_FIELD_V)[0] += 0.5;
  check_ok(sph_particles_touch(b.set, SPH_FIELD_V));
  advance(&b, 3, 5, 0.02);
  check_rel(balance(&b, 0.1).momentum_error, 0.5 * values(&b, SPH_FIELD_M)[0], 1e-10);
  check_ok(sph_total_lagrangian_start(b.tl, b.set)); /* begins anew */
  assert_true(isnan(balance(&b, 0.0).momentum_error));
  advance(&b, 0, 2, 0.02);
  assert_true(balance(&b, 0.04).momentum_error < 1e-13);
  unmake(&b);
  sph_context_destroy(ctx);
}

/* ---- calls and failures ------------------------------------------------------------------ */

static void test_without_audit(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_total_lagrangian_options o = defaults();
  tl_body b = make(ctx, 2, &o, 0.1);
  advance(&b, 0, 2, 0.02);
  const sph_total_lagrangian_ledger l = balance(&b, 0.04);
  assert_true(isnan(l.viscous) && isnan(l.gravity) && isnan(l.hooks) && isnan(l.energy_error));
  assert_true(isnan(l.impulse_form[0]) && isnan(l.moment_hooks[2]) && isnan(l.momentum_error));
  assert_true(l.kinetic > 0.0 && l.mass > 0.0 && l.size == sizeof l);
  sph_total_lagrangian *tl = NULL;
  o = audited();
  o.dim = 2;
  o.integrator = SPH_INTEGRATOR_RK4;
  check_status(sph_total_lagrangian_create(ctx, &o, b.material, &tl), SPH_ERR_UNSUPPORTED);
  assert_null(tl);
  unmake(&b);
  sph_context_destroy(ctx);
}

static void test_calls(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_total_lagrangian_options o = audited();
  tl_body b = make(ctx, 2, &o, 0.1), other = {.ctx = ctx};
  sph_total_lagrangian_ledger l = {.size = 0, .mass = 7.0};
  check_status(sph_total_lagrangian_balance(b.tl, b.set, 0.0, NULL), SPH_ERR_ARG);
  check_status(sph_total_lagrangian_balance(b.tl, b.set, 0.0, &l), SPH_ERR_ARG);
  assert_true(l.mass == 7.0);
  sph_total_lagrangian_ledger_init(&l);
  assert_true(l.mass == 0.0);
  fill(&other, 2, 0.0);
  check_status(sph_total_lagrangian_balance(b.tl, other.set, 0.0, &l), SPH_ERR_STATE);
  sph_particles_destroy(other.set);
  struct {
    size_t size;
    double time, mass;
  } older = {sizeof older, 0.0, 0.0}; /* of a host built with a shorter ledger */
  check_ok(sph_total_lagrangian_balance(b.tl, b.set, 0.0, (sph_total_lagrangian_ledger *)&older));
  assert_true(older.mass > 0.0 && older.size == sizeof older);
  unmake(&b);
  sph_context_destroy(ctx);
}

static int32_t refuse_later(void *user, double t, sph_particles *set, const sph_rate *rates,
                            int32_t count) {
  (void)set;
  (void)rates;
  (void)count;
  return t > 0.05 ? *(int *)user : 0;
}

/* A failed step is not in the ledger, and the step that is then taken is. */
static void test_failed_step(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_total_lagrangian_options o = audited();
  o.gravity[1] = -1.0;
  tl_body b = make(ctx, 2, &o, 0.2);
  int answer = 1;
  check_ok(sph_rhs_set_prepare(sph_total_lagrangian_rhs(b.tl), refuse_later, &answer));
  advance(&b, 0, 1, 0.04);
  const sph_total_lagrangian_ledger before = balance(&b, 0.04);
  check_status(sph_total_lagrangian_step(b.tl, b.set, 0.04, 0.04), SPH_RETRY);
  answer = 0;
  const sph_total_lagrangian_ledger after = balance(&b, 0.04);
  assert_memory_equal(&before, &after, sizeof before);
  advance(&b, 1, 4, 0.04);
  const sph_total_lagrangian_ledger l = balance(&b, 0.16);
  check_rel(l.impulse_gravity[1], -0.16 * l.mass, 1e-12);
  assert_true(l.momentum_error < 1e-13);
  unmake(&b);
  sph_context_destroy(ctx);
}

static sph_status starved(sph_context *ctx, void *user) {
  sph_total_lagrangian_options o = audited();
  tl_body b = {.ctx = ctx};
  sph_total_lagrangian_ledger l;
  (void)user;
  o.dim = 2;
  o.alpha = 0.5;
  sph_total_lagrangian_ledger_init(&l);
  oom_pause();
  b.material = rubber(ctx, 2);
  fill(&b, 2, 0.1);
  oom_resume();
  sph_status s = sph_total_lagrangian_create(ctx, &o, b.material, &b.tl);
  if (!s) s = sph_total_lagrangian_start(b.tl, b.set);
  if (!s) s = sph_total_lagrangian_step(b.tl, b.set, 0.0, 0.01);
  if (!s) s = sph_total_lagrangian_balance(b.tl, b.set, 0.01, &l);
  assert_true((l.mass > 0.0) == (s == SPH_OK));
  unmake(&b);
  return s;
}

static void test_memory(void **state) {
  (void)state;
  oom_sweep(starved, NULL);
}

/* A steady step with the ledger allocates nothing. */
static void test_steady(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_total_lagrangian_options o = audited();
  o.alpha = 0.5;
  tl_body b = make(ctx, 2, &o, 0.1);
  int64_t before, after;
  advance(&b, 0, 2, 0.01);
  (void)balance(&b, 0.02);
  check_ok(sph_context_memory(ctx, NULL, NULL, &before));
  advance(&b, 2, 4, 0.01);
  (void)balance(&b, 0.04);
  check_ok(sph_context_memory(ctx, NULL, NULL, &after));
  assert_int_equal(before, after);
  unmake(&b);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_free_body),
    cmocka_unit_test(test_viscosity),
    cmocka_unit_test(test_clamp_and_gravity),
    cmocka_unit_test(test_host_writes),
    cmocka_unit_test(test_without_audit),
    cmocka_unit_test(test_calls),
    cmocka_unit_test(test_failed_step),
    cmocka_unit_test(test_memory),
    cmocka_unit_test(test_steady),
};
SPH_TEST_MAIN(tests)
