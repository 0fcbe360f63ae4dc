/* Composed right-hand side: hooks, ghosts, lists that are updated or not, the frozen
 * configuration, small and empty sets. */
#include "../rhs_help.h"

typedef struct hook_log {
  int32_t prepared, finished, answer_prepare, answer_finish;
  double t;
  sph_particles *set;
  const sph_rate *rates;
  int32_t count;
} hook_log;

static int32_t on_prepare(void *user, double t, sph_particles *set, const sph_rate *rates,
                          int32_t count) {
  hook_log *h = (hook_log *)user;
  assert_int_equal(h->prepared, h->finished);
  h->prepared++;
  h->t = t;
  h->set = set;
  h->rates = rates;
  h->count = count;
  return h->answer_prepare;
}

static int32_t on_finish(void *user, double t, sph_particles *set, const sph_rate *rates,
                         int32_t count) {
  hook_log *h = (hook_log *)user;
  assert_true(h->t == t && h->set == set && h->rates == rates && h->count == count);
  h->finished++;
  if (count > 0 && rates[0].field == SPH_FIELD_V) rates[0].values[0] = 42.0; /* a driven particle */
  return h->answer_finish;
}

static void test_hooks(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 1, 30, 0, 2);
  sph_rhs *rhs = rh_rhs(&s);
  sph_term t = rh_term(SPH_TERM_BODY_FORCE, 0, 0);
  hook_log h = {0};
  double v[30], rho[30];
  sph_rate rates[2] = {{SPH_FIELD_V, v}, {SPH_FIELD_RHO, rho}};
  check_ok(sph_rhs_add(rhs, &t));
  check_ok(sph_rhs_set_prepare(rhs, on_prepare, &h));
  check_ok(sph_rhs_set_finish(rhs, on_finish, &h));
  check_ok(sph_rhs_evaluate(rhs, s.set, s.list, 3.75, rates, 2));
  assert_true(h.prepared == 1 && h.finished == 1);
  assert_true(h.t == 3.75 && h.set == s.set && h.count == 2 && h.rates == rates);
  assert_true(v[0] == 42.0 && v[1] == t.vector[0] && rho[0] == 0.0);
  check_ok(sph_rhs_evaluate(rhs, s.set, s.list, -1.0, NULL, 0));
  assert_true(h.prepared == 2 && h.finished == 2 && h.count == 0);
  check_ok(sph_rhs_set_finish(rhs, NULL, NULL));
  check_ok(sph_rhs_set_prepare(rhs, NULL, NULL));
  check_ok(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, rates, 2));
  assert_true(h.prepared == 2 && h.finished == 2 && v[0] == t.vector[0]);
  check_status(sph_rhs_set_prepare(NULL, on_prepare, &h), SPH_ERR_ARG);
  check_status(sph_rhs_set_finish(NULL, on_finish, &h), SPH_ERR_ARG);
  check_status(sph_rhs_set_prepare((sph_rhs *)ctx, on_prepare, &h), SPH_ERR_HANDLE);
  check_status(sph_rhs_set_finish((sph_rhs *)ctx, on_finish, &h), SPH_ERR_HANDLE);
  sph_rhs_destroy(rhs);
  rh_free(&s);
  sph_context_destroy(ctx);
}

static void test_hook_answers(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 1, 30, 0, 2);
  sph_rhs *rhs = rh_rhs(&s);
  hook_log h = {0};
  check_ok(sph_rhs_set_prepare(rhs, on_prepare, &h));
  check_ok(sph_rhs_set_finish(rhs, on_finish, &h));
  h.answer_prepare = 5;
  check_status(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, NULL, 0), SPH_RETRY);
  h.answer_prepare = -5;
  h.finished = h.prepared; /* the other hook was not called, as it should be */
  check_status(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, NULL, 0), SPH_ERR_CALLBACK);
  assert_non_null(strstr(sph_context_last_error(ctx), "prepare"));
  assert_non_null(strstr(sph_context_last_error(ctx), "-5"));
  h.answer_prepare = 0;
  h.finished = h.prepared;
  h.answer_finish = 1;
  check_status(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, NULL, 0), SPH_RETRY);
  h.answer_finish = -6;
  check_status(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, NULL, 0), SPH_ERR_CALLBACK);
  assert_non_null(strstr(sph_context_last_error(ctx), "finish"));
  h.answer_finish = 0;
  check_ok(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, NULL, 0));
  sph_rhs_destroy(rhs);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* --- ghosts made by the hook ------------------------------------------------------------- */

