/* All Voronoi cells of some particles: the loop, its room, and the search for neighbours. */
#include "cell.h"

#include <math.h>
#include <stdlib.h>

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
static int64_t gather(sphi_tessellation *job, int64_t i, double radius, sphi_cell_room *room,
                      int64_t *found) {
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
static int64_t measure(sphi_tessellation *job, int64_t i, sphi_cell_room *room) {
  double radius = 3.0 * job->spacing, reach;
  job->cell[i].volume = -1.0;
  for (;;) {
    int64_t found = 0;
    const int64_t mates = gather(job, i, radius, room, &found);
    if (mates < 0) return found;
    if (job->coincident < INT64_MAX) return 0;
    const double limit = job->limit > 0.0 ? job->limit : INFINITY;
    const sphi_measure how = {job->region, job->spacing, job->levels, limit};
    sphi_moments moments;
    sphi_cell_measure(&how, job->x + i * job->region->dim, mates, job->all, room, &reach, &moments);
    if (radius > 2.0 * reach || radius > job->diagonal) {
      job->cell[i] = moments;
      return 0;
    }
    radius = fmin(2.0 * radius, 2.000001 * reach);
  }
}

static void measure_range(void *user, int64_t begin, int64_t end, int32_t worker) {
  sphi_tessellation *job = user;
  for (int64_t i = begin; i < end; ++i) measure(job, i, &job->rooms[worker]);
}

/* Cells with more neighbours than the workers have room for, one by one. */
static sph_status measure_crowded(sphi_tessellation *job) {
  for (int64_t i = 0; i < job->n && job->coincident == INT64_MAX; ++i)
    while (job->cell[i].volume < 0.0 && job->coincident == INT64_MAX) {
      const int64_t missing = measure(job, i, &job->rooms[0]);
      if (missing == 0) break;
      room_destroy(job->ctx, &job->rooms[0]);
      const sph_status s = room_create(job->ctx, &job->rooms[0], 2 * missing);
      if (s) return s;
    }
  return SPH_OK;
}

/* ---- all cells --------------------------------------------------------------------------- */

static sph_status make_rooms(sphi_tessellation *job) {
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

sph_status sphi_tessellation_open(sphi_tessellation *job) {
  const sph_region_options *region = job->region;
  sph_neighbors_options options;
  sph_neighbors_options_init(&options);
  options.method = SPH_NEIGHBORS_TREE;
  options.support = 1.0;
  job->workers = sphi_workers(job->ctx);
  job->diagonal = 0.0;
  job->spacing = pow((double)job->n, -1.0 / region->dim);
  for (int32_t a = 0; a < region->dim; ++a) {
    job->spacing *= pow(region->hi[a] - region->lo[a], 1.0 / region->dim);
    job->diagonal = hypot(job->diagonal, region->hi[a] - region->lo[a]);
  }
  sph_status s = sph_neighbors_create(job->ctx, &options, &job->list);
  if (!s) s = make_rooms(job);
  if (s) return s;
  job->cell = sphi_alloc(job->ctx, sphi_mul((size_t)job->n, sizeof *job->cell));
  return job->cell != NULL ? SPH_OK : SPH_ERR_NOMEM;
}

/* The list finds no pairs to speak of: it is there to be asked for points. */
sph_status sphi_tessellation_run(sphi_tessellation *job) {
  sph_status s = sph_neighbors_build_arrays(job->list, job->region->dim, job->n, job->x, NULL,
                                            1e-3 * job->spacing);
  if (s) return s;
  job->coincident = INT64_MAX;
  sphi_parallel(job->ctx, job->n, 64, measure_range, job);
  s = measure_crowded(job);
  if (s || job->coincident == INT64_MAX) return s;
  return sphi_fail(job->ctx, SPH_ERR_ARG, "%s: another particle is where particle %lld is",
                   job->function, (long long)job->coincident);
}

void sphi_tessellation_close(sphi_tessellation *job) {
  for (int32_t w = 0; job->rooms != NULL && w < job->workers; ++w)
    room_destroy(job->ctx, &job->rooms[w]);
  sphi_free(job->ctx, job->rooms, sphi_mul((size_t)job->workers, sizeof *job->rooms));
  sph_neighbors_destroy(job->list);
  sphi_free(job->ctx, job->cell, sphi_mul((size_t)job->n, sizeof *job->cell));
}

/* ---- checks ------------------------------------------------------------------------------ */

sph_status sphi_check_region(sph_context *ctx, const char *function, const sph_region_options *o) {
  sph_status s = sphi_check_box(ctx, function, o->dim, o->lo, o->hi);
  if (!s) s = sphi_check_holes(ctx, function, o->holes, o->hole);
  if (s) return s;
  if (o->holes > 0 && o->dim != 2)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: %d circular holes in %d-D", function, (int)o->holes,
                     (int)o->dim);
  if (o->levels < 0 || o->levels > 12)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: levels is %d, not 0..12", function, (int)o->levels);
  return SPH_OK;
}

sph_status sphi_check_in_box(sph_context *ctx, const char *function, const sph_region_options *o,
                             int64_t n, const double *x) {
  for (int64_t k = 0; k < n * o->dim; ++k) {
    const int32_t a = (int32_t)(k % o->dim);
    if (!(x[k] >= o->lo[a] && x[k] <= o->hi[a]))
      return sphi_fail(ctx, SPH_ERR_ARG,
                       "%s: component %d of particle %lld is %g, the box goes from %g to %g",
                       function, (int)a, (long long)(k / o->dim), x[k], o->lo[a], o->hi[a]);
  }
  return SPH_OK;
}
