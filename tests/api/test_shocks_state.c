/* Checkpoints: a run that is taken up in another context, by another scheme on another set, goes on
 * bit for bit; what is damaged or of another run is refused. */
#include "../shocks_help.h"

#include "../oom.h"

static void same(const cloud *a, const cloud *b, int32_t field) {
  const size_t bytes = (size_t)(a->n * sph_particles_components(a->set, field)) * sizeof(double);
  assert_memory_equal(sk_field(a, field), sk_field(b, field), bytes);
}

static void same_state(const cloud *a, const cloud *b) {
  static const int32_t fields[] = {SPH_FIELD_X,   SPH_FIELD_V, SPH_FIELD_E,
                                   SPH_FIELD_RHO, SPH_FIELD_M, SPH_FIELD_H};
  for (int k = 0; k < 6; k++) same(a, b, fields[k]);
  if (a->kind == SK_GAS) return;
  same(a, b, SPH_FIELD_SIGMA);
  same(a, b, sph_particles_find_field(a->set, "plastic_strain"));
}

/* Another set with other numbers in it, but the same roles and phases. */
static cloud other_cloud(sph_context *ctx, int32_t dim, int32_t kind) {
  cloud c = sk_cloud(ctx, dim, sk_side(dim), kind);
  for (int64_t i = 0; i < c.n; i++) {
    sk_field(&c, SPH_FIELD_X)[i * dim] += 100.0;
    sk_field(&c, SPH_FIELD_M)[i] = sk_field(&c, SPH_FIELD_RHO)[i] = 5.0;
  }
  return c;
}

static void go_on(cloud *c, int steps) {
  for (int k = 0; k < steps; k++) {
    double dt;
    sk_ok(c, sph_shocks_stable_dt(c->scheme, &dt));
    sk_steps(c, 1, dt);
  }
}

static void *save(const cloud *c, size_t *bytes) {
  check_ok(sph_shocks_state_size(c->scheme, bytes));
  void *buffer = malloc(*bytes);
  assert_non_null(buffer);
  check_ok(sph_shocks_save(c->scheme, buffer, *bytes));
  return buffer;
}

static void check_restart(int32_t dim, const sph_shocks_options *o, int32_t kind) {
  sph_context *first = rh_context(1), *second = rh_context(2);
  cloud a = sk_cloud(first, dim, sk_side(dim), kind), b = other_cloud(second, dim, kind);
  size_t bytes;
  sk_start(&a, o);
  go_on(&a, 5);
  if (o->density == SPH_SHOCKS_INTEGRAL && dim == 2)
    check_ok(sph_shocks_update(a.scheme)); /* lengths that are solved for stay */
  void *buffer = save(&a, &bytes);
  go_on(&a, 5);
  sk_ok(&b, sk_create(&b, o));
  sk_ok(&b, sph_shocks_restore(b.scheme, buffer, bytes));
  go_on(&b, 5);
  same_state(&a, &b);
  const sph_shocks_ledger la = sk_ledger(&a), lb = sk_ledger(&b);
  assert_memory_equal(&la, &lb, sizeof la);
  free(buffer);
  sk_free(&a);
  sk_free(&b);
  sph_context_destroy(first);
  sph_context_destroy(second);
}

static void test_restart(void **state) {
  (void)state;
  static const int32_t methods[] = {SPH_INTEGRATOR_LEAPFROG_PREDICTED, SPH_INTEGRATOR_HEUN,
                                    SPH_INTEGRATOR_LEAPFROG};
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int k = 0; k < 3; k++)
      for (int32_t density = SPH_SHOCKS_DIFFERENTIAL; density <= SPH_SHOCKS_INTEGRAL; density++) {
        sph_shocks_options o = sk_options(dim);
        o.integrator = methods[k];
        o.audit = methods[k] != SPH_INTEGRATOR_LEAPFROG;
        o.density = density;
        check_restart(dim, &o, SK_GAS);
        check_restart(dim, &o, SK_HARDENING);
      }
}

/* A list that is kept over steps is not the same in both runs unless it is built anew. */
static void test_verlet(void **state) {
  (void)state;
  sph_shocks_options o = sk_options(2);
  o.neighbors = SPH_NEIGHBORS_VERLET;
  o.adaptive = 0;
  o.skin = 0.5;
  check_restart(2, &o, SK_HARDENING);
}

/* A saved state can be taken up again and again, by the scheme that wrote it, too. */
static void test_again(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  cloud c = sk_cloud(ctx, 2, 8, SK_SOLID), d = sk_cloud(ctx, 2, 8, SK_SOLID);
  sph_shocks_options o = sk_options(2);
  size_t bytes;
  sk_start(&c, &o);
  sk_start(&d, &o);
  go_on(&c, 3);
  go_on(&d, 6);
  void *buffer = save(&c, &bytes);
  for (int k = 0; k < 2; k++) {
    go_on(&c, 2);
    sk_ok(&c, sph_shocks_restore(c.scheme, buffer, bytes));
    assert_int_equal(sk_ledger(&c).steps, 3);
  }
  go_on(&c, 3);
  same_state(&c, &d);
  free(buffer);
  sk_free(&c);
  sk_free(&d);
  sph_context_destroy(ctx);
}

