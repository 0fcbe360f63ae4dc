/* Part of isothermal_bar.c: the figures of every run, and their bounds. */
#ifndef EXAMPLES_ISOTHERMAL_BAR_VALIDATE_H
#define EXAMPLES_ISOTHERMAL_BAR_VALIDATE_H

#include "shock_tube_validate.h"

#define THESIS "Zisis 2017 section 5.1"

/* What a run with number smoothing is held to. */
typedef struct bound {
  double spacing;
  int equal;
  tube_errors known;
  double low, high; /* P at the contact, per cent */
} bound;

static const bound bounds[] = {
    {.0025, 0, {7.8e-3, 6.5e-3, 6.1e-3, 0.0}, -15.0, 15.0},
    {.005, 1, {6.2e-3, 4.0e-3, 5.6e-3, 0.0}, -3.0, 3.0},
};

/* Shocks where P, the fan where v passes the mean of both sides; the contact between particles. */
static int check_places(const outcome *o) {
  const tube *t = &o->t;
  const tube_riemann *a = &o->exact.first, *b = &o->exact.second;
  const sph_riemann_solution *s = &b->solution;
  const double left = a->x0 + a->t * a->solution.head[0];
  const double fan = b->x0 + b->t * 0.5 * (s->head[0] + s->tail[0]);
  const double contact = b->x0 + b->t * s->v[0], shock = b->x0 + b->t * s->head[1];
  const int64_t k = t->first[2];
  return tube_place(t, "left_shock", tube_crossing(t, t->p, 0.5 * a->solution.p, left), left, 0,
                    a->solution.rho[0]) +
         tube_place(t, "fan_middle",
                    tube_crossing(t, t->v, 0.5 * (a->solution.v[0] + s->v[0]), fan), fan, 1,
                    a->solution.rho[0]) +
         tube_place(t, "contact", 0.5 * (t->x[k - 1] + t->x[k]), contact, 1, s->rho[0]) +
         tube_place(t, "right_shock", tube_crossing(t, t->p, 0.5 * s->p, shock), shock, 2,
                    s->rho[1]);
}

static int validate_run(const bound *b, int32_t smoothing, double *l1_p) {
  outcome o = run(bar(b->spacing, b->equal, smoothing));
  const tube_errors unknown = {0.0, 0.0, 0.0, 0.0};
  int failed = 0;
  if (smoothing == SPH_SMOOTHING_NUMBER) {
    failed += tube_check_l1(&o.t, &o.l1, &b->known, "p");
    failed += tube_check_contact(&o.t, o.contact, b->low, b->high, THESIS);
    failed += check_places(&o);
    failed += tube_bound(&o.t, "energy_drift", tube_drift(&o.t), -1, 1e-6, EXACT);
  } else {
    tube_check_l1(&o.t, &o.l1, &unknown, NULL);
    tube_report_contact(&o.t, o.contact, NAN, NAN, THESIS,
                        "the source shows number smoothing for this case");
  }
  *l1_p = o.l1.p;
  tube_destroy(&o.t);
  return failed;
}

/* The two Riemann problems themselves. */
static int validate_reference(void) {
  const tube_setup s = bar(0.0025, 0, SPH_SMOOTHING_NUMBER);
  tube t;
  tube_create(&t, &s);
  const tube_relay r = tube_relay_solve(t.ctx, &s);
  const sph_riemann_solution *a = &r.first.solution, *b = &r.second.solution;
  const double measured[] = {a->p, a->v[0], r.meets, b->p, b->v[0], b->rho[0], b->rho[1]};
  static const double known[] = {0.640388, 0.5, 0.156155, 0.209918, 0.804380, 1.209918, 1.089671};
  static const char *const names[] = {"p_impact", "v_impact", "meets",    "p",
                                      "v",        "rho_left", "rho_right"};
  char keys[TUBE_KEYS];
  int failed = 0;
  for (size_t k = 0; k < sizeof known / sizeof *known; ++k) {
    snprintf(keys, sizeof keys, "case=isothermal_bar quantity=exact_%s", names[k]);
    failed += result_line(keys, measured[k], known[k], INDEPENDENT, 1e-6, 0);
  }
  result_report("case=isothermal_bar quantity=exact_p_by_jumps", b->p, 0.210287, THESIS,
                "the source replaces the fan by a jump, which is 0.2 per cent off");
  tube_destroy(&t);
  return failed;
}

static int validate(void) {
  double l1[2][SPH_SMOOTHING_NUMBER + 1];
  int failed = validate_reference();
  for (int equal = 0; equal <= 1; ++equal)
    for (int32_t smoothing = SPH_SMOOTHING_MASS; smoothing <= SPH_SMOOTHING_NUMBER; ++smoothing)
      failed += validate_run(&bounds[equal], smoothing, &l1[equal][smoothing]);
  return failed + result_bound("case=isothermal_bar quantity=L1_p_spacing_over_masses",
                               l1[0][SPH_SMOOTHING_NUMBER] / l1[1][SPH_SMOOTHING_NUMBER], 1, 1.0,
                               THESIS);
}

#endif
