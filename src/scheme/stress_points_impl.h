/* The handle of stress points. */
#ifndef SPHI_STRESS_POINTS_IMPL_H
#define SPHI_STRESS_POINTS_IMPL_H

#include "../kernel/kernel_impl.h"
#include "../material/material_impl.h"
#include "../particles/particles_impl.h"

#include <sph/correction.h>
#include <sph/neighbors.h>
#include <sph/stress_points.h>

enum { SPHI_MAGIC_STRESS_POINTS = 0x53504843, SPHI_POINT_PHASES = 256 };

struct sph_stress_points {
  sphi_object base;
  sph_stress_points_options options;
  sph_kernel *kernel;                         /* retained */
  sph_neighbors *list;                        /* the host's */
  sph_material *materials[SPHI_POINT_PHASES]; /* retained */
  int32_t dim;                                /* of the points; 0 before the first */
  int64_t count;                              /* points */
  double *offsets;                            /* count * dim: d_p */
  double *stresses;                           /* count packed symmetric */
  size_t offset_bytes, stress_bytes;
  sphi_buffer scratch; /* arrays of particles and points */
};

#endif
