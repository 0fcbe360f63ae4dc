/* Particle layouts: lattices against counting and distances, layouts about holes against their
 * radii, jitter against its moments; refusals and memory. Volumes:
 * test_layout_volumes.c. */
#include "../layout_help.h"
#include "../oom.h"

/* ---- lattices ---------------------------------------------------------------------------- */

static void test_cartesian(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  for (int32_t dim = 1; dim <= 3; ++dim)
    for (int32_t anchor = SPH_LATTICE_CENTRED; anchor <= SPH_LATTICE_FACES; ++anchor) {
      sph_lattice_options o = lattice_of(dim, SPH_LATTICE_CARTESIAN, anchor, 0.25);
      int64_t n, m = 1, index = 0;
      o.lo[0] = -0.5, o.hi[0] = 1.0, o.lo[1] = 3.0, o.hi[1] = 4.0, o.lo[2] = 0.0, o.hi[2] = 0.5;
      const int64_t cells[3] = {6, 4, 2};
      const int faces = anchor == SPH_LATTICE_FACES;
      double *x = lattice(ctx, &o, &n);
      for (int32_t a = 0; a < dim; ++a) m *= cells[a] + faces;
      assert_int_equal(n, m);
      for (int64_t i = 0; i < n; ++i, index = i) /* x fastest */
        for (int32_t a = 0; a < dim; ++a) {
          const int64_t k = index % (cells[a] + faces);
          index /= cells[a] + faces;
          check_close(x[i * dim + a], o.lo[a] + ((double)k + (faces ? 0.0 : 0.5)) * 0.25, 1e-15);
        }
      free(x);
    }
  sph_context_destroy(ctx);
}

/* Neighbours at the distance s: 6 in 2-D, 12 in 3-D, none nearer, in a box that fits exactly. */
static void test_hexagonal(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  for (int32_t dim = 2; dim <= 3; ++dim)
    for (int32_t anchor = SPH_LATTICE_CENTRED; anchor <= SPH_LATTICE_FACES; ++anchor) {
      const double s = 0.1;
      sph_lattice_options o = lattice_of(dim, SPH_LATTICE_HEXAGONAL, anchor, s);
      int64_t n;
      int full = 0;
      o.hi[0] = 6 * s, o.hi[1] = 6 * sqrt(0.75) * s, o.hi[2] = 6 * sqrt(2.0 / 3.0) * s;
      double *x = lattice(ctx, &o, &n);
      if (anchor == SPH_LATTICE_CENTRED) assert_int_equal(n, dim == 2 ? 36 : 216);
      for (int64_t i = 0; i < n; ++i) {
        int touching = 0;
        for (int64_t j = 0; j < n; ++j) {
          const double r = distance(dim, x + i * dim, x + j * dim);
          assert_true(i == j || r > s * (1.0 - 1e-12));
          touching += i != j && r < s * (1.0 + 1e-12);
        }
        full += touching == (dim == 2 ? 6 : 12);
        assert_true(touching <= (dim == 2 ? 6 : 12));
      }
      assert_true(full >= (dim == 2 ? 16 : 64)); /* all but the outer shell */
      free(x);
    }
  sph_context_destroy(ctx);
}

/* Every mirrored point stands in the set, to the bit. */
static void check_mirrored(int64_t n, const double *x, int32_t dim, int axes) {
  for (int64_t i = 0; i < n; ++i)
    for (int32_t a = 0; a < dim; ++a) {
      double image[3];
      if (!(axes & (1 << a))) continue;
      for (int32_t b = 0; b < dim; ++b) image[b] = a == b ? -x[i * dim + b] : x[i * dim + b];
      assert_true(holds(n, x, dim, image, 0.0));
    }
}

static void test_lattice_symmetry(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  for (int32_t dim = 1; dim <= 3; ++dim) {
    sph_lattice_options o = lattice_of(dim, SPH_LATTICE_CARTESIAN, SPH_LATTICE_CENTRED, 0.07);
    int64_t n;
    for (int a = 0; a < 3; ++a) o.hi[a] = 0.31 + 0.1 * a, o.lo[a] = -o.hi[a];
    double *x = lattice(ctx, &o, &n);
    check_mirrored(n, x, dim, 7);
    free(x);
    o.kind = SPH_LATTICE_HEXAGONAL, o.anchor = SPH_LATTICE_FACES;
    x = lattice(ctx, &o, &n);
    check_mirrored(n, x, dim, dim == 2 ? 1 : dim == 1); /* in x; 3-D layers are shifted rows */
    free(x);
  }
  sph_context_destroy(ctx);
}

