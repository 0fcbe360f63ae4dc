/* What all layouts share: writing points, checking boxes and holes, random displacement. */
#include "layout_impl.h"

#include <math.h>

void sphi_points_add(sphi_points *points, const double *at) {
  if (points->x != NULL)
    for (int32_t a = 0; a < points->dim; ++a) points->x[points->n * points->dim + a] = at[a];
  points->n++;
}

sph_status sphi_layout_write(sph_context *ctx, const char *function, int32_t dim,
                             sphi_generate_fn generate, const void *layout, int64_t capacity,
                             double *x, int64_t *n) {
  if (n == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "%s: n is NULL", function);
  if (capacity < 0 || (x == NULL && capacity > 0))
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: capacity is %lld, x is %s", function,
                     (long long)capacity, x == NULL ? "NULL" : "given");
  sphi_points points = {dim, NULL, 0};
  generate(layout, &points);
  if (points.n > SPHI_LAYOUT_MAX || (x != NULL && points.n > capacity))
    return sphi_fail(ctx, SPH_ERR_LIMIT, "%s: %lld points, capacity is %lld", function,
                     (long long)points.n, (long long)capacity);
  *n = points.n;
  if (x == NULL) return SPH_OK;
  points = (sphi_points){dim, x, 0};
  generate(layout, &points);
  return SPH_OK;
}

sph_status sphi_check_box(sph_context *ctx, const char *function, int32_t dim, const double *lo,
                          const double *hi) {
  if (dim < 1 || dim > 3)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: dim is %d, not 1, 2 or 3", function, (int)dim);
  for (int32_t a = 0; a < dim; ++a)
    if (!(lo[a] < hi[a]) || !isfinite(hi[a] - lo[a]))
      return sphi_fail(ctx, SPH_ERR_ARG, "%s: the box goes from %g to %g on axis %d", function,
                       lo[a], hi[a], (int)a);
  return SPH_OK;
}

/* Overlapping holes would be taken off twice. Those that touch are fine. */
static sph_status check_overlap(sph_context *ctx, const char *function, const double *hole,
                                int32_t a, int32_t b) {
  const double *p = sphi_hole(hole, a), *q = sphi_hole(hole, b);
  const double distance = hypot(p[0] - q[0], p[1] - q[1]);
  if (distance >= (p[2] + q[2]) * (1.0 - 1e-12)) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_ARG, "%s: holes %d and %d overlap: radii %g and %g, distance %g",
                   function, (int)a, (int)b, p[2], q[2], distance);
}

sph_status sphi_check_holes(sph_context *ctx, const char *function, int32_t holes,
                            const double *hole) {
  if (holes < 0 || (holes > 0 && hole == NULL))
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: holes is %d, hole is %s", function, (int)holes,
                     hole == NULL ? "NULL" : "given");
  for (int32_t k = 0; k < holes; ++k) {
    const double *h = sphi_hole(hole, k);
    if (!isfinite(h[0]) || !isfinite(h[1]) || !isfinite(h[2]) || !(h[2] > 0.0))
      return sphi_fail(ctx, SPH_ERR_ARG, "%s: hole %d has the centre (%g, %g) and the radius %g",
                       function, (int)k, h[0], h[1], h[2]);
    for (int32_t other = 0; other < k; ++other) {
      const sph_status s = check_overlap(ctx, function, hole, other, k);
      if (s) return s;
    }
  }
  return SPH_OK;
}

/* ---- jitter ------------------------------------------------------------------------------ */

/* The output function of splitmix64 (Steele, Lea, Flood, OOPSLA 2014): a good hash of a counter. */
static uint64_t mix(uint64_t z) {
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return z ^ (z >> 31);
}

/* Uniform in [-1, 1), a multiple of 2^-52. */
static double uniform(uint64_t seed, uint64_t counter) {
  const uint64_t bits = mix(mix(seed) + (counter + 1) * UINT64_C(0x9e3779b97f4a7c15)) >> 11;
  return (double)bits * 0x1p-52 - 1.0;
}

static void jitter_point(int32_t dim, double amplitude, uint64_t seed, sph_inside_fn inside,
                         void *user, int64_t i, double *x) {
  double at[3];
  for (int32_t a = 0; a < dim; ++a)
    at[a] = x[a] + amplitude * uniform(seed, (uint64_t)i * 3 + (uint64_t)a);
  if (inside != NULL && !inside(user, at)) return;
  for (int32_t a = 0; a < dim; ++a) x[a] = at[a];
}

sph_status sph_layout_jitter(sph_context *ctx, int32_t dim, double amplitude, uint64_t seed,
                             sph_inside_fn inside, void *inside_user, int64_t n, double *x) {
  const sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "context");
  if (s) return s;
  if (dim < 1 || dim > 3)
    return sphi_fail(ctx, SPH_ERR_ARG, "sph_layout_jitter: dim is %d, not 1, 2 or 3", (int)dim);
  if (n < 0 || (n > 0 && x == NULL))
    return sphi_fail(ctx, SPH_ERR_ARG, "sph_layout_jitter: n is %lld, x is %s", (long long)n,
                     x == NULL ? "NULL" : "given");
  if (!(amplitude >= 0.0) || !isfinite(amplitude))
    return sphi_fail(ctx, SPH_ERR_ARG, "sph_layout_jitter: the amplitude is %g", amplitude);
  for (int64_t i = 0; i < n; ++i)
    jitter_point(dim, amplitude, seed, inside, inside_user, i, x + i * dim);
  return SPH_OK;
}
