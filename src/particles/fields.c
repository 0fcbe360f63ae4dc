/* Fields of a particle set: names, creation, lending, revisions. */
#include "set.h"

#include <string.h>

/* Components of the built-in fields: a number, or one of those that depend on dim. */
enum { VECTOR = -1, TENSOR = -2, MATRIX = -3 };
typedef struct builtin_field {
  const char *name;
  int32_t components;
} builtin_field;

static const builtin_field builtins[SPHI_BUILTIN_FIELDS] = {[SPH_FIELD_X] = {"x", VECTOR},
                                                            [SPH_FIELD_V] = {"v", VECTOR},
                                                            [SPH_FIELD_M] = {"m", 1},
                                                            [SPH_FIELD_RHO] = {"rho", 1},
                                                            [SPH_FIELD_H] = {"h", 1},
                                                            [SPH_FIELD_P] = {"p", 1},
                                                            [SPH_FIELD_C] = {"c", 1},
                                                            [SPH_FIELD_E] = {"e", 1},
                                                            [SPH_FIELD_SIGMA] = {"sigma", TENSOR},
                                                            [SPH_FIELD_X0] = {"x0", VECTOR},
                                                            [SPH_FIELD_A] = {"a", VECTOR},
                                                            [SPH_FIELD_SPACING] = {"spacing", 1},
                                                            [SPH_FIELD_F] = {"F", MATRIX},
                                                            [SPH_FIELD_PK] = {"PK", MATRIX},
                                                            [SPH_FIELD_OMEGA] = {"omega", 1}};

static int32_t resolve_components(int32_t code, int32_t dim) {
  if (code == VECTOR) return dim;
  if (code == MATRIX) return dim * dim;
  return code == TENSOR ? dim * (dim + 1) / 2 : code;
}

void sphi_set_name_builtins(sph_particles *set) {
  for (int32_t s = 0; s < SPHI_FIELD_SLOTS; s++) set->fields[s].lent = -1;
  for (int32_t s = 0; s < SPHI_BUILTIN_FIELDS; s++) {
    sphi_field *f = &set->fields[s];
    memcpy(f->name, builtins[s].name, strlen(builtins[s].name) + 1);
    f->components = resolve_components(builtins[s].components, set->dim);
  }
}

static int32_t slot_of(const sph_particles *set, int32_t field) {
  if (field >= 0 && field < SPHI_BUILTIN_FIELDS) return field;
  if (field < SPHI_HOST_FIELD_BASE || field >= SPHI_HOST_FIELD_BASE + set->host_fields) return -1;
  return field - SPHI_HOST_FIELD_BASE + SPHI_BUILTIN_FIELDS;
}

sphi_field *sphi_set_field(const sph_particles *set, int32_t field) {
  int32_t slot = slot_of(set, field);
  /* The slot of a const set is handed to callers that got the set itself as writable. */
  return slot < 0 ? NULL : (sphi_field *)&set->fields[slot];
}

sphi_shape sphi_field_shape(const sph_particles *set, int32_t field) {
  int32_t slot = slot_of(set, field);
  if (slot < 0 || slot >= SPHI_BUILTIN_FIELDS || builtins[slot].components > 0)
    return SPHI_SHAPE_PLAIN;
  if (builtins[slot].components == VECTOR) return SPHI_SHAPE_VECTOR;
  return builtins[slot].components == TENSOR ? SPHI_SHAPE_SYMMETRIC : SPHI_SHAPE_MATRIX;
}

size_t sphi_field_bytes(const sphi_field *f, int64_t particles) {
  return sphi_mul((size_t)particles, (size_t)f->components * sizeof(double));
}

sph_status sphi_field_create(sph_particles *set, sphi_field *f) {
  f->values = sphi_alloc(set->object.ctx, sphi_field_bytes(f, set->capacity));
  if (f->values == NULL) return SPH_ERR_NOMEM;
  memset(f->values, 0, sphi_field_bytes(f, set->count)); /* the rest when particles are added */
  f->lent = -1;
  f->revision++;
  return SPH_OK;
}

