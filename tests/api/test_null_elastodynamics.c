/* Every function of elastodynamics.h and adapt.h with a handle that is NULL or of another kind, and
 * with each required pointer NULL. test_null_complete sees to it that none is missing here. */
#include "../solid_help.h"

enum { SOLID, CONTEXT, PARTICLES, MATERIAL, KINDS };

static struct {
  void *handle[KINDS];
  solid s;
  sph_elastodynamics_options o;
  sph_elastodynamics_ledger ledger;
  double in[4], out[4];
  sph_elastodynamics *made;
} g;

static void open_all(void) {
  static const int64_t side[2] = {5, 4};
  memset(&g, 0, sizeof g);
  sph_context *ctx = rh_context(1);
  g.s = so_block(ctx, 2, side, 0.0);
  g.o = so_options(2);
  so_start(&g.s, &g.o);
  sph_elastodynamics_ledger_init(&g.ledger);
  for (int k = 0; k < 4; k++) g.in[k] = 1.0;
  void *all[KINDS] = {g.s.scheme, ctx, g.s.set, g.s.hooke};
  memcpy(g.handle, all, sizeof all);
}

static void close_all(void) {
  sph_context *ctx = g.s.ctx;
  so_free(&g.s);
  sph_context_destroy(ctx);
}

#define CTX g.s.ctx
#define SET g.s.set
#define E g.s.scheme

/* name, kind of the handle h, call: SPH_ERR_ARG for NULL, SPH_ERR_HANDLE for the other kinds. */
#define HANDLE_CALLS(X)                                                       \
  X(make, CONTEXT, sph_elastodynamics_create(h, SET, &g.o, &g.made))          \
  X(make_set, PARTICLES, sph_elastodynamics_create(CTX, h, &g.o, &g.made))    \
  X(law, SOLID, sph_elastodynamics_set_material(h, 0, g.s.hooke))             \
  X(law_law, MATERIAL, sph_elastodynamics_set_material(E, 0, h))              \
  X(prepare, SOLID, sph_elastodynamics_set_prepare(h, NULL, NULL))            \
  X(finish, SOLID, sph_elastodynamics_set_finish(h, NULL, NULL))              \
  X(start, SOLID, sph_elastodynamics_start(h, 0.0))                           \
  X(stable, SOLID, sph_elastodynamics_stable_dt(h, g.out))                    \
  X(step, SOLID, sph_elastodynamics_step(h, 0.1, NULL))                       \
  X(run, SOLID, sph_elastodynamics_run(h, 1.0, NULL, NULL))                   \
  X(balance, SOLID, sph_elastodynamics_balance(h, &g.ledger))                 \
  X(h_density, CONTEXT, sph_h_from_density(h, 2, 4, g.in, g.in, g.in, g.out)) \
  X(h_mass, CONTEXT, sph_h_from_mass(h, 2, 4, 1.2, g.in, g.in, g.out))        \
  X(h_rate, CONTEXT, sph_h_rate(h, 2, 4, g.in, g.in, g.in, g.out))            \
  X(h_spacing, CONTEXT, sph_h_from_spacing(h, 4, 1.5, g.in, g.out))

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

static void drop_made(void) {
  sph_elastodynamics_destroy(g.made);
  g.made = NULL;
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
    drop_made();
  }
  close_all();
}

#define POINTER_CALLS(X)                                    \
  X(sph_elastodynamics_create(CTX, SET, NULL, &g.made))     \
  X(sph_elastodynamics_create(CTX, SET, &g.o, NULL))        \
  X(sph_elastodynamics_stable_dt(E, NULL))                  \
  X(sph_elastodynamics_balance(E, NULL))                    \
  X(sph_h_from_density(CTX, 2, 4, NULL, g.in, g.in, g.out)) \
  X(sph_h_from_density(CTX, 2, 4, g.in, NULL, g.in, g.out)) \
  X(sph_h_from_density(CTX, 2, 4, g.in, g.in, NULL, g.out)) \
  X(sph_h_from_density(CTX, 2, 4, g.in, g.in, g.in, NULL))  \
  X(sph_h_from_mass(CTX, 2, 4, 1.2, NULL, g.in, g.out))     \
  X(sph_h_from_mass(CTX, 2, 4, 1.2, g.in, NULL, g.out))     \
  X(sph_h_from_mass(CTX, 2, 4, 1.2, g.in, g.in, NULL))      \
  X(sph_h_rate(CTX, 2, 4, NULL, g.in, g.in, g.out))         \
  X(sph_h_rate(CTX, 2, 4, g.in, NULL, g.in, g.out))         \
  X(sph_h_rate(CTX, 2, 4, g.in, g.in, NULL, g.out))         \
  X(sph_h_rate(CTX, 2, 4, g.in, g.in, g.in, NULL))          \
  X(sph_h_from_spacing(CTX, 4, 1.5, NULL, g.out))           \
  X(sph_h_from_spacing(CTX, 4, 1.5, g.in, NULL))

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
  assert_true(isnan(sph_elastodynamics_time(h)));
  assert_null(sph_elastodynamics_rhs(h));
  assert_null(sph_elastodynamics_list(h));
  assert_null(sph_elastodynamics_integrator(h));
  assert_null(sph_elastodynamics_kernel(h));
  sph_elastodynamics_destroy(h); /* leaves another kind alone */
}

static void test_getters(void **state) {
  (void)state;
  open_all();
  check_getters(NULL);
  for (int k = CONTEXT; k < KINDS; k++) check_getters(g.handle[k]);
  check_ok(sph_elastodynamics_step(E, 0.1, NULL)); /* all still alive */
  assert_true(isnan(sph_pair_w(NULL, SPH_H_MAX, 0.1, 1.0, 1.0)));
  assert_true(isnan(sph_pair_dwdr(NULL, SPH_H_MAX, 0.1, 1.0, 1.0)));
  assert_true(isnan(sph_pair_h(0, 1.0, 1.0)));
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
  TRY(sph_elastodynamics_options_init_sized)
  TRY(sph_elastodynamics_ledger_init_sized)
#undef TRY
  for (int k = 0; k < 4; k++) assert_int_equal(small.bytes[k], 0xaa);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_handles),
    cmocka_unit_test(test_pointers),
    cmocka_unit_test(test_getters),
    cmocka_unit_test(test_inits),
};
SPH_TEST_MAIN(tests)
