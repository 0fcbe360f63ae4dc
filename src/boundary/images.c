/* Which particles have images about which walls.
 *
 * Two passes over the real particles in fixed chunks: count, then write at the offsets of the
 * chunks, so that the order of the ghosts does not depend on the threads. */
#include "boundary_impl.h"

#include <math.h>
#include <string.h>

enum { CHUNK = 1024 };

/* What one chunk of particles finds. */
typedef struct part {
  double h_max, moved2;
  int64_t images, escaped, oblique; /* lowest particle of these; INT64_MAX: none */
  int32_t escaped_wall;
} part;

typedef struct image_job {
  sph_ghosts *g;
  const double *x, *h;
  const double *seen; /* positions of the last update, or NULL */
  const int32_t *phases;
  int64_t n;
  int32_t dim;
  double reach, made_reach;
  sphi_plane plane[SPHI_MAX_WALLS];
  int32_t phase[SPHI_MAX_WALLS];
  uint32_t square[SPHI_MAX_WALLS];  /* walls at right angles to this one */
  uint32_t oblique[SPHI_MAX_WALLS]; /* neither square nor face to face */
  double cosine[SPHI_MAX_WALLS][SPHI_MAX_WALLS];
  int64_t *owner;
  uint32_t *mask;
  part *parts;
} image_job;

static int64_t chunks_of(int64_t n) { return (n + CHUNK - 1) / CHUNK; }

static void chunk_range(const image_job *j, int64_t c, int64_t *lo, int64_t *hi) {
  *lo = c * CHUNK;
  *hi = *lo + CHUNK < j->n ? *lo + CHUNK : j->n;
}

/* --- reach and motion -------------------------------------------------------------------- */

static void survey_chunks(void *job, int64_t begin, int64_t end, int32_t worker) {
  image_job *j = job;
  (void)worker;
  for (int64_t c = begin; c < end; ++c) {
    int64_t lo, hi;
    part p = {0.0, 0.0, 0, INT64_MAX, INT64_MAX, 0};
    chunk_range(j, c, &lo, &hi);
    for (int64_t i = lo; j->h && i < hi; ++i) p.h_max = fmax(p.h_max, j->h[i]);
    for (int64_t i = lo; j->seen && i < hi; ++i) {
      double d2 = 0.0;
      for (int32_t a = 0; a < j->dim; ++a) {
        const double d = j->x[i * j->dim + a] - j->seen[i * j->dim + a];
        d2 += d * d;
      }
      if (!(d2 <= p.moved2)) p.moved2 = d2; /* keeps a NaN, which then asks for an update */
    }
    j->parts[c] = p;
  }
}

/* Reach without skin, and the largest motion since the last update where that is of use. */
static void survey(image_job *j, double *moved) {
  const sph_ghosts_options *o = &j->g->options;
  double h_max = 0.0, moved2 = 0.0;
  sphi_parallel(j->g->base.ctx, chunks_of(j->n), 1, survey_chunks, j);
  for (int64_t c = 0; c < chunks_of(j->n); ++c) {
    h_max = fmax(h_max, j->parts[c].h_max);
    if (!(j->parts[c].moved2 <= moved2)) moved2 = j->parts[c].moved2;
  }
  j->reach = o->reach > 0.0 ? o->reach : o->support * h_max;
  *moved = sqrt(moved2);
}

static sph_status reserve_parts(image_job *j) {
  size_t bytes = sphi_mul((size_t)chunks_of(j->n), sizeof(part));
  sph_status s = sphi_buffer_reserve(j->g->base.ctx, &j->g->parts, bytes);
  j->parts = j->g->parts.ptr;
  return s;
}

static sph_status begin_job(image_job *j, sph_ghosts *g, const sph_particles *set,
                            const sph_wall *next) {
  memset(j, 0, sizeof *j);
  j->g = g;
  j->dim = g->options.dim;
  j->n = sph_particles_real_count(set);
  j->x = sph_particles_field_const(set, g->options.position_field);
  j->h = sph_particles_field_const(set, SPH_FIELD_H);
  j->phases = sphi_particles_phases(set);
  for (int32_t w = 0; w < g->walls; ++w) {
    j->plane[w] = sphi_wall_plane(g, next, w);
    j->phase[w] = next[w].phase;
  }
  return reserve_parts(j);
}

