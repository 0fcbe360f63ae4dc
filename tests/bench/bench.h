/* What the benchmarks share: clocks, pinning, repetitions, a host's thread pool, BENCH lines.
 *
 * Include this first: pinning needs a GNU extension. Every figure is the median of at least five
 * repetitions after one that is not counted. Beside the wall clock stand the processor time and the
 * fastest repetition: on a machine with other work the three part, and `busy` says so. */
#ifndef SPH_TESTS_BENCH_H
#define SPH_TESTS_BENCH_H

#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include <math.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#ifdef __linux__
#include <sched.h>
#endif

#include <sph/sph.h>

#define BENCH_FN static __attribute__((unused))
enum { BENCH_REPETITIONS = 5, BENCH_MOST = 64 };

/* A benchmark has no use for going on after a failure. */
BENCH_FN void bench_ok(sph_status status, const char *what, const sph_context *ctx) {
  if (status == SPH_OK) return;
  printf("failed: %s: %s (%s)\n", what, sph_status_name(status),
         ctx ? sph_context_last_error(ctx) : "");
  exit(1);
}
#define BENCH_OK(call, ctx) bench_ok((call), #call, (ctx))

BENCH_FN void *bench_alloc(int64_t count, size_t size) {
  void *p = calloc((size_t)(count > 0 ? count : 1), size);
  if (p) return p;
  printf("failed: out of memory\n");
  exit(1);
}

BENCH_FN int32_t bench_best_isa(void) {
  int32_t isa = SPH_ISA_AVX512;
  while (isa > SPH_ISA_PORTABLE && !sph_isa_available(isa)) isa--;
  return isa;
}

/* --- clocks ------------------------------------------------------------------------------- */

