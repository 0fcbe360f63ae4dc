/* Every public function that answers a status, with each of its allocations refused in turn: it
 * says SPH_ERR_NOMEM with a sentence, changes nothing a host can see, leaks nothing, and a repeated
 * call does what it would have done. */
#include "../everywhere.h"
#include "../oom.h"

#include <glob.h>

enum { DIM = 2, N = 42, ROWS = 36 };

typedef struct state_of {
  uint64_t set, values, list, output;
} state_of;

static state_of look(const everywhere *w) {
  state_of s = {ew_set_state(w, 1), ew_set_state(w, 0), 0, ew_output(w)};
  s.list = ew_list_state(w);
  return s;
}

static void expect_same(const state_of *a, const state_of *b, const ew_entry *e, const char *when) {
  if (a->values != b->values) fail_msg("%s: the set's values differ %s", e->name, when);
  if (a->list != b->list) fail_msg("%s: the list differs %s", e->name, when);
}

/* One world in which allocation `countdown` of the call is refused; 0 when none was. */
static int refuse_one(const ew_entry *e, int64_t countdown, int once, const state_of *before,
                      const state_of *after) {
  sph_context *ctx = oom_context();
  everywhere *w = ew_open(ctx, DIM, N, ROWS);
  oom.once = once;
  oom.countdown = countdown;
  sph_status status = e->call(w);
  int refused = oom.refused > 0;
  oom.countdown = -1;
  if (refused) {
    check_status(status, SPH_ERR_NOMEM);
    assert_non_null(strstr(sph_context_last_error(ctx), "memory"));
    if (!(e->flags & EW_WRITES)) {
      if (before->set != ew_set_state(w, 1)) fail_msg("%s: the set changed", e->name);
      if (!(e->flags & EW_OUTPUT) && before->output != ew_output(w))
        fail_msg("%s: outputs changed", e->name);
    }
    status = e->call(w);
  }
  if (status != SPH_OK)
    fail_msg("%s: %s: %s", e->name, sph_status_name(status), sph_context_last_error(ctx));
  state_of end = look(w);
  expect_same(&end, after, e, "after a repeated call");
  if (end.output != after->output) fail_msg("%s: outputs of a repeated call differ", e->name);
  ew_close(w);
  sph_context_destroy(ctx);
  oom_check_clean();
  return refused;
}

/* The same, looking at the list in between, which makes its rows. */
static void refuse_and_look(const ew_entry *e, int64_t countdown, const state_of *before) {
  sph_context *ctx = oom_context();
  everywhere *w = ew_open(ctx, DIM, N, ROWS);
  oom.countdown = countdown;
  sph_status status = e->call(w);
  int refused = oom.refused > 0;
  oom.countdown = -1;
  if (refused) check_status(status, SPH_ERR_NOMEM);
  state_of now = look(w);
  if (refused && e->call != ew_sort && e->call != ew_add && now.values != before->values)
    fail_msg("%s: the set's values changed", e->name); /* those two clear the ghosts first */
  if (refused && now.list != before->list) fail_msg("%s: the list changed", e->name);
  ew_close(w);
  sph_context_destroy(ctx);
  oom_check_clean();
}

static void test_every_function(void **state) {
  (void)state;
  for (int k = 0; k < EW_ENTRIES; k++) {
    const ew_entry *e = &ew_entries[k];
    sph_context *ctx = oom_context();
    everywhere *w = ew_open(ctx, DIM, N, ROWS);
    state_of before = look(w), after;
    check_ok(e->call(w));
    after = look(w);
    ew_close(w);
    sph_context_destroy(ctx);
    int64_t refusals = 0;
    for (int once = 0; once < 2; once++)
      for (int64_t countdown = 0; refuse_one(e, countdown, once, &before, &after); countdown++) {
        refuse_and_look(e, countdown, &before);
        refusals++;
        assert_true(countdown < 1000);
      }
    if ((refusals > 0) != e->allocates)
      fail_msg("%s: %d allocations were refused", e->name, (int)refusals);
  }
}

/* The one that has no context yet. */
static void test_context(void **state) {
  (void)state;
  for (int32_t threads = 1; threads <= 3; threads += 2)
    for (int64_t countdown = 0;; countdown++) {
      sph_context_options o;
      sph_context *ctx = (sph_context *)&o;
      oom_reset();
      oom_options(&o);
      o.threads = threads;
      oom.countdown = countdown;
      sph_status status = sph_context_create(&o, &ctx);
      int64_t refused = oom.refused;
      check_status(status, refused > 0 ? SPH_ERR_NOMEM : SPH_OK);
      if (refused > 0) assert_null(ctx);
      sph_context_destroy(ctx);
      oom_check_clean();
      if (refused == 0) break;
      assert_true(countdown < 100);
    }
}

/* Other tests with failing memory. */
static char *read_others(void) {
  static const char *const folders[] = {"tests/api/test_*.c", "tests/unit/test_*.c"};
  char *text = (char *)calloc(1, EW_TEXT);
  assert_non_null(text);
  for (int f = 0; f < 2; f++) {
    glob_t found;
    if (glob(folders[f], 0, NULL, &found) != 0) continue;
    for (size_t k = 0; k < found.gl_pathc; k++) ew_append(text, found.gl_pathv[k], "oom.h\"");
    globfree(&found);
  }
  return text;
}

/* Run from the top of the tree, as the Makefile does; elsewhere there is nothing to read. */
static void test_complete(void **state) {
  (void)state;
  glob_t headers;
  char *others = read_others();
  int missing = 0;
  if (!*others || glob("include/sph/*.h", 0, NULL, &headers) != 0) {
    free(others);
    skip();
  }
  for (size_t k = 0; k < headers.gl_pathc; k++) missing += ew_missing(headers.gl_pathv[k], others);
  globfree(&headers);
  free(others);
  assert_int_equal(missing, 0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_every_function),
    cmocka_unit_test(test_context),
    cmocka_unit_test(test_complete),
};
SPH_TEST_MAIN(tests)
