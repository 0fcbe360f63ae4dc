/* Part of smooth_wave.c: every figure with its reference, and the rates.
 *
 * He 2015 prints no errors for this case. The figures by N come from an independent 1-D program
 * that was written from the same equations; they are met to one unit of its last digit. */
#ifndef EXAMPLES_SMOOTH_WAVE_VALIDATE_H
#define EXAMPLES_SMOOTH_WAVE_VALIDATE_H

enum { KEYS = 200, RATE_RUNS = 6 };

#define RK4 SPH_INTEGRATOR_RK4
#define RKC SPH_INTEGRATOR_RKC
#define INDEPENDENT "independent 1-D program"

typedef struct figure {
  int boundary;
  int32_t scheme;
  double cfl;
  int n;
  double l1, l2, digit; /* of the stress; digit: one unit of the last one, 0: report only */
  const char *reason;
} figure;

#define NOT_STABLE "RKC is not stable on the imaginary axis: inviscid waves grow"
#define HELD_BY_VALUE "shows how the end is held: by value at every stage it is .1141 and .1091"

static const figure figures[] = {
    {SECOND_ORDER, RKC, 1.0, 20, .078, .080, 1e-3, NULL},
    {SECOND_ORDER, RKC, 1.0, 40, .0206, .0234, 1e-4, NULL},
    {SECOND_ORDER, RKC, 1.0, 80, .0055, .0070, 1e-4, NULL},
    {SECOND_ORDER, RKC, 1.0, 160, .0016, .0022, 1e-4, NULL},
    {SECOND_ORDER, RKC, 1.0, 250, .0009, .0011, 1e-4, NULL},
    {SECOND_ORDER, RKC, 1.0, 500, .0020, .0029, 0.0, NOT_STABLE},
    {SECOND_ORDER, RKC, 1.0, 1000, .31, .59, 0.0, NOT_STABLE},
    {SECOND_ORDER, RKC, 0.5, 500, .00019, .00037, 1e-5, NULL},
    {SECOND_ORDER, RKC, 0.5, 1000, .00005, .00011, 1e-5, NULL},
    {SECOND_ORDER, RK4, 1.0, 500, .00020, .00039, 1e-5, NULL},
    {SECOND_ORDER, RK4, 1.0, 1000, .00005, .00012, 1e-5, NULL},
    {PLAIN, RKC, 1.0, 40, .075, .089, 1e-3, NULL},
    {PLAIN, RKC, 1.0, 80, .034, .047, 1e-3, NULL},
    {PLAIN, RKC, 1.0, 160, .0149, .0247, 1e-4, NULL},
    {PLAIN, RKC, 1.0, 250, .0092, .0160, 1e-4, NULL},
    {HELD, RKC, 1.0, 20, .115, .109, 0.0, HELD_BY_VALUE},
    {HELD, RKC, 1.0, 40, .048, .045, 1e-3, NULL},
    {HELD, RKC, 1.0, 80, .0239, .0216, 1e-4, NULL},
    {HELD, RKC, 1.0, 160, .0122, .0109, 1e-4, NULL},
    {HELD, RKC, 1.0, 250, .0080, .0071, 1e-4, NULL},
};

static void make_keys(char keys[KEYS], const char *quantity, int boundary, int32_t scheme,
                      double cfl, int n, int stages) {
  static const char *const names[] = {"?", "second_order_ghosts", "plain_ghosts", "held_end"};
  int used = snprintf(keys, KEYS, "case=smooth_wave quantity=%s", quantity);
  if (n > 0) used += snprintf(keys + used, (size_t)(KEYS - used), " n=%d", n);
  snprintf(keys + used, (size_t)(KEYS - used), " scheme=%s cfl=%.3g stages=%d form=%s boundary=%s",
           scheme == RKC ? "rkc" : "rk4", cfl, stages, boundary == HELD ? "difference" : "summed",
           names[boundary]);
}

static int validate_figure(const figure *f) {
  const errors e = run(f->n, f->boundary, f->scheme, f->cfl);
  const double measured[] = {e.stress.l1, e.stress.l2}, reference[] = {f->l1, f->l2};
  int failed = 0;
  for (int k = 0; k < 2; ++k) {
    char keys[KEYS];
    make_keys(keys, k == 0 ? "stress_L1" : "stress_L2", f->boundary, f->scheme, f->cfl, f->n,
              e.stages);
    if (f->digit > 0.0)
      failed += result_line(keys, measured[k], reference[k], INDEPENDENT, f->digit, 0);
    else
      result_report(keys, measured[k], reference[k], INDEPENDENT, f->reason);
  }
  return failed;
}

/* Rates of stress and velocity in both norms must reach the bounds. He's rates beside those of the
 * boundary that is likely to be his. */
static int validate_rates(int boundary, int32_t scheme, double bound1, double bound2) {
  static const double n[RATE_RUNS] = {20, 40, 60, 80, 100, 160};
  static const char *const quantity[] = {"rate_stress_L1", "rate_stress_L2", "rate_velocity_L1",
                                         "rate_velocity_L2"};
  double error[4][RATE_RUNS];
  char keys[KEYS];
  int failed = 0;
  int32_t stages = 0;
  for (int k = 0; k < RATE_RUNS; ++k) {
    const errors e = run((int)n[k], boundary, scheme, 1.0);
    error[0][k] = e.stress.l1;
    error[1][k] = e.stress.l2;
    error[2][k] = e.velocity.l1;
    error[3][k] = e.velocity.l2;
    stages = e.stages;
  }
  for (int q = 0; q < 4; ++q) {
    const double rate = convergence_rate(RATE_RUNS, n, error[q]);
    make_keys(keys, quantity[q], boundary, scheme, 1.0, 0, stages);
    failed += result_bound(keys, rate, 1, q % 2 == 0 ? bound1 : bound2, "least rate wanted");
    if (boundary == HELD && scheme == RKC && q < 2)
      result_report(keys, rate, q == 0 ? 1.0 : 1.5, "He 2015 fig. 5.7",
                    q == 0 ? "a rate read from a figure"
                           : "1.5 is what an L2 norm without 1/sqrt(N) would show");
  }
  return failed;
}

static int validate(void) {
  int failed = 0;
  for (size_t k = 0; k < sizeof figures / sizeof *figures; ++k)
    failed += validate_figure(&figures[k]);
  failed += validate_rates(SECOND_ORDER, RKC, 1.7, 1.7);
  failed += validate_rates(SECOND_ORDER, RK4, 1.7, 1.7);
  failed += validate_rates(PLAIN, RKC, 0.95, 0.9);
  failed += validate_rates(PLAIN, RK4, 0.95, 0.9);
  failed += validate_rates(HELD, RKC, 0.95, 0.9);
  failed += validate_rates(HELD, RK4, 0.95, 0.9);
  return failed;
}

#endif
