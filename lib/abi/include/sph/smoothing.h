/* Compressible flow and solids under shock: one set of operators for three smoothings, with
 * smoothing lengths that differ from particle to particle, and the dissipation that shocks need.
 *
 * Notation as in operators.h, but nothing here has one h for a pair: W_ij(h) is W(r_ij, h), dW(h)
 * its gradient with respect to x_i, (x_ij / r) dW/dr, zero at r = 0. Sums over density take h_i
 * alone (gather), forces h_i and h_j. So a list must hold every pair with r < support max(h_i,
 * h_j): rule SPH_H_MAX or SPH_H_AVERAGE, or any rule where h is the same everywhere. d is the
 * dimension, n_i = rho_i / m_i the number density.
 *
 * What is smoothed:
 *
 *                 density                rate of density                    a_i     b_j
 *   MASS          sum m_j W_ij           sum m_j v_ij.dW_ij / omega_i       1       m_j
 *   VOLUME        none                   rho_i sum V_j v_ij.dW_ij / omega_i rho_i   m_j / rho_j
 *   NUMBER        m_i sum W_ij           m_i sum v_ij.dW_ij / omega_i       m_i     1
 *
 * With the weights a and b all three are one scheme:
 *
 *   omega_i    = 1 + (h_i a_i / (d rho_i)) sum_j b_j dW/dh(r_ij, h_i), i included
 *   drho_i/dt  = (a_i / omega_i) sum_j b_j v_ij.dW_ij(h_i)
 *   dv_i/dt    = -(1/m_i) sum_j [Q_i b_j dW_ij(h_i) + Q_j b_i dW_ij(h_j)],
 *   Q_i        = m_i a_i P_i / (omega_i rho_i^2)
 *   de_i/dt    = (P_i / rho_i^2) drho_i/dt
 *
 * The force is minus the transpose of the rate of density, weighted with m P / rho^2. So momentum,
 * angular momentum and sum m (v^2/2 + e) are kept to rounding, whatever h, m, P and omega are:
 * an error in omega costs accuracy, not conservation. omega is the derivative of the density with
 * h = eta (m / rho)^(1/d); where h is fixed it is 1. dW/dh = -(d W + r dW/dr) / h.
 *
 * Where all masses are equal MASS and NUMBER are the same scheme, and give the same bits. Choose
 * NUMBER where masses differ: MASS smears the mass of a heavy neighbour into a light particle, the
 * density then jumps at a contact between particles of the same density. VOLUME has no potential.
 *
 * Deviator tau of the stress sigma = -P 1 + tau, by h_i and h_j, without omega, for any smoothing:
 *
 *   dv_i/dt   += (1/rho_i) sum_j V_j [tau_i.dW_ij(h_i) + tau_j.dW_ij(h_j)]
 *   de_i/dt   += -(1/rho_i) sum_j V_j v_ij.tau_i.dW_ij(h_i) = tau_i : L_i / rho_i
 *   L_i        = sum_j V_j (v_j - v_i) (x) dW_ij(h_i)
 *
 * keeps momentum and energy; not angular momentum, for the force is not along the pair.
 *
 * Dissipation. With dWm = (dW_ij(h_i) + dW_ij(h_j)) / 2, rho_ij, c_ij arithmetic means, r_ij the
 * unit vector, u = v_ij.r_ij and the sums over the pairs with u < 0 (or over all):
 *
 *   drho_i/dt += sum_j (m_j / rho_ij) a_rho (P_i - P_j) / s_rho  r_ij.dWm            mass flux
 *   dv_i/dt   += sum_j (m_j / rho_ij) a_v s_v u  dWm                                 viscosity
 *   de_i/dt   -= sum_j (m_j / rho_ij) [a_v s_v u^2 / 2 - a_e s_e (e_i - e_j)] r_ij.dWm
 *
 * heating is never negative and balances the kinetic energy that is lost; conduction keeps sum m e
 * and lets sum m e^2 fall; the mass flux evens out pressures and keeps sum m rho. The signal speed
 * s of each has its own b:
 *
 *   SOUND     s = c_ij - (b/2) u                                        Zisis (4.22)
 *   GENERAL   s = sqrt(c_i^2 + b u^2) + sqrt(c_j^2 + b u^2) - u          Zisis (4.24)
 *
 * GENERAL is about twice SOUND where u is small. In pairs that recede u counts as 0 here, so that s
 * is never negative. A limit of the continuum: psi diffuses with a s h k, k = .564, .665, .752 for
 * the Gaussian in 1-D, 2-D, 3-D, all pairs.
 *
 * The flux of mass does no work here: P / rho^2 multiplies the reversible drho alone. Fed the whole
 * rate, as Zisis (6.3) reads literally, energy leaks.
 *
 * Source: I. Zisis, PhD thesis, Eindhoven 2017: (3.38) to (3.65), (4.1) to (4.28), (6.2) to (6.9).
 * What it prints wrongly:
 *   (3.27)  de = P d(1/rho); the sign is minus
 *   (3.56)  1/(rho_j rho_j) for 1/(rho_i rho_j)
 *   (4.6)   a density sum for VOLUME, rho_i = rho_i sum W m, that is no equation for rho; there is
 *           none
 *   (4.7)   lacks the difference x_i - x_j of the positions' variations; (4.14) has it
 *   (4.8)   exponent 1/3 for 1/d
 *   (4.15)  (m / rho) at i; it is at j
 *   (4.25)  sign, and 1/|x_ij| missing
 *   (4.26)  v' in the condition for v_ij
 *   (4.28)  plus before the conductivity: energy would flow to where there is more of it
 *   (6.9)   v_i - v_j for v_j - v_i: minus the gradient
 *   The text contradicts itself on the signal speed. (4.22) is the default here: (4.24) lets shocks
 *   run ahead. */
