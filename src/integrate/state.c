/* The state: bound items as pieces {y, n}, flat copies, linear combinations, reductions.
 *
 * Every loop writes only its own range and adds in an order that does not depend on how the
 * range is cut, so results have the same bits for any number of threads. */
#include "integrate_impl.h"

#include "../particles/particles_impl.h"

#include <math.h>
#include <string.h>

/* ---- layout ------------------------------------------------------------------------------ */

static sph_status find_field(sph_integrator *it, sph_particles *set, sphi_item *item) {
  sph_context *ctx = it->base.ctx;
  int32_t components = sph_particles_components(set, item->field);
  if (components < 1)
    return sphi_fail(ctx, SPH_ERR_ARG, "bound field %d does not exist in the set",
                     (int)item->field);
  sph_status status = sph_particles_field(set, item->field, &item->y);
  if (status != SPH_OK) return status;
  int64_t n = sph_particles_real_count(set) * components;
  if (n != item->n) it->memory.has_vector = 0;
  item->n = n;
  return SPH_OK;
}

static sph_status find_fields(sph_integrator *it, sph_particles *set) {
  for (int32_t k = 0; k < it->items; ++k) {
    if (it->item[k].field < 0) continue;
    sph_status status = find_field(it, set, &it->item[k]);
    if (status != SPH_OK) return status;
  }
  return SPH_OK;
}

/* Offsets at multiples of 64 bytes. An eigenvector kept from another layout is worthless. */
static void lay_out(sph_integrator *it) {
  int64_t offset = 0;
  for (int32_t k = 0; k < it->items; ++k) {
    sphi_item *item = &it->item[k];
    if (item->offset != offset) it->memory.has_vector = 0;
    item->offset = offset;
    offset += (item->n + 7) / 8 * 8;
  }
  if (it->stride != offset) it->memory.has_vector = 0;
  it->stride = offset;
}

static sph_status reserve_vectors(sph_integrator *it) {
  size_t doubles = sphi_mul((size_t)it->stride, (size_t)sphi_vector_count(it));
  size_t bytes = sphi_mul(doubles, sizeof(double));
  if (bytes > it->vectors.bytes) it->memory.has_vector = 0;
  return sphi_buffer_reserve(it->base.ctx, &it->vectors, bytes);
}

static sph_status remember_ids(sph_integrator *it, sph_particles *set) {
  if (it->fields == 0) return SPH_OK;
  size_t bytes = sphi_mul((size_t)it->real_count, sizeof(int64_t));
  sph_status status = sphi_buffer_reserve(it->base.ctx, &it->ids, bytes);
  if (status == SPH_OK && bytes > 0) memcpy(it->ids.ptr, sph_particles_ids(set), bytes);
  return status;
}

sph_status sphi_state_layout(sph_integrator *it, sph_particles *set) {
  sph_status status = find_fields(it, set);
  if (status != SPH_OK) return status;
  lay_out(it);
  it->real_count = sph_particles_real_count(set);
  it->generation = sph_particles_generation(set);
  status = reserve_vectors(it);
  if (status == SPH_OK) status = remember_ids(it, set);
  return status == SPH_OK ? sphi_history_follow(it, set) : status;
}

/* ---- particles that change during a step ------------------------------------------------- */

static int32_t same_ids(const sph_integrator *it, const sph_particles *set) {
  if (sph_particles_real_count(set) < it->real_count) return 0;
  size_t bytes = (size_t)it->real_count * sizeof(int64_t);
  return bytes == 0 || memcmp(it->ids.ptr, sph_particles_ids(set), bytes) == 0;
}

/* The pieces lose their place: nothing is written to particles that are not the old ones. */
static void forget_fields(sph_integrator *it) {
  for (int32_t k = 0; k < it->items; ++k)
    if (it->item[k].field >= 0) it->item[k].n = 0;
}

