/* What the examples of hypervelocity impact share: a disc of metal that hits a plate of one or more
 * layers, in plane strain; its run by the scheme of shocks.h, and figures of it.
 *
 * The flight is along +x; the plate fills 0 < x < thickness and |y| < width/2, and the disc starts
 * one microsecond before it meets the plate. Square lattices of spacing D, masses rho D^2; nothing
 * holds the plate, all surfaces are free, and there is no law of contact: all particles interact.
 * Mie-Grueneisen with the cubic curve, von Mises without hardening, no fracture, no spall: what
 * separates does so because its particles have left each other's support.
 *
 * Two options are not the defaults. Where fragments tear, particles clump, the sum that makes omega
 * exceeds what their density says, and forces grow as 1/omega^2: with the floor of 0.2 such clumps
 * vibrate unstably at the default cfl, which shows as a gain of energy of 2e-3; from 0.5 on none
 * was seen. And steps of at most 1 per cent of density, which act for the two microseconds of the
 * first shock, cut the error of the energy to a seventh, 7e-6.
 *
 * Phase 0 is the disc, phase k layer k of the plate, from the front. SI units; figures in mm.
 *
 * Figures. The source does not say how it measures; here
 *   cloud    all particles more than 1 mm behind the rear face. Length: 99.9 per cent of them are
 *            nearer to the rear face. Width: of the middle 99.9 per cent in y.
 *   opening  columns of the plate, 0.25 mm wide in y, from 1 mm before to 1 mm behind it, that hold
 *            less than half of what they held at the start; without gaps about the axis. */
#ifndef EXAMPLES_IMPACT_H
#define EXAMPLES_IMPACT_H

#include "common.h"

#include <string.h>
#include <time.h>

enum { IMPACT_LAYERS = 5, IMPACT_KEYS = 200 };

static const double impact_mm = 1e-3, impact_us = 1e-6;

typedef struct impact_layer {
  double thickness;
  int32_t material; /* as sph_mie_gruneisen_constants() names it */
} impact_layer;

typedef struct impact_setup {
  const char *name; /* of the plate */
  int32_t disc;     /* its material */
  double radius, speed;
  int layers;
  impact_layer layer[IMPACT_LAYERS]; /* from the front */
  double width, spacing;
} impact_setup;

typedef struct impact {
  impact_setup setup;
  sph_context *ctx;
  sph_particles *set;
  sph_shocks *shocks;
  int64_t n, first[IMPACT_LAYERS + 2]; /* of each phase; n at the end */
  double rear;                         /* x of the rear face: the thickness */
  double energy_start, seconds;
  sph_shocks_ledger ledger;
} impact;

/* ---- set-up ------------------------------------------------------------------------------ */

static inline double impact_thickness(const impact_setup *s) {
  double sum = 0.0;
  for (int k = 0; k < s->layers; ++k) sum += s->layer[k].thickness;
  return sum;
}

static inline int32_t impact_material_of(const impact_setup *s, int phase) {
  return phase == 0 ? s->disc : s->layer[phase - 1].material;
}

/* A metal or resin: pressure by Mie and Grueneisen, strength by von Mises. */
static inline sph_material *impact_material(sph_context *ctx, int32_t id, double *density) {
  sph_material *pressure, *solid;
  sph_mie_gruneisen_options eos;
  sph_strength_options strength;
  sph_mie_gruneisen_options_init(&eos);
  sph_strength_options_init(&strength);
  need(ctx, sph_mie_gruneisen_constants(id, &eos, &strength));
  need(ctx, sph_material_create_mie_gruneisen(ctx, &eos, &pressure));
  need(ctx, sph_material_create_strength(ctx, pressure, &strength, &solid));
  sph_material_destroy(pressure); /* the solid keeps it */
  *density = eos.density;
  return solid;
}

static inline int32_t impact_in_disc(void *radius, const double *x) {
  return hypot(x[0], x[1]) < *(const double *)radius;
}

/* Lattice points of the disc about the origin, or of a layer. */
static inline sph_lattice_options impact_lattice(impact_setup *s, int phase) {
  sph_lattice_options o;
  sph_lattice_options_init(&o);
  o.dim = 2;
  o.spacing = s->spacing;
  if (phase == 0) {
    o.lo[0] = o.lo[1] = -(o.hi[0] = o.hi[1] = s->radius);
    o.inside = impact_in_disc;
    o.inside_user = &s->radius;
    return o;
  }
  o.lo[0] = 0.0;
  for (int k = 0; k + 1 < phase; ++k) o.lo[0] += s->layer[k].thickness;
  o.hi[0] = o.lo[0] + s->layer[phase - 1].thickness;
  o.hi[1] = 0.5 * s->width;
  o.lo[1] = -o.hi[1];
  return o;
}

