/* Contexts, particles, kernels, neighbours, materials, right-hand sides and integrators with a
 * handle that is NULL or of another kind, and with each required pointer NULL; of the whole library
 * what answers no status. Other subjects: test_null_SUBJECT.c; that none is missing:
 * test_null_complete.c. */
#include "../null_help.h"

/* The list here has another rule than adaptation takes: to be told so is to be let in. */
static sph_status adapt(sph_neighbors *list, sph_kernel *kernel, sph_particles *set) {
  sph_status s = sph_adapt_smoothing(list, kernel, set, NULL, NULL);
  const char *said = s == SPH_ERR_ARG && list ? sph_context_last_error(g.s.ctx) : "";
  return strstr(said, "SPH_H_MAX") ? SPH_OK : s;
}

#define HANDLE_CALLS(X)                                                                    \
  X(memory, CONTEXT, sph_context_memory(h, NULL, NULL, NULL))                              \
  X(parallel, CONTEXT, sph_parallel_for(h, 1, 1, loop_fn, NULL))                           \
  X(new_set, CONTEXT, sph_particles_create(h, NULL, MADE))                                 \
  X(new_kernel, CONTEXT, sph_kernel_create(h, SPH_KERNEL_LUCY, 1, MADE))                   \
  X(new_callback, CONTEXT, sph_kernel_create_callback(h, 1, 1.0, kernel_fn, NULL, MADE))   \
  X(new_table, CONTEXT, sph_kernel_create_table(h, 1, 1.0, 8, g.in, g.in, 1, MADE))        \
  X(new_list, CONTEXT, sph_neighbors_create(h, NULL, MADE))                                \
  X(new_law, CONTEXT, sph_material_create(h, &g.law, NULL, MADE))                          \
  X(new_hooke, CONTEXT, sph_material_create_hooke(h, &g.hooke, MADE))                      \
  X(new_rhs, CONTEXT, sph_rhs_create(h, W, NULL, MADE))                                    \
  X(new_rhs_kernel, KERNEL, sph_rhs_create(CTX, h, NULL, MADE))                            \
  X(new_integrator, CONTEXT, sph_integrator_create(h, NULL, MADE))                         \
  X(reserve, PARTICLES, sph_particles_reserve(h, 10))                                      \
  X(add, PARTICLES, sph_particles_add(h, 1, NULL))                                         \
  X(add_ghosts, PARTICLES, sph_particles_add_ghosts(h, 1, NULL))                           \
  X(clear_ghosts, PARTICLES, sph_particles_clear_ghosts(h))                                \
  X(remove, PARTICLES, sph_particles_remove(h, 1, g.offsets))                              \
  X(sort, PARTICLES, sph_particles_sort(h, 1.0, NULL))                                     \
  X(add_field, PARTICLES, sph_particles_add_field(h, "other", 1, &g.field))                \
  X(field, PARTICLES, sph_particles_field(h, SPH_FIELD_V, MADE))                           \
  X(lend, PARTICLES, sph_particles_lend(h, SPH_FIELD_V, g.out, 4096))                      \
  X(touch, PARTICLES, sph_particles_touch(h, SPH_FIELD_X))                                 \
  X(kernel_values, KERNEL, sph_kernel_evaluate(h, 1, g.in, 1.0, g.out, NULL, NULL, NULL))  \
  X(build, NEIGHBORS, sph_neighbors_build(h, SET))                                         \
  X(build_set, PARTICLES, sph_neighbors_build(LIST, h))                                    \
  X(build_arrays, NEIGHBORS, sph_neighbors_build_arrays(h, 1, 1, g.in, NULL, 1.0))         \
  X(update, NEIGHBORS, sph_neighbors_update(h, SET, NULL))                                 \
  X(update_set, PARTICLES, sph_neighbors_update(LIST, h, NULL))                            \
  X(update_arrays, NEIGHBORS, sph_neighbors_update_arrays(h, 1, 1, g.in, NULL, 1.0, NULL)) \
  X(rows, NEIGHBORS, sph_neighbors_rows(h, &g.offsets, &g.indices))                        \
  X(query, NEIGHBORS, sph_neighbors_query(h, g.in, 1.0, 64, g.near, &g.found))             \
  X(law_rate, MATERIAL, sph_material_stress_rate(h, &g.block, g.out))                      \
  X(law_pressure, MATERIAL, sph_material_pressure(h, &g.block, g.out))                     \
  X(law_speed, MATERIAL, sph_material_sound_speed(h, &g.block, g.out))                     \
  X(psi, RHS, sph_rhs_strain_energy(h, SET, g.out))                                        \
  X(psi_set, PARTICLES, sph_rhs_strain_energy(g.rhs, h, g.out))                            \
  X(rhs_add, RHS, sph_rhs_add(h, &g.term))                                                 \
  X(rhs_host, RHS, sph_rhs_add_host(h, SPH_FIELD_V, pair_fn, NULL))                        \
  X(rhs_material, RHS, sph_rhs_set_material(h, 0, g.material))                             \
  X(rhs_prepare, RHS, sph_rhs_set_prepare(h, NULL, NULL))                                  \
  X(rhs_finish, RHS, sph_rhs_set_finish(h, NULL, NULL))                                    \
  X(evaluate, RHS, sph_rhs_evaluate(h, SET, LIST, 0.0, &g.rate, 1))                        \
  X(evaluate_set, PARTICLES, sph_rhs_evaluate(g.rhs, h, LIST, 0.0, &g.rate, 1))            \
  X(evaluate_list, NEIGHBORS, sph_rhs_evaluate(g.rhs, SET, h, 0.0, &g.rate, 1))            \
  X(bind, INTEGRATOR, sph_integrator_bind_field(h, SPH_FIELD_X))                           \
  X(bind_array, INTEGRATOR, sph_integrator_bind_array(h, g.out, 4))                        \
  X(set_function, INTEGRATOR, sph_integrator_set_function(h, rhs_fn, NULL))                \
  X(set_rhs, INTEGRATOR, sph_integrator_set_rhs(h, g.rhs, LIST))                           \
  X(set_rhs_rhs, RHS, sph_integrator_set_rhs(g.it, h, LIST))                               \
  X(set_rhs_list, NEIGHBORS, sph_integrator_set_rhs(g.it, g.rhs, h))                       \
  X(step, INTEGRATOR, sph_integrator_step(h, SET, 0.0, 1.0, NULL))                         \
  X(step_set, PARTICLES, sph_integrator_step(g.it, h, 0.0, 1.0, NULL))                     \
  X(save, INTEGRATOR, sph_integrator_save(h, SET))                                         \
  X(save_set, PARTICLES, sph_integrator_save(g.it, h))                                     \
  X(restore, INTEGRATOR, sph_integrator_restore(h, SET))                                   \
  X(set_filter, INTEGRATOR, sph_integrator_set_filter(h, NULL, NULL))                      \
  X(restart, INTEGRATOR, sph_integrator_restart(h))                                        \
  X(cfl, PARTICLES, sph_cfl_step(h, 1.0, g.out))                                           \
  X(adapt, NEIGHBORS, adapt(h, W, SET))                                                    \
  X(adapt_kernel, KERNEL, adapt(LIST, h, SET))                                             \
  X(adapt_set, PARTICLES, adapt(LIST, W, h))                                               \
  X(signal, NEIGHBORS, sph_signal_step(h, &g.a, 1.0, g.out))                               \
  X(density_step, CONTEXT, sph_density_step(h, 4, 1.0, g.in, g.in, g.out))

