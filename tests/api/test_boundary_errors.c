/* Boundaries: bad input is refused with the state as before, nothing leaks when memory runs out;
 * held and driven particles. */
#include "../ghost_help.h"
#include "../oom.h"

enum { SIDE = 8 };

static void *make(const rh_system *s, const sph_ghosts_options *o, sph_status wanted) {
  sph_ghosts *g = NULL;
  check_status(sph_ghosts_create(s->ctx, o, &g), wanted);
  if (wanted != SPH_OK) assert_null(g);
  return g;
}

/* --- ghosts ------------------------------------------------------------------------------ */

static void test_options(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  const rh_system s = {.ctx = ctx};
  sph_ghosts_options o;
#define REFUSE(change)         \
  sph_ghosts_options_init(&o); \
  change;                      \
  make(&s, &o, SPH_ERR_ARG);
  REFUSE(o.dim = 0)
  REFUSE(o.dim = 4)
  REFUSE(o.position_field = SPH_FIELD_V)
  REFUSE(o.support = -1.0)
  REFUSE(o.support = 0.0)
  REFUSE(o.support = NAN)
  REFUSE(o.reach = -1.0)
  REFUSE(o.reach = INFINITY)
  REFUSE(o.skin = -0.1)
  REFUSE(o.escape = 0)
  REFUSE(o.escape = 4)
  REFUSE(o.gravity[2] = NAN)
  REFUSE(o.gradient_field = SPH_FIELD_V)
  REFUSE(o.gradient_field = 128)
  REFUSE(o.gradient_field = -2)
  REFUSE(o.size = 4)
#undef REFUSE
  struct {
    sph_ghosts_options o;
    int64_t more;
  } later;
  memset(&later, 0, sizeof later);
  sph_ghosts_options_init_sized(&later.o, sizeof later);
  later.more = 1;
  make(&s, &later.o, SPH_ERR_VERSION);
  later.more = 0;
  sph_ghosts_destroy(make(&s, &later.o, SPH_OK));
  sph_ghosts_destroy(make(&s, NULL, SPH_OK));
  sph_context_destroy(ctx);
}

static void test_walls(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  const rh_system s = {.ctx = ctx, .dim = 3};
  sph_ghosts *g = gh_ghosts(&s, 0.0);
  sph_wall w, kept;
  int32_t index = -7;
#define REFUSE(change)    \
  sph_wall_init(&w);      \
  w.kind = SPH_WALL_SLIP; \
  w.normal[0] = 1.0;      \
  change;                 \
  check_status(sph_ghosts_add_wall(g, &w, &index), SPH_ERR_ARG);
  REFUSE(w.kind = 0)
  REFUSE(w.kind = 6)
  REFUSE(w.normal[0] = 0.0)
  REFUSE(w.normal[1] = INFINITY)
  REFUSE(w.point[2] = NAN)
  REFUSE(w.data.velocity[0] = NAN)
  REFUSE(w.data.acceleration[1] = NAN)
  REFUSE(w.data.traction[2] = INFINITY)
  REFUSE(w.data.traction_rate[2] = NAN)
  REFUSE(w.beta_max = 0.5)
  REFUSE(w.beta_max = NAN)
  REFUSE(w.modulus = -1.0)
  REFUSE(w.shear_modulus = INFINITY)
#undef REFUSE
  assert_int_equal(index, -7);
  /* 32 walls around a sphere; none faces as another does */
  for (int k = 0; k < 33; k++) {
    sph_wall_init(&w);
    w.kind = SPH_WALL_SLIP;
    w.normal[0] = cos(0.1 * k);
    w.normal[1] = 1e200 * sin(0.1 * k);
    w.normal[0] *= 1e200;
    check_status(sph_ghosts_add_wall(g, &w, &index), k < 32 ? SPH_OK : SPH_ERR_LIMIT);
    assert_int_equal(index, k < 32 ? k : 31);
  }
  sph_wall_init(&kept);
  check_ok(sph_ghosts_get_wall(g, 5, &kept));
  check_close(kept.normal[0], cos(0.5), 1e-15);
  w.normal[0] = cos(0.6); /* as wall 6 */
  w.normal[1] = sin(0.6);
  check_status(sph_ghosts_set_wall(g, 5, &w), SPH_ERR_ARG);
  assert_non_null(strstr(sph_context_last_error(ctx), "walls 6 and 5"));
  check_status(sph_ghosts_set_wall(g, 32, &w), SPH_ERR_ARG);
  check_status(sph_ghosts_set_wall(g, -1, &w), SPH_ERR_ARG);
  check_status(sph_ghosts_get_wall(g, 32, &w), SPH_ERR_ARG);
  w.size = 0;
  check_status(sph_ghosts_get_wall(g, 0, &w), SPH_ERR_ARG);
  sph_wall_init(&w);
  check_ok(sph_ghosts_get_wall(g, 5, &w));
  assert_memory_equal(&w, &kept, sizeof w);
  static const int32_t bad[][2] = {{-1, SPH_MIRROR_COPY},
                                   {128, SPH_MIRROR_COPY},
                                   {SPH_FIELD_V, 0},
                                   {SPH_FIELD_V, 7},
                                   {SPH_FIELD_E, SPH_MIRROR_WALL}};
  for (int k = 0; k < 5; k++)
    check_status(sph_ghosts_set_mirror(g, bad[k][0], bad[k][1]), SPH_ERR_ARG);
  sph_ghosts_destroy(g);
  sph_context_destroy(ctx);
}

