/* Sides of Riemann problems for tests, and what any weak solution must satisfy. */
#ifndef SPH_TESTS_RIEMANN_HELP_H
#define SPH_TESTS_RIEMANN_HELP_H

#include "eos_help.h"

#include <sph/reference.h>

static CHECK_UNUSED sph_riemann_side gas_side(double rho, double v, double p, double gamma,
                                              double reference) {
  sph_riemann_side s;
  sph_riemann_side_init(&s);
  s.rho = rho;
  s.v = v;
  s.p = p;
  s.gamma = gamma;
  s.reference_pressure = reference;
  return s;
}

static CHECK_UNUSED sph_riemann_side tait_side(double rho, double v, double rho0, double c0,
                                               double gamma) {
  sph_riemann_side s = gas_side(rho, v, 0.0, gamma, 0.0);
  s.law = SPH_RIEMANN_BAROTROPIC;
  s.density = rho0;
  s.sound_speed = c0;
  return s;
}

static CHECK_UNUSED sph_riemann_side solid_side(double rho, double v, double p, double rho0,
                                                double c0, double slope, double gruneisen,
                                                int32_t curve) {
  sph_riemann_side s = tait_side(rho, v, rho0, c0, 1.0);
  s.law = SPH_RIEMANN_MIE_GRUNEISEN;
  s.p = p;
  s.slope = slope;
  s.gruneisen = gruneisen;
  s.curve = curve;
  return s;
}

static CHECK_UNUSED sph_riemann_side void_side(double p) {
  sph_riemann_side s = gas_side(0.0, 0.0, p, 1.4, 0.0);
  s.law = SPH_RIEMANN_VOID;
  return s;
}

static CHECK_UNUSED sph_riemann_solution solve(sph_context *ctx, const sph_riemann_side *left,
                                               const sph_riemann_side *right) {
  sph_riemann_solution s;
  sph_riemann_solution_init(&s);
  sph_status status = sph_riemann_solve(ctx, left, right, &s);
  if (status != SPH_OK) print_error("%s\n", sph_context_last_error(ctx));
  check_ok(status);
  return s;
}

typedef struct ray {
  double rho, v, p, e;
} ray;

static CHECK_UNUSED ray sample(sph_context *ctx, const sph_riemann_side *left,
                               const sph_riemann_side *right, const sph_riemann_solution *s,
                               double speed) {
  ray r;
  check_ok(sph_riemann_sample(ctx, left, right, s, 1, &speed, &r.rho, &r.v, &r.p, &r.e));
  return r;
}

/* The same law as a material of the library, which shares no line with the solver. */
static CHECK_UNUSED sph_material *material_of(sph_context *ctx, const sph_riemann_side *s) {
  sph_material *m = NULL;
  if (s->law == SPH_RIEMANN_GAS) return gas(ctx, s->gamma, s->reference_pressure, 0.0);
  if (s->law == SPH_RIEMANN_BAROTROPIC) {
    sph_barotropic_options o;
    sph_barotropic_options_init(&o);
    o.density = s->density;
    o.sound_speed = s->sound_speed;
    o.gamma = s->gamma;
    o.background = s->background;
    check_ok(sph_material_create_barotropic(ctx, &o, &m));
    return m;
  }
  sph_mie_gruneisen_options o;
  sph_mie_gruneisen_options_init(&o);
  o.density = s->density;
  o.sound_speed = s->sound_speed;
  o.slope = s->slope;
  o.gruneisen = s->gruneisen;
  o.curve = s->curve;
  o.sound_floor = 0.0;
  check_ok(sph_material_create_mie_gruneisen(ctx, &o, &m));
  return m;
}

/* Mass, momentum and energy of the profile at t = 1, between two speeds with nothing in between
 * that is not smooth: Gauss-Legendre with 5 points on `panels` pieces of z, x = end + (start - end)
 * z^4, for a fan that ends in a void is a broken power there. */
static CHECK_UNUSED void add_integrals(sph_context *ctx, const sph_riemann_side *left,
                                       const sph_riemann_side *right, const sph_riemann_solution *s,
                                       double start, double end, int panels, double sum[3]) {
  static const double at[] = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                              0.9061798459386640};
  static const double weight[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                  0.4786286704993665, 0.2369268850561891};
  if (start == end) return;
  for (int k = 0; k < panels; k++)
    for (int g = 0; g < 5; g++) {
      const double z = (k + 0.5 * (1.0 + at[g])) / panels;
      const ray r = sample(ctx, left, right, s, end + (start - end) * pow(z, 4.0));
      const double w = 0.5 * weight[g] / panels * 4.0 * pow(z, 3.0) * fabs(start - end);
      if (r.rho == 0.0) continue;
      sum[0] += w * r.rho;
      sum[1] += w * r.rho * r.v;
      sum[2] += w * r.rho * (r.e + 0.5 * r.v * r.v);
    }
}

