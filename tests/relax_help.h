/* What the tests of relaxed layouts and of layouts of several materials share. */
#ifndef SPH_TESTS_RELAX_HELP_H
#define SPH_TESTS_RELAX_HELP_H

#include "check.h"
#include "oom.h"

#include <stdlib.h>

#include <sph/sph.h>

static const CHECK_UNUSED double pi = 3.14159265358979323846;

static CHECK_UNUSED sph_context *context_of(int32_t threads) {
  sph_context_options o;
  sph_context *ctx = NULL;
  sph_context_options_init(&o);
  o.threads = threads;
  check_ok(sph_context_create(&o, &ctx));
  return ctx;
}

static CHECK_UNUSED sph_region_options box_of(int32_t dim) {
  sph_region_options r;
  sph_region_options_init(&r);
  r.dim = dim;
  return r;
}

static CHECK_UNUSED double *scattered(sph_context *ctx, int32_t dim, int64_t n) {
  double *x = (double *)malloc((size_t)(n * dim) * sizeof *x);
  assert_non_null(x);
  for (int64_t k = 0; k < n * dim; k++) x[k] = 0.5;
  check_ok(sph_layout_jitter(ctx, dim, 0.499, 5, NULL, NULL, n, x));
  return x;
}

static CHECK_UNUSED sph_relax_options relax_of(int32_t iterations, double tolerance) {
  sph_relax_options o;
  sph_relax_options_init(&o);
  o.iterations = iterations;
  o.tolerance = tolerance;
  return o;
}

static CHECK_UNUSED sph_status relax(sph_context *ctx, const sph_region_options *r,
                                     const sph_relax_options *o, int64_t n, double *x, double *v,
                                     sph_relax_result *result) {
  sph_relax_result_init(result);
  return sph_layout_relax(ctx, r, o, n, x, v, result);
}

static CHECK_UNUSED void said(sph_context *ctx, const char *words) {
  if (strstr(sph_context_last_error(ctx), words) == NULL)
    fail_msg("\"%s\" is not in \"%s\"", words, sph_context_last_error(ctx));
}

#endif
