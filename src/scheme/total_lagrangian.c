/* Total-Lagrangian elasticity, composed of public pieces; only the handle itself (its memory and
 * error sentences) uses the services of core. */
#include "total_lagrangian_impl.h"

#include <sph/integrator.h>
#include <sph/material.h>
#include <sph/neighbors.h>

#include <math.h>
#include <string.h>

enum { GRAIN = 8192 };

/* ---- options and life --------------------------------------------------------------------- */

void sph_total_lagrangian_options_init_sized(sph_total_lagrangian_options *options, size_t size) {
  const sph_total_lagrangian_options defaults = {.size = sizeof defaults,
                                                 .kernel = SPH_KERNEL_WENDLAND_C2,
                                                 .h_ratio = 1.0,
                                                 .form = SPH_PIOLA_CONSERVATIVE,
                                                 .hourglass_form = SPH_HOURGLASS_VARIATIONAL,
                                                 .hourglass = 0.1,
                                                 .cfl = 0.5,
                                                 .integrator = SPH_INTEGRATOR_LEAPFROG};
  sphi_options_init(options, size, &defaults, sizeof defaults);
}

static int at_least(double value, double least) { return isfinite(value) && value >= least; }

static sph_status check_options(sph_context *ctx, const sph_total_lagrangian_options *o) {
  const double *g = o->gravity;
  if (o->dim < 1 || o->dim > 3)
    return sphi_fail(ctx, SPH_ERR_ARG, "total_lagrangian: dim is %d", o->dim);
  if (!(at_least(o->h_ratio, 0.0) && o->h_ratio > 0.0 && at_least(o->cfl, 0.0) && o->cfl > 0.0))
    return sphi_fail(ctx, SPH_ERR_ARG, "total_lagrangian: h_ratio %g, cfl %g", o->h_ratio, o->cfl);
  if (!at_least(o->hourglass, 0.0) || !at_least(o->alpha, 0.0) || !at_least(o->beta, 0.0))
    return sphi_fail(ctx, SPH_ERR_ARG, "total_lagrangian: hourglass %g, alpha %g, beta %g",
                     o->hourglass, o->alpha, o->beta);
  if (!isfinite(g[0]) || !isfinite(g[1]) || !isfinite(g[2]))
    return sphi_fail(ctx, SPH_ERR_ARG, "total_lagrangian: gravity (%g, %g, %g)", g[0], g[1], g[2]);
  if (o->integrator == SPH_INTEGRATOR_BUTCHER || o->integrator == SPH_INTEGRATOR_RKC)
    return sphi_fail(ctx, SPH_ERR_UNSUPPORTED,
                     "total_lagrangian: integrator %d needs options of its own", o->integrator);
  if (o->audit && o->integrator != SPH_INTEGRATOR_LEAPFROG)
    return sphi_fail(ctx, SPH_ERR_UNSUPPORTED,
                     "total_lagrangian: the ledger goes with LEAPFROG, not with integrator %d",
                     o->integrator);
  return SPH_OK;
}

static sph_status add_term(sph_rhs *rhs, int32_t kind, int32_t form, double alpha, double beta,
                           const double *vector) {
  sph_term term;
  sph_term_init(&term);
  term.kind = kind;
  term.form = form;
  term.alpha = alpha;
  term.beta = beta;
  term.corrected = kind == SPH_TERM_FIRST_PIOLA && form == SPH_PIOLA_SUMMED;
  if (vector) memcpy(term.vector, vector, sizeof term.vector);
  return sph_rhs_add(rhs, &term);
}

sph_status sphi_tl_add_viscosity(sph_rhs *rhs, const sph_total_lagrangian_options *o) {
  if (o->alpha == 0.0 && o->beta == 0.0) return SPH_OK;
  return add_term(rhs, SPH_TERM_MONAGHAN, SPH_MONAGHAN_CURRENT, o->alpha, o->beta, NULL);
}

