/* Neighbour structures against a brute-force oracle of their own, for every method, dimension,
 * rule, instruction set and number of threads; and the layout that the pair loops read. */
#include "check.h"

#include "../../src/neighbors/layout.h"

#include <stdlib.h>

#include <sph/context.h>
#include <sph/neighbors.h>

enum { MOST = 1200 };

typedef struct cloud {
  int32_t dim;
  int64_t n;
  double x[MOST * 3], h[MOST];
  int32_t periodic[3];
  double lo[3], hi[3];
  double support;
} cloud;

/* Dense rows: near[i * n + j]. */
static unsigned char near[MOST * MOST];
static cloud shared;

static uint64_t seed = 1;

static double uniform(void) {
  seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return (double)(seed >> 11) * 0x1p-53;
}

/* --- clouds --- */

enum { RANDOM, CLUSTERS, LATTICE, LINE, SHAPES };

static void place(cloud *c, int shape) {
  int64_t side = c->dim == 1 ? c->n : c->dim == 2 ? 15 : 6;
  for (int64_t i = 0; i < c->n; i++) {
    int64_t at[3] = {i % side, i / side % side, i / (side * side)};
    for (int a = 0; a < c->dim; a++) {
      double *x = &c->x[i * c->dim + a];
      *x = uniform();
      if (shape == CLUSTERS) *x = 0.05 * *x + 0.3 * (double)((i * (3 + a)) % 4);
      if (shape == LATTICE) *x = ((double)at[a] + 0.2 * *x) / (double)side;
      if (shape == LINE && a > 0) *x = 0.5;
    }
  }
  if (shape == CLUSTERS) memcpy(&c->x[0], &c->x[4 * c->dim], sizeof(double) * (size_t)c->dim);
}

static void make_cloud(cloud *c, int32_t dim, int64_t n, int shape, int unequal, int periodic) {
  memset(c, 0, sizeof *c);
  c->dim = dim;
  c->n = n;
  c->support = 2.0;
  place(c, shape);
  double typical = dim == 1 ? 0.01 : dim == 2 ? 0.05 : 0.1;
  for (int64_t i = 0; i < n; i++) c->h[i] = unequal ? typical * (0.5 + 1.5 * uniform()) : typical;
  for (int a = 0; a < dim; a++) {
    c->periodic[a] = periodic >> a & 1;
    c->lo[a] = 0.1 * a;
    c->hi[a] = c->lo[a] + 1.0;
    if (!c->periodic[a]) continue;
    for (int64_t i = 0; i < n; i += 3) c->x[i * dim + a] += (double)(i % 5) - 2.0;
  }
}

/* --- the oracle --- */

static double pair_h(int32_t rule, double a, double b) {
  if (rule == SPH_H_ARITHMETIC) return (a + b) / 2.0;
  if (rule == SPH_H_HARMONIC) return 2.0 * a * b / (a + b);
  if (rule == SPH_H_MIN) return fmin(a, b);
  return fmax(a, b);
}

static double distance_to(const cloud *c, const double *p, const double *q) {
  double sum = 0.0;
  for (int a = 0; a < c->dim; a++) {
    double d = fabs(p[a] - q[a]), box = c->hi[a] - c->lo[a];
    if (c->periodic[a]) {
      d = fmod(d, box);
      d = fmin(d, box - d);
    }
    sum += d * d;
  }
  return sqrt(sum);
}

static void find_all(const cloud *c, int32_t rule) {
  for (int64_t i = 0; i < c->n; i++)
    for (int64_t j = 0; j < c->n; j++) {
      double r = distance_to(c, &c->x[i * c->dim], &c->x[j * c->dim]);
      near[i * c->n + j] = i != j && r < c->support * pair_h(rule, c->h[i], c->h[j]);
    }
}

/* --- comparing --- */

static sph_context *make_context(int32_t isa, int32_t threads) {
  sph_context_options o;
  sph_context *ctx = NULL;
  sph_context_options_init(&o);
  o.isa = isa;
  o.threads = threads;
  check_ok(sph_context_create(&o, &ctx));
  return ctx;
}

static sph_neighbors *make_list(sph_context *ctx, const cloud *c, int32_t method, int32_t rule,
                                double skin) {
  sph_neighbors_options o;
  sph_neighbors *list = NULL;
  sph_neighbors_options_init(&o);
  o.method = method;
  o.h_rule = rule;
  o.support = c->support;
  o.skin = skin;
  memcpy(o.periodic, c->periodic, sizeof o.periodic);
  memcpy(o.box_lo, c->lo, sizeof o.box_lo);
  memcpy(o.box_hi, c->hi, sizeof o.box_hi);
  check_ok(sph_neighbors_create(ctx, &o, &list));
  return list;
}

