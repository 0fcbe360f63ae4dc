/* The ready scheme for solids: it is what its parts are, waves travel at their speed, walls hold,
 * laws of h act, and bad input leaves everything as it was. */
#include "../solid_help.h"

#include "../oom.h"

/* ---- the parts, composed by hand --------------------------------------------------------- */

static void add(sph_rhs *rhs, sph_term t) { check_ok(sph_rhs_add(rhs, &t)); }

static sph_rhs *by_hand(sph_context *ctx, int32_t form, sph_kernel *kernel, sph_material *hooke) {
  sph_rhs *rhs = NULL;
  sph_term t;
  check_ok(sph_rhs_create(ctx, kernel, NULL, &rhs));
  sph_term_init(&t);
  t.kind = SPH_TERM_MOTION;
  add(rhs, t);
  t.kind = SPH_TERM_STRESS;
  t.form = form;
  t.corrected = form != SPH_STRESS_CONSERVATIVE;
  add(rhs, t);
  sph_term_init(&t);
  t.kind = SPH_TERM_STRESS_RATE;
  t.corrected = 1;
  add(rhs, t);
  sph_term_init(&t);
  t.kind = SPH_TERM_MONAGHAN;
  t.alpha = t.beta = 2.5;
  add(rhs, t);
  t.kind = SPH_TERM_ARTIFICIAL_STRESS;
  t.epsilon = 0.3;
  t.spacing_ratio = 1.0 / 1.5;
  add(rhs, t);
  check_ok(sph_rhs_set_material(rhs, 0, hooke));
  return rhs;
}

/* Three steps of the host's own composition. */
static void step_by_hand(solid *s, int32_t form) {
  sph_kernel *kernel = NULL;
  sph_neighbors *list = NULL;
  sph_integrator *it = NULL;
  sph_integrator_options io;
  sph_neighbors_options no;
  sph_neighbors_options_init(&no);
  no.method = SPH_NEIGHBORS_VERLET;
  no.skin = 0.3;
  sph_integrator_options_init(&io);
  io.method = SPH_INTEGRATOR_RKC;
  io.stage_rule = SPH_STAGES_CFL;
  io.wave_speed = s->dim == 1 ? 1.0 : sqrt(0.7 / 0.52);
  io.spacing = 1.0;
  check_ok(sph_kernel_create(s->ctx, SPH_KERNEL_CUBIC_SPLINE, s->dim, &kernel));
  check_ok(sph_neighbors_create(s->ctx, &no, &list));
  check_ok(sph_integrator_create(s->ctx, &io, &it));
  sph_rhs *rhs = by_hand(s->ctx, form, kernel, s->hooke);
  static const int32_t fields[] = {SPH_FIELD_X, SPH_FIELD_V, SPH_FIELD_SIGMA};
  for (int k = 0; k < 3; k++) check_ok(sph_integrator_bind_field(it, fields[k]));
  check_ok(sph_integrator_set_rhs(it, rhs, list));
  for (int k = 0; k < 3; k++) check_ok(sph_integrator_step(it, s->set, 0.5 * k, 0.5, NULL));
  sph_integrator_destroy(it);
  sph_rhs_destroy(rhs);
  sph_neighbors_destroy(list);
  sph_kernel_destroy(kernel);
}

static const int64_t sides[4][3] = {{0}, {40}, {9, 8}, {5, 4, 6}};

static void test_composition(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int32_t form = SPH_STRESS_SUMMED; form <= SPH_STRESS_CONSERVATIVE; form++) {
      solid a = so_block(ctx, dim, sides[dim], 0.1), b = so_block(ctx, dim, sides[dim], 0.1);
      sph_elastodynamics_options o = so_options(dim);
      o.momentum = form;
      so_stir(&a, 0.01);
      so_stir(&b, 0.01);
      so_start(&a, &o);
      so_start(&b, &o); /* fills H and C of the other, too */
      for (int k = 0; k < 3; k++) check_ok(sph_elastodynamics_step(a.scheme, 0.5, NULL));
      check_close(sph_elastodynamics_time(a.scheme), 1.5, 0.0);
      step_by_hand(&b, form);
      static const int32_t fields[] = {SPH_FIELD_X, SPH_FIELD_V, SPH_FIELD_SIGMA};
      for (int k = 0; k < 3; k++)
        assert_memory_equal(so_field(&a, fields[k]), so_field(&b, fields[k]),
                            (size_t)(a.n * sph_particles_components(a.set, fields[k])) * 8);
      so_free(&a);
      so_free(&b);
    }
  sph_context_destroy(ctx);
}

