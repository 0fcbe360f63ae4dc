/* Plain references of the operators: brute force over all pairs, one contribution at a time, from
 * the formulas as published, with kernel values from the public point functions.
 *
 * Every result comes with a bound: the sum of the absolute values of everything that was added up.
 * Rounding errors are measured in units of it. */
#ifndef SPH_TESTS_REFERENCE_H
#define SPH_TESTS_REFERENCE_H

#include "check.h"

#include <stdlib.h>

#include <sph/sph.h>

/* Every array is given; matrix may be NULL. period[a] > 0: axis a wraps. */
typedef struct ref_particles {
  int32_t dim;
  int64_t n;
  const double *x, *v, *m, *rho, *h, *p, *c, *sigma, *matrix;
  double period[3];
  int32_t h_rule;
  const sph_kernel *kernel;
} ref_particles;

/* grad_i W_ij = g dx. */
typedef struct ref_pair {
  int64_t i, j;
  double dx[3], r2, h, w, g;
} ref_pair;

typedef struct ref_system {
  ref_particles a;
  ref_pair *pairs; /* both directions, those with W or dW/dr not 0 */
  int64_t count;
} ref_system;

typedef struct ref_out {
  double *value, *bound;
} ref_out;

static CHECK_UNUSED void ref_add(const ref_out *o, int64_t at, double value, double bound) {
  o->value[at] += value;
  o->bound[at] += bound;
}

