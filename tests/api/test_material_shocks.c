/* Mie-Grueneisen and Tillotson: shocks by the jump conditions, published and measured states,
 * continuity, limits; constants of materials. */
#include "../eos_help.h"

/* ---- Mie-Grueneisen ---- */

/* A linear U_s(u_p) and the jump conditions give rho, p and e behind a shock: the law agrees. */
static void test_linear_hugoniot(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int32_t which = SPH_ALUMINIUM_1000; which <= SPH_HOMOGENISED; which++) {
    sph_mie_gruneisen_options o;
    sph_mie_gruneisen_options_init(&o);
    check_ok(sph_mie_gruneisen_constants(which, &o, NULL));
    sph_material *m = gruneisen(ctx, which, SPH_HUGONIOT, 0.1);
    sph_material *cubic = gruneisen(ctx, which, SPH_HUGONIOT_CUBIC, 0.1);
    for (double up = 1; up < 10000; up *= 2) {
      double us = o.sound_speed + o.slope * up, rho = o.density * us / (us - up);
      double p = o.density * us * up, e = 0.5 * up * up;
      check_rel(pressure(m, rho, e), p, 1e-11);
      check_rel(energy(m, rho, p), e, 1e-8);
      double u = rho / o.density - 1; /* the cubic agrees to its order */
      if (u < 0.1) check_rel(pressure(cubic, rho, e), p, 12 * u * u * u);
    }
    sph_material_destroy(m);
    sph_material_destroy(cubic);
  }
  sph_context_destroy(ctx);
}

/* Excess of p over rho0 u^2/(1 - rho0/rho), at e = u^2/2. Mie-Grueneisen has 1 - Gamma u/2 as a
 * factor of it, whose zero is no shock: divide by it (gruneisen = 0 for other laws). */
static double excess(const sph_material *m, double rho0, double gruneisen, double rho, double up) {
  double need = rho0 * up * up / (1 - rho0 / rho);
  return (pressure(m, rho, 0.5 * up * up) - need) / (1 - 0.5 * gruneisen * (rho / rho0 - 1));
}

/* p behind a shock into material at rest with this particle speed: the least density without
 * excess, by steps and bisection; HUGE_VAL where the law has none. */
static double shocked(const sph_material *m, double rho0, double gruneisen, double up) {
  double low = rho0 * (1 + 1e-9), high = low;
  while (excess(m, rho0, gruneisen, high, up) < 0) {
    low = high;
    high += 0.01 * rho0;
    if (high > 2.9 * rho0) return HUGE_VAL;
  }
  for (int k = 0; k < 60; k++) {
    double mid = 0.5 * (low + high);
    if (excess(m, rho0, gruneisen, mid, up) < 0)
      low = mid;
    else
      high = mid;
  }
  return pressure(m, 0.5 * (low + high), 0.5 * up * up);
}

/* Pressure and the speed of the contact where a body with `speed` hits another. */
static double impact(const sph_material *m[2], const sph_mie_gruneisen_options o[2], double speed,
                     double *contact) {
  double low = 0, high = speed;
  for (int k = 0; k < 50; k++) {
    double mid = 0.5 * (low + high);
    if (shocked(m[1], o[1].density, o[1].gruneisen, mid) <
        shocked(m[0], o[0].density, o[0].gruneisen, speed - mid))
      low = mid;
    else
      high = mid;
  }
  *contact = low;
  return shocked(m[1], o[1].density, o[1].gruneisen, low);
}

/* Zisis 6.2, planar impacts of aluminium 2024 on three metals. */
static void test_planar_impacts(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  static const struct {
    int32_t target;
    double speed, cubic, contact, linear;
  } cases[] = {{SPH_ALUMINIUM_2024, 6180, 80.6e9, 3090, 81.5e9},
               {SPH_COPPER, 5750, 111.5e9, 1883, 113.1e9},
               {SPH_LEAD, 6850, 139.6e9, 2350, 143.6e9}};
  for (int k = 0; k < 3; k++)
    for (int32_t curve = SPH_HUGONIOT_CUBIC; curve <= SPH_HUGONIOT; curve++) {
      const int32_t which[2] = {SPH_ALUMINIUM_2024, cases[k].target};
      const sph_material *m[2];
      sph_material *made[2];
      sph_mie_gruneisen_options o[2];
      double contact;
      for (int side = 0; side < 2; side++) {
        sph_mie_gruneisen_options_init(o + side);
        check_ok(sph_mie_gruneisen_constants(which[side], o + side, NULL));
        m[side] = made[side] = gruneisen(ctx, which[side], curve, 0.1);
      }
      double p = impact(m, o, cases[k].speed, &contact);
      check_close(p, curve == SPH_HUGONIOT ? cases[k].linear : cases[k].cubic, 0.06e9);
      if (curve == SPH_HUGONIOT_CUBIC) check_close(contact, cases[k].contact, 0.6);
      for (int side = 0; side < 2; side++) sph_material_destroy(made[side]);
    }
  sph_context_destroy(ctx);
}

