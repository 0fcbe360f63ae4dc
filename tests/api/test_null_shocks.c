/* Every function of shocks.h, and what integrators and right-hand sides have for it, with a handle
 * that is NULL or of another kind, and with each required pointer NULL. test_null_everywhere sees
 * to it that none is missing here. */
#include "../shocks_help.h"

#include "../oom.h"

enum { SHOCKS, CONTEXT, PARTICLES, MATERIAL, GHOSTS, RHS, INTEGRATOR, KINDS };

static struct {
  void *handle[KINDS];
  cloud c;
  sph_shocks_options o;
  sph_shocks_ledger ledger;
  sph_ghosts *ghosts;
  sph_shocks *made;
  size_t bytes;
  double out[8], buffer[1 << 14];
} g;

static void open_all(void) {
  memset(&g, 0, sizeof g);
  sph_context *ctx = rh_context(1);
  sph_ghosts_options o;
  g.c = sk_cloud(ctx, 2, 4, SK_SOLID);
  g.o = sk_options(2);
  sk_start(&g.c, &g.o);
  sph_shocks_ledger_init(&g.ledger);
  sph_ghosts_options_init(&o);
  o.dim = 2;
  o.support = 3.0;
  check_ok(sph_ghosts_create(ctx, &o, &g.ghosts));
  check_ok(sph_shocks_save(g.c.scheme, g.buffer, sizeof g.buffer));
  void *all[KINDS] = {g.c.scheme, ctx, g.c.set, g.c.gas, g.ghosts, sph_shocks_rhs(g.c.scheme),
                      NULL};
  memcpy(g.handle, all, sizeof all);
  g.handle[INTEGRATOR] = sph_shocks_integrator(g.c.scheme);
}

static void close_all(void) {
  sph_context *ctx = g.c.ctx;
  sk_free(&g.c);
  sph_ghosts_destroy(g.ghosts);
  sph_context_destroy(ctx);
}

#define CTX g.c.ctx
#define SET g.c.set
#define S g.c.scheme
#define ROOM sizeof g.buffer
#define SIGMA sk_field(&g.c, SPH_FIELD_SIGMA)

/* name, kind of the handle h, call: SPH_ERR_ARG for NULL, SPH_ERR_HANDLE for the other kinds. What
 * makes a new integrator stands last. */
#define HANDLE_CALLS(X)                                                          \
  X(make, CONTEXT, sph_shocks_create(h, SET, &g.o, &g.made))                     \
  X(make_set, PARTICLES, sph_shocks_create(CTX, h, &g.o, &g.made))               \
  X(law, SHOCKS, sph_shocks_set_material(h, 0, g.c.gas))                         \
  X(law_law, MATERIAL, sph_shocks_set_material(S, 0, h))                         \
  X(prepare, SHOCKS, sph_shocks_set_prepare(h, NULL, NULL))                      \
  X(finish, SHOCKS, sph_shocks_set_finish(h, NULL, NULL))                        \
  X(walls, SHOCKS, sph_shocks_set_ghosts(h, NULL))                               \
  X(stable, SHOCKS, sph_shocks_stable_dt(h, g.out))                              \
  X(step, SHOCKS, sph_shocks_step(h, 1e-3, NULL))                                \
  X(run, SHOCKS, sph_shocks_run(h, 0.01, NULL, NULL))                            \
  X(update, SHOCKS, sph_shocks_update(h))                                        \
  X(balance, SHOCKS, sph_shocks_balance(h, &g.ledger))                           \
  X(size, SHOCKS, sph_shocks_state_size(h, &g.bytes))                            \
  X(save, SHOCKS, sph_shocks_save(h, g.buffer, ROOM))                            \
  X(fill, RHS, sph_rhs_fill(h, SET, SPH_FIELD_P))                                \
  X(fill_set, PARTICLES, sph_rhs_fill(g.handle[RHS], h, SPH_FIELD_C))            \
  X(yield, RHS, sph_rhs_plastic_return(h, SET, SIGMA, NULL))                     \
  X(yield_set, PARTICLES, sph_rhs_plastic_return(g.handle[RHS], h, SIGMA, NULL)) \
  X(it_size, INTEGRATOR, sph_integrator_state_size(h, SET, &g.bytes))            \
  X(it_write, INTEGRATOR, sph_integrator_state_write(h, SET, g.buffer, ROOM))    \
  X(it_read, INTEGRATOR, sph_integrator_state_read(h, SET, g.buffer, ROOM))      \
  X(it_set, PARTICLES, sph_integrator_state_size(g.handle[INTEGRATOR], h, &g.bytes))

#define DEFINE_CALL(name, k, call) \
  static sph_status call_##name(void *h) { return call; }
HANDLE_CALLS(DEFINE_CALL)

typedef struct handle_call {
  const char *text;
  int kind;
  sph_status (*call)(void *h);
} handle_call;

#define LIST_CALL(name, k, call) {#call, k, call_##name},
static const handle_call handle_calls[] = {HANDLE_CALLS(LIST_CALL)};
enum { CALLS = sizeof handle_calls / sizeof *handle_calls };

static void expect(sph_status got, sph_status want, const char *text) {
  if (got != want) fail_msg("%s: %s, not %s", text, sph_status_name(got), sph_status_name(want));
}

static void test_handles(void **state) {
  (void)state;
  open_all();
  for (int c = 0; c < CALLS; c++) {
    const handle_call *x = &handle_calls[c];
    expect(x->call(NULL), SPH_ERR_ARG, x->text);
    for (int other = 0; other < KINDS; other++)
      if (other != x->kind) expect(x->call(g.handle[other]), SPH_ERR_HANDLE, x->text);
    assert_null(g.made);
    expect(x->call(g.handle[x->kind]), SPH_OK, x->text); /* the refusals are real */
    sph_shocks_destroy(g.made);
    g.made = NULL;
  }
  close_all();
}

