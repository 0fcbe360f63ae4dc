/* Artificial stress: the pointwise tensor against two independent formulas, and its properties;
 * the term's power and spacing. That the term is the pair sum of these tensors is tested with the
 * other terms. */
#include "../rhs_help.h"

/* The angle form as published, He 2015 (3.23) to (3.26), with atan2. */
static void angle_form(const double *s, double rho, double epsilon, double *R) {
  double theta = 0.5 * atan2(2.0 * s[2], s[0] - s[1]), c = cos(theta), n = sin(theta);
  double sx = c * c * s[0] + 2.0 * n * c * s[2] + n * n * s[1];
  double sy = n * n * s[0] - 2.0 * n * c * s[2] + c * c * s[1];
  double rx = sx > 0.0 ? -epsilon * sx / (rho * rho) : 0.0;
  double ry = sy > 0.0 ? -epsilon * sy / (rho * rho) : 0.0;
  R[0] = rx * c * c + ry * n * n;
  R[1] = rx * n * n + ry * c * c;
  R[2] = (rx - ry) * n * c;
}

static void unpack(const double *s, double A[3][3]) {
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) A[a][b] = s[rh_sym(3, a, b)];
}

static void product(double A[3][3], double B[3][3], double C[3][3]) {
  double out[3][3];
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++)
      out[a][b] = A[a][0] * B[0][b] + A[a][1] * B[1][b] + A[a][2] * B[2][b];
  memcpy(C, out, sizeof out);
}

static double cofactor(double A[3][3], int a, int b) {
  int p = (a + 1) % 3, q = (a + 2) % 3, r = (b + 1) % 3, t = (b + 2) % 3;
  return A[p][r] * A[q][t] - A[p][t] * A[q][r];
}

/* Newton's iteration for the matrix sign: X <- (c X + (c X)^-1) / 2, c = |det|^(-1/3). No
 * eigenvalue or eigenvector is ever formed. */
static void matrix_sign(double A[3][3], double X[3][3]) {
  memcpy(X, A, 9 * sizeof(double));
  for (int k = 0; k < 60; k++) {
    double det = 0.0, next[3][3];
    for (int b = 0; b < 3; b++) det += X[0][b] * cofactor(X, 0, b);
    double c = cbrt(1.0 / fabs(det));
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) next[a][b] = 0.5 * (c * X[a][b] + cofactor(X, b, a) / det / c);
    memcpy(X, next, sizeof next);
  }
}

/* R = -(epsilon / rho^2) times the positive part of sigma, (sigma + |sigma|) / 2 with
 * |sigma| = sigma sign(sigma). */
static void sign_form(const double *s, double rho, double epsilon, double *R) {
  double A[3][3], S[3][3], P[3][3];
  unpack(s, A);
  matrix_sign(A, S);
  product(A, S, P);
  for (int a = 0; a < 3; a++)
    for (int b = a; b < 3; b++)
      R[rh_sym(3, a, b)] = -epsilon / (rho * rho) * 0.5 * (A[a][b] + P[a][b]);
}

static void turn(int dim, double Q[3][3], const double *s, double *out) {
  for (int a = 0; a < dim; a++)
    for (int b = a; b < dim; b++) {
      double sum = 0.0;
      for (int k = 0; k < dim; k++)
        for (int l = 0; l < dim; l++) sum += Q[a][k] * s[rh_sym(dim, k, l)] * Q[b][l];
      out[rh_sym(dim, a, b)] = sum;
    }
}

