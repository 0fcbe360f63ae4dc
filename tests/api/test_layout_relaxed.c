/* Centroidal layouts: exact layouts, centroids and moments in closed form and by sampling, energy,
 * refusals, memory. */
#include "../relax_help.h"

/* ---- exact ------------------------------------------------------------------------------- */

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* In 1-D one layout alone is centroidal: (i + 1/2) / n, energy 1 / (12 n^2). */
static void test_line(void **state) {
  (void)state;
  enum { N = 10 };
  sph_context *ctx = context_of(1);
  double *x = scattered(ctx, 1, N), v[N];
  sph_region_options r = box_of(1);
  sph_relax_options o = relax_of(5000, 1e-13);
  sph_relax_result result;
  check_ok(relax(ctx, &r, &o, N, x, v, &result));
  assert_true(result.iterations > 10 && result.iterations < 5000);
  qsort(x, N, sizeof *x, ascending);
  for (int i = 0; i < N; i++) {
    check_close(x[i], (i + 0.5) / N, 1e-10);
    check_close(v[i], 1.0 / N, 1e-10);
  }
  check_rel(result.energy, 1.0 / (12.0 * N * N), 1e-9);
  check_close(result.smallest, 0.1, 1e-10);
  check_close(result.largest, 0.1, 1e-10);
  free(x);
  sph_context_destroy(ctx);
}

/* A centred lattice stays: energy of a cell d s^(d + 2) / 12. */
static void test_lattice(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  for (int32_t dim = 1; dim <= 3; dim++) {
    double x[3 * 64], before[3 * 64], v[64];
    int64_t n = 0;
    sph_lattice_options l;
    sph_lattice_options_init(&l);
    l.dim = dim;
    l.spacing = dim == 3 ? 0.25 : 0.125;
    check_ok(sph_layout_lattice(ctx, &l, 64, x, &n));
    memcpy(before, x, sizeof before);
    sph_region_options r = box_of(dim);
    sph_relax_result result;
    check_ok(relax(ctx, &r, NULL, n, x, v, &result));
    assert_int_equal(result.iterations, 1); /* it sees that nothing moved */
    assert_true(result.moved < 1e-15);
    for (int64_t k = 0; k < n * dim; k++) check_close(x[k], before[k], 1e-15);
    check_rel(result.energy, (double)n * dim * pow(l.spacing, dim + 2) / 12.0, 1e-12);
    for (int64_t i = 0; i < n; i++) check_rel(v[i], pow(l.spacing, dim), 1e-12);
  }
  sph_context_destroy(ctx);
}

static int32_t in_half_disc(void *user, const double *p) {
  (void)user;
  return p[1] >= 0.0 && p[0] * p[0] + p[1] * p[1] < 1.0;
}
static int32_t in_triangle(void *user, const double *p) {
  (void)user;
  return p[0] > 0.0 && p[1] > 0.0 && p[0] + 2.0 * p[1] < 1.0;
}

/* One particle goes to the centroid of the region: half a disc (0, 4 / (3 pi)), its second moment
 * about it pi/4 - pi/2 (4 / (3 pi))^2; a triangle; a box less a corner of a disc. */
static void test_centroids(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  sph_relax_options o = relax_of(20, 1e-12);
  sph_relax_result result;
  double x[3] = {0.3, 0.2, 0.7}, v[1];
  o.relaxation = 1.0;
  sph_region_options r = box_of(2);
  r.lo[0] = r.lo[1] = -1.0;
  r.levels = 9;
  r.inside = in_half_disc;
  check_ok(relax(ctx, &r, &o, 1, x, v, &result));
  const double height = 4.0 / (3.0 * pi);
  check_close(x[0], 0.0, 1e-5);
  check_close(x[1], height, 1e-5);
  check_close(v[0], 0.5 * pi, 1e-4);
  check_close(result.energy, 0.25 * pi - 0.5 * pi * height * height, 1e-4);
  r.inside = in_triangle;
  r.lo[0] = r.lo[1] = 0.0;
  r.hi[1] = 0.5;
  check_ok(relax(ctx, &r, &o, 1, (x[0] = 0.1, x), v, &result));
  check_close(x[0], 1.0 / 3.0, 1e-7);
  check_close(x[1], 1.0 / 6.0, 1e-7);
  check_close(v[0], 0.25, 1e-7);
  check_close(result.energy, 5.0 / 288.0, 1e-7); /* A (a^2 + b^2) / 18, legs 1 and 1/2 */
  const double hole[3] = {1.0, 1.0, 1.0}, cut = 0.25 * pi;
  r = box_of(2); /* first moment of a quarter disc: 1/3 from its corner */
  r.levels = 9;
  r.holes = 1;
  r.hole = hole;
  check_ok(relax(ctx, &r, &o, 1, (x[0] = x[1] = 0.1, x), v, &result));
  for (int a = 0; a < 2; a++) check_close(x[a], (0.5 - (cut - 1.0 / 3.0)) / (1.0 - cut), 2e-5);
  check_rel(v[0], 1.0 - cut, 1e-12); /* holes are exact in the volume */
  r = box_of(3);
  r.hi[0] = 2.0;
  check_ok(relax(ctx, &r, &o, 1, (x[0] = 1.9, x), v, &result));
  for (int a = 0; a < 3; a++) check_close(x[a], a == 0 ? 1.0 : 0.5, 1e-11);
  check_rel(result.energy, 2.0 * (4.0 + 1.0 + 1.0) / 12.0, 1e-12);
  sph_context_destroy(ctx);
}

