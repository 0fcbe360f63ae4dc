/* Part of twisting_column.c: the period of a small twist; conservation and no hourglass pattern in
 * a large one. */
#ifndef EXAMPLES_TWISTING_COLUMN_VALIDATE_H
#define EXAMPLES_TWISTING_COLUMN_VALIDATE_H

/* Period of the small twist: twice the time between two zeros of the angle. */
static int validate_period(int64_t n) {
  column c;
  char keys[128];
  double dt, before = 0.0, zero[2] = {0.0, 0.0};
  int found = 0;
  column_create(&c, n, 1.0, 0.1);
  need(c.ctx, sph_total_lagrangian_time_step(c.tl, c.set, &dt));
  for (int64_t k = 1; found < 2 && (double)k * dt < 2.0 * torsion_period(); ++k) {
    need(c.ctx, sph_total_lagrangian_step(c.tl, c.set, (double)(k - 1) * dt, dt));
    const double angle = twist_angle(&c, before);
    if (k > 1 && before * angle < 0.0) zero[found++] = ((double)k - angle / (angle - before)) * dt;
    before = angle;
  }
  column_destroy(&c);
  snprintf(keys, sizeof keys, "case=twisting_column quantity=torsion_period n=%d", (int)n);
  return result_line(keys, found == 2 ? 2.0 * (zero[1] - zero[0]) : NAN, torsion_period(),
                     "Saint-Venant torsion", 0.03, 1);
}

/* Root mean square of the fourth differences of u along the column, over 16 and the spacing. */
static double pattern(const column *c) {
  const double *x = field(c->ctx, c->set, SPH_FIELD_X), *X = field(c->ctx, c->set, SPH_FIELD_X0);
  const int64_t layer = 3 * c->n * c->n, n = 3 * sph_particles_count(c->set);
  double sum = 0.0;
  for (int64_t k = 2 * layer; k < n - 2 * layer; ++k) {
    double u[5];
    for (int64_t s = 0; s < 5; ++s) u[s] = x[k + (s - 2) * layer] - X[k + (s - 2) * layer];
    const double d = (u[0] - 4.0 * u[1] + 6.0 * u[2] - 4.0 * u[3] + u[4]) / 16.0;
    sum += d * d;
  }
  return sqrt(3.0 * sum / (double)(n - 4 * layer)) / c->dp;
}

typedef struct outcome {
  double energy, momentum, angular, twist, pattern; /* largest of the run */
} outcome;

static outcome large_twist(int64_t n, double hourglass) {
  const double duration = 1.2 * torsion_period();
  outcome r = {.energy = 0.0};
  column c;
  double dt, twist = 0.0;
  column_create(&c, n, 105.0, hourglass);
  need(c.ctx, sph_total_lagrangian_time_step(c.tl, c.set, &dt));
  const int64_t steps = (int64_t)ceil(duration / dt);
  const sph_total_lagrangian_ledger start = balance(&c, 0.0);
  const double scale = sqrt(2.0 * start.mass * start.kinetic); /* of a momentum */
  for (int64_t k = 1; k <= steps; ++k) {
    need(c.ctx, sph_total_lagrangian_step(c.tl, c.set, (double)(k - 1) * dt, dt));
    twist = twist_angle(&c, twist);
    r.twist = fmax(r.twist, fabs(twist));
    if (k % 20 != 0 && k != steps) continue;
    const sph_total_lagrangian_ledger now = balance(&c, (double)k * dt);
    double turn = 0.0, push = 0.0;
    for (int a = 0; a < 3; ++a) {
      turn += fabs(now.angular_momentum[a] - start.angular_momentum[a]);
      push += fabs(now.momentum[a] - start.momentum[a]);
    }
    r.energy = fmax(r.energy, fabs(energy_of(&now) / energy_of(&start) - 1.0));
    r.momentum = fmax(r.momentum, push / scale);
    r.angular = fmax(r.angular, turn / fabs(start.angular_momentum[1]));
    r.pattern = fmax(r.pattern, pattern(&c));
  }
  column_destroy(&c);
  return r;
}

static int bound(const char *quantity, int64_t n, double measured, double limit,
                 const char *source) {
  char keys[128];
  snprintf(keys, sizeof keys, "case=twisting_column quantity=%s n=%d", quantity, (int)n);
  return result_bound(keys, measured, -1, limit, source);
}

static int validate_spacing(int64_t n) {
  int failed = validate_period(n);
  const outcome r = large_twist(n, 0.1), bare = large_twist(n, 0.0);
  char keys[128];
  failed += bound("energy_drift", n, r.energy, 1e-3, "leapfrog");
  failed += bound("momentum", n, r.momentum, 1e-12, "antisymmetric forces");
  failed += bound("angular_momentum_drift", n, r.angular, 1e-12, "frame-indifferent energy");
  failed += bound("hourglass_pattern", n, r.pattern, 0.01, "smooth fields");
  snprintf(keys, sizeof keys, "case=twisting_column quantity=pattern_without_control n=%d", (int)n);
  result_report(keys, bare.pattern, 0.01, "smooth fields", "for comparison");
  return failed;
}

static int validate(int full) {
  const int failed = validate_spacing(6);
  return full ? failed + validate_spacing(10) : failed;
}

#endif
