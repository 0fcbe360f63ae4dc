/* Values of the ghosts: every field of the owner, passed through one wall after the other. */
#include "boundary_impl.h"

#include <math.h>
#include <string.h>

enum { GRAIN = 256, COLUMNS = SPHI_FIELD_IDS };

/* One field to mirror. */
typedef struct column {
  int32_t field, mirror, components;
  double *values;
} column;

typedef struct mirror_job {
  const sph_ghosts *g;
  const sph_wall *wall;
  sphi_plane plane[SPHI_MAX_WALLS]; /* by which distances are judged */
  double t;
  int32_t dim;
  int64_t first; /* ghost */
  const int64_t *owner;
  const uint32_t *mask;
  const double *place; /* the position field */
  const double *rho;
  const double *gradient; /* the field with the velocity gradients, or NULL */
  const double *x0;       /* X0 in a frozen configuration, or NULL */
  int32_t *phases;
  int32_t columns, walled; /* the first `walled` are changed by walls, the others copied */
  column column[COLUMNS];
  int32_t changed[3]; /* X, X0, H: whether some ghost's value did */
  int64_t behind;     /* lowest ghost whose owner is not in front; INT64_MAX: none */
} mirror_job;

/* One ghost passing through one wall. */
typedef struct crossing {
  const sph_wall *wall;
  const sphi_plane *reference;
  double d, rho;
  sph_wall_data data;
  const double *L;  /* velocity gradient of what passes; NULL: not known */
  const double *x0; /* its X0 where X is X0 + u; else NULL */
  double c[3];      /* -2 d rho (a_b - g), the change of the traction across the wall */
} crossing;

/* --- fields ------------------------------------------------------------------------------ */

static int fits(const sph_ghosts *g, int32_t field, int32_t components) {
  const int32_t dim = g->options.dim, mirror = g->mirror[field];
  if (field == g->options.gradient_field && components != dim * dim) return 0;
  if (mirror == SPH_MIRROR_VECTOR) return components == dim;
  if (mirror == SPH_MIRROR_MATRIX) return components == dim * dim;
  return mirror != SPH_MIRROR_TENSOR || components == sph_sym_components(dim);
}

sph_status sphi_mirror_check(const sph_ghosts *g, const sph_particles *set) {
  if (sph_particles_dim(set) != g->options.dim)
    return sphi_fail(g->base.ctx, SPH_ERR_ARG, "ghosts: the set is %d-D, the walls %d-D",
                     sph_particles_dim(set), g->options.dim);
  if (g->options.gradient_field >= 0 && !sph_particles_components(set, g->options.gradient_field))
    return sphi_fail(g->base.ctx, SPH_ERR_ARG, "ghosts: the set has no gradient_field %d",
                     g->options.gradient_field);
  for (int32_t f = 0; f < SPHI_FIELD_IDS; ++f) {
    const int32_t components = sph_particles_components(set, f);
    if (components > 0 && !fits(g, f, components))
      return sphi_fail(g->base.ctx, SPH_ERR_ARG,
                       "ghosts: mirror %d does not fit the %d components of field %s", g->mirror[f],
                       components, sphi_field_name(set, f));
  }
  return SPH_OK;
}

static void collect(mirror_job *j, sph_particles *set, int copies) {
  for (int32_t f = 0; f < SPHI_FIELD_IDS; ++f) {
    column *c = &j->column[j->columns];
    const int32_t mirror = j->g->mirror[f];
    if (mirror == SPH_MIRROR_LEAVE || (mirror == SPH_MIRROR_COPY) != copies) continue;
    if (!sph_particles_field_const(set, f)) continue;
    if (sph_particles_field(set, f, &c->values)) continue; /* it exists, so this does not fail */
    c->field = f;
    c->mirror = mirror;
    c->components = sph_particles_components(set, f);
    j->columns++;
  }
}

