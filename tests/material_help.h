/* What the tests of materials share. */
#ifndef SPH_TESTS_MATERIAL_HELP_H
#define SPH_TESTS_MATERIAL_HELP_H

#include "check.h"

#include <sph/sph.h>

/* splitmix64, the same numbers on every machine */
static CHECK_UNUSED uint64_t random_state;
static CHECK_UNUSED double random_in(double low, double high) {
  uint64_t z = (random_state += UINT64_C(0x9e3779b97f4a7c15));
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  z ^= z >> 31;
  return low + (high - low) * (double)(z >> 11) * 0x1p-53;
}
static CHECK_UNUSED double random_signed(void) { return random_in(-1, 1); }

static CHECK_UNUSED sph_context *make_context(void) {
  sph_context *ctx = NULL;
  check_ok(sph_context_create(NULL, &ctx));
  return ctx;
}

/* The call fails with this status and a sentence that holds `words`. */
static CHECK_UNUSED void refused(sph_context *ctx, sph_status got, sph_status want,
                                 const char *words) {
  check_status(got, want);
  if (strstr(sph_context_last_error(ctx), words) == NULL)
    fail_msg("\"%s\" is not in \"%s\"", words, sph_context_last_error(ctx));
}

/* 1, 2 or 3 */
static CHECK_UNUSED int32_t dim_of(int32_t reduction) {
  return reduction <= SPH_UNIAXIAL_STRAIN ? 1 : reduction <= SPH_PLANE_STRAIN ? 2 : 3;
}

#endif
