/* Speed of the sums over pairs, through the public calls: composed right-hand sides and single
 * operators, packing and unpacking included, lists built before and reused. Arguments:
 * bench_args.h; cases: wcsph_rhs, elastic_rhs, density, gradient, with 1 million particles. */
#include "bench.h"

#include "bench_args.h"
#include "bench_cases.h"
#include "bench_machine.h"
#include "bench_scalar.h"

#include <sys/resource.h>

enum { PART = 4 };

static bench_args args;
static bench_machine machine; /* measured when first needed */

static const bench_machine *get_machine(void) {
  if (machine.threads == 0) machine = bench_machine_measure(bench_best_isa(), bench_threads(&args));
  return &machine;
}

static int wanted(int which) {
  return bench_wants(&args, bench_case[which].name) &&
         bench_wants_form(&args, strchr(bench_case[which].extra, '=') + 1);
}
static double neighbours_of(int32_t dim) {
  return args.neighbours > 0.0 ? args.neighbours : bench_usual_neighbours(dim);
}

/* --- the plain loop ----------------------------------------------------------------------- */

typedef struct scalar_result {
  double rate[BENCH_CASES]; /* pairs per second */
  double difference[BENCH_CASES];
} scalar_result;

static double difference(const double *a, const double *b, int64_t n) {
  double most = 0.0, size = 0.0;
  for (int64_t i = 0; i < n; i++) {
    most = fmax(most, fabs(a[i] - b[i]));
    size = fmax(size, fabs(b[i]));
  }
  return most / size;
}

static void scalar_open(scalar_job *j, bench_set *s) {
  int64_t n = s->n, d = s->setup.dim, sym = sph_sym_components(s->setup.dim);
  memset(j, 0, sizeof *j);
  sph_operands_init(&j->a);
  BENCH_OK(sph_operands_from_set(s->set, &j->a), s->ctx);
  BENCH_OK(sph_neighbors_rows(s->list, &j->offsets, &j->indices), s->ctx);
  j->rows = n;
  j->alpha = bench_alpha;
  j->beta = bench_beta;
  j->art_epsilon = bench_art_epsilon;
  j->art_ratio = bench_art_ratio;
  j->f = j->a.p;
  j->pr = bench_alloc(n, sizeof(double));
  j->matrix = bench_alloc(n * d * d, sizeof(double));
  j->art = bench_alloc(n * sym, sizeof(double));
  j->drho = bench_alloc(n, sizeof(double));
  j->dvdt = bench_alloc(n * d, sizeof(double));
  j->gradv = bench_alloc(n * d * d, sizeof(double));
  j->grad = bench_alloc(n * sym, sizeof(double));
}

static void scalar_close(scalar_job *j) {
  free(j->pr);
  free(j->matrix);
  free(j->art);
  free(j->drho);
  free(j->dvdt);
  free(j->gradv);
  free(j->grad);
}

/* The velocity gradient of the plain loop, through the material. */
static double stress_rate_difference(bench_work *w, scalar_job *j) {
  sph_material_block b;
  bench_set *s = w->s;
  int64_t n = s->n * sph_sym_components(s->setup.dim);
  sph_material *solid = bench_solid(s);
  sph_material_block_init(&b);
  b.dim = s->setup.dim;
  b.n = s->n;
  b.velocity_gradient = j->gradv;
  b.sigma = j->a.sigma;
  BENCH_OK(sph_material_stress_rate(solid, &b, j->art), s->ctx);
  sph_material_destroy(solid);
  return difference(w->rates[1].values, j->art, n);
}

/* Whether both computed the same. */
static double compare(bench_set *s, int which, scalar_job *j) {
  bench_work w;
  double d;
  bench_work_open(&w, s, which);
  bench_work_run(&w);
  if (which == BENCH_DENSITY)
    d = difference(w.out, j->drho, s->n);
  else if (which == BENCH_GRADIENT)
    d = difference(w.out, j->grad, s->n * s->setup.dim);
  else if (which == BENCH_WCSPH)
    d = fmax(difference(w.rates[0].values, j->dvdt, s->n * s->setup.dim),
             difference(w.rates[1].values, j->drho, s->n));
  else
    d = fmax(difference(w.rates[0].values, j->dvdt, s->n * s->setup.dim),
             stress_rate_difference(&w, j));
  bench_work_close(&w);
  return d;
}

/* Those of the rows that are timed: the first ones in the host's order, which is sorted. */
static double pairs_of(const scalar_job *j) {
  return (double)(j->offsets[j->rows] - j->offsets[0]);
}