static void build(sph_neighbors *list, const cloud *c) {
  check_ok(sph_neighbors_build_arrays(list, c->dim, c->n, c->x, c->h, 0.0));
}

static void check_rows(sph_neighbors *list, const cloud *c) {
  const int64_t *offsets;
  const int32_t *indices;
  check_ok(sph_neighbors_rows(list, &offsets, &indices));
  assert_int_equal(offsets[0], 0);
  for (int64_t i = 0; i < c->n; i++) {
    int64_t p = offsets[i];
    for (int64_t j = 0; j < c->n; j++) {
      if (!near[i * c->n + j]) continue;
      if (p < offsets[i + 1] && indices[p] == j)
        p++;
      else
        fail_msg("row %lld lacks %lld", (long long)i, (long long)j);
    }
    assert_int_equal(p, offsets[i + 1]);
  }
}

/* What neighbors_impl.h promises. */
static void check_layout(const sph_neighbors *list, const cloud *c) {
  unsigned char seen[MOST] = {0};
  assert_int_equal(list->n, c->n);
  assert_int_equal(list->start[0], 0);
  for (int64_t k = 0; k < list->n; k++) {
    assert_in_range(list->order[k], 0, list->n - 1);
    assert_int_equal(seen[list->order[k]]++, 0);
    for (int64_t p = list->start[k]; p < list->start[k + 1]; p++) {
      assert_int_not_equal(list->pair[p], k);
      if (p > list->start[k]) assert_true(list->pair[p] > list->pair[p - 1]);
    }
  }
  for (int p = 0; p < SPHI_ROW_PADDING; p++)
    assert_int_equal(list->pair[list->start[list->n] + p], 0);
}

static void compare(sph_context *ctx, const cloud *c, int32_t method, int32_t rule) {
  sph_neighbors *list = make_list(ctx, c, method, rule, method == SPH_NEIGHBORS_VERLET ? 0.03 : 0);
  build(list, c);
  check_layout(list, c);
  check_rows(list, c);
  sph_neighbors_destroy(list);
}

/* Every method and instruction set; the numbers of threads take turns, or all in a long run. */
static void compare_everywhere(const cloud *c, int32_t rule) {
  static const int32_t threads[] = {1, 2, 3, 8};
  static int turn = 0;
  for (int32_t isa = SPH_ISA_PORTABLE; isa <= SPH_ISA_AVX512; isa++) {
    turn++;
    for (int t = 0; t < 4 && sph_isa_available(isa); t++) {
      if (!check_long_run && t != turn % 4) continue;
      sph_context *ctx = make_context(isa, threads[t]);
      for (int32_t m = SPH_NEIGHBORS_ALL_PAIRS; m <= SPH_NEIGHBORS_TREE; m++)
        compare(ctx, c, m, rule);
      sph_context_destroy(ctx);
    }
  }
}

static void test_every_combination(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int shape = 0; shape < SHAPES; shape++)
      for (int periodic = 0; periodic < 1 << dim; periodic++)
        for (int32_t rule = 0; rule <= SPH_H_AVERAGE; rule++) {
          int32_t used = rule == 0 ? SPH_H_HARMONIC : rule;
          make_cloud(&shared, dim,
                     check_long_run    ? 343
                     : check_short_run ? 64
                                       : 216,
                     shape, rule > 0, periodic);
          find_all(&shared, used);
          compare_everywhere(&shared, used);
        }
}

/* Exact ties: the cutoff is strict. Coordinates are small integers, so nothing is rounded. */
static void test_ties(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int wraps = 0; wraps < 2; wraps++) {
      cloud *c = &shared;
      make_cloud(c, dim, dim == 1 ? 10 : dim == 2 ? 100 : 1000, RANDOM, 0, 0);
      for (int64_t i = 0; i < c->n; i++) {
        int64_t at[3] = {i % 10, i / 10 % 10, i / 100};
        for (int a = 0; a < dim; a++) c->x[i * dim + a] = (double)at[a];
        c->h[i] = 1.5;
      }
      for (int a = 0; a < dim; a++) {
        c->periodic[a] = wraps;
        c->lo[a] = 0.0;
        c->hi[a] = 10.0;
      }
      find_all(c, SPH_H_ARITHMETIC);
      compare_everywhere(c, SPH_H_ARITHMETIC);
    }
}

