/* One step: checks, the call of the right-hand side, and the way back after a failure. */
#include "integrate_impl.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- vectors ----------------------------------------------------------------------------- */

int32_t sphi_estimates(const sph_integrator *it) {
  const sph_integrator_options *o = &it->options;
  return o->stability_check_interval > 0 ||
         (o->method == SPH_INTEGRATOR_RKC && o->stage_rule == SPH_STAGES_POWER);
}

/* Start, then the rates of a tableau; F0, F, Y_{k-2} of RKC; F0, F_half, F1 of leapfrog; F and the
 * half-step values of the predicted one. */
static int32_t method_vectors(const sph_integrator *it) {
  if (it->options.method == SPH_INTEGRATOR_LEAPFROG_PREDICTED) return 3;
  return 1 + (it->tableau.s > 0 ? it->tableau.s : 3);
}

int32_t sphi_vector_count(const sph_integrator *it) {
  int32_t extra = it->options.method == SPH_INTEGRATOR_RKC ? 1 : 3;
  return method_vectors(it) + (sphi_estimates(it) ? extra : 0);
}

double *sphi_vector(const sph_integrator *it, int32_t index) {
  return (double *)it->vectors.ptr + (int64_t)index * it->stride;
}

double *sphi_vector_eigen(const sph_integrator *it) { return sphi_vector(it, method_vectors(it)); }

/* RKC has two vectors that are idle while it estimates. */
double *sphi_vector_probe(const sph_integrator *it) {
  return it->options.method == SPH_INTEGRATOR_RKC ? sphi_vector(it, SPHI_VEC_RATE + 1)
                                                  : sphi_vector(it, method_vectors(it) + 1);
}

double *sphi_vector_previous(const sph_integrator *it) {
  return it->options.method == SPH_INTEGRATOR_RKC ? sphi_vector(it, SPHI_VEC_RATE + 2)
                                                  : sphi_vector(it, method_vectors(it) + 2);
}

/* ---- the right-hand side ----------------------------------------------------------------- */

static int32_t is_library_status(int32_t answer) {
#define SPHI_KNOWN(name, value, text) \
  if (answer == (value)) return 1;
  SPH_STATUS_LIST(SPHI_KNOWN)
#undef SPHI_KNOWN
  return 0;
}

/* A callback may have called the library: what that said goes on. The text is copied first, as
 * the new sentence takes its place. */
static sph_status translate(sph_context *ctx, const char *who, double t, int32_t answer) {
  char before[256];
  if (answer == 0) return SPH_OK;
  if (answer > 0)
    return sphi_fail(ctx, SPH_RETRY, "the %s asked for a smaller step at t = %.9g", who, t);
  if (!is_library_status(answer))
    return sphi_fail(ctx, SPH_ERR_CALLBACK, "the %s failed with %d at t = %.9g", who, (int)answer,
                     t);
  (void)snprintf(before, sizeof before, "%s", sph_context_last_error(ctx));
  return sphi_fail(ctx, answer, "the %s answered %s at t = %.9g; last sentence: %s", who,
                   sph_status_name(answer), t, before);
}

sph_status sphi_evaluate(sph_integrator *it, sph_particles *set, double t, double *rate) {
  sph_rate rates[SPHI_ITEMS_MAX];
  for (int32_t k = 0; k < it->items; ++k)
    rates[k] = (sph_rate){it->item[k].field, rate + it->item[k].offset};
  it->evaluations += 1;
  int32_t answer = it->rhs ? sph_rhs_evaluate(it->rhs, set, it->list, t, rates, it->items)
                           : it->fn(it->user, t, set, rates, it->items);
  sph_status status = sphi_state_follow(it, set);
  if (status != SPH_OK) return status;
  if (it->rhs && answer < 0 && is_library_status(answer)) return answer;
  return translate(it->base.ctx, "right-hand side", t, answer);
}

/* ---- the filter -------------------------------------------------------------------------- */

/* vector NULL: the state in place. */
static sph_status filter(const sphi_step *step, double t, int32_t copy, double *vector) {
  sph_integrator *it = step->it;
  sph_rate values[SPHI_ITEMS_MAX];
  if (!it->filter) return SPH_OK;
  for (int32_t k = 0; k < it->items; ++k) {
    const sphi_item *item = &it->item[k];
    values[k] = (sph_rate){item->field, vector ? vector + item->offset : item->y};
    if (vector && item->field == SPH_FIELD_X) values[k].values = NULL;
  }
  int32_t answer = it->filter(it->filter_user, t, step->set, copy, values, it->items);
  sph_status status = sphi_state_follow(it, step->set);
  return status == SPH_OK ? translate(it->base.ctx, "filter", t, answer) : status;
}

sph_status sphi_filter_half(const sphi_step *step, double t, double *vector) {
  return filter(step, t, SPH_COPY_HALF, vector);
}

sph_status sphi_finish_stage(const sphi_step *step, double t, int32_t copy) {
  sph_status status = filter(step, t, copy, NULL);
  sphi_state_touch(step->it, step->set);
  return status;
}

sph_status sphi_write_stage(const sphi_step *step, const sphi_combination *c, double t,
                            int32_t copy) {
  sphi_state_combine(step->it, NULL, c);
  return sphi_finish_stage(step, t, copy);
}

void sphi_restore_start(const sphi_step *step) {
  sphi_state_copy(step->it, NULL, sphi_vector(step->it, SPHI_VEC_START));
  sphi_state_touch(step->it, step->set);
}

/* ---- checks ------------------------------------------------------------------------------ */

