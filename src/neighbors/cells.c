/* Cells: a bounded grid, a stable counting sort, and the cells around a cell.
 *
 * The edge is the largest cutoff (a little more, so that rounding cannot put two neighbours two
 * cells apart). The grid covers the particles when that needs at most about one cell for two
 * particles. Else, first it shrinks to where most particles are: coordinates beyond are clamped
 * to the outermost cells, which keeps neighbours in adjacent cells because clamping is monotone;
 * then cells grow. So memory is bounded whatever the positions.
 *
 * Cells are numbered in tiles: x fastest, then y within a tile, then all of z, then the next
 * tile. A plane of a tile holds about a thousand particles, so three planes of them stay in a
 * second-level cache while a sweep moves along z, for any size of the domain. */
#include "layout.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum {
  MAX_AXIS = 1 << 20, /* cells an axis; keeps rounding of (x - lo) * inv below the margin */
  TILE_PARTICLES = 1200,
  SAMPLE = 2048,
  BLOCKS = 64, /* pieces of the prefix sum */
  GRAIN = 4096
};

static const double margin = 1.000001;

typedef struct sort_job {
  sphi_layout *l;
  const sphi_input *in;
  uint32_t *key;
  uint32_t *histogram; /* parts * total */
  uint32_t block[BLOCKS + 1];
  int64_t parts;
} sort_job;

/* --- choosing the grid --- */

/* Shell sort: small, and allocates nothing. */
static void sort_doubles(double *v, int64_t n) {
  for (int64_t gap = n / 2; gap > 0; gap = gap == 2 ? 1 : gap * 5 / 11) {
    for (int64_t i = gap; i < n; i++) {
      double x = v[i];
      int64_t k = i;
      for (; k >= gap && v[k - gap] > x; k -= gap) v[k] = v[k - gap];
      v[k] = x;
    }
  }
}

/* The middle of the distribution along one axis, from a strided sample, with generous ends. */
static void bulk(const sphi_input *in, int axis, double edge, double *sample, double *lo,
                 double *hi) {
  int64_t count = in->n < SAMPLE ? in->n : SAMPLE;
  for (int64_t s = 0; s < count; s++) {
    int64_t i = in->n < SAMPLE ? s : (int64_t)((double)s * (double)in->n / SAMPLE);
    sample[s] = in->x[i * in->dim + axis];
  }
  sort_doubles(sample, count);
  double a = sample[count / 32], b = sample[count - 1 - count / 32];
  double extra = (b - a) * 0.125 + 2.0 * edge;
  *lo = fmax(*lo, a - extra);
  *hi = fmin(*hi, b + extra);
}

/* Cells along an axis of the given width, none narrower than the edge. */
static int32_t cells_along(double width, double edge, double most) {
  double q = floor(width / edge);
  if (!(q >= 1.0) || width > DBL_MAX) return 1; /* also when the edge is not finite */
  return (int32_t)fmin(q, most);
}

static double product(const int32_t count[3]) {
  return (double)count[0] * (double)count[1] * (double)count[2];
}

/* Periodic positions may lie many boxes outside, which costs digits: fewer cells then. */
static double most_cells(const sphi_input *in, const sphi_cells *c, int axis, double width) {
  if (c->wrap[axis] == 0.0) return MAX_AXIS;
  double away = fmax(fabs(in->lo[axis] - c->lo[axis]), fabs(in->hi[axis] - c->lo[axis]));
  return fmax(1.0, fmin((double)MAX_AXIS, 1e8 / (1.0 + away / width)));
}

static void count_cells(const sphi_input *in, sphi_cells *c, const double width[3], double edge) {
  for (int a = 0; a < 3; a++) {
    c->count[a] = 1;
    if (a < in->dim) c->count[a] = cells_along(width[a], edge, most_cells(in, c, a, width[a]));
  }
}

