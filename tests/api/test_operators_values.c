/* Operators against plain references and by hand: every form, dimension, kernel, rule for unequal
 * h, instruction set and number of threads. */
#include "../operator_cases.h"

static oc_particles set;
static double out[18 * OC_MAX], value[18 * OC_MAX], bound[18 * OC_MAX];

static void expect_close(const oc_case *op, const oc_particles *s, int64_t length, int32_t isa,
                         const char *what) {
  for (int64_t k = 0; k < length; k++)
    if (!(fabs(out[k] - value[k]) <= 1e-12 * bound[k]))
      fail_msg("%s form %d, %d-D, %s, %s: value %lld is %.17g, expected %.17g, off by %.2g of the "
               "contributions",
               op->name, (int)op->form, (int)s->dim, sph_isa_name(isa), what, (long long)k, out[k],
               value[k], fabs(out[k] - value[k]) / bound[k]);
}

typedef struct machine {
  sph_context *ctx;
  sph_kernel *kernel;
  sph_neighbors *list;
} machine;

static machine make_machine(const oc_particles *s, int32_t isa, int32_t type, int32_t rule) {
  machine m = {0};
  if (!sph_isa_available(isa)) return m;
  m.ctx = oc_context(isa, 1);
  m.kernel = oc_kernel(m.ctx, type, s->dim);
  m.list = oc_list(m.ctx, s, m.kernel, rule);
  return m;
}

static void free_machine(machine *m) {
  sph_neighbors_destroy(m->list);
  sph_kernel_destroy(m->kernel);
  sph_context_destroy(m->ctx);
}

static void compute(const oc_case *op, const ref_system *system, const oc_particles *s,
                    int64_t rows) {
  ref_out o = {value, bound};
  memset(value, 0, sizeof value);
  memset(bound, 0, sizeof bound);
  op->ref(system, s, op, rows, &o);
}

/* Every operator with every instruction set, against one reference. */
static void compare(const oc_particles *s, int32_t type, int32_t rule, int corrected, int64_t rows,
                    const char *what) {
  machine m[SPH_ISA_AVX512 + 1];
  memset(m, 0, sizeof m);
  for (int32_t isa = SPH_ISA_PORTABLE; isa <= SPH_ISA_AVX512; isa++)
    m[isa] = make_machine(s, isa, type, rule);
  ref_particles particles = oc_reference(s, m[SPH_ISA_PORTABLE].kernel, rule, corrected);
  ref_system system = ref_build(&particles);
  sph_operands a;
  oc_operands(s, corrected, &a);
  a.rows = rows == s->n ? -1 : rows;
  assert_true(system.count > 0);
  for (int k = 0; k < OC_CASES; k++) {
    const oc_case *op = &oc_cases[k];
    int64_t length = oc_length(op, s->dim, rows);
    if ((op->flags & OC_NEEDS_MATRIX) && !corrected) continue;
    compute(op, &system, s, rows);
    for (int32_t isa = SPH_ISA_PORTABLE; isa <= SPH_ISA_AVX512; isa++) {
      if (!m[isa].ctx) continue;
      oc_call call = oc_call_of(m[isa].list, m[isa].kernel, &a, s, out);
      for (int64_t i = 0; i <= length; i++) out[i] = 4.25;
      check_ok(op->run(&call, op));
      expect_close(op, s, length, isa, what);
      assert_true(out[length] == 4.25); /* nothing behind the results */
    }
  }
  ref_free(&system);
  for (int32_t isa = SPH_ISA_PORTABLE; isa <= SPH_ISA_AVX512; isa++) free_machine(&m[isa]);
}

static const int64_t side_of[4] = {0, 37, 9, 6};

