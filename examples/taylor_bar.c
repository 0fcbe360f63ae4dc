/* The impact of Taylor: a rod of copper hits a rigid wall and becomes a mushroom. In 3-D.
 *
 * Equations   those of shocks.h with strength: p = K (rho/rho0 - 1), von Mises with linear
 *             hardening, Y = 400 MPa + 100 MPa times the plastic strain
 * Set-up      length 32.4 mm, radius 3.2 mm, 227 m/s, E = 117 GPa, nu = 0.35, 8930 kg/m^3, to
 *             80 us; a wall without friction. A quarter of the rod: mirror images about the wall
 *             and both planes of symmetry. The first row of particles stands on the wall, of half
 *             a cell and without velocity along the axis. Number smoothing; neither mass flux nor
 *             conduction, for there are no shocks, and half the usual viscosity.
 * Reference   a benchmark of finite-element codes: A. Kamoulakos, IMechE Conf. Proc. 1990; Y. Zhu,
 *             S. Cescotto, Int. J. Numer. Methods Engng 38 (1995); G. Camacho, M. Ortiz, CMAME 142
 *             (1997): final length 21.26 to 21.66 mm, radius of the foot 6.89 to 7.24 mm, largest
 *             plastic strain 2.47 to 3.25.
 * Expected: length within 2 per cent, radius within 5 per cent of the middle of these. The length
 * is 21.81, 21.74, 21.70 mm with 4, 5, 6 particles in a radius. It is the viscosity that matters
 * most: with 4 in a radius and a_v = 0.2, 0.5, 1 it is 20.9, 21.8, 22.9 mm.
 *
 *   taylor_bar            four particles in a radius, and a picture
 *   taylor_bar validate   one RESULT line a figure, six in a radius; long: eight as well */
#include "common.h"

#include <string.h>
#include <time.h>

static const double length = 32.4e-3, radius = 3.2e-3, speed = 227.0, duration = 80e-6;
static const double density = 8930.0, young = 117e9, poisson = 0.35;

typedef struct rod {
  sph_context *ctx;
  sph_particles *set;
  sph_shocks *shocks;
  sph_ghosts *mirrors;
  sph_hold *foot; /* no acceleration off the wall */
  int64_t n, rows;
  double spacing;
} rod;

/* ---- set-up ------------------------------------------------------------------------------ */

static int32_t in_rod(void *user, const double *x) {
  (void)user;
  return hypot(x[1], x[2]) < radius;
}

/* Cells along the axis: the first is cut in half by the wall. */
static void make_particles(rod *s, int across) {
  sph_lattice_options o;
  sph_particles_options options;
  sph_particles_options_init(&options);
  need(s->ctx, sph_particles_create(s->ctx, &options, &s->set));
  sph_lattice_options_init(&o);
  o.dim = 3;
  o.spacing = s->spacing = radius / across;
  s->rows = llround(length / s->spacing + 0.5);
  const double cell = length / ((double)s->rows - 0.5);
  o.lo[0] = -0.5 * cell;
  o.hi[0] = length;
  o.hi[1] = o.hi[2] = radius;
  o.inside = in_rod;
  need(s->ctx, sph_layout_lattice(s->ctx, &o, 0, NULL, &s->n));
  need(s->ctx, sph_particles_add(s->set, s->n, NULL));
  double *x = field(s->ctx, s->set, SPH_FIELD_X), *v = field(s->ctx, s->set, SPH_FIELD_V);
  double *m = field(s->ctx, s->set, SPH_FIELD_M), *rho = field(s->ctx, s->set, SPH_FIELD_RHO);
  need(s->ctx, sph_layout_lattice(s->ctx, &o, s->n, x, &s->n));
  for (int64_t i = 0; i < s->n; ++i) {
    const int on_wall = i % s->rows == 0;
    if (on_wall) x[3 * i] = 0.0; /* exactly, so that it has no image of its own */
    v[3 * i] = on_wall ? 0.0 : -speed;
    rho[i] = density;
    m[i] = (on_wall ? 0.5 : 1.0) * density * cell * s->spacing * s->spacing;
  }
}

