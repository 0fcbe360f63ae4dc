/* Smoothing functions W(r, h) in 1, 2 and 3 dimensions.
 *
 * W(r, h) = alpha_d / h^d * w(q), q = r / h, zero for q >= support (sph_kernel_support()). The
 * integral over d-dimensional space is 1 for every kernel. h is the classical smoothing length of
 * the literature that names the kernel; to compare kernels take equal resolution, not equal h
 * (sph_kernel_equal_h()).
 *
 * sigma^2 is the second moment per dimension, (1/d) int |x|^2 W dx at h = 1: a smoothed field is
 * f + (sigma^2 h^2 / 2) lap f + O(h^4) in the interior. sph_kernel_deviation() is sigma.
 *
 *   kernel          support  w(q)
 *   cubic spline       2     2/3 - q^2 + q^3/2 for q < 1, (2-q)^3 / 6 for 1 <= q < 2
 *   quartic spline     2.5   (2.5-q)^4 - 5 (1.5-q)+^4 + 10 (0.5-q)+^4
 *   quintic spline     3     (3-q)^5 - 6 (2-q)+^5 + 15 (1-q)+^5
 *   quadratic          1     1 - q^2
 *   Johnson            2     3q^2/16 - 3q/4 + 3/4 = (3/16) (2-q)^2
 *   Lucy               1     (1+3q) (1-q)^3 = 1 - 6q^2 + 8q^3 - 3q^4
 *   new quartic        2     2/3 - 9q^2/8 + 19q^3/24 - 5q^4/32
 *   Gaussian           3     exp(-q^2), cut and renormalised
 *   super-Gaussian     3     (1 + d/2 - q^2) exp(-q^2), cut and renormalised
 *   Wendland C2        2     1-D: (1-u)^3 (1+3u); 2-D and 3-D: (1-u)^4 (1+4u); u = q/2
 *   Wendland C4        2     1-D: (1-u)^5 (1+5u+8u^2); 2-D and 3-D: (1-u)^6 (1+6u+35u^2/3)
 *   Wendland C6        2     1-D: (1-u)^7 (1+7u+19u^2+21u^3);
 *                            2-D and 3-D: (1-u)^8 (1+8u+25u^2+32u^3)
 *   mollifier          1     exp(1 / (q^2 - 1))
 *
 *   kernel          alpha_1    alpha_2        alpha_3         sigma^2 in 1-D, 2-D, 3-D
 *   cubic spline    1          15/(7 pi)      3/(2 pi)        1/3       31/98       3/10
 *   quartic spline  1/24       96/(1199 pi)   1/(20 pi)       5/12      9759/24416  23/60
 *   quintic spline  1/120      7/(478 pi)     1/(120 pi)      1/2       2771/5736   7/15
 *   quadratic       3/4        2/pi           15/(8 pi)       1/5       1/6         1/7
 *   Johnson         1          2/pi           5/(4 pi)        2/5       2/5         8/21
 *   Lucy            5/4        5/pi           105/(16 pi)     2/21      5/56        1/12
 *   new quartic     1          15/(7 pi)      315/(208 pi)    104/315   15/49       11/39
 *   Gaussian        0.564202   0.318349       0.179666        0.499791  0.499445    0.498746
 *   super-Gaussian  0.564084   0.317996       0.178993        0.001880  0.004993    0.011242
 *   Wendland C2     5/8        7/(4 pi)       21/(16 pi)      8/21      5/18        4/15
 *   Wendland C4     3/4        9/(4 pi)       495/(256 pi)    4/15      7/33        8/39
 *   Wendland C6     55/64      39/(14 pi)     1365/(512 pi)   8/39      6/35        1/6
 *   mollifier       2.252284   2.143566       2.267117        0.158114  0.130656    0.111696
 *
 * (x)+ = max(x, 0). Polynomial constants are exact; the others are the first digits of those used.
 *
 * Sources: He = L. He, PhD thesis, Durham 2015; HS = He and Seaid, Acta Mech. 227 (2016); Sun =
 * F. Sun, PhD thesis, Southampton 2013; Zisis = I. Zisis, PhD thesis, Eindhoven 2017. What they
 * print wrongly:
 *   cubic spline    HS (2) prints 6 (2-r)^3 for (2-r)^3/6: discontinuous at 1, 1-D integral
 *                   47/12. He (2.21), Sun (6.1.6) and Zisis (2.7, M4) are right.
 *   quartic spline  Sun (6.1.7) prints -(5 (q+1.5)^4 + 10 (q+0.5)^4) in its first branch:
 *                   integral 65/96 and a jump of -5/6 at q = 0.5. "Quadratic-spline" in his
 *                   tables 6.1 and 6.2 is this one.
 *   Johnson         He (2.22), Sun (6.1.3); "Johnson quartic" in Sun 6.2 is this quadratic.
 *   new quartic     He (2.23), Sun (6.1.9), after Liu. Neither says that it turns negative.
 *   Gaussian        He (2.20) prints 1/sqrt(pi h) for 1/(sqrt(pi) h). Zisis (2.6), over the
 *                   support 3h, prints 3/sqrt(pi), 3/pi, 3/pi^1.5 for (3/sqrt(pi))^d: its
 *                   integrals are 1, 1/3, 1/9. Neither renormalises a cut: at 3h it costs
 *                   2.2e-5, 1.2e-4, 4.4e-4 of the integral, at Sun's 2h 0.5, 1.8, 4.6 %. Here it
 *                   is renormalised, so that sigma^2 is a little below 1/2.
 *   super-Gaussian  Sun (6.1.5) gives 3/2 - q^2, right in 1-D only; its integral in 3-D is 0.
 *   Wendland C2     (2-q)^4 (1+2q) = 16 (1-q/2)^4 (1+2q) in He (3.21), which gives 7/(64 pi) for
 *                   2-D and 3-D: in 3-D it is 21/(256 pi). psi_{3,1} is the member for d = 2, 3;
 *                   in 1-D it is psi_{2,1} (l = floor(d/2) + k + 1). Zisis (2.9) is right.
 *   Wendland C4     Zisis (2.10) calls it C6; his constants are right. The true C6 is not in
 *                   these sources.
 *   mollifier       Zisis (2.4) prints 4.826 and 5.08 for d = 2, 3: 2.25 and 2.24 times too
 *                   large.
 *   resolution      Zisis (2.13) and (2.14) print another integral than the second moment.
 *   gradient        (x_ij / r) dW/dr, dW/dr = alpha_d / h^(d+1) dw/dq. He (2.29) lacks the 1/h
 *                   that dw/dq needs; Zisis (2.5) has x_ij / q over h^(d+1), where h^(d+2) is
 *                   due.
 *
 * What to know before choosing:
 *   - The new quartic is negative for 1.6957 < q < 2 (least value -0.00158 alpha_d at q = 1.8),
 *     its slope is positive for 1.8 < q < 2, and its second derivative ends at -1/4. The super-
 *     Gaussian is negative for q > sqrt(1 + d/2).
 *   - Johnson has a cusp: dw/dq = -3/4 at q = 0+, so the gradient is discontinuous there; at r =
 *     0 it is 0.
 *   - At the edge the quadratic ends with slope -2 alpha_d, and both Gaussians jump (by exp(-9)
 *     = 1.2e-4 times alpha_d for the Gaussian). All others are at least once differentiable.
 *   - The super-Gaussian is of fourth order: uncut, its second moment is 0, and what is left of
 *     it comes from the cut. Its deviation is no measure of resolution.
 *   - Wendland functions have positive Fourier transforms, so particles do not pair at large
 *     neighbour numbers; splines go negative in 2-D and 3-D (M4 first at k H = 11.39 and 12.57,
 *     M6 at 16.75 and 18.95, H the support radius). The cut leaves negative ripples of
 *     1e-5 on the Gaussian's. */
