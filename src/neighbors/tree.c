/* A k-d tree with small leaves, for particles of very unequal smoothing length.
 *
 * The top of the tree is cut from a sample, so that every particle can be sent to its subtree
 * in one parallel pass; each subtree then fits a cache and is halved at medians until a leaf
 * holds at most SPHI_LEAF particles. Nothing depends on the number of threads. Boxes are those
 * of the particles themselves, so the cuts decide about speed only: a walk is right for any. */
#include "layout.h"

#include <math.h>
#include <string.h>

enum {
  SUBTREE = 4096,    /* particles a subtree holds, about */
  MAX_LEVELS = 10,
  SAMPLE_EACH = 32,  /* samples a subtree */
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
  uint32_t node[1 << MAX_LEVELS];        /* first node */
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
  return fmax(fmin(a, b), fmin(fmax(a, b), c));
}

static void swap_records(record *a, record *b) {
  record t = *a;
  *a = *b;
  *b = t;
}

/* Hoare's partition of [lo, hi]: [lo, result] <= pivot <= [result + 1, hi]. */
static int64_t partition(record *r, int64_t lo, int64_t hi, int axis) {
  double pivot = median3(r[lo].x[axis], r[lo + (hi - lo) / 2].x[axis], r[hi].x[axis]);
  int64_t i = lo - 1, j = hi + 1;
  for (;;) {
    do i++;
    while (r[i].x[axis] < pivot);
    do j--;
    while (r[j].x[axis] > pivot);
    if (i >= j) return j < hi ? j : hi - 1;
    swap_records(&r[i], &r[j]);
  }
}

