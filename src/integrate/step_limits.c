/* Steps that a state allows: by sound and motion, by signals between neighbours, by the change of
 * density. Each is the least of a time of every particle. */
#include "integrate_impl.h"

#include "../neighbors/neighbors_impl.h"
#include "../particles/particles_impl.h"

#include <sph/adapt.h>

#include <math.h>

/* ---- the least of all -------------------------------------------------------------------- */

/* Time of one particle, a length over a speed; infinity where it sets no limit, NaN where its
 * values make no sense. */
typedef double (*time_fn)(const void *values, int64_t i);

typedef struct least_job {
  time_fn time;
  const void *values;
  int64_t n;
  double least[SPHI_REDUCE_CHUNKS];
  int64_t bad; /* lowest particle without sense */
} least_job;

static double least_of(least_job *job, int64_t begin, int64_t end) {
  double least = INFINITY;
  for (int64_t i = begin; i < end; ++i) {
    const double time = job->time(job->values, i);
    if (isnan(time)) {
      sphi_lowest(&job->bad, i);
      return least;
    }
    least = fmin(least, time);
  }
  return least;
}

static void least_chunks(void *job, int64_t begin, int64_t end, int32_t worker) {
  least_job *l = job;
  const int64_t size = (l->n + SPHI_REDUCE_CHUNKS - 1) / SPHI_REDUCE_CHUNKS;
  (void)worker;
  for (int64_t chunk = begin; chunk < end; ++chunk) {
    const int64_t from = chunk * size, to = from + size < l->n ? from + size : l->n;
    l->least[chunk] = from < to ? least_of(l, from, to) : INFINITY;
  }
}

/* Least time over [0, n); *bad is INT64_MAX, or the first particle without sense. */
static double least_time(sph_context *ctx, int64_t n, time_fn time, const void *values,
                         int64_t *bad) {
  least_job job = {.time = time, .values = values, .n = n, .bad = INT64_MAX};
  const int64_t grain = n < SPHI_STATE_GRAIN ? SPHI_REDUCE_CHUNKS : 1;
  double least = INFINITY;
  sphi_parallel(ctx, SPHI_REDUCE_CHUNKS, grain, least_chunks, &job);
  for (int32_t chunk = 0; chunk < SPHI_REDUCE_CHUNKS; ++chunk)
    least = fmin(least, job.least[chunk]);
  *bad = job.bad;
  return least;
}

/* factor * least, which must be a step. */
static sph_status finish(sph_context *ctx, const char *name, double factor, double least,
                         double *dt) {
  const double step = factor * least;
  if (!isfinite(step))
    return sphi_fail(ctx, SPH_ERR_NUMERIC, "%s: no particle moves or carries sound: no finite step",
                     name);
  if (!(step > 0.0))
    return sphi_fail(ctx, SPH_ERR_NUMERIC, "%s: %g times the least h / speed = %g is no step", name,
                     factor, least);
  *dt = step;
  return SPH_OK;
}

static sph_status check_factor(sph_context *ctx, const char *name, const char *what,
                               double factor) {
  if (isfinite(factor) && factor > 0.0) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_ARG, "%s: %s = %g must be finite and > 0", name, what, factor);
}

/* NaN unless h is positive and finite, s finite and >= 0. */
static double time_of(double h, double s) {
  if (!isfinite(h) || h <= 0.0 || !isfinite(s) || s < 0.0) return NAN;
  return s > 0.0 ? h / s : INFINITY;
}

/* ---- sound and motion -------------------------------------------------------------------- */

typedef struct cfl_values {
  int32_t dim;
  const double *h, *c, *v;
} cfl_values;

static double cfl_speed(const cfl_values *f, int64_t i) {
  double square = 0.0;
  for (int32_t a = 0; f->v && a < f->dim; ++a) {
    const double v = f->v[i * f->dim + a];
    square += v * v;
  }
  return (f->c ? f->c[i] : 0.0) + sqrt(square);
}

static double cfl_time(const void *values, int64_t i) {
  const cfl_values *f = values;
  return time_of(f->h[i], cfl_speed(f, i));
}

