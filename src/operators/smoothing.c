/* Operators in which each particle has its own h: density, omega, pressure, deviator, dissipation.
 */
#include "operators_impl.h"

#include <math.h>
#include <string.h>

sph_status sphi_check_both_h(const sph_neighbors *list, const char *name) {
  const int32_t rule = list->options.h_rule;
  if (rule == SPH_H_MAX || rule == SPH_H_AVERAGE || list->n == 0 || list->h_uniform > 0.0)
    return SPH_OK;
  return sphi_fail(list->base.ctx, SPH_ERR_ARG,
                   "%s: h differs between particles, and the list's rule %d misses pairs within "
                   "the larger h; build it with SPH_H_MAX",
                   name, rule);
}

static sph_status check_smoothing(sph_context *ctx, int32_t smoothing, const char *name) {
  if (smoothing >= SPH_SMOOTHING_MASS && smoothing <= SPH_SMOOTHING_NUMBER) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_ARG, "%s: unknown smoothing %d", name, smoothing);
}

/* ---- gathers ---------------------------------------------------------------------------------
 */

sph_status sph_smoothed_density(sph_neighbors *list, const sph_kernel *kernel,
                                const sph_operands *a, int32_t smoothing, double *rho) {
  static const char name[] = "sph_smoothed_density";
  sph_operands own;
  sph_status s = sphi_operator_begin(list, kernel, a, SPHI_NEED_M, rho, name, &own);
  if (!s) s = check_smoothing(list->base.ctx, smoothing, name);
  if (!s && smoothing == SPH_SMOOTHING_VOLUME)
    s = sphi_fail(list->base.ctx, SPH_ERR_UNSUPPORTED,
                  "%s: volume smoothing has no density sum, for the volumes are what is sought",
                  name);
  if (!s) s = sphi_check_both_h(list, name);
  return s ? s : sphi_smoothed_gather(list, kernel, &own, smoothing, 0.0, rho, NULL);
}

sph_status sph_grad_h(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *a,
                      int32_t smoothing, double omega_floor, double *omega) {
  static const char name[] = "sph_grad_h";
  sph_operands own;
  sph_status s =
      sphi_operator_begin(list, kernel, a, SPHI_NEED_M | SPHI_NEED_RHO, omega, name, &own);
  if (!s) s = check_smoothing(list->base.ctx, smoothing, name);
  if (!s && !(isfinite(omega_floor) && omega_floor >= 0.0))
    s = sphi_fail(list->base.ctx, SPH_ERR_ARG, "%s: omega_floor %g", name, omega_floor);
  if (!s) s = sphi_check_both_h(list, name);
  return s ? s : sphi_smoothed_gather(list, kernel, &own, smoothing, omega_floor, NULL, omega);
}

/* ---- forces ----------------------------------------------------------------------------------
 */

static void clear(double *out, int64_t count) {
  if (out && count > 0) memset(out, 0, (size_t)count * sizeof *out);
}

static sph_status run(sph_neighbors *list, const sphi_smoothed *sweep) {
  const sph_operands *a = sweep->a;
  sph_status s = sphi_smoothed_reserve(list, sweep); /* before anything is written */
  if (s) return s;
  clear(sweep->drho, a->rows);
  clear(sweep->dedt, a->rows);
  clear(sweep->dvdt, a->rows * a->dim);
  return sphi_smoothed_run(list, sweep);
}

static const void *any_of(const double *a, const double *b, const double *c) {
  return a ? a : b ? b : c;
}

/* omega and the uniform values that may be any number. */
static sph_status check_pressure(sph_context *ctx, const sph_operands *a, const char *name) {
  if (!a->omega && !(isfinite(a->omega0) && a->omega0 >= 0.0))
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: omega is NULL and omega0 is %g", name, a->omega0);
  if (!a->p && !isfinite(a->p0))
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: p is NULL and p0 is %g", name, a->p0);
  return SPH_OK;
}

sph_status sph_smoothed_pressure(sph_neighbors *list, const sph_kernel *kernel,
                                 const sph_operands *a, int32_t smoothing, double *drho,
                                 double *dvdt, double *dedt) {
  static const char name[] = "sph_smoothed_pressure";
  const uint32_t needs = SPHI_NEED_M | SPHI_NEED_RHO | (drho || dedt ? SPHI_NEED_V : 0);
  sph_operands own;
  sph_status s = sphi_operator_begin(list, kernel, a, needs, any_of(drho, dvdt, dedt), name, &own);
  if (!s) s = check_smoothing(list->base.ctx, smoothing, name);
  if (!s) s = check_pressure(list->base.ctx, &own, name);
  if (!s) s = sphi_check_both_h(list, name);
  if (s) return s;
  sphi_smoothed sweep = {.terms = SPHI_SMOOTHED_PRESSURE,
                         .smoothing = smoothing,
                         .kernel = kernel,
                         .a = &own,
                         .drho = drho,
                         .dvdt = dvdt,
                         .dedt = dedt};
  return run(list, &sweep);
}

