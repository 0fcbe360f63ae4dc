/* A cantilever beam of magnesium that swings in its first mode.
 *
 * Equations   dv/dt = (1/rho) div sigma, Hooke in plane stress with the Jaumann rate, dx/dt = v
 *   dv_i/dt = sum_j m_j [sigma_i B_i^-1 / rho_i^2 + sigma_j B_j^-1 / rho_j^2
 *                        + f^4 (R_i + R_j) - Pi_ij] g_ij
 *   L_i     = sum_j m_j/rho_j (v_j - v_i) B_i^-1 g_ij
 *   the ready scheme of elastodynamics.h. He and He & Seaid print B_i^-1 on sigma_j, too: that does
 *   not balance L_i at free surfaces, gains energy, and is up to 11 % too slow.
 *
 * Set-up      L = 0.5 m, depth d = 0.1 or 0.05 m, rho = 1738 kg/m^3, E = 45 GPa, nu = 0.35, plane
 *   stress. Square lattice of spacing dp with particles on the faces, cubic spline, h = 1.5 dp,
 *   alpha = beta = 2.5, artificial stress epsilon = 0.3. Clamp: three columns of wall particles at
 *   x < 0. At t = 0 v_y is the first mode, V_f c at the tip. RKC at CFL c dt/dp = 2.5, c^2 = E/rho.
 *
 * Reference   Euler-Bernoulli: omega = sqrt(E d^2 k^4 / (12 rho)), k L = 1.875: 2066 and 1033
 *   rad/s (the sources say Hz). Plane stress, finite elements: 2008.2 and 1026.2 rad/s, 2.8 % and
 *   0.7 % less, to which a good solver converges.
 *
 * Expected    dp = 0.01 (d = 0.1) and 0.005 (d = 0.05): within 2.6 % of plane stress. Artificial
 *   stress takes 18 % of the gradients of tension and with it 2.3 % of omega, at any dp; given with
 *   f = 1 at 0.75 dp it takes a third of that. Without it, and with a lattice of cells (nothing
 * on the faces, so that the mass is exact), the errors are 9.5 % and 3.8 %: a rate of 1.3. But then
 *   strains of 10 % (V_f = 0.05) tear particles apart.
 *
 *   oscillating_beam                    three periods; tip.csv and, with gnuplot, a picture
 *   oscillating_beam validate | long    one RESULT line a figure; long: the published spacing
 *   oscillating_beam row DEPTH DP VF    one row of the published table, three periods */
#include "common.h"

#include <string.h>
#include <time.h>

static const double length = 0.5, density = 1738.0, young = 45e9, poisson = 0.35;
static const double pi = 3.14159265358979323846, kL = 1.8751040687119612;

enum { CROSSINGS = 32 };

typedef struct beam_options {
  double depth, dp, v_f; /* m, m, tip velocity over c */
  double cfl, periods;
  int32_t form;     /* SPH_STRESS_* */
  double epsilon;   /* of the artificial stress */
  double viscosity; /* alpha = beta */
  int32_t faces;    /* particles on the faces, else a lattice of cells */
  int32_t position; /* SPH_FIELD_X; SPH_FIELD_X0: frozen configuration */
  int32_t audit;    /* keep the energy ledger */
  int32_t clamp;    /* columns of the clamp */
  double touch;     /* distance in dp at which artificial stress is full */
} beam_options;

#define STANDARD SPH_STRESS_CONSERVATIVE, 0.3, 2.5, 1, SPH_FIELD_X, 0, 3, 1.0

typedef struct beam {
  beam_options o;
  double c, dt, omega; /* omega: Euler-Bernoulli */
  int columns, rows;
  sph_context *ctx;
  sph_particles *set;
  sph_elastodynamics *solid;
  FILE *history; /* NULL: none */
} beam;

typedef struct outcome {
  double omega; /* pi over the mean distance of zero crossings of the tip; NaN: none, or blown up */
  double peaks[CROSSINGS]; /* largest deflections between them, over V_f c / omega_EB */
  int crossings;
  int32_t stages;
  double growth, balance, form; /* of the ledger, over the energy at the start */
  double seconds;
} outcome;

/* ---- set-up ------------------------------------------------------------------------------ */

/* v_y / (V_f c) of the first mode, 1 at the tip. */
static double mode(double x) {
  const double k = kL / length * x, M = sin(kL) + sinh(kL), N = cos(kL) + cosh(kL);
  const double Q = 2.0 * (cos(kL) * sinh(kL) - sin(kL) * cosh(kL));
  return (M * (cos(k) - cosh(k)) - N * (sin(k) - sinh(k))) / Q;
}

