/* Terms of variable smoothing lengths in a composed right-hand side: fused they give what the
 * operators give one by one, for any set of terms and of rates; the velocity gradient that the
 * materials get; what is refused. */
#include "../oom.h"
#include "../rhs_help.h"

enum { SMOOTHED = 1, STRESS = 2, LOSS = 4 };

/* All fields, h that differs twofold, a list by the rule MAX. */
static rh_system make_system(sph_context *ctx, int32_t dim, uint32_t flavour, int with_omega) {
  rh_system s = rh_make(ctx, dim, rh_side(dim), flavour, (uint64_t)(17 + dim));
  sph_neighbors_options o;
  sph_neighbors_options_init(&o);
  o.support = sph_kernel_support(s.kernel);
  o.h_rule = SPH_H_MAX;
  rh_fill(&s, SPH_FIELD_H, 0.8, 1.5, 1);
  rh_fill(&s, SPH_FIELD_E, 0.5, 2.0, 1);
  if (with_omega) rh_fill(&s, SPH_FIELD_OMEGA, 0.6, 1.3, 1);
  sph_neighbors_destroy(s.list);
  check_ok(sph_neighbors_create(ctx, &o, &s.list));
  check_ok(sph_neighbors_build(s.list, s.set));
  return s;
}

static sph_dissipation losses(void) {
  sph_dissipation z;
  sph_dissipation_init(&z);
  z.viscosity = 1.2;
  z.conductivity = 0.4;
  z.mass_flux = 0.7;
  z.mass_flux_b = 1.5;
  return z;
}

static sph_rhs *make_rhs(const rh_system *s, unsigned terms, int32_t smoothing) {
  sph_rhs *rhs = rh_rhs(s);
  sph_dissipation z = losses();
  sph_term t = rh_term(SPH_TERM_SMOOTHED, smoothing, 0);
  if (terms & SMOOTHED) check_ok(sph_rhs_add(rhs, &t));
  t = rh_term(SPH_TERM_SMOOTHED_STRESS, 0, 0);
  if (terms & STRESS) check_ok(sph_rhs_add(rhs, &t));
  t = rh_term(SPH_TERM_DISSIPATION, 0, 0);
  t.dissipation = &z;
  if (terms & LOSS) check_ok(sph_rhs_add(rhs, &t));
  memset(&z, 0xff, sizeof z); /* it was copied */
  return rhs;
}

/* Rates of rho, v, e, one after the other, and the sizes of what was added up. */
typedef struct rates {
  double *rho, *v, *e;
  int64_t n;
} rates;

static rates make_rates(const rh_system *s, double value) {
  rates r = {.n = s->rows * (s->dim + 2)};
  r.rho = rh_array(r.n);
  r.v = r.rho + s->rows;
  r.e = r.v + s->rows * s->dim;
  for (int64_t k = 0; k < r.n; k++) r.rho[k] = value;
  return r;
}

static void add_part(rates *sum, rates *size, rates *part) {
  for (int64_t k = 0; k < sum->n; k++) {
    sum->rho[k] += part->rho[k];
    size->rho[k] += fabs(part->rho[k]);
    part->rho[k] = 0.0;
  }
}

static void by_operators(const rh_system *s, unsigned terms, int32_t smoothing, rates *sum,
                         rates *size) {
  sph_operands a = rh_operands(s, NULL);
  sph_dissipation z = losses();
  rates part = make_rates(s, 0.0);
  if (terms & SMOOTHED) {
    check_ok(sph_smoothed_pressure(s->list, s->kernel, &a, smoothing, part.rho, part.v, part.e));
    add_part(sum, size, &part);
  }
  if (terms & STRESS) {
    check_ok(sph_smoothed_stress(s->list, s->kernel, &a, part.v, part.e, NULL));
    add_part(sum, size, &part);
  }
  if (terms & LOSS) {
    check_ok(sph_smoothed_dissipation(s->list, s->kernel, &a, &z, part.rho, part.v, part.e));
    add_part(sum, size, &part);
  }
  free(part.rho);
}

static void expect_close(const rates *got, const rates *want, const rates *size, int64_t lo,
                         int64_t count) {
  double most = rh_largest(size->rho + lo, count); /* of the field */
  for (int64_t k = lo; k < lo + count; k++)
    assert_true(fabs(got->rho[k] - want->rho[k]) <= 1e-12 * most);
}

