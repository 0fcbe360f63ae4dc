/* Part of oscillating_beam.c: the published frequencies, and what else is known of the case.
 *
 *   T  L. He, PhD thesis, Durham 2015, table 5.3 = He & Seaid, Acta Mech. 227 (2016), table 2:
 *      frequencies and errors against Euler-Bernoulli, dp = 1/300 m. The runs here must not be
 *      further from it. `validate` takes coarser lattices and, for d = 0.05 m, the first half
 *      period; `long` takes the published spacing and three periods for every row.
 *   F  plane stress, finite elements (Q9, converged): what every solver should converge to. The
 *      published small-amplitude results lie 3.25 % and 1.87 % below it.
 *
 * The same beam by the total-Lagrangian scheme (total_lagrangian.h): St. Venant-Kirchhoff, Wendland
 * kernel, h = 0.8 dp, hourglass control, no viscosity, leapfrog; a lattice of cells, so that the
 * mass is exact, and one column as the clamp. */
#ifndef EXAMPLES_OSCILLATING_BEAM_VALIDATE_H
#define EXAMPLES_OSCILLATING_BEAM_VALIDATE_H

enum { KEYS = 200, ROWS = 6 };

#define T53 "He 2015 table 5.3"
#define FEM "plane stress, finite elements"
#define STEP 1.637711e-6 /* s, of every published run */

static const struct row {
  double v_f, omega[2], error[2]; /* d = 0.1, d = 0.05 m; percent */
} rows[ROWS] = {
    {.05, {1888, 982}, {8.62, 4.94}},   {.02, {1929, 983}, {6.63, 4.84}},
    {.01, {1943, 1000}, {5.95, 3.19}},  {.005, {1943, 1007}, {5.95, 2.52}},
    {.002, {1943, 1007}, {5.95, 2.52}}, {.001, {1943, 1007}, {5.95, 2.52}},
};

static const double depths[2] = {0.1, 0.05}, plane_stress[2] = {2008.2, 1026.2};
static const double target[2] = {3.3, 1.9}; /* percent of plane_stress, for V_f <= .005 */

/* ---- total Lagrangian -------------------------------------------------------------------- */

static beam_options total_lagrangian(double depth, double dp, double v_f, double periods) {
  return (beam_options){depth, dp, v_f, 0.8, periods, 0, 1, 1, {0}};
}

/* Finish hook: the clamp does not move. */
static int32_t hold_clamp(void *user, double t, sph_particles *set, const sph_rate *rates,
                          int32_t count) {
  const beam *b = user;
  (void)t;
  (void)set;
  for (int32_t k = 0; k < count; ++k)
    for (int64_t i = 0; i < 2 * (int64_t)b->o.clamp * b->rows; ++i) rates[k].values[i] = 0.0;
  return 0;
}

static void make_total(beam *b) {
  sph_material *elastic;
  sph_hyperelastic_options law;
  sph_total_lagrangian_options options;
  sph_hyperelastic_options_init(&law);
  law.law = SPH_ST_VENANT_KIRCHHOFF;
  law.young = young;
  law.poisson = poisson;
  law.density = density;
  law.reduction = SPH_PLANE_STRESS;
  sph_total_lagrangian_options_init(&options);
  options.dim = 2;
  options.h_ratio = 0.8; /* 8 neighbours: the layer softened by the surface is a support thick */
  options.cfl = b->o.cfl;
  need(b->ctx, sph_material_create_hyperelastic(b->ctx, &law, &elastic));
  need(b->ctx, sph_total_lagrangian_create(b->ctx, &options, elastic, &b->tl));
  sph_material_destroy(elastic); /* the scheme keeps it */
  need(b->ctx, sph_total_lagrangian_start(b->tl, b->set));
  need(b->ctx, sph_rhs_set_finish(sph_total_lagrangian_rhs(b->tl), hold_clamp, b));
  need(b->ctx, sph_total_lagrangian_time_step(b->tl, b->set, &b->dt));
}

/* ---- energy ------------------------------------------------------------------------------ */

