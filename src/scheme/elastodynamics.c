/* Elastodynamics, updated Lagrangian. From top to bottom: options, terms, one evaluation, start,
 * steps. Everything below is done with public functions: copy what you want to change. */
#include "scheme_impl.h"

#include <math.h>
#include <string.h>

/* ---- options ----------------------------------------------------------------------------- */

static const sph_elastodynamics_options defaults = {.size = sizeof defaults,
                                                    .kernel = SPH_KERNEL_CUBIC_SPLINE,
                                                    .h_ratio = 1.5,
                                                    .h_law = SPH_H_LAW_CONSTANT,
                                                    .h_rule = SPH_H_ARITHMETIC,
                                                    .momentum = SPH_STRESS_CONSERVATIVE,
                                                    .corrected = 1,
                                                    .density = SPH_DENSITY_FROZEN,
                                                    .alpha = 2.5,
                                                    .beta = 2.5,
                                                    .artificial_stress = 0.3,
                                                    .artificial_power = 4,
                                                    .artificial_spacing = 1.0,
                                                    .surface_damping = 1,
                                                    .integrator = SPH_INTEGRATOR_RKC,
                                                    .stage_rule = SPH_STAGES_CFL,
                                                    .stages = 2,
                                                    .cfl = 1.0,
                                                    .neighbors = SPH_NEIGHBORS_VERLET,
                                                    .skin = 0.3};

void sph_elastodynamics_options_init_sized(sph_elastodynamics_options *options, size_t size) {
  sphi_options_init(options, size, &defaults, sizeof defaults);
}

enum { RATES = 32 }; /* that an integrator binds at most */

static int in(int32_t x, int32_t lo, int32_t hi) { return x >= lo && x <= hi; }
static int positive(double x) { return isfinite(x) && x > 0.0; }
static int not_negative(double x) { return isfinite(x) && x >= 0.0; }

/* What the parts do not check themselves when they are created. */
static sph_status check_options(sph_context *ctx, const sph_elastodynamics_options *o) {
  if (!in(o->momentum, SPH_STRESS_SUMMED, SPH_STRESS_CONSERVATIVE) ||
      !in(o->density, SPH_DENSITY_FROZEN, SPH_DENSITY_CONTINUITY) ||
      !in(o->h_law, SPH_H_LAW_CONSTANT, SPH_H_LAW_SPACING))
    return sphi_fail(ctx, SPH_ERR_ARG, "elastodynamics: momentum form %d, density %d, law of h %d",
                     (int)o->momentum, (int)o->density, (int)o->h_law);
  if (in(o->h_law, SPH_H_LAW_DENSITY, SPH_H_LAW_RATE) && o->density != SPH_DENSITY_CONTINUITY)
    return sphi_fail(ctx, SPH_ERR_ARG, "elastodynamics: law %d of h needs the continuity",
                     (int)o->h_law);
  if (!not_negative(o->spacing) || !positive(o->h_ratio) || !positive(o->cfl) ||
      !not_negative(o->skin) || !not_negative(o->wave_speed))
    return sphi_fail(ctx, SPH_ERR_ARG,
                     "elastodynamics: spacing %g, h_ratio %g, cfl %g, skin %g, wave_speed %g",
                     o->spacing, o->h_ratio, o->cfl, o->skin, o->wave_speed);
  if (!not_negative(o->alpha) || !not_negative(o->beta) || !not_negative(o->artificial_stress) ||
      !not_negative(o->xsph))
    return sphi_fail(ctx, SPH_ERR_ARG,
                     "elastodynamics: alpha %g, beta %g, artificial stress %g, XSPH %g", o->alpha,
                     o->beta, o->artificial_stress, o->xsph);
  if (o->integrator == SPH_INTEGRATOR_BUTCHER || o->stage_rule == SPH_STAGES_RADIUS)
    return sphi_fail(
        ctx, SPH_ERR_UNSUPPORTED,
        "elastodynamics: tableaux and radius callbacks need an integrator of the host");
  if (o->audit && o->integrator == SPH_INTEGRATOR_LEAPFROG)
    return sphi_fail(ctx, SPH_ERR_UNSUPPORTED, "elastodynamics: leapfrog carries no ledger");
  return SPH_OK;
}

