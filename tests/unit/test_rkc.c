/* Runge-Kutta-Chebyshev as numbers: coefficients, intervals, amplification, stage counts. */
#include "check.h"

#include <sph/integrator.h>

enum { MOST = 1001 };
typedef struct table {
  double mu[MOST], nu[MOST], mu_t[MOST], gamma_t[MOST], c[MOST];
} table;

static void fill(table *k, int32_t s, int32_t b1) {
  check_ok(sph_rkc_coefficients(s, b1, k->mu, k->nu, k->mu_t, k->gamma_t, k->c));
}

static void check_row(const double *got, int first, int last, const double *want) {
  for (int k = first; k <= last; ++k) check_close(got[k], want[k - first], 1e-11);
}

/* ---- reference coefficients, twelve decimals --------------------------------------------- */

static void test_two_stages(void **state) {
  static const double mu_t[] = {1.0, 0.5}, mu[] = {0.5}, nu[] = {-1.0}, gamma_t[] = {0.0};
  static const double c[] = {1.0, 1.0};
  table k;
  (void)state;
  fill(&k, 2, SPH_RKC_B1_INVERSE_W0);
  check_row(k.mu_t, 1, 2, mu_t);
  check_row(k.mu, 2, 2, mu);
  check_row(k.nu, 2, 2, nu);
  check_row(k.gamma_t, 2, 2, gamma_t);
  check_row(k.c, 1, 2, c);
  check_close((1.0 + 2.0 / 13.0 / 4.0 + 1.0) / sph_rkc_beta(2), 1.038461538462, 1e-11);
}

static void test_three_stages(void **state) {
  static const double mu_t[] = {.379166372431, .189583186216, .879121561324};
  static const double mu[] = {.5, 2.318564158754}, nu[] = {-1, -.280160518053};
  static const double gamma_t[] = {0, -.652015675319};
  static const double c[] = {.379166372431, .379166372431, 1};
  table k;
  (void)state;
  fill(&k, 3, SPH_RKC_B1_INVERSE_W0);
  check_row(k.mu_t, 1, 3, mu_t);
  check_row(k.mu, 2, 3, mu);
  check_row(k.nu, 2, 3, nu);
  check_row(k.gamma_t, 2, 3, gamma_t);
  check_row(k.c, 1, 3, c);
  check_close((2.0 + 2.0 / 13.0 / 9.0) / sph_rkc_beta(3), .385647848883, 1e-11);
}

static void test_five_stages(void **state) {
  static const double mu_t[] = {.127122315347, .063561157673, .298892036911, .264501915438,
                                .255406793882};
  static const double mu[] = {.5, 2.351216118863, 2.080688309652, 2.009142086384};
  static const double nu[] = {-1, -.290317877464, -1.208122027445, -1.032354614854};
  static const double gamma_t[] = {0, -.223257779995, -.183920235940, -.171588124378};
  static const double c[] = {.127122315347, .127122315347, .337620413057, .629485256695, 1};
  table k;
  (void)state;
  fill(&k, 5, SPH_RKC_B1_INVERSE_W0);
  check_row(k.mu_t, 1, 5, mu_t);
  check_row(k.mu, 2, 5, mu);
  check_row(k.nu, 2, 5, nu);
  check_row(k.gamma_t, 2, 5, gamma_t);
  check_row(k.c, 1, 5, c);
  check_close((2.0 + 2.0 / 13.0 / 25.0) / sph_rkc_beta(5), .127904606518, 1e-11);
}

static void test_three_stages_equal_b2(void **state) {
  static const double mu_t[] = {.093198457089, .771295697766, .879121561324};
  static const double mu[] = {2.034188034188, 2.318564158754}, nu[] = {-1, -1.139798346950};
  static const double gamma_t[] = {-.581712511551, -.652015675319};
  static const double c[] = {.093198457089, .379166372431, 1};
  table k;
  (void)state;
  fill(&k, 3, SPH_RKC_B1_EQUAL_B2);
  check_row(k.mu_t, 1, 3, mu_t);
  check_row(k.mu, 2, 3, mu);
  check_row(k.nu, 2, 3, nu);
  check_row(k.gamma_t, 2, 3, gamma_t);
  check_row(k.c, 1, 3, c);
}

/* ---- properties for many s --------------------------------------------------------------- */

