/* The calls on the ghosts of a set: update, refresh, the prepare hook, particles put back. */
#include "boundary_impl.h"

static sph_status check(sph_ghosts *g, const sph_particles *set) {
  sph_status s = sphi_check_handle(NULL, g, SPHI_MAGIC_GHOSTS, "ghosts");
  if (!s) s = sphi_check_handle(g->base.ctx, set, SPHI_MAGIC_PARTICLES, "set");
  return s ? s : sphi_mirror_check(g, set);
}

sph_status sph_ghosts_update(sph_ghosts *g, sph_particles *set, double t) {
  sph_wall next[SPHI_MAX_WALLS];
  sph_status s = check(g, set);
  if (!s) s = sphi_walls_at(g, t, next);
  return s ? s : sphi_images_update(g, set, t, next);
}

static int is_fresh(const sph_ghosts *g, const sph_particles *set) {
  return g->set == set && g->generation == sph_particles_generation(set) &&
         g->made_changes == g->changes;
}

static sph_status check_behind(sph_ghosts *g, const sph_particles *set, const sph_wall *next) {
  const int64_t behind = sphi_mirror_behind(g, set, next);
  if (behind < 0 || g->options.escape == SPH_ESCAPE_IGNORE) return SPH_OK;
  if (g->options.escape == SPH_ESCAPE_RETRY) return SPH_RETRY;
  return sphi_fail(g->base.ctx, SPH_ERR_STATE,
                   "ghosts: particle %lld, whose image is ghost %lld, is not in front of a wall",
                   (long long)((const int64_t *)g->owner.ptr)[behind], (long long)behind);
}

sph_status sph_ghosts_refresh(sph_ghosts *g, sph_particles *set, double t) {
  sph_wall next[SPHI_MAX_WALLS];
  sph_status s = check(g, set);
  if (s) return s;
  if (!is_fresh(g, set))
    return sphi_fail(g->base.ctx, SPH_ERR_STATE,
                     "ghosts: the particles or the walls changed since the last update");
  s = sphi_walls_at(g, t, next);
  if (!s) s = check_behind(g, set, next);
  return s ? s : sphi_mirror_write(g, set, t, next);
}

static sph_status prepare(sph_ghosts *g, sph_particles *set, double t) {
  sph_wall next[SPHI_MAX_WALLS];
  sph_status s = check(g, set);
  if (!s) s = sphi_walls_at(g, t, next);
  if (s) return s;
  if (sphi_images_serve(g, set, next) && sphi_mirror_behind(g, set, next) < 0)
    return sphi_mirror_write(g, set, t, next);
  return sphi_images_update(g, set, t, next);
}

int32_t sph_ghosts_prepare(void *ghosts, double t, sph_particles *set, const sph_rate *rates,
                           int32_t count) {
  (void)rates;
  (void)count;
  return prepare(ghosts, set, t);
}

static int is_ghosts(const sph_ghosts *g) {
  return sphi_check_handle(NULL, g, SPHI_MAGIC_GHOSTS, "ghosts") == SPH_OK;
}

int64_t sph_ghosts_count(const sph_ghosts *g) { return is_ghosts(g) ? g->count : -1; }

const int64_t *sph_ghosts_owners(const sph_ghosts *g) { return is_ghosts(g) ? g->owner.ptr : NULL; }

const uint32_t *sph_ghosts_walls(const sph_ghosts *g) { return is_ghosts(g) ? g->mask.ptr : NULL; }

/* --- escaped particles ------------------------------------------------------------------- */

/* Mirror the place, and turn the velocity relative to the wall where it points outwards. */
static void put_back(const sph_wall *w, int32_t dim, double d, double *x, double *v) {
  double outwards = 0.0;
  for (int32_t a = 0; v && a < dim; ++a) outwards += (v[a] - w->data.velocity[a]) * w->normal[a];
  for (int32_t a = 0; a < dim; ++a) {
    x[a] -= 2.0 * d * w->normal[a];
    if (v && outwards < 0.0) v[a] -= 2.0 * outwards * w->normal[a];
  }
}

static int recapture(const sph_ghosts *g, int32_t phase, double *x, double *v) {
  int moved = 0;
  for (int32_t k = 0; k < g->walls; ++k) {
    const sph_wall *w = &g->wall[k];
    if (w->phase >= 0 && w->phase != phase) continue;
    const sphi_plane plane = sphi_wall_plane(g, g->wall, k);
    const double d = sphi_plane_distance(&plane, g->options.dim, x);
    if (!(d < 0.0)) continue;
    put_back(w, g->options.dim, d, x, v);
    moved = 1;
  }
  return moved;
}

sph_status sph_ghosts_recapture(sph_ghosts *g, sph_particles *set, int64_t *count) {
  double *x, *v = NULL;
  int64_t moved = 0;
  sph_status s = check(g, set);
  if (!s) s = sph_particles_field(set, SPH_FIELD_X, &x);
  if (!s && sph_particles_field_const(set, SPH_FIELD_V))
    s = sph_particles_field(set, SPH_FIELD_V, &v);
  if (s) return s;
  const int32_t dim = g->options.dim, *phases = sphi_particles_phases(set);
  if (g->options.position_field == SPH_FIELD_X)
    for (int64_t i = 0; i < sph_particles_real_count(set); ++i)
      moved += recapture(g, phases[i], x + i * dim, v ? v + i * dim : NULL);
  if (count) *count = moved;
  return moved > 0 ? sph_particles_touch(set, SPH_FIELD_X) : SPH_OK;
}
