/* Balances of the scheme for shocks, and what boundaries do to them: pairs keep momentum and energy
 * to rounding, steps to their order; walls hold, drive and are charged; mirrors mirror. */
#include "../shocks_help.h"

/* ---- nothing but pairs ------------------------------------------------------------------- */

/* After 50 steps of unequal particles, with and without strength. */
static void check_kept(cloud *c, const sph_shocks_options *o) {
  const int32_t dim = c->dim;
  sk_start(c, o);
  const sph_shocks_ledger start = sk_ledger(c);
  assert_true(start.energy_error == 0.0 && start.momentum_error == 0.0);
  sk_steps(c, 50, 0.005);
  const sph_shocks_ledger l = sk_ledger(c);
  assert_int_equal(l.steps, 50);
  check_close(l.mass, start.mass, 0.0);
  check_close(l.total, l.kinetic + l.internal, 1e-13 * l.total);
  for (int a = 0; a < 3; a++) {
    check_close(l.momentum[a], start.momentum[a], 1e-11);
    check_close(l.impulse_form[a], 0.0, 1e-11);
  }
  check_close(l.form, 0.0, 1e-12 * start.total);
  check_close(l.total, start.total, 2e-4 * start.total);
  check_close(l.energy_error, l.total - start.total, 1e-11 * start.total);
  if (c->kind == SK_GAS && dim > 1) /* the deviator's forces are not central */
    for (int a = dim == 2 ? 2 : 0; a < 3; a++)
      check_close(l.angular_momentum[a], start.angular_momentum[a], 2e-3);
  assert_true(fabs(l.kinetic - start.kinetic) > 1e-3 * start.kinetic); /* something happened */
}

static void test_kept(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int32_t smoothing = SPH_SMOOTHING_MASS; smoothing <= SPH_SMOOTHING_NUMBER; smoothing++)
      for (int k = 0; k < 4; k++) {
        cloud c = sk_cloud(ctx, dim, sk_side(dim), k & 1 ? SK_SOLID : SK_GAS);
        sph_shocks_options o = sk_options(dim);
        o.smoothing = smoothing;
        o.density = k & 2 ? SPH_SHOCKS_INTEGRAL : SPH_SHOCKS_DIFFERENTIAL;
        if (o.density == SPH_SHOCKS_DIFFERENTIAL || smoothing != SPH_SMOOTHING_VOLUME)
          check_kept(&c, &o);
        sk_free(&c);
      }
  sph_context_destroy(ctx);
}

/* The error of the steps falls with their square. */
static double error_of(sph_context *ctx, int steps, int32_t method) {
  cloud c = sk_cloud(ctx, 2, 10, SK_GAS);
  sph_shocks_options o = sk_options(2);
  sph_dissipation smooth;
  sph_dissipation_init(&smooth);
  smooth.viscosity = smooth.conductivity = smooth.mass_flux = 0.0; /* they have kinks */
  o.dissipation = &smooth;
  o.integrator = method;
  o.omega_floor = 0.0;
  sk_start(&c, &o);
  sk_steps(&c, steps, 0.1 / steps);
  const double error = fabs(sk_ledger(&c).energy_error);
  sk_free(&c);
  return error;
}

static void test_order(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  const double coarse = error_of(ctx, 20, SPH_INTEGRATOR_LEAPFROG_PREDICTED);
  const double fine = error_of(ctx, 40, SPH_INTEGRATOR_LEAPFROG_PREDICTED);
  assert_true(coarse > 1e-9 && coarse / fine > 3.0);
  assert_true(error_of(ctx, 40, SPH_INTEGRATOR_RK4) < 1e-3 * fine);
  sph_context_destroy(ctx);
}

/* ---- forces and hooks -------------------------------------------------------------------- */

typedef struct push {
  int prepared, finished;
  const cloud *c;
} push;

