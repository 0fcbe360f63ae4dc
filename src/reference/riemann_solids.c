/* Waves of laws that are linear in the energy, p = cold(rho) + heat(rho) e: Mie-Grueneisen in its
 * three forms. The Hugoniot is a closed form of the density; the isentrope is integrated,
 *
 *   de/dy = p/rho,   d gain/dy = c,   y = ln rho,
 *
 * in z = sqrt(y - y_0), y_0 the end: where c = 0 there, it grows as z, and in z all is smooth. */
#include "reference_impl.h"

#include <float.h>
#include <math.h>

/* cold, heat and their derivatives by rho */
typedef struct coefficients {
  double cold, dcold, heat, dheat;
} coefficients;

/* The reference curve by u = rho/rho0 - 1, and its derivative. */
static void curve(const sph_riemann_side *m, double u, double *p, double *dp) {
  const double a = m->density * m->sound_speed * m->sound_speed, s = m->slope - 1.0;
  if (m->curve != SPH_COLD_CUBIC && u <= 0.0) {
    *p = a * u;
    *dp = a;
  } else if (m->curve == SPH_HUGONIOT) { /* a eta/(1 - S eta)^2 with eta = u/(1 + u) */
    const double d = 1.0 - s * u;
    *p = a * u * (1.0 + u) / (d * d);
    *dp = a * (1.0 + 2.0 * u + s * u) / (d * d * d);
  } else {
    const double b = a * (1.0 + 2.0 * s), c = a * (2.0 * s + 3.0 * s * s);
    *p = u * (a + u * (b + u * c));
    *dp = a + u * (2.0 * b + 3.0 * u * c);
  }
}

static coefficients coefficients_at(const sph_riemann_side *m, double rho) {
  const double u = rho / m->density - 1.0, g = m->gruneisen;
  double p, dp;
  curve(m, u, &p, &dp);
  if (m->curve == SPH_COLD_CUBIC) return (coefficients){p, dp / m->density, g * m->density, 0.0};
  return (coefficients){(1.0 - 0.5 * g * u) * p,
                        ((1.0 - 0.5 * g * u) * dp - 0.5 * g * p) / m->density, g * rho, g};
}

static double pressure_of(const coefficients *k, double e) { return k->cold + k->heat * e; }

/* c^2 = dp/drho + p/rho^2 dp/de; may be negative in tension */
static double sound2_of(const coefficients *k, double rho, double e) {
  return k->dcold + k->dheat * e + pressure_of(k, e) / rho / rho * k->heat;
}

/* ---- the isentrope ----------------------------------------------------------------------- */

typedef struct isentrope {
  const sph_riemann_side *given;
  double origin; /* y_0; in_y: the independent variable is y itself */
  int in_y;
} isentrope;

static double density_at(const isentrope *s, double z) {
  return exp(s->in_y ? z : s->origin + z * z);
}

static double energy_slope(const isentrope *s, double z, double e) {
  const double rho = density_at(s, z);
  const coefficients k = coefficients_at(s->given, rho);
  return (s->in_y ? 1.0 : 2.0 * z) * pressure_of(&k, e) / rho;
}

/* Gragg's modified midpoint rule: its error has even powers of the step alone. */
static double midpoint(const isentrope *s, double z, double h, int steps, double e) {
  const double d = h / steps;
  double before = e, now = e + d * energy_slope(s, z, e);
  for (int i = 1; i < steps; ++i) {
    const double next = before + 2.0 * d * energy_slope(s, z + i * d, now);
    before = now;
    now = next;
  }
  return 0.5 * (before + now + d * energy_slope(s, z + h, now));
}

/* The energy at z + h, extrapolated: Hairer, Norsett, Wanner, Solving ODEs I, section II.9. */
enum { COLUMNS = 4 };
static double advance(const isentrope *s, double z, double h, double e) {
  double row[COLUMNS];
  for (int j = 0; j < COLUMNS; ++j) {
    double better = midpoint(s, z, h, 2 * (j + 1), e);
    for (int i = 1; i <= j; ++i) { /* Neville, in place: row[i - 1] is of the former row */
      const double ratio = (double)(j + 1) / (j + 1 - i), old = row[i - 1];
      row[i - 1] = better;
      better += (better - old) / (ratio * ratio - 1.0);
    }
    row[j] = better;
  }
  return row[COLUMNS - 1];
}

