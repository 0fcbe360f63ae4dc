/* A world with one object of each kind, and a table of every public function that answers a
 * status, called with sensible arguments. Tests run the whole table: with failing memory, on
 * several threads, with empty and single-particle sets, with values that are not finite.
 *
 * ew_missing() names the functions of a header that are not in the table. */
#ifndef SPH_TESTS_EVERYWHERE_H
#define SPH_TESTS_EVERYWHERE_H

#include "everywhere_world.h"

/* --- the table --------------------------------------------------------------------------- */

typedef sph_status (*ew_call)(everywhere *w);

/* Keep what a create function made just long enough to see that it did. */
#define EW_CREATE(type, call)                                      \
  type *made = NULL;                                               \
  sph_status s = call;                                             \
  w->made = made != NULL;                                          \
  if ((s == SPH_OK) != (made != NULL)) return SPH_STATUS_RESERVED; \
  type##_destroy(made);                                            \
  return s

static sph_status ew_particles_create(everywhere *w) {
  sph_particles_options o;
  sph_particles_options_init(&o);
  o.dim = w->dim;
  o.capacity = w->n;
  EW_CREATE(sph_particles, sph_particles_create(w->ctx, &o, &made));
}
static sph_status ew_kernel_create(everywhere *w) {
  EW_CREATE(sph_kernel, sph_kernel_create(w->ctx, SPH_KERNEL_LUCY, w->dim, &made));
}
static sph_status ew_kernel_create_callback(everywhere *w) {
  EW_CREATE(sph_kernel, sph_kernel_create_callback(w->ctx, 1, 1.0, ew_profile, NULL, &made));
}
static sph_status ew_kernel_create_table(everywhere *w) {
  double p[5], dp[5];
  for (int k = 0; k < 5; k++) ew_profile(NULL, 0.25 * k, &p[k], &dp[k]);
  EW_CREATE(sph_kernel, sph_kernel_create_table(w->ctx, 1, 1.0, 5, p, dp, 1, &made));
}
static sph_status ew_neighbors_create(everywhere *w) {
  EW_CREATE(sph_neighbors, sph_neighbors_create(w->ctx, NULL, &made));
}
static sph_status ew_material_create(everywhere *w) {
  sph_material_functions f;
  sph_material_functions_init(&f);
  f.pressure = ew_law;
  EW_CREATE(sph_material, sph_material_create(w->ctx, &f, NULL, &made));
}
static sph_status ew_material_create_hooke(everywhere *w) {
  sph_hooke_options h;
  sph_hooke_options_init(&h);
  h.young = h.density = 1.0;
  EW_CREATE(sph_material, sph_material_create_hooke(w->ctx, &h, &made));
}
static sph_status ew_rhs_create(everywhere *w) {
  EW_CREATE(sph_rhs, sph_rhs_create(w->ctx, w->kernel, NULL, &made));
}
static sph_status ew_integrator_create(everywhere *w) {
  static const double a[] = {0.0, 0.0, 1.0, 0.0}, b[] = {0.5, 0.5};
  sph_integrator_options o;
  sph_integrator_options_init(&o);
  o.method = SPH_INTEGRATOR_BUTCHER;
  o.butcher_stages = 2;
  o.butcher_a = a;
  o.butcher_b = b;
  EW_CREATE(sph_integrator, sph_integrator_create(w->ctx, &o, &made));
}

