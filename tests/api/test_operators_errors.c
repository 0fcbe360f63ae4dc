/* Operators with bad input, without memory, in a steady loop. */
#include "../oom.h"
#include "../operator_cases.h"

static oc_particles set;
static double out[18 * OC_MAX];

enum { MARK = 77 };

static void mark_outputs(void) {
  for (int k = 0; k < 18 * OC_MAX; k++) out[k] = MARK;
}

static void expect_untouched(void) {
  for (int k = 0; k < 18 * OC_MAX; k++)
    if (out[k] != MARK) fail_msg("output %d was written: %g", k, out[k]);
}

typedef struct bench {
  sph_context *ctx;
  sph_kernel *kernel;
  sph_neighbors *list;
  sph_operands a;
} bench;

static bench begin(int32_t dim) {
  bench b;
  b.ctx = oc_context(SPH_ISA_AUTO, 1);
  b.kernel = oc_kernel(b.ctx, SPH_KERNEL_CUBIC_SPLINE, dim);
  oc_make(&set, dim, 5, 1.2, OC_VARY_H | OC_VARY_M, (uint64_t)dim);
  b.list = oc_list(b.ctx, &set, b.kernel, SPH_H_ARITHMETIC);
  oc_operands(&set, 1, &b.a);
  mark_outputs();
  return b;
}

static void end(bench *b) {
  sph_neighbors_destroy(b->list);
  sph_kernel_destroy(b->kernel);
  sph_context_destroy(b->ctx);
}

/* Every operator answers `want`, writes nothing and, with words, says them. */
static void all_refuse(const bench *b, const oc_call *call, sph_status want, const char *words) {
  for (int k = 0; k < OC_CASES; k++) {
    const oc_case *op = &oc_cases[k];
    sph_status got = op->run(call, op);
    if (got != want)
      fail_msg("%s form %d: %s, expected %s", op->name, (int)op->form, sph_status_name(got),
               sph_status_name(want));
    if (words && strstr(sph_context_last_error(b->ctx), words) == NULL)
      fail_msg("%s: \"%s\" is not in \"%s\"", op->name, words, sph_context_last_error(b->ctx));
    expect_untouched();
  }
}

/* sph_<operator>: every sentence starts with the name of the function. */
static const char *name_of(const oc_case *op) {
  static const char *const names[][2] = {
      {"density", "sph_density_summation"},  {"shepard", "sph_shepard_sum"},
      {"matrix", "sph_gradient_matrix"},     {"stress", "sph_stress_divergence"},
      {"pressure", "sph_pressure_gradient"}, {"monaghan", "sph_viscosity_monaghan"},
      {"bulk", "sph_viscosity_bulk"}};
  for (size_t k = 0; k < sizeof names / sizeof *names; k++)
    if (strncmp(op->name, names[k][0], strlen(names[k][0])) == 0) return names[k][1];
  return op->name;
}

static void test_handles(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) {
    bench b = begin(dim);
    const oc_call good = oc_call_of(b.list, b.kernel, &b.a, &set, out);
    oc_call call = good;
    call.list = NULL;
    all_refuse(&b, &call, SPH_ERR_ARG, NULL);
    call.list = (sph_neighbors *)(void *)b.kernel;
    all_refuse(&b, &call, SPH_ERR_HANDLE, NULL);
    call = good;
    call.kernel = NULL;
    all_refuse(&b, &call, SPH_ERR_ARG, "kernel");
    call.kernel = (const sph_kernel *)(const void *)b.list;
    all_refuse(&b, &call, SPH_ERR_HANDLE, "kernel");
    call.kernel = (const sph_kernel *)(const void *)b.ctx;
    all_refuse(&b, &call, SPH_ERR_HANDLE, "kernel");
    call = good;
    call.a = NULL;
    all_refuse(&b, &call, SPH_ERR_ARG, "operands");
    end(&b);
  }
}