/* Arrays may have moved; lengths stay those of the begin of the step. */
static void refind_fields(sph_integrator *it, sph_particles *set) {
  for (int32_t k = 0; k < it->items; ++k)
    if (it->item[k].field >= 0) (void)sph_particles_field(set, it->item[k].field, &it->item[k].y);
}

sph_status sphi_state_follow(sph_integrator *it, sph_particles *set) {
  if (it->fields == 0) return SPH_OK;
  uint64_t generation = sph_particles_generation(set);
  if (generation == it->generation) return SPH_OK;
  it->generation = generation;
  int32_t same = same_ids(it, set);
  if (same)
    refind_fields(it, set);
  else
    forget_fields(it);
  if (same && sph_particles_real_count(set) == it->real_count) return SPH_OK;
  return sphi_fail(it->base.ctx, SPH_ERR_STATE,
                   "the right-hand side changed the real particles (%lld before, %lld now); "
                   "only ghosts may come and go during a step",
                   (long long)it->real_count, (long long)sph_particles_real_count(set));
}

const sphi_item *sphi_item_of(const sph_integrator *it, int32_t field) {
  for (int32_t k = 0; k < it->items; ++k)
    if (it->item[k].field == field) return &it->item[k];
  return NULL;
}

void sphi_state_touch(const sph_integrator *it, sph_particles *set) {
  for (int32_t k = 0; k < it->items; ++k)
    if (it->item[k].field >= 0) (void)sph_particles_touch(set, it->item[k].field);
}

/* ---- copies and linear combinations ------------------------------------------------------ */

static const double *piece(const sphi_item *item, const double *vector) {
  return vector ? vector + item->offset : item->y;
}

typedef struct copy_job {
  double *to;
  const double *from;
} copy_job;

static void copy_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  copy_job *c = job;
  (void)worker;
  memcpy(c->to + begin, c->from + begin, (size_t)(end - begin) * sizeof(double));
}

void sphi_state_copy(sph_integrator *it, double *to, const double *from) {
  for (int32_t k = 0; k < it->items; ++k) {
    sphi_item *item = &it->item[k];
    copy_job job = {to ? to + item->offset : item->y, piece(item, from)};
    if (item->n > 0) sphi_parallel(it->base.ctx, item->n, SPHI_STATE_GRAIN, copy_range, &job);
  }
}

void sphi_combination_add(sphi_combination *c, double factor, const double *vector) {
  if (factor == 0.0) return;
  c->factor[c->count] = factor;
  c->vector[c->count] = vector;
  c->count += 1;
}

enum { COMBINE_BLOCK = 256 };

typedef struct combine_job {
  double *out;
  int32_t count;
  const double *factor;
  const double *piece[SPHI_TERMS_MAX];
} combine_job;

/* The sum is complete before the block is stored: out may be one of the terms. */
static void combine_block(const combine_job *c, int64_t begin, int64_t n) {
  double sum[COMBINE_BLOCK] = {0.0};
  for (int32_t m = 0; m < c->count; ++m) {
    const double *v = c->piece[m] + begin;
    double factor = c->factor[m];
    for (int64_t i = 0; i < n; ++i) sum[i] += factor * v[i];
  }
  memcpy(c->out + begin, sum, (size_t)n * sizeof(double));
}

static void combine_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  (void)worker;
  for (int64_t i = begin; i < end; i += COMBINE_BLOCK)
    combine_block(job, i, end - i < COMBINE_BLOCK ? end - i : COMBINE_BLOCK);
}

void sphi_state_combine(sph_integrator *it, double *out, const sphi_combination *c) {
  for (int32_t k = 0; k < it->items; ++k) {
    sphi_item *item = &it->item[k];
    combine_job job = {out ? out + item->offset : item->y, c->count, c->factor, {NULL}};
    for (int32_t m = 0; m < c->count; ++m) job.piece[m] = piece(item, c->vector[m]);
    if (item->n > 0) sphi_parallel(it->base.ctx, item->n, SPHI_STATE_GRAIN, combine_range, &job);
  }
}

