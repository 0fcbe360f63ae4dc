/* Part of elastic_bar.c: the published errors of the velocity at t = 0.12 ms, and their check.
 *
 *   T  L. He, PhD thesis, Durham 2015, table 5.1 (N = 250; time steps by CFL number)
 *   P  L. He, M. Seaid, Acta Mech. 227 (2016), table 1 (time steps in microseconds; its header says
 *      11.8, 23.6, 47.2, but the stage counts need a hundredth of these)
 *
 * Both report some columns under another time step than the one that gives the figure: every Euler
 * entry, and RK4 at N = 250 in the last column of P, which T copies, come out at 4/3 of the printed
 * step (P's computing times say so too: RK4 at N = 250 goes from 279.8 s to 108.1 s between two
 * columns whose steps differ by a factor of 2). Such entries appear twice: at the printed step as
 * a report, at 4/3 of it with a verdict. */
#ifndef EXAMPLES_ELASTIC_BAR_VALIDATE_H
#define EXAMPLES_ELASTIC_BAR_VALIDATE_H

enum { CHECK_L1 = 1, CHECK_L2 = 2, CHECK_BOTH = 3 };

typedef struct published {
  const char *source;
  int n;
  int32_t scheme; /* SPH_INTEGRATOR_* */
  double cfl, dt; /* one of them, the other 0; dt in microseconds */
  int stages;     /* of RKC; 0: not printed */
  double l1, l2;
  int checked;        /* CHECK_*: these figures must be met within 1 % */
  const char *reason; /* why the others are only reported */
} published;

#define T51 "He 2015 table 5.1"
#define P1 "He & Seaid 2016 table 1"
#define EULER SPH_INTEGRATOR_EULER
#define PC2 SPH_INTEGRATOR_PC2
#define RK4 SPH_INTEGRATOR_RK4
#define RKC SPH_INTEGRATOR_RKC

#define STEP_43 "the printed figure belongs to 4/3 of the printed step (next entry)"
#define STEP_43_UNSTABLE "the printed figure is near that of 4/3 of the printed step (next entry)"
#define HALF_UNSTABLE "beyond the stable step: oscillates, 0.6 % less dt moves it by up to 5 %"
#define PC2_TWICE "the two sources contradict each other; .0886/.1613 in He & Seaid is met"
#define ABOVE_OWN \
  "above its own row (next entry); the ratio depends on CFL, not n, and is not the same"

