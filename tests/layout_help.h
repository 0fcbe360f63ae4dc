/* What the tests of particle layouts share. */
#ifndef LAYOUT_HELP_H
#define LAYOUT_HELP_H

#include "check.h"

#include <stdlib.h>

#include <sph/context.h>
#include <sph/layout.h>

static const double pi = 3.14159265358979323846;

static inline sph_context *context_of(int32_t threads) {
  sph_context_options o;
  sph_context *ctx = NULL;
  sph_context_options_init(&o);
  o.threads = threads;
  check_ok(sph_context_create(&o, &ctx));
  return ctx;
}

static inline double *room(int64_t n) {
  double *values = malloc((size_t)(n + 1) * sizeof *values);
  assert_non_null(values);
  return values;
}

static inline sph_lattice_options lattice_of(int32_t dim, int32_t kind, int32_t anchor,
                                             double spacing) {
  sph_lattice_options o;
  sph_lattice_options_init(&o);
  o.dim = dim;
  o.kind = kind;
  o.anchor = anchor;
  o.spacing = spacing;
  return o;
}

/* Count, then write; the array is the caller's to free. */
static inline double *lattice(sph_context *ctx, const sph_lattice_options *o, int64_t *n) {
  check_ok(sph_layout_lattice(ctx, o, 0, NULL, n));
  double *x = room(*n * o->dim);
  int64_t written = -1;
  check_ok(sph_layout_lattice(ctx, o, *n, x, &written));
  assert_int_equal(written, *n);
  return x;
}

static inline double *holes(sph_context *ctx, const sph_hole_layout_options *o, int64_t *n) {
  check_ok(sph_layout_holes(ctx, o, 0, NULL, n));
  double *x = room(*n * 2);
  check_ok(sph_layout_holes(ctx, o, *n, x, n));
  return x;
}

static inline double distance(int32_t dim, const double *a, const double *b) {
  double sum = 0.0;
  for (int32_t k = 0; k < dim; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sqrt(sum);
}

static inline double sum(int64_t n, const double *v) {
  double total = 0.0;
  for (int64_t i = 0; i < n; ++i) total += v[i];
  return total;
}

/* Whether the point stands in the set, within `tolerance`. */
static inline int holds(int64_t n, const double *x, int32_t dim, const double *point,
                        double tolerance) {
  for (int64_t i = 0; i < n; ++i)
    if (distance(dim, x + i * dim, point) <= tolerance) return 1;
  return 0;
}

/* ---- plates, discs -------------------------------------------------------------------------- */

static const double centre_hole[3] = {0.0, 0.0, 0.3};
static const double nine[27] = {0,  0,  .3, -.7, -.7, .2, 0,  -.7, .2, .7, -.7, .2, -.7, 0,
                                .2, .7, 0,  .2,  -.7, .7, .2, 0,   .7, .2, .7,  .7, .2};

static inline sph_hole_layout_options plate(int32_t kind, int32_t count, const double *hole,
                                            double s) {
  sph_hole_layout_options o;
  sph_hole_layout_options_init(&o);
  o.kind = kind;
  o.holes = count;
  o.hole = hole;
  o.spacing = s;
  o.lo[0] = o.lo[1] = -1.0;
  return o;
}

static inline sph_region_options region(int32_t dim, int32_t count, const double *hole) {
  sph_region_options o;
  sph_region_options_init(&o);
  o.dim = dim;
  o.holes = count;
  o.hole = hole;
  for (int a = 0; a < 3; ++a) o.lo[a] = -1.0;
  return o;
}

static inline int32_t in_disc(void *user, const double *p) {
  const double r = *(const double *)user;
  return p[0] * p[0] + p[1] * p[1] < r * r;
}

static const int all_kinds[] = {SPH_HOLES_EQUALLY_RADIAL, SPH_HOLES_RADIAL, SPH_HOLES_SQUARED};

#endif
