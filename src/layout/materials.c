/* Layouts of several materials: each phase filled by itself, one after the other. */
#include "relax.h"

#include <math.h>
#include <string.h>

static const char function[] = "sph_layout_materials";

enum { PHASES_MAX = 256 };

void sph_material_layout_options_init_sized(sph_material_layout_options *options, size_t size) {
  const sph_material_layout_options defaults = {.size = sizeof defaults,
                                                .kind = SPH_LATTICE_CARTESIAN,
                                                .equal = SPH_EQUAL_MASS,
                                                .hi = {1.0, 1.0, 1.0},
                                                .phases = 1,
                                                .levels = 3};
  sphi_options_init(options, size, &defaults, sizeof defaults);
}

/* ---- checks ------------------------------------------------------------------------------ */

static int positive(double x) { return isfinite(x) && x > 0.0; }

static sph_status check_phases(sph_context *ctx, const sph_material_layout_options *o) {
  if (o->phases < 1 || o->phases > PHASES_MAX)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: phases is %d, not 1..%d", function, (int)o->phases,
                     (int)PHASES_MAX);
  if (o->phases > 1 && o->phase == NULL && o->boxes == NULL)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: %d phases need `phase` or boxes", function,
                     (int)o->phases);
  for (int32_t k = 0; k < o->phases; ++k) {
    if (o->density != NULL && !positive(o->density[k]))
      return sphi_fail(ctx, SPH_ERR_ARG, "%s: the density of phase %d is %g", function, (int)k,
                       o->density[k]);
    if (o->boxes == NULL) continue;
    const double *box = o->boxes + (ptrdiff_t)k * 2 * o->dim;
    const sph_status s = sphi_check_box(ctx, function, o->dim, box, box + o->dim);
    if (s) return s;
  }
  return SPH_OK;
}

static sph_status check(sph_context *ctx, const sph_material_layout_options *o) {
  const sph_status s = sphi_check_box(ctx, function, o->dim, o->lo, o->hi);
  if (s) return s;
  if (o->kind < SPH_LATTICE_CARTESIAN || o->kind > SPH_LAYOUT_RELAXED)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: unknown kind %d", function, (int)o->kind);
  if (o->equal != SPH_EQUAL_MASS && o->equal != SPH_EQUAL_SPACING)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: equal is %d", function, (int)o->equal);
  if (!positive(o->spacing))
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: the spacing is %g", function, o->spacing);
  if (o->levels < 0 || o->levels > 12)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: levels is %d, not 0..12", function, (int)o->levels);
  return check_phases(ctx, o);
}

/* ---- one phase --------------------------------------------------------------------------- */

/* A host's answer beyond its phases is noted by the lowest such number, for the sentence. */
typedef struct selection {
  const sph_material_layout_options *o;
  int32_t phase;
  int64_t unknown; /* INT64_MAX: none */
} selection;

static int32_t is_selected(void *user, const double *at) {
  selection *s = user;
  const int32_t phase = s->o->phase(s->o->phase_user, at);
  if (phase >= s->o->phases) sphi_lowest(&s->unknown, phase);
  return phase == s->phase;
}

/* The particles of a phase, in buffers of their own. */
typedef struct filling {
  sph_context *ctx;
  const sph_material_layout_options *o;
  sph_relax_options relax;
  selection selected;
  double lo[3], hi[3]; /* the box of the phase */
  double spacing;
  int64_t n;
  sphi_buffer x, volume;
} filling;

static void set_box(filling *f) {
  const sph_material_layout_options *o = f->o;
  const double *box = o->boxes + (ptrdiff_t)f->selected.phase * 2 * o->dim;
  for (int32_t a = 0; a < o->dim; ++a) {
    f->lo[a] = o->boxes == NULL ? o->lo[a] : box[a];
    f->hi[a] = o->boxes == NULL ? o->hi[a] : box[o->dim + a];
  }
}

/* D_L (rho_L / rho)^(1/d), Zisis section 4.4 (a). */
static void set_spacing(filling *f) {
  const sph_material_layout_options *o = f->o;
  double least = INFINITY;
  f->spacing = o->spacing;
  if (o->equal == SPH_EQUAL_SPACING || o->density == NULL) return;
  for (int32_t k = 0; k < o->phases; ++k) least = fmin(least, o->density[k]);
  f->spacing *= pow(least / o->density[f->selected.phase], 1.0 / o->dim);
}

