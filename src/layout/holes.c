/* Layouts of a rectangle about circular holes. Points are made in the order base, rings on the
 * edges of holes, rows on the faces; a point is left out where one of a later kind will stand. */
#include "layout_impl.h"

#include <math.h>

static const char function[] = "sph_layout_holes";
static const double pi = 3.14159265358979323846;

typedef struct plate {
  sph_hole_layout_options o;
  double tolerance; /* rounding of coordinates, a length */
  int32_t rays;     /* RADIAL: on a full circle */
  int32_t steps;    /* RADIAL: along each ray */
} plate;

void sph_hole_layout_options_init_sized(sph_hole_layout_options *options, size_t size) {
  const sph_hole_layout_options defaults = {.kind = SPH_HOLES_EQUALLY_RADIAL,
                                            .hi = {1.0, 1.0},
                                            .faces = SPH_FACE_X_LO | SPH_FACE_X_HI | SPH_FACE_Y_LO |
                                                     SPH_FACE_Y_HI,
                                            .edge_rings = 1,
                                            .clearance = 0.6};
  sphi_options_init(options, size, &defaults, sizeof defaults);
}

/* ---- which points stay ------------------------------------------------------------------- */

static double distance_to_edge(const double *hole, const double *at) {
  const double dx = at[0] - hole[0], dy = at[1] - hole[1];
  return sqrt(dx * dx + dy * dy) - hole[2];
}

static int in_plate(const plate *p, const double *at) {
  for (int32_t a = 0; a < 2; ++a)
    if (at[a] < p->o.lo[a] - p->tolerance || at[a] > p->o.hi[a] + p->tolerance) return 0;
  for (int32_t k = 0; k < p->o.holes; ++k)
    if (distance_to_edge(sphi_hole(p->o.hole, k), at) < -p->tolerance) return 0;
  return 1;
}

static int near_row(const plate *p, const double *at) {
  const double limit = p->o.clearance * p->o.spacing;
  for (int32_t a = 0; a < 2; ++a) {
    if ((p->o.faces & (SPH_FACE_X_LO << (2 * a))) && at[a] - p->o.lo[a] < limit) return 1;
    if ((p->o.faces & (SPH_FACE_X_HI << (2 * a))) && p->o.hi[a] - at[a] < limit) return 1;
  }
  return 0;
}

/* Within the rings of hole `first` or a later one, or too close to the outermost. */
static int near_rings(const plate *p, const double *at, int32_t first) {
  if (p->o.edge_rings == 0) return 0;
  const double depth = p->o.offset + p->o.edge_rings - 1 + p->o.clearance;
  for (int32_t k = first; k < p->o.holes; ++k)
    if (distance_to_edge(sphi_hole(p->o.hole, k), at) < depth * p->o.spacing - p->tolerance)
      return 1;
  return 0;
}

/* Rounding must not put a point outside the box. */
static void add(const plate *p, sphi_points *points, const double *at) {
  double kept[2];
  for (int32_t a = 0; a < 2; ++a) kept[a] = fmin(fmax(at[a], p->o.lo[a]), p->o.hi[a]);
  sphi_points_add(points, kept);
}

/* A point that yields to rows on faces and to the rings of hole `first` and later ones. */
static void offer(const plate *p, sphi_points *points, const double *at, int32_t first) {
  if (in_plate(p, at) && !near_row(p, at) && !near_rings(p, at, first)) add(p, points, at);
}

/* ---- rings ------------------------------------------------------------------------------- */

/* The j-th of 4 m directions, shifted by `phase` steps; symmetric about both axes and both
 * diagonals to the bit, because only angles up to 45 degrees are computed. */
static void direction(int64_t j, int64_t m, double phase, double *c, double *s) {
  const int64_t quadrant = j / m;
  const double step = (double)(j % m) + phase, rest = (double)m - step;
  const double angle = 0.5 * pi * fmin(step, rest) / (double)m;
  const double near = cos(angle), far = step == rest ? near : sin(angle);
  const double x = step <= rest ? near : far, y = step <= rest ? far : near;
  *c = quadrant == 0 ? x : quadrant == 1 ? -y : quadrant == 2 ? -x : y;
  *s = quadrant == 0 ? y : quadrant == 1 ? x : quadrant == 2 ? -y : -x;
}

