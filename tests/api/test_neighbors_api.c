/* The public face of neighbour structures: refusals, sets and staleness, failing memory, limits,
 * steady state. */
#include "check.h"
#include "oom.h"

#include <stdlib.h>

#include <sph/context.h>
#include <sph/neighbors.h>
#include <sph/particles.h>

enum { N = 3000 };

static double positions[N * 3];

static void fill_positions(double scale) {
  uint64_t seed = 5;
  for (int i = 0; i < N * 3; i++) {
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    positions[i] = scale * (double)(seed >> 11) * 0x1p-53;
  }
}

static sph_neighbors *make(sph_context *ctx, int32_t method, double skin) {
  sph_neighbors_options o;
  sph_neighbors *list = NULL;
  sph_neighbors_options_init(&o);
  o.method = method;
  o.skin = skin;
  check_ok(sph_neighbors_create(ctx, &o, &list));
  return list;
}

static sph_context *plain_context(void) {
  sph_context *ctx = NULL;
  check_ok(sph_context_create(NULL, &ctx));
  return ctx;
}

/* --- refusals --- */

static void refuse(sph_context *ctx, const sph_neighbors_options *o, const char *word) {
  sph_neighbors *list = (sph_neighbors *)ctx;
  check_status(sph_neighbors_create(ctx, o, &list), SPH_ERR_ARG);
  assert_null(list);
  assert_non_null(strstr(sph_context_last_error(ctx), word));
}

static void test_options(void **state) {
  (void)state;
  sph_context *ctx = plain_context();
  sph_neighbors_options o, d;
  sph_neighbors *list = NULL;
  sph_neighbors_options_init(&d);
  assert_int_equal(d.size, sizeof d);
  assert_int_equal(d.method, SPH_NEIGHBORS_CELLS);
  assert_int_equal(d.h_rule, SPH_H_ARITHMETIC);
  check_close(d.support, 2.0, 0.0);
  o = d, o.method = 9, refuse(ctx, &o, "method");
  o = d, o.method = 0, refuse(ctx, &o, "method");
  o = d, o.h_rule = 6, refuse(ctx, &o, "h_rule");
  o = d, o.support = 0.0, refuse(ctx, &o, "support");
  o = d, o.support = NAN, refuse(ctx, &o, "support");
  o = d, o.skin = -1.0, refuse(ctx, &o, "skin");
  o = d, o.skin = INFINITY, refuse(ctx, &o, "skin");
  o = d, o.max_pairs = -1, refuse(ctx, &o, "max_pairs");
  o = d, o.periodic[1] = 1, refuse(ctx, &o, "axis 1");
  o.box_hi[1] = NAN, refuse(ctx, &o, "axis 1");
  check_status(sph_neighbors_create(ctx, &d, NULL), SPH_ERR_ARG);
  check_status(sph_neighbors_create(NULL, &d, &list), SPH_ERR_ARG);
  check_ok(sph_neighbors_create(ctx, NULL, &list));
  sph_neighbors_destroy(list);
  sph_neighbors_destroy(NULL);
  sph_context_destroy(ctx);
}