static sph_status reserve(filling *f, int64_t n) {
  const size_t values = sphi_mul((size_t)n, sizeof(double));
  sph_status s = sphi_buffer_reserve(f->ctx, &f->x, sphi_mul(values, (size_t)f->o->dim));
  return s ? s : sphi_buffer_reserve(f->ctx, &f->volume, values);
}

static sph_status unknown_phase(const filling *f) {
  if (f->selected.unknown == INT64_MAX) return SPH_OK;
  return sphi_fail(f->ctx, SPH_ERR_ARG, "%s: `phase` answers %lld, there are %d phases", function,
                   (long long)f->selected.unknown, (int)f->o->phases);
}

/* Points of a lattice within the phase; *cell is the volume of a cell of it. */
static sph_status lattice(filling *f, int32_t kind, double spacing, double *cell) {
  sph_lattice_options l;
  int64_t all = 0;
  sph_lattice_options_init(&l);
  l.dim = f->o->dim;
  l.kind = kind;
  l.spacing = spacing;
  *cell = 1.0;
  for (int32_t a = 0; a < l.dim; ++a) {
    l.lo[a] = f->lo[a];
    l.hi[a] = f->hi[a];
    *cell *= l.hi[a] - l.lo[a];
  }
  sph_status s = sph_layout_lattice(f->ctx, &l, 0, NULL, &all);
  *cell /= (double)all;
  l.inside = f->o->phase != NULL ? is_selected : NULL;
  l.inside_user = &f->selected;
  if (!s) s = sph_layout_lattice(f->ctx, &l, 0, NULL, &f->n);
  if (!s) s = unknown_phase(f);
  if (!s) s = reserve(f, f->n);
  return s || f->n == 0 ? s : sph_layout_lattice(f->ctx, &l, f->n, f->x.ptr, &f->n);
}

static sph_status fill_with_lattice(filling *f) {
  double cell;
  const sph_status s = lattice(f, f->o->kind, f->spacing, &cell);
  for (int64_t i = 0; !s && i < f->n; ++i) ((double *)f->volume.ptr)[i] = cell;
  return s;
}

/* ---- relaxed ----------------------------------------------------------------------------- */

static sph_region_options region_of(filling *f) {
  sph_region_options r;
  sph_region_options_init(&r);
  r.dim = f->o->dim;
  memcpy(r.lo, f->lo, sizeof r.lo);
  memcpy(r.hi, f->hi, sizeof r.hi);
  r.levels = f->o->levels;
  r.inside = f->o->phase != NULL ? is_selected : NULL;
  r.inside_user = &f->selected;
  return r;
}

/* Distance in a hexagonal lattice whose cells have the volume v: sqrt(3)/2 s^2, s^3 / sqrt(2). */
static double hexagonal_spacing(int32_t dim, double v) {
  return dim == 1 ? v : dim == 2 ? sqrt(v / sqrt(0.75)) : cbrt(sqrt(2.0) * v);
}

/* Every point of a phase that is filled with a lattice lies closer than that to a particle. */
static sphi_relax_limits limits_of(const filling *f) {
  enum { REACH = 2 };
  const int32_t coarse = f->o->dim == 3 ? 0 : 2;
  const int32_t levels = f->o->levels < coarse ? f->o->levels : coarse;
  return (sphi_relax_limits){levels, REACH * f->spacing};
}

static sph_status relax(filling *f, const sph_relax_options *options) {
  const sph_region_options r = region_of(f);
  const sphi_relax_limits limits = limits_of(f);
  sph_relax_result result;
  return sphi_relax(f->ctx, function, &r, options, &limits, f->n, f->x.ptr, f->volume.ptr, &result);
}

/* The volume of the phase, as the cells of the points in it share it. */
static sph_status measure(filling *f, double *total) {
  sph_relax_options stay = f->relax;
  stay.iterations = 0;
  const double *v = f->volume.ptr;
  const sph_status s = relax(f, &stay);
  *total = 0.0;
  for (int64_t i = 0; !s && i < f->n; ++i) *total += v[i];
  return s;
}

