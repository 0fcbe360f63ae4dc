/* Plain references of smoothing.h: brute force over all pairs, each of the three schemes as it is
 * printed (with its errata corrected), one contribution at a time, kernel values from the public
 * point functions. Every result comes with a bound, the sum of the absolute values of what was
 * added up; rounding is measured in units of it. */
#ifndef SPH_TESTS_SMOOTHED_HELP_H
#define SPH_TESTS_SMOOTHED_HELP_H

#include "operator_cases.h"

/* Random particles of operator_cases.h with an energy and an omega, and h that differ threefold. */
typedef struct sm_particles {
  oc_particles s;
  double e[OC_MAX], omega[OC_MAX];
  const sph_kernel *kernel;
} sm_particles;

enum { SM_RHO, SM_V, SM_E, SM_L, SM_OUTPUTS };

/* Rates: rho (n), v (n * dim), e (n), velocity gradient (n * dim * dim). */
typedef struct sm_out {
  double value[SM_OUTPUTS][9 * OC_MAX], bound[SM_OUTPUTS][9 * OC_MAX];
} sm_out;

static CHECK_UNUSED const int64_t sm_side[4] = {0, 45, 9, 5};

static CHECK_UNUSED void sm_make(sm_particles *p, int32_t dim, uint32_t flavour, double support,
                                 uint64_t seed) {
  const double reach = dim == 3 ? 1.7 : 2.4; /* of the largest h */
  oc_make(&p->s, dim, sm_side[dim], 1.0, flavour, seed);
  oc_fill(p->s.h, p->s.n, reach / support / 3.0, reach / support, (flavour & OC_VARY_H) != 0);
  oc_fill(p->e, p->s.n, 0.3, 2.0, 1);
  oc_fill(p->omega, p->s.n, 0.6, 1.3, 1);
}

static CHECK_UNUSED void sm_operands(const sm_particles *p, sph_operands *a) {
  oc_operands(&p->s, 0, a);
  a->e = p->e;
  a->omega = p->omega;
}

/* One ordered pair. */
typedef struct sm_pair {
  int64_t i, j;
  double dx[3], r, unit[3]; /* x_ij, its length and direction, 0 for coincident particles */
  double wi, gi, gj;        /* W(h_i), dW/dr at h_i and h_j */
  double dv[3], u;          /* v_ij and v_ij.r_ij */
} sm_pair;

static CHECK_UNUSED sm_pair sm_make_pair(const sm_particles *p, int64_t i, int64_t j) {
  const oc_particles *s = &p->s;
  sm_pair q = {.i = i, .j = j};
  double r2 = 0.0;
  for (int a = 0; a < s->dim; a++) {
    q.dx[a] = s->x[i * s->dim + a] - s->x[j * s->dim + a];
    if (oc_wraps(s, a)) q.dx[a] -= s->edge * nearbyint(q.dx[a] / s->edge);
    r2 += q.dx[a] * q.dx[a];
  }
  q.r = sqrt(r2);
  for (int a = 0; a < s->dim; a++) {
    q.unit[a] = q.r > 0.0 ? q.dx[a] / q.r : 0.0;
    q.dv[a] = s->v[i * s->dim + a] - s->v[j * s->dim + a];
    q.u += q.dv[a] * q.unit[a];
  }
  q.wi = sph_kernel_w(p->kernel, q.r, s->h[i]);
  q.gi = sph_kernel_dwdr(p->kernel, q.r, s->h[i]);
  q.gj = sph_kernel_dwdr(p->kernel, q.r, s->h[j]);
  return q;
}

static CHECK_UNUSED void sm_add(sm_out *o, int what, int64_t at, double value) {
  o->value[what][at] += value;
  o->bound[what][at] += fabs(value);
}

typedef void (*sm_visit)(const sm_particles *p, const sm_pair *q, const void *options, sm_out *o);

static CHECK_UNUSED void sm_each_pair(const sm_particles *p, sm_visit visit, const void *options,
                                      sm_out *o) {
  for (int64_t i = 0; i < p->s.n; i++)
    for (int64_t j = 0; j < p->s.n; j++) {
      if (i == j) continue;
      sm_pair q = sm_make_pair(p, i, j);
      if (q.gi != 0.0 || q.gj != 0.0) visit(p, &q, options, o);
    }
}

/* --- density and omega ------------------------------------------------------------------- */