static void add_ring(const plate *p, sphi_points *points, const double *hole, double radius,
                     int32_t first) {
  const int64_t quarter = (int64_t)fmax(1.0, round(0.5 * pi * radius / p->o.spacing));
  for (int64_t j = 0; j < 4 * quarter; ++j) {
    double c, s;
    direction(j, quarter, p->o.phase, &c, &s);
    const double at[2] = {hole[0] + radius * c, hole[1] + radius * s};
    offer(p, points, at, first);
  }
}

/* Distance from the centre of hole 0 to the farthest corner. */
static double farthest(const plate *p) {
  const double *h = p->o.hole;
  return hypot(fmax(fabs(p->o.lo[0] - h[0]), fabs(p->o.hi[0] - h[0])),
               fmax(fabs(p->o.lo[1] - h[1]), fabs(p->o.hi[1] - h[1])));
}

static void add_equal_rings(const plate *p, sphi_points *points) {
  const double end = farthest(p) + p->tolerance;
  for (int64_t k = 0;; ++k) {
    const double radius = p->o.hole[2] + ((double)k + p->o.offset) * p->o.spacing;
    if (radius > end) return;
    add_ring(p, points, p->o.hole, radius, 1);
  }
}

static void add_edge_rings(const plate *p, sphi_points *points) {
  for (int32_t k = p->o.kind == SPH_HOLES_SQUARED ? 0 : 1; k < p->o.holes; ++k)
    for (int32_t ring = 0; ring < p->o.edge_rings; ++ring) {
      const double *hole = sphi_hole(p->o.hole, k);
      add_ring(p, points, hole, hole[2] + (ring + p->o.offset) * p->o.spacing, k + 1);
    }
}

/* ---- rays -------------------------------------------------------------------------------- */

/* From the centre of hole 0 to the rectangle; 0 where the ray leaves it at once. */
static double ray_length(const plate *p, double c, double s) {
  const double along[2] = {c, s};
  double length = INFINITY;
  for (int32_t a = 0; a < 2; ++a) {
    const double face = along[a] > 0.0 ? p->o.hi[a] : p->o.lo[a];
    if (along[a] != 0.0) length = fmin(length, (face - p->o.hole[a]) / along[a]);
  }
  return length;
}

/* Rays an angle d apart with steps of r d along them hold int ln(R / r) dtheta / d^2 points; as
 * many as area / s^2 are wanted. 0: no ray has room. */
static int fit_rays(plate *p) {
  enum { SAMPLES = 4096 };
  double logs = 0.0, area = 0.0;
  int64_t valid = 0;
  for (int64_t j = 0; j < SAMPLES; ++j) {
    double c, s;
    direction(j, SAMPLES / 4, 0.5, &c, &s);
    const double radius = p->o.hole[2], length = ray_length(p, c, s);
    if (!(length > radius)) continue;
    logs += log(length / radius);
    area += 0.5 * (length - radius) * (length + radius);
    valid++;
  }
  if (valid == 0) return 0;
  const double angle = p->o.spacing * sqrt(logs / area), mean = logs / (double)valid;
  const double rays = 8.0 * fmax(1.0, round(2.0 * pi / (8.0 * angle)));
  const double steps = fmax(1.0, round(mean / angle));
  if (!(rays * (steps + 1.0) <= (double)SPHI_LAYOUT_MAX)) return -1;
  p->rays = (int32_t)rays;
  p->steps = (int32_t)steps;
  return 1;
}

