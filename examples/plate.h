/* What plate_with_hole and porous_plate share: a quarter (or the whole) of a square elastic plate
 * with circular holes, as particles in plane stress.
 *
 * The planes x = 0 and y = 0 of a quarter are planes of symmetry. Particles stand on them, and
 * ghosts mirror all others near them (boundary.h, SLIP walls). The stress
 * form is the conservative one, with the corrected gradients g~ of both particles,
 *
 *   dv_i/dt = sum_j m_j (sigma_i B_i^-1 / rho_i^2 + sigma_j B_j^-1 / rho_j^2) g_ij,
 *
 * the adjoint of the velocity gradient: the work of the stress on the strain rate is that of the
 * forces on the velocities, so that small vibrations cannot grow, and a boundary without forces is
 * free of traction by itself. For accuracy volumes must then be those of the clipped cells. (The
 * difference form with held stresses, which reproduces the one-dimensional tables of He, is not the
 * adjoint of anything, and grows at any time step: see plate_with_hole_validate.h.) */
#ifndef EXAMPLES_PLATE_H
#define EXAMPLES_PLATE_H

#include "common.h"

#include <string.h>
#include <time.h>

static const double side = 1.0; /* half the side of the plate */
static const double density = 1738.0, young = 45e9, poisson = 0.35;

enum {
  PLATE_FROZEN = 0, /* small strains: Hooke, pairs and kernels are those at rest */
  PLATE_MOVING = 1, /* Hooke with the Jaumann rate; positions and densities advance */
  PLATE_TOTAL = 2,  /* total-Lagrangian, neo-Hookean */
  PLATE_LINEAR = 3  /* the same with Hooke's law for small strains */
};

typedef struct plate_options {
  int32_t holes;
  const double *hole; /* as sph_layout_holes() takes them; hole 0 about the origin */
  int32_t layout;     /* SPH_HOLES_* */
  double dp;
  int whole;         /* all four quarters, without ghosts */
  int constant_mass; /* rho A / N, as published, instead of rho times the Voronoi area */
  double h_ratio;    /* h / spacing */
  int32_t form;      /* SPH_STRESS_*, 0: CONSERVATIVE; not for total-Lagrangian plates */
  double viscosity;  /* alpha = beta */
  double artificial; /* epsilon of the artificial stress; not for total-Lagrangian plates */
  double hourglass;  /* control of total-Lagrangian plates */
  int motion;        /* PLATE_* */
  int32_t scheme;    /* SPH_INTEGRATOR_* */
  double cfl;        /* c dt / smallest spacing, c = sqrt(E / rho) */
  int32_t stages;    /* of RKC */
} plate_options;

typedef struct plate {
  plate_options o;
  double c, dt, smallest;
  int64_t n;
  sph_context *ctx;
  sph_particles *set;
  sph_neighbors *list;
  sph_material *material;
  sph_rhs *rhs;
  sph_integrator *integrator;
  sph_ghosts *ghosts;               /* NULL for a whole plate */
  double *x, *v, *sigma, *m, *rest; /* fields of the set; rest: where the particles were */
} plate;

static int is_total(const plate *p) {
  return p->o.motion == PLATE_TOTAL || p->o.motion == PLATE_LINEAR;
}

/* ---- symmetry ---------------------------------------------------------------------------- */

/* Ghosts beyond both planes of symmetry. They need gradient matrices, or deformation gradients, of
 * their own, and for these neighbours: they reach twice the support. */
static void make_ghosts(plate *p) {
  sph_ghosts_options options;
  sph_wall wall;
  sph_ghosts_options_init(&options);
  options.dim = 2;
  options.support = 4.0;
  options.position_field = is_total(p) ? SPH_FIELD_X0 : SPH_FIELD_X;
  options.skin = 0.1 * p->o.dp;
  need(p->ctx, sph_ghosts_create(p->ctx, &options, &p->ghosts));
  for (int a = 0; a < 2; ++a) {
    sph_wall_init(&wall);
    wall.kind = SPH_WALL_SLIP;
    wall.normal[a] = 1.0;
    need(p->ctx, sph_ghosts_add_wall(p->ghosts, &wall, NULL));
  }
  need(p->ctx, sph_ghosts_update(p->ghosts, p->set, 0.0));
}

