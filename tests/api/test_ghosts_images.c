/* Ghosts: which particles have images about which walls, against brute force; how long images
 * serve; escaped particles; periodic axes; the frozen configuration. */
#include "../ghost_help.h"

enum { SIDE = 8 };

/* --- which images ------------------------------------------------------------------------ */

/* Every particle, every set of faces of the box: an image about the product of mirrors where its
 * corner is nearer than the reach. */
static void check_images(const rh_system *s, const sph_ghosts *g, double edge, double reach) {
  const double *x = gh_const(s, SPH_FIELD_X);
  const int64_t *owner = sph_ghosts_owners(g);
  const uint32_t *mask = sph_ghosts_walls(g);
  int64_t k = 0;
  for (int64_t i = 0; i < s->rows; i++)
    for (uint32_t faces = 1; faces < 1u << (2 * s->dim); faces++) {
      double d2 = 0.0, image[3];
      int wanted = 1;
      for (int a = 0; a < s->dim; a++) {
        const uint32_t both = faces >> (2 * a) & 3;
        image[a] = x[i * s->dim + a];
        if (both == 3) wanted = 0;
        if (both == 0) continue;
        const double plane = both == 2 ? edge : 0.0, d = fabs(image[a] - plane);
        d2 += d * d;
        image[a] = 2.0 * plane - image[a];
      }
      if (!wanted || !(d2 < reach * reach)) continue;
      assert_true(k < sph_ghosts_count(g));
      assert_int_equal(owner[k], i);
      assert_int_equal(mask[k], faces);
      for (int a = 0; a < s->dim; a++)
        check_close(x[(s->rows + k) * s->dim + a], image[a], 1e-14 * edge);
      k++;
    }
  assert_int_equal(k, sph_ghosts_count(g));
  assert_int_equal(sph_particles_count(s->set), s->rows + k);
}

static void test_brute_force(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) {
    sph_context *ctx = rh_context(1);
    rh_system s = rh_make(ctx, dim, SIDE, RH_VARY_H, (uint64_t)dim);
    const gh_frame frame = gh_identity();
    sph_ghosts *g = gh_ghosts(&s, 0.0);
    gh_box(g, &frame, dim, SIDE, SPH_WALL_SLIP);
    check_ok(sph_ghosts_update(g, s.set, 0.0));
    check_images(&s, g, SIDE, 2.0 * rh_largest(gh_const(&s, SPH_FIELD_H), s.rows));
    sph_ghosts_destroy(g);
    rh_free(&s);
    sph_context_destroy(ctx);
  }
}

/* A lattice with mirror images all around is the infinite lattice: the density is the same at
 * every particle, corners included. */
static void test_infinite_lattice(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) {
    sph_context *ctx = rh_context(1);
    rh_system s = rh_make(ctx, dim, SIDE, 0, 1);
    const gh_frame frame = gh_random_frame(dim);
    double *x = rh_field(&s, SPH_FIELD_X), *rho = rh_array(s.rows);
    for (int64_t k = 0; k < s.rows * dim; k++) x[k] = floor(x[k]) + 0.5;
    gh_turn(&s, &frame);
    sph_ghosts *g = gh_ghosts(&s, 0.0);
    gh_box(g, &frame, dim, SIDE, SPH_WALL_SLIP);
    check_ok(sph_ghosts_update(g, s.set, 0.0));
    check_ok(sph_neighbors_update(s.list, s.set, NULL));
    sph_operands a;
    check_ok(sph_operands_from_set(s.set, &a));
    check_ok(sph_density_summation(s.list, s.kernel, &a, rho));
    for (int64_t i = 1; i < s.rows; i++) check_rel(rho[i], rho[0], 1e-13);
    free(rho);
    sph_ghosts_destroy(g);
    rh_free(&s);
    sph_context_destroy(ctx);
  }
}

