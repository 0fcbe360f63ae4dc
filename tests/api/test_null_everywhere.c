/* Every public function with a handle that is NULL or of another kind, and with each required
 * pointer NULL. The last test reads the headers and this file, and names a function that is missing
 * here. */
#include "../rhs_help.h"

#include <ctype.h>
#include <glob.h>

typedef enum kind {
  CONTEXT,
  PARTICLES,
  KERNEL,
  NEIGHBORS,
  MATERIAL,
  RHS,
  INTEGRATOR,
  GHOSTS,
  HOLD,
  POINTS,
  TOTAL_LAGRANGIAN,
  KINDS
} kind;

/* One valid object of each kind, and arrays that are large enough for every call. */
static struct {
  void *handle[KINDS];
  rh_system s;
  sph_material *material;
  sph_rhs *rhs;
  sph_integrator *it;
  sph_ghosts *ghosts;
  sph_hold *hold;
  sph_stress_points *points;
  sph_total_lagrangian *tl;
  sph_material *rubber;
  sph_total_lagrangian_options tl_options;
  sph_total_lagrangian_energies energies;
  sph_hyperelastic_options hyper;
  sph_wall wall;
  sph_operands a, frozen; /* the second one with a gradient matrix */
  sph_material_block block;
  sph_material_functions law;
  sph_hooke_options hooke;
  sph_bulk_viscosity bulk;
  sph_lattice_options lattice;
  sph_hole_layout_options holes;
  sph_region_options region;
  sph_term term;
  sph_rate rate;
  const int64_t *offsets;
  const int32_t *indices;
  double in[4096], out[4096];
  int32_t field, near[64];
  int64_t found;
  void *made;
} g;

/* The list here has another rule than adaptation takes: to be told so is to be let in. */
static sph_status adapt(sph_neighbors *list, sph_kernel *kernel, sph_particles *set) {
  sph_status s = sph_adapt_smoothing(list, kernel, set, NULL, NULL);
  const char *said = s == SPH_ERR_ARG && list ? sph_context_last_error(g.s.ctx) : "";
  return strstr(said, "SPH_H_MAX") ? SPH_OK : s;
}

static void kernel_fn(void *user, double q, double *w, double *dw) {
  (void)user;
  *w = 1.0 - q;
  *dw = -1.0;
}
static void loop_fn(void *job, int64_t begin, int64_t end, int32_t worker) {
  (void)job;
  (void)begin;
  (void)end;
  (void)worker;
}
static void pair_fn(void *user, const sph_pair_block *b, double *out) {
  (void)user;
  (void)b;
  (void)out;
}
static int32_t rhs_fn(void *user, double t, sph_particles *set, const sph_rate *rates,
                      int32_t count) {
  (void)user;
  (void)t;
  for (int32_t k = 0; k < count; k++) /* scalars and vectors of one dimension */
    for (int64_t i = 0; i < sph_particles_real_count(set); i++) rates[k].values[i] = 0.0;
  return 0;
}
static int32_t law_fn(void *user, const sph_material_block *b, double *out) {
  (void)user;
  for (int64_t i = 0; i < b->n; i++) out[i] = 0.0;
  return 0;
}

static sph_ghosts *make_ghosts(sph_context *ctx) {
  sph_ghosts *ghosts = NULL;
  sph_ghosts_options o;
  sph_ghosts_options_init(&o);
  o.dim = 1;
  check_ok(sph_ghosts_create(ctx, &o, &ghosts));
  sph_wall_init(&g.wall);
  g.wall.kind = SPH_WALL_SLIP;
  g.wall.normal[0] = 1.0;
  g.wall.point[0] = -100.0; /* far from all particles */
  check_ok(sph_ghosts_add_wall(ghosts, &g.wall, NULL));
  check_ok(sph_ghosts_update(ghosts, g.s.set, 0.0));
  return ghosts;
}

