/* The pairs in the host's order, and queries at points. */
#include "search.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { GRAIN = 256, SMALL = 16, PIECES = 64 /* of the prefix sum */ };

typedef struct rows_job {
  const sph_neighbors *list;
  int64_t *offsets;
  int32_t *indices;
  int64_t piece[PIECES + 1];
} rows_job;

/* --- rows --- */

/* At the present positions, without the skin. */
static int is_near(const sph_neighbors *list, int64_t i, int64_t j) {
  const sphi_layout *l = &list->priv->layout[0];
  const double *const x[3] = {list->priv->now[0], list->priv->now[1], list->priv->now[2]};
  double cut = l->rule.support * l->h_uniform;
  if (!l->rule.uniform) cut = sphi_reach(&l->rule, l->s[i], l->s[j]);
  return sphi_distance2(&l->rule, x, i, j) < cut * cut;
}

static int is_filtered(const sph_neighbors *list) { return list->priv->layout[0].rule.skin > 0.0; }

static void count_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  rows_job *r = job;
  const sph_neighbors *list = r->list;
  int filtered = is_filtered(list);
  (void)worker;
  for (int64_t k = begin; k < end; k++) {
    int64_t count = list->start[k + 1] - list->start[k];
    if (filtered) count = 0;
    for (int64_t p = list->start[k]; filtered && p < list->start[k + 1]; p++)
      count += is_near(list, k, list->pair[p]);
    r->offsets[list->order[k] + 1] = count;
  }
}

static int64_t piece_begin(const rows_job *r, int64_t piece) { return r->list->n * piece / PIECES; }

static void piece_sums(void *job, int64_t begin, int64_t end, int32_t worker) {
  rows_job *r = job;
  (void)worker;
  for (int64_t p = begin; p < end; p++) {
    int64_t sum = 0;
    for (int64_t i = piece_begin(r, p); i < piece_begin(r, p + 1); i++) sum += r->offsets[i + 1];
    r->piece[p + 1] = sum;
  }
}

static void piece_offsets(void *job, int64_t begin, int64_t end, int32_t worker) {
  rows_job *r = job;
  (void)worker;
  for (int64_t p = begin; p < end; p++) {
    int64_t sum = r->piece[p];
    for (int64_t i = piece_begin(r, p); i < piece_begin(r, p + 1); i++)
      r->offsets[i + 1] = sum += r->offsets[i + 1];
  }
}

/* offsets[i + 1], so far the length of row i, becomes where it ends. */
static void sum_lengths(sph_context *ctx, rows_job *r) {
  int64_t grain = r->list->n > PIECES * GRAIN ? 1 : PIECES;
  sphi_parallel(ctx, PIECES, grain, piece_sums, r);
  r->offsets[0] = r->piece[0] = 0;
  for (int p = 0; p < PIECES; p++) r->piece[p + 1] += r->piece[p];
  sphi_parallel(ctx, PIECES, grain, piece_offsets, r);
}

static void insertion_sort(int32_t *v, int64_t n) {
  for (int64_t i = 1; i < n; i++) {
    int32_t x = v[i];
    int64_t k = i;
    for (; k > 0 && v[k - 1] > x; k--) v[k] = v[k - 1];
    v[k] = x;
  }
}

static void sift_down(int32_t *v, int64_t at, int64_t n) {
  int32_t x = v[at];
  for (int64_t child; (child = 2 * at + 1) < n; at = child) {
    if (child + 1 < n && v[child + 1] > v[child]) child++;
    if (v[child] <= x) break;
    v[at] = v[child];
  }
  v[at] = x;
}

static void heap_sort(int32_t *v, int64_t n) {
  for (int64_t i = n / 2; i-- > 0;) sift_down(v, i, n);
  for (int64_t last = n - 1; last > 0; last--) {
    int32_t x = v[0];
    v[0] = v[last];
    v[last] = x;
    sift_down(v, 0, last);
  }
}

static int32_t middle_of(int32_t a, int32_t b, int32_t c) {
  int32_t lo = a < b ? a : b, hi = a < b ? b : a;
  return c < lo ? lo : c > hi ? hi : c;
}