/* What an update refuses; the ghosts that were there stay. */
static void check_refused(sph_ghosts *g, const rh_system *s, sph_status wanted, const char *word) {
  const int64_t count = sph_particles_count(s->set);
  const uint64_t generation = sph_particles_generation(s->set);
  check_status(sph_ghosts_update(g, s->set, 0.0), wanted);
  assert_non_null(strstr(sph_context_last_error(s->ctx), word));
  assert_int_equal(sph_particles_count(s->set), count);
  assert_int_equal(sph_particles_generation(s->set), generation);
}

/* A field for the velocity gradient that does not exist, or has other components. */
static void test_gradient_field(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, SIDE, 0, 2);
  sph_ghosts_options o;
  int32_t field;
  sph_ghosts_options_init(&o);
  o.dim = 2;
  o.gradient_field = 64;
  sph_ghosts *g = make(&s, &o, SPH_OK);
  check_refused(g, &s, SPH_ERR_ARG, "no gradient_field 64");
  check_ok(sph_particles_add_field(s.set, "L", 3, &field));
  assert_int_equal(field, 64);
  check_refused(g, &s, SPH_ERR_ARG, "3 components");
  check_ok(sph_ghosts_set_mirror(g, field, SPH_MIRROR_COPY));
  check_refused(g, &s, SPH_ERR_ARG, "3 components");
  check_ok(sph_ghosts_set_mirror(g, field, SPH_MIRROR_WALL));
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

static void test_updates(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, SIDE, 0, 2), cube = rh_make(ctx, 3, 3, 0, 2);
  const gh_frame frame = gh_identity();
  sph_ghosts *g = gh_ghosts(&s, 0.0);
  check_ok(sph_ghosts_update(g, s.set, 0.0)); /* no wall, no ghost */
  assert_int_equal(sph_ghosts_count(g), 0);
  check_status(sph_ghosts_update(g, cube.set, 0.0), SPH_ERR_ARG);
  sph_wall w = gh_wall(&frame, 2, SIDE, 0, SPH_WALL_SLIP);
  gh_add(g, &w);
  check_status(sph_ghosts_refresh(g, s.set, 0.0), SPH_ERR_STATE); /* a wall came */
  check_ok(sph_ghosts_update(g, s.set, 0.0));
  check_ok(sph_ghosts_refresh(g, s.set, 0.0));
  assert_true(sph_ghosts_count(g) > 0);
  /* face to face and too close */
  w = gh_wall(&frame, 2, 1.5, 1, SPH_WALL_SLIP);
  gh_add(g, &w);
  check_refused(g, &s, SPH_ERR_UNSUPPORTED, "face each other at the distance 1.5");
  w.point[0] = SIDE;
  check_ok(sph_ghosts_set_wall(g, 1, &w));
  check_ok(sph_ghosts_update(g, s.set, 0.0));
  /* a slanting wall: no trouble while its edges are far from all particles */
  w = gh_wall(&frame, 2, SIDE, 2, SPH_WALL_SLIP);
  w.normal[0] = 0.5;
  w.point[0] = -40.0;
  w.point[1] = -40.0;
  gh_add(g, &w);
  check_ok(sph_ghosts_update(g, s.set, 0.0));
  w.point[0] = w.point[1] = 0.0;
  check_ok(sph_ghosts_set_wall(g, 2, &w));
  check_refused(g, &s, SPH_ERR_UNSUPPORTED, "not at right angles");
  sph_ghosts_destroy(g);
  /* nothing to take the reach from */
  sph_particles *bare = NULL;
  sph_particles_options o;
  sph_particles_options_init(&o);
  o.dim = 2;
  check_ok(sph_particles_create(ctx, &o, &bare));
  check_ok(sph_particles_add(bare, 4, NULL));
  g = gh_ghosts(&s, 0.0);
  gh_box(g, &frame, 2, SIDE, SPH_WALL_SLIP);
  check_status(sph_ghosts_update(g, bare, 0.0), SPH_ERR_ARG);
  assert_non_null(strstr(sph_context_last_error(ctx), "field H"));
  double *h = NULL;
  check_ok(sph_particles_field(bare, SPH_FIELD_H, &h)); /* all 0 */
  check_status(sph_ghosts_update(g, bare, 0.0), SPH_ERR_ARG);
  sph_ghosts_destroy(g);
  sph_particles_destroy(bare);
  rh_free(&cube);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* A lent array: with room the ghosts go there, without they are refused in a sentence, also
 * through a right-hand side. */