/* One wall for each phase, on the two sides of the same plane. */
static void test_phases(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, SIDE, 0, 7);
  sph_ghosts *g = gh_ghosts(&s, 0.0);
  const gh_frame frame = gh_identity();
  const double *x = gh_const(&s, SPH_FIELD_X), middle = SIDE / 2.0;
  int32_t *phases = sph_particles_phases(s.set);
  for (int64_t i = 0; i < s.rows; i++) phases[i] = x[2 * i] < middle ? 3 : 5;
  for (int side = 0; side < 2; side++) {
    sph_wall w = gh_wall(&frame, 2, middle, 1 - side, SPH_WALL_SLIP);
    w.point[0] = middle;
    w.phase = side ? 5 : 3;
    gh_add(g, &w);
  }
  check_ok(sph_ghosts_update(g, s.set, 0.0));
  int64_t wanted = 0;
  const double reach = 2.0 * gh_const(&s, SPH_FIELD_H)[0];
  x = gh_const(&s, SPH_FIELD_X);
  phases = sph_particles_phases(s.set);
  for (int64_t i = 0; i < s.rows; i++) wanted += fabs(x[2 * i] - middle) < reach;
  assert_true(wanted > 0);
  assert_int_equal(sph_ghosts_count(g), wanted);
  for (int64_t k = 0; k < wanted; k++) {
    const int64_t owner = sph_ghosts_owners(g)[k];
    assert_int_equal(phases[s.rows + k], phases[owner]);
    check_close(x[2 * (s.rows + k)], 2.0 * middle - x[2 * owner], 1e-14 * SIDE);
    assert_int_equal(sph_ghosts_walls(g)[k], phases[owner] == 5 ? 2 : 1);
  }
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* On an axis that wraps, walls parallel to it: the density is the sum over all images. */
static void test_periodic(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, SIDE, 0, 3);
  double *x = rh_field(&s, SPH_FIELD_X), *rho = rh_array(s.rows);
  sph_neighbors_options o;
  sph_ghosts_options go;
  sph_ghosts *g;
  sph_neighbors_options_init(&o);
  o.periodic[1] = 1;
  o.box_hi[1] = SIDE;
  sph_neighbors_destroy(s.list);
  check_ok(sph_neighbors_create(ctx, &o, &s.list));
  sph_ghosts_options_init(&go);
  go.dim = 2;
  go.periodic[1] = 1;
  check_ok(sph_ghosts_create(ctx, &go, &g));
  const gh_frame frame = gh_identity();
  for (int face = 0; face < 2; face++) {
    const sph_wall w = gh_wall(&frame, 2, SIDE, face, SPH_WALL_SLIP);
    gh_add(g, &w);
  }
  const sph_wall across = gh_wall(&frame, 2, SIDE, 2, SPH_WALL_SLIP);
  check_status(sph_ghosts_add_wall(g, &across, NULL), SPH_ERR_ARG);
  /* a particle may lie outside the box along the axis that wraps */
  x[1] += 5 * SIDE;
  check_ok(sph_particles_touch(s.set, SPH_FIELD_X));
  check_ok(sph_ghosts_update(g, s.set, 0.0));
  check_ok(sph_neighbors_update(s.list, s.set, NULL));
  sph_operands a;
  check_ok(sph_operands_from_set(s.set, &a));
  check_ok(sph_density_summation(s.list, s.kernel, &a, rho));
  /* brute force: nine images of each particle */
  x = rh_field(&s, SPH_FIELD_X);
  for (int64_t i = 0; i < s.rows; i++) {
    double sum = 0.0;
    for (int64_t j = 0; j < s.rows; j++)
      for (int wrap = -7; wrap <= 7; wrap++)
        for (int mirror = 0; mirror < 3; mirror++) {
          const double xj = mirror == 0 ? x[2 * j] : (mirror == 1 ? 0.0 : 2.0 * SIDE) - x[2 * j];
          const double r = hypot(x[2 * i] - xj, x[2 * i + 1] - x[2 * j + 1] - wrap * SIDE);
          sum += a.m[j] * sph_kernel_w(s.kernel, r, a.h[i]);
        }
    check_rel(rho[i], sum, 1e-12);
  }
  free(rho);
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* A particle on a wall is its own image. */
static void test_on_the_wall(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 1, SIDE, 0, 3);
  sph_ghosts *g = gh_ghosts(&s, 0.0);
  sph_wall w = gh_wall(&(gh_frame){{{1.0}}, {0.0}}, 1, SIDE, 0, SPH_WALL_SLIP);
  w.point[0] = gh_const(&s, SPH_FIELD_X)[0];
  gh_add(g, &w);
  check_ok(sph_ghosts_update(g, s.set, 0.0));
  assert_true(sph_ghosts_count(g) > 0);
  assert_int_equal(sph_ghosts_owners(g)[0], 1);
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* --- how long images serve --------------------------------------------------------------- */

