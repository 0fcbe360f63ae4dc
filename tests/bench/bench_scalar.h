/* The same sums as a plain C loop: double precision, one pair at a time, compressed rows of a
 * spatially sorted set, equal masses not assumed, equal h assumed. What a figure of the library is
 * a multiple of. Written as a careful programmer would without vectors: one square root and as few
 * divisions as the formulas allow, what belongs to one particle computed once. */
#ifndef SPH_TESTS_BENCH_SCALAR_H
#define SPH_TESTS_BENCH_SCALAR_H

#include "bench.h"
#include "bench_cases.h"

typedef struct scalar_job {
  sph_operands a;
  const int64_t *offsets;
  const int32_t *indices;
  int64_t rows;       /* the first ones; what belongs to later ones was computed before, on all */
  double alpha, beta; /* viscosity */
  double art_epsilon, art_ratio;      /* artificial stress */
  const double *f;                    /* field of the gradient */
  double *pr, *matrix, *art;          /* scratch */
  double *drho, *dvdt, *gradv, *grad; /* results */
} scalar_job;

#define SCALAR_INLINE static inline __attribute__((always_inline, unused))
#define SCALAR_UNROLL _Pragma("GCC unroll 6")

/* alpha_d / h^d of Wendland C2 */
SCALAR_INLINE double scalar_norm(int dim, double h) {
  const double pi = 3.14159265358979323846;
  return dim == 1   ? 5.0 / 8.0 / h
         : dim == 2 ? 7.0 / (4.0 * pi) / (h * h)
                    : 21.0 / (16.0 * pi) / (h * h * h);
}
/* w(q) and dw/dq / q, q < 2 */
SCALAR_INLINE double scalar_w(int dim, double q) {
  double u = 1.0 - 0.5 * q;
  return dim == 1 ? u * u * u * (1.0 + 1.5 * q) : u * u * u * u * (1.0 + 2.0 * q);
}
SCALAR_INLINE double scalar_slope(int dim, double q) {
  double u = 1.0 - 0.5 * q;
  return dim == 1 ? -3.0 * u * u : -5.0 * u * u * u;
}
SCALAR_INLINE double scalar_distance(const double *x, int64_t i, int64_t j, int dim, double *dx) {
  double r2 = 0.0;
  SCALAR_UNROLL for (int k = 0; k < dim; k++) {
    dx[k] = x[i * dim + k] - x[j * dim + k];
    r2 += dx[k] * dx[k];
  }
  return r2;
}

SCALAR_INLINE void scalar_wcsph_dim(const scalar_job *s, int dim) {
  const sph_operands *a = &s->a;
  const double *m = a->m, *rho = a->rho, *c = a->c, *pr = s->pr;
  double h = a->h[0], norm = scalar_norm(dim, h) / (h * h), per_h = 1.0 / h;
  for (int64_t i = 0; i < s->rows; i++) {
    double q = a->p[i] / (rho[i] * rho[i]);
    s->pr[i] = q;
  }
  for (int64_t i = 0; i < s->rows; i++) {
    double drho = 0.0, acc[3] = {0.0, 0.0, 0.0};
    for (int64_t k = s->offsets[i]; k < s->offsets[i + 1]; k++) {
      int64_t j = s->indices[k];
      double dx[3], dv[3], vx = 0.0, r2 = scalar_distance(a->x, i, j, dim, dx);
      SCALAR_UNROLL for (int d = 0; d < dim; d++) {
        dv[d] = a->v[i * dim + d] - a->v[j * dim + d];
        vx += dv[d] * dx[d];
      }
      double mf = m[j] * norm * scalar_slope(dim, sqrt(r2) * per_h), push = pr[i] + pr[j];
      if (vx < 0.0) {
        double phi = h * vx / (r2 + 0.01 * h * h);
        push += phi * (s->beta * phi - 0.5 * s->alpha * (c[i] + c[j])) / (0.5 * (rho[i] + rho[j]));
      }
      drho += mf * vx;
      SCALAR_UNROLL for (int d = 0; d < dim; d++) acc[d] -= mf * push * dx[d];
    }
    s->drho[i] = drho;
    for (int d = 0; d < dim; d++) s->dvdt[i * dim + d] = acc[d];
  }
}

