/* Particle sets from within: a model that random operations are compared with, the order of the
 * sort, state after every failed allocation, ten million particles. */
#include "../../src/particles/set.h"
#include "../check.h"
#include "../oom.h"

static uint64_t random_state = 1;
static uint64_t random_bits(void) { /* splitmix64 */
  uint64_t z = (random_state += UINT64_C(0x9e3779b97f4a7c15));
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return z ^ (z >> 31);
}
static double random_unit(void) { return (double)(random_bits() >> 11) * 0x1p-53; }
static int64_t random_below(int64_t n) { return (int64_t)(random_bits() % (uint64_t)n); }

static sph_context *make_context(int32_t threads) {
  sph_context_options o;
  sph_context *ctx = NULL;
  sph_context_options_init(&o);
  o.threads = threads;
  check_ok(sph_context_create(&o, &ctx));
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
  return values;
}

/* ---- random operations against a model: each particle carries its id in every array ---- */

enum { MODEL_MAX = 4000 };
typedef struct model {
  int64_t ids[MODEL_MAX]; /* in order */
  int64_t count, next_id;
} model;

static void stamp(sph_particles *set, int64_t first, int64_t n) {
  double *sigma = field(set, SPH_FIELD_SIGMA), *e = field(set, SPH_FIELD_E);
  for (int64_t i = first; i < first + n; i++) {
    for (int c = 0; c < 3; c++) sigma[3 * i + c] = (double)(10 * set->ids[i] + c);
    e[i] = (double)set->ids[i];
    set->phases[i] = (int32_t)(set->ids[i] % 5);
    set->roles[i] = set->ids[i] % 2 ? SPH_ROLE_WALL : SPH_ROLE_REAL;
  }
}

static void check_model(const sph_particles *set, const model *m) {
  assert_int_equal(set->count, m->count);
  assert_int_equal(set->real_count, m->count);
  const double *sigma = sph_particles_field_const(set, SPH_FIELD_SIGMA);
  const double *e = sph_particles_field_const(set, SPH_FIELD_E);
  for (int64_t i = 0; i < m->count; i++) {
    int64_t id = m->ids[i];
    assert_int_equal(set->ids[i], id);
    assert_int_equal(set->phases[i], id % 5);
    assert_int_equal(set->roles[i], id % 2 ? SPH_ROLE_WALL : SPH_ROLE_REAL);
    assert_true(e[i] == (double)id);
    for (int c = 0; c < 3; c++) assert_true(sigma[3 * i + c] == (double)(10 * id + c));
  }
}

static void random_add(sph_particles *set, model *m) {
  int64_t n = random_below(200), first = -1;
  if (m->count + n > MODEL_MAX) return;
  check_ok(sph_particles_add(set, n, &first));
  assert_int_equal(first, m->count);
  for (int64_t k = 0; k < n; k++) m->ids[m->count++] = m->next_id++;
  stamp(set, first, n);
}

static void random_remove(sph_particles *set, model *m) {
  int64_t doomed[MODEL_MAX], n = 0, kept = 0;
  double rate = random_unit();
  rate = rate * rate;
  for (int64_t i = 0; i < m->count; i++) {
    if (random_unit() < rate)
      doomed[n++] = i;
    else
      m->ids[kept++] = m->ids[i];
  }
  m->count = kept;
  for (int64_t k = n - 1; k > 0; k--) { /* any order must do */
    int64_t j = random_below(k + 1), swap = doomed[k];
    doomed[k] = doomed[j];
    doomed[j] = swap;
  }
  check_ok(sph_particles_remove(set, n, doomed));
}

static void random_sort(sph_particles *set, model *m) {
  int64_t permutation[MODEL_MAX], old[MODEL_MAX];
  double *x = field(set, SPH_FIELD_X);
  for (int64_t k = 0; k < 2 * m->count; k++) x[k] = random_unit() * 10 - 5;
  memcpy(old, m->ids, sizeof old);
  check_ok(sph_particles_sort(set, 0.7, permutation));
  for (int64_t k = 0; k < m->count; k++) m->ids[k] = old[permutation[k]];
}

