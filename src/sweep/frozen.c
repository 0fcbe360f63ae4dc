/* Packing for the frozen pair sums, choice of the loop, and running it. */
#include "frozen_run.h"

#include <string.h>

enum { PACK_GRAIN = 4096, ROW_GRAIN = 512 };

int64_t sphi_frozen_pairs(const struct sph_neighbors *list) {
  return list->start[list->n] + SPHI_ROW_PADDING;
}

int64_t sphi_frozen_scratch(int32_t dim, int64_t n) {
  const uint32_t everything = SPHI_FROZEN_PIOLA_ROW | SPHI_FROZEN_HOURGLASS | SPHI_FROZEN_VISCOSITY;
  return n * 4 * sphi_frozen_record_of(everything, 0, dim).quads;
}

static const sphi_frozen_loops *loops_of(const sph_context *ctx) {
  switch (sphi_isa(ctx)) {
  case SPH_ISA_AVX512:
    return &sphi_frozen_avx512;
  case SPH_ISA_AVX2:
    return &sphi_frozen_avx2;
  default:
    return &sphi_frozen_portable;
  }
}

static double scalar_at(const double *array, double uniform, int64_t i) {
  return array ? array[i] : uniform;
}

/* The modulus that the hourglass springs are measured with. */
static double stiffness_at(const sph_operands *a, int64_t i) {
  double c = scalar_at(a->c, a->c0, i);
  return scalar_at(a->rho, a->rho0, i) * c * c;
}

static sphi_frozen_run run_of(const sphi_frozen *z, double *scratch) {
  sphi_frozen_run run = {.z = z, .records = scratch, .rows = z->a->rows};
  for (int a = 0; a < 3; ++a) {
    run.period[a] = z->list->period[a];
    run.inverse_period[a] = run.period[a] > 0.0 ? 1.0 / run.period[a] : 0.0;
  }
  return run;
}

/* ---- packing: host arrays, in host order, into records in sweep order -------------------------
 */

static void pack_displacement(const sphi_frozen_run *run, const double *x, int64_t i, double *to) {
  const sph_operands *a = run->z->a;
  for (int32_t c = 0; c < a->dim; ++c) to[c] = x[i * a->dim + c] - a->x[i * a->dim + c];
}

static void pack_gradient(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const sphi_frozen_run *run = job;
  const sph_operands *a = run->z->a;
  int64_t d = a->dim;
  (void)worker;
  for (int64_t k = lo; k < hi; ++k) {
    int64_t i = run->z->list->order[k];
    double *rec = run->records + k * run->layout.quads * 4;
    for (int64_t c = 0; c < d; ++c) {
      rec[c] = a->x[i * d + c];
      rec[d + c] = run->f[i * d + c] - (run->minus ? run->minus[i * d + c] : 0.0);
    }
  }
}

static void pack_weights(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const sphi_frozen_run *run = job;
  const sphi_frozen_record *y = &run->layout;
  const sph_operands *a = run->z->a;
  (void)worker;
  for (int64_t k = lo; k < hi; ++k) {
    int64_t i = run->z->list->order[k];
    double *rec = run->records + k * y->quads * 4;
    for (int32_t c = 0; c < a->dim; ++c) rec[c] = a->x[i * a->dim + c];
    rec[y->h] = scalar_at(a->h, a->h0, i);
    rec[y->vol] = scalar_at(a->m, a->m0, i) / scalar_at(a->rho, a->rho0, i);
  }
}

/* P B^-1, or P. */
static void pack_stress(const sphi_frozen_run *run, int64_t i, double *to) {
  const int d = run->z->a->dim;
  const double *p = run->force->P + i * d * d, *b;
  if (run->force->terms & SPHI_FROZEN_PIOLA_ROW) {
    memcpy(to, p, (size_t)(d * d) * sizeof *to);
    return;
  }
  b = run->z->a->gradient_matrix + i * d * d;
  for (int r = 0; r < d; ++r)
    for (int c = 0; c < d; ++c) {
      double sum = 0.0;
      for (int k = 0; k < d; ++k) sum += p[r * d + k] * b[k * d + c];
      to[r * d + c] = sum;
    }
}

/* -(F - 1) E times half the coefficient, added. */
static void add_springs(const sphi_frozen_run *run, int64_t i, double *to) {
  const int d = run->z->a->dim;
  const double *f = run->force->F + i * d * d;
  double e = run->z->stiffness >= 0.0 ? run->z->stiffness : stiffness_at(run->z->a, i);
  double scale = -0.5 * run->force->hourglass * e;
  for (int k = 0; k < d * d; ++k) to[k] += scale * (f[k] - (k % (d + 1) == 0 ? 1.0 : 0.0));
}

