/* Composed right-hand side: what a call accepts and refuses, rates, hooks, lists, ghosts. */
#include "../rhs_help.h"

static void refused(sph_context *ctx, sph_status got, sph_status want, const char *words) {
  check_status(got, want);
  if (strstr(sph_context_last_error(ctx), words) == NULL)
    fail_msg("\"%s\" is not in \"%s\"", words, sph_context_last_error(ctx));
}

/* --- creation and terms ------------------------------------------------------------------ */

static void test_inits(void **state) {
  (void)state;
  struct {
    sph_term t;
    unsigned char behind[16];
  } term;
  struct {
    sph_rhs_options o;
    unsigned char behind[16];
  } options;
  memset(&term, 0xaa, sizeof term);
  memset(&options, 0xaa, sizeof options);
  sph_term_init(&term.t);
  sph_rhs_options_init(&options.o);
  assert_int_equal(term.t.size, sizeof term.t);
  assert_int_equal(term.t.power, 4);
  assert_int_equal(term.t.kind, 0);
  assert_int_equal(options.o.size, sizeof options.o);
  assert_int_equal(options.o.position_field, SPH_FIELD_X);
  assert_int_equal(options.o.update_list, 1);
  for (int k = 0; k < 16; k++) assert_true(term.behind[k] == 0xaa && options.behind[k] == 0xaa);
  sph_term_init_sized(&term.t, sizeof term);
  sph_rhs_options_init_sized(&options.o, sizeof options);
  for (int k = 0; k < 16; k++) assert_true(term.behind[k] == 0 && options.behind[k] == 0);
  sph_term_init_sized(NULL, 100);
  sph_rhs_options_init_sized(NULL, 100);
}

static void test_create(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_kernel *kernel = NULL;
  sph_rhs_options o;
  sph_rhs *rhs = (sph_rhs *)ctx;
  check_ok(sph_kernel_create(ctx, SPH_KERNEL_WENDLAND_C2, 2, &kernel));
  check_status(sph_rhs_create(NULL, kernel, NULL, &rhs), SPH_ERR_ARG);
  assert_null(rhs);
  rhs = (sph_rhs *)ctx;
  check_status(sph_rhs_create(ctx, NULL, NULL, &rhs), SPH_ERR_ARG);
  assert_null(rhs);
  check_status(sph_rhs_create(ctx, kernel, NULL, NULL), SPH_ERR_ARG);
  check_status(sph_rhs_create((sph_context *)kernel, kernel, NULL, &rhs), SPH_ERR_HANDLE);
  check_status(sph_rhs_create(ctx, (sph_kernel *)ctx, NULL, &rhs), SPH_ERR_HANDLE);
  sph_rhs_options_init(&o);
  o.position_field = SPH_FIELD_V;
  refused(ctx, sph_rhs_create(ctx, kernel, &o, &rhs), SPH_ERR_ARG, "position_field");
  sph_rhs_options_init(&o);
  o.size = 3;
  check_status(sph_rhs_create(ctx, kernel, &o, &rhs), SPH_ERR_ARG);
  struct {
    sph_rhs_options o;
    int64_t newer;
  } later;
  sph_rhs_options_init_sized(&later.o, sizeof later);
  check_ok(sph_rhs_create(ctx, kernel, &later.o, &rhs));
  sph_rhs_destroy(rhs);
  later.newer = 1;
  check_status(sph_rhs_create(ctx, kernel, &later.o, &rhs), SPH_ERR_VERSION);
  assert_null(rhs);
  sph_rhs_destroy(NULL);
  sph_rhs_destroy((sph_rhs *)kernel); /* another kind: left alone */
  assert_int_equal(sph_kernel_dim(kernel), 2);
  sph_kernel_destroy(kernel);
  sph_context_destroy(ctx);
}

/* With the total-Lagrangian forms, which have tests of their own. */
static int32_t last_form(int32_t kind) {
  return kind == SPH_TERM_STRESS_RATE || kind == SPH_TERM_MONAGHAN ? 2 : rh_forms(kind);
}