typedef struct mirror {
  int32_t count; /* to add each time; alternates with 0 */
  int32_t calls;
} mirror;

/* Mirror the first `count` particles at x = 0. */
static int32_t make_ghosts(void *user, double t, sph_particles *set, const sph_rate *rates,
                           int32_t count) {
  static const int32_t fields[] = {SPH_FIELD_X, SPH_FIELD_V, SPH_FIELD_M, SPH_FIELD_RHO,
                                   SPH_FIELD_H, SPH_FIELD_P, SPH_FIELD_C, SPH_FIELD_SIGMA};
  mirror *m = (mirror *)user;
  int64_t first;
  int32_t k = m->calls++ % 2 ? 0 : m->count;
  (void)t;
  (void)rates;
  (void)count;
  if (sph_particles_clear_ghosts(set) || sph_particles_add_ghosts(set, k, &first)) return -1;
  for (int f = 0; f < 8; f++) {
    double *a;
    if (sph_particles_field(set, fields[f], &a)) return -2;
    int32_t c = sph_particles_components(set, fields[f]);
    memcpy(a + first * c, a, (size_t)(k * c) * sizeof *a);
    if (fields[f] <= SPH_FIELD_V)
      for (int64_t i = first; i < first + k; i++) a[i * c] = -a[i * c];
  }
  return sph_particles_touch(set, SPH_FIELD_X);
}

/* Ghosts that the hook makes act at once, and those it takes away act no more. */
static void test_ghosts_from_hook(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++) {
    rh_system s = rh_make(ctx, dim, rh_side(dim), RH_VARY_ALL, 11);
    sph_rhs *rhs = rh_rhs(&s), *bare = rh_rhs(&s);
    mirror m = {.count = 5};
    sph_term t = rh_term(SPH_TERM_PRESSURE, 0, 1);
    check_ok(sph_rhs_add(rhs, &t));
    check_ok(sph_rhs_add(bare, &t));
    check_ok(sph_rhs_set_prepare(rhs, make_ghosts, &m));
    double *with = rh_rates(&s, rhs, SPH_FIELD_V);
    assert_int_equal(sph_particles_count(s.set), s.rows + 5);
    assert_int_equal(sph_neighbors_count(s.list), s.rows + 5);
    double *again = rh_rates(&s, bare, SPH_FIELD_V);
    assert_memory_equal(with, again, (size_t)(s.rows * dim) * sizeof *with);
    double *without = rh_rates(&s, rhs, SPH_FIELD_V);
    assert_int_equal(sph_particles_count(s.set), s.rows);
    rh_operator(&s, &t, again);
    assert_memory_not_equal(with, without, (size_t)(s.rows * dim) * sizeof *with);
    double size = rh_largest(again, s.rows * dim);
    for (int64_t k = 0; k < s.rows * dim; k++) check_close(without[k], again[k], 1e-13 * size);
    free(with);
    free(without);
    free(again);
    sph_rhs_destroy(rhs);
    sph_rhs_destroy(bare);
    rh_free(&s);
  }
  sph_context_destroy(ctx);
}

static int32_t add_real(void *user, double t, sph_particles *set, const sph_rate *rates,
                        int32_t count) {
  (void)user;
  (void)t;
  (void)rates;
  (void)count;
  return sph_particles_add(set, 1, NULL);
}

/* More real particles than the rates have room for. */
static void test_hook_adds_real(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 1, 30, 0, 2);
  sph_rhs *rhs = rh_rhs(&s);
  double *v = rh_array(30);
  sph_rate rate = {SPH_FIELD_V, v};
  check_ok(sph_rhs_set_prepare(rhs, add_real, NULL));
  check_status(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, &rate, 1), SPH_ERR_STATE);
  assert_non_null(strstr(sph_context_last_error(ctx), "31"));
  free(v);
  sph_rhs_destroy(rhs);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* --- lists ------------------------------------------------------------------------------- */

