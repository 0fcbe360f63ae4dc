/* The scheme total_lagrangian: what it prepares, its leapfrog against a step by hand, what it keeps
 * over many periods, failures, memory, threads. */
#include "../oom.h"
#include "../total_lagrangian_help.h"

/* ---- preparing ------------------------------------------------------------------------------- */

static void test_start(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t d = 1; d <= 3; d++) {
    sph_total_lagrangian_options o = defaults();
    o.h_ratio = 1.3;
    tl_body b = make(ctx, d, &o, 0.1);
    int64_t n = sph_particles_count(b.set);
    double speed = 0.0, dt = 0.0;
    sph_material_block block;
    sph_material_block_init(&block);
    block.dim = d;
    block.n = 1;
    check_ok(sph_material_sound_speed(b.material, &block, &speed));
    assert_memory_equal(values(&b, SPH_FIELD_X0), values(&b, SPH_FIELD_X),
                        (size_t)(n * d) * sizeof(double));
    for (int64_t i = 0; i < n; i++) {
      check_rel(values(&b, SPH_FIELD_H)[i], 1.3 * 0.5, 1e-14);
      check_rel(values(&b, SPH_FIELD_C)[i], speed, 1e-14);
    }
    check_ok(sph_total_lagrangian_time_step(b.tl, b.set, &dt));
    check_rel(dt, 0.5 * 0.5 / speed, 1e-14);
    /* the host's own spacing and speeds count */
    values(&b, SPH_FIELD_SPACING)[0] = 0.25;
    values(&b, SPH_FIELD_C)[0] = 7.0;
    check_ok(sph_total_lagrangian_start(b.tl, b.set));
    check_rel(values(&b, SPH_FIELD_H)[0], 1.3 * 0.25, 1e-14);
    check_ok(sph_total_lagrangian_time_step(b.tl, b.set, &dt));
    check_rel(dt, 0.5 * 0.25 / 7.0, 1e-14);
    unmake(&b);
  }
  sph_context_destroy(ctx);
}

/* ---- a step ---------------------------------------------------------------------------------- */

/* Kick, drift, kick with the right-hand side that was handed out. */
static void step_by_hand(const tl_body *b, double t, double dt, double *a) {
  double *x = values(b, SPH_FIELD_X), *v = values(b, SPH_FIELD_V);
  int64_t n = sph_particles_count(b->set) * sph_particles_dim(b->set);
  sph_rate rate = {SPH_FIELD_V, a};
  sph_rhs *rhs = sph_total_lagrangian_rhs(b->tl);
  sph_neighbors *list = sph_total_lagrangian_list(b->tl);
  check_ok(sph_rhs_evaluate(rhs, b->set, list, t, &rate, 1));
  for (int64_t k = 0; k < n; k++) v[k] += 0.5 * dt * a[k];
  for (int64_t k = 0; k < n; k++) x[k] += dt * v[k];
  check_ok(sph_particles_touch(b->set, SPH_FIELD_X));
  check_ok(sph_rhs_evaluate(rhs, b->set, list, t + dt, &rate, 1));
  for (int64_t k = 0; k < n; k++) v[k] += 0.5 * dt * a[k];
}

static void test_step(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t d = 1; d <= 3; d++) {
    sph_total_lagrangian_options o = defaults();
    o.gravity[0] = -0.3;
    tl_body b = make(ctx, d, &o, 0.2), c = make(ctx, d, &o, 0.2);
    int64_t n = sph_particles_count(b.set) * d;
    double *a = rh_array(n), dt = 0.02;
    for (int k = 0; k < 5; k++) {
      check_ok(sph_total_lagrangian_step(b.tl, b.set, k * dt, dt));
      step_by_hand(&c, k * dt, dt, a);
    }
    assert_memory_equal(values(&b, SPH_FIELD_X), values(&c, SPH_FIELD_X), (size_t)n * sizeof *a);
    assert_memory_equal(values(&b, SPH_FIELD_V), values(&c, SPH_FIELD_V), (size_t)n * sizeof *a);
    free(a);
    unmake(&b);
    unmake(&c);
  }
  sph_context_destroy(ctx);
}

