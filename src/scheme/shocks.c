/* Shocks. Options, terms, creation, steps, parts; one evaluation is in shocks_evaluate.c, the start
 * in shocks_start.c. Everything is done with public functions: copy what you want to change. */
#include "shocks_impl.h"

#include "../material/material_impl.h"

#include <math.h>

/* ---- options ----------------------------------------------------------------------------- */

static const sph_shocks_options defaults = {.size = sizeof defaults,
                                            .kernel = SPH_KERNEL_GAUSSIAN,
                                            .smoothing = SPH_SMOOTHING_NUMBER,
                                            .density = SPH_SHOCKS_DIFFERENTIAL,
                                            .eta = 1.2,
                                            .adaptive = 1,
                                            .omega_floor = 0.2,
                                            .integrator = SPH_INTEGRATOR_LEAPFROG_PREDICTED,
                                            .cfl = 0.25,
                                            .density_limit = 0.1,
                                            .neighbors = SPH_NEIGHBORS_CELLS,
                                            .skin = 0.2,
                                            .audit = 1};

void sph_shocks_options_init_sized(sph_shocks_options *options, size_t size) {
  sphi_options_init(options, size, &defaults, sizeof defaults);
}

static int in(int32_t x, int32_t lo, int32_t hi) { return x >= lo && x <= hi; }
static int positive(double x) { return isfinite(x) && x > 0.0; }
static int not_negative(double x) { return isfinite(x) && x >= 0.0; }

static sph_status check_numbers(sph_context *ctx, const sph_shocks_options *o) {
  if (!in(o->smoothing, SPH_SMOOTHING_MASS, SPH_SMOOTHING_NUMBER) ||
      !in(o->density, SPH_SHOCKS_DIFFERENTIAL, SPH_SHOCKS_INTEGRAL))
    return sphi_fail(ctx, SPH_ERR_ARG, "shocks: smoothing %d, density %d", (int)o->smoothing,
                     (int)o->density);
  if (!positive(o->eta) || !not_negative(o->omega_floor) || !positive(o->cfl) ||
      !not_negative(o->skin) || !(o->density_limit > 0.0))
    return sphi_fail(ctx, SPH_ERR_ARG,
                     "shocks: eta %g, omega_floor %g, cfl %g, skin %g, density_limit %g", o->eta,
                     o->omega_floor, o->cfl, o->skin, o->density_limit);
  return SPH_OK;
}

/* What the parts do not check themselves when they are created. */
static sph_status check_options(sph_context *ctx, const sph_shocks_options *o) {
  sph_status s = check_numbers(ctx, o);
  if (s) return s;
  if (o->density == SPH_SHOCKS_INTEGRAL && o->smoothing == SPH_SMOOTHING_VOLUME)
    return sphi_fail(ctx, SPH_ERR_UNSUPPORTED, "shocks: smoothing VOLUME has no density sum");
  if (o->density == SPH_SHOCKS_INTEGRAL && !o->adaptive)
    return sphi_fail(ctx, SPH_ERR_ARG, "shocks: INTEGRAL solves for h, and needs adaptive");
  if (o->integrator == SPH_INTEGRATOR_BUTCHER || o->integrator == SPH_INTEGRATOR_RKC)
    return sphi_fail(ctx, SPH_ERR_UNSUPPORTED,
                     "shocks: tableaux and RKC need an integrator of the host");
  if (o->audit && o->integrator == SPH_INTEGRATOR_LEAPFROG)
    return sphi_fail(ctx, SPH_ERR_UNSUPPORTED, "shocks: this leapfrog carries no ledger");
  return SPH_OK;
}

static sph_status read_dissipation(sph_context *ctx, const sph_shocks_options *o,
                                   sph_dissipation *out) {
  sph_dissipation_init(out);
  if (!o->dissipation && o->density == SPH_SHOCKS_INTEGRAL) out->mass_flux = 0.0;
  sph_status s = sphi_options_read(ctx, out, sizeof *out, o->dissipation);
  if (s || o->density != SPH_SHOCKS_INTEGRAL || out->mass_flux == 0.0) return s;
  return sphi_fail(ctx, SPH_ERR_ARG, "shocks: INTEGRAL takes no mass flux, not %g", out->mass_flux);
}

