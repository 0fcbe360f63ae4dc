/* Speed of neighbour lists from scratch: order, cells or tree, and pairs, each build anew.
 *
 * A jittered lattice; medians. Pairs are counted once per direction. Arguments: bench_args.h;
 * cases: list_cells, list_tree, with 1 million points. */
#include "bench.h"

#include "bench_args.h"

static bench_args args;

typedef struct setup {
  const char *name;
  int32_t method, dim;
  int64_t n;
  double neighbours; /* aimed at, in a full environment */
  double ratio;      /* largest h over smallest */
  int shuffled;
} setup;

static uint64_t seed = 7;

static double uniform(void) {
  seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return (double)(seed >> 11) * 0x1p-53;
}

/* A cubic lattice of spacing 1, each point moved by up to 0.3. */
static int64_t lattice(const setup *s, double *x) {
  int64_t side = (int64_t)floor(pow((double)s->n, 1.0 / s->dim) + 0.5), count = 1;
  for (int a = 0; a < s->dim; a++) count *= side;
  for (int64_t i = 0; i < count; i++) {
    int64_t at[3] = {i % side, i / side % side, i / side / side};
    for (int a = 0; a < s->dim; a++)
      x[i * s->dim + a] = (double)at[a] + 0.3 * (2.0 * uniform() - 1.0);
  }
  return count;
}

static void shuffle(double *x, int64_t n, int dim) {
  for (int64_t i = n - 1; i > 0; i--) {
    int64_t j = (int64_t)(uniform() * (double)(i + 1));
    for (int a = 0; a < dim; a++) {
      double t = x[i * dim + a];
      x[i * dim + a] = x[j * dim + a];
      x[j * dim + a] = t;
    }
  }
}

/* Cutoff 2 h for the wanted number of neighbours at spacing 1. With unequal h the spacing stays
 * and h varies slowly in space, as it does where resolution changes. */
static void lengths(const setup *s, const double *x, double *h, int64_t n) {
  double ball = s->dim == 1 ? 2.0 : s->dim == 2 ? acos(-1.0) : 4.0 / 3.0 * acos(-1.0);
  double base = 0.5 * pow((s->neighbours + 1.0) / ball, 1.0 / s->dim);
  double side = pow((double)n, 1.0 / s->dim);
  for (int64_t i = 0; i < n; i++) {
    double wave = 0.5 + 0.5 * cos(2.0 * acos(-1.0) * x[i * s->dim] / side);
    h[i] = base * (s->ratio > 1.0 ? pow(s->ratio, 0.5 - wave) : 1.0);
  }
}

typedef struct build_job {
  const setup *s;
  sph_context *ctx;
  sph_neighbors *list;
  const double *x, *h;
  int64_t n;
} build_job;

static void build(void *user) {
  build_job *j = user;
  BENCH_OK(sph_neighbors_build_arrays(j->list, j->s->dim, j->n, j->x, j->h, 0.0), j->ctx);
}

static bench_time measure(const setup *s, const double *x, const double *h, int64_t n, int32_t isa,
                          int32_t threads) {
  sph_context_options co;
  sph_neighbors_options no;
  build_job j = {.s = s, .x = x, .h = h, .n = n};
  int64_t peak = 0;
  sph_context_options_init(&co);
  co.threads = threads;
  co.isa = isa;
  bench_pin(threads);
  BENCH_OK(sph_context_create(&co, &j.ctx), NULL);
  sph_neighbors_options_init(&no);
  no.method = s->method;
  BENCH_OK(sph_neighbors_create(j.ctx, &no, &j.list), j.ctx);
  bench_line line = {.name = s->name, .dim = s->dim, .n = n, .threads = threads, .isa = isa};
  line.time = bench_measure(build, &j, args.repetitions);
  line.pairs = (double)sph_neighbors_pairs(j.list);
  BENCH_OK(sph_context_memory(j.ctx, NULL, &peak, NULL), j.ctx);
  line.bytes_per_particle = (double)peak / (double)n;
  bench_print(&line, "seconds=%.4f best_seconds=%.4f order=%s h_ratio=%g", line.time.wall,
              line.time.best, s->shuffled ? "shuffled" : "spatial", s->ratio);
  sph_neighbors_destroy(j.list);
  sph_context_destroy(j.ctx);
  return line.time;
}

/* One thread and, where wanted, several. */
static void measure_threads(const setup *s, const double *x, const double *h, int64_t n,
                            int32_t isa) {
  int32_t threads = bench_threads(&args);
  bench_time one = measure(s, x, h, n, isa, 1);
  if (!bench_wants_threads(&args)) return;
  bench_time many = measure(s, x, h, n, isa, threads);
  printf("BENCH case=ratio of=%s dim=%d isa=%s h_ratio=%g what=two_threads threads=%d value=%.3f "
         "by_cpu=%.3f\n",
         s->name, (int)s->dim, sph_isa_name(isa), s->ratio, (int)threads, one.best / many.best,
         one.cpu / many.cpu * threads);
}

/* Every instruction set for the first case only, unless asked for. */
static int wants_isa(const setup *s, int32_t isa) {
  int usual = s->dim == 3 && s->neighbours == 74 && s->ratio == 1 && !s->shuffled;
  return sph_isa_available(isa) && bench_wants_isa(&args, isa) &&
         (usual || args.longer || args.only);
}

static void run(const setup *s) {
  int64_t most = s->n + s->n / 8 + 2000; /* a full lattice */
  double *x = bench_alloc(most * s->dim, sizeof *x), *h = bench_alloc(most, sizeof *h);
  int64_t count = lattice(s, x);
  if (s->shuffled) shuffle(x, count, s->dim);
  lengths(s, x, h, count);
  int32_t best = bench_best_isa();
  measure_threads(s, x, h, count, best);
  for (int32_t isa = best - 1; isa >= SPH_ISA_PORTABLE; isa--)
    if (wants_isa(s, isa)) measure_threads(s, x, h, count, isa);
  free(x);
  free(h);
}

int main(int argc, char **argv) {
  args = bench_read_args(argc, argv);
  const int64_t n = args.n ? args.n : 1000000;
  const setup setups[] = {
      {"list_cells", SPH_NEIGHBORS_CELLS, 3, n, 74, 1, 0},
      {"list_cells", SPH_NEIGHBORS_CELLS, 3, n, 62, 1, 0},
      {"list_cells", SPH_NEIGHBORS_CELLS, 3, n, 74, 1, 1},
      {"list_cells", SPH_NEIGHBORS_CELLS, 2, n, 28, 1, 0},
      {"list_cells", SPH_NEIGHBORS_CELLS, 1, n, 6, 1, 0},
      {"list_tree", SPH_NEIGHBORS_TREE, 3, n, 74, 4, 0},
      {"list_tree", SPH_NEIGHBORS_TREE, 2, n, 28, 4, 0},
      {"list_tree", SPH_NEIGHBORS_TREE, 3, n, 74, 1, 0},
  };
  for (size_t k = 0; k < sizeof setups / sizeof setups[0]; k++) {
    setup s = setups[k];
    if (!bench_wants(&args, s.name) || !bench_wants_dim(&args, s.dim)) continue;
    if (args.neighbours > 0.0) s.neighbours = args.neighbours;
    run(&s);
  }
  return 0;
}
