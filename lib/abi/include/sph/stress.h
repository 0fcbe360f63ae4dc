/* Stress tensors, one particle at a time: principal stresses, equivalent stress, rotation.
 *
 * Pure functions on the host's arrays, serial, O(n); disjoint ranges may run on several threads.
 * They have no context, so a failure is a status without a sentence. */
#ifndef SPH_STRESS_H
#define SPH_STRESS_H

#include <sph/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Principal stresses and their directions.
 *
 *   sigma       n packed symmetric
 *   values      n * dim, of each particle in descending order (tension first)
 *   directions  NULL, or n * dim * dim: direction k of particle i is the unit vector at
 *               directions + (i * dim + k) * dim
 *
 * Closed form, sound for repeated and nearly repeated stresses and at any scale: the error of a
 * stress is a few roundings of the largest component, directions are orthonormal and right-handed
 * to 1e-14. For 3-D after D. Eberly, A Robust Eigensolver for 3x3 Symmetric Matrices, 2014. In
 * plane strain the third principal stress zz is not among them. A particle with components that
 * are not finite gets NaN.
 * SPH_ERR_ARG: dim outside 1..3, n < 0. Since 0.1. */
SPH_API sph_status sph_principal_stresses(int32_t dim, int64_t n, const double *sigma,
                                          double *values, double *directions);

/* The equivalent stress of von Mises, sqrt(3/2 s:s) with s the deviator of the 3x3 stress.
 *
 *   across  NULL (zero: plane and uniaxial stress), or n: zz in 2-D, yy = zz in 1-D (plane and
 *           uniaxial strain). Not used in 3-D.
 *   out     n
 *
 * SPH_ERR_ARG: dim outside 1..3, n < 0. Since 0.1. */
SPH_API sph_status sph_equivalent_stress(int32_t dim, int64_t n, const double *sigma,
                                         const double *across, double *out);

/* How the rotation of a step follows from the spin omega = (L - L^T)/2.
 *
 *   ROTATION_EXPONENTIAL  R = exp(omega dt), the rotation by |omega| dt: exact for a spin that is
 *                         constant over the step.
 *   ROTATION_CAYLEY       R = (I - omega dt/2)^-1 (I + omega dt/2), the rotation by
 *                         2 atan(|omega| dt/2): exact when L dt is the gradient of the
 *                         displacements of the step by the positions in its middle.
 *                         T. Hughes, J. Winget, Int. J. Numer. Meth. Eng. 15 (1980) 1862-1867. */
enum { SPH_ROTATION_EXPONENTIAL = 1, SPH_ROTATION_CAYLEY = 2 };

/* Turn stresses with the material over a time step: sigma <- R sigma R^T.
 *
 * R is orthogonal to rounding, so principal stresses keep their values to less than 1e-15 a step,
 * however large the step is. The rate form (Jaumann terms in sph_material_stress_rate()) keeps
 * them only as well as its integrator does. Relative change after one full turn in N equal steps:
 * Euler (2 pi)^2 2/N, midpoint and Heun (2 pi)^4 2/N^3, Runge-Kutta of order 4 (2 pi)^6 (4/9)/N^5 -
 * below 1e-6 from 123 steps on.
 *
 *   velocity_gradient  n * dim * dim, L_ab = d v_a / d x_b
 *   sigma              n packed symmetric; 1-D is left as it is
 *
 * SPH_ERR_ARG: dim outside 1..3, n < 0, dt not finite, an unknown rotation. Since 0.1. */
SPH_API sph_status sph_stress_rotate(int32_t dim, int64_t n, const double *velocity_gradient,
                                     double dt, int32_t rotation, double *sigma);

#ifdef __cplusplus
}
#endif
#endif
