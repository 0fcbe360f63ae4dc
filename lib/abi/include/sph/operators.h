/* SPH operators: each callable alone on host arrays, each also a term of a composed right-hand
 * side (rhs.h), where the same code runs.
 *
 * All take a built neighbour list, a kernel of the same dimension and a description of the
 * particle arrays. Sums run over the stored neighbours within the support, and over i itself where W(0)
 * counts; each sum has a fixed order, so the bits do not depend on the number of threads. Outputs
 * are host arrays in host order and must not overlap inputs.
 *
 * Notation: V_j = m_j / rho_j, g_ij = grad_i W(r_ij, h_ij) = (x_ij / r) dW/dr, zero at r = 0, and g~_ij = B_i^-1 g_ij when
 * `gradient_matrix` is given (correction.h). He 2015 eq. 2.29 misses a factor 1/h. */
#ifndef SPH_OPERATORS_H
#define SPH_OPERATORS_H

#include <sph/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Arrays of n particles in host order, none of them kept or copied. A scalar array that is NULL means "the value *0
 * everywhere"; vectors and tensors that an operator needs may not be NULL. Size first: zero-fill through
 * sph_operands_init(). */
typedef struct sph_operands {
  size_t size;
  int32_t dim;
  int64_t n;        /* must equal the list's count */
  int64_t rows;     /* results for i < rows only (ghosts stand last); default -1 = n */
  const double *x;  /* n * dim: positions now, within the list's skin of those it was built from */
  const double *v;  /* n * dim */
  const double *m;   double m0;
  const double *rho; double rho0;
  const double *h;   double h0;
  const double *p;   double p0; /* pressure */
  const double *c;   double c0; /* sound speed */
  const double *sigma;           /* packed symmetric */
  const double *gradient_matrix; /* NULL, or n * dim * dim from sph_gradient_matrix(): corrects gradients */
} sph_operands;

/* Zero everything and set the size. Since 0.1. */
SPH_API void sph_operands_init_sized(sph_operands *operands, size_t size);
#define sph_operands_init(operands) sph_operands_init_sized((operands), sizeof(sph_operands))

/* Point the operands at the fields of a set that exist (rows = real count). Valid until the set
 * grows. Since 0.1. */
SPH_API sph_status sph_operands_from_set(sph_particles *set, sph_operands *operands);

/* Every operator: SPH_ERR_ARG (a needed array is NULL, sizes or dimensions that do not fit, an uncorrectable form; the
 * sentence names it), SPH_ERR_STATE (the list was never built), SPH_ERR_STALE (positions moved
 * further than the list allows), SPH_ERR_NOMEM; outputs are untouched then. O(pairs). */

/* Variants of a gradient, He 2015 (2.33). Only the difference form is exact for linear fields. */
enum {
  SPH_GRADIENT_PLAIN = 1,      /* sum V_j f_j g_ij */
  SPH_GRADIENT_DIFFERENCE = 2, /* sum V_j (f_j - f_i) g_ij */
  SPH_GRADIENT_SUM = 3         /* sum V_j (f_j + f_i) g_ij */
};

/* rho_i = sum_j m_j W_ij, i included. rho: rows. (Zisis 3.38, Sun 6.1.13.) Since 0.1. */
SPH_API sph_status sph_density_summation(sph_neighbors *list, const sph_kernel *kernel,
                                         const sph_operands *a, double *rho);

/* d rho/dt. MASS: sum m_j v_ij.g_ij (Sun 4.2.7, which prints rho_b for m_b). VOLUME:
 * rho_i sum V_j v_ij.g_ij (Sun 4.2.3, He 3.8a). NUMBER: m_i sum v_ij.g_ij (Zisis 3.57). drho: rows. Since 0.1. */
enum { SPH_CONTINUITY_MASS = 1, SPH_CONTINUITY_VOLUME = 2, SPH_CONTINUITY_NUMBER = 3 };
SPH_API sph_status sph_continuity(sph_neighbors *list, const sph_kernel *kernel,
                                  const sph_operands *a, int32_t form, double *drho);

/* L_ab = d v_a / d x_b by the difference form, He 2015 (3.7b). L: rows * dim * dim. Since 0.1. */
SPH_API sph_status sph_velocity_gradient(sph_neighbors *list, const sph_kernel *kernel,
                                         const sph_operands *a, double *L);

/* Gradient of a field f of `components` >= 1 doubles a particle: grad[(i * components + k) * dim + b] = d f_k / d x_b.
 * Since 0.1. */
SPH_API sph_status sph_gradient(sph_neighbors *list, const sph_kernel *kernel,
                                const sph_operands *a, int32_t variant, int32_t components,
                                const double *f, double *grad);

/* Interpolated field at the particles: sum V_j f_j W_ij, i included; shepard nonzero: divided by sum V_j W_ij,
 * He 2015 (2.26), (2.31). out: rows * components. Since 0.1. */
SPH_API sph_status sph_interpolate(sph_neighbors *list, const sph_kernel *kernel,
                                   const sph_operands *a, int32_t shepard, int32_t components,
                                   const double *f, double *out);

/* The same at `points` (np * dim), with the h of each contributing particle. A point without
 * neighbours gets 0. out: np * components. Since 0.1. */
SPH_API sph_status sph_interpolate_at(sph_neighbors *list, const sph_kernel *kernel,
                                      const sph_operands *a, int32_t shepard, int64_t np,
                                      const double *points, int32_t components, const double *f,
                                      double *out);