/* place of (a, b) in a packed tensor */
SCALAR_INLINE int scalar_sym(int dim, int a, int b) {
  return a == b ? a : dim == 2 ? 2 : a + b + 2;
}

/* B_i^-1 by cofactors. */
SCALAR_INLINE void scalar_inverse(int dim, const double *b, double *inverse) {
  if (dim == 1) {
    inverse[0] = 1.0 / b[0];
  } else if (dim == 2) {
    double det = b[0] * b[3] - b[1] * b[2];
    inverse[0] = b[3] / det;
    inverse[1] = -b[1] / det;
    inverse[2] = -b[2] / det;
    inverse[3] = b[0] / det;
  } else {
    double det = 0.0;
    for (int r = 0; r < 3; r++)
      for (int c = 0; c < 3; c++) {
        int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
        inverse[c * 3 + r] = b[r1 * 3 + c1] * b[r2 * 3 + c2] - b[r1 * 3 + c2] * b[r2 * 3 + c1];
      }
    for (int c = 0; c < 3; c++) det += b[c] * inverse[c * 3];
    for (int k = 0; k < 9; k++) inverse[k] /= det;
  }
}

SCALAR_INLINE void scalar_matrices(const scalar_job *s, int dim) {
  const sph_operands *a = &s->a;
  double h = a->h[0], norm = scalar_norm(dim, h) / (h * h), per_h = 1.0 / h;
  for (int64_t i = 0; i < s->rows; i++) {
    double b[9] = {0.0};
    for (int64_t k = s->offsets[i]; k < s->offsets[i + 1]; k++) {
      int64_t j = s->indices[k];
      double dx[3], r2 = scalar_distance(a->x, i, j, dim, dx);
      double vf = -s->pr[j] * norm * scalar_slope(dim, sqrt(r2) * per_h);
      SCALAR_UNROLL for (int c = 0; c < dim; c++) {
        SCALAR_UNROLL for (int d = 0; d < dim; d++) b[c * dim + d] += vf * dx[c] * dx[d];
      }
    }
    scalar_inverse(dim, b, s->matrix + i * dim * dim);
  }
}

/* Velocity gradient, stress divergence and viscosity in one pass; cured: with corrected gradients
 * and artificial stress, after a pass for the matrices. pr holds V_j. */
