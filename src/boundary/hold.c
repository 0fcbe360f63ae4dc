/* Held and driven particles: a finish hook that overwrites their rates. */
#include "boundary_impl.h"

#include <math.h>
#include <string.h>

typedef struct entry {
  int32_t field;
  int64_t n;
  uint64_t components;
  sph_hold_fn fn;
  void *user;
  int64_t *indices; /* n */
  double *normals;  /* n * 3, or NULL: values are held, not a traction */
} entry;

struct sph_hold {
  sphi_object base;
  entry *entries;
  int32_t count, capacity;
};

enum { MAX_COMPONENTS = 64 };

/* --- life -------------------------------------------------------------------------------- */

sph_status sph_hold_create(sph_context *ctx, sph_hold **out) {
  if (out) *out = NULL;
  sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (s) return s;
  if (!out) return sphi_fail(ctx, SPH_ERR_ARG, "hold: out is NULL");
  sph_hold *hold = sphi_calloc(ctx, sizeof *hold);
  if (!hold) return SPH_ERR_NOMEM;
  hold->base.magic = SPHI_MAGIC_HOLD;
  hold->base.ctx = ctx;
  sphi_context_retain(ctx);
  *out = hold;
  return SPH_OK;
}

static size_t bytes_of(int64_t n, size_t size) { return sphi_mul((size_t)n, size); }

static void free_entry(sph_context *ctx, entry *e) {
  sphi_free(ctx, e->indices, bytes_of(e->n, sizeof *e->indices));
  sphi_free(ctx, e->normals, bytes_of(e->n, 3 * sizeof *e->normals));
}

sph_status sph_hold_clear(sph_hold *hold) {
  sph_status s = sphi_check_handle(NULL, hold, SPHI_MAGIC_HOLD, "hold");
  if (s) return s;
  for (int32_t k = 0; k < hold->count; ++k) free_entry(hold->base.ctx, &hold->entries[k]);
  hold->count = 0;
  return SPH_OK;
}

void sph_hold_destroy(sph_hold *hold) {
  if (sph_hold_clear(hold)) return;
  sph_context *ctx = hold->base.ctx;
  sphi_free(ctx, hold->entries, bytes_of(hold->capacity, sizeof *hold->entries));
  hold->base.magic = 0;
  sphi_free(ctx, hold, sizeof *hold);
  sphi_context_release(ctx);
}

/* --- entries ----------------------------------------------------------------------------- */

static sph_status check_list(sph_context *ctx, int64_t n, const int64_t *indices, int64_t first) {
  if (n < 0 || n > INT32_MAX || first < 0 || first > INT32_MAX)
    return sphi_fail(ctx, SPH_ERR_ARG, "hold: %lld particles from %lld on", (long long)n,
                     (long long)first);
  for (int64_t k = 0; indices && k < n; ++k)
    if (indices[k] < 0)
      return sphi_fail(ctx, SPH_ERR_ARG, "hold: index %lld of entry %lld", (long long)indices[k],
                       (long long)k);
  return SPH_OK;
}

static sph_status make_room(sph_hold *hold) {
  sph_context *ctx = hold->base.ctx;
  if (hold->count < hold->capacity) return SPH_OK;
  const int32_t capacity = hold->capacity ? 2 * hold->capacity : 8;
  entry *grown = sphi_alloc(ctx, bytes_of(capacity, sizeof *grown));
  if (!grown) return SPH_ERR_NOMEM;
  if (hold->count > 0) memcpy(grown, hold->entries, (size_t)hold->count * sizeof *grown);
  sphi_free(ctx, hold->entries, bytes_of(hold->capacity, sizeof *grown));
  hold->entries = grown;
  hold->capacity = capacity;
  return SPH_OK;
}

/* Room and the list of particles; the rest of *e is filled in. */
static sph_status append(sph_hold *hold, entry e, const int64_t *indices, int64_t first,
                         int32_t *index) {
  sph_context *ctx = hold->base.ctx;
  sph_status s = make_room(hold);
  if (s) return s;
  e.indices = sphi_alloc(ctx, bytes_of(e.n, sizeof *e.indices));
  if (!e.indices) return SPH_ERR_NOMEM;
  for (int64_t k = 0; k < e.n; ++k) e.indices[k] = indices ? indices[k] : first + k;
  if (index) *index = hold->count;
  hold->entries[hold->count++] = e;
  return SPH_OK;
}

sph_status sph_hold_field(sph_hold *hold, int32_t field, int64_t n, const int64_t *indices,
                          int64_t first, uint64_t components, sph_hold_fn fn, void *user,
                          int32_t *index) {
  sph_status s = sphi_check_handle(NULL, hold, SPHI_MAGIC_HOLD, "hold");
  if (s) return s;
  if (field < 0 || field >= SPHI_FIELD_IDS || components == 0)
    return sphi_fail(hold->base.ctx, SPH_ERR_ARG, "hold: field %d, components %llx", field,
                     (unsigned long long)components);
  s = check_list(hold->base.ctx, n, indices, first);
  if (s) return s;
  const entry e = {.field = field, .n = n, .components = components, .fn = fn, .user = user};
  return append(hold, e, indices, first, index);
}