static sph_status ew_remove(everywhere *w) {
  static const int64_t first = 0;
  return sph_particles_remove(w->set, w->rows > 0, &first);
}
static sph_status ew_sort(everywhere *w) {
  check_ok(sph_particles_clear_ghosts(w->set)); /* allocates nothing */
  return sph_particles_sort(w->set, 0.7, NULL);
}
static sph_status ew_add(everywhere *w) {
  check_ok(sph_particles_clear_ghosts(w->set));
  return sph_particles_add(w->set, 500, &w->number);
}
static sph_status ew_add_field(everywhere *w) {
  int32_t id = 0;
  sph_status s = sph_particles_add_field(w->set, "temperature", 2, &id);
  w->number = id;
  return s;
}
static sph_status ew_field(everywhere *w) {
  double *array;
  return sph_particles_field(w->set, SPH_FIELD_A, &array);
}
static sph_status ew_take_back(everywhere *w) {
  for (int k = 0; k < EW_OUT; k++) w->out[k] = 0.25;
  check_ok(sph_particles_lend(w->set, SPH_FIELD_SPACING, w->out, EW_OUT));
  sph_status s = sph_particles_lend(w->set, SPH_FIELD_SPACING, NULL, 0);
  if (s != SPH_OK) check_ok(sph_particles_lend(w->set, SPH_FIELD_SPACING, w->more, EW_OUT));
  for (int k = 0; k < EW_OUT; k++) w->out[k] = -7.0;
  return s;
}
static sph_status ew_evaluate_kernel(everywhere *w) {
  static const double r[] = {0.0, 0.3, 1.7, 5.0};
  return sph_kernel_evaluate(w->kernel, 4, r, 1.1, w->out, w->out + 4, w->out + 8, w->out + 12);
}
static sph_status ew_query(everywhere *w) {
  double at[3] = {0.0, 0.0, 0.0};
  int32_t near[64];
  sph_status s = sph_neighbors_query(w->list, at, 2.0, 64, near, &w->number);
  for (int64_t k = 0; s == SPH_OK && k < w->number && k < 64; k++) w->out[k] = near[k];
  return s;
}
static sph_status ew_rows(everywhere *w) {
  const int64_t *offsets;
  const int32_t *indices;
  sph_status s = sph_neighbors_rows(w->list, &offsets, &indices);
  if (s == SPH_OK) w->number = offsets[w->n];
  for (int64_t k = 0; s == SPH_OK && k < w->number && k < EW_OUT; k++) w->out[k] = indices[k];
  return s;
}
/* h a little larger, so that there are more pairs than there is room for. */
static sph_status ew_build_arrays(everywhere *w) {
  return sph_neighbors_build_arrays(w->list, w->dim, w->n, w->a.x, NULL, 3.0);
}
static sph_status ew_update_arrays(everywhere *w) {
  int32_t rebuilt = 0;
  sph_status s = sph_neighbors_update_arrays(w->list, w->dim, w->n, w->a.x, NULL, 3.0, &rebuilt);
  w->number = rebuilt;
  return s;
}
static sph_status ew_update(everywhere *w) {
  check_ok(sph_particles_touch(w->set, SPH_FIELD_X));
  return sph_neighbors_update(w->list, w->set, NULL);
}
static sph_material_block ew_block(everywhere *w) {
  sph_material_block b;
  sph_material_block_init(&b);
  b.dim = w->dim;
  b.n = w->n;
  b.velocity_gradient = w->more;
  b.sigma = w->a.sigma;
  b.rho = w->a.rho;
  return b;
}
static sph_status ew_stress_rate(everywhere *w) {
  sph_material_block b = ew_block(w);
  return sph_material_stress_rate(w->hooke, &b, w->out);
}
static sph_status ew_sound_speed(everywhere *w) {
  sph_material_block b = ew_block(w);
  return sph_material_sound_speed(w->hooke, &b, w->out);
}
/* Of a configuration in which every particle has moved by the same: F is the identity. */
static sph_status ew_deformation(everywhere *w) {
  sph_operands a = w->a;
  a.gradient_matrix = w->ones;
  return sph_deformation_gradient(w->list, w->kernel, &a, w->points, w->out);
}
static sph_status ew_piola(everywhere *w) {
  for (int k = 0; k < EW_OUT; k++) w->more[k] = 0.25 * (k % 9);
  sph_status s = sph_piola_divergence(w->list, w->kernel, &w->a, SPH_PIOLA_SUMMED, w->more, w->out);
  for (int k = 0; k < EW_OUT; k++) w->more[k] = -7.0;
  return s;
}
/* Hooke's law has no pressure, and says so; these allocate nothing all the same. */
static sph_status ew_unsupported(sph_status s) { return s == SPH_ERR_UNSUPPORTED ? SPH_OK : s; }
static sph_status ew_energy(everywhere *w) {
  sph_material_block b = ew_block(w);
  return ew_unsupported(sph_material_energy(w->hooke, &b, w->out));
}
static sph_status ew_derivatives(everywhere *w) {
  sph_material_block b = ew_block(w);
  return ew_unsupported(sph_material_pressure_derivatives(w->hooke, &b, w->out, w->more));
}
static sph_status ew_pressure(everywhere *w) {
  sph_material_block b = ew_block(w);
  return ew_unsupported(sph_material_pressure(w->hooke, &b, w->out));
}
static sph_status ew_shear_speed(everywhere *w) {
  sph_material_block b = ew_block(w);
  return sph_material_shear_speed(w->hooke, &b, w->out);
}
static sph_status ew_small_strain(everywhere *w) {
  sph_material_block b = ew_block(w);
  b.strain = w->a.sigma;
  return sph_material_small_strain_stress(w->hooke, &b, w->out);
}
static sph_status ew_first_piola(everywhere *w) {
  return sph_material_first_piola(w->hooke, w->dim, w->n, w->more, w->out, NULL);
}
static sph_status ew_cauchy(everywhere *w) {
  return sph_material_cauchy_stress(w->hooke, w->dim, w->n, w->more, w->out);
}
static sph_status ew_bulk(everywhere *w) {
  sph_bulk_viscosity o;
  sph_bulk_viscosity_init(&o);
  o.neumann = o.linear = o.spacing = o.hk_alpha = o.hk_beta = 1.0;
  return sph_viscosity_bulk(w->list, w->kernel, &w->a, &o, w->more, w->out);
}
static sph_status ew_matrix(everywhere *w) {
  return sph_gradient_matrix(w->list, w->kernel, &w->a, w->out, w->more, &w->number);
}
static sph_status ew_at(everywhere *w) {
  return sph_interpolate_at(w->list, w->kernel, &w->a, 1, w->n, w->points, w->dim, w->a.v, w->out);
}
static sph_status ew_add_term(everywhere *w) {
  sph_rhs *rhs = NULL;
  sph_term t = rh_term(SPH_TERM_STRESS, 0, 1);
  sph_status s = sph_rhs_create(w->ctx, w->kernel, NULL, &rhs);
  if (s == SPH_OK) check_ok(sph_rhs_add(rhs, &t)); /* these allocate nothing */
  if (s == SPH_OK) check_ok(sph_rhs_add_host(rhs, SPH_FIELD_V, ew_pair, NULL));
  if (s == SPH_OK) check_ok(sph_rhs_set_material(rhs, 0, w->hooke));
  if (s == SPH_OK) check_ok(sph_rhs_set_prepare(rhs, ew_hook, NULL));
  if (s == SPH_OK) check_ok(sph_rhs_set_finish(rhs, ew_hook, NULL));
  sph_rhs_destroy(rhs);
  return s;
}
static sph_status ew_evaluate(everywhere *w) {
  sph_rate rates[] = {{SPH_FIELD_X, w->out},
                      {SPH_FIELD_V, w->out + EW_OUT / 4},
                      {SPH_FIELD_SIGMA, w->out + EW_OUT / 2},
                      {SPH_FIELD_RHO, w->more}};
  return sph_rhs_evaluate(w->rhs, w->set, w->list, 0.0, rates, 4);
}
static sph_status ew_bind(everywhere *w) {
  sph_integrator *it = NULL;
  sph_status s = sph_integrator_create(w->ctx, NULL, &it);
  if (s == SPH_OK) check_ok(sph_integrator_bind_field(it, SPH_FIELD_V));
  if (s == SPH_OK) check_ok(sph_integrator_bind_array(it, w->out, 8));
  if (s == SPH_OK) check_ok(sph_integrator_set_function(it, ew_decay, NULL));
  if (s == SPH_OK) check_ok(sph_integrator_set_rhs(it, w->rhs, w->list));
  sph_integrator_destroy(it);
  return s;
}
static sph_status ew_step(everywhere *w) {
  sph_step_info info;
  sph_step_info_init(&info);
  info.want_error = 1;
  sph_status s = sph_integrator_step(w->it, w->set, 0.0, 0.25, &info);
  if (s == SPH_OK) w->out[0] = info.error;
  return s;
}
static CHECK_UNUSED int32_t ew_filter(void *user, double t, sph_particles *set, int32_t copy,
                                      const sph_rate *values, int32_t count) {
  (void)user, (void)t, (void)set, (void)copy, (void)values, (void)count;
  return 0;
}
static sph_status ew_predicted(everywhere *w) {
  sph_integrator *it = NULL;
  sph_integrator_options o;
  sph_integrator_options_init(&o);
  o.method = SPH_INTEGRATOR_LEAPFROG_PREDICTED;
  sph_status s = sph_integrator_create(w->ctx, &o, &it);
  if (s == SPH_OK) check_ok(sph_integrator_bind_field(it, SPH_FIELD_V));
  if (s == SPH_OK) check_ok(sph_integrator_set_function(it, ew_decay, NULL));
  if (s == SPH_OK) check_ok(sph_integrator_set_filter(it, ew_filter, NULL));
  if (s == SPH_OK) s = sph_integrator_save(it, w->set);
  if (s == SPH_OK) s = sph_integrator_step(it, w->set, 0.0, 0.25, NULL);
  if (s == SPH_OK) check_ok(sph_integrator_restart(it));
  sph_integrator_destroy(it);
  return s;
}
static sph_status ew_cfl(everywhere *w) { return sph_cfl_step(w->set, 0.5, w->out); }
static sph_status ew_adapt(everywhere *w) {
  sph_neighbors_options lo;
  sph_adapt_options o;
  sph_neighbors *list = NULL;
  sph_neighbors_options_init(&lo);
  sph_adapt_options_init(&o);
  lo.h_rule = SPH_H_MAX;
  o.keep = 1;
  sph_status s = sph_neighbors_create(w->ctx, &lo, &list);
  if (s == SPH_OK) s = sph_adapt_smoothing(list, w->kernel, w->set, &o, NULL);
  sph_neighbors_destroy(list);
  return s;
}
static sph_status ew_holes(everywhere *w) {
  const double hole[3] = {0.5, 0.5, 0.25};
  sph_hole_layout_options o;
  sph_hole_layout_options_init(&o);
  o.holes = 1;
  o.hole = hole;
  o.spacing = 0.25;
  return sph_layout_holes(w->ctx, &o, 64, w->out, &w->number);
}
static sph_status ew_relax(everywhere *w) {
  const double points[6] = {0.125, 0.25, 0.375, 0.5, 0.625, 0.75};
  sph_region_options r;
  sph_region_options_init(&r);
  r.dim = 2;
  memcpy(w->more, points, sizeof points);
  sph_status s = sph_layout_relax(w->ctx, &r, NULL, 3, w->more, w->out, NULL);
  for (int k = 0; s != SPH_OK && k < 6; k++) w->more[k] = -7.0;
  return s;
}
static sph_status ew_materials(everywhere *w) {
  sph_material_layout_options o;
  sph_material_layout_options_init(&o);
  o.dim = w->dim;
  o.kind = SPH_LAYOUT_RELAXED;
  o.spacing = 0.5;
  int32_t phase[8];
  return sph_layout_materials(w->ctx, &o, 8, w->out, phase, w->more, &w->number);
}
static sph_status ew_signal(everywhere *w) { return sph_signal_step(w->list, &w->a, 0.25, w->out); }
static sph_status ew_density_step(everywhere *w) {
  double dt = -7.0;
  sph_status s = sph_density_step(w->ctx, w->rows, 0.1, w->a.rho, w->a.v, &dt);
  w->out[0] = isinf(dt) ? 0.0 : dt; /* nobody sets a limit */
  return s;
}
static sph_status ew_memory(everywhere *w) {
  return sph_context_memory(w->ctx, &w->number, NULL, NULL);
}

