/* The context through its public header. */
#include "oom.h"

#include <stdlib.h>

#include <sph/sph.h>

static sph_context *create(const sph_context_options *options) {
  sph_context *ctx = NULL;
  check_ok(sph_context_create(options, &ctx));
  assert_non_null(ctx);
  return ctx;
}

/* *out starts as garbage: a failure must set it to NULL. */
static void check_refused(const sph_context_options *options, sph_status want) {
  int garbage = 0;
  sph_context *ctx = (sph_context *)(void *)&garbage;
  check_status(sph_context_create(options, &ctx), want);
  assert_null(ctx);
}

/* --- version and statuses */

static void test_version(void **state) {
  (void)state;
  int32_t major = -1, minor = -1, patch = -1;
  char text[32];
  sph_version(&major, &minor, &patch);
  assert_int_equal(major, SPH_VERSION_MAJOR);
  assert_int_equal(minor, SPH_VERSION_MINOR);
  assert_int_equal(patch, SPH_VERSION_PATCH);
  snprintf(text, sizeof text, "%d.%d.%d", (int)major, (int)minor, (int)patch);
  assert_string_equal(sph_version_string(), text);
  sph_version(NULL, NULL, NULL);
}

static void test_status_names_and_texts(void **state) {
  (void)state;
#define ONE_STATUS(name, value, text)                 \
  assert_int_equal(name, value);                      \
  assert_string_equal(sph_status_name(value), #name); \
  assert_string_equal(sph_status_text(value), text);
  SPH_STATUS_LIST(ONE_STATUS)
#undef ONE_STATUS
  assert_string_equal(sph_status_name(12345), "unknown");
  assert_string_equal(sph_status_text(-12345), "unknown status");
}

static void test_sym_components(void **state) {
  (void)state;
  const int32_t want[] = {0, 1, 3, 6, 0};
  for (int32_t dim = 0; dim < 5; ++dim) assert_int_equal(sph_sym_components(dim), want[dim]);
  assert_int_equal(sph_sym_components(-1), 0);
  assert_int_equal(sph_sym_components(INT32_MAX), 0);
}

/* --- creation */

static void test_defaults(void **state) {
  (void)state;
  sph_context_options o;
  memset(&o, 0xff, sizeof o);
  sph_context_options_init(&o);
  assert_int_equal(o.size, sizeof o);
  assert_true(o.alloc == NULL && o.free == NULL && o.parallel_for == NULL);
  assert_true(o.log == NULL && o.progress == NULL);
  assert_int_equal(o.threads, 1);
  assert_int_equal(o.isa, SPH_ISA_AUTO);
  assert_int_equal(o.log_level, SPH_LOG_WARNING);
  const sph_context_options *both[] = {NULL, &o};
  for (int i = 0; i < 2; ++i) {
    sph_context *ctx = create(both[i]);
    assert_int_equal(sph_context_workers(ctx), 1);
    assert_in_range(sph_context_isa(ctx), SPH_ISA_PORTABLE, SPH_ISA_AVX512);
    assert_string_equal(sph_context_last_error(ctx), "");
    sph_context_destroy(ctx);
  }
}

static void test_null_everywhere(void **state) {
  (void)state;
  check_status(sph_context_create(NULL, NULL), SPH_ERR_ARG);
  sph_context_options_init(NULL);
  sph_context_destroy(NULL);
  assert_string_equal(sph_context_last_error(NULL), "");
  assert_int_equal(sph_context_workers(NULL), 0);
  assert_int_equal(sph_context_isa(NULL), 0);
  check_status(sph_context_memory(NULL, NULL, NULL, NULL), SPH_ERR_ARG);
  check_status(sph_parallel_for(NULL, 1, 1, NULL, NULL), SPH_ERR_ARG);
  sph_context *ctx = create(NULL);
  check_ok(sph_context_memory(ctx, NULL, NULL, NULL));
  sph_context_destroy(ctx);
}

static void some_loop(void *user, int64_t count, int64_t grain, sph_loop_fn body, void *job) {
  (void)user;
  (void)grain;
  body(job, 0, count, 0);
}

static void test_bad_options(void **state) {
  (void)state;
  sph_context_options good, o;
  sph_context_options_init(&good);
  o = good;
  o.alloc = oom_alloc;
  check_refused(&o, SPH_ERR_ARG);
  o = good;
  o.free = oom_free;
  check_refused(&o, SPH_ERR_ARG);
  const int32_t threads[] = {-1, INT32_MIN, 1025, INT32_MAX};
  for (int i = 0; i < 4; ++i) {
    o = good;
    o.threads = threads[i];
    check_refused(&o, SPH_ERR_ARG);
  }
  const int32_t workers[] = {0, -1, INT32_MIN};
  for (int i = 0; i < 3; ++i) {
    o = good;
    o.parallel_for = some_loop;
    o.workers = workers[i];
    check_refused(&o, SPH_ERR_ARG);
  }
  const int32_t isas[] = {-1, 4, INT32_MIN, INT32_MAX};
  for (int i = 0; i < 4; ++i) {
    o = good;
    o.isa = isas[i];
    check_refused(&o, SPH_ERR_ARG);
  }
}

static void test_options_of_other_sizes(void **state) {
  (void)state;
  struct {
    sph_context_options o;
    unsigned char tail[64];
  } newer;
  memset(&newer, 0xff, sizeof newer);
  sph_context_options_init_sized(&newer.o, sizeof newer);
  assert_int_equal(newer.o.size, sizeof newer);
  for (size_t i = 0; i < sizeof newer.tail; ++i) assert_int_equal(newer.tail[i], 0);
  sph_context_destroy(create(&newer.o));
  newer.tail[63] = 1;
  check_refused(&newer.o, SPH_ERR_VERSION);
  newer.tail[63] = 0;
  newer.tail[0] = 1;
  check_refused(&newer.o, SPH_ERR_VERSION);
  newer.o.size = 0;
  check_refused(&newer.o, SPH_ERR_ARG);
  newer.o.size = SIZE_MAX;
  check_refused(&newer.o, SPH_ERR_ARG);

  /* an older host: bytes beyond its size are neither written nor read */
  sph_context_options old;
  memset(&old, 0x55, sizeof old);
  const size_t before_isa = offsetof(sph_context_options, isa);
  sph_context_options_init_sized(&old, before_isa);
  assert_int_equal(old.isa, 0x55555555);
  assert_int_equal(old.threads, 1);
  sph_context *ctx = create(&old);
  assert_in_range(sph_context_isa(ctx), SPH_ISA_PORTABLE, SPH_ISA_AVX512);
  sph_context_destroy(ctx);
}

static void test_forced_instruction_sets(void **state) {
  (void)state;
  int32_t best = SPH_ISA_PORTABLE;
  for (int32_t isa = SPH_ISA_PORTABLE; isa <= SPH_ISA_AVX512; ++isa) {
    sph_context_options o;
    sph_context_options_init(&o);
    o.isa = isa;
    if (!sph_isa_available(isa)) {
      check_refused(&o, SPH_ERR_UNSUPPORTED);
      continue;
    }
    best = isa;
    sph_context *ctx = create(&o);
    assert_int_equal(sph_context_isa(ctx), isa);
    sph_context_destroy(ctx);
  }
  sph_context *ctx = create(NULL);
  assert_int_equal(sph_context_isa(ctx), best);
  sph_context_destroy(ctx);
}

static void test_instruction_set_names(void **state) {
  (void)state;
  assert_int_equal(sph_isa_available(SPH_ISA_PORTABLE), 1);
  assert_int_equal(sph_isa_available(-1), 0);
  assert_int_equal(sph_isa_available(99), 0);
  assert_string_equal(sph_isa_name(SPH_ISA_PORTABLE), "portable");
  assert_string_equal(sph_isa_name(SPH_ISA_AVX2), "avx2");
  assert_string_equal(sph_isa_name(SPH_ISA_AVX512), "avx512");
  assert_string_equal(sph_isa_name(SPH_ISA_AUTO), "unknown");
  assert_string_equal(sph_isa_name(-5), "unknown");
}

static void test_thread_counts(void **state) {
  (void)state;
  const int32_t threads[] = {0, 1, 2, 3, 8, 64};
  for (int i = 0; i < 6; ++i) {
    sph_context_options o;
    sph_context_options_init(&o);
    o.threads = threads[i];
    sph_context *ctx = create(&o);
    if (threads[i] > 0)
      assert_int_equal(sph_context_workers(ctx), threads[i]);
    else
      assert_in_range(sph_context_workers(ctx), 1, 1024);
    sph_context_destroy(ctx);
  }
}

static void test_two_contexts_share_nothing(void **state) {
  (void)state;
  sph_context *a = create(NULL), *b = create(NULL);
  check_status(sph_parallel_for(a, -1, 1, NULL, NULL), SPH_ERR_ARG);
  assert_true(sph_context_last_error(a)[0] != '\0');
  assert_string_equal(sph_context_last_error(b), "");
  sph_context_destroy(a);
  assert_string_equal(sph_context_last_error(b), "");
  sph_context_destroy(b);
}

/* --- handles of another kind */

static void test_wrong_handle(void **state) {
  (void)state;
  int64_t bytes = -1;
  union {
    uint64_t words[64];
    unsigned char raw[512];
  } other;
  memset(&other, 0x41, sizeof other);
  sph_context *wrong = (sph_context *)(void *)&other;
  assert_string_equal(sph_context_last_error(wrong), "");
  assert_int_equal(sph_context_workers(wrong), 0);
  assert_int_equal(sph_context_isa(wrong), 0);
  check_status(sph_context_memory(wrong, &bytes, NULL, NULL), SPH_ERR_HANDLE);
  assert_int_equal(bytes, -1);
  check_status(sph_parallel_for(wrong, 1, 1, NULL, NULL), SPH_ERR_HANDLE);
  sph_context_destroy(wrong);
  for (size_t i = 0; i < sizeof other.raw; ++i) assert_int_equal(other.raw[i], 0x41);
}

/* --- memory hooks */

static void test_memory_is_given_back(void **state) {
  (void)state;
  const int32_t threads[] = {1, 4};
  for (int i = 0; i < 2; ++i) {
    sph_context_options o;
    oom_reset();
    oom_options(&o);
    o.threads = threads[i];
    sph_context *ctx = create(&o);
    int64_t bytes = 0, peak = 0, count = 0;
    check_ok(sph_context_memory(ctx, &bytes, &peak, &count));
    assert_int_equal(bytes, oom.live_bytes);
    assert_int_equal(count, oom.allocations);
    assert_true(peak >= bytes);
    sph_context_destroy(ctx);
    oom_check_clean();
  }
}

static void test_no_memory(void **state) {
  (void)state;
  for (int64_t countdown = 0; countdown < 2; ++countdown) {
    sph_context_options o;
    oom_reset();
    oom_options(&o);
    o.threads = 3;
    oom.countdown = countdown;
    check_refused(&o, SPH_ERR_NOMEM);
    oom_check_clean();
  }
}

/* --- log hook and last error */

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

static void nothing(void *job, int64_t begin, int64_t end, int32_t worker) {
  (void)job;
  (void)begin;
  (void)end;
  (void)worker;
}

static void test_errors_reach_the_log(void **state) {
  (void)state;
  heard h = {0, 0, ""};
  sph_context_options o;
  sph_context_options_init(&o);
  o.log = listen;
  o.log_user = &h;
  sph_context *ctx = create(&o);
  check_ok(sph_parallel_for(ctx, 3, 1, nothing, NULL));
  assert_int_equal(h.count, 0);
  check_status(sph_parallel_for(ctx, -42, 1, nothing, NULL), SPH_ERR_ARG);
  assert_int_equal(h.count, 1);
  assert_int_equal(h.level, SPH_LOG_ERROR);
  assert_string_equal(h.text, sph_context_last_error(ctx));
  assert_non_null(strstr(h.text, "-42"));
  /* success leaves the sentence of the last failure */
  check_ok(sph_parallel_for(ctx, 3, 1, nothing, NULL));
  assert_non_null(strstr(sph_context_last_error(ctx), "-42"));
  sph_context_destroy(ctx);
}

static void test_log_level_zero_is_silent(void **state) {
  (void)state;
  heard h = {0, 0, ""};
  sph_context_options o;
  sph_context_options_init(&o);
  o.log = listen;
  o.log_user = &h;
  o.log_level = 0;
  sph_context *ctx = create(&o);
  check_status(sph_parallel_for(ctx, 1, 0, nothing, NULL), SPH_ERR_ARG);
  assert_int_equal(h.count, 0);
  assert_true(sph_context_last_error(ctx)[0] != '\0');
  sph_context_destroy(ctx);
}

/* --- loops */

enum { COUNT = 1003 };

typedef struct marks {
  int32_t workers;
  int32_t worker_of[COUNT];
  int32_t times[COUNT];
} marks;

static void mark(void *job, int64_t begin, int64_t end, int32_t worker) {
  marks *m = job;
  for (int64_t i = begin; i < end; ++i) {
    ++m->times[i];
    m->worker_of[i] = worker;
  }
}

static void check_marks(sph_context *ctx, int64_t grain) {
  static marks m;
  memset(&m, 0, sizeof m);
  check_ok(sph_parallel_for(ctx, COUNT, grain, mark, &m));
  for (int i = 0; i < COUNT; ++i) {
    assert_int_equal(m.times[i], 1);
    assert_true(m.worker_of[i] >= 0 && m.worker_of[i] < sph_context_workers(ctx));
  }
}

static void test_loops_on_own_threads(void **state) {
  (void)state;
  const int32_t threads[] = {1, 2, 3, 8};
  const int64_t grains[] = {1, 7, 64, COUNT, INT64_MAX};
  for (int k = 0; k < 4; ++k) {
    sph_context_options o;
    sph_context_options_init(&o);
    o.threads = threads[k];
    sph_context *ctx = create(&o);
    for (int g = 0; g < 5; ++g) check_marks(ctx, grains[g]);
    sph_context_destroy(ctx);
  }
}

static void test_loop_arguments(void **state) {
  (void)state;
  sph_context *ctx = create(NULL);
  check_status(sph_parallel_for(ctx, 1, 1, NULL, NULL), SPH_ERR_ARG);
  check_status(sph_parallel_for(ctx, -1, 1, nothing, NULL), SPH_ERR_ARG);
  check_status(sph_parallel_for(ctx, INT64_MIN, 1, nothing, NULL), SPH_ERR_ARG);
  check_status(sph_parallel_for(ctx, 1, 0, nothing, NULL), SPH_ERR_ARG);
  check_status(sph_parallel_for(ctx, 1, -3, nothing, NULL), SPH_ERR_ARG);
  check_ok(sph_parallel_for(ctx, 0, 1, nothing, NULL));
  sph_context_destroy(ctx);
}

typedef struct nested {
  sph_context *ctx;
  sph_status status[8];
} nested;

static void loop_in_loop(void *job, int64_t begin, int64_t end, int32_t worker) {
  nested *n = job;
  (void)worker;
  for (int64_t i = begin; i < end; ++i)
    n->status[i] = sph_parallel_for(n->ctx, 10, 1, nothing, NULL);
}

static void test_loops_do_not_nest(void **state) {
  (void)state;
  const int32_t threads[] = {1, 3};
  for (int k = 0; k < 2; ++k) {
    sph_context_options o;
    sph_context_options_init(&o);
    o.threads = threads[k];
    nested n = {create(&o), {0}};
    check_ok(sph_parallel_for(n.ctx, 8, 1, loop_in_loop, &n));
    for (int i = 0; i < 8; ++i) assert_int_equal(n.status[i], SPH_ERR_STATE);
    check_ok(sph_parallel_for(n.ctx, 8, 1, nothing, NULL));
    sph_context_destroy(n.ctx);
  }
}

/* Cuts that a host may choose: one piece, single indices backwards, uneven pieces. */
static void host_whole(void *user, int64_t count, int64_t grain, sph_loop_fn body, void *job) {
  (void)grain;
  ++*(int *)user;
  body(job, 0, count, 4);
}

static void host_backwards(void *user, int64_t count, int64_t grain, sph_loop_fn body, void *job) {
  (void)grain;
  ++*(int *)user;
  for (int64_t i = count - 1; i >= 0; --i) body(job, i, i + 1, (int32_t)(i % 5));
}

static void host_uneven(void *user, int64_t count, int64_t grain, sph_loop_fn body, void *job) {
  (void)grain;
  ++*(int *)user;
  int64_t step = 1;
  for (int64_t begin = 0; begin < count; begin += step, step = 2 * step + 1)
    body(job, begin, begin + step < count ? begin + step : count, (int32_t)(step % 5));
}

static void test_loops_of_the_host(void **state) {
  (void)state;
  const sph_parallel_for_fn loops[] = {host_whole, host_backwards, host_uneven};
  for (int k = 0; k < 3; ++k) {
    int calls = 0;
    sph_context_options o;
    sph_context_options_init(&o);
    o.parallel_for = loops[k];
    o.parallel_user = &calls;
    o.workers = 5;
    o.threads = 8; /* the host's loop rules */
    sph_context *ctx = create(&o);
    assert_int_equal(sph_context_workers(ctx), 5);
    check_marks(ctx, 1);
    check_marks(ctx, 100);
    assert_int_equal(calls, 2);
    check_marks(ctx, COUNT); /* not worth cutting: the host is not asked */
    assert_int_equal(calls, 2);
    sph_context_destroy(ctx);
  }
}

/* --- life time */

static void test_objects_keep_the_context(void **state) {
  (void)state;
  sph_context *ctx = oom_context();
  sph_particles *set = NULL;
  check_ok(sph_particles_create(ctx, NULL, &set));
  sph_context_destroy(ctx);
  assert_true(oom.live_blocks > 0);
  check_ok(sph_particles_add(set, 10, NULL));
  sph_particles_destroy(set);
  oom_check_clean();
}

static void test_other_kinds_of_handle(void **state) {
  (void)state;
  sph_context *ctx = create(NULL);
  sph_particles *set = NULL;
  check_status(sph_particles_create((sph_context *)(void *)&(uint64_t[64]){1}, NULL, &set),
               SPH_ERR_HANDLE);
  assert_null(set);
  check_ok(sph_particles_create(ctx, NULL, &set));
  check_status(sph_parallel_for((sph_context *)(void *)set, 1, 1, nothing, NULL), SPH_ERR_HANDLE);
  sph_context_destroy((sph_context *)(void *)set);
  assert_int_equal(sph_particles_count(set), 0);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_version),
    cmocka_unit_test(test_status_names_and_texts),
    cmocka_unit_test(test_sym_components),
    cmocka_unit_test(test_defaults),
    cmocka_unit_test(test_null_everywhere),
    cmocka_unit_test(test_bad_options),
    cmocka_unit_test(test_options_of_other_sizes),
    cmocka_unit_test(test_forced_instruction_sets),
    cmocka_unit_test(test_instruction_set_names),
    cmocka_unit_test(test_thread_counts),
    cmocka_unit_test(test_two_contexts_share_nothing),
    cmocka_unit_test(test_wrong_handle),
    cmocka_unit_test(test_memory_is_given_back),
    cmocka_unit_test(test_no_memory),
    cmocka_unit_test(test_errors_reach_the_log),
    cmocka_unit_test(test_log_level_zero_is_silent),
    cmocka_unit_test(test_loops_on_own_threads),
    cmocka_unit_test(test_loop_arguments),
    cmocka_unit_test(test_loops_do_not_nest),
    cmocka_unit_test(test_loops_of_the_host),
    cmocka_unit_test(test_objects_keep_the_context),
    cmocka_unit_test(test_other_kinds_of_handle),
};

SPH_TEST_MAIN(tests)
