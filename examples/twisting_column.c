/* A free column of rubber, its ends twisted against each other and let go.
 *
 * Equations   total-Lagrangian elasticity, include/sph/total_lagrangian.h: P = dpsi/dF of a
 *             neo-Hookean law in 3-D, conservative corrected forces, hourglass control, no
 *             viscosity, leapfrog.
 * Set-up      1 m x 1 m x 6 m along y about the origin, rho = 1100 kg/m^3, E = 17 MPa, nu = 0.45,
 *             after J. Bonet et al., Comput. Methods Appl. Mech. Engrg. 300 (2016), whose column is
 *             held at one end. At first v = w (z, 0, -x) with w = W sin(pi y / 6 m) + 10 / s: the
 *             second part turns all of it, so that there is an angular momentum to keep.
 * Reference   W = 1 / s, torsion of a slender bar, Saint-Venant: the ends swing with the period
 *             2 L / (c_s sqrt(It / Ip)), c_s^2 = G / rho, It = 0.14058 a^4, Ip = a^4 / 6.
 *             W = 105 / s, twisted by nearly a full turn: momentum, angular momentum and energy are
 *             kept; no hourglass pattern: fourth differences of the displacements along the
 *             lattice, which pass an odd-even pattern and stop smooth fields, in spacings.
 * Expected    period within 3 % with 6 x 6 particles; momenta to rounding; energy to 1e-3 of what
 *             the column was given; pattern below 0.01, and more without hourglass control.
 *
 *   twisting_column            the large twist with its ledger as CSV and, with gnuplot, a picture
 *   twisting_column validate   6 x 6 x 36 particles
 *   twisting_column long       10 x 10 x 60 as well */
#include "common.h"

#include <string.h>

static const double side = 1.0, length = 6.0, density = 1100.0, young = 17e6, poisson = 0.45;
static const double spin = 10.0, pi = 3.14159265358979323846;

typedef struct column {
  int64_t n; /* particles across; 6 n along */
  double dp;
  sph_context *ctx;
  sph_particles *set;
  sph_total_lagrangian *tl;
} column;

/* ---- set-up ------------------------------------------------------------------------------ */

static void make_particles(column *c, double twist) {
  sph_particles_options options;
  sph_particles_options_init(&options);
  need(c->ctx, sph_particles_create(c->ctx, &options, &c->set));
  need(c->ctx, sph_particles_add(c->set, 6 * c->n * c->n * c->n, NULL));
  double *x = field(c->ctx, c->set, SPH_FIELD_X), *v = field(c->ctx, c->set, SPH_FIELD_V);
  double *m = field(c->ctx, c->set, SPH_FIELD_M), *rho = field(c->ctx, c->set, SPH_FIELD_RHO);
  for (int64_t i = 0; i < sph_particles_count(c->set); ++i) {
    x[3 * i] = ((double)(i % c->n) + 0.5) * c->dp - 0.5 * side;
    x[3 * i + 2] = ((double)(i / c->n % c->n) + 0.5) * c->dp - 0.5 * side;
    x[3 * i + 1] = ((double)(i / (c->n * c->n)) + 0.5) * c->dp - 0.5 * length;
    const double w = twist * sin(pi * x[3 * i + 1] / length) + spin;
    v[3 * i] = w * x[3 * i + 2];
    v[3 * i + 2] = -w * x[3 * i];
    m[i] = density * c->dp * c->dp * c->dp;
    rho[i] = density;
  }
}

static void column_create(column *c, int64_t n, double twist, double hourglass) {
  sph_material *rubber;
  sph_hyperelastic_options law; /* neo-Hookean, 3-D by default */
  sph_hyperelastic_options_init(&law);
  law.young = young;
  law.poisson = poisson;
  law.density = density;
  sph_total_lagrangian_options options;
  sph_total_lagrangian_options_init(&options);
  options.dim = 3;
  options.h_ratio = 0.8; /* 18 neighbours: the layer softened by the surface is a support thick */
  options.hourglass = hourglass;
  *c = (column){.n = n, .dp = side / (double)n};
  need(NULL, sph_context_create(NULL, &c->ctx));
  need(c->ctx, sph_material_create_hyperelastic(c->ctx, &law, &rubber));
  need(c->ctx, sph_total_lagrangian_create(c->ctx, &options, rubber, &c->tl));
  sph_material_destroy(rubber); /* the scheme keeps it */
  make_particles(c, twist);
  need(c->ctx, sph_total_lagrangian_start(c->tl, c->set));
}

