/* The bottom layer from within: memory, options, errors, loops, life time. */
#include "oom.h"

#include "core/core_impl.h"

#include <stdatomic.h>
#include <stdlib.h>

static sph_context *make_context(int32_t threads) {
  sph_context_options o;
  sph_context *ctx = NULL;
  sph_context_options_init(&o);
  o.threads = threads;
  check_ok(sph_context_create(&o, &ctx));
  return ctx;
}

/* --- memory */

static void test_alloc_is_aligned_and_counted(void **state) {
  (void)state;
  sph_context *ctx = make_context(1);
  int64_t before = 0, bytes = 0, peak = 0, count = 0;
  check_ok(sph_context_memory(ctx, &before, NULL, NULL));
  assert_true(before > 0);
  void *a = sphi_alloc(ctx, 1), *b = sphi_calloc(ctx, 1000);
  assert_int_equal((uintptr_t)a % 64, 0);
  assert_int_equal((uintptr_t)b % 64, 0);
  for (int i = 0; i < 1000; ++i) assert_int_equal(((unsigned char *)b)[i], 0);
  check_ok(sph_context_memory(ctx, &bytes, &peak, &count));
  assert_int_equal(bytes, before + 64 + 1024);
  assert_int_equal(peak, bytes);
  assert_int_equal(count, 3);
  sphi_free(ctx, a, 1);
  sphi_free(ctx, b, 1000);
  sphi_free(ctx, NULL, 17);
  check_ok(sph_context_memory(ctx, &bytes, &peak, &count));
  assert_int_equal(bytes, before);
  assert_int_equal(peak, before + 64 + 1024);
  assert_int_equal(count, 3);
  sph_context_destroy(ctx);
}

static void test_alloc_of_nothing(void **state) {
  (void)state;
  sph_context *ctx = oom_context();
  void *a = sphi_alloc(ctx, 0), *b = sphi_calloc(ctx, 0);
  assert_non_null(a);
  assert_non_null(b);
  assert_ptr_not_equal(a, b);
  sphi_free(ctx, a, 0);
  sphi_free(ctx, b, 0);
  sph_context_destroy(ctx);
  oom_check_clean();
}

static void test_alloc_refuses_absurd_sizes(void **state) {
  (void)state;
  sph_context *ctx = oom_context();
  int64_t asked = oom.allocations;
  assert_null(sphi_alloc(ctx, SIZE_MAX));
  assert_null(sphi_alloc(ctx, SIZE_MAX - 63));
  assert_null(sphi_calloc(ctx, (size_t)PTRDIFF_MAX));
  assert_int_equal(oom.allocations, asked);
  assert_non_null(strstr(sph_context_last_error(ctx), "9223372036854775807 bytes"));
  sph_context_destroy(ctx);
  oom_check_clean();
}

static void test_mul_saturates(void **state) {
  (void)state;
  assert_int_equal(sphi_mul(0, SIZE_MAX), 0);
  assert_int_equal(sphi_mul(SIZE_MAX, 0), 0);
  assert_int_equal(sphi_mul(3, 7), 21);
  assert_int_equal(sphi_mul(SIZE_MAX, 1), SIZE_MAX);
  assert_int_equal(sphi_mul(SIZE_MAX / 2 + 1, 2), SIZE_MAX);
  assert_int_equal(sphi_mul((size_t)1 << 32, (size_t)1 << 32), SIZE_MAX);
}

static void test_buffer_grows_and_stays(void **state) {
  (void)state;
  sph_context *ctx = oom_context();
  sphi_buffer b = {NULL, 0};
  check_ok(sphi_buffer_reserve(ctx, &b, 0));
  assert_non_null(b.ptr);
  check_ok(sphi_buffer_reserve(ctx, &b, 1000));
  void *kept = b.ptr;
  int64_t asked = oom.allocations;
  check_ok(sphi_buffer_reserve(ctx, &b, 1000));
  check_ok(sphi_buffer_reserve(ctx, &b, 10));
  assert_ptr_equal(b.ptr, kept);
  assert_int_equal(oom.allocations, asked);
  oom.countdown = 0;
  check_status(sphi_buffer_reserve(ctx, &b, 5000), SPH_ERR_NOMEM);
  assert_ptr_equal(b.ptr, kept);
  assert_int_equal(b.bytes, 1000);
  oom.countdown = -1;
  check_status(sphi_buffer_reserve(ctx, &b, SIZE_MAX), SPH_ERR_NOMEM);
  check_ok(sphi_buffer_reserve(ctx, &b, 1001));
  assert_true(b.bytes >= 1001);
  sphi_buffer_free(ctx, &b);
  sphi_buffer_free(ctx, &b);
  sph_context_destroy(ctx);
  oom_check_clean();
}

