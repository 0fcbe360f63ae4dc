/* Arguments of the benchmarks, the same for each program: `key=value`, in any order.
 *
 *   only=CASE          this case alone (wcsph_rhs, list_cells, step_elastic ...), measured with one
 *                      thread, the best instruction set and sorted particles
 *   variants           with only=: also threads, instruction sets and orders, as without it
 *   dim=3 n=1000000    this dimension, this many particles (a full lattice near it)
 *   neighbours=74      on average; form=cured, scheme=euler: what a line says
 *   threads=2 isa=avx2 the variants with these
 *   skin=0.2           of steps, in spacings, instead of a choice by measurement
 *   repetitions=5      of which the median is taken
 *   bare               of right-hand sides: neither plain loop nor roofline
 *   scaling            of right-hand sides: the same case from 10^4 to 10^6 (long: 10^7) alone
 *   long               also what takes minutes: ten million particles, every instruction set
 */
#ifndef SPH_TESTS_BENCH_ARGS_H
#define SPH_TESTS_BENCH_ARGS_H

#include "bench.h"

typedef struct bench_args {
  const char *only, *form, *scheme; /* NULL: every one */
  int32_t dim, threads, isa;        /* 0: every one */
  int32_t variants, longer, bare, scaling, repetitions;
  int64_t n;         /* 0: the case's own */
  double neighbours; /* 0: the usual */
  double skin;       /* < 0: to be chosen */
} bench_args;

static __attribute__((noreturn)) void bench_usage(const char *argument) {
  printf("unknown argument %s; known: only= dim= n= neighbours= form= scheme= threads= isa= skin= "
         "repetitions= variants bare scaling long\n",
         argument);
  exit(2);
}

/* The value of `argument` where it is `key=value`, else NULL. */
BENCH_FN const char *bench_value(const char *argument, const char *key) {
  size_t length = strlen(key);
  return strncmp(argument, key, length) == 0 && argument[length] == '=' ? argument + length + 1
                                                                        : NULL;
}

BENCH_FN double bench_number(const char *argument, const char *value, double lo, double hi) {
  char *end = NULL;
  double number = strtod(value, &end);
  if (end == value || *end || !(number >= lo && number <= hi)) bench_usage(argument);
  return number;
}

BENCH_FN int32_t bench_isa_of(const char *argument, const char *value) {
  for (int32_t isa = SPH_ISA_PORTABLE; isa <= SPH_ISA_AVX512; isa++)
    if (strcmp(sph_isa_name(isa), value) == 0) return isa;
  bench_usage(argument);
}

BENCH_FN void bench_argument(bench_args *a, const char *s) {
  const char *v;
  if ((v = bench_value(s, "only")))
    a->only = v;
  else if ((v = bench_value(s, "form")))
    a->form = v;
  else if ((v = bench_value(s, "scheme")))
    a->scheme = v;
  else if ((v = bench_value(s, "dim")))
    a->dim = (int32_t)bench_number(s, v, 1, 3);
  else if ((v = bench_value(s, "n")))
    a->n = (int64_t)bench_number(s, v, 1000, 1e9);
  else if ((v = bench_value(s, "neighbours")))
    a->neighbours = bench_number(s, v, 1, 10000);
  else if ((v = bench_value(s, "threads")))
    a->threads = (int32_t)bench_number(s, v, 1, BENCH_MOST);
  else if ((v = bench_value(s, "isa")))
    a->isa = bench_isa_of(s, v);
  else if ((v = bench_value(s, "skin")))
    a->skin = bench_number(s, v, 0.0, 10.0);
  else if ((v = bench_value(s, "repetitions")))
    a->repetitions = (int32_t)bench_number(s, v, 1, BENCH_MOST);
  else if (strcmp(s, "variants") == 0)
    a->variants = 1;
  else if (strcmp(s, "bare") == 0)
    a->bare = 1;
  else if (strcmp(s, "scaling") == 0)
    a->scaling = 1;
  else if (strcmp(s, "long") == 0)
    a->longer = 1;
  else
    bench_usage(s);
}

BENCH_FN bench_args bench_read_args(int argc, char **argv) {
  bench_args a = {.repetitions = BENCH_REPETITIONS, .skin = -1.0};
  for (int k = 1; k < argc; k++) bench_argument(&a, argv[k]);
  return a;
}

BENCH_FN int bench_wants(const bench_args *a, const char *name) {
  return a->only == NULL || strcmp(a->only, name) == 0;
}
BENCH_FN int bench_wants_dim(const bench_args *a, int32_t dim) {
  return a->dim == 0 || a->dim == dim;
}
BENCH_FN int bench_wants_form(const bench_args *a, const char *form) {
  return a->form == NULL || strcmp(a->form, form) == 0;
}
BENCH_FN int bench_wants_scheme(const bench_args *a, const char *scheme) {
  return a->scheme == NULL || strcmp(a->scheme, scheme) == 0;
}

/* Beside the first measurement (one thread, best instruction set): */
BENCH_FN int bench_wants_variants(const bench_args *a) { return a->only == NULL || a->variants; }
BENCH_FN int bench_wants_threads(const bench_args *a) {
  return a->threads ? a->threads > 1 : bench_wants_variants(a);
}
BENCH_FN int bench_wants_isa(const bench_args *a, int32_t isa) {
  return a->isa ? a->isa == isa : bench_wants_variants(a);
}
/* One thread beside many: two, or as many as asked for. */
BENCH_FN int32_t bench_threads(const bench_args *a) { return a->threads > 1 ? a->threads : 2; }

#endif