/* How far a wall has moved along its normal; infinite where it turned. */
static double wall_moved(const image_job *j, int32_t w) {
  const sphi_plane *made = &j->g->made[w], *now = &j->plane[w];
  for (int a = 0; a < 3; ++a)
    if (made->normal[a] != now->normal[a]) return INFINITY;
  return fabs(sphi_plane_distance(made, j->dim, now->point));
}

int sphi_images_serve(sph_ghosts *g, const sph_particles *set, const sph_wall *next) {
  image_job j;
  double moved, shift = 0.0;
  if (g->set != set || g->generation != sph_particles_generation(set) ||
      g->made_changes != g->changes || g->real_count != sph_particles_real_count(set))
    return 0;
  if (begin_job(&j, g, set, next)) return 0;
  for (int32_t w = 0; w < g->walls; ++w) shift = fmax(shift, wall_moved(&j, w));
  if (!(shift <= g->made_reach)) return 0;
  j.seen = g->seen.ptr;
  survey(&j, &moved);
  return j.reach + moved + shift <= g->made_reach;
}

/* --- walls against each other ------------------------------------------------------------ */

static int together(const image_job *j, int32_t a, int32_t b) {
  return j->phase[a] < 0 || j->phase[b] < 0 || j->phase[a] == j->phase[b];
}

/* Walls face to face: the image of an image must lie out of reach. */
static sph_status check_gap(const image_job *j, int32_t a, int32_t b) {
  const double gap = sphi_plane_distance(&j->plane[a], j->dim, j->plane[b].point);
  if (gap >= j->made_reach) return SPH_OK;
  return sphi_fail(j->g->base.ctx, SPH_ERR_UNSUPPORTED,
                   "ghosts: walls %d and %d face each other at the distance %g, below the reach "
                   "%g: images of images are not made",
                   a, b, gap, j->made_reach);
}

static sph_status relate(image_job *j) {
  for (int32_t a = 0; a < j->g->walls; ++a)
    for (int32_t b = 0; b < a; ++b) {
      const double c = sphi_dot(j->dim, j->plane[a].normal, j->plane[b].normal);
      if (!together(j, a, b)) continue;
      j->cosine[a][b] = j->cosine[b][a] = c;
      if (fabs(c) < 1e-9) {
        j->square[a] |= UINT32_C(1) << b;
        j->square[b] |= UINT32_C(1) << a;
      } else if (c > -1.0 + 1e-12) {
        j->oblique[a] |= UINT32_C(1) << b;
        j->oblique[b] |= UINT32_C(1) << a;
      } else {
        sph_status s = check_gap(j, a, b);
        if (s) return s;
      }
    }
  return SPH_OK;
}

/* --- images of one particle -------------------------------------------------------------- */

/* Walls within reach and their distances; the first wall that i is behind, or -1. */
static uint32_t near_walls(const image_job *j, int64_t i, double *d, int32_t *behind) {
  uint32_t near = 0;
  *behind = -1;
  for (int32_t w = 0; w < j->g->walls; ++w) {
    if (j->phase[w] >= 0 && j->phases[i] != j->phase[w]) continue;
    d[w] = sphi_plane_distance(&j->plane[w], j->dim, j->x + i * j->dim);
    if (d[w] > 1e-9 * j->made_reach && d[w] < j->made_reach) near |= UINT32_C(1) << w;
    if (d[w] < -1e-9 * j->made_reach && *behind < 0) *behind = w;
  }
  return near;
}

