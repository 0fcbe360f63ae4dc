/* Materials: pointwise laws between strain, density, energy and stress.
 *
 * A material is stateless: all it needs comes in as arrays, so one handle serves any number of
 * particles and threads. Hosts supply their own law as a table of callbacks on blocks. */
#ifndef SPH_MATERIAL_H
#define SPH_MATERIAL_H

#include <sph/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How a law is reduced to fewer dimensions. */
enum {
  SPH_UNIAXIAL_STRESS = 1, /* 1-D: sigma' = E L; lateral stress zero */
  SPH_UNIAXIAL_STRAIN = 2, /* 1-D: sigma' = (lambda + 2 mu) L; lateral strain zero */
  SPH_PLANE_STRESS = 3,    /* 2-D */
  SPH_PLANE_STRAIN = 4,    /* 2-D */
  SPH_SOLID = 5            /* 3-D */
};

/* A block of n particles. Arrays that a law does not need may be NULL; those it needs and that
 * are NULL are an SPH_ERR_ARG of the caller. */
typedef struct sph_material_block {
  size_t size;
  int32_t dim;
  int64_t n;
  const double *velocity_gradient; /* n * dim * dim */
  const double *sigma;             /* n packed symmetric */
  const double *rho;               /* n */
  const double *e;                 /* n: specific internal energy */
} sph_material_block;

SPH_API void sph_material_block_init_sized(sph_material_block *block, size_t size);
#define sph_material_block_init(b) sph_material_block_init_sized((b), sizeof(sph_material_block))

/* A host's law. Entries may be NULL: the law then does not have that property, and asking for it is
 * SPH_ERR_UNSUPPORTED. Callbacks are pure and may run on several threads at once on disjoint blocks. A positive return asks
 * for a smaller step (SPH_RETRY), a negative one is SPH_ERR_CALLBACK. */
typedef struct sph_material_functions {
  size_t size;
  int32_t (*stress_rate)(void *user, const sph_material_block *block, double *dsigma);
  int32_t (*pressure)(void *user, const sph_material_block *block, double *p);
  int32_t (*sound_speed)(void *user, const sph_material_block *block, double *c);
  void (*destroy)(void *user); /* called once, when the last reference goes; may be NULL */
} sph_material_functions;

SPH_API void sph_material_functions_init_sized(sph_material_functions *f, size_t size);
#define sph_material_functions_init(f)                                                       \
  sph_material_functions_init_sized((f), sizeof(sph_material_functions))

/* A host's own material; the table is copied. SPH_ERR_ARG: all entries NULL. Since 0.1. */
SPH_API sph_status sph_material_create(sph_context *ctx, const sph_material_functions *functions,
                                       void *user, sph_material **out);

typedef struct sph_hooke_options {
  size_t size;
  double young;        /* E > 0, a stress */
  double poisson;      /* -1 < nu < 0.5; default 0 */
  double density;      /* reference density > 0, for wave speeds */
  int32_t reduction;   /* SPH_UNIAXIAL_STRESS ... SPH_SOLID; default UNIAXIAL_STRESS */
  int32_t jaumann;     /* nonzero: Jaumann rate (2-D, 3-D; no effect in 1-D); default 1 */
} sph_hooke_options;
SPH_API void sph_hooke_options_init_sized(sph_hooke_options *options, size_t size);
#define sph_hooke_options_init(o) sph_hooke_options_init_sized((o), sizeof(sph_hooke_options))

/* Isotropic Hooke in rate form, He 2015 (3.4), (3.5): sigma' = 2G D' + K tr(D) I [- sigma omega + omega sigma], reduced to the
 * dimension as said by `reduction`. Also gives sound_speed: the longitudinal wave speed of the reduction,
 * sqrt(E/rho) for uniaxial stress. SPH_ERR_ARG: constants out of range. Since 0.1. */
SPH_API sph_status sph_material_create_hooke(sph_context *ctx, const sph_hooke_options *options,
                                             sph_material **out);

/* Give up the caller's reference. NULL is allowed. Since 0.1. */
SPH_API void sph_material_destroy(sph_material *material);

/* d sigma/dt from velocity gradient and stress (and density). dsigma: n packed symmetric.
 * SPH_ERR_ARG: an array the law needs is NULL, or the law is for another dimension.
 * SPH_ERR_UNSUPPORTED, SPH_RETRY, SPH_ERR_CALLBACK. Since 0.1. */
SPH_API sph_status sph_material_stress_rate(const sph_material *material,
                                            const sph_material_block *block, double *dsigma);
/* p from density and energy. p: n. Errors as above. Since 0.1. */
SPH_API sph_status sph_material_pressure(const sph_material *material,
                                         const sph_material_block *block, double *p);
/* Sound speed. c: n. Errors as above. Since 0.1. */
SPH_API sph_status sph_material_sound_speed(const sph_material *material,
                                            const sph_material_block *block, double *c);

#ifdef __cplusplus
}
#endif
#endif
