/* Part of sphere_on_plate.c: the figures of the three targets, and their bounds.
 *
 * `long` has the ten particles per mm of the source, `validate` four. The source prints no others
 * but those at ten; five per mm, of an independent program: cloud 91.2 x 70.6, 81.6 x 53.9, 97.0 x
 * 62.7 mm, crater 33.5-34.5, 28.5, 27.5-28.7 mm. */
#ifndef EXAMPLES_SPHERE_ON_PLATE_VALIDATE_H
#define EXAMPLES_SPHERE_ON_PLATE_VALIDATE_H

#define THESIS "Zisis 2017 section 6.2"
#define INDEPENDENT "independent program with 5 per mm"
#define RIEMANN "independent Riemann solver"
#define COARSE "coarser than published; that resolution is run by the argument long"
#define OWN_MEASURE "the source does not say how it measures"

/* What a target is held to with ten particles per mm, and what is known. */
typedef struct bound {
  double ratio_low, ratio_high;   /* L/W */
  double crater_low, crater_high; /* mm; 0: no bound */
  double length, width, crater;   /* mm, of an independent program */
  double p, v;                    /* GPa, m/s: plane layers of the two materials */
} bound;

static const bound bounds[TARGETS] = {{1.36, 1.42, 24.0, 35.0, 91.2, 70.6, 34.0, 80.6, 3090.0},
                                      {0.0, 1.49, 0.0, 27.0, 81.6, 53.9, 28.5, 111.5, 1883.0},
                                      {1.48, 1.64, 25.0, 27.0, 97.0, 62.7, 28.1, 139.6, 2350.0}};

static const char *keys_of(char keys[IMPACT_KEYS], const impact *s, const char *quantity) {
  snprintf(keys, IMPACT_KEYS, "case=sphere_on_plate quantity=%s target=%s n=%lld per_mm=%g",
           quantity, s->setup.name, (long long)s->n, impact_mm / s->setup.spacing);
  return keys;
}

/* Six rows are too few for the thin plates. */
static int is_fine(const impact *s, int full) { return full || s->rear > 3.0 * impact_mm; }

/* Within [low, high]; only reported when coarse. */
static int check_range(const char *keys, int fine, double measured, double low, double high) {
  char half[IMPACT_KEYS + 16];
  int failed = 0;
  if (!fine) {
    result_report(keys, measured, high, THESIS, COARSE);
    return 0;
  }
  if (low > 0.0) {
    snprintf(half, sizeof half, "%s side=low", keys);
    failed += result_bound(half, measured, 1, low, THESIS);
  }
  snprintf(half, sizeof half, "%s side=high", keys);
  return failed + result_bound(half, measured, -1, high, THESIS);
}

static int check_cloud(const impact *s, const bound *b, int full) {
  char keys[IMPACT_KEYS];
  const impact_cloud cloud = impact_measure_cloud(s, 0.999), inner = impact_measure_cloud(s, 0.98);
  result_report(keys_of(keys, s, "cloud_length_mm"), cloud.length / impact_mm, b->length,
                INDEPENDENT, OWN_MEASURE);
  result_report(keys_of(keys, s, "cloud_width_mm"), cloud.width / impact_mm, b->width, INDEPENDENT,
                OWN_MEASURE);
  result_report(keys_of(keys, s, "cloud_ratio_98_percent"), inner.length / inner.width,
                b->length / b->width, INDEPENDENT, OWN_MEASURE);
  return check_range(keys_of(keys, s, "cloud_ratio"), is_fine(s, full), cloud.length / cloud.width,
                     b->ratio_low, b->ratio_high);
}

static int check_end(const impact *s, const bound *b, int full) {
  char keys[IMPACT_KEYS];
  const double crater = impact_opening(s) / impact_mm;
  int failed = check_range(keys_of(keys, s, "crater_mm"), is_fine(s, full), crater, b->crater_low,
                           b->crater_high);
  failed += result_bound(keys_of(keys, s, "energy_lost"), impact_energy_loss(s), -1, 3e-5, THESIS);
  failed += result_bound(keys_of(keys, s, "momentum_error"),
                         s->ledger.momentum_error / s->ledger.momentum[0], -1, 1e-12,
                         "antisymmetric forces");
  result_report(keys_of(keys, s, "particle_steps_a_second"), impact_rate(s), NAN, "-",
                "depends on the machine");
  return failed;
}

static int validate_target(int k, int full) {
  impact s;
  const impact_setup setup = setup_of(&targets[k], full ? 10.0 : 4.0);
  impact_create(&s, &setup);
  impact_run(&s, 20.0 * impact_us);
  int failed = check_cloud(&s, &bounds[k], full);
  impact_run(&s, 30.0 * impact_us);
  failed += check_end(&s, &bounds[k], full);
  impact_destroy(&s);
  return failed;
}

/* Where plane layers of the two materials would meet, exactly. */
static int validate_planar(int k) {
  char keys[IMPACT_KEYS];
  const sph_riemann_solution s =
      impact_planar(SPH_ALUMINIUM_2024, targets[k].material, targets[k].speed);
  snprintf(keys, sizeof keys, "case=sphere_on_plate quantity=planar_p_GPa target=%s",
           targets[k].name);
  int failed = result_line(keys, s.p * 1e-9, bounds[k].p, RIEMANN, 0.05, 0);
  snprintf(keys, sizeof keys, "case=sphere_on_plate quantity=planar_v target=%s", targets[k].name);
  return failed + result_line(keys, s.v[0], bounds[k].v, RIEMANN, 0.5, 0);
}

static int validate(int full) {
  int failed = 0;
  for (int k = 0; k < TARGETS; ++k) failed += validate_planar(k);
  for (int k = 0; k < TARGETS; ++k) failed += validate_target(k, full);
  return failed;
}

#endif
