/* Layouts, boundaries, stress points and the total-Lagrangian scheme with a handle that is NULL or
 * of another kind, and with each required pointer NULL. */
#include "../null_help.h"

#define NEW_SCHEME(o, made) sph_total_lagrangian_create(CTX, o, g.rubber, made)

#define HANDLE_CALLS(X)                                                                 \
  X(tl_new, CONTEXT, sph_total_lagrangian_create(h, &g.tl_options, g.rubber, MADE))     \
  X(tl_new_law, MATERIAL, sph_total_lagrangian_create(CTX, &g.tl_options, h, MADE))     \
  X(tl_start, TOTAL_LAGRANGIAN, sph_total_lagrangian_start(h, SET))                     \
  X(tl_start_set, PARTICLES, sph_total_lagrangian_start(g.tl, h))                       \
  X(tl_dt, TOTAL_LAGRANGIAN, sph_total_lagrangian_time_step(h, SET, g.out))             \
  X(tl_dt_set, PARTICLES, sph_total_lagrangian_time_step(g.tl, h, g.out))               \
  X(tl_step, TOTAL_LAGRANGIAN, sph_total_lagrangian_step(h, SET, 0.0, 1.0))             \
  X(tl_step_set, PARTICLES, sph_total_lagrangian_step(g.tl, h, 0.0, 1.0))               \
  X(tl_energy, TOTAL_LAGRANGIAN, sph_total_lagrangian_energy(h, SET, 0.0, &g.energies)) \
  X(tl_energy_set, PARTICLES, sph_total_lagrangian_energy(g.tl, h, 0.0, &g.energies))   \
  X(tl_balance, TOTAL_LAGRANGIAN, sph_total_lagrangian_balance(h, SET, 0.0, &g.ledger)) \
  X(tl_balance_set, PARTICLES, sph_total_lagrangian_balance(g.tl, h, 0.0, &g.ledger))   \
  X(lattice, CONTEXT, sph_layout_lattice(h, &g.lattice, 0, NULL, &g.found))             \
  X(holes, CONTEXT, sph_layout_holes(h, &g.holes, 0, NULL, &g.found))                   \
  X(jitter, CONTEXT, sph_layout_jitter(h, 1, 0.1, 1, NULL, NULL, 1, g.out))             \
  X(volumes, CONTEXT, sph_layout_volumes(h, &g.region, 1, g.in, g.out))                 \
  X(new_ghosts, CONTEXT, sph_ghosts_create(h, NULL, MADE))                              \
  X(add_wall, GHOSTS, sph_ghosts_add_wall(h, &g.wall, NULL))                            \
  X(set_wall, GHOSTS, sph_ghosts_set_wall(h, 0, &g.wall))                               \
  X(get_wall, GHOSTS, sph_ghosts_get_wall(h, 0, &g.wall))                               \
  X(set_mirror, GHOSTS, sph_ghosts_set_mirror(h, SPH_FIELD_E, SPH_MIRROR_LEAVE))        \
  X(ghosts_update, GHOSTS, sph_ghosts_update(h, SET, 0.0))                              \
  X(ghosts_update_set, PARTICLES, sph_ghosts_update(g.ghosts, h, 0.0))                  \
  X(ghosts_refresh, GHOSTS, sph_ghosts_refresh(h, SET, 0.0))                            \
  X(ghosts_refresh_set, PARTICLES, sph_ghosts_refresh(g.ghosts, h, 0.0))                \
  X(ghosts_prepare, GHOSTS, sph_ghosts_prepare(h, 0.0, SET, NULL, 0))                   \
  X(ghosts_prepare_set, PARTICLES, sph_ghosts_prepare(g.ghosts, 0.0, h, NULL, 0))       \
  X(recapture, GHOSTS, sph_ghosts_recapture(h, SET, NULL))                              \
  X(recapture_set, PARTICLES, sph_ghosts_recapture(g.ghosts, h, NULL))                  \
  X(new_hold, CONTEXT, sph_hold_create(h, MADE))                                        \
  X(hold_field, HOLD, sph_hold_field(h, 1, 1, NULL, 0, 1, NULL, NULL, NULL))            \
  X(hold_traction, HOLD, sph_hold_traction(h, 1, NULL, 0, g.in, NULL, NULL, NULL))      \
  X(hold_clear, HOLD, sph_hold_clear(h))                                                \
  X(hold_finish, HOLD, sph_hold_finish(h, 0.0, SET, NULL, 0))                           \
  X(hold_finish_set, PARTICLES, sph_hold_finish(g.hold, 0.0, h, NULL, 0))               \
  X(new_points, CONTEXT, sph_stress_points_create(h, W, LIST, NULL, MADE))              \
  X(new_points_w, KERNEL, sph_stress_points_create(CTX, h, LIST, NULL, MADE))           \
  X(new_points_list, NEIGHBORS, sph_stress_points_create(CTX, W, h, NULL, MADE))        \
  X(points_material, POINTS, sph_stress_points_set_material(h, 0, g.material))          \
  X(points_place, POINTS, sph_stress_points_place(h, SET))                              \
  X(points_place_set, PARTICLES, sph_stress_points_place(g.points, h))                  \
  X(points_average, POINTS, sph_stress_points_average(h, SET))                          \
  X(points_average_set, PARTICLES, sph_stress_points_average(g.points, h))              \
  X(points_rates, POINTS, sph_stress_points_rates(h, 0.0, SET, NULL, 0))                \
  X(points_rates_set, PARTICLES, sph_stress_points_rates(g.points, 0.0, h, NULL, 0))    \
  X(points_bind, POINTS, sph_stress_points_bind(h, g.it))                               \
  X(points_bind_it, INTEGRATOR, sph_stress_points_bind(g.points, h))

