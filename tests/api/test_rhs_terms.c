/* Composed right-hand side, term by term: each term alone gives what its operator gives, any list
 * of terms the sum of its operators. */
#include "../rhs_help.h"

/* The stress rate needs a material and has tests of its own. */
static const int32_t kinds[] = {
    SPH_TERM_CONTINUITY,     SPH_TERM_PRESSURE,   SPH_TERM_STRESS,
    SPH_TERM_MONAGHAN,       SPH_TERM_XSPH,       SPH_TERM_MOTION,
    SPH_TERM_BULK_VISCOSITY, SPH_TERM_BODY_FORCE, SPH_TERM_ARTIFICIAL_STRESS};
enum { KINDS = sizeof kinds / sizeof *kinds, FLAVOURS = 7 };

static const uint32_t flavours[FLAVOURS] = {
    0, RH_VARY_M, RH_VARY_H, RH_VARY_C, RH_VARY_ALL, RH_GHOSTS, RH_VARY_ALL | RH_GHOSTS};

static int64_t length(const rh_system *s, int32_t kind) {
  return s->rows * sph_particles_components(s->set, rh_target(kind));
}

/* One list of terms against the sum of their operators, in the largest norm. */
static void compare(const rh_system *s, const sph_term *terms, int count, int32_t target,
                    double tol) {
  sph_rhs *rhs = rh_rhs(s);
  int64_t n = s->rows * sph_particles_components(s->set, target);
  double *want = rh_array(n), *one = rh_array(n), size = 0.0;
  for (int64_t k = 0; k < n; k++) want[k] = 0.0;
  for (int t = 0; t < count; t++) {
    check_ok(sph_rhs_add(rhs, &terms[t]));
    if (rh_target(terms[t].kind) != target) continue;
    rh_operator(s, &terms[t], one);
    size += rh_largest(one, n);
    for (int64_t k = 0; k < n; k++) want[k] += one[k];
  }
  double *got = rh_rates(s, rhs, target);
  for (int64_t k = 0; k < n; k++) {
    if (fabs(got[k] - want[k]) <= tol * size) continue;
    for (int t = 0; t < count; t++)
      print_error("kind %d form %d corrected %d\n", terms[t].kind, terms[t].form,
                  terms[t].corrected);
    fail_msg("%d-D, field %d, entry %d: %.17g, not %.17g (size %g)", s->dim, target, (int)k, got[k],
             want[k], size);
  }
  free(want);
  free(one);
  free(got);
  sph_rhs_destroy(rhs);
}

/* Terms that are nothing but their operator have its bits; the artificial stress has a formula of
 * the test's own to meet. */
static void check_alone(const rh_system *s, const sph_term *t) {
  int64_t n = length(s, t->kind);
  if (t->kind == SPH_TERM_ARTIFICIAL_STRESS) {
    compare(s, t, 1, SPH_FIELD_V, 1e-13);
    return;
  }
  sph_rhs *rhs = rh_rhs(s);
  double *want = rh_array(n);
  check_ok(sph_rhs_add(rhs, t));
  rh_operator(s, t, want);
  double *got = rh_rates(s, rhs, rh_target(t->kind));
  if (memcmp(got, want, (size_t)n * sizeof *got) != 0) compare(s, t, 1, rh_target(t->kind), 1e-13);
  assert_true(rh_largest(got, n) > 1e-3); /* something was there to compare */
  free(got);
  free(want);
  sph_rhs_destroy(rhs);
}

static void check_all_alone(sph_context *ctx, int32_t dim, uint32_t flavour) {
  rh_system s = rh_make(ctx, dim, rh_side(dim), flavour, 7 + flavour);
  for (int k = 0; k < KINDS; k++)
    for (int32_t form = 0; form <= rh_forms(kinds[k]); form++)
      for (int32_t c = 0; c <= rh_correctable(kinds[k], form); c++) {
        sph_term t = rh_term(kinds[k], form, c);
        check_alone(&s, &t);
      }
  rh_free(&s);
}

static void test_alone(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int f = 0; f < FLAVOURS; f++) check_all_alone(ctx, dim, flavours[f]);
  sph_context_destroy(ctx);
}

