/* Properties of a material: which a law has, what it needs, checks, dispatch to its functions. */
#include "material_impl.h"

#include <sph/eos.h>

typedef int32_t (*one_output)(void *user, const sph_material_block *block, double *out);

/* The law of a property that writes one array. */
static one_output law_of(const sph_material *m, int32_t property) {
  const sph_material_functions *f = &m->functions;
  switch (property) {
  case SPHI_MATERIAL_STRESS_RATE:
    return f->stress_rate;
  case SPHI_MATERIAL_PRESSURE:
    return f->pressure;
  case SPHI_MATERIAL_SOUND_SPEED:
    return f->sound_speed;
  case SPHI_MATERIAL_SHEAR_SPEED:
    return f->shear_speed;
  case SPHI_MATERIAL_SMALL_STRAIN_STRESS:
    return f->small_strain_stress;
  case SPHI_MATERIAL_CAUCHY_STRESS:
    return f->cauchy_stress;
  case SPHI_MATERIAL_STRESS_RATE_ACROSS:
    return f->stress_rate_across;
  case SPHI_MATERIAL_TEMPERATURE:
    return f->temperature;
  case SPHI_MATERIAL_ENERGY:
    return f->energy;
  default:
    return NULL;
  }
}

int32_t sphi_material_has(const sph_material *material, int32_t property) {
  if (material == NULL) return 0;
  switch (property) {
  case SPHI_MATERIAL_FIRST_PIOLA:
    return material->functions.first_piola != NULL;
  case SPHI_MATERIAL_PRESSURE_DERIVATIVES:
    return material->functions.pressure_derivatives != NULL;
  case SPHI_MATERIAL_PLASTIC_RETURN:
    return material->functions.plastic_return != NULL;
  default:
    return law_of(material, property) != NULL;
  }
}

uint32_t sphi_material_needs(const sph_material *material, int32_t property) {
  return material->needs[property];
}

int32_t sphi_material_dim(const sph_material *material) { return material->dim; }

static const char *property_name(int32_t property) {
  static const char *const names[SPHI_MATERIAL_PROPERTIES] = {"stress_rate",
                                                              "pressure",
                                                              "sound_speed",
                                                              "shear_speed",
                                                              "small_strain_stress",
                                                              "cauchy_stress",
                                                              "stress_rate_across",
                                                              "temperature",
                                                              "energy",
                                                              "first_piola",
                                                              "pressure_derivatives",
                                                              "plastic_return"};
  return names[property];
}

/* Name of the first array that is needed and NULL; NULL when all are there. */
static const char *missing_array(uint32_t needs, const sph_material_block *b) {
  if ((needs & SPHI_NEEDS_GRADIENT) && b->velocity_gradient == NULL) return "velocity_gradient";
  if ((needs & SPHI_NEEDS_SIGMA) && b->sigma == NULL) return "sigma";
  if ((needs & SPHI_NEEDS_RHO) && b->rho == NULL) return "rho";
  if ((needs & SPHI_NEEDS_E) && b->e == NULL) return "e";
  if ((needs & SPHI_NEEDS_F) && b->deformation_gradient == NULL) return "deformation_gradient";
  if ((needs & SPHI_NEEDS_STRAIN) && b->strain == NULL) return "strain";
  if ((needs & SPHI_NEEDS_P) && b->p == NULL) return "p";
  return NULL;
}

static sph_status check_shape(const sph_material *material, int32_t property,
                              const sph_material_block *b) {
  sph_context *ctx = material->object.ctx;
  const char *name = property_name(property);
  if (b->dim < 1 || b->dim > 3)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: dim is %d, not 1, 2 or 3", name, (int)b->dim);
  if (material->dim != 0 && material->dim != b->dim)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: the block is %d-D, the material %d-D", name,
                     (int)b->dim, (int)material->dim);
  if (b->n < 0)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: n = %lld is negative", name, (long long)b->n);
  return SPH_OK;
}

sph_status sphi_material_check_block(const sph_material *material, int32_t property,
                                     const sph_material_block *block) {
  sph_context *ctx = material->object.ctx;
  const char *name = property_name(property);
  if (!sphi_material_has(material, property))
    return sphi_fail(ctx, SPH_ERR_UNSUPPORTED, "%s: the material has no such law", name);
  sph_status status = check_shape(material, property, block);
  if (status != SPH_OK) return status;
  const char *missing = missing_array(material->needs[property], block);
  if (block->n > 0 && missing != NULL)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: the material needs %s, which is NULL", name, missing);
  return SPH_OK;
}

/* ---- evaluation in loops ---- */

static sph_status callback_status(int32_t returned) {
  if (returned == 0) return SPH_OK;
  return returned > 0 ? SPH_RETRY : SPH_ERR_CALLBACK;
}