/* A NaN stays. */
static void largest(double *most, double x) {
  if (!(x <= *most)) *most = x;
}

/* Kinetic energy, what was put into strain, and what artificial stress holds as long as there is
 * tension (total Lagrangian: what the springs of the hourglass control hold). Only viscosity may
 * change the sum. */
static void read_energy(const beam *b, double t, outcome *r) {
  sph_total_lagrangian_energies e = {.size = sizeof e};
  sph_elastodynamics_ledger ledger;
  double energy;
  if (b->tl) {
    need(b->ctx, sph_total_lagrangian_energy(b->tl, b->set, t, &e));
    energy = e.kinetic + e.strain + e.hourglass;
  } else {
    sph_elastodynamics_ledger_init(&ledger);
    need(b->ctx, sph_elastodynamics_balance(b->solid, &ledger));
    energy = ledger.kinetic + ledger.strain + ledger.artificial;
  }
  if (t == 0.0) r->initial = energy;
  if (t > 0.0) largest(&r->growth, (energy - r->energy) / r->initial);
  r->energy = energy;
  largest(&r->drift, fabs(energy / r->initial - 1.0));
  if (b->tl) return;
  largest(&r->balance, fabs(ledger.energy_error) / r->initial);
  largest(&r->form, fabs(ledger.form) / r->initial);
}

/* ---- lines ------------------------------------------------------------------------------- */

static void make_keys(char keys[KEYS], const char *quantity, const beam_options *o) {
  static const char *const forms[] = {"?", "summed", "difference", "conservative"};
  int used = snprintf(keys, KEYS,
                      "case=oscillating_beam quantity=%s d=%g dp=%.4g V_f=%g clamp=%d "
                      "periods=%g lattice=%s",
                      quantity, o->depth, o->dp, o->v_f, (int)o->clamp, o->periods,
                      o->faces ? "faces" : "cells");
  const size_t left = (size_t)(KEYS - used);
  if (o->total)
    snprintf(keys + used, left, " total_lagrangian=1");
  else
    used += snprintf(keys + used, left, " epsilon=%g alpha=%g form=%s%s",
                     o->scheme.artificial_stress, o->scheme.alpha, forms[o->scheme.momentum],
                     o->scheme.position_field == SPH_FIELD_X0 ? " positions=frozen" : "");
  if (!o->total && o->scheme.artificial_spacing != 1.0)
    snprintf(keys + used, (size_t)(KEYS - used), " f_is_1_at=%gdp", o->scheme.artificial_spacing);
}

static double percent(double measured, double reference) {
  return 100.0 * fabs(measured / reference - 1.0);
}

static int bound(const char *quantity, const beam_options *o, double measured, double limit,
                 const char *source) {
  char keys[KEYS];
  make_keys(keys, quantity, o);
  return result_bound(keys, measured, -1, limit, source);
}

static void report(const char *quantity, const beam_options *o, double measured, double reference,
                   const char *source, const char *reason) {
  char keys[KEYS];
  make_keys(keys, quantity, o);
  result_report(keys, measured, reference, source, reason);
}

/* ---- the published table ----------------------------------------------------------------- */

/* Ledger: energy falls from each reading to the next, and nothing else changes it than viscosity
 * and, by terms of second order, the steps. (Deflections may grow: at large amplitudes the first
 * mode is not alone.) */
static int validate_energy(const beam_options *o, const outcome *r) {
  if (o->total)
    return bound("energy_drift", o, r->drift, 1e-3, "leapfrog keeps it within (omega dt)^2");
  int failed = bound("growth_of_energy", o, r->growth, 0.0, "viscosity only dissipates");
  failed += bound("work_out_of_balance", o, r->form, 1e-10, "transpose of the velocity gradient");
  if (o->v_f <= .02)
    return failed + bound("energy_error_of_steps", o, r->balance, 1e-3, "second order in dt");
  report(
      "energy_error_of_steps", o, r->balance, 1e-3, "second order in dt",
      "at large amplitudes more pairs pass from approach to recession, where viscosity has a kink");
  return failed;
}

