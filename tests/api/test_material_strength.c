/* Strength on top of an equation of state: the deviatoric rate and its limit, the return to the
 * yield stress, wave speeds, what comes from below, references. */
#include "../eos_help.h"
#include "../oom.h"
#include "../tensor_help.h"

static int32_t fluid_pressure(void *user, const sph_material_block *b, double *p) {
  (void)user;
  for (int64_t i = 0; i < b->n; i++) p[i] = 4 * (b->rho[i] - 1);
  return 0;
}
static int32_t fluid_speed(void *user, const sph_material_block *b, double *c) {
  (void)user;
  for (int64_t i = 0; i < b->n; i++) c[i] = 2;
  return 0;
}
static void count_destroy(void *user) { ++*(int *)user; }

static sph_status make_fluid(sph_context *ctx, int *destroyed, sph_material **out) {
  sph_material_functions f;
  sph_material_functions_init(&f);
  f.pressure = fluid_pressure;
  f.sound_speed = fluid_speed;
  f.destroy = count_destroy;
  return sph_material_create(ctx, &f, destroyed, out);
}

static sph_strength_options strength_options(double y) {
  sph_strength_options o;
  sph_strength_options_init(&o);
  o.shear = 1.5;
  o.yield = y;
  return o;
}

static sph_material *make_strength(sph_context *ctx, const sph_strength_options *o) {
  static int ignored;
  sph_material *fluid = NULL, *m = NULL;
  check_ok(make_fluid(ctx, &ignored, &fluid));
  check_ok(sph_material_create_strength(ctx, fluid, o, &m));
  sph_material_destroy(fluid);
  return m;
}

/* The figures at sph_material_create_strength(): q = 4.99 and Y = 1.70. */
static void test_strength_return(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_strength_options o = strength_options(1.70);
  sph_material *m = make_strength(ctx, &o);
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int trial = 0; trial < 20; trial++) {
      double s[6], old[6], work = 0, strain = 0;
      tensor t;
      for (int k = 0; k < 6; k++) s[k] = random_signed();
      if (dim == 3) s[2] = -s[0] - s[1];
      full(dim, s, 0, t);
      if (dim == 1) t[1][1] = t[2][2] = -0.5L * s[0];
      if (dim == 2) t[2][2] = -(real)s[0] - s[1];
      double scale = 4.99 / (double)equivalent(t);
      for (int k = 0; k < 6; k++) old[k] = s[k] *= scale;
      check_ok(sph_material_plastic_return(m, dim, 1, s, NULL, &strain, &work));
      for (int k = 0; k < dim * (dim + 1) / 2; k++) check_close(s[k], old[k] * 1.70 / 4.99, 1e-14);
      check_rel(strain, (4.99 - 1.70) / 4.5, 1e-13);
      check_rel(work, 1.70 * strain, 1e-13);
    }
  check_close(4.99 * pow(1.70 / 4.99, 2), 0.58, 0.005); /* the factor without its root */
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

static void test_strength_rate(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int by_dim = 0; by_dim < 2; by_dim++)
    for (int32_t dim = 1; dim <= 3; dim++) {
      sph_strength_options o = strength_options(INFINITY);
      o.trace_by_dim = by_dim;
      sph_material *m = make_strength(ctx, &o);
      double l[9], s[6] = {0}, rate[6], rho = 1.2, c, shear;
      real d[3][3] = {{0}}, trace = 0;
      sph_material_block b;
      for (int k = 0; k < 9; k++) l[k] = random_signed();
      for (int k = 0; k < 6; k++) s[k] = random_signed();
      sph_material_block_init(&b);
      b.dim = dim;
      b.n = 1;
      b.velocity_gradient = l;
      b.sigma = s;
      b.rho = &rho;
      check_ok(sph_material_stress_rate(m, &b, rate));
      for (int a = 0; a < dim; a++) trace += l[a * dim + a];
      for (int k = 0; k < dim * (dim + 1) / 2; k++) {
        int a = row[packed[dim][k]], e = column[packed[dim][k]];
        d[a][e] =
            0.5L * (l[a * dim + e] + l[e * dim + a]) - (a == e ? trace / (by_dim ? dim : 3) : 0);
        real want = 2 * 1.5L * d[a][e];
        for (int q = 0; q < dim; q++) { /* omega s - s omega */
          tensor full_s;
          full(dim, s, 0, full_s);
          want += 0.5L * ((real)l[a * dim + q] - l[q * dim + a]) * full_s[q][e];
          want -= full_s[a][q] * 0.5L * ((real)l[q * dim + e] - l[e * dim + q]);
        }
        check_close(rate[k], (double)want, 1e-14);
      }
      check_ok(sph_material_sound_speed(m, &b, &c));
      check_rel(c * c, 4 + 2 * 1.5 * (1 - (by_dim ? 1.0 / dim : 1.0 / 3)) / 1.2, 1e-14);
      check_ok(sph_material_shear_speed(m, &b, &shear));
      check_rel(shear * shear, 1.5 / 1.2, 1e-14);
      check_ok(sph_material_pressure(m, &b, &c));
      check_rel(c, 0.8, 1e-14);
      refused(ctx, sph_material_temperature(m, &b, &c), SPH_ERR_UNSUPPORTED, "temperature");
      rho = 0;
      refused(ctx, sph_material_sound_speed(m, &b, &c), SPH_ERR_NUMERIC,
              "particle 0: density 0 is not positive");
      refused(ctx, sph_material_shear_speed(m, &b, &c), SPH_ERR_NUMERIC, "density");
      sph_material_destroy(m);
    }
  sph_context_destroy(ctx);
}

