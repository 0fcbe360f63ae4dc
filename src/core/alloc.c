/* Memory through the context's hooks, counted. Only the calling thread allocates. */
#define _DEFAULT_SOURCE /* madvise() */
#include "core_impl.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

/* Every block is padded to whole cache lines, so a vector load at its end stays inside. Zero
 * bytes take one line: the pointer is valid and distinct. */
enum { LINE = 64 };

static size_t padded(size_t bytes) { return bytes == 0 ? LINE : (bytes + LINE - 1) / LINE * LINE; }

/* Pair loops gather records from all over a large block: with small pages most of these accesses
 * would miss the translation buffers. Where the system has no huge pages the request is void. */
static void *alloc_large(size_t size, size_t page) {
  void *ptr = aligned_alloc(page, (size + page - 1) / page * page);
#ifdef MADV_HUGEPAGE
  if (ptr) (void)madvise(ptr, size, MADV_HUGEPAGE);
#endif
  return ptr;
}

void *sphi_libc_alloc(void *user, size_t size, size_t align) {
  const size_t page = (size_t)1 << 21, large = 4 * page;
  (void)user;
  if (size >= large && size <= PTRDIFF_MAX - page) return alloc_large(size, page);
  return aligned_alloc(align, size);
}

void sphi_libc_free(void *user, void *ptr, size_t size) {
  (void)user;
  (void)size;
  free(ptr);
}

void *sphi_alloc(sph_context *ctx, size_t bytes) {
  void *ptr = NULL;
  if (bytes <= PTRDIFF_MAX - LINE) ptr = ctx->alloc(ctx->alloc_user, padded(bytes), LINE);
  if (!ptr) {
    (void)sphi_fail(ctx, SPH_ERR_NOMEM, "out of memory: %zu bytes asked for, %lld held", bytes,
                    (long long)ctx->bytes);
    return NULL;
  }
  ctx->bytes += (int64_t)padded(bytes);
  if (ctx->bytes > ctx->peak) ctx->peak = ctx->bytes;
  ++ctx->allocations;
  return ptr;
}

void *sphi_calloc(sph_context *ctx, size_t bytes) {
  void *ptr = sphi_alloc(ctx, bytes);
  if (ptr) memset(ptr, 0, padded(bytes));
  return ptr;
}

void sphi_free(sph_context *ctx, void *ptr, size_t bytes) {
  if (!ptr) return;
  ctx->bytes -= (int64_t)padded(bytes);
  ctx->free(ctx->alloc_user, ptr, padded(bytes));
}

size_t sphi_mul(size_t a, size_t b) { return b != 0 && a > SIZE_MAX / b ? SIZE_MAX : a * b; }