/* Compared on all rows, timed on a quarter of them. */
static scalar_result time_scalar(int32_t dim, int64_t n, double h) {
  static const bench_fn loops[BENCH_CASES] = {scalar_wcsph, scalar_elastic, scalar_cured,
                                              scalar_density, scalar_gradient};
  bench_setup setup = {.dim = dim, .n = n, .h = h, .threads = 1, .isa = bench_best_isa()};
  scalar_result r;
  bench_set s;
  scalar_job j;
  bench_open(&s, &setup);
  bench_fill_all(&s);
  scalar_open(&j, &s);
  memset(&r, 0, sizeof r);
  for (int k = 0; k < BENCH_CASES; k++) {
    if (!wanted(k)) continue;
    loops[k](&j);
    r.difference[k] = compare(&s, k, &j);
    if (!(r.difference[k] < 1e-10)) {
      printf("failed: %s differs from the plain loop by %g\n", bench_case[k].name, r.difference[k]);
      exit(1);
    }
    j.rows = s.n / PART;
    r.rate[k] = pairs_of(&j) / bench_measure(loops[k], &j, args.repetitions).wall;
    j.rows = s.n;
  }
  scalar_close(&j);
  bench_close(&s);
  return r;
}

/* --- the library -------------------------------------------------------------------------- */

static double bytes_per_particle(const bench_set *s) {
  int64_t peak = 0;
  BENCH_OK(sph_context_memory(s->ctx, NULL, &peak, NULL), s->ctx);
  return (double)peak / (double)s->n;
}

static const char *threads_of(const bench_setup *u) {
  return u->threads == 1 ? "none" : u->host ? "host" : "pool";
}

/* Cases 0 .. cases - 1 on one set. times (may be NULL) receives what they took. */
static void run_cases(const bench_setup *setup, int cases, const scalar_result *scalar,
                      bench_time *times) {
  bench_set s;
  bench_open(&s, setup);
  bench_fill_all(&s);
  for (int k = 0; k < cases; k++) {
    bench_work w;
    if (!wanted(k)) continue;
    bench_line line = {.name = bench_case[k].name,
                       .dim = setup->dim,
                       .n = s.n,
                       .threads = setup->threads,
                       .isa = setup->isa,
                       .pairs = (double)s.pairs,
                       .scalar_rate = scalar ? scalar->rate[k] : 0.0};
    bench_work_open(&w, &s, k);
    line.time = bench_measure(bench_work_run, &w, args.repetitions);
    line.bytes_per_particle = bytes_per_particle(&s);
    bench_print(&line, "%s parallel=%s order=%s masses_and_h=%s", bench_case[k].extra,
                threads_of(setup), setup->order == BENCH_SHUFFLED ? "shuffled" : "sorted",
                setup->vary ? "vary" : "uniform");
    if (times) {
      times[k] = line.time;
      times[k].pairs = line.pairs;
    }
    bench_work_close(&w);
  }
  bench_close(&s);
}

/* Times of a over b: of the fastest repetitions, and of processor time, which other work on the
 * machine disturbs less. With threads the latter is time of all of them, so 2.0 would be two
 * threads that never wait or hinder each other; and what register-only loops gain on these
 * processors stands beside. */
static void ratio(const char *what, int32_t dim, int which, bench_time a, bench_time b,
                  int32_t threads) {
  if (!wanted(which)) return;
  double value = a.best / b.best;
  printf("BENCH case=ratio of=%s %s dim=%d what=%s value=%.3f by_cpu=%.3f", bench_case[which].name,
         bench_case[which].extra, (int)dim, what, value, a.cpu / b.cpu * threads);
  if (threads > 1) {
    double possible = get_machine()->flops[1] / get_machine()->flops[0];
    printf(" possible=%.2f of_possible=%.2f", possible, value / possible);
  }
  putchar('\n');
  fflush(stdout);
}

/* How near to what the machine can do. Bytes are those that must come from and go to memory: an
 * index a pair, and the fields of a particle once for all its neighbours. */
static void roofline(int32_t dim, int which, double neighbours, double pairs_per_s) {
  if (!wanted(which)) return;
  const bench_machine *m = get_machine();
  double flops = scalar_flops(which, (int)dim);
  double bytes = 4.0 + 8.0 * scalar_doubles(which, (int)dim) / neighbours;
  double roof = fmin(m->flops[0], flops / bytes * m->bytes[0]);
  printf("BENCH case=roofline of=%s %s dim=%d threads=1 flops_per_pair=%.0f bytes_per_pair=%.2f "
         "flops_per_byte=%.2f peak_gflops=%.1f stream_gbytes_per_s=%.1f roof_gflops=%.1f "
         "bound=%s gflops=%.1f share=%.3f\n",
         bench_case[which].name, bench_case[which].extra, (int)dim, flops, bytes, flops / bytes,
         m->flops[0] * 1e-9, m->bytes[0] * 1e-9, roof * 1e-9,
         roof < m->flops[0] ? "memory" : "flops", flops * pairs_per_s * 1e-9,
         flops * pairs_per_s / roof);
  fflush(stdout);
}

static void run_isas(const bench_setup *best, const scalar_result *scalar, const bench_time *time) {
  bench_time other[BENCH_CASES];
  for (int32_t isa = best->isa - 1; isa >= SPH_ISA_PORTABLE; isa--) {
    bench_setup u = *best;
    u.isa = isa;
    if (!sph_isa_available(isa) || !bench_wants_isa(&args, isa)) continue;
    run_cases(&u, BENCH_CASES, scalar, other);
    for (int k = 0; k < BENCH_CASES; k++)
      ratio(isa == SPH_ISA_AVX2 ? "avx2_speed" : "portable_speed", u.dim, k, time[k], other[k], 1);
  }
}

