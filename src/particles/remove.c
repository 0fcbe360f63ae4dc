/* Removal of particles: mark in a bitmap, then close the gaps of each array in one pass. */
#include "set.h"

#include <string.h>

static int marked(const uint64_t *marks, int64_t i) { return (int)(marks[i >> 6] >> (i & 63)) & 1; }

/* SPH_OK, or the sentence for the first index that is out of range or comes twice. */
static sph_status mark_all(sph_particles *set, uint64_t *marks, int64_t n, const int64_t *indices) {
  for (int64_t k = 0; k < n; k++) {
    int64_t i = indices[k];
    if (i < 0 || i >= set->count)
      return sphi_fail(set->object.ctx, SPH_ERR_ARG,
                       "remove: indices[%lld] = %lld is outside 0..%lld", (long long)k,
                       (long long)i, (long long)set->count - 1);
    if (marked(marks, i))
      return sphi_fail(set->object.ctx, SPH_ERR_ARG, "remove: indices[%lld] = %lld comes twice",
                       (long long)k, (long long)i);
    marks[i >> 6] |= UINT64_C(1) << (i & 63);
  }
  return SPH_OK;
}

/* First index from i on whose mark equals `wanted`; `count` when there is none. Whole words
 * that cannot hold one are skipped. */
static int64_t next_with(const uint64_t *marks, int64_t i, int64_t count, int wanted) {
  const uint64_t dull = wanted ? 0 : ~UINT64_C(0);
  while (i < count) {
    if ((i & 63) == 0 && marks[i >> 6] == dull)
      i += 64;
    else if (marked(marks, i) == wanted)
      return i;
    else
      i++;
  }
  return count;
}

static void close_gaps(sphi_column c, const uint64_t *marks, int64_t count) {
  char *data = c.data;
  int64_t to = next_with(marks, 0, count, 1), from = to;
  while (from < count) {
    int64_t begin = next_with(marks, from, count, 0);
    int64_t end = next_with(marks, begin, count, 1);
    memmove(data + (size_t)to * c.stride, data + (size_t)begin * c.stride,
            (size_t)(end - begin) * c.stride);
    to += end - begin;
    from = end;
  }
}

static int64_t marked_below(const uint64_t *marks, int64_t end) {
  int64_t n = 0;
  for (int64_t i = next_with(marks, 0, end, 1); i < end; i = next_with(marks, i + 1, end, 1)) n++;
  return n;
}

static void remove_marked(sph_particles *set, const uint64_t *marks, int64_t n) {
  sphi_column columns[SPHI_MAX_COLUMNS];
  int32_t arrays = sphi_set_columns(set, columns);
  for (int32_t a = 0; a < arrays; a++) close_gaps(columns[a], marks, set->count);
  set->real_count -= marked_below(marks, set->real_count);
  set->count -= n;
  set->generation++;
  sphi_set_touch_all(set);
}

static sph_status check_remove(const sph_particles *set, int64_t n, const int64_t *indices) {
  sph_status status = sphi_set_check(set);
  if (status != SPH_OK) return status;
  if (n < 0)
    return sphi_fail(set->object.ctx, SPH_ERR_ARG, "remove: n = %lld is negative", (long long)n);
  if (n > 0 && indices == NULL)
    return sphi_fail(set->object.ctx, SPH_ERR_ARG, "remove: indices is NULL");
  return SPH_OK;
}

sph_status sph_particles_remove(sph_particles *set, int64_t n, const int64_t *indices) {
  sph_status status = check_remove(set, n, indices);
  if (status != SPH_OK || n == 0) return status;
  size_t bytes = ((size_t)set->count / 64 + 1) * sizeof(uint64_t);
  status = sphi_buffer_reserve(set->object.ctx, &set->marks, bytes);
  if (status != SPH_OK) return status;
  uint64_t *marks = set->marks.ptr;
  memset(marks, 0, bytes);
  status = mark_all(set, marks, n, indices);
  if (status == SPH_OK) remove_marked(set, marks, n);
  return status;
}
