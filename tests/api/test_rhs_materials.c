/* Materials in a composed right-hand side: stress rates of several phases, pressure laws, laws of
 * the host that need what is not there, ask for a smaller step or fail. */
#include "../rhs_help.h"

static sph_material *hooke(sph_context *ctx, int32_t reduction, double young, int32_t jaumann) {
  sph_hooke_options o;
  sph_material *m = NULL;
  sph_hooke_options_init(&o);
  o.young = young;
  o.poisson = 0.3;
  o.density = 1.1;
  o.reduction = reduction;
  o.jaumann = jaumann;
  check_ok(sph_material_create_hooke(ctx, &o, &m));
  return m;
}

static int32_t reduction_of(int32_t dim) {
  return dim == 1 ? SPH_UNIAXIAL_STRESS : dim == 2 ? SPH_PLANE_STRAIN : SPH_SOLID;
}

/* A host's law: relaxation towards a strain rate, with every array that a block offers. */
typedef struct host_law {
  double rate;
  int32_t answer; /* of every call */
  int64_t destroyed;
} host_law;

static int32_t host_stress_rate(void *user, const sph_material_block *b, double *out) {
  const host_law *law = (const host_law *)user;
  int n = b->dim * (b->dim + 1) / 2, d = b->dim;
  if (!b->velocity_gradient || !b->sigma || !b->rho) return -7;
  for (int64_t i = 0; i < b->n; i++)
    for (int r = 0; r < d; r++)
      for (int s = r; s < d; s++) {
        const double *L = b->velocity_gradient + i * d * d;
        int c = rh_sym(d, r, s);
        out[i * n + c] =
            b->rho[i] * (L[r * d + s] + L[s * d + r]) - law->rate * b->sigma[i * n + c];
      }
  return law->answer;
}

static int32_t host_pressure(void *user, const sph_material_block *b, double *p) {
  const host_law *law = (const host_law *)user;
  if (!b->rho) return -8;
  for (int64_t i = 0; i < b->n; i++) p[i] = law->rate * b->rho[i] + (b->e ? b->e[i] : 0.0);
  return law->answer;
}

static void host_destroy(void *user) { ++((host_law *)user)->destroyed; }

static sph_material *host_material(sph_context *ctx, host_law *law, int stress, int pressure) {
  sph_material_functions f;
  sph_material *m = NULL;
  sph_material_functions_init(&f);
  if (stress) f.stress_rate = host_stress_rate;
  if (pressure) f.pressure = host_pressure;
  f.destroy = host_destroy;
  check_ok(sph_material_create(ctx, &f, law, &m));
  return m;
}

/* What the material gives on the velocity gradient of the operator, particle by particle. */
static void expected_rates(const rh_system *s, sph_material *const *materials, int corrected,
                           double *out) {
  int d = s->dim, n = d * (d + 1) / 2;
  double *matrix = rh_array(s->n * 9), *L = rh_array(s->n * 9);
  const int32_t *phase = sph_particles_phases(s->set);
  sph_operands a = rh_operands(s, corrected ? matrix : NULL);
  check_ok(sph_velocity_gradient(s->list, s->kernel, &a, L));
  for (int64_t i = 0; i < s->rows; i++) {
    sph_material_block b;
    sph_material_block_init(&b);
    b.dim = d;
    b.n = 1;
    b.velocity_gradient = L + i * d * d;
    b.sigma = a.sigma + i * n;
    b.rho = a.rho + i;
    check_ok(sph_material_stress_rate(materials[phase[i]], &b, out + i * n));
  }
  free(matrix);
  free(L);
}

static void check_stress_rates(sph_context *ctx, int32_t dim, uint32_t flavour, int corrected) {
  rh_system s = rh_make(ctx, dim, rh_side(dim), flavour, 5);
  host_law law = {.rate = 0.8};
  sph_material *m[4] = {hooke(ctx, reduction_of(dim), 3.0, 1), host_material(ctx, &law, 1, 0),
                        hooke(ctx, reduction_of(dim), 70.0, 0), NULL};
  sph_rhs *rhs = rh_rhs(&s);
  sph_term t = rh_term(SPH_TERM_STRESS_RATE, 0, corrected);
  check_ok(sph_rhs_add(rhs, &t));
  for (int k = 0; k < 3; k++) check_ok(sph_rhs_set_material(rhs, k, m[k]));
  for (int64_t i = 0; i < s.n; i++) sph_particles_phases(s.set)[i] = rh_choice(3);
  int64_t n = s.rows * sph_sym_components(dim);
  double *want = rh_array(n), *got = rh_rates(&s, rhs, SPH_FIELD_SIGMA);
  expected_rates(&s, m, corrected, want);
  double size = rh_largest(want, n);
  for (int64_t k = 0; k < n; k++) check_close(got[k], want[k], 1e-13 * size);
  free(want);
  free(got);
  sph_rhs_destroy(rhs);
  for (int k = 0; k < 3; k++) sph_material_destroy(m[k]);
  assert_int_equal(law.destroyed, 1);
  rh_free(&s);
}

