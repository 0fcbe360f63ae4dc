/* One evaluation, from top to bottom: checks, hook, list, pressures, pair sums, pointwise rates,
 * hook. */
#include "rhs_impl.h"

#include <stdio.h>
#include <string.h>

/* The fields that a kind of term adds to, as bits. */
static uint32_t term_fields(int32_t kind) {
  switch (kind) {
  case SPH_TERM_CONTINUITY:
    return 1u << SPH_FIELD_RHO;
  case SPH_TERM_STRESS_RATE:
    return 1u << SPH_FIELD_SIGMA;
  case SPH_TERM_XSPH:
  case SPH_TERM_MOTION:
    return 1u << SPH_FIELD_X;
  case SPH_TERM_SMOOTHED:
  case SPH_TERM_DISSIPATION:
    return 1u << SPH_FIELD_RHO | 1u << SPH_FIELD_V | 1u << SPH_FIELD_E;
  case SPH_TERM_SMOOTHED_STRESS:
    return 1u << SPH_FIELD_V | 1u << SPH_FIELD_E;
  default:
    return 1u << SPH_FIELD_V;
  }
}

double *sphi_rate_of(const sphi_evaluation *e, int32_t field) {
  for (int32_t k = 0; k < e->count; ++k)
    if (e->rates[k].field == field) return e->rates[k].values;
  return NULL;
}

int sphi_term_wanted(const sphi_evaluation *e, int32_t kind) {
  uint32_t asked = 0;
  for (int32_t k = 0; k < e->count; ++k)
    if (e->rates[k].field < 32) asked |= 1u << e->rates[k].field;
  return e->rhs->terms[kind].kind && (asked & term_fields(kind)) != 0;
}

int sphi_form_wanted(const sphi_evaluation *e, int32_t kind, int32_t form) {
  return sphi_term_wanted(e, kind) && e->rhs->terms[kind].form == form;
}

static sph_status check_rates(const sphi_evaluation *e) {
  sph_context *ctx = e->rhs->base.ctx;
  if (e->count < 0 || (e->count > 0 && !e->rates))
    return sphi_fail(ctx, SPH_ERR_ARG, "sph_rhs_evaluate: %d rates, array %s", e->count,
                     e->rates ? "given" : "NULL");
  for (int32_t k = 0; k < e->count; ++k) {
    if (!e->rates[k].values && e->rows > 0)
      return sphi_fail(ctx, SPH_ERR_ARG, "sph_rhs_evaluate: the rate of %s is NULL",
                       sphi_field_name(e->set, e->rates[k].field));
    if (sph_particles_components(e->set, e->rates[k].field) == 0)
      return sphi_fail(ctx, SPH_ERR_ARG, "sph_rhs_evaluate: there is no field %d",
                       e->rates[k].field);
    for (int32_t l = 0; l < k; ++l)
      if (e->rates[l].field == e->rates[k].field)
        return sphi_fail(ctx, SPH_ERR_ARG, "sph_rhs_evaluate: the rate of %s is asked for twice",
                         sphi_field_name(e->set, e->rates[k].field));
  }
  return SPH_OK;
}

static sph_status check_arguments(sph_rhs *rhs, sph_particles *set, sph_neighbors *list) {
  sph_status s = sphi_check_handle(NULL, rhs, SPHI_MAGIC_RHS, "rhs");
  if (!s) s = sphi_check_handle(rhs->base.ctx, set, SPHI_MAGIC_PARTICLES, "set");
  if (!s) s = sphi_check_handle(rhs->base.ctx, list, SPHI_MAGIC_NEIGHBORS, "list");
  if (s) return s;
  if (rhs->kernel->dim != sph_particles_dim(set))
    return sphi_fail(rhs->base.ctx, SPH_ERR_ARG,
                     "sph_rhs_evaluate: the set is %d-D, the kernel %d-D", sph_particles_dim(set),
                     rhs->kernel->dim);
  if (list->options.support < rhs->kernel->support * (1.0 - 1e-12))
    return sphi_fail(rhs->base.ctx, SPH_ERR_ARG,
                     "sph_rhs_evaluate: the list reaches %g h, the kernel %g h",
                     list->options.support, rhs->kernel->support);
  return SPH_OK;
}