static void test_null_and_unbuilt(void **state) {
  (void)state;
  sph_context *ctx = plain_context();
  sph_neighbors *list = make(ctx, SPH_NEIGHBORS_CELLS, 0.0);
  const int64_t *offsets;
  const int32_t *indices;
  int64_t found;
  double p[3] = {0, 0, 0};
  check_status(sph_neighbors_build(NULL, NULL), SPH_ERR_ARG);
  check_status(sph_neighbors_build(list, NULL), SPH_ERR_ARG);
  check_status(sph_neighbors_build(list, (const sph_particles *)list), SPH_ERR_HANDLE);
  check_status(sph_neighbors_update(list, NULL, NULL), SPH_ERR_ARG);
  check_status(sph_neighbors_build_arrays(NULL, 3, 0, NULL, NULL, 1.0), SPH_ERR_ARG);
  check_status(sph_neighbors_build_arrays(list, 3, 1, NULL, NULL, 1.0), SPH_ERR_ARG);
  check_status(sph_neighbors_rows(list, &offsets, &indices), SPH_ERR_STATE);
  check_status(sph_neighbors_query(list, p, 1.0, 0, NULL, &found), SPH_ERR_STATE);
  assert_int_equal(sph_neighbors_count(NULL), -1);
  assert_int_equal(sph_neighbors_pairs(NULL), -1);
  assert_int_equal(sph_neighbors_builds(NULL), -1);
  assert_int_equal(sph_neighbors_pairs(list), 0);
  check_ok(sph_neighbors_build_arrays(list, 3, 0, NULL, NULL, 1.0));
  check_ok(sph_neighbors_rows(list, &offsets, &indices));
  assert_int_equal(offsets[0], 0);
  check_status(sph_neighbors_rows(list, NULL, &indices), SPH_ERR_ARG);
  check_status(sph_neighbors_rows(NULL, &offsets, &indices), SPH_ERR_ARG);
  check_ok(sph_neighbors_query(list, p, 1.0, 0, NULL, &found));
  assert_int_equal(found, 0);
  check_status(sph_neighbors_query(list, NULL, 1.0, 0, NULL, &found), SPH_ERR_ARG);
  check_status(sph_neighbors_query(list, p, 0.0, 0, NULL, &found), SPH_ERR_ARG);
  check_status(sph_neighbors_query(list, p, NAN, 0, NULL, &found), SPH_ERR_ARG);
  check_status(sph_neighbors_query(list, p, 1.0, 1, NULL, &found), SPH_ERR_ARG);
  check_status(sph_neighbors_query(list, p, 1.0, -1, NULL, &found), SPH_ERR_ARG);
  check_status(sph_neighbors_query(list, p, 1.0, 0, NULL, NULL), SPH_ERR_ARG);
  p[2] = INFINITY;
  check_status(sph_neighbors_query(list, p, 1.0, 0, NULL, &found), SPH_ERR_ARG);
  sph_neighbors_destroy(list);
  sph_context_destroy(ctx);
}

static void check_sentence(sph_context *ctx, const char *a, const char *b) {
  const char *text = sph_context_last_error(ctx);
  if (strstr(text, a) == NULL || strstr(text, b) == NULL) fail_msg("sentence: %s", text);
}

static void test_bad_particles(void **state) {
  (void)state;
  for (int32_t m = SPH_NEIGHBORS_ALL_PAIRS; m <= SPH_NEIGHBORS_TREE; m++) {
    sph_context *ctx = plain_context();
    sph_neighbors *list = make(ctx, m, 0.0);
    double h[N];
    fill_positions(1.0);
    for (int i = 0; i < N; i++) h[i] = 0.05;
    check_ok(sph_neighbors_build_arrays(list, 3, N, positions, h, 0.0));
    int64_t pairs = sph_neighbors_pairs(list);
    positions[3 * 777 + 1] = NAN;
    positions[3 * 900] = INFINITY;
    check_status(sph_neighbors_build_arrays(list, 3, N, positions, h, 0.0), SPH_ERR_ARG);
    check_sentence(ctx, "particle 777", "nan");
    h[41] = -0.5;
    check_status(sph_neighbors_build_arrays(list, 3, N, positions, h, 0.0), SPH_ERR_ARG);
    check_sentence(ctx, "particle 41", "-0.5");
    check_status(sph_neighbors_update_arrays(list, 3, N, positions, h, 0.0, NULL), SPH_ERR_ARG);
    check_status(sph_neighbors_build_arrays(list, 3, N, positions, NULL, 0.0), SPH_ERR_ARG);
    check_status(sph_neighbors_build_arrays(list, 4, N, positions, h, 0.0), SPH_ERR_ARG);
    check_status(sph_neighbors_build_arrays(list, 3, -1, positions, h, 0.0), SPH_ERR_ARG);
    check_status(sph_neighbors_build_arrays(list, 3, INT64_MAX, positions, h, 0.0), SPH_ERR_LIMIT);
    assert_int_equal(sph_neighbors_pairs(list), pairs);
    assert_int_equal(sph_neighbors_builds(list), 1);
    sph_neighbors_destroy(list);
    sph_context_destroy(ctx);
  }
}

