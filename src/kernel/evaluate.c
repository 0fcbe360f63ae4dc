/* W, dW/dr, d2W/dr2 and dW/dh from a profile:
 *   W = a w, dW/dr = a w'/h, d2W/dr2 = a w''/h^2, dW/dh = -(d W + r dW/dr)/h, a = alpha/h^d. */
#include "profile.h"

#include <math.h>

typedef struct values {
  double w;
  double dwdr;
  double d2wdr2;
  double dwdh;
} values;

static int is_length(double h) { return h > 0.0 && isfinite(h); }

static double scale(const sph_kernel *kernel, double h) {
  if (kernel->dim == 1) return kernel->alpha / h;
  return kernel->dim == 2 ? kernel->alpha / (h * h) : kernel->alpha / (h * h * h);
}

/* Outside the support nothing is multiplied, so that an h^d that underflows gives no NaN. */
static values evaluate(const sph_kernel *kernel, double r, double h, int second) {
  const double q = r / h;
  sphi_profile p = {0.0, 0.0, 0.0};
  if (!(q < kernel->support)) return (values){0.0, 0.0, 0.0, 0.0};
  if (second)
    p = sphi_kernel_profile2(kernel, q);
  else
    sphi_kernel_profile(kernel, q, &p.w, &p.dw);
  const double a = scale(kernel, h);
  return (values){a * p.w, r > 0.0 ? a * p.dw / h : 0.0, a * p.d2w / (h * h),
                  -a * (kernel->dim * p.w + q * p.dw) / h};
}

static int is_valid(const sph_kernel *kernel, double r, double h) {
  return sphi_is_kernel(kernel) && r >= 0.0 && is_length(h);
}

double sph_kernel_w(const sph_kernel *kernel, double r, double h) {
  return is_valid(kernel, r, h) ? evaluate(kernel, r, h, 0).w : NAN;
}

double sph_kernel_dwdr(const sph_kernel *kernel, double r, double h) {
  return is_valid(kernel, r, h) ? evaluate(kernel, r, h, 0).dwdr : NAN;
}

double sph_kernel_d2wdr2(const sph_kernel *kernel, double r, double h) {
  return is_valid(kernel, r, h) ? evaluate(kernel, r, h, 1).d2wdr2 : NAN;
}

double sph_kernel_dwdh(const sph_kernel *kernel, double r, double h) {
  return is_valid(kernel, r, h) ? evaluate(kernel, r, h, 0).dwdh : NAN;
}

static sph_status check_distances(sph_context *ctx, int64_t n, const double *r, double h) {
  if (n < 0) return sphi_fail(ctx, SPH_ERR_ARG, "kernel: n is %lld, negative", (long long)n);
  if (n > 0 && r == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "kernel: r is NULL");
  if (!is_length(h))
    return sphi_fail(ctx, SPH_ERR_ARG, "kernel: h is %g, not positive and finite", h);
  for (int64_t i = 0; i < n; i++)
    if (!(r[i] >= 0.0))
      return sphi_fail(ctx, SPH_ERR_ARG, "kernel: r[%lld] is %g, negative or not a number",
                       (long long)i, r[i]);
  return SPH_OK;
}

sph_status sph_kernel_evaluate(const sph_kernel *kernel, int64_t n, const double *r, double h,
                               double *w, double *dwdr, double *d2wdr2, double *dwdh) {
  sph_status status = sphi_check_handle(NULL, kernel, SPHI_MAGIC_KERNEL, "kernel");
  if (status != SPH_OK) return status;
  status = check_distances(kernel->base.ctx, n, r, h);
  if (status != SPH_OK) return status;
  for (int64_t i = 0; i < n; i++) {
    const values v = evaluate(kernel, r[i], h, d2wdr2 != NULL);
    if (w != NULL) w[i] = v.w;
    if (dwdr != NULL) dwdr[i] = v.dwdr;
    if (d2wdr2 != NULL) d2wdr2[i] = v.d2wdr2;
    if (dwdh != NULL) dwdh[i] = v.dwdh;
  }
  return SPH_OK;
}
