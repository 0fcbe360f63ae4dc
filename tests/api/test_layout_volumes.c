/* Volumes of particles: closed forms, a brute-force oracle, symmetry, any number of threads;
 * refusals and memory. */
#include "../layout_help.h"
#include "../oom.h"

/* Equal cells of a lattice, in 1-D, 2-D, 3-D; halves, quarters and eighths on faces. */
static void test_lattice_volumes(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  for (int32_t dim = 1; dim <= 3; ++dim)
    for (int32_t anchor = SPH_LATTICE_CENTRED; anchor <= SPH_LATTICE_FACES; ++anchor) {
      sph_lattice_options o = lattice_of(dim, SPH_LATTICE_CARTESIAN, anchor, 0.2);
      sph_region_options box = region(dim, 0, NULL);
      int64_t n;
      for (int a = 0; a < 3; ++a) o.lo[a] = -1.0;
      double *x = lattice(ctx, &o, &n), *v = room(n);
      check_ok(sph_layout_volumes(ctx, &box, n, x, v));
      for (int64_t i = 0; i < n; ++i) {
        double want = 1.0;
        for (int32_t a = 0; a < dim; ++a) want *= fabs(x[i * dim + a]) == 1.0 ? 0.1 : 0.2;
        check_rel(v[i], want, 1e-12);
      }
      check_rel(sum(n, v), pow(2.0, dim), 1e-12);
      free(x), free(v);
    }
  sph_context_destroy(ctx);
}

/* Hexagonal cells away from the faces: s^2 sqrt(3)/2 and s^3 / sqrt(2). */
static void test_hexagonal_volumes(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  for (int32_t dim = 2; dim <= 3; ++dim) {
    const double s = 2.0 / 8;
    sph_lattice_options o = lattice_of(dim, SPH_LATTICE_HEXAGONAL, SPH_LATTICE_CENTRED, s);
    sph_region_options box = region(dim, 0, NULL);
    int64_t n, interior = 0;
    for (int a = 0; a < 3; ++a) {
      o.lo[a] = 0.0;
      o.hi[a] = (a == 0 ? 1.0 : a == 1 ? sqrt(0.75) : sqrt(2.0 / 3.0)) * 8 * s;
      box.lo[a] = o.lo[a], box.hi[a] = o.hi[a];
    }
    double *x = lattice(ctx, &o, &n), *v = room(n);
    check_ok(sph_layout_volumes(ctx, &box, n, x, v));
    for (int64_t i = 0; i < n; ++i) {
      int far = 1;
      for (int32_t a = 0; a < dim; ++a)
        far &= x[i * dim + a] > 1.2 * s && x[i * dim + a] < o.hi[a] - 1.2 * s;
      if (!far) continue;
      check_rel(v[i], dim == 2 ? sqrt(0.75) * s * s : s * s * s / sqrt(2.0), 1e-12);
      interior++;
    }
    assert_true(interior > (dim == 2 ? 20 : 100));
    free(x), free(v);
  }
  sph_context_destroy(ctx);
}

/* Scattered points: each volume against counting a fine grid of samples by the nearest point. */
static void test_oracle(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  for (int32_t dim = 1; dim <= 3; ++dim) {
    enum { N = 30 };
    const int side = dim == 1 ? 100000 : dim == 2 ? 400 : 60;
    double x[3 * N], v[N], counted[N] = {0.0}, samples = pow(side, dim);
    sph_region_options box = region(dim, dim == 2 ? 1 : 0, centre_hole);
    for (int k = 0; k < 3 * N; ++k) x[k] = 0.0;
    check_ok(sph_layout_jitter(ctx, dim, 0.95, 3, NULL, NULL, N, x));
    check_ok(sph_layout_volumes(ctx, &box, N, x, v));
    for (int64_t s = 0; s < (int64_t)samples; ++s) {
      double p[3], best = 1e9;
      int64_t rest = s;
      int owner = 0;
      for (int32_t a = 0; a < dim; ++a, rest /= side)
        p[a] = -1.0 + ((double)(rest % side) + 0.5) * 2.0 / side;
      if (dim == 2 && hypot(p[0], p[1]) < 0.3) continue;
      for (int i = 0; i < N; ++i) {
        const double r = distance(dim, x + i * dim, p);
        if (r < best) best = r, owner = i;
      }
      counted[owner] += pow(2.0, dim) / samples;
    }
    const double measure = pow(2.0, dim) - (dim == 2 ? pi * 0.09 : 0.0);
    check_rel(sum(N, v), measure, 1e-12);
    for (int i = 0; i < N; ++i)
      check_close(v[i], counted[i], 2e-3 * measure / N * (dim == 3 ? 8 : 5));
  }
  sph_context_destroy(ctx);
}