static sph_status add_terms(sph_rhs *rhs, const sph_total_lagrangian_options *o) {
  const double *g = o->gravity;
  sph_status s = add_term(rhs, SPH_TERM_MOTION, 0, 0.0, 0.0, NULL);
  if (!s) s = add_term(rhs, SPH_TERM_FIRST_PIOLA, o->form, 0.0, 0.0, NULL);
  if (!s && o->hourglass > 0.0)
    s = add_term(rhs, SPH_TERM_HOURGLASS, o->hourglass_form, o->hourglass, 0.0, NULL);
  if (!s) s = sphi_tl_add_viscosity(rhs, o);
  if (!s && (g[0] != 0.0 || g[1] != 0.0 || g[2] != 0.0))
    s = add_term(rhs, SPH_TERM_BODY_FORCE, 0, 0.0, 0.0, g);
  return s;
}

static sph_status make_pieces(sph_total_lagrangian *tl, sph_material *material) {
  const sph_total_lagrangian_options *o = &tl->options;
  sph_context *ctx = tl->base.ctx;
  sph_neighbors_options near;
  sph_rhs_options frozen;
  sph_status s = sph_kernel_create(ctx, o->kernel, o->dim, &tl->kernel);
  if (s) return s;
  sph_neighbors_options_init(&near);
  near.support = sph_kernel_support(tl->kernel);
  sph_rhs_options_init(&frozen);
  frozen.position_field = SPH_FIELD_X0;
  s = sph_neighbors_create(ctx, &near, &tl->list);
  if (!s) s = sph_rhs_create(ctx, tl->kernel, &frozen, &tl->rhs);
  if (!s) s = sph_rhs_set_material(tl->rhs, 0, material);
  tl->material = material;
  return s ? s : add_terms(tl->rhs, o);
}

static sph_status make_integrator(sph_total_lagrangian *tl) {
  sph_integrator_options o;
  if (tl->options.integrator == SPH_INTEGRATOR_LEAPFROG) return SPH_OK;
  sph_integrator_options_init(&o);
  o.method = tl->options.integrator;
  sph_status s = sph_integrator_create(tl->base.ctx, &o, &tl->integrator);
  if (!s) s = sph_integrator_bind_field(tl->integrator, SPH_FIELD_X);
  if (!s) s = sph_integrator_bind_field(tl->integrator, SPH_FIELD_V);
  if (!s) s = sph_integrator_set_rhs(tl->integrator, tl->rhs, tl->list);
  return s;
}

sph_status sph_total_lagrangian_create(sph_context *ctx,
                                       const sph_total_lagrangian_options *options,
                                       sph_material *material, sph_total_lagrangian **out) {
  sph_total_lagrangian_options own;
  if (!out) return SPH_ERR_ARG;
  *out = NULL;
  sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (!s) s = sphi_check_handle(ctx, material, SPHI_MAGIC_MATERIAL, "material");
  if (s) return s;
  sph_total_lagrangian_options_init(&own);
  s = sphi_options_read(ctx, &own, sizeof own, options);
  if (!s) s = check_options(ctx, &own);
  if (s) return s;
  sph_total_lagrangian *tl = sphi_calloc(ctx, sizeof *tl);
  if (!tl) return SPH_ERR_NOMEM;
  tl->base.magic = SPHI_MAGIC_TOTAL_LAGRANGIAN;
  tl->base.ctx = ctx;
  tl->options = own;
  sphi_context_retain(ctx);
  s = make_pieces(tl, material);
  if (!s) s = make_integrator(tl);
  if (!s && own.audit) s = sphi_tl_ledger_create(tl);
  if (s)
    sph_total_lagrangian_destroy(tl);
  else
    *out = tl;
  return s;
}

static sph_status check(sph_total_lagrangian *tl) {
  return sphi_check_handle(NULL, tl, SPHI_MAGIC_TOTAL_LAGRANGIAN, "total_lagrangian");
}

void sph_total_lagrangian_destroy(sph_total_lagrangian *tl) {
  if (!tl || check(tl)) return;
  sph_context *ctx = tl->base.ctx;
  sphi_tl_ledger_destroy(tl);
  sph_integrator_destroy(tl->integrator);
  sph_rhs_destroy(tl->rhs);
  sph_neighbors_destroy(tl->list);
  sph_kernel_destroy(tl->kernel);
  sphi_buffer_free(ctx, &tl->rates);
  sphi_buffer_free(ctx, &tl->saved);
  sphi_buffer_free(ctx, &tl->scratch);
  tl->base.magic = 0;
  sphi_free(ctx, tl, sizeof *tl);
  sphi_context_release(ctx);
}