/* Quicksort that turns to heapsort when it goes too deep. No equal entries. */
static void sort_indices(int32_t *v, int64_t n, int depth) {
  while (n > SMALL) {
    if (depth-- == 0) {
      heap_sort(v, n);
      return;
    }
    int32_t pivot = middle_of(v[0], v[n / 2], v[n - 1]);
    int64_t i = -1, j = n;
    for (;;) {
      do i++;
      while (v[i] < pivot);
      do j--;
      while (v[j] > pivot);
      if (i >= j) break;
      int32_t x = v[i];
      v[i] = v[j];
      v[j] = x;
    }
    sort_indices(v, j + 1, depth);
    v += j + 1;
    n -= j + 1;
  }
  insertion_sort(v, n);
}

static void rows_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  rows_job *r = job;
  const sph_neighbors *list = r->list;
  int filtered = is_filtered(list);
  (void)worker;
  for (int64_t k = begin; k < end; k++) {
    int32_t *row = r->indices + r->offsets[list->order[k]];
    int64_t count = 0;
    for (int64_t p = list->start[k]; p < list->start[k + 1]; p++) {
      if (filtered && !is_near(list, k, list->pair[p])) continue;
      row[count++] = (int32_t)list->order[list->pair[p]];
    }
    sort_indices(row, count, 48);
  }
}

static sph_status make_rows(sph_neighbors *list) {
  struct sphi_neighbors_private *p = list->priv;
  sph_context *ctx = list->base.ctx;
  size_t n = (size_t)list->n;
  sph_status s = sphi_buffer_reserve(ctx, &p->b_offsets, sphi_mul(n + 1, sizeof(int64_t)));
  if (s != SPH_OK) return s;
  rows_job job = {.list = list, .offsets = p->b_offsets.ptr};
  sphi_parallel(ctx, list->n, GRAIN, count_body, &job);
  sum_lengths(ctx, &job);
  s = sphi_buffer_reserve(ctx, &p->b_indices,
                          sphi_mul((size_t)job.offsets[n] + 1, sizeof(int32_t)));
  if (s != SPH_OK) return s;
  job.indices = p->b_indices.ptr;
  sphi_parallel(ctx, list->n, GRAIN, rows_body, &job);
  p->rows_valid = 1;
  return SPH_OK;
}

sph_status sph_neighbors_rows(sph_neighbors *list, const int64_t **offsets,
                              const int32_t **indices) {
  sph_status s = sphi_check_handle(NULL, list, SPHI_MAGIC_NEIGHBORS, "list");
  if (s != SPH_OK) return s;
  sph_context *ctx = list->base.ctx;
  if (offsets == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "offsets is NULL");
  if (indices == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "indices is NULL");
  if (list->builds == 0) return sphi_fail(ctx, SPH_ERR_STATE, "the neighbour list was never built");
  if (!list->priv->rows_valid) s = make_rows(list);
  if (s != SPH_OK) return s;
  *offsets = list->priv->b_offsets.ptr;
  *indices = list->priv->b_indices.ptr;
  return SPH_OK;
}

/* --- queries --- */

typedef struct query {
  const sph_neighbors *list;
  const double *point;
  double radius2;
  int64_t capacity, found;
  int32_t *indices; /* the lowest `capacity` so far: a heap when full */
} query;

static void keep_index(query *q, int32_t index) {
  int64_t at = q->found++;
  if (at < q->capacity) {
    q->indices[at] = index;
    if (at + 1 < q->capacity) return;
    for (int64_t i = q->capacity / 2; i-- > 0;) sift_down(q->indices, i, q->capacity);
  } else if (q->capacity > 0 && index < q->indices[0]) {
    q->indices[0] = index;
    sift_down(q->indices, 0, q->capacity);
  }
}

static void test_range(query *q, sphi_range r) {
  const sph_neighbors *list = q->list;
  const sphi_rule *rule = &list->priv->layout[0].rule;
  for (uint32_t k = r.begin; k < r.end; k++) {
    double sum = 0.0;
    for (int a = 0; a < rule->dim; a++) {
      double d = q->point[a] - list->priv->now[a][k];
      if (rule->period[a] > 0.0) d = sphi_wrap(d, rule->period[a], rule->inverse[a]);
      sum = a == 0 ? d * d : sum + d * d;
    }
    if (sum < q->radius2) keep_index(q, (int32_t)list->order[k]);
  }
}

