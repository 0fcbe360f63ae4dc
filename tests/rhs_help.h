/* What the tests of the composed right-hand side share: particle systems, and every term as its
 * operator computes it alone. */
#ifndef SPH_TESTS_RHS_HELP_H
#define SPH_TESTS_RHS_HELP_H

#include "check.h"

#include <stdlib.h>

#include <sph/sph.h>

enum { RH_VARY_M = 1, RH_VARY_H = 2, RH_VARY_C = 4, RH_GHOSTS = 8, RH_WRAP = 16 };
enum { RH_VARY_ALL = RH_VARY_M | RH_VARY_H | RH_VARY_C };

typedef struct rh_system {
  sph_context *ctx; /* the caller's */
  sph_kernel *kernel;
  sph_particles *set;
  sph_neighbors *list;
  int32_t dim;
  int64_t n, rows; /* all, and the real ones */
} rh_system;

/* splitmix64, the same numbers on every machine */
static CHECK_UNUSED uint64_t rh_seed;
static CHECK_UNUSED uint64_t rh_bits(void) {
  uint64_t z = (rh_seed += UINT64_C(0x9e3779b97f4a7c15));
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return z ^ (z >> 31);
}
static CHECK_UNUSED double rh_random(double lo, double hi) {
  return lo + (hi - lo) * ((double)(rh_bits() >> 11) * 0x1p-53);
}
static CHECK_UNUSED int32_t rh_choice(int32_t count) {
  return (int32_t)(rh_bits() % (uint64_t)count);
}

static CHECK_UNUSED double *rh_field(const rh_system *s, int32_t field) {
  double *a = NULL;
  check_ok(sph_particles_field(s->set, field, &a));
  return a;
}

static CHECK_UNUSED void rh_fill(const rh_system *s, int32_t field, double lo, double hi,
                                 int vary) {
  double *a = rh_field(s, field), same = rh_random(lo, hi);
  int64_t n = s->n * sph_particles_components(s->set, field);
  for (int64_t k = 0; k < n; k++) a[k] = vary ? rh_random(lo, hi) : same;
  check_ok(sph_particles_touch(s->set, field));
}

static CHECK_UNUSED void rh_place(const rh_system *s, int64_t side) {
  double *x = rh_field(s, SPH_FIELD_X);
  for (int64_t i = 0; i < s->n; i++)
    for (int64_t a = 0, k = i; a < s->dim; a++, k /= side)
      x[i * s->dim + a] = (double)(k % side) + 0.5 + rh_random(-0.3, 0.3);
  check_ok(sph_particles_touch(s->set, SPH_FIELD_X));
}

static CHECK_UNUSED void rh_make_list(rh_system *s, double edge, uint32_t flavour) {
  sph_neighbors_options o;
  sph_neighbors_options_init(&o);
  o.support = sph_kernel_support(s->kernel);
  for (int a = 0; a < s->dim; a++) {
    o.periodic[a] = (flavour & RH_WRAP) != 0;
    o.box_hi[a] = edge;
  }
  check_ok(sph_neighbors_create(s->ctx, &o, &s->list));
}

/* A jittered lattice of spacing 1 with `side` particles an axis, every field filled but E. With
 * ghosts the last sixth of the particles are. */
static CHECK_UNUSED rh_system rh_make(sph_context *ctx, int32_t dim, int64_t side, uint32_t flavour,
                                      uint64_t seed) {
  rh_system s = {.ctx = ctx, .dim = dim};
  sph_particles_options o;
  rh_seed = seed;
  s.n = dim == 1 ? side : dim == 2 ? side * side : side * side * side;
  s.rows = flavour & RH_GHOSTS ? s.n - s.n / 6 : s.n;
  sph_particles_options_init(&o);
  o.dim = dim;
  check_ok(sph_particles_create(ctx, &o, &s.set));
  check_ok(sph_particles_add(s.set, s.rows, NULL));
  if (s.rows < s.n) check_ok(sph_particles_add_ghosts(s.set, s.n - s.rows, NULL));
  check_ok(sph_kernel_create(ctx, SPH_KERNEL_CUBIC_SPLINE, dim, &s.kernel));
  rh_make_list(&s, (double)side, flavour);
  rh_place(&s, side);
  rh_fill(&s, SPH_FIELD_V, -1.0, 1.0, 1);
  rh_fill(&s, SPH_FIELD_M, 0.8, 1.6, (flavour & RH_VARY_M) != 0);
  rh_fill(&s, SPH_FIELD_RHO, 0.7, 1.9, 1);
  rh_fill(&s, SPH_FIELD_H, 1.1, 1.5, (flavour & RH_VARY_H) != 0);
  rh_fill(&s, SPH_FIELD_P, -1.0, 2.0, 1);
  rh_fill(&s, SPH_FIELD_C, 1.0, 2.0, (flavour & RH_VARY_C) != 0);
  rh_fill(&s, SPH_FIELD_SIGMA, -1.0, 1.0, 1);
  check_ok(sph_neighbors_build(s.list, s.set));
  return s;
}

