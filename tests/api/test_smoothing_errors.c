/* Operators with one h a particle: refusals, odd particles, failing memory, threads, equal masses.
 */
#include "../oom.h"
#include "../smoothed_help.h"

static sm_particles set;
static double out[5][9 * OC_MAX], again[5][9 * OC_MAX];

typedef struct world {
  sph_context *ctx;
  sph_kernel *kernel;
  sph_neighbors *list;
  sph_operands a;
} world;

enum { VARY = OC_VARY_M | OC_VARY_H | OC_VARY_C };

static world open_world(int32_t isa, int32_t threads) {
  world w = {0};
  w.ctx = oc_context(isa, threads);
  w.kernel = oc_kernel(w.ctx, SPH_KERNEL_GAUSSIAN, set.s.dim);
  set.kernel = w.kernel;
  w.list = sm_list(w.ctx, &set);
  sm_operands(&set, &w.a);
  return w;
}

static void close_world(world *w) {
  sph_neighbors_destroy(w->list);
  sph_kernel_destroy(w->kernel);
  sph_context_destroy(w->ctx);
}

/* --- every operator, in one table ------------------------------------------------------------- */

/* Results go to `to`; the fields it needs besides x, h, m. */
typedef struct operator_row {
  const char *name, *needs; /* letters: r(ho) v p c s(igma) */
  sph_status (*run)(world *w, double (*to)[9 * OC_MAX]);
} operator_row;

static int32_t smoothing = SPH_SMOOTHING_NUMBER;
static const sph_dissipation *options;

static sph_status run_density(world *w, double (*to)[9 * OC_MAX]) {
  return sph_smoothed_density(w->list, w->kernel, &w->a, smoothing, to[0]);
}
static sph_status run_omega(world *w, double (*to)[9 * OC_MAX]) {
  return sph_grad_h(w->list, w->kernel, &w->a, smoothing, 0.2, to[0]);
}
static sph_status run_pressure(world *w, double (*to)[9 * OC_MAX]) {
  return sph_smoothed_pressure(w->list, w->kernel, &w->a, smoothing, to[0], to[1], to[2]);
}
static sph_status run_stress(world *w, double (*to)[9 * OC_MAX]) {
  return sph_smoothed_stress(w->list, w->kernel, &w->a, to[1], to[2], to[3]);
}
static sph_status run_dissipation(world *w, double (*to)[9 * OC_MAX]) {
  return sph_smoothed_dissipation(w->list, w->kernel, &w->a, options, to[0], to[1], to[2]);
}

static const operator_row operators[] = {{"density", "", run_density},
                                         {"omega", "r", run_omega},
                                         {"pressure", "rv", run_pressure},
                                         {"stress", "rvs", run_stress},
                                         {"dissipation", "rvc", run_dissipation}};
enum { OPERATORS = 5, CALM = 77 };

static void calm(double (*to)[9 * OC_MAX]) {
  for (int k = 0; k < 5; k++)
    for (int i = 0; i < 9 * OC_MAX; i++) to[k][i] = CALM;
}

/* Refused with these words, and nothing was written. */
static void refused(world *w, const operator_row *op, sph_status want, const char *words) {
  calm(out);
  sph_status got = op->run(w, out);
  if (got != want) print_error("%s: %s\n", op->name, sph_context_last_error(w->ctx));
  check_status(got, want);
  if (!strstr(sph_context_last_error(w->ctx), words))
    fail_msg("%s: \"%s\" is not in \"%s\"", op->name, words, sph_context_last_error(w->ctx));
  for (int k = 0; k < 5; k++)
    for (int64_t i = 0; i < 9 * OC_MAX; i++) assert_true(out[k][i] == CALM);
}

/* --- refusals -----------------------------------------------------------------------------------
 */

