/* Eigenvalues and eigenvectors of symmetric matrices up to 3x3 in closed form.
 *
 * The usual trigonometric formula loses half the digits where two eigenvalues nearly agree. It is
 * sound for the one that lies farthest from the other two: with trace 0 and squares summing to 6,
 * that one is between sqrt(3) and 2 in size and at least sqrt(3) from the others. So only this one
 * and its vector come from it; in the plane across, the remaining 2x2 problem is solved by one
 * plane rotation, which is sound for any pair. After D. Eberly, A Robust Eigensolver for 3x3
 * Symmetric Matrices, Geometric Tools, 2014. */
#include "eigen.h"

#include <math.h>
#include <string.h>

static double dot(const double *a, const double *b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double *a, const double *b, double *out) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

/* (c, s) of the rotation that makes {{a, b}, {b, d}} diagonal, the larger eigenvalue first */
static void plane_rotation(double a, double b, double d, double *c, double *s) {
  double half = 0.5 * (a - d), length = hypot(half, b);
  *c = 1;
  *s = 0;
  if (!(length > 0)) return;
  /* cos and sin of twice the angle are half/length and b/length */
  double larger = sqrt(0.5 * (1 + fabs(half) / length)), smaller = 0.5 * (b / length) / larger;
  *c = half >= 0 ? larger : fabs(smaller);
  *s = half >= 0 ? smaller : copysign(larger, b);
}

static void eigen_2(const double *m, double *values, double *vectors) {
  double c, s, mean = 0.5 * (m[0] + m[1]), radius = hypot(0.5 * (m[0] - m[1]), m[2]);
  values[0] = mean + radius;
  values[1] = mean - radius;
  if (vectors == NULL) return;
  plane_rotation(m[0], m[2], m[1], &c, &s);
  vectors[0] = vectors[3] = c;
  vectors[1] = s;
  vectors[2] = -s;
}

static void apply(const double *m, const double *v, double *out) {
  out[0] = m[0] * v[0] + m[3] * v[1] + m[4] * v[2];
  out[1] = m[3] * v[0] + m[1] * v[1] + m[5] * v[2];
  out[2] = m[4] * v[0] + m[5] * v[1] + m[2] * v[2];
}

/* Unit vector along which (m - value I) vanishes: the longest of the products of two rows. */
static void null_vector(const double *m, double value, double *v) {
  const double rows[3][3] = {
      {m[0] - value, m[3], m[4]}, {m[3], m[1] - value, m[5]}, {m[4], m[5], m[2] - value}};
  double best = -1;
  for (int k = 0; k < 3; k++) {
    double candidate[3];
    cross(rows[k], rows[(k + 1) % 3], candidate);
    double square = dot(candidate, candidate);
    if (square <= best) continue;
    best = square;
    memcpy(v, candidate, sizeof candidate);
  }
  for (int k = 0; k < 3; k++) v[k] /= sqrt(best);
}

/* Unit vectors u, w that make (v, u, w) orthonormal and right-handed. */
static void complete(const double *v, double *u, double *w) {
  int small = fabs(v[0]) <= fabs(v[1]) ? 0 : 1; /* v has another component that is larger */
  double length = hypot(v[1 - small], v[2]);
  memset(u, 0, 3 * sizeof *u);
  u[1 - small] = -v[2] / length;
  u[2] = v[1 - small] / length;
  cross(v, u, w);
}

