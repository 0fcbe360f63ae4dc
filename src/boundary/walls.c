/* Life of a ghost handle, its walls, and where they are at a time. */
#include "boundary_impl.h"

#include <math.h>
#include <string.h>

void sph_wall_init_sized(sph_wall *wall, size_t size) {
  const sph_wall defaults = {.size = sizeof defaults, .phase = -1, .beta_max = 1.5};
  sphi_options_init(wall, size, &defaults, sizeof defaults);
}

void sph_ghosts_options_init_sized(sph_ghosts_options *options, size_t size) {
  const sph_ghosts_options defaults = {.size = sizeof defaults,
                                       .dim = 3,
                                       .position_field = SPH_FIELD_X,
                                       .support = 2.0,
                                       .escape = SPH_ESCAPE_FAIL,
                                       .gradient_field = -1};
  sphi_options_init(options, size, &defaults, sizeof defaults);
}

static int not_negative(double x) { return x >= 0.0 && isfinite(x); }

static int finite_vector(const double *v, int32_t dim) {
  for (int32_t a = 0; a < dim; ++a)
    if (!isfinite(v[a])) return 0;
  return 1;
}

static sph_status check_options(sph_context *ctx, const sph_ghosts_options *o) {
  if (o->dim < 1 || o->dim > 3)
    return sphi_fail(ctx, SPH_ERR_ARG, "ghosts: dim is %d, not 1, 2 or 3", o->dim);
  if (o->position_field != SPH_FIELD_X && o->position_field != SPH_FIELD_X0)
    return sphi_fail(ctx, SPH_ERR_ARG, "ghosts: position_field %d is neither X nor X0",
                     o->position_field);
  if (!not_negative(o->support) || !not_negative(o->reach) || !not_negative(o->skin) ||
      (o->support == 0.0 && o->reach == 0.0))
    return sphi_fail(ctx, SPH_ERR_ARG, "ghosts: support %g, reach %g, skin %g", o->support,
                     o->reach, o->skin);
  if (o->escape < SPH_ESCAPE_FAIL || o->escape > SPH_ESCAPE_IGNORE)
    return sphi_fail(ctx, SPH_ERR_ARG, "ghosts: unknown escape %d", o->escape);
  if (o->gradient_field != -1 && (o->gradient_field < 64 || o->gradient_field >= SPHI_FIELD_IDS))
    return sphi_fail(ctx, SPH_ERR_ARG, "ghosts: gradient_field %d is no field of the host's",
                     o->gradient_field);
  if (!finite_vector(o->gravity, o->dim))
    return sphi_fail(ctx, SPH_ERR_ARG, "ghosts: gravity is not finite");
  return SPH_OK;
}

static void set_default_mirrors(sph_ghosts *g) {
  static const int32_t by_wall[] = {SPH_FIELD_X, SPH_FIELD_X0, SPH_FIELD_V, SPH_FIELD_SIGMA,
                                    SPH_FIELD_P, SPH_FIELD_A,  SPH_FIELD_M};
  memset(g->mirror, SPH_MIRROR_COPY, sizeof g->mirror);
  for (size_t k = 0; k < sizeof by_wall / sizeof *by_wall; ++k)
    g->mirror[by_wall[k]] = SPH_MIRROR_WALL;
  g->mirror[SPH_FIELD_F] = g->mirror[SPH_FIELD_PK] = SPH_MIRROR_MATRIX;
}

sph_status sph_ghosts_create(sph_context *ctx, const sph_ghosts_options *options,
                             sph_ghosts **out) {
  sph_ghosts_options own;
  if (out) *out = NULL;
  sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (s) return s;
  if (!out) return sphi_fail(ctx, SPH_ERR_ARG, "ghosts: out is NULL");
  sph_ghosts_options_init(&own);
  s = sphi_options_read(ctx, &own, sizeof own, options);
  if (!s) s = check_options(ctx, &own);
  if (s) return s;
  for (int32_t a = own.dim; a < 3; ++a) own.gravity[a] = 0.0;
  sph_ghosts *g = sphi_calloc(ctx, sizeof *g);
  if (!g) return SPH_ERR_NOMEM;
  g->base.magic = SPHI_MAGIC_GHOSTS;
  g->base.ctx = ctx;
  g->options = own;
  set_default_mirrors(g);
  if (own.gradient_field >= 0) g->mirror[own.gradient_field] = SPH_MIRROR_WALL;
  sphi_context_retain(ctx);
  *out = g;
  return SPH_OK;
}