SCALAR_INLINE void scalar_elastic_dim(const scalar_job *s, int dim, int cured) {
  const sph_operands *a = &s->a;
  const double *m = a->m, *rho = a->rho, *c = a->c;
  const int n = dim * (dim + 1) / 2;
  double h = a->h[0], norm = scalar_norm(dim, h) / (h * h), per_h = 1.0 / h;
  double at_spacing = 1.0 / scalar_w(dim, s->art_ratio);
  double *weighted = s->grad; /* sigma / rho^2 */
  for (int64_t i = 0; i < s->rows; i++) {
    s->pr[i] = m[i] / rho[i];
    for (int k = 0; k < n; k++) weighted[i * n + k] = a->sigma[i * n + k] / (rho[i] * rho[i]);
  }
  if (cured) {
    scalar_matrices(s, dim);
    BENCH_OK(sph_artificial_stress(dim, s->rows, a->sigma, rho, 0.0, s->art_epsilon, s->art), NULL);
  }
  for (int64_t i = 0; i < s->rows; i++) {
    double L[9] = {0.0}, acc[3] = {0.0, 0.0, 0.0}, ti[6];
    for (int k = 0; k < n; k++) ti[k] = weighted[i * n + k];
    for (int64_t k = s->offsets[i]; k < s->offsets[i + 1]; k++) {
      int64_t j = s->indices[k];
      double dx[3], dv[3], g[3], t[6], vx = 0.0, r2 = scalar_distance(a->x, i, j, dim, dx);
      double q = sqrt(r2) * per_h, f = norm * scalar_slope(dim, q), pi = 0.0;
      SCALAR_UNROLL for (int d = 0; d < dim; d++) {
        dv[d] = a->v[i * dim + d] - a->v[j * dim + d];
        vx += dv[d] * dx[d];
        g[d] = f * dx[d];
      }
      if (cured) {
        double plain[3];
        SCALAR_UNROLL for (int d = 0; d < dim; d++) plain[d] = g[d];
        SCALAR_UNROLL for (int d = 0; d < dim; d++) {
          g[d] = 0.0;
          SCALAR_UNROLL for (int e = 0; e < dim; e++) g[d] +=
              s->matrix[(i * dim + d) * dim + e] * plain[e];
        }
      }
      if (vx < 0.0) {
        double phi = h * vx / (r2 + 0.01 * h * h);
        pi = phi * (s->beta * phi - 0.5 * s->alpha * (c[i] + c[j])) / (0.5 * (rho[i] + rho[j]));
      }
      SCALAR_UNROLL for (int d = 0; d < n; d++) t[d] = ti[d] + weighted[j * n + d];
      if (cured) {
        double w = scalar_w(dim, q) * at_spacing, w2 = w * w, w4 = w2 * w2;
        SCALAR_UNROLL for (int d = 0; d < n; d++) t[d] +=
            w4 * (s->art[i * n + d] + s->art[j * n + d]);
      }
      SCALAR_UNROLL for (int d = 0; d < dim; d++) {
        double sum = -pi * g[d], vg = -s->pr[j] * g[d];
        SCALAR_UNROLL for (int e = 0; e < dim; e++) {
          sum += t[scalar_sym(dim, d, e)] * g[e];
          L[e * dim + d] += dv[e] * vg;
        }
        acc[d] += m[j] * sum;
      }
    }
    for (int d = 0; d < dim; d++) s->dvdt[i * dim + d] = acc[d];
    for (int d = 0; d < dim * dim; d++) s->gradv[i * dim * dim + d] = L[d];
  }
}

SCALAR_INLINE void scalar_density_dim(const scalar_job *s, int dim) {
  const sph_operands *a = &s->a;
  double h = a->h[0], norm = scalar_norm(dim, h), per_h = 1.0 / h;
  for (int64_t i = 0; i < s->rows; i++) {
    double sum = a->m[i] * scalar_w(dim, 0.0);
    for (int64_t k = s->offsets[i]; k < s->offsets[i + 1]; k++) {
      double dx[3], r2 = scalar_distance(a->x, i, s->indices[k], dim, dx);
      sum += a->m[s->indices[k]] * scalar_w(dim, sqrt(r2) * per_h);
    }
    s->drho[i] = norm * sum;
  }
}

SCALAR_INLINE void scalar_gradient_dim(const scalar_job *s, int dim) {
  const sph_operands *a = &s->a;
  double h = a->h[0], norm = scalar_norm(dim, h) / (h * h), per_h = 1.0 / h;
  for (int64_t i = 0; i < s->rows; i++) s->pr[i] = a->m[i] / a->rho[i];
  for (int64_t i = 0; i < s->rows; i++) {
    double sum[3] = {0.0, 0.0, 0.0};
    for (int64_t k = s->offsets[i]; k < s->offsets[i + 1]; k++) {
      int64_t j = s->indices[k];
      double dx[3], r2 = scalar_distance(a->x, i, j, dim, dx);
      double w = s->pr[j] * (s->f[j] - s->f[i]) * norm * scalar_slope(dim, sqrt(r2) * per_h);
      SCALAR_UNROLL for (int d = 0; d < dim; d++) sum[d] += w * dx[d];
    }
    for (int d = 0; d < dim; d++) s->grad[i * dim + d] = sum[d];
  }
}

