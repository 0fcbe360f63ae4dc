/* The leapfrog with predicted values, and the filter that every method offers. */
#include "integrate_help.h"
#include "oom.h"

#include "integrate/integrate_impl.h"

#include <stdlib.h>

enum { PREDICTED = SPH_INTEGRATOR_LEAPFROG_PREDICTED };

static sph_integrator *with_fields(sph_context *ctx, int32_t method, sph_rhs_fn fn, void *user,
                                   int others) {
  sph_integrator *it = make(ctx, method);
  check_ok(sph_integrator_bind_field(it, SPH_FIELD_V));
  if (others) check_ok(sph_integrator_bind_field(it, SPH_FIELD_E));
  check_ok(sph_integrator_bind_field(it, SPH_FIELD_X));
  check_ok(sph_integrator_set_function(it, fn, user));
  return it;
}

static double *field(sph_particles *set, int32_t f) {
  double *y = NULL;
  check_ok(sph_particles_field(set, f, &y));
  return y;
}

/* Steps that vary by a factor of three, without a pattern. */
static double uneven(int n) { return 0.05 * (1.0 + 0.5 * sin(2.3 * n * n)); }

/* ---- the formulas ------------------------------------------------------------------------ */

/* Order 2 in everything, forces that depend on everything, XSPH, steps that alternate. */
static void test_order(void **state) {
  sph_context *ctx = context_with(1);
  (void)state;
  for (int others = 0; others < 2; ++others)
    for (int k = 0; k < 3; ++k) {
      double exact[3], a[3], b[3];
      run_tangle(ctx, SPH_INTEGRATOR_RK4, others, 4000, 0.0, exact);
      run_tangle(ctx, PREDICTED, others, 400, 0.4 * k, a);
      run_tangle(ctx, PREDICTED, others, 800, 0.4 * k, b);
      for (int m = 0; m < 2 + others; ++m)
        check_close(log2(fabs(a[m] - exact[m]) / fabs(b[m] - exact[m])), 2.0, 0.15);
    }
  sph_context_destroy(ctx);
}

