/* What a multistep method keeps of earlier steps, for each particle by its id: particles may be
 * added, removed and sorted between steps. */
#include "integrate_impl.h"

#include <string.h>

static int64_t rounded(int64_t n) { return (n + 7) / 8 * 8; }

void sphi_history_forget(sph_integrator *it) {
  it->history.count = -1;
  it->history.array_step = 0.0;
  it->history.set = NULL;
}

void sphi_history_free(sph_integrator *it) {
  sphi_buffer_free(it->base.ctx, &it->history.difference);
  sphi_buffer_free(it->base.ctx, &it->history.last_step);
  sphi_buffer_free(it->base.ctx, &it->history.ids);
}

/* ---- ids to indices ---------------------------------------------------------------------- */

/* Open addressing; a slot holds an index into `ids`, or -1. */
typedef struct id_map {
  const int64_t *ids;
  int64_t *slot;
  uint64_t mask;
} id_map;

static uint64_t hash(const id_map *map, int64_t id) {
  return ((uint64_t)id * UINT64_C(0x9e3779b97f4a7c15)) >> 20 & map->mask;
}

static void insert_all(id_map *map, int64_t n) {
  for (int64_t i = 0; i < n; ++i) {
    uint64_t at = hash(map, map->ids[i]);
    while (map->slot[at] >= 0) at = (at + 1) & map->mask;
    map->slot[at] = i;
  }
}

/* Old index of an id; -1: new. */
static int64_t find(const id_map *map, int64_t id) {
  uint64_t at = hash(map, id);
  while (map->slot[at] >= 0 && map->ids[map->slot[at]] != id) at = (at + 1) & map->mask;
  return map->slot[at];
}

/* ---- another set of particles ------------------------------------------------------------ */

/* The new history in the making. */
typedef struct remap {
  sphi_buffer difference, last_step, ids, slots, old_index;
  uint64_t mask;
} remap;

static void free_remap(sph_context *ctx, remap *m) {
  sphi_buffer_free(ctx, &m->difference);
  sphi_buffer_free(ctx, &m->last_step);
  sphi_buffer_free(ctx, &m->ids);
  sphi_buffer_free(ctx, &m->slots);
  sphi_buffer_free(ctx, &m->old_index);
}

static sph_status reserve(sph_context *ctx, sphi_buffer *b, int64_t count) {
  return sphi_buffer_reserve(ctx, b, sphi_mul((size_t)count, 8));
}

static sph_status make_room(const sph_integrator *it, remap *m) {
  sph_context *ctx = it->base.ctx;
  const int64_t n = it->real_count, old = it->history.count > 0 ? it->history.count : 0;
  int64_t slots = 2;
  while (slots < 2 * old) slots *= 2;
  m->mask = (uint64_t)slots - 1;
  sph_status status = reserve(ctx, &m->difference, it->stride);
  if (status == SPH_OK) status = reserve(ctx, &m->last_step, n);
  if (status == SPH_OK) status = reserve(ctx, &m->ids, n);
  if (status == SPH_OK) status = reserve(ctx, &m->old_index, n);
  return status == SPH_OK ? reserve(ctx, &m->slots, slots) : status;
}

static void find_old(const sph_integrator *it, const sph_particles *set, remap *m) {
  const int64_t *ids = sph_particles_ids(set);
  const double *last = it->history.last_step.ptr;
  int64_t *old = m->old_index.ptr;
  id_map map = {it->history.ids.ptr, m->slots.ptr, m->mask};
  for (uint64_t s = 0; s <= m->mask; ++s) map.slot[s] = -1;
  insert_all(&map, it->history.count > 0 ? it->history.count : 0);
  for (int64_t i = 0; i < it->real_count; ++i) {
    old[i] = find(&map, ids[i]);
    ((double *)m->last_step.ptr)[i] = old[i] < 0 ? 0.0 : last[old[i]];
    ((int64_t *)m->ids.ptr)[i] = ids[i];
  }
}

/* Item by item; `from` is where the item began in the old layout. */
static void move_field(const sphi_item *item, int64_t count, const int64_t *old, const double *from,
                       double *to) {
  const int64_t components = item->n / count;
  const size_t bytes = (size_t)components * sizeof *to;
  for (int64_t i = 0; i < count; ++i) {
    if (old[i] < 0)
      memset(to + i * components, 0, bytes);
    else
      memcpy(to + i * components, from + old[i] * components, bytes);
  }
}

static void move_differences(const sph_integrator *it, const sph_particles *set, remap *m) {
  const int32_t known = it->history.count >= 0;
  const double *from = it->history.difference.ptr;
  for (int32_t k = 0; k < it->items; ++k) {
    const sphi_item *item = &it->item[k];
    double *to = (double *)m->difference.ptr + item->offset;
    int64_t old_n = item->n;
    if (item->field >= 0) {
      old_n = known ? it->history.count * sph_particles_components(set, item->field) : 0;
      if (item->n > 0) move_field(item, it->real_count, m->old_index.ptr, from, to);
    } else if (item->n > 0) {
      const size_t bytes = (size_t)item->n * sizeof *to;
      if (known)
        memcpy(to, from, bytes);
      else
        memset(to, 0, bytes);
    }
    if (known) from += rounded(old_n);
  }
}

static void swap(sphi_buffer *a, sphi_buffer *b) {
  const sphi_buffer keep = *a;
  *a = *b;
  *b = keep;
}

static sph_status rebuild(sph_integrator *it, const sph_particles *set) {
  remap m = {.mask = 0};
  sph_status status = make_room(it, &m);
  if (status == SPH_OK) {
    if (set) find_old(it, set, &m);
    move_differences(it, set, &m);
    swap(&it->history.difference, &m.difference);
    swap(&it->history.last_step, &m.last_step);
    swap(&it->history.ids, &m.ids);
    it->history.count = it->real_count;
    it->history.set = set;
  }
  free_remap(it->base.ctx, &m);
  return status;
}

static int32_t same_ids(const sphi_history *h, const sph_particles *set) {
  if (!set || h->count == 0) return 1;
  return memcmp(h->ids.ptr, sph_particles_ids(set), (size_t)h->count * sizeof(int64_t)) == 0;
}

sph_status sphi_history_follow(sph_integrator *it, const sph_particles *set) {
  sphi_history *h = &it->history;
  if (it->options.method != SPH_INTEGRATOR_LEAPFROG_PREDICTED) return SPH_OK;
  const sph_particles *of = it->fields > 0 ? set : NULL;
  if (h->set != of) sphi_history_forget(it);
  return h->count == it->real_count && same_ids(h, of) ? SPH_OK : rebuild(it, of);
}

void sphi_history_stamp(sph_integrator *it, double dt) {
  double *last = it->history.last_step.ptr;
  for (int64_t i = 0; i < it->real_count; ++i) last[i] = dt;
  it->history.array_step = dt;
}
