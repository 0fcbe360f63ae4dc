/* Composed right-hand side: memory that runs out, a steady call, lifetimes, and the same bits for
 * any number of threads. */
#include "../oom.h"
#include "../rhs_help.h"

static sph_status add_all(sph_rhs *rhs, int32_t corrected) {
  sph_status status = SPH_OK;
  for (int32_t kind = 1; status == SPH_OK && kind <= SPH_TERM_ARTIFICIAL_STRESS; kind++) {
    sph_term t = rh_term(kind, 0, corrected && rh_correctable(kind, 1));
    status = sph_rhs_add(rhs, &t);
  }
  return status;
}

static int32_t some_pressure(void *user, const sph_material_block *b, double *p) {
  (void)user;
  for (int64_t i = 0; i < b->n; i++) p[i] = 2.0 * b->rho[i];
  return 0;
}

static int32_t some_stress_rate(void *user, const sph_material_block *b, double *d) {
  (void)user;
  int c = b->dim * (b->dim + 1) / 2, dd = b->dim * b->dim;
  for (int64_t i = 0; i < b->n * c; i++)
    d[i] = b->velocity_gradient[i / c * dd] + 0.1 * b->sigma[i];
  return 0;
}

static sph_status make_material(sph_context *ctx, sph_material **out) {
  sph_material_functions f;
  sph_material_functions_init(&f);
  f.pressure = some_pressure;
  f.stress_rate = some_stress_rate;
  return sph_material_create(ctx, &f, NULL, out);
}

static void host_term(void *user, const sph_pair_block *b, double *out) {
  (void)user;
  for (int32_t k = 0; k < b->count; k++) out[0] += b->w[k] * b->dx[k * b->dim];
}

/* --- out of memory ----------------------------------------------------------------------- */

typedef struct oom_run_state {
  int32_t dim, corrected;
} oom_run_state;

/* V M RHO H C SIGMA for n more particles, with ghosts at the end. */
static void grow(sph_particles *set, int32_t dim, int64_t n, double at) {
  oom_pause();
  rh_system s = {.set = set, .dim = dim};
  check_ok(sph_particles_add(set, n, NULL));
  s.n = sph_particles_count(set);
  rh_seed = 5;
  rh_fill(&s, SPH_FIELD_X, at, at + 4.0, 1);
  rh_fill(&s, SPH_FIELD_V, -1.0, 1.0, 1);
  rh_fill(&s, SPH_FIELD_M, 1.0, 2.0, 1);
  rh_fill(&s, SPH_FIELD_RHO, 1.0, 2.0, 1);
  rh_fill(&s, SPH_FIELD_H, 0.7, 0.9, 1);
  rh_fill(&s, SPH_FIELD_C, 1.0, 2.0, 1);
  rh_fill(&s, SPH_FIELD_SIGMA, -1.0, 1.0, 1);
  oom_resume();
}

static sph_status rates_once(sph_rhs *rhs, sph_particles *set, sph_neighbors *list) {
  static double v[600], x[600], rho[200], sigma[1200];
  sph_rate rates[4] = {
      {SPH_FIELD_V, v}, {SPH_FIELD_X, x}, {SPH_FIELD_RHO, rho}, {SPH_FIELD_SIGMA, sigma}};
  return sph_rhs_evaluate(rhs, set, list, 0.0, rates, 4);
}