/* Whether the edge of two walls at an angle is within reach. */
static int near_oblique(const image_job *j, uint32_t near, const double *d) {
  for (int32_t a = 0; near >> a; ++a)
    for (int32_t b = 0; (near >> a & 1) && b < a; ++b) {
      const double c = j->cosine[a][b];
      if (!(near >> b & 1) || !(j->oblique[a] >> b & 1)) continue;
      const double d2 = (d[a] * d[a] + d[b] * d[b] - 2.0 * c * d[a] * d[b]) / (1.0 - c * c);
      if (d2 < j->made_reach * j->made_reach) return 1;
    }
  return 0;
}

/* A set of walls has an image when they meet at right angles and their corner is within reach. */
static int has_image(const image_job *j, uint32_t walls, const double *d) {
  double d2 = 0.0;
  for (int32_t w = 0; walls >> w; ++w) {
    const uint32_t bit = UINT32_C(1) << w;
    if (!(walls & bit)) continue;
    if ((walls & ~bit) & ~j->square[w]) return 0;
    d2 += d[w] * d[w];
  }
  return d2 < j->made_reach * j->made_reach;
}

/* Images of i; written from owner and mask on where these are not NULL. Returns how many. */
static int64_t images_of(const image_job *j, int64_t i, uint32_t near, const double *d,
                         int64_t *owner, uint32_t *mask) {
  int64_t count = 0;
  for (uint32_t s = (0 - near) & near; s; s = (s - near) & near) { /* subsets, ascending */
    if (!has_image(j, s, d)) continue;
    if (owner) {
      owner[count] = i;
      mask[count] = s;
    }
    ++count;
  }
  return count;
}

static void count_chunks(void *job, int64_t begin, int64_t end, int32_t worker) {
  image_job *j = job;
  (void)worker;
  for (int64_t c = begin; c < end; ++c) {
    int64_t lo, hi;
    part p = {0.0, 0.0, 0, INT64_MAX, INT64_MAX, 0};
    chunk_range(j, c, &lo, &hi);
    for (int64_t i = lo; i < hi; ++i) {
      double d[SPHI_MAX_WALLS];
      int32_t behind;
      const uint32_t near = near_walls(j, i, d, &behind);
      if (behind >= 0 && p.escaped == INT64_MAX) {
        p.escaped = i;
        p.escaped_wall = behind;
      }
      if (!near) continue;
      if (p.oblique == INT64_MAX && near_oblique(j, near, d)) p.oblique = i;
      p.images += images_of(j, i, near, d, NULL, NULL);
    }
    j->parts[c] = p;
  }
}

static void write_chunks(void *job, int64_t begin, int64_t end, int32_t worker) {
  image_job *j = job;
  (void)worker;
  for (int64_t c = begin; c < end; ++c) {
    int64_t lo, hi, at = j->parts[c].images; /* by now the offset of the chunk */
    chunk_range(j, c, &lo, &hi);
    for (int64_t i = lo; i < hi; ++i) {
      double d[SPHI_MAX_WALLS];
      int32_t behind;
      const uint32_t near = near_walls(j, i, d, &behind);
      if (near) at += images_of(j, i, near, d, j->owner + at, j->mask + at);
    }
  }
}

static sph_status escaped(const image_job *j, const part *p) {
  const int32_t w = p->escaped_wall, escape = j->g->options.escape;
  if (escape == SPH_ESCAPE_IGNORE) return SPH_OK;
  if (escape == SPH_ESCAPE_RETRY) return SPH_RETRY;
  return sphi_fail(j->g->base.ctx, SPH_ERR_STATE, "ghosts: particle %lld lies %g behind wall %d",
                   (long long)p->escaped,
                   -sphi_plane_distance(&j->plane[w], j->dim, j->x + p->escaped * j->dim), w);
}

/* Total of the images; the counts of the chunks become offsets. The lowest particle that is in
 * trouble decides. */
static sph_status total_images(image_job *j, int64_t *total) {
  *total = 0;
  for (int64_t c = 0; c < chunks_of(j->n); ++c) {
    part *p = &j->parts[c];
    sph_status s = p->escaped < INT64_MAX ? escaped(j, p) : SPH_OK;
    if (s) return s;
    if (p->oblique < INT64_MAX)
      return sphi_fail(j->g->base.ctx, SPH_ERR_UNSUPPORTED,
                       "ghosts: particle %lld lies within the reach %g of the edge of two walls "
                       "that are not at right angles",
                       (long long)p->oblique, j->made_reach);
    const int64_t images = p->images;
    p->images = *total;
    *total += images;
  }
  return SPH_OK;
}

