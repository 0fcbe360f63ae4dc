/* What the two examples of shock chambers share: a compressed material in the middle of a square
 * box of gas, at rest, let go at t = 0.
 *
 * The box is |x|, |y| < 2.5, with a frame of particles that stay as they are, as thick as a support
 * (the source's reaches to 3). One quarter is computed, with planes of symmetry at x = 0 and y = 0:
 * the lattice is symmetric about them, so that it does what the whole does, at a quarter of the
 * cost. Equal spacing 1/N_l, masses by density. */
#ifndef EXAMPLES_SHOCK_CHAMBER_H
#define EXAMPLES_SHOCK_CHAMBER_H

#include "shock_plane.h"

enum { INSIDE = 0, OUTSIDE = 1 };

typedef struct chamber_state {
  double rho, p, gamma, reference_pressure;
} chamber_state;

typedef struct chamber_setup {
  const char *name;
  chamber_state state[2]; /* of INSIDE and OUTSIDE */
  int circle;             /* inside: r < 0.5, not |x|, |y| < 0.5 */
  int cells;              /* N_l, of a unit of length */
  int32_t smoothing;
  sph_dissipation loss;
} chamber_setup;

static const double chamber_half = 0.5, chamber_box = 2.5;

static inline int chamber_inside(const chamber_setup *c, const double *x) {
  return c->circle ? hypot(x[0], x[1]) < chamber_half : fmax(x[0], x[1]) < chamber_half;
}

static inline void chamber_fill(plane *s, const chamber_setup *c) {
  const double *x = field(s->ctx, s->set, SPH_FIELD_X);
  double *rho = field(s->ctx, s->set, SPH_FIELD_RHO), *p = field(s->ctx, s->set, SPH_FIELD_P);
  (void)field(s->ctx, s->set, SPH_FIELD_V); /* zeros */
  for (int64_t i = 0; i < s->n; ++i) {
    const int phase = chamber_inside(c, x + 2 * i) ? INSIDE : OUTSIDE;
    sph_particles_phases(s->set)[i] = phase;
    rho[i] = c->state[phase].rho;
    p[i] = c->state[phase].p;
    if (fmax(x[2 * i], x[2 * i + 1]) > chamber_box) sph_particles_roles(s->set)[i] = SPH_ROLE_WALL;
  }
}

static inline void chamber_create(plane *s, const chamber_setup *c) {
  const double dp = 1.0 / c->cells, edge = ceil(chamber_box * c->cells - 1e-9) + 4.0;
  const double lo[2] = {0.0, 0.0}, hi[2] = {edge * dp, edge * dp};
  sph_material *laws[2];
  sph_shocks_options o;
  sph_shocks_options_init(&o);
  o.dim = 2;
  o.smoothing = c->smoothing;
  o.dissipation = &c->loss;
  plane_create(s, dp);
  plane_lattice(s, lo, hi, NULL, NULL);
  chamber_fill(s, c);
  for (int axis = 0; axis < 2; ++axis) plane_mirror(s, axis, 0.0, 1.0);
  for (int k = 0; k < 2; ++k)
    laws[k] = plane_gas(s->ctx, c->state[k].gamma, c->state[k].reference_pressure);
  plane_start(s, &o, laws, 2);
}

/* ---- figures ----------------------------------------------------------------------------- */

/* Distance along the positive x axis, or along the diagonal, of a particle that is nearer to it
 * than its h, as the source takes them; NaN of others. */
static inline double chamber_along(const plane *s, int64_t i, int diagonal) {
  const double x = s->x[2 * i], y = s->x[2 * i + 1];
  if (!diagonal) return y < s->h[i] ? x : NAN;
  return fabs(x - y) < sqrt(2.0) * s->h[i] ? (x + y) / sqrt(2.0) : NAN;
}

/* Means over bins along a line; a bin without particles has count 0. */
enum { CHAMBER_BINS = 64 };
static const double chamber_bins_end = 1.6;