static void test_no_output(void **state) {
  (void)state;
  bench b = begin(2);
  for (int k = 0; k < OC_CASES; k++) {
    if (strcmp(oc_cases[k].name, "matrix") == 0 || strcmp(oc_cases[k].name, "bulk_q") == 0)
      continue; /* there the output under test may be NULL */
    oc_call call = oc_call_of(b.list, b.kernel, &b.a, &set, NULL);
    check_status(oc_cases[k].run(&call, &oc_cases[k]), SPH_ERR_ARG);
    assert_non_null(strstr(sph_context_last_error(b.ctx), name_of(&oc_cases[k])));
    assert_non_null(strstr(sph_context_last_error(b.ctx), "output"));
  }
  check_status(sph_gradient_matrix(b.list, b.kernel, &b.a, NULL, out, NULL), SPH_ERR_ARG);
  expect_untouched();
  sph_bulk_viscosity o = oc_bulk(15);
  check_status(sph_viscosity_bulk(b.list, b.kernel, &b.a, &o, out, NULL), SPH_ERR_ARG);
  expect_untouched();
  end(&b);
}

static void test_sizes(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) {
    bench b = begin(dim);
    sph_kernel *other = oc_kernel(b.ctx, SPH_KERNEL_CUBIC_SPLINE, dim % 3 + 1);
    sph_kernel *wide = oc_kernel(b.ctx, SPH_KERNEL_QUINTIC_SPLINE, dim);
    sph_operands a = b.a;
    const oc_call good = oc_call_of(b.list, b.kernel, &a, &set, out);
    oc_call call = good;
    call.kernel = other;
    all_refuse(&b, &call, SPH_ERR_ARG, "-D");
    const int32_t dims[] = {0, -1, 4, INT32_MAX};
    for (int k = 0; k < 4; k++) {
      a.dim = dims[k];
      all_refuse(&b, &good, SPH_ERR_ARG, "-D");
    }
    /* kernel and operands agree, the list is of another dimension */
    a.dim = dim % 3 + 1;
    all_refuse(&b, &call, SPH_ERR_ARG, "list");
    a = b.a;
    call.kernel = wide; /* reaches 3 h, the list 2 h */
    all_refuse(&b, &call, SPH_ERR_ARG, "3 h");
    const int64_t counts[] = {0, -1, 4, set.n + 1, INT64_MAX, INT64_MIN};
    for (int k = 0; k < 6; k++) {
      a.n = counts[k];
      all_refuse(&b, &good, SPH_ERR_ARG, NULL);
    }
    a.n = set.n;
    const int64_t rows[] = {-2, set.n + 1, INT64_MAX, INT64_MIN};
    for (int k = 0; k < 4; k++) {
      a.rows = rows[k];
      all_refuse(&b, &good, SPH_ERR_ARG, "rows");
    }
    a = b.a;
    a.size = 0;
    all_refuse(&b, &good, SPH_ERR_ARG, "size");
    a.size = (size_t)1 << 20;
    all_refuse(&b, &good, SPH_ERR_ARG, "size");
    sph_kernel_destroy(other);
    sph_kernel_destroy(wide);
    end(&b);
  }
}

/* Operands of a newer host: unknown zero bytes are fine, others are not. */
static void test_newer_operands(void **state) {
  (void)state;
  bench b = begin(2);
  struct {
    sph_operands a;
    unsigned char tail[32];
  } newer;
  sph_operands_init_sized(&newer.a, sizeof newer);
  assert_int_equal(newer.a.size, sizeof newer);
  for (int k = 0; k < 32; k++) assert_int_equal(newer.tail[k], 0);
  memcpy(&newer.a, &b.a, sizeof b.a);
  newer.a.size = sizeof newer;
  newer.tail[31] = 1;
  oc_call call = oc_call_of(b.list, b.kernel, &newer.a, &set, out);
  all_refuse(&b, &call, SPH_ERR_VERSION, NULL);
  newer.tail[31] = 0;
  for (int k = 0; k < OC_CASES; k++) check_ok(oc_cases[k].run(&call, &oc_cases[k]));
  /* an older host, which knows no matrix */
  sph_operands older = b.a;
  static double plain[9 * OC_MAX];
  older.size = offsetof(sph_operands, gradient_matrix);
  b.a.gradient_matrix = NULL;
  check_ok(sph_velocity_gradient(b.list, b.kernel, &b.a, plain));
  check_ok(sph_velocity_gradient(b.list, b.kernel, &older, out));
  assert_memory_equal(out, plain, (size_t)(set.n * 4) * sizeof *out);
  sph_operands_init_sized(NULL, 100);
  sph_bulk_viscosity_init_sized(NULL, 100);
  end(&b);
}

