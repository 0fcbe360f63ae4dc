/* The kernel handle. Pure data once created: the pair loops read it directly. */
#ifndef SPHI_KERNEL_IMPL_H
#define SPHI_KERNEL_IMPL_H

#include "../core/core.h"

#include <sph/kernel.h>

struct sph_kernel {
  sphi_object base;
  int32_t references;
  int32_t type; /* SPH_KERNEL_*, 0 for a host's own */
  int32_t dim;
  double support;   /* kappa, in units of h */
  double alpha;     /* W = alpha / h^d * w(q) */
  double deviation; /* sigma / h */
  sph_kernel_fn fn; /* host's profile (callback or table), already scaled so that alpha = 1 */
  void *user;
  /* table kernels: n samples of w and dw, spacing support / (n - 1) */
  int64_t table_n;
  double *table;
  double *dtable;
};

/* Profile of any kernel without alpha: *w = w(q), *dw = dw/dq; both 0 for q >= support. q >= 0. */
void sphi_kernel_profile(const struct sph_kernel *kernel, double q, double *w, double *dw);

void sphi_kernel_retain(sph_kernel *kernel);
void sphi_kernel_release(sph_kernel *kernel);

#endif