static void coarsen(const sphi_input *in, sphi_cells *c, const double width[3], double edge,
                    double limit) {
  for (int a = 0; a < in->dim; a++)
    if (width[a] <= DBL_MAX) edge = fmax(edge, width[a] / MAX_AXIS);
  count_cells(in, c, width, edge);
  while (product(c->count) > limit) {
    edge *= fmax(1.02, pow(product(c->count) / limit, 1.0 / in->dim));
    count_cells(in, c, width, edge);
  }
}

/* Sparse cells cost more for themselves than for their particles: somewhat larger ones then. */
static double suit_occupancy(const sphi_input *in, const sphi_cells *c, double edge) {
  static const double wanted[] = {16.0, 10.0, 10.0}, most[] = {6.0, 1.4, 1.2};
  double occupancy = (double)in->n / product(c->count);
  double factor = pow(wanted[in->dim - 1] / occupancy, 1.0 / in->dim);
  return edge * fmax(1.0, fmin(factor, most[in->dim - 1]));
}

static void set_widths(const sph_neighbors_options *o, const sphi_input *in, const sphi_rule *rule,
                       sphi_cells *c, double width[3]) {
  for (int a = 0; a < in->dim; a++) {
    int wraps = rule->period[a] > 0.0;
    c->wrap[a] = rule->inverse[a];
    c->lo[a] = wraps ? o->box_lo[a] : in->lo[a];
    width[a] = wraps ? rule->period[a] : in->hi[a] - in->lo[a];
  }
}

static void shrink_widths(const sphi_input *in, sphi_cells *c, double edge, double *sample,
                          double width[3]) {
  for (int a = 0; a < in->dim; a++) {
    if (c->wrap[a] > 0.0) continue;
    double lo = in->lo[a], hi = in->hi[a];
    bulk(in, a, edge, sample, &lo, &hi);
    c->lo[a] = lo;
    width[a] = hi - lo;
  }
}

static sph_status choose_counts(sph_context *ctx, const sph_neighbors_options *o,
                                const sphi_input *in, sphi_layout *l, sphi_scratch *tmp) {
  sphi_cells *c = &l->cells;
  double width[3] = {0.0, 0.0, 0.0};
  double edge = l->rule.cut * margin, limit = 0.5 * (double)in->n + 64.0;
  memset(c, 0, sizeof *c);
  set_widths(o, in, &l->rule, c, width);
  count_cells(in, c, width, edge);
  if (product(c->count) > limit) {
    sph_status s = sphi_buffer_reserve(ctx, &tmp->sample, SAMPLE * sizeof(double));
    if (s != SPH_OK) return s;
    shrink_widths(in, c, edge, tmp->sample.ptr, width);
    coarsen(in, c, width, edge, limit);
  }
  double suited = suit_occupancy(in, c, edge);
  for (int a = 0; a < in->dim; a++) {
    int32_t larger = cells_along(width[a], suited, most_cells(in, c, a, width[a]));
    if (c->count[a] >= 8 && larger < c->count[a])
      c->count[a] = larger; /* few cells are too large already */
  }
  for (int a = 0; a < in->dim; a++) {
    c->inv[a] = c->wrap[a] > 0.0 ? (double)c->count[a] : c->count[a] / width[a];
    if (c->count[a] == 1) c->inv[a] = 0.0;
  }
  return SPH_OK;
}

/* --- numbering --- */

static int32_t even_tile(int32_t count, double wanted) {
  int32_t tiles = (int32_t)ceil(count / fmax(wanted, 1.0));
  return (count + tiles - 1) / tiles;
}

static void choose_tiles(sphi_layout *l) {
  sphi_cells *c = &l->cells;
  double each = fmax(1.0, (double)l->n / product(c->count));
  double wanted = fmax(4.0, TILE_PARTICLES / each);
  double ty = l->dim == 3 ? fmax(1.0, floor(sqrt(wanted / 4.0))) : 1.0;
  c->tile[1] = l->dim == 3 ? even_tile(c->count[1], ty) : 1;
  c->tile[0] = l->dim > 1 ? even_tile(c->count[0], wanted / c->tile[1]) : c->count[0];
}

