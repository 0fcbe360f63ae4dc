/* Ghosts: the values of their fields. Fields that are linear in the distance from the wall and obey
 * its condition must be continued linearly; turned walls give turned values. */
#include "../ghost_help.h"

enum { SIDE = 6 };

/* --- linear fields ----------------------------------------------------------------------- */

/* In the wall's frame (normal = axis 0): f(d) = f0 + d f1. */
typedef struct linear_field {
  double v0[3], v1[3], s0[6], s1[6], p0, p1;
  sph_wall_data data; /* in the wall's frame */
  double gravity[3];
} linear_field;

static const double M = 7.0, G = 2.0, rho = 1.3;

static void random_vector(double *v, int32_t dim) {
  for (int a = 0; a < 3; a++) v[a] = a < dim ? rh_random(-1.0, 1.0) : 0.0;
}

/* What holds at a wall, derived here from continuum mechanics: e_0 points into the body. */
static linear_field make_field(int32_t kind, int32_t dim) {
  linear_field f;
  double force[3] = {0.0, 0.0, 0.0};
  memset(&f, 0, sizeof f);
  random_vector(f.data.velocity, dim);
  random_vector(f.data.acceleration, dim);
  random_vector(f.data.traction, dim);
  random_vector(f.data.traction_rate, dim);
  random_vector(f.gravity, dim);
  random_vector(f.v0, dim);
  random_vector(f.v1, dim);
  for (int c = 0; c < dim * (dim + 1) / 2; c++) f.s0[c] = rh_random(-1.0, 1.0);
  f.p0 = rh_random(-1.0, 1.0);
  for (int a = 0; a < dim; a++) force[a] = rho * (f.data.acceleration[a] - f.gravity[a]);
  f.p1 = -force[0]; /* rho a = -grad p + rho g */
  if (kind == SPH_WALL_SLIP) {
    /* v_n is the wall's, v_t has no gradient; no shear at the wall, where sigma_nn obeys the
     * momentum balance */
    f.v0[0] = f.data.velocity[0];
    for (int a = 1; a < dim; a++) {
      f.v1[a] = 0.0;
      f.s0[rh_sym(dim, 0, a)] = 0.0;
      f.s1[rh_sym(dim, 0, a)] = rh_random(-1.0, 1.0);
    }
    f.s1[0] = force[0];
  } else if (kind == SPH_WALL_TRACTION) {
    /* the force on the body is sigma times the outward normal -e_0 */
    for (int a = 0; a < dim; a++) {
      f.s0[rh_sym(dim, 0, a)] = -f.data.traction[a];
      f.s1[rh_sym(dim, 0, a)] = rh_random(-1.0, 1.0);
      f.v1[a] = -f.data.traction_rate[a] / (a == 0 ? M : G);
    }
    f.p0 = f.data.traction[0];
    f.p1 = rh_random(-1.0, 1.0);
  } else {
    for (int a = 0; a < dim; a++) {
      f.v0[a] = f.data.velocity[a];
      f.s1[rh_sym(dim, 0, a)] = force[a];
    }
  }
  return f;
}

static void values_at(const gh_frame *frame, const linear_field *f, int32_t dim, double d,
                      double *v, double *sigma, double *p) {
  double vd[3], sd[6];
  for (int a = 0; a < dim; a++) vd[a] = f->v0[a] + d * f->v1[a];
  for (int c = 0; c < dim * (dim + 1) / 2; c++) sd[c] = f->s0[c] + d * f->s1[c];
  gh_vector(frame, dim, vd, v);
  gh_tensor(frame, dim, sd, sigma);
  *p = f->p0 + d * f->p1;
}

