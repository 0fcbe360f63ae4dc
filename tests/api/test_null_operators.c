/* Operators with a handle that is NULL or of another kind, and with each required pointer NULL. */
#include "../null_help.h"

#define SPRINGS(h, w, x, F, o) sph_hourglass_force(h, w, &g.frozen, 1, 0.1, x, F, o, NULL)

#define HANDLE_CALLS(X)                                                          \
  X(from_set, PARTICLES, sph_operands_from_set(h, &g.a))                         \
  X(density, NEIGHBORS, sph_density_summation(h, W, &g.a, g.out))                \
  X(density_w, KERNEL, sph_density_summation(LIST, h, &g.a, g.out))              \
  X(continuity, NEIGHBORS, sph_continuity(h, W, &g.a, 1, g.out))                 \
  X(continuity_w, KERNEL, sph_continuity(LIST, h, &g.a, 1, g.out))               \
  X(gradv, NEIGHBORS, sph_velocity_gradient(h, W, &g.a, g.out))                  \
  X(gradv_w, KERNEL, sph_velocity_gradient(LIST, h, &g.a, g.out))                \
  X(gradient, NEIGHBORS, sph_gradient(h, W, &g.a, 1, 1, g.in, g.out))            \
  X(gradient_w, KERNEL, sph_gradient(LIST, h, &g.a, 1, 1, g.in, g.out))          \
  X(interpolate, NEIGHBORS, sph_interpolate(h, W, &g.a, 0, 1, g.in, g.out))      \
  X(interpolate_w, KERNEL, sph_interpolate(LIST, h, &g.a, 0, 1, g.in, g.out))    \
  X(at, NEIGHBORS, sph_interpolate_at(h, W, &g.a, 0, 1, g.in, 1, g.in, g.out))   \
  X(at_w, KERNEL, sph_interpolate_at(LIST, h, &g.a, 0, 1, g.in, 1, g.in, g.out)) \
  X(stress, NEIGHBORS, sph_stress_divergence(h, W, &g.a, 1, g.out))              \
  X(stress_w, KERNEL, sph_stress_divergence(LIST, h, &g.a, 1, g.out))            \
  X(pressure, NEIGHBORS, sph_pressure_gradient(h, W, &g.a, 1, g.out))            \
  X(pressure_w, KERNEL, sph_pressure_gradient(LIST, h, &g.a, 1, g.out))          \
  X(monaghan, NEIGHBORS, sph_viscosity_monaghan(h, W, &g.a, 1.0, 1.0, g.out))    \
  X(monaghan_w, KERNEL, sph_viscosity_monaghan(LIST, h, &g.a, 1.0, 1.0, g.out))  \
  X(bulk, NEIGHBORS, sph_viscosity_bulk(h, W, &g.a, &g.bulk, NULL, g.out))       \
  X(bulk_w, KERNEL, sph_viscosity_bulk(LIST, h, &g.a, &g.bulk, NULL, g.out))     \
  X(xsph, NEIGHBORS, sph_xsph(h, W, &g.a, 0.5, g.out))                           \
  X(xsph_w, KERNEL, sph_xsph(LIST, h, &g.a, 0.5, g.out))                         \
  X(shepard, NEIGHBORS, sph_shepard_sum(h, W, &g.a, g.out))                      \
  X(shepard_w, KERNEL, sph_shepard_sum(LIST, h, &g.a, g.out))                    \
  X(matrix, NEIGHBORS, sph_gradient_matrix(h, W, &g.a, g.out, NULL, NULL))       \
  X(matrix_w, KERNEL, sph_gradient_matrix(LIST, h, &g.a, g.out, NULL, NULL))     \
  X(def, NEIGHBORS, sph_deformation_gradient(h, W, &g.frozen, g.in, g.out))      \
  X(def_w, KERNEL, sph_deformation_gradient(LIST, h, &g.frozen, g.in, g.out))    \
  X(piola, NEIGHBORS, sph_piola_divergence(h, W, &g.frozen, 1, g.in, g.out))     \
  X(piola_w, KERNEL, sph_piola_divergence(LIST, h, &g.frozen, 1, g.in, g.out))   \
  X(springs, NEIGHBORS, SPRINGS(h, W, g.in, g.in, g.out))                        \
  X(springs_w, KERNEL, SPRINGS(LIST, h, g.in, g.in, g.out))

HANDLE_CALLS(DEFINE_CALL)
static const handle_call handle_calls[] = {HANDLE_CALLS(LIST_CALL)};

static void test_handles(void **state) {
  (void)state;
  check_handle_calls(handle_calls, sizeof handle_calls / sizeof *handle_calls);
}