/* The scheme itself on y' = lambda y, z = dt lambda. */
static void run_scheme(const table *k, int32_t s, double zr, double zi, double *re, double *im) {
  double yr = 1.0 + k->mu_t[1] * zr, yi = k->mu_t[1] * zi, qr = 1.0, qi = 0.0;
  for (int32_t j = 2; j <= s; ++j) {
    double rest = 1.0 - k->mu[j] - k->nu[j];
    double fr = zr * yr - zi * yi, fi = zr * yi + zi * yr;
    double nr = k->mu[j] * yr + k->nu[j] * qr + rest + k->mu_t[j] * fr + k->gamma_t[j] * zr;
    double ni = k->mu[j] * yi + k->nu[j] * qi + k->mu_t[j] * fi + k->gamma_t[j] * zi;
    qr = yr;
    qi = yi;
    yr = nr;
    yi = ni;
  }
  *re = yr;
  *im = yi;
}

/* Both choices of b_1 have the polynomial that sph_rkc_amplification() states. */
static void test_scheme_has_the_polynomial(void **state) {
  static const double z[][2] = {{-0.3, 0}, {0, 0.4}, {-1.2, 0.3}, {0.2, 0.1}, {-1.9, 0}};
  static const int32_t stages[] = {2, 3, 4, 5, 8, 10, 20, 50, 100};
  table k;
  (void)state;
  for (int32_t b1 = 1; b1 <= 2; ++b1)
    for (size_t i = 0; i < sizeof stages / sizeof stages[0]; ++i)
      for (size_t m = 0; m < sizeof z / sizeof z[0]; ++m) {
        double re, im, s = stages[i];
        fill(&k, stages[i], b1);
        run_scheme(&k, stages[i], z[m][0], z[m][1], &re, &im);
        check_close(hypot(re, im), sph_rkc_amplification(stages[i], z[m][0], z[m][1]),
                    1e-14 * s * s);
      }
}

/* P - exp = O(z^3), with the remainder (c3 - 1/6) z^3 of order 2 exactly. */
static void test_order_two(void **state) {
  table k;
  (void)state;
  for (int32_t s = 2; s <= 30; ++s)
    for (int32_t b1 = 1; b1 <= 2; ++b1) {
      double re, im, error[2];
      fill(&k, s, b1);
      for (int m = 0; m < 2; ++m) {
        double a = m ? 0.01 : 0.02;
        run_scheme(&k, s, -0.6 * a, 0.8 * a, &re, &im);
        error[m] = hypot(re - exp(-0.6 * a) * cos(0.8 * a), im - exp(-0.6 * a) * sin(0.8 * a));
      }
      check_close(log2(error[0] / error[1]), 3.0, 0.02);
      assert_true(error[1] < 0.17 * 1e-6);
    }
}

/* U' = t^p: the nodes must integrate 1 and t exactly, which a plus sign in gamma~ would not. */
static void test_quadrature(void **state) {
  table k;
  (void)state;
  for (int32_t s = 2; s <= 30; ++s)
    for (int32_t b1 = 1; b1 <= 2; ++b1)
      for (int p = 0; p <= 1; ++p) {
        fill(&k, s, b1);
        double y = p ? 0.0 : k.mu_t[1], old = 0.0;
        for (int32_t j = 2; j <= s; ++j) {
          double f = p ? k.c[j - 1] : 1.0, f0 = p ? 0.0 : 1.0;
          double next = k.mu[j] * y + k.nu[j] * old + k.mu_t[j] * f + k.gamma_t[j] * f0;
          old = y;
          y = next;
        }
        check_close(y, p ? 0.5 : 1.0, 1e-12);
      }
}

static void test_nodes_ascend_and_end_at_one(void **state) {
  static const int32_t stages[] = {2, 3, 7, 40, 300, 1000};
  table k;
  (void)state;
  for (size_t i = 0; i < sizeof stages / sizeof stages[0]; ++i)
    for (int32_t b1 = 1; b1 <= 2; ++b1) {
      int32_t s = stages[i];
      fill(&k, s, b1);
      for (int32_t j = 3; j <= s; ++j) assert_true(k.c[j] > k.c[j - 1]);
      assert_true(k.c[s] == 1.0);
      assert_true(k.c[0] == 0.0 && k.mu[0] == 0.0 && k.mu[1] == 0.0 && k.nu[1] == 0.0);
      assert_true(k.gamma_t[1] == 0.0 && k.mu_t[0] == 0.0);
    }
}

static void test_single_arrays(void **state) {
  table all;
  double one[6];
  (void)state;
  fill(&all, 5, 1);
  check_ok(sph_rkc_coefficients(5, 1, NULL, NULL, NULL, one, NULL));
  assert_memory_equal(one, all.gamma_t, sizeof one);
  check_ok(sph_rkc_coefficients(5, 1, NULL, NULL, NULL, NULL, NULL));
}

/* ---- stability --------------------------------------------------------------------------- */

