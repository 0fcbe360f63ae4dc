/* The exact Riemann problem of two materials: the pressure that keeps them together. */
#include "reference_impl.h"

#include <float.h>
#include <math.h>

static const sph_riemann_side defaults = {
    .law = SPH_RIEMANN_GAS, .gamma = 1.4, .curve = SPH_HUGONIOT_CUBIC};

void sph_riemann_side_init_sized(sph_riemann_side *side, size_t size) {
  sphi_options_init(side, size, &defaults, sizeof defaults);
}

void sph_riemann_solution_init_sized(sph_riemann_solution *solution, size_t size) {
  static const sph_riemann_solution none = {0};
  sphi_options_init(solution, size, &none, sizeof none);
}

/* ---- the two sides ----------------------------------------------------------------------- */

sph_status sphi_riemann_above(sph_context *ctx, const char *side, const char *what, double value,
                              double least, int closed) {
  if ((closed ? value >= least : value > least) && isfinite(value)) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_ARG, "%s: %s = %g must be finite and %s %g", side, what, value,
                   closed ? "at least" : "above", least);
}

static sph_status check_state(sph_context *ctx, const sph_riemann_side *g, const char *name) {
  if (!isfinite(g->p)) return sphi_fail(ctx, SPH_ERR_ARG, "%s: p = %g is not finite", name, g->p);
  if (g->law == SPH_RIEMANN_VOID) return SPH_OK;
  if (!isfinite(g->v)) return sphi_fail(ctx, SPH_ERR_ARG, "%s: v = %g is not finite", name, g->v);
  return sphi_riemann_above(ctx, name, "rho", g->rho, 0.0, 0);
}

/* What was derived from finite numbers may still overflow. */
static sph_status check_start(sph_context *ctx, const sphi_side *side, const char *name) {
  const sphi_wave *w = &side->start;
  if (isfinite(w->p) && isfinite(w->e) && isfinite(w->c) && isfinite(side->lowest)) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_NUMERIC, "%s: p = %g, e = %g, c = %g: beyond the numbers", name,
                   w->p, w->e, w->c);
}

static sph_status prepare(sph_context *ctx, const sph_riemann_side *given, const char *name,
                          sphi_side *side) {
  static const sphi_riemann_law *const laws[] = {NULL, &sphi_riemann_gas, &sphi_riemann_barotropic,
                                                 &sphi_riemann_mie_gruneisen, NULL};
  if (!given) return sphi_fail(ctx, SPH_ERR_ARG, "%s is NULL", name);
  *side = (sphi_side){.given = defaults};
  sph_status s = sphi_options_read(ctx, &side->given, sizeof side->given, given);
  if (s != SPH_OK) return s;
  const sph_riemann_side *g = &side->given;
  if (g->law < SPH_RIEMANN_GAS || g->law > SPH_RIEMANN_VOID)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: law = %d is unknown", name, (int)g->law);
  s = check_state(ctx, g, name);
  if (s != SPH_OK) return s;
  side->law = laws[g->law];
  side->lowest = g->p;
  side->start = (sphi_wave){.p = g->p, .rho = g->rho};
  if (!side->law) return SPH_OK;
  s = side->law->prepare(ctx, side, name);
  side->start.front = side->start.c;
  return s == SPH_OK ? check_start(ctx, side, name) : s;
}

static sph_status prepare_both(sph_context *ctx, const sph_riemann_side *left,
                               const sph_riemann_side *right, sphi_side side[2]) {
  sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (s == SPH_OK) s = prepare(ctx, left, "left", &side[0]);
  if (s == SPH_OK) s = prepare(ctx, right, "right", &side[1]);
  if (s != SPH_OK) return s;
  if (!side[0].law && !side[1].law)
    return sphi_fail(ctx, SPH_ERR_ARG, "left and right are both void");
  return SPH_OK;
}

/* ---- the pressure between them ----------------------------------------------------------- */

/* How fast the sides would overlap at the pressure p; negative when they drift apart ... */
static double closing(const void *user, double p) {
  const sphi_side *side = user;
  const double apart = side[1].given.v - side[0].given.v;
  return side[0].law->wave(&side[0], p).gain + side[1].law->wave(&side[1], p).gain + apart;
}

