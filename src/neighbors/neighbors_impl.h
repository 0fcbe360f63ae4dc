/* The neighbour handle as the pair loops see it.
 *
 * Particles are numbered a second time, in sweep order: position k of a spatial order, so that
 * neighbours lie close in memory. order[k] is the host index. Rows hold sweep positions. */
#ifndef SPHI_NEIGHBORS_IMPL_H
#define SPHI_NEIGHBORS_IMPL_H

#include "../core/core.h"

#include <sph/neighbors.h>

enum { SPHI_ROW_PADDING = 16 }; /* readable entries (value 0) after the last pair */

struct sph_neighbors {
  sphi_object base;
  sph_neighbors_options options;
  int32_t dim;     /* of the last build; 0 before the first */
  int64_t n;       /* particles of the last build */
  uint32_t *order; /* n: host index of sweep position k; ascending within a cell */
  int64_t *start;  /* n + 1: row of sweep position k is pair[start[k]] ... pair[start[k + 1] - 1] */
  /* sweep positions, ascending in a row, self excluded; skin included; then padding */
  uint32_t *pair;
  double period[3]; /* box length of periodic axes, else 0: displacements wrap by minimum image */
  double h_uniform; /* the h of every particle if all are equal, else 0 */
  double h_max;
  int64_t builds;
  sphi_buffer scratch[6]; /* of the pair loops; they fill them, the list frees them on destroy */
  struct sphi_neighbors_private *priv; /* grids, buffers, public rows, positions at the build */
};

/* SPH_OK; SPH_ERR_STATE never built; SPH_ERR_ARG n or dim differ. */
sph_status sphi_neighbors_check(const sph_neighbors *list, int32_t dim, int64_t n);

/* SPH_ERR_STALE when a particle is further from where it was at the build than half the skin, or
 * another h than it had.
 * O(n); the list was checked before. */
sph_status sphi_neighbors_fresh(const sph_neighbors *list, const double *x, const double *h,
                                double h0);

/* Host index lists for query points: as sph_neighbors_query(), but without argument checks, and
 * safe to call from several threads at once. Returns the number found; writes at most capacity,
 * ascending. */
int64_t sphi_neighbors_near(const sph_neighbors *list, const double *point, double radius,
                            int64_t capacity, int32_t *indices);

#endif
