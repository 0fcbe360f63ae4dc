/* Voronoi cells: an interval in 1-D, a polygon cut by half-planes in 2-D, and in 3-D the faces of a
 * polyhedron one by one, each a polygon in its plane cut by all other half-spaces. */
#include "cell.h"

#include <math.h>
#include <string.h>

static double length2(const double *p) { return p[0] * p[0] + p[1] * p[1]; }

/* Keep n.p <= offset (Sutherland and Hodgman); `from` and `to` differ. */
static void cut(const sphi_polygon *from, sphi_polygon *to, const double *n, double offset) {
  to->n = 0;
  for (int64_t k = 0; k < from->n; ++k) {
    const double *p = from->p[k], *q = from->p[k + 1 < from->n ? k + 1 : 0];
    const double at_p = n[0] * p[0] + n[1] * p[1] - offset;
    const double at_q = n[0] * q[0] + n[1] * q[1] - offset;
    if (at_p <= 0.0) {
      to->p[to->n][0] = p[0];
      to->p[to->n++][1] = p[1];
    }
    if ((at_p < 0.0 && at_q > 0.0) || (at_p > 0.0 && at_q < 0.0)) {
      const double t = at_p / (at_p - at_q);
      to->p[to->n][0] = p[0] + t * (q[0] - p[0]);
      to->p[to->n++][1] = p[1] + t * (q[1] - p[1]);
    }
  }
}

static int cuts(const sphi_polygon *polygon, const double *n, double offset) {
  for (int64_t k = 0; k < polygon->n; ++k)
    if (n[0] * polygon->p[k][0] + n[1] * polygon->p[k][1] > offset) return 1;
  return 0;
}

static void swap(sphi_cell_room *room) {
  const sphi_polygon other = room->a;
  room->a = room->b;
  room->b = other;
}

static double reach_of(const sphi_polygon *polygon) {
  double most = 0.0;
  for (int64_t k = 0; k < polygon->n; ++k) most = fmax(most, length2(polygon->p[k]));
  return sqrt(most);
}

