/* A host's own kernels: from a callback, or from a table by cubic Hermite interpolation. Both are
 * integrated at creation, so that a wrong normalisation is noticed before a particle moves. */
#include "profile.h"

#include <math.h>

/* Enough that a kink inside a panel costs less than the tolerance of 1e-6. */
#define SPHI_CALLBACK_PANELS 1024
#define SPHI_UNIT_TOLERANCE 1e-6

/* ---- moments ----------------------------------------------------------------------------- */

typedef struct moments {
  double integral; /* over d-dimensional space */
  double second;   /* (1/d) int |q|^2 w */
} moments;

/* Four-point Gauss in each of `panels` equal panels. Exact for tables, whose integrand is of
 * degree 3 + d + 1 <= 7 between two samples. */
static moments integrate(const sph_kernel *kernel, int64_t panels) {
  static const double node[4] = {-0.86113631159405257522, -0.33998104358485626480,
                                 0.33998104358485626480, 0.86113631159405257522};
  static const double weight[4] = {0.34785484513745385737, 0.65214515486254614263,
                                   0.65214515486254614263, 0.34785484513745385737};
  static const double sphere[3] = {2.0, 6.28318530717958647693, 12.5663706143591729539};
  const double width = kernel->support / (double)panels;
  moments m = {0.0, 0.0};
  for (int64_t i = 0; i < panels; i++)
    for (int k = 0; k < 4; k++) {
      const double q = ((double)i + 0.5 + 0.5 * node[k]) * width;
      double w, dw;
      sphi_kernel_profile(kernel, q, &w, &dw);
      /* dw * 0 carries a NaN or an infinity of the derivative into the sum */
      const double area = kernel->dim == 1 ? 1.0 : kernel->dim == 2 ? q : q * q;
      const double part = weight[k] * area * (w + dw * 0.0);
      m.integral += part;
      m.second += part * q * q;
    }
  const double factor = 0.5 * width * sphere[kernel->dim - 1];
  m.integral *= factor;
  m.second *= factor / kernel->dim;
  return m;
}

/* A kernel of higher order has no positive second moment: its deviation is 0. */
static void set_deviation(sph_kernel *kernel, double second) {
  kernel->deviation = second > 0.0 ? sqrt(second) : 0.0;
}

static sph_status check_integral(const sph_kernel *kernel, double integral) {
  sph_context *ctx = kernel->base.ctx;
  if (!isfinite(integral))
    return sphi_fail(ctx, SPH_ERR_NUMERIC, "kernel: a value of the profile is not finite");
  if (!(fabs(integral - 1.0) <= SPHI_UNIT_TOLERANCE))
    return sphi_fail(ctx, SPH_ERR_NUMERIC, "kernel: the integral in %d-D is %.9g, not 1",
                     (int)kernel->dim, integral);
  return SPH_OK;
}

static sph_status check_support(sph_context *ctx, double support) {
  if (support > 0.0 && isfinite(support)) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_ARG, "kernel: support is %g, not positive and finite", support);
}

/* ---- callback ---------------------------------------------------------------------------- */

static sph_status fill_callback(sph_kernel *kernel, double support, sph_kernel_fn fn, void *user) {
  sph_context *ctx = kernel->base.ctx;
  double w, dw;
  if (fn == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "kernel: fn is NULL");
  const sph_status status = check_support(ctx, support);
  if (status != SPH_OK) return status;
  kernel->support = support;
  kernel->alpha = 1.0;
  kernel->fn = fn;
  kernel->user = user;
  fn(user, 0.0, &w, &dw);
  if (!isfinite(w) || !isfinite(dw))
    return sphi_fail(ctx, SPH_ERR_NUMERIC, "kernel: the profile is not finite at q = 0");
  const moments m = integrate(kernel, SPHI_CALLBACK_PANELS);
  set_deviation(kernel, m.second);
  return check_integral(kernel, m.integral);
}

sph_status sph_kernel_create_callback(sph_context *ctx, int32_t dim, double support,
                                      sph_kernel_fn fn, void *user, sph_kernel **out) {
  sph_kernel *kernel = NULL;
  if (out != NULL) *out = NULL;
  sph_status status = sphi_kernel_new(ctx, dim, out != NULL ? &kernel : NULL);
  if (status != SPH_OK) return status;
  status = fill_callback(kernel, support, fn, user);
  if (status != SPH_OK)
    sphi_kernel_release(kernel);
  else
    *out = kernel;
  return status;
}

/* ---- table ------------------------------------------------------------------------------- */

/* The interval of q and the position 0 <= *t <= 1 in it. */
static int64_t locate(const sph_kernel *kernel, double q, double *t) {
  const double s = q * (double)(kernel->table_n - 1) / kernel->support;
  int64_t i = (int64_t)s;
  if (i > kernel->table_n - 2) i = kernel->table_n - 2;
  *t = s - (double)i;
  return i;
}