static sph_status require(sphi_evaluation *e, const void *array, int32_t field, int32_t kind) {
  if (array) return SPH_OK;
  return sphi_fail(e->rhs->base.ctx, SPH_ERR_ARG, "sph_rhs_evaluate: term %d needs field %s", kind,
                   sphi_field_name(e->set, field));
}

static int needs_c(const sph_term *t) {
  return t->kind == SPH_TERM_MONAGHAN || t->kind == SPH_TERM_HOURGLASS ||
         (t->kind == SPH_TERM_BULK_VISCOSITY && (t->linear != 0.0 || t->alpha != 0.0));
}

/* Which fields each wanted term reads. */
static sph_status check_fields(sphi_evaluation *e) {
  const sph_operands *a = &e->a;
  sph_status s = require(e, a->h, SPH_FIELD_H, 0);
  for (int32_t k = 1; !s && k < SPH_TERM_SMOOTHED; ++k) {
    const sph_term *t = &e->rhs->terms[k];
    if (!sphi_term_wanted(e, k)) continue;
    int velocity = k == SPH_TERM_CONTINUITY || k == SPH_TERM_STRESS_RATE ||
                   k == SPH_TERM_MONAGHAN || k == SPH_TERM_BULK_VISCOSITY || k == SPH_TERM_XSPH ||
                   k == SPH_TERM_MOTION;
    int sums = k != SPH_TERM_BODY_FORCE && k != SPH_TERM_MOTION;
    int stress = k == SPH_TERM_STRESS || k == SPH_TERM_ARTIFICIAL_STRESS;
    if (velocity) s = require(e, a->v, SPH_FIELD_V, k);
    if (!s && sums) s = require(e, a->m, SPH_FIELD_M, k);
    if (!s && sums) s = require(e, a->rho, SPH_FIELD_RHO, k);
    if (!s && k == SPH_TERM_PRESSURE && !sphi_rhs_has_pressure_law(e->rhs))
      s = require(e, a->p, SPH_FIELD_P, k);
    if (!s && stress) s = require(e, a->sigma, SPH_FIELD_SIGMA, k);
    if (!s && needs_c(t)) s = require(e, a->c, SPH_FIELD_C, k);
  }
  return s;
}

/* The hook may have called the library, whose sentence goes on. It is copied first, as the new one
 * takes its place. */
static sph_status hook_failed(const sphi_evaluation *e, const char *name, int32_t answer) {
  sph_context *ctx = e->rhs->base.ctx;
  char before[512];
  (void)snprintf(before, sizeof before, "%s", sph_context_last_error(ctx));
  if (before[0] == '\0' || strcmp(sph_status_name(answer), "unknown") == 0)
    return sphi_fail(ctx, SPH_ERR_CALLBACK, "the %s hook answered %d at t = %g", name, answer,
                     e->t);
  return sphi_fail(ctx, SPH_ERR_CALLBACK,
                   "the %s hook answered %d (%s) at t = %g; last sentence: %s", name, answer,
                   sph_status_name(answer), e->t, before);
}

static sph_status run_hook(sphi_evaluation *e, sph_rhs_hook hook, void *user, const char *name) {
  if (!hook) return SPH_OK;
  int32_t answer = hook(user, e->t, e->set, e->rates, e->count);
  if (answer == 0) return SPH_OK;
  if (answer > 0) return SPH_RETRY;
  return hook_failed(e, name, answer);
}

