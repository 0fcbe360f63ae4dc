/* What the proofs of the round examples share: figures of a run as RESULT lines. */
#ifndef EXAMPLES_RADIAL_VALIDATE_H
#define EXAMPLES_RADIAL_VALIDATE_H

#include "radial.h"

static inline int radial_bound(const radial *a, const char *quantity, double measured, int side,
                               double bound, const char *source) {
  char keys[RADIAL_KEYS];
  return result_bound(radial_keys(keys, a, quantity), measured, side, bound, source);
}

static inline void radial_report(const radial *a, const char *quantity, double measured,
                                 double reference, const char *source, const char *reason) {
  char keys[RADIAL_KEYS];
  result_report(radial_keys(keys, a, quantity), measured, reference, source, reason);
}

/* What the steps change the total energy by, at the default cfl: cold gas, shocks without limit of
 * strength, in 3-D a handful of particles across. A thousandth; it falls with more particles for
 * Noh, not for Sedov. */
static inline int radial_check_energy(const radial *a) {
  return radial_bound(a, "energy_drift", fabs(a->ledger.energy_error / a->energy_start), -1, 1e-3,
                      "conservation");
}

#endif