/* Keep `wanted` of the points, evenly over their order. */
static void drop(filling *f, int64_t wanted) {
  const size_t bytes = (size_t)f->o->dim * sizeof(double);
  char *x = f->x.ptr;
  for (int64_t k = 0; k < wanted; ++k) {
    const int64_t from = (int64_t)((double)f->n / (double)wanted * ((double)k + 0.5));
    memmove(x + (size_t)k * bytes, x + (size_t)from * bytes, bytes);
  }
  f->n = wanted;
}

/* Term k of the sequence of Roberts, R_d: multiples of the powers of 1/g, g^(d+1) = g + 1. */
static void scatter(const filling *f, int64_t k, double *at) {
  const double g[] = {0.0, 1.6180339887498949, 1.3247179572447460, 1.2207440846057596};
  double step = 1.0;
  for (int32_t a = 0; a < f->o->dim; ++a) {
    step /= g[f->o->dim];
    const double u = 0.5 + (double)k * step;
    at[a] = f->lo[a] + (f->hi[a] - f->lo[a]) * (u - floor(u));
  }
}

/* Append points of an even sequence that lie in the phase, until there are `wanted`. A phase that
 * is hit once in a million tries at most keeps what it has. */
static sph_status add(filling *f, int64_t wanted) {
  enum { TRIES = 1000000 };
  const int32_t dim = f->o->dim;
  sphi_buffer more = {NULL, 0};
  sph_status s =
      sphi_buffer_reserve(f->ctx, &more, sphi_mul(sphi_mul((size_t)wanted, (size_t)dim), 8));
  if (s) return s;
  double *x = more.ptr;
  if (f->n > 0) memcpy(x, f->x.ptr, (size_t)(f->n * dim) * sizeof *x);
  for (int64_t k = 1, last = 0; f->n < wanted && k - last < TRIES; ++k) {
    double at[3];
    scatter(f, k, at);
    if (f->o->phase != NULL && !is_selected(&f->selected, at)) continue;
    memcpy(x + f->n * dim, at, (size_t)dim * sizeof *x);
    f->n += 1;
    last = k;
  }
  sphi_buffer_free(f->ctx, &f->x);
  f->x = more;
  s = sphi_buffer_reserve(f->ctx, &f->volume, sphi_mul((size_t)f->n, sizeof *x));
  return s ? s : unknown_phase(f);
}

/* As many points as the volume of the phase asks for, not yet relaxed. */
static sph_status start_relaxed(filling *f) {
  const double target = pow(f->spacing, f->o->dim);
  double cell, total;
  sph_status s = lattice(f, SPH_LATTICE_HEXAGONAL, hexagonal_spacing(f->o->dim, target), &cell);
  if (!s && f->n == 0) s = add(f, 1);
  if (s || f->n == 0) return s;
  s = measure(f, &total);
  if (s) return s;
  const double count = fmax(1.0, round(total / target));
  if (count > (double)SPHI_LAYOUT_MAX)
    return sphi_fail(f->ctx, SPH_ERR_LIMIT, "%s: %g particles in phase %d", function, count,
                     (int)f->selected.phase);
  const int64_t wanted = (int64_t)count;
  if (wanted < f->n) drop(f, wanted);
  return wanted > f->n ? add(f, wanted) : SPH_OK;
}

static sph_status fill(filling *f, int move) {
  f->n = 0;
  set_box(f);
  set_spacing(f);
  if (f->o->kind != SPH_LAYOUT_RELAXED) return fill_with_lattice(f);
  const sph_status s = start_relaxed(f);
  return s || !move || f->n == 0 ? s : relax(f, &f->relax);
}

/* ---- all phases -------------------------------------------------------------------------- */

/* What the host gets, collected first. */
typedef struct collection {
  int64_t capacity, n;
  double *x, *volume;
  int32_t *phase;
} collection;