/* Stretched and sheared far beyond yielding: the limited rate with small Euler steps, and the
 * return after steps of the free rate, end at the same stress, q = Y. */
static void follow(const sph_material *m, int32_t dim, int steps, int returns, double *s) {
  const double motion[9] = {0.5, 1.0, 0.2, -0.3, -0.2, 0.4, 0.6, 0, -0.1};
  double l[9], rate[6];
  sph_material_block b;
  for (int k = 0; k < dim * dim; k++) l[k] = motion[k];
  sph_material_block_init(&b);
  b.dim = dim;
  b.n = 1;
  b.velocity_gradient = l;
  b.sigma = s;
  for (int k = 0; k < steps; k++) {
    check_ok(sph_material_stress_rate(m, &b, rate));
    for (int c = 0; c < dim * (dim + 1) / 2; c++) s[c] += rate[c] / steps;
    if (returns) check_ok(sph_material_plastic_return(m, dim, 1, s, NULL, NULL, NULL));
  }
}

static void test_limited_rate(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int32_t dim = 1; dim <= 3; dim++) {
    sph_strength_options o = strength_options(0.25);
    sph_material *plain = make_strength(ctx, &o);
    o.limit_rate = 1;
    sph_material *limited = make_strength(ctx, &o);
    double returned[6] = {0}, rated[6] = {0};
    follow(plain, dim, 20000, 1, returned);
    follow(limited, dim, 20000, 0, rated);
    for (int c = 0; c < dim * (dim + 1) / 2; c++) check_close(rated[c], returned[c], 1e-3 * 0.25);
    tensor t;
    full(dim, rated, 0, t);
    if (dim == 1) t[1][1] = t[2][2] = -0.5L * rated[0];
    if (dim == 2) t[2][2] = -(real)rated[0] - rated[1];
    check_rel((double)equivalent(t), 0.25, 1e-3);
    double over[6]; /* the rate over the array of the stress */
    double l[9] = {1, 2, 0, 0, -1, 0, 0, 0, 0.5}, want[6];
    memcpy(over, rated, sizeof over);
    sph_material_block b;
    sph_material_block_init(&b);
    b.dim = dim;
    b.n = 1;
    b.velocity_gradient = l;
    b.sigma = over;
    check_ok(sph_material_stress_rate(limited, &b, want));
    check_ok(sph_material_stress_rate(limited, &b, over));
    for (int c = 0; c < dim * (dim + 1) / 2; c++) assert_true(over[c] == want[c]);
    sph_material_destroy(plain);
    sph_material_destroy(limited);
  }
  sph_context_destroy(ctx);
}

static void test_references(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  int destroyed = 0;
  sph_material *fluid = NULL, *m = NULL;
  sph_strength_options o = strength_options(1);
  check_ok(make_fluid(ctx, &destroyed, &fluid));
  check_ok(sph_material_create_strength(ctx, fluid, &o, &m));
  sph_material_destroy(fluid);
  assert_int_equal(destroyed, 0);
  sph_material_destroy(m);
  assert_int_equal(destroyed, 1);
  sph_context_destroy(ctx);
}