/* ---- terms ------------------------------------------------------------------------------- */

static sph_term term_of(int32_t kind, int32_t form, int32_t corrected) {
  sph_term term;
  sph_term_init(&term);
  term.kind = kind;
  term.form = form;
  term.corrected = corrected;
  return term;
}

sph_status sphi_scheme_viscosity(const sph_elastodynamics *solid, sph_rhs *rhs) {
  const sph_elastodynamics_options *o = &solid->options;
  sph_term term = term_of(SPH_TERM_MONAGHAN, 0, o->corrected_damping);
  term.alpha = o->alpha;
  term.beta = o->beta;
  return o->alpha > 0.0 || o->beta > 0.0 ? sph_rhs_add(rhs, &term) : SPH_OK;
}

sph_status sphi_scheme_artificial_stress(const sph_elastodynamics *solid, sph_rhs *rhs) {
  const sph_elastodynamics_options *o = &solid->options;
  sph_term term = term_of(SPH_TERM_ARTIFICIAL_STRESS, 0, o->corrected_damping);
  term.epsilon = o->artificial_stress;
  term.power = o->artificial_power;
  term.spacing_ratio = o->artificial_spacing / o->h_ratio;
  return o->artificial_stress > 0.0 ? sph_rhs_add(rhs, &term) : SPH_OK;
}

static sph_status add_body_force(const sph_elastodynamics *solid) {
  sph_term term = term_of(SPH_TERM_BODY_FORCE, 0, 0);
  int any = 0;
  for (int a = 0; a < 3; ++a) any |= (term.vector[a] = solid->options.body_force[a]) != 0.0;
  return any ? sph_rhs_add(solid->rhs, &term) : SPH_OK;
}

static sph_status add_xsph(const sph_elastodynamics *solid) {
  sph_term term = term_of(SPH_TERM_XSPH, 0, 0);
  term.epsilon = solid->options.xsph;
  return term.epsilon > 0.0 ? sph_rhs_add(solid->rhs, &term) : SPH_OK;
}

/* He (3.7), (3.8), (3.22). */
static sph_status add_terms(sph_elastodynamics *solid) {
  const sph_elastodynamics_options *o = &solid->options;
  const int32_t plain = o->momentum == SPH_STRESS_CONSERVATIVE; /* has its own correction */
  const sph_term motion = term_of(SPH_TERM_MOTION, 0, 0);
  const sph_term stress = term_of(SPH_TERM_STRESS, o->momentum, o->corrected && !plain);
  const sph_term rate = term_of(SPH_TERM_STRESS_RATE, 0, o->corrected);
  const sph_term density = term_of(SPH_TERM_CONTINUITY, SPH_CONTINUITY_VOLUME, o->corrected);
  sph_status s = sph_rhs_add(solid->rhs, &motion);
  if (!s) s = sph_rhs_add(solid->rhs, &stress);
  if (!s) s = sph_rhs_add(solid->rhs, &rate);
  if (!s && o->density == SPH_DENSITY_CONTINUITY) s = sph_rhs_add(solid->rhs, &density);
  if (!s) s = sphi_scheme_viscosity(solid, solid->rhs);
  if (!s) s = sphi_scheme_artificial_stress(solid, solid->rhs);
  if (!s) s = add_body_force(solid);
  return s ? s : add_xsph(solid);
}

/* ---- one evaluation ---------------------------------------------------------------------- */

/* He (6.1), before the pair loops. */
static sph_status h_from_density(sph_elastodynamics *solid) {
  sph_particles *set = solid->set;
  double *h, *rho, *h0, *rho0;
  sph_status s = sph_particles_field(set, SPH_FIELD_H, &h);
  if (!s) s = sph_particles_field(set, SPH_FIELD_RHO, &rho);
  if (!s) s = sph_particles_field(set, solid->h0_field, &h0);
  if (!s) s = sph_particles_field(set, solid->rho0_field, &rho0);
  if (!s)
    s = sph_h_from_density(solid->base.ctx, solid->options.dim, sph_particles_real_count(set), h0,
                           rho0, rho, h);
  return s ? s : sph_particles_touch(set, SPH_FIELD_H);
}