static int32_t in_ball(void *user, const double *p) {
  (void)user;
  return p[0] * p[0] + p[1] * p[1] + p[2] * p[2] < 1.0;
}

/* Half a ball: 3/8 of the radius above its base, int |y - c|^2 = 2 pi/5 - 2 pi/3 (3/8)^2; and the
 * ball shared by a lattice: the error of the sum falls by four with each level. */
static void test_ball(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  sph_region_options r = box_of(3);
  sph_relax_options o = relax_of(12, 0.0);
  sph_relax_result result;
  double x[3] = {0.2, 0.1, 0.3}, v[1], error[3];
  r.lo[0] = r.lo[1] = -1.0;
  r.inside = in_ball;
  r.levels = 4;
  o.relaxation = 1.0;
  check_ok(relax(ctx, &r, &o, 1, x, v, &result));
  check_rel(v[0], 2.0 * pi / 3.0, 3e-3);
  check_close(x[0], 0.0, 2e-3);
  check_close(x[1], 0.0, 2e-3);
  check_close(x[2], 0.375, 2e-3);
  check_rel(result.energy, 2.0 * pi / 5.0 - 2.0 * pi / 3.0 * 9.0 / 64.0, 6e-3);
  sph_lattice_options l;
  sph_lattice_options_init(&l);
  l.dim = 3;
  l.spacing = 0.5;
  l.inside = in_ball;
  for (int a = 0; a < 3; a++) l.lo[a] = r.lo[a] = -1.0;
  double lattice[3 * 64], volume[64];
  int64_t n = 0;
  check_ok(sph_layout_lattice(ctx, &l, 64, lattice, &n));
  for (int level = 0; level < 3; level++) {
    double sum = 0.0;
    r.levels = 1 + level;
    check_ok(sph_layout_volumes(ctx, &r, n, lattice, volume));
    for (int64_t i = 0; i < n; i++) sum += volume[i];
    error[level] = fabs(sum - 4.0 * pi / 3.0);
  }
  check_close(error[1] / error[0], 0.25, 0.1);
  check_close(error[2] / error[1], 0.25, 0.1);
  assert_true(error[2] < 0.02);
  sph_context_destroy(ctx);
}

/* ---- properties -------------------------------------------------------------------------- */

static int32_t in_ring(void *user, const double *p) {
  const double dx = p[0] - 0.5, dy = p[1] - 0.5, r2 = dx * dx + dy * dy;
  (void)user;
  return r2 < 0.23 && r2 > 0.03;
}

/* Sum over the samples of a fine grid of |y - nearest particle|^2, and the centroids. */
static double sampled(const sph_region_options *r, int64_t n, const double *x, int side,
                      double *centroid) {
  const int d = r->dim;
  double energy = 0.0, *volume = (double *)calloc((size_t)n, sizeof *volume);
  int64_t samples = 1;
  assert_non_null(volume);
  memset(centroid, 0, (size_t)(n * d) * sizeof *centroid);
  for (int a = 0; a < d; a++) samples *= side;
  for (int64_t s = 0; s < samples; s++) {
    double p[3], best = INFINITY;
    int64_t rest = s, owner = 0;
    for (int a = 0; a < d; a++, rest /= side) p[a] = ((double)(rest % side) + 0.5) / side;
    if (r->inside && !r->inside(r->inside_user, p)) continue;
    for (int64_t i = 0; i < n; i++) {
      double square = 0.0;
      for (int a = 0; a < d; a++) square += (p[a] - x[i * d + a]) * (p[a] - x[i * d + a]);
      if (square < best) best = square, owner = i;
    }
    energy += best / (double)samples;
    volume[owner] += 1.0;
    for (int a = 0; a < d; a++) centroid[owner * d + a] += p[a];
  }
  for (int64_t k = 0; k < n * d; k++) centroid[k] /= volume[k / d];
  free(volume);
  return energy;
}

