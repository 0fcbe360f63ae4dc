/* The handle: options, building, updating. */
#include "layout.h"

#include "../particles/particles_impl.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { GRAIN = 8192 };

static const int64_t most_particles = ((int64_t)1 << 31) - 64;

/* --- options --- */

void sph_neighbors_options_init_sized(sph_neighbors_options *options, size_t size) {
  sph_neighbors_options defaults;
  if (options == NULL || size < sizeof(size_t)) return;
  memset(&defaults, 0, sizeof defaults);
  defaults.method = SPH_NEIGHBORS_CELLS;
  defaults.h_rule = SPH_H_ARITHMETIC;
  defaults.support = 2.0;
  if (size > sizeof defaults) memset((char *)options + sizeof defaults, 0, size - sizeof defaults);
  memcpy(options, &defaults, size < sizeof defaults ? size : sizeof defaults);
  options->size = size;
}

static int is_finite(double x) { return fabs(x) <= DBL_MAX; }

static sph_status check_box(sph_context *ctx, const sph_neighbors_options *o) {
  for (int a = 0; a < 3; a++) {
    if (!o->periodic[a]) continue;
    if (!(o->box_hi[a] > o->box_lo[a]) || !is_finite(o->box_hi[a] - o->box_lo[a]))
      return sphi_fail(ctx, SPH_ERR_ARG, "periodic box of axis %d: lo = %g, hi = %g", a,
                       o->box_lo[a], o->box_hi[a]);
  }
  return SPH_OK;
}

static sph_status check_options(sph_context *ctx, const sph_neighbors_options *o) {
  if (o->method < SPH_NEIGHBORS_ALL_PAIRS || o->method > SPH_NEIGHBORS_TREE)
    return sphi_fail(ctx, SPH_ERR_ARG, "method %d is unknown", (int)o->method);
  if (o->h_rule < SPH_H_ARITHMETIC || o->h_rule > SPH_H_AVERAGE)
    return sphi_fail(ctx, SPH_ERR_ARG, "h_rule %d is unknown", (int)o->h_rule);
  if (!(o->support > 0.0) || !is_finite(o->support))
    return sphi_fail(ctx, SPH_ERR_ARG, "support is %g; it must be positive and finite", o->support);
  if (!(o->skin >= 0.0) || !is_finite(o->skin))
    return sphi_fail(ctx, SPH_ERR_ARG, "skin is %g; it must not be negative, and finite", o->skin);
  if (o->max_pairs < 0)
    return sphi_fail(ctx, SPH_ERR_ARG, "max_pairs is %lld", (long long)o->max_pairs);
  return check_box(ctx, o);
}

/* --- life --- */

static sph_neighbors *new_handle(sph_context *ctx, const sph_neighbors_options *o) {
  sph_neighbors *list = sphi_calloc(ctx, sizeof *list);
  if (list == NULL) return NULL;
  list->priv = sphi_calloc(ctx, sizeof *list->priv);
  if (list->priv == NULL) {
    sphi_free(ctx, list, sizeof *list);
    return NULL;
  }
  list->base.magic = SPHI_MAGIC_NEIGHBORS;
  list->base.ctx = ctx;
  list->options = *o;
  for (int a = 0; a < 3; a++) list->period[a] = o->periodic[a] ? o->box_hi[a] - o->box_lo[a] : 0.0;
  sphi_context_retain(ctx);
  return list;
}

sph_status sph_neighbors_create(sph_context *ctx, const sph_neighbors_options *options,
                                sph_neighbors **out) {
  sph_neighbors_options o;
  if (out != NULL) *out = NULL;
  sph_status status = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (status != SPH_OK) return status;
  if (out == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "out is NULL");
  sph_neighbors_options_init(&o);
  status = sphi_options_read(ctx, &o, sizeof o, options);
  if (status == SPH_OK) status = check_options(ctx, &o);
  if (status != SPH_OK) return status;
  *out = new_handle(ctx, &o);
  return *out != NULL ? SPH_OK : SPH_ERR_NOMEM;
}

static void free_buffers(sph_neighbors *list) {
  sph_context *ctx = list->base.ctx;
  struct sphi_neighbors_private *p = list->priv;
  sphi_buffer *all[] = {&p->scratch.key,    &p->scratch.histogram, &p->scratch.sample,
                        &p->scratch.record, &p->scratch.part,      &p->b_now,
                        &p->b_offsets,      &p->b_indices};
  for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) sphi_buffer_free(ctx, all[i]);
  for (size_t i = 0; i < sizeof list->scratch / sizeof list->scratch[0]; i++)
    sphi_buffer_free(ctx, &list->scratch[i]);
  sphi_layout_free(ctx, &p->layout[0]);
  sphi_layout_free(ctx, &p->layout[1]);
  sphi_pairs_free(ctx, &p->pairs);
}

