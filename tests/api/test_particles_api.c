/* Particle sets through the public calls: every call, every refusal with its sentence. */
#include "../check.h"
#include "../oom.h"

#include <sph/sph.h>

static sph_context *make_context(void) {
  sph_context *ctx = NULL;
  check_ok(sph_context_create(NULL, &ctx));
  return ctx;
}

static sph_particles *make_set(sph_context *ctx, int32_t dim, int64_t n) {
  sph_particles_options o;
  sph_particles *set = NULL;
  sph_particles_options_init(&o);
  o.dim = dim;
  check_ok(sph_particles_create(ctx, &o, &set));
  check_ok(sph_particles_add(set, n, NULL));
  return set;
}

static double *field(sph_particles *set, int32_t id) {
  double *values = NULL;
  check_ok(sph_particles_field(set, id, &values));
  assert_non_null(values);
  return values;
}

/* The call fails with this status and a sentence that holds `words`. */
static void refused(sph_context *ctx, sph_status got, sph_status want, const char *words) {
  check_status(got, want);
  if (strstr(sph_context_last_error(ctx), words) == NULL)
    fail_msg("\"%s\" is not in \"%s\"", words, sph_context_last_error(ctx));
}

static void test_options(void **state) {
  (void)state;
  struct {
    sph_particles_options o;
    unsigned char behind[16];
  } guarded;
  memset(&guarded, 0xaa, sizeof guarded);
  sph_particles_options_init(&guarded.o);
  assert_int_equal(guarded.o.size, sizeof guarded.o);
  assert_int_equal(guarded.o.dim, 3);
  assert_int_equal(guarded.o.capacity, 0);
  for (int k = 0; k < 16; k++) assert_int_equal(guarded.behind[k], 0xaa);
  /* a newer caller: the unknown tail is cleared, so that it asks for nothing */
  sph_particles_options_init_sized(&guarded.o, sizeof guarded);
  for (int k = 0; k < 16; k++) assert_int_equal(guarded.behind[k], 0);
  sph_particles_options_init_sized(NULL, 100);
}

static void test_create_refusals(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_particles_options o;
  sph_particles *set = (sph_particles *)ctx;
  check_status(sph_particles_create(NULL, NULL, &set), SPH_ERR_ARG);
  assert_null(set);
  check_status(sph_particles_create(ctx, NULL, NULL), SPH_ERR_ARG);
  const int32_t dims[] = {0, 4, -1};
  for (int k = 0; k < 3; k++) {
    sph_particles_options_init(&o);
    o.dim = dims[k];
    set = (sph_particles *)ctx;
    refused(ctx, sph_particles_create(ctx, &o, &set), SPH_ERR_ARG, "dim is");
    assert_null(set);
  }
  sph_particles_options_init(&o);
  o.capacity = -5;
  refused(ctx, sph_particles_create(ctx, &o, &set), SPH_ERR_ARG, "-5");
  o.capacity = INT64_C(2147483648) - 63;
  refused(ctx, sph_particles_create(ctx, &o, &set), SPH_ERR_LIMIT, "2147483584");
  sph_context_destroy(ctx);
}

static void test_newer_options(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_particles *set = NULL;
  struct {
    sph_particles_options o;
    int64_t unknown;
  } newer;
  memset(&newer, 0, sizeof newer);
  sph_particles_options_init_sized(&newer.o, sizeof newer);
  check_ok(sph_particles_create(ctx, &newer.o, &set));
  sph_particles_destroy(set);
  newer.unknown = 1;
  check_status(sph_particles_create(ctx, &newer.o, &set), SPH_ERR_VERSION);
  assert_null(set);
  sph_context_destroy(ctx);
}