/* Every term that must be refused; after them the list is still empty. */
static void test_add_refusals(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, 6, 0, 1);
  sph_rhs *rhs = rh_rhs(&s);
  sph_term t = rh_term(SPH_TERM_STRESS, 0, 0);
  check_status(sph_rhs_add(NULL, &t), SPH_ERR_ARG);
  check_status(sph_rhs_add((sph_rhs *)s.list, &t), SPH_ERR_HANDLE);
  check_status(sph_rhs_add(rhs, NULL), SPH_ERR_ARG);
  t.kind = 0;
  refused(ctx, sph_rhs_add(rhs, &t), SPH_ERR_ARG, "kind 0");
  t.kind = SPH_TERM_DISSIPATION + 1;
  refused(ctx, sph_rhs_add(rhs, &t), SPH_ERR_ARG, "kind 16");
  t.kind = -1;
  check_status(sph_rhs_add(rhs, &t), SPH_ERR_ARG);
  for (int32_t kind = 1; kind <= SPH_TERM_ARTIFICIAL_STRESS; kind++) {
    t = rh_term(kind, last_form(kind) + 1, 0);
    refused(ctx, sph_rhs_add(rhs, &t), SPH_ERR_ARG, "form");
    t = rh_term(kind, -1, 0);
    refused(ctx, sph_rhs_add(rhs, &t), SPH_ERR_ARG, "form");
    for (int32_t form = 0; form <= rh_forms(kind); form++) {
      t = rh_term(kind, form, 1);
      if (!rh_correctable(kind, form)) refused(ctx, sph_rhs_add(rhs, &t), SPH_ERR_ARG, "corrected");
    }
  }
  double *numbers[] = {&t.alpha,  &t.beta,    &t.epsilon,   &t.neumann,
                       &t.linear, &t.spacing, &t.vector[0], &t.vector[2]};
  for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
    for (int bad = 0; bad < 2; bad++) {
      t = rh_term(SPH_TERM_BULK_VISCOSITY, 0, 0);
      *numbers[k] = bad ? NAN : -INFINITY;
      refused(ctx, sph_rhs_add(rhs, &t), SPH_ERR_ARG, "finite");
    }
  t = rh_term(SPH_TERM_BULK_VISCOSITY, 0, 0);
  t.spacing = 0.0;
  refused(ctx, sph_rhs_add(rhs, &t), SPH_ERR_ARG, "spacing");
  t.size = 4;
  check_status(sph_rhs_add(rhs, &t), SPH_ERR_ARG);
  struct {
    sph_term t;
    int64_t newer;
  } later;
  sph_term_init_sized(&later.t, sizeof later);
  later.t.kind = SPH_TERM_MOTION;
  later.newer = 5;
  check_status(sph_rhs_add(rhs, &later.t), SPH_ERR_VERSION);
  double *v = rh_rates(&s, rhs, SPH_FIELD_V);
  assert_true(rh_largest(v, s.rows * 2) == 0.0);
  free(v);
  sph_rhs_destroy(rhs);
  rh_free(&s);
  sph_context_destroy(ctx);
}

static void test_add_artificial_refusals(void **state) {
  (void)state;
  static const double ratios[] = {0.0, -1.0, NAN, INFINITY, 2.0, 2.5}; /* the support is 2 */
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, 6, 0, 1);
  sph_rhs *rhs = rh_rhs(&s);
  sph_term t;
  for (size_t k = 0; k < sizeof ratios / sizeof *ratios; k++) {
    t = rh_term(SPH_TERM_ARTIFICIAL_STRESS, 0, 0);
    t.spacing_ratio = ratios[k];
    refused(ctx, sph_rhs_add(rhs, &t), SPH_ERR_ARG, "spacing_ratio");
  }
  static const int32_t powers[] = {-1, 0, 17};
  for (int k = 0; k < 3; k++) {
    t = rh_term(SPH_TERM_ARTIFICIAL_STRESS, 0, 0);
    t.power = powers[k];
    refused(ctx, sph_rhs_add(rhs, &t), SPH_ERR_ARG, "power");
  }
  t = rh_term(SPH_TERM_ARTIFICIAL_STRESS, 0, 0);
  check_ok(sph_rhs_add(rhs, &t));
  sph_rhs_destroy(rhs);
  rh_free(&s);
  sph_context_destroy(ctx);
}