/* With a skin the images and the generation of the set stay while particles move little, and the
 * ghosts go with them; every needed image is there. */
static void test_skin(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, SIDE, 0, 11);
  const double reach = 2.0 * gh_const(&s, SPH_FIELD_H)[0];
  const gh_frame frame = gh_identity();
  sph_ghosts *g = gh_ghosts(&s, 0.4);
  gh_box(g, &frame, 2, SIDE, SPH_WALL_SLIP);
  assert_int_equal(sph_ghosts_prepare(g, 0.0, s.set, NULL, 0), 0);
  check_images(&s, g, SIDE, reach + 0.4);
  const int64_t count = sph_ghosts_count(g);
  const uint64_t generation = sph_particles_generation(s.set);
  for (int step = 0; step < 3; step++) { /* 0.1 each, along both axes: 0.14, 0.28 and 0.42 */
    double *x = rh_field(&s, SPH_FIELD_X);
    for (int64_t k = 0; k < s.rows * 2; k++) x[k] += x[k] < SIDE / 2 ? 0.1 : -0.1;
    check_ok(sph_particles_touch(s.set, SPH_FIELD_X));
    assert_int_equal(sph_ghosts_prepare(g, 0.0, s.set, NULL, 0), 0);
    if (step < 2) {
      assert_int_equal(sph_ghosts_count(g), count);
      assert_int_equal(sph_particles_generation(s.set), generation);
      for (int64_t k = 0; k < count; k++)
        if (sph_ghosts_walls(g)[k] == 1)
          check_close(gh_const(&s, SPH_FIELD_X)[2 * (s.rows + k)],
                      -gh_const(&s, SPH_FIELD_X)[2 * sph_ghosts_owners(g)[k]], 1e-14);
    } else {
      check_images(&s, g, SIDE, reach + 0.4);
    }
  }
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* Whatever is moved, added or changed: prepare gives what a fresh handle's update gives. */
static void test_prepare_is_update(void **state) {
  (void)state;
  for (int round = 0; round < 12; round++) {
    sph_context *ctx = rh_context(1);
    rh_system s = rh_make(ctx, 2, SIDE, RH_VARY_H, (uint64_t)round);
    const gh_frame frame = gh_identity();
    sph_ghosts *g = gh_ghosts(&s, 0.0), *fresh = gh_ghosts(&s, 0.0);
    double *x = rh_field(&s, SPH_FIELD_X), *h = rh_field(&s, SPH_FIELD_H);
    gh_box(g, &frame, 2, SIDE, SPH_WALL_SLIP);
    assert_int_equal(sph_ghosts_prepare(g, 0.0, s.set, NULL, 0), 0);
    x = rh_field(&s, SPH_FIELD_X);
    h = rh_field(&s, SPH_FIELD_H);
    gh_box(fresh, &frame, 2, SIDE, SPH_WALL_SLIP);
    switch (round % 4) {
    case 0: /* particles */
      for (int64_t k = 0; k < 2 * s.rows; k++) x[k] += rh_random(0.0, 0.3) * (SIDE / 2.0 - x[k]);
      break;
    case 1: /* a larger reach */
      for (int64_t i = 0; i < s.rows; i++) h[i] *= 1.2;
      break;
    case 2: { /* a wall that moves */
      sph_wall w = gh_wall(&frame, 2, SIDE, 0, SPH_WALL_SLIP);
      w.point[0] -= 0.5;
      check_ok(sph_ghosts_set_wall(g, 0, &w));
      check_ok(sph_ghosts_set_wall(fresh, 0, &w));
      break;
    }
    default: /* fewer particles */
      check_ok(sph_particles_remove(s.set, 3, (int64_t[]){0, 9, 17}));
      s.rows -= 3;
    }
    check_ok(sph_particles_touch(s.set, SPH_FIELD_X));
    assert_int_equal(sph_ghosts_prepare(g, 0.0, s.set, NULL, 0), 0);
    const int64_t n = sph_particles_count(s.set);
    double *kept = rh_array(2 * n);
    memcpy(kept, gh_const(&s, SPH_FIELD_X), (size_t)(2 * n) * sizeof *kept);
    check_ok(sph_ghosts_update(fresh, s.set, 0.0));
    assert_int_equal(sph_particles_count(s.set), n);
    assert_memory_equal(kept, gh_const(&s, SPH_FIELD_X), (size_t)(2 * n) * sizeof *kept);
    free(kept);
    sph_ghosts_destroy(fresh);
    sph_ghosts_destroy(g);
    rh_free(&s);
    sph_context_destroy(ctx);
  }
}