/* Write the field on particles [from, to), or compare. */
static void apply_field(const rh_system *s, const gh_frame *frame, const linear_field *f,
                        int64_t from, int64_t to, int compare) {
  const int32_t dim = s->dim, comps = dim * (dim + 1) / 2;
  const double *x = gh_const(s, SPH_FIELD_X);
  double *v = rh_field(s, SPH_FIELD_V), *sigma = rh_field(s, SPH_FIELD_SIGMA);
  double *p = rh_field(s, SPH_FIELD_P);
  for (int64_t i = from; i < to; i++) {
    double vi[3], si[6], pi, d = 0.0;
    for (int a = 0; a < dim; a++) d += (x[i * dim + a] - frame->origin[a]) * frame->e[0][a];
    values_at(frame, f, dim, d, vi, si, &pi);
    for (int a = 0; a < dim && compare; a++) check_close(v[i * dim + a], vi[a], 4e-13);
    for (int c = 0; c < comps && compare; c++) check_close(sigma[i * comps + c], si[c], 4e-13);
    if (compare) check_close(p[i], pi, 4e-13);
    if (compare) continue;
    memcpy(v + i * dim, vi, (size_t)dim * sizeof *v);
    memcpy(sigma + i * comps, si, (size_t)comps * sizeof *sigma);
    p[i] = pi;
  }
}

static sph_wall wall_of(const gh_frame *frame, const linear_field *f, int32_t dim, int32_t kind) {
  sph_wall w = gh_wall(frame, dim, SIDE, 0, kind);
  gh_vector(frame, dim, f->data.velocity, w.data.velocity);
  gh_vector(frame, dim, f->data.acceleration, w.data.acceleration);
  gh_vector(frame, dim, f->data.traction, w.data.traction);
  gh_vector(frame, dim, f->data.traction_rate, w.data.traction_rate);
  w.modulus = M;
  w.shear_modulus = G;
  w.beta_max = INFINITY;
  for (int a = 0; a < dim; a++) w.normal[a] *= 3.0; /* made a unit vector */
  return w;
}

static sph_ghosts *ghosts_with_gravity(const rh_system *s, const gh_frame *frame,
                                       const double *gravity) {
  sph_ghosts *g = NULL;
  sph_ghosts_options o;
  sph_ghosts_options_init(&o);
  o.dim = s->dim;
  gh_vector(frame, s->dim, gravity, o.gravity);
  check_ok(sph_ghosts_create(s->ctx, &o, &g));
  return g;
}

static void check_linear(int32_t dim, int32_t kind) {
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, dim, SIDE, 0, (uint64_t)(10 * dim + kind));
  const gh_frame frame = gh_random_frame(dim);
  const linear_field f = make_field(kind, dim);
  const sph_wall w = wall_of(&frame, &f, dim, kind);
  gh_turn(&s, &frame);
  double *density = rh_field(&s, SPH_FIELD_RHO);
  for (int64_t i = 0; i < s.rows; i++) density[i] = rho;
  apply_field(&s, &frame, &f, 0, s.rows, 0);
  sph_ghosts *g = ghosts_with_gravity(&s, &frame, f.gravity);
  gh_add(g, &w);
  check_ok(sph_ghosts_update(g, s.set, 0.0));
  assert_true(sph_ghosts_count(g) > 0);
  apply_field(&s, &frame, &f, s.rows, s.rows + sph_ghosts_count(g), 1);
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

static void test_linear(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int32_t kind = SPH_WALL_SLIP; kind <= SPH_WALL_VELOCITY; kind++)
      if (kind != SPH_WALL_PAIRWISE) check_linear(dim, kind);
}

/* --- velocity gradients ------------------------------------------------------------------ */

/* v = v0 + L x, linear in all directions, at a TRACTION wall whose rate of traction obeys Hooke's
 * law: continued linearly. Turned at random. */