/* ... so that the wanted pressure is where `closing` is 0. A d for which it is positive at low + d
 * is found by doubling, or between what is too low and what the laws do not reach. */
static double reach(const sphi_side side[2], double low) {
  const double dv = side[1].given.v - side[0].given.v;
  double d = fmax(side[0].start.p, side[1].start.p) - low, good = 0.0, bad = INFINITY;
  if (!(d > 0.0)) d = fmax(fmax(side[0].given.rho, side[1].given.rho) * dv * dv, DBL_MIN);
  while (d > good && d < bad && low + d > low) {
    const double f = closing(side, low + d);
    if (f >= 0.0 && isfinite(f)) return d;
    *(isfinite(f) ? &good : &bad) = d;
    d = isfinite(bad) ? 0.5 * (good + bad) : 2.0 * d;
  }
  return NAN;
}

/* The pressure lies between `low`, where the sides drift apart, and low + d; d is halved first, for
 * it may be smaller by orders. */
static sph_status find_pressure(sph_context *ctx, const sphi_side side[2], double low, double *p) {
  double d = reach(side, low), half = 0.5 * d;
  if (isnan(d))
    return sphi_fail(ctx, SPH_ERR_NUMERIC,
                     "velocities %g and %g: no pressure that the laws reach stops the two sides",
                     side[0].given.v, side[1].given.v);
  while (low + half > low && closing(side, low + half) > 0.0) {
    d = half;
    half *= 0.5;
  }
  *p = sphi_root(closing, side, low + half, low + d);
  return SPH_OK;
}

/* The pressure, and whether a void opens. */
static sph_status middle(sph_context *ctx, const sphi_side side[2], double *p, int32_t *gap) {
  const double low = fmax(side[0].lowest, side[1].lowest);
  *gap = 0;
  *p = low;
  if (!side[0].law || !side[1].law) { /* the pressure of the void, as far as the other can */
    *gap = 1;
    return SPH_OK;
  }
  const double most = closing(side, low);
  *gap = most > 0.0;
  return most >= 0.0 ? SPH_OK : find_pressure(ctx, side, low, p);
}

/* ---- the solution ------------------------------------------------------------------------ */

static sph_status check_convex(sph_context *ctx, const sphi_side *side, const sphi_wave *behind,
                               int k) {
  if (!(behind->p < side->start.p) || !side->law->convex || side->law->convex(side, behind))
    return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_UNSUPPORTED,
                   "%s: between rho = %g and %g the law is not convex, its expansion is no fan",
                   k == 0 ? "left" : "right", behind->rho, side->start.rho);
}

/* One side of the solution; sign is -1 for the left, whose waves move to the left. */
static sph_status describe(sph_context *ctx, const sphi_side *side, int k, double p,
                           sph_riemann_solution *out) {
  const double sign = k == 0 ? -1.0 : 1.0, v = side->given.v;
  if (!side->law) return SPH_OK;
  const sphi_wave w = side->law->wave(side, p);
  out->rho[k] = w.rho;
  out->e[k] = w.e;
  out->c[k] = w.c;
  out->v[k] = v + sign * w.gain;
  out->head[k] = v + sign * w.front;
  out->tail[k] = p < side->start.p ? out->v[k] + sign * w.c : out->head[k];
  out->wave[k] = p < side->start.p ? SPH_WAVE_FAN : p > side->start.p ? SPH_WAVE_SHOCK : 0;
  return check_convex(ctx, side, &w, k);
}

static int all_finite(const sph_riemann_solution *s) {
  int finite = isfinite(s->p);
  for (int k = 0; k < 2; ++k)
    finite = finite && isfinite(s->v[k]) && isfinite(s->rho[k]) && isfinite(s->e[k]) &&
             isfinite(s->head[k]) && isfinite(s->tail[k]);
  return finite;
}

/* A side that is void moves with the surface of the other. A contact has one velocity: the two
 * waves give it to rounding, and the mean of them is symmetric. */
static void join(const sphi_side side[2], sph_riemann_solution *out) {
  for (int k = 0; k < 2; ++k)
    if (!side[k].law) out->v[k] = out->head[k] = out->tail[k] = out->v[1 - k];
  if (!out->gap) out->v[0] = out->v[1] = 0.5 * (out->v[0] + out->v[1]);
}

