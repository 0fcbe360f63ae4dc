/* SPH operators: each callable alone on host arrays, each also a term of a composed right-hand
 * side (rhs.h), where the same code runs.
 *
 * All take a built neighbour list, a kernel of the same dimension and a description of the
 * particle arrays. Sums run over the stored neighbours within the support, and over i itself where
 * W(0) counts; each sum has a fixed order, so the bits do not depend on the number of threads.
 * Outputs are host arrays in host order and must not overlap inputs.
 *
 * Notation: V_j = m_j / rho_j; g_ij = grad_i W(r_ij, h_ij) = (x_ij / r) dW/dr, zero at r = 0, with
 * h_ij by the list's rule. With the rule AVERAGE, W and g are those of h_i and h_j, averaged, and
 * where a formula needs h_ij itself (Monaghan's viscosity) it is the arithmetic mean.
 * g~_ij = B_i^-1 g_ij where `gradient_matrix` is given (correction.h), else g_ij.
 *
 * Sources: He = L. He, PhD thesis, Durham 2015; Sun = F. Sun, PhD thesis, Southampton 2013; Zisis =
 * I. Zisis, PhD thesis, Eindhoven 2017. He (2.29) misses a factor 1/h in the gradient. */
#ifndef SPH_OPERATORS_H
#define SPH_OPERATORS_H

#include <sph/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Arrays of n particles in host order, the host's, none of them kept or copied.
 *
 * A scalar array that is NULL means its uniform value everywhere: m0, rho0, h0, c0, which must then
 * be positive and finite; p0 or e0, finite; omega0, positive, or 0 for 1. Vectors and tensors that
 * an operator needs may not be NULL; what it does not need is not looked at. Every operator needs x
 * and h; beyond these
 *
 *   density summation                       m
 *   continuity                              v, m; VOLUME also rho
 *   velocity gradient, XSPH                 v, m, rho
 *   gradient, interpolation, corrections    m, rho
 *   stress divergence                       m, rho, sigma; CONSERVATIVE also gradient_matrix
 *   pressure gradient                       m, rho, p
 *   Monaghan's viscosity                    v, m, rho, c
 *   bulk viscosity                          v, m, rho; c for its linear and Hernquist-Katz terms
 *   total-Lagrangian operators              m, rho, gradient_matrix; hourglass control also c
 *   variable smoothing lengths              see smoothing.h; alone these read e and omega
 *
 * h is that of the build: a larger one misses pairs, which goes unnoticed. */
typedef struct sph_operands {
  size_t size;     /* set by sph_operands_init() */
  int32_t dim;     /* 1, 2 or 3, as the list and the kernel */
  int64_t n;       /* must equal the list's count */
  int64_t rows;    /* results for i < rows only (ghosts stand last), 0..n; default -1 = n */
  const double *x; /* n * dim: positions; none further than half the list's skin from the build */
  const double *v; /* n * dim */
  const double *m;
  double m0;
  const double *rho;
  double rho0;
  const double *h;
  double h0;
  const double *p; /* pressure */
  double p0;
  const double *c; /* sound speed */
  double c0;
  const double *sigma;           /* n packed symmetric */
  const double *gradient_matrix; /* NULL, or from sph_gradient_matrix(): corrects gradients. Of the
                                  * rows; CONSERVATIVE reads all n. dim * dim each */
  const double *e;               /* specific internal energy */
  double e0;
  const double *omega; /* factor of a variable smoothing length (smoothing.h) */
  double omega0;
} sph_operands;

/* Fill *operands with the defaults: arrays NULL, numbers 0 (rows -1). Since 0.1. */
SPH_API void sph_operands_init_sized(sph_operands *operands, size_t size);
#define sph_operands_init(operands) sph_operands_init_sized((operands), sizeof(sph_operands))

/* Initialise the operands and point them at the fields of a set that exist; fields that do not are
 * NULL, gradient_matrix too. n is the count, rows the real count (0 for a set of ghosts). The
 * arrays stay the set's, valid until it grows. O(1). SPH_ERR_ARG: operands NULL. Since 0.1. */