static void test_add_twice(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, 6, 0, 1);
  sph_rhs *rhs = rh_rhs(&s);
  for (int32_t kind = 1; kind <= SPH_TERM_ARTIFICIAL_STRESS; kind++) {
    sph_term t = rh_term(kind, 0, 0);
    check_ok(sph_rhs_add(rhs, &t));
    memset(&t, 0xff, sizeof t); /* it was copied */
    t = rh_term(kind, rh_forms(kind), 0);
    refused(ctx, sph_rhs_add(rhs, &t), SPH_ERR_ARG, "already");
  }
  sph_rhs_destroy(rhs);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* --- rates ------------------------------------------------------------------------------- */

static void test_rate_refusals(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, 6, 0, 1);
  sph_rhs *rhs = rh_rhs(&s);
  sph_term t = rh_term(SPH_TERM_STRESS, 0, 0);
  check_ok(sph_rhs_add(rhs, &t));
  double a[72], b[72];
  sph_rate two[2] = {{SPH_FIELD_V, a}, {SPH_FIELD_V, b}};
  refused(ctx, sph_rhs_evaluate(rhs, s.set, s.list, 0.0, two, 2), SPH_ERR_ARG, "twice");
  two[1] = (sph_rate){SPH_FIELD_RHO, NULL};
  refused(ctx, sph_rhs_evaluate(rhs, s.set, s.list, 0.0, two, 2), SPH_ERR_ARG, "rho");
  two[1] = (sph_rate){64, b};
  refused(ctx, sph_rhs_evaluate(rhs, s.set, s.list, 0.0, two, 2), SPH_ERR_ARG, "64");
  two[1] = (sph_rate){-1, b};
  check_status(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, two, 2), SPH_ERR_ARG);
  two[1] = (sph_rate){64, NULL};
  check_status(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, two, 2), SPH_ERR_ARG);
  check_status(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, two, -1), SPH_ERR_ARG);
  check_status(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, NULL, 1), SPH_ERR_ARG);
  check_ok(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, NULL, 0));
  check_status(sph_rhs_evaluate(NULL, s.set, s.list, 0.0, two, 1), SPH_ERR_ARG);
  check_status(sph_rhs_evaluate(rhs, NULL, s.list, 0.0, two, 1), SPH_ERR_ARG);
  check_status(sph_rhs_evaluate(rhs, s.set, NULL, 0.0, two, 1), SPH_ERR_ARG);
  check_status(sph_rhs_evaluate((sph_rhs *)s.set, s.set, s.list, 0.0, two, 1), SPH_ERR_HANDLE);
  check_status(sph_rhs_evaluate(rhs, (sph_particles *)rhs, s.list, 0.0, two, 1), SPH_ERR_HANDLE);
  check_status(sph_rhs_evaluate(rhs, s.set, (sph_neighbors *)rhs, 0.0, two, 1), SPH_ERR_HANDLE);
  sph_rhs_destroy(rhs);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* A set of other dimension, and a list that reaches less far than the kernel. */
static void test_misfits(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, 6, 0, 1), other = rh_make(ctx, 3, 3, 0, 1);
  sph_kernel *wide = NULL;
  sph_rhs *rhs = rh_rhs(&s), *far = NULL;
  double a[108];
  sph_rate rate = {SPH_FIELD_V, a};
  refused(ctx, sph_rhs_evaluate(rhs, other.set, other.list, 0.0, &rate, 1), SPH_ERR_ARG, "3-D");
  check_ok(sph_kernel_create(ctx, SPH_KERNEL_QUINTIC_SPLINE, 2, &wide));
  check_ok(sph_rhs_create(ctx, wide, NULL, &far));
  refused(ctx, sph_rhs_evaluate(far, s.set, s.list, 0.0, &rate, 1), SPH_ERR_ARG, "reaches");
  sph_rhs_destroy(far);
  sph_kernel_destroy(wide);
  sph_rhs_destroy(rhs);
  rh_free(&other);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* Rates without a term are zero, whatever the arrays held; fields not asked for are not needed. */