HANDLE_CALLS(DEFINE_CALL)
static const handle_call handle_calls[] = {HANDLE_CALLS(LIST_CALL)};

static void test_handles(void **state) {
  (void)state;
  check_handle_calls(handle_calls, sizeof handle_calls / sizeof *handle_calls);
}

#define POINTER_CALLS(X)                                            \
  X(sph_context_create(NULL, NULL))                                 \
  X(sph_parallel_for(CTX, 1, 1, NULL, NULL))                        \
  X(sph_particles_create(CTX, NULL, NULL))                          \
  X(sph_particles_remove(SET, 1, NULL))                             \
  X(sph_particles_add_field(SET, NULL, 1, &g.field))                \
  X(sph_particles_add_field(SET, "name", 1, NULL))                  \
  X(sph_particles_field(SET, SPH_FIELD_V, NULL))                    \
  X(sph_kernel_create(CTX, SPH_KERNEL_LUCY, 1, NULL))               \
  X(sph_kernel_create_callback(CTX, 1, 1.0, NULL, NULL, MADE))      \
  X(sph_kernel_create_callback(CTX, 1, 1.0, kernel_fn, NULL, NULL)) \
  X(sph_kernel_create_table(CTX, 1, 1.0, 8, NULL, g.in, 1, MADE))   \
  X(sph_kernel_create_table(CTX, 1, 1.0, 8, g.in, NULL, 1, MADE))   \
  X(sph_kernel_create_table(CTX, 1, 1.0, 8, g.in, g.in, 1, NULL))   \
  X(sph_kernel_evaluate(W, 1, NULL, 1.0, g.out, NULL, NULL, NULL))  \
  X(sph_neighbors_create(CTX, NULL, NULL))                          \
  X(sph_neighbors_build_arrays(LIST, 1, 1, NULL, NULL, 1.0))        \
  X(sph_neighbors_update_arrays(LIST, 1, 1, NULL, NULL, 1.0, NULL)) \
  X(sph_neighbors_rows(LIST, NULL, &g.indices))                     \
  X(sph_neighbors_rows(LIST, &g.offsets, NULL))                     \
  X(sph_neighbors_query(LIST, NULL, 1.0, 64, g.near, &g.found))     \
  X(sph_neighbors_query(LIST, g.in, 1.0, 64, NULL, &g.found))       \
  X(sph_neighbors_query(LIST, g.in, 1.0, 64, g.near, NULL))         \
  X(sph_material_create(CTX, NULL, NULL, MADE))                     \
  X(sph_material_create(CTX, &g.law, NULL, NULL))                   \
  X(sph_material_create_hooke(CTX, NULL, MADE))                     \
  X(sph_material_create_hooke(CTX, &g.hooke, NULL))                 \
  X(sph_material_stress_rate(g.material, NULL, g.out))              \
  X(sph_material_stress_rate(g.material, &g.block, NULL))           \
  X(sph_material_pressure(g.material, NULL, g.out))                 \
  X(sph_material_pressure(g.material, &g.block, NULL))              \
  X(sph_material_sound_speed(g.material, NULL, g.out))              \
  X(sph_material_sound_speed(g.material, &g.block, NULL))           \
  X(sph_rhs_strain_energy(g.rhs, SET, NULL))                        \
  X(sph_rhs_create(CTX, W, NULL, NULL))                             \
  X(sph_rhs_add(g.rhs, NULL))                                       \
  X(sph_rhs_add_host(g.rhs, SPH_FIELD_V, NULL, NULL))               \
  X(sph_rhs_evaluate(g.rhs, SET, LIST, 0.0, NULL, 1))               \
  X(sph_integrator_create(CTX, NULL, NULL))                         \
  X(sph_integrator_bind_array(g.it, NULL, 4))                       \
  X(sph_integrator_set_function(g.it, NULL, NULL))                  \
  X(sph_cfl_step(SET, 1.0, NULL))                                   \
  X(sph_signal_step(LIST, NULL, 1.0, g.out))                        \
  X(sph_signal_step(LIST, &g.a, 1.0, NULL))                         \
  X(sph_density_step(CTX, 4, 1.0, NULL, g.in, g.out))               \
  X(sph_density_step(CTX, 4, 1.0, g.in, NULL, g.out))               \
  X(sph_density_step(CTX, 4, 1.0, g.in, g.in, NULL))