static void make_particles(beam *b) {
  sph_particles_options options;
  sph_particles_options_init(&options);
  options.dim = 2;
  need(b->ctx, sph_particles_create(b->ctx, &options, &b->set));
  need(b->ctx, sph_particles_add(b->set, (int64_t)b->columns * b->rows, NULL));
  double *x = field(b->ctx, b->set, SPH_FIELD_X), *v = field(b->ctx, b->set, SPH_FIELD_V);
  double *m = field(b->ctx, b->set, SPH_FIELD_M), *rho = field(b->ctx, b->set, SPH_FIELD_RHO);
  int32_t *role = sph_particles_roles(b->set);
  for (int64_t i = 0; i < sph_particles_count(b->set); ++i) {
    const int column = (int)(i / b->rows), row = (int)(i % b->rows);
    x[2 * i] = (column - b->o.clamp + 0.5) * b->o.dp;
    x[2 * i + 1] = (row - 0.5 * (b->rows - 1)) * b->o.dp;
    rho[i] = density;
    m[i] = density * b->o.dp * b->o.dp;
    if (column < b->o.clamp)
      role[i] = SPH_ROLE_WALL; /* its velocity stays 0 */
    else
      v[2 * i + 1] = b->o.v_f * b->c * mode(x[2 * i]);
  }
  need(b->ctx, sph_particles_touch(b->set, SPH_FIELD_X));
}

static void make_scheme(beam *b) {
  sph_material *hooke;
  sph_hooke_options elastic;
  sph_elastodynamics_options options;
  sph_hooke_options_init(&elastic);
  elastic.young = young;
  elastic.poisson = poisson;
  elastic.density = density;
  elastic.reduction = SPH_PLANE_STRESS;
  sph_elastodynamics_options_init(&options);
  options.dim = 2;
  options.spacing = b->o.dp;
  options.momentum = b->o.form;
  options.artificial_stress = b->o.epsilon;
  options.artificial_spacing = b->o.touch;
  options.alpha = options.beta = b->o.viscosity;
  options.wave_speed = b->c; /* the sources' */
  options.position_field = b->o.position;
  options.audit = b->o.audit;
  need(b->ctx, sph_material_create_hooke(b->ctx, &elastic, &hooke));
  need(b->ctx, sph_elastodynamics_create(b->ctx, b->set, &options, &b->solid));
  need(b->ctx, sph_elastodynamics_set_material(b->solid, 0, hooke));
  sph_material_destroy(hooke); /* the scheme keeps it */
  need(b->ctx, sph_elastodynamics_start(b->solid, 0.0));
}

static void beam_create(beam *b, const beam_options *o) {
  memset(b, 0, sizeof *b);
  b->o = *o;
  b->c = sqrt(young / density);
  b->dt = o->cfl * o->dp / b->c;
  b->omega = pow(kL / length, 2.0) * o->depth * sqrt(young / (12.0 * density));
  b->columns = (int)lround(length / o->dp) + o->clamp;
  b->rows = (int)lround(o->depth / o->dp) + (o->faces != 0);
  need(NULL, sph_context_create(NULL, &b->ctx));
  make_particles(b);
  make_scheme(b);
}

static void beam_destroy(beam *b) {
  sph_elastodynamics_destroy(b->solid);
  sph_particles_destroy(b->set);
  sph_context_destroy(b->ctx);
}

/* ---- running ----------------------------------------------------------------------------- */

/* Mean of the last column: the neutral line may lie between two rows. */
static double deflection(const beam *b) {
  const double *x = sph_particles_field_const(b->set, SPH_FIELD_X);
  double sum = 0.0;
  for (int row = 0; row < b->rows; ++row) sum += x[2 * ((b->columns - 1) * b->rows + row) + 1];
  return sum / b->rows;
}

/* A NaN stays. */
static void largest(double *most, double x) {
  if (!(x <= *most)) *most = x;
}

/* Kinetic energy, what was put into strain, and what artificial stress holds as long as there is
 * tension. Only viscosity may change the sum. */
static void read_ledger(const beam *b, double initial, outcome *r) {
  sph_elastodynamics_ledger ledger;
  if (!b->o.audit) return;
  sph_elastodynamics_ledger_init(&ledger);
  need(b->ctx, sph_elastodynamics_balance(b->solid, &ledger));
  const double energy = ledger.kinetic + ledger.strain + ledger.artificial;
  largest(&r->growth, energy / initial - 1.0);
  largest(&r->balance, fabs(ledger.energy_error) / initial);
  largest(&r->form, fabs(ledger.form) / initial);
}

