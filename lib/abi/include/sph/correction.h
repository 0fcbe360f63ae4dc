/* Corrections that restore consistency near boundaries and in disorder.
 *
 * Shepard divides by S_i = sum_j V_j W_ij (He 2015, 2.31). The kernel-gradient matrix
 *   B_i = sum_j V_j g_ij (x) (x_j - x_i)   and   g~_ij = B_i^-1 g_ij
 * makes difference gradients exact for linear fields in any dimension (He & Seaid 2016, after
 * eq. 3; the thesis prints only the scalar form, a division that is undefined for d > 1). */
#ifndef SPH_CORRECTION_H
#define SPH_CORRECTION_H

#include <sph/operators.h>

#ifdef __cplusplus
extern "C" {
#endif

/* S_i = sum_j V_j W_ij, i included. sum: rows. Since 0.1. */
SPH_API sph_status sph_shepard_sum(sph_neighbors *list, const sph_kernel *kernel,
                                   const sph_operands *a, double *sum);

/* B_i^-1, row-major: inverse has rows * dim * dim doubles and may serve as `gradient_matrix` when rows = n. Where B_i is ill
 * conditioned (its condition number in the Frobenius norm above 1e3: isolated, collinear or coplanar particles) the identity is
 * stored, i.e. the plain gradient is used; *fallbacks (may be NULL) counts those. matrix (may be NULL) receives B_i itself.
 * Since 0.1. */
SPH_API sph_status sph_gradient_matrix(sph_neighbors *list, const sph_kernel *kernel,
                                       const sph_operands *a, double *inverse, double *matrix,
                                       int64_t *fallbacks);

#ifdef __cplusplus
}
#endif
#endif
