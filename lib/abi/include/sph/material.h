/* Materials: pointwise laws between strain, density, energy and stress.
 *
 * A material is stateless: all it needs comes in as arrays, so one handle serves any number of
 * particles and threads. Hosts supply their own law as a table of callbacks on blocks.
 *
 * With L_ab = d v_a / d x_b, the strain rate is D = (L + L^T)/2 and the spin
 * omega = (L - L^T)/2. */
#ifndef SPH_MATERIAL_H
#define SPH_MATERIAL_H

#include <sph/base.h>

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
 *                         The stress zz is not zero, but not stored: nothing in the plane
 *                         depends on it, and zz = nu (xx + yy) for small strains.
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

/* A block of n particles. Arrays that a law does not need may be NULL; those it needs and that
 * are NULL are an SPH_ERR_ARG of the caller (not when n is 0). Arrays are the caller's, read and
 * not kept. Numbers are taken as they come: a NaN gives NaN for its own particle only. */
typedef struct sph_material_block {
  size_t size;                     /* set by sph_material_block_init() */
  int32_t dim;                     /* 1, 2 or 3; default 0, which is refused */
  int64_t n;                       /* default 0 */
  const double *velocity_gradient; /* n * dim * dim */
  const double *sigma;             /* n packed symmetric */
  const double *rho;               /* n */
  const double *e;                 /* n: specific internal energy */
} sph_material_block;

/* Fill *block with the defaults: no particles, all arrays NULL. Since 0.1. */
SPH_API void sph_material_block_init_sized(sph_material_block *block, size_t size);
#define sph_material_block_init(b) sph_material_block_init_sized((b), sizeof(sph_material_block))

/* A host's law. Entries may be NULL: the law then does not have that property, and asking for it
 * is SPH_ERR_UNSUPPORTED. Callbacks are pure and may run on several threads at once on disjoint
 * blocks; they are not called for empty blocks. They write n entries (packed symmetric ones for
 * a stress rate) and look themselves for arrays of the block that are NULL. Return 0; a positive
 * return asks for a smaller step (SPH_RETRY), a negative one is SPH_ERR_CALLBACK. */
typedef struct sph_material_functions {
  size_t size; /* set by sph_material_functions_init() */
  int32_t (*stress_rate)(void *user, const sph_material_block *block, double *dsigma);
  int32_t (*pressure)(void *user, const sph_material_block *block, double *p);
  int32_t (*sound_speed)(void *user, const sph_material_block *block, double *c);
  void (*destroy)(void *user); /* called once, when the last reference goes; may be NULL */
} sph_material_functions;

/* Fill *f with the defaults: every entry NULL. Since 0.1. */
SPH_API void sph_material_functions_init_sized(sph_material_functions *f, size_t size);
#define sph_material_functions_init(f) \
  sph_material_functions_init_sized((f), sizeof(sph_material_functions))

/* A host's own material; the table is copied, `user` is passed to every callback. *out is NULL
 * on failure; `user` then stays the caller's, and `destroy` is not called.
 * SPH_ERR_ARG: stress_rate, pressure and sound_speed all NULL. SPH_ERR_VERSION, SPH_ERR_NOMEM.
 * Since 0.1. */
SPH_API sph_status sph_material_create(sph_context *ctx, const sph_material_functions *functions,
                                       void *user, sph_material **out);

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
 * sqrt((lambda + 2G)/rho) for the others. There is no pressure law. The wave speed sqrt(E/rho)
 * that the sources use in every dimension is too low in 2-D and 3-D.
 *
 * *out is NULL on failure. SPH_ERR_ARG: constants out of range or not finite, an unknown
 * reduction. SPH_ERR_VERSION, SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_material_create_hooke(sph_context *ctx, const sph_hooke_options *options,
                                             sph_material **out);

/* Give up the caller's reference; what uses the material keeps its own. NULL is allowed.
 * Since 0.1. */
SPH_API void sph_material_destroy(sph_material *material);

/* d sigma/dt from velocity gradient and stress (and density). dsigma: n packed symmetric; for
 * built-in laws it may be the block's sigma array. Serial, O(n).
 * SPH_ERR_ARG: an array the law needs is NULL, dim outside 1..3, n < 0, or the law is for
 * another dimension. SPH_ERR_UNSUPPORTED: the law has no stress rate. SPH_RETRY,
 * SPH_ERR_CALLBACK: what a host's law answered; dsigma is as that left it. SPH_ERR_VERSION.
 * Since 0.1. */
SPH_API sph_status sph_material_stress_rate(const sph_material *material,
                                            const sph_material_block *block, double *dsigma);
/* p from density and energy. p: n. Errors as above. Since 0.1. */
SPH_API sph_status sph_material_pressure(const sph_material *material,
                                         const sph_material_block *block, double *p);
/* Sound speed, or the longitudinal wave speed of a solid. c: n. Errors as above. Since 0.1. */
SPH_API sph_status sph_material_sound_speed(const sph_material *material,
                                            const sph_material_block *block, double *c);

#ifdef __cplusplus
}
#endif
#endif
