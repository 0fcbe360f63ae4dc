/* Second-order ghosts in 2-D: errors of waves against exact solutions, in a frozen configuration.
 */
#include "../ghost_help.h"

/* Isotropic Hooke by its moduli M = lambda + 2 G and G, plane strain, small rotations; rho = 1. */
static const double M = 3.0, G = 1.0;

static int32_t hooke(void *user, const sph_material_block *b, double *out) {
  (void)user;
  for (int64_t i = 0; i < b->n; i++) {
    const double *L = b->velocity_gradient + 4 * i, trace = L[0] + L[3];
    out[3 * i] = (M - 2.0 * G) * trace + 2.0 * G * L[0];
    out[3 * i + 1] = (M - 2.0 * G) * trace + 2.0 * G * L[3];
    out[3 * i + 2] = G * (L[1] + L[2]);
  }
  return 0;
}

/* A lattice of nx times ny particles of spacing dp, and what advances it. */
typedef struct body {
  rh_system s;
  sph_ghosts *ghosts;
  sph_rhs *rhs;
  sph_integrator *it;
  double dp;
} body;

static body make_body(sph_context *ctx, int nx, int ny, double dp, int periodic_x) {
  body b = {.s = {.ctx = ctx, .dim = 2, .n = (int64_t)nx * ny, .rows = (int64_t)nx * ny}, .dp = dp};
  sph_particles_options po;
  sph_neighbors_options no;
  sph_particles_options_init(&po);
  po.dim = 2;
  check_ok(sph_particles_create(ctx, &po, &b.s.set));
  check_ok(sph_particles_add(b.s.set, b.s.rows, NULL));
  check_ok(sph_kernel_create(ctx, SPH_KERNEL_CUBIC_SPLINE, 2, &b.s.kernel));
  sph_neighbors_options_init(&no);
  no.periodic[0] = periodic_x;
  no.box_hi[0] = nx * dp;
  check_ok(sph_neighbors_create(ctx, &no, &b.s.list));
  for (int64_t i = 0; i < b.s.rows; i++) {
    rh_field(&b.s, SPH_FIELD_X0)[2 * i] = ((double)(i % nx) + 0.5) * dp;
    rh_field(&b.s, SPH_FIELD_X0)[2 * i + 1] = ((double)(i / nx) + 0.5) * dp;
    rh_field(&b.s, SPH_FIELD_M)[i] = dp * dp;
    rh_field(&b.s, SPH_FIELD_RHO)[i] = 1.0;
    rh_field(&b.s, SPH_FIELD_H)[i] = 1.5 * dp;
  }
  rh_field(&b.s, SPH_FIELD_V);
  rh_field(&b.s, SPH_FIELD_SIGMA);
  return b;
}

static void make_ghosts(body *b, int periodic_x, int32_t gradient_field) {
  sph_ghosts_options o;
  sph_ghosts_options_init(&o);
  o.dim = 2;
  o.position_field = SPH_FIELD_X0;
  o.periodic[0] = periodic_x;
  o.gradient_field = gradient_field;
  check_ok(sph_ghosts_create(b->s.ctx, &o, &b->ghosts));
}

/* Summed form, corrected gradients, RK4. */
static void make_scheme(body *b) {
  static const int32_t kinds[2] = {SPH_TERM_STRESS, SPH_TERM_STRESS_RATE};
  sph_rhs_options ro;
  sph_material *m = NULL;
  sph_material_functions f;
  sph_rhs_options_init(&ro);
  ro.position_field = SPH_FIELD_X0;
  check_ok(sph_rhs_create(b->s.ctx, b->s.kernel, &ro, &b->rhs));
  sph_material_functions_init(&f);
  f.stress_rate = hooke;
  check_ok(sph_material_create(b->s.ctx, &f, NULL, &m));
  check_ok(sph_rhs_set_material(b->rhs, 0, m));
  sph_material_destroy(m);
  for (int k = 0; k < 2; k++) {
    const sph_term t = rh_term(kinds[k], 0, 1);
    check_ok(sph_rhs_add(b->rhs, &t));
  }
  check_ok(sph_rhs_set_prepare(b->rhs, sph_ghosts_prepare, b->ghosts));
  check_ok(sph_integrator_create(b->s.ctx, NULL, &b->it));
  check_ok(sph_integrator_bind_field(b->it, SPH_FIELD_V));
  check_ok(sph_integrator_bind_field(b->it, SPH_FIELD_SIGMA));
  check_ok(sph_integrator_set_rhs(b->it, b->rhs, b->s.list));
}

