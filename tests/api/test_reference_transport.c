/* Wasserstein distance: printed figures, closed forms, brute force, metric properties. */
#include "../oom.h"

#include <sph/reference.h>

static sph_context *ctx;

static int open_context(void **state) {
  (void)state;
  return sph_context_create(NULL, &ctx) != SPH_OK;
}
static int close_context(void **state) {
  (void)state;
  sph_context_destroy(ctx);
  return 0;
}

static uint64_t seed;
static double uniform(void) {
  seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return (double)(seed >> 11) * 0x1p-53;
}

typedef struct cloud {
  int64_t n;
  int dim;
  double x[3 * 1024], m[1024];
} cloud;

static cloud random_cloud(int64_t n, int dim, int masses) {
  cloud c = {.n = n, .dim = dim};
  double total = 0;
  for (int64_t k = 0; k < n * dim; k++) c.x[k] = uniform();
  for (int64_t k = 0; k < n; k++) total += c.m[k] = masses ? uniform() : 1.0;
  for (int64_t k = 0; k < n; k++) c.m[k] /= total;
  return c;
}

static double distance(const cloud *a, const cloud *b) {
  double d = -1;
  check_ok(sph_wasserstein_distance(ctx, a->dim, a->n, a->x, a->m, b->n, b->x, b->m, &d));
  return d;
}

static double length(const double *a, const double *b, int dim) {
  double sum = 0;
  for (int k = 0; k < dim; k++) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sqrt(sum);
}

/* ---- figures of the source --------------------------------------------------------------- */

/* Cell centres of an l x l grid over the square of side 2 that lie in the unit circle. */
static int64_t disc(int l, double *x) {
  int64_t n = 0;
  for (int i = 0; i < l; i++)
    for (int j = 0; j < l; j++) {
      const double at[2] = {(2.0 * i + 1) / l - 1, (2.0 * j + 1) / l - 1};
      if (at[0] * at[0] + at[1] * at[1] >= 1) continue;
      x[2 * n] = at[0];
      x[2 * n++ + 1] = at[1];
    }
  return n;
}

/* Zisis 4.5.1: the initial measures of the drop */
static void test_drop(void **state) {
  (void)state;
  static const int l[] = {2, 4, 6, 8, 12, 16, 24, 32}, n[] = {4, 12, 32, 52, 112, 208, 448, 812};
  static const double want[] = {0.353553, 0.220150, 0.150022, 0.112858,
                                0.075537, 0.057524, 0.038399};
  static double x[2 * 812], y[2 * 812];
  const int last = check_short_run ? 5 : 7;
  for (int k = 0; k < last; k++) {
    double d = -1;
    assert_int_equal(disc(l[k], x), n[k]);
    assert_int_equal(disc(l[k + 1], y), n[k + 1]);
    check_ok(sph_wasserstein_distance(ctx, 2, n[k], x, NULL, n[k + 1], y, NULL, &d));
    check_close(d, want[k], 5.001e-7);
  }
}

/* Zisis 4.5.2: the initial measures of the shock tube, 8 k particles to the left and k to the right
 */
static int64_t tube(int64_t k, double *x) {
  for (int64_t i = 0; i < 8 * k; i++) x[i] = 0.5 * ((double)i + 0.5) / (double)(8 * k);
  for (int64_t i = 0; i < k; i++) x[8 * k + i] = 0.5 + 0.5 * ((double)i + 0.5) / (double)k;
  return 9 * k;
}

static void test_tube(void **state) {
  (void)state;
  static const int k[] = {2, 5, 10, 25, 50, 100, 200};
  static const double want[] = {1.44444e-2, 5.55556e-3, 2.88889e-3,
                                1.11111e-3, 5.55556e-4, 2.77778e-4};
  static double x[1800], y[1800];
  for (int i = 0; i < 6; i++) {
    double d = -1;
    const int64_t n = tube(k[i], x), m = tube(k[i + 1], y);
    check_ok(sph_wasserstein_distance(ctx, 1, n, x, NULL, m, y, NULL, &d));
    check_rel(d, want[i], 5e-6);
  }
}

