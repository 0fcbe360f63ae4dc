/* Smoothing lengths that fit the density: exact lattices, plain bisection over all pairs, starts
 * from far away, particles for which there is none. */
#include "../check.h"

#include <stdlib.h>

#include <sph/sph.h>

enum { N = 400 };

typedef struct cloud {
  sph_context *ctx;
  sph_particles *set;
  sph_neighbors *list;
  sph_kernel *kernel;
  int32_t dim;
  int64_t n, rows;
  double *x, *m, *h, *rho, period;
} cloud;

typedef struct recipe {
  int32_t threads, dim, kernel, method, ghosts;
  int64_t n;
  double period; /* 0: open */
} recipe;

static double *field(cloud *c, int32_t f) {
  double *y = NULL;
  check_ok(sph_particles_field(c->set, f, &y));
  return y;
}

static void make_list(cloud *c, const recipe *r) {
  sph_neighbors_options o;
  sph_neighbors_options_init(&o);
  o.method = r->method ? r->method : SPH_NEIGHBORS_CELLS;
  o.h_rule = SPH_H_MAX;
  o.support = sph_kernel_support(c->kernel);
  if (o.method == SPH_NEIGHBORS_VERLET) o.skin = 0.01;
  for (int a = 0; a < 3; a++) {
    o.periodic[a] = r->period > 0.0;
    o.box_hi[a] = r->period;
  }
  check_ok(sph_neighbors_create(c->ctx, &o, &c->list));
}

static cloud open_cloud(recipe r) {
  cloud c = {.dim = r.dim, .n = r.n, .rows = r.n - r.ghosts, .period = r.period};
  sph_context_options co;
  sph_particles_options po;
  sph_context_options_init(&co);
  co.threads = r.threads ? r.threads : 1;
  check_ok(sph_context_create(&co, &c.ctx));
  sph_particles_options_init(&po);
  po.dim = r.dim;
  check_ok(sph_particles_create(c.ctx, &po, &c.set));
  check_ok(sph_particles_add(c.set, c.rows, NULL));
  check_ok(sph_particles_add_ghosts(c.set, r.ghosts, NULL));
  check_ok(
      sph_kernel_create(c.ctx, r.kernel ? r.kernel : SPH_KERNEL_CUBIC_SPLINE, r.dim, &c.kernel));
  make_list(&c, &r);
  c.x = field(&c, SPH_FIELD_X);
  c.m = field(&c, SPH_FIELD_M);
  c.h = field(&c, SPH_FIELD_H);
  c.rho = field(&c, SPH_FIELD_RHO);
  for (int64_t i = 0; i < c.n; i++) c.m[i] = c.h[i] = 1.0;
  return c;
}

static void close_cloud(cloud *c) {
  sph_neighbors_destroy(c->list);
  sph_kernel_destroy(c->kernel);
  sph_particles_destroy(c->set);
  sph_context_destroy(c->ctx);
}

static double noise(int64_t k) {
  double s = 43758.5453 * sin(12.9898 * (double)k + 78.233);
  return s - floor(s);
}

/* Denser towards the origin, masses within a factor of ten, in [0, 1)^d. */
static cloud random_cloud(recipe r) {
  cloud c = open_cloud(r);
  for (int64_t k = 0; k < c.n * c.dim; k++) c.x[k] = pow(noise(k), 1.5);
  for (int64_t i = 0; i < c.n; i++) {
    c.m[i] = 0.1 + 0.9 * noise(7 * i + 100000);
    c.h[i] = 1.2 * pow(1.0 / (double)c.n, 1.0 / c.dim) * (0.5 + noise(3 * i + 50000));
  }
  return c;
}

static sph_adapt_options options_of(int32_t smoothing, double eta) {
  sph_adapt_options o;
  sph_adapt_options_init(&o);
  o.smoothing = smoothing;
  o.eta = eta;
  return o;
}

static sph_status adapt(cloud *c, const sph_adapt_options *o, sph_adapt_result *result) {
  if (result) sph_adapt_result_init(result);
  check_ok(sph_particles_touch(c->set, SPH_FIELD_X));
  return sph_adapt_smoothing(c->list, c->kernel, c->set, o, result);
}

