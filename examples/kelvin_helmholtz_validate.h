/* Part of kelvin_helmholtz.c: linear theory against the published rate, growth against theory. */
#ifndef EXAMPLES_KELVIN_HELMHOLTZ_VALIDATE_H
#define EXAMPLES_KELVIN_HELMHOLTZ_VALIDATE_H

#define LINEAR "linear theory, inviscid"

static int validate_growth(int rows, double known, double *error) {
  char keys[120];
  plane s;
  layer_create(&s, rows);
  const double measured = growth(&s);
  *error = fabs(measured / known - 1.0);
  snprintf(keys, sizeof keys, "case=kelvin_helmholtz quantity=growth_rate n=%lld", (long long)s.n);
  int failed = 0;
  if (rows >= 64)
    failed += result_line(keys, measured, known, LINEAR, 0.1, 1);
  else
    result_report(keys, measured, known, LINEAR, "fourteen spacings a wave are few: 64 are held");
  snprintf(keys, sizeof keys, "case=kelvin_helmholtz quantity=energy_error n=%lld", (long long)s.n);
  failed += result_bound(keys, plane_drift(&s), -1, 1e-5, "kept, but for the steps");
  plane_destroy(&s);
  return failed;
}

static int validate(int full) {
  static const int rows[] = {32, 64, 128};
  const double known = compressible_growth();
  double error[3];
  int failed = 0;
  failed += result_line("case=kelvin_helmholtz quantity=theory_incompressible",
                        theory(2.0 * pi, 0.0) * thickness / speed, 0.1897,
                        "Michalke 1964, without walls", 0.01, 0);
  result_report("case=kelvin_helmholtz quantity=theory_compressible", known * thickness / speed,
                0.1897, "Michalke 1964", "at a Mach number of 0.245 it is smaller");
  for (int k = 0; k < (full ? 3 : 2); ++k) failed += validate_growth(rows[k], known, &error[k]);
  return failed + result_bound("case=kelvin_helmholtz quantity=error_32_over_64",
                               error[0] / error[1], 1, 1.0, "falls as N grows");
}

#endif