static CHECK_UNUSED double sm_dwdh(const sm_particles *p, double r, double h) {
  return -((double)p->s.dim * sph_kernel_w(p->kernel, r, h) +
           r * sph_kernel_dwdr(p->kernel, r, h)) /
         h;
}

static CHECK_UNUSED void sm_density(const sm_particles *p, int32_t smoothing, double *rho) {
  for (int64_t i = 0; i < p->s.n; i++) {
    rho[i] = 0.0;
    for (int64_t j = 0; j < p->s.n; j++)
      rho[i] += (smoothing == SPH_SMOOTHING_MASS ? p->s.m[j] : p->s.m[i]) *
                sph_kernel_w(p->kernel, sm_make_pair(p, i, j).r, p->s.h[i]);
  }
}

/* bound: what the sum cancels from. */
static CHECK_UNUSED void sm_omega(const sm_particles *p, int32_t smoothing, double *omega,
                                  double *bound) {
  const oc_particles *s = &p->s;
  for (int64_t i = 0; i < s->n; i++) {
    double h = s->h[i], factor = h / ((double)s->dim * s->rho[i]);
    if (smoothing == SPH_SMOOTHING_NUMBER) factor *= s->m[i];
    if (smoothing == SPH_SMOOTHING_VOLUME) factor = h / (double)s->dim;
    omega[i] = bound[i] = 1.0;
    for (int64_t j = 0; j < s->n; j++) {
      double weight = smoothing == SPH_SMOOTHING_MASS     ? s->m[j]
                      : smoothing == SPH_SMOOTHING_VOLUME ? s->m[j] / s->rho[j]
                                                          : 1.0;
      double term = factor * weight * sm_dwdh(p, sm_make_pair(p, i, j).r, h);
      omega[i] += term;
      bound[i] += fabs(term);
    }
  }
}

/* --- the reversible part, scheme by scheme ------------------------------------------------ */

static CHECK_UNUSED double sm_pressure_force(const sm_particles *p, int32_t smoothing,
                                             const sm_pair *q, int side) {
  const oc_particles *s = &p->s;
  const int64_t i = q->i, j = q->j, k = side ? j : i;
  double term = s->p[k] / p->omega[k] * (side ? q->gj : q->gi);
  switch (smoothing) {
  case SPH_SMOOTHING_MASS: /* (4.13) */
    return -s->m[j] * term / (s->rho[k] * s->rho[k]);
  case SPH_SMOOTHING_VOLUME: /* (4.16) */
    return -s->m[j] / (s->rho[i] * s->rho[j]) * term;
  default: /* (4.19) */
    return -s->m[k] * s->m[k] / s->m[i] * term / (s->rho[k] * s->rho[k]);
  }
}

static CHECK_UNUSED double sm_density_rate(const sm_particles *p, int32_t smoothing,
                                           const sm_pair *q) {
  const oc_particles *s = &p->s;
  const int64_t i = q->i, j = q->j;
  switch (smoothing) {
  case SPH_SMOOTHING_MASS: /* (4.12) */
    return s->m[j] / p->omega[i];
  case SPH_SMOOTHING_VOLUME: /* (4.15) */
    return s->rho[i] * s->m[j] / s->rho[j] / p->omega[i];
  default: /* (4.18) */
    return s->m[i] / p->omega[i];
  }
}

static CHECK_UNUSED void sm_pressure_pair(const sm_particles *p, const sm_pair *q,
                                          const void *options, sm_out *o) {
  const int32_t smoothing = *(const int32_t *)options;
  const oc_particles *s = &p->s;
  double factor = sm_density_rate(p, smoothing, q);
  for (int a = 0; a < s->dim; a++) {
    double rate = factor * q->dv[a] * q->gi * q->unit[a];
    sm_add(o, SM_RHO, q->i, rate);
    sm_add(o, SM_E, q->i, s->p[q->i] / (s->rho[q->i] * s->rho[q->i]) * rate);
    for (int side = 0; side < 2; side++)
      sm_add(o, SM_V, q->i * s->dim + a, sm_pressure_force(p, smoothing, q, side) * q->unit[a]);
  }
}

/* --- the deviator (6.2), (6.3), (6.6) ------------------------------------------------------ */