static void add_rays(const plate *p, sphi_points *points) {
  const double radius = p->o.hole[2];
  for (int64_t j = 0; j < p->rays; ++j) {
    double c, s;
    direction(j, p->rays / 4, p->o.phase, &c, &s);
    const double length = ray_length(p, c, s);
    if (!(length > radius)) continue;
    for (int32_t k = 0; k <= p->steps; ++k) {
      const double fraction = (k + p->o.offset) / p->steps;
      if (fraction > 1.0) break;
      const double r = radius * pow(length / radius, fraction);
      const double at[2] = {p->o.hole[0] + r * c, p->o.hole[1] + r * s};
      offer(p, points, at, 1);
    }
  }
}

/* ---- lattice and faces ------------------------------------------------------------------- */

static double step_count(double length, double spacing) {
  return fmax(1.0, round(length / spacing));
}

static void add_square(const plate *p, sphi_points *points) {
  double cells[2], at[2];
  for (int32_t a = 0; a < 2; ++a) cells[a] = step_count(p->o.hi[a] - p->o.lo[a], p->o.spacing);
  for (double row = p->o.phase; row <= cells[1]; ++row)
    for (double column = p->o.phase; column <= cells[0]; ++column) {
      const double steps[2] = {column, row};
      for (int32_t a = 0; a < 2; ++a) /* from the middle: symmetric to the bit about 0 */
        at[a] = 0.5 * (p->o.lo[a] + p->o.hi[a]) +
                (2.0 * steps[a] - cells[a]) * (0.5 * (p->o.hi[a] - p->o.lo[a]) / cells[a]);
      offer(p, points, at, 0);
    }
}

/* The stretch of a face in axis a at height `level` of the other axis that a hole takes out, as
 * far as it lies beyond `from`: the first such one. Returns 0 when none is left. */
static int next_cut(const plate *p, int32_t a, double level, double from, double *lo, double *hi) {
  int found = 0;
  for (int32_t k = 0; k < p->o.holes; ++k) {
    const double *hole = sphi_hole(p->o.hole, k), d = level - hole[1 - a];
    if (!(fabs(d) < hole[2])) continue;
    const double half = sqrt((hole[2] - d) * (hole[2] + d));
    if (hole[a] + half <= from + p->tolerance || (found && hole[a] - half >= *lo)) continue;
    *lo = hole[a] - half;
    *hi = hole[a] + half;
    found = 1;
  }
  return found;
}

/* Points from one end to the other, both included; corners belong to the rows in y where both
 * faces have a row. Written from the middle, as above. */
static void add_stretch(const plate *p, sphi_points *points, int32_t a, double level, double from,
                        double to) {
  const double cells = step_count(to - from, p->o.spacing);
  const int skip_lo = a == 0 && from == p->o.lo[0] && (p->o.faces & SPH_FACE_X_LO);
  const int skip_hi = a == 0 && to == p->o.hi[0] && (p->o.faces & SPH_FACE_X_HI);
  for (double k = skip_lo; k <= cells - skip_hi; ++k) {
    double at[2];
    at[a] = 0.5 * (from + to) + (2.0 * k - cells) * (0.5 * (to - from) / cells);
    at[1 - a] = level;
    add(p, points, at);
  }
}

static void add_row(const plate *p, sphi_points *points, int32_t a, double level) {
  double from = p->o.lo[a], lo = 0.0, hi = 0.0;
  while (next_cut(p, a, level, from, &lo, &hi)) {
    if (lo > from + p->tolerance && lo < p->o.hi[a]) add_stretch(p, points, a, level, from, lo);
    if (lo >= p->o.hi[a]) break;
    from = hi;
  }
  if (from < p->o.hi[a]) add_stretch(p, points, a, level, from, p->o.hi[a]);
}

static void add_rows(const plate *p, sphi_points *points) {
  if (p->o.faces & SPH_FACE_X_LO) add_row(p, points, 1, p->o.lo[0]);
  if (p->o.faces & SPH_FACE_X_HI) add_row(p, points, 1, p->o.hi[0]);
  if (p->o.faces & SPH_FACE_Y_LO) add_row(p, points, 0, p->o.lo[1]);
  if (p->o.faces & SPH_FACE_Y_HI) add_row(p, points, 0, p->o.hi[1]);
}

