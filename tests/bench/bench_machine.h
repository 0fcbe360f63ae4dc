/* What the machine gives at most: multiply-adds in registers, and a stream through memory, on one
 * thread and on several. A ratio of two timings of the library is judged against these: where two
 * processors are two hyperthreads of one core, two threads cannot be twice as fast as one. The
 * fastest of several short runs counts, for a limit is what is wanted. */
#ifndef SPH_TESTS_BENCH_MACHINE_H
#define SPH_TESTS_BENCH_MACHINE_H

#include "bench.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

enum {
  MACHINE_RUNS = 60,
  MACHINE_CHAINS = 12,     /* independent ones: more than latency times units */
  MACHINE_ROUNDS = 500000, /* about a millisecond */
  MACHINE_STREAM = 1 << 23 /* doubles an array: three of 64 MiB, beyond the caches */
};

typedef struct bench_machine {
  int32_t threads, isa;
  double flops[2], bytes[2]; /* a second: [0] one thread, [1] `threads` */
} bench_machine;

typedef struct machine_job {
  int32_t isa, threads;
  double *a, *b, *c;
  double sink[BENCH_MOST * 8];
} machine_job;

/* --- multiply-adds ------------------------------------------------------------------------ */

/* x <- a x + b in twelve chains, kept in registers. FMA(x) is one step of a chain. */
#define MACHINE_LOOP(TYPE, SET, FMA)                                              \
  TYPE a = SET(0.999999), b = SET(1e-7);                                          \
  TYPE x0 = SET(1.0), x1 = SET(1.1), x2 = SET(1.2), x3 = SET(1.3), x4 = SET(1.4); \
  TYPE x5 = SET(1.5), x6 = SET(1.6), x7 = SET(1.7), x8 = SET(1.8), x9 = SET(1.9); \
  TYPE xa = SET(2.0), xb = SET(2.1);                                              \
  for (int64_t k = 0; k < rounds; k++) {                                          \
    x0 = FMA(x0, a, b), x1 = FMA(x1, a, b), x2 = FMA(x2, a, b);                   \
    x3 = FMA(x3, a, b), x4 = FMA(x4, a, b), x5 = FMA(x5, a, b);                   \
    x6 = FMA(x6, a, b), x7 = FMA(x7, a, b), x8 = FMA(x8, a, b);                   \
    x9 = FMA(x9, a, b), xa = FMA(xa, a, b), xb = FMA(xb, a, b);                   \
  }                                                                               \
  x0 = x0 + x1 + x2 + x3 + x4 + x5 + x6 + x7 + x8 + x9 + xa + xb;                 \
  memcpy(out, &x0, sizeof(double))

typedef double machine_pair __attribute__((vector_size(16)));
#define MACHINE_PAIR_SET(x) ((machine_pair){(x), (x)})
#define MACHINE_PAIR_FMA(x, a, b) ((x) * (a) + (b))

static void machine_portable(int64_t rounds, double *out) {
  MACHINE_LOOP(machine_pair, MACHINE_PAIR_SET, MACHINE_PAIR_FMA);
}
#if defined(__x86_64__)
__attribute__((target("avx2,fma"))) static void machine_avx2(int64_t rounds, double *out) {
  MACHINE_LOOP(__m256d, _mm256_set1_pd, _mm256_fmadd_pd);
}
__attribute__((target("avx512f"))) static void machine_avx512(int64_t rounds, double *out) {
  MACHINE_LOOP(__m512d, _mm512_set1_pd, _mm512_fmadd_pd);
}
#endif

static double machine_lanes(int32_t isa) {
  return isa == SPH_ISA_AVX512 ? 8.0 : isa == SPH_ISA_AVX2 ? 4.0 : 2.0;
}

static void machine_fma_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  machine_job *j = job;
  (void)worker;
  for (int64_t k = begin; k < end; k++) {
    double *out = &j->sink[8 * k];
#if defined(__x86_64__)
    if (j->isa == SPH_ISA_AVX512) machine_avx512(MACHINE_ROUNDS, out);
    if (j->isa == SPH_ISA_AVX2) machine_avx2(MACHINE_ROUNDS, out);
#endif
    if (j->isa == SPH_ISA_PORTABLE) machine_portable(MACHINE_ROUNDS, out);
  }
}

/* --- stream ------------------------------------------------------------------------------- */

static void machine_stream_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  machine_job *j = job;
  (void)worker;
  for (int64_t k = begin; k < end; k++) {
    int64_t lo = MACHINE_STREAM * k / j->threads, hi = MACHINE_STREAM * (k + 1) / j->threads;
    for (int64_t i = lo; i < hi; i++) j->a[i] = j->b[i] + 0.5 * j->c[i];
  }
}

/* --- both --------------------------------------------------------------------------------- */

/* Fastest of several runs, each thread with one piece. */
static double machine_time(machine_job *j, sph_loop_fn body) {
  bench_pool pool;
  double least = INFINITY;
  bench_pin(j->threads);
  bench_pool_start(&pool, j->threads);
  for (int r = -1; r < MACHINE_RUNS; r++) {
    double begin = bench_now();
    if (j->threads == 1)
      body(j, 0, 1, 0);
    else
      bench_pool_for(&pool, j->threads, 1, body, j);
    if (r >= 0) least = fmin(least, bench_now() - begin);
  }
  bench_pool_stop(&pool);
  return least;
}

BENCH_FN bench_machine bench_machine_measure(int32_t isa, int32_t threads) {
  machine_job *j = bench_alloc(1, sizeof *j);
  bench_machine m = {.threads = threads, .isa = isa};
  j->isa = isa;
  j->a = bench_alloc(MACHINE_STREAM, sizeof(double));
  j->b = bench_alloc(MACHINE_STREAM, sizeof(double));
  j->c = bench_alloc(MACHINE_STREAM, sizeof(double));
  for (int64_t i = 0; i < MACHINE_STREAM; i++) j->b[i] = j->c[i] = (double)i;
  for (int k = 0; k < 2; k++) {
    double flops = 2.0 * MACHINE_CHAINS * MACHINE_ROUNDS * machine_lanes(isa);
    j->threads = k == 0 ? 1 : threads;
    m.flops[k] = flops * j->threads / machine_time(j, machine_fma_body);
    /* two read, one written; a written line is read first */
    m.bytes[k] = 4.0 * sizeof(double) * MACHINE_STREAM / machine_time(j, machine_stream_body);
  }
  free(j->a);
  free(j->b);
  free(j->c);
  free(j);
  return m;
}

#endif
