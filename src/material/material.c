/* The material handle: creation, references, checks, dispatch to the law's functions. */
#include "material_impl.h"

#include <string.h>

void sphi_material_init_sized(void *options, size_t size, const void *defaults, size_t known) {
  if (options == NULL || size < sizeof(size_t)) return;
  memset(options, 0, size); /* a newer caller's extra members read as "not asked for" */
  memcpy(options, defaults, size < known ? size : known);
  memcpy(options, &size, sizeof size);
}

void sph_material_block_init_sized(sph_material_block *block, size_t size) {
  const sph_material_block none = {.size = sizeof none};
  sphi_material_init_sized(block, size, &none, sizeof none);
}

void sph_material_functions_init_sized(sph_material_functions *f, size_t size) {
  const sph_material_functions none = {.size = sizeof none};
  sphi_material_init_sized(f, size, &none, sizeof none);
}

sph_status sphi_material_make(sph_context *ctx, const sph_material_functions *functions, void *user,
                              sph_material **out) {
  sph_material *material = sphi_calloc(ctx, sizeof *material);
  if (material == NULL) return SPH_ERR_NOMEM;
  material->object.magic = SPHI_MAGIC_MATERIAL;
  material->object.ctx = ctx;
  sphi_context_retain(ctx);
  material->references = 1;
  material->functions = *functions;
  material->user = user;
  *out = material;
  return SPH_OK;
}

sph_status sph_material_create(sph_context *ctx, const sph_material_functions *functions,
                               void *user, sph_material **out) {
  if (out != NULL) *out = NULL;
  sph_status status = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (status != SPH_OK) return status;
  if (out == NULL || functions == NULL)
    return sphi_fail(ctx, SPH_ERR_ARG, "material: %s is NULL", out == NULL ? "out" : "functions");
  sph_material_functions f = {.size = sizeof f};
  status = sphi_options_read(ctx, &f, sizeof f, functions);
  if (status != SPH_OK) return status;
  if (f.stress_rate == NULL && f.pressure == NULL && f.sound_speed == NULL)
    return sphi_fail(ctx, SPH_ERR_ARG, "material: the table has no law at all");
  return sphi_material_make(ctx, &f, user, out);
}

void sphi_material_retain(sph_material *material) {
  if (material != NULL) material->references++;
}

void sphi_material_release(sph_material *material) {
  if (material == NULL || --material->references > 0) return;
  sph_context *ctx = material->object.ctx;
  material->object.magic = 0; /* first: the callback may try to destroy the handle again */
  if (material->functions.destroy != NULL) material->functions.destroy(material->user);
  sphi_free(ctx, material, sizeof *material);
  sphi_context_release(ctx);
}

void sph_material_destroy(sph_material *material) {
  if (sphi_check_handle(NULL, material, SPHI_MAGIC_MATERIAL, "material") == SPH_OK)
    sphi_material_release(material);
}

int32_t sphi_material_has(const sph_material *material, int32_t property) {
  if (material == NULL) return 0;
  switch (property) {
  case SPHI_MATERIAL_STRESS_RATE:
    return material->functions.stress_rate != NULL;
  case SPHI_MATERIAL_PRESSURE:
    return material->functions.pressure != NULL;
  case SPHI_MATERIAL_SOUND_SPEED:
    return material->functions.sound_speed != NULL;
  default:
    return 0;
  }
}

uint32_t sphi_material_needs(const sph_material *material, int32_t property) {
  return material->needs[property];
}

int32_t sphi_material_dim(const sph_material *material) { return material->dim; }

static const char *property_name(int32_t property) {
  static const char *const names[] = {"stress_rate", "pressure", "sound_speed"};
  return names[property];
}

/* Name of the first array that is needed and NULL; NULL when all are there. */
static const char *missing_array(uint32_t needs, const sph_material_block *b) {
  if ((needs & SPHI_NEEDS_GRADIENT) && b->velocity_gradient == NULL) return "velocity_gradient";
  if ((needs & SPHI_NEEDS_SIGMA) && b->sigma == NULL) return "sigma";
  if ((needs & SPHI_NEEDS_RHO) && b->rho == NULL) return "rho";
  if ((needs & SPHI_NEEDS_E) && b->e == NULL) return "e";
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

static sph_status callback_status(int32_t returned) {
  if (returned == 0) return SPH_OK;
  return returned > 0 ? SPH_RETRY : SPH_ERR_CALLBACK;
}

sph_status sphi_material_stress_rate_quiet(const sph_material *material,
                                           const sph_material_block *block, double *dsigma) {
  if (block->n == 0) return SPH_OK;
  return callback_status(material->functions.stress_rate(material->user, block, dsigma));
}

sph_status sphi_material_pressure_quiet(const sph_material *material,
                                        const sph_material_block *block, double *p) {
  if (block->n == 0) return SPH_OK;
  return callback_status(material->functions.pressure(material->user, block, p));
}

sph_status sphi_material_sound_speed_quiet(const sph_material *material,
                                           const sph_material_block *block, double *c) {
  if (block->n == 0) return SPH_OK;
  return callback_status(material->functions.sound_speed(material->user, block, c));
}

sph_status sphi_material_fail(const sph_material *material, int32_t property, sph_status status) {
  if (status >= 0) return status;
  return sphi_fail(material->object.ctx, status, "%s: the material's callback failed",
                   property_name(property));
}

/* What the three public calls check alike. *mine receives the block in this library's size. */
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

sph_status sph_material_stress_rate(const sph_material *material, const sph_material_block *block,
                                    double *dsigma) {
  sph_material_block mine;
  sph_status status = check_call(material, SPHI_MATERIAL_STRESS_RATE, block, dsigma, &mine);
  if (status != SPH_OK) return status;
  status = sphi_material_stress_rate_quiet(material, &mine, dsigma);
  return sphi_material_fail(material, SPHI_MATERIAL_STRESS_RATE, status);
}

sph_status sph_material_pressure(const sph_material *material, const sph_material_block *block,
                                 double *p) {
  sph_material_block mine;
  sph_status status = check_call(material, SPHI_MATERIAL_PRESSURE, block, p, &mine);
  if (status != SPH_OK) return status;
  status = sphi_material_pressure_quiet(material, &mine, p);
  return sphi_material_fail(material, SPHI_MATERIAL_PRESSURE, status);
}

sph_status sph_material_sound_speed(const sph_material *material, const sph_material_block *block,
                                    double *c) {
  sph_material_block mine;
  sph_status status = check_call(material, SPHI_MATERIAL_SOUND_SPEED, block, c, &mine);
  if (status != SPH_OK) return status;
  status = sphi_material_sound_speed_quiet(material, &mine, c);
  return sphi_material_fail(material, SPHI_MATERIAL_SOUND_SPEED, status);
}