int32_t sphi_set_columns(const sph_particles *set, sphi_column columns[SPHI_MAX_COLUMNS]) {
  int32_t n = 0;
  columns[n++] = (sphi_column){set->roles, sizeof *set->roles};
  columns[n++] = (sphi_column){set->phases, sizeof *set->phases};
  columns[n++] = (sphi_column){set->ids, sizeof *set->ids};
  for (int32_t s = 0; s < SPHI_FIELD_SLOTS; s++) {
    const sphi_field *f = &set->fields[s];
    if (f->values != NULL) columns[n++] = (sphi_column){f->values, sphi_field_bytes(f, 1)};
  }
  return n;
}

void sphi_set_touch_all(sph_particles *set) {
  for (int32_t s = 0; s < SPHI_FIELD_SLOTS; s++)
    if (set->fields[s].values != NULL) set->fields[s].revision++;
}

const char *sphi_field_name(const sph_particles *set, int32_t field) {
  const sphi_field *f = sphi_set_field(set, field);
  return f != NULL ? f->name : "unknown";
}

static sph_status unknown_field(const sph_particles *set, int32_t field, const char *call) {
  return sphi_fail(set->object.ctx, SPH_ERR_ARG, "%s: there is no field %d", call, (int)field);
}

int32_t sph_particles_find_field(const sph_particles *set, const char *name) {
  if (sphi_set_check(set) != SPH_OK || name == NULL) return -1;
  for (int32_t s = 0; s < SPHI_BUILTIN_FIELDS + set->host_fields; s++)
    if (strcmp(set->fields[s].name, name) == 0)
      return s < SPHI_BUILTIN_FIELDS ? s : s - SPHI_BUILTIN_FIELDS + SPHI_HOST_FIELD_BASE;
  return -1;
}

/* strlen() that stops looking: a host's name may lack its terminator. */
static size_t bounded_length(const char *name) {
  size_t n = 0;
  while (n < SPHI_FIELD_NAME && name[n] != '\0') n++;
  return n;
}

static sph_status check_new_field(const sph_particles *set, const char *name, int32_t components) {
  sph_context *ctx = set->object.ctx;
  size_t length = bounded_length(name);
  if (length == 0 || length >= SPHI_FIELD_NAME)
    return sphi_fail(ctx, SPH_ERR_ARG, "add_field: the name must have 1 to %d characters",
                     SPHI_FIELD_NAME - 1);
  if (components < 1 || components > SPHI_MAX_COMPONENTS)
    return sphi_fail(ctx, SPH_ERR_ARG, "add_field: '%s' has %d components, not 1 to %d", name,
                     (int)components, SPHI_MAX_COMPONENTS);
  if (sph_particles_find_field(set, name) >= 0)
    return sphi_fail(ctx, SPH_ERR_ARG, "add_field: there is a field '%s' already", name);
  if (set->host_fields == SPHI_HOST_FIELDS)
    return sphi_fail(ctx, SPH_ERR_LIMIT, "add_field: '%s' would be host field %d of at most %d",
                     name, SPHI_HOST_FIELDS + 1, SPHI_HOST_FIELDS);
  return SPH_OK;
}

sph_status sph_particles_add_field(sph_particles *set, const char *name, int32_t components,
                                   int32_t *field) {
  sph_status status = sphi_set_check(set);
  if (status != SPH_OK) return status;
  if (name == NULL || field == NULL)
    return sphi_fail(set->object.ctx, SPH_ERR_ARG, "add_field: %s is NULL",
                     name == NULL ? "name" : "field");
  status = check_new_field(set, name, components);
  if (status != SPH_OK) return status;
  sphi_field fresh = {.components = components, .lent = -1};
  memcpy(fresh.name, name, bounded_length(name));
  status = sphi_field_create(set, &fresh);
  if (status != SPH_OK) return status;
  set->fields[SPHI_BUILTIN_FIELDS + set->host_fields] = fresh;
  *field = SPHI_HOST_FIELD_BASE + set->host_fields++;
  return SPH_OK;
}

int32_t sph_particles_components(const sph_particles *set, int32_t field) {
  if (sphi_set_check(set) != SPH_OK) return 0;
  const sphi_field *f = sphi_set_field(set, field);
  return f != NULL ? f->components : 0;
}

