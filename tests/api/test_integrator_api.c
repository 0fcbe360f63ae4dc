/* Integrators through the public calls: every call, every refusal, and a composed right-hand side.
 */
#include "../check.h"

#include <sph/sph.h>

static sph_context *make_context(void) {
  sph_context *ctx = NULL;
  check_ok(sph_context_create(NULL, &ctx));
  return ctx;
}

/* The call fails with this status and a sentence that holds `words`. */
static void refused(sph_context *ctx, sph_status got, sph_status want, const char *words) {
  check_status(got, want);
  if (strstr(sph_context_last_error(ctx), words) == NULL)
    fail_msg("\"%s\" is not in \"%s\"", words, sph_context_last_error(ctx));
}

static int32_t zero_rate(void *user, double t, sph_particles *set, const sph_rate *rates,
                         int32_t count) {
  (void)user;
  (void)t;
  (void)set;
  for (int32_t k = 0; k < count; ++k) rates[k].values[0] = 0.0;
  return 0;
}

static double some_radius(void *user, double t, sph_particles *set) {
  (void)user;
  (void)t;
  (void)set;
  return 1.0;
}

/* ---- options ----------------------------------------------------------------------------- */

static void test_option_defaults(void **state) {
  sph_integrator_options o;
  (void)state;
  memset(&o, 0xaa, sizeof o);
  sph_integrator_options_init(&o);
  assert_int_equal(o.size, sizeof o);
  assert_int_equal(o.method, SPH_INTEGRATOR_RK4);
  assert_int_equal(o.rkc_b1, SPH_RKC_B1_INVERSE_W0);
  assert_int_equal(o.stage_rule, SPH_STAGES_POWER);
  assert_int_equal(o.max_stages, 100);
  assert_int_equal(o.power_iterations, 50);
  assert_int_equal(o.power_interval, 25);
  assert_int_equal(o.stability_check_interval, -1);
  assert_int_equal(o.check_finite, 1);
  check_close(o.power_safety, 1.1, 0.0);
  check_close(o.rtol, 1e-3, 0.0);
  check_close(o.atol, 1e-6, 0.0);
  assert_null(o.butcher_a);
  sph_integrator_options_init_sized(NULL, sizeof o);
}

static void test_info_defaults(void **state) {
  struct {
    sph_step_info info;
    unsigned char behind[16];
  } guarded;
  (void)state;
  memset(&guarded, 0xaa, sizeof guarded);
  sph_step_info_init(&guarded.info);
  assert_int_equal(guarded.info.size, sizeof guarded.info);
  assert_int_equal(guarded.info.want_error, 0);
  assert_true(isnan(guarded.info.error) && isnan(guarded.info.radius));
  assert_true(isnan(guarded.info.suggested_dt) && isnan(guarded.info.growth));
  for (int k = 0; k < 16; ++k) assert_int_equal(guarded.behind[k], 0xaa);
  sph_step_info_init_sized(NULL, 8);
}

static void test_old_and_new_callers(void **state) {
  struct {
    sph_integrator_options o;
    unsigned char behind[16];
  } newer;
  sph_context *ctx = make_context();
  sph_integrator *it = NULL;
  sph_integrator_options old;
  (void)state;
  sph_integrator_options_init_sized(&newer.o, sizeof newer);
  check_ok(sph_integrator_create(ctx, &newer.o, &it));
  sph_integrator_destroy(it);
  newer.behind[15] = 1;
  check_status(sph_integrator_create(ctx, &newer.o, &it), SPH_ERR_VERSION);
  assert_null(it);
  memset(&old, 0xaa, sizeof old);
  sph_integrator_options_init_sized(&old, offsetof(sph_integrator_options, rkc_b1));
  check_ok(sph_integrator_create(ctx, &old, &it)); /* the tail is garbage, and not read */
  sph_integrator_destroy(it);
  old.size = 1;
  check_status(sph_integrator_create(ctx, &old, &it), SPH_ERR_ARG);
  sph_context_destroy(ctx);
}

/* ---- creation ---------------------------------------------------------------------------- */

static void try_options(sph_context *ctx, const sph_integrator_options *o, const char *words) {
  sph_integrator *it = (sph_integrator *)ctx;
  refused(ctx, sph_integrator_create(ctx, o, &it), SPH_ERR_ARG, words);
  assert_null(it);
}

/* One field of the options at a time. */
#define TRY(options, field, value, words)  \
  do {                                     \
    sph_integrator_options o_ = (options); \
    o_.field = (value);                    \
    try_options(ctx, &o_, words);          \
  } while (0)

