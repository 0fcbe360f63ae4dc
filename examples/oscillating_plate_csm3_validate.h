/* Part of oscillating_plate_csm3.c: mean, amplitude and frequency of the point A beside those of
 * the reference, and that they converge. */
#ifndef EXAMPLES_OSCILLATING_PLATE_CSM3_VALIDATE_H
#define EXAMPLES_OSCILLATING_PLATE_CSM3_VALIDATE_H

enum { KEYS = 128 };

#define DATA "Turek & Hron 2006 CSM3, data of TrixiParticles.jl"

static int compare(int rows, const char *quantity, double measured, double reference) {
  char keys[KEYS];
  snprintf(keys, sizeof keys, "case=oscillating_plate_csm3 quantity=%s rows=%d", quantity, rows);
  if (rows >= 10) return result_line(keys, measured, reference, DATA, 0.05, 1);
  result_report(keys, measured, reference, DATA, "coarse, for the convergence");
  return 0;
}

static double amplitude(const outcome *r) { return 0.5 * (r->high[1] - r->low[1]); }

static int validate_rows(int rows, outcome *r) {
  plate p;
  char keys[KEYS];
  plate_create(&p, rows);
  *r = plate_run(&p, NULL);
  plate_destroy(&p);
  int failed = compare(rows, "tip_x_mean_mm", 500.0 * (r->high[0] + r->low[0]), 1e3 * mean_x);
  failed += compare(rows, "tip_x_amplitude_mm", 500.0 * (r->high[0] - r->low[0]), 1e3 * range_x);
  failed += compare(rows, "tip_y_mean_mm", 500.0 * (r->high[1] + r->low[1]), 1e3 * mean_y);
  failed += compare(rows, "tip_y_amplitude_mm", 1e3 * amplitude(r), 1e3 * range_y);
  failed += compare(rows, "frequency", r->frequency, frequency);
  snprintf(keys, sizeof keys, "case=oscillating_plate_csm3 quantity=energy_drift rows=%d", rows);
  return failed + result_bound(keys, r->drift, -1, 1e-6, "leapfrog");
}

/* With 20 rows the amplitude has settled: what is left is the distance to the reference. */
static int validate(int full) {
  outcome coarse, middle, fine;
  int failed = validate_rows(5, &coarse) + validate_rows(10, &middle);
  if (!full) return failed;
  failed += validate_rows(20, &fine);
  failed += result_line("case=oscillating_plate_csm3 quantity=tip_y_amplitude_10_over_20_rows",
                        amplitude(&middle) / amplitude(&fine), 1.0, "converged", 0.005, 0);
  return failed + result_line("case=oscillating_plate_csm3 quantity=frequency_10_over_20_rows",
                              middle.frequency / fine.frequency, 1.0, "converged", 0.005, 0);
}

#endif