/* Laws and lengths are those of the state. */
static int32_t prepare(void *user, double t, sph_particles *set, const sph_rate *rates,
                       int32_t count) {
  push *p = user;
  const cloud *c = p->c;
  (void)t, (void)rates, (void)count;
  p->prepared++;
  for (int64_t i = 0; i < sph_particles_real_count(set); i++) {
    const double rho = sk_field(c, SPH_FIELD_RHO)[i], e = sk_field(c, SPH_FIELD_E)[i];
    check_rel(sk_field(c, SPH_FIELD_P)[i], 0.4 * rho * e, 1e-14);
    check_rel(sk_field(c, SPH_FIELD_C)[i], sqrt(1.4 * 0.4 * e), 1e-14);
    check_rel(sk_field(c, SPH_FIELD_H)[i],
              1.2 * pow(sk_field(c, SPH_FIELD_M)[i] / rho, 1.0 / c->dim), 1e-14);
  }
  return 0;
}

static int32_t finish(void *user, double t, sph_particles *set, const sph_rate *rates,
                      int32_t count) {
  (void)t, (void)set;
  ((push *)user)->finished++;
  for (int32_t k = 0; k < count; k++) {
    if (rates[k].field == SPH_FIELD_V) rates[k].values[3] += 0.7;
    if (rates[k].field == SPH_FIELD_E) rates[k].values[5] += 0.3;
  }
  return 0;
}

static void test_hooks(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++) {
    cloud c = sk_cloud(ctx, dim, sk_side(dim), SK_GAS);
    sph_shocks_options o = sk_options(dim);
    push p = {0, 0, &c};
    const double *m = sk_field(&c, SPH_FIELD_M);
    o.body_force[dim - 1] = -0.4;
    o.integrator = SPH_INTEGRATOR_RK4;
    check_ok(sk_create(&c, &o));
    check_ok(sph_shocks_set_prepare(c.scheme, prepare, &p));
    check_ok(sph_shocks_set_finish(c.scheme, finish, &p));
    sk_ok(&c, sph_shocks_start(c.scheme, 0.0));
    const sph_shocks_ledger start = sk_ledger(&c);
    sk_steps(&c, 10, 0.01);
    const sph_shocks_ledger l = sk_ledger(&c);
    assert_int_equal(p.prepared, 41);
    assert_true(p.finished >= 41);
    check_rel(l.impulse_body[dim - 1], -0.4 * 0.1 * l.mass, 1e-12);
    /* the third particle's velocity, or its components */
    check_rel(l.impulse_hooks[3 % dim], 0.7 * 0.1 * m[3 / dim], 1e-12);
    assert_true(l.hooks > 0.3 * 0.1 * m[5] - 0.05 && l.body != 0.0 && l.walls == 0.0);
    check_close(l.energy_error, 0.0, 1e-8 * start.total);
    check_close(l.momentum_error, 0.0, 1e-11);
    sk_free(&c);
  }
  sph_context_destroy(ctx);
}

/* ---- walls ------------------------------------------------------------------------------- */

/* The first particles are a piston: they move on as they are, and the ledger tells their work. */
static void test_walls(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  cloud c = sk_cloud(ctx, 1, 60, SK_GAS);
  sph_shocks_options o = sk_options(1);
  o.integrator = SPH_INTEGRATOR_RK4; /* so that what is left is the ledger's own */
  double *x = sk_field(&c, SPH_FIELD_X), *v = sk_field(&c, SPH_FIELD_V);
  for (int64_t i = 0; i < c.n; i++) {
    v[i] = i < 6 ? 0.5 : 0.0;
    if (i < 6 || i >= 54) sph_particles_roles(c.set)[i] = SPH_ROLE_WALL;
  }
  const double begin = x[0], rho = sk_field(&c, SPH_FIELD_RHO)[2];
  const double e = sk_field(&c, SPH_FIELD_E)[2];
  sk_start(&c, &o);
  const sph_shocks_ledger start = sk_ledger(&c);
  sk_ok(&c, sph_shocks_run(c.scheme, 4.0, NULL, NULL));
  const sph_shocks_ledger l = sk_ledger(&c);
  check_close(x[0], begin + 2.0, 1e-12);
  for (int i = 0; i < 6; i++) check_close(v[i], 0.5, 0.0);
  for (int i = 54; i < 60; i++) check_close(v[i], 0.0, 0.0);
  check_close(sk_field(&c, SPH_FIELD_RHO)[2], rho, 0.0);
  check_close(sk_field(&c, SPH_FIELD_E)[2], e, 0.0);
  assert_true(l.walls > 0.1 && l.total > start.total + 0.1); /* the piston did work */
  check_close(l.energy_error, 0.0, 1e-5 * l.walls);
  check_close(l.momentum_error, 0.0, 1e-10);
  check_close(l.impulse_walls[0], l.momentum[0] - start.momentum[0], 1e-10);
  sk_free(&c);
  sph_context_destroy(ctx);
}

