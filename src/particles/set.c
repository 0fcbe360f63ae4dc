/* Life of a particle set: options, create, destroy, plain questions. */
#include "set.h"

#include <string.h>

static const sph_particles_options default_options = {sizeof(sph_particles_options), 3, 0};

void sph_particles_options_init_sized(sph_particles_options *options, size_t size) {
  if (options == NULL || size < sizeof(size_t)) return;
  size_t known = size < sizeof default_options ? size : sizeof default_options;
  memset(options, 0, size); /* a newer caller's extra members read as "not asked for" */
  memcpy(options, &default_options, known);
  options->size = size;
}

static sph_status check_options(sph_context *ctx, const sph_particles_options *o) {
  if (o->dim < 1 || o->dim > 3)
    return sphi_fail(ctx, SPH_ERR_ARG, "particles: dim is %d, not 1, 2 or 3", (int)o->dim);
  if (o->capacity < 0)
    return sphi_fail(ctx, SPH_ERR_ARG, "particles: capacity %lld is negative",
                     (long long)o->capacity);
  if (o->capacity > SPHI_MAX_PARTICLES)
    return sphi_fail(ctx, SPH_ERR_LIMIT, "particles: capacity %lld exceeds the limit %lld",
                     (long long)o->capacity, (long long)SPHI_MAX_PARTICLES);
  return SPH_OK;
}

static sph_status build(sph_particles *set, const sph_particles_options *o) {
  set->dim = o->dim;
  set->generation = 1;
  sphi_set_name_builtins(set);
  sph_status status = sphi_set_grow(set, o->capacity);
  if (status != SPH_OK) return status;
  return sphi_field_create(set, &set->fields[SPH_FIELD_X]);
}

sph_status sph_particles_create(sph_context *ctx, const sph_particles_options *options,
                                sph_particles **out) {
  if (out != NULL) *out = NULL;
  sph_status status = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (status != SPH_OK) return status;
  if (out == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "particles: out is NULL");
  sph_particles_options o = default_options;
  status = sphi_options_read(ctx, &o, sizeof o, options);
  if (status == SPH_OK) status = check_options(ctx, &o);
  if (status != SPH_OK) return status;
  sph_particles *set = sphi_calloc(ctx, sizeof *set);
  if (set == NULL) return SPH_ERR_NOMEM;
  set->object.magic = SPHI_MAGIC_PARTICLES;
  set->object.ctx = ctx;
  sphi_context_retain(ctx);
  status = build(set, &o);
  if (status != SPH_OK) {
    sph_particles_destroy(set);
    return status;
  }
  *out = set;
  return SPH_OK;
}

static void free_arrays(sph_particles *set) {
  sph_context *ctx = set->object.ctx;
  for (int32_t s = 0; s < SPHI_FIELD_SLOTS; s++) {
    sphi_field *f = &set->fields[s];
    if (f->lent < 0) sphi_free(ctx, f->values, sphi_field_bytes(f, set->capacity));
  }
  size_t n = (size_t)set->capacity;
  sphi_free(ctx, set->roles, n * sizeof *set->roles);
  sphi_free(ctx, set->phases, n * sizeof *set->phases);
  sphi_free(ctx, set->ids, n * sizeof *set->ids);
  sphi_buffer_free(ctx, &set->marks);
}

void sph_particles_destroy(sph_particles *set) {
  if (sphi_check_handle(NULL, set, SPHI_MAGIC_PARTICLES, "set") != SPH_OK) return;
  sph_context *ctx = set->object.ctx;
  free_arrays(set);
  set->object.magic = 0;
  sphi_free(ctx, set, sizeof *set);
  sphi_context_release(ctx);
}

sph_status sphi_set_check(const sph_particles *set) {
  return sphi_check_handle(NULL, set, SPHI_MAGIC_PARTICLES, "set");
}

int32_t sph_particles_dim(const sph_particles *set) {
  return sphi_set_check(set) == SPH_OK ? set->dim : 0;
}

int64_t sph_particles_count(const sph_particles *set) {
  return sphi_set_check(set) == SPH_OK ? set->count : 0;
}

int64_t sph_particles_real_count(const sph_particles *set) {
  return sphi_set_check(set) == SPH_OK ? set->real_count : 0;
}

uint64_t sph_particles_generation(const sph_particles *set) {
  return sphi_set_check(set) == SPH_OK ? set->generation : 0;
}

int32_t *sph_particles_roles(sph_particles *set) {
  return sphi_set_check(set) == SPH_OK ? set->roles : NULL;
}

int32_t *sph_particles_phases(sph_particles *set) {
  return sphi_set_check(set) == SPH_OK ? set->phases : NULL;
}

const int64_t *sph_particles_ids(const sph_particles *set) {
  return sphi_set_check(set) == SPH_OK ? set->ids : NULL;
}

sph_context *sphi_particles_context(const sph_particles *set) { return set->object.ctx; }

const int32_t *sphi_particles_phases(const sph_particles *set) { return set->phases; }

const int32_t *sphi_particles_roles(const sph_particles *set) { return set->roles; }