/* A list that is not to be updated here must still hold. */
static sph_status check_fresh(const sphi_evaluation *e) {
  sph_status s = sphi_neighbors_check(e->list, e->dim, e->a.n);
  return s || e->a.n == 0 ? s : sphi_neighbors_fresh(e->list, e->a.x, e->a.h, e->a.h0);
}

static sph_status update_list(sphi_evaluation *e) {
  const sph_operands *a = &e->a;
  sph_status s;
  if (sphi_frozen_unchanged(e)) return SPH_OK;
  if (!e->rhs->options.update_list)
    s = check_fresh(e);
  else if (e->rhs->options.position_field == SPH_FIELD_X)
    s = sph_neighbors_update(e->list, e->set, NULL);
  else
    s = sph_neighbors_update_arrays(e->list, a->dim, a->n, a->x, a->h, a->h0, NULL);
  if (!s) sphi_frozen_remember(e);
  return s;
}

static sph_status gather(sphi_evaluation *e) {
  sph_status s = sph_operands_from_set(e->set, &e->a);
  if (s) return s;
  int32_t field = e->rhs->options.position_field;
  e->a.x = sph_particles_field_const(e->set, field);
  e->rows = e->a.rows;
  return require(e, e->a.x, field, 0);
}

static void clear_rates(sphi_evaluation *e) {
  for (int32_t k = 0; k < e->count; ++k) {
    int32_t c = sph_particles_components(e->set, e->rates[k].field);
    if (e->rows > 0) memset(e->rates[k].values, 0, (size_t)e->rows * (size_t)c * sizeof(double));
  }
}

/* The hook may mirror pressures, so they are those of this state when it runs; it may also change
 * the state, so they are computed again after it. It may have added ghosts; the arrays of the rates
 * have no room for more real particles. */
static sph_status prepare(sphi_evaluation *e) {
  int64_t rows = e->rows;
  sph_status s = e->rhs->prepare ? sphi_rhs_pressures(e) : SPH_OK;
  if (!s) s = run_hook(e, e->rhs->prepare, e->rhs->prepare_user, "prepare");
  if (!s) s = gather(e);
  if (s || e->rows == rows) return s;
  return sphi_fail(e->rhs->base.ctx, SPH_ERR_STATE,
                   "the prepare hook changed the number of real particles from %lld to %lld",
                   (long long)rows, (long long)e->rows);
}

static sph_status evaluate(sphi_evaluation *e) {
  sph_rhs *rhs = e->rhs;
  sph_status s = gather(e);
  if (!s) s = check_rates(e);
  if (!s) s = prepare(e);
  if (!s) s = check_fields(e);
  if (!s) s = sphi_frozen_check(e);
  if (!s) s = update_list(e);
  if (!s) s = sphi_smoothed_check(e);
  if (!s) s = sphi_rhs_pressures(e);
  if (s) return s;
  clear_rates(e);
  if (e->rows > 0) s = sphi_rhs_sweeps(e);
  if (!s && e->rows > 0) s = sphi_rhs_frozen_terms(e);
  if (!s && e->rows > 0) s = sphi_rhs_smoothed_terms(e);
  if (!s && e->rows > 0) s = sphi_rhs_host_terms(e);
  if (!s && e->rows > 0) s = sphi_rhs_stress_rates(e);
  if (s) return s;
  sphi_rhs_pointwise(e);
  return run_hook(e, rhs->finish, rhs->finish_user, "finish");
}

sph_status sph_rhs_evaluate(sph_rhs *rhs, sph_particles *set, sph_neighbors *list, double t,
                            const sph_rate *rates, int32_t count) {
  sph_status s = check_arguments(rhs, set, list);
  if (s) return s;
  sphi_evaluation e = {.rhs = rhs,
                       .set = set,
                       .list = list,
                       .t = t,
                       .rates = rates,
                       .count = count,
                       .dim = sph_particles_dim(set)};
  e.rows = sph_particles_real_count(set);
  return evaluate(&e);
}