/* Frequency, and where it is kept the energy. */
static int validate_row(int d, const struct row *row, const beam_options *o) {
  const outcome r = run(o, NULL);
  int failed = bound("error_Euler_Bernoulli_percent", o,
                     percent(r.omega, euler_bernoulli(o->depth)), row->error[d], T53);
  report("omega", o, r.omega, row->omega[d], T53, "the published error is the bound");
  if (row->v_f <= .005)
    failed +=
        bound("error_plane_stress_percent", o, percent(r.omega, plane_stress[d]), target[d], FEM);
  if (o->total || o->scheme.audit) failed += validate_energy(o, &r);
  return failed;
}

/* The ledger takes three times as long: it is kept in the first and fourth row. */
static int validate_table(int full) {
  int failed = 0;
  for (int d = 0; d < 2; ++d)
    for (int k = 0; k < ROWS; ++k) {
      const double dp = full ? 1.0 / 300.0 : d == 0 ? .01 : .005;
      const double periods = full || (d == 0 && k % 3 == 0) ? 3.2 : d == 0 ? 1.1 : 0.6;
      beam_options o = published(depths[d], dp, rows[k].v_f, periods);
      o.scheme.audit = k % 3 == 0 && (full || d == 0);
      failed += validate_row(d, &rows[k], &o);
    }
  return failed;
}

static int validate_total(int full) {
  int failed = 0;
  for (int d = 0; d < 2; ++d)
    for (int k = 0; k < ROWS; k += full ? 1 : 3) {
      const double dp = full ? 1.0 / 300.0 : d == 0 ? .01 : .005;
      const beam_options o =
          total_lagrangian(depths[d], dp, rows[k].v_f, full || d == 0 ? 3.2 : 0.6);
      failed += validate_row(d, &rows[k], &o);
    }
  return failed;
}

/* Stages of the published step at the three spacings, from the runs themselves. */
static int validate_stages(void) {
  static const double n[3] = {100, 200, 300};
  int failed = 0;
  for (int k = 0; k < 3; ++k) {
    char keys[KEYS];
    beam_options o = published(0.1, 1.0 / n[k], .01, .003);
    o.cfl = STEP * n[k] * sqrt(young / density);
    const outcome r = run(&o, NULL);
    make_keys(keys, "stages", &o);
    failed += result_line(keys, r.stages, 3.0 + k, "He 2015 fig. 5.18", 0.0, 0);
  }
  return failed;
}

/* ---- convergence ------------------------------------------------------------------------- */

/* Errors against plane stress, in percent; of the published scheme at one step for all spacings, as
 * published. */
static int errors_of(int full, beam_options o, double *n, double *error) {
  const int count = full ? 3 : 2;
  for (int k = 0; k < count; ++k) {
    n[k] = 100.0 * (k + 1);
    o.dp = o.scheme.spacing = 1.0 / n[k];
    if (!o.total) o.cfl = STEP * n[k] * sqrt(young / density);
    error[k] = percent(run(&o, NULL).omega, plane_stress[0]);
  }
  return count;
}

static int validate_rate(int full, beam_options o) {
  double n[3], error[3];
  char keys[KEYS];
  int failed = 0;
  const int count = errors_of(full, o, n, error);
  for (int k = 1; k < count; ++k) {
    o.dp = 1.0 / n[k];
    failed += bound("convergence_error_plane_stress_percent", &o, error[k], error[k - 1],
                    "error at the coarser spacing");
  }
  make_keys(keys, "rate_of_error", &o);
  return failed +
         result_bound(keys, convergence_rate(count, n, error), 1, 1.0, "He 2015 fig. 5.19");
}

/* With the exact mass (cells) and without artificial stress there is one error of first order, that
 * of the clamp: the strain ends at a wall, and the gradient smears it. One held column instead of
 * three leaves less of it. */
static int validate_convergence(int full) {
  beam_options o = published(0.1, .01, .01, 0.6);
  o.scheme.artificial_stress = 0.0;
  o.faces = 0;
  int failed = validate_rate(full, o);
  o.clamp = 1;
  failed += validate_rate(full, o);
  return failed + validate_rate(full, total_lagrangian(0.1, .01, .01, 0.6));
}

