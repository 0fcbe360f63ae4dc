/* A shock tube between a liquid and a gas of a twentieth of its density.
 *
 * Equations   drho/dt = -rho div v,   dv/dt = -grad P/rho,   de/dt = -(P/rho) div v,
 *             P = (gamma - 1) rho e - gamma P_ref, as in smoothing.h, with viscosity, conductivity
 *             and mass flux
 * Set-up      liquid rho = 1, P = 1, gamma = 4.4, P_ref = 0.6 left of x = 0.7, gas rho = 0.05, P =
 *             0.01, gamma = 1.4 right of it, at rest, in 10^3 kg/m^3, GPa, km/s; [0, 1], beyond
 *             which the particles stay as they are. t = 0.23, 200 and 800 particles of equal
 *             spacing. Gaussian, eta = 1.2, a_v = 1, a_rho = 0.5, a_e = 0.1, b = 2. Source: Zisis,
 *             PhD thesis, Eindhoven 2017, section 5.2.3. It prints t = 0.0023, by when waves have
 *             moved by 0.006; no place of the jump, which must be beyond 0.61; dt = 1e-8 s,
 *             which is 1e-5 here
 * Reference   exact, sph_riemann_solve(): P* 0.0308105, v* 0.471431; fan from 0.08974 to 0.38250,
 *             contact 0.80843, shock 0.90306. Published: P has a hump at the contact, the shock
 *             steepens towards its place with more particles. Numbers: an independent program
 * Expected    L1 of P over [0.05, 0.95] 0.0027 with 800, a third of that with 200; P at the contact
 *             up to 56 per cent above P*; shock within two spacings
 *
 *   liquid_gas_tube            print the figures, write profiles as CSV and, with gnuplot, a
 *                              picture
 *   liquid_gas_tube validate   one RESULT line a figure */
#include "shock_tube.h"

static const double x0 = 0.7, from = 0.05, to = 0.95, gas_p = 0.01;

static tube_setup liquid_gas(int particles, double a_rho) {
  tube_setup s = tube_defaults("liquid_gas_tube");
  sph_riemann_side *liquid = tube_add(&s, 0.0, x0, 1.0, 0.0, 1.0);
  liquid->gamma = 4.4;
  liquid->reference_pressure = 0.6;
  tube_add(&s, x0, 1.0, 0.05, 0.0, gas_p)->gamma = 1.4;
  s.spacing = 1.0 / particles;
  s.frozen = 0.2;
  s.end = 0.23;
  s.dt =
      2e-5; /* a sixth of the stable step, which makes the dip of P at the contact twice as deep */
  s.loss.mass_flux = a_rho;
  return s;
}

/* A run with its figures. */
typedef struct outcome {
  tube t;
  tube_riemann exact;
  tube_errors l1;
  tube_range contact;
  double shock; /* its place */
} outcome;

static outcome run(tube_setup s) {
  outcome o;
  need(o.t.ctx, tube_run(&o.t, &s));
  o.exact = tube_solve(o.t.ctx, &s.region[0].state, &s.region[1].state, x0, s.end);
  o.l1 = tube_l1(&o.t, from, to, tube_riemann_state, &o.exact);
  o.contact = tube_contact(&o.t, 1, o.exact.solution.p);
  o.shock = tube_crossing(&o.t, o.t.p, 0.5 * (o.exact.solution.p + gas_p),
                          x0 + s.end * o.exact.solution.head[1]);
  return o;
}

/* ---- demo -------------------------------------------------------------------------------- */

static const char picture[] =
    "set terminal pngcairo size 1100,800\nset output 'liquid_gas_tube.png'\n"
    "set datafile separator ','\nset multiplot layout 2,2\nset xrange [0.05:0.95]\n"
    "do for [k=2:5] {\n  set ylabel word('x rho P v e', k)\n"
    "  plot 'liquid_gas_200.csv' skip 1 using 1:k with points pt 6 ps 0.5 title '200', \\\n"
    "    'liquid_gas_800.csv' skip 1 using 1:k with points pt 2 ps 0.3 title '800', \\\n"
    "    'liquid_gas_800.csv' skip 1 using 1:(column(k + 4)) with lines lc rgb 'black' title "
    "'exact'\n"
    "}\n";

static int demo(void) {
  int failed = 0;
  printf("%-9s %8s %8s %8s   %-20s %s\n", "particles", "L1 rho", "P", "v", "P at the contact, %",
         "shock (0.90306)");
  for (int particles = 200; particles <= 800; particles *= 4) {
    char path[32];
    outcome o = run(liquid_gas(particles, 0.5));
    printf("%-9d %8.4f %8.4f %8.4f   %+.1f %+.1f          %.5f\n", particles, o.l1.rho, o.l1.p,
           o.l1.v, o.contact.highest, o.contact.lowest, o.shock);
    failed += particles == 800 && !(o.l1.p < 0.0027);
    snprintf(path, sizeof path, "liquid_gas_%d.csv", particles);
    tube_write(&o.t, path, tube_riemann_state, &o.exact);
    tube_destroy(&o.t);
  }
  draw("liquid_gas_tube.gp", picture);
  return failed;
}

/* Every figure with its bound; nothing in there is needed to use the library. */
#include "liquid_gas_tube_validate.h"

int main(int argc, char **argv) {
  return (argc > 1 && strcmp(argv[1], "demo") != 0 ? validate() : demo()) != 0;
}
