/* A shear layer whose waves grow as linear theory says.
 *
 * Equations   those of smoothing.h with number smoothing, P = (gamma - 1) rho e, with little
 *             viscosity, without conductivity and mass flux
 * Set-up      u = U tanh(y/d), U = 0.5, d = 0.0708, rho = 1, P = 2.5, gamma = 5/3 (Mach number
 *             0.245); x periodic on [0, 1], slip walls at y = -0.5 and 0.5; at first the
 *             growing wave of linear theory is there, v_y = 0.01 U at y = 0. Square lattice,
 * Gaussian, eta = 1.6, for with 1.2
 *             the disorder of the sheared lattice shows in the rate (-9 % instead of -3); a_v =
 * 0.05 Reference   the linear equation of inviscid compressible parallel flow for the amplitude of
 * the pressure, waves exp(i k (x - c t)), p'' - 2 U'/(U - c) p' - k^2 (1
 * - M^2 (U - c)^2) p = 0,   M = 1/sound speed, p' = 0 at the walls: L. Mack, AGARD report 709
 * (1984). Of a layer that is odd in y c = i c_i, and the growth rate is k c_i: by shooting, here.
 * Without walls and at M = 0: 0.1897 U/d at k d = 0.4446, A. Michalke, J. Fluid Mech. 19 (1964) 543
 * Expected    growth rate of the amplitude within 10 % of theory on 64 rows
 *
 *   kelvin_helmholtz            growth, and with gnuplot a picture of the roll-up
 *   kelvin_helmholtz validate   32 and 64 rows
 *   kelvin_helmholtz long       128 rows as well */
#include "shock_plane.h"

#include <complex.h>

static const double speed = 0.5, thickness = 0.0708, pressure = 2.5, gas_gamma = 5.0 / 3.0;
static const double seed = 0.01, half = 0.5, pi = 3.14159265358979323846;
static const double from = 0.0, to = 2.0; /* times between which the growth is taken */

/* ---- linear theory ----------------------------------------------------------------------- */

typedef struct wave {
  double complex p, dp;
} wave;

static wave slope_of(double y, wave w, double k, double complex c, double mach) {
  const double u = speed * tanh(y / thickness), sech = 1.0 / cosh(y / thickness);
  const double du = speed / thickness * sech * sech;
  return (wave){w.dp,
                2.0 * du / (u - c) * w.dp + k * k * (1.0 - mach * mach * (u - c) * (u - c)) * w.p};
}

static wave ahead(wave w, wave k, double dy) { return (wave){w.p + dy * k.p, w.dp + dy * k.dp}; }

enum { STEPS = 2000 }; /* from wall to wall */

/* From the wall at -half; the first `steps` of the way, kept at every step where `kept` is given.
 */
static wave shoot(double c_i, double k, double mach, int steps, wave *kept) {
  const double dy = 2.0 * half / STEPS;
  const double complex c = c_i * I;
  wave w = {1.0, 0.0};
  for (int n = 0; n < steps; ++n) {
    if (kept) kept[n] = w;
    const double y = -half + n * dy;
    const wave k1 = slope_of(y, w, k, c, mach);
    const wave k2 = slope_of(y + 0.5 * dy, ahead(w, k1, 0.5 * dy), k, c, mach);
    const wave k3 = slope_of(y + 0.5 * dy, ahead(w, k2, 0.5 * dy), k, c, mach);
    const wave k4 = slope_of(y + dy, ahead(w, k3, dy), k, c, mach);
    w.p += dy / 6.0 * (k1.p + 2.0 * k2.p + 2.0 * k3.p + k4.p);
    w.dp += dy / 6.0 * (k1.dp + 2.0 * k2.dp + 2.0 * k3.dp + k4.dp);
  }
  if (kept) kept[steps] = w;
  return w;
}

/* At y = 0 p(-y) = conj p(y), but for a factor, asks for this to vanish. */
static double mismatch(double c_i, double k, double mach) {
  const wave w = shoot(c_i, k, mach, STEPS / 2, NULL);
  return creal(w.dp / w.p);
}

/* k c_i by bisection. */
static double theory(double k, double mach) {
  double lo = 0.05 * speed, hi = 0.95 * speed;
  const double at_lo = mismatch(lo, k, mach);
  for (int n = 0; n < 60; ++n) {
    const double middle = 0.5 * (lo + hi);
    if ((mismatch(middle, k, mach) > 0.0) == (at_lo > 0.0))
      lo = middle;
    else
      hi = middle;
  }
  return k * lo;
}

static double mach_unit(void) { return 1.0 / sqrt(gas_gamma * pressure); }
static double compressible_growth(void) { return theory(2.0 * pi, mach_unit()); }

/* The growing wave at a place, of unit amplitude somewhere: i k (U - c) v = -p', i k (U - c) u + U'
 * v = -i k p, as rho = 1. */
typedef struct eigenwave {
  double complex u, v, p;
} eigenwave;

static eigenwave wave_at(const wave *table, double growth_rate, double y) {
  const double k = 2.0 * pi, s = (y + half) / (2.0 * half) * STEPS;
  const int n = s < STEPS - 1 ? (int)s : STEPS - 1;
  const double complex p = table[n].p + (s - n) * (table[n + 1].p - table[n].p);
  const double complex dp = table[n].dp + (s - n) * (table[n + 1].dp - table[n].dp);
  const double sech = 1.0 / cosh(y / thickness);
  const double complex relative = I * k * (speed * tanh(y / thickness) - growth_rate / k * I);
  const double complex v = -dp / relative;
  return (eigenwave){-(I * k * p + speed / thickness * sech * sech * v) / relative, v, p};
}