static void open_all(void) {
  memset(&g, 0, sizeof g);
  sph_context *ctx = rh_context(1);
  g.s = rh_make(ctx, 1, 32, 0, 1);
  for (int k = 0; k < 4096; k++) g.in[k] = 1.0;
  sph_material_functions_init(&g.law);
  g.law.stress_rate = g.law.pressure = g.law.sound_speed = law_fn;
  check_ok(sph_material_create(ctx, &g.law, NULL, &g.material));
  sph_hooke_options_init(&g.hooke);
  g.hooke.young = g.hooke.density = 1.0;
  g.rhs = rh_rhs(&g.s);
  check_ok(sph_integrator_create(ctx, NULL, &g.it));
  check_ok(sph_integrator_bind_field(g.it, SPH_FIELD_V));
  check_ok(sph_integrator_set_function(g.it, rhs_fn, NULL));
  check_ok(sph_operands_from_set(g.s.set, &g.a));
  sph_material_block_init(&g.block);
  g.block.dim = 1;
  g.block.n = 4;
  sph_bulk_viscosity_init(&g.bulk);
  sph_lattice_options_init(&g.lattice);
  g.lattice.dim = 1;
  g.lattice.spacing = 0.5;
  sph_hole_layout_options_init(&g.holes);
  g.holes.holes = 1;
  g.holes.hole = g.in; /* the centre (1, 1), the corner of the unit square, and the radius 1 */
  g.holes.spacing = 0.5;
  sph_region_options_init(&g.region);
  g.region.dim = 1;
  g.term = rh_term(SPH_TERM_STRESS, 0, 0);
  g.rate = (sph_rate){SPH_FIELD_V, g.out};
  g.ghosts = make_ghosts(ctx);
  check_ok(sph_hold_create(ctx, &g.hold));
  check_ok(sph_stress_points_create(ctx, g.s.kernel, g.s.list, NULL, &g.points));
  g.frozen = g.a;
  g.frozen.gradient_matrix = g.in;
  sph_hyperelastic_options_init(&g.hyper);
  g.hyper.young = g.hyper.density = 1.0;
  g.hyper.reduction = SPH_UNIAXIAL_STRESS;
  check_ok(sph_material_create_hyperelastic(ctx, &g.hyper, &g.rubber));
  sph_total_lagrangian_options_init(&g.tl_options);
  g.tl_options.dim = 1;
  check_ok(sph_total_lagrangian_create(ctx, &g.tl_options, g.rubber, &g.tl));
  g.energies.size = sizeof g.energies;
  void *all[KINDS] = {ctx,  g.s.set,  g.s.kernel, g.s.list, g.material, g.rhs,
                      g.it, g.ghosts, g.hold,     g.points, g.tl};
  memcpy(g.handle, all, sizeof all);
}

static void close_all(void) {
  sph_context *ctx = g.s.ctx;
  sph_total_lagrangian_destroy(g.tl);
  sph_material_destroy(g.rubber);
  sph_stress_points_destroy(g.points);
  sph_hold_destroy(g.hold);
  sph_ghosts_destroy(g.ghosts);
  sph_integrator_destroy(g.it);
  sph_rhs_destroy(g.rhs);
  sph_material_destroy(g.material);
  rh_free(&g.s);
  sph_context_destroy(ctx);
}

#define SET g.s.set
#define LIST g.s.list
#define W g.s.kernel
#define CTX g.s.ctx
#define MADE (void *)&g.made

#define SPRINGS(h, w, x, F, o) sph_hourglass_force(h, w, &g.frozen, 1, 0.1, x, F, o, NULL)