static int32_t tiles(int32_t count, int32_t tile) { return (count + tile - 1) / tile; }

/* Number of cells along the axis that is swept within a column of tiles, and of y tiles. */
static void column(const sphi_cells *c, int32_t dim, int32_t *slow, int32_t *ytiles) {
  *slow = dim == 3 ? c->count[2] : dim == 2 ? c->count[1] : 1;
  *ytiles = dim == 3 ? tiles(c->count[1], c->tile[1]) : 1;
}

static void fill_tables(sphi_cells *c, int32_t dim) {
  int32_t slow, ytiles;
  column(c, dim, &slow, &ytiles);
  uint32_t tx = (uint32_t)c->tile[0], ty = (uint32_t)c->tile[1];
  uint32_t plane = tx * ty, col = plane * (uint32_t)slow;
  for (uint32_t i = 0; i < (uint32_t)c->count[0]; i++)
    c->table[0][i] = (i / tx) * ((uint32_t)ytiles * col) + i % tx;
  for (uint32_t i = 0; i < (uint32_t)c->count[1]; i++)
    c->table[1][i] = dim == 3 ? (i / ty) * col + (i % ty) * tx : i * plane;
  for (uint32_t i = 0; i < (uint32_t)c->count[2]; i++) c->table[2][i] = i * plane;
}

static sph_status make_tables(sph_context *ctx, sphi_layout *l) {
  sphi_cells *c = &l->cells;
  int32_t slow, ytiles;
  choose_tiles(l);
  column(c, l->dim, &slow, &ytiles);
  size_t all = (size_t)tiles(c->count[0], c->tile[0]) * (size_t)(c->tile[0] * c->tile[1]) *
               (size_t)ytiles * (size_t)slow;
  size_t entries = (size_t)c->count[0] + (size_t)c->count[1] + (size_t)c->count[2];
  sph_status s = sphi_buffer_reserve(ctx, &l->b_table, entries * sizeof(uint32_t));
  if (s == SPH_OK) s = sphi_buffer_reserve(ctx, &l->b_first, (all + 1) * sizeof(uint32_t));
  if (s != SPH_OK) return s;
  c->total = (uint32_t)all;
  c->first = l->b_first.ptr;
  c->table[0] = l->b_table.ptr;
  c->table[1] = c->table[0] + c->count[0];
  c->table[2] = c->table[1] + c->count[1];
  fill_tables(c, l->dim);
  return SPH_OK;
}

int sphi_cells_index(const sphi_cells *c, int axis, double x) {
  double t = x - c->lo[axis];
  if (c->wrap[axis] > 0.0) {
    t *= c->wrap[axis];
    t -= floor(t);
  }
  t *= c->inv[axis];
  int last = c->count[axis] - 1;
  if (!(t > 0.0)) return 0; /* NaN too: 0 * infinity, where there is one cell */
  return t < (double)last ? (int)t : last;
}

/* --- counting sort: stable, so the order does not depend on how the input is cut --- */

static void part_bounds(const sort_job *s, int64_t part, int64_t *begin, int64_t *end) {
  *begin = s->in->n * part / s->parts;
  *end = s->in->n * (part + 1) / s->parts;
}

static uint32_t cell_of(const sphi_cells *c, int dim, const double *x) {
  uint32_t id = c->table[0][sphi_cells_index(c, 0, x[0])];
  if (dim > 1) id += c->table[1][sphi_cells_index(c, 1, x[1])];
  if (dim > 2) id += c->table[2][sphi_cells_index(c, 2, x[2])];
  return id;
}

