/* Speed of whole steps: lists, right-hand side and integration, through the public calls.
 *
 * A free block of fluid or solid on a jittered lattice, set moving by a smooth velocity field: the
 * fluid at a tenth of the speed of sound, the solid at a two-hundredth. Lists have a skin, which is
 * chosen by measurement. Beside the library's integrators stands a host that integrates by itself
 * with one evaluation a step (scheme=host: v += dt a, then x += dt v).
 * Arguments: bench_args.h; cases: step_wcsph, step_elastic. */
#include "bench.h"

#include "bench_args.h"
#include "bench_cases.h"

static bench_args args;

enum { FLUID, SOLID };
enum { EULER, LEAPFROG, HOST };
static const char *const scheme_name[] = {"euler", "leapfrog", "host"};

typedef struct step_setup {
  const char *name;
  int32_t matter, dim;
  int64_t n;
  double neighbours;
} step_setup;

typedef struct stepper {
  bench_set s;
  sph_rhs *rhs, *sums; /* with and without update of the list */
  sph_integrator *it;  /* NULL: the host's loops */
  sph_rate rates[4];
  int32_t count;
  int64_t steps, evaluations;
  double t, dt;
} stepper;

/* --- physics ------------------------------------------------------------------------------ */

/* p = c^2 (rho - 1), c = 10 */
static int32_t fluid_pressure(void *user, const sph_material_block *b, double *p) {
  (void)user;
  for (int64_t i = 0; i < b->n; i++) p[i] = 100.0 * (b->rho[i] - 1.0);
  return 0;
}

static sph_material *make_material(stepper *w, int32_t matter) {
  sph_material *m = NULL;
  sph_material_functions f;
  if (matter == SOLID) return bench_solid(&w->s);
  sph_material_functions_init(&f);
  f.pressure = fluid_pressure;
  BENCH_OK(sph_material_create(w->s.ctx, &f, NULL, &m), w->s.ctx);
  return m;
}

static sph_rhs *make_rhs(stepper *w, int32_t matter, int32_t update_list) {
  sph_rhs *rhs = NULL;
  sph_rhs_options o;
  bench_set *s = &w->s;
  sph_material *material = make_material(w, matter);
  sph_rhs_options_init(&o);
  o.update_list = update_list;
  BENCH_OK(sph_rhs_create(s->ctx, s->kernel, &o, &rhs), s->ctx);
  BENCH_OK(sph_rhs_set_material(rhs, 0, material), s->ctx);
  sph_material_destroy(material);
  bench_add(s, rhs, SPH_TERM_MOTION, 0, 0);
  bench_add(s, rhs, SPH_TERM_MONAGHAN, 0, 0);
  bench_add(s, rhs, SPH_TERM_CONTINUITY, SPH_CONTINUITY_MASS, 0);
  if (matter == FLUID) {
    bench_add(s, rhs, SPH_TERM_PRESSURE, SPH_PRESSURE_MASS, 0);
    return rhs;
  }
  bench_add(s, rhs, SPH_TERM_STRESS, SPH_STRESS_SUMMED, 0);
  bench_add(s, rhs, SPH_TERM_STRESS_RATE, 0, 0);
  return rhs;
}

/* Each component varies along the next axis only, so that volume is kept (in 1-D: a wave). */
static void set_moving(bench_set *s, double speed) {
  const double *x = bench_field(s, SPH_FIELD_X);
  double *v = bench_field(s, SPH_FIELD_V);
  int64_t dim = s->setup.dim;
  double k = 2.0 * bench_pi / (double)bench_side(s->setup.n, s->setup.dim);
  for (int64_t i = 0; i < s->n; i++)
    for (int64_t a = 0; a < dim; a++)
      v[i * dim + a] = speed / sqrt((double)dim) * sin(k * x[i * dim + (a + 1) % dim]);
}

