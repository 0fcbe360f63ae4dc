/* Stress points (stress_points.h), made of the public operators.
 *
 * Particles and points stand in one set of arrays, particles first, with one neighbour list. Two
 * arrays of masses, one zero on points and one zero on particles, say over which of them a sum
 * runs, so that no pair loop of its own is needed. */
#include "stress_points_impl.h"

#include <math.h>
#include <string.h>

enum { GRAIN = 256 };

typedef struct point_job {
  sph_stress_points *s;
  sph_particles *set;
  const sph_rate *rates;
  int32_t count, dim, comps, fan; /* fan: points a particle */
  int64_t n, real, points;        /* particles, real ones, points */
  const double *x, *v, *m, *rho, *h;
  const int32_t *phases;
  double *ax, *av, *a_rho, *ah, *sigma, *m_particles, *m_points, *L, *dvdt, *matrix;
  sph_operands operands;
  double *rate_offsets, *rate_stresses; /* NULL: not asked for */
  int64_t failed;                       /* lowest run of particles whose law failed */
} point_job;

/* --- gathering ---------------------------------------------------------------------------- */

static void gather_particle(const point_job *j, int64_t i) {
  const int32_t d = j->dim;
  memcpy(j->ax + i * d, j->x + i * d, (size_t)d * sizeof(double));
  memcpy(j->av + i * d, j->v + i * d, (size_t)d * sizeof(double));
  j->a_rho[i] = j->rho[i];
  j->ah[i] = j->h[i];
  j->m_particles[i] = j->m[i];
  j->m_points[i] = 0.0;
  memset(j->sigma + i * j->comps, 0, (size_t)j->comps * sizeof(double));
}

/* The mean stress goes to the particle, the stress of the point to the point. */
static void gather_points(const point_job *j, int64_t i) {
  const int32_t d = j->dim, c = j->comps;
  for (int64_t p = i * j->fan; p < (i + 1) * j->fan; ++p) {
    const int64_t q = j->n + p;
    for (int32_t a = 0; a < d; ++a) {
      j->ax[q * d + a] = j->x[i * d + a] + j->s->offsets[p * d + a];
      j->av[q * d + a] = j->v[i * d + a];
    }
    for (int32_t k = 0; k < c; ++k) {
      j->sigma[q * c + k] = j->s->stresses[p * c + k];
      j->sigma[i * c + k] += j->s->stresses[p * c + k] / j->fan;
    }
    j->a_rho[q] = j->rho[i];
    j->ah[q] = j->h[i];
    j->m_particles[q] = 0.0;
    j->m_points[q] = j->m[i] / j->fan;
  }
}

static void gather_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const point_job *j = job;
  (void)worker;
  for (int64_t i = lo; i < hi; ++i) {
    gather_particle(j, i);
    if (i < j->real) gather_points(j, i);
  }
}

/* --- pointwise ---------------------------------------------------------------------------- */

/* v_p = v_i + L_i d_p; its second part is the rate of d_p. */
static void point_velocities(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const point_job *j = job;
  const int32_t d = j->dim;
  (void)worker;
  for (int64_t p = lo; p < hi; ++p) {
    const double *L = j->L + p / j->fan * d * d, *offset = j->s->offsets + p * d;
    for (int32_t a = 0; a < d; ++a) {
      double rate = 0.0;
      for (int32_t b = 0; b < d; ++b) rate += L[a * d + b] * offset[b];
      j->av[(j->n + p) * d + a] += rate;
      if (j->rate_offsets) j->rate_offsets[p * d + a] = rate;
    }
  }
}

static void particle_rates(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const point_job *j = job;
  const int32_t d = j->dim;
  (void)worker;
  for (int32_t k = 0; k < j->count; ++k) {
    double *out = j->rates[k].values;
    const int32_t field = j->rates[k].field;
    for (int64_t i = lo * d; field == SPH_FIELD_X && i < hi * d; ++i) out[i] = j->v[i];
    for (int64_t i = lo; field == SPH_FIELD_RHO && i < hi; ++i) {
      double trace = 0.0;
      for (int32_t a = 0; a < d; ++a) trace += j->L[(i * d + a) * d + a];
      out[i] = -j->rho[i] * trace;
    }
  }
}

