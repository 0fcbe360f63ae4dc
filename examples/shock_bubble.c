/* A weak shock in air meets a cylinder of a heavier gas, R22, as in the experiment of Haas and
 * Sturtevant.
 *
 * Equations   those of smoothing.h with number smoothing: drho/dt = -rho div v, dv/dt = -grad P
 *             /rho, de/dt = -(P/rho) div v, P = (gamma - 1) rho e, with viscosity and mass flux
 * Set-up      lengths in m, speeds in 343 m/s, so 1 us is 3.43e-4. Channel 0.89 x 0.089; cylinder
 *             of diameter D = 0.05 about x = 0.6 on the axis; shock of Mach 1.22 at x = 0.675,
 *             moving left. rho, u, P, gamma: air 1.4, 0, 1, 1.4; behind the shock 1.92691,
 *             -0.33361, 1.5698, 1.4; R22 4.4154, 0, 1, 1.249. The upper half is computed, with
 *             mirror images at the axis and at the wall. Particles beyond the left end stay as they
 *             are; those beyond the right end, which must not be at rest, or an expansion would run
 *             into the bubble, move on with u. Square lattice, masses by density, Gaussian, eta =
 *             1.2, a_v = 1, a_rho = 0.5, a_e = 0, b = 2; to 1020 us after the shock arrives at t =
 *             D/1.22. The source has 4000 particles on a unit of length, 1.3 million in all
 * Reference   planar theory: refracted shock 236.4 m/s, interface 85.1 m/s, P = 1.75469; finite
 *             volumes, 2000 cells a unit: table in shock_bubble_validate.h. Zisis, PhD thesis,
 *             Eindhoven 2017, section 5.5, shows pictures; at 1020 us a pair of vortices
 * Expected    interface on the axis within 1.5 mm of finite volumes up to 405 us (0.6 mm with 1011
 *             on a unit of length); refracted shock 240 m/s +-5 % (252)
 *
 *   shock_bubble            four times, with pictures (1011 on a unit of length)
 *   shock_bubble validate   719 on a unit
 *   shock_bubble long       1011 on a unit as well */
#include "shock_plane.h"

enum { AIR = 0, R22 = 1 };

static const double half_height = 0.0445, length = 0.89, centre = 0.6, radius = 0.025;
static const double shock_at = 0.675, arrival = 0.05 / 1.22, microsecond = 3.43e-4;
static const double unit_speed = 343.0; /* m/s */

typedef struct gas_state {
  double rho, u, p, gamma;
} gas_state;

static const gas_state air = {1.4, 0.0, 1.0, 1.4}, shocked = {1.92691, -0.33361, 1.5698, 1.4};
static const gas_state r22 = {4.41540, 0.0, 1.0, 1.249};

static void fill(plane *s) {
  double *x = field(s->ctx, s->set, SPH_FIELD_X), *v = field(s->ctx, s->set, SPH_FIELD_V);
  double *rho = field(s->ctx, s->set, SPH_FIELD_RHO), *p = field(s->ctx, s->set, SPH_FIELD_P);
  for (int64_t i = 0; i < s->n; ++i) {
    const int bubble = hypot(x[2 * i] - centre, x[2 * i + 1]) < radius;
    const gas_state *g = bubble ? &r22 : x[2 * i] > shock_at ? &shocked : &air;
    v[2 * i] = g->u;
    rho[i] = g->rho;
    p[i] = g->p;
    sph_particles_phases(s->set)[i] = bubble ? R22 : AIR;
    if (x[2 * i] < 0.0 || x[2 * i] > length) sph_particles_roles(s->set)[i] = SPH_ROLE_WALL;
  }
}

/* The channel with `rows` rows of particles in its upper half, at time 0. */
static void bubble_create(plane *s, int rows) {
  const double dp = half_height / rows, frame = 4.0 * dp; /* more than a support */
  const double lo[2] = {-frame, 0.0}, hi[2] = {length + frame, half_height};
  sph_material *laws[2];
  sph_dissipation loss;
  sph_shocks_options o;
  sph_dissipation_init(&loss);
  loss.conductivity = 0.0;
  loss.flux_limit = 0.0; /* the source has none; needed beside liquids in tension only */
  sph_shocks_options_init(&o);
  o.dim = 2;
  o.dissipation = &loss;
  plane_create(s, dp);
  plane_lattice(s, lo, hi, NULL, NULL);
  fill(s);
  plane_mirror(s, 1, 0.0, 1.0);
  plane_mirror(s, 1, half_height, -1.0);
  laws[AIR] = plane_gas(s->ctx, air.gamma, 0.0);
  laws[R22] = plane_gas(s->ctx, r22.gamma, 0.0);
  plane_start(s, &o, laws, 2);
}

static void run_to(plane *s, double us) { need(s->ctx, plane_run(s, arrival + us * microsecond)); }

/* ---- figures, in mm from the centre at the start ------------------------------------------- */

/* The interface on the axis, on the side where `side` is 1 (upstream) or -1: between the outermost
 * particle of R22 and the next one of air, by their spacings. */
static double interface(const plane *s, double side) {
  int64_t in = -1, out = -1;
  for (int64_t i = 0; i < s->n; ++i)
    if (s->phase[i] == R22 && s->x[2 * i + 1] < s->h[i] &&
        (in < 0 || side * s->x[2 * i] > side * s->x[2 * in]))
      in = i;
  for (int64_t i = 0; i < s->n; ++i)
    if (s->phase[i] == AIR && s->x[2 * i + 1] < s->h[i] &&
        side * s->x[2 * i] > side * s->x[2 * in] &&
        (out < 0 || side * s->x[2 * i] < side * s->x[2 * out]))
      out = i;
  const double a = s->h[in], b = s->h[out];
  return 1e3 * ((b * s->x[2 * in] + a * s->x[2 * out]) / (a + b) - centre);
}