static void test_null_and_wrong_handle(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  double *values = (double *)ctx, lent[3] = {0};
  int64_t index = 0;
  int32_t id = 0;
  for (int wrong = 0; wrong < 2; wrong++) {
    sph_particles *set = wrong ? (sph_particles *)ctx : NULL;
    sph_status want = wrong ? SPH_ERR_HANDLE : SPH_ERR_ARG;
    check_status(sph_particles_reserve(set, 1), want);
    check_status(sph_particles_add(set, 1, NULL), want);
    check_status(sph_particles_add_ghosts(set, 1, NULL), want);
    check_status(sph_particles_clear_ghosts(set), want);
    check_status(sph_particles_remove(set, 1, &index), want);
    check_status(sph_particles_sort(set, 1.0, NULL), want);
    check_status(sph_particles_add_field(set, "f", 1, &id), want);
    check_status(sph_particles_field(set, SPH_FIELD_X, &values), want);
    assert_null(values);
    check_status(sph_particles_lend(set, SPH_FIELD_X, lent, 1), want);
    check_status(sph_particles_touch(set, SPH_FIELD_X), want);
    assert_int_equal(sph_particles_dim(set), 0);
    assert_int_equal(sph_particles_count(set), 0);
    assert_int_equal(sph_particles_real_count(set), 0);
    assert_int_equal(sph_particles_generation(set), 0);
    assert_int_equal(sph_particles_revision(set, SPH_FIELD_X), 0);
    assert_int_equal(sph_particles_components(set, SPH_FIELD_X), 0);
    assert_int_equal(sph_particles_find_field(set, "x"), -1);
    assert_null(sph_particles_field_const(set, SPH_FIELD_X));
    assert_null(sph_particles_roles(set));
    assert_null(sph_particles_phases(set));
    assert_null(sph_particles_ids(set));
    sph_particles_destroy(set); /* must not touch a context */
  }
  sph_particles *set = NULL;
  sph_particles *real = make_set(ctx, 2, 1);
  check_status(sph_particles_create((sph_context *)real, NULL, &set), SPH_ERR_HANDLE);
  sph_particles_destroy(real);
  sph_context_destroy(ctx);
}

static void test_set_outlives_context_reference(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_particles *set = make_set(ctx, 3, 10);
  sph_context_destroy(ctx);
  check_ok(sph_particles_add(set, 1000, NULL));
  assert_int_equal(sph_particles_count(set), 1010);
  sph_particles_destroy(set);
}