static void test_missing(void **state) {
  (void)state;
  sm_make(&set, 2, VARY, 3.0, 1);
  world w = open_world(SPH_ISA_AUTO, 1);
  for (int k = 0; k < OPERATORS; k++) {
    const operator_row *op = &operators[k];
    sm_operands(&set, &w.a);
    w.a.x = NULL;
    refused(&w, op, SPH_ERR_ARG, "x is NULL");
    sm_operands(&set, &w.a);
    w.a.m = NULL;
    refused(&w, op, SPH_ERR_ARG, "m is NULL");
    w.a.m0 = INFINITY;
    refused(&w, op, SPH_ERR_ARG, "m is NULL and its uniform value is inf");
    sm_operands(&set, &w.a);
    w.a.rho = NULL;
    if (strchr(op->needs, 'r')) refused(&w, op, SPH_ERR_ARG, "rho is NULL");
    sm_operands(&set, &w.a);
    w.a.v = NULL;
    if (strchr(op->needs, 'v')) refused(&w, op, SPH_ERR_ARG, "v is NULL");
    sm_operands(&set, &w.a);
    w.a.c = NULL;
    if (strchr(op->needs, 'c')) refused(&w, op, SPH_ERR_ARG, "c is NULL");
    sm_operands(&set, &w.a);
    w.a.sigma = NULL;
    if (strchr(op->needs, 's')) refused(&w, op, SPH_ERR_ARG, "sigma is NULL");
    sm_operands(&set, &w.a);
    w.a.n = set.s.n - 1;
    refused(&w, op, SPH_ERR_ARG, "");
  }
  close_world(&w);
}

static void test_numbers(void **state) {
  (void)state;
  sm_make(&set, 1, VARY, 3.0, 1);
  world w = open_world(SPH_ISA_AUTO, 1);
  const operator_row *pressure = &operators[2], *loss = &operators[4];
  w.a.omega = NULL;
  w.a.omega0 = -1.0;
  refused(&w, pressure, SPH_ERR_ARG, "omega0 is -1");
  w.a.omega0 = NAN;
  refused(&w, pressure, SPH_ERR_ARG, "omega0 is nan");
  w.a.omega0 = 0.0;
  w.a.p = NULL;
  w.a.p0 = INFINITY;
  refused(&w, pressure, SPH_ERR_ARG, "p0 is inf");
  refused(&w, loss, SPH_ERR_ARG, "p0 is inf");
  w.a.p0 = 0.0;
  w.a.e = NULL;
  w.a.e0 = NAN;
  refused(&w, loss, SPH_ERR_ARG, "e0 nan");
  for (smoothing = -1; smoothing <= 4; smoothing += smoothing == 0 ? 4 : 1)
    for (int k = 0; k < 3; k++) refused(&w, &operators[k], SPH_ERR_ARG, "unknown smoothing");
  smoothing = SPH_SMOOTHING_VOLUME;
  refused(&w, &operators[0], SPH_ERR_UNSUPPORTED, "volume");
  smoothing = SPH_SMOOTHING_NUMBER;
  calm(out);
  check_status(sph_grad_h(w.list, w.kernel, &w.a, 1, -0.1, out[0]), SPH_ERR_ARG);
  check_status(sph_grad_h(w.list, w.kernel, &w.a, 1, NAN, out[0]), SPH_ERR_ARG);
  check_status(sph_grad_h(w.list, w.kernel, &w.a, 1, INFINITY, out[0]), SPH_ERR_ARG);
  assert_true(out[0][0] == CALM);
  close_world(&w);
}

static void test_options(void **state) {
  (void)state;
  static const double bad[] = {-1.0, NAN, INFINITY, -INFINITY};
  sph_dissipation z;
  sm_make(&set, 1, VARY, 3.0, 1);
  world w = open_world(SPH_ISA_AUTO, 1);
  options = &z;
  double *const numbers[] = {&z.viscosity, &z.viscosity_b, &z.conductivity, &z.conductivity_b,
                             &z.mass_flux, &z.mass_flux_b, &z.flux_limit};
  static const char *const names[] = {"viscosity", "viscosity_b", "conductivity", "conductivity_b",
                                      "mass_flux", "mass_flux_b", "flux_limit"};
  for (int k = 0; k < 7; k++)
    for (int b = 0; b < 4; b++) {
      sph_dissipation_init(&z);
      *numbers[k] = bad[b];
      refused(&w, &operators[4], SPH_ERR_ARG, names[k]);
    }
  int32_t *const choices[] = {&z.signal, &z.conductivity_form, &z.pairs, &z.flux_form};
  for (int k = 0; k < 4; k++)
    for (int32_t value = 0; value <= 3; value += 3) {
      sph_dissipation_init(&z);
      *choices[k] = value;
      refused(&w, &operators[4], SPH_ERR_ARG, "unknown");
    }
  sph_dissipation_init(&z);
  z.size = 3;
  refused(&w, &operators[4], SPH_ERR_ARG, "");
  struct {
    sph_dissipation z;
    double later;
  } newer;
  memset(&newer, 0, sizeof newer);
  sph_dissipation_init_sized(&newer.z, sizeof newer);
  options = &newer.z;
  check_ok(run_dissipation(&w, out)); /* zeros behind are no wish */
  newer.later = 1.0;
  refused(&w, &operators[4], SPH_ERR_VERSION, "");
  options = NULL;
  close_world(&w);
}