static CHECK_UNUSED void sm_stress_pair(const sm_particles *p, const sm_pair *q,
                                        const void *options, sm_out *o) {
  const oc_particles *s = &p->s;
  const int64_t i = q->i, j = q->j;
  const int d = s->dim, n = d * (d + 1) / 2;
  const double factor = s->m[j] / (s->rho[i] * s->rho[j]);
  (void)options;
  for (int a = 0; a < d; a++)
    for (int b = 0; b < d; b++) {
      double ti = s->sigma[i * n + ref_sym(d, a, b)], tj = s->sigma[j * n + ref_sym(d, a, b)];
      double ei = q->gi * q->unit[b], ej = q->gj * q->unit[b];
      sm_add(o, SM_V, i * d + a, factor * ti * ei);
      sm_add(o, SM_V, i * d + a, factor * tj * ej);
      sm_add(o, SM_E, i, -factor * q->dv[a] * ti * ei);
      sm_add(o, SM_L, (i * d + a) * d + b, -q->dv[a] * ei * s->m[j] / s->rho[j]);
    }
}

/* --- dissipation (4.21) to (4.28) ---------------------------------------------------------- */

static CHECK_UNUSED double sm_signal(const sm_particles *p, const sm_pair *q,
                                     const sph_dissipation *z, double b) {
  double ci = p->s.c[q->i], cj = p->s.c[q->j], u = q->u < 0.0 ? q->u : 0.0;
  if (z->signal == SPH_SIGNAL_SOUND) return 0.5 * (ci + cj) - 0.5 * b * u;
  return sqrt(ci * ci + b * u * u) + sqrt(cj * cj + b * u * u) - u;
}

static CHECK_UNUSED double sm_flux(const sm_particles *p, const sm_pair *q,
                                   const sph_dissipation *z) {
  double pi = p->s.p[q->i], pj = p->s.p[q->j];
  if (z->flux_form == SPH_FLUX_POSITIVE) {
    pi = pi > 0.0 ? pi : 0.0;
    pj = pj > 0.0 ? pj : 0.0;
  }
  return z->mass_flux * (pi - pj) / sm_signal(p, q, z, z->mass_flux_b);
}

static CHECK_UNUSED void sm_dissipation_pair(const sm_particles *p, const sm_pair *q,
                                             const void *options, sm_out *o) {
  const sph_dissipation *z = (const sph_dissipation *)options;
  const oc_particles *s = &p->s;
  const int64_t i = q->i, j = q->j;
  double rho = 0.5 * (s->rho[i] + s->rho[j]), slope = 0.5 * (q->gi + q->gj);
  double weight = s->m[j] / rho, viscous = z->viscosity * sm_signal(p, q, z, z->viscosity_b);
  double se = sm_signal(p, q, z, z->conductivity_b);
  if (z->conductivity_form == SPH_CONDUCTIVITY_PRESSURE) se = sqrt(fabs(s->p[i] - s->p[j]) / rho);
  if (z->pairs == SPH_PAIRS_APPROACHING && !(q->u < 0.0)) return;
  if (q->r == 0.0) return; /* r_ij.dW = 0 */
  for (int a = 0; a < s->dim; a++)
    sm_add(o, SM_V, i * s->dim + a, weight * viscous * q->u * slope * q->unit[a]);
  sm_add(o, SM_E, i, -weight * viscous * 0.5 * q->u * q->u * slope);
  sm_add(o, SM_E, i, weight * z->conductivity * se * (p->e[i] - p->e[j]) * slope);
  if (z->mass_flux > 0.0) sm_add(o, SM_RHO, i, weight * sm_flux(p, q, z) * slope);
}

/* The cut of the mass flux, after the sum. */
static CHECK_UNUSED void sm_cut(const sm_particles *p, double limit, sm_out *o) {
  for (int64_t i = 0; limit > 0.0 && i < p->s.n; i++) {
    double most = limit * p->s.rho[i] * p->s.c[i] / p->s.h[i], *flux = &o->value[SM_RHO][i];
    *flux = fmin(fmax(*flux, -most), most);
  }
}

static CHECK_UNUSED void sm_clear(sm_out *o) { memset(o, 0, sizeof *o); }

/* The rule MAX, as smoothing.h asks for. */
static CHECK_UNUSED sph_neighbors *sm_list(sph_context *ctx, const sm_particles *p) {
  return oc_list(ctx, &p->s, p->kernel, SPH_H_MAX);
}

#endif
