/* The context's own threads.
 *
 * One 64-bit word, the gate, holds the number of the loop, whether it is still open, and how many
 * threads are inside. A thread enters only an open gate; the calling thread works too, closes the
 * gate when no range is left, and waits for those inside. So a thread that wakes late is not
 * waited for, which matters when there are more threads than processors. */
#include "core_impl.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#define GATE_COUNT UINT64_C(0xffffffff)
#define GATE_OPEN (UINT64_C(1) << 32)
#define GATE_LOOP (UINT64_C(1) << 33)
#define LOOP_OF(gate) ((gate) >> 33)

/* Loops follow each other closely in a step: a short spin saves most system calls. */
enum { SPINS = 1000 };

typedef struct pool_thread {
  pthread_t handle;
  sphi_pool *pool;
  int32_t worker;
} pool_thread;

struct sphi_pool {
  _Alignas(64) _Atomic uint64_t gate;
  _Alignas(64) _Atomic int64_t next; /* first index that nobody has taken */
  _Alignas(64) int64_t count;
  int64_t grain;
  sph_loop_fn body;
  void *job;
  pthread_mutex_t mutex;
  pthread_cond_t wake;
  pthread_cond_t done;
  _Atomic int32_t sleepers;
  _Atomic int32_t stop;
  int32_t spins;
  int32_t started; /* threads running, the caller not among them */
  size_t bytes;
  pool_thread threads[];
};

int32_t sphi_processors(void) {
  long n = sysconf(_SC_NPROCESSORS_ONLN);
  if (n < 1) return 1;
  return n > SPHI_MAX_THREADS ? SPHI_MAX_THREADS : (int32_t)n;
}

static void relax(void) {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  __asm__ volatile("yield");
#endif
}

static void take_ranges(sphi_pool *pool, int32_t worker) {
  int64_t count = pool->count, grain = pool->grain;
  /* Looking before taking keeps `next` below count + workers * grain. */
  while (atomic_load_explicit(&pool->next, memory_order_relaxed) < count) {
    int64_t begin = atomic_fetch_add_explicit(&pool->next, grain, memory_order_relaxed);
    if (begin >= count) return;
    pool->body(pool->job, begin, count - begin > grain ? begin + grain : count, worker);
  }
}

/* Wait for a loop other than `seen` or for the end; answers the gate. */
static uint64_t wait_for_loop(sphi_pool *pool, uint64_t seen) {
  uint64_t gate = atomic_load(&pool->gate);
  for (int32_t i = 0; i < pool->spins && LOOP_OF(gate) == seen; ++i) {
    relax();
    gate = atomic_load(&pool->gate);
  }
  if (LOOP_OF(gate) != seen) return gate;
  pthread_mutex_lock(&pool->mutex);
  /* Announced before the gate is read again; the caller opens it before it looks for sleepers. */
  atomic_fetch_add(&pool->sleepers, 1);
  while (LOOP_OF(gate = atomic_load(&pool->gate)) == seen && !atomic_load(&pool->stop))
    pthread_cond_wait(&pool->wake, &pool->mutex);
  atomic_fetch_sub(&pool->sleepers, 1);
  pthread_mutex_unlock(&pool->mutex);
  return gate;
}

static bool enter(sphi_pool *pool, uint64_t gate) {
  while (gate & GATE_OPEN)
    if (atomic_compare_exchange_weak(&pool->gate, &gate, gate + 1)) return true;
  return false;
}

static void leave(sphi_pool *pool) {
  uint64_t before = atomic_fetch_sub(&pool->gate, 1);
  if ((before & GATE_COUNT) != 1 || (before & GATE_OPEN)) return;
  pthread_mutex_lock(&pool->mutex);
  pthread_cond_signal(&pool->done);
  pthread_mutex_unlock(&pool->mutex);
}

