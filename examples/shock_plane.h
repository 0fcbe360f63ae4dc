/* What the two-dimensional examples of shocks share: a scene of particles on square lattices, its
 * run by the scheme of shocks.h, and figures of it.
 *
 *   plane_create(&s, dp);
 *   plane_lattice(&s, lo, hi, inside, user);    particles at the middles of cells of side dp
 *   ... the host fills V, RHO, P, phases, roles ...
 *   plane_mirror(&s, axis, at, into);           a wall, or a plane of symmetry
 *   plane_start(&s, &options, laws, count);     M = rho dp^2, E from P by the law of the phase
 *   plane_run(&s, t);                           up to time t; may be called again
 *   plane_destroy(&s); */
#ifndef EXAMPLES_SHOCK_PLANE_H
#define EXAMPLES_SHOCK_PLANE_H

#include "common.h"

#include <string.h>
#include <time.h>

typedef struct plane {
  double dp;           /* side of a cell */
  int32_t periodic[2]; /* of the scheme's options, for the walls; set before plane_mirror() */
  sph_context *ctx;
  sph_particles *set;
  sph_ghosts *ghosts; /* NULL: no walls */
  sph_shocks *shocks;
  int64_t n; /* particles without ghosts, frozen ones too */
  const double *x, *v, *m, *rho, *h, *p, *e;
  const int32_t *phase;
  sph_shocks_ledger ledger; /* after the last run */
  double energy_start;
  int64_t neighbours; /* most of a particle, looked at after every 16th step */
  double seconds;     /* of the processor */
  int64_t seen;       /* steps */
} plane;

/* ---- set-up ------------------------------------------------------------------------------ */

static inline void plane_create(plane *s, double dp) {
  sph_particles_options options;
  memset(s, 0, sizeof *s);
  s->dp = dp;
  need(NULL, sph_context_create(NULL, &s->ctx));
  sph_particles_options_init(&options);
  options.dim = 2;
  need(s->ctx, sph_particles_create(s->ctx, &options, &s->set));
}

/* Particles on the lattice of [lo, hi], where `inside` (NULL: everywhere) says so. */
static inline void plane_lattice(plane *s, const double lo[2], const double hi[2],
                                 sph_inside_fn inside, void *user) {
  sph_lattice_options o;
  int64_t count, first;
  sph_lattice_options_init(&o);
  o.dim = 2;
  o.spacing = s->dp;
  for (int a = 0; a < 2; ++a) o.lo[a] = lo[a], o.hi[a] = hi[a];
  o.inside = inside;
  o.inside_user = user;
  need(s->ctx, sph_layout_lattice(s->ctx, &o, 0, NULL, &count));
  need(s->ctx, sph_particles_add(s->set, count, &first));
  double *x = field(s->ctx, s->set, SPH_FIELD_X) + 2 * first;
  need(s->ctx, sph_layout_lattice(s->ctx, &o, count, x, &count));
  s->n = first + count;
}

/* A slip wall, or a plane of symmetry, at `at` on an axis; the body lies above it where `into` is
 * 1, below it where it is -1. */
static inline void plane_mirror(plane *s, int axis, double at, double into) {
  sph_wall wall;
  sph_ghosts_options o;
  sph_ghosts_options_init(&o);
  o.dim = 2;
  for (int a = 0; a < 2; ++a) o.periodic[a] = s->periodic[a];
  o.support = 3.0;              /* of the Gaussian */
  o.escape = SPH_ESCAPE_IGNORE; /* what noise carries through has no image until it is back */
  if (!s->ghosts) need(s->ctx, sph_ghosts_create(s->ctx, &o, &s->ghosts));
  sph_wall_init(&wall);
  wall.kind = SPH_WALL_SLIP;
  wall.point[axis] = at;
  wall.normal[axis] = into;
  need(s->ctx, sph_ghosts_add_wall(s->ghosts, &wall, NULL));
}

/* An ideal gas, or with a reference pressure a stiffened one. */
static inline sph_material *plane_gas(sph_context *ctx, double gamma, double reference_pressure) {
  sph_material *law;
  sph_gas_options o;
  sph_gas_options_init(&o);
  o.gamma = gamma;
  o.reference_pressure = reference_pressure;
  need(ctx, sph_material_create_gas(ctx, &o, &law));
  return law;
}

