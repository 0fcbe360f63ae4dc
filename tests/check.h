/* The test harness: cmocka where it is installed, a small stand-in with the same macros where it
 * is not.
 *
 *   static void test_sum(void **state) { (void)state; check_close(1.0 + 1.0, 2.0, 0.0); }
 *   static const struct CMUnitTest tests[] = {cmocka_unit_test(test_sum)};
 *   SPH_TEST_MAIN(tests)
 *
 * A failed check ends its test, not the program. The program ends with the line
 * `N passed, N failed` under both harnesses and exits nonzero when a test failed. Run with the
 * argument `long`, check_long_run is 1: tests may then use larger sizes. With `short`, for slow
 * instrumentation, check_short_run is 1: the same paths with smaller ones. */
#ifndef SPH_TESTS_CHECK_H
#define SPH_TESTS_CHECK_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <sph/base.h>

#define CHECK_UNUSED __attribute__((unused))

static CHECK_UNUSED int check_long_run = 0, check_short_run = 0;

#ifdef SPH_HAVE_CMOCKA

#include <cmocka.h>

#define check_fail_here(file, line) _fail((file), (line))

#else

typedef void (*CMUnitTestFunction)(void **state);
typedef int (*CMFixtureFunction)(void **state);

struct CMUnitTest {
  const char *name;
  CMUnitTestFunction test_func;
  CMFixtureFunction setup_func;
  CMFixtureFunction teardown_func;
  void *initial_state;
};

