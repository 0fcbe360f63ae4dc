/* Stress tensors: principal and equivalent stresses, exact rotation, the step with an exact
 * rotation beside the rate form in integrators. */
#include "../material_help.h"

static const double turn = 6.283185307179586477;

static sph_material *make_hooke(sph_context *ctx, int32_t reduction, int32_t jaumann) {
  sph_hooke_options o;
  sph_material *m = NULL;
  sph_hooke_options_init(&o);
  o.young = 2.0;
  o.poisson = 0.3;
  o.density = 1.0;
  o.reduction = reduction;
  o.jaumann = jaumann;
  check_ok(sph_material_create_hooke(ctx, &o, &m));
  return m;
}

static sph_material_block block(int32_t dim, int64_t n, const double *l) {
  sph_material_block b;
  sph_material_block_init(&b);
  b.dim = dim;
  b.n = n;
  b.velocity_gradient = l;
  return b;
}

static int32_t comps_of(int32_t dim) { return dim * (dim + 1) / 2; }

static void full(int32_t dim, const double *packed, double out[3][3]) {
  static const int row[] = {0, 1, 2, 0, 0, 1}, column[] = {0, 1, 2, 1, 2, 2};
  static const int at[4][6] = {{0}, {0}, {0, 1, 3}, {0, 1, 2, 3, 4, 5}};
  memset(out, 0, 9 * sizeof(double));
  for (int k = 0; k < comps_of(dim); k++)
    out[row[at[dim][k]]][column[at[dim][k]]] = out[column[at[dim][k]]][row[at[dim][k]]] = packed[k];
}

/* ---- principal and equivalent stresses ---- */

static void test_principal_stresses(void **state) {
  (void)state;
  enum { N = 50 };
  for (int32_t dim = 1; dim <= 3; dim++) {
    double s[N * 6], values[N * 3], v[N * 9];
    for (int k = 0; k < N * 6; k++) s[k] = 1e8 * random_signed();
    check_ok(sph_principal_stresses(dim, N, s, values, v));
    for (int i = 0; i < N; i++) {
      double m[3][3];
      full(dim, s + i * comps_of(dim), m);
      for (int k = 0; k < dim; k++) {
        const double *w = v + (i * dim + k) * dim;
        for (int a = 0; a < dim; a++) {
          double image = 0;
          for (int b = 0; b < dim; b++) image += m[a][b] * w[b];
          check_close(image, values[i * dim + k] * w[a], 1e-6);
        }
      }
    }
  }
}

/* Pure shear: tension and compression at 45 degrees. */
static void test_pure_shear(void **state) {
  (void)state;
  const double s[6] = {0, 0, 7, 0, 0, -7};
  double values[4], v[8];
  check_ok(sph_principal_stresses(2, 2, s, values, v));
  for (int i = 0; i < 2; i++) {
    check_rel(values[2 * i], 7, 1e-15);
    check_rel(values[2 * i + 1], -7, 1e-15);
    check_close(v[4 * i] * v[4 * i + 1], i == 0 ? 0.5 : -0.5, 1e-15);
  }
  check_ok(sph_principal_stresses(2, 2, s, values, NULL));
}

/* sqrt(3/2 s:s) of the full tensor */
static void test_equivalent_stress(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int trial = 0; trial < 40; trial++) {
      double s[6], across = random_signed(), m[3][3], sum = 0, got;
      for (int k = 0; k < 6; k++) s[k] = random_signed();
      full(dim, s, m);
      for (int a = dim; a < 3; a++) m[a][a] = trial % 2 ? across : 0;
      double mean = (m[0][0] + m[1][1] + m[2][2]) / 3;
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
          double deviator = m[a][b] - (a == b ? mean : 0);
          sum += deviator * deviator;
        }
      check_ok(sph_equivalent_stress(dim, 1, s, trial % 2 ? &across : NULL, &got));
      check_close(got, sqrt(1.5 * sum), 1e-14);
    }
}

/* ---- rotation ---- */

/* L of a rigid rotation about `axis` with angular velocity |axis|. */
static void spin_gradient(int32_t dim, const double axis[3], double *l) {
  const double w[3][3] = {{0, -axis[2], axis[1]}, {axis[2], 0, -axis[0]}, {-axis[1], axis[0], 0}};
  for (int a = 0; a < dim; a++)
    for (int b = 0; b < dim; b++) l[a * dim + b] = w[a][b];
}