static void collect_fields(mirror_job *j, sph_particles *set) {
  collect(j, set, 0);
  j->walled = j->columns;
  collect(j, set, 1);
}

/* --- through one wall -------------------------------------------------------------------- */

/* u += 2 (shift - u.n) n, the mirror image of a point or vector. */
static void reflect(int32_t dim, double *u, const double *n, double shift) {
  const double along = 2.0 * (shift - sphi_dot(dim, u, n));
  for (int32_t a = 0; a < dim; ++a) u[a] += along * n[a];
}

/* s -> Q s Q = s - 2 (s n) n^T - 2 n (s n)^T + 4 (n.s n) n n^T. */
static void reflect_tensor(double s[3][3], const double *n) {
  double sn[3];
  for (int a = 0; a < 3; ++a) sn[a] = sphi_dot(3, s[a], n);
  const double nsn = sphi_dot(3, sn, n);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      s[a][b] += -2.0 * (sn[a] * n[b] + n[a] * sn[b]) + 4.0 * nsn * n[a] * n[b];
}

/* About the plane; in a frozen configuration x = X0 + u, with u as the velocity would be. */
static void mirror_position(int32_t dim, const crossing *c, double *x) {
  const sph_wall *w = c->wall;
  double image[3] = {0.0, 0.0, 0.0}, moved[3] = {0.0, 0.0, 0.0};
  if (!c->x0) {
    reflect(dim, x, w->normal, sphi_dot(dim, w->point, w->normal));
    return;
  }
  for (int32_t a = 0; a < dim; ++a) {
    image[a] = c->x0[a];
    moved[a] = w->point[a] - c->reference->point[a];
    x[a] -= c->x0[a];
    if (w->kind != SPH_WALL_SLIP && w->kind != SPH_WALL_TRACTION) x[a] = 2.0 * moved[a] - x[a];
  }
  if (w->kind == SPH_WALL_SLIP) reflect(dim, x, w->normal, sphi_dot(dim, moved, w->normal));
  reflect(dim, image, c->reference->normal,
          sphi_dot(dim, c->reference->point, c->reference->normal));
  for (int32_t a = 0; a < dim; ++a) x[a] += image[a];
}

/* What the velocity gradient tells: D_t = tr L - n.L n and grad_t v_n = L^T n - (n.L n) n. */
static double along_wall(int32_t dim, const crossing *x, double *slope) {
  const double *n = x->wall->normal;
  double trace = 0.0, nLn = 0.0;
  for (int32_t b = 0; b < dim; ++b) {
    slope[b] = 0.0;
    for (int32_t a = 0; x->L && a < dim; ++a) slope[b] += n[a] * x->L[a * dim + b];
    if (x->L) trace += x->L[b * dim + b];
    nLn += slope[b] * n[b];
  }
  for (int32_t b = 0; b < dim; ++b) slope[b] -= nLn * n[b];
  return trace - nLn;
}

/* v_r - 2 d dv/dn from Hooke's law, with w = -dt/dt. */
static void traction_velocity(int32_t dim, const crossing *x, double *v) {
  const double *n = x->wall->normal, *rate = x->data.traction_rate;
  const double M = x->wall->modulus, G = x->wall->shear_modulus, w_n = -sphi_dot(dim, rate, n);
  double slope[3];
  const double spread = along_wall(dim, x, slope);
  const double normal = M > 0.0 ? (w_n - (M - 2.0 * G) * spread) / M : 0.0;
  for (int32_t a = 0; a < dim; ++a) {
    const double across = G > 0.0 ? (-rate[a] - w_n * n[a]) / G - slope[a] : 0.0;
    v[a] -= 2.0 * x->d * (normal * n[a] + across);
  }
}