/* He (6.3), at the start and when the host touched SPACING. */
sph_status sphi_scheme_h_from_spacing(sph_elastodynamics *solid) {
  sph_particles *set = solid->set;
  double *h, *spacing;
  sph_status s = sph_particles_field(set, SPH_FIELD_H, &h);
  if (!s) s = sph_particles_field(set, SPH_FIELD_SPACING, &spacing);
  if (!s)
    s = sph_h_from_spacing(solid->base.ctx, sph_particles_real_count(set), solid->options.h_ratio,
                           spacing, h);
  solid->spacing_revision = sph_particles_revision(set, SPH_FIELD_SPACING);
  return s ? s : sph_particles_touch(set, SPH_FIELD_H);
}

static sph_status update_h(sph_elastodynamics *solid) {
  if (solid->options.h_law == SPH_H_LAW_DENSITY) return h_from_density(solid);
  if (solid->options.h_law != SPH_H_LAW_SPACING) return SPH_OK;
  const uint64_t now = sph_particles_revision(solid->set, SPH_FIELD_SPACING);
  return now == solid->spacing_revision ? SPH_OK : sphi_scheme_h_from_spacing(solid);
}

static double *rate_of(const sph_rate *rates, int32_t count, int32_t field) {
  for (int32_t k = 0; k < count; ++k)
    if (rates[k].field == field) return rates[k].values;
  return NULL;
}

/* A wall keeps its velocity, and moves with it whatever XSPH says. */
static void hold_walls(sph_elastodynamics *solid, double *dx, double *dv) {
  const int32_t dim = solid->options.dim, *role = sph_particles_roles(solid->set);
  const double *v = sph_particles_field_const(solid->set, SPH_FIELD_V);
  for (int64_t i = 0; i < sph_particles_real_count(solid->set); ++i)
    for (int32_t a = 0; role[i] == SPH_ROLE_WALL && a < dim; ++a) {
      if (dx) dx[i * dim + a] = v[i * dim + a];
      if (dv) dv[i * dim + a] = 0.0;
    }
}

/* He (6.2). */
static sph_status h_rate(sph_elastodynamics *solid, const double *drho, double *dh) {
  if (solid->options.h_law != SPH_H_LAW_RATE || !drho || !dh) return SPH_OK;
  return sph_h_rate(solid->base.ctx, solid->options.dim, sph_particles_real_count(solid->set),
                    sph_particles_field_const(solid->set, SPH_FIELD_H),
                    sph_particles_field_const(solid->set, SPH_FIELD_RHO), drho, dh);
}

/* After the pair loops: walls, then the host's hook. */
static int32_t finish(void *user, double t, sph_particles *set, const sph_rate *rates,
                      int32_t count) {
  sph_elastodynamics *solid = user;
  double *dv = rate_of(rates, count, SPH_FIELD_V);
  const int32_t audit = solid->options.audit && dv;
  if (audit) solid->before = sphi_moments_of(solid->base.ctx, set, dv);
  hold_walls(solid, rate_of(rates, count, SPH_FIELD_X), dv);
  const int32_t answer =
      solid->finish ? solid->finish(solid->finish_user, t, set, rates, count) : 0;
  if (audit) solid->after = sphi_moments_of(solid->base.ctx, set, dv);
  return answer;
}

/* The rates of the fields stand first in `fields`; the array of integrals is the ledger's own. */
static sph_status split_rates(const sph_elastodynamics *solid, const sph_rate *rates, int32_t count,
                              sph_rate *fields, int32_t *n, double **integrals) {
  for (int32_t k = 0; k < count; ++k) {
    if (rates[k].field >= 0)
      fields[(*n)++] = rates[k];
    else if (rates[k].field == solid->ledger_item)
      *integrals = rates[k].values;
    else
      return sphi_fail(solid->base.ctx, SPH_ERR_STATE,
                       "elastodynamics: no rates for the array bound as item %d", (int)k);
  }
  return SPH_OK;
}