sph_rhs *sph_total_lagrangian_rhs(sph_total_lagrangian *tl) { return check(tl) ? NULL : tl->rhs; }

sph_neighbors *sph_total_lagrangian_list(sph_total_lagrangian *tl) {
  return check(tl) ? NULL : tl->list;
}

/* ---- the reference configuration ---------------------------------------------------------- */

sph_status sphi_tl_check_set(sph_total_lagrangian *tl, const sph_particles *set) {
  sph_status s = check(tl);
  if (!s) s = sphi_check_handle(tl->base.ctx, set, SPHI_MAGIC_PARTICLES, "set");
  if (s || sph_particles_dim(set) == tl->options.dim) return s;
  return sphi_fail(tl->base.ctx, SPH_ERR_ARG, "total_lagrangian: the set is %d-D, the scheme %d-D",
                   sph_particles_dim(set), tl->options.dim);
}

sph_status sphi_tl_check_started(sph_total_lagrangian *tl, const sph_particles *set) {
  sph_status s = sphi_tl_check_set(tl, set);
  if (s || tl->started == set) return s;
  return sphi_fail(tl->base.ctx, SPH_ERR_STATE,
                   "total_lagrangian: the scheme was not started with this set");
}

static sph_status check_masses(sph_total_lagrangian *tl, const sph_particles *set) {
  const double *m = sph_particles_field_const(set, SPH_FIELD_M);
  const double *rho = sph_particles_field_const(set, SPH_FIELD_RHO);
  if (!m || !rho)
    return sphi_fail(tl->base.ctx, SPH_ERR_ARG, "total_lagrangian: the set has no field %s",
                     m ? "rho" : "m");
  for (int64_t i = 0; i < sph_particles_count(set); ++i)
    if (!(isfinite(m[i]) && m[i] > 0.0 && isfinite(rho[i]) && rho[i] > 0.0))
      return sphi_fail(tl->base.ctx, SPH_ERR_ARG,
                       "total_lagrangian: particle %lld has m %g, rho %g", (long long)i, m[i],
                       rho[i]);
  return SPH_OK;
}

static sph_status set_lengths(sph_total_lagrangian *tl, sph_particles *set) {
  const double *m = sph_particles_field_const(set, SPH_FIELD_M);
  const double *rho = sph_particles_field_const(set, SPH_FIELD_RHO);
  const double *spacing = sph_particles_field_const(set, SPH_FIELD_SPACING);
  const double power = 1.0 / tl->options.dim;
  double *h;
  sph_status s = sph_particles_field(set, SPH_FIELD_H, &h);
  for (int64_t i = 0; !s && i < sph_particles_count(set); ++i) {
    double dp = spacing && spacing[i] > 0.0 ? spacing[i] : pow(m[i] / rho[i], power);
    h[i] = tl->options.h_ratio * dp;
  }
  return s ? s : sph_particles_touch(set, SPH_FIELD_H);
}

static sph_status set_speeds(sph_total_lagrangian *tl, sph_particles *set) {
  sph_material_block block;
  double *c;
  if (sph_particles_field_const(set, SPH_FIELD_C)) return sph_particles_touch(set, SPH_FIELD_C);
  sph_material_block_init(&block);
  block.dim = tl->options.dim;
  block.n = sph_particles_count(set);
  block.rho = sph_particles_field_const(set, SPH_FIELD_RHO);
  sph_status s = sph_particles_field(set, SPH_FIELD_C, &c);
  if (!s) s = sph_material_sound_speed(tl->material, &block, c);
  return s ? s : sph_particles_touch(set, SPH_FIELD_C);
}

static sph_status set_reference(sph_total_lagrangian *tl, sph_particles *set) {
  const double *x = sph_particles_field_const(set, SPH_FIELD_X);
  int64_t n = sph_particles_count(set) * tl->options.dim;
  double *x0, *v;
  sph_status s = sph_particles_field(set, SPH_FIELD_X0, &x0);
  if (!s) s = sph_particles_field(set, SPH_FIELD_V, &v);
  if (s) return s;
  memcpy(x0, x, (size_t)n * sizeof *x0);
  return sph_particles_touch(set, SPH_FIELD_X0);
}