/* First cell along an axis and how many, wrapping, that the sphere touches. */
static void span_of(const sphi_cells *c, const sphi_rule *rule, int axis, double x, double reach,
                    int *first, int *count) {
  *first = 0;
  *count = c->count[axis];
  if (axis >= rule->dim || *count == 1) return;
  if (rule->period[axis] > 0.0 && 2.0 * reach >= 0.999 * rule->period[axis]) return;
  *first = sphi_cells_index(c, axis, x - reach);
  int last = sphi_cells_index(c, axis, x + reach);
  if (rule->period[axis] > 0.0) {
    int n = (last - *first + c->count[axis]) % c->count[axis] + 1;
    if (last == *first && 2.0 * reach * c->wrap[axis] * c->count[axis] > 0.999)
      return; /* all around */
    *count = n;
  } else {
    *count = last - *first + 1;
  }
}

static void query_cells(query *q, double reach) {
  const sphi_layout *l = &q->list->priv->layout[0];
  const sphi_cells *c = &l->cells;
  int first[3], count[3];
  for (int a = 0; a < 3; a++) {
    double x = a < l->dim ? q->point[a] : 0.0;
    span_of(c, &l->rule, a, x, reach, &first[a], &count[a]);
    if (count[a] == c->count[a]) first[a] = 0;
  }
  for (int z = 0; z < count[2]; z++)
    for (int y = 0; y < count[1]; y++)
      for (int x = 0; x < count[0]; x++) {
        uint32_t id = c->table[0][(first[0] + x) % c->count[0]] +
                      c->table[1][(first[1] + y) % c->count[1]] +
                      c->table[2][(first[2] + z) % c->count[2]];
        test_range(q, (sphi_range){c->first[id], c->first[id + 1]});
      }
}

static void query_tree(query *q, double reach) {
  const sphi_layout *l = &q->list->priv->layout[0];
  const double zero[3] = {0.0, 0.0, 0.0};
  double at[3] = {0.0, 0.0, 0.0};
  sphi_range ranges[SPHI_MAX_RANGES];
  sphi_walk walk;
  int n;
  for (int a = 0; a < l->dim; a++) at[a] = q->point[a];
  sphi_boxes_fn near = sphi_search_of(q->list->base.ctx)->boxes;
  sphi_walk_begin(&walk, &l->tree, &l->rule, near, at, zero, 0.0, reach);
  while ((n = sphi_walk_ranges(&walk, ranges)) > 0)
    for (int k = 0; k < n; k++) test_range(q, ranges[k]);
}

int64_t sphi_neighbors_near(const sph_neighbors *list, const double *point, double radius,
                            int64_t capacity, int32_t *indices) {
  const sphi_layout *l = &list->priv->layout[0];
  query q = {list, point, radius * radius, capacity, 0, indices};
  double reach = (radius + list->priv->moved) * 1.000001; /* cells are those of the build */
  if (l->n == 0) return 0;
  if (l->method == SPH_NEIGHBORS_TREE)
    query_tree(&q, reach);
  else if (l->method == SPH_NEIGHBORS_ALL_PAIRS)
    test_range(&q, (sphi_range){0, (uint32_t)l->n});
  else
    query_cells(&q, reach);
  if (q.found >= capacity)
    heap_sort(indices, capacity);
  else
    sort_indices(indices, q.found, 48);
  return q.found;
}

static sph_status check_query(const sph_neighbors *list, const double *point, double radius,
                              int64_t capacity, const int32_t *indices, const int64_t *found) {
  sph_context *ctx = list->base.ctx;
  if (list->builds == 0) return sphi_fail(ctx, SPH_ERR_STATE, "the neighbour list was never built");
  if (point == NULL || found == NULL)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s is NULL", point == NULL ? "point" : "found");
  if (capacity < 0 || (capacity > 0 && indices == NULL))
    return sphi_fail(ctx, SPH_ERR_ARG, "capacity is %lld, indices is %s", (long long)capacity,
                     indices == NULL ? "NULL" : "given");
  if (!(radius > 0.0)) return sphi_fail(ctx, SPH_ERR_ARG, "radius is %g", radius);
  for (int a = 0; a < list->dim; a++)
    if (!(fabs(point[a]) <= DBL_MAX))
      return sphi_fail(ctx, SPH_ERR_ARG, "component %d of the point is %g", a, point[a]);
  return SPH_OK;
}

sph_status sph_neighbors_query(const sph_neighbors *list, const double *point, double radius,
                               int64_t capacity, int32_t *indices, int64_t *found) {
  sph_status s = sphi_check_handle(NULL, list, SPHI_MAGIC_NEIGHBORS, "list");
  if (s == SPH_OK) s = check_query(list, point, radius, capacity, indices, found);
  if (s != SPH_OK) return s;
  *found = sphi_neighbors_near(list, point, radius, capacity, indices);
  return SPH_OK;
}