static void test_stress_rates(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int corrected = 0; corrected < 2; corrected++) {
      check_stress_rates(ctx, dim, 0, corrected);
      check_stress_rates(ctx, dim, RH_VARY_ALL | RH_GHOSTS, corrected);
    }
  sph_context_destroy(ctx);
}

/* Beside other terms, in one sweep, the stress rate is the same. */
static void test_stress_rate_among_others(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int corrected = 0; corrected < 2; corrected++)
    for (int32_t dim = 1; dim <= 3; dim++) {
      rh_system s = rh_make(ctx, dim, rh_side(dim), 0, 6);
      sph_material *m = hooke(ctx, reduction_of(dim), 3.0, 1);
      static const int32_t kinds[] = {SPH_TERM_STRESS_RATE, SPH_TERM_STRESS, SPH_TERM_MONAGHAN,
                                      SPH_TERM_BULK_VISCOSITY};
      sph_rhs *rhs = rh_rhs(&s);
      for (int k = 0; k < 4; k++) {
        sph_term t = rh_term(kinds[k], 0, corrected && k < 3);
        check_ok(sph_rhs_add(rhs, &t));
      }
      check_ok(sph_rhs_set_material(rhs, 0, m));
      int64_t n = s.rows * sph_sym_components(dim);
      double *want = rh_array(n), *got = rh_array(n), *v = rh_array(s.rows * dim);
      sph_rate rates[2] = {{SPH_FIELD_V, v}, {SPH_FIELD_SIGMA, got}};
      check_ok(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, rates, 2));
      expected_rates(&s, &m, corrected, want);
      double size = rh_largest(want, n);
      for (int64_t k = 0; k < n; k++) check_close(got[k], want[k], 1e-13 * size);
      free(want);
      free(got);
      free(v);
      sph_material_destroy(m);
      sph_rhs_destroy(rhs);
      rh_free(&s);
    }
  sph_context_destroy(ctx);
}

/* P of the phases with a law comes from the law, that of the others stays; forces use it. */
static void test_pressure_law(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, 12, RH_VARY_M, 7);
  host_law law = {.rate = 2.5};
  sph_material *m = host_material(ctx, &law, 0, 1);
  sph_rhs *rhs = rh_rhs(&s);
  sph_term t = rh_term(SPH_TERM_PRESSURE, 0, 0);
  check_ok(sph_rhs_add(rhs, &t));
  check_ok(sph_rhs_set_material(rhs, 1, m));
  for (int64_t i = 0; i < s.n; i++) sph_particles_phases(s.set)[i] = rh_choice(2);
  double *p = rh_field(&s, SPH_FIELD_P), *want = rh_array(s.n);
  const double *rho = rh_field(&s, SPH_FIELD_RHO);
  for (int64_t i = 0; i < s.n; i++)
    want[i] = sph_particles_phases(s.set)[i] == 1 ? 2.5 * rho[i] : p[i];
  double *got = rh_rates(&s, rhs, SPH_FIELD_V), *force = rh_array(s.rows * 2);
  assert_memory_equal(p, want, (size_t)s.n * sizeof *p);
  rh_operator(&s, &t, force);
  double size = rh_largest(force, s.rows * 2);
  for (int64_t k = 0; k < s.rows * 2; k++) check_close(got[k], force[k], 1e-13 * size);
  free(got);
  free(force);
  free(want);
  sph_material_destroy(m);
  sph_rhs_destroy(rhs);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* A plain set with the fields named. */
static sph_particles *small_set(sph_context *ctx, int64_t n, const int32_t *fields, int count) {
  sph_particles_options o;
  sph_particles *set = NULL;
  double *a = NULL;
  sph_particles_options_init(&o);
  o.dim = 1;
  check_ok(sph_particles_create(ctx, &o, &set));
  check_ok(sph_particles_add(set, n, NULL));
  check_ok(sph_particles_field(set, SPH_FIELD_X, &a));
  for (int64_t i = 0; i < n; i++) a[i] = (double)i;
  for (int k = 0; k < count; k++) {
    check_ok(sph_particles_field(set, fields[k], &a));
    for (int64_t i = 0; i < n; i++) a[i] = 1.25;
  }
  return set;
}