static void run_threads(const bench_setup *best, const scalar_result *scalar,
                        const bench_time *time) {
  bench_time other[BENCH_CASES];
  for (int32_t host = 0; host < 2; host++) {
    bench_setup u = *best;
    u.threads = bench_threads(&args);
    u.host = host;
    run_cases(&u, BENCH_CASES, scalar, other);
    for (int k = 0; k < BENCH_CASES; k++)
      ratio(host ? "two_host_threads" : "two_threads", u.dim, k, time[k], other[k], u.threads);
  }
}

static void run_orders(const bench_setup *best, const scalar_result *scalar,
                       const bench_time *time) {
  bench_time other[BENCH_CASES];
  bench_setup shuffled = *best, vary = *best;
  shuffled.order = BENCH_SHUFFLED;
  run_cases(&shuffled, 2, scalar, other);
  for (int k = 0; k < 2; k++) ratio("shuffled_time", best->dim, k, other[k], time[k], 1);
  vary.vary = 1;
  run_cases(&vary, 3, NULL, other);
  for (int k = 0; k < 3; k++) ratio("varying_time", best->dim, k, other[k], time[k], 1);
}

static void print_differences(int32_t dim, const scalar_result *scalar) {
  printf("# %d-D: largest difference from the plain loop, relative to the largest rate:", (int)dim);
  for (int k = 0; k < BENCH_CASES; k++)
    if (wanted(k)) printf(" %.1e", scalar->difference[k]);
  printf("\n");
}

static void run_dimension(int32_t dim, int64_t n) {
  double h = bench_tune(dim, n, neighbours_of(dim));
  bench_time best[BENCH_CASES];
  scalar_result scalar = {{0.0}, {0.0}};
  bench_setup u = {.dim = dim, .n = n, .h = h, .threads = 1, .isa = bench_best_isa()};
  int variants = dim == 3 || args.longer || args.only;
  if (!args.bare) {
    scalar = time_scalar(dim, n, h);
    print_differences(dim, &scalar);
  }
  run_cases(&u, BENCH_CASES, &scalar, best);
  if (dim == 3 && !args.bare)
    for (int k = 0; k <= BENCH_ELASTIC; k++)
      roofline(dim, k, neighbours_of(dim), best[k].pairs / best[k].best);
  if (variants) run_isas(&u, &scalar, best);
  if (bench_wants_threads(&args)) run_threads(&u, &scalar, best);
  if (bench_wants_variants(&args) && variants) run_orders(&u, &scalar, best);
}

/* Largest memory of the process so far, all sets and the benchmark's own arrays included. */
static double resident_gib(void) {
  struct rusage u;
  return getrusage(RUSAGE_SELF, &u) == 0 ? (double)u.ru_maxrss / 1048576.0 : 0.0;
}

static void print_size(int which, int64_t n, bench_time each, bench_time first) {
  if (!wanted(which)) return;
  printf("BENCH case=scaling of=%s dim=3 n=%lld ns_per_particle=%.2f cpu_ns_per_particle=%.2f "
         "times_first=%.3f by_cpu=%.3f resident_gib=%.2f\n",
         bench_case[which].name, (long long)n, each.best * 1e9, each.cpu * 1e9,
         each.best / first.best, each.cpu / first.cpu, resident_gib());
  fflush(stdout);
}

/* The same number of neighbours at every size: time of a particle against that of the smallest. */
static void run_scaling(void) {
  bench_time first[2];
  for (int64_t n = 10000; n <= (args.longer ? 10000000 : 1000000); n *= 10) {
    bench_time t[BENCH_CASES];
    bench_setup u = {.dim = 3, .n = n, .threads = 1, .isa = bench_best_isa()};
    double side = (double)bench_side(n, 3), count = side * side * side;
    u.h = bench_tune(3, n, neighbours_of(3));
    run_cases(&u, 2, NULL, t);
    for (int k = 0; k < 2; k++) {
      bench_time each = {t[k].wall / count, t[k].best / count, t[k].cpu / count, 0.0};
      if (n == 10000) first[k] = each;
      print_size(k, (int64_t)count, each, first[k]);
    }
  }
}

int main(int argc, char **argv) {
  int any = 0;
  args = bench_read_args(argc, argv);
  for (int k = 0; k < BENCH_CASES; k++) any |= wanted(k);
  if (!any) return 0;
  for (int32_t dim = 3; dim >= 1 && !args.scaling; dim--)
    if (bench_wants_dim(&args, dim)) run_dimension(dim, args.n ? args.n : 1000000);
  if (args.scaling || (args.n == 0 && bench_wants_dim(&args, 3) && bench_wants_variants(&args)))
    run_scaling();
  return 0;
}