static void bind_fields(stepper *w, int32_t matter) {
  const int32_t field[] = {SPH_FIELD_X, SPH_FIELD_V, SPH_FIELD_RHO, SPH_FIELD_SIGMA};
  w->count = matter == SOLID ? 4 : 3;
  for (int32_t k = 0; k < w->count; k++) {
    w->rates[k].field = field[k];
    w->rates[k].values =
        bench_alloc(w->s.n * sph_particles_components(w->s.set, field[k]), sizeof(double));
    if (w->it) BENCH_OK(sph_integrator_bind_field(w->it, field[k]), w->s.ctx);
  }
}

static void make_integrator(stepper *w, int scheme) {
  sph_integrator_options o;
  if (scheme == HOST) return;
  sph_integrator_options_init(&o);
  o.method = scheme == EULER ? SPH_INTEGRATOR_EULER : SPH_INTEGRATOR_LEAPFROG;
  BENCH_OK(sph_integrator_create(w->s.ctx, &o, &w->it), w->s.ctx);
  BENCH_OK(sph_integrator_set_rhs(w->it, w->rhs, w->s.list), w->s.ctx);
}

/* w must stay where it is. */
static void step_open(stepper *w, const step_setup *u, double h, double skin, int scheme,
                      int32_t threads, int32_t noted) {
  bench_setup setup = {
      .dim = u->dim, .n = u->n, .h = h, .skin = skin, .threads = threads, .noted = noted};
  memset(w, 0, sizeof *w);
  setup.isa = bench_best_isa();
  setup.method = skin > 0.0 ? SPH_NEIGHBORS_VERLET : SPH_NEIGHBORS_CELLS;
  bench_open(&w->s, &setup);
  bench_fill(&w->s, SPH_FIELD_M, 1.0, 1.0, 0);
  bench_fill(&w->s, SPH_FIELD_RHO, 1.0, 1.0, 0);
  bench_fill(&w->s, SPH_FIELD_P, 0.0, 0.0, 0);
  bench_fill(&w->s, SPH_FIELD_C, 10.0, 10.0, 0);
  bench_fill(&w->s, SPH_FIELD_SIGMA, 0.0, 0.0, 0);
  set_moving(&w->s, u->matter == FLUID ? 1.0 : 0.05);
  w->rhs = make_rhs(w, u->matter, 1);
  w->sums = make_rhs(w, u->matter, 0);
  make_integrator(w, scheme);
  bind_fields(w, u->matter);
  BENCH_OK(sph_cfl_step(w->s.set, 0.3, &w->dt), w->s.ctx);
}

static void step_close(stepper *w) {
  sph_integrator_destroy(w->it);
  sph_rhs_destroy(w->rhs);
  sph_rhs_destroy(w->sums);
  for (int32_t k = 0; k < w->count; k++) free(w->rates[k].values);
  bench_close(&w->s);
}

/* --- one step ----------------------------------------------------------------------------- */

typedef struct advance_job {
  double *y;
  const double *rate;
  double dt;
} advance_job;

static void advance(void *user, int64_t begin, int64_t end, int32_t worker) {
  const advance_job *j = user;
  (void)worker;
  for (int64_t i = begin; i < end; i++) j->y[i] += j->dt * j->rate[i];
}

/* All but X by their rates, then X by the new velocity. */
static void integrate(stepper *w) {
  bench_set *s = &w->s;
  for (int32_t k = 1; k <= w->count; k++) {
    int32_t field = w->rates[k % w->count].field;
    advance_job j = {bench_field(s, field), w->rates[k % w->count].values, w->dt};
    if (field == SPH_FIELD_X) j.rate = bench_field(s, SPH_FIELD_V);
    BENCH_OK(sph_parallel_for(s->ctx, s->n * sph_particles_components(s->set, field), 16384,
                              advance, &j),
             s->ctx);
  }
  BENCH_OK(sph_particles_touch(s->set, SPH_FIELD_X), s->ctx);
}

static void evaluate(stepper *w, sph_rhs *rhs) {
  BENCH_OK(sph_rhs_evaluate(rhs, w->s.set, w->s.list, w->t, w->rates + 1, w->count - 1), w->s.ctx);
  w->evaluations++;
}

static void host_step(stepper *w) {
  evaluate(w, w->rhs);
  integrate(w);
}