static void *thread_main(void *argument) {
  pool_thread *self = argument;
  sphi_pool *pool = self->pool;
  uint64_t seen = 0;
  while (!atomic_load(&pool->stop)) {
    uint64_t gate = wait_for_loop(pool, seen);
    seen = LOOP_OF(gate);
    if (!enter(pool, gate)) continue;
    take_ranges(pool, self->worker);
    leave(pool);
  }
  return NULL;
}

static void open_gate(sphi_pool *pool) {
  uint64_t closed = atomic_load(&pool->gate);
  atomic_store(&pool->gate, (closed + GATE_LOOP) | GATE_OPEN);
  if (atomic_load(&pool->sleepers) == 0) return;
  pthread_mutex_lock(&pool->mutex);
  pthread_cond_broadcast(&pool->wake);
  pthread_mutex_unlock(&pool->mutex);
}

static void close_gate(sphi_pool *pool) {
  uint64_t gate = atomic_fetch_and(&pool->gate, ~GATE_OPEN) & ~GATE_OPEN;
  for (int32_t i = 0; i < pool->spins && (gate & GATE_COUNT) != 0; ++i) {
    relax();
    gate = atomic_load(&pool->gate);
  }
  if ((gate & GATE_COUNT) == 0) return;
  pthread_mutex_lock(&pool->mutex);
  while ((atomic_load(&pool->gate) & GATE_COUNT) != 0) pthread_cond_wait(&pool->done, &pool->mutex);
  pthread_mutex_unlock(&pool->mutex);
}

void sphi_pool_run(sphi_pool *pool, int64_t count, int64_t grain, sph_loop_fn body, void *job) {
  pool->count = count;
  pool->grain = grain;
  pool->body = body;
  pool->job = job;
  atomic_store(&pool->next, 0);
  open_gate(pool);
  take_ranges(pool, 0);
  close_gate(pool);
}

/* Signals belong to the host's threads. */
static sph_status start(sphi_pool *pool, int32_t workers) {
  sigset_t all, old;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &old);
  for (int32_t i = 1; i < workers; ++i) {
    pool_thread *t = &pool->threads[i - 1];
    t->pool = pool;
    t->worker = i;
    if (pthread_create(&t->handle, NULL, thread_main, t) != 0) break;
    pool->started = i;
  }
  pthread_sigmask(SIG_SETMASK, &old, NULL);
  return pool->started == workers - 1 ? SPH_OK : SPH_ERR_NOMEM;
}

sph_status sphi_pool_create(sph_context *ctx, int32_t workers, sphi_pool **out) {
  size_t bytes = sizeof(sphi_pool) + (size_t)(workers - 1) * sizeof(pool_thread);
  sphi_pool *pool = sphi_calloc(ctx, bytes);
  if (!pool) return SPH_ERR_NOMEM;
  pool->bytes = bytes;
  /* Spinning for a processor that another thread of ours needs only costs. */
  pool->spins = workers <= sphi_processors() ? SPINS : 0;
  pthread_mutex_init(&pool->mutex, NULL);
  pthread_cond_init(&pool->wake, NULL);
  pthread_cond_init(&pool->done, NULL);
  sph_status status = start(pool, workers);
  if (status == SPH_OK)
    *out = pool;
  else
    sphi_pool_destroy(ctx, pool);
  return status;
}

void sphi_pool_destroy(sph_context *ctx, sphi_pool *pool) {
  pthread_mutex_lock(&pool->mutex);
  atomic_store(&pool->stop, 1);
  /* Leaves the spin loops as well. */
  atomic_fetch_add(&pool->gate, GATE_LOOP);
  pthread_cond_broadcast(&pool->wake);
  pthread_mutex_unlock(&pool->mutex);
  for (int32_t i = 0; i < pool->started; ++i) pthread_join(pool->threads[i].handle, NULL);
  pthread_cond_destroy(&pool->done);
  pthread_cond_destroy(&pool->wake);
  pthread_mutex_destroy(&pool->mutex);
  sphi_free(ctx, pool, pool->bytes);
}
