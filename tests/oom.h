/* Failing memory: a context whose allocator refuses one chosen allocation, and a sweep that
 * fails each allocation of a scenario in turn.
 *
 *   static sph_status scenario(sph_context *ctx, void *user) {
 *     sph_particles *set = NULL;
 *     sph_status s = sph_particles_create(ctx, NULL, &set);
 *     if (s == SPH_OK) s = sph_particles_add(set, 100, NULL);
 *     sph_particles_destroy(set);
 *     return s;
 *   }
 *   oom_sweep(scenario, NULL);
 *
 * A scenario answers the first status that was not SPH_OK and gives everything back on every
 * path. What must not fail (preparing, or checking that the state is unchanged) stands between
 * oom_pause() and oom_resume(). */
#ifndef SPH_TESTS_OOM_H
#define SPH_TESTS_OOM_H

#include "check.h"

#include <stdlib.h>

#include <sph/context.h>

typedef struct oom_state {
  int64_t countdown; /* allocations that still succeed; negative: all */
  int once;          /* after a refusal: 1 = later calls succeed again, 0 = they fail too */
  int paused;
  int64_t refused;     /* allocations refused so far */
  int64_t allocations; /* allocations made so far */
  int64_t live_blocks;
  int64_t live_bytes;
  int64_t bad_frees; /* size in free differs from that in alloc, or not our block */
} oom_state;

static CHECK_UNUSED oom_state oom;

enum { OOM_HEADER = 64 };
#define OOM_MARK UINT64_C(0x6f6f6d6d61726b21)

static CHECK_UNUSED int oom_refuses(oom_state *s) {
  if (s->paused || s->countdown < 0) return 0;
  if (s->countdown > 0) {
    --s->countdown;
    return 0;
  }
  ++s->refused;
  if (s->once) s->countdown = -1;
  return 1;
}

static CHECK_UNUSED void *oom_alloc(void *user, size_t size, size_t align) {
  oom_state *s = (oom_state *)user;
  if (align > OOM_HEADER || size > SIZE_MAX - 2 * OOM_HEADER || oom_refuses(s)) return NULL;
  size_t total = (size + 2 * OOM_HEADER - 1) / OOM_HEADER * OOM_HEADER;
  unsigned char *raw = (unsigned char *)aligned_alloc(OOM_HEADER, total);
  if (!raw) return NULL;
  uint64_t head[2] = {OOM_MARK, (uint64_t)size};
  memcpy(raw, head, sizeof head);
  memset(raw + OOM_HEADER, 0xff, total - OOM_HEADER); /* NaN where doubles are read too early */
  ++s->allocations;
  ++s->live_blocks;
  s->live_bytes += (int64_t)size;
  return raw + OOM_HEADER;
}

static CHECK_UNUSED void oom_free(void *user, void *ptr, size_t size) {
  oom_state *s = (oom_state *)user;
  if (!ptr) return;
  unsigned char *raw = (unsigned char *)ptr - OOM_HEADER;
  uint64_t head[2];
  memcpy(head, raw, sizeof head);
  if (head[0] != OOM_MARK || head[1] != (uint64_t)size) ++s->bad_frees;
  memset(raw, 0, OOM_HEADER);
  --s->live_blocks;
  s->live_bytes -= (int64_t)size;
  free(raw);
}

static CHECK_UNUSED void oom_pause(void) { ++oom.paused; }
static CHECK_UNUSED void oom_resume(void) { --oom.paused; }

/* Forget all counts; every allocation succeeds until oom.countdown is set. */
static CHECK_UNUSED void oom_reset(void) {
  memset(&oom, 0, sizeof oom);
  oom.countdown = -1;
}

/* Fill options with the defaults and the failing allocator. */
static CHECK_UNUSED void oom_options(sph_context_options *options) {
  sph_context_options_init(options);
  options->alloc = oom_alloc;
  options->free = oom_free;
  options->alloc_user = &oom;
}

/* A context on the failing allocator, which refuses nothing yet. */
static CHECK_UNUSED sph_context *oom_context(void) {
  sph_context_options options;
  sph_context *ctx = NULL;
  oom_reset();
  oom_options(&options);
  check_ok(sph_context_create(&options, &ctx));
  return ctx;
}

/* Nothing is held and every free named the size that was asked for. */
static CHECK_UNUSED void oom_check_clean(void) {
  assert_int_equal(oom.live_blocks, 0);
  assert_int_equal(oom.live_bytes, 0);
  assert_int_equal(oom.bad_frees, 0);
}

typedef sph_status (*oom_scenario)(sph_context *ctx, void *user);

/* One run with the given countdown: 1 when no allocation was refused any more. */
static CHECK_UNUSED int oom_run(oom_scenario scenario, void *user, int64_t countdown, int once) {
  sph_context *ctx = oom_context();
  oom.once = once;
  oom.countdown = countdown;
  sph_status status = scenario(ctx, user);
  int refused = oom.refused > 0;
  oom.countdown = -1;
  check_status(status, refused ? SPH_ERR_NOMEM : SPH_OK);
  if (refused) assert_true(sph_context_last_error(ctx)[0] != '\0');
  sph_context_destroy(ctx);
  oom_check_clean();
  return !refused;
}

/* Run the scenario with allocation 0, 1, 2 ... refused (alone, then with all later ones) until it
 * succeeds. Every refused run must answer SPH_ERR_NOMEM with a sentence and leak nothing. */
static CHECK_UNUSED void oom_sweep(oom_scenario scenario, void *user) {
  for (int once = 0; once < 2; ++once) {
    int64_t countdown = 0;
    while (!oom_run(scenario, user, countdown, once)) {
      ++countdown;
      assert_true(countdown < 100000);
    }
  }
}

#endif
