/* Part of gresho.c: errors of both viscosities, their fall, and what is kept. */
#ifndef EXAMPLES_GRESHO_VALIDATE_H
#define EXAMPLES_GRESHO_VALIDATE_H

#define EXACT "exact, Gresho and Chan 1990"
#define VISCOUS "vortex with the viscosity that a_v amounts to"

/* The kinematic viscosity of (4.27), h c a_v k_d/(d + 2) with k_2 = 0.665 for the Gaussian,
 * acting on approaching pairs, in a pure shear one half of all; c at the ring of the peak. */
static double viscosity_of(double cells, double a_v) {
  const double h = 1.2 / cells, p = 5.0 + 0.5, c = sqrt(5.0 / 3.0 * p);
  return 0.5 * a_v * c * h * 0.665 / 4.0;
}

/* dv/dt = nu (v'' + v'/r - v/r^2) from the vortex, by explicit differences: what is left of its
 * velocity in 0.18 < r < 0.22 at the end. */
static double viscous_peak(sph_context *ctx, double nu) {
  enum { N = 240 };
  const double dr = 0.6 / N, most = 0.2 * dr * dr / nu;
  const int64_t steps = (int64_t)(end_time / most) + 1;
  const double k = nu * end_time / (double)steps / (dr * dr);
  double r[N + 2], v[N + 2], next[N + 2], sum = 0.0, weight = 0.0;
  for (int i = 0; i < N + 2; ++i) r[i] = (i + 0.5) * dr;
  exact_vortex(ctx, N + 2, r, v, NULL);
  for (int64_t n = 0; n < steps; ++n) {
    for (int i = 0; i < N + 1; ++i) {
      const double before = i > 0 ? v[i - 1] : -v[0]; /* odd about the centre */
      next[i] = v[i] + k * (v[i + 1] - 2.0 * v[i] + before + 0.5 * dr / r[i] * (v[i + 1] - before) -
                            dr * dr / (r[i] * r[i]) * v[i]);
    }
    memcpy(v, next, (N + 1) * sizeof *v);
  }
  for (int i = 0; i < N; ++i)
    if (fabs(r[i] - 0.2) < 0.02) sum += v[i] * r[i], weight += r[i];
  return sum / weight;
}

static int validate_run(int cells, double viscosity, double *l1) {
  char keys[120], rest[60];
  plane s;
  vortex_create(&s, cells, viscosity);
  need(s.ctx, plane_run(&s, end_time));
  const errors e = measure(&s);
  snprintf(rest, sizeof rest, "n=%lld a_v=%g", (long long)s.n, viscosity);
  snprintf(keys, sizeof keys, "case=gresho quantity=L1_v %s", rest);
  result_report(keys, e.l1, 0.0, EXACT, "held by its fall with N and with the viscosity");
  snprintf(keys, sizeof keys, "case=gresho quantity=peak_v %s", rest);
  result_report(keys, e.peak, 0.95, EXACT, "mean over the ring of the peak; exact of the start");
  snprintf(keys, sizeof keys, "case=gresho quantity=peak_v_viscous %s", rest);
  const double left = viscous_peak(s.ctx, viscosity_of(cells, viscosity));
  int failed = 0;
  if (viscosity == 1.0)
    failed += result_line(keys, e.peak, left, VISCOUS, 0.1, 1);
  else
    result_report(keys, e.peak, left, VISCOUS, "what is lost beyond it is the particles' disorder");
  snprintf(keys, sizeof keys, "case=gresho quantity=energy_error %s", rest);
  if (viscosity == 1.0)
    failed += result_bound(keys, plane_drift(&s), -1, 1e-5, "kept, but for the steps");
  else
    result_report(keys, plane_drift(&s), 0.0, "kept, but for the steps", "noise that little damps");
  snprintf(keys, sizeof keys, "case=gresho quantity=momentum_error %s", rest);
  failed += result_bound(keys, s.ledger.momentum_error, -1, 1e-12, "kept");
  plane_destroy(&s);
  *l1 = e.l1;
  return failed;
}

static int validate(int full) {
  static const double viscosity[] = {1.0, 0.05};
  static const double n[] = {32.0, 64.0, 128.0};
  double l1[2][3];
  const int sizes = full ? 3 : 2;
  int failed = 0;
  for (int k = 0; k < 2; ++k) {
    char keys[120];
    for (int j = 0; j < sizes; ++j) failed += validate_run((int)n[j], viscosity[k], &l1[k][j]);
    snprintf(keys, sizeof keys, "case=gresho quantity=rate a_v=%g n=%g", viscosity[k],
             n[sizes - 1] * n[sizes - 1]);
    failed += result_bound(keys, convergence_rate(sizes, n, l1[k]), 1, 0.4,
                           "loss by a viscosity that goes as h, towards 1");
  }
  return failed + result_bound("case=gresho quantity=L1_a_v_1_over_0.05",
                               l1[0][sizes - 1] / l1[1][sizes - 1], 1, 1.0, "viscosity is loss");
}

#endif