/* --- escaped particles ------------------------------------------------------------------- */

static sph_ghosts *escape_ghosts(const rh_system *s, int32_t escape) {
  sph_ghosts *g = NULL;
  sph_ghosts_options o;
  const gh_frame frame = gh_identity();
  sph_ghosts_options_init(&o);
  o.dim = s->dim;
  o.escape = escape;
  check_ok(sph_ghosts_create(s->ctx, &o, &g));
  gh_box(g, &frame, s->dim, SIDE, SPH_WALL_SLIP);
  return g;
}

static void test_escape(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, SIDE, 0, 13);
  for (int32_t escape = SPH_ESCAPE_FAIL; escape <= SPH_ESCAPE_IGNORE; escape++) {
    sph_ghosts *g = escape_ghosts(&s, escape);
    check_ok(sph_ghosts_update(g, s.set, 0.0));
    const int64_t count = sph_ghosts_count(g);
    double *x = rh_field(&s, SPH_FIELD_X), kept = x[2 * 5 + 1];
    x[2 * 5 + 1] = -0.25;
    check_ok(sph_particles_touch(s.set, SPH_FIELD_X));
    const sph_status wanted[] = {SPH_ERR_STATE, SPH_RETRY, SPH_OK};
    check_status(sph_ghosts_refresh(g, s.set, 0.0), wanted[escape - 1]);
    check_status(sph_ghosts_update(g, s.set, 0.0), wanted[escape - 1]);
    if (escape == SPH_ESCAPE_FAIL) {
      assert_non_null(strstr(sph_context_last_error(ctx), "particle 5"));
      assert_non_null(strstr(sph_context_last_error(ctx), "0.25 behind wall 2"));
    }
    if (escape < SPH_ESCAPE_IGNORE) assert_int_equal(sph_ghosts_count(g), count);
    for (int64_t k = 0; escape == SPH_ESCAPE_IGNORE && k < sph_ghosts_count(g); k++)
      if (sph_ghosts_owners(g)[k] == 5) assert_int_equal(sph_ghosts_walls(g)[k] & 4, 0);
    rh_field(&s, SPH_FIELD_X)[2 * 5 + 1] = kept;
    check_ok(sph_particles_touch(s.set, SPH_FIELD_X));
    sph_ghosts_destroy(g);
  }
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* Back through the corner, with both velocities turned; one that flies inwards keeps its own. */
static void test_recapture(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, SIDE, 0, 17);
  sph_ghosts *g = escape_ghosts(&s, SPH_ESCAPE_FAIL);
  double *x = rh_field(&s, SPH_FIELD_X), *v = rh_field(&s, SPH_FIELD_V);
  sph_wall moving;
  int64_t count = -1;
  sph_wall_init(&moving);
  check_ok(sph_ghosts_get_wall(g, 1, &moving)); /* x = SIDE */
  moving.data.velocity[0] = -2.0;
  check_ok(sph_ghosts_set_wall(g, 1, &moving));
  const double put[4][4] = {{-0.5, -0.25, -1.0, -3.0},     /* through x = 0 and y = 0 */
                            {-0.5, 2.0, 1.0, 7.0},         /* already on its way back */
                            {SIDE + 0.25, 2.0, -1.0, 7.0}, /* slower than the wall */
                            {SIDE + 0.25, 2.0, -3.0, 7.0}};
  const double want[4][4] = {{0.5, 0.25, 1.0, 3.0},
                             {0.5, 2.0, 1.0, 7.0},
                             {SIDE - 0.25, 2.0, -3.0, 7.0}, /* -1 + 2 (-2 + 1) */
                             {SIDE - 0.25, 2.0, -3.0, 7.0}};
  for (int i = 0; i < 4; i++) {
    memcpy(x + 2 * i, put[i], 2 * sizeof *x);
    memcpy(v + 2 * i, put[i] + 2, 2 * sizeof *v);
  }
  const uint64_t revision = sph_particles_revision(s.set, SPH_FIELD_X);
  check_ok(sph_ghosts_recapture(g, s.set, &count));
  assert_int_equal(count, 4);
  assert_true(sph_particles_revision(s.set, SPH_FIELD_X) > revision);
  for (int i = 0; i < 4; i++)
    for (int a = 0; a < 2; a++) {
      check_close(x[2 * i + a], want[i][a], 1e-15 * SIDE);
      check_close(v[2 * i + a], want[i][2 + a], 1e-15);
    }
  check_ok(sph_ghosts_recapture(g, s.set, &count));
  assert_int_equal(count, 0);
  check_ok(sph_ghosts_update(g, s.set, 0.0));
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* --- the frozen configuration ------------------------------------------------------------ */