/* d gain/dz, from an energy that is right: c^2 may be the small difference of large terms. */
static double gain_slope(const isentrope *s, double z, double e) {
  const double rho = density_at(s, z);
  const coefficients k = coefficients_at(s->given, rho);
  return 2.0 * z * sqrt(fmax(sound2_of(&k, rho, e), 0.0));
}

/* Gauss-Legendre with 8 points on each panel, the energy carried from one to the next. */
static void panels(const isentrope *s, double from, double to, double *e, double *gain) {
  static const double at[] = {0.01985507175123188, 0.10166676129318663, 0.2372337950418355,
                              0.4082826787521751,  0.5917173212478249,  0.7627662049581645,
                              0.8983332387068134,  0.9801449282487682};
  static const double weight[] = {0.05061426814518813, 0.11119051722668724, 0.15685332293894363,
                                  0.18134189168918100, 0.18134189168918100, 0.15685332293894363,
                                  0.11119051722668724, 0.05061426814518813};
  const int n = 1 + (int)(fabs(to - from) / 0.15);
  const double h = (to - from) / n;
  double z = from;
  for (int i = 0; i < n; ++i) {
    for (int g = 0; g < 8; ++g) {
      const double next = from + h * (i + at[g]);
      *e = advance(s, z, next - z, *e);
      *gain += h * weight[g] * gain_slope(s, next, *e);
      z = next;
    }
    const double end = from + h * (i + 1);
    *e = advance(s, z, end - z, *e);
    z = end;
  }
}

/* From the undisturbed density to ln rho = y, cut at rho0, where two of the curves have a kink. */
static sphi_wave expand(const sphi_side *side, double y) {
  const isentrope s = {&side->given, side->slowest, 0};
  const double start = log(side->given.rho), kink = log(side->given.density);
  double z = sqrt(start - side->slowest), e = side->start.e, gain = 0.0;
  const double end = sqrt(fmax(y - side->slowest, 0.0));
  if (start > kink && kink > fmax(y, side->slowest)) {
    const double middle = sqrt(kink - side->slowest);
    panels(&s, z, middle, &e, &gain);
    z = middle;
  }
  panels(&s, z, end, &e, &gain);
  sphi_wave w = {.rho = exp(y), .e = e, .gain = gain, .front = side->start.c};
  const coefficients k = coefficients_at(&side->given, w.rho);
  w.p = pressure_of(&k, w.e);
  w.c = sqrt(fmax(sound2_of(&k, w.rho, w.e), 0.0));
  return w;
}

/* ---- where it ends ----------------------------------------------------------------------- */

typedef struct ending {
  isentrope s;
  double y, e; /* a state with c^2 > 0 */
} ending;

static double ending_sound2(const void *user, double y) {
  const ending *end = user;
  const coefficients k = coefficients_at(end->s.given, exp(y));
  return sound2_of(&k, exp(y), advance(&end->s, end->y, y - end->y, end->e));
}

/* March down until c^2 changes its sign, or to a tenth of the density. */
static void find_end(sphi_side *side) {
  ending end = {{&side->given, 0.0, 1}, log(side->given.rho), side->start.e};
  const double kink = log(side->given.density);
  const double floor = log(0.1 * fmin(side->given.rho, side->given.density));
  while (end.y > floor) {
    double next = fmax(end.y - 0.05, floor);
    if (end.y > kink && next < kink) next = kink;
    if (ending_sound2(&end, next) <= 0.0) {
      end.y = sphi_root(ending_sound2, &end, next, end.y);
      break;
    }
    end.e = advance(&end.s, end.y, next - end.y, end.e);
    end.y = next;
  }
  side->slowest = end.y;
  side->lowest = expand(side, side->slowest).p;
}

