/* Laws for the smoothing length and the one h and W of a pair. */
#include "../check.h"

#include <stdlib.h>

#include <sph/sph.h>

enum { N = 10000 };

static const int32_t rules[] = {SPH_H_ARITHMETIC, SPH_H_HARMONIC, SPH_H_MAX, SPH_H_MIN,
                                SPH_H_AVERAGE};

static sph_context *context_of(int32_t threads) {
  sph_context_options o;
  sph_context *ctx = NULL;
  sph_context_options_init(&o);
  o.threads = threads;
  check_ok(sph_context_create(&o, &ctx));
  return ctx;
}

/* ---- laws -------------------------------------------------------------------------------- */

/* h^d rho, and with it the number of neighbours, is kept. */
static void test_density(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  const double h0[3] = {0.1, 2.0, 3.0}, rho0[3] = {1.0, 5.0, 8.0}, rho[3] = {8.0, 1.0, 8.0};
  for (int32_t dim = 1; dim <= 3; dim++) {
    double h[3];
    check_ok(sph_h_from_density(ctx, dim, 3, h0, rho0, rho, h));
    for (int i = 0; i < 3; i++)
      check_rel(pow(h[i], dim) * rho[i], pow(h0[i], dim) * rho0[i], 1e-14);
    check_close(h[2], 3.0, 0.0); /* nothing changed */
  }
  double cube[1];
  check_ok(sph_h_from_density(ctx, 3, 1, h0, rho0, rho, cube));
  check_close(cube[0], 0.05, 1e-16); /* eight times denser: half the length in 3-D */
  check_ok(sph_h_from_density(ctx, 3, 0, NULL, NULL, NULL, NULL));
  sph_context_destroy(ctx);
}

/* Particles of volume m / rho = 8: an edge of 8, sqrt 8 or 2. */
static void test_mass(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  const double m[2] = {4.0, 16.0}, rho[2] = {0.5, 2.0}, edge[] = {0.0, 8.0, sqrt(8.0), 2.0};
  for (int32_t dim = 1; dim <= 3; dim++) {
    double h[2];
    check_ok(sph_h_from_mass(ctx, dim, 2, 1.2, m, rho, h));
    for (int i = 0; i < 2; i++) check_rel(h[i], 1.2 * edge[dim], 1e-15);
  }
  sph_context_destroy(ctx);
}

/* h by Heun's rule over `steps` while rho = 2 + sin t, to t = 1. */
static double integrated(sph_context *ctx, int32_t dim, int steps) {
  double h = 0.3, dt = 1.0 / steps, k1, k2, half;
  for (int s = 0; s < steps; s++) {
    double t = s * dt, rho = 2.0 + sin(t), drho = cos(t);
    check_ok(sph_h_rate(ctx, dim, 1, &h, &rho, &drho, &k1));
    half = h + dt * k1;
    rho = 2.0 + sin(t + dt);
    drho = cos(t + dt);
    check_ok(sph_h_rate(ctx, dim, 1, &half, &rho, &drho, &k2));
    h += 0.5 * dt * (k1 + k2);
  }
  return h;
}

/* The differential form integrates to the algebraic one, with the integrator's order. */
static void test_rate(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  const double h0 = 0.3, rho0 = 2.0, rho = 2.0 + sin(1.0);
  for (int32_t dim = 1; dim <= 3; dim++) {
    double exact, coarse, fine;
    check_ok(sph_h_from_density(ctx, dim, 1, &h0, &rho0, &rho, &exact));
    coarse = fabs(integrated(ctx, dim, 20) - exact);
    fine = fabs(integrated(ctx, dim, 40) - exact);
    assert_true(coarse > 1e-8 && coarse < 1e-4);
    check_close(log2(coarse / fine), 2.0, 0.1);
  }
  sph_context_destroy(ctx);
}

static void test_spacing(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  double spacing[2] = {0.1, 0.05};
  check_ok(sph_h_from_spacing(ctx, 2, 1.5, spacing, spacing)); /* in place */
  check_close(spacing[0], 0.15, 1e-16);
  check_close(spacing[1], 0.075, 1e-16);
  sph_context_destroy(ctx);
}