static void test_inside(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  sph_lattice_options o = lattice_of(2, SPH_LATTICE_CARTESIAN, SPH_LATTICE_CENTRED, 0.01);
  double r = 0.8;
  int64_t n, all = 0;
  o.lo[0] = o.lo[1] = -1.0;
  o.inside = in_disc, o.inside_user = &r;
  double *x = lattice(ctx, &o, &n);
  for (int i = -100; i < 100; ++i)
    for (int j = -100; j < 100; ++j) all += hypot(i + 0.5, j + 0.5) < 80.0;
  assert_int_equal(n, all);
  for (int64_t i = 0; i < n; ++i) assert_true(in_disc(&r, x + 2 * i));
  free(x);
  sph_context_destroy(ctx);
}

/* ---- jitter ------------------------------------------------------------------------------ */

static void test_jitter(void **state) {
  (void)state;
  enum { N = 20000 };
  sph_context *ctx = context_of(1);
  double *x = room(3 * N), *y = room(3 * N), *part = room(3 * N);
  double mean = 0.0, square = 0.0, r = 1.0;
  for (int k = 0; k < 3 * N; ++k) x[k] = y[k] = part[k] = 0.5;
  check_ok(sph_layout_jitter(ctx, 3, 0.1, 7, NULL, NULL, N, x));
  check_ok(sph_layout_jitter(ctx, 3, 0.1, 7, NULL, NULL, N, y));
  check_ok(sph_layout_jitter(ctx, 3, 0.1, 7, NULL, NULL, 10, part));
  assert_memory_equal(x, y, 3 * N * sizeof *x);
  assert_memory_equal(x, part, 30 * sizeof *x);
  for (int k = 0; k < 3 * N; ++k) {
    assert_true(fabs(x[k] - 0.5) <= 0.1);
    mean += (x[k] - 0.5) / (3 * N);
    square += (x[k] - 0.5) * (x[k] - 0.5) / (3 * N);
  }
  check_close(mean, 0.0, 5.0 * 0.1 / sqrt(3.0 * 3 * N)); /* five deviations of the mean */
  check_rel(square, 0.01 / 3.0, 0.02);
  check_ok(sph_layout_jitter(ctx, 3, 0.1, 8, NULL, NULL, N, y));
  int64_t same = 0;
  for (int k = 0; k < 3 * N; ++k) same += x[k] == 0.5 || y[k] == x[k];
  assert_true(same < 5);
  for (int k = 0; k < N; ++k) y[2 * k] = 0.999, y[2 * k + 1] = 0.0;
  check_ok(sph_layout_jitter(ctx, 2, 0.1, 8, in_disc, &r, N, y));
  int64_t moved = 0;
  for (int k = 0; k < N; ++k) {
    assert_true(in_disc(&r, y + 2 * k));
    moved += y[2 * k] != 0.999;
  }
  assert_true(moved > N / 3 && moved < 2 * N / 3);
  free(x), free(y), free(part);
  sph_context_destroy(ctx);
}

/* ---- layouts about holes ----------------------------------------------------------------- */

/* Within the plate, outside the holes, nowhere too dense, and as many as the area asks for. */
static void test_holes(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  for (int k = 0; k < 3; ++k)
    for (int32_t count = 1; count <= 9; count += 8) {
      const double s = 0.03;
      double area = 4.0;
      int64_t n;
      sph_hole_layout_options o = plate(all_kinds[k], count, nine, s);
      double *x = holes(ctx, &o, &n), nearest = 1.0;
      for (int h = 0; h < count; ++h) area -= pi * nine[3 * h + 2] * nine[3 * h + 2];
      /* rays are denser than s where the other holes are not */
      const int rays = all_kinds[k] == SPH_HOLES_RADIAL && count > 1;
      check_rel((double)n, area / (s * s), rays ? 0.2 : 0.1);
      for (int64_t i = 0; i < n; ++i) {
        assert_true(fabs(x[2 * i]) <= 1.0 && fabs(x[2 * i + 1]) <= 1.0);
        for (int h = 0; h < count; ++h)
          assert_true(distance(2, x + 2 * i, nine + 3 * h) > nine[3 * h + 2] - 1e-12);
        for (int64_t j = 0; j < i; ++j) nearest = fmin(nearest, distance(2, x + 2 * i, x + 2 * j));
      }
      /* radial layouts are dense at the hole by design: 2 pi .3 / rays */
      assert_true(nearest > (all_kinds[k] == SPH_HOLES_RADIAL ? 0.3 : 0.5) * s);
      check_mirrored(n, x, 2, 3);
      free(x);
    }
  sph_context_destroy(ctx);
}

