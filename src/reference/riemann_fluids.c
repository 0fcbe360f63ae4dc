/* Waves of gases and of barotropic fluids, in closed form. */
#include "reference_impl.h"

#include <math.h>

/* ---- ideal and stiffened gas: all in q = p + P_ref, Toro (4.5) to (4.63) ---- */

static double gas_energy(const sph_riemann_side *g, double rho, double p) {
  return (p + g->gamma * g->reference_pressure) / ((g->gamma - 1.0) * rho);
}

static sph_status gas_prepare(sph_context *ctx, sphi_side *side, const char *name) {
  const sph_riemann_side *g = &side->given;
  sph_status s = sphi_riemann_above(ctx, name, "gamma", g->gamma, 1.0, 0);
  if (s == SPH_OK)
    s = sphi_riemann_above(ctx, name, "reference_pressure", g->reference_pressure, 0.0, 1);
  if (s == SPH_OK) s = sphi_riemann_above(ctx, name, "p", g->p, -g->reference_pressure, 1);
  if (s != SPH_OK) return s;
  side->lowest = 0.0 - g->reference_pressure; /* not -0 */
  side->start.p = g->p;
  side->start.e = gas_energy(g, g->rho, g->p);
  side->start.c = sqrt(g->gamma * (g->p + g->reference_pressure) / g->rho);
  return SPH_OK;
}

static sphi_wave gas_shock(const sphi_side *side, double p) {
  const double gamma = side->given.gamma, rho = side->given.rho, b = (gamma - 1.0) / (gamma + 1.0);
  const double q1 = side->start.p + side->given.reference_pressure;
  const double q = p + side->given.reference_pressure;
  sphi_wave w = {.p = p, .rho = rho * (q + b * q1) / (b * q + q1)};
  w.gain = (p - side->start.p) * sqrt(2.0 / ((gamma + 1.0) * rho * (q + b * q1)));
  w.front = sqrt(((gamma + 1.0) * q + (gamma - 1.0) * q1) / (2.0 * rho));
  return w;
}

/* From the ratio c/c_1: everything else is a power of it. */
static sphi_wave gas_isentrope(const sphi_side *side, double log_ratio) {
  const double gamma = side->given.gamma, k = 2.0 / (gamma - 1.0);
  const double q1 = side->start.p + side->given.reference_pressure;
  sphi_wave w = {.front = side->start.c};
  w.p = q1 * exp(gamma * k * log_ratio) - side->given.reference_pressure;
  w.rho = side->given.rho * exp(k * log_ratio);
  w.gain = k * side->start.c * expm1(log_ratio);
  return w;
}

static sphi_wave gas_complete(const sphi_side *side, sphi_wave w) {
  const sph_riemann_side *g = &side->given;
  w.e = w.rho > 0.0 ? gas_energy(g, w.rho, w.p) : 0.0;
  w.c = w.rho > 0.0 ? sqrt(g->gamma * fmax(w.p + g->reference_pressure, 0.0) / w.rho) : 0.0;
  return w;
}

static sphi_wave gas_wave(const sphi_side *side, double p) {
  if (p == side->start.p) return side->start;
  if (p > side->start.p) return gas_complete(side, gas_shock(side, p));
  const double gamma = side->given.gamma, reference = side->given.reference_pressure;
  const double ratio = (p + reference) / (side->start.p + reference);
  sphi_wave w = gas_isentrope(side, (gamma - 1.0) / (2.0 * gamma) * log(ratio));
  w.p = p;
  return gas_complete(side, w);
}

/* gain + c = speed with gain = 2 (c - c_1)/(gamma - 1) */
static sphi_wave gas_fan(const sphi_side *side, double speed) {
  const double gamma = side->given.gamma, c1 = side->start.c;
  const double c = ((gamma - 1.0) * speed + 2.0 * c1) / (gamma + 1.0);
  return gas_complete(side, gas_isentrope(side, log(fmax(c, 0.0) / c1)));
}

const sphi_riemann_law sphi_riemann_gas = {gas_prepare, gas_wave, gas_fan, NULL};

/* ---- barotropic: all in the ratio rho/rho0 ---- */