/* A list with another rule, one that reaches too short, one never built, one that is old. */
static void test_lists(void **state) {
  (void)state;
  sm_make(&set, 2, VARY, 3.0, 1);
  world w = open_world(SPH_ISA_AUTO, 1);
  sph_neighbors *good = w.list, *never = NULL, *other = NULL;
  sph_kernel *cubic = oc_kernel(w.ctx, SPH_KERNEL_CUBIC_SPLINE, 2);
  for (int k = 0; k < OPERATORS; k++) {
    const operator_row *op = &operators[k];
    for (int32_t rule = 1; rule <= OC_RULES; rule++) {
      if (rule == SPH_H_MAX) continue;
      w.list = oc_list(w.ctx, &set.s, w.kernel, rule);
      if (rule == SPH_H_AVERAGE)
        check_ok(op->run(&w, out));
      else
        refused(&w, op, SPH_ERR_ARG, "larger h");
      sph_neighbors_destroy(w.list);
    }
    w.list = oc_list(w.ctx, &set.s, cubic, SPH_H_MAX);
    refused(&w, op, SPH_ERR_ARG, "reaches 2 h");
    sph_neighbors_destroy(w.list);
    sph_neighbors_options o;
    sph_neighbors_options_init(&o);
    o.support = 3.0;
    check_ok(sph_neighbors_create(w.ctx, &o, &never));
    w.list = never;
    refused(&w, op, SPH_ERR_STATE, "");
    sph_neighbors_destroy(never);
    w.list = good;
    set.s.x[7] += 0.25;
    refused(&w, op, SPH_ERR_STALE, "particle 3");
    set.s.x[7] -= 0.25;
    other = w.list;
    w.kernel = (sph_kernel *)other;
    refused(&w, op, SPH_ERR_HANDLE, "kernel");
    w.kernel = (sph_kernel *)set.kernel;
  }
  sph_kernel_destroy(cubic);
  close_world(&w);
}

/* --- outputs that are not wanted
 * ------------------------------------------------------------------ */

/* Each output alone has the bits that it has among the others. */
static void test_each_output(void **state) {
  (void)state;
  sm_make(&set, 3, VARY, 3.0, 2);
  world w = open_world(SPH_ISA_AUTO, 1);
  const size_t n = (size_t)set.s.n * sizeof(double);
  calm(out);
  check_ok(run_pressure(&w, out));
  check_ok(sph_smoothed_pressure(w.list, w.kernel, &w.a, smoothing, again[0], NULL, NULL));
  check_ok(sph_smoothed_pressure(w.list, w.kernel, &w.a, smoothing, NULL, NULL, again[2]));
  w.a.v = NULL; /* not needed then */
  check_ok(sph_smoothed_pressure(w.list, w.kernel, &w.a, smoothing, NULL, again[1], NULL));
  assert_memory_equal(out[0], again[0], n);
  assert_memory_equal(out[1], again[1], 3 * n);
  assert_memory_equal(out[2], again[2], n);
  sm_operands(&set, &w.a);
  check_ok(run_stress(&w, out));
  check_ok(sph_smoothed_stress(w.list, w.kernel, &w.a, NULL, again[2], NULL));
  check_ok(sph_smoothed_stress(w.list, w.kernel, &w.a, NULL, NULL, again[3]));
  w.a.v = NULL;
  check_ok(sph_smoothed_stress(w.list, w.kernel, &w.a, again[1], NULL, NULL));
  for (int k = 1; k <= 3; k++)
    assert_memory_equal(out[k], again[k], (k == 1 ? 3 : k == 2 ? 1 : 9) * n);
  sm_operands(&set, &w.a);
  check_ok(run_dissipation(&w, out));
  check_ok(sph_smoothed_dissipation(w.list, w.kernel, &w.a, NULL, again[0], NULL, NULL));
  check_ok(sph_smoothed_dissipation(w.list, w.kernel, &w.a, NULL, NULL, again[1], NULL));
  check_ok(sph_smoothed_dissipation(w.list, w.kernel, &w.a, NULL, NULL, NULL, again[2]));
  for (int k = 0; k <= 2; k++) assert_memory_equal(out[k], again[k], (k == 1 ? 3 : 1) * n);
  close_world(&w);
}

