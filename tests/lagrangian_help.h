/* What the total-Lagrangian tests share: a body in its reference configuration, deformations, and
 * plain references of the pair sums, over all pairs, from the formulas as they stand in
 * operators.h, with kernel values from the public point functions. */
#ifndef SPH_TESTS_LAGRANGIAN_HELP_H
#define SPH_TESTS_LAGRANGIAN_HELP_H

#include "rhs_help.h"

typedef struct lg_body {
  rh_system s;
  sph_operands a; /* of the reference configuration */
  double *X, *x, *matrix, *F, *P;
  double edge[3]; /* of periodic axes, else 0 */
  int32_t rule;
  int64_t rows;
} lg_body;

static CHECK_UNUSED double *lg_copy(const double *from, int64_t n) {
  double *to = rh_array(n);
  memcpy(to, from, (size_t)n * sizeof *to);
  return to;
}

/* rh_make()'s system frozen where it is, with the list's rule for unequal h. */
static CHECK_UNUSED lg_body lg_make(sph_context *ctx, int32_t dim, uint32_t flavour, int32_t rule,
                                    uint64_t seed) {
  lg_body b = {.rule = rule};
  b.s = rh_make(ctx, dim, rh_side(dim), flavour, seed);
  sph_neighbors_options o;
  sph_neighbors_options_init(&o);
  o.h_rule = rule;
  for (int k = 0; k < dim && (flavour & RH_WRAP); k++) {
    o.periodic[k] = 1;
    o.box_hi[k] = b.edge[k] = (double)rh_side(dim);
  }
  sph_neighbors_destroy(b.s.list);
  check_ok(sph_neighbors_create(ctx, &o, &b.s.list));
  check_ok(sph_neighbors_build(b.s.list, b.s.set));
  check_ok(sph_operands_from_set(b.s.set, &b.a));
  int64_t n = b.s.n;
  b.rows = b.s.rows;
  b.X = lg_copy(b.a.x, n * dim);
  b.x = lg_copy(b.a.x, n * dim);
  b.matrix = rh_array(n * dim * dim);
  b.F = rh_array(n * dim * dim);
  b.P = rh_array(n * dim * dim);
  b.a.x = b.X;
  b.a.rows = -1; /* the tensors are wanted of all */
  check_ok(sph_gradient_matrix(b.s.list, b.s.kernel, &b.a, b.matrix, NULL, NULL));
  b.a.gradient_matrix = b.matrix;
  return b;
}

static CHECK_UNUSED void lg_free(lg_body *b) {
  free(b->X);
  free(b->x);
  free(b->matrix);
  free(b->F);
  free(b->P);
  rh_free(&b->s);
}

/* x = A X + t. */
static CHECK_UNUSED void lg_deform(lg_body *b, const double *A, double t) {
  int d = b->s.dim;
  for (int64_t i = 0; i < b->s.n; i++)
    for (int r = 0; r < d; r++) {
      b->x[i * d + r] = t;
      for (int c = 0; c < d; c++) b->x[i * d + r] += A[r * d + c] * b->X[i * d + c];
    }
}

/* A fixed rotation about (1, 2, 3), in 2-D about z, in 1-D none. */
static CHECK_UNUSED void lg_rotation(int d, double angle, double *R) {
  double axis[3] = {1.0, 2.0, 3.0}, size = sqrt(14.0), c = cos(angle), s = sin(angle);
  if (d == 1) R[0] = 1.0;
  if (d == 2) {
    R[0] = R[3] = c;
    R[1] = -s;
    R[2] = s;
  }
  for (int r = 0; d == 3 && r < 3; r++)
    for (int k = 0; k < 3; k++) {
      double u = axis[r] / size, v = axis[k] / size;
      int third = 3 - r - k;
      double sign = r == k ? 0.0 : (k - r + 3) % 3 == 1 ? -1.0 : 1.0;
      R[r * 3 + k] = (1.0 - c) * u * v + (r == k ? c : sign * s * axis[third] / size);
    }
}

static CHECK_UNUSED void lg_shake(lg_body *b, double size) {
  for (int64_t k = 0; k < b->s.n * b->s.dim; k++) b->x[k] += rh_random(-size, size);
}

/* ---- references ----------------------------------------------------------------------------- */

typedef struct lg_pair {
  double X[3], x[3];  /* X_ij, x_ij = X_ij + u_ij */
  double R, W, slope; /* |X_ij|, W, (dW/dr)/r */
  double vol;         /* V_j */
} lg_pair;