static const published entries[] = {
    {T51, 250, RKC, 0.6, 0, 3, .0889, .1612, CHECK_BOTH, NULL},
    {T51, 250, RKC, 1.0, 0, 3, .0889, .1611, CHECK_BOTH, NULL},
    {T51, 250, RKC, 1.2, 0, 4, .0888, .1616, CHECK_BOTH, NULL},
    {T51, 250, RKC, 2.5, 0, 5, .0888, .1614, CHECK_BOTH, NULL},
    {T51, 250, RK4, 0.6, 0, 0, .1005, .1710, 0, STEP_43},
    {T51 " (CFL 0.6)", 250, RK4, 0.8, 0, 0, .1005, .1710, CHECK_BOTH, NULL},
    {T51, 250, RK4, 1.0, 0, 0, .1260, .1899, CHECK_BOTH, NULL},
    {T51, 250, RK4, 1.2, 0, 0, .2497, .2632, 0, HALF_UNSTABLE},
    {T51, 250, PC2, 0.6, 0, 0, .1056, .1737, 0, PC2_TWICE},
    {T51, 250, EULER, 0.6, 0, 0, .1469, .1943, 0, STEP_43_UNSTABLE},
    {T51 " (CFL 0.6)", 250, EULER, 0.8, 0, 0, .1469, .1943, 0, HALF_UNSTABLE},

    {P1, 250, RKC, 0, .118, 2, .0889, .1613, CHECK_BOTH, NULL},
    {P1, 250, RKC, 0, .236, 2, .0889, .1613, CHECK_BOTH, NULL},
    {P1, 250, RKC, 0, .472, 3, .0889, .1612, CHECK_BOTH, NULL},
    {P1, 500, RKC, 0, .118, 2, .0625, .1353, CHECK_BOTH, NULL},
    {P1, 500, RKC, 0, .236, 3, .0625, .1353, CHECK_BOTH, NULL},
    {P1, 500, RKC, 0, .472, 4, .0643, .1372, 0, ABOVE_OWN},
    {P1 " (.118 us)", 500, RKC, 0, .472, 0, .0625, .1353, CHECK_BOTH, NULL},
    {P1, 750, RKC, 0, .118, 0, .0511, .1222, CHECK_BOTH, NULL}, /* printed s = 2, formula 3 */
    {P1, 750, RKC, 0, .236, 3, .0510, .1221, CHECK_BOTH, NULL},
    {P1, 750, RKC, 0, .472, 4, .0522, .1234, 0, ABOVE_OWN},
    {P1 " (.118 us)", 750, RKC, 0, .472, 0, .0511, .1222, CHECK_BOTH, NULL},
    {P1, 1000, RKC, 0, .118, 3, .0441, .1136, CHECK_BOTH, NULL},
    {P1, 1000, RKC, 0, .236, 4, .0445, .1153, CHECK_L1, ABOVE_OWN},
    {P1 " (.118 us)", 1000, RKC, 0, .236, 0, .0441, .1136, CHECK_BOTH, NULL},
    {P1, 1000, RKC, 0, .472, 5, .0441, .1137, CHECK_BOTH, NULL},

    {P1, 250, RK4, 0, .118, 0, .0889, .1613, CHECK_BOTH, NULL},
    {P1, 250, RK4, 0, .236, 0, .0889, .1613, CHECK_BOTH, NULL},
    {P1, 250, RK4, 0, .472, 0, .1005, .1710, 0, STEP_43},
    {P1 " (.472 us)", 250, RK4, 0, .6293, 0, .1005, .1710, CHECK_BOTH, NULL},
    {P1, 500, RK4, 0, .118, 0, .0625, .1353, CHECK_BOTH, NULL},
    {P1, 500, RK4, 0, .236, 0, .0626, .1354, CHECK_BOTH, NULL},
    {P1, 500, RK4, 0, .472, 0, .1764, .2172, 0, HALF_UNSTABLE},
    {P1, 750, RK4, 0, .118, 0, .0510, .1221, CHECK_BOTH, NULL},
    {P1, 750, RK4, 0, .236, 0, .0618, .1340, CHECK_BOTH, NULL},
    {P1, 1000, RK4, 0, .118, 0, .0441, .1136, CHECK_BOTH, NULL},
    {P1, 1000, RK4, 0, .236, 0, .1203, .1797, 0, HALF_UNSTABLE},

    {P1, 250, PC2, 0, .118, 0, .0889, .1613, CHECK_BOTH, NULL},
    {P1, 250, PC2, 0, .236, 0, .0889, .1613, CHECK_BOTH, NULL},
    {P1, 250, PC2, 0, .472, 0, .0886, .1613, CHECK_BOTH, NULL},
    {P1, 500, PC2, 0, .118, 0, .0625, .1353, CHECK_BOTH, NULL},
    {P1, 500, PC2, 0, .236, 0, .0625, .1354, CHECK_BOTH, NULL},
    {P1, 750, PC2, 0, .118, 0, .0510, .1221, CHECK_BOTH, NULL},
    {P1, 1000, PC2, 0, .118, 0, .0441, .1137, CHECK_BOTH, NULL},

    {P1, 250, EULER, 0, .118, 0, .0840, .1569, 0, STEP_43},
    {P1 " (.118 us)", 250, EULER, 0, .1573, 0, .0840, .1569, CHECK_BOTH, NULL},
    {P1, 250, EULER, 0, .236, 0, .0789, .1519, 0, STEP_43},
    {P1 " (.236 us)", 250, EULER, 0, .3147, 0, .0789, .1519, CHECK_BOTH, NULL},
    {P1, 250, EULER, 0, .472, 0, .1469, .1943, 0, STEP_43_UNSTABLE},
    {P1 " (.472 us)", 250, EULER, 0, .6293, 0, .1469, .1943, 0, HALF_UNSTABLE},
    {P1, 500, EULER, 0, .118, 0, .0555, .1275, 0, STEP_43},
    {P1 " (.118 us)", 500, EULER, 0, .1573, 0, .0555, .1275, CHECK_BOTH, NULL},
    {P1, 500, EULER, 0, .236, 0, .1002, .1598, 0, STEP_43_UNSTABLE},
    {P1 " (.236 us)", 500, EULER, 0, .3147, 0, .1002, .1598, 0, HALF_UNSTABLE},
    {P1, 750, EULER, 0, .118, 0, .0480, .1180, 0, STEP_43},
    {P1 " (.118 us)", 750, EULER, 0, .1573, 0, .0480, .1180, CHECK_BOTH, NULL},
    {P1, 1000, EULER, 0, .118, 0, .0675, .1323, 0, STEP_43_UNSTABLE},
    {P1 " (.118 us)", 1000, EULER, 0, .1573, 0, .0675, .1323, 0, HALF_UNSTABLE},
};

enum { ENTRIES = sizeof entries / sizeof *entries };

