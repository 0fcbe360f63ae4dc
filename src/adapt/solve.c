/* The smoothing length of one particle: the root of g(h) = S(h) - eta^d,
 *
 *   S(h) = h^d sum_j w_ij W(r_ij, h) = alpha sum_j w_ij w(r_ij / h),   w_ij = 1 or m_j / m_i,
 *
 * which rises with h wherever the kernel falls with r. In a continuum S grows like h^d, so Newton
 * runs in u = h^d: u <- u - g / (dS/du), with u dS/du = (h dS/dh) / d. From far away, too, one such
 * step comes near; it is bisected when it leaves the bracket or does not halve the miss. */
#include "adapt_impl.h"

#include <float.h>
#include <math.h>

enum { KEPT = 512 }; /* pairs of a row whose geometry is computed once, on the stack */

/* The row of one particle within its reach. */
typedef struct row {
  const sphi_adapt_job *job;
  int64_t k, count; /* count -1: too many to keep */
  double r[KEPT], weight[KEPT];
} row;

static double distance(const sphi_adapt_job *job, int64_t i, int64_t j) {
  const sph_neighbors *list = job->list;
  const double *a = job->x + i * job->dim, *b = job->x + j * job->dim;
  double square = 0.0;
  for (int32_t k = 0; k < job->dim; ++k) {
    double x = a[k] - b[k];
    if (list->period[k] > 0.0) x -= list->period[k] * nearbyint(x / list->period[k]);
    square += x * x;
  }
  return sqrt(square);
}

static double weight(const sphi_adapt_job *job, int64_t i, int64_t j) {
  return job->m ? job->m[j] / job->m[i] : 1.0;
}

/* Rows may hold particles from beyond the reach of i, but not all of them. */
static void fill(row *w, const sphi_adapt_job *job, int64_t k, double reach) {
  const sph_neighbors *list = job->list;
  const int64_t i = list->order[k];
  const double cut = job->kernel->support * reach;
  w->job = job;
  w->k = k;
  w->count = 0;
  for (int64_t p = list->start[k]; p < list->start[k + 1]; ++p) {
    const int64_t j = list->order[list->pair[p]];
    const double r = distance(job, i, j);
    if (r >= cut) continue;
    if (w->count == KEPT) {
      w->count = -1;
      return;
    }
    w->r[w->count] = r;
    w->weight[w->count++] = weight(job, i, j);
  }
}

static void add_pair(const sph_kernel *kernel, double q, double weight, double *s, double *t) {
  double w, dw;
  if (q >= kernel->support) return;
  sphi_kernel_profile(kernel, q, &w, &dw);
  *s += weight * w;
  *t -= weight * q * dw;
}

void sphi_adapt_sum(const sphi_adapt_job *job, int64_t k, double h, double *sum, double *slope) {
  const sph_neighbors *list = job->list;
  const int64_t i = list->order[k];
  double s = 0.0, t = 0.0;
  for (int64_t p = list->start[k]; p < list->start[k + 1]; ++p) {
    const int64_t j = list->order[list->pair[p]];
    add_pair(job->kernel, distance(job, i, j) / h, weight(job, i, j), &s, &t);
  }
  *sum = job->own + job->kernel->alpha * s;
  *slope = job->kernel->alpha * t;
}

/* The same sum, in the same order. */
static void sum_of_row(const row *w, double h, double *sum, double *slope) {
  double s = 0.0, t = 0.0;
  if (w->count < 0) {
    sphi_adapt_sum(w->job, w->k, h, sum, slope);
    return;
  }
  for (int64_t p = 0; p < w->count; ++p)
    add_pair(w->job->kernel, w->r[p] / h, w->weight[p], &s, &t);
  *sum = w->job->own + w->job->kernel->alpha * s;
  *slope = w->job->kernel->alpha * t;
}

/* ---- particles for which no h will do ---------------------------------------------------- */

/* S(0+): the particle itself and those at its place; *nearest is the least distance above 0. */
static double sum_at_zero(const sphi_adapt_job *job, int64_t k, double *nearest) {
  const sph_neighbors *list = job->list;
  const int64_t i = list->order[k];
  double s = 1.0;
  *nearest = INFINITY;
  for (int64_t p = list->start[k]; p < list->start[k + 1]; ++p) {
    const int64_t j = list->order[list->pair[p]];
    const double r = distance(job, i, j);
    if (r == 0.0)
      s += weight(job, i, j);
    else
      *nearest = fmin(*nearest, r);
  }
  return job->own * s;
}