#define EW_OPERATOR(name, ...) \
  static sph_status ew_##name(everywhere *w) { return sph_##name(w->list, w->kernel, __VA_ARGS__); }
EW_OPERATOR(density_summation, &w->a, w->out)
EW_OPERATOR(continuity, &w->a, SPH_CONTINUITY_VOLUME, w->out)
EW_OPERATOR(velocity_gradient, &w->a, w->out)
EW_OPERATOR(gradient, &w->a, SPH_GRADIENT_DIFFERENCE, w->dim, w->a.v, w->out)
EW_OPERATOR(interpolate, &w->a, 1, w->dim, w->a.v, w->out)
EW_OPERATOR(stress_divergence, &w->a, SPH_STRESS_SUMMED, w->out)
EW_OPERATOR(pressure_gradient, &w->a, SPH_PRESSURE_NUMBER, w->out)
EW_OPERATOR(viscosity_monaghan, &w->a, 1.0, 2.0, w->out)
EW_OPERATOR(xsph, &w->a, 0.5, w->out)
EW_OPERATOR(shepard_sum, &w->a, w->out)

#define EW_SIMPLE(name, call) \
  static sph_status ew_##name(everywhere *w) { return call; }
EW_SIMPLE(reserve, sph_particles_reserve(w->set, 5000))
EW_SIMPLE(add_ghosts, sph_particles_add_ghosts(w->set, 700, &w->number))
EW_SIMPLE(clear_ghosts, sph_particles_clear_ghosts(w->set))
EW_SIMPLE(touch, sph_particles_touch(w->set, SPH_FIELD_V))
EW_SIMPLE(build, sph_neighbors_build(w->list, w->set))
EW_SIMPLE(from_set, sph_operands_from_set(w->set, &w->a))
EW_SIMPLE(artificial, sph_artificial_stress(w->dim, w->n, w->a.sigma, w->a.rho, 1.0, 0.3, w->out))
EW_SIMPLE(h_density, sph_h_from_density(w->ctx, w->dim, w->n, w->a.h, w->a.rho, w->a.m, w->out))
EW_SIMPLE(h_mass, sph_h_from_mass(w->ctx, w->dim, w->n, 1.2, w->a.m, w->a.rho, w->out))
EW_SIMPLE(h_rate, sph_h_rate(w->ctx, w->dim, w->n, w->a.h, w->a.rho, w->a.p, w->out))
EW_SIMPLE(h_spacing, sph_h_from_spacing(w->ctx, w->n, 1.5, w->a.h, w->out))
EW_SIMPLE(principal, sph_principal_stresses(w->dim, w->n, w->a.sigma, w->out, w->more))
EW_SIMPLE(recapture, sph_ghosts_recapture(w->ghosts, w->set, &w->number))
EW_SIMPLE(save, sph_integrator_save(w->it, w->set))
EW_SIMPLE(restore, sph_integrator_restore(w->saved, w->set))
EW_SIMPLE(loop, sph_parallel_for(w->ctx, 8, 1, ew_ones, w))
EW_SIMPLE(coefficients, sph_rkc_coefficients(5, 1, w->out, NULL, NULL, NULL, w->more))