/* m has trace 0 and squares that sum to 6. Values descend; frame: their vectors. */
static void eigen_normalised(const double *m, double *values, double frame[3][3]) {
  static const double third_turn = 2.0943951023931954923;
  double determinant = m[0] * (m[1] * m[2] - m[5] * m[5]) - m[3] * (m[3] * m[2] - m[5] * m[4]) +
                       m[4] * (m[3] * m[5] - m[1] * m[4]);
  double angle = acos(fmax(-1.0, fmin(1.0, 0.5 * determinant))) / 3;
  int largest = determinant >= 0; /* the one that lies apart is the largest, or the least */
  double v[3], u[3], w[3], mu[3], mw[3], mv[3], c, s;
  null_vector(m, 2 * cos(largest ? angle : angle + third_turn), v);
  complete(v, u, w);
  apply(m, u, mu);
  apply(m, w, mw);
  apply(m, v, mv);
  plane_rotation(dot(u, mu), dot(u, mw), dot(w, mw), &c, &s);
  double mean = 0.5 * (dot(u, mu) + dot(w, mw));
  double radius = hypot(0.5 * (dot(u, mu) - dot(w, mw)), dot(u, mw));
  int at = largest ? 0 : 2, first = largest ? 1 : 0;
  values[at] = dot(v, mv);
  values[first] = mean + radius;
  values[first + 1] = mean - radius;
  for (int k = 0; k < 3; k++) {
    frame[at][k] = v[k];
    frame[first][k] = c * u[k] + s * w[k];
    frame[first + 1][k] = c * w[k] - s * u[k];
  }
}

static void exchange(double *values, double frame[3][3], int a, int b) {
  if (values[a] >= values[b]) return;
  double value = values[a];
  values[a] = values[b];
  values[b] = value;
  for (int k = 0; k < 3; k++) { /* one sign changes, so that the frame stays right-handed */
    double component = frame[a][k];
    frame[a][k] = frame[b][k];
    frame[b][k] = -component;
  }
}

/* Multiply by a power of two, if need be, that makes squares and cubes of the entries ordinary
 * doubles; returns its exponent. It changes no bit of the result. */
static int scale_to_one(int32_t count, double *m) {
  double largest = 0;
  int exponent = 0;
  for (int32_t k = 0; k < count; k++) largest = fmax(largest, fabs(m[k]));
  if (!(largest > 0) || (largest > 0x1p-200 && largest < 0x1p200)) return 0;
  (void)frexp(largest, &exponent);
  for (int32_t k = 0; k < count; k++) m[k] = ldexp(m[k], -exponent);
  return exponent;
}

static void eigen_3(const double *m, double *values, double *vectors) {
  double b[6], mean = (m[0] + m[1] + m[2]) / 3, frame[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int k = 0; k < 6; k++) b[k] = k < 3 ? m[k] - mean : m[k];
  const int exponent = scale_to_one(6, b); /* they may be tiny beside the mean */
  double off = dot(b + 3, b + 3), size = sqrt((dot(b, b) + 2 * off) / 6);
  if (!(off > 0)) { /* diagonal: exact */
    memcpy(values, m, 3 * sizeof *values);
  } else {
    for (int k = 0; k < 6; k++) b[k] /= size;
    eigen_normalised(b, values, frame);
    for (int k = 0; k < 3; k++) values[k] = mean + ldexp(size * values[k], exponent);
  }
  exchange(values, frame, 0, 1);
  exchange(values, frame, 1, 2);
  exchange(values, frame, 0, 1);
  if (vectors != NULL) memcpy(vectors, frame, sizeof frame);
}

void sphi_eigen_symmetric(int32_t dim, const double *packed, double *values, double *vectors) {
  const int32_t count = dim * (dim + 1) / 2;
  double scaled[6];
  int finite = 1;
  for (int32_t k = 0; k < count; k++) finite &= isfinite(scaled[k] = packed[k]) != 0;
  if (!finite) {
    for (int32_t k = 0; k < dim; k++) values[k] = NAN;
    for (int32_t k = 0; k < dim * dim && vectors != NULL; k++) vectors[k] = NAN;
    return;
  }
  const int exponent = scale_to_one(count, scaled);
  if (dim == 1) {
    values[0] = scaled[0];
    if (vectors != NULL) vectors[0] = 1;
  } else if (dim == 2) {
    eigen_2(scaled, values, vectors);
  } else {
    eigen_3(scaled, values, vectors);
  }
  for (int32_t k = 0; k < dim; k++) values[k] = ldexp(values[k], exponent);
}
