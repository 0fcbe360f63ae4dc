/* Corrections that restore consistency near boundaries and in disorder.
 *
 * Shepard divides by S_i = sum_j V_j W_ij (He 2015, 2.31). The kernel-gradient matrix
 *   B_i = sum_j V_j g_ij (x) (x_j - x_i)   and   g~_ij = B_i^-1 g_ij
 * makes difference gradients exact for linear fields in any dimension (He & Seaid 2016, after
 * eq. 3; the thesis prints only the scalar form, a division that is undefined for d > 1).
 *
 * Errors, state after failure and cost are those of the operators (operators.h). */
#ifndef SPH_CORRECTION_H
#define SPH_CORRECTION_H

#include <sph/operators.h>

#ifdef __cplusplus
extern "C" {
#endif

/* S_i = sum_j V_j W_ij, i included. sum: rows, the host's. Since 0.1. */
SPH_API sph_status sph_shepard_sum(sph_neighbors *list, const sph_kernel *kernel,
                                   const sph_operands *a, double *sum);

/* B_i^-1, row-major. inverse: rows * dim * dim, the host's; it may serve as `gradient_matrix` of
 * the same rows (the conservative stress form reads all n). matrix (may be NULL) receives B_i
 * itself, rows * dim * dim, at the cost of a second sweep. The operands' own gradient_matrix is
 * ignored.
 *
 * The identity is stored, i.e. the plain gradient is used, where B_i is of no use. With Frobenius
 * norms: |B_i| |B_i^-1| >= 1e3 (collinear or coplanar neighbours), or |B_i| <= 1e-3 (isolated
 * particles, or neighbours at the edge of the support only; in 1-D the only rule that acts, for the
 * product above is 1 there), or B_i singular or not finite. *fallbacks (may be NULL) receives their
 * number. Since 0.1. */
SPH_API sph_status sph_gradient_matrix(sph_neighbors *list, const sph_kernel *kernel,
                                       const sph_operands *a, double *inverse, double *matrix,
                                       int64_t *fallbacks);

#ifdef __cplusplus
}
#endif
#endif