/* Take away one array (and its uniform value): who needs it says so, the others do not notice. */
static void test_missing_arrays(void **state) {
  (void)state;
  static const struct {
    char letter;
    const char *words;
  } arrays[] = {{'x', "x is NULL"},     {'h', "h is NULL"},      {'m', "m is NULL"},
                {'r', "rho is NULL"},   {'v', "v is NULL"},      {'c', "c is NULL"},
                {'s', "sigma is NULL"}, {'b', "gradient_matrix"}};
  for (int32_t dim = 1; dim <= 3; dim++) {
    bench b = begin(dim);
    for (size_t m = 0; m < sizeof arrays / sizeof *arrays; m++)
      for (int k = 0; k < OC_CASES; k++) {
        const oc_case *op = &oc_cases[k];
        sph_operands a = b.a;
        oc_call call = oc_call_of(b.list, b.kernel, &a, &set, out);
        switch (arrays[m].letter) {
        case 'x':
          a.x = NULL;
          break;
        case 'h':
          a.h = NULL;
          break;
        case 'm':
          a.m = NULL;
          break;
        case 'r':
          a.rho = NULL;
          break;
        case 'v':
          a.v = NULL;
          break;
        case 'c':
          a.c = NULL;
          break;
        case 's':
          a.sigma = NULL;
          break;
        default:
          a.gradient_matrix = NULL;
        }
        mark_outputs();
        if (!strchr(op->needs, arrays[m].letter)) {
          check_ok(op->run(&call, op));
          continue;
        }
        sph_status got = op->run(&call, op);
        const char *said = sph_context_last_error(b.ctx);
        if (got != SPH_ERR_ARG || !strstr(said, arrays[m].words) || !strstr(said, name_of(op)))
          fail_msg("%s form %d without %c: %s \"%s\"", op->name, (int)op->form, arrays[m].letter,
                   sph_status_name(got), said);
        expect_untouched();
        /* uniform values that cannot be */
        const double bad[] = {-1.0, NAN, INFINITY};
        for (int q = 0; q < 3 && strchr("hmrc", arrays[m].letter); q++) {
          a.h0 = a.m0 = a.rho0 = a.c0 = bad[q];
          check_status(op->run(&call, op), SPH_ERR_ARG);
          expect_untouched();
        }
      }
    end(&b);
  }
}

static void test_forms(void **state) {
  (void)state;
  bench b = begin(2);
  const int32_t forms[] = {0, -1, 5, INT32_MAX, INT32_MIN};
  for (int k = 0; k < 5; k++) {
    char said[32];
    snprintf(said, sizeof said, "%d", (int)forms[k]);
    check_status(sph_continuity(b.list, b.kernel, &b.a, forms[k], out), SPH_ERR_ARG);
    assert_non_null(strstr(sph_context_last_error(b.ctx), said));
    check_status(sph_gradient(b.list, b.kernel, &b.a, forms[k], 1, set.f, out), SPH_ERR_ARG);
    assert_non_null(strstr(sph_context_last_error(b.ctx), said));
    check_status(sph_stress_divergence(b.list, b.kernel, &b.a, forms[k], out), SPH_ERR_ARG);
    assert_non_null(strstr(sph_context_last_error(b.ctx), said));
    check_status(sph_pressure_gradient(b.list, b.kernel, &b.a, forms[k], out), SPH_ERR_ARG);
    assert_non_null(strstr(sph_context_last_error(b.ctx), said));
  }
  check_status(sph_continuity(b.list, b.kernel, &b.a, 4, out), SPH_ERR_ARG);
  check_status(sph_stress_divergence(b.list, b.kernel, &b.a, 4, out), SPH_ERR_ARG);
  expect_untouched();
  end(&b);
}