static int32_t count_calls(void *user, double t, sph_particles *set, const sph_rate *rates,
                           int32_t count) {
  (void)t;
  (void)set;
  (void)rates;
  (void)count;
  ++*(int *)user;
  return 0;
}

/* One evaluation a step; another when the host touches X or V, or jumps in time. Asking for the
 * energy changes nothing. */
static void test_kept_acceleration(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_total_lagrangian_options o = defaults();
  o.alpha = 0.3; /* so that the acceleration depends on the velocity */
  tl_body b = make(ctx, 2, &o, 0.2), c = make(ctx, 2, &o, 0.2);
  int calls = 0;
  check_ok(sph_rhs_set_finish(sph_total_lagrangian_rhs(b.tl), count_calls, &calls));
  for (int k = 0; k < 10; k++) {
    check_ok(sph_total_lagrangian_step(b.tl, b.set, k * 0.02, 0.02));
    check_ok(sph_total_lagrangian_step(c.tl, c.set, k * 0.02, 0.02));
    (void)total(&b, (k + 1) * 0.02);
  }
  assert_int_equal(calls, 11);
  assert_memory_equal(values(&b, SPH_FIELD_X), values(&c, SPH_FIELD_X), 2 * 36 * sizeof(double));
  check_ok(sph_particles_touch(b.set, SPH_FIELD_X));
  check_ok(sph_total_lagrangian_step(b.tl, b.set, 0.2, 0.02));
  assert_int_equal(calls, 13);
  check_ok(sph_particles_touch(b.set, SPH_FIELD_V));
  check_ok(sph_total_lagrangian_step(b.tl, b.set, 0.22, 0.02));
  assert_int_equal(calls, 15);
  check_ok(sph_total_lagrangian_step(b.tl, b.set, 5.0, 0.02));
  assert_int_equal(calls, 17);
  unmake(&b);
  unmake(&c);
  sph_context_destroy(ctx);
}

/* Back in time to where it came from. */
static void test_reversible(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_total_lagrangian_options o = defaults();
  tl_body b = make(ctx, 2, &o, 0.2);
  double begin[72], *x = values(&b, SPH_FIELD_X), far = 0.0;
  memcpy(begin, x, sizeof begin);
  for (int k = 0; k < 200; k++) check_ok(sph_total_lagrangian_step(b.tl, b.set, k * 0.05, 0.05));
  for (int k = 0; k < 72; k++) far = fmax(far, fabs(x[k] - begin[k]));
  assert_true(far > 0.1);
  for (int k = 200; k > 0; k--) check_ok(sph_total_lagrangian_step(b.tl, b.set, k * 0.05, -0.05));
  for (int k = 0; k < 72; k++) check_close(x[k], begin[k], 1e-9);
  unmake(&b);
  sph_context_destroy(ctx);
}

/* ---- conservation ---------------------------------------------------------------------------- */

typedef struct sums {
  double linear[3], angular[3];
} sums;

static sums momenta(const tl_body *b) {
  sums s = {{0}, {0}};
  int d = sph_particles_dim(b->set);
  const double *x = values(b, SPH_FIELD_X), *v = values(b, SPH_FIELD_V);
  const double *m = values(b, SPH_FIELD_M);
  for (int64_t i = 0; i < sph_particles_count(b->set); i++)
    for (int k = 0; k < d; k++) {
      int l = (k + 1) % d;
      s.linear[k] += m[i] * v[i * d + k];
      if (d > 1) s.angular[k] += m[i] * (x[i * d + k] * v[i * d + l] - x[i * d + l] * v[i * d + k]);
    }
  return s;
}

/* Some twenty periods of the slowest mode. Leapfrog keeps both momenta to rounding and the energy
 * near its start, with no trend; RK4 loses some in the fastest modes. */