/* n_i at h by the definition, over all pairs. */
static double number(const cloud *c, int32_t smoothing, int64_t i, double h) {
  double sum = 0.0;
  for (int64_t j = 0; j < c->n; j++) {
    double r2 = 0.0;
    for (int a = 0; a < c->dim; a++) {
      double x = c->x[i * c->dim + a] - c->x[j * c->dim + a];
      if (c->period > 0.0) x -= c->period * floor(x / c->period + 0.5);
      r2 += x * x;
    }
    double w = sph_kernel_w(c->kernel, sqrt(r2), h);
    sum += smoothing == SPH_SMOOTHING_MASS ? c->m[j] / c->m[i] * w : w;
  }
  return sum;
}

/* The root by plain bisection, in logarithms. */
static double bisected(const cloud *c, int32_t smoothing, double eta, int64_t i) {
  double low = 1e-8, high = 1e8;
  for (int k = 0; k < 120; k++) {
    double h = sqrt(low * high);
    if (number(c, smoothing, i, h) * pow(h, c->dim) < pow(eta, c->dim))
      low = h;
    else
      high = h;
  }
  return sqrt(low * high);
}

/* ---- exact values ------------------------------------------------------------------------ */

/* Cubic spline on a lattice of spacing 1 at h = 1, w(q) = 1 - 3/2 q^2 + 3/4 q^3, (2 - q)^3 / 4:
 * eta^d = alpha (w(0) + 2 d w(1) + ..) with w(1) = 1/4. In 1-D it is 2/3 + 2/6 = 1. */
static void test_lattice(void **state) {
  (void)state;
  const double s2 = pow(2.0 - sqrt(2.0), 3) / 4.0, s3 = pow(2.0 - sqrt(3.0), 3) / 4.0;
  const double pi = acos(-1.0), eta_d[] = {0.0, 1.0, 10.0 / (7.0 * pi) * (2.0 + 4.0 * s2),
                                           1.0 / pi * (2.5 + 12.0 * s2 + 8.0 * s3)};
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int32_t smoothing = SPH_SMOOTHING_MASS; smoothing <= SPH_SMOOTHING_NUMBER;
         smoothing += 2) {
      const int64_t side = dim == 3 ? 6 : 8, n = dim == 1 ? side : dim == 2 ? 64 : 216;
      cloud c = open_cloud((recipe){.dim = dim, .n = n, .period = (double)side});
      for (int64_t i = 0; i < n; i++) {
        int64_t k = i;
        for (int a = 0; a < dim; a++, k /= side) c.x[i * dim + a] = (double)(k % side) + 0.5;
        c.m[i] = 3.0;
        c.h[i] = 0.7 + 0.6 * noise(i);
      }
      sph_adapt_options o = options_of(smoothing, pow(eta_d[dim], 1.0 / dim));
      check_ok(adapt(&c, &o, NULL));
      for (int64_t i = 0; i < n; i++) {
        check_close(c.h[i], 1.0, 1e-10);
        check_rel(c.rho[i], 3.0 * eta_d[dim], 1e-9);
      }
      close_cloud(&c);
    }
}

/* Two particles in 1-D at the distance 1: (2/3) (w(0) + w(1 / h)) = eta by hand. With eta = 2/3 +
 * 1/6: h = 1. With masses 1 and 3 the light one has 2/3 + 3/6 = 7/6; the heavy one cannot have more
 * than 2/3 + 2/9. */
static void test_pair(void **state) {
  (void)state;
  cloud c = open_cloud((recipe){.dim = 1, .n = 2});
  sph_adapt_options o = options_of(SPH_SMOOTHING_NUMBER, 5.0 / 6.0);
  c.x[1] = 1.0;
  c.h[0] = 0.9;
  check_ok(adapt(&c, &o, NULL));
  for (int i = 0; i < 2; i++) check_close(c.h[i], 1.0, 1e-10);
  c.m[1] = 3.0;
  c.h[1] = 0.7;
  o = options_of(SPH_SMOOTHING_MASS, 7.0 / 6.0);
  o.keep = 1;
  sph_adapt_result result;
  check_ok(adapt(&c, &o, &result));
  check_close(c.h[0], 1.0, 1e-10);
  assert_int_equal(result.kept, 1);
  assert_int_equal(result.first_kept, 1);
  check_close(c.h[1], 0.7, 0.0);
  close_cloud(&c);
}

/* ---- all pairs --------------------------------------------------------------------------- */