/* Of one cell: the lattice is stretched to fit where the spacing does not divide the box. */
static inline double impact_cell(const sph_lattice_options *o) {
  double area = 1.0;
  for (int a = 0; a < 2; ++a) {
    const double side = o->hi[a] - o->lo[a];
    area *= side / (double)llround(side / o->spacing);
  }
  return area;
}

static inline void impact_fill(impact *s, int phase, double density, double area) {
  const double start = -s->setup.radius - s->setup.speed * impact_us;
  double *x = field(s->ctx, s->set, SPH_FIELD_X), *v = field(s->ctx, s->set, SPH_FIELD_V);
  double *m = field(s->ctx, s->set, SPH_FIELD_M), *rho = field(s->ctx, s->set, SPH_FIELD_RHO);
  for (int64_t i = s->first[phase]; i < s->first[phase + 1]; ++i) {
    sph_particles_phases(s->set)[i] = phase;
    m[i] = density * area;
    rho[i] = density;
    if (phase > 0) continue;
    x[2 * i] += start;
    v[2 * i] = s->setup.speed;
  }
}

/* The disc or a layer: its particles and its material. */
static inline void impact_add(impact *s, int phase) {
  const sph_lattice_options lattice = impact_lattice(&s->setup, phase);
  int64_t count;
  double density;
  need(s->ctx, sph_layout_lattice(s->ctx, &lattice, 0, NULL, &count));
  need(s->ctx, sph_particles_add(s->set, count, &s->first[phase]));
  s->n = s->first[phase + 1] = s->first[phase] + count;
  double *x = field(s->ctx, s->set, SPH_FIELD_X) + 2 * s->first[phase];
  need(s->ctx, sph_layout_lattice(s->ctx, &lattice, count, x, &count));
  sph_material *solid = impact_material(s->ctx, impact_material_of(&s->setup, phase), &density);
  need(s->ctx, sph_shocks_set_material(s->shocks, phase, solid));
  sph_material_destroy(solid); /* the scheme keeps it */
  impact_fill(s, phase, density, impact_cell(&lattice));
}

/* Everything at time 0, one microsecond before the impact. */
static inline void impact_create(impact *s, const impact_setup *setup) {
  sph_particles_options particles;
  sph_shocks_options options;
  memset(s, 0, sizeof *s);
  s->setup = *setup;
  s->rear = impact_thickness(setup);
  need(NULL, sph_context_create(NULL, &s->ctx));
  sph_particles_options_init(&particles);
  particles.dim = 2;
  need(s->ctx, sph_particles_create(s->ctx, &particles, &s->set));
  sph_shocks_options_init(&options); /* number smoothing, a_v = 1, a_rho = 0.5, a_e = 0.1, b = 2 */
  options.dim = 2;
  options.omega_floor = 0.5;
  options.density_limit = 0.01;
  need(s->ctx, sph_shocks_create(s->ctx, s->set, &options, &s->shocks));
  for (int phase = 0; phase <= setup->layers; ++phase) impact_add(s, phase);
  need(s->ctx, sph_shocks_start(s->shocks, 0.0));
  sph_shocks_ledger_init(&s->ledger);
  need(s->ctx, sph_shocks_balance(s->shocks, &s->ledger));
  s->energy_start = s->ledger.total;
}

static inline void impact_destroy(impact *s) {
  sph_shocks_destroy(s->shocks);
  sph_particles_destroy(s->set);
  sph_context_destroy(s->ctx);
}

/* To a time after the impact. */
static inline void impact_run(impact *s, double after) {
  const clock_t start = clock();
  need(s->ctx, sph_shocks_run(s->shocks, impact_us + after, NULL, NULL));
  s->seconds += (double)(clock() - start) / CLOCKS_PER_SEC;
  need(s->ctx, sph_shocks_balance(s->shocks, &s->ledger));
}

/* ---- figures ----------------------------------------------------------------------------- */

