/* Layouts of several materials: exact layouts, counts, masses, refusals, memory. */
#include "../relax_help.h"

/* ---- materials --------------------------------------------------------------------------- */

typedef struct layout {
  int64_t n;
  double *x, *v;
  int32_t *phase;
} layout;

static layout make_layout(sph_context *ctx, const sph_material_layout_options *o) {
  layout l = {0, NULL, NULL, NULL};
  check_ok(sph_layout_materials(ctx, o, 0, NULL, NULL, NULL, &l.n));
  l.x = (double *)malloc((size_t)(l.n * o->dim + 1) * sizeof *l.x);
  l.v = (double *)malloc((size_t)(l.n + 1) * sizeof *l.v);
  l.phase = (int32_t *)malloc((size_t)(l.n + 1) * sizeof *l.phase);
  int64_t n = -1;
  check_ok(sph_layout_materials(ctx, o, l.n, l.x, l.phase, l.v, &n));
  assert_int_equal(n, l.n);
  return l;
}

static void free_layout(layout *l) {
  free(l->x);
  free(l->v);
  free(l->phase);
}

static sph_material_layout_options materials_of(int32_t dim, int32_t kind, int32_t equal,
                                                double spacing) {
  sph_material_layout_options o;
  sph_material_layout_options_init(&o);
  o.dim = dim;
  o.kind = kind;
  o.equal = equal;
  o.spacing = spacing;
  return o;
}

/* A shock tube of densities 4 and 1: particles at half a spacing from the contact and the ends;
 * with equal masses 40 and 10, D_H = D_L rho_L / rho_H, else 10 and 10. Relaxed: the same. */
static void test_tube(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  const double density[2] = {4.0, 1.0}, boxes[4] = {0.0, 0.5, 0.5, 1.0};
  for (int32_t kind = 1; kind <= 3; kind++)
    for (int32_t equal = 1; equal <= 2; equal++) {
      sph_material_layout_options o = materials_of(1, kind, equal, 0.05);
      const int64_t left = equal == SPH_EQUAL_MASS ? 40 : 10;
      o.phases = 2;
      o.density = density;
      o.boxes = boxes;
      layout l = make_layout(ctx, &o);
      assert_int_equal(l.n, left + 10);
      for (int64_t i = 0; i < l.n; i++) {
        const int32_t phase = i >= left;
        const double s = phase || equal == SPH_EQUAL_SPACING ? 0.05 : 0.0125;
        assert_int_equal(l.phase[i], phase);
        check_close(l.x[i], 0.5 * phase + ((double)(i - phase * left) + 0.5) * s, 1e-14);
        check_rel(l.v[i], s, 1e-12);
        if (equal == SPH_EQUAL_MASS) check_rel(density[phase] * l.v[i], 0.05, 1e-12);
      }
      free_layout(&l);
    }
  sph_context_destroy(ctx);
}

/* Phase 1: a disc; phase 2: right of x = 0.8; phase 0: the rest, but nothing above y = 0.9. */
static int32_t disc_and_wall(void *user, const double *p) {
  (void)user;
  if (p[1] > 0.9) return -1;
  if (hypot(p[0] - 0.4, p[1] - 0.45) < 0.25) return 1;
  return p[0] > 0.8 ? 2 : 0;
}

static const double three[3] = {1.0, 4.0, 2.25};
static const double area[3] = {0.72 - 0.0625 * 3.14159265358979323846,
                               0.0625 * 3.14159265358979323846, 0.18};