static void check_periods(sph_context *ctx, int32_t d, int32_t integrator, double energy_bound,
                          double turn_bound) {
  sph_total_lagrangian_options o = defaults();
  o.integrator = integrator;
  o.cfl = 0.25;
  tl_body b = make(ctx, d, &o, 0.15);
  double dt, energy = total(&b, 0.0), most[2] = {0.0, 0.0};
  sums first = momenta(&b);
  check_ok(sph_total_lagrangian_time_step(b.tl, b.set, &dt));
  int steps = check_long_run && integrator == SPH_INTEGRATOR_LEAPFROG ? 20000 : 1500;
  for (int k = 0; k < steps; k++) {
    check_ok(sph_total_lagrangian_step(b.tl, b.set, k * dt, dt));
    if (k % 10) continue;
    double *half = &most[2 * k >= steps];
    *half = fmax(*half, fabs(total(&b, (k + 1) * dt) - energy));
  }
  sums last = momenta(&b);
  for (int half = 0; half < 2; half++)
    if (!(most[half] <= energy_bound * energy))
      fail_msg("%d-D, integrator %d: energy off by %g of %g", d, integrator, most[half], energy);
  if (integrator == SPH_INTEGRATOR_LEAPFROG) assert_true(most[1] <= 1.2 * most[0]);
  for (int k = 0; k < 3; k++) {
    check_close(last.linear[k], first.linear[k], 1e-12);
    check_close(last.angular[k], first.angular[k], turn_bound);
  }
  unmake(&b);
}

static void test_periods(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t d = 1; d <= 3; d++) {
    if (d == 3 && !check_long_run) continue; /* has its example */
    check_periods(ctx, d, SPH_INTEGRATOR_LEAPFROG, 2e-2, 1e-12);
    check_periods(ctx, d, SPH_INTEGRATOR_RK4, 1e-2, 1e-3);
  }
  sph_context_destroy(ctx);
}

/* The energy error of the leapfrog falls with the square of the step. */
static void test_energy_order(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  double error[2];
  for (int fine = 0; fine < 2; fine++) {
    sph_total_lagrangian_options o = defaults();
    tl_body b = make(ctx, 2, &o, 0.15);
    int steps = fine ? 200 : 100;
    double dt = 5.0 / steps, energy = total(&b, 0.0);
    error[fine] = 0.0;
    for (int k = 0; k < steps; k++) {
      check_ok(sph_total_lagrangian_step(b.tl, b.set, k * dt, dt));
      error[fine] = fmax(error[fine], fabs(total(&b, (k + 1) * dt) - energy));
    }
    unmake(&b);
  }
  assert_true(error[0] > 3.5 * error[1] && error[0] < 4.5 * error[1]);
  sph_context_destroy(ctx);
}

/* Gravity and viscosity: free fall of an undeformed body is exact, and viscosity only takes. */
static void test_gravity_and_viscosity(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_total_lagrangian_options o = defaults();
  o.gravity[1] = -2.0;
  tl_body b = make(ctx, 2, &o, 0.0);
  double at = values(&b, SPH_FIELD_X)[1], energy = total(&b, 0.0);
  for (int k = 0; k < 50; k++) check_ok(sph_total_lagrangian_step(b.tl, b.set, k * 0.02, 0.02));
  check_close(values(&b, SPH_FIELD_X)[1], at - 1.0, 1e-13);
  check_close(total(&b, 1.0), energy, 1e-12);
  unmake(&b);
  o = defaults();
  o.alpha = 1.0;
  o.beta = 1.0;
  b = make(ctx, 2, &o, 0.2);
  double last = total(&b, 0.0), begin = last;
  for (int k = 0; k < 200; k++) {
    check_ok(sph_total_lagrangian_step(b.tl, b.set, k * 0.02, 0.02));
    double now = total(&b, (k + 1) * 0.02);
    assert_true(now < last + 1e-4 * begin); /* but for what the leapfrog sways by */
    last = now;
  }
  assert_true(last < 0.9 * begin);
  unmake(&b);
  sph_context_destroy(ctx);
}

/* ---- machines -------------------------------------------------------------------------------- */

