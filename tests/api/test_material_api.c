/* Materials through the public calls: a host's own law, Hooke's wave speeds, every refusal. */
#include "../check.h"
#include "../oom.h"

#include <sph/sph.h>

static sph_context *make_context(void) {
  sph_context *ctx = NULL;
  check_ok(sph_context_create(NULL, &ctx));
  return ctx;
}

static sph_hooke_options hooke_options(int32_t reduction) {
  sph_hooke_options o;
  sph_hooke_options_init(&o);
  o.young = 45e9;
  o.poisson = 0.35;
  o.density = 1738;
  o.reduction = reduction;
  return o;
}

static sph_material_block block(int32_t dim, int64_t n) {
  sph_material_block b;
  sph_material_block_init(&b);
  b.dim = dim;
  b.n = n;
  return b;
}

/* The call fails with this status and a sentence that holds `words`. */
static void refused(sph_context *ctx, sph_status got, sph_status want, const char *words) {
  check_status(got, want);
  if (strstr(sph_context_last_error(ctx), words) == NULL)
    fail_msg("\"%s\" is not in \"%s\"", words, sph_context_last_error(ctx));
}

static void test_defaults(void **state) {
  (void)state;
  sph_hooke_options o;
  sph_material_block b;
  sph_material_functions f;
  sph_hooke_options_init(&o);
  assert_int_equal(o.size, sizeof o);
  assert_true(o.poisson == 0 && o.young == 0 && o.density == 0);
  assert_int_equal(o.reduction, SPH_UNIAXIAL_STRESS);
  assert_int_equal(o.jaumann, 1);
  sph_material_block_init(&b);
  assert_int_equal(b.size, sizeof b);
  assert_int_equal(b.n, 0);
  assert_null(b.velocity_gradient);
  sph_material_functions_init(&f);
  assert_int_equal(f.size, sizeof f);
  assert_true(f.stress_rate == NULL && f.destroy == NULL);
  sph_hooke_options_init_sized(NULL, 10);
  sph_material_block_init_sized(NULL, 10);
  sph_material_functions_init_sized(NULL, 10);
}

static void test_wave_speeds(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  const double e = 45e9, nu = 0.35, rho = 1738, c0 = sqrt(e / rho);
  const double lateral = (1 - nu) / ((1 + nu) * (1 - 2 * nu)); /* (lambda + 2G) / E */
  const double want[] = {c0, c0 * sqrt(lateral), c0 / sqrt(1 - nu * nu), c0 * sqrt(lateral),
                         c0 * sqrt(lateral)};
  check_rel(want[2] / c0, 1.0675, 1e-4); /* the figures usually quoted for nu = 0.35 */
  check_rel(want[3] / c0, 1.267, 1e-3);
  for (int32_t reduction = SPH_UNIAXIAL_STRESS; reduction <= SPH_SOLID; reduction++) {
    const int32_t dims[] = {1, 1, 2, 2, 3};
    sph_hooke_options o = hooke_options(reduction);
    sph_material_block b = block(dims[reduction - 1], 3);
    sph_material *m = NULL;
    double c[4] = {-1, -1, -1, -1};
    check_ok(sph_material_create_hooke(ctx, &o, &m));
    check_ok(sph_material_sound_speed(m, &b, c));
    for (int k = 0; k < 3; k++) check_rel(c[k], want[reduction - 1], 1e-14);
    assert_true(c[3] == -1);
    sph_material_destroy(m);
  }
  sph_context_destroy(ctx);
}

