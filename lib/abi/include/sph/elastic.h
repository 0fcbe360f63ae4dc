/* Elastic materials: Hooke's law as a rate and in total form, hyperelastic laws, wave speeds. */
#ifndef SPH_ELASTIC_H
#define SPH_ELASTIC_H

#include <sph/material.h>
#include <sph/stress.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How a law is reduced to fewer dimensions. For Hooke's law with E, nu, G = E/(2(1+nu)),
 * K = E/(3(1-2nu)) and lambda = K - 2G/3, the rates of the stored components are
 *
 *   UNIAXIAL_STRESS  1-D  xx' = E D_xx. Lateral stress zero: D_yy = D_zz = -nu D_xx.
 *   UNIAXIAL_STRAIN  1-D  xx' = (lambda + 2G) D_xx. Lateral strain zero.
 *   PLANE_STRESS     2-D  xx' = E/(1-nu^2) (D_xx + nu D_yy), xy' = 2G D_xy.
 *                         zz stress zero: D_zz = -nu/(1-nu) (D_xx + D_yy).
 *   PLANE_STRAIN     2-D  xx' = (lambda + 2G) D_xx + lambda D_yy, xy' = 2G D_xy. D_zz = 0.
 *                         The stress zz is not zero, but not stored: nothing elastic in the
 *                         plane depends on it, and zz = nu (xx + yy) for small strains.
 *                         Plasticity does, and keeps it (plasticity.h).
 *   SOLID            3-D  all of sigma' = 2G (D - tr(D) I/3) + K tr(D) I.
 *
 * All are that last formula with the D_zz given (and D_yy in 1-D). The trace must include
 * these: He and Seaid, Acta Mech. 227 (2016), text at eq. (7), give tr(D) = D_xx + D_yy beside
 * the plane-stress matrix, which would be two different materials. The 1/3 of the deviator
 * stays 1/3 in every dimension. */
enum {
  SPH_UNIAXIAL_STRESS = 1,
  SPH_UNIAXIAL_STRAIN = 2,
  SPH_PLANE_STRESS = 3,
  SPH_PLANE_STRAIN = 4,
  SPH_SOLID = 5
};

typedef struct sph_hooke_options {
  size_t size;       /* set by sph_hooke_options_init() */
  double young;      /* E > 0, a stress; must be given */
  double poisson;    /* -1 < nu < 0.5; default 0 */
  double density;    /* reference density > 0, for the wave speed; must be given */
  int32_t reduction; /* SPH_UNIAXIAL_STRESS ... SPH_SOLID; default UNIAXIAL_STRESS */
  int32_t jaumann;   /* nonzero: Jaumann rate (2-D, 3-D; no effect in 1-D); default 1 */
} sph_hooke_options;
/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_hooke_options_init_sized(sph_hooke_options *options, size_t size);
#define sph_hooke_options_init(o) sph_hooke_options_init_sized((o), sizeof(sph_hooke_options))

/* Isotropic Hooke in rate form, reduced to the dimension as said by `reduction` (formulas
 * there): sigma' = 2G D' + K tr(D) I, and with the Jaumann rate + omega sigma - sigma omega.
 * In 2-D, with w = (L_xy - L_yx)/2, that adds 2 w s_xy (xx), -2 w s_xy (yy), w (s_yy - s_xx)
 * (xy). With L_ab = d v_a / d x_b a rigid rotation R turns sigma into R sigma R^T; the opposite
 * sign convention of L does not. The reference is L. He, PhD thesis, Durham 2015, (3.4), (3.5).
 *
 * The stress rate needs velocity_gradient, and sigma when the Jaumann rate is on in 2-D and 3-D.
 * The sound speed needs no array: it is the longitudinal wave speed of the reduction at the
 * reference density, sqrt(E/rho) for uniaxial stress, sqrt(E/((1-nu^2) rho)) for plane stress,
 * sqrt((lambda + 2G)/rho) for the others. The wave speed sqrt(E/rho) that the sources use in
 * every dimension is too low in 2-D and 3-D. The shear speed is sqrt(G/rho). There is no pressure
 * law.
 *
 * The total form for small strains, sigma = 2G strain + lambda tr(strain) I with the strains
 * across of the reduction, needs strain (L. He, (A.27) to (A.29)). first_piola and cauchy_stress
 * are that stress of the strain (F + F^T)/2 - I, with psi = sigma:strain/2: a linear material
 * for total-Lagrangian schemes, right for small strains and small rotations only.
 *
 * *out is NULL on failure. SPH_ERR_ARG: constants out of range or not finite, an unknown
 * reduction. SPH_ERR_VERSION, SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_material_create_hooke(sph_context *ctx, const sph_hooke_options *options,
                                             sph_material **out);

/* A time step of stresses outside any integrator, with the exact rotation of the frame:
 *
 *   sigma <- R2 (R2 sigma R2^T + dt sigma'(D)) R2^T,   R2 R2 = R,
 *
 * where sigma'(D) is the law's stress rate for the strain rate alone, without spin, and R the
 * rotation of the step (stress.h). With the velocity gradient of the middle of the step, of second
 * order; a rigid rotation changes no principal stress beyond rounding, however long the step. (The
 * rate form in an integrator turns stresses as well as the integrator does; figures at
 * sph_stress_rotate().) A law's own Jaumann switch makes no difference here.
 *
 *   block     velocity_gradient, and rho, e and others if the law needs them; its sigma is unread
 *   rotation  SPH_ROTATION_EXPONENTIAL or SPH_ROTATION_CAYLEY; no difference in 1-D
 *   sigma     n packed symmetric, advanced
 *   across    NULL, or n: the stress across (sph_material_stress_rate_across()), advanced
 *
 * Serial, O(n), no memory; disjoint blocks may be run on several threads if no call fails. Errors
 * as for sph_material_stress_rate(); SPH_ERR_ARG also for dt not finite, an unknown rotation.
 * When a host's law fails, the particles before the failing run of 64 are already advanced.
 * Since 0.1. */