/* --- materials ---------------------------------------------------------------------------- */

static int64_t run_end(const point_job *j, int64_t i, int64_t hi) {
  int64_t end = i + 1;
  while (end < hi && j->phases[end] == j->phases[i]) ++end;
  return end;
}

static sph_material *law_of(const point_job *j, int64_t i) {
  const int32_t phase = j->phases[i];
  return phase >= 0 && phase < SPHI_POINT_PHASES ? j->s->materials[phase] : NULL;
}

/* The points of particles [lo, hi), which are of one phase. */
static sph_material_block block_of(const point_job *j, int64_t lo, int64_t hi) {
  sph_material_block b;
  const int64_t first = lo * j->fan;
  sph_material_block_init(&b);
  b.dim = j->dim;
  b.n = (hi - lo) * j->fan;
  b.velocity_gradient = j->L + (j->n + first) * j->dim * j->dim;
  b.sigma = j->s->stresses + first * j->comps;
  b.rho = j->a_rho + j->n + first;
  return b;
}

static sph_status run_law(const point_job *j, int64_t lo, int64_t hi) {
  const sph_material_block b = block_of(j, lo, hi);
  return sphi_material_stress_rate_quiet(law_of(j, lo), &b,
                                         j->rate_stresses + lo * j->fan * j->comps);
}

static void law_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  point_job *j = job;
  (void)worker;
  for (int64_t i = lo, end; i < hi; i = end) {
    end = run_end(j, i, hi);
    if (run_law(j, i, end)) sphi_lowest(&j->failed, i);
  }
}

static sph_status check_laws(const point_job *j) {
  for (int64_t i = 0; i < j->real; i = run_end(j, i, j->real)) {
    sph_material *law = law_of(j, i);
    const sph_material_block b = block_of(j, i, i + 1);
    if (!sphi_material_has(law, SPHI_MATERIAL_STRESS_RATE))
      return sphi_fail(j->s->base.ctx, SPH_ERR_STATE,
                       "stress points: particle %lld has phase %d, which has no material with a "
                       "stress rate",
                       (long long)i, j->phases[i]);
    sph_status s = sphi_material_check_block(law, SPHI_MATERIAL_STRESS_RATE, &b);
    if (s) return s;
  }
  return SPH_OK;
}

static sph_status stress_rates(point_job *j) {
  if (!j->rate_stresses) return SPH_OK;
  sph_status s = check_laws(j);
  if (s) return s;
  j->failed = INT64_MAX;
  sphi_parallel(j->s->base.ctx, j->real, GRAIN, law_range, j);
  if (j->failed == INT64_MAX) return SPH_OK;
  s = run_law(j, j->failed, run_end(j, j->failed, j->real));
  return sphi_material_fail(law_of(j, j->failed), SPHI_MATERIAL_STRESS_RATE,
                            s ? s : SPH_ERR_CALLBACK);
}

/* --- sums --------------------------------------------------------------------------------- */

/* Sums over particles or over points, for all rows or for those of the real particles. */
static sph_status sum_over(point_job *j, const double *masses, int64_t rows) {
  sph_operands *a = &j->operands;
  a->m = masses;
  a->rows = rows;
  a->gradient_matrix = NULL;
  if (!j->s->options.corrected) return SPH_OK;
  sph_status s = sph_gradient_matrix(j->s->list, j->s->kernel, a, j->matrix, NULL, NULL);
  a->gradient_matrix = j->matrix;
  return s;
}

