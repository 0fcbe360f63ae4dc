/* Reading the input of a build: validation, extents, and the numbers behind the pair rule. */
#include "layout.h"

#include <float.h>
#include <math.h>

enum { GRAIN = 8192 };

typedef struct part {
  double lo[3], hi[3], h_min, h_max;
  int64_t bad;  /* lowest invalid particle */
  char pad[64]; /* parts of two workers share no cache line */
} part;

typedef struct scan {
  const sphi_input *in;
  part *parts;
} scan;

/* Also false for NaN. */
static int is_finite(double x) { return fabs(x) <= DBL_MAX; }

static int valid_h(double h) { return h > 0.0 && is_finite(h); }

static void scan_positions(const sphi_input *in, part *p, int64_t begin, int64_t end) {
  int dim = in->dim;
  for (int a = 0; a < dim; a++) {
    double lo = p->lo[a], hi = p->hi[a];
    for (int64_t i = begin; i < end; i++) {
      double x = in->x[i * dim + a];
      if (!is_finite(x) && i < p->bad) p->bad = i;
      lo = x < lo ? x : lo;
      hi = x > hi ? x : hi;
    }
    p->lo[a] = lo;
    p->hi[a] = hi;
  }
}

static void scan_lengths(const sphi_input *in, part *p, int64_t begin, int64_t end) {
  if (in->h == NULL) return;
  for (int64_t i = begin; i < end; i++) {
    double h = in->h[i];
    if (!valid_h(h) && i < p->bad) p->bad = i;
    p->h_min = h < p->h_min ? h : p->h_min;
    p->h_max = h > p->h_max ? h : p->h_max;
  }
}

static void scan_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  scan *s = job;
  enum { STRIP = 1024 }; /* so that the passes over the axes find x in the cache */
  for (int64_t b = begin; b < end; b += STRIP) {
    int64_t e = end - b < STRIP ? end : b + STRIP;
    scan_positions(s->in, &s->parts[worker], b, e);
    scan_lengths(s->in, &s->parts[worker], b, e);
  }
}

static sph_status refuse(sph_context *ctx, const sphi_input *in, int64_t i) {
  for (int a = 0; a < in->dim; a++) {
    double x = in->x[i * in->dim + a];
    if (!is_finite(x))
      return sphi_fail(ctx, SPH_ERR_ARG, "position component %d of particle %lld is %g", a,
                       (long long)i, x);
  }
  double h = in->h != NULL ? in->h[i] : in->h0;
  return sphi_fail(ctx, SPH_ERR_ARG,
                   "smoothing length of particle %lld is %g; it must be positive and finite",
                   (long long)i, h);
}

static void clear_part(part *p) {
  for (int a = 0; a < 3; a++) {
    p->lo[a] = INFINITY;
    p->hi[a] = -INFINITY;
  }
  p->h_min = INFINITY;
  p->h_max = 0.0;
  p->bad = INT64_MAX;
}

static int64_t merge_parts(sphi_input *in, const part *parts, int32_t count) {
  part all;
  clear_part(&all);
  for (int32_t w = 0; w < count; w++) {
    for (int a = 0; a < 3; a++) {
      all.lo[a] = fmin(all.lo[a], parts[w].lo[a]);
      all.hi[a] = fmax(all.hi[a], parts[w].hi[a]);
    }
    all.h_min = fmin(all.h_min, parts[w].h_min);
    all.h_max = fmax(all.h_max, parts[w].h_max);
    all.bad = parts[w].bad < all.bad ? parts[w].bad : all.bad;
  }
  for (int a = 0; a < 3; a++) {
    in->lo[a] = all.lo[a];
    in->hi[a] = all.hi[a];
  }
  in->h_min = in->h == NULL ? in->h0 : all.h_min;
  in->h_max = in->h == NULL ? in->h0 : all.h_max;
  return all.bad;
}

sph_status sphi_input_scan(sph_context *ctx, sphi_input *in, sphi_scratch *tmp) {
  int32_t workers = sphi_workers(ctx);
  sph_status status = sphi_buffer_reserve(ctx, &tmp->part, (size_t)workers * sizeof(part));
  if (status != SPH_OK) return status;
  part *parts = tmp->part.ptr;
  for (int32_t w = 0; w < workers; w++) clear_part(&parts[w]);
  if (in->n > 0 && in->h == NULL && !valid_h(in->h0)) parts[0].bad = 0;
  scan s = {in, parts};
  sphi_parallel(ctx, in->n, GRAIN, scan_body, &s);
  int64_t bad = merge_parts(in, parts, workers);
  return bad == INT64_MAX ? SPH_OK : refuse(ctx, in, bad);
}

double sphi_rule_s(const sphi_rule *r, double h) {
  if (r->h_rule == SPH_H_ARITHMETIC) return 0.5 * (r->support * h);
  if (r->h_rule == SPH_H_HARMONIC) return 1.0 / (r->support * h);
  return r->support * h;
}

void sphi_rule_set(sphi_rule *r, const sph_neighbors *list, const sphi_input *in) {
  const sph_neighbors_options *o = &list->options;
  r->dim = in->dim;
  r->h_rule = o->h_rule;
  r->support = o->support;
  r->skin = o->method == SPH_NEIGHBORS_VERLET ? o->skin : 0.0;
  r->uniform = in->n == 0 || in->h_min == in->h_max;
  r->cut = in->n == 0 ? r->skin : o->support * in->h_max + r->skin;
  r->periodic = r->far = 0;
  for (int a = 0; a < 3; a++) {
    int wraps = a < in->dim && list->period[a] > 0.0;
    r->period[a] = wraps ? list->period[a] : 0.0;
    r->inverse[a] = wraps ? 1.0 / list->period[a] : 0.0;
    r->periodic |= wraps;
    if (!wraps) continue;
    double away = fmax(fabs(in->lo[a] - o->box_lo[a]), fabs(in->hi[a] - o->box_lo[a]));
    r->far |= away > 1e7 * r->cut;
  }
}