static void test_lent(void **state) {
  (void)state;
  static double lent[2 * 400];
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, SIDE, 0, 2);
  const gh_frame frame = gh_identity();
  sph_ghosts *g = gh_ghosts(&s, 0.0);
  gh_box(g, &frame, 2, SIDE, SPH_WALL_SLIP);
  memcpy(lent, gh_const(&s, SPH_FIELD_X), (size_t)(2 * s.n) * sizeof *lent);
  check_ok(sph_particles_lend(s.set, SPH_FIELD_X, lent, s.n + 3));
  check_refused(g, &s, SPH_ERR_LIMIT, "lent to field 'x'");
  sph_rhs *rhs = rh_rhs(&s);
  check_ok(sph_rhs_set_prepare(rhs, sph_ghosts_prepare, g));
  check_status(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, NULL, 0), SPH_ERR_CALLBACK);
  assert_non_null(strstr(sph_context_last_error(ctx), "lent to field 'x'"));
  check_ok(sph_particles_lend(s.set, SPH_FIELD_X, lent, 400));
  check_ok(sph_ghosts_update(g, s.set, 0.0));
  assert_true(sph_ghosts_count(g) > 3);
  const double first = lent[2 * sph_ghosts_owners(g)[0]];
  const int across_x = sph_ghosts_walls(g)[0] == 1;
  assert_true(across_x ? lent[2 * s.n] == -first : lent[2 * s.n] == first);
  sph_rhs_destroy(rhs);
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

static sph_status out_of_memory(sph_context *ctx, void *user) {
  (void)user;
  oom_pause();
  rh_system s = rh_make(ctx, 2, SIDE, 0, 2);
  oom_resume();
  const gh_frame frame = gh_identity();
  sph_ghosts *g = NULL;
  sph_hold *hold = NULL;
  sph_ghosts_options o;
  sph_ghosts_options_init(&o);
  o.dim = 2;
  const double normal[3] = {0.0, 1.0, 0.0};
  sph_status status = sph_ghosts_create(ctx, &o, &g);
  for (int face = 0; face < 4 && !status; face++) {
    const sph_wall w = gh_wall(&frame, 2, SIDE, face, SPH_WALL_SLIP);
    status = sph_ghosts_add_wall(g, &w, NULL);
  }
  const int64_t count = sph_particles_count(s.set);
  if (!status) status = sph_ghosts_update(g, s.set, 0.0);
  if (status) assert_int_equal(sph_particles_count(s.set), count);
  if (!status) status = sph_hold_create(ctx, &hold);
  for (int k = 0; k < 9 && !status; k++)
    status = k % 2 ? sph_hold_field(hold, SPH_FIELD_V, 5, NULL, 0, 1, NULL, NULL, NULL)
                   : sph_hold_traction(hold, 1, NULL, 0, normal, NULL, NULL, NULL);
  sph_hold_destroy(hold);
  sph_ghosts_destroy(g);
  rh_free(&s);
  return status;
}

static void test_memory(void **state) {
  (void)state;
  oom_sweep(out_of_memory, NULL);
}

