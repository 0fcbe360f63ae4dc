/* The parts of an evaluation that look at one particle at a time: laws of the materials, motion,
 * body force. */
#include "rhs_impl.h"

#include <string.h>

enum { GRAIN = 1024 };

/* A law over all particles, in runs of one phase. The lowest failing particle wins, so that
 * messages repeat. */
typedef struct law_job {
  sphi_evaluation *e;
  int32_t property;
  const int32_t *phase;
  double *out;
  double *energy; /* FIRST_PIOLA: may be NULL */
  double *strain; /* PLASTIC_RETURN: may be NULL */
  int64_t failed;
  sph_status status; /* of a rerun of the failing run, on the calling thread */
} law_job;

static sph_material *law_of(const law_job *j, int64_t i) {
  int32_t p = j->phase[i];
  sph_material *m = p >= 0 && p < SPHI_PHASES ? j->e->rhs->materials[p] : NULL;
  return sphi_material_has(m, j->property) ? m : NULL;
}

static const double *shifted(const double *array, int64_t at) { return array ? array + at : NULL; }

static sph_material_block block_of(const law_job *j, int64_t lo, int64_t hi) {
  const sph_operands *a = &j->e->a;
  int32_t d = a->dim;
  sph_material_block b;
  sph_material_block_init(&b);
  b.dim = d;
  b.n = hi - lo;
  if (j->property == SPHI_MATERIAL_STRESS_RATE)
    b.velocity_gradient = (const double *)j->e->rhs->scratch[SPHI_RHS_GRADV].ptr + lo * d * d;
  if (j->property == SPHI_MATERIAL_FIRST_PIOLA) b.deformation_gradient = j->e->F + lo * d * d;
  b.sigma = shifted(a->sigma, lo * sph_sym_components(d));
  b.rho = shifted(a->rho, lo);
  b.e = shifted(sph_particles_field_const(j->e->set, SPH_FIELD_E), lo);
  return b;
}

static sph_status run_law(const law_job *j, int64_t lo, int64_t hi) {
  sph_material *m = law_of(j, lo);
  if (!m) return SPH_OK;
  sph_material_block b = block_of(j, lo, hi);
  if (j->property == SPHI_MATERIAL_STRESS_RATE)
    return sphi_material_stress_rate_quiet(m, &b, j->out + lo * sph_sym_components(b.dim));
  if (j->property == SPHI_MATERIAL_FIRST_PIOLA)
    return sphi_material_first_piola_quiet(m, b.dim, b.n, b.deformation_gradient,
                                           j->out + lo * b.dim * b.dim,
                                           j->energy ? j->energy + lo : NULL);
  if (j->property == SPHI_MATERIAL_PLASTIC_RETURN)
    return sphi_material_plastic_return_quiet(m, &b, j->out + lo * sph_sym_components(b.dim), NULL,
                                              j->strain ? j->strain + lo : NULL, NULL);
  return sphi_material_evaluate_quiet(m, j->property, &b, j->out + lo);
}

static int64_t run_end(const law_job *j, int64_t lo, int64_t hi) {
  int64_t end = lo + 1;
  while (end < hi && j->phase[end] == j->phase[lo]) ++end;
  return end;
}

static void law_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  law_job *j = job;
  (void)worker;
  for (int64_t i = lo; i < hi;) {
    int64_t end = run_end(j, i, hi);
    if (run_law(j, i, end)) sphi_lowest(&j->failed, i);
    i = end;
  }
}

/* Arrays and laws that every phase in use needs, before any thread starts. */
static sph_status check_laws(const law_job *j, int64_t n, int required) {
  sph_context *ctx = j->e->rhs->base.ctx;
  for (int64_t i = 0; i < n; i = run_end(j, i, n)) {
    sph_material *m = law_of(j, i);
    if (!m && required)
      return sphi_fail(ctx, SPH_ERR_STATE,
                       "sph_rhs_evaluate: particle %lld has phase %d, which has no material with "
                       "a %s",
                       (long long)i, j->phase[i],
                       j->property == SPHI_MATERIAL_FIRST_PIOLA ? "first Piola-Kirchhoff stress"
                                                                : "stress rate");
    if (!m) continue;
    sph_material_block b = block_of(j, i, i + 1);
    sph_status s = sphi_material_check_block(m, j->property, &b);
    if (s) return s;
  }
  return SPH_OK;
}

