/* A drop of water that is drawn into an ellipse.
 *
 * Equations   drho/dt = -rho div v,   dv/dt = -grad P/rho,   P = B ((rho/rho0)^7 - 1), B = rho0
 *             c0^2/7, with viscosity and mass flux, as in smoothing.h: mass smoothing, h fixed
 * Set-up      a disc of radius 1, v = (-100 x, 100 y), free surface, units m, kg, s; lattice of l
 *             cells on the diameter, those within the circle: l = 4 to 96 gives N = 12 to 7232.
 *             Wendland C2, h = 1.2 spacings in the convention of the Gaussian, a_rho = 0.5, b = 0.
 *             The source leaves open density, sound speed and viscosity: here 1000, 1400 and a_v =
 *             0.05; its h = 1.5 N^(-1/2) is 0.85 spacings only. Steps of 0.25 h/(c + v)
 * Reference   an incompressible drop stays an ellipse, of half axes a and b = 1/a: A' = A^2 (a^2 -
 *             b^2)/(a^2 + b^2), a' = -A a, b' = A b, A = 100 at first, by Runge-Kutta: b = 1.9445
 *             at t = 0.0076. Zisis, PhD thesis, Eindhoven 2017, section 4.5.1: b = 1.93 with 7232
 *             particles; Monaghan, J. Comput. Phys. 110 (1994): 1.91. Drops of N and of more
 *             particles approach each other in the Wasserstein distance as N^(-1/2)
 * Expected    b within 0.015 of 1.93; rates of the distance -1/2 +- 0.15
 *
 *   elliptical_drop            half axes, positions as CSV and, with gnuplot, a picture
 *   elliptical_drop validate   N = 52 to 1804
 *   elliptical_drop long       N = 12 to 7232 */
#include "shock_plane.h"

static const double rho0 = 1000.0, c0 = 1400.0, rate = 100.0, axis_time = 0.0076, end_time = 0.01;

static int32_t in_disc(void *user, const double *x) {
  (void)user;
  return x[0] * x[0] + x[1] * x[1] < 1.0;
}

static void fill(plane *s) {
  double *x = field(s->ctx, s->set, SPH_FIELD_X), *v = field(s->ctx, s->set, SPH_FIELD_V);
  double *rho = field(s->ctx, s->set, SPH_FIELD_RHO), *h = field(s->ctx, s->set, SPH_FIELD_H);
  sph_kernel *gaussian, *wendland;
  need(s->ctx, sph_kernel_create(s->ctx, SPH_KERNEL_GAUSSIAN, 2, &gaussian));
  need(s->ctx, sph_kernel_create(s->ctx, SPH_KERNEL_WENDLAND_C2, 2, &wendland));
  const double length = sph_kernel_equal_h(wendland, gaussian, 1.2 * s->dp);
  for (int64_t i = 0; i < s->n; ++i) {
    v[2 * i] = -rate * x[2 * i];
    v[2 * i + 1] = rate * x[2 * i + 1];
    rho[i] = rho0;
    h[i] = length;
  }
  sph_kernel_destroy(gaussian);
  sph_kernel_destroy(wendland);
}

/* A drop of `cells` on its diameter, at time 0. */
static void drop_create(plane *s, int cells) {
  static const double lo[2] = {-1.0, -1.0}, hi[2] = {1.0, 1.0};
  sph_material *water;
  sph_dissipation loss;
  sph_shocks_options o;
  sph_barotropic_options tait;
  sph_barotropic_options_init(&tait);
  tait.density = rho0;
  tait.sound_speed = c0;
  sph_dissipation_init(&loss);
  loss.viscosity = 0.05;
  loss.conductivity = loss.viscosity_b = loss.mass_flux_b = 0.0;
  sph_shocks_options_init(&o);
  o.dim = 2;
  o.kernel = SPH_KERNEL_WENDLAND_C2;
  o.smoothing = SPH_SMOOTHING_MASS;
  o.adaptive = 0;
  o.dissipation = &loss;
  plane_create(s, 2.0 / cells);
  plane_lattice(s, lo, hi, in_disc, NULL);
  fill(s);
  need(s->ctx, sph_material_create_barotropic(s->ctx, &tait, &water));
  plane_start(s, &o, &water, 1);
}

