/* Integrators and the state they advance: failures, ghosts, threads, memory, save and restore. */
#include "integrate_help.h"
#include "oom.h"

#include <stdlib.h>

enum { N = 50 };
static const int32_t every_method[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};

/* A pendulum for each particle that misbehaves at a chosen call. */
typedef struct trap {
  int calls, at;
  int32_t answer; /* what it returns there */
  int what;       /* or: 1 NaN, 2 add a particle, 3 remove one, 4 sort, 5 step again */
  int ghosts;     /* remake so many ghosts at each call */
  sph_integrator *it;
} trap;

static int32_t misbehave(trap *p, double t, sph_particles *set, const sph_rate *rates) {
  static const int64_t seventh = 7;
  if (p->what == 1) rates[1].values[13] = NAN;
  if (p->what == 2) check_ok(sph_particles_add(set, 100000, NULL));
  if (p->what == 3) check_ok(sph_particles_remove(set, 1, &seventh));
  if (p->what == 4) check_ok(sph_particles_sort(set, 0.01, NULL));
  if (p->what == 5) return sph_integrator_step(p->it, set, t, 0.1, NULL);
  if (p->what == 6) return sph_integrator_bind_field(p->it, SPH_FIELD_E);
  if (p->what == 7) return sph_integrator_save(p->it, set);
  if (p->what == 8) return sph_integrator_restore(p->it, set);
  return p->answer;
}

static void remake_ghosts(trap *p, sph_particles *set) {
  check_ok(sph_particles_clear_ghosts(set));
  check_ok(sph_particles_add_ghosts(set, p->ghosts + 1000 * p->calls, NULL));
}

static int32_t trapped(void *user, double t, sph_particles *set, const sph_rate *rates,
                       int32_t count) {
  trap *p = (trap *)user;
  int32_t answer = pendulum(NULL, t, set, rates, count);
  if (p->ghosts) remake_ghosts(p, set);
  if (p->calls++ == p->at) answer = misbehave(p, t, set, rates);
  return answer;
}

static sph_integrator *bound(sph_context *ctx, int32_t method, sph_rhs_fn fn, void *user) {
  sph_integrator *it = make(ctx, method);
  check_ok(sph_integrator_bind_field(it, SPH_FIELD_X));
  check_ok(sph_integrator_bind_field(it, SPH_FIELD_V));
  check_ok(sph_integrator_bind_field(it, SPH_FIELD_RHO));
  check_ok(sph_integrator_set_function(it, fn, user));
  return it;
}

typedef struct snapshot {
  double x[2 * N], v[2 * N], rho[N];
} snapshot;

static snapshot take(const sph_particles *set) {
  snapshot s;
  memcpy(s.x, sph_particles_field_const(set, SPH_FIELD_X), sizeof s.x);
  memcpy(s.v, sph_particles_field_const(set, SPH_FIELD_V), sizeof s.v);
  memcpy(s.rho, sph_particles_field_const(set, SPH_FIELD_RHO), sizeof s.rho);
  return s;
}

static sph_particles *set_of(sph_context *ctx) {
  double *rho;
  sph_particles *set = make_set(ctx, 2, N);
  check_ok(sph_particles_field(set, SPH_FIELD_RHO, &rho));
  for (int i = 0; i < N; ++i) rho[i] = 1.0 + 0.01 * i;
  return set;
}

/* Fail at each evaluation in turn, in each method; the fields are as before, to the bit. */
static void check_failure(int32_t answer, int what, sph_status want, const char *sentence) {
  int last = what == 1 ? 1 : 4; /* a rate that weighs nothing in the end may be NaN */
  for (int m = 0; m < 10; ++m)
    for (int at = 0; at < last; ++at) {
      trap p = {0, at, answer, what, 0, NULL};
      sph_context *ctx = context_with(1);
      sph_particles *set = set_of(ctx);
      sph_integrator *it = p.it = bound(ctx, every_method[m], trapped, &p);
      snapshot before = take(set), after;
      uint64_t revision = sph_particles_revision(set, SPH_FIELD_X);
      sph_status status = sph_integrator_step(it, set, 0.0, 0.1, NULL);
      if (p.calls <= at) {
        check_ok(status); /* the method has fewer stages */
      } else {
        check_status(status, want);
        assert_non_null(strstr(sph_context_last_error(ctx), sentence));
        after = take(set);
        assert_memory_equal(&before, &after, sizeof before);
        assert_true(sph_particles_revision(set, SPH_FIELD_X) > revision);
        p.at = -1;
        check_ok(sph_integrator_step(it, set, 0.0, 0.05, NULL));
      }
      sph_integrator_destroy(it);
      sph_particles_destroy(set);
      sph_context_destroy(ctx);
    }
}

