/* What the proofs of the one-dimensional examples of shocks share: figures of a run as RESULT
 * lines. */
#ifndef EXAMPLES_SHOCK_TUBE_VALIDATE_H
#define EXAMPLES_SHOCK_TUBE_VALIDATE_H

#include "shock_tube.h"

#define EXACT "exact Riemann solution"
#define INDEPENDENT "independent program"

/* `measured` at most (side -1) or at least (side 1) `bound`; answers the number of failures. */
static inline int tube_bound(const tube *t, const char *quantity, double measured, int side,
                             double bound, const char *source) {
  char keys[TUBE_KEYS];
  return result_bound(tube_keys(keys, t, quantity), measured, side, bound, source);
}

static inline void tube_report(const tube *t, const char *quantity, double measured,
                               double reference, const char *source, const char *reason) {
  char keys[TUBE_KEYS];
  result_report(tube_keys(keys, t, quantity), measured, reference, source, reason);
}

/* The place of a wave, to within twice the smoothing length of the denser state beside it. */
static inline int tube_place(const tube *t, const char *quantity, double measured, double exact,
                             int region, double density) {
  char keys[TUBE_KEYS];
  const tube_setup *s = &t->setup;
  const double h = 1.2 * tube_spacing(s, region) * s->region[region].state.rho / density;
  return result_line(tube_keys(keys, t, quantity), measured, exact, EXACT, 2.0 * h, 0);
}

/* L1 errors against those of a program written from the same equations by others; 0: not known.
 * `held`: which of "rho", "p", "v" must not exceed it; NULL: none. */
static inline int tube_check_l1(const tube *t, const tube_errors *l1, const tube_errors *known,
                                const char *held) {
  const double measured[] = {l1->rho, l1->p, l1->v}, printed[] = {known->rho, known->p, known->v};
  static const char *const names[] = {"rho", "p", "v"};
  int failed = 0;
  for (int k = 0; k < 3; ++k) {
    char quantity[16];
    snprintf(quantity, sizeof quantity, "L1_%s", names[k]);
    if (held && strcmp(held, names[k]) == 0)
      failed += tube_bound(t, quantity, measured[k], -1, printed[k], INDEPENDENT);
    else
      tube_report(t, quantity, measured[k], printed[k] > 0.0 ? printed[k] : NAN, INDEPENDENT,
                  held
                      ? "shown beside the error that is bounded"
                      : "a smoothing, layout or size without a bound, shown beside those with one");
  }
  return failed;
}

/* The same figure, to the two digits in which it is printed. */
static inline int tube_agree(const tube *t, const char *quantity, double measured, double printed) {
  char keys[TUBE_KEYS];
  return result_line(tube_keys(keys, t, quantity), measured, printed, INDEPENDENT,
                     0.5 * pow(10.0, floor(log10(printed)) - 1.0), 0);
}

/* P/P* - 1 at a contact within [low, high] per cent. */
static inline int tube_check_contact(const tube *t, tube_range contact, double low, double high,
                                     const char *source) {
  return tube_bound(t, "contact_high_percent", contact.highest, -1, high, source) +
         tube_bound(t, "contact_low_percent", contact.lowest, 1, low, source);
}
static inline void tube_report_contact(const tube *t, tube_range contact, double low, double high,
                                       const char *source, const char *reason) {
  tube_report(t, "contact_high_percent", contact.highest, high, source, reason);
  tube_report(t, "contact_low_percent", contact.lowest, low, source, reason);
}

/* What shocks.h says of the default cfl. */
#define DRIFT_BOUND 1e-5

/* What the steps change the total energy by, less what moving walls do, relative. */
static inline double tube_drift(const tube *t) {
  return fabs(t->ledger.energy_error / t->energy_start);
}

#endif