sph_status sphi_tl_build_list(sph_total_lagrangian *tl, const sph_particles *set) {
  return sph_neighbors_build_arrays(tl->list, tl->options.dim, sph_particles_count(set),
                                    sph_particles_field_const(set, SPH_FIELD_X0),
                                    sph_particles_field_const(set, SPH_FIELD_H), 0.0);
}

sph_status sph_total_lagrangian_start(sph_total_lagrangian *tl, sph_particles *set) {
  sph_status s = sphi_tl_check_set(tl, set);
  if (!s) s = check_masses(tl, set);
  if (s) return s;
  tl->set = tl->started = NULL;
  tl->ledger.begun = 0;
  s = set_lengths(tl, set);
  if (!s) s = set_speeds(tl, set);
  if (!s) s = set_reference(tl, set);
  if (!s) /* M and RHO may have been written by the host */
    s = sph_particles_touch(set, SPH_FIELD_M);
  if (!s) s = sph_particles_touch(set, SPH_FIELD_RHO);
  if (!s) s = sphi_tl_build_list(tl, set);
  if (!s) tl->started = set;
  return s;
}

sph_status sph_total_lagrangian_time_step(sph_total_lagrangian *tl, const sph_particles *set,
                                          double *dt) {
  sph_status s = sphi_tl_check_started(tl, set);
  if (s) return s;
  if (!dt) return sphi_fail(tl->base.ctx, SPH_ERR_ARG, "total_lagrangian: dt is NULL");
  const double *h = sph_particles_field_const(set, SPH_FIELD_H);
  const double *c = sph_particles_field_const(set, SPH_FIELD_C);
  double least = INFINITY;
  for (int64_t i = 0; i < sph_particles_real_count(set); ++i)
    if (c[i] > 0.0 && h[i] / c[i] < least) least = h[i] / c[i];
  if (!isfinite(least))
    return sphi_fail(tl->base.ctx, SPH_ERR_NUMERIC, "total_lagrangian: no particle gives a step");
  *dt = tl->options.cfl / tl->options.h_ratio * least;
  return SPH_OK;
}

/* ---- leapfrog ------------------------------------------------------------------------------ */

typedef struct move_job {
  double *y;
  const double *rate;
  double dt;
} move_job;

static void move_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const move_job *j = job;
  (void)worker;
  for (int64_t k = lo; k < hi; ++k) j->y[k] += j->dt * j->rate[k];
}

static sph_status move(sph_particles *set, sph_context *ctx, int32_t field, const double *rate,
                       double dt) {
  move_job job = {NULL, rate, dt};
  sph_status s = sph_particles_field(set, field, &job.y);
  if (!s)
    s = sph_parallel_for(ctx, sph_particles_real_count(set) * sph_particles_dim(set), GRAIN,
                         move_range, &job);
  return s ? s : sph_particles_touch(set, field);
}

/* Accelerations at (t, set) into tl->rates. */
static sph_status accelerate(sph_total_lagrangian *tl, sph_particles *set, double t) {
  size_t n = (size_t)sph_particles_real_count(set) * (size_t)tl->options.dim;
  tl->set = NULL;
  sph_status s = sphi_buffer_reserve(tl->base.ctx, &tl->rates, sphi_mul(n, sizeof(double)));
  if (s) return s;
  sph_rate rate = {SPH_FIELD_V, tl->rates.ptr};
  s = sph_rhs_evaluate(tl->rhs, set, tl->list, t, &rate, 1);
  return s || !tl->options.audit ? s : sphi_tl_ledger_split(tl, set, t);
}

void sphi_tl_remember(sph_total_lagrangian *tl, const sph_particles *set, double t, double dt) {
  tl->set = set;
  tl->generation = sph_particles_generation(set);
  tl->revision_x = sph_particles_revision(set, SPH_FIELD_X);
  tl->revision_v = sph_particles_revision(set, SPH_FIELD_V);
  tl->t = t;
  tl->slack = 1e-6 * fabs(dt);
}