static void test_retry(void **state) {
  (void)state;
  check_failure(3, 0, SPH_RETRY, "smaller step");
}
static void test_host_failure(void **state) {
  (void)state;
  check_failure(-77, 0, SPH_ERR_CALLBACK, "-77");
}
static void test_library_failure(void **state) {
  (void)state;
  check_failure(SPH_ERR_STALE, 0, SPH_ERR_STALE, "SPH_ERR_STALE");
}
static void test_step_within_step(void **state) {
  (void)state;
  for (int what = 5; what <= 8; ++what) check_failure(0, what, SPH_ERR_STATE, "running");
}
static void test_particles_added(void **state) {
  (void)state;
  check_failure(0, 2, SPH_ERR_STATE, "real particles");
}

/* A NaN in the first rate, which PC2 sees through the second only. */
static void test_not_finite(void **state) {
  (void)state;
  check_failure(0, 1, SPH_ERR_NUMERIC, "particle 6");
}

static void test_not_finite_allowed(void **state) {
  trap p = {0, 0, 0, 1, 0, NULL};
  sph_context *ctx = context_with(1);
  sph_particles *set = set_of(ctx);
  sph_integrator_options o = method_options(SPH_INTEGRATOR_EULER);
  (void)state;
  o.check_finite = 0;
  sph_integrator *it = make_with(ctx, o);
  check_ok(sph_integrator_bind_field(it, SPH_FIELD_X));
  check_ok(sph_integrator_bind_field(it, SPH_FIELD_V));
  check_ok(sph_integrator_set_function(it, trapped, &p));
  check_ok(sph_integrator_step(it, set, 0.0, 0.1, NULL));
  assert_true(isnan(sph_particles_field_const(set, SPH_FIELD_V)[13]));
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

/* Removed or reordered particles cannot be put back; nothing else is written over them. */
static void test_particles_removed_or_sorted(void **state) {
  (void)state;
  for (int what = 3; what <= 4; ++what)
    for (int m = 0; m < 10; ++m) {
      trap p = {0, 0, 0, what, 0, NULL};
      sph_context *ctx = context_with(1);
      sph_particles *set = set_of(ctx);
      sph_integrator *it = bound(ctx, every_method[m], trapped, &p);
      check_status(sph_integrator_step(it, set, 0.0, 0.1, NULL), SPH_ERR_STATE);
      const double *rho = sph_particles_field_const(set, SPH_FIELD_RHO);
      for (int64_t i = 0; i < sph_particles_real_count(set); ++i)
        check_close(rho[i], 1.0 + 0.01 * (double)sph_particles_ids(set)[i], 0.0);
      check_ok(sph_integrator_step(it, set, 0.0, 0.1, NULL));
      sph_integrator_destroy(it);
      sph_particles_destroy(set);
      sph_context_destroy(ctx);
    }
}

/* Ghosts may come and go at each stage, and the arrays may move with them. */
static void test_ghosts_come_and_go(void **state) {
  (void)state;
  for (int m = 0; m < 10; ++m) {
    trap p = {0, -1, 0, 0, 0, NULL}, q = {0, -1, 0, 0, 10, NULL};
    sph_context *ctx = context_with(1);
    sph_particles *a = set_of(ctx), *b = set_of(ctx);
    sph_integrator *ia = bound(ctx, every_method[m], trapped, &p);
    sph_integrator *ib = bound(ctx, every_method[m], trapped, &q);
    for (int n = 0; n < 5; ++n) {
      check_ok(sph_integrator_step(ia, a, 0.1 * n, 0.1, NULL));
      check_ok(sph_integrator_step(ib, b, 0.1 * n, 0.1, NULL));
    }
    snapshot sa = take(a), sb = take(b);
    assert_memory_equal(&sa, &sb, sizeof sa);
    sph_integrator_destroy(ia);
    sph_integrator_destroy(ib);
    sph_particles_destroy(a);
    sph_particles_destroy(b);
    sph_context_destroy(ctx);
  }
}

/* ---- states of the handle ---------------------------------------------------------------- */

static void test_misuse(void **state) {
  sph_context *ctx = context_with(1);
  sph_particles *set = set_of(ctx);
  double a[4] = {0, 0, 0, 0};
  sph_integrator *it = make(ctx, SPH_INTEGRATOR_RK4);
  (void)state;
  check_status(sph_integrator_step(it, set, 0.0, 0.1, NULL), SPH_ERR_STATE);
  check_status(sph_integrator_save(it, set), SPH_ERR_STATE);
  check_ok(sph_integrator_bind_field(it, SPH_FIELD_X));
  check_status(sph_integrator_step(it, set, 0.0, 0.1, NULL), SPH_ERR_STATE);
  check_ok(sph_integrator_set_function(it, pendulum, NULL));
  check_status(sph_integrator_bind_field(it, SPH_FIELD_X), SPH_ERR_ARG);
  check_status(sph_integrator_bind_field(it, -1), SPH_ERR_ARG);
  check_status(sph_integrator_step(it, NULL, 0.0, 0.1, NULL), SPH_ERR_ARG);
  check_status(sph_integrator_step(it, set, 0.0, 0.0, NULL), SPH_ERR_ARG);
  check_status(sph_integrator_step(it, set, 0.0, NAN, NULL), SPH_ERR_ARG);
  check_status(sph_integrator_step(it, set, INFINITY, 0.1, NULL), SPH_ERR_ARG);
  check_status(sph_integrator_restore(it, set), SPH_ERR_STATE);
  check_ok(sph_integrator_bind_array(it, a, 2));
  check_status(sph_integrator_bind_array(it, a + 1, 2), SPH_ERR_ARG);
  check_status(sph_integrator_bind_array(it, a, 0), SPH_ERR_ARG);
  check_status(sph_integrator_bind_array(it, a + 2, -1), SPH_ERR_ARG);
  check_ok(sph_integrator_bind_array(it, a + 2, 2));
  check_ok(sph_integrator_bind_field(it, 99));
  check_status(sph_integrator_step(it, set, 0.0, 0.1, NULL), SPH_ERR_ARG);
  assert_non_null(strstr(sph_context_last_error(ctx), "99"));
  for (int32_t k = 4; k < 32; ++k) check_ok(sph_integrator_bind_field(it, 100 + k));
  check_status(sph_integrator_bind_field(it, 200), SPH_ERR_LIMIT);
  check_status(sph_integrator_bind_array(it, (double *)&set, 0), SPH_ERR_LIMIT);
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static void test_leapfrog_binding(void **state) {
  sph_context *ctx = context_with(1);
  sph_particles *set = set_of(ctx);
  double a = 0.0;
  sph_integrator *it = make(ctx, SPH_INTEGRATOR_LEAPFROG);
  (void)state;
  check_status(sph_integrator_bind_array(it, &a, 1), SPH_ERR_UNSUPPORTED);
  check_ok(sph_integrator_bind_field(it, SPH_FIELD_X));
  check_ok(sph_integrator_set_function(it, pendulum, NULL));
  check_status(sph_integrator_step(it, set, 0.0, 0.1, NULL), SPH_ERR_STATE);
  check_ok(sph_integrator_bind_field(it, SPH_FIELD_V));
  check_ok(sph_integrator_step(it, set, 0.0, 0.1, NULL));
  check_ok(sph_integrator_step(it, set, 0.0, -0.1, NULL));
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

/* Rates come in the order of binding, with their field, over the real particles; empty sets too. */
static int32_t look(void *user, double t, sph_particles *set, const sph_rate *rates,
                    int32_t count) {
  (void)t;
  assert_int_equal(count, 4);
  assert_int_equal(rates[0].field, -1);
  assert_int_equal(rates[1].field, SPH_FIELD_V);
  assert_int_equal(rates[2].field, -3);
  assert_int_equal(rates[3].field, SPH_FIELD_H);
  rates[0].values[0] = 1.0;
  rates[2].values[0] = rates[2].values[1] = 2.0;
  for (int64_t i = 0; i < sph_particles_real_count(set); ++i) {
    for (int a = 0; a < 3; ++a) rates[1].values[3 * i + a] = 3.0;
    rates[3].values[i] = 4.0;
  }
  ++*(int *)user;
  return 0;
}

static void test_rates_in_order(void **state) {
  (void)state;
  for (int64_t n = 0; n <= 5; n += 5) {
    sph_context *ctx = context_with(1);
    sph_particles *set = make_set(ctx, 3, n);
    double one[1] = {0}, two[3] = {0, 0, 7}, *v, *h;
    int calls = 0;
    sph_integrator *it = make(ctx, SPH_INTEGRATOR_RK4);
    check_ok(sph_integrator_bind_array(it, one, 1));
    check_ok(sph_integrator_bind_field(it, SPH_FIELD_V));
    check_ok(sph_integrator_bind_array(it, two, 2));
    check_ok(sph_integrator_bind_field(it, SPH_FIELD_H));
    check_ok(sph_integrator_set_function(it, look, &calls));
    check_ok(sph_particles_add_ghosts(set, 3, NULL));
    check_ok(sph_particles_field(set, SPH_FIELD_V, &v));
    memset(v, 0, (size_t)(n + 3) * 3 * sizeof *v);
    check_ok(sph_integrator_step(it, set, 0.0, 0.5, NULL));
    check_ok(sph_particles_field(set, SPH_FIELD_H, &h));
    assert_int_equal(calls, 4);
    check_close(one[0], 0.5, 1e-15);
    check_close(two[1], 1.0, 1e-15);
    check_close(two[2], 7.0, 0.0);
    for (int64_t i = 0; i < 3 * (n + 3); ++i) check_close(v[i], i < 3 * n ? 1.5 : 0.0, 1e-15);
    for (int64_t i = 0; i < n + 3; ++i) check_close(h[i], i < n ? 2.0 : 0.0, 1e-15);
    sph_integrator_destroy(it);
    sph_particles_destroy(set);
    sph_context_destroy(ctx);
  }
}

/* ---- the same bits ----------------------------------------------------------------------- */

/* A host's loop that cuts the range unevenly and backwards. */
static void odd_loop(void *user, int64_t count, int64_t grain, sph_loop_fn body, void *job) {
  int64_t end = count;
  (void)user;
  (void)grain;
  for (int64_t k = 1; end > 0; ++k) {
    int64_t begin = end > 37 * k ? end - 37 * k : 0;
    body(job, begin, end, (int32_t)(k % 3));
    end = begin;
  }
}

static sph_context *context_of_kind(int kind) {
  static const int32_t threads[] = {1, 2, 3, 8};
  sph_context_options o;
  sph_context *ctx = NULL;
  if (kind < 4) return context_with(threads[kind]);
  sph_context_options_init(&o);
  o.workers = 3;
  o.parallel_for = odd_loop;
  check_ok(sph_context_create(&o, &ctx));
  return ctx;
}

static void run_kind(int kind, int32_t method, int64_t n, double *out) {
  sph_context *ctx = context_of_kind(kind);
  sph_particles *set = make_set(ctx, 2, n);
  sph_integrator_options o = method_options(method);
  double drag = 3.0;
  sph_step_info info;
  sph_step_info_init(&info);
  info.want_error = 1;
  o.stability_check_interval = 2;
  o.stage_rule = SPH_STAGES_POWER;
  sph_integrator *it = make_with(ctx, o);
  check_ok(sph_integrator_bind_field(it, SPH_FIELD_X));
  check_ok(sph_integrator_bind_field(it, SPH_FIELD_V));
  check_ok(sph_integrator_set_function(it, pendulum, &drag));
  for (int k = 0; k < 4; ++k) check_ok(sph_integrator_step(it, set, 0.1 * k, 0.1, &info));
  memcpy(out, sph_particles_field_const(set, SPH_FIELD_X), (size_t)(2 * n) * sizeof *out);
  out[2 * n] = info.error;
  out[2 * n + 1] = info.radius;
  out[2 * n + 2] = info.eigen_re;
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
}

static void test_same_bits(void **state) {
  enum { MANY = 30011 };
  size_t bytes = (2 * MANY + 3) * sizeof(double);
  double *a = malloc(bytes), *b = malloc(bytes);
  (void)state;
  for (int m = 0; m < 10; ++m) {
    run_kind(0, every_method[m], MANY, a);
    for (int kind = 1; kind <= 4; ++kind) {
      run_kind(kind, every_method[m], MANY, b);
      assert_memory_equal(a, b, bytes);
    }
  }
  free(a);
  free(b);
}

/* ---- memory ------------------------------------------------------------------------------ */

static sph_integrator_options heavy(int32_t method) {
  sph_integrator_options o = method_options(method);
  o.stability_check_interval = 1;
  if (method == SPH_INTEGRATOR_RKC) o.stage_rule = SPH_STAGES_POWER;
  return o;
}

static void test_steady_step_allocates_nothing(void **state) {
  (void)state;
  for (int m = 0; m < 10; ++m) {
    sph_context *ctx = context_with(2);
    sph_particles *set = set_of(ctx);
    sph_step_info info;
    int64_t before = 0, after = 0;
    sph_step_info_init(&info);
    info.want_error = 1;
    sph_integrator *it = make_with(ctx, heavy(every_method[m]));
    check_ok(sph_integrator_bind_field(it, SPH_FIELD_X));
    check_ok(sph_integrator_bind_field(it, SPH_FIELD_V));
    check_ok(sph_integrator_set_function(it, pendulum, NULL));
    check_ok(sph_integrator_step(it, set, 0.0, 0.1, &info));
    check_ok(sph_integrator_save(it, set));
    check_ok(sph_context_memory(ctx, NULL, NULL, &before));
    for (int k = 0; k < 10; ++k) {
      check_ok(sph_integrator_save(it, set));
      check_ok(sph_integrator_step(it, set, 0.1 * k, 0.1, &info));
      check_ok(sph_integrator_restore(it, set));
    }
    check_ok(sph_context_memory(ctx, NULL, NULL, &after));
    assert_int_equal(before, after);
    sph_integrator_destroy(it);
    sph_particles_destroy(set);
    sph_context_destroy(ctx);
  }
}

static sph_status use_all(sph_integrator *it, double *y) {
  sph_status status = sph_integrator_bind_array(it, y, 3);
  if (status == SPH_OK) status = sph_integrator_set_function(it, smooth_system, y);
  if (status == SPH_OK) status = sph_integrator_save(it, NULL);
  if (status == SPH_OK) status = sph_integrator_step(it, NULL, 0.0, 0.01, NULL);
  if (status == SPH_OK) status = sph_integrator_restore(it, NULL);
  return status;
}

static sph_status memory_scenario(sph_context *ctx, void *user) {
  double y[3], start[3];
  sph_integrator *it = NULL;
  sph_integrator_options o = heavy(*(const int32_t *)user);
  smooth_solution(0.0, y);
  smooth_solution(0.0, start);
  if (o.method == SPH_INTEGRATOR_BUTCHER) {
    o.butcher_stages = 3;
    o.butcher_a = fehlberg_a;
    o.butcher_b = fehlberg_b;
  }
  sph_status status = sph_integrator_create(ctx, &o, &it);
  if (status != SPH_OK) assert_null(it);
  if (status == SPH_OK) status = use_all(it, y);
  assert_memory_equal(y, start, sizeof y);
  sph_integrator_destroy(it);
  return status;
}

static sph_status set_scenario(sph_context *ctx, void *user) {
  sph_particles *set = NULL;
  sph_integrator *it = NULL;
  sph_integrator_options o = heavy(*(const int32_t *)user);
  sph_status status = sph_particles_create(ctx, NULL, &set);
  if (status == SPH_OK) status = sph_particles_add(set, 4, NULL);
  if (status == SPH_OK) status = sph_integrator_create(ctx, &o, &it);
  if (status == SPH_OK) status = sph_integrator_bind_field(it, SPH_FIELD_X);
  if (status == SPH_OK) status = sph_integrator_bind_field(it, SPH_FIELD_V);
  if (status == SPH_OK) status = sph_integrator_set_function(it, pendulum, NULL);
  if (status == SPH_OK) status = sph_integrator_step(it, set, 0.0, 0.1, NULL);
  sph_integrator_destroy(it);
  sph_particles_destroy(set);
  return status;
}

static void test_no_memory(void **state) {
  static const int32_t leapfrog = SPH_INTEGRATOR_LEAPFROG;
  (void)state;
  for (int m = 0; m < 10; ++m)
    if (every_method[m] != leapfrog) oom_sweep(memory_scenario, (void *)&every_method[m]);
  oom_sweep(set_scenario, (void *)&leapfrog);
  oom_sweep(set_scenario, (void *)&every_method[8]);
  oom_sweep(set_scenario, (void *)&every_method[9]);
}

/* ---- save and restore -------------------------------------------------------------------- */

/* A repeated run has the same bits, although the power iteration has memory. */
static void test_repeat_after_restore(void **state) {
  (void)state;
  for (int m = 0; m < 10; ++m) {
    trap p = {0, -1, 0, 0, 0, NULL};
    sph_context *ctx = context_with(1);
    sph_particles *set = set_of(ctx);
    sph_integrator_options o = heavy(every_method[m]);
    o.power_interval = 3;
    o.power_iterations = 2; /* never settled: each estimate differs from the one before */
    sph_integrator *it = make_with(ctx, o);
    check_ok(sph_integrator_bind_field(it, SPH_FIELD_X));
    check_ok(sph_integrator_bind_field(it, SPH_FIELD_V));
    check_ok(sph_integrator_bind_field(it, SPH_FIELD_RHO));
    check_ok(sph_integrator_set_function(it, trapped, &p));
    for (int k = 0; k < 4; ++k) check_ok(sph_integrator_step(it, set, 0.1 * k, 0.1, NULL));
    check_ok(sph_integrator_save(it, set));
    for (int k = 4; k < 12; ++k) check_ok(sph_integrator_step(it, set, 0.1 * k, 0.1, NULL));
    snapshot first = take(set);
    for (int again = 0; again < 2; ++again) {
      check_ok(sph_integrator_restore(it, set));
      for (int k = 4; k < 12; ++k) check_ok(sph_integrator_step(it, set, 0.1 * k, 0.1, NULL));
      snapshot second = take(set);
      assert_memory_equal(&first, &second, sizeof first);
    }
    check_ok(sph_particles_add(set, 1, NULL));
    check_status(sph_integrator_restore(it, set), SPH_ERR_STATE);
    sph_integrator_destroy(it);
    sph_particles_destroy(set);
    sph_context_destroy(ctx);
  }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_retry),
    cmocka_unit_test(test_host_failure),
    cmocka_unit_test(test_library_failure),
    cmocka_unit_test(test_step_within_step),
    cmocka_unit_test(test_particles_added),
    cmocka_unit_test(test_not_finite),
    cmocka_unit_test(test_not_finite_allowed),
    cmocka_unit_test(test_particles_removed_or_sorted),
    cmocka_unit_test(test_ghosts_come_and_go),
    cmocka_unit_test(test_misuse),
    cmocka_unit_test(test_leapfrog_binding),
    cmocka_unit_test(test_rates_in_order),
    cmocka_unit_test(test_same_bits),
    cmocka_unit_test(test_steady_step_allocates_nothing),
    cmocka_unit_test(test_no_memory),
    cmocka_unit_test(test_repeat_after_restore),
};
SPH_TEST_MAIN(tests)
