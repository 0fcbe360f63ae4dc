/* Growth of a particle set: reserve, add, ghosts. */
#include "set.h"

#include <string.h>

/* Fresh arrays of a growing set; NULL where the set has none of its own. */
typedef struct fresh_arrays {
  double *fields[SPHI_FIELD_SLOTS];
  int32_t *roles, *phases;
  int64_t *ids;
  int64_t capacity;
} fresh_arrays;

static int owns_array(const sphi_field *f) { return f->values != NULL && f->lent < 0; }

static sph_status fresh_alloc(const sph_particles *set, fresh_arrays *fresh) {
  sph_context *ctx = set->object.ctx;
  size_t n = (size_t)fresh->capacity;
  fresh->roles = sphi_alloc(ctx, sphi_mul(n, sizeof *fresh->roles));
  if (fresh->roles == NULL) return SPH_ERR_NOMEM;
  fresh->phases = sphi_alloc(ctx, sphi_mul(n, sizeof *fresh->phases));
  if (fresh->phases == NULL) return SPH_ERR_NOMEM;
  fresh->ids = sphi_alloc(ctx, sphi_mul(n, sizeof *fresh->ids));
  if (fresh->ids == NULL) return SPH_ERR_NOMEM;
  for (int32_t s = 0; s < SPHI_FIELD_SLOTS; s++) {
    const sphi_field *f = &set->fields[s];
    if (!owns_array(f)) continue;
    fresh->fields[s] = sphi_alloc(ctx, sphi_field_bytes(f, fresh->capacity));
    if (fresh->fields[s] == NULL) return SPH_ERR_NOMEM;
  }
  return SPH_OK;
}

static void fresh_free(const sph_particles *set, fresh_arrays *fresh) {
  sph_context *ctx = set->object.ctx;
  size_t n = (size_t)fresh->capacity;
  sphi_free(ctx, fresh->roles, n * sizeof *fresh->roles);
  sphi_free(ctx, fresh->phases, n * sizeof *fresh->phases);
  sphi_free(ctx, fresh->ids, n * sizeof *fresh->ids);
  for (int32_t s = 0; s < SPHI_FIELD_SLOTS; s++)
    if (fresh->fields[s] != NULL)
      sphi_free(ctx, fresh->fields[s], sphi_field_bytes(&set->fields[s], fresh->capacity));
}

static void copy_into(const sph_particles *set, fresh_arrays *fresh) {
  size_t n = (size_t)set->count;
  if (n == 0) return;
  memcpy(fresh->roles, set->roles, n * sizeof *fresh->roles);
  memcpy(fresh->phases, set->phases, n * sizeof *fresh->phases);
  memcpy(fresh->ids, set->ids, n * sizeof *fresh->ids);
  for (int32_t s = 0; s < SPHI_FIELD_SLOTS; s++)
    if (fresh->fields[s] != NULL)
      memcpy(fresh->fields[s], set->fields[s].values,
             sphi_field_bytes(&set->fields[s], set->count));
}

/* Exchange the set's own arrays with `fresh`, which then holds the old ones. */
static void swap_arrays(sph_particles *set, fresh_arrays *fresh) {
  fresh_arrays old = {{NULL}, set->roles, set->phases, set->ids, set->capacity};
  for (int32_t s = 0; s < SPHI_FIELD_SLOTS; s++) {
    if (fresh->fields[s] == NULL) continue;
    old.fields[s] = set->fields[s].values;
    set->fields[s].values = fresh->fields[s];
  }
  set->roles = fresh->roles;
  set->phases = fresh->phases;
  set->ids = fresh->ids;
  set->capacity = fresh->capacity;
  *fresh = old;
}

sph_status sphi_set_grow(sph_particles *set, int64_t capacity) {
  fresh_arrays fresh = {{NULL}, NULL, NULL, NULL, capacity};
  sph_status status = fresh_alloc(set, &fresh);
  if (status == SPH_OK) {
    copy_into(set, &fresh);
    swap_arrays(set, &fresh);
  }
  fresh_free(set, &fresh);
  return status;
}

/* The shortest lent array; NULL when nothing is lent. */
static const sphi_field *shortest_lent(const sph_particles *set) {
  const sphi_field *shortest = NULL;
  for (int32_t s = 0; s < SPHI_FIELD_SLOTS; s++) {
    const sphi_field *f = &set->fields[s];
    if (f->lent >= 0 && (shortest == NULL || f->lent < shortest->lent)) shortest = f;
  }
  return shortest;
}

