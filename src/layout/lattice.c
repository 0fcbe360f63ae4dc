/* Cartesian and hexagonal lattices in a box. */
#include "layout_impl.h"

#include <math.h>

static const char function[] = "sph_layout_lattice";

typedef struct lattice {
  sph_lattice_options o;
  int64_t cells[3]; /* steps between the faces, per axis */
} lattice;

void sph_lattice_options_init_sized(sph_lattice_options *options, size_t size) {
  const sph_lattice_options defaults = {
      .kind = SPH_LATTICE_CARTESIAN, .anchor = SPH_LATTICE_CENTRED, .hi = {1.0, 1.0, 1.0}};
  sphi_options_init(options, size, &defaults, sizeof defaults);
}

/* A line of points along one axis, in steps from the low face: first, first + 1, ... */
typedef struct line {
  double first;
  int64_t count;
} line;

/* Points at whole steps, faces included, or at half steps between them. */
static line on_faces(int64_t cells) { return (line){0.0, cells + 1}; }
static line between_faces(int64_t cells) { return (line){0.5, cells}; }

/* Rows along x and layers along z of a hexagonal lattice are shifted by the parity of their
 * number. Centred: a quarter of a step either way, so that shifted rows hold equally many points.
 */
static line hexagonal_line(int32_t axis, int32_t anchor, int64_t cells, int shifted) {
  if (axis == 0 && anchor == SPH_LATTICE_CENTRED) return (line){shifted ? 0.75 : 0.25, cells};
  if (axis == 0) return shifted ? between_faces(cells) : on_faces(cells);
  if (anchor == SPH_LATTICE_CENTRED) /* a third of a row between the two kinds of layers */
    return (line){shifted ? 2.0 / 3.0 : 1.0 / 3.0, cells};
  return shifted ? (line){1.0 / 3.0, cells} : on_faces(cells);
}

/* The points along x of row `row` in layer `layer`, or the rows along y of a layer (row ignored),
 * or the layers along z. */
static line line_of(const lattice *l, int32_t axis, int64_t row, int64_t layer) {
  const int64_t cells = l->cells[axis];
  const int hexagonal = l->o.kind == SPH_LATTICE_HEXAGONAL;
  if (hexagonal && axis == 0 && l->o.dim > 1)
    return hexagonal_line(0, l->o.anchor, cells, (row + layer) % 2 != 0);
  if (hexagonal && axis == 1 && l->o.dim == 3)
    return hexagonal_line(1, l->o.anchor, cells, layer % 2 != 0);
  return l->o.anchor == SPH_LATTICE_FACES ? on_faces(cells) : between_faces(cells);
}

/* Measured from the middle of the box, so that mirrored points are equal to the bit about 0. */
static double coordinate(const lattice *l, int32_t axis, const line *on, int64_t k) {
  const double lo = l->o.lo[axis], hi = l->o.hi[axis], cells = (double)l->cells[axis];
  const double from_middle = 2.0 * (on->first + (double)k) - cells; /* in half steps, exact */
  return 0.5 * (lo + hi) + from_middle * (0.5 * (hi - lo) / cells);
}

static void generate(const void *layout, sphi_points *points) {
  const lattice *l = layout;
  const int32_t dim = l->o.dim;
  const line one = {0.0, 1};
  const line layers = dim > 2 ? line_of(l, 2, 0, 0) : one;
  double at[3] = {0.0, 0.0, 0.0};
  for (int64_t layer = 0; layer < layers.count; ++layer) {
    if (dim > 2) at[2] = coordinate(l, 2, &layers, layer);
    const line rows = dim > 1 ? line_of(l, 1, 0, layer) : one;
    for (int64_t row = 0; row < rows.count; ++row) {
      if (dim > 1) at[1] = coordinate(l, 1, &rows, row);
      const line columns = line_of(l, 0, row, layer);
      for (int64_t k = 0; k < columns.count; ++k) {
        at[0] = coordinate(l, 0, &columns, k);
        if (l->o.inside == NULL || l->o.inside(l->o.inside_user, at)) sphi_points_add(points, at);
      }
    }
  }
}

static sph_status check(sph_context *ctx, const sph_lattice_options *o) {
  const sph_status s = sphi_check_box(ctx, function, o->dim, o->lo, o->hi);
  if (s) return s;
  if (o->kind != SPH_LATTICE_CARTESIAN && o->kind != SPH_LATTICE_HEXAGONAL)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: unknown kind %d", function, (int)o->kind);
  if (o->anchor != SPH_LATTICE_CENTRED && o->anchor != SPH_LATTICE_FACES)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: unknown anchor %d", function, (int)o->anchor);
  if (!(o->spacing > 0.0) || !isfinite(o->spacing))
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: the spacing is %g", function, o->spacing);
  return SPH_OK;
}

/* Whole steps along each axis. */
static sph_status fit(sph_context *ctx, lattice *l) {
  const sph_lattice_options *o = &l->o;
  const double step[3] = {1.0, sqrt(0.75), sqrt(2.0 / 3.0)};
  double points = 1.0;
  for (int32_t a = 0; a < o->dim; ++a) {
    const double s = o->kind == SPH_LATTICE_HEXAGONAL ? step[a] * o->spacing : o->spacing;
    const double cells = fmax(1.0, round((o->hi[a] - o->lo[a]) / s));
    points *= cells + 1.0;
    if (!(points <= (double)SPHI_LAYOUT_MAX))
      return sphi_fail(ctx, SPH_ERR_LIMIT, "%s: the spacing %g gives %g points or more", function,
                       o->spacing, points);
    l->cells[a] = (int64_t)cells;
  }
  return SPH_OK;
}

sph_status sph_layout_lattice(sph_context *ctx, const sph_lattice_options *options,
                              int64_t capacity, double *x, int64_t *n) {
  lattice l = {.cells = {1, 1, 1}};
  sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "context");
  if (s) return s;
  sph_lattice_options_init(&l.o);
  if (options == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "%s: options is NULL", function);
  s = sphi_options_read(ctx, &l.o, sizeof l.o, options);
  if (!s) s = check(ctx, &l.o);
  if (!s) s = fit(ctx, &l);
  return s ? s : sphi_layout_write(ctx, function, l.o.dim, generate, &l, capacity, x, n);
}