/* ---- waves ------------------------------------------------------------------------------- */

/* A plane wave that runs once through a periodic box: everything should be back. Relative error of
 * v, which is that of the phase. */
static double wave_error(sph_context *ctx, int32_t dim, int64_t n) {
  const int64_t side[3] = {n, 7, 7}; /* two cutoffs, skin included */
  solid s = so_block(ctx, dim, side, 0.0);
  sph_elastodynamics_options o = so_options(dim);
  const double k = 2.0 * 3.14159265358979323846 / (double)n;
  double error = 0.0, norm = 0.0;
  o.alpha = o.beta = o.artificial_stress = 0.0;
  o.surface_damping = 0; /* C is checked below */
  o.integrator = SPH_INTEGRATOR_RK4;
  for (int a = 0; a < 3; a++) {
    o.periodic[a] = a < dim;
    o.box_hi[a] = (double)side[a];
  }
  double *x = so_field(&s, SPH_FIELD_X), *v = so_field(&s, SPH_FIELD_V);
  double *sigma = so_field(&s, SPH_FIELD_SIGMA);
  /* (lambda + 2G) / rho with E = 1, nu = 0.3: 0.7 / (1.3 * 0.4); in 1-D E / rho. The other normal
   * stresses are nu / (1 - nu) of that along the wave. */
  const double c = dim == 1 ? 1.0 : sqrt(0.7 / 0.52);
  for (int64_t i = 0; i < s.n; i++) {
    v[i * dim] = 1e-6 * sin(k * x[i * dim]);
    for (int a = 0; a < dim; a++)
      sigma[i * sph_sym_components(dim) + a] = -c * v[i * dim] * (a == 0 ? 1.0 : 0.3 / 0.7);
  }
  so_start(&s, &o);
  check_rel(so_field(&s, SPH_FIELD_C)[0], c, 1e-14);
  check_ok(sph_elastodynamics_run(s.scheme, (double)n / c, NULL, NULL));
  for (int64_t i = 0; i < s.n; i++) {
    const double exact = 1e-6 * sin(k * so_field(&s, SPH_FIELD_X0)[i * dim]);
    error += fabs(v[i * dim] - exact);
    norm += fabs(exact);
  }
  so_free(&s);
  return error / norm;
}

static void test_waves(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++) {
    const double coarse = wave_error(ctx, dim, 16), fine = wave_error(ctx, dim, 32);
    assert_true(fine < 0.3);
    check_close(log2(coarse / fine), 2.0, 0.25);
  }
  sph_context_destroy(ctx);
}

/* ---- walls, forces, hooks ---------------------------------------------------------------- */

static int32_t push(void *user, double t, sph_particles *set, const sph_rate *rates,
                    int32_t count) {
  (void)t;
  (void)set;
  for (int32_t k = 0; k < count; k++)
    if (rates[k].field == SPH_FIELD_V) rates[k].values[*(int64_t *)user] = 0.25;
  return 0;
}

/* The first particle is a wall that moves, the last is pushed by the host: velocities exactly. */
static void test_walls(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  solid s = so_block(ctx, 1, sides[1], 0.0);
  sph_elastodynamics_options o = so_options(1);
  int64_t last = s.n - 1;
  double *x = so_field(&s, SPH_FIELD_X), *v = so_field(&s, SPH_FIELD_V), begin = x[0];
  sph_particles_roles(s.set)[0] = SPH_ROLE_WALL;
  v[0] = 0.01;
  o.xsph = 0.5; /* smooths the positions of the others only */
  so_start(&s, &o);
  check_ok(sph_elastodynamics_set_finish(s.scheme, push, &last));
  check_ok(sph_elastodynamics_run(s.scheme, 3.0, NULL, NULL));
  check_close(v[0], 0.01, 0.0);
  check_close(x[0], begin + 0.03, 1e-14);
  check_close(v[last], 0.75, 1e-13);
  assert_true(v[2] > 1e-4); /* the wave is under way */
  so_free(&s);
  sph_context_destroy(ctx);
}

