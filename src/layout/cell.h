/* Voronoi cells within a region, everything measured from the particle. */
#ifndef SPHI_LAYOUT_CELL_H
#define SPHI_LAYOUT_CELL_H

#include "layout_impl.h"

#include <sph/neighbors.h>

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

/* Integrals over a cell within the region, y measured from the particle. */
typedef struct sphi_moments {
  double volume;   /* of 1: length, area or volume */
  double first[3]; /* of y */
  double second;   /* of |y|^2 */
} sphi_moments;

/* What cells are measured with: the region, and the mean distance of particles. A host's `inside`
 * is looked at in pieces of spacing / 4, where it cuts down to spacing / 2^levels. */
typedef struct sphi_measure {
  const sph_region_options *region;
  double spacing;
  int32_t levels;
  double limit; /* what lies farther than this along an axis is no one's; infinity: none */
} sphi_measure;

/* The cell of a particle at x against `mates` sorted by distance. Moments but the volume are 0
 * unless `all` asks for them; where circular holes cut the cell they are those of halving. *reach
 * receives the largest distance of its corners: mates farther away than twice that cannot cut it.
 */
void sphi_cell_measure(const sphi_measure *how, const double *x, int64_t mates, int all,
                       sphi_cell_room *room, double *reach, sphi_moments *moments);

/* Add those of [lo, hi], and of a triangle, all of it inside. */
void sphi_add_segment(sphi_moments *moments, double lo, double hi);
void sphi_add_triangle(sphi_moments *moments, const double *a, const double *b, const double *c);

/* Of a convex polygon (coordinates relative to x): its area, that within a disc, and what is in the
 * region. */
double sphi_polygon_area(const sphi_polygon *polygon);
double sphi_polygon_in_disc(const sphi_polygon *polygon, const double *centre, double radius);
void sphi_polygon_inside(const sphi_measure *how, const double *x, const sphi_polygon *polygon,
                         sphi_moments *moments);
/* Of the tetrahedron of the particle, which lies in its cell, and a, b, c. */
void sphi_tetrahedron_inside(const sphi_measure *how, const double *x, const double *a,
                             const double *b, const double *c, sphi_moments *moments);
void sphi_segment_inside(const sphi_measure *how, double x, double lo, double hi,
                         sphi_moments *moments);

/* Cells of all particles; zero-initialise, then set the first part. Opened for n particles, it can
 * run for other positions of them again and again. Close it even when opening failed. */
typedef struct sphi_tessellation {
  sph_context *ctx;
  const char *function; /* for sentences */
  const sph_region_options *region;
  int64_t n; /* at least 1 */
  const double *x;
  int all;        /* all moments, not the volumes alone */
  int32_t levels; /* of halving; may change between runs */
  double limit;   /* of a sphi_measure; 0 stands for none */

  sphi_moments *cell; /* n: what a run finds; a volume below 0 while the room was too small */
  sph_neighbors *list;
  double spacing, diagonal; /* mean distance, size of the box */
  sphi_cell_room *rooms;    /* one a worker */
  int32_t workers;
  int64_t coincident; /* lowest particle at the place of another */
} sphi_tessellation;

sph_status sphi_tessellation_open(sphi_tessellation *job);
sph_status sphi_tessellation_run(sphi_tessellation *job);
void sphi_tessellation_close(sphi_tessellation *job);

sph_status sphi_check_region(sph_context *ctx, const char *function, const sph_region_options *o);
sph_status sphi_check_in_box(sph_context *ctx, const char *function, const sph_region_options *o,
                             int64_t n, const double *x);

/* Whether a point is outside every hole and inside as the host says; the box is not looked at. */
int sphi_in_region(const sph_region_options *region, const double *at);

#endif