/* ---- oracles ----------------------------------------------------------------------------- */

static double best_order(const cloud *a, const cloud *b, int k, unsigned used, double so_far,
                         double best) {
  if (so_far >= best) return best;
  if (k == a->n) return so_far;
  for (int j = 0; j < b->n; j++)
    if (!(used >> j & 1))
      best = best_order(a, b, k + 1, used | 1u << j,
                        so_far + length(a->x + k * a->dim, b->x + j * b->dim, a->dim), best);
  return best;
}

/* Equal masses, as many of each: the best of all permutations (Birkhoff). */
static void test_permutations(void **state) {
  (void)state;
  seed = 1;
  for (int round = 0; round < 60; round++) {
    const int n = 1 + round % 7;
    const cloud a = random_cloud(n, 1 + round % 3, 0), b = random_cloud(n, 1 + round % 3, 0);
    check_rel(distance(&a, &b), best_order(&a, &b, 0, 0, 0, INFINITY) / n, 1e-13);
  }
}

/* Masses that are whole numbers: points repeated, and again all permutations. */
static void test_repeated(void **state) {
  (void)state;
  seed = 2;
  for (int round = 0; round < 60; round++) {
    const int dim = 2 + round % 2;
    cloud a = {.dim = dim}, b = {.dim = dim}, all[2] = {{.dim = dim}, {.dim = dim}};
    cloud *few[2] = {&a, &b};
    for (int s = 0; s < 2; s++)
      for (int left = 7; left > 0;) {
        const int copies = 1 + (int)(uniform() * (left < 4 ? left : 4));
        double *x = few[s]->x + few[s]->n * dim;
        for (int d = 0; d < dim; d++) x[d] = uniform();
        few[s]->m[few[s]->n++] = copies;
        for (int c = 0; c < copies; c++) {
          memcpy(all[s].x + all[s].n * dim, x, sizeof(double) * (size_t)dim);
          all[s].m[all[s].n++] = 1;
        }
        left -= copies;
      }
    const double want = best_order(&all[0], &all[1], 0, 0, 0, INFINITY) / 7;
    check_rel(distance(&a, &b), want, 1e-12);
    check_rel(distance(&all[0], &b), want, 1e-12);
  }
}

/* Points on a line in the plane or in space: the closed form of 1-D against the simplex. */
static void test_line(void **state) {
  (void)state;
  seed = 3;
  static const double along[3] = {0.6, -0.48, 0.64};
  for (int round = 0; round < 12; round++) {
    const int64_t n = check_short_run ? 20 : 30 * (round + 1), m = 7 + 40 * (round % 5);
    const int dim = 2 + round % 2;
    cloud a = random_cloud(n, 1, round % 3), b = random_cloud(m, 1, round % 3);
    cloud c = a, d = b;
    c.dim = d.dim = dim;
    const double unit = dim == 2 ? hypot(0.6, 0.48) : 1.0;
    for (int64_t i = 0; i < n; i++)
      for (int k = 0; k < dim; k++) c.x[i * dim + k] = 3 + a.x[i] * along[k] / unit;
    for (int64_t i = 0; i < m; i++)
      for (int k = 0; k < dim; k++) d.x[i * dim + k] = 3 + b.x[i] * along[k] / unit;
    check_rel(distance(&c, &d), distance(&a, &b), 1e-11);
  }
}

/* Kantorovich: sum f (mu - nu) <= W1 for every f that grows no faster than distance; and any plan
 * costs at least as much. f = |x - z| and f = direction . x do not reach it, the product plan is
 * far above it. */
static void test_bounds(void **state) {
  (void)state;
  seed = 4;
  for (int round = 0; round < 10; round++) {
    const cloud a = random_cloud(40, 2, 1), b = random_cloud(55, 2, 1);
    const double d = distance(&a, &b);
    double product = 0;
    for (int i = 0; i < 40; i++)
      for (int j = 0; j < 55; j++) product += a.m[i] * b.m[j] * length(a.x + 2 * i, b.x + 2 * j, 2);
    assert_true(d < product);
    for (int k = 0; k < 50; k++) {
      const double z[2] = {2 * uniform() - 0.5, 2 * uniform() - 0.5};
      double dual = 0;
      for (int i = 0; i < 40; i++) dual += a.m[i] * length(a.x + 2 * i, z, 2);
      for (int j = 0; j < 55; j++) dual -= b.m[j] * length(b.x + 2 * j, z, 2);
      assert_true(fabs(dual) <= d);
    }
  }
}

