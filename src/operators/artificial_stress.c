/* Artificial stress of Gray from the principal stresses, He 2015 (3.22) to (3.26). */
#include "../sweep/artificial.h"
#include "operators_impl.h"

#include <math.h>

sph_status sph_artificial_stress(int32_t dim, int64_t n, const double *sigma, const double *rho,
                                 double rho0, double epsilon, double *R) {
  if (dim < 1 || dim > 3 || n < 0 || !isfinite(epsilon)) return SPH_ERR_ARG;
  if (n > 0 && (!sigma || !R || (!rho && !(isfinite(rho0) && rho0 > 0.0)))) return SPH_ERR_ARG;
  sphi_artificial(SPH_ISA_PORTABLE)(dim, n, sigma, rho, rho0, epsilon, R);
  return SPH_OK;
}