/* name, kind of the handle h, call: SPH_ERR_ARG for NULL, SPH_ERR_HANDLE for the other kinds. */
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
  X(from_set, PARTICLES, sph_operands_from_set(h, &g.a))                                   \
  X(density, NEIGHBORS, sph_density_summation(h, W, &g.a, g.out))                          \
  X(density_w, KERNEL, sph_density_summation(LIST, h, &g.a, g.out))                        \
  X(continuity, NEIGHBORS, sph_continuity(h, W, &g.a, 1, g.out))                           \
  X(continuity_w, KERNEL, sph_continuity(LIST, h, &g.a, 1, g.out))                         \
  X(gradv, NEIGHBORS, sph_velocity_gradient(h, W, &g.a, g.out))                            \
  X(gradv_w, KERNEL, sph_velocity_gradient(LIST, h, &g.a, g.out))                          \
  X(gradient, NEIGHBORS, sph_gradient(h, W, &g.a, 1, 1, g.in, g.out))                      \
  X(gradient_w, KERNEL, sph_gradient(LIST, h, &g.a, 1, 1, g.in, g.out))                    \
  X(interpolate, NEIGHBORS, sph_interpolate(h, W, &g.a, 0, 1, g.in, g.out))                \
  X(interpolate_w, KERNEL, sph_interpolate(LIST, h, &g.a, 0, 1, g.in, g.out))              \
  X(at, NEIGHBORS, sph_interpolate_at(h, W, &g.a, 0, 1, g.in, 1, g.in, g.out))             \
  X(at_w, KERNEL, sph_interpolate_at(LIST, h, &g.a, 0, 1, g.in, 1, g.in, g.out))           \
  X(stress, NEIGHBORS, sph_stress_divergence(h, W, &g.a, 1, g.out))                        \
  X(stress_w, KERNEL, sph_stress_divergence(LIST, h, &g.a, 1, g.out))                      \
  X(pressure, NEIGHBORS, sph_pressure_gradient(h, W, &g.a, 1, g.out))                      \
  X(pressure_w, KERNEL, sph_pressure_gradient(LIST, h, &g.a, 1, g.out))                    \
  X(monaghan, NEIGHBORS, sph_viscosity_monaghan(h, W, &g.a, 1.0, 1.0, g.out))              \
  X(monaghan_w, KERNEL, sph_viscosity_monaghan(LIST, h, &g.a, 1.0, 1.0, g.out))            \
  X(bulk, NEIGHBORS, sph_viscosity_bulk(h, W, &g.a, &g.bulk, NULL, g.out))                 \
  X(bulk_w, KERNEL, sph_viscosity_bulk(LIST, h, &g.a, &g.bulk, NULL, g.out))               \
  X(xsph, NEIGHBORS, sph_xsph(h, W, &g.a, 0.5, g.out))                                     \
  X(xsph_w, KERNEL, sph_xsph(LIST, h, &g.a, 0.5, g.out))                                   \
  X(shepard, NEIGHBORS, sph_shepard_sum(h, W, &g.a, g.out))                                \
  X(shepard_w, KERNEL, sph_shepard_sum(LIST, h, &g.a, g.out))                              \
  X(matrix, NEIGHBORS, sph_gradient_matrix(h, W, &g.a, g.out, NULL, NULL))                 \
  X(matrix_w, KERNEL, sph_gradient_matrix(LIST, h, &g.a, g.out, NULL, NULL))               \
  X(def, NEIGHBORS, sph_deformation_gradient(h, W, &g.frozen, g.in, g.out))                \
  X(def_w, KERNEL, sph_deformation_gradient(LIST, h, &g.frozen, g.in, g.out))              \
  X(piola, NEIGHBORS, sph_piola_divergence(h, W, &g.frozen, 1, g.in, g.out))               \
  X(piola_w, KERNEL, sph_piola_divergence(LIST, h, &g.frozen, 1, g.in, g.out))             \
  X(springs, NEIGHBORS, SPRINGS(h, W, g.in, g.in, g.out))                                  \
  X(springs_w, KERNEL, SPRINGS(LIST, h, g.in, g.in, g.out))                                \
  X(tl_new, CONTEXT, sph_total_lagrangian_create(h, &g.tl_options, g.rubber, MADE))        \
  X(tl_new_law, MATERIAL, sph_total_lagrangian_create(CTX, &g.tl_options, h, MADE))        \
  X(tl_start, TOTAL_LAGRANGIAN, sph_total_lagrangian_start(h, SET))                        \
  X(tl_start_set, PARTICLES, sph_total_lagrangian_start(g.tl, h))                          \
  X(tl_dt, TOTAL_LAGRANGIAN, sph_total_lagrangian_time_step(h, SET, g.out))                \
  X(tl_dt_set, PARTICLES, sph_total_lagrangian_time_step(g.tl, h, g.out))                  \
  X(tl_step, TOTAL_LAGRANGIAN, sph_total_lagrangian_step(h, SET, 0.0, 1.0))                \
  X(tl_step_set, PARTICLES, sph_total_lagrangian_step(g.tl, h, 0.0, 1.0))                  \
  X(tl_energy, TOTAL_LAGRANGIAN, sph_total_lagrangian_energy(h, SET, 0.0, &g.energies))    \
  X(tl_energy_set, PARTICLES, sph_total_lagrangian_energy(g.tl, h, 0.0, &g.energies))      \
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
  X(density_step, CONTEXT, sph_density_step(h, 4, 1.0, g.in, g.in, g.out))                 \
  X(lattice, CONTEXT, sph_layout_lattice(h, &g.lattice, 0, NULL, &g.found))                \
  X(holes, CONTEXT, sph_layout_holes(h, &g.holes, 0, NULL, &g.found))                      \
  X(jitter, CONTEXT, sph_layout_jitter(h, 1, 0.1, 1, NULL, NULL, 1, g.out))                \
  X(volumes, CONTEXT, sph_layout_volumes(h, &g.region, 1, g.in, g.out))                    \
  X(new_ghosts, CONTEXT, sph_ghosts_create(h, NULL, MADE))                                 \
  X(add_wall, GHOSTS, sph_ghosts_add_wall(h, &g.wall, NULL))                               \
  X(set_wall, GHOSTS, sph_ghosts_set_wall(h, 0, &g.wall))                                  \
  X(get_wall, GHOSTS, sph_ghosts_get_wall(h, 0, &g.wall))                                  \
  X(set_mirror, GHOSTS, sph_ghosts_set_mirror(h, SPH_FIELD_E, SPH_MIRROR_LEAVE))           \
  X(ghosts_update, GHOSTS, sph_ghosts_update(h, SET, 0.0))                                 \
  X(ghosts_update_set, PARTICLES, sph_ghosts_update(g.ghosts, h, 0.0))                     \
  X(ghosts_refresh, GHOSTS, sph_ghosts_refresh(h, SET, 0.0))                               \
  X(ghosts_refresh_set, PARTICLES, sph_ghosts_refresh(g.ghosts, h, 0.0))                   \
  X(ghosts_prepare, GHOSTS, sph_ghosts_prepare(h, 0.0, SET, NULL, 0))                      \
  X(ghosts_prepare_set, PARTICLES, sph_ghosts_prepare(g.ghosts, 0.0, h, NULL, 0))          \
  X(recapture, GHOSTS, sph_ghosts_recapture(h, SET, NULL))                                 \
  X(recapture_set, PARTICLES, sph_ghosts_recapture(g.ghosts, h, NULL))                     \
  X(new_hold, CONTEXT, sph_hold_create(h, MADE))                                           \
  X(hold_field, HOLD, sph_hold_field(h, 1, 1, NULL, 0, 1, NULL, NULL, NULL))               \
  X(hold_traction, HOLD, sph_hold_traction(h, 1, NULL, 0, g.in, NULL, NULL, NULL))         \
  X(hold_clear, HOLD, sph_hold_clear(h))                                                   \
  X(hold_finish, HOLD, sph_hold_finish(h, 0.0, SET, NULL, 0))                              \
  X(hold_finish_set, PARTICLES, sph_hold_finish(g.hold, 0.0, h, NULL, 0))                  \
  X(new_points, CONTEXT, sph_stress_points_create(h, W, LIST, NULL, MADE))                 \
  X(new_points_w, KERNEL, sph_stress_points_create(CTX, h, LIST, NULL, MADE))              \
  X(new_points_list, NEIGHBORS, sph_stress_points_create(CTX, W, h, NULL, MADE))           \
  X(points_material, POINTS, sph_stress_points_set_material(h, 0, g.material))             \
  X(points_place, POINTS, sph_stress_points_place(h, SET))                                 \
  X(points_place_set, PARTICLES, sph_stress_points_place(g.points, h))                     \
  X(points_average, POINTS, sph_stress_points_average(h, SET))                             \
  X(points_average_set, PARTICLES, sph_stress_points_average(g.points, h))                 \
  X(points_rates, POINTS, sph_stress_points_rates(h, 0.0, SET, NULL, 0))                   \
  X(points_rates_set, PARTICLES, sph_stress_points_rates(g.points, 0.0, h, NULL, 0))       \
  X(points_bind, POINTS, sph_stress_points_bind(h, g.it))                                  \
  X(points_bind_it, INTEGRATOR, sph_stress_points_bind(g.points, h))

