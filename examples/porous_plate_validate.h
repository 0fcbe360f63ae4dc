/* Part of porous_plate.c: what He 2015, 5.4 says about his pictures, and symmetry. */
#ifndef EXAMPLES_POROUS_PLATE_VALIDATE_H
#define EXAMPLES_POROUS_PLATE_VALIDATE_H

#define T54 "He 2015 section 5.4"

enum { KEYS = 200 };

static void make_keys(char keys[KEYS], const char *quantity, double dp, const outcome *r) {
  snprintf(keys, KEYS, "case=porous_plate quantity=%s dp=%g n=%lld scheme=rkc cfl=2.5", quantity,
           dp, (long long)r->particles);
}

static int above(const char *quantity, double dp, const outcome *r, double measured, double bound) {
  char keys[KEYS];
  make_keys(keys, quantity, dp, r);
  return result_bound(keys, measured, 1, bound, T54);
}

/* The quarter: it completes, and the holes rank as published. */
static int validate_quarter(double dp) {
  static const char reason[] = "only pictures are published";
  const outcome r = run_once(dp, 1, 0);
  char keys[KEYS];
  int failed = 0;
  make_keys(keys, "completed", dp, &r);
  failed += result_line(keys, r.completed, 1.0, T54, 0.0, 0);
  make_keys(keys, "mean_strain", dp, &r);
  failed += result_line(keys, r.strain, 0.2, T54, 1e-6, 0);
  failed += above("hole_5_over_hole_6", dp, &r, r.centre / r.side_hole, 1.0);
  failed += above("hole_1_over_hole_6", dp, &r, r.corner / r.side_hole, 1.0);
  failed += above("hole_6_over_hole_2", dp, &r, r.side_hole / r.top_hole, 1.0);
  failed += above("tension_above_hole_5_over_E", dp, &r, r.rim / young, 0.0);
  make_keys(keys, "hole_5", dp, &r);
  result_report(keys, r.centre, NAN, T54, reason);
  make_keys(keys, "hole_1", dp, &r);
  result_report(keys, r.corner, NAN, T54, reason);
  make_keys(keys, "hole_6", dp, &r);
  result_report(keys, r.side_hole, NAN, T54, reason);
  make_keys(keys, "hole_2", dp, &r);
  result_report(keys, r.top_hole, NAN, T54, reason);
  make_keys(keys, "seconds", dp, &r);
  result_report(keys, r.seconds, NAN, T54, "depends on the machine");
  return failed;
}

/* Largest difference between a particle of the whole plate and its image in an axis, in m. */
static double asymmetry(const plate *p) {
  double most = 0.0;
  for (int64_t i = 0; i < p->n; ++i)
    for (int a = 0; a < 2; ++a) {
      double image[2] = {p->rest[2 * i], p->rest[2 * i + 1]};
      image[a] = -image[a];
      const int64_t j = nearest(p, image[0], image[1]);
      for (int b = 0; b < 2; ++b) {
        const double mirrored = a == b ? -p->x[2 * j + b] : p->x[2 * j + b];
        most = fmax(most, fabs(p->x[2 * i + b] - mirrored));
      }
    }
  return most;
}

/* The whole plate without ghosts stays symmetric, and agrees with the quarter. */
static int validate_symmetry(double dp, double until) {
  plate whole, quarter;
  char keys[KEYS];
  double apart = 0.0;
  driven_create(&whole, dp, 1, 1);
  driven_create(&quarter, dp, 0, 1);
  const outcome r = run(&whole, until, 0);
  (void)run(&quarter, until, 0);
  for (int64_t i = 0; i < quarter.n; ++i) {
    const int64_t j = nearest(&whole, quarter.rest[2 * i], quarter.rest[2 * i + 1]);
    for (int a = 0; a < 2; ++a)
      apart = fmax(apart, fabs(quarter.x[2 * i + a] - whole.x[2 * j + a]));
  }
  make_keys(keys, "asymmetry_of_the_whole", dp, &r);
  const int failed = result_bound(keys, asymmetry(&whole) / side, -1, 1e-6, "symmetry");
  make_keys(keys, "quarter_from_whole", dp, &r);
  plate_destroy(&whole);
  plate_destroy(&quarter);
  return failed + result_bound(keys, apart / side, -1, 1e-6, "symmetry");
}

/* With the published viscosity and artificial stress: how far it goes. */
static void report_published(double dp) {
  char keys[KEYS];
  const outcome r = run_once(dp, 0, 0);
  make_keys(keys, "strain_reached_alpha_2.5_epsilon_0.3", dp, &r);
  result_report(keys, r.strain, 0.2, T54, "buckles, then tears at the rims of the corner holes");
}

static int validate(int full) {
  const double dp = full ? 0.0124 : 0.025;
  const int failed = validate_quarter(dp) + validate_symmetry(0.05, end_time);
  report_published(0.025);
  return failed;
}

#endif