/* ---- properties -------------------------------------------------------------------------- */

static void test_metric(void **state) {
  (void)state;
  seed = 5;
  for (int dim = 1; dim <= 3; dim++)
    for (int round = 0; round < 6; round++) {
      const cloud a = random_cloud(30, dim, round % 2), b = random_cloud(17, dim, round % 2),
                  c = random_cloud(51, dim, 1);
      const double ab = distance(&a, &b), bc = distance(&b, &c), ac = distance(&a, &c);
      check_rel(distance(&b, &a), ab, 1e-12);
      assert_true(ac <= ab + bc + 1e-12 && ab <= ac + bc + 1e-12 && bc <= ab + ac + 1e-12);
      check_close(distance(&a, &a), 0.0, 0.0);
      cloud moved = a;
      double shift = 0;
      for (int d = 0; d < dim; d++) shift += (d + 1.0) * (d + 1.0);
      for (int64_t k = 0; k < a.n * dim; k++) moved.x[k] += (double)(k % dim) + 1.0;
      check_rel(distance(&a, &moved), sqrt(shift), 1e-12); /* a shift costs its length */
      cloud large = a, wide = b;
      for (int64_t k = 0; k < a.n * dim; k++) large.x[k] *= 1e200;
      for (int64_t k = 0; k < b.n * dim; k++) wide.x[k] *= 1e200;
      check_rel(distance(&large, &wide), ab * 1e200, 1e-12);
      for (int64_t k = 0; k < a.n; k++) large.m[k] *= 1e-100; /* units of mass do not matter */
      for (int64_t k = 0; k < b.n; k++) wide.m[k] *= 1e-100;
      check_rel(distance(&large, &wide), ab * 1e200, 1e-12);
    }
}

/* The order of the points does not matter, nor do points without mass, nor halves of a point. */
static void test_same_measure(void **state) {
  (void)state;
  seed = 6;
  const cloud a = random_cloud(60, 2, 1), b = random_cloud(70, 2, 1);
  const double d = distance(&a, &b);
  cloud c = {.n = 121, .dim = 2};
  for (int k = 0; k < 120; k++) {
    const int from = (k * 37) % 60;
    memcpy(c.x + 2 * k, a.x + 2 * from, 2 * sizeof(double));
    c.m[k] = 0.5 * a.m[from];
  }
  c.x[240] = 1000;
  check_rel(distance(&c, &b), d, 1e-12 * 1000 / d);
  check_close(distance(&c, &a), 0.0, 1e-10);
}

static void test_degenerate(void **state) {
  (void)state;
  cloud a = {.n = 50, .dim = 2}, b = {.n = 20, .dim = 2}; /* everything in one place */
  for (int k = 0; k < 50; k++) a.m[k] = 0.02;
  for (int k = 0; k < 20; k++) b.m[k] = 0.05;
  check_close(distance(&a, &b), 0.0, 0.0);
  for (int k = 0; k < 20; k++) b.x[2 * k] = 3.0;
  check_rel(distance(&a, &b), 3.0, 1e-14);
  for (int k = 0; k < 50; k++) a.x[2 * k] = k < 10 ? 3.0 : 0.0; /* ties everywhere */
  check_rel(distance(&a, &b), 2.4, 1e-13);
  seed = 8; /* a lattice against itself, shifted: many plans are best */
  for (int k = 0; k < 49; k++) {
    a.x[2 * k] = k % 7;
    a.x[2 * k + 1] = k / 7;
  }
  a.n = 49;
  cloud c = a;
  for (int k = 0; k < 49; k++) c.x[2 * k] += 2.0;
  for (int k = 0; k < 49; k++) a.m[k] = c.m[k] = 1;
  check_rel(distance(&a, &c), 2.0, 1e-13);
}