/* PAIRS: row i of `out` depends on what lies within two supports of i only.
 * OUTPUT: `out` is undefined after a failure. WRITES: revisions may grow then. */
enum { EW_PAIRS = 1, EW_OUTPUT = 2, EW_WRITES = 4 };

typedef struct ew_entry {
  const char *name; /* of the function, or of all that it calls */
  ew_call call;
  int flags;
  int32_t allocates;
} ew_entry;

static const ew_entry ew_entries[] = {
    {"sph_context_memory", ew_memory, 0, 0},
    {"sph_parallel_for", ew_loop, 0, 0},
    {"sph_particles_create", ew_particles_create, 0, 1},
    {"sph_particles_reserve", ew_reserve, 0, 1},
    {"sph_particles_add", ew_add, EW_WRITES, 1},
    {"sph_particles_add_ghosts", ew_add_ghosts, 0, 1},
    {"sph_particles_clear_ghosts", ew_clear_ghosts, 0, 0},
    {"sph_particles_remove", ew_remove, 0, 1},
    {"sph_particles_sort", ew_sort, EW_WRITES, 1},
    {"sph_particles_add_field", ew_add_field, 0, 1},
    {"sph_particles_field", ew_field, 0, 1},
    {"sph_particles_lend", ew_take_back, EW_WRITES, 1},
    {"sph_particles_touch", ew_touch, 0, 0},
    {"sph_kernel_create", ew_kernel_create, 0, 1},
    {"sph_kernel_create_callback", ew_kernel_create_callback, 0, 1},
    {"sph_kernel_create_table", ew_kernel_create_table, 0, 1},
    {"sph_kernel_evaluate", ew_evaluate_kernel, 0, 0},
    {"sph_neighbors_create", ew_neighbors_create, 0, 1},
    {"sph_neighbors_build", ew_build, 0, 1},
    {"sph_neighbors_build_arrays", ew_build_arrays, 0, 1},
    {"sph_neighbors_update", ew_update, EW_WRITES, 1},
    {"sph_neighbors_update_arrays", ew_update_arrays, 0, 1},
    {"sph_neighbors_rows", ew_rows, 0, 1},
    {"sph_neighbors_query", ew_query, 0, 0},
    {"sph_material_create", ew_material_create, 0, 1},
    {"sph_material_create_hooke", ew_material_create_hooke, 0, 1},
    {"sph_material_stress_rate", ew_stress_rate, 0, 0},
    {"sph_material_pressure", ew_pressure, 0, 0},
    {"sph_material_sound_speed", ew_sound_speed, 0, 0},
    {"sph_material_shear_speed", ew_shear_speed, 0, 0},
    {"sph_material_small_strain_stress", ew_small_strain, 0, 0},
    {"sph_material_first_piola", ew_first_piola, 0, 0},
    {"sph_material_cauchy_stress", ew_cauchy, 0, 0},
    {"sph_material_energy", ew_energy, 0, 0},
    {"sph_material_pressure_derivatives", ew_derivatives, 0, 0},
    {"sph_operands_from_set", ew_from_set, 0, 0},
    {"sph_density_summation", ew_density_summation, EW_PAIRS, 1},
    {"sph_continuity", ew_continuity, EW_PAIRS, 1},
    {"sph_velocity_gradient", ew_velocity_gradient, EW_PAIRS, 1},
    {"sph_gradient", ew_gradient, EW_PAIRS, 1},
    {"sph_interpolate", ew_interpolate, EW_PAIRS, 1},
    {"sph_interpolate_at", ew_at, EW_PAIRS, 1},
    {"sph_stress_divergence", ew_stress_divergence, EW_PAIRS, 1},
    {"sph_pressure_gradient", ew_pressure_gradient, EW_PAIRS, 1},
    {"sph_viscosity_monaghan", ew_viscosity_monaghan, EW_PAIRS, 1},
    {"sph_viscosity_bulk", ew_bulk, EW_PAIRS, 1},
    {"sph_artificial_stress", ew_artificial, EW_PAIRS, 0},
    {"sph_xsph", ew_xsph, EW_PAIRS, 1},
    {"sph_shepard_sum", ew_shepard_sum, EW_PAIRS, 1},
    {"sph_gradient_matrix", ew_matrix, EW_PAIRS, 1},
    {"sph_deformation_gradient", ew_deformation, EW_PAIRS, 1},
    {"sph_piola_divergence", ew_piola, EW_PAIRS, 1},
    {"sph_principal_stresses", ew_principal, 0, 0},
    {"sph_ghosts_recapture", ew_recapture, 0, 0},
    {"sph_h_from_density", ew_h_density, 0, 0},
    {"sph_h_rate", ew_h_rate, 0, 0},
    {"sph_h_from_spacing", ew_h_spacing, 0, 0},
    {"sph_rhs_create", ew_rhs_create, 0, 1},
    {"sph_rhs_add sph_rhs_add_host sph_rhs_set_material sph_rhs_set_prepare sph_rhs_set_finish",
     ew_add_term, 0, 1},
    {"sph_rhs_evaluate", ew_evaluate, EW_OUTPUT, 1},
    {"sph_adapt_smoothing", ew_adapt, EW_WRITES, 1},
    {"sph_layout_holes", ew_holes, 0, 0},
    {"sph_layout_relax", ew_relax, 0, 1},
    {"sph_layout_materials", ew_materials, 0, 1},
    {"sph_h_from_mass", ew_h_mass, 0, 0},
    {"sph_signal_step", ew_signal, 0, 1},
    {"sph_density_step", ew_density_step, 0, 0},
    {"sph_integrator_create", ew_integrator_create, 0, 1},
    {"sph_integrator_bind_field sph_integrator_bind_array sph_integrator_set_function "
     "sph_integrator_set_rhs",
     ew_bind, 0, 1},
    {"sph_integrator_step", ew_step, EW_WRITES, 1},
    {"sph_integrator_step sph_integrator_set_filter sph_integrator_restart", ew_predicted,
     EW_WRITES, 1},
    {"sph_integrator_save", ew_save, 0, 1},
    {"sph_integrator_restore", ew_restore, EW_WRITES, 0},
    {"sph_rkc_coefficients", ew_coefficients, 0, 0},
    {"sph_cfl_step", ew_cfl, 0, 0},
};
enum { EW_ENTRIES = sizeof ew_entries / sizeof *ew_entries };

