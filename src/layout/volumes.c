/* Volumes of particles: those of their Voronoi cells. */
#include "cell.h"

static const char function[] = "sph_layout_volumes";

void sph_region_options_init_sized(sph_region_options *options, size_t size) {
  const sph_region_options defaults = {.hi = {1.0, 1.0, 1.0}, .levels = 5};
  sphi_options_init(options, size, &defaults, sizeof defaults);
}

static sph_status check_particles(sph_context *ctx, const sph_region_options *o, int64_t n,
                                  const double *x, const double *volumes) {
  if (n < 0 || n > SPHI_LAYOUT_MAX || (n > 0 && (x == NULL || volumes == NULL)))
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: n is %lld, x is %s, volumes is %s", function,
                     (long long)n, x == NULL ? "NULL" : "given",
                     volumes == NULL ? "NULL" : "given");
  return sphi_check_in_box(ctx, function, o, n, x);
}

sph_status sph_layout_volumes(sph_context *ctx, const sph_region_options *options, int64_t n,
                              const double *x, double *volumes) {
  sph_region_options region;
  sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "context");
  if (s) return s;
  sph_region_options_init(&region);
  if (options == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "%s: options is NULL", function);
  s = sphi_options_read(ctx, &region, sizeof region, options);
  if (!s) s = sphi_check_region(ctx, function, &region);
  if (!s) s = check_particles(ctx, &region, n, x, volumes);
  if (s || n == 0) return s;
  sphi_tessellation job = {
      .ctx = ctx, .function = function, .region = &region, .n = n, .x = x, .levels = region.levels};
  s = sphi_tessellation_open(&job);
  if (!s) s = sphi_tessellation_run(&job);
  for (int64_t i = 0; !s && i < n; ++i) volumes[i] = job.cell[i].volume;
  sphi_tessellation_close(&job);
  return s;
}
