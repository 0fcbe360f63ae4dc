/* Plasticity against numerical return mappings: the plastic multiplier by bisection on full
 * tensors, the reductions by bisection on the strains across; closed solutions of bars. */
#include "../material_help.h"
#include "../oom.h"
#include "../tensor_help.h"

static const double young = 3.0, nu = 0.3, yield = 0.4;

static sph_von_mises_options options_of(int32_t reduction, double hardening) {
  sph_von_mises_options o;
  sph_von_mises_options_init(&o);
  o.young = young;
  o.poisson = nu;
  o.density = 2;
  o.yield = yield;
  o.hardening = hardening;
  o.reduction = reduction;
  return o;
}

static sph_material *make(sph_context *ctx, int32_t reduction, double hardening) {
  sph_von_mises_options o = options_of(reduction, hardening);
  sph_material *m = NULL;
  check_ok(sph_material_create_von_mises(ctx, &o, &m));
  return m;
}

/* ---- the oracle, in 3x3 and long double ---- */

/* s <- s - 2G strain (3/2 dev s / q): the stress after plastic flow along its own deviator */
static void flow(tensor trial, real strain, tensor out) {
  real g = young / (2 * (1 + (real)nu)), q = equivalent(trial);
  real mean = (trial[0][0] + trial[1][1] + trial[2][2]) / 3;
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++)
      out[a][b] = trial[a][b] - 3 * g * strain / q * (trial[a][b] - (a == b ? mean : 0));
}

/* Bisection for the plastic strain at which q meets the yield stress. Returns it. */
static real return_by_bisection(tensor trial, real hardening, real before, tensor out) {
  real low = 0, high = equivalent(trial) / (3 * young / (2 * (1 + (real)nu)));
  memcpy(out, trial, sizeof(tensor));
  if (equivalent(trial) <= yield + hardening * before) return 0;
  for (int k = 0; k < 90; k++) {
    real mid = 0.5L * (low + high);
    flow(trial, mid, out);
    if (equivalent(out) > yield + hardening * (before + mid))
      low = mid;
    else
      high = mid;
  }
  return low;
}

/* The trial stress, with an elastic strain e in the directions across that are free. */
static void strained(int32_t reduction, tensor trial, real e, tensor out) {
  real lambda = young * (real)nu / ((1 + (real)nu) * (1 - 2 * (real)nu));
  real mu = young / (2 * (1 + (real)nu));
  int from = reduction == SPH_UNIAXIAL_STRESS ? 1 : 2;
  memcpy(out, trial, sizeof(tensor));
  for (int a = 0; a < 3; a++) out[a][a] += lambda * e * (3 - from) + (a >= from ? 2 * mu * e : 0);
}

/* Of implicit Euler in the reduction: the strain across is such that no stress is left there. */
static real oracle(int32_t reduction, tensor trial, real hardening, real before, tensor out) {
  tensor at;
  real low = -10, high = 10, plastic = 0;
  if (reduction != SPH_PLANE_STRESS && reduction != SPH_UNIAXIAL_STRESS)
    return return_by_bisection(trial, hardening, before, out);
  for (int k = 0; k < 100; k++) {
    real mid = 0.5L * (low + high);
    strained(reduction, trial, mid, at);
    plastic = return_by_bisection(at, hardening, before, out);
    if (out[2][2] > 0)
      high = mid;
    else
      low = mid;
  }
  return plastic;
}