/* The isentropic bar of Zisis 5.3, with the exact states of its impact. */
static void test_cold_cubic(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_mie_gruneisen_options o;
  sph_material *m = NULL;
  sph_mie_gruneisen_options_init(&o);
  o.density = o.sound_speed = 1;
  o.slope = 1.338;
  o.gruneisen = 2;
  o.curve = SPH_COLD_CUBIC;
  check_ok(sph_material_create_mie_gruneisen(ctx, &o, &m));
  check_rel(pressure(m, 1.375506, 0.125), 0.915769, 3e-6);
  check_rel(pressure(m, 1.214535, 0.062837), 0.427406, 1e-5);
  sph_material_destroy(m);
  o.density = 0.4, o.sound_speed = 0.484, o.slope = 1.470, o.gruneisen = 0.67;
  check_ok(sph_material_create_mie_gruneisen(ctx, &o, &m));
  check_rel(pressure(m, 0.768843, 0.256303), 0.427406, 1e-5);
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

static void test_limits_of_gruneisen(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_mie_gruneisen_options o;
  sph_material *m = gruneisen(ctx, SPH_COPPER, SPH_HUGONIOT, 0.1), *cut = NULL;
  double rho[2] = {8930 * 2.999, 8930 * 3.0}, e[2] = {0, 0}, out[2] = {7, 7}, by_rho, by_e;
  sph_material_block b = block(2, rho, e);
  b.p = e;
  assert_true(isfinite(pressure(m, rho[0], 0))); /* S = 1.5: eta < 2/3, rho < 3 rho0 */
  refused(ctx, sph_material_pressure(m, &b, out), SPH_ERR_NUMERIC,
          "particle 1: density 26790 is beyond 26790");
  refused(ctx, sph_material_energy(m, &b, out), SPH_ERR_NUMERIC, "particle 1: density");
  assert_true(out[0] == 7 && out[1] == 7);
  /* one curve, with one slope, through rest */
  check_close(pressure(m, 8930 * (1 + 1e-9), 0), 8930. * 3900 * 3900 * 1e-9, 1e-4 * 136);
  check_close(pressure(m, 8930 * (1 - 1e-9), 0), -8930. * 3900 * 3900 * 1e-9, 1e-4 * 136);
  check_rel(sound(m, 8930, 0), 3900, 1e-14);
  /* strong tension: the floor; the cut-off */
  sph_material_destroy(m);
  m = gruneisen(ctx, SPH_COPPER, SPH_COLD_CUBIC, 0.1);
  check_rel(sound(m, 8930 * 0.45, 0), 390, 1e-14);
  sph_material_destroy(m);
  m = gruneisen(ctx, SPH_COPPER, SPH_COLD_CUBIC, 0);
  assert_true(sound(m, 8930 * 0.45, 0) == 0);
  sph_material_destroy(m);
  sph_mie_gruneisen_options_init(&o);
  check_ok(sph_mie_gruneisen_constants(SPH_COPPER, &o, NULL));
  o.minimum_pressure = -2e9;
  check_ok(sph_material_create_mie_gruneisen(ctx, &o, &cut));
  assert_true(pressure(cut, 8930 * 0.9, 0) == -2e9);
  derivatives(cut, 8930 * 0.9, 0, &by_rho, &by_e);
  assert_true(by_rho == 0 && by_e == 0);
  check_rel(sound(cut, 8930 * 0.9, 0), 390, 1e-14);
  assert_true(pressure(cut, 8930 * 0.99, 0) > -2e9);
  sph_material_destroy(cut);
  sph_context_destroy(ctx);
}

/* ---- Tillotson ---- */

static void test_tillotson_is_continuous(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int32_t which = SPH_TILLOTSON_ALUMINIUM; which <= SPH_TILLOTSON_GRANITE; which++) {
    sph_tillotson_options o;
    sph_tillotson_options_init(&o);
    check_ok(sph_tillotson_constants(which, &o));
    sph_material *m = tillotson(ctx, which, 0.1);
    const double d = 1e-9;
    for (double eta = 0.02; eta < 1; eta += 0.01)
      for (int edge = 0; edge < 2; edge++) {
        double e = edge ? o.e_cv : o.e_iv, rho = eta * o.density;
        check_close(pressure(m, rho, e * (1 + d)), pressure(m, rho, e * (1 - d)), 1e-6 * o.A);
      }
    for (double e = 0; e < 3 * o.e_cv; e += 0.05 * o.e_iv)
      check_close(pressure(m, o.density * (1 + d), e), pressure(m, o.density * (1 - d), e),
                  1e-6 * o.A);
    sph_material_destroy(m);
  }
  sph_context_destroy(ctx);
}