/* --- what a test sees of it -------------------------------------------------------------- */

static CHECK_UNUSED uint64_t ew_hash(uint64_t h, const void *data, size_t bytes) {
  const unsigned char *p = (const unsigned char *)data;
  for (; bytes >= 8; bytes -= 8, p += 8) {
    uint64_t word;
    memcpy(&word, p, sizeof word);
    h = ((h ^ word) * UINT64_C(0x9e3779b97f4a7c15)) ^ (h >> 29);
  }
  for (; bytes > 0; bytes--) h = (h ^ *p++) * UINT64_C(1099511628211);
  return h;
}

/* Everything a host can read of the set; with_counters: generation and revisions too. */
static CHECK_UNUSED uint64_t ew_set_state(const everywhere *w, int with_counters) {
  int64_t n = sph_particles_count(w->set), real = sph_particles_real_count(w->set);
  uint64_t h = ew_hash(ew_hash(1, &n, sizeof n), &real, sizeof real);
  uint64_t generation = sph_particles_generation(w->set);
  if (with_counters) h = ew_hash(h, &generation, sizeof generation);
  for (int32_t f = 0; f < 64 + 2; f += f == EW_FIELDS ? 64 - EW_FIELDS : 1) {
    const double *v = sph_particles_field_const(w->set, f);
    uint64_t revision = sph_particles_revision(w->set, f);
    size_t each = (size_t)sph_particles_components(w->set, f) * sizeof(double);
    if (with_counters) h = ew_hash(h, &revision, sizeof revision);
    if (v && f != SPH_FIELD_SPACING) h = ew_hash(h, v, (size_t)n * each);
  }
  h = ew_hash(h, sph_particles_roles(w->set), (size_t)n * sizeof(int32_t));
  h = ew_hash(h, sph_particles_phases(w->set), (size_t)n * sizeof(int32_t));
  return ew_hash(h, sph_particles_ids(w->set), (size_t)n * sizeof(int64_t));
}

