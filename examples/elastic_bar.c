/* A stress wave in an elastic bar of magnesium, fixed at one end, loaded suddenly at the other.
 *
 * Equations   dv/dt = (1/rho) dsigma/dx,   dsigma/dt = E dv/dx,   dx/dt = v       (uniaxial stress)
 *   dv_i/dt     = sum_j m_j [(sigma_j - sigma_i) / (rho_i rho_j) - Pi_ij] dW~_ij
 *   dsigma_i/dt = E sum_j m_j/rho_j (v_j - v_i) dW~_ij
 *   with the corrected kernel gradient dW~ and Monaghan's viscosity Pi. He prints the first sum
 *   with sigma_j + sigma_i; it is the difference that gives his figures.
 * Set-up      L = 1 m, rho = 1738 kg/m^3, E = 45 GPa, so c = 5088.4 m/s. N particles at the middles
 *             of cells dp = L/N; cubic spline, h = 1.5 dp, alpha = beta = 2.5. From t = 0 a stress
 *             of -8.8436 MPa acts at x = 0: it is held on the first particle; the velocity 0 is
 *             held on the last. (Other form, for comparison: the sum, with ghosts beyond the ends.)
 * Reference   exact: with v0 = sigma0 / (rho c) = 1 m/s, v = v0 and sigma = -sigma0 behind the
 *             front x = c t; at the fixed end the stress doubles. Published:
 *             elastic_bar_validate.h.
 * Norms       L1 and L2 of the velocity over all particles at t = 0.12 ms, relative.
 * Expected    RKC at any CFL of the table, N = 250: L1 = .089, L2 = .161, all of it viscous
 *             smearing, so rates of 1/2 and 1/4; with alpha = beta = .5, h = 1.2 dp: L1 < .036.
 *
 *   elastic_bar            compare RKC and RK4, write profiles as CSV and, with gnuplot, a picture
 *   elastic_bar validate   every entry of the published tables, one RESULT line each */
#include "common.h"

#include <string.h>
#include <time.h>

static const double length = 1.0, density = 1738.0, young = 45e9, load = 8.8436e6;
static const double snapshot = 1.2e-4; /* s */

typedef struct bar_options {
  int n;
  int32_t scheme; /* SPH_INTEGRATOR_* */
  double cfl;
  double viscosity; /* alpha = beta */
  double h_ratio;   /* h / dp */
  int32_t form;     /* SPH_STRESS_DIFFERENCE: held end particles; SPH_STRESS_SUMMED: ghosts */
  int32_t stages;   /* of RKC; 0: by formula */
} bar_options;

#define STANDARD 2.5, 1.5, SPH_STRESS_DIFFERENCE, 0

typedef struct bar {
  bar_options o;
  double dp, c;
  int ghosts; /* at each end */
  sph_context *ctx;
  sph_particles *set;
  sph_neighbors *list;
  sph_rhs *rhs;
  sph_integrator *integrator;
  double *x, *v, *sigma, *v_exact, *sigma_exact; /* fields of the set */
} bar;

/* What the integrator reported, and the errors against the exact solution. */
typedef struct outcome {
  norms error; /* NaN: the run blew up */
  int32_t stages;
  int64_t evaluations;
  double seconds, end_stress;
} outcome;

/* ---- boundary conditions ----------------------------------------------------------------- */

/* Finish hook: a held value has the rate 0. */
static int32_t hold_ends(void *user, double t, sph_particles *set, const sph_rate *rates,
                         int32_t count) {
  const bar *b = user;
  (void)t;
  (void)set;
  for (int32_t k = 0; k < count; ++k) {
    if (rates[k].field == SPH_FIELD_SIGMA) rates[k].values[0] = 0.0;
    if (rates[k].field == SPH_FIELD_V) rates[k].values[b->o.n - 1] = 0.0;
  }
  return 0;
}

/* Ghosts beyond both ends instead, for the summed form, which is not the published one. */
static void add_ghosts(bar *b);
static int32_t mirror_ends(void *user, double t, sph_particles *set, const sph_rate *rates,
                           int32_t count);

/* ---- set-up ------------------------------------------------------------------------------ */

/* Built-in fields come to be when they are asked for; a host adds its own by name. */
static double *own_field(bar *b, const char *name) {
  int32_t id;
  need(b->ctx, sph_particles_add_field(b->set, name, 1, &id));
  return field(b->ctx, b->set, id);
}