static int out_of_range(const sph_material *m, int32_t property, const sph_material_block *b) {
  return m->examine != NULL && m->examine(m->user, property, b, NULL, 0) >= 0;
}

sph_status sphi_material_evaluate_quiet(const sph_material *material, int32_t property,
                                        const sph_material_block *block, double *out) {
  if (block->n == 0) return SPH_OK;
  if (out_of_range(material, property, block)) return SPH_ERR_NUMERIC;
  return callback_status(law_of(material, property)(material->user, block, out));
}

sph_status sphi_material_stress_rate_quiet(const sph_material *material,
                                           const sph_material_block *block, double *dsigma) {
  return sphi_material_evaluate_quiet(material, SPHI_MATERIAL_STRESS_RATE, block, dsigma);
}

sph_status sphi_material_pressure_quiet(const sph_material *material,
                                        const sph_material_block *block, double *p) {
  return sphi_material_evaluate_quiet(material, SPHI_MATERIAL_PRESSURE, block, p);
}

sph_status sphi_material_sound_speed_quiet(const sph_material *material,
                                           const sph_material_block *block, double *c) {
  return sphi_material_evaluate_quiet(material, SPHI_MATERIAL_SOUND_SPEED, block, c);
}

sph_material_block sphi_material_block_of_f(int32_t dim, int64_t n, const double *F) {
  return (sph_material_block){
      .size = sizeof(sph_material_block), .dim = dim, .n = n, .deformation_gradient = F};
}

sph_status sphi_material_first_piola_quiet(const sph_material *material, int32_t dim, int64_t n,
                                           const double *F, double *P, double *energy) {
  const sph_material_block b = sphi_material_block_of_f(dim, n, F);
  if (n == 0) return SPH_OK;
  if (out_of_range(material, SPHI_MATERIAL_FIRST_PIOLA, &b)) return SPH_ERR_NUMERIC;
  return callback_status(material->functions.first_piola(material->user, &b, P, energy));
}

sph_status sphi_material_plastic_return_quiet(const sph_material *material,
                                              const sph_material_block *block, double *sigma,
                                              double *across, double *plastic_strain,
                                              double *plastic_work) {
  if (block->n == 0) return SPH_OK;
  return callback_status(material->functions.plastic_return(material->user, block, sigma, across,
                                                            plastic_strain, plastic_work));
}

sph_status sphi_material_explain(const sph_material *material, int32_t property,
                                 const sph_material_block *block, int64_t first,
                                 sph_status status) {
  char text[160];
  if (status != SPH_ERR_NUMERIC || material->examine == NULL)
    return sphi_material_fail(material, property, status);
  int64_t i = material->examine(material->user, property, block, text, sizeof text);
  if (i < 0) return sphi_material_fail(material, property, status);
  return sphi_fail(material->object.ctx, status, "%s: particle %lld: %s", property_name(property),
                   (long long)(first + i), text);
}

sph_status sphi_material_fail(const sph_material *material, int32_t property, sph_status status) {
  if (status >= 0) return status;
  return sphi_fail(material->object.ctx, status, "%s: %s", property_name(property),
                   status == SPH_ERR_NUMERIC ? "a particle is outside the range of the law"
                                             : "the material's callback failed");
}

/* ---- the public calls ---- */

/* What the public calls check alike. *mine receives the block in this library's size. */
static sph_status check_call(const sph_material *material, int32_t property,
                             const sph_material_block *block, const double *out,
                             sph_material_block *mine) {
  sph_status status = sphi_check_handle(NULL, material, SPHI_MAGIC_MATERIAL, "material");
  if (status != SPH_OK) return status;
  sph_context *ctx = material->object.ctx;
  if (block == NULL || out == NULL)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: %s is NULL", property_name(property),
                     block == NULL ? "the block" : "the output array");
  *mine = (sph_material_block){.size = sizeof *mine};
  status = sphi_options_read(ctx, mine, sizeof *mine, block);
  if (status != SPH_OK) return status;
  mine->size = sizeof *mine;
  return sphi_material_check_block(material, property, mine);
}

static sph_status evaluate(const sph_material *material, int32_t property,
                           const sph_material_block *block, double *out) {
  sph_material_block mine;
  sph_status status = check_call(material, property, block, out, &mine);
  if (status != SPH_OK) return status;
  status = sphi_material_evaluate_quiet(material, property, &mine, out);
  return sphi_material_explain(material, property, &mine, 0, status);
}

sph_status sph_material_stress_rate(const sph_material *material, const sph_material_block *block,
                                    double *dsigma) {
  return evaluate(material, SPHI_MATERIAL_STRESS_RATE, block, dsigma);
}

sph_status sph_material_pressure(const sph_material *material, const sph_material_block *block,
                                 double *p) {
  return evaluate(material, SPHI_MATERIAL_PRESSURE, block, p);
}