/* All layouts about holes: the areas add up, and mirrored particles have the same. */
static void test_hole_volumes(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  for (int k = 0; k < 3; ++k)
    for (int32_t count = 1; count <= 9; count += 8)
      for (int quarter = 0; quarter < 2; ++quarter) {
        int64_t n;
        double area = 4.0;
        sph_hole_layout_options o = plate(all_kinds[k], count, nine, 0.04);
        sph_region_options r = region(2, count, nine);
        for (int h = 0; h < count; ++h) area -= pi * nine[3 * h + 2] * nine[3 * h + 2];
        if (quarter) {
          o.lo[0] = o.lo[1] = r.lo[0] = r.lo[1] = 0.0;
          o.faces = SPH_FACE_X_HI | SPH_FACE_Y_HI;
          area *= 0.25;
        }
        double *x = holes(ctx, &o, &n), *v = room(n);
        check_ok(sph_layout_volumes(ctx, &r, n, x, v));
        check_rel(sum(n, v), area, 1e-12);
        for (int64_t i = 0; i < n; ++i) {
          assert_true(v[i] > 0.0);
          for (int64_t j = 0; j < n && !quarter; ++j)
            if (x[2 * j] == -x[2 * i] && x[2 * j + 1] == x[2 * i + 1]) check_rel(v[j], v[i], 1e-10);
        }
        free(x), free(v);
      }
  sph_context_destroy(ctx);
}

/* A host's region: the sum errs as documented, and by a quarter of it with each level. */
static void test_inside_volumes(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  double r = 0.8, error[3];
  int64_t n;
  sph_lattice_options o = lattice_of(2, SPH_LATTICE_CARTESIAN, SPH_LATTICE_CENTRED, 0.1);
  sph_region_options disc = region(2, 0, NULL);
  o.lo[0] = o.lo[1] = -1.0;
  o.inside = disc.inside = in_disc;
  o.inside_user = disc.inside_user = &r;
  double *x = lattice(ctx, &o, &n), *v = room(n);
  for (int level = 0; level < 3; ++level) {
    disc.levels = 2 + level;
    check_ok(sph_layout_volumes(ctx, &disc, n, x, v));
    error[level] = fabs(sum(n, v) - pi * r * r);
    assert_true(error[level] < 2 * pi * r * pow(0.1 / pow(2.0, disc.levels), 2.0) / (12.0 * r));
  }
  check_close(error[1] / error[0], 0.25, 0.1);
  check_close(error[2] / error[1], 0.25, 0.1);
  disc.levels = 9;
  disc.holes = 1, disc.hole = centre_hole; /* both ways to say what is left out */
  check_ok(sph_layout_volumes(ctx, &disc, n, x, v));
  check_rel(sum(n, v), pi * (r * r - 0.09), 2e-7);
  free(x), free(v);
  double line[4] = {-0.6, -0.1, 0.3, 0.7}, length[4];
  sph_region_options segment = region(1, 0, NULL);
  check_ok(sph_layout_volumes(ctx, &segment, 4, line, length));
  const double want[4] = {0.65, 0.45, 0.4, 0.5};
  for (int i = 0; i < 4; ++i) check_close(length[i], want[i], 1e-15);
  sph_context_destroy(ctx);
}

static int32_t in_segment(void *user, const double *p) {
  const double *ends = user;
  return p[0] > ends[0] && p[0] < ends[1];
}

static void test_inside_line(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  double x[3] = {-0.5, 0.0, 0.5}, v[3], ends[2] = {-0.6, 0.123456};
  sph_region_options o = region(1, 0, NULL);
  o.inside = in_segment, o.inside_user = ends;
  check_ok(sph_layout_volumes(ctx, &o, 3, x, v));
  check_close(v[0], 0.35, 1e-9);
  check_close(v[1], 0.25 + 0.123456, 1e-9);
  check_close(v[2], 0.0, 0.0);
  sph_context_destroy(ctx);
}

/* A cell with more neighbours than a worker has room for: the hub of a wheel, with 1000 corners. */
static void test_crowded(void **state) {
  (void)state;
  enum { RIM = 1000 };
  sph_context *ctx = context_of(2);
  double *x = room(2 * RIM + 2), *v = room(RIM + 1);
  sph_region_options box = region(2, 0, NULL);
  x[0] = x[1] = 0.0;
  for (int k = 1; k <= RIM; ++k) {
    x[2 * k] = 0.01 * cos(2 * pi * k / RIM);
    x[2 * k + 1] = 0.01 * sin(2 * pi * k / RIM);
  }
  check_ok(sph_layout_volumes(ctx, &box, RIM + 1, x, v));
  check_rel(v[0], RIM * 0.005 * 0.005 * tan(pi / RIM), 1e-9); /* a polygon of apothem .005 */
  check_rel(sum(RIM + 1, v), 4.0, 1e-12);
  free(x), free(v);
  sph_context_destroy(ctx);
}