static void check_gradient(int32_t dim) {
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, dim, SIDE, 0, (uint64_t)(70 + dim));
  const gh_frame frame = gh_random_frame(dim);
  double L[9], slope[3] = {0.0}, spread = 0.0, w[3], u[3];
  gh_turn(&s, &frame);
  int32_t field;
  check_ok(sph_particles_add_field(s.set, "L", dim * dim, &field));
  for (int k = 0; k < 9; k++) L[k] = rh_random(-1.0, 1.0);
  for (int64_t i = 0; i < s.rows; i++) {
    memcpy(rh_field(&s, field) + i * dim * dim, L, (size_t)(dim * dim) * sizeof *L);
    for (int a = 0; a < dim; a++) {
      rh_field(&s, SPH_FIELD_V)[i * dim + a] = 0.1 * a;
      for (int b = 0; b < dim; b++)
        rh_field(&s, SPH_FIELD_V)[i * dim + a] +=
            L[a * dim + b] * gh_const(&s, SPH_FIELD_X)[i * dim + b];
    }
  }
  /* sdot n = lambda (tr L) n + G (L + L^T) n, lambda = M - 2 G; the traction rate is its negative
   */
  for (int a = 0; a < dim; a++) spread += L[a * dim + a];
  for (int a = 0; a < dim; a++) {
    for (int b = 0; b < dim; b++) slope[a] += G * (L[a * dim + b] + L[b * dim + a]) * frame.e[0][b];
    w[a] = (M - 2.0 * G) * spread * frame.e[0][a] + slope[a];
  }
  sph_ghosts *g = NULL;
  sph_ghosts_options o;
  sph_ghosts_options_init(&o);
  o.dim = dim;
  o.gradient_field = field;
  check_ok(sph_ghosts_create(ctx, &o, &g));
  sph_wall wall = gh_wall(&frame, dim, SIDE, 0, SPH_WALL_TRACTION);
  wall.modulus = M;
  wall.shear_modulus = G;
  for (int a = 0; a < dim; a++) wall.data.traction_rate[a] = -w[a];
  gh_add(g, &wall);
  check_ok(sph_ghosts_update(g, s.set, 0.0));
  for (int64_t i = s.rows; i < s.rows + sph_ghosts_count(g); i++)
    for (int a = 0; a < dim; a++) {
      u[a] = 0.1 * a;
      for (int b = 0; b < dim; b++) u[a] += L[a * dim + b] * gh_const(&s, SPH_FIELD_X)[i * dim + b];
      check_close(gh_const(&s, SPH_FIELD_V)[i * dim + a], u[a], 1e-12);
      for (int b = 0; b < dim; b++)
        assert_true(gh_const(&s, field)[(i * dim + a) * dim + b] == L[a * dim + b]);
    }
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* Images of a linear velocity field about other walls: their L is that of their velocities. */
static void check_mirrored_gradient(int32_t kind) {
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 3, SIDE, 0, 90);
  const gh_frame frame = gh_random_frame(3);
  double L[9];
  int32_t field;
  gh_turn(&s, &frame);
  check_ok(sph_particles_add_field(s.set, "L", 9, &field));
  for (int k = 0; k < 9; k++) L[k] = rh_random(-1.0, 1.0);
  for (int64_t i = 0; i < s.rows; i++) {
    memcpy(rh_field(&s, field) + 9 * i, L, sizeof L);
    for (int a = 0; a < 3; a++) {
      rh_field(&s, SPH_FIELD_V)[3 * i + a] = 0.0;
      for (int b = 0; b < 3; b++)
        rh_field(&s, SPH_FIELD_V)[3 * i + a] += L[3 * a + b] * gh_const(&s, SPH_FIELD_X)[3 * i + b];
    }
  }
  sph_ghosts *g = NULL;
  sph_ghosts_options o;
  sph_ghosts_options_init(&o);
  o.gradient_field = field;
  check_ok(sph_ghosts_create(ctx, &o, &g));
  const sph_wall wall = gh_wall(&frame, 3, SIDE, 4, kind);
  gh_add(g, &wall);
  check_ok(sph_ghosts_update(g, s.set, 0.0));
  const int64_t first = s.rows;
  for (int64_t i = first + 1; i < first + sph_ghosts_count(g); i++)
    for (int a = 0; a < 3; a++) {
      double difference = 0.0;
      for (int b = 0; b < 3; b++)
        difference +=
            gh_const(&s, field)[9 * i + 3 * a + b] *
            (gh_const(&s, SPH_FIELD_X)[3 * i + b] - gh_const(&s, SPH_FIELD_X)[3 * first + b]);
      check_close(gh_const(&s, SPH_FIELD_V)[3 * i + a] - gh_const(&s, SPH_FIELD_V)[3 * first + a],
                  difference, 1e-12);
    }
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

static void test_gradients(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) check_gradient(dim);
  check_mirrored_gradient(SPH_WALL_SLIP);
  check_mirrored_gradient(SPH_WALL_VELOCITY);
}

/* --- single values ----------------------------------------------------------------------- */

