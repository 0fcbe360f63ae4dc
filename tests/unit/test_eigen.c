/* Eigen-decomposition of small symmetric matrices: A v = value v, an orthonormal frame to 1e-14 in
 * every case, repeated and nearly repeated eigenvalues, every scale of doubles, and eigenvalues
 * against those that were put in. */
#include "../../src/core/eigen.h"
#include "../check.h"

static uint64_t random_state = 5;
static double random_signed(void) { /* splitmix64, in (-1, 1) */
  uint64_t z = (random_state += UINT64_C(0x9e3779b97f4a7c15));
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  z ^= z >> 31;
  return (double)(z >> 11) * 0x1p-52 - 1;
}

static double entry(int dim, const double *packed, int a, int b) {
  static const int at[4][9] = {{0}, {0}, {0, 2, 2, 1}, {0, 3, 4, 3, 1, 5, 4, 5, 2}};
  return packed[at[dim][a * dim + b]];
}

/* Orthonormal, right-handed, descending, and A v = value v to `tolerance` of the largest entry. */
static void check_decomposition(int dim, const double *m, double tolerance) {
  double values[3], alone[3], v[9], scale = 0;
  int count = dim * (dim + 1) / 2;
  for (int k = 0; k < count; k++) scale = fmax(scale, fabs(m[k]));
  sphi_eigen_symmetric(dim, m, values, v);
  sphi_eigen_symmetric(dim, m, alone, NULL);
  for (int k = 0; k < dim; k++) assert_true(values[k] == alone[k]);
  for (int k = 0; k + 1 < dim; k++) assert_true(values[k] >= values[k + 1]);
  for (int i = 0; i < dim; i++)
    for (int j = 0; j < dim; j++) {
      double sum = 0, image = 0;
      for (int k = 0; k < dim; k++) sum += v[i * dim + k] * v[j * dim + k];
      check_close(sum, i == j, 1e-14);
      for (int k = 0; k < dim; k++) /* row i, vector j; halves against overflow */
        image += (0.5 * entry(dim, m, i, k)) * v[j * dim + k];
      if (!(fabs(image - 0.5 * values[j] * v[j * dim + i]) <= tolerance * scale))
        fail_msg("residual %g of %g at scale %g", image - 0.5 * values[j] * v[j * dim + i],
                 tolerance * scale, scale);
    }
  if (dim == 2) check_close(v[0] * v[3] - v[1] * v[2], 1, 1e-14);
  if (dim == 3)
    check_close(v[0] * (v[4] * v[8] - v[5] * v[7]) - v[1] * (v[3] * v[8] - v[5] * v[6]) +
                    v[2] * (v[3] * v[7] - v[4] * v[6]),
                1, 1e-14);
}

static void test_random(void **state) {
  (void)state;
  for (int dim = 1; dim <= 3; dim++)
    for (int trial = 0; trial < 5000; trial++) {
      double m[6];
      for (int k = 0; k < 6; k++) m[k] = random_signed();
      check_decomposition(dim, m, 2e-15);
    }
}

static void random_frame(double q[3][3]) {
  double a[3], norm = 0;
  for (int k = 0; k < 3; k++) a[k] = random_signed();
  norm = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  for (int i = 0; i < 3; i++) /* a reflection: orthogonal, symmetric */
    for (int j = 0; j < 3; j++) q[i][j] = (i == j) - 2 * a[i] * a[j] / (norm * norm);
}

static void compose(const double *values, double m[6]) {
  static const int row[] = {0, 1, 2, 0, 0, 1}, column[] = {0, 1, 2, 1, 2, 2};
  double q[3][3];
  random_frame(q);
  for (int c = 0; c < 6; c++) {
    m[c] = 0;
    for (int k = 0; k < 3; k++) m[c] += q[row[c]][k] * values[k] * q[column[c]][k];
  }
}

