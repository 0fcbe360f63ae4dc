/* Kernels through the public interface: arguments, a host's own kernels, memory. */
#include "../check.h"
#include "../oom.h"

#include <sph/context.h>
#include <sph/kernel.h>

static sph_context *make_context(void) {
  sph_context *ctx = NULL;
  check_ok(sph_context_create(NULL, &ctx));
  return ctx;
}

static sph_kernel *make(sph_context *ctx, int32_t type, int32_t dim) {
  sph_kernel *kernel = NULL;
  check_ok(sph_kernel_create(ctx, type, dim, &kernel));
  assert_non_null(kernel);
  return kernel;
}

/* ---- built-in kernels ----------------------------------------------------------------------- */

static void test_names(void **state) {
  (void)state;
  static const char *const names[] = {
      "unknown",     "cubic_spline", "quartic_spline", "quintic_spline", "quadratic",
      "johnson",     "lucy",         "new_quartic",    "gaussian",       "super_gaussian",
      "wendland_c2", "wendland_c4",  "wendland_c6",    "mollifier",      "unknown"};
  for (int32_t type = 0; type <= 14; ++type)
    assert_string_equal(sph_kernel_name(type), names[type]);
  assert_string_equal(sph_kernel_name(-1), "unknown");
  assert_string_equal(sph_kernel_name(INT32_MAX), "unknown");
}

static void test_queries(void **state) {
  (void)state;
  static const double support[] = {0, 2, 2.5, 3, 1, 2, 1, 2, 3, 3, 2, 2, 2, 1};
  sph_context *ctx = make_context();
  for (int32_t type = 1; type <= 13; ++type)
    for (int32_t dim = 1; dim <= 3; ++dim) {
      sph_kernel *kernel = make(ctx, type, dim);
      assert_int_equal(sph_kernel_type(kernel), type);
      assert_int_equal(sph_kernel_dim(kernel), dim);
      check_close(sph_kernel_support(kernel), support[type], 0.0);
      assert_true(sph_kernel_alpha(kernel) > 0.0);
      assert_true(sph_kernel_deviation(kernel) > 0.0);
      sph_kernel_destroy(kernel);
    }
  sph_context_destroy(ctx);
}

static void test_create_arguments(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_kernel *const before = make(ctx, SPH_KERNEL_LUCY, 2);
  const int32_t types[] = {0, -1, 14, INT32_MIN, INT32_MAX};
  const int32_t dims[] = {0, -1, 4, INT32_MIN, INT32_MAX};
  for (int i = 0; i < 5; ++i) {
    sph_kernel *out = before;
    check_status(sph_kernel_create(ctx, types[i], 2, &out), SPH_ERR_ARG);
    assert_null(out);
    assert_true(strstr(sph_context_last_error(ctx), "type") != NULL);
    out = before;
    check_status(sph_kernel_create(ctx, SPH_KERNEL_LUCY, dims[i], &out), SPH_ERR_ARG);
    assert_null(out);
    assert_true(strstr(sph_context_last_error(ctx), "dim") != NULL);
  }
  sph_kernel *out = before;
  check_status(sph_kernel_create(NULL, SPH_KERNEL_LUCY, 2, &out), SPH_ERR_ARG);
  assert_null(out);
  check_status(sph_kernel_create(ctx, SPH_KERNEL_LUCY, 2, NULL), SPH_ERR_ARG);
  check_status(sph_kernel_create((sph_context *)before, SPH_KERNEL_LUCY, 2, &out), SPH_ERR_HANDLE);
  sph_kernel_destroy(before);
  sph_context_destroy(ctx);
}

static void test_null(void **state) {
  (void)state;
  double r = 0.5, w = 7.0;
  sph_kernel_destroy(NULL);
  assert_int_equal(sph_kernel_type(NULL), 0);
  assert_int_equal(sph_kernel_dim(NULL), 0);
  check_close(sph_kernel_support(NULL), 0.0, 0.0);
  check_close(sph_kernel_deviation(NULL), 0.0, 0.0);
  check_close(sph_kernel_alpha(NULL), 0.0, 0.0);
  assert_true(isnan(sph_kernel_w(NULL, 0.5, 1.0)));
  assert_true(isnan(sph_kernel_dwdr(NULL, 0.5, 1.0)));
  assert_true(isnan(sph_kernel_d2wdr2(NULL, 0.5, 1.0)));
  assert_true(isnan(sph_kernel_dwdh(NULL, 0.5, 1.0)));
  check_status(sph_kernel_evaluate(NULL, 1, &r, 1.0, &w, NULL, NULL, NULL), SPH_ERR_ARG);
  check_close(w, 7.0, 0.0);
}

