/* The inverse of a kernel-gradient matrix, and where there is none. */
#ifndef SPHI_INVERT_H
#define SPHI_INVERT_H

#include <math.h>
#include <stdint.h>

#define SPHI_INVERT_INLINE static inline __attribute__((always_inline, unused))

/* Adjugate and determinant: inverse = adjugate / det. */
SPHI_INVERT_INLINE double sphi_adjugate(int32_t d, const double *b, double *adj) {
  if (d == 1) {
    adj[0] = 1.0;
    return b[0];
  }
  if (d == 2) {
    adj[0] = b[3];
    adj[1] = -b[1];
    adj[2] = -b[2];
    adj[3] = b[0];
    return b[0] * b[3] - b[1] * b[2];
  }
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) {
      int r1 = (c + 1) % 3, r2 = (c + 2) % 3, c1 = (r + 1) % 3, c2 = (r + 2) % 3;
      adj[r * 3 + c] = b[r1 * 3 + c1] * b[r2 * 3 + c2] - b[r1 * 3 + c2] * b[r2 * 3 + c1];
    }
  return b[0] * adj[0] + b[1] * adj[3] + b[2] * adj[6];
}

SPHI_INVERT_INLINE double sphi_frobenius(int32_t d, const double *a) {
  double s = 0.0;
  for (int k = 0; k < d * d; ++k) s += a[k] * a[k];
  return sqrt(s);
}

/* B_i to its inverse, or the identity where it is ill conditioned (correction.h): 1 then, else 0.
 * A matrix far from the identity in size is as useless as a singular one. */
SPHI_INVERT_INLINE int sphi_invert_gradient_matrix(int32_t dim, const double *b, double *inverse) {
  enum { CONDITION_LIMIT = 1000 };
  double adj[9], det = sphi_adjugate(dim, b, adj), size = sphi_frobenius(dim, b);
  int good =
      isfinite(det) && size > 1e-3 && size * sphi_frobenius(dim, adj) < CONDITION_LIMIT * fabs(det);
  double scale = 1.0 / det;
  for (int k = 0; k < dim * dim; ++k)
    inverse[k] = good ? adj[k] * scale : (k % (dim + 1) == 0 ? 1.0 : 0.0);
  return !good;
}

#endif
