/* The scheme for shocks when something is wrong: options, materials, starts, bad states, runs that
 * need smaller steps, failing memory; and the same bits for any number of threads. */
#include "../shocks_help.h"

#include "../oom.h"

/* ---- refusals ---------------------------------------------------------------------------- */

#define REFUSE(change, status, words)                                         \
  do {                                                                        \
    sph_shocks_options o = sk_options(2);                                     \
    sph_dissipation d;                                                        \
    sph_shocks *none = (void *)&o;                                            \
    sph_dissipation_init(&d);                                                 \
    change;                                                                   \
    sk_refused(ctx, sph_shocks_create(ctx, c.set, &o, &none), status, words); \
    assert_null(none);                                                        \
  } while (0)

static void test_options(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  cloud c = sk_cloud(ctx, 2, 4, SK_GAS);
  const sph_status arg = SPH_ERR_ARG, unsupported = SPH_ERR_UNSUPPORTED;
  REFUSE(o.dim = 3, arg, "dim 3");
  REFUSE(o.dim = 0, arg, "dim 0");
  REFUSE(o.kernel = 99, arg, "99");
  REFUSE(o.smoothing = 0, arg, "smoothing 0");
  REFUSE(o.smoothing = 4, arg, "smoothing 4");
  REFUSE(o.density = 3, arg, "density 3");
  REFUSE(o.eta = 0.0, arg, "eta 0");
  REFUSE(o.eta = NAN, arg, "eta nan");
  REFUSE(o.omega_floor = -0.1, arg, "omega_floor -0.1");
  REFUSE(o.cfl = 0.0, arg, "cfl 0");
  REFUSE(o.cfl = INFINITY, arg, "cfl inf");
  REFUSE(o.density_limit = 0.0, arg, "density_limit 0");
  REFUSE(o.density_limit = NAN, arg, "density_limit nan");
  REFUSE(o.skin = -1.0, arg, "skin -1");
  REFUSE(o.neighbors = 12, arg, "12");
  REFUSE(o.max_pairs = -1, arg, "max_pairs");
  REFUSE(o.periodic[1] = 1, arg, "");
  REFUSE(o.integrator = 77, arg, "77");
  REFUSE(o.body_force[1] = NAN, arg, "not finite");
  REFUSE(o.dissipation = &d; d.viscosity = -1.0, arg, "viscosity");
  REFUSE(o.dissipation = &d; d.size = 2, arg, "");
  REFUSE(o.density = SPH_SHOCKS_INTEGRAL; o.dissipation = &d, arg, "mass flux, not 0.5");
  REFUSE(o.density = SPH_SHOCKS_INTEGRAL; o.adaptive = 0, arg, "adaptive");
  REFUSE(o.density = SPH_SHOCKS_INTEGRAL; o.smoothing = SPH_SMOOTHING_VOLUME, unsupported, "sum");
  REFUSE(o.integrator = SPH_INTEGRATOR_BUTCHER, unsupported, "tableaux");
  REFUSE(o.integrator = SPH_INTEGRATOR_RKC, unsupported, "RKC");
  REFUSE(o.integrator = SPH_INTEGRATOR_LEAPFROG, unsupported, "leapfrog");
  sk_free(&c);
  sph_context_destroy(ctx);
}

static int32_t one_law(void *user, const sph_material_block *b, double *out) {
  (void)user;
  for (int64_t i = 0; i < b->n; i++) out[i] = 1.0;
  return 0;
}

static void test_materials(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  cloud c = sk_cloud(ctx, 2, 4, SK_GAS);
  sph_shocks_options o = sk_options(2);
  sph_material_functions law;
  sph_material *own = NULL;
  check_ok(sk_create(&c, &o));
  sph_material_functions_init(&law);
  law.sound_speed = one_law;
  check_ok(sph_material_create(ctx, &law, NULL, &own));
  sk_refused(ctx, sph_shocks_set_material(c.scheme, 0, own), SPH_ERR_UNSUPPORTED, "pressure");
  sph_material_destroy(own);
  law.sound_speed = NULL;
  law.pressure = one_law;
  check_ok(sph_material_create(ctx, &law, NULL, &own));
  sk_refused(ctx, sph_shocks_set_material(c.scheme, 0, own), SPH_ERR_UNSUPPORTED, "sound_speed");
  sph_material_destroy(own);
  check_status(sph_shocks_set_material(c.scheme, -1, c.gas), SPH_ERR_ARG);
  check_status(sph_shocks_set_material(c.scheme, 256, c.gas), SPH_ERR_ARG);
  check_ok(sph_shocks_start(c.scheme, 0.0)); /* what was set before is still there */
  sk_free(&c);
  sph_context_destroy(ctx);
}