static void check_roots(cloud *c, int32_t smoothing, double eta) {
  for (int64_t i = 0; i < c->rows; i++) {
    double n = number(c, smoothing, i, c->h[i]);
    check_rel(n * pow(c->h[i], c->dim), pow(eta, c->dim), 2e-10);
    check_rel(c->rho[i], c->m[i] * n, 1e-12);
    if (i % 7 == 0) check_rel(c->h[i], bisected(c, smoothing, eta, i), 1e-9);
  }
}

/* Every search, open and periodic, both sums, two kernels. */
static void test_brute_force(void **state) {
  (void)state;
  const int32_t kernels[] = {SPH_KERNEL_CUBIC_SPLINE, SPH_KERNEL_WENDLAND_C4};
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int32_t k = 0; k < 16; k++) {
      recipe r = {.dim = dim, .n = N, .method = 1 + k % 4, .kernel = kernels[k / 8]};
      if (k / 4 % 2) r.period = 1.0;
      cloud c = random_cloud(r);
      int32_t smoothing = k % 2 ? SPH_SMOOTHING_MASS : SPH_SMOOTHING_NUMBER;
      sph_adapt_options o = options_of(smoothing, 1.3);
      sph_status s = adapt(&c, &o, NULL);
      if (s != SPH_OK) fail_msg("%d-D, %d: %s", dim, k, sph_context_last_error(c.ctx));
      check_roots(&c, smoothing, 1.3);
      close_cloud(&c);
    }
}

/* The list is ready afterwards: the library's own density sum finds n h^d = eta^d. */
static void test_list_is_ready(void **state) {
  (void)state;
  cloud c = random_cloud((recipe){.dim = 2, .n = N});
  sph_adapt_options o = options_of(SPH_SMOOTHING_NUMBER, 1.2);
  sph_adapt_result result;
  int32_t rebuilt = 7;
  check_ok(adapt(&c, &o, &result));
  assert_true(result.builds >= 2 && result.most_evaluations <= 20);
  check_ok(sph_neighbors_update(c.list, c.set, &rebuilt));
  assert_int_equal(rebuilt, 0);
  for (int k = 0; k < 3; k++) { /* again from there: nothing to do */
    double before[N];
    memcpy(before, c.h, sizeof before);
    check_ok(adapt(&c, &o, &result));
    assert_memory_equal(before, c.h, sizeof before);
    assert_int_equal(result.evaluations, N);
    assert_int_equal(result.builds, 2);
  }
  for (int64_t i = 0; i < 2 * N; i++) c.x[i] += 1e-3 * noise(i + 31); /* as in a time step */
  check_ok(adapt(&c, &o, &result));
  assert_true(result.evaluations <= 5 * N && result.builds <= 3);
  check_roots(&c, SPH_SMOOTHING_NUMBER, 1.2);
  close_cloud(&c);
}

/* Starts at a hundredth and a hundredfold, and both mixed. */
static void test_cold_start(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int k = 0; k < 6; k++) {
      cloud c = random_cloud((recipe){.dim = dim, .n = N, .period = k % 2 ? 1.0 : 0.0});
      sph_adapt_options o = options_of(SPH_SMOOTHING_NUMBER, 1.2);
      sph_adapt_result result;
      double want[N];
      check_ok(adapt(&c, &o, NULL));
      memcpy(want, c.h, sizeof want);
      for (int64_t i = 0; i < N; i++)
        c.h[i] *= k / 2 == 0 ? 0.01 : k / 2 == 1 ? 100.0 : pow(100.0, 2.0 * noise(i + 9) - 1.0);
      check_ok(adapt(&c, &o, &result));
      for (int64_t i = 0; i < N; i++) check_rel(c.h[i], want[i], 1e-9);
      assert_true(result.evaluations < 20 * N && result.most_evaluations < 60);
      close_cloud(&c);
    }
}

/* Ghosts count in sums; their own h is left alone, whatever it is. */
static void test_ghosts(void **state) {
  (void)state;
  cloud c = random_cloud((recipe){.dim = 2, .n = N, .ghosts = 100});
  sph_adapt_options o = options_of(SPH_SMOOTHING_MASS, 1.2);
  for (int64_t i = c.rows; i < N; i++) c.h[i] = 0.05;
  check_ok(adapt(&c, &o, NULL));
  check_roots(&c, SPH_SMOOTHING_MASS, 1.2);
  for (int64_t i = c.rows; i < N; i++) check_close(c.h[i], 0.05, 0.0);
  close_cloud(&c);
}