static void check_return(sph_context *ctx, int32_t reduction, double hardening) {
  int32_t dim = dim_of(reduction);
  int held = reduction == SPH_PLANE_STRAIN || reduction == SPH_UNIAXIAL_STRAIN, yields = 0;
  sph_material *m = make(ctx, reduction, hardening);
  for (int trial = 0; trial < 25; trial++) {
    const double size = trial % 5 == 0 ? 0.1 : 1;
    double s[6], across = held ? size * random_signed() : 0,
                 strain = 0.2 / (1 + hardening) * fabs(random_signed());
    double before = strain, work = 7, y0 = yield + hardening * before;
    tensor in, want;
    for (int k = 0; k < 6; k++) s[k] = size * random_signed();
    full(dim, s, across, in);
    real plastic = oracle(reduction, in, hardening, before, want);
    check_ok(sph_material_plastic_return(m, dim, 1, s, &across, &strain, &work));
    for (int k = 0; k < dim * (dim + 1) / 2; k++)
      check_close(s[k], (double)want[row[packed[dim][k]]][column[packed[dim][k]]], 1e-13);
    if (held) check_close(across, (double)want[2][2], 1e-13);
    check_close(strain - before, (double)plastic, 1e-13);
    double y1 = yield + hardening * strain;
    check_close(work - 7, 0.5 * (y0 + y1) * (double)plastic, 1e-13);
    full(dim, s, across, in);
    if (plastic > 0) check_rel((double)equivalent(in), y1, 1e-14);
    yields += plastic > 0;
  }
  if (yields < 5 || yields > 24) fail_msg("reduction %d: %d of 25 yield", reduction, yields);
  sph_material_destroy(m);
}

static void test_return(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int32_t reduction = SPH_UNIAXIAL_STRESS; reduction <= SPH_SOLID; reduction++)
    for (int k = 0; k < 3; k++) check_return(ctx, reduction, k == 0 ? 0 : k == 1 ? 0.3 : 50);
  sph_context_destroy(ctx);
}

/* Far beyond the yield stress, and barely: q = Y still. */
static void test_overshoots(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int32_t reduction = SPH_UNIAXIAL_STRESS; reduction <= SPH_SOLID; reduction++)
    for (int hard = 0; hard < 2; hard++) {
      int32_t dim = dim_of(reduction);
      sph_material *m = make(ctx, reduction, hard ? 0.3 : 0);
      for (double over = 1 + 1e-15; over < 1e14; over = 1 + 40 * (over - 1)) {
        double s[6], across = 0, strain = 0, q;
        tensor t;
        for (int k = 0; k < 6; k++) s[k] = random_signed();
        full(dim, s, across, t);
        double scale = over * yield / (double)equivalent(t);
        for (int k = 0; k < 6; k++) s[k] *= scale;
        check_ok(sph_material_plastic_return(m, dim, 1, s, &across, &strain, NULL));
        check_ok(sph_equivalent_stress(dim, 1, s, &across, &q));
        /* a deviator beside a huge pressure is known to the rounding of that */
        check_rel(q, yield + (hard ? 0.3 * strain : 0), 1e-14 + 1e-15 * over);
      }
      sph_material_destroy(m);
    }
  sph_context_destroy(ctx);
}

/* Within the yield surface nothing is written; nor for a NaN. */
static void test_elastic_is_untouched(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int32_t reduction = SPH_UNIAXIAL_STRESS; reduction <= SPH_SOLID; reduction++) {
    int32_t dim = dim_of(reduction), comps = dim * (dim + 1) / 2;
    sph_material *m = make(ctx, reduction, 0.3);
    double s[12], old[12], across[2] = {0.01, 0.02}, strain[2] = {0, 0}, work[2] = {1, 2};
    for (int k = 0; k < 12; k++) s[k] = old[k] = 0.1 * random_signed();
    s[comps] = old[comps] = NAN;
    check_ok(sph_material_plastic_return(m, dim, 2, s, across, strain, work));
    for (int k = 0; k < 12; k++) assert_true(isnan(old[k]) ? isnan(s[k]) : s[k] == old[k]);
    assert_true(across[0] == 0.01 && across[1] == 0.02 && strain[0] == 0 && strain[1] == 0);
    assert_true(work[0] == 1 && work[1] == 2);
    sph_material_destroy(m);
  }
  sph_context_destroy(ctx);
}

/* ---- bars ---- */

