/* Every public function with empty sets, single particles, ghosts alone, values that are not
 * finite, and objects of another dimension. */
#include "../everywhere.h"

/* --- few particles ----------------------------------------------------------------------- */

static void run_all(int32_t dim, int64_t n, int64_t rows) {
  for (int k = 0; k < EW_ENTRIES; k++) {
    const ew_entry *e = &ew_entries[k];
    sph_context *ctx = rh_context(1);
    everywhere *w = ew_open(ctx, dim, n, rows);
    sph_status s = e->call(w), want = SPH_OK;
    if ((e->call == ew_cfl || e->call == ew_signal) && rows == 0)
      want = SPH_ERR_NUMERIC; /* no step is the largest */
    if (s != want)
      fail_msg("%s, %d-D, %d particles, %d real: %s: %s", e->name, (int)dim, (int)n, (int)rows,
               sph_status_name(s), sph_context_last_error(ctx));
    for (int j = 0; s == SPH_OK && j < EW_OUT; j++)
      if (!isfinite(w->out[j]))
        fail_msg("%s, %d-D, %d particles: out[%d] = %g", e->name, (int)dim, (int)n, j, w->out[j]);
    ew_close(w);
    sph_context_destroy(ctx);
  }
}

static void test_empty(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) run_all(dim, 0, 0);
}
static void test_single(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) run_all(dim, 1, 1);
}
static void test_ghosts_alone(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) run_all(dim, 5, 0);
}

/* --- a particle that is not finite ------------------------------------------------------- */

enum { SIDE = 12, PLANE = SIDE * SIDE };

/* Rows further than two supports from `sick` have the bits that they had without it. */
static void expect_local(const everywhere *w, const double *healthy, int64_t sick,
                         const ew_entry *e, int32_t field) {
  int64_t per = 0;
  for (int64_t k = 0; k < EW_OUT && healthy[k] != -7.0; k++) per = k + 1;
  per /= w->n;
  assert_true(per >= 1);
  for (int64_t i = 0; i < w->n; i++) {
    double dx = w->points[2 * i] - w->points[2 * sick];
    double dy = w->points[2 * i + 1] - w->points[2 * sick + 1];
    if (dx * dx + dy * dy < 6.0 * 6.0) continue; /* two supports of h = 1.5 */
    if (memcmp(w->out + i * per, healthy + i * per, (size_t)per * sizeof(double)) != 0)
      fail_msg("%s: field %d of particle %d spoils particle %d", e->name, (int)field, (int)sick,
               (int)i);
  }
}

static void spoil(everywhere *w, int32_t field, int64_t particle, double value) {
  double *a;
  check_ok(sph_particles_field(w->set, field, &a));
  a[particle * sph_particles_components(w->set, field)] = value;
}

/* v, m, rho, p, c, sigma pass through, and spoil nobody out of reach; x and h are refused by the
 * list, which no longer holds. */
static void sick_particle(const ew_entry *e, int32_t field, double value) {
  sph_context *ctx = rh_context(1);
  everywhere *w = ew_open(ctx, 2, PLANE, PLANE);
  check_ok(e->call(w));
  double *healthy = (double *)malloc(sizeof w->out);
  assert_non_null(healthy);
  memcpy(healthy, w->out, sizeof w->out);
  spoil(w, field, 17, value);
  sph_status s = e->call(w);
  int geometry = field == SPH_FIELD_X || field == SPH_FIELD_H;
  if (geometry && e->call != ew_artificial) {
    check_status(s, SPH_ERR_STALE);
    assert_memory_equal(w->out, healthy, sizeof w->out);
  } else {
    check_ok(s);
    expect_local(w, healthy, 17, e, field);
  }
  free(healthy);
  ew_close(w);
  sph_context_destroy(ctx);
}

static void test_sick_particle(void **state) {
  (void)state;
  static const int32_t fields[] = {SPH_FIELD_X, SPH_FIELD_V, SPH_FIELD_M, SPH_FIELD_RHO,
                                   SPH_FIELD_H, SPH_FIELD_P, SPH_FIELD_C, SPH_FIELD_SIGMA};
  static const double values[] = {NAN, INFINITY, -INFINITY};
  for (int k = 0; k < EW_ENTRIES; k++)
    for (size_t f = 0; f < sizeof fields / sizeof *fields; f++)
      for (size_t v = 0; v < sizeof values / sizeof *values; v++)
        if (ew_entries[k].flags & EW_PAIRS) sick_particle(&ew_entries[k], fields[f], values[v]);
}

