/* Terms in which each particle has its own h: one sweep for pressure, deviator and dissipation. */
#include "rhs_impl.h"

int sphi_smoothed_makes_gradient(const sphi_evaluation *e) {
  const sph_term *rate = &e->rhs->terms[SPH_TERM_STRESS_RATE];
  return e->rhs->terms[SPH_TERM_SMOOTHED_STRESS].kind && !rate->corrected &&
         sphi_form_wanted(e, SPH_TERM_STRESS_RATE, SPH_STRESS_RATE_SPATIAL);
}

static uint32_t terms_of(const sphi_evaluation *e) {
  uint32_t terms = 0;
  if (sphi_term_wanted(e, SPH_TERM_SMOOTHED)) terms |= SPHI_SMOOTHED_PRESSURE;
  if (sphi_term_wanted(e, SPH_TERM_DISSIPATION)) terms |= SPHI_SMOOTHED_DISSIPATION;
  if (sphi_term_wanted(e, SPH_TERM_SMOOTHED_STRESS) || sphi_smoothed_makes_gradient(e))
    terms |= SPHI_SMOOTHED_STRESS;
  return terms;
}

static int needs_pressure(const sphi_evaluation *e, uint32_t terms) {
  const sph_dissipation *z = &e->rhs->dissipation;
  const int flux = z->mass_flux > 0.0 && sphi_rate_of(e, SPH_FIELD_RHO);
  const int heat = z->conductivity > 0.0 && z->conductivity_form == SPH_CONDUCTIVITY_PRESSURE &&
                   sphi_rate_of(e, SPH_FIELD_E);
  if (sphi_rhs_has_pressure_law(e->rhs)) return 0; /* it makes the field */
  if (terms & SPHI_SMOOTHED_PRESSURE)
    return sphi_rate_of(e, SPH_FIELD_V) || sphi_rate_of(e, SPH_FIELD_E);
  return (terms & SPHI_SMOOTHED_DISSIPATION) && (flux || heat);
}

typedef struct need {
  const double *array;
  int32_t field;
  int wanted;
} need;

sph_status sphi_smoothed_check(sphi_evaluation *e) {
  const sph_operands *a = &e->a;
  const uint32_t terms = terms_of(e);
  const int loss = (terms & SPHI_SMOOTHED_DISSIPATION) != 0;
  const int conducts =
      loss && e->rhs->dissipation.conductivity > 0.0 && sphi_rate_of(e, SPH_FIELD_E);
  const need needs[] = {{a->v, SPH_FIELD_V, 1},
                        {a->m, SPH_FIELD_M, 1},
                        {a->rho, SPH_FIELD_RHO, 1},
                        {a->p, SPH_FIELD_P, needs_pressure(e, terms)},
                        {a->c, SPH_FIELD_C, loss},
                        {a->e, SPH_FIELD_E, conducts},
                        {a->sigma, SPH_FIELD_SIGMA, (terms & SPHI_SMOOTHED_STRESS) != 0}};
  if (!terms) return SPH_OK;
  for (size_t k = 0; k < sizeof needs / sizeof *needs; ++k)
    if (needs[k].wanted && !needs[k].array)
      return sphi_fail(e->rhs->base.ctx, SPH_ERR_ARG,
                       "sph_rhs_evaluate: the terms of variable smoothing lengths need field %s",
                       sphi_field_name(e->set, needs[k].field));
  return sphi_check_both_h(e->list, "sph_rhs_evaluate");
}

sph_status sphi_rhs_smoothed_terms(sphi_evaluation *e) {
  sph_rhs *rhs = e->rhs;
  sphi_smoothed sweep = {.terms = terms_of(e),
                         .smoothing = rhs->terms[SPH_TERM_SMOOTHED].form,
                         .kernel = rhs->kernel,
                         .a = &e->a,
                         .dissipation = rhs->dissipation,
                         .drho = sphi_rate_of(e, SPH_FIELD_RHO),
                         .dvdt = sphi_rate_of(e, SPH_FIELD_V),
                         .dedt = sphi_rate_of(e, SPH_FIELD_E)};
  if (!sweep.terms) return SPH_OK;
  if (sphi_smoothed_makes_gradient(e)) { /* which the materials read next */
    size_t bytes = sphi_mul((size_t)(e->rows * e->dim * e->dim), sizeof(double));
    sph_status s = sphi_buffer_reserve(rhs->base.ctx, &rhs->scratch[SPHI_RHS_GRADV], bytes);
    if (s) return s;
    sweep.gradv = rhs->scratch[SPHI_RHS_GRADV].ptr;
  }
  return sphi_smoothed_run(e->list, &sweep);
}