static void test_pointers(void **state) {
  (void)state;
  open_all();
  g.made = NULL;
  POINTER_CALLS(REFUSED)
  assert_null(g.made);
  /* a material takes NULL: it is removed; another kind is refused */
  check_ok(sph_rhs_set_material(g.rhs, 0, NULL));
  for (int k = 0; k < KINDS; k++)
    if (k != MATERIAL) check_status(sph_rhs_set_material(g.rhs, 0, g.handle[k]), SPH_ERR_HANDLE);
  close_all();
}

/* --- functions without a status ---------------------------------------------------------- */

/* A pair function adds nothing for a handle that is not its own. */
static void check_pair_functions(void *h) {
  static const int32_t j[1] = {1};
  const sph_pair_block b = {sizeof b, 1, 1, 0, j, g.in, g.in, g.in, g.in};
  double out[1] = {0.0};
  sph_no_slip_gradient(h, &b, out);
  sph_no_slip_continuity(h, &b, out);
  sph_no_slip_stress(h, &b, out);
  sph_no_slip_pressure(h, &b, out);
  assert_true(out[0] == 0.0);
}

static void check_getters(void *h, kind not_this) {
  if (not_this != CONTEXT) {
    assert_int_equal(sph_context_workers(h), 0);
    assert_int_equal(sph_context_isa(h), 0);
    assert_non_null(sph_context_last_error(h));
  }
  if (not_this != PARTICLES) {
    assert_int_equal(sph_particles_dim(h), 0);
    assert_int_equal(sph_particles_count(h), 0);
    assert_int_equal(sph_particles_real_count(h), 0);
    assert_int_equal(sph_particles_generation(h), 0);
    assert_int_equal(sph_particles_components(h, SPH_FIELD_V), 0);
    assert_int_equal(sph_particles_revision(h, SPH_FIELD_X), 0);
    assert_int_equal(sph_particles_find_field(h, "x"), -1);
    assert_null(sph_particles_field_const(h, SPH_FIELD_X));
    assert_null(sph_particles_roles(h));
    assert_null(sph_particles_phases(h));
    assert_null(sph_particles_ids(h));
  }
  if (not_this != KERNEL) {
    assert_int_equal(sph_kernel_type(h), 0);
    assert_int_equal(sph_kernel_dim(h), 0);
    assert_true(sph_kernel_support(h) == 0.0 && sph_kernel_deviation(h) == 0.0);
    assert_true(sph_kernel_alpha(h) == 0.0);
    assert_true(isnan(sph_kernel_w(h, 0.5, 1.0)) && isnan(sph_kernel_dwdr(h, 0.5, 1.0)));
    assert_true(isnan(sph_kernel_d2wdr2(h, 0.5, 1.0)) && isnan(sph_kernel_dwdh(h, 0.5, 1.0)));
    assert_true(isnan(sph_kernel_equal_h(h, W, 1.0)) && isnan(sph_kernel_equal_h(W, h, 1.0)));
  }
  if (not_this != NEIGHBORS) {
    assert_int_equal(sph_neighbors_count(h), -1);
    assert_int_equal(sph_neighbors_pairs(h), -1);
    assert_int_equal(sph_neighbors_builds(h), -1);
  }
  if (not_this != GHOSTS) {
    assert_int_equal(sph_ghosts_count(h), -1);
    assert_null(sph_ghosts_owners(h));
    assert_null(sph_ghosts_walls(h));
    check_pair_functions(h);
  }
  if (not_this != POINTS) {
    assert_int_equal(sph_stress_points_count(h), 0);
    assert_null(sph_stress_points_offsets(h));
    assert_null(sph_stress_points_stresses(h));
  }
  if (not_this != TOTAL_LAGRANGIAN) {
    assert_null(sph_total_lagrangian_rhs(h));
    assert_null(sph_total_lagrangian_list(h));
  }
}

