/* Dominant eigenvalue of the Jacobian J = dF/dU by power iteration, with differences in place of J:
 *
 *   J d ~ (F(U + a d) - F(U)) / a,  a so small that no entry moves by more than sqrt(DBL_EPSILON)
 *   of the size of its item, which is its largest value plus its largest change in one step.
 *
 * A plain power iteration gives |J d| / |d|, which for a pair of complex eigenvalues (waves) swings
 * for ever. Here the last two directions p, d with J p = s d span a plane; projecting J onto it
 * (Arnoldi with two vectors) gives J d ~ alpha p + beta d and the eigenvalues of
 * lambda^2 - beta lambda - s alpha = 0: a real one or a pair, with a residual that says how much
 * to believe.
 *
 * The norm. Items have different units, and a wave hands its energy from one to the other (velocity
 * and stress): in a norm that favours one of them J is far from normal, and the projection is
 * useless in every other iteration. So the weights come from two successive products: |d| |J d| of
 * an item is the square of its share in the mode, whatever the start was. From then on they stay,
 * so that items that do not take part fade.
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

/* Inner products of p, d and g = J d, of one item or of all with weights. */
typedef struct products {
  double pp, pd, dd, gp, gd, gg;
} products;

typedef struct power_iteration {
  sphi_step *step;
  const double *f0;
  double *d, *p, *g;
  double d_max; /* max |d| in units of the sizes */
  double s;     /* J p = s d */
  products item[SPHI_ITEMS_MAX];
  double weight[SPHI_ITEMS_MAX]; /* of a square */
  products all;
} power_iteration;

/* ---- sizes ------------------------------------------------------------------------------- */

static double *size_of(const power_iteration *w, int32_t k) { return &w->step->it->item[k].scale; }
static int32_t items_of(const power_iteration *w) { return w->step->it->items; }

/* An item that is zero and stays zero has no size yet: it is left out of the first direction and
 * gets a size from its first response. When all are zero, any size will do. */
static void set_sizes(power_iteration *w) {
  sph_integrator *it = w->step->it;
  double total = 0.0;
  for (int32_t k = 0; k < it->items; ++k) {
    double size = sphi_state_max(it, k, sphi_vector(it, SPHI_VEC_START));
    size += fabs(w->step->dt) * sphi_state_max(it, k, w->f0);
    *size_of(w, k) = size;
    total += size;
  }
  for (int32_t k = 0; k < it->items && total == 0.0; ++k) *size_of(w, k) = 1.0;
}

static double inverse(double x) { return x > 0.0 ? 1.0 / x : 0.0; }

/* ---- the first direction ----------------------------------------------------------------- */

/* -1 .. 1, never near 0; the finaliser of SplitMix64. */
static double hashed(int64_t i) {
  uint64_t z = ((uint64_t)i + 1) * UINT64_C(0x9e3779b97f4a7c15);
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  z ^= z >> 31;
  double size = 0.5 + 0.5 * (double)(z >> 11) * 0x1p-53;
  return (z & 1) ? size : -size;
}

typedef struct mix_job {
  double *d;
  int64_t offset;
  double keep, add; /* d = keep d + add hash */
} mix_job;

/* What is not kept is not read either: it may be garbage. */
static void mix_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  const mix_job *m = job;
  (void)worker;
  for (int64_t i = begin; i < end; ++i) {
    double kept = m->keep == 0.0 ? 0.0 : m->keep * m->d[i];
    m->d[i] = kept + m->add * hashed(m->offset + i);
  }
}

static void mix(power_iteration *w, double keep, double add) {
  sph_integrator *it = w->step->it;
  for (int32_t k = 0; k < it->items; ++k) {
    const sphi_item *item = &it->item[k];
    mix_job job = {w->d + item->offset, item->offset, item->scale > 0.0 ? keep : 0.0,
                   add * item->scale};
    if (item->n > 0) sphi_parallel(it->base.ctx, item->n, SPHI_STATE_GRAIN, mix_range, &job);
  }
}