SPH_API sph_status sph_operands_from_set(sph_particles *set, sph_operands *operands);

/* Every operator answers
 *   SPH_ERR_ARG       a needed array is NULL, a uniform value not positive and finite, n, rows or
 *                     dimensions that do not fit, a list that reaches less far than the kernel, an
 *                     unknown form, a coefficient not finite; the sentence names it;
 *   SPH_ERR_STATE     the list was never built;
 *   SPH_ERR_STALE     a position lies further from the one that the list was built from than the
 *                     list allows;
 *   SPH_ERR_NOMEM     no memory for the packed particles, which the list keeps: a repeated call
 *                     allocates nothing;
 *   SPH_ERR_VERSION   operands newer than this library.
 * Outputs are untouched then. Values are taken as they come: a NaN spreads to the neighbours. Cost:
 * one sweep over the pairs, O(pairs), on the context's threads, unless said otherwise. */

/* Variants of a gradient, He (2.33). Only the difference form is exact for linear fields, and only
 * with `gradient_matrix`. */
enum {
  SPH_GRADIENT_PLAIN = 1,      /* sum V_j f_j g~_ij */
  SPH_GRADIENT_DIFFERENCE = 2, /* sum V_j (f_j - f_i) g~_ij */
  SPH_GRADIENT_SUM = 3         /* sum V_j (f_j + f_i) g~_ij */
};

/* rho_i = sum_j m_j W_ij, i included (Zisis 3.38, Sun 6.1.13). rho: rows. Since 0.1. */
SPH_API sph_status sph_density_summation(sph_neighbors *list, const sph_kernel *kernel,
                                         const sph_operands *a, double *rho);

/* Forms of d rho/dt. */
enum {
  SPH_CONTINUITY_MASS = 1,   /* sum m_j v_ij.g~_ij (Sun 4.2.7, which prints rho_b for m_b) */
  SPH_CONTINUITY_VOLUME = 2, /* rho_i sum V_j v_ij.g~_ij (Sun 4.2.3, He 3.8a) */
  SPH_CONTINUITY_NUMBER = 3  /* m_i sum v_ij.g~_ij (Zisis 3.57) */
};

/* d rho/dt in the form SPH_CONTINUITY_*. drho: rows. Since 0.1. */
SPH_API sph_status sph_continuity(sph_neighbors *list, const sph_kernel *kernel,
                                  const sph_operands *a, int32_t form, double *drho);

/* L_ab = d v_a / d x_b = sum V_j (v_j - v_i)_a g~_ij,b, the difference form, He (3.7b).
 * L: rows * dim * dim, row-major. Since 0.1. */
SPH_API sph_status sph_velocity_gradient(sph_neighbors *list, const sph_kernel *kernel,
                                         const sph_operands *a, double *L);

/* Gradient of a field f of `components` >= 1 doubles a particle (f: n * components), by a variant
 * SPH_GRADIENT_*: grad[(i * components + k) * dim + b] = d f_k / d x_b, rows * components * dim.
 * One sweep for every four components. SPH_ERR_ARG also: f NULL, components < 1. Since 0.1. */
SPH_API sph_status sph_gradient(sph_neighbors *list, const sph_kernel *kernel,
                                const sph_operands *a, int32_t variant, int32_t components,
                                const double *f, double *grad);

/* Interpolated field at the particles: sum V_j f_j W_ij, i included, He (2.26); shepard nonzero:
 * divided by sum V_j W_ij, He (2.31). f: n * components, out: rows * components. One sweep for
 * every four components, one more for shepard. SPH_ERR_ARG also: f NULL, components < 1.
 * Since 0.1. */
SPH_API sph_status sph_interpolate(sph_neighbors *list, const sph_kernel *kernel,
                                   const sph_operands *a, int32_t shepard, int32_t components,
                                   const double *f, double *out);

/* The same at np points (np * dim), with the h of each contributing particle whatever the list's
 * rule. A point without neighbours gets 0. out: np * components. Scratch: 4 bytes a worker for each
 * neighbour of the fullest point. O(np * neighbours). SPH_ERR_ARG also: np < 0, points NULL, a
 * point not finite (the first is named). Since 0.1. */