/* Pairs and triples that agree, or nearly: from a tenth down to below rounding. */
static void test_repeated(void **state) {
  (void)state;
  for (int power = 1; power <= 20; power++)
    for (int trial = 0; trial < 300; trial++) {
      double gap = pow(10, -power), m[6], got[3];
      const double sets[][3] = {{2, 1 + gap, 1},       {1 + gap, 1, -2}, {1 + gap, 1, 1 - gap},
                                {gap, 0, -gap},        {1, gap, -gap},   {1, 1, 1},
                                {1 + gap * gap, 1, 1}, {0, 0, -1},       {1, 0, 0}};
      for (size_t k = 0; k < sizeof sets / sizeof *sets; k++) {
        compose(sets[k], m);
        check_decomposition(3, m, 2e-15);
        sphi_eigen_symmetric(3, m, got, NULL);
        double scale = fmax(fabs(sets[k][0]), fabs(sets[k][2]));
        for (int c = 0; c < 3; c++) check_close(got[c], sets[k][c], 4e-15 * scale);
      }
    }
}

static void test_nearly_diagonal(void **state) {
  (void)state;
  for (int power = 0; power <= 323; power++)
    for (int trial = 0; trial < 20; trial++) {
      double off = pow(10, -power);
      const double three[6] = {
          1,  2 + random_signed(), random_signed(), off * random_signed(), off * random_signed(),
          off};
      const double equal[6] = {1, 1, 1, off * random_signed(), off, 0};
      const double two[3] = {1, 1 + off, off}, turned[3] = {-1, 1, off};
      check_decomposition(3, three, 2e-15);
      check_decomposition(3, equal, 2e-15);
      check_decomposition(2, two, 2e-15);
      check_decomposition(2, turned, 2e-15);
    }
}

static void test_scales(void **state) {
  (void)state;
  for (int exponent = -1000; exponent <= 1020; exponent += 20)
    for (int trial = 0; trial < 20; trial++) {
      double m[6], big[6], values[3], scaled[3];
      for (int k = 0; k < 6; k++) {
        m[k] = random_signed();
        big[k] = ldexp(m[k], exponent);
      }
      for (int dim = 1; dim <= 3; dim++) {
        check_decomposition(dim, big, 2e-15);
        sphi_eigen_symmetric(dim, m, values, NULL);
        sphi_eigen_symmetric(dim, big, scaled, NULL);
        for (int k = 0; k < dim; k++) assert_true(scaled[k] == ldexp(values[k], exponent));
      }
    }
  const double graded[6] = {1e300, 1, 1e-300, 1e100, 1e-100, 1e-200};
  const double denormal[6] = {4e-320, 5e-320, 6e-320, 3e-320, 2e-320, 1e-320};
  check_decomposition(3, graded, 2e-15);
  check_decomposition(3, denormal, 1e-3);
}

static void test_exact(void **state) {
  (void)state;
  const double zero[6] = {0}, diagonal[6] = {1, 3, -2}, ones[6] = {1, 1, 1, 1, 1, 1};
  double values[3], v[9];
  for (int dim = 1; dim <= 3; dim++) {
    sphi_eigen_symmetric(dim, zero, values, v);
    for (int k = 0; k < dim; k++) assert_true(values[k] == 0);
    for (int k = 0; k < dim * dim; k++) assert_true(v[k] == (k % (dim + 1) == 0));
  }
  sphi_eigen_symmetric(3, diagonal, values, v);
  assert_true(values[0] == 3 && values[1] == 1 && values[2] == -2);
  assert_true(fabs(v[1]) == 1 && fabs(v[3]) == 1 && fabs(v[8]) == 1);
  sphi_eigen_symmetric(3, ones, values, v);
  check_close(values[0], 3, 1e-15);
  check_close(values[1], 0, 1e-15);
  check_close(values[2], 0, 1e-15);
}

static void test_not_finite(void **state) {
  (void)state;
  const double bad[] = {NAN, INFINITY, -INFINITY};
  for (int dim = 1; dim <= 3; dim++)
    for (int b = 0; b < 3; b++)
      for (int at = 0; at < dim * (dim + 1) / 2; at++) {
        double m[6] = {1, 2, 3, 4, 5, 6}, values[3], v[9];
        m[at] = bad[b];
        sphi_eigen_symmetric(dim, m, values, v);
        for (int k = 0; k < dim; k++) assert_true(isnan(values[k]));
        for (int k = 0; k < dim * dim; k++) assert_true(isnan(v[k]));
      }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_random),          cmocka_unit_test(test_repeated),
    cmocka_unit_test(test_nearly_diagonal), cmocka_unit_test(test_scales),
    cmocka_unit_test(test_exact),           cmocka_unit_test(test_not_finite),
};
SPH_TEST_MAIN(tests)
