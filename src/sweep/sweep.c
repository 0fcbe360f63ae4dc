/* Making a sweep ready and running it: uniform arrays are found, the instance and the record
 * layout chosen, records packed, rows run on the context's threads. */
#include "run.h"

#include <math.h>

enum { PACK_GRAIN = 4096, ROW_GRAIN = 512, SCRATCH_RECORDS = 0 };

static int is_uniform(const double *array, int64_t n) {
  if (!array) return 1;
  for (int64_t i = 1; i < n; ++i)
    if (array[i] != array[0]) return 0;
  return 1;
}

/* A field that no term reads counts as uniform, so that it takes no room. */
static uint32_t uniform_arrays(const sphi_sweep *s) {
  const sph_operands *a = s->a;
  uint32_t u = 0;
  if (!sphi_needs_m(s->spec) || is_uniform(a->m, a->n)) u |= SPHI_UNIFORM_M;
  if (is_uniform(a->h, a->n)) u |= SPHI_UNIFORM_H;
  if (!(s->spec.terms & SPHI_MONAGHAN) || is_uniform(a->c, a->n)) u |= SPHI_UNIFORM_C;
  return u;
}

static sphi_rows_fn choose_rows(sph_context *ctx, sphi_spec *spec, int32_t dim) {
  switch (sphi_isa(ctx)) {
  case SPH_ISA_AVX512:
    return sphi_rows_avx512(spec, dim);
  case SPH_ISA_AVX2:
    return sphi_rows_avx2(spec, dim);
  default:
    return sphi_rows_portable(spec, dim);
  }
}

sphi_artificial_fn sphi_artificial(int32_t isa) {
  switch (isa) {
  case SPH_ISA_AVX512:
    return sphi_artificial_avx512;
  case SPH_ISA_AVX2:
    return sphi_artificial_avx2;
  default:
    return sphi_artificial_portable;
  }
}

static void set_periods(sphi_run *run) {
  run->wrap = 0;
  for (int a = 0; a < 3; ++a) {
    run->period[a] = run->list->period[a];
    run->inverse_period[a] = run->period[a] > 0.0 ? 1.0 / run->period[a] : 0.0;
    if (run->period[a] > 0.0) run->wrap = 1;
  }
}

static void set_constants(sphi_run *run) {
  const sph_operands *a = run->sweep->a;
  run->m0 = a->m && a->n > 0 ? a->m[0] : a->m0;
  run->h0 = a->h && a->n > 0 ? a->h[0] : a->h0;
  run->c0 = a->c && a->n > 0 ? a->c[0] : a->c0;
  run->rows = a->rows;
  run->h_rule = run->list->options.h_rule;
}

static void pack_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  (void)worker;
  sphi_pack((const sphi_run *)job, lo, hi);
}

typedef struct rows_job {
  const sphi_run *run;
  sphi_rows_fn rows;
} rows_job;

static void rows_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const rows_job *j = job;
  (void)worker;
  j->rows(j->run, lo, hi);
}

sph_status sphi_sweep_run(sph_neighbors *list, const sphi_sweep *sweep) {
  sph_context *ctx = list->base.ctx;
  sphi_run run = {.sweep = sweep, .list = list, .spec = sweep->spec};
  rows_job job = {&run, NULL};
  sph_status status = sphi_neighbors_check(list, sweep->a->dim, sweep->a->n);
  if (status || sweep->a->n == 0) return status;
  run.spec.uniform = uniform_arrays(sweep);
  run.spec.corrected &= run.spec.terms;
  if (run.spec.stress == SPH_STRESS_CONSERVATIVE) run.spec.corrected &= ~(uint32_t)SPHI_STRESS;
  run.spec.width = sweep->f_count;
  job.rows = choose_rows(ctx, &run.spec, sweep->a->dim);
  run.layout = sphi_record_of(run.spec, sweep->a->dim);
  sphi_streams_of(&run);
  set_periods(&run);
  set_constants(&run);
  size_t bytes = sphi_mul((size_t)sweep->a->n, (size_t)run.layout.quads * 4 * sizeof(double));
  status = sphi_buffer_reserve(ctx, &list->scratch[SCRATCH_RECORDS], bytes);
  if (status) return status;
  run.records = list->scratch[SCRATCH_RECORDS].ptr;
  sphi_parallel(ctx, sweep->a->n, PACK_GRAIN, pack_range, &run);
  sphi_parallel(ctx, sweep->a->n, ROW_GRAIN, rows_range, &job);
  return SPH_OK;
}
