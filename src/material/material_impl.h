/* Materials as other layers see them: references, properties, and evaluation inside loops. */
#ifndef SPHI_MATERIAL_IMPL_H
#define SPHI_MATERIAL_IMPL_H

#include "../core/core.h"

#include <sph/material.h>

/* Properties a law may have. */
enum {
  SPHI_MATERIAL_STRESS_RATE = 0,
  SPHI_MATERIAL_PRESSURE,
  SPHI_MATERIAL_SOUND_SPEED,
  SPHI_MATERIAL_SHEAR_SPEED,
  SPHI_MATERIAL_SMALL_STRAIN_STRESS,
  SPHI_MATERIAL_CAUCHY_STRESS,
  SPHI_MATERIAL_STRESS_RATE_ACROSS,
  SPHI_MATERIAL_TEMPERATURE,
  SPHI_MATERIAL_ENERGY,
  /* those above write one array, these more */
  SPHI_MATERIAL_FIRST_PIOLA,
  SPHI_MATERIAL_PRESSURE_DERIVATIVES,
  SPHI_MATERIAL_PLASTIC_RETURN,
  SPHI_MATERIAL_PROPERTIES
};

/* Arrays of a block that a property reads, as bits. */
enum {
  SPHI_NEEDS_GRADIENT = 1,
  SPHI_NEEDS_SIGMA = 2,
  SPHI_NEEDS_RHO = 4,
  SPHI_NEEDS_E = 8,
  SPHI_NEEDS_F = 16,
  SPHI_NEEDS_STRAIN = 32,
  SPHI_NEEDS_P = 64,
  /* of the return alone, arrays beside the block */
  SPHI_NEEDS_ACROSS = 128,
  SPHI_NEEDS_PLASTIC_STRAIN = 256
};

/* Index of the first particle of a block for which a built-in law is not defined; -1 for none.
 * Writes about it into `text` unless that is NULL. Pure. */
typedef int64_t (*sphi_material_examine)(const void *user, int32_t property,
                                         const sph_material_block *block, char *text, size_t room);

struct sph_material {
  sphi_object object;
  int64_t references;
  int32_t dim;                              /* the only dimension the law is for; 0 = any */
  uint32_t needs[SPHI_MATERIAL_PROPERTIES]; /* 0 for a host's law, which checks for itself */
  sphi_material_examine examine;            /* NULL: nothing is out of range */
  sph_material_functions functions;
  void *user;
};

void sphi_material_retain(sph_material *material);
void sphi_material_release(sph_material *material);

/* Nonzero when the law has the property; 0 for NULL. */
int32_t sphi_material_has(const sph_material *material, int32_t property);
/* The arrays that a property reads, as SPHI_NEEDS_* bits. A host's law does not say: 0. */
uint32_t sphi_material_needs(const sph_material *material, int32_t property);
/* The dimension a law is for; 0 when any will do. */
int32_t sphi_material_dim(const sph_material *material);

/* Everything that can be wrong with a block for this property: the law lacks it, dimension, n,
 * arrays that it needs. Writes the sentence. Once before a loop, then the calls below. */
sph_status sphi_material_check_block(const sph_material *material, int32_t property,
                                     const sph_material_block *block);

/* Evaluate without checks and without touching the context, for worker threads. The block has
 * this library's size. SPH_OK, SPH_RETRY, SPH_ERR_CALLBACK, SPH_ERR_NUMERIC (then `out` is
 * untouched). The caller of the loop writes the sentence with sphi_material_explain(). */
sph_status sphi_material_evaluate_quiet(const sph_material *material, int32_t property,
                                        const sph_material_block *block, double *out);
sph_status sphi_material_stress_rate_quiet(const sph_material *material,
                                           const sph_material_block *block, double *dsigma);
sph_status sphi_material_pressure_quiet(const sph_material *material,
                                        const sph_material_block *block, double *p);
sph_status sphi_material_sound_speed_quiet(const sph_material *material,
                                           const sph_material_block *block, double *c);
/* The same from F; energy may be NULL. */
sph_status sphi_material_first_piola_quiet(const sph_material *material, int32_t dim, int64_t n,
                                           const double *F, double *P, double *energy);
sph_status sphi_material_plastic_return_quiet(const sph_material *material,
                                              const sph_material_block *block, double *sigma,
                                              double *across, double *plastic_strain,
                                              double *plastic_work);

/* A block of deformation gradients, for sphi_material_check_block() and _explain(). */
sph_material_block sphi_material_block_of_f(int32_t dim, int64_t n, const double *F);

/* Write the sentence that belongs to a status of the calls above and return it. SPH_OK and
 * SPH_RETRY, which is no failure, pass through. `block` is the one that failed and `first` the
 * number of its first particle, so that the sentence can name the particle. */
sph_status sphi_material_explain(const sph_material *material, int32_t property,
                                 const sph_material_block *block, int64_t first, sph_status status);
/* The same without a block: no particle is named. */
sph_status sphi_material_fail(const sph_material *material, int32_t property, sph_status status);

/* Make a handle. On failure `user` stays the caller's. */
sph_status sphi_material_make(sph_context *ctx, const sph_material_functions *functions, void *user,
                              sph_material **out);
/* What the constructors of built-in laws check alike: the context, out and options not NULL, and
 * the options, which are read over `defaults` into `mine`. *out becomes NULL. */
sph_status sphi_material_begin(sph_context *ctx, const char *name, void *mine, size_t size,
                               const void *options, sph_material **out);
/* SPH_OK, or SPH_ERR_ARG with a sentence when a constant is not finite and positive. */
sph_status sphi_material_positive(sph_context *ctx, const char *law, const char *name,
                                  double value);
/* Fill an options struct of the caller's `size` from the library's defaults, which begin with
 * their size. */
void sphi_material_init_sized(void *options, size_t size, const void *defaults, size_t known);

#endif