/* A steady stage allocates nothing. */
static void test_steady(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, SIDE, 0, 2);
  const gh_frame frame = gh_identity();
  sph_ghosts *g = gh_ghosts(&s, 0.0);
  int64_t before, after;
  gh_box(g, &frame, 2, SIDE, SPH_WALL_SLIP);
  for (int k = 0; k < 6; k++) {
    double *x = rh_field(&s, SPH_FIELD_X);
    for (int64_t i = 0; i < 2 * s.rows; i++) x[i] += k % 2 ? 1e-3 : -1e-3;
    check_ok(sph_particles_touch(s.set, SPH_FIELD_X));
    assert_int_equal(sph_ghosts_prepare(g, 0.0, s.set, NULL, 0), 0);
    if (k == 3) check_ok(sph_context_memory(ctx, NULL, NULL, &before));
  }
  check_ok(sph_context_memory(ctx, NULL, NULL, &after));
  assert_int_equal(before, after);
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* --- held particles ----------------------------------------------------------------------------
 */

static void drive(void *user, double t, int64_t i, double *rate) {
  rate[0] = *(const double *)user * t;
  rate[1] = (double)i;
}

static void test_hold_field(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, 4, 0, 2);
  sph_hold *hold = NULL;
  double v[32], x[32], scale = 5.0;
  const sph_rate rates[2] = {{SPH_FIELD_V, v}, {SPH_FIELD_X, x}};
  const int64_t list[2] = {9, 2};
  int32_t index = -1;
  check_ok(sph_hold_create(ctx, &hold));
  check_ok(sph_hold_field(hold, SPH_FIELD_V, 3, NULL, 4, UINT64_MAX, NULL, NULL, &index));
  assert_int_equal(index, 0);
  check_ok(sph_hold_field(hold, SPH_FIELD_V, 2, list, 0, 2, drive, &scale, &index));
  assert_int_equal(index, 1);
  check_ok(sph_hold_field(hold, SPH_FIELD_V, 1, NULL, 5, 1, drive, &scale, NULL));
  check_ok(sph_hold_field(hold, SPH_FIELD_RHO, 1, NULL, 5, 1, NULL, NULL, NULL)); /* not asked */
  for (int k = 0; k < 32; k++) v[k] = x[k] = 100.0 + k;
  assert_int_equal(sph_hold_finish(hold, 3.0, s.set, rates, 2), 0);
  for (int i = 0; i < 16; i++) {
    double want[2] = {100.0 + 2 * i, 101.0 + 2 * i};
    if (i >= 4 && i < 7) want[0] = want[1] = 0.0;
    if (i == 9 || i == 2) want[1] = i;
    if (i == 5) want[0] = 15.0; /* the later entry counts */
    assert_true(v[2 * i] == want[0] && v[2 * i + 1] == want[1]);
    assert_true(x[2 * i] == 100.0 + 2 * i);
  }
  /* the last entry does nothing wrong until it is asked for */
  check_ok(sph_hold_field(hold, SPH_FIELD_V, 1, NULL, 16, 1, NULL, NULL, NULL));
  assert_int_equal(sph_hold_finish(hold, 3.0, s.set, rates, 2), SPH_ERR_ARG);
  assert_non_null(strstr(sph_context_last_error(ctx), "particle 16 of 16"));
  check_ok(sph_hold_clear(hold));
  check_ok(sph_hold_field(hold, SPH_FIELD_V, 1, NULL, 0, 4, NULL, NULL, NULL));
  assert_int_equal(sph_hold_finish(hold, 3.0, s.set, rates, 2), SPH_ERR_ARG);
  check_ok(sph_hold_clear(hold));
  assert_int_equal(sph_hold_finish(hold, 3.0, s.set, rates, 2), 0);
  assert_int_equal(sph_hold_finish(hold, 3.0, s.set, NULL, 2), SPH_ERR_ARG);
  assert_int_equal(sph_hold_finish(hold, 3.0, s.set, NULL, -1), SPH_ERR_ARG);
  assert_int_equal(sph_hold_finish(NULL, 3.0, s.set, rates, 2), SPH_ERR_ARG);
  assert_int_equal(sph_hold_finish(ctx, 3.0, s.set, rates, 2), SPH_ERR_HANDLE);
  assert_int_equal(sph_hold_finish(hold, 3.0, NULL, rates, 2), SPH_ERR_ARG);