static void test_random_operations(void **state) {
  (void)state;
  static model m;
  sph_context *ctx = make_context(2);
  sph_particles *set = make_set(ctx, 2, 0);
  memset(&m, 0, sizeof m);
  for (int round = 0; round < (check_long_run ? 3000 : 300); round++) {
    switch (random_below(5)) {
    case 0:
      random_remove(set, &m);
      break;
    case 1:
      random_sort(set, &m);
      break;
    default:
      random_add(set, &m);
      break;
    }
    check_model(set, &m);
  }
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static void test_remove_runs(void **state) { /* word boundaries of the bitmap */
  (void)state;
  sph_context *ctx = make_context(1);
  for (int64_t begin = 60; begin < 70; begin++)
    for (int64_t end = begin; end < 200; end += 13) {
      sph_particles *set = make_set(ctx, 1, 256);
      int64_t doomed[256], n = 0;
      for (int64_t i = begin; i < end; i++) doomed[n++] = i;
      doomed[n++] = 255;
      check_ok(sph_particles_remove(set, n, doomed));
      assert_int_equal(set->count, 256 - n);
      for (int64_t i = 0; i < set->count; i++)
        assert_int_equal(set->ids[i], i < begin ? i : i + n - 1);
      sph_particles_destroy(set);
    }
  sph_context_destroy(ctx);
}

/* ---- sort ---- */

static double axis_cell(double x, double cell) {
  double c = floor(x / cell);
  return c > 0x1p62 ? 0x1p62 : c < -0x1p62 ? -0x1p62 : c;
}

/* Whether old particle a stands before b by the header's rule. */
static int before(const double *x, int32_t dim, double cell, int64_t a, int64_t b) {
  for (int32_t axis = dim - 1; axis >= 0; axis--) {
    double ca = axis_cell(x[a * dim + axis], cell), cb = axis_cell(x[b * dim + axis], cell);
    if (ca != cb) return ca < cb;
  }
  return a < b;
}

static void check_sorted(int32_t dim, double cell, const double *x, int64_t n, int32_t threads) {
  sph_context *ctx = make_context(threads);
  sph_particles *set = make_set(ctx, dim, n);
  double *mine = field(set, SPH_FIELD_X), *x0 = field(set, SPH_FIELD_X0);
  static int64_t permutation[5000];
  memcpy(mine, x, (size_t)(n * dim) * sizeof *x);
  memcpy(x0, x, (size_t)(n * dim) * sizeof *x);
  check_ok(sph_particles_sort(set, cell, permutation));
  for (int64_t k = 1; k < n; k++)
    assert_true(before(x, dim, cell, permutation[k - 1], permutation[k]));
  for (int64_t k = 0; k < n; k++) {
    assert_int_equal(set->ids[k], permutation[k]);
    assert_memory_equal(mine + k * dim, x + permutation[k] * dim, (size_t)dim * sizeof *x);
  }
  assert_memory_equal(mine, x0, (size_t)(n * dim) * sizeof *x);
  assert_ptr_equal(field(set, SPH_FIELD_X), mine); /* addresses stay */
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static void test_sort_order(void **state) {
  (void)state;
  static double x[15000];
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int32_t threads = 1; threads <= 3; threads++) {
      for (int64_t k = 0; k < 5000 * dim; k++) x[k] = 200 * random_unit() - 100;
      check_sorted(dim, 0.01, x, 5000, threads);
      check_sorted(dim, 7.0, x, 5000, threads);
      check_sorted(dim, 1e6, x, 5000, threads); /* two cells an axis */
    }
}

static void test_sort_far_away(void **state) {
  (void)state;
  static double x[3000];
  for (int64_t k = 0; k < 3000; k++) x[k] = 20 * random_unit() - 10;
  const double far[] = {1e30,   -1e30,   1e300,  -1e308, 1.7976931348623157e308,
                        1e15,   -1e18,   4e18,   5e18,   1e19,
                        0x1p62, -0x1p62, 0x1p63, 1e-320, -0.0};
  for (int64_t k = 0; k < 15; k++) x[91 * k] = far[k];
  check_sorted(3, 1.0, x, 1000, 1);
  check_sorted(3, 1e-300, x, 1000, 2); /* quotients overflow to infinity */
  check_sorted(3, 1e300, x, 1000, 2);
  check_sorted(1, 5e-324, x, 3000, 1);
}

static void test_sort_same_bits_for_any_threads(void **state) {
  (void)state;
  enum { N = 60000 };
  static double first[3 * N];
  for (int32_t threads = 1; threads <= 8; threads++) {
    sph_context *ctx = make_context(threads);
    sph_particles *set = make_set(ctx, 3, N);
    double *x = field(set, SPH_FIELD_X);
    random_state = 42;
    for (int64_t k = 0; k < 3 * N; k++) x[k] = random_unit();
    check_ok(sph_particles_sort(set, 0.05, NULL));
    if (threads == 1) memcpy(first, x, sizeof first);
    assert_memory_equal(x, first, sizeof first);
    sph_particles_destroy(set);
    sph_context_destroy(ctx);
  }
}

/* ---- growth ---- */

static void test_growth_is_geometric(void **state) {
  (void)state;
  sph_context *ctx = make_context(1);
  sph_particles *set = make_set(ctx, 1, 0);
  int moves = 0;
  int64_t capacity = set->capacity;
  for (int k = 0; k < 100000; k++) {
    check_ok(sph_particles_add(set, 1, NULL));
    if (set->capacity != capacity) moves++;
    capacity = set->capacity;
  }
  assert_true(moves < 40);
  assert_true(capacity < 150002);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static void test_growth_stops_at_lent(void **state) {
  (void)state;
  sph_context *ctx = make_context(1);
  sph_particles *set = make_set(ctx, 1, 100);
  double lent[110];
  check_ok(sph_particles_lend(set, SPH_FIELD_E, lent, 110));
  check_ok(sph_particles_add(set, 1, NULL));
  assert_int_equal(set->capacity, 110);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

/* ---- what a failed allocation leaves behind ---- */

typedef struct snapshot {
  sph_particles set; /* the struct itself: pointers, counters, revisions */
  double x[64], e[64];
  int64_t ids[64];
} snapshot;

static void take(snapshot *s, const sph_particles *set) {
  memset(s, 0, sizeof *s);
  memcpy(&s->set, set, sizeof *set);
  memcpy(s->x, set->fields[SPH_FIELD_X].values, (size_t)(2 * set->count) * sizeof(double));
  memcpy(s->e, set->fields[SPH_FIELD_E].values, (size_t)set->count * sizeof(double));
  memcpy(s->ids, set->ids, (size_t)set->count * sizeof(int64_t));
}

typedef sph_status (*operation)(sph_particles *set);

/* Grow, then undo nothing: the snapshot covers every byte of the set's struct. */
static sph_status grow_by_add(sph_particles *set) { return sph_particles_add(set, 500, NULL); }
static sph_status grow_by_reserve(sph_particles *set) { return sph_particles_reserve(set, 500); }
static sph_status grow_by_ghosts(sph_particles *set) {
  return sph_particles_add_ghosts(set, 500, NULL);
}
static sph_status sort_it(sph_particles *set) { return sph_particles_sort(set, 0.1, NULL); }
static sph_status remove_some(sph_particles *set) {
  return sph_particles_remove(set, 2, (int64_t[]){4, 2});
}
static sph_status new_builtin(sph_particles *set) {
  double *values;
  return sph_particles_field(set, SPH_FIELD_V, &values);
}
static sph_status new_host_field(sph_particles *set) {
  int32_t id;
  return sph_particles_add_field(set, "mine", 2, &id);
}
static sph_status back_from_host(sph_particles *set) {
  return sph_particles_lend(set, SPH_FIELD_E, NULL, 0);
}

static sph_particles *prepared(sph_context *ctx, double *lent) {
  sph_particles *set = make_set(ctx, 2, 30);
  double *x = field(set, SPH_FIELD_X);
  for (int k = 0; k < 60; k++) x[k] = random_unit();
  for (int k = 0; k < 600; k++) lent[k] = k;
  check_ok(sph_particles_lend(set, SPH_FIELD_E, lent, 600));
  return set;
}

/* Refuse allocation `countdown` of one operation; 0 when none was refused any more. */
static int fails_cleanly(operation op, int64_t countdown, int once) {
  static snapshot was, is;
  static double lent[600];
  sph_context *ctx = oom_context();
  sph_particles *set = prepared(ctx, lent);
  take(&was, set);
  oom.once = once;
  oom.countdown = countdown;
  sph_status status = op(set);
  oom.countdown = -1;
  int refused = oom.refused > 0;
  check_status(status, refused ? SPH_ERR_NOMEM : SPH_OK);
  if (refused) {
    take(&is, set);
    assert_memory_equal(&was, &is, sizeof was);
    check_ok(op(set)); /* and it works when there is memory again */
  }
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
  oom_check_clean();
  return refused;
}

static void test_out_of_memory_changes_nothing(void **state) {
  (void)state;
  const operation all[] = {grow_by_add, grow_by_reserve, grow_by_ghosts, sort_it,
                           remove_some, new_builtin,     new_host_field, back_from_host};
  for (int k = 0; k < 8; k++)
    for (int once = 0; once < 2; once++) {
      int64_t countdown = 0;
      while (fails_cleanly(all[k], countdown, once)) countdown++;
      assert_true(countdown > 0); /* the operation did allocate */
    }
}

/* ---- services for other layers ---- */

static void test_internal_questions(void **state) {
  (void)state;
  sph_context *ctx = make_context(1);
  sph_particles *set = make_set(ctx, 1, 1);
  int32_t id = 0;
  check_ok(sph_particles_add_field(set, "mine", 2, &id));
  assert_ptr_equal(sphi_particles_context(set), ctx);
  assert_string_equal(sphi_field_name(set, SPH_FIELD_SPACING), "spacing");
  assert_string_equal(sphi_field_name(set, id), "mine");
  assert_string_equal(sphi_field_name(set, id + 1), "unknown");
  assert_string_equal(sphi_field_name(set, -1), "unknown");
  assert_ptr_equal(sphi_particles_phases(set), sph_particles_phases(set));
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static void test_ten_million(void **state) {
  (void)state;
  const int64_t n = 10000000;
  sph_context *ctx = make_context(2);
  sph_particles *set = make_set(ctx, 1, n);
  double *x = field(set, SPH_FIELD_X);
  for (int64_t i = 0; i < n; i++) x[i] = (double)((i * 7919) % n) + 0.5;
  int64_t doomed[3] = {n - 1, 0, n / 2};
  check_ok(sph_particles_remove(set, 3, doomed));
  assert_int_equal(set->count, n - 3);
  assert_int_equal(set->ids[n - 4], n - 2);
  if (check_long_run) {
    check_ok(sph_particles_sort(set, 1.0, NULL));
    for (int64_t i = 1; i < n - 3; i++)
      if (!(x[i - 1] < x[i])) fail();
    check_ok(sph_particles_add(set, n, NULL));
    assert_int_equal(set->ids[2 * n - 4], 2 * n - 1);
  }
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_random_operations),
    cmocka_unit_test(test_remove_runs),
    cmocka_unit_test(test_sort_order),
    cmocka_unit_test(test_sort_far_away),
    cmocka_unit_test(test_sort_same_bits_for_any_threads),
    cmocka_unit_test(test_growth_is_geometric),
    cmocka_unit_test(test_growth_stops_at_lent),
    cmocka_unit_test(test_out_of_memory_changes_nothing),
    cmocka_unit_test(test_internal_questions),
    cmocka_unit_test(test_ten_million),
};
SPH_TEST_MAIN(tests)