#define DEFINE_CALL(name, k, call) \
  static sph_status call_##name(void *h) { return call; }
HANDLE_CALLS(DEFINE_CALL)

typedef struct handle_call {
  const char *text;
  kind k;
  sph_status (*call)(void *h);
} handle_call;

#define LIST_CALL(name, k, call) {#call, k, call_##name},
static const handle_call handle_calls[] = {HANDLE_CALLS(LIST_CALL)};
enum { CALLS = sizeof handle_calls / sizeof *handle_calls };

static void expect(sph_status got, sph_status want, const char *text, int other) {
  if (got != want)
    fail_msg("%s with handle %d: %s, not %s", text, other, sph_status_name(got),
             sph_status_name(want));
}

static void test_handles(void **state) {
  (void)state;
  open_all();
  for (int c = 0; c < CALLS; c++) {
    const handle_call *x = &handle_calls[c];
    for (int other = 0; other < KINDS; other++) {
      if (other == (int)x->k) continue;
      g.made = NULL;
      expect(x->call(g.handle[other]), SPH_ERR_HANDLE, x->text, other);
      assert_null(g.made);
    }
    expect(x->call(NULL), SPH_ERR_ARG, x->text, -1);
    assert_null(g.made);
  }
  assert_int_equal(sph_particles_count(SET), 32); /* nothing of all that was done */
  close_all();
}

