/* Particle sets and right-hand sides of the benchmarks: a jittered lattice of spacing 1, Wendland
 * C2, every field filled; h is such that a particle has the wanted number of neighbours on average,
 * surfaces included. */
#ifndef SPH_TESTS_BENCH_CASES_H
#define SPH_TESTS_BENCH_CASES_H

#include "bench.h"

static const double bench_pi = 3.14159265358979323846;

/* splitmix64: the same numbers on every machine */
static __attribute__((unused)) uint64_t bench_seed;
BENCH_FN double bench_random(double lo, double hi) {
  uint64_t z = (bench_seed += UINT64_C(0x9e3779b97f4a7c15));
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return lo + (hi - lo) * ((double)((z ^ (z >> 31)) >> 11) * 0x1p-53);
}

enum { BENCH_SORTED = 0, BENCH_SHUFFLED = 1 };

typedef struct bench_setup {
  int32_t dim, threads, isa;
  int32_t host;   /* threads come from a pool of the host's */
  int32_t noted;  /* one thread, its loops timed: bench_notes */
  int32_t order;  /* BENCH_SORTED, BENCH_SHUFFLED */
  int32_t vary;   /* masses, speeds of sound and h differ: no loop for uniform sets fits */
  int32_t method; /* SPH_NEIGHBORS_*; 0: cells */
  int64_t n;      /* rounded to a full lattice */
  double h, skin;
} bench_setup;

typedef struct bench_set {
  bench_setup setup;
  bench_pool pool;
  bench_notes notes;
  sph_context *ctx;
  sph_kernel *kernel;
  sph_particles *set;
  sph_neighbors *list;
  int64_t n, pairs; /* pairs within the cutoff and the skin */
} bench_set;

BENCH_FN double *bench_field(bench_set *s, int32_t field) {
  double *a = NULL;
  BENCH_OK(sph_particles_field(s->set, field, &a), s->ctx);
  return a;
}

BENCH_FN int64_t bench_side(int64_t n, int32_t dim) {
  return (int64_t)floor(pow((double)n, 1.0 / dim) + 0.5);
}

/* lo .. hi, or the middle for all */
BENCH_FN void bench_fill(bench_set *s, int32_t field, double lo, double hi, int vary) {
  double *a = bench_field(s, field);
  int64_t count = s->n * sph_particles_components(s->set, field);
  for (int64_t k = 0; k < count; k++) a[k] = vary ? bench_random(lo, hi) : 0.5 * (lo + hi);
  BENCH_OK(sph_particles_touch(s->set, field), s->ctx);
}

BENCH_FN void bench_shuffle(double *x, int64_t n, int dim) {
  for (int64_t i = n - 1; i > 0; i--) {
    int64_t j = (int64_t)bench_random(0.0, (double)(i + 1));
    for (int a = 0; a < dim; a++) {
      double t = x[i * dim + a];
      x[i * dim + a] = x[j * dim + a];
      x[j * dim + a] = t;
    }
  }
}

/* Sorting by cells of the support radius is what a host would do who cares for locality. */
BENCH_FN void bench_place(bench_set *s) {
  int64_t side = bench_side(s->setup.n, s->setup.dim), dim = s->setup.dim;
  double *x = bench_field(s, SPH_FIELD_X);
  for (int64_t i = 0; i < s->n; i++)
    for (int64_t a = 0, k = i; a < dim; a++, k /= side)
      x[i * dim + a] = (double)(k % side) + 0.5 + bench_random(-0.3, 0.3);
  if (s->setup.order == BENCH_SHUFFLED) bench_shuffle(x, s->n, (int)dim);
  BENCH_OK(sph_particles_touch(s->set, SPH_FIELD_X), s->ctx);
  if (s->setup.order == BENCH_SORTED)
    BENCH_OK(sph_particles_sort(s->set, 2.0 * s->setup.h, NULL), s->ctx);
}

BENCH_FN void bench_context(bench_set *s) {
  sph_context_options o;
  sph_context_options_init(&o);
  o.threads = s->setup.threads;
  o.isa = s->setup.isa;
  bench_pin(s->setup.threads);
  if (s->setup.host) {
    bench_pool_start(&s->pool, s->setup.threads);
    o.threads = 1;
    o.workers = s->setup.threads;
    o.parallel_for = bench_pool_for;
    o.parallel_user = &s->pool;
  }
  if (s->setup.noted) {
    o.workers = 2; /* with one, loops would not be offered */
    o.parallel_for = bench_noted_for;
    o.parallel_user = &s->notes;
  }
  BENCH_OK(sph_context_create(&o, &s->ctx), NULL);
}