/* ---- the Hugoniot ------------------------------------------------------------------------ */

/* From rest at rho0 the Hugoniot is the reference curve itself. */
static int from_rest(const sphi_side *side) {
  const sph_riemann_side *m = &side->given;
  return m->curve != SPH_COLD_CUBIC && m->rho == m->density && m->p == 0.0;
}

/* Zisis (1.7) solved for p: [cold + heat (e_1 + p_1 d/2)]/(1 - heat d/2), d = 1/rho_1 - 1/rho. */
static double hugoniot(const sphi_side *side, double y) {
  const double rho = exp(y), rho1 = side->given.rho, d = (rho - rho1) / (rho * rho1);
  double p, dp;
  curve(&side->given, rho / side->given.density - 1.0, &p, &dp);
  if (from_rest(side)) return p;
  const coefficients k = coefficients_at(&side->given, rho);
  return (k.cold + k.heat * (side->start.e + 0.5 * side->start.p * d)) / (1.0 - 0.5 * k.heat * d);
}

/* ln rho that no shock reaches: 1 - heat d/2 = 0, or the pole of the curve. */
static double densest(const sphi_side *side) {
  const sph_riemann_side *m = &side->given;
  double limit = from_rest(side) ? INFINITY : m->rho * (1.0 + 2.0 / m->gruneisen);
  if (m->curve == SPH_COLD_CUBIC) {
    const double least = 1.0 / m->rho - 2.0 / (m->gruneisen * m->density);
    limit = least > 0.0 ? 1.0 / least : INFINITY;
  }
  if (m->curve == SPH_HUGONIOT && m->slope > 1.0)
    limit = fmin(limit, m->density * m->slope / (m->slope - 1.0));
  return log(limit);
}

typedef struct target {
  const sphi_side *side;
  double p;
} target;

static double hugoniot_miss(const void *user, double y) {
  const target *t = user;
  return hugoniot(t->side, y) - t->p;
}

static double isentrope_miss(const void *user, double y) {
  const target *t = user;
  return expand(t->side, y).p - t->p;
}

static double fan_miss(const void *user, double y) {
  const target *t = user;
  const sphi_wave w = expand(t->side, y);
  return w.gain + w.c - t->p;
}

/* ln rho behind the shock to p: the distance from the undisturbed state is doubled, or what is left
 * to the limit halved, until p lies below. NaN when the law does not reach it. */
static double compress(const sphi_side *side, double p) {
  const target t = {side, p};
  const double start = log(side->given.rho), limit = densest(side);
  double lo = start, hi = start;
  for (int k = -6; k < 60; ++k) {
    lo = hi;
    hi = fmin(start + ldexp(1.0, k), isfinite(limit) ? 0.5 * (lo + limit) : INFINITY);
    const double reached = hugoniot(side, hi);
    if (!(reached > side->start.p)) return NAN;
    if (reached >= p) return sphi_root(hugoniot_miss, &t, lo, hi);
  }
  return NAN;
}

static sphi_wave shock(const sphi_side *side, double p) {
  const double y = compress(side, p), rho1 = side->given.rho;
  if (isnan(y)) return (sphi_wave){.p = NAN, .gain = NAN};
  const double d = -expm1(-(y - log(rho1))) / rho1, up = p - side->start.p;
  sphi_wave w = {.p = p, .rho = exp(y), .gain = sqrt(up * d), .front = sqrt(up / d) / rho1};
  const coefficients k = coefficients_at(&side->given, w.rho);
  w.e = side->start.e + 0.5 * (p + side->start.p) * d;
  w.c = sqrt(fmax(sound2_of(&k, w.rho, w.e), 0.0));
  return w;
}

/* So weak that the density would not show it: the isentrope to first order. */
static sphi_wave weak(const sphi_side *side, double p) {
  const double rho = side->given.rho, c = side->start.c, up = p - side->start.p;
  sphi_wave w = side->start;
  w.p = p;
  w.rho += up / (c * c);
  w.e += side->start.p / rho * (up / rho / (c * c));
  w.gain = up / (rho * c);
  return w;
}