int sphi_tl_remembered(const sph_total_lagrangian *tl, const sph_particles *set, double t) {
  return tl->set == set && tl->generation == sph_particles_generation(set) &&
         tl->revision_x == sph_particles_revision(set, SPH_FIELD_X) &&
         tl->revision_v == sph_particles_revision(set, SPH_FIELD_V) && fabs(t - tl->t) <= tl->slack;
}

sph_status sphi_tl_accelerate_once(sph_total_lagrangian *tl, sph_particles *set, double t) {
  if (sphi_tl_remembered(tl, set, t)) return SPH_OK;
  sph_status s = accelerate(tl, set, t);
  if (!s) sphi_tl_remember(tl, set, t, 0.0);
  return s;
}

/* 0, unless something is not finite; four sums, so that none waits for the one before. */
static double zero_times(const double *y, int64_t n) {
  double sum[4] = {0.0, 0.0, 0.0, 0.0};
  for (int64_t k = 0; k < n; ++k) sum[k & 3] += 0.0 * y[k];
  return sum[0] + sum[1] + sum[2] + sum[3];
}

static sph_status check_finite(sph_total_lagrangian *tl, const sph_particles *set) {
  const double *x = sph_particles_field_const(set, SPH_FIELD_X);
  const double *v = sph_particles_field_const(set, SPH_FIELD_V);
  const int64_t n = sph_particles_real_count(set) * tl->options.dim;
  if (zero_times(x, n) == 0.0 && zero_times(v, n) == 0.0) return SPH_OK;
  int64_t bad = 0;
  while (isfinite(x[bad]) && isfinite(v[bad])) ++bad;
  return sphi_fail(tl->base.ctx, SPH_ERR_NUMERIC, "total_lagrangian: particle %lld is not finite",
                   (long long)(bad / tl->options.dim));
}

static sph_status kick(sph_total_lagrangian *tl, sph_particles *set, double dt) {
  sphi_tl_ledger_kick(tl, set, dt);
  sph_status s = move(set, tl->base.ctx, SPH_FIELD_V, tl->rates.ptr, dt);
  if (!s) sphi_tl_ledger_kick(tl, set, dt);
  return s;
}

static sph_status leapfrog(sph_total_lagrangian *tl, sph_particles *set, double t, double dt) {
  sph_context *ctx = tl->base.ctx;
  sph_status s = kick(tl, set, 0.5 * dt);
  if (!s) s = move(set, ctx, SPH_FIELD_X, sph_particles_field_const(set, SPH_FIELD_V), dt);
  if (!s) s = accelerate(tl, set, t + dt);
  if (!s) s = kick(tl, set, 0.5 * dt);
  return s ? s : check_finite(tl, set);
}

/* Copy X and V of the real particles to `saved` (back: the other way). */
static void copy_state(sph_total_lagrangian *tl, sph_particles *set, int back) {
  static const int32_t fields[2] = {SPH_FIELD_X, SPH_FIELD_V};
  size_t n = (size_t)sph_particles_real_count(set) * (size_t)tl->options.dim;
  for (size_t k = 0; k < 2; ++k) {
    double *y = NULL, *copy = (double *)tl->saved.ptr + k * n;
    if (sph_particles_field(set, fields[k], &y)) continue; /* both exist */
    memcpy(back ? y : copy, back ? copy : y, n * sizeof *y);
    if (back) (void)sph_particles_touch(set, fields[k]);
  }
}

static sph_status step_leapfrog(sph_total_lagrangian *tl, sph_particles *set, double t, double dt) {
  size_t n = 2 * (size_t)sph_particles_real_count(set) * (size_t)tl->options.dim;
  int64_t count = sph_particles_real_count(set);
  sph_status s = sphi_buffer_reserve(tl->base.ctx, &tl->saved, sphi_mul(n, sizeof(double)));
  if (s) return s;
  copy_state(tl, set, 0);
  s = sphi_tl_accelerate_once(tl, set, t);
  if (!s && tl->options.audit) s = sphi_tl_ledger_begin(tl, set);
  const sphi_tl_ledger before = tl->ledger;
  if (!s) s = leapfrog(tl, set, t, dt);
  if (!s) {
    sphi_tl_remember(tl, set, t + dt, dt);
    return SPH_OK;
  }
  memcpy(tl->ledger.integral, before.integral, sizeof before.integral);
  if (sph_particles_real_count(set) == count) copy_state(tl, set, 1);
  return s;
}

