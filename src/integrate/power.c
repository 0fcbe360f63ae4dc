/* Dominant eigenvalue of the Jacobian J = dF/dU by power iteration, with differences in place of J:
 *
 *   J d ~ (F(U + a d) - F(U)) / a,  a so small that no entry moves by more than sqrt(DBL_EPSILON)
 *   of the size of its item.
 *
 * Fields of one state have different units. The norm divides each item by its own size, which is
 * its largest value plus its largest change in one step.
 *
 * A plain power iteration gives |J d| / |d|, which for a pair of complex eigenvalues (waves) swings
 * for ever. Here the last two directions p, d with J p = s d span a plane; projecting J onto it
 * (Arnoldi with two vectors) gives J d ~ alpha p + beta d and the eigenvalues of
 * lambda^2 - beta lambda - s alpha = 0: a real one or a pair, with a residual that says how much
 * to believe.
 *
 * The first direction holds every frequency: signs and sizes from a hash of the index. A smooth
 * start such as F(U) is blind to the modes that matter. The last direction is kept for the next
 * estimate, with some of the hash mixed in, lest the iteration stays with a mode that has ceased to
 * dominate. */
#include "integrate_impl.h"

#include <float.h>
#include <math.h>

static const double refresh = 0.05;   /* share of the hash in a kept direction, root mean square */
static const double settled = 5e-3;   /* relative change of the radius that ends the iteration */
static const double parallel = 1e-10; /* sin^2 of p and d below which they are one direction */

typedef struct power_iteration {
  sphi_step *step;
  const double *f0;
  double *d, *p, *g; /* direction, the one before, J d */
  double d_max;      /* max |d| in units of the sizes */
  double s;          /* J p = s d */
  double pp, pd, dd; /* inner products */
  double gp, gd, gg;
} power_iteration;

/* ---- sizes and the first direction ------------------------------------------------------- */

/* An item that is zero and stays zero gets size 1: it cannot be told from data. */
static void set_scales(power_iteration *w) {
  sph_integrator *it = w->step->it;
  for (int32_t k = 0; k < it->items; ++k) {
    double size = sphi_state_max(it, k, sphi_vector(it, SPHI_VEC_START));
    size += fabs(w->step->dt) * sphi_state_max(it, k, w->f0);
    it->item[k].scale = size > 0.0 ? size : 1.0;
  }
}

/* -1 .. 1, never near 0; the finaliser of SplitMix64. */
static double hashed(int64_t i) {
  uint64_t z = ((uint64_t)i + 1) * UINT64_C(0x9e3779b97f4a7c15);
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  z ^= z >> 31;
  double size = 0.5 + 0.5 * (double)(z >> 11) * 0x1p-53;
  return (z & 1) ? size : -size;
}

typedef struct start_job {
  double *d;
  int64_t offset;
  double keep, add; /* d = keep d + add hash */
} start_job;

static void start_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  start_job *s = job;
  (void)worker;
  for (int64_t i = begin; i < end; ++i) {
    double kept = s->keep == 0.0 ? 0.0 : s->keep * s->d[i];
    s->d[i] = kept + s->add * hashed(s->offset + i);
  }
}

/* ---- one product ------------------------------------------------------------------------- */

typedef struct product_job {
  double *g;
  const double *f0, *d, *p;
  double factor, weight;
} product_job;

/* g = (g - f0) factor, and the products with g. */
static void product_range(void *job, int64_t begin, int64_t end, double out[4]) {
  const product_job *q = job;
  double largest = 0.0;
  for (int64_t i = begin; i < end; ++i) {
    double g = (q->g[i] - q->f0[i]) * q->factor;
    double scaled = g * q->weight;
    q->g[i] = g;
    out[0] += scaled * scaled;
    out[1] += scaled * (q->d[i] * q->weight);
    out[2] += scaled * (q->p[i] * q->weight);
    if (fabs(scaled) > largest) largest = fabs(scaled);
  }
  out[3] = largest;
}