static sph_material *make_copper(sph_context *ctx) {
  sph_material *pressure, *copper;
  sph_barotropic_options eos;
  sph_strength_options strength;
  sph_barotropic_options_init(&eos);
  eos.density = density;
  eos.sound_speed = sqrt(young / (3.0 * (1.0 - 2.0 * poisson)) / density);
  eos.gamma = 1.0;
  sph_strength_options_init(&strength);
  strength.shear = 0.5 * young / (1.0 + poisson);
  strength.yield = 400e6;
  strength.hardening = 100e6;
  need(ctx, sph_material_create_barotropic(ctx, &eos, &pressure));
  need(ctx, sph_material_create_strength(ctx, pressure, &strength, &copper));
  sph_material_destroy(pressure); /* copper keeps it */
  return copper;
}

static void make_scheme(rod *s) {
  sph_shocks_options options;
  sph_dissipation loss;
  sph_dissipation_init(&loss);
  loss.viscosity = 0.5;
  loss.mass_flux = loss.conductivity = 0.0;
  sph_shocks_options_init(&options);
  options.dim = 3;
  options.dissipation = &loss;
  need(s->ctx, sph_shocks_create(s->ctx, s->set, &options, &s->shocks));
  sph_material *copper = make_copper(s->ctx);
  need(s->ctx, sph_shocks_set_material(s->shocks, 0, copper));
  sph_material_destroy(copper); /* the scheme keeps it */
}

/* The wall x = 0, and the planes of symmetry y = 0 and z = 0. */
static void make_walls(rod *s) {
  sph_ghosts_options options;
  sph_ghosts_options_init(&options);
  options.support = sph_kernel_support(sph_shocks_kernel(s->shocks));
  options.escape = SPH_ESCAPE_IGNORE; /* at a corner one may stray by less than a micrometre */
  need(s->ctx, sph_ghosts_create(s->ctx, &options, &s->mirrors));
  for (int a = 0; a < 3; ++a) {
    sph_wall wall;
    sph_wall_init(&wall);
    wall.kind = SPH_WALL_SLIP;
    wall.normal[a] = 1.0;
    need(s->ctx, sph_ghosts_add_wall(s->mirrors, &wall, NULL));
  }
  need(s->ctx, sph_shocks_set_ghosts(s->shocks, s->mirrors));
  need(s->ctx, sph_hold_create(s->ctx, &s->foot));
  for (int64_t i = 0; i < s->n; i += s->rows)
    need(s->ctx, sph_hold_field(s->foot, SPH_FIELD_V, 1, NULL, i, 1, NULL, NULL, NULL));
  need(s->ctx, sph_shocks_set_finish(s->shocks, sph_hold_finish, s->foot));
}

static void rod_create(rod *s, int across) {
  *s = (rod){.n = 0};
  need(NULL, sph_context_create(NULL, &s->ctx));
  make_particles(s, across);
  make_scheme(s);
  make_walls(s);
  need(s->ctx, sph_shocks_start(s->shocks, 0.0));
}

static void rod_destroy(rod *s) {
  sph_hold_destroy(s->foot);
  sph_shocks_destroy(s->shocks);
  sph_ghosts_destroy(s->mirrors);
  sph_particles_destroy(s->set);
  sph_context_destroy(s->ctx);
}

/* ---- figures ----------------------------------------------------------------------------- */

typedef struct outcome {
  double length, radius, strain; /* largest plastic strain */
  double energy, kinetic;        /* change of the total, and what is left; of the first kinetic */
  int64_t steps;
  double seconds;
} outcome;