static void mirror_velocity(int32_t dim, const crossing *x, double *v) {
  const double *vb = x->data.velocity, *n = x->wall->normal;
  double beta = 2.0;
  switch (x->wall->kind) {
  case SPH_WALL_SLIP:
    reflect(dim, v, n, sphi_dot(dim, vb, n));
    return;
  case SPH_WALL_TRACTION:
    traction_velocity(dim, x, v);
    return;
  case SPH_WALL_NO_SLIP:
  case SPH_WALL_PAIRWISE: /* what the library's terms would see, had the ghost a mass */
    beta = fmin(x->wall->beta_max, 2.0);
    break;
  default:
    break;
  }
  for (int32_t a = 0; a < dim; ++a) v[a] = (1.0 - beta) * v[a] + beta * vb[a];
}

static void mirror_stress(int32_t dim, const crossing *x, double *packed) {
  double s[3][3], c[3];
  const double *n = x->wall->normal;
  sphi_sym_unpack(dim, packed, s);
  memcpy(c, x->c, sizeof c);
  if (x->wall->kind == SPH_WALL_SLIP) {
    const double along = sphi_dot(3, c, n);
    reflect_tensor(s, n);
    for (int a = 0; a < 3; ++a) c[a] = along * n[a];
  } else if (x->wall->kind == SPH_WALL_TRACTION)
    for (int a = 0; a < 3; ++a) c[a] = 2.0 * (-x->data.traction[a] - sphi_dot(3, s[a], n));
  sphi_change_traction(s, n, c);
  sphi_sym_pack(dim, s, packed);
}

/* dp/dn = -rho (a_b - g).n, so that p_g = p_r - c.n. */
static double mirror_pressure(const crossing *x, double p) {
  const double *n = x->wall->normal;
  if (x->wall->kind == SPH_WALL_TRACTION) return 2.0 * sphi_dot(3, x->data.traction, n) - p;
  return p - sphi_dot(3, x->c, n);
}

/* f -> f Q, and Q f. */
static void reflect_columns(int32_t dim, double *f, const double *n) {
  for (int32_t a = 0; a < dim; ++a) reflect(dim, f + a * dim, n, 0.0);
}
static void reflect_rows(int32_t dim, double *f, const double *n) {
  for (int32_t b = 0; b < dim; ++b) {
    double along = 0.0;
    for (int32_t a = 0; a < dim; ++a) along += n[a] * f[a * dim + b];
    for (int32_t a = 0; a < dim; ++a) f[a * dim + b] -= 2.0 * along * n[a];
  }
}

/* L -> Q L Q, -L Q where velocities are odd, L where they are continued. */
static void mirror_gradient(int32_t dim, const crossing *x, double *L) {
  const int32_t kind = x->wall->kind;
  if (kind == SPH_WALL_TRACTION) return;
  reflect_columns(dim, L, x->wall->normal);
  if (kind == SPH_WALL_SLIP)
    reflect_rows(dim, L, x->wall->normal);
  else
    for (int32_t k = 0; k < dim * dim; ++k) L[k] = -L[k];
}

/* The fields whose mirror is their wall's. */
static void through_wall(int32_t dim, const crossing *x, int32_t field, double *f) {
  const double *n = x->wall->normal;
  switch (field) {
  case SPH_FIELD_X:
    mirror_position(dim, x, f);
    break;
  case SPH_FIELD_X0:
    reflect(dim, f, x->reference->normal, sphi_dot(dim, x->reference->point, x->reference->normal));
    break;
  case SPH_FIELD_V:
    mirror_velocity(dim, x, f);
    break;
  case SPH_FIELD_SIGMA:
    mirror_stress(dim, x, f);
    break;
  case SPH_FIELD_P:
    f[0] = mirror_pressure(x, f[0]);
    break;
  case SPH_FIELD_A:
    reflect(dim, f, n, 0.0);
    break;
  case SPH_FIELD_M: /* pairs that the library's terms must not see, or an escaped owner */
    if (x->wall->kind == SPH_WALL_PAIRWISE || !(x->d > 0.0)) f[0] = 0.0;
    break;
  default:
    mirror_gradient(dim, x, f);
    break;
  }
}

