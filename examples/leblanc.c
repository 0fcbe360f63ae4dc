/* The shock tube of LeBlanc: a pressure ratio of 10^9, a density ratio of 1000.
 *
 * Equations   drho/dt = -rho div v,   dv/dt = -grad P/rho,   de/dt = -(P/rho) div v,
 *             P = (gamma - 1) rho e, as in smoothing.h, with viscosity, conductivity, mass flux
 * Set-up      gamma = 5/3; left of x = 3 rho = 1, e = 0.1, right of it rho = 0.001, e = 1e-7, at
 *             rest; [0, 9], beyond which the particles stay as they are. t = 6. Gaussian, eta =
 *             1.2, a_v = 1, a_rho = 0.5, a_e = 0.1, b = 2; equal spacing, masses of 1 to 1000
 * Reference   exact, sph_riemann_solve()
 * Expected    L1 of e over [0, 9] 0.075, 0.037, 0.017 with 450, 900, 1800 particles; the shock,
 *             exactly at 7.975, runs ahead by 0.79, 0.37, 0.17
 *
 *   leblanc            print the figures, write profiles as CSV and, with gnuplot, a picture
 *   leblanc validate   one RESULT line a figure, 450 and 900 particles
 *   leblanc long       1800 as well */
#include "shock_tube.h"

static const double x0 = 3.0, length = 9.0, gamma_gas = 5.0 / 3.0;

static tube_setup leblanc(int particles) {
  tube_setup s = tube_defaults("leblanc");
  tube_add(&s, 0.0, x0, 1.0, 0.0, (gamma_gas - 1.0) * 0.1)->gamma = gamma_gas;
  tube_add(&s, x0, length, 1e-3, 0.0, (gamma_gas - 1.0) * 1e-10)->gamma = gamma_gas;
  s.spacing = length / particles;
  s.frozen = 0.5;
  s.end = 6.0;
  s.first = 1e-3 * s.spacing;
  s.loss.flux_limit = 0.1; /* without, the flux of the first steps empties the gas beside x = 3 */
  return s;
}

/* A run with its figures. */
typedef struct outcome {
  tube t;
  tube_riemann exact;
  tube_errors l1;
  double shock, contact; /* their places */
} outcome;

static outcome run(tube_setup s) {
  outcome o;
  const sph_status status = tube_run(&o.t, &s);
  need(o.t.ctx, status);
  o.exact = tube_solve(o.t.ctx, &s.region[0].state, &s.region[1].state, x0, s.end);
  o.l1 = tube_l1(&o.t, 0.0, length, tube_riemann_state, &o.exact);
  o.shock = tube_crossing(&o.t, o.t.v, 0.5 * o.exact.solution.v[1],
                          x0 + s.end * o.exact.solution.head[1]);
  o.contact = 0.5 * (o.t.x[o.t.first[1] - 1] + o.t.x[o.t.first[1]]);
  return o;
}

/* ---- demo -------------------------------------------------------------------------------- */

static const char picture[] =
    "set terminal pngcairo size 1100,800\nset output 'leblanc.png'\n"
    "set datafile separator ','\nset multiplot layout 2,2\nset xrange [0:9]\n"
    "do for [k=2:5] {\n  set ylabel word('x rho P v e', k)\n"
    "  if (k < 4) { set logscale y } else { unset logscale y }\n"
    "  plot 'leblanc_450.csv' skip 1 using 1:k with points pt 6 ps 0.4 title '450', \\\n"
    "    'leblanc_1800.csv' skip 1 using 1:k with points pt 2 ps 0.3 title '1800', \\\n"
    "    'leblanc_1800.csv' skip 1 using 1:(column(k + 4)) with lines lc rgb 'black' title "
    "'exact'\n"
    "}\n";

static int demo(void) {
  int failed = 0;
  printf("%-9s %9s %9s %9s %9s %9s %9s\n", "particles", "L1 rho", "P", "v", "e", "shock",
         "contact");
  for (int particles = 450; particles <= 1800; particles *= 2) {
    char path[32];
    outcome o = run(leblanc(particles));
    printf("%-9d %9.3g %9.3g %9.3g %9.3g %9.4f %9.4f\n", particles, o.l1.rho, o.l1.p, o.l1.v,
           o.l1.e, o.shock, o.contact);
    snprintf(path, sizeof path, "leblanc_%d.csv", particles);
    tube_write(&o.t, path, tube_riemann_state, &o.exact);
    failed += !(o.l1.rho < 0.02);
    tube_destroy(&o.t);
  }
  draw("leblanc.gp", picture);
  return failed;
}

/* Every figure with its bound; nothing in there is needed to use the library. */
#include "leblanc_validate.h"

int main(int argc, char **argv) {
  if (argc < 2 || strcmp(argv[1], "demo") == 0) return demo() != 0;
  return validate(strcmp(argv[1], "long") == 0) != 0;
}