/* Pulled, then pressed: the bilinear curve with the tangent E H/(E + H), and its area. */
static void test_bar_with_hardening(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  enum { STEPS = 1000 };
  const double hardening = 0.5, end = 0.6;
  sph_material *m = make(ctx, SPH_UNIAXIAL_STRESS, hardening);
  double l = 1, s = 0, strain = 0, work = 0, total = 0;
  sph_material_block b;
  sph_material_block_init(&b);
  b.dim = 1;
  b.n = 1;
  b.velocity_gradient = &l;
  for (int k = 0; k < STEPS; k++) {
    double before = s;
    check_ok(sph_material_stress_update(m, &b, end / STEPS, SPH_ROTATION_CAYLEY, &s, NULL));
    check_ok(sph_material_plastic_return(m, 1, 1, &s, NULL, &strain, &work));
    total += 0.5 * (before + s) * end / STEPS;
  }
  double tangent = young * hardening / (young + hardening);
  check_rel(s, yield + tangent * (end - yield / young), 1e-12);
  check_rel(strain, end - s / young, 1e-12);
  check_rel(work, total - s * s / (2 * young), 1e-4); /* the step with the kink is not exact */
  l = -1; /* unloading is elastic until -s: isotropic hardening */
  double pulled = s, plastic = strain;
  check_ok(sph_material_stress_update(m, &b, 2 * pulled / young, SPH_ROTATION_CAYLEY, &s, NULL));
  check_ok(sph_material_plastic_return(m, 1, 1, &s, NULL, &strain, NULL));
  check_rel(s, -pulled, 1e-12);
  check_close(strain, plastic, 1e-12);
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

/* Uniaxial strain: elastic to Y (lambda + 2G)/(2G), then with the bulk modulus. */
static void test_hugoniot_elastic_limit(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  enum { STEPS = 1000 };
  const double end = -0.5, g = young / (2 * (1 + nu)), bulk = young / (3 * (1 - 2 * nu));
  const double stiff = bulk + 4 * g / 3, limit = yield * stiff / (2 * g);
  sph_material *m = make(ctx, SPH_UNIAXIAL_STRAIN, 0);
  double l = end, s = 0, across = 0;
  sph_material_block b;
  sph_material_block_init(&b);
  b.dim = 1;
  b.n = 1;
  b.velocity_gradient = &l;
  for (int k = 0; k < STEPS; k++) {
    check_ok(sph_material_stress_update(m, &b, 1.0 / STEPS, SPH_ROTATION_CAYLEY, &s, &across));
    check_ok(sph_material_plastic_return(m, 1, 1, &s, &across, NULL, NULL));
  }
  check_rel(s, -limit + bulk * (end + limit / stiff), 1e-12);
  check_rel(s - across, -yield, 1e-12);
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

/* The return commutes with rotations of the axes. */
static void test_isotropy(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int32_t reduction = SPH_PLANE_STRESS; reduction <= SPH_SOLID; reduction++) {
    int32_t dim = dim_of(reduction);
    sph_material *m = make(ctx, reduction, 0.3);
    for (int trial = 0; trial < 20; trial++) {
      double s[6], turned[6], l[9], across[2] = {0.1, 0.1}, strain[2] = {0, 0};
      for (int k = 0; k < 9; k++) l[k] = random_signed();
      for (int k = 0; k < 6; k++) s[k] = turned[k] = random_signed();
      check_ok(sph_stress_rotate(dim, 1, l, 1, SPH_ROTATION_EXPONENTIAL, turned));
      check_ok(sph_material_plastic_return(m, dim, 1, turned, across, strain, NULL));
      check_ok(sph_material_plastic_return(m, dim, 1, s, across + 1, strain + 1, NULL));
      check_ok(sph_stress_rotate(dim, 1, l, 1, SPH_ROTATION_EXPONENTIAL, s));
      for (int k = 0; k < dim * (dim + 1) / 2; k++) check_close(s[k], turned[k], 1e-14);
      check_close(strain[0], strain[1], 1e-14);
    }
    sph_material_destroy(m);
  }
  sph_context_destroy(ctx);
}

/* Elastic parts are Hooke's, to the bit. */
static void test_elastic_part(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int32_t reduction = SPH_UNIAXIAL_STRESS; reduction <= SPH_SOLID; reduction++) {
    int32_t dim = dim_of(reduction);
    sph_material *m = make(ctx, reduction, 0), *hooke = NULL;
    sph_hooke_options h;
    double l[9], s[6], got[6] = {0}, want[6] = {0};
    sph_material_block b;
    sph_hooke_options_init(&h);
    h.young = young, h.poisson = nu, h.density = 2, h.reduction = reduction;
    check_ok(sph_material_create_hooke(ctx, &h, &hooke));
    for (int k = 0; k < 9; k++) l[k] = random_signed();
    for (int k = 0; k < 6; k++) s[k] = random_signed();
    sph_material_block_init(&b);
    b.dim = dim;
    b.n = 1;
    b.velocity_gradient = l;
    b.sigma = s;
    check_ok(sph_material_stress_rate(m, &b, got));
    check_ok(sph_material_stress_rate(hooke, &b, want));
    assert_memory_equal(got, want, sizeof got);
    check_ok(sph_material_sound_speed(m, &b, got));
    check_ok(sph_material_sound_speed(hooke, &b, want));
    check_ok(sph_material_shear_speed(m, &b, got + 1));
    check_ok(sph_material_shear_speed(hooke, &b, want + 1));
    if (dim < 3) {
      check_ok(sph_material_stress_rate_across(m, &b, got + 2));
      check_ok(sph_material_stress_rate_across(hooke, &b, want + 2));
    }
    assert_memory_equal(got, want, sizeof got);
    sph_material_destroy(m);
    sph_material_destroy(hooke);
  }
  sph_context_destroy(ctx);
}

