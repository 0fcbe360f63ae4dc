/* Materials: pointwise laws between strain, density, energy and stress.
 *
 * A material is stateless: all it needs comes in as arrays, so one handle serves any number of
 * particles and threads. Ready laws: elastic.h (Hooke, hyperelastic), eos.h (equations of state),
 * plasticity.h (von Mises; strength on top of an equation of state). Hosts supply their own law
 * as a table of callbacks on blocks.
 *
 * A law has some of the properties below; asking for one that it does not have is
 * SPH_ERR_UNSUPPORTED. With L_ab = d v_a / d x_b, the strain rate is D = (L + L^T)/2 and the spin
 * omega = (L - L^T)/2. With positions X before the deformation, F_ab = d x_a / d X_b. */
#ifndef SPH_MATERIAL_H
#define SPH_MATERIAL_H

#include <sph/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A block of n particles. Arrays that a law does not need may be NULL; those it needs and that
 * are NULL are an SPH_ERR_ARG of the caller (not when n is 0). Arrays are the caller's, read and
 * not kept.
 *
 * Numbers for which a law is not defined (det F or a density that is not positive, an energy below
 * its range; each law says which) are SPH_ERR_NUMERIC: the sentence names the first such particle
 * and the outputs are untouched. Other numbers are taken as they come: a NaN gives NaN for its own
 * particle only. */
typedef struct sph_material_block {
  size_t size;                        /* set by sph_material_block_init() */
  int32_t dim;                        /* 1, 2 or 3; default 0, which is refused */
  int64_t n;                          /* default 0 */
  const double *velocity_gradient;    /* n * dim * dim */
  const double *sigma;                /* n packed symmetric */
  const double *rho;                  /* n */
  const double *e;                    /* n: specific internal energy */
  const double *deformation_gradient; /* n * dim * dim */
  const double *strain;               /* n packed symmetric: small strain, xy = (u_x,y + u_y,x)/2 */
  const double *p;                    /* n: pressure, where the energy is asked for */
} sph_material_block;

/* Fill *block with the defaults: no particles, all arrays NULL. Since 0.1. */
SPH_API void sph_material_block_init_sized(sph_material_block *block, size_t size);
#define sph_material_block_init(b) sph_material_block_init_sized((b), sizeof(sph_material_block))

/* A host's law. Entries may be NULL: the law then does not have that property. Callbacks are pure
 * and may run on several threads at once on disjoint blocks; they are not called for empty blocks.
 * They write n entries, in the shapes of the calls below, and look themselves for arrays of the
 * block that are NULL. Return 0; a positive return asks for a smaller step (SPH_RETRY), a negative
 * one is SPH_ERR_CALLBACK. */
typedef struct sph_material_functions {
  size_t size; /* set by sph_material_functions_init() */
  int32_t (*stress_rate)(void *user, const sph_material_block *block, double *dsigma);
  int32_t (*pressure)(void *user, const sph_material_block *block, double *p);
  int32_t (*sound_speed)(void *user, const sph_material_block *block, double *c);
  void (*destroy)(void *user); /* called once, when the last reference goes; may be NULL */
  int32_t (*first_piola)(void *user, const sph_material_block *block, double *P,
                         double *energy); /* energy may be NULL */
  int32_t (*cauchy_stress)(void *user, const sph_material_block *block, double *sigma);
  int32_t (*small_strain_stress)(void *user, const sph_material_block *block, double *sigma);
  int32_t (*shear_speed)(void *user, const sph_material_block *block, double *c);
  int32_t (*stress_rate_across)(void *user, const sph_material_block *block, double *rate);
  int32_t (*temperature)(void *user, const sph_material_block *block, double *temperature);
  int32_t (*energy)(void *user, const sph_material_block *block, double *e);
  int32_t (*pressure_derivatives)(void *user, const sph_material_block *block, double *dp_drho,
                                  double *dp_de); /* either may be NULL */
  int32_t (*plastic_return)(void *user, const sph_material_block *block, double *sigma,
                            double *across, double *plastic_strain,
                            double *plastic_work); /* all but sigma may be NULL */
} sph_material_functions;

/* Fill *f with the defaults: every entry NULL. Since 0.1. */
SPH_API void sph_material_functions_init_sized(sph_material_functions *f, size_t size);
#define sph_material_functions_init(f) \
  sph_material_functions_init_sized((f), sizeof(sph_material_functions))

/* A host's own material; the table is copied, `user` is passed to every callback. *out is NULL
 * on failure; `user` then stays the caller's, and `destroy` is not called.
 * SPH_ERR_ARG: every law of the table is NULL. SPH_ERR_VERSION, SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_material_create(sph_context *ctx, const sph_material_functions *functions,
                                       void *user, sph_material **out);

/* Give up the caller's reference; what uses the material keeps its own. NULL is allowed.
 * Since 0.1. */
SPH_API void sph_material_destroy(sph_material *material);

/* d sigma/dt from velocity gradient and stress (and density). dsigma: n packed symmetric; for
 * built-in laws it may be the block's sigma array. Serial, O(n).
 * SPH_ERR_ARG: an array the law needs is NULL, dim outside 1..3, n < 0, or the law is for
 * another dimension. SPH_ERR_UNSUPPORTED: the law has no stress rate. SPH_ERR_NUMERIC: see
 * sph_material_block. SPH_RETRY, SPH_ERR_CALLBACK: what a host's law answered; dsigma is as that
 * left it. SPH_ERR_VERSION. Since 0.1. */
SPH_API sph_status sph_material_stress_rate(const sph_material *material,
                                            const sph_material_block *block, double *dsigma);
/* p from density and energy. p: n. Errors as above. Since 0.1. */
SPH_API sph_status sph_material_pressure(const sph_material *material,
                                         const sph_material_block *block, double *p);
/* Sound speed, or the longitudinal wave speed of a solid. c: n. Errors as above. Since 0.1. */
SPH_API sph_status sph_material_sound_speed(const sph_material *material,
                                            const sph_material_block *block, double *c);
/* Speed of shear waves. c: n. Errors as above. Since 0.1. */
SPH_API sph_status sph_material_shear_speed(const sph_material *material,
                                            const sph_material_block *block, double *c);
/* Stress from small strain. sigma: n packed symmetric; may be the block's strain array for
 * built-in laws. Errors as above. Since 0.1. */
SPH_API sph_status sph_material_small_strain_stress(const sph_material *material,
                                                    const sph_material_block *block, double *sigma);

/* First Piola-Kirchhoff stress P_ab = d psi / d F_ab, force a per undeformed area with normal b,
 * from deformation gradients. F, P: n * dim * dim, row-major; P may be F for built-in laws.
 * energy: NULL, or n: psi, per undeformed volume. Serial, O(n).
 *
 * SPH_ERR_NUMERIC: det F is not positive, or in plane or uniaxial stress no thickness frees the
 * faces of stress; the sentence names the first such particle, outputs are untouched. Other
 * errors as for sph_material_stress_rate(). Since 0.1. */
SPH_API sph_status sph_material_first_piola(const sph_material *material, int32_t dim, int64_t n,
                                            const double *F, double *P, double *energy);
/* Cauchy stress from deformation gradients: sigma = P F^T / J, where J includes the change of
 * thickness in plane and uniaxial stress. F: n * dim * dim. sigma: n packed symmetric. Errors as
 * for sph_material_first_piola(). Since 0.1. */
SPH_API sph_status sph_material_cauchy_stress(const sph_material *material, int32_t dim, int64_t n,
                                              const double *F, double *sigma);

#ifdef __cplusplus
}
#endif
#endif