/* ---- terms ------------------------------------------------------------------------------- */

static sph_status add(sph_rhs *rhs, int32_t kind, int32_t form) {
  sph_term term;
  sph_term_init(&term);
  term.kind = kind;
  term.form = form;
  return sph_rhs_add(rhs, &term);
}

static sph_status add_dissipation(const sph_shocks *shocks) {
  sph_term term;
  sph_term_init(&term);
  term.kind = SPH_TERM_DISSIPATION;
  term.dissipation = &shocks->dissipation;
  return sph_rhs_add(shocks->rhs, &term);
}

static sph_status add_body_force(const sph_shocks *shocks) {
  sph_term term;
  int any = 0;
  sph_term_init(&term);
  term.kind = SPH_TERM_BODY_FORCE;
  for (int a = 0; a < 3; ++a) any |= (term.vector[a] = shocks->options.body_force[a]) != 0.0;
  return any ? sph_rhs_add(shocks->rhs, &term) : SPH_OK;
}

static sph_status add_terms(const sph_shocks *shocks) {
  sph_status s = add(shocks->rhs, SPH_TERM_MOTION, 0);
  if (!s) s = add(shocks->rhs, SPH_TERM_SMOOTHED, shocks->options.smoothing);
  if (!s) s = add_dissipation(shocks);
  return s ? s : add_body_force(shocks);
}

/* ---- creation ---------------------------------------------------------------------------- */

static sph_status make_fixed_parts(sph_shocks *shocks) {
  const sph_shocks_options *o = &shocks->options;
  sph_status s = sph_kernel_create(shocks->base.ctx, o->kernel, o->dim, &shocks->kernel);
  if (!s) s = sph_rhs_create(shocks->base.ctx, shocks->kernel, NULL, &shocks->rhs);
  if (!s) s = add_terms(shocks);
  if (!s) s = sph_rhs_set_finish(shocks->rhs, sphi_shocks_finish, shocks);
  if (!s) s = sphi_shocks_make_parts(shocks, 1.0); /* now, so that bad options are named here */
  sphi_shocks_drop_parts(shocks);
  return s;
}

static sph_status check_create(sph_context *ctx, const sph_particles *set,
                               const sph_shocks_options *options, sph_shocks_options *o,
                               sph_dissipation *dissipation) {
  sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (!s) s = sphi_check_handle(ctx, set, SPHI_MAGIC_PARTICLES, "set");
  if (s) return s;
  if (!options) return sphi_fail(ctx, SPH_ERR_ARG, "shocks: the options are NULL");
  s = sphi_options_read(ctx, o, sizeof *o, options);
  if (!s) s = check_options(ctx, o);
  if (!s) s = read_dissipation(ctx, o, dissipation);
  if (s || o->dim == sph_particles_dim(set)) return s;
  return sphi_fail(ctx, SPH_ERR_ARG, "shocks: dim %d, the set is %d-D", (int)o->dim,
                   (int)sph_particles_dim(set));
}

sph_status sph_shocks_create(sph_context *ctx, sph_particles *set,
                             const sph_shocks_options *options, sph_shocks **out) {
  sph_shocks_options o = defaults;
  sph_dissipation dissipation;
  if (!out) return SPH_ERR_ARG;
  *out = NULL;
  sph_status s = check_create(ctx, set, options, &o, &dissipation);
  if (s) return s;
  sph_shocks *shocks = sphi_calloc(ctx, sizeof *shocks);
  if (!shocks) return SPH_ERR_NOMEM;
  shocks->base = (sphi_object){SPHI_MAGIC_SHOCKS, ctx};
  shocks->options = o;
  shocks->options.dissipation = NULL; /* the host's, copied */
  shocks->dissipation = dissipation;
  shocks->set = set;
  sphi_context_retain(ctx);
  s = make_fixed_parts(shocks);
  if (s)
    sph_shocks_destroy(shocks);
  else
    *out = shocks;
  return s;
}

