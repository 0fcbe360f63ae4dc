/* Step control: error norm, the step that the error suggests, the CFL step. */
#include "integrate_impl.h"

#include "../particles/particles_impl.h"

#include <math.h>

/* ---- error norm -------------------------------------------------------------------------- */

/* Maximum norms, item by item: entries that pass through zero do not stop the run, and fields of
 * different units do not mix. */
double sphi_error_norm(sph_integrator *it, const double *error) {
  double largest = 0.0;
  for (int32_t k = 0; k < it->items; ++k) {
    double size =
        fmax(sphi_state_max(it, k, NULL), sphi_state_max(it, k, sphi_vector(it, SPHI_VEC_START)));
    double e = sphi_state_max(it, k, error);
    double tolerance = it->options.atol + it->options.rtol * size;
    double ratio = e == 0.0 ? 0.0 : e / tolerance; /* 0 / 0 where atol = 0 and y = 0 */
    if (!(ratio <= largest)) largest = ratio;
  }
  return largest;
}

double sphi_suggest(double dt, double error, int32_t order) {
  double factor = 0.8 * pow(error, -1.0 / (order + 1.0)); /* error 0 gives infinity */
  if (!(factor >= 0.1)) factor = 0.1;
  return dt * (factor < 5.0 ? factor : 5.0);
}

/* ---- CFL step ---------------------------------------------------------------------------- */

typedef struct cfl_job {
  int64_t n;
  int32_t dim;
  const double *h, *c, *v;
  double least[SPHI_REDUCE_CHUNKS];
  int64_t bad;
} cfl_job;

static double speed(const cfl_job *job, int64_t i) {
  double square = 0.0;
  for (int32_t a = 0; job->v && a < job->dim; ++a) {
    double v = job->v[i * job->dim + a];
    square += v * v;
  }
  return (job->c ? job->c[i] : 0.0) + sqrt(square);
}

static double least_time(cfl_job *job, int64_t begin, int64_t end) {
  double least = INFINITY;
  for (int64_t i = begin; i < end; ++i) {
    double h = job->h[i], s = speed(job, i);
    if (!isfinite(h) || h <= 0.0 || !isfinite(s) || s < 0.0) {
      sphi_lowest(&job->bad, i);
      return least;
    }
    if (s > 0.0 && h / s < least) least = h / s;
  }
  return least;
}

static void cfl_chunks(void *job, int64_t begin, int64_t end, int32_t worker) {
  cfl_job *c = job;
  int64_t size = (c->n + SPHI_REDUCE_CHUNKS - 1) / SPHI_REDUCE_CHUNKS;
  (void)worker;
  for (int64_t chunk = begin; chunk < end; ++chunk) {
    int64_t from = chunk * size, to = from + size < c->n ? from + size : c->n;
    c->least[chunk] = from < to ? least_time(c, from, to) : INFINITY;
  }
}

static sph_status finish_cfl(sph_context *ctx, const cfl_job *job, double cfl, double *dt) {
  double least = INFINITY;
  if (job->bad != INT64_MAX)
    return sphi_fail(ctx, SPH_ERR_NUMERIC, "particle %lld has h = %g and speed c + |v| = %g",
                     (long long)job->bad, job->h[job->bad], speed(job, job->bad));
  for (int32_t chunk = 0; chunk < SPHI_REDUCE_CHUNKS; ++chunk)
    least = fmin(least, job->least[chunk]);
  double step = cfl * least;
  if (!isfinite(step))
    return sphi_fail(ctx, SPH_ERR_NUMERIC, "no particle moves or carries sound: no finite step");
  *dt = step;
  return SPH_OK;
}

static void run_cfl(sph_context *ctx, cfl_job *job) {
  int64_t grain = job->n < SPHI_STATE_GRAIN ? SPHI_REDUCE_CHUNKS : 1;
  sphi_parallel(ctx, SPHI_REDUCE_CHUNKS, grain, cfl_chunks, job);
}

sph_status sph_cfl_step(const sph_particles *set, double cfl, double *dt) {
  sph_status status = sphi_check_handle(NULL, set, SPHI_MAGIC_PARTICLES, "set");
  if (status != SPH_OK) return status;
  sph_context *ctx = sphi_particles_context(set);
  if (!dt) return sphi_fail(ctx, SPH_ERR_ARG, "dt is NULL");
  if (!isfinite(cfl) || cfl <= 0.0)
    return sphi_fail(ctx, SPH_ERR_ARG, "cfl = %g must be finite and > 0", cfl);
  const double *h = sph_particles_field_const(set, SPH_FIELD_H);
  if (!h) return sphi_fail(ctx, SPH_ERR_ARG, "the set has no field \"h\"");
  cfl_job job = {.n = sph_particles_real_count(set),
                 .dim = sph_particles_dim(set),
                 .h = h,
                 .c = sph_particles_field_const(set, SPH_FIELD_C),
                 .v = sph_particles_field_const(set, SPH_FIELD_V),
                 .bad = INT64_MAX};
  run_cfl(ctx, &job);
  return finish_cfl(ctx, &job, cfl, dt);
}
