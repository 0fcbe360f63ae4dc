/* Scratch that grows and is kept. */
#include "core_impl.h"

sph_status sphi_buffer_reserve(sph_context *ctx, sphi_buffer *b, size_t bytes) {
  if (b->ptr && b->bytes >= bytes) return SPH_OK;
  /* Half more than before: slowly growing demands settle after a few steps. */
  size_t wanted = bytes;
  if (b->bytes <= SIZE_MAX / 4 && wanted < b->bytes + b->bytes / 2)
    wanted = b->bytes + b->bytes / 2;
  void *ptr = sphi_alloc(ctx, wanted);
  if (!ptr) return SPH_ERR_NOMEM;
  sphi_free(ctx, b->ptr, b->bytes);
  b->ptr = ptr;
  b->bytes = wanted;
  return SPH_OK;
}

void sphi_buffer_free(sph_context *ctx, sphi_buffer *b) {
  sphi_free(ctx, b->ptr, b->bytes);
  b->ptr = NULL;
  b->bytes = 0;
}