/* Rings at r + k s carry round(2 pi r / 4 s) * 4 points, the first one on each half axis. */
static void test_rings(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  const double s = 0.04;
  for (int half = 0; half < 2; ++half) {
    int64_t n, on_ring[12] = {0}, on_axis = 0;
    sph_hole_layout_options o = plate(SPH_HOLES_EQUALLY_RADIAL, 1, centre_hole, s);
    o.phase = o.offset = 0.5 * half;
    double *x = holes(ctx, &o, &n);
    for (int64_t i = 0; i < n; ++i) {
      const double ring = (hypot(x[2 * i], x[2 * i + 1]) - 0.3) / s - o.offset;
      if (ring < 11.5) {
        check_close(ring, round(ring), 1e-9);
        on_ring[(int)round(ring)]++;
      }
      on_axis += x[2 * i + 1] == 0.0 && fabs(x[2 * i]) < 1.0;
    }
    for (int k = 0; k < 12; ++k)
      assert_int_equal(on_ring[k], 4 * (int)round(2 * pi * (.3 + (k + o.offset) * s) / (4 * s)));
    assert_int_equal(on_axis, half ? 0 : 2 * 17); /* rings 0..17 but the last, too near the row */
    free(x);
  }
  sph_context_destroy(ctx);
}

/* The quarter holds what the whole plate holds in its quadrant. */
static void test_quarter(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  for (int k = 0; k < 3; ++k)
    for (int32_t count = 1; count <= 9; count += 8) {
      int64_t n, m, inside = 0;
      sph_hole_layout_options o = plate(all_kinds[k], count, nine, 0.05);
      double *x = holes(ctx, &o, &n);
      o.lo[0] = o.lo[1] = 0.0;
      o.faces = SPH_FACE_X_HI | SPH_FACE_Y_HI;
      double *y = holes(ctx, &o, &m);
      for (int64_t i = 0; i < n; ++i) inside += x[2 * i] >= 0.0 && x[2 * i + 1] >= 0.0;
      assert_int_equal(m, inside);
      for (int64_t i = 0; i < m; ++i) assert_true(holds(n, x, 2, y + 2 * i, 1e-14));
      free(x), free(y);
    }
  sph_context_destroy(ctx);
}

/* Rows on faces stop at the holes that cut them. */
static void test_cut_face(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  int64_t n, on_face = 0;
  sph_hole_layout_options o = plate(SPH_HOLES_EQUALLY_RADIAL, 1, centre_hole, 0.1);
  o.lo[1] = 0.0; /* the half plate: the face y = 0 is cut from -.3 to .3 */
  double *x = holes(ctx, &o, &n);
  for (int64_t i = 0; i < n; ++i) on_face += x[2 * i + 1] == 0.0;
  assert_int_equal(on_face, 2 * 8); /* seven steps on either side */
  for (int k = 0; k < 8; ++k)
    for (int side = -1; side <= 1; side += 2)
      assert_true(holds(n, x, 2, (double[2]){side * (0.3 + 0.1 * k), 0.0}, 1e-14));
  assert_true(holds(n, x, 2, (double[2]){-1.0, 1.0}, 0.0));
  free(x);
  sph_context_destroy(ctx);
}

/* ---- refusals ---------------------------------------------------------------------------- */