typedef struct chamber_profile {
  int count[CHAMBER_BINS];
  double rho[CHAMBER_BINS], p[CHAMBER_BINS], e[CHAMBER_BINS];
} chamber_profile;

static inline chamber_profile chamber_bin(const plane *s, int diagonal) {
  chamber_profile b;
  memset(&b, 0, sizeof b);
  for (int64_t i = 0; i < s->n; ++i) {
    const double at = chamber_along(s, i, diagonal) / chamber_bins_end * CHAMBER_BINS;
    if (!(at < CHAMBER_BINS)) continue;
    const int k = (int)at;
    b.count[k] += 1;
    b.rho[k] += s->rho[i];
    b.p[k] += s->p[i];
    b.e[k] += s->e[i];
  }
  for (int k = 0; k < CHAMBER_BINS; ++k) {
    b.rho[k] /= b.count[k];
    b.p[k] /= b.count[k];
    b.e[k] /= b.count[k];
  }
  return b;
}

/* The outermost place where the binned pressure passes `level`: the shock, for half its jump. */
static inline double chamber_shock(const chamber_profile *b, double level) {
  const double width = chamber_bins_end / CHAMBER_BINS;
  double next = NAN, next_x = NAN;
  for (int k = CHAMBER_BINS - 1; k >= 0; --k) {
    if (b->count[k] == 0) continue;
    const double x = (k + 0.5) * width;
    if (b->p[k] > level) return x + (next_x - x) * (level - b->p[k]) / (next - b->p[k]);
    next = b->p[k];
    next_x = x;
  }
  return NAN;
}

/* Outermost particle of the inside, and innermost of the outside, along a line. */
typedef struct chamber_range {
  double inside, outside;
} chamber_range;

static inline chamber_range chamber_contact(const plane *s, int diagonal) {
  chamber_range c = {0.0, INFINITY};
  for (int64_t i = 0; i < s->n; ++i) {
    const double at = chamber_along(s, i, diagonal);
    if (s->phase[i] == INSIDE && at > c.inside) c.inside = at;
    if (s->phase[i] == OUTSIDE && at < c.outside) c.outside = at;
  }
  return c;
}

/* How far the two sides have got into each other: the largest excess, over directions of five
 * degrees each, of the outermost particle of the inside above the innermost of the outside, in
 * spacings of the start. Below 0: they are apart everywhere. */
static inline double chamber_overlap(const plane *s) {
  enum { DIRECTIONS = 18 };
  double in[DIRECTIONS] = {0.0}, out[DIRECTIONS], most = -INFINITY;
  for (int k = 0; k < DIRECTIONS; ++k) out[k] = INFINITY;
  for (int64_t i = 0; i < s->n; ++i) {
    const double x = s->x[2 * i], y = s->x[2 * i + 1], r = hypot(x, y);
    const int k = (int)fmin(atan2(y, x) / (2.0 * atan(1.0)) * DIRECTIONS, DIRECTIONS - 1);
    if (s->phase[i] == INSIDE)
      in[k] = fmax(in[k], r);
    else
      out[k] = fmin(out[k], r);
  }
  for (int k = 0; k < DIRECTIONS; ++k) most = fmax(most, in[k] - out[k]);
  return most / s->dp;
}

/* Position, density, pressure, energy and phase of the particles that moved. */
static inline void chamber_write(const plane *s, const char *path) {
  FILE *file = open_output(path);
  fprintf(file, "x,y,rho,p,e,phase,along\n");
  for (int64_t i = 0; i < s->n; ++i)
    if (fmax(s->x[2 * i], s->x[2 * i + 1]) < chamber_bins_end)
      fprintf(file, "%.7g,%.7g,%.7g,%.7g,%.7g,%d,%.7g\n", s->x[2 * i], s->x[2 * i + 1], s->rho[i],
              s->p[i], s->e[i], (int)s->phase[i], chamber_along(s, i, 0));
  fclose(file);
}

#endif