BENCH_FN sph_neighbors *bench_list(bench_set *s, int32_t method, double skin) {
  sph_neighbors_options o;
  sph_neighbors *list = NULL;
  sph_neighbors_options_init(&o);
  o.method = method ? method : SPH_NEIGHBORS_CELLS;
  o.support = sph_kernel_support(s->kernel);
  o.skin = skin;
  BENCH_OK(sph_neighbors_create(s->ctx, &o, &list), s->ctx);
  return list;
}

/* s must stay where it is: the context may point to its pool. */
BENCH_FN void bench_open(bench_set *s, const bench_setup *setup) {
  sph_particles_options o;
  memset(s, 0, sizeof *s);
  s->setup = *setup;
  bench_seed = 7;
  int64_t side = bench_side(setup->n, setup->dim);
  s->n = setup->dim == 1 ? side : setup->dim == 2 ? side * side : side * side * side;
  bench_context(s);
  sph_particles_options_init(&o);
  o.dim = setup->dim;
  o.capacity = s->n;
  BENCH_OK(sph_particles_create(s->ctx, &o, &s->set), s->ctx);
  BENCH_OK(sph_particles_add(s->set, s->n, NULL), s->ctx);
  BENCH_OK(sph_kernel_create(s->ctx, SPH_KERNEL_WENDLAND_C2, setup->dim, &s->kernel), s->ctx);
  bench_place(s);
  bench_fill(s, SPH_FIELD_H, 0.95 * setup->h, 1.05 * setup->h, setup->vary);
  s->list = bench_list(s, setup->method, setup->skin);
  BENCH_OK(sph_neighbors_build(s->list, s->set), s->ctx);
  s->pairs = sph_neighbors_pairs(s->list);
}

/* Values that leave no term without work; about half of the pairs approach each other. */
BENCH_FN void bench_fill_all(bench_set *s) {
  bench_fill(s, SPH_FIELD_V, -1.0, 1.0, 1);
  bench_fill(s, SPH_FIELD_M, 0.95, 1.05, s->setup.vary);
  bench_fill(s, SPH_FIELD_RHO, 0.95, 1.05, 1);
  bench_fill(s, SPH_FIELD_P, -1.0, 2.0, 1);
  bench_fill(s, SPH_FIELD_C, 9.0, 11.0, s->setup.vary);
  bench_fill(s, SPH_FIELD_SIGMA, -1.0, 1.0, 1);
}

BENCH_FN void bench_close(bench_set *s) {
  sph_neighbors_destroy(s->list);
  sph_kernel_destroy(s->kernel);
  sph_particles_destroy(s->set);
  sph_context_destroy(s->ctx);
  if (s->setup.host) bench_pool_stop(&s->pool);
  memset(s, 0, sizeof *s);
}

/* h for so many neighbours on average. Surfaces take their share, so the ball of a full environment
 * is a first guess only. */
BENCH_FN double bench_tune(int32_t dim, int64_t n, double neighbours) {
  double ball = dim == 1 ? 2.0 : dim == 2 ? bench_pi : 4.0 / 3.0 * bench_pi;
  bench_setup setup = {.dim = dim, .threads = 1, .n = n};
  setup.h = 0.5 * pow((neighbours + 1.0) / ball, 1.0 / dim);
  for (int k = 0; k < 2; k++) {
    bench_set s;
    bench_open(&s, &setup);
    double found = (double)s.pairs / (double)s.n;
    bench_close(&s);
    /* in 1-D the count jumps with h more than surfaces cost */
    if (dim > 1) setup.h *= pow((neighbours + 1.0) / (found + 1.0), 1.0 / dim);
  }
  return setup.h;
}

BENCH_FN double bench_usual_neighbours(int32_t dim) { return dim == 1 ? 5.5 : dim == 2 ? 28 : 74; }

/* --- right-hand sides --------------------------------------------------------------------- */

enum { BENCH_WCSPH, BENCH_ELASTIC, BENCH_CURED, BENCH_DENSITY, BENCH_GRADIENT, BENCH_CASES };

static const struct {
  const char *name, *extra;
} bench_case[BENCH_CASES] = {{"wcsph_rhs", "form=plain"},
                             {"elastic_rhs", "form=plain"},
                             {"elastic_rhs", "form=cured"},
                             {"density", "form=sum"},
                             {"gradient", "form=difference"}};

static const double bench_alpha = 0.5, bench_beta = 1.0;
static const double bench_art_epsilon = 0.3, bench_art_ratio = 0.75;