/* Half height of the bubble: the largest area of R22 in a column of 4 mm, by its width. Right
 * while the bubble does not overhang; single particles, which stay behind where the lattice makes
 * steps of the circle, hardly count. */
static double bubble_height(const plane *s) {
  enum { COLUMNS = 250 };
  double area[COLUMNS] = {0.0}, most = 0.0;
  for (int64_t i = 0; i < s->n; ++i)
    if (s->phase[i] == R22) area[(int)(250.0 * s->x[2 * i])] += s->m[i] / s->rho[i];
  for (int k = 0; k < COLUMNS; ++k) most = fmax(most, 250.0 * area[k]);
  return 1e3 * most;
}

/* The first place from the left where the pressure in a row of particles passes `level`: rows next
 * to the axis (R22 alone) or to the wall. Means of places and pressures over half a spacing. */
static double front(const plane *s, int wall, double level) {
  enum { BINS = 4096 };
  static double sum[BINS], count[BINS];
  const double width = s->dp;
  memset(sum, 0, sizeof sum);
  memset(count, 0, sizeof count);
  for (int64_t i = 0; i < s->n; ++i) {
    const double y = wall ? half_height - s->x[2 * i + 1] : s->x[2 * i + 1];
    const int k = (int)(s->x[2 * i] / width);
    if (y > s->h[i] || k < 0 || k >= BINS || (!wall && s->phase[i] != R22)) continue;
    sum[k] += s->p[i];
    count[k] += 1.0;
  }
  double before = NAN, at = NAN;
  for (int k = 0; k < BINS; ++k) {
    if (count[k] == 0.0) continue;
    const double p = sum[k] / count[k], x = (k + 0.5) * width;
    if (p > level) return 1e3 * (at + (x - at) * (level - before) / (p - before) - centre);
    before = p;
    at = x;
  }
  return NAN;
}

/* How much faster the rim of the bubble is carried on than what is near the axis, m/s: the pair of
 * vortices of a heavy bubble, which lags behind the air around it. */
static double vortex_speed(const plane *s) {
  double u[2] = {0.0}, n[2] = {0.0};
  for (int64_t i = 0; i < s->n; ++i) {
    const double y = 1e3 * s->x[2 * i + 1];
    if (s->phase[i] != R22 || (y > 5.0 && y < 25.0)) continue;
    u[y > 5.0] -= s->v[2 * i];
    n[y > 5.0] += 1.0;
  }
  return unit_speed * (u[1] / n[1] - u[0] / n[0]);
}

static double highest_pressure(const plane *s) {
  double most = 0.0;
  for (int64_t i = 0; i < s->n; ++i) most = fmax(most, s->p[i]);
  return most;
}

/* ---- demo -------------------------------------------------------------------------------- */

static const char picture[] =
    "set terminal pngcairo size 1300,900\nset output 'shock_bubble.png'\n"
    "set datafile separator ','\nset multiplot layout 4,2\nset yrange [-0.0445:0.0445]\n"
    "set size ratio -1\nset tics out\n"
    "do for [k=0:3] {\n  us = word('55 187 417 1020', k + 1)\n"
    "  set xrange [0.6-(k<3?0.1:0.15):0.6+(k<3?0.1:0.05)]\n"
    "  set cbrange [1:1.9]\n  set title us.' us, pressure'\n"
    "  plot for [m=-1:1:2] 'shock_bubble.csv' index k using 1:(m*$2):4 with points pt 7 ps 0.25 "
    "palette notitle\n"
    "  set cbrange [1:8]\n  set title us.' us, density'\n"
    "  plot for [m=-1:1:2] 'shock_bubble.csv' index k using 1:(m*$2):3 with points pt 7 ps 0.25 "
    "palette notitle\n}\n";

static int demo(void) {
  static const double times[] = {55.0, 187.0, 417.0, 1020.0};
  plane s;
  bubble_create(&s, 45);
  FILE *file = open_output("shock_bubble.csv");
  for (int k = 0; k < 4; ++k) {
    run_to(&s, times[k]);
    printf(
        "%5.0f us: interface on the axis %+.1f and %+.1f mm, half height %.1f mm, P up to %.2f\n",
        times[k], interface(&s, 1.0), interface(&s, -1.0), bubble_height(&s), highest_pressure(&s));
    for (int64_t i = 0; i < s.n; ++i)
      if (fabs(s.x[2 * i] - centre) < 0.16)
        fprintf(file, "%.6g,%.6g,%.6g,%.6g\n", s.x[2 * i], s.x[2 * i + 1], s.rho[i], s.p[i]);
    fprintf(file, "\n\n");
  }
  fclose(file);
  draw("shock_bubble.gp", picture);
  const int failed = !(vortex_speed(&s) > 10.0);
  plane_destroy(&s);
  return failed;
}

/* Every figure with its bound; nothing in there is needed to use the library. */
#include "shock_bubble_validate.h"

int main(int argc, char **argv) {
  const int proof = argc > 1 && strcmp(argv[1], "demo") != 0;
  return (proof ? validate(strcmp(argv[1], "long") == 0) : demo()) != 0;
}
