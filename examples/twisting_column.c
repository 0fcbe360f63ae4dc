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

static sph_total_lagrangian_ledger balance(const column *c, double t) {
  sph_total_lagrangian_ledger l;
  sph_total_lagrangian_ledger_init(&l);
  need(c->ctx, sph_total_lagrangian_balance(c->tl, c->set, t, &l));
  return l;
}

static double energy_of(const sph_total_lagrangian_ledger *l) {
  return l->kinetic + l->strain + l->hourglass;
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

/* Saint-Venant. */
static double torsion_period(void) {
  const double shear = 0.5 * young / (1.0 + poisson);
  return 2.0 * length / sqrt(shear / density * 6.0 * 0.14058);
}

/* ---- demo -------------------------------------------------------------------------------- */

static const char picture[] =
    "set terminal pngcairo size 900,600\nset output 'twisting_column.png'\n"
    "set datafile separator ','\nset multiplot layout 2,1\nset xlabel 't / s'\n"
    "plot 'twisting_column.csv' using 1:4 with lines lw 2 title 'twist / rad'\n"
    "plot 'twisting_column.csv' using 1:($2-1) with lines lw 2 title 'energy drift'\n";

static int demo(void) {
  const double duration = 1.2 * torsion_period();
  column c;
  double dt, twist = 0.0, most = 0.0;
  FILE *csv = open_output("twisting_column.csv");
  column_create(&c, 6, 105.0, 0.1);
  need(c.ctx, sph_total_lagrangian_time_step(c.tl, c.set, &dt));
  const sph_total_lagrangian_ledger start = balance(&c, 0.0);
  for (int64_t k = 1; (double)k * dt <= duration; ++k) {
    need(c.ctx, sph_total_lagrangian_step(c.tl, c.set, (double)(k - 1) * dt, dt));
    twist = twist_angle(&c, twist);
    most = fmax(most, fabs(twist));
    if (k % 20 != 0) continue;
    const sph_total_lagrangian_ledger now = balance(&c, (double)k * dt);
    fprintf(csv, "%.6g,%.9g,%.9g,%.6g\n", (double)k * dt, energy_of(&now) / energy_of(&start),
            now.angular_momentum[1] / start.angular_momentum[1], twist);
  }
  const sph_total_lagrangian_ledger end = balance(&c, duration);
  printf("largest twist %.2f rad; energy drift %.2g, angular momentum %.2g\n", most,
         energy_of(&end) / energy_of(&start) - 1.0,
         end.angular_momentum[1] / start.angular_momentum[1] - 1.0);
  column_destroy(&c);
  fclose(csv);
  draw("twisting_column.gp", picture);
  return 0;
}

/* Every figure of the case; nothing in there is needed to use the library. */
#include "twisting_column_validate.h"

int main(int argc, char **argv) {
  const char *mode = argc > 1 ? argv[1] : "demo";
  return (strcmp(mode, "demo") == 0 ? demo() : validate(strcmp(mode, "long") == 0)) != 0;
}