/* --- required pointers ------------------------------------------------------------------- */

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
#define NEW_SCHEME(o, made) sph_total_lagrangian_create(CTX, o, g.rubber, made)
#define OPERATOR_NULLS(X, f) X(f(NULL, g.out)) X(f(&g.a, NULL))
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
  X(sph_operands_from_set(SET, NULL))                               \
  OPERATOR_NULLS(X, DENSITY)                                        \
  OPERATOR_NULLS(X, CONTINUITY)                                     \
  OPERATOR_NULLS(X, VELOCITY_GRADIENT)                              \
  OPERATOR_NULLS(X, GRADIENT)                                       \
  OPERATOR_NULLS(X, INTERPOLATE)                                    \
  OPERATOR_NULLS(X, INTERPOLATE_AT)                                 \
  OPERATOR_NULLS(X, STRESS)                                         \
  OPERATOR_NULLS(X, PRESSURE)                                       \
  OPERATOR_NULLS(X, MONAGHAN)                                       \
  OPERATOR_NULLS(X, BULK)                                           \
  OPERATOR_NULLS(X, XSPH)                                           \
  OPERATOR_NULLS(X, SHEPARD)                                        \
  OPERATOR_NULLS(X, MATRIX)                                         \
  X(sph_gradient(LIST, W, &g.a, 1, 1, NULL, g.out))                 \
  X(sph_interpolate(LIST, W, &g.a, 0, 1, NULL, g.out))              \
  X(sph_interpolate_at(LIST, W, &g.a, 0, 1, NULL, 1, g.in, g.out))  \
  X(sph_interpolate_at(LIST, W, &g.a, 0, 1, g.in, 1, NULL, g.out))  \
  X(sph_viscosity_bulk(LIST, W, &g.a, NULL, NULL, g.out))           \
  X(sph_artificial_stress(1, 1, NULL, NULL, 1.0, 0.3, g.out))       \
  X(sph_artificial_stress(1, 1, g.in, NULL, 1.0, 0.3, NULL))        \
  X(sph_deformation_gradient(LIST, W, NULL, g.in, g.out))           \
  X(sph_deformation_gradient(LIST, W, &g.frozen, NULL, g.out))      \
  X(sph_deformation_gradient(LIST, W, &g.frozen, g.in, NULL))       \
  X(sph_piola_divergence(LIST, W, NULL, 1, g.in, g.out))            \
  X(sph_piola_divergence(LIST, W, &g.frozen, 1, NULL, g.out))       \
  X(sph_piola_divergence(LIST, W, &g.frozen, 1, g.in, NULL))        \
  X(SPRINGS(LIST, W, NULL, g.in, g.out))                            \
  X(SPRINGS(LIST, W, g.in, NULL, g.out))                            \
  X(SPRINGS(LIST, W, g.in, g.in, NULL))                             \
  X(NEW_SCHEME(NULL, MADE))                                         \
  X(NEW_SCHEME(&g.tl_options, NULL))                                \
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
  X(sph_density_step(CTX, 4, 1.0, g.in, g.in, NULL))                \
  X(sph_layout_lattice(CTX, NULL, 0, NULL, &g.found))               \
  X(sph_layout_lattice(CTX, &g.lattice, 0, NULL, NULL))             \
  X(sph_layout_lattice(CTX, &g.lattice, 9, NULL, &g.found))         \
  X(sph_layout_holes(CTX, NULL, 0, NULL, &g.found))                 \
  X(sph_layout_holes(CTX, &g.holes, 0, NULL, NULL))                 \
  X(sph_layout_holes(CTX, &g.holes, 9, NULL, &g.found))             \
  X(sph_layout_jitter(CTX, 1, 0.1, 1, NULL, NULL, 1, NULL))         \
  X(sph_layout_volumes(CTX, NULL, 1, g.in, g.out))                  \
  X(sph_layout_volumes(CTX, &g.region, 1, NULL, g.out))             \
  X(sph_layout_volumes(CTX, &g.region, 1, g.in, NULL))              \
  X(sph_ghosts_create(CTX, NULL, NULL))                             \
  X(sph_ghosts_add_wall(g.ghosts, NULL, NULL))                      \
  X(sph_ghosts_set_wall(g.ghosts, 0, NULL))                         \
  X(sph_ghosts_get_wall(g.ghosts, 0, NULL))                         \
  X(sph_hold_create(CTX, NULL))                                     \
  X(sph_hold_traction(g.hold, 1, NULL, 0, NULL, NULL, NULL, NULL))  \
  X(sph_hold_finish(g.hold, 0.0, SET, NULL, 1))                     \
  X(sph_stress_points_create(CTX, W, LIST, NULL, NULL))