void sph_shocks_destroy(sph_shocks *shocks) {
  if (sphi_check_handle(NULL, shocks, SPHI_MAGIC_SHOCKS, "shocks")) return;
  sph_context *ctx = shocks->base.ctx;
  sphi_shocks_drop_parts(shocks);
  sph_rhs_destroy(shocks->rhs);
  sph_kernel_destroy(shocks->kernel);
  sphi_buffer_free(ctx, &shocks->lengths);
  sphi_buffer_free(ctx, &shocks->drho);
  sphi_buffer_free(ctx, &shocks->strain);
  shocks->base.magic = 0;
  sphi_free(ctx, shocks, sizeof *shocks);
  sphi_context_release(ctx);
}

sph_status sphi_shocks_check(const sph_shocks *shocks, int32_t started) {
  sph_status s = sphi_check_handle(NULL, shocks, SPHI_MAGIC_SHOCKS, "shocks");
  if (s || !started || shocks->started) return s;
  return sphi_fail(shocks->base.ctx, SPH_ERR_STATE, "shocks: not started");
}

/* ---- materials, ghosts, hooks ------------------------------------------------------------ */

/* The deviator's terms, and its field. */
static sph_status add_strength(sph_shocks *shocks) {
  double *ignored;
  if (shocks->strength) return SPH_OK;
  sph_status s = sph_particles_field(shocks->set, SPH_FIELD_SIGMA, &ignored);
  shocks->strain_field = sph_particles_find_field(shocks->set, "plastic_strain");
  if (!s && shocks->strain_field < 0)
    s = sph_particles_add_field(shocks->set, "plastic_strain", 1, &shocks->strain_field);
  if (!s) s = add(shocks->rhs, SPH_TERM_SMOOTHED_STRESS, 0);
  if (!s) s = add(shocks->rhs, SPH_TERM_STRESS_RATE, 0);
  shocks->strength = !s;
  return s;
}

sph_status sph_shocks_set_material(sph_shocks *shocks, int32_t phase, sph_material *material) {
  double none[1];
  sph_material_block block;
  sph_status s = sphi_shocks_check(shocks, 0);
  if (!s) s = sphi_check_handle(shocks->base.ctx, material, SPHI_MAGIC_MATERIAL, "material");
  if (s) return s;
  sph_material_block_init(&block); /* of no particles: whether there is such a law */
  block.dim = shocks->options.dim;
  s = sph_material_pressure(material, &block, none);
  if (!s) s = sph_material_sound_speed(material, &block, none);
  if (!s) s = sph_rhs_set_material(shocks->rhs, phase, material);
  if (!s) shocks->has_law[phase] = 1;
  if (!s && sphi_material_has(material, SPHI_MATERIAL_STRESS_RATE)) s = add_strength(shocks);
  return s;
}

sph_status sph_shocks_set_ghosts(sph_shocks *shocks, sph_ghosts *ghosts) {
  sph_status s = sphi_shocks_check(shocks, 0);
  if (!s && ghosts) s = sph_ghosts_set_mirror(ghosts, SPH_FIELD_OMEGA, SPH_MIRROR_COPY);
  if (!s) shocks->ghosts = ghosts;
  return s;
}

sph_status sph_shocks_set_prepare(sph_shocks *shocks, sph_rhs_hook fn, void *user) {
  sph_status s = sphi_shocks_check(shocks, 0);
  if (s) return s;
  shocks->prepare = fn;
  shocks->prepare_user = user;
  return SPH_OK;
}

sph_status sph_shocks_set_finish(sph_shocks *shocks, sph_rhs_hook fn, void *user) {
  sph_status s = sphi_shocks_check(shocks, 0);
  if (s) return s;
  shocks->finish = fn;
  shocks->finish_user = user;
  return SPH_OK;
}

/* ---- steps ------------------------------------------------------------------------------- */

sph_status sph_shocks_update(sph_shocks *shocks) {
  sph_status s = sphi_shocks_check(shocks, 1);
  return s ? s : sphi_shocks_fill(shocks, shocks->book.time, NULL, 0);
}