/* Lattices: the points of each phase's own lattice that lie in it. */
static void test_lattices(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  for (int32_t dim = 2; dim <= 3; dim++)
    for (int32_t kind = 1; kind <= 2; kind++)
      for (int32_t equal = 1; equal <= 2; equal++) {
        sph_material_layout_options o = materials_of(dim, kind, equal, dim == 2 ? 0.02 : 0.06);
        int64_t at = 0;
        o.phases = 3;
        o.density = three;
        o.phase = disc_and_wall;
        layout l = make_layout(ctx, &o);
        for (int32_t k = 0; k < 3; k++) {
          const double s = o.spacing * (equal == 1 ? pow(1.0 / three[k], 1.0 / dim) : 1.0);
          double sum = 0.0;
          sph_lattice_options lattice;
          int64_t n = 0;
          sph_lattice_options_init(&lattice);
          lattice.dim = dim;
          lattice.kind = kind;
          lattice.spacing = s;
          check_ok(sph_layout_lattice(ctx, &lattice, 0, NULL, &n));
          double *x = (double *)malloc((size_t)(n * dim) * sizeof *x);
          check_ok(sph_layout_lattice(ctx, &lattice, n, x, &n));
          for (int64_t i = 0; i < n; i++) {
            if (disc_and_wall(NULL, x + i * dim) != k) continue;
            assert_memory_equal(x + i * dim, l.x + at * dim, (size_t)dim * sizeof *x);
            assert_int_equal(l.phase[at], k);
            check_rel(l.v[at], 1.0 / (double)n, 1e-12);
            sum += l.v[at++];
          }
          check_rel(sum, area[k], dim == 2 ? 0.06 : 0.15);
          free(x);
        }
        assert_int_equal(at, l.n);
        free_layout(&l);
      }
  sph_context_destroy(ctx);
}

/* Masses to the bit where the lattices fit: 2-D, ratio 4, spacing halved. */
static void test_equal_masses(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  const double density[2] = {1.0, 4.0}, boxes[8] = {0.0, 0.0, 0.5, 1.0, 0.5, 0.0, 1.0, 1.0};
  for (int32_t kind = 1; kind <= 2; kind++) {
    sph_material_layout_options o = materials_of(2, kind, SPH_EQUAL_MASS, 0.0625);
    o.phases = 2;
    o.density = density;
    o.boxes = boxes;
    layout l = make_layout(ctx, &o);
    int64_t count[2] = {0, 0};
    for (int64_t i = 0; i < l.n; i++) {
      count[l.phase[i]]++;
      if (kind == SPH_LATTICE_CARTESIAN) check_close(density[l.phase[i]] * l.v[i], 0x1p-8, 0.0);
      assert_true((l.x[2 * i] > 0.5) == l.phase[i]);
    }
    if (kind == SPH_LATTICE_CARTESIAN) assert_int_equal(count[0], 128);
    check_close((double)count[1] / (double)count[0], 4.0, kind == 1 ? 0.0 : 0.3);
    free_layout(&l);
  }
  sph_context_destroy(ctx);
}

/* Relaxed phases: counts as the areas ask for, areas shared out, equal masses, all in place. */
static void test_relaxed_materials(void **state) {
  (void)state;
  sph_context *ctx = context_of(2);
  for (int32_t equal = 1; equal <= 2; equal++) {
    sph_relax_options moderate = relax_of(check_long_run ? 100 : 40, check_short_run ? 1e-2 : 0.0);
    sph_material_layout_options o = materials_of(2, SPH_LAYOUT_RELAXED, equal, 0.04);
    o.relax = &moderate;
    o.phases = 3;
    o.density = three;
    o.phase = disc_and_wall;
    layout l = make_layout(ctx, &o);
    for (int32_t k = 0; k < 3; k++) {
      double sum = 0.0, least = 1.0, most = 0.0, edge = 1.0;
      int64_t n = 0;
      for (int64_t i = 0; i < l.n; i++) {
        if (l.phase[i] != k) continue;
        assert_int_equal(disc_and_wall(NULL, l.x + 2 * i), k);
        n++;
        sum += l.v[i];
        least = fmin(least, l.v[i]);
        most = fmax(most, l.v[i]);
        if (k == 1) edge = fmin(edge, 0.25 - hypot(l.x[2 * i] - 0.4, l.x[2 * i + 1] - 0.45));
      }
      const double v = 0.04 * 0.04 / (equal == SPH_EQUAL_MASS ? three[k] : 1.0);
      assert_int_equal(n, (int64_t)round(area[k] / v));
      check_rel(sum, area[k], 1e-3);
      assert_true(least > 0.6 * sum / (double)n && most < 1.45 * sum / (double)n);
      check_rel(sum / (double)n, v, 0.6 / (double)n + 1e-3);
      if (k == 1) check_rel(edge, 0.5 * sqrt(v), 0.25); /* half a spacing from the disc's edge */
    }
    free_layout(&l);
  }
  sph_context_destroy(ctx);
}

