/* Part of porous_plate.c: what He 2015, 5.4 says about his pictures, and symmetry.
 *
 * He moves the kernels with the particles (Hooke's law as a rate, Jaumann). Such runs agree with
 * the total-Lagrangian one as long as they live, but tear at the stretched rims of the corner
 * holes, by the tensile instability; how far they come is reported. Less of it: equal masses, more
 * artificial stress and viscosity, h = 1.5 dp. */
#ifndef EXAMPLES_POROUS_PLATE_VALIDATE_H
#define EXAMPLES_POROUS_PLATE_VALIDATE_H

#define T54 "He 2015 section 5.4"

enum { KEYS = 200 };

static void make_keys(char keys[KEYS], const char *quantity, const plate_options *o,
                      const outcome *r) {
  snprintf(keys, KEYS, "case=porous_plate quantity=%s kernels=%s dp=%g n=%lld scheme=rkc cfl=%g",
           quantity, o->motion == PLATE_TOTAL ? "reference" : "moving", o->dp,
           (long long)r->particles, o->cfl);
}

static int above(const char *quantity, const plate_options *o, const outcome *r, double measured,
                 double bound) {
  char keys[KEYS];
  make_keys(keys, quantity, o, r);
  return result_bound(keys, measured, 1, bound, T54);
}

/* No figures are published: those of a run with the double spacing stand in. */
static int compare_hole(const char *quantity, const plate_options *o, const outcome *r,
                        double measured, double coarse) {
  char keys[KEYS];
  make_keys(keys, quantity, o, r);
  return result_line(keys, measured, coarse, "the double spacing", 0.02, 0);
}

/* The quarter: it completes, the holes rank as published, and the spacing does not matter. */
static int validate_quarter(const plate_options *o, const outcome *coarse, outcome *fine) {
  const outcome r = run_once(o, 0);
  *fine = r;
  char keys[KEYS];
  int failed = 0;
  make_keys(keys, "completed", o, &r);
  failed += result_line(keys, r.completed, 1.0, T54, 0.0, 0);
  make_keys(keys, "mean_strain", o, &r);
  failed += result_line(keys, r.strain, 0.2, T54, 1e-6, 0);
  failed += above("hole_5_over_hole_6", o, &r, r.centre / r.side_hole, 1.0);
  failed += above("hole_1_over_hole_6", o, &r, r.corner / r.side_hole, 1.0);
  failed += above("hole_6_over_hole_2", o, &r, r.side_hole / r.top_hole, 1.0);
  failed += above("tension_above_hole_5_over_E", o, &r, r.rim / young, 0.0);
  failed += compare_hole("hole_5", o, &r, r.centre, coarse->centre);
  failed += compare_hole("hole_1", o, &r, r.corner, coarse->corner);
  failed += compare_hole("hole_6", o, &r, r.side_hole, coarse->side_hole);
  return failed + compare_hole("hole_2", o, &r, r.top_hole, coarse->top_hole);
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
static int validate_symmetry(double dp, outcome *part) {
  plate_options coarse = total, all = total;
  porous whole, quarter;
  char keys[KEYS];
  double apart = 0.0;
  coarse.dp = all.dp = dp;
  all.whole = 1;
  porous_create(&whole, &all);
  porous_create(&quarter, &coarse);
  const outcome r = run(&whole.p, end_time, 0);
  *part = run(&quarter.p, end_time, 0);
  for (int64_t i = 0; i < quarter.p.n; ++i) {
    const int64_t j = nearest(&whole.p, quarter.p.rest[2 * i], quarter.p.rest[2 * i + 1]);
    for (int a = 0; a < 2; ++a)
      apart = fmax(apart, fabs(quarter.p.x[2 * i + a] - whole.p.x[2 * j + a]));
  }
  make_keys(keys, "asymmetry_of_the_whole", &all, &r);
  int failed = result_bound(keys, r.completed ? asymmetry(&whole.p) : NAN, -1, 1e-6, "symmetry");
  make_keys(keys, "quarter_from_whole", &coarse, part);
  failed += result_bound(keys, part->completed ? apart : NAN, -1, 1e-6, "symmetry");
  porous_destroy(&whole);
  porous_destroy(&quarter);
  return failed;
}

/* Kernels that move, as published and as it takes to get to the end. */
static void report_moving(const outcome *coarse) {
  char keys[KEYS];
  plate_options o = total;
  o.motion = PLATE_MOVING;
  o.constant_mass = 1;
  o.h_ratio = 1.5;
  o.cfl = 2.5;
  o.stages = 8;
  for (int stiff = 0; stiff < 2; ++stiff) {
    o.viscosity = stiff ? 5.0 : 2.5;
    o.artificial = stiff ? 0.5 : 0.3;
    const outcome r = run_once(&o, 0);
    make_keys(keys, stiff ? "strain_reached_alpha_5_epsilon_0.5" : "strain_reached_as_published",
              &o, &r);
    result_report(keys, r.strain, 0.2, T54, "tensile instability at the rims of the corner holes");
    make_keys(keys, "hole_5", &o, &r);
    if (r.completed) result_report(keys, r.centre, coarse->centre, "kernels at rest", "other law");
    make_keys(keys, "hole_1", &o, &r);
    if (r.completed) result_report(keys, r.corner, coarse->corner, "kernels at rest", "other law");
  }
}

/* As many particles as He's. */
static int validate_fine(const outcome *coarse) {
  outcome fine;
  plate_options o = total;
  o.dp = 0.0124;
  o.cfl = 1.0;
  return validate_quarter(&o, coarse, &fine);
}

static int validate(int full) {
  outcome coarse, middle;
  int failed = validate_symmetry(0.05, &coarse) + validate_quarter(&total, &coarse, &middle);
  report_moving(&coarse);
  if (!full) return failed;
  failed += validate_symmetry(0.025, &coarse);
  return failed + validate_fine(&middle);
}

#endif