static void test_common_refusals(void **state) {
  sph_context *ctx = make_context();
  sph_integrator_options o;
  (void)state;
  sph_integrator_options_init(&o);
  TRY(o, method, 0, "method 0");
  TRY(o, method, 11, "method 11");
  TRY(o, rtol, -1.0, "rtol");
  TRY(o, atol, NAN, "atol");
  TRY(o, power_iterations, 0, "power_iterations");
  TRY(o, power_iterations, 1001, "power_iterations");
  TRY(o, stability_check_interval, -2, "stability_check_interval");
  o.rtol = 0.0;
  TRY(o, atol, 0.0, "not both 0");
  sph_context_destroy(ctx);
}

static void test_rkc_refusals(void **state) {
  sph_context *ctx = make_context();
  sph_integrator_options o;
  (void)state;
  sph_integrator_options_init(&o);
  o.method = SPH_INTEGRATOR_RKC;
  TRY(o, rkc_b1, 0, "rkc_b1");
  TRY(o, max_stages, 1, "max_stages");
  TRY(o, max_stages, 1001, "max_stages");
  TRY(o, stage_rule, 5, "stage_rule");
  TRY(o, power_safety, 0.9, "power_safety");
  TRY(o, power_safety, INFINITY, "power_safety");
  TRY(o, power_interval, 0, "power_interval");
  o.stage_rule = SPH_STAGES_FIXED;
  TRY(o, stages, 1, "stages = 1");
  TRY(o, stages, 101, "stages = 101");
  o.stage_rule = SPH_STAGES_CFL;
  o.wave_speed = 1.0;
  TRY(o, spacing, 0.0, "spacing");
  o.spacing = 1.0;
  TRY(o, wave_speed, -1.0, "wave_speed");
  o.stage_rule = SPH_STAGES_RADIUS;
  TRY(o, radius, NULL, "radius");
  sph_context_destroy(ctx);
}

static void test_tableau_refusals(void **state) {
  static const double a[] = {0, 0, 0.5, 0}, b[] = {0, 1}, implicit[] = {0, 0.1, 0.5, 0};
  static const double diagonal[] = {0, 0, 0.5, 0.5}, lost[] = {0, 0, NAN, 0},
                      short_b[] = {0.5, 0.4};
  sph_context *ctx = make_context();
  sph_integrator_options o;
  (void)state;
  sph_integrator_options_init(&o);
  o.method = SPH_INTEGRATOR_BUTCHER;
  o.butcher_stages = 2;
  o.butcher_a = a;
  o.butcher_b = b;
  TRY(o, butcher_stages, 0, "butcher_stages");
  TRY(o, butcher_stages, 33, "butcher_stages");
  TRY(o, butcher_a, NULL, "NULL");
  TRY(o, butcher_b, NULL, "NULL");
  TRY(o, butcher_a, implicit, "butcher_a[0][1]");
  TRY(o, butcher_a, diagonal, "butcher_a[1][1]");
  TRY(o, butcher_a, lost, "butcher_a[1][0]");
  TRY(o, butcher_b, short_b, "butcher_b sums");
  TRY(o, butcher_b_low, short_b, "butcher_b_low sums");
  sph_context_destroy(ctx);
}