static void test_narrow_box(void **state) {
  (void)state;
  sph_context *ctx = plain_context();
  sph_neighbors_options o;
  sph_neighbors *list = NULL;
  sph_neighbors_options_init(&o);
  o.periodic[1] = 1;
  o.box_hi[1] = 1.0;
  check_ok(sph_neighbors_create(ctx, &o, &list));
  fill_positions(1.0);
  check_ok(sph_neighbors_build_arrays(list, 3, 100, positions, NULL, 0.25));
  check_status(sph_neighbors_build_arrays(list, 3, 100, positions, NULL, 0.26), SPH_ERR_LIMIT);
  check_sentence(ctx, "axis 1", "two cutoffs");
  check_ok(sph_neighbors_build_arrays(list, 1, 100, positions, NULL, 0.26));
  positions[1] = 1e30;
  check_status(sph_neighbors_build_arrays(list, 3, 100, positions, NULL, 0.1), SPH_ERR_LIMIT);
  positions[1] = 1e8 + 0.5;
  check_ok(sph_neighbors_build_arrays(list, 3, 100, positions, NULL, 0.1));
  sph_neighbors_destroy(list);
  sph_context_destroy(ctx);
}

/* --- a copy of the rows, to see that a failure leaves them --- */

typedef struct rows_copy {
  int64_t n, pairs;
  int64_t *offsets;
  int32_t *indices;
} rows_copy;

static sph_status take_rows(sph_neighbors *list, rows_copy *copy) {
  const int64_t *offsets;
  const int32_t *indices;
  sph_status s = sph_neighbors_rows(list, &offsets, &indices);
  if (s != SPH_OK) return s;
  copy->n = sph_neighbors_count(list);
  copy->pairs = offsets[copy->n];
  copy->offsets = malloc(((size_t)copy->n + 1) * sizeof *offsets);
  copy->indices = malloc(((size_t)copy->pairs + 1) * sizeof *indices);
  memcpy(copy->offsets, offsets, ((size_t)copy->n + 1) * sizeof *offsets);
  memcpy(copy->indices, indices, (size_t)copy->pairs * sizeof *indices);
  return SPH_OK;
}

static void drop_rows(rows_copy *copy) {
  free(copy->offsets);
  free(copy->indices);
}

static void check_same_rows(sph_neighbors *list, const rows_copy *copy) {
  const int64_t *offsets;
  const int32_t *indices;
  check_ok(sph_neighbors_rows(list, &offsets, &indices));
  assert_int_equal(sph_neighbors_count(list), copy->n);
  assert_int_equal(offsets[copy->n], copy->pairs);
  assert_memory_equal(offsets, copy->offsets, ((size_t)copy->n + 1) * sizeof *offsets);
  assert_memory_equal(indices, copy->indices, (size_t)copy->pairs * sizeof *indices);
}

/* The public rows are cached; a destroyed pair list would show only in rows made afresh, which
 * a reused Verlet list asks for. */
static void check_pairs_alive(sph_neighbors *list, const double *x, double h) {
  const int64_t *offsets;
  const int32_t *indices;
  int32_t rebuilt = 1;
  double moved[N * 3];
  rows_copy copy;
  for (int i = 0; i < N * 3; i++) moved[i] = x[i] + 1e-9;
  check_ok(take_rows(list, &copy));
  check_ok(sph_neighbors_update_arrays(list, 3, N, moved, NULL, h, &rebuilt));
  assert_int_equal(rebuilt, 0);
  check_ok(sph_neighbors_rows(list, &offsets, &indices));
  assert_int_equal(offsets[N], copy.pairs);
  assert_memory_equal(indices, copy.indices, (size_t)copy.pairs * sizeof *indices);
  drop_rows(&copy);
}

static void test_max_pairs(void **state) {
  (void)state;
  sph_context *ctx = plain_context();
  sph_neighbors_options o;
  sph_neighbors *list = NULL;
  sph_neighbors_options_init(&o);
  o.method = SPH_NEIGHBORS_VERLET;
  o.skin = 1e-3;
  o.max_pairs = 100000;
  check_ok(sph_neighbors_create(ctx, &o, &list));
  fill_positions(1.0);
  check_ok(sph_neighbors_build_arrays(list, 3, N, positions, NULL, 0.05));
  rows_copy before;
  check_ok(take_rows(list, &before));
  check_status(sph_neighbors_build_arrays(list, 3, N, positions, NULL, 0.5), SPH_ERR_LIMIT);
  check_sentence(ctx, "max_pairs", "100000");
  check_same_rows(list, &before);
  check_pairs_alive(list, positions, 0.05);
  drop_rows(&before);
  sph_neighbors_destroy(list);
  sph_context_destroy(ctx);
}

