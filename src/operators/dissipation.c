/* Artificial viscosities and XSPH. */
#include "operators_impl.h"

#include <math.h>
#include <string.h>

sph_status sph_viscosity_monaghan(sph_neighbors *list, const sph_kernel *kernel,
                                  const sph_operands *a, double alpha, double beta, double *dvdt) {
  sph_operands own;
  uint32_t needs = SPHI_NEED_V | SPHI_NEED_M | SPHI_NEED_RHO | SPHI_NEED_C;
  sph_status s = sphi_operator_begin(list, kernel, a, needs, dvdt, "sph_viscosity_monaghan", &own);
  if (s) return s;
  if (!isfinite(alpha) || !isfinite(beta))
    return sphi_fail(list->base.ctx, SPH_ERR_ARG, "sph_viscosity_monaghan: alpha %g, beta %g",
                     alpha, beta);
  sphi_sweep sweep = sphi_sweep_of(kernel, &own, SPHI_MONAGHAN);
  sweep.alpha = alpha;
  sweep.beta = beta;
  sweep.dvdt = dvdt;
  return sphi_sweep_run(list, &sweep);
}

enum { GRAIN = 8192 };

typedef struct scale_job {
  double *out, factor;
} scale_job;

static void scale_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const scale_job *j = job;
  (void)worker;
  for (int64_t k = lo; k < hi; ++k) j->out[k] *= j->factor;
}

sph_status sph_xsph(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *a,
                    double epsilon, double *out) {
  sph_operands own;
  uint32_t needs = SPHI_NEED_V | SPHI_NEED_M | SPHI_NEED_RHO;
  sph_status s = sphi_operator_begin(list, kernel, a, needs, out, "sph_xsph", &own);
  if (s) return s;
  if (!isfinite(epsilon))
    return sphi_fail(list->base.ctx, SPH_ERR_ARG, "sph_xsph: epsilon %g", epsilon);
  sphi_sweep sweep = sphi_sweep_of(kernel, &own, SPHI_XSPH);
  sweep.xsph = out;
  s = sphi_sweep_run(list, &sweep);
  scale_job job = {out, epsilon};
  if (!s) sphi_parallel(list->base.ctx, own.rows * own.dim, GRAIN, scale_range, &job);
  return s;
}

void sph_bulk_viscosity_init_sized(sph_bulk_viscosity *options, size_t size) {
  if (!options || size < sizeof(size_t)) return;
  memset(options, 0, size);
  options->size = size;
}

double sphi_bulk_pressure(const sph_bulk_viscosity *o, double div, double h, double rho, double c) {
  if (!(div < 0.0)) return 0.0;
  double dx = o->spacing, d = -div;
  return o->neumann * dx * dx * rho * d * d + o->linear * dx * c * rho * d +
         o->hk_alpha * h * rho * c * d + o->hk_beta * h * h * rho * d * d;
}

static double scalar_at(const double *array, double uniform, int64_t i) {
  return array ? array[i] : uniform;
}

typedef struct bulk_job {
  const sph_operands *a;
  const sph_bulk_viscosity *o;
  const double *gradv;
  double *q;
} bulk_job;

/* Particles without a row have no velocity gradient: q = 0. */
static void bulk_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  const bulk_job *j = job;
  const sph_operands *a = j->a;
  int32_t d = a->dim;
  (void)worker;
  for (int64_t i = lo; i < hi; ++i) {
    double div = 0.0;
    for (int32_t k = 0; i < a->rows && k < d; ++k) div += j->gradv[i * d * d + k * d + k];
    j->q[i] = sphi_bulk_pressure(j->o, div, scalar_at(a->h, a->h0, i),
                                 scalar_at(a->rho, a->rho0, i), scalar_at(a->c, a->c0, i));
  }
}

sph_status sphi_bulk_pressures(sph_neighbors *list, const sph_kernel *kernel,
                               const sph_operands *own, const sph_bulk_viscosity *o, double *gradv,
                               double *q) {
  sphi_sweep sweep = sphi_sweep_of(kernel, own, SPHI_GRADV);
  bulk_job job = {own, o, gradv, q};
  sweep.gradv = gradv;
  sph_status s = sphi_sweep_run(list, &sweep);
  if (!s) sphi_parallel(list->base.ctx, own->n, GRAIN, bulk_range, &job);
  return s;
}

static sph_status check_bulk(sph_context *ctx, const sph_bulk_viscosity *o) {
  if (!isfinite(o->neumann) || !isfinite(o->linear) || !isfinite(o->hk_alpha) ||
      !isfinite(o->hk_beta) || !isfinite(o->spacing))
    return sphi_fail(ctx, SPH_ERR_ARG, "sph_viscosity_bulk: a coefficient is not finite");
  if ((o->neumann != 0.0 || o->linear != 0.0) && !(o->spacing > 0.0))
    return sphi_fail(ctx, SPH_ERR_ARG, "sph_viscosity_bulk: spacing %g", o->spacing);
  return SPH_OK;
}

enum { SCRATCH_GRADV = 1, SCRATCH_Q = 2 };

static sph_status run_bulk(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *own,
                           const sph_bulk_viscosity *o, double *q, double *dvdt) {
  sph_context *ctx = list->base.ctx;
  size_t n = (size_t)own->n, dd = (size_t)(own->dim * own->dim);
  sph_status s =
      sphi_buffer_reserve(ctx, &list->scratch[SCRATCH_GRADV], sphi_mul(n, dd * sizeof(double)));
  if (!s) s = sphi_buffer_reserve(ctx, &list->scratch[SCRATCH_Q], sphi_mul(n, sizeof(double)));
  if (s) return s;
  double *all = list->scratch[SCRATCH_Q].ptr;
  s = sphi_bulk_pressures(list, kernel, own, o, list->scratch[SCRATCH_GRADV].ptr, all);
  if (s) return s;
  sphi_sweep sweep = sphi_sweep_of(kernel, own, SPHI_BULK);
  sweep.q = all;
  sweep.dvdt = dvdt;
  s = sphi_sweep_run(list, &sweep);
  if (!s && q) memcpy(q, all, (size_t)own->rows * sizeof(double));
  return s;
}

sph_status sph_viscosity_bulk(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *a,
                              const sph_bulk_viscosity *options, double *q, double *dvdt) {
  sph_operands own;
  sph_bulk_viscosity o;
  uint32_t needs = SPHI_NEED_V | SPHI_NEED_M | SPHI_NEED_RHO;
  sph_bulk_viscosity_init(&o);
  sph_status s = sphi_operator_begin(list, kernel, a, needs, dvdt, "sph_viscosity_bulk", &own);
  if (!s && !options)
    s = sphi_fail(list->base.ctx, SPH_ERR_ARG, "sph_viscosity_bulk: the options are NULL");
  if (!s) s = sphi_options_read(list->base.ctx, &o, sizeof o, options);
  if (!s) s = check_bulk(list->base.ctx, &o);
  if (!s && own.n > 0 && (o.linear != 0.0 || o.hk_alpha != 0.0) && !own.c &&
      !(own.c0 > 0.0 && isfinite(own.c0)))
    s = sphi_fail(list->base.ctx, SPH_ERR_ARG, "sph_viscosity_bulk: c is NULL and c0 is %g",
                  own.c0);
  return s || own.n == 0 ? s : run_bulk(list, kernel, &own, &o, q, dvdt);
}