/* ---- reductions -------------------------------------------------------------------------- */

typedef struct reduce_job {
  int64_t n;
  sphi_reduce_fn fn;
  void *job;
  double part[SPHI_REDUCE_CHUNKS][4];
} reduce_job;

static void reduce_chunks(void *job, int64_t begin, int64_t end, int32_t worker) {
  reduce_job *r = job;
  int64_t size = (r->n + SPHI_REDUCE_CHUNKS - 1) / SPHI_REDUCE_CHUNKS;
  (void)worker;
  for (int64_t chunk = begin; chunk < end; ++chunk) {
    int64_t from = chunk * size;
    int64_t to = from + size < r->n ? from + size : r->n;
    if (from < to) r->fn(r->job, from, to, r->part[chunk]);
  }
}

void sphi_reduce(sph_context *ctx, int64_t n, sphi_reduce_fn fn, void *job, double out[4]) {
  reduce_job r = {n, fn, job, {{0.0}}};
  int64_t grain = n < SPHI_STATE_GRAIN ? SPHI_REDUCE_CHUNKS : 1;
  if (n > 0) sphi_parallel(ctx, SPHI_REDUCE_CHUNKS, grain, reduce_chunks, &r);
  for (int32_t m = 0; m < 4; ++m) out[m] = 0.0;
  for (int32_t chunk = 0; chunk < SPHI_REDUCE_CHUNKS; ++chunk) {
    for (int32_t m = 0; m < 3; ++m) out[m] += r.part[chunk][m];
    if (r.part[chunk][3] > out[3]) out[3] = r.part[chunk][3];
  }
}

/* NaN compares false with everything, hence the detour over infinity. */
static void max_range(void *job, int64_t begin, int64_t end, double out[4]) {
  const double *v = *(const double **)job;
  double largest = 0.0;
  for (int64_t i = begin; i < end; ++i) {
    double size = isfinite(v[i]) ? fabs(v[i]) : INFINITY;
    if (size > largest) largest = size;
  }
  out[3] = largest;
}

double sphi_state_max(sph_integrator *it, int32_t k, const double *vector) {
  const double *v = piece(&it->item[k], vector);
  double out[4];
  sphi_reduce(it->base.ctx, it->item[k].n, max_range, &v, out);
  return out[3];
}

typedef struct finite_job {
  const double *y;
  int64_t first;
} finite_job;

static void finite_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  finite_job *f = job;
  (void)worker;
  for (int64_t i = begin; i < end; ++i)
    if (!isfinite(f->y[i])) {
      sphi_lowest(&f->first, i);
      return;
    }
}

static sph_status not_finite(sph_integrator *it, const sph_particles *set, const sphi_item *item,
                             int64_t i) {
  sph_context *ctx = it->base.ctx;
  if (item->field < 0)
    return sphi_fail(ctx, SPH_ERR_NUMERIC, "bound array %d, entry %lld became %g in the step",
                     (int)(-1 - item->field), (long long)i, item->y[i]);
  int32_t components = sph_particles_components(set, item->field);
  return sphi_fail(ctx, SPH_ERR_NUMERIC,
                   "field \"%s\" of particle %lld, component %lld, became %g in the step",
                   sphi_field_name(set, item->field), (long long)(i / components),
                   (long long)(i % components), item->y[i]);
}

sph_status sphi_state_check_finite(sph_integrator *it, const sph_particles *set) {
  for (int32_t k = 0; k < it->items; ++k) {
    sphi_item *item = &it->item[k];
    finite_job job = {item->y, INT64_MAX};
    if (item->n > 0) sphi_parallel(it->base.ctx, item->n, SPHI_STATE_GRAIN, finite_range, &job);
    if (job.first != INT64_MAX) return not_finite(it, set, item, job.first);
  }
  return SPH_OK;
}
