/* Runge-Kutta-Chebyshev of order 2 (T 4.17 with dt, E19; P 25):
 *
 *   Y0 = U;  Y1 = Y0 + mu~_1 dt F0
 *   Yk = mu_k Y_{k-1} + nu_k Y_{k-2} + (1 - mu_k - nu_k) Y0 + mu~_k dt F_{k-1} + gamma~_k dt F0
 *
 * Y_{k-1} is the state itself; one pass turns it into Y_k and puts the old value into the vector
 * of Y_{k-2}. */
#include "integrate_impl.h"

#include <math.h>

enum { F0 = SPHI_VEC_RATE, F = SPHI_VEC_RATE + 1, OLD = SPHI_VEC_RATE + 2 };

/* ---- coefficients, kept while the stage count stays -------------------------------------- */

enum { ROW_MU = 0, ROW_NU = 1, ROW_MU_T = 2, ROW_GAMMA_T = 3, ROW_C = 4 };

static double *row(const sph_integrator *it, int32_t which) {
  return it->rkc_values + (size_t)which * ((size_t)it->options.max_stages + 1);
}

static void prepare_coefficients(sph_integrator *it, int32_t s) {
  if (it->rkc_stages == s) return;
  (void)sph_rkc_coefficients(s, it->options.rkc_b1, row(it, ROW_MU), row(it, ROW_NU),
                             row(it, ROW_MU_T), row(it, ROW_GAMMA_T), row(it, ROW_C));
  it->rkc_stages = s;
}

/* ---- how many stages --------------------------------------------------------------------- */

/* Largest dt that max_stages allow by the rule dt radius = 0.653 (s^2 - 1), just inside. */
static double largest_step(const sph_integrator *it, double radius) {
  double s = it->options.max_stages;
  return 0.653 * (s * s - 1.0) / radius * (1.0 - 1e-12);
}

static sph_status bound_stages(sphi_step *step, int32_t s, double radius) {
  sph_integrator *it = step->it;
  step->info->radius = radius;
  step->info->stages = s;
  if (s >= 2 && s <= it->options.max_stages) return SPH_OK;
  double dt = largest_step(it, radius);
  step->info->suggested_dt = dt;
  return sphi_fail(it->base.ctx, SPH_RETRY,
                   "RKC needs more than max_stages = %d for dt = %.9g and spectral radius %.9g; "
                   "the largest step is %.9g",
                   (int)it->options.max_stages, step->dt, radius, dt);
}

static sph_status stages_from_callback(sphi_step *step) {
  sph_integrator *it = step->it;
  double radius = it->options.radius(it->options.radius_user, step->t, step->set);
  sph_status status = sphi_state_follow(it, step->set);
  if (status != SPH_OK) return status;
  if (!isfinite(radius) || radius < 0.0)
    return sphi_fail(it->base.ctx, SPH_ERR_CALLBACK,
                     "the spectral radius from the host is %g at t = %.9g", radius, step->t);
  return bound_stages(step, sph_rkc_stages_radius(step->dt, radius), radius);
}

/* Rules that need no right-hand side, before one is paid for. 5 c / dp is what the published CFL
 * rule takes for the radius: 5 * 0.131 = 0.655. */
static sph_status stages_beforehand(sphi_step *step) {
  const sph_integrator_options *o = &step->it->options;
  switch (o->stage_rule) {
  case SPH_STAGES_FIXED:
    step->info->stages = o->stages;
    return SPH_OK;
  case SPH_STAGES_CFL:
    return bound_stages(step, sph_rkc_stages_cfl(step->dt, o->wave_speed, o->spacing),
                        5.0 * o->wave_speed / o->spacing);
  case SPH_STAGES_RADIUS:
    return stages_from_callback(step);
  default:
    return SPH_OK;
  }
}

/* At first the intervals double, 1, 2, 4 ..: a run often starts at rest, where a viscosity that
 * acts on approaching pairs shows half of its radius. */
static int32_t estimate_is_due(const sph_integrator *it) {
  const sphi_memory *m = &it->memory;
  int64_t interval = it->options.power_interval;
  if (m->estimated_at < 0) return 1;
  if (m->estimated_at + 1 < interval) interval = m->estimated_at + 1;
  return m->steps - m->estimated_at >= interval;
}

static sph_status take_estimate(sphi_step *step) {
  sph_integrator *it = step->it;
  sphi_eigen eigen = {NAN, NAN, NAN};
  sph_status status =
      sphi_power_estimate(step, sphi_vector(it, F0), it->options.power_iterations, &eigen);
  if (status != SPH_OK) return status;
  sphi_restore_start(step);
  if (!isfinite(sphi_eigen_radius(&eigen)))
    return sphi_fail(it->base.ctx, SPH_ERR_NUMERIC,
                     "the right-hand side near t = %.9g is not finite: no spectral radius",
                     step->t);
  it->memory.eigen = eigen;
  it->memory.estimated_at = it->memory.steps;
  return SPH_OK;
}

static sph_status stages_by_power(sphi_step *step) {
  sph_integrator *it = step->it;
  if (estimate_is_due(it)) {
    sph_status status = take_estimate(step);
    if (status != SPH_OK) return status;
  }
  double radius = it->options.power_safety * sphi_eigen_radius(&it->memory.eigen);
  sph_status status = bound_stages(step, sph_rkc_stages_radius(step->dt, radius), radius);
  if (status == SPH_OK) step->info->stages = sphi_stability_stages(step, step->info->stages);
  if (status == SPH_OK) sphi_stability_judge(step, step->info->stages);
  return status;
}