/* Periodic boxes of two cutoffs and a little more, where cells are few. */
static void test_small_boxes(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int step = 0; step < 8; step++) {
      cloud *c = &shared;
      make_cloud(c, dim, 200, RANDOM, step & 1, 7);
      double most = 0.0;
      for (int64_t i = 0; i < c->n; i++) most = fmax(most, c->h[i]);
      for (int a = 0; a < dim; a++) {
        double box = 2.0 * (2.0 * most + 0.03) * (1.0 + 0.13 * step * (a + 1));
        for (int64_t i = 0; i < c->n; i++) c->x[i * dim + a] *= box;
        c->hi[a] = c->lo[a] + box;
      }
      find_all(c, SPH_H_MAX);
      compare_everywhere(c, SPH_H_MAX);
    }
}

/* Larger than one chunk, so that waves, copies and growth take part; by count and checksum. */
static uint64_t checksum(const sph_neighbors *list) {
  uint64_t sum = UINT64_C(14695981039346656037);
  for (int64_t k = 0; k < list->n; k++) {
    sum = (sum ^ list->order[k]) * UINT64_C(1099511628211);
    for (int64_t p = list->start[k]; p < list->start[k + 1]; p++)
      sum = (sum ^ list->pair[p]) * UINT64_C(1099511628211);
  }
  return sum;
}

static void fill_big(double *x, double *h, int64_t n, int32_t dim, int shape) {
  for (int64_t i = 0; i < n; i++) {
    for (int a = 0; a < dim; a++) {
      double u = uniform();
      x[i * dim + a] = shape == 0 ? u : u * u * u;
    }
    h[i] = (dim == 3 ? 0.02 : dim == 2 ? 0.006 : 0.00003) * (0.5 + 1.5 * uniform());
  }
}

static int64_t total_pairs(sph_context *ctx, int32_t method, int32_t dim, int64_t n,
                           const double *x, const double *h, uint64_t *sum) {
  cloud c = {.support = 2.0};
  sph_neighbors *list = make_list(ctx, &c, method, SPH_H_ARITHMETIC, 0.0);
  check_ok(sph_neighbors_build_arrays(list, dim, n, x, h, 0.01));
  int64_t pairs = sph_neighbors_pairs(list);
  *sum = checksum(list);
  sph_neighbors_destroy(list);
  return pairs;
}

static void test_large(void **state) {
  (void)state;
  int64_t n = check_long_run ? 200000 : check_short_run ? 5000 : 20000;
  double *x = malloc((size_t)n * 3 * sizeof *x), *h = malloc((size_t)n * sizeof *h);
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int shape = 0; shape < 2; shape++) {
      fill_big(x, h, n, dim, shape);
      int64_t expected = -1;
      uint64_t sums[5] = {0};
      for (int32_t isa = SPH_ISA_PORTABLE; isa <= SPH_ISA_AVX512; isa++)
        for (int32_t threads = 1; threads <= 8 && sph_isa_available(isa); threads *= 2) {
          sph_context *ctx = make_context(isa, threads);
          for (int32_t m = SPH_NEIGHBORS_CELLS; m <= SPH_NEIGHBORS_TREE; m++) {
            uint64_t sum;
            int64_t pairs = total_pairs(ctx, m, dim, n, x, h, &sum);
            if (expected < 0) expected = pairs;
            if (sums[m] == 0) sums[m] = sum;
            assert_int_equal(pairs, expected);
            assert_true(sum == sums[m]);
          }
          sph_context_destroy(ctx);
        }
      assert_true(sums[SPH_NEIGHBORS_CELLS] == sums[SPH_NEIGHBORS_VERLET]);
    }
  free(x);
  free(h);
}

/* A crowd in which everyone is everyone's neighbour, among particles that have none: buffers made
 * for the latter end their chunks early, in the middle of a row block. */
