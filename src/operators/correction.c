/* Shepard sums and the kernel-gradient matrix. */
#include "../sweep/invert.h"
#include "operators_impl.h"

#include <string.h>

sph_status sph_shepard_sum(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *a,
                           double *sum) {
  sph_operands own;
  sph_status s = sphi_operator_begin(list, kernel, a, SPHI_NEED_M | SPHI_NEED_RHO, sum,
                                     "sph_shepard_sum", &own);
  if (s) return s;
  sphi_sweep sweep = sphi_sweep_of(kernel, &own, SPHI_SHEPARD);
  sweep.shepard = sum;
  return sphi_sweep_run(list, &sweep);
}

typedef struct invert_job {
  int32_t dim;
  double *b;
  int64_t *fallbacks; /* one counter a worker */
} invert_job;

static void invert_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const invert_job *j = job;
  int32_t dd = j->dim * j->dim;
  double m[9];
  for (int64_t i = lo; i < hi; ++i) {
    memcpy(m, j->b + i * dd, (size_t)dd * sizeof *m);
    j->fallbacks[worker] += sphi_invert_gradient_matrix(j->dim, m, j->b + i * dd);
  }
}

enum { SCRATCH_COUNTS = 2, INVERT_GRAIN = 4096 };

static sph_status reserve_counts(sph_neighbors *list) {
  size_t bytes = sphi_mul((size_t)sphi_workers(list->base.ctx), sizeof(int64_t));
  return sphi_buffer_reserve(list->base.ctx, &list->scratch[SCRATCH_COUNTS], bytes);
}

static sph_status invert_all(sph_neighbors *list, const sph_operands *own, double *b,
                             int64_t *fallbacks) {
  sph_context *ctx = list->base.ctx;
  int32_t workers = sphi_workers(ctx);
  sph_status s = reserve_counts(list);
  if (s) return s;
  invert_job job = {own->dim, b, list->scratch[SCRATCH_COUNTS].ptr};
  memset(job.fallbacks, 0, (size_t)workers * sizeof(int64_t));
  sphi_parallel(ctx, own->rows, INVERT_GRAIN, invert_range, &job);
  for (int32_t w = 1; w < workers; ++w) job.fallbacks[0] += job.fallbacks[w];
  if (fallbacks) *fallbacks = job.fallbacks[0];
  return SPH_OK;
}

sph_status sphi_gradient_matrices(sph_neighbors *list, const sph_kernel *kernel,
                                  const sph_operands *own, double *inverse, int64_t *fallbacks) {
  sphi_sweep sweep = sphi_sweep_of(kernel, own, SPHI_MATRIX);
  sweep.spec.corrected = 0;
  sweep.matrix = inverse;
  sph_status s = sphi_sweep_run(list, &sweep);
  return s ? s : invert_all(list, own, inverse, fallbacks);
}

sph_status sph_gradient_matrix(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *a,
                               double *inverse, double *matrix, int64_t *fallbacks) {
  sph_operands own;
  sph_status s = sphi_operator_begin(list, kernel, a, SPHI_NEED_M | SPHI_NEED_RHO, inverse,
                                     "sph_gradient_matrix", &own);
  /* before anything is written */
  if (!s) s = reserve_counts(list);
  if (s) return s;
  if (matrix) {
    sphi_sweep sweep = sphi_sweep_of(kernel, &own, SPHI_MATRIX);
    sweep.spec.corrected = 0;
    sweep.matrix = matrix;
    s = sphi_sweep_run(list, &sweep);
  }
  return s ? s : sphi_gradient_matrices(list, kernel, &own, inverse, fallbacks);
}