static sph_status find_images(image_job *j, int64_t *total) {
  sph_ghosts *g = j->g;
  sphi_parallel(g->base.ctx, chunks_of(j->n), 1, count_chunks, j);
  sph_status s = total_images(j, total);
  const size_t count = (size_t)*total;
  if (!s) s = sphi_buffer_reserve(g->base.ctx, &g->next_owner, sphi_mul(count, sizeof(int64_t)));
  if (!s) s = sphi_buffer_reserve(g->base.ctx, &g->next_mask, sphi_mul(count, sizeof(uint32_t)));
  if (s) return s;
  j->owner = g->next_owner.ptr;
  j->mask = g->next_mask.ptr;
  sphi_parallel(g->base.ctx, chunks_of(j->n), 1, write_chunks, j);
  return SPH_OK;
}

/* --- update ------------------------------------------------------------------------------ */

/* Give the set `count` ghosts. Growing comes first, since it alone can fail. */
static sph_status resize(sph_particles *set, int64_t count) {
  const int64_t have = sph_particles_count(set) - sph_particles_real_count(set);
  if (count > have) return sph_particles_add_ghosts(set, count - have, NULL);
  if (count == have) return SPH_OK;
  sph_status s = sph_particles_clear_ghosts(set);
  return s ? s : sph_particles_add_ghosts(set, count, NULL);
}

static void swap(sphi_buffer *a, sphi_buffer *b) {
  const sphi_buffer c = *a;
  *a = *b;
  *b = c;
}

/* The positions, for sphi_images_serve(). */
static sph_status remember(image_job *j) {
  const size_t bytes = sphi_mul((size_t)(j->n * j->dim), sizeof(double));
  return sphi_buffer_reserve(j->g->base.ctx, &j->g->seen, bytes);
}

static void commit(image_job *j, const sph_particles *set, int64_t count) {
  sph_ghosts *g = j->g;
  swap(&g->owner, &g->next_owner);
  swap(&g->mask, &g->next_mask);
  if (j->n > 0) memcpy(g->seen.ptr, j->x, (size_t)(j->n * j->dim) * sizeof(double));
  memcpy(g->made, j->plane, sizeof g->made);
  g->set = set;
  g->generation = sph_particles_generation(set);
  g->made_changes = g->changes;
  g->made_reach = j->made_reach;
  g->count = count;
  g->real_count = j->n;
}

static sph_status check_needs(const image_job *j) {
  const sph_ghosts_options *o = &j->g->options;
  if (!j->x) return sphi_fail(j->g->base.ctx, SPH_ERR_ARG, "ghosts: distances need field X0");
  if (!j->h && o->reach == 0.0)
    return sphi_fail(j->g->base.ctx, SPH_ERR_ARG, "ghosts: the reach needs field H");
  if (j->g->walls == 0 || j->n == 0 || (j->reach > 0.0 && isfinite(j->reach))) return SPH_OK;
  return sphi_fail(j->g->base.ctx, SPH_ERR_ARG, "ghosts: the reach is %g", j->reach);
}

sph_status sphi_images_update(sph_ghosts *g, sph_particles *set, double t, const sph_wall *next) {
  image_job j;
  int64_t total = 0;
  double moved;
  sph_status s = begin_job(&j, g, set, next);
  if (s) return s;
  survey(&j, &moved);
  j.made_reach = j.reach + g->options.skin;
  s = check_needs(&j);
  if (!s) s = relate(&j);
  if (!s) s = find_images(&j, &total);
  if (!s) s = remember(&j);
  if (!s) s = resize(set, total);
  if (s) return s;
  j.x = sph_particles_field_const(set, g->options.position_field); /* may have moved */
  commit(&j, set, total);
  return sphi_mirror_write(g, set, t, next);
}