/* In the published setting errors of both signs meet: the lattice is d + dp deep (2.1 % at 1/300),
 * the clamp is soft, artificial stress takes 2.3 % at any spacing. */
static void report_convergence(int full) {
  beam_options o = published(0.1, .01, .01, 0.6);
  double n[3], error[3];
  const int count = errors_of(full, o, n, error);
  for (int k = 0; k < count; ++k) {
    o.dp = 1.0 / n[k];
    report("convergence_error_plane_stress_percent", &o, error[k], 3.25,
           "He 2015 table 5.3, "
           "against F",
           "what artificial stress takes does not fall with dp; the rate is that of the cells");
  }
}

/* What is best for d = 0.1 is not for d = 0.05. */
static void report_half_depth(int full) {
  beam_options o = published(depths[1], full ? 1.0 / 300.0 : .005, .005, 0.6);
  o.scheme.artificial_stress = 0.0;
  o.faces = 0;
  o.clamp = 1;
  report("best_error_plane_stress_percent", &o, percent(run(&o, NULL).omega, plane_stress[1]),
         target[1], FEM,
         "half the rows: those at a face see the bending strain of a place deeper inside, which "
         "costs (dp/d)^2; the lattice with faces is deeper by dp and makes up for it");
}

/* Ours, for all: artificial stress that is full where pairs come closer than 0.75 dp. It still
 * keeps particles apart, and takes a third of what it takes at dp. */
static int validate_touch(void) {
  int failed = 0;
  for (int k = 0; k < ROWS; k += 3) {
    beam_options o = published(depths[0], .01, rows[k].v_f, k == 0 ? 3.2 : 1.1);
    o.scheme.artificial_spacing = 0.75;
    o.scheme.audit = k == 0;
    const outcome r = run(&o, NULL);
    failed += bound("best_error_plane_stress_percent", &o, percent(r.omega, plane_stress[0]),
                    target[0], FEM);
    if (k == 0) failed += validate_energy(&o, &r);
  }
  return failed;
}

/* ---- beside the published setting -------------------------------------------------------- */

/* Pairs and gradients of the configuration at rest: the total Lagrangian form that He prints. */
static int validate_frozen(void) {
  int failed = 0;
  for (int k = 0; k < ROWS; k += 3) {
    beam_options o = published(0.1, .01, rows[k].v_f, k == 0 ? 3.2 : 1.1);
    o.scheme.position_field = SPH_FIELD_X0;
    failed += validate_row(0, &rows[k], &o);
  }
  return failed;
}

static void report_variants(void) {
  beam_options o = published(0.1, .01, .005, 1.1);
  o.cfl = 1.0;
  o.scheme.alpha = o.scheme.beta = 0.5;
  outcome r = run(&o, NULL);
  report("omega_at_cfl_1", &o, r.omega, 1943, T53,
         "a fifth of the viscosity: RKC is stable to CFL 1, not to 2.5");
  o = published(0.1, .01, .005, 1.1);
  o.scheme.momentum = SPH_STRESS_SUMMED;
  r = run(&o, NULL);
  report("omega", &o, r.omega, 1943, T53,
         "the form as printed is not the transpose of the velocity gradient at free surfaces");
  o = published(0.1, .01, .05, 3.2);
  o.scheme.artificial_stress = 0.0;
  r = run(&o, NULL);
  report("last_deflection_over_first", &o,
         r.peaks[r.crossings > 0 ? r.crossings - 1 : 0] / r.peaks[0], 1.0, "undamped",
         "strains of 10 %: tension makes particles clump, which wastes energy");
}

static int validate(int full) {
  int failed = validate_stages();
  failed += validate_table(full);
  failed += validate_total(full);
  failed += validate_convergence(full);
  report_convergence(full);
  report_half_depth(full);
  failed += validate_touch();
  failed += validate_frozen();
  report_variants();
  return failed;
}

#endif
