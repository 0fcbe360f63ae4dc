/* The context: options, life time, and the calls that read it. */
#include "core_impl.h"

#include <string.h>

static void set_defaults(sph_context_options *o) {
  memset(o, 0, sizeof *o);
  o->size = sizeof *o;
  o->threads = 1;
  o->isa = SPH_ISA_AUTO;
  o->log_level = SPH_LOG_WARNING;
}

void sph_context_options_init_sized(sph_context_options *options, size_t size) {
  sph_context_options defaults;
  set_defaults(&defaults);
  sphi_options_init(options, size, &defaults, sizeof defaults);
}

/* There is no context yet that could keep a sentence: statuses only. */
static sph_status read_options(const sph_context_options *options, sph_context_options *o) {
  set_defaults(o);
  sph_status status = sphi_options_read(NULL, o, sizeof *o, options);
  if (status != SPH_OK) return status;
  if ((o->alloc == NULL) != (o->free == NULL)) return SPH_ERR_ARG;
  if (o->threads < 0 || o->threads > SPHI_MAX_THREADS) return SPH_ERR_ARG;
  if (o->parallel_for && o->workers < 1) return SPH_ERR_ARG;
  if (!o->alloc) {
    o->alloc = sphi_libc_alloc;
    o->free = sphi_libc_free;
    o->alloc_user = NULL;
  }
  return sphi_isa_choose(o->isa, &o->isa);
}

static void apply_options(sph_context *ctx, const sph_context_options *o) {
  ctx->alloc = o->alloc;
  ctx->free = o->free;
  ctx->alloc_user = o->alloc_user;
  ctx->parallel_for = o->parallel_for;
  ctx->parallel_user = o->parallel_user;
  ctx->isa = o->isa;
  ctx->log_level = o->log_level;
  ctx->log = o->log;
  ctx->log_user = o->log_user;
  ctx->progress = o->progress;
  ctx->progress_user = o->progress_user;
}

/* The context's own block and its pool count like any other memory of it. */
static size_t context_bytes(void) { return (sizeof(sph_context) + 63) / 64 * 64; }

static sph_status start_threads(sph_context *ctx, const sph_context_options *o) {
  ctx->workers = o->threads == 0 ? sphi_processors() : o->threads;
  if (ctx->parallel_for) {
    ctx->workers = o->workers;
    return SPH_OK;
  }
  return ctx->workers == 1 ? SPH_OK : sphi_pool_create(ctx, ctx->workers, &ctx->pool);
}

static void free_context(sph_context *ctx) {
  sph_free_fn release = ctx->free;
  void *user = ctx->alloc_user;
  ctx->base.magic = 0;
  release(user, ctx, context_bytes());
}

sph_status sph_context_create(const sph_context_options *options, sph_context **out) {
  if (!out) return SPH_ERR_ARG;
  *out = NULL;
  sph_context_options o;
  sph_status status = read_options(options, &o);
  if (status != SPH_OK) return status;
  sph_context *ctx = o.alloc(o.alloc_user, context_bytes(), 64);
  if (!ctx) return SPH_ERR_NOMEM;
  memset(ctx, 0, sizeof *ctx);
  apply_options(ctx, &o);
  ctx->base.magic = SPHI_MAGIC_CONTEXT;
  ctx->references = 1;
  ctx->bytes = ctx->peak = (int64_t)context_bytes();
  ctx->allocations = 1;
  status = start_threads(ctx, &o);
  if (status != SPH_OK) {
    free_context(ctx);
    return status;
  }
  *out = ctx;
  return SPH_OK;
}

void sphi_context_retain(sph_context *ctx) { ++ctx->references; }

void sphi_context_release(sph_context *ctx) {
  if (--ctx->references > 0) return;
  if (ctx->pool) sphi_pool_destroy(ctx, ctx->pool);
  free_context(ctx);
}

static bool valid(const sph_context *ctx) {
  return sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx") == SPH_OK;
}

void sph_context_destroy(sph_context *ctx) {
  if (!valid(ctx) || ctx->host_gone) return;
  ctx->host_gone = true;
  sphi_context_release(ctx);
}

const char *sph_context_last_error(const sph_context *ctx) { return valid(ctx) ? ctx->error : ""; }

int32_t sph_context_workers(const sph_context *ctx) { return valid(ctx) ? ctx->workers : 0; }

int32_t sph_context_isa(const sph_context *ctx) { return valid(ctx) ? ctx->isa : 0; }

int32_t sphi_workers(const sph_context *ctx) { return ctx->workers; }

int32_t sphi_isa(const sph_context *ctx) { return ctx->isa; }

sph_status sph_context_memory(const sph_context *ctx, int64_t *bytes, int64_t *peak,
                              int64_t *allocations) {
  sph_status status = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (status != SPH_OK) return status;
  if (bytes) *bytes = ctx->bytes;
  if (peak) *peak = ctx->peak;
  if (allocations) *allocations = ctx->allocations;
  return SPH_OK;
}
