/* Particle layouts: shared by the files of this folder. */
#ifndef SPHI_LAYOUT_IMPL_H
#define SPHI_LAYOUT_IMPL_H

#include "../core/core.h"

#include <sph/layout.h>

enum { SPHI_LAYOUT_MAX = INT32_MAX - 63 }; /* as a particle set holds: 2^31 - 64 */

/* Where points go. They are only counted while x is NULL. */
typedef struct sphi_points {
  int32_t dim;
  double *x;
  int64_t n;
} sphi_points;

void sphi_points_add(sphi_points *points, const double *at);

/* Puts all points of a layout into a sink, the same at every call. */
typedef void (*sphi_generate_fn)(const void *layout, sphi_points *points);

/* Count, compare with capacity, write: the outputs of every layout function. */
sph_status sphi_layout_write(sph_context *ctx, const char *function, int32_t dim,
                             sphi_generate_fn generate, const void *layout, int64_t capacity,
                             double *x, int64_t *n);

/* Checks shared by the option structs; each writes a sentence that begins with the function. */
sph_status sphi_check_box(sph_context *ctx, const char *function, int32_t dim, const double *lo,
                          const double *hi);
sph_status sphi_check_holes(sph_context *ctx, const char *function, int32_t holes,
                            const double *hole);

static inline const double *sphi_hole(const double *hole, int32_t k) { return hole + 3 * k; }

#endif