static void test_start(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  cloud c = sk_cloud(ctx, 2, 4, SK_GAS);
  sph_shocks_options o = sk_options(2);
  sph_shocks_ledger l;
  double dt, buffer[4];
  size_t bytes;
  sph_shocks_ledger_init(&l);
  check_ok(sph_shocks_create(ctx, c.set, &o, &c.scheme));
  sph_shocks *s = c.scheme;
  assert_true(isnan(sph_shocks_time(s)));
  assert_null(sph_shocks_list(s));
  assert_null(sph_shocks_integrator(s));
  assert_non_null(sph_shocks_rhs(s));
  assert_int_equal(sph_kernel_dim(sph_shocks_kernel(s)), 2);
  sk_refused(ctx, sph_shocks_step(s, 0.1, NULL), SPH_ERR_STATE, "not started");
  sk_refused(ctx, sph_shocks_run(s, 0.1, NULL, NULL), SPH_ERR_STATE, "not started");
  sk_refused(ctx, sph_shocks_update(s), SPH_ERR_STATE, "not started");
  sk_refused(ctx, sph_shocks_stable_dt(s, &dt), SPH_ERR_STATE, "not started");
  sk_refused(ctx, sph_shocks_balance(s, &l), SPH_ERR_STATE, "not started");
  sk_refused(ctx, sph_shocks_state_size(s, &bytes), SPH_ERR_STATE, "not started");
  sk_refused(ctx, sph_shocks_save(s, buffer, sizeof buffer), SPH_ERR_STATE, "not started");
  sk_refused(ctx, sph_shocks_start(s, 0.0), SPH_ERR_STATE, "phase 0");
  check_ok(sph_shocks_set_material(s, 0, c.gas));
  sk_refused(ctx, sph_shocks_start(s, INFINITY), SPH_ERR_ARG, "inf");
  sk_field(&c, SPH_FIELD_M)[3] = 0.0;
  sk_refused(ctx, sph_shocks_start(s, 0.0), SPH_ERR_NUMERIC, "mass of particle 3 is 0");
  sk_field(&c, SPH_FIELD_M)[3] = 1.0;
  sk_field(&c, SPH_FIELD_RHO)[5] = NAN;
  sk_refused(ctx, sph_shocks_start(s, 0.0), SPH_ERR_NUMERIC, "density of particle 5 is nan");
  sk_field(&c, SPH_FIELD_RHO)[5] = 1.0;
  sk_field(&c, SPH_FIELD_E)[7] = -1.0;
  sk_refused(ctx, sph_shocks_start(s, 0.0), SPH_ERR_NUMERIC, "particle 7");
  sk_field(&c, SPH_FIELD_E)[7] = 1.0;
  sph_particles_phases(c.set)[6] = 4;
  sk_refused(ctx, sph_shocks_start(s, 0.0), SPH_ERR_STATE, "phase 4 of particle 6");
  sph_particles_phases(c.set)[6] = -4;
  sk_refused(ctx, sph_shocks_start(s, 0.0), SPH_ERR_STATE, "phase -4");
  sph_particles_phases(c.set)[6] = 0;
  check_ok(sph_shocks_start(s, 2.0));
  check_close(sph_shocks_time(s), 2.0, 0.0);
  check_ok(sph_shocks_step(s, 0.01, NULL));
  check_status(sph_shocks_run(s, 1.0, NULL, NULL), SPH_ERR_ARG);
  check_status(sph_shocks_run(s, NAN, NULL, NULL), SPH_ERR_ARG);
  double array[2] = {0.0, 0.0}; /* of the host: nobody gives its rates */
  check_ok(sph_integrator_bind_array(sph_shocks_integrator(s), array, 2));
  check_status(sph_shocks_step(s, 0.01, NULL), SPH_ERR_STATE);
  sk_free(&c);
  sph_context_destroy(ctx);
}

static void test_empty(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  cloud c = sk_cloud(ctx, 2, 0, SK_GAS);
  sph_shocks_options o = sk_options(2);
  check_ok(sk_create(&c, &o));
  sk_refused(ctx, sph_shocks_start(c.scheme, 0.0), SPH_ERR_STATE, "empty");
  sk_free(&c);
  sph_context_destroy(ctx);
}

/* ---- bad states -------------------------------------------------------------------------- */