/* ---- the law ----------------------------------------------------------------------------- */

static sphi_wave solid_wave(const sphi_side *side, double p) {
  const double rho = side->given.rho, c = side->start.c;
  if (fabs(p - side->start.p) <= 1e-9 * rho * c * c) return weak(side, p);
  if (p > side->start.p) return shock(side, p);
  if (p <= side->lowest) return expand(side, side->slowest);
  const target t = {side, p};
  sphi_wave w = expand(side, sphi_root(isentrope_miss, &t, side->slowest, log(rho)));
  w.p = p;
  return w;
}

static sphi_wave solid_fan(const sphi_side *side, double speed) {
  const target t = {side, speed};
  return expand(side, sphi_root(fan_miss, &t, side->slowest, log(side->given.rho)));
}

/* In strong tension the cubic may turn its other side, and an expansion is no fan any more. Across
 * a weak wave the speed changes by less than it is rounded by. */
static int solid_convex(const sphi_side *side, const sphi_wave *behind) {
  enum { STEPS = 64 };
  const double rounding = 64 * DBL_EPSILON * side->start.c;
  const isentrope s = {&side->given, side->slowest, 0};
  const double start = sqrt(log(side->given.rho) - side->slowest);
  const double end = sqrt(fmax(log(behind->rho) - side->slowest, 0.0));
  double e = side->start.e, gain = 0.0, last = side->start.c;
  for (int k = 0; k < STEPS; ++k) {
    const double z = start + (end - start) * k / STEPS;
    const double next = start + (end - start) * (k + 1) / STEPS;
    panels(&s, z, next, &e, &gain);
    const double rho = density_at(&s, next);
    const coefficients c = coefficients_at(&side->given, rho);
    const double speed = gain + sqrt(fmax(sound2_of(&c, rho, e), 0.0));
    if (speed > last + rounding) return 0;
    last = speed;
  }
  return 1;
}

static sph_status check_constants(sph_context *ctx, const sph_riemann_side *m, const char *name) {
  sph_status s = sphi_riemann_above(ctx, name, "density", m->density, 0.0, 0);
  if (s == SPH_OK) s = sphi_riemann_above(ctx, name, "sound_speed", m->sound_speed, 0.0, 0);
  if (s == SPH_OK) s = sphi_riemann_above(ctx, name, "slope", m->slope, 0.0, 1);
  if (s == SPH_OK) s = sphi_riemann_above(ctx, name, "gruneisen", m->gruneisen, 0.0, 0);
  if (s != SPH_OK) return s;
  if (m->curve < SPH_HUGONIOT_CUBIC || m->curve > SPH_COLD_CUBIC)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: curve = %d is unknown", name, (int)m->curve);
  return SPH_OK;
}

static sph_status solid_prepare(sph_context *ctx, sphi_side *side, const char *name) {
  const sph_riemann_side *m = &side->given;
  sph_status s = check_constants(ctx, m, name);
  if (s != SPH_OK) return s;
  if (m->curve == SPH_HUGONIOT && 1.0 - m->density / m->rho >= 1.0 / m->slope)
    return sphi_fail(ctx, SPH_ERR_NUMERIC, "%s: rho = %g is denser than any shock makes it", name,
                     m->rho);
  const coefficients k = coefficients_at(m, m->rho);
  side->start.p = m->p;
  side->start.e = (m->p - k.cold) / k.heat;
  const double c2 = sound2_of(&k, m->rho, side->start.e);
  if (!(c2 > 0.0) || !isfinite(c2))
    return sphi_fail(ctx, SPH_ERR_NUMERIC, "%s: at rho = %g, p = %g the sound speed has c^2 = %g",
                     name, m->rho, m->p, c2);
  side->start.c = sqrt(c2);
  find_end(side);
  return SPH_OK;
}

const sphi_riemann_law sphi_riemann_mie_gruneisen = {solid_prepare, solid_wave, solid_fan,
                                                     solid_convex};
