/* Particle layouts: lattices against counting and distances, layouts about holes against their
 * radii, volumes against closed forms, a brute-force oracle and symmetry; refusals and memory. */
#include "check.h"
#include "oom.h"

#include <stdlib.h>

#include <sph/context.h>
#include <sph/layout.h>

static const double pi = 3.14159265358979323846;

static sph_context *context_of(int32_t threads) {
  sph_context_options o;
  sph_context *ctx = NULL;
  sph_context_options_init(&o);
  o.threads = threads;
  check_ok(sph_context_create(&o, &ctx));
  return ctx;
}

static double *room(int64_t n) {
  double *values = malloc((size_t)(n + 1) * sizeof *values);
  assert_non_null(values);
  return values;
}

static sph_lattice_options lattice_of(int32_t dim, int32_t kind, int32_t anchor, double spacing) {
  sph_lattice_options o;
  sph_lattice_options_init(&o);
  o.dim = dim;
  o.kind = kind;
  o.anchor = anchor;
  o.spacing = spacing;
  return o;
}

/* Count, then write; the array is the caller's to free. */
static double *lattice(sph_context *ctx, const sph_lattice_options *o, int64_t *n) {
  check_ok(sph_layout_lattice(ctx, o, 0, NULL, n));
  double *x = room(*n * o->dim);
  int64_t written = -1;
  check_ok(sph_layout_lattice(ctx, o, *n, x, &written));
  assert_int_equal(written, *n);
  return x;
}

static double *holes(sph_context *ctx, const sph_hole_layout_options *o, int64_t *n) {
  check_ok(sph_layout_holes(ctx, o, 0, NULL, n));
  double *x = room(*n * 2);
  check_ok(sph_layout_holes(ctx, o, *n, x, n));
  return x;
}

static double distance(int32_t dim, const double *a, const double *b) {
  double sum = 0.0;
  for (int32_t k = 0; k < dim; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sqrt(sum);
}

static double sum(int64_t n, const double *v) {
  double total = 0.0;
  for (int64_t i = 0; i < n; ++i) total += v[i];
  return total;
}

/* Whether the point stands in the set, within `tolerance`. */
static int holds(int64_t n, const double *x, int32_t dim, const double *point, double tolerance) {
  for (int64_t i = 0; i < n; ++i)
    if (distance(dim, x + i * dim, point) <= tolerance) return 1;
  return 0;
}

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

static int32_t in_disc(void *user, const double *p) {
  const double r = *(const double *)user;
  return p[0] * p[0] + p[1] * p[1] < r * r;
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

static const double centre_hole[3] = {0.0, 0.0, 0.3};
static const double nine[27] = {0,  0,  .3, -.7, -.7, .2, 0,  -.7, .2, .7, -.7, .2, -.7, 0,
                                .2, .7, 0,  .2,  -.7, .7, .2, 0,   .7, .2, .7,  .7, .2};

static sph_hole_layout_options plate(int32_t kind, int32_t count, const double *hole, double s) {
  sph_hole_layout_options o;
  sph_hole_layout_options_init(&o);
  o.kind = kind;
  o.holes = count;
  o.hole = hole;
  o.spacing = s;
  o.lo[0] = o.lo[1] = -1.0;
  return o;
}

static sph_region_options region(int32_t dim, int32_t count, const double *hole) {
  sph_region_options o;
  sph_region_options_init(&o);
  o.dim = dim;
  o.holes = count;
  o.hole = hole;
  for (int a = 0; a < 3; ++a) o.lo[a] = -1.0;
  return o;
}

static const int all_kinds[] = {SPH_HOLES_EQUALLY_RADIAL, SPH_HOLES_RADIAL, SPH_HOLES_SQUARED};

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

/* ---- volumes ----------------------------------------------------------------------------- */

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
  BAD((o.dim = 3, o.inside = in_disc), SPH_ERR_UNSUPPORTED, "inside");
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
  check_status(sph_layout_jitter(ctx, 0, 0.1, 1, NULL, NULL, 3, x), SPH_ERR_ARG);
  check_status(sph_layout_jitter(ctx, 2, -0.1, 1, NULL, NULL, 3, x), SPH_ERR_ARG);
  check_status(sph_layout_jitter(ctx, 2, INFINITY, 1, NULL, NULL, 3, x), SPH_ERR_ARG);
  check_status(sph_layout_jitter(ctx, 2, 0.1, 1, NULL, NULL, -3, x), SPH_ERR_ARG);
  check_status(sph_layout_jitter(ctx, 2, 0.1, 1, NULL, NULL, 3, NULL), SPH_ERR_ARG);
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
    cmocka_unit_test(test_cartesian),
    cmocka_unit_test(test_hexagonal),
    cmocka_unit_test(test_lattice_symmetry),
    cmocka_unit_test(test_inside),
    cmocka_unit_test(test_jitter),
    cmocka_unit_test(test_holes),
    cmocka_unit_test(test_rings),
    cmocka_unit_test(test_quarter),
    cmocka_unit_test(test_cut_face),
    cmocka_unit_test(test_lattice_volumes),
    cmocka_unit_test(test_hexagonal_volumes),
    cmocka_unit_test(test_oracle),
    cmocka_unit_test(test_hole_volumes),
    cmocka_unit_test(test_inside_volumes),
    cmocka_unit_test(test_inside_line),
    cmocka_unit_test(test_crowded),
    cmocka_unit_test(test_threads),
    cmocka_unit_test(test_lattice_refusals),
    cmocka_unit_test(test_hole_refusals),
    cmocka_unit_test(test_volume_refusals),
    cmocka_unit_test(test_memory),
};
SPH_TEST_MAIN(tests)