static void test_every_kernel(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int32_t type = 1; type <= OC_KERNELS; type++) {
      sph_context *ctx = oc_context(SPH_ISA_AUTO, 1);
      sph_kernel *kernel = oc_kernel(ctx, type, dim);
      double h = 2.4 / sph_kernel_support(kernel);
      uint32_t flavour = type % 2 ? OC_VARY_H | OC_VARY_C : OC_VARY_M;
      oc_make(&set, dim, side_of[dim], h, flavour, (uint64_t)(100 * dim + type));
      sph_kernel_destroy(kernel);
      sph_context_destroy(ctx);
      compare(&set, type, SPH_H_ARITHMETIC, type % 2, set.n, sph_kernel_name(type));
    }
}

static void test_every_rule(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int32_t rule = 1; rule <= OC_RULES; rule++)
      for (int corrected = 0; corrected < 2; corrected++) {
        uint32_t flavour = OC_VARY_H | (corrected ? 0 : OC_VARY_M | OC_VARY_C);
        oc_make(&set, dim, side_of[dim], 1.2, flavour, (uint64_t)(10 * dim + rule));
        compare(&set, SPH_KERNEL_CUBIC_SPLINE, rule, corrected, set.n, "rule");
      }
}

/* Which arrays are uniform chooses another instance of the loop. */
static void test_every_uniformity(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (uint32_t flavour = 0; flavour < 8; flavour++) {
      oc_make(&set, dim, side_of[dim], 1.2, flavour, flavour + 1);
      compare(&set, SPH_KERNEL_WENDLAND_C2, SPH_H_MAX, (int)flavour % 2, set.n, "uniformity");
      compare(&set, SPH_KERNEL_WENDLAND_C2, SPH_H_MIN, 1 - (int)flavour % 2, set.n, "uniformity");
    }
}

static void test_periodic(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int corrected = 0; corrected < 2; corrected++) {
      uint32_t all = OC_VARY_M | OC_VARY_H | OC_WRAP_ALL;
      oc_make(&set, dim, side_of[dim], 1.1, all, 7);
      compare(&set, SPH_KERNEL_CUBIC_SPLINE, SPH_H_ARITHMETIC, corrected, set.n, "all periodic");
      oc_make(&set, dim, side_of[dim], 1.1, OC_WRAP, 8);
      compare(&set, SPH_KERNEL_QUARTIC_SPLINE, SPH_H_ARITHMETIC, corrected, set.n, "x periodic");
    }
}

/* The first rows only, as with ghosts behind. */
static void test_rows(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int corrected = 0; corrected < 2; corrected++) {
      oc_make(&set, dim, side_of[dim], 1.2, OC_VARY_H | OC_VARY_M, 9);
      compare(&set, SPH_KERNEL_WENDLAND_C4, SPH_H_ARITHMETIC, corrected, set.n * 2 / 3, "rows");
      compare(&set, SPH_KERNEL_WENDLAND_C4, SPH_H_ARITHMETIC, corrected, 1, "one row");
    }
}

/* Positions that moved after the build, within what the skin of the list allows. */
static void test_skin(void **state) {
  (void)state;
  sph_context *ctx = oc_context(SPH_ISA_AUTO, 1);
  for (int32_t dim = 1; dim <= 3; dim++) {
    sph_kernel *kernel = oc_kernel(ctx, SPH_KERNEL_CUBIC_SPLINE, dim);
    sph_neighbors_options o;
    sph_neighbors *list = NULL;
    oc_make(&set, dim, side_of[dim], 0.9, OC_VARY_H | OC_WRAP, 17);
    sph_neighbors_options_init(&o);
    o.method = SPH_NEIGHBORS_VERLET;
    o.skin = 0.8;
    o.periodic[0] = 1;
    o.box_hi[0] = set.edge;
    check_ok(sph_neighbors_create(ctx, &o, &list));
    check_ok(sph_neighbors_build_arrays(list, dim, set.n, set.x, set.h, 0.0));
    for (int64_t k = 0; k < set.n * dim; k++)
      set.x[k] += oc_random(-0.39, 0.39) / sqrt((double)dim);
    ref_particles particles = oc_reference(&set, kernel, SPH_H_ARITHMETIC, 1);
    ref_system system = ref_build(&particles);
    for (int k = 0; k < OC_CASES; k++) {
      const oc_case *op = &oc_cases[k];
      sph_operands a;
      oc_operands(&set, 1, &a);
      oc_call call = oc_call_of(list, kernel, &a, &set, out);
      compute(op, &system, &set, set.n);
      check_ok(op->run(&call, op));
      expect_close(op, &set, oc_length(op, dim, set.n), sph_context_isa(ctx), "skin");
    }
    ref_free(&system);
    sph_neighbors_destroy(list);
    sph_kernel_destroy(kernel);
  }
  sph_context_destroy(ctx);
}

