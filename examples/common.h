/* What the examples share: stopping at a failed call, error norms, least-squares rates. */
#ifndef EXAMPLES_COMMON_H
#define EXAMPLES_COMMON_H

#include <sph/sph.h>

#include "../tests/validation/result.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* End the program with the library's own sentence when a call fails. */
static inline void need(const sph_context *ctx, sph_status status) {
  if (status == SPH_OK) return;
  fprintf(stderr, "%s: %s\n", sph_status_name(status), sph_context_last_error(ctx));
  exit(2);
}

/* A field that the set has by now, or that is created by this. */
static inline double *field(const sph_context *ctx, sph_particles *set, int32_t id) {
  double *values;
  need(ctx, sph_particles_field(set, id, &values));
  return values;
}

static inline FILE *open_output(const char *path) {
  FILE *file = fopen(path, "w");
  if (file) return file;
  perror(path);
  exit(2);
}

/* Write a gnuplot script and run it where gnuplot is installed. */
static inline void draw(const char *path, const char *script) {
  FILE *file = open_output(path);
  fputs(script, file);
  fclose(file);
  char command[256];
  snprintf(command, sizeof command, "gnuplot %s", path);
  if (system("command -v gnuplot > /dev/null 2>&1") != 0)
    printf("No picture: gnuplot is missing (Debian package gnuplot-nox). It draws %s.\n", path);
  else
    printf(system(command) == 0 ? "Drawn by gnuplot from %s.\n" : "gnuplot fails on %s.\n", path);
}

/* Log hook: warnings of the library, for example about an unstable step. */
static inline void log_to_stderr(void *user, int32_t level, const char *text) {
  (void)user;
  if (level == SPH_LOG_ERROR) return; /* need() says it */
  fprintf(stderr, "libsph: %s\n", text);
}

/* A progress line on the terminal, of work that takes longer than two seconds. */
static inline void show_progress(double fraction, const char *what) {
  static sph_progress_line line;
  if (line.size == 0) sph_progress_line_init(&line, stderr);
  (void)sph_progress_terminal(&line, fraction, what);
}

/* L1 = sum|u - exact| / sum|exact|, L2 = sqrt(sum (u - exact)^2 / sum exact^2). */
typedef struct norms {
  double l1, l2;
} norms;

static inline norms relative_norms(int64_t n, const double *u, const double *exact) {
  double e1 = 0.0, e2 = 0.0, s1 = 0.0, s2 = 0.0;
  for (int64_t i = 0; i < n; ++i) {
    const double e = u[i] - exact[i];
    e1 += fabs(e);
    e2 += e * e;
    s1 += fabs(exact[i]);
    s2 += exact[i] * exact[i];
  }
  return (norms){e1 / s1, sqrt(e2 / s2)};
}

/* Least-squares slope p of log error = const - p log n. */
static inline double convergence_rate(int count, const double *n, const double *error) {
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (int k = 0; k < count; ++k) {
    const double x = log(n[k]), y = log(error[k]);
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  return -(count * sxy - sx * sy) / (count * sxx - sx * sx);
}

/* A figure that must not exceed `bound` (side < 0), or not fall below it (side > 0). */
static inline int result_bound(const char *keys, double measured, int side, double bound,
                               const char *source) {
  const int passed = side < 0 ? measured <= bound : measured >= bound;
  char all[256];
  snprintf(all, sizeof all, "%s bound=%s", keys, side < 0 ? "upper" : "lower");
  result_head(all, measured, bound, source);
  printf(" tolerance=0 verdict=%s\n", passed ? "pass" : "fail");
  fflush(stdout);
  return !passed;
}

#endif