/* What looks at the whole set names the particle, and changes nothing. */
static void refuse_sick(ew_call call, int32_t field, sph_status want) {
  static const double values[] = {NAN, INFINITY, -INFINITY};
  for (size_t v = 0; v < sizeof values / sizeof *values; v++) {
    sph_context *ctx = rh_context(1);
    everywhere *w = ew_open(ctx, 2, PLANE, PLANE);
    spoil(w, field, 17, values[v]);
    check_ok(sph_particles_touch(w->set, field));
    uint64_t before = ew_set_state(w, 0), list = ew_list_state(w);
    check_status(call(w), want);
    if (!strstr(sph_context_last_error(ctx), "17"))
      fail_msg("not named: %s", sph_context_last_error(ctx));
    assert_true(before == ew_set_state(w, 0));
    assert_true(list == ew_list_state(w));
    ew_close(w);
    sph_context_destroy(ctx);
  }
}

static void test_refused_sets(void **state) {
  (void)state;
  refuse_sick(ew_sort, SPH_FIELD_X, SPH_ERR_ARG);
  refuse_sick(ew_build, SPH_FIELD_X, SPH_ERR_ARG);
  refuse_sick(ew_build, SPH_FIELD_H, SPH_ERR_ARG);
  refuse_sick(ew_update, SPH_FIELD_X, SPH_ERR_ARG);
  refuse_sick(ew_update, SPH_FIELD_H, SPH_ERR_ARG);
  refuse_sick(ew_build_arrays, SPH_FIELD_X, SPH_ERR_ARG);
  refuse_sick(ew_update_arrays, SPH_FIELD_X, SPH_ERR_ARG);
  refuse_sick(ew_evaluate, SPH_FIELD_X, SPH_ERR_ARG);
  refuse_sick(ew_evaluate, SPH_FIELD_H, SPH_ERR_ARG);
  refuse_sick(ew_cfl, SPH_FIELD_H, SPH_ERR_NUMERIC);
  refuse_sick(ew_cfl, SPH_FIELD_C, SPH_ERR_NUMERIC);
  refuse_sick(ew_cfl, SPH_FIELD_V, SPH_ERR_NUMERIC);
  refuse_sick(ew_signal, SPH_FIELD_C, SPH_ERR_NUMERIC);
  refuse_sick(ew_signal, SPH_FIELD_V, SPH_ERR_NUMERIC);
}

/* --- numbers that are not finite --------------------------------------------------------- */

/* Calls with one number x: SPH_ERR_ARG for NaN and both infinities, and a sentence. */
#define NUMBER_CALLS(X)                                                                  \
  X(sort, sph_particles_sort(w->set, x, NULL))                                           \
  X(callback, sph_kernel_create_callback(w->ctx, 1, x, ew_profile, NULL, &kernel))       \
  X(table, sph_kernel_create_table(w->ctx, 1, x, 4, w->points, w->points, 1, &kernel))   \
  X(kernel_h, sph_kernel_evaluate(w->kernel, 1, w->points, x, w->out, NULL, NULL, NULL)) \
  X(build_h0, sph_neighbors_build_arrays(w->list, 2, w->n, w->a.x, NULL, x))             \
  X(update_h0, sph_neighbors_update_arrays(w->list, 2, w->n, w->a.x, NULL, x, NULL))     \
  X(alpha, sph_viscosity_monaghan(w->list, w->kernel, &w->a, x, 1.0, w->out))            \
  X(beta, sph_viscosity_monaghan(w->list, w->kernel, &w->a, 1.0, x, w->out))             \
  X(xsph, sph_xsph(w->list, w->kernel, &w->a, x, w->out))                                \
  X(time, sph_integrator_step(w->it, w->set, x, 0.1, NULL))                              \
  X(step, sph_integrator_step(w->it, w->set, 0.0, x, NULL))                              \
  X(cfl, sph_cfl_step(w->set, x, w->out))                                                \
  X(signal, sph_signal_step(w->list, &w->a, x, w->out))                                  \
  X(density_step, sph_density_step(w->ctx, w->rows, x, w->a.rho, w->a.v, w->out))        \
  X(m0, (w->a.m = NULL, w->a.m0 = x, ew_density_summation(w)))                           \
  X(rho0, (w->a.rho = NULL, w->a.rho0 = x, ew_velocity_gradient(w)))                     \
  X(c0, (w->a.c = NULL, w->a.c0 = x, ew_viscosity_monaghan(w)))                          \
  X(h0, (w->a.h = NULL, w->a.h0 = x, ew_density_summation(w)))                           \
  X(point, (w->points[3] = x, ew_at(w)))