/* Makes the rows, which the list then keeps. */
static CHECK_UNUSED uint64_t ew_list_state(const everywhere *w) {
  const int64_t *offsets;
  const int32_t *indices;
  int64_t n = sph_neighbors_count(w->list), builds = sph_neighbors_builds(w->list);
  check_ok(sph_neighbors_rows(w->list, &offsets, &indices));
  uint64_t h = ew_hash(ew_hash(1, &n, sizeof n), &builds, sizeof builds);
  h = ew_hash(h, offsets, (size_t)(n + 1) * sizeof *offsets);
  return ew_hash(h, indices, (size_t)offsets[n] * sizeof *indices);
}

static CHECK_UNUSED uint64_t ew_output(const everywhere *w) {
  uint64_t h = ew_hash(ew_hash(1, w->out, sizeof w->out), w->more, sizeof w->more);
  return ew_hash(h, &w->made, sizeof w->made);
}

/* --- is every function here? ------------------------------------------------------------- */

static CHECK_UNUSED int ew_has(const char *name, size_t length) {
  for (int k = 0; k < EW_ENTRIES; k++)
    for (const char *at = strstr(ew_entries[k].name, "sph_"); at; at = strstr(at + 1, "sph_"))
      if (strncmp(at, name, length) == 0 && (at[length] == '\0' || at[length] == ' ')) return 1;
  return 0;
}

