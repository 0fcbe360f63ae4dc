/* Equations of state: derivatives by differences, sound speeds along isentropes that are integrated
 * step by step, inverses, gases and barotropic fluids, ranges, refusals. */
#include "../eos_help.h"
#include "../oom.h"
#include "../rhs_help.h"

/* ---- the laws, and a range of states each ---- */

enum { LAWS = 13 };
typedef struct law {
  sph_material *m;
  double rho[2], e[2]; /* ranges without kinks */
  int barotropic;
} law;

static law law_of(sph_context *ctx, int k) {
  const double al = 2700;
  switch (k) {
  case 0:
    return (law){gas(ctx, 1.4, 0, 0), {0.1, 3}, {0.5, 4}, 0};
  case 1:
    return (law){gas(ctx, 4.4, 0.6, 0), {0.7, 2}, {1, 4}, 0};
  case 2:
    return (law){barotropic(ctx, 1, 0), {900, 1100}, {0, 1}, 1};
  case 3:
    return (law){barotropic(ctx, 7, 1e5), {900, 1100}, {0, 1}, 1};
  case 4:
    return (law){barotropic(ctx, 1.4, 0), {300, 2000}, {0, 1}, 1};
  case 5:
    return (law){
        gruneisen(ctx, SPH_ALUMINIUM_2024, SPH_HUGONIOT_CUBIC, 0), {2800, 4000}, {0, 5e6}, 0};
  case 6:
    return (law){gruneisen(ctx, SPH_LEAD, SPH_HUGONIOT, 0), {11400, 17000}, {0, 2e6}, 0};
  case 7:
    return (law){gruneisen(ctx, SPH_COPPER, SPH_COLD_CUBIC, 0), {8500, 12000}, {0, 3e6}, 0};
  case 8:
    return (law){gruneisen(ctx, SPH_EPOXY, SPH_HUGONIOT_CUBIC, 0), {2000, 2270}, {0, 1e6}, 0};
  case 9: /* compressed */
    return (law){tillotson(ctx, SPH_TILLOTSON_ALUMINIUM, 0), {al * 1.01, al * 2}, {-1e5, 3e7}, 0};
  case 10: /* tension */
    return (law){tillotson(ctx, SPH_TILLOTSON_ALUMINIUM, 0), {al * 0.8, al * 0.99}, {0, 2.9e6}, 0};
  case 11: /* partly vaporised */
    return (law){tillotson(ctx, SPH_TILLOTSON_ALUMINIUM, 0), {al * 0.5, al * 0.9}, {4e6, 1.3e7}, 0};
  default: /* vapour */
    return (law){
        tillotson(ctx, SPH_TILLOTSON_ALUMINIUM, 0), {al * 0.05, al * 0.9}, {1.5e7, 4e7}, 0};
  }
}

/* Central differences, extrapolated once. */
static void test_derivatives(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int k = 0; k < LAWS; k++) {
    law l = law_of(ctx, k);
    for (int trial = 0; trial < 40; trial++) {
      double rho = random_in(l.rho[0], l.rho[1]), e = random_in(l.e[0], l.e[1]), by_rho, by_e;
      double d[2][2], h[2] = {1e-4 * rho, 1e-4 * (l.e[1] - l.e[0])};
      for (int half = 0; half < 2; half++) {
        double s = half ? 0.5 : 1;
        d[half][0] =
            (pressure(l.m, rho + s * h[0], e) - pressure(l.m, rho - s * h[0], e)) / (2 * s * h[0]);
        d[half][1] =
            (pressure(l.m, rho, e + s * h[1]) - pressure(l.m, rho, e - s * h[1])) / (2 * s * h[1]);
      }
      derivatives(l.m, rho, e, &by_rho, &by_e);
      double scale = fabs(pressure(l.m, rho, e)) + rho * fabs(by_rho);
      check_close(by_rho * rho, (4 * d[1][0] - d[0][0]) / 3 * rho, 1e-10 * scale);
      if (l.barotropic)
        assert_true(by_e == 0);
      else
        check_close(by_e * l.e[1], (4 * d[1][1] - d[0][1]) / 3 * l.e[1],
                    1e-10 * (scale + fabs(by_e * l.e[1])));
      double alone;
      sph_material_block b = block(1, &rho, &e);
      check_ok(sph_material_pressure_derivatives(l.m, &b, NULL, &alone));
      assert_true(alone == by_e);
      check_ok(sph_material_pressure_derivatives(l.m, &b, &alone, NULL));
      assert_true(alone == by_rho);
    }
    sph_material_destroy(l.m);
  }
  sph_context_destroy(ctx);
}