static CHECK_UNUSED void rh_free(rh_system *s) {
  sph_neighbors_destroy(s->list);
  sph_kernel_destroy(s->kernel);
  sph_particles_destroy(s->set);
  memset(s, 0, sizeof *s);
}

/* The sides that keep a test quick and still fill several vectors of neighbours. */
static CHECK_UNUSED int64_t rh_side(int32_t dim) { return dim == 1 ? 60 : dim == 2 ? 12 : 6; }

static CHECK_UNUSED sph_context *rh_context(int32_t threads) {
  sph_context_options o;
  sph_context *ctx = NULL;
  sph_context_options_init(&o);
  o.threads = threads;
  check_ok(sph_context_create(&o, &ctx));
  return ctx;
}

static CHECK_UNUSED sph_rhs *rh_rhs(const rh_system *s) {
  sph_rhs *rhs = NULL;
  check_ok(sph_rhs_create(s->ctx, s->kernel, NULL, &rhs));
  return rhs;
}

/* --- terms ------------------------------------------------------------------------------- */

/* A term with coefficients that are all different and not 0. */
static CHECK_UNUSED sph_term rh_term(int32_t kind, int32_t form, int32_t corrected) {
  sph_term t;
  sph_term_init(&t);
  t.kind = kind;
  t.form = form;
  t.corrected = corrected;
  t.alpha = 1.3;
  t.beta = 0.7;
  t.epsilon = 0.4;
  t.neumann = 1.7;
  t.linear = 0.6;
  t.spacing = 0.9;
  t.vector[0] = 0.3;
  t.vector[1] = -9.81;
  t.vector[2] = 2.5;
  t.spacing_ratio = 0.8;
  return t;
}

static CHECK_UNUSED int32_t rh_forms(int32_t kind) {
  switch (kind) {
  case SPH_TERM_CONTINUITY:
  case SPH_TERM_STRESS:
    return 3;
  case SPH_TERM_PRESSURE:
    return 4;
  default:
    return 0;
  }
}

static CHECK_UNUSED int32_t rh_correctable(int32_t kind, int32_t form) {
  switch (kind) {
  case SPH_TERM_XSPH:
  case SPH_TERM_BODY_FORCE:
  case SPH_TERM_MOTION:
    return 0;
  default:
    return kind != SPH_TERM_STRESS || form != SPH_STRESS_CONSERVATIVE;
  }
}

static CHECK_UNUSED int32_t rh_target(int32_t kind) {
  switch (kind) {
  case SPH_TERM_CONTINUITY:
    return SPH_FIELD_RHO;
  case SPH_TERM_STRESS_RATE:
    return SPH_FIELD_SIGMA;
  case SPH_TERM_XSPH:
  case SPH_TERM_MOTION:
    return SPH_FIELD_X;
  default:
    return SPH_FIELD_V;
  }
}

static CHECK_UNUSED double *rh_array(int64_t n) {
  double *a = (double *)malloc((size_t)(n > 0 ? n : 1) * sizeof *a);
  assert_non_null(a);
  for (int64_t k = 0; k < n; k++) a[k] = NAN; /* what must be overwritten */
  return a;
}

static CHECK_UNUSED double rh_largest(const double *a, int64_t n) {
  double most = 0.0;
  for (int64_t k = 0; k < n; k++) {
    if (!isfinite(a[k])) return NAN;
    if (fabs(a[k]) > most) most = fabs(a[k]);
  }
  return most;
}

/* Rates of one field. */
static CHECK_UNUSED double *rh_rates(const rh_system *s, sph_rhs *rhs, int32_t field) {
  double *a = rh_array(s->rows * sph_particles_components(s->set, field));
  sph_rate rate = {field, a};
  sph_status status = sph_rhs_evaluate(rhs, s->set, s->list, 0.0, &rate, 1);
  if (status != SPH_OK) print_error("%s\n", sph_context_last_error(s->ctx));
  check_ok(status);
  return a;
}

/* --- the same from the operators --------------------------------------------------------- */

static CHECK_UNUSED sph_operands rh_operands(const rh_system *s, double *matrix) {
  sph_operands a;
  sph_operands_init(&a);
  check_ok(sph_operands_from_set(s->set, &a));
  if (!matrix) return a;
  a.rows = a.n;
  check_ok(sph_gradient_matrix(s->list, s->kernel, &a, matrix, NULL, NULL));
  a.rows = s->rows;
  a.gradient_matrix = matrix;
  return a;
}

