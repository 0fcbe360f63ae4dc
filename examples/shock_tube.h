/* What the one-dimensional examples of shocks share: a tube or bar of several materials side by
 * side, its run by the scheme of shocks.h, and figures of it.
 *
 * A case is a tube_setup: regions from left to right, each with the state and the law of a
 * sph_riemann_side, so that the exact solution and the particles are made of the same numbers.
 * Particles stand at the middles of cells: with equal spacing D everywhere, masses rho D, or with
 * equal masses, spacing D in the region of lowest density rho_L and D rho_L/rho elsewhere. Beyond
 * both ends the outer regions go on for `frozen`, particles that keep what they have; 0: free ends,
 * right where the pressure is 0.
 *
 * Figures: L1 is the mean of |numerical - exact| over a window, by length (nothing where no
 * material is): a mean over particles would count dense regions, where they are more, twice over.
 * "Contact" is the largest and the smallest of P/P* - 1 over the 25 particles around a contact, in
 * per cent. */
#ifndef EXAMPLES_SHOCK_TUBE_H
#define EXAMPLES_SHOCK_TUBE_H

#include "common.h"

#include <string.h>
#include <time.h>

enum { TUBE_REGIONS = 8, TUBE_AROUND = 12, TUBE_KEYS = 200 };

typedef struct tube_region {
  double from, to;
  sph_riemann_side state; /* law, density, velocity, pressure */
} tube_region;

typedef struct tube_setup {
  const char *name;
  int regions;
  tube_region region[TUBE_REGIONS];
  double spacing;       /* D */
  int equal_masses;     /* 0: equal spacing */
  double frozen;        /* thickness of the layers beyond the ends */
  int mirror[2];        /* 1: a reflecting wall at this end */
  double end;           /* time */
  double dt;            /* 0 (default): the scheme's own stable step */
  double first;         /* first step, from which steps grow by an eighth each up to the stable one;
                         * 0: the stable one. At rest that does not see how fast a large jump of
                         * pressure is about to set light particles in motion */
  int32_t smoothing;    /* SPH_SMOOTHING_*; default NUMBER */
  int32_t density;      /* SPH_SHOCKS_*; default DIFFERENTIAL */
  sph_dissipation loss; /* default: that of the library, but without limit of the mass flux */
} tube_setup;

typedef struct tube {
  tube_setup setup;
  sph_context *ctx;
  sph_particles *set;
  sph_shocks *shocks;
  sph_ghosts *ghosts;              /* NULL without walls */
  int64_t n;                       /* particles, frozen ones too */
  int64_t first[TUBE_REGIONS + 1]; /* of each region; n at the end */
  const double *x, *rho, *v, *p, *e;
  sph_shocks_ledger ledger; /* at the end */
  double energy_start;
  double seconds;
} tube;

/* ---- set-up ------------------------------------------------------------------------------ */

static inline tube_setup tube_defaults(const char *name) {
  tube_setup s;
  memset(&s, 0, sizeof s);
  s.name = name;
  s.smoothing = SPH_SMOOTHING_NUMBER;
  s.density = SPH_SHOCKS_DIFFERENTIAL;
  sph_dissipation_init(&s.loss);
  s.loss.flux_limit = 0.0; /* the source has none; needed beside liquids in tension only */
  return s;
}

/* Append a region on the right; the law is filled in by the caller. */
static inline sph_riemann_side *tube_add(tube_setup *s, double from, double to, double rho,
                                         double v, double p) {
  tube_region *r = &s->region[s->regions++];
  r->from = from;
  r->to = to;
  sph_riemann_side_init(&r->state);
  r->state.rho = rho;
  r->state.v = v;
  r->state.p = p;
  return &r->state;
}