/* Distances by X0 about the wall as it was added; X about the wall as it is. */
static void test_frozen(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 1, SIDE, 0, 3);
  sph_ghosts_options o;
  sph_ghosts *g;
  sph_ghosts_options_init(&o);
  o.dim = 1;
  o.position_field = SPH_FIELD_X0;
  check_ok(sph_ghosts_create(ctx, &o, &g));
  sph_wall w = gh_wall(&(gh_frame){{{1.0}}, {0.0}}, 1, SIDE, 0, SPH_WALL_VELOCITY);
  gh_add(g, &w);
  check_status(sph_ghosts_update(g, s.set, 0.0), SPH_ERR_ARG); /* no X0 */
  double *x = rh_field(&s, SPH_FIELD_X), *x0 = rh_field(&s, SPH_FIELD_X0);
  for (int64_t i = 0; i < s.rows; i++) {
    x0[i] = x[i];
    x[i] = x[i] * 1.5 - 4.0; /* wherever: nothing escapes by X */
  }
  check_ok(sph_ghosts_update(g, s.set, 0.0));
  const int64_t count = sph_ghosts_count(g);
  assert_true(count >= 2);
  w.point[0] = -4.0;
  check_ok(sph_ghosts_set_wall(g, 0, &w));
  assert_int_equal(sph_ghosts_prepare(g, 0.0, s.set, NULL, 0), 0);
  assert_int_equal(sph_ghosts_count(g), count);
  x = rh_field(&s, SPH_FIELD_X);
  x0 = rh_field(&s, SPH_FIELD_X0);
  for (int64_t k = 0; k < count; k++) {
    const int64_t i = sph_ghosts_owners(g)[k];
    check_close(x0[s.rows + k], -x0[i], 1e-15);
    check_close(x[s.rows + k], -8.0 - x[i], 1e-14);
  }
  check_ok(sph_ghosts_recapture(g, s.set, NULL));
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* X is X0 plus a displacement that is mirrored as a velocity: Q u + 2 (u_b.n) n, 2 u_b - u, u. */
static void check_displacement(int32_t kind) {
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, SIDE, 0, 3);
  sph_ghosts_options o;
  sph_ghosts *g;
  const double moved[2] = {0.3, -0.2};
  sph_ghosts_options_init(&o);
  o.dim = 2;
  o.position_field = SPH_FIELD_X0;
  check_ok(sph_ghosts_create(ctx, &o, &g));
  const gh_frame frame = gh_identity();
  sph_wall w = gh_wall(&frame, 2, SIDE, 2, kind); /* y = 0 */
  gh_add(g, &w);
  for (int a = 0; a < 2; a++) w.point[a] += moved[a];
  check_ok(sph_ghosts_set_wall(g, 0, &w));
  double *x = rh_field(&s, SPH_FIELD_X), *x0 = rh_field(&s, SPH_FIELD_X0);
  for (int64_t k = 0; k < 2 * s.rows; k++) {
    x0[k] = x[k];
    x[k] += rh_random(-1.0, 1.0);
  }
  check_ok(sph_ghosts_update(g, s.set, 0.0));
  x = rh_field(&s, SPH_FIELD_X);
  x0 = rh_field(&s, SPH_FIELD_X0);
  for (int64_t k = 0; k < sph_ghosts_count(g); k++) {
    const int64_t i = sph_ghosts_owners(g)[k], j = s.rows + k;
    const double u[2] = {x[2 * i] - x0[2 * i], x[2 * i + 1] - x0[2 * i + 1]};
    double want[2] = {u[0], u[1]};
    if (kind != SPH_WALL_TRACTION) want[1] = 2.0 * moved[1] - u[1];
    if (kind == SPH_WALL_VELOCITY) want[0] = 2.0 * moved[0] - u[0];
    assert_true(x0[2 * j] == x0[2 * i] && x0[2 * j + 1] == -x0[2 * i + 1]);
    for (int a = 0; a < 2; a++) check_close(x[2 * j + a] - x0[2 * j + a], want[a], 1e-14);
  }
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