/* Without `phase` also in 3-D; a phase smaller than a particle has one, a phase that is nowhere
 * none. */
static int32_t speck(void *user, const double *p) {
  (void)user;
  return hypot(p[0] - 0.31, p[1] - 0.17) < 0.01 ? 1 : 0;
}

static void test_few(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  const double boxes[12] = {0, 0, 0, 0.5, 1, 1, 0.5, 0, 0, 1, 1, 1}, density[2] = {1.0, 8.0};
  sph_relax_options quick = relax_of(3, 0.0);
  sph_material_layout_options o = materials_of(3, SPH_LAYOUT_RELAXED, SPH_EQUAL_MASS, 0.25);
  o.phases = 2;
  o.boxes = boxes;
  o.density = density;
  o.relax = &quick;
  layout l = make_layout(ctx, &o);
  double sum[2] = {0.0, 0.0};
  assert_int_equal(l.n, 32 + 256);
  for (int64_t i = 0; i < l.n; i++) sum[l.phase[i]] += l.v[i];
  for (int k = 0; k < 2; k++) check_rel(sum[k], 0.5, 1e-12);
  free_layout(&l);
  o = materials_of(2, SPH_LAYOUT_RELAXED, SPH_EQUAL_SPACING, 0.1);
  o.phases = 3;
  o.phase = speck;
  l = make_layout(ctx, &o);
  assert_int_equal(l.n, 101);
  assert_int_equal(l.phase[99], 0);
  assert_int_equal(l.phase[100], 1);
  assert_int_equal(speck(NULL, l.x + 200), 1);
  assert_true(l.v[100] > 0.0);
  free_layout(&l);
  sph_context_destroy(ctx);
}

/* A ball in a box, in 3-D: numbers, volumes, places. */
static int32_t ball_in_box(void *user, const double *p) {
  (void)user;
  return hypot(hypot(p[0] - 0.5, p[1] - 0.5), p[2] - 0.5) < 0.4 ? 0 : 1;
}

static void test_ball_in_box(void **state) {
  (void)state;
  sph_context *ctx = context_of(2);
  const double density[2] = {4.0, 1.0}, ball = 4.0 * pi / 3.0 * 0.064;
  sph_relax_options few = relax_of(check_long_run ? 50 : check_short_run ? 0 : 2, 0.0);
  sph_material_layout_options o = materials_of(3, SPH_LAYOUT_RELAXED, SPH_EQUAL_MASS, 0.2);
  o.phases = 2;
  o.density = density;
  o.phase = ball_in_box;
  o.relax = &few;
  o.levels = 1;
  layout l = make_layout(ctx, &o);
  double sum[2] = {0.0, 0.0}, count[2] = {0.0, 0.0};
  for (int64_t i = 0; i < l.n; i++) {
    assert_int_equal(ball_in_box(NULL, l.x + 3 * i), l.phase[i]);
    assert_true(l.v[i] > 0.0);
    sum[l.phase[i]] += l.v[i];
    count[l.phase[i]] += 1.0;
  }
  check_rel(sum[0], ball, 0.02);
  check_rel(sum[1], 1.0 - ball, 0.02);
  check_close(count[0], ball * 4.0 / 0.008, 3.0);
  check_close(count[1], (1.0 - ball) / 0.008, 3.0);
  free_layout(&l);
  sph_context_destroy(ctx);
}

/* ---- refusals ---------------------------------------------------------------------------- */

static int32_t seventh(void *user, const double *p) {
  (void)user;
  return p[0] > 0.5 ? 7 : 0;
}