/* Those that make the integrator anew. */
static void test_restarts(void **state) {
  (void)state;
  open_all();
  for (int other = CONTEXT; other < INTEGRATOR; other++) {
    check_status(sph_shocks_start(g.handle[other], 0.0), SPH_ERR_HANDLE);
    check_status(sph_shocks_restore(g.handle[other], g.buffer, ROOM), SPH_ERR_HANDLE);
    if (other != GHOSTS) check_status(sph_shocks_set_ghosts(S, g.handle[other]), SPH_ERR_HANDLE);
  }
  check_status(sph_shocks_start(NULL, 0.0), SPH_ERR_ARG);
  check_status(sph_shocks_restore(NULL, g.buffer, ROOM), SPH_ERR_ARG);
  check_ok(sph_shocks_restore(S, g.buffer, ROOM));
  check_ok(sph_shocks_set_ghosts(S, g.ghosts));
  check_ok(sph_shocks_start(S, 0.0));
  close_all();
}

#define POINTER_CALLS(X)                                               \
  X(sph_shocks_create(CTX, SET, NULL, &g.made))                        \
  X(sph_shocks_create(CTX, SET, &g.o, NULL))                           \
  X(sph_shocks_stable_dt(S, NULL))                                     \
  X(sph_shocks_balance(S, NULL))                                       \
  X(sph_shocks_state_size(S, NULL))                                    \
  X(sph_shocks_save(S, NULL, ROOM))                                    \
  X(sph_rhs_fill(g.handle[RHS], SET, SPH_FIELD_H))                     \
  X(sph_rhs_plastic_return(g.handle[RHS], SET, NULL, NULL))            \
  X(sph_integrator_state_size(g.handle[INTEGRATOR], SET, NULL))        \
  X(sph_integrator_state_size(g.handle[INTEGRATOR], NULL, &g.bytes))   \
  X(sph_integrator_state_write(g.handle[INTEGRATOR], SET, NULL, ROOM)) \
  X(sph_integrator_state_read(g.handle[INTEGRATOR], SET, NULL, ROOM))  \
  X(sph_shocks_restore(S, NULL, ROOM))

static void test_pointers(void **state) {
  (void)state;
  open_all();
#define RUN(call) expect(call, SPH_ERR_ARG, #call);
  POINTER_CALLS(RUN)
#undef RUN
  assert_null(g.made);
  close_all();
}

static void check_getters(void *h) {
  assert_true(isnan(sph_shocks_time(h)));
  assert_null(sph_shocks_rhs(h));
  assert_null(sph_shocks_list(h));
  assert_null(sph_shocks_integrator(h));
  assert_null(sph_shocks_kernel(h));
  sph_shocks_destroy(h); /* leaves another kind alone */
}

static void test_getters(void **state) {
  (void)state;
  open_all();
  check_getters(NULL);
  for (int k = CONTEXT; k < KINDS; k++) check_getters(g.handle[k]);
  check_ok(sph_shocks_step(S, 1e-3, NULL)); /* all still alive */
  close_all();
}

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
  TRY(sph_shocks_options_init_sized)
  TRY(sph_shocks_ledger_init_sized)
#undef TRY
  for (int k = 0; k < 4; k++) assert_int_equal(small.bytes[k], 0xaa);
}

/* The laws by themselves, with failing memory: fields that are not there yet. */
static sph_status scenario(sph_context *ctx, void *user) {
  sph_rhs *rhs = NULL;
  sph_kernel *kernel = NULL;
  (void)user;
  oom_pause();
  cloud c = sk_cloud(ctx, 2, 4, SK_HARDENING);
  check_ok(sph_kernel_create(ctx, SPH_KERNEL_GAUSSIAN, 2, &kernel));
  check_ok(sph_rhs_create(ctx, kernel, NULL, &rhs));
  check_ok(sph_rhs_set_material(rhs, 1, c.solid));
  double *sigma = sk_field(&c, SPH_FIELD_SIGMA), strain[16] = {0.0};
  for (int64_t k = 0; k < 3 * c.n; k++) sigma[k] = 1.0;
  oom_resume();
  sph_status s = sph_rhs_fill(rhs, c.set, SPH_FIELD_P);
  if (!s) s = sph_rhs_fill(rhs, c.set, SPH_FIELD_C);
  if (!s) s = sph_rhs_plastic_return(rhs, c.set, sigma, strain);
  oom_pause();
  if (!s) {
    check_status(sph_rhs_plastic_return(rhs, c.set, sigma, NULL), SPH_ERR_ARG); /* it hardens */
    for (int64_t i = 0; i < c.n; i++) assert_true((strain[i] > 0.0) == (i % 4 >= 2));
    for (int64_t i = 0; i < c.n; i++) assert_true((sigma[3 * i] < 1.0) == (i % 4 >= 2));
    for (int64_t i = 0; i < c.n; i++)
      assert_true((sk_field(&c, SPH_FIELD_C)[i] > 0.0) == (i % 4 >= 2));
  }
  sph_rhs_destroy(rhs);
  sph_kernel_destroy(kernel);
  sk_free(&c);
  oom_resume();
  return s;
}

static void test_laws(void **state) {
  (void)state;
  oom_sweep(scenario, NULL);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_handles),  cmocka_unit_test(test_restarts),
    cmocka_unit_test(test_pointers), cmocka_unit_test(test_getters),
    cmocka_unit_test(test_inits),    cmocka_unit_test(test_laws),
};
SPH_TEST_MAIN(tests)