/* From nothing, then with more particles, so that every scratch array grows. */
static sph_status scenario(sph_context *ctx, void *user) {
  const oom_run_state *o = (const oom_run_state *)user;
  sph_particles_options po;
  sph_particles *set = NULL;
  sph_kernel *kernel = NULL;
  sph_neighbors *list = NULL;
  sph_material *material = NULL;
  sph_rhs *rhs = NULL;
  sph_particles_options_init(&po);
  po.dim = o->dim;
  sph_status s = sph_kernel_create(ctx, SPH_KERNEL_CUBIC_SPLINE, o->dim, &kernel);
  if (!s) s = sph_particles_create(ctx, &po, &set);
  if (!s) s = sph_neighbors_create(ctx, NULL, &list);
  if (!s) s = make_material(ctx, &material);
  if (!s) s = sph_rhs_create(ctx, kernel, NULL, &rhs);
  if (!s) s = add_all(rhs, o->corrected);
  if (!s) s = sph_rhs_add_host(rhs, SPH_FIELD_V, host_term, NULL);
  if (!s) s = sph_rhs_set_material(rhs, 0, material);
  for (int k = 0; !s && k < 2; k++) {
    grow(set, o->dim, 60 + 60 * k, 0.0);
    s = rates_once(rhs, set, list);
  }
  sph_rhs_destroy(rhs);
  sph_material_destroy(material);
  sph_neighbors_destroy(list);
  sph_particles_destroy(set);
  sph_kernel_destroy(kernel);
  return s;
}

static void test_out_of_memory(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) {
    oom_run_state o = {dim, dim != 2};
    oom_sweep(scenario, &o);
  }
}

/* After a refusal the same call succeeds, with the rates it would have had. */
static void test_recovers(void **state) {
  (void)state;
  sph_context *ctx = oom_context();
  rh_system s = rh_make(ctx, 2, 12, RH_VARY_ALL, 30);
  double *want = NULL;
  for (int64_t refuse = -1; refuse < 200; refuse++) {
    sph_rhs *rhs = rh_rhs(&s);
    sph_material *m = NULL;
    check_ok(add_all(rhs, 1));
    check_ok(make_material(ctx, &m));
    check_ok(sph_rhs_set_material(rhs, 0, m));
    sph_material_destroy(m);
    double v[288];
    sph_rate rate = {SPH_FIELD_V, v};
    oom.refused = 0;
    oom.once = 1;
    oom.countdown = refuse;
    sph_status status = sph_rhs_evaluate(rhs, s.set, s.list, 0.0, &rate, 1);
    oom.countdown = -1;
    int64_t refused = oom.refused;
    check_status(status, refused ? SPH_ERR_NOMEM : SPH_OK);
    double *got = rh_rates(&s, rhs, SPH_FIELD_V);
    if (!want) {
      want = got;
    } else {
      assert_memory_equal(got, want, 288 * sizeof *got);
      free(got);
    }
    sph_rhs_destroy(rhs);
    if (refuse >= 0 && !refused) break;
    assert_true(refuse < 199);
  }
  free(want);
  rh_free(&s);
  sph_context_destroy(ctx);
  oom_check_clean();
}

/* --- steady calls ------------------------------------------------------------------------ */

static void test_steady(void **state) {
  (void)state;
  for (int32_t method = SPH_NEIGHBORS_ALL_PAIRS; method <= SPH_NEIGHBORS_TREE; method++)
    for (int32_t corrected = 0; corrected < 2; corrected++) {
      sph_context *ctx = rh_context(2);
      rh_system s = rh_make(ctx, 3, 6, RH_GHOSTS, 31);
      sph_neighbors_options o;
      sph_material *m = NULL;
      sph_rhs *rhs = rh_rhs(&s);
      sph_neighbors_options_init(&o);
      o.method = method;
      o.skin = method == SPH_NEIGHBORS_VERLET ? 0.1 : 0.0;
      sph_neighbors_destroy(s.list);
      s.list = NULL;
      check_ok(sph_neighbors_create(ctx, &o, &s.list));
      check_ok(make_material(ctx, &m));
      check_ok(add_all(rhs, corrected));
      check_ok(sph_rhs_add_host(rhs, SPH_FIELD_V, host_term, NULL));
      check_ok(sph_rhs_set_material(rhs, 0, m));
      int64_t before = 0, after = 0;
      double *x = rh_field(&s, SPH_FIELD_X);
      for (int step = 0; step < 12; step++) {
        for (int64_t k = 0; k < s.n * 3; k++) x[k] += step % 2 ? -1e-3 : 1e-3;
        check_ok(sph_particles_touch(s.set, SPH_FIELD_X));
        if (step == 4) check_ok(sph_context_memory(ctx, NULL, NULL, &before));
        static double v[648], dx[648], rho[216], sigma[1296];
        sph_rate rates[4] = {
            {SPH_FIELD_V, v}, {SPH_FIELD_X, dx}, {SPH_FIELD_RHO, rho}, {SPH_FIELD_SIGMA, sigma}};
        check_ok(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, rates, 4));
      }
      check_ok(sph_context_memory(ctx, NULL, NULL, &after));
      assert_int_equal(after, before);
      sph_rhs_destroy(rhs);
      sph_material_destroy(m);
      rh_free(&s);
      sph_context_destroy(ctx);
    }
}