static CHECK_UNUSED double lg_h(int32_t rule, double a, double b) {
  switch (rule) {
  case SPH_H_HARMONIC:
    return 2.0 * a * b / (a + b);
  case SPH_H_MAX:
    return a > b ? a : b;
  case SPH_H_MIN:
    return a < b ? a : b;
  default:
    return 0.5 * (a + b);
  }
}

static CHECK_UNUSED lg_pair lg_pair_of(const lg_body *b, int64_t i, int64_t j) {
  lg_pair p = {.R = 0.0};
  int d = b->s.dim;
  const sph_kernel *k = b->s.kernel;
  double hi = b->a.h[i], hj = b->a.h[j], dw;
  for (int c = 0; c < d; c++) {
    double u = (b->x[i * d + c] - b->X[i * d + c]) - (b->x[j * d + c] - b->X[j * d + c]);
    p.X[c] = b->X[i * d + c] - b->X[j * d + c];
    if (b->edge[c] > 0.0) p.X[c] -= b->edge[c] * nearbyint(p.X[c] / b->edge[c]);
    p.x[c] = p.X[c] + u;
    p.R += p.X[c] * p.X[c];
  }
  p.R = sqrt(p.R);
  if (b->rule == SPH_H_AVERAGE) {
    p.W = 0.5 * (sph_kernel_w(k, p.R, hi) + sph_kernel_w(k, p.R, hj));
    dw = 0.5 * (sph_kernel_dwdr(k, p.R, hi) + sph_kernel_dwdr(k, p.R, hj));
  } else {
    double h = lg_h(b->rule, hi, hj);
    p.W = sph_kernel_w(k, p.R, h);
    dw = sph_kernel_dwdr(k, p.R, h);
  }
  p.slope = dw / p.R;
  p.vol = b->a.m[j] / b->a.rho[j];
  return p;
}

/* out = M v of a row-major matrix. */
static CHECK_UNUSED void lg_times(int d, const double *M, const double *v, double *out) {
  for (int r = 0; r < d; r++) {
    out[r] = 0.0;
    for (int c = 0; c < d; c++) out[r] += M[r * d + c] * v[c];
  }
}

/* F_i = sum V_j (x_j - x_i) (x) B^-1 g_ij, as published. bound: of rounding. */
static CHECK_UNUSED void lg_gradient(const lg_body *b, int64_t i, double *F, double *bound) {
  int d = b->s.dim;
  double e[3];
  for (int k = 0; k < d * d; k++) F[k] = bound[k] = 0.0;
  for (int64_t j = 0; j < b->s.n; j++) {
    if (j == i) continue;
    lg_pair p = lg_pair_of(b, i, j);
    lg_times(d, b->matrix + i * d * d, p.X, e);
    for (int r = 0; r < d; r++)
      for (int c = 0; c < d; c++) {
        F[r * d + c] -= p.vol * p.x[r] * p.slope * e[c];
        bound[r * d + c] += fabs(p.vol * p.x[r] * p.slope * e[c]);
      }
  }
}

/* A pair's share of m_i dv_i/dt / V_i = rho_i dv_i/dt. */
typedef void (*lg_term)(const lg_body *b, const void *data, int64_t i, int64_t j, const lg_pair *p,
                        double *f);

static CHECK_UNUSED void lg_force(const lg_body *b, lg_term term, const void *data, int64_t i,
                                  double *dvdt, double *bound) {
  int d = b->s.dim;
  double f[3];
  for (int k = 0; k < d; k++) dvdt[k] = bound[k] = 0.0;
  for (int64_t j = 0; j < b->s.n; j++) {
    if (j == i) continue;
    lg_pair p = lg_pair_of(b, i, j);
    if (p.W == 0.0 && p.slope == 0.0) continue;
    term(b, data, i, j, &p, f);
    for (int k = 0; k < d; k++) {
      dvdt[k] += p.vol * f[k] / b->a.rho[i];
      bound[k] += fabs(p.vol * f[k] / b->a.rho[i]);
    }
  }
}

static CHECK_UNUSED void lg_conservative(const lg_body *b, const void *data, int64_t i, int64_t j,
                                         const lg_pair *p, double *f) {
  int d = b->s.dim, dd = d * d;
  double ei[3], ej[3], fi[3], fj[3];
  (void)data;
  lg_times(d, b->matrix + i * dd, p->X, ei);
  lg_times(d, b->matrix + j * dd, p->X, ej);
  lg_times(d, b->P + i * dd, ei, fi);
  lg_times(d, b->P + j * dd, ej, fj);
  for (int k = 0; k < d; k++) f[k] = p->slope * (fi[k] + fj[k]);
}

