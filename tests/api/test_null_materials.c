/* Every function of materials and stresses with a handle that is NULL or of another kind, and with
 * each required pointer NULL; all calls of the tables succeed as they stand, so the refusals are
 * real. test_null_complete sees to it that no function is missing here. */
#include "../check.h"

#include <sph/sph.h>

enum { MATERIAL, CONTEXT, KERNEL, KINDS };

static struct {
  void *handle[KINDS];
  sph_context *ctx;
  sph_material *material;
  sph_kernel *kernel;
  sph_material_block block;
  sph_material_functions law;
  sph_hooke_options hooke;
  sph_hyperelastic_options hyper;
  sph_von_mises_options mises;
  sph_strength_options strength;
  sph_gas_options gas;
  sph_barotropic_options barotropic;
  sph_mie_gruneisen_options gruneisen;
  sph_tillotson_options tillotson;
  double in[16], out[16];
  sph_material *made;
} g;

static int32_t one_fn(void *user, const sph_material_block *b, double *out) {
  (void)user;
  for (int64_t i = 0; i < b->n; i++) out[i] = 0.0;
  return 0;
}
static int32_t two_fn(void *user, const sph_material_block *b, double *out, double *other) {
  (void)user;
  for (int64_t i = 0; i < b->n; i++) {
    if (out) out[i] = 0.0;
    if (other) other[i] = 0.0;
  }
  return 0;
}
static int32_t return_fn(void *user, const sph_material_block *b, double *sigma, double *across,
                         double *plastic_strain, double *plastic_work) {
  (void)user;
  (void)across;
  (void)plastic_strain;
  (void)plastic_work;
  for (int64_t i = 0; i < b->n; i++) sigma[i] = 0.0;
  return 0;
}

static void fill_law(void) {
  sph_material_functions_init(&g.law);
  g.law.stress_rate = g.law.pressure = g.law.sound_speed = g.law.shear_speed = one_fn;
  g.law.small_strain_stress = g.law.cauchy_stress = g.law.stress_rate_across = one_fn;
  g.law.temperature = g.law.energy = one_fn;
  g.law.first_piola = g.law.pressure_derivatives = two_fn;
  g.law.plastic_return = return_fn;
}

static void fill_options(void) {
  sph_hooke_options_init(&g.hooke);
  g.hooke.young = g.hooke.density = 1.0;
  sph_hyperelastic_options_init(&g.hyper);
  g.hyper.young = g.hyper.density = 1.0;
  sph_von_mises_options_init(&g.mises);
  g.mises.young = g.mises.density = g.mises.yield = 1.0;
  sph_strength_options_init(&g.strength);
  g.strength.shear = 1.0;
  sph_gas_options_init(&g.gas);
  sph_barotropic_options_init(&g.barotropic);
  g.barotropic.density = g.barotropic.sound_speed = 1.0;
  sph_mie_gruneisen_options_init(&g.gruneisen);
  check_ok(sph_mie_gruneisen_constants(SPH_LEAD, &g.gruneisen, NULL));
  sph_tillotson_options_init(&g.tillotson);
  check_ok(sph_tillotson_constants(SPH_TILLOTSON_IRON, &g.tillotson));
}

static void open_all(void) {
  memset(&g, 0, sizeof g);
  for (int k = 0; k < 16; k++) g.in[k] = 1.0;
  fill_law();
  fill_options();
  check_ok(sph_context_create(NULL, &g.ctx));
  check_ok(sph_material_create(g.ctx, &g.law, NULL, &g.material));
  check_ok(sph_kernel_create(g.ctx, SPH_KERNEL_LUCY, 1, &g.kernel));
  sph_material_block_init(&g.block);
  g.block.dim = 1;
  g.block.n = 4;
  g.block.velocity_gradient = g.in;
  void *all[KINDS] = {g.material, g.ctx, g.kernel};
  memcpy(g.handle, all, sizeof all);
}

static void close_all(void) {
  sph_material_destroy(g.material);
  sph_kernel_destroy(g.kernel);
  sph_context_destroy(g.ctx);
}

