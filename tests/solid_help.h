/* What the tests of the elastodynamics scheme share: a jittered block of an elastic solid, E = 1,
 * rho = 1, spacing 1, and its scheme. */
#ifndef SPH_TESTS_SOLID_HELP_H
#define SPH_TESTS_SOLID_HELP_H

#include "rhs_help.h"

typedef struct solid {
  sph_context *ctx; /* the caller's */
  sph_particles *set;
  sph_material *hooke;
  sph_elastodynamics *scheme;
  int32_t dim;
  int64_t n;
} solid;

static CHECK_UNUSED double *so_field(const solid *s, int32_t field) {
  double *a = NULL;
  check_ok(sph_particles_field(s->set, field, &a));
  return a;
}

static CHECK_UNUSED sph_elastodynamics_options so_options(int32_t dim) {
  sph_elastodynamics_options o;
  sph_elastodynamics_options_init(&o);
  o.dim = dim;
  o.spacing = 1.0;
  return o;
}

/* side[] particles an axis at the middles of cells, moved by up to `jitter`; at rest. */
static CHECK_UNUSED solid so_block(sph_context *ctx, int32_t dim, const int64_t *side,
                                   double jitter) {
  solid s = {.ctx = ctx, .dim = dim, .n = 1};
  sph_particles_options o;
  sph_hooke_options h;
  rh_seed = 5;
  for (int32_t a = 0; a < dim; a++) s.n *= side[a];
  sph_particles_options_init(&o);
  o.dim = dim;
  check_ok(sph_particles_create(ctx, &o, &s.set));
  check_ok(sph_particles_add(s.set, s.n, NULL));
  double *x = so_field(&s, SPH_FIELD_X), *m = so_field(&s, SPH_FIELD_M);
  double *rho = so_field(&s, SPH_FIELD_RHO);
  for (int64_t i = 0; i < s.n; i++) {
    m[i] = rho[i] = 1.0;
    for (int64_t a = 0, k = i; a < dim; k /= side[a], a++)
      x[i * dim + a] = (double)(k % side[a]) + 0.5 + rh_random(-jitter, jitter);
  }
  check_ok(sph_particles_touch(s.set, SPH_FIELD_X));
  sph_hooke_options_init(&h);
  h.young = h.density = 1.0;
  h.poisson = dim == 1 ? 0.0 : 0.3;
  h.reduction = dim == 1 ? SPH_UNIAXIAL_STRESS : dim == 2 ? SPH_PLANE_STRAIN : SPH_SOLID;
  check_ok(sph_material_create_hooke(ctx, &h, &s.hooke));
  return s;
}

static CHECK_UNUSED void so_start(solid *s, const sph_elastodynamics_options *o) {
  check_ok(sph_elastodynamics_create(s->ctx, s->set, o, &s->scheme));
  check_ok(sph_elastodynamics_set_material(s->scheme, 0, s->hooke));
  sph_status status = sph_elastodynamics_start(s->scheme, 0.0);
  if (status != SPH_OK) print_error("%s\n", sph_context_last_error(s->ctx));
  check_ok(status);
}

static CHECK_UNUSED void so_free(solid *s) {
  sph_elastodynamics_destroy(s->scheme);
  sph_material_destroy(s->hooke);
  sph_particles_destroy(s->set);
}

/* Smooth velocities of size `amplitude`, none of them zero everywhere. */
static CHECK_UNUSED void so_stir(solid *s, double amplitude) {
  const double *x = so_field(s, SPH_FIELD_X);
  double *v = so_field(s, SPH_FIELD_V);
  for (int64_t i = 0; i < s->n; i++)
    for (int32_t a = 0; a < s->dim; a++) {
      double phase = 0.7 * a;
      for (int32_t b = 0; b < s->dim; b++) phase += (0.5 + 0.2 * b) * x[i * s->dim + b];
      v[i * s->dim + a] = amplitude * sin(phase);
    }
}

static CHECK_UNUSED sph_elastodynamics_ledger so_ledger(const solid *s) {
  sph_elastodynamics_ledger l;
  sph_elastodynamics_ledger_init(&l);
  check_ok(sph_elastodynamics_balance(s->scheme, &l));
  return l;
}

#endif
