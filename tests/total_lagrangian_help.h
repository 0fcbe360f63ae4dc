/* What the tests of the scheme total_lagrangian share: a free block with its material and scheme.
 */
#ifndef TOTAL_LAGRANGIAN_HELP_H
#define TOTAL_LAGRANGIAN_HELP_H

#include "rhs_help.h"

typedef struct tl_body {
  sph_context *ctx; /* the caller's */
  sph_material *material;
  sph_particles *set;
  sph_total_lagrangian *tl;
} tl_body;

enum { SIDE = 6 };

static inline sph_material *rubber(sph_context *ctx, int32_t dim) {
  sph_hyperelastic_options o;
  sph_material *m = NULL;
  sph_hyperelastic_options_init(&o);
  o.young = 2.0;
  o.poisson = 0.3;
  o.density = 1.1;
  o.reduction = dim == 1 ? SPH_UNIAXIAL_STRESS : dim == 2 ? SPH_PLANE_STRAIN : SPH_SOLID;
  check_ok(sph_material_create_hyperelastic(ctx, &o, &m));
  return m;
}

static inline double *values(const tl_body *b, int32_t field) {
  double *a = NULL;
  check_ok(sph_particles_field(b->set, field, &a));
  return a;
}

/* A free block of spacing 1/2, slightly jittered, with velocities that deform and turn it. */
static inline void fill(tl_body *b, int32_t dim, double speed) {
  sph_particles_options o;
  sph_particles_options_init(&o);
  o.dim = dim;
  int64_t n = dim == 1 ? SIDE : dim == 2 ? SIDE * SIDE : SIDE * SIDE * SIDE;
  check_ok(sph_particles_create(b->ctx, &o, &b->set));
  check_ok(sph_particles_add(b->set, n, NULL));
  double *x = values(b, SPH_FIELD_X), *v = values(b, SPH_FIELD_V);
  double *m = values(b, SPH_FIELD_M), *rho = values(b, SPH_FIELD_RHO);
  rh_seed = 9;
  for (int64_t i = 0; i < n; i++) {
    int64_t k = i;
    for (int a = 0; a < dim; a++, k /= SIDE)
      x[i * dim + a] = 0.5 * ((double)(k % SIDE) + rh_random(-0.05, 0.05));
    for (int a = 0; a < dim; a++)
      v[i * dim + a] = speed * (sin(2.0 * x[i * dim + (a + 1) % dim]) + 0.3 * a);
    m[i] = 1.1 * pow(0.5, dim);
    rho[i] = 1.1;
  }
}

static inline tl_body make(sph_context *ctx, int32_t dim, sph_total_lagrangian_options *o,
                           double speed) {
  tl_body b = {.ctx = ctx, .material = rubber(ctx, dim)};
  o->dim = dim;
  check_ok(sph_total_lagrangian_create(ctx, o, b.material, &b.tl));
  fill(&b, dim, speed);
  check_ok(sph_total_lagrangian_start(b.tl, b.set));
  return b;
}

static inline void unmake(tl_body *b) {
  sph_total_lagrangian_destroy(b->tl);
  sph_particles_destroy(b->set);
  sph_material_destroy(b->material);
}

static inline sph_total_lagrangian_options defaults(void) {
  sph_total_lagrangian_options o;
  sph_total_lagrangian_options_init(&o);
  return o;
}

static inline double total(const tl_body *b, double t) {
  sph_total_lagrangian_energies e = {.size = sizeof e};
  check_ok(sph_total_lagrangian_energy(b->tl, b->set, t, &e));
  return e.kinetic + e.strain + e.hourglass + e.gravity;
}

#endif