static void test_displacements(void **state) {
  (void)state;
  check_displacement(SPH_WALL_SLIP);
  check_displacement(SPH_WALL_VELOCITY);
  check_displacement(SPH_WALL_TRACTION);
}

/* A refresh touches what changed only, so that what is kept of a frozen configuration lives on. */
static void test_touches(void **state) {
  (void)state;
  static const int32_t watched[3] = {SPH_FIELD_X, SPH_FIELD_X0, SPH_FIELD_H};
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, SIDE, 0, 3);
  const gh_frame frame = gh_identity();
  sph_ghosts *g = gh_ghosts(&s, 0.0);
  gh_box(g, &frame, 2, SIDE, SPH_WALL_SLIP);
  memcpy(rh_field(&s, SPH_FIELD_X0), gh_const(&s, SPH_FIELD_X), (size_t)(2 * s.rows) * 8);
  check_ok(sph_ghosts_update(g, s.set, 0.0));
  for (int change = -1; change < 3; change++) { /* nothing, then one field after the other */
    uint64_t before[3];
    if (change >= 0) rh_field(&s, watched[change])[0] *= 1.01;
    for (int k = 0; k < 3; k++) before[k] = sph_particles_revision(s.set, watched[k]);
    check_ok(sph_ghosts_refresh(g, s.set, 0.0));
    for (int k = 0; k < 3; k++)
      assert_int_equal(sph_particles_revision(s.set, watched[k]) > before[k], k == change);
  }
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_brute_force),
    cmocka_unit_test(test_infinite_lattice),
    cmocka_unit_test(test_phases),
    cmocka_unit_test(test_periodic),
    cmocka_unit_test(test_on_the_wall),
    cmocka_unit_test(test_skin),
    cmocka_unit_test(test_prepare_is_update),
    cmocka_unit_test(test_escape),
    cmocka_unit_test(test_recapture),
    cmocka_unit_test(test_frozen),
    cmocka_unit_test(test_displacements),
    cmocka_unit_test(test_touches),
};
SPH_TEST_MAIN(tests)
