/* What the operator tests share: random particles, a table of every operator in every form with its
 * reference, contexts of every kind. */
#ifndef SPH_TESTS_OPERATOR_CASES_H
#define SPH_TESTS_OPERATOR_CASES_H

#include "reference.h"

enum { OC_MAX = 5000, OC_WIDTH = 6, OC_POINTS = 24, OC_KERNELS = 13, OC_RULES = 5 };

/* What varies from particle to particle; OC_WRAP: periodic in x, OC_WRAP_ALL: in all axes. */
enum { OC_VARY_M = 1, OC_VARY_H = 2, OC_VARY_C = 4, OC_WRAP = 8, OC_WRAP_ALL = 16 };

typedef struct oc_particles {
  int32_t dim;
  int64_t n;
  uint32_t flavour;
  double edge; /* box length; the spacing is 1 */
  double x[3 * OC_MAX], v[3 * OC_MAX], m[OC_MAX], rho[OC_MAX], h[OC_MAX], p[OC_MAX], c[OC_MAX];
  double sigma[6 * OC_MAX], matrix[9 * OC_MAX], f[OC_WIDTH * OC_MAX];
  double points[3 * OC_POINTS];
} oc_particles;

/* splitmix64, the same numbers on every machine */
static CHECK_UNUSED uint64_t oc_seed;
static CHECK_UNUSED double oc_random(double lo, double hi) {
  uint64_t z = (oc_seed += UINT64_C(0x9e3779b97f4a7c15));
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return lo + (hi - lo) * ((double)((z ^ (z >> 31)) >> 11) * 0x1p-53);
}

static CHECK_UNUSED void oc_fill(double *a, int64_t n, double lo, double hi, int vary) {
  double same = oc_random(lo, hi);
  for (int64_t i = 0; i < n; i++) a[i] = vary ? oc_random(lo, hi) : same;
}

/* A jittered lattice of `side` particles an axis. The matrices are any, not even symmetric. */
static CHECK_UNUSED void oc_make(oc_particles *s, int32_t dim, int64_t side, double h,
                                 uint32_t flavour, uint64_t seed) {
  oc_seed = seed;
  s->dim = dim;
  s->flavour = flavour;
  s->edge = (double)side;
  s->n = dim == 1 ? side : dim == 2 ? side * side : side * side * side;
  assert_true(s->n <= OC_MAX);
  for (int64_t i = 0; i < s->n; i++)
    for (int64_t a = 0, k = i; a < dim; a++, k /= side)
      s->x[i * dim + a] = (double)(k % side) + 0.5 + oc_random(-0.3, 0.3);
  oc_fill(s->v, s->n * dim, -1.0, 1.0, 1);
  oc_fill(s->m, s->n, 0.8, 1.6, (flavour & OC_VARY_M) != 0);
  oc_fill(s->rho, s->n, 0.7, 1.9, 1);
  oc_fill(s->h, s->n, 0.85 * h, 1.15 * h, (flavour & OC_VARY_H) != 0);
  oc_fill(s->c, s->n, 1.0, 2.0, (flavour & OC_VARY_C) != 0);
  oc_fill(s->p, s->n, -1.0, 2.0, 1);
  oc_fill(s->sigma, s->n * dim * (dim + 1) / 2, -1.0, 1.0, 1);
  oc_fill(s->f, s->n * OC_WIDTH, -1.0, 1.0, 1);
  for (int64_t k = 0; k < s->n * dim * dim; k++)
    s->matrix[k] = oc_random(-0.4, 0.4) + (k % (dim * dim) % (dim + 1) == 0 ? 1.0 : 0.0);
  for (int64_t k = 0; k < OC_POINTS * dim; k++) s->points[k] = oc_random(-1.0, s->edge + 1.0);
  s->points[0] = 1e6;
}

static CHECK_UNUSED int oc_wraps(const oc_particles *s, int axis) {
  return axis < s->dim && ((s->flavour & OC_WRAP_ALL) || (axis == 0 && (s->flavour & OC_WRAP)));
}

static CHECK_UNUSED void oc_operands(const oc_particles *s, int corrected, sph_operands *a) {
  sph_operands_init(a);
  a->dim = s->dim;
  a->n = s->n;
  a->x = s->x;
  a->v = s->v;
  a->m = s->m;
  a->rho = s->rho;
  a->h = s->h;
  a->p = s->p;
  a->c = s->c;
  a->sigma = s->sigma;
  a->gradient_matrix = corrected ? s->matrix : NULL;
}