/* NULL arrays mean the one value: the same bits as arrays of that value. */
static void test_uniform_values(void **state) {
  (void)state;
  static double other[18 * OC_MAX];
  sph_context *ctx = oc_context(SPH_ISA_AUTO, 1);
  for (int32_t dim = 1; dim <= 3; dim++) {
    oc_make(&set, dim, side_of[dim], 1.2, 0, 21);
    oc_fill(set.rho, set.n, 1.3, 1.4, 0);
    oc_fill(set.p, set.n, 1.3, 1.4, 0);
    sph_kernel *kernel = oc_kernel(ctx, SPH_KERNEL_CUBIC_SPLINE, dim);
    sph_neighbors *list = oc_list(ctx, &set, kernel, SPH_H_ARITHMETIC);
    for (int k = 0; k < OC_CASES; k++) {
      sph_operands a;
      size_t bytes = (size_t)oc_length(&oc_cases[k], dim, set.n) * sizeof(double);
      oc_operands(&set, 1, &a);
      oc_call call = oc_call_of(list, kernel, &a, &set, out);
      check_ok(oc_cases[k].run(&call, &oc_cases[k]));
      a.m = a.rho = a.h = a.p = a.c = NULL;
      a.m0 = set.m[0];
      a.rho0 = set.rho[0];
      a.h0 = set.h[0];
      a.p0 = set.p[0];
      a.c0 = set.c[0];
      call.out = other;
      check_ok(oc_cases[k].run(&call, &oc_cases[k]));
      assert_memory_equal(out, other, bytes);
    }
    sph_neighbors_destroy(list);
    sph_kernel_destroy(kernel);
  }
  sph_context_destroy(ctx);
}

/* --- a host's own kernel ------------------------------------------------------------------- */

static void c2_profile(void *user, double q, double *w, double *dw) {
  double a = 1.0 - 0.5 * q, alpha = *(const double *)user;
  *w = alpha * a * a * a * a * (1.0 + 2.0 * q);
  *dw = alpha * -5.0 * q * a * a * a;
}

static void test_host_kernel(void **state) {
  (void)state;
  double alpha = 7.0 / (4.0 * 3.14159265358979323846);
  for (int32_t isa = SPH_ISA_PORTABLE; isa <= SPH_ISA_AVX512; isa++) {
    if (!sph_isa_available(isa)) continue;
    sph_context *ctx = oc_context(isa, 1);
    sph_kernel *own = NULL, *built_in = oc_kernel(ctx, SPH_KERNEL_WENDLAND_C2, 2);
    check_ok(sph_kernel_create_callback(ctx, 2, 2.0, c2_profile, &alpha, &own));
    oc_make(&set, 2, 9, 1.2, OC_VARY_H, 31);
    sph_neighbors *list = oc_list(ctx, &set, own, SPH_H_ARITHMETIC);
    ref_particles particles = oc_reference(&set, built_in, SPH_H_ARITHMETIC, 1);
    ref_system system = ref_build(&particles);
    for (int k = 0; k < OC_CASES; k++) {
      sph_operands a;
      oc_operands(&set, 1, &a);
      oc_call call = oc_call_of(list, own, &a, &set, out);
      compute(&oc_cases[k], &system, &set, set.n);
      check_ok(oc_cases[k].run(&call, &oc_cases[k]));
      expect_close(&oc_cases[k], &set, oc_length(&oc_cases[k], 2, set.n), isa, "host kernel");
    }
    ref_free(&system);
    sph_neighbors_destroy(list);
    sph_kernel_destroy(own);
    sph_kernel_destroy(built_in);
    sph_context_destroy(ctx);
  }
}