/* ---- reference --------------------------------------------------------------------------- */

/* A, a, b. */
typedef struct ellipse {
  double A, a, b;
} ellipse;

static ellipse change(ellipse e, ellipse k, double dt) {
  const double A = e.A + dt * k.A, a = e.a + dt * k.a, b = e.b + dt * k.b;
  return (ellipse){A * A * (a * a - b * b) / (a * a + b * b), -A * a, A * b};
}

static ellipse exact_ellipse(double t) {
  enum { STEPS = 1000 };
  const double dt = t / STEPS;
  ellipse e = {rate, 1.0, 1.0}, none = {0.0, 0.0, 0.0};
  for (int n = 0; n < STEPS; ++n) {
    const ellipse k1 = change(e, none, 0.0), k2 = change(e, k1, 0.5 * dt);
    const ellipse k3 = change(e, k2, 0.5 * dt), k4 = change(e, k3, dt);
    e.A += dt / 6.0 * (k1.A + 2.0 * k2.A + 2.0 * k3.A + k4.A);
    e.a += dt / 6.0 * (k1.a + 2.0 * k2.a + 2.0 * k3.a + k4.a);
    e.b += dt / 6.0 * (k1.b + 2.0 * k2.b + 2.0 * k3.b + k4.b);
  }
  return e;
}

/* ---- figures ----------------------------------------------------------------------------- */

/* Half axis along y of the ellipse with the particles' second moment, <y^2> = b^2/4; the lattice
 * has 2 cells/12 of its own in a disc, so it is set against that of the start, where b = 1. */
static double second_moment(const plane *s, int axis) {
  double sum = 0.0;
  for (int64_t i = 0; i < s->n; ++i) sum += s->x[2 * i + axis] * s->x[2 * i + axis];
  return sum / (double)s->n;
}

/* Farthest particle along an axis. */
static double farthest(const plane *s, int axis) {
  double far = 0.0;
  for (int64_t i = 0; i < s->n; ++i) far = fmax(far, fabs(s->x[2 * i + axis]));
  return far;
}

/* ---- demo -------------------------------------------------------------------------------- */

static const char picture[] =
    "set terminal pngcairo size 1200,700\nset output 'elliptical_drop.png'\n"
    "set datafile separator ','\nset size ratio -1\nset multiplot layout 1,4\n"
    "set xrange [-1.1:1.1]\nset yrange [-2.4:2.4]\nset cbrange [-2e6:6e6]\nset parametric\n"
    "do for [k=0:3] {\n  b = word('1 1.08310 1.43922 1.94452', k + 1) + 0\n"
    "  plot 'elliptical_drop.csv' index k using 1:2:3 with points pt 7 ps 0.3 palette notitle, \\\n"
    "    cos(t)/b, sin(t)*b with lines lc rgb 'black' title sprintf('b = %.3f', b)\n}\n";

static int demo(void) {
  static const double times[] = {0.0, 0.0008, 0.0038, 0.0076};
  plane s;
  double b = 0.0;
  drop_create(&s, 48);
  FILE *file = open_output("elliptical_drop.csv");
  const double start = second_moment(&s, 1);
  for (int k = 0; k < 4; ++k) {
    need(s.ctx, plane_run(&s, times[k]));
    b = sqrt(second_moment(&s, 1) / start);
    for (int64_t i = 0; i < s.n; ++i)
      fprintf(file, "%.6g,%.6g,%.6g\n", s.x[2 * i], s.x[2 * i + 1], s.p[i]);
    fprintf(file, "\n\n");
    printf("t = %.4f: b = %.4f, incompressible %.4f; farthest particle %.4f\n", times[k], b,
           exact_ellipse(times[k]).b, farthest(&s, 1));
  }
  fclose(file);
  draw("elliptical_drop.gp", picture);
  plane_destroy(&s);
  return !(fabs(b - exact_ellipse(axis_time).b) < 0.05);
}

/* Every figure with its bound; nothing in there is needed to use the library. */
#include "elliptical_drop_validate.h"

int main(int argc, char **argv) {
  const int proof = argc > 1 && strcmp(argv[1], "demo") != 0;
  return (proof ? validate(strcmp(argv[1], "long") == 0) : demo()) != 0;
}
