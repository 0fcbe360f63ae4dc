/* Strength on top of an equation of state: deviatoric elasticity and the yield criterion of von
 * Mises, everything else from the equation of state. */
#include "elastic_impl.h"
#include "plastic.h"

#include <math.h>
#include <sph/plasticity.h>
#include <stdio.h>

typedef struct strength {
  sph_context *ctx;
  sph_material *eos; /* retained */
  sphi_plastic plastic;
  int32_t by_dim, limit_rate, jaumann;
} strength;

void sph_strength_options_init_sized(sph_strength_options *options, size_t size) {
  const sph_strength_options defaults = {.size = sizeof defaults, .yield = INFINITY, .jaumann = 1};
  sphi_material_init_sized(options, size, &defaults, sizeof defaults);
}

/* 2G (D - tr(D)/3 I), or tr(D)/dim */
static sphi_moduli moduli_of(const strength *law, int32_t dim) {
  const double part = law->by_dim ? 1.0 / dim : 1.0 / 3, g = law->plastic.shear;
  return (sphi_moduli){.stiff = 2 * g * (1 - part), .cross = -2 * g * part, .shear = g};
}

/* Take the outward part of a rate away where the yield stress is reached. The spin terms are
 * normal to S and take no part. */
static void limit(const strength *law, int32_t dim, const double *s, double *rate) {
  const double square = sphi_deviator_square(dim, s), y = law->plastic.yield;
  double outward = 0; /* S:rate of the 3x3 tensors */
  if (!(1.5 * square >= y * y)) return;
  for (int32_t c = 0; c < dim * (dim + 1) / 2; c++) outward += (c < dim ? 1 : 2) * s[c] * rate[c];
  if (dim == 1) outward *= 1.5;
  if (dim == 2) outward += (s[0] + s[1]) * (rate[0] + rate[1]);
  for (int32_t c = 0; c < dim * (dim + 1) / 2 && outward > 0; c++)
    rate[c] -= outward / square * s[c];
}

static int32_t stress_rate(void *user, const sph_material_block *b, double *rate) {
  const strength *law = user;
  const sphi_moduli m = moduli_of(law, b->dim);
  const int32_t comps = b->dim * (b->dim + 1) / 2;
  if (!law->limit_rate) {
    sphi_elastic_rate(&m, law->jaumann, b, rate);
    return 0;
  }
  for (int64_t i = 0; i < b->n; i++) { /* one by one: `rate` may be the array of the stress */
    sph_material_block one = *b;
    double r[6];
    one.n = 1;
    one.velocity_gradient += i * b->dim * b->dim;
    one.sigma += i * comps;
    sphi_elastic_rate(&m, law->jaumann, &one, r);
    limit(law, b->dim, one.sigma, r);
    for (int32_t c = 0; c < comps; c++) rate[i * comps + c] = r[c];
  }
  return 0;
}

static int32_t plastic_return(void *user, const sph_material_block *b, double *sigma,
                              double *across, double *plastic_strain, double *plastic_work) {
  const strength *law = user;
  (void)across;
  sphi_plastic_return_deviator(&law->plastic, b->dim, b->n, sigma, plastic_strain, plastic_work);
  return 0;
}

/* ---- wave speeds ---- */

static int32_t sound_speed(void *user, const sph_material_block *b, double *c) {
  const strength *law = user;
  const double stiff = moduli_of(law, b->dim).stiff;
  int32_t returned = law->eos->functions.sound_speed(law->eos->user, b, c);
  for (int64_t i = 0; i < b->n && returned == 0; i++) c[i] = sqrt(c[i] * c[i] + stiff / b->rho[i]);
  return returned;
}

static int32_t shear_speed(void *user, const sph_material_block *b, double *c) {
  const strength *law = user;
  for (int64_t i = 0; i < b->n; i++) c[i] = sqrt(law->plastic.shear / b->rho[i]);
  return 0;
}

/* ---- what the equation of state answers ---- */

static int32_t pressure(void *user, const sph_material_block *b, double *p) {
  const sph_material *eos = ((const strength *)user)->eos;
  return eos->functions.pressure(eos->user, b, p);
}

static int32_t temperature(void *user, const sph_material_block *b, double *t) {
  const sph_material *eos = ((const strength *)user)->eos;
  return eos->functions.temperature(eos->user, b, t);
}

static int32_t energy(void *user, const sph_material_block *b, double *e) {
  const sph_material *eos = ((const strength *)user)->eos;
  return eos->functions.energy(eos->user, b, e);
}

static int32_t pressure_derivatives(void *user, const sph_material_block *b, double *dp_drho,
                                    double *dp_de) {
  const sph_material *eos = ((const strength *)user)->eos;
  return eos->functions.pressure_derivatives(eos->user, b, dp_drho, dp_de);
}

static int64_t no_density(const sph_material_block *b, char *text, size_t room) {
  for (int64_t i = 0; i < b->n; i++) {
    if (b->rho[i] > 0) continue;
    if (text != NULL) (void)snprintf(text, room, "density %g is not positive", b->rho[i]);
    return i;
  }
  return -1;
}