/* A body in front of a mirror is half of one without. */
static sph_ghosts *mirror(sph_context *ctx, int32_t dim, double at) {
  sph_ghosts_options o;
  sph_wall wall;
  sph_ghosts *ghosts = NULL;
  sph_ghosts_options_init(&o);
  o.dim = dim;
  o.support = 3.0;
  check_ok(sph_ghosts_create(ctx, &o, &ghosts));
  sph_wall_init(&wall);
  wall.kind = SPH_WALL_SLIP;
  wall.point[0] = at;
  wall.normal[0] = 1.0;
  check_ok(sph_ghosts_add_wall(ghosts, &wall, NULL));
  return ghosts;
}

/* The second half of the particles mirrors the first one about x = 0. */
static void make_symmetric(cloud *c) {
  static const int32_t fields[] = {SPH_FIELD_X, SPH_FIELD_V, SPH_FIELD_M, SPH_FIELD_RHO,
                                   SPH_FIELD_E};
  const int64_t half = c->n / 2;
  for (int k = 0; k < 5; k++) {
    double *f = sk_field(c, fields[k]);
    const int32_t components = sph_particles_components(c->set, fields[k]);
    for (int64_t i = 0; i < half * components; i++)
      f[half * components + i] = (k < 2 && i % components == 0 ? -1.0 : 1.0) * f[i];
  }
  for (int64_t i = 0; i < half; i++)
    sph_particles_phases(c->set)[half + i] = sph_particles_phases(c->set)[i];
  check_ok(sph_particles_touch(c->set, SPH_FIELD_X));
}

static void check_mirror(sph_context *ctx, int32_t dim, int32_t density, int32_t kind) {
  cloud whole = sk_cloud(ctx, dim, sk_side(dim), kind),
        half = sk_cloud(ctx, dim, sk_side(dim), kind);
  sph_shocks_options o = sk_options(dim);
  int64_t rest[1024];
  o.density = density;
  make_symmetric(&whole);
  for (int64_t i = 0; i < half.n / 2; i++) rest[i] = half.n / 2 + i;
  check_ok(sph_particles_remove(half.set, half.n / 2, rest));
  half.n /= 2;
  sph_ghosts *ghosts = mirror(ctx, dim, 0.0);
  sk_ok(&half, sk_create(&half, &o));
  check_ok(sph_shocks_set_ghosts(half.scheme, ghosts));
  sk_ok(&half, sph_shocks_start(half.scheme, 0.0));
  sk_start(&whole, &o);
  for (int k = 0; k < 5; k++) {
    double dt[2];
    check_ok(sph_shocks_stable_dt(whole.scheme, &dt[0]));
    sk_ok(&half, sph_shocks_stable_dt(half.scheme, &dt[1]));
    check_rel(dt[1], dt[0], 1e-9);
    sk_steps(&whole, 1, dt[0]);
    sk_steps(&half, 1, dt[0]);
  }
  assert_true(sph_ghosts_count(ghosts) > 0);
  for (int64_t k = 0; k < half.n * dim; k++)
    check_close(sk_field(&half, SPH_FIELD_V)[k], sk_field(&whole, SPH_FIELD_V)[k], 1e-9);
  for (int64_t i = 0; i < half.n; i++) {
    check_close(sk_field(&half, SPH_FIELD_E)[i], sk_field(&whole, SPH_FIELD_E)[i], 1e-9);
    check_close(sk_field(&half, SPH_FIELD_RHO)[i], sk_field(&whole, SPH_FIELD_RHO)[i], 1e-9);
  }
  const sph_shocks_ledger l = sk_ledger(&half); /* a mirror at rest leaves energy alone */
  check_close(l.form, 0.0, 1e-11 * l.total);
  assert_true(fabs(l.impulse_form[0]) > 1e-3);
  sk_free(&whole);
  sk_free(&half);
  sph_ghosts_destroy(ghosts);
}