static void test_fields_and_points(void **state) {
  (void)state;
  bench b = begin(2);
  const int32_t widths[] = {0, -1, INT32_MIN};
  for (int k = 0; k < 3; k++) {
    int32_t w = widths[k];
    check_status(sph_gradient(b.list, b.kernel, &b.a, 2, w, set.f, out), SPH_ERR_ARG);
    check_status(sph_interpolate(b.list, b.kernel, &b.a, 0, w, set.f, out), SPH_ERR_ARG);
    check_status(sph_interpolate_at(b.list, b.kernel, &b.a, 0, 4, set.points, w, set.f, out),
                 SPH_ERR_ARG);
    assert_non_null(strstr(sph_context_last_error(b.ctx), "components"));
  }
  check_status(sph_gradient(b.list, b.kernel, &b.a, 2, 1, NULL, out), SPH_ERR_ARG);
  check_status(sph_interpolate(b.list, b.kernel, &b.a, 0, 1, NULL, out), SPH_ERR_ARG);
  check_status(sph_interpolate_at(b.list, b.kernel, &b.a, 0, 4, set.points, 1, NULL, out),
               SPH_ERR_ARG);
  assert_non_null(strstr(sph_context_last_error(b.ctx), "f is NULL"));
  check_status(sph_interpolate_at(b.list, b.kernel, &b.a, 0, 4, NULL, 1, set.f, out), SPH_ERR_ARG);
  assert_non_null(strstr(sph_context_last_error(b.ctx), "points is NULL"));
  check_status(sph_interpolate_at(b.list, b.kernel, &b.a, 0, -1, set.points, 1, set.f, out),
               SPH_ERR_ARG);
  const double bad[] = {NAN, INFINITY, -INFINITY};
  for (int k = 0; k < 3; k++) {
    set.points[5] = bad[k];
    check_status(sph_interpolate_at(b.list, b.kernel, &b.a, 0, 4, set.points, 1, set.f, out),
                 SPH_ERR_ARG);
    assert_non_null(strstr(sph_context_last_error(b.ctx), "point 2"));
    check_ok(sph_interpolate_at(b.list, b.kernel, &b.a, 0, 0, set.points, 1, set.f, out));
    check_ok(sph_interpolate_at(b.list, b.kernel, &b.a, 0, 0, NULL, 1, set.f, out));
  }
  expect_untouched();
  end(&b);
}

static void test_coefficients(void **state) {
  (void)state;
  bench b = begin(2);
  const double bad[] = {NAN, INFINITY, -INFINITY};
  check_status(sph_viscosity_bulk(b.list, b.kernel, &b.a, NULL, NULL, out), SPH_ERR_ARG);
  for (int k = 0; k < 3; k++) {
    check_status(sph_viscosity_monaghan(b.list, b.kernel, &b.a, bad[k], 1.0, out), SPH_ERR_ARG);
    check_status(sph_viscosity_monaghan(b.list, b.kernel, &b.a, 1.0, bad[k], out), SPH_ERR_ARG);
    check_status(sph_xsph(b.list, b.kernel, &b.a, bad[k], out), SPH_ERR_ARG);
    for (int m = 0; m < 5; m++) {
      sph_bulk_viscosity o = oc_bulk(15);
      *(m == 0   ? &o.neumann
        : m == 1 ? &o.linear
        : m == 2 ? &o.spacing
        : m == 3 ? &o.hk_alpha
                 : &o.hk_beta) = bad[k];
      check_status(sph_viscosity_bulk(b.list, b.kernel, &b.a, &o, NULL, out), SPH_ERR_ARG);
    }
  }
  sph_bulk_viscosity o = oc_bulk(3);
  o.spacing = 0.0;
  check_status(sph_viscosity_bulk(b.list, b.kernel, &b.a, &o, NULL, out), SPH_ERR_ARG);
  assert_non_null(strstr(sph_context_last_error(b.ctx), "spacing"));
  o = oc_bulk(15);
  o.size = 3;
  check_status(sph_viscosity_bulk(b.list, b.kernel, &b.a, &o, NULL, out), SPH_ERR_ARG);
  expect_untouched();
  o = oc_bulk(12); /* without the first two no spacing is needed */
  o.spacing = 0.0;
  check_ok(sph_viscosity_bulk(b.list, b.kernel, &b.a, &o, NULL, out));
  end(&b);
}

static void test_list_states(void **state) {
  (void)state;
  bench b = begin(3);
  sph_neighbors *fresh = NULL;
  check_ok(sph_neighbors_create(b.ctx, NULL, &fresh));
  oc_call call = oc_call_of(fresh, b.kernel, &b.a, &set, out);
  all_refuse(&b, &call, SPH_ERR_STATE, "built");
  sph_neighbors_destroy(fresh);
  end(&b);
}

/* The arrays of the operands moved after the build. */
static void test_stale(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) {
    bench b = begin(dim);
    oc_call call = oc_call_of(b.list, b.kernel, &b.a, &set, out);
    set.x[0] += 0.4; /* in place: a list without a skin allows nothing */
    all_refuse(&b, &call, SPH_ERR_STALE, NULL);
    end(&b);
  }
}