static void test_pointers(void **state) {
  (void)state;
  open_all();
  g.made = NULL;
#define RUN(call) expect(call, SPH_ERR_ARG, #call, -1);
  POINTER_CALLS(RUN)
#undef RUN
  assert_null(g.made);
  /* a material takes NULL: it is removed; another kind is refused */
  check_ok(sph_rhs_set_material(g.rhs, 0, NULL));
  for (int k = 0; k < KINDS; k++)
    if (k != MATERIAL) check_status(sph_rhs_set_material(g.rhs, 0, g.handle[k]), SPH_ERR_HANDLE);
  close_all();
}

/* The operators and the law are fine with what the tables start from: the refusals are real. */
static void test_valid_calls(void **state) {
  (void)state;
  open_all();
  for (int c = 0; c < CALLS; c++) {
    const handle_call *x = &handle_calls[c];
    if (x->k != NEIGHBORS || strstr(x->text, "sph_neighbors") != NULL) continue;
    if (strstr(x->text, "(h, W") != NULL) expect(x->call(LIST), SPH_OK, x->text, -1);
  }
  check_ok(sph_material_stress_rate(g.material, &g.block, g.out));
  check_ok(sph_rhs_evaluate(g.rhs, SET, LIST, 0.0, &g.rate, 1));
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

/* --- is everything here? ----------------------------------------------------------------- */

enum { TEXT_ROOM = 1 << 20 };

/* Append a file to a text; 0 when it cannot be read. */
static int append_file(char *text, const char *path) {
  size_t used = strlen(text);
  FILE *f = fopen(path, "rb");
  if (!f) return 0;
  size_t n = fread(text + used, 1, TEXT_ROOM - 1 - used, f);
  assert_true(n > 0 && used + n < TEXT_ROOM - 1);
  (void)fclose(f);
  return 1;
}

/* The tests of this kind: this file and those of single subjects. */
static char *read_tests(void) {
  glob_t found;
  char *text = (char *)calloc(1, TEXT_ROOM);
  assert_non_null(text);
  if (glob("tests/api/test_null_*.c", 0, NULL, &found) == 0) {
    for (size_t k = 0; k < found.gl_pathc; ++k) assert_true(append_file(text, found.gl_pathv[k]));
    globfree(&found);
  }
  return text;
}

/* The name before the first parenthesis after SPH_API; 0 at a #define. */
static int name_of(const char *declaration, char *name, size_t room) {
  size_t end = strcspn(declaration, "(;\n"), begin = end, length;
  if (declaration[end] != '(') return 0;
  while (begin > 0 &&
         (isalnum((unsigned char)declaration[begin - 1]) || declaration[begin - 1] == '_'))
    begin--;
  length = end - begin;
  if (length < 5 || length >= room || strncmp(declaration + begin, "sph_", 4) != 0) return 0;
  memcpy(name, declaration + begin, length);
  name[length] = '\0';
  return 1;
}

/* Whether a text has the name as a whole word. */
static int has_word(const char *text, const char *name) {
  size_t length = strlen(name);
  for (const char *at = strstr(text, name); at; at = strstr(at + length, name))
    if (!isalnum((unsigned char)at[length]) && at[length] != '_') return 1;
  return 0;
}

static int missing_of(const char *path, const char *tested) {
  int missing = 0;
  char name[128], *header = (char *)calloc(1, TEXT_ROOM);
  assert_non_null(header);
  assert_true(append_file(header, path));
  for (const char *at = strstr(header, "SPH_API "); at; at = strstr(at + 8, "SPH_API "))
    if (name_of(at + 8, name, sizeof name) && !has_word(tested, name)) {
      print_error("%s is not tested with NULL\n", name);
      missing++;
    }
  free(header);
  return missing;
}

/* Run from the top of the tree, as the Makefile does; elsewhere there is nothing to read. */
static void test_complete(void **state) {
  (void)state;
  glob_t headers;
  char *tested = read_tests();
  int missing = 0;
  if (!*tested || glob("include/sph/*.h", 0, NULL, &headers) != 0) {
    free(tested);
    skip();
  }
  for (size_t k = 0; k < headers.gl_pathc; ++k)
    if (!strstr(headers.gl_pathv[k], "/base.h")) missing += missing_of(headers.gl_pathv[k], tested);
  globfree(&headers);
  free(tested);
  assert_int_equal(missing, 0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_handles),     cmocka_unit_test(test_pointers),
    cmocka_unit_test(test_valid_calls), cmocka_unit_test(test_getters),
    cmocka_unit_test(test_inits),       cmocka_unit_test(test_pure),
    cmocka_unit_test(test_complete),
};
SPH_TEST_MAIN(tests)
