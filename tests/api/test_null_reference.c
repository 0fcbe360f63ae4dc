/* Every reference with a context that is NULL or of another kind, and with each required pointer
 * NULL; all calls of the tables succeed as they stand, so the refusals are real.
 * test_null_complete sees to it that no function is missing here. */
#include "../oom.h"

#include <sph/sph.h>

static struct {
  sph_context *ctx;
  sph_kernel *kernel;
  sph_riemann_side side;
  sph_riemann_solution solution;
  sph_noh_options noh;
  sph_sedov_options sedov;
  sph_gresho_options gresho;
  double in[2], out[2];
} g;

static void open_all(void) {
  memset(&g, 0, sizeof g);
  g.ctx = oom_context();
  check_ok(sph_kernel_create(g.ctx, SPH_KERNEL_CUBIC_SPLINE, 1, &g.kernel));
  sph_riemann_side_init(&g.side);
  g.side.rho = g.side.p = 1.0;
  sph_riemann_solution_init(&g.solution);
  sph_noh_options_init(&g.noh);
  sph_sedov_options_init(&g.sedov);
  sph_gresho_options_init(&g.gresho);
  g.noh.dim = g.sedov.dim = 2;
  g.in[0] = 0.1;
  g.in[1] = 0.3;
}

static void close_all(void) {
  sph_kernel_destroy(g.kernel);
  sph_context_destroy(g.ctx);
}

#define CALLS(X, ctx)                                                                            \
  X(sph_riemann_solve(ctx, &g.side, &g.side, &g.solution))                                       \
  X(sph_riemann_sample(ctx, &g.side, &g.side, &g.solution, 2, g.in, g.out, g.out, g.out, g.out)) \
  X(sph_noh_solution(ctx, &g.noh, 1.0, 2, g.in, g.out, g.out, g.out, g.out))                     \
  X(sph_sedov_solution(ctx, &g.sedov, 1.0, 2, g.in, g.out, g.out, g.out, g.out, g.out))          \
  X(sph_gresho_solution(ctx, &g.gresho, 2, g.in, g.out, g.out))                                  \
  X(sph_wasserstein_distance(ctx, 2, 1, g.in, g.in, 1, g.in, g.in, g.out))

static void expect(sph_status got, sph_status want, const char *call) {
  if (got != want)
    fail_msg("%s: %s instead of %s", call, sph_status_name(got), sph_status_name(want));
}

/* All but the transport problem do without memory: they succeed when every allocation is refused.
 * The transport problem says so and leaves its output alone. */
static void test_memory(void **state) {
  (void)state;
  open_all();
  oom.countdown = 0;
  expect(sph_riemann_solve(g.ctx, &g.side, &g.side, &g.solution), SPH_OK, "solve");
  expect(sph_riemann_sample(g.ctx, &g.side, &g.side, &g.solution, 2, g.in, g.out, NULL, NULL, NULL),
         SPH_OK, "sample");
  expect(sph_noh_solution(g.ctx, &g.noh, 1.0, 2, g.in, g.out, NULL, NULL, NULL), SPH_OK, "noh");
  expect(sph_sedov_solution(g.ctx, &g.sedov, 1.0, 2, g.in, NULL, g.out, NULL, NULL, NULL), SPH_OK,
         "sedov");
  expect(sph_gresho_solution(g.ctx, &g.gresho, 2, g.in, g.out, NULL), SPH_OK, "gresho");
  assert_int_equal(oom.refused, 0);
  g.out[0] = 7.0;
  expect(sph_wasserstein_distance(g.ctx, 2, 1, g.in, g.in, 1, g.in, g.in, g.out), SPH_ERR_NOMEM,
         "wasserstein");
  assert_true(oom.refused > 0 && g.out[0] == 7.0);
  oom.countdown = -1;
  close_all();
  oom_check_clean();
}

static void test_handles(void **state) {
  (void)state;
  open_all();
#define FINE(call) expect(call, SPH_OK, #call);
  CALLS(FINE, g.ctx)
#undef FINE
#define NONE(call) expect(call, SPH_ERR_ARG, #call);
  CALLS(NONE, NULL)
#undef NONE
#define OTHER(call) expect(call, SPH_ERR_HANDLE, #call);
  CALLS(OTHER, (sph_context *)(void *)g.kernel)
#undef OTHER
  close_all();
}

