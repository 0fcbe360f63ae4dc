/* Size-first options: structs that grow at their end without breaking older hosts. */
#include "core_impl.h"

#include <string.h>

/* A size above this was never set by an init function. */
enum { LARGEST_OPTIONS = 1 << 16 };

void sphi_options_init(void *dst, size_t size, const void *defaults, size_t defaults_size) {
  if (!dst || size < sizeof(size_t)) return;
  size_t known = size < defaults_size ? size : defaults_size;
  memcpy(dst, defaults, known);
  memset((char *)dst + known, 0, size - known);
  memcpy(dst, &size, sizeof size);
}

sph_status sphi_options_read(sph_context *ctx, void *dst, size_t dst_size, const void *src) {
  if (!src) return SPH_OK;
  size_t size = 0;
  memcpy(&size, src, sizeof size);
  if (size < sizeof size || size > LARGEST_OPTIONS)
    return sphi_fail(ctx, SPH_ERR_ARG,
                     "the size %zu of the options was not set by their init function", size);
  const unsigned char *bytes = (const unsigned char *)src;
  for (size_t i = dst_size; i < size; ++i)
    if (bytes[i] != 0)
      return sphi_fail(ctx, SPH_ERR_VERSION,
                       "byte %zu of the options is set, this library knows %zu bytes", i, dst_size);
  memcpy(dst, src, size < dst_size ? size : dst_size);
  memcpy(dst, &dst_size, sizeof dst_size);
  return SPH_OK;
}
