/* Terms on a frozen configuration: what is kept of it from evaluation to evaluation, and the sums
 * of total-Lagrangian elasticity. */
#include "../sweep/invert.h"
#include "rhs_impl.h"

#include <string.h>

int sphi_term_frozen(const sph_term *t) {
  switch (t->kind) {
  case SPH_TERM_FIRST_PIOLA:
  case SPH_TERM_HOURGLASS:
    return 1;
  case SPH_TERM_STRESS_RATE:
    return t->form == SPH_STRESS_RATE_LAGRANGIAN;
  case SPH_TERM_MONAGHAN:
    return t->form == SPH_MONAGHAN_CURRENT;
  default:
    return 0;
  }
}

/* ---- the configuration -------------------------------------------------------------------------
 */

static sphi_frozen_key key_of(const sphi_evaluation *e) {
  static const int32_t fields[5] = {SPH_FIELD_X0, SPH_FIELD_H, SPH_FIELD_M, SPH_FIELD_RHO,
                                    SPH_FIELD_C};
  sphi_frozen_key key;
  memset(&key, 0, sizeof key); /* keys are compared as bytes */
  key.set = e->set;
  key.list = e->list;
  key.pair = e->list->pair;
  key.generation = sph_particles_generation(e->set);
  for (int k = 0; k < 5; ++k) key.revision[k] = sph_particles_revision(e->set, fields[k]);
  key.builds = e->list->builds;
  return key;
}

int sphi_frozen_unchanged(const sphi_evaluation *e) {
  if (e->rhs->options.position_field != SPH_FIELD_X0 || e->list->builds == 0) return 0;
  sphi_frozen_key key = key_of(e);
  return memcmp(&key, &e->rhs->frozen_key, sizeof key) == 0;
}

void sphi_frozen_remember(sphi_evaluation *e) {
  e->rhs->frozen_has = 0;
  if (e->rhs->options.position_field == SPH_FIELD_X0) e->rhs->frozen_key = key_of(e);
}

/* ---- what the terms need -----------------------------------------------------------------------
 */

static int needs_gradient(const sphi_evaluation *e) {
  return sphi_term_wanted(e, SPH_TERM_FIRST_PIOLA) || sphi_term_wanted(e, SPH_TERM_HOURGLASS) ||
         sphi_form_wanted(e, SPH_TERM_STRESS_RATE, SPH_STRESS_RATE_LAGRANGIAN);
}

static int needs_frozen(const sphi_evaluation *e) {
  return needs_gradient(e) || sphi_form_wanted(e, SPH_TERM_MONAGHAN, SPH_MONAGHAN_CURRENT);
}

/* Whether P comes from the Cauchy stress, which is then integrated in time. */
static int from_cauchy(const sphi_evaluation *e) {
  return e->rhs->terms[SPH_TERM_STRESS_RATE].form == SPH_STRESS_RATE_LAGRANGIAN;
}

sph_status sphi_frozen_check(sphi_evaluation *e) {
  sph_status s = SPH_OK;
  if (sphi_term_wanted(e, SPH_TERM_FIRST_PIOLA)) {
    if (from_cauchy(e) && !e->a.sigma)
      s = sphi_fail(e->rhs->base.ctx, SPH_ERR_ARG, "sph_rhs_evaluate: term %d needs field sigma",
                    SPH_TERM_FIRST_PIOLA);
    if (!s) s = sph_particles_field(e->set, SPH_FIELD_PK, &e->P);
  }
  if (!s && needs_gradient(e)) s = sph_particles_field(e->set, SPH_FIELD_F, &e->F);
  return s;
}

static sph_status reserve(sphi_evaluation *e, int slot, int64_t doubles) {
  size_t bytes = sphi_mul((size_t)doubles, sizeof(double));
  return sphi_buffer_reserve(e->rhs->base.ctx, &e->rhs->scratch[slot], bytes);
}

static double *scratch(const sphi_evaluation *e, int slot) { return e->rhs->scratch[slot].ptr; }

/* Weights of the pairs, unless they are known. */
static sph_status make_weights(sphi_evaluation *e, sphi_frozen *z) {
  sph_rhs *rhs = e->rhs;
  const int central = sphi_form_wanted(e, SPH_TERM_HOURGLASS, SPH_HOURGLASS_CENTRAL);
  const uint32_t wanted = SPHI_FROZEN_HAS_SLOPE | (central ? SPHI_FROZEN_HAS_VALUE : 0);
  sph_status s = SPH_OK;
  if ((rhs->frozen_has & wanted) != wanted) {
    s = reserve(e, SPHI_RHS_SLOPE, sphi_frozen_pairs(e->list));
    if (!s && central) s = reserve(e, SPHI_RHS_VALUE, sphi_frozen_pairs(e->list));
  }
  if (s) return s;
  *z = (sphi_frozen){.list = e->list,
                     .kernel = rhs->kernel,
                     .a = &e->a,
                     .slope = scratch(e, SPHI_RHS_SLOPE),
                     .value = central ? scratch(e, SPHI_RHS_VALUE) : NULL,
                     .stiffness = rhs->frozen_stiffness};
  if ((rhs->frozen_has & wanted) == wanted) return SPH_OK;
  sphi_frozen_weights(z, scratch(e, SPHI_RHS_RECORDS));
  rhs->frozen_stiffness = z->stiffness;
  rhs->frozen_has = (rhs->frozen_has & SPHI_FROZEN_HAS_MATRIX) | wanted;
  return SPH_OK;
}

