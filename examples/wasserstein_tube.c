/* The shock tube of Sod as a measure: how far two resolutions are from each other, in the distance
 * of Wasserstein, without any exact solution.
 *
 * Equations   drho/dt = -rho div v,   dv/dt = -grad P/rho,   de/dt = -(P/rho) div v,
 *             P = (gamma - 1) rho e, as in smoothing.h, with viscosity, conductivity, mass flux
 * Set-up      gamma = 5/3; left of x = 0.5 rho = 1, P = 1, right of it rho = 0.125, P = 0.1, at
 *             rest; [0, 1], beyond which the particles stay as they are. Equal masses, N = 18, 45,
 *             90, 225, 450, 900, 1800: 8 parts left, 1 part right. Gaussian, eta = 1.2, a_v = 1,
 *             a_rho = 0.5, a_e = 0.1, b = 2, t = 0.2
 * Reference   W1 between the particles of successive N, masses divided by their total; M its
 *             largest value at t = 0, 0.02 .. 0.2. Theory: M falls like 1/N. Initially M follows in
 *             closed form from the cells: 1.44444e-2, 5.55556e-3, 2.88889e-3, 1.11111e-3,
 *             5.55556e-4, 2.77778e-4. Zisis, PhD thesis, Eindhoven 2017, section 4.5.2, plots a
 *             rate "similar to theory"
 * Expected    the initial distances to rounding, rates within 0.15 of -1 from N = 225 on
 *
 *   wasserstein_tube            print distances and rates
 *   wasserstein_tube validate   one RESULT line a figure */
#include "shock_tube.h"

enum { SIZES = 7, TIMES = 11, MOST = 1800 };
static const int sizes[SIZES] = {18, 45, 90, 225, 450, 900, MOST};
static const double end_time = 0.2;

static tube_setup sod(int particles) {
  tube_setup s = tube_defaults("wasserstein_tube");
  tube_add(&s, 0.0, 0.5, 1.0, 0.0, 1.0)->gamma = 5.0 / 3.0;
  tube_add(&s, 0.5, 1.0, 0.125, 0.0, 0.1)->gamma = 5.0 / 3.0;
  s.spacing = 0.5 / (particles / 9); /* of the ninth part on the right */
  s.equal_masses = 1;
  s.frozen = 0.2;
  s.end = end_time;
  return s;
}

/* Places of the particles that are not frozen, at TIMES times. */
static void run(int particles, double *x) {
  tube_setup s = sod(particles);
  tube t;
  tube_create(&t, &s);
  const int64_t layer = tube_layer(&s, 0);
  for (int k = 0; k < TIMES; ++k) {
    need(t.ctx, sph_shocks_run(t.shocks, end_time * k / (TIMES - 1), NULL, NULL));
    memcpy(x + (ptrdiff_t)k * particles, field(t.ctx, t.set, SPH_FIELD_X) + layer,
           (size_t)particles * sizeof *x);
  }
  tube_destroy(&t);
}

/* Distances of two sizes at all times; all masses of a run are the same. */
static void compare(int n, const double *x, int more, const double *y, double *distance) {
  sph_context *ctx;
  need(NULL, sph_context_create(NULL, &ctx));
  for (ptrdiff_t k = 0; k < TIMES; ++k)
    need(ctx, sph_wasserstein_distance(ctx, 1, n, x + k * n, NULL, more, y + k * more, NULL,
                                       &distance[k]));
  sph_context_destroy(ctx);
}

/* distance[k]: sizes k and k + 1 at all times. */
static void study(double distance[SIZES - 1][TIMES]) {
  static double x[2][TIMES * MOST];
  run(sizes[0], x[0]);
  for (int k = 0; k + 1 < SIZES; ++k) {
    run(sizes[k + 1], x[(k + 1) % 2]);
    compare(sizes[k], x[k % 2], sizes[k + 1], x[(k + 1) % 2], distance[k]);
  }
}

static double largest(const double distance[TIMES]) {
  double m = 0.0;
  for (int k = 0; k < TIMES; ++k) m = fmax(m, distance[k]);
  return m;
}

/* (4.41) of the source: of M between the pairs k - 1 and k; nothing precedes the first. */
static double rate(double before, double m, int k) {
  if (k == 0) return NAN;
  return log(m / before) / log((double)sizes[k] / sizes[k - 1]);
}

static int demo(void) {
  double distance[SIZES - 1][TIMES], before[3] = {NAN, NAN, NAN};
  int failed = 0;
  study(distance);
  printf("%-12s %-22s %-22s %s\n", "N", "W1 at t = 0, rate", "at t = 0.2, rate", "largest, rate");
  for (int k = 0; k + 1 < SIZES; ++k) {
    const double m[3] = {distance[k][0], distance[k][TIMES - 1], largest(distance[k])};
    printf("%4d, %4d  ", sizes[k], sizes[k + 1]);
    for (int i = 0; i < 3; ++i) {
      printf("  %.5e %+.3f  ", m[i], rate(before[i], m[i], k));
      before[i] = m[i];
    }
    printf("\n");
    failed += !(m[2] < 0.3 / sizes[k]);
  }
  return failed;
}

/* Every figure with its bound; nothing in there is needed to use the library. */
#include "wasserstein_tube_validate.h"

int main(int argc, char **argv) {
  return (argc > 1 && strcmp(argv[1], "demo") != 0 ? validate() : demo()) != 0;
}
