/* Centroidal Voronoi layouts by Lloyd's method: every particle goes towards the centroid of its
 * cell within the region, then the cells are made anew.
 *
 * The energy E = sum_i int over cell i of |y - x_i|^2 dy falls in both halves of a step. For given
 * cells it is sum V_i |x_i - c_i|^2 + const, and x_i + w (c_i - x_i) leaves (1 - w)^2 of that, less
 * than before for 0 < w < 2; for given particles the Voronoi cells are those of least energy. */
#include "relax.h"

#include <math.h>
#include <string.h>

static const char function[] = "sph_layout_relax";

void sph_relax_options_init_sized(sph_relax_options *options, size_t size) {
  const sph_relax_options defaults = {
      .size = sizeof defaults, .iterations = 100, .tolerance = 1e-3, .relaxation = 1.5};
  sphi_options_init(options, size, &defaults, sizeof defaults);
}

void sph_relax_result_init_sized(sph_relax_result *result, size_t size) {
  const sph_relax_result defaults = {.size = sizeof defaults};
  sphi_options_init(result, size, &defaults, sizeof defaults);
}

/* ---- one step ---------------------------------------------------------------------------- */

typedef struct mover {
  const sphi_tessellation *cells;
  double relaxation;
  int32_t levels; /* while they move */
  double *x;      /* where cells->x points */
  double *moved;  /* n */
} mover;

static int in_box(const sph_region_options *region, const double *at) {
  for (int32_t a = 0; a < region->dim; ++a)
    if (!(at[a] >= region->lo[a] && at[a] <= region->hi[a])) return 0;
  return 1;
}

/* Towards the centroid; half as far, and half again, while that leads out of the region. */
static void move(const mover *m, int64_t i) {
  enum { HALVINGS = 10 };
  const sph_region_options *region = m->cells->region;
  const sphi_moments *cell = &m->cells->cell[i];
  double *x = m->x + i * region->dim, factor = m->relaxation;
  m->moved[i] = 0.0;
  if (!(cell->volume > 0.0)) return; /* a part of the region too thin to be seen */
  for (int k = 0; k < HALVINGS; ++k, factor *= 0.5) {
    double at[3], square = 0.0;
    for (int32_t a = 0; a < region->dim; ++a) {
      const double step = factor * cell->first[a] / cell->volume;
      at[a] = x[a] + step;
      square += step * step;
    }
    if (!in_box(region, at) || !sphi_in_region(region, at)) continue;
    memcpy(x, at, (size_t)region->dim * sizeof *x);
    m->moved[i] = sqrt(square);
    return;
  }
}

static void move_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  (void)worker;
  for (int64_t i = begin; i < end; ++i) move(job, i);
}

static double largest(int64_t n, const double *v) {
  double most = 0.0;
  for (int64_t i = 0; i < n; ++i) most = fmax(most, v[i]);
  return most;
}

static sph_status iterate(sphi_tessellation *cells, const mover *m, const sph_relax_options *o,
                          sph_relax_result *result) {
  cells->levels = m->levels;
  for (int32_t k = 0; k < o->iterations; ++k) {
    const sph_status s = sphi_tessellation_run(cells);
    if (s) return s;
    sphi_parallel(cells->ctx, cells->n, 64, move_range, (void *)(uintptr_t)m);
    result->iterations += 1;
    result->moved = largest(cells->n, m->moved);
    if (result->moved <= o->tolerance * cells->spacing) break;
  }
  cells->levels = cells->region->levels;
  return sphi_tessellation_run(cells);
}

/* ---- the end ----------------------------------------------------------------------------- */

static void judge(const sphi_tessellation *cells, sph_relax_result *result) {
  result->smallest = INFINITY;
  for (int64_t i = 0; i < cells->n; ++i) {
    result->energy += cells->cell[i].second;
    result->smallest = fmin(result->smallest, cells->cell[i].volume);
    result->largest = fmax(result->largest, cells->cell[i].volume);
  }
}