static void square_range(void *job, int64_t begin, int64_t end, double out[4]) {
  const double *d = *(const double **)job;
  for (int64_t i = begin; i < end; ++i) {
    out[0] += d[i] * d[i];
    if (fabs(d[i]) > out[3]) out[3] = fabs(d[i]);
  }
}

/* d . d of each item, max |d|, and the sum of squares in units of the sizes. */
static double measure(power_iteration *w) {
  sph_integrator *it = w->step->it;
  double sum = 0.0, out[4];
  w->d_max = 0.0;
  for (int32_t k = 0; k < it->items; ++k) {
    const double *d = w->d + it->item[k].offset;
    double unit = inverse(*size_of(w, k));
    sphi_reduce(it->base.ctx, it->item[k].n, square_range, &d, out);
    w->item[k].dd = out[0];
    w->weight[k] = unit * unit;
    w->d_max = fmax(w->d_max, out[3] * unit);
    sum += out[0] * unit * unit;
  }
  return sum;
}

static double entries(const sph_integrator *it) {
  double n = 0.0;
  for (int32_t k = 0; k < it->items; ++k) n += (double)it->item[k].n;
  return n;
}

/* The kept direction with a little of the hash, or the hash alone. */
static void start_direction(power_iteration *w) {
  sph_integrator *it = w->step->it;
  double sum = it->memory.has_vector ? measure(w) : 0.0;
  if (sum > 0.0 && isfinite(sum))
    mix(w, 1.0, refresh * sqrt(sum / entries(it)));
  else
    mix(w, 0.0, 1.0);
  it->memory.has_vector = 0; /* until this estimate ends well */
}

static void prepare(power_iteration *w) {
  set_sizes(w);
  start_direction(w);
  sphi_state_copy(w->step->it, w->p, w->d); /* anything finite: not used in the first round */
  (void)measure(w);
}

/* ---- one product ------------------------------------------------------------------------- */

typedef struct product_job {
  double *g;
  const double *f0, *d, *p;
  double factor;
} product_job;

/* g = (g - f0) factor, and the products with g. */
static void product_range(void *job, int64_t begin, int64_t end, double out[4]) {
  const product_job *q = job;
  for (int64_t i = begin; i < end; ++i) {
    double g = (q->g[i] - q->f0[i]) * q->factor;
    q->g[i] = g;
    out[0] += g * g;
    out[1] += g * q->d[i];
    out[2] += g * q->p[i];
    if (fabs(g) > out[3]) out[3] = fabs(g);
  }
}

/* Returns max |g| in units of the sizes. */
static double multiply(power_iteration *w, double amplitude) {
  sph_integrator *it = w->step->it;
  double largest = 0.0, out[4];
  for (int32_t k = 0; k < it->items; ++k) {
    int64_t at = it->item[k].offset;
    product_job job = {w->g + at, w->f0 + at, w->d + at, w->p + at, 1.0 / amplitude};
    sphi_reduce(it->base.ctx, it->item[k].n, product_range, &job, out);
    w->item[k].gg = out[0];
    w->item[k].gd = out[1];
    w->item[k].gp = out[2];
    if (*size_of(w, k) == 0.0) *size_of(w, k) = fabs(w->step->dt) * out[3] / w->d_max;
    largest = fmax(largest, out[3] * inverse(*size_of(w, k)));
  }
  return largest;
}

static sph_status probe(power_iteration *w, double *g_max) {
  sph_integrator *it = w->step->it;
  double amplitude = sqrt(DBL_EPSILON) / w->d_max;
  sphi_combination c = {0, {0.0}, {NULL}};
  sphi_combination_add(&c, 1.0, sphi_vector(it, SPHI_VEC_START));
  sphi_combination_add(&c, amplitude, w->d);
  sphi_state_combine(it, NULL, &c); /* no filter: its derivative is not asked for */
  sphi_state_touch(it, w->step->set);
  sph_status status = sphi_evaluate(it, w->step->set, w->step->t, w->g);
  if (status == SPH_OK) *g_max = multiply(w, amplitude);
  return status;
}

/* ---- the plane --------------------------------------------------------------------------- */