static CHECK_UNUSED int rh_sym(int dim, int a, int b) {
  static const int two[2][2] = {{0, 2}, {2, 1}};
  static const int three[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  return dim == 1 ? 0 : dim == 2 ? two[a][b] : three[a][b];
}

/* One pair of the artificial stress from its formula: m_j (W / W(dp))^n (R_i + R_j).g~_ij. */
static CHECK_UNUSED void rh_art_pair(const rh_system *s, const sph_operands *a, const sph_term *t,
                                     const double *R, int64_t i, int64_t j, double *out) {
  int d = s->dim, n = d * (d + 1) / 2;
  double dx[3], g[3], r = 0.0, h = 0.5 * (a->h[i] + a->h[j]);
  for (int k = 0; k < d; k++) {
    dx[k] = a->x[i * d + k] - a->x[j * d + k];
    r += dx[k] * dx[k];
  }
  r = sqrt(r);
  double slope = sph_kernel_dwdr(s->kernel, r, h);
  double w = sph_kernel_w(s->kernel, r, h) / sph_kernel_w(s->kernel, t->spacing_ratio * h, h);
  for (int k = 0; k < d; k++) {
    g[k] = slope / r * dx[k];
    if (!a->gradient_matrix) continue;
    g[k] = 0.0;
    for (int l = 0; l < d; l++) g[k] += a->gradient_matrix[(i * d + k) * d + l] * slope / r * dx[l];
  }
  for (int k = 0; k < d; k++)
    for (int l = 0; l < d; l++) {
      int c = rh_sym(d, k, l);
      out[k] += a->m[j] * pow(w, t->power) * (R[i * n + c] + R[j * n + c]) * g[l];
    }
}

static CHECK_UNUSED void rh_artificial(const rh_system *s, const sph_operands *a, const sph_term *t,
                                       double *out) {
  double *R = rh_array(s->n * 6);
  check_ok(sph_artificial_stress(s->dim, s->n, a->sigma, a->rho, 0.0, t->epsilon, R));
  for (int64_t i = 0; i < s->rows; i++) {
    for (int k = 0; k < s->dim; k++) out[i * s->dim + k] = 0.0;
    for (int64_t j = 0; j < s->n; j++)
      if (j != i) rh_art_pair(s, a, t, R, i, j, out + i * s->dim);
  }
  free(R);
}

static CHECK_UNUSED void rh_bulk(const rh_system *s, const sph_operands *a, const sph_term *t,
                                 double *out) {
  sph_bulk_viscosity o;
  sph_bulk_viscosity_init(&o);
  o.neumann = t->neumann;
  o.linear = t->linear;
  o.spacing = t->spacing;
  o.hk_alpha = t->alpha;
  o.hk_beta = t->beta;
  check_ok(sph_viscosity_bulk(s->list, s->kernel, a, &o, NULL, out));
}

static CHECK_UNUSED void rh_constant(const rh_system *s, const sph_term *t, const double *v,
                                     double *out) {
  for (int64_t i = 0; i < s->rows; i++)
    for (int k = 0; k < s->dim; k++)
      out[i * s->dim + k] = t->kind == SPH_TERM_MOTION ? v[i * s->dim + k] : t->vector[k];
}

/* What a term alone must give, from the operators; the stress rate is left to its own tests. */
static CHECK_UNUSED void rh_operator(const rh_system *s, const sph_term *t, double *out) {
  double *matrix = rh_array(s->n * 9);
  int need = t->corrected || (t->kind == SPH_TERM_STRESS && t->form == SPH_STRESS_CONSERVATIVE);
  int32_t form = t->form ? t->form : 1;
  sph_operands a = rh_operands(s, need ? matrix : NULL);
  switch (t->kind) {
  case SPH_TERM_CONTINUITY:
    check_ok(sph_continuity(s->list, s->kernel, &a, form, out));
    break;
  case SPH_TERM_PRESSURE:
    check_ok(sph_pressure_gradient(s->list, s->kernel, &a, form, out));
    break;
  case SPH_TERM_STRESS:
    check_ok(sph_stress_divergence(s->list, s->kernel, &a, form, out));
    break;
  case SPH_TERM_MONAGHAN:
    check_ok(sph_viscosity_monaghan(s->list, s->kernel, &a, t->alpha, t->beta, out));
    break;
  case SPH_TERM_BULK_VISCOSITY:
    rh_bulk(s, &a, t, out);
    break;
  case SPH_TERM_XSPH:
    check_ok(sph_xsph(s->list, s->kernel, &a, t->epsilon, out));
    break;
  case SPH_TERM_ARTIFICIAL_STRESS:
    rh_artificial(s, &a, t, out);
    break;
  default:
    rh_constant(s, t, a.v, out);
  }
  free(matrix);
}

#endif
