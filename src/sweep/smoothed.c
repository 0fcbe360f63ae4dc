/* Packing for the sums with two smoothing lengths a pair, choice of the loop, and running it. */
#include "smoothed_run.h"

#include <string.h>

enum { PACK_GRAIN = 4096, ROW_GRAIN = 256, SCRATCH_RECORDS = 0 };

static const sphi_smoothed_loops *loops_of(const sph_context *ctx) {
  switch (sphi_isa(ctx)) {
  case SPH_ISA_AVX512:
    return &sphi_smoothed_avx512;
  case SPH_ISA_AVX2:
    return &sphi_smoothed_avx2;
  default:
    return &sphi_smoothed_portable;
  }
}

/* With equal masses MASS and NUMBER are one scheme: run as one, their bits are equal too. */
static int32_t plain_smoothing(const sph_operands *a, int32_t smoothing) {
  if (smoothing != SPH_SMOOTHING_NUMBER) return smoothing;
  for (int64_t i = 1; a->m && i < a->n; ++i)
    if (a->m[i] != a->m[0]) return smoothing;
  return SPH_SMOOTHING_MASS;
}

static sphi_smoothed_sweep sweep_of(sph_neighbors *list, const sphi_smoothed *s,
                                    sphi_smoothed_record layout) {
  sphi_smoothed_sweep run = {
      .s = s, .list = list, .layout = layout, .records = list->scratch[SCRATCH_RECORDS].ptr};
  for (int a = 0; a < 3; ++a) {
    run.period[a] = list->period[a];
    run.inverse_period[a] = run.period[a] > 0.0 ? 1.0 / run.period[a] : 0.0;
  }
  return run;
}

static sph_status reserve(sph_neighbors *list, int64_t n, int quads) {
  size_t bytes = sphi_mul((size_t)n, (size_t)quads * 4 * sizeof(double));
  return sphi_buffer_reserve(list->base.ctx, &list->scratch[SCRATCH_RECORDS], bytes);
}

/* ---- packing: host arrays, in host order, into records in sweep order -------------------------
 */

/* Q_i = m_i a_i P_i / (omega_i rho_i^2). */
static double pressure_of(const sphi_smoothed *s, int64_t i) {
  const sph_operands *a = s->a;
  double m = sphi_scalar_at(a->m, a->m0, i), rho = sphi_scalar_at(a->rho, a->rho0, i);
  double weight = m * sphi_smoothed_a(s->smoothing, m, rho);
  return weight * sphi_scalar_at(a->p, a->p0, i) /
         (sphi_scalar_at(a->omega, a->omega0, i) * rho * rho);
}

static void pack_dissipation(const sph_operands *a, const sphi_smoothed_record *y, int64_t i,
                             double *rec) {
  rec[y->m] = sphi_scalar_at(a->m, a->m0, i);
  rec[y->rho] = sphi_scalar_at(a->rho, a->rho0, i);
  rec[y->c] = sphi_scalar_at(a->c, a->c0, i);
  rec[y->p] = sphi_scalar_at(a->p, a->p0, i);
  rec[y->e] = sphi_scalar_at(a->e, a->e0, i);
}

static void pack_stress(const sph_operands *a, const sphi_smoothed_record *y, int64_t i,
                        double *rec) {
  const int n = a->dim * (a->dim + 1) / 2;
  double vol = sphi_scalar_at(a->m, a->m0, i) / sphi_scalar_at(a->rho, a->rho0, i);
  rec[y->vol] = vol;
  for (int c = 0; c < n; ++c) rec[y->t + c] = vol * a->sigma[i * n + c];
}

