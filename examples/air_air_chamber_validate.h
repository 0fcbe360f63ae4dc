/* Part of air_air_chamber.c: the figures of every run, and their bounds. */
#ifndef EXAMPLES_AIR_AIR_CHAMBER_VALIDATE_H
#define EXAMPLES_AIR_AIR_CHAMBER_VALIDATE_H

#define THESIS "Zisis 2017 section 5.4.1"
#define INDEPENDENT "independent program"
#define VOLUMES "finite volumes"
#define FINDING "the source plots it, with the finding that number smoothing is better"

/* The errors of the independent program with number smoothing. */
typedef struct known {
  int cells;
  double rho, p, e;
} known;

static const known knowns[] = {
    {25, 0.0251, 0.0272, 0.079}, {50, 0.0081, 0.0103, 0.028}, {100, 0.0055, 0.0054, 0.013}};

static const char *keys_of(char keys[160], const outcome *o, int32_t smoothing,
                           const char *quantity) {
  snprintf(keys, 160, "case=air_air_chamber quantity=%s n_l=%g smoothing=%s", quantity,
           1.0 / o->s.dp, smoothing_name[smoothing]);
  return keys;
}

/* The solver of the reference against another one, 300 cells a unit; away from the waves. */
static int check_reference(const euler *g) {
  static const double at[][3] = {{0.025, 0.4898, 0.3043}, {0.225, 0.4528, 0.2670},
                                 {0.425, 0.3655, 0.1869}, {0.625, 0.4006, 0.2177},
                                 {0.825, 0.4135, 0.2295}, {0.875, 0.4106, 0.2270},
                                 {0.975, 0.1972, 0.2278}, {1.175, 0.2048, 0.2426},
                                 {1.375, 0.2213, 0.2761}, {1.475, 0.1250, 0.1000}};
  char keys[120];
  int failed = 0;
  for (size_t k = 0; k < sizeof at / sizeof *at; ++k) {
    const double *q = g->cell[(int)(at[k][0] / g->dx)].q;
    snprintf(keys, sizeof keys, "case=air_air_chamber quantity=reference_rho x=%g", at[k][0]);
    failed += result_line(keys, q[0], at[k][1], "another HLLC program", 0.0025, 0);
    snprintf(keys, sizeof keys, "case=air_air_chamber quantity=reference_p x=%g", at[k][0]);
    failed += result_line(keys, q[3], at[k][2], "another HLLC program", 0.0025, 0);
  }
  return failed;
}

/* The contact between the last particle of one gas and the first of the other, by their spacings,
 * which are as sqrt(m/rho): densities of 0.41 and 0.2 there, masses as 1 and 0.125. */
static double between(chamber_range c) {
  const double inside = sqrt(1.0 / 0.41), outside = sqrt(0.125 / 0.2);
  return (outside * c.inside + inside * c.outside) / (inside + outside);
}

/* Within twice the smoothing length behind the shock, and of the places that are known. */
static int check_waves(const outcome *o, const chamber_profile *axis,
                       const chamber_profile *diagonal) {
  const int32_t by_number = SPH_SMOOTHING_NUMBER;
  const double reach = 2.0 * 1.2 * o->s.dp * sqrt(0.125 / 0.22);
  char keys[160];
  int failed = 0;
  failed += result_line(keys_of(keys, o, by_number, "shock_axis"), o->shock,
                        chamber_shock(axis, shock_level(axis)), VOLUMES, reach, 0);
  failed += result_line(keys_of(keys, o, by_number, "shock_diagonal"), o->diagonal_shock,
                        chamber_shock(diagonal, shock_level(diagonal)), VOLUMES, reach, 0);
  failed += result_line(keys_of(keys, o, by_number, "contact_axis"), between(o->contact),
                        contact_place(axis), VOLUMES, o->s.dp, 0);
  failed += result_line(keys_of(keys, o, by_number, "contact_diagonal"), between(o->diagonal),
                        contact_place(diagonal), VOLUMES, 2.0 * o->s.dp, 0);
  return failed + result_bound(keys_of(keys, o, by_number, "overlap"), o->overlap, -1, 0.0, THESIS);
}