/* A member of options: create (or add) is refused. */
#define OPTION_CALLS(X)                                                                            \
  X(sph_neighbors_options, support, sph_neighbors_create(w->ctx, &o, &list))                       \
  X(sph_neighbors_options, skin, sph_neighbors_create(w->ctx, &o, &list))                          \
  X(sph_neighbors_options, box_lo[1],                                                              \
    (o.periodic[1] = 1, sph_neighbors_create(w->ctx, &o, &list)))                                  \
  X(sph_neighbors_options, box_hi[1],                                                              \
    (o.periodic[1] = 1, sph_neighbors_create(w->ctx, &o, &list)))                                  \
  X(sph_hooke_options, young, sph_material_create_hooke(w->ctx, &o, &material))                    \
  X(sph_hooke_options, density, (o.young = 1.0, sph_material_create_hooke(w->ctx, &o, &material))) \
  X(sph_hooke_options, poisson,                                                                    \
    (o.young = o.density = 1.0, sph_material_create_hooke(w->ctx, &o, &material)))                 \
  X(sph_bulk_viscosity, neumann,                                                                   \
    (o.spacing = 1.0, sph_viscosity_bulk(w->list, w->kernel, &w->a, &o, NULL, w->out)))            \
  X(sph_bulk_viscosity, linear,                                                                    \
    (o.spacing = 1.0, sph_viscosity_bulk(w->list, w->kernel, &w->a, &o, NULL, w->out)))            \
  X(sph_bulk_viscosity, spacing,                                                                   \
    (o.linear = 1.0, sph_viscosity_bulk(w->list, w->kernel, &w->a, &o, NULL, w->out)))             \
  X(sph_bulk_viscosity, hk_alpha, sph_viscosity_bulk(w->list, w->kernel, &w->a, &o, NULL, w->out)) \
  X(sph_bulk_viscosity, hk_beta, sph_viscosity_bulk(w->list, w->kernel, &w->a, &o, NULL, w->out))  \
  X(sph_integrator_options, rtol, sph_integrator_create(w->ctx, &o, &it))                          \
  X(sph_integrator_options, atol, sph_integrator_create(w->ctx, &o, &it))                          \
  X(sph_integrator_options, power_safety,                                                          \
    (o.method = SPH_INTEGRATOR_RKC, sph_integrator_create(w->ctx, &o, &it)))                       \
  X(sph_integrator_options, wave_speed,                                                            \
    (o.method = SPH_INTEGRATOR_RKC, o.stage_rule = SPH_STAGES_CFL, o.spacing = 1.0,                \
     sph_integrator_create(w->ctx, &o, &it)))                                                      \
  X(sph_integrator_options, spacing,                                                               \
    (o.method = SPH_INTEGRATOR_RKC, o.stage_rule = SPH_STAGES_CFL,                                 \
     sph_integrator_create(w->ctx, &o, &it)))                                                      \
  X(sph_term, alpha, (o.kind = SPH_TERM_MONAGHAN, sph_rhs_add(rhs, &o)))                           \
  X(sph_term, beta, (o.kind = SPH_TERM_MONAGHAN, sph_rhs_add(rhs, &o)))                            \
  X(sph_term, epsilon, (o.kind = SPH_TERM_XSPH, sph_rhs_add(rhs, &o)))                             \
  X(sph_term, neumann, (o.kind = SPH_TERM_BULK_VISCOSITY, o.spacing = 1.0, sph_rhs_add(rhs, &o)))  \
  X(sph_term, linear, (o.kind = SPH_TERM_BULK_VISCOSITY, o.spacing = 1.0, sph_rhs_add(rhs, &o)))   \
  X(sph_term, spacing, (o.kind = SPH_TERM_BULK_VISCOSITY, o.linear = 1.0, sph_rhs_add(rhs, &o)))   \
  X(sph_term, vector[2], (o.kind = SPH_TERM_BODY_FORCE, sph_rhs_add(rhs, &o)))                     \
  X(sph_term, spacing_ratio, (o.kind = SPH_TERM_ARTIFICIAL_STRESS, sph_rhs_add(rhs, &o)))