/* ---- the sums ----------------------------------------------------------------------------------
 */

static sphi_frozen_force force_of(const sphi_evaluation *e, const double *x) {
  const sph_term *piola = &e->rhs->terms[SPH_TERM_FIRST_PIOLA];
  const sph_term *hourglass = &e->rhs->terms[SPH_TERM_HOURGLASS];
  const sph_term *viscosity = &e->rhs->terms[SPH_TERM_MONAGHAN];
  sphi_frozen_force force = {.corrected = piola->corrected,
                             .x = x,
                             .v = e->a.v,
                             .F = e->F,
                             .P = e->P,
                             .hourglass = hourglass->alpha,
                             .alpha = viscosity->alpha,
                             .beta = viscosity->beta,
                             .dvdt = sphi_rate_of(e, SPH_FIELD_V)};
  if (sphi_form_wanted(e, SPH_TERM_FIRST_PIOLA, SPH_PIOLA_CONSERVATIVE))
    force.terms |= SPHI_FROZEN_PIOLA;
  if (sphi_form_wanted(e, SPH_TERM_FIRST_PIOLA, SPH_PIOLA_SUMMED))
    force.terms |= SPHI_FROZEN_PIOLA_ROW;
  if (sphi_form_wanted(e, SPH_TERM_HOURGLASS, SPH_HOURGLASS_VARIATIONAL))
    force.terms |= SPHI_FROZEN_HOURGLASS;
  if (sphi_form_wanted(e, SPH_TERM_HOURGLASS, SPH_HOURGLASS_CENTRAL))
    force.terms |= SPHI_FROZEN_HOURGLASS_CENTRAL;
  if (sphi_form_wanted(e, SPH_TERM_MONAGHAN, SPH_MONAGHAN_CURRENT))
    force.terms |= SPHI_FROZEN_VISCOSITY;
  return force;
}

enum { POINT_GRAIN = 2048 };

/* P = J sigma F^-T = sigma (adj F)^T. */
static void cauchy_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  static const int at[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  const sphi_evaluation *e = job;
  const int d = e->dim, c = sph_sym_components(e->dim);
  double adj[9];
  (void)worker;
  for (int64_t i = lo; i < hi; ++i) {
    sphi_adjugate(d, e->F + i * d * d, adj);
    for (int r = 0; r < d; ++r)
      for (int s = 0; s < d; ++s) {
        double sum = 0.0;
        for (int k = 0; k < d; ++k)
          sum += e->a.sigma[i * c + (d == 2 && r != k ? 2 : at[r][k])] * adj[s * d + k];
        e->P[(i * d + r) * d + s] = sum;
      }
  }
}

/* L = F' F^-1, in the place of F'. */
static void rate_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const sphi_evaluation *e = job;
  const int d = e->dim;
  double rate[9], adj[9];
  (void)worker;
  for (int64_t i = lo; i < hi; ++i) {
    double *L = scratch(e, SPHI_RHS_GRADV) + i * d * d;
    double per = 1.0 / sphi_adjugate(d, e->F + i * d * d, adj);
    memcpy(rate, L, (size_t)(d * d) * sizeof *rate);
    for (int r = 0; r < d; ++r)
      for (int c = 0; c < d; ++c) {
        double sum = 0.0;
        for (int k = 0; k < d; ++k) sum += rate[r * d + k] * adj[k * d + c];
        L[r * d + c] = per * sum;
      }
  }
}

static sph_status make_stress(sphi_evaluation *e) {
  if (!from_cauchy(e)) return sphi_rhs_first_piola(e);
  sphi_parallel(e->rhs->base.ctx, e->a.n, POINT_GRAIN, cauchy_range, e);
  return SPH_OK;
}

static sph_status make_velocity_gradient(sphi_evaluation *e, const sphi_frozen *z) {
  sph_status s = reserve(e, SPHI_RHS_GRADV, e->rows * e->dim * e->dim);
  if (s) return s;
  sphi_frozen_gradient(z, e->a.v, NULL, 0, e->rows, scratch(e, SPHI_RHS_RECORDS),
                       scratch(e, SPHI_RHS_GRADV));
  sphi_parallel(e->rhs->base.ctx, e->rows, POINT_GRAIN, rate_range, e);
  return SPH_OK;
}

sph_status sphi_rhs_frozen_terms(sphi_evaluation *e) {
  const double *x = sph_particles_field_const(e->set, SPH_FIELD_X);
  sphi_frozen z;
  if (!needs_frozen(e)) return SPH_OK;
  sph_status s = sphi_rhs_matrices(e);
  if (!s) s = reserve(e, SPHI_RHS_RECORDS, sphi_frozen_scratch(e->dim, e->a.n));
  if (!s) s = make_weights(e, &z);
  if (s) return s;
  double *records = scratch(e, SPHI_RHS_RECORDS);
  if (e->F) sphi_frozen_gradient(&z, x, e->a.x, 1, e->a.n, records, e->F);
  if (e->P) s = make_stress(e);
  if (s) return s;
  sphi_frozen_force force = force_of(e, x);
  if (force.terms) sphi_frozen_add_force(&z, &force, records);
  if (!sphi_form_wanted(e, SPH_TERM_STRESS_RATE, SPH_STRESS_RATE_LAGRANGIAN)) return SPH_OK;
  return make_velocity_gradient(e, &z);
}