static void test_threads(void **state) {
  (void)state;
  double *a = malloc(4 * N * sizeof *a), *b = a + N, *rho = b + N, *drho = rho + N;
  assert_non_null(a);
  for (int i = 0; i < N; i++) {
    rho[i] = 1.0 + 0.37 * (i % 97);
    drho[i] = sin(i);
  }
  for (int32_t threads = 1; threads <= 3; threads += 2) {
    sph_context *ctx = context_of(threads);
    double *out = threads == 1 ? a : b;
    check_ok(sph_h_from_spacing(ctx, N, 1.7, rho, out));
    check_ok(sph_h_from_density(ctx, 3, N, out, out, rho, out));
    check_ok(sph_h_rate(ctx, 3, N, out, rho, drho, out));
    sph_context_destroy(ctx);
  }
  assert_memory_equal(a, b, N * sizeof *a);
  free(a);
}

/* ---- pairs ------------------------------------------------------------------------------- */

static void test_pair_h(void **state) {
  (void)state;
  check_close(sph_pair_h(SPH_H_ARITHMETIC, 1.0, 3.0), 2.0, 0.0);
  check_close(sph_pair_h(SPH_H_HARMONIC, 1.0, 3.0), 1.5, 0.0);
  check_close(sph_pair_h(SPH_H_MAX, 1.0, 3.0), 3.0, 0.0);
  check_close(sph_pair_h(SPH_H_MIN, 1.0, 3.0), 1.0, 0.0);
  check_close(sph_pair_h(SPH_H_AVERAGE, 1.0, 3.0), 3.0, 0.0);
  for (int k = 0; k < 5; k++) {
    for (double x = 0.01; x < 5.0; x *= 1.3) {
      double h = sph_pair_h(rules[k], x, 0.7), swapped = sph_pair_h(rules[k], 0.7, x);
      assert_memory_equal(&h, &swapped, sizeof h);
      assert_true(h >= fmin(x, 0.7) * (1.0 - 1e-15) && h <= fmax(x, 0.7) * (1.0 + 1e-15));
    }
    check_close(sph_pair_h(rules[k], 0.3, 0.3), 0.3, 1e-16);
    assert_true(isnan(sph_pair_h(rules[k], 0.0, 1.0)) && isnan(sph_pair_h(rules[k], 1.0, -1.0)));
    assert_true(isnan(sph_pair_h(rules[k], NAN, 1.0)) &&
                isnan(sph_pair_h(rules[k], 1.0, INFINITY)));
  }
  assert_true(isnan(sph_pair_h(0, 1.0, 1.0)) && isnan(sph_pair_h(6, 1.0, 1.0)));
}

/* Two particles alone: what the density summation adds to the self term is m W_ij. */
static double summed(sph_context *ctx, sph_kernel *kernel, int32_t rule, double r, double h_i,
                     double h_j, int who) {
  double x[2] = {0.0, r}, h[2] = {h_i, h_j}, rho[2];
  sph_neighbors_options o;
  sph_neighbors *list = NULL;
  sph_operands a;
  sph_neighbors_options_init(&o);
  o.h_rule = rule;
  check_ok(sph_neighbors_create(ctx, &o, &list));
  check_ok(sph_neighbors_build_arrays(list, 1, 2, x, h, 0.0));
  sph_operands_init(&a);
  a.dim = 1;
  a.n = 2;
  a.x = x;
  a.h = h;
  a.m0 = 1.0;
  check_ok(sph_density_summation(list, kernel, &a, rho));
  sph_neighbors_destroy(list);
  return rho[who] - sph_kernel_w(kernel, 0.0, h[who]);
}

static void test_pair_w(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  sph_kernel *kernel = NULL;
  check_ok(sph_kernel_create(ctx, SPH_KERNEL_CUBIC_SPLINE, 1, &kernel));
  for (int k = 0; k < 5; k++)
    for (double r = 0.1; r < 3.0; r += 0.3) {
      double w = sph_pair_w(kernel, rules[k], r, 0.6, 1.1);
      double swapped = sph_pair_w(kernel, rules[k], r, 1.1, 0.6);
      double slope = sph_pair_dwdr(kernel, rules[k], r, 0.6, 1.1);
      check_rel(w, swapped, 1e-15);
      for (int who = 0; who < 2; who++)
        check_close(summed(ctx, kernel, rules[k], r, 0.6, 1.1, who), w, 1e-14);
      check_close((sph_pair_w(kernel, rules[k], r + 1e-6, 0.6, 1.1) -
                   sph_pair_w(kernel, rules[k], r - 1e-6, 0.6, 1.1)) /
                      2e-6,
                  slope, 1e-8);
    }
  check_close(sph_pair_w(kernel, SPH_H_AVERAGE, 0.5, 0.6, 1.1),
              0.5 * (sph_kernel_w(kernel, 0.5, 0.6) + sph_kernel_w(kernel, 0.5, 1.1)), 1e-16);
  assert_true(isnan(sph_pair_w(NULL, SPH_H_MAX, 0.1, 1.0, 1.0)));
  assert_true(isnan(sph_pair_w(kernel, SPH_H_MAX, -0.1, 1.0, 1.0)));
  assert_true(isnan(sph_pair_w(kernel, SPH_H_AVERAGE, 0.1, 1.0, 0.0)));
  assert_true(isnan(sph_pair_dwdr(kernel, 9, 0.1, 1.0, 1.0)));
  sph_kernel_destroy(kernel);
  sph_context_destroy(ctx);
}

