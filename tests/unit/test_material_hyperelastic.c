/* Hyperelastic laws against the stored energy of the full 3x3 deformation gradient in long double,
 * in which the stretches across are found by bisection on the slope of that energy, and the
 * stresses by differences of it; objectivity, the limit of small strains, ranges. */
#include "../../src/material/material_impl.h"
#include "../material_help.h"
#include "../oom.h"

static const double young = 2.7;

static sph_hyperelastic_options options_of(int32_t law, int32_t reduction, double nu) {
  sph_hyperelastic_options o;
  sph_hyperelastic_options_init(&o);
  o.law = law;
  o.reduction = reduction;
  o.young = young;
  o.poisson = nu;
  o.density = 1.3;
  return o;
}

static sph_material *make(sph_context *ctx, int32_t law, int32_t reduction, double nu) {
  sph_hyperelastic_options o = options_of(law, reduction, nu);
  sph_material *m = NULL;
  check_ok(sph_material_create_hyperelastic(ctx, &o, &m));
  return m;
}

/* ---- the oracle ---- */

typedef long double real;
typedef struct oracle {
  int32_t law, reduction;
  double nu;
} oracle;

static real determinant(real f[3][3]) {
  return f[0][0] * (f[1][1] * f[2][2] - f[1][2] * f[2][1]) -
         f[0][1] * (f[1][0] * f[2][2] - f[1][2] * f[2][0]) +
         f[0][2] * (f[1][0] * f[2][1] - f[1][1] * f[2][0]);
}

static real stored_energy(const oracle *o, real f[3][3]) {
  real nu = o->nu, mu = young / (2 * (1 + nu)), lambda = young * nu / ((1 + nu) * (1 - 2 * nu));
  real trace = 0, square = 0, norm = 0, log_j = logl(determinant(f));
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) {
      real g = a == b ? -0.5L : 0;
      for (int c = 0; c < 3; c++) g += 0.5L * f[c][a] * f[c][b];
      if (a == b) trace += g;
      square += g * g;
      norm += f[a][b] * f[a][b];
    }
  if (o->law == SPH_ST_VENANT_KIRCHHOFF) return lambda / 2 * trace * trace + mu * square;
  return mu / 2 * (norm - 3) - mu * log_j + lambda / 2 * log_j * log_j;
}

/* with the stretch t in the directions across */
static real energy_at(const oracle *o, const real *f, real t) {
  real full[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  int32_t d = dim_of(o->reduction);
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++)
      if (a < d && b < d)
        full[a][b] = f[a * d + b];
      else if (a == b)
        full[a][b] = t;
  return stored_energy(o, full);
}

/* The stretch across where the energy is least: its slope changes sign. */
static real free_stretch(const oracle *o, const real *f) {
  real low = 0.05L, high = 8;
  if (o->reduction != SPH_PLANE_STRESS && o->reduction != SPH_UNIAXIAL_STRESS) return 1;
  for (int k = 0; k < 90; k++) {
    real t = 0.5L * (low + high), h = 1e-7L;
    if (energy_at(o, f, t + h) > energy_at(o, f, t - h))
      high = t;
    else
      low = t;
  }
  return low;
}

static real least_energy(const oracle *o, const real *f) {
  return energy_at(o, f, free_stretch(o, f));
}

static void random_gradient(int32_t d, double size, double *f) {
  for (int k = 0; k < d * d; k++) f[k] = (k % (d + 1) == 0) + size * random_signed();
}