/* The equation of state of a side. */
static inline sph_material *tube_material(sph_context *ctx, const sph_riemann_side *s) {
  sph_material *law = NULL;
  sph_gas_options gas;
  sph_barotropic_options liquid;
  sph_mie_gruneisen_options solid;
  if (s->law == SPH_RIEMANN_GAS) {
    sph_gas_options_init(&gas);
    gas.gamma = s->gamma;
    gas.reference_pressure = s->reference_pressure;
    need(ctx, sph_material_create_gas(ctx, &gas, &law));
  } else if (s->law == SPH_RIEMANN_BAROTROPIC) {
    sph_barotropic_options_init(&liquid);
    liquid.density = s->density;
    liquid.sound_speed = s->sound_speed;
    liquid.gamma = s->gamma;
    liquid.background = s->background;
    need(ctx, sph_material_create_barotropic(ctx, &liquid, &law));
  } else {
    sph_mie_gruneisen_options_init(&solid);
    solid.density = s->density;
    solid.sound_speed = s->sound_speed;
    solid.slope = s->slope;
    solid.gruneisen = s->gruneisen;
    solid.curve = s->curve;
    need(ctx, sph_material_create_mie_gruneisen(ctx, &solid, &law));
  }
  return law;
}

static inline double tube_energy(sph_context *ctx, const sph_material *law,
                                 const sph_riemann_side *s) {
  double e;
  sph_material_block block;
  sph_material_block_init(&block);
  block.dim = 1;
  block.n = 1;
  block.rho = &s->rho;
  block.p = &s->p;
  need(ctx, sph_material_energy(law, &block, &e));
  return e;
}

static inline double tube_spacing(const tube_setup *s, int region) {
  double lowest = s->region[0].state.rho;
  for (int k = 1; k < s->regions; ++k) lowest = fmin(lowest, s->region[k].state.rho);
  return s->equal_masses ? s->spacing * lowest / s->region[region].state.rho : s->spacing;
}

/* Cells of a region, and of the frozen layer beside it. */
static inline int64_t tube_cells(const tube_setup *s, int region) {
  const tube_region *r = &s->region[region];
  return llround((r->to - r->from) / tube_spacing(s, region));
}
static inline int64_t tube_layer(const tube_setup *s, int region) {
  return llround(s->frozen / tube_spacing(s, region));
}

static inline int64_t tube_count(tube *t) {
  const tube_setup *s = &t->setup;
  t->n = tube_layer(s, 0);
  for (int k = 0; k < s->regions; ++k) {
    t->first[k] = t->n;
    t->n += tube_cells(s, k);
  }
  t->n += tube_layer(s, s->regions - 1);
  t->first[s->regions] = t->n;
  t->first[0] = 0; /* a layer belongs to its region */
  return t->n;
}

/* The particles of a region, with the law's energy; cells are counted from its left end. */
static inline void tube_fill(tube *t, int k, double e) {
  const tube_region *r = &t->setup.region[k];
  const double d = tube_spacing(&t->setup, k);
  const int64_t before = k == 0 ? tube_layer(&t->setup, 0) : 0, cells = tube_cells(&t->setup, k);
  double *x = field(t->ctx, t->set, SPH_FIELD_X), *v = field(t->ctx, t->set, SPH_FIELD_V);
  double *m = field(t->ctx, t->set, SPH_FIELD_M), *rho = field(t->ctx, t->set, SPH_FIELD_RHO);
  double *energy = field(t->ctx, t->set, SPH_FIELD_E);
  for (int64_t i = t->first[k]; i < t->first[k + 1]; ++i) {
    const int64_t cell = i - t->first[k] - before;
    x[i] = r->from + ((double)cell + 0.5) * d;
    v[i] = r->state.v;
    m[i] = r->state.rho * d;
    rho[i] = r->state.rho;
    energy[i] = e;
    sph_particles_phases(t->set)[i] = k;
    if (cell < 0 || cell >= cells) sph_particles_roles(t->set)[i] = SPH_ROLE_WALL;
  }
}