/* --- work of the loops -------------------------------------------------------------------- */

/* What one pair costs: additions, multiplications, divisions and square roots of the loops above,
 * each once, the viscosity of every pair included. Counted by hand, for 2-D and 3-D:
 *   distance             dim + 2 dim - 1
 *   q and slope          2 + 5
 *   v_ij and v_ij.x_ij   dim + 2 dim - 1
 *   viscosity            3 + 4 + 2 + 2 (phi, bracket, density, quotient)
 *   wcsph: mf, push, its viscosity 2 + 1 + 1; rate of density 2; acceleration 1 + 2 dim
 *   elastic: f, gradient 1 + dim; sums of stress n; acceleration and velocity gradient
 *            dim (4 + 4 dim)
 *   density: distance, q 2, w 8, sum 2; gradient: distance, q and slope, weight 4, sums 2 dim
 *   cured: another pass for the matrix (distance, q and slope, volume 2, entries 2 dim^2 + dim),
 *          corrected gradient 2 dim^2, artificial stress 11 + 3 n */
BENCH_FN double scalar_flops(int which, int dim) {
  double d = dim, n = d * (d + 1.0) / 2.0, distance = 3.0 * d - 1.0;
  double elastic = 2.0 * distance + 7.0 + 11.0 + 1.0 + d + n + d * (4.0 + 4.0 * d);
  double matrix = distance + 7.0 + 2.0 + 2.0 * d * d + d;
  switch (which) {
  case BENCH_WCSPH:
    return 2.0 * distance + 7.0 + 11.0 + 4.0 + 2.0 + 1.0 + 2.0 * d;
  case BENCH_ELASTIC:
    return elastic;
  case BENCH_CURED:
    return elastic + matrix + 2.0 * d * d + 11.0 + 3.0 * n;
  case BENCH_DENSITY:
    return distance + 2.0 + 8.0 + 2.0;
  default:
    return distance + 7.0 + 4.0 + 2.0 * d;
  }
}

/* Doubles of a particle that a case must read and write, whatever the program. */
BENCH_FN double scalar_doubles(int which, int dim) {
  double d = dim, n = d * (d + 1.0) / 2.0;
  switch (which) {
  case BENCH_WCSPH: /* x v m rho p c; dv/dt drho/dt */
    return 2.0 * d + 4.0 + d + 1.0;
  case BENCH_ELASTIC: /* x v m rho c sigma; dv/dt dsigma/dt */
  case BENCH_CURED:
    return 2.0 * d + 3.0 + n + d + n;
  case BENCH_DENSITY: /* x m; rho */
    return d + 2.0;
  default: /* x m rho f; gradient */
    return d + 3.0 + d;
  }
}

/* One function a case; the dimension is a constant within. */
#define SCALAR_CASE(name, ...)     \
  BENCH_FN void name(void *user) { \
    const scalar_job *s = user;    \
    if (s->a.dim == 1) {           \
      enum { DIM = 1 };            \
      __VA_ARGS__;                 \
    } else if (s->a.dim == 2) {    \
      enum { DIM = 2 };            \
      __VA_ARGS__;                 \
    } else {                       \
      enum { DIM = 3 };            \
      __VA_ARGS__;                 \
    }                              \
  }
SCALAR_CASE(scalar_wcsph, scalar_wcsph_dim(s, DIM))
SCALAR_CASE(scalar_elastic, scalar_elastic_dim(s, DIM, 0))
SCALAR_CASE(scalar_cured, scalar_elastic_dim(s, DIM, 1))
SCALAR_CASE(scalar_density, scalar_density_dim(s, DIM))
SCALAR_CASE(scalar_gradient, scalar_gradient_dim(s, DIM))

#endif