static void test_body_force(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  solid s = so_block(ctx, 2, sides[2], 0.1);
  sph_elastodynamics_options o = so_options(2);
  o.body_force[1] = -0.5;
  so_start(&s, &o);
  for (int k = 0; k < 4; k++) check_ok(sph_elastodynamics_step(s.scheme, 0.5, NULL));
  for (int64_t i = 0; i < s.n; i++) check_close(so_field(&s, SPH_FIELD_V)[2 * i + 1], -1.0, 1e-13);
  so_free(&s);
  sph_context_destroy(ctx);
}

/* C: the wave speed inside, more at the surface, by the trace of an inverse that is known in 1-D:
 * B of the first particle is half of the full sum, for the lattice is symmetric about it. */
static void test_surface_damping(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int on = 0; on < 2; on++) {
    solid s = so_block(ctx, 1, sides[1], 0.0);
    sph_elastodynamics_options o = so_options(1);
    o.surface_damping = on;
    o.wave_speed = 3.0;
    so_start(&s, &o);
    const double *c = so_field(&s, SPH_FIELD_C);
    sph_kernel *kernel = sph_elastodynamics_kernel(s.scheme);
    double full = 0.0;
    for (int k = 1; k <= 2; k++) full -= 2.0 * k * sph_kernel_dwdr(kernel, k, 1.5);
    check_rel(c[0], on ? 3.0 * 2.0 / full : 3.0, 1e-13);
    check_rel(c[20], on ? 3.0 * fmax(1.0, 1.0 / full) : 3.0, 1e-13);
    so_free(&s);
  }
  sph_context_destroy(ctx);
}

/* ---- density and smoothing length -------------------------------------------------------- */

static void test_h_laws(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  double end[3] = {0};
  for (int32_t law = SPH_H_LAW_DENSITY; law <= SPH_H_LAW_RATE; law++) {
    solid s = so_block(ctx, 2, sides[2], 0.0);
    sph_elastodynamics_options o = so_options(2);
    o.density = SPH_DENSITY_CONTINUITY;
    o.h_law = law;
    o.integrator = SPH_INTEGRATOR_RK4;
    const double *x = so_field(&s, SPH_FIELD_X), *rho = so_field(&s, SPH_FIELD_RHO);
    double *h = so_field(&s, SPH_FIELD_H), *v = so_field(&s, SPH_FIELD_V);
    for (int64_t k = 0; k < 2 * s.n; k++) v[k] = -0.02 * (x[k] - 4.0); /* compresses everywhere */
    so_start(&s, &o);
    check_close(h[0], 1.5, 0.0);
    for (int k = 0; k < 16; k++) check_ok(sph_elastodynamics_step(s.scheme, 0.125, NULL));
    const double *now = sph_particles_field_const(s.set, SPH_FIELD_H);
    assert_true(rho[s.n / 2] > 1.02);
    for (int64_t i = 0; i < s.n && law == SPH_H_LAW_RATE; i++)
      check_rel(now[i] * now[i] * rho[i], 2.25, 1e-6);
    end[law - SPH_H_LAW_DENSITY] = now[s.n / 2];
    so_free(&s);
  }
  check_rel(end[0], end[1], 2e-3); /* that of the last stage, and that of the last step */
  sph_context_destroy(ctx);
}

static void test_spacing_law(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  solid s = so_block(ctx, 1, sides[1], 0.0);
  sph_elastodynamics_options o = so_options(1);
  o.h_law = SPH_H_LAW_SPACING;
  so_start(&s, &o);
  check_ok(sph_elastodynamics_step(s.scheme, 0.1, NULL));
  so_field(&s, SPH_FIELD_SPACING)[7] = 0.9;
  check_ok(sph_elastodynamics_step(s.scheme, 0.1, NULL));
  check_close(so_field(&s, SPH_FIELD_H)[7], 1.5, 0.0); /* nobody said so yet */
  check_ok(sph_particles_touch(s.set, SPH_FIELD_SPACING));
  check_ok(sph_elastodynamics_step(s.scheme, 0.1, NULL));
  check_close(so_field(&s, SPH_FIELD_H)[7], 1.35, 1e-15);
  check_close(so_field(&s, SPH_FIELD_H)[8], 1.5, 0.0);
  so_free(&s);
  sph_context_destroy(ctx);
}

/* ---- running ----------------------------------------------------------------------------- */