/* rows: only the first ones are written. */
static void test_rows(void **state) {
  (void)state;
  static const int width[4] = {1, 2, 1, 4};
  sm_make(&set, 2, VARY, 3.0, 2);
  world w = open_world(SPH_ISA_AUTO, 1);
  for (int k = 0; k < OPERATORS; k++)
    for (int64_t rows = 0; rows < set.s.n; rows += 40) {
      calm(out);
      calm(again);
      w.a.rows = -1;
      check_ok(operators[k].run(&w, again));
      w.a.rows = rows;
      check_ok(operators[k].run(&w, out));
      for (int o = 0; o < 4; o++) {
        int64_t written = rows * width[o];
        assert_memory_equal(out[o], again[o], (size_t)written * sizeof(double));
        for (int64_t i = written; i < 9 * OC_MAX; i++) assert_true(out[o][i] == CALM);
      }
    }
  close_world(&w);
}

/* --- odd particles
 * ---------------------------------------------------------------------------------- */

/* Two in one place: no force between them, no rate that is not finite, whatever the kernel. */
static void test_coincident(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int32_t type = 1; type <= OC_KERNELS; type++)
      for (int32_t isa = SPH_ISA_PORTABLE; isa <= SPH_ISA_AVX512; isa++) {
        if (!sph_isa_available(isa)) continue;
        static const double x[6] = {0.5, 0.5, 0.5, 0.5, 0.5, 0.5};
        world w = {0};
        sph_dissipation z;
        sph_neighbors_options o;
        sm_make(&set, dim, VARY, 3.0, 2);
        w.ctx = oc_context(isa, 1);
        w.kernel = oc_kernel(w.ctx, type, dim);
        sph_neighbors_options_init(&o);
        o.support = sph_kernel_support(w.kernel);
        o.h_rule = SPH_H_MAX;
        check_ok(sph_neighbors_create(w.ctx, &o, &w.list));
        sm_operands(&set, &w.a);
        w.a.n = 2;
        w.a.x = x;
        check_ok(sph_neighbors_build_arrays(w.list, dim, 2, x, w.a.h, 0.0));
        assert_int_equal(sph_neighbors_pairs(w.list), 2);
        sph_dissipation_init(&z);
        z.pairs = SPH_PAIRS_ALL;
        options = &z;
        for (int k = 0; k < OPERATORS; k++) {
          calm(out);
          check_ok(operators[k].run(&w, out));
          for (int f = 0; f < 4; f++)
            for (int i = 0; i < 2 * (f == 1 ? dim : f == 3 ? dim * dim : 1); i++) {
              assert_true(isfinite(out[f][i]));
              if (k >= 2) assert_true(out[f][i] == 0.0 || out[f][i] == CALM);
            }
        }
        options = NULL;
        sph_neighbors_destroy(w.list);
        sph_kernel_destroy(w.kernel);
        sph_context_destroy(w.ctx);
      }
}

