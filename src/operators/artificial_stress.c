/* Artificial stress of Gray from the principal stresses, He 2015 (3.22) to (3.26). */
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

/* One Jacobi rotation that clears a[p][q]; v collects the eigenvectors. */
static void rotate(double a[3][3], double v[3][3], int p, int q) {
  if (a[p][q] == 0.0) return;
  double tau = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
  double t = (tau >= 0.0 ? 1.0 : -1.0) / (fabs(tau) + sqrt(1.0 + tau * tau));
  double c = 1.0 / sqrt(1.0 + t * t), s = t * c;
  for (int k = 0; k < 3; ++k) {
    double kp = a[k][p], kq = a[k][q], vp = v[k][p], vq = v[k][q];
    a[k][p] = c * kp - s * kq;
    a[k][q] = s * kp + c * kq;
    v[k][p] = c * vp - s * vq;
    v[k][q] = s * vp + c * vq;
  }
  for (int k = 0; k < 3; ++k) {
    double pk = a[p][k], qk = a[q][k];
    a[p][k] = c * pk - s * qk;
    a[q][k] = s * pk + c * qk;
  }
}

/* Cyclic Jacobi: for 3x3 it reaches rounding in five sweeps from any start, repeated
 * eigenvalues included, where the closed form loses half the digits. */
static void artificial_3d(const double *s, double scale, double *r) {
  enum { SWEEPS = 6 };
  double a[3][3] = {{s[0], s[3], s[4]}, {s[3], s[1], s[5]}, {s[4], s[5], s[2]}};
  double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int k = 0; k < SWEEPS; ++k) {
    rotate(a, v, 0, 1);
    rotate(a, v, 0, 2);
    rotate(a, v, 1, 2);
  }
  memset(r, 0, 6 * sizeof *r);
  for (int k = 0; k < 3; ++k) {
    double c = cure(a[k][k], scale);
    r[0] += c * v[0][k] * v[0][k];
    r[1] += c * v[1][k] * v[1][k];
    r[2] += c * v[2][k] * v[2][k];
    r[3] += c * v[0][k] * v[1][k];
    r[4] += c * v[0][k] * v[2][k];
    r[5] += c * v[1][k] * v[2][k];
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
  if (n > 0 && (!sigma || !R || (!rho && !(isfinite(rho0) && rho0 > 0.0)))) return SPH_ERR_ARG;
  int32_t c = dim * (dim + 1) / 2;
  for (int64_t i = 0; i < n; ++i)
    sphi_artificial_stress(dim, sigma + i * c, rho ? rho[i] : rho0, epsilon, R + i * c);
  return SPH_OK;
}