void sph_ghosts_destroy(sph_ghosts *g) {
  if (sphi_check_handle(NULL, g, SPHI_MAGIC_GHOSTS, "ghosts")) return;
  sph_context *ctx = g->base.ctx;
  sphi_buffer *all[] = {&g->owner, &g->mask, &g->seen, &g->next_owner, &g->next_mask, &g->parts};
  for (size_t k = 0; k < sizeof all / sizeof *all; ++k) sphi_buffer_free(ctx, all[k]);
  g->base.magic = 0;
  sphi_free(ctx, g, sizeof *g);
  sphi_context_release(ctx);
}

/* --- walls ------------------------------------------------------------------------------- */

static void clear_beyond(double *v, int32_t dim) {
  for (int32_t a = dim; a < 3; ++a) v[a] = 0.0;
}

/* Entries beyond the dimension do not count; the normal becomes a unit vector. Its largest entry
 * is taken out first, so that no square overflows. */
static int make_unit(double *n, int32_t dim) {
  double largest = 0.0, length;
  clear_beyond(n, dim);
  for (int32_t a = 0; a < dim; ++a) largest = fmax(largest, fabs(n[a]));
  if (!(largest > 0.0) || !isfinite(largest)) return 0;
  for (int32_t a = 0; a < dim; ++a) n[a] /= largest;
  length = sqrt(sphi_dot(dim, n, n));
  if (length != 1.0)
    for (int32_t a = 0; a < dim; ++a) n[a] /= length;
  return 1;
}

static int finite_wall(const sph_wall *w, int32_t dim) {
  const sph_wall_data *d = &w->data;
  return finite_vector(w->point, dim) && finite_vector(w->normal, dim) &&
         finite_vector(d->velocity, dim) && finite_vector(d->acceleration, dim) &&
         finite_vector(d->traction, dim) && finite_vector(d->traction_rate, dim);
}

/* Geometry and data; also what a callback wrote. */
static sph_status check_place(const sph_ghosts *g, sph_wall *w, int32_t index) {
  sph_context *ctx = g->base.ctx;
  const int32_t dim = g->options.dim;
  if (!finite_wall(w, dim))
    return sphi_fail(ctx, SPH_ERR_ARG, "ghosts: a number of wall %d is not finite", index);
  if (!make_unit(w->normal, dim))
    return sphi_fail(ctx, SPH_ERR_ARG, "ghosts: the normal of wall %d has length 0", index);
  double *const vectors[] = {w->point, w->data.velocity, w->data.acceleration, w->data.traction,
                             w->data.traction_rate};
  for (size_t k = 0; k < sizeof vectors / sizeof *vectors; ++k) clear_beyond(vectors[k], dim);
  for (int32_t a = 0; a < dim; ++a)
    if (g->options.periodic[a] && fabs(w->normal[a]) > 1e-12)
      return sphi_fail(ctx, SPH_ERR_ARG,
                       "ghosts: axis %d is periodic, but the normal of wall %d is %g along it", a,
                       index, w->normal[a]);
  return SPH_OK;
}

static sph_status check_facing(const sph_ghosts *g, const sph_wall *w, int32_t index) {
  for (int32_t k = 0; k < g->walls; ++k) {
    const sph_wall *other = &g->wall[k];
    if (k == index) continue;
    if (other->phase >= 0 && w->phase >= 0 && other->phase != w->phase) continue;
    if (sphi_dot(g->options.dim, other->normal, w->normal) > 1.0 - 1e-12)
      return sphi_fail(g->base.ctx, SPH_ERR_ARG, "ghosts: walls %d and %d face the same way", k,
                       index);
  }
  return SPH_OK;
}

static sph_status read_wall(const sph_ghosts *g, const sph_wall *wall, int32_t index,
                            sph_wall *own) {
  sph_context *ctx = g->base.ctx;
  sph_wall_init(own);
  sph_status s = sphi_options_read(ctx, own, sizeof *own, wall);
  if (s) return s;
  if (own->kind < SPH_WALL_SLIP || own->kind > SPH_WALL_VELOCITY)
    return sphi_fail(ctx, SPH_ERR_ARG, "ghosts: unknown kind %d of wall %d", own->kind, index);
  if (!(own->beta_max >= 1.0))
    return sphi_fail(ctx, SPH_ERR_ARG, "ghosts: beta_max %g of wall %d is below 1", own->beta_max,
                     index);
  if (!not_negative(own->modulus) || !not_negative(own->shear_modulus))
    return sphi_fail(ctx, SPH_ERR_ARG, "ghosts: moduli %g and %g of wall %d", own->modulus,
                     own->shear_modulus, index);
  s = check_place(g, own, index);
  return s ? s : check_facing(g, own, index);
}