static double modulus(const sph_riemann_side *b) {
  return b->density * b->sound_speed * b->sound_speed / b->gamma;
}

static double barotropic_pressure(const sph_riemann_side *b, double rho) {
  return b->background + modulus(b) * expm1(b->gamma * log(rho / b->density));
}

/* The integral of p/rho^2 from rho0. */
static double barotropic_energy(const sph_riemann_side *b, double rho) {
  const double k = b->gamma - 1.0, l = log(rho / b->density);
  const double work = k > 0.0 ? expm1(k * l) / k : l;
  return (modulus(b) * work + (b->background - modulus(b)) * -expm1(-l)) / b->density;
}

static double barotropic_sound(const sph_riemann_side *b, double rho) {
  return b->sound_speed * exp(0.5 * (b->gamma - 1.0) * log(rho / b->density));
}

static sph_status barotropic_prepare(sph_context *ctx, sphi_side *side, const char *name) {
  const sph_riemann_side *b = &side->given;
  sph_status s = sphi_riemann_above(ctx, name, "density", b->density, 0.0, 0);
  if (s == SPH_OK) s = sphi_riemann_above(ctx, name, "sound_speed", b->sound_speed, 0.0, 0);
  if (s == SPH_OK) s = sphi_riemann_above(ctx, name, "gamma", b->gamma, 1.0, 1);
  if (s != SPH_OK) return s;
  if (!isfinite(b->background))
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: background = %g is not finite", name, b->background);
  side->lowest = b->background - modulus(b);
  side->start.p = barotropic_pressure(b, b->rho);
  side->start.e = barotropic_energy(b, b->rho);
  side->start.c = barotropic_sound(b, b->rho);
  return SPH_OK;
}

static sphi_wave barotropic_complete(const sphi_side *side, sphi_wave w) {
  w.e = w.rho > 0.0 ? barotropic_energy(&side->given, w.rho) : 0.0;
  w.c = w.rho > 0.0 ? barotropic_sound(&side->given, w.rho) : 0.0;
  return w;
}

/* The gain is the integral of c/rho; for gamma = 1 that is c0 times the logarithm. */
static sphi_wave barotropic_isentrope(const sphi_side *side, double log_ratio) {
  const double k = 0.5 * (side->given.gamma - 1.0), c1 = side->start.c;
  sphi_wave w = {.front = c1, .rho = side->given.rho * exp(log_ratio)};
  w.gain = c1 * (k > 0.0 ? expm1(k * log_ratio) / k : log_ratio);
  return w;
}

static sphi_wave barotropic_wave(const sphi_side *side, double p) {
  const sph_riemann_side *b = &side->given;
  if (p == side->start.p) return side->start;
  const double up = p - side->start.p;
  const double q1 = modulus(b) * exp(b->gamma * log(b->rho / b->density));
  const double log_ratio = p <= side->lowest ? -INFINITY : log1p(up / q1) / b->gamma;
  sphi_wave w = barotropic_isentrope(side, log_ratio);
  if (up > 0.0) { /* mass and momentum: gain^2 = up (1/rho_1 - 1/rho) */
    const double shrink = -expm1(-log_ratio) / b->rho;
    w.gain = sqrt(up * shrink);
    w.front = sqrt(up / shrink) / b->rho;
  }
  w.p = p;
  return barotropic_complete(side, w);
}

static sphi_wave barotropic_fan(const sphi_side *side, double speed) {
  const double k = 0.5 * (side->given.gamma - 1.0), c1 = side->start.c;
  /* gain + c = speed, gain = (c - c_1)/k */
  const double log_ratio =
      k > 0.0 ? log(fmax(k * speed + c1, 0.0) / ((k + 1.0) * c1)) / k : speed / c1 - 1.0;
  sphi_wave w = barotropic_complete(side, barotropic_isentrope(side, log_ratio));
  w.p = w.rho > 0.0 ? barotropic_pressure(&side->given, w.rho) : side->lowest;
  return w;
}

const sphi_riemann_law sphi_riemann_barotropic = {barotropic_prepare, barotropic_wave,
                                                  barotropic_fan, NULL};
