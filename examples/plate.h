/* What plate_with_hole and porous_plate share: a quarter (or the whole) of a square elastic plate
 * with circular holes, as particles in plane stress.
 *
 * The planes x = 0 and y = 0 of a quarter are planes of symmetry. Particles stand on them, and
 * ghosts mirror all others near them: sigma_g = Q sigma Q, v_g = Q v, Q = I - 2 n n^T. The stress
 * form is the conservative one, with the corrected gradients g~ of both particles,
 *
 *   dv_i/dt = sum_j m_j (sigma_i B_i^-1 / rho_i^2 + sigma_j B_j^-1 / rho_j^2) g_ij,
 *
 * the adjoint of the velocity gradient: the work of the stress on the strain rate is that of the
 * forces on the velocities, so that small vibrations cannot grow, and a boundary without forces is
 * free of traction by itself. For accuracy volumes must then be those of the clipped cells. (The
 * difference form with held stresses, which reproduces the one-dimensional tables of He, is
 * unstable here, on every layout and at any time step.) */
#ifndef EXAMPLES_PLATE_H
#define EXAMPLES_PLATE_H

#include "common.h"

#include <string.h>
#include <time.h>

static const double side = 1.0; /* half the side of the plate */
static const double density = 1738.0, young = 45e9, poisson = 0.35;

typedef struct plate_options {
  int32_t holes;
  const double *hole; /* as sph_layout_holes() takes them; hole 0 about the origin */
  int32_t layout;     /* SPH_HOLES_* */
  double dp;
  int whole;         /* all four quarters, without ghosts */
  int constant_mass; /* rho A / N, as published, instead of rho times the Voronoi area */
  double h_ratio;    /* h / spacing */
  double viscosity;  /* alpha = beta */
  double artificial; /* epsilon of the artificial stress */
  int moving;        /* positions and densities advance; else pairs and kernels are those at rest */
  int32_t scheme;    /* SPH_INTEGRATOR_* */
  double cfl;        /* c dt / smallest spacing, c = sqrt(E / rho) */
  int32_t stages;    /* of RKC */
} plate_options;

typedef struct plate {
  plate_options o;
  double c, dt, smallest;
  int64_t n, ghosts, *origin; /* the real particle that each ghost mirrors */
  int *mirror;                /* 1: at x = 0, 2: at y = 0, 3: at both */
  sph_context *ctx;
  sph_particles *set;
  sph_neighbors *list;
  sph_rhs *rhs;
  sph_integrator *integrator;
  double *x, *v, *sigma, *rho, *m; /* fields of the set */
  double *rest;                    /* where the particles were */
} plate;

/* ---- symmetry ---------------------------------------------------------------------------- */

/* Prepare hook: ghosts follow their particles. */
static int32_t mirror_ghosts(void *user, double t, sph_particles *set, const sph_rate *rates,
                             int32_t count) {
  plate *p = user;
  (void)t;
  (void)rates;
  (void)count;
  for (int64_t k = 0; k < p->ghosts; ++k) {
    const int64_t i = p->origin[k], g = p->n + k;
    const double sign[2] = {p->mirror[k] & 1 ? -1.0 : 1.0, p->mirror[k] & 2 ? -1.0 : 1.0};
    for (int a = 0; a < 2; ++a) {
      p->x[2 * g + a] = sign[a] * p->x[2 * i + a];
      p->v[2 * g + a] = sign[a] * p->v[2 * i + a];
      p->sigma[3 * g + a] = p->sigma[3 * i + a];
    }
    p->rho[g] = p->rho[i];
    p->sigma[3 * g + 2] = sign[0] * sign[1] * p->sigma[3 * i + 2];
  }
  return p->o.moving ? sph_particles_touch(set, SPH_FIELD_X) : SPH_OK;
}

/* Particles on a plane of symmetry stay there. For finish hooks, with the rate of V. */
static void keep_planes(const plate *p, double *rate) {
  for (int64_t k = 0; k < 2 * p->n; ++k)
    if (p->rest[k] == 0.0) rate[k] = 0.0;
}

/* A ghost acts on particles within 2 h and needs neighbours of its own for its gradient matrix:
 * twice that. Particles that move towards the plane are wanted as well: half as much again. */
static void choose_ghosts(plate *p, const double *x, const double *h) {
  p->origin = malloc(3 * (size_t)p->n * sizeof *p->origin);
  p->mirror = malloc(3 * (size_t)p->n * sizeof *p->mirror);
  if (!p->origin || !p->mirror) exit(2);
  for (int planes = 1; planes < 4 && !p->o.whole; ++planes)
    for (int64_t i = 0; i < p->n; ++i) {
      const double reach = 4.0 * h[i] * (p->o.moving ? 1.5 : 1.0);
      int near = 1;
      for (int a = 0; a < 2; ++a)
        if (planes & (1 << a)) near &= x[2 * i + a] > 0.0 && x[2 * i + a] < reach;
      if (!near) continue;
      p->origin[p->ghosts] = i;
      p->mirror[p->ghosts++] = planes;
    }
}