/* --- the inverse ----------------------------------------------------------------------------- */

static void test_gradient_matrix(void **state) {
  (void)state;
  static double inverse[9 * OC_MAX], matrix[9 * OC_MAX], alone[9 * OC_MAX];
  sph_context *ctx = oc_context(SPH_ISA_AUTO, 1);
  for (int32_t dim = 1; dim <= 3; dim++) {
    int64_t fallbacks = -1, dd = dim * dim;
    sph_operands a;
    oc_make(&set, dim, side_of[dim], 1.3, OC_VARY_H | OC_VARY_M, 41);
    for (int64_t i = 0; i < set.n; i++) set.m[i] *= set.rho[i]; /* volumes near 1 */
    sph_kernel *kernel = oc_kernel(ctx, SPH_KERNEL_CUBIC_SPLINE, dim);
    sph_neighbors *list = oc_list(ctx, &set, kernel, SPH_H_ARITHMETIC);
    oc_operands(&set, 1, &a); /* a matrix among the operands changes nothing here */
    check_ok(sph_gradient_matrix(list, kernel, &a, inverse, matrix, &fallbacks));
    assert_int_equal(fallbacks, 0);
    for (int64_t i = 0; i < set.n; i++)
      for (int64_t r = 0; r < dim; r++)
        for (int64_t c = 0; c < dim; c++) {
          double s = 0.0;
          for (int64_t k = 0; k < dim; k++)
            s += inverse[i * dd + r * dim + k] * matrix[i * dd + k * dim + c];
          check_close(s, r == c ? 1.0 : 0.0, 1e-11);
          assert_true(matrix[i * dd + r * dim + c] == matrix[i * dd + c * dim + r]);
        }
    check_ok(sph_gradient_matrix(list, kernel, &a, alone, NULL, NULL));
    assert_memory_equal(alone, inverse, (size_t)(set.n * dd) * sizeof(double));
    sph_neighbors_destroy(list);
    sph_kernel_destroy(kernel);
  }
  sph_context_destroy(ctx);
}

/* --- by hand --------------------------------------------------------------------------------- */

/* Two particles at distance 1 = h, cubic spline in 1-D: W(0) = 2/3, W = 1/6, grad_0 W = +1/2 (for
 * x_0 < x_1: x_ij = -1, dW/dr = -1/2), grad_1 W = -1/2. */