static void test_material_refusals(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  const double bad_box[8] = {0, 0, 1, 1, 1, 0, 1, 1}, bad_density[2] = {1.0, 0.0};
  const sph_material_layout_options good = materials_of(2, 1, 1, 0.1);
  sph_material_layout_options o;
  sph_relax_options relaxation = relax_of(-1, 0.0);
  double x[400], v[200];
  int32_t phase[200];
  int64_t n = -7;
#define BAD(change, status, words)                                                                \
  o = good, change, check_status(sph_layout_materials(ctx, &o, 0, NULL, NULL, NULL, &n), status); \
  said(ctx, words);                                                                               \
  assert_int_equal(n, -7)
  BAD(o.dim = 0, SPH_ERR_ARG, "dim is 0");
  BAD(o.kind = 4, SPH_ERR_ARG, "kind 4");
  BAD(o.equal = 3, SPH_ERR_ARG, "equal is 3");
  BAD(o.spacing = 0.0, SPH_ERR_ARG, "spacing is 0");
  BAD(o.spacing = 1e-9, SPH_ERR_LIMIT, "1e-09");
  BAD(o.levels = 13, SPH_ERR_ARG, "levels is 13");
  BAD(o.phases = 0, SPH_ERR_ARG, "phases is 0");
  BAD(o.phases = 2, SPH_ERR_ARG, "2 phases need");
  BAD((o.phases = 2, o.phase = seventh, o.density = bad_density), SPH_ERR_ARG, "phase 1 is 0");
  BAD((o.phases = 2, o.boxes = bad_box), SPH_ERR_ARG, "axis 0");
  BAD((o.phases = 2, o.phase = seventh), SPH_ERR_ARG, "answers 7, there are 2");
  BAD((o.kind = 3, o.phases = 2, o.phase = seventh), SPH_ERR_ARG, "answers 7, there are 2");
  BAD((o.dim = 3, o.kind = 3, o.phases = 2, o.phase = seventh), SPH_ERR_ARG, "answers 7");
  BAD(o.relax = &relaxation, SPH_ERR_ARG, "iterations = -1");
#undef BAD
  for (int k = 0; k < 200; k++) v[k] = 7.0;
  check_status(sph_layout_materials(ctx, &good, 99, x, phase, v, &n), SPH_ERR_LIMIT);
  said(ctx, "100 particles, capacity is 99");
  check_status(sph_layout_materials(ctx, &good, 0, x, phase, v, &n), SPH_ERR_LIMIT);
  check_status(sph_layout_materials(ctx, &good, -1, x, phase, v, &n), SPH_ERR_ARG);
  check_status(sph_layout_materials(ctx, &good, 5, NULL, NULL, NULL, &n), SPH_ERR_ARG);
  check_status(sph_layout_materials(ctx, &good, 200, x, NULL, v, &n), SPH_ERR_ARG);
  check_status(sph_layout_materials(ctx, &good, 200, x, phase, v, NULL), SPH_ERR_ARG);
  for (int k = 0; k < 200; k++) check_close(v[k], 7.0, 0.0);
  check_ok(sph_layout_materials(ctx, &good, 200, x, phase, v, &n));
  assert_int_equal(n, 100);
  sph_context_destroy(ctx);
}

/* ---- memory ------------------------------------------------------------------------------ */

static sph_status material_scenario(sph_context *ctx, void *user) {
  double x[2 * 120], v[120];
  int32_t phase[120];
  int64_t n = -7;
  sph_relax_options quick = relax_of(1, 0.0);
  sph_material_layout_options o = materials_of(2, *(int32_t *)user, SPH_EQUAL_SPACING, 0.1);
  o.phases = 2;
  o.phase = speck;
  o.relax = &quick;
  const sph_status s = sph_layout_materials(ctx, &o, 120, x, phase, v, &n);
  assert_true((n == -7) == (s != SPH_OK));
  return s;
}

static void test_memory(void **state) {
  (void)state;
  for (int32_t kind = 1; kind <= 3; kind += 2) oom_sweep(material_scenario, &kind);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_tube),
    cmocka_unit_test(test_lattices),
    cmocka_unit_test(test_equal_masses),
    cmocka_unit_test(test_relaxed_materials),
    cmocka_unit_test(test_few),
    cmocka_unit_test(test_ball_in_box),
    cmocka_unit_test(test_material_refusals),
    cmocka_unit_test(test_memory),
};
SPH_TEST_MAIN(tests)