static sph_status run_laws(law_job *j, int64_t n) {
  j->failed = INT64_MAX;
  sphi_parallel(j->e->rhs->base.ctx, n, GRAIN, law_range, j);
  if (j->failed == INT64_MAX) return SPH_OK;
  int64_t end = run_end(j, j->failed, n);
  j->status = run_law(j, j->failed, end);
  sph_material_block b = block_of(j, j->failed, end);
  return sphi_material_explain(law_of(j, j->failed), j->property, &b, j->failed,
                               j->status ? j->status : SPH_ERR_CALLBACK);
}

int sphi_rhs_has_pressure_law(const sph_rhs *rhs) {
  int any = 0;
  for (int32_t p = 0; rhs->material_count > 0 && p < SPHI_PHASES; ++p)
    any |= sphi_material_has(rhs->materials[p], SPHI_MATERIAL_PRESSURE);
  return any;
}

sph_status sphi_rhs_pressures(sphi_evaluation *e) {
  law_job j = {.e = e, .property = SPHI_MATERIAL_PRESSURE, .phase = sphi_particles_phases(e->set)};
  if (!sphi_rhs_has_pressure_law(e->rhs) || e->rows == 0) return SPH_OK;
  sph_status s = sph_particles_field(e->set, SPH_FIELD_P, &j.out);
  if (s) return s;
  e->a.p = j.out;
  s = check_laws(&j, e->rows, 0);
  return s ? s : run_laws(&j, e->rows);
}

sph_status sphi_rhs_stress_rates(sphi_evaluation *e) {
  law_job j = {.e = e,
               .property = SPHI_MATERIAL_STRESS_RATE,
               .phase = sphi_particles_phases(e->set),
               .out = sphi_rate_of(e, SPH_FIELD_SIGMA)};
  if (!sphi_term_wanted(e, SPH_TERM_STRESS_RATE)) return SPH_OK;
  /* Beside solids of which the deviator is integrated, a material without rate is a fluid. */
  const int required = !e->rhs->terms[SPH_TERM_SMOOTHED_STRESS].kind;
  sph_status s = check_laws(&j, e->rows, required);
  return s ? s : run_laws(&j, e->rows);
}

sph_status sphi_rhs_first_piola(sphi_evaluation *e) {
  law_job j = {.e = e,
               .property = SPHI_MATERIAL_FIRST_PIOLA,
               .phase = sphi_particles_phases(e->set),
               .out = e->P};
  sph_status s = check_laws(&j, e->a.n, 1);
  return s ? s : run_laws(&j, e->a.n);
}

static sph_status check_energy_call(sph_rhs *rhs, sph_particles *set, const double *energy) {
  sph_status s = sphi_check_handle(NULL, rhs, SPHI_MAGIC_RHS, "rhs");
  if (!s) s = sphi_check_handle(rhs->base.ctx, set, SPHI_MAGIC_PARTICLES, "set");
  if (s) return s;
  if (!energy) return sphi_fail(rhs->base.ctx, SPH_ERR_ARG, "sph_rhs_strain_energy: NULL array");
  if (!sph_particles_field_const(set, SPH_FIELD_F) || !sph_particles_field_const(set, SPH_FIELD_PK))
    return sphi_fail(
        rhs->base.ctx, SPH_ERR_STATE,
        "sph_rhs_strain_energy: no term SPH_TERM_FIRST_PIOLA was evaluated on the set");
  return SPH_OK;
}

sph_status sph_rhs_strain_energy(sph_rhs *rhs, sph_particles *set, double *energy) {
  sph_status s = check_energy_call(rhs, set, energy);
  if (s) return s;
  sphi_evaluation e = {.rhs = rhs, .set = set, .dim = sph_particles_dim(set)};
  s = sph_operands_from_set(set, &e.a);
  if (!s) s = sph_particles_field(set, SPH_FIELD_F, &e.F);
  if (!s) s = sph_particles_field(set, SPH_FIELD_PK, &e.P);
  if (s) return s;
  law_job j = {.e = &e,
               .property = SPHI_MATERIAL_FIRST_PIOLA,
               .phase = sphi_particles_phases(set),
               .out = e.P,
               .energy = energy};
  s = check_laws(&j, e.a.rows, 1);
  return s ? s : run_laws(&j, e.a.rows);
}

/* ---- laws by themselves ------------------------------------------------------------------ */