static sph_status sums_over_particles(point_job *j) {
  sph_operands *a = &j->operands;
  const int64_t all = j->n + j->points;
  sph_status s = sum_over(j, j->m_particles, all);
  a->rows = j->n;
  if (!s) s = sph_velocity_gradient(j->s->list, j->s->kernel, a, j->L);
  if (s) return s;
  sphi_parallel(j->s->base.ctx, j->points, GRAIN, point_velocities, j);
  a->rows = all;
  return sph_velocity_gradient(j->s->list, j->s->kernel, a, j->L);
}

static double *rate_of(const point_job *j, int32_t field) {
  for (int32_t k = 0; k < j->count; ++k)
    if (j->rates[k].field == field) return j->rates[k].values;
  return NULL;
}

static sph_status sums_over_points(point_job *j) {
  double *dvdt = rate_of(j, SPH_FIELD_V);
  if (!dvdt) return SPH_OK;
  sph_status s = sum_over(j, j->m_points, j->real);
  if (s) return s;
  return sph_stress_divergence(j->s->list, j->s->kernel, &j->operands, j->s->options.form, dvdt);
}

/* --- one evaluation ------------------------------------------------------------------------ */

static sph_status need(const point_job *j, const void *array, const char *name) {
  if (array) return SPH_OK;
  return sphi_fail(j->s->base.ctx, SPH_ERR_ARG, "stress points: the set has no field %s", name);
}

static sph_status read_set(point_job *j) {
  j->x = sph_particles_field_const(j->set, SPH_FIELD_X);
  j->v = sph_particles_field_const(j->set, SPH_FIELD_V);
  j->m = sph_particles_field_const(j->set, SPH_FIELD_M);
  j->rho = sph_particles_field_const(j->set, SPH_FIELD_RHO);
  j->h = sph_particles_field_const(j->set, SPH_FIELD_H);
  j->phases = sphi_particles_phases(j->set);
  j->n = sph_particles_count(j->set);
  sph_status s = need(j, j->v, "v");
  if (!s) s = need(j, j->m, "m");
  if (!s) s = need(j, j->rho, "rho");
  return s ? s : need(j, j->h, "h");
}

static sph_status read_rates(point_job *j) {
  double **const arrays[2] = {&j->rate_offsets, &j->rate_stresses};
  int32_t found = 0;
  for (int32_t k = 0; k < j->count; ++k) {
    const int32_t f = j->rates[k].field;
    const int known = f == SPH_FIELD_X || f == SPH_FIELD_V || f == SPH_FIELD_RHO;
    if (!j->rates[k].values || (f >= 0 && !known) || (f < 0 && found == 2))
      return sphi_fail(j->s->base.ctx, SPH_ERR_ARG,
                       "stress points: there is no rate of field %d, or its array is NULL", f);
    if (f < 0) *arrays[found++] = j->rates[k].values;
  }
  return SPH_OK;
}

/* Cut the scratch into the arrays of particles and points. */
static sph_status cut_scratch(point_job *j) {
  const int64_t all = j->n + j->points, d = j->dim;
  const int64_t sizes[] = {all * d, all * d, all,         all,        all * j->comps,
                           all,     all,     all * d * d, all * d * d};
  double **const arrays[] = {&j->ax,          &j->av,       &j->a_rho, &j->ah,    &j->sigma,
                             &j->m_particles, &j->m_points, &j->L,     &j->matrix};
  enum { ARRAYS = sizeof sizes / sizeof *sizes };
  size_t total = 0;
  for (int k = 0; k < ARRAYS; ++k) total += (size_t)sizes[k];
  sph_status s = sphi_buffer_reserve(j->s->base.ctx, &j->s->scratch, sphi_mul(total, 8));
  double *at = j->s->scratch.ptr;
  for (int k = 0; !s && k < ARRAYS; at += sizes[k++]) *arrays[k] = at;
  return s;
}

static void set_operands(point_job *j) {
  sph_operands *a = &j->operands;
  sph_operands_init(a);
  a->dim = j->dim;
  a->n = j->n + j->points;
  a->x = j->ax;
  a->v = j->av;
  a->rho = j->a_rho;
  a->h = j->ah;
  a->sigma = j->sigma;
}

