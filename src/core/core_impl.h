/* The structs of the bottom layer. Only src/core includes this. */
#ifndef SPHI_CORE_IMPL_H
#define SPHI_CORE_IMPL_H

#include "core.h"

#include <stdatomic.h>
#include <stdbool.h>

#define SPHI_ERROR_LENGTH 1024
#define SPHI_MAX_THREADS 1024

typedef struct sphi_pool sphi_pool;

struct sph_context {
  sphi_object base; /* base.ctx stays NULL: a context does not retain itself */
  int64_t references;
  bool host_gone; /* the host gave up its reference; a second destroy is ignored */

  sph_alloc_fn alloc;
  sph_free_fn free;
  void *alloc_user;
  int64_t bytes;
  int64_t peak;
  int64_t allocations;

  int32_t workers;
  sph_parallel_for_fn parallel_for;
  void *parallel_user;
  sphi_pool *pool;  /* NULL: serial, or the host's own loop */
  bool in_parallel; /* a loop of this context is running */

  int32_t isa;
  int32_t log_level;
  sph_log_fn log;
  void *log_user;
  sph_progress_fn progress;
  void *progress_user;

  char error[SPHI_ERROR_LENGTH];
};

/* Start `workers` - 1 threads; the caller of a loop is worker 0. */
sph_status sphi_pool_create(sph_context *ctx, int32_t workers, sphi_pool **out);
void sphi_pool_destroy(sph_context *ctx, sphi_pool *pool);
void sphi_pool_run(sphi_pool *pool, int64_t count, int64_t grain, sph_loop_fn body, void *job);
/* Processors online, at least 1, at most SPHI_MAX_THREADS. */
int32_t sphi_processors(void);

/* Defaults of the memory hooks. */
void *sphi_libc_alloc(void *user, size_t size, size_t align);
void sphi_libc_free(void *user, void *ptr, size_t size);

/* SPH_ERR_ARG for an unknown set, SPH_ERR_UNSUPPORTED for one that is missing here. */
sph_status sphi_isa_choose(int32_t wanted, int32_t *chosen);

#endif
