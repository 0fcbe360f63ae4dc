/* The pair sums of an evaluation: what must come before (gradient matrices, viscous pressures,
 * artificial stress), then one sweep for all terms. */
#include "../sweep/artificial.h"
#include "rhs_impl.h"

#include <string.h>

static const struct {
  int32_t kind;
  uint32_t term;
} sweep_terms[] = {
    {SPH_TERM_CONTINUITY, SPHI_CONTINUITY},
    {SPH_TERM_PRESSURE, SPHI_PRESSURE},
    {SPH_TERM_STRESS, SPHI_STRESS},
    {SPH_TERM_STRESS_RATE, SPHI_GRADV},
    {SPH_TERM_MONAGHAN, SPHI_MONAGHAN},
    {SPH_TERM_BULK_VISCOSITY, SPHI_BULK},
    {SPH_TERM_XSPH, SPHI_XSPH},
    {SPH_TERM_ARTIFICIAL_STRESS, SPHI_ARTSTRESS},
};

enum { SWEEP_TERMS = sizeof sweep_terms / sizeof *sweep_terms };

static sph_status reserve(sphi_evaluation *e, int slot, int64_t doubles) {
  size_t bytes = sphi_mul((size_t)doubles, sizeof(double));
  return sphi_buffer_reserve(e->rhs->base.ctx, &e->rhs->scratch[slot], bytes);
}

static double *scratch(sphi_evaluation *e, int slot) { return e->rhs->scratch[slot].ptr; }

static sphi_spec spec_of(const sphi_evaluation *e) {
  sphi_spec spec = {.continuity = SPH_CONTINUITY_MASS,
                    .pressure = SPH_PRESSURE_MASS,
                    .stress = SPH_STRESS_SUMMED};
  for (int k = 0; k < SWEEP_TERMS; ++k) {
    const sph_term *t = &e->rhs->terms[sweep_terms[k].kind];
    if (!sphi_term_wanted(e, sweep_terms[k].kind) || sphi_term_frozen(t)) continue;
    if (t->kind == SPH_TERM_STRESS_RATE && sphi_smoothed_makes_gradient(e)) continue;
    spec.terms |= sweep_terms[k].term;
    if (t->corrected) spec.corrected |= sweep_terms[k].term;
    if (t->kind == SPH_TERM_CONTINUITY) spec.continuity = t->form;
    if (t->kind == SPH_TERM_PRESSURE) spec.pressure = t->form;
    if (t->kind == SPH_TERM_STRESS) spec.stress = t->form;
  }
  return spec;
}

/* Matrices are needed before the sweep only where something needs them earlier or of neighbours;
 * else the sweep makes each row's own. */
static int needs_matrices_before(const sphi_spec *spec) {
  return (spec->corrected & SPHI_BULK) ||
         ((spec->terms & SPHI_STRESS) && spec->stress == SPH_STRESS_CONSERVATIVE);
}

/* Ghosts need a matrix only where the conservative form reads that of j. */
sph_status sphi_rhs_matrices(sphi_evaluation *e) {
  sph_operands all = e->a;
  sph_status s = SPH_OK;
  all.rows = all.n;
  all.gradient_matrix = NULL;
  if (!(e->rhs->frozen_has & SPHI_FROZEN_HAS_MATRIX)) {
    s = reserve(e, SPHI_RHS_MATRIX, all.n * e->dim * e->dim);
    if (!s)
      s = sphi_gradient_matrices(e->list, e->rhs->kernel, &all, scratch(e, SPHI_RHS_MATRIX), NULL);
  }
  if (s) return s;
  if (e->rhs->options.position_field == SPH_FIELD_X0) e->rhs->frozen_has |= SPHI_FROZEN_HAS_MATRIX;
  e->a.gradient_matrix = scratch(e, SPHI_RHS_MATRIX);
  return SPH_OK;
}

static sph_status make_bulk(sphi_evaluation *e) {
  const sph_term *t = &e->rhs->terms[SPH_TERM_BULK_VISCOSITY];
  sph_bulk_viscosity o = {sizeof o, t->neumann, t->linear, t->spacing, t->alpha, t->beta};
  sph_operands a = e->a;
  sph_status s = reserve(e, SPHI_RHS_Q, a.n);
  if (!s) s = reserve(e, SPHI_RHS_GRADV, e->rows * e->dim * e->dim);
  if (s) return s;
  if (!t->corrected) a.gradient_matrix = NULL;
  return sphi_bulk_pressures(e->list, e->rhs->kernel, &a, &o, scratch(e, SPHI_RHS_GRADV),
                             scratch(e, SPHI_RHS_Q));
}

