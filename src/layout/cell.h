/* Voronoi cells within a region, everything measured from the particle. */
#ifndef SPHI_LAYOUT_CELL_H
#define SPHI_LAYOUT_CELL_H

#include "layout_impl.h"

/* Another particle: the cell ends at the half-plane d.p = |d|^2 / 2. */
typedef struct sphi_mate {
  double d[3]; /* x_j - x_i */
  double r2;   /* |d|^2 */
  int64_t j;
} sphi_mate;

typedef struct sphi_polygon {
  double (*p)[2]; /* counter-clockwise */
  int64_t n;
} sphi_polygon;

/* Room of one worker: mates, their indices, and two polygons, of `capacity` + 8 points each. */
typedef struct sphi_cell_room {
  int64_t capacity;
  sphi_mate *mates;
  int32_t *indices;
  sphi_polygon a, b;
} sphi_cell_room;

/* The cell of a particle at x against `mates` sorted by distance: its length, area or volume within
 * the region. *reach receives the largest distance of its corners: mates farther away than twice
 * that cannot cut it. */
double sphi_cell_measure(const sph_region_options *region, const double *x, int64_t mates,
                         sphi_cell_room *room, double *reach);

/* Area of a convex polygon (coordinates relative to x) within the holes, or without what is not
 * inside. */
double sphi_polygon_area(const sphi_polygon *polygon);
double sphi_polygon_in_disc(const sphi_polygon *polygon, const double *centre, double radius);
double sphi_polygon_inside(const sph_region_options *region, const double *x,
                           const sphi_polygon *polygon);
double sphi_segment_inside(const sph_region_options *region, double x, double lo, double hi);

#endif