/* The formulas as printed, in another order, in all four states. */
static double printed(const sph_tillotson_options *t, double rho, double e) {
  double eta = rho / t->density, mu = eta - 1, v = t->density / rho;
  double bracket = t->b / (e / (t->e0 * eta * eta) + 1);
  double pc = (t->a + bracket) * rho * e + t->A * mu + t->B * mu * mu;
  double pe = t->a * rho * e + (bracket * rho * e + t->A * mu / exp(t->beta * (v - 1))) /
                                   exp(t->alpha * (v - 1) * (v - 1));
  if (eta >= 1 || e <= t->e_iv) return pc;
  if (e >= t->e_cv) return pe;
  return (pe * (e - t->e_iv) + pc * (t->e_cv - e)) / (t->e_cv - t->e_iv);
}

static void test_tillotson_as_printed(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int32_t which = SPH_TILLOTSON_ALUMINIUM; which <= SPH_TILLOTSON_GRANITE; which++) {
    sph_tillotson_options o;
    sph_tillotson_options_init(&o);
    check_ok(sph_tillotson_constants(which, &o));
    sph_material *m = tillotson(ctx, which, 0.1);
    for (int trial = 0; trial < 300; trial++) {
      double rho = o.density * random_in(0.02, 2), e = random_in(0, 2 * o.e_cv);
      check_close(pressure(m, rho, e), printed(&o, rho, e), 1e-12 * (o.A + rho * e));
      check_close(pressure(m, rho, energy(m, rho, pressure(m, rho, e))), pressure(m, rho, e),
                  1e-12 * (o.A + rho * e));
    }
    check_rel(sound(m, o.density, 0), sqrt(o.A / o.density), 1e-14);
    /* thin hot vapour is a gas with gamma - 1 = a */
    check_rel(pressure(m, 1e-3 * o.density, 10 * o.e_cv), o.a * 1e-3 * o.density * 10 * o.e_cv,
              1e-9);
    sph_material_destroy(m);
  }
  sph_context_destroy(ctx);
}

/* Shocks of Tillotson's metals against the measured linear Hugoniots (S. Marsh, LASL Shock Hugoniot
 * Data, 1980): aluminium 2024 5.328 + 1.338 u, iron above its transition 3.935 + 1.578 u km/s. */
static void test_tillotson_shocks(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material *al = tillotson(ctx, SPH_TILLOTSON_ALUMINIUM, 0.1);
  sph_material *iron = tillotson(ctx, SPH_TILLOTSON_IRON, 0.1);
  for (double up = 500; up <= 4000; up += 500)
    check_rel(shocked(al, 2700, 0, up), 2700 * (5328 + 1.338 * up) * up, 0.04);
  for (double up = 1500; up <= 4000; up += 500)
    check_rel(shocked(iron, 7800, 0, up), 7800 * (3935 + 1.578 * up) * up, 0.06);
  sph_material_destroy(al);
  sph_material_destroy(iron);
  sph_context_destroy(ctx);
}

