/* A bar strikes another, and the shock runs on into a light layer: two Riemann problems in a row.
 *
 * Equations   drho/dt = -rho div v,   dv/dt = -grad P/rho,   P = c0^2 (rho - rho0), as in
 *             smoothing.h, with viscosity and mass flux
 * Set-up      {rho, v, rho0, c0}: [0, 0.6) {1, 1, 1, 1} strikes [0.6, 0.8) {1, 0, 1, 1}; then [0.8,
 *             1.2) {0.25, 0, 0.25, 0.5} and [1.2, 1.4] {1, 0, 1, 1}; ends free. Gaussian, eta =
 *             1.2, a_v = 1, a_rho = 0.2, b = 2, t = 0.4, dt = 5e-5. Equal spacing 0.0025, or equal
 *             masses, spacing 0.005 in the layer
 * Reference   exact, sph_riemann_solve() twice: impact P 0.640388, v 0.5; the shock reaches the
 *             layer at 0.156155; then P* 0.209918, v* 0.804380. At the end left shock 0.487689, fan
 *             from 0.678078 to 0.752299, contact 0.996144, shock 1.054543. Zisis, PhD thesis,
 *             Eindhoven 2017, section 5.1, takes jump relations for the fan (P* 0.210287) and plots
 *             profiles: P nearly flat at the contact with equal masses, a small hump without
 * Expected    L1 of P over [0.4, 1.35]: at most 0.0065 (equal spacing), 0.0040 (equal masses); P at
 *             the contact within 15 and 3 per cent of P*; waves within 2 h of their places
 *
 *   isothermal_bar            print the figures, write profiles as CSV and, with gnuplot, a picture
 *   isothermal_bar validate   one RESULT line a figure */
#include "shock_tube.h"

static const double from = 0.4, to = 1.35;

static void add_bar(tube_setup *s, double left, double right, double rho, double v, double c) {
  sph_riemann_side *side = tube_add(s, left, right, rho, v, 0.0);
  side->law = SPH_RIEMANN_BAROTROPIC;
  side->gamma = 1.0; /* the linear law */
  side->density = rho;
  side->sound_speed = c;
}

static tube_setup bar(double spacing, int equal_masses, int32_t smoothing) {
  tube_setup s = tube_defaults("isothermal_bar");
  add_bar(&s, 0.0, 0.6, 1.0, 1.0, 1.0);
  add_bar(&s, 0.6, 0.8, 1.0, 0.0, 1.0);
  add_bar(&s, 0.8, 1.2, 0.25, 0.0, 0.5);
  add_bar(&s, 1.2, 1.4, 1.0, 0.0, 1.0);
  s.spacing = spacing;
  s.equal_masses = equal_masses;
  s.end = 0.4;
  s.dt = 5e-5;
  s.smoothing = smoothing;
  s.loss.mass_flux = 0.2;
  s.loss.conductivity = 0.0; /* pressures do not depend on energy */
  return s;
}

/* A run with its figures. */
typedef struct outcome {
  tube t;
  tube_relay exact;
  tube_errors l1;
  tube_range contact;
} outcome;

static outcome run(tube_setup s) {
  outcome o;
  need(o.t.ctx, tube_run(&o.t, &s));
  o.exact = tube_relay_solve(o.t.ctx, &s);
  o.l1 = tube_l1(&o.t, from, to, tube_relay_state, &o.exact);
  o.contact = tube_contact(&o.t, 2, o.exact.second.solution.p);
  return o;
}

/* ---- demo -------------------------------------------------------------------------------- */

static const char picture[] =
    "set terminal pngcairo size 1100,900\nset output 'isothermal_bar.png'\n"
    "set datafile separator ','\nset multiplot layout 3,1\nset xrange [0.4:1.35]\n"
    "do for [k=2:4] {\n  set ylabel word('x rho P v', k)\n"
    "  plot 'bar_spacing.csv' skip 1 using 1:k with points pt 6 ps 0.4 title 'equal spacing', \\\n"
    "    'bar_masses.csv' skip 1 using 1:k with points pt 2 ps 0.5 title 'equal masses', \\\n"
    "    'bar_spacing.csv' skip 1 using 1:(column(k + 4)) with lines lc rgb 'black' title 'exact'\n"
    "}\n";

static int demo(void) {
  static const char *const files[] = {"bar_spacing.csv", "bar_masses.csv"};
  int failed = 0;
  printf("%-14s %-9s %8s %8s %8s   %s\n", "layout", "smoothing", "L1 rho", "P", "v",
         "P at the contact, %");
  for (int equal = 0; equal <= 1; ++equal)
    for (int32_t smoothing = SPH_SMOOTHING_MASS; smoothing <= SPH_SMOOTHING_NUMBER; ++smoothing) {
      outcome o = run(bar(equal ? 0.005 : 0.0025, equal, smoothing));
      printf("%-14s %-9s %8.4f %8.4f %8.4f   %+.1f %+.1f\n", equal ? "equal masses" : "spacing",
             tube_smoothing(&o.t.setup), o.l1.rho, o.l1.p, o.l1.v, o.contact.highest,
             o.contact.lowest);
      failed += smoothing == SPH_SMOOTHING_NUMBER && !(o.l1.p < 0.0065);
      if (smoothing == SPH_SMOOTHING_NUMBER)
        tube_write(&o.t, files[equal], tube_relay_state, &o.exact);
      tube_destroy(&o.t);
    }
  draw("isothermal_bar.gp", picture);
  return failed;
}

/* Every figure with its bound; nothing in there is needed to use the library. */
#include "isothermal_bar_validate.h"

int main(int argc, char **argv) {
  return (argc > 1 && strcmp(argv[1], "demo") != 0 ? validate() : demo()) != 0;
}