static void test_threads(void **state) {
  (void)state;
  double first[2 * N];
  for (int32_t threads = 1; threads <= 5; threads++) {
    cloud c = random_cloud((recipe){.dim = 3, .n = N, .threads = threads});
    sph_adapt_options o = options_of(SPH_SMOOTHING_MASS, 1.2);
    check_ok(adapt(&c, &o, NULL));
    if (threads == 1) {
      memcpy(first, c.h, N * sizeof *first);
      memcpy(first + N, c.rho, N * sizeof *first);
    }
    assert_memory_equal(c.h, first, N * sizeof *first);
    assert_memory_equal(c.rho, first + N, N * sizeof *first);
    close_cloud(&c);
  }
}

/* A kernel that is cut: where the sum jumps across eta^d, h is the place of the jump. */
static void test_jumps(void **state) {
  (void)state;
  enum { SIDE = 60, MANY = SIDE * SIDE };
  cloud c = open_cloud(
      (recipe){.dim = 2, .n = MANY, .kernel = SPH_KERNEL_GAUSSIAN, .period = (double)SIDE});
  sph_adapt_options o = options_of(SPH_SMOOTHING_NUMBER, 1.2);
  sph_adapt_result result;
  int64_t off = 0;
  for (int64_t i = 0; i < MANY; i++) {
    c.x[2 * i] = (double)(i % SIDE) + 0.4 * noise(2 * i);
    c.x[2 * i + 1] = (double)(i / SIDE) + 0.4 * noise(2 * i + 1);
    c.h[i] = 1.2;
  }
  check_ok(adapt(&c, &o, &result));
  const double jump = sph_kernel_w(c.kernel, 3.0 * (1.0 - 1e-15), 1.0) / (1.2 * 1.2);
  for (int64_t i = 0; i < MANY; i++) {
    double h = c.h[i], miss = number(&c, SPH_SMOOTHING_NUMBER, i, h) * h * h / (1.2 * 1.2) - 1.0;
    if (fabs(miss) <= 2e-10) continue;
    off++;
    assert_true(fabs(miss) <= 1.01 * jump);
    double other = miss > 0.0 ? h * (1.0 - 1e-14) : h * (1.0 + 1e-14);
    assert_true((number(&c, SPH_SMOOTHING_NUMBER, i, other) * other * other < 1.2 * 1.2) ==
                (miss > 0.0));
  }
  assert_int_equal(off, result.jumps);
  assert_true(off > 0 && off < MANY / 100);
  close_cloud(&c);
}

/* ---- no h -------------------------------------------------------------------------------- */

static void refused(cloud *c, const sph_adapt_options *o, sph_status want, const char *words) {
  double *h = (double *)malloc((size_t)c->n * 2 * sizeof *h);
  assert_non_null(h);
  memcpy(h, c->h, (size_t)c->n * sizeof *h);
  memcpy(h + c->n, c->rho, (size_t)c->n * sizeof *h);
  sph_adapt_result result;
  sph_adapt_result_init(&result);
  result.kept = -5;
  check_status(sph_adapt_smoothing(c->list, c->kernel, c->set, o, &result), want);
  if (strstr(sph_context_last_error(c->ctx), words) == NULL)
    fail_msg("\"%s\" is not in \"%s\"", words, sph_context_last_error(c->ctx));
  assert_memory_equal(h, c->h, (size_t)c->n * sizeof *h);
  assert_memory_equal(h + c->n, c->rho, (size_t)c->n * sizeof *h);
  assert_int_equal(result.kept, -5);
  free(h);
}

/* Alone, or too few: named, or kept, or bounded. */
static void test_alone(void **state) {
  (void)state;
  const int64_t enough[] = {0, 2, 4, 6}; /* eta^d / W(0) = 1.8, 3.2, 5.4 */
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int64_t n = 1; n <= enough[dim]; n++) {
      cloud c = open_cloud((recipe){.dim = dim, .n = n});
      for (int64_t k = 0; k < n * dim; k++) c.x[k] = noise(k);
      sph_adapt_options o = options_of(SPH_SMOOTHING_NUMBER, 1.2);
      sph_adapt_result result;
      if (n < enough[dim]) {
        refused(&c, &o, SPH_ERR_NUMERIC, "no h for particle 0: too few");
        o.keep = 1;
        check_ok(adapt(&c, &o, &result));
        assert_int_equal(result.kept, n);
        assert_int_equal(result.first_kept, 0);
        for (int64_t i = 0; i < n; i++) {
          check_close(c.h[i], 1.0, 0.0);
          check_rel(c.rho[i], number(&c, SPH_SMOOTHING_NUMBER, i, 1.0), 1e-13);
        }
        o.h_max = 2.5;
        check_ok(adapt(&c, &o, &result));
        assert_int_equal(result.bounded, n);
        for (int64_t i = 0; i < n; i++) check_close(c.h[i], 2.5, 0.0);
      } else {
        check_ok(adapt(&c, &o, &result));
        check_roots(&c, SPH_SMOOTHING_NUMBER, 1.2);
      }
      close_cloud(&c);
    }
}