/* Stages settled, F0 evaluated, stability looked at. */
static sph_status begin(sphi_step *step) {
  sph_integrator *it = step->it;
  sph_status status = stages_beforehand(step);
  if (status == SPH_OK) status = sphi_evaluate(it, step->set, step->t, sphi_vector(it, F0));
  if (status != SPH_OK) return status;
  if (it->options.stage_rule == SPH_STAGES_POWER) return stages_by_power(step);
  return sphi_stability_watch(step, sphi_vector(it, F0), step->info->stages);
}

/* ---- stages ------------------------------------------------------------------------------ */

typedef struct update_job {
  double *y, *old;
  const double *y0, *f0, *f;
  double mu, nu, rest, mu_dt, gamma_dt;
} update_job;

static void update_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  const update_job *u = job;
  (void)worker;
  for (int64_t i = begin; i < end; ++i) {
    double y = u->y[i];
    u->y[i] = u->mu * y + u->nu * u->old[i] + u->rest * u->y0[i] + u->mu_dt * u->f[i] +
              u->gamma_dt * u->f0[i];
    u->old[i] = y;
  }
}

static update_job stage_factors(const sphi_step *step, int32_t k) {
  const sph_integrator *it = step->it;
  update_job u = {NULL, NULL, NULL, NULL, NULL, 0.0, 0.0, 0.0, 0.0, 0.0};
  u.mu = row(it, ROW_MU)[k];
  u.nu = row(it, ROW_NU)[k];
  u.rest = 1.0 - u.mu - u.nu;
  u.mu_dt = row(it, ROW_MU_T)[k] * step->dt;
  u.gamma_dt = row(it, ROW_GAMMA_T)[k] * step->dt;
  return u;
}

/* Stage k stands in place. */
static sph_status finish(sphi_step *step, int32_t k) {
  const int32_t last = k == step->info->stages;
  const double c = last ? 1.0 : row(step->it, ROW_C)[k];
  return sphi_finish_stage(step, step->t + c * step->dt, last ? SPH_COPY_RESULT : SPH_COPY_STAGE);
}

static sph_status write_stage(sphi_step *step, int32_t k) {
  sph_integrator *it = step->it;
  update_job u = stage_factors(step, k);
  for (int32_t m = 0; m < it->items; ++m) {
    sphi_item *item = &it->item[m];
    u.y = item->y;
    u.old = sphi_vector(it, OLD) + item->offset;
    u.y0 = sphi_vector(it, SPHI_VEC_START) + item->offset;
    u.f0 = sphi_vector(it, F0) + item->offset;
    u.f = sphi_vector(it, F) + item->offset;
    if (item->n > 0) sphi_parallel(it->base.ctx, item->n, SPHI_STATE_GRAIN, update_range, &u);
  }
  return finish(step, k);
}

static sph_status write_first_stage(sphi_step *step) {
  sph_integrator *it = step->it;
  sphi_combination c = {0, {0.0}, {NULL}};
  sphi_state_copy(it, sphi_vector(it, OLD), sphi_vector(it, SPHI_VEC_START));
  sphi_combination_add(&c, 1.0, sphi_vector(it, SPHI_VEC_START));
  sphi_combination_add(&c, row(it, ROW_MU_T)[1] * step->dt, sphi_vector(it, F0));
  sphi_state_combine(it, NULL, &c);
  return finish(step, 1);
}

/* The recurrence reads Y_{k-1} from the state: what a right-hand side overwrote there (values it
 * holds fixed, say) takes part in the next stage. */
static sph_status run_stages(sphi_step *step) {
  sph_integrator *it = step->it;
  prepare_coefficients(it, step->info->stages);
  sph_status status = write_first_stage(step);
  for (int32_t k = 2; k <= step->info->stages && status == SPH_OK; ++k) {
    double t = step->t + row(it, ROW_C)[k - 1] * step->dt;
    status = sphi_evaluate(it, step->set, t, sphi_vector(it, F));
    if (status == SPH_OK) status = write_stage(step, k);
  }
  return status;
}

/* ---- error ------------------------------------------------------------------------------- */

/* The trapezoidal defect D = U_n - U_{n+1} + dt/2 (F_n + F_{n+1}) is dt^3/12 U''' on the exact
 * solution. For U' = lambda U, P_s(z) = 1 + z + z^2/2 + c3 z^3 + .. with c3 = (s^2 - 4) /
 * (10 (s^2 - 1)) for small eps, so the true local error is (1/6 - c3) dt^3 U''', 1/15 for many
 * stages: 0.8 D of the exact solution. On the computed one 0.8 D = 0.8 (1/4 - c3) dt^3 U''', larger
 * than the true error by 1.2 (s = 2) to 1.8 (s large): the estimate errs on the safe side. */
static sph_status estimate_error(sphi_step *step) {
  sph_integrator *it = step->it;
  double *f = sphi_vector(it, F);
  sphi_combination c = {0, {0.0}, {NULL}};
  if (!step->has_info || !step->info->want_error) return SPH_OK;
  sph_status status = sphi_evaluate(it, step->set, step->t + step->dt, f);
  if (status != SPH_OK) return status;
  sphi_combination_add(&c, 0.8, sphi_vector(it, SPHI_VEC_START));
  sphi_combination_add(&c, -0.8, NULL);
  sphi_combination_add(&c, 0.4 * step->dt, sphi_vector(it, F0));
  sphi_combination_add(&c, 0.4 * step->dt, f);
  sphi_state_combine(it, f, &c);
  step->info->error = sphi_error_norm(it, f);
  step->info->suggested_dt = sphi_suggest(step->dt, step->info->error, 2);
  return SPH_OK;
}

sph_status sphi_rkc_step(sphi_step *step) {
  sph_status status = begin(step);
  if (status == SPH_OK) status = run_stages(step);
  return status == SPH_OK ? estimate_error(step) : status;
}