/* Form 0 is the first one. */
static void test_form_zero(void **state) {
  (void)state;
  static const int32_t with_forms[] = {SPH_TERM_CONTINUITY, SPH_TERM_PRESSURE, SPH_TERM_STRESS};
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, 9, RH_VARY_M, 3);
  for (int k = 0; k < 3; k++) {
    sph_term zero = rh_term(with_forms[k], 0, 0), one = rh_term(with_forms[k], 1, 0);
    sph_rhs *a = rh_rhs(&s), *b = rh_rhs(&s);
    check_ok(sph_rhs_add(a, &zero));
    check_ok(sph_rhs_add(b, &one));
    double *x = rh_rates(&s, a, rh_target(zero.kind)), *y = rh_rates(&s, b, rh_target(zero.kind));
    assert_memory_equal(x, y, (size_t)length(&s, zero.kind) * sizeof *x);
    free(x);
    free(y);
    sph_rhs_destroy(a);
    sph_rhs_destroy(b);
  }
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* A random list: some kinds, in random order, with random forms. */
static int draw(sph_term *terms, int32_t corrected) {
  int count = 0;
  int32_t start = rh_choice(KINDS);
  for (int k = 0; k < KINDS; k++) {
    int32_t kind = kinds[(start + k * 2) % KINDS]; /* 2 and the number of kinds are coprime */
    int32_t form = rh_choice(rh_forms(kind) + 1);
    int32_t c = corrected < 0 ? rh_choice(2) : corrected;
    if (rh_choice(2)) continue;
    terms[count++] = rh_term(kind, form, c && rh_correctable(kind, form));
  }
  return count;
}

static void check_sums(int32_t corrected) {
  static const int32_t targets[] = {SPH_FIELD_RHO, SPH_FIELD_V, SPH_FIELD_X};
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int f = 0; f < FLAVOURS; f++) {
      rh_system s = rh_make(ctx, dim, rh_side(dim), flavours[f], 70 + (uint64_t)f);
      for (int trial = 0; trial < (check_long_run ? 200 : 12); trial++) {
        sph_term terms[KINDS];
        int count = draw(terms, corrected);
        for (int t = 0; t < 3; t++) compare(&s, terms, count, targets[t], 1e-12);
      }
      rh_free(&s);
    }
  sph_context_destroy(ctx);
}

static void test_sums_plain(void **state) {
  (void)state;
  check_sums(0);
}

static void test_sums_corrected(void **state) {
  (void)state;
  check_sums(1);
}

/* Some terms corrected, others not. */
static void test_sums_mixed(void **state) {
  (void)state;
  check_sums(-1);
}

/* What the loop has an instance of its own for, and neighbours of those lists. */
static void test_usual_lists(void **state) {
  (void)state;
  static const int32_t lists[][4] = {
      {SPH_TERM_CONTINUITY, SPH_TERM_PRESSURE, SPH_TERM_MONAGHAN, 0},
      {SPH_TERM_STRESS, SPH_TERM_MONAGHAN, 0, 0},
      {SPH_TERM_STRESS, SPH_TERM_MONAGHAN, SPH_TERM_ARTIFICIAL_STRESS, 0},
      {SPH_TERM_STRESS, SPH_TERM_ARTIFICIAL_STRESS, 0, 0},
      {SPH_TERM_PRESSURE, SPH_TERM_STRESS, SPH_TERM_BODY_FORCE, 0},
      {SPH_TERM_MOTION, SPH_TERM_XSPH, SPH_TERM_CONTINUITY, SPH_TERM_PRESSURE}};
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int f = 0; f < FLAVOURS; f++) {
      rh_system s = rh_make(ctx, dim, rh_side(dim), flavours[f], 170 + (uint64_t)f);
      for (size_t l = 0; l < sizeof lists / sizeof *lists; l++)
        for (int32_t c = 0; c < 2; c++) {
          sph_term terms[4];
          int count = 0;
          for (; count < 4 && lists[l][count]; count++)
            terms[count] =
                rh_term(lists[l][count], 0, c && rh_correctable(lists[l][count], 1) ? 1 : 0);
          compare(&s, terms, count, SPH_FIELD_V, 1e-12);
          compare(&s, terms, count, SPH_FIELD_RHO, 1e-12);
          compare(&s, terms, count, SPH_FIELD_X, 1e-12);
        }
      rh_free(&s);
    }
  sph_context_destroy(ctx);
}