static void count_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  sort_job *s = job;
  const sphi_cells *c = &s->l->cells;
  int dim = s->in->dim;
  (void)worker;
  for (int64_t part = begin; part < end; part++) {
    uint32_t *h = s->histogram + (size_t)part * c->total;
    int64_t b, e;
    part_bounds(s, part, &b, &e);
    memset(h, 0, (size_t)c->total * sizeof *h);
    for (int64_t i = b; i < e; i++) {
      uint32_t id = cell_of(c, dim, s->in->x + i * dim);
      s->key[i] = id;
      h[id]++;
    }
  }
}

static void block_bounds(const sphi_cells *c, int64_t block, uint32_t *begin, uint32_t *end) {
  *begin = (uint32_t)((uint64_t)c->total * (uint64_t)block / BLOCKS);
  *end = (uint32_t)((uint64_t)c->total * (uint64_t)(block + 1) / BLOCKS);
}

static void sum_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  sort_job *s = job;
  const sphi_cells *c = &s->l->cells;
  (void)worker;
  for (int64_t block = begin; block < end; block++) {
    uint32_t b, e, sum = 0;
    block_bounds(c, block, &b, &e);
    for (int64_t part = 0; part < s->parts; part++)
      for (uint32_t id = b; id < e; id++) sum += s->histogram[(size_t)part * c->total + id];
    s->block[block + 1] = sum;
  }
}

static void offset_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  sort_job *s = job;
  const sphi_cells *c = &s->l->cells;
  (void)worker;
  for (int64_t block = begin; block < end; block++) {
    uint32_t b, e, at = s->block[block];
    block_bounds(c, block, &b, &e);
    for (uint32_t id = b; id < e; id++) {
      c->first[id] = at;
      for (int64_t part = 0; part < s->parts; part++) {
        uint32_t *slot = &s->histogram[(size_t)part * c->total + id];
        uint32_t count = *slot;
        *slot = at;
        at += count;
      }
    }
  }
}

static void scatter_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  sort_job *s = job;
  (void)worker;
  for (int64_t part = begin; part < end; part++) {
    uint32_t *next = s->histogram + (size_t)part * s->l->cells.total;
    int64_t b, e;
    part_bounds(s, part, &b, &e);
    for (int64_t i = b; i < e; i++) s->l->order[next[s->key[i]]++] = (uint32_t)i;
  }
}

static void sort_into_cells(sph_context *ctx, sort_job *s) {
  sphi_parallel(ctx, s->parts, 1, count_body, s);
  sphi_parallel(ctx, BLOCKS, s->l->cells.total > GRAIN ? 1 : BLOCKS, sum_body, s);
  s->block[0] = 0;
  for (int b = 0; b < BLOCKS; b++) s->block[b + 1] += s->block[b];
  sphi_parallel(ctx, BLOCKS, s->l->cells.total > GRAIN ? 1 : BLOCKS, offset_body, s);
  s->l->cells.first[s->l->cells.total] = (uint32_t)s->in->n;
  sphi_parallel(ctx, s->parts, 1, scatter_body, s);
}

/* One part a worker, fewer where the histograms would outgrow the particles. */
static int64_t choose_parts(sph_context *ctx, int64_t n, uint32_t total) {
  int64_t parts = sphi_workers(ctx);
  int64_t most = 1 + 4 * n / (int64_t)total;
  if (parts > most) parts = most;
  if (parts > 1 + n / GRAIN) parts = 1 + n / GRAIN;
  return parts;
}

sph_status sphi_cells_build(sph_context *ctx, sphi_layout *l, const sphi_input *in,
                            const sph_neighbors_options *o, sphi_scratch *tmp) {
  sphi_cells *c = &l->cells;
  if (in->n == 0) return SPH_OK;
  sph_status s = choose_counts(ctx, o, in, l, tmp);
  if (s == SPH_OK) s = make_tables(ctx, l);
  if (s != SPH_OK) return s;
  sort_job job = {.l = l, .in = in, .parts = choose_parts(ctx, in->n, c->total)};
  s = sphi_buffer_reserve(ctx, &tmp->key, sphi_mul((size_t)in->n, sizeof(uint32_t)));
  if (s == SPH_OK)
    s = sphi_buffer_reserve(ctx, &tmp->histogram, (size_t)job.parts * c->total * sizeof(uint32_t));
  if (s != SPH_OK) return s;
  job.key = tmp->key.ptr;
  job.histogram = tmp->histogram.ptr;
  sort_into_cells(ctx, &job);
  return SPH_OK;
}