/* ---- particles --------------------------------------------------------------------------- */

static double *make_layout(plate *p) {
  sph_hole_layout_options layout;
  sph_hole_layout_options_init(&layout);
  layout.kind = p->o.layout;
  layout.holes = p->o.holes;
  layout.hole = p->o.hole;
  layout.spacing = p->o.dp;
  layout.lo[0] = layout.lo[1] = p->o.whole ? -side : 0.0;
  layout.edge_rings = p->o.layout == SPH_HOLES_SQUARED ? 0 : 1;
  if (!p->o.whole) layout.faces = SPH_FACE_X_HI | SPH_FACE_Y_HI;
  if (p->o.layout != SPH_HOLES_EQUALLY_RADIAL) layout.faces = 0; /* the others reach the faces */
  need(p->ctx, sph_layout_holes(p->ctx, &layout, 0, NULL, &p->n));
  double *x = malloc(2 * (size_t)p->n * sizeof *x);
  if (!x) exit(2);
  need(p->ctx, sph_layout_holes(p->ctx, &layout, p->n, x, &p->n));
  return x;
}

/* Areas of the whole plate: a particle on a plane of symmetry has the other half too. The mean is
 * that of the whole as well, where it counts half as often as one beside the plane. */
static double *make_volumes(const plate *p, const double *x) {
  sph_region_options region;
  double total = 0.0, count = 0.0, *volume = malloc((size_t)p->n * sizeof *volume);
  if (!volume) exit(2);
  sph_region_options_init(&region);
  region.dim = 2;
  region.lo[0] = region.lo[1] = p->o.whole ? -side : 0.0;
  region.holes = p->o.holes;
  region.hole = p->o.hole;
  need(p->ctx, sph_layout_volumes(p->ctx, &region, p->n, x, volume));
  for (int64_t i = 0; i < p->n; ++i) {
    double weight = 1.0;
    for (int a = 0; a < 2 && !p->o.whole; ++a)
      if (x[2 * i + a] == 0.0) {
        volume[i] *= 2.0;
        weight *= 0.5;
      }
    total += weight * volume[i];
    count += weight;
  }
  for (int64_t i = 0; i < p->n && p->o.constant_mass; ++i) volume[i] = total / count;
  return volume;
}

/* On rays the spacing grows with the distance from the hole; its first step is the smallest. */
static double local_spacing(const plate *p, const double *at) {
  if (p->o.layout != SPH_HOLES_RADIAL) return p->o.dp;
  return p->smallest * hypot(at[0], at[1]) / p->o.hole[2];
}

static void fill_fields(plate *p, const double *x, const double *volume, const double *h) {
  double *c = field(p->ctx, p->set, SPH_FIELD_C);
  double *length = field(p->ctx, p->set, SPH_FIELD_H);
  p->x = field(p->ctx, p->set, SPH_FIELD_X);
  p->rest = field(p->ctx, p->set, SPH_FIELD_X0);
  p->v = field(p->ctx, p->set, SPH_FIELD_V);
  p->sigma = field(p->ctx, p->set, SPH_FIELD_SIGMA);
  p->rho = field(p->ctx, p->set, SPH_FIELD_RHO);
  p->m = field(p->ctx, p->set, SPH_FIELD_M);
  for (int64_t k = 0; k < p->n + p->ghosts; ++k) {
    const int64_t i = k < p->n ? k : p->origin[k - p->n];
    p->m[k] = density * volume[i];
    p->rho[k] = density;
    c[k] = p->c;
    length[k] = h[i];
  }
  memcpy(p->x, x, 2 * (size_t)p->n * sizeof *x);
  memcpy(p->rest, x, 2 * (size_t)p->n * sizeof *x);
  mirror_ghosts(p, 0.0, p->set, NULL, 0);
  need(p->ctx, sph_particles_touch(p->set, SPH_FIELD_X));
  need(p->ctx, sph_particles_touch(p->set, SPH_FIELD_H));
}