/* A context where a kernel is expected is noticed. */
static void test_other_handle(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  const sph_kernel *wrong = (const sph_kernel *)ctx;
  double r = 0.5, w = 7.0;
  assert_true(isnan(sph_kernel_w(wrong, 0.5, 1.0)));
  assert_int_equal(sph_kernel_dim(wrong), 0);
  check_status(sph_kernel_evaluate(wrong, 1, &r, 1.0, &w, NULL, NULL, NULL), SPH_ERR_HANDLE);
  sph_context_destroy(ctx);
}

static void check_all_nan(const sph_kernel *kernel, double r, double h) {
  assert_true(isnan(sph_kernel_w(kernel, r, h)));
  assert_true(isnan(sph_kernel_dwdr(kernel, r, h)));
  assert_true(isnan(sph_kernel_d2wdr2(kernel, r, h)));
  assert_true(isnan(sph_kernel_dwdh(kernel, r, h)));
}

static void test_bad_numbers(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_kernel *kernel = make(ctx, SPH_KERNEL_CUBIC_SPLINE, 3);
  check_all_nan(kernel, -1e-300, 1.0);
  check_all_nan(kernel, NAN, 1.0);
  check_all_nan(kernel, 0.5, 0.0);
  check_all_nan(kernel, 0.5, -1.0);
  check_all_nan(kernel, 0.5, NAN);
  check_all_nan(kernel, 0.5, INFINITY);
  check_close(sph_kernel_w(kernel, INFINITY, 1.0), 0.0, 0.0);
  check_close(sph_kernel_w(kernel, 1.0, 1e-200), 0.0, 0.0);
  sph_kernel_destroy(kernel);
  sph_context_destroy(ctx);
}

static void test_evaluate(void **state) {
  (void)state;
  enum { N = 60 };
  double r[N], w[N], dw[N], d2w[N], dh[N];
  sph_context *ctx = make_context();
  sph_kernel *kernel = make(ctx, SPH_KERNEL_WENDLAND_C4, 2);
  const double h = 0.31;
  for (int i = 0; i < N; ++i) r[i] = 0.0117 * i;
  check_ok(sph_kernel_evaluate(kernel, N, r, h, w, dw, d2w, dh));
  for (int i = 0; i < N; ++i) {
    check_close(w[i], sph_kernel_w(kernel, r[i], h), 0.0);
    check_close(dw[i], sph_kernel_dwdr(kernel, r[i], h), 0.0);
    check_close(d2w[i], sph_kernel_d2wdr2(kernel, r[i], h), 0.0);
    check_close(dh[i], sph_kernel_dwdh(kernel, r[i], h), 0.0);
  }
  check_ok(sph_kernel_evaluate(kernel, N, r, h, NULL, NULL, NULL, NULL));
  check_ok(sph_kernel_evaluate(kernel, 0, NULL, h, NULL, NULL, NULL, NULL));
  sph_kernel_destroy(kernel);
  sph_context_destroy(ctx);
}

static void test_evaluate_arguments(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_kernel *kernel = make(ctx, SPH_KERNEL_LUCY, 1);
  double r[3] = {0.1, 0.2, 0.3}, w[3] = {7, 7, 7};
  check_status(sph_kernel_evaluate(kernel, -1, r, 1.0, w, NULL, NULL, NULL), SPH_ERR_ARG);
  check_status(sph_kernel_evaluate(kernel, 3, NULL, 1.0, w, NULL, NULL, NULL), SPH_ERR_ARG);
  const double bad_h[] = {0.0, -1.0, NAN, INFINITY};
  for (int i = 0; i < 4; ++i)
    check_status(sph_kernel_evaluate(kernel, 3, r, bad_h[i], w, NULL, NULL, NULL), SPH_ERR_ARG);
  r[2] = -0.5;
  check_status(sph_kernel_evaluate(kernel, 3, r, 1.0, w, NULL, NULL, NULL), SPH_ERR_ARG);
  assert_true(strstr(sph_context_last_error(ctx), "r[2] is -0.5") != NULL);
  r[1] = NAN;
  check_status(sph_kernel_evaluate(kernel, 3, r, 1.0, w, NULL, NULL, NULL), SPH_ERR_ARG);
  assert_true(strstr(sph_context_last_error(ctx), "r[1]") != NULL);
  for (int i = 0; i < 3; ++i) check_close(w[i], 7.0, 0.0);
  sph_kernel_destroy(kernel);
  sph_context_destroy(ctx);
}