#ifndef SPH_KERNEL_H
#define SPH_KERNEL_H

#include <sph/base.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
  SPH_KERNEL_CUBIC_SPLINE = 1,   /* M4, support 2 */
  SPH_KERNEL_QUARTIC_SPLINE = 2, /* M5, support 2.5 */
  SPH_KERNEL_QUINTIC_SPLINE = 3, /* M6, support 3 */
  SPH_KERNEL_QUADRATIC = 4,      /* 1 - q^2, support 1 */
  SPH_KERNEL_JOHNSON = 5,        /* Johnson's quadratic, support 2; cusp at r = 0 */
  SPH_KERNEL_LUCY = 6,           /* (1 + 3q)(1 - q)^3, support 1 */
  SPH_KERNEL_NEW_QUARTIC = 7,    /* Liu's quartic, support 2; negative for 1.6957 < q < 2 */
  SPH_KERNEL_GAUSSIAN = 8,       /* exp(-q^2), cut at 3h and renormalised */
  SPH_KERNEL_SUPER_GAUSSIAN = 9, /* (1 + d/2 - q^2) exp(-q^2), cut at 3h and renormalised */
  SPH_KERNEL_WENDLAND_C2 = 10,   /* psi_{2,1} in 1-D, psi_{3,1} in 2-D and 3-D, support 2 */
  SPH_KERNEL_WENDLAND_C4 = 11,   /* support 2 */
  SPH_KERNEL_WENDLAND_C6 = 12,   /* support 2 */
  SPH_KERNEL_MOLLIFIER = 13      /* exp(1 / (q^2 - 1)), support 1 */
};

/* Create one of the kernels above for one dimension. Cheap; may be shared by many objects of the
 * same context. SPH_ERR_ARG: unknown type, dim outside 1..3. SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_kernel_create(sph_context *ctx, int32_t type, int32_t dim, sph_kernel **out);

/* A host's own profile: *w = w(q) and *dw = dw/dq for 0 <= q < support, normalised so that the
 * integral of w(|q|) over d-dimensional space is 1. Pure and thread-safe. Never called outside that
 * range. */