static void test_stable_dt(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  solid s = so_block(ctx, 1, sides[1], 0.0);
  sph_elastodynamics_options o = so_options(1);
  double dt = 0.0;
  o.spacing = 0.0;
  o.cfl = 0.8;
  o.wave_speed = 4.0;
  for (int64_t i = 0; i < s.n; i++) so_field(&s, SPH_FIELD_SPACING)[i] = i == 11 ? 0.5 : 1.0;
  so_start(&s, &o);
  check_ok(sph_elastodynamics_stable_dt(s.scheme, &dt));
  check_rel(dt, 0.8 * 0.5 / 4.0, 1e-14);
  so_field(&s, SPH_FIELD_V)[11] = -1.0;
  check_ok(sph_elastodynamics_stable_dt(s.scheme, &dt));
  check_rel(dt, 0.8 * 0.5 / 5.0, 1e-14);
  so_free(&s);
  sph_context_destroy(ctx);
}

typedef struct counter {
  int calls, answer_at, answer;
} counter;

static int32_t count_steps(void *user, sph_elastodynamics *scheme, const sph_step_info *info) {
  counter *c = user;
  assert_true(info->stages >= 2 && sph_elastodynamics_time(scheme) > 0.0);
  return ++c->calls == c->answer_at ? c->answer : 0;
}

static void test_run(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  solid s = so_block(ctx, 1, sides[1], 0.0);
  sph_elastodynamics_options o = so_options(1); /* dt = 1 */
  counter c = {0, 0, 0};
  so_start(&s, &o);
  check_ok(sph_elastodynamics_run(s.scheme, 3.3, count_steps, &c));
  assert_int_equal(c.calls, 4); /* 1, 1, 0.65, 0.65 */
  check_close(sph_elastodynamics_time(s.scheme), 3.3, 0.0);
  check_ok(sph_elastodynamics_run(s.scheme, 3.3, count_steps, &c));
  assert_int_equal(c.calls, 4);
  c = (counter){0, 2, 5};
  check_ok(sph_elastodynamics_run(s.scheme, 20.0, count_steps, &c));
  assert_int_equal(c.calls, 2);
  c = (counter){0, 1, -5};
  check_status(sph_elastodynamics_run(s.scheme, 20.0, count_steps, &c), SPH_ERR_CALLBACK);
  check_status(sph_elastodynamics_run(s.scheme, 1.0, NULL, NULL), SPH_ERR_ARG);
  check_status(sph_elastodynamics_run(s.scheme, NAN, NULL, NULL), SPH_ERR_ARG);
  so_free(&s);
  sph_context_destroy(ctx);
}

/* Asks for a smaller step `left` times. */
static int32_t hesitate(void *user, double t, sph_particles *set, const sph_rate *rates,
                        int32_t count) {
  int *left = user;
  (void)t;
  (void)set;
  (void)rates;
  (void)count;
  return *left > 0 ? (--*left, 1) : 0;
}

static void test_halving(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  solid s = so_block(ctx, 1, sides[1], 0.0);
  sph_elastodynamics_options o = so_options(1);
  counter c = {0, 1, 1};
  int left = 3;
  o.integrator = SPH_INTEGRATOR_RK4;
  so_start(&s, &o);
  check_ok(sph_elastodynamics_set_prepare(s.scheme, hesitate, &left));
  check_status(sph_elastodynamics_step(s.scheme, 1.0, NULL), SPH_RETRY);
  check_close(sph_elastodynamics_time(s.scheme), 0.0, 0.0);
  check_ok(sph_elastodynamics_run(s.scheme, 9.0, count_steps, &c));
  check_close(sph_elastodynamics_time(s.scheme), 0.25, 0.0);
  left = 1000;
  check_status(sph_elastodynamics_run(s.scheme, 9.0, NULL, NULL), SPH_RETRY);
  assert_int_equal(left, 1000 - 21);
  so_free(&s);
  sph_context_destroy(ctx);
}