static void column_destroy(column *c) {
  sph_total_lagrangian_destroy(c->tl);
  sph_particles_destroy(c->set);
  sph_context_destroy(c->ctx);
}

/* ---- measuring --------------------------------------------------------------------------- */

typedef struct ledger {
  double energy, momentum, angular[3];
  double scale; /* sum m |v|, what the momentum is measured by */
} ledger;

static ledger measure(column *c, double t) {
  ledger l = {.energy = 0.0};
  sph_total_lagrangian_energies e = {.size = sizeof e};
  const double *x = field(c->ctx, c->set, SPH_FIELD_X), *v = field(c->ctx, c->set, SPH_FIELD_V);
  const double *m = field(c->ctx, c->set, SPH_FIELD_M);
  double sum[3] = {0.0};
  need(c->ctx, sph_total_lagrangian_energy(c->tl, c->set, t, &e));
  for (int64_t i = 0; i < sph_particles_count(c->set); ++i)
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, d = (a + 2) % 3;
      sum[a] += m[i] * v[3 * i + a];
      l.scale += m[i] * fabs(v[3 * i + a]);
      l.angular[a] += m[i] * (x[3 * i + b] * v[3 * i + d] - x[3 * i + d] * v[3 * i + b]);
    }
  l.energy = e.kinetic + e.strain + e.hourglass;
  l.momentum = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
  return l;
}

/* Angle by which the upper end is turned against the lower one, from the first moments of both end
 * layers: of their X and x. Within a turn of the angle `near`. */
static double twist_angle(const column *c, double near) {
  const double *x = field(c->ctx, c->set, SPH_FIELD_X), *X = field(c->ctx, c->set, SPH_FIELD_X0);
  const int64_t layer = c->n * c->n, top = sph_particles_count(c->set) - layer;
  double angle = 0.0;
  for (int end = 0; end < 2; ++end) {
    double along = 0.0, across = 0.0;
    for (int64_t i = end ? top : 0; i < (end ? top + layer : layer); ++i) {
      along += X[3 * i + 2] * x[3 * i + 2] + X[3 * i] * x[3 * i];
      across += X[3 * i + 2] * x[3 * i] - X[3 * i] * x[3 * i + 2];
    }
    angle += (end ? 1.0 : -1.0) * atan2(across, along);
  }
  return near + remainder(angle - near, 2.0 * pi);
}

/* Root mean square of the fourth differences of u along the column, over 16 and the spacing. */
static double pattern(const column *c) {
  const double *x = field(c->ctx, c->set, SPH_FIELD_X), *X = field(c->ctx, c->set, SPH_FIELD_X0);
  const int64_t layer = 3 * c->n * c->n, n = 3 * sph_particles_count(c->set);
  double sum = 0.0;
  for (int64_t k = 2 * layer; k < n - 2 * layer; ++k) {
    double u[5];
    for (int64_t s = 0; s < 5; ++s) u[s] = x[k + (s - 2) * layer] - X[k + (s - 2) * layer];
    const double d = (u[0] - 4.0 * u[1] + 6.0 * u[2] - 4.0 * u[3] + u[4]) / 16.0;
    sum += d * d;
  }
  return sqrt(3.0 * sum / (double)(n - 4 * layer)) / c->dp;
}

/* ---- validation -------------------------------------------------------------------------- */

static double torsion_period(void) {
  const double shear = 0.5 * young / (1.0 + poisson);
  return 2.0 * length / sqrt(shear / density * 6.0 * 0.14058);
}

/* Period of the small twist: twice the time between two zeros of the angle. */
static int validate_period(int64_t n) {
  column c;
  char keys[128];
  double dt, before = 0.0, zero[2] = {0.0, 0.0};
  int found = 0;
  column_create(&c, n, 1.0, 0.1);
  need(c.ctx, sph_total_lagrangian_time_step(c.tl, c.set, &dt));
  for (int64_t k = 1; found < 2 && (double)k * dt < 2.0 * torsion_period(); ++k) {
    need(c.ctx, sph_total_lagrangian_step(c.tl, c.set, (double)(k - 1) * dt, dt));
    const double angle = twist_angle(&c, before);
    if (k > 1 && before * angle < 0.0) zero[found++] = ((double)k - angle / (angle - before)) * dt;
    before = angle;
  }
  column_destroy(&c);
  snprintf(keys, sizeof keys, "case=twisting_column quantity=torsion_period n=%d", (int)n);
  return result_line(keys, found == 2 ? 2.0 * (zero[1] - zero[0]) : NAN, torsion_period(),
                     "Saint-Venant torsion", 0.03, 1);
}

