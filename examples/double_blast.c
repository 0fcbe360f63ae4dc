/* Two blasts between reflecting walls run into each other: strong shocks, and contacts that are
 * struck again and again.
 *
 * Equations   drho/dt = -rho div v,   dv/dt = -grad P/rho,   de/dt = -(P/rho) div v,
 *             P = (gamma - 1) rho e, as in smoothing.h, with viscosity, conductivity, mass flux
 * Set-up      gamma = 1.4, rho = 1, at rest; P = 1000 in [0, 0.1), 0.01 in [0.1, 0.9), 100 in [0.9,
 *             1]; walls at 0 and 1, mirror images. t = 0.038. Gaussian, eta = 1.2, a_v = 1, a_e =
 *             0.1, b = 2. Equal spacing, which are equal masses here, so that no contact asks for
 *             mass flux, whose bias of the density grows with every shock: a_rho = 0
 * Reference   P. Woodward, P. Colella, J. Comput. Phys. 54 (1984) 115-173, who plot it. Numbers: a
 *             program for finite volumes of second order (HLLC), 25 600 cells, which shares nothing
 *             with this library: the two peaks of density, and its means over 40 bins
 * Expected    L1 of the bins 0.03 with 400 particles, 0.016 with 800; peaks within 5 per cent
 *
 *   double_blast            print the figures, write profiles as CSV and, with gnuplot, a picture
 *   double_blast validate   one RESULT line a figure, 400 and 800 particles
 *   double_blast long       1600 as well */
#include "shock_tube.h"

enum { BINS = 40 };

static const double bins[BINS] = {0.1462, 0.1480, 0.1497, 0.1516, 0.1537, 0.1557, 0.1578, 0.1599,
                                  0.1620, 0.1641, 0.1662, 0.1684, 0.1706, 0.1729, 0.1751, 0.1774,
                                  0.1795, 0.1806, 0.1817, 0.1828, 0.1838, 0.1849, 0.1860, 0.6212,
                                  2.0500, 2.5461, 5.0162, 4.3392, 3.9486, 3.3683, 4.5929, 5.7216,
                                  0.8542, 0.8603, 0.6790, 0.3087, 0.3087, 0.3087, 0.3087, 0.3087};

static tube_setup blasts(int particles, double a_rho) {
  static const double edges[] = {0.0, 0.1, 0.9, 1.0}, p[] = {1000.0, 0.01, 100.0};
  tube_setup s = tube_defaults("double_blast");
  for (int k = 0; k < 3; ++k) tube_add(&s, edges[k], edges[k + 1], 1.0, 0.0, p[k])->gamma = 1.4;
  s.spacing = 1.0 / particles;
  s.mirror[0] = s.mirror[1] = 1;
  s.end = 0.038;
  s.loss.mass_flux = a_rho;
  return s;
}

/* The mean density of a bin: a particle stands for half the way to its neighbours. */
static double bin_mean(const tube *t, int bin) {
  const double lo = (double)bin / BINS, hi = (double)(bin + 1) / BINS;
  double sum = 0.0;
  for (int64_t i = 0; i < t->n; ++i) {
    const double from = i == 0 ? 0.0 : 0.5 * (t->x[i - 1] + t->x[i]);
    const double to = i + 1 == t->n ? 1.0 : 0.5 * (t->x[i] + t->x[i + 1]);
    sum += t->rho[i] * fmax(fmin(to, hi) - fmax(from, lo), 0.0);
  }
  return sum * BINS;
}

static double bins_l1(const tube *t) {
  double sum = 0.0;
  for (int k = 0; k < BINS; ++k) sum += fabs(bin_mean(t, k) - bins[k]);
  return sum / BINS;
}

/* A peak of density between two places. */
typedef struct peak {
  double x, rho;
} peak;

static peak highest(const tube *t, double from, double to) {
  peak p = {NAN, 0.0};
  for (int64_t i = 0; i < t->n; ++i)
    if (t->x[i] > from && t->x[i] < to && t->rho[i] > p.rho) p = (peak){t->x[i], t->rho[i]};
  return p;
}

/* ---- demo -------------------------------------------------------------------------------- */

static tube_state bin_state(void *user, double x) {
  (void)user;
  const int bin = (int)fmin(fmax(x * BINS, 0.0), BINS - 1);
  return (tube_state){bins[bin], NAN, NAN, NAN};
}

static const char picture[] =
    "set terminal pngcairo size 1100,900\nset output 'double_blast.png'\n"
    "set datafile separator ','\nset multiplot layout 3,1\nset xrange [0.5:0.9]\n"
    "do for [k=2:4] {\n  set ylabel word('x rho P v', k)\n"
    "  plot 'blast_400.csv' skip 1 using 1:k with points pt 6 ps 0.4 title '400', \\\n"
    "    'blast_800.csv' skip 1 using 1:k with points pt 2 ps 0.4 title '800', \\\n"
    "    'blast_800.csv' skip 1 using 1:(k == 2 ? $6 : NaN) with steps title 'bins'\n}\n";

static int demo(void) {
  int failed = 0;
  printf("%-9s %8s   %-22s %s\n", "particles", "L1 bins", "left peak at", "right peak at");
  for (int particles = 400; particles <= 800; particles *= 2) {
    const tube_setup s = blasts(particles, 0.0);
    char path[32];
    tube t;
    need(t.ctx, tube_run(&t, &s));
    const peak left = highest(&t, 0.5, 0.7), right = highest(&t, 0.7, 0.85);
    printf("%-9d %8.4f   %.4f %.4f          %.4f %.4f\n", particles, bins_l1(&t), left.rho, left.x,
           right.rho, right.x);
    snprintf(path, sizeof path, "blast_%d.csv", particles);
    tube_write(&t, path, bin_state, NULL);
    failed += !(bins_l1(&t) < 0.04);
    tube_destroy(&t);
  }
  draw("double_blast.gp", picture);
  return failed;
}

/* Every figure with its bound; nothing in there is needed to use the library. */
#include "double_blast_validate.h"

int main(int argc, char **argv) {
  if (argc < 2 || strcmp(argv[1], "demo") == 0) return demo() != 0;
  return validate(strcmp(argv[1], "long") == 0) != 0;
}
