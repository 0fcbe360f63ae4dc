/* Cold gas that falls on a plane, an axis and a point: a shock of infinite strength that runs
 * outwards.
 *
 * Equations   drho/dt = -rho div v,   dv/dt = -grad P/rho,   de/dt = -(P/rho) div v,
 *             P = (gamma - 1) rho e, as in smoothing.h, with viscosity and conductivity
 * Set-up      gamma = 5/3, rho = 1, e = 0, v = -x/r in a ball of radius 1, whose free surface
 *             stands at r = 0.4 at the end, t = 0.6; planar, 1.6 and 1.0. Gaussian, eta = 1.2,
 *             a_v = 1, a_e = 1, b = 2, a_rho = 0
 * Reference   exact, sph_noh_solution(): rho = 4, 16, 64 within r = 0.2. W. Noh, J. Comput. Phys.
 *             72 (1987) 78-120. Every scheme with artificial viscosity heats the centre and leaves
 *             the density too low there
 * Expected    planar, 100 particles a unit length: L1 of the density over [0, 1] 0.033.
 *             Cylindrical, 100 across: 14.9 behind the shock, 16 exactly. Spherical: 64 asks for
 *             four spacings of the start in each one behind the shock; 28 across give 20
 *
 *   noh            print the figures, write profiles as CSV and, with gnuplot, a picture
 *   noh validate   one RESULT line a figure
 *   noh long       more particles in 3-D */
#include "radial.h"

static const double front = 0.2; /* the shock at the end */

static radial_setup noh(int32_t dim, int across) {
  radial_setup s = radial_defaults("noh", dim, across);
  s.gamma = 5.0 / 3.0;
  s.end = 0.6;
  if (dim == 1) s.radius = 1.6; /* of which [0, 1] is left at the end */
  s.loss.mass_flux = 0.0;       /* one gas of one density: no contact asks for it */
  s.loss.conductivity = 1.0;    /* less heat at the centre */
  return s;
}

/* A run with its exact density at every particle. */
typedef struct outcome {
  radial a;
  double *exact;
  double l1;
} outcome;

static outcome run(radial_setup s) {
  outcome o;
  sph_noh_options options;
  radial_create(&o.a, &s);
  for (int64_t i = 0; i < o.a.n; ++i)
    for (int32_t k = 0; k < s.dim; ++k)
      o.a.v[i * s.dim + k] = -o.a.x[i * s.dim + k] / radial_distance(&o.a, i);
  radial_run(&o.a);
  sph_noh_options_init(&options);
  options.dim = s.dim;
  o.exact = malloc((size_t)o.a.n * sizeof *o.exact);
  if (!o.exact) exit(2);
  need(o.a.ctx,
       sph_noh_solution(o.a.ctx, &options, s.end, o.a.n, o.a.r, o.exact, NULL, NULL, NULL));
  o.l1 = radial_l1(&o.a, o.exact, s.dim == 1 ? 1.0 : 0.35);
  return o;
}

static void end(outcome *o) {
  free(o->exact);
  radial_destroy(&o->a);
}

/* ---- demo -------------------------------------------------------------------------------- */

static const char picture[] =
    "set terminal pngcairo size 1100,500\nset output 'noh.png'\n"
    "set datafile separator ','\nset multiplot layout 1,3\nset xrange [0:0.45]\n"
    "do for [d=1:3] {\n  set title sprintf('%d-D', d)\n"
    "  plot sprintf('noh_%d.csv', d) skip 1 using 1:2 with points pt 6 ps 0.3 title 'rho', \\\n"
    "    '' skip 1 using 1:4 with dots lc rgb 'black' title 'exact'\n}\n";

static int demo(void) {
  static const int across[] = {200, 100, 20};
  int failed = 0;
  printf("%-4s %9s %9s   %-20s %s\n", "dim", "particles", "L1 rho", "rho behind the shock",
         "exact");
  for (int32_t dim = 1; dim <= 3; ++dim) {
    char path[32];
    outcome o = run(noh(dim, across[dim - 1]));
    printf("%-4d %9lld %9.4f   %-20.3f %.0f\n", (int)dim, (long long)o.a.n, o.l1,
           radial_mean(&o.a, 0.4 * front, 0.8 * front), pow(4.0, dim));
    snprintf(path, sizeof path, "noh_%d.csv", (int)dim);
    radial_write(&o.a, path, o.exact);
    failed += !(o.l1 < 0.2 * pow(4.0, dim));
    end(&o);
  }
  draw("noh.gp", picture);
  return failed;
}

/* Every figure with its bound; nothing in there is needed to use the library. */
#include "noh_validate.h"

int main(int argc, char **argv) {
  if (argc < 2 || strcmp(argv[1], "demo") == 0) return demo() != 0;
  return validate(strcmp(argv[1], "long") == 0) != 0;
}