static CHECK_UNUSED ref_particles oc_reference(const oc_particles *s, const sph_kernel *kernel,
                                               int32_t rule, int corrected) {
  ref_particles r = {.dim = s->dim, .n = s->n, .x = s->x, .v = s->v, .m = s->m, .rho = s->rho};
  r.h = s->h;
  r.p = s->p;
  r.c = s->c;
  r.sigma = s->sigma;
  r.matrix = corrected ? s->matrix : NULL;
  r.h_rule = rule;
  r.kernel = kernel;
  for (int a = 0; a < s->dim; a++) r.period[a] = oc_wraps(s, a) ? s->edge : 0.0;
  return r;
}

/* A built list; the arrays h of operands and list are the same. */
static CHECK_UNUSED sph_neighbors *oc_list(sph_context *ctx, const oc_particles *s,
                                           const sph_kernel *kernel, int32_t rule) {
  sph_neighbors_options o;
  sph_neighbors *list = NULL;
  sph_neighbors_options_init(&o);
  o.h_rule = rule;
  o.support = sph_kernel_support(kernel);
  for (int a = 0; a < s->dim; a++) {
    o.periodic[a] = oc_wraps(s, a);
    o.box_hi[a] = s->edge;
  }
  check_ok(sph_neighbors_create(ctx, &o, &list));
  check_ok(sph_neighbors_build_arrays(list, s->dim, s->n, s->x, s->h, 0.0));
  return list;
}

static CHECK_UNUSED sph_kernel *oc_kernel(sph_context *ctx, int32_t type, int32_t dim) {
  sph_kernel *kernel = NULL;
  check_ok(sph_kernel_create(ctx, type, dim, &kernel));
  return kernel;
}

static CHECK_UNUSED sph_context *oc_context(int32_t isa, int32_t threads) {
  sph_context_options o;
  sph_context *ctx = NULL;
  sph_context_options_init(&o);
  o.isa = isa;
  o.threads = threads;
  check_ok(sph_context_create(&o, &ctx));
  return ctx;
}

/* --- the table --------------------------------------------------------------------------- */

typedef struct oc_call {
  sph_neighbors *list;
  const sph_kernel *kernel;
  const sph_operands *a;
  const double *f, *points;
  double *out;
} oc_call;

enum { OC_NEEDS_F = 1, OC_NEEDS_MATRIX = 2, OC_AT_POINTS = 4, OC_TWO_OUTPUTS = 8 };

typedef struct oc_case {
  const char *name;
  int32_t form, width;    /* of the operator; width: components of a field */
  int32_t one, dim, dim2; /* doubles a particle: one + dim * d + dim2 * d^2 */
  const char *needs;      /* letters of the arrays it reads: x h m r(ho) v p c s(igma) b (matrix) */
  uint32_t flags;
  sph_status (*run)(const oc_call *call, const struct oc_case *op);
  void (*ref)(const ref_system *s, const oc_particles *p, const struct oc_case *op, int64_t rows,
              const ref_out *out);
} oc_case;

#define OC_OPERATOR(name, call, formula)                                                        \
  static CHECK_UNUSED sph_status oc_run_##name(const oc_call *c, const oc_case *op) {           \
    (void)op;                                                                                   \
    return call;                                                                                \
  }                                                                                             \
  static CHECK_UNUSED void oc_ref_##name(const ref_system *s, const oc_particles *p,            \
                                         const oc_case *op, int64_t rows, const ref_out *out) { \
    (void)p;                                                                                    \
    (void)op;                                                                                   \
    (void)rows;                                                                                 \
    formula;                                                                                    \
  }

static CHECK_UNUSED sph_bulk_viscosity oc_bulk(int32_t form) {
  sph_bulk_viscosity k;
  sph_bulk_viscosity_init(&k);
  k.spacing = 0.9;
  if (form & 1) k.neumann = 1.7;
  if (form & 2) k.linear = 0.6;
  if (form & 4) k.hk_alpha = 0.8;
  if (form & 8) k.hk_beta = 1.3;
  return k;
}

