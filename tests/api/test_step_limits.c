/* Steps by signals between neighbours and by the change of density. */
#include "../oom.h"

#include <stdlib.h>

#include <sph/sph.h>

enum { N = 600 };

typedef struct cloud {
  sph_context *ctx;
  sph_neighbors *list;
  sph_operands a;
  double x[3 * N], v[3 * N], h[N], c[N];
} cloud;

static double noise(int k) { return sin(12.9898 * k + 1.3 * k * k); }

static cloud *make_cloud(int32_t threads, int32_t dim, sph_neighbors_options *o) {
  cloud *q = (cloud *)calloc(1, sizeof *q);
  sph_context_options co;
  assert_non_null(q);
  sph_context_options_init(&co);
  co.threads = threads;
  check_ok(sph_context_create(&co, &q->ctx));
  for (int k = 0; k < dim * N; k++) {
    q->x[k] = noise(k);
    q->v[k] = 3.0 * noise(k + 7777);
  }
  for (int i = 0; i < N; i++) {
    q->h[i] = (dim == 1 ? 0.01 : dim == 2 ? 0.1 : 0.2) * (1.0 + 0.3 * noise(3 * i));
    q->c[i] = 1.0 + 0.5 * noise(5 * i);
  }
  check_ok(sph_neighbors_create(q->ctx, o, &q->list));
  check_ok(sph_neighbors_build_arrays(q->list, dim, N, q->x, q->h, 0.0));
  sph_operands_init(&q->a);
  q->a.dim = dim;
  q->a.n = N;
  q->a.x = q->x;
  q->a.v = q->v;
  q->a.h = q->h;
  q->a.c = q->c;
  return q;
}

static void free_cloud(cloud *q) {
  sph_neighbors_destroy(q->list);
  sph_context_destroy(q->ctx);
  free(q);
}

/* All pairs, the nearest of all images. */
static double brute(const cloud *q, double courant, const sph_neighbors_options *o) {
  const int d = q->a.dim;
  const int64_t rows = q->a.rows < 0 ? N : q->a.rows;
  double least = INFINITY;
  for (int64_t i = 0; i < rows; i++) {
    double most = 0.0;
    for (int64_t j = 0; j < N; j++) {
      double r2 = 0.0, dot = 0.0;
      for (int a = 0; a < d; a++) {
        double x = q->x[i * d + a] - q->x[j * d + a], box = o->box_hi[a] - o->box_lo[a];
        while (o->periodic[a] && x > 0.5 * box) x -= box;
        while (o->periodic[a] && x < -0.5 * box) x += box;
        r2 += x * x;
        dot += x * (q->v[i * d + a] - q->v[j * d + a]);
      }
      double cut = o->support * sph_pair_h(o->h_rule, q->h[i], q->h[j]);
      if (i != j && sqrt(r2) < cut) most = fmax(most, fabs(dot) / sqrt(r2));
    }
    least = fmin(least, q->h[i] / ((q->a.c ? q->c[i] : q->a.c0) + most));
  }
  return courant * least;
}

static sph_neighbors_options options_of(int32_t method, int periodic) {
  sph_neighbors_options o;
  sph_neighbors_options_init(&o);
  o.method = method;
  o.h_rule = SPH_H_MAX;
  if (method == SPH_NEIGHBORS_VERLET) o.skin = 0.05;
  for (int a = 0; a < 3; a++) {
    o.periodic[a] = periodic;
    o.box_lo[a] = -1.0;
    o.box_hi[a] = 1.0;
  }
  return o;
}

/* Every method of search, dimension and box; the skin takes no part. */
static void test_brute_force(void **state) {
  (void)state;
  for (int32_t method = 1; method <= 4; method++)
    for (int32_t dim = 1; dim <= 3; dim++)
      for (int periodic = 0; periodic < 2; periodic++) {
        sph_neighbors_options o = options_of(method, periodic);
        cloud *q = make_cloud(1, dim, &o);
        double dt = 0.0;
        check_ok(sph_signal_step(q->list, &q->a, 0.3, &dt));
        check_rel(dt, brute(q, 0.3, &o), 1e-14);
        q->a.rows = 100; /* the others count as neighbours only */
        q->a.c = NULL;
        check_ok(sph_signal_step(q->list, &q->a, 0.3, &dt)); /* c0 = 0 */
        check_rel(dt, brute(q, 0.3, &o), 1e-14);
        free_cloud(q);
      }
}