SPH_API sph_status sph_interpolate_at(sph_neighbors *list, const sph_kernel *kernel,
                                      const sph_operands *a, int32_t shepard, int64_t np,
                                      const double *points, int32_t components, const double *f,
                                      double *out);

/* Forms of dv_i/dt from the stress. */
enum {
  SPH_STRESS_SUMMED = 1,      /* sum m_j (sigma_i/rho_i^2 + sigma_j/rho_j^2) g~_ij, He (3.8b):
                               * conserves momentum when uncorrected */
  SPH_STRESS_DIFFERENCE = 2,  /* sum m_j (sigma_j - sigma_i)/(rho_i rho_j) g~_ij: exact for linear
                               * stress when corrected, no natural traction condition; what
                               * reproduces He's one-dimensional tables, in no source's print */
  SPH_STRESS_CONSERVATIVE = 3 /* sum m_j (sigma_i B_i^-1/rho_i^2 + sigma_j B_j^-1/rho_j^2) g_ij:
                               * corrected and antisymmetric, momentum kept to rounding */
};

/* dv_i/dt from the stress in the form SPH_STRESS_*. dvdt: rows * dim. SPH_ERR_ARG also:
 * CONSERVATIVE without gradient_matrix. Since 0.1. */
SPH_API sph_status sph_stress_divergence(sph_neighbors *list, const sph_kernel *kernel,
                                         const sph_operands *a, int32_t form, double *dvdt);

/* Forms of dv_i/dt = -grad p / rho. Where g~ is g the first three conserve momentum. */
enum {
  SPH_PRESSURE_MASS = 1,      /* -sum m_j (p_i/rho_i^2 + p_j/rho_j^2) g~_ij (Sun 4.2.8) */
  SPH_PRESSURE_VOLUME = 2,    /* -(1/rho_i) sum V_j (p_i + p_j) g~_ij (Sun 4.2.9; Zisis 3.56 prints
                               * 1/(rho_j rho_j)) */
  SPH_PRESSURE_NUMBER = 3,    /* -(1/m_i) sum (V_i^2 p_i + V_j^2 p_j) g~_ij (Zisis 3.65) */
  SPH_PRESSURE_DIFFERENCE = 4 /* -(1/rho_i) sum V_j (p_j - p_i) g~_ij (Zisis 3.83, whose sign is
                               * wrong); not conservative */
};

/* dv_i/dt from the pressure in the form SPH_PRESSURE_*. dvdt: rows * dim. Since 0.1. */
SPH_API sph_status sph_pressure_gradient(sph_neighbors *list, const sph_kernel *kernel,
                                         const sph_operands *a, int32_t form, double *dvdt);

/* Artificial viscosity of Monaghan, He (3.16): where v_ij.x_ij < 0,
 *   Pi_ij = (-alpha c_ij phi_ij + beta phi_ij^2) / rho_ij,
 *   phi_ij = h_ij v_ij.x_ij / (r^2 + (0.1 h_ij)^2),
 * with arithmetic pair means c_ij, rho_ij and the pair's h_ij (rule AVERAGE: the arithmetic mean);
 * else 0. dv_i/dt = -sum m_j Pi_ij g~_ij. dvdt: rows * dim. Since 0.1. */
SPH_API sph_status sph_viscosity_monaghan(sph_neighbors *list, const sph_kernel *kernel,
                                          const sph_operands *a, double alpha, double beta,
                                          double *dvdt);

/* Viscous pressures q_i from the divergence of velocity; zero where it is not negative. Added up:
 *   von Neumann-Richtmyer   neumann dx^2 rho (div v)^2                           He (3.14)
 *   linear                  linear dx c rho |div v|                              He (3.15), sign
 *                                                                                wrong there
 *   Hernquist-Katz          hk_alpha h rho c |div v| + hk_beta h^2 rho (div v)^2   He (3.17)
 * with the particle's own h. */