static CHECK_UNUSED sph_status oc_call_bulk(const oc_call *c, int32_t form) {
  sph_bulk_viscosity k = oc_bulk(form);
  return sph_viscosity_bulk(c->list, c->kernel, c->a, &k, NULL, c->out);
}

/* The pressures go to the output under test, the forces aside. */
static CHECK_UNUSED sph_status oc_call_bulk_q(const oc_call *c, int32_t form) {
  static double aside[3 * OC_MAX];
  sph_bulk_viscosity k = oc_bulk(form);
  return sph_viscosity_bulk(c->list, c->kernel, c->a, &k, c->out, aside);
}

static CHECK_UNUSED sph_status oc_call_matrix(const oc_call *c) {
  static double inverse[9 * OC_MAX];
  return sph_gradient_matrix(c->list, c->kernel, c->a, inverse, c->out, NULL);
}

static CHECK_UNUSED void oc_formula_bulk(const ref_system *s, int32_t form, int64_t rows,
                                         int pressures, const ref_out *out) {
  sph_bulk_viscosity k = oc_bulk(form);
  if (pressures)
    ref_bulk_pressures(s, &k, rows, out);
  else
    ref_bulk(s, &k, rows, out);
}

OC_OPERATOR(density, sph_density_summation(c->list, c->kernel, c->a, c->out), ref_density(s, out))
OC_OPERATOR(shepard, sph_shepard_sum(c->list, c->kernel, c->a, c->out), ref_shepard(s, out))
OC_OPERATOR(continuity, sph_continuity(c->list, c->kernel, c->a, op->form, c->out),
            ref_continuity(s, op->form, out))
OC_OPERATOR(velocity_gradient, sph_velocity_gradient(c->list, c->kernel, c->a, c->out),
            ref_velocity_gradient(s, out))
OC_OPERATOR(gradient, sph_gradient(c->list, c->kernel, c->a, op->form, op->width, c->f, c->out),
            ref_gradient(s, op->form, op->width, p->f, out))
OC_OPERATOR(interpolate,
            sph_interpolate(c->list, c->kernel, c->a, op->form, op->width, c->f, c->out),
            ref_interpolate(s, op->form, op->width, p->f, out))
OC_OPERATOR(interpolate_at,
            sph_interpolate_at(c->list, c->kernel, c->a, op->form, OC_POINTS, c->points, op->width,
                               c->f, c->out),
            ref_interpolate_at(s, op->form, OC_POINTS, p->points, op->width, p->f, out))
OC_OPERATOR(matrix, oc_call_matrix(c), ref_matrix(s, out))
OC_OPERATOR(stress, sph_stress_divergence(c->list, c->kernel, c->a, op->form, c->out),
            ref_stress(s, op->form, out))
OC_OPERATOR(pressure, sph_pressure_gradient(c->list, c->kernel, c->a, op->form, c->out),
            ref_pressure(s, op->form, out))
OC_OPERATOR(monaghan, sph_viscosity_monaghan(c->list, c->kernel, c->a, 1.5, 2.5, c->out),
            ref_monaghan(s, 1.5, 2.5, out))
OC_OPERATOR(bulk, oc_call_bulk(c, op->form), oc_formula_bulk(s, op->form, rows, 0, out))
OC_OPERATOR(bulk_q, oc_call_bulk_q(c, op->form), oc_formula_bulk(s, op->form, rows, 1, out))
OC_OPERATOR(xsph, sph_xsph(c->list, c->kernel, c->a, 0.5, c->out), ref_xsph(s, 0.5, out))