/* Derivatives are those of the interpolating polynomial, so W and dW/dr fit exactly; the second
 * one is piecewise linear and jumps at the samples by as much as the table is coarse. */
sphi_profile sphi_kernel_table_profile(const sph_kernel *kernel, double q) {
  double t;
  const int64_t i = locate(kernel, q, &t);
  const double step = kernel->support / (double)(kernel->table_n - 1);
  const double a = kernel->table[i];
  const double rise = kernel->table[i + 1] - a;
  const double s0 = step * kernel->dtable[i], s1 = step * kernel->dtable[i + 1];
  /* a + s0 t + c t^2 + d t^3 */
  const double c = 3.0 * rise - 2.0 * s0 - s1;
  const double d = s0 + s1 - 2.0 * rise;
  return (sphi_profile){a + t * (s0 + t * (c + t * d)), (s0 + t * (2.0 * c + 3.0 * t * d)) / step,
                        (2.0 * c + 6.0 * t * d) / (step * step)};
}

void sphi_kernel_table_fn(void *user, double q, double *w, double *dw) {
  const sphi_profile p = sphi_kernel_table_profile(user, q);
  *w = p.w;
  *dw = p.dw;
}

static sph_status check_table(sph_context *ctx, double support, int64_t n, const double *w,
                              const double *dw) {
  const sph_status status = check_support(ctx, support);
  if (status != SPH_OK) return status;
  if (n < 4)
    return sphi_fail(ctx, SPH_ERR_ARG, "kernel: a table of %lld samples, at least 4 are needed",
                     (long long)n);
  if (w == NULL || dw == NULL)
    return sphi_fail(ctx, SPH_ERR_ARG, "kernel: %s is NULL", w == NULL ? "w" : "dw");
  for (int64_t i = 0; i < n; i++)
    if (!isfinite(w[i]) || !isfinite(dw[i]))
      return sphi_fail(ctx, SPH_ERR_NUMERIC, "kernel: sample %lld is not finite: w %g, dw %g",
                       (long long)i, w[i], dw[i]);
  return SPH_OK;
}

static sph_status copy_table(sph_kernel *kernel, int64_t n, const double *w, const double *dw) {
  const size_t bytes = sphi_mul(sphi_mul(2, (size_t)n), sizeof(double));
  double *table = sphi_alloc(kernel->base.ctx, bytes);
  if (table == NULL) return SPH_ERR_NOMEM;
  for (int64_t i = 0; i < n; i++) {
    table[i] = w[i];
    table[n + i] = dw[i];
  }
  kernel->table_n = n;
  kernel->table = table;
  kernel->dtable = table + n;
  return SPH_OK;
}

static sph_status normalise_table(sph_kernel *kernel, moments *m) {
  if (!(m->integral > 0.0) || !isfinite(m->integral))
    return sphi_fail(kernel->base.ctx, SPH_ERR_NUMERIC,
                     "kernel: the table cannot be normalised, its integral is %g", m->integral);
  const double factor = 1.0 / m->integral;
  for (int64_t i = 0; i < 2 * kernel->table_n; i++) kernel->table[i] *= factor;
  m->second *= factor;
  m->integral = 1.0;
  return SPH_OK;
}

static sph_status fill_table(sph_kernel *kernel, double support, int64_t n, const double *w,
                             const double *dw, int32_t normalise) {
  sph_status status = check_table(kernel->base.ctx, support, n, w, dw);
  if (status == SPH_OK) status = copy_table(kernel, n, w, dw);
  if (status != SPH_OK) return status;
  kernel->support = support;
  kernel->alpha = 1.0;
  kernel->fn = sphi_kernel_table_fn;
  kernel->user = kernel;
  moments m = integrate(kernel, n - 1);
  if (normalise) status = normalise_table(kernel, &m);
  if (status != SPH_OK) return status;
  set_deviation(kernel, m.second);
  return check_integral(kernel, m.integral);
}

sph_status sph_kernel_create_table(sph_context *ctx, int32_t dim, double support, int64_t n,
                                   const double *w, const double *dw, int32_t normalise,
                                   sph_kernel **out) {
  sph_kernel *kernel = NULL;
  if (out != NULL) *out = NULL;
  sph_status status = sphi_kernel_new(ctx, dim, out != NULL ? &kernel : NULL);
  if (status != SPH_OK) return status;
  status = fill_table(kernel, support, n, w, dw, normalise);
  if (status != SPH_OK)
    sphi_kernel_release(kernel);
  else
    *out = kernel;
  return status;
}
