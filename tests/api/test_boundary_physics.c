/* Boundaries in use: what a wall does to velocity gradients, to water at rest and to momentum. */
#include "../ghost_help.h"

enum { SIDE = 8 };

static double *evaluate(const rh_system *s, sph_rhs *rhs, int32_t field) {
  return rh_rates(s, rhs, field);
}

static void add_term(sph_rhs *rhs, int32_t kind, int32_t form, int32_t corrected) {
  sph_term t = rh_term(kind, form, corrected);
  check_ok(sph_rhs_add(rhs, &t));
}

/* A lattice of spacing 1 and unit density. */
static rh_system lattice(sph_context *ctx, int32_t dim) {
  rh_system s = rh_make(ctx, dim, SIDE, 0, 1);
  double *x = rh_field(&s, SPH_FIELD_X), *h = rh_field(&s, SPH_FIELD_H);
  for (int64_t k = 0; k < s.rows * dim; k++) x[k] = floor(x[k]) + 0.5;
  for (int64_t i = 0; i < s.rows; i++) {
    rh_field(&s, SPH_FIELD_M)[i] = rh_field(&s, SPH_FIELD_RHO)[i] = 1.0;
    h[i] = 1.3;
  }
  check_ok(sph_particles_touch(s.set, SPH_FIELD_X));
  return s;
}

/* --- velocity gradients ------------------------------------------------------------------ */

/* A material whose stress rate shows the velocity gradient: {xx, yy, xy} = {L00, L11, L01}. */
static int32_t show_gradient(void *user, const sph_material_block *b, double *out) {
  (void)user;
  for (int64_t i = 0; i < b->n; i++) {
    out[3 * i] = b->velocity_gradient[4 * i];
    out[3 * i + 1] = b->velocity_gradient[4 * i + 3];
    out[3 * i + 2] = b->velocity_gradient[4 * i + 1];
  }
  return 0;
}

static sph_rhs *gradient_rhs(const rh_system *s, sph_ghosts *g, int32_t corrected) {
  sph_rhs *rhs = rh_rhs(s);
  sph_material *m = NULL;
  sph_material_functions f;
  sph_material_functions_init(&f);
  f.stress_rate = show_gradient;
  check_ok(sph_material_create(s->ctx, &f, NULL, &m));
  check_ok(sph_rhs_set_material(rhs, 0, m));
  sph_material_destroy(m);
  add_term(rhs, SPH_TERM_STRESS_RATE, 0, corrected);
  check_ok(sph_rhs_set_prepare(rhs, sph_ghosts_prepare, g));
  return rhs;
}

/* The shear v_x = v_b + 0.3 y above a no-slip wall at y = 0 that moves with v_b, and the
 * stretching v_y = 0.7 y at a slip wall: the wall rows must see the same gradient as the middle. */
