/* The equation of state of Tillotson: condensed, expanded and partly vaporised matter. */
#include "eos_impl.h"

#include <math.h>
#include <stdio.h>

void sph_tillotson_options_init_sized(sph_tillotson_options *options, size_t size) {
  const sph_tillotson_options defaults = {
      .size = sizeof defaults, .minimum_pressure = -INFINITY, .sound_floor = 0.1};
  sphi_material_init_sized(options, size, &defaults, sizeof defaults);
}

/* p1. With w = 1 + e/(e0 eta^2): dw/drho = -2 (w - 1)/rho, d(e/w)/de = 1/w^2. */
static sphi_eos_state condensed(const sph_tillotson_options *t, double rho, double e) {
  const double eta = rho / t->density, u = (rho - t->density) / t->density;
  const double w = 1 + e / (t->e0 * eta * eta);
  return (sphi_eos_state){.p = (t->a + t->b / w) * rho * e + (t->A + t->B * u) * u,
                          .dp_drho = (t->a + t->b / w + 2 * t->b * (w - 1) / (w * w)) * e +
                                     (t->A + 2 * t->B * u) / t->density,
                          .dp_de = rho * (t->a + t->b / (w * w))};
}

/* p2 = a rho e + (b rho e/w + A u y) x, y = exp(-beta z), x = exp(-alpha z^2), z = 1/eta - 1 */
static sphi_eos_state expanded(const sph_tillotson_options *t, double rho, double e) {
  const double eta = rho / t->density, u = (rho - t->density) / t->density, z = -u / eta;
  const double w = 1 + e / (t->e0 * eta * eta);
  const double x = exp(-t->alpha * z * z), y = exp(-t->beta * z), dz = -1 / (eta * rho);
  const double bracket = t->b * rho * e / w + t->A * u * y;
  const double slope = (t->b / w + 2 * t->b * (w - 1) / (w * w)) * e +
                       t->A * y * (1 / t->density - t->beta * dz * u);
  return (sphi_eos_state){.p = t->a * rho * e + bracket * x,
                          .dp_drho = t->a * e + x * (slope - bracket * 2 * t->alpha * z * dz),
                          .dp_de = rho * (t->a + t->b * x / (w * w))};
}

static sphi_eos_state tillotson_state(const sphi_eos *law, double rho, double e) {
  const sph_tillotson_options *t = &law->of.tillotson;
  if (rho >= t->density || e <= t->e_iv) return condensed(t, rho, e);
  const sphi_eos_state vapour = expanded(t, rho, e);
  if (e >= t->e_cv) return vapour;
  const sphi_eos_state liquid = condensed(t, rho, e);
  const double range = t->e_cv - t->e_iv, s = (e - t->e_iv) / range, r = (t->e_cv - e) / range;
  return (sphi_eos_state){.p = r * liquid.p + s * vapour.p,
                          .dp_drho = r * liquid.dp_drho + s * vapour.dp_drho,
                          .dp_de =
                              r * liquid.dp_de + s * vapour.dp_de + (vapour.p - liquid.p) / range};
}

/* e > -k with rho e (a + b k/(k + e)) = p; a, b > 0. At e = -k the quadratic is -b k^2: exactly one
 * root lies above. */
static double energy_root(double a, double b, double k, double rho, double p) {
  const double half = 0.5 * ((a + b) * k - p / rho), product = -p * k / rho;
  const double root = sqrt(half * half - a * product);
  return half > 0 ? -product / (half + root) : (root - half) / a;
}

static double energy_between(const sphi_eos *law, double rho, double p) {
  double low = law->of.tillotson.e_iv, high = law->of.tillotson.e_cv;
  for (;;) {
    const double mid = 0.5 * (low + high);
    if (!(mid > low && mid < high)) return mid;
    if (tillotson_state(law, rho, mid).p > p)
      high = mid;
    else
      low = mid;
  }
}

static double tillotson_energy(const sphi_eos *law, double rho, double p) {
  const sph_tillotson_options *t = &law->of.tillotson;
  const double eta = rho / t->density, u = (rho - t->density) / t->density, z = -u / eta;
  const double k = t->e0 * eta * eta;
  const double liquid = energy_root(t->a, t->b, k, rho, p - (t->A + t->B * u) * u);
  if (rho >= t->density || liquid <= t->e_iv) return liquid;
  const double x = exp(-t->alpha * z * z), y = exp(-t->beta * z);
  const double vapour = energy_root(t->a, t->b * x, k, rho, p - t->A * u * y * x);
  return vapour >= t->e_cv ? vapour : energy_between(law, rho, p);
}

static int tillotson_refuse(const sphi_eos *law, double rho, double e, char *text, size_t room) {
  const double eta = rho / law->of.tillotson.density, least = -law->of.tillotson.e0 * eta * eta;
  if (e > least) return 0;
  if (text != NULL) (void)snprintf(text, room, "energy %g is not above %g", e, least);
  return 1;
}

static sph_status check_constants(sph_context *ctx, const sph_tillotson_options *o) {
  const struct {
    const char *name;
    double value;
    int32_t positive;
  } all[] = {{"density", o->density, 1},
             {"a", o->a, 1},
             {"b", o->b, 1},
             {"A", o->A, 1},
             {"B", o->B, 0},
             {"alpha", o->alpha, 0},
             {"beta", o->beta, 0},
             {"e0", o->e0, 1},
             {"e_iv", o->e_iv, 1},
             {"e_cv", o->e_cv, 1}};
  for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
    sph_status status = all[k].positive
                            ? sphi_material_positive(ctx, "tillotson", all[k].name, all[k].value)
                            : sphi_eos_not_negative(ctx, "tillotson", all[k].name, all[k].value);
    if (status != SPH_OK) return status;
  }
  if (!(o->e_iv < o->e_cv))
    return sphi_fail(ctx, SPH_ERR_ARG, "tillotson: e_iv = %g is not below e_cv = %g", o->e_iv,
                     o->e_cv);
  return sphi_eos_check_limits(ctx, "tillotson", o->minimum_pressure, o->sound_floor);
}

sph_status sph_material_create_tillotson(sph_context *ctx, const sph_tillotson_options *options,
                                         sph_material **out) {
  sph_tillotson_options o = {.size = 0};
  sph_tillotson_options_init(&o);
  sph_status status = sphi_material_begin(ctx, "tillotson", &o, sizeof o, options, out);
  if (status == SPH_OK) status = check_constants(ctx, &o);
  if (status != SPH_OK) return status;
  const sphi_eos law = {.state = tillotson_state,
                        .energy = tillotson_energy,
                        .refuse = tillotson_refuse,
                        .minimum_pressure = o.minimum_pressure,
                        .floor2 = o.sound_floor * o.sound_floor * o.A / o.density,
                        .of.tillotson = o};
  return sphi_eos_make(ctx, &law, out);
}
