/* A tree of small leaves, for particles of very unequal smoothing length.
 *
 * Leaves are those of a k-d tree. Its top is cut from a sample, so that every particle can be
 * sent to its subtree in one parallel pass; each subtree then fits a cache and is halved at
 * medians until a leaf holds at most SPHI_LEAF particles. Above the leaves, in their order, each
 * level has one box for eight boxes of the level below: a walk tests eight at a time and needs
 * no links. Nothing depends on the number of threads. Boxes are those of the particles
 * themselves, so the cuts decide about speed only: a walk is right for any. */
#include "layout.h"

#include <math.h>
#include <string.h>

enum {
  SUBTREE = 4096, /* particles a subtree holds, about */
  MAX_LEVELS = 10,
  SAMPLE_EACH = 32, /* samples a subtree */
  GRAIN = 8192
};

typedef struct record {
  double x[3];
  uint32_t index;
  uint32_t tree; /* of the sample: unused */
} record;

typedef struct top {
  int levels, count; /* count = 2^levels subtrees */
  int32_t axis[1 << MAX_LEVELS];
  double cut[1 << MAX_LEVELS];
  uint32_t begin[(1 << MAX_LEVELS) + 1]; /* sweep positions */
  uint32_t leaf[1 << MAX_LEVELS];        /* first leaf */
} top;

typedef struct tree_job {
  sphi_layout *l;
  const sphi_input *in;
  top *top;
  record *record;
  uint32_t *histogram; /* parts * top->count */
  uint16_t *key;
  int64_t parts;
} tree_job;

typedef struct level_job {
  const sphi_rule *rule;
  const sphi_boxes *from;
  sphi_boxes *to;
  int64_t count; /* boxes in `from` */
} level_job;

/* --- halving --- */

static int widest_axis(const record *r, int64_t n, int dim) {
  int best = 0;
  double width = -1.0;
  for (int a = 0; a < dim; a++) {
    double lo = r[0].x[a], hi = lo;
    for (int64_t i = 1; i < n; i++) {
      double x = r[i].x[a];
      lo = x < lo ? x : lo;
      hi = x > hi ? x : hi;
    }
    if (hi - lo > width) {
      width = hi - lo;
      best = a;
    }
  }
  return best;
}

static double median3(double a, double b, double c) {
  double lo = a < b ? a : b, hi = a < b ? b : a;
  return c < lo ? lo : c > hi ? hi : c;
}

/* Near the median: of three, or of nine. */
static double choose_pivot(const record *r, int64_t n, int axis) {
  int64_t step = n / 9;
  double m[3];
  if (n < 64) return median3(r[0].x[axis], r[n / 2].x[axis], r[n - 1].x[axis]);
  for (int64_t k = 0; k < 3; k++) {
    const record *q = r + k * 3 * step;
    m[k] = median3(q[0].x[axis], q[step].x[axis], q[2 * step].x[axis]);
  }
  return median3(m[0], m[1], m[2]);
}

/* Records below the pivot to the front (or_equal: those not above it); returns how many. Each is
 * exchanged whether or not it must be: cheaper than a branch that cannot be predicted. */
static int64_t partition(record *r, int64_t n, int axis, double pivot, int or_equal) {
  int64_t kept = 0;
  for (int64_t k = 0; k < n; k++) {
    record t = r[k];
    r[k] = r[kept];
    r[kept] = t;
    kept += or_equal ? t.x[axis] <= pivot : t.x[axis] < pivot;
  }
  return kept;
}

/* Bring the median to the middle. Gives up when that gets expensive: any order is right. */
static void select_middle(record *r, int64_t n, int64_t middle, int axis) {
  int64_t work = 16 * n;
  while (n > 1 && work > 0) {
    double pivot = choose_pivot(r, n, axis);
    int64_t below = partition(r, n, axis, pivot, 0);
    work -= n;
    if (middle < below) {
      n = below;
      continue;
    }
    if (below == 0) below = partition(r, n, axis, pivot, 1);
    if (middle < below) return; /* among records equal to the pivot */
    r += below;
    n -= below;
    middle -= below;
  }
}

/* --- the top, from a sample --- */

static void cut_sample(top *t, record *r, int64_t n, int dim, int node, int level) {
  if (level == t->levels) return;
  int axis = n > 0 ? widest_axis(r, n, dim) : 0;
  int64_t middle = n / 2;
  if (n > 1) select_middle(r, n, middle, axis);
  t->axis[node] = axis;
  t->cut[node] = n > 0 ? r[middle].x[axis] : 0.0;
  cut_sample(t, r, middle, dim, 2 * node + 1, level + 1);
  cut_sample(t, r + middle, n - middle, dim, 2 * node + 2, level + 1);
}