#define cmocka_unit_test(f) \
  { #f, f, NULL, NULL, NULL }
#define cmocka_unit_test_setup(f, setup) \
  { #f, f, setup, NULL, NULL }
#define cmocka_unit_test_teardown(f, teardown) \
  { #f, f, NULL, teardown, NULL }
#define cmocka_unit_test_setup_teardown(f, setup, teardown) \
  { #f, f, setup, teardown, NULL }
#define cmocka_unit_test_prestate(f, state) \
  { #f, f, NULL, NULL, state }

static jmp_buf check_jump;
static volatile int check_skipped;

static CHECK_UNUSED __attribute__((noreturn)) void check_fail_here(const char *file, int line) {
  fprintf(stderr, "%s:%d: error: check failed\n", file, line);
  fflush(stderr);
  longjmp(check_jump, 1);
}

static CHECK_UNUSED __attribute__((noreturn)) void check_skip_here(void) {
  check_skipped = 1;
  longjmp(check_jump, 1);
}

static CHECK_UNUSED void check_true_at(int holds, const char *text, const char *file, int line) {
  if (holds) return;
  fprintf(stderr, "%s\n", text);
  check_fail_here(file, line);
}

static CHECK_UNUSED void check_int_at(int want_equal, uintmax_t a, uintmax_t b, const char *file,
                                      int line) {
  if ((a == b) == (want_equal != 0)) return;
  fprintf(stderr, "%lld (0x%llx) %s %lld (0x%llx)\n", (long long)a, (unsigned long long)a,
          want_equal ? "!=" : "==", (long long)b, (unsigned long long)b);
  check_fail_here(file, line);
}

static CHECK_UNUSED void check_string_at(int want_equal, const char *a, const char *b,
                                         const char *file, int line) {
  if ((strcmp(a, b) == 0) == (want_equal != 0)) return;
  fprintf(stderr, "\"%s\" %s \"%s\"\n", a, want_equal ? "!=" : "==", b);
  check_fail_here(file, line);
}

static CHECK_UNUSED void check_memory_at(int want_equal, const void *a, const void *b, size_t n,
                                         const char *file, int line) {
  const unsigned char *p = (const unsigned char *)a, *q = (const unsigned char *)b;
  size_t i = 0;
  while (i < n && p[i] == q[i]) ++i;
  if ((i == n) == (want_equal != 0)) return;
  if (want_equal)
    fprintf(stderr, "memory differs first at byte %zu of %zu: 0x%02x != 0x%02x\n", i, n, p[i],
            q[i]);
  else
    fprintf(stderr, "memory is the same over %zu bytes\n", n);
  check_fail_here(file, line);
}

#define assert_true(c) check_true_at((c) ? 1 : 0, #c, __FILE__, __LINE__)
#define assert_false(c) check_true_at((c) ? 0 : 1, "!(" #c ")", __FILE__, __LINE__)
#define assert_non_null(p) check_true_at((p) != NULL, #p " is NULL", __FILE__, __LINE__)
#define assert_null(p) check_true_at((p) == NULL, #p " is not NULL", __FILE__, __LINE__)
#define assert_int_equal(a, b) check_int_at(1, (uintmax_t)(a), (uintmax_t)(b), __FILE__, __LINE__)
#define assert_int_not_equal(a, b) \
  check_int_at(0, (uintmax_t)(a), (uintmax_t)(b), __FILE__, __LINE__)
#define assert_ptr_equal(a, b)                             \
  check_int_at(1, (uintmax_t)(uintptr_t)(const void *)(a), \
               (uintmax_t)(uintptr_t)(const void *)(b), __FILE__, __LINE__)
#define assert_ptr_not_equal(a, b)                         \
  check_int_at(0, (uintmax_t)(uintptr_t)(const void *)(a), \
               (uintmax_t)(uintptr_t)(const void *)(b), __FILE__, __LINE__)
#define assert_string_equal(a, b) check_string_at(1, (a), (b), __FILE__, __LINE__)
#define assert_string_not_equal(a, b) check_string_at(0, (a), (b), __FILE__, __LINE__)
#define assert_memory_equal(a, b, n) check_memory_at(1, (a), (b), (n), __FILE__, __LINE__)
#define assert_memory_not_equal(a, b, n) check_memory_at(0, (a), (b), (n), __FILE__, __LINE__)
#define assert_in_range(v, lo, hi)                                                      \
  check_true_at((uintmax_t)(v) >= (uintmax_t)(lo) && (uintmax_t)(v) <= (uintmax_t)(hi), \
                #v " is outside [" #lo ", " #hi "]", __FILE__, __LINE__)
#define fail() check_fail_here(__FILE__, __LINE__)
#define skip() check_skip_here()
#define print_message printf
#define print_error(...) fprintf(stderr, __VA_ARGS__)
#define fail_msg(...)                    \
  do {                                   \
    print_error("ERROR: ");              \
    print_error(__VA_ARGS__);            \
    print_error("\n");                   \
    check_fail_here(__FILE__, __LINE__); \
  } while (0)

static CHECK_UNUSED int check_run_one(const struct CMUnitTest *test) {
  void *state = test->initial_state;
  volatile int failed = 0;
  check_skipped = 0;
  if (test->setup_func && test->setup_func(&state) != 0) {
    fprintf(stderr, "the setup of %s failed\n", test->name);
    return 1;
  }
  if (setjmp(check_jump) == 0)
    test->test_func(&state);
  else
    failed = !check_skipped;
  if (test->teardown_func && test->teardown_func(&state) != 0) {
    fprintf(stderr, "the teardown of %s failed\n", test->name);
    failed = 1;
  }
  return failed;
}

static CHECK_UNUSED int check_run_group(const struct CMUnitTest *tests, size_t count,
                                        CMFixtureFunction setup, CMFixtureFunction teardown) {
  void *state = NULL;
  int failures = 0;
  if (setup && setup(&state) != 0) return (int)count;
  for (size_t i = 0; i < count; ++i) {
    if (check_run_one(&tests[i]) == 0) continue;
    fprintf(stderr, "[  FAILED  ] %s\n", tests[i].name);
    ++failures;
  }
  if (teardown) teardown(&state);
  return failures;
}

#define cmocka_run_group_tests(tests, setup, teardown) \
  check_run_group((tests), sizeof(tests) / sizeof((tests)[0]), (setup), (teardown))

#endif

static CHECK_UNUSED void check_close_at(double a, double b, double tol, const char *text,
                                        const char *file, int line) {
  if (a == b || fabs(a - b) <= tol) return;
  print_error("%s: %.17g and %.17g differ by %.3g > %.3g\n", text, a, b, fabs(a - b), tol);
  check_fail_here(file, line);
}

static CHECK_UNUSED void check_rel_at(double a, double b, double tol, const char *text,
                                      const char *file, int line) {
  double scale = fabs(a) > fabs(b) ? fabs(a) : fabs(b);
  if (a == b || fabs(a - b) <= tol * scale) return;
  print_error("%s: %.17g and %.17g differ by %.3g relative > %.3g\n", text, a, b,
              fabs(a - b) / scale, tol);
  check_fail_here(file, line);
}

static CHECK_UNUSED void check_status_at(sph_status got, sph_status want, const char *text,
                                         const char *file, int line) {
  if (got == want) return;
  print_error("%s: %s (%d), expected %s (%d)\n", text, sph_status_name(got), (int)got,
              sph_status_name(want), (int)want);
  check_fail_here(file, line);
}

/* |a - b| <= tol; NaN never passes. */
#define check_close(a, b, tol) check_close_at((a), (b), (tol), #a, __FILE__, __LINE__)
/* |a - b| <= tol * max(|a|, |b|); NaN never passes. */
#define check_rel(a, b, tol) check_rel_at((a), (b), (tol), #a, __FILE__, __LINE__)
/* The call answers this status; prints names when not. */
#define check_status(expr, status) check_status_at((expr), (status), #expr, __FILE__, __LINE__)
#define check_ok(expr) check_status(expr, SPH_OK)

#define SPH_TEST_MAIN(tests)                                                        \
  int main(int argc, char **argv) {                                                 \
    int check_count = (int)(sizeof(tests) / sizeof((tests)[0]));                    \
    check_long_run = argc > 1 && strcmp(argv[1], "long") == 0;                      \
    check_short_run = argc > 1 && strcmp(argv[1], "short") == 0;                    \
    int check_failed = cmocka_run_group_tests((tests), NULL, NULL);                 \
    if (check_failed < 0 || check_failed > check_count) check_failed = check_count; \
    fflush(stderr);                                                                 \
    printf("%d passed, %d failed\n", check_count - check_failed, check_failed);     \
    return check_failed != 0;                                                       \
  }

#endif