static void make_particles(bar *b) {
  sph_particles_options options;
  sph_particles_options_init(&options);
  options.dim = 1;
  need(b->ctx, sph_particles_create(b->ctx, &options, &b->set));
  need(b->ctx, sph_particles_add(b->set, b->o.n, NULL));
  if (b->o.form == SPH_STRESS_SUMMED) add_ghosts(b);
  b->x = field(b->ctx, b->set, SPH_FIELD_X);
  b->v = field(b->ctx, b->set, SPH_FIELD_V); /* zero, as every new field */
  b->sigma = field(b->ctx, b->set, SPH_FIELD_SIGMA);
  b->v_exact = own_field(b, "v_exact");
  b->sigma_exact = own_field(b, "sigma_exact");
  double *m = field(b->ctx, b->set, SPH_FIELD_M), *rho = field(b->ctx, b->set, SPH_FIELD_RHO);
  double *h = field(b->ctx, b->set, SPH_FIELD_H), *c = field(b->ctx, b->set, SPH_FIELD_C);
  for (int64_t i = 0; i < sph_particles_count(b->set); ++i) {
    b->x[i] = ((double)i + 0.5) * b->dp;
    m[i] = density * b->dp;
    rho[i] = density;
    h[i] = b->o.h_ratio * b->dp;
    c[i] = b->c;
  }
  if (b->o.form == SPH_STRESS_DIFFERENCE) b->sigma[0] = -load;
  need(b->ctx, sph_particles_touch(b->set, SPH_FIELD_X));
  need(b->ctx, sph_particles_touch(b->set, SPH_FIELD_H));
}

static void add_term(bar *b, int32_t kind, int32_t form, int32_t corrected, double viscosity) {
  sph_term term;
  sph_term_init(&term);
  term.kind = kind;
  term.form = form;
  term.corrected = corrected;
  term.alpha = term.beta = viscosity;
  need(b->ctx, sph_rhs_add(b->rhs, &term));
}

static void make_rhs(bar *b) {
  sph_kernel *kernel;
  sph_material *hooke;
  sph_hooke_options elastic;
  sph_hooke_options_init(&elastic);
  elastic.young = young;
  elastic.density = density;
  need(b->ctx, sph_kernel_create(b->ctx, SPH_KERNEL_CUBIC_SPLINE, 1, &kernel));
  need(b->ctx, sph_material_create_hooke(b->ctx, &elastic, &hooke));
  need(b->ctx, sph_rhs_create(b->ctx, kernel, NULL, &b->rhs));
  add_term(b, SPH_TERM_MOTION, 0, 0, 0.0);
  add_term(b, SPH_TERM_STRESS, b->o.form, 1, 0.0);
  add_term(b, SPH_TERM_STRESS_RATE, 0, 1, 0.0);
  add_term(b, SPH_TERM_MONAGHAN, 0, 1, b->o.viscosity);
  need(b->ctx, sph_rhs_set_material(b->rhs, 0, hooke));
  need(b->ctx, b->o.form == SPH_STRESS_SUMMED ? sph_rhs_set_prepare(b->rhs, mirror_ends, b)
                                              : sph_rhs_set_finish(b->rhs, hold_ends, b));
  sph_material_destroy(hooke); /* the right-hand side keeps both */
  sph_kernel_destroy(kernel);
}

static void make_integrator(bar *b) {
  sph_integrator_options options;
  sph_integrator_options_init(&options);
  options.method = b->o.scheme;
  options.stage_rule = SPH_STAGES_CFL; /* of RKC: s = 1 + floor(sqrt(1 + CFL / 0.131)) */
  if (b->o.stages > 0) {
    options.stage_rule = SPH_STAGES_FIXED;
    options.stages = b->o.stages;
  }
  options.wave_speed = b->c;
  options.spacing = b->dp;
  need(b->ctx, sph_integrator_create(b->ctx, &options, &b->integrator));
  need(b->ctx, sph_integrator_bind_field(b->integrator, SPH_FIELD_X));
  need(b->ctx, sph_integrator_bind_field(b->integrator, SPH_FIELD_V));
  need(b->ctx, sph_integrator_bind_field(b->integrator, SPH_FIELD_SIGMA));
  need(b->ctx, sph_integrator_set_rhs(b->integrator, b->rhs, b->list));
}

static void bar_create(bar *b, const bar_options *o) {
  sph_context_options context;
  sph_context_options_init(&context);
  context.log = log_to_stderr;
  memset(b, 0, sizeof *b);
  b->o = *o;
  b->dp = length / o->n;
  b->c = sqrt(young / density);
  need(NULL, sph_context_create(&context, &b->ctx));
  make_particles(b);
  sph_neighbors_options options;
  sph_neighbors_options_init(&options);
  options.method = SPH_NEIGHBORS_VERLET; /* kept while nothing moves by more than skin / 2 */
  options.skin = 0.25 * b->dp;
  need(b->ctx, sph_neighbors_create(b->ctx, &options, &b->list));
  make_rhs(b);
  make_integrator(b);
}

static void bar_destroy(bar *b) {
  sph_integrator_destroy(b->integrator);
  sph_rhs_destroy(b->rhs);
  sph_neighbors_destroy(b->list);
  sph_particles_destroy(b->set);
  sph_context_destroy(b->ctx);
}

/* ---- running ----------------------------------------------------------------------------- */

/* Exact velocity and stress at the particles, until the front comes back to the free end. */
static void exact_state(bar *b, double t) {
  for (int i = 0; i < b->o.n; ++i) {
    const double x = ((double)i + 0.5) * b->dp; /* where the particle was at rest */
    const int loaded = x < b->c * t, reflected = 2.0 * length - x < b->c * t;
    b->v_exact[i] = (loaded - reflected) * load / (density * b->c);
    b->sigma_exact[i] = -(loaded + reflected) * load;
  }
}