/* Each is SPH_ERR_ARG. Operators say so of the operands and of every output. */
#define DENSITY(a, o) sph_density_summation(LIST, W, a, o)
#define CONTINUITY(a, o) sph_continuity(LIST, W, a, 1, o)
#define VELOCITY_GRADIENT(a, o) sph_velocity_gradient(LIST, W, a, o)
#define GRADIENT(a, o) sph_gradient(LIST, W, a, 1, 1, g.in, o)
#define INTERPOLATE(a, o) sph_interpolate(LIST, W, a, 0, 1, g.in, o)
#define INTERPOLATE_AT(a, o) sph_interpolate_at(LIST, W, a, 0, 1, g.in, 1, g.in, o)
#define STRESS(a, o) sph_stress_divergence(LIST, W, a, 1, o)
#define PRESSURE(a, o) sph_pressure_gradient(LIST, W, a, 1, o)
#define MONAGHAN(a, o) sph_viscosity_monaghan(LIST, W, a, 1.0, 1.0, o)
#define BULK(a, o) sph_viscosity_bulk(LIST, W, a, &g.bulk, NULL, o)
#define XSPH(a, o) sph_xsph(LIST, W, a, 0.5, o)
#define SHEPARD(a, o) sph_shepard_sum(LIST, W, a, o)
#define MATRIX(a, o) sph_gradient_matrix(LIST, W, a, o, NULL, NULL)
#define OPERATOR_NULLS(X, f) X(f(NULL, g.out)) X(f(&g.a, NULL))
#define POINTER_CALLS(X)                                           \
  X(sph_operands_from_set(SET, NULL))                              \
  OPERATOR_NULLS(X, DENSITY)                                       \
  OPERATOR_NULLS(X, CONTINUITY)                                    \
  OPERATOR_NULLS(X, VELOCITY_GRADIENT)                             \
  OPERATOR_NULLS(X, GRADIENT)                                      \
  OPERATOR_NULLS(X, INTERPOLATE)                                   \
  OPERATOR_NULLS(X, INTERPOLATE_AT)                                \
  OPERATOR_NULLS(X, STRESS)                                        \
  OPERATOR_NULLS(X, PRESSURE)                                      \
  OPERATOR_NULLS(X, MONAGHAN)                                      \
  OPERATOR_NULLS(X, BULK)                                          \
  OPERATOR_NULLS(X, XSPH)                                          \
  OPERATOR_NULLS(X, SHEPARD)                                       \
  OPERATOR_NULLS(X, MATRIX)                                        \
  X(sph_gradient(LIST, W, &g.a, 1, 1, NULL, g.out))                \
  X(sph_interpolate(LIST, W, &g.a, 0, 1, NULL, g.out))             \
  X(sph_interpolate_at(LIST, W, &g.a, 0, 1, NULL, 1, g.in, g.out)) \
  X(sph_interpolate_at(LIST, W, &g.a, 0, 1, g.in, 1, NULL, g.out)) \
  X(sph_viscosity_bulk(LIST, W, &g.a, NULL, NULL, g.out))          \
  X(sph_artificial_stress(1, 1, NULL, NULL, 1.0, 0.3, g.out))      \
  X(sph_artificial_stress(1, 1, g.in, NULL, 1.0, 0.3, NULL))       \
  X(sph_deformation_gradient(LIST, W, NULL, g.in, g.out))          \
  X(sph_deformation_gradient(LIST, W, &g.frozen, NULL, g.out))     \
  X(sph_deformation_gradient(LIST, W, &g.frozen, g.in, NULL))      \
  X(sph_piola_divergence(LIST, W, NULL, 1, g.in, g.out))           \
  X(sph_piola_divergence(LIST, W, &g.frozen, 1, NULL, g.out))      \
  X(sph_piola_divergence(LIST, W, &g.frozen, 1, g.in, NULL))       \
  X(SPRINGS(LIST, W, NULL, g.in, g.out))                           \
  X(SPRINGS(LIST, W, g.in, NULL, g.out))                           \
  X(SPRINGS(LIST, W, g.in, g.in, NULL))

static void test_pointers(void **state) {
  (void)state;
  open_all();
  g.made = NULL;
  POINTER_CALLS(REFUSED)
  assert_null(g.made);
  close_all();
}

/* The operators and the law are fine with what the tables start from: the refusals are real. */
static void test_valid_calls(void **state) {
  (void)state;
  open_all();
  for (int c = 0; c < (int)(sizeof handle_calls / sizeof *handle_calls); c++) {
    const handle_call *x = &handle_calls[c];
    if (x->k != NEIGHBORS) continue;
    if (strstr(x->text, "(h, W") != NULL) expect(x->call(LIST), SPH_OK, x->text, -1);
  }
  check_ok(sph_material_stress_rate(g.material, &g.block, g.out));
  check_ok(sph_rhs_evaluate(g.rhs, SET, LIST, 0.0, &g.rate, 1));
  close_all();
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_handles),
    cmocka_unit_test(test_pointers),
    cmocka_unit_test(test_valid_calls),
};
SPH_TEST_MAIN(tests)
