/* Part of taylor_bar.c: the figures, and their bounds. */
#ifndef EXAMPLES_TAYLOR_BAR_VALIDATE_H
#define EXAMPLES_TAYLOR_BAR_VALIDATE_H

#define BENCHMARK "Kamoulakos 1990, Zhu & Cescotto 1995, Camacho & Ortiz 1997"

static const char *keys_of(char keys[160], const rod *s, int across, const char *quantity) {
  snprintf(keys, 160, "case=taylor_bar quantity=%s n=%lld across=%d", quantity, (long long)s->n,
           across);
  return keys;
}

/* The middle of the published figures. */
static int validate_rod(int across) {
  char keys[160];
  rod s;
  rod_create(&s, across);
  const outcome o = run(&s);
  int failed = result_line(keys_of(keys, &s, across, "length_mm"), 1e3 * o.length, 21.46, BENCHMARK,
                           0.02, 1);
  failed +=
      result_line(keys_of(keys, &s, across, "radius_mm"), 1e3 * o.radius, 7.07, BENCHMARK, 0.05, 1);
  failed += result_bound(keys_of(keys, &s, across, "kinetic_energy_left"), o.kinetic, -1, 0.01,
                         "the rod has come to rest");
  failed += result_bound(keys_of(keys, &s, across, "energy_error"), o.energy, -1, 2e-4,
                         "time steps; the foot starts at rest, a jump");
  result_report(keys_of(keys, &s, across, "largest_plastic_strain"), o.strain, 2.86, BENCHMARK,
                "the published range is 2.47 to 3.25, and grows with refinement");
  result_report(keys_of(keys, &s, across, "particle_steps_a_second"),
                (double)s.n * (double)o.steps / o.seconds, NAN, "-", "depends on the machine");
  rod_destroy(&s);
  return failed;
}

static int validate(int full) {
  const int failed = validate_rod(6);
  return full ? failed + validate_rod(8) : failed;
}

#endif