/* --- failing memory --- */

/* Build, build a larger list, update: each failure leaves the rows of the last success. */
static sph_status failing_builds(sph_context *ctx, void *user) {
  int32_t method = *(const int32_t *)user;
  sph_neighbors_options o;
  sph_neighbors *list = NULL;
  rows_copy before = {0, 0, NULL, NULL};
  sph_neighbors_options_init(&o);
  o.method = method;
  o.skin = 1e-3;
  sph_status s = sph_neighbors_create(ctx, &o, &list);
  if (s == SPH_OK) s = sph_neighbors_build_arrays(list, 3, 1000, positions, NULL, 0.06);
  if (s == SPH_OK) s = take_rows(list, &before);
  if (s == SPH_OK) {
    s = sph_neighbors_build_arrays(list, 3, N, positions, NULL, 0.1);
    oom_pause();
    if (s != SPH_OK) {
      check_same_rows(list, &before);
      assert_int_equal(sph_neighbors_builds(list), 1);
    }
    oom_resume();
  }
  if (s == SPH_OK) {
    int32_t rebuilt = 7;
    const int64_t *offsets;
    const int32_t *indices;
    positions[0] += 1e-5;
    s = sph_neighbors_update_arrays(list, 3, N, positions, NULL, 0.1, &rebuilt);
    positions[0] -= 1e-5;
    if (s == SPH_OK)
      s = sph_neighbors_rows(list, &offsets, &indices);
    else
      assert_int_equal(rebuilt, 7);
  }
  drop_rows(&before);
  sph_neighbors_destroy(list);
  return s;
}

static void test_failing_memory(void **state) {
  (void)state;
  fill_positions(1.0);
  for (int32_t m = SPH_NEIGHBORS_ALL_PAIRS; m <= SPH_NEIGHBORS_TREE; m++)
    oom_sweep(failing_builds, &m);
}

/* A rebuild that fails halfway, after pairs were overwritten: the pairs themselves survive. */
static sph_status failing_rebuild(sph_context *ctx, void *user) {
  (void)user;
  sph_neighbors *list = NULL;
  oom_pause();
  list = make(ctx, SPH_NEIGHBORS_VERLET, 1e-3);
  check_ok(sph_neighbors_build_arrays(list, 3, N, positions, NULL, 0.06));
  oom_resume();
  sph_status s = sph_neighbors_build_arrays(list, 3, N, positions, NULL, 0.2);
  oom_pause();
  if (s != SPH_OK) check_pairs_alive(list, positions, 0.06);
  oom_resume();
  sph_neighbors_destroy(list);
  return s;
}

static void test_failing_rebuild(void **state) {
  (void)state;
  fill_positions(1.0);
  oom_sweep(failing_rebuild, NULL);
}

static void test_steady_state(void **state) {
  (void)state;
  for (int32_t m = SPH_NEIGHBORS_ALL_PAIRS; m <= SPH_NEIGHBORS_TREE; m++) {
    sph_context *ctx = plain_context();
    sph_neighbors *list = make(ctx, m, 1e-4);
    fill_positions(1.0);
    int64_t before = 0, after = 0;
    for (int step = 0; step < 12; step++) {
      if (step == 4) check_ok(sph_context_memory(ctx, NULL, NULL, &before));
      for (int i = 0; i < N * 3; i++) positions[i] += i % 3 ? 2e-5 : -1e-5;
      int32_t rebuilt;
      check_ok(sph_neighbors_update_arrays(list, 3, N, positions, NULL, 0.08, &rebuilt));
    }
    check_ok(sph_context_memory(ctx, NULL, NULL, &after));
    assert_int_equal(after, before);
    sph_neighbors_destroy(list);
    sph_context_destroy(ctx);
  }
}

/* --- sets --- */

static sph_particles *make_set(sph_context *ctx, int64_t n, double h) {
  sph_particles *set = NULL;
  double *x, *hs;
  check_ok(sph_particles_create(ctx, NULL, &set));
  check_ok(sph_particles_add(set, n, NULL));
  check_ok(sph_particles_field(set, SPH_FIELD_X, &x));
  memcpy(x, positions, (size_t)n * 3 * sizeof *x);
  if (h <= 0.0) return set;
  check_ok(sph_particles_field(set, SPH_FIELD_H, &hs));
  for (int64_t i = 0; i < n; i++) hs[i] = h;
  return set;
}

