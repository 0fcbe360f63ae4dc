/* What other layers may ask of a particle set beyond the public calls. */
#ifndef SPHI_PARTICLES_IMPL_H
#define SPHI_PARTICLES_IMPL_H

#include "../core/core.h"

#include <sph/particles.h>

sph_context *sphi_particles_context(const sph_particles *set);
/* Name of a field for error sentences, never NULL. */
const char *sphi_field_name(const sph_particles *set, int32_t field);
const int32_t *sphi_particles_phases(const sph_particles *set);
const int32_t *sphi_particles_roles(const sph_particles *set);

/* Every field has an id below this: built-in ones below 64, the host's above. */
enum { SPHI_FIELD_IDS = 128 };

/* What the components of a field are. The host's own fields are plain. */
typedef enum sphi_shape {
  SPHI_SHAPE_PLAIN,
  SPHI_SHAPE_VECTOR,
  SPHI_SHAPE_SYMMETRIC, /* packed */
  SPHI_SHAPE_MATRIX     /* dim * dim */
} sphi_shape;
sphi_shape sphi_field_shape(const sph_particles *set, int32_t field);

#endif