static void test_empty(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) {
    bench b = begin(dim);
    sph_operands a;
    check_ok(sph_neighbors_build_arrays(b.list, dim, 0, NULL, NULL, 1.0));
    sph_operands_init(&a);
    a.dim = dim;
    for (int filled = 0; filled < 2; filled++) {
      for (int k = 0; k < OC_CASES; k++) {
        oc_call call = oc_call_of(b.list, b.kernel, &a, &set, out);
        if ((oc_cases[k].flags & OC_NEEDS_MATRIX) && !filled) continue;
        check_ok(oc_cases[k].run(&call, &oc_cases[k]));
        if (!(oc_cases[k].flags & OC_AT_POINTS)) expect_untouched();
        for (int64_t i = 0; i < oc_length(&oc_cases[k], dim, 0); i++) assert_true(out[i] == 0.0);
        mark_outputs();
      }
      a = b.a;
      a.n = 0;
    }
    end(&b);
  }
}

/* A NaN in an input stays where it is felt: no crash, rows out of reach are as before. */
static void test_nan_input(void **state) {
  (void)state;
  static double before[18 * OC_MAX];
  bench b = begin(1);
  for (int k = 0; k < OC_CASES; k++) {
    oc_call call = oc_call_of(b.list, b.kernel, &b.a, &set, out);
    if (oc_cases[k].flags & OC_AT_POINTS) continue;
    check_ok(oc_cases[k].run(&call, &oc_cases[k]));
    memcpy(before, out, sizeof out);
    oc_particles *s = &set;
    double *arrays[] = {s->v, s->rho, s->p, s->c, s->sigma, s->f};
    double kept[6];
    for (int m = 0; m < 6; m++) {
      kept[m] = arrays[m][0];
      arrays[m][0] = NAN;
    }
    check_ok(oc_cases[k].run(&call, &oc_cases[k]));
    for (int m = 0; m < 6; m++) arrays[m][0] = kept[m];
    if (oc_length(&oc_cases[k], 1, set.n) == set.n && s->x[set.n - 1] - s->x[0] > 3.0)
      assert_true(out[set.n - 1] == before[set.n - 1]);
  }
  end(&b);
}

static void test_operands_from_set(void **state) {
  (void)state;
  sph_context *ctx = oc_context(SPH_ISA_AUTO, 1);
  sph_particles_options o;
  sph_particles *particles = NULL;
  sph_operands a;
  double *field = NULL;
  sph_particles_options_init(&o);
  o.dim = 2;
  check_ok(sph_particles_create(ctx, &o, &particles));
  check_ok(sph_particles_add(particles, 7, NULL));
  check_ok(sph_particles_add_ghosts(particles, 2, NULL));
  memset(&a, 0xaa, sizeof a);
  check_ok(sph_operands_from_set(particles, &a));
  assert_int_equal(a.size, sizeof a);
  assert_int_equal(a.dim, 2);
  assert_int_equal(a.n, 9);
  assert_int_equal(a.rows, 7);
  check_ok(sph_particles_field(particles, SPH_FIELD_X, &field));
  assert_ptr_equal(a.x, field);
  assert_null(a.v);
  assert_null(a.m);
  assert_null(a.sigma);
  assert_null(a.gradient_matrix);
  assert_true(a.m0 == 0.0 && a.h0 == 0.0);
  const int32_t ids[] = {SPH_FIELD_V, SPH_FIELD_M, SPH_FIELD_RHO,  SPH_FIELD_H,
                         SPH_FIELD_P, SPH_FIELD_C, SPH_FIELD_SIGMA};
  double *fields[7];
  for (int k = 0; k < 7; k++) check_ok(sph_particles_field(particles, ids[k], &fields[k]));
  check_ok(sph_operands_from_set(particles, &a));
  const double *got[7] = {a.v, a.m, a.rho, a.h, a.p, a.c, a.sigma};
  for (int k = 0; k < 7; k++) assert_ptr_equal(got[k], fields[k]);
  check_status(sph_operands_from_set(NULL, &a), SPH_ERR_ARG);
  check_status(sph_operands_from_set(particles, NULL), SPH_ERR_ARG);
  check_status(sph_operands_from_set((sph_particles *)(void *)ctx, &a), SPH_ERR_HANDLE);
  assert_ptr_equal(a.sigma, fields[6]);
  sph_particles_destroy(particles);
  sph_context_destroy(ctx);
}