/* What cannot answer a status answers its nothing; destroying another kind leaves it alone. */
static void check_destroyers(void *h, kind not_this) {
  if (not_this != CONTEXT) sph_context_destroy(h);
  if (not_this != PARTICLES) sph_particles_destroy(h);
  if (not_this != KERNEL) sph_kernel_destroy(h);
  if (not_this != NEIGHBORS) sph_neighbors_destroy(h);
  if (not_this != MATERIAL) sph_material_destroy(h);
  if (not_this != RHS) sph_rhs_destroy(h);
  if (not_this != INTEGRATOR) sph_integrator_destroy(h);
  if (not_this != GHOSTS) sph_ghosts_destroy(h);
  if (not_this != HOLD) sph_hold_destroy(h);
  if (not_this != POINTS) sph_stress_points_destroy(h);
  if (not_this != TOTAL_LAGRANGIAN) sph_total_lagrangian_destroy(h);
}

static void test_getters(void **state) {
  (void)state;
  open_all();
  check_getters(NULL, KINDS);
  check_destroyers(NULL, KINDS);
  for (int k = 0; k < KINDS; k++) {
    check_getters(g.handle[k], (kind)k);
    check_destroyers(g.handle[k], (kind)k);
  }
  assert_int_equal(sph_particles_find_field(SET, NULL), -1);
  assert_int_equal(sph_neighbors_count(LIST), 32);
  check_ok(sph_rhs_evaluate(g.rhs, SET, LIST, 0.0, &g.rate, 1)); /* all still alive */
  check_ok(sph_integrator_step(g.it, SET, 0.0, 1e-3, NULL));
  close_all();
}