static void test_two_particles(void **state) {
  (void)state;
  const double x[2] = {3.0, 4.0}, v[2] = {1.0, -1.0}, m[2] = {2.0, 3.0}, rho[2] = {4.0, 2.0};
  const double p[2] = {8.0, 4.0}, c[2] = {1.0, 3.0}, sigma[2] = {16.0, 8.0}, f[2] = {5.0, 7.0};
  sph_context *ctx = oc_context(SPH_ISA_AUTO, 1);
  sph_kernel *kernel = oc_kernel(ctx, SPH_KERNEL_CUBIC_SPLINE, 1);
  sph_neighbors *list = NULL;
  sph_operands a;
  double y[2], q[2];
  check_ok(sph_neighbors_create(ctx, NULL, &list));
  check_ok(sph_neighbors_build_arrays(list, 1, 2, x, NULL, 1.0));
  sph_operands_init(&a);
  a.dim = 1;
  a.n = 2;
  a.x = x;
  a.v = v;
  a.m = m;
  a.rho = rho;
  a.h0 = 1.0;
  a.p = p;
  a.c = c;
  a.sigma = sigma;
#define EXPECT(call, first, second) \
  check_ok(call);                   \
  check_rel(y[0], first, 1e-14);    \
  check_rel(y[1], second, 1e-14)
  EXPECT(sph_density_summation(list, kernel, &a, y), 11.0 / 6.0, 7.0 / 3.0);
  EXPECT(sph_shepard_sum(list, kernel, &a, y), 7.0 / 12.0, 13.0 / 12.0);
  EXPECT(sph_interpolate(list, kernel, &a, 0, 1, f, y), 5.0 / 3.0 + 1.75, 7.0 + 5.0 / 12.0);
  EXPECT(sph_interpolate(list, kernel, &a, 1, 1, f, y), 41.0 / 7.0, 89.0 / 13.0);
  EXPECT(sph_continuity(list, kernel, &a, SPH_CONTINUITY_MASS, y), 3.0, 2.0);
  EXPECT(sph_continuity(list, kernel, &a, SPH_CONTINUITY_VOLUME, y), 6.0, 1.0);
  EXPECT(sph_continuity(list, kernel, &a, SPH_CONTINUITY_NUMBER, y), 2.0, 3.0);
  EXPECT(sph_velocity_gradient(list, kernel, &a, y), -1.5, -0.5);
  EXPECT(sph_gradient(list, kernel, &a, SPH_GRADIENT_PLAIN, 1, f, y), 5.25, -1.25);
  EXPECT(sph_gradient(list, kernel, &a, SPH_GRADIENT_DIFFERENCE, 1, f, y), 1.5, 0.5);
  EXPECT(sph_gradient(list, kernel, &a, SPH_GRADIENT_SUM, 1, f, y), 9.0, -3.0);
  EXPECT(sph_stress_divergence(list, kernel, &a, SPH_STRESS_SUMMED, y), 4.5, -3.0);
  EXPECT(sph_stress_divergence(list, kernel, &a, SPH_STRESS_DIFFERENCE, y), -1.5, -1.0);
  EXPECT(sph_pressure_gradient(list, kernel, &a, SPH_PRESSURE_MASS, y), -2.25, 1.5);
  EXPECT(sph_pressure_gradient(list, kernel, &a, SPH_PRESSURE_VOLUME, y), -2.25, 1.5);
  EXPECT(sph_pressure_gradient(list, kernel, &a, SPH_PRESSURE_NUMBER, y), -2.75, 5.5 / 3.0);
  EXPECT(sph_pressure_gradient(list, kernel, &a, SPH_PRESSURE_DIFFERENCE, y), 0.75, 0.5);
  /* phi = -2/1.01, c = 2, rho = 3: Pi = (2 alpha 2/1.01 + beta 4/1.0201) / 3 */
  EXPECT(sph_viscosity_monaghan(list, kernel, &a, 1.01, 1.0201, y), -4.0, 8.0 / 3.0);
  EXPECT(sph_xsph(list, kernel, &a, 0.5, y), -1.0 / 6.0, 1.0 / 9.0);
  sph_bulk_viscosity k;
  sph_bulk_viscosity_init(&k);
  k.neumann = 2.0;
  k.linear = 1.0;
  k.spacing = 2.0;
  k.hk_alpha = 2.0;
  k.hk_beta = 1.0;
  /* div = -3/2: 72 + 12 + 12 + 9; div = -1/2: 4 + 6 + 6 + 1/2. q/rho^2: 105/16 and 33/8. */
  EXPECT(sph_viscosity_bulk(list, kernel, &a, &k, q, y), -1.5 * 171.0 / 16.0, 171.0 / 16.0);
  check_rel(q[0], 105.0, 1e-14);
  check_rel(q[1], 16.5, 1e-14);
  const double points[2] = {3.5, 9.0}; /* W(1/2) = 23/48 */
  EXPECT(sph_interpolate_at(list, kernel, &a, 0, 2, points, 1, f, y), 13.0 * 23.0 / 48.0, 0.0);
  EXPECT(sph_interpolate_at(list, kernel, &a, 1, 2, points, 1, f, y), 6.5, 0.0);
  /* B_0 = V_1 / 2, B_1 = V_0 / 2 */
  EXPECT(sph_gradient_matrix(list, kernel, &a, y, q, NULL), 4.0 / 3.0, 4.0);
  check_rel(q[0], 0.75, 1e-14);
  check_rel(q[1], 0.25, 1e-14);
  const double inverse[2] = {4.0 / 3.0, 4.0};
  a.gradient_matrix = inverse;
  EXPECT(sph_velocity_gradient(list, kernel, &a, y), -2.0, -2.0);
  EXPECT(sph_stress_divergence(list, kernel, &a, SPH_STRESS_SUMMED, y), 6.0, -12.0);
  EXPECT(sph_stress_divergence(list, kernel, &a, SPH_STRESS_CONSERVATIVE, y), 14.0, -28.0 / 3.0);
#undef EXPECT
  sph_neighbors_destroy(list);
  sph_kernel_destroy(kernel);
  sph_context_destroy(ctx);
}