/* e at rho + d on the isentrope de/drho = p/rho^2, by the classical Runge-Kutta method. */
static double isentrope(const sph_material *m, double rho, double e, double d) {
  double k1 = pressure(m, rho, e) / (rho * rho), mid = rho + d / 2, end = rho + d;
  double k2 = pressure(m, mid, e + d / 2 * k1) / (mid * mid);
  double k3 = pressure(m, mid, e + d / 2 * k2) / (mid * mid);
  double k4 = pressure(m, end, e + d * k3) / (end * end);
  return e + d / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
}

static void test_sound_speed_along_isentropes(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int k = 0; k < LAWS; k++) {
    law l = law_of(ctx, k);
    for (int trial = 0; trial < 40; trial++) {
      double rho = random_in(l.rho[0], l.rho[1]), e = random_in(l.e[0], l.e[1]), d = 1e-4 * rho;
      double up = pressure(l.m, rho + d, isentrope(l.m, rho, e, d));
      double down = pressure(l.m, rho - d, isentrope(l.m, rho, e, -d));
      double c = sound(l.m, rho, e), want = (up - down) / (2 * d);
      double scale = fabs(want) + fabs(pressure(l.m, rho, e)) / rho;
      check_close(c * c, fmax(want, 0), 2e-6 * scale); /* no floor: 0 where it is unstable */
    }
    sph_material_destroy(l.m);
  }
  sph_context_destroy(ctx);
}

/* e -> p -> e, and p -> e -> p where several energies may give p. */
static void test_energy_inverts_pressure(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int k = 0; k < LAWS; k++) {
    law l = law_of(ctx, k);
    for (int trial = 0; trial < 40 && !l.barotropic; trial++) {
      double rho = random_in(l.rho[0], l.rho[1]), e = random_in(l.e[0], l.e[1]), by_e;
      double p = pressure(l.m, rho, e), back = energy(l.m, rho, p);
      derivatives(l.m, rho, e, NULL, &by_e);
      check_close(pressure(l.m, rho, back), p,
                  1e-12 * (fabs(p) + by_e * l.e[1]) + 1e-9 * (k == 11) * fabs(p));
      if (k != 11) check_close(back, e, 1e-11 * l.e[1]);
    }
    sph_material_destroy(l.m);
  }
  sph_context_destroy(ctx);
}

/* ---- gases and barotropic fluids ---- */

static void test_published_gas_states(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material *liquid = gas(ctx, 4.4, 0.6, 0), *air = gas(ctx, 1.4, 0, 718);
  /* the liquid-gas tube of Zisis 5.2.3 */
  check_rel(energy(liquid, 0.809341, 0.0308105), 0.970583, 2e-6);
  check_rel(energy(air, 0.107291, 0.0308105), 0.717919, 1e-5);
  check_rel(sound(air, 1.4, 1 / (0.4 * 1.4)), 1, 1e-15); /* air of 5.5: c = 1 */
  double rho = 1, e = 718 * 300, t;
  sph_material_block b = block(1, &rho, &e);
  check_ok(sph_material_temperature(air, &b, &t));
  check_rel(t, 300, 1e-15);
  refused(ctx, sph_material_temperature(liquid, &b, &t), SPH_ERR_UNSUPPORTED, "temperature");
  sph_material_destroy(air);
  sph_material_destroy(liquid);
  sph_context_destroy(ctx);
}

/* T ds = de + p d(1/rho) is an exact differential with T = (e - P_ref/rho)/c_v: along an isentrope
 * T ~ rho^(gamma-1). */