static sph_status check_normals(sph_context *ctx, int64_t n, const double *normals) {
  for (int64_t k = 0; k < n; ++k) {
    const double *m = normals + 3 * k, length = sqrt(sphi_dot(3, m, m));
    if (!(length > 0.0) || !isfinite(length))
      return sphi_fail(ctx, SPH_ERR_ARG, "hold: normal %lld is (%g, %g, %g)", (long long)k, m[0],
                       m[1], m[2]);
  }
  return SPH_OK;
}

sph_status sph_hold_traction(sph_hold *hold, int64_t n, const int64_t *indices, int64_t first,
                             const double *normals, sph_hold_fn fn, void *user, int32_t *index) {
  sph_status s = sphi_check_handle(NULL, hold, SPHI_MAGIC_HOLD, "hold");
  if (s) return s;
  sph_context *ctx = hold->base.ctx;
  if (!normals) return sphi_fail(ctx, SPH_ERR_ARG, "hold: normals is NULL");
  s = check_list(ctx, n, indices, first);
  if (!s) s = check_normals(ctx, n, normals);
  if (s) return s;
  entry e = {.field = SPH_FIELD_SIGMA, .n = n, .components = 1, .fn = fn, .user = user};
  e.normals = sphi_alloc(ctx, bytes_of(n, 3 * sizeof *e.normals));
  if (!e.normals) return SPH_ERR_NOMEM;
  if (n > 0) memcpy(e.normals, normals, (size_t)n * 3 * sizeof *e.normals);
  s = append(hold, e, indices, first, index);
  if (s) sphi_free(ctx, e.normals, bytes_of(n, 3 * sizeof *e.normals));
  return s;
}

/* --- the hook ---------------------------------------------------------------------------- */

static void hold_value(const entry *e, double t, int64_t i, int32_t components, double *rate) {
  double value[MAX_COMPONENTS] = {0.0};
  if (e->fn) e->fn(e->user, t, i, value);
  for (int32_t c = 0; c < components; ++c)
    if (e->components >> c & 1) rate[c] = value[c];
}

/* A normal without entries within the dimension has no traction to hold: 0. */
static int hold_traction(const entry *e, double t, int64_t k, int32_t dim, double *rate) {
  double s[3][3], value[3] = {0.0, 0.0, 0.0}, m[3] = {0.0, 0.0, 0.0}, c[3] = {0.0, 0.0, 0.0};
  const double *given = e->normals + 3 * k, length = sqrt(sphi_dot(dim, given, given));
  if (!(length > 0.0)) return 0;
  for (int32_t a = 0; a < dim; ++a) m[a] = given[a] / length;
  if (e->fn) e->fn(e->user, t, e->indices[k], value);
  sphi_sym_unpack(dim, rate, s);
  for (int32_t a = 0; a < dim; ++a) c[a] = value[a] - sphi_dot(dim, s[a], m);
  sphi_change_traction(s, m, c);
  sphi_sym_pack(dim, s, rate);
  return 1;
}

static sph_status run_entry(const sph_hold *hold, const entry *e, double t,
                            const sph_particles *set, double *rates) {
  const int32_t components = sph_particles_components(set, e->field);
  const int32_t dim = sph_particles_dim(set);
  const int64_t n = sph_particles_real_count(set);
  if (components < 64 && e->components != UINT64_MAX && e->components >> components)
    return sphi_fail(hold->base.ctx, SPH_ERR_ARG, "hold: mask %llx for the %d components of %s",
                     (unsigned long long)e->components, components, sphi_field_name(set, e->field));
  for (int64_t k = 0; k < e->n; ++k) {
    const int64_t i = e->indices[k];
    if (i >= n)
      return sphi_fail(hold->base.ctx, SPH_ERR_ARG, "hold: particle %lld of %lld", (long long)i,
                       (long long)n);
    if (!e->normals)
      hold_value(e, t, i, components, rates + i * components);
    else if (!hold_traction(e, t, k, dim, rates + i * components))
      return sphi_fail(hold->base.ctx, SPH_ERR_ARG,
                       "hold: the normal of particle %lld has no entry in %d-D", (long long)i, dim);
  }
  return SPH_OK;
}

static sph_status finish(const sph_hold *hold, double t, const sph_particles *set,
                         const sph_rate *rates, int32_t count) {
  sph_status s = sphi_check_handle(NULL, hold, SPHI_MAGIC_HOLD, "hold");
  if (!s) s = sphi_check_handle(hold->base.ctx, set, SPHI_MAGIC_PARTICLES, "set");
  if (!s && (count < 0 || (count > 0 && !rates)))
    s = sphi_fail(hold->base.ctx, SPH_ERR_ARG, "hold: %d rates, array %s", count,
                  rates ? "given" : "NULL");
  for (int32_t e = 0; !s && e < hold->count; ++e)
    for (int32_t k = 0; !s && k < count; ++k)
      if (rates[k].field == hold->entries[e].field && rates[k].values)
        s = run_entry(hold, &hold->entries[e], t, set, rates[k].values);
  return s;
}

int32_t sph_hold_finish(void *hold, double t, sph_particles *set, const sph_rate *rates,
                        int32_t count) {
  return finish(hold, t, set, rates, count);
}