HANDLE_CALLS(DEFINE_CALL)
static const handle_call handle_calls[] = {HANDLE_CALLS(LIST_CALL)};

static void test_handles(void **state) {
  (void)state;
  check_handle_calls(handle_calls, sizeof handle_calls / sizeof *handle_calls);
}

#define POINTER_CALLS(X)                                           \
  X(NEW_SCHEME(NULL, MADE))                                        \
  X(NEW_SCHEME(&g.tl_options, NULL))                               \
  X(sph_layout_lattice(CTX, NULL, 0, NULL, &g.found))              \
  X(sph_layout_lattice(CTX, &g.lattice, 0, NULL, NULL))            \
  X(sph_layout_lattice(CTX, &g.lattice, 9, NULL, &g.found))        \
  X(sph_layout_holes(CTX, NULL, 0, NULL, &g.found))                \
  X(sph_layout_holes(CTX, &g.holes, 0, NULL, NULL))                \
  X(sph_layout_holes(CTX, &g.holes, 9, NULL, &g.found))            \
  X(sph_layout_jitter(CTX, 1, 0.1, 1, NULL, NULL, 1, NULL))        \
  X(sph_layout_volumes(CTX, NULL, 1, g.in, g.out))                 \
  X(sph_layout_volumes(CTX, &g.region, 1, NULL, g.out))            \
  X(sph_layout_volumes(CTX, &g.region, 1, g.in, NULL))             \
  X(sph_ghosts_create(CTX, NULL, NULL))                            \
  X(sph_ghosts_add_wall(g.ghosts, NULL, NULL))                     \
  X(sph_ghosts_set_wall(g.ghosts, 0, NULL))                        \
  X(sph_ghosts_get_wall(g.ghosts, 0, NULL))                        \
  X(sph_hold_create(CTX, NULL))                                    \
  X(sph_hold_traction(g.hold, 1, NULL, 0, NULL, NULL, NULL, NULL)) \
  X(sph_hold_finish(g.hold, 0.0, SET, NULL, 1))                    \
  X(sph_stress_points_create(CTX, W, LIST, NULL, NULL))

static void test_pointers(void **state) {
  (void)state;
  open_all();
  g.made = NULL;
  POINTER_CALLS(REFUSED)
  assert_null(g.made);
  close_all();
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_handles),
    cmocka_unit_test(test_pointers),
};
SPH_TEST_MAIN(tests)
