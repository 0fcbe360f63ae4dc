/* Part of liquid_liquid_tube.c: the figures of every run, and their bounds. */
#ifndef EXAMPLES_LIQUID_LIQUID_TUBE_VALIDATE_H
#define EXAMPLES_LIQUID_LIQUID_TUBE_VALIDATE_H

#include "shock_tube_validate.h"

#define THESIS "Zisis 2017 section 5.2.2"
#define PLOTTED "the source plots it, without numbers"

static const tube_errors known_a = {2.0e-3, 4.1, 0.061, 0.0}, known_b = {4.1e-3, 2.2, 0.042, 0.0};

/* As the source has it, 400 and 100 particles a unit length. */
static int validate_case(char which) {
  outcome o = run(liquids(which, 1.0 / 400));
  int failed = tube_check_l1(&o.t, &o.l1, which == 'a' ? &known_a : &known_b, "rho");
  if (which == 'a')
    failed += tube_check_contact(&o.t, o.contact, -3.0, 3.0, THESIS);
  else
    tube_report_contact(&o.t, o.contact, NAN, NAN, THESIS, PLOTTED);
  const sph_riemann_solution *s = &o.exact.solution;
  const double shock = o.exact.t * s->head[1];
  failed += tube_place(&o.t, "right_shock", tube_crossing(&o.t, o.t.p, 0.5 * (s->p + 1.0), shock),
                       shock, 1, s->rho[1]);
  failed += tube_bound(&o.t, "energy_drift", tube_drift(&o.t), -1, DRIFT_BOUND, EXACT);
  const tube_errors fine = o.l1;
  tube_destroy(&o.t);
  o = run(liquids(which, 1.0 / 100));
  tube_report_contact(&o.t, o.contact, NAN, NAN, THESIS, PLOTTED);
  failed += tube_bound(&o.t, "L1_p_n100_over_n400", o.l1.p / fine.p, 1, 2.0,
                       "of first order it would be 4, at jumps less");
  tube_destroy(&o.t);
  return failed;
}

/* What the source tries on the error of case a, which reaches from the left wave to the contact. */
static int validate_variants(void) {
  tube_setup s = liquids('a', 1.0 / 400);
  s.name = "liquid_liquid_tube set=a pairs=all";
  s.loss.pairs = SPH_PAIRS_ALL;
  outcome o = run(s);
  int failed = tube_check_contact(&o.t, o.contact, -0.3, 0.3, INDEPENDENT);
  tube_destroy(&o.t);
  s = liquids('a', 1.0 / 400);
  for (int energy = 0; energy <= 1; ++energy) {
    s.loss.mass_flux = energy ? 0.5 : 1.0;
    s.loss.conductivity = energy ? 1.0 : 0.1;
    o = run(s);
    tube_report_contact(&o.t, o.contact, NAN, NAN, THESIS,
                        "the source: a smaller error with a_rho = 1; its caption says a_e = 1");
    tube_destroy(&o.t);
  }
  s.loss.mass_flux = s.loss.conductivity = 0.0;
  o = run(s);
  failed += tube_bound(&o.t, "contact_high_percent", o.contact.highest, 1, 20.0,
                       "independent program, 43 without mass flux and conductivity");
  tube_destroy(&o.t);
  return failed;
}

static int validate(void) { return validate_case('a') + validate_case('b') + validate_variants(); }

#endif