/* Particles on a plane of symmetry stay there. For finish hooks, with the rate of V. */
static void keep_planes(const plate *p, double *rate) {
  for (int64_t k = 0; k < 2 * p->n && !p->o.whole; ++k)
    if (p->rest[k] == 0.0) rate[k] = 0.0;
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

static void fill_fields(plate *p, const double *x, const double *volume) {
  double *c = field(p->ctx, p->set, SPH_FIELD_C), *h = field(p->ctx, p->set, SPH_FIELD_H);
  p->x = field(p->ctx, p->set, SPH_FIELD_X);
  p->rest = field(p->ctx, p->set, SPH_FIELD_X0);
  p->v = field(p->ctx, p->set, SPH_FIELD_V);
  p->sigma = field(p->ctx, p->set, SPH_FIELD_SIGMA);
  p->m = field(p->ctx, p->set, SPH_FIELD_M);
  double *rho = field(p->ctx, p->set, SPH_FIELD_RHO);
  memcpy(p->x, x, 2 * (size_t)p->n * sizeof *x);
  memcpy(p->rest, x, 2 * (size_t)p->n * sizeof *x);
  for (int64_t i = 0; i < p->n; ++i) {
    p->m[i] = density * volume[i];
    rho[i] = density;
    c[i] = p->c;
    h[i] = p->o.h_ratio * local_spacing(p, x + 2 * i);
  }
  need(p->ctx, sph_particles_touch(p->set, SPH_FIELD_X));
  need(p->ctx, sph_particles_touch(p->set, SPH_FIELD_H));
}

static void make_particles(plate *p) {
  sph_particles_options options;
  double *x = make_layout(p), *volume = make_volumes(p, x);
  p->smallest = p->o.dp;
  if (p->o.layout == SPH_HOLES_RADIAL) p->smallest = hypot(x[2] - x[0], x[3] - x[1]);
  sph_particles_options_init(&options);
  options.dim = 2;
  options.capacity = 4 * p->n; /* with ghosts: the arrays stay where they are */
  need(p->ctx, sph_particles_create(p->ctx, &options, &p->set));
  need(p->ctx, sph_particles_add(p->set, p->n, NULL));
  fill_fields(p, x, volume);
  if (!p->o.whole) make_ghosts(p);
  free(x), free(volume);
}

/* ---- right-hand side and integrator ------------------------------------------------------ */

/* corrected: gradients g~ with the matrix of the particle. Conservative forms are so by themselves.
 */
static void add_term(plate *p, sph_term term, int32_t kind, int32_t form, int32_t corrected) {
  term.kind = kind;
  term.form = form;
  term.corrected = corrected;
  need(p->ctx, sph_rhs_add(p->rhs, &term));
}

static void add_terms(plate *p) {
  const int total = is_total(p);
  sph_term term;
  sph_term_init(&term);
  if (p->o.motion != PLATE_FROZEN) add_term(p, term, SPH_TERM_MOTION, 0, 0);
  if (p->o.motion == PLATE_MOVING) add_term(p, term, SPH_TERM_CONTINUITY, SPH_CONTINUITY_VOLUME, 1);
  const int32_t form = p->o.form ? p->o.form : SPH_STRESS_CONSERVATIVE;
  if (!total) add_term(p, term, SPH_TERM_STRESS, form, form != SPH_STRESS_CONSERVATIVE);
  if (!total) add_term(p, term, SPH_TERM_STRESS_RATE, 0, 1);
  if (total) add_term(p, term, SPH_TERM_FIRST_PIOLA, SPH_PIOLA_CONSERVATIVE, 0);
  term.alpha = p->o.hourglass;
  if (total) add_term(p, term, SPH_TERM_HOURGLASS, 0, 0);
  term.alpha = term.beta = p->o.viscosity;
  add_term(p, term, SPH_TERM_MONAGHAN, total ? SPH_MONAGHAN_CURRENT : 0, !total);
  sph_term_init(&term);
  term.epsilon = p->o.artificial;
  term.spacing_ratio = 1.0 / p->o.h_ratio;
  if (p->o.artificial > 0.0) add_term(p, term, SPH_TERM_ARTIFICIAL_STRESS, 0, 1);
}

static void make_material(plate *p) {
  sph_hooke_options hooke;
  sph_hyperelastic_options neo_hookean;
  sph_hooke_options_init(&hooke); /* with the Jaumann rate */
  sph_hyperelastic_options_init(&neo_hookean);
  hooke.young = neo_hookean.young = young;
  hooke.poisson = neo_hookean.poisson = poisson;
  hooke.density = neo_hookean.density = density;
  hooke.reduction = neo_hookean.reduction = SPH_PLANE_STRESS;
  need(p->ctx, p->o.motion == PLATE_TOTAL
                   ? sph_material_create_hyperelastic(p->ctx, &neo_hookean, &p->material)
                   : sph_material_create_hooke(p->ctx, &hooke, &p->material));
}

static void make_rhs(plate *p) {
  sph_kernel *kernel;
  sph_rhs_options options;
  sph_rhs_options_init(&options);
  if (is_total(p)) options.position_field = SPH_FIELD_X0;
  need(p->ctx, sph_kernel_create(p->ctx, SPH_KERNEL_CUBIC_SPLINE, 2, &kernel));
  need(p->ctx, sph_rhs_create(p->ctx, kernel, &options, &p->rhs));
  sph_kernel_destroy(kernel); /* the right-hand side keeps it */
  add_terms(p);
  need(p->ctx, sph_rhs_set_material(p->rhs, 0, p->material));
  if (p->ghosts) need(p->ctx, sph_rhs_set_prepare(p->rhs, sph_ghosts_prepare, p->ghosts));
}

static void make_integrator(plate *p) {
  static const struct {
    int32_t field;
    int in[4]; /* whether it advances, by motion */
  } fields[] = {{SPH_FIELD_X, {0, 1, 1, 1}},
                {SPH_FIELD_RHO, {0, 1, 0, 0}},
                {SPH_FIELD_V, {1, 1, 1, 1}},
                {SPH_FIELD_SIGMA, {1, 1, 0, 0}}};
  sph_integrator_options options;
  sph_integrator_options_init(&options);
  options.method = p->o.scheme;
  options.stage_rule = SPH_STAGES_FIXED;
  options.stages = p->o.stages;
  options.stability_check_interval = 0;
  need(p->ctx, sph_integrator_create(p->ctx, &options, &p->integrator));
  for (size_t k = 0; k < sizeof fields / sizeof *fields; ++k)
    if (fields[k].in[p->o.motion])
      need(p->ctx, sph_integrator_bind_field(p->integrator, fields[k].field));
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
  make_material(p);
  make_rhs(p);
  make_integrator(p);
  p->dt = o->cfl * p->smallest / p->c;
}

/* SIGMA as of the last stage: a field that advances, or by the law from F. */
static void find_stress(plate *p) {
  if (!is_total(p)) return;
  const double *F = field(p->ctx, p->set, SPH_FIELD_F);
  need(p->ctx, sph_material_cauchy_stress(p->material, 2, p->n, F, p->sigma));
}

static void plate_destroy(plate *p) {
  sph_integrator_destroy(p->integrator);
  sph_rhs_destroy(p->rhs);
  sph_material_destroy(p->material);
  sph_ghosts_destroy(p->ghosts);
  sph_neighbors_destroy(p->list);
  sph_particles_destroy(p->set);
  sph_context_destroy(p->ctx);
}

#endif