static void test_crowd(void **state) {
  (void)state;
  enum { ALONE = 3000, CROWD = 4200, ALL = ALONE + CROWD };
  static const int32_t methods[] = {SPH_NEIGHBORS_CELLS, SPH_NEIGHBORS_TREE};
  double *x = malloc(ALL * 2 * sizeof *x);
  cloud c = {.support = 2.0};
  for (int64_t i = 0; i < ALL; i++) {
    x[2 * i] = i < ALONE ? (double)(i % 50) : 200.0 + 0.01 * uniform();
    x[2 * i + 1] = i < ALONE ? (double)(i / 50) : 200.0 + 0.01 * uniform();
  }
  for (int k = 0; k < 2; k++) {
    sph_context *ctx = make_context(SPH_ISA_AUTO, k == 0 ? 3 : 1);
    sph_neighbors *list = make_list(ctx, &c, methods[k], SPH_H_MAX, 0.0);
    check_ok(sph_neighbors_build_arrays(list, 2, ALL, x, NULL, 0.25));
    for (int64_t i = 0; i < ALL; i++) {
      int64_t length = list->start[i + 1] - list->start[i];
      assert_int_equal(length, list->order[i] < ALONE ? 0 : CROWD - 1);
      for (int64_t p = list->start[i]; p < list->start[i + 1]; p++)
        if (list->order[list->pair[p]] < ALONE || list->pair[p] == i) fail_msg("a wrong pair");
    }
    sph_neighbors_destroy(list);
    sph_context_destroy(ctx);
  }
  free(x);
}

/* Leaves are counted before they are made. */
static void test_leaves(void **state) {
  (void)state;
  enum { LARGEST = 20000 };
  sph_context *ctx = make_context(SPH_ISA_AUTO, 1);
  double *x = malloc(LARGEST * sizeof *x);
  cloud c = {.support = 2.0};
  sph_neighbors *list = make_list(ctx, &c, SPH_NEIGHBORS_TREE, SPH_H_MAX, 0.0);
  for (int64_t i = 0; i < LARGEST; i++) x[i] = uniform();
  for (int64_t n = 1; n <= LARGEST; n += n < 700 ? 1 : 1 + n / 3) {
    check_ok(sph_neighbors_build_arrays(list, 1, n, x, NULL, 1e-7));
    const sphi_tree *tree = &list->priv->layout[0].tree;
    assert_int_equal(tree->leaf[0], 0);
    assert_int_equal(tree->leaf[tree->leaf_count], n);
    for (uint32_t k = 0; k < tree->leaf_count; k++)
      assert_in_range(tree->leaf[k + 1], tree->leaf[k] + 1, tree->leaf[k] + SPHI_LEAF);
  }
  sph_neighbors_destroy(list);
  sph_context_destroy(ctx);
  free(x);
}

/* Offsets of the public rows, summed in pieces. */
static void test_many_rows(void **state) {
  (void)state;
  enum { N = 40000 };
  sph_context *ctx = make_context(SPH_ISA_AUTO, 3);
  double *x = malloc(N * sizeof *x);
  cloud c = {.support = 2.0};
  const int64_t *offsets;
  const int32_t *indices;
  for (int64_t i = 0; i < N; i++) x[i] = uniform();
  sph_neighbors *list = make_list(ctx, &c, SPH_NEIGHBORS_CELLS, SPH_H_MAX, 0.0);
  check_ok(sph_neighbors_build_arrays(list, 1, N, x, NULL, 1.0 / N));
  check_ok(sph_neighbors_rows(list, &offsets, &indices));
  assert_int_equal(offsets[0], 0);
  assert_int_equal(offsets[N], sph_neighbors_pairs(list));
  for (int64_t k = 0; k < N; k++) {
    int64_t i = list->order[k], count = list->start[k + 1] - list->start[k];
    assert_int_equal(offsets[i + 1] - offsets[i], count);
    for (int64_t p = offsets[i]; p < offsets[i + 1]; p++)
      if (!(fabs(x[indices[p]] - x[i]) < 2.0 / N)) fail_msg("row %lld", (long long)i);
  }
  sph_neighbors_destroy(list);
  sph_context_destroy(ctx);
  free(x);
}

/* --- extremes --- */

/* Everything that all methods must agree on, against the oracle. */
static void check_cloud(const cloud *c) {
  find_all(c, SPH_H_ARITHMETIC);
  compare_everywhere(c, SPH_H_ARITHMETIC);
}