static int check_errors(const outcome *o, const known *k) {
  const int32_t by_number = SPH_SMOOTHING_NUMBER;
  char keys[160];
  int failed = 0;
  if (k->cells == 50) {
    failed +=
        result_bound(keys_of(keys, o, by_number, "error_rho"), o->rho, -1, 0.0085, INDEPENDENT);
    failed += result_bound(keys_of(keys, o, by_number, "error_p"), o->p, -1, 0.011, INDEPENDENT);
  } else {
    result_report(keys_of(keys, o, by_number, "error_rho"), o->rho, k->rho, INDEPENDENT,
                  "the bound is for N_l = 50");
    result_report(keys_of(keys, o, by_number, "error_p"), o->p, k->p, INDEPENDENT,
                  "the bound is for N_l = 50");
  }
  result_report(keys_of(keys, o, by_number, "error_e"), o->e, k->e, INDEPENDENT,
                "beside density and pressure, no bound is set");
  return failed;
}

static int check_run(const outcome *o, int32_t smoothing) {
  char keys[160];
  result_report(keys_of(keys, o, smoothing, "steps"), (double)o->s.ledger.steps, NAN, THESIS,
                "twice as many with mass smoothing, says the source, without its rule for steps");
  result_report(keys_of(keys, o, smoothing, "particle_steps_per_second"), plane_speed(&o->s), NAN,
                "one thread", "a speed");
  return result_bound(keys_of(keys, o, smoothing, "neighbours"), (double)o->s.neighbours, -1,
                      smoothing == SPH_SMOOTHING_NUMBER ? 100.0 : 200.0, INDEPENDENT) +
         result_bound(keys_of(keys, o, smoothing, "energy_drift"), plane_drift(&o->s), -1, 6e-5,
                      INDEPENDENT);
}

/* With mass and volume smoothing: the gases get into each other. */
static int validate_others(const chamber_profile *reference) {
  int failed = 0;
  for (int32_t k = SPH_SMOOTHING_MASS; k <= SPH_SMOOTHING_VOLUME; ++k) {
    char keys[160];
    const chamber_setup c = air_air(50, k);
    outcome o = run(&c, reference);
    failed += result_bound(keys_of(keys, &o, k, "overlap"), o.overlap, 1, 2.0, THESIS);
    result_report(keys_of(keys, &o, k, "error_rho"), o.rho, NAN, THESIS, FINDING);
    result_report(keys_of(keys, &o, k, "error_p"), o.p, NAN, THESIS, FINDING);
    failed += check_run(&o, k);
    plane_destroy(&o.s);
  }
  return failed;
}

static int validate_sizes(int sizes, const chamber_profile *axis, const chamber_profile *diagonal) {
  double rho[3], p[3];
  int failed = 0;
  for (int k = 0; k < sizes; ++k) {
    const chamber_setup c = air_air(knowns[k].cells, SPH_SMOOTHING_NUMBER);
    outcome o = run(&c, axis);
    failed += check_errors(&o, &knowns[k]);
    failed += check_waves(&o, axis, diagonal);
    failed += check_run(&o, SPH_SMOOTHING_NUMBER);
    rho[k] = o.rho;
    p[k] = o.p;
    plane_destroy(&o.s);
  }
  failed += result_bound("case=air_air_chamber quantity=error_rho_25_over_50", rho[0] / rho[1], 1,
                         2.0, INDEPENDENT);
  return failed + result_bound("case=air_air_chamber quantity=error_p_25_over_50", p[0] / p[1], 1,
                               2.0, INDEPENDENT);
}

static int validate(int full) {
  euler g;
  reference_create(&g, full ? 300 : 150);
  const chamber_profile axis = reference_bin(&g, 0), diagonal = reference_bin(&g, 1);
  int failed = check_reference(&g);
  euler_destroy(&g);
  failed += validate_sizes(full ? 3 : 2, &axis, &diagonal);
  return failed + validate_others(&axis);
}

#endif