/* Three particles at the corners (0,0), (1,0), (0,1), h = 1: the legs have W = 1/6 a, dW/dr = -a/2,
 * the hypotenuse W = (2 - sqrt 2)^3 / 6 a, dW/dr = -(2 - sqrt 2)^2 / 2 a; a = 15 / (7 pi). */
static void test_three_particles(void **state) {
  (void)state;
  const double x[6] = {0, 0, 1, 0, 0, 1}, v[6] = {0, 0, 2, 4, 6, -2};
  const double sigma[9] = {0, 0, 0, 1, 2, 3, 4, 5, 6}, alpha = 15.0 / (7.0 * acos(-1.0));
  const double d = 2.0 - sqrt(2.0), w = alpha * d * d * d / 6.0,
               g = 0.5 * alpha * d * d / sqrt(2.0);
  sph_context *ctx = oc_context(SPH_ISA_AUTO, 1);
  sph_kernel *kernel = oc_kernel(ctx, SPH_KERNEL_CUBIC_SPLINE, 2);
  sph_neighbors *list = NULL;
  sph_operands a;
  double y[12];
  check_ok(sph_neighbors_create(ctx, NULL, &list));
  check_ok(sph_neighbors_build_arrays(list, 2, 3, x, NULL, 1.0));
  sph_operands_init(&a);
  a.dim = 2;
  a.n = 3;
  a.x = x;
  a.v = v;
  a.sigma = sigma;
  a.h0 = a.m0 = a.rho0 = 1.0;
  check_ok(sph_density_summation(list, kernel, &a, y));
  check_rel(y[0], alpha, 1e-14);
  check_rel(y[1], alpha * 5.0 / 6.0 + w, 1e-14);
  check_rel(y[2], alpha * 5.0 / 6.0 + w, 1e-14);
  /* L_0 = sum (v_j - v_i) (x) (a/2) (x_j - x_i) */
  check_ok(sph_velocity_gradient(list, kernel, &a, y));
  const double l0[4] = {1.0, 3.0, 2.0, -1.0};
  for (int k = 0; k < 4; k++) check_rel(y[k], alpha * l0[k], 1e-14);
  /* of 1: from 0, (-2,-4)(x)(-1,0) a/2; from 2, (4,-6)(x)(-1,1) g */
  check_close(y[4], alpha - 4.0 * g, 1e-14);
  check_close(y[5], 4.0 * g, 1e-14);
  check_close(y[6], 2.0 * alpha + 6.0 * g, 1e-14);
  check_close(y[7], -6.0 * g, 1e-14);
  /* on 0: sigma_1 (1,0) a/2 + sigma_2 (0,1) a/2 = a/2 ((1,3) + (6,5)) */
  check_ok(sph_stress_divergence(list, kernel, &a, SPH_STRESS_SUMMED, y));
  check_close(y[0], 3.5 * alpha, 1e-14);
  check_close(y[1], 4.0 * alpha, 1e-14);
  /* on 1: sigma_1 (-1,0) a/2 + (sigma_1 + sigma_2) (-1,1) g, the sum {5, 7, 9} */
  check_close(y[2], -0.5 * alpha + 4.0 * g, 1e-14);
  check_close(y[3], -1.5 * alpha - 2.0 * g, 1e-14);
  sph_neighbors_destroy(list);
  sph_kernel_destroy(kernel);
  sph_context_destroy(ctx);
}