/* --- lifetimes --------------------------------------------------------------------------- */

/* The host gives up kernel, material and context before the right-hand side is used. */
static void test_retained(void **state) {
  (void)state;
  sph_context *ctx = oom_context();
  rh_system s = rh_make(ctx, 2, 12, 0, 32);
  sph_material *m = NULL;
  sph_rhs *rhs = rh_rhs(&s);
  sph_term t = rh_term(SPH_TERM_STRESS_RATE, 0, 0);
  check_ok(make_material(ctx, &m));
  check_ok(sph_rhs_add(rhs, &t));
  check_ok(sph_rhs_set_material(rhs, 0, m));
  double *want = rh_rates(&s, rhs, SPH_FIELD_SIGMA);
  sph_kernel_destroy(s.kernel);
  s.kernel = NULL;
  sph_material_destroy(m);
  sph_context_destroy(ctx);
  double *got = rh_rates(&s, rhs, SPH_FIELD_SIGMA);
  assert_memory_equal(got, want, (size_t)(s.rows * 3) * sizeof *got);
  free(got);
  free(want);
  rh_free(&s);
  sph_rhs_destroy(rhs);
  oom_check_clean();
}

/* One right-hand side for several sets and lists of different size, in turn. */
static void test_several_sets(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system a = rh_make(ctx, 2, 6, 0, 33), b = rh_make(ctx, 2, 20, RH_VARY_ALL, 34);
  sph_material *m = NULL;
  sph_rhs *shared = rh_rhs(&a), *own = rh_rhs(&b);
  check_ok(make_material(ctx, &m));
  check_ok(add_all(shared, 1));
  check_ok(add_all(own, 1));
  check_ok(sph_rhs_set_material(shared, 0, m));
  check_ok(sph_rhs_set_material(own, 0, m));
  for (int k = 0; k < 3; k++) {
    free(rh_rates(&a, shared, SPH_FIELD_V));
    double *x = rh_rates(&b, shared, SPH_FIELD_V), *y = rh_rates(&b, own, SPH_FIELD_V);
    assert_memory_equal(x, y, (size_t)(b.rows * 2) * sizeof *x);
    free(x);
    free(y);
  }
  sph_rhs_destroy(shared);
  sph_rhs_destroy(own);
  sph_material_destroy(m);
  rh_free(&a);
  rh_free(&b);
  sph_context_destroy(ctx);
}

/* --- threads ----------------------------------------------------------------------------- */

/* A host's loop that cuts the range oddly, runs the pieces backwards and lies about the worker. */
static void odd_for(void *user, int64_t count, int64_t grain, sph_loop_fn body, void *job) {
  int64_t piece = grain / 3 + 7, last = (count - 1) / piece;
  (void)user;
  for (int64_t k = last; k >= 0; k--)
    body(job, k * piece, (k + 1) * piece < count ? (k + 1) * piece : count, (int32_t)(k % 3));
}