/* data: the matrix of the row counts where it is not NULL. */
static CHECK_UNUSED void lg_summed(const lg_body *b, const void *data, int64_t i, int64_t j,
                                   const lg_pair *p, double *f) {
  int d = b->s.dim, dd = d * d;
  double e[3], fi[3], fj[3];
  memcpy(e, p->X, sizeof e);
  if (data) lg_times(d, b->matrix + i * dd, p->X, e);
  lg_times(d, b->P + i * dd, e, fi);
  lg_times(d, b->P + j * dd, e, fj);
  for (int k = 0; k < d; k++) f[k] = p->slope * (fi[k] + fj[k]);
}

static CHECK_UNUSED double lg_modulus(const lg_body *b, int64_t i) {
  return b->a.rho[i] * b->a.c[i] * b->a.c[i];
}

/* e of particle k for the pair: F_k X_ij - x_ij. */
static CHECK_UNUSED void lg_deviation(const lg_body *b, int64_t k, const lg_pair *p, double *e) {
  int d = b->s.dim;
  lg_times(d, b->F + k * d * d, p->X, e);
  for (int c = 0; c < d; c++) e[c] -= p->x[c];
}

/* data: const double, alpha. */
static CHECK_UNUSED void lg_variational(const lg_body *b, const void *data, int64_t i, int64_t j,
                                        const lg_pair *p, double *f) {
  double alpha = *(const double *)data, ei[3], ej[3];
  lg_deviation(b, i, p, ei);
  lg_deviation(b, j, p, ej);
  for (int k = 0; k < b->s.dim; k++)
    f[k] = -0.5 * alpha * p->slope * (lg_modulus(b, i) * ei[k] + lg_modulus(b, j) * ej[k]);
}

static CHECK_UNUSED double lg_along(const lg_body *b, int64_t k, const lg_pair *p, double *unit) {
  double e[3], r = 0.0, along = 0.0;
  lg_deviation(b, k, p, e);
  for (int c = 0; c < b->s.dim; c++) r += p->x[c] * p->x[c];
  for (int c = 0; c < b->s.dim; c++) {
    unit[c] = p->x[c] / sqrt(r);
    along += e[c] * unit[c];
  }
  return along;
}

static CHECK_UNUSED void lg_central(const lg_body *b, const void *data, int64_t i, int64_t j,
                                    const lg_pair *p, double *f) {
  double alpha = *(const double *)data, unit[3];
  double e =
      lg_modulus(b, i) * lg_along(b, i, p, unit) + lg_modulus(b, j) * lg_along(b, j, p, unit);
  for (int k = 0; k < b->s.dim; k++) f[k] = 0.5 * alpha * p->W / (p->R * p->R) * e * unit[k];
}

/* data: alpha, beta. */
static CHECK_UNUSED void lg_viscosity(const lg_body *b, const void *data, int64_t i, int64_t j,
                                      const lg_pair *p, double *f) {
  const double *ab = data;
  int d = b->s.dim;
  double r2 = 0.0, vx = 0.0, h = 0.5 * (b->a.h[i] + b->a.h[j]);
  double rho = 0.5 * (b->a.rho[i] + b->a.rho[j]), c = 0.5 * (b->a.c[i] + b->a.c[j]);
  for (int k = 0; k < d; k++) {
    r2 += p->x[k] * p->x[k];
    vx += (b->a.v[i * d + k] - b->a.v[j * d + k]) * p->x[k];
  }
  double phi = h * vx / (r2 + 0.01 * h * h);
  double Pi = vx < 0.0 ? (-ab[0] * c * phi + ab[1] * phi * phi) / rho : 0.0;
  /* V_i times m_j Pi dW/dR x/r, per V_j */
  for (int k = 0; k < d; k++)
    f[k] = -b->a.rho[i] * b->a.rho[j] * Pi * (p->slope * p->R) * p->x[k] / sqrt(r2);
}

/* The springs of a particle, (alpha/4) V_i E_i sum V_j s_ij e^2. */
static CHECK_UNUSED double lg_spring_energy(const lg_body *b, int32_t form, double alpha,
                                            int64_t i) {
  double sum = 0.0, e[3];
  for (int64_t j = 0; j < b->s.n; j++) {
    if (j == i) continue;
    lg_pair p = lg_pair_of(b, i, j);
    if (form == SPH_HOURGLASS_CENTRAL) {
      double along = lg_along(b, i, &p, e);
      sum += p.vol * p.W / (p.R * p.R) * along * along;
    } else {
      lg_deviation(b, i, &p, e);
      for (int k = 0; k < b->s.dim; k++) sum -= p.vol * p.slope * e[k] * e[k];
    }
  }
  return 0.25 * alpha * b->a.m[i] / b->a.rho[i] * lg_modulus(b, i) * sum;
}

#endif