/* Energy against samples; and when it has settled, every particle is the centroid of its samples.
 */
static void test_sampling(void **state) {
  (void)state;
  enum { N = 25 };
  sph_context *ctx = context_of(1);
  for (int32_t dim = 1; dim <= (check_short_run ? 1 : 3); dim++)
    for (int region = 0; region < (dim == 2 ? 2 : 1); region++) {
      const int side = dim == 1 ? 20000 : dim == 2 ? 300 : 50;
      double *x = scattered(ctx, dim, N), centroid[3 * N];
      sph_region_options r = box_of(dim);
      sph_relax_result result;
      if (region) {
        r.inside = in_ring;
        r.levels = 4;
        for (int i = 0; i < N; i++) {
          x[2 * i] = 0.5 + 0.3 * cos(i * i);
          x[2 * i + 1] = 0.5 + 0.3 * sin(i * i);
        }
      }
      sph_relax_options o = relax_of(0, 0.0);
      check_ok(relax(ctx, &r, &o, N, x, NULL, &result));
      check_rel(result.energy, sampled(&r, N, x, side, centroid), 5e-3);
      o = relax_of(2000, 1e-6);
      check_ok(relax(ctx, &r, &o, N, x, NULL, &result));
      check_rel(result.energy, sampled(&r, N, x, side, centroid), 5e-3);
      assert_true(result.iterations < 2000);
      const double s = pow(1.0 / N, 1.0 / dim);
      for (int k = 0; k < N * dim; k++) check_close(x[k], centroid[k], 0.02 * s);
      free(x);
    }
  sph_context_destroy(ctx);
}

/* The energy falls with every iteration, whatever the relaxation, and the volumes add up. */
static void test_energy_falls(void **state) {
  (void)state;
  sph_context *ctx = context_of(2);
  const double relaxation[] = {0.3, 1.0, 1.5, 1.95};
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int k = 0; k < 4; k++) {
      const int64_t n = dim == 3 ? 60 : 150;
      double *x = scattered(ctx, dim, n), *v = (double *)malloc((size_t)n * sizeof *v);
      sph_region_options r = box_of(dim);
      sph_relax_options o = relax_of(0, 0.0);
      sph_relax_result result;
      o.relaxation = relaxation[k];
      check_ok(relax(ctx, &r, &o, n, x, v, &result));
      o.iterations = 1;
      for (int it = 0; it < (check_short_run ? 3 : 25); it++) {
        double before = result.energy, sum = 0.0;
        check_ok(relax(ctx, &r, &o, n, x, v, &result));
        if (!(result.energy < before)) fail_msg("%d-D, %g: %d", dim, relaxation[k], it);
        for (int64_t i = 0; i < n; i++) sum += v[i];
        check_rel(sum, 1.0, 1e-12);
      }
      free(x), free(v);
    }
  sph_context_destroy(ctx);
}

/* Fejes Toth: no n cells of a convex polygon have less than n hexagons of the same area, 5 / (18
 * sqrt 3) A^2 each; a square lattice has 1/6 A^2. */
static void test_quality(void **state) {
  (void)state;
  enum { N = 400 };
  sph_context *ctx = context_of(2);
  double *x = scattered(ctx, 2, N);
  sph_region_options r = box_of(2);
  sph_relax_options o = relax_of(300, 1e-4);
  sph_relax_result result;
  check_ok(relax(ctx, &r, &o, N, x, NULL, &result));
  const double energy = result.energy * N; /* over A^2 = 1 / N^2 a cell */
  assert_true(energy > 5.0 / (18.0 * sqrt(3.0)) && energy < 1.0 / 6.0);
  assert_true(result.smallest > 0.7 / N && result.largest < 1.3 / N);
  free(x);
  sph_context_destroy(ctx);
}