static void pack_viscous(const sphi_frozen_run *run, int64_t i, double *rec) {
  const sphi_frozen_record *y = &run->layout;
  const sph_operands *a = run->z->a;
  for (int32_t c = 0; c < a->dim; ++c) rec[y->v + c] = run->force->v[i * a->dim + c];
  rec[y->rho] = scalar_at(a->rho, a->rho0, i);
  rec[y->c] = scalar_at(a->c, a->c0, i);
  rec[y->h] = scalar_at(a->h, a->h0, i);
}

static void pack_force(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const sphi_frozen_run *run = job;
  const sphi_frozen_record *y = &run->layout;
  const uint32_t stressed = SPHI_FROZEN_PIOLA | SPHI_FROZEN_PIOLA_ROW;
  const int dd = run->z->a->dim * run->z->a->dim;
  (void)worker;
  for (int64_t k = lo; k < hi; ++k) {
    int64_t i = run->z->list->order[k];
    double *rec = run->records + k * y->quads * 4;
    for (int32_t c = 0; c < run->z->a->dim; ++c) rec[c] = run->z->a->x[i * run->z->a->dim + c];
    if (y->u >= 0) pack_displacement(run, run->force->x, i, rec + y->u);
    if (y->t >= 0) memset(rec + y->t, 0, (size_t)dd * sizeof *rec);
    if (y->g >= 0) memset(rec + y->g, 0, (size_t)dd * sizeof *rec);
    if (run->force->terms & stressed) pack_stress(run, i, rec + y->t);
    if (y->g >= 0)
      add_springs(run, i, rec + y->g);
    else if (run->force->terms & SPHI_FROZEN_HOURGLASS)
      add_springs(run, i, rec + y->t);
    if (y->e >= 0) rec[y->e] = stiffness_at(run->z->a, i);
    if (y->v >= 0) pack_viscous(run, i, rec);
  }
}

/* ---- running -----------------------------------------------------------------------------------
 */

typedef struct rows_job {
  const sphi_frozen_run *run;
  sphi_frozen_fn rows;
} rows_job;

static void rows_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const rows_job *j = job;
  (void)worker;
  j->rows(j->run, lo, hi);
}

static void run_rows(sphi_frozen_run *run, sph_loop_fn pack, sphi_frozen_fn rows) {
  sph_context *ctx = run->z->list->base.ctx;
  rows_job job = {run, rows};
  sphi_parallel(ctx, run->z->a->n, PACK_GRAIN, pack, run);
  sphi_parallel(ctx, run->z->a->n, ROW_GRAIN, rows_range, &job);
}

static double uniform_stiffness(const sph_operands *a) {
  double e = stiffness_at(a, 0);
  for (int64_t i = 1; (a->rho || a->c) && i < a->n; ++i)
    if (stiffness_at(a, i) != e) return -1.0;
  return e;
}

void sphi_frozen_weights(sphi_frozen *z, double *scratch) {
  sphi_frozen_run run = run_of(z, scratch);
  int64_t last = z->list->start[z->list->n];
  run.layout = sphi_frozen_weight_record(z->a->dim);
  z->stiffness = z->a->n > 0 ? uniform_stiffness(z->a) : -1.0;
  run_rows(&run, pack_weights, loops_of(z->list->base.ctx)->weights[z->a->dim - 1]);
  memset(z->slope + last, 0, SPHI_ROW_PADDING * sizeof *z->slope);
  if (z->value) memset(z->value + last, 0, SPHI_ROW_PADDING * sizeof *z->value);
}

void sphi_frozen_gradient(const sphi_frozen *z, const double *f, const double *minus, int identity,
                          int64_t rows, double *scratch, double *out) {
  sphi_frozen_run run = run_of(z, scratch);
  run.layout = sphi_frozen_gradient_record(z->a->dim);
  run.f = f;
  run.minus = minus;
  run.identity = identity;
  run.rows = rows;
  run.out = out;
  run_rows(&run, pack_gradient, loops_of(z->list->base.ctx)->gradient[z->a->dim - 1]);
}

static sphi_frozen_fn choose_force(const sphi_frozen *z, uint32_t terms) {
  const sphi_frozen_loops *loops = loops_of(z->list->base.ctx);
  const int d = z->a->dim - 1;
  if (terms == SPHI_FROZEN_PIOLA) return loops->piola[d];
  if (terms == (SPHI_FROZEN_PIOLA | SPHI_FROZEN_HOURGLASS) && z->stiffness >= 0.0)
    return loops->controlled[d];
  return loops->force[d];
}

void sphi_frozen_add_force(const sphi_frozen *z, const sphi_frozen_force *force, double *scratch) {
  sphi_frozen_run run = run_of(z, scratch);
  run.force = force;
  run.e0 = z->stiffness;
  run.layout = sphi_frozen_record_of(force->terms, z->stiffness >= 0.0, z->a->dim);
  run_rows(&run, pack_force, choose_force(z, force->terms));
}
