/* Volumes of particles: the loop over their Voronoi cells. */
#include "cell.h"

#include <sph/neighbors.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char function[] = "sph_layout_volumes";

void sph_region_options_init_sized(sph_region_options *options, size_t size) {
  const sph_region_options defaults = {.hi = {1.0, 1.0, 1.0}, .levels = 5};
  sphi_options_init(options, size, &defaults, sizeof defaults);
}

typedef struct cells {
  sph_context *ctx;
  const sph_region_options *region;
  int64_t n;
  const double *x;
  double *volumes; /* negative: the room was too small */
  sph_neighbors *list;
  double spacing, diagonal; /* mean distance, size of the box */
  sphi_cell_room *rooms;    /* one a worker */
  int32_t workers;
  int64_t coincident; /* lowest particle at the place of another */
} cells;

/* ---- room -------------------------------------------------------------------------------- */

static size_t room_bytes(int64_t capacity, size_t *indices, size_t *polygon) {
  *indices = (sphi_mul((size_t)capacity, sizeof(int32_t)) + 63) / 64 * 64;
  *polygon = sphi_mul((size_t)capacity + 8, 2 * sizeof(double));
  return sphi_mul((size_t)capacity, sizeof(sphi_mate)) + *indices + 2 * *polygon;
}

/* One block: mates, polygons, indices. */
static sph_status room_create(sph_context *ctx, sphi_cell_room *room, int64_t capacity) {
  size_t indices, polygon;
  char *block = sphi_alloc(ctx, room_bytes(capacity, &indices, &polygon));
  if (block == NULL) return SPH_ERR_NOMEM;
  room->capacity = capacity;
  room->mates = (sphi_mate *)block;
  block += (size_t)capacity * sizeof(sphi_mate);
  room->a.p = (double(*)[2])block;
  room->b.p = (double(*)[2])(block + polygon);
  room->indices = (int32_t *)(block + 2 * polygon);
  return SPH_OK;
}

static void room_destroy(sph_context *ctx, sphi_cell_room *room) {
  size_t indices, polygon;
  if (room->capacity > 0)
    sphi_free(ctx, room->mates, room_bytes(room->capacity, &indices, &polygon));
  room->capacity = 0;
}

/* ---- one cell ---------------------------------------------------------------------------- */

static int nearer(const void *a, const void *b) {
  const sphi_mate *p = a, *q = b;
  if (p->r2 != q->r2) return p->r2 < q->r2 ? -1 : 1;
  return p->j < q->j ? -1 : p->j > q->j;
}

/* The particles within `radius` of particle i, nearest first; -1 when there is no room for them.
 * *found counts i as well. */
static int64_t gather(cells *job, int64_t i, double radius, sphi_cell_room *room, int64_t *found) {
  const int32_t dim = job->region->dim;
  const double *x = job->x + i * dim;
  int64_t mates = 0;
  if (sph_neighbors_query(job->list, x, radius, room->capacity, room->indices, found) != SPH_OK ||
      *found > room->capacity)
    return -1;
  for (int64_t k = 0; k < *found; ++k) {
    sphi_mate mate = {.j = room->indices[k]};
    if (mate.j == i) continue;
    for (int32_t a = 0; a < dim; ++a) {
      mate.d[a] = job->x[mate.j * dim + a] - x[a];
      mate.r2 += mate.d[a] * mate.d[a];
    }
    if (mate.r2 == 0.0) sphi_lowest(&job->coincident, i);
    room->mates[mates++] = mate;
  }
  qsort(room->mates, (size_t)mates, sizeof *room->mates, nearer);
  return mates;
}

/* Look farther until no particle beyond could cut the cell. Returns the room that was missing. */
static int64_t measure(cells *job, int64_t i, sphi_cell_room *room) {
  double radius = 3.0 * job->spacing, reach;
  job->volumes[i] = -1.0;
  for (;;) {
    int64_t found = 0;
    const int64_t mates = gather(job, i, radius, room, &found);
    if (mates < 0) return found;
    if (job->coincident < INT64_MAX) return 0;
    const double measured =
        sphi_cell_measure(job->region, job->x + i * job->region->dim, mates, room, &reach);
    if (radius > 2.0 * reach || radius > job->diagonal) {
      job->volumes[i] = measured;
      return 0;
    }
    radius = fmin(2.0 * radius, 2.000001 * reach);
  }
}

static void measure_range(void *user, int64_t begin, int64_t end, int32_t worker) {
  cells *job = user;
  for (int64_t i = begin; i < end; ++i) measure(job, i, &job->rooms[worker]);
}

/* Cells with more neighbours than the workers have room for, one by one. */
static sph_status measure_crowded(cells *job) {
  for (int64_t i = 0; i < job->n && job->coincident == INT64_MAX; ++i)
    while (job->volumes[i] < 0.0 && job->coincident == INT64_MAX) {
      const int64_t missing = measure(job, i, &job->rooms[0]);
      if (missing == 0) break;
      room_destroy(job->ctx, &job->rooms[0]);
      const sph_status s = room_create(job->ctx, &job->rooms[0], 2 * missing);
      if (s) return s;
    }
  return SPH_OK;
}

