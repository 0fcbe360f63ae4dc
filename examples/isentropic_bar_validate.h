/* Part of isentropic_bar.c: the figures of every run, and their bounds. */
#ifndef EXAMPLES_ISENTROPIC_BAR_VALIDATE_H
#define EXAMPLES_ISENTROPIC_BAR_VALIDATE_H

#include "shock_tube_validate.h"

#define THESIS "Zisis 2017 section 5.3"

static int validate_layout(int equal, const tube_errors *known, double low, double high) {
  outcome o = run(bar(equal, 0.5, 0.5));
  const tube_riemann *a = &o.exact.first, *b = &o.exact.second;
  const double left = a->x0 + a->t * a->solution.head[0];
  const double right = b->x0 + b->t * b->solution.head[1];
  int failed = tube_check_l1(&o.t, &o.l1, known, "p");
  failed += tube_check_contact(&o.t, o.contact, low, high, INDEPENDENT);
  failed += tube_place(&o.t, "left_shock", tube_crossing(&o.t, o.t.p, 0.5 * a->solution.p, left),
                       left, 0, a->solution.rho[0]);
  failed += tube_place(&o.t, "right_shock", tube_crossing(&o.t, o.t.p, 0.5 * b->solution.p, right),
                       right, 2, b->solution.rho[1]);
  failed += tube_bound(&o.t, "energy_drift", tube_drift(&o.t), -1, DRIFT_BOUND, EXACT);
  tube_destroy(&o.t);
  return failed;
}

/* The wave of e behind the fan is heat of the first instants of the impact: exact e 0.0628. It
 * shrinks with conductivity. */
static int validate_heating(void) {
  static const double a_e[] = {0.0, 0.1, 0.5, 2.0}, known[] = {0.168, 0.103, 0.083, 0.072};
  double before = INFINITY;
  int failed = 0;
  for (int k = 0; k < 4; ++k) {
    outcome o = run(bar(0, 0.5, a_e[k]));
    tube_report(&o.t, "largest_e_at_the_face", o.heat, known[k], INDEPENDENT,
                "the exact value is 0.0628; ordered below");
    if (k > 0) failed += tube_bound(&o.t, "heat_less_than_before", o.heat, -1, before, THESIS);
    before = o.heat;
    tube_destroy(&o.t);
  }
  return failed;
}

/* The two Riemann problems themselves. */
static int validate_reference(void) {
  const tube_setup s = bar(0, 0.5, 0.5);
  tube t;
  tube_create(&t, &s);
  const tube_relay r = tube_relay_solve(t.ctx, &s);
  const sph_riemann_solution *a = &r.first.solution, *b = &r.second.solution;
  const double measured[] = {a->p,    a->v[0],   a->rho[0], a->e[0], r.meets, b->p,
                             b->v[0], b->rho[0], b->rho[1], b->e[0], b->e[1], b->head[1]};
  static const double known[] = {0.915769, 0.5,      1.375506, 0.125,    0.109198, 0.427406,
                                 0.715966, 1.214535, 0.768843, 0.062837, 0.256303, 1.492411};
  static const char *const names[] = {"p_impact",  "v_impact", "rho_impact", "e_impact",
                                      "meets",     "p",        "v",          "rho_left",
                                      "rho_right", "e_left",   "e_right",    "shock_speed"};
  char keys[TUBE_KEYS];
  int failed = 0;
  for (size_t k = 0; k < sizeof known / sizeof *known; ++k) {
    snprintf(keys, sizeof keys, "case=isentropic_bar quantity=exact_%s", names[k]);
    failed += result_line(keys, measured[k], known[k], INDEPENDENT, 1e-6, 0);
  }
  tube_destroy(&t);
  return failed;
}

static int validate(void) {
  static const tube_errors unequal = {6.1e-3, 9.2e-3, 5.9e-3, 0.0};
  static const tube_errors equal = {6.3e-3, 8.4e-3, 5.5e-3, 0.0};
  int failed = validate_reference();
  failed += validate_layout(0, &unequal, -10.0, 10.0);
  failed += validate_layout(1, &equal, -10.0, 10.0);
  failed += validate_heating();
  outcome o = run(bar(0, 0.0, 0.0));
  failed += tube_bound(&o.t, "contact_high_percent", o.contact.highest, 1, 50.0,
                       "independent program, 57 without mass flux and conductivity");
  tube_destroy(&o.t);
  return failed;
}

#endif