/* --- options */

typedef struct options_v1 {
  size_t size;
  int32_t a;
  int32_t b;
} options_v1;

typedef struct options_v2 {
  options_v1 old;
  double c;
  int64_t d;
} options_v2;

static void test_options_of_every_age(void **state) {
  (void)state;
  options_v1 mine = {sizeof mine, 1, 2};
  options_v2 newer;
  memset(&newer, 0, sizeof newer);
  newer.old.size = sizeof newer;
  newer.old.a = 7;
  /* a newer host that sets nothing new */
  check_ok(sphi_options_read(NULL, &mine, sizeof mine, &newer));
  assert_int_equal(mine.a, 7);
  assert_int_equal(mine.b, 0);
  assert_int_equal(mine.size, sizeof mine);
  /* a newer host that wants something unknown */
  newer.d = 1;
  newer.old.a = 8;
  check_status(sphi_options_read(NULL, &mine, sizeof mine, &newer), SPH_ERR_VERSION);
  assert_int_equal(mine.a, 7);
  /* an older host keeps the defaults of what it does not know */
  options_v1 old = {sizeof(size_t) + sizeof(int32_t), 5, 99};
  mine.b = 3;
  check_ok(sphi_options_read(NULL, &mine, sizeof mine, &old));
  assert_int_equal(mine.a, 5);
  assert_int_equal(mine.b, 3);
  check_ok(sphi_options_read(NULL, &mine, sizeof mine, NULL));
  assert_int_equal(mine.a, 5);
}

static void test_options_sizes_that_nobody_set(void **state) {
  (void)state;
  options_v1 mine = {sizeof mine, 1, 2}, bad = {0, 9, 9};
  const size_t sizes[] = {0, 1, sizeof(size_t) - 1, (size_t)1 << 20, SIZE_MAX};
  for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
    bad.size = sizes[i];
    check_status(sphi_options_read(NULL, &mine, sizeof mine, &bad), SPH_ERR_ARG);
  }
  assert_int_equal(mine.a, 1);
}

static void test_options_init_cuts_and_pads(void **state) {
  (void)state;
  const options_v1 defaults = {sizeof defaults, 4, 5};
  options_v2 o;
  memset(&o, 0xff, sizeof o);
  sphi_options_init(&o, sizeof o, &defaults, sizeof defaults);
  assert_int_equal(o.old.size, sizeof o);
  assert_int_equal(o.old.b, 5);
  assert_int_equal(o.d, 0);
  memset(&o, 0xff, sizeof o);
  sphi_options_init(&o, sizeof(size_t) + sizeof(int32_t), &defaults, sizeof defaults);
  assert_int_equal(o.old.a, 4);
  assert_int_equal(o.old.b, -1);
  memset(&o, 0xff, sizeof o);
  sphi_options_init(&o, 3, &defaults, sizeof defaults);
  assert_int_equal(o.old.a, -1);
  sphi_options_init(NULL, sizeof o, &defaults, sizeof defaults);
}

/* --- errors */

static void test_fail_keeps_the_sentence(void **state) {
  (void)state;
  sph_context *ctx = make_context(1);
  assert_string_equal(sph_context_last_error(ctx), "");
  check_status(sphi_fail(ctx, SPH_ERR_ARG, "h = %g of particle %d", -1.5, 7), SPH_ERR_ARG);
  assert_string_equal(sph_context_last_error(ctx), "h = -1.5 of particle 7");
  sphi_fail(ctx, SPH_ERR_ARG, "outer: %s", sph_context_last_error(ctx));
  assert_string_equal(sph_context_last_error(ctx), "outer: h = -1.5 of particle 7");
  check_status(sphi_fail(NULL, SPH_ERR_IO, "%s", "nobody hears"), SPH_ERR_IO);
  sph_context_destroy(ctx);
}