sph_status sph_cfl_step(const sph_particles *set, double cfl, double *dt) {
  sph_status status = sphi_check_handle(NULL, set, SPHI_MAGIC_PARTICLES, "set");
  if (status != SPH_OK) return status;
  sph_context *ctx = sphi_particles_context(set);
  if (!dt) return sphi_fail(ctx, SPH_ERR_ARG, "dt is NULL");
  status = check_factor(ctx, "sph_cfl_step", "cfl", cfl);
  if (status != SPH_OK) return status;
  const double *h = sph_particles_field_const(set, SPH_FIELD_H);
  if (!h) return sphi_fail(ctx, SPH_ERR_ARG, "the set has no field \"h\"");
  const cfl_values values = {sph_particles_dim(set), h, sph_particles_field_const(set, SPH_FIELD_C),
                             sph_particles_field_const(set, SPH_FIELD_V)};
  int64_t bad;
  const double least = least_time(ctx, sph_particles_real_count(set), cfl_time, &values, &bad);
  if (bad != INT64_MAX)
    return sphi_fail(ctx, SPH_ERR_NUMERIC, "particle %lld has h = %g and speed c + |v| = %g",
                     (long long)bad, h[bad], cfl_speed(&values, bad));
  return finish(ctx, "sph_cfl_step", cfl, least, dt);
}

/* ---- signals between neighbours ---------------------------------------------------------- */

typedef struct signal_job {
  const sph_neighbors *list;
  sph_operands a;
  double *speed;  /* rows */
  double *packed; /* n * 2 * dim: x, v of a particle, in the order of the list */
} signal_job;

static double h_of(const sph_operands *a, int64_t i) { return a->h ? a->h[i] : a->h0; }

static void pack_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  const signal_job *s = job;
  const sph_operands *a = &s->a;
  (void)worker;
  for (int64_t k = begin; k < end; ++k) {
    const int64_t from = (int64_t)s->list->order[k] * a->dim;
    double *to = s->packed + 2 * a->dim * k;
    for (int32_t d = 0; d < a->dim; ++d) {
      to[d] = a->x[from + d];
      to[a->dim + d] = a->v[from + d];
    }
  }
}

/* Only a skin lets pairs beyond the cutoff into a row. */
static int beyond(const signal_job *job, int64_t k, int64_t l, double r2) {
  const sph_neighbors *list = job->list;
  if (list->options.method != SPH_NEIGHBORS_VERLET) return 0;
  const double cut =
      list->options.support * sph_pair_h(list->options.h_rule, h_of(&job->a, list->order[k]),
                                         h_of(&job->a, list->order[l]));
  return r2 >= cut * cut;
}

/* Largest |v_ij . r_ij| of a row; NaN when one is not finite. Products are compared, so that a pair
 * that sets no new mark costs no division; coincident particles, which have no direction, do not.
 */
static inline double fastest(const signal_job *job, int64_t k, int32_t dim) {
  const sph_neighbors *list = job->list;
  const double *own = job->packed + 2 * dim * k;
  double most = 0.0;
  for (int64_t p = list->start[k]; p < list->start[k + 1]; ++p) {
    const double *other = job->packed + 2 * dim * (int64_t)list->pair[p];
    double r2 = 0.0, dot = 0.0;
    for (int32_t d = 0; d < dim; ++d) {
      double x = own[d] - other[d];
      if (list->period[d] > 0.0) x -= list->period[d] * nearbyint(x / list->period[d]);
      r2 += x * x;
      dot += x * (own[dim + d] - other[dim + d]);
    }
    if (dot * dot <= most * r2 || beyond(job, k, list->pair[p], r2)) continue;
    most = dot * dot / r2;
    if (!isfinite(most)) return NAN;
  }
  return sqrt(most);
}

static double fastest_of(const signal_job *job, int64_t k) {
  return job->a.dim == 1   ? fastest(job, k, 1)
         : job->a.dim == 2 ? fastest(job, k, 2)
                           : fastest(job, k, 3);
}

static void signal_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  const signal_job *s = job;
  (void)worker;
  for (int64_t k = begin; k < end; ++k) {
    const int64_t i = s->list->order[k];
    if (i < s->a.rows) s->speed[i] = (s->a.c ? s->a.c[i] : s->a.c0) + fastest_of(s, k);
  }
}

static double signal_time(const void *values, int64_t i) {
  const signal_job *s = values;
  return time_of(h_of(&s->a, i), s->speed[i]);
}

/* A velocity that is not finite would spread to the neighbours, and one of them be named. */
static double velocity_time(const void *values, int64_t i) {
  const sph_operands *a = values;
  for (int32_t k = 0; k < a->dim; ++k)
    if (!isfinite(a->v[i * a->dim + k])) return NAN;
  return INFINITY;
}

static sph_status check_velocities(sph_context *ctx, const sph_operands *a) {
  int64_t bad;
  (void)least_time(ctx, a->n, velocity_time, a, &bad);
  if (bad == INT64_MAX) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_NUMERIC,
                   "sph_signal_step: the velocity of particle %lld is not finite", (long long)bad);
}