/* One particle at (1, 0.5) with v = (2, 3), sigma = (5, 7, 11), rho = 2, m = 6, p = 13. */
static rh_system one_particle(sph_context *ctx) {
  rh_system s = rh_make(ctx, 2, 1, 0, 1);
  const double x[2] = {1.0, 0.5}, v[2] = {2.0, 3.0}, sigma[3] = {5.0, 7.0, 11.0};
  memcpy(rh_field(&s, SPH_FIELD_X), x, sizeof x);
  memcpy(rh_field(&s, SPH_FIELD_V), v, sizeof v);
  memcpy(rh_field(&s, SPH_FIELD_SIGMA), sigma, sizeof sigma);
  rh_field(&s, SPH_FIELD_RHO)[0] = 2.0;
  rh_field(&s, SPH_FIELD_M)[0] = 6.0;
  rh_field(&s, SPH_FIELD_P)[0] = 13.0;
  check_ok(sph_particles_touch(s.set, SPH_FIELD_X));
  return s;
}

static void check_one(int32_t kind, double beta_max, const double v[2], const double sigma[3],
                      double p, double m) {
  sph_context *ctx = rh_context(1);
  rh_system s = one_particle(ctx);
  sph_ghosts *g = gh_ghosts(&s, 0.0);
  sph_wall w;
  sph_wall_init(&w);
  w.kind = kind;
  w.normal[1] = 1.0; /* y = 0, distance 0.5 */
  w.beta_max = beta_max;
  w.modulus = 4.0;
  w.shear_modulus = 2.0;
  w.data = (sph_wall_data){{0.5, 1.0}, {10.0, 20.0}, {3.0, 9.0}, {-1.0, 8.0}};
  gh_add(g, &w);
  check_ok(sph_ghosts_update(g, s.set, 0.0));
  assert_int_equal(sph_ghosts_count(g), 1);
  const double *x = gh_const(&s, SPH_FIELD_X);
  assert_true(x[2] == 1.0 && x[3] == -0.5);
  for (int a = 0; a < 2; a++) check_close(gh_const(&s, SPH_FIELD_V)[2 + a], v[a], 1e-15);
  for (int c = 0; c < 3; c++) check_close(gh_const(&s, SPH_FIELD_SIGMA)[3 + c], sigma[c], 1e-14);
  check_close(gh_const(&s, SPH_FIELD_P)[1], p, 1e-14);
  assert_true(gh_const(&s, SPH_FIELD_M)[1] == m && gh_const(&s, SPH_FIELD_RHO)[1] == 2.0);
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* By hand, with 2 d rho a = 2 (10, 20). */
static void test_single(void **state) {
  (void)state;
  check_one(SPH_WALL_SLIP, 1.5, (double[]){2.0, -1.0}, (double[]){5.0, -33.0, -11.0}, 53.0, 6.0);
  /* He's bound: -0.5 v + 1.5 v_b; the minus of (3.10b) would give -1.75, -3 */
  check_one(SPH_WALL_NO_SLIP, 1.5, (double[]){-0.25, 0.0}, (double[]){5.0, -33.0, -9.0}, 53.0, 6.0);
  check_one(SPH_WALL_NO_SLIP, 9.0, (double[]){-1.0, -1.0}, (double[]){5.0, -33.0, -9.0}, 53.0, 6.0);
  check_one(SPH_WALL_PAIRWISE, 1.5, (double[]){-0.25, 0.0}, (double[]){5.0, -33.0, -9.0}, 53.0,
            0.0);
  check_one(SPH_WALL_VELOCITY, 1.5, (double[]){-1.0, -1.0}, (double[]){5.0, -33.0, -9.0}, 53.0,
            6.0);
  /* sigma n = -t: sigma_yy = -18 - 7, sigma_xy = -6 - 11; dv/dn = (1/2, -8/4) */
  check_one(SPH_WALL_TRACTION, 1.5, (double[]){1.5, 5.0}, (double[]){5.0, -25.0, -17.0}, 5.0, 6.0);
}

/* Slip at y = 0, no-slip at x = 0: the corner image passes through both. */
static void test_corner(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = one_particle(ctx);
  sph_ghosts *g = gh_ghosts(&s, 0.0);
  sph_wall w;
  for (int k = 0; k < 2; k++) {
    sph_wall_init(&w);
    w.kind = k ? SPH_WALL_VELOCITY : SPH_WALL_SLIP;
    w.normal[k ? 0 : 1] = 1.0;
    gh_add(g, &w);
  }
  check_ok(sph_ghosts_update(g, s.set, 0.0));
  assert_int_equal(sph_ghosts_count(g), 3);
  const double x[6] = {1.0, -0.5, -1.0, 0.5, -1.0, -0.5};
  const double v[6] = {2.0, -3.0, -2.0, -3.0, -2.0, 3.0};
  const double sigma[9] = {5.0, 7.0, -11.0, 5.0, 7.0, 11.0, 5.0, 7.0, -11.0};
  for (int k = 0; k < 6; k++) {
    assert_true(gh_const(&s, SPH_FIELD_X)[2 + k] == x[k]);
    assert_true(gh_const(&s, SPH_FIELD_V)[2 + k] == v[k]);
  }
  for (int k = 0; k < 9; k++) assert_true(gh_const(&s, SPH_FIELD_SIGMA)[3 + k] == sigma[k]);
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* --- turned boxes ------------------------------------------------------------------------ */

/* Walls of different kinds on all faces; the box and the data are turned together. */
static sph_ghosts *mixed_box(const rh_system *s, const gh_frame *frame) {
  static const int32_t kinds[6] = {SPH_WALL_SLIP,     SPH_WALL_TRACTION, SPH_WALL_VELOCITY,
                                   SPH_WALL_PAIRWISE, SPH_WALL_NO_SLIP,  SPH_WALL_SLIP};
  const double gravity[3] = {0.2, -0.7, 0.4};
  sph_ghosts *g = ghosts_with_gravity(s, frame, gravity);
  for (int face = 0; face < 2 * s->dim; face++) {
    sph_wall w = gh_wall(frame, s->dim, SIDE, face, kinds[face]);
    linear_field f;
    rh_seed = (uint64_t)(100 + face);
    f = make_field(SPH_WALL_VELOCITY, s->dim);
    const sph_wall like = wall_of(frame, &f, s->dim, kinds[face]);
    w.data = like.data;
    w.modulus = M;
    w.shear_modulus = G;
    gh_add(g, &w);
  }
  return g;
}

static void check_turned(int32_t dim) {
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, dim, SIDE, 0, 4), turned = rh_make(ctx, dim, SIDE, 0, 4);
  const gh_frame straight = gh_identity(), frame = gh_random_frame(dim);
  const int32_t comps = dim * (dim + 1) / 2;
  sph_ghosts *g = mixed_box(&s, &straight), *h = mixed_box(&turned, &frame);
  gh_turn(&turned, &frame);
  check_ok(sph_ghosts_update(g, s.set, 0.0));
  check_ok(sph_ghosts_update(h, turned.set, 0.0));
  const int64_t count = sph_ghosts_count(g);
  assert_int_equal(count, sph_ghosts_count(h));
  assert_memory_equal(sph_ghosts_owners(g), sph_ghosts_owners(h), (size_t)count * 8);
  assert_memory_equal(sph_ghosts_walls(g), sph_ghosts_walls(h), (size_t)count * 4);
  for (int64_t i = s.rows; i < s.rows + count; i++) {
    double u[6];
    gh_point(&frame, dim, gh_const(&s, SPH_FIELD_X) + i * dim, u);
    for (int a = 0; a < dim; a++)
      check_close(gh_const(&turned, SPH_FIELD_X)[i * dim + a], u[a], 1e-13 * SIDE);
    gh_vector(&frame, dim, gh_const(&s, SPH_FIELD_V) + i * dim, u);
    for (int a = 0; a < dim; a++)
      check_close(gh_const(&turned, SPH_FIELD_V)[i * dim + a], u[a], 1e-13 * SIDE);
    gh_tensor(&frame, dim, gh_const(&s, SPH_FIELD_SIGMA) + i * comps, u);
    for (int c = 0; c < comps; c++)
      check_close(gh_const(&turned, SPH_FIELD_SIGMA)[i * comps + c], u[c], 1e-13 * SIDE);
    check_close(gh_const(&turned, SPH_FIELD_P)[i], gh_const(&s, SPH_FIELD_P)[i], 1e-13 * SIDE);
  }
  sph_ghosts_destroy(h);
  sph_ghosts_destroy(g);
  rh_free(&turned);
  rh_free(&s);
  sph_context_destroy(ctx);
}

static void test_turned(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) check_turned(dim);
}