static void check_gradient(int32_t kind, int32_t corrected) {
  sph_context *ctx = rh_context(1);
  rh_system s = lattice(ctx, 2);
  sph_ghosts *g = gh_ghosts(&s, 0.0);
  sph_wall w;
  sph_wall_init(&w);
  w.kind = kind;
  w.normal[1] = 1.0;
  w.beta_max = INFINITY;
  w.data.velocity[0] = -0.4;
  gh_add(g, &w);
  for (int64_t i = 0; i < s.rows; i++) {
    const double y = gh_const(&s, SPH_FIELD_X)[2 * i + 1];
    rh_field(&s, SPH_FIELD_V)[2 * i] = kind == SPH_WALL_SLIP ? 5.0 : -0.4 + 0.3 * y;
    rh_field(&s, SPH_FIELD_V)[2 * i + 1] = 0.7 * y;
  }
  sph_rhs *rhs = gradient_rhs(&s, g, corrected);
  if (kind == SPH_WALL_PAIRWISE)
    check_ok(sph_rhs_add_host(rhs, SPH_TARGET_VELOCITY_GRADIENT, sph_no_slip_gradient, g));
  double *L = evaluate(&s, rhs, SPH_FIELD_SIGMA);
  const int64_t middle = 3 * (4 * SIDE + 4);
  if (corrected) {
    check_close(L[middle + 1], 0.7, 1e-12);
    check_close(L[middle + 2], kind == SPH_WALL_SLIP ? 0.0 : 0.3, 1e-12);
  }
  assert_true(fabs(L[middle + 1] - 0.7) < 0.02);
  for (int64_t y = 0; y < 5; y++)
    for (int c = 0; c < 3; c++) check_close(L[3 * (y * SIDE + 4) + c], L[middle + c], 1e-13);
  free(L);
  sph_rhs_destroy(rhs);
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

static void test_gradients(void **state) {
  (void)state;
  for (int32_t corrected = 0; corrected < 2; corrected++) {
    check_gradient(SPH_WALL_SLIP, corrected);
    check_gradient(SPH_WALL_NO_SLIP, corrected);
    check_gradient(SPH_WALL_VELOCITY, corrected);
  }
  check_gradient(SPH_WALL_PAIRWISE, 0);
}

/* --- no-slip by pairs --------------------------------------------------------------------------
 */

/* One pair of He 2015 (3.10) at the walls x = 0 and y = 0, of which the line from i to the ghost
 * meets one first. */
static void brute_pair(const rh_system *s, int64_t i, int64_t owner, uint32_t mask, double beta_max,
                       double *dx, double *dv) {
  static const double wall_v[2][2] = {{0.3, -0.2}, {0.1, 0.6}};
  const double *xi = gh_const(s, SPH_FIELD_X) + 2 * i, *xo = gh_const(s, SPH_FIELD_X) + 2 * owner;
  const double *vi = gh_const(s, SPH_FIELD_V) + 2 * i;
  int first = -1;
  double meets = 2.0;
  for (int a = 0; a < 2; a++) {
    const double image = mask >> a & 1 ? -xo[a] : xo[a];
    dx[a] = xi[a] - image;
    if (!(mask >> a & 1) || xi[a] / dx[a] >= meets) continue;
    meets = xi[a] / dx[a];
    first = a;
  }
  const double beta = fmin(beta_max, 1.0 + (dx[first] - xi[first]) / xi[first]);
  for (int a = 0; a < 2; a++) dv[a] = (1.0 - beta) * vi[a] + beta * wall_v[first][a] - vi[a];
}

typedef struct pair_sums {
  double L[4], drho, stress[2], pressure[2];
} pair_sums;

static pair_sums brute_sums(const rh_system *s, int64_t i, double reach, double beta_max) {
  pair_sums sum = {{0.0}, 0.0, {0.0}, {0.0}};
  const double *sigma = gh_const(s, SPH_FIELD_SIGMA) + 3 * i, *m = gh_const(s, SPH_FIELD_M);
  const double *x = gh_const(s, SPH_FIELD_X), h = gh_const(s, SPH_FIELD_H)[i];
  const double rho = gh_const(s, SPH_FIELD_RHO)[i], p = gh_const(s, SPH_FIELD_P)[i];
  for (int64_t o = 0; o < s->rows; o++)
    for (uint32_t mask = 1; mask < 4; mask++) {
      double dx[2], dv[2], d2 = 0.0;
      for (int a = 0; a < 2; a++) d2 += mask >> a & 1 ? x[2 * o + a] * x[2 * o + a] : 0.0;
      if (d2 >= reach * reach) continue;
      brute_pair(s, i, o, mask, beta_max, dx, dv);
      const double r = hypot(dx[0], dx[1]), f = sph_kernel_dwdr(s->kernel, r, h) / r;
      for (int a = 0; a < 2; a++) {
        for (int b = 0; b < 2; b++) sum.L[2 * a + b] += m[o] / rho * dv[a] * f * dx[b];
        sum.drho -= m[o] * dv[a] * f * dx[a];
        sum.stress[a] += 2.0 * m[o] / (rho * rho) * f * (sigma[a] * dx[a] + sigma[2] * dx[1 - a]);
        sum.pressure[a] -= 2.0 * m[o] / (rho * rho) * p * f * dx[a];
      }
    }
  return sum;
}

static sph_ghosts *pairwise_corner(const rh_system *s, double beta_max) {
  sph_ghosts *g = gh_ghosts(s, 0.0);
  const double v[2][2] = {{0.3, -0.2}, {0.1, 0.6}};
  for (int a = 0; a < 2; a++) {
    sph_wall w;
    sph_wall_init(&w);
    w.kind = SPH_WALL_PAIRWISE;
    w.normal[a] = 1.0;
    w.beta_max = beta_max;
    memcpy(w.data.velocity, v[a], sizeof v[a]);
    gh_add(g, &w);
  }
  return g;
}

/* The library's own terms see nothing of these ghosts, so the host terms' part is what differs. */
static void check_pairs(double beta_max) {
  static const sph_pair_fn fns[] = {sph_no_slip_gradient, sph_no_slip_continuity,
                                    sph_no_slip_stress, sph_no_slip_pressure};
  static const int32_t targets[] = {SPH_TARGET_VELOCITY_GRADIENT, SPH_FIELD_RHO, SPH_FIELD_V,
                                    SPH_FIELD_V};
  sph_context *ctx = rh_context(3);
  rh_system s = rh_make(ctx, 2, SIDE, RH_VARY_M, 21);
  const double reach = 2.0 * gh_const(&s, SPH_FIELD_H)[0];
  for (int term = 0; term < 4; term++) {
    double *rates[2];
    const int32_t field = term == 0 ? SPH_FIELD_SIGMA : targets[term];
    const int32_t comps = sph_particles_components(s.set, field);
    for (int with = 0; with < 2; with++) {
      sph_ghosts *g = pairwise_corner(&s, beta_max);
      sph_rhs *rhs = gradient_rhs(&s, g, 0);
      add_term(rhs, SPH_TERM_CONTINUITY, 0, 0);
      add_term(rhs, SPH_TERM_STRESS, 0, 0);
      if (with) check_ok(sph_rhs_add_host(rhs, targets[term], fns[term], g));
      rates[with] = evaluate(&s, rhs, field);
      sph_rhs_destroy(rhs);
      sph_ghosts_destroy(g);
    }
    for (int64_t i = 0; i < s.rows; i++) {
      const pair_sums b = brute_sums(&s, i, reach, beta_max);
      const double shown[3] = {b.L[0], b.L[3], b.L[1]};
      const double *want[] = {shown, &b.drho, b.stress, b.pressure};
      for (int c = 0; c < comps; c++)
        check_close(rates[1][i * comps + c] - rates[0][i * comps + c], want[term][c], 1e-12);
    }
    free(rates[0]);
    free(rates[1]);
  }
  rh_free(&s);
  sph_context_destroy(ctx);
}

static void test_pairs(void **state) {
  (void)state;
  check_pairs(1.5); /* He's bound */
  check_pairs(2.5);
  check_pairs(INFINITY);
}

/* Without a stress rate nobody asks for the velocity gradient. */
static void test_target_skipped(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = lattice(ctx, 2);
  sph_ghosts *g = pairwise_corner(&s, 1.5);
  sph_rhs *rhs = gradient_rhs(&s, g, 0);
  check_ok(sph_rhs_add_host(rhs, SPH_TARGET_VELOCITY_GRADIENT, sph_no_slip_gradient, g));
  add_term(rhs, SPH_TERM_MOTION, 0, 0);
  double *dx = evaluate(&s, rhs, SPH_FIELD_X);
  assert_memory_equal(dx, gh_const(&s, SPH_FIELD_V), (size_t)(2 * s.rows) * sizeof *dx);
  free(dx);
  sph_rhs_destroy(rhs);
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* --- water at rest ------------------------------------------------------------------------------
 */

/* p = -rho g.(x - surface), gravity askew to the walls of a corner in 3-D: with the ghosts'
 * pressure continued, no particle of the corner accelerates, and without it they do. */
static void check_hydrostatic(const double *gravity, double tolerance, int at_rest) {
  sph_context *ctx = rh_context(1);
  rh_system s = lattice(ctx, 3);
  sph_ghosts *g = NULL;
  sph_ghosts_options o;
  sph_ghosts_options_init(&o);
  if (at_rest) memcpy(o.gravity, gravity, sizeof o.gravity);
  check_ok(sph_ghosts_create(ctx, &o, &g));
  const gh_frame frame = gh_identity();
  for (int face = 0; face < 6; face += 2) {
    const sph_wall w = gh_wall(&frame, 3, SIDE, face, SPH_WALL_SLIP);
    gh_add(g, &w);
  }
  for (int64_t i = 0; i < s.rows; i++) {
    const double *x = gh_const(&s, SPH_FIELD_X) + 3 * i;
    rh_field(&s, SPH_FIELD_P)[i] = 20.0 + gravity[0] * x[0] + gravity[1] * x[1] + gravity[2] * x[2];
  }
  sph_rhs *rhs = rh_rhs(&s);
  sph_term force = rh_term(SPH_TERM_BODY_FORCE, 0, 0);
  memcpy(force.vector, gravity, sizeof force.vector);
  check_ok(sph_rhs_add(rhs, &force));
  add_term(rhs, SPH_TERM_PRESSURE, SPH_PRESSURE_DIFFERENCE, 1);
  check_ok(sph_rhs_set_prepare(rhs, sph_ghosts_prepare, g));
  double *a = evaluate(&s, rhs, SPH_FIELD_V), most = 0.0;
  for (int64_t i = 0; i < s.rows; i++) {
    const double *x = gh_const(&s, SPH_FIELD_X) + 3 * i;
    for (int k = 0; k < 3 && x[0] < 4.0 && x[1] < 4.0 && x[2] < 4.0; k++)
      most = fmax(most, fabs(a[3 * i + k]));
  }
  if (at_rest)
    assert_true(most < tolerance);
  else
    assert_true(most > 0.1);
  free(a);
  sph_rhs_destroy(rhs);
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

static void test_hydrostatic(void **state) {
  (void)state;
  const double gravity[3] = {-0.4, -0.9, -0.7};
  check_hydrostatic(gravity, 1e-12, 1);
  check_hydrostatic(gravity, 0.0, 0);
}

/* Pressures of a material are mirrored as they are now, also in the first evaluation. */
static int32_t square_law(void *user, const sph_material_block *b, double *p) {
  (void)user;
  for (int64_t i = 0; i < b->n; i++) p[i] = b->rho[i] * b->rho[i];
  return 0;
}

static void test_pressure_law(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, SIDE, 0, 3);
  const gh_frame frame = gh_identity();
  sph_ghosts *g = gh_ghosts(&s, 0.0);
  gh_box(g, &frame, 2, SIDE, SPH_WALL_SLIP);
  sph_material *m = NULL;
  sph_material_functions f;
  sph_material_functions_init(&f);
  f.pressure = square_law;
  check_ok(sph_material_create(ctx, &f, NULL, &m));
  sph_rhs *rhs = rh_rhs(&s);
  check_ok(sph_rhs_set_material(rhs, 0, m));
  sph_material_destroy(m);
  check_ok(sph_rhs_set_prepare(rhs, sph_ghosts_prepare, g));
  for (int round = 0; round < 2; round++) {
    double *rho = rh_field(&s, SPH_FIELD_RHO);
    for (int64_t i = 0; i < s.rows; i++) rho[i] = 1.0 + round + 0.01 * (double)i;
    check_ok(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, NULL, 0));
    rho = rh_field(&s, SPH_FIELD_RHO);
    for (int64_t k = 0; k < sph_ghosts_count(g); k++) {
      const double own = rho[sph_ghosts_owners(g)[k]];
      assert_true(gh_const(&s, SPH_FIELD_P)[s.rows + k] == own * own);
    }
  }
  sph_rhs_destroy(rhs);
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* --- momentum ---------------------------------------------------------------------------- */

/* A slip wall pushes along its normal only: what it changes of the momentum of a random state has
 * no part along the wall, to rounding; the normal part is not small. */
static void test_momentum(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 3, SIDE, RH_VARY_M, 31);
  const gh_frame frame = gh_random_frame(3);
  gh_turn(&s, &frame);
  sph_ghosts *g = gh_ghosts(&s, 0.0);
  const sph_wall w = gh_wall(&frame, 3, SIDE, 2, SPH_WALL_SLIP);
  gh_add(g, &w);
  sph_rhs *rhs = rh_rhs(&s);
  add_term(rhs, SPH_TERM_STRESS, SPH_STRESS_SUMMED, 0);
  add_term(rhs, SPH_TERM_PRESSURE, SPH_PRESSURE_MASS, 0);
  add_term(rhs, SPH_TERM_MONAGHAN, 0, 0);
  check_ok(sph_rhs_set_prepare(rhs, sph_ghosts_prepare, g));
  double *a = evaluate(&s, rhs, SPH_FIELD_V), sum[3] = {0.0}, size = 0.0;
  for (int64_t i = 0; i < s.rows; i++)
    for (int k = 0; k < 3; k++) {
      const double m = gh_const(&s, SPH_FIELD_M)[i];
      size += fabs(m * a[3 * i + k]);
      for (int l = 0; l < 3; l++) sum[l] += m * a[3 * i + k] * frame.e[l][k];
    }
  assert_true(fabs(sum[0]) < 1e-13 * size && fabs(sum[2]) < 1e-13 * size);
  assert_true(fabs(sum[1]) > 1e-6 * size);
  free(a);
  sph_rhs_destroy(rhs);
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_gradients),      cmocka_unit_test(test_pairs),
    cmocka_unit_test(test_target_skipped), cmocka_unit_test(test_hydrostatic),
    cmocka_unit_test(test_pressure_law),   cmocka_unit_test(test_momentum),
};
SPH_TEST_MAIN(tests)
