/* The shock tube of Sod with equal spacing or equal masses: what three smoothings make of it.
 *
 * Equations   drho/dt = -rho div v,   dv/dt = -grad P/rho,   de/dt = -(P/rho) div v,
 *             P = (gamma - 1) rho e, as in smoothing.h, with viscosity, conductivity, mass flux
 * Set-up      gamma = 5/3; left of x = 0.5 rho = 1, P = 1, right of it rho = 0.125, P = 0.1, at
 * rest; [0, 1], beyond which the particles stay as they are. Gaussian, eta = 1.2, a_v = 1, a_rho =
 * 0.5, a_e = 0.1, b = 2. Equal spacing: N = 400; equal masses: 400 + 50. The source prints a
 * spacing of 0.001 for the latter, which would give 4500. Reference   exact, sph_riemann_solve():
 * P* = 0.293945, u* = 0.841195, densities 0.479689 and 0.229806 at the contact x = 0.66824, shock
 * at 0.86889 when t = 0.2. Zisis, PhD thesis, Eindhoven 2017, section 5.2.1, prints profiles, no
 * numbers: P is flat at the contact with equal masses, has a hump with unequal ones, a spike
 * without mass flux. Numbers: an independent program, written from the same equations. Expected L1
 * of the density over [0.1, 0.95]: 0.0039 (equal spacing), 0.0049 (equal masses) at most; P at the
 * contact within 19 and 4 per cent of P*.
 *
 *   air_air_tube            print the figures, write profiles as CSV and, with gnuplot, a picture
 *   air_air_tube validate   one RESULT line a figure */
#include "shock_tube.h"

static const double x0 = 0.5, from = 0.1, to = 0.95, end_time = 0.2;

static tube_setup air_air(double spacing, int equal_masses, int32_t smoothing, double a_rho) {
  tube_setup s = tube_defaults("air_air_tube");
  tube_add(&s, 0.0, x0, 1.0, 0.0, 1.0)->gamma = 5.0 / 3.0;
  tube_add(&s, x0, 1.0, 0.125, 0.0, 0.1)->gamma = 5.0 / 3.0;
  s.spacing = spacing;
  s.equal_masses = equal_masses;
  s.frozen = 0.2;
  s.end = end_time;
  s.dt = 5e-5; /* the source's; the stable step gives the same profiles in a fifth of the steps */
  s.smoothing = smoothing;
  s.loss.mass_flux = a_rho;
  return s;
}

/* A run with its figures. */
typedef struct outcome {
  tube t;
  tube_riemann exact;
  tube_errors l1;
  tube_range contact;
  double drift, shock; /* change of total energy, relative; place of the shock */
} outcome;

static outcome run(tube_setup s) {
  outcome o;
  need(o.t.ctx, tube_run(&o.t, &s));
  o.exact = tube_solve(o.t.ctx, &s.region[0].state, &s.region[1].state, x0, s.end);
  o.l1 = tube_l1(&o.t, from, to, tube_riemann_state, &o.exact);
  o.contact = tube_contact(&o.t, 1, o.exact.solution.p);
  o.drift = fabs(o.t.ledger.total / o.t.energy_start - 1.0);
  o.shock = tube_crossing(&o.t, o.t.p, 0.5 * (o.exact.solution.p + 0.1),
                          x0 + s.end * o.exact.solution.head[1]);
  return o;
}

/* ---- demo -------------------------------------------------------------------------------- */

static const char picture[] =
    "set terminal pngcairo size 1100,800\nset output 'air_air_tube.png'\n"
    "set datafile separator ','\nset multiplot layout 2,2\nset xrange [0.1:0.95]\n"
    "do for [k=2:5] {\n  set ylabel word('x rho P v e', k)\n"
    "  plot 'equal_spacing.csv' skip 1 using 1:k with points pt 6 ps 0.4 title 'equal spacing', "
    "\\\n"
    "    'equal_masses.csv' skip 1 using 1:k with points pt 2 ps 0.5 title 'equal masses', \\\n"
    "    'equal_spacing.csv' skip 1 using 1:(column(k + 4)) with lines lc rgb 'black' title "
    "'exact'\n"
    "}\n";

static int demo(void) {
  static const char *const files[] = {"equal_spacing.csv", "equal_masses.csv"};
  int failed = 0;
  printf("%-14s %-9s %8s %8s %8s   %s\n", "layout", "smoothing", "L1 rho", "P", "v",
         "P at the contact, %");
  for (int equal = 0; equal <= 1; ++equal)
    for (int32_t smoothing = SPH_SMOOTHING_MASS; smoothing <= SPH_SMOOTHING_NUMBER; ++smoothing) {
      outcome o = run(air_air(equal ? 0.01 : 0.0025, equal, smoothing, 0.5));
      printf("%-14s %-9s %8.4f %8.4f %8.4f   %+.1f %+.1f\n", equal ? "equal masses" : "spacing",
             tube_smoothing(&o.t.setup), o.l1.rho, o.l1.p, o.l1.v, o.contact.highest,
             o.contact.lowest);
      failed += smoothing == SPH_SMOOTHING_NUMBER && !(o.l1.rho < 0.0049);
      if (smoothing == SPH_SMOOTHING_NUMBER)
        tube_write(&o.t, files[equal], tube_riemann_state, &o.exact);
      tube_destroy(&o.t);
    }
  draw("air_air_tube.gp", picture);
  return failed;
}

/* Every figure with its bound; nothing in there is needed to use the library. */
#include "air_air_tube_validate.h"

int main(int argc, char **argv) {
  return (argc > 1 && strcmp(argv[1], "demo") != 0 ? validate() : demo()) != 0;
}
