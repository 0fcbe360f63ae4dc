/* Plasticity: the yield criterion of von Mises with radial return, and strength (a deviatoric
 * stress with a yield stress) on top of an equation of state. */
#ifndef SPH_PLASTICITY_H
#define SPH_PLASTICITY_H

#include <sph/elastic.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Return stresses to the yield surface after an elastic step.
 *
 *   sigma           n packed symmetric: in, the elastic trial stress; out, the stress
 *   across          n: the stress zz in plane strain, yy = zz in uniaxial strain (its elastic rate
 *                   is sph_material_stress_rate_across()), in and out. There SPH_ERR_ARG if NULL;
 *                   elsewhere unread
 *   plastic_strain  n: accumulated plastic strain, the integral of sqrt(2/3 dp:dp) with dp the
 *                   plastic strain increment, in and out. May be NULL without hardening
 *   plastic_work    NULL, or n: plastic work per volume, added to
 *
 * Every array is written for particles that yield only. A NaN is left where it is. Serial, O(n), no
 * memory; disjoint ranges may run on several threads. Apply it to every copy of the stress that an
 * integrator keeps between steps.
 * SPH_ERR_ARG: dim outside 1..3, n < 0, the law is for another dimension. SPH_ERR_UNSUPPORTED: the
 * law has no yield surface. SPH_RETRY, SPH_ERR_CALLBACK: a host's law. Since 0.1. */
SPH_API sph_status sph_material_plastic_return(const sph_material *material, int32_t dim, int64_t n,
                                               double *sigma, double *across,
                                               double *plastic_strain, double *plastic_work);

typedef struct sph_von_mises_options {
  size_t size;       /* set by sph_von_mises_options_init() */
  double young;      /* E > 0; must be given */
  double poisson;    /* -1 < nu < 0.5; default 0 */
  double density;    /* reference density > 0, for wave speeds; must be given */
  double yield;      /* yield stress in uniaxial tension, > 0; must be given */
  double hardening;  /* H = d(yield stress)/d(plastic strain) >= 0; default 0: perfect plasticity */
  int32_t reduction; /* SPH_UNIAXIAL_STRESS ... SPH_SOLID; default UNIAXIAL_STRESS */
  int32_t jaumann;   /* as for Hooke's law; default 1 */
} sph_von_mises_options;
/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_von_mises_options_init_sized(sph_von_mises_options *options, size_t size);
#define sph_von_mises_options_init(o) \
  sph_von_mises_options_init_sized((o), sizeof(sph_von_mises_options))

/* Hooke's law with the yield criterion q <= Y, q = sqrt(3/2 s:s) the equivalent stress, Y = yield +
 * H * plastic strain, and the associated flow rule. Its stress rate and wave speeds are the elastic
 * ones, as of sph_material_create_hooke(); the plastic part is sph_material_plastic_return() after
 * each step (or sph_material_stress_update()). The return is the implicit Euler step of the flow
 * rule, the closest point in the energy norm; after it q = Y to rounding:
 *
 *   SOLID, PLANE_STRAIN, UNIAXIAL_STRAIN   radial: the pressure stays, the deviator of the 3x3
 *     stress is scaled by Y/q, the plastic strain grows by (q - Y)/(3G + H).
 *   PLANE_STRESS   zz stays zero, so the thickness strain must yield with the plane and scaling the
 *     stress would not be consistent: with the multiplier x >= 0
 *         xx + yy  <-  (xx + yy)/(1 + E x/(3(1 - nu)))
 *         xx - yy, xy  <-  the same/(1 + 2G x),   plastic strain += 2/3 x q,
 *     x from q = Y by Newton's method, monotone since the left side is convex.
 *   UNIAXIAL_STRESS   plastic strain += (|xx| - Y)/(E + H).
 *
 * The plastic work of a return is the plastic strain times the mean of Y before and after.
 * Source: J. Simo, T. Hughes, Computational Inelasticity, 1998, boxes 3.2 and 3.3 (their
 * multiplier is x).
 *
 * *out is NULL on failure. SPH_ERR_ARG: constants out of range or not finite, an unknown
 * reduction. SPH_ERR_VERSION, SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_material_create_von_mises(sph_context *ctx,
                                                 const sph_von_mises_options *options,
                                                 sph_material **out);

typedef struct sph_strength_options {
  size_t size;          /* set by sph_strength_options_init() */
  double shear;         /* shear modulus G > 0; must be given */
  double yield;         /* yield stress in uniaxial tension, > 0; default INFINITY: elastic */
  double hardening;     /* H >= 0; default 0: perfect plasticity */
  int32_t trace_by_dim; /* nonzero: tr(D)/dim in the deviator instead of tr(D)/3; default 0 */
  int32_t limit_rate;   /* nonzero: the rate itself stops at the yield surface; default 0 */
  int32_t jaumann;      /* as for Hooke's law; default 1 */
} sph_strength_options;
/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_strength_options_init_sized(sph_strength_options *options, size_t size);
#define sph_strength_options_init(o) \
  sph_strength_options_init_sized((o), sizeof(sph_strength_options))

/* A solid under shock: stress sigma = S - p I, p from an equation of state, S here. For 1-D, 2-D
 * and 3-D unless `eos` is for one of them. `sigma` of the block and of the calls is S alone.
 *
 *   stress rate     S' = 2G (D - tr(D)/3 I) + omega S - S omega (the last two: jaumann)
 *   plastic return  S <- S min(1, Y/q), q = sqrt(3/2 S:S), with hardening as for von Mises above
 *   pressure, temperature, energy and derivatives: of `eos`, which is retained
 *   sound speed     sqrt(c^2 + 4G/(3 rho)), c of `eos`; shear speed sqrt(G/rho)
 *
 * In fewer dimensions this is plane and uniaxial strain: S has trace zero, so the components across
 * are known, S_zz = -(S_xx + S_yy) in 2-D, S_yy = S_zz = -S_xx/2 in 1-D, and enter q; `across` of
 * the return is unread. trace_by_dim is the form that the source computes with in 2-D: the trace
 * in the plane vanishes, S_zz = 0, and the sound speed has 2G(1 - 1/dim)/rho instead of
 * 4G/(3 rho). In 1-D there would be no S at all.
 *
 * limit_rate: where q >= Y and the rate points outward, its outward part is taken away, S' -= 2G
 * (S:D')/(S:S) S with D' the deviator of D (Prandtl, Reuss). For integrators with several
 * stages, beside the return, which removes what drifts off. Only without hardening.
 *
 * Source: I. Zisis, PhD thesis, Eindhoven 2017, section 6.1. Its (6.7) prints G for 2G, its (6.14)
 * the factor Y/(3 S:S), which has the unit 1/stress; both are mended here. The factor Y^2/(3 J2),
 * J2 = S:S/2, of Libersky and others is the square of ours and overshoots: it turns q = 4.99 at
 * Y = 1.70 into 0.58, not 1.70.
 *
 * *out is NULL on failure. SPH_ERR_ARG: constants out of range, `eos` without pressure or sound
 * speed, limit_rate with hardening. SPH_ERR_VERSION, SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_material_create_strength(sph_context *ctx, sph_material *eos,
                                                const sph_strength_options *options,
                                                sph_material **out);

#ifdef __cplusplus
}
#endif
#endif
