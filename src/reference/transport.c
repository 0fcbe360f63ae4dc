/* The transport problem by a primal network simplex. Sources 0..n-1 and sinks n..n+m-1 hang in a
 * spanning tree; the arc between a node and its parent carries `flow` from the source to the sink.
 * Arcs outside the tree carry nothing. A pivot takes in an arc whose reduced cost |x - y| - u - v
 * is negative and takes out one that its cycle empties.
 *
 * Every empty arc of the tree points to the root, and the last arc that blocks, seen along the
 * cycle from its top, leaves: then that stays so, and no tree comes back (W. Cunningham, Math.
 * Program. 11 (1976) 105-116). Flows are whole numbers, so that empty is exact. */
#include "reference_impl.h"

#include <float.h>
#include <math.h>

typedef struct node {
  double price;                        /* u of a source, v of a sink: u + v = cost along the tree */
  int64_t flow;                        /* on the arc to the parent */
  int32_t parent, child, next, before; /* -1: none; the children of a node are a list */
  int32_t depth;
} node;

typedef struct network {
  node *nodes;
  const double *x, *y;
  int32_t n, m, dim;
  double tolerance; /* on reduced costs */
} network;

static double distance(const double *a, const double *b, int32_t dim) {
  double sum = 0.0;
  for (int32_t k = 0; k < dim; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sqrt(sum);
}

static double cost(const network *w, int32_t source, int32_t sink) {
  return distance(w->x + (int64_t)source * w->dim, w->y + (int64_t)(sink - w->n) * w->dim, w->dim);
}

static int is_source(const network *w, int32_t i) { return i < w->n; }

/* Cost of the arc between a node and its parent. */
static double tree_cost(const network *w, int32_t i) {
  const int32_t j = w->nodes[i].parent;
  return is_source(w, i) ? cost(w, i, j) : cost(w, j, i);
}

/* ---- the tree ---------------------------------------------------------------------------- */

static void hang(network *w, int32_t i, int32_t parent) {
  node *a = &w->nodes[i], *p = &w->nodes[parent];
  a->parent = parent;
  a->before = -1;
  a->next = p->child;
  if (a->next >= 0) w->nodes[a->next].before = i;
  p->child = i;
}

static void unhang(network *w, int32_t i) {
  node *a = &w->nodes[i];
  if (a->before >= 0)
    w->nodes[a->before].next = a->next;
  else
    w->nodes[a->parent].child = a->next;
  if (a->next >= 0) w->nodes[a->next].before = a->before;
}

/* The node after i in the subtree of top, parents first; -1 at the end. */
static int32_t following(const network *w, int32_t i, int32_t top) {
  if (w->nodes[i].child >= 0) return w->nodes[i].child;
  while (i != top && w->nodes[i].next < 0) i = w->nodes[i].parent;
  return i == top ? -1 : w->nodes[i].next;
}

/* Prices and depths below top, whose own are right, from the costs of the tree. */
static void price_below(network *w, int32_t top) {
  for (int32_t i = following(w, top, top); i >= 0; i = following(w, i, top)) {
    const node *p = &w->nodes[w->nodes[i].parent];
    w->nodes[i].price = tree_cost(w, i) - p->price;
    w->nodes[i].depth = p->depth + 1;
  }
}

/* Make `base` the top of the part of the tree below `cut`, with `flow` on its new arc, and hang it
 * under `parent`: the arcs from base up to cut turn round and keep their flows. */
static void move_part(network *w, int32_t cut, int32_t base, int32_t parent, int64_t flow) {
  int32_t i = base, above = parent;
  for (;;) {
    const int32_t old = w->nodes[i].parent;
    const int64_t kept = w->nodes[i].flow;
    unhang(w, i);
    hang(w, i, above);
    w->nodes[i].flow = flow;
    if (i == cut) break;
    above = i;
    flow = kept;
    i = old;
  }
  w->nodes[base].price = tree_cost(w, base) - w->nodes[parent].price;
  w->nodes[base].depth = w->nodes[parent].depth + 1;
  price_below(w, base);
}

/* ---- a pivot ----------------------------------------------------------------------------- */

static int32_t meeting(const network *w, int32_t a, int32_t b) {
  while (a != b) {
    if (w->nodes[a].depth >= w->nodes[b].depth)
      a = w->nodes[a].parent;
    else
      b = w->nodes[b].parent;
  }
  return a;
}

/* The cycle runs from its top down to the source, over the new arc, and from the sink up again. It
 * takes flow from arcs above sources on the way down, and above sinks on the way up. */
static int32_t blocking(const network *w, int32_t source, int32_t sink, int32_t top,
                        int64_t *amount) {
  int32_t leaving = -1;
  *amount = INT64_MAX;
  for (int32_t i = source; i != top; i = w->nodes[i].parent)
    if (is_source(w, i) && w->nodes[i].flow < *amount) {
      *amount = w->nodes[i].flow;
      leaving = i;
    }
  for (int32_t i = sink; i != top; i = w->nodes[i].parent)
    if (!is_source(w, i) && w->nodes[i].flow <= *amount) {
      *amount = w->nodes[i].flow;
      leaving = i;
    }
  return leaving;
}

static int below(const network *w, int32_t i, int32_t top, int32_t wanted) {
  for (; i != top; i = w->nodes[i].parent)
    if (i == wanted) return 1;
  return 0;
}

static void pivot(network *w, int32_t source, int32_t sink) {
  const int32_t top = meeting(w, source, sink);
  int64_t amount;
  const int32_t leaving = blocking(w, source, sink, top, &amount);
  for (int32_t i = source; i != top; i = w->nodes[i].parent)
    w->nodes[i].flow += is_source(w, i) ? -amount : amount;
  for (int32_t i = sink; i != top; i = w->nodes[i].parent)
    w->nodes[i].flow += is_source(w, i) ? amount : -amount;
  if (below(w, source, top, leaving))
    move_part(w, leaving, source, sink, amount);
  else
    move_part(w, leaving, sink, source, amount);
}

/* ---- pricing ----------------------------------------------------------------------------- */

/* The sink of the least reduced cost in a row; -1 when none is below -tolerance. */
static int32_t best_of_row(const network *w, int32_t source) {
  const double *x = w->x + (int64_t)source * w->dim, u = w->nodes[source].price;
  double least = -w->tolerance;
  int32_t best = -1;
  for (int32_t j = 0; j < w->m; ++j) {
    const double reduced =
        distance(x, w->y + (int64_t)j * w->dim, w->dim) - u - w->nodes[w->n + j].price;
    if (reduced < least) {
      least = reduced;
      best = w->n + j;
    }
  }
  return best;
}

/* Rows in turn, one pivot a row, until all of them in sequence have nothing to offer. */
static sph_status improve(sph_context *ctx, network *w) {
  int64_t pivots = 0;
  int32_t idle = 0;
  for (int32_t row = 0; idle < w->n; row = row + 1 < w->n ? row + 1 : 0) {
    const int32_t sink = best_of_row(w, row);
    ++idle;
    if (sink < 0) continue;
    idle = 0;
    pivot(w, row, sink);
    if (++pivots % 1024 != 0) continue;
    const double done = (double)pivots / ((double)pivots + 4.0 * ((double)w->n + w->m));
    const sph_status s = sphi_progress(ctx, done, "the transport problem");
    if (s != SPH_OK) return s;
  }
  return SPH_OK;
}

/* ---- start ------------------------------------------------------------------------------- */

/* North-west corner rule: sources and sinks as they stand, each filling what is left of the other.
 * When both are exhausted at once the empty arc goes from the source to the next sink, that is
 * towards the root, the last sink. */
static void first_tree(network *w, const int64_t *supply, const int64_t *demand) {
  const int32_t nodes = w->n + w->m;
  int32_t i = 0, j = 0;
  int64_t left = supply[0], room = demand[0];
  for (int32_t k = 0; k < nodes; ++k)
    w->nodes[k] = (node){.parent = -1, .child = -1, .next = -1, .before = -1};
  while (i < w->n - 1 || j < w->m - 1) {
    const int64_t amount = left < room ? left : room;
    const int sink_done = j < w->m - 1 && room == amount;
    const int32_t done = sink_done ? w->n + j : i, other = sink_done ? i : w->n + j;
    left -= amount;
    room -= amount;
    hang(w, done, other);
    w->nodes[done].flow = amount;
    if (sink_done)
      room = demand[++j];
    else
      left = supply[++i];
  }
  hang(w, w->n - 1, nodes - 1);
  w->nodes[w->n - 1].flow = left;
  price_below(w, nodes - 1);
}

static double total_cost(const network *w) {
  double sum = 0.0, rest = 0.0; /* Neumaier */
  for (int32_t i = 0; i < w->n + w->m; ++i) {
    if (w->nodes[i].parent < 0) continue;
    const double term = (double)w->nodes[i].flow * tree_cost(w, i), next = sum + term;
    rest += fabs(sum) >= fabs(term) ? (sum - next) + term : (term - next) + sum;
    sum = next;
  }
  return sum + rest;
}

sph_status sphi_transport(sph_context *ctx, int32_t dim, const sphi_masses *from,
                          const sphi_masses *to, double *result) {
  network w = {.x = from->x, .y = to->x, .n = (int32_t)from->n, .m = (int32_t)to->n, .dim = dim};
  const size_t bytes = sphi_mul((size_t)(from->n + to->n), sizeof *w.nodes);
  w.nodes = sphi_alloc(ctx, bytes);
  if (!w.nodes) return SPH_ERR_NOMEM;
  /* A price is a sum along the tree of distances below 2, with so much rounding. */
  w.tolerance = 8.0 * DBL_EPSILON * sqrt((double)(from->n + to->n));
  first_tree(&w, from->units, to->units);
  const sph_status s = improve(ctx, &w);
  if (s == SPH_OK) *result = total_cost(&w);
  sphi_free(ctx, w.nodes, bytes);
  return s;
}