#define OC_ROW(name, form, width, one, dim, dim2, needs, flags) \
  { #name, form, width, one, dim, dim2, needs, flags, oc_run_##name, oc_ref_##name }

static CHECK_UNUSED const oc_case oc_cases[] = {
    OC_ROW(density, 0, 0, 1, 0, 0, "xhm", 0),
    OC_ROW(shepard, 0, 0, 1, 0, 0, "xhmr", 0),
    OC_ROW(continuity, SPH_CONTINUITY_MASS, 0, 1, 0, 0, "xhmv", 0),
    OC_ROW(continuity, SPH_CONTINUITY_VOLUME, 0, 1, 0, 0, "xhmrv", 0),
    OC_ROW(continuity, SPH_CONTINUITY_NUMBER, 0, 1, 0, 0, "xhmv", 0),
    OC_ROW(velocity_gradient, 0, 0, 0, 0, 1, "xhmrv", 0),
    OC_ROW(gradient, SPH_GRADIENT_PLAIN, 1, 0, 1, 0, "xhmr", OC_NEEDS_F),
    OC_ROW(gradient, SPH_GRADIENT_DIFFERENCE, 1, 0, 1, 0, "xhmr", OC_NEEDS_F),
    OC_ROW(gradient, SPH_GRADIENT_SUM, 1, 0, 1, 0, "xhmr", OC_NEEDS_F),
    OC_ROW(gradient, SPH_GRADIENT_PLAIN, 3, 0, 3, 0, "xhmr", OC_NEEDS_F),
    OC_ROW(gradient, SPH_GRADIENT_DIFFERENCE, 6, 0, 6, 0, "xhmr", OC_NEEDS_F),
    OC_ROW(gradient, SPH_GRADIENT_SUM, 5, 0, 5, 0, "xhmr", OC_NEEDS_F),
    OC_ROW(interpolate, 0, 1, 1, 0, 0, "xhmr", OC_NEEDS_F),
    OC_ROW(interpolate, 1, 1, 1, 0, 0, "xhmr", OC_NEEDS_F),
    OC_ROW(interpolate, 0, 6, 6, 0, 0, "xhmr", OC_NEEDS_F),
    OC_ROW(interpolate, 1, 5, 5, 0, 0, "xhmr", OC_NEEDS_F),
    OC_ROW(interpolate_at, 0, 1, 1, 0, 0, "xhmr", OC_NEEDS_F | OC_AT_POINTS),
    OC_ROW(interpolate_at, 1, 5, 5, 0, 0, "xhmr", OC_NEEDS_F | OC_AT_POINTS),
    OC_ROW(matrix, 0, 0, 0, 0, 1, "xhmr", OC_TWO_OUTPUTS),
    OC_ROW(stress, SPH_STRESS_SUMMED, 0, 0, 1, 0, "xhmrs", 0),
    OC_ROW(stress, SPH_STRESS_DIFFERENCE, 0, 0, 1, 0, "xhmrs", 0),
    OC_ROW(stress, SPH_STRESS_CONSERVATIVE, 0, 0, 1, 0, "xhmrsb", OC_NEEDS_MATRIX),
    OC_ROW(pressure, SPH_PRESSURE_MASS, 0, 0, 1, 0, "xhmr", 0),
    OC_ROW(pressure, SPH_PRESSURE_VOLUME, 0, 0, 1, 0, "xhmr", 0),
    OC_ROW(pressure, SPH_PRESSURE_NUMBER, 0, 0, 1, 0, "xhmr", 0),
    OC_ROW(pressure, SPH_PRESSURE_DIFFERENCE, 0, 0, 1, 0, "xhmr", 0),
    OC_ROW(monaghan, 0, 0, 0, 1, 0, "xhmrvc", 0),
    OC_ROW(bulk, 3, 0, 0, 1, 0, "xhmrvc", OC_TWO_OUTPUTS),
    OC_ROW(bulk, 12, 0, 0, 1, 0, "xhmrvc", OC_TWO_OUTPUTS),
    OC_ROW(bulk, 9, 0, 0, 1, 0, "xhmrv", OC_TWO_OUTPUTS),
    OC_ROW(bulk_q, 15, 0, 1, 0, 0, "xhmrvc", OC_TWO_OUTPUTS),
    OC_ROW(xsph, 0, 0, 0, 1, 0, "xhmrv", 0),
};
enum { OC_CASES = (int)(sizeof oc_cases / sizeof *oc_cases) };

static CHECK_UNUSED int64_t oc_length(const oc_case *op, int32_t dim, int64_t n) {
  int64_t rows = op->flags & OC_AT_POINTS ? OC_POINTS : n;
  return rows * (op->one + op->dim * dim + op->dim2 * dim * dim);
}

static CHECK_UNUSED oc_call oc_call_of(sph_neighbors *list, const sph_kernel *kernel,
                                       const sph_operands *a, const oc_particles *s, double *out) {
  oc_call c = {list, kernel, a, s->f, s->points, out};
  return c;
}

#endif