/* Where T prints "-": the run is unstable. */
static const published unstable[] = {
    {T51, 250, EULER, 1.0, 0, 0, 0, 0, 0, NULL}, {T51, 250, EULER, 1.2, 0, 0, 0, 0, 0, NULL},
    {T51, 250, EULER, 2.5, 0, 0, 0, 0, 0, NULL}, {T51, 250, PC2, 1.0, 0, 0, 0, 0, 0, NULL},
    {T51, 250, PC2, 1.2, 0, 0, 0, 0, 0, NULL},   {T51, 250, PC2, 2.5, 0, 0, 0, 0, 0, NULL},
    {T51, 250, RK4, 2.5, 0, 0, 0, 0, 0, NULL},
};

enum { UNSTABLE = sizeof unstable / sizeof *unstable };

enum { KEYS = 200 };

static const char *scheme_name(int32_t scheme) {
  static const char *const names[] = {"?", "euler", "pc2", "heun", "ssprk3", "rk4"};
  return scheme == RKC ? "rkc" : names[scheme];
}

static void make_keys(char keys[KEYS], const char *quantity, const bar_options *o, double dt,
                      int stages) {
  int used = snprintf(keys, KEYS, "case=elastic_bar quantity=%s n=%d scheme=%s cfl=%.3g", quantity,
                      o->n, scheme_name(o->scheme), o->cfl);
  if (dt > 0.0) used += snprintf(keys + used, (size_t)(KEYS - used), " dt=%.4gus", dt);
  snprintf(keys + used, (size_t)(KEYS - used), " stages=%d form=%s", stages,
           o->form == SPH_STRESS_SUMMED ? "summed" : "difference");
}

static outcome run_once(const bar_options *o, double t) {
  bar b;
  bar_create(&b, o);
  const outcome r = bar_run(&b, t);
  bar_destroy(&b);
  return r;
}

static bar_options options_of(const published *p) {
  const double c = sqrt(young / density);
  return (bar_options){p->n, p->scheme, p->dt > 0.0 ? c * p->dt * 1e-6 * p->n / length : p->cfl,
                       STANDARD};
}

/* ---- the tables -------------------------------------------------------------------------- */

/* Entries of another row or column than the step says, "He ... (.118 us)", name it. */
static void name_row(char keys[KEYS], const char *source) {
  const char *row = strchr(source, '(');
  const size_t used = strlen(keys);
  if (row) snprintf(keys + used, KEYS - used, " row=\"%.*s\"", (int)strlen(row) - 2, row + 1);
}

static int compare_entry(const published *p, const bar_options *o, const outcome *r, int which) {
  const int first = which == CHECK_L1;
  const double measured = first ? r->error.l1 : r->error.l2, printed = first ? p->l1 : p->l2;
  char keys[KEYS];
  make_keys(keys, first ? "velocity_L1" : "velocity_L2", o, p->dt, r->stages);
  name_row(keys, p->source);
  if (p->checked & which) return result_line(keys, measured, printed, p->source, 0.01, 1);
  result_report(keys, measured, printed, p->source, p->reason);
  return 0;
}

static int validate_entries(void) {
  int failed = 0;
  for (int k = 0; k < ENTRIES; ++k) {
    const published *p = &entries[k];
    const bar_options o = options_of(p);
    const outcome r = run_once(&o, snapshot);
    char keys[KEYS];
    failed += compare_entry(p, &o, &r, CHECK_L1) + compare_entry(p, &o, &r, CHECK_L2);
    make_keys(keys, "stages", &o, p->dt, r.stages);
    if (p->stages > 0) failed += result_line(keys, r.stages, p->stages, p->source, 0.0, 0);
  }
  return failed;
}

static int validate_unstable(void) {
  int failed = 0;
  for (int k = 0; k < UNSTABLE; ++k) {
    const bar_options o = options_of(&unstable[k]);
    const outcome r = run_once(&o, snapshot);
    char keys[KEYS];
    make_keys(keys, "unstable", &o, 0.0, r.stages);
    failed += result_line(keys, !(r.error.l1 < 1.0), 1.0, unstable[k].source, 0.0, 0);
  }
  return failed;
}

/* P prints s = 2 for N = 750 at .118 us, where the formula gives 3: its run was one of 2. */
static int validate_two_stages(void) {
  bar_options o = {750, RKC, sqrt(young / density) * .118e-6 * 750.0 / length, STANDARD};
  char keys[KEYS];
  o.stages = 2;
  const outcome r = run_once(&o, snapshot);
  make_keys(keys, "velocity_L1", &o, .118, r.stages);
  int failed = result_line(keys, r.error.l1, .0511, P1, 0.01, 1);
  make_keys(keys, "velocity_L2", &o, .118, r.stages);
  return failed + result_line(keys, r.error.l2, .1222, P1, 0.01, 1);
}

/* ---- statements beside the tables -------------------------------------------------------- */

