/* Mie-Grueneisen with the Hugoniot of a linear relation between shock and particle speed. */
#include "eos_impl.h"

#include <math.h>
#include <stdio.h>

typedef struct curve {
  double p, slope; /* of the reference curve, and its derivative by u */
} curve;

void sph_mie_gruneisen_options_init_sized(sph_mie_gruneisen_options *options, size_t size) {
  const sph_mie_gruneisen_options defaults = {.size = sizeof defaults,
                                              .curve = SPH_HUGONIOT_CUBIC,
                                              .minimum_pressure = -INFINITY,
                                              .sound_floor = 0.1};
  sphi_material_init_sized(options, size, &defaults, sizeof defaults);
}

static curve curve_at(const sphi_eos *law, double u) {
  const double a = law->of.gruneisen.a, b = law->of.gruneisen.b, c = law->of.gruneisen.c;
  const int32_t kind = law->of.gruneisen.curve;
  if (u <= 0 && kind != SPH_COLD_CUBIC) return (curve){a * u, a};
  if (kind != SPH_HUGONIOT) return (curve){u * (a + u * (b + u * c)), a + u * (2 * b + u * 3 * c)};
  const double eta = u / (1 + u), s = law->of.gruneisen.slope, rest = 1 - s * eta;
  return (curve){a * eta / (rest * rest),
                 a * (1 + s * eta) / (rest * rest * rest) / ((1 + u) * (1 + u))};
}

/* (1 - Gamma u/2) p_H + Gamma rho e; the cold cubic + Gamma rho0 e */
static sphi_eos_state gruneisen_state(const sphi_eos *law, double rho, double e) {
  const double rho0 = law->of.gruneisen.density, g = law->of.gruneisen.gruneisen;
  const double u = (rho - rho0) / rho0;
  const curve at = curve_at(law, u);
  if (law->of.gruneisen.curve == SPH_COLD_CUBIC)
    return (sphi_eos_state){at.p + g * rho0 * e, at.slope / rho0, g * rho0};
  return (sphi_eos_state){(1 - 0.5 * g * u) * at.p + g * rho * e,
                          ((1 - 0.5 * g * u) * at.slope - 0.5 * g * at.p) / rho0 + g * e, g * rho};
}

static double gruneisen_energy(const sphi_eos *law, double rho, double p) {
  const sphi_eos_state cold = gruneisen_state(law, rho, 0);
  return (p - cold.p) / cold.dp_de;
}

static int gruneisen_refuse(const sphi_eos *law, double rho, double other, char *text,
                            size_t room) {
  const double rho0 = law->of.gruneisen.density, s = law->of.gruneisen.slope;
  (void)other;
  if (law->of.gruneisen.curve != SPH_HUGONIOT || s * (rho - rho0) < rho) return 0;
  if (text != NULL)
    (void)snprintf(text, room, "density %g is beyond %g, the limit of shock compression", rho,
                   rho0 * s / (s - 1));
  return 1;
}

static sph_status check(sph_context *ctx, const sph_mie_gruneisen_options *o) {
  const char *name = "mie_gruneisen";
  sph_status status = sphi_material_positive(ctx, name, "density", o->density);
  if (status == SPH_OK) status = sphi_material_positive(ctx, name, "sound_speed", o->sound_speed);
  if (status == SPH_OK) status = sphi_eos_not_negative(ctx, name, "slope", o->slope);
  if (status == SPH_OK) status = sphi_material_positive(ctx, name, "gruneisen", o->gruneisen);
  if (status != SPH_OK) return status;
  if (o->curve < SPH_HUGONIOT_CUBIC || o->curve > SPH_COLD_CUBIC)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: unknown curve %d", name, (int)o->curve);
  return sphi_eos_check_limits(ctx, name, o->minimum_pressure, o->sound_floor);
}

sph_status sph_material_create_mie_gruneisen(sph_context *ctx,
                                             const sph_mie_gruneisen_options *options,
                                             sph_material **out) {
  sph_mie_gruneisen_options o = {.size = 0};
  sph_mie_gruneisen_options_init(&o);
  sph_status status = sphi_material_begin(ctx, "mie_gruneisen", &o, sizeof o, options, out);
  if (status == SPH_OK) status = check(ctx, &o);
  if (status != SPH_OK) return status;
  const double a = o.density * o.sound_speed * o.sound_speed, s1 = o.slope - 1;
  const double floor = o.sound_floor * o.sound_speed;
  const sphi_eos law = {.state = gruneisen_state,
                        .energy = gruneisen_energy,
                        .refuse = gruneisen_refuse,
                        .refuse_pressure = gruneisen_refuse,
                        .minimum_pressure = o.minimum_pressure,
                        .floor2 = floor * floor,
                        .of.gruneisen = {o.density, a, a * (1 + 2 * s1), a * (2 * s1 + 3 * s1 * s1),
                                         o.slope, o.gruneisen, o.curve}};
  return sphi_eos_make(ctx, &law, out);
}