/* Where a fan of Mie-Grueneisen passes rho0 and has a kink; its tail when it does not. */
static CHECK_UNUSED double kink_of(sph_context *ctx, const sph_riemann_side *left,
                                   const sph_riemann_side *right, const sph_riemann_solution *s,
                                   int k) {
  const sph_riemann_side *side = k == 0 ? left : right;
  double head = s->head[k], tail = s->tail[k];
  if (side->law != SPH_RIEMANN_MIE_GRUNEISEN || s->wave[k] != SPH_WAVE_FAN ||
      side->rho <= side->density || s->rho[k] >= side->density)
    return tail;
  for (int i = 0; i < 40; i++) {
    const double middle = 0.5 * (head + tail);
    *(sample(ctx, left, right, s, middle).rho > side->density ? &head : &tail) = middle;
  }
  return 0.5 * (head + tail);
}

/* The conservation laws over the whole fan of waves, the definition of a weak solution: what is in
 * [-x, x] at t = 1 is what was there, and what came in through the ends. Energy for laws that have
 * one. All terms against the largest of their kind. */
static CHECK_UNUSED void check_conservation(sph_context *ctx, const sph_riemann_side *left,
                                            const sph_riemann_side *right,
                                            const sph_riemann_solution *s, int panels,
                                            double tolerance) {
  const sph_riemann_side *side[2] = {left, right};
  const double end = 1.1 * fmax(fmax(fabs(s->head[0]), fabs(s->head[1])), 1e-30);
  double now[3] = {0}, scale[3] = {1e-300, 1e-300, 1e-300};
  for (int k = 0; k < 2; k++) { /* fans end at their tails */
    const double kink = kink_of(ctx, left, right, s, k);
    const int many = side[k]->law == SPH_RIEMANN_MIE_GRUNEISEN ? 1 + panels / 3 : panels;
    add_integrals(ctx, left, right, s, k == 0 ? -end : end, s->head[k], 1, now);
    add_integrals(ctx, left, right, s, s->head[k], kink, many, now);
    add_integrals(ctx, left, right, s, kink, s->tail[k], many, now);
    add_integrals(ctx, left, right, s, s->tail[k], s->v[k], 1, now);
  }
  for (int k = 0; k < 2; k++) {
    const ray r = sample(ctx, left, right, s, k == 0 ? -end : end);
    const double sign = k == 0 ? 1.0 : -1.0, total = r.e + 0.5 * r.v * r.v;
    if (side[k]->law == SPH_RIEMANN_VOID) continue;
    const double was[3] = {r.rho * end, r.rho * r.v * end, r.rho * total * end};
    const double in[3] = {r.rho * r.v, r.rho * r.v * r.v + r.p, r.v * (r.rho * total + r.p)};
    const double size[3] = {r.rho * end, r.rho * fabs(end * end) + fabs(r.p),
                            end * (r.rho * (fabs(r.e) + end * end) + fabs(r.p))};
    for (int c = 0; c < 3; c++) {
      now[c] -= was[c] + sign * in[c];
      scale[c] += size[c];
    }
  }
  /* A void carries its pressure from surface to surface, and the work of it. */
  if (s->gap && s->p != 0.0) {
    const int none = left->law == SPH_RIEMANN_VOID ? 0 : right->law == SPH_RIEMANN_VOID ? 1 : -1;
    if (none >= 0) {
      now[1] += (none == 0 ? -1.0 : 1.0) * s->p;
      now[2] += (none == 0 ? -1.0 : 1.0) * s->p * s->v[0];
    } else {
      now[2] -= s->p * (s->v[1] - s->v[0]);
    }
  }
  const int energy = left->law != SPH_RIEMANN_BAROTROPIC && right->law != SPH_RIEMANN_BAROTROPIC;
  for (int c = 0; c < (energy ? 3 : 2); c++) check_close(now[c] / scale[c], 0.0, tolerance);
}

#endif