/* Where component (a, b) of a packed symmetric tensor stands. */
static CHECK_UNUSED int ref_sym(int32_t dim, int a, int b) {
  static const int two[2][2] = {{0, 2}, {2, 1}};
  static const int three[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  return dim == 1 ? 0 : dim == 2 ? two[a][b] : three[a][b];
}

static CHECK_UNUSED double ref_pair_h(int32_t rule, double a, double b) {
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

static CHECK_UNUSED double ref_distance2(const ref_particles *a, const double *x, const double *y,
                                         double *dx) {
  double r2 = 0.0;
  for (int k = 0; k < a->dim; k++) {
    dx[k] = x[k] - y[k];
    if (a->period[k] > 0.0) dx[k] -= a->period[k] * nearbyint(dx[k] / a->period[k]);
    r2 += dx[k] * dx[k];
  }
  return r2;
}

static CHECK_UNUSED ref_pair ref_make_pair(const ref_particles *a, int64_t i, int64_t j) {
  ref_pair q = {.i = i, .j = j};
  q.r2 = ref_distance2(a, a->x + i * a->dim, a->x + j * a->dim, q.dx);
  double r = sqrt(q.r2), hi = a->h[i], hj = a->h[j], dwdr;
  q.h = ref_pair_h(a->h_rule, hi, hj);
  if (a->h_rule == SPH_H_AVERAGE) {
    q.w = 0.5 * (sph_kernel_w(a->kernel, r, hi) + sph_kernel_w(a->kernel, r, hj));
    dwdr = 0.5 * (sph_kernel_dwdr(a->kernel, r, hi) + sph_kernel_dwdr(a->kernel, r, hj));
  } else {
    q.w = sph_kernel_w(a->kernel, r, q.h);
    dwdr = sph_kernel_dwdr(a->kernel, r, q.h);
  }
  q.g = r > 0.0 ? dwdr / r : 0.0;
  return q;
}

/* Give the result to ref_free(). */
static CHECK_UNUSED ref_system ref_build(const ref_particles *a) {
  ref_system s = {.a = *a};
  int64_t room = 0;
  for (int64_t i = 0; i < a->n; i++)
    for (int64_t j = 0; j < a->n; j++) {
      ref_pair q = ref_make_pair(a, i, j);
      if (i == j || (q.w == 0.0 && q.g == 0.0)) continue;
      if (s.count == room) {
        room = 2 * room + 1024;
        s.pairs = (ref_pair *)realloc(s.pairs, (size_t)room * sizeof *s.pairs);
        assert_non_null(s.pairs);
      }
      s.pairs[s.count++] = q;
    }
  return s;
}

static CHECK_UNUSED void ref_free(ref_system *s) {
  free(s->pairs);
  s->pairs = NULL;
  s->count = 0;
}

static CHECK_UNUSED double ref_volume(const ref_system *s, int64_t i) {
  return s->a.m[i] / s->a.rho[i];
}

static CHECK_UNUSED double ref_w0(const ref_system *s, int64_t i) {
  return sph_kernel_w(s->a.kernel, 0.0, s->a.h[i]);
}

/* The gradient of the pair, corrected by the matrix of i where there is one, and its bound. */
static CHECK_UNUSED void ref_gradient_of(const ref_system *s, const ref_pair *q, double *e,
                                         double *bound) {
  int d = s->a.dim;
  for (int a = 0; a < d; a++) {
    e[a] = q->g * q->dx[a];
    bound[a] = fabs(e[a]);
    if (!s->a.matrix) continue;
    e[a] = bound[a] = 0.0;
    for (int b = 0; b < d; b++) {
      double t = s->a.matrix[q->i * d * d + a * d + b] * q->g * q->dx[b];
      e[a] += t;
      bound[a] += fabs(t);
    }
  }
}

#define REF_EACH_PAIR(s, q) \
  for (const ref_pair *q = (s)->pairs, *q##_end = q + (s)->count; q != q##_end; q++)

static CHECK_UNUSED void ref_density(const ref_system *s, const ref_out *o) {
  for (int64_t i = 0; i < s->a.n; i++) ref_add(o, i, s->a.m[i] * ref_w0(s, i), 0.0);
  for (int64_t i = 0; i < s->a.n; i++) o->bound[i] = fabs(o->value[i]);
  REF_EACH_PAIR(s, q) ref_add(o, q->i, s->a.m[q->j] * q->w, fabs(s->a.m[q->j] * q->w));
}

static CHECK_UNUSED void ref_shepard(const ref_system *s, const ref_out *o) {
  for (int64_t i = 0; i < s->a.n; i++) {
    double t = ref_volume(s, i) * ref_w0(s, i);
    ref_add(o, i, t, fabs(t));
  }
  REF_EACH_PAIR(s, q) {
    double t = ref_volume(s, q->j) * q->w;
    ref_add(o, q->i, t, fabs(t));
  }
}

static CHECK_UNUSED void ref_continuity(const ref_system *s, int32_t form, const ref_out *o) {
  int d = s->a.dim;
  REF_EACH_PAIR(s, q) {
    double e[3], b[3], factor = s->a.m[q->i];
    if (form == SPH_CONTINUITY_MASS) factor = s->a.m[q->j];
    if (form == SPH_CONTINUITY_VOLUME) factor = s->a.rho[q->i] * ref_volume(s, q->j);
    ref_gradient_of(s, q, e, b);
    for (int a = 0; a < d; a++) {
      double dv = s->a.v[q->i * d + a] - s->a.v[q->j * d + a];
      ref_add(o, q->i, factor * dv * e[a], factor * fabs(dv) * b[a]);
    }
  }
}

/* d f_k / d x_b of a field of `width` components. */
static CHECK_UNUSED void ref_gradient(const ref_system *s, int32_t variant, int32_t width,
                                      const double *f, const ref_out *o) {
  int d = s->a.dim;
  REF_EACH_PAIR(s, q) {
    double e[3], b[3], vol = ref_volume(s, q->j);
    ref_gradient_of(s, q, e, b);
    for (int k = 0; k < width; k++) {
      double fi = f[q->i * width + k], fj = f[q->j * width + k], t = fj;
      if (variant == SPH_GRADIENT_DIFFERENCE) t = fj - fi;
      if (variant == SPH_GRADIENT_SUM) t = fj + fi;
      for (int a = 0; a < d; a++)
        ref_add(o, (q->i * width + k) * d + a, vol * t * e[a], vol * (fabs(fi) + fabs(fj)) * b[a]);
    }
  }
}

static CHECK_UNUSED void ref_velocity_gradient(const ref_system *s, const ref_out *o) {
  ref_gradient(s, SPH_GRADIENT_DIFFERENCE, s->a.dim, s->a.v, o);
}

static CHECK_UNUSED void ref_interpolate(const ref_system *s, int32_t shepard, int32_t width,
                                         const double *f, const ref_out *o) {
  for (int64_t i = 0; i < s->a.n; i++)
    for (int k = 0; k < width; k++) {
      double t = ref_volume(s, i) * f[i * width + k] * ref_w0(s, i);
      ref_add(o, i * width + k, t, fabs(t));
    }
  REF_EACH_PAIR(s, q)
  for (int k = 0; k < width; k++) {
    double t = ref_volume(s, q->j) * f[q->j * width + k] * q->w;
    ref_add(o, q->i * width + k, t, fabs(t));
  }
  if (!shepard) return;
  double *sum = (double *)calloc((size_t)s->a.n * 2, sizeof *sum);
  assert_non_null(sum);
  ref_out so = {sum, sum + s->a.n};
  ref_shepard(s, &so);
  for (int64_t k = 0; k < s->a.n * width; k++) {
    o->value[k] /= sum[k / width];
    o->bound[k] /= fabs(sum[k / width]);
  }
  free(sum);
}

/* At arbitrary points, with the h of the contributing particle. */
static CHECK_UNUSED void ref_interpolate_at(const ref_system *s, int32_t shepard, int64_t np,
                                            const double *points, int32_t width, const double *f,
                                            const ref_out *o) {
  for (int64_t p = 0; p < np; p++) {
    double sum = 0.0, dx[3];
    for (int64_t j = 0; j < s->a.n; j++) {
      double r2 = ref_distance2(&s->a, points + p * s->a.dim, s->a.x + j * s->a.dim, dx);
      double w = ref_volume(s, j) * sph_kernel_w(s->a.kernel, sqrt(r2), s->a.h[j]);
      sum += w;
      for (int k = 0; k < width; k++)
        ref_add(o, p * width + k, w * f[j * width + k], fabs(w * f[j * width + k]));
    }
    for (int k = 0; shepard && sum != 0.0 && k < width; k++) {
      o->value[p * width + k] /= sum;
      o->bound[p * width + k] /= fabs(sum);
    }
  }
}

/* B_i = sum V_j grad W (x) (x_j - x_i), never corrected. */
static CHECK_UNUSED void ref_matrix(const ref_system *s, const ref_out *o) {
  int d = s->a.dim;
  REF_EACH_PAIR(s, q)
  for (int a = 0; a < d; a++)
    for (int b = 0; b < d; b++) {
      double t = -ref_volume(s, q->j) * q->g * q->dx[a] * q->dx[b];
      ref_add(o, q->i * d * d + a * d + b, t, fabs(t));
    }
}

/* sum_b T_ab y_b of the full tensor that a packed one stands for. */
static CHECK_UNUSED double ref_sym_times(int32_t dim, const double *t, int a, const double *y) {
  double s = 0.0;
  for (int b = 0; b < dim; b++) s += t[ref_sym(dim, a, b)] * y[b];
  return s;
}

static CHECK_UNUSED void ref_stress_conservative(const ref_system *s, const ref_pair *q,
                                                 const ref_out *o) {
  int d = s->a.dim, n = d * (d + 1) / 2;
  const int64_t both[2] = {q->i, q->j};
  for (int side = 0; side < 2; side++) {
    int64_t k = both[side];
    double y[3], rho = s->a.rho[k];
    for (int a = 0; a < d; a++) {
      y[a] = 0.0;
      for (int b = 0; b < d; b++) y[a] += s->a.matrix[k * d * d + a * d + b] * q->g * q->dx[b];
    }
    for (int a = 0; a < d; a++)
      for (int b = 0; b < d; b++) {
        double t = s->a.m[q->j] * s->a.sigma[k * n + ref_sym(d, a, b)] / (rho * rho) * y[b];
        ref_add(o, q->i * d + a, t, 4.0 * fabs(t));
      }
  }
}

static CHECK_UNUSED void ref_stress(const ref_system *s, int32_t form, const ref_out *o) {
  int d = s->a.dim, n = d * (d + 1) / 2;
  REF_EACH_PAIR(s, q) {
    const double *si = s->a.sigma + q->i * n, *sj = s->a.sigma + q->j * n;
    double ri = s->a.rho[q->i], rj = s->a.rho[q->j], mj = s->a.m[q->j], e[3], b[3];
    if (form == SPH_STRESS_CONSERVATIVE) {
      ref_stress_conservative(s, q, o);
      continue;
    }
    ref_gradient_of(s, q, e, b);
    for (int a = 0; a < d; a++) {
      double t =
          mj * (ref_sym_times(d, si, a, e) / (ri * ri) + ref_sym_times(d, sj, a, e) / (rj * rj));
      if (form == SPH_STRESS_DIFFERENCE)
        t = mj * (ref_sym_times(d, sj, a, e) - ref_sym_times(d, si, a, e)) / (ri * rj);
      double size = 0.0;
      for (int k = 0; k < d; k++)
        size += (fabs(si[ref_sym(d, a, k)]) + fabs(sj[ref_sym(d, a, k)])) * b[k];
      ref_add(o, q->i * d + a, t, mj * size / (ri * rj));
    }
  }
}

static CHECK_UNUSED void ref_pressure(const ref_system *s, int32_t form, const ref_out *o) {
  int d = s->a.dim;
  REF_EACH_PAIR(s, q) {
    double ri = s->a.rho[q->i], rj = s->a.rho[q->j], mi = s->a.m[q->i], mj = s->a.m[q->j];
    double ti = s->a.p[q->i], tj = s->a.p[q->j], e[3], b[3];
    switch (form) {
    case SPH_PRESSURE_MASS:
      ti *= mj / (ri * ri);
      tj *= mj / (rj * rj);
      break;
    case SPH_PRESSURE_NUMBER:
      ti *= (mi / ri) * (mi / ri) / mi;
      tj *= (mj / rj) * (mj / rj) / mi;
      break;
    default:
      ti *= mj / (ri * rj) * (form == SPH_PRESSURE_DIFFERENCE ? -1.0 : 1.0);
      tj *= mj / (ri * rj);
    }
    ref_gradient_of(s, q, e, b);
    for (int a = 0; a < d; a++)
      ref_add(o, q->i * d + a, -(ti + tj) * e[a], (fabs(ti) + fabs(tj)) * b[a]);
  }
}

static CHECK_UNUSED void ref_monaghan(const ref_system *s, double alpha, double beta,
                                      const ref_out *o) {
  int d = s->a.dim;
  REF_EACH_PAIR(s, q) {
    double vx = 0.0, size = 0.0, e[3], b[3];
    for (int a = 0; a < d; a++) {
      double dv = s->a.v[q->i * d + a] - s->a.v[q->j * d + a];
      vx += dv * q->dx[a];
      size += fabs(dv * q->dx[a]);
    }
    double c = 0.5 * (s->a.c[q->i] + s->a.c[q->j]);
    double rho = 0.5 * (s->a.rho[q->i] + s->a.rho[q->j]);
    double k = q->h / (q->r2 + 0.01 * q->h * q->h), phi = k * vx;
    double pi = vx < 0.0 ? (-alpha * c * phi + beta * phi * phi) / rho : 0.0;
    double bound = (alpha * c + beta * k * size) * k * size / rho;
    ref_gradient_of(s, q, e, b);
    for (int a = 0; a < d; a++)
      ref_add(o, q->i * d + a, -s->a.m[q->j] * pi * e[a], s->a.m[q->j] * bound * b[a]);
  }
}

/* Viscous pressure of one particle from div v < 0. */
static CHECK_UNUSED double ref_bulk_pressure(const sph_bulk_viscosity *k, double div, double h,
                                             double rho, double c) {
  double q = 0.0;
  if (!(div < 0.0)) return 0.0;
  q += k->neumann * k->spacing * k->spacing * rho * div * div;
  q += -k->linear * k->spacing * c * rho * div;
  q += k->hk_alpha * h * rho * c * fabs(div) + k->hk_beta * h * h * rho * div * div;
  return q;
}

/* q of the particles < rows; those from there on have none. */
static CHECK_UNUSED void ref_bulk_pressures(const ref_system *s, const sph_bulk_viscosity *k,
                                            int64_t rows, const ref_out *o) {
  int d = s->a.dim;
  double *L = (double *)calloc((size_t)(2 * s->a.n * d * d), sizeof *L);
  assert_non_null(L);
  ref_out g = {L, L + s->a.n * d * d};
  ref_velocity_gradient(s, &g);
  for (int64_t i = 0; i < rows; i++) {
    double div = 0.0, bound = 0.0;
    for (int a = 0; a < d; a++) {
      div += g.value[i * d * d + a * d + a];
      bound += g.bound[i * d * d + a * d + a];
    }
    o->value[i] = ref_bulk_pressure(k, div, s->a.h[i], s->a.rho[i], s->a.c[i]);
    o->bound[i] = ref_bulk_pressure(k, -bound, s->a.h[i], s->a.rho[i], s->a.c[i]);
  }
  free(L);
}

static CHECK_UNUSED void ref_bulk(const ref_system *s, const sph_bulk_viscosity *k, int64_t rows,
                                  const ref_out *o) {
  int d = s->a.dim;
  double *q0 = (double *)calloc((size_t)(2 * s->a.n), sizeof *q0);
  assert_non_null(q0);
  ref_out qo = {q0, q0 + s->a.n};
  ref_bulk_pressures(s, k, rows, &qo);
  REF_EACH_PAIR(s, q) {
    double ri = s->a.rho[q->i], rj = s->a.rho[q->j], mj = s->a.m[q->j], e[3], b[3];
    double t = qo.value[q->i] / (ri * ri) + qo.value[q->j] / (rj * rj);
    double bound = qo.bound[q->i] / (ri * ri) + qo.bound[q->j] / (rj * rj);
    ref_gradient_of(s, q, e, b);
    for (int a = 0; a < d; a++) ref_add(o, q->i * d + a, -mj * t * e[a], mj * bound * b[a]);
  }
  free(q0);
}

static CHECK_UNUSED void ref_xsph(const ref_system *s, double epsilon, const ref_out *o) {
  int d = s->a.dim;
  REF_EACH_PAIR(s, q) {
    double rho = 0.5 * (s->a.rho[q->i] + s->a.rho[q->j]);
    double k = epsilon * s->a.m[q->j] / rho * q->w;
    for (int a = 0; a < d; a++) {
      double dv = s->a.v[q->j * d + a] - s->a.v[q->i * d + a];
      ref_add(o, q->i * d + a, k * dv, fabs(k * dv));
    }
  }
}

#endif
