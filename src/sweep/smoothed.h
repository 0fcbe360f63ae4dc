/* Pair sums in which each particle has its own h, for the operators of smoothing.h: gathers over
 * h_i (density, omega), and forces with dW(h_i) and dW(h_j). Two kernels a pair and no rule for
 * unequal h; all terms share one loop. The weights a_i and b_j make the three smoothings one. */
#ifndef SPHI_SMOOTHED_H
#define SPHI_SMOOTHED_H

#include "../kernel/kernel_impl.h"
#include "../neighbors/neighbors_impl.h"

#include <sph/smoothing.h>

enum {
  SPHI_SMOOTHED_PRESSURE = 1,   /* the reversible part */
  SPHI_SMOOTHED_STRESS = 2,     /* the deviator */
  SPHI_SMOOTHED_DISSIPATION = 4 /* viscosity, conductivity, mass flux */
};

typedef struct sphi_smoothed {
  uint32_t terms;
  int32_t smoothing; /* SPH_SMOOTHING_* */
  const struct sph_kernel *kernel;
  const sph_operands *a;
  sph_dissipation dissipation;
  double *drho, *dvdt, *dedt; /* rows < a->rows are added to; NULL: not wanted */
  double *gradv;              /* STRESS: L, set; NULL: not wanted */
} sphi_smoothed;

/* Run over a list that was checked. Records go to list->scratch[0]. SPH_OK, SPH_ERR_NOMEM: nothing
 * was written. */
sph_status sphi_smoothed_run(sph_neighbors *list, const sphi_smoothed *sweep);

/* Make room, so that the run cannot fail. */
sph_status sphi_smoothed_reserve(sph_neighbors *list, const sphi_smoothed *sweep);

/* Gathers of the rows: a_i sum b_j W(h_i) into density, omega raised to `floor` into omega; either
 * may be NULL. */
sph_status sphi_smoothed_gather(sph_neighbors *list, const struct sph_kernel *kernel,
                                const sph_operands *a, int32_t smoothing, double floor,
                                double *density, double *omega);

#endif