/* --- memory ------------------------------------------------------------------------------------
 */

/* One operator on a fresh list, so that every buffer is still to come. */
static sph_status memory_scenario(sph_context *ctx, void *user) {
  const oc_case *op = (const oc_case *)user;
  sph_operands a;
  oom_pause();
  sph_kernel *kernel = oc_kernel(ctx, SPH_KERNEL_CUBIC_SPLINE, set.dim);
  sph_neighbors *list = oc_list(ctx, &set, kernel, SPH_H_ARITHMETIC);
  oc_operands(&set, 1, &a);
  mark_outputs();
  oom_resume();
  oc_call call = oc_call_of(list, kernel, &a, &set, out);
  sph_status status = op->run(&call, op);
  oom_pause();
  if (status != SPH_OK) expect_untouched();
  if (status != SPH_OK) check_ok(op->run(&call, op)); /* and it works when memory is back */
  oom_resume();
  sph_neighbors_destroy(list);
  sph_kernel_destroy(kernel);
  return status;
}

static void test_out_of_memory(void **state) {
  (void)state;
  oc_make(&set, 2, 5, 1.2, OC_VARY_H | OC_VARY_M, 1);
  for (int k = 0; k < OC_CASES; k++) {
    oc_case op = oc_cases[k];
    oom_sweep(memory_scenario, &op);
  }
}

static sph_status inverse_scenario(sph_context *ctx, void *user) {
  (void)user;
  sph_operands a;
  oom_pause();
  sph_kernel *kernel = oc_kernel(ctx, SPH_KERNEL_CUBIC_SPLINE, set.dim);
  sph_neighbors *list = oc_list(ctx, &set, kernel, SPH_H_ARITHMETIC);
  oc_operands(&set, 0, &a);
  mark_outputs();
  oom_resume();
  int64_t fallbacks = MARK;
  sph_status status = sph_gradient_matrix(list, kernel, &a, out, out + 9 * OC_MAX, &fallbacks);
  oom_pause();
  if (status != SPH_OK) expect_untouched();
  if (status != SPH_OK) assert_int_equal(fallbacks, MARK);
  oom_resume();
  sph_neighbors_destroy(list);
  sph_kernel_destroy(kernel);
  return status;
}

static void test_matrix_out_of_memory(void **state) {
  (void)state;
  oc_make(&set, 2, 5, 1.2, 0, 1);
  oom_sweep(inverse_scenario, NULL);
}

/* Called again with the same sizes, an operator takes no memory; points are no part of a step. */
static void test_steady(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int corrected = 0; corrected < 2; corrected++) {
      bench b = begin(dim);
      if (!corrected) b.a.gradient_matrix = NULL;
      for (int round = 0; round < 2; round++)
        for (int k = 0; k < OC_CASES; k++) {
          const oc_case *op = &oc_cases[k];
          int64_t before = 0, after = 0;
          oc_call call = oc_call_of(b.list, b.kernel, &b.a, &set, out);
          if ((op->flags & OC_NEEDS_MATRIX) && !corrected) continue;
          if (op->flags & OC_AT_POINTS) continue;
          check_ok(sph_context_memory(b.ctx, NULL, NULL, &before));
          check_ok(op->run(&call, op));
          check_ok(sph_context_memory(b.ctx, NULL, NULL, &after));
          if (round > 0 && after != before)
            fail_msg("%s form %d, %d-D: %d allocations when repeated", op->name, (int)op->form,
                     (int)dim, (int)(after - before));
        }
      end(&b);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_handles),
    cmocka_unit_test(test_no_output),
    cmocka_unit_test(test_sizes),
    cmocka_unit_test(test_newer_operands),
    cmocka_unit_test(test_missing_arrays),
    cmocka_unit_test(test_forms),
    cmocka_unit_test(test_fields_and_points),
    cmocka_unit_test(test_coefficients),
    cmocka_unit_test(test_list_states),
    cmocka_unit_test(test_empty),
    cmocka_unit_test(test_nan_input),
    cmocka_unit_test(test_operands_from_set),
    cmocka_unit_test(test_out_of_memory),
    cmocka_unit_test(test_matrix_out_of_memory),
    cmocka_unit_test(test_stale),
    cmocka_unit_test(test_steady),
};
SPH_TEST_MAIN(tests)