static void test_limits_of_tillotson(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_tillotson_options o;
  sph_material *m = tillotson(ctx, SPH_TILLOTSON_ALUMINIUM, 0.1), *cut = NULL;
  double rho[2] = {2700, 2700}, e[2] = {-4.99e6, -5e6}, out[2] = {7, 7};
  sph_material_block b = block(2, rho, e);
  refused(ctx, sph_material_pressure(m, &b, out), SPH_ERR_NUMERIC,
          "particle 1: energy -5e+06 is not above -5e+06");
  assert_true(out[0] == 7);
  check_close(pressure(m, 1e-9, 0), 65.0e9 - 75.2e9, 1);
  check_rel(sound(m, 1e-9, 0), 0.1 * sqrt(75.2e9 / 2700), 1e-14);
  sph_tillotson_options_init(&o);
  check_ok(sph_tillotson_constants(SPH_TILLOTSON_ALUMINIUM, &o));
  o.minimum_pressure = -0.2e9;
  check_ok(sph_material_create_tillotson(ctx, &o, &cut));
  assert_true(pressure(cut, 1e-9, 0) == -0.2e9);
  sph_material_destroy(m);
  sph_material_destroy(cut);
  sph_context_destroy(ctx);
}

/* ---- constants ---- */

/* Every entry of the homogenised material is 3/4 aluminium 2024 + 1/4 epoxy, as printed. */
static void test_homogenised_constants(void **state) {
  (void)state;
  sph_mie_gruneisen_options o[3];
  sph_strength_options s[3];
  const int32_t which[3] = {SPH_ALUMINIUM_2024, SPH_EPOXY, SPH_HOMOGENISED};
  for (int k = 0; k < 3; k++) {
    sph_mie_gruneisen_options_init(o + k);
    sph_strength_options_init(s + k);
    check_ok(sph_mie_gruneisen_constants(which[k], o + k, s + k));
    assert_int_equal(o[k].size, sizeof o[k]);
    assert_true(o[k].sound_floor == 0.1 && s[k].jaumann == 1);
  }
  check_close(o[2].density, 0.75 * o[0].density + 0.25 * o[1].density, 0.51);
  check_close(o[2].sound_speed, 0.75 * o[0].sound_speed + 0.25 * o[1].sound_speed, 1);
  check_close(o[2].slope, 0.75 * o[0].slope + 0.25 * o[1].slope, 5.1e-4);
  check_close(o[2].gruneisen, 0.75 * o[0].gruneisen + 0.25 * o[1].gruneisen, 1e-12);
  check_close(s[2].shear, 0.75 * s[0].shear + 0.25 * s[1].shear, 0.051e9);
  check_close(s[2].yield, 0.75 * s[0].yield + 0.25 * s[1].yield, 0.5e6);
}

static void test_constants_refusals(void **state) {
  (void)state;
  sph_mie_gruneisen_options o;
  sph_strength_options s;
  sph_tillotson_options t;
  sph_mie_gruneisen_options_init(&o);
  sph_strength_options_init(&s);
  sph_tillotson_options_init(&t);
  check_status(sph_mie_gruneisen_constants(0, &o, &s), SPH_ERR_ARG);
  check_status(sph_mie_gruneisen_constants(7, &o, &s), SPH_ERR_ARG);
  check_status(sph_mie_gruneisen_constants(SPH_LEAD, NULL, NULL), SPH_ERR_ARG);
  check_status(sph_tillotson_constants(6, &t), SPH_ERR_ARG);
  check_status(sph_tillotson_constants(0, &t), SPH_ERR_ARG);
  s.size = 0;
  check_status(sph_mie_gruneisen_constants(SPH_LEAD, &o, &s), SPH_ERR_ARG);
  t.size = 8;
  check_status(sph_tillotson_constants(SPH_TILLOTSON_IRON, &t), SPH_ERR_ARG);
  assert_true(o.density == 0 && s.shear == 0 && t.density == 0);
  check_ok(sph_mie_gruneisen_constants(SPH_LEAD, &o, NULL));
  s.size = sizeof s;
  check_ok(sph_mie_gruneisen_constants(SPH_LEAD, NULL, &s));
  assert_true(o.density == 11360 && s.shear == 8.6e9);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_linear_hugoniot),
    cmocka_unit_test(test_planar_impacts),
    cmocka_unit_test(test_cold_cubic),
    cmocka_unit_test(test_limits_of_gruneisen),
    cmocka_unit_test(test_tillotson_is_continuous),
    cmocka_unit_test(test_tillotson_as_printed),
    cmocka_unit_test(test_tillotson_shocks),
    cmocka_unit_test(test_limits_of_tillotson),
    cmocka_unit_test(test_homogenised_constants),
    cmocka_unit_test(test_constants_refusals),
};
SPH_TEST_MAIN(tests)