/* The same bits with any number of threads, the frozen configuration and laws of h included. */
static void test_threads(void **state) {
  (void)state;
  enum { COUNT = 3 * 9 * 8 };
  double v[2][COUNT];
  for (int k = 0; k < 2; k++) {
    sph_context *ctx = rh_context(k == 0 ? 1 : 4);
    solid s = so_block(ctx, 2, sides[2], 0.1);
    sph_elastodynamics_options o = so_options(2);
    o.density = SPH_DENSITY_CONTINUITY;
    o.h_law = SPH_H_LAW_RATE;
    o.audit = 1;
    so_stir(&s, 0.05);
    so_start(&s, &o);
    check_ok(sph_elastodynamics_run(s.scheme, 5.0, NULL, NULL));
    memcpy(v[k], so_field(&s, SPH_FIELD_SIGMA), sizeof v[k]);
    so_free(&s);
    sph_context_destroy(ctx);
  }
  assert_memory_equal(v[0], v[1], sizeof v[0]);
}

/* Frozen: pairs of the start, so that a body that has flown away in one piece feels nothing. */
static void test_frozen(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  solid s = so_block(ctx, 2, sides[2], 0.1);
  sph_elastodynamics_options o = so_options(2);
  o.position_field = SPH_FIELD_X0;
  so_stir(&s, 1e-3);
  for (int64_t i = 0; i < s.n; i++) so_field(&s, SPH_FIELD_V)[2 * i] += 10.0;
  so_start(&s, &o);
  check_ok(sph_elastodynamics_run(s.scheme, 5.0, NULL, NULL));
  assert_int_equal(sph_neighbors_builds(sph_elastodynamics_list(s.scheme)), 1);
  assert_true(so_field(&s, SPH_FIELD_X)[0] > 49.0);
  for (int64_t i = 0; i < s.n; i++) check_close(so_field(&s, SPH_FIELD_V)[2 * i], 10.0, 2e-3);
  so_free(&s);
  sph_context_destroy(ctx);
}

/* ---- refusals ---------------------------------------------------------------------------- */

static void refused(sph_context *ctx, sph_status got, sph_status want, const char *words) {
  check_status(got, want);
  if (strstr(sph_context_last_error(ctx), words) == NULL)
    fail_msg("\"%s\" is not in \"%s\"", words, sph_context_last_error(ctx));
}

#define REFUSE(change, status, words)                                              \
  do {                                                                             \
    sph_elastodynamics_options o = so_options(2);                                  \
    sph_elastodynamics *none = (void *)&o;                                         \
    change;                                                                        \
    refused(ctx, sph_elastodynamics_create(ctx, s.set, &o, &none), status, words); \
    assert_null(none);                                                             \
  } while (0)

static void test_options(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  solid s = so_block(ctx, 2, sides[2], 0.0);
  const sph_status arg = SPH_ERR_ARG;
  REFUSE(o.dim = 3, arg, "dim 3");
  REFUSE(o.dim = 0, arg, "dim 0");
  REFUSE(o.kernel = 99, arg, "99");
  REFUSE(o.spacing = -1.0, arg, "spacing -1");
  REFUSE(o.spacing = INFINITY, arg, "spacing inf");
  REFUSE(o.h_ratio = 0.0, arg, "h_ratio 0");
  REFUSE(o.h_ratio = 0.4, arg, "spacing_ratio"); /* W(dp) would be 0 */
  REFUSE(o.h_law = 9, arg, "law of h 9");
  REFUSE(o.h_law = SPH_H_LAW_RATE, arg, "continuity");
  REFUSE(o.h_rule = 9, arg, "9");
  REFUSE(o.momentum = 0, arg, "form 0");
  REFUSE(o.momentum = 4, arg, "form 4");
  REFUSE(o.density = 0, arg, "density 0");
  REFUSE(o.alpha = NAN, arg, "alpha nan");
  REFUSE(o.beta = -2.0, arg, "beta -2");
  REFUSE(o.artificial_stress = -0.5, arg, "stress -0.5");
  REFUSE(o.artificial_power = 0, arg, "power 0");
  REFUSE(o.artificial_spacing = 0.0, arg, "spacing_ratio");
  REFUSE(o.artificial_spacing = NAN, arg, "spacing_ratio");
  REFUSE(o.xsph = -1.0, arg, "XSPH -1");
  REFUSE(o.body_force[0] = NAN, arg, "not finite");
  REFUSE(o.wave_speed = -1.0, arg, "wave_speed -1");
  REFUSE(o.integrator = 77, arg, "77");
  REFUSE(o.stage_rule = 77, arg, "77");
  REFUSE(o.stage_rule = SPH_STAGES_FIXED; o.stages = 1, arg, "stages = 1");
  REFUSE(o.cfl = 0.0, arg, "cfl 0");
  REFUSE(o.neighbors = 12, arg, "12");
  REFUSE(o.skin = -0.1, arg, "skin -0.1");
  REFUSE(o.periodic[0] = 1, arg, "");
  REFUSE(o.position_field = SPH_FIELD_V, arg, "position_field");
  REFUSE(o.integrator = SPH_INTEGRATOR_BUTCHER, SPH_ERR_UNSUPPORTED, "tableaux");
  REFUSE(o.stage_rule = SPH_STAGES_RADIUS, SPH_ERR_UNSUPPORTED, "radius");
  REFUSE(o.audit = 1; o.integrator = SPH_INTEGRATOR_LEAPFROG, SPH_ERR_UNSUPPORTED, "leapfrog");
  so_free(&s);
  sph_context_destroy(ctx);
}