static void test_threads(void **state) {
  (void)state;
  sph_context *one = context_of(1), *many = context_of(4);
  int64_t n, m;
  sph_hole_layout_options o = plate(SPH_HOLES_EQUALLY_RADIAL, 9, nine, 0.03);
  sph_region_options r = region(2, 9, nine);
  double *x = holes(one, &o, &n), *y = holes(many, &o, &m), *v = room(n), *w = room(n);
  assert_int_equal(n, m);
  assert_memory_equal(x, y, (size_t)n * 2 * sizeof *x);
  check_ok(sph_layout_volumes(one, &r, n, x, v));
  check_ok(sph_layout_volumes(many, &r, n, x, w));
  assert_memory_equal(v, w, (size_t)n * sizeof *v);
  free(x), free(y), free(v), free(w);
  sph_context_destroy(one);
  sph_context_destroy(many);
}

/* ---- refusals ---------------------------------------------------------------------------- */

static void test_volume_refusals(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  const double overlapping[6] = {0, 0, .3, .4, 0, .2};
  double x[6] = {0.1, 0.1, 0.5, 0.5, -0.5, 0.5}, v[3] = {7.0, 7.0, 7.0};
  const sph_region_options good = region(2, 0, NULL);
  sph_region_options o;
#define BAD(change, status, word)                                               \
  o = good, change, check_status(sph_layout_volumes(ctx, &o, 3, x, v), status); \
  assert_true(v[0] == 7.0 && v[1] == 7.0 && v[2] == 7.0);                       \
  assert_non_null(strstr(sph_context_last_error(ctx), word))
  BAD(o.dim = 0, SPH_ERR_ARG, "dim is 0");
  BAD(o.lo[1] = 1.0, SPH_ERR_ARG, "axis 1");
  BAD(o.lo[1] = 0.2, SPH_ERR_ARG, "component 1 of particle 0 is 0.1");
  BAD(o.levels = 13, SPH_ERR_ARG, "levels is 13");
  BAD(o.levels = -1, SPH_ERR_ARG, "levels is -1");
  BAD((o.holes = 2, o.hole = overlapping), SPH_ERR_ARG, "overlap");
  BAD((o.dim = 3, o.holes = 1, o.hole = centre_hole), SPH_ERR_ARG, "3-D");
  BAD((x[2] = 0.1, x[3] = 0.1), SPH_ERR_ARG, "where particle 0 is");
  BAD(x[3] = NAN, SPH_ERR_ARG, "particle 1");
#undef BAD
  x[3] = 0.5;
  check_status(sph_layout_volumes(ctx, &good, -1, x, v), SPH_ERR_ARG);
  check_status(sph_layout_volumes(ctx, &good, 3, NULL, v), SPH_ERR_ARG);
  check_status(sph_layout_volumes(ctx, &good, 3, x, NULL), SPH_ERR_ARG);
  check_ok(sph_layout_volumes(ctx, &good, 0, NULL, NULL));
  check_ok(sph_layout_volumes(ctx, &good, 1, x, v));
  check_close(v[0], 4.0, 1e-15); /* alone: all of the box */
  sph_context_destroy(ctx);
}

static sph_status make_volumes(sph_context *ctx, void *user) {
  const double *x = user;
  double v[400];
  const sph_region_options o = region(2, 0, NULL);
  for (int k = 0; k < 400; ++k) v[k] = 7.0;
  const sph_status s = sph_layout_volumes(ctx, &o, 400, x, v);
  for (int k = 0; k < 400; ++k) assert_true((v[k] == 7.0) == (s != SPH_OK));
  return s;
}

/* A wheel again, so that the room of the crowded cell has to grow. */
static void test_memory(void **state) {
  (void)state;
  double x[800] = {0.0};
  for (int k = 1; k < 400; ++k) {
    x[2 * k] = 0.01 * cos(2 * pi * k / 399);
    x[2 * k + 1] = 0.01 * sin(2 * pi * k / 399);
  }
  oom_sweep(make_volumes, x);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_lattice_volumes), cmocka_unit_test(test_hexagonal_volumes),
    cmocka_unit_test(test_oracle),          cmocka_unit_test(test_hole_volumes),
    cmocka_unit_test(test_inside_volumes),  cmocka_unit_test(test_inside_line),
    cmocka_unit_test(test_crowded),         cmocka_unit_test(test_threads),
    cmocka_unit_test(test_volume_refusals), cmocka_unit_test(test_memory),
};
SPH_TEST_MAIN(tests)