static void check_against_energy(sph_context *ctx, const oracle *o, double size) {
  int32_t d = dim_of(o->reduction);
  sph_material *m = make(ctx, o->law, o->reduction, o->nu);
  for (int trial = 0; trial < 20; trial++) {
    double f[9], p[9], psi;
    real exact[9], h = 2e-5L;
    random_gradient(d, size, f);
    check_ok(sph_material_first_piola(m, d, 1, f, p, &psi));
    for (int k = 0; k < d * d; k++) exact[k] = f[k];
    check_close(psi, (double)least_energy(o, exact), 1e-12);
    real t = free_stretch(o, exact); /* P is the partial derivative there: the slope along t is 0 */
    for (int k = 0; k < d * d; k++) {
      real at = exact[k], difference;
      exact[k] = at + h;
      difference = energy_at(o, exact, t);
      exact[k] = at - h;
      difference -= energy_at(o, exact, t);
      exact[k] = at;
      check_close(p[k], (double)(difference / (2 * h)), 2e-8);
    }
  }
  sph_material_destroy(m);
}

static void test_energy_and_its_derivative(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  const double nus[] = {0.0, 0.3, 0.45, -0.3};
  for (int32_t law = SPH_ST_VENANT_KIRCHHOFF; law <= SPH_NEO_HOOKEAN; law++)
    for (int32_t reduction = SPH_UNIAXIAL_STRESS; reduction <= SPH_SOLID; reduction++)
      for (int k = 0; k < 4; k++) {
        const oracle o = {law, reduction, nus[k]};
        check_against_energy(ctx, &o, 0.25);
      }
  sph_context_destroy(ctx);
}

/* P = d psi/dF along a path: psi of the library alone, through its own Newton iteration. */
static void test_energy_is_the_work(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int32_t law = SPH_ST_VENANT_KIRCHHOFF; law <= SPH_NEO_HOOKEAN; law++)
    for (int32_t reduction = SPH_UNIAXIAL_STRESS; reduction <= SPH_SOLID; reduction++) {
      enum { STEPS = 400 };
      int32_t d = dim_of(reduction);
      sph_material *m = make(ctx, law, reduction, 0.35);
      double end[9], f[9], p[9], psi = 0, work = 0;
      random_gradient(d, 0.3, end);
      for (int step = 0; step <= STEPS; step++) { /* Simpson's rule from I to `end` */
        double s = (double)step / STEPS;
        double weight = step == 0 || step == STEPS ? 1 : step % 2 ? 4 : 2;
        for (int k = 0; k < d * d; k++)
          f[k] = (k % (d + 1) == 0) + s * (end[k] - (k % (d + 1) == 0));
        check_ok(sph_material_first_piola(m, d, 1, f, p, &psi));
        for (int k = 0; k < d * d; k++)
          work += weight / (3.0 * STEPS) * p[k] * (end[k] - (k % (d + 1) == 0));
      }
      check_close(psi, work, 1e-11);
      assert_true(psi > 0);
      sph_material_destroy(m);
    }
  sph_context_destroy(ctx);
}

static void multiply(int32_t d, const double *a, const double *b, double *out) {
  for (int i = 0; i < d; i++)
    for (int j = 0; j < d; j++) {
      out[i * d + j] = 0;
      for (int k = 0; k < d; k++) out[i * d + j] += a[i * d + k] * b[k * d + j];
    }
}

static void random_rotation(int32_t d, double *q) {
  double a = 3 * random_signed(), b = 3 * random_signed();
  if (d == 1) {
    q[0] = 1;
  } else if (d == 2) {
    const double r[4] = {cos(a), -sin(a), sin(a), cos(a)};
    memcpy(q, r, sizeof r);
  } else {
    const double z[9] = {cos(a), -sin(a), 0, sin(a), cos(a), 0, 0, 0, 1};
    const double x[9] = {1, 0, 0, 0, cos(b), -sin(b), 0, sin(b), cos(b)};
    multiply(3, z, x, q);
  }
}