static void load_record(record *r, const sphi_input *in, int64_t i) {
  for (int a = 0; a < 3; a++) r->x[a] = a < in->dim ? in->x[i * in->dim + a] : 0.0;
  r->index = (uint32_t)i;
  r->tree = 0;
}

static void make_top(tree_job *t) {
  top *p = t->top;
  int64_t n = t->in->n, count = (int64_t)SAMPLE_EACH * p->count;
  if (count > n) count = n;
  for (int64_t s = 0; s < count; s++) {
    int64_t i = (int64_t)((double)s * (double)n / (double)count);
    load_record(&t->record[s], t->in, i < n ? i : n - 1);
  }
  cut_sample(p, t->record, count, t->in->dim, 0, 0);
}

static int choose_levels(int64_t n) {
  int levels = 0;
  while (levels < MAX_LEVELS && (n >> levels) > SUBTREE) levels++;
  return levels;
}

/* --- sending particles to subtrees: a stable counting sort --- */

static uint32_t subtree_of(const top *t, const double *x) {
  uint32_t node = 0;
  for (int level = 0; level < t->levels; level++)
    node = 2 * node + 1 + (uint32_t)(x[t->axis[node]] >= t->cut[node]);
  return node - (uint32_t)(t->count - 1);
}

static void part_bounds(const tree_job *t, int64_t part, int64_t *begin, int64_t *end) {
  *begin = t->in->n * part / t->parts;
  *end = t->in->n * (part + 1) / t->parts;
}

static void count_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  tree_job *t = job;
  (void)worker;
  for (int64_t part = begin; part < end; part++) {
    uint32_t *h = t->histogram + part * t->top->count;
    int64_t b, e;
    part_bounds(t, part, &b, &e);
    memset(h, 0, (size_t)t->top->count * sizeof *h);
    for (int64_t i = b; i < e; i++) {
      uint32_t s = subtree_of(t->top, t->in->x + i * t->in->dim);
      t->key[i] = (uint16_t)s;
      h[s]++;
    }
  }
}

static void scatter_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  tree_job *t = job;
  (void)worker;
  for (int64_t part = begin; part < end; part++) {
    uint32_t *next = t->histogram + part * t->top->count;
    int64_t b, e;
    part_bounds(t, part, &b, &e);
    for (int64_t i = b; i < e; i++) load_record(&t->record[next[t->key[i]]++], t->in, i);
  }
}

static void offsets(tree_job *t) {
  uint32_t at = 0;
  for (int s = 0; s < t->top->count; s++) {
    t->top->begin[s] = at;
    for (int64_t part = 0; part < t->parts; part++) {
      uint32_t *slot = &t->histogram[part * t->top->count + s];
      uint32_t count = *slot;
      *slot = at;
      at += count;
    }
  }
  t->top->begin[t->top->count] = at;
}

/* --- numbering leaves before they are made --- */

/* Halving gives parts of two sizes on every level: `small` ones of size m, `large` ones of m + 1.
 */
static uint32_t leaves_of(uint32_t n) {
  uint32_t m = n, small = n > 0, large = 0;
  for (; m > SPHI_LEAF; m /= 2) {
    uint32_t s = small, l = large;
    small = m % 2 ? s : 2 * s + l; /* an odd part gives one of each, an even one two equal ones */
    large = m % 2 ? s + 2 * l : l;
  }
  return small + (m == SPHI_LEAF ? 2 * large : large);
}

static uint32_t number_leaves(top *t) {
  uint32_t leaf = 0;
  for (int s = 0; s < t->count; s++) {
    t->leaf[s] = leaf;
    leaf += leaves_of(t->begin[s + 1] - t->begin[s]);
  }
  return leaf;
}

/* --- subtrees --- */

static void box_of(sphi_boxes *b, int lane, const record *r, int64_t n) {
  for (int a = 0; a < 3; a++) {
    double lo = r[0].x[a], hi = lo;
    for (int64_t i = 1; i < n; i++) {
      double x = r[i].x[a];
      lo = x < lo ? x : lo;
      hi = x > hi ? x : hi;
    }
    double middle = 0.5 * lo + 0.5 * hi;
    b->center[a][lane] = middle;
    b->half[a][lane] = (hi - middle > middle - lo ? hi - middle : middle - lo) * (1.0 + 1e-14);
  }
}

static void sort_leaf(record *r, int64_t n) {
  for (int64_t i = 1; i < n; i++) {
    record x = r[i];
    int64_t k = i;
    for (; k > 0 && r[k - 1].index > x.index; k--) r[k] = r[k - 1];
    r[k] = x;
  }
}

static double bound_of(const tree_job *t, const record *r, int64_t n) {
  const sphi_rule *rule = &t->l->rule;
  if (rule->uniform) return 0.0;
  double s = sphi_rule_s(rule, t->in->h[r[0].index]);
  for (int64_t i = 1; i < n; i++)
    s = sphi_rule_bound(rule, s, sphi_rule_s(rule, t->in->h[r[i].index]));
  return s;
}