/* |d|^2 and max |d|, for the first direction. */
static void size_range(void *job, int64_t begin, int64_t end, double out[4]) {
  const product_job *q = job;
  double largest = 0.0;
  for (int64_t i = begin; i < end; ++i) {
    double scaled = q->d[i] * q->weight;
    out[0] += scaled * scaled;
    if (fabs(scaled) > largest) largest = fabs(scaled);
  }
  out[3] = largest;
}

/* Reduce over all items: sums in the order of the items. */
static void reduce_items(power_iteration *w, sphi_reduce_fn fn, double factor, double out[4]) {
  sph_integrator *it = w->step->it;
  for (int32_t m = 0; m < 4; ++m) out[m] = 0.0;
  for (int32_t k = 0; k < it->items; ++k) {
    int64_t at = it->item[k].offset;
    product_job job = {w->g + at, w->f0 + at, w->d + at,
                       w->p + at, factor,     1.0 / it->item[k].scale};
    double part[4];
    sphi_reduce(it->base.ctx, it->item[k].n, fn, &job, part);
    for (int32_t m = 0; m < 3; ++m) out[m] += part[m];
    if (part[3] > out[3]) out[3] = part[3];
  }
}

static sph_status probe(power_iteration *w, double *g_max) {
  sph_integrator *it = w->step->it;
  double amplitude = sqrt(DBL_EPSILON) / w->d_max, out[4];
  sphi_combination c = {0, {0.0}, {NULL}};
  sphi_combination_add(&c, 1.0, sphi_vector(it, SPHI_VEC_START));
  sphi_combination_add(&c, amplitude, w->d);
  sphi_write_stage(w->step, &c);
  sph_status status = sphi_evaluate(it, w->step->set, w->step->t, w->g);
  if (status != SPH_OK) return status;
  reduce_items(w, product_range, 1.0 / amplitude, out);
  w->gg = out[0];
  w->gd = out[1];
  w->gp = out[2];
  *g_max = out[3];
  return SPH_OK;
}

/* ---- the plane --------------------------------------------------------------------------- */

static double residual(double gg, double rest) {
  return gg > 0.0 ? sqrt(fmax(rest, 0.0) / gg) : 0.0;
}

/* One direction only: the Rayleigh quotient. */
static sphi_eigen on_line(const power_iteration *w) {
  double lambda = w->gd / w->dd;
  return (sphi_eigen){lambda, 0.0, residual(w->gg, w->gg - lambda * w->gd)};
}

/* Roots of lambda^2 - beta lambda - q = 0; of two real ones the larger in size, computed without
 * cancellation. */
static sphi_eigen dominant_root(double beta, double q, double rest) {
  double disc = 0.25 * beta * beta + q;
  if (disc < 0.0) return (sphi_eigen){0.5 * beta, sqrt(-disc), rest};
  return (sphi_eigen){0.5 * beta + copysign(sqrt(disc), beta), 0.0, rest};
}

static sphi_eigen in_plane(const power_iteration *w) {
  double det = w->pp * w->dd - w->pd * w->pd;
  if (!(det > parallel * w->pp * w->dd)) return on_line(w);
  double alpha = (w->gp * w->dd - w->gd * w->pd) / det;
  double beta = (w->gd * w->pp - w->gp * w->pd) / det;
  double rest = residual(w->gg, w->gg - alpha * w->gp - beta * w->gd);
  return dominant_root(beta, w->s * alpha, rest);
}

/* ---- the iteration ----------------------------------------------------------------------- */

typedef struct advance_job {
  double *d, *p;
  const double *g;
  double factor;
} advance_job;

static void advance_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  const advance_job *a = job;
  (void)worker;
  for (int64_t i = begin; i < end; ++i) {
    a->p[i] = a->d[i];
    a->d[i] = a->g[i] * a->factor;
  }
}

