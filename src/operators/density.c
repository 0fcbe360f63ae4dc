/* Density: summation and rate. */
#include "operators_impl.h"

sph_status sph_density_summation(sph_neighbors *list, const sph_kernel *kernel,
                                 const sph_operands *a, double *rho) {
  sph_operands own;
  sph_status s =
      sphi_operator_begin(list, kernel, a, SPHI_NEED_M, rho, "sph_density_summation", &own);
  if (s) return s;
  sphi_sweep sweep = sphi_sweep_of(kernel, &own, SPHI_DENSITY);
  sweep.density = rho;
  return sphi_sweep_run(list, &sweep);
}

sph_status sph_continuity(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *a,
                          int32_t form, double *drho) {
  sph_operands own;
  uint32_t needs = SPHI_NEED_V | SPHI_NEED_M;
  if (form == SPH_CONTINUITY_VOLUME) needs |= SPHI_NEED_RHO;
  sph_status s = sphi_operator_begin(list, kernel, a, needs, drho, "sph_continuity", &own);
  if (s) return s;
  if (form < SPH_CONTINUITY_MASS || form > SPH_CONTINUITY_NUMBER)
    return sphi_fail(list->base.ctx, SPH_ERR_ARG, "sph_continuity: unknown form %d", form);
  sphi_sweep sweep = sphi_sweep_of(kernel, &own, SPHI_CONTINUITY);
  sweep.spec.continuity = form;
  sweep.drho = drho;
  return sphi_sweep_run(list, &sweep);
}