/* A rotation, from a random quaternion in 3-D. */
static void rotation(int dim, double Q[3][3]) {
  double q[4], size = 0.0;
  memset(Q, 0, 9 * sizeof(double));
  for (int k = 0; k < 4; k++) {
    q[k] = dim == 2 && (k == 1 || k == 2) ? 0.0 : rh_random(-1.0, 1.0);
    size += q[k] * q[k];
  }
  for (int k = 0; k < 4; k++) q[k] /= sqrt(size);
  double w = q[0], x = q[1], y = q[2], z = q[3];
  double all[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                      {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                      {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
  memcpy(Q, all, sizeof all);
}

static void random_tensor(double *s) {
  for (int k = 0; k < 6; k++) s[k] = rh_random(-1.0, 1.0);
}

static void close_all(const double *a, const double *b, int n, double tol) {
  for (int k = 0; k < n; k++) check_close(a[k], b[k], tol);
}

/* As the library has it, with rho as a uniform value. */
static void ask(int32_t dim, const double *s, double rho, double epsilon, double *R) {
  check_ok(sph_artificial_stress(dim, 1, s, NULL, rho, epsilon, R));
}

static void test_one_dimension(void **state) {
  (void)state;
  double s[3] = {2.0, -2.0, 0.0}, rho[3] = {0.5, 0.5, 1.0}, R[3];
  check_ok(sph_artificial_stress(1, 3, s, rho, 0.0, 0.3, R));
  check_close(R[0], -0.3 * 2.0 / 0.25, 1e-15);
  assert_true(R[1] == 0.0 && R[2] == 0.0);
}

static void test_angle_form(void **state) {
  (void)state;
  rh_seed = 1;
  for (int k = 0; k < 20000; k++) {
    double s[6], want[3], got[3], rho = rh_random(0.5, 2.0);
    random_tensor(s);
    angle_form(s, rho, 0.3, want);
    ask(2, s, rho, 0.3, got);
    close_all(got, want, 3, 1e-14);
  }
}

static void test_matrix_sign(void **state) {
  (void)state;
  rh_seed = 2;
  for (int k = 0; k < 20000; k++) {
    double s[6], want[6], got[6], rho = rh_random(0.5, 2.0);
    random_tensor(s);
    sign_form(s, rho, 0.3, want);
    ask(3, s, rho, 0.3, got);
    close_all(got, want, 6, 2e-13);
  }
}

/* The plane part of a tensor without out-of-plane shear is the plane result. */
static void test_plane_in_space(void **state) {
  (void)state;
  rh_seed = 3;
  for (int k = 0; k < 1000; k++) {
    double s[6], plane[3], space[6];
    random_tensor(s);
    s[4] = s[5] = 0.0;
    double flat[3] = {s[0], s[1], s[3]};
    ask(2, flat, 1.0, 0.5, plane);
    ask(3, s, 1.0, 0.5, space);
    check_close(space[0], plane[0], 1e-14);
    check_close(space[1], plane[1], 1e-14);
    check_close(space[3], plane[2], 1e-14);
    check_close(space[2], s[2] > 0.0 ? -0.5 * s[2] : 0.0, 1e-14);
    check_close(space[4], 0.0, 1e-14);
    check_close(space[5], 0.0, 1e-14);
  }
}

static void test_rotation(void **state) {
  (void)state;
  rh_seed = 4;
  for (int k = 0; k < 5000; k++)
    for (int32_t dim = 2; dim <= 3; dim++) {
      double s[6], R[6], turned[6], of_turned[6], turned_R[6], Q[3][3];
      int n = dim * (dim + 1) / 2;
      random_tensor(s);
      rotation(dim, Q);
      turn(dim, Q, s, turned);
      ask(dim, s, 1.0, 0.3, R);
      ask(dim, turned, 1.0, 0.3, of_turned);
      turn(dim, Q, R, turned_R);
      close_all(of_turned, turned_R, n, 1e-14);
    }
}

/* diag(p) turned: the principal values are known, repeated ones as well. */
static void check_principal(int32_t dim, const double *p) {
  for (int k = 0; k < 500; k++) {
    double Q[3][3], s[6], want[6], got[6], diagonal[6] = {p[0], p[1], p[2], 0, 0, 0};
    double cured[6] = {0.0};
    int n = dim * (dim + 1) / 2;
    if (dim == 2) diagonal[2] = 0.0;
    for (int a = 0; a < dim; a++) cured[a] = p[a] > 0.0 ? -0.3 * p[a] : 0.0;
    rotation(dim, Q);
    turn(dim, Q, diagonal, s);
    turn(dim, Q, cured, want);
    ask(dim, s, 1.0, 0.3, got);
    close_all(got, want, n, 2e-15 * (fabs(p[0]) + fabs(p[1]) + fabs(p[2])));
  }
}

static void test_repeated(void **state) {
  (void)state;
  static const double two[][3] = {{1, 1, 0}, {-1, -1, 0}, {1, 1 + 1e-9, 0}, {1, 0, 0}, {1, -1, 0}};
  static const double three[][3] = {
      {1, 1, 1}, {1, 1, 2},     {1, 1, -2},      {-1, -1, 2},        {1, 1 + 1e-8, 1 - 1e-8},
      {3, 0, 0}, {3, 3, 0},     {1e9, 1e9, 1.0}, {1, 1 + 1e-15, -1}, {2, -2, 0},
      {0, 0, 0}, {1e-8, 1, 1e8}};
  rh_seed = 5;
  for (size_t k = 0; k < sizeof two / sizeof *two; k++) check_principal(2, two[k]);
  for (size_t k = 0; k < sizeof three / sizeof *three; k++) check_principal(3, three[k]);
}

/* Pure compression gives nothing at all; pure tension gives -epsilon sigma / rho^2. */
static void test_definite(void **state) {
  (void)state;
  rh_seed = 6;
  for (int k = 0; k < 2000; k++)
    for (int32_t dim = 1; dim <= 3; dim++) {
      double Q[3][3], s[6], R[6], p[6] = {0.0};
      int n = dim * (dim + 1) / 2;
      double sign = k % 2 ? 1.0 : -1.0;
      for (int a = 0; a < dim; a++) p[a] = sign * rh_random(0.1, 2.0);
      rotation(dim, Q);
      if (dim == 1) Q[0][0] = 1.0;
      turn(dim, Q, p, s);
      ask(dim, s, 2.0, 0.4, R);
      for (int c = 0; c < n; c++)
        if (sign < 0.0)
          assert_true(R[c] == 0.0);
        else
          check_close(R[c], -0.1 * s[c], 1e-15);
    }
}

/* The result may overwrite the stress; no particles, no arrays; a NaN stays with its particle. */
static void test_arrays(void **state) {
  (void)state;
  rh_seed = 7;
  for (int32_t dim = 1; dim <= 3; dim++) {
    double s[6 * 50], R[6 * 50], rho[50];
    int n = dim * (dim + 1) / 2;
    for (int k = 0; k < 6 * 50; k++) s[k] = rh_random(-1.0, 1.0);
    for (int k = 0; k < 50; k++) rho[k] = rh_random(0.5, 2.0);
    check_ok(sph_artificial_stress(dim, 50, s, rho, 0.0, 0.3, R));
    check_ok(sph_artificial_stress(dim, 50, s, rho, 0.0, 0.3, s));
    assert_memory_equal(s, R, sizeof(double) * 50 * (size_t)n);
    check_ok(sph_artificial_stress(dim, 0, NULL, NULL, 0.0, 0.3, NULL));
    for (int k = 0; k < 3 * n; k++) s[k] = 1.0;
    s[n] = NAN;
    check_ok(sph_artificial_stress(dim, 3, s, NULL, 1.0, 0.3, R));
    assert_true(isnan(R[n]));
    for (int k = 0; k < n; k++) assert_true(isfinite(R[k]) && isfinite(R[2 * n + k]));
  }
}

static void test_refusals(void **state) {
  (void)state;
  double s[6] = {1, 1, 1, 0, 0, 0}, R[6] = {7, 7, 7, 7, 7, 7}, rho = 1.0;
  check_status(sph_artificial_stress(0, 1, s, &rho, 0.0, 0.3, R), SPH_ERR_ARG);
  check_status(sph_artificial_stress(4, 1, s, &rho, 0.0, 0.3, R), SPH_ERR_ARG);
  check_status(sph_artificial_stress(3, -1, s, &rho, 0.0, 0.3, R), SPH_ERR_ARG);
  check_status(sph_artificial_stress(3, 1, NULL, &rho, 0.0, 0.3, R), SPH_ERR_ARG);
  check_status(sph_artificial_stress(3, 1, s, &rho, 0.0, 0.3, NULL), SPH_ERR_ARG);
  check_status(sph_artificial_stress(3, 1, s, NULL, 0.0, 0.3, R), SPH_ERR_ARG);
  check_status(sph_artificial_stress(3, 1, s, NULL, -1.0, 0.3, R), SPH_ERR_ARG);
  check_status(sph_artificial_stress(3, 1, s, NULL, NAN, 0.3, R), SPH_ERR_ARG);
  check_status(sph_artificial_stress(3, 1, s, &rho, 0.0, NAN, R), SPH_ERR_ARG);
  check_status(sph_artificial_stress(3, 1, s, &rho, 0.0, INFINITY, R), SPH_ERR_ARG);
  for (int k = 0; k < 6; k++) assert_true(R[k] == 7.0);
}

/* Every power, and spacings on both sides of the inner kink of the spline. */
static void test_power_and_spacing(void **state) {
  (void)state;
  static const double ratios[] = {0.3, 0.6667, 1.0, 1.4};
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int vary = 0; vary < 2; vary++) {
      rh_system s = rh_make(ctx, dim, rh_side(dim), vary ? RH_VARY_ALL : 0, 8);
      for (int32_t power = 1; power <= 16; power++) {
        sph_term t = rh_term(SPH_TERM_ARTIFICIAL_STRESS, 0, power % 2);
        double *want = rh_array(s.rows * dim), *matrix = rh_array(s.n * 9);
        t.power = power;
        t.spacing_ratio = ratios[power % 4];
        sph_operands a = rh_operands(&s, t.corrected ? matrix : NULL);
        rh_artificial(&s, &a, &t, want);
        sph_rhs *rhs = rh_rhs(&s);
        check_ok(sph_rhs_add(rhs, &t));
        double *got = rh_rates(&s, rhs, SPH_FIELD_V), size = rh_largest(want, s.rows * dim);
        for (int64_t k = 0; k < s.rows * dim; k++) check_close(got[k], want[k], 1e-12 * size);
        free(want);
        free(matrix);
        free(got);
        sph_rhs_destroy(rhs);
      }
      rh_free(&s);
    }
  sph_context_destroy(ctx);
}

/* The cure scales with epsilon and is silent in compression. */
static void test_compressed_body(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 3, 5, RH_VARY_M, 9);
  sph_term t = rh_term(SPH_TERM_ARTIFICIAL_STRESS, 0, 0);
  sph_rhs *rhs = rh_rhs(&s);
  check_ok(sph_rhs_add(rhs, &t));
  double *sigma = rh_field(&s, SPH_FIELD_SIGMA);
  for (int64_t k = 0; k < s.n * 6; k++) sigma[k] = k % 6 < 3 ? -3.0 : rh_random(-1.0, 1.0);
  double *got = rh_rates(&s, rhs, SPH_FIELD_V);
  assert_true(rh_largest(got, s.rows * 3) == 0.0);
  free(got);
  sph_rhs_destroy(rhs);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* The bits of a particle do not depend on those beside it, or they would depend on how the loop is
 * cut for threads. Diagonal stresses need no turn, general ones several. */
static void test_alone(void **state) {
  enum { MANY = 64 };
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) {
    double sigma[MANY * 6], together[MANY * 6], alone[6], rho[MANY];
    int c = sph_sym_components(dim);
    for (int i = 0; i < MANY; i++) {
      rho[i] = rh_random(0.5, 2.0);
      for (int k = 0; k < c; k++)
        sigma[i * c + k] = i % 3 == 0 && k >= dim ? 0.0 : rh_random(-1.0, 1.0);
    }
    check_ok(sph_artificial_stress(dim, MANY, sigma, rho, 0.0, 0.3, together));
    for (int i = 0; i < MANY; i++) {
      check_ok(sph_artificial_stress(dim, 1, sigma + i * c, rho + i, 0.0, 0.3, alone));
      assert_memory_equal(alone, together + i * c, (size_t)c * sizeof *alone);
    }
  }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_one_dimension),   cmocka_unit_test(test_angle_form),
    cmocka_unit_test(test_matrix_sign),     cmocka_unit_test(test_plane_in_space),
    cmocka_unit_test(test_rotation),        cmocka_unit_test(test_repeated),
    cmocka_unit_test(test_definite),        cmocka_unit_test(test_arrays),
    cmocka_unit_test(test_refusals),        cmocka_unit_test(test_power_and_spacing),
    cmocka_unit_test(test_compressed_body), cmocka_unit_test(test_alone),
};
SPH_TEST_MAIN(tests)
