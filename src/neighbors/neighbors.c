/* Neighbour structures, plain version: one cell per axis at most, two passes (count, fill). */
#include "neighbors_impl.h"

#include "../particles/particles_impl.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct sphi_neighbors_private {
  size_t n_alloc, pair_alloc;
  double *x, *h; /* sweep order */
  int64_t *offsets;
  int32_t *rows;
  size_t rows_alloc;
  int32_t rows_valid;
  const sph_particles *set;
  uint64_t generation, rev_x, rev_h;
};

void sph_neighbors_options_init_sized(sph_neighbors_options *options, size_t size) {
  sph_neighbors_options d;
  memset(&d, 0, sizeof d);
  d.size = size;
  d.method = SPH_NEIGHBORS_CELLS;
  d.h_rule = SPH_H_ARITHMETIC;
  d.support = 2.0;
  if (options != NULL) memcpy(options, &d, size < sizeof d ? size : sizeof d);
}

sph_status sph_neighbors_create(sph_context *ctx, const sph_neighbors_options *options,
                                sph_neighbors **out) {
  sph_status s = sphi_check_handle(ctx, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (out != NULL) *out = NULL;
  if (s != SPH_OK) return s;
  if (out == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "out is NULL");
  sph_neighbors_options o;
  sph_neighbors_options_init(&o);
  s = sphi_options_read(ctx, &o, sizeof o, options);
  if (s != SPH_OK) return s;
  sph_neighbors *l = sphi_calloc(ctx, sizeof *l);
  struct sphi_neighbors_private *p = sphi_calloc(ctx, sizeof *p);
  if (l == NULL || p == NULL) {
    sphi_free(ctx, l, sizeof *l);
    sphi_free(ctx, p, sizeof *p);
    return SPH_ERR_NOMEM;
  }
  l->base.magic = SPHI_MAGIC_NEIGHBORS;
  l->base.ctx = ctx;
  sphi_context_retain(ctx);
  l->options = o;
  l->priv = p;
  for (int a = 0; a < 3; a++) l->period[a] = o.periodic[a] ? o.box_hi[a] - o.box_lo[a] : 0.0;
  *out = l;
  return SPH_OK;
}

static void free_rows(sph_neighbors *l) {
  struct sphi_neighbors_private *p = l->priv;
  sphi_free(l->base.ctx, p->offsets, ((size_t)l->n + 1) * 8);
  sphi_free(l->base.ctx, p->rows, p->rows_alloc * 4);
  p->offsets = NULL;
  p->rows = NULL;
}

static void free_all(sph_neighbors *l) {
  struct sphi_neighbors_private *p = l->priv;
  size_t n = p->n_alloc;
  sph_context *c = l->base.ctx;
  free_rows(l);
  sphi_free(c, l->order, n * 4);
  sphi_free(c, l->start, (n + 1) * 8);
  sphi_free(c, l->pair, p->pair_alloc * 4);
  sphi_free(c, p->x, n * 24);
  sphi_free(c, p->h, n * 8);
}

void sph_neighbors_destroy(sph_neighbors *list) {
  if (list == NULL || list->base.magic != SPHI_MAGIC_NEIGHBORS) return;
  sph_context *c = list->base.ctx;
  free_all(list);
  sphi_free(c, list->priv, sizeof *list->priv);
  list->base.magic = 0;
  sphi_free(c, list, sizeof *list);
  sphi_context_release(c);
}

static double pair_cutoff(const sph_neighbors *l, double a, double b) {
  double h = 0.5 * (a + b);
  if (l->options.h_rule == SPH_H_HARMONIC) h = 2.0 / (1.0 / a + 1.0 / b);
  if (l->options.h_rule == SPH_H_MAX || l->options.h_rule == SPH_H_AVERAGE) h = a > b ? a : b;
  if (l->options.h_rule == SPH_H_MIN) h = a < b ? a : b;
  return l->options.support * (a == b ? a : h) + (l->options.method == SPH_NEIGHBORS_VERLET ? l->options.skin : 0);
}

static int is_pair(const sph_neighbors *l, int64_t i, int64_t j) {
  double r2 = 0.0;
  const struct sphi_neighbors_private *p = l->priv;
  for (int a = 0; a < l->dim; a++) {
    double d = p->x[i * 3 + a] - p->x[j * 3 + a];
    if (l->period[a] > 0) d -= l->period[a] * rint(d / l->period[a]);
    r2 += d * d;
  }
  double c = pair_cutoff(l, p->h[i], p->h[j]);
  return i != j && r2 < c * c;
}

typedef struct { int64_t key[3]; uint32_t i; } item;

static int compare_items(const void *a, const void *b) {
  const item *p = a, *q = b;
  for (int k = 2; k >= 0; k--)
    if (p->key[k] != q->key[k]) return p->key[k] < q->key[k] ? -1 : 1;
  return p->i < q->i ? -1 : 1;
}

/* rows of equal (y, z) cell are found by binary search over the sorted keys */
static int64_t lower(const item *t, int64_t n, const int64_t key[3]) {
  int64_t lo = 0, hi = n;
  while (lo < hi) {
    int64_t m = (lo + hi) / 2;
    int less = 0;
    for (int k = 2; k >= 0; k--)
      if (t[m].key[k] != key[k]) { less = t[m].key[k] < key[k]; break; }
    if (less) lo = m + 1; else hi = m;
  }
  return lo;
}

static int by_u32(const void *a, const void *b) {
  uint32_t p = *(const uint32_t *)a, q = *(const uint32_t *)b;
  return p < q ? -1 : p > q;
}

static sph_status find(sph_neighbors *l, const item *t, const int64_t nc[3]) {
  int64_t n = l->n, used = 0;
  size_t cap = (size_t)n * 40 + 64;
  uint32_t *pair = malloc(cap * 4);
  if (pair == NULL) return SPH_ERR_NOMEM;
  int any_periodic = l->period[0] > 0 || l->period[1] > 0 || l->period[2] > 0;
  int64_t prev[3] = {INT64_MIN, 0, 0};
  int64_t rb[9], re[9];
  for (int64_t i = 0; i < n; i++) {
    l->start[i] = used;
    int nr = 0;
    if (memcmp(prev, t[i].key, sizeof prev) != 0) {
      memcpy(prev, t[i].key, sizeof prev);
      for (int q = 0; q < 9; q++) {
        int64_t k0[3] = {t[i].key[0] - 1, t[i].key[1] + q % 3 - 1, t[i].key[2] + q / 3 - 1}, k1[3];
        memcpy(k1, k0, sizeof k0);
        k1[0] += 3;
        rb[q] = lower(t, n, k0);
        re[q] = lower(t, n, k1);
      }
    }
    nr = 9;
    int64_t b0 = 0, e0 = n;
    for (int q = 0; q < (any_periodic ? 1 : nr); q++) {
      int64_t b = any_periodic ? b0 : rb[q], e = any_periodic ? e0 : re[q];
      for (int64_t j = b; j < e; j++) {
        if (!is_pair(l, i, j)) continue;
        if ((size_t)used + 32 > cap) {
          cap *= 2;
          uint32_t *g = realloc(pair, cap * 4);
          if (g == NULL) { free(pair); return SPH_ERR_NOMEM; }
          pair = g;
        }
        pair[used++] = (uint32_t)j;
      }
    }
    qsort(pair + l->start[i], (size_t)(used - l->start[i]), 4, by_u32);
  }
  l->start[n] = used;
  (void)nc;
  l->pair = sphi_calloc(l->base.ctx, ((size_t)used + SPHI_ROW_PADDING) * 4);
  l->priv->pair_alloc = (size_t)used + SPHI_ROW_PADDING;
  if (l->pair) memcpy(l->pair, pair, (size_t)used * 4);
  free(pair);
  return l->pair ? SPH_OK : SPH_ERR_NOMEM;
}

sph_status sph_neighbors_build_arrays(sph_neighbors *l, int32_t dim, int64_t n, const double *x,
                                      const double *h, double h0) {
  sph_status s = sphi_check_handle(NULL, l, SPHI_MAGIC_NEIGHBORS, "list");
  if (s != SPH_OK) return s;
  sph_context *c = l->base.ctx;
  if (dim < 1 || dim > 3 || n < 0) return sphi_fail(c, SPH_ERR_ARG, "dim or n");
  if (n > 0 && x == NULL) return sphi_fail(c, SPH_ERR_ARG, "x is NULL");
  double hmax = 0, hmin = INFINITY;
  for (int64_t i = 0; i < n; i++) {
    double hi = h ? h[i] : h0;
    if (!(hi > 0) || !isfinite(hi)) return sphi_fail(c, SPH_ERR_ARG, "h of particle %lld is %g", (long long)i, hi);
    for (int a = 0; a < dim; a++)
      if (!isfinite(x[i * dim + a])) return sphi_fail(c, SPH_ERR_ARG, "position %d of particle %lld is %g", a, (long long)i, x[i * dim + a]);
    if (hi > hmax) hmax = hi;
    if (hi < hmin) hmin = hi;
  }
  free_all(l);
  l->dim = dim;
  l->n = n;
  l->h_max = hmax;
  l->h_uniform = hmax == hmin ? hmax : 0;
  size_t m = (size_t)n;
  l->priv->n_alloc = m;
  l->order = sphi_alloc(c, m * 4);
  l->start = sphi_alloc(c, (m + 1) * 8);
  l->priv->x = sphi_calloc(c, m * 24);
  l->priv->h = sphi_alloc(c, m * 8);
  l->priv->rows_valid = 0;
  item *t = malloc((m + 1) * sizeof *t);
  double edge = pair_cutoff(l, hmax, hmax) * 1.000001;
  for (int64_t i = 0; i < n; i++) {
    memset(&t[i], 0, sizeof t[i]);
    t[i].i = (uint32_t)i;
    for (int a = 0; a < dim; a++) t[i].key[a] = (int64_t)fmax(-1e15, fmin(1e15, floor(x[i * dim + a] / edge)));
  }
  qsort(t, m, sizeof *t, compare_items);
  for (int64_t k = 0; k < n; k++) {
    l->order[k] = t[k].i;
    for (int a = 0; a < dim; a++) l->priv->x[k * 3 + a] = x[(int64_t)t[k].i * dim + a];
    l->priv->h[k] = h ? h[t[k].i] : h0;
  }
  int64_t nc[3] = {0, 0, 0};
  s = find(l, t, nc);
  free(t);
  l->builds++;
  return s;
}

sph_status sph_neighbors_build(sph_neighbors *l, const sph_particles *set) {
  sph_status s = sphi_check_handle(NULL, l, SPHI_MAGIC_NEIGHBORS, "list");
  if (s == SPH_OK) s = sphi_check_handle(l->base.ctx, set, SPHI_MAGIC_PARTICLES, "set");
  if (s != SPH_OK) return s;
  const double *h = sph_particles_field_const(set, SPH_FIELD_H);
  int64_t n = sph_particles_count(set);
  if (h == NULL && n > 0) return sphi_fail(l->base.ctx, SPH_ERR_ARG, "the set has no field h");
  s = sph_neighbors_build_arrays(l, sph_particles_dim(set), n,
                                 sph_particles_field_const(set, SPH_FIELD_X), h, 1.0);
  if (s != SPH_OK) return s;
  l->priv->set = set;
  l->priv->generation = sph_particles_generation(set);
  l->priv->rev_x = sph_particles_revision(set, SPH_FIELD_X);
  l->priv->rev_h = sph_particles_revision(set, SPH_FIELD_H);
  return s;
}

sph_status sph_neighbors_update(sph_neighbors *l, const sph_particles *set, int32_t *rebuilt) {
  sph_status s = sphi_check_handle(NULL, l, SPHI_MAGIC_NEIGHBORS, "list");
  if (s == SPH_OK) s = sphi_check_handle(l->base.ctx, set, SPHI_MAGIC_PARTICLES, "set");
  if (s != SPH_OK) return s;
  int same = l->builds > 0 && l->priv->set == set &&
             l->priv->generation == sph_particles_generation(set) &&
             l->priv->rev_x == sph_particles_revision(set, SPH_FIELD_X) &&
             l->priv->rev_h == sph_particles_revision(set, SPH_FIELD_H);
  if (rebuilt) *rebuilt = !same;
  return same ? SPH_OK : sph_neighbors_build(l, set);
}

sph_status sph_neighbors_update_arrays(sph_neighbors *l, int32_t dim, int64_t n, const double *x,
                                       const double *h, double h0, int32_t *rebuilt) {
  if (rebuilt) *rebuilt = 1;
  return sph_neighbors_build_arrays(l, dim, n, x, h, h0);
}

int64_t sph_neighbors_count(const sph_neighbors *l) { return l ? l->n : -1; }
int64_t sph_neighbors_pairs(const sph_neighbors *l) { return l ? (l->builds ? l->start[l->n] : 0) : -1; }
int64_t sph_neighbors_builds(const sph_neighbors *l) { return l ? l->builds : -1; }

sph_status sph_neighbors_rows(sph_neighbors *l, const int64_t **offsets, const int32_t **indices) {
  sph_status s = sphi_check_handle(NULL, l, SPHI_MAGIC_NEIGHBORS, "list");
  if (s != SPH_OK) return s;
  if (l->builds == 0) return sphi_fail(l->base.ctx, SPH_ERR_STATE, "never built");
  struct sphi_neighbors_private *p = l->priv;
  if (!p->rows_valid) {
    free_rows(l);
    p->offsets = sphi_calloc(l->base.ctx, ((size_t)l->n + 1) * 8);
    p->rows_alloc = (size_t)l->start[l->n];
    p->rows = sphi_alloc(l->base.ctx, p->rows_alloc * 4);
    if (!p->offsets || !p->rows) return SPH_ERR_NOMEM;
    for (int64_t k = 0; k < l->n; k++) p->offsets[l->order[k] + 1] = l->start[k + 1] - l->start[k];
    for (int64_t i = 0; i < l->n; i++) p->offsets[i + 1] += p->offsets[i];
    for (int64_t k = 0; k < l->n; k++) {
      int64_t o = p->offsets[l->order[k]];
      for (int64_t q = l->start[k]; q < l->start[k + 1]; q++) p->rows[o + q - l->start[k]] = (int32_t)l->order[l->pair[q]];
      qsort(p->rows + o, (size_t)(l->start[k + 1] - l->start[k]), 4, by_u32);
    }
    p->rows_valid = 1;
  }
  if (offsets) *offsets = p->offsets;
  if (indices) *indices = p->rows;
  return SPH_OK;
}

int64_t sphi_neighbors_near(const sph_neighbors *l, const double *point, double radius,
                            int64_t capacity, int32_t *indices) {
  int64_t found = 0;
  for (int64_t k = 0; k < l->n; k++) {
    double r2 = 0;
    for (int a = 0; a < l->dim; a++) {
      double d = point[a] - l->priv->x[k * 3 + a];
      if (l->period[a] > 0) d -= l->period[a] * rint(d / l->period[a]);
      r2 += d * d;
    }
    if (r2 < radius * radius) {
      if (found < capacity) indices[found] = (int32_t)l->order[k];
      found++;
    }
  }
  if (found <= capacity) qsort(indices, (size_t)found, 4, by_u32);
  return found;
}

sph_status sph_neighbors_query(const sph_neighbors *l, const double *point, double radius,
                               int64_t capacity, int32_t *indices, int64_t *found) {
  if (l->builds == 0) return sphi_fail(l->base.ctx, SPH_ERR_STATE, "never built");
  *found = sphi_neighbors_near(l, point, radius, capacity, indices);
  return SPH_OK;
}

sph_status sphi_neighbors_check(const sph_neighbors *l, int32_t dim, int64_t n) {
  if (l->builds == 0) return sphi_fail(l->base.ctx, SPH_ERR_STATE, "the neighbour list was never built");
  if (l->dim != dim || l->n != n)
    return sphi_fail(l->base.ctx, SPH_ERR_ARG, "the neighbour list is for %lld particles", (long long)l->n);
  return SPH_OK;
}