static void test_fail_cuts_long_sentences(void **state) {
  (void)state;
  sph_context *ctx = make_context(1);
  char text[4096];
  memset(text, 'x', sizeof text);
  text[sizeof text - 1] = '\0';
  sphi_fail(ctx, SPH_ERR_ARG, "%s", text);
  assert_int_equal(strlen(sph_context_last_error(ctx)), SPHI_ERROR_LENGTH - 1);
  sph_context_destroy(ctx);
}

static void test_check_handle(void **state) {
  (void)state;
  sph_context *ctx = make_context(1);
  sphi_object o = {SPHI_MAGIC_KERNEL, ctx};
  check_ok(sphi_check_handle(ctx, &o, SPHI_MAGIC_KERNEL, "kernel"));
  check_status(sphi_check_handle(ctx, NULL, SPHI_MAGIC_KERNEL, "kernel"), SPH_ERR_ARG);
  assert_string_equal(sph_context_last_error(ctx), "kernel is NULL");
  check_status(sphi_check_handle(ctx, &o, SPHI_MAGIC_RHS, "rhs"), SPH_ERR_HANDLE);
  assert_non_null(strstr(sph_context_last_error(ctx), "rhs is a handle of another kind"));
  check_status(sphi_check_handle(NULL, &o, SPHI_MAGIC_RHS, "rhs"), SPH_ERR_HANDLE);
  o.magic = 0;
  check_status(sphi_check_handle(ctx, &o, SPHI_MAGIC_KERNEL, "kernel"), SPH_ERR_HANDLE);
  sph_context_destroy(ctx);
}

typedef struct heard {
  int count;
  int32_t level;
  char text[256];
} heard;

static void listen(void *user, int32_t level, const char *text) {
  heard *h = user;
  ++h->count;
  h->level = level;
  snprintf(h->text, sizeof h->text, "%s", text);
}

static void test_log_filters_by_level(void **state) {
  (void)state;
  heard h = {0, 0, ""};
  for (int32_t limit = 0; limit <= SPH_LOG_DEBUG; ++limit) {
    sph_context_options o;
    sph_context *ctx = NULL;
    sph_context_options_init(&o);
    o.log = listen;
    o.log_user = &h;
    o.log_level = limit;
    check_ok(sph_context_create(&o, &ctx));
    h.count = 0;
    for (int32_t level = SPH_LOG_WARNING; level <= SPH_LOG_DEBUG; ++level)
      sphi_log(ctx, level, "level %d", level);
    sphi_fail(ctx, SPH_ERR_ARG, "failure");
    assert_int_equal(h.count, limit);
    if (limit >= SPH_LOG_ERROR) assert_string_equal(h.text, "failure");
    sph_context_destroy(ctx);
  }
  sphi_log(NULL, SPH_LOG_ERROR, "nobody hears");
}

static int32_t stop_at_half(void *user, double fraction, const char *what) {
  ++*(int *)user;
  assert_string_equal(what, "settling");
  return fraction >= 0.5;
}

static void test_progress_can_stop(void **state) {
  (void)state;
  int calls = 0;
  sph_context_options o;
  sph_context *ctx = NULL;
  sph_context_options_init(&o);
  o.progress = stop_at_half;
  o.progress_user = &calls;
  check_ok(sph_context_create(&o, &ctx));
  check_ok(sphi_progress(ctx, 0.25, "settling"));
  check_status(sphi_progress(ctx, 0.5, "settling"), SPH_ERR_CALLBACK);
  assert_string_equal(sph_context_last_error(ctx), "the host stopped settling at 50.0 %");
  assert_int_equal(calls, 2);
  sph_context_destroy(ctx);
  check_ok(sphi_progress(NULL, 0.5, "settling"));
}

/* --- life time */

static void test_context_outlives_the_hosts_reference(void **state) {
  (void)state;
  sph_context *ctx = oom_context();
  sphi_context_retain(ctx);
  sphi_context_retain(ctx);
  sph_context_destroy(ctx);
  sph_context_destroy(ctx); /* a second time must not take a reference of ours */
  assert_true(oom.live_blocks > 0);
  void *p = sphi_alloc(ctx, 100);
  assert_non_null(p);
  sphi_free(ctx, p, 100);
  sphi_context_release(ctx);
  assert_true(oom.live_blocks > 0);
  sphi_context_release(ctx);
  oom_check_clean();
}