/* The recursion as the source writes it, in the test's own words. */
static void test_as_written(void **state) {
  sph_context *ctx = context_with(1);
  sph_particles *set = make_set(ctx, 1, 1);
  double *x = field(set, SPH_FIELD_X), *v = field(set, SPH_FIELD_V), drag = 0.3, last = 0.0, t = 0;
  sph_integrator *it = with_fields(ctx, PREDICTED, pendulum, &drag, 0);
  double xs = x[0], vs = v[0], half = 0.0;
  sph_step_info info;
  (void)state;
  sph_step_info_init(&info);
  for (int n = 0; n < 500; ++n) {
    double dt = uneven(n), f = -sin(xs) - drag * vs;
    half = n == 0 ? vs + f * dt / 2 : half + f * (last + dt) / 2;
    xs += half * dt;
    vs = half + f * dt / 2;
    check_ok(sph_integrator_step(it, set, t, dt, &info));
    check_close(x[0], xs, 1e-14);
    check_close(v[0], vs, 1e-14);
    t += last = dt;
  }
  assert_int_equal(info.stages, 1);
  assert_int_equal(info.evaluations, 1);
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static int32_t constant_force(void *user, double t, sph_particles *set, const sph_rate *rates,
                              int32_t count) {
  (void)user;
  (void)t;
  for (int32_t k = 0; k < count; ++k)
    for (int64_t i = 0; i < 2 * sph_particles_real_count(set); ++i)
      rates[k].values[i] =
          rates[k].field == SPH_FIELD_V ? -2.0 : sph_particles_field_const(set, SPH_FIELD_V)[i];
  return 0;
}

/* A parabola is exact, whatever the steps: the start and the means of the steps are right. */
static void test_constant_force(void **state) {
  sph_context *ctx = context_with(1);
  sph_particles *set = make_set(ctx, 2, 10);
  sph_integrator *it = with_fields(ctx, PREDICTED, constant_force, NULL, 0);
  double *x = field(set, SPH_FIELD_X), *v = field(set, SPH_FIELD_V), x0[20], v0[20], t = 0.0;
  (void)state;
  memcpy(x0, x, sizeof x0);
  memcpy(v0, v, sizeof v0);
  for (int n = 0; n < 100; ++n) {
    check_ok(sph_integrator_step(it, set, t, uneven(n), NULL));
    t += uneven(n);
  }
  for (int i = 0; i < 20; ++i) {
    check_close(x[i], x0[i] + v0[i] * t - t * t, 1e-12);
    check_close(v[i], v0[i] - 2.0 * t, 1e-13);
  }
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

/* ---- the oscillator ---------------------------------------------------------------------- */

static int32_t oscillator(void *user, double t, sph_particles *set, const sph_rate *rates,
                          int32_t count) {
  const double *x = sph_particles_field_const(set, SPH_FIELD_X);
  const double *v = sph_particles_field_const(set, SPH_FIELD_V);
  (void)user;
  (void)t;
  for (int32_t k = 0; k < count; ++k)
    rates[k].values[0] = rates[k].field == SPH_FIELD_V ? -x[0] : v[0];
  return 0;
}

static int32_t watch_half(void *user, double t, sph_particles *set, int32_t copy,
                          const sph_rate *values, int32_t count) {
  (void)t;
  (void)set;
  (void)count;
  if (copy == SPH_COPY_HALF) *(double *)user = values[0].values[0];
  return 0;
}

/* v^(k-1/2) v^(k+1/2) + omega^2 x^2 is kept exactly by a leapfrog with equal steps. Energy of the
 * predicted values then neither grows nor exceeds O(dt): ten thousand periods. */
static void test_oscillator(void **state) {
  sph_context *ctx = context_with(1);
  sph_particles *set = make_set(ctx, 1, 1);
  sph_integrator *it = with_fields(ctx, PREDICTED, oscillator, NULL, 0);
  double *x = field(set, SPH_FIELD_X), *v = field(set, SPH_FIELD_V), half = 0.0, kept = 0.0;
  double low[2] = {1.0, 1.0}, high[2] = {0.0, 0.0};
  const int steps = check_long_run ? 1000000 : 100000;
  (void)state;
  x[0] = 1.0;
  v[0] = 0.0;
  check_ok(sph_integrator_set_filter(it, watch_half, &half));
  for (int n = 0; n < steps; ++n) {
    double before = half, at = x[0], energy = 0.5 * (x[0] * x[0] + v[0] * v[0]);
    check_ok(sph_integrator_step(it, set, 0.1 * n, 0.1, NULL));
    if (n == 1) kept = before * half + at * at;
    if (n > 1) check_close(before * half + at * at, kept, 1e-10);
    low[2 * n >= steps] = fmin(low[2 * n >= steps], energy);
    high[2 * n >= steps] = fmax(high[2 * n >= steps], energy);
  }
  check_close(low[0], low[1], 1e-5);
  check_close(high[0], high[1], 1e-5);
  assert_true(high[0] - low[0] < 0.06 && high[0] - low[0] > 1e-4);
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

/* A wave between V and E, and a decay: Adams and Bashforth's formula. */
static int32_t wave(void *user, double t, sph_particles *set, const sph_rate *rates,
                    int32_t count) {
  double v = sph_particles_field_const(set, SPH_FIELD_V)[0];
  double e = sph_particles_field_const(set, SPH_FIELD_E)[0];
  double decay = *(const double *)user;
  (void)t;
  for (int32_t k = 0; k < count; ++k)
    rates[k].values[0] = rates[k].field == SPH_FIELD_E   ? v - decay * e
                         : rates[k].field == SPH_FIELD_V ? -e - decay * v
                                                         : v;
  return 0;
}

static double growth(sph_context *ctx, double decay, double dt, int steps) {
  sph_particles *set = make_set(ctx, 1, 1);
  sph_integrator *it = with_fields(ctx, PREDICTED, wave, &decay, 1);
  double *v = field(set, SPH_FIELD_V), *e = field(set, SPH_FIELD_E), middle = 0.0;
  v[0] = 1.0;
  e[0] = 0.0;
  for (int n = 0; n < steps; ++n) {
    check_ok(sph_integrator_step(it, set, dt * n, dt, NULL));
    if (2 * n == steps) middle = hypot(v[0], e[0]);
  }
  double factor = pow(hypot(v[0], e[0]) / middle, 2.0 / (steps - 2));
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  return factor;
}

/* Larger root of rho^2 - (1 + 3 z/2) rho + z/2 = 0 for z = i y, by Newton from e^z. */
static double ab2_growth(double y) {
  double re = cos(y), im = sin(y);
  for (int n = 0; n < 50; ++n) { /* rho <- rho - p / p' */
    double pr = re * re - im * im - re + 1.5 * y * im, pi = 2.0 * re * im - im - 1.5 * y * re;
    double dr = 2.0 * re - 1.0, di = 2.0 * im - 1.5 * y;
    pi += 0.5 * y;
    double size = dr * dr + di * di;
    re -= (pr * dr + pi * di) / size;
    im -= (pi * dr - pr * di) / size;
  }
  return hypot(re, im);
}

static void test_growth_of_waves(void **state) {
  sph_context *ctx = context_with(1);
  (void)state;
  for (double y = 0.1; y < 0.45; y += 0.1) {
    check_close(growth(ctx, 0.0, y, 4000), ab2_growth(y), 1e-8);
    check_rel(ab2_growth(y) - 1.0, pow(y, 4) / 4.0, 4.0 * y * y);
  }
  assert_true(growth(ctx, 300.0, 0.99 / 300.0, 2000) < 1.0);
  assert_true(growth(ctx, 300.0, 1.01 / 300.0, 2000) > 1.0);
  sph_context_destroy(ctx);
}

/* Where the force depends on X alone, omega dt < 2; and a step back undoes a step. */
static double oscillate(sph_context *ctx, double dt, int steps) {
  sph_particles *set = make_set(ctx, 1, 1);
  sph_integrator *it = with_fields(ctx, PREDICTED, oscillator, NULL, 0);
  double largest = 0.0, *x = field(set, SPH_FIELD_X);
  for (int n = 0; n < steps; ++n) {
    check_ok(sph_integrator_step(it, set, n * dt, dt, NULL));
    largest = fmax(largest, fabs(x[0]));
  }
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  return largest;
}

static void test_stability(void **state) {
  sph_context *ctx = context_with(1);
  (void)state;
  assert_true(oscillate(ctx, 1.99, 10000) < 50.0);
  assert_true(oscillate(ctx, 2.01, 500) > 1e10);
  sph_context_destroy(ctx);
}

static void test_step_back(void **state) {
  sph_context *ctx = context_with(1);
  sph_particles *set = make_set(ctx, 2, 20);
  sph_integrator *it = with_fields(ctx, PREDICTED, pendulum, NULL, 0);
  double x0[40], v0[40], *x = field(set, SPH_FIELD_X), *v = field(set, SPH_FIELD_V);
  (void)state;
  memcpy(x0, x, sizeof x0);
  memcpy(v0, v, sizeof v0);
  for (int n = 0; n < 500; ++n) check_ok(sph_integrator_step(it, set, 0.1 * n, 0.1, NULL));
  assert_true(fabs(x[0] - x0[0]) > 1e-3);
  for (int n = 500; n > 0; --n) check_ok(sph_integrator_step(it, set, 0.1 * n, -0.1, NULL));
  for (int i = 0; i < 40; ++i) {
    check_close(x[i], x0[i], 1e-11);
    check_close(v[i], v0[i], 0.1); /* predicted by the force one step on */
  }
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

/* ---- memory from step to step ------------------------------------------------------------ */

enum { N = 40, DIM = 2 };

typedef struct track {
  double x[DIM * N], v[DIM * N], e[N];
} track;

static track take(const sph_particles *set) {
  track s;
  memset(&s, 0, sizeof s);
  for (int64_t i = 0; i < sph_particles_real_count(set); ++i) {
    int64_t id = sph_particles_ids(set)[i];
    if (id >= N) continue;
    memcpy(s.x + DIM * id, sph_particles_field_const(set, SPH_FIELD_X) + DIM * i, DIM * 8);
    memcpy(s.v + DIM * id, sph_particles_field_const(set, SPH_FIELD_V) + DIM * i, DIM * 8);
    s.e[id] = sph_particles_field_const(set, SPH_FIELD_E)[i];
  }
  return s;
}

/* Every particle for itself: what others do shows nowhere. */
static int32_t alone(void *user, double t, sph_particles *set, const sph_rate *rates,
                     int32_t count) {
  int32_t *answer = (int32_t *)user;
  for (int32_t k = 0; k < count; ++k) {
    const double *y = sph_particles_field_const(set, rates[k].field);
    const double *x = sph_particles_field_const(set, SPH_FIELD_X);
    const double *v = sph_particles_field_const(set, SPH_FIELD_V);
    int64_t n = sph_particles_real_count(set);
    int32_t parts = sph_particles_components(set, rates[k].field);
    for (int64_t i = 0; i < n * parts; ++i)
      rates[k].values[i] = rates[k].field == SPH_FIELD_X   ? v[i]
                           : rates[k].field == SPH_FIELD_V ? -sin(x[i]) - 0.2 * v[i]
                                                           : cos(t) * y[i] - v[DIM * i];
  }
  return answer ? *answer : 0;
}

static void steps_of(sph_integrator *it, sph_particles *set, int from, int to) {
  for (int n = from; n < to; ++n) check_ok(sph_integrator_step(it, set, 0.1 * n, uneven(n), NULL));
}

static void fill_e(sph_particles *set) {
  double *e = field(set, SPH_FIELD_E);
  for (int i = 0; i < N; ++i) e[i] = 1.0 + 0.1 * i;
}

static track undisturbed(sph_context *ctx, int steps) {
  sph_particles *set = make_set(ctx, DIM, N);
  sph_integrator *it = with_fields(ctx, PREDICTED, alone, NULL, 1);
  fill_e(set);
  steps_of(it, set, 0, steps);
  track s = take(set);
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  return s;
}

/* Particles come, go and change places; each goes on as if alone, to the bit. */
static void test_changing_counts(void **state) {
  sph_context *ctx = context_with(1);
  sph_particles *set = make_set(ctx, DIM, N);
  sph_integrator *it = with_fields(ctx, PREDICTED, alone, NULL, 1);
  static const int64_t gone[] = {0, 17, N + 2};
  track want = undisturbed(ctx, 20);
  (void)state;
  fill_e(set);
  steps_of(it, set, 0, 5);
  check_ok(sph_particles_add(set, 1000, NULL));
  steps_of(it, set, 5, 8);
  check_ok(sph_particles_sort(set, 0.05, NULL));
  steps_of(it, set, 8, 12);
  check_ok(sph_particles_remove(set, 3, gone));
  steps_of(it, set, 12, 20);
  track got = take(set);
  int missing = 0;
  for (int id = 0; id < N; ++id) {
    if (got.x[DIM * id] == 0.0) {
      ++missing;
      continue;
    }
    assert_memory_equal(got.x + DIM * id, want.x + DIM * id, DIM * 8);
    assert_memory_equal(got.v + DIM * id, want.v + DIM * id, DIM * 8);
    check_close(got.e[id], want.e[id], 0.0);
  }
  assert_true(missing <= 3);
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

/* A particle that comes late starts with a half step, like the first of all. */
static void test_late_comer(void **state) {
  sph_context *ctx = context_with(1);
  sph_particles *set = make_set(ctx, DIM, N), *one = make_set(ctx, DIM, 1);
  sph_integrator *it = with_fields(ctx, PREDICTED, alone, NULL, 1);
  sph_integrator *single = with_fields(ctx, PREDICTED, alone, NULL, 1);
  (void)state;
  fill_e(set);
  steps_of(it, set, 0, 7);
  check_ok(sph_particles_add(set, 1, NULL));
  field(one, SPH_FIELD_E)[0] = field(set, SPH_FIELD_E)[N] = 2.5;
  for (int a = 0; a < DIM; ++a) {
    field(set, SPH_FIELD_X)[DIM * N + a] = field(one, SPH_FIELD_X)[a];
    field(set, SPH_FIELD_V)[DIM * N + a] = field(one, SPH_FIELD_V)[a];
  }
  steps_of(it, set, 7, 15);
  steps_of(single, one, 7, 15);
  for (int a = 0; a < DIM; ++a)
    check_close(field(set, SPH_FIELD_V)[DIM * N + a], field(one, SPH_FIELD_V)[a], 0.0);
  check_close(field(set, SPH_FIELD_E)[N], field(one, SPH_FIELD_E)[0], 0.0);
  sph_integrator_destroy(it);
  sph_integrator_destroy(single);
  sph_particles_destroy(set);
  sph_particles_destroy(one);
  sph_context_destroy(ctx);
}

typedef struct gate {
  int32_t at, answer; /* copy at which to answer so */
} gate;

static int32_t gated(void *user, double t, sph_particles *set, int32_t copy, const sph_rate *values,
                     int32_t count) {
  const gate *g = (const gate *)user;
  (void)t;
  (void)set;
  (void)values;
  (void)count;
  return copy == g->at ? g->answer : 0;
}

/* Steps given up, by the right-hand side or by the filter at either copy, leave no trace. */
static void test_given_up(void **state) {
  sph_context *ctx = context_with(1);
  sph_particles *set = make_set(ctx, DIM, N);
  int32_t answer = 0;
  sph_integrator *it = with_fields(ctx, PREDICTED, alone, &answer, 1);
  track want = undisturbed(ctx, 12);
  (void)state;
  fill_e(set);
  for (int n = 0; n < 12; ++n) {
    gate g = {1 + n % 3, n % 2 ? 1 : -5};
    check_ok(sph_integrator_set_filter(it, gated, &g));
    answer = n % 3 == 0 ? 2 : 0;
    track before = take(set);
    sph_status want_status = n % 3 == 0 || n % 2 ? SPH_RETRY : SPH_ERR_CALLBACK;
    check_status(sph_integrator_step(it, set, 0.1 * n, 0.7, NULL), want_status);
    assert_non_null(strstr(sph_context_last_error(ctx), n % 3 ? "the filter" : "the right-hand"));
    track after = take(set);
    assert_memory_equal(&before, &after, sizeof after);
    answer = 0;
    check_ok(sph_integrator_set_filter(it, NULL, NULL));
    check_ok(sph_integrator_step(it, set, 0.1 * n, uneven(n), NULL));
  }
  track got = take(set);
  assert_memory_equal(&got, &want, sizeof got);
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

/* Restarted, or given another set: as if new, to the bit. */
static void test_restart(void **state) {
  sph_context *ctx = context_with(1);
  (void)state;
  for (int other = 0; other < 2; ++other) {
    sph_particles *set = make_set(ctx, DIM, N), *second = make_set(ctx, DIM, N);
    sph_integrator *it = with_fields(ctx, PREDICTED, alone, NULL, 1);
    track want = undisturbed(ctx, 6);
    fill_e(set);
    fill_e(second);
    steps_of(it, set, 0, 9);
    if (!other) {
      check_ok(sph_integrator_restart(it));
      memcpy(field(set, SPH_FIELD_X), field(second, SPH_FIELD_X), sizeof want.x);
      memcpy(field(set, SPH_FIELD_V), field(second, SPH_FIELD_V), sizeof want.v);
      fill_e(set);
    }
    steps_of(it, other ? second : set, 0, 6);
    track got = take(other ? second : set);
    assert_memory_equal(&got, &want, sizeof got);
    sph_integrator_destroy(it);
    sph_particles_destroy(set);
    sph_particles_destroy(second);
  }
  sph_context_destroy(ctx);
}

/* What a host adds to V between steps moves X from the next step on. */
static void test_push(void **state) {
  sph_context *ctx = context_with(1);
  sph_particles *set = make_set(ctx, 2, 10);
  sph_integrator *it = with_fields(ctx, PREDICTED, constant_force, NULL, 0);
  double *x = field(set, SPH_FIELD_X), *v = field(set, SPH_FIELD_V), x0[20], v0[20];
  (void)state;
  for (int n = 0; n < 4; ++n) check_ok(sph_integrator_step(it, set, 0.0, 0.25, NULL));
  for (int i = 0; i < 20; ++i) v[i] += 3.0;
  memcpy(x0, x, sizeof x0);
  memcpy(v0, v, sizeof v0);
  for (int n = 0; n < 4; ++n) check_ok(sph_integrator_step(it, set, 0.0, 0.25, NULL));
  for (int i = 0; i < 20; ++i) check_close(x[i], x0[i] + v0[i] - 1.0, 1e-14);
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

/* X moves by V; without X, V need not be bound, and plain arrays are taken. */
static void test_binding(void **state) {
  sph_context *ctx = context_with(1);
  sph_particles *set = make_set(ctx, 1, 3);
  double y[3];
  (void)state;
  sph_integrator *it = make(ctx, PREDICTED);
  check_ok(sph_integrator_bind_field(it, SPH_FIELD_X));
  check_ok(sph_integrator_set_function(it, pendulum, NULL));
  check_status(sph_integrator_step(it, set, 0.0, 0.1, NULL), SPH_ERR_STATE);
  assert_non_null(strstr(sph_context_last_error(ctx), "field V"));
  sph_integrator_destroy(it);
  it = make(ctx, PREDICTED);
  smooth_solution(0.0, y);
  check_ok(sph_integrator_bind_array(it, y, 3));
  check_ok(sph_integrator_set_function(it, smooth_system, y));
  for (int n = 0; n < 2000; ++n) check_ok(sph_integrator_step(it, NULL, n * 1e-3, 1e-3, NULL));
  double exact[3];
  smooth_solution(2.0, exact);
  for (int k = 0; k < 3; ++k) check_close(y[k], exact[k], 2e-5);
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

/* Allocations refused while the history moves to other particles. */
static sph_status moving_scenario(sph_context *ctx, void *user) {
  sph_particles *set = NULL;
  sph_integrator *it = NULL;
  sph_integrator_options o = method_options(PREDICTED);
  (void)user;
  sph_status status = sph_particles_create(ctx, NULL, &set);
  if (status == SPH_OK) status = sph_particles_add(set, 4, NULL);
  if (status == SPH_OK) status = sph_integrator_create(ctx, &o, &it);
  if (status == SPH_OK) status = sph_integrator_bind_field(it, SPH_FIELD_X);
  if (status == SPH_OK) status = sph_integrator_bind_field(it, SPH_FIELD_V);
  if (status == SPH_OK) status = sph_integrator_set_function(it, pendulum, NULL);
  for (int n = 0; n < 3 && status == SPH_OK; ++n) {
    status = sph_integrator_step(it, set, 0.0, 0.1, NULL);
    if (status == SPH_OK) status = sph_particles_add(set, 50, NULL);
  }
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  return status;
}

static void test_no_memory(void **state) {
  (void)state;
  oom_sweep(moving_scenario, NULL);
}

/* ---- filters ----------------------------------------------------------------------------- */

typedef struct seen {
  int count[4]; /* by copy */
  double last_t;
  int32_t order[2];
} seen;

static int32_t look(void *user, double t, sph_particles *set, int32_t copy, const sph_rate *values,
                    int32_t count) {
  seen *s = (seen *)user;
  s->count[copy] += 1;
  s->last_t = t;
  assert_int_equal(count, 3);
  assert_int_equal(values[0].field, SPH_FIELD_V);
  assert_int_equal(values[2].field, SPH_FIELD_X);
  if (copy == SPH_COPY_HALF) {
    assert_null(values[2].values);
    assert_true(values[0].values != sph_particles_field_const(set, SPH_FIELD_V));
  } else {
    for (int k = 0; k < 3; ++k)
      assert_ptr_equal(values[k].values, sph_particles_field_const(set, values[k].field));
  }
  return 0;
}

/* Each method: one copy a stage after the first, one result at the end; a filter that looks on
 * changes no bit. */
static void test_filter_looks_on(void **state) {
  static const int stages[] = {0, 0, 1, 1, 2, 3, 3, 2, 2, 2, 0};
  (void)state;
  for (int32_t m = 1; m <= 10; ++m) {
    seen s = {{0, 0, 0, 0}, 0.0, {0, 0}};
    sph_context *ctx = context_with(1);
    sph_particles *a = make_set(ctx, DIM, N), *b = make_set(ctx, DIM, N);
    sph_integrator *ia = with_fields(ctx, m, alone, NULL, 1);
    sph_integrator *ib = with_fields(ctx, m, alone, NULL, 1);
    fill_e(a);
    fill_e(b);
    check_ok(sph_integrator_set_filter(ib, look, &s));
    for (int n = 0; n < 5; ++n) {
      check_ok(sph_integrator_step(ia, a, 0.1 * n, 0.1, NULL));
      check_ok(sph_integrator_step(ib, b, 0.1 * n, 0.1, NULL));
      check_close(s.last_t, 0.1 * n + 0.1, 1e-15);
    }
    track ta = take(a), tb = take(b);
    assert_memory_equal(&ta, &tb, sizeof ta);
    assert_int_equal(s.count[SPH_COPY_STAGE], 5 * stages[m]);
    assert_int_equal(s.count[SPH_COPY_HALF], m == PREDICTED ? 5 : 0);
    assert_int_equal(s.count[SPH_COPY_RESULT], 5);
    sph_integrator_destroy(ia);
    sph_integrator_destroy(ib);
    sph_particles_destroy(a);
    sph_particles_destroy(b);
    sph_context_destroy(ctx);
  }
}

/* Perfect plasticity: E is a stress that V loads at the constant rate 1, with the bound 0.5. */
static int32_t load(void *user, double t, sph_particles *set, const sph_rate *rates,
                    int32_t count) {
  (void)user;
  (void)t;
  assert_true(fabs(sph_particles_field_const(set, SPH_FIELD_E)[0]) <= 0.5);
  for (int32_t k = 0; k < count; ++k)
    rates[k].values[0] = rates[k].field == SPH_FIELD_E   ? 1.0
                         : rates[k].field == SPH_FIELD_V ? -sph_particles_field_const(set, 7)[0]
                                                         : 0.0;
  return 0;
}

static int32_t yield(void *user, double t, sph_particles *set, int32_t copy, const sph_rate *values,
                     int32_t count) {
  (void)t;
  (void)set;
  for (int32_t k = 0; k < count; ++k)
    if (values[k].field == SPH_FIELD_E && fabs(values[k].values[0]) > 0.5) {
      values[k].values[0] = copysign(0.5, values[k].values[0]);
      *(int *)user |= 1 << copy;
    }
  return 0;
}

static void test_filter_returns(void **state) {
  (void)state;
  assert_int_equal(SPH_FIELD_E, 7);
  for (int32_t m = 1; m <= 10; ++m) {
    int treated = 0;
    sph_context *ctx = context_with(1);
    sph_particles *set = make_set(ctx, 1, 1);
    sph_integrator *it = with_fields(ctx, m, load, NULL, 1);
    double *v = field(set, SPH_FIELD_V), *e = field(set, SPH_FIELD_E);
    v[0] = 0.0;
    check_ok(sph_integrator_set_filter(it, yield, &treated));
    for (int n = 0; n < 100; ++n) check_ok(sph_integrator_step(it, set, 0.01 * n, 0.01, NULL));
    check_close(e[0], 0.5, 0.0);
    /* int_0^1 min(t, 1/2) dt = 3/8; order 1 at the kink */
    check_close(v[0], -0.375, m == SPH_INTEGRATOR_EULER ? 3e-3 : 2e-4);
    assert_true(treated & 1 << SPH_COPY_RESULT);
    if (m == PREDICTED) assert_true(treated & 1 << SPH_COPY_HALF);
    sph_integrator_destroy(it);
    sph_particles_destroy(set);
    sph_context_destroy(ctx);
  }
}

/* Refusals at each copy: the fields are as before. */
static void test_filter_refuses(void **state) {
  (void)state;
  for (int32_t m = 1; m <= 10; ++m)
    for (int32_t copy = 1; copy <= 3; ++copy) {
      gate g = {copy, SPH_ERR_NUMERIC};
      sph_context *ctx = context_with(1);
      sph_particles *set = make_set(ctx, DIM, N);
      sph_integrator *it = with_fields(ctx, m, alone, NULL, 1);
      fill_e(set);
      check_ok(sph_integrator_set_filter(it, gated, &g));
      track before = take(set);
      sph_status status = sph_integrator_step(it, set, 0.0, 0.1, NULL);
      if (status != SPH_OK) {
        check_status(status, SPH_ERR_NUMERIC);
        assert_non_null(strstr(sph_context_last_error(ctx), "the filter answered"));
        track after = take(set);
        assert_memory_equal(&before, &after, sizeof after);
      } else {
        assert_true(copy == SPH_COPY_HALF ? m != PREDICTED : copy == SPH_COPY_STAGE);
      }
      sph_integrator_destroy(it);
      sph_particles_destroy(set);
      sph_context_destroy(ctx);
    }
}

static int32_t meddle(void *user, double t, sph_particles *set, int32_t copy,
                      const sph_rate *values, int32_t count) {
  sph_integrator *it = *(sph_integrator **)user;
  (void)t;
  (void)set;
  (void)copy;
  (void)values;
  (void)count;
  check_status(sph_integrator_set_filter(it, NULL, NULL), SPH_ERR_STATE);
  return sph_integrator_restart(it);
}

static void test_filter_meddles(void **state) {
  sph_context *ctx = context_with(1);
  sph_particles *set = make_set(ctx, DIM, N);
  sph_integrator *it = with_fields(ctx, PREDICTED, alone, NULL, 1);
  (void)state;
  check_ok(sph_integrator_set_filter(it, meddle, &it));
  check_status(sph_integrator_step(it, set, 0.0, 0.1, NULL), SPH_ERR_STATE);
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_order),           cmocka_unit_test(test_as_written),
    cmocka_unit_test(test_constant_force),  cmocka_unit_test(test_oscillator),
    cmocka_unit_test(test_growth_of_waves), cmocka_unit_test(test_stability),
    cmocka_unit_test(test_step_back),       cmocka_unit_test(test_changing_counts),
    cmocka_unit_test(test_late_comer),      cmocka_unit_test(test_given_up),
    cmocka_unit_test(test_restart),         cmocka_unit_test(test_push),
    cmocka_unit_test(test_binding),         cmocka_unit_test(test_no_memory),
    cmocka_unit_test(test_filter_looks_on), cmocka_unit_test(test_filter_returns),
    cmocka_unit_test(test_filter_refuses),  cmocka_unit_test(test_filter_meddles),
};
SPH_TEST_MAIN(tests)
