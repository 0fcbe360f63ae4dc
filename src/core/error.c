/* Last error, log and progress. Nothing here takes memory: it runs when memory is gone. */
#include "core_impl.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void emit(sph_context *ctx, int32_t level, const char *text) {
  if (ctx->log && level <= ctx->log_level) ctx->log(ctx->log_user, level, text);
}

sph_status sphi_fail(sph_context *ctx, sph_status status, const char *format, ...) {
  if (!ctx) return status;
  /* Through a copy: an argument may be the previous sentence itself. */
  char text[SPHI_ERROR_LENGTH];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  memcpy(ctx->error, text, sizeof text);
  ctx->error[sizeof ctx->error - 1] = '\0';
  emit(ctx, SPH_LOG_ERROR, ctx->error);
  return status;
}

void sphi_log(sph_context *ctx, int32_t level, const char *format, ...) {
  if (!ctx || !ctx->log || level > ctx->log_level) return;
  char text[SPHI_ERROR_LENGTH];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  emit(ctx, level, text);
}

sph_status sphi_progress(sph_context *ctx, double fraction, const char *what) {
  if (!ctx || !ctx->progress) return SPH_OK;
  if (ctx->progress(ctx->progress_user, fraction, what) == 0) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_CALLBACK, "the host stopped %s at %.1f %%", what, 100.0 * fraction);
}

sph_status sphi_check_handle(sph_context *ctx, const void *handle, uint32_t magic,
                             const char *name) {
  if (!handle) return sphi_fail(ctx, SPH_ERR_ARG, "%s is NULL", name);
  /* Only the leading word is read: the object may be of any kind. */
  uint32_t found = 0;
  memcpy(&found, handle, sizeof found);
  if (found == magic) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_HANDLE, "%s is a handle of another kind or was destroyed", name);
}
