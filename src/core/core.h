/* Internal services of the bottom layer: memory, errors, options, parallel loops.
 * Every struct of this layer is defined in core_impl.h; other layers use only what is here. */
#ifndef SPHI_CORE_H
#define SPHI_CORE_H

#include <sph/base.h>
#include <sph/context.h>

#define SPHI_PRINTF(f, a) __attribute__((format(printf, f, a)))

/* Every handle starts with this. The magic is cleared on destroy. */
typedef struct sphi_object {
  uint32_t magic;
  sph_context *ctx; /* retained */
} sphi_object;

enum {
  SPHI_MAGIC_CONTEXT = 0x53504831,
  SPHI_MAGIC_PARTICLES = 0x53504832,
  SPHI_MAGIC_KERNEL = 0x53504833,
  SPHI_MAGIC_NEIGHBORS = 0x53504834,
  SPHI_MAGIC_MATERIAL = 0x53504835,
  SPHI_MAGIC_RHS = 0x53504836,
  SPHI_MAGIC_INTEGRATOR = 0x53504837,
  SPHI_MAGIC_SERIES = 0x53504953,
  SPHI_MAGIC_HISTORY = 0x53504948,
  SPHI_MAGIC_TOTAL_LAGRANGIAN = 0x53504854
};

/* SPH_OK, SPH_ERR_ARG for NULL, SPH_ERR_HANDLE for another kind. `name` goes into the sentence,
 * which is written only when ctx is not NULL. */
sph_status sphi_check_handle(sph_context *ctx, const void *handle, uint32_t magic,
                             const char *name);

/* Write the last-error sentence, pass it to the log hook at level ERROR, return `status`. No heap.
 * ctx may be NULL. */
sph_status sphi_fail(sph_context *ctx, sph_status status, const char *format, ...)
    SPHI_PRINTF(3, 4);
void sphi_log(sph_context *ctx, int32_t level, const char *format, ...) SPHI_PRINTF(3, 4);
/* 0 to go on; SPH_ERR_CALLBACK (sentence written) when the host asked to stop. */
sph_status sphi_progress(sph_context *ctx, double fraction, const char *what);

void sphi_context_retain(sph_context *ctx);
void sphi_context_release(sph_context *ctx);

/* 64-byte aligned, not cleared; NULL when out of memory (sentence written). bytes 0 is legal and
 * gives a valid pointer. */
void *sphi_alloc(sph_context *ctx, size_t bytes);
void *sphi_calloc(sph_context *ctx, size_t bytes);
void sphi_free(sph_context *ctx, void *ptr, size_t bytes); /* ptr NULL is allowed */
/* a * b, or SIZE_MAX when that overflows (which sphi_alloc then refuses). */
size_t sphi_mul(size_t a, size_t b);

/* A buffer that grows and is kept. Zero-initialise. */
typedef struct sphi_buffer {
  void *ptr;
  size_t bytes;
} sphi_buffer;
/* Ensure at least `bytes`; contents are lost when it grows. SPH_OK or SPH_ERR_NOMEM with the old
 * buffer intact. */
sph_status sphi_buffer_reserve(sph_context *ctx, sphi_buffer *b, size_t bytes);
void sphi_buffer_free(sph_context *ctx, sphi_buffer *b);

/* Copy size-first options `src` (may be NULL) of the caller's size over `dst`, which holds the
 * defaults and is dst_size long. SPH_ERR_VERSION when unknown trailing bytes are nonzero,
 * SPH_ERR_ARG when the caller's size is smaller than a size_t. */
sph_status sphi_options_read(sph_context *ctx, void *dst, size_t dst_size, const void *src);

/* Body of the sph_*_options_init_sized() functions: copy the defaults, cut or zero-padded to the
 * caller's size, and set the leading size member. Nothing when dst is NULL. */
void sphi_options_init(void *dst, size_t size, const void *defaults, size_t defaults_size);

/* Run body over [0, count). Serial when count <= grain or one worker. */
void sphi_parallel(sph_context *ctx, int64_t count, int64_t grain, sph_loop_fn body, void *job);
int32_t sphi_workers(const sph_context *ctx);
int32_t sphi_isa(const sph_context *ctx);

/* First failing index of a parallel loop: keeps the lowest. Start with INT64_MAX. Thread-safe. */
void sphi_lowest(int64_t *slot, int64_t index);

#endif