static void make_leaf(tree_job *t, uint32_t leaf, uint32_t begin, int64_t n) {
  record *r = t->record + begin;
  sphi_boxes *b = &t->l->tree.level[0][leaf / 8];
  sort_leaf(r, n);
  box_of(b, (int)(leaf % 8), r, n);
  b->s[leaf % 8] = bound_of(t, r, n);
  for (int64_t i = 0; i < n; i++) t->l->order[begin + i] = r[i].index;
  t->l->tree.leaf[leaf] = begin;
}

/* Leaves of the particles [begin, end), numbered from `leaf`; returns the next number. */
static uint32_t halve(tree_job *t, uint32_t begin, uint32_t end, uint32_t leaf) {
  uint32_t n = end - begin, middle = n / 2;
  if (n == 0) return leaf;
  if (n <= SPHI_LEAF) {
    make_leaf(t, leaf, begin, n);
    return leaf + 1;
  }
  record *r = t->record + begin;
  select_middle(r, n, middle, widest_axis(r, n, t->in->dim));
  return halve(t, begin + middle, end, halve(t, begin, begin + middle, leaf));
}

static void subtree_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  tree_job *t = job;
  (void)worker;
  for (int64_t s = begin; s < end; s++)
    halve(t, t->top->begin[s], t->top->begin[s + 1], t->top->leaf[s]);
}

/* --- levels above the leaves --- */

/* The box around `count` boxes. */
static void join(const sphi_rule *rule, const sphi_boxes *from, int count, sphi_boxes *to,
                 int lane) {
  for (int a = 0; a < 3; a++) {
    double lo = INFINITY, hi = -INFINITY;
    for (int k = 0; k < count; k++) {
      double low = from->center[a][k] - from->half[a][k];
      double high = from->center[a][k] + from->half[a][k];
      lo = low < lo ? low : lo;
      hi = high > hi ? high : hi;
    }
    double middle = 0.5 * lo + 0.5 * hi;
    to->center[a][lane] = middle;
    to->half[a][lane] = (hi - middle > middle - lo ? hi - middle : middle - lo) * (1.0 + 1e-14);
    to->half[a][lane] += 1e-15 * (fabs(lo) + fabs(hi)); /* lo and hi were rounded themselves */
  }
  to->s[lane] = from->s[0];
  for (int k = 1; k < count; k++) to->s[lane] = sphi_rule_bound(rule, to->s[lane], from->s[k]);
}

static void level_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  const level_job *j = job;
  (void)worker;
  for (int64_t k = begin; k < end; k++) {
    int64_t left = j->count - 8 * k;
    join(j->rule, &j->from[k], left < 8 ? (int)left : 8, &j->to[k / 8], (int)(k % 8));
  }
}

/* Lanes beyond the last box are read and then masked: give them numbers. */
static void close_level(sphi_boxes *boxes, uint32_t count) {
  for (uint32_t k = count; k % 8 != 0; k++) {
    sphi_boxes *b = &boxes[k / 8];
    for (int a = 0; a < 3; a++) b->center[a][k % 8] = b->half[a][k % 8] = 0.0;
    b->s[k % 8] = b->s[0];
  }
}

static void make_levels(sph_context *ctx, sphi_layout *l) {
  sphi_tree *t = &l->tree;
  uint32_t count = t->leaf_count;
  t->boxes[0] = count;
  close_level(t->level[0], count);
  for (int k = 1; k < t->levels; k++) {
    level_job job = {&l->rule, t->level[k - 1], t->level[k], count};
    count = (count + 7) / 8;
    t->boxes[k] = count;
    sphi_parallel(ctx, count, 512, level_body, &job);
    close_level(t->level[k], count);
  }
}

/* --- building --- */

static sph_status reserve(sph_context *ctx, tree_job *t, sphi_scratch *tmp) {
  size_t n = (size_t)t->in->n, parts = (size_t)t->parts;
  sph_status s = sphi_buffer_reserve(ctx, &tmp->record, sphi_mul(n, sizeof(record)));
  if (s == SPH_OK) s = sphi_buffer_reserve(ctx, &tmp->key, sphi_mul(n, sizeof(uint16_t)));
  if (s == SPH_OK)
    s = sphi_buffer_reserve(ctx, &tmp->histogram,
                            sphi_mul(parts * sizeof(uint32_t), (size_t)1 << MAX_LEVELS));
  if (s == SPH_OK) s = sphi_buffer_reserve(ctx, &tmp->sample, sizeof(top));
  if (s != SPH_OK) return s;
  t->record = tmp->record.ptr;
  t->key = tmp->key.ptr;
  t->histogram = tmp->histogram.ptr;
  t->top = tmp->sample.ptr;
  return SPH_OK;
}