/* The energy reaches the law where the set has it. A set without P gets it from the law. */
static void test_pressure_creates_p(void **state) {
  (void)state;
  static const int32_t fields[] = {SPH_FIELD_H, SPH_FIELD_M, SPH_FIELD_RHO, SPH_FIELD_E};
  sph_context *ctx = rh_context(1);
  sph_particles *set = small_set(ctx, 20, fields, 4);
  host_law law = {.rate = 2.0};
  sph_material *m = host_material(ctx, &law, 0, 1);
  rh_system s = {.ctx = ctx, .set = set, .dim = 1, .n = 20, .rows = 20};
  check_ok(sph_kernel_create(ctx, SPH_KERNEL_CUBIC_SPLINE, 1, &s.kernel));
  check_ok(sph_neighbors_create(ctx, NULL, &s.list));
  sph_rhs *rhs = rh_rhs(&s);
  sph_term t = rh_term(SPH_TERM_PRESSURE, 0, 0);
  check_ok(sph_rhs_add(rhs, &t));
  check_ok(sph_rhs_set_material(rhs, 0, m));
  double *v = rh_rates(&s, rhs, SPH_FIELD_V);
  const double *p = sph_particles_field_const(set, SPH_FIELD_P);
  assert_non_null(p);
  for (int i = 0; i < 20; i++) check_close(p[i], 2.0 * 1.25 + 1.25, 0.0);
  free(v);
  sph_rhs_destroy(rhs);
  sph_material_destroy(m);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* --- refusals ---------------------------------------------------------------------------- */

typedef struct law_rig {
  rh_system s;
  sph_rhs *rhs;
  double rates[256];
} law_rig;

static law_rig make_rig(sph_context *ctx) {
  law_rig r = {.s = rh_make(ctx, 1, 40, 0, 9)};
  sph_term t = rh_term(SPH_TERM_STRESS_RATE, 0, 0);
  r.rhs = rh_rhs(&r.s);
  check_ok(sph_rhs_add(r.rhs, &t));
  return r;
}

static void free_rig(law_rig *r) {
  sph_rhs_destroy(r->rhs);
  rh_free(&r->s);
}

static void expect(law_rig *r, int32_t field, sph_status want, const char *words) {
  sph_rate rate = {field, r->rates};
  check_status(sph_rhs_evaluate(r->rhs, r->s.set, r->s.list, 0.0, &rate, 1), want);
  if (strstr(sph_context_last_error(r->s.ctx), words) == NULL)
    fail_msg("\"%s\" is not in \"%s\"", words, sph_context_last_error(r->s.ctx));
}

/* A phase without a material, or whose material has no stress rate, is named with its particle. */
static void test_no_material(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  law_rig r = make_rig(ctx);
  host_law law = {.rate = 1.0};
  sph_material *m = hooke(ctx, SPH_UNIAXIAL_STRESS, 3.0, 0), *p = host_material(ctx, &law, 0, 1);
  expect(&r, SPH_FIELD_SIGMA, SPH_ERR_STATE, "phase 0");
  check_ok(sph_rhs_set_material(r.rhs, 0, m));
  expect(&r, SPH_FIELD_SIGMA, SPH_OK, "");
  sph_particles_phases(r.s.set)[17] = 200;
  expect(&r, SPH_FIELD_SIGMA, SPH_ERR_STATE, "particle 17 has phase 200");
  check_ok(sph_rhs_set_material(r.rhs, 200, p));
  expect(&r, SPH_FIELD_SIGMA, SPH_ERR_STATE, "particle 17 has phase 200");
  check_ok(sph_rhs_set_material(r.rhs, 200, m));
  expect(&r, SPH_FIELD_SIGMA, SPH_OK, "");
  sph_particles_phases(r.s.set)[3] = -1;
  expect(&r, SPH_FIELD_SIGMA, SPH_ERR_STATE, "particle 3");
  sph_particles_phases(r.s.set)[3] = 256;
  expect(&r, SPH_FIELD_SIGMA, SPH_ERR_STATE, "particle 3");
  expect(&r, SPH_FIELD_V, SPH_OK, ""); /* not asked for, not needed */
  sph_particles_phases(r.s.set)[3] = 0;
  check_ok(sph_rhs_set_material(r.rhs, 0, NULL));
  expect(&r, SPH_FIELD_SIGMA, SPH_ERR_STATE, "phase 0");
  sph_material_destroy(m);
  sph_material_destroy(p);
  free_rig(&r);
  assert_int_equal(law.destroyed, 1);
  sph_context_destroy(ctx);
}

/* Ghosts need no material: they get no rates. */
static void test_ghosts_without_material(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  law_rig r = make_rig(ctx);
  sph_material *m = hooke(ctx, SPH_UNIAXIAL_STRESS, 3.0, 0);
  check_ok(sph_rhs_set_material(r.rhs, 0, m));
  check_ok(sph_particles_add_ghosts(r.s.set, 2, NULL));
  for (int64_t k = 40; k < 42; k++) {
    rh_field(&r.s, SPH_FIELD_X)[k] = (double)k + 0.5;
    rh_field(&r.s, SPH_FIELD_H)[k] = rh_field(&r.s, SPH_FIELD_M)[k] = 1.0;
    rh_field(&r.s, SPH_FIELD_RHO)[k] = 1.0;
    sph_particles_phases(r.s.set)[k] = 77;
  }
  check_ok(sph_particles_touch(r.s.set, SPH_FIELD_X));
  expect(&r, SPH_FIELD_SIGMA, SPH_OK, "");
  sph_material_destroy(m);
  free_rig(&r);
  sph_context_destroy(ctx);
}

static void test_wrong_dimension(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  law_rig r = make_rig(ctx);
  sph_material *m = hooke(ctx, SPH_SOLID, 3.0, 0);
  check_ok(sph_rhs_set_material(r.rhs, 0, m));
  expect(&r, SPH_FIELD_SIGMA, SPH_ERR_ARG, "3-D");
  sph_material_destroy(m);
  free_rig(&r);
  sph_context_destroy(ctx);
}

/* A law that asks for a smaller step, and one that fails. */
static void test_law_answers(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  law_rig r = make_rig(ctx);
  host_law law = {.rate = 1.0};
  sph_material *m = host_material(ctx, &law, 1, 1);
  check_ok(sph_rhs_set_material(r.rhs, 0, m));
  law.answer = 3;
  expect(&r, SPH_FIELD_SIGMA, SPH_RETRY, "");
  law.answer = -3;
  expect(&r, SPH_FIELD_SIGMA, SPH_ERR_CALLBACK, "pressure");
  sph_material_destroy(m);
  m = host_material(ctx, &law, 1, 0);
  check_ok(sph_rhs_set_material(r.rhs, 0, m));
  expect(&r, SPH_FIELD_SIGMA, SPH_ERR_CALLBACK, "stress_rate");
  law.answer = 1;
  expect(&r, SPH_FIELD_SIGMA, SPH_RETRY, "");
  law.answer = 0;
  expect(&r, SPH_FIELD_SIGMA, SPH_OK, "");
  sph_material_destroy(m);
  free_rig(&r);
  assert_int_equal(law.destroyed, 2);
  sph_context_destroy(ctx);
}

/* Materials are retained: setting, replacing, removing and destroying count right. */
static void test_references(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  law_rig r = make_rig(ctx);
  host_law law = {.rate = 1.0};
  sph_material *m = host_material(ctx, &law, 1, 0);
  check_ok(sph_rhs_set_material(r.rhs, 0, m));
  check_ok(sph_rhs_set_material(r.rhs, 0, m)); /* again */
  check_ok(sph_rhs_set_material(r.rhs, 255, m));
  sph_material_destroy(m);
  expect(&r, SPH_FIELD_SIGMA, SPH_OK, "");
  check_ok(sph_rhs_set_material(r.rhs, 0, NULL));
  assert_int_equal(law.destroyed, 0);
  check_ok(sph_rhs_set_material(r.rhs, 0, NULL));
  check_ok(sph_rhs_set_material(r.rhs, 255, NULL));
  assert_int_equal(law.destroyed, 1);
  m = host_material(ctx, &law, 1, 0);
  check_ok(sph_rhs_set_material(r.rhs, 7, m));
  sph_material_destroy(m);
  free_rig(&r);
  assert_int_equal(law.destroyed, 2);
  sph_context_destroy(ctx);
}

static void test_set_material_refusals(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  law_rig r = make_rig(ctx);
  sph_material *m = hooke(ctx, SPH_UNIAXIAL_STRESS, 3.0, 0);
  check_status(sph_rhs_set_material(NULL, 0, m), SPH_ERR_ARG);
  check_status(sph_rhs_set_material((sph_rhs *)m, 0, m), SPH_ERR_HANDLE);
  check_status(sph_rhs_set_material(r.rhs, -1, m), SPH_ERR_ARG);
  check_status(sph_rhs_set_material(r.rhs, 256, m), SPH_ERR_ARG);
  check_status(sph_rhs_set_material(r.rhs, 0, (sph_material *)r.rhs), SPH_ERR_HANDLE);
  expect(&r, SPH_FIELD_SIGMA, SPH_ERR_STATE, "phase 0"); /* nothing was set */
  sph_material_destroy(m);
  free_rig(&r);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_stress_rates),    cmocka_unit_test(test_stress_rate_among_others),
    cmocka_unit_test(test_pressure_law),    cmocka_unit_test(test_pressure_creates_p),
    cmocka_unit_test(test_no_material),     cmocka_unit_test(test_ghosts_without_material),
    cmocka_unit_test(test_wrong_dimension), cmocka_unit_test(test_law_answers),
    cmocka_unit_test(test_references),      cmocka_unit_test(test_set_material_refusals),
};
SPH_TEST_MAIN(tests)