static void test_extremes(void **state) {
  (void)state;
  cloud *c = &shared;
  for (int32_t dim = 1; dim <= 3; dim++) {
    make_cloud(c, dim, 300, RANDOM, 0, 0);
    c->x[17 * dim] = 1e30;
    c->x[40 * dim] = -1e30;
    c->x[41 * dim] = -1e30;
    for (int a = 1; a < dim; a++) c->x[40 * dim + a] = c->x[41 * dim + a] = 0.5;
    check_cloud(c);
    c->x[18 * dim + dim - 1] = 1.7e308;
    c->x[19 * dim + dim - 1] = -1.7e308;
    check_cloud(c);
    make_cloud(c, dim, 300, RANDOM, 1, 0);
    for (int64_t i = 0; i < 300 * dim; i++) c->x[i] = 0.25; /* coincident */
    check_cloud(c);
    make_cloud(c, dim, 300, RANDOM, 1, 0);
    for (int64_t i = 0; i < 300; i++) c->h[i] = 10.0; /* one cell, all neighbours */
    check_cloud(c);
    make_cloud(c, dim, 300, RANDOM, 1, 0);
    for (int64_t i = 0; i < 300; i++) c->h[i] *= i % 2 ? 1e-9 : 1.0;
    check_cloud(c);
    for (int64_t i = 0; i < 300; i++) c->h[i] = i % 2 ? 1e-200 : 1e200;
    check_cloud(c);
    make_cloud(c, dim, 1, RANDOM, 0, 0);
    check_cloud(c);
    make_cloud(c, dim, 0, RANDOM, 0, 0);
    check_cloud(c);
  }
}

static void test_scales(void **state) {
  (void)state;
  cloud *c = &shared;
  static const double units[] = {1e-140, 1e-30, 1e30, 1e140};
  for (int u = 0; u < 4; u++)
    for (int32_t dim = 1; dim <= 3; dim++) {
      make_cloud(c, dim, 300, RANDOM, u & 1, 0);
      for (int64_t i = 0; i < 300 * dim; i++) c->x[i] *= units[u];
      for (int64_t i = 0; i < 300; i++) c->h[i] *= units[u];
      check_cloud(c);
    }
  for (int32_t dim = 1; dim <= 3; dim++) { /* far from the origin */
    make_cloud(c, dim, 300, RANDOM, 1, 0);
    for (int64_t i = 0; i < 300 * dim; i++) c->x[i] += 1e9;
    check_cloud(c);
  }
}

/* Few particles in a huge box: memory stays of the order of the particles. */
static void test_sparse_memory(void **state) {
  (void)state;
  for (int32_t m = SPH_NEIGHBORS_CELLS; m <= SPH_NEIGHBORS_TREE; m++) {
    sph_context *ctx = make_context(SPH_ISA_AUTO, 2);
    cloud *c = &shared;
    make_cloud(c, 3, 1000, RANDOM, 0, 0);
    for (int64_t i = 0; i < 3000; i++) c->x[i] *= 1e12;
    sph_neighbors *list = make_list(ctx, c, m, SPH_H_MAX, 0.0);
    build(list, c);
    int64_t peak;
    check_ok(sph_context_memory(ctx, NULL, &peak, NULL));
    assert_true(peak < 16 << 20);
    assert_int_equal(sph_neighbors_pairs(list), 0);
    sph_neighbors_destroy(list);
    sph_context_destroy(ctx);
  }
}

/* --- queries --- */

static void check_query(const sph_neighbors *list, const cloud *c, const double *p, double radius) {
  int32_t got[MOST], few[7];
  int64_t found, again, count = 0;
  check_ok(sph_neighbors_query(list, p, radius, MOST, got, &found));
  for (int64_t i = 0; i < c->n; i++) {
    if (!(distance_to(c, p, &c->x[i * c->dim]) < radius)) continue;
    assert_true(count < found);
    assert_int_equal(got[count], i);
    count++;
  }
  assert_int_equal(found, count);
  check_ok(sph_neighbors_query(list, p, radius, 7, few, &again));
  assert_int_equal(again, found);
  for (int64_t i = 0; i < found && i < 7; i++) assert_int_equal(few[i], got[i]);
  check_ok(sph_neighbors_query(list, p, radius, 0, NULL, &again));
  assert_int_equal(again, found);
}

static void test_queries(void **state) {
  (void)state;
  sph_context *ctx = make_context(SPH_ISA_AUTO, 1);
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int periodic = 0; periodic < 1 << dim; periodic++)
      for (int32_t m = SPH_NEIGHBORS_ALL_PAIRS; m <= SPH_NEIGHBORS_TREE; m++) {
        make_cloud(&shared, dim, 343, periodic & 1 ? LATTICE : RANDOM, 1, periodic);
        sph_neighbors *list = make_list(ctx, &shared, m, SPH_H_MAX, 0.0);
        build(list, &shared);
        for (int q = 0; q < 60; q++) {
          double p[3] = {3.0 * uniform() - 1.0, 3.0 * uniform() - 1.0, 3.0 * uniform() - 1.0};
          check_query(list, &shared, p, pow(10.0, -2.0 + 3.0 * uniform()));
        }
        sph_neighbors_destroy(list);
      }
  sph_context_destroy(ctx);
}