enum { EW_TEXT = 1 << 22 };

/* Append a file to a text when it contains a word. */
static CHECK_UNUSED void ew_append(char *text, const char *path, const char *word) {
  size_t used = strlen(text);
  FILE *file = fopen(path, "rb");
  assert_non_null(file);
  size_t n = fread(text + used, 1, EW_TEXT - 1 - used, file);
  assert_true(n > 0 && used + n < EW_TEXT - 1);
  text[used + n] = '\0';
  (void)fclose(file);
  if (!strstr(text + used, word)) text[used] = '\0';
}

static CHECK_UNUSED int ew_has_word(const char *text, const char *name, size_t length) {
  for (const char *at = strchr(text, 's'); at; at = strchr(at + 1, 's'))
    if (strncmp(at, name, length) == 0 && !isalnum((unsigned char)at[length]) && at[length] != '_')
      return 1;
  return 0;
}

/* Functions of a header that answer a status, are not in the table, nor named in `others`. */
static CHECK_UNUSED int ew_missing(const char *path, const char *others) {
  static const char declaration[] = "SPH_API sph_status ";
  char *text = (char *)calloc(1, EW_TEXT);
  int missing = 0;
  assert_non_null(text);
  ew_append(text, path, "");
  for (const char *at = strstr(text, declaration); at; at = strstr(at + 1, declaration)) {
    const char *name = at + sizeof declaration - 1;
    size_t length = strcspn(name, "(");
    /* What takes no handle has no allocator either. */
    int pure =
        strncmp(name + length, "(sph_", 5) != 0 && strncmp(name + length, "(const sph_", 11) != 0;
    if (pure || ew_has(name, length) || ew_has_word(others, name, length)) continue;
    print_error("%.*s is not tested with failing memory\n", (int)length, name);
    missing++;
  }
  free(text);
  return missing;
}

#endif