#define MADE &g.made
#define UPDATE(m, b, s) sph_material_stress_update(m, b, 0.1, SPH_ROTATION_CAYLEY, s, NULL)

/* name, kind of the handle h, call: SPH_ERR_ARG for NULL, SPH_ERR_HANDLE for the other kinds. */
#define HANDLE_CALLS(X)                                                                \
  X(law, CONTEXT, sph_material_create(h, &g.law, NULL, MADE))                          \
  X(hooke, CONTEXT, sph_material_create_hooke(h, &g.hooke, MADE))                      \
  X(hyper, CONTEXT, sph_material_create_hyperelastic(h, &g.hyper, MADE))               \
  X(mises, CONTEXT, sph_material_create_von_mises(h, &g.mises, MADE))                  \
  X(strength, CONTEXT, sph_material_create_strength(h, g.material, &g.strength, MADE)) \
  X(strength_eos, MATERIAL, sph_material_create_strength(g.ctx, h, &g.strength, MADE)) \
  X(gas, CONTEXT, sph_material_create_gas(h, &g.gas, MADE))                            \
  X(barotropic, CONTEXT, sph_material_create_barotropic(h, &g.barotropic, MADE))       \
  X(gruneisen, CONTEXT, sph_material_create_mie_gruneisen(h, &g.gruneisen, MADE))      \
  X(tillotson, CONTEXT, sph_material_create_tillotson(h, &g.tillotson, MADE))          \
  X(rate, MATERIAL, sph_material_stress_rate(h, &g.block, g.out))                      \
  X(pressure, MATERIAL, sph_material_pressure(h, &g.block, g.out))                     \
  X(sound, MATERIAL, sph_material_sound_speed(h, &g.block, g.out))                     \
  X(shear, MATERIAL, sph_material_shear_speed(h, &g.block, g.out))                     \
  X(total, MATERIAL, sph_material_small_strain_stress(h, &g.block, g.out))             \
  X(across, MATERIAL, sph_material_stress_rate_across(h, &g.block, g.out))             \
  X(temperature, MATERIAL, sph_material_temperature(h, &g.block, g.out))               \
  X(energy, MATERIAL, sph_material_energy(h, &g.block, g.out))                         \
  X(slopes, MATERIAL, sph_material_pressure_derivatives(h, &g.block, g.out, NULL))     \
  X(piola, MATERIAL, sph_material_first_piola(h, 1, 4, g.in, g.out, NULL))             \
  X(cauchy, MATERIAL, sph_material_cauchy_stress(h, 1, 4, g.in, g.out))                \
  X(plastic, MATERIAL, sph_material_plastic_return(h, 1, 4, g.out, NULL, NULL, NULL))  \
  X(update, MATERIAL, UPDATE(h, &g.block, g.out))

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
  if (want != SPH_OK) assert_null(g.made);
  sph_material_destroy(g.made);
  g.made = NULL;
}

static void test_handles(void **state) {
  (void)state;
  open_all();
  for (int c = 0; c < CALLS; c++) {
    const handle_call *x = &handle_calls[c];
    for (int other = 0; other < KINDS; other++)
      expect(x->call(g.handle[other]), other == x->kind ? SPH_OK : SPH_ERR_HANDLE, x->text);
    expect(x->call(NULL), SPH_ERR_ARG, x->text);
  }
  for (int other = CONTEXT; other < KINDS; other++)
    sph_material_destroy((sph_material *)g.handle[other]); /* touches nothing of another kind */
  sph_material_destroy(NULL);
  close_all();
}