/* Debris far away has a long h, or its bound; what stays behind does not notice. */
static void test_debris(void **state) {
  (void)state;
  for (int bound = 0; bound < 2; bound++) {
    cloud c = random_cloud((recipe){.dim = 2, .n = N, .method = SPH_NEIGHBORS_TREE});
    sph_adapt_options o = options_of(SPH_SMOOTHING_NUMBER, 1.2);
    sph_adapt_result result;
    c.x[2 * 17] = 1000.0;
    if (bound) o.h_max = 0.5;
    check_ok(adapt(&c, &o, &result));
    assert_int_equal(result.bounded, bound);
    if (bound)
      check_close(c.h[17], 0.5, 0.0);
    else
      check_rel(c.h[17], bisected(&c, SPH_SMOOTHING_NUMBER, 1.2, 17), 1e-9);
    assert_true(bound || c.h[17] > 500.0);
    check_rel(c.h[18], bisected(&c, SPH_SMOOTHING_NUMBER, 1.2, 18), 1e-9);
    close_cloud(&c);
  }
}

/* Two at one place are too many in 1-D (4/3 > 1.2), three in 2-D, not two; four and more in 3-D. */
static void test_coincident(void **state) {
  (void)state;
  const int64_t most[] = {0, 1, 3, 5}; /* eta^d / W(0) = 1.8, 3.2, 5.4 */
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int64_t together = 2; together <= 6; together++) {
      cloud c = random_cloud((recipe){.dim = dim, .n = N});
      sph_adapt_options o = options_of(SPH_SMOOTHING_NUMBER, 1.2);
      sph_adapt_result result;
      for (int64_t k = 0; k < together; k++)
        memcpy(c.x + (60 + k) * dim, c.x + 60 * dim, (size_t)dim * sizeof(double));
      if (together <= most[dim]) {
        check_ok(adapt(&c, &o, NULL));
        check_roots(&c, SPH_SMOOTHING_NUMBER, 1.2);
      } else {
        double h = c.h[61];
        refused(&c, &o, SPH_ERR_NUMERIC, "no h for particle 60: too many particles at its place");
        o.keep = 1;
        check_ok(adapt(&c, &o, &result));
        assert_int_equal(result.kept, together);
        assert_int_equal(result.first_kept, 60);
        check_close(c.h[61], h, 0.0);
        o.h_min = 1e-6;
        check_ok(adapt(&c, &o, &result));
        assert_int_equal(result.kept, 0);
        assert_int_equal(result.bounded, together);
        check_close(c.h[61], 1e-6, 0.0);
      }
      close_cloud(&c);
    }
}

/* Too few particles for a periodic box, however h is chosen; and too few evaluations. */
static void test_box_and_budget(void **state) {
  (void)state;
  cloud c = open_cloud((recipe){.dim = 2, .n = 3, .period = 1.0});
  for (int k = 0; k < 6; k++) c.x[k] = noise(k);
  for (int i = 0; i < 3; i++) c.h[i] = 10.0;
  sph_adapt_options o = options_of(SPH_SMOOTHING_NUMBER, 1.2);
  refused(&c, &o, SPH_ERR_NUMERIC, "no h for particle 0: the periodic box");
  o.keep = 1;
  check_status(adapt(&c, &o, NULL), SPH_ERR_LIMIT); /* the kept h does not fit either */
  check_close(c.h[0], 10.0, 0.0);
  o.h_max = 0.2;
  check_ok(adapt(&c, &o, NULL));
  check_close(c.h[0], 0.2, 0.0);
  close_cloud(&c);
  c = random_cloud((recipe){.dim = 2, .n = N});
  o = options_of(SPH_SMOOTHING_NUMBER, 1.2);
  o.max_evaluations = 2;
  refused(&c, &o, SPH_ERR_NUMERIC, "max_evaluations are spent");
  close_cloud(&c);
}