/* ---- refusals ---- */

static void test_von_mises_refusals(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material *m = (sph_material *)ctx;
  const double bad[] = {0, -1, NAN, INFINITY};
  double s[6] = {1, 2, 3, 4, 5, 6}, strain[2] = {0}, across[2] = {0};
  for (int k = 0; k < 4; k++) {
    sph_von_mises_options o = options_of(SPH_SOLID, 0);
    o.yield = bad[k];
    refused(ctx, sph_material_create_von_mises(ctx, &o, &m), SPH_ERR_ARG, "yield");
    assert_null(m);
    o = options_of(SPH_SOLID, bad[k]);
    if (bad[k] != 0)
      refused(ctx, sph_material_create_von_mises(ctx, &o, &m), SPH_ERR_ARG, "hardening");
  }
  sph_von_mises_options o = options_of(0, 0);
  refused(ctx, sph_material_create_von_mises(ctx, &o, &m), SPH_ERR_ARG, "reduction 0");
  m = make(ctx, SPH_PLANE_STRAIN, 0.3);
  refused(ctx, sph_material_plastic_return(m, 2, 1, s, NULL, strain, NULL), SPH_ERR_ARG, "across");
  refused(ctx, sph_material_plastic_return(m, 2, 1, s, across, NULL, NULL), SPH_ERR_ARG,
          "plastic_strain");
  refused(ctx, sph_material_plastic_return(m, 3, 1, s, across, strain, NULL), SPH_ERR_ARG, "3-D");
  refused(ctx, sph_material_plastic_return(m, 2, -1, s, across, strain, NULL), SPH_ERR_ARG,
          "negative");
  refused(ctx, sph_material_plastic_return(m, 2, 1, NULL, across, strain, NULL), SPH_ERR_ARG,
          "NULL");
  check_ok(sph_material_plastic_return(m, 2, 0, s, NULL, NULL, NULL));
  for (int k = 0; k < 6; k++) assert_true(s[k] == k + 1);
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

static sph_status lives(sph_context *ctx, void *user) {
  sph_material *m = NULL;
  sph_von_mises_options o = options_of(SPH_SOLID, 0.1);
  (void)user;
  sph_status status = sph_material_create_von_mises(ctx, &o, &m);
  sph_material_destroy(m);
  return status;
}

static void test_out_of_memory(void **state) {
  (void)state;
  oom_sweep(lives, NULL);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_return),
    cmocka_unit_test(test_overshoots),
    cmocka_unit_test(test_elastic_is_untouched),
    cmocka_unit_test(test_bar_with_hardening),
    cmocka_unit_test(test_hugoniot_elastic_limit),
    cmocka_unit_test(test_isotropy),
    cmocka_unit_test(test_elastic_part),
    cmocka_unit_test(test_von_mises_refusals),
    cmocka_unit_test(test_out_of_memory),
};
SPH_TEST_MAIN(tests)