#define POINTER_CALLS(X)                                                                        \
  X(sph_riemann_solve(g.ctx, NULL, &g.side, &g.solution))                                       \
  X(sph_riemann_solve(g.ctx, &g.side, NULL, &g.solution))                                       \
  X(sph_riemann_solve(g.ctx, &g.side, &g.side, NULL))                                           \
  X(sph_riemann_sample(g.ctx, NULL, &g.side, &g.solution, 2, g.in, g.out, NULL, NULL, NULL))    \
  X(sph_riemann_sample(g.ctx, &g.side, NULL, &g.solution, 2, g.in, g.out, NULL, NULL, NULL))    \
  X(sph_riemann_sample(g.ctx, &g.side, &g.side, NULL, 2, g.in, g.out, NULL, NULL, NULL))        \
  X(sph_riemann_sample(g.ctx, &g.side, &g.side, &g.solution, 2, NULL, g.out, NULL, NULL, NULL)) \
  X(sph_noh_solution(g.ctx, NULL, 1.0, 2, g.in, g.out, NULL, NULL, NULL))                       \
  X(sph_noh_solution(g.ctx, &g.noh, 1.0, 2, NULL, g.out, NULL, NULL, NULL))                     \
  X(sph_sedov_solution(g.ctx, NULL, 1.0, 2, g.in, NULL, g.out, NULL, NULL, NULL))               \
  X(sph_sedov_solution(g.ctx, &g.sedov, 1.0, 2, NULL, NULL, g.out, NULL, NULL, NULL))           \
  X(sph_gresho_solution(g.ctx, &g.gresho, 2, NULL, g.out, NULL))                                \
  X(sph_wasserstein_distance(g.ctx, 2, 1, NULL, NULL, 1, g.in, NULL, g.out))                    \
  X(sph_wasserstein_distance(g.ctx, 2, 1, g.in, NULL, 1, NULL, NULL, g.out))                    \
  X(sph_wasserstein_distance(g.ctx, 2, 1, g.in, NULL, 1, g.in, NULL, NULL))

static void test_pointers(void **state) {
  (void)state;
  open_all();
#define RUN(call) expect(call, SPH_ERR_ARG, #call);
  POINTER_CALLS(RUN)
#undef RUN
  close_all();
}

/* What may be NULL. */
static void test_optional(void **state) {
  (void)state;
  open_all();
  check_ok(sph_riemann_solve(g.ctx, &g.side, &g.side, &g.solution));
  check_ok(
      sph_riemann_sample(g.ctx, &g.side, &g.side, &g.solution, 2, g.in, NULL, NULL, NULL, NULL));
  check_ok(sph_noh_solution(g.ctx, &g.noh, 1.0, 2, g.in, NULL, NULL, NULL, NULL));
  check_ok(sph_sedov_solution(g.ctx, &g.sedov, 1.0, 2, g.in, NULL, NULL, NULL, NULL, NULL));
  check_ok(sph_gresho_solution(g.ctx, NULL, 2, g.in, NULL, NULL));
  check_ok(sph_wasserstein_distance(g.ctx, 2, 1, g.in, NULL, 1, g.in, NULL, g.out));
  close_all();
}

/* Nothing happens to NULL, and nothing is written past a size that cannot hold the size. */
static void test_inits(void **state) {
  (void)state;
  union {
    size_t size;
    unsigned char bytes[4];
  } small = {0};
  memset(&small, 0xaa, sizeof small);
#define TRY(function)  \
  function(NULL, 100); \
  function(NULL, 0);   \
  function((void *)&small, 4);
  TRY(sph_riemann_side_init_sized)
  TRY(sph_riemann_solution_init_sized)
  TRY(sph_noh_options_init_sized)
  TRY(sph_sedov_options_init_sized)
  TRY(sph_gresho_options_init_sized)
#undef TRY
  for (int k = 0; k < 4; k++) assert_int_equal(small.bytes[k], 0xaa);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_memory),   cmocka_unit_test(test_handles),
    cmocka_unit_test(test_pointers), cmocka_unit_test(test_optional),
    cmocka_unit_test(test_inits),
};
SPH_TEST_MAIN(tests)