/* Two particles by hand: they approach at speed 5 along the pair, sound 2, h = 0.5. */
static void test_pair(void **state) {
  (void)state;
  const double x[4] = {0.0, 0.0, 0.3, 0.4}, v[4] = {3.0, 4.0, 0.0, 0.0};
  sph_context *ctx = oom_context();
  sph_neighbors *list = NULL;
  sph_operands a;
  double dt = 0.0;
  check_ok(sph_neighbors_create(ctx, NULL, &list));
  check_ok(sph_neighbors_build_arrays(list, 2, 2, x, NULL, 0.5));
  sph_operands_init(&a);
  a.dim = 2;
  a.n = 2;
  a.x = x;
  a.v = v;
  a.h0 = 0.5;
  a.c0 = 2.0;
  check_ok(sph_signal_step(list, &a, 0.25, &dt));
  check_close(dt, 0.25 * 0.5 / 7.0, 1e-17);
  const double across[4] = {4.0, -3.0, 0.0, 0.0}; /* no signal across the pair */
  a.v = across;
  oom.countdown = 0; /* from now on every allocation fails: none is asked for */
  check_ok(sph_signal_step(list, &a, 0.25, &dt));
  assert_int_equal(oom.refused, 0);
  oom.countdown = -1;
  check_close(dt, 0.25 * 0.5 / 2.0, 1e-16);
  sph_neighbors_destroy(list);
  sph_context_destroy(ctx);
}

/* A uniform motion changes nothing, unlike h / (c + |v|). */
static void test_galilean(void **state) {
  (void)state;
  sph_neighbors_options o = options_of(SPH_NEIGHBORS_CELLS, 0);
  cloud *q = make_cloud(1, 2, &o);
  double at_rest = 0.0, moving = 0.0;
  check_ok(sph_signal_step(q->list, &q->a, 0.3, &at_rest));
  for (int k = 0; k < 2 * N; k++) q->v[k] += 1000.0;
  check_ok(sph_signal_step(q->list, &q->a, 0.3, &moving));
  check_rel(moving, at_rest, 1e-11);
  free_cloud(q);
}

static void test_threads(void **state) {
  (void)state;
  double first[2] = {0.0, 0.0};
  for (int32_t threads = 1; threads <= 8; threads++) {
    sph_neighbors_options o = options_of(SPH_NEIGHBORS_CELLS, 0);
    cloud *q = make_cloud(threads, 3, &o);
    double dt[2];
    check_ok(sph_signal_step(q->list, &q->a, 0.3, &dt[0]));
    check_ok(sph_density_step(q->ctx, N, 0.1, q->h, q->v, &dt[1]));
    if (threads == 1) memcpy(first, dt, sizeof dt);
    assert_memory_equal(dt, first, sizeof dt);
    free_cloud(q);
  }
}

static void test_density_step(void **state) {
  (void)state;
  sph_context *ctx = NULL;
  double rho[3] = {1.0, 2.0, 4.0}, drho[3] = {0.0, -5.0, 1.0}, dt = 0.0;
  check_ok(sph_context_create(NULL, &ctx));
  check_ok(sph_density_step(ctx, 3, 0.1, rho, drho, &dt));
  check_close(dt, 0.1 * 2.0 / 5.0, 1e-17);
  drho[1] = drho[2] = 0.0;
  check_ok(sph_density_step(ctx, 3, 0.1, rho, drho, &dt));
  assert_true(isinf(dt) && dt > 0.0);
  check_ok(sph_density_step(ctx, 0, 0.1, NULL, NULL, &dt));
  assert_true(isinf(dt));
  sph_context_destroy(ctx);
}