static void test_mirror(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int32_t density = SPH_SHOCKS_DIFFERENTIAL; density <= SPH_SHOCKS_INTEGRAL; density++) {
      check_mirror(ctx, dim, density, SK_GAS);
      check_mirror(ctx, dim, density, SK_SOLID);
    }
  sph_context_destroy(ctx);
}

/* ---- a box that wraps -------------------------------------------------------------------- */

/* A uniform gas in a periodic box stays as it is; h is kept where the host says so. */
static void test_periodic(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t adaptive = 0; adaptive <= 1; adaptive++) {
    cloud c = sk_cloud(ctx, 2, 10, SK_GAS);
    sph_shocks_options o = sk_options(2);
    o.adaptive = adaptive;
    for (int a = 0; a < 2; a++) {
      o.periodic[a] = 1;
      o.box_hi[a] = 10.0;
    }
    double *x = sk_field(&c, SPH_FIELD_X), *h = sk_field(&c, SPH_FIELD_H);
    for (int64_t i = 0; i < c.n; i++) {
      for (int a = 0; a < 2; a++) x[2 * i + a] = (double)(a ? i / 10 : i % 10) + 0.5;
      sk_field(&c, SPH_FIELD_M)[i] = sk_field(&c, SPH_FIELD_RHO)[i] = 1.0;
      sk_field(&c, SPH_FIELD_E)[i] = 1.0;
      sk_field(&c, SPH_FIELD_V)[2 * i] = 0.25;
      sk_field(&c, SPH_FIELD_V)[2 * i + 1] = 0.0;
      h[i] = i % 2 ? 1.3 : 0.0; /* given, or to be made */
    }
    check_ok(sph_particles_touch(c.set, SPH_FIELD_X));
    sk_start(&c, &o);
    for (int64_t i = 0; i < c.n; i++) check_close(h[i], i % 2 && !adaptive ? 1.3 : 1.2, 1e-15);
    if (!adaptive) check_close(sk_field(&c, SPH_FIELD_OMEGA)[7], 1.0, 0.0);
    sk_steps(&c, 20, 0.1);
    if (adaptive)
      for (int64_t i = 0; i < c.n; i++) {
        check_close(sk_field(&c, SPH_FIELD_V)[2 * i], 0.25, 1e-13);
        check_close(sk_field(&c, SPH_FIELD_RHO)[i], 1.0, 1e-13);
      }
    sk_free(&c);
  }
  sph_context_destroy(ctx);
}

/* Without audit the integrals are not there, the sums are. */
static void test_no_audit(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  cloud c = sk_cloud(ctx, 2, 10, SK_GAS);
  sph_shocks_options o = sk_options(2);
  o.audit = 0;
  o.integrator = SPH_INTEGRATOR_LEAPFROG;
  sk_start(&c, &o);
  sk_steps(&c, 3, 0.01);
  const sph_shocks_ledger l = sk_ledger(&c);
  assert_true(isnan(l.form) && isnan(l.walls) && isnan(l.hooks) && isnan(l.energy_error));
  assert_true(l.total > 0.0 && isfinite(l.momentum[1]));
  sk_free(&c);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_kept),     cmocka_unit_test(test_order),  cmocka_unit_test(test_hooks),
    cmocka_unit_test(test_walls),    cmocka_unit_test(test_mirror), cmocka_unit_test(test_periodic),
    cmocka_unit_test(test_no_audit),
};
SPH_TEST_MAIN(tests)