static sph_context *odd_context(void) {
  sph_context_options o;
  sph_context *ctx = NULL;
  sph_context_options_init(&o);
  o.parallel_for = odd_for;
  o.workers = 3;
  check_ok(sph_context_create(&o, &ctx));
  return ctx;
}

enum { BITS = 3000 * 12 };

static void collect(sph_context *ctx, int32_t dim, int32_t corrected, uint32_t flavour,
                    double *out) {
  rh_system s = rh_make(ctx, dim, dim == 1 ? 2500 : dim == 2 ? 50 : 14, flavour, 35);
  sph_material *m = NULL;
  sph_rhs *rhs = rh_rhs(&s);
  check_ok(make_material(ctx, &m));
  check_ok(add_all(rhs, corrected));
  check_ok(sph_rhs_set_material(rhs, 0, m));
  check_ok(sph_rhs_add_host(rhs, SPH_FIELD_V, host_term, NULL));
  int32_t c = sph_sym_components(dim);
  assert_true(s.rows <= 3000);
  sph_rate rates[4] = {{SPH_FIELD_V, out},
                       {SPH_FIELD_X, out + 3000 * 3},
                       {SPH_FIELD_RHO, out + 3000 * 6},
                       {SPH_FIELD_SIGMA, out + 3000 * 7}};
  if (c == 6) rates[3].field = SPH_FIELD_C; /* 3-D stress rates do not fit, and have their turn */
  check_ok(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, rates, 4));
  sph_rhs_destroy(rhs);
  sph_material_destroy(m);
  rh_free(&s);
}

static void test_threads(void **state) {
  (void)state;
  static const int32_t threads[] = {2, 3, 8, 0};
  static const uint32_t flavours[] = {0, RH_VARY_ALL | RH_GHOSTS};
  static double one[BITS], many[BITS];
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int32_t corrected = 0; corrected < 2; corrected++)
      for (int f = 0; f < 2; f++) {
        sph_context *ctx = rh_context(1);
        memset(one, 0, sizeof one);
        collect(ctx, dim, corrected, flavours[f], one);
        sph_context_destroy(ctx);
        assert_true(rh_largest(one, BITS) > 0.1);
        for (int k = 0; k < 4; k++) {
          ctx = threads[k] ? rh_context(threads[k]) : odd_context();
          memset(many, 0, sizeof many);
          collect(ctx, dim, corrected, flavours[f], many);
          sph_context_destroy(ctx);
          assert_memory_equal(many, one, sizeof one);
        }
      }
}

static void test_threads_3d_stress_rate(void **state) {
  (void)state;
  static const int32_t threads[] = {1, 2, 3, 8, 0};
  double *first = NULL;
  for (int k = 0; k < 5; k++) {
    sph_context *ctx = threads[k] ? rh_context(threads[k]) : odd_context();
    rh_system s = rh_make(ctx, 3, 14, RH_VARY_M, 36);
    sph_material *m = NULL;
    sph_rhs *rhs = rh_rhs(&s);
    check_ok(make_material(ctx, &m));
    check_ok(add_all(rhs, 1));
    check_ok(sph_rhs_set_material(rhs, 0, m));
    double *a = rh_rates(&s, rhs, SPH_FIELD_SIGMA);
    if (!first)
      first = a;
    else
      assert_memory_equal(a, first, (size_t)(s.rows * 6) * sizeof *a);
    if (a != first) free(a);
    sph_rhs_destroy(rhs);
    sph_material_destroy(m);
    rh_free(&s);
    sph_context_destroy(ctx);
  }
  free(first);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_out_of_memory),
    cmocka_unit_test(test_recovers),
    cmocka_unit_test(test_steady),
    cmocka_unit_test(test_retained),
    cmocka_unit_test(test_several_sets),
    cmocka_unit_test(test_threads),
    cmocka_unit_test(test_threads_3d_stress_rate),
};
SPH_TEST_MAIN(tests)
