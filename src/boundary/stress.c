/* Symmetric tensors at a plane. */
#include "boundary_impl.h"

void sphi_sym_unpack(int32_t dim, const double *packed, double s[3][3]) {
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) s[a][b] = 0.0;
  for (int32_t a = 0; a < dim; ++a) s[a][a] = packed[a];
  if (dim > 1) s[0][1] = s[1][0] = packed[dim];
  if (dim > 2) {
    s[0][2] = s[2][0] = packed[4];
    s[1][2] = s[2][1] = packed[5];
  }
}

void sphi_sym_pack(int32_t dim, double s[3][3], double *packed) {
  for (int32_t a = 0; a < dim; ++a) packed[a] = s[a][a];
  if (dim > 1) packed[dim] = s[0][1];
  if (dim > 2) {
    packed[4] = s[0][2];
    packed[5] = s[1][2];
  }
}

void sphi_change_traction(double s[3][3], const double *n, const double *c) {
  const double along = sphi_dot(3, c, n);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) s[a][b] += c[a] * n[b] + n[a] * c[b] - along * n[a] * n[b];
}