void sph_neighbors_destroy(sph_neighbors *list) {
  if (list == NULL || list->base.magic != SPHI_MAGIC_NEIGHBORS) return;
  sph_context *ctx = list->base.ctx;
  free_buffers(list);
  sphi_free(ctx, list->priv, sizeof *list->priv);
  list->base.magic = 0;
  sphi_free(ctx, list, sizeof *list);
  sphi_context_release(ctx);
}

/* --- building --- */

static sph_status check_input(sph_context *ctx, const sphi_input *in) {
  if (in->dim < 1 || in->dim > 3)
    return sphi_fail(ctx, SPH_ERR_ARG, "dim is %d; it must be 1, 2 or 3", (int)in->dim);
  if (in->n < 0) return sphi_fail(ctx, SPH_ERR_ARG, "n is %lld", (long long)in->n);
  if (in->n > most_particles)
    return sphi_fail(ctx, SPH_ERR_LIMIT, "n is %lld; at most 2^31 - 64 particles are possible",
                     (long long)in->n);
  if (in->n > 0 && in->x == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "x is NULL");
  return SPH_OK;
}

/* Minimum images are unique only in boxes of two cutoffs. */
static sph_status check_periods(const sph_neighbors *list, const sphi_input *in) {
  sphi_rule rule;
  sphi_rule_set(&rule, list, in);
  for (int a = 0; a < in->dim && in->n > 0; a++) {
    if (rule.period[a] == 0.0) continue;
    double lo = list->options.box_lo[a], away = fmax(fabs(in->lo[a] - lo), fabs(in->hi[a] - lo));
    if (rule.period[a] < 2.0 * rule.cut)
      return sphi_fail(list->base.ctx, SPH_ERR_LIMIT,
                       "the periodic box of axis %d is %g wide, less than two cutoffs of %g", a,
                       rule.period[a], rule.cut);
    if (away > 1e9 * rule.period[a])
      return sphi_fail(list->base.ctx, SPH_ERR_LIMIT,
                       "a particle is %g away from the periodic box of axis %d, %g wide", away, a,
                       rule.period[a]);
  }
  return SPH_OK;
}

/* Make the next layout the present one. Never fails. */
static void commit(sph_neighbors *list) {
  struct sphi_neighbors_private *p = list->priv;
  sphi_layout old = p->layout[0];
  p->layout[0] = p->layout[1];
  p->layout[1] = old;
  const sphi_layout *l = &p->layout[0];
  list->dim = l->dim;
  list->n = l->n;
  list->order = l->order;
  list->start = l->start;
  list->h_uniform = l->h_uniform;
  list->h_max = l->h_max;
  for (int a = 0; a < 3; a++) p->now[a] = l->x[a];
  p->moved = 0.0;
  p->rows_valid = 0;
  p->set = NULL;
  list->builds++;
}

static sph_status build(sph_neighbors *list, sphi_input *in) {
  sph_context *ctx = list->base.ctx;
  struct sphi_neighbors_private *p = list->priv;
  sph_status s = check_input(ctx, in);
  if (s == SPH_OK) s = sphi_input_scan(ctx, in, &p->scratch);
  if (s == SPH_OK) s = check_periods(list, in);
  if (s == SPH_OK) s = sphi_layout_build(list, &p->layout[1], in, &p->scratch);
  if (s != SPH_OK) return s;
  s = sphi_fill(list, &p->layout[1]);
  /* The one array of pairs was being overwritten: what it held follows from the old layout. */
  if (s != SPH_OK && list->builds > 0) sphi_fill_again(list, &p->layout[0]);
  if (s == SPH_OK) commit(list);
  return s;
}

sph_status sph_neighbors_build_arrays(sph_neighbors *list, int32_t dim, int64_t n, const double *x,
                                      const double *h, double h0) {
  sph_status s = sphi_check_handle(NULL, list, SPHI_MAGIC_NEIGHBORS, "list");
  if (s != SPH_OK) return s;
  sphi_input in = {.dim = dim, .n = n, .x = x, .h = h, .h0 = h0};
  return build(list, &in);
}

