/* Part of wasserstein_tube.c: every distance and rate, and their bounds. */
#ifndef EXAMPLES_WASSERSTEIN_TUBE_VALIDATE_H
#define EXAMPLES_WASSERSTEIN_TUBE_VALIDATE_H

#define THESIS "Zisis 2017 section 4.5.2"
#define THEORY "theory: -1"

/* A rate is judged where the coarser run of the coarser pair has this many particles. */
enum { JUDGED_FROM = 225 };

static int check_rate(const char *quantity, double measured, int k) {
  char keys[128];
  snprintf(keys, sizeof keys, "case=wasserstein_tube quantity=%s n=%d", quantity, sizes[k + 1]);
  if (sizes[k - 1] >= JUDGED_FROM) return result_line(keys, measured, -1.0, THEORY, 0.15, 0);
  result_report(keys, measured, -1.0, THEORY, "too few particles to resolve the waves");
  return 0;
}

static int validate(void) {
  static const double initial[] = {1.44444e-2, 5.55556e-3, 2.88889e-3,
                                   1.11111e-3, 5.55556e-4, 2.77778e-4};
  static const double rates[] = {-1.043, -0.943, -1.043, -1.000, -1.000};
  double distance[SIZES - 1][TIMES];
  char keys[128];
  int failed = 0;
  study(distance);
  for (int k = 0; k + 1 < SIZES; ++k) {
    snprintf(keys, sizeof keys, "case=wasserstein_tube quantity=initial_distance n=%d",
             sizes[k + 1]);
    failed += result_line(keys, distance[k][0], initial[k], "closed form of the cells", 4e-6, 1);
    if (k == 0) continue;
    snprintf(keys, sizeof keys, "case=wasserstein_tube quantity=initial_rate n=%d", sizes[k + 1]);
    failed += result_line(keys, rate(distance[k - 1][0], distance[k][0], k), rates[k - 1],
                          "closed form of the cells", 5.1e-4, 0);
    failed +=
        check_rate("final_rate", rate(distance[k - 1][TIMES - 1], distance[k][TIMES - 1], k), k);
    failed +=
        check_rate("largest_rate", rate(largest(distance[k - 1]), largest(distance[k]), k), k);
  }
  return failed;
}

#endif