/* P(QF) = Q P(F), psi(QF) = psi(F), sigma(QF) = Q sigma Q^T; isotropy: P(FQ) = P(F) Q. */
static void test_objectivity(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int32_t law = SPH_ST_VENANT_KIRCHHOFF; law <= SPH_NEO_HOOKEAN; law++)
    for (int32_t reduction = SPH_PLANE_STRESS; reduction <= SPH_SOLID; reduction++) {
      int32_t d = dim_of(reduction);
      sph_material *m = make(ctx, law, reduction, 0.3);
      for (int trial = 0; trial < 20; trial++) {
        double f[9], q[9], qf[9], fq[9], p[9], pqf[9], pfq[9], want[9], psi[3];
        random_gradient(d, 0.3, f);
        random_rotation(d, q);
        multiply(d, q, f, qf);
        multiply(d, f, q, fq);
        check_ok(sph_material_first_piola(m, d, 1, f, p, psi));
        check_ok(sph_material_first_piola(m, d, 1, qf, pqf, psi + 1));
        check_ok(sph_material_first_piola(m, d, 1, fq, pfq, psi + 2));
        check_close(psi[1], psi[0], 1e-14);
        check_close(psi[2], psi[0], 1e-14);
        multiply(d, q, p, want);
        for (int k = 0; k < d * d; k++) check_close(pqf[k], want[k], 1e-13);
        multiply(d, p, q, want);
        for (int k = 0; k < d * d; k++) check_close(pfq[k], want[k], 1e-13);
      }
      sph_material_destroy(m);
    }
  sph_context_destroy(ctx);
}

static void test_nothing_at_rest(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int32_t law = SPH_ST_VENANT_KIRCHHOFF; law <= SPH_NEO_HOOKEAN; law++)
    for (int32_t reduction = SPH_UNIAXIAL_STRESS; reduction <= SPH_SOLID; reduction++) {
      int32_t d = dim_of(reduction);
      sph_material *m = make(ctx, law, reduction, 0.37);
      double f[9], p[9], s[6], psi = 1;
      random_gradient(d, 0, f);
      check_ok(sph_material_first_piola(m, d, 1, f, p, &psi));
      check_ok(sph_material_cauchy_stress(m, d, 1, f, s));
      for (int k = 0; k < d * d; k++) assert_true(p[k] == 0);
      for (int k = 0; k < d * (d + 1) / 2; k++) assert_true(s[k] == 0);
      assert_true(psi == 0);
      sph_material_destroy(m);
    }
  sph_context_destroy(ctx);
}

/* Small strains: the laws differ from Hooke's by the square of the strain, and so do the energies
 * relative to theirs. */
static void test_hooke_is_the_limit(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  const double nu = 0.3;
  for (int32_t law = SPH_ST_VENANT_KIRCHHOFF; law <= SPH_NEO_HOOKEAN; law++)
    for (int32_t k = 0; k < 15; k++) {
      const double size = k < 5 ? 1e-3 : k < 10 ? 1e-6 : 1e-9;
      int32_t reduction = SPH_UNIAXIAL_STRESS + k % 5, d = dim_of(reduction);
      sph_material *m = make(ctx, law, reduction, nu), *linear = NULL;
      sph_hooke_options h;
      double f[9], p[9], s[6], want[9], cauchy[6], psi, half_work;
      sph_hooke_options_init(&h);
      h.young = young;
      h.poisson = nu;
      h.density = 1.3;
      h.reduction = reduction;
      check_ok(sph_material_create_hooke(ctx, &h, &linear));
      random_gradient(d, size, f);
      check_ok(sph_material_first_piola(m, d, 1, f, p, &psi));
      check_ok(sph_material_first_piola(linear, d, 1, f, want, &half_work));
      for (int c = 0; c < d * d; c++) check_close(p[c], want[c], 40 * size * size + 1e-15);
      check_rel(psi, half_work, 40 * size);
      check_ok(sph_material_cauchy_stress(m, d, 1, f, s));
      check_ok(sph_material_cauchy_stress(linear, d, 1, f, cauchy));
      for (int c = 0; c < d * (d + 1) / 2; c++)
        check_close(s[c], cauchy[c], 40 * size * size + 1e-15);
      sph_material_destroy(linear);
      sph_material_destroy(m);
    }
  sph_context_destroy(ctx);
}