/* --- particle sets --- */

static sph_status read_set(const sph_neighbors *list, const sph_particles *set, sphi_input *in) {
  sph_context *ctx = list->base.ctx;
  sph_status s = sphi_check_handle(ctx, set, SPHI_MAGIC_PARTICLES, "set");
  if (s != SPH_OK) return s;
  memset(in, 0, sizeof *in);
  in->dim = sph_particles_dim(set);
  in->n = sph_particles_count(set);
  in->x = sph_particles_field_const(set, SPH_FIELD_X);
  in->h = sph_particles_field_const(set, SPH_FIELD_H);
  in->h0 = 1.0;
  if (in->n > 0 && in->h == NULL)
    return sphi_fail(ctx, SPH_ERR_ARG, "the set has no field %s",
                     sphi_field_name(set, SPH_FIELD_H));
  return SPH_OK;
}

static void remember(struct sphi_neighbors_private *p, const sph_particles *set) {
  p->set = set;
  p->generation = sph_particles_generation(set);
  p->revision_x = sph_particles_revision(set, SPH_FIELD_X);
  p->revision_h = sph_particles_revision(set, SPH_FIELD_H);
}

static int is_remembered(const struct sphi_neighbors_private *p, const sph_particles *set) {
  return p->set == (const void *)set && p->generation == sph_particles_generation(set) &&
         p->revision_x == sph_particles_revision(set, SPH_FIELD_X) &&
         p->revision_h == sph_particles_revision(set, SPH_FIELD_H);
}

sph_status sph_neighbors_build(sph_neighbors *list, const sph_particles *set) {
  sphi_input in;
  sph_status s = sphi_check_handle(NULL, list, SPHI_MAGIC_NEIGHBORS, "list");
  if (s == SPH_OK) s = read_set(list, set, &in);
  if (s == SPH_OK) s = build(list, &in);
  if (s == SPH_OK) remember(list->priv, set);
  return s;
}

/* --- updating --- */

typedef struct move_job {
  const sphi_layout *l;
  const sphi_input *in;
  double *to[3];
  double *most; /* largest squared displacement, one a worker, 8 apart */
  int64_t differs;
} move_job;

static int same_h(const move_job *m, int64_t k) {
  const sphi_layout *l = m->l;
  double h = m->in->h != NULL ? m->in->h[l->order[k]] : m->in->h0;
  return l->s == NULL ? h == l->h_uniform : sphi_rule_s(&l->rule, h) == l->s[k];
}

/* Displacements since the build, and the new positions in sweep order. */
static void move_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  move_job *m = job;
  const sphi_layout *l = m->l;
  double most = m->most[worker * 8];
  for (int64_t k = begin; k < end; k++) {
    const double *x = m->in->x + (int64_t)l->order[k] * l->dim;
    double sum = 0.0;
    for (int a = 0; a < l->dim; a++) {
      double d = x[a] - l->x[a][k];
      sum += d * d;
      m->to[a][k] = x[a];
    }
    if (!(sum <= most)) most = sum <= DBL_MAX ? sum : INFINITY; /* NaN: rebuild, and complain */
    if (!same_h(m, k)) sphi_lowest(&m->differs, k);
  }
  m->most[worker * 8] = most;
}

static void swap_buffers(sphi_buffer *a, sphi_buffer *b) {
  sphi_buffer t = *a;
  *a = *b;
  *b = t;
}

/* Take over the positions that move_body() wrote into the next layout's array. */
static void accept_move(sph_neighbors *list, move_job *m, double moved) {
  struct sphi_neighbors_private *p = list->priv;
  swap_buffers(&p->b_now, &p->layout[1].b_x);
  for (int a = 0; a < 3; a++) p->now[a] = m->to[a];
  p->moved = moved;
  p->rows_valid = 0;
}

static sph_status measure(sph_neighbors *list, const sphi_input *in, move_job *m, double *moved) {
  struct sphi_neighbors_private *p = list->priv;
  sph_context *ctx = list->base.ctx;
  size_t stride = (size_t)in->n + SPHI_POSITION_PADDING, workers = (size_t)sphi_workers(ctx);
  sph_status s = sphi_buffer_reserve(ctx, &p->layout[1].b_x, stride * 3 * sizeof(double));
  if (s == SPH_OK) s = sphi_buffer_reserve(ctx, &p->scratch.sample, workers * 8 * sizeof(double));
  if (s != SPH_OK) return s;
  *m =
      (move_job){.l = &p->layout[0], .in = in, .most = p->scratch.sample.ptr, .differs = INT64_MAX};
  for (size_t a = 0; a < 3; a++) m->to[a] = (double *)p->layout[1].b_x.ptr + a * stride;
  for (size_t w = 0; w < workers; w++) m->most[w * 8] = 0.0;
  sphi_parallel(ctx, in->n, GRAIN, move_body, m);
  double most = 0.0;
  for (size_t w = 0; w < workers; w++) most = fmax(most, m->most[w * 8]);
  *moved = m->differs == INT64_MAX ? sqrt(most) : INFINITY;
  return SPH_OK;
}