static void one_step(void *user) {
  stepper *w = user;
  sph_step_info info;
  sph_step_info_init(&info);
  if (w->it) {
    BENCH_OK(sph_integrator_step(w->it, w->s.set, w->t, w->dt, &info), w->s.ctx);
    w->evaluations += info.evaluations;
  } else {
    host_step(w);
  }
  w->t += w->dt;
  w->steps++;
}

enum { BLOCK = 10 }; /* steps in one repetition, so that each has its share of builds */

static void steps(void *user) {
  for (int k = 0; k < BLOCK; k++) one_step(user);
}

static int64_t allocations(const stepper *w) {
  int64_t count = 0;
  BENCH_OK(sph_context_memory(w->s.ctx, NULL, NULL, &count), w->s.ctx);
  return count;
}

/* --- profile ------------------------------------------------------------------------------ */

enum { BUILD, CHECK, PACK, SWEEP, AFTER, INTEGRATE, PARTS };
static const char *const part_name[PARTS] = {"list_build", "list_check",  "prepare_and_pack",
                                             "sweep",      "after_sweep", "integrate"};

/* The longest loop of an evaluation is the one over pairs (it writes its results itself: there is
 * no unpacking apart from it); before come pressure and packing, after come stress rates. */
static void share_evaluation(const bench_notes *notes, double all, double part[PARTS]) {
  int32_t longest = 0;
  double before = 0.0;
  for (int32_t k = 1; k < notes->count; k++)
    if (notes->seconds[k] > notes->seconds[longest]) longest = k;
  for (int32_t k = 0; k < longest; k++) before += notes->seconds[k];
  part[PACK] += before;
  part[SWEEP] += notes->seconds[longest];
  part[AFTER] += all - before - notes->seconds[longest];
}

/* One step of the host's, its parts timed; they add up to the step. */
static void profiled_step(stepper *w, double part[PARTS]) {
  int32_t rebuilt = 0;
  double t0 = bench_cpu();
  BENCH_OK(sph_neighbors_update(w->s.list, w->s.set, &rebuilt), w->s.ctx);
  w->s.notes.count = 0;
  double t1 = bench_cpu();
  evaluate(w, w->sums);
  double t2 = bench_cpu();
  integrate(w);
  part[rebuilt ? BUILD : CHECK] += t1 - t0;
  share_evaluation(&w->s.notes, t2 - t1, part);
  part[INTEGRATE] += bench_cpu() - t2;
}

static void run_profile(const step_setup *u, double h, double skin) {
  stepper w;
  double part[PARTS] = {0.0}, all = 0.0;
  int count = BLOCK * args.repetitions;
  step_open(&w, u, h, skin, HOST, 1, 1);
  profiled_step(&w, part);
  memset(part, 0, sizeof part);
  for (int k = 0; k < count; k++) profiled_step(&w, part);
  for (int k = 0; k < PARTS; k++) all += part[k];
  printf("BENCH case=%s_profile dim=%d n=%lld threads=1 ns_per_particle_step=%.1f", u->name,
         (int)u->dim, (long long)w.s.n, all / count / (double)w.s.n * 1e9);
  for (int k = 0; k < PARTS; k++) printf(" %s=%.3f", part_name[k], part[k] / all);
  putchar('\n');
  fflush(stdout);
  step_close(&w);
}

/* --- whole steps -------------------------------------------------------------------------- */