typedef struct outcome {
  double energy, momentum, angular, twist, pattern; /* largest of the run */
} outcome;

static outcome large_twist(int64_t n, double hourglass, FILE *csv) {
  const double duration = 1.2 * torsion_period();
  outcome r = {.energy = 0.0};
  column c;
  double dt, twist = 0.0;
  column_create(&c, n, 105.0, hourglass);
  need(c.ctx, sph_total_lagrangian_time_step(c.tl, c.set, &dt));
  const int64_t steps = (int64_t)ceil(duration / dt);
  const ledger start = measure(&c, 0.0);
  for (int64_t k = 1; k <= steps; ++k) {
    need(c.ctx, sph_total_lagrangian_step(c.tl, c.set, (double)(k - 1) * dt, dt));
    twist = twist_angle(&c, twist);
    r.twist = fmax(r.twist, fabs(twist));
    if (k % 20 != 0 && k != steps) continue;
    const ledger now = measure(&c, (double)k * dt);
    double turn = 0.0;
    for (int a = 0; a < 3; ++a) turn += fabs(now.angular[a] - start.angular[a]);
    r.energy = fmax(r.energy, fabs(now.energy / start.energy - 1.0));
    r.momentum = fmax(r.momentum, now.momentum / start.scale);
    r.angular = fmax(r.angular, turn / fabs(start.angular[1]));
    r.pattern = fmax(r.pattern, pattern(&c));
    if (csv)
      fprintf(csv, "%.6g,%.9g,%.9g,%.6g,%.6g\n", (double)k * dt, now.energy / start.energy,
              now.angular[1] / start.angular[1], twist, pattern(&c));
  }
  column_destroy(&c);
  return r;
}

static int bound(const char *quantity, int64_t n, double measured, double limit,
                 const char *source) {
  char keys[128];
  snprintf(keys, sizeof keys, "case=twisting_column quantity=%s n=%d", quantity, (int)n);
  return result_bound(keys, measured, -1, limit, source);
}

static int validate(int64_t n) {
  int failed = validate_period(n);
  const outcome r = large_twist(n, 0.1, NULL), bare = large_twist(n, 0.0, NULL);
  char keys[128];
  failed += bound("energy_drift", n, r.energy, 1e-3, "leapfrog");
  failed += bound("momentum", n, r.momentum, 1e-12, "antisymmetric forces");
  failed += bound("angular_momentum_drift", n, r.angular, 1e-12, "frame-indifferent energy");
  failed += bound("hourglass_pattern", n, r.pattern, 0.01, "smooth fields");
  snprintf(keys, sizeof keys, "case=twisting_column quantity=pattern_without_control n=%d", (int)n);
  result_report(keys, bare.pattern, 0.01, "smooth fields", "for comparison");
  return failed;
}

/* ---- demo -------------------------------------------------------------------------------- */

static const char picture[] =
    "set terminal pngcairo size 900,600\nset output 'twisting_column.png'\n"
    "set datafile separator ','\nset multiplot layout 2,1\nset xlabel 't / s'\n"
    "plot 'twisting_column.csv' using 1:4 with lines lw 2 title 'twist / rad'\n"
    "plot 'twisting_column.csv' using 1:($2-1) with lines lw 2 title 'energy drift'\n";

static int demo(void) {
  FILE *csv = open_output("twisting_column.csv");
  const outcome r = large_twist(6, 0.1, csv);
  fclose(csv);
  printf("largest twist %.2f rad; energy drift %.2g, angular momentum %.2g, momentum %.2g, pattern "
         "%.2g spacings\n",
         r.twist, r.energy, r.angular, r.momentum, r.pattern);
  draw("twisting_column.gp", picture);
  return 0;
}

int main(int argc, char **argv) {
  if (argc > 1 && strcmp(argv[1], "validate") == 0) return validate(6) != 0;
  if (argc > 1 && strcmp(argv[1], "long") == 0) return validate(6) + validate(10) != 0;
  return demo();
}