/* The integrator's right-hand side. */
int32_t sphi_scheme_evaluate(void *user, double t, sph_particles *set, const sph_rate *rates,
                             int32_t count) {
  sph_elastodynamics *solid = user;
  sph_rate fields[RATES];
  double *integrals = NULL;
  int32_t n = 0;
  sph_status s = split_rates(solid, rates, count, fields, &n, &integrals);
  if (!s) s = update_h(solid);
  if (!s) s = sph_rhs_evaluate(solid->rhs, set, solid->list, t, fields, n);
  if (!s) s = h_rate(solid, rate_of(fields, n, SPH_FIELD_RHO), rate_of(fields, n, SPH_FIELD_H));
  return s || !integrals ? s : sphi_ledger_rates(solid, t, integrals);
}

/* ---- creation ---------------------------------------------------------------------------- */

static sph_status make_parts(sph_elastodynamics *solid) {
  sph_context *ctx = solid->base.ctx;
  sph_rhs_options options;
  sph_rhs_options_init(&options);
  options.position_field = solid->options.position_field;
  sph_status s = sph_kernel_create(ctx, solid->options.kernel, solid->options.dim, &solid->kernel);
  if (!s) s = sph_rhs_create(ctx, solid->kernel, &options, &solid->rhs);
  if (!s) s = add_terms(solid);
  if (!s) s = sph_rhs_set_finish(solid->rhs, finish, solid);
  return s || !solid->options.audit ? s : sphi_ledger_create(solid);
}

sph_status sph_elastodynamics_create(sph_context *ctx, sph_particles *set,
                                     const sph_elastodynamics_options *options,
                                     sph_elastodynamics **out) {
  sph_elastodynamics_options o = defaults;
  if (!out) return SPH_ERR_ARG;
  *out = NULL;
  sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (!s) s = sphi_check_handle(ctx, set, SPHI_MAGIC_PARTICLES, "set");
  if (s) return s;
  if (!options) return sphi_fail(ctx, SPH_ERR_ARG, "elastodynamics: the options are NULL");
  s = sphi_options_read(ctx, &o, sizeof o, options);
  if (!s) s = check_options(ctx, &o);
  if (!s && o.dim != sph_particles_dim(set))
    s = sphi_fail(ctx, SPH_ERR_ARG, "elastodynamics: dim %d, the set is %d-D", (int)o.dim,
                  (int)sph_particles_dim(set));
  if (s) return s;
  sph_elastodynamics *solid = sphi_calloc(ctx, sizeof *solid);
  if (!solid) return SPH_ERR_NOMEM;
  solid->base = (sphi_object){SPHI_MAGIC_ELASTODYNAMICS, ctx};
  solid->options = o;
  solid->set = set;
  solid->time = NAN;
  sphi_context_retain(ctx);
  s = make_parts(solid);
  if (!s) s = sphi_scheme_make_parts(solid, 1.0, 1.0); /* now, so that bad options are named here */
  sphi_scheme_drop_parts(solid);
  if (s)
    sph_elastodynamics_destroy(solid);
  else
    *out = solid;
  return s;
}

void sph_elastodynamics_destroy(sph_elastodynamics *solid) {
  if (sphi_check_handle(NULL, solid, SPHI_MAGIC_ELASTODYNAMICS, "solid")) return;
  sph_context *ctx = solid->base.ctx;
  sphi_scheme_drop_parts(solid);
  for (int k = 0; k < 2; ++k) sph_rhs_destroy(solid->damping[k]);
  sph_rhs_destroy(solid->rhs);
  sph_kernel_destroy(solid->kernel);
  sphi_buffer_free(ctx, &solid->scratch);
  solid->base.magic = 0;
  sphi_free(ctx, solid, sizeof *solid);
  sphi_context_release(ctx);
}

sph_status sphi_scheme_check(const sph_elastodynamics *solid, int32_t started) {
  sph_status s = sphi_check_handle(NULL, solid, SPHI_MAGIC_ELASTODYNAMICS, "solid");
  if (s || !started || solid->started) return s;
  return sphi_fail(solid->base.ctx, SPH_ERR_STATE, "elastodynamics: not started");
}