static void make_particles(plate *p) {
  sph_particles_options options;
  double *x = make_layout(p), *volume = make_volumes(p, x);
  double *h = malloc((size_t)p->n * sizeof *h);
  if (!h) exit(2);
  p->smallest = p->o.dp;
  if (p->o.layout == SPH_HOLES_RADIAL) p->smallest = hypot(x[2] - x[0], x[3] - x[1]);
  for (int64_t i = 0; i < p->n; ++i) h[i] = p->o.h_ratio * local_spacing(p, x + 2 * i);
  choose_ghosts(p, x, h);
  sph_particles_options_init(&options);
  options.dim = 2;
  need(p->ctx, sph_particles_create(p->ctx, &options, &p->set));
  need(p->ctx, sph_particles_add(p->set, p->n, NULL));
  need(p->ctx, sph_particles_add_ghosts(p->set, p->ghosts, NULL));
  fill_fields(p, x, volume, h);
  free(x), free(volume), free(h);
}

/* ---- right-hand side and integrator ------------------------------------------------------ */

static void add_term(plate *p, const sph_term *defaults, int32_t kind) {
  sph_term term = *defaults;
  term.kind = kind;
  term.corrected = kind != SPH_TERM_MOTION && kind != SPH_TERM_STRESS;
  need(p->ctx, sph_rhs_add(p->rhs, &term));
}

static void make_rhs(plate *p) {
  sph_kernel *kernel;
  sph_material *hooke;
  sph_hooke_options elastic;
  sph_term term;
  sph_hooke_options_init(&elastic); /* with the Jaumann rate */
  elastic.young = young;
  elastic.density = density;
  elastic.poisson = poisson;
  elastic.reduction = SPH_PLANE_STRESS;
  need(p->ctx, sph_kernel_create(p->ctx, SPH_KERNEL_CUBIC_SPLINE, 2, &kernel));
  need(p->ctx, sph_material_create_hooke(p->ctx, &elastic, &hooke));
  need(p->ctx, sph_rhs_create(p->ctx, kernel, NULL, &p->rhs));
  sph_term_init(&term);
  if (p->o.moving) add_term(p, &term, SPH_TERM_MOTION);
  term.form = SPH_CONTINUITY_VOLUME;
  if (p->o.moving) add_term(p, &term, SPH_TERM_CONTINUITY);
  term.form = 0;
  add_term(p, &term, SPH_TERM_STRESS_RATE);
  term.form = SPH_STRESS_CONSERVATIVE;
  add_term(p, &term, SPH_TERM_STRESS);
  sph_term_init(&term);
  term.alpha = term.beta = p->o.viscosity;
  add_term(p, &term, SPH_TERM_MONAGHAN);
  term.epsilon = p->o.artificial;
  term.spacing_ratio = 1.0 / p->o.h_ratio;
  add_term(p, &term, SPH_TERM_ARTIFICIAL_STRESS);
  need(p->ctx, sph_rhs_set_material(p->rhs, 0, hooke));
  need(p->ctx, sph_rhs_set_prepare(p->rhs, mirror_ghosts, p));
  sph_material_destroy(hooke); /* the right-hand side keeps both */
  sph_kernel_destroy(kernel);
}

static void make_integrator(plate *p) {
  sph_integrator_options options;
  sph_integrator_options_init(&options);
  options.method = p->o.scheme;
  options.stage_rule = SPH_STAGES_FIXED;
  options.stages = p->o.stages;
  options.stability_check_interval = 0;
  need(p->ctx, sph_integrator_create(p->ctx, &options, &p->integrator));
  if (p->o.moving) need(p->ctx, sph_integrator_bind_field(p->integrator, SPH_FIELD_X));
  if (p->o.moving) need(p->ctx, sph_integrator_bind_field(p->integrator, SPH_FIELD_RHO));
  need(p->ctx, sph_integrator_bind_field(p->integrator, SPH_FIELD_V));
  need(p->ctx, sph_integrator_bind_field(p->integrator, SPH_FIELD_SIGMA));
  need(p->ctx, sph_integrator_set_rhs(p->integrator, p->rhs, p->list));
}

static void plate_create(plate *p, const plate_options *o) {
  sph_neighbors_options list;
  memset(p, 0, sizeof *p);
  p->o = *o;
  p->c = sqrt(young / density);
  need(NULL, sph_context_create(NULL, &p->ctx));
  make_particles(p);
  sph_neighbors_options_init(&list);
  list.method = SPH_NEIGHBORS_VERLET;
  list.skin = 0.1 * o->dp;
  need(p->ctx, sph_neighbors_create(p->ctx, &list, &p->list));
  make_rhs(p);
  make_integrator(p);
  p->dt = o->cfl * p->smallest / p->c;
}

static void plate_destroy(plate *p) {
  sph_integrator_destroy(p->integrator);
  sph_rhs_destroy(p->rhs);
  sph_neighbors_destroy(p->list);
  sph_particles_destroy(p->set);
  sph_context_destroy(p->ctx);
  free(p->origin);
  free(p->mirror);
}

#endif