/* Bring the median to the middle. Gives up when that gets expensive: any order is right. */
static void select_middle(record *r, int64_t n, int64_t middle, int axis) {
  int64_t lo = 0, hi = n - 1, work = 16 * n;
  while (lo < hi && work > 0) {
    work -= hi - lo;
    int64_t cut = partition(r, lo, hi, axis);
    if (middle <= cut) hi = cut;
    else lo = cut + 1;
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

/* --- numbering nodes before they are made --- */

static uint32_t leaves_of(uint32_t n) {
  if (n <= SPHI_LEAF) return n > 0;
  return leaves_of(n / 2) + leaves_of(n - n / 2);
}

static uint32_t nodes_of(uint32_t leaves) { return leaves == 0 ? 1 : 2 * leaves - 1; }

/* Preorder over the top: an empty subtree is one empty leaf node, without a leaf number. */
static uint32_t number_top(tree_job *t, int node, int level, uint32_t next, uint32_t *leaf) {
  top *p = t->top;
  if (level == p->levels) {
    int s = node - (p->count - 1);
    uint32_t leaves = leaves_of(p->begin[s + 1] - p->begin[s]);
    p->node[s] = next;
    p->leaf[s] = *leaf;
    *leaf += leaves;
    return next + nodes_of(leaves);
  }
  uint32_t after = number_top(t, 2 * node + 1, level + 1, next + 1, leaf);
  return number_top(t, 2 * node + 2, level + 1, after, leaf);
}

/* --- subtrees --- */

static void box_of(sphi_node *node, const record *r, int64_t n) {
  for (int a = 0; a < 3; a++) {
    double lo = r[0].x[a], hi = lo;
    for (int64_t i = 1; i < n; i++) {
      double x = r[i].x[a];
      lo = x < lo ? x : lo;
      hi = x > hi ? x : hi;
    }
    node->center[a] = 0.5 * lo + 0.5 * hi;
    node->half[a] = fmax(hi - node->center[a], node->center[a] - lo) * (1.0 + 1e-14);
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

static void make_leaf(tree_job *t, sphi_node *node, record *r, uint32_t *leaf) {
  int64_t n = node->end - node->begin;
  node->leaf = 1;
  if (n == 0) {
    for (int a = 0; a < 3; a++) {
      node->center[a] = 0.0;
      node->half[a] = -INFINITY; /* infinitely far from everything */
    }
    node->s = 0.0;
    return;
  }
  sort_leaf(r, n);
  box_of(node, r, n);
  node->s = bound_of(t, r, n);
  for (int64_t i = 0; i < n; i++) t->l->order[node->begin + i] = r[i].index;
  t->l->tree.leaf[(*leaf)++] = node->begin;
}

/* Box of a parent from its children. */
static void join(sphi_node *nodes, uint32_t parent, const sphi_rule *rule) {
  sphi_node *p = &nodes[parent];
  const sphi_node *a = &nodes[parent + 1], *b = &nodes[a->skip];
  if (b->half[0] < 0.0 || a->half[0] < 0.0) {
    const sphi_node *full = b->half[0] < 0.0 ? a : b;
    memcpy(p->center, full->center, sizeof p->center);
    memcpy(p->half, full->half, sizeof p->half);
    p->s = full->s;
    return;
  }
  for (int k = 0; k < 3; k++) {
    double lo = fmin(a->center[k] - a->half[k], b->center[k] - b->half[k]);
    double hi = fmax(a->center[k] + a->half[k], b->center[k] + b->half[k]);
    p->center[k] = 0.5 * lo + 0.5 * hi;
    p->half[k] = fmax(hi - p->center[k], p->center[k] - lo) * (1.0 + 1e-14);
    p->half[k] += 1e-15 * (fabs(lo) + fabs(hi)); /* lo and hi were rounded themselves */
  }
  p->s = sphi_rule_bound(rule, a->s, b->s);
}

static uint32_t halve(tree_job *t, uint32_t at, uint32_t begin, uint32_t end, uint32_t *leaf) {
  sphi_node *node = &t->l->tree.nodes[at];
  record *r = t->record + begin;
  node->begin = begin;
  node->end = end;
  if (end - begin <= SPHI_LEAF) {
    make_leaf(t, node, r, leaf);
    return node->skip = at + 1;
  }
  uint32_t middle = (end - begin) / 2;
  int axis = widest_axis(r, end - begin, t->in->dim);
  select_middle(r, end - begin, middle, axis);
  node->leaf = 0;
  uint32_t next = halve(t, at + 1, begin, begin + middle, leaf);
  node->skip = halve(t, next, begin + middle, end, leaf);
  join(t->l->tree.nodes, at, &t->l->rule);
  return node->skip;
}

static void subtree_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  tree_job *t = job;
  (void)worker;
  for (int64_t s = begin; s < end; s++) {
    uint32_t leaf = t->top->leaf[s];
    halve(t, t->top->node[s], t->top->begin[s], t->top->begin[s + 1], &leaf);
  }
}

static uint32_t close_top(tree_job *t, int node, int level, uint32_t at) {
  top *p = t->top;
  sphi_node *nodes = t->l->tree.nodes;
  if (level == p->levels) return nodes[at].skip;
  int last = p->levels - level;
  int s = (node + 1) * (1 << last) - p->count; /* first subtree below this node */
  nodes[at].begin = p->begin[s];
  nodes[at].end = p->begin[s + (1 << last)];
  nodes[at].leaf = 0;
  uint32_t next = close_top(t, 2 * node + 1, level + 1, at + 1);
  nodes[at].skip = close_top(t, 2 * node + 2, level + 1, next);
  join(nodes, at, &t->l->rule);
  return nodes[at].skip;
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

static sph_status reserve_nodes(sph_context *ctx, tree_job *t, uint32_t nodes, uint32_t leaves) {
  sphi_layout *l = t->l;
  sph_status s = sphi_buffer_reserve(ctx, &l->b_nodes, sphi_mul(nodes, sizeof(sphi_node)));
  if (s == SPH_OK)
    s = sphi_buffer_reserve(ctx, &l->b_leaf, sphi_mul((size_t)leaves + 1, sizeof(uint32_t)));
  if (s != SPH_OK) return s;
  l->tree.nodes = l->b_nodes.ptr;
  l->tree.leaf = l->b_leaf.ptr;
  l->tree.count = nodes;
  l->tree.leaf_count = leaves;
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
  uint32_t leaves = 0;
  uint32_t nodes = number_top(&t, 0, 0, 0, &leaves);
  s = reserve_nodes(ctx, &t, nodes, leaves);
  if (s != SPH_OK) return s;
  sphi_parallel(ctx, t.top->count, 1, subtree_body, &t);
  l->tree.leaf[leaves] = (uint32_t)in->n;
  close_top(&t, 0, 0, 0);
  return SPH_OK;
}

/* --- candidates --- */

uint32_t sphi_tree_leaf_at(const sphi_tree *t, uint32_t position) {
  uint32_t lo = 0, hi = t->leaf_count;
  while (hi - lo > 1) {
    uint32_t mid = lo + (hi - lo) / 2;
    if (t->leaf[mid] <= position) lo = mid;
    else hi = mid;
  }
  return lo;
}

static double gap2(const sphi_rule *rule, const sphi_node *node, const double center[3],
                   const double half[3]) {
  double sum = 0.0;
  for (int a = 0; a < rule->dim; a++) {
    double d = node->center[a] - center[a];
    if (rule->period[a] > 0.0) d = sphi_wrap(d, rule->period[a], rule->inverse[a]);
    d = fabs(d) - (node->half[a] + half[a]);
    if (d > 0.0) sum += d * d; /* not for NaN, from infinite boxes: they touch everything */
  }
  return sum;
}

int sphi_tree_ranges(const sphi_tree *t, const sphi_rule *rule, const double center[3],
                     const double half[3], double s, double radius, uint32_t *cursor,
                     sphi_range *out) {
  uint32_t at = *cursor;
  int n = 0;
  while (at < t->count && n < SPHI_MAX_RANGES) {
    const sphi_node *node = &t->nodes[at];
    double reach = radius;
    if (radius < 0.0) reach = rule->uniform ? rule->cut : sphi_reach(rule, s, node->s) + rule->skin;
    reach *= 1.000001; /* rounding of boxes and distances */
    if (!(gap2(rule, node, center, half) <= reach * reach)) {
      at = node->skip;
      continue;
    }
    at++;
    if (!node->leaf) continue;
    if (n > 0 && out[n - 1].end == node->begin) out[n - 1].end = node->end;
    else out[n++] = (sphi_range){node->begin, node->end};
  }
  *cursor = at;
  return n;
}
