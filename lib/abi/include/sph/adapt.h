/* Resolution that varies: laws for the smoothing length, and the one h and W of a pair.
 *
 * "He" = L. He, PhD thesis, Durham 2015, chapter 6. d is the dimension.
 *
 * Laws. All keep the number of neighbours roughly constant:
 *
 *   density   h_i = h_i0 (rho_i0 / rho_i)^(1/d)                         He (6.1)
 *   rate      dh_i/dt = -(h_i / (d rho_i)) d rho_i/dt                   He (6.2), its derivative
 *   spacing   h_i = a dp_i, with a in 0.8 .. 1.8, usually 1.5           He (6.3)
 *
 * Pairs. With unequal h a pair needs one value that is the same from both sides, or forces are not
 * opposite: SPH_H_* of neighbors.h, He (6.4) to (6.9). He calls the harmonic mean geometric. */
#ifndef SPH_ADAPT_H
#define SPH_ADAPT_H

#include <sph/base.h>
#include <sph/neighbors.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The arrays below have n doubles each and are the host's; outputs may be the input of the same
 * index (h may be h0) and are untouched after a failure. O(n), on the context's threads, with the
 * same bits for any number of them. All answer
 *   SPH_ERR_ARG      n < 0, dim outside 1..3, an array NULL while n > 0;
 *   SPH_ERR_NUMERIC  an input that must be positive and finite is not: the sentence names the
 *                    lowest such index and its values. */

/* Density law: h from its reference h0 at the density rho0, which all must be positive.
 * Since 0.1. */
SPH_API sph_status sph_h_from_density(sph_context *ctx, int32_t dim, int64_t n, const double *h0,
                                      const double *rho0, const double *rho, double *h);

/* Rate law: dh from h and rho, positive, and drho = d rho/dt, finite. Integrated beside rho it
 * gives the density law, up to the error of the integrator. Since 0.1. */
SPH_API sph_status sph_h_rate(sph_context *ctx, int32_t dim, int64_t n, const double *h,
                              const double *rho, const double *drho, double *dh);

/* Spacing law: h = ratio * spacing, both positive. SPH_ERR_ARG also: ratio not positive and finite.
 * Since 0.1. */
SPH_API sph_status sph_h_from_spacing(sph_context *ctx, int64_t n, double ratio,
                                      const double *spacing, double *h);

/* h of a pair by a rule SPH_H_*; the same bits when i and j change places. AVERAGE has no one h:
 * the larger one, which its cutoff is made of. NaN for an unknown rule, or when one of the two is
 * not positive and finite. Since 0.1. */
SPH_API double sph_pair_h(int32_t rule, double h_i, double h_j);

/* W_ij at the distance r: W(r, h_ij), He (6.8), or for AVERAGE [W(r, h_i) + W(r, h_j)] / 2, He
 * (6.9). NaN as above, and for what sph_kernel_w() calls so. Since 0.1. */
SPH_API double sph_pair_w(const sph_kernel *kernel, int32_t rule, double r, double h_i, double h_j);

/* dW_ij/dr, likewise. Since 0.1. */
SPH_API double sph_pair_dwdr(const sph_kernel *kernel, int32_t rule, double r, double h_i,
                             double h_j);

#ifdef __cplusplus
}
#endif
#endif
