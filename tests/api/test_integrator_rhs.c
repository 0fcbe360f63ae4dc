/* A composed right-hand side in every integrator: an elastic wave runs, repeats to the bit with any
 * number of threads, and a step that is given up leaves no trace. */
#include "../rhs_help.h"

enum { N = 120, STEPS = 40 };

static const int32_t methods[] = {
    SPH_INTEGRATOR_EULER,    SPH_INTEGRATOR_PC2, SPH_INTEGRATOR_HEUN,
    SPH_INTEGRATOR_SSPRK3,   SPH_INTEGRATOR_RK4, SPH_INTEGRATOR_RK38,
    SPH_INTEGRATOR_LEAPFROG, SPH_INTEGRATOR_RKC, SPH_INTEGRATOR_LEAPFROG_PREDICTED};
enum { METHODS = sizeof methods / sizeof *methods };

/* A bar of unit stiffness and density, wave speed 1, spacing 1 / N. */
typedef struct bar {
  sph_context *ctx;
  rh_system s;
  sph_material *material;
  sph_rhs *rhs;
  sph_integrator *it;
} bar;

static void fill_bar(bar *b) {
  double *x = rh_field(&b->s, SPH_FIELD_X), *v = rh_field(&b->s, SPH_FIELD_V);
  double dp = 1.0 / N, *sigma = rh_field(&b->s, SPH_FIELD_SIGMA);
  for (int i = 0; i < N; i++) {
    double y = ((i + 0.5) * dp - 0.5) / 0.08;
    x[i] = (i + 0.5) * dp;
    v[i] = 1e-3 * exp(-y * y);
    sigma[i] = -v[i]; /* runs to the right */
    rh_field(&b->s, SPH_FIELD_M)[i] = dp;
    rh_field(&b->s, SPH_FIELD_RHO)[i] = rh_field(&b->s, SPH_FIELD_C)[i] = 1.0;
    rh_field(&b->s, SPH_FIELD_H)[i] = 1.5 * dp;
  }
  check_ok(sph_particles_touch(b->s.set, SPH_FIELD_X));
}

static void make_model(bar *b) {
  static const int32_t kinds[] = {SPH_TERM_STRESS, SPH_TERM_STRESS_RATE, SPH_TERM_MONAGHAN,
                                  SPH_TERM_MOTION};
  sph_hooke_options o;
  sph_hooke_options_init(&o);
  o.young = o.density = 1.0;
  check_ok(sph_material_create_hooke(b->ctx, &o, &b->material));
  b->rhs = rh_rhs(&b->s);
  for (int k = 0; k < 4; k++) {
    sph_term t = rh_term(kinds[k], 0, 0);
    if (kinds[k] == SPH_TERM_STRESS) t.form = SPH_STRESS_DIFFERENCE;
    t.alpha = 0.5;
    check_ok(sph_rhs_add(b->rhs, &t));
  }
  check_ok(sph_rhs_set_material(b->rhs, 0, b->material));
}

static bar make_bar(sph_context *ctx, int32_t method) {
  static const int32_t fields[] = {SPH_FIELD_X, SPH_FIELD_V, SPH_FIELD_SIGMA};
  bar b = {.ctx = ctx, .s = {.ctx = ctx, .dim = 1, .n = N, .rows = N}};
  sph_particles_options po;
  sph_integrator_options o;
  sph_particles_options_init(&po);
  po.dim = 1;
  check_ok(sph_particles_create(ctx, &po, &b.s.set));
  check_ok(sph_particles_add(b.s.set, N, NULL));
  check_ok(sph_kernel_create(ctx, SPH_KERNEL_CUBIC_SPLINE, 1, &b.s.kernel));
  check_ok(sph_neighbors_create(ctx, NULL, &b.s.list));
  fill_bar(&b);
  make_model(&b);
  sph_integrator_options_init(&o);
  o.method = method;
  check_ok(sph_integrator_create(ctx, &o, &b.it));
  for (int k = 0; k < 3; k++) check_ok(sph_integrator_bind_field(b.it, fields[k]));
  check_ok(sph_integrator_set_rhs(b.it, b.rhs, b.s.list));
  return b;
}