static sph_status run(sphi_tessellation *cells, mover *m, const sph_relax_options *o, double *x,
                      double *volumes, sph_relax_result *result) {
  const size_t bytes = sphi_mul((size_t)cells->n * (size_t)cells->region->dim, sizeof *x);
  m->x = sphi_alloc(cells->ctx, bytes);
  m->moved = sphi_alloc(cells->ctx, sphi_mul((size_t)cells->n, sizeof *m->moved));
  if (m->x == NULL || m->moved == NULL) return SPH_ERR_NOMEM;
  memcpy(m->x, x, bytes);
  cells->x = m->x;
  sph_status s = sphi_tessellation_open(cells);
  if (!s) s = iterate(cells, m, o, result);
  if (s) return s;
  judge(cells, result);
  memcpy(x, m->x, bytes);
  for (int64_t i = 0; volumes != NULL && i < cells->n; ++i) volumes[i] = cells->cell[i].volume;
  return SPH_OK;
}

sph_status sphi_relax(sph_context *ctx, const char *name, const sph_region_options *region,
                      const sph_relax_options *options, const sphi_relax_limits *limits, int64_t n,
                      double *x, double *volumes, sph_relax_result *result) {
  sphi_tessellation cells = {.ctx = ctx,
                             .function = name,
                             .region = region,
                             .n = n,
                             .x = x,
                             .all = 1,
                             .limit = limits->reach};
  mover m = {.cells = &cells, .relaxation = options->relaxation, .levels = limits->levels};
  sph_relax_result found;
  sph_relax_result_init(&found);
  const sph_status s = run(&cells, &m, options, x, volumes, &found);
  sphi_tessellation_close(&cells);
  sphi_free(ctx, m.x, sphi_mul((size_t)n * (size_t)region->dim, sizeof *x));
  sphi_free(ctx, m.moved, sphi_mul((size_t)n, sizeof *m.moved));
  if (!s) *result = found;
  return s;
}

/* ---- the call ---------------------------------------------------------------------------- */

sph_status sphi_check_relax(sph_context *ctx, const char *name, const sph_relax_options *o) {
  if (o->iterations >= 0 && isfinite(o->tolerance) && o->tolerance >= 0.0 && o->relaxation > 0.0 &&
      o->relaxation < 2.0)
    return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_ARG,
                   "%s: iterations = %d and tolerance = %g must not be negative, relaxation = %g "
                   "lie between 0 and 2",
                   name, (int)o->iterations, o->tolerance, o->relaxation);
}

static sph_status check_particles(sph_context *ctx, const sph_region_options *region, int64_t n,
                                  const double *x) {
  if (n < 0 || n > SPHI_LAYOUT_MAX || (n > 0 && x == NULL))
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: n is %lld, x is %s", function, (long long)n,
                     x == NULL ? "NULL" : "given");
  sph_status s = sphi_check_in_box(ctx, function, region, n, x);
  for (int64_t i = 0; !s && i < n; ++i)
    if (!sphi_in_region(region, x + i * region->dim))
      s = sphi_fail(ctx, SPH_ERR_ARG, "%s: particle %lld is not in the region", function,
                    (long long)i);
  return s;
}

static void answer(const sph_relax_result *found, sph_relax_result *result) {
  if (result == NULL) return;
  const size_t size = result->size;
  memcpy(result, found, size < sizeof *found ? size : sizeof *found);
  result->size = size;
}

sph_status sph_layout_relax(sph_context *ctx, const sph_region_options *region,
                            const sph_relax_options *options, int64_t n, double *x, double *volumes,
                            sph_relax_result *result) {
  sph_region_options r;
  sph_relax_options o;
  sph_relax_result found;
  sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "context");
  if (s) return s;
  sph_region_options_init(&r);
  sph_relax_options_init(&o);
  sph_relax_result_init(&found);
  if (region == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "%s: region is NULL", function);
  s = sphi_options_read(ctx, &r, sizeof r, region);
  if (!s) s = sphi_options_read(ctx, &o, sizeof o, options);
  if (!s && result != NULL) s = sphi_options_read(ctx, &found, sizeof found, result);
  if (!s) s = sphi_check_region(ctx, function, &r);
  if (!s) s = sphi_check_relax(ctx, function, &o);
  if (!s) s = check_particles(ctx, &r, n, x);
  if (s) return s;
  sph_relax_result_init(&found);
  const sphi_relax_limits limits = {r.levels, 0.0};
  if (n > 0) s = sphi_relax(ctx, function, &r, &o, &limits, n, x, volumes, &found);
  if (!s) answer(&found, result);
  return s;
}