SPH_API sph_status sph_material_stress_update(const sph_material *material,
                                              const sph_material_block *block, double dt,
                                              int32_t rotation, double *sigma, double *across);

/* Rate of the stress across in plane strain (zz) and uniaxial strain (yy = zz): lambda tr(D) for
 * Hooke's law. rate: n. An elastic body needs it only for output; plasticity, which depends on it,
 * keeps it as state. In plane and uniaxial stress it is 0. SPH_ERR_UNSUPPORTED: 3-D laws, laws
 * without it. Other errors as for sph_material_stress_rate(). Since 0.1. */
SPH_API sph_status sph_material_stress_rate_across(const sph_material *material,
                                                   const sph_material_block *block, double *rate);

/* Laws with a stored energy, for total-Lagrangian schemes. Both have Hooke's law as their limit
 * for small strains, with lambda = E nu/((1+nu)(1-2nu)) and mu = E/(2(1+nu)), and both are
 * objective: P(QF) = Q P(F) for every rotation Q.
 *
 *   ST_VENANT_KIRCHHOFF  psi = lambda/2 tr(G)^2 + mu G:G with G = (F^T F - I)/2,
 *                        P = F (lambda tr(G) I + 2 mu G). For large rotations and small strains:
 *                        under compression it softens, below a stretch of 1/sqrt(3) it collapses.
 *   NEO_HOOKEAN          psi = mu/2 (F:F - 3) - mu ln J + lambda/2 (ln J)^2,
 *                        P = mu (F - F^-T) + lambda ln J F^-T. For large strains.
 *
 * Sources: Bonet, Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd ed. 2008,
 * (6.27) to (6.29); Holzapfel, Nonlinear Solid Mechanics, 2000, (6.151). */
enum { SPH_ST_VENANT_KIRCHHOFF = 1, SPH_NEO_HOOKEAN = 2 };

typedef struct sph_hyperelastic_options {
  size_t size;       /* set by sph_hyperelastic_options_init() */
  int32_t law;       /* SPH_ST_VENANT_KIRCHHOFF or SPH_NEO_HOOKEAN; default NEO_HOOKEAN */
  double young;      /* E > 0; must be given */
  double poisson;    /* -1 < nu < 0.5; default 0 */
  double density;    /* density before the deformation > 0, for wave speeds; must be given */
  int32_t reduction; /* SPH_UNIAXIAL_STRESS ... SPH_SOLID; default SOLID */
} sph_hyperelastic_options;
/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_hyperelastic_options_init_sized(sph_hyperelastic_options *options, size_t size);
#define sph_hyperelastic_options_init(o) \
  sph_hyperelastic_options_init_sized((o), sizeof(sph_hyperelastic_options))

/* A hyperelastic material; properties first_piola and cauchy_stress, which need F, and the wave
 * speeds. In one and two dimensions F is completed to 3x3 by the reduction:
 *
 *   PLANE_STRAIN, UNIAXIAL_STRAIN   F = 1 across.
 *   PLANE_STRESS, UNIAXIAL_STRESS   the stretch t across (both, in 1-D) that makes P zero there.
 *     St. Venant-Kirchhoff: t^2 = 1 + 2 G_zz with G_zz = -nu/(1-nu) (G_xx + G_yy), in 1-D
 *     G_yy = G_zz = -nu G_xx; where that is not positive the faces would meet: an error.
 *     Neo-Hookean: mu (t^2 - 1) + lambda ln J = 0, by Newton's method, monotone from the side
 *     where it cannot fail, to rounding. There is a t for every F unless nu is negative.
 *
 * psi is per undeformed volume and includes the parts across; since P is zero along t, P = d
 * psi/dF holds in every reduction. F = I gives zero to the bit; psi keeps its relative accuracy
 * for small strains.
 *
 * The wave speeds are per undeformed length and time, for steps of total-Lagrangian schemes, at
 * the density before the deformation. Without deformation_gradient in the block they are those at
 * rest, as for Hooke's law. With it, those of small waves on the present state along its principal
 * directions i, the largest of
 *
 *   longitudinal  rho c^2 = d^2 psi / d l_i^2, l_i the principal stretches, psi reduced
 *   shear         rho c^2 = (l_i psi_i - l_j psi_j)/(l_i^2 - l_j^2), psi_i = d psi / d l_i, j in
 *                 the space of the reduction (R. Ogden, Non-Linear Elastic Deformations, 1984,
 *                 6.4); shear_speed is of these alone, in 1-D sqrt(mu/rho)
 *
 * squares that are negative, where the material is not stable, left out; 0 when all are.
 *
 * *out is NULL on failure. SPH_ERR_ARG: constants out of range or not finite, an unknown law or
 * reduction. SPH_ERR_VERSION, SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_material_create_hyperelastic(sph_context *ctx,
                                                    const sph_hyperelastic_options *options,
                                                    sph_material **out);

#ifdef __cplusplus
}
#endif
#endif