/* sigma = P F^T / J with the J of the oracle's stretch across. */
static void test_cauchy(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  static const int row[] = {0, 1, 2, 0, 0, 1}, column[] = {0, 1, 2, 1, 2, 2};
  static const int packed[4][6] = {{0}, {0}, {0, 1, 3}, {0, 1, 2, 3, 4, 5}};
  for (int32_t law = SPH_ST_VENANT_KIRCHHOFF; law <= SPH_NEO_HOOKEAN; law++)
    for (int32_t reduction = SPH_UNIAXIAL_STRESS; reduction <= SPH_SOLID; reduction++) {
      const oracle o = {law, reduction, 0.3};
      int32_t d = dim_of(reduction);
      sph_material *m = make(ctx, law, reduction, 0.3);
      double f[9], p[9], s[6];
      real exact[9], full[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, t;
      random_gradient(d, 0.25, f);
      for (int k = 0; k < d * d; k++) exact[k] = f[k];
      t = free_stretch(&o, exact);
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) full[a][b] = a < d && b < d ? exact[a * d + b] : a == b ? t : 0;
      check_ok(sph_material_first_piola(m, d, 1, f, p, NULL));
      check_ok(sph_material_cauchy_stress(m, d, 1, f, s));
      for (int k = 0; k < d * (d + 1) / 2; k++) {
        real sum = 0;
        for (int c = 0; c < d; c++)
          sum += p[row[packed[d][k]] * d + c] * exact[column[packed[d][k]] * d + c];
        check_close(s[k], (double)(sum / determinant(full)), 1e-10);
      }
      sph_material_destroy(m);
    }
  sph_context_destroy(ctx);
}

/* A rubber strip in uniaxial tension, nearly incompressible: sigma = mu (s^2 - 1/s). */
static void test_nearly_incompressible_bar(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  const double nu = 0.4999999, mu = young / (2 * (1 + nu));
  sph_material *m = make(ctx, SPH_NEO_HOOKEAN, SPH_UNIAXIAL_STRESS, nu);
  for (double s = 0.2; s < 6; s *= 1.3) {
    double sigma;
    check_ok(sph_material_cauchy_stress(m, 1, 1, &s, &sigma));
    check_close(sigma, mu * (s * s - 1 / s), 1e-5 * young * (1 + s * s));
  }
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

/* Plane and uniaxial stress from nearly nothing to many times the length: P stays finite, and the
 * solid with that stretch across bears no stress there. */
static void test_extreme_stretches(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  const double nus[] = {0.0, 0.3, 0.499999, -0.5};
  for (int k = 0; k < 4; k++) {
    sph_material *strip = make(ctx, SPH_NEO_HOOKEAN, SPH_UNIAXIAL_STRESS, nus[k]);
    double last = -HUGE_VAL;
    for (double s = nus[k] < 0 ? 0.75 : 1e-12; s < 1e12; s *= 7) {
      double p;
      check_ok(sph_material_first_piola(strip, 1, 1, &s, &p, NULL));
      assert_true(isfinite(p));
      assert_true(p > last); /* convex in the stretch */
      last = p;
    }
    sph_material_destroy(strip);
  }
  sph_context_destroy(ctx);
}

static void test_out_of_range(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int32_t law = SPH_ST_VENANT_KIRCHHOFF; law <= SPH_NEO_HOOKEAN; law++)
    for (int32_t reduction = SPH_UNIAXIAL_STRESS; reduction <= SPH_SOLID; reduction++) {
      enum { N = 5 };
      const double bad[] = {0, -1, NAN, INFINITY};
      int32_t d = dim_of(reduction);
      sph_material *m = make(ctx, law, reduction, 0.3);
      double f[N * 9], p[N * 9], psi[N], s[N * 6];
      for (int k = 0; k < 4; k++) {
        for (int i = 0; i < N; i++) random_gradient(d, 0.1, f + i * d * d);
        for (int j = 0; j < N * 9; j++) p[j] = 5;
        for (int j = 0; j < N * 6; j++) s[j] = 5;
        for (int c = 0; c < d; c++) f[3 * d * d + c] = c == 0 ? bad[k] : 0;
        f[4 * d * d] = NAN; /* a later one: not named */
        psi[0] = 5;
        refused(ctx, sph_material_first_piola(m, d, N, f, p, psi), SPH_ERR_NUMERIC,
                "particle 3: det F");
        refused(ctx, sph_material_cauchy_stress(m, d, N, f, s), SPH_ERR_NUMERIC, "particle 3");
        for (int j = 0; j < N * 9; j++) assert_true(p[j] == 5);
        for (int j = 0; j < N * 6; j++) assert_true(s[j] == 5);
        assert_true(psi[0] == 5);
      }
      sph_material_destroy(m);
    }
  sph_context_destroy(ctx);
}

