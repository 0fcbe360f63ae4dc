/* Context: memory, threads, instruction set, log and progress hooks, the last error.
 *
 * Every other handle is made from a context and retains it, so a host may destroy its own
 * reference at any time. There is no global state: two contexts share nothing.
 *
 * A context, and what was made from it, serves one calling thread at a time. Use one context
 * per host thread that calls the library. */
#ifndef SPH_CONTEXT_H
#define SPH_CONTEXT_H

#include <sph/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Memory hooks. `align` is a power of two, at most 64. NULL means out of memory, which the
 * library reports as SPH_ERR_NOMEM. `size` in free is the size that was asked for. */
typedef void *(*sph_alloc_fn)(void *user, size_t size, size_t align);
typedef void (*sph_free_fn)(void *user, void *ptr, size_t size);

/* One piece of a parallel loop: indices [begin, end), on worker 0 <= worker < workers. */
typedef void (*sph_loop_fn)(void *job, int64_t begin, int64_t end, int32_t worker);

/* A host's own thread pool. Must call body on disjoint ranges that together cover [0, count),
 * give bodies that run at the same time distinct worker numbers below `workers` of the options,
 * and return when all are done. `grain` is a hint: ranges no smaller than this pay. Results of
 * the library do not depend on how the range is cut. */
typedef void (*sph_parallel_for_fn)(void *user, int64_t count, int64_t grain, sph_loop_fn body,
                                    void *job);

enum { SPH_LOG_ERROR = 1, SPH_LOG_WARNING = 2, SPH_LOG_INFO = 3, SPH_LOG_DEBUG = 4 };
typedef void (*sph_log_fn)(void *user, int32_t level, const char *text);

/* Progress of a long call (neighbour builds, files being written), 0 <= fraction <= 1, on the
 * calling thread. It must not change or destroy what the call works on. A nonzero return asks the
 * call to stop; it then answers SPH_ERR_CALLBACK. A ready one for terminals is in io.h. */
typedef int32_t (*sph_progress_fn)(void *user, double fraction, const char *what);

/* Instruction sets of the pair loop. AUTO takes the best that this machine runs. */
enum { SPH_ISA_AUTO = 0, SPH_ISA_PORTABLE = 1, SPH_ISA_AVX2 = 2, SPH_ISA_AVX512 = 3 };

typedef struct sph_context_options {
  size_t size;        /* set by sph_context_options_init() */
  sph_alloc_fn alloc; /* NULL: aligned_alloc of libc */
  sph_free_fn free;   /* NULL: free of libc; alloc and free come together */
  void *alloc_user;
  int32_t threads;                  /* own pool: 0 = all online processors, 1 = serial; default 1 */
  int32_t workers;                  /* with parallel_for: its largest worker number plus one */
  sph_parallel_for_fn parallel_for; /* NULL: own pool */
  void *parallel_user;
  int32_t isa;       /* SPH_ISA_*; default SPH_ISA_AUTO */
  int32_t log_level; /* most verbose level passed on; default SPH_LOG_WARNING */
  sph_log_fn log;    /* NULL: silent */
  void *log_user;
  sph_progress_fn progress; /* NULL: none */
  void *progress_user;
} sph_context_options;

/* Fill *options with the defaults. Called through the macro, which passes the size that the
 * caller was compiled with; bytes beyond it are not written. Since 0.1. */
SPH_API void sph_context_options_init_sized(sph_context_options *options, size_t size);
#define sph_context_options_init(options) \
  sph_context_options_init_sized((options), sizeof(sph_context_options))

/* Create a context. options may be NULL for the defaults: libc memory, one thread, the best
 * instruction set, silent. *out receives the handle, NULL on failure.
 *
 * SPH_ERR_ARG: out NULL, only one of alloc and free, threads < 0 or > 1024, workers < 1 with
 * parallel_for, an unknown isa. SPH_ERR_UNSUPPORTED: this machine lacks the forced instruction
 * set. SPH_ERR_VERSION: options newer than this library. SPH_ERR_NOMEM: memory or threads.
 * There is no handle yet to hold a sentence; the status says what was wrong. Since 0.1. */
SPH_API sph_status sph_context_create(const sph_context_options *options, sph_context **out);

/* Give up the caller's reference. The memory goes when the last handle made from the context is
 * destroyed. NULL is allowed. Since 0.1. */
SPH_API void sph_context_destroy(sph_context *ctx);

/* Sentence of the last failure in this context, with the values; "" when there was none, never
 * NULL. Valid until the next call on the context. Since 0.1. */
SPH_API const char *sph_context_last_error(const sph_context *ctx);

/* Workers that a parallel loop may use at the same time; 0 for NULL. Since 0.1. */
SPH_API int32_t sph_context_workers(const sph_context *ctx);

/* The instruction set in use (never AUTO); 0 for NULL. Since 0.1. */
SPH_API int32_t sph_context_isa(const sph_context *ctx);

/* Whether this machine and this build run an instruction set: 1 or 0. Since 0.1. */
SPH_API int32_t sph_isa_available(int32_t isa);

/* "portable", "avx2", "avx512"; "unknown" otherwise. Static. Since 0.1. */
SPH_API const char *sph_isa_name(int32_t isa);

/* Memory held through this context now, its highest mark, and the number of allocations made so
 * far (a steady step makes none). Any pointer may be NULL. Since 0.1. */
SPH_API sph_status sph_context_memory(const sph_context *ctx, int64_t *bytes, int64_t *peak,
                                      int64_t *allocations);

/* Run a host loop on the context's threads: body(job, begin, end, worker) over [0, count) in
 * ranges of about `grain` (at least 1); returns when all are done. Allocates nothing.
 * SPH_ERR_ARG: body NULL, count < 0, grain < 1. SPH_ERR_STATE: called from the body of another loop
 * of the context (nested), without a sentence; body does not run then. Since 0.1. */
SPH_API sph_status sph_parallel_for(sph_context *ctx, int64_t count, int64_t grain,
                                    sph_loop_fn body, void *job);

#ifdef __cplusplus
}
#endif
#endif