static void rectangle(sphi_polygon *polygon, double x0, double x1, double y0, double y1) {
  const double corners[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
  for (int k = 0; k < 4; ++k)
    for (int a = 0; a < 2; ++a) polygon->p[k][a] = corners[k][a];
  polygon->n = 4;
}

/* ---- 1-D --------------------------------------------------------------------------------- */

static void interval(const sphi_measure *how, const double *x, int64_t mates,
                     const sphi_cell_room *room, double *reach, sphi_moments *moments) {
  const sph_region_options *region = how->region;
  double lo = fmax(region->lo[0] - x[0], -how->limit);
  double hi = fmin(region->hi[0] - x[0], how->limit);
  for (int64_t k = 0; k < mates; ++k) {
    const double middle = 0.5 * room->mates[k].d[0];
    if (middle < 0.0) lo = fmax(lo, middle);
    if (middle > 0.0) hi = fmin(hi, middle);
  }
  *reach = fmax(-lo, hi);
  if (region->inside == NULL)
    sphi_add_segment(moments, lo, hi);
  else
    sphi_segment_inside(how, x[0], lo, hi, moments);
}

/* ---- 2-D --------------------------------------------------------------------------------- */

/* Area taken off by the holes; *cut tells whether one reaches the cell. */
static double area_of_holes(const sph_region_options *region, const double *x,
                            const sphi_polygon *polygon, double reach, int *cut) {
  double area = 0.0;
  for (int32_t k = 0; k < region->holes; ++k) {
    const double *hole = sphi_hole(region->hole, k);
    const double centre[2] = {hole[0] - x[0], hole[1] - x[1]};
    if (sqrt(length2(centre)) >= hole[2] + reach) continue;
    area += sphi_polygon_in_disc(polygon, centre, hole[2]);
    *cut = 1;
  }
  return area;
}

static void measure_polygon(const sphi_measure *how, const double *x, const sphi_polygon *polygon,
                            double reach, int all, sphi_moments *moments) {
  const sph_region_options *region = how->region;
  const double zero[2] = {0.0, 0.0};
  int cut = 0;
  if (region->inside != NULL) {
    sphi_polygon_inside(how, x, polygon, moments);
    return;
  }
  const double area = sphi_polygon_area(polygon) - area_of_holes(region, x, polygon, reach, &cut);
  if (all && cut) sphi_polygon_inside(how, x, polygon, moments);
  for (int64_t k = 0; all && !cut && k < polygon->n; ++k)
    sphi_add_triangle(moments, zero, polygon->p[k], polygon->p[k + 1 < polygon->n ? k + 1 : 0]);
  moments->volume = fmax(0.0, area);
}

static void polygon_cell(const sphi_measure *how, const double *x, int64_t mates, int all,
                         sphi_cell_room *room, double *reach, sphi_moments *moments) {
  const sph_region_options *region = how->region;
  const double most = how->limit;
  rectangle(&room->a, fmax(region->lo[0] - x[0], -most), fmin(region->hi[0] - x[0], most),
            fmax(region->lo[1] - x[1], -most), fmin(region->hi[1] - x[1], most));
  *reach = reach_of(&room->a);
  for (int64_t k = 0; k < mates; ++k) {
    const sphi_mate *mate = &room->mates[k];
    if (mate->r2 > 4.0 * *reach * *reach) break;
    if (!cuts(&room->a, mate->d, 0.5 * mate->r2)) continue;
    cut(&room->a, &room->b, mate->d, 0.5 * mate->r2);
    swap(room);
    *reach = reach_of(&room->a);
  }
  measure_polygon(how, x, &room->a, *reach, all, moments);
}

/* ---- 3-D --------------------------------------------------------------------------------- */

/* A half-space n.p <= offset, |n| = 1, offset >= 0. */
typedef struct plane {
  double n[3], offset;
} plane;

static plane plane_of(const sphi_measure *how, const double *x, const sphi_mate *mates, int64_t k) {
  const sph_region_options *region = how->region;
  plane result = {{0.0, 0.0, 0.0}, 0.0};
  if (k < 6) { /* the faces of the box */
    const int64_t a = k / 2;
    result.n[a] = k % 2 ? 1.0 : -1.0;
    result.offset = fmin(how->limit, k % 2 ? region->hi[a] - x[a] : x[a] - region->lo[a]);
    return result;
  }
  const sphi_mate *mate = &mates[k - 6];
  const double r = sqrt(mate->r2);
  for (int a = 0; a < 3; ++a) result.n[a] = mate->d[a] / r;
  result.offset = 0.5 * r;
  return result;
}

/* Two directions at right angles to n and to each other. */
static void tangents(const double *n, double *u, double *v) {
  const int a = fabs(n[0]) < fabs(n[1]) ? (fabs(n[0]) < fabs(n[2]) ? 0 : 2)
                                        : (fabs(n[1]) < fabs(n[2]) ? 1 : 2);
  double size = 0.0;
  for (int k = 0; k < 3; ++k) u[k] = (k == a ? 1.0 : 0.0) - n[a] * n[k];
  for (int k = 0; k < 3; ++k) size += u[k] * u[k];
  for (int k = 0; k < 3; ++k) u[k] /= sqrt(size);
  for (int k = 0; k < 3; ++k)
    v[k] = n[(k + 1) % 3] * u[(k + 2) % 3] - n[(k + 2) % 3] * u[(k + 1) % 3];
}

static double dot3(const double *a, const double *b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The face of the cell in plane k, left in room->a as coordinates along u and v. */
static void cut_face(const sphi_measure *how, const double *x, int64_t planes, int64_t k,
                     double size, sphi_cell_room *room) {
  const plane own = plane_of(how, x, room->mates, k);
  double u[3], v[3];
  tangents(own.n, u, v);
  rectangle(&room->a, -size, size, -size, size);
  for (int64_t other = 0; other < planes && room->a.n > 0; ++other) {
    if (other == k) continue;
    const plane p = plane_of(how, x, room->mates, other);
    const double in_plane[2] = {dot3(p.n, u), dot3(p.n, v)};
    const double offset = p.offset - own.offset * dot3(p.n, own.n);
    if (!cuts(&room->a, in_plane, offset)) continue;
    cut(&room->a, &room->b, in_plane, offset);
    swap(room);
  }
}

/* The pyramid from the particle, volume = offset * area / 3, to a face in plane k. Its centroid
 * lies at 3/4 of the way to the face's, and int |y|^2 = offset/5 int over the face of |y|^2. */
static void add_pyramid(const plane *face, const sphi_polygon *polygon, int all,
                        sphi_moments *moments) {
  const double zero[2] = {0.0, 0.0};
  double u[3], v[3];
  moments->volume += face->offset * sphi_polygon_area(polygon) / 3.0;
  if (!all) return;
  sphi_moments flat = {0.0, {0.0, 0.0, 0.0}, 0.0};
  for (int64_t k = 0; k < polygon->n; ++k)
    sphi_add_triangle(&flat, zero, polygon->p[k], polygon->p[k + 1 < polygon->n ? k + 1 : 0]);
  tangents(face->n, u, v);
  for (int a = 0; a < 3; ++a)
    moments->first[a] +=
        face->offset / 4.0 *
        (face->offset * flat.volume * face->n[a] + flat.first[0] * u[a] + flat.first[1] * v[a]);
  moments->second += face->offset / 5.0 * (face->offset * face->offset * flat.volume + flat.second);
}

/* The same, of what is inside: tetrahedra from the particle to a fan of the face. */
static void add_pyramid_inside(const sphi_measure *how, const double *x, const plane *face,
                               const sphi_polygon *polygon, sphi_moments *moments) {
  double u[3], v[3], corner[3][3];
  tangents(face->n, u, v);
  for (int64_t k = 0; k < polygon->n; ++k) {
    double *at = corner[k < 2 ? k : 2];
    if (k > 2) memcpy(corner[1], corner[2], sizeof corner[1]);
    for (int a = 0; a < 3; ++a)
      at[a] = face->offset * face->n[a] + polygon->p[k][0] * u[a] + polygon->p[k][1] * v[a];
    if (k >= 2) sphi_tetrahedron_inside(how, x, corner[0], corner[1], corner[2], moments);
  }
}

/* Face by face, against the first `mates`. Returns the largest distance of a corner. */
static double polyhedron(const sphi_measure *how, const double *x, int64_t mates, int all,
                         double size, sphi_cell_room *room, sphi_moments *moments) {
  double most = 0.0;
  *moments = (sphi_moments){0.0, {0.0, 0.0, 0.0}, 0.0};
  for (int64_t k = 0; k < mates + 6; ++k) {
    const plane face = plane_of(how, x, room->mates, k);
    cut_face(how, x, mates + 6, k, size, room);
    if (room->a.n == 0) continue;
    most = fmax(most, hypot(face.offset, reach_of(&room->a)));
    if (how->region->inside == NULL)
      add_pyramid(&face, &room->a, all, moments);
    else
      add_pyramid_inside(how, x, &face, &room->a, moments);
  }
  return most;
}

/* Every face is cut by every plane: begin with few mates, and go on with those only that could cut
 * what these leave. */
static void polyhedron_cell(const sphi_measure *how, const double *x, int64_t mates, int all,
                            sphi_cell_room *room, double *reach, sphi_moments *moments) {
  enum { FIRST = 40 };
  int64_t used = 0, needed = mates < FIRST ? mates : FIRST;
  double diagonal = 0.0;
  for (int a = 0; a < 3; ++a) diagonal = hypot(diagonal, how->region->hi[a] - how->region->lo[a]);
  do {
    used = needed;
    *reach = polyhedron(how, x, used, all, 2.0 * diagonal, room, moments);
    while (needed < mates && room->mates[needed].r2 <= 4.0 * *reach * *reach) ++needed;
  } while (needed > used);
}

void sphi_cell_measure(const sphi_measure *how, const double *x, int64_t mates, int all,
                       sphi_cell_room *room, double *reach, sphi_moments *moments) {
  *moments = (sphi_moments){0.0, {0.0, 0.0, 0.0}, 0.0};
  if (how->region->dim == 1)
    interval(how, x, mates, room, reach, moments);
  else if (how->region->dim == 2)
    polygon_cell(how, x, mates, all, room, reach, moments);
  else
    polyhedron_cell(how, x, mates, all, room, reach, moments);
}
