/* The material handle: creation, references, what the constructors of all laws check. */
#include "material_impl.h"

#include <math.h>
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
  const sph_material probe = {.functions = f};
  int32_t laws = 0;
  for (int32_t k = 0; k < SPHI_MATERIAL_PROPERTIES; k++) laws += sphi_material_has(&probe, k);
  if (laws == 0) return sphi_fail(ctx, SPH_ERR_ARG, "material: the table has no law at all");
  return sphi_material_make(ctx, &f, user, out);
}

sph_status sphi_material_begin(sph_context *ctx, const char *name, void *mine, size_t size,
                               const void *options, sph_material **out) {
  if (out != NULL) *out = NULL;
  sph_status status = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (status != SPH_OK) return status;
  if (out == NULL || options == NULL)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: %s is NULL", name, out == NULL ? "out" : "options");
  return sphi_options_read(ctx, mine, size, options);
}

sph_status sphi_material_positive(sph_context *ctx, const char *law, const char *name,
                                  double value) {
  if (value > 0 && isfinite(value)) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_ARG, "%s: %s = %g is not positive and finite", law, name, value);
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