static void test_threads(void **state) {
  (void)state;
  double *x[2];
  for (int many = 0; many < 2; many++) {
    sph_context *ctx = rh_context(many ? 3 : 1);
    sph_total_lagrangian_options o = defaults();
    o.alpha = 0.5;
    tl_body b = make(ctx, 3, &o, 0.2);
    for (int k = 0; k < 20; k++) check_ok(sph_total_lagrangian_step(b.tl, b.set, k * 0.05, 0.05));
    x[many] = rh_array(3 * SIDE * SIDE * SIDE);
    memcpy(x[many], values(&b, SPH_FIELD_X), 3 * SIDE * SIDE * SIDE * sizeof(double));
    unmake(&b);
    sph_context_destroy(ctx);
  }
  assert_memory_equal(x[0], x[1], 3 * SIDE * SIDE * SIDE * sizeof(double));
  free(x[0]);
  free(x[1]);
}

/* ---- failures -------------------------------------------------------------------------------- */

static int32_t refuse_later(void *user, double t, sph_particles *set, const sph_rate *rates,
                            int32_t count) {
  (void)set;
  (void)rates;
  (void)count;
  return t > 0.05 ? *(int *)user : 0;
}

/* A step that fails leaves X and V as they were, and can be repeated. */
static void test_failed_step(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t method = 0; method < 2; method++) {
    sph_total_lagrangian_options o = defaults();
    if (method) o.integrator = SPH_INTEGRATOR_RK4;
    tl_body b = make(ctx, 2, &o, 0.2);
    double x[72], v[72];
    int answer = 1;
    memcpy(x, values(&b, SPH_FIELD_X), sizeof x);
    memcpy(v, values(&b, SPH_FIELD_V), sizeof v);
    check_ok(sph_rhs_set_prepare(sph_total_lagrangian_rhs(b.tl), refuse_later, &answer));
    check_status(sph_total_lagrangian_step(b.tl, b.set, 0.0, 0.1), SPH_RETRY);
    answer = -1;
    check_status(sph_total_lagrangian_step(b.tl, b.set, 0.0, 0.1), SPH_ERR_CALLBACK);
    assert_memory_equal(x, values(&b, SPH_FIELD_X), sizeof x);
    assert_memory_equal(v, values(&b, SPH_FIELD_V), sizeof v);
    check_ok(sph_total_lagrangian_step(b.tl, b.set, 0.0, 0.05));
    memcpy(x, values(&b, SPH_FIELD_X), sizeof x);
    check_ok(sph_rhs_set_prepare(sph_total_lagrangian_rhs(b.tl), NULL, NULL));
    check_status(sph_total_lagrangian_step(b.tl, b.set, 0.05, 1e3), SPH_ERR_NUMERIC);
    assert_memory_equal(x, values(&b, SPH_FIELD_X), sizeof x);
    values(&b, SPH_FIELD_V)[3] = NAN;
    check_ok(sph_particles_touch(b.set, SPH_FIELD_V));
    check_status(sph_total_lagrangian_step(b.tl, b.set, 0.05, 0.01), SPH_ERR_NUMERIC);
    assert_memory_equal(x, values(&b, SPH_FIELD_X), sizeof x);
    unmake(&b);
  }
  sph_context_destroy(ctx);
}

static void refused(sph_context *ctx, sph_material *m, sph_total_lagrangian_options o,
                    sph_status want) {
  sph_total_lagrangian *tl = (sph_total_lagrangian *)&o;
  check_status(sph_total_lagrangian_create(ctx, &o, m, &tl), want);
  assert_null(tl);
}

