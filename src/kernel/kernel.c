/* The kernel handle: creation of the built-in kernels, references, queries. */
#include "profile.h"

#include <math.h>

sph_status sphi_kernel_new(sph_context *ctx, int32_t dim, sph_kernel **out) {
  if (out != NULL) *out = NULL;
  const sph_status status = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "context");
  if (status != SPH_OK) return status;
  if (out == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "kernel: out is NULL");
  if (dim < 1 || dim > 3)
    return sphi_fail(ctx, SPH_ERR_ARG, "kernel: dim is %d, not 1, 2 or 3", (int)dim);
  sph_kernel *kernel = sphi_calloc(ctx, sizeof *kernel);
  if (kernel == NULL) return SPH_ERR_NOMEM;
  kernel->base.magic = SPHI_MAGIC_KERNEL;
  kernel->base.ctx = ctx;
  sphi_context_retain(ctx);
  kernel->references = 1;
  kernel->dim = dim;
  *out = kernel;
  return SPH_OK;
}

sph_status sph_kernel_create(sph_context *ctx, int32_t type, int32_t dim, sph_kernel **out) {
  sphi_kernel_constants constants;
  sph_kernel *kernel = NULL;
  if (out != NULL) *out = NULL;
  const sph_status status = sphi_kernel_new(ctx, dim, out != NULL ? &kernel : NULL);
  if (status != SPH_OK) return status;
  if (!sphi_kernel_lookup(type, dim, &constants)) {
    sphi_kernel_release(kernel);
    return sphi_fail(ctx, SPH_ERR_ARG, "kernel: unknown type %d", (int)type);
  }
  kernel->type = type;
  kernel->support = constants.support;
  kernel->alpha = constants.alpha;
  kernel->deviation = sqrt(constants.variance);
  *out = kernel;
  return SPH_OK;
}

void sphi_kernel_retain(sph_kernel *kernel) { kernel->references++; }

void sphi_kernel_release(sph_kernel *kernel) {
  if (--kernel->references > 0) return;
  sph_context *ctx = kernel->base.ctx;
  kernel->base.magic = 0;
  /* One block holds both columns of a table. */
  sphi_free(ctx, kernel->table, 2 * (size_t)kernel->table_n * sizeof(double));
  sphi_free(ctx, kernel, sizeof *kernel);
  sphi_context_release(ctx);
}

void sph_kernel_destroy(sph_kernel *kernel) {
  if (sphi_is_kernel(kernel)) sphi_kernel_release(kernel);
}

const char *sph_kernel_name(int32_t type) {
  sphi_kernel_constants constants;
  return sphi_kernel_lookup(type, 1, &constants) ? constants.name : "unknown";
}

int32_t sph_kernel_type(const sph_kernel *kernel) {
  return sphi_is_kernel(kernel) ? kernel->type : 0;
}

int32_t sph_kernel_dim(const sph_kernel *kernel) {
  return sphi_is_kernel(kernel) ? kernel->dim : 0;
}

double sph_kernel_support(const sph_kernel *kernel) {
  return sphi_is_kernel(kernel) ? kernel->support : 0.0;
}

double sph_kernel_deviation(const sph_kernel *kernel) {
  return sphi_is_kernel(kernel) ? kernel->deviation : 0.0;
}

double sph_kernel_alpha(const sph_kernel *kernel) {
  return sphi_is_kernel(kernel) ? kernel->alpha : 0.0;
}

double sph_kernel_equal_h(const sph_kernel *kernel, const sph_kernel *other, double h_other) {
  if (!sphi_is_kernel(kernel) || !sphi_is_kernel(other) || kernel->dim != other->dim) return NAN;
  if (!(h_other > 0.0) || !isfinite(h_other)) return NAN;
  if (!(kernel->deviation > 0.0) || !(other->deviation > 0.0)) return NAN;
  return h_other * (other->deviation / kernel->deviation);
}