static int32_t run_hook(const point_job *j, sph_rhs_hook hook, void *user, double t) {
  return hook ? hook(user, t, j->set, j->rates, j->count) : 0;
}

static sph_status check_points(const point_job *j) {
  if (j->dim == j->s->kernel->dim && j->points == j->real * j->fan && j->s->dim == j->dim)
    return SPH_OK;
  return sphi_fail(j->s->base.ctx, SPH_ERR_STATE,
                   "stress points: %lld points in %d-D do not belong to %lld particles in %d-D",
                   (long long)j->points, j->s->dim, (long long)j->real, j->dim);
}

static point_job make_job(sph_stress_points *s, sph_particles *set) {
  point_job j = {.s = s, .set = set, .dim = sph_particles_dim(set)};
  j.comps = sph_sym_components(j.dim);
  j.fan = 1 << j.dim;
  j.real = sph_particles_real_count(set);
  j.points = s->count;
  return j;
}

static sph_status evaluate(point_job *j) {
  sph_context *ctx = j->s->base.ctx;
  sph_status s = read_set(j);
  if (!s) s = read_rates(j);
  if (!s) s = cut_scratch(j);
  if (s) return s;
  sphi_parallel(ctx, j->n, GRAIN, gather_range, j);
  set_operands(j);
  s = sph_neighbors_update_arrays(j->s->list, j->dim, j->operands.n, j->ax, j->ah, 0.0, NULL);
  if (!s) s = sums_over_particles(j);
  if (!s) s = stress_rates(j);
  if (!s) s = sums_over_points(j);
  if (!s) sphi_parallel(ctx, j->real, GRAIN, particle_rates, j);
  return s;
}

int32_t sph_stress_points_rates(void *points, double t, sph_particles *set, const sph_rate *rates,
                                int32_t count) {
  sph_stress_points *p = points;
  sph_status s = sphi_check_handle(NULL, p, SPHI_MAGIC_STRESS_POINTS, "points");
  if (!s) s = sphi_check_handle(p->base.ctx, set, SPHI_MAGIC_PARTICLES, "set");
  if (s) return s;
  if (count < 0 || (count > 0 && !rates))
    return sphi_fail(p->base.ctx, SPH_ERR_ARG, "stress points: %d rates, array %s", count,
                     rates ? "given" : "NULL");
  point_job j = make_job(p, set);
  j.rates = rates;
  j.count = count;
  s = check_points(&j);
  if (!s) s = run_hook(&j, p->options.prepare, p->options.prepare_user, t);
  if (!s) s = evaluate(&j);
  return s ? s : run_hook(&j, p->options.finish, p->options.finish_user, t);
}

/* --- for output ----------------------------------------------------------------------------- */

static void average(const point_job *j, double *sigma) {
  const int32_t c = j->comps;
  for (int64_t k = 0; k < j->real * c; ++k) {
    const double *first = j->s->stresses + k / c * j->fan * c + k % c;
    sigma[k] = 0.0;
    for (int32_t p = 0; p < j->fan; ++p) sigma[k] += first[p * c] / j->fan;
  }
}

sph_status sph_stress_points_average(sph_stress_points *points, sph_particles *set) {
  double *sigma;
  sph_status s = sphi_check_handle(NULL, points, SPHI_MAGIC_STRESS_POINTS, "points");
  if (!s) s = sphi_check_handle(points->base.ctx, set, SPHI_MAGIC_PARTICLES, "set");
  if (s) return s;
  const point_job j = make_job(points, set);
  s = check_points(&j);
  if (!s) s = sph_particles_field(set, SPH_FIELD_SIGMA, &sigma);
  if (s) return s;
  average(&j, sigma);
  return sph_particles_touch(set, SPH_FIELD_SIGMA);
}
