/* Host terms: the pairs of one particle are handed over in blocks, with geometry and kernel. */
#include "rhs_impl.h"

#include <math.h>
#include <string.h>

enum { BLOCK = 64, GRAIN = 128 };

typedef struct host_job {
  sphi_evaluation *e;
  const sphi_host_term *term;
  double *out;
  int32_t components;
} host_job;

typedef struct host_block {
  int32_t j[BLOCK];
  double dx[3 * BLOCK], r[BLOCK], w[BLOCK], f[BLOCK];
} host_block;

static double pair_h(int32_t rule, double a, double b) {
  switch (rule) {
  case SPH_H_HARMONIC:
    return 2.0 * a * b / (a + b);
  case SPH_H_MAX:
    return a > b ? a : b;
  case SPH_H_MIN:
    return a < b ? a : b;
  default:
    return 0.5 * (a + b);
  }
}

static void pair_kernel(const host_job *j, double r, double hi, double hj, double *w, double *f) {
  const sph_kernel *k = j->e->rhs->kernel;
  double dw;
  if (j->e->list->options.h_rule == SPH_H_AVERAGE) {
    *w = 0.5 * (sph_kernel_w(k, r, hi) + sph_kernel_w(k, r, hj));
    dw = 0.5 * (sph_kernel_dwdr(k, r, hi) + sph_kernel_dwdr(k, r, hj));
  } else {
    double h = pair_h(j->e->list->options.h_rule, hi, hj);
    *w = sph_kernel_w(k, r, h);
    dw = sph_kernel_dwdr(k, r, h);
  }
  *f = r > 0.0 ? dw / r : 0.0;
}

/* One pair into slot c; 0 when it lies beyond the support. */
static int fill_pair(const host_job *job, int64_t i, int64_t j, host_block *b, int c) {
  const sphi_evaluation *e = job->e;
  int32_t d = e->dim;
  double r2 = 0.0;
  for (int32_t a = 0; a < d; ++a) {
    double x = e->a.x[i * d + a] - e->a.x[j * d + a], box = e->list->period[a];
    if (box > 0.0) x -= box * nearbyint(x / box);
    b->dx[c * d + a] = x;
    r2 += x * x;
  }
  b->r[c] = sqrt(r2);
  b->j[c] = (int32_t)j;
  pair_kernel(job, b->r[c], e->a.h[i], e->a.h[j], &b->w[c], &b->f[c]);
  return b->w[c] != 0.0 || b->f[c] != 0.0;
}

static void hand_over(const host_job *job, int64_t i, const host_block *b, int count) {
  sph_pair_block block = {sizeof block, job->e->dim, count, i, b->j, b->dx, b->r, b->w, b->f};
  if (count > 0) job->term->fn(job->term->user, &block, job->out + i * job->components);
}

static void host_row(const host_job *job, int64_t k) {
  const sph_neighbors *list = job->e->list;
  int64_t i = list->order[k];
  host_block b;
  int count = 0;
  for (int64_t p = list->start[k]; p < list->start[k + 1]; ++p) {
    count += fill_pair(job, i, list->order[list->pair[p]], &b, count);
    if (count == BLOCK) {
      hand_over(job, i, &b, count);
      count = 0;
    }
  }
  hand_over(job, i, &b, count);
}

static void host_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const host_job *j = job;
  (void)worker;
  for (int64_t k = lo; k < hi; ++k)
    if (j->e->list->order[k] < j->e->rows) host_row(j, k);
}

/* Where a term adds to: a rate, or the velocity gradient that the materials are about to read. NULL
 * where nobody asks for it. */
static double *target_of(sphi_evaluation *e, int32_t field, int32_t *components) {
  if (field == SPH_TARGET_VELOCITY_GRADIENT) {
    *components = e->dim * e->dim;
    return sphi_term_wanted(e, SPH_TERM_STRESS_RATE) ? e->rhs->scratch[SPHI_RHS_GRADV].ptr : NULL;
  }
  *components = sph_particles_components(e->set, field);
  return sphi_rate_of(e, field);
}

sph_status sphi_rhs_host_terms(sphi_evaluation *e) {
  sph_rhs *rhs = e->rhs;
  for (int32_t k = 0; k < rhs->host_count; ++k) {
    host_job job = {.e = e, .term = &rhs->host[k]};
    job.out = target_of(e, rhs->host[k].field, &job.components);
    if (!job.out) continue;
    sphi_parallel(rhs->base.ctx, e->a.n, GRAIN, host_range, &job);
  }
  return SPH_OK;
}
