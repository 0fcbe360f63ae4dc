/* The bracketed root and the transport problem from within. */
#include "check.h"
#include "reference/reference_impl.h"

static int calls;
static double power_of(const void *user, double x) {
  ++calls;
  return pow(x, *(const double *)user) - 2.0;
}
static double jump(const void *user, double x) {
  (void)user;
  return x < 0.3 ? -1.0 : 1e30;
}
static double flat(const void *user, double x) {
  (void)user;
  return x * x * x * x * x;
}

/* To the last bits, from either end, in few steps. */
static void test_root(void **state) {
  (void)state;
  for (double n = 0.25; n < 40.0; n *= 1.7) {
    const double want = pow(2.0, 1.0 / n);
    calls = 0;
    check_rel(sphi_root(power_of, &n, 0.0, 20.0), want, 4e-16 * fmax(1.0, 1.0 / n));
    check_rel(sphi_root(power_of, &n, 20.0, 0.0), want, 4e-16 * fmax(1.0, 1.0 / n));
    assert_true(calls < 2 * 90);
  }
}

/* Where there is nothing to interpolate it halves; a root at an end is seen. */
static void test_rough(void **state) {
  (void)state;
  check_rel(sphi_root(jump, NULL, 0.0, 1.0), 0.3, 1e-15);
  check_rel(sphi_root(jump, NULL, -1e300, 1e300), 0.3, 1e-15);
  check_close(sphi_root(flat, NULL, -1.0, 3.0), 0.0, 1e-60);
  assert_true(sphi_root(flat, NULL, 0.0, 3.0) == 0.0);
  assert_true(sphi_root(flat, NULL, -3.0, 0.0) == 0.0);
}

/* Two sources, three sinks on a square, worked by hand: 3 units at (0, 0), 2 at (1, 0); to 1 at
 * (0, 1), 1 at (1, 1), 3 at (1, 0). The 2 stay, one of the 3 goes along the side, the others go up
 * and across: 1 + 1 + sqrt 2. The order of the points does not matter. */
static void test_by_hand(void **state) {
  (void)state;
  sph_context *ctx = NULL;
  check_ok(sph_context_create(NULL, &ctx));
  static const double x[2][4] = {{0, 0, 1, 0}, {1, 0, 0, 0}};
  static const int64_t mx[2][2] = {{3, 2}, {2, 3}}, my[2][3] = {{1, 1, 3}, {3, 1, 1}};
  static const double y[2][6] = {{0, 1, 1, 1, 1, 0}, {1, 0, 1, 1, 0, 1}};
  for (int a = 0; a < 2; a++)
    for (int b = 0; b < 2; b++) {
      const sphi_masses from = {2, x[a], mx[a]}, to = {3, y[b], my[b]};
      double cost = 0.0;
      check_ok(sphi_transport(ctx, 2, &from, &to, &cost));
      check_rel(cost, 2.0 + sqrt(2.0), 1e-15);
      check_ok(sphi_transport(ctx, 2, &to, &from, &cost));
      check_rel(cost, 2.0 + sqrt(2.0), 1e-15);
    }
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_root),
    cmocka_unit_test(test_rough),
    cmocka_unit_test(test_by_hand),
};
SPH_TEST_MAIN(tests)
