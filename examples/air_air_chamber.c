/* A square of compressed air bursts in a box of thinner air, with three smoothings.
 *
 * Equations   those of smoothing.h: drho/dt = -rho div v, dv/dt = -grad P/rho, de/dt = -(P/rho)
 *             div v, P = (gamma - 1) rho e, with viscosity, conductivity and mass flux
 * Set-up      gamma = 5/3; |x|, |y| < 0.5: rho = 1, P = 1, outside 0.125 and 0.1, at rest; box
 *             and frame see shock_chamber.h. Equal spacing, N_l = 25, 50, 100 on a unit of length,
 *             masses 8 : 1. Gaussian, eta = 1.2, a_v = 1, a_rho = 0.5, a_e = 0.1, b = 2; t = 0.5
 * Reference   a finite-volume solver, euler_plane.h, on 150 or 300 cells a unit: contact at 0.93
 *             on the axis, shock at 1.425. Zisis, PhD thesis, Eindhoven 2017, section 5.4.1,
 *             plots: with mass and volume smoothing gas infiltrates the dense region, with number
 *             smoothing it does not. Numbers: an independent SPH program, from the same equations
 * Expected    means of 64 bins on the axis, N_l = 50: errors 0.0085 of rho, 0.011 of P at most,
 *             half of those with N_l = 25 or less
 *
 *   air_air_chamber            print the figures and, with gnuplot, draw two pictures
 *   air_air_chamber validate   N_l = 25, 50
 *   air_air_chamber long       100 as well, against 300 cells */
#include "euler_plane.h"
#include "shock_chamber.h"

static const double end_time = 0.5, gas_gamma = 5.0 / 3.0;

static chamber_setup air_air(int cells, int32_t smoothing) {
  chamber_setup c = {.name = "air_air_chamber", .cells = cells, .smoothing = smoothing};
  c.state[INSIDE] = (chamber_state){1.0, 1.0, gas_gamma, 0.0};
  c.state[OUTSIDE] = (chamber_state){0.125, 0.1, gas_gamma, 0.0};
  sph_dissipation_init(&c.loss);
  c.loss.flux_limit = 0.0; /* the source has none; needed beside liquids in tension only */
  return c;
}

static const char *const smoothing_name[] = {"", "mass", "volume", "number"};

/* ---- reference --------------------------------------------------------------------------- */

static void reference_create(euler *g, int cells) {
  euler_create(g, (int)(chamber_bins_end * cells + 0.5), chamber_bins_end, gas_gamma);
  for (int j = 0; j < g->n; ++j)
    for (int i = 0; i < g->n; ++i) {
      const int in = (fmax(i, j) + 0.5) * g->dx < chamber_half;
      g->cell[j * g->n + i] =
          in ? (euler_cell){{1.0, 0.0, 0.0, 1.0}} : (euler_cell){{0.125, 0.0, 0.0, 0.1}};
    }
  euler_run(g, end_time);
}

/* Means along the axis, or the diagonal, over the same bins. */
static chamber_profile reference_bin(const euler *g, int diagonal) {
  chamber_profile b;
  memset(&b, 0, sizeof b);
  for (int i = 0; i < g->n; ++i) {
    const int k = (int)((i + 0.5) * (diagonal ? sqrt(2.0) : 1.0) / g->n * CHAMBER_BINS);
    const double *q = g->cell[diagonal ? i * g->n + i : i].q;
    if (k >= CHAMBER_BINS) break;
    b.count[k] += 1;
    b.rho[k] += q[0];
    b.p[k] += q[3];
    b.e[k] += q[3] / ((gas_gamma - 1.0) * q[0]);
  }
  for (int k = 0; k < CHAMBER_BINS; ++k) {
    b.rho[k] /= b.count[k];
    b.p[k] /= b.count[k];
    b.e[k] /= b.count[k];
  }
  return b;
}

/* Half the jump of the shock, its front taken as the largest pressure beyond 1.2. */
static double shock_level(const chamber_profile *b) {
  double most = 0.1;
  for (int k = (int)(1.2 / chamber_bins_end * CHAMBER_BINS); k < CHAMBER_BINS; ++k)
    if (b->count[k] > 0) most = fmax(most, b->p[k]);
  return 0.5 * (most + 0.1);
}

/* Where the energy falls from that of the shocked outer gas, above 1.5, to that of the inner one,
 * seen from outside: half way is 1.28. */
static double contact_place(const chamber_profile *b) {
  const double width = chamber_bins_end / CHAMBER_BINS, level = 1.28;
  int k = CHAMBER_BINS - 1;
  while (k > 0 && !(b->e[k] > 1.5)) --k;
  while (k > 0 && !(b->e[k] < level)) --k;
  return width * (k + 0.5 + (level - b->e[k]) / (b->e[k + 1] - b->e[k]));
}

