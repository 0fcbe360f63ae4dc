/* Speed of whole steps of total-Lagrangian elasticity, through the public calls.
 *
 *   bench_step_tl [repetitions]
 *
 * A free block on a jittered lattice, neo-Hookean, set swinging by a smooth velocity field. The
 * scheme steps it: leapfrog, one evaluation a step, two sweeps over kept pair weights; forces with
 * and without hourglass control and viscosity. The list is built once, before. */
#include "bench.h"

#include "bench_cases.h"

static int repetitions = BENCH_REPETITIONS;

enum { BLOCK = 5 }; /* steps in one repetition */

typedef struct step_setup {
  const char *what;
  int32_t dim;
  int64_t n;
  double neighbours, hourglass, viscosity;
} step_setup;

typedef struct stepper {
  bench_set s;
  sph_total_lagrangian *tl;
  double t, dt;
} stepper;

static sph_material *make_rubber(bench_set *s) {
  sph_hyperelastic_options o;
  sph_material *m = NULL;
  sph_hyperelastic_options_init(&o);
  o.young = 1.0;
  o.poisson = 0.3;
  o.density = 1.0;
  o.reduction = s->setup.dim == 2 ? SPH_PLANE_STRAIN : SPH_SOLID;
  BENCH_OK(sph_material_create_hyperelastic(s->ctx, &o, &m), s->ctx);
  return m;
}

/* Each component varies along the next axis only. */
static void set_moving(bench_set *s, double speed) {
  const double *x = bench_field(s, SPH_FIELD_X);
  double *v = bench_field(s, SPH_FIELD_V);
  int64_t dim = s->setup.dim;
  double k = 2.0 * bench_pi / (double)bench_side(s->setup.n, s->setup.dim);
  for (int64_t i = 0; i < s->n; i++)
    for (int64_t a = 0; a < dim; a++) v[i * dim + a] = speed * sin(k * x[i * dim + (a + 1) % dim]);
}

static void step_open(stepper *w, const step_setup *u, double h, int32_t threads) {
  const bench_setup setup = {.dim = u->dim, .threads = threads, .n = u->n, .h = h};
  sph_total_lagrangian_options o;
  memset(w, 0, sizeof *w);
  bench_open(&w->s, &setup);
  bench_fill(&w->s, SPH_FIELD_M, 1.0, 1.0, 0);
  bench_fill(&w->s, SPH_FIELD_RHO, 1.0, 1.0, 0);
  set_moving(&w->s, 0.01);
  sph_total_lagrangian_options_init(&o);
  o.dim = u->dim;
  o.h_ratio = h;
  o.hourglass = u->hourglass;
  o.alpha = o.beta = u->viscosity;
  sph_material *rubber = make_rubber(&w->s);
  BENCH_OK(sph_total_lagrangian_create(w->s.ctx, &o, rubber, &w->tl), w->s.ctx);
  sph_material_destroy(rubber);
  BENCH_OK(sph_total_lagrangian_start(w->tl, w->s.set), w->s.ctx);
  BENCH_OK(sph_total_lagrangian_time_step(w->tl, w->s.set, &w->dt), w->s.ctx);
}

static void steps(void *user) {
  stepper *w = user;
  for (int k = 0; k < BLOCK; k++) {
    BENCH_OK(sph_total_lagrangian_step(w->tl, w->s.set, w->t, w->dt), w->s.ctx);
    w->t += w->dt;
  }
}

static void run(const step_setup *u, int32_t threads) {
  stepper w;
  int64_t before = 0, after = 0, peak = 0;
  step_open(&w, u, bench_tune(u->dim, u->n, u->neighbours), threads);
  steps(&w); /* every buffer gets its size */
  BENCH_OK(sph_context_memory(w.s.ctx, NULL, NULL, &before), w.s.ctx);
  bench_line line = {.name = "step_tl",
                     .dim = u->dim,
                     .n = w.s.n,
                     .threads = threads,
                     .isa = sph_context_isa(w.s.ctx),
                     .pairs = 2.0 * u->neighbours * (double)w.s.n * BLOCK,
                     .steps = (double)w.s.n * BLOCK,
                     .neighbours = u->neighbours,
                     .time = bench_measure(steps, &w, repetitions)};
  BENCH_OK(sph_context_memory(w.s.ctx, NULL, &peak, &after), w.s.ctx);
  line.bytes_per_particle = (double)peak / (double)w.s.n;
  bench_print(&line,
              "forces=%s evaluations_per_step=1 allocations=%lld cpu_particle_steps_per_s=%.4g",
              u->what, (long long)(after - before), line.steps * threads / line.time.cpu);
  sph_total_lagrangian_destroy(w.tl);
  bench_close(&w.s);
}

int main(int argc, char **argv) {
  static const step_setup setups[] = {{"elastic", 2, 130000, 20.0, 0.0, 0.0},
                                      {"elastic+hourglass", 2, 130000, 20.0, 0.1, 0.0},
                                      {"elastic+hourglass+viscosity", 2, 130000, 20.0, 0.1, 1.0},
                                      {"elastic+hourglass", 3, 130000, 56.0, 0.1, 0.0}};
  for (int k = 1; k < argc; k++)
    if (atoi(argv[k]) > 0 && atoi(argv[k]) <= BENCH_MOST) repetitions = atoi(argv[k]);
  for (size_t k = 0; k < sizeof setups / sizeof *setups; k++) run(&setups[k], 1);
  run(&setups[1], 2);
  return 0;
}
