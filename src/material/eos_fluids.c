/* Ideal and stiffened gas; barotropic fluids. */
#include "eos_impl.h"

#include <math.h>
#include <stdio.h>

/* ---- gases ---- */

void sph_gas_options_init_sized(sph_gas_options *options, size_t size) {
  const sph_gas_options defaults = {.size = sizeof defaults, .gamma = 1.4};
  sphi_material_init_sized(options, size, &defaults, sizeof defaults);
}

static sphi_eos_state gas_state(const sphi_eos *law, double rho, double e) {
  const double g = law->of.gas.gamma;
  return (sphi_eos_state){.p = (g - 1) * rho * e - g * law->of.gas.reference_pressure,
                          .dp_drho = (g - 1) * e,
                          .dp_de = (g - 1) * rho};
}

static double gas_energy(const sphi_eos *law, double rho, double p) {
  const double g = law->of.gas.gamma;
  return (p + g * law->of.gas.reference_pressure) / ((g - 1) * rho);
}

static double gas_temperature(const sphi_eos *law, double rho, double e) {
  return (e - law->of.gas.reference_pressure / rho) / law->of.gas.heat_capacity;
}

static int gas_refuse(const sphi_eos *law, double rho, double e, char *text, size_t room) {
  const double least = law->of.gas.reference_pressure / rho;
  if (e >= least) return 0;
  if (text != NULL)
    (void)snprintf(text, room, "energy %g is below %g, that of a cold gas", e, least);
  return 1;
}

static int gas_refuse_pressure(const sphi_eos *law, double rho, double p, char *text, size_t room) {
  const double least = -law->of.gas.reference_pressure;
  (void)rho;
  if (p >= least) return 0;
  if (text != NULL)
    (void)snprintf(text, room, "pressure %g is below %g, that of a cold gas", p, least);
  return 1;
}

sph_status sph_material_create_gas(sph_context *ctx, const sph_gas_options *options,
                                   sph_material **out) {
  sph_gas_options o = {.size = 0};
  sph_gas_options_init(&o);
  sph_status status = sphi_material_begin(ctx, "gas", &o, sizeof o, options, out);
  if (status != SPH_OK) return status;
  if (!(o.gamma > 1) || !isfinite(o.gamma))
    return sphi_fail(ctx, SPH_ERR_ARG, "gas: gamma = %g is not above 1 and finite", o.gamma);
  status = sphi_eos_not_negative(ctx, "gas", "reference_pressure", o.reference_pressure);
  if (status == SPH_OK)
    status = sphi_eos_not_negative(ctx, "gas", "heat_capacity", o.heat_capacity);
  if (status != SPH_OK) return status;
  const sphi_eos law = {.state = gas_state,
                        .energy = gas_energy,
                        .temperature = o.heat_capacity > 0 ? gas_temperature : NULL,
                        .refuse = gas_refuse,
                        .refuse_pressure = gas_refuse_pressure,
                        .minimum_pressure = -INFINITY,
                        .of.gas = {o.gamma, o.reference_pressure, o.heat_capacity}};
  return sphi_eos_make(ctx, &law, out);
}

/* ---- barotropic fluids ---- */

void sph_barotropic_options_init_sized(sph_barotropic_options *options, size_t size) {
  const sph_barotropic_options defaults = {.size = sizeof defaults, .gamma = 7};
  sphi_material_init_sized(options, size, &defaults, sizeof defaults);
}

/* expm1 keeps small compressions exact */
static sphi_eos_state barotropic_state(const sphi_eos *law, double rho, double e) {
  const double rho0 = law->of.barotropic.density, g = law->of.barotropic.gamma;
  const double log_ratio =
      fabs(rho - rho0) < 0.5 * rho0 ? log1p((rho - rho0) / rho0) : log(rho / rho0);
  (void)e;
  return (sphi_eos_state){
      .p = law->of.barotropic.background + law->of.barotropic.modulus * expm1(g * log_ratio),
      .dp_drho = g * law->of.barotropic.modulus / rho0 * exp((g - 1) * log_ratio)};
}

/* Integral of p/rho^2 from rho0, with x = rho/rho0:
 * ((background - B)(1 - 1/x) + B (x^(gamma-1) - 1)/(gamma - 1))/rho0, B ln x for gamma = 1 */
static double barotropic_energy(const sphi_eos *law, double rho, double p) {
  const double rho0 = law->of.barotropic.density, g1 = law->of.barotropic.gamma - 1;
  const double modulus = law->of.barotropic.modulus, log_ratio = log(rho / rho0);
  const double power = g1 > 0 ? expm1(g1 * log_ratio) / g1 : log_ratio;
  (void)p;
  return ((law->of.barotropic.background - modulus) * (1 - rho0 / rho) + modulus * power) / rho0;
}

sph_status sph_material_create_barotropic(sph_context *ctx, const sph_barotropic_options *options,
                                          sph_material **out) {
  sph_barotropic_options o = {.size = 0};
  sph_barotropic_options_init(&o);
  sph_status status = sphi_material_begin(ctx, "barotropic", &o, sizeof o, options, out);
  if (status == SPH_OK) status = sphi_material_positive(ctx, "barotropic", "density", o.density);
  if (status == SPH_OK)
    status = sphi_material_positive(ctx, "barotropic", "sound_speed", o.sound_speed);
  if (status != SPH_OK) return status;
  if (!(o.gamma >= 1) || !isfinite(o.gamma))
    return sphi_fail(ctx, SPH_ERR_ARG, "barotropic: gamma = %g is below 1 or not finite", o.gamma);
  if (!isfinite(o.background))
    return sphi_fail(ctx, SPH_ERR_ARG, "barotropic: background = %g", o.background);
  const double modulus = o.density * o.sound_speed * o.sound_speed / o.gamma;
  const sphi_eos law = {.state = barotropic_state,
                        .energy = barotropic_energy,
                        .minimum_pressure = -INFINITY,
                        .barotropic = 1,
                        .of.barotropic = {o.density, modulus, o.gamma, o.background}};
  return sphi_eos_make(ctx, &law, out);
}