typedef void (*sph_kernel_fn)(void *user, double q, double *w, double *dw);

/* Kernel from a callback, which is called once per pair and evaluation (exact, but slower than the
 * built-in ones) and 4097 times here, to integrate it. fn and user must stay valid as long as the
 * kernel. d2W/dr2 is by central differences of dw. SPH_ERR_ARG: fn NULL, dim outside 1..3, support
 * not positive and finite; SPH_ERR_NUMERIC: a value is not finite, or the integral differs from 1
 * by more than 1e-6 (the sentence says what it is). SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_kernel_create_callback(sph_context *ctx, int32_t dim, double support,
                                              sph_kernel_fn fn, void *user, sph_kernel **out);

/* Kernel from a table: w and dw/dq at n >= 4 equally spaced q from 0 to `support` inclusive;
 * copied, interpolated by cubic Hermite polynomials (derivatives are those of the polynomials; the
 * second one jumps at the samples). normalise nonzero: scaled so that the integral is 1; else it
 * must be 1 within 1e-6. SPH_ERR_ARG: n < 4, w or dw NULL, dim, support as above. SPH_ERR_NUMERIC:
 * a sample is not finite (named), the integral is not 1, or not positive where it is to be
 * normalised. SPH_ERR_NOMEM. O(n). Since 0.1. */
SPH_API sph_status sph_kernel_create_table(sph_context *ctx, int32_t dim, double support, int64_t n,
                                           const double *w, const double *dw, int32_t normalise,
                                           sph_kernel **out);

/* Give up the caller's reference; the memory goes with the last object that uses the kernel. NULL
 * is allowed. Since 0.1. */
SPH_API void sph_kernel_destroy(sph_kernel *kernel);

/* Name of a built-in type ("cubic_spline" ...); "unknown" otherwise. Static. Since 0.1. */
SPH_API const char *sph_kernel_name(int32_t type);

/* SPH_KERNEL_* of a kernel, 0 for a host's own or NULL. Since 0.1. */
SPH_API int32_t sph_kernel_type(const sph_kernel *kernel);
/* Dimension; 0 for NULL. Since 0.1. */
SPH_API int32_t sph_kernel_dim(const sph_kernel *kernel);
/* Support radius in units of h; 0 for NULL. Since 0.1. */
SPH_API double sph_kernel_support(const sph_kernel *kernel);
/* Standard deviation per dimension in units of h, sigma^2 = (1/d) int |x|^2 W dx; 0 for NULL and
 * for a host's kernel whose second moment is not positive. Since 0.1. */
SPH_API double sph_kernel_deviation(const sph_kernel *kernel);
/* Normalisation alpha_d for h = 1, so that W(0) = alpha_d * w(0); 1 for a host's own kernel, 0 for
 * NULL. Since 0.1. */
SPH_API double sph_kernel_alpha(const sph_kernel *kernel);

/* W at one distance, 1 / length^dim. This and the next three: NaN for NULL, r < 0, a NaN, or h not
 * positive and finite; 0 at and beyond the support. Since 0.1. */
SPH_API double sph_kernel_w(const sph_kernel *kernel, double r, double h);
/* dW/dr. At r = 0 it is 0 for every kernel, also the one with a cusp. Since 0.1. */
SPH_API double sph_kernel_dwdr(const sph_kernel *kernel, double r, double h);
/* d2W/dr2. Since 0.1. */
SPH_API double sph_kernel_d2wdr2(const sph_kernel *kernel, double r, double h);
/* dW/dh = -(d W + r dW/dr) / h. Since 0.1. */
SPH_API double sph_kernel_dwdh(const sph_kernel *kernel, double r, double h);

/* The same for n distances with one h; any of w, dwdr, d2wdr2, dwdh (n doubles each) may be NULL.
 * Same bits as the functions above.
 * SPH_ERR_ARG: n < 0, r NULL with n > 0, h not positive and finite; a negative or NaN r, named.
 * O(n). Since 0.1. */
SPH_API sph_status sph_kernel_evaluate(const sph_kernel *kernel, int64_t n, const double *r,
                                       double h, double *w, double *dwdr, double *d2wdr2,
                                       double *dwdh);

/* The h of `kernel` that resolves like `other` at h_other: equal standard deviation. NaN for NULL,
 * different dimensions, h_other not positive and finite, or a kernel without a deviation. Not
 * meaningful for the super-Gaussian (see above). Zisis 2017 section 2, with the second moment per
 * dimension, where his eq. 2.13 prints another integral. Since 0.1. */
SPH_API double sph_kernel_equal_h(const sph_kernel *kernel, const sph_kernel *other,
                                  double h_other);

#ifdef __cplusplus
}
#endif
#endif