static sph_rhs *with_options(const rh_system *s, int32_t field, int32_t update) {
  sph_rhs_options o;
  sph_rhs *rhs = NULL;
  sph_term t = rh_term(SPH_TERM_STRESS, 0, 0);
  sph_rhs_options_init(&o);
  o.position_field = field;
  o.update_list = update;
  check_ok(sph_rhs_create(s->ctx, s->kernel, &o, &rhs));
  check_ok(sph_rhs_add(rhs, &t));
  return rhs;
}

static sph_status ask(const rh_system *s, sph_rhs *rhs) {
  double *v = rh_array(s->rows * s->dim);
  sph_rate rate = {SPH_FIELD_V, v};
  sph_status status = sph_rhs_evaluate(rhs, s->set, s->list, 0.0, &rate, 1);
  free(v);
  return status;
}

static void move(const rh_system *s, double by) {
  rh_field(s, SPH_FIELD_X)[0] += by;
  check_ok(sph_particles_touch(s->set, SPH_FIELD_X));
}

/* update_list 1: the list follows. 0: a set that moved, grew or changed h is refused. */
static void test_update_list(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, 8, 0, 2);
  sph_rhs *follow = with_options(&s, SPH_FIELD_X, 1), *fixed = with_options(&s, SPH_FIELD_X, 0);
  int64_t builds = sph_neighbors_builds(s.list);
  check_ok(ask(&s, fixed));
  check_ok(ask(&s, follow));
  assert_int_equal(sph_neighbors_builds(s.list), builds);
  move(&s, 0.1);
  check_status(ask(&s, fixed), SPH_ERR_STALE);
  check_ok(ask(&s, follow));
  assert_int_equal(sph_neighbors_builds(s.list), builds + 1);
  check_ok(ask(&s, fixed));
  rh_field(&s, SPH_FIELD_H)[3] *= 1.5;
  check_ok(sph_particles_touch(s.set, SPH_FIELD_H));
  check_status(ask(&s, fixed), SPH_ERR_STALE);
  check_ok(sph_neighbors_update(s.list, s.set, NULL));
  check_ok(ask(&s, fixed));
  check_ok(sph_particles_touch(s.set, SPH_FIELD_V)); /* no matter for the list */
  check_ok(ask(&s, fixed));
  check_ok(sph_particles_add_ghosts(s.set, 1, NULL));
  rh_field(&s, SPH_FIELD_H)[64] = 1.0;
  rh_field(&s, SPH_FIELD_M)[64] = rh_field(&s, SPH_FIELD_RHO)[64] = 1.0;
  check_status(ask(&s, fixed), SPH_ERR_ARG); /* the list is of 64 */
  sph_rhs_destroy(follow);
  sph_rhs_destroy(fixed);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* Never built; built from arrays, of the right and of a wrong count; built for another set. */
static void test_foreign_lists(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, 8, 0, 2), other = rh_make(ctx, 2, 8, 0, 3);
  sph_rhs *fixed = with_options(&s, SPH_FIELD_X, 0), *follow = with_options(&s, SPH_FIELD_X, 1);
  const double *x = rh_field(&s, SPH_FIELD_X), *h = rh_field(&s, SPH_FIELD_H);
  sph_neighbors_destroy(s.list);
  check_ok(sph_neighbors_create(ctx, NULL, &s.list));
  check_status(ask(&s, fixed), SPH_ERR_STATE);
  check_ok(sph_neighbors_build_arrays(s.list, 2, 64, x, h, 0.0));
  check_ok(ask(&s, fixed));
  check_ok(sph_neighbors_build_arrays(s.list, 2, 63, x, h, 0.0));
  check_status(ask(&s, fixed), SPH_ERR_ARG);
  check_ok(sph_neighbors_build(s.list, other.set));
  check_status(ask(&s, fixed), SPH_ERR_STALE);
  check_ok(ask(&s, follow));
  check_ok(ask(&s, fixed));
  sph_rhs_destroy(fixed);
  sph_rhs_destroy(follow);
  rh_free(&s);
  rh_free(&other);
  sph_context_destroy(ctx);
}