static sph_status check_operands(const sph_neighbors *list, sph_operands *a, const char *name) {
  sph_context *ctx = list->base.ctx;
  sph_status status = sphi_neighbors_check(list, a->dim, a->n);
  if (status != SPH_OK) return status;
  if (a->rows < -1 || a->rows > a->n)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: n = %lld, rows = %lld", name, (long long)a->n,
                     (long long)a->rows);
  if (a->rows == -1) a->rows = a->n;
  if (a->n > 0 && (!a->x || !a->v))
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: %s is NULL", name, a->x ? "v" : "x");
  status = a->n > 0 ? sphi_neighbors_fresh(list, a->x, a->h, a->h0) : SPH_OK;
  return status == SPH_OK ? check_velocities(ctx, a) : status;
}

enum { SIGNAL_GRAIN = 256, SCRATCH_RECORDS = 0 /* of the list, as in every loop over pairs */ };

static sph_status run_signals(signal_job *job, double factor, double *dt) {
  sph_context *ctx = job->list->base.ctx;
  int64_t bad;
  sphi_parallel(ctx, job->a.n, SPHI_STATE_GRAIN, pack_range, job);
  sphi_parallel(ctx, job->a.n, SIGNAL_GRAIN, signal_range, job);
  const double least = least_time(ctx, job->a.rows, signal_time, job, &bad);
  if (bad != INT64_MAX)
    return sphi_fail(ctx, SPH_ERR_NUMERIC,
                     "sph_signal_step: particle %lld has h = %g and speed c + max |v_ij . r_ij| = "
                     "%g",
                     (long long)bad, h_of(&job->a, bad), job->speed[bad]);
  return finish(ctx, "sph_signal_step", factor, least, dt);
}

sph_status sph_signal_step(sph_neighbors *list, const sph_operands *a, double courant, double *dt) {
  sph_status status = sphi_check_handle(NULL, list, SPHI_MAGIC_NEIGHBORS, "list");
  if (status != SPH_OK) return status;
  sph_context *ctx = list->base.ctx;
  signal_job job = {.list = list};
  if (!a || !dt) return sphi_fail(ctx, SPH_ERR_ARG, "sph_signal_step: %s is NULL", a ? "dt" : "a");
  sph_operands_init(&job.a);
  status = sphi_options_read(ctx, &job.a, sizeof job.a, a);
  if (status == SPH_OK) status = check_factor(ctx, "sph_signal_step", "courant", courant);
  if (status == SPH_OK) status = check_operands(list, &job.a, "sph_signal_step");
  if (status != SPH_OK) return status;
  const size_t packed = sphi_mul((size_t)job.a.n, 2 * (size_t)job.a.dim);
  const size_t bytes = sphi_mul(packed + (size_t)job.a.rows, sizeof(double));
  status = sphi_buffer_reserve(ctx, &list->scratch[SCRATCH_RECORDS], bytes);
  if (status != SPH_OK) return status;
  job.packed = list->scratch[SCRATCH_RECORDS].ptr;
  job.speed = job.packed + packed;
  return run_signals(&job, courant, dt);
}

/* ---- change of density ------------------------------------------------------------------- */

typedef struct density_values {
  const double *rho, *drho;
} density_values;

static double density_time(const void *values, int64_t i) {
  const density_values *f = values;
  return time_of(f->rho[i], fabs(f->drho[i]));
}

sph_status sph_density_step(sph_context *ctx, int64_t n, double limit, const double *rho,
                            const double *drho, double *dt) {
  sph_status status = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (status != SPH_OK) return status;
  if (!dt || n < 0 || (n > 0 && (!rho || !drho)))
    return sphi_fail(ctx, SPH_ERR_ARG, "sph_density_step: n = %lld, %s", (long long)n,
                     n < 0 ? "negative" : "an array or dt is NULL");
  status = check_factor(ctx, "sph_density_step", "limit", limit);
  if (status != SPH_OK) return status;
  const density_values values = {rho, drho};
  int64_t bad;
  const double least = least_time(ctx, n, density_time, &values, &bad);
  if (bad != INT64_MAX)
    return sphi_fail(ctx, SPH_ERR_NUMERIC,
                     "sph_density_step: particle %lld has rho = %g and d rho/dt = %g",
                     (long long)bad, rho[bad], drho[bad]);
  if (isinf(least)) {
    *dt = INFINITY;
    return SPH_OK;
  }
  return finish(ctx, "sph_density_step", limit, least, dt);
}