static uint64_t bits_of(const cloud *c) {
  static const int32_t fields[] = {SPH_FIELD_X, SPH_FIELD_V, SPH_FIELD_E, SPH_FIELD_RHO};
  uint64_t sum = 1;
  for (int k = 0; k < 4; k++) {
    const unsigned char *p = (const unsigned char *)sk_field(c, fields[k]);
    const size_t bytes = (size_t)(c->n * sph_particles_components(c->set, fields[k])) * 8;
    for (size_t b = 0; b < bytes; b++) sum = (sum ^ p[b]) * UINT64_C(1099511628211);
  }
  return sum;
}

/* Particles that fly apart so fast that a long step would empty them. */
static void test_bad_states(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++) {
    cloud c = sk_cloud(ctx, dim, sk_side(dim), SK_GAS);
    sph_shocks_options o = sk_options(dim);
    double *x = sk_field(&c, SPH_FIELD_X), *v = sk_field(&c, SPH_FIELD_V);
    for (int64_t k = 0; k < c.n * dim; k++) v[k] = 2.0 * x[k];
    sk_start(&c, &o);
    const uint64_t before = bits_of(&c);
    sk_refused(ctx, sph_shocks_step(c.scheme, 4.0, NULL), SPH_ERR_NUMERIC, "density -");
    assert_non_null(strstr(sph_context_last_error(ctx), "in step 1"));
    assert_true(bits_of(&c) == before);
    assert_int_equal(sk_ledger(&c).steps, 0);
    check_close(sph_shocks_time(c.scheme), 0.0, 0.0);
    sk_steps(&c, 1, 0.01); /* goes on as if nothing had been */
    sk_free(&c);
  }
  sph_context_destroy(ctx);
}

/* With stable steps as long as that a run halves, counts, and arrives. */
static void test_halving(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  cloud c = sk_cloud(ctx, 1, 40, SK_GAS);
  sph_shocks_options o = sk_options(1);
  o.cfl = 40.0;
  o.density_limit = INFINITY;
  o.integrator = SPH_INTEGRATOR_HEUN;
  for (int64_t i = 0; i < c.n; i++)
    sk_field(&c, SPH_FIELD_V)[i] = 2.0 * sk_field(&c, SPH_FIELD_X)[i];
  sk_start(&c, &o);
  sk_ok(&c, sph_shocks_run(c.scheme, 1.0, NULL, NULL));
  check_close(sph_shocks_time(c.scheme), 1.0, 0.0);
  assert_true(sk_ledger(&c).retries > 0);
  sk_free(&c);
  sph_context_destroy(ctx);
}

static int32_t never(void *user, double t, sph_particles *set, const sph_rate *rates,
                     int32_t count) {
  (void)t, (void)set, (void)rates, (void)count;
  return *(int32_t *)user;
}

static int32_t stop_at(void *user, sph_shocks *scheme, const sph_step_info *info) {
  int32_t *left = user;
  assert_true(info->evaluations > 0 && sph_shocks_time(scheme) > 0.0);
  return *left > 0 ? (--*left, 0) : *left < 0 ? -1 : 1;
}

/* What hooks answer. */
static void test_answers(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  cloud c = sk_cloud(ctx, 2, 6, SK_GAS);
  sph_shocks_options o = sk_options(2);
  int32_t answer = 1, left = 3;
  sk_start(&c, &o);
  check_ok(sph_shocks_set_prepare(c.scheme, never, &answer));
  check_status(sph_shocks_step(c.scheme, 0.01, NULL), SPH_RETRY);
  answer = -3;
  sk_refused(ctx, sph_shocks_step(c.scheme, 0.01, NULL), SPH_ERR_CALLBACK, "-3");
  sk_refused(ctx, sph_shocks_update(c.scheme), SPH_ERR_CALLBACK, "prepare");
  check_ok(sph_shocks_set_prepare(c.scheme, NULL, NULL));
  check_ok(sph_shocks_set_finish(c.scheme, never, &answer));
  check_status(sph_shocks_run(c.scheme, 0.01, NULL, NULL), SPH_ERR_CALLBACK);
  check_ok(sph_shocks_set_finish(c.scheme, NULL, NULL));
  check_ok(sph_shocks_run(c.scheme, 10.0, stop_at, &left)); /* the fourth step ends it */
  assert_int_equal(sk_ledger(&c).steps, 4);
  left = -1;
  sk_refused(ctx, sph_shocks_run(c.scheme, 10.0, stop_at, &left), SPH_ERR_CALLBACK, "host");
  sk_free(&c);
  sph_context_destroy(ctx);
}