static void set_weights(power_iteration *w) {
  for (int32_t k = 0; k < items_of(w); ++k) {
    double square = sqrt(w->item[k].dd) * sqrt(w->item[k].gg);
    if (square == 0.0) square = fmax(w->item[k].dd, w->item[k].gg);
    w->weight[k] = inverse(square);
  }
}

static void add_up(power_iteration *w) {
  products sum = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  for (int32_t k = 0; k < items_of(w); ++k) {
    const products *q = &w->item[k];
    double weight = w->weight[k];
    sum.pp += weight * q->pp;
    sum.pd += weight * q->pd;
    sum.dd += weight * q->dd;
    sum.gp += weight * q->gp;
    sum.gd += weight * q->gd;
    sum.gg += weight * q->gg;
  }
  w->all = sum;
}

static double residual(double gg, double rest) {
  return gg > 0.0 ? sqrt(fmax(rest, 0.0) / gg) : 0.0;
}

/* One direction only: the Rayleigh quotient. */
static sphi_eigen on_line(const products *q) {
  double lambda = q->dd > 0.0 ? q->gd / q->dd : 0.0;
  return (sphi_eigen){lambda, 0.0, residual(q->gg, q->gg - lambda * q->gd)};
}

/* The first product has no plane: the quotient of the norms with the sign of Rayleigh's. */
static sphi_eigen first_guess(const products *q) {
  sphi_eigen eigen = on_line(q);
  if (q->dd > 0.0) eigen.re = copysign(sqrt(q->gg / q->dd), eigen.re);
  return eigen;
}

/* Roots of lambda^2 - beta lambda - q = 0; of two real ones the larger in size, computed without
 * cancellation. */
static sphi_eigen dominant_root(double beta, double q, double rest) {
  double disc = 0.25 * beta * beta + q;
  if (disc < 0.0) return (sphi_eigen){0.5 * beta, sqrt(-disc), rest};
  return (sphi_eigen){0.5 * beta + copysign(sqrt(disc), beta), 0.0, rest};
}

static sphi_eigen in_plane(const products *q, double s) {
  double det = q->pp * q->dd - q->pd * q->pd;
  if (!(det > parallel * q->pp * q->dd)) return on_line(q);
  double alpha = (q->gp * q->dd - q->gd * q->pd) / det;
  double beta = (q->gd * q->pp - q->gp * q->pd) / det;
  double rest = residual(q->gg, q->gg - alpha * q->gp - beta * q->gd);
  return dominant_root(beta, s * alpha, rest);
}

static sphi_eigen judge(power_iteration *w, int32_t round) {
  if (round == 1) set_weights(w);
  add_up(w);
  return round == 0 ? first_guess(&w->all) : in_plane(&w->all, w->s);
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
    products *q = &w->item[k];
    advance_job job = {w->d + at, w->p + at, w->g + at, factor};
    if (it->item[k].n > 0)
      sphi_parallel(it->base.ctx, it->item[k].n, SPHI_STATE_GRAIN, advance_range, &job);
    *q = (products){q->dd, q->gd * factor, q->gg * factor * factor, 0.0, 0.0, 0.0};
  }
  w->s = g_max;
  w->d_max = 1.0;
}

double sphi_eigen_radius(const sphi_eigen *eigen) { return hypot(eigen->re, eigen->im); }

static sph_status iterate(power_iteration *w, int32_t iterations, sphi_eigen *eigen) {
  double old = -1.0, g_max = 0.0;
  for (int32_t round = 0; round < iterations; ++round) {
    sph_status status = probe(w, &g_max);
    if (status != SPH_OK) return status;
    *eigen = judge(w, round);
    double radius = sphi_eigen_radius(eigen);
    if (!isfinite(radius) || g_max == 0.0) return SPH_OK;
    if (round > 1 && fabs(radius - old) <= settled * radius) break;
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
  if (w.d_max == 0.0) return SPH_OK;
  *eigen = (sphi_eigen){NAN, NAN, NAN};
  if (!isfinite(w.d_max)) return SPH_OK;
  return iterate(&w, iterations, eigen);
}
