/* Accelerations from stress and from pressure. */
#include "operators_impl.h"

static sph_status check_stress_form(sph_context *ctx, const sph_operands *a, int32_t form) {
  if (form < SPH_STRESS_SUMMED || form > SPH_STRESS_CONSERVATIVE)
    return sphi_fail(ctx, SPH_ERR_ARG, "sph_stress_divergence: unknown form %d", form);
  if (form == SPH_STRESS_CONSERVATIVE && !a->gradient_matrix)
    return sphi_fail(ctx, SPH_ERR_ARG,
                     "sph_stress_divergence: the conservative form needs gradient_matrix");
  return SPH_OK;
}

sph_status sph_stress_divergence(sph_neighbors *list, const sph_kernel *kernel,
                                 const sph_operands *a, int32_t form, double *dvdt) {
  sph_operands own;
  uint32_t needs = SPHI_NEED_M | SPHI_NEED_RHO | SPHI_NEED_SIGMA;
  sph_status s = sphi_operator_begin(list, kernel, a, needs, dvdt, "sph_stress_divergence", &own);
  if (!s) s = check_stress_form(list->base.ctx, &own, form);
  if (s) return s;
  sphi_sweep sweep = sphi_sweep_of(kernel, &own, SPHI_STRESS);
  sweep.spec.stress = form;
  if (form == SPH_STRESS_CONSERVATIVE) sweep.spec.corrected = 0;
  sweep.dvdt = dvdt;
  return sphi_sweep_run(list, &sweep);
}

sph_status sph_pressure_gradient(sph_neighbors *list, const sph_kernel *kernel,
                                 const sph_operands *a, int32_t form, double *dvdt) {
  sph_operands own;
  uint32_t needs = SPHI_NEED_M | SPHI_NEED_RHO | SPHI_NEED_P;
  sph_status s = sphi_operator_begin(list, kernel, a, needs, dvdt, "sph_pressure_gradient", &own);
  if (s) return s;
  if (form < SPH_PRESSURE_MASS || form > SPH_PRESSURE_DIFFERENCE)
    return sphi_fail(list->base.ctx, SPH_ERR_ARG, "sph_pressure_gradient: unknown form %d", form);
  sphi_sweep sweep = sphi_sweep_of(kernel, &own, SPHI_PRESSURE);
  sweep.spec.pressure = form;
  sweep.dvdt = dvdt;
  return sphi_sweep_run(list, &sweep);
}