#ifndef SPH_SMOOTHING_H
#define SPH_SMOOTHING_H

#include <sph/base.h>
#include <sph/operators.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { SPH_SMOOTHING_MASS = 1, SPH_SMOOTHING_VOLUME = 2, SPH_SMOOTHING_NUMBER = 3 };

/* Every operator below answers what those of operators.h answer, and SPH_ERR_ARG for an unknown
 * smoothing and for a list that does not reach the larger h of a pair. Operands: x, h and m (which
 * may be uniform); beyond these
 *
 *   sph_smoothed_density      -
 *   sph_grad_h                rho
 *   sph_smoothed_pressure     rho, p, omega; v where drho or dedt is wanted
 *   sph_smoothed_stress       rho, sigma (the deviator); v where dedt or gradv is wanted
 *   sph_smoothed_dissipation  rho, c, v; p with mass flux or the conductivity of PRESSURE; e with
 *                             conductivity
 *
 * omega is NULL with omega0 = 0 where h is fixed. Ghosts need it as they need P. gradient_matrix is
 * not looked at. Outputs are overwritten; one that is NULL is not wanted, but one must be given. */

/* The density of MASS or NUMBER by the sum above, i included. rho: rows. With rho and h coupled by
 * h = eta (m / rho)^(1/d) see adapt.h. SPH_ERR_UNSUPPORTED: VOLUME, which has no such sum: the
 * volumes ask for the densities that are sought. One light sweep. Since 0.1. */
SPH_API sph_status sph_smoothed_density(sph_neighbors *list, const sph_kernel *kernel,
                                        const sph_operands *a, int32_t smoothing, double *rho);

/* The factor omega of h that follows the density. `rho` of the operands enters, so that it also
 * serves densities that are integrated in time and differ from the sum. At a jump of rho or m,
 * where they do, omega may come near zero or below: it is raised to omega_floor (0.2 is usual; 0:
 * left as it is). omega: rows. SPH_ERR_ARG also: omega_floor negative or not finite. One
 * light sweep. Since 0.1. */