static void test_refused(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  cloud c = sk_cloud(ctx, 2, 5, SK_GAS), other = sk_cloud(ctx, 2, 4, SK_GAS);
  sph_shocks_options o = sk_options(2);
  size_t bytes;
  sk_start(&c, &o);
  go_on(&c, 2);
  unsigned char *buffer = save(&c, &bytes);
  sk_refused(ctx, sph_shocks_restore(c.scheme, buffer, bytes - 1), SPH_ERR_ARG, "bytes");
  sk_refused(ctx, sph_shocks_step(c.scheme, 0.01, NULL), SPH_ERR_STATE, "not started");
  sk_refused(ctx, sph_shocks_restore(c.scheme, buffer + 1, bytes), SPH_ERR_ARG, "aligned");
  for (size_t at = 0; at < bytes; at += at < 200 ? 1 : 97) {
    buffer[at] ^= 0x10;
    check_status(sph_shocks_restore(c.scheme, buffer, bytes), SPH_ERR_ARG);
    buffer[at] ^= 0x10;
  }
  check_ok(sk_create(&other, &o));
  sk_refused(ctx, sph_shocks_restore(other.scheme, buffer, bytes), SPH_ERR_ARG, "another set");
  sk_free(&other);
  other = sk_cloud(ctx, 2, 5, SK_GAS);
  o.integrator = SPH_INTEGRATOR_HEUN;
  check_ok(sk_create(&other, &o));
  check_status(sph_shocks_restore(other.scheme, buffer, bytes), SPH_ERR_ARG);
  check_ok(sph_shocks_restore(c.scheme, buffer, bytes)); /* it is still good */
  sk_steps(&c, 1, 0.01);
  free(buffer);
  sk_free(&c);
  sk_free(&other);
  sph_context_destroy(ctx);
}

/* ---- integrators by themselves ----------------------------------------------------------- */

static int32_t decay(void *user, double t, sph_particles *set, const sph_rate *rates,
                     int32_t count) {
  const double *y = user;
  (void)set, (void)t;
  for (int k = 0; k < 3; k++) rates[0].values[k] = count == 1 ? -(1.0 + k) * y[k] * y[k] : 0.0;
  return 0;
}

static sph_integrator *integrator(sph_context *ctx, int32_t method, double *y) {
  sph_integrator_options o;
  sph_integrator *it = NULL;
  sph_integrator_options_init(&o);
  o.method = method;
  if (sph_integrator_create(ctx, &o, &it) != SPH_OK) return NULL;
  check_ok(sph_integrator_bind_array(it, y, 3));
  check_ok(sph_integrator_set_function(it, decay, y));
  return it;
}

static void test_integrator(void **state) {
  (void)state;
  static const int32_t methods[] = {SPH_INTEGRATOR_LEAPFROG_PREDICTED, SPH_INTEGRATOR_RKC,
                                    SPH_INTEGRATOR_RK4};
  sph_context *ctx = rh_context(1);
  for (int m = 0; m < 3; m++) {
    double y[3] = {1.0, 0.5, 2.0}, z[3] = {9.0, 9.0, 9.0};
    sph_integrator *a = integrator(ctx, methods[m], y), *b = integrator(ctx, methods[m], z);
    sph_integrator *other = integrator(ctx, methods[(m + 1) % 3], z);
    size_t bytes, more;
    for (int k = 0; k < 12; k++) check_ok(sph_integrator_step(a, NULL, 0.02 * k, 0.02, NULL));
    check_ok(sph_integrator_state_size(a, NULL, &bytes));
    double *buffer = malloc(bytes);
    check_status(sph_integrator_state_write(a, NULL, buffer, bytes - 1), SPH_ERR_ARG);
    check_ok(sph_integrator_state_write(a, NULL, buffer, bytes));
    check_ok(sph_integrator_state_size(b, NULL, &more));
    assert_true(more == bytes);
    check_ok(sph_integrator_state_read(b, NULL, buffer, bytes));
    assert_memory_equal(y, z, sizeof y);
    for (int k = 12; k < 40; k++) {
      check_ok(sph_integrator_step(a, NULL, 0.02 * k, 0.02, NULL));
      check_ok(sph_integrator_step(b, NULL, 0.02 * k, 0.02, NULL));
    }
    assert_memory_equal(y, z, sizeof y);
    assert_true(y[0] < 0.6);
    const double kept = z[0];
    check_status(sph_integrator_state_read(b, NULL, buffer, bytes - 8), SPH_ERR_ARG);
    double *padded = calloc(1, 4096); /* long enough, so that it is the method that is refused */
    memcpy(padded, buffer, bytes);
    check_status(sph_integrator_state_read(other, NULL, padded, 4096), SPH_ERR_ARG);
    padded[0] = 1.0;
    check_status(sph_integrator_state_read(b, NULL, padded, 4096), SPH_ERR_ARG);
    check_close(z[0], kept, 0.0);
    free(padded);
    free(buffer);
    sph_integrator_destroy(a);
    sph_integrator_destroy(b);
    sph_integrator_destroy(other);
  }
  sph_context_destroy(ctx);
}

static sph_status scenario(sph_context *ctx, void *user) {
  double y[3] = {1.0, 0.5, 2.0}, buffer[256];
  size_t bytes = 0;
  sph_integrator *it = integrator(ctx, *(int32_t *)user, y);
  if (!it) return SPH_ERR_NOMEM;
  sph_status s = sph_integrator_state_size(it, NULL, &bytes);
  if (!s) s = sph_integrator_state_write(it, NULL, buffer, sizeof buffer);
  if (!s) s = sph_integrator_state_read(it, NULL, buffer, sizeof buffer);
  sph_integrator_destroy(it);
  return s;
}

static void test_memory(void **state) {
  (void)state;
  int32_t methods[] = {SPH_INTEGRATOR_LEAPFROG_PREDICTED, SPH_INTEGRATOR_RKC};
  for (int k = 0; k < 2; k++) oom_sweep(scenario, &methods[k]);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_restart),    cmocka_unit_test(test_verlet),
    cmocka_unit_test(test_again),      cmocka_unit_test(test_refused),
    cmocka_unit_test(test_integrator), cmocka_unit_test(test_memory),
};
SPH_TEST_MAIN(tests)