static void run_steps(const step_setup *u, double h, double skin, int scheme, int32_t threads) {
  stepper w;
  step_open(&w, u, h, skin, scheme, threads, 0);
  steps(&w); /* every buffer gets its size */
  int64_t before = allocations(&w), builds = sph_neighbors_builds(w.s.list), peak = 0;
  w.steps = w.evaluations = 0;
  bench_time t = bench_measure(steps, &w, args.repetitions);
  int64_t made = allocations(&w) - before;
  double count = (double)w.steps, evaluations = (double)w.evaluations / count;
  double rebuilt = (double)(sph_neighbors_builds(w.s.list) - builds) / count;
  bench_line line = {.name = u->name,
                     .dim = u->dim,
                     .n = w.s.n,
                     .threads = threads,
                     .isa = w.s.setup.isa,
                     .pairs = u->neighbours * (double)w.s.n * evaluations * BLOCK,
                     .steps = (double)w.s.n * BLOCK,
                     .time = t};
  BENCH_OK(sph_context_memory(w.s.ctx, NULL, &peak, NULL), w.s.ctx);
  line.bytes_per_particle = (double)peak / (double)w.s.n;
  /* pairs of all evaluations, but the neighbours of one */
  line.neighbours = u->neighbours;
  bench_print(&line,
              "scheme=%s evaluations_per_step=%.2f builds_per_step=%.3f skin=%.2f "
              "listed_neighbours=%.1f allocations=%lld cpu_particle_steps_per_s=%.4g",
              scheme_name[scheme], evaluations, rebuilt, skin,
              (double)sph_neighbors_pairs(w.s.list) / (double)w.s.n, (long long)made,
              line.steps * threads / t.cpu);
  step_close(&w);
}

/* Lengths in units of the spacing. Without a skin every step builds. */
static double choose_skin(const step_setup *u, double h) {
  static const double skins[] = {0.0, 0.05, 0.1, 0.2, 0.3, 0.45};
  enum { SKINS = sizeof skins / sizeof skins[0], STEPS = 20 };
  double least = INFINITY, best = 0.0;
  printf("BENCH case=%s_skin dim=%d n=%lld ns_per_particle_step=", u->name, (int)u->dim,
         (long long)u->n);
  for (int k = 0; k < SKINS; k++) {
    stepper w;
    step_open(&w, u, h, skins[k], HOST, 1, 0);
    one_step(&w);
    double begin = bench_cpu();
    for (int i = 0; i < STEPS; i++) one_step(&w);
    double t = (bench_cpu() - begin) / STEPS;
    printf("%s%.2f:%.1f", k ? "," : "", skins[k], t / (double)w.s.n * 1e9);
    if (t < least) {
      least = t;
      best = skins[k];
    }
    step_close(&w);
  }
  printf(" best=%.2f\n", best);
  fflush(stdout);
  return best;
}

/* The skin is chosen on the first, smaller set of each kind. */
static void run_kind(const step_setup *kind, int64_t large) {
  step_setup u = *kind;
  int32_t threads = bench_threads(&args);
  if (!bench_wants(&args, u.name) || !bench_wants_dim(&args, u.dim)) return;
  if (args.n) u.n = args.n;
  if (args.neighbours > 0.0) u.neighbours = args.neighbours;
  double h = bench_tune(u.dim, u.n, u.neighbours);
  double skin = args.skin >= 0.0 ? args.skin : choose_skin(&u, h);
  for (int scheme = EULER; scheme <= HOST; scheme++)
    if (bench_wants_scheme(&args, scheme_name[scheme]) &&
        (scheme != LEAPFROG || args.longer || args.scheme))
      run_steps(&u, h, skin, scheme, 1);
  run_profile(&u, h, skin);
  if (bench_wants_threads(&args)) run_steps(&u, h, skin, HOST, threads);
  if (large == 0 || args.n || !bench_wants_variants(&args)) return;
  u.n = large;
  h = bench_tune(u.dim, u.n, u.neighbours);
  run_steps(&u, h, skin, HOST, 1);
  run_steps(&u, h, skin, HOST, threads);
}

/* `large`: once more with so many particles; 0: not. */
static const struct {
  step_setup setup;
  int64_t large;
} kinds[] = {
    {{"step_wcsph", FLUID, 3, 100000, 63.0}, 1000000},
    {{"step_wcsph", FLUID, 2, 100000, 25.0}, 0},
    {{"step_elastic", SOLID, 3, 100000, 64.0}, 0},
    {{"step_elastic", SOLID, 2, 100000, 25.0}, 0},
};

int main(int argc, char **argv) {
  args = bench_read_args(argc, argv);
  for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++)
    run_kind(&kinds[k].setup, kinds[k].large);
  return 0;
}