static inline void tube_make_scheme(tube *t) {
  sph_shocks_options o;
  sph_shocks_options_init(&o);
  o.dim = 1;
  o.smoothing = t->setup.smoothing;
  o.density = t->setup.density;
  o.dissipation = &t->setup.loss;
  need(t->ctx, sph_shocks_create(t->ctx, t->set, &o, &t->shocks));
}

/* Reflecting walls at the ends that have one: mirror images reach as far as the kernel. */
static inline void tube_make_walls(tube *t) {
  const tube_setup *s = &t->setup;
  sph_ghosts_options o;
  if (!s->mirror[0] && !s->mirror[1]) return;
  sph_ghosts_options_init(&o);
  o.dim = 1;
  o.support = sph_kernel_support(sph_shocks_kernel(t->shocks));
  need(t->ctx, sph_ghosts_create(t->ctx, &o, &t->ghosts));
  for (int end = 0; end < 2; ++end) {
    sph_wall wall;
    sph_wall_init(&wall);
    wall.kind = SPH_WALL_SLIP;
    wall.point[0] = end ? s->region[s->regions - 1].to : s->region[0].from;
    wall.normal[0] = end ? -1.0 : 1.0;
    if (s->mirror[end]) need(t->ctx, sph_ghosts_add_wall(t->ghosts, &wall, NULL));
  }
  need(t->ctx, sph_shocks_set_ghosts(t->shocks, t->ghosts));
}

/* Everything at time 0. */
static inline void tube_create(tube *t, const tube_setup *setup) {
  sph_particles_options options;
  memset(t, 0, sizeof *t);
  t->setup = *setup;
  need(NULL, sph_context_create(NULL, &t->ctx));
  sph_particles_options_init(&options);
  options.dim = 1;
  need(t->ctx, sph_particles_create(t->ctx, &options, &t->set));
  need(t->ctx, sph_particles_add(t->set, tube_count(t), NULL));
  tube_make_scheme(t);
  tube_make_walls(t);
  for (int k = 0; k < setup->regions; ++k) {
    sph_material *law = tube_material(t->ctx, &setup->region[k].state);
    tube_fill(t, k, tube_energy(t->ctx, law, &setup->region[k].state));
    need(t->ctx, sph_shocks_set_material(t->shocks, k, law));
    sph_material_destroy(law); /* the scheme keeps it */
  }
  need(t->ctx, sph_shocks_start(t->shocks, 0.0));
}

static inline void tube_destroy(tube *t) {
  sph_shocks_destroy(t->shocks);
  sph_ghosts_destroy(t->ghosts);
  sph_particles_destroy(t->set);
  sph_context_destroy(t->ctx);
}

/* ---- running ----------------------------------------------------------------------------- */

static inline sph_status tube_grow(tube *t) {
  double dt = t->setup.first, stable = INFINITY;
  sph_status status = SPH_OK;
  while (!status && dt < stable && sph_shocks_time(t->shocks) + dt < t->setup.end) {
    status = sph_shocks_step(t->shocks, dt, NULL);
    if (!status) status = sph_shocks_stable_dt(t->shocks, &stable);
    dt *= 1.125;
  }
  return status ? status : sph_shocks_run(t->shocks, t->setup.end, NULL, NULL);
}

static inline sph_status tube_steps(tube *t) {
  const tube_setup *s = &t->setup;
  const int64_t steps = s->dt > 0.0 ? llround(s->end / s->dt) : 0;
  if (s->first > 0.0) return tube_grow(t);
  if (steps == 0) return sph_shocks_run(t->shocks, s->end, NULL, NULL);
  sph_status status = SPH_OK;
  for (int64_t k = 0; !status && k < steps; ++k)
    status = sph_shocks_step(t->shocks, s->end / (double)steps, NULL);
  return status ? status : sph_shocks_update(t->shocks);
}

