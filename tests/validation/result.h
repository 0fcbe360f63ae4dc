/* Machine-readable result lines of the validation programs:
 *
 *   RESULT case=elastic_bar quantity=velocity_L1 n=250 measured=0.0888 reference=0.0888
 *          source="He 2015 table 5.1" tolerance=0.01 verdict=pass        (on one line)
 *
 * A program adds up what result_line() returns and ends with failures != 0. */
#ifndef SPH_VALIDATION_RESULT_H
#define SPH_VALIDATION_RESULT_H

#include <math.h>
#include <stdio.h>

/* Four decimals, as the published tables print; four significant digits for small numbers. */
static inline void result_number(const char *key, double value) {
  const double size = fabs(value);
  printf(size == 0.0 || size >= 0.01 ? " %s=%.4f" : " %s=%.4g", key, value);
}

static inline void result_head(const char *keys, double measured, double reference,
                               const char *source) {
  printf("RESULT %s", keys);
  result_number("measured", measured);
  result_number("reference", reference);
  printf(" source=\"%s\"", source);
}

/* Compare and print; 1 on failure, 0 on success. keys: "case=NAME quantity=NAME ...". The
 * tolerance is absolute, or relative to the reference when `relative` is not 0. NaN fails. */
static inline int result_line(const char *keys, double measured, double reference,
                              const char *source, double tolerance, int relative) {
  const double allowed = relative ? tolerance * fabs(reference) : tolerance;
  const int passed = fabs(measured - reference) <= allowed;
  result_head(keys, measured, reference, source);
  printf(" tolerance=%g verdict=%s\n", tolerance, passed ? "pass" : "fail");
  fflush(stdout);
  return !passed;
}

/* A figure shown beside the published one without a verdict; `reason` says why. */
static inline void result_report(const char *keys, double measured, double reference,
                                 const char *source, const char *reason) {
  result_head(keys, measured, reference, source);
  printf(" reason=\"%s\" verdict=report\n", reason);
  fflush(stdout);
}

#endif