/* --- candidates --- */

uint32_t sphi_cells_at(const sphi_cells *c, uint32_t position) {
  uint32_t lo = 0, hi = c->total; /* the last cell that begins at or before the position */
  while (hi - lo > 1) {
    uint32_t mid = lo + (hi - lo) / 2;
    if (c->first[mid] <= position)
      lo = mid;
    else
      hi = mid;
  }
  return lo;
}

static void coordinates(const sphi_cells *c, int32_t dim, uint32_t id, int32_t at[3]) {
  int32_t slow, ytiles;
  column(c, dim, &slow, &ytiles);
  uint32_t tx = (uint32_t)c->tile[0], ty = (uint32_t)c->tile[1];
  uint32_t xin = id % tx, rest = id / tx;
  uint32_t yin = rest % ty;
  rest /= ty;
  uint32_t z = rest % (uint32_t)slow;
  rest /= (uint32_t)slow;
  uint32_t yt = rest % (uint32_t)ytiles, xt = rest / (uint32_t)ytiles;
  at[0] = (int32_t)(xt * tx + xin);
  at[1] = (int32_t)(dim == 2 ? z : yt * ty + yin);
  at[2] = (int32_t)(dim == 3 ? z : 0);
}

/* The cells next to `at` along an axis: table entries, at most three, none twice. */
static int next_to(const sphi_cells *c, int axis, int32_t at, uint32_t out[3]) {
  int32_t count = c->count[axis];
  int n = 0;
  for (int32_t d = -1; d <= 1; d++) {
    int32_t k = at + d;
    if (c->wrap[axis] > 0.0) {
      if (count < 3 && d >= count - 1 && d > 0) continue; /* 1 or 2 cells: seen already */
      if (count == 1 && d != 0) continue;
      k = (k + count) % count;
    }
    if (k >= 0 && k < count) out[n++] = c->table[axis][k];
  }
  return n;
}

static int add_range(sphi_range *out, int n, uint32_t begin, uint32_t end) {
  int at = n;
  if (begin == end) return n;
  while (at > 0 && out[at - 1].begin > begin) {
    out[at] = out[at - 1];
    at--;
  }
  out[at].begin = begin;
  out[at].end = end;
  return n + 1;
}

static int merge_ranges(sphi_range *out, int n) {
  int kept = 0;
  for (int r = 0; r < n; r++) {
    if (kept > 0 && out[kept - 1].end == out[r].begin)
      out[kept - 1].end = out[r].end;
    else
      out[kept++] = out[r];
  }
  return kept;
}

/* One row of cells: runs of consecutive numbers become one range. */
static int add_row(const sphi_cells *c, uint32_t row, const uint32_t *xs, int nx, sphi_range *out,
                   int n) {
  for (int i = 0; i < nx;) {
    uint32_t first = row + xs[i], last = first;
    for (i++; i < nx && row + xs[i] == last + 1; i++) last++;
    n = add_range(out, n, c->first[first], c->first[last + 1]);
  }
  return n;
}

int sphi_cells_ranges(const sphi_cells *c, int32_t dim, uint32_t cell, sphi_range *out) {
  int32_t at[3];
  uint32_t xs[3], ys[3], zs[3];
  coordinates(c, dim, cell, at);
  int nx = next_to(c, 0, at[0], xs), ny = next_to(c, 1, at[1], ys);
  int nz = next_to(c, 2, at[2], zs), n = 0;
  for (int z = 0; z < nz; z++)
    for (int y = 0; y < ny; y++) n = add_row(c, ys[y] + zs[z], xs, nx, out, n);
  return merge_ranges(out, n);
}
