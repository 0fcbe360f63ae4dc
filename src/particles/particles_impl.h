/* What other layers may ask of a particle set beyond the public calls. */
#ifndef SPHI_PARTICLES_IMPL_H
#define SPHI_PARTICLES_IMPL_H

#include "../core/core.h"

#include <sph/particles.h>

sph_context *sphi_particles_context(const sph_particles *set);
/* Name of a field for error sentences, never NULL. */
const char *sphi_field_name(const sph_particles *set, int32_t field);
const int32_t *sphi_particles_phases(const sph_particles *set);

#endif