/* R s R^T with R = exp(angle W) from its power series. */
static void turned(int32_t dim, const double axis[3], double angle, const double *s, double *out) {
  static const int row[] = {0, 1, 2, 0, 0, 1}, column[] = {0, 1, 2, 1, 2, 2};
  static const int at[4][6] = {{0}, {0}, {0, 1, 3}, {0, 1, 2, 3, 4, 5}};
  long double r[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, power[3][3], next[3][3];
  double l[9], m[3][3];
  spin_gradient(3, axis, l);
  memcpy(power, r, sizeof r);
  for (int term = 1; term < 60; term++) {
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) {
        next[a][b] = 0;
        for (int c = 0; c < 3; c++) next[a][b] += power[a][c] * l[c * 3 + b] * angle / term;
      }
    memcpy(power, next, sizeof next);
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) r[a][b] += power[a][b];
  }
  full(dim, s, m);
  for (int k = 0; k < comps_of(dim); k++) {
    long double sum = 0;
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) sum += r[row[at[dim][k]]][a] * m[a][b] * r[column[at[dim][k]]][b];
    out[k] = (double)sum;
  }
}

static void random_axis(int32_t dim, double axis[3]) {
  double norm;
  for (int k = 0; k < 3; k++) axis[k] = dim == 2 && k < 2 ? 0 : random_signed();
  norm = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  for (int k = 0; k < 3; k++) axis[k] /= norm;
}

static void test_rotation(void **state) {
  (void)state;
  for (int32_t dim = 2; dim <= 3; dim++)
    for (int trial = 0; trial < 30; trial++) {
      double axis[3], l[9], s[6], exponential[6], cayley[6], want[6];
      double angle = trial == 0 ? 1e-9 : trial == 1 ? turn : 3 * random_signed();
      random_axis(dim, axis);
      spin_gradient(dim, axis, l);
      for (int k = 0; k < dim * dim; k++) /* a stretching does not turn */
        if (k % (dim + 1) == 0) l[k] += random_signed();
      for (int k = 0; k < 6; k++) s[k] = exponential[k] = cayley[k] = random_signed();
      check_ok(sph_stress_rotate(dim, 1, l, angle, SPH_ROTATION_EXPONENTIAL, exponential));
      turned(dim, axis, angle, s, want);
      for (int k = 0; k < comps_of(dim); k++) check_close(exponential[k], want[k], 1e-14);
      check_ok(sph_stress_rotate(dim, 1, l, angle, SPH_ROTATION_CAYLEY, cayley));
      turned(dim, axis, 2 * atan(angle / 2), s, want);
      for (int k = 0; k < comps_of(dim); k++) check_close(cayley[k], want[k], 1e-14);
    }
}

/* One turn in a few or many steps: the same principal stresses, and with the exponential the same
 * stresses. */
static void test_one_turn(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  const int counts[] = {3, 100, 10000};
  for (int32_t reduction = SPH_PLANE_STRESS; reduction <= SPH_SOLID; reduction++)
    for (int c = 0; c < 3; c++)
      for (int32_t rotation = SPH_ROTATION_EXPONENTIAL; rotation <= SPH_ROTATION_CAYLEY;
           rotation++) {
        int32_t dim = reduction == SPH_SOLID ? 3 : 2;
        sph_material *m = make_hooke(ctx, reduction, 1);
        double axis[3], l[9], s[6], start[6], values[3], before[3];
        random_axis(dim, axis);
        spin_gradient(dim, axis, l);
        for (int k = 0; k < 6; k++) s[k] = start[k] = random_signed();
        sph_material_block b = block(dim, 1, l);
        for (int step = 0; step < counts[c]; step++)
          check_ok(sph_material_stress_update(m, &b, turn / counts[c], rotation, s, NULL));
        check_ok(sph_principal_stresses(dim, 1, start, before, NULL));
        check_ok(sph_principal_stresses(dim, 1, s, values, NULL));
        for (int k = 0; k < dim; k++) check_close(values[k], before[k], 1e-14 + 1e-15 * counts[c]);
        for (int k = 0; k < comps_of(dim) && rotation == SPH_ROTATION_EXPONENTIAL; k++)
          check_close(s[k], start[k], 1e-14 + 4e-15 * counts[c]);
        sph_material_destroy(m);
      }
  sph_context_destroy(ctx);
}