static void test_equal_h(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_kernel *cubic = make(ctx, SPH_KERNEL_CUBIC_SPLINE, 1);
  sph_kernel *lucy = make(ctx, SPH_KERNEL_LUCY, 1);
  sph_kernel *plane = make(ctx, SPH_KERNEL_LUCY, 2);
  /* variances 1/3 and 2/21: h of Lucy is sqrt(7/2) times that of the cubic spline */
  check_rel(sph_kernel_equal_h(lucy, cubic, 0.2), 0.2 * sqrt(3.5), 1e-15);
  check_close(sph_kernel_equal_h(cubic, cubic, 0.2), 0.2, 0.0);
  assert_true(isnan(sph_kernel_equal_h(plane, cubic, 0.2)));
  assert_true(isnan(sph_kernel_equal_h(NULL, cubic, 0.2)));
  assert_true(isnan(sph_kernel_equal_h(cubic, NULL, 0.2)));
  assert_true(isnan(sph_kernel_equal_h(cubic, lucy, 0.0)));
  assert_true(isnan(sph_kernel_equal_h(cubic, lucy, -1.0)));
  assert_true(isnan(sph_kernel_equal_h(cubic, lucy, NAN)));
  sph_kernel_destroy(cubic);
  sph_kernel_destroy(lucy);
  sph_kernel_destroy(plane);
  sph_context_destroy(ctx);
}

/* ---- a host's own kernels ------------------------------------------------------------------- */

/* The cubic spline once more, normalised; user points at alpha. */
static void cubic_profile(void *user, double q, double *w, double *dw) {
  const double alpha = *(const double *)user;
  const double a = 2.0 - q;
  *w = alpha * (q < 1.0 ? 2.0 / 3.0 - q * q + 0.5 * q * q * q : a * a * a / 6.0);
  *dw = alpha * (q < 1.0 ? -2.0 * q + 1.5 * q * q : -0.5 * a * a);
}

/* Values within a tolerance relative to W(0); the second derivative has its own. */
static void check_same_kernel(const sph_kernel *mine, const sph_kernel *theirs, double tolerance,
                              double tolerance2) {
  const double h = 0.7, scale = sph_kernel_w(theirs, 0.0, h) / h;
  check_close(sph_kernel_deviation(mine), sph_kernel_deviation(theirs), 1e-8);
  check_close(sph_kernel_support(mine), 2.0, 0.0);
  for (int i = 0; i < 250; ++i) {
    const double r = 0.00613 * i;
    check_close(sph_kernel_w(mine, r, h), sph_kernel_w(theirs, r, h), tolerance * scale);
    check_close(sph_kernel_dwdr(mine, r, h), sph_kernel_dwdr(theirs, r, h), tolerance * scale / h);
    check_close(sph_kernel_dwdh(mine, r, h), sph_kernel_dwdh(theirs, r, h), tolerance * scale / h);
    check_close(sph_kernel_d2wdr2(mine, r, h), sph_kernel_d2wdr2(theirs, r, h),
                tolerance2 * scale / h / h);
  }
}

static void test_callback(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int32_t dim = 1; dim <= 3; ++dim) {
    sph_kernel *cubic = make(ctx, SPH_KERNEL_CUBIC_SPLINE, dim), *mine = NULL;
    double alpha = sph_kernel_alpha(cubic);
    check_ok(sph_kernel_create_callback(ctx, dim, 2.0, cubic_profile, &alpha, &mine));
    assert_int_equal(sph_kernel_type(mine), 0);
    assert_int_equal(sph_kernel_dim(mine), dim);
    check_close(sph_kernel_alpha(mine), 1.0, 0.0);
    check_same_kernel(mine, cubic, 1e-14, 1e-4);
    sph_kernel_destroy(mine);
    sph_kernel_destroy(cubic);
  }
  sph_context_destroy(ctx);
}