static void refused(sph_context *ctx, sph_status got, sph_status want, const char *words) {
  check_status(got, want);
  if (strstr(sph_context_last_error(ctx), words) == NULL)
    fail_msg("\"%s\" is not in \"%s\"", words, sph_context_last_error(ctx));
}

static void test_refusals(void **state) {
  (void)state;
  sph_neighbors_options o = options_of(SPH_NEIGHBORS_CELLS, 0);
  cloud *q = make_cloud(2, 2, &o);
  const sph_status arg = SPH_ERR_ARG, numeric = SPH_ERR_NUMERIC;
  double dt = 7.0;
  sph_operands a = q->a;
  sph_neighbors *fresh = NULL;
  refused(q->ctx, sph_signal_step(q->list, &a, 0.0, &dt), arg, "courant = 0");
  refused(q->ctx, sph_signal_step(q->list, &a, NAN, &dt), arg, "courant = nan");
  a.v = NULL;
  refused(q->ctx, sph_signal_step(q->list, &a, 0.3, &dt), arg, "v is NULL");
  a = q->a;
  a.n = N - 1;
  check_status(sph_signal_step(q->list, &a, 0.3, &dt), arg);
  a = q->a;
  a.rows = N + 1;
  refused(q->ctx, sph_signal_step(q->list, &a, 0.3, &dt), arg, "rows = 601");
  check_ok(sph_neighbors_create(q->ctx, NULL, &fresh));
  check_status(sph_signal_step(fresh, &q->a, 0.3, &dt), SPH_ERR_STATE);
  sph_neighbors_destroy(fresh);
  q->x[5] += 0.5;
  check_status(sph_signal_step(q->list, &q->a, 0.3, &dt), SPH_ERR_STALE);
  q->x[5] -= 0.5;
  check_ok(sph_neighbors_build_arrays(q->list, 2, N, q->x, q->h, 0.0));
  q->c[77] = NAN;
  q->c[78] = -100.0;
  refused(q->ctx, sph_signal_step(q->list, &q->a, 0.3, &dt), numeric, "particle 77");
  q->c[77] = 1.0;
  refused(q->ctx, sph_signal_step(q->list, &q->a, 0.3, &dt), numeric, "particle 78");
  q->c[78] = 1.0;
  q->v[2 * 33] = INFINITY;
  check_status(sph_signal_step(q->list, &q->a, 0.3, &dt), numeric);
  memset(q->v, 0, sizeof q->v);
  memset(q->c, 0, sizeof q->c);
  refused(q->ctx, sph_signal_step(q->list, &q->a, 0.3, &dt), numeric, "no finite step");
  q->c[9] = 1e300;
  refused(q->ctx, sph_signal_step(q->list, &q->a, 1e-30, &dt), numeric, "is no step");
  refused(q->ctx, sph_density_step(q->ctx, -1, 0.1, q->h, q->v, &dt), arg, "n = -1");
  refused(q->ctx, sph_density_step(q->ctx, N, -0.1, q->h, q->v, &dt), arg, "limit = -0.1");
  q->v[3] = NAN;
  refused(q->ctx, sph_density_step(q->ctx, N, 0.1, q->h, q->v, &dt), numeric, "particle 3");
  q->v[3] = 0.0;
  q->h[2] = -1.0;
  refused(q->ctx, sph_density_step(q->ctx, N, 0.1, q->h, q->v, &dt), numeric, "rho = -1");
  q->h[2] = 1e-300;
  q->v[2] = 1e300;
  refused(q->ctx, sph_density_step(q->ctx, N, 0.1, q->h, q->v, &dt), numeric, "is no step");
  check_close(dt, 7.0, 0.0);
  free_cloud(q);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_brute_force),  cmocka_unit_test(test_pair),
    cmocka_unit_test(test_galilean),     cmocka_unit_test(test_threads),
    cmocka_unit_test(test_density_step), cmocka_unit_test(test_refusals),
};
SPH_TEST_MAIN(tests)