/* One particle alone by summation: there is no h, which is an error, or counted. */
static void test_unsolved(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t keep = 0; keep <= 1; keep++) {
    cloud c = sk_cloud(ctx, 2, 1, SK_GAS);
    sph_shocks_options o = sk_options(2);
    o.density = SPH_SHOCKS_INTEGRAL;
    o.keep_unsolved = keep;
    check_ok(sk_create(&c, &o));
    if (keep)
      check_ok(sph_shocks_start(c.scheme, 0.0));
    else
      sk_refused(ctx, sph_shocks_start(c.scheme, 0.0), SPH_ERR_NUMERIC, "particle 0");
    if (keep) {
      sk_steps(&c, 1, 0.01);
      check_ok(sph_shocks_update(c.scheme));
      assert_true(sk_ledger(&c).unsolved > 0);
    }
    sk_free(&c);
  }
  sph_context_destroy(ctx);
}

/* ---- threads and memory ------------------------------------------------------------------ */

static void test_threads(void **state) {
  (void)state;
  sph_context *ctx[2] = {rh_context(1), rh_context(4)};
  for (int32_t density = SPH_SHOCKS_DIFFERENTIAL; density <= SPH_SHOCKS_INTEGRAL; density++) {
    cloud c[2];
    sph_shocks_ledger l[2];
    sph_shocks_options o = sk_options(2);
    o.density = density;
    for (int k = 0; k < 2; k++) {
      c[k] = sk_cloud(ctx[k], 2, 80, SK_HARDENING);
      sk_start(&c[k], &o);
      for (int n = 0; n < 3; n++) {
        double dt;
        check_ok(sph_shocks_stable_dt(c[k].scheme, &dt));
        sk_steps(&c[k], 1, dt);
      }
      l[k] = sk_ledger(&c[k]);
    }
    assert_true(bits_of(&c[0]) == bits_of(&c[1]));
    assert_memory_equal(&l[0], &l[1], sizeof l[0]);
    for (int k = 0; k < 2; k++) sk_free(&c[k]);
  }
  for (int k = 0; k < 2; k++) sph_context_destroy(ctx[k]);
}

typedef struct scene {
  int32_t density;
  char *buffer;
} scene;

static sph_status play(cloud *c, const scene *of) {
  sph_shocks_options o = sk_options(2);
  size_t bytes = 0;
  double dt;
  o.density = of->density;
  sph_status s = sk_create(c, &o);
  if (!s) s = sph_shocks_start(c->scheme, 0.0);
  if (!s) s = sph_shocks_stable_dt(c->scheme, &dt);
  if (!s) s = sph_shocks_step(c->scheme, 0.01, NULL);
  if (!s) s = sph_shocks_update(c->scheme);
  if (!s) s = sph_shocks_state_size(c->scheme, &bytes);
  if (!s) s = sph_shocks_save(c->scheme, of->buffer, bytes);
  return s ? s : sph_shocks_restore(c->scheme, of->buffer, bytes);
}

static sph_status scenario(sph_context *ctx, void *user) {
  oom_pause();
  cloud c = sk_cloud(ctx, 2, 5, SK_HARDENING);
  oom_resume();
  sph_status s = play(&c, user);
  oom_pause();
  sk_free(&c);
  oom_resume();
  return s;
}

static void test_memory(void **state) {
  (void)state;
  scene two = {SPH_SHOCKS_DIFFERENTIAL, calloc(1, 1 << 20)};
  oom_sweep(scenario, &two);
  two.density = SPH_SHOCKS_INTEGRAL;
  oom_sweep(scenario, &two);
  free(two.buffer);
}

/* A steady step allocates nothing. */
static void test_steady(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  cloud c = sk_cloud(ctx, 3, 6, SK_HARDENING);
  sph_shocks_options o = sk_options(3);
  int64_t before, after;
  double dt;
  sk_start(&c, &o);
  sk_steps(&c, 2, 1e-4);
  check_ok(sph_shocks_stable_dt(c.scheme, &dt));
  check_ok(sph_context_memory(ctx, NULL, NULL, &before));
  sk_steps(&c, 5, 1e-4);
  check_ok(sph_context_memory(ctx, NULL, NULL, &after));
  assert_int_equal(before, after);
  sk_free(&c);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_options),    cmocka_unit_test(test_materials),
    cmocka_unit_test(test_start),      cmocka_unit_test(test_empty),
    cmocka_unit_test(test_bad_states), cmocka_unit_test(test_halving),
    cmocka_unit_test(test_answers),    cmocka_unit_test(test_unsolved),
    cmocka_unit_test(test_threads),    cmocka_unit_test(test_memory),
    cmocka_unit_test(test_steady),
};
SPH_TEST_MAIN(tests)