/* The error does not depend on the CFL number, and the viscous front gives rates of 1/2, 1/4. */
static int validate_statements(void) {
  static const double cfl[] = {0.6, 1.0, 1.2, 2.5}, n[] = {250, 500, 750, 1000};
  double l1[4], l2[4];
  char keys[KEYS];
  bar_options o = {250, RKC, 0.6, STANDARD};
  int failed = 0;
  for (int k = 0; k < 4; ++k) {
    o.cfl = cfl[k];
    const outcome r = run_once(&o, snapshot);
    l1[k] = r.error.l1;
    make_keys(keys, "velocity_L1_over_that_at_cfl_0.6", &o, 0.0, r.stages);
    if (k > 0) failed += result_line(keys, l1[k] / l1[0], 1.0, "one error at all CFL", 0.01, 0);
  }
  for (int k = 0; k < 4; ++k) {
    o.n = (int)n[k];
    const outcome r = run_once(&o, snapshot);
    l1[k] = r.error.l1;
    l2[k] = r.error.l2;
  }
  const char *theory = "viscous smearing";
  failed += result_line("case=elastic_bar quantity=rate_L1 scheme=rkc cfl=2.5 form=difference",
                        convergence_rate(4, n, l1), 0.5, theory, 0.03, 0);
  failed += result_line("case=elastic_bar quantity=rate_L2 scheme=rkc cfl=2.5 form=difference",
                        convergence_rate(4, n, l2), 0.25, theory, 0.03, 0);
  o = (bar_options){250, RKC, 2.5, STANDARD};
  const outcome late = run_once(&o, 3.5e-4); /* the front came to the fixed end at 0.197 ms */
  make_keys(keys, "end_stress_over_load", &o, 0.0, late.stages);
  return failed + result_line(keys, -late.end_stress / load, 2.0, "exact", 0.01, 1);
}

/* Ours: less viscosity is enough. The reference is a bound. */
static int validate_better(void) {
  bar_options o = {250, RKC, 1.2, STANDARD};
  char keys[KEYS];
  o.viscosity = 0.5;
  o.h_ratio = 1.2;
  const outcome r = run_once(&o, snapshot);
  make_keys(keys, "velocity_L1_alpha_0.5", &o, 0.0, r.stages);
  const int failed =
      result_bound(keys, r.error.l1, -1, 0.036, "bound for alpha = beta = 0.5, h = 1.2 dp");
  make_keys(keys, "velocity_L2_alpha_0.5", &o, 0.0, r.stages);
  result_report(keys, r.error.l2, .1614, T51,
                "published at alpha = 2.5: the error is its viscosity");
  return failed;
}

/* As many as the support reaches, beyond each end. */
static void add_ghosts(bar *b) {
  b->ghosts = (int)ceil(2.0 * b->o.h_ratio);
  need(b->ctx, sph_particles_add_ghosts(b->set, 2 * b->ghosts, NULL));
}

/* Prepare hook: ghosts mirror the particles next to each end, first all of the loaded end. There
 * the stress is -load in the middle between particle and ghost; at the fixed one the velocity 0. */
static int32_t mirror_ends(void *user, double t, sph_particles *set, const sph_rate *rates,
                           int32_t count) {
  bar *b = user;
  (void)t;
  (void)rates;
  (void)count;
  const double free_end = b->x[0] - 0.5 * b->dp;
  for (int k = 0; k < b->ghosts; ++k) {
    const int left = b->o.n + k, right = left + b->ghosts, mirrored = b->o.n - 1 - k;
    b->x[left] = 2.0 * free_end - b->x[k];
    b->v[left] = b->v[k];
    b->sigma[left] = -2.0 * load - b->sigma[k];
    b->x[right] = 2.0 * length - b->x[mirrored];
    b->v[right] = -b->v[mirrored];
    b->sigma[right] = b->sigma[mirrored];
  }
  return sph_particles_touch(set, SPH_FIELD_X);
}

/* The form as printed, with ghosts that carry the load. */
static void report_summed(void) {
  for (int k = 0; k < ENTRIES; ++k) {
    const published *p = &entries[k];
    bar_options o = options_of(p);
    if (p->scheme != RKC || p->stages == 0 || (p->n > 250 && p->dt != .236)) continue;
    char keys[KEYS];
    o.form = SPH_STRESS_SUMMED;
    const outcome r = run_once(&o, snapshot);
    const char *why = "summed form with traction ghosts; the tables come from the difference form";
    make_keys(keys, "velocity_L1", &o, p->dt, r.stages);
    result_report(keys, r.error.l1, p->l1, p->source, why);
    make_keys(keys, "velocity_L2", &o, p->dt, r.stages);
    result_report(keys, r.error.l2, p->l2, p->source, why);
  }
}

static int validate(void) {
  int failed = validate_entries();
  failed += validate_unstable();
  failed += validate_two_stages();
  failed += validate_statements();
  failed += validate_better();
  report_summed();
  return failed;
}

#endif