typedef struct art_job {
  sphi_evaluation *e;
  double *out;
  sphi_artificial_fn stress;
} art_job;

static void art_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const art_job *j = job;
  const sph_operands *a = &j->e->a;
  double epsilon = j->e->rhs->terms[SPH_TERM_ARTIFICIAL_STRESS].epsilon;
  int32_t c = sph_sym_components(a->dim);
  (void)worker;
  j->stress(a->dim, hi - lo, a->sigma + lo * c, a->rho + lo, 0.0, epsilon, j->out + lo * c);
}

static sph_status make_art(sphi_evaluation *e) {
  enum { GRAIN = 1024 };
  sph_status s = reserve(e, SPHI_RHS_ART, e->a.n * sph_sym_components(e->dim));
  if (s) return s;
  art_job job = {e, scratch(e, SPHI_RHS_ART), sphi_artificial(sphi_isa(e->rhs->base.ctx))};
  sphi_parallel(e->rhs->base.ctx, e->a.n, GRAIN, art_range, &job);
  return SPH_OK;
}

/* 1 / w(q) at the initial spacing, in the normalisation of a pair's W. */
static double art_scale(const sphi_evaluation *e) {
  const sph_term *t = &e->rhs->terms[SPH_TERM_ARTIFICIAL_STRESS];
  double w, dw;
  sphi_kernel_profile(e->rhs->kernel, t->spacing_ratio, &w, &dw);
  return 1.0 / w;
}

static sph_status make_outputs(sphi_evaluation *e, sphi_sweep *sweep) {
  sph_status s = SPH_OK;
  uint32_t terms = sweep->spec.terms;
  if (terms & SPHI_GRADV) s = reserve(e, SPHI_RHS_GRADV, e->rows * e->dim * e->dim);
  if (!s && (terms & SPHI_XSPH)) s = reserve(e, SPHI_RHS_XSPH, e->rows * e->dim);
  sweep->gradv = scratch(e, SPHI_RHS_GRADV);
  sweep->xsph = scratch(e, SPHI_RHS_XSPH);
  sweep->drho = sphi_rate_of(e, SPH_FIELD_RHO);
  sweep->dvdt = sphi_rate_of(e, SPH_FIELD_V);
  return s;
}

static sph_status make_inputs(sphi_evaluation *e, sphi_sweep *sweep) {
  const sph_term *monaghan = &e->rhs->terms[SPH_TERM_MONAGHAN];
  sph_status s = SPH_OK;
  uint32_t terms = sweep->spec.terms;
  /* matrices of a frozen configuration are kept; others are made within the sweep */
  const int kept = e->rhs->options.position_field == SPH_FIELD_X0;
  if (needs_matrices_before(&sweep->spec) || (kept && sweep->spec.corrected))
    s = sphi_rhs_matrices(e);
  else if (sweep->spec.corrected)
    sweep->spec.terms |= SPHI_MATRIX;
  if (!s && (terms & SPHI_BULK)) s = make_bulk(e);
  if (!s && (terms & SPHI_ARTSTRESS)) s = make_art(e);
  sweep->alpha = monaghan->alpha;
  sweep->beta = monaghan->beta;
  sweep->q = scratch(e, SPHI_RHS_Q);
  sweep->art = scratch(e, SPHI_RHS_ART);
  sweep->art_power = e->rhs->terms[SPH_TERM_ARTIFICIAL_STRESS].power;
  if (terms & SPHI_ARTSTRESS) sweep->art_scale = art_scale(e);
  return s;
}

sph_status sphi_rhs_sweeps(sphi_evaluation *e) {
  sphi_sweep sweep;
  memset(&sweep, 0, sizeof sweep);
  sweep.kernel = e->rhs->kernel;
  sweep.spec = spec_of(e);
  e->active = sweep.spec.terms;
  if (!sweep.spec.terms) return sphi_neighbors_check(e->list, e->dim, e->a.n);
  sph_status s = make_inputs(e, &sweep);
  if (!s) s = make_outputs(e, &sweep);
  sweep.a = &e->a;
  return s ? s : sphi_sweep_run(e->list, &sweep);
}
