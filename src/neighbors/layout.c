/* Memory of a layout, and the copy of positions in sweep order. */
#include "layout.h"

#include <string.h>

enum { GRAIN = 8192 };

typedef struct copy_job {
  sphi_layout *l;
  const sphi_input *in;
} copy_job;

sph_status sphi_layout_reserve(sph_context *ctx, sphi_layout *l, const sphi_input *in) {
  size_t n = (size_t)in->n;
  size_t stride = n + SPHI_POSITION_PADDING;
  sph_status s = sphi_buffer_reserve(ctx, &l->b_order, sphi_mul(n + 1, sizeof(uint32_t)));
  if (s == SPH_OK) s = sphi_buffer_reserve(ctx, &l->b_start, sphi_mul(n + 1, sizeof(int64_t)));
  if (s == SPH_OK) s = sphi_buffer_reserve(ctx, &l->b_x, sphi_mul(stride * 3, sizeof(double)));
  if (s == SPH_OK && !l->rule.uniform)
    s = sphi_buffer_reserve(ctx, &l->b_s, sphi_mul(stride, sizeof(double)));
  if (s != SPH_OK) return s;
  l->order = l->b_order.ptr;
  l->start = l->b_start.ptr;
  for (size_t a = 0; a < 3; a++) l->x[a] = (double *)l->b_x.ptr + a * stride;
  l->s = l->rule.uniform ? NULL : l->b_s.ptr;
  return SPH_OK;
}

void sphi_layout_free(sph_context *ctx, sphi_layout *l) {
  sphi_buffer *all[] = {&l->b_order, &l->b_start, &l->b_x,     &l->b_s,
                        &l->b_table, &l->b_first, &l->b_nodes, &l->b_leaf};
  for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) sphi_buffer_free(ctx, all[i]);
}

static void copy_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  copy_job *c = job;
  sphi_layout *l = c->l;
  const uint32_t *order = l->order;
  int64_t dim = l->dim;
  (void)worker;
  for (int64_t k = begin; k < end; k++) {
    const double *x = c->in->x + order[k] * dim;
    l->x[0][k] = x[0];
    if (dim > 1) l->x[1][k] = x[1];
    if (dim > 2) l->x[2][k] = x[2];
  }
  if (l->s == NULL) return;
  for (int64_t k = begin; k < end; k++) l->s[k] = sphi_rule_s(&l->rule, c->in->h[order[k]]);
}

static void pad_positions(sphi_layout *l) {
  size_t n = (size_t)l->n;
  for (int a = 0; a < 3; a++) memset(l->x[a] + n, 0, SPHI_POSITION_PADDING * sizeof(double));
  if (l->s != NULL) memset(l->s + n, 0, SPHI_POSITION_PADDING * sizeof(double));
}

static void identity_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  const sphi_layout *l = job;
  (void)worker;
  for (int64_t k = begin; k < end; k++) l->order[k] = (uint32_t)k;
}

/* The order first: cells and the tree sort, all pairs keep the host's order. */
static sph_status make_order(const sph_neighbors *list, sphi_layout *l, const sphi_input *in,
                             sphi_scratch *tmp) {
  sph_context *ctx = list->base.ctx;
  if (l->method == SPH_NEIGHBORS_TREE) return sphi_tree_build(ctx, l, in, tmp);
  if (l->method != SPH_NEIGHBORS_ALL_PAIRS)
    return sphi_cells_build(ctx, l, in, &list->options, tmp);
  sphi_parallel(ctx, l->n, GRAIN, identity_body, l);
  return SPH_OK;
}

sph_status sphi_layout_build(const sph_neighbors *list, sphi_layout *l, const sphi_input *in,
                             sphi_scratch *tmp) {
  sph_context *ctx = list->base.ctx;
  l->method = list->options.method;
  l->dim = in->dim;
  l->n = in->n;
  l->h_max = in->n > 0 ? in->h_max : 0.0;
  l->h_uniform = in->n > 0 && in->h_min == in->h_max ? in->h_max : 0.0;
  sphi_rule_set(&l->rule, list, in);
  sph_status s = sphi_layout_reserve(ctx, l, in);
  if (s == SPH_OK) s = make_order(list, l, in, tmp);
  if (s != SPH_OK) return s;
  copy_job job = {l, in};
  sphi_parallel(ctx, l->n, GRAIN, copy_body, &job);
  pad_positions(l);
  return SPH_OK;
}