static sph_status append(collection *all, const filling *f) {
  const int32_t dim = f->o->dim;
  const int64_t from = all->n;
  all->n += f->n;
  if (all->n > SPHI_LAYOUT_MAX)
    return sphi_fail(f->ctx, SPH_ERR_LIMIT, "%s: more than %d particles", function,
                     (int)SPHI_LAYOUT_MAX);
  if (all->x == NULL || all->n > all->capacity || f->n == 0) return SPH_OK;
  memcpy(all->x + from * dim, f->x.ptr, (size_t)(f->n * dim) * sizeof(double));
  memcpy(all->volume + from, f->volume.ptr, (size_t)f->n * sizeof(double));
  for (int64_t i = from; i < all->n; ++i) all->phase[i] = f->selected.phase;
  return SPH_OK;
}

static sph_status fill_all(filling *f, collection *all) {
  sph_status s = SPH_OK;
  for (int32_t k = 0; k < f->o->phases && !s; ++k) {
    f->selected = (selection){f->o, k, INT64_MAX};
    s = fill(f, all->x != NULL);
    if (!s) s = append(all, f);
  }
  if (!s && all->x != NULL && all->n > all->capacity)
    s = sphi_fail(f->ctx, SPH_ERR_LIMIT, "%s: %lld particles, capacity is %lld", function,
                  (long long)all->n, (long long)all->capacity);
  return s;
}

static sph_status check_outputs(sph_context *ctx, int64_t capacity, const double *x,
                                const int32_t *phase, const double *volume, const int64_t *n) {
  const int given = (x != NULL) + (phase != NULL) + (volume != NULL);
  if (n != NULL && capacity >= 0 && (given == 3 || (given == 0 && capacity == 0))) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_ARG, "%s: capacity is %lld, x, phase and volume are %s, n is %s",
                   function, (long long)capacity,
                   given == 3   ? "given"
                   : given == 0 ? "NULL"
                                : "not all given",
                   n == NULL ? "NULL" : "given");
}

/* Into scratch of the capacity, and from there to the host when all is done. */
static sph_status collect(filling *f, collection *all, double *x, int32_t *phase, double *volume) {
  sphi_buffer b[3] = {{NULL, 0}, {NULL, 0}, {NULL, 0}};
  const size_t values = sphi_mul((size_t)all->capacity + 1, sizeof(double));
  const size_t dim = (size_t)f->o->dim;
  sph_status s = sphi_buffer_reserve(f->ctx, &b[0], sphi_mul(values, dim));
  if (!s) s = sphi_buffer_reserve(f->ctx, &b[1], values);
  if (!s) s = sphi_buffer_reserve(f->ctx, &b[2], values / 2);
  all->x = b[0].ptr;
  all->volume = b[1].ptr;
  all->phase = b[2].ptr;
  if (!s) s = fill_all(f, all);
  if (!s && all->n > 0) {
    memcpy(x, all->x, (size_t)all->n * dim * sizeof *x);
    memcpy(volume, all->volume, (size_t)all->n * sizeof *volume);
    memcpy(phase, all->phase, (size_t)all->n * sizeof *phase);
  }
  for (int k = 0; k < 3; ++k) sphi_buffer_free(f->ctx, &b[k]);
  return s;
}

sph_status sph_layout_materials(sph_context *ctx, const sph_material_layout_options *options,
                                int64_t capacity, double *x, int32_t *phase, double *volume,
                                int64_t *n) {
  sph_material_layout_options o;
  sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "context");
  if (s) return s;
  sph_material_layout_options_init(&o);
  if (options == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "%s: options is NULL", function);
  s = sphi_options_read(ctx, &o, sizeof o, options);
  filling f = {.ctx = ctx, .o = &o};
  collection all = {.capacity = capacity};
  sph_relax_options_init(&f.relax);
  if (!s && o.relax != NULL) s = sphi_options_read(ctx, &f.relax, sizeof f.relax, o.relax);
  if (!s) s = sphi_check_relax(ctx, function, &f.relax);
  if (!s) s = check_outputs(ctx, capacity, x, phase, volume, n);
  if (!s) s = check(ctx, &o);
  if (s) return s;
  s = x == NULL ? fill_all(&f, &all) : collect(&f, &all, x, phase, volume);
  sphi_buffer_free(ctx, &f.x);
  sphi_buffer_free(ctx, &f.volume);
  if (!s) *n = all.n;
  return s;
}