#define LAW_NULLS(X, f) X(f(g.material, NULL, g.out)) X(f(g.material, &g.block, NULL))
#define MAKE_NULLS(X, f, o) X(f(g.ctx, NULL, MADE)) X(f(g.ctx, o, NULL))
#define POINTER_CALLS(X)                                                   \
  X(sph_material_create(g.ctx, NULL, NULL, MADE))                          \
  X(sph_material_create(g.ctx, &g.law, NULL, NULL))                        \
  MAKE_NULLS(X, sph_material_create_hooke, &g.hooke)                       \
  MAKE_NULLS(X, sph_material_create_hyperelastic, &g.hyper)                \
  MAKE_NULLS(X, sph_material_create_von_mises, &g.mises)                   \
  MAKE_NULLS(X, sph_material_create_gas, &g.gas)                           \
  MAKE_NULLS(X, sph_material_create_barotropic, &g.barotropic)             \
  MAKE_NULLS(X, sph_material_create_mie_gruneisen, &g.gruneisen)           \
  MAKE_NULLS(X, sph_material_create_tillotson, &g.tillotson)               \
  X(sph_material_create_strength(g.ctx, g.material, NULL, MADE))           \
  X(sph_material_create_strength(g.ctx, g.material, &g.strength, NULL))    \
  LAW_NULLS(X, sph_material_stress_rate)                                   \
  LAW_NULLS(X, sph_material_pressure)                                      \
  LAW_NULLS(X, sph_material_sound_speed)                                   \
  LAW_NULLS(X, sph_material_shear_speed)                                   \
  LAW_NULLS(X, sph_material_small_strain_stress)                           \
  LAW_NULLS(X, sph_material_stress_rate_across)                            \
  LAW_NULLS(X, sph_material_temperature)                                   \
  LAW_NULLS(X, sph_material_energy)                                        \
  X(sph_material_pressure_derivatives(g.material, NULL, g.out, g.out))     \
  X(sph_material_pressure_derivatives(g.material, &g.block, NULL, NULL))   \
  X(sph_material_first_piola(g.material, 1, 4, NULL, g.out, NULL))         \
  X(sph_material_first_piola(g.material, 1, 4, g.in, NULL, g.out))         \
  X(sph_material_cauchy_stress(g.material, 1, 4, NULL, g.out))             \
  X(sph_material_cauchy_stress(g.material, 1, 4, g.in, NULL))              \
  X(sph_material_plastic_return(g.material, 1, 4, NULL, NULL, NULL, NULL)) \
  X(UPDATE(g.material, NULL, g.out))                                       \
  X(UPDATE(g.material, &g.block, NULL))                                    \
  X(sph_mie_gruneisen_constants(SPH_LEAD, NULL, NULL))                     \
  X(sph_tillotson_constants(SPH_TILLOTSON_IRON, NULL))                     \
  X(sph_principal_stresses(1, 1, NULL, g.out, NULL))                       \
  X(sph_principal_stresses(1, 1, g.in, NULL, NULL))                        \
  X(sph_equivalent_stress(1, 1, NULL, NULL, g.out))                        \
  X(sph_equivalent_stress(1, 1, g.in, NULL, NULL))                         \
  X(sph_stress_rotate(2, 1, NULL, 1.0, SPH_ROTATION_CAYLEY, g.out))        \
  X(sph_stress_rotate(2, 1, g.in, 1.0, SPH_ROTATION_CAYLEY, NULL))

static void test_pointers(void **state) {
  (void)state;
  open_all();
#define RUN(call) expect(call, SPH_ERR_ARG, #call);
  POINTER_CALLS(RUN)
#undef RUN
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
  TRY(sph_material_block_init_sized)
  TRY(sph_material_functions_init_sized)
  TRY(sph_hooke_options_init_sized)
  TRY(sph_hyperelastic_options_init_sized)
  TRY(sph_von_mises_options_init_sized)
  TRY(sph_strength_options_init_sized)
  TRY(sph_gas_options_init_sized)
  TRY(sph_barotropic_options_init_sized)
  TRY(sph_mie_gruneisen_options_init_sized)
  TRY(sph_tillotson_options_init_sized)
#undef TRY
  for (int k = 0; k < 4; k++) assert_int_equal(small.bytes[k], 0xaa);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_handles),
    cmocka_unit_test(test_pointers),
    cmocka_unit_test(test_inits),
};
SPH_TEST_MAIN(tests)
