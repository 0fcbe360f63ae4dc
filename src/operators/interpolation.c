/* Interpolation at the particles and at arbitrary points. */
#include "operators_impl.h"

#include <math.h>
#include <string.h>

static sph_status check_field(sph_context *ctx, int32_t components, const double *f,
                              const char *name) {
  if (components < 1) return sphi_fail(ctx, SPH_ERR_ARG, "%s: %d components", name, components);
  return f ? SPH_OK : sphi_fail(ctx, SPH_ERR_ARG, "%s: f is NULL", name);
}

enum { SCRATCH_SHEPARD = 2 };

enum { DIVIDE_GRAIN = 4096 };

typedef struct divide_job {
  double *out;
  const double *by;
  int32_t components;
} divide_job;

static void divide_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const divide_job *j = job;
  (void)worker;
  for (int64_t i = lo; i < hi; ++i)
    for (int32_t c = 0; c < j->components; ++c) j->out[i * j->components + c] /= j->by[i];
}

static sph_status shepard_divide(sph_neighbors *list, const sph_kernel *kernel,
                                 const sph_operands *own, int32_t components, double *out) {
  sphi_sweep sweep = sphi_sweep_of(kernel, own, SPHI_SHEPARD);
  sweep.shepard = list->scratch[SCRATCH_SHEPARD].ptr;
  sph_status s = sphi_sweep_run(list, &sweep);
  divide_job job = {out, sweep.shepard, components};
  if (!s) sphi_parallel(list->base.ctx, own->rows, DIVIDE_GRAIN, divide_range, &job);
  return s;
}

sph_status sph_interpolate(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *a,
                           int32_t shepard, int32_t components, const double *f, double *out) {
  sph_operands own;
  sph_status s = sphi_operator_begin(list, kernel, a, SPHI_NEED_M | SPHI_NEED_RHO, out,
                                     "sph_interpolate", &own);
  if (!s) s = check_field(list->base.ctx, components, f, "sph_interpolate");
  if (!s && shepard) /* before anything is written */
    s = sphi_buffer_reserve(list->base.ctx, &list->scratch[SCRATCH_SHEPARD],
                            sphi_mul((size_t)own.n, sizeof(double)));
  if (s) return s;
  sphi_sweep sweep = sphi_sweep_of(kernel, &own, SPHI_INTERP);
  sweep.f_stride = sweep.interp_stride = components;
  for (int32_t c = 0; !s && c < components; c += SPHI_FIELD_WIDTH) {
    sweep.f = f + c;
    sweep.f_count = components - c < SPHI_FIELD_WIDTH ? components - c : SPHI_FIELD_WIDTH;
    sweep.interp = out + c;
    s = sphi_sweep_run(list, &sweep);
  }
  return s || !shepard ? s : shepard_divide(list, kernel, &own, components, out);
}

/* One job for all points; each worker has its own room for the neighbours of a point. */
typedef struct points_job {
  const sph_neighbors *list;
  const sph_kernel *kernel;
  const sph_operands *a;
  int32_t shepard, components;
  const double *points, *f;
  double *out;
  int32_t *near;
  int64_t room;
} points_job;

static double distance_to(const points_job *j, const double *point, int64_t i) {
  double r2 = 0.0;
  for (int32_t c = 0; c < j->a->dim; ++c) {
    double d = point[c] - j->a->x[i * j->a->dim + c], box = j->list->period[c];
    if (box > 0.0) d -= box * nearbyint(d / box);
    r2 += d * d;
  }
  return sqrt(r2);
}

static void interpolate_point(const points_job *j, const double *point, const int32_t *near,
                              int64_t found, double *out) {
  double sum = 0.0;
  for (int32_t c = 0; c < j->components; ++c) out[c] = 0.0;
  for (int64_t k = 0; k < found; ++k) {
    int64_t i = near[k];
    double h = j->a->h ? j->a->h[i] : j->a->h0;
    double m = j->a->m ? j->a->m[i] : j->a->m0, rho = j->a->rho ? j->a->rho[i] : j->a->rho0;
    double w = m / rho * sph_kernel_w(j->kernel, distance_to(j, point, i), h);
    sum += w;
    for (int32_t c = 0; c < j->components; ++c) out[c] += w * j->f[i * j->components + c];
  }
  if (j->shepard && sum != 0.0)
    for (int32_t c = 0; c < j->components; ++c) out[c] /= sum;
}