/* The layer, with the wave that grows in proportion: nothing else, sound above all, is set off. */
static void fill(plane *s) {
  static wave table[STEPS + 1];
  double *x = field(s->ctx, s->set, SPH_FIELD_X), *v = field(s->ctx, s->set, SPH_FIELD_V);
  double *rho = field(s->ctx, s->set, SPH_FIELD_RHO), *p = field(s->ctx, s->set, SPH_FIELD_P);
  const double growth_rate = compressible_growth();
  (void)shoot(growth_rate / (2.0 * pi), 2.0 * pi, mach_unit(), STEPS, table);
  const double size = seed * speed / cabs(wave_at(table, growth_rate, 0.0).v);
  for (int64_t i = 0; i < s->n; ++i) {
    const double y = x[2 * i + 1];
    const double complex along = size * cexp(2.0 * pi * I * x[2 * i]);
    const eigenwave w = wave_at(table, growth_rate, y);
    const double dp = creal(along * w.p);
    v[2 * i] = speed * tanh(y / thickness) + creal(along * w.u);
    v[2 * i + 1] = creal(along * w.v);
    rho[i] = 1.0 + dp * mach_unit() * mach_unit();
    p[i] = pressure + dp;
    sph_particles_phases(s->set)[i] = y > 0.0;
  }
}

static void layer_create(plane *s, int rows) {
  const double lo[2] = {0.0, -half}, hi[2] = {1.0, half};
  sph_material *laws[2];
  sph_dissipation loss;
  sph_shocks_options o;
  sph_dissipation_init(&loss);
  loss.viscosity = 0.05;
  loss.conductivity = loss.mass_flux = 0.0;
  sph_shocks_options_init(&o);
  o.dim = 2;
  o.dissipation = &loss;
  o.eta = 1.6;
  o.periodic[0] = 1;
  o.box_hi[0] = 1.0;
  plane_create(s, 1.0 / rows);
  plane_lattice(s, lo, hi, NULL, NULL);
  fill(s);
  s->periodic[0] = 1;
  plane_mirror(s, 1, -half, 1.0);
  plane_mirror(s, 1, half, -1.0);
  for (int k = 0; k < 2; ++k) laws[k] = plane_gas(s->ctx, gas_gamma, 0.0);
  plane_start(s, &o, laws, 2);
}

/* Amplitude of the wave exp(2 pi i x) of v_y, weighted towards the layer. */
static double amplitude(const plane *s) {
  double re = 0.0, im = 0.0, norm = 0.0;
  for (int64_t i = 0; i < s->n; ++i) {
    const double w = exp(-2.0 * pi * fabs(s->x[2 * i + 1])), phase = 2.0 * pi * s->x[2 * i];
    re += w * s->v[2 * i + 1] * cos(phase);
    im += w * s->v[2 * i + 1] * sin(phase);
    norm += w;
  }
  return 2.0 * hypot(re, im) / norm;
}

/* Growth rate: slope of log amplitude over eleven times. */
static double growth(plane *s) {
  enum { TIMES = 11 };
  double t[TIMES], inverse[TIMES];
  for (int k = 0; k < TIMES; ++k) {
    t[k] = from + (to - from) * k / (TIMES - 1);
    need(s->ctx, plane_run(s, t[k]));
    inverse[k] = 1.0 / amplitude(s);
    t[k] = exp(t[k]); /* convergence_rate() takes logarithms of both */
  }
  return convergence_rate(TIMES, t, inverse);
}

/* ---- demo -------------------------------------------------------------------------------- */

static const char picture[] =
    "set terminal pngcairo size 700,700\nset output 'kelvin_helmholtz.png'\n"
    "set datafile separator ','\nset size ratio -1\nset xrange [0:1]\nset yrange [-0.5:0.5]\n"
    "plot 'kelvin_helmholtz.csv' using 1:($3==0?$2:1/0) with points pt 7 ps 0.3 lc rgb 'blue' "
    "notitle, \\\n  '' using 1:($3==1?$2:1/0) with points pt 7 ps 0.3 lc rgb 'red' notitle\n";

static int demo(void) {
  plane s;
  layer_create(&s, 64);
  const double measured = growth(&s), known = compressible_growth();
  printf("growth rate %.4f, linear theory %.4f\n", measured, known);
  need(s.ctx, plane_run(&s, 5.0));
  FILE *file = open_output("kelvin_helmholtz.csv");
  for (int64_t i = 0; i < s.n; ++i)
    fprintf(file, "%.6g,%.6g,%d\n", s.x[2 * i] - floor(s.x[2 * i]), s.x[2 * i + 1],
            (int)s.phase[i]);
  fclose(file);
  draw("kelvin_helmholtz.gp", picture);
  plane_destroy(&s);
  return !(fabs(measured / known - 1.0) < 0.1);
}

/* Every figure with its bound; nothing in there is needed to use the library. */
#include "kelvin_helmholtz_validate.h"

int main(int argc, char **argv) {
  const int proof = argc > 1 && strcmp(argv[1], "demo") != 0;
  return (proof ? validate(strcmp(argv[1], "long") == 0) : demo()) != 0;
}
