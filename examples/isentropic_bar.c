/* A bar strikes another, and the shock runs on into a light layer, with energy: two Riemann
 * problems in a row of materials whose pressure depends on density and energy.
 *
 * Equations   drho/dt = -rho div v,   dv/dt = -grad P/rho,   de/dt = -(P/rho) div v,
 *             P = K1 u + K2 u^2 + K3 u^3 + B0 rho0 e, u = rho/rho0 - 1, as in smoothing.h, with
 *             viscosity, conductivity and mass flux
 * Set-up      {rho, v, c0, S0, B0}: [0, 0.6) {1, 1, 1, 1.338, 2} strikes [0.6, 0.8) {1, 0, ...};
 *             then [0.8, 1.2) {0.4, 0, 0.484, 1.47, 0.67} and [1.2, 1.4] the first again; all rho =
 *             rho0, e = 0, ends free. Gaussian, eta = 1.2, a_v = 1, a_rho = a_e = 0.5, b = 2, t =
 *             0.25. Equal spacing 0.0025, or equal masses, spacing 0.005 in the layer
 * Reference   exact, sph_riemann_solve() twice: impact P 0.915769, v 0.5; the shock reaches the
 *             layer at 0.109198; then P* 0.427406, v* 0.715966. At the end left shock 0.39212, fan
 *             from 0.60112 to 0.68090, contact 0.90081, shock 1.01013. Zisis, PhD thesis, Eindhoven
 *             2017, section 5.3, has no exact solution and leaves open whether a wave of e behind
 *             the fan is physical: it is not, the exact e is uniform there. Numbers: an independent
 *             program, written from the same equations
 * Expected    L1 of P over [0.3, 1.15] at most 0.0092 (equal spacing), 0.0084 (equal masses); P at
 *             the contact within 10 per cent of P*
 *
 *   isentropic_bar            print the figures, write profiles as CSV and, with gnuplot, a picture
 *   isentropic_bar validate   one RESULT line a figure */
#include "shock_tube.h"

static const double from = 0.3, to = 1.15;

static void add_bar(tube_setup *s, double left, double right, double v, int light) {
  sph_riemann_side *side = tube_add(s, left, right, light ? 0.4 : 1.0, v, 0.0);
  side->law = SPH_RIEMANN_MIE_GRUNEISEN;
  side->curve = SPH_COLD_CUBIC;
  side->density = side->rho;
  side->sound_speed = light ? 0.484 : 1.0;
  side->slope = light ? 1.47 : 1.338;
  side->gruneisen = light ? 0.67 : 2.0;
}

static tube_setup bar(int equal_masses, double a_rho, double a_e) {
  tube_setup s = tube_defaults("isentropic_bar");
  add_bar(&s, 0.0, 0.6, 1.0, 0);
  add_bar(&s, 0.6, 0.8, 0.0, 0);
  add_bar(&s, 0.8, 1.2, 0.0, 1);
  add_bar(&s, 1.2, 1.4, 0.0, 0);
  s.spacing = equal_masses ? 0.005 : 0.0025;
  s.equal_masses = equal_masses;
  s.end = 0.25;
  s.dt = 5e-5; /* the source gives none here; that of its isothermal bar */
  s.loss.mass_flux = a_rho;
  s.loss.conductivity = a_e;
  return s;
}

/* A run with its figures. */
typedef struct outcome {
  tube t;
  tube_relay exact;
  tube_errors l1;
  tube_range contact;
  double heat; /* largest e around the face of impact, between fan and layer */
} outcome;

/* Within 12 particles of the face, where the exact e is that of the expanded state or of the fan.
 */
static double wall_heating(const tube *t) {
  double largest = 0.0;
  for (int64_t i = t->first[1] - TUBE_AROUND; i <= t->first[1] + TUBE_AROUND; ++i)
    largest = fmax(largest, t->e[i]);
  return largest;
}

static outcome run(tube_setup s) {
  outcome o;
  need(o.t.ctx, tube_run(&o.t, &s));
  o.exact = tube_relay_solve(o.t.ctx, &s);
  o.l1 = tube_l1(&o.t, from, to, tube_relay_state, &o.exact);
  o.contact = tube_contact(&o.t, 2, o.exact.second.solution.p);
  o.heat = wall_heating(&o.t);
  return o;
}

/* ---- demo -------------------------------------------------------------------------------- */

static const char picture[] =
    "set terminal pngcairo size 1100,800\nset output 'isentropic_bar.png'\n"
    "set datafile separator ','\nset multiplot layout 2,2\nset xrange [0.3:1.15]\n"
    "do for [k=2:5] {\n  set ylabel word('x rho P v e', k)\n"
    "  plot 'isentropic_spacing.csv' skip 1 using 1:k with points pt 6 ps 0.4 title \\\n"
    "    'equal spacing', 'isentropic_masses.csv' skip 1 using 1:k with points pt 2 ps 0.4 \\\n"
    "    title 'equal masses', 'isentropic_spacing.csv' skip 1 using 1:(column(k + 4)) \\\n"
    "    with lines lc rgb 'black' title 'exact'\n}\n";

static int demo(void) {
  static const char *const files[] = {"isentropic_spacing.csv", "isentropic_masses.csv"};
  int failed = 0;
  printf("%-14s %8s %8s %8s   %s\n", "layout", "L1 rho", "P", "v", "P at the contact, %");
  for (int equal = 0; equal <= 1; ++equal) {
    outcome o = run(bar(equal, 0.5, 0.5));
    printf("%-14s %8.4f %8.4f %8.4f   %+.1f %+.1f\n", equal ? "equal masses" : "spacing", o.l1.rho,
           o.l1.p, o.l1.v, o.contact.highest, o.contact.lowest);
    failed += !(o.l1.p < 0.0092);
    tube_write(&o.t, files[equal], tube_relay_state, &o.exact);
    tube_destroy(&o.t);
  }
  draw("isentropic_bar.gp", picture);
  return failed;
}

/* Every figure with its bound; nothing in there is needed to use the library. */
#include "isentropic_bar_validate.h"

int main(int argc, char **argv) {
  return (argc > 1 && strcmp(argv[1], "demo") != 0 ? validate() : demo()) != 0;
}