/* From time 0 to the end. Answers what the scheme does: a set-up may be one that fails. */
static inline sph_status tube_run(tube *t, const tube_setup *setup) {
  tube_create(t, setup);
  sph_shocks_ledger_init(&t->ledger);
  need(t->ctx, sph_shocks_balance(t->shocks, &t->ledger));
  t->energy_start = t->ledger.total;
  const clock_t start = clock();
  const sph_status status = tube_steps(t);
  t->seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
  need(t->ctx, sph_shocks_balance(t->shocks, &t->ledger));
  t->x = sph_particles_field_const(t->set, SPH_FIELD_X);
  t->rho = sph_particles_field_const(t->set, SPH_FIELD_RHO);
  t->v = sph_particles_field_const(t->set, SPH_FIELD_V);
  t->p = sph_particles_field_const(t->set, SPH_FIELD_P);
  t->e = sph_particles_field_const(t->set, SPH_FIELD_E);
  return status;
}

/* ---- exact states ------------------------------------------------------------------------ */

typedef struct tube_state {
  double rho, v, p, e;
} tube_state;

/* The exact state at x, at the end of the run. */
typedef tube_state (*tube_exact)(void *user, double x);

/* A Riemann problem between two states at x0, a time t after it began. */
typedef struct tube_riemann {
  sph_context *ctx;
  sph_riemann_side left, right;
  sph_riemann_solution solution;
  double x0, t;
} tube_riemann;

static inline tube_riemann tube_solve(sph_context *ctx, const sph_riemann_side *left,
                                      const sph_riemann_side *right, double x0, double t) {
  tube_riemann r = {ctx, *left, *right, {0}, x0, t};
  sph_riemann_solution_init(&r.solution);
  need(ctx, sph_riemann_solve(ctx, left, right, &r.solution));
  return r;
}

static inline tube_state tube_riemann_state(void *riemann, double x) {
  const tube_riemann *r = (const tube_riemann *)riemann;
  const double speed = (x - r->x0) / r->t;
  tube_state s;
  need(r->ctx, sph_riemann_sample(r->ctx, &r->left, &r->right, &r->solution, 1, &speed, &s.rho,
                                  &s.v, &s.p, &s.e));
  return s;
}

/* Two in a row, of regions 0 to 3: 0 strikes 1 at time 0; the shock through 1 meets 2, the second
 * problem begins; 3 is the material of 1 again, at rest and not yet reached. */
typedef struct tube_relay {
  tube_riemann first, second;
  double meets;       /* when the second begins */
  double beyond_from; /* where region 3 begins */
} tube_relay;

static inline tube_relay tube_relay_solve(sph_context *ctx, const tube_setup *s) {
  const tube_region *r = s->region;
  tube_relay a;
  a.first = tube_solve(ctx, &r[0].state, &r[1].state, r[1].from, s->end);
  a.meets = (r[2].from - r[1].from) / a.first.solution.head[1];
  a.beyond_from = r[3].from;
  sph_riemann_side struck = r[1].state;
  struck.rho = a.first.solution.rho[1];
  struck.v = a.first.solution.v[1];
  struck.p = a.first.solution.p;
  a.second = tube_solve(ctx, &struck, &r[2].state, r[2].from, s->end - a.meets);
  return a;
}

static inline tube_state tube_relay_state(void *relay, double x) {
  tube_relay *a = (tube_relay *)relay;
  const double front = a->second.x0 + a->second.t * a->second.solution.head[0];
  return tube_riemann_state(x < front || x >= a->beyond_from ? &a->first : &a->second, x);
}

/* ---- figures ----------------------------------------------------------------------------- */

/* Mean errors of density, pressure, velocity, energy. */
typedef struct tube_errors {
  double rho, p, v, e;
} tube_errors;

