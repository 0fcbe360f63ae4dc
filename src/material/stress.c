/* Stress tensors by themselves: principal and equivalent stresses, rotation. */
#include "../core/eigen.h"
#include "rotation.h"

#include <math.h>
#include <sph/stress.h>

static int shape_is_bad(int32_t dim, int64_t n) { return dim < 1 || dim > 3 || n < 0; }

sph_status sph_principal_stresses(int32_t dim, int64_t n, const double *sigma, double *values,
                                  double *directions) {
  if (shape_is_bad(dim, n) || sigma == NULL || values == NULL) return SPH_ERR_ARG;
  const int32_t comps = dim * (dim + 1) / 2;
  for (int64_t i = 0; i < n; i++)
    sphi_eigen_symmetric(dim, sigma + i * comps, values + i * dim,
                         directions != NULL ? directions + i * dim * dim : NULL);
  return SPH_OK;
}

/* sqrt of half the squared differences of the normal stresses plus three times the shears' */
static double equivalent(int32_t dim, const double *s, double across) {
  const double a = s[0], b = dim > 1 ? s[1] : across, c = dim > 2 ? s[2] : across;
  double square = 0.5 * ((a - b) * (a - b) + (b - c) * (b - c) + (c - a) * (c - a));
  for (int32_t k = dim; k < dim * (dim + 1) / 2; k++) square += 3 * s[k] * s[k];
  return sqrt(square);
}

sph_status sph_equivalent_stress(int32_t dim, int64_t n, const double *sigma, const double *across,
                                 double *out) {
  if (shape_is_bad(dim, n) || sigma == NULL || out == NULL) return SPH_ERR_ARG;
  const int32_t comps = dim * (dim + 1) / 2;
  for (int64_t i = 0; i < n; i++)
    out[i] = equivalent(dim, sigma + i * comps, across != NULL ? across[i] : 0);
  return SPH_OK;
}

/* ---- rotation ---- */

sphi_rotation sphi_rotation_of(int32_t dim, const double *l, double dt, int32_t kind) {
  /* omega b = axis x b */
  double half[3] = {0, 0, 0};
  if (dim == 2) {
    half[2] = 0.25 * dt * (l[2] - l[1]);
  } else {
    half[0] = 0.25 * dt * (l[7] - l[5]);
    half[1] = 0.25 * dt * (l[2] - l[6]);
    half[2] = 0.25 * dt * (l[3] - l[1]);
  }
  const double angle = sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
  double w, factor;
  if (kind == SPH_ROTATION_CAYLEY) {
    w = factor = 1 / sqrt(1 + angle * angle);
  } else {
    w = cos(angle);
    factor = angle > 1e-8 ? sin(angle) / angle : 1;
  }
  return (sphi_rotation){w, factor * half[0], factor * half[1], factor * half[2]};
}

sphi_rotation sphi_rotation_half(sphi_rotation q) {
  if (q.w < 0) q = (sphi_rotation){-q.w, -q.x, -q.y, -q.z};
  const double norm = sqrt(2 * (1 + q.w));
  return (sphi_rotation){(1 + q.w) / norm, q.x / norm, q.y / norm, q.z / norm};
}

static void rotate_2(sphi_rotation q, double *s) {
  const double c = q.w * q.w - q.z * q.z, n = 2 * q.w * q.z; /* cos, sin of the angle */
  const double mean = 0.5 * (s[0] + s[1]), half = 0.5 * (s[0] - s[1]);
  const double c2 = c * c - n * n, n2 = 2 * c * n;
  const double turned = c2 * half - n2 * s[2];
  s[2] = n2 * half + c2 * s[2];
  s[0] = mean + turned;
  s[1] = mean - turned;
}

static void rotate_3(sphi_rotation q, double *s) {
  const double r[3][3] = {
      {1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - q.w * q.z), 2 * (q.x * q.z + q.w * q.y)},
      {2 * (q.x * q.y + q.w * q.z), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z - q.w * q.x)},
      {2 * (q.x * q.z - q.w * q.y), 2 * (q.y * q.z + q.w * q.x), 1 - 2 * (q.x * q.x + q.y * q.y)}};
  static const int32_t row[] = {0, 1, 2, 0, 0, 1}, column[] = {0, 1, 2, 1, 2, 2};
  const double m[3][3] = {{s[0], s[3], s[4]}, {s[3], s[1], s[5]}, {s[4], s[5], s[2]}};
  double rm[3][3];
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++)
      rm[a][b] = r[a][0] * m[0][b] + r[a][1] * m[1][b] + r[a][2] * m[2][b];
  for (int c = 0; c < 6; c++) {
    const double *a = rm[row[c]], *b = r[column[c]];
    s[c] = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
}

void sphi_rotate(int32_t dim, sphi_rotation q, double *s) {
  if (dim == 2) rotate_2(q, s);
  if (dim == 3) rotate_3(q, s);
}

sph_status sph_stress_rotate(int32_t dim, int64_t n, const double *velocity_gradient, double dt,
                             int32_t rotation, double *sigma) {
  if (shape_is_bad(dim, n) || velocity_gradient == NULL || sigma == NULL || !isfinite(dt))
    return SPH_ERR_ARG;
  if (rotation != SPH_ROTATION_EXPONENTIAL && rotation != SPH_ROTATION_CAYLEY) return SPH_ERR_ARG;
  for (int64_t i = 0; i < n && dim > 1; i++)
    sphi_rotate(dim, sphi_rotation_of(dim, velocity_gradient + i * dim * dim, dt, rotation),
                sigma + i * (dim * (dim + 1) / 2));
  return SPH_OK;
}
