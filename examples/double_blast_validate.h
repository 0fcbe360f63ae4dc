/* Part of double_blast.c: the figures of every run, and their bounds. */
#ifndef EXAMPLES_DOUBLE_BLAST_VALIDATE_H
#define EXAMPLES_DOUBLE_BLAST_VALIDATE_H

#include "shock_tube_validate.h"

#define FINITE_VOLUMES "finite volumes (HLLC), 25600 cells"

static const peak left_peak = {0.64709, 5.33764}, right_peak = {0.77861, 6.46108};

/* The right peak is broad: grids of 1600 and 25600 cells find it 0.003 apart, so that its place is
 * only shown. */
static int check_peak(const tube *t, const char *side, peak measured, peak known) {
  char quantity[32], keys[TUBE_KEYS];
  snprintf(quantity, sizeof quantity, "%s_peak_place", side);
  tube_report(t, quantity, measured.x, known.x, FINITE_VOLUMES,
              "a broad maximum has no exact place");
  snprintf(quantity, sizeof quantity, "%s_peak_density", side);
  return result_line(tube_keys(keys, t, quantity), measured.rho, known.rho, FINITE_VOLUMES, 0.05,
                     1);
}

static int validate_run(int particles, double bound, double *l1) {
  const tube_setup s = blasts(particles, 0.0);
  tube t;
  need(t.ctx, tube_run(&t, &s));
  *l1 = bins_l1(&t);
  int failed = tube_bound(&t, "L1_bins", *l1, -1, bound, FINITE_VOLUMES);
  failed += check_peak(&t, "left", highest(&t, 0.5, 0.7), left_peak);
  failed += check_peak(&t, "right", highest(&t, 0.7, 0.85), right_peak);
  failed += tube_bound(&t, "energy_drift", tube_drift(&t), -1, 3e-5,
                       "conservation; steps at jumps of pressure of 1e5");
  tube_destroy(&t);
  return failed;
}

/* What mass flux does to the density behind many shocks. */
static void validate_flux(void) {
  const tube_setup s = blasts(400, 0.5);
  tube t;
  need(t.ctx, tube_run(&t, &s));
  tube_report(&t, "right_peak_density", highest(&t, 0.7, 0.85).rho, right_peak.rho, FINITE_VOLUMES,
              "shows the bias of the mass flux, which this case does without");
  tube_destroy(&t);
}

static int validate(int full) {
  double coarse, fine, finest;
  int failed = validate_run(400, 0.04, &coarse);
  failed += validate_run(800, 0.02, &fine);
  failed += result_bound("case=double_blast quantity=L1_bins_n400_over_n800", coarse / fine, 1, 1.5,
                         "of first order it would be 2");
  if (full) failed += validate_run(1600, 0.01, &finest);
  validate_flux();
  return failed;
}

#endif