/* --- the same bits -----------------------------------------------------------------------------
 */

/* A host's loop: pieces of 37, the last first, worker numbers in turn. */
static void odd_loop(void *user, int64_t count, int64_t grain, sph_loop_fn body, void *job) {
  int32_t worker = 0, *calls = (int32_t *)user;
  (void)grain;
  for (int64_t end = count; end > 0; end -= 37, worker = (worker + 1) % 5, ++*calls)
    body(job, end > 37 ? end - 37 : 0, end, worker);
}

static sph_context *threads_context(int32_t isa, int which, int32_t *calls) {
  static const int32_t threads[4] = {1, 2, 3, 8};
  sph_context_options o;
  sph_context *ctx = NULL;
  if (which < 4) return oc_context(isa, threads[which]);
  sph_context_options_init(&o);
  o.isa = isa;
  o.parallel_for = odd_loop;
  o.parallel_user = calls;
  o.workers = 5;
  check_ok(sph_context_create(&o, &ctx));
  return ctx;
}

static uint64_t hash_of(const double *a, int64_t n) {
  uint64_t h = UINT64_C(1469598103934665603), bits;
  for (int64_t k = 0; k < n; k++) {
    memcpy(&bits, a + k, sizeof bits);
    h = (h ^ bits) * UINT64_C(1099511628211);
  }
  return h;
}

static void test_same_bits(void **state) {
  (void)state;
  static const int64_t sides[4] = {0, 5000, 70, 17};
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int32_t isa = SPH_ISA_PORTABLE; isa <= SPH_ISA_AVX512; isa++) {
      uint64_t first[OC_CASES];
      if (!sph_isa_available(isa)) continue;
      oc_make(&set, dim, sides[dim], 1.1, OC_VARY_H | OC_VARY_M, 51);
      for (int which = 0; which < 5; which++) {
        int32_t calls = 0;
        sph_context *ctx = threads_context(isa, which, &calls);
        sph_kernel *kernel = oc_kernel(ctx, SPH_KERNEL_WENDLAND_C2, dim);
        sph_neighbors *list = oc_list(ctx, &set, kernel, SPH_H_ARITHMETIC);
        for (int k = 0; k < OC_CASES; k++) {
          sph_operands a;
          oc_operands(&set, 1, &a);
          oc_call call = oc_call_of(list, kernel, &a, &set, out);
          check_ok(oc_cases[k].run(&call, &oc_cases[k]));
          uint64_t h = hash_of(out, oc_length(&oc_cases[k], dim, set.n));
          if (which == 0) first[k] = h;
          if (h != first[k])
            fail_msg("%s form %d, %d-D, %s: other bits with threads %d", oc_cases[k].name,
                     (int)oc_cases[k].form, (int)dim, sph_isa_name(isa), which);
        }
        assert_true(which < 4 || calls > 0);
        sph_neighbors_destroy(list);
        sph_kernel_destroy(kernel);
        sph_context_destroy(ctx);
      }
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_two_particles),
    cmocka_unit_test(test_three_particles),
    cmocka_unit_test(test_every_kernel),
    cmocka_unit_test(test_every_rule),
    cmocka_unit_test(test_every_uniformity),
    cmocka_unit_test(test_periodic),
    cmocka_unit_test(test_rows),
    cmocka_unit_test(test_uniform_values),
    cmocka_unit_test(test_host_kernel),
    cmocka_unit_test(test_gradient_matrix),
    cmocka_unit_test(test_same_bits),
    cmocka_unit_test(test_skin),
};
SPH_TEST_MAIN(tests)