/* Whether the set may hold `n` particles at all. */
static sph_status check_room(const sph_particles *set, int64_t n, const char *call) {
  if (n > SPHI_MAX_PARTICLES)
    return sphi_fail(set->object.ctx, SPH_ERR_LIMIT, "%s: %lld particles exceed the limit %lld",
                     call, (long long)n, (long long)SPHI_MAX_PARTICLES);
  const sphi_field *f = shortest_lent(set);
  if (f != NULL && n > f->lent)
    return sphi_fail(set->object.ctx, SPH_ERR_LIMIT,
                     "%s: %lld particles, but the array lent to field '%s' holds %lld", call,
                     (long long)n, f->name, (long long)f->lent);
  return SPH_OK;
}

sph_status sph_particles_reserve(sph_particles *set, int64_t capacity) {
  sph_status status = sphi_set_check(set);
  if (status != SPH_OK) return status;
  if (capacity < 0)
    return sphi_fail(set->object.ctx, SPH_ERR_ARG, "reserve: capacity %lld is negative",
                     (long long)capacity);
  status = check_room(set, capacity, "reserve");
  if (status != SPH_OK || capacity <= set->capacity) return status;
  status = sphi_set_grow(set, capacity);
  if (status == SPH_OK) set->generation++;
  return status;
}

/* Capacity to grow to for `n` particles: half as much again, within the limits. */
static int64_t grown_capacity(const sph_particles *set, int64_t n) {
  int64_t c = set->capacity + set->capacity / 2;
  const sphi_field *f = shortest_lent(set);
  if (f != NULL && c > f->lent) c = f->lent;
  if (c > SPHI_MAX_PARTICLES) c = SPHI_MAX_PARTICLES;
  return c > n ? c : n;
}

static sph_status make_room(sph_particles *set, int64_t n, const char *call) {
  if (n < 0)
    return sphi_fail(set->object.ctx, SPH_ERR_ARG, "%s: n = %lld is negative", call, (long long)n);
  /* n alone may be near INT64_MAX, so the sum waits until n is known to be small. */
  sph_status status =
      n > SPHI_MAX_PARTICLES ? check_room(set, n, call) : check_room(set, set->count + n, call);
  if (status != SPH_OK || set->count + n <= set->capacity) return status;
  return sphi_set_grow(set, grown_capacity(set, set->count + n));
}

static void zero_fields(sph_particles *set, int64_t n) {
  for (int32_t s = 0; s < SPHI_FIELD_SLOTS; s++) {
    sphi_field *f = &set->fields[s];
    if (!owns_array(f)) continue;
    memset(f->values + set->count * f->components, 0, sphi_field_bytes(f, n));
  }
}

/* Append n records; the room is there. */
static void append(sph_particles *set, int64_t n, int32_t role) {
  zero_fields(set, n);
  for (int64_t i = set->count; i < set->count + n; i++) {
    set->roles[i] = role;
    set->phases[i] = 0;
    set->ids[i] = role == SPH_ROLE_GHOST ? -1 : set->next_id++;
  }
  set->count += n;
  if (role != SPH_ROLE_GHOST) set->real_count += n;
}

static sph_status add(sph_particles *set, int64_t n, int32_t role, const char *call,
                      int64_t *first) {
  sph_status status = make_room(set, n, call);
  if (status != SPH_OK) return status;
  if (first != NULL) *first = set->count;
  if (n == 0) return SPH_OK;
  append(set, n, role);
  set->generation++;
  sphi_set_touch_all(set);
  return SPH_OK;
}

sph_status sph_particles_add(sph_particles *set, int64_t n, int64_t *first) {
  sph_status status = sphi_set_check(set);
  if (status != SPH_OK) return status;
  if (set->count != set->real_count)
    return sphi_fail(set->object.ctx, SPH_ERR_STATE,
                     "add: the set holds %lld ghosts; clear them first",
                     (long long)(set->count - set->real_count));
  return add(set, n, SPH_ROLE_REAL, "add", first);
}

sph_status sph_particles_add_ghosts(sph_particles *set, int64_t n, int64_t *first) {
  sph_status status = sphi_set_check(set);
  if (status != SPH_OK) return status;
  return add(set, n, SPH_ROLE_GHOST, "add_ghosts", first);
}

sph_status sph_particles_clear_ghosts(sph_particles *set) {
  sph_status status = sphi_set_check(set);
  if (status != SPH_OK || set->count == set->real_count) return status;
  set->count = set->real_count;
  set->generation++;
  return SPH_OK;
}