/* By signals, and by the last rates of the density. */
static sph_status smaller_step(sph_shocks *shocks, double *dt) {
  const sph_shocks_options *o = &shocks->options;
  double by_signals, by_density = INFINITY;
  sph_operands a;
  sph_operands_init(&a);
  sph_status s = sph_operands_from_set(shocks->set, &a);
  if (!s) s = sph_signal_step(shocks->list, &a, o->cfl, &by_signals);
  if (!s && o->density == SPH_SHOCKS_DIFFERENTIAL && isfinite(o->density_limit))
    s = sph_density_step(shocks->base.ctx, a.rows, o->density_limit, a.rho, shocks->drho.ptr,
                         &by_density);
  if (!s) *dt = fmin(by_signals, by_density);
  return s;
}

sph_status sph_shocks_stable_dt(sph_shocks *shocks, double *dt) {
  sph_status s = sphi_shocks_check(shocks, 1);
  if (s) return s;
  if (!dt) return sphi_fail(shocks->base.ctx, SPH_ERR_ARG, "shocks: dt is NULL");
  s = sphi_shocks_neighbors(shocks, shocks->book.time, NULL, 0);
  return s ? s : smaller_step(shocks, dt);
}

sph_status sph_shocks_step(sph_shocks *shocks, double dt, sph_step_info *info) {
  sph_status s = sphi_shocks_check(shocks, 1);
  if (!s) s = sph_integrator_step(shocks->integrator, shocks->set, shocks->book.time, dt, info);
  if (s) return s;
  shocks->book.time += dt;
  ++shocks->book.steps;
  return sphi_shocks_keep_strain(shocks);
}

/* A run with the host's function. */
typedef struct run {
  sph_shocks *shocks;
  sph_shocks_fn after;
  void *user;
} run;

static sph_status run_dt(void *scheme, double *dt) {
  return sph_shocks_stable_dt(((run *)scheme)->shocks, dt);
}
static sph_status run_step(void *scheme, double dt, sph_step_info *info) {
  return sph_shocks_step(((run *)scheme)->shocks, dt, info);
}
static int32_t run_after(void *scheme, const sph_step_info *info) {
  const run *r = scheme;
  return r->after ? r->after(r->user, r->shocks, info) : 0;
}
/* A state out of range may have come of too large a step. */
static int32_t run_halve(void *scheme, sph_status status) {
  if (status != SPH_RETRY && status != SPH_ERR_NUMERIC) return 0;
  ++((run *)scheme)->shocks->book.retries;
  return 1;
}

sph_status sph_shocks_run(sph_shocks *shocks, double t_end, sph_shocks_fn after, void *user) {
  sph_status s = sphi_shocks_check(shocks, 1);
  if (s) return s;
  run r = {shocks, after, user};
  const sphi_march march = {.ctx = shocks->base.ctx,
                            .name = "shocks",
                            .scheme = &r,
                            .time = &shocks->book.time,
                            .stable_dt = run_dt,
                            .step = run_step,
                            .after = run_after,
                            .halve = run_halve};
  s = sphi_march_to(&march, t_end);
  return s ? s : sphi_shocks_fill(shocks, shocks->book.time, NULL, 0);
}

/* ---- parts ------------------------------------------------------------------------------- */

double sph_shocks_time(const sph_shocks *shocks) {
  return sphi_shocks_check(shocks, 0) || !shocks->started ? NAN : shocks->book.time;
}
sph_rhs *sph_shocks_rhs(sph_shocks *shocks) {
  return sphi_shocks_check(shocks, 0) ? NULL : shocks->rhs;
}
sph_neighbors *sph_shocks_list(sph_shocks *shocks) {
  return sphi_shocks_check(shocks, 0) ? NULL : shocks->list;
}
sph_integrator *sph_shocks_integrator(sph_shocks *shocks) {
  return sphi_shocks_check(shocks, 0) ? NULL : shocks->integrator;
}
sph_kernel *sph_shocks_kernel(sph_shocks *shocks) {
  return sphi_shocks_check(shocks, 0) ? NULL : shocks->kernel;
}