/* A periodic box and other rules of h: the list decides, as for the operators. */
static void test_periodic_and_rules(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t rule = SPH_H_ARITHMETIC; rule <= SPH_H_AVERAGE; rule++)
    for (int32_t dim = 1; dim <= 3; dim++) {
      rh_system s = rh_make(ctx, dim, rh_side(dim), RH_VARY_ALL | RH_WRAP, 33);
      sph_neighbors_options o;
      sph_neighbors_options_init(&o);
      o.h_rule = rule;
      for (int a = 0; a < dim; a++) {
        o.periodic[a] = 1;
        o.box_hi[a] = (double)rh_side(dim);
      }
      sph_neighbors_destroy(s.list);
      s.list = NULL;
      check_ok(sph_neighbors_create(ctx, &o, &s.list));
      check_ok(sph_neighbors_build(s.list, s.set));
      sph_term terms[5] = {rh_term(SPH_TERM_CONTINUITY, 2, 0), rh_term(SPH_TERM_STRESS, 0, 1),
                           rh_term(SPH_TERM_MONAGHAN, 0, 0), rh_term(SPH_TERM_XSPH, 0, 0),
                           rh_term(SPH_TERM_PRESSURE, 3, 0)};
      compare(&s, terms, 5, SPH_FIELD_V, 1e-12);
      compare(&s, terms, 5, SPH_FIELD_RHO, 1e-12);
      compare(&s, terms, 5, SPH_FIELD_X, 1e-12);
      rh_free(&s);
    }
  sph_context_destroy(ctx);
}

/* A Verlet list holds pairs beyond the support: they must not count. */
static void test_skin(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, 12, RH_VARY_M, 12);
  sph_term t = rh_term(SPH_TERM_STRESS, 0, 0);
  sph_rhs *rhs = rh_rhs(&s);
  check_ok(sph_rhs_add(rhs, &t));
  double *want = rh_rates(&s, rhs, SPH_FIELD_V);
  sph_neighbors_options o;
  sph_neighbors_options_init(&o);
  o.method = SPH_NEIGHBORS_VERLET;
  o.skin = 0.7;
  sph_neighbors_destroy(s.list);
  s.list = NULL;
  check_ok(sph_neighbors_create(ctx, &o, &s.list));
  double *got = rh_rates(&s, rhs, SPH_FIELD_V);
  double size = rh_largest(want, s.rows * 2);
  for (int64_t k = 0; k < s.rows * 2; k++) check_close(got[k], want[k], 1e-13 * size);
  free(got);
  free(want);
  sph_rhs_destroy(rhs);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* Three fields at once are as three evaluations. */
static void test_together(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 3, 6, RH_GHOSTS, 4);
  sph_rhs *rhs = rh_rhs(&s);
  sph_term terms[4] = {rh_term(SPH_TERM_CONTINUITY, 0, 0), rh_term(SPH_TERM_PRESSURE, 0, 0),
                       rh_term(SPH_TERM_MOTION, 0, 0), rh_term(SPH_TERM_XSPH, 0, 0)};
  for (int k = 0; k < 4; k++) check_ok(sph_rhs_add(rhs, &terms[k]));
  double *x = rh_array(s.rows * 3), *v = rh_array(s.rows * 3), *rho = rh_array(s.rows);
  sph_rate rates[3] = {{SPH_FIELD_V, v}, {SPH_FIELD_RHO, rho}, {SPH_FIELD_X, x}};
  check_ok(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, rates, 3));
  for (int k = 0; k < 3; k++) {
    int64_t n = s.rows * sph_particles_components(s.set, rates[k].field);
    double *alone = rh_rates(&s, rhs, rates[k].field), size = rh_largest(alone, n);
    for (int64_t i = 0; i < n; i++) check_close(rates[k].values[i], alone[i], 1e-13 * size);
    free(alone);
  }
  free(x);
  free(v);
  free(rho);
  sph_rhs_destroy(rhs);
  rh_free(&s);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_alone),      cmocka_unit_test(test_form_zero),
    cmocka_unit_test(test_sums_plain), cmocka_unit_test(test_sums_corrected),
    cmocka_unit_test(test_sums_mixed), cmocka_unit_test(test_usual_lists),
    cmocka_unit_test(test_skin),       cmocka_unit_test(test_periodic_and_rules),
    cmocka_unit_test(test_together),
};
SPH_TEST_MAIN(tests)
