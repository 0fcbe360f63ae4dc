/* What the tests of the scheme for shocks share: a cloud of particles of unequal mass, density and
 * energy, of a gas or of a gas and a solid side by side, and its scheme. */
#ifndef SPH_TESTS_SHOCKS_HELP_H
#define SPH_TESTS_SHOCKS_HELP_H

#include "rhs_help.h"

enum { SK_GAS = 0, SK_SOLID = 1, SK_HARDENING = 2 }; /* what phase 1 is; SK_GAS: there is none */

typedef struct cloud {
  sph_context *ctx; /* the caller's */
  sph_particles *set;
  sph_material *gas, *liquid, *solid;
  sph_shocks *scheme;
  int32_t dim, kind;
  int64_t n;
} cloud;

static CHECK_UNUSED double *sk_field(const cloud *c, int32_t field) {
  double *a = NULL;
  check_ok(sph_particles_field(c->set, field, &a));
  return a;
}

static CHECK_UNUSED sph_shocks_options sk_options(int32_t dim) {
  sph_shocks_options o;
  sph_shocks_options_init(&o);
  o.dim = dim;
  return o;
}

/* A gas with gamma 1.4; a barotropic liquid, at rest at rho = 1, with strength. */
static CHECK_UNUSED void sk_laws(cloud *c) {
  sph_gas_options gas;
  sph_barotropic_options liquid;
  sph_strength_options strength;
  sph_gas_options_init(&gas);
  check_ok(sph_material_create_gas(c->ctx, &gas, &c->gas));
  sph_barotropic_options_init(&liquid);
  liquid.density = 1.0;
  liquid.sound_speed = 1.5;
  liquid.gamma = 3.0;
  check_ok(sph_material_create_barotropic(c->ctx, &liquid, &c->liquid));
  sph_strength_options_init(&strength);
  strength.shear = 2.0;
  strength.yield = 0.05;
  strength.hardening = c->kind == SK_HARDENING ? 0.5 : 0.0;
  check_ok(sph_material_create_strength(c->ctx, c->liquid, &strength, &c->solid));
}

/* Half of the particles are of phase 1 unless all are gas. */
static CHECK_UNUSED void sk_fill(cloud *c, int64_t side) {
  double *x = sk_field(c, SPH_FIELD_X), *v = sk_field(c, SPH_FIELD_V);
  double *m = sk_field(c, SPH_FIELD_M), *rho = sk_field(c, SPH_FIELD_RHO);
  double *e = sk_field(c, SPH_FIELD_E);
  int32_t *phase = sph_particles_phases(c->set);
  for (int64_t i = 0; i < c->n; i++) {
    for (int64_t a = 0, k = i; a < c->dim; k /= side, a++) {
      x[i * c->dim + a] = (double)(k % side) + 0.5 + rh_random(-0.2, 0.2);
      v[i * c->dim + a] = rh_random(-0.3, 0.3);
    }
    phase[i] = c->kind != SK_GAS && i % side >= side / 2;
    rho[i] = rh_random(0.8, 1.2);
    m[i] = rho[i] * rh_random(0.8, 1.2);
    e[i] = rh_random(0.9, 1.1);
  }
  check_ok(sph_particles_touch(c->set, SPH_FIELD_X));
}

static CHECK_UNUSED cloud sk_cloud(sph_context *ctx, int32_t dim, int64_t side, int32_t kind) {
  cloud c = {.ctx = ctx, .dim = dim, .kind = kind, .n = 1};
  sph_particles_options o;
  rh_seed = 11;
  for (int32_t a = 0; a < dim; a++) c.n *= side;
  sph_particles_options_init(&o);
  o.dim = dim;
  check_ok(sph_particles_create(ctx, &o, &c.set));
  check_ok(sph_particles_add(c.set, c.n, NULL));
  sk_laws(&c);
  sk_fill(&c, side);
  return c;
}

/* The scheme with its materials, not started. */
static CHECK_UNUSED sph_status sk_create(cloud *c, const sph_shocks_options *o) {
  sph_status s = sph_shocks_create(c->ctx, c->set, o, &c->scheme);
  if (!s) s = sph_shocks_set_material(c->scheme, 0, c->gas);
  if (!s && c->kind != SK_GAS) s = sph_shocks_set_material(c->scheme, 1, c->solid);
  return s;
}

static CHECK_UNUSED void sk_ok(const cloud *c, sph_status status) {
  if (status != SPH_OK) print_error("%s\n", sph_context_last_error(c->ctx));
  check_ok(status);
}

static CHECK_UNUSED void sk_start(cloud *c, const sph_shocks_options *o) {
  sk_ok(c, sk_create(c, o));
  sk_ok(c, sph_shocks_start(c->scheme, 0.0));
}

static CHECK_UNUSED void sk_steps(cloud *c, int count, double dt) {
  for (int k = 0; k < count; k++) sk_ok(c, sph_shocks_step(c->scheme, dt, NULL));
}

static CHECK_UNUSED void sk_free(cloud *c) {
  sph_shocks_destroy(c->scheme);
  sph_material_destroy(c->gas);
  sph_material_destroy(c->solid);
  sph_material_destroy(c->liquid);
  sph_particles_destroy(c->set);
}

static CHECK_UNUSED sph_shocks_ledger sk_ledger(const cloud *c) {
  sph_shocks_ledger l;
  sph_shocks_ledger_init(&l);
  check_ok(sph_shocks_balance(c->scheme, &l));
  return l;
}

static CHECK_UNUSED int64_t sk_side(int32_t dim) { return dim == 1 ? 40 : dim == 2 ? 10 : 6; }

/* A sentence must have these words in it. */
static CHECK_UNUSED void sk_refused(sph_context *ctx, sph_status got, sph_status want,
                                    const char *words) {
  if (got != want) print_error("%s\n", sph_context_last_error(ctx));
  check_status(got, want);
  if (strstr(sph_context_last_error(ctx), words) == NULL)
    fail_msg("\"%s\" is not in \"%s\"", words, sph_context_last_error(ctx));
}

#endif
