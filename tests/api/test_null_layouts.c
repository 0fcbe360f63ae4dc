/* Relaxed layouts and layouts of several materials with a handle that is NULL or of another kind,
 * and with each required pointer NULL. The other layouts: test_null_bodies.c. */
#include "../null_help.h"

static int32_t phase[64];

static const sph_material_layout_options *materials(void) {
  static sph_material_layout_options o;
  sph_material_layout_options_init(&o);
  o.dim = 1;
  o.spacing = 0.25;
  return &o;
}

#define FILL(...) sph_layout_materials(CTX, __VA_ARGS__)

#define HANDLE_CALLS(X)                                                         \
  X(relax, CONTEXT, sph_layout_relax(h, &g.region, NULL, 1, g.in, g.out, NULL)) \
  X(fill, CONTEXT, sph_layout_materials(h, materials(), 0, NULL, NULL, NULL, &g.found))

HANDLE_CALLS(DEFINE_CALL)
static const handle_call handle_calls[] = {HANDLE_CALLS(LIST_CALL)};

static void test_handles(void **state) {
  (void)state;
  check_handle_calls(handle_calls, sizeof handle_calls / sizeof *handle_calls);
}

#define POINTER_CALLS(X)                                          \
  X(sph_layout_relax(CTX, NULL, NULL, 1, g.in, g.out, NULL))      \
  X(sph_layout_relax(CTX, &g.region, NULL, 1, NULL, g.out, NULL)) \
  X(FILL(NULL, 0, NULL, NULL, NULL, &g.found))                    \
  X(FILL(materials(), 0, NULL, NULL, NULL, NULL))                 \
  X(FILL(materials(), 64, NULL, phase, g.out, &g.found))          \
  X(FILL(materials(), 64, g.out, NULL, g.out, &g.found))          \
  X(FILL(materials(), 64, g.out, phase, NULL, &g.found))

static void test_pointers(void **state) {
  (void)state;
  open_all();
  POINTER_CALLS(REFUSED)
  check_ok(FILL(materials(), 64, g.out, phase, g.in, &g.found));
  assert_int_equal(g.found, 4);
  close_all();
}

/* Initialisers of options: NULL, and a size that does not even hold the size. */
static void test_inits(void **state) {
  (void)state;
  size_t small = 0xaaaa;
  sph_relax_options_init_sized(NULL, 100);
  sph_relax_result_init_sized(NULL, 100);
  sph_material_layout_options_init_sized(NULL, 100);
  sph_relax_options_init_sized((sph_relax_options *)&small, 4);
  sph_relax_result_init_sized((sph_relax_result *)&small, 4);
  sph_material_layout_options_init_sized((sph_material_layout_options *)&small, 4);
  assert_int_equal(small, 0xaaaa);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_handles),
    cmocka_unit_test(test_pointers),
    cmocka_unit_test(test_inits),
};
SPH_TEST_MAIN(tests)