/* The list finds points among the positions it was built from. */
static double reach_of(const points_job *j) {
  return j->kernel->support * j->list->h_max + j->list->options.skin;
}

static void interpolate_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const points_job *j = job;
  int32_t *near = j->near + worker * j->room;
  double radius = reach_of(j);
  for (int64_t p = lo; p < hi; ++p) {
    const double *point = j->points + p * j->a->dim;
    int64_t found = sphi_neighbors_near(j->list, point, radius, j->room, near);
    interpolate_point(j, point, near, found, j->out + p * j->components);
  }
}

/* Room for the fullest neighbourhood, found by counting first. */
typedef struct count_job {
  const points_job *points;
  int64_t *most;
} count_job;

static void count_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const count_job *c = job;
  const points_job *j = c->points;
  double radius = reach_of(j);
  for (int64_t p = lo; p < hi; ++p) {
    int64_t found = sphi_neighbors_near(j->list, j->points + p * j->a->dim, radius, 0, NULL);
    if (found > c->most[worker]) c->most[worker] = found;
  }
}

static sph_status check_points(sph_context *ctx, int64_t np, int32_t dim, const double *points) {
  if (np < 0) return sphi_fail(ctx, SPH_ERR_ARG, "sph_interpolate_at: %lld points", (long long)np);
  if (np > 0 && !points) return sphi_fail(ctx, SPH_ERR_ARG, "sph_interpolate_at: points is NULL");
  for (int64_t k = 0; k < np * dim; ++k)
    if (!isfinite(points[k]))
      return sphi_fail(ctx, SPH_ERR_ARG, "sph_interpolate_at: point %lld is at %g",
                       (long long)(k / dim), points[k]);
  return SPH_OK;
}

static sph_status run_points(sph_neighbors *list, points_job *job, int64_t np) {
  enum { GRAIN = 64, SCRATCH_COUNTS = 1, SCRATCH_NEAR = 3 };
  sph_context *ctx = list->base.ctx;
  int32_t workers = sphi_workers(ctx);
  size_t count_bytes = sphi_mul((size_t)workers, sizeof(int64_t));
  sphi_buffer *counts = &list->scratch[SCRATCH_COUNTS], *near = &list->scratch[SCRATCH_NEAR];
  sph_status s = sphi_buffer_reserve(ctx, counts, count_bytes);
  if (s) return s;
  count_job count = {job, counts->ptr};
  memset(count.most, 0, count_bytes);
  sphi_parallel(ctx, np, GRAIN, count_range, &count);
  job->room = 1;
  for (int32_t w = 0; w < workers; ++w)
    if (count.most[w] > job->room) job->room = count.most[w];
  size_t bytes = sphi_mul(sphi_mul((size_t)workers, (size_t)job->room), sizeof(int32_t));
  s = sphi_buffer_reserve(ctx, near, bytes);
  if (s) return s;
  job->near = near->ptr;
  sphi_parallel(ctx, np, GRAIN, interpolate_range, job);
  return SPH_OK;
}

sph_status sph_interpolate_at(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *a,
                              int32_t shepard, int64_t np, const double *points, int32_t components,
                              const double *f, double *out) {
  sph_operands own;
  sph_status s = sphi_operator_begin(list, kernel, a, SPHI_NEED_M | SPHI_NEED_RHO, out,
                                     "sph_interpolate_at", &own);
  if (!s) s = check_field(list->base.ctx, components, f, "sph_interpolate_at");
  if (!s) s = check_points(list->base.ctx, np, own.dim, points);
  if (s || np == 0) return s;
  points_job job = {list, kernel, &own, shepard, components, points, f, out, NULL, 0};
  return run_points(list, &job, np);
}