/* The rates asked for are those of the operators, whichever are asked for together. */
static void check_rates(const rh_system *s, unsigned terms, int32_t smoothing) {
  sph_rhs *rhs = make_rhs(s, terms, smoothing);
  rates want = make_rates(s, 0.0), size = make_rates(s, 0.0);
  by_operators(s, terms, smoothing, &want, &size);
  for (unsigned asked = 1; asked < 8; asked++) {
    rates got = make_rates(s, NAN);
    sph_rate list[3];
    int32_t count = 0;
    if (asked & 1) list[count++] = (sph_rate){SPH_FIELD_RHO, got.rho};
    if (asked & 2) list[count++] = (sph_rate){SPH_FIELD_V, got.v};
    if (asked & 4) list[count++] = (sph_rate){SPH_FIELD_E, got.e};
    check_ok(sph_rhs_evaluate(rhs, s->set, s->list, 0.0, list, count));
    if (asked & 1) expect_close(&got, &want, &size, 0, s->rows);
    if (asked & 2) expect_close(&got, &want, &size, s->rows, s->rows * s->dim);
    if (asked & 4) expect_close(&got, &want, &size, s->rows * (s->dim + 1), s->rows);
    free(got.rho);
  }
  free(want.rho);
  free(size.rho);
  sph_rhs_destroy(rhs);
}

static void test_against_operators(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++)
    for (unsigned terms = 1; terms < 8; terms++)
      for (int32_t smoothing = 1; smoothing <= 3; smoothing++) {
        uint32_t flavour = RH_VARY_ALL | (terms % 2 ? RH_GHOSTS : 0);
        rh_system s = make_system(ctx, dim, flavour, terms != 3);
        check_rates(&s, terms, smoothing);
        rh_free(&s);
      }
  sph_context_destroy(ctx);
}

/* Beside terms of the other loop, all add up. */
static void test_beside_others(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = make_system(ctx, 2, RH_VARY_ALL, 1);
  sph_rhs *both = make_rhs(&s, SMOOTHED, SPH_SMOOTHING_NUMBER);
  sph_rhs *first = make_rhs(&s, SMOOTHED, SPH_SMOOTHING_NUMBER), *second = rh_rhs(&s);
  sph_term t = rh_term(SPH_TERM_MONAGHAN, 0, 0), g = rh_term(SPH_TERM_BODY_FORCE, 0, 0);
  check_ok(sph_rhs_add(both, &t));
  check_ok(sph_rhs_add(both, &g));
  check_ok(sph_rhs_add(second, &t));
  check_ok(sph_rhs_add(second, &g));
  double *all = rh_rates(&s, both, SPH_FIELD_V), *a = rh_rates(&s, first, SPH_FIELD_V);
  double *b = rh_rates(&s, second, SPH_FIELD_V), most = rh_largest(all, s.rows * 2);
  for (int64_t k = 0; k < s.rows * 2; k++) assert_true(fabs(all[k] - a[k] - b[k]) <= 1e-14 * most);
  free(all);
  free(a);
  free(b);
  sph_rhs_destroy(both);
  sph_rhs_destroy(first);
  sph_rhs_destroy(second);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* --- the velocity gradient of the materials ------------------------------------------------ */

/* A law that hands back the symmetric part of L. */
static int32_t strain_rate(void *user, const sph_material_block *b, double *out) {
  const int d = b->dim, c = d * (d + 1) / 2;
  (void)user;
  for (int64_t i = 0; i < b->n; i++)
    for (int r = 0; r < d; r++)
      for (int k = r; k < d; k++)
        out[i * c + rh_sym(d, r, k)] = 0.5 * (b->velocity_gradient[(i * d + r) * d + k] +
                                              b->velocity_gradient[(i * d + k) * d + r]);
  return 0;
}

static sph_material *strain_law(sph_context *ctx) {
  sph_material_functions f;
  sph_material *law = NULL;
  sph_material_functions_init(&f);
  f.stress_rate = strain_rate;
  check_ok(sph_material_create(ctx, &f, NULL, &law));
  return law;
}

static void expect_gradient(const rh_system *s, const double *rate, const double *L) {
  const int d = s->dim, c = d * (d + 1) / 2;
  double most = rh_largest(L, s->rows * d * d);
  for (int64_t i = 0; i < s->rows; i++)
    for (int r = 0; r < d; r++)
      for (int k = 0; k < d; k++) {
        double want = 0.5 * (L[(i * d + r) * d + k] + L[(i * d + k) * d + r]);
        assert_true(fabs(rate[i * c + rh_sym(d, r, k)] - want) <= 1e-12 * most);
      }
}

/* Adds 1 to L_00. */
static void more_gradient(void *user, const sph_pair_block *b, double *out) {
  int64_t *last = (int64_t *)user;
  if (last[b->i] == 0) out[0] += 1.0;
  last[b->i] = 1;
}

static void test_velocity_gradient(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_material *law = strain_law(ctx);
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int corrected = 0; corrected < 2; corrected++) {
      rh_system s = make_system(ctx, dim, RH_VARY_ALL | RH_GHOSTS, 1);
      sph_rhs *rhs = make_rhs(&s, STRESS, 0);
      sph_term t = rh_term(SPH_TERM_STRESS_RATE, 0, corrected);
      double *L = rh_array(s.n * dim * dim), *matrix = rh_array(s.n * dim * dim);
      int64_t *seen = (int64_t *)calloc((size_t)s.n, sizeof *seen);
      assert_non_null(seen);
      check_ok(sph_rhs_add(rhs, &t));
      check_ok(sph_rhs_set_material(rhs, 0, law));
      sph_operands a = rh_operands(&s, corrected ? matrix : NULL);
      if (corrected)
        check_ok(sph_velocity_gradient(s.list, s.kernel, &a, L));
      else
        check_ok(sph_smoothed_stress(s.list, s.kernel, &a, NULL, NULL, L));
      double *rate = rh_rates(&s, rhs, SPH_FIELD_SIGMA);
      expect_gradient(&s, rate, L);
      free(rate);
      check_ok(sph_rhs_add_host(rhs, SPH_TARGET_VELOCITY_GRADIENT, more_gradient, seen));
      rate = rh_rates(&s, rhs, SPH_FIELD_SIGMA);
      for (int64_t i = 0; i < s.rows; i++) L[i * dim * dim] += (double)seen[i];
      expect_gradient(&s, rate, L);
      free(rate);
      free(L);
      free(matrix);
      free(seen);
      sph_rhs_destroy(rhs);
      rh_free(&s);
    }
  sph_material_destroy(law);
  sph_context_destroy(ctx);
}