/* Whether the list still serves for these positions; then they become the present ones. */
static sph_status reuse(sph_neighbors *list, const sphi_input *in, int *reused) {
  move_job m;
  double moved = INFINITY;
  double skin = list->priv->layout[0].rule.skin;
  *reused = 0;
  if (list->builds == 0 || in->dim != list->dim || in->n != list->n) return SPH_OK;
  sph_status s = measure(list, in, &m, &moved);
  if (s != SPH_OK || !(2.0 * moved <= skin)) return s;
  *reused = 1;
  if (moved > 0.0 || list->priv->moved > 0.0) accept_move(list, &m, moved);
  return SPH_OK;
}

static sph_status update(sph_neighbors *list, sphi_input *in, int32_t *rebuilt) {
  int reused;
  sph_status s = check_input(list->base.ctx, in);
  if (s == SPH_OK) s = reuse(list, in, &reused);
  if (s != SPH_OK) return s;
  if (!reused) s = build(list, in);
  if (s == SPH_OK && rebuilt != NULL) *rebuilt = !reused;
  return s;
}

sph_status sph_neighbors_update(sph_neighbors *list, const sph_particles *set, int32_t *rebuilt) {
  sphi_input in;
  sph_status s = sphi_check_handle(NULL, list, SPHI_MAGIC_NEIGHBORS, "list");
  if (s == SPH_OK) s = read_set(list, set, &in);
  if (s != SPH_OK) return s;
  struct sphi_neighbors_private *p = list->priv;
  if (list->builds > 0 && is_remembered(p, set)) {
    if (rebuilt != NULL) *rebuilt = 0;
    return SPH_OK;
  }
  int reusable = p->set == (const void *)set && p->generation == sph_particles_generation(set) &&
                 list->options.method == SPH_NEIGHBORS_VERLET;
  int32_t built = 1;
  s = reusable ? update(list, &in, &built) : build(list, &in);
  if (s != SPH_OK) return s;
  remember(p, set);
  if (rebuilt != NULL) *rebuilt = built;
  return SPH_OK;
}

sph_status sph_neighbors_update_arrays(sph_neighbors *list, int32_t dim, int64_t n, const double *x,
                                       const double *h, double h0, int32_t *rebuilt) {
  sph_status s = sphi_check_handle(NULL, list, SPHI_MAGIC_NEIGHBORS, "list");
  if (s != SPH_OK) return s;
  sphi_input in = {.dim = dim, .n = n, .x = x, .h = h, .h0 = h0};
  s = update(list, &in, rebuilt);
  if (s == SPH_OK) list->priv->set = NULL; /* the present positions are no set's */
  return s;
}

/* --- questions --- */

static int is_list(const sph_neighbors *list) {
  return list != NULL && list->base.magic == SPHI_MAGIC_NEIGHBORS;
}

int64_t sph_neighbors_count(const sph_neighbors *list) { return is_list(list) ? list->n : -1; }

int64_t sph_neighbors_pairs(const sph_neighbors *list) {
  if (!is_list(list)) return -1;
  return list->builds > 0 ? list->start[list->n] : 0;
}

int64_t sph_neighbors_builds(const sph_neighbors *list) {
  return is_list(list) ? list->builds : -1;
}

sph_status sphi_neighbors_check(const sph_neighbors *list, int32_t dim, int64_t n) {
  sph_context *ctx = list->base.ctx;
  if (list->builds == 0) return sphi_fail(ctx, SPH_ERR_STATE, "the neighbour list was never built");
  if (list->dim != dim || list->n != n)
    return sphi_fail(ctx, SPH_ERR_ARG,
                     "the neighbour list is of %lld particles in %d-D, not of %lld in %d-D",
                     (long long)list->n, (int)list->dim, (long long)n, (int)dim);
  return SPH_OK;
}