static void test_create_refusals(void **state) {
  sph_context *ctx = make_context();
  sph_particles *set = NULL;
  sph_integrator *it = NULL;
  (void)state;
  check_ok(sph_particles_create(ctx, NULL, &set));
  check_status(sph_integrator_create(NULL, NULL, &it), SPH_ERR_ARG);
  check_status(sph_integrator_create((sph_context *)set, NULL, &it), SPH_ERR_HANDLE);
  check_status(sph_integrator_create(ctx, NULL, NULL), SPH_ERR_ARG);
  check_ok(sph_integrator_create(ctx, NULL, &it));
  sph_integrator_destroy(it);
  sph_integrator_destroy(NULL);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

/* ---- NULL and other handles -------------------------------------------------------------- */

static void test_null(void **state) {
  double y = 0.0;
  (void)state;
  check_status(sph_integrator_bind_field(NULL, 0), SPH_ERR_ARG);
  check_status(sph_integrator_bind_array(NULL, &y, 1), SPH_ERR_ARG);
  check_status(sph_integrator_set_function(NULL, zero_rate, NULL), SPH_ERR_ARG);
  check_status(sph_integrator_set_rhs(NULL, NULL, NULL), SPH_ERR_ARG);
  check_status(sph_integrator_step(NULL, NULL, 0.0, 1.0, NULL), SPH_ERR_ARG);
  check_status(sph_integrator_save(NULL, NULL), SPH_ERR_ARG);
  check_status(sph_integrator_restore(NULL, NULL), SPH_ERR_ARG);
  check_status(sph_cfl_step(NULL, 1.0, &y), SPH_ERR_ARG);
}

static void test_other_handles(void **state) {
  sph_context *ctx = make_context();
  sph_integrator *it = NULL, *other;
  sph_particles *set = NULL;
  double y = 0.0;
  (void)state;
  check_ok(sph_integrator_create(ctx, NULL, &it));
  check_ok(sph_particles_create(ctx, NULL, &set));
  other = (sph_integrator *)set;
  check_status(sph_integrator_bind_field(other, 0), SPH_ERR_HANDLE);
  check_status(sph_integrator_bind_array(other, &y, 1), SPH_ERR_HANDLE);
  check_status(sph_integrator_set_function(other, zero_rate, NULL), SPH_ERR_HANDLE);
  check_status(sph_integrator_set_rhs(other, NULL, NULL), SPH_ERR_HANDLE);
  check_status(sph_integrator_step(other, NULL, 0.0, 1.0, NULL), SPH_ERR_HANDLE);
  check_status(sph_integrator_save(other, NULL), SPH_ERR_HANDLE);
  check_status(sph_integrator_restore(other, NULL), SPH_ERR_HANDLE);
  check_status(sph_cfl_step((sph_particles *)it, 1.0, &y), SPH_ERR_HANDLE);
  check_status(sph_integrator_set_function(it, NULL, NULL), SPH_ERR_ARG);
  check_status(sph_integrator_set_rhs(it, NULL, NULL), SPH_ERR_ARG);
  check_status(sph_integrator_set_rhs(it, (sph_rhs *)set, NULL), SPH_ERR_HANDLE);
  check_status(sph_integrator_bind_array(it, NULL, 1), SPH_ERR_ARG);
  check_ok(sph_integrator_bind_array(it, &y, 1));
  check_ok(sph_integrator_set_function(it, zero_rate, NULL));
  check_status(sph_integrator_step(it, (sph_particles *)it, 0.0, 1.0, NULL), SPH_ERR_HANDLE);
  check_status(sph_integrator_save(it, (sph_particles *)it), SPH_ERR_HANDLE);
  check_ok(sph_integrator_step(it, set, 0.0, 1.0, NULL));
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

/* An info of another size: what it has is written, no more; a failure leaves it alone. */
static void test_info_sizes(void **state) {
  sph_context *ctx = make_context();
  sph_integrator *it = NULL;
  sph_step_info info;
  double y = 0.0;
  (void)state;
  check_ok(sph_integrator_create(ctx, NULL, &it));
  check_ok(sph_integrator_bind_array(it, &y, 1));
  check_ok(sph_integrator_set_function(it, zero_rate, NULL));
  memset(&info, 0xaa, sizeof info);
  sph_step_info_init_sized(&info, offsetof(sph_step_info, error));
  check_ok(sph_integrator_step(it, NULL, 0.0, 1.0, &info));
  assert_int_equal(info.stages, 4);
  assert_int_equal(info.evaluations, 4);
  assert_int_equal(info.want_error, (int32_t)0xaaaaaaaa);
  assert_int_equal(info.size, offsetof(sph_step_info, error));
  info.stages = 77;
  check_status(sph_integrator_step(it, NULL, 0.0, 0.0, &info), SPH_ERR_ARG);
  assert_int_equal(info.stages, 77);
  info.size = 0;
  check_status(sph_integrator_step(it, NULL, 0.0, 1.0, &info), SPH_ERR_ARG);
  sph_integrator_destroy(it);
  sph_context_destroy(ctx);
}

/* The context may be given up first. */
static void test_outlives_context_reference(void **state) {
  sph_context *ctx = make_context();
  sph_integrator *it = NULL;
  sph_integrator_options o;
  double y = 3.0;
  (void)state;
  sph_integrator_options_init(&o);
  o.method = SPH_INTEGRATOR_RKC;
  o.stage_rule = SPH_STAGES_RADIUS;
  o.radius = some_radius;
  check_ok(sph_integrator_create(ctx, &o, &it));
  sph_context_destroy(ctx);
  check_ok(sph_integrator_bind_array(it, &y, 1));
  check_ok(sph_integrator_set_function(it, zero_rate, NULL));
  check_ok(sph_integrator_step(it, NULL, 0.0, 1.0, NULL));
  check_close(y, 3.0, 1e-15);
  sph_integrator_destroy(it);
}

/* ---- a composed right-hand side ---------------------------------------------------------- */

typedef struct world {
  sph_context *ctx;
  sph_particles *set;
  sph_kernel *kernel;
  sph_neighbors *list;
  sph_rhs *rhs;
  double *x, *v;
} world;

/* Free fall: x' = v, v' = g. */
static world make_world(void) {
  world w = {make_context(), NULL, NULL, NULL, NULL, NULL, NULL};
  sph_particles_options o;
  sph_term motion, gravity;
  double *h, *m, *rho;
  sph_particles_options_init(&o);
  o.dim = 2;
  check_ok(sph_particles_create(w.ctx, &o, &w.set));
  check_ok(sph_particles_add(w.set, 100, NULL));
  check_ok(sph_particles_field(w.set, SPH_FIELD_X, &w.x));
  check_ok(sph_particles_field(w.set, SPH_FIELD_V, &w.v));
  check_ok(sph_particles_field(w.set, SPH_FIELD_H, &h));
  check_ok(sph_particles_field(w.set, SPH_FIELD_M, &m));
  check_ok(sph_particles_field(w.set, SPH_FIELD_RHO, &rho));
  for (int i = 0; i < 100; ++i) {
    w.x[2 * i] = 0.1 * (i % 10);
    w.x[2 * i + 1] = 0.1 * (i / 10);
    w.v[2 * i] = 1.0;
    h[i] = 0.15;
    m[i] = 0.01;
    rho[i] = 1.0;
  }
  check_ok(sph_kernel_create(w.ctx, SPH_KERNEL_CUBIC_SPLINE, 2, &w.kernel));
  check_ok(sph_neighbors_create(w.ctx, NULL, &w.list));
  check_ok(sph_rhs_create(w.ctx, w.kernel, NULL, &w.rhs));
  sph_term_init(&motion);
  motion.kind = SPH_TERM_MOTION;
  check_ok(sph_rhs_add(w.rhs, &motion));
  sph_term_init(&gravity);
  gravity.kind = SPH_TERM_BODY_FORCE;
  gravity.vector[1] = -10.0;
  check_ok(sph_rhs_add(w.rhs, &gravity));
  check_ok(sph_neighbors_build(w.list, w.set));
  return w;
}

static void free_world(world *w) {
  sph_rhs_destroy(w->rhs);
  sph_neighbors_destroy(w->list);
  sph_kernel_destroy(w->kernel);
  sph_particles_destroy(w->set);
  sph_context_destroy(w->ctx);
}

/* Every method of order 2 or more falls exactly. */
static void test_free_fall(void **state) {
  (void)state;
  for (int32_t method = SPH_INTEGRATOR_PC2; method <= SPH_INTEGRATOR_RKC; ++method) {
    sph_integrator_options o;
    sph_integrator *it = NULL;
    if (method == SPH_INTEGRATOR_BUTCHER) continue;
    world w = make_world();
    sph_integrator_options_init(&o);
    o.method = method;
    check_ok(sph_integrator_create(w.ctx, &o, &it));
    check_ok(sph_integrator_bind_field(it, SPH_FIELD_X));
    check_ok(sph_integrator_bind_field(it, SPH_FIELD_V));
    check_ok(sph_integrator_set_rhs(it, w.rhs, w.list));
    for (int n = 0; n < 10; ++n) check_ok(sph_integrator_step(it, w.set, 0.05 * n, 0.05, NULL));
    for (int i = 0; i < 100; ++i) {
      check_close(w.x[2 * i], 0.1 * (i % 10) + 0.5, 1e-13);
      check_close(w.x[2 * i + 1], 0.1 * (i / 10) - 0.5 * 10.0 * 0.25, 1e-13);
      check_close(w.v[2 * i + 1], -5.0, 1e-13);
    }
    sph_integrator_destroy(it);
    free_world(&w);
  }
}

static void test_composed_refusals(void **state) {
  world w = make_world();
  sph_integrator *it = NULL;
  double y = 0.0;
  (void)state;
  check_ok(sph_integrator_create(w.ctx, NULL, &it));
  check_ok(sph_integrator_set_rhs(it, w.rhs, w.list));
  check_status(sph_integrator_set_rhs(it, w.rhs, NULL), SPH_ERR_ARG);
  check_status(sph_integrator_set_rhs(it, w.rhs, (sph_neighbors *)w.rhs), SPH_ERR_HANDLE);
  check_ok(sph_integrator_bind_field(it, SPH_FIELD_V));
  refused(w.ctx, sph_integrator_step(it, NULL, 0.0, 1.0, NULL), SPH_ERR_ARG, "composed");
  check_ok(sph_integrator_bind_array(it, &y, 1));
  refused(w.ctx, sph_integrator_step(it, w.set, 0.0, 1.0, NULL), SPH_ERR_STATE, "plain arrays");
  sph_integrator_destroy(it);
  free_world(&w);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_option_defaults),
    cmocka_unit_test(test_info_defaults),
    cmocka_unit_test(test_old_and_new_callers),
    cmocka_unit_test(test_common_refusals),
    cmocka_unit_test(test_rkc_refusals),
    cmocka_unit_test(test_tableau_refusals),
    cmocka_unit_test(test_create_refusals),
    cmocka_unit_test(test_null),
    cmocka_unit_test(test_other_handles),
    cmocka_unit_test(test_info_sizes),
    cmocka_unit_test(test_outlives_context_reference),
    cmocka_unit_test(test_free_fall),
    cmocka_unit_test(test_composed_refusals),
};
SPH_TEST_MAIN(tests)