static void generate(const void *layout, sphi_points *points) {
  const plate *p = layout;
  if (p->o.kind == SPH_HOLES_EQUALLY_RADIAL) add_equal_rings(p, points);
  if (p->o.kind == SPH_HOLES_RADIAL) add_rays(p, points);
  if (p->o.kind == SPH_HOLES_SQUARED) add_square(p, points);
  add_edge_rings(p, points);
  add_rows(p, points);
}

/* ---- checks ------------------------------------------------------------------------------ */

static sph_status check_numbers(sph_context *ctx, const sph_hole_layout_options *o) {
  if (o->kind < SPH_HOLES_EQUALLY_RADIAL || o->kind > SPH_HOLES_SQUARED)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: unknown kind %d", function, (int)o->kind);
  if (!(o->spacing > 0.0) || !isfinite(o->spacing))
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: the spacing is %g", function, o->spacing);
  if (o->faces < 0 || o->faces > 15)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: faces is %d", function, (int)o->faces);
  if (o->edge_rings < 0 || o->edge_rings > 100)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: edge_rings is %d, not 0..100", function,
                     (int)o->edge_rings);
  if (!(o->offset >= 0.0 && o->offset <= 1.0) || !(o->clearance >= 0.0 && o->clearance <= 1.0))
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: offset is %g, clearance %g, not 0..1", function,
                     o->offset, o->clearance);
  if (o->phase != 0.0 && o->phase != 0.5)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: phase is %g, neither 0 nor 0.5", function, o->phase);
  return SPH_OK;
}

static sph_status check(sph_context *ctx, const sph_hole_layout_options *o) {
  sph_status s = check_numbers(ctx, o);
  if (!s) s = sphi_check_box(ctx, function, 2, o->lo, o->hi);
  if (!s) s = sphi_check_holes(ctx, function, o->holes, o->hole);
  if (s) return s;
  if (o->holes < 1) return sphi_fail(ctx, SPH_ERR_ARG, "%s: no hole is given", function);
  for (int32_t a = 0; a < 2; ++a)
    if (o->hole[a] < o->lo[a] || o->hole[a] > o->hi[a])
      return sphi_fail(ctx, SPH_ERR_ARG, "%s: the centre (%g, %g) of hole 0 is outside the box",
                       function, o->hole[0], o->hole[1]);
  return SPH_OK;
}

/* Rings and lattice run over a square about hole 0; face rows are shorter. */
static sph_status check_size(sph_context *ctx, const plate *p) {
  const double side = 2.0 * farthest(p) / p->o.spacing + 2.0;
  if (side * side <= (double)SPHI_LAYOUT_MAX) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_LIMIT, "%s: the spacing %g gives %g points or more", function,
                   p->o.spacing, side * side);
}

static sph_status check_rays(sph_context *ctx, plate *p) {
  if (p->o.kind != SPH_HOLES_RADIAL) return SPH_OK;
  const int fitted = fit_rays(p);
  if (fitted < 0)
    return sphi_fail(ctx, SPH_ERR_LIMIT, "%s: the spacing %g gives too many rays", function,
                     p->o.spacing);
  if (fitted > 0) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_ARG, "%s: hole 0, of radius %g, leaves no room for a ray", function,
                   p->o.hole[2]);
}

sph_status sph_layout_holes(sph_context *ctx, const sph_hole_layout_options *options,
                            int64_t capacity, double *x, int64_t *n) {
  plate p = {.rays = 0};
  sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "context");
  if (s) return s;
  sph_hole_layout_options_init(&p.o);
  if (options == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "%s: options is NULL", function);
  s = sphi_options_read(ctx, &p.o, sizeof p.o, options);
  if (!s) s = check(ctx, &p.o);
  if (!s) s = check_size(ctx, &p);
  if (!s) s = check_rays(ctx, &p);
  if (s) return s;
  p.tolerance = 1e-12 * (farthest(&p) + hypot(p.o.hole[0], p.o.hole[1]));
  return sphi_layout_write(ctx, function, 2, generate, &p, capacity, x, n);
}
