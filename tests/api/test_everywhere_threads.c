/* Every public function that answers a status gives the same bits on 1, 2, 3 and 8 threads, and on
 * a host's pool that cuts loops raggedly, from behind, with workers that come and go. */
#include "../everywhere.h"

enum { HOST_POOL = -1, WORKERS = 5 };

typedef struct bits {
  uint64_t set, list, output;
  int64_t number;
} bits;

static void host_pool(void *user, int64_t count, int64_t grain, sph_loop_fn body, void *job) {
  uint64_t *turn = (uint64_t *)user;
  (void)grain;
  for (int64_t end = count; end > 0;) {
    *turn = *turn * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    int64_t length = 1 + (int64_t)((*turn >> 33) % 97);
    int64_t begin = end > length ? end - length : 0;
    body(job, begin, end, (int32_t)((*turn >> 13) % WORKERS));
    end = begin;
  }
}

static bits run(const ew_entry *e, int32_t threads, int32_t dim, int64_t n) {
  uint64_t turn = 1;
  sph_context *ctx = NULL;
  sph_context_options o;
  sph_context_options_init(&o);
  o.threads = threads == HOST_POOL ? 1 : threads;
  if (threads == HOST_POOL) {
    o.parallel_for = host_pool;
    o.parallel_user = &turn;
    o.workers = WORKERS;
  }
  check_ok(sph_context_create(&o, &ctx));
  everywhere *w = ew_open(ctx, dim, n, n - n / 10);
  check_ok(e->call(w));
  bits b = {ew_set_state(w, 1), ew_list_state(w), ew_output(w), w->number};
  ew_close(w);
  sph_context_destroy(ctx);
  return b;
}

/* Sizes beyond the grains of the loops, so that there is something to cut. */
static void test_same_bits(void **state) {
  (void)state;
  static const int32_t threads[] = {2, 3, 8, HOST_POOL};
  static const int64_t sizes[] = {0, 3000, 3600, 1728};
  for (int k = 0; k < EW_ENTRIES; k++) {
    const ew_entry *e = &ew_entries[k];
    for (int32_t dim = 1; dim <= 3; dim++) {
      bits one = run(e, 1, dim, sizes[dim]);
      if (e->call == ew_memory) continue; /* more threads hold more memory */
      for (size_t t = 0; t < sizeof threads / sizeof *threads; t++) {
        bits other = run(e, threads[t], dim, sizes[dim]);
        if (memcmp(&one, &other, sizeof one) != 0)
          fail_msg("%s in %d-D: other bits on %d threads", e->name, (int)dim, (int)threads[t]);
      }
    }
  }
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(test_same_bits)};
SPH_TEST_MAIN(tests)