static void test_context_create_without_memory(void **state) {
  (void)state;
  const int32_t threads[] = {1, 4};
  for (int k = 0; k < 2; ++k) {
    int64_t countdown = 0;
    sph_context *ctx = NULL;
    for (;; ++countdown) {
      sph_context_options o;
      oom_reset();
      oom_options(&o);
      o.threads = threads[k];
      oom.countdown = countdown;
      ctx = (sph_context *)&o;
      sph_status status = sph_context_create(&o, &ctx);
      if (oom.refused == 0) {
        check_ok(status);
        break;
      }
      check_status(status, SPH_ERR_NOMEM);
      assert_null(ctx);
      oom_check_clean();
    }
    assert_int_equal(countdown, k + 1);
    sph_context_destroy(ctx);
    oom_check_clean();
  }
}

static sph_status two_buffers(sph_context *ctx, void *user) {
  sphi_buffer a = {NULL, 0}, b = {NULL, 0};
  (void)user;
  sph_status status = sphi_buffer_reserve(ctx, &a, 100);
  if (status == SPH_OK) status = sphi_buffer_reserve(ctx, &b, 200);
  if (status == SPH_OK) status = sphi_buffer_reserve(ctx, &a, 4000);
  sphi_buffer_free(ctx, &a);
  sphi_buffer_free(ctx, &b);
  return status;
}

static void test_sweep_of_failing_allocations(void **state) {
  (void)state;
  oom_sweep(two_buffers, NULL);
}

/* --- loops */

typedef struct tally {
  int32_t workers;
  _Atomic int32_t inside[16]; /* per worker number: bodies running now */
  _Atomic int32_t clashes;
  _Atomic int64_t outside;
  _Atomic unsigned char *seen;
  int64_t count;
} tally;

static void tally_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  tally *t = job;
  if (worker < 0 || worker >= t->workers || begin < 0 || end > t->count || begin >= end) {
    atomic_fetch_add(&t->outside, 1);
    return;
  }
  if (atomic_fetch_add(&t->inside[worker], 1) != 0) atomic_fetch_add(&t->clashes, 1);
  for (int64_t i = begin; i < end; ++i) atomic_fetch_add(&t->seen[i], 1);
  atomic_fetch_sub(&t->inside[worker], 1);
}

static void check_cover(sph_context *ctx, int64_t count, int64_t grain) {
  tally t;
  memset(&t, 0, sizeof t);
  t.workers = sphi_workers(ctx);
  t.count = count;
  t.seen = calloc((size_t)count + 1, sizeof *t.seen);
  assert_non_null((void *)t.seen);
  sphi_parallel(ctx, count, grain, tally_body, &t);
  int64_t wrong = 0;
  for (int64_t i = 0; i < count; ++i) wrong += atomic_load(&t.seen[i]) != 1;
  wrong += atomic_load(&t.seen[count]);
  free((void *)t.seen);
  assert_int_equal(wrong, 0);
  assert_int_equal(atomic_load(&t.clashes), 0);
  assert_int_equal(atomic_load(&t.outside), 0);
}

static void test_pool_covers_every_index_once(void **state) {
  (void)state;
  const int32_t threads[] = {1, 2, 3, 8, 16};
  const int64_t counts[] = {0, 1, 2, 7, 64, 1000, 4096};
  const int64_t grains[] = {-1, 0, 1, 3, 64, 1000, INT64_C(1) << 40};
  for (size_t k = 0; k < sizeof threads / sizeof threads[0]; ++k) {
    sph_context *ctx = make_context(threads[k]);
    assert_int_equal(sphi_workers(ctx), threads[k]);
    for (size_t c = 0; c < sizeof counts / sizeof counts[0]; ++c)
      for (size_t g = 0; g < sizeof grains / sizeof grains[0]; ++g)
        check_cover(ctx, counts[c], grains[g]);
    sph_context_destroy(ctx);
  }
}

static void add_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  (void)worker;
  for (int64_t i = begin; i < end; ++i) ++((int64_t *)job)[i];
}