sph_status sph_particles_field(sph_particles *set, int32_t field, double **array) {
  if (array != NULL) *array = NULL;
  sph_status status = sphi_set_check(set);
  if (status != SPH_OK) return status;
  if (array == NULL) return sphi_fail(set->object.ctx, SPH_ERR_ARG, "field: array is NULL");
  sphi_field *f = sphi_set_field(set, field);
  if (f == NULL) return unknown_field(set, field, "field");
  if (f->values == NULL) status = sphi_field_create(set, f);
  if (status == SPH_OK) *array = f->values;
  return status;
}

const double *sph_particles_field_const(const sph_particles *set, int32_t field) {
  if (sphi_set_check(set) != SPH_OK) return NULL;
  const sphi_field *f = sphi_set_field(set, field);
  return f != NULL ? f->values : NULL;
}

/* The other field whose array overlaps the host's, or the field itself where the array is its own:
 * growth would free what is lent, sorting would reorder it twice. Addresses as numbers, for
 * pointers into different arrays must not be compared. */
static const sphi_field *overlapping(const sph_particles *set, const sphi_field *wanted,
                                     const double *array, int64_t capacity) {
  uintptr_t begin = (uintptr_t)array;
  size_t bytes = sphi_field_bytes(wanted, capacity);
  for (int32_t s = 0; s < SPHI_FIELD_SLOTS; s++) {
    const sphi_field *f = &set->fields[s];
    uintptr_t own = (uintptr_t)f->values;
    if (f->values == NULL || (f == wanted && f->lent >= 0)) continue;
    size_t own_bytes = sphi_field_bytes(f, f->lent >= 0 ? f->lent : set->capacity);
    if (begin == own || (begin > own ? begin - own < own_bytes : own - begin < bytes)) return f;
  }
  return NULL;
}

/* Put the host's array in place of the field's. */
static void lend(sph_particles *set, sphi_field *f, double *array, int64_t capacity) {
  if (f->lent < 0) sphi_free(set->object.ctx, f->values, sphi_field_bytes(f, set->capacity));
  f->values = array;
  f->lent = capacity;
}

/* Replace the host's array by a copy of our own. */
static sph_status take_back(sph_particles *set, sphi_field *f) {
  double *own = sphi_alloc(set->object.ctx, sphi_field_bytes(f, set->capacity));
  if (own == NULL) return SPH_ERR_NOMEM;
  memcpy(own, f->values, sphi_field_bytes(f, set->count));
  f->values = own;
  f->lent = -1;
  return SPH_OK;
}

sph_status sph_particles_lend(sph_particles *set, int32_t field, double *array, int64_t capacity) {
  sph_status status = sphi_set_check(set);
  if (status != SPH_OK) return status;
  sphi_field *f = sphi_set_field(set, field);
  if (f == NULL) return unknown_field(set, field, "lend");
  if (array == NULL && f->lent < 0) return SPH_OK; /* nothing to take back */
  if (array != NULL && capacity < set->count)
    return sphi_fail(set->object.ctx, SPH_ERR_ARG,
                     "lend: the array for field '%s' holds %lld particles, the set has %lld",
                     f->name, (long long)capacity, (long long)set->count);
  const sphi_field *other = array != NULL ? overlapping(set, f, array, capacity) : NULL;
  if (other != NULL)
    return sphi_fail(set->object.ctx, SPH_ERR_ARG,
                     "lend: the array for field '%s' overlaps that of field '%s' (%s)", f->name,
                     other->name, other->lent < 0 ? "the set's own" : "lent too");
  if (array != NULL)
    lend(set, f, array, capacity);
  else
    status = take_back(set, f);
  if (status != SPH_OK) return status;
  f->revision++;
  set->generation++;
  return SPH_OK;
}

sph_status sph_particles_touch(sph_particles *set, int32_t field) {
  sph_status status = sphi_set_check(set);
  if (status != SPH_OK) return status;
  sphi_field *f = sphi_set_field(set, field);
  if (f == NULL) return unknown_field(set, field, "touch");
  if (f->values == NULL)
    return sphi_fail(set->object.ctx, SPH_ERR_ARG, "touch: field '%s' was never created", f->name);
  f->revision++;
  return SPH_OK;
}

uint64_t sph_particles_revision(const sph_particles *set, int32_t field) {
  if (sphi_set_check(set) != SPH_OK) return 0;
  const sphi_field *f = sphi_set_field(set, field);
  return f != NULL ? f->revision : 0;
}
