/* Part of air_air_tube.c: the figures of every run, and their bounds. */
#ifndef EXAMPLES_AIR_AIR_TUBE_VALIDATE_H
#define EXAMPLES_AIR_AIR_TUBE_VALIDATE_H

#define THESIS "Zisis 2017 section 5.2.1"
#define INDEPENDENT "independent program"
#define EXACT "exact Riemann solution"
#define FINDING "the source plots it, with the finding that number smoothing is better"

/* What a run is held to; the errors of an independent program, 0: none is known. */
typedef struct bound {
  double spacing;
  int equal;
  int32_t smoothing;
  double a_rho;
  double dt;                /* 0: the stable step */
  double l1_rho, high, low; /* at most; P at the contact within [low, high] per cent; 0: no bound */
  tube_errors known;
} bound;

static const bound bounds[] = {
    {.0025, 0, SPH_SMOOTHING_NUMBER, 0.5, 5e-5, 3.9e-3, 19.0, -4.0, {3.8e-3, 4.7e-3, 5.4e-3, 0.0}},
    {.0025, 0, SPH_SMOOTHING_MASS, 0.5, 5e-5, 0.0, 0.0, 0.0, {5.3e-3, 7.0e-3, 8.0e-3, 0.0}},
    {.0025, 0, SPH_SMOOTHING_VOLUME, 0.5, 5e-5, 0.0, 0.0, 0.0, {6.1e-3, 7.8e-3, 9.2e-3, 0.0}},
    {.01, 1, SPH_SMOOTHING_NUMBER, 0.5, 5e-5, 4.9e-3, 4.0, -4.0, {4.8e-3, 5.0e-3, 1.5e-2, 0.0}},
    {.01, 1, SPH_SMOOTHING_MASS, 0.5, 5e-5, 4.9e-3, 4.0, -4.0, {0.0, 0.0, 0.0, 0.0}},
    {.01, 1, SPH_SMOOTHING_VOLUME, 0.5, 5e-5, 0.0, 0.0, 0.0, {0.0, 0.0, 0.0, 0.0}},
    {.000625, 0, SPH_SMOOTHING_NUMBER, 0.5, 2e-5, 0.0, 0.0, 0.0, {1.2e-3, 1.5e-3, 1.4e-3, 0.0}},
};

static void report(const char *keys, double measured, double known, const char *reason) {
  if (known > 0.0)
    result_report(keys, measured, known, INDEPENDENT, reason);
  else
    result_report(keys, measured, NAN, THESIS, FINDING);
}

static int check_contact(const outcome *o, const bound *b) {
  char keys[TUBE_KEYS];
  int failed = 0;
  if (b->high == 0.0) {
    result_report(tube_keys(keys, &o->t, "contact_high_percent"), o->contact.highest, NAN, THESIS,
                  FINDING);
    result_report(tube_keys(keys, &o->t, "contact_low_percent"), o->contact.lowest, NAN, THESIS,
                  FINDING);
    return 0;
  }
  failed += result_bound(tube_keys(keys, &o->t, "contact_high_percent"), o->contact.highest, -1,
                         b->high, INDEPENDENT);
  return failed + result_bound(tube_keys(keys, &o->t, "contact_low_percent"), o->contact.lowest, 1,
                               b->low, INDEPENDENT);
}

/* Within twice the smoothing length behind it. */
static int check_shock(const outcome *o, const bound *b) {
  char keys[TUBE_KEYS];
  const double exact = x0 + end_time * o->exact.solution.head[1];
  const double h = 1.2 * b->spacing * 0.125 / o->exact.solution.rho[1];
  tube_keys(keys, &o->t, "shock_position");
  if (b->smoothing == SPH_SMOOTHING_NUMBER)
    return result_line(keys, o->shock, exact, EXACT, 2.0 * h, 0);
  result_report(keys, o->shock, exact, EXACT, FINDING);
  return 0;
}

static int validate_run(const bound *b, double *l1_rho) {
  char keys[TUBE_KEYS];
  tube_setup s = air_air(b->spacing, b->equal, b->smoothing, b->a_rho);
  s.dt = b->dt;
  outcome o = run(s);
  int failed = 0;
  if (b->l1_rho > 0.0)
    failed += result_bound(tube_keys(keys, &o.t, "L1_rho"), o.l1.rho, -1, b->l1_rho, INDEPENDENT);
  else
    report(tube_keys(keys, &o.t, "L1_rho"), o.l1.rho, b->known.rho, FINDING);
  report(tube_keys(keys, &o.t, "L1_p"), o.l1.p, b->known.p, "beside the density, no bound is set");
  report(tube_keys(keys, &o.t, "L1_v"), o.l1.v, b->known.v, "beside the density, no bound is set");
  failed += check_contact(&o, b);
  failed += result_bound(tube_keys(keys, &o.t, "energy_drift"), o.drift, -1, 1e-6, EXACT);
  failed += check_shock(&o, b);
  *l1_rho = o.l1.rho;
  tube_destroy(&o.t);
  return failed;
}

/* Without mass flux the pressure has a spike at the contact. */
static int validate_spike(double spacing, int equal) {
  char keys[TUBE_KEYS];
  outcome o = run(air_air(spacing, equal, SPH_SMOOTHING_NUMBER, 0.0));
  const int failed = result_bound(tube_keys(keys, &o.t, "contact_high_percent"), o.contact.highest,
                                  1, 50.0, THESIS);
  tube_destroy(&o.t);
  return failed;
}

/* The solver of the reference itself. */
static int validate_reference(void) {
  const tube_setup s = air_air(0.0025, 0, SPH_SMOOTHING_NUMBER, 0.5);
  tube t;
  tube_create(&t, &s);
  const tube_riemann r = tube_solve(t.ctx, &s.region[0].state, &s.region[1].state, x0, s.end);
  const double measured[] = {r.solution.p, r.solution.v[0], r.solution.rho[0], r.solution.rho[1]};
  static const double known[] = {0.293945, 0.841195, 0.479689, 0.229806};
  static const char *const names[] = {"p", "v", "rho_left", "rho_right"};
  char keys[TUBE_KEYS];
  int failed = 0;
  for (int k = 0; k < 4; ++k) {
    snprintf(keys, sizeof keys, "case=air_air_tube quantity=exact_%s", names[k]);
    failed += result_line(keys, measured[k], known[k], INDEPENDENT, 1e-6, 0);
  }
  tube_destroy(&t);
  return failed;
}

static int validate(void) {
  double l1[sizeof bounds / sizeof *bounds];
  int failed = validate_reference();
  for (size_t k = 0; k < sizeof bounds / sizeof *bounds; ++k)
    failed += validate_run(&bounds[k], &l1[k]);
  failed += result_bound("case=air_air_tube quantity=L1_rho_mass_over_number layout=equal_spacing",
                         l1[1] / l1[0], 1, 1.0, THESIS);
  failed += result_bound("case=air_air_tube quantity=L1_rho_volume_over_mass layout=equal_spacing",
                         l1[2] / l1[1], 1, 1.0, THESIS);
  failed += result_bound("case=air_air_tube quantity=L1_rho_n400_over_n1600 layout=equal_spacing",
                         l1[0] / l1[6], 1, 2.0, "of first order it would be 4, at jumps less");
  failed += validate_spike(0.0025, 0);
  return failed + validate_spike(0.01, 1);
}

#endif