static void test_beta(void **state) {
  (void)state;
  check_close(sph_rkc_beta(2), 1.963, 5e-4);
  check_close(sph_rkc_beta(3), 5.230, 5e-4);
  check_close(sph_rkc_beta(4), 9.804, 5e-4);
  check_close(sph_rkc_beta(5), 15.685, 5e-4);
  check_close(sph_rkc_beta(10), 64.69, 5e-3);
  for (int32_t s = 20; s <= 1000; s += 70) {
    double square = (double)s * (double)s - 1.0;
    check_rel(sph_rkc_beta(s), 0.653 * square, 1e-3);
    check_rel(sph_rkc_beta(s), 2.0 / 3.0 * square * (1.0 - 4.0 / 195.0), 1e-3);
  }
}

/* The stage rule must never choose an interval that is too short. */
static void test_rule_stays_inside(void **state) {
  (void)state;
  for (double load = 0.0; load < 5e5; load = 1.01 * load + 0.01)
    assert_true(sph_rkc_beta(sph_rkc_stages_radius(1.0, load)) > load * (1.0 - 1e-4));
}

/* |P| <= 1 - eps/3 or so over the interval, away from 0. */
static void test_damping(void **state) {
  (void)state;
  for (int32_t s = 2; s <= 60; ++s) {
    double beta = sph_rkc_beta(s), worst = 0.0;
    for (int m = 0; m <= 4000; ++m) {
      double p = sph_rkc_amplification(s, -beta * m / 4000.0, 0.0);
      assert_true(p <= 1.0 + 1e-12);
      if (m > 2000 && p > worst) worst = p;
    }
    assert_true(worst < 1.0 - 0.03);
  }
}

static double crossing(int32_t s) {
  double low = sph_rkc_beta(s), high = 2.0 * low;
  while (sph_rkc_amplification(s, -low, 0.0) <= 1.0 && low < high) low += 1e-4;
  return low;
}

static void test_first_crossing(void **state) {
  (void)state;
  check_close(crossing(2), 2.000, 1e-3);
  check_close(crossing(3), 6.180, 1e-3);
  check_close(crossing(4), 9.851, 1e-3);
  check_close(crossing(5), 16.60, 5e-3);
  check_close(crossing(10), 64.74, 5e-3);
}

/* |P(i y)| = 1 + k y^4, weakly unstable for every s. */
static double imaginary_k(int32_t s) {
  double y = 0.02;
  return (sph_rkc_amplification(s, 0.0, y) - 1.0) / pow(y, 4.0);
}

static void test_imaginary_axis(void **state) {
  static const int32_t s[] = {2, 3, 4, 5, 10, 20};
  static const double k[] = {.125, .062, .048, .043, .037, .035};
  (void)state;
  for (int m = 0; m < 6; ++m) check_close(imaginary_k(s[m]), k[m], 6e-4);
}

/* Growth per step of the highest wave mode of the bar, kappa dp = 0.697. */
static void test_wave_growth(void **state) {
  static const double cfl[] = {0.6, 1.0, 1.2, 2.5}, growth[] = {1.0019, 1.0147, 1.024, 1.357};
  static const double tolerance[] = {1e-4, 3e-4, 1e-3, 3e-3};
  (void)state;
  for (int m = 0; m < 4; ++m) {
    int32_t s = sph_rkc_stages_cfl(cfl[m], 1.0, 1.0);
    check_close(sph_rkc_amplification(s, 0.0, 0.697 * cfl[m]), growth[m], tolerance[m]);
  }
}

/* ---- stage counts ------------------------------------------------------------------------ */

static void test_published_counts(void **state) {
  static const double c = 5088.3966, cfl[] = {0.6, 1.0, 1.2, 2.5};
  static const int32_t by_cfl[] = {3, 3, 4, 5};
  static const struct {
    double dt_us, dp_mm;
    int32_t s;
  } curve[] = {{.157, 10, 2}, {.157, 4, 2}, {.157, 2, 3}, {.157, 1, 3},  {.236, 10, 2},
               {.236, 4, 2},  {.236, 2, 3}, {.236, 1, 4}, {.393, 10, 2}, {.393, 4, 3},
               {.393, 2, 3},  {.393, 1, 5}, {1.0, 10, 3}, {1.0, 4, 4},   {1.0, 2, 5},
               {2.0, 10, 3},  {2.0, 4, 5},  {2.0, 2, 7}};
  (void)state;
  for (int m = 0; m < 4; ++m) assert_int_equal(sph_rkc_stages_cfl(cfl[m], 1.0, 1.0), by_cfl[m]);
  for (size_t m = 0; m < sizeof curve / sizeof curve[0]; ++m)
    assert_int_equal(sph_rkc_stages_cfl(curve[m].dt_us * 1e-6, c, curve[m].dp_mm * 1e-3),
                     curve[m].s);
}