sph_status sph_ghosts_add_wall(sph_ghosts *g, const sph_wall *wall, int32_t *index) {
  sph_wall own;
  sph_status s = sphi_check_handle(NULL, g, SPHI_MAGIC_GHOSTS, "ghosts");
  if (s) return s;
  if (!wall) return sphi_fail(g->base.ctx, SPH_ERR_ARG, "ghosts: the wall is NULL");
  if (g->walls == SPHI_MAX_WALLS)
    return sphi_fail(g->base.ctx, SPH_ERR_LIMIT, "ghosts: more than %d walls", SPHI_MAX_WALLS);
  s = read_wall(g, wall, g->walls, &own);
  if (s) return s;
  const int32_t k = g->walls++;
  g->wall[k] = own;
  memcpy(g->reference[k].point, own.point, sizeof own.point);
  memcpy(g->reference[k].normal, own.normal, sizeof own.normal);
  g->changes++;
  if (index) *index = k;
  return SPH_OK;
}

static sph_status check_index(const sph_ghosts *g, int32_t index) {
  if (index >= 0 && index < g->walls) return SPH_OK;
  return sphi_fail(g->base.ctx, SPH_ERR_ARG, "ghosts: wall %d of %d", index, g->walls);
}

sph_status sph_ghosts_set_wall(sph_ghosts *g, int32_t index, const sph_wall *wall) {
  sph_wall own;
  sph_status s = sphi_check_handle(NULL, g, SPHI_MAGIC_GHOSTS, "ghosts");
  if (s) return s;
  if (!wall) return sphi_fail(g->base.ctx, SPH_ERR_ARG, "ghosts: the wall is NULL");
  s = check_index(g, index);
  if (!s) s = read_wall(g, wall, index, &own);
  if (s) return s;
  if (own.phase != g->wall[index].phase) g->changes++;
  g->wall[index] = own;
  return SPH_OK;
}

sph_status sph_ghosts_get_wall(const sph_ghosts *g, int32_t index, sph_wall *wall) {
  sph_status s = sphi_check_handle(NULL, g, SPHI_MAGIC_GHOSTS, "ghosts");
  if (s) return s;
  if (!wall || wall->size < sizeof(size_t))
    return sphi_fail(g->base.ctx, SPH_ERR_ARG, "ghosts: the wall is %s",
                     wall ? "not initialised" : "NULL");
  s = check_index(g, index);
  if (s) return s;
  sphi_options_init(wall, wall->size, &g->wall[index], sizeof g->wall[index]);
  return SPH_OK;
}

sph_status sphi_walls_at(const sph_ghosts *g, double t, sph_wall *next) {
  for (int32_t k = 0; k < g->walls; ++k) {
    next[k] = g->wall[k];
    if (!next[k].move) continue;
    const int32_t answer = next[k].move(next[k].move_user, t, &next[k]);
    if (answer > 0) return SPH_RETRY;
    if (answer < 0)
      return sphi_fail(g->base.ctx, SPH_ERR_CALLBACK, "ghosts: the motion of wall %d answered %d",
                       k, answer);
    sph_status s = check_place(g, &next[k], k);
    if (s) return s;
  }
  return SPH_OK;
}

/* --- mirrors ----------------------------------------------------------------------------- */

static int by_wall(const sph_ghosts *g, int32_t field) {
  return field == g->options.gradient_field || field == SPH_FIELD_X || field == SPH_FIELD_X0 ||
         field == SPH_FIELD_V || field == SPH_FIELD_SIGMA || field == SPH_FIELD_P ||
         field == SPH_FIELD_A || field == SPH_FIELD_M;
}

sph_status sph_ghosts_set_mirror(sph_ghosts *g, int32_t field, int32_t mirror) {
  sph_status s = sphi_check_handle(NULL, g, SPHI_MAGIC_GHOSTS, "ghosts");
  if (s) return s;
  if (field < 0 || field >= SPHI_FIELD_IDS)
    return sphi_fail(g->base.ctx, SPH_ERR_ARG, "ghosts: there is no field %d", field);
  if (mirror < SPH_MIRROR_COPY || mirror > SPH_MIRROR_MATRIX ||
      (mirror == SPH_MIRROR_WALL && !by_wall(g, field)))
    return sphi_fail(g->base.ctx, SPH_ERR_ARG, "ghosts: mirror %d for field %d", mirror, field);
  g->mirror[field] = (int8_t)mirror;
  g->changes++;
  return SPH_OK;
}