/* ---- the rate form in integrators, as documented at sph_stress_rotate() ---- */

static void rate_of(const sph_material *m, int32_t dim, const double *l, const double *s,
                    double *rate) {
  sph_material_block b = block(dim, 1, l);
  b.sigma = s;
  check_ok(sph_material_stress_rate(m, &b, rate));
}

/* stages 1: Euler, 2: midpoint, 4: Runge-Kutta */
static void rate_step(const sph_material *m, int32_t dim, const double *l, double dt, int stages,
                      double *s) {
  static const double at[5][4] = {{0}, {0}, {0, 0.5}, {0}, {0, 0.5, 0.5, 1}};
  static const double weight[5][4] = {{0}, {1}, {0, 1}, {0}, {1. / 6, 1. / 3, 1. / 3, 1. / 6}};
  double rate[6] = {0}, stage[6], sum[6];
  memcpy(sum, s, sizeof sum);
  for (int k = 0; k < stages; k++) {
    for (int c = 0; c < 6; c++) stage[c] = s[c] + dt * at[stages][k] * rate[c];
    rate_of(m, dim, l, stage, rate);
    for (int c = 0; c < 6; c++) sum[c] += dt * weight[stages][k] * rate[c];
  }
  memcpy(s, sum, sizeof sum);
}

/* Relative change of the difference of the principal stresses after one turn. */
static double change_of_a_turn(const sph_material *m, int stages, int steps) {
  const double axis[3] = {0, 0, 1};
  double l[4], s[6] = {3, -1, 0.5}, before[2], after[2];
  spin_gradient(2, axis, l);
  check_ok(sph_principal_stresses(2, 1, s, before, NULL));
  for (int k = 0; k < steps; k++) rate_step(m, 2, l, turn / steps, stages, s);
  check_ok(sph_principal_stresses(2, 1, s, after, NULL));
  return fabs((after[0] - after[1]) / (before[0] - before[1]) - 1);
}