static void expect_refusal(const everywhere *w, sph_status s, double x, const char *text) {
  if (s != SPH_ERR_ARG) fail_msg("%g: %s: %s", x, text, sph_status_name(s));
  assert_true(sph_context_last_error(w->ctx)[0] != '\0');
}

static void try_numbers(double x) {
  sph_context *ctx = rh_context(1);
  everywhere *w = ew_open(ctx, 2, PLANE, PLANE);
  uint64_t before = ew_set_state(w, 1), list = ew_list_state(w), out = ew_output(w);
  sph_operands a = w->a;
  sph_kernel *kernel = NULL;
#define RUN(name, call)               \
  expect_refusal(w, call, x, #name);  \
  w->a = a; /* as some calls spoil */ \
  w->points[3] = 0.0;
  NUMBER_CALLS(RUN)
#undef RUN
  assert_null(kernel);
  assert_true(before == ew_set_state(w, 1));
  assert_true(list == ew_list_state(w));
  assert_true(out == ew_output(w));
  ew_close(w);
  sph_context_destroy(ctx);
}

static void try_options(double x) {
  sph_context *ctx = rh_context(1);
  everywhere *w = ew_open(ctx, 2, PLANE, PLANE);
  uint64_t out = ew_output(w);
  sph_neighbors *list = NULL;
  sph_material *material = NULL;
  sph_integrator *it = NULL;
  sph_rhs *rhs = NULL;
  check_ok(sph_rhs_create(ctx, w->kernel, NULL, &rhs));
#define RUN(type, member, call)                    \
  do {                                             \
    type o;                                        \
    type##_init(&o);                               \
    o.member = x;                                  \
    expect_refusal(w, call, x, #type "." #member); \
  } while (0);
  OPTION_CALLS(RUN)
#undef RUN
  assert_null(list);
  assert_null(material);
  assert_null(it);
  assert_true(out == ew_output(w));
  sph_rhs_destroy(rhs);
  ew_close(w);
  sph_context_destroy(ctx);
}

static void test_numbers(void **state) {
  (void)state;
  static const double values[] = {NAN, INFINITY, -INFINITY};
  for (size_t v = 0; v < sizeof values / sizeof *values; v++) {
    try_numbers(values[v]);
    try_options(values[v]);
  }
}

/* Functions without a status answer NaN, or their nothing. */
static void test_pure(void **state) {
  (void)state;
  static const double values[] = {NAN, INFINITY, -INFINITY};
  sph_context *ctx = rh_context(1);
  sph_kernel *k = NULL;
  check_ok(sph_kernel_create(ctx, SPH_KERNEL_CUBIC_SPLINE, 2, &k));
  for (size_t v = 0; v < sizeof values / sizeof *values; v++) {
    double x = values[v];
    assert_true(isnan(sph_kernel_w(k, 0.5, x)) && isnan(sph_kernel_dwdr(k, 0.5, x)));
    assert_true(isnan(sph_kernel_d2wdr2(k, 0.5, x)) && isnan(sph_kernel_dwdh(k, 0.5, x)));
    assert_true(isnan(sph_kernel_equal_h(k, k, x)));
    assert_int_equal(sph_rkc_stages_cfl(x, 1.0, 1.0), -1);
    assert_int_equal(sph_rkc_stages_cfl(1.0, x, 1.0), -1);
    assert_int_equal(sph_rkc_stages_cfl(1.0, 1.0, x), -1);
    assert_int_equal(sph_rkc_stages_radius(x, 1.0), -1);
    assert_int_equal(sph_rkc_stages_radius(1.0, x), -1);
    double r[3] = {1.0, 1.0, 1.0};
    check_status(sph_artificial_stress(1, 3, r, NULL, x, 0.3, r), SPH_ERR_ARG);
    check_status(sph_artificial_stress(1, 3, r, NULL, 1.0, x, r), SPH_ERR_ARG);
    assert_true(r[0] == 1.0 && r[1] == 1.0 && r[2] == 1.0);
  }
  assert_true(isnan(sph_kernel_w(k, NAN, 1.0)) && isnan(sph_kernel_w(k, -INFINITY, 1.0)));
  assert_true(sph_kernel_w(k, INFINITY, 1.0) == 0.0); /* beyond the support */
  sph_kernel_destroy(k);
  sph_context_destroy(ctx);
}

/* --- objects of another dimension -------------------------------------------------------- */

/* Kernel, operands or list of another dimension than the rest: refused, outputs untouched. */
static void test_other_dimension(void **state) {
  (void)state;
  for (int k = 0; k < EW_ENTRIES; k++) {
    const ew_entry *e = &ew_entries[k];
    if (e->call != ew_evaluate && !(e->flags & EW_PAIRS)) continue;
    if (e->call == ew_artificial) continue; /* takes dim itself */
    for (int32_t dim = 1; dim <= 3; dim++) {
      sph_context *ctx = rh_context(1);
      everywhere *w = ew_open(ctx, dim, 8, 8), *other = ew_open(ctx, dim % 3 + 1, 8, 8);
      uint64_t before = ew_output(w);
      for (int what = 0; what < 3; what++) {
        everywhere mixed = *w;
        if (what == 0) mixed.kernel = other->kernel;
        if (what == 1) mixed.list = other->list;
        if (what == 2) mixed.a.dim = other->dim;
        if (what == 0 && e->call == ew_evaluate) mixed.rhs = other->rhs;
        if (what > 0 && e->call == ew_evaluate) continue; /* it updates the list itself */
        sph_status s = e->call(&mixed);
        if (s != SPH_ERR_ARG) fail_msg("%s, case %d: %s", e->name, what, sph_status_name(s));
        assert_true(ew_output(&mixed) == before);
      }
      ew_close(other);
      ew_close(w);
      sph_context_destroy(ctx);
    }
  }
}

static void test_bad_dimension(void **state) {
  (void)state;
  static const int32_t dims[] = {INT32_MIN, -1, 0, 4, 7, INT32_MAX};
  sph_context *ctx = rh_context(1);
  everywhere *w = ew_open(ctx, 2, 16, 16);
  for (size_t k = 0; k < sizeof dims / sizeof *dims; k++) {
    sph_particles_options o;
    sph_particles *set = NULL;
    sph_kernel *kernel = NULL;
    sph_material_block b = ew_block(w);
    sph_particles_options_init(&o);
    o.dim = b.dim = dims[k];
    check_status(sph_particles_create(ctx, &o, &set), SPH_ERR_ARG);
    check_status(sph_kernel_create(ctx, SPH_KERNEL_LUCY, dims[k], &kernel), SPH_ERR_ARG);
    check_status(sph_kernel_create_callback(ctx, dims[k], 1.0, ew_profile, NULL, &kernel),
                 SPH_ERR_ARG);
    check_status(sph_kernel_create_table(ctx, dims[k], 1.0, 4, w->out, w->out, 1, &kernel),
                 SPH_ERR_ARG);
    check_status(sph_neighbors_build_arrays(w->list, dims[k], 4, w->a.x, NULL, 1.0), SPH_ERR_ARG);
    check_status(sph_neighbors_update_arrays(w->list, dims[k], 4, w->a.x, NULL, 1.0, NULL),
                 SPH_ERR_ARG);
    check_status(sph_artificial_stress(dims[k], 4, w->out, NULL, 1.0, 0.3, w->out), SPH_ERR_ARG);
    check_status(sph_material_stress_rate(w->hooke, &b, w->out), SPH_ERR_ARG);
    check_status(sph_material_sound_speed(w->hooke, &b, w->out), SPH_ERR_ARG);
    assert_int_equal(sph_sym_components(dims[k]), 0);
    assert_null(set);
    assert_null(kernel);
  }
  ew_close(w);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_empty),         cmocka_unit_test(test_single),
    cmocka_unit_test(test_ghosts_alone),  cmocka_unit_test(test_sick_particle),
    cmocka_unit_test(test_refused_sets),  cmocka_unit_test(test_numbers),
    cmocka_unit_test(test_pure),          cmocka_unit_test(test_other_dimension),
    cmocka_unit_test(test_bad_dimension),
};
SPH_TEST_MAIN(tests)