static void test_callback_arguments(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  double alpha = 1.0;
  sph_kernel *out = NULL;
  const double bad[] = {0.0, -1.0, NAN, INFINITY};
  for (int i = 0; i < 4; ++i)
    check_status(sph_kernel_create_callback(ctx, 1, bad[i], cubic_profile, &alpha, &out),
                 SPH_ERR_ARG);
  check_status(sph_kernel_create_callback(ctx, 1, 2.0, NULL, NULL, &out), SPH_ERR_ARG);
  check_status(sph_kernel_create_callback(ctx, 0, 2.0, cubic_profile, &alpha, &out), SPH_ERR_ARG);
  check_status(sph_kernel_create_callback(ctx, 1, 2.0, cubic_profile, &alpha, NULL), SPH_ERR_ARG);
  check_status(sph_kernel_create_callback(NULL, 1, 2.0, cubic_profile, &alpha, &out), SPH_ERR_ARG);
  alpha = 1.0 + 3e-6; /* just outside the tolerance of 1e-6 */
  check_status(sph_kernel_create_callback(ctx, 1, 2.0, cubic_profile, &alpha, &out),
               SPH_ERR_NUMERIC);
  assert_true(strstr(sph_context_last_error(ctx), "1.000003") != NULL);
  alpha = NAN;
  check_status(sph_kernel_create_callback(ctx, 1, 2.0, cubic_profile, &alpha, &out),
               SPH_ERR_NUMERIC);
  assert_null(out);
  sph_context_destroy(ctx);
}

enum { TABLE = 401 };

/* Samples of the cubic spline with w(0) = 2/3 * factor. */
static void fill_table(double *w, double *dw, double factor) {
  for (int i = 0; i < TABLE; ++i) cubic_profile(&factor, 2.0 * i / (TABLE - 1), &w[i], &dw[i]);
}

/* The cubic spline is a cubic between samples, so that its table is exact. */
static void test_table(void **state) {
  (void)state;
  double w[TABLE], dw[TABLE];
  sph_context *ctx = make_context();
  for (int32_t dim = 1; dim <= 3; ++dim)
    for (int32_t normalise = 0; normalise <= 1; ++normalise) {
      sph_kernel *cubic = make(ctx, SPH_KERNEL_CUBIC_SPLINE, dim), *mine = NULL;
      fill_table(w, dw, normalise ? 17.0 : sph_kernel_alpha(cubic));
      check_ok(sph_kernel_create_table(ctx, dim, 2.0, TABLE, w, dw, normalise, &mine));
      w[0] = 1e9; /* the table was copied */
      assert_int_equal(sph_kernel_type(mine), 0);
      check_same_kernel(mine, cubic, 1e-12, 1e-9);
      sph_kernel_destroy(mine);
      sph_kernel_destroy(cubic);
    }
  sph_context_destroy(ctx);
}

static void test_table_arguments(void **state) {
  (void)state;
  double w[TABLE], dw[TABLE];
  sph_context *ctx = make_context();
  sph_kernel *out = NULL;
  fill_table(w, dw, 1.0);
  check_status(sph_kernel_create_table(ctx, 1, 2.0, 3, w, dw, 1, &out), SPH_ERR_ARG);
  check_status(sph_kernel_create_table(ctx, 1, 2.0, -5, w, dw, 1, &out), SPH_ERR_ARG);
  check_status(sph_kernel_create_table(ctx, 1, 2.0, TABLE, NULL, dw, 1, &out), SPH_ERR_ARG);
  check_status(sph_kernel_create_table(ctx, 1, 2.0, TABLE, w, NULL, 1, &out), SPH_ERR_ARG);
  check_status(sph_kernel_create_table(ctx, 1, 0.0, TABLE, w, dw, 1, &out), SPH_ERR_ARG);
  check_status(sph_kernel_create_table(ctx, 1, NAN, TABLE, w, dw, 1, &out), SPH_ERR_ARG);
  check_status(sph_kernel_create_table(ctx, 4, 2.0, TABLE, w, dw, 1, &out), SPH_ERR_ARG);
  check_status(sph_kernel_create_table(ctx, 1, 2.0, TABLE, w, dw, 1, NULL), SPH_ERR_ARG);
  check_status(sph_kernel_create_table(NULL, 1, 2.0, TABLE, w, dw, 1, &out), SPH_ERR_ARG);
  assert_null(out);
  sph_context_destroy(ctx);
}