/* Initialisers of options: NULL, and a size that does not even hold the size. */
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
  TRY(sph_context_options_init_sized)
  TRY(sph_particles_options_init_sized)
  TRY(sph_neighbors_options_init_sized)
  TRY(sph_material_block_init_sized)
  TRY(sph_material_functions_init_sized)
  TRY(sph_hooke_options_init_sized)
  TRY(sph_operands_init_sized)
  TRY(sph_bulk_viscosity_init_sized)
  TRY(sph_lattice_options_init_sized)
  TRY(sph_hole_layout_options_init_sized)
  TRY(sph_region_options_init_sized)
  TRY(sph_term_init_sized)
  TRY(sph_rhs_options_init_sized)
  TRY(sph_integrator_options_init_sized)
  TRY(sph_adapt_options_init_sized)
  TRY(sph_adapt_result_init_sized)
  TRY(sph_step_info_init_sized)
  TRY(sph_wall_init_sized)
  TRY(sph_ghosts_options_init_sized)
  TRY(sph_stress_points_options_init_sized)
  TRY(sph_total_lagrangian_options_init_sized)
  TRY(sph_total_lagrangian_ledger_init_sized)
#undef TRY
  for (int k = 0; k < 4; k++) assert_int_equal(small.bytes[k], 0xaa);
}

/* Pure functions: no handle, pointers that may all be NULL, text that is never NULL. */
static void test_pure(void **state) {
  (void)state;
  static const int32_t odd[] = {INT32_MIN, -12345, -1, 0, 99, INT32_MAX};
  sph_version(NULL, NULL, NULL);
  assert_non_null(sph_version_string());
  check_ok(sph_rkc_coefficients(3, SPH_RKC_B1_INVERSE_W0, NULL, NULL, NULL, NULL, NULL));
  for (size_t k = 0; k < sizeof odd / sizeof *odd; k++) {
    assert_non_null(sph_status_text(odd[k]));
    assert_non_null(sph_status_name(odd[k]));
    assert_non_null(sph_isa_name(odd[k]));
    assert_non_null(sph_kernel_name(odd[k]));
    assert_int_equal(sph_sym_components(odd[k]), 0);
    if (odd[k] != 0) assert_int_equal(sph_isa_available(odd[k]), 0);
    if (odd[k] != 99) {
      assert_true(isnan(sph_rkc_beta(odd[k])));
      assert_true(isnan(sph_rkc_amplification(odd[k], -1.0, 0.0)));
    }
  }
  assert_int_equal(sph_rkc_stages_cfl(NAN, 1.0, 1.0), -1);
  assert_int_equal(sph_rkc_stages_radius(-1.0, 1.0), -1);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_handles), cmocka_unit_test(test_pointers), cmocka_unit_test(test_getters),
    cmocka_unit_test(test_inits),   cmocka_unit_test(test_pure),
};
SPH_TEST_MAIN(tests)
