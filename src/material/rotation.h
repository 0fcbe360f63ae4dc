/* Rotation of packed symmetric tensors by a unit quaternion. */
#ifndef SPHI_ROTATION_H
#define SPHI_ROTATION_H

#include <stdint.h>

/* cos(angle/2), sin(angle/2) times the axis; in 2-D the axis is z. */
typedef struct sphi_rotation {
  double w, x, y, z;
} sphi_rotation;

/* The rotation of a step from L and dt; `kind` is SPH_ROTATION_EXPONENTIAL or _CAYLEY. dim 2, 3. */
sphi_rotation sphi_rotation_of(int32_t dim, const double *velocity_gradient, double dt,
                               int32_t kind);
/* About the same axis by half the angle. */
sphi_rotation sphi_rotation_half(sphi_rotation q);
/* s <- R s R^T. dim 2 or 3. */
void sphi_rotate(int32_t dim, sphi_rotation q, double *s);

#endif