/* One alone, and none at all. */
static void test_few(void **state) {
  (void)state;
  for (int64_t n = 0; n < 2; n++) {
    sm_make(&set, 2, VARY, 3.0, 2);
    set.s.n = n;
    world w = open_world(SPH_ISA_AUTO, 1);
    for (int k = 0; k < OPERATORS; k++) {
      calm(out);
      check_ok(operators[k].run(&w, out));
      assert_true(n > 0 || out[0][0] == CALM);
      if (n == 0 || k < 2) continue;
      assert_true(out[0][0] == 0.0 || out[0][0] == CALM);
      assert_true(out[1][0] == 0.0 && out[1][1] == 0.0 && out[2][0] == 0.0);
    }
    double self = set.s.m[0] * sph_kernel_w(w.kernel, 0.0, set.s.h[0]);
    if (n == 1) check_ok(run_density(&w, out));
    if (n == 1) check_rel(out[0][0], self, 1e-15);
    if (n == 1) check_ok(run_omega(&w, out)); /* 1 - (m / rho) W(0) */
    if (n == 1) check_rel(out[0][0], fmax(0.2, 1.0 - self / set.s.rho[0]), 1e-14);
    close_world(&w);
  }
}

/* NaN of one particle reaches its neighbours, and nobody else. */
static void test_nan(void **state) {
  (void)state;
  sm_make(&set, 2, VARY, 3.0, 3);
  world w = open_world(SPH_ISA_AUTO, 1);
  double *const arrays[] = {set.s.v, set.s.m, set.s.rho, set.s.p, set.s.c, set.e, set.s.sigma};
  const int64_t mid = set.s.n / 2;
  for (int k = 0; k < OPERATORS; k++)
    for (int f = 0; f < 7; f++) {
      const int64_t at = f == 0 ? 2 * mid : f == 6 ? 3 * mid : mid;
      const double before = arrays[f][at];
      calm(again);
      calm(out);
      check_ok(operators[k].run(&w, again));
      arrays[f][at] = NAN;
      check_ok(operators[k].run(&w, out));
      arrays[f][at] = before;
      for (int64_t i = 0; i < set.s.n; i++) {
        sm_pair q = sm_make_pair(&set, i, mid);
        const int near = i == mid || q.gi != 0.0 || q.gj != 0.0;
        if (!near) assert_true(memcmp(&out[0][i], &again[0][i], sizeof(double)) == 0);
        if (!near) assert_true(memcmp(&out[1][2 * i], &again[1][2 * i], 2 * sizeof(double)) == 0);
        if (!near) assert_true(memcmp(&out[2][i], &again[2][i], sizeof(double)) == 0);
      }
    }
  set.s.p[mid] = NAN;
  check_ok(run_pressure(&w, out));
  assert_true(isnan(out[1][2 * mid]) && isnan(out[2][mid]));
  close_world(&w);
}

/* Cold gas: no speed of sound, so no signal where b u is 0 too; what flows elsewhere is finite. */
static void test_cold(void **state) {
  (void)state;
  sph_dissipation z;
  for (int32_t isa = SPH_ISA_PORTABLE; isa <= SPH_ISA_AVX512; isa++) {
    if (!sph_isa_available(isa)) continue;
    sm_make(&set, 2, VARY, 3.0, 3);
    for (int64_t i = 0; i < set.s.n; i++) set.s.c[i] = 0.0;
    world w = open_world(isa, 1);
    sph_dissipation_init(&z);
    z.flux_limit = 0.0;
    options = &z;
    check_ok(run_dissipation(&w, out));
    for (int64_t i = 0; i < set.s.n; i++) assert_true(isfinite(out[0][i]) && out[0][i] != 0.0);
    z.mass_flux_b = 0.0;
    check_ok(run_dissipation(&w, out));
    for (int64_t i = 0; i < set.s.n; i++) assert_true(out[0][i] == 0.0);
    options = NULL;
    close_world(&w);
  }
}

/* --- bits
 * ------------------------------------------------------------------------------------------- */

static void test_threads(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int32_t isa = SPH_ISA_PORTABLE; isa <= SPH_ISA_AVX512; isa++) {
      if (!sph_isa_available(isa)) continue;
      oc_make(&set.s, dim, dim == 1 ? 2000 : dim == 2 ? 45 : 13, 1.0, VARY, 9);
      oc_fill(set.s.h, set.s.n, 0.5, 0.9, 1);
      oc_fill(set.e, set.s.n, 0.3, 2.0, 1);
      oc_fill(set.omega, set.s.n, 0.6, 1.3, 1);
      for (int k = 0; k < OPERATORS; k++)
        for (int32_t threads = 1; threads <= 4; threads *= 2) {
          double(*to)[9 * OC_MAX] = threads == 1 ? again : out;
          world w = open_world(isa, threads);
          calm(to);
          check_ok(operators[k].run(&w, to));
          if (threads > 1) assert_memory_equal(out, again, sizeof out);
          close_world(&w);
        }
    }
}