/* A particle stands for half the way to its neighbours. */
static inline tube_errors tube_l1(const tube *t, double from, double to, tube_exact exact,
                                  void *user) {
  tube_errors sum = {0.0, 0.0, 0.0, 0.0};
  const double length = to - from;
  for (int64_t i = 1; i + 1 < t->n; ++i) {
    if (t->x[i] < from || t->x[i] > to) continue;
    const tube_state s = exact(user, t->x[i]);
    const double dx = 0.5 * (t->x[i + 1] - t->x[i - 1]);
    sum.rho += dx * fabs(t->rho[i] - s.rho);
    sum.p += dx * fabs(t->p[i] - s.p);
    sum.v += dx * fabs(t->v[i] - s.v);
    sum.e += dx * fabs(t->e[i] - s.e);
  }
  return (tube_errors){sum.rho / length, sum.p / length, sum.v / length, sum.e / length};
}

typedef struct tube_range {
  double highest, lowest;
} tube_range;

/* Extremes of P/P* - 1 in per cent around the contact on the left of `region`. */
static inline tube_range tube_contact(const tube *t, int region, double p) {
  tube_range r = {-INFINITY, INFINITY};
  const int64_t at = t->first[region];
  for (int64_t i = at - TUBE_AROUND; i <= at + TUBE_AROUND; ++i) {
    r.highest = fmax(r.highest, 100.0 * (t->p[i] / p - 1.0));
    r.lowest = fmin(r.lowest, 100.0 * (t->p[i] / p - 1.0));
  }
  return r;
}

/* Where f (one of the arrays of *t) passes `level` between two particles, nearest to `near`; NaN:
 * nowhere. With the mean of the states on both sides of a wave it is the place of the wave. */
static inline double tube_crossing(const tube *t, const double *f, double level, double near) {
  double best = NAN;
  for (int64_t i = 0; i + 1 < t->n; ++i) {
    if ((f[i] - level) * (f[i + 1] - level) > 0.0 || f[i] == f[i + 1]) continue;
    const double x = t->x[i] + (t->x[i + 1] - t->x[i]) * (level - f[i]) / (f[i + 1] - f[i]);
    if (!(fabs(x - near) >= fabs(best - near))) best = x;
  }
  return best;
}

/* Whether no particle has overtaken another. */
static inline int tube_in_order(const tube *t) {
  for (int64_t i = 0; i + 1 < t->n; ++i)
    if (t->x[i] >= t->x[i + 1]) return 0;
  return 1;
}

/* ---- what is printed --------------------------------------------------------------------- */

static inline const char *tube_smoothing(const tube_setup *s) {
  return s->smoothing == SPH_SMOOTHING_MASS     ? "mass"
         : s->smoothing == SPH_SMOOTHING_VOLUME ? "volume"
                                                : "number";
}

/* The keys of a figure of this run. */
static inline const char *tube_keys(char keys[TUBE_KEYS], const tube *t, const char *quantity) {
  const tube_setup *s = &t->setup;
  const int64_t frozen = tube_layer(s, 0) + tube_layer(s, s->regions - 1);
  const int used = snprintf(
      keys, TUBE_KEYS, "case=%s quantity=%s n=%lld layout=%s smoothing=%s a_rho=%g a_e=%g", s->name,
      quantity, (long long)(t->n - frozen), s->equal_masses ? "equal_masses" : "equal_spacing",
      tube_smoothing(s), s->loss.mass_flux, s->loss.conductivity);
  if (s->dt > 0.0) snprintf(keys + used, (size_t)(TUBE_KEYS - used), " dt=%g", s->dt);
  return keys;
}

/* Profiles with their exact values as CSV, for pictures. */
static inline void tube_write(const tube *t, const char *path, tube_exact exact, void *user) {
  FILE *file = open_output(path);
  fprintf(file, "x,rho,p,v,e,rho_exact,p_exact,v_exact,e_exact\n");
  for (int64_t i = 0; i < t->n; ++i) {
    const tube_state s = exact(user, t->x[i]);
    fprintf(file, "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", t->x[i], t->rho[i], t->p[i],
            t->v[i], t->e[i], s.rho, s.p, s.v, s.e);
  }
  fclose(file);
  printf("  wrote %s\n", path);
}

#endif
