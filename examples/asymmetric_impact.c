/* A bar strikes a lighter and softer one: what smoothing and layout make of the contact.
 *
 * Equations   drho/dt = -rho div v,   dv/dt = -grad P/rho,   P = c0^2 (rho - rho0), as in
 *             smoothing.h, with viscosity and mass flux
 * Set-up      [0, 0.5) rho = rho0 = c0 = v = 1; [0.5, 1] at rest with rho = rho0, c0 of
 *             A {0.25, 0.5}, B {0.5, 0.5}, C {0.25, 0.25}; ends free. Gaussian, eta = 1.2, a_v = 1,
 *             b = 2, a_rho = 0.2, in C 1; t = 0.3. Equal spacing (A 100 and 400 particles, B 400,
 *             C 800) or equal masses (A 125 and 500, B 501, C 1250); dt = 1e-4 up to 125, else 5e-5
 * Reference   exact, sph_riemann_solve(): P* 0.211420, 0.340559, 0.186231. Zisis, PhD thesis,
 *             Eindhoven 2017, section 5.1, plots profiles and finds: density singular at the
 *             contact without mass flux; left wave smeared and a hump of P with equal spacing;
 *             right of the contact volume smoothing overestimates rho in both layouts, mass
 *             smoothing with equal spacing, whatever dt; C needs a_rho = 1. Numbers: an independent
 *             program, written from the same equations
 * Expected    L1 over [0.1, 0.95] with number smoothing: A 0.0055 and 0.0050 (rho), B 0.0043 and
 *             0.0031, C 0.0025 and 0.0013 (P); P at the contact of A within 10 and 1 per cent
 *
 *   asymmetric_impact            print the figures, write profiles of A as CSV and, with gnuplot, a
 *                                picture
 *   asymmetric_impact validate   one RESULT line a figure
 *   asymmetric_impact long       as above, with all smoothings for B and C as well */
#include "shock_tube.h"

static const double from = 0.1, to = 0.95;

/* A parameter set: the bar on the right, and the sizes of the source. */
typedef struct impact {
  const char *name;
  double rho, c, a_rho;
  double spacing, masses; /* spacing of both layouts */
} impact;

static const impact set_a = {"asymmetric_impact set=A", .25, .5, 0.2, 1.0 / 400, 0.5 / 100};
static const impact set_b = {"asymmetric_impact set=B", .5, .5, 0.2, 1.0 / 400, 0.5 / 167};
static const impact set_c = {"asymmetric_impact set=C", .25, .25, 1.0, 1.0 / 800, 0.5 / 250};

static void add_bar(tube_setup *s, double left, double right, double rho, double v, double c) {
  sph_riemann_side *side = tube_add(s, left, right, rho, v, 0.0);
  side->law = SPH_RIEMANN_BAROTROPIC;
  side->gamma = 1.0; /* the linear law */
  side->density = rho;
  side->sound_speed = c;
}

static tube_setup impact_setup(const impact *a, int equal_masses, int32_t smoothing) {
  tube_setup s = tube_defaults(a->name);
  add_bar(&s, 0.0, 0.5, 1.0, 1.0, 1.0);
  add_bar(&s, 0.5, 1.0, a->rho, 0.0, a->c);
  s.spacing = equal_masses ? a->masses : a->spacing;
  s.equal_masses = equal_masses;
  s.end = 0.3;
  s.dt = s.spacing * (equal_masses ? a->rho : 1.0) > 0.004 ? 1e-4 : 5e-5;
  s.smoothing = smoothing;
  s.loss.mass_flux = a->a_rho;
  s.loss.conductivity = 0.0; /* pressures do not depend on energy */
  return s;
}

/* A run with its figures. */
typedef struct outcome {
  tube t;
  tube_riemann exact;
  tube_errors l1;
  tube_range contact;
  double beside, plateau; /* rho/rho* - 1 right of the contact: at the first particle, and midway
                           * to the shock */
} outcome;

/* The mean over the middle third of what lies between contact and shock. */
static double plateau(const outcome *o) {
  const sph_riemann_solution *s = &o->exact.solution;
  const double contact = o->exact.x0 + o->exact.t * s->v[0];
  const double third = o->exact.t * (s->head[1] - s->v[0]) / 3.0;
  double sum = 0.0;
  int64_t count = 0;
  for (int64_t i = 0; i < o->t.n; ++i)
    if (o->t.x[i] > contact + third && o->t.x[i] < contact + 2.0 * third)
      sum += o->t.rho[i] / s->rho[1] - 1.0, ++count;
  return sum / (double)count;
}

static outcome run(tube_setup s) {
  outcome o;
  need(o.t.ctx, tube_run(&o.t, &s));
  o.exact = tube_solve(o.t.ctx, &s.region[0].state, &s.region[1].state, 0.5, s.end);
  o.l1 = tube_l1(&o.t, from, to, tube_riemann_state, &o.exact);
  o.contact = tube_contact(&o.t, 1, o.exact.solution.p);
  o.beside = o.t.rho[o.t.first[1]] / o.exact.solution.rho[1] - 1.0;
  o.plateau = plateau(&o);
  return o;
}

/* ---- demo -------------------------------------------------------------------------------- */

static const char picture[] =
    "set terminal pngcairo size 1100,900\nset output 'asymmetric_impact.png'\n"
    "set datafile separator ','\nset multiplot layout 3,2\nset xrange [0.4:0.9]\n"
    "do for [k=2:4] {\n  do for [l in 'spacing masses'] {\n"
    "    set ylabel word('x rho P v', k)\n    set title 'equal '.l\n"
    "    plot for [s in 'mass volume number'] 'impact_'.l.'_'.s.'.csv' skip 1 using 1:k \\\n"
    "      with points ps 0.4 title s, 'impact_'.l.'_number.csv' skip 1 using 1:(column(k + 4)) "
    "\\\n"
    "      with lines lc rgb 'black' title 'exact'\n  }\n}\n";

static int demo(void) {
  int failed = 0;
  printf("%-14s %-9s %8s %8s %8s   %-22s %s\n", "layout", "smoothing", "L1 rho", "P", "v",
         "P at the contact, %", "rho right of it, %");
  for (int equal = 0; equal <= 1; ++equal)
    for (int32_t smoothing = SPH_SMOOTHING_MASS; smoothing <= SPH_SMOOTHING_NUMBER; ++smoothing) {
      char path[64];
      outcome o = run(impact_setup(&set_a, equal, smoothing));
      printf("%-14s %-9s %8.4f %8.4f %8.4f   %+7.1f %+7.1f       %+7.1f\n",
             equal ? "equal masses" : "spacing", tube_smoothing(&o.t.setup), o.l1.rho, o.l1.p,
             o.l1.v, o.contact.highest, o.contact.lowest, 100.0 * o.beside);
      failed += smoothing == SPH_SMOOTHING_NUMBER && !(o.l1.rho < 0.0055);
      snprintf(path, sizeof path, "impact_%s_%s.csv", equal ? "masses" : "spacing",
               tube_smoothing(&o.t.setup));
      tube_write(&o.t, path, tube_riemann_state, &o.exact);
      tube_destroy(&o.t);
    }
  draw("asymmetric_impact.gp", picture);
  return failed;
}

/* Every figure with its bound; nothing in there is needed to use the library. */
#include "asymmetric_impact_validate.h"

int main(int argc, char **argv) {
  if (argc < 2 || strcmp(argv[1], "demo") == 0) return demo() != 0;
  return validate(strcmp(argv[1], "long") == 0) != 0;
}