/* ---- refusals ---------------------------------------------------------------------------- */

static void refused(sph_context *ctx, sph_status got, sph_status want, const char *words) {
  check_status(got, want);
  if (strstr(sph_context_last_error(ctx), words) == NULL)
    fail_msg("\"%s\" is not in \"%s\"", words, sph_context_last_error(ctx));
}

static void test_refusals(void **state) {
  (void)state;
  sph_context *ctx = context_of(1);
  double good[2] = {1.0, 2.0}, bad[2] = {1.0, -3.5}, nan[2] = {1.0, NAN}, out[2] = {7.0, 7.0};
  const sph_status arg = SPH_ERR_ARG, numeric = SPH_ERR_NUMERIC;
  refused(ctx, sph_h_from_density(ctx, 0, 2, good, good, good, out), arg, "dim = 0");
  refused(ctx, sph_h_from_density(ctx, 4, 2, good, good, good, out), arg, "dim = 4");
  refused(ctx, sph_h_from_density(ctx, 2, -1, good, good, good, out), arg, "n = -1");
  refused(ctx, sph_h_from_density(ctx, 2, 2, good, NULL, good, out), arg, "NULL");
  refused(ctx, sph_h_rate(ctx, 2, 2, good, good, NULL, out), arg, "NULL");
  refused(ctx, sph_h_from_spacing(ctx, 2, 1.5, good, NULL), arg, "NULL");
  refused(ctx, sph_h_from_spacing(ctx, 2, 0.0, good, out), arg, "ratio = 0");
  refused(ctx, sph_h_from_spacing(ctx, 2, NAN, good, out), arg, "ratio = nan");
  refused(ctx, sph_h_from_density(ctx, 2, 2, bad, good, good, out), numeric,
          "particle 1 has h = -3.5");
  refused(ctx, sph_h_from_density(ctx, 2, 2, good, good, nan, out), numeric, "rho = nan");
  refused(ctx, sph_h_rate(ctx, 2, 2, good, bad, good, out), numeric, "rho = -3.5");
  refused(ctx, sph_h_rate(ctx, 2, 2, good, good, nan, out), numeric, "d rho/dt = nan");
  refused(ctx, sph_h_from_spacing(ctx, 2, 1.5, bad, out), numeric, "spacing = -3.5");
  refused(ctx, sph_h_from_mass(ctx, 2, 2, -1.2, good, good, out), arg, "eta = -1.2");
  refused(ctx, sph_h_from_mass(ctx, 2, 2, 1.2, bad, good, out), numeric, "m = -3.5");
  refused(ctx, sph_h_from_mass(ctx, 2, 2, 1.2, good, nan, out), numeric, "rho = nan");
  check_ok(sph_h_rate(ctx, 2, 2, good, good, bad, out)); /* a rate may be negative */
  out[0] = out[1] = 7.0;
  check_status(sph_h_rate(ctx, 2, 2, bad, good, good, out), numeric);
  check_close(out[0] + out[1], 14.0, 0.0);
  check_status(sph_h_rate(NULL, 2, 2, good, good, good, out), arg);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_density), cmocka_unit_test(test_rate),     cmocka_unit_test(test_spacing),
    cmocka_unit_test(test_mass),    cmocka_unit_test(test_threads),  cmocka_unit_test(test_pair_h),
    cmocka_unit_test(test_pair_w),  cmocka_unit_test(test_refusals),
};
SPH_TEST_MAIN(tests)
