/* Artificial stress of Gray from the principal stresses, He 2015 (3.22) to (3.26). */
#include "../core/eigen.h"
#include "operators_impl.h"

#include <math.h>
#include <string.h>

/* R of one principal stress; a NaN stays one. */
static double cure(double s, double scale) { return s <= 0.0 ? 0.0 : -scale * s; }

static void artificial_2d(const double *s, double scale, double *r) {
  double theta = 0.5 * atan2(2.0 * s[2], s[0] - s[1]);
  double c = cos(theta), n = sin(theta);
  double r1 = cure(c * c * s[0] + 2.0 * n * c * s[2] + n * n * s[1], scale);
  double r2 = cure(n * n * s[0] - 2.0 * n * c * s[2] + c * c * s[1], scale);
  r[0] = r1 * c * c + r2 * n * n;
  r[1] = r1 * n * n + r2 * c * c;
  r[2] = (r1 - r2) * n * c;
}

static void artificial_3d(const double *s, double scale, double *r) {
  double values[3], v[9];
  sphi_eigen_symmetric(3, s, values, v);
  memset(r, 0, 6 * sizeof *r);
  for (int k = 0; k < 3; ++k) {
    const double c = cure(values[k], scale), *w = v + 3 * k;
    r[0] += c * w[0] * w[0];
    r[1] += c * w[1] * w[1];
    r[2] += c * w[2] * w[2];
    r[3] += c * w[0] * w[1];
    r[4] += c * w[0] * w[2];
    r[5] += c * w[1] * w[2];
  }
}

void sphi_artificial_stress(int32_t dim, const double *sigma, double rho, double epsilon,
                            double *r) {
  double scale = epsilon / (rho * rho), out[6];
  if (dim == 1)
    out[0] = cure(sigma[0], scale);
  else if (dim == 2)
    artificial_2d(sigma, scale, out);
  else
    artificial_3d(sigma, scale, out);
  memcpy(r, out, (size_t)(dim * (dim + 1) / 2) * sizeof *r);
}

sph_status sph_artificial_stress(int32_t dim, int64_t n, const double *sigma, const double *rho,
                                 double rho0, double epsilon, double *R) {
  if (dim < 1 || dim > 3 || n < 0 || !isfinite(epsilon)) return SPH_ERR_ARG;
  if (n > 0 && (!sigma || !R || (!rho && !(rho0 > 0.0)))) return SPH_ERR_ARG;
  int32_t c = dim * (dim + 1) / 2;
  for (int64_t i = 0; i < n; ++i)
    sphi_artificial_stress(dim, sigma + i * c, rho ? rho[i] : rho0, epsilon, R + i * c);
  return SPH_OK;
}