/* St. Venant-Kirchhoff: G_xx nu = 1/2 in the bar, at the stretch sqrt(1 + 1/nu), the sides meet.
 * Neo-Hookean with negative nu: a strong compression has no free thickness. */
static void test_no_thickness(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material *bar = make(ctx, SPH_ST_VENANT_KIRCHHOFF, SPH_UNIAXIAL_STRESS, 0.25);
  sph_material *plate = make(ctx, SPH_ST_VENANT_KIRCHHOFF, SPH_PLANE_STRESS, 0.25);
  sph_material *auxetic = make(ctx, SPH_NEO_HOOKEAN, SPH_UNIAXIAL_STRESS, -0.5);
  double p[4], limit = sqrt(5.0), below = limit * (1 - 1e-12), above = limit * (1 + 1e-12);
  check_ok(sph_material_first_piola(bar, 1, 1, &below, p, NULL));
  refused(ctx, sph_material_first_piola(bar, 1, 1, &above, p, NULL), SPH_ERR_NUMERIC,
          "particle 0: no thickness");
  /* plane: G_xx + G_yy = 3/2 */
  const double inside[4] = {1.58, 0, 0, 1.58}, outside[4] = {1.59, 0, 0, 1.59};
  check_ok(sph_material_first_piola(plate, 2, 1, inside, p, NULL));
  refused(ctx, sph_material_first_piola(plate, 2, 1, outside, p, NULL), SPH_ERR_NUMERIC,
          "no thickness");
  const double crushed = 1e-3, squeezed = 0.9;
  check_ok(sph_material_first_piola(auxetic, 1, 1, &squeezed, p, NULL));
  refused(ctx, sph_material_first_piola(auxetic, 1, 1, &crushed, p, NULL), SPH_ERR_NUMERIC,
          "no thickness");
  sph_material_destroy(bar);
  sph_material_destroy(plate);
  sph_material_destroy(auxetic);
  sph_context_destroy(ctx);
}

static void test_over_the_input_and_in_parts(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  enum { N = 40 };
  for (int32_t law = SPH_ST_VENANT_KIRCHHOFF; law <= SPH_NEO_HOOKEAN; law++)
    for (int32_t reduction = SPH_UNIAXIAL_STRESS; reduction <= SPH_SOLID; reduction++) {
      int32_t d = dim_of(reduction);
      sph_material *m = make(ctx, law, reduction, 0.3);
      double f[N * 9], whole[N * 9], parts[N * 9], psi[N], some[N];
      for (int i = 0; i < N; i++) random_gradient(d, 0.2, f + i * d * d);
      check_ok(sph_material_first_piola(m, d, N, f, whole, psi));
      for (int i = 0; i < N; i += 10)
        check_ok(
            sphi_material_first_piola_quiet(m, d, 10, f + i * d * d, parts + i * d * d, some + i));
      assert_memory_equal(whole, parts, sizeof *f * (size_t)(N * d * d));
      assert_memory_equal(psi, some, sizeof psi);
      check_ok(sph_material_first_piola(m, d, N, f, f, NULL));
      assert_memory_equal(whole, f, sizeof *f * (size_t)(N * d * d));
      sph_material_destroy(m);
    }
  sph_context_destroy(ctx);
}

