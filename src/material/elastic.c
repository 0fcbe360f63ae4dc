/* Moduli of isotropic linear elasticity in the reductions to fewer dimensions. */
#include "elastic_impl.h"

#include <math.h>

int32_t sphi_reduction_dim(int32_t reduction) {
  switch (reduction) {
  case SPH_UNIAXIAL_STRESS:
  case SPH_UNIAXIAL_STRAIN:
    return 1;
  case SPH_PLANE_STRESS:
  case SPH_PLANE_STRAIN:
    return 2;
  case SPH_SOLID:
    return 3;
  default:
    return 0;
  }
}

sphi_moduli sphi_moduli_of(double young, double poisson, int32_t reduction) {
  const double nu = poisson;
  sphi_moduli m = {.shear = young / (2 * (1 + nu))};
  if (reduction == SPH_UNIAXIAL_STRESS) {
    m.stiff = young;
  } else if (reduction == SPH_PLANE_STRESS) {
    m.stiff = young / ((1 - nu) * (1 + nu));
    m.cross = nu * m.stiff;
  } else { /* no strain across: lambda + 2 mu and lambda */
    m.cross = young * nu / ((1 + nu) * (1 - 2 * nu));
    m.stiff = m.cross + 2 * m.shear;
    m.across = m.cross;
  }
  return m;
}

sph_status sphi_elastic_check(sph_context *ctx, const char *law, double young, double poisson,
                              double density, int32_t reduction) {
  sph_status status = sphi_material_positive(ctx, law, "young", young);
  if (status != SPH_OK) return status;
  if (!(poisson > -1 && poisson < 0.5))
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: poisson = %g is outside (-1, 0.5)", law, poisson);
  status = sphi_material_positive(ctx, law, "density", density);
  if (status != SPH_OK) return status;
  if (sphi_reduction_dim(reduction) == 0)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: unknown reduction %d", law, (int)reduction);
  return SPH_OK;
}