/* ---- figures ----------------------------------------------------------------------------- */

typedef struct outcome {
  plane s;
  double rho, p, e; /* mean errors of the bins on the axis */
  double shock, diagonal_shock;
  chamber_range contact, diagonal;
  double overlap; /* of the two gases, in spacings */
} outcome;

static void mean_errors(outcome *o, const chamber_profile *a, const chamber_profile *b) {
  int used = 0;
  for (int k = 0; k < CHAMBER_BINS; ++k) {
    if (a->count[k] == 0) continue;
    o->rho += fabs(a->rho[k] - b->rho[k]);
    o->p += fabs(a->p[k] - b->p[k]);
    o->e += fabs(a->e[k] - b->e[k]);
    ++used;
  }
  o->rho /= used;
  o->p /= used;
  o->e /= used;
}

static outcome run(const chamber_setup *c, const chamber_profile *reference) {
  outcome o;
  memset(&o, 0, sizeof o);
  chamber_create(&o.s, c);
  need(o.s.ctx, plane_run(&o.s, end_time));
  const chamber_profile axis = chamber_bin(&o.s, 0), diagonal = chamber_bin(&o.s, 1);
  mean_errors(&o, &axis, reference);
  o.shock = chamber_shock(&axis, shock_level(&axis));
  o.diagonal_shock = chamber_shock(&diagonal, shock_level(&diagonal));
  o.contact = chamber_contact(&o.s, 0);
  o.diagonal = chamber_contact(&o.s, 1);
  o.overlap = chamber_overlap(&o.s);
  return o;
}

/* ---- demo -------------------------------------------------------------------------------- */

static const char picture[] =
    "set terminal pngcairo size 1300,900\nset output 'air_air_chamber.png'\n"
    "set datafile separator ','\nset key bottom left\nset multiplot layout 2,3\nset xrange "
    "[0:1.6]\n"
    "do for [k=3:5] {\n  set ylabel word('x y rho P e', k)\n"
    "  plot 'number.csv' skip 1 using 7:k with points pt 7 ps 0.3 title 'particles', \\\n"
    "    'axis.csv' skip 1 using 1:(column(k - 1)) with lines lc rgb 'black' title "
    "'finite volumes'\n}\n"
    "set yrange [0:1.6]\nset size ratio -1\nset ylabel 'y'\nset cbrange [0.1:0.5]\n"
    "do for [name in 'mass volume number'] {\n"
    "  plot name.'.csv' skip 1 using 1:2:3 with points pt 7 ps 0.4 palette title name\n}\n";

static void write_axis(const chamber_profile *b) {
  FILE *file = open_output("axis.csv");
  fprintf(file, "x,rho,p,e\n");
  for (int k = 0; k < CHAMBER_BINS; ++k)
    fprintf(file, "%g,%g,%g,%g\n", (k + 0.5) * chamber_bins_end / CHAMBER_BINS, b->rho[k], b->p[k],
            b->e[k]);
  fclose(file);
}

static int demo(void) {
  int failed = 0;
  euler g;
  reference_create(&g, 150);
  const chamber_profile reference = reference_bin(&g, 0);
  write_axis(&reference);
  euler_destroy(&g);
  printf("N_l = 50   %8s %8s %8s %8s %16s %8s\n", "rho", "P", "e", "shock", "contact", "overlap");
  for (int32_t k = SPH_SMOOTHING_MASS; k <= SPH_SMOOTHING_NUMBER; ++k) {
    char name[32];
    const chamber_setup c = air_air(50, k);
    outcome o = run(&c, &reference);
    printf("%-10s %8.4f %8.4f %8.4f %8.4f %8.4f%8.4f %8.2f\n", smoothing_name[k], o.rho, o.p, o.e,
           o.shock, o.contact.inside, o.contact.outside, o.overlap);
    snprintf(name, sizeof name, "%s.csv", smoothing_name[k]);
    chamber_write(&o.s, name);
    failed += k == SPH_SMOOTHING_NUMBER && !(o.rho < 0.0085);
    plane_destroy(&o.s);
  }
  draw("air_air_chamber.gp", picture);
  return failed;
}

/* Every figure with its bound; nothing in there is needed to use the library. */
#include "air_air_chamber_validate.h"

int main(int argc, char **argv) {
  const int proof = argc > 1 && strcmp(argv[1], "demo") != 0;
  return (proof ? validate(strcmp(argv[1], "long") == 0) : demo()) != 0;
}