/* An evaluation of nothing but laws. */
static sph_status begin_laws(sph_rhs *rhs, sph_particles *set, sphi_evaluation *e, law_job *j) {
  sph_status s = sphi_check_handle(NULL, rhs, SPHI_MAGIC_RHS, "rhs");
  if (!s) s = sphi_check_handle(rhs->base.ctx, set, SPHI_MAGIC_PARTICLES, "set");
  if (s) return s;
  *e = (sphi_evaluation){.rhs = rhs, .set = set, .dim = sph_particles_dim(set)};
  *j = (law_job){.e = e, .phase = sphi_particles_phases(set)};
  return sph_operands_from_set(set, &e->a);
}

sph_status sph_rhs_fill(sph_rhs *rhs, sph_particles *set, int32_t field) {
  sphi_evaluation e;
  law_job j;
  sph_status s = begin_laws(rhs, set, &e, &j);
  if (!s && field != SPH_FIELD_P && field != SPH_FIELD_C)
    s = sphi_fail(rhs->base.ctx, SPH_ERR_ARG, "sph_rhs_fill: field %d is neither P nor C",
                  (int)field);
  if (!s) s = sph_particles_field(set, field, &j.out);
  j.property = field == SPH_FIELD_P ? SPHI_MATERIAL_PRESSURE : SPHI_MATERIAL_SOUND_SPEED;
  if (!s) s = check_laws(&j, e.a.rows, 0);
  if (!s) s = run_laws(&j, e.a.rows);
  return s ? s : sph_particles_touch(set, field);
}

static sph_status check_return(const law_job *j, int64_t n) {
  for (int64_t i = 0; i < n; i = run_end(j, i, n)) {
    const sph_material *m = law_of(j, i);
    const uint32_t needs = m ? sphi_material_needs(m, SPHI_MATERIAL_PLASTIC_RETURN) : 0;
    const int across = (needs & SPHI_NEEDS_ACROSS) != 0;
    if (!across && (j->strain || !(needs & SPHI_NEEDS_PLASTIC_STRAIN))) continue;
    return sphi_fail(j->e->rhs->base.ctx, across ? SPH_ERR_UNSUPPORTED : SPH_ERR_ARG,
                     "sph_rhs_plastic_return: the law of phase %d needs %s", (int)j->phase[i],
                     across ? "the stress across" : "the plastic strain");
  }
  return SPH_OK;
}

sph_status sph_rhs_plastic_return(sph_rhs *rhs, sph_particles *set, double *sigma,
                                  double *plastic_strain) {
  sphi_evaluation e;
  law_job j;
  sph_status s = begin_laws(rhs, set, &e, &j);
  if (!s && !sigma)
    s = sphi_fail(rhs->base.ctx, SPH_ERR_ARG, "sph_rhs_plastic_return: sigma is NULL");
  if (s) return s;
  j.property = SPHI_MATERIAL_PLASTIC_RETURN;
  j.out = sigma;
  j.strain = plastic_strain;
  e.a.sigma = sigma;
  s = check_laws(&j, e.a.rows, 0);
  if (!s) s = check_return(&j, e.a.rows);
  return s ? s : run_laws(&j, e.a.rows);
}

static void point_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const sphi_evaluation *e = job;
  const sph_term *terms = e->rhs->terms;
  double *dx = sphi_rate_of(e, SPH_FIELD_X), *dv = sphi_rate_of(e, SPH_FIELD_V);
  const double *xsph = e->rhs->scratch[SPHI_RHS_XSPH].ptr;
  int32_t d = e->dim;
  (void)worker;
  if (dx && terms[SPH_TERM_MOTION].kind)
    for (int64_t k = lo * d; k < hi * d; ++k) dx[k] += e->a.v[k];
  if (dx && terms[SPH_TERM_XSPH].kind)
    for (int64_t k = lo * d; k < hi * d; ++k) dx[k] += terms[SPH_TERM_XSPH].epsilon * xsph[k];
  if (dv && terms[SPH_TERM_BODY_FORCE].kind)
    for (int64_t i = lo; i < hi; ++i)
      for (int32_t c = 0; c < d; ++c) dv[i * d + c] += terms[SPH_TERM_BODY_FORCE].vector[c];
}

void sphi_rhs_pointwise(sphi_evaluation *e) {
  sphi_parallel(e->rhs->base.ctx, e->rows, GRAIN, point_range, e);
}