static void test_stiffened_temperature(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material *m = gas(ctx, 4.4, 0.6, 2);
  double rho = 1, e = 1.5, t[2];
  sph_material_block b = block(1, &rho, &e);
  check_ok(sph_material_temperature(m, &b, t));
  for (int k = 0; k < 1000; k++) {
    e = isentrope(m, rho, e, 2e-4);
    rho += 2e-4;
  }
  check_ok(sph_material_temperature(m, &b, t + 1));
  check_rel(t[1] / t[0], pow(1.2, 3.4), 1e-10);
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

static void test_cold_and_forbidden_gas(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material *ideal = gas(ctx, 5. / 3, 0, 0), *stiff = gas(ctx, 4.4, 0.6, 0);
  double rho[3] = {1, 2, 3}, e[3] = {1, 0, -1e-300}, out[3] = {7, 7, 7}, p[3] = {1, 0, -1};
  assert_true(pressure(ideal, 1, 0) == 0 && sound(ideal, 1, 0) == 0);
  check_close(pressure(stiff, 2, 0.3), -0.6, 1e-15);
  check_close(sound(stiff, 2, 0.3), 0, 1e-7);
  sph_material_block b = block(3, rho, e);
  b.p = p;
  refused(ctx, sph_material_pressure(ideal, &b, out), SPH_ERR_NUMERIC,
          "pressure: particle 2: energy -1e-300 is below 0");
  refused(ctx, sph_material_sound_speed(ideal, &b, out), SPH_ERR_NUMERIC, "particle 2: energy");
  refused(ctx, sph_material_pressure_derivatives(ideal, &b, out, NULL), SPH_ERR_NUMERIC,
          "particle 2: energy");
  refused(ctx, sph_material_energy(ideal, &b, out), SPH_ERR_NUMERIC, "particle 2: pressure -1");
  refused(ctx, sph_material_pressure(stiff, &b, out), SPH_ERR_NUMERIC, "particle 1: energy 0");
  for (int k = 0; k < 3; k++) assert_true(out[k] == 7);
  sph_material_destroy(ideal);
  sph_material_destroy(stiff);
  sph_context_destroy(ctx);
}

static void test_barotropic(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material *linear = barotropic(ctx, 1, 0), *tait = barotropic(ctx, 7, 0), *raised;
  const double b = 1000 * 900.0 / 7;
  for (int trial = 0; trial < 20; trial++) {
    double rho = random_in(500, 1500), x = rho / 1000;
    check_close(pressure(linear, rho, NAN), 900 * (rho - 1000), 1e-9);
    check_close(pressure(tait, rho, NAN), b * (pow(x, 7) - 1), 1e-13 * b * (1 + pow(x, 7)));
    check_rel(sound(tait, rho, 0), 30 * pow(x, 3), 1e-14);
    check_rel(sound(linear, rho, 0), 30, 1e-14);
  }
  check_rel(pressure(tait, 1000 * (1 + 1e-12), 0), 900 * (1000 * (1 + 1e-12) - 1000), 1e-10);
  assert_true(pressure(tait, 1000, 0) == 0);
  raised = barotropic(ctx, 1.4, 1000 * 900.0 / 1.4); /* the polytrope */
  check_rel(pressure(raised, 1700, 0), 1000 * 900.0 / 1.4 * pow(1.7, 1.4), 1e-14);
  sph_material *all[3] = {linear, tait, raised};
  for (int k = 0; k < 3; k++) { /* energy: 0 at rho0, de/drho = p/rho^2 */
    double h = 1e-2, rho = 1100, other = 900;
    double slope = (energy(all[k], rho + h, NAN) - energy(all[k], rho - h, NAN)) / (2 * h);
    check_rel(slope, pressure(all[k], rho, 0) / (rho * rho), 1e-7);
    slope = (energy(all[k], other + h, NAN) - energy(all[k], other - h, NAN)) / (2 * h);
    check_rel(slope, pressure(all[k], other, 0) / (other * other), 1e-7);
    assert_true(energy(all[k], 1000, 0) == 0);
    sph_material_destroy(all[k]);
  }
  sph_context_destroy(ctx);
}

/* ---- all of them ---- */

static void test_bad_states(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  const double bad[] = {0, -1, NAN, INFINITY};
  for (int k = 0; k < LAWS; k++) {
    law l = law_of(ctx, k);
    double rho[4], e[4], p[4] = {1, 1, 1, 1}, out[4] = {7, 7, 7, 7};
    sph_material_block b = block(4, rho, e);
    b.p = p;
    for (int trial = 0; trial < 4; trial++) {
      for (int i = 0; i < 4; i++) rho[i] = 0.5 * (l.rho[0] + l.rho[1]), e[i] = l.e[1];
      rho[2] = bad[trial];
      rho[3] = -5; /* not the first */
      refused(ctx, sph_material_pressure(l.m, &b, out), SPH_ERR_NUMERIC, "particle 2: density");
      refused(ctx, sph_material_sound_speed(l.m, &b, out), SPH_ERR_NUMERIC, "particle 2: density");
      refused(ctx, sph_material_energy(l.m, &b, out), SPH_ERR_NUMERIC, "particle 2: density");
      refused(ctx, sph_material_pressure_derivatives(l.m, &b, out, NULL), SPH_ERR_NUMERIC,
              "particle 2: density");
      rho[2] = rho[3] = rho[0];
      if (trial < 2 || l.barotropic) continue;
      e[1] = p[1] = bad[trial];
      refused(ctx, sph_material_pressure(l.m, &b, out), SPH_ERR_NUMERIC, "particle 1: energy");
      refused(ctx, sph_material_energy(l.m, &b, out), SPH_ERR_NUMERIC, "particle 1: pressure");
      p[1] = 1;
    }
    for (int i = 0; i < 4; i++) assert_true(out[i] == 7);
    for (int i = 0; i < 4; i++) rho[i] = l.rho[0], e[i] = l.e[1];
    b.dim = 3;
    check_ok(sph_material_pressure(l.m, &b, out));
    b.e = l.barotropic ? e : NULL;
    b.rho = l.barotropic ? NULL : rho;
    check_status(sph_material_pressure(l.m, &b, out), SPH_ERR_ARG);
    b.rho = rho;
    b.p = NULL;
    if (!l.barotropic) refused(ctx, sph_material_energy(l.m, &b, out), SPH_ERR_ARG, "needs p");
    sph_material_destroy(l.m);
  }
  sph_context_destroy(ctx);
}

/* A host's own law has every property. */
static int32_t host_one(void *user, const sph_material_block *b, double *out) {
  for (int64_t i = 0; i < b->n; i++) out[i] = *(const double *)user;
  return 0;
}
static int32_t host_two(void *user, const sph_material_block *b, double *dp_drho, double *dp_de) {
  for (int64_t i = 0; i < b->n; i++) {
    if (dp_drho != NULL) dp_drho[i] = *(const double *)user;
    if (dp_de != NULL) dp_de[i] = 2 * *(const double *)user;
  }
  return b->n > 1 ? -1 : 0;
}

static void test_host_law(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material_functions f;
  sph_material *m = NULL;
  double three = 3, rho[2] = {1, 1}, out[2], by_e[2];
  sph_material_functions_init(&f);
  f.temperature = f.energy = f.shear_speed = host_one;
  f.pressure_derivatives = host_two;
  check_ok(sph_material_create(ctx, &f, &three, &m));
  sph_material_block b = block(1, rho, NULL);
  check_ok(sph_material_temperature(m, &b, out));
  assert_true(out[0] == 3);
  check_ok(sph_material_energy(m, &b, out));
  check_ok(sph_material_pressure_derivatives(m, &b, out, by_e));
  assert_true(out[0] == 3 && by_e[0] == 6);
  b.n = 2;
  refused(ctx, sph_material_pressure_derivatives(m, &b, out, by_e), SPH_ERR_CALLBACK,
          "pressure_derivatives");
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

/* In a composed right-hand side the particle is named as the set counts it, whatever the threads.
 */
static void test_named_in_a_right_hand_side(void **state) {
  (void)state;
  for (int32_t threads = 1; threads <= 3; threads++) {
    enum { N = 5000 };
    sph_context *ctx = rh_context(threads);
    rh_system s = rh_make(ctx, 1, N, 0, 4);
    sph_material *air = gas(ctx, 1.4, 0, 0);
    sph_rhs *rhs = rh_rhs(&s);
    sph_term t = rh_term(SPH_TERM_PRESSURE, 0, 0);
    double *e = rh_field(&s, SPH_FIELD_E), *rates = (double *)calloc(N, sizeof *rates);
    sph_rate rate = {SPH_FIELD_V, rates};
    check_ok(sph_rhs_add(rhs, &t));
    check_ok(sph_rhs_set_material(rhs, 0, air));
    for (int i = 0; i < N; i++) e[i] = 1;
    check_ok(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, &rate, 1));
    e[4711] = e[3001] = -1;
    refused(ctx, sph_rhs_evaluate(rhs, s.set, s.list, 0.0, &rate, 1), SPH_ERR_NUMERIC,
            "pressure: particle 3001: energy -1 is below 0");
    free(rates);
    sph_rhs_destroy(rhs);
    sph_material_destroy(air);
    rh_free(&s);
    sph_context_destroy(ctx);
  }
}

/* ---- creation ---- */

#define BAD(create, options, member, value, words)                 \
  do {                                                             \
    double keep_ = (options).member;                               \
    (options).member = (value);                                    \
    refused(ctx, create(ctx, &(options), &m), SPH_ERR_ARG, words); \
    assert_null(m);                                                \
    (options).member = keep_;                                      \
  } while (0)

static void test_creation_refusals(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material *m = NULL;
  sph_gas_options g;
  sph_barotropic_options b;
  sph_mie_gruneisen_options o;
  sph_tillotson_options t;
  sph_gas_options_init(&g);
  sph_barotropic_options_init(&b);
  b.density = b.sound_speed = 1;
  sph_mie_gruneisen_options_init(&o);
  sph_tillotson_options_init(&t);
  check_ok(sph_mie_gruneisen_constants(SPH_LEAD, &o, NULL));
  check_ok(sph_tillotson_constants(SPH_TILLOTSON_ICE, &t));
  BAD(sph_material_create_gas, g, gamma, 1, "gamma");
  BAD(sph_material_create_gas, g, gamma, NAN, "gamma");
  BAD(sph_material_create_gas, g, reference_pressure, -1, "reference_pressure");
  BAD(sph_material_create_gas, g, heat_capacity, INFINITY, "heat_capacity");
  BAD(sph_material_create_barotropic, b, density, 0, "density");
  BAD(sph_material_create_barotropic, b, sound_speed, -1, "sound_speed");
  BAD(sph_material_create_barotropic, b, gamma, 0.5, "gamma");
  BAD(sph_material_create_barotropic, b, background, NAN, "background");
  BAD(sph_material_create_mie_gruneisen, o, density, NAN, "density");
  BAD(sph_material_create_mie_gruneisen, o, sound_speed, 0, "sound_speed");
  BAD(sph_material_create_mie_gruneisen, o, slope, -1, "slope");
  BAD(sph_material_create_mie_gruneisen, o, gruneisen, 0, "gruneisen");
  BAD(sph_material_create_mie_gruneisen, o, minimum_pressure, NAN, "minimum_pressure");
  BAD(sph_material_create_mie_gruneisen, o, sound_floor, 1.5, "sound_floor");
  o.curve = 4;
  refused(ctx, sph_material_create_mie_gruneisen(ctx, &o, &m), SPH_ERR_ARG, "curve 4");
  BAD(sph_material_create_tillotson, t, density, 0, "density");
  BAD(sph_material_create_tillotson, t, a, 0, "a = 0");
  BAD(sph_material_create_tillotson, t, b, -1, "b = -1");
  BAD(sph_material_create_tillotson, t, A, NAN, "A = ");
  BAD(sph_material_create_tillotson, t, B, -1, "B = -1");
  BAD(sph_material_create_tillotson, t, alpha, -1, "alpha");
  BAD(sph_material_create_tillotson, t, beta, INFINITY, "beta");
  BAD(sph_material_create_tillotson, t, e0, 0, "e0");
  BAD(sph_material_create_tillotson, t, e_cv, t.e_iv, "e_cv");
  BAD(sph_material_create_tillotson, t, sound_floor, -1, "sound_floor");
  refused(ctx, sph_material_create_gas(ctx, NULL, &m), SPH_ERR_ARG, "options is NULL");
  refused(ctx, sph_material_create_gas(ctx, &g, NULL), SPH_ERR_ARG, "out is NULL");
  sph_context_destroy(ctx);
}

static sph_status lives(sph_context *ctx, void *user) {
  sph_material *m = NULL, *metal = NULL;
  sph_tillotson_options t;
  sph_strength_options s;
  (void)user;
  sph_tillotson_options_init(&t);
  check_ok(sph_tillotson_constants(SPH_TILLOTSON_IRON, &t));
  sph_strength_options_init(&s);
  s.shear = 80e9;
  sph_status status = sph_material_create_tillotson(ctx, &t, &m);
  if (status == SPH_OK) status = sph_material_create_strength(ctx, m, &s, &metal);
  sph_material_destroy(m);
  sph_material_destroy(metal);
  return status;
}

static void test_out_of_memory(void **state) {
  (void)state;
  oom_sweep(lives, NULL);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_derivatives),
    cmocka_unit_test(test_sound_speed_along_isentropes),
    cmocka_unit_test(test_energy_inverts_pressure),
    cmocka_unit_test(test_published_gas_states),
    cmocka_unit_test(test_stiffened_temperature),
    cmocka_unit_test(test_cold_and_forbidden_gas),
    cmocka_unit_test(test_barotropic),
    cmocka_unit_test(test_bad_states),
    cmocka_unit_test(test_host_law),
    cmocka_unit_test(test_named_in_a_right_hand_side),
    cmocka_unit_test(test_creation_refusals),
    cmocka_unit_test(test_out_of_memory),
};
SPH_TEST_MAIN(tests)