static void refuse_lattice(sph_context *ctx, const sph_lattice_options *o, sph_status status,
                           const char *word) {
  int64_t n = -7;
  check_status(sph_layout_lattice(ctx, o, 0, NULL, &n), status);
  assert_int_equal(n, -7);
  if (strstr(sph_context_last_error(ctx), word) == NULL)
    fail_msg("\"%s\" lacks \"%s\"", sph_context_last_error(ctx), word);
}

static void test_lattice_refusals(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  const sph_lattice_options good = lattice_of(2, 1, 1, 0.1);
  sph_lattice_options o;
#define BAD(change, status, word) o = good, change, refuse_lattice(ctx, &o, status, word)
  BAD(o.dim = 0, SPH_ERR_ARG, "dim is 0");
  BAD(o.dim = 4, SPH_ERR_ARG, "dim is 4");
  BAD(o.kind = 3, SPH_ERR_ARG, "kind 3");
  BAD(o.anchor = 0, SPH_ERR_ARG, "anchor 0");
  BAD(o.spacing = 0.0, SPH_ERR_ARG, "spacing is 0");
  BAD(o.spacing = -0.5, SPH_ERR_ARG, "spacing is -0.5");
  BAD(o.spacing = NAN, SPH_ERR_ARG, "spacing is");
  BAD(o.spacing = INFINITY, SPH_ERR_ARG, "spacing is inf");
  BAD(o.hi[1] = 0.0, SPH_ERR_ARG, "axis 1");
  BAD(o.hi[0] = NAN, SPH_ERR_ARG, "axis 0");
  BAD(o.hi[0] = INFINITY, SPH_ERR_ARG, "axis 0");
  BAD((o.lo[0] = -1e308, o.hi[0] = 1e308), SPH_ERR_ARG, "axis 0");
  BAD(o.spacing = 1e-6, SPH_ERR_LIMIT, "1e-06");
  BAD(o.spacing = 1e-300, SPH_ERR_LIMIT, "1e-300");
  BAD(o.size = 3, SPH_ERR_ARG, "size 3");
#undef BAD
  double x[8] = {5.0};
  int64_t n = 9;
  o = good, o.spacing = 0.5;
  check_status(sph_layout_lattice(ctx, &o, 3, x, &n), SPH_ERR_LIMIT);
  assert_true(n == 9 && x[0] == 5.0);
  check_status(sph_layout_lattice(ctx, &o, -1, x, &n), SPH_ERR_ARG);
  check_status(sph_layout_lattice(ctx, &o, 4, NULL, &n), SPH_ERR_ARG);
  check_ok(sph_layout_lattice(ctx, &o, 4, x, &n));
  assert_int_equal(n, 4);
  o.spacing = 1e30; /* coarser than the box: one cell */
  check_ok(sph_layout_lattice(ctx, &o, 4, x, &n));
  assert_true(n == 1 && x[0] == 0.5 && x[1] == 0.5);
  sph_context_destroy(ctx);
}

static void refuse_holes(sph_context *ctx, const sph_hole_layout_options *o, sph_status status,
                         const char *word) {
  int64_t n = -7;
  check_status(sph_layout_holes(ctx, o, 0, NULL, &n), status);
  assert_int_equal(n, -7);
  if (strstr(sph_context_last_error(ctx), word) == NULL)
    fail_msg("\"%s\" lacks \"%s\"", sph_context_last_error(ctx), word);
}