static void free_body(body *b) {
  sph_integrator_destroy(b->it);
  sph_rhs_destroy(b->rhs);
  sph_ghosts_destroy(b->ghosts);
  rh_free(&b->s);
}

/* --- plane waves -------------------------------------------------------------------------- */

/* A strip of length 1 that wraps across. At its end y = 0 a pressure and a shear act, its end y = 1
 * is fixed: a P and an S wave of speeds sqrt(M) and sqrt(G), looked at until the first arrives. */
enum { ACROSS = 13 };
static const double strip_end = 0.55;

/* Smooth at its start up to the third derivative: sin^4(pi t), and its rate. */
static double bump(double t) { return t > 0.0 ? pow(sin(3.141592653589793 * t), 4.0) : 0.0; }
static double bump_rate(double t) {
  const double a = 3.141592653589793 * t;
  return t > 0.0 ? 4.0 * 3.141592653589793 * pow(sin(a), 3.0) * cos(a) : 0.0;
}

static int32_t load(void *user, double t, sph_wall *wall) {
  (void)user;
  for (int a = 0; a < 2; a++) {
    wall->data.traction[a] = (a == 0 ? 2e-3 : 1e-3) * bump(t);
    wall->data.traction_rate[a] = (a == 0 ? 2e-3 : 1e-3) * bump_rate(t);
  }
  return 0;
}

/* The wave from the loaded end: v = force / c at t - y/c, in each direction. */
static void strip_errors(const body *b, double error[2]) {
  for (int a = 0; a < 2; a++) {
    const double c = sqrt(a == 0 ? G : M), force = a == 0 ? 2e-3 : 1e-3;
    double e2 = 0.0, s2 = 0.0;
    for (int64_t i = 0; i < b->s.rows; i++) {
      const double y = gh_const(&b->s, SPH_FIELD_X0)[2 * i + 1];
      const double exact = force / c * bump(strip_end - y / c);
      const double e = gh_const(&b->s, SPH_FIELD_V)[2 * i + a] - exact;
      e2 += e * e;
      s2 += exact * exact;
    }
    error[a] = sqrt(e2 / s2);
  }
}

static void run_strip(int n, int second_order, double error[2]) {
  sph_context *ctx = rh_context(1);
  const gh_frame frame = gh_identity();
  body b = make_body(ctx, ACROSS, n, 1.0 / n, 1);
  make_ghosts(&b, 1, -1);
  sph_wall w = gh_wall(&frame, 2, 1.0, 2, SPH_WALL_TRACTION);
  w.move = load;
  w.modulus = second_order ? M : 0.0;
  w.shear_modulus = second_order ? G : 0.0;
  gh_add(b.ghosts, &w);
  w = gh_wall(&frame, 2, 1.0, 3, SPH_WALL_VELOCITY);
  gh_add(b.ghosts, &w);
  make_scheme(&b);
  const int steps = (int)ceil(strip_end * sqrt(M) / b.dp);
  for (int k = 0; k < steps; k++)
    check_ok(sph_integrator_step(b.it, b.s.set, k * strip_end / steps, strip_end / steps, NULL));
  strip_errors(&b, error);
  free_body(&b);
  sph_context_destroy(ctx);
}

static void test_strip(void **state) {
  (void)state;
  double coarse[2], fine[2], plain[2];
  run_strip(20, 1, coarse);
  run_strip(80, 1, fine);
  run_strip(80, 0, plain);
  for (int a = 0; a < 2; a++) {
    const double rate = log(coarse[a] / fine[a]) / log(4.0);
    if (!(rate > 1.9 && plain[a] > 3.0 * fine[a]))
      fail_msg("direction %d: errors %g, %g, rate %g; without the terms in d %g", a, coarse[a],
               fine[a], rate, plain[a]);
  }
}

/* --- free edges --------------------------------------------------------------------------- */

