/* Profiles w(q) of the built-in kernels and the constants that go with them. Private to this
 * folder; everything else reads struct sph_kernel. */
#ifndef SPHI_KERNEL_PROFILE_H
#define SPHI_KERNEL_PROFILE_H

#include "kernel_impl.h"

static inline int sphi_is_kernel(const sph_kernel *kernel) {
  return kernel != NULL && kernel->base.magic == SPHI_MAGIC_KERNEL;
}

/* A profile and its derivatives with respect to q. */
typedef struct sphi_profile {
  double w;
  double dw;
  double d2w;
} sphi_profile;

/* Constants of one kernel in one dimension, all for h = 1. */
typedef struct sphi_kernel_constants {
  const char *name;
  double support;
  double alpha;
  double variance; /* second moment per dimension */
} sphi_kernel_constants;

/* Returns 0 for an unknown type or a dimension outside 1..3, and leaves *out alone. */
int sphi_kernel_lookup(int32_t type, int32_t dim, sphi_kernel_constants *out);

/* w, w' and w'' of any kernel; all 0 for q >= support. q >= 0. At q = 0 the one-sided values. */
sphi_profile sphi_kernel_profile2(const struct sph_kernel *kernel, double q);

/* Interpolated sample of a table kernel, which is `user`; a sph_kernel_fn. */
void sphi_kernel_table_fn(void *user, double q, double *w, double *dw);
sphi_profile sphi_kernel_table_profile(const struct sph_kernel *kernel, double q);

/* A handle with everything but profile and constants filled in; SPH_ERR_ARG, SPH_ERR_NOMEM. */
sph_status sphi_kernel_new(sph_context *ctx, int32_t dim, sph_kernel **out);

#endif