static int64_t examine(const void *user, int32_t property, const sph_material_block *b, char *text,
                       size_t room) {
  const sph_material *eos = ((const strength *)user)->eos;
  if (property == SPHI_MATERIAL_STRESS_RATE || property == SPHI_MATERIAL_PLASTIC_RETURN) return -1;
  if (property == SPHI_MATERIAL_SHEAR_SPEED) return no_density(b, text, room);
  if (eos->examine != NULL) return eos->examine(eos->user, property, b, text, room);
  return property == SPHI_MATERIAL_SOUND_SPEED ? no_density(b, text, room) : -1;
}

/* ---- the handle ---- */

static void destroy(void *user) {
  strength *law = user;
  sphi_material_release(law->eos);
  sphi_free(law->ctx, law, sizeof *law);
}

static sph_status check(sph_context *ctx, const sph_material *eos, const sph_strength_options *o) {
  sph_status status = sphi_material_positive(ctx, "strength", "shear", o->shear);
  if (status != SPH_OK) return status;
  if (!(o->yield > 0))
    return sphi_fail(ctx, SPH_ERR_ARG, "strength: yield = %g is not positive", o->yield);
  if (!(o->hardening >= 0) || !isfinite(o->hardening))
    return sphi_fail(ctx, SPH_ERR_ARG, "strength: hardening = %g is negative or not finite",
                     o->hardening);
  if (o->limit_rate && o->hardening > 0)
    return sphi_fail(ctx, SPH_ERR_ARG, "strength: limit_rate with hardening = %g", o->hardening);
  if (!sphi_material_has(eos, SPHI_MATERIAL_PRESSURE) ||
      !sphi_material_has(eos, SPHI_MATERIAL_SOUND_SPEED))
    return sphi_fail(ctx, SPH_ERR_ARG,
                     "strength: the equation of state has no pressure or no sound speed");
  return SPH_OK;
}

static void set_needs(sph_material *m, const strength *law) {
  const sph_material *eos = law->eos;
  m->dim = eos->dim;
  m->examine = examine;
  for (int32_t k = 0; k < SPHI_MATERIAL_PROPERTIES; k++) m->needs[k] = eos->needs[k];
  m->needs[SPHI_MATERIAL_STRESS_RATE] =
      SPHI_NEEDS_GRADIENT | (law->jaumann || law->limit_rate ? (uint32_t)SPHI_NEEDS_SIGMA : 0u);
  m->needs[SPHI_MATERIAL_SOUND_SPEED] |= SPHI_NEEDS_RHO;
  m->needs[SPHI_MATERIAL_SHEAR_SPEED] = SPHI_NEEDS_RHO;
  m->needs[SPHI_MATERIAL_PLASTIC_RETURN] =
      law->plastic.hardening > 0 ? (uint32_t)SPHI_NEEDS_PLASTIC_STRAIN : 0u;
}

static sph_material_functions table_of(const sph_material *eos) {
  const sph_material_functions *has = &eos->functions;
  return (sph_material_functions){
      .size = sizeof(sph_material_functions),
      .stress_rate = stress_rate,
      .plastic_return = plastic_return,
      .sound_speed = sound_speed,
      .shear_speed = shear_speed,
      .pressure = pressure,
      .temperature = has->temperature != NULL ? temperature : NULL,
      .energy = has->energy != NULL ? energy : NULL,
      .pressure_derivatives = has->pressure_derivatives != NULL ? pressure_derivatives : NULL,
      .destroy = destroy};
}

static sph_status make(sph_context *ctx, sph_material *eos, const sph_strength_options *o,
                       sph_material **out) {
  strength *law = sphi_calloc(ctx, sizeof *law);
  if (law == NULL) return SPH_ERR_NOMEM;
  law->ctx = ctx;
  law->eos = eos;
  law->plastic = (sphi_plastic){.yield = o->yield, .hardening = o->hardening, .shear = o->shear};
  law->by_dim = o->trace_by_dim != 0;
  law->limit_rate = o->limit_rate != 0;
  law->jaumann = o->jaumann != 0;
  const sph_material_functions f = table_of(eos);
  sph_status status = sphi_material_make(ctx, &f, law, out);
  if (status != SPH_OK) {
    sphi_free(ctx, law, sizeof *law);
    return status;
  }
  sphi_material_retain(eos);
  set_needs(*out, law);
  return SPH_OK;
}

sph_status sph_material_create_strength(sph_context *ctx, sph_material *eos,
                                        const sph_strength_options *options, sph_material **out) {
  sph_strength_options o = {.size = 0};
  sph_strength_options_init(&o);
  sph_status status = sphi_material_begin(ctx, "strength", &o, sizeof o, options, out);
  if (status == SPH_OK) status = sphi_check_handle(ctx, eos, SPHI_MAGIC_MATERIAL, "eos");
  if (status == SPH_OK) status = check(ctx, eos, &o);
  return status == SPH_OK ? make(ctx, eos, &o, out) : status;
}