static int32_t speed_of_density(void *user, const sph_material_block *b, double *c) {
  (void)user;
  (void)c;
  return b->rho ? 0 : -1;
}

/* A law that tells its speed from arrays needs `wave_speed`. */
static void test_material_speed(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  solid s = so_block(ctx, 2, sides[2], 0.0);
  sph_elastodynamics_options o = so_options(2);
  sph_material_functions law;
  sph_material *own = NULL;
  sph_material_functions_init(&law);
  law.sound_speed = speed_of_density;
  check_ok(sph_material_create(ctx, &law, NULL, &own));
  check_ok(sph_elastodynamics_create(ctx, s.set, &o, &s.scheme));
  check_status(sph_elastodynamics_set_material(s.scheme, 0, own), SPH_ERR_CALLBACK);
  check_status(sph_elastodynamics_set_material(s.scheme, -1, s.hooke), SPH_ERR_ARG);
  check_status(sph_elastodynamics_set_material(s.scheme, 256, s.hooke), SPH_ERR_ARG);
  sph_elastodynamics_destroy(s.scheme);
  o.wave_speed = 3.0;
  check_ok(sph_elastodynamics_create(ctx, s.set, &o, &s.scheme));
  check_ok(sph_elastodynamics_set_material(s.scheme, 0, own));
  sph_material_destroy(own);
  so_free(&s);
  sph_context_destroy(ctx);
}

static void test_start(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  solid s = so_block(ctx, 2, sides[2], 0.0);
  sph_elastodynamics_options o = so_options(2);
  sph_elastodynamics_ledger l;
  double dt;
  sph_elastodynamics_ledger_init(&l);
  check_ok(sph_elastodynamics_create(ctx, s.set, &o, &s.scheme));
  sph_elastodynamics *e = s.scheme;
  assert_true(isnan(sph_elastodynamics_time(e)));
  assert_null(sph_elastodynamics_list(e));
  assert_null(sph_elastodynamics_integrator(e));
  assert_non_null(sph_elastodynamics_rhs(e));
  assert_int_equal(sph_kernel_dim(sph_elastodynamics_kernel(e)), 2);
  refused(ctx, sph_elastodynamics_step(e, 0.1, NULL), SPH_ERR_STATE, "not started");
  refused(ctx, sph_elastodynamics_run(e, 0.1, NULL, NULL), SPH_ERR_STATE, "not started");
  refused(ctx, sph_elastodynamics_stable_dt(e, &dt), SPH_ERR_STATE, "not started");
  refused(ctx, sph_elastodynamics_balance(e, &l), SPH_ERR_STATE, "not started");
  refused(ctx, sph_elastodynamics_start(e, 0.0), SPH_ERR_STATE, "phase 0");
  check_ok(sph_elastodynamics_set_material(e, 0, s.hooke));
  refused(ctx, sph_elastodynamics_start(e, INFINITY), SPH_ERR_ARG, "inf");
  so_field(&s, SPH_FIELD_M)[3] = 0.0;
  refused(ctx, sph_elastodynamics_start(e, 0.0), SPH_ERR_NUMERIC, "mass of particle 3 is 0");
  so_field(&s, SPH_FIELD_M)[3] = 1.0;
  so_field(&s, SPH_FIELD_RHO)[5] = NAN;
  refused(ctx, sph_elastodynamics_start(e, 0.0), SPH_ERR_NUMERIC, "density of particle 5 is nan");
  so_field(&s, SPH_FIELD_RHO)[5] = 1.0;
  sph_particles_phases(s.set)[6] = 4;
  refused(ctx, sph_elastodynamics_start(e, 0.0), SPH_ERR_STATE, "phase 4 of particle 6");
  sph_particles_phases(s.set)[6] = -4;
  refused(ctx, sph_elastodynamics_start(e, 0.0), SPH_ERR_STATE, "phase -4");
  sph_particles_phases(s.set)[6] = 0;
  check_ok(sph_elastodynamics_start(e, 2.0));
  check_close(sph_elastodynamics_time(e), 2.0, 0.0);
  check_ok(sph_elastodynamics_step(e, 0.1, NULL));
  so_field(&s, SPH_FIELD_V)[8] = NAN;
  refused(ctx, sph_elastodynamics_step(e, 0.1, NULL), SPH_ERR_ARG, "position");
  check_close(sph_elastodynamics_time(e), 2.1, 1e-15);
  so_field(&s, SPH_FIELD_V)[8] = 0.0;
  double array[2] = {0.0, 0.0}; /* of the host: nobody gives its rates */
  check_ok(sph_elastodynamics_start(e, 0.0));
  check_ok(sph_integrator_bind_array(sph_elastodynamics_integrator(e), array, 2));
  check_status(sph_elastodynamics_step(e, 0.1, NULL), SPH_ERR_STATE);
  so_free(&s);
  sph_context_destroy(ctx);
}

