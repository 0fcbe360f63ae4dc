/* Part of laminate.c: the figures of the three plates, and their bounds.
 *
 * `long` has the twenty particles per mm of the source, three times 54 000. `validate` has four,
 * one row in a layer of epoxy, and checks what does not depend on resolution: conservation,
 * pressures. Layers can part by themselves only where one of epoxy is thicker than the support, 3.6
 * spacings: from fifteen per mm on. */
#ifndef EXAMPLES_LAMINATE_VALIDATE_H
#define EXAMPLES_LAMINATE_VALIDATE_H

#define THESIS "Zisis 2017 section 6.3"
#define RIEMANN "independent Riemann solver"
#define COARSE "coarser than published; that resolution is run by the argument long"
#define OWN_MEASURE "the source does not say how it measures"

/* Published: mm, but for the ratio. Planar impact of disc and first layer: GPa. */
typedef struct bound {
  double length, width, ratio, opening;
} bound;

static const bound bounds[PLATES] = {
    {65.0, 45.0, 1.44, 18.25}, {68.0, 46.0, 1.48, 19.4}, {66.0, 48.0, 1.38, 17.6}};

typedef struct outcome {
  double opening, front, rear;
} outcome;

static const char *keys_of(char keys[IMPACT_KEYS], const impact *s, const char *quantity) {
  snprintf(keys, IMPACT_KEYS, "case=laminate quantity=%s plate=%s n=%lld per_mm=%g", quantity,
           s->setup.name, (long long)s->n, impact_mm / s->setup.spacing);
  return keys;
}

/* Held to a relative tolerance; only reported when coarse. */
static int check(const char *keys, int full, double measured, double known, double tolerance) {
  if (full) return result_line(keys, measured, known, THESIS, tolerance, 1);
  result_report(keys, measured, known, THESIS, COARSE);
  return 0;
}

static int check_cloud(const impact *s, const bound *b, int full) {
  char keys[IMPACT_KEYS];
  const impact_cloud cloud = impact_measure_cloud(s, 0.999);
  result_report(keys_of(keys, s, "cloud_length_mm"), cloud.length / impact_mm, b->length, THESIS,
                OWN_MEASURE);
  result_report(keys_of(keys, s, "cloud_width_mm"), cloud.width / impact_mm, b->width, THESIS,
                OWN_MEASURE);
  return check(keys_of(keys, s, "cloud_ratio"), full, cloud.length / cloud.width, b->ratio, 0.15);
}

static int check_end(const impact *s, const bound *b, int full, outcome *o) {
  char keys[IMPACT_KEYS];
  *o = (outcome){impact_opening(s) / impact_mm, peeled_width(s, FRONT_SHEET) / impact_mm,
                 peeled_width(s, REAR_SHEET) / impact_mm};
  int failed = check(keys_of(keys, s, "opening_mm"), full, o->opening, b->opening, 0.1);
  failed += result_bound(keys_of(keys, s, "energy_lost"), impact_energy_loss(s), -1, 5e-5, THESIS);
  failed += result_bound(keys_of(keys, s, "momentum_error"),
                         s->ledger.momentum_error / s->ledger.momentum[0], -1, 1e-12,
                         "antisymmetric forces");
  result_report(keys_of(keys, s, "peeled_front_mm"), o->front, NAN, THESIS,
                "the source shows pictures; the measure is ours");
  result_report(keys_of(keys, s, "peeled_rear_mm"), o->rear, NAN, THESIS,
                "the source shows pictures; the measure is ours");
  result_report(keys_of(keys, s, "particle_steps_a_second"), impact_rate(s), NAN, "-",
                "depends on the machine");
  return failed;
}

static int validate_plate(int k, int full, outcome *o) {
  impact s;
  const impact_setup setup = setup_of(&plates[k], full ? 20.0 : 4.0);
  impact_create(&s, &setup);
  impact_run(&s, 20.0 * impact_us);
  int failed = check_cloud(&s, &bounds[k], full);
  impact_run(&s, 30.0 * impact_us);
  failed += check_end(&s, &bounds[k], full, o);
  impact_destroy(&s);
  return failed;
}

static int validate_planar(const char *name, int32_t plate_material, double p) {
  char keys[IMPACT_KEYS];
  snprintf(keys, sizeof keys, "case=laminate quantity=planar_p_GPa material=%s", name);
  const sph_riemann_solution s = impact_planar(SPH_ALUMINIUM_1000, plate_material, 4280.0);
  return result_line(keys, s.p * 1e-9, p, RIEMANN, 0.05, 0);
}

/* At least (side > 0) or at most `limit`; only reported when coarse. */
static int compare(const char *quantity, int full, double measured, int side, double limit) {
  char keys[IMPACT_KEYS];
  snprintf(keys, sizeof keys, "case=laminate quantity=%s", quantity);
  if (full) return result_bound(keys, measured, side, limit, THESIS);
  result_report(keys, measured, limit, THESIS, COARSE);
  return 0;
}

/* The order of the openings, and that the laminate peels alone. */
static int compare_plates(const outcome *o, int full) {
  const double peeled[] = {o[0].front + o[0].rear, o[1].front + o[1].rear, o[2].front + o[2].rear};
  int failed = compare("opening_laminate_over_monolithic", full, o[1].opening / o[0].opening, 1, 1);
  failed +=
      compare("opening_monolithic_over_homogenised", full, o[0].opening / o[2].opening, 1, 1.0);
  failed += compare("peeled_laminate_mm", full, peeled[1], 1, 1.0);
  failed += compare("peeled_monolithic_mm", full, peeled[0], -1, 0.1 * peeled[1]);
  return failed + compare("peeled_homogenised_mm", full, peeled[2], -1, 0.1 * peeled[1]);
}

static int validate(int full) {
  outcome o[PLATES];
  int failed = validate_planar("aluminium_2024", SPH_ALUMINIUM_2024, 48.7);
  failed += validate_planar("epoxy", SPH_EPOXY, 38.1);
  failed += validate_planar("homogenised", SPH_HOMOGENISED, 46.2);
  for (int k = 0; k < PLATES; ++k) failed += validate_plate(k, full, &o[k]);
  return failed + compare_plates(o, full);
}

#endif