static void test_hole_refusals(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  const sph_hole_layout_options good = plate(SPH_HOLES_EQUALLY_RADIAL, 1, centre_hole, 0.1);
  const double overlapping[6] = {0, 0, .3, .4, 0, .2}, negative[3] = {0, 0, -.1};
  const double nowhere[3] = {0, NAN, .1}, outside[3] = {2, 0, .1}, large[3] = {0, 0, 1.5};
  sph_hole_layout_options o;
#define BAD(change, status, word) o = good, change, refuse_holes(ctx, &o, status, word)
  BAD(o.kind = 0, SPH_ERR_ARG, "kind 0");
  BAD(o.kind = 4, SPH_ERR_ARG, "kind 4");
  BAD(o.spacing = 0.0, SPH_ERR_ARG, "spacing is 0");
  BAD(o.spacing = NAN, SPH_ERR_ARG, "spacing");
  BAD(o.faces = 16, SPH_ERR_ARG, "faces is 16");
  BAD(o.faces = -1, SPH_ERR_ARG, "faces is -1");
  BAD(o.edge_rings = 101, SPH_ERR_ARG, "edge_rings is 101");
  BAD(o.offset = 1.5, SPH_ERR_ARG, "offset is 1.5");
  BAD(o.offset = NAN, SPH_ERR_ARG, "offset");
  BAD(o.clearance = -0.1, SPH_ERR_ARG, "clearance -0.1");
  BAD(o.phase = 0.25, SPH_ERR_ARG, "phase is 0.25");
  BAD(o.lo[0] = 1.0, SPH_ERR_ARG, "axis 0");
  BAD(o.holes = 0, SPH_ERR_ARG, "no hole");
  BAD(o.holes = -1, SPH_ERR_ARG, "holes is -1");
  BAD(o.hole = NULL, SPH_ERR_ARG, "hole is NULL");
  BAD((o.holes = 2, o.hole = overlapping), SPH_ERR_ARG, "holes 0 and 1 overlap");
  BAD(o.hole = negative, SPH_ERR_ARG, "radius -0.1");
  BAD(o.hole = nowhere, SPH_ERR_ARG, "hole 0 has the centre");
  BAD(o.hole = outside, SPH_ERR_ARG, "outside the box");
  BAD((o.kind = SPH_HOLES_RADIAL, o.hole = large), SPH_ERR_ARG, "no room");
  BAD(o.spacing = 1e-5, SPH_ERR_LIMIT, "1e-05");
  BAD((o.spacing = 1e-5, o.kind = SPH_HOLES_RADIAL), SPH_ERR_LIMIT, "1e-05");
#undef BAD
  sph_context_destroy(ctx);
}

static void test_jitter_refusals(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  double x[6] = {0.1, 0.1, 0.5, 0.5, -0.5, 0.5};
  check_status(sph_layout_jitter(ctx, 0, 0.1, 1, NULL, NULL, 3, x), SPH_ERR_ARG);
  check_status(sph_layout_jitter(ctx, 2, -0.1, 1, NULL, NULL, 3, x), SPH_ERR_ARG);
  check_status(sph_layout_jitter(ctx, 2, INFINITY, 1, NULL, NULL, 3, x), SPH_ERR_ARG);
  check_status(sph_layout_jitter(ctx, 2, 0.1, 1, NULL, NULL, -3, x), SPH_ERR_ARG);
  check_status(sph_layout_jitter(ctx, 2, 0.1, 1, NULL, NULL, 3, NULL), SPH_ERR_ARG);
  sph_context_destroy(ctx);
}

/* A call that fails for want of memory writes nothing. */
static sph_status make_layouts(sph_context *ctx, void *user) {
  const sph_lattice_options box = lattice_of(2, SPH_LATTICE_HEXAGONAL, SPH_LATTICE_FACES, 0.1);
  double x[2 * 2000];
  (void)user;
  for (int k = 0; k < 4000; ++k) x[k] = 7.0;
  int64_t n = -1;
  sph_status s = sph_layout_lattice(ctx, &box, 2000, x, &n);
  for (int k = 0; k < 3 && !s; ++k) {
    const sph_hole_layout_options o = plate(all_kinds[k], 9, nine, 0.06);
    for (int i = 0; i < 4000; ++i) x[i] = 7.0;
    n = -1;
    s = sph_layout_holes(ctx, &o, 2000, x, &n);
  }
  assert_true((x[0] == 7.0) == (s != SPH_OK) && (n == -1) == (s != SPH_OK));
  return s;
}

static void test_memory(void **state) {
  (void)state;
  oom_sweep(make_layouts, NULL);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_cartesian),
    cmocka_unit_test(test_hexagonal),
    cmocka_unit_test(test_lattice_symmetry),
    cmocka_unit_test(test_inside),
    cmocka_unit_test(test_jitter),
    cmocka_unit_test(test_holes),
    cmocka_unit_test(test_rings),
    cmocka_unit_test(test_quarter),
    cmocka_unit_test(test_cut_face),
    cmocka_unit_test(test_lattice_refusals),
    cmocka_unit_test(test_hole_refusals),
    cmocka_unit_test(test_jitter_refusals),
    cmocka_unit_test(test_memory),
};
SPH_TEST_MAIN(tests)
