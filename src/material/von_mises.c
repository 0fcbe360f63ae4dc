/* Hooke's law with the yield criterion of von Mises. */
#include "elastic_impl.h"
#include "plastic.h"

#include <math.h>
#include <sph/plasticity.h>

typedef struct von_mises {
  sph_context *ctx;
  sphi_moduli moduli;
  sphi_plastic plastic;
  double density;
  int32_t reduction, jaumann;
} von_mises;

void sph_von_mises_options_init_sized(sph_von_mises_options *options, size_t size) {
  const sph_von_mises_options defaults = {
      .size = sizeof defaults, .reduction = SPH_UNIAXIAL_STRESS, .jaumann = 1};
  sphi_material_init_sized(options, size, &defaults, sizeof defaults);
}

static int32_t stress_rate(void *user, const sph_material_block *b, double *rate) {
  const von_mises *law = user;
  sphi_elastic_rate(&law->moduli, law->jaumann, b, rate);
  return 0;
}

static int32_t stress_rate_across(void *user, const sph_material_block *b, double *rate) {
  const von_mises *law = user;
  sphi_elastic_rate_across(&law->moduli, b, rate);
  return 0;
}

static int32_t sound_speed(void *user, const sph_material_block *b, double *c) {
  const von_mises *law = user;
  for (int64_t i = 0; i < b->n; i++) c[i] = sqrt(law->moduli.stiff / law->density);
  return 0;
}

static int32_t shear_speed(void *user, const sph_material_block *b, double *c) {
  const von_mises *law = user;
  for (int64_t i = 0; i < b->n; i++) c[i] = sqrt(law->moduli.shear / law->density);
  return 0;
}

static int32_t plastic_return(void *user, const sph_material_block *b, double *sigma,
                              double *across, double *plastic_strain, double *plastic_work) {
  const von_mises *law = user;
  sphi_plastic_return(&law->plastic, law->reduction, b->n, sigma, across, plastic_strain,
                      plastic_work);
  return 0;
}

static void destroy(void *user) {
  von_mises *law = user;
  sphi_free(law->ctx, law, sizeof *law);
}

static sph_status check(sph_context *ctx, const sph_von_mises_options *o) {
  sph_status status =
      sphi_elastic_check(ctx, "von_mises", o->young, o->poisson, o->density, o->reduction);
  if (status == SPH_OK) status = sphi_material_positive(ctx, "von_mises", "yield", o->yield);
  if (status != SPH_OK) return status;
  if (!(o->hardening >= 0) || !isfinite(o->hardening))
    return sphi_fail(ctx, SPH_ERR_ARG, "von_mises: hardening = %g is negative or not finite",
                     o->hardening);
  return SPH_OK;
}

static void set_needs(sph_material *m, const von_mises *law) {
  const int32_t held = law->reduction == SPH_PLANE_STRAIN || law->reduction == SPH_UNIAXIAL_STRAIN;
  m->dim = sphi_reduction_dim(law->reduction);
  m->needs[SPHI_MATERIAL_STRESS_RATE] =
      SPHI_NEEDS_GRADIENT | (law->jaumann ? (uint32_t)SPHI_NEEDS_SIGMA : 0u);
  m->needs[SPHI_MATERIAL_STRESS_RATE_ACROSS] = SPHI_NEEDS_GRADIENT;
  m->needs[SPHI_MATERIAL_PLASTIC_RETURN] =
      (held ? (uint32_t)SPHI_NEEDS_ACROSS : 0u) |
      (law->plastic.hardening > 0 ? (uint32_t)SPHI_NEEDS_PLASTIC_STRAIN : 0u);
}

static sph_status make(sph_context *ctx, const sph_von_mises_options *o, sph_material **out) {
  von_mises *law = sphi_calloc(ctx, sizeof *law);
  if (law == NULL) return SPH_ERR_NOMEM;
  law->ctx = ctx;
  law->moduli = sphi_moduli_of(o->young, o->poisson, o->reduction);
  law->plastic = (sphi_plastic){.yield = o->yield,
                                .hardening = o->hardening,
                                .shear = law->moduli.shear,
                                .young = o->young,
                                .poisson = o->poisson};
  law->density = o->density;
  law->reduction = o->reduction;
  law->jaumann = o->jaumann != 0 && sphi_reduction_dim(o->reduction) > 1;
  const sph_material_functions f = {.size = sizeof f,
                                    .stress_rate = stress_rate,
                                    .sound_speed = sound_speed,
                                    .shear_speed = shear_speed,
                                    .stress_rate_across =
                                        o->reduction == SPH_SOLID ? NULL : stress_rate_across,
                                    .plastic_return = plastic_return,
                                    .destroy = destroy};
  sph_status status = sphi_material_make(ctx, &f, law, out);
  if (status != SPH_OK) {
    destroy(law);
    return status;
  }
  set_needs(*out, law);
  return SPH_OK;
}

sph_status sph_material_create_von_mises(sph_context *ctx, const sph_von_mises_options *options,
                                         sph_material **out) {
  sph_von_mises_options o = {.size = 0};
  sph_von_mises_options_init(&o);
  sph_status status = sphi_material_begin(ctx, "von_mises", &o, sizeof o, options, out);
  if (status == SPH_OK) status = check(ctx, &o);
  return status == SPH_OK ? make(ctx, &o, out) : status;
}