static sph_status check_time(const sph_integrator *it, double t, double dt) {
  sph_context *ctx = it->base.ctx;
  if (!isfinite(t) || !isfinite(dt) || dt == 0.0)
    return sphi_fail(ctx, SPH_ERR_ARG, "t = %g and dt = %g must be finite, dt not 0", t, dt);
  if (dt < 0.0 && it->options.method == SPH_INTEGRATOR_RKC)
    return sphi_fail(ctx, SPH_ERR_ARG, "dt = %g: RKC does not run backwards", dt);
  return SPH_OK;
}

static int32_t has_field(const sph_integrator *it, int32_t field) {
  return sphi_item_of(it, field) != NULL;
}

static sph_status check_ready(const sph_integrator *it) {
  sph_context *ctx = it->base.ctx;
  if (it->busy)
    return sphi_fail(ctx, SPH_ERR_STATE, "a step of this integrator is running already");
  if (it->items == 0) return sphi_fail(ctx, SPH_ERR_STATE, "nothing is bound");
  if (!it->fn && !it->rhs) return sphi_fail(ctx, SPH_ERR_STATE, "no right-hand side is set");
  if (it->rhs && it->fields < it->items)
    return sphi_fail(ctx, SPH_ERR_STATE,
                     "a composed right-hand side gives no rates for plain arrays; use a callback");
  if (it->options.method == SPH_INTEGRATOR_LEAPFROG &&
      (!has_field(it, SPH_FIELD_X) || !has_field(it, SPH_FIELD_V)))
    return sphi_fail(ctx, SPH_ERR_STATE, "leapfrog needs the fields X and V bound");
  if (it->options.method == SPH_INTEGRATOR_LEAPFROG_PREDICTED && has_field(it, SPH_FIELD_X) &&
      !has_field(it, SPH_FIELD_V))
    return sphi_fail(ctx, SPH_ERR_STATE, "leapfrog needs the field V bound, by which X moves");
  return SPH_OK;
}

static sph_status check_set(const sph_integrator *it, const sph_particles *set) {
  sph_context *ctx = it->base.ctx;
  if (set) return sphi_check_handle(ctx, set, SPHI_MAGIC_PARTICLES, "set");
  if (it->fields == 0 && !it->rhs) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_ARG, "set is NULL, but %s",
                   it->rhs ? "the right-hand side is composed" : "fields are bound");
}

/* ---- the step ---------------------------------------------------------------------------- */

static sph_status run_method(sphi_step *step) {
  switch (step->it->options.method) {
  case SPH_INTEGRATOR_LEAPFROG:
    return sphi_leapfrog_step(step);
  case SPH_INTEGRATOR_LEAPFROG_PREDICTED:
    return sphi_leapfrog_predicted_step(step);
  case SPH_INTEGRATOR_RKC:
    return sphi_rkc_step(step);
  default:
    return sphi_butcher_step(step);
  }
}

/* A state that became senseless says that the estimate was wrong: take a new one. */
static void go_back(sphi_step *step, sph_status status) {
  sphi_restore_start(step);
  if (status == SPH_ERR_NUMERIC) step->it->memory.estimated_at = -1;
}

static sph_status run_step(sphi_step *step) {
  sph_integrator *it = step->it;
  sph_status status = sphi_state_layout(it, step->set);
  if (status != SPH_OK) return status;
  sphi_state_copy(it, sphi_vector(it, SPHI_VEC_START), NULL);
  it->evaluations = 0;
  it->busy = 1;
  status = run_method(step);
  it->busy = 0;
  if (status == SPH_OK && it->options.check_finite) status = sphi_state_check_finite(it, step->set);
  if (status != SPH_OK) {
    go_back(step, status);
    return status;
  }
  it->memory.steps += 1;
  if (it->options.method == SPH_INTEGRATOR_LEAPFROG_PREDICTED) sphi_leapfrog_predicted_keep(step);
  return SPH_OK;
}

static sph_status read_info(sph_integrator *it, sph_step_info *info, const sph_step_info *host) {
  sph_step_info_init(info);
  if (!host) return SPH_OK;
  sph_status status = sphi_options_read(it->base.ctx, info, sizeof *info, host);
  int32_t want = info->want_error;
  sph_step_info_init(info);
  info->want_error = want;
  return status;
}

static void write_info(const sph_integrator *it, const sph_step_info *info, sph_step_info *host) {
  sph_step_info all = *info;
  if (!host) return;
  size_t size = host->size;
  all.evaluations = it->evaluations;
  all.eigen_re = it->memory.eigen.re;
  all.eigen_im = it->memory.eigen.im;
  all.growth = it->memory.growth;
  memcpy(host, &all, size < sizeof all ? size : sizeof all);
  host->size = size;
}

sph_status sph_integrator_step(sph_integrator *it, sph_particles *set, double t, double dt,
                               sph_step_info *info) {
  sph_status status = sphi_check_handle(NULL, it, SPHI_MAGIC_INTEGRATOR, "integrator");
  if (status != SPH_OK) return status;
  status = check_time(it, t, dt);
  if (status == SPH_OK) status = check_ready(it);
  if (status == SPH_OK) status = check_set(it, set);
  if (status != SPH_OK) return status;
  sph_step_info answer;
  status = read_info(it, &answer, info);
  if (status != SPH_OK) return status;
  sphi_step step = {it, set, t, dt, &answer, info != NULL};
  status = run_step(&step);
  if (status == SPH_OK || status == SPH_RETRY) write_info(it, &answer, info);
  return status;
}