/* A part that fails in a thread: the sentence, written afterwards, counts from the whole. */
static void test_explained_afterwards(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material *m = make(ctx, SPH_NEO_HOOKEAN, SPH_SOLID, 0.3);
  double f[3 * 9] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 0, -1}, p[27];
  check_status(sphi_material_first_piola_quiet(m, 3, 3, f, p, NULL), SPH_ERR_NUMERIC);
  assert_string_equal(sph_context_last_error(ctx), "");
  sph_material_block b = sphi_material_block_of_f(3, 3, f);
  refused(ctx, sphi_material_explain(m, SPHI_MATERIAL_FIRST_PIOLA, &b, 1000, SPH_ERR_NUMERIC),
          SPH_ERR_NUMERIC, "first_piola: particle 1001: det F = -1");
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

static void test_wave_speeds_at_rest(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int32_t law = SPH_ST_VENANT_KIRCHHOFF; law <= SPH_NEO_HOOKEAN; law++)
    for (int32_t reduction = SPH_UNIAXIAL_STRESS; reduction <= SPH_SOLID; reduction++) {
      int32_t d = dim_of(reduction);
      sph_material *m = make(ctx, law, reduction, 0.3);
      sph_material_block b;
      double f[9], step = 1e-6, p[2][9], c, shear;
      sph_material_block_init(&b);
      b.dim = d;
      b.n = 1;
      check_ok(sph_material_sound_speed(m, &b, &c));
      check_ok(sph_material_shear_speed(m, &b, &shear));
      for (int side = 0; side < 2; side++) { /* rho c^2 = d P_xx / d F_xx */
        random_gradient(d, 0, f);
        f[0] += side ? -step : step;
        check_ok(sph_material_first_piola(m, d, 1, f, p[side], NULL));
      }
      check_rel(1.3 * c * c, (p[0][0] - p[1][0]) / (2 * step), 1e-8);
      for (int side = 0; side < 2 && d > 1; side++) { /* rho c^2 = d P_xy / d F_xy */
        random_gradient(d, 0, f);
        f[1] += side ? -step : step;
        check_ok(sph_material_first_piola(m, d, 1, f, p[side], NULL));
      }
      if (d > 1) check_rel(1.3 * shear * shear, (p[0][1] - p[1][1]) / (2 * step), 1e-8);
      sph_material_destroy(m);
    }
  sph_context_destroy(ctx);
}