static double kinetic_energy(const beam *b) {
  sph_elastodynamics_ledger ledger;
  sph_elastodynamics_ledger_init(&ledger);
  need(b->ctx, sph_elastodynamics_balance(b->solid, &ledger));
  return ledger.kinetic;
}

static outcome beam_run(beam *b) {
  const outcome failed = {.omega = NAN, .growth = NAN, .balance = NAN, .form = NAN};
  outcome r = {.growth = -1.0};
  sph_step_info info;
  sph_step_info_init(&info);
  const double initial = kinetic_energy(b), unit = b->o.v_f * b->c / b->omega;
  const int64_t steps = (int64_t)(b->o.periods * 2.0 * pi / (b->omega * b->dt));
  double first = 0.0, last = 0.0, before = 0.0, peak = 0.0;
  const clock_t start = clock();
  for (int64_t k = 0; k < steps && r.crossings < CROSSINGS; ++k) {
    if (sph_elastodynamics_step(b->solid, b->dt, &info) != SPH_OK) return failed;
    const double y = deflection(b), t = (double)k * b->dt;
    peak = fmax(peak, fabs(y));
    if (b->history) fprintf(b->history, "%.9g,%.9g\n", t + b->dt, y);
    if (k % 16 == 15) read_ledger(b, initial, &r);
    if (y * before < 0.0) {
      last = t + b->dt * before / (before - y);
      if (r.crossings == 0) first = last;
      r.peaks[r.crossings++] = peak / unit;
      peak = 0.0;
    }
    before = y;
  }
  r.seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
  r.stages = info.stages;
  r.omega = NAN;
  if (r.crossings == 1) r.omega = pi / first; /* it started from zero */
  if (r.crossings > 1) r.omega = pi * (r.crossings - 1) / (last - first);
  return r;
}

static outcome run(const beam_options *o, const char *history) {
  beam b;
  beam_create(&b, o);
  b.history = history ? open_output(history) : NULL;
  if (b.history) fprintf(b.history, "t,y\n");
  const outcome r = beam_run(&b);
  if (b.history) fclose(b.history);
  beam_destroy(&b);
  return r;
}

/* ---- demo -------------------------------------------------------------------------------- */

static const char picture[] =
    "set terminal pngcairo size 900,500\nset output 'oscillating_beam.png'\n"
    "set datafile separator ','\nset xlabel 't / ms'\nset ylabel 'tip deflection / mm'\n"
    "set xzeroaxis\nset key below\nplot 'tip.csv' skip 1 using ($1*1e3):($2*1e3) with lines lw 2 "
    "title \\\n"
    "  'epsilon = 0.3', 'tip_plain.csv' skip 1 using ($1*1e3):($2*1e3) with lines lw 2 title \\\n"
    "  'no artificial stress', 12.53*sin(2.0082*x) with lines lc rgb 'black' dt 2 title \\\n"
    "  'plane stress, undamped'\n";

static void print_row(const beam_options *o, const outcome *r) {
  const double theory = pow(kL / length, 2.0) * o->depth * sqrt(young / (12.0 * density));
  printf("%6g %8.5f %6g %8g %7d %10.1f %10.2f %% %9.3f %6.1f s\n", o->depth, o->dp, o->v_f,
         o->epsilon, r->stages, r->omega, 100.0 * (r->omega / theory - 1.0),
         r->crossings > 0 ? r->peaks[r->crossings - 1] / r->peaks[0] : NAN, r->seconds);
}

static void print_head(void) {
  printf("%6s %8s %6s %8s %7s %10s %12s %9s\n", "depth", "dp", "V_f", "epsilon", "stages", "omega",
         "against E-B", "amplitude");
}

static int demo(void) {
  beam_options o = {0.1, 0.01, 0.005, 2.5, 3.2, STANDARD};
  print_head();
  const outcome with = run(&o, "tip.csv");
  print_row(&o, &with);
  o.epsilon = 0.0;
  const outcome without = run(&o, "tip_plain.csv");
  print_row(&o, &without);
  draw("oscillating_beam.gp", picture);
  return !(fabs(with.omega / 2008.2 - 1.0) < 0.033) + !(fabs(without.omega / 2008.2 - 1.0) < 0.01);
}

/* The published table and everything else; nothing in there is needed to use the library. */
#include "oscillating_beam_validate.h"

int main(int argc, char **argv) {
  if (argc == 5 && strcmp(argv[1], "row") == 0) return one_row(argv + 2);
  const int full = argc > 1 && strcmp(argv[1], "long") == 0;
  return (argc > 1 && strcmp(argv[1], "demo") != 0 ? validate(full) : demo()) != 0;
}