/* --- other fields, callbacks ------------------------------------------------------------- */

static void test_other_fields(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = one_particle(ctx);
  sph_ghosts *g = gh_ghosts(&s, 0.0);
  int32_t plain, vector, tensor, left, matrix;
  check_ok(sph_particles_add_field(s.set, "plain", 5, &plain));
  check_ok(sph_particles_add_field(s.set, "vector", 2, &vector));
  check_ok(sph_particles_add_field(s.set, "tensor", 3, &tensor));
  check_ok(sph_particles_add_field(s.set, "left", 1, &left));
  check_ok(sph_particles_add_field(s.set, "matrix", 4, &matrix));
  check_ok(sph_ghosts_set_mirror(g, matrix, SPH_MIRROR_MATRIX));
  check_ok(sph_ghosts_set_mirror(g, vector, SPH_MIRROR_VECTOR));
  check_ok(sph_ghosts_set_mirror(g, tensor, SPH_MIRROR_TENSOR));
  check_ok(sph_ghosts_set_mirror(g, left, SPH_MIRROR_LEAVE));
  check_ok(sph_ghosts_set_mirror(g, SPH_FIELD_V, SPH_MIRROR_COPY));
  const int32_t fields[] = {
      plain,  vector,     tensor, left, SPH_FIELD_A, SPH_FIELD_E, SPH_FIELD_SPACING,
      matrix, SPH_FIELD_F};
  for (int k = 0; k < 9; k++)
    for (int c = 0; c < sph_particles_components(s.set, fields[k]); c++)
      rh_field(&s, fields[k])[c] = 10.0 * k + c + 1.0;
  sph_particles_phases(s.set)[0] = 4;
  sph_wall w;
  sph_wall_init(&w);
  w.kind = SPH_WALL_SLIP;
  w.normal[1] = 1.0;
  gh_add(g, &w);
  check_ok(sph_ghosts_update(g, s.set, 0.0));
  for (int c = 0; c < 5; c++) assert_true(gh_const(&s, plain)[5 + c] == c + 1.0);
  assert_true(gh_const(&s, vector)[2] == 11.0 && gh_const(&s, vector)[3] == -12.0);
  assert_true(gh_const(&s, tensor)[3] == 21.0 && gh_const(&s, tensor)[4] == 22.0);
  assert_true(gh_const(&s, tensor)[5] == -23.0);
  assert_true(gh_const(&s, left)[1] == 0.0);
  for (int c = 0; c < 4; c++) { /* those with one index across the wall change sign */
    const double sign = c == 1 || c == 2 ? -1.0 : 1.0;
    assert_true(gh_const(&s, matrix)[4 + c] == sign * (71.0 + c));
    assert_true(gh_const(&s, SPH_FIELD_F)[4 + c] == sign * (81.0 + c));
  }
  assert_true(gh_const(&s, SPH_FIELD_A)[2] == 41.0 && gh_const(&s, SPH_FIELD_A)[3] == -42.0);
  assert_true(gh_const(&s, SPH_FIELD_E)[1] == 51.0 && gh_const(&s, SPH_FIELD_SPACING)[1] == 61.0);
  assert_true(gh_const(&s, SPH_FIELD_C)[1] == gh_const(&s, SPH_FIELD_C)[0]);
  assert_true(gh_const(&s, SPH_FIELD_H)[1] == gh_const(&s, SPH_FIELD_H)[0]);
  assert_true(gh_const(&s, SPH_FIELD_V)[3] == 3.0);
  assert_int_equal(sph_particles_phases(s.set)[1], 4);
  assert_int_equal(sph_particles_roles(s.set)[1], SPH_ROLE_GHOST);
  rh_field(&s, left)[1] = 8.0; /* what the host writes stays */
  check_ok(sph_ghosts_refresh(g, s.set, 0.0));
  assert_true(gh_const(&s, left)[1] == 8.0);
  /* a mirror that does not fit, before anything is written */
  check_ok(sph_ghosts_set_mirror(g, plain, SPH_MIRROR_VECTOR));
  check_status(sph_ghosts_update(g, s.set, 0.0), SPH_ERR_ARG);
  assert_non_null(strstr(sph_context_last_error(ctx), "plain"));
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

static int32_t swing(void *user, double t, sph_wall *wall) {
  if (t > 100.0) return (int32_t) * (int *)user;
  wall->point[1] = -t;
  wall->data.velocity[1] = -1.0;
  if (t > 50.0) wall->point[1] = NAN;
  return 0;
}

static void by_place(void *user, double t, const double *x, sph_wall_data *data) {
  assert_ptr_equal(user, NULL);
  data->velocity[0] = 100.0 * x[0] + 10.0 * x[1] + t; /* the foot lies on the wall */
  data->velocity[1] *= 2.0;
}

static void test_callbacks(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = one_particle(ctx);
  sph_ghosts *g = gh_ghosts(&s, 0.0);
  sph_wall w, now;
  int answer = 3;
  sph_wall_init(&w);
  w.kind = SPH_WALL_VELOCITY;
  w.normal[1] = 1.0;
  w.move = swing;
  w.move_user = &answer;
  w.vary = by_place;
  gh_add(g, &w);
  check_ok(sph_ghosts_update(g, s.set, 0.25)); /* the wall at y = -0.25 */
  check_close(gh_const(&s, SPH_FIELD_X)[3], -1.0, 1e-15);
  check_close(gh_const(&s, SPH_FIELD_V)[2], 2.0 * (100.0 - 2.5 + 0.25) - 2.0, 1e-12);
  check_close(gh_const(&s, SPH_FIELD_V)[3], 2.0 * -2.0 - 3.0, 1e-13);
  check_ok(sph_ghosts_refresh(g, s.set, 0.5));
  check_close(gh_const(&s, SPH_FIELD_X)[3], -1.5, 1e-15);
  sph_wall_init(&now);
  check_ok(sph_ghosts_get_wall(g, 0, &now));
  assert_true(now.point[1] == -0.5 && now.data.velocity[1] == -1.0 && now.normal[1] == 1.0);
  /* answers, and nonsense; the ghosts stay */
  check_status(sph_ghosts_refresh(g, s.set, 101.0), SPH_RETRY);
  answer = -4;
  check_status(sph_ghosts_update(g, s.set, 101.0), SPH_ERR_CALLBACK);
  assert_non_null(strstr(sph_context_last_error(ctx), "-4"));
  check_status(sph_ghosts_update(g, s.set, 60.0), SPH_ERR_ARG);
  check_close(gh_const(&s, SPH_FIELD_X)[3], -1.5, 1e-15);
  check_ok(sph_ghosts_refresh(g, s.set, 0.5));
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* --- threads ----------------------------------------------------------------------------- */

static void test_threads(void **state) {
  (void)state;
  double *first = NULL;
  int64_t n = 0;
  for (int32_t threads = 1; threads <= 5; threads += 2) {
    sph_context *ctx = rh_context(threads);
    rh_system s = rh_make(ctx, 3, 14, RH_VARY_H, 5); /* several chunks */
    const gh_frame frame = gh_identity();
    sph_ghosts *g = gh_ghosts(&s, 0.0);
    gh_box(g, &frame, 3, 14, SPH_WALL_SLIP);
    check_ok(sph_ghosts_update(g, s.set, 0.0));
    const double *sigma = gh_const(&s, SPH_FIELD_SIGMA);
    if (!first) {
      n = 6 * sph_particles_count(s.set);
      first = rh_array(n);
      memcpy(first, sigma, (size_t)n * sizeof *first);
    }
    assert_int_equal(n, 6 * sph_particles_count(s.set));
    assert_memory_equal(first, sigma, (size_t)n * sizeof *first);
    sph_ghosts_destroy(g);
    rh_free(&s);
    sph_context_destroy(ctx);
  }
  free(first);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_linear),    cmocka_unit_test(test_gradients),
    cmocka_unit_test(test_single),    cmocka_unit_test(test_corner),
    cmocka_unit_test(test_turned),    cmocka_unit_test(test_other_fields),
    cmocka_unit_test(test_callbacks), cmocka_unit_test(test_threads),
};
SPH_TEST_MAIN(tests)