BENCH_FN double bench_clock(clockid_t clock) {
  struct timespec t;
  clock_gettime(clock, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}
BENCH_FN double bench_now(void) { return bench_clock(CLOCK_MONOTONIC); }
BENCH_FN double bench_cpu(void) { return bench_clock(CLOCK_PROCESS_CPUTIME_ID); }

BENCH_FN int bench_compare(const void *a, const void *b) {
  double p = *(const double *)a, q = *(const double *)b;
  return (p > q) - (p < q);
}
BENCH_FN double bench_median(double *v, int n) {
  qsort(v, (size_t)n, sizeof *v, bench_compare);
  return v[n / 2];
}

/* Seconds of one call. */
typedef struct bench_time {
  double wall, best, cpu; /* median, fastest, median of processor time */
  double pairs;           /* of one call, where a caller notes it */
} bench_time;

typedef void (*bench_fn)(void *user);

/* Calls too short for the clocks are repeated within one repetition. */
BENCH_FN bench_time bench_measure(bench_fn fn, void *user, int repetitions) {
  double wall[BENCH_MOST], cpu[BENCH_MOST], begin = bench_now();
  fn(user);
  double once = bench_now() - begin;
  int calls = once < 0.05 ? (int)(0.05 / (once + 1e-6)) + 1 : 1;
  if (repetitions > BENCH_MOST) repetitions = BENCH_MOST;
  for (int r = 0; r < repetitions; r++) {
    double c = bench_cpu(), t = bench_now();
    for (int k = 0; k < calls; k++) fn(user);
    wall[r] = (bench_now() - t) / calls;
    cpu[r] = (bench_cpu() - c) / calls;
  }
  bench_time t = {bench_median(wall, repetitions), 0.0, bench_median(cpu, repetitions), 0.0};
  t.best = wall[0];
  return t;
}

/* --- pinning ------------------------------------------------------------------------------ */

/* Let this thread and those that it starts use the last `count` of the processors that the process
 * began with. */
BENCH_FN void bench_pin(int32_t count) {
#ifdef __linux__
  static cpu_set_t all;
  static int known;
  cpu_set_t some;
  if (!known && sched_getaffinity(0, sizeof all, &all)) return;
  known = 1;
  CPU_ZERO(&some);
  for (size_t c = CPU_SETSIZE; c-- > 0 && CPU_COUNT(&some) < count;)
    if (CPU_ISSET(c, &all)) CPU_SET(c, &some);
  sched_setaffinity(0, sizeof some, &some);
#else
  (void)count;
#endif
}

/* --- a host's own thread pool ------------------------------------------------------------- */

typedef struct bench_pool {
  pthread_mutex_t lock;
  pthread_cond_t go, done;
  pthread_t thread[BENCH_MOST];
  int32_t workers, running, quit, started;
  uint64_t turn;
  int64_t count, grain;
  _Atomic int64_t next;
  sph_loop_fn body;
  void *job;
} bench_pool;

BENCH_FN void bench_pool_work(bench_pool *p, int32_t worker) {
  for (;;) {
    int64_t lo = atomic_fetch_add(&p->next, p->grain);
    if (lo >= p->count) return;
    p->body(p->job, lo, lo + p->grain < p->count ? lo + p->grain : p->count, worker);
  }
}

BENCH_FN void *bench_pool_thread(void *user) {
  bench_pool *p = user;
  uint64_t seen = 0;
  pthread_mutex_lock(&p->lock);
  int32_t worker = ++p->started;
  for (;;) {
    while (p->turn == seen && !p->quit) pthread_cond_wait(&p->go, &p->lock);
    if (p->quit) break;
    seen = p->turn;
    pthread_mutex_unlock(&p->lock);
    bench_pool_work(p, worker);
    pthread_mutex_lock(&p->lock);
    if (--p->running == 0) pthread_cond_signal(&p->done);
  }
  pthread_mutex_unlock(&p->lock);
  return NULL;
}

/* The sph_parallel_for_fn. */
BENCH_FN void bench_pool_for(void *user, int64_t count, int64_t grain, sph_loop_fn body,
                             void *job) {
  bench_pool *p = user;
  if (count <= grain) {
    if (count > 0) body(job, 0, count, 0);
    return;
  }
  pthread_mutex_lock(&p->lock);
  p->count = count;
  p->grain = grain;
  p->body = body;
  p->job = job;
  atomic_store(&p->next, 0);
  p->running = p->workers - 1;
  p->turn++;
  pthread_cond_broadcast(&p->go);
  pthread_mutex_unlock(&p->lock);
  bench_pool_work(p, 0);
  pthread_mutex_lock(&p->lock);
  while (p->running > 0) pthread_cond_wait(&p->done, &p->lock);
  pthread_mutex_unlock(&p->lock);
}

BENCH_FN void bench_pool_start(bench_pool *p, int32_t workers) {
  memset(p, 0, sizeof *p);
  p->workers = workers;
  pthread_mutex_init(&p->lock, NULL);
  pthread_cond_init(&p->go, NULL);
  pthread_cond_init(&p->done, NULL);
  for (int32_t k = 1; k < workers; k++)
    if (pthread_create(&p->thread[k], NULL, bench_pool_thread, p)) exit(1);
}

BENCH_FN void bench_pool_stop(bench_pool *p) {
  pthread_mutex_lock(&p->lock);
  p->quit = 1;
  pthread_cond_broadcast(&p->go);
  pthread_mutex_unlock(&p->lock);
  for (int32_t k = 1; k < p->workers; k++) pthread_join(p->thread[k], NULL);
  pthread_cond_destroy(&p->go);
  pthread_cond_destroy(&p->done);
  pthread_mutex_destroy(&p->lock);
}

/* --- a host's loop that takes notes ------------------------------------------------------- */

/* Runs every loop of the library on the calling thread and keeps its processor time, so that a call
 * can be taken apart without a look inside. */
enum { BENCH_LOOPS = 64 };
typedef struct bench_notes {
  int32_t count;
  double seconds[BENCH_LOOPS];
} bench_notes;

/* The sph_parallel_for_fn. */
BENCH_FN void bench_noted_for(void *user, int64_t count, int64_t grain, sph_loop_fn body,
                              void *job) {
  bench_notes *notes = user;
  double begin = bench_cpu();
  (void)grain;
  body(job, 0, count, 0);
  if (notes->count < BENCH_LOOPS) notes->seconds[notes->count++] = bench_cpu() - begin;
}

/* --- lines -------------------------------------------------------------------------------- */

typedef struct bench_line {
  const char *name;
  int32_t dim, threads, isa;
  int64_t n;
  double pairs;      /* of one call, once per direction */
  double steps;      /* particle-steps of one call; 0: n */
  double neighbours; /* 0: pairs / n */
  bench_time time;
  double scalar_rate;        /* pairs per second of the plain loop; 0: not timed */
  double bytes_per_particle; /* 0: not known */
} bench_line;

/* `extra`: further keys, formatted. */
BENCH_FN __attribute__((format(printf, 2, 3))) void bench_print(const bench_line *l,
                                                                const char *extra, ...) {
  double n = (double)l->n, t = l->time.wall, steps = l->steps > 0.0 ? l->steps : n;
  va_list args;
  printf("BENCH case=%s dim=%d n=%lld threads=%d isa=%s neighbours=%.1f mpairs_per_s=%.1f "
         "ns_per_pair=%.3f particle_steps_per_s=%.4g",
         l->name, (int)l->dim, (long long)l->n, (int)l->threads, sph_isa_name(l->isa),
         l->neighbours > 0.0 ? l->neighbours : l->pairs / n, l->pairs / t * 1e-6,
         t / l->pairs * 1e9, steps / t);
  if (l->scalar_rate > 0.0)
    printf(" scalar_mpairs_per_s=%.1f times_scalar=%.2f", l->scalar_rate * 1e-6,
           l->pairs / t / l->scalar_rate);
  if (l->bytes_per_particle > 0.0) printf(" bytes_per_particle=%.0f", l->bytes_per_particle);
  printf(" best_mpairs_per_s=%.1f cpu_mpairs_per_s=%.1f busy=%.2f", l->pairs / l->time.best * 1e-6,
         l->pairs * l->threads / l->time.cpu * 1e-6, l->time.cpu / (t * l->threads));
  va_start(args, extra);
  if (*extra) putchar(' ');
  vprintf(extra, args);
  va_end(args);
  putchar('\n');
  fflush(stdout);
}

#endif