/* Levels up to the one that has at most eight boxes. */
static sph_status reserve_levels(sph_context *ctx, sphi_layout *l, uint32_t leaves) {
  sphi_tree *t = &l->tree;
  size_t first[SPHI_LEVELS], all = 0;
  t->leaf_count = leaves;
  t->levels = 0;
  for (size_t count = leaves; t->levels == 0 || count > 1; t->levels++) {
    count = (count + 7) / 8; /* of eight boxes */
    first[t->levels] = all;
    all += count;
  }
  sph_status s = sphi_buffer_reserve(ctx, &l->b_nodes, all * sizeof(sphi_boxes));
  if (s == SPH_OK)
    s = sphi_buffer_reserve(ctx, &l->b_leaf, ((size_t)leaves + 1) * sizeof(uint32_t));
  if (s != SPH_OK) return s;
  for (int k = 0; k < t->levels; k++) t->level[k] = (sphi_boxes *)l->b_nodes.ptr + first[k];
  t->leaf = l->b_leaf.ptr;
  return SPH_OK;
}

static int64_t choose_parts(sph_context *ctx, int64_t n) {
  int64_t parts = sphi_workers(ctx);
  return parts > 1 + n / GRAIN ? 1 + n / GRAIN : parts;
}

sph_status sphi_tree_build(sph_context *ctx, sphi_layout *l, const sphi_input *in,
                           sphi_scratch *tmp) {
  if (in->n == 0) return SPH_OK;
  tree_job t = {.l = l, .in = in, .parts = choose_parts(ctx, in->n)};
  sph_status s = reserve(ctx, &t, tmp);
  if (s != SPH_OK) return s;
  t.top->levels = choose_levels(in->n);
  t.top->count = 1 << t.top->levels;
  make_top(&t);
  sphi_parallel(ctx, t.parts, 1, count_body, &t);
  offsets(&t);
  sphi_parallel(ctx, t.parts, 1, scatter_body, &t);
  uint32_t leaves = number_leaves(t.top);
  s = reserve_levels(ctx, l, leaves);
  if (s != SPH_OK) return s;
  sphi_parallel(ctx, t.top->count, 1, subtree_body, &t);
  l->tree.leaf[leaves] = (uint32_t)in->n;
  make_levels(ctx, l);
  return SPH_OK;
}

/* --- candidates --- */

uint32_t sphi_tree_leaf_at(const sphi_tree *t, uint32_t position) {
  uint32_t lo = 0, hi = t->leaf_count;
  while (hi - lo > 1) {
    uint32_t mid = lo + (hi - lo) / 2;
    if (t->leaf[mid] <= position)
      lo = mid;
    else
      hi = mid;
  }
  return lo;
}

/* Lanes of a block that are boxes within reach. */
static uint32_t boxes_near(const sphi_walk *w, int level, uint32_t block) {
  uint32_t left = w->tree->boxes[level] - 8 * block;
  uint32_t mask = w->near(w, &w->tree->level[level][block]);
  return left < 8 ? mask & ((1u << left) - 1u) : mask;
}

void sphi_walk_begin(sphi_walk *w, const sphi_tree *t, const sphi_rule *rule, sphi_boxes_fn near,
                     const double center[3], const double half[3], double s, double radius) {
  double reach = (radius >= 0.0 ? radius : rule->cut) * SPHI_REACH_MARGIN;
  w->near = near;
  w->tree = t;
  w->rule = rule;
  for (int a = 0; a < 3; a++) {
    w->center[a] = center[a];
    w->half[a] = half[a];
  }
  w->s = s;
  w->limit = -1.0;
  if (radius >= 0.0 || rule->uniform) w->limit = reach * reach;
  w->at = t->levels - 1;
  w->block[w->at] = 0;
  w->mask[w->at] = boxes_near(w, w->at, 0);
}

int sphi_walk_ranges(sphi_walk *w, sphi_range *out) {
  const sphi_tree *t = w->tree;
  int n = 0;
  while (w->at < t->levels && n < SPHI_MAX_RANGES) {
    uint32_t mask = w->mask[w->at];
    if (mask == 0) {
      w->at++;
      continue;
    }
    w->mask[w->at] = mask & (mask - 1);
    uint32_t box = 8 * w->block[w->at] + (uint32_t)__builtin_ctz(mask);
    if (w->at > 0) {
      w->at--;
      w->block[w->at] = box;
      w->mask[w->at] = boxes_near(w, w->at, box);
      continue;
    }
    if (n > 0 && out[n - 1].end == t->leaf[box])
      out[n - 1].end = t->leaf[box + 1];
    else
      out[n++] = (sphi_range){t->leaf[box], t->leaf[box + 1]};
  }
  return n;
}