/* --- memory ---------------------------------------------------------------------------------- */

/* All terms with a stress rate; a second call has what it needs. */
static sph_status scenario(sph_context *ctx, void *user) {
  sph_term t = rh_term(SPH_TERM_STRESS_RATE, 0, 0);
  double *out = (double *)user;
  oom_pause();
  rh_system s = make_system(ctx, 2, RH_VARY_ALL, 1);
  sph_rhs *rhs = make_rhs(&s, SMOOTHED | STRESS | LOSS, SPH_SMOOTHING_NUMBER);
  sph_material *law = strain_law(ctx);
  const sph_rate list[] = {
      {SPH_FIELD_V, out}, {SPH_FIELD_SIGMA, out + 1000}, {SPH_FIELD_E, out + 2000}};
  check_ok(sph_rhs_add(rhs, &t));
  check_ok(sph_rhs_set_material(rhs, 0, law));
  oom_resume();
  sph_status status = sph_rhs_evaluate(rhs, s.set, s.list, 0.0, list, 3);
  oom_pause();
  int64_t allocations = oom.allocations;
  if (!status) check_ok(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, list, 3));
  assert_int_equal(oom.allocations, allocations);
  sph_material_destroy(law);
  sph_rhs_destroy(rhs);
  rh_free(&s);
  oom_resume();
  return status;
}

static void test_memory(void **state) {
  static double out[3000];
  (void)state;
  oom_sweep(scenario, out);
}

/* --- refusals -------------------------------------------------------------------------------- */

static void refused(sph_context *ctx, sph_status got, const char *words) {
  check_status(got, SPH_ERR_ARG);
  if (strstr(sph_context_last_error(ctx), words) == NULL)
    fail_msg("\"%s\" is not in \"%s\"", words, sph_context_last_error(ctx));
}