/* M and E of every particle from RHO and P. */
static inline void plane_masses_and_energies(plane *s, sph_material *const *laws) {
  const double *rho = field(s->ctx, s->set, SPH_FIELD_RHO);
  const double *p = field(s->ctx, s->set, SPH_FIELD_P);
  double *m = field(s->ctx, s->set, SPH_FIELD_M), *e = field(s->ctx, s->set, SPH_FIELD_E);
  sph_material_block one;
  sph_material_block_init(&one);
  one.dim = 2;
  one.n = 1;
  for (int64_t i = 0; i < s->n; ++i) {
    m[i] = rho[i] * s->dp * s->dp;
    one.rho = rho + i;
    one.p = p + i;
    need(s->ctx, sph_material_energy(laws[sph_particles_phases(s->set)[i]], &one, e + i));
  }
}

static inline void plane_look(plane *s) {
  s->x = sph_particles_field_const(s->set, SPH_FIELD_X);
  s->v = sph_particles_field_const(s->set, SPH_FIELD_V);
  s->m = sph_particles_field_const(s->set, SPH_FIELD_M);
  s->rho = sph_particles_field_const(s->set, SPH_FIELD_RHO);
  s->h = sph_particles_field_const(s->set, SPH_FIELD_H);
  s->p = sph_particles_field_const(s->set, SPH_FIELD_P);
  s->e = sph_particles_field_const(s->set, SPH_FIELD_E);
  s->phase = sph_particles_phases(s->set);
  need(s->ctx, sph_shocks_balance(s->shocks, &s->ledger));
}

/* The scheme, with one law for each phase (released here, the scheme keeps them), at time 0. */
static inline void plane_start(plane *s, const sph_shocks_options *options, sph_material **laws,
                               int count) {
  need(s->ctx, sph_shocks_create(s->ctx, s->set, options, &s->shocks));
  need(s->ctx, sph_shocks_set_ghosts(s->shocks, s->ghosts));
  plane_masses_and_energies(s, laws);
  for (int k = 0; k < count; ++k) {
    need(s->ctx, sph_shocks_set_material(s->shocks, k, laws[k]));
    sph_material_destroy(laws[k]);
  }
  need(s->ctx, sph_shocks_start(s->shocks, 0.0));
  sph_shocks_ledger_init(&s->ledger);
  plane_look(s);
  s->energy_start = s->ledger.total;
}

static inline void plane_destroy(plane *s) {
  sph_shocks_destroy(s->shocks);
  sph_ghosts_destroy(s->ghosts);
  sph_particles_destroy(s->set);
  sph_context_destroy(s->ctx);
}

/* ---- running ----------------------------------------------------------------------------- */

static inline int64_t plane_most_neighbours(sph_neighbors *list, int64_t n) {
  const int64_t *first;
  const int32_t *other;
  int64_t most = 0;
  if (sph_neighbors_rows(list, &first, &other) != SPH_OK) return 0;
  for (int64_t i = 0; i < n; ++i)
    if (first[i + 1] - first[i] > most) most = first[i + 1] - first[i];
  return most;
}

static inline int32_t plane_after(void *user, sph_shocks *shocks, const sph_step_info *info) {
  plane *s = user;
  (void)info;
  if (s->seen++ % 16 != 0) return 0;
  const int64_t most = plane_most_neighbours(sph_shocks_list(shocks), s->n);
  if (most > s->neighbours) s->neighbours = most;
  return 0;
}

/* Up to time t. Answers what the scheme does: a set-up may be one that fails. */
static inline sph_status plane_run(plane *s, double t) {
  const clock_t start = clock();
  const sph_status status = sph_shocks_run(s->shocks, t, plane_after, s);
  s->seconds += (double)(clock() - start) / CLOCKS_PER_SEC;
  plane_look(s);
  return status;
}

/* Change of kinetic + internal energy that nothing accounts for, relative. */
static inline double plane_drift(const plane *s) {
  return fabs(s->ledger.energy_error / s->energy_start);
}

/* Particles and steps for each second of the processor. */
static inline double plane_speed(const plane *s) {
  return (double)s->n * (double)s->ledger.steps / s->seconds;
}

#endif