static void mirror_tensor(int32_t dim, const double *n, double *packed) {
  double s[3][3];
  sphi_sym_unpack(dim, packed, s);
  reflect_tensor(s, n);
  sphi_sym_pack(dim, s, packed);
}

static void apply(int32_t dim, const crossing *x, const column *c, double *f) {
  if (c->mirror == SPH_MIRROR_WALL)
    through_wall(dim, x, c->field, f);
  else if (c->mirror == SPH_MIRROR_VECTOR)
    reflect(dim, f, x->wall->normal, 0.0);
  else if (c->mirror == SPH_MIRROR_TENSOR)
    mirror_tensor(dim, x->wall->normal, f);
  else if (c->mirror == SPH_MIRROR_MATRIX) {
    reflect_columns(dim, f, x->wall->normal);
    reflect_rows(dim, f, x->wall->normal);
  }
}

/* --- one ghost --------------------------------------------------------------------------- */

/* Walls at right angles do not change each other's distance: d is the owner's for each. */
static crossing make_crossing(const mirror_job *j, int64_t owner, int32_t w) {
  const sph_wall *wall = &j->wall[w];
  const double *x = j->place + owner * j->dim;
  crossing c = {.wall = wall, .reference = &j->g->reference[w], .data = wall->data};
  c.d = sphi_plane_distance(&j->plane[w], j->dim, x);
  c.rho = j->rho ? j->rho[owner] : 0.0;
  if (wall->vary) {
    double foot[3] = {0.0, 0.0, 0.0};
    for (int32_t a = 0; a < j->dim; ++a) foot[a] = x[a] - c.d * j->plane[w].normal[a];
    wall->vary(wall->vary_user, j->t, foot, &c.data);
  }
  for (int32_t a = 0; a < j->dim; ++a)
    c.c[a] = -2.0 * c.d * c.rho * (c.data.acceleration[a] - j->g->options.gravity[a]);
  return c;
}

/* Fields that neighbour lists and kept configurations watch: 0, 1, 2 for X, X0, H, else -1. */
static int watched(int32_t field) {
  if (field == SPH_FIELD_X) return 0;
  if (field == SPH_FIELD_X0) return 1;
  return field == SPH_FIELD_H ? 2 : -1;
}

/* The owner's values; those that are watched as they were go to `old`. */
static void copy_owner(const mirror_job *j, int64_t ghost, int64_t owner, double old[3][3]) {
  for (int32_t f = 0; f < j->columns; ++f) {
    const column *c = &j->column[f];
    const int k = watched(c->field);
    const double *from = c->values + owner * c->components;
    double *to = c->values + ghost * c->components;
    for (int32_t a = 0; k >= 0 && a < c->components; ++a) old[k][a] = to[a];
    for (int32_t a = 0; a < c->components; ++a) to[a] = from[a];
  }
  j->phases[ghost] = j->phases[owner];
}

/* Bits are compared, as a NaN that stays is no change. */
static void notice_changes(mirror_job *j, int64_t ghost, double old[3][3]) {
  for (int32_t f = 0; f < j->columns; ++f) {
    const column *c = &j->column[f];
    const int k = watched(c->field);
    if (k < 0 || __atomic_load_n(&j->changed[k], __ATOMIC_RELAXED)) continue;
    if (memcmp(old[k], c->values + ghost * c->components, (size_t)c->components * sizeof(double)) !=
        0)
      __atomic_store_n(&j->changed[k], 1, __ATOMIC_RELAXED);
  }
}