/* With equal masses, given as an array or as a number, mass and number smoothing have the same
 * bits.
 */
static void test_equal_masses(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) {
    sm_make(&set, dim, OC_VARY_H | OC_VARY_C, 3.0, 9);
    world w = open_world(SPH_ISA_AUTO, 1);
    for (int k = 0; k < 3; k++) {
      calm(out);
      smoothing = SPH_SMOOTHING_MASS;
      check_ok(operators[k].run(&w, out));
      smoothing = SPH_SMOOTHING_NUMBER;
      for (int uniform = 0; uniform < 2; uniform++) {
        calm(again);
        w.a.m = uniform ? NULL : set.s.m;
        w.a.m0 = set.s.m[0];
        check_ok(operators[k].run(&w, again));
        assert_memory_equal(out, again, sizeof out);
      }
      w.a.m = set.s.m;
    }
    close_world(&w);
  }
}

/* Uniform values in place of arrays. */
static void test_uniform(void **state) {
  (void)state;
  static const double one = 1.25;
  sm_make(&set, 2, 0, 3.0, 9);
  world w = open_world(SPH_ISA_AUTO, 1);
  double *const arrays[] = {set.s.m, set.s.rho, set.s.h, set.s.p, set.s.c, set.e, set.omega};
  for (int f = 0; f < 7; f++)
    for (int64_t i = 0; i < set.s.n; i++) arrays[f][i] = one;
  check_ok(sph_neighbors_build_arrays(w.list, 2, set.s.n, set.s.x, NULL, one));
  for (int k = 0; k < OPERATORS; k++) {
    sm_operands(&set, &w.a);
    calm(out);
    check_ok(operators[k].run(&w, out));
    w.a.m = w.a.rho = w.a.h = w.a.p = w.a.c = w.a.e = w.a.omega = NULL;
    w.a.m0 = w.a.rho0 = w.a.h0 = w.a.p0 = w.a.c0 = w.a.e0 = w.a.omega0 = one;
    calm(again);
    check_ok(operators[k].run(&w, again));
    assert_memory_equal(out, again, sizeof out);
  }
  close_world(&w);
}

/* --- memory
 * ------------------------------------------------------------------------------------------ */

/* Preparation cannot fail; each operator then runs twice, the second time with what it has. */
static sph_status scenario(sph_context *ctx, void *user) {
  const operator_row *op = (const operator_row *)user;
  world w = {.ctx = ctx};
  int64_t allocations;
  oom_pause();
  set.kernel = w.kernel = oc_kernel(ctx, SPH_KERNEL_GAUSSIAN, set.s.dim);
  w.list = sm_list(ctx, &set);
  sm_operands(&set, &w.a);
  calm(out);
  oom_resume();
  sph_status s = op->run(&w, out);
  oom_pause();
  for (int k = 0; s && k < 5; k++)
    for (int i = 0; i < 9 * OC_MAX; i++) assert_true(out[k][i] == CALM);
  allocations = oom.allocations;
  if (!s) check_ok(op->run(&w, out));
  assert_int_equal(oom.allocations, allocations);
  sph_neighbors_destroy(w.list);
  sph_kernel_destroy(w.kernel);
  oom_resume();
  return s;
}

static void test_memory(void **state) {
  (void)state;
  sm_make(&set, 2, VARY, 3.0, 9);
  for (int k = 0; k < OPERATORS; k++) oom_sweep(scenario, (void *)&operators[k]);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_missing),     cmocka_unit_test(test_numbers),
    cmocka_unit_test(test_options),     cmocka_unit_test(test_lists),
    cmocka_unit_test(test_each_output), cmocka_unit_test(test_rows),
    cmocka_unit_test(test_coincident),  cmocka_unit_test(test_few),
    cmocka_unit_test(test_nan),         cmocka_unit_test(test_cold),
    cmocka_unit_test(test_threads),     cmocka_unit_test(test_equal_masses),
    cmocka_unit_test(test_uniform),     cmocka_unit_test(test_memory)};
SPH_TEST_MAIN(tests)