static void test_table_values(void **state) {
  (void)state;
  double w[TABLE], dw[TABLE];
  sph_context *ctx = make_context();
  sph_kernel *out = NULL;
  fill_table(w, dw, 1.1);
  check_status(sph_kernel_create_table(ctx, 1, 2.0, TABLE, w, dw, 0, &out), SPH_ERR_NUMERIC);
  fill_table(w, dw, -1.0);
  check_status(sph_kernel_create_table(ctx, 1, 2.0, TABLE, w, dw, 1, &out), SPH_ERR_NUMERIC);
  fill_table(w, dw, 0.0);
  check_status(sph_kernel_create_table(ctx, 1, 2.0, TABLE, w, dw, 1, &out), SPH_ERR_NUMERIC);
  fill_table(w, dw, 1.0);
  w[37] = NAN;
  check_status(sph_kernel_create_table(ctx, 1, 2.0, TABLE, w, dw, 1, &out), SPH_ERR_NUMERIC);
  assert_true(strstr(sph_context_last_error(ctx), "37") != NULL);
  fill_table(w, dw, 1.0);
  dw[TABLE - 1] = INFINITY;
  check_status(sph_kernel_create_table(ctx, 1, 2.0, TABLE, w, dw, 1, &out), SPH_ERR_NUMERIC);
  assert_null(out);
  sph_context_destroy(ctx);
}

/* ---- life time and memory ------------------------------------------------------------------- */

static void test_outlives_context(void **state) {
  (void)state;
  sph_context *ctx = oom_context();
  sph_kernel *kernel = make(ctx, SPH_KERNEL_CUBIC_SPLINE, 1);
  sph_context_destroy(ctx); /* the kernel holds the context */
  check_rel(sph_kernel_w(kernel, 0.0, 1.0), 2.0 / 3.0, 1e-15);
  sph_kernel_destroy(kernel);
  oom_check_clean();
}

static sph_status create_all(sph_context *ctx, void *user) {
  double w[TABLE], dw[TABLE], alpha = 1.0;
  sph_kernel *a = NULL, *b = NULL, *c = NULL;
  (void)user;
  fill_table(w, dw, 2.0);
  sph_status status = sph_kernel_create(ctx, SPH_KERNEL_GAUSSIAN, 3, &a);
  if (status == SPH_OK) status = sph_kernel_create_callback(ctx, 1, 2.0, cubic_profile, &alpha, &b);
  if (status == SPH_OK) status = sph_kernel_create_table(ctx, 2, 2.0, TABLE, w, dw, 1, &c);
  if (status != SPH_OK) assert_null(c);
  sph_kernel_destroy(a);
  sph_kernel_destroy(b);
  sph_kernel_destroy(c);
  return status;
}

static void test_out_of_memory(void **state) {
  (void)state;
  oom_sweep(create_all, NULL);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_names),
    cmocka_unit_test(test_queries),
    cmocka_unit_test(test_create_arguments),
    cmocka_unit_test(test_null),
    cmocka_unit_test(test_other_handle),
    cmocka_unit_test(test_bad_numbers),
    cmocka_unit_test(test_evaluate),
    cmocka_unit_test(test_evaluate_arguments),
    cmocka_unit_test(test_equal_h),
    cmocka_unit_test(test_callback),
    cmocka_unit_test(test_callback_arguments),
    cmocka_unit_test(test_table),
    cmocka_unit_test(test_table_arguments),
    cmocka_unit_test(test_table_values),
    cmocka_unit_test(test_outlives_context),
    cmocka_unit_test(test_out_of_memory),
};

SPH_TEST_MAIN(tests)