static void test_options(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_material *m = rubber(ctx, 2);
  sph_total_lagrangian *tl = NULL;
  sph_total_lagrangian_options o = defaults(), good = defaults();
  good.dim = 2;
  refused(ctx, m, o, SPH_ERR_ARG); /* dim must be given */
  check_status(sph_total_lagrangian_create(ctx, NULL, m, &tl), SPH_ERR_ARG);
  check_status(sph_total_lagrangian_create(ctx, &good, m, NULL), SPH_ERR_ARG);
  check_status(sph_total_lagrangian_create(NULL, &good, m, &tl), SPH_ERR_ARG);
  check_status(sph_total_lagrangian_create(ctx, &good, NULL, &tl), SPH_ERR_ARG);
  check_status(sph_total_lagrangian_create(ctx, &good, (sph_material *)ctx, &tl), SPH_ERR_HANDLE);
  double *numbers[] = {&o.h_ratio, &o.cfl,        &o.hourglass, &o.alpha,
                       &o.beta,    &o.gravity[0], &o.gravity[2]};
  for (int k = 0; k < 7; k++)
    for (int bad = 0; bad < 3; bad++) {
      o = good;
      *numbers[k] = bad == 0 ? NAN : bad == 1 ? INFINITY : -1.0;
      if (bad < 2 || k < 5) refused(ctx, m, o, SPH_ERR_ARG);
    }
  o = good;
  o.h_ratio = 0.0;
  refused(ctx, m, o, SPH_ERR_ARG);
  int32_t *choices[] = {&o.kernel, &o.form, &o.hourglass_form, &o.integrator, &o.dim};
  for (int k = 0; k < 5; k++) {
    o = good;
    *choices[k] = 99;
    refused(ctx, m, o, SPH_ERR_ARG);
  }
  o = good;
  o.integrator = SPH_INTEGRATOR_RKC;
  refused(ctx, m, o, SPH_ERR_UNSUPPORTED);
  struct {
    sph_total_lagrangian_options o;
    double later;
  } newer = {good, 1.0};
  newer.o.size = sizeof newer;
  check_status(sph_total_lagrangian_create(ctx, &newer.o, m, &tl), SPH_ERR_VERSION);
  newer.later = 0.0;
  check_ok(sph_total_lagrangian_create(ctx, &newer.o, m, &tl));
  sph_total_lagrangian_destroy(tl);
  sph_total_lagrangian_destroy(NULL);
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

static void test_calls(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_total_lagrangian_options o = defaults();
  tl_body b = make(ctx, 2, &o, 0.1), flat = {.ctx = ctx};
  sph_total_lagrangian_energies e = {.size = sizeof e}, small = {.size = 8};
  double dt;
  assert_null(sph_total_lagrangian_rhs(NULL));
  assert_null(sph_total_lagrangian_list(NULL));
  check_status(sph_total_lagrangian_step(b.tl, b.set, 0.0, 0.0), SPH_ERR_ARG);
  check_status(sph_total_lagrangian_step(b.tl, b.set, 0.0, NAN), SPH_ERR_ARG);
  check_status(sph_total_lagrangian_step(b.tl, b.set, INFINITY, 0.1), SPH_ERR_ARG);
  check_status(sph_total_lagrangian_energy(b.tl, b.set, 0.0, NULL), SPH_ERR_ARG);
  check_status(sph_total_lagrangian_energy(b.tl, b.set, 0.0, &small), SPH_ERR_ARG);
  check_status(sph_total_lagrangian_time_step(b.tl, b.set, NULL), SPH_ERR_ARG);
  fill(&flat, 1, 0.0);
  check_status(sph_total_lagrangian_start(b.tl, flat.set), SPH_ERR_ARG);
  sph_particles_destroy(flat.set);
  fill(&flat, 2, 0.0);
  check_status(sph_total_lagrangian_step(b.tl, flat.set, 0.0, 0.1), SPH_ERR_STATE);
  check_status(sph_total_lagrangian_time_step(b.tl, flat.set, &dt), SPH_ERR_STATE);
  check_status(sph_total_lagrangian_energy(b.tl, flat.set, 0.0, &e), SPH_ERR_STATE);
  values(&flat, SPH_FIELD_M)[7] = 0.0;
  check_status(sph_total_lagrangian_start(b.tl, flat.set), SPH_ERR_ARG);
  assert_non_null(strstr(sph_context_last_error(ctx), "particle 7"));
  values(&flat, SPH_FIELD_M)[7] = 1.0;
  values(&flat, SPH_FIELD_RHO)[5] = NAN;
  check_status(sph_total_lagrangian_start(b.tl, flat.set), SPH_ERR_ARG);
  assert_non_null(strstr(sph_context_last_error(ctx), "particle 5"));
  sph_particles_destroy(flat.set);
  unmake(&b);
  sph_context_destroy(ctx);
}

/* An empty set can be started and stepped, but has no time step. */
static void test_empty(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_total_lagrangian_options o = defaults();
  tl_body b = make(ctx, 2, &o, 0.1);
  sph_particles_options p;
  sph_particles *none;
  double dt, *a;
  sph_particles_options_init(&p);
  p.dim = 2;
  check_ok(sph_particles_create(ctx, &p, &none));
  check_status(sph_total_lagrangian_start(b.tl, none), SPH_ERR_ARG);
  check_ok(sph_particles_field(none, SPH_FIELD_M, &a));
  check_ok(sph_particles_field(none, SPH_FIELD_RHO, &a));
  check_ok(sph_total_lagrangian_start(b.tl, none));
  check_status(sph_total_lagrangian_time_step(b.tl, none, &dt), SPH_ERR_NUMERIC);
  check_ok(sph_total_lagrangian_step(b.tl, none, 0.0, 0.1));
  sph_particles_destroy(none);
  unmake(&b);
  sph_context_destroy(ctx);
}

/* ---- memory ---------------------------------------------------------------------------------- */

static sph_status starved(sph_context *ctx, void *user) {
  sph_total_lagrangian_options o = defaults();
  tl_body b = {.ctx = ctx};
  double x[72];
  sph_total_lagrangian_energies e = {.size = sizeof e};
  o.dim = 2;
  o.integrator = *(const int32_t *)user;
  oom_pause();
  b.material = rubber(ctx, 2);
  fill(&b, 2, 0.1);
  memcpy(x, values(&b, SPH_FIELD_X), sizeof x);
  oom_resume();
  sph_status s = sph_total_lagrangian_create(ctx, &o, b.material, &b.tl);
  if (!s) s = sph_total_lagrangian_start(b.tl, b.set);
  if (!s) s = sph_total_lagrangian_step(b.tl, b.set, 0.0, 0.01);
  if (s) assert_memory_equal(x, values(&b, SPH_FIELD_X), sizeof x);
  if (!s) s = sph_total_lagrangian_energy(b.tl, b.set, 0.01, &e);
  unmake(&b);
  return s;
}

static void test_memory(void **state) {
  (void)state;
  int32_t methods[] = {SPH_INTEGRATOR_LEAPFROG, SPH_INTEGRATOR_RK4};
  oom_sweep(starved, &methods[0]);
  oom_sweep(starved, &methods[1]);
}

static void test_steady(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_total_lagrangian_options o = defaults();
  tl_body b = make(ctx, 2, &o, 0.1);
  int64_t before, after;
  check_ok(sph_total_lagrangian_step(b.tl, b.set, 0.0, 0.01));
  (void)total(&b, 0.01);
  check_ok(sph_context_memory(ctx, NULL, NULL, &before));
  check_ok(sph_total_lagrangian_step(b.tl, b.set, 0.01, 0.01));
  (void)total(&b, 0.02);
  check_ok(sph_context_memory(ctx, NULL, NULL, &after));
  assert_int_equal(before, after);
  unmake(&b);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_start),
    cmocka_unit_test(test_step),
    cmocka_unit_test(test_kept_acceleration),
    cmocka_unit_test(test_reversible),
    cmocka_unit_test(test_periods),
    cmocka_unit_test(test_energy_order),
    cmocka_unit_test(test_gravity_and_viscosity),
    cmocka_unit_test(test_threads),
    cmocka_unit_test(test_failed_step),
    cmocka_unit_test(test_options),
    cmocka_unit_test(test_calls),
    cmocka_unit_test(test_empty),
    cmocka_unit_test(test_memory),
    cmocka_unit_test(test_steady),
};
SPH_TEST_MAIN(tests)