static void mirror_ghost(mirror_job *j, int64_t k) {
  const int64_t owner = j->owner[k], ghost = j->first + k;
  double old[3][3];
  copy_owner(j, ghost, owner, old);
  for (int32_t w = 0; j->mask[k] >> w; ++w) {
    if (!(j->mask[k] >> w & 1)) continue;
    crossing x = make_crossing(j, owner, w);
    /* X and V come before the fields that they need as these were in front of the wall */
    if (j->gradient) x.L = j->gradient + ghost * j->dim * j->dim;
    if (j->x0) x.x0 = j->x0 + ghost * j->dim;
    for (int32_t f = 0; f < j->walled; ++f)
      apply(j->dim, &x, &j->column[f], j->column[f].values + ghost * j->column[f].components);
  }
  notice_changes(j, ghost, old);
}

static void mirror_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  (void)worker;
  for (int64_t k = lo; k < hi; ++k) mirror_ghost(job, k);
}

/* --- all ghosts -------------------------------------------------------------------------- */

static mirror_job make_job(const sph_ghosts *g, const sph_particles *set, double t,
                           const sph_wall *next) {
  mirror_job j = {.g = g, .wall = next, .t = t, .dim = g->options.dim, .behind = INT64_MAX};
  j.first = g->real_count;
  j.owner = g->owner.ptr;
  j.mask = g->mask.ptr;
  j.place = sph_particles_field_const(set, g->options.position_field);
  j.rho = sph_particles_field_const(set, SPH_FIELD_RHO);
  if (g->options.position_field == SPH_FIELD_X0)
    j.x0 = sph_particles_field_const(set, SPH_FIELD_X0);
  if (g->options.gradient_field >= 0)
    j.gradient = sph_particles_field_const(set, g->options.gradient_field);
  for (int32_t w = 0; w < g->walls; ++w) j.plane[w] = sphi_wall_plane(g, next, w);
  return j;
}

static void behind_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  mirror_job *j = job;
  (void)worker;
  for (int64_t k = lo; k < hi; ++k)
    for (int32_t w = 0; j->mask[k] >> w; ++w)
      if ((j->mask[k] >> w & 1) &&
          sphi_plane_distance(&j->plane[w], j->dim, j->place + j->owner[k] * j->dim) <= 0.0)
        sphi_lowest(&j->behind, k);
}

int64_t sphi_mirror_behind(sph_ghosts *g, const sph_particles *set, const sph_wall *next) {
  mirror_job j = make_job(g, set, 0.0, next);
  sphi_parallel(g->base.ctx, g->count, GRAIN, behind_range, &j);
  return j.behind == INT64_MAX ? -1 : j.behind;
}

/* What the pair functions read. */
static void keep_arrays(sph_ghosts *g, const sph_particles *set) {
  g->x = sph_particles_field_const(set, g->options.position_field);
  g->v = sph_particles_field_const(set, SPH_FIELD_V);
  g->m = sph_particles_field_const(set, SPH_FIELD_M);
  g->rho = sph_particles_field_const(set, SPH_FIELD_RHO);
  g->sigma = sph_particles_field_const(set, SPH_FIELD_SIGMA);
}

/* Only what changed, so that lists and kept configurations live on. */
static sph_status touch_changed(const mirror_job *j, sph_particles *set) {
  static const int32_t fields[3] = {SPH_FIELD_X, SPH_FIELD_X0, SPH_FIELD_H};
  sph_status s = SPH_OK;
  for (int k = 0; k < 3 && !s; ++k)
    if (j->changed[k]) s = sph_particles_touch(set, fields[k]);
  return s;
}

sph_status sphi_mirror_write(sph_ghosts *g, sph_particles *set, double t, const sph_wall *next) {
  mirror_job j = make_job(g, set, t, next);
  j.phases = sph_particles_phases(set);
  collect_fields(&j, set);
  sphi_parallel(g->base.ctx, g->count, GRAIN, mirror_range, &j);
  if (g->walls > 0) memcpy(g->wall, next, (size_t)g->walls * sizeof *next);
  keep_arrays(g, set);
  g->time = t;
  return touch_changed(&j, set);
}