SPH_API sph_status sph_grad_h(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *a,
                              int32_t smoothing, double omega_floor, double *omega);

/* The reversible part: rates of density and energy, acceleration from the pressure. drho, dedt:
 * rows; dvdt: rows * dim; any may be NULL. Since 0.1. */
SPH_API sph_status sph_smoothed_pressure(sph_neighbors *list, const sph_kernel *kernel,
                                         const sph_operands *a, int32_t smoothing, double *drho,
                                         double *dvdt, double *dedt);

/* The deviator: acceleration, rate of energy, velocity gradient L by h_i. `sigma` of the operands
 * is tau; in 2-D its components in the plane. dvdt: rows * dim; dedt: rows; gradv: rows * dim *
 * dim, row-major; any may be NULL. Since 0.1. */
SPH_API sph_status sph_smoothed_stress(sph_neighbors *list, const sph_kernel *kernel,
                                       const sph_operands *a, double *dvdt, double *dedt,
                                       double *gradv);

/* Signal speeds. */
enum { SPH_SIGNAL_SOUND = 1, SPH_SIGNAL_GENERAL = 2 };
/* Speed s_e of the conductivity. */
enum {
  SPH_CONDUCTIVITY_SIGNAL = 1,  /* a signal speed as above */
  SPH_CONDUCTIVITY_PRESSURE = 2 /* sqrt(|P_i - P_j| / rho_ij), after Price: none across a contact,
                                 * where e jumps and P does not. conductivity_b is not read */
};
enum { SPH_PAIRS_APPROACHING = 1, SPH_PAIRS_ALL = 2 };
/* Pressures in the mass flux. */
enum {
  SPH_FLUX_SIGNED = 1,  /* P */
  SPH_FLUX_POSITIVE = 2 /* max(P, 0): a liquid in tension does not drain the gas beside it */
};

typedef struct sph_dissipation {
  size_t size;           /* set by sph_dissipation_init() */
  double viscosity;      /* a_v >= 0; default 1 */
  double viscosity_b;    /* b of its signal speed >= 0; default 2, likewise below */
  double conductivity;   /* a_e >= 0; default 0.1 */
  double conductivity_b; /* */
  double mass_flux;      /* a_rho >= 0; default 0.5. Densities by summation need none: 0 */
  double mass_flux_b;
  int32_t signal;            /* SPH_SIGNAL_*; default SOUND */
  int32_t conductivity_form; /* SPH_CONDUCTIVITY_*; default SIGNAL */
  int32_t pairs;             /* SPH_PAIRS_*; default APPROACHING */
  int32_t flux_form;         /* SPH_FLUX_*; default SIGNED */
  /* |drho_i| of the mass flux is cut to flux_limit rho_i c_i / h_i; 0: not at all. Default 0.1.
   * Without it, and with SIGNED, a liquid in tension drains a gas beside it to rho <= 0. A cut rate
   * is not matched by that of its neighbours: where it acts, sum m rho is no longer kept, while
   * mass, momentum and energy are. POSITIVE keeps it. */
  double flux_limit;
} sph_dissipation;

/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_dissipation_init_sized(sph_dissipation *options, size_t size);
#define sph_dissipation_init(o) sph_dissipation_init_sized((o), sizeof(sph_dissipation))

/* Mass flux into drho, viscosity into dvdt, heating and conduction into dedt. options NULL: the
 * defaults. drho, dedt: rows; dvdt: rows * dim; any may be NULL. A pair without a signal speed (c
 * and b u both 0) has no flux of mass. SPH_ERR_ARG also: a coefficient negative or not finite, an
 * unknown choice. Since 0.1. */
SPH_API sph_status sph_smoothed_dissipation(sph_neighbors *list, const sph_kernel *kernel,
                                            const sph_operands *a, const sph_dissipation *options,
                                            double *drho, double *dvdt, double *dedt);

#ifdef __cplusplus
}
#endif
#endif