/* p = d, d = J d / max |J d|; the products follow without another pass. */
static void advance(power_iteration *w, double g_max) {
  sph_integrator *it = w->step->it;
  double factor = 1.0 / g_max;
  for (int32_t k = 0; k < it->items; ++k) {
    int64_t at = it->item[k].offset;
    advance_job job = {w->d + at, w->p + at, w->g + at, factor};
    if (it->item[k].n > 0)
      sphi_parallel(it->base.ctx, it->item[k].n, SPHI_STATE_GRAIN, advance_range, &job);
  }
  w->pp = w->dd;
  w->pd = w->gd * factor;
  w->dd = w->gg * factor * factor;
  w->s = g_max;
  w->d_max = 1.0;
}

/* d = keep d + add * hash */
static void mix(power_iteration *w, double keep, double add) {
  sph_integrator *it = w->step->it;
  for (int32_t k = 0; k < it->items; ++k) {
    sphi_item *item = &it->item[k];
    start_job job = {w->d + item->offset, item->offset, keep, add * item->scale};
    if (item->n > 0) sphi_parallel(it->base.ctx, item->n, SPHI_STATE_GRAIN, start_range, &job);
  }
}

static void measure(power_iteration *w) {
  double out[4];
  reduce_items(w, size_range, 1.0, out);
  w->dd = out[0];
  w->d_max = out[3];
}

static double entries(const sph_integrator *it) {
  double n = 0.0;
  for (int32_t k = 0; k < it->items; ++k) n += (double)it->item[k].n;
  return n;
}

/* The kept direction with a little of the hash, or the hash alone. */
static void start_direction(power_iteration *w) {
  sph_integrator *it = w->step->it;
  w->dd = 0.0;
  if (it->memory.has_vector) measure(w);
  if (w->dd > 0.0)
    mix(w, 1.0, refresh * sqrt(w->dd / entries(it)));
  else
    mix(w, 0.0, 1.0);
  it->memory.has_vector = 0; /* until this estimate ends well */
}

static void prepare(power_iteration *w) {
  set_scales(w);
  start_direction(w);
  sphi_state_copy(w->step->it, w->p, w->d); /* anything finite: not used in the first round */
  measure(w);
}

double sphi_eigen_radius(const sphi_eigen *eigen) { return hypot(eigen->re, eigen->im); }

static sph_status iterate(power_iteration *w, int32_t iterations, sphi_eigen *eigen) {
  double old = -1.0, g_max = 0.0;
  for (int32_t m = 0; m < iterations; ++m) {
    sph_status status = probe(w, &g_max);
    if (status != SPH_OK) return status;
    *eigen = m == 0 ? on_line(w) : in_plane(w);
    if (m == 0) eigen->re = copysign(sqrt(w->gg / w->dd), eigen->re);
    double radius = sphi_eigen_radius(eigen);
    if (!isfinite(radius) || g_max == 0.0) return SPH_OK;
    if (m > 1 && fabs(radius - old) <= settled * radius) break;
    old = radius;
    advance(w, g_max);
  }
  w->step->it->memory.has_vector = 1;
  return SPH_OK;
}

/* An empty state has no modes. */
sph_status sphi_power_estimate(sphi_step *step, const double *f0, int32_t iterations,
                               sphi_eigen *eigen) {
  sph_integrator *it = step->it;
  power_iteration w = {.step = step,
                       .f0 = f0,
                       .d = sphi_vector_eigen(it),
                       .p = sphi_vector_previous(it),
                       .g = sphi_vector_probe(it)};
  *eigen = (sphi_eigen){0.0, 0.0, 0.0};
  prepare(&w);
  if (w.dd == 0.0) return SPH_OK;
  *eigen = (sphi_eigen){NAN, NAN, NAN};
  if (!isfinite(w.d_max)) return SPH_OK;
  return iterate(&w, iterations, eigen);
}