/* The pairs are those of X0; that X moves changes neither list nor rates. */
static void test_frozen(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, 9, 0, 2);
  sph_rhs *frozen = with_options(&s, SPH_FIELD_X0, 1), *moving = with_options(&s, SPH_FIELD_X, 1);
  check_status(ask(&s, frozen), SPH_ERR_ARG);
  assert_non_null(strstr(sph_context_last_error(ctx), "x0"));
  double *x0 = rh_field(&s, SPH_FIELD_X0);
  memcpy(x0, rh_field(&s, SPH_FIELD_X), (size_t)(s.n * 2) * sizeof *x0);
  double *want = rh_rates(&s, moving, SPH_FIELD_V), *first = rh_rates(&s, frozen, SPH_FIELD_V);
  int64_t builds = sph_neighbors_builds(s.list);
  for (int k = 0; k < 20; k++) move(&s, 0.3);
  double *later = rh_rates(&s, frozen, SPH_FIELD_V);
  assert_int_equal(sph_neighbors_builds(s.list), builds);
  assert_memory_equal(first, want, (size_t)(s.rows * 2) * sizeof *want);
  assert_memory_equal(later, want, (size_t)(s.rows * 2) * sizeof *want);
  x0[0] += 0.1;
  check_ok(sph_particles_touch(s.set, SPH_FIELD_X0));
  double *moved = rh_rates(&s, frozen, SPH_FIELD_V);
  assert_memory_not_equal(moved, want, (size_t)(s.rows * 2) * sizeof *want);
  sph_rhs *fixed = with_options(&s, SPH_FIELD_X0, 0);
  check_ok(ask(&s, fixed));
  free(want);
  free(first);
  free(later);
  free(moved);
  sph_rhs_destroy(fixed);
  sph_rhs_destroy(frozen);
  sph_rhs_destroy(moving);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* Host terms see the frozen pairs, too. */
static void frozen_pairs(void *user, const sph_pair_block *b, double *out) {
  (void)user;
  for (int32_t k = 0; k < b->count; k++) out[0] += b->w[k];
}

static void test_frozen_host_term(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, 9, 0, 2);
  sph_rhs *frozen = with_options(&s, SPH_FIELD_X0, 1);
  memcpy(rh_field(&s, SPH_FIELD_X0), rh_field(&s, SPH_FIELD_X), (size_t)(s.n * 2) * 8);
  check_ok(sph_rhs_add_host(frozen, SPH_FIELD_E, frozen_pairs, NULL));
  double *a = rh_rates(&s, frozen, SPH_FIELD_E);
  move(&s, 3.0);
  double *b = rh_rates(&s, frozen, SPH_FIELD_E);
  assert_memory_equal(a, b, (size_t)s.rows * sizeof *a);
  assert_true(a[0] > 0.0);
  free(a);
  free(b);
  sph_rhs_destroy(frozen);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* --- small sets -------------------------------------------------------------------------- */

static sph_rhs *everything(const rh_system *s) {
  sph_rhs *rhs = rh_rhs(s);
  for (int32_t kind = 1; kind <= SPH_TERM_ARTIFICIAL_STRESS; kind++) {
    sph_term t = rh_term(kind, 0, rh_correctable(kind, 1));
    if (kind != SPH_TERM_STRESS_RATE) check_ok(sph_rhs_add(rhs, &t));
  }
  check_ok(sph_rhs_add_host(rhs, SPH_FIELD_V, frozen_pairs, NULL));
  return rhs;
}

