/* Spatial sort: one stable radix sort per axis, x first, so that the last axis weighs most and
 * ties keep the order of their indices.
 *
 * Cell coordinates are 64-bit numbers, clamped, and counted from the lowest one present: a
 * particle at 1e300 costs more passes, never an overflow or memory. */
#include "set.h"

#include <math.h>
#include <string.h>

enum { DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS };

typedef struct entry {
  uint64_t key;
  int64_t index;
} entry;

typedef struct sort_job {
  sph_particles *set;
  const double *x;
  double cell;
  int64_t n;
  entry *now, *next; /* sorted so far, and room for the next pass */
  size_t bytes;      /* of each of the two */
  int64_t bad;       /* first particle whose position is not finite */
} sort_job;

static void check_finite(void *user, int64_t begin, int64_t end, int32_t worker) {
  sort_job *job = user;
  int32_t dim = job->set->dim;
  (void)worker;
  for (int64_t k = begin * dim; k < end * dim; k++) {
    if (isfinite(job->x[k])) continue;
    sphi_lowest(&job->bad, k / dim);
    return;
  }
}

/* floor(x / cell) as an order-preserving unsigned number. The quotient may be infinite; beyond
 * 2^62 cells all positions count as one cell. */
static uint64_t cell_key(double x, double cell) {
  const double limit = 4611686018427387904.0; /* 2^62 */
  double c = floor(x / cell);
  if (c > limit) c = limit;
  if (c < -limit) c = -limit;
  return (uint64_t)(int64_t)c + (UINT64_C(1) << 62);
}

/* Write this axis' keys, counted from the lowest; returns the highest. */
static uint64_t make_keys(sort_job *job, int32_t axis) {
  int32_t dim = job->set->dim;
  uint64_t low = UINT64_MAX, high = 0;
  for (int64_t k = 0; k < job->n; k++) {
    uint64_t key = cell_key(job->x[job->now[k].index * dim + axis], job->cell);
    job->now[k].key = key;
    if (key < low) low = key;
    if (key > high) high = key;
  }
  for (int64_t k = 0; k < job->n; k++) job->now[k].key -= low;
  return high - low;
}

/* Stable counting sort by the digit at `shift`. */
static void sort_digit(sort_job *job, int32_t shift) {
  int64_t start[DIGITS] = {0};
  for (int64_t k = 0; k < job->n; k++) start[(job->now[k].key >> shift) & (DIGITS - 1)]++;
  int64_t sum = 0;
  for (int32_t d = 0; d < DIGITS; d++) {
    int64_t in_digit = start[d];
    start[d] = sum;
    sum += in_digit;
  }
  for (int64_t k = 0; k < job->n; k++)
    job->next[start[(job->now[k].key >> shift) & (DIGITS - 1)]++] = job->now[k];
  entry *swap = job->now;
  job->now = job->next;
  job->next = swap;
}

static void sort_entries(sort_job *job) {
  for (int64_t k = 0; k < job->n; k++) job->now[k].index = k;
  for (int32_t axis = 0; axis < job->set->dim; axis++) {
    uint64_t range = make_keys(job, axis);
    for (int32_t shift = 0; shift < 64 && (range >> shift) != 0; shift += DIGIT_BITS)
      sort_digit(job, shift);
  }
}

static int already_sorted(const sort_job *job) {
  for (int64_t k = 0; k < job->n; k++)
    if (job->now[k].index != k) return 0;
  return 1;
}

/* A slice of a column: `width` bytes at `offset` of each record. */
typedef struct gather_job {
  const entry *order;
  sphi_column column;
  size_t offset, width;
  char *scratch;
} gather_job;

static void gather(void *user, int64_t begin, int64_t end, int32_t worker) {
  const gather_job *job = user;
  const char *data = (const char *)job->column.data + job->offset;
  (void)worker;
  for (int64_t k = begin; k < end; k++)
    memcpy(job->scratch + (size_t)k * job->width,
           data + (size_t)job->order[k].index * job->column.stride, job->width);
}

static void put_back(void *user, int64_t begin, int64_t end, int32_t worker) {
  const gather_job *job = user;
  char *data = (char *)job->column.data + job->offset;
  (void)worker;
  for (int64_t k = begin; k < end; k++)
    memcpy(data + (size_t)k * job->column.stride, job->scratch + (size_t)k * job->width,
           job->width);
}

/* Bring every array into the new order, in slices that fit the room of the sort's second half.
 * Arrays keep their addresses, so they are copied back, not exchanged. */
static void permute_columns(sort_job *job) {
  sphi_column columns[SPHI_MAX_COLUMNS];
  int32_t arrays = sphi_set_columns(job->set, columns);
  for (int32_t a = 0; a < arrays; a++) {
    gather_job g = {job->now, columns[a], 0, 0, (char *)job->next};
    for (g.offset = 0; g.offset < g.column.stride; g.offset += g.width) {
      size_t left = g.column.stride - g.offset;
      g.width = left < sizeof(entry) ? left : sizeof(entry);
      sphi_parallel(job->set->object.ctx, job->n, 16384, gather, &g);
      sphi_parallel(job->set->object.ctx, job->n, 16384, put_back, &g);
    }
  }
}

static sph_status alloc_job(sort_job *job) {
  sph_context *ctx = job->set->object.ctx;
  job->bytes = sphi_mul((size_t)job->n, sizeof(entry));
  job->now = sphi_alloc(ctx, job->bytes);
  if (job->now == NULL) return SPH_ERR_NOMEM;
  job->next = sphi_alloc(ctx, job->bytes);
  return job->next != NULL ? SPH_OK : SPH_ERR_NOMEM;
}

static void free_job(sort_job *job) {
  sphi_free(job->set->object.ctx, job->now, job->bytes);
  sphi_free(job->set->object.ctx, job->next, job->bytes);
}

static sph_status check_sort(sort_job *job) {
  sph_context *ctx = job->set->object.ctx;
  if (!(job->cell > 0) || !isfinite(job->cell))
    return sphi_fail(ctx, SPH_ERR_ARG, "sort: cell = %g is not positive and finite", job->cell);
  if (job->set->count != job->set->real_count)
    return sphi_fail(ctx, SPH_ERR_STATE, "sort: the set holds %lld ghosts; clear them first",
                     (long long)(job->set->count - job->set->real_count));
  sphi_parallel(ctx, job->n, 65536, check_finite, job);
  if (job->bad < job->n)
    return sphi_fail(ctx, SPH_ERR_ARG, "sort: the position of particle %lld is not finite",
                     (long long)job->bad);
  return SPH_OK;
}

static void finish_sort(sort_job *job, int64_t *permutation) {
  for (int64_t k = 0; permutation != NULL && k < job->n; k++) permutation[k] = job->now[k].index;
  if (already_sorted(job)) return;
  permute_columns(job);
  job->set->generation++;
  sphi_set_touch_all(job->set);
}

sph_status sph_particles_sort(sph_particles *set, double cell, int64_t *permutation) {
  sph_status status = sphi_set_check(set);
  if (status != SPH_OK) return status;
  sort_job job = {.set = set,
                  .x = set->fields[SPH_FIELD_X].values,
                  .cell = cell,
                  .n = set->real_count,
                  .bad = INT64_MAX};
  status = check_sort(&job);
  if (status != SPH_OK) return status;
  status = alloc_job(&job);
  if (status == SPH_OK) {
    sort_entries(&job);
    finish_sort(&job, permutation);
  }
  free_job(&job);
  return status;
}