/* Lame's mode of a square plate of side 1 with four free edges, k = pi, G = 1:
 *   v = (-cos kx sin ky, sin kx cos ky) cos(omega t),  omega = sqrt(2) k,
 *   sigma_xx = -sigma_yy = 2 k sin kx sin ky sin(omega t) / omega,  sigma_xy = 0.
 * At the edge x = 0 the tangential velocity has the slope -dv_x/dy, not 0. */
static void lame(double x, double y, double t, double v[2], double sigma[3]) {
  const double k = 3.141592653589793, omega = sqrt(2.0) * k;
  v[0] = -cos(k * x) * sin(k * y) * cos(omega * t);
  v[1] = sin(k * x) * cos(k * y) * cos(omega * t);
  sigma[0] = 2.0 * k * sin(k * x) * sin(k * y) * sin(omega * t) / omega;
  sigma[1] = -sigma[0];
  sigma[2] = 0.0;
}

/* The velocity gradient of the present state, with the ghosts as they are. */
static void find_gradient(const body *b, int32_t field) {
  const rh_system *s = &b->s;
  double *matrix = rh_array(4 * sph_particles_count(s->set));
  sph_operands a;
  check_ok(sph_ghosts_update(b->ghosts, s->set, 0.0));
  double *L = rh_field(s, field);
  check_ok(sph_operands_from_set(s->set, &a));
  a.x = gh_const(s, SPH_FIELD_X0);
  check_ok(sph_neighbors_update_arrays(s->list, 2, a.n, a.x, a.h, 0.0, NULL));
  check_ok(sph_gradient_matrix(s->list, s->kernel, &a, matrix, NULL, NULL));
  a.gradient_matrix = matrix;
  check_ok(sph_velocity_gradient(s->list, s->kernel, &a, L));
  free(matrix);
}

static double plate_norm(const body *b, double t) {
  double e2 = 0.0, s2 = 0.0;
  for (int64_t i = 0; i < b->s.rows; i++) {
    const double *x = gh_const(&b->s, SPH_FIELD_X0) + 2 * i;
    double v[2], sigma[3];
    lame(x[0], x[1], t, v, sigma);
    for (int a = 0; a < 2; a++) {
      const double e = gh_const(&b->s, SPH_FIELD_V)[2 * i + a] - v[a];
      e2 += e * e;
      s2 += v[a] * v[a];
    }
  }
  return sqrt(e2 / s2);
}

/* Relative L2 error of the velocity after a third of the period. */
static double plate_error(int n, int with_gradient) {
  sph_context *ctx = rh_context(1);
  const gh_frame frame = gh_identity();
  const double end = 0.5;
  int32_t field;
  body b = make_body(ctx, n, n, 1.0 / n, 0);
  for (int64_t i = 0; i < b.s.rows; i++) {
    const double *x = gh_const(&b.s, SPH_FIELD_X0) + 2 * i;
    lame(x[0], x[1], 0.0, rh_field(&b.s, SPH_FIELD_V) + 2 * i,
         rh_field(&b.s, SPH_FIELD_SIGMA) + 3 * i);
  }
  check_ok(sph_particles_add_field(b.s.set, "L", 4, &field));
  make_ghosts(&b, 0, with_gradient ? field : -1);
  for (int face = 0; face < 4; face++) {
    sph_wall w = gh_wall(&frame, 2, 1.0, face, SPH_WALL_TRACTION);
    w.modulus = M;
    w.shear_modulus = G;
    gh_add(b.ghosts, &w);
  }
  make_scheme(&b);
  for (int k = 0; k < n; k++) { /* the gradient of the last step serves in the next */
    find_gradient(&b, field);
    check_ok(sph_integrator_step(b.it, b.s.set, k * end / n, end / n, NULL));
  }
  const double error = plate_norm(&b, end);
  free_body(&b);
  sph_context_destroy(ctx);
  return error;
}

static void test_free_plate(void **state) {
  (void)state;
  const double coarse = plate_error(10, 1), fine = plate_error(40, 1), plain = plate_error(40, 0);
  const double rate = log(coarse / fine) / log(4.0);
  if (!(rate > 1.9 && fine < 0.02 && plain > 5.0 * fine))
    fail_msg("errors %g, %g, rate %g; without the velocity gradient %g", coarse, fine, rate, plain);
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(test_strip),
                                          cmocka_unit_test(test_free_plate)};
SPH_TEST_MAIN(tests)
