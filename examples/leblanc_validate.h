/* Part of leblanc.c: the figures of every run, and their bounds. */
#ifndef EXAMPLES_LEBLANC_VALIDATE_H
#define EXAMPLES_LEBLANC_VALIDATE_H

#include "shock_tube_validate.h"

#define SPACINGS "no published bound for particles: own figure, to notice what changes it"

static int validate_run(int particles, double most, outcome *o) {
  char keys[TUBE_KEYS];
  *o = run(leblanc(particles));
  const double shock = o->exact.x0 + o->exact.t * o->exact.solution.head[1];
  int failed = tube_bound(&o->t, "L1_e", o->l1.e, -1, most, SPACINGS);
  tube_report(&o->t, "L1_rho", o->l1.rho, 0.0, EXACT, "ordered below, with those of e");
  tube_report(&o->t, "L1_v", o->l1.v, 0.0, EXACT, "ordered below, with those of e");
  result_report(tube_keys(keys, &o->t, "shock_position"), o->shock, shock, EXACT,
                "the shock runs ahead by what heats the gas at the contact in the beginning");
  failed += tube_bound(&o->t, "in_order", tube_in_order(&o->t), 1, 1.0, EXACT);
  failed += tube_bound(&o->t, "energy_drift", tube_drift(&o->t), -1, DRIFT_BOUND, "conservation");
  o->shock -= shock;
  tube_destroy(&o->t);
  return failed;
}

/* First order in the spacing: rho, v, e and the shock's lead fall by two with twice as many. */
static int check_order(int particles, const outcome *a, const outcome *b) {
  const double ratio[] = {a->l1.rho / b->l1.rho, a->l1.v / b->l1.v, a->l1.e / b->l1.e,
                          a->shock / b->shock};
  static const char *const names[] = {"L1_rho", "L1_v", "L1_e", "shock_lead"};
  int failed = 0;
  for (int k = 0; k < 4; ++k) {
    char keys[96];
    snprintf(keys, sizeof keys, "case=leblanc quantity=%s_halved_spacing n=%d", names[k],
             particles);
    failed += result_bound(keys, ratio[k], 1, 1.7, "of first order it would be 2");
  }
  return failed;
}

static int validate(int full) {
  outcome coarse, fine, finest;
  int failed = validate_run(450, 0.080, &coarse);
  failed += validate_run(900, 0.040, &fine) + check_order(900, &coarse, &fine);
  if (full) failed += validate_run(1800, 0.020, &finest) + check_order(1800, &fine, &finest);
  return failed;
}

#endif
