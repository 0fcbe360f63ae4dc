/* Parallel loops: serial, on the context's own pool, or through the host's hook. */
#include "core_impl.h"

void sphi_parallel(sph_context *ctx, int64_t count, int64_t grain, sph_loop_fn body, void *job) {
  if (count <= 0) return;
  if (grain < 1) grain = 1;
  ctx->in_parallel = true;
  if (count <= grain || ctx->workers == 1)
    body(job, 0, count, 0);
  else if (ctx->parallel_for)
    ctx->parallel_for(ctx->parallel_user, count, grain, body, job);
  else
    sphi_pool_run(ctx->pool, count, grain, body, job);
  ctx->in_parallel = false;
}

sph_status sph_parallel_for(sph_context *ctx, int64_t count, int64_t grain, sph_loop_fn body,
                            void *job) {
  sph_status status = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (status != SPH_OK) return status;
  /* No sentence: another thread of ours might be the one that calls. */
  if (ctx->in_parallel) return SPH_ERR_STATE;
  if (!body) return sphi_fail(ctx, SPH_ERR_ARG, "body is NULL");
  if (count < 0) return sphi_fail(ctx, SPH_ERR_ARG, "count is %lld", (long long)count);
  if (grain < 1) return sphi_fail(ctx, SPH_ERR_ARG, "grain is %lld", (long long)grain);
  sphi_parallel(ctx, count, grain, body, job);
  return SPH_OK;
}

void sphi_lowest(int64_t *slot, int64_t index) {
  int64_t seen = __atomic_load_n(slot, __ATOMIC_RELAXED);
  while (index < seen &&
         !__atomic_compare_exchange_n(slot, &seen, index, 1, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
}