static void test_refusals(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material *m = (sph_material *)ctx;
  sph_hyperelastic_options o = options_of(3, SPH_SOLID, 0.3);
  double f[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, p[9];
  refused(ctx, sph_material_create_hyperelastic(ctx, &o, &m), SPH_ERR_ARG, "unknown law 3");
  assert_null(m);
  o = options_of(SPH_NEO_HOOKEAN, 9, 0.3);
  refused(ctx, sph_material_create_hyperelastic(ctx, &o, &m), SPH_ERR_ARG, "reduction 9");
  o = options_of(SPH_NEO_HOOKEAN, SPH_SOLID, 0.5);
  refused(ctx, sph_material_create_hyperelastic(ctx, &o, &m), SPH_ERR_ARG, "poisson");
  o = options_of(SPH_NEO_HOOKEAN, SPH_SOLID, 0.3);
  o.density = NAN;
  refused(ctx, sph_material_create_hyperelastic(ctx, &o, &m), SPH_ERR_ARG, "density");
  o.density = 1;
  o.young = -1;
  refused(ctx, sph_material_create_hyperelastic(ctx, &o, &m), SPH_ERR_ARG, "young");
  m = make(ctx, SPH_NEO_HOOKEAN, SPH_SOLID, 0.3);
  refused(ctx, sph_material_first_piola(m, 2, 1, f, p, NULL), SPH_ERR_ARG, "2-D");
  refused(ctx, sph_material_first_piola(m, 3, -1, f, p, NULL), SPH_ERR_ARG, "negative");
  refused(ctx, sph_material_first_piola(m, 3, 1, NULL, p, NULL), SPH_ERR_ARG,
          "deformation_gradient");
  refused(ctx, sph_material_first_piola(m, 3, 1, f, NULL, NULL), SPH_ERR_ARG, "output");
  check_ok(sph_material_first_piola(m, 3, 0, NULL, p, NULL));
  sph_material_block b = sphi_material_block_of_f(3, 1, f);
  refused(ctx, sph_material_stress_rate(m, &b, p), SPH_ERR_UNSUPPORTED, "stress_rate");
  refused(ctx, sph_material_pressure(m, &b, p), SPH_ERR_UNSUPPORTED, "pressure");
  refused(ctx, sph_material_small_strain_stress(m, &b, p), SPH_ERR_UNSUPPORTED, "small_strain");
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

/* ---- a host's own law ---- */

static int32_t spring(void *user, const sph_material_block *b, double *p, double *energy) {
  const double k = *(const double *)user;
  if (b->deformation_gradient == NULL) return -1;
  for (int64_t i = 0; i < b->n; i++) {
    double stretch = b->deformation_gradient[i];
    if (stretch <= 0) return stretch < 0 ? -1 : 1;
    p[i] = k * (stretch - 1);
    if (energy != NULL) energy[i] = 0.5 * k * (stretch - 1) * (stretch - 1);
  }
  return 0;
}

static void test_host_law(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material_functions f;
  sph_material *m = NULL;
  double k = 3, stretch[3] = {1, 2, 0.5}, p[3], psi[3];
  sph_material_functions_init(&f);
  f.first_piola = spring;
  check_ok(sph_material_create(ctx, &f, &k, &m));
  check_ok(sph_material_first_piola(m, 1, 3, stretch, p, psi));
  for (int i = 0; i < 3; i++) check_rel(p[i], 3 * (stretch[i] - 1), 1e-15);
  check_rel(psi[1], 1.5, 1e-15);
  check_ok(sph_material_first_piola(m, 1, 3, stretch, p, NULL));
  refused(ctx, sph_material_cauchy_stress(m, 1, 3, stretch, p), SPH_ERR_UNSUPPORTED, "cauchy");
  stretch[1] = 0;
  check_status(sph_material_first_piola(m, 1, 3, stretch, p, psi), SPH_RETRY);
  stretch[1] = -1;
  refused(ctx, sph_material_first_piola(m, 1, 3, stretch, p, psi), SPH_ERR_CALLBACK,
          "first_piola: the material's callback failed");
  refused(ctx, sph_material_first_piola(m, 1, 3, NULL, p, psi), SPH_ERR_ARG, "F is NULL");
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

static sph_status lives(sph_context *ctx, void *user) {
  sph_hyperelastic_options o = options_of(SPH_NEO_HOOKEAN, SPH_SOLID, 0.3);
  sph_material *m = NULL;
  (void)user;
  sph_status status = sph_material_create_hyperelastic(ctx, &o, &m);
  assert_true((status == SPH_OK) == (m != NULL));
  sph_material_destroy(m);
  return status;
}

static void test_out_of_memory(void **state) {
  (void)state;
  oom_sweep(lives, NULL);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_energy_and_its_derivative),
    cmocka_unit_test(test_energy_is_the_work),
    cmocka_unit_test(test_objectivity),
    cmocka_unit_test(test_nothing_at_rest),
    cmocka_unit_test(test_hooke_is_the_limit),
    cmocka_unit_test(test_cauchy),
    cmocka_unit_test(test_nearly_incompressible_bar),
    cmocka_unit_test(test_extreme_stretches),
    cmocka_unit_test(test_out_of_range),
    cmocka_unit_test(test_no_thickness),
    cmocka_unit_test(test_over_the_input_and_in_parts),
    cmocka_unit_test(test_explained_afterwards),
    cmocka_unit_test(test_wave_speeds_at_rest),
    cmocka_unit_test(test_refusals),
    cmocka_unit_test(test_host_law),
    cmocka_unit_test(test_out_of_memory),
};
SPH_TEST_MAIN(tests)