sph_status sph_smoothed_stress(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *a,
                               double *dvdt, double *dedt, double *gradv) {
  static const char name[] = "sph_smoothed_stress";
  const uint32_t needs =
      SPHI_NEED_M | SPHI_NEED_RHO | SPHI_NEED_SIGMA | (dedt || gradv ? SPHI_NEED_V : 0);
  sph_operands own;
  sph_status s = sphi_operator_begin(list, kernel, a, needs, any_of(dvdt, dedt, gradv), name, &own);
  if (!s) s = sphi_check_both_h(list, name);
  if (s) return s;
  sphi_smoothed sweep = {.terms = SPHI_SMOOTHED_STRESS,
                         .smoothing = SPH_SMOOTHING_MASS,
                         .kernel = kernel,
                         .a = &own,
                         .dvdt = dvdt,
                         .dedt = dedt,
                         .gradv = gradv};
  return run(list, &sweep);
}

/* ---- dissipation -----------------------------------------------------------------------------
 */

void sph_dissipation_init_sized(sph_dissipation *options, size_t size) {
  const sph_dissipation defaults = {.size = sizeof defaults,
                                    .viscosity = 1.0,
                                    .viscosity_b = 2.0,
                                    .conductivity = 0.1,
                                    .conductivity_b = 2.0,
                                    .mass_flux = 0.5,
                                    .mass_flux_b = 2.0,
                                    .signal = SPH_SIGNAL_SOUND,
                                    .conductivity_form = SPH_CONDUCTIVITY_SIGNAL,
                                    .pairs = SPH_PAIRS_APPROACHING,
                                    .flux_form = SPH_FLUX_SIGNED,
                                    .flux_limit = 0.1};
  sphi_options_init(options, size, &defaults, sizeof defaults);
}

static sph_status check_coefficients(sph_context *ctx, const sph_dissipation *z, const char *name) {
  const double value[] = {z->viscosity, z->viscosity_b, z->conductivity, z->conductivity_b,
                          z->mass_flux, z->mass_flux_b, z->flux_limit};
  static const char *const what[] = {"viscosity", "viscosity_b", "conductivity", "conductivity_b",
                                     "mass_flux", "mass_flux_b", "flux_limit"};
  for (size_t k = 0; k < sizeof value / sizeof *value; ++k)
    if (!isfinite(value[k]) || value[k] < 0.0)
      return sphi_fail(ctx, SPH_ERR_ARG, "%s: %s %g of the dissipation", name, what[k], value[k]);
  return SPH_OK;
}

static sph_status check_choices(sph_context *ctx, const sph_dissipation *z, const char *name) {
  const int32_t value[] = {z->signal, z->conductivity_form, z->pairs, z->flux_form};
  static const char *const what[] = {"signal", "conductivity_form", "pairs", "flux_form"};
  for (size_t k = 0; k < sizeof value / sizeof *value; ++k)
    if (value[k] < 1 || value[k] > 2)
      return sphi_fail(ctx, SPH_ERR_ARG, "%s: unknown %s %d of the dissipation", name, what[k],
                       value[k]);
  return SPH_OK;
}

sph_status sphi_dissipation_read(sph_context *ctx, const sph_dissipation *options, const char *name,
                                 sph_dissipation *own) {
  sph_dissipation_init(own);
  sph_status s = sphi_options_read(ctx, own, sizeof *own, options);
  if (!s) s = check_coefficients(ctx, own, name);
  return s ? s : check_choices(ctx, own, name);
}

static sph_status check_dissipated(sph_context *ctx, const sph_operands *a, const char *name) {
  if ((!a->p && !isfinite(a->p0)) || (!a->e && !isfinite(a->e0)))
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: p0 is %g and e0 %g", name, a->p0, a->e0);
  return SPH_OK;
}

sph_status sph_smoothed_dissipation(sph_neighbors *list, const sph_kernel *kernel,
                                    const sph_operands *a, const sph_dissipation *options,
                                    double *drho, double *dvdt, double *dedt) {
  static const char name[] = "sph_smoothed_dissipation";
  const uint32_t needs = SPHI_NEED_M | SPHI_NEED_RHO | SPHI_NEED_C | SPHI_NEED_V;
  sphi_smoothed sweep = {.terms = SPHI_SMOOTHED_DISSIPATION,
                         .smoothing = SPH_SMOOTHING_MASS,
                         .kernel = kernel,
                         .drho = drho,
                         .dvdt = dvdt,
                         .dedt = dedt};
  sph_operands own;
  sph_status s = sphi_operator_begin(list, kernel, a, needs, any_of(drho, dvdt, dedt), name, &own);
  if (!s) s = sphi_dissipation_read(list->base.ctx, options, name, &sweep.dissipation);
  if (!s) s = check_dissipated(list->base.ctx, &own, name);
  if (!s) s = sphi_check_both_h(list, name);
  sweep.a = &own;
  return s ? s : run(list, &sweep);
}