/* Loops in quick succession meet threads that are still waking from the previous one. */
static void test_pool_runs_many_small_loops(void **state) {
  (void)state;
  const int32_t threads[] = {2, 3, 8};
  const int64_t rounds = check_long_run ? 200000 : 5000;
  for (size_t k = 0; k < sizeof threads / sizeof threads[0]; ++k) {
    sph_context *ctx = make_context(threads[k]);
    int64_t values[40] = {0};
    for (int64_t r = 0; r < rounds; ++r) sphi_parallel(ctx, 40, 1 + r % 7, add_body, values);
    for (int i = 0; i < 40; ++i) assert_int_equal(values[i], rounds);
    sph_context_destroy(ctx);
  }
}

static void test_pool_starts_and_stops(void **state) {
  (void)state;
  for (int i = 0; i < 200; ++i) {
    sph_context *ctx = make_context(1 + i % 8);
    if (i % 3 == 0) check_cover(ctx, 10, 1);
    sph_context_destroy(ctx);
  }
}

static void test_steady_loops_allocate_nothing(void **state) {
  (void)state;
  sph_context *ctx = make_context(3);
  int64_t before = 0, after = 0, values[100] = {0};
  check_ok(sph_context_memory(ctx, NULL, NULL, &before));
  for (int i = 0; i < 100; ++i) sphi_parallel(ctx, 100, 1, add_body, values);
  check_ok(sph_context_memory(ctx, NULL, NULL, &after));
  assert_int_equal(before, after);
  sph_context_destroy(ctx);
}

static void lowest_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  (void)worker;
  for (int64_t i = begin; i < end; ++i)
    if (i % 1000 == 77) sphi_lowest(job, i);
}

static void test_lowest_index_wins(void **state) {
  (void)state;
  sph_context *ctx = make_context(8);
  for (int i = 0; i < 50; ++i) {
    int64_t slot = INT64_MAX;
    sphi_parallel(ctx, 20000, 10, lowest_body, &slot);
    assert_int_equal(slot, 77);
    sphi_parallel(ctx, 70, 10, lowest_body, &slot);
    assert_int_equal(slot, 77);
  }
  sph_context_destroy(ctx);
}

static void test_processors(void **state) {
  (void)state;
  assert_in_range(sphi_processors(), 1, SPHI_MAX_THREADS);
}

static void test_isa_choose(void **state) {
  (void)state;
  int32_t isa = -7;
  check_status(sphi_isa_choose(-1, &isa), SPH_ERR_ARG);
  check_status(sphi_isa_choose(4, &isa), SPH_ERR_ARG);
  assert_int_equal(isa, -7);
  check_ok(sphi_isa_choose(SPH_ISA_AUTO, &isa));
  assert_int_equal(sph_isa_available(isa), 1);
  for (int32_t better = isa + 1; better <= SPH_ISA_AVX512; ++better) {
    assert_int_equal(sph_isa_available(better), 0);
    check_status(sphi_isa_choose(better, &isa), SPH_ERR_UNSUPPORTED);
  }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_alloc_is_aligned_and_counted),
    cmocka_unit_test(test_alloc_of_nothing),
    cmocka_unit_test(test_alloc_refuses_absurd_sizes),
    cmocka_unit_test(test_mul_saturates),
    cmocka_unit_test(test_buffer_grows_and_stays),
    cmocka_unit_test(test_options_of_every_age),
    cmocka_unit_test(test_options_sizes_that_nobody_set),
    cmocka_unit_test(test_options_init_cuts_and_pads),
    cmocka_unit_test(test_fail_keeps_the_sentence),
    cmocka_unit_test(test_fail_cuts_long_sentences),
    cmocka_unit_test(test_check_handle),
    cmocka_unit_test(test_log_filters_by_level),
    cmocka_unit_test(test_progress_can_stop),
    cmocka_unit_test(test_context_outlives_the_hosts_reference),
    cmocka_unit_test(test_context_create_without_memory),
    cmocka_unit_test(test_sweep_of_failing_allocations),
    cmocka_unit_test(test_pool_covers_every_index_once),
    cmocka_unit_test(test_pool_runs_many_small_loops),
    cmocka_unit_test(test_pool_starts_and_stops),
    cmocka_unit_test(test_steady_loops_allocate_nothing),
    cmocka_unit_test(test_lowest_index_wins),
    cmocka_unit_test(test_processors),
    cmocka_unit_test(test_isa_choose),
};

SPH_TEST_MAIN(tests)