static inline int impact_compare(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* The value below which `part` of the sorted ones lie. */
static inline double impact_quantile(const double *sorted, int64_t n, double part) {
  return sorted[llround(part * (double)(n - 1))];
}

typedef struct impact_cloud {
  double length, width;
  int64_t particles;
} impact_cloud;

/* `part` of the cloud counts, 0.999 for the figures above. */
static inline impact_cloud impact_measure_cloud(const impact *s, double part) {
  const double *x = sph_particles_field_const(s->set, SPH_FIELD_X), edge = s->rear + impact_mm;
  double *along = malloc(2 * (size_t)s->n * sizeof *along), *across = along + s->n;
  impact_cloud cloud = {NAN, NAN, 0};
  if (!along) exit(2);
  for (int64_t i = 0; i < s->n; ++i) {
    if (x[2 * i] <= edge) continue;
    along[cloud.particles] = x[2 * i] - s->rear;
    across[cloud.particles++] = x[2 * i + 1];
  }
  if (cloud.particles > 0) {
    qsort(along, (size_t)cloud.particles, sizeof *along, impact_compare);
    qsort(across, (size_t)cloud.particles, sizeof *across, impact_compare);
    cloud.length = impact_quantile(along, cloud.particles, part);
    cloud.width = impact_quantile(across, cloud.particles, 0.5 + 0.5 * part) -
                  impact_quantile(across, cloud.particles, 0.5 - 0.5 * part);
  }
  free(along);
  return cloud;
}

/* Of the plate. 0: no column has lost half. */
static inline double impact_opening(const impact *s) {
  enum { BINS = 4096 };
  static const double bin = 0.25e-3;
  const double *x = sph_particles_field_const(s->set, SPH_FIELD_X);
  const double full = (double)(s->n - s->first[1]) * bin / s->setup.width; /* at the start */
  int64_t count[BINS] = {0};
  for (int64_t i = s->first[1]; i < s->n; ++i) {
    const double at = floor(x[2 * i + 1] / bin) + BINS / 2;
    if (x[2 * i] < -impact_mm || x[2 * i] > s->rear + impact_mm) continue;
    if (at >= 0.0 && at < BINS) ++count[(int)at];
  }
  int lo = BINS / 2, hi = BINS / 2;
  while (hi < BINS && (double)count[hi] < 0.5 * full) ++hi;
  while (lo > 0 && (double)count[lo - 1] < 0.5 * full) --lo;
  return bin * (double)(hi - lo);
}

/* What of the first energy is missing. */
static inline double impact_energy_loss(const impact *s) {
  return fabs(1.0 - s->ledger.total / s->energy_start);
}

static inline double impact_rate(const impact *s) { /* particle-steps a second */
  return (double)s->n * (double)s->ledger.steps / s->seconds;
}

static inline sph_riemann_side impact_side(sph_context *ctx, int32_t material, double v) {
  sph_riemann_side side;
  sph_mie_gruneisen_options eos;
  sph_mie_gruneisen_options_init(&eos);
  need(ctx, sph_mie_gruneisen_constants(material, &eos, NULL));
  sph_riemann_side_init(&side);
  side.law = SPH_RIEMANN_MIE_GRUNEISEN;
  side.rho = side.density = eos.density;
  side.sound_speed = eos.sound_speed;
  side.slope = eos.slope;
  side.gruneisen = eos.gruneisen;
  side.curve = eos.curve;
  side.v = v;
  return side;
}

/* Pressure and velocity where plane layers of two materials meet head-on, exactly. */
static inline sph_riemann_solution impact_planar(int32_t disc, int32_t plate, double speed) {
  sph_context *ctx = NULL;
  sph_riemann_solution solution;
  need(ctx, sph_context_create(NULL, &ctx));
  const sph_riemann_side left = impact_side(ctx, disc, speed), right = impact_side(ctx, plate, 0.0);
  sph_riemann_solution_init(&solution);
  need(ctx, sph_riemann_solve(ctx, &left, &right, &solution));
  sph_context_destroy(ctx);
  return solution;
}

/* ---- what is written --------------------------------------------------------------------- */

/* Positions in mm, phase and speed as CSV, for pictures. */
static inline void impact_write(const impact *s, const char *path) {
  const double *x = sph_particles_field_const(s->set, SPH_FIELD_X);
  const double *v = sph_particles_field_const(s->set, SPH_FIELD_V);
  FILE *file = open_output(path);
  fprintf(file, "x,y,phase,speed\n");
  for (int64_t i = 0; i < s->n; ++i)
    fprintf(file, "%.5g,%.5g,%d,%.4g\n", x[2 * i] / impact_mm, x[2 * i + 1] / impact_mm,
            (int)sph_particles_phases(s->set)[i], hypot(v[2 * i], v[2 * i + 1]));
  fclose(file);
}

#endif
