/* A vortex that should stand still: how much viscosity and the noise of the particles wear it down.
 *
 * Equations   those of smoothing.h with number smoothing, P = (gamma - 1) rho e, with viscosity
 *             and mass flux; no conductivity, for there is no shock
 * Set-up      periodic box [-0.5, 0.5]^2, rho = 1, gamma = 5/3; v and P of sph_gresho_solution():
 *             v = r/0.2 up to r = 0.2, 2 - r/0.2 up to 0.4, 0 beyond, P = 5 at the centre, so that
 *             the Mach number is 0.35 at most. Square lattice, Gaussian, eta = 1.2, b = 2, t = 1:
 *             0.8 turns at r = 0.2. a_v = 1, the source's for shocks, and 0.05
 * Reference   the vortex itself: P. Gresho, S. Chan, Int. J. Numer. Meth. Fluids 11 (1990) 621;
 *             R. Liska, B. Wendroff, SIAM J. Sci. Comput. 25 (2003) 995, as a test of gas dynamics.
 *             V. Springel, MNRAS 401 (2010) 791, finds that SPH converges slowly here
 * Expected    L1, the mean of |v_angle - exact| over r < 0.5, falls as N grows; less viscosity,
 *             less loss
 *
 *   gresho            errors, profiles as CSV and, with gnuplot, a picture
 *   gresho validate   N = 32^2, 64^2
 *   gresho long       128^2 as well */
#include "shock_plane.h"

static const double end_time = 1.0, half_box = 0.5;

static void exact_vortex(sph_context *ctx, int64_t n, const double *r, double *v, double *p) {
  sph_gresho_options o;
  sph_gresho_options_init(&o);
  need(ctx, sph_gresho_solution(ctx, &o, n, r, v, p));
}

static void fill(plane *s) {
  double *x = field(s->ctx, s->set, SPH_FIELD_X), *v = field(s->ctx, s->set, SPH_FIELD_V);
  double *rho = field(s->ctx, s->set, SPH_FIELD_RHO), *p = field(s->ctx, s->set, SPH_FIELD_P);
  for (int64_t i = 0; i < s->n; ++i) {
    const double r = hypot(x[2 * i], x[2 * i + 1]);
    double around;
    exact_vortex(s->ctx, 1, &r, &around, &p[i]);
    v[2 * i] = -around * x[2 * i + 1] / r; /* no particle of the lattice is at the centre */
    v[2 * i + 1] = around * x[2 * i] / r;
    rho[i] = 1.0;
  }
}

static void vortex_create(plane *s, int cells, double viscosity) {
  const double lo[2] = {-half_box, -half_box}, hi[2] = {half_box, half_box};
  sph_material *gas;
  sph_dissipation loss;
  sph_shocks_options o;
  sph_dissipation_init(&loss);
  loss.viscosity = viscosity;
  loss.conductivity = 0.0;
  sph_shocks_options_init(&o);
  o.dim = 2;
  o.dissipation = &loss;
  for (int a = 0; a < 2; ++a) {
    o.periodic[a] = 1;
    o.box_lo[a] = lo[a];
    o.box_hi[a] = hi[a];
  }
  plane_create(s, 1.0 / cells);
  plane_lattice(s, lo, hi, NULL, NULL);
  fill(s);
  gas = plane_gas(s->ctx, 5.0 / 3.0, 0.0);
  plane_start(s, &o, &gas, 1);
}

/* ---- figures ----------------------------------------------------------------------------- */

/* Distance from the centre and velocity around it; positions may have left the box. */
static void polar(const plane *s, int64_t i, double *r, double *around) {
  const double x = s->x[2 * i] - round(s->x[2 * i]), y = s->x[2 * i + 1] - round(s->x[2 * i + 1]);
  *r = hypot(x, y);
  *around = (x * s->v[2 * i + 1] - y * s->v[2 * i]) / *r;
}

typedef struct errors {
  double l1, peak; /* peak: mean velocity in 0.18 < r < 0.22, exact 0.95 */
} errors;

static errors measure(const plane *s) {
  errors e = {0.0, 0.0};
  int64_t count = 0, top = 0;
  for (int64_t i = 0; i < s->n; ++i) {
    double r, around, exact;
    polar(s, i, &r, &around);
    if (r >= half_box) continue;
    exact_vortex(s->ctx, 1, &r, &exact, NULL);
    e.l1 += fabs(around - exact);
    ++count;
    if (fabs(r - 0.2) > 0.02) continue;
    e.peak += around;
    ++top;
  }
  e.l1 /= (double)count;
  e.peak /= (double)top;
  return e;
}

static void write_profile(const plane *s, const char *path) {
  FILE *file = open_output(path);
  for (int64_t i = 0; i < s->n; ++i) {
    double r, around;
    polar(s, i, &r, &around);
    if (r < half_box) fprintf(file, "%.6g,%.6g\n", r, around);
  }
  fclose(file);
}

/* ---- demo -------------------------------------------------------------------------------- */

static const char picture[] =
    "set terminal pngcairo size 900,600\nset output 'gresho.png'\nset datafile separator ','\n"
    "set xlabel 'r'\nset ylabel 'v'\n"
    "plot 'thick.csv' with dots title 'a_v = 1', 'thin.csv' with points pt 7 ps 0.3 title "
    "'a_v = 0.05', \\\n  x < 0.2 ? 5*x : x < 0.4 ? 2 - 5*x : 0 with lines lc rgb 'black' title "
    "'exact'\n";

static int demo(void) {
  static const double viscosity[] = {1.0, 0.05};
  static const char *const files[] = {"thick.csv", "thin.csv"};
  errors e[2];
  for (int k = 0; k < 2; ++k) {
    plane s;
    vortex_create(&s, 64, viscosity[k]);
    need(s.ctx, plane_run(&s, end_time));
    e[k] = measure(&s);
    printf("N = 64^2, a_v = %g: L1 %.4f, peak %.3f, energy error %.1e\n", viscosity[k], e[k].l1,
           e[k].peak, plane_drift(&s));
    write_profile(&s, files[k]);
    plane_destroy(&s);
  }
  draw("gresho.gp", picture);
  return !(e[1].l1 < e[0].l1);
}

/* Every figure with its bound; nothing in there is needed to use the library. */
#include "gresho_validate.h"

int main(int argc, char **argv) {
  const int proof = argc > 1 && strcmp(argv[1], "demo") != 0;
  return (proof ? validate(strcmp(argv[1], "long") == 0) : demo()) != 0;
}
