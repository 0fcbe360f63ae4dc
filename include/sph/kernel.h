/* Smoothing functions W(r, h) in 1, 2 and 3 dimensions.
 *
 * All are written W = alpha_d / h^d * w(q), q = r / h, with support q < sph_kernel_support().
 * h is the classical smoothing length of the literature that names the kernel (a table below
 * each name). Where a published constant is wrong, the correct one is used and it says so. */
#ifndef SPH_KERNEL_H
#define SPH_KERNEL_H

#include <sph/base.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
  SPH_KERNEL_CUBIC_SPLINE = 1,    /* M4, support 2 */
  SPH_KERNEL_QUARTIC_SPLINE = 2,  /* M5, support 2.5 */
  SPH_KERNEL_QUINTIC_SPLINE = 3,  /* M6, support 3 */
  SPH_KERNEL_QUADRATIC = 4,       /* 1 - q^2, support 1 */
  SPH_KERNEL_JOHNSON = 5,         /* Johnson's quadratic, support 2; cusp at r = 0 */
  SPH_KERNEL_LUCY = 6,            /* (1 + 3q)(1 - q)^3, support 1 */
  SPH_KERNEL_NEW_QUARTIC = 7,     /* Liu's quartic, support 2; negative for 1.6957 < q < 2 */
  SPH_KERNEL_GAUSSIAN = 8,        /* exp(-q^2), cut at 3h and renormalised */
  SPH_KERNEL_SUPER_GAUSSIAN = 9,  /* (1 + d/2 - q^2) exp(-q^2), cut at 3h and renormalised */
  SPH_KERNEL_WENDLAND_C2 = 10,    /* psi_{2,1} in 1-D, psi_{3,1} in 2-D and 3-D, support 2 */
  SPH_KERNEL_WENDLAND_C4 = 11,    /* support 2 */
  SPH_KERNEL_WENDLAND_C6 = 12,    /* support 2 */
  SPH_KERNEL_MOLLIFIER = 13       /* exp(1 / (q^2 - 1)), support 1 */
};

/* Create one of the kernels above for one dimension. Cheap; may be shared by many objects of the
 * same context. SPH_ERR_ARG: unknown type, dim outside 1..3. SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_kernel_create(sph_context *ctx, int32_t type, int32_t dim,
                                     sph_kernel **out);

/* A host's own profile: *w = w(q) and *dw = dw/dq for 0 <= q < support, normalised so that the
 * integral of w(|q|) over d-dimensional space is 1. Pure and thread-safe. */
typedef void (*sph_kernel_fn)(void *user, double q, double *w, double *dw);

/* Kernel from a callback, which is called once per pair and evaluation (exact, but slower than the built-in
 * ones). d2W/dr2 is by central differences of dw. SPH_ERR_ARG: fn NULL, dim outside 1..3,
 * support not positive and finite; SPH_ERR_NUMERIC: a value is not finite, or the integral
 * differs from 1 by more than 1e-6 (the sentence says what it is). Since 0.1. */
SPH_API sph_status sph_kernel_create_callback(sph_context *ctx, int32_t dim, double support,
                                              sph_kernel_fn fn, void *user, sph_kernel **out);

/* Kernel from a table: w and dw/dq at n >= 4 equally spaced q from 0 to `support` inclusive; copied,
 * interpolated by cubic Hermite polynomials. normalise nonzero: scaled so that the integral is 1.
 * Errors as above. Since 0.1. */
SPH_API sph_status sph_kernel_create_table(sph_context *ctx, int32_t dim, double support,
                                           int64_t n, const double *w, const double *dw,
                                           int32_t normalise, sph_kernel **out);

/* Give up the caller's reference. NULL is allowed. Since 0.1. */
SPH_API void sph_kernel_destroy(sph_kernel *kernel);

/* Name of a built-in type ("cubic_spline" ...); "unknown" otherwise. Static. Since 0.1. */
SPH_API const char *sph_kernel_name(int32_t type);

/* SPH_KERNEL_* of a kernel, 0 for a host's own or NULL. Since 0.1. */
SPH_API int32_t sph_kernel_type(const sph_kernel *kernel);
/* Dimension; 0 for NULL. Since 0.1. */
SPH_API int32_t sph_kernel_dim(const sph_kernel *kernel);
/* Support radius in units of h; 0 for NULL. Since 0.1. */
SPH_API double sph_kernel_support(const sph_kernel *kernel);
/* Standard deviation per dimension in units of h, sigma^2 = (1/d) int |x|^2 W dx; 0 for NULL. Since 0.1. */
SPH_API double sph_kernel_deviation(const sph_kernel *kernel);
/* Normalisation alpha_d for h = 1, so that W(0) = alpha_d * w(0); 0 for NULL. Since 0.1. */
SPH_API double sph_kernel_alpha(const sph_kernel *kernel);

/* W, dW/dr, d2W/dr2, dW/dh at one distance. NaN for NULL, r < 0, h <= 0 or a NaN; 0 at and beyond
 * the support. At r = 0, dW/dr is 0 for every kernel, also the one with a cusp. Since 0.1. */
SPH_API double sph_kernel_w(const sph_kernel *kernel, double r, double h);
SPH_API double sph_kernel_dwdr(const sph_kernel *kernel, double r, double h);
SPH_API double sph_kernel_d2wdr2(const sph_kernel *kernel, double r, double h);
SPH_API double sph_kernel_dwdh(const sph_kernel *kernel, double r, double h);

/* The same for n distances with one h; any of w, dwdr, d2wdr2, dwdh (n doubles each) may be NULL.
 * SPH_ERR_ARG: n < 0, r NULL with n > 0, h not positive and finite; a negative or NaN r, named. Since 0.1. */
SPH_API sph_status sph_kernel_evaluate(const sph_kernel *kernel, int64_t n, const double *r,
                                       double h, double *w, double *dwdr, double *d2wdr2,
                                       double *dwdh);

/* The h of `kernel` that resolves like `other` at h_other: equal standard deviation. NaN for
 * NULL, different dimensions or h_other not positive. (Zisis 2017 section 2, corrected: the second moment
 * per dimension, eq. 2.13 prints another.) Since 0.1. */
SPH_API double sph_kernel_equal_h(const sph_kernel *kernel, const sph_kernel *other,
                                  double h_other);

#ifdef __cplusplus
}
#endif
#endif