/* s = k for CFL in [0.131 ((k-1)^2 - 1), 0.131 (k^2 - 1)) */
static void test_interval_ends(void **state) {
  static const double end[] = {.393, 1.048, 1.965, 3.144, 4.585, 6.288, 8.253, 10.48, 12.969};
  (void)state;
  for (int m = 0; m < 9; ++m) {
    assert_int_equal(sph_rkc_stages_cfl(end[m] * (1.0 - 1e-12), 1.0, 1.0), m + 2);
    assert_int_equal(sph_rkc_stages_cfl(end[m] * (1.0 + 1e-12), 1.0, 1.0), m + 3);
  }
  for (int k = 2; k <= 50; ++k) {
    double load = 0.653 * (k * k - 1.0);
    assert_int_equal(sph_rkc_stages_radius(1.0, load * (1.0 - 1e-12)), k);
    assert_int_equal(sph_rkc_stages_radius(load * (1.0 + 1e-12), 1.0), k + 1);
  }
}

static void test_never_one_stage(void **state) {
  (void)state;
  assert_int_equal(sph_rkc_stages_cfl(0.0, 1.0, 1.0), 2);
  assert_int_equal(sph_rkc_stages_cfl(1.0, 0.0, 1.0), 2);
  assert_int_equal(sph_rkc_stages_radius(1.0, 0.0), 2);
}

static void test_bad_arguments(void **state) {
  table k;
  (void)state;
  k.mu[0] = 7.0;
  check_status(sph_rkc_coefficients(1, 1, k.mu, NULL, NULL, NULL, NULL), SPH_ERR_ARG);
  check_status(sph_rkc_coefficients(1001, 1, k.mu, NULL, NULL, NULL, NULL), SPH_ERR_ARG);
  check_status(sph_rkc_coefficients(3, 0, k.mu, NULL, NULL, NULL, NULL), SPH_ERR_ARG);
  check_status(sph_rkc_coefficients(3, 3, k.mu, NULL, NULL, NULL, NULL), SPH_ERR_ARG);
  assert_true(k.mu[0] == 7.0);
  assert_true(isnan(sph_rkc_beta(1)) && isnan(sph_rkc_beta(-3)) && isnan(sph_rkc_beta(1001)));
  assert_true(isnan(sph_rkc_amplification(1, 0.0, 0.0)));
  assert_true(isnan(sph_rkc_amplification(3, NAN, 0.0)));
  assert_int_equal(sph_rkc_stages_cfl(-1.0, 1.0, 1.0), -1);
  assert_int_equal(sph_rkc_stages_cfl(1.0, -1.0, 1.0), -1);
  assert_int_equal(sph_rkc_stages_cfl(1.0, 1.0, 0.0), -1);
  assert_int_equal(sph_rkc_stages_cfl(1.0, NAN, 1.0), -1);
  assert_int_equal(sph_rkc_stages_cfl(INFINITY, 1.0, 1.0), -1);
  assert_int_equal(sph_rkc_stages_cfl(1e200, 1e200, 1.0), -1);
  assert_int_equal(sph_rkc_stages_radius(1.0, -1.0), -1);
  assert_int_equal(sph_rkc_stages_radius(1.0, NAN), -1);
  assert_int_equal(sph_rkc_stages_radius(1.0, 1e19), -1);
  assert_true(sph_rkc_stages_radius(1.0, 1e17) > 300000000);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_two_stages),
    cmocka_unit_test(test_three_stages),
    cmocka_unit_test(test_five_stages),
    cmocka_unit_test(test_three_stages_equal_b2),
    cmocka_unit_test(test_scheme_has_the_polynomial),
    cmocka_unit_test(test_order_two),
    cmocka_unit_test(test_quadrature),
    cmocka_unit_test(test_nodes_ascend_and_end_at_one),
    cmocka_unit_test(test_single_arrays),
    cmocka_unit_test(test_beta),
    cmocka_unit_test(test_rule_stays_inside),
    cmocka_unit_test(test_damping),
    cmocka_unit_test(test_first_crossing),
    cmocka_unit_test(test_imaginary_axis),
    cmocka_unit_test(test_wave_growth),
    cmocka_unit_test(test_published_counts),
    cmocka_unit_test(test_interval_ends),
    cmocka_unit_test(test_never_one_stage),
    cmocka_unit_test(test_bad_arguments),
};
SPH_TEST_MAIN(tests)