static void free_bar(bar *b) {
  sph_integrator_destroy(b->it);
  sph_rhs_destroy(b->rhs);
  sph_material_destroy(b->material);
  rh_free(&b->s);
}

/* X, V, SIGMA. */
static void state_of(const bar *b, double *out) {
  memcpy(out, rh_field(&b->s, SPH_FIELD_X), N * sizeof *out);
  memcpy(out + N, rh_field(&b->s, SPH_FIELD_V), N * sizeof *out);
  memcpy(out + 2 * N, rh_field(&b->s, SPH_FIELD_SIGMA), N * sizeof *out);
}

static void odd_for(void *user, int64_t count, int64_t grain, sph_loop_fn body, void *job) {
  int64_t piece = grain / 2 + 3;
  (void)user;
  for (int64_t k = (count - 1) / piece; k >= 0; k--)
    body(job, k * piece, (k + 1) * piece < count ? (k + 1) * piece : count, (int32_t)(k % 2));
}

static sph_context *context_of(int32_t threads) {
  sph_context_options o;
  sph_context *ctx = NULL;
  if (threads > 0) return rh_context(threads);
  sph_context_options_init(&o);
  o.parallel_for = odd_for;
  o.workers = 2;
  check_ok(sph_context_create(&o, &ctx));
  return ctx;
}

static void run(int32_t threads, int32_t method, double *out) {
  sph_context *ctx = context_of(threads);
  bar b = make_bar(ctx, method);
  double dt = 0.2 / N;
  for (int k = 0; k < STEPS; k++) check_ok(sph_integrator_step(b.it, b.s.set, k * dt, dt, NULL));
  state_of(&b, out);
  free_bar(&b);
  sph_context_destroy(ctx);
}

/* The pulse has moved by its way, and little of it is lost. */
static void test_wave(void **state) {
  (void)state;
  double way = STEPS * 0.2 / N;
  for (int m = 0; m < METHODS; m++) {
    double out[3 * N], worst = 0.0;
    run(1, methods[m], out);
    assert_true(isfinite(rh_largest(out, 3 * N)));
    for (int i = 0; i < N; i++) {
      double y = ((i + 0.5) / N - 0.5 - way) / 0.08;
      worst = fmax(worst, fabs(out[N + i] - 1e-3 * exp(-y * y)));
    }
    if (worst > 5e-5) print_error("method %d: %g\n", methods[m], worst);
    assert_true(worst <= 5e-5);
  }
}

static void test_threads(void **state) {
  (void)state;
  static const int32_t threads[] = {2, 3, 8, 0};
  for (int m = 0; m < METHODS; m++) {
    double one[3 * N], many[3 * N];
    run(1, methods[m], one);
    for (int k = 0; k < 4; k++) {
      run(threads[k], methods[m], many);
      assert_memory_equal(many, one, sizeof one);
    }
  }
}

/* --- steps that are given up ------------------------------------------------------------- */

typedef struct refusal {
  int32_t at, calls, answer;
} refusal;

static int32_t refuse(void *user, double t, sph_particles *set, const sph_rate *rates,
                      int32_t count) {
  refusal *r = (refusal *)user;
  (void)t;
  (void)set;
  (void)rates;
  (void)count;
  return r->calls++ == r->at ? r->answer : 0;
}

/* In each stage in turn, from either hook: the fields are as before, and the step can be done. */
static void check_refusals(int32_t method, int finish) {
  sph_context *ctx = rh_context(1);
  bar b = make_bar(ctx, method);
  double before[3 * N], after[3 * N], done[3 * N], dt = 0.2 / N;
  bar free_run = make_bar(ctx, method);
  check_ok(sph_integrator_step(free_run.it, free_run.s.set, 0.0, dt, NULL));
  state_of(&free_run, done);
  state_of(&b, before);
  refusal r = {.at = 0};
  check_ok(finish ? sph_rhs_set_finish(b.rhs, refuse, &r) : sph_rhs_set_prepare(b.rhs, refuse, &r));
  for (r.at = 0; r.at < 1000; r.at++) {
    r.calls = 0;
    r.answer = r.at % 2 ? -1 : 1;
    sph_status status = sph_integrator_step(b.it, b.s.set, 0.0, dt, NULL);
    if (r.calls <= r.at) { /* the step was over before */
      check_ok(status);
      break;
    }
    check_status(status, r.answer > 0 ? SPH_RETRY : SPH_ERR_CALLBACK);
    state_of(&b, after);
    assert_memory_equal(after, before, sizeof before);
  }
  assert_true(r.at > 0 && r.at < 1000);
  state_of(&b, after);
  if (method != SPH_INTEGRATOR_RKC) assert_memory_equal(after, done, sizeof done);
  for (int k = 0; k < 3 * N; k++) check_close(after[k], done[k], 1e-9);
  free_bar(&free_run);
  free_bar(&b);
  sph_context_destroy(ctx);
}

