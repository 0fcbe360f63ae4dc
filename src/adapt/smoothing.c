/* Laws for the smoothing length: He (6.1) to (6.3), Zisis (4.2). */
#include "../core/core.h"

#include <sph/adapt.h>

#include <math.h>

enum { GRAIN = 4096 };

/* What one law reads and writes; unused inputs are NULL. */
typedef struct law {
  int64_t n;
  int32_t dim;
  double ratio;
  const double *h, *m, *rho0, *rho, *drho, *spacing;
  double *out;
  int64_t bad; /* lowest index with an input out of range */
} law;

static int positive(double x) { return isfinite(x) && x > 0.0; }

/* x^(1/d). */
static double root(int32_t dim, double x) { return dim == 1 ? x : dim == 2 ? sqrt(x) : cbrt(x); }

static int fine(const law *l, int64_t i) {
  const double *const wanted[] = {l->h, l->m, l->rho0, l->rho, l->spacing};
  for (int k = 0; k < 5; ++k)
    if (wanted[k] && !positive(wanted[k][i])) return 0;
  return !l->drho || isfinite(l->drho[i]);
}

static void check_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  law *l = job;
  (void)worker;
  for (int64_t i = begin; i < end; ++i)
    if (!fine(l, i)) {
      sphi_lowest(&l->bad, i);
      return;
    }
}

static void density_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  const law *l = job;
  (void)worker;
  for (int64_t i = begin; i < end; ++i) l->out[i] = l->h[i] * root(l->dim, l->rho0[i] / l->rho[i]);
}

static void mass_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  const law *l = job;
  (void)worker;
  for (int64_t i = begin; i < end; ++i) l->out[i] = l->ratio * root(l->dim, l->m[i] / l->rho[i]);
}

static void rate_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  const law *l = job;
  (void)worker;
  for (int64_t i = begin; i < end; ++i)
    l->out[i] = -l->h[i] * l->drho[i] / ((double)l->dim * l->rho[i]);
}

static void spacing_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  const law *l = job;
  (void)worker;
  for (int64_t i = begin; i < end; ++i) l->out[i] = l->ratio * l->spacing[i];
}

static sph_status check_shape(sph_context *ctx, const char *name, const law *l, int complete) {
  sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (s) return s;
  if (l->n < 0 || l->dim < 1 || l->dim > 3)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: n = %lld, dim = %d", name, (long long)l->n,
                     (int)l->dim);
  if (l->n > 0 && !complete) return sphi_fail(ctx, SPH_ERR_ARG, "%s: an array is NULL", name);
  return SPH_OK;
}

static double value(const double *array, int64_t i) { return array ? array[i] : NAN; }

static sph_status run(sph_context *ctx, const char *name, law *l, sph_loop_fn body) {
  l->bad = INT64_MAX;
  sphi_parallel(ctx, l->n, GRAIN, check_range, l);
  if (l->bad != INT64_MAX)
    return sphi_fail(ctx, SPH_ERR_NUMERIC,
                     "%s: particle %lld has h = %g, m = %g, rho0 = %g, rho = %g, d rho/dt = %g, "
                     "spacing = %g (nan: not given)",
                     name, (long long)l->bad, value(l->h, l->bad), value(l->m, l->bad),
                     value(l->rho0, l->bad), value(l->rho, l->bad), value(l->drho, l->bad),
                     value(l->spacing, l->bad));
  sphi_parallel(ctx, l->n, GRAIN, body, l);
  return SPH_OK;
}

sph_status sph_h_from_density(sph_context *ctx, int32_t dim, int64_t n, const double *h0,
                              const double *rho0, const double *rho, double *h) {
  law l = {.n = n, .dim = dim, .h = h0, .rho0 = rho0, .rho = rho, .out = h};
  sph_status s = check_shape(ctx, "sph_h_from_density", &l, h0 && rho0 && rho && h);
  return s ? s : run(ctx, "sph_h_from_density", &l, density_range);
}

sph_status sph_h_rate(sph_context *ctx, int32_t dim, int64_t n, const double *h, const double *rho,
                      const double *drho, double *dh) {
  law l = {.n = n, .dim = dim, .h = h, .rho = rho, .drho = drho, .out = dh};
  sph_status s = check_shape(ctx, "sph_h_rate", &l, h && rho && drho && dh);
  return s ? s : run(ctx, "sph_h_rate", &l, rate_range);
}

static sph_status check_ratio(sph_context *ctx, const char *name, const char *what, double ratio) {
  if (positive(ratio)) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_ARG, "%s: %s = %g", name, what, ratio);
}

sph_status sph_h_from_mass(sph_context *ctx, int32_t dim, int64_t n, double eta, const double *m,
                           const double *rho, double *h) {
  law l = {.n = n, .dim = dim, .ratio = eta, .m = m, .rho = rho, .out = h};
  sph_status s = check_shape(ctx, "sph_h_from_mass", &l, m && rho && h);
  if (!s) s = check_ratio(ctx, "sph_h_from_mass", "eta", eta);
  return s ? s : run(ctx, "sph_h_from_mass", &l, mass_range);
}

sph_status sph_h_from_spacing(sph_context *ctx, int64_t n, double ratio, const double *spacing,
                              double *h) {
  law l = {.n = n, .dim = 1, .ratio = ratio, .spacing = spacing, .out = h};
  sph_status s = check_shape(ctx, "sph_h_from_spacing", &l, spacing && h);
  if (!s) s = check_ratio(ctx, "sph_h_from_spacing", "ratio", ratio);
  return s ? s : run(ctx, "sph_h_from_spacing", &l, spacing_range);
}