static void pack_one(const sphi_smoothed_sweep *run, int64_t i, double *rec) {
  const sphi_smoothed_record *y = &run->layout;
  const sph_operands *a = run->s->a;
  const int d = a->dim;
  for (int c = 0; c < d; ++c) rec[y->x + c] = a->x[i * d + c];
  if (y->v >= 0)
    for (int c = 0; c < d; ++c) rec[y->v + c] = a->v ? a->v[i * d + c] : 0.0;
  if (y->hi >= 0) rec[y->hi] = 1.0 / sphi_scalar_at(a->h, a->h0, i);
  if (y->b >= 0)
    rec[y->b] = sphi_smoothed_b(run->s->smoothing, sphi_scalar_at(a->m, a->m0, i),
                                sphi_scalar_at(a->rho, a->rho0, i));
  if (y->q >= 0) rec[y->q] = pressure_of(run->s, i);
  if (y->m >= 0) pack_dissipation(a, y, i, rec);
  if (y->t >= 0) pack_stress(a, y, i, rec);
}

static void pack_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const sphi_smoothed_sweep *run = job;
  (void)worker;
  for (int64_t k = lo; k < hi; ++k)
    pack_one(run, run->list->order[k], run->records + k * run->layout.quads * 4);
}

/* ---- running -----------------------------------------------------------------------------------
 */

typedef struct rows_job {
  const sphi_smoothed_sweep *run;
  sphi_smoothed_fn rows;
} rows_job;

static void rows_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const rows_job *j = job;
  (void)worker;
  j->rows(j->run, lo, hi);
}

static void run_rows(sphi_smoothed_sweep *run, sphi_smoothed_fn rows) {
  sph_context *ctx = run->list->base.ctx;
  rows_job job = {run, rows};
  sphi_parallel(ctx, run->s->a->n, PACK_GRAIN, pack_range, run);
  sphi_parallel(ctx, run->s->a->n, ROW_GRAIN, rows_range, &job);
}

static sphi_smoothed_fn choose(const sph_context *ctx, uint32_t terms, int32_t dim) {
  const sphi_smoothed_loops *loops = loops_of(ctx);
  switch (terms) {
  case SPHI_SMOOTHED_FLUID:
    return loops->fluid[dim - 1];
  case SPHI_SMOOTHED_GAS:
    return loops->gas[dim - 1];
  case SPHI_SMOOTHED_SOLID:
    return loops->solid[dim - 1];
  default:
    return loops->forces[dim - 1];
  }
}

sph_status sphi_smoothed_reserve(sph_neighbors *list, const sphi_smoothed *sweep) {
  return reserve(list, sweep->a->n, sphi_smoothed_record_of(sweep->terms, sweep->a->dim).quads);
}

sph_status sphi_smoothed_run(sph_neighbors *list, const sphi_smoothed *sweep) {
  sph_operands a = *sweep->a;
  sphi_smoothed own = *sweep;
  sph_status s = sphi_smoothed_reserve(list, sweep);
  if (s || a.n == 0) return s;
  if (!a.omega && a.omega0 == 0.0) a.omega0 = 1.0;
  own.a = &a;
  own.smoothing = plain_smoothing(&a, own.smoothing);
  sphi_smoothed_sweep run = sweep_of(list, &own, sphi_smoothed_record_of(own.terms, a.dim));
  run_rows(&run, choose(list->base.ctx, own.terms, a.dim));
  return SPH_OK;
}

sph_status sphi_smoothed_gather(sph_neighbors *list, const struct sph_kernel *kernel,
                                const sph_operands *a, int32_t smoothing, double floor,
                                double *density, double *omega) {
  sphi_smoothed own = {.smoothing = plain_smoothing(a, smoothing), .kernel = kernel, .a = a};
  sphi_smoothed_record layout = sphi_smoothed_gather_record(a->dim);
  sph_status s = reserve(list, a->n, layout.quads);
  if (s || a->n == 0) return s;
  sphi_smoothed_sweep run = sweep_of(list, &own, layout);
  run.floor = floor;
  run.density = density;
  run.omega = omega;
  run_rows(&run, loops_of(list->base.ctx)->gather[a->dim - 1]);
  return SPH_OK;
}
