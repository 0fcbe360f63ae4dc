/* Relaxation, for layouts that end with it. */
#ifndef SPHI_LAYOUT_RELAX_H
#define SPHI_LAYOUT_RELAX_H

#include "cell.h"

sph_status sphi_check_relax(sph_context *ctx, const char *name, const sph_relax_options *options);

/* What a layout without voids may spare. */
typedef struct sphi_relax_limits {
  int32_t levels; /* of halving while particles move; afterwards those of the region */
  double reach;   /* along an axis, from any particle to the end of its cell; 0: any */
} sphi_relax_limits;

/* sph_layout_relax() for n > 0 particles within a region, both checked. x, volumes (may be NULL)
 * and *result are untouched after a failure. */
sph_status sphi_relax(sph_context *ctx, const char *name, const sph_region_options *region,
                      const sph_relax_options *options, const sphi_relax_limits *limits, int64_t n,
                      double *x, double *volumes, sph_relax_result *result);

#endif