typedef struct sph_bulk_viscosity {
  size_t size;     /* set by sph_bulk_viscosity_init() */
  double neumann;  /* a_1; default 0 */
  double linear;   /* a_2; default 0 */
  double spacing;  /* dx of the two above, a length; > 0 where one of them is not 0; default 0 */
  double hk_alpha; /* Hernquist-Katz alpha; default 0 */
  double hk_beta;  /* Hernquist-Katz beta; default 0 */
} sph_bulk_viscosity;

/* Fill *options with the defaults: no viscosity. Since 0.1. */
SPH_API void sph_bulk_viscosity_init_sized(sph_bulk_viscosity *options, size_t size);
#define sph_bulk_viscosity_init(o) sph_bulk_viscosity_init_sized((o), sizeof(sph_bulk_viscosity))

/* dv_i/dt = -sum m_j (q_i/rho_i^2 + q_j/rho_j^2) g~_ij. Particles at or beyond `rows` (ghosts) take
 * part with q_j = 0, for their divergence is not known. dvdt: rows * dim; q: rows, receives the
 * pressures, may be NULL. Two sweeps: div v by the difference form (with g~ too), then the force.
 * The list keeps dim^2 + 1 doubles a particle. SPH_ERR_ARG also: options NULL. Since 0.1. */
SPH_API sph_status sph_viscosity_bulk(sph_neighbors *list, const sph_kernel *kernel,
                                      const sph_operands *a, const sph_bulk_viscosity *options,
                                      double *q, double *dvdt);

/* Gray's artificial stress from a stress state, He (3.22) to (3.26): in the frame of the principal
 * stresses s_k, R_k = -epsilon s_k / rho^2 where s_k > 0, else 0, turned back. The angle is that of
 * atan2 (tan 2 theta, as printed, loses the branch). rho NULL: rho0 everywhere. sigma and R: n
 * packed symmetric tensors, which may be the same array. SPH_ERR_ARG: dim outside 1..3, n < 0,
 * NULL, rho0 not positive and finite, epsilon not finite. Takes no handle, so there is no sentence.
 * No cure for every lattice: rows of a square one under equal tension in both directions slide past
 * each other all the same, at h = 1.2 dp; those of a triangular one do not.
 * Pointwise, serial, O(n). Since 0.1. */
SPH_API sph_status sph_artificial_stress(int32_t dim, int64_t n, const double *sigma,
                                         const double *rho, double rho0, double epsilon, double *R);

/* XSPH: out_i = epsilon sum_j (m_j / rho_ij) (v_j - v_i) W_ij, rho_ij the pair mean, He (4.4);
 * usual epsilon 0.5. out: rows * dim, to be added to dx/dt. Since 0.1. */
SPH_API sph_status sph_xsph(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *a,
                            double epsilon, double *out);

/* ---- Total-Lagrangian operators --------------------------------------------------------------
 *
 * The operands describe the reference configuration: x are the reference positions X, on which the
 * list was built, m, rho and h the masses, densities and smoothing lengths there, gradient_matrix
 * the B^-1 of all n (sph_gradient_matrix() with rows = n). X_ij, V_j and g_ij belong to it too.
 * Current positions x and the tensors are extra arguments: n * dim and n * dim * dim, row-major.
 * The displacements u = x - X enter, so that small strains do not cancel, and a periodic axis wraps
 * X_ij alone.
 *
 * Each call first computes what the kernel says of each pair, which the list keeps room for (8
 * bytes a pair), and then sums: two sweeps. The composed right-hand side (rhs.h) computes it once.
 *
 * Sources: R. Vignjevic, J. Reveles, J. Campbell, CMES 14 (2006) 181; G. C. Ganzenmueller, Comput.
 * Methods Appl. Mech. Engrg. 286 (2015) 87. He (3.27), (3.28) prints a total-Lagrangian form with
 * the Cauchy stress in place of P, which is right for small deformations and rotations only. */