static void test_bar(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_hooke_options o = hooke_options(SPH_UNIAXIAL_STRESS);
  sph_material_block b = block(1, 3);
  sph_material *m = NULL;
  const double l[3] = {1e-3, 0, -2};
  double rate[3];
  check_ok(sph_material_create_hooke(ctx, &o, &m));
  b.velocity_gradient = l; /* no stress array is needed in 1-D */
  check_ok(sph_material_stress_rate(m, &b, rate));
  check_rel(rate[0], 45e6, 1e-15);
  assert_true(rate[1] == 0);
  check_rel(rate[2], -90e9, 1e-15);
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

static void test_hooke_refusals(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_hooke_options o;
  sph_material *m = (sph_material *)ctx;
  refused(ctx, sph_material_create_hooke(ctx, NULL, &m), SPH_ERR_ARG, "options is NULL");
  assert_null(m);
  o = hooke_options(SPH_SOLID);
  check_status(sph_material_create_hooke(NULL, &o, &m), SPH_ERR_ARG);
  refused(ctx, sph_material_create_hooke(ctx, &o, NULL), SPH_ERR_ARG, "out is NULL");
  const double bad[] = {0, -1, NAN, INFINITY};
  for (int k = 0; k < 4; k++) {
    o = hooke_options(SPH_SOLID);
    o.young = bad[k];
    refused(ctx, sph_material_create_hooke(ctx, &o, &m), SPH_ERR_ARG, "young");
    o = hooke_options(SPH_SOLID);
    o.density = bad[k];
    refused(ctx, sph_material_create_hooke(ctx, &o, &m), SPH_ERR_ARG, "density");
  }
  const double bad_nu[] = {0.5, -1, NAN, 7};
  for (int k = 0; k < 4; k++) {
    o = hooke_options(SPH_SOLID);
    o.poisson = bad_nu[k];
    refused(ctx, sph_material_create_hooke(ctx, &o, &m), SPH_ERR_ARG, "poisson");
  }
  o = hooke_options(6);
  refused(ctx, sph_material_create_hooke(ctx, &o, &m), SPH_ERR_ARG, "reduction 6");
  assert_null(m);
  sph_context_destroy(ctx);
}

static void test_block_refusals(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_hooke_options o = hooke_options(SPH_PLANE_STRESS);
  sph_material *m = NULL;
  double l[9] = {0}, s[6] = {0}, out[6] = {1, 2, 3, 4, 5, 6};
  check_ok(sph_material_create_hooke(ctx, &o, &m));
  sph_material_block b = block(2, 1);
  b.velocity_gradient = l;
  b.sigma = s;
  refused(ctx, sph_material_stress_rate(m, NULL, out), SPH_ERR_ARG, "block is NULL");
  refused(ctx, sph_material_stress_rate(m, &b, NULL), SPH_ERR_ARG, "output array is NULL");
  b.dim = 3;
  refused(ctx, sph_material_stress_rate(m, &b, out), SPH_ERR_ARG,
          "the block is 3-D, the material 2-D");
  b.dim = 0;
  refused(ctx, sph_material_stress_rate(m, &b, out), SPH_ERR_ARG, "dim is 0");
  b.dim = 2;
  b.n = -1;
  refused(ctx, sph_material_stress_rate(m, &b, out), SPH_ERR_ARG, "n = -1");
  b.n = 1;
  b.velocity_gradient = NULL;
  refused(ctx, sph_material_stress_rate(m, &b, out), SPH_ERR_ARG, "velocity_gradient");
  b.velocity_gradient = l;
  b.sigma = NULL;
  refused(ctx, sph_material_stress_rate(m, &b, out), SPH_ERR_ARG, "sigma");
  refused(ctx, sph_material_pressure(m, &b, out), SPH_ERR_UNSUPPORTED, "pressure");
  b.size = 3;
  check_status(sph_material_stress_rate(m, &b, out), SPH_ERR_ARG);
  for (int k = 0; k < 6; k++) assert_true(out[k] == k + 1);
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

static void test_empty_block(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_hooke_options o = hooke_options(SPH_SOLID);
  sph_material_block b = block(3, 0);
  sph_material *m = NULL;
  double out[1] = {5};
  check_ok(sph_material_create_hooke(ctx, &o, &m));
  check_ok(sph_material_stress_rate(m, &b, out));
  check_ok(sph_material_sound_speed(m, &b, out));
  assert_true(out[0] == 5);
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

static void test_wrong_handles(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material_block b = block(1, 0);
  sph_material_functions f;
  sph_hooke_options o = hooke_options(SPH_UNIAXIAL_STRESS);
  sph_material *m = NULL, *other = NULL;
  double out[1];
  sph_material_functions_init(&f);
  check_ok(sph_material_create_hooke(ctx, &o, &m));
  for (int wrong = 0; wrong < 2; wrong++) {
    sph_material *handle = wrong ? (sph_material *)ctx : NULL;
    sph_status want = wrong ? SPH_ERR_HANDLE : SPH_ERR_ARG;
    check_status(sph_material_stress_rate(handle, &b, out), want);
    check_status(sph_material_pressure(handle, &b, out), want);
    check_status(sph_material_sound_speed(handle, &b, out), want);
    check_status(sph_material_create((sph_context *)(wrong ? m : NULL), &f, NULL, &other), want);
    check_status(sph_material_create_hooke((sph_context *)(wrong ? m : NULL), &o, &other), want);
    assert_null(other);
    sph_material_destroy(handle); /* must not touch a context */
  }
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

/* ---- a host's own law ---- */

typedef struct host_law {
  int32_t answer;
  int calls, destroyed;
  double gamma;
} host_law;

static int32_t ideal_gas(void *user, const sph_material_block *b, double *p) {
  host_law *law = (host_law *)user;
  law->calls++;
  if (b->size < sizeof(sph_material_block) || b->rho == NULL || b->e == NULL) return -1;
  for (int64_t i = 0; i < b->n; i++) p[i] = (law->gamma - 1) * b->rho[i] * b->e[i];
  return law->answer;
}

static void count_destroy(void *user) { ((host_law *)user)->destroyed++; }

static void test_host_law(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material_functions f;
  host_law law = {0, 0, 0, 1.4};
  sph_material *m = NULL;
  const double rho[2] = {1, 0.125}, e[2] = {2.5, 2};
  double p[2], c[2];
  sph_material_functions_init(&f);
  f.pressure = ideal_gas;
  f.destroy = count_destroy;
  check_ok(sph_material_create(ctx, &f, &law, &m));
  f.pressure = NULL; /* the table was copied */
  sph_material_block b = block(3, 2);
  b.rho = rho;
  b.e = e;
  check_ok(sph_material_pressure(m, &b, p));
  check_rel(p[0], 1.0, 1e-15);
  check_rel(p[1], 0.1, 1e-15);
  b.dim = 1; /* a host's law is for any dimension */
  check_ok(sph_material_pressure(m, &b, p));
  refused(ctx, sph_material_sound_speed(m, &b, c), SPH_ERR_UNSUPPORTED, "sound_speed");
  refused(ctx, sph_material_stress_rate(m, &b, c), SPH_ERR_UNSUPPORTED, "stress_rate");
  law.answer = 3;
  check_status(sph_material_pressure(m, &b, p), SPH_RETRY);
  law.answer = -3;
  refused(ctx, sph_material_pressure(m, &b, p), SPH_ERR_CALLBACK, "pressure");
  assert_int_equal(law.calls, 4);
  b.n = 0;
  check_ok(sph_material_pressure(m, &b, p)); /* not called for nothing */
  assert_int_equal(law.calls, 4);
  sph_context_destroy(ctx);
  assert_int_equal(law.destroyed, 0);
  sph_material_destroy(m);
  assert_int_equal(law.destroyed, 1);
}

static void test_host_law_refusals(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  struct {
    sph_material_functions f;
    int64_t unknown;
  } newer;
  host_law law = {0, 0, 0, 1.4};
  sph_material *m = (sph_material *)ctx;
  memset(&newer, 0, sizeof newer);
  sph_material_functions_init(&newer.f);
  newer.f.destroy = count_destroy;
  refused(ctx, sph_material_create(ctx, &newer.f, &law, &m), SPH_ERR_ARG, "no law");
  assert_null(m);
  refused(ctx, sph_material_create(ctx, NULL, &law, &m), SPH_ERR_ARG, "functions is NULL");
  newer.f.pressure = ideal_gas;
  refused(ctx, sph_material_create(ctx, &newer.f, &law, NULL), SPH_ERR_ARG, "out is NULL");
  newer.f.size = sizeof newer;
  newer.unknown = 1;
  check_status(sph_material_create(ctx, &newer.f, &law, &m), SPH_ERR_VERSION);
  assert_null(m);
  assert_int_equal(law.destroyed, 0); /* a failed creation leaves `user` to the host */
  sph_context_destroy(ctx);
}

/* ---- memory ---- */

static sph_status lives(sph_context *ctx, void *user) {
  host_law *law = (host_law *)user;
  sph_hooke_options o = hooke_options(SPH_PLANE_STRAIN);
  sph_material_functions f;
  sph_material *hooke = NULL, *host = NULL;
  sph_material_functions_init(&f);
  f.pressure = ideal_gas;
  f.destroy = count_destroy;
  law->destroyed = 0;
  sph_status status = sph_material_create_hooke(ctx, &o, &hooke);
  if (status == SPH_OK) status = sph_material_create(ctx, &f, law, &host);
  assert_true((status == SPH_OK) == (host != NULL));
  sph_material_destroy(hooke);
  sph_material_destroy(host);
  assert_int_equal(law->destroyed, status == SPH_OK);
  return status;
}

static void test_out_of_memory(void **state) {
  (void)state;
  host_law law = {0, 0, 0, 1.4};
  oom_sweep(lives, &law);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_defaults),
    cmocka_unit_test(test_wave_speeds),
    cmocka_unit_test(test_bar),
    cmocka_unit_test(test_hooke_refusals),
    cmocka_unit_test(test_block_refusals),
    cmocka_unit_test(test_empty_block),
    cmocka_unit_test(test_wrong_handles),
    cmocka_unit_test(test_host_law),
    cmocka_unit_test(test_host_law_refusals),
    cmocka_unit_test(test_out_of_memory),
};
SPH_TEST_MAIN(tests)