sph_status sph_riemann_solve(sph_context *ctx, const sph_riemann_side *left,
                             const sph_riemann_side *right, sph_riemann_solution *solution) {
  sphi_side side[2];
  sph_riemann_solution out = {0};
  sph_status s = prepare_both(ctx, left, right, side);
  if (s != SPH_OK) return s;
  if (!solution) return sphi_fail(ctx, SPH_ERR_ARG, "solution is NULL");
  const size_t size = solution->size;
  if (size < sizeof size || size > 4096)
    return sphi_fail(ctx, SPH_ERR_ARG,
                     "the size %zu of the solution was not set by its init function", size);
  s = middle(ctx, side, &out.p, &out.gap);
  for (int k = 0; k < 2 && s == SPH_OK; ++k) s = describe(ctx, &side[k], k, out.p, &out);
  if (s != SPH_OK) return s;
  join(side, &out);
  if (!all_finite(&out))
    return sphi_fail(ctx, SPH_ERR_NUMERIC, "the pressure %g is beyond what the laws reach", out.p);
  sphi_options_init(solution, size, &out, sizeof out);
  return SPH_OK;
}

/* ---- along rays -------------------------------------------------------------------------- */

typedef struct ray_state {
  double rho, v, p, e;
} ray_state;

static ray_state on_side(const sphi_side *side, int k, const sph_riemann_solution *s,
                         double speed) {
  const double sign = k == 0 ? -1.0 : 1.0;
  const sphi_wave *start = &side->start;
  if (!side->law) return (ray_state){0.0, NAN, start->p, 0.0};
  /* At a jump the state on its right: strict on one side, not on the other. */
  const int ahead = k == 0 ? speed < s->head[0] : speed >= s->head[1];
  const int behind = k == 0 ? speed >= s->tail[0] : speed < s->tail[1];
  if (ahead) return (ray_state){start->rho, side->given.v, start->p, start->e};
  if (behind || s->wave[k] != SPH_WAVE_FAN) return (ray_state){s->rho[k], s->v[k], s->p, s->e[k]};
  const sphi_wave w = side->law->fan(side, sign * (speed - side->given.v));
  return (ray_state){w.rho, side->given.v + sign * w.gain, w.p, w.e};
}

static ray_state on_ray(const sphi_side side[2], const sph_riemann_solution *s, double speed) {
  if (speed < s->v[0]) return on_side(&side[0], 0, s, speed);
  if (speed >= s->v[1]) return on_side(&side[1], 1, s, speed);
  return (ray_state){0.0, speed, s->p, 0.0};
}

static sph_status check_rays(sph_context *ctx, int64_t n, const double *speed) {
  if (n < 0) return sphi_fail(ctx, SPH_ERR_ARG, "n = %lld is negative", (long long)n);
  if (n > 0 && !speed) return sphi_fail(ctx, SPH_ERR_ARG, "speed is NULL");
  for (int64_t k = 0; k < n; ++k)
    if (!isfinite(speed[k]))
      return sphi_fail(ctx, SPH_ERR_ARG, "speed[%lld] = %g is not finite", (long long)k, speed[k]);
  return SPH_OK;
}

sph_status sph_riemann_sample(sph_context *ctx, const sph_riemann_side *left,
                              const sph_riemann_side *right, const sph_riemann_solution *solution,
                              int64_t n, const double *speed, double *rho, double *v, double *p,
                              double *e) {
  sphi_side side[2];
  sph_riemann_solution known = {0};
  sph_status s = prepare_both(ctx, left, right, side);
  if (s != SPH_OK) return s;
  if (!solution) return sphi_fail(ctx, SPH_ERR_ARG, "solution is NULL");
  s = sphi_options_read(ctx, &known, sizeof known, solution);
  if (s == SPH_OK) s = check_rays(ctx, n, speed);
  if (s != SPH_OK) return s;
  for (int64_t k = 0; k < n; ++k) {
    const ray_state at = on_ray(side, &known, speed[k]);
    if (rho) rho[k] = at.rho;
    if (v) v[k] = at.v;
    if (p) p[k] = at.p;
    if (e) e[k] = at.e;
  }
  return SPH_OK;
}