/* Strength on top of a metal: everything else comes from below. */
static void test_metal_with_strength(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_mie_gruneisen_options o;
  sph_strength_options s;
  sph_material *eos = NULL, *metal = NULL;
  sph_mie_gruneisen_options_init(&o);
  sph_strength_options_init(&s);
  check_ok(sph_mie_gruneisen_constants(SPH_ALUMINIUM_2024, &o, &s));
  assert_true(s.shear == 27.1e9 && s.yield == 0.265e9);
  check_ok(sph_material_create_mie_gruneisen(ctx, &o, &eos));
  check_ok(sph_material_create_strength(ctx, eos, &s, &metal));
  double rho = 3000, e = 1e6, a, c, p = pressure(eos, rho, e), out;
  assert_true(pressure(metal, rho, e) == p);
  check_rel(energy(metal, rho, p), e, 1e-12);
  derivatives(metal, rho, e, &a, &c);
  assert_true(a > 0 && c > 0);
  check_rel(sound(metal, rho, e), sqrt(pow(sound(eos, rho, e), 2) + 4 * 27.1e9 / (3 * rho)), 1e-14);
  rho = -1;
  sph_material_block b = block(1, &rho, &e);
  refused(ctx, sph_material_pressure(metal, &b, &out), SPH_ERR_NUMERIC, "particle 0: density -1");
  b.e = NULL;
  refused(ctx, sph_material_pressure(metal, &b, &out), SPH_ERR_ARG, "needs e");
  sph_material_destroy(eos);
  sph_material_destroy(metal);
  sph_context_destroy(ctx);
}

static void test_strength_refusals(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material *fluid = NULL, *hooke = NULL, *m = NULL;
  sph_hooke_options h;
  int destroyed = 0;
  double s[6] = {0};
  sph_hooke_options_init(&h);
  h.young = h.density = 1;
  check_ok(sph_material_create_hooke(ctx, &h, &hooke));
  check_ok(make_fluid(ctx, &destroyed, &fluid));
  sph_strength_options o = strength_options(1);
  refused(ctx, sph_material_create_strength(ctx, hooke, &o, &m), SPH_ERR_ARG, "no pressure");
  o.shear = 0;
  refused(ctx, sph_material_create_strength(ctx, fluid, &o, &m), SPH_ERR_ARG, "shear");
  o = strength_options(0);
  refused(ctx, sph_material_create_strength(ctx, fluid, &o, &m), SPH_ERR_ARG, "yield");
  o = strength_options(1);
  o.hardening = 1;
  o.limit_rate = 1;
  refused(ctx, sph_material_create_strength(ctx, fluid, &o, &m), SPH_ERR_ARG, "limit_rate");
  o.hardening = -1;
  refused(ctx, sph_material_create_strength(ctx, fluid, &o, &m), SPH_ERR_ARG, "hardening");
  assert_null(m);
  refused(ctx, sph_material_plastic_return(fluid, 3, 1, s, NULL, NULL, NULL), SPH_ERR_UNSUPPORTED,
          "plastic_return");
  sph_material_destroy(fluid);
  assert_int_equal(destroyed, 1); /* a failed creation keeps no reference */
  sph_material_destroy(hooke);
  sph_context_destroy(ctx);
}

static sph_status lives(sph_context *ctx, void *user) {
  int destroyed = 0;
  sph_material *fluid = NULL, *m = NULL;
  sph_strength_options o = strength_options(1);
  (void)user;
  sph_status status = make_fluid(ctx, &destroyed, &fluid);
  if (status == SPH_OK) status = sph_material_create_strength(ctx, fluid, &o, &m);
  sph_material_destroy(m);
  assert_int_equal(destroyed, 0);
  sph_material_destroy(fluid);
  return status;
}

static void test_out_of_memory(void **state) {
  (void)state;
  oom_sweep(lives, NULL);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_strength_return),     cmocka_unit_test(test_strength_rate),
    cmocka_unit_test(test_limited_rate),        cmocka_unit_test(test_references),
    cmocka_unit_test(test_metal_with_strength), cmocka_unit_test(test_strength_refusals),
    cmocka_unit_test(test_out_of_memory),
};
SPH_TEST_MAIN(tests)