sph_status sph_elastodynamics_set_material(sph_elastodynamics *solid, int32_t phase,
                                           sph_material *material) {
  double speed[1];
  sph_material_block block;
  sph_status s = sphi_scheme_check(solid, 0);
  if (s) return s;
  speed[0] = solid->options.wave_speed;
  sph_material_block_init(&block);
  block.dim = solid->options.dim;
  block.n = 1;
  s = sphi_check_handle(solid->base.ctx, material, SPHI_MAGIC_MATERIAL, "material");
  if (!s && speed[0] == 0.0) s = sph_material_sound_speed(material, &block, speed);
  if (!s && !positive(speed[0]))
    s = sphi_fail(solid->base.ctx, SPH_ERR_NUMERIC, "elastodynamics: sound speed %g of phase %d",
                  speed[0], (int)phase);
  if (!s) s = sph_rhs_set_material(solid->rhs, phase, material);
  if (!s) solid->speed[phase] = speed[0];
  return s;
}

sph_status sph_elastodynamics_set_prepare(sph_elastodynamics *solid, sph_rhs_hook fn, void *user) {
  sph_status s = sphi_scheme_check(solid, 0);
  return s ? s : sph_rhs_set_prepare(solid->rhs, fn, user);
}

sph_status sph_elastodynamics_set_finish(sph_elastodynamics *solid, sph_rhs_hook fn, void *user) {
  sph_status s = sphi_scheme_check(solid, 0);
  if (s) return s;
  solid->finish = fn;
  solid->finish_user = user;
  return SPH_OK;
}

/* ---- steps ------------------------------------------------------------------------------- */

sph_status sph_elastodynamics_step(sph_elastodynamics *solid, double dt, sph_step_info *info) {
  sph_status s = sphi_scheme_check(solid, 1);
  if (!s) s = sph_integrator_step(solid->integrator, solid->set, solid->time, dt, info);
  if (!s) solid->time += dt;
  return s;
}

/* A run of the scheme with the host's function. */
typedef struct run {
  sph_elastodynamics *solid;
  sph_elastodynamics_fn after;
  void *user;
} run;

static sph_status run_dt(void *scheme, double *dt) {
  return sph_elastodynamics_stable_dt(((run *)scheme)->solid, dt);
}
static sph_status run_step(void *scheme, double dt, sph_step_info *info) {
  return sph_elastodynamics_step(((run *)scheme)->solid, dt, info);
}
static int32_t run_after(void *scheme, const sph_step_info *info) {
  const run *r = scheme;
  return r->after ? r->after(r->user, r->solid, info) : 0;
}
static int32_t run_halve(void *scheme, sph_status status) {
  (void)scheme;
  return status == SPH_RETRY;
}

sph_status sph_elastodynamics_run(sph_elastodynamics *solid, double t_end,
                                  sph_elastodynamics_fn after, void *user) {
  sph_status s = sphi_scheme_check(solid, 1);
  if (s) return s;
  run r = {solid, after, user};
  const sphi_march march = {.ctx = solid->base.ctx,
                            .name = "elastodynamics",
                            .scheme = &r,
                            .time = &solid->time,
                            .stable_dt = run_dt,
                            .step = run_step,
                            .after = run_after,
                            .halve = run_halve};
  return sphi_march_to(&march, t_end);
}

/* ---- parts ------------------------------------------------------------------------------- */

double sph_elastodynamics_time(const sph_elastodynamics *solid) {
  return sphi_scheme_check(solid, 0) ? NAN : solid->started ? solid->time : NAN;
}
sph_rhs *sph_elastodynamics_rhs(sph_elastodynamics *solid) {
  return sphi_scheme_check(solid, 0) ? NULL : solid->rhs;
}
sph_neighbors *sph_elastodynamics_list(sph_elastodynamics *solid) {
  return sphi_scheme_check(solid, 0) ? NULL : solid->list;
}
sph_integrator *sph_elastodynamics_integrator(sph_elastodynamics *solid) {
  return sphi_scheme_check(solid, 0) ? NULL : solid->integrator;
}
sph_kernel *sph_elastodynamics_kernel(sph_elastodynamics *solid) {
  return sphi_scheme_check(solid, 0) ? NULL : solid->kernel;
}