sph_status sph_total_lagrangian_step(sph_total_lagrangian *tl, sph_particles *set, double t,
                                     double dt) {
  sph_status s = sphi_tl_check_started(tl, set);
  if (s) return s;
  if (!isfinite(t) || !isfinite(dt) || dt == 0.0)
    return sphi_fail(tl->base.ctx, SPH_ERR_ARG, "total_lagrangian: t %g, dt %g", t, dt);
  if (!tl->integrator) return step_leapfrog(tl, set, t, dt);
  tl->set = NULL;
  return sph_integrator_step(tl->integrator, set, t, dt, NULL);
}

/* ---- energies ------------------------------------------------------------------------------ */

/* Energies of the springs into `energy`; `force` and `matrix` are scratch. */
static sph_status spring_energies(sph_total_lagrangian *tl, sph_particles *set, double *matrix,
                                  double *force, double *energy) {
  sph_operands a;
  sph_status s = sph_operands_from_set(set, &a);
  if (s) return s;
  const double *F = sph_particles_field_const(set, SPH_FIELD_F);
  const double *x = a.x;
  a.x = sph_particles_field_const(set, SPH_FIELD_X0);
  a.rows = a.n;
  s = sph_gradient_matrix(tl->list, tl->kernel, &a, matrix, NULL, NULL);
  a.gradient_matrix = matrix;
  a.rows = sph_particles_real_count(set);
  if (s) return s;
  return sph_hourglass_force(tl->list, tl->kernel, &a, tl->options.hourglass_form,
                             tl->options.hourglass, x, F, force, energy);
}

static void sum_energies(const sph_total_lagrangian *tl, const sph_particles *set,
                         const double *psi, sph_total_lagrangian_energies *e) {
  const double *m = sph_particles_field_const(set, SPH_FIELD_M);
  const double *rho = sph_particles_field_const(set, SPH_FIELD_RHO);
  const double *x = sph_particles_field_const(set, SPH_FIELD_X);
  const double *v = sph_particles_field_const(set, SPH_FIELD_V);
  const int32_t d = tl->options.dim;
  for (int64_t i = 0; i < sph_particles_real_count(set); ++i) {
    e->strain += m[i] / rho[i] * psi[i];
    for (int32_t k = 0; k < d; ++k) {
      e->kinetic += 0.5 * m[i] * v[i * d + k] * v[i * d + k];
      e->gravity -= m[i] * tl->options.gravity[k] * x[i * d + k];
    }
  }
}

static sph_status measure(sph_total_lagrangian *tl, sph_particles *set,
                          sph_total_lagrangian_energies *e) {
  const int32_t d = tl->options.dim;
  size_t n = (size_t)sph_particles_count(set);
  size_t doubles = sphi_mul(n, (size_t)(d * d + d + 1));
  sph_status s = sphi_buffer_reserve(tl->base.ctx, &tl->scratch, sphi_mul(doubles, sizeof(double)));
  if (s) return s;
  double *energy = tl->scratch.ptr, *force = energy + n, *matrix = force + n * (size_t)d;
  s = sph_rhs_strain_energy(tl->rhs, set, energy);
  if (s) return s;
  sum_energies(tl, set, energy, e);
  if (tl->options.hourglass == 0.0) return SPH_OK;
  s = spring_energies(tl, set, matrix, force, energy);
  for (int64_t i = 0; !s && i < sph_particles_real_count(set); ++i) e->hourglass += energy[i];
  return s;
}

sph_status sph_total_lagrangian_energy(sph_total_lagrangian *tl, sph_particles *set, double t,
                                       sph_total_lagrangian_energies *energies) {
  sph_status s = sphi_tl_check_started(tl, set);
  if (s) return s;
  if (!energies || energies->size < sizeof *energies)
    return sphi_fail(tl->base.ctx, SPH_ERR_ARG, "total_lagrangian: energies %s",
                     energies ? "are shorter than those of this library" : "is NULL");
  sph_total_lagrangian_energies e = {.size = energies->size};
  s = sphi_tl_accelerate_once(tl, set, t);
  if (!s) s = measure(tl, set, &e);
  if (!s) memcpy(energies, &e, sizeof e);
  return s;
}