static void test_term_refusals(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = make_system(ctx, 2, RH_VARY_ALL, 0);
  sph_rhs *rhs = rh_rhs(&s);
  sph_dissipation z = losses();
  sph_term t = rh_term(SPH_TERM_SMOOTHED, 4, 0);
  refused(ctx, sph_rhs_add(rhs, &t), "form 4");
  t = rh_term(SPH_TERM_SMOOTHED, 0, 1);
  refused(ctx, sph_rhs_add(rhs, &t), "corrected");
  t = rh_term(SPH_TERM_SMOOTHED_STRESS, 1, 0);
  refused(ctx, sph_rhs_add(rhs, &t), "no form 1");
  t = rh_term(SPH_TERM_DISSIPATION, 0, 0);
  t.dissipation = &z;
  z.viscosity = -1.0;
  refused(ctx, sph_rhs_add(rhs, &t), "viscosity -1");
  z = losses();
  z.pairs = 3;
  refused(ctx, sph_rhs_add(rhs, &t), "pairs 3");
  z = losses();
  z.mass_flux_b = NAN;
  refused(ctx, sph_rhs_add(rhs, &t), "mass_flux_b nan");
  t.dissipation = NULL; /* none of these was added: the defaults are */
  check_ok(sph_rhs_add(rhs, &t));
  refused(ctx, sph_rhs_add(rhs, &t), "already");
  sph_rhs_destroy(rhs);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* A set that lacks one of the fields. */
static rh_system set_without(sph_context *ctx, int32_t missing) {
  static const int32_t fields[] = {SPH_FIELD_V, SPH_FIELD_M, SPH_FIELD_RHO, SPH_FIELD_H,
                                   SPH_FIELD_P, SPH_FIELD_C, SPH_FIELD_E,   SPH_FIELD_SIGMA};
  rh_system s = {.ctx = ctx, .dim = 1, .n = 20, .rows = 20};
  sph_particles_options o;
  sph_particles_options_init(&o);
  o.dim = 1;
  rh_seed = 3;
  check_ok(sph_particles_create(ctx, &o, &s.set));
  check_ok(sph_particles_add(s.set, s.n, NULL));
  check_ok(sph_kernel_create(ctx, SPH_KERNEL_CUBIC_SPLINE, 1, &s.kernel));
  rh_make_list(&s, 20.0, 0);
  rh_place(&s, 20);
  for (int k = 0; k < 8; k++)
    if (fields[k] != missing) rh_fill(&s, fields[k], 1.0, 1.5, fields[k] != SPH_FIELD_H);
  return s;
}

static void test_missing_fields(void **state) {
  (void)state;
  static const struct {
    int32_t field;
    const char *name;
    unsigned terms; /* that need it */
  } rows[] = {{SPH_FIELD_V, "field v", 7},
              {SPH_FIELD_M, "field m", 7},
              {SPH_FIELD_RHO, "field rho", 7},
              {SPH_FIELD_P, "field p", SMOOTHED | LOSS},
              {SPH_FIELD_C, "field c", LOSS},
              {SPH_FIELD_E, "field e", LOSS},
              {SPH_FIELD_SIGMA, "field sigma", STRESS}};
  sph_context *ctx = rh_context(1);
  double rho[20], v[20], e[20];
  const sph_rate list[] = {{SPH_FIELD_V, v}, {SPH_FIELD_RHO, rho}, {SPH_FIELD_E, e}};
  for (int k = 0; k < 7; k++)
    for (unsigned term = 1; term < 8; term *= 2) {
      rh_system s = set_without(ctx, rows[k].field);
      sph_rhs *rhs = make_rhs(&s, term, 0);
      sph_status status = sph_rhs_evaluate(rhs, s.set, s.list, 0.0, list, 3);
      if (rows[k].terms & term)
        refused(ctx, status, rows[k].name);
      else
        check_ok(status);
      sph_rhs_destroy(rhs);
      rh_free(&s);
    }
  sph_context_destroy(ctx);
}

static void test_list_refused(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 1, 30, RH_VARY_ALL, 5); /* rule ARITHMETIC */
  sph_rhs *rhs = make_rhs(&s, SMOOTHED, 0);
  double v[30];
  sph_rate rate = {SPH_FIELD_V, v};
  refused(ctx, sph_rhs_evaluate(rhs, s.set, s.list, 0.0, &rate, 1), "larger h");
  rh_fill(&s, SPH_FIELD_H, 1.2, 1.4, 0); /* the same everywhere: any rule will do */
  check_ok(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, &rate, 1));
  sph_rhs_destroy(rhs);
  rh_free(&s);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(test_against_operators),
                                          cmocka_unit_test(test_beside_others),
                                          cmocka_unit_test(test_velocity_gradient),
                                          cmocka_unit_test(test_term_refusals),
                                          cmocka_unit_test(test_memory),
                                          cmocka_unit_test(test_missing_fields),
                                          cmocka_unit_test(test_list_refused)};
SPH_TEST_MAIN(tests)