static void test_given_up(void **state) {
  (void)state;
  for (int m = 0; m < METHODS; m++)
    for (int finish = 0; finish < 2; finish++) check_refusals(methods[m], finish);
}

/* Save and restore around composed steps: the second go has the bits of the first. */
static void test_repeat(void **state) {
  (void)state;
  for (int m = 0; m < METHODS; m++) {
    sph_context *ctx = rh_context(1);
    bar b = make_bar(ctx, methods[m]);
    double first[3 * N], second[3 * N], dt = 0.2 / N;
    for (int k = 0; k < 3; k++) check_ok(sph_integrator_step(b.it, b.s.set, k * dt, dt, NULL));
    check_ok(sph_integrator_save(b.it, b.s.set));
    for (int k = 3; k < 6; k++) check_ok(sph_integrator_step(b.it, b.s.set, k * dt, dt, NULL));
    state_of(&b, first);
    check_ok(sph_integrator_restore(b.it, b.s.set));
    for (int k = 3; k < 6; k++) check_ok(sph_integrator_step(b.it, b.s.set, k * dt, dt, NULL));
    state_of(&b, second);
    assert_memory_equal(second, first, sizeof first);
    free_bar(&b);
    sph_context_destroy(ctx);
  }
}

/* What the right-hand side refuses, the step refuses with the same sentence. */
static void test_refusals_pass(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  bar b = make_bar(ctx, SPH_INTEGRATOR_RK4);
  double before[3 * N], after[3 * N];
  state_of(&b, before);
  check_ok(sph_rhs_set_material(b.rhs, 0, NULL));
  check_status(sph_integrator_step(b.it, b.s.set, 0.0, 1e-3, NULL), SPH_ERR_STATE);
  assert_non_null(strstr(sph_context_last_error(ctx), "phase 0"));
  state_of(&b, after);
  assert_memory_equal(after, before, sizeof before);
  check_status(sph_integrator_set_rhs(b.it, NULL, b.s.list), SPH_ERR_ARG);
  check_status(sph_integrator_set_rhs(b.it, b.rhs, NULL), SPH_ERR_ARG);
  check_status(sph_integrator_set_rhs(b.it, (sph_rhs *)b.it, b.s.list), SPH_ERR_HANDLE);
  check_status(sph_integrator_set_rhs(b.it, b.rhs, (sph_neighbors *)b.it), SPH_ERR_HANDLE);
  check_status(sph_integrator_step(b.it, NULL, 0.0, 1e-3, NULL), SPH_ERR_ARG);
  free_bar(&b);
  sph_context_destroy(ctx);
}

/* Steps of a composed right-hand side allocate nothing once everything has its size. */
static void test_steady(void **state) {
  (void)state;
  for (int m = 0; m < METHODS; m++) {
    sph_context *ctx = rh_context(2);
    bar b = make_bar(ctx, methods[m]);
    int64_t before = 0, after = 0;
    double dt = 0.2 / N;
    for (int k = 0; k < 12; k++) {
      if (k == 6) check_ok(sph_context_memory(ctx, NULL, NULL, &before));
      check_ok(sph_integrator_step(b.it, b.s.set, k * dt, dt, NULL));
    }
    check_ok(sph_context_memory(ctx, NULL, NULL, &after));
    assert_int_equal(after, before);
    free_bar(&b);
    sph_context_destroy(ctx);
  }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_wave),          cmocka_unit_test(test_threads),
    cmocka_unit_test(test_given_up),      cmocka_unit_test(test_repeat),
    cmocka_unit_test(test_refusals_pass), cmocka_unit_test(test_steady),
};
SPH_TEST_MAIN(tests)
