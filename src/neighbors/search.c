/* The frame of a group, and the exact test. */
#include "search.h"

#include <float.h>
#include <math.h>

/* Box of the rows. On a periodic axis rows are first put on the side of the first one. */
static void box_of_rows(sphi_group *g, int axis) {
  const double *x = g->l->x[axis];
  const sphi_rule *rule = &g->l->rule;
  double origin = rule->period[axis] > 0.0 ? x[g->begin] : 0.0, lo = 0.0, hi = 0.0;
  for (int64_t i = g->begin; i < g->end; i++) {
    double d = x[i] - origin;
    if (rule->period[axis] > 0.0) d = sphi_wrap(d, rule->period[axis], rule->inverse[axis]);
    lo = i == g->begin || d < lo ? d : lo;
    hi = i == g->begin || d > hi ? d : hi;
  }
  double middle = 0.5 * lo + 0.5 * hi;
  g->center[axis] = origin + middle;
  g->half[axis] = fmax(hi - middle, middle - lo);
  g->half[axis] += 4.0 * DBL_EPSILON * (fabs(g->center[axis]) + fabs(origin));
}

static double bound_of_rows(const sphi_group *g) {
  const double *s = g->l->s;
  double bound = s[g->begin];
  for (int64_t i = g->begin + 1; i < g->end; i++) bound = sphi_rule_bound(&g->l->rule, bound, s[i]);
  return bound;
}

/* Whether the image nearest to the centre is the one nearest to every row. */
static int images_are_unique(const sphi_group *g, double reach) {
  const sphi_rule *rule = &g->l->rule;
  for (int a = 0; a < rule->dim; a++)
    if (rule->period[a] > 0.0 && 2.000001 * (g->half[a] + reach) > rule->period[a]) return 0;
  return 1;
}

/* Squares of lengths must stay well inside the range of single precision. */
static double set_precision(sphi_group *g) {
  const sphi_rule *rule = &g->l->rule;
  double size = 0.0;
  for (int a = 0; a < rule->dim; a++) size = fmax(size, g->half[a]);
  size += rule->cut;
  g->single = size > 1e-12 && size < 1e12 && !rule->far;
  g->narrow = rule->periodic && !images_are_unique(g, rule->cut);
  return size;
}

static void set_bounds(sphi_group *g, double size) {
  const sphi_rule *rule = &g->l->rule;
  double linear = SPHI_DOUBT_LINEAR * size, constant = SPHI_DOUBT_CONSTANT * size * size;
  double square = rule->cut * rule->cut;
  double doubt = linear * rule->cut + SPHI_DOUBT_SQUARE * square + constant;
  g->low = (float)(square - doubt);
  g->high = (float)(square + doubt);
  g->doubt_linear = (float)linear;
  g->doubt_constant = (float)constant;
  for (int a = 0; a < 3; a++) g->box[a] = (float)(g->half[a] * (1.0 + 1e-6) + 1e-6 * size);
  for (int a = 0; a < 3; a++) g->period[a] = (float)rule->period[a];
  g->skin = (float)rule->skin;
  g->s_group = (float)g->s;
}

void sphi_group_set(sphi_group *g, const sphi_layout *l, int64_t begin, int64_t end) {
  g->l = l;
  g->begin = begin;
  g->end = end;
  g->s = 0.0;
  for (int a = 0; a < 3; a++) g->center[a] = g->half[a] = 0.0;
  for (int a = 0; a < l->dim; a++) box_of_rows(g, a);
  if (!l->rule.uniform) g->s = bound_of_rows(g);
  double size = set_precision(g);
  if (g->single) set_bounds(g, size);
}

uint32_t sphi_exact_lanes(const sphi_layout *l, int64_t i, const uint32_t *index,
                          uint32_t doubtful) {
  uint32_t kept = 0;
  for (uint32_t left = doubtful; left != 0; left &= left - 1) {
    int lane = __builtin_ctz(left);
    if (sphi_is_pair(l, i, index[lane])) kept |= 1u << lane;
  }
  return kept;
}

static void gather_exact(const sphi_group *g, const sphi_range *r, int count, sphi_candidates *c) {
  (void)g;
  for (int k = 0; k < count; k++)
    for (uint32_t j = r[k].begin; j < r[k].end; j++) c->index[c->count++] = j;
}

static int64_t rows_exact(const sphi_group *g, sphi_candidates *c, uint32_t *out, int64_t capacity,
                          int64_t *used, int64_t *start) {
  for (int64_t i = g->begin; i < g->end; i++) {
    int64_t at = *used;
    if (at + c->count > capacity) return i - g->begin;
    start[i] = at;
    for (int64_t q = 0; q < c->count; q++) {
      out[at] = c->index[q];
      at += sphi_is_pair(g->l, i, c->index[q]);
    }
    *used = at;
  }
  return g->end - g->begin;
}

const sphi_search sphi_search_exact = {gather_exact, rows_exact, NULL};

const sphi_search *sphi_search_of(const sph_context *ctx) {
#if defined(__x86_64__)
  if (sphi_isa(ctx) == SPH_ISA_AVX512) return &sphi_search_avx512;
  if (sphi_isa(ctx) == SPH_ISA_AVX2) return &sphi_search_avx2;
#endif
  (void)ctx;
  return &sphi_search_portable;
}