/* ---- what is refused --------------------------------------------------------------------- */

static void test_refused(void **state) {
  (void)state;
  const double x[4] = {0, 1, 2, 3}, bad[4] = {0, INFINITY, 0, 0}, m[2] = {1, 1},
               half[2] = {0.5, 0.5}, negative[2] = {2, -1}, none[2] = {0, 0},
               huge[4] = {1e308, 0, -1e308, 0}, heavy[2] = {1e308, 1e308};
  double d = 7;
#define REFUSE(status, dim, nx, px, mx, ny, py, my) \
  check_status(sph_wasserstein_distance(ctx, dim, nx, px, mx, ny, py, my, &d), status)
  REFUSE(SPH_ERR_ARG, 0, 2, x, m, 2, x, m);
  REFUSE(SPH_ERR_ARG, 4, 1, x, m, 1, x, m);
  REFUSE(SPH_ERR_ARG, 2, 0, x, m, 2, x, m);
  REFUSE(SPH_ERR_ARG, 2, 2, x, m, -1, x, m);
  REFUSE(SPH_ERR_LIMIT, 2, INT64_MAX, x, m, 2, x, m);
  REFUSE(SPH_ERR_ARG, 2, 2, bad, m, 2, x, m);
  assert_non_null(strstr(sph_context_last_error(ctx), "position 0"));
  REFUSE(SPH_ERR_ARG, 2, 2, x, m, 2, x, negative);
  assert_non_null(strstr(sph_context_last_error(ctx), "my[1] = -1"));
  REFUSE(SPH_ERR_ARG, 2, 2, x, none, 2, x, m);
  REFUSE(SPH_ERR_ARG, 2, 2, x, heavy, 2, x, heavy);
  REFUSE(SPH_ERR_ARG, 2, 2, x, m, 2, x, half);
  assert_non_null(strstr(sph_context_last_error(ctx), "differ"));
  REFUSE(SPH_ERR_NUMERIC, 2, 2, huge, m, 2, x, m);
  assert_true(d == 7);
}

static int32_t stop(void *user, double fraction, const char *what) {
  (void)what;
  ++*(int *)user;
  assert_true(fraction >= 0 && fraction <= 1);
  return *(int *)user >= 2;
}

static void test_stopped(void **state) {
  (void)state;
  int calls = 0;
  double d = 7;
  sph_context_options o;
  sph_context *own = NULL;
  sph_context_options_init(&o);
  o.progress = stop;
  o.progress_user = &calls;
  check_ok(sph_context_create(&o, &own));
  seed = 9;
  const cloud a = random_cloud(1000, 2, 1), b = random_cloud(1000, 2, 1);
  check_status(sph_wasserstein_distance(own, 2, a.n, a.x, a.m, b.n, b.x, b.m, &d),
               SPH_ERR_CALLBACK);
  assert_true(d == 7 && calls == 2);
  sph_context_destroy(own);
}

static sph_status both(sph_context *own, void *user) {
  cloud *c = user;
  double d = 7;
  for (int dim = 1; dim <= 2; dim++) {
    const sph_status s = sph_wasserstein_distance(own, dim, 20, c[0].x, NULL, 15, c[1].x, NULL, &d);
    if (s != SPH_OK) return s;
  }
  return SPH_OK;
}

static void test_memory(void **state) {
  (void)state;
  seed = 10;
  cloud c[2] = {random_cloud(20, 2, 0), random_cloud(15, 2, 0)};
  oom_sweep(both, c);
}

#define WITH(test) cmocka_unit_test_setup_teardown(test, open_context, close_context)
static const struct CMUnitTest tests[] = {
    WITH(test_drop),       WITH(test_tube),    WITH(test_permutations), WITH(test_repeated),
    WITH(test_line),       WITH(test_bounds),  WITH(test_metric),       WITH(test_same_measure),
    WITH(test_degenerate), WITH(test_refused), WITH(test_stopped),      WITH(test_memory),
};
SPH_TEST_MAIN(tests)