/* --- Verlet --- */

static void jiggle(cloud *c, double most) {
  for (int64_t i = 0; i < c->n * c->dim; i++)
    c->x[i] += most * (2.0 * uniform() - 1.0) / sqrt((double)c->dim);
}

/* Rows and queries are right at every step, also just before a rebuild; it is rebuilt only when
 * twice the largest displacement exceeds the skin. */
static void test_verlet(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int periodic = 0; periodic < 2; periodic++) {
      sph_context *ctx = make_context(SPH_ISA_AUTO, 2);
      cloud *c = &shared;
      make_cloud(c, dim, 343, RANDOM, 1, periodic ? 7 : 0);
      sph_neighbors *list = make_list(ctx, c, SPH_NEIGHBORS_VERLET, SPH_H_ARITHMETIC, 0.02);
      build(list, c);
      double origin[MOST * 3];
      memcpy(origin, c->x, sizeof origin);
      int reused = 0, built = 0;
      for (int step = 0; step < 40; step++) {
        jiggle(c, 0.002);
        double most = 0.0;
        for (int64_t i = 0; i < c->n; i++) {
          double sum = 0.0;
          for (int a = 0; a < dim; a++) sum += pow(c->x[i * dim + a] - origin[i * dim + a], 2);
          most = fmax(most, sqrt(sum));
        }
        int32_t rebuilt = -1;
        check_ok(sph_neighbors_update_arrays(list, dim, c->n, c->x, c->h, 0.0, &rebuilt));
        assert_int_equal(rebuilt, 2.0 * most > 0.02);
        if (rebuilt) memcpy(origin, c->x, sizeof origin);
        reused += !rebuilt;
        built += rebuilt;
        find_all(c, SPH_H_ARITHMETIC);
        check_rows(list, c);
        double p[3] = {uniform(), uniform(), uniform()};
        check_query(list, c, p, 0.2);
      }
      assert_true(reused > 5 && built > 1);
      sph_neighbors_destroy(list);
      sph_context_destroy(ctx);
    }
}

/* Two particles that approach each other by exactly the skin are found just in time. */
static void test_verlet_rule(void **state) {
  (void)state;
  sph_context *ctx = make_context(SPH_ISA_AUTO, 1);
  cloud *c = &shared;
  int32_t rebuilt;
  make_cloud(c, 1, 2, RANDOM, 0, 0);
  c->h[0] = c->h[1] = 0.5;
  c->x[0] = 0.0;
  c->x[1] = 1.24;
  sph_neighbors *list = make_list(ctx, c, SPH_NEIGHBORS_VERLET, SPH_H_MAX, 0.25);
  build(list, c);
  assert_int_equal(sph_neighbors_pairs(list), 2);
  c->x[0] = 0.125;
  c->x[1] = 1.12;
  check_ok(sph_neighbors_update_arrays(list, 1, 2, c->x, c->h, 0.0, &rebuilt));
  assert_int_equal(rebuilt, 0);
  find_all(c, SPH_H_MAX);
  assert_true(near[1]);
  check_rows(list, c);
  c->x[0] = 0.1250001;
  check_ok(sph_neighbors_update_arrays(list, 1, 2, c->x, c->h, 0.0, &rebuilt));
  assert_int_equal(rebuilt, 1);
  c->h[1] = 0.51;
  check_ok(sph_neighbors_update_arrays(list, 1, 2, c->x, c->h, 0.0, &rebuilt));
  assert_int_equal(rebuilt, 1);
  check_ok(sph_neighbors_update_arrays(list, 1, 2, c->x, c->h, 0.0, &rebuilt));
  assert_int_equal(rebuilt, 0);
  sph_neighbors_destroy(list);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_every_combination),
    cmocka_unit_test(test_ties),
    cmocka_unit_test(test_small_boxes),
    cmocka_unit_test(test_large),
    cmocka_unit_test(test_crowd),
    cmocka_unit_test(test_leaves),
    cmocka_unit_test(test_many_rows),
    cmocka_unit_test(test_extremes),
    cmocka_unit_test(test_scales),
    cmocka_unit_test(test_sparse_memory),
    cmocka_unit_test(test_queries),
    cmocka_unit_test(test_verlet),
    cmocka_unit_test(test_verlet_rule),
};

SPH_TEST_MAIN(tests)