/* The free end: the mean of the last row, and half its cell. */
static double final_length(const rod *s) {
  const double *x = sph_particles_field_const(s->set, SPH_FIELD_X);
  double sum = 0.0;
  for (int64_t i = s->rows - 1; i < s->n; i += s->rows) sum += x[3 * i];
  return sum / (double)(s->n / s->rows) + 0.5 * length / ((double)s->rows - 0.5);
}

/* The foot: the outermost particle, and half a spacing. */
static double final_radius(const rod *s) {
  const double *x = sph_particles_field_const(s->set, SPH_FIELD_X);
  double most = 0.0;
  for (int64_t i = 0; i < s->n; ++i) most = fmax(most, hypot(x[3 * i + 1], x[3 * i + 2]));
  return most + 0.5 * s->spacing;
}

static double largest_strain(const rod *s) {
  const double *strain =
      sph_particles_field_const(s->set, sph_particles_find_field(s->set, "plastic_strain"));
  double most = 0.0;
  for (int64_t i = 0; i < s->n; ++i) most = fmax(most, strain[i]);
  return most;
}

static outcome run(rod *s) {
  sph_shocks_ledger ledger;
  sph_shocks_ledger_init(&ledger);
  need(s->ctx, sph_shocks_balance(s->shocks, &ledger));
  const double first = ledger.total;
  const clock_t start = clock();
  need(s->ctx, sph_shocks_run(s->shocks, duration, NULL, NULL));
  const double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
  need(s->ctx, sph_shocks_balance(s->shocks, &ledger));
  return (outcome){.length = final_length(s),
                   .radius = final_radius(s),
                   .strain = largest_strain(s),
                   .energy = fabs(ledger.energy_error) / first,
                   .kinetic = ledger.kinetic / first,
                   .steps = ledger.steps,
                   .seconds = seconds};
}

/* ---- demo -------------------------------------------------------------------------------- */

static void write_files(const rod *s) {
  const double *x = sph_particles_field_const(s->set, SPH_FIELD_X);
  const double *strain =
      sph_particles_field_const(s->set, sph_particles_find_field(s->set, "plastic_strain"));
  FILE *file = open_output("taylor_bar.csv");
  fprintf(file, "x,r,plastic_strain\n");
  for (int64_t i = 0; i < s->n; ++i)
    fprintf(file, "%.5g,%.5g,%.4g\n", 1e3 * x[3 * i], 1e3 * hypot(x[3 * i + 1], x[3 * i + 2]),
            strain[i]);
  fclose(file);
}

static const char picture[] =
    "set terminal pngcairo noenhanced size 1000,420\nset output 'taylor_bar.png'\n"
    "set datafile separator ','\nset size ratio -1\nset key off\nset cblabel 'plastic strain'\n"
    "set palette rgb 33,13,10\nset xrange [0:24]\nset yrange [0:9]\nset xlabel 'x / mm'\n"
    "set ylabel 'r / mm'\nset title 'copper rod, 80 us after it met the wall x = 0'\n"
    "plot 'taylor_bar.csv' skip 1 using 1:2:3 with points pt 7 ps 0.9 palette\n";

static int demo(void) {
  rod s;
  rod_create(&s, 4);
  const outcome o = run(&s);
  printf("length %.2f mm (21.26 to 21.66), radius %.2f mm (6.89 to 7.24), largest plastic strain "
         "%.2f\n%lld particles, %lld steps, %.1f s, energy error %.1e\n",
         1e3 * o.length, 1e3 * o.radius, o.strain, (long long)s.n, (long long)o.steps, o.seconds,
         o.energy);
  write_files(&s);
  draw("taylor_bar.gp", picture);
  rod_destroy(&s);
  return !(fabs(o.length / 21.46e-3 - 1.0) < 0.05);
}

/* Every figure with its bound; nothing in there is needed to use the library. */
#include "taylor_bar_validate.h"

int main(int argc, char **argv) {
  if (argc < 2 || strcmp(argv[1], "demo") == 0) return demo() != 0;
  return validate(strcmp(argv[1], "long") == 0) != 0;
}