static void test_zero_and_overwritten(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 3, 4, RH_GHOSTS, 1);
  sph_rhs *rhs = rh_rhs(&s);
  sph_term t = rh_term(SPH_TERM_CONTINUITY, 0, 0);
  check_ok(sph_rhs_add(rhs, &t));
  static const int32_t fields[] = {SPH_FIELD_X, SPH_FIELD_V, SPH_FIELD_E, SPH_FIELD_SIGMA,
                                   SPH_FIELD_SPACING};
  for (int k = 0; k < 5; k++) {
    int32_t c = sph_particles_components(s.set, fields[k]);
    double *a = rh_array(s.rows * c + 4);
    sph_rate rate = {fields[k], a};
    check_ok(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, &rate, 1));
    assert_true(rh_largest(a, s.rows * c) == 0.0);
    for (int j = 0; j < 4; j++) assert_true(isnan(a[s.rows * c + j])); /* ghosts get none */
    free(a);
  }
  sph_rhs_destroy(rhs);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* Each field that a term reads, missing in turn, is named. */
static void check_missing(sph_context *ctx, int32_t kind, uint32_t needs) {
  static const struct {
    int32_t field;
    const char *name;
  } all[] = {{SPH_FIELD_V, "field v"}, {SPH_FIELD_M, "field m"}, {SPH_FIELD_RHO, "field rho"},
             {SPH_FIELD_P, "field p"}, {SPH_FIELD_C, "field c"}, {SPH_FIELD_SIGMA, "field sigma"}};
  for (int missing = 0; missing < 6; missing++) {
    sph_particles_options o;
    rh_system s = {.ctx = ctx, .dim = 1, .n = 8, .rows = 8};
    double a[8];
    sph_rate rate = {rh_target(kind), a};
    sph_term t = rh_term(kind, 0, 0);
    sph_particles_options_init(&o);
    o.dim = 1;
    check_ok(sph_particles_create(ctx, &o, &s.set));
    check_ok(sph_particles_add(s.set, 8, NULL));
    check_ok(sph_kernel_create(ctx, SPH_KERNEL_CUBIC_SPLINE, 1, &s.kernel));
    check_ok(sph_neighbors_create(ctx, NULL, &s.list));
    rh_place(&s, 8);
    rh_fill(&s, SPH_FIELD_H, 1.2, 1.2, 0);
    for (int k = 0; k < 6; k++)
      if (k != missing) rh_fill(&s, all[k].field, 1.0, 2.0, 1);
    sph_rhs *rhs = rh_rhs(&s);
    check_ok(sph_rhs_add(rhs, &t));
    sph_status status = sph_rhs_evaluate(rhs, s.set, s.list, 0.0, &rate, 1);
    if (needs >> missing & 1)
      refused(ctx, status, SPH_ERR_ARG, all[missing].name);
    else
      check_status(status, kind == SPH_TERM_STRESS_RATE ? SPH_ERR_STATE : SPH_OK);
    assert_true((sph_particles_revision(s.set, all[missing].field) != 0) == 0);
    sph_rhs_destroy(rhs);
    rh_free(&s);
  }
}

static void test_missing_fields(void **state) {
  (void)state;
  enum { V = 1, M = 2, RHO = 4, P = 8, C = 16, S = 32 };
  sph_context *ctx = rh_context(1);
  check_missing(ctx, SPH_TERM_CONTINUITY, V | M | RHO);
  check_missing(ctx, SPH_TERM_PRESSURE, M | RHO | P);
  check_missing(ctx, SPH_TERM_STRESS, M | RHO | S);
  check_missing(ctx, SPH_TERM_STRESS_RATE, V | M | RHO);
  check_missing(ctx, SPH_TERM_MONAGHAN, V | M | RHO | C);
  check_missing(ctx, SPH_TERM_BULK_VISCOSITY, V | M | RHO | C);
  check_missing(ctx, SPH_TERM_XSPH, V | M | RHO);
  check_missing(ctx, SPH_TERM_BODY_FORCE, 0);
  check_missing(ctx, SPH_TERM_MOTION, V);
  check_missing(ctx, SPH_TERM_ARTIFICIAL_STRESS, M | RHO | S);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_inits),          cmocka_unit_test(test_create),
    cmocka_unit_test(test_add_refusals),   cmocka_unit_test(test_add_artificial_refusals),
    cmocka_unit_test(test_add_twice),      cmocka_unit_test(test_rate_refusals),
    cmocka_unit_test(test_misfits),        cmocka_unit_test(test_zero_and_overwritten),
    cmocka_unit_test(test_missing_fields),
};
SPH_TEST_MAIN(tests)