/* To time t, the last step shortened to end there. The errors are NaN when the run blew up. */
static outcome bar_run(bar *b, double t) {
  outcome r = {.error = {NAN, NAN}};
  sph_step_info info;
  sph_step_info_init(&info);
  const double dt = b->o.cfl * b->dp / b->c;
  const int64_t full = (int64_t)(t / dt * (1.0 + 1e-12));
  const clock_t start = clock();
  for (int64_t k = 0; k <= full; ++k) {
    const double now = (double)k * dt, step = k < full ? dt : t - now;
    if (step < 1e-9 * dt) break;
    if (sph_integrator_step(b->integrator, b->set, now, step, &info) != SPH_OK) return r;
    show_progress((double)k / (double)full, "steps");
    if (k < full) r.stages = info.stages;
    r.evaluations += info.evaluations;
  }
  show_progress(1.0, "steps");
  r.seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
  r.end_stress = b->sigma[b->o.n - 1];
  exact_state(b, t);
  r.error = relative_norms(b->o.n, b->v, b->v_exact);
  return r;
}

/* ---- demo -------------------------------------------------------------------------------- */

static void write_profile(const bar *b, const char *path) {
  FILE *file = open_output(path);
  fprintf(file, "x,v,v_exact,sigma,sigma_exact\n");
  for (int i = 0; i < b->o.n; ++i)
    fprintf(file, "%.9g,%.9g,%.9g,%.9g,%.9g\n", b->x[i], b->v[i], b->v_exact[i], b->sigma[i],
            b->sigma_exact[i]);
  fclose(file);
  printf("  wrote %s\n", path);
}

static const char picture[] =
    "set terminal pngcairo size 900,800\nset output 'elastic_bar.png'\n"
    "set datafile separator ','\nset multiplot layout 2,1\nset xlabel 'x / m'\n"
    "set ylabel 'velocity / (m/s)'\nset key bottom left\n"
    "plot 'rkc.csv' skip 1 using 1:3 with steps lc rgb 'black' title 'exact', \\\n"
    "  '' skip 1 using 1:2 with lines lw 2 title 'RKC, CFL 2.5', \\\n"
    "  'rk4.csv' skip 1 using 1:2 with lines dt 2 lw 2 title 'RK4, CFL 0.6', \\\n"
    "  'rkc_sharp.csv' skip 1 using 1:2 with lines lw 2 title 'RKC, less viscosity'\n"
    "set ylabel 'stress / MPa'\nset key top left\n"
    "plot 'rkc.csv' skip 1 using 1:($5/1e6) with steps lc rgb 'black' title 'exact', \\\n"
    "  '' skip 1 using 1:($4/1e6) with lines lw 2 title 'RKC, CFL 2.5', \\\n"
    "  'rk4.csv' skip 1 using 1:($4/1e6) with lines dt 2 lw 2 title 'RK4, CFL 0.6', \\\n"
    "  'rkc_sharp.csv' skip 1 using 1:($4/1e6) with lines lw 2 title 'RKC, less viscosity'\n";

static int demo(void) {
  static const struct {
    const char *name, *published, *csv;
    bar_options o;
  } runs[] = {
      {"RKC", ".0888 .1614", "rkc.csv", {250, SPH_INTEGRATOR_RKC, 2.5, STANDARD}},
      {"RK4", ".1005 .1710", "rk4.csv", {250, SPH_INTEGRATOR_RK4, 0.6, STANDARD}},
      {"RK4", "(the same)", NULL, {250, SPH_INTEGRATOR_RK4, 0.8, STANDARD}},
      {"RKC, less viscosity", "", "rkc_sharp.csv", {250, SPH_INTEGRATOR_RKC, 1.2, .5, 1.2, 2, 0}},
  };
  int failed = 0;
  printf("Elastic bar, 250 particles: velocity at t = 0.12 ms, relative errors L1 L2\n\n"
         "%-20s %4s %6s %11s %6s   %-11s   %s\n",
         "method", "CFL", "stages", "evaluations", "ms", "published", "measured");
  for (size_t k = 0; k < sizeof runs / sizeof *runs; ++k) {
    bar b;
    bar_create(&b, &runs[k].o);
    const outcome r = bar_run(&b, snapshot);
    printf("%-20s %4.1f %6d %11lld %6.1f   %-11s   %.4f %.4f\n", runs[k].name, b.o.cfl, r.stages,
           (long long)r.evaluations, 1e3 * r.seconds, runs[k].published, r.error.l1, r.error.l2);
    failed += !(r.error.l1 < 0.102);
    if (runs[k].csv) write_profile(&b, runs[k].csv);
    bar_destroy(&b);
  }
  printf("\nWhat is published for RK4 at CFL 0.6 are the errors of CFL 0.8.\n");
  draw("elastic_bar.gp", picture);
  return failed;
}

/* The published tables, entry by entry; nothing in there is needed to use the library. */
#include "elastic_bar_validate.h"

int main(int argc, char **argv) {
  return (argc > 1 && strcmp(argv[1], "demo") != 0 ? validate() : demo()) != 0;
}