static void test_rate_form_as_documented(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material *m = make_hooke(ctx, SPH_PLANE_STRESS, 1);
  check_rel(change_of_a_turn(m, 1, 10000), pow(turn, 2) * 2 / 1e4, 0.02);
  check_rel(change_of_a_turn(m, 2, 400), pow(turn, 4) * 2 / pow(400, 3), 0.02);
  check_rel(change_of_a_turn(m, 4, 100), pow(turn, 6) * 4 / 9 / pow(100, 5), 0.02);
  assert_true(change_of_a_turn(m, 4, 123) < 1e-6);
  assert_true(change_of_a_turn(m, 4, 121) > 1e-6);
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

/* ---- the step against the rate form ---- */

static double update_error(const sph_material *m, int32_t dim, const double *l, int steps,
                           const double *want) {
  double s[6] = {0.3, -0.2, 0.1, 0.2, -0.1, 0.4}, worst = 0;
  sph_material_block b = block(dim, 1, l);
  for (int k = 0; k < steps; k++)
    check_ok(sph_material_stress_update(m, &b, 1.0 / steps, SPH_ROTATION_EXPONENTIAL, s, NULL));
  for (int c = 0; c < comps_of(dim); c++) worst = fmax(worst, fabs(s[c] - want[c]));
  return worst;
}

/* Shearing with rotation and stretching: second order, to the solution of the rate form. */
static void test_update_is_of_second_order(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  const double plane[4] = {0.4, 1.7, -0.9, 0.1};
  const double space[9] = {0.4, 1.7, 0.3, -0.9, 0.1, 0.8, -0.2, 0.5, -0.6};
  for (int32_t reduction = SPH_PLANE_STRESS; reduction <= SPH_SOLID; reduction++) {
    int32_t dim = reduction == SPH_SOLID ? 3 : 2;
    const double *l = dim == 3 ? space : plane;
    sph_material *m = make_hooke(ctx, reduction, 1), *same = make_hooke(ctx, reduction, 0);
    double want[6] = {0.3, -0.2, 0.1, 0.2, -0.1, 0.4};
    for (int k = 0; k < 400; k++) rate_step(m, dim, l, 1.0 / 400, 4, want);
    double coarse = update_error(m, dim, l, 20, want), fine = update_error(m, dim, l, 40, want);
    check_close(log2(coarse / fine), 2, 0.05);
    assert_true(fine < 1e-3);
    assert_true(update_error(same, dim, l, 40, want) == fine); /* without the switch, too */
    sph_material_destroy(m);
    sph_material_destroy(same);
  }
  sph_context_destroy(ctx);
}

/* zz of plane strain is that of the solid that is held across; in 1-D likewise. */
static void test_across(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material *solid = make_hooke(ctx, SPH_SOLID, 1);
  for (int32_t reduction = SPH_UNIAXIAL_STRESS; reduction <= SPH_PLANE_STRAIN; reduction++) {
    int32_t dim = reduction <= SPH_UNIAXIAL_STRAIN ? 1 : 2;
    int held = reduction == SPH_UNIAXIAL_STRAIN || reduction == SPH_PLANE_STRAIN;
    sph_material *m = make_hooke(ctx, reduction, 1);
    double l[4] = {0.4, 0.7, -0.9, 0.1}, space[9] = {0}, s[6] = {0}, in3d[6] = {0}, zz = 0, rate;
    for (int a = 0; a < dim; a++)
      for (int b = 0; b < dim; b++) space[a * 3 + b] = l[a * dim + b];
    sph_material_block flat = block(dim, 1, l), deep = block(3, 1, space);
    check_ok(sph_material_stress_rate_across(m, &flat, &rate));
    for (int k = 0; k < 10; k++) {
      check_ok(sph_material_stress_update(m, &flat, 0.1, SPH_ROTATION_EXPONENTIAL, s, &zz));
      check_ok(sph_material_stress_update(solid, &deep, 0.1, SPH_ROTATION_EXPONENTIAL, in3d, NULL));
    }
    check_close(zz, held ? in3d[2] : 0, 1e-14);
    check_close(rate, zz, 1e-14);
    if (held) check_close(s[0], in3d[0], 1e-14);
    sph_material_destroy(m);
  }
  sph_material_block deep = block(3, 0, NULL);
  double out;
  refused(ctx, sph_material_stress_rate_across(solid, &deep, &out), SPH_ERR_UNSUPPORTED, "across");
  sph_material_destroy(solid);
  sph_context_destroy(ctx);
}

/* Runs of 64 meet: the same bits as one particle at a time. */
static void test_many_particles(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  enum { N = 150 };
  sph_material *m = make_hooke(ctx, SPH_PLANE_STRAIN, 1);
  double l[N * 4], together[N * 3], alone[N * 3], zz[N], zz_alone[N];
  for (int k = 0; k < N * 4; k++) l[k] = random_signed();
  for (int k = 0; k < N * 3; k++) together[k] = alone[k] = random_signed();
  for (int k = 0; k < N; k++) zz[k] = zz_alone[k] = random_signed();
  sph_material_block b = block(2, N, l);
  check_ok(sph_material_stress_update(m, &b, 0.3, SPH_ROTATION_CAYLEY, together, zz));
  for (int i = 0; i < N; i++) {
    sph_material_block one = block(2, 1, l + 4 * i);
    check_ok(
        sph_material_stress_update(m, &one, 0.3, SPH_ROTATION_CAYLEY, alone + 3 * i, zz_alone + i));
  }
  assert_memory_equal(together, alone, sizeof alone);
  assert_memory_equal(zz, zz_alone, sizeof zz);
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

static int32_t creep(void *user, const sph_material_block *b, double *rate) {
  if (b->sigma == NULL || b->e == NULL || b->velocity_gradient == NULL) return -1;
  for (int64_t i = 0; i < b->n; i++) {
    if (b->e[i] < 0) return *(const int32_t *)user;
    rate[i] = b->velocity_gradient[i] - b->e[i] * b->sigma[i];
  }
  return 0;
}

/* A host's law sees the present stress and the other arrays, shifted with the particles. */
static void test_host_law(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  enum { N = 100 };
  sph_material_functions f;
  sph_material *m = NULL;
  int32_t answer = 1;
  double l[N], e[N], s[N];
  sph_material_functions_init(&f);
  f.stress_rate = creep;
  check_ok(sph_material_create(ctx, &f, &answer, &m));
  for (int i = 0; i < N; i++) l[i] = i, e[i] = 0.01 * i, s[i] = 2;
  sph_material_block b = block(1, N, l);
  b.e = e;
  check_ok(sph_material_stress_update(m, &b, 0.5, SPH_ROTATION_EXPONENTIAL, s, NULL));
  for (int i = 0; i < N; i++) check_close(s[i], 2 + 0.5 * (i - 0.02 * i), 1e-13);
  e[80] = -1;
  check_status(sph_material_stress_update(m, &b, 0.5, SPH_ROTATION_EXPONENTIAL, s, NULL),
               SPH_RETRY);
  answer = -1;
  refused(ctx, sph_material_stress_update(m, &b, 0.5, SPH_ROTATION_EXPONENTIAL, s, NULL),
          SPH_ERR_CALLBACK, "stress_rate");
  check_status(sph_material_stress_update(m, &b, 0.5, SPH_ROTATION_EXPONENTIAL, s, e),
               SPH_ERR_UNSUPPORTED);
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

/* ---- present wave speeds of hyperelastic laws ---- */

/* d P_row / d F_at at the diagonal F with these stretches */
static double slope(const sph_material *m, int32_t dim, const double *stretches, int at) {
  double p[2][9], f[9] = {0}, step = 1e-5;
  for (int a = 0; a < dim; a++) f[a * (dim + 1)] = stretches[a];
  for (int side = 0; side < 2; side++) {
    double keep = f[at];
    f[at] += side ? -step : step;
    check_ok(sph_material_first_piola(m, dim, 1, f, p[side], NULL));
    f[at] = keep;
  }
  return (p[0][at] - p[1][at]) / (2 * step);
}

static void check_waves(const sph_material *m, int32_t dim, const double *stretches) {
  double longitudinal = 0, shear = 0, f[9] = {0}, c, c_shear;
  sph_material_block b = block(dim, 1, NULL);
  b.deformation_gradient = f;
  for (int a = 0; a < dim; a++) f[a * (dim + 1)] = stretches[a];
  for (int a = 0; a < dim; a++) {
    longitudinal = fmax(longitudinal, slope(m, dim, stretches, a * (dim + 1)));
    for (int k = 0; k < dim; k++)
      if (k != a) shear = fmax(shear, slope(m, dim, stretches, a * dim + k));
  }
  check_ok(sph_material_sound_speed(m, &b, &c));
  check_ok(sph_material_shear_speed(m, &b, &c_shear));
  check_rel(1.7 * c * c, fmax(longitudinal, shear), 1e-7);
  if (dim > 1) check_rel(1.7 * c_shear * c_shear, shear, 1e-7);
}

static void test_present_wave_speeds(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  const double states[][3] = {{1, 1, 1}, {1.3, 0.9, 0.8}, {0.8, 1.1, 1.2}, {1.2, 1.25, 1.3}};
  for (int32_t law = SPH_ST_VENANT_KIRCHHOFF; law <= SPH_NEO_HOOKEAN; law++)
    for (int32_t reduction = SPH_UNIAXIAL_STRESS; reduction <= SPH_SOLID; reduction++) {
      int32_t dim = reduction <= SPH_UNIAXIAL_STRAIN ? 1 : reduction <= SPH_PLANE_STRAIN ? 2 : 3;
      sph_hyperelastic_options o;
      sph_material *m = NULL;
      sph_hyperelastic_options_init(&o);
      o.law = law;
      o.reduction = reduction;
      o.young = 3;
      o.poisson = 0.3;
      o.density = 1.7;
      check_ok(sph_material_create_hyperelastic(ctx, &o, &m));
      for (int k = 0; k < 4; k++) check_waves(m, dim, states[k]);
      sph_material_destroy(m);
    }
  sph_context_destroy(ctx);
}

/* Turning the body or the axes changes no speed; a collapsed St. Venant-Kirchhoff bar has none. */
static void test_wave_speeds_and_rotation(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_hyperelastic_options o;
  sph_material *m = NULL, *bar = NULL;
  double f[2][4] = {{1.3, 0, 0, 0.8}, {0}}, c[2];
  sph_hyperelastic_options_init(&o);
  o.young = o.density = 1;
  o.poisson = 0.3;
  o.reduction = SPH_PLANE_STRAIN;
  check_ok(sph_material_create_hyperelastic(ctx, &o, &m));
  const double a = cos(0.7), b = sin(0.7), p = cos(2.0), q = sin(2.0); /* R1 F R2 */
  f[1][0] = a * 1.3 * p - b * 0.8 * q, f[1][1] = -a * 1.3 * q - b * 0.8 * p;
  f[1][2] = b * 1.3 * p + a * 0.8 * q, f[1][3] = -b * 1.3 * q + a * 0.8 * p;
  sph_material_block two = block(2, 2, NULL);
  two.deformation_gradient = f[0];
  check_ok(sph_material_sound_speed(m, &two, c));
  check_rel(c[0], c[1], 1e-14);
  o.law = SPH_ST_VENANT_KIRCHHOFF;
  o.reduction = SPH_UNIAXIAL_STRAIN;
  check_ok(sph_material_create_hyperelastic(ctx, &o, &bar));
  double crushed = 0.5;
  sph_material_block one = block(1, 1, NULL);
  one.deformation_gradient = &crushed;
  check_ok(sph_material_sound_speed(bar, &one, c));
  assert_true(c[0] == 0);
  crushed = -1;
  refused(ctx, sph_material_sound_speed(bar, &one, c), SPH_ERR_NUMERIC, "particle 0: det F = -1");
  sph_material_destroy(m);
  sph_material_destroy(bar);
  sph_context_destroy(ctx);
}

/* ---- refusals ---- */

static void test_refusals(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material *m = make_hooke(ctx, SPH_PLANE_STRAIN, 1);
  double s[6] = {1, 2, 3, 4, 5, 6}, l[9] = {0}, out[9];
  check_status(sph_principal_stresses(0, 1, s, out, NULL), SPH_ERR_ARG);
  check_status(sph_principal_stresses(4, 1, s, out, NULL), SPH_ERR_ARG);
  check_status(sph_principal_stresses(3, -1, s, out, NULL), SPH_ERR_ARG);
  check_ok(sph_principal_stresses(3, 0, s, out, NULL));
  check_status(sph_equivalent_stress(0, 1, s, NULL, out), SPH_ERR_ARG);
  check_status(sph_equivalent_stress(2, -1, s, NULL, out), SPH_ERR_ARG);
  check_status(sph_stress_rotate(2, 1, l, NAN, SPH_ROTATION_CAYLEY, s), SPH_ERR_ARG);
  check_status(sph_stress_rotate(2, 1, l, 1, 3, s), SPH_ERR_ARG);
  check_status(sph_stress_rotate(4, 1, l, 1, SPH_ROTATION_CAYLEY, s), SPH_ERR_ARG);
  check_status(sph_stress_rotate(2, -1, l, 1, SPH_ROTATION_CAYLEY, s), SPH_ERR_ARG);
  sph_material_block b = block(2, 1, l), none = block(2, 1, NULL);
  const int32_t cayley = SPH_ROTATION_CAYLEY;
  refused(ctx, sph_material_stress_update(m, &b, INFINITY, cayley, s, NULL), SPH_ERR_ARG, "inf");
  refused(ctx, sph_material_stress_update(m, &b, 1, 0, s, NULL), SPH_ERR_ARG, "rotation 0");
  refused(ctx, sph_material_stress_update(m, &none, 1, cayley, s, NULL), SPH_ERR_ARG, "gradient");
  b.dim = 3;
  refused(ctx, sph_material_stress_update(m, &b, 1, cayley, s, NULL), SPH_ERR_ARG, "3-D");
  b.dim = 2;
  b.n = -1;
  refused(ctx, sph_material_stress_update(m, &b, 1, cayley, s, NULL), SPH_ERR_ARG, "negative");
  b.n = 0;
  check_ok(sph_material_stress_update(m, &b, 1, cayley, s, NULL));
  for (int k = 0; k < 6; k++) assert_true(s[k] == k + 1);
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_principal_stresses),
    cmocka_unit_test(test_pure_shear),
    cmocka_unit_test(test_equivalent_stress),
    cmocka_unit_test(test_rotation),
    cmocka_unit_test(test_one_turn),
    cmocka_unit_test(test_rate_form_as_documented),
    cmocka_unit_test(test_update_is_of_second_order),
    cmocka_unit_test(test_across),
    cmocka_unit_test(test_many_particles),
    cmocka_unit_test(test_host_law),
    cmocka_unit_test(test_present_wave_speeds),
    cmocka_unit_test(test_wave_speeds_and_rotation),
    cmocka_unit_test(test_refusals),
};
SPH_TEST_MAIN(tests)