static void test_add_zero_fills(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_particles *set = make_set(ctx, 2, 0);
  int64_t first = -1;
  check_ok(sph_particles_add(set, 3, &first));
  assert_int_equal(first, 0);
  double *x = field(set, SPH_FIELD_X), *rho = field(set, SPH_FIELD_RHO);
  for (int k = 0; k < 6; k++) x[k] = k;
  for (int k = 0; k < 3; k++) rho[k] = 10 + k;
  check_ok(sph_particles_remove(set, 1, (int64_t[]){1}));
  check_ok(sph_particles_add(set, 2, &first)); /* reuses what the removed one left */
  assert_int_equal(first, 2);
  x = field(set, SPH_FIELD_X);
  rho = field(set, SPH_FIELD_RHO);
  const double want_x[] = {0, 1, 4, 5, 0, 0, 0, 0}, want_rho[] = {10, 12, 0, 0};
  assert_memory_equal(x, want_x, sizeof want_x);
  assert_memory_equal(rho, want_rho, sizeof want_rho);
  const int64_t want_ids[] = {0, 2, 3, 4};
  assert_memory_equal(sph_particles_ids(set), want_ids, sizeof want_ids);
  assert_int_equal((uintptr_t)x % 64, 0);
  assert_int_equal((uintptr_t)rho % 64, 0);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static void test_add_refusals(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_particles *set = make_set(ctx, 1, 4);
  int64_t first = 77;
  refused(ctx, sph_particles_add(set, -1, &first), SPH_ERR_ARG, "n = -1");
  refused(ctx, sph_particles_add(set, INT64_MAX, &first), SPH_ERR_LIMIT, "9223372036854775807");
  refused(ctx, sph_particles_add(set, INT64_C(2147483584) - 3, &first), SPH_ERR_LIMIT,
          "2147483585");
  refused(ctx, sph_particles_add_ghosts(set, -2, &first), SPH_ERR_ARG, "n = -2");
  refused(ctx, sph_particles_add_ghosts(set, INT64_MAX, &first), SPH_ERR_LIMIT, "add_ghosts");
  refused(ctx, sph_particles_reserve(set, -3), SPH_ERR_ARG, "-3");
  refused(ctx, sph_particles_reserve(set, INT64_MAX), SPH_ERR_LIMIT, "2147483584");
  assert_int_equal(first, 77);
  assert_int_equal(sph_particles_count(set), 4);
  uint64_t generation = sph_particles_generation(set);
  check_ok(sph_particles_add(set, 0, &first));
  assert_int_equal(first, 4);
  assert_int_equal(sph_particles_generation(set), generation);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static void test_ghosts(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_particles *set = make_set(ctx, 2, 3);
  int64_t first = -1;
  check_ok(sph_particles_add_ghosts(set, 2, &first));
  assert_int_equal(first, 3);
  check_ok(sph_particles_add_ghosts(set, 1, &first));
  assert_int_equal(first, 5);
  assert_int_equal(sph_particles_count(set), 6);
  assert_int_equal(sph_particles_real_count(set), 3);
  for (int k = 0; k < 6; k++) {
    assert_int_equal(sph_particles_roles(set)[k], k < 3 ? SPH_ROLE_REAL : SPH_ROLE_GHOST);
    assert_int_equal(sph_particles_phases(set)[k], 0);
    assert_int_equal(sph_particles_ids(set)[k], k < 3 ? k : -1);
  }
  refused(ctx, sph_particles_add(set, 1, NULL), SPH_ERR_STATE, "3 ghosts");
  refused(ctx, sph_particles_sort(set, 1.0, NULL), SPH_ERR_STATE, "3 ghosts");
  check_ok(sph_particles_remove(set, 2, (int64_t[]){4, 0})); /* a ghost and a real one */
  assert_int_equal(sph_particles_count(set), 4);
  assert_int_equal(sph_particles_real_count(set), 2);
  uint64_t generation = sph_particles_generation(set);
  check_ok(sph_particles_clear_ghosts(set));
  assert_int_equal(sph_particles_count(set), 2);
  assert_true(sph_particles_generation(set) > generation);
  generation = sph_particles_generation(set);
  check_ok(sph_particles_clear_ghosts(set));
  assert_int_equal(sph_particles_generation(set), generation);
  check_ok(sph_particles_add(set, 1, &first));
  assert_int_equal(sph_particles_ids(set)[first], 3); /* ghosts used up no id */
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static void test_remove_refusals(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_particles *set = make_set(ctx, 1, 100);
  uint64_t generation = sph_particles_generation(set);
  refused(ctx, sph_particles_remove(set, -1, NULL), SPH_ERR_ARG, "n = -1");
  refused(ctx, sph_particles_remove(set, 1, NULL), SPH_ERR_ARG, "indices is NULL");
  refused(ctx, sph_particles_remove(set, 2, (int64_t[]){5, 100}), SPH_ERR_ARG,
          "indices[1] = 100 is outside 0..99");
  refused(ctx, sph_particles_remove(set, 1, (int64_t[]){-1}), SPH_ERR_ARG, "= -1 is outside");
  refused(ctx, sph_particles_remove(set, 3, (int64_t[]){70, 5, 70}), SPH_ERR_ARG,
          "indices[2] = 70 comes twice");
  check_ok(sph_particles_remove(set, 0, NULL));
  assert_int_equal(sph_particles_count(set), 100);
  assert_int_equal(sph_particles_generation(set), generation);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static void test_remove_all(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_particles *set = make_set(ctx, 3, 64);
  int64_t all[64];
  for (int k = 0; k < 64; k++) all[k] = 63 - k;
  check_ok(sph_particles_remove(set, 64, all));
  assert_int_equal(sph_particles_count(set), 0);
  refused(ctx, sph_particles_remove(set, 1, all), SPH_ERR_ARG, "outside");
  check_ok(sph_particles_sort(set, 1.0, NULL));
  check_ok(sph_particles_add(set, 1, NULL));
  assert_int_equal(sph_particles_ids(set)[0], 64);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static void test_builtin_fields(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  const char *names[] = {"x",     "v",  "m", "rho",     "h", "p",  "c",    "e",
                         "sigma", "x0", "a", "spacing", "F", "PK", "omega"};
  for (int32_t dim = 1; dim <= 3; dim++) {
    sph_particles *set = make_set(ctx, dim, 5);
    assert_int_equal(sph_particles_dim(set), dim);
    uint64_t generation = sph_particles_generation(set);
    for (int32_t f = 0; f < 15; f++) {
      int vector = f == SPH_FIELD_X || f == SPH_FIELD_V || f == SPH_FIELD_X0 || f == SPH_FIELD_A;
      int32_t want = vector ? dim : f == SPH_FIELD_SIGMA ? sph_sym_components(dim) : 1;
      if (f == SPH_FIELD_F || f == SPH_FIELD_PK) want = dim * dim;
      assert_int_equal(sph_particles_find_field(set, names[f]), f);
      assert_int_equal(sph_particles_components(set, f), want);
      assert_int_equal(sph_particles_field_const(set, f) != NULL, f == SPH_FIELD_X);
      double *values = field(set, f);
      for (int32_t k = 0; k < 5 * want; k++) assert_true(values[k] == 0.0);
      assert_ptr_equal(field(set, f), values);
      assert_ptr_equal(sph_particles_field_const(set, f), values);
    }
    assert_int_equal(sph_particles_generation(set), generation);
    sph_particles_destroy(set);
  }
  sph_context_destroy(ctx);
}

static void test_field_refusals(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_particles *set = make_set(ctx, 2, 5);
  double *values, lent[10];
  const int32_t unknown[] = {-1, 15, 63, 64, 1000, INT32_MAX, INT32_MIN};
  for (int k = 0; k < 7; k++) {
    values = lent;
    refused(ctx, sph_particles_field(set, unknown[k], &values), SPH_ERR_ARG, "no field");
    assert_null(values);
    assert_null(sph_particles_field_const(set, unknown[k]));
    assert_int_equal(sph_particles_components(set, unknown[k]), 0);
    assert_int_equal(sph_particles_revision(set, unknown[k]), 0);
    refused(ctx, sph_particles_lend(set, unknown[k], lent, 5), SPH_ERR_ARG, "no field");
    refused(ctx, sph_particles_touch(set, unknown[k]), SPH_ERR_ARG, "no field");
  }
  refused(ctx, sph_particles_field(set, 0, NULL), SPH_ERR_ARG, "array is NULL");
  refused(ctx, sph_particles_touch(set, SPH_FIELD_H), SPH_ERR_ARG, "'h' was never created");
  assert_int_equal(sph_particles_find_field(set, NULL), -1);
  assert_int_equal(sph_particles_find_field(set, ""), -1);
  assert_int_equal(sph_particles_find_field(set, "nothing"), -1);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static void test_host_fields(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_particles *set = make_set(ctx, 2, 3);
  int32_t id = 0;
  for (int32_t k = 0; k < 64; k++) {
    char name[16];
    snprintf(name, sizeof name, "host%d", (int)k);
    check_ok(sph_particles_add_field(set, name, 1 + k, &id));
    assert_int_equal(id, 64 + k);
    assert_int_equal(sph_particles_find_field(set, name), id);
    assert_int_equal(sph_particles_components(set, id), 1 + k);
    double *values = field(set, id);
    for (int32_t c = 0; c < 3 * (1 + k); c++) assert_true(values[c] == 0.0);
    values[0] = k;
  }
  id = -7;
  refused(ctx, sph_particles_add_field(set, "more", 1, &id), SPH_ERR_LIMIT, "at most 64");
  assert_int_equal(id, -7);
  check_ok(sph_particles_add(set, 1000, NULL));
  for (int32_t k = 0; k < 64; k++) assert_true(field(set, 64 + k)[0] == (double)k);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static void test_host_field_refusals(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_particles *set = make_set(ctx, 2, 3);
  int32_t id = -7;
  char name31[] = "abcdefghijklmnopqrstuvwxyz01234";
  refused(ctx, sph_particles_add_field(set, NULL, 1, &id), SPH_ERR_ARG, "name is NULL");
  refused(ctx, sph_particles_add_field(set, "f", 1, NULL), SPH_ERR_ARG, "field is NULL");
  refused(ctx, sph_particles_add_field(set, "", 1, &id), SPH_ERR_ARG, "1 to 31");
  refused(ctx, sph_particles_add_field(set, "abcdefghijklmnopqrstuvwxyz012345", 1, &id),
          SPH_ERR_ARG, "1 to 31");
  refused(ctx, sph_particles_add_field(set, "f", 0, &id), SPH_ERR_ARG, "0 components");
  refused(ctx, sph_particles_add_field(set, "f", 65, &id), SPH_ERR_ARG, "65 components");
  refused(ctx, sph_particles_add_field(set, "rho", 1, &id), SPH_ERR_ARG, "'rho' already");
  assert_int_equal(id, -7);
  check_ok(sph_particles_add_field(set, name31, 64, &id));
  assert_int_equal(id, 64);
  refused(ctx, sph_particles_add_field(set, name31, 1, &id), SPH_ERR_ARG, "already");
  name31[0] = 'Z'; /* the set has a copy */
  assert_int_equal(sph_particles_find_field(set, "abcdefghijklmnopqrstuvwxyz01234"), 64);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static void test_lend(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_particles *set = make_set(ctx, 2, 3);
  double mine[8] = {6, 60, 5, 50, 4, 40, 7, 70}, mass[3] = {1, 2, 3};
  check_ok(sph_particles_lend(set, SPH_FIELD_X, mine, 4));
  assert_ptr_equal(field(set, SPH_FIELD_X), mine);
  check_ok(sph_particles_lend(set, SPH_FIELD_M, mass, 3)); /* never created before */
  assert_ptr_equal(field(set, SPH_FIELD_M), mass);
  refused(ctx, sph_particles_add(set, 1, NULL), SPH_ERR_LIMIT, "'m' holds 3");
  check_ok(sph_particles_lend(set, SPH_FIELD_M, NULL, 0));
  assert_ptr_not_equal(field(set, SPH_FIELD_M), mass);
  assert_memory_equal(field(set, SPH_FIELD_M), mass, sizeof mass);
  refused(ctx, sph_particles_reserve(set, 5), SPH_ERR_LIMIT, "'x' holds 4");
  check_ok(sph_particles_reserve(set, 4));
  check_ok(sph_particles_add(set, 1, NULL));
  assert_true(mine[6] == 7 && mine[7] == 70); /* lent arrays are left as filled */
  assert_true(field(set, SPH_FIELD_M)[3] == 0);
  refused(ctx, sph_particles_add_ghosts(set, 1, NULL), SPH_ERR_LIMIT, "'x' holds 4");
  check_ok(sph_particles_sort(set, 1.0, NULL));
  const double sorted[] = {4, 40, 5, 50, 6, 60, 7, 70};
  assert_memory_equal(mine, sorted, sizeof sorted);
  check_ok(sph_particles_remove(set, 1, (int64_t[]){0}));
  assert_memory_equal(mine, sorted + 2, 6 * sizeof(double));
  check_ok(sph_particles_lend(set, SPH_FIELD_X, NULL, -1));
  assert_memory_equal(field(set, SPH_FIELD_X), sorted + 2, 6 * sizeof(double));
  check_ok(sph_particles_add(set, 100, NULL));
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static void test_lend_refusals(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_particles *set = make_set(ctx, 1, 3);
  double a[8] = {0}, b[8] = {0};
  double *own = field(set, SPH_FIELD_X);
  refused(ctx, sph_particles_lend(set, SPH_FIELD_X, a, 2), SPH_ERR_ARG,
          "'x' holds 2 particles, the set has 3");
  refused(ctx, sph_particles_lend(set, SPH_FIELD_X, a, -1), SPH_ERR_ARG, "holds -1");
  refused(ctx, sph_particles_lend(set, SPH_FIELD_X, own, 3), SPH_ERR_ARG, "set's own");
  refused(ctx, sph_particles_lend(set, SPH_FIELD_M, own, 3), SPH_ERR_ARG, "of field 'x'");
  refused(ctx, sph_particles_lend(set, SPH_FIELD_M, own + 1, 3), SPH_ERR_ARG, "of field 'x'");
  uint64_t generation = sph_particles_generation(set);
  check_ok(sph_particles_lend(set, SPH_FIELD_X, NULL, 0)); /* nothing is lent */
  assert_ptr_equal(field(set, SPH_FIELD_X), own);
  assert_int_equal(sph_particles_generation(set), generation);
  check_ok(sph_particles_lend(set, SPH_FIELD_X, a, 8));
  check_ok(sph_particles_lend(set, SPH_FIELD_X, b, 3)); /* another one in its place */
  assert_ptr_equal(field(set, SPH_FIELD_X), b);
  check_ok(sph_particles_lend(set, SPH_FIELD_X, b + 1, 5)); /* may overlap its predecessor */
  refused(ctx, sph_particles_lend(set, SPH_FIELD_M, b, 3), SPH_ERR_ARG, "lent too");
  refused(ctx, sph_particles_lend(set, SPH_FIELD_M, b + 5, 3), SPH_ERR_ARG, "lent too");
  check_ok(sph_particles_lend(set, SPH_FIELD_M, a, 8));
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static void test_sort_refusals(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_particles *set = make_set(ctx, 2, 4);
  const double bad[] = {0.0, -1.0, NAN, INFINITY};
  for (int k = 0; k < 4; k++)
    refused(ctx, sph_particles_sort(set, bad[k], NULL), SPH_ERR_ARG, "cell");
  double *x = field(set, SPH_FIELD_X);
  x[7] = NAN;
  x[5] = -INFINITY;
  x[0] = 9;
  refused(ctx, sph_particles_sort(set, 1.0, NULL), SPH_ERR_ARG, "particle 2 is not finite");
  assert_true(x[0] == 9);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static void test_counters(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_particles *set = make_set(ctx, 1, 2);
  assert_int_equal(sph_particles_revision(set, SPH_FIELD_H), 0);
  field(set, SPH_FIELD_H);
  uint64_t h = sph_particles_revision(set, SPH_FIELD_H);
  assert_true(h > 0);
  uint64_t x = sph_particles_revision(set, SPH_FIELD_X), g = sph_particles_generation(set);
  check_ok(sph_particles_touch(set, SPH_FIELD_H));
  assert_int_equal(sph_particles_revision(set, SPH_FIELD_H), h + 1);
  assert_int_equal(sph_particles_revision(set, SPH_FIELD_X), x);
  assert_int_equal(sph_particles_generation(set), g);
  check_ok(sph_particles_reserve(set, 1000)); /* arrays move, values do not change */
  assert_int_equal(sph_particles_generation(set), g + 1);
  assert_int_equal(sph_particles_revision(set, SPH_FIELD_X), x);
  check_ok(sph_particles_reserve(set, 1000));
  assert_int_equal(sph_particles_generation(set), g + 1);
  check_ok(sph_particles_add(set, 1, NULL));
  assert_int_equal(sph_particles_generation(set), g + 2);
  assert_true(sph_particles_revision(set, SPH_FIELD_X) > x);
  field(set, SPH_FIELD_X)[0] = 5;
  x = sph_particles_revision(set, SPH_FIELD_X);
  check_ok(sph_particles_sort(set, 1.0, NULL));
  assert_int_equal(sph_particles_generation(set), g + 3);
  assert_true(sph_particles_revision(set, SPH_FIELD_X) > x);
  x = sph_particles_revision(set, SPH_FIELD_X);
  check_ok(sph_particles_sort(set, 1.0, NULL)); /* in order already */
  assert_int_equal(sph_particles_generation(set), g + 3);
  assert_int_equal(sph_particles_revision(set, SPH_FIELD_X), x);
  check_ok(sph_particles_remove(set, 1, (int64_t[]){1}));
  assert_int_equal(sph_particles_generation(set), g + 4);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static int64_t allocations(const sph_context *ctx) {
  int64_t n = 0;
  check_ok(sph_context_memory(ctx, NULL, NULL, &n));
  return n;
}

static void test_reserved_adds_allocate_nothing(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_particles *set = make_set(ctx, 3, 0);
  int32_t id = 0;
  check_ok(sph_particles_add_field(set, "mine", 5, &id));
  check_ok(sph_particles_reserve(set, 1000));
  double *v = field(set, SPH_FIELD_V), *x = field(set, SPH_FIELD_X);
  int64_t before = allocations(ctx);
  for (int k = 0; k < 99; k++) check_ok(sph_particles_add(set, 10, NULL));
  check_ok(sph_particles_add_ghosts(set, 10, NULL));
  check_ok(sph_particles_clear_ghosts(set));
  check_ok(sph_particles_add_ghosts(set, 10, NULL));
  assert_int_equal(allocations(ctx), before);
  assert_ptr_equal(field(set, SPH_FIELD_V), v);
  assert_ptr_equal(field(set, SPH_FIELD_X), x);
  check_ok(sph_particles_remove(set, 1, (int64_t[]){7}));
  before = allocations(ctx);
  check_ok(sph_particles_remove(set, 1, (int64_t[]){7})); /* its scratch is kept */
  assert_int_equal(allocations(ctx), before);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static void test_empty_and_single(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_particles *set = make_set(ctx, 3, 0);
  field(set, SPH_FIELD_SIGMA);
  check_ok(sph_particles_sort(set, 0.5, NULL));
  check_ok(sph_particles_clear_ghosts(set));
  check_ok(sph_particles_add_ghosts(set, 1, NULL)); /* ghosts alone are fine */
  assert_int_equal(sph_particles_real_count(set), 0);
  check_ok(sph_particles_clear_ghosts(set));
  check_ok(sph_particles_add(set, 1, NULL));
  int64_t permutation = -1;
  check_ok(sph_particles_sort(set, 0.5, &permutation));
  assert_int_equal(permutation, 0);
  check_ok(sph_particles_remove(set, 1, (int64_t[]){0}));
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

/* Everything that allocates, in one life. */
static sph_status life(sph_context *ctx, void *user) {
  (void)user;
  sph_particles *set = NULL;
  double lent[400], *values;
  int32_t id;
  for (int k = 0; k < 400; k++) lent[k] = (k * 7919) % 400;
  sph_particles_options o;
  sph_particles_options_init(&o);
  o.dim = 1;
  o.capacity = 10;
  sph_status s = sph_particles_create(ctx, &o, &set);
  if (s == SPH_OK) s = sph_particles_add(set, 20, NULL);
  if (s == SPH_OK) s = sph_particles_field(set, SPH_FIELD_SIGMA, &values);
  if (s == SPH_OK) s = sph_particles_add_field(set, "mine", 3, &id);
  if (s == SPH_OK) s = sph_particles_lend(set, SPH_FIELD_X, lent, 400);
  if (s == SPH_OK) s = sph_particles_reserve(set, 100);
  if (s == SPH_OK) s = sph_particles_add(set, 300, NULL);
  if (s == SPH_OK) s = sph_particles_sort(set, 3.0, NULL);
  if (s == SPH_OK) s = sph_particles_remove(set, 2, (int64_t[]){3, 1});
  if (s == SPH_OK) s = sph_particles_lend(set, SPH_FIELD_X, NULL, 0);
  if (s == SPH_OK) s = sph_particles_add_ghosts(set, 500, NULL);
  sph_particles_destroy(set);
  return s;
}

static void test_out_of_memory(void **state) {
  (void)state;
  oom_sweep(life, NULL);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_options),
    cmocka_unit_test(test_create_refusals),
    cmocka_unit_test(test_newer_options),
    cmocka_unit_test(test_null_and_wrong_handle),
    cmocka_unit_test(test_set_outlives_context_reference),
    cmocka_unit_test(test_add_zero_fills),
    cmocka_unit_test(test_add_refusals),
    cmocka_unit_test(test_ghosts),
    cmocka_unit_test(test_remove_refusals),
    cmocka_unit_test(test_remove_all),
    cmocka_unit_test(test_builtin_fields),
    cmocka_unit_test(test_field_refusals),
    cmocka_unit_test(test_host_fields),
    cmocka_unit_test(test_host_field_refusals),
    cmocka_unit_test(test_lend),
    cmocka_unit_test(test_lend_refusals),
    cmocka_unit_test(test_sort_refusals),
    cmocka_unit_test(test_counters),
    cmocka_unit_test(test_reserved_adds_allocate_nothing),
    cmocka_unit_test(test_empty_and_single),
    cmocka_unit_test(test_out_of_memory),
};
SPH_TEST_MAIN(tests)
