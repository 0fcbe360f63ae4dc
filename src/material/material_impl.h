/* Materials as other layers see them: references, properties, and evaluation inside loops. */
#ifndef SPHI_MATERIAL_IMPL_H
#define SPHI_MATERIAL_IMPL_H

#include "../core/core.h"

#include <sph/material.h>

/* Properties a law may have. */
enum { SPHI_MATERIAL_STRESS_RATE = 0, SPHI_MATERIAL_PRESSURE = 1, SPHI_MATERIAL_SOUND_SPEED = 2 };

/* Arrays of a block that a property reads, as bits. */
enum { SPHI_NEEDS_GRADIENT = 1, SPHI_NEEDS_SIGMA = 2, SPHI_NEEDS_RHO = 4, SPHI_NEEDS_E = 8 };

struct sph_material {
  sphi_object object;
  int64_t references;
  int32_t dim;       /* the only dimension the law is for; 0 = any */
  uint32_t needs[3]; /* by property; 0 for a host's law, which checks for itself */
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
 * this library's size. SPH_OK, SPH_RETRY, SPH_ERR_CALLBACK. The caller of the loop writes the
 * sentence with sphi_material_fail(). */
sph_status sphi_material_stress_rate_quiet(const sph_material *material,
                                           const sph_material_block *block, double *dsigma);
sph_status sphi_material_pressure_quiet(const sph_material *material,
                                        const sph_material_block *block, double *p);
sph_status sphi_material_sound_speed_quiet(const sph_material *material,
                                           const sph_material_block *block, double *c);
/* Write the sentence that belongs to a status of the calls above and return it. SPH_OK and
 * SPH_RETRY, which is no failure, pass through. */
sph_status sphi_material_fail(const sph_material *material, int32_t property, sph_status status);

/* Make a handle. On failure `user` stays the caller's. */
sph_status sphi_material_make(sph_context *ctx, const sph_material_functions *functions, void *user,
                              sph_material **out);
/* Fill an options struct of the caller's `size` from the library's defaults, which begin with
 * their size. */
void sphi_material_init_sized(void *options, size_t size, const void *defaults, size_t known);

#endif