static void test_sets(void **state) {
  (void)state;
  sph_context *ctx = plain_context();
  fill_positions(1.0);
  sph_particles *set = make_set(ctx, 500, 0.1), *bare = make_set(ctx, 5, 0.0);
  sph_neighbors *list = make(ctx, SPH_NEIGHBORS_VERLET, 0.01);
  int32_t rebuilt;
  double *x, *h;
  check_status(sph_neighbors_build(list, bare), SPH_ERR_ARG);
  check_sentence(ctx, "field h", "");
  check_ok(sph_neighbors_update(list, set, &rebuilt));
  assert_int_equal(rebuilt, 1);
  check_ok(sph_neighbors_update(list, set, &rebuilt));
  assert_int_equal(rebuilt, 0);
  check_ok(sph_particles_field(set, SPH_FIELD_X, &x));
  x[0] += 0.004;
  check_ok(sph_particles_touch(set, SPH_FIELD_X));
  check_ok(sph_neighbors_update(list, set, &rebuilt));
  assert_int_equal(rebuilt, 0);
  x[0] += 0.004;
  check_ok(sph_particles_touch(set, SPH_FIELD_X));
  check_ok(sph_neighbors_update(list, set, &rebuilt));
  assert_int_equal(rebuilt, 1);
  check_ok(sph_particles_field(set, SPH_FIELD_H, &h));
  check_ok(sph_particles_touch(set, SPH_FIELD_H));
  check_ok(sph_neighbors_update(list, set, &rebuilt));
  assert_int_equal(rebuilt, 0);
  h[3] *= 1.5;
  check_ok(sph_particles_touch(set, SPH_FIELD_H));
  check_ok(sph_neighbors_update(list, set, &rebuilt));
  assert_int_equal(rebuilt, 1);
  check_ok(sph_particles_add(set, 1, NULL));
  check_ok(sph_particles_field(set, SPH_FIELD_H, &h));
  check_status(sph_neighbors_update(list, set, &rebuilt), SPH_ERR_ARG); /* the new h is 0 */
  h[500] = 0.1;
  check_ok(sph_neighbors_update(list, set, &rebuilt));
  assert_int_equal(rebuilt, 1);
  assert_int_equal(sph_neighbors_count(list), 501);
  sph_neighbors_destroy(list);
  sph_particles_destroy(set);
  sph_particles_destroy(bare);
  sph_context_destroy(ctx);
}

/* --- a host that asks to stop --- */

static int32_t stop(void *user, double fraction, const char *what) {
  (void)fraction;
  (void)what;
  return *(int *)user;
}

static void test_stop(void **state) {
  (void)state;
  int wish = 0;
  sph_context_options o;
  sph_context *ctx = NULL;
  sph_context_options_init(&o);
  o.progress = stop;
  o.progress_user = &wish;
  check_ok(sph_context_create(&o, &ctx));
  sph_neighbors *list = make(ctx, SPH_NEIGHBORS_VERLET, 1e-3);
  fill_positions(1.0);
  check_ok(sph_neighbors_build_arrays(list, 3, N, positions, NULL, 0.06));
  rows_copy before;
  check_ok(take_rows(list, &before));
  wish = 1;
  check_status(sph_neighbors_build_arrays(list, 3, N, positions, NULL, 0.08), SPH_ERR_CALLBACK);
  check_same_rows(list, &before);
  check_pairs_alive(list, positions, 0.06);
  drop_rows(&before);
  sph_neighbors_destroy(list);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_options),
    cmocka_unit_test(test_null_and_unbuilt),
    cmocka_unit_test(test_bad_particles),
    cmocka_unit_test(test_narrow_box),
    cmocka_unit_test(test_max_pairs),
    cmocka_unit_test(test_failing_memory),
    cmocka_unit_test(test_failing_rebuild),
    cmocka_unit_test(test_steady_state),
    cmocka_unit_test(test_sets),
    cmocka_unit_test(test_stop),
};

SPH_TEST_MAIN(tests)