/* ---- refusals ---------------------------------------------------------------------------- */

#define TRY(member, value, words)         \
  do {                                    \
    sph_adapt_options o_ = o;             \
    o_.member = (value);                  \
    refused(&c, &o_, SPH_ERR_ARG, words); \
  } while (0)

static void test_options(void **state) {
  (void)state;
  cloud c = random_cloud((recipe){.dim = 2, .n = N});
  sph_adapt_options o = options_of(SPH_SMOOTHING_NUMBER, 1.2);
  TRY(smoothing, 2, "smoothing = 2");
  TRY(smoothing, 4, "smoothing = 4");
  TRY(eta, 0.0, "eta = 0");
  TRY(eta, NAN, "eta = nan");
  TRY(eta, 0.3, "a particle alone");
  TRY(tolerance, 0.0, "tolerance");
  TRY(max_evaluations, 0, "max_evaluations");
  TRY(h_min, -1.0, "h_min");
  TRY(h_max, INFINITY, "h_max");
  o.h_min = 2.0;
  TRY(h_max, 1.0, "h_min = 2");
  o.h_min = 0.0;
  c.h[5] = -1.0;
  refused(&c, &o, SPH_ERR_NUMERIC, "particle 5 has h = -1");
  c.h[5] = 0.1;
  c.m[6] = NAN;
  c.h[7] = 0.1;
  refused(&c, &o, SPH_ERR_NUMERIC, "particle 6 has m = ");
  c.m[6] = 1.0;
  c.x[20] = INFINITY;
  refused(&c, &o, SPH_ERR_ARG, "10");
  close_cloud(&c);
}

static void test_other_list(void **state) {
  (void)state;
  cloud c = random_cloud((recipe){.dim = 2, .n = N});
  sph_neighbors *good = c.list;
  sph_neighbors_options no;
  sph_adapt_options o = options_of(SPH_SMOOTHING_NUMBER, 1.2);
  sph_neighbors_options_init(&no);
  check_ok(sph_neighbors_create(c.ctx, &no, &c.list));
  refused(&c, &o, SPH_ERR_ARG, "SPH_H_MAX");
  sph_neighbors_destroy(c.list);
  no.h_rule = SPH_H_AVERAGE;
  no.support = 1.9;
  check_ok(sph_neighbors_create(c.ctx, &no, &c.list));
  refused(&c, &o, SPH_ERR_ARG, "1.9 h");
  sph_neighbors_destroy(c.list);
  no.support = 2.0;
  no.max_pairs = 10;
  check_ok(sph_neighbors_create(c.ctx, &no, &c.list));
  refused(&c, &o, SPH_ERR_LIMIT, "pairs");
  sph_neighbors_destroy(c.list);
  c.list = good;
  sph_kernel *kernel = c.kernel;
  check_ok(sph_kernel_create(c.ctx, SPH_KERNEL_CUBIC_SPLINE, 3, &c.kernel));
  refused(&c, &o, SPH_ERR_ARG, "3-D");
  sph_kernel_destroy(c.kernel);
  c.kernel = kernel;
  close_cloud(&c);
}

/* No particles, ghosts alone, defaults. */
static void test_empty(void **state) {
  (void)state;
  cloud c = open_cloud((recipe){.dim = 2, .n = 5, .ghosts = 5});
  check_ok(adapt(&c, NULL, NULL));
  check_close(c.h[0], 1.0, 0.0);
  check_ok(sph_particles_clear_ghosts(c.set));
  check_ok(adapt(&c, NULL, NULL));
  close_cloud(&c);
  sph_adapt_options_init_sized(NULL, 8);
  sph_adapt_result_init_sized(NULL, 8);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_lattice),     cmocka_unit_test(test_pair),
    cmocka_unit_test(test_brute_force), cmocka_unit_test(test_list_is_ready),
    cmocka_unit_test(test_cold_start),  cmocka_unit_test(test_ghosts),
    cmocka_unit_test(test_threads),     cmocka_unit_test(test_jumps),
    cmocka_unit_test(test_alone),       cmocka_unit_test(test_debris),
    cmocka_unit_test(test_coincident),  cmocka_unit_test(test_box_and_budget),
    cmocka_unit_test(test_options),     cmocka_unit_test(test_other_list),
    cmocka_unit_test(test_empty),
};
SPH_TEST_MAIN(tests)