static void test_threads(void **state) {
  (void)state;
  enum { N = 500 };
  double first[3 * N];
  for (int32_t threads = 1; threads <= 5; threads += 2) {
    sph_context *ctx = context_of(threads);
    double *x = scattered(ctx, 2, N), v[N];
    sph_region_options r = box_of(2);
    sph_relax_options o = relax_of(5, 0.0);
    sph_relax_result result;
    r.inside = in_ring;
    r.levels = 2;
    for (int i = 0; i < N; i++) {
      x[2 * i] = 0.5 + (0.2 + 0.25 * i / N) * cos(1.7 * i);
      x[2 * i + 1] = 0.5 + (0.2 + 0.25 * i / N) * sin(1.7 * i);
    }
    check_ok(relax(ctx, &r, &o, N, x, v, &result));
    if (threads == 1) {
      memcpy(first, x, 2 * N * sizeof *x);
      memcpy(first + 2 * N, v, N * sizeof *x);
    }
    assert_memory_equal(x, first, 2 * N * sizeof *x);
    assert_memory_equal(v, first + 2 * N, N * sizeof *x);
    free(x);
    sph_context_destroy(ctx);
  }
}

/* ---- refusals ---------------------------------------------------------------------------- */

static void test_relax_refusals(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  double x[4] = {0.25, 0.5, 0.75, 0.5}, v[2] = {7.0, 7.0};
  const sph_region_options good_region = box_of(2);
  sph_region_options r;
  sph_relax_options o;
  sph_relax_result result;
#define BAD(change, status, words)                            \
  sph_relax_options_init(&o), r = good_region, change;        \
  check_status(relax(ctx, &r, &o, 2, x, v, &result), status); \
  said(ctx, words);                                           \
  assert_true(v[0] == 7.0 && x[0] == 0.25 && result.energy == 0.0)
  BAD(o.iterations = -1, SPH_ERR_ARG, "iterations = -1");
  BAD(o.tolerance = NAN, SPH_ERR_ARG, "tolerance = nan");
  BAD(o.relaxation = 2.0, SPH_ERR_ARG, "relaxation = 2");
  BAD(o.relaxation = 0.0, SPH_ERR_ARG, "relaxation = 0");
  BAD(r.dim = 4, SPH_ERR_ARG, "dim is 4");
  BAD(r.inside = in_triangle, SPH_ERR_ARG, "particle 0 is not in the region");
  BAD(r.hi[0] = 0.7, SPH_ERR_ARG, "particle 1");
#undef BAD
  x[2] = x[0], x[3] = x[1];
  check_status(relax(ctx, &good_region, NULL, 2, x, v, &result), SPH_ERR_ARG);
  said(ctx, "where particle 0 is");
  check_status(sph_layout_relax(ctx, &good_region, NULL, -1, x, v, NULL), SPH_ERR_ARG);
  check_ok(sph_layout_relax(ctx, &good_region, NULL, 0, NULL, NULL, NULL));
  check_ok(sph_layout_relax(ctx, &good_region, NULL, 1, x, NULL, NULL));
  check_close(x[0], 0.5, 1e-3); /* the default tolerance */
  sph_context_destroy(ctx);
}

/* ---- memory ------------------------------------------------------------------------------ */

static sph_status relaxed_scenario(sph_context *ctx, void *user) {
  double x[2 * 30], before[2 * 30], v[30];
  (void)user;
  for (int i = 0; i < 60; i++) before[i] = x[i] = 0.5 + 0.49 * sin(1.3 * i + 0.1 * i * i);
  sph_region_options r = box_of(2);
  sph_relax_options o = relax_of(2, 0.0);
  const sph_status s = sph_layout_relax(ctx, &r, &o, 30, x, v, NULL);
  assert_true((memcmp(x, before, sizeof x) == 0) == (s != SPH_OK));
  return s;
}

static void test_memory(void **state) {
  (void)state;
  oom_sweep(relaxed_scenario, NULL);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_line),           cmocka_unit_test(test_lattice),
    cmocka_unit_test(test_centroids),      cmocka_unit_test(test_sampling),
    cmocka_unit_test(test_ball),           cmocka_unit_test(test_energy_falls),
    cmocka_unit_test(test_quality),        cmocka_unit_test(test_threads),
    cmocka_unit_test(test_relax_refusals), cmocka_unit_test(test_memory),
};
SPH_TEST_MAIN(tests)