BENCH_FN void bench_add(bench_set *s, sph_rhs *rhs, int32_t kind, int32_t form, int32_t corrected) {
  sph_term t;
  sph_term_init(&t);
  t.kind = kind;
  t.form = form;
  t.corrected = corrected;
  t.alpha = bench_alpha;
  t.beta = bench_beta;
  t.epsilon = bench_art_epsilon;
  t.spacing_ratio = bench_art_ratio;
  t.power = 4;
  BENCH_OK(sph_rhs_add(rhs, &t), s->ctx);
}

/* A solid with sound speed near 10 at density 1. */
BENCH_FN sph_material *bench_solid(bench_set *s) {
  static const int32_t reduction[] = {0, SPH_UNIAXIAL_STRESS, SPH_PLANE_STRAIN, SPH_SOLID};
  sph_material *m = NULL;
  sph_hooke_options o;
  sph_hooke_options_init(&o);
  o.young = 75.0;
  o.poisson = 0.3;
  o.density = 1.0;
  o.reduction = reduction[s->setup.dim];
  BENCH_OK(sph_material_create_hooke(s->ctx, &o, &m), s->ctx);
  return m;
}

BENCH_FN sph_rhs *bench_rhs(bench_set *s, int which, int32_t update_list) {
  sph_rhs *rhs = NULL;
  sph_rhs_options o;
  int32_t cured = which == BENCH_CURED;
  sph_rhs_options_init(&o);
  o.update_list = update_list;
  BENCH_OK(sph_rhs_create(s->ctx, s->kernel, &o, &rhs), s->ctx);
  bench_add(s, rhs, SPH_TERM_MONAGHAN, 0, cured);
  if (which == BENCH_WCSPH) {
    bench_add(s, rhs, SPH_TERM_CONTINUITY, SPH_CONTINUITY_MASS, 0);
    bench_add(s, rhs, SPH_TERM_PRESSURE, SPH_PRESSURE_MASS, 0);
    return rhs;
  }
  sph_material *solid = bench_solid(s);
  BENCH_OK(sph_rhs_set_material(rhs, 0, solid), s->ctx);
  sph_material_destroy(solid);
  bench_add(s, rhs, SPH_TERM_STRESS_RATE, 0, cured);
  bench_add(s, rhs, SPH_TERM_STRESS, SPH_STRESS_SUMMED, cured);
  if (cured) bench_add(s, rhs, SPH_TERM_ARTIFICIAL_STRESS, 0, cured);
  return rhs;
}

/* --- one case made ready ------------------------------------------------------------------ */

typedef struct bench_work {
  bench_set *s;
  int which;
  sph_rhs *rhs;
  sph_operands a;
  sph_rate rates[2];
  int32_t count;
  double *out; /* of the operators */
} bench_work;

BENCH_FN void bench_work_open(bench_work *w, bench_set *s, int which) {
  memset(w, 0, sizeof *w);
  w->s = s;
  w->which = which;
  if (which == BENCH_DENSITY || which == BENCH_GRADIENT) {
    sph_operands_init(&w->a);
    BENCH_OK(sph_operands_from_set(s->set, &w->a), s->ctx);
    w->out = bench_alloc(s->n * s->setup.dim, sizeof(double));
    return;
  }
  int32_t other = which == BENCH_WCSPH ? SPH_FIELD_RHO : SPH_FIELD_SIGMA;
  w->rhs = bench_rhs(s, which, 1);
  w->count = 2;
  w->rates[0].field = SPH_FIELD_V;
  w->rates[1].field = other;
  for (int k = 0; k < 2; k++)
    w->rates[k].values =
        bench_alloc(s->n * sph_particles_components(s->set, w->rates[k].field), sizeof(double));
}

BENCH_FN void bench_work_run(void *user) {
  bench_work *w = user;
  bench_set *s = w->s;
  if (w->which == BENCH_DENSITY)
    BENCH_OK(sph_density_summation(s->list, s->kernel, &w->a, w->out), s->ctx);
  else if (w->which == BENCH_GRADIENT)
    BENCH_OK(sph_gradient(s->list, s->kernel, &w->a, SPH_GRADIENT_DIFFERENCE, 1, w->a.p, w->out),
             s->ctx);
  else
    BENCH_OK(sph_rhs_evaluate(w->rhs, s->set, s->list, 0.0, w->rates, w->count), s->ctx);
}

BENCH_FN void bench_work_close(bench_work *w) {
  sph_rhs_destroy(w->rhs);
  free(w->rates[0].values);
  free(w->rates[1].values);
  free(w->out);
}

#endif