/* F_i = sum V_j (x_j - x_i) (x) g~_ij, computed as 1 + sum V_j (u_j - u_i) (x) g~_ij: the same
 * where B_i has an inverse; where it has none and the plain gradient stands in, a body at rest
 * still has F = 1. Exact for linear deformations. F: rows * dim * dim, F[a * dim + b] = d x_a / d
 * X_b. SPH_ERR_ARG also: x or gradient_matrix NULL. Since 0.1. */
SPH_API sph_status sph_deformation_gradient(sph_neighbors *list, const sph_kernel *kernel,
                                            const sph_operands *a, const double *x, double *F);

/* Forms of dv_i/dt from the first Piola-Kirchhoff stress. With a = V a0 the energy is sum V_i
 * psi(F_i). Published with m_j (P_i / rho_i^2 + P_j / rho_j^2), which is the same where the
 * reference density is uniform; where it is not, only the volumes below derive from an energy. */
enum {
  SPH_PIOLA_CONSERVATIVE = 1, /* (1/rho_i) sum V_j (P_i B_i^-1 + P_j B_j^-1) g_ij. Momentum is kept
                               * to rounding; with F of sph_deformation_gradient() and P = d psi / d
                               * F the force is minus the gradient of sum V_i psi(F_i), so that
                               * energy and, for objective psi, angular momentum are kept too */
  SPH_PIOLA_SUMMED = 2        /* (1/rho_i) sum V_j (P_i + P_j) g~_ij. Where gradient_matrix is NULL:
                               * g_ij, and momentum is kept; else exact in the interior for linear
                               * P. Neither derives from an energy */
};

/* dv_i/dt from P in the form SPH_PIOLA_*. P of all n. dvdt: rows * dim. SPH_ERR_ARG also: P NULL,
 * unknown form, CONSERVATIVE without gradient_matrix. Since 0.1. */
SPH_API sph_status sph_piola_divergence(sph_neighbors *list, const sph_kernel *kernel,
                                        const sph_operands *a, int32_t form, const double *P,
                                        double *dvdt);

/* Forms of hourglass control. F knows nothing of motions that are orthogonal to its sum, the
 * zero-energy modes. Springs draw each pair to where F says it should be. With the deviations
 *   e_i = F_i X_ij - x_ij  (e_j likewise with F_j)
 * and the moduli E_i = rho_i c_i^2, c the sound speed of the operands,
 *   m_i dv_i/dt = (alpha/2) sum V_i V_j s_ij (E_i e_i + E_j e_j). */
enum {
  /* All of e, s_ij = -(dW/dr)/r. F is the least-squares fit of the deformation with just these
   * weights, so that a change of F does no work, and the force is minus the gradient of
   *   (alpha/4) sum_i V_i E_i sum_j V_j s_ij |e_i|^2,
   * which is frame-indifferent: energy, momentum and angular momentum are kept. In the
   * composed right-hand side it rides on the stress. In no source. */
  SPH_HOURGLASS_VARIATIONAL = 1,
  /* The part of e along x_ij, s_ij = W / X_ij^2: Ganzenmueller (2015), where E is
   * Young's modulus: take c = sqrt(E / rho) for his figures. Central, so momentum and angular
   * momentum are kept; the work that a change of F does is left out, so energy is not. */
  SPH_HOURGLASS_CENTRAL = 2
};

/* dv_i/dt by hourglass control SPH_HOURGLASS_*. x, F: of all n. dvdt: rows * dim. energy: NULL, or
 * rows: of the springs of each particle, (alpha/4) V_i E_i sum_j V_j s_ij |e_i|^2 (CENTRAL: of the
 * part along x_ij). alpha around 0.1 to 1; it adds alpha rho c^2 of stiffness at most, to be
 * thought of in the time step. SPH_ERR_ARG also: x, F or gradient_matrix NULL, c missing, unknown
 * form, alpha negative or not finite. Since 0.1. */
SPH_API sph_status sph_hourglass_force(sph_neighbors *list, const sph_kernel *kernel,
                                       const sph_operands *a, int32_t form, double alpha,
                                       const double *x, const double *F, double *dvdt,
                                       double *energy);

#ifdef __cplusplus
}
#endif
#endif