static void test_empty(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  const int64_t none[1] = {0};
  solid s = so_block(ctx, 1, none, 0.0);
  sph_elastodynamics_options o = so_options(1);
  check_ok(sph_elastodynamics_create(ctx, s.set, &o, &s.scheme));
  refused(ctx, sph_elastodynamics_start(s.scheme, 0.0), SPH_ERR_STATE, "empty");
  so_free(&s);
  sph_context_destroy(ctx);
}

static sph_status scenario(sph_context *ctx, void *user) {
  sph_elastodynamics_options o = so_options(2);
  (void)user;
  oom_pause();
  solid s = so_block(ctx, 2, sides[2], 0.0);
  oom_resume();
  o.audit = 1;
  o.density = SPH_DENSITY_CONTINUITY;
  o.h_law = SPH_H_LAW_DENSITY;
  sph_status status = sph_elastodynamics_create(ctx, s.set, &o, &s.scheme);
  if (!status) status = sph_elastodynamics_set_material(s.scheme, 0, s.hooke);
  if (!status) status = sph_elastodynamics_start(s.scheme, 0.0);
  if (!status) status = sph_elastodynamics_step(s.scheme, 0.1, NULL);
  oom_pause();
  so_free(&s);
  oom_resume();
  return status;
}

static void test_memory(void **state) {
  (void)state;
  oom_sweep(scenario, NULL);
}

/* A steady step allocates nothing. */
static void test_steady(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  solid s = so_block(ctx, 2, sides[2], 0.1);
  sph_elastodynamics_options o = so_options(2);
  int64_t before, after;
  o.audit = 1;
  so_stir(&s, 0.01);
  so_start(&s, &o);
  check_ok(sph_elastodynamics_run(s.scheme, 2.0, NULL, NULL));
  check_ok(sph_context_memory(ctx, NULL, NULL, &before));
  check_ok(sph_elastodynamics_run(s.scheme, 4.0, NULL, NULL));
  check_ok(sph_context_memory(ctx, NULL, NULL, &after));
  assert_int_equal(before, after);
  so_free(&s);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_composition),
    cmocka_unit_test(test_waves),
    cmocka_unit_test(test_walls),
    cmocka_unit_test(test_body_force),
    cmocka_unit_test(test_surface_damping),
    cmocka_unit_test(test_h_laws),
    cmocka_unit_test(test_spacing_law),
    cmocka_unit_test(test_stable_dt),
    cmocka_unit_test(test_run),
    cmocka_unit_test(test_halving),
    cmocka_unit_test(test_threads),
    cmocka_unit_test(test_frozen),
    cmocka_unit_test(test_options),
    cmocka_unit_test(test_material_speed),
    cmocka_unit_test(test_start),
    cmocka_unit_test(test_empty),
    cmocka_unit_test(test_memory),
    cmocka_unit_test(test_steady),
};
SPH_TEST_MAIN(tests)