#define REFUSE(...) check_status(sph_hold_field(hold, __VA_ARGS__, NULL, NULL, NULL), SPH_ERR_ARG);
  REFUSE(-1, 1, NULL, 0, 1)
  REFUSE(128, 1, NULL, 0, 1)
  REFUSE(SPH_FIELD_V, 1, NULL, 0, 0)
  REFUSE(SPH_FIELD_V, -1, NULL, 0, 1)
  REFUSE(SPH_FIELD_V, INT64_MAX, NULL, 0, 1)
  REFUSE(SPH_FIELD_V, 1, NULL, -1, 1)
  REFUSE(SPH_FIELD_V, 1, ((const int64_t[]){-3}), 0, 1)
#undef REFUSE
  sph_hold_destroy(hold);
  rh_free(&s);
  sph_context_destroy(ctx);
}

static void wanted_traction(void *user, double t, int64_t i, double *rate) {
  for (int a = 0; a < 3; a++) rate[a] = ((const double *)user)[a] * t + (double)i;
}

/* (d sigma/dt) m is what is asked for; what acts within the surface is kept: u.s u for every u
 * across m. */
static void test_hold_traction(void **state) {
  (void)state;
  const double push[3] = {0.3, -0.8, 1.1};
  for (int32_t dim = 1; dim <= 3; dim++) {
    sph_context *ctx = rh_context(1);
    rh_system s = rh_make(ctx, dim, 3, 0, 2);
    const gh_frame f = gh_random_frame(dim);
    const int32_t comps = dim * (dim + 1) / 2;
    double *rate = rh_array(6 * s.rows), before[6], user[3], normal[3] = {0.0, 0.0, 5.0};
    for (int a = 0; a < 3; a++) user[a] = push[a];
    for (int a = 0; a < dim; a++) normal[a] = 2.0 * f.e[0][a];
    for (int64_t k = 0; k < comps * s.rows; k++) rate[k] = rh_random(-1.0, 1.0);
    memcpy(before, rate + comps, sizeof before);
    sph_hold *hold = NULL;
    const sph_rate rates = {SPH_FIELD_SIGMA, rate};
    check_ok(sph_hold_create(ctx, &hold));
    check_ok(sph_hold_traction(hold, 1, NULL, 1, normal, wanted_traction, user, NULL));
    assert_int_equal(sph_hold_finish(hold, 2.0, s.set, &rates, 1), 0);
    for (int a = 0; a < dim; a++) {
      double sum = 0.0;
      for (int b = 0; b < dim; b++) sum += rate[comps + rh_sym(dim, a, b)] * f.e[0][b];
      check_close(sum, 2.0 * push[a] + 1.0, 1e-14);
    }
    for (int u = 1; u < dim; u++)
      for (int w = 1; w < dim; w++) {
        double got = 0.0, want = 0.0;
        for (int a = 0; a < dim; a++)
          for (int b = 0; b < dim; b++) {
            got += rate[comps + rh_sym(dim, a, b)] * f.e[u][a] * f.e[w][b];
            want += before[rh_sym(dim, a, b)] * f.e[u][a] * f.e[w][b];
          }
        check_close(got, want, 1e-14);
      }
    const double bad[2][3] = {{0.0, 0.0, 0.0}, {NAN, 1.0, 0.0}};
    for (int k = 0; k < 2; k++)
      check_status(sph_hold_traction(hold, 1, NULL, 0, bad[k], NULL, NULL, NULL), SPH_ERR_ARG);
    const double beyond[3] = {0.0, 0.0, 1.0};
    check_ok(sph_hold_traction(hold, 1, NULL, 0, beyond, NULL, NULL, NULL));
    assert_int_equal(sph_hold_finish(hold, 2.0, s.set, &rates, 1), dim < 3 ? SPH_ERR_ARG : SPH_OK);
    free(rate);
    sph_hold_destroy(hold);
    rh_free(&s);
    sph_context_destroy(ctx);
  }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_options),       cmocka_unit_test(test_walls),
    cmocka_unit_test(test_updates),       cmocka_unit_test(test_gradient_field),
    cmocka_unit_test(test_lent),          cmocka_unit_test(test_memory),
    cmocka_unit_test(test_steady),        cmocka_unit_test(test_hold_field),
    cmocka_unit_test(test_hold_traction),
};
SPH_TEST_MAIN(tests)