/* S(infinity) <= eta^d: not even all particles at one place would do. */
static int32_t is_alone(const sphi_adapt_job *job, int64_t i) {
  return !job->periodic && job->own * job->total / (job->m ? job->m[i] : 1.0) <= job->target;
}

/* ---- one step ---------------------------------------------------------------------------- */

static double root(int32_t dim, double u) { return dim == 1 ? u : dim == 2 ? sqrt(u) : cbrt(u); }

static double middle(const sphi_adapt_particle *p) {
  if (p->high > 4.0 * p->low) return sqrt(p->low) * sqrt(p->high);
  return 0.5 * (p->low + p->high);
}

/* Where to look next. Without an upper bound the step at most doubles h: where only one neighbour
 * is near the edge of the support the slope says nothing. */
static double next_h(const sphi_adapt_job *job, const sphi_adapt_particle *p, double miss,
                     double slope) {
  const double factor = 1.0 - miss * job->dim / slope; /* of u */
  double h = slope > 0.0 && factor > 0.0 ? p->h * root(job->dim, factor) : NAN;
  if (isinf(p->high)) return h > p->h && h < 2.0 * p->h ? h : 2.0 * p->h;
  if (fabs(miss) > 0.5 * fabs(p->last_miss) || !(h > p->low && h < p->high)) h = middle(p);
  return h;
}

/* Whether h is where it stays; narrows the bracket. */
static int32_t settles(const sphi_adapt_job *job, sphi_adapt_particle *p, double miss) {
  const double most = fmin(job->h_max, job->box_h);
  if (fabs(miss) <= job->tolerance * job->target) {
    p->state = SPHI_ADAPT_SOLVED;
  } else if (miss < 0.0 && p->h >= most) {
    p->state = job->h_max <= job->box_h ? SPHI_ADAPT_BOUNDED : SPHI_ADAPT_BOX;
  } else if (miss > 0.0 && p->h <= job->h_min) {
    p->state = SPHI_ADAPT_BOUNDED;
  } else {
    if (miss < 0.0)
      p->low = fmax(p->low, p->h);
    else
      p->high = p->h;
    if (p->low >= (1.0 - 4.0 * DBL_EPSILON) * p->high) p->state = SPHI_ADAPT_JUMP;
  }
  return p->state != SPHI_ADAPT_ACTIVE;
}

static double bounded(const sphi_adapt_job *job, double h) {
  return fmin(fmax(h, job->h_min), fmin(job->h_max, job->box_h));
}

/* What can be said before any step: that no root exists, unless a bound takes its place; and where
 * the sum is still that of h = 0. */
static void prepare(const sphi_adapt_job *job, int64_t k, sphi_adapt_particle *p) {
  double nearest;
  const double least = sum_at_zero(job, k, &nearest);
  if (least >= job->target && job->h_min == 0.0) p->state = SPHI_ADAPT_COINCIDENT;
  if (is_alone(job, job->list->order[k]) && isinf(job->h_max)) p->state = SPHI_ADAPT_ALONE;
  if (least < job->target) /* nothing is nearer: the reach hides no one */
    p->low = fmax(p->low, fmin(nearest / job->kernel->support, p->reach));
  p->h = bounded(job, fmax(p->h, p->low));
}

void sphi_adapt_solve(const sphi_adapt_job *job, int64_t k) {
  sphi_adapt_particle *p = &job->particle[job->list->order[k]];
  row w;
  prepare(job, k, p);
  fill(&w, job, k, p->reach);
  while (p->state == SPHI_ADAPT_ACTIVE && p->h <= p->reach) {
    double slope;
    if (p->evaluations == job->max_evaluations) {
      p->state = SPHI_ADAPT_SPENT;
      return;
    }
    sum_of_row(&w, p->h, &p->sum, &slope);
    p->evaluations += 1;
    const double miss = p->sum - job->target;
    if (settles(job, p, miss)) return;
    p->h = bounded(job, next_h(job, p, miss, slope));
    p->last_miss = miss;
  }
}