/* dv_i/dt from the stress.
 * SUMMED: sum m_j (sigma_i/rho_i^2 + sigma_j/rho_j^2) g~_ij, He 2015 (3.8b): conserves momentum when uncorrected.
 * DIFFERENCE: sum m_j (sigma_j - sigma_i)/(rho_i rho_j) g~_ij: exact for linear stress, no
 *   natural traction condition; what reproduces He's one-dimensional tables, in no source's print.
 * CONSERVATIVE: sum m_j (sigma_i B_i^-1/rho_i^2 + sigma_j B_j^-1/rho_j^2) g_ij: corrected and
 *   antisymmetric, momentum kept to rounding.
 * dvdt: rows * dim. Since 0.1. */
enum { SPH_STRESS_SUMMED = 1, SPH_STRESS_DIFFERENCE = 2, SPH_STRESS_CONSERVATIVE = 3 };
SPH_API sph_status sph_stress_divergence(sph_neighbors *list, const sph_kernel *kernel,
                                         const sph_operands *a, int32_t form, double *dvdt);

/* dv_i/dt = -grad p / rho.
 * MASS: -sum m_j (p_i/rho_i^2 + p_j/rho_j^2) g_ij (Sun 4.2.8).
 * VOLUME: -(1/rho_i) sum V_j (p_i + p_j) g_ij (Sun 4.2.9; Zisis 3.56 prints 1/(rho_j rho_j)).
 * NUMBER: -(1/m_i) sum (V_i^2 p_i + V_j^2 p_j) g_ij (Zisis 3.65).
 * DIFFERENCE: -(1/rho_i) sum V_j (p_j - p_i) g_ij (Zisis 3.83, whose sign is wrong); not conservative. Since 0.1. */
enum { SPH_PRESSURE_MASS = 1, SPH_PRESSURE_VOLUME = 2, SPH_PRESSURE_NUMBER = 3, SPH_PRESSURE_DIFFERENCE = 4 };
SPH_API sph_status sph_pressure_gradient(sph_neighbors *list, const sph_kernel *kernel,
                                         const sph_operands *a, int32_t form, double *dvdt);

/* Artificial viscosity of Monaghan, He 2015 (3.16): where v_ij.x_ij < 0,
 *   Pi_ij = (-alpha c_ij phi_ij + beta phi_ij^2) / rho_ij, phi_ij = h_ij v_ij.x_ij / (r^2 + (0.1 h_ij)^2),
 * with arithmetic pair means c_ij, rho_ij and the pair's h_ij; else 0. dv_i/dt = -sum m_j Pi_ij g~_ij. Since 0.1. */
SPH_API sph_status sph_viscosity_monaghan(sph_neighbors *list, const sph_kernel *kernel,
                                          const sph_operands *a, double alpha, double beta,
                                          double *dvdt);

/* Viscous pressures q_i from the divergence of velocity; both are zero where it is not negative.
 * NEUMANN: q = a dx^2 rho (div v)^2 (He 3.14). LINEAR: q = a dx c rho |div v| (He 3.15, whose sign
 * is wrong). HERNQUIST_KATZ: q = alpha h rho c |div v| + beta h^2 rho (div v)^2 (He 3.17), the h of the particle.
 * dv_i/dt = -sum m_j (q_i/rho_i^2 + q_j/rho_j^2) g~_ij; q (rows, may be NULL) receives the pressures. */
typedef struct sph_bulk_viscosity {
  size_t size;
  double neumann;   /* a_1; default 0 */
  double linear;    /* a_2; default 0 */
  double spacing;   /* dx of the two above, a length; needed when they are not 0 */
  double hk_alpha;  /* Hernquist-Katz alpha; default 0 */
  double hk_beta;   /* Hernquist-Katz beta; default 0 */
} sph_bulk_viscosity;
SPH_API void sph_bulk_viscosity_init_sized(sph_bulk_viscosity *options, size_t size);
#define sph_bulk_viscosity_init(o) sph_bulk_viscosity_init_sized((o), sizeof(sph_bulk_viscosity))
/* Two sweeps: div v by the difference form, then the force. Since 0.1. */
SPH_API sph_status sph_viscosity_bulk(sph_neighbors *list, const sph_kernel *kernel,
                                      const sph_operands *a, const sph_bulk_viscosity *options,
                                      double *q, double *dvdt);

/* Gray's artificial stress from a stress state, He 2015 (3.22) to (3.26): in the frame of the
 * principal stresses s_k, R_k = -epsilon s_k / rho^2 where s_k > 0, else 0, turned back. The angle is that of
 * atan2 (tan 2 theta, as printed, loses the branch). rho NULL: rho0 everywhere. sigma and R:
 * n packed symmetric tensors, which may be the same array. SPH_ERR_ARG: dim outside 1..3, n < 0, NULL, rho0 not positive,
 * epsilon not finite. Pointwise, serial. Since 0.1. */
SPH_API sph_status sph_artificial_stress(int32_t dim, int64_t n, const double *sigma,
                                         const double *rho, double rho0, double epsilon,
                                         double *R);

/* XSPH: out_i = epsilon sum_j (m_j / rho_ij) (v_j - v_i) W_ij, rho_ij the pair mean, He 2015 (4.4); usual epsilon 0.5. out:
 * rows * dim, to be added to dx/dt. Since 0.1. */
SPH_API sph_status sph_xsph(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *a,
                            double epsilon, double *out);

#ifdef __cplusplus
}
#endif
#endif