/* No particles; only ghosts, which get no rates: nothing is written, NULL arrays will do. */
static void test_nobody(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int ghosts = 0; ghosts < 2; ghosts++) {
      rh_system s = rh_make(ctx, dim, 3, 0, 2);
      sph_rhs *rhs = everything(&s);
      double guard[3] = {7.0, 7.0, 7.0};
      sph_rate rates[3] = {{SPH_FIELD_V, guard}, {SPH_FIELD_RHO, NULL}, {SPH_FIELD_X, guard + 1}};
      int64_t *all = (int64_t *)malloc(sizeof *all * (size_t)s.n);
      assert_non_null(all);
      for (int64_t i = 0; i < s.n; i++) all[i] = i;
      check_ok(sph_particles_remove(s.set, s.n, all));
      free(all);
      if (ghosts) {
        check_ok(sph_particles_add_ghosts(s.set, 2, NULL));
        for (int32_t f = SPH_FIELD_X; f <= SPH_FIELD_SIGMA; f++) {
          int32_t c = sph_particles_components(s.set, f);
          for (int32_t k = 0; k < 2 * c; k++) rh_field(&s, f)[k] = 1.0 + 0.1 * k;
        }
      }
      check_ok(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, rates, 3));
      assert_true(guard[0] == 7.0 && guard[1] == 7.0 && guard[2] == 7.0);
      sph_rhs_destroy(rhs);
      rh_free(&s);
    }
  sph_context_destroy(ctx);
}

/* One particle alone, and two at one place: finite, and only what needs no neighbour. */
static void test_lonely(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int64_t n = 1; n <= 2; n++) {
      rh_system s = rh_make(ctx, dim, 2, 0, 2);
      sph_rhs *rhs = everything(&s);
      int64_t drop[8];
      for (int64_t i = n; i < s.n; i++) drop[i - n] = i;
      check_ok(sph_particles_remove(s.set, s.n - n, drop));
      s.n = s.rows = n;
      double *x = rh_field(&s, SPH_FIELD_X);
      for (int64_t k = 0; k < n * dim; k++) x[k] = 0.5;
      check_ok(sph_particles_touch(s.set, SPH_FIELD_X));
      double v[6], rho[2], dx[6];
      sph_rate rates[3] = {{SPH_FIELD_V, v}, {SPH_FIELD_RHO, rho}, {SPH_FIELD_X, dx}};
      check_ok(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, rates, 3));
      sph_term force = rh_term(SPH_TERM_BODY_FORCE, 0, 0);
      const double *velocity = rh_field(&s, SPH_FIELD_V);
      for (int64_t i = 0; i < n; i++) {
        assert_true(rho[i] == 0.0);
        for (int k = 0; k < dim; k++) {
          assert_true(isfinite(dx[i * dim + k]));
          if (n == 1) assert_true(dx[k] == velocity[k]);
          if (n == 1 || k > 0) check_close(v[i * dim + k], force.vector[k], 0.0);
        }
      }
      sph_rhs_destroy(rhs);
      rh_free(&s);
    }
  sph_context_destroy(ctx);
}

/* A NaN or infinite position is refused with the sentence of the list, and nothing is lost. */
static void test_bad_positions(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, 6, 0, 2);
  sph_rhs *rhs = with_options(&s, SPH_FIELD_X, 1);
  double *x = rh_field(&s, SPH_FIELD_X), kept = x[7];
  for (int k = 0; k < 2; k++) {
    x[7] = k ? NAN : INFINITY;
    check_ok(sph_particles_touch(s.set, SPH_FIELD_X));
    check_status(ask(&s, rhs), SPH_ERR_ARG);
    assert_non_null(strstr(sph_context_last_error(ctx), "3")); /* particle 3 */
  }
  x[7] = kept;
  check_ok(sph_particles_touch(s.set, SPH_FIELD_X));
  check_ok(ask(&s, rhs));
  sph_rhs_destroy(rhs);
  rh_free(&s);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_hooks),
    cmocka_unit_test(test_hook_answers),
    cmocka_unit_test(test_ghosts_from_hook),
    cmocka_unit_test(test_hook_adds_real),
    cmocka_unit_test(test_update_list),
    cmocka_unit_test(test_foreign_lists),
    cmocka_unit_test(test_frozen),
    cmocka_unit_test(test_frozen_host_term),
    cmocka_unit_test(test_nobody),
    cmocka_unit_test(test_lonely),
    cmocka_unit_test(test_bad_positions),
};
SPH_TEST_MAIN(tests)