/* ---- all cells --------------------------------------------------------------------------- */

/* A list that finds no pairs to speak of: it is there to be asked for points. */
static sph_status make_list(cells *job) {
  sph_neighbors_options options;
  sph_neighbors_options_init(&options);
  options.method = SPH_NEIGHBORS_TREE;
  options.support = 1.0;
  const sph_status s = sph_neighbors_create(job->ctx, &options, &job->list);
  return s ? s
           : sph_neighbors_build_arrays(job->list, job->region->dim, job->n, job->x, NULL,
                                        1e-3 * job->spacing);
}

static sph_status make_rooms(cells *job) {
  enum { CAPACITY = 256 };
  const size_t bytes = sphi_mul((size_t)job->workers, sizeof *job->rooms);
  job->rooms = sphi_calloc(job->ctx, bytes);
  if (job->rooms == NULL) return SPH_ERR_NOMEM;
  for (int32_t w = 0; w < job->workers; ++w) {
    const sph_status s = room_create(job->ctx, &job->rooms[w], CAPACITY);
    if (s) return s;
  }
  return SPH_OK;
}

static void clean_up(cells *job) {
  for (int32_t w = 0; job->rooms != NULL && w < job->workers; ++w)
    room_destroy(job->ctx, &job->rooms[w]);
  sphi_free(job->ctx, job->rooms, sphi_mul((size_t)job->workers, sizeof *job->rooms));
  sph_neighbors_destroy(job->list);
  sphi_free(job->ctx, job->volumes, sphi_mul((size_t)job->n, sizeof *job->volumes));
}

static sph_status measure_all(cells *job, double *volumes) {
  sph_status s = make_list(job);
  if (!s) s = make_rooms(job);
  if (s) return s;
  job->volumes = sphi_alloc(job->ctx, sphi_mul((size_t)job->n, sizeof *job->volumes));
  if (job->volumes == NULL) return SPH_ERR_NOMEM;
  sphi_parallel(job->ctx, job->n, 64, measure_range, job);
  s = measure_crowded(job);
  if (s) return s;
  if (job->coincident < INT64_MAX)
    return sphi_fail(job->ctx, SPH_ERR_ARG, "%s: another particle is where particle %lld is",
                     function, (long long)job->coincident);
  memcpy(volumes, job->volumes, (size_t)job->n * sizeof *volumes);
  return SPH_OK;
}

/* ---- checks ------------------------------------------------------------------------------ */

static sph_status check_region(sph_context *ctx, const sph_region_options *o) {
  sph_status s = sphi_check_box(ctx, function, o->dim, o->lo, o->hi);
  if (!s) s = sphi_check_holes(ctx, function, o->holes, o->hole);
  if (s) return s;
  if (o->holes > 0 && o->dim != 2)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: %d circular holes in %d-D", function, (int)o->holes,
                     (int)o->dim);
  if (o->levels < 0 || o->levels > 12)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: levels is %d, not 0..12", function, (int)o->levels);
  if (o->inside != NULL && o->dim == 3)
    return sphi_fail(ctx, SPH_ERR_UNSUPPORTED, "%s: inside is for 1-D and 2-D", function);
  return SPH_OK;
}

static sph_status check_particles(sph_context *ctx, const sph_region_options *o, int64_t n,
                                  const double *x, const double *volumes) {
  if (n < 0 || n > SPHI_LAYOUT_MAX || (n > 0 && (x == NULL || volumes == NULL)))
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: n is %lld, x is %s, volumes is %s", function,
                     (long long)n, x == NULL ? "NULL" : "given",
                     volumes == NULL ? "NULL" : "given");
  for (int64_t k = 0; k < n * o->dim; ++k) {
    const int32_t a = (int32_t)(k % o->dim);
    if (!(x[k] >= o->lo[a] && x[k] <= o->hi[a]))
      return sphi_fail(ctx, SPH_ERR_ARG,
                       "%s: component %d of particle %lld is %g, the box goes from %g to %g",
                       function, (int)a, (long long)(k / o->dim), x[k], o->lo[a], o->hi[a]);
  }
  return SPH_OK;
}

sph_status sph_layout_volumes(sph_context *ctx, const sph_region_options *options, int64_t n,
                              const double *x, double *volumes) {
  sph_region_options region;
  sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "context");
  if (s) return s;
  sph_region_options_init(&region);
  if (options == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "%s: options is NULL", function);
  s = sphi_options_read(ctx, &region, sizeof region, options);
  if (!s) s = check_region(ctx, &region);
  if (!s) s = check_particles(ctx, &region, n, x, volumes);
  if (s || n == 0) return s;
  cells job = {.ctx = ctx, .region = &region, .n = n, .x = x, .workers = sphi_workers(ctx)};
  job.coincident = INT64_MAX;
  job.spacing = pow((double)n, -1.0 / region.dim);
  for (int32_t a = 0; a < region.dim; ++a) {
    job.spacing *= pow(region.hi[a] - region.lo[a], 1.0 / region.dim);
    job.diagonal = hypot(job.diagonal, region.hi[a] - region.lo[a]);
  }
  s = measure_all(&job, volumes);
  clean_up(&job);
  return s;
}
