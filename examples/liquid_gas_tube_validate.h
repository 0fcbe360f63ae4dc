/* Part of liquid_gas_tube.c: the figures of every run, and their bounds. */
#ifndef EXAMPLES_LIQUID_GAS_TUBE_VALIDATE_H
#define EXAMPLES_LIQUID_GAS_TUBE_VALIDATE_H

#include "shock_tube_validate.h"

#define THESIS "Zisis 2017 section 5.2.3"

static int validate_run(int particles, const tube_errors *known, tube_errors *l1) {
  outcome o = run(liquid_gas(particles, 0.5));
  const double shock = o.exact.x0 + o.exact.t * o.exact.solution.head[1];
  char keys[TUBE_KEYS];
  int failed = tube_check_l1(&o.t, &o.l1, known, particles == 800 ? "p" : NULL);
  tube_report_contact(&o.t, o.contact, particles == 800 ? -8.0 : NAN, particles == 800 ? 56.0 : NAN,
                      INDEPENDENT, "the source plots the hump, without numbers");
  if (particles == 800)
    failed += result_line(tube_keys(keys, &o.t, "shock_position"), o.shock, shock, EXACT,
                          2.0 * o.t.setup.spacing, 0);
  else
    result_report(tube_keys(keys, &o.t, "shock_position"), o.shock, shock, EXACT,
                  "the source: the shock approaches its place with more particles");
  failed += tube_bound(&o.t, "energy_drift", tube_drift(&o.t), -1, DRIFT_BOUND, EXACT);
  *l1 = o.l1;
  tube_destroy(&o.t);
  return failed;
}

/* More mass flux, a lower hump; none, a spike. */
static void validate_flux(double a_rho, double known_low, double known_high) {
  outcome o = run(liquid_gas(800, a_rho));
  tube_report_contact(&o.t, o.contact, known_low, known_high, INDEPENDENT,
                      "what the mass flux does, shown beside the run of the source");
  tube_destroy(&o.t);
}

/* Equal masses put spacings of 1 to 20 beside each other. The independent program's particles
 * overtake each other there. */
static void validate_equal_masses(void) {
  tube_setup s = liquid_gas(80, 0.5);
  tube t;
  s.equal_masses = 1;
  s.dt = 0.0;
  const sph_status status = tube_run(&t, &s);
  tube_report(&t, "completes_in_order", !status && tube_in_order(&t), 0.0, INDEPENDENT,
              "spacings of 1 to 20 at a contact are outside what the method is for");
  tube_destroy(&t);
}

static int validate(void) {
  static const tube_errors known_200 = {3.2e-3, 9.9e-3, 1.3e-2, 0.0};
  static const tube_errors known_800 = {9.0e-4, 2.7e-3, 2.6e-3, 0.0};
  tube_errors coarse, fine;
  int failed = validate_run(200, &known_200, &coarse);
  failed += validate_run(800, &known_800, &fine);
  failed += result_bound("case=liquid_gas_tube quantity=L1_p_n200_over_n800", coarse.p / fine.p, 1,
                         3.0, INDEPENDENT);
  failed += result_bound("case=liquid_gas_tube quantity=L1_rho_n200_over_n800",
                         coarse.rho / fine.rho, 1, 3.0, INDEPENDENT);
  validate_flux(1.0, NAN, 39.0);
  validate_flux(0.0, -34.0, 88.0);
  validate_equal_masses();
  return failed;
}

#endif
