/* No-slip by pairs, He 2015 (3.10) and (3.11). */
#include "boundary_impl.h"

#include <math.h>

/* A ghost behind a PAIRWISE wall as the particle i sees it. */
typedef struct seen_ghost {
  double mass;          /* its owner's */
  double difference[3]; /* v_j - v_i = beta (v_b - v_i) */
} seen_ghost;

/* Of the PAIRWISE walls of the ghost the one that the line from i to j meets first: the smallest
 * d_i / (d_i + d_j). -1: there is none. */
static int32_t first_wall(const sph_ghosts *g, uint32_t mask, const double *xi, const double *dx,
                          double *di, double *dj) {
  const int32_t dim = g->options.dim;
  double best = INFINITY;
  int32_t found = -1;
  for (int32_t w = 0; mask >> w; ++w) {
    if (!(mask >> w & 1) || g->wall[w].kind != SPH_WALL_PAIRWISE) continue;
    const sphi_plane plane = sphi_wall_plane(g, g->wall, w);
    const double a = sphi_plane_distance(&plane, dim, xi);
    const double b = sphi_dot(dim, plane.normal, dx) - a; /* x_j = x_i - dx lies behind */
    const double fraction = a + b != 0.0 ? a / (a + b) : 0.0;
    if (fraction >= best) continue;
    best = fraction;
    found = w;
    *di = a;
    *dj = b;
  }
  return found;
}

static double beta_of(const sph_wall *wall, double di, double dj) {
  if (!(di > 0.0)) return isinf(wall->beta_max) ? 1.0 : wall->beta_max;
  return fmin(wall->beta_max, 1.0 + dj / di);
}

/* At the foot of x, where the wall's data vary along it. */
static sph_wall_data data_at(const sph_ghosts *g, int32_t w, double d, const double *x) {
  const sph_wall *wall = &g->wall[w];
  sph_wall_data data = wall->data;
  if (!wall->vary) return data;
  const sphi_plane plane = sphi_wall_plane(g, g->wall, w);
  double foot[3] = {0.0, 0.0, 0.0};
  for (int32_t a = 0; a < g->options.dim; ++a) foot[a] = x[a] - d * plane.normal[a];
  wall->vary(wall->vary_user, g->time, foot, &data);
  return data;
}

/* Whether pair k of the block is one of these; *s then tells how it is seen. */
static int see(const sph_ghosts *g, const sph_pair_block *b, int32_t k, seen_ghost *s) {
  const int64_t ghost = b->j[k] - g->real_count, i = b->i;
  const int32_t dim = g->options.dim;
  double di, dj;
  if (ghost < 0 || ghost >= g->count) return 0;
  const uint32_t mask = ((const uint32_t *)g->mask.ptr)[ghost];
  const int32_t w = first_wall(g, mask, g->x + i * dim, b->dx + k * dim, &di, &dj);
  if (w < 0) return 0;
  const double beta = beta_of(&g->wall[w], di, dj);
  const sph_wall_data data = data_at(g, w, di, g->x + i * dim);
  s->mass = g->m ? g->m[((const int64_t *)g->owner.ptr)[ghost]] : 0.0;
  for (int32_t a = 0; a < dim; ++a)
    s->difference[a] = g->v ? beta * (data.velocity[a] - g->v[i * dim + a]) : 0.0;
  return 1;
}

static int usable(const sph_ghosts *g) {
  return sphi_check_handle(NULL, g, SPHI_MAGIC_GHOSTS, "ghosts") == SPH_OK && g->x && g->rho;
}

void sph_no_slip_gradient(void *ghosts, const sph_pair_block *b, double *out) {
  const sph_ghosts *g = ghosts;
  const int32_t dim = b->dim;
  seen_ghost s;
  if (!usable(g)) return;
  for (int32_t k = 0; k < b->count; ++k) {
    if (!see(g, b, k, &s)) continue;
    const double volume = s.mass / g->rho[b->i] * b->f[k];
    for (int32_t a = 0; a < dim; ++a)
      for (int32_t c = 0; c < dim; ++c)
        out[a * dim + c] += volume * s.difference[a] * b->dx[k * dim + c];
  }
}

void sph_no_slip_continuity(void *ghosts, const sph_pair_block *b, double *out) {
  const sph_ghosts *g = ghosts;
  seen_ghost s;
  if (!usable(g)) return;
  for (int32_t k = 0; k < b->count; ++k)
    if (see(g, b, k, &s))
      out[0] -= s.mass * b->f[k] * sphi_dot(b->dim, s.difference, b->dx + k * b->dim);
}

void sph_no_slip_stress(void *ghosts, const sph_pair_block *b, double *out) {
  const sph_ghosts *g = ghosts;
  const int32_t dim = b->dim;
  double sigma[3][3];
  seen_ghost s;
  if (!usable(g) || !g->sigma) return;
  sphi_sym_unpack(dim, g->sigma + b->i * sph_sym_components(dim), sigma);
  for (int32_t k = 0; k < b->count; ++k) {
    if (!see(g, b, k, &s)) continue;
    const double factor = 2.0 * s.mass / (g->rho[b->i] * g->rho[b->i]) * b->f[k];
    for (int32_t a = 0; a < dim; ++a) out[a] += factor * sphi_dot(dim, sigma[a], b->dx + k * dim);
  }
}

void sph_no_slip_pressure(void *ghosts, const sph_pair_block *b, double *out) {
  const sph_ghosts *g = ghosts;
  const int32_t dim = b->dim;
  seen_ghost s;
  if (!usable(g)) return;
  /* a material may have made the field after the hook */
  const double *p = sph_particles_field_const(g->set, SPH_FIELD_P);
  if (!p) return;
  for (int32_t k = 0; k < b->count; ++k) {
    if (!see(g, b, k, &s)) continue;
    const double factor = 2.0 * s.mass * p[b->i] / (g->rho[b->i] * g->rho[b->i]) * b->f[k];
    for (int32_t a = 0; a < dim; ++a) out[a] -= factor * b->dx[k * dim + a];
  }
}