sph_status sph_material_sound_speed(const sph_material *material, const sph_material_block *block,
                                    double *c) {
  return evaluate(material, SPHI_MATERIAL_SOUND_SPEED, block, c);
}

sph_status sph_material_shear_speed(const sph_material *material, const sph_material_block *block,
                                    double *c) {
  return evaluate(material, SPHI_MATERIAL_SHEAR_SPEED, block, c);
}

sph_status sph_material_small_strain_stress(const sph_material *material,
                                            const sph_material_block *block, double *sigma) {
  return evaluate(material, SPHI_MATERIAL_SMALL_STRAIN_STRESS, block, sigma);
}

sph_status sph_material_stress_rate_across(const sph_material *material,
                                           const sph_material_block *block, double *rate) {
  return evaluate(material, SPHI_MATERIAL_STRESS_RATE_ACROSS, block, rate);
}

sph_status sph_material_temperature(const sph_material *material, const sph_material_block *block,
                                    double *temperature) {
  return evaluate(material, SPHI_MATERIAL_TEMPERATURE, block, temperature);
}

sph_status sph_material_energy(const sph_material *material, const sph_material_block *block,
                               double *e) {
  return evaluate(material, SPHI_MATERIAL_ENERGY, block, e);
}

sph_status sph_material_pressure_derivatives(const sph_material *material,
                                             const sph_material_block *block, double *dp_drho,
                                             double *dp_de) {
  const int32_t property = SPHI_MATERIAL_PRESSURE_DERIVATIVES;
  sph_material_block mine;
  sph_status status =
      check_call(material, property, block, dp_drho != NULL ? dp_drho : dp_de, &mine);
  if (status != SPH_OK || mine.n == 0) return status;
  if (out_of_range(material, property, &mine))
    status = SPH_ERR_NUMERIC;
  else
    status = callback_status(
        material->functions.pressure_derivatives(material->user, &mine, dp_drho, dp_de));
  return sphi_material_explain(material, property, &mine, 0, status);
}

/* A host's law does not say what it needs: F must be there all the same. */
static sph_status check_of_f(const sph_material *material, int32_t property,
                             const sph_material_block *b, const double *out) {
  sph_material_block mine;
  sph_status status = check_call(material, property, b, out, &mine);
  if (status == SPH_OK && b->n > 0 && b->deformation_gradient == NULL)
    return sphi_fail(material->object.ctx, SPH_ERR_ARG, "%s: F is NULL", property_name(property));
  return status;
}

sph_status sph_material_cauchy_stress(const sph_material *material, int32_t dim, int64_t n,
                                      const double *F, double *sigma) {
  const sph_material_block b = sphi_material_block_of_f(dim, n, F);
  sph_status status = check_of_f(material, SPHI_MATERIAL_CAUCHY_STRESS, &b, sigma);
  return status == SPH_OK ? evaluate(material, SPHI_MATERIAL_CAUCHY_STRESS, &b, sigma) : status;
}

sph_status sph_material_first_piola(const sph_material *material, int32_t dim, int64_t n,
                                    const double *F, double *P, double *energy) {
  const sph_material_block b = sphi_material_block_of_f(dim, n, F);
  sph_status status = check_of_f(material, SPHI_MATERIAL_FIRST_PIOLA, &b, P);
  if (status != SPH_OK) return status;
  status = sphi_material_first_piola_quiet(material, dim, n, F, P, energy);
  return sphi_material_explain(material, SPHI_MATERIAL_FIRST_PIOLA, &b, 0, status);
}

sph_status sph_material_plastic_return(const sph_material *material, int32_t dim, int64_t n,
                                       double *sigma, double *across, double *plastic_strain,
                                       double *plastic_work) {
  const sph_material_block b = {.size = sizeof b, .dim = dim, .n = n, .sigma = sigma};
  sph_material_block mine;
  sph_status status = check_call(material, SPHI_MATERIAL_PLASTIC_RETURN, &b, sigma, &mine);
  if (status != SPH_OK) return status;
  sph_context *ctx = material->object.ctx;
  const uint32_t needs = material->needs[SPHI_MATERIAL_PLASTIC_RETURN];
  if (n > 0 && (needs & SPHI_NEEDS_ACROSS) && across == NULL)
    return sphi_fail(ctx, SPH_ERR_ARG, "plastic_return: across is NULL, the reduction needs it");
  if (n > 0 && (needs & SPHI_NEEDS_PLASTIC_STRAIN) && plastic_strain == NULL)
    return sphi_fail(ctx, SPH_ERR_ARG,
                     "plastic_return: plastic_strain is NULL, hardening needs it");
  status = sphi_material_plastic_return_quiet(material, &mine, sigma, across, plastic_strain,
                                              plastic_work);
  return sphi_material_explain(material, SPHI_MATERIAL_PLASTIC_RETURN, &mine, 0, status);
}
