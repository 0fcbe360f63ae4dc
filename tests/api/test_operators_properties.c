/* What the operators promise whatever the particles: conservation, exactness, invariance, order. */
#include "../operator_cases.h"

static oc_particles set;
static double out[9 * OC_MAX], more[9 * OC_MAX];

typedef struct bench {
  sph_context *ctx;
  sph_kernel *kernel;
  sph_neighbors *list;
  sph_operands a;
} bench;

static bench begin(int32_t dim, int32_t type, int32_t rule, double h, uint32_t flavour) {
  static const int64_t side_of[4] = {0, 60, 14, 8};
  bench b;
  b.ctx = oc_context(SPH_ISA_AUTO, 1);
  b.kernel = oc_kernel(b.ctx, type, dim);
  oc_make(&set, dim, side_of[dim], h, flavour, (uint64_t)(1000 * dim + 10 * type + rule));
  b.list = oc_list(b.ctx, &set, b.kernel, rule);
  oc_operands(&set, 0, &b.a);
  return b;
}

static void end(bench *b) {
  sph_neighbors_destroy(b->list);
  sph_kernel_destroy(b->kernel);
  sph_context_destroy(b->ctx);
}

/* Use the true correction matrices of the set. */
static void correct(bench *b) {
  int64_t fallbacks = -1;
  check_ok(sph_gradient_matrix(b->list, b->kernel, &b->a, set.matrix, NULL, &fallbacks));
  assert_int_equal(fallbacks, 0);
  b->a.gradient_matrix = set.matrix;
}

/* m = rho * (a volume near 1), so that the particles fill space. */
static void fill_space(void) {
  for (int64_t i = 0; i < set.n; i++) set.m[i] = set.rho[i] * (0.9 + 0.2 * set.m[i] / 1.6);
}

/* --- conservation ------------------------------------------------------------------------------
 */

static void expect_no_force(const double *f, int turning, const char *what, int32_t form) {
  int32_t d = set.dim;
  double sum[3] = {0, 0, 0}, size = 0.0, torque[3] = {0, 0, 0};
  for (int64_t i = 0; i < set.n; i++)
    for (int32_t a = 0; a < d; a++) {
      sum[a] += set.m[i] * f[i * d + a];
      size += fabs(set.m[i] * f[i * d + a]);
      for (int32_t b = 0; b < a; b++)
        torque[a + b - 1] +=
            set.m[i] * (set.x[i * d + b] * f[i * d + a] - set.x[i * d + a] * f[i * d + b]);
    }
  assert_true(size > 0.0);
  for (int32_t a = 0; a < d; a++)
    if (!(fabs(sum[a]) <= 1e-13 * size))
      fail_msg("%s form %d, %d-D: momentum %g of %g", what, (int)form, (int)d, sum[a], size);
  for (int32_t a = 0; turning && a < 3; a++)
    if (!(fabs(torque[a]) <= 1e-13 * size * set.edge))
      fail_msg("%s form %d, %d-D: torque %g of %g", what, (int)form, (int)d, torque[a], size);
}

static void test_momentum(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int32_t rule = 1; rule <= OC_RULES; rule++)
      for (uint32_t wrap = 0; wrap <= OC_WRAP_ALL; wrap += OC_WRAP_ALL) {
        int open = wrap == 0;
        bench b = begin(dim, SPH_KERNEL_CUBIC_SPLINE, rule, 1.2, 7 | wrap);
        sph_bulk_viscosity k = oc_bulk(15);
        check_ok(sph_stress_divergence(b.list, b.kernel, &b.a, SPH_STRESS_SUMMED, out));
        expect_no_force(out, 0, "stress", SPH_STRESS_SUMMED);
        for (int32_t form = SPH_PRESSURE_MASS; form <= SPH_PRESSURE_NUMBER; form++) {
          check_ok(sph_pressure_gradient(b.list, b.kernel, &b.a, form, out));
          expect_no_force(out, open, "pressure", form);
        }
        check_ok(sph_viscosity_monaghan(b.list, b.kernel, &b.a, 2.5, 2.5, out));
        expect_no_force(out, open, "Monaghan", 0);
        check_ok(sph_viscosity_bulk(b.list, b.kernel, &b.a, &k, NULL, out));
        expect_no_force(out, open, "bulk", 0);
        check_ok(sph_xsph(b.list, b.kernel, &b.a, 0.5, out));
        expect_no_force(out, 0, "XSPH", 0);
        correct(&b);
        check_ok(sph_stress_divergence(b.list, b.kernel, &b.a, SPH_STRESS_CONSERVATIVE, out));
        expect_no_force(out, 0, "stress", SPH_STRESS_CONSERVATIVE);
        end(&b);
      }
}

/* Two particles pull on each other with opposite forces to the last bit when the masses are equal.
 */
static void test_antisymmetric_bits(void **state) {
  (void)state;
  for (int32_t isa = SPH_ISA_PORTABLE; isa <= SPH_ISA_AVX512; isa++) {
    if (!sph_isa_available(isa)) continue;
    sph_context *ctx = oc_context(isa, 1);
    for (int32_t dim = 1; dim <= 3; dim++) {
      sph_kernel *kernel = oc_kernel(ctx, SPH_KERNEL_QUINTIC_SPLINE, dim);
      for (uint64_t seed = 1; seed <= 50; seed++) {
        sph_operands a;
        oc_make(&set, dim, dim == 1 ? 2 : 1, 1.2, OC_VARY_H | OC_VARY_C, seed);
        set.n = 2;
        for (int64_t k = 0; k < 2 * dim; k++) set.x[k] = oc_random(0.0, 1.0);
        set.m[1] = set.m[0];
        set.h[1] = set.h[0] * 1.1;
        for (int k = 0; k < 6; k++) set.sigma[6 + k] = set.sigma[k] + 0.1 * k;
        set.c[1] = set.c[0] + 1.0;
        set.rho[1] = set.rho[0] * 1.3;
        set.p[1] = set.p[0] + 0.3;
        for (int k = 0; k < 3; k++) set.v[k + dim] = set.v[k] - set.x[k + dim] + set.x[k];
        for (int k = 0; k < 9; k++) set.matrix[9 + k] = set.matrix[k] = oc_random(0.5, 1.5);
        sph_neighbors *list = oc_list(ctx, &set, kernel, SPH_H_ARITHMETIC);
        oc_operands(&set, 0, &a);
        for (int form = 0; form < 5; form++) {
          a.gradient_matrix = form == 4 ? set.matrix : NULL;
          if (form == 0) check_ok(sph_viscosity_monaghan(list, kernel, &a, 1.0, 2.0, out));
          if (form == 1) check_ok(sph_pressure_gradient(list, kernel, &a, SPH_PRESSURE_MASS, out));
          if (form == 2) check_ok(sph_stress_divergence(list, kernel, &a, SPH_STRESS_SUMMED, out));
          if (form == 3)
            check_ok(sph_pressure_gradient(list, kernel, &a, SPH_PRESSURE_NUMBER, out));
          if (form == 4)
            check_ok(sph_stress_divergence(list, kernel, &a, SPH_STRESS_CONSERVATIVE, out));
          for (int k = 0; k < dim; k++) {
            assert_true(out[k] == -out[dim + k]);
            assert_true(out[k] != 0.0);
          }
        }
        sph_neighbors_destroy(list);
      }
      sph_kernel_destroy(kernel);
    }
    sph_context_destroy(ctx);
  }
}

/* Force and continuity of one form are adjoint: sum m (v.a + (p / rho^2) d rho/dt) = 0. */
static void test_energy(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int32_t rule = 1; rule <= OC_RULES; rule++)
      for (int32_t form = 1; form <= 3; form++) {
        bench b = begin(dim, SPH_KERNEL_WENDLAND_C4, rule, 1.2, 7);
        double sum = 0.0, size = 0.0;
        check_ok(sph_continuity(b.list, b.kernel, &b.a, form, out));
        check_ok(sph_pressure_gradient(b.list, b.kernel, &b.a, form, more));
        for (int64_t i = 0; i < set.n; i++) {
          double heat = set.m[i] * set.p[i] / (set.rho[i] * set.rho[i]) * out[i];
          sum += heat;
          size += fabs(heat);
          for (int32_t a = 0; a < dim; a++)
            sum += set.m[i] * set.v[i * dim + a] * more[i * dim + a];
        }
        check_close(sum, 0.0, 1e-12 * size);
        end(&b);
      }
}

/* Viscosity takes kinetic energy: sum m v.a <= 0. */
static void test_viscosity_dissipates(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) {
    bench b = begin(dim, SPH_KERNEL_CUBIC_SPLINE, SPH_H_ARITHMETIC, 1.2, 7);
    double power = 0.0;
    check_ok(sph_viscosity_monaghan(b.list, b.kernel, &b.a, 1.0, 2.0, out));
    for (int64_t k = 0; k < set.n * dim; k++) power += set.m[k / dim] * set.v[k] * out[k];
    assert_true(power < 0.0);
    end(&b);
  }
}

/* --- exactness ---------------------------------------------------------------------------------
 */

/* Difference forms with the matrix are exact for linear fields, in disorder and at free edges. */
static void test_linear(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int32_t rule = 1; rule <= OC_RULES; rule++) {
      bench b = begin(dim, SPH_KERNEL_CUBIC_SPLINE, rule, 1.3, 7);
      int32_t d = dim, n = d * (d + 1) / 2;
      double L[9], slope[18];
      fill_space();
      correct(&b);
      for (int k = 0; k < d * d; k++) L[k] = oc_random(-1.0, 1.0);
      for (int k = 0; k < n * d; k++) slope[k] = oc_random(-1.0, 1.0);
      for (int64_t i = 0; i < set.n; i++) {
        set.p[i] = 3.0;
        for (int k = 0; k < d; k++) set.v[i * d + k] = 0.5;
        for (int k = 0; k < n; k++) set.sigma[i * n + k] = 0.25;
        for (int c = 0; c < d; c++) {
          set.p[i] += slope[c] * set.x[i * d + c];
          for (int k = 0; k < d; k++) set.v[i * d + k] += L[k * d + c] * set.x[i * d + c];
          for (int k = 0; k < n; k++) set.sigma[i * n + k] += slope[k * d + c] * set.x[i * d + c];
        }
      }
      check_ok(sph_velocity_gradient(b.list, b.kernel, &b.a, out));
      for (int64_t k = 0; k < set.n * d * d; k++) check_close(out[k], L[k % (d * d)], 1e-11);
      check_ok(sph_gradient(b.list, b.kernel, &b.a, SPH_GRADIENT_DIFFERENCE, d, set.v, out));
      for (int64_t k = 0; k < set.n * d * d; k++) check_close(out[k], L[k % (d * d)], 1e-11);
      check_ok(sph_gradient(b.list, b.kernel, &b.a, SPH_GRADIENT_DIFFERENCE, n, set.sigma, out));
      for (int64_t k = 0; k < set.n * n * d; k++) check_close(out[k], slope[k % (n * d)], 1e-11);
      check_ok(sph_continuity(b.list, b.kernel, &b.a, SPH_CONTINUITY_VOLUME, out));
      double div = d == 1 ? L[0] : d == 2 ? L[0] + L[3] : L[0] + L[4] + L[8];
      for (int64_t i = 0; i < set.n; i++) check_close(out[i], -set.rho[i] * div, 1e-11);
      check_ok(sph_stress_divergence(b.list, b.kernel, &b.a, SPH_STRESS_DIFFERENCE, out));
      for (int64_t k = 0; k < set.n * d; k++) {
        double want = 0.0;
        for (int c = 0; c < d; c++) want += slope[ref_sym(d, (int)(k % d), c) * d + c];
        check_close(out[k], want / set.rho[k / d], 1e-11);
      }
      check_ok(sph_pressure_gradient(b.list, b.kernel, &b.a, SPH_PRESSURE_DIFFERENCE, out));
      for (int64_t k = 0; k < set.n * d; k++)
        check_close(out[k], -slope[k % d] / set.rho[k / d], 1e-11);
      end(&b);
    }
}

static void test_constants(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int corrected = 0; corrected < 2; corrected++) {
      bench b = begin(dim, SPH_KERNEL_WENDLAND_C2, SPH_H_ARITHMETIC, 1.3, 7);
      sph_bulk_viscosity k = oc_bulk(15);
      fill_space();
      if (corrected) correct(&b);
      for (int64_t i = 0; i < 6 * set.n; i++) set.f[i] = set.sigma[i] = 3.7;
      for (int64_t i = 0; i < set.n; i++) set.p[i] = 2.9;
      for (int64_t i = 0; i < set.n * dim; i++) set.v[i] = -1.7;
      check_ok(sph_interpolate(b.list, b.kernel, &b.a, 1, 6, set.f, out));
      for (int64_t i = 0; i < 6 * set.n; i++) check_rel(out[i], 3.7, 1e-14);
      for (int64_t i = 0; i < OC_POINTS * dim; i++) set.points[i] = oc_random(0.0, set.edge);
      check_ok(sph_interpolate_at(b.list, b.kernel, &b.a, 1, OC_POINTS, set.points, 6, set.f, out));
      for (int64_t i = 0; i < 6 * OC_POINTS; i++) check_rel(out[i], 3.7, 1e-14);
      /* difference forms: nothing at all, not even rounding */
      static const char *const zero[] = {"continuity", "velocity_gradient", "xsph", "monaghan",
                                         "bulk"};
      for (int c = 0; c < OC_CASES; c++) {
        const oc_case *op = &oc_cases[c];
        int is_zero = 0;
        for (size_t z = 0; z < sizeof zero / sizeof *zero; z++)
          if (strcmp(op->name, zero[z]) == 0) is_zero = 1;
        if (strcmp(op->name, "gradient") == 0) is_zero = op->form == SPH_GRADIENT_DIFFERENCE;
        if (strcmp(op->name, "stress") == 0) is_zero = op->form == SPH_STRESS_DIFFERENCE;
        if (strcmp(op->name, "pressure") == 0) is_zero = op->form == SPH_PRESSURE_DIFFERENCE;
        if (!is_zero) continue;
        oc_call call = oc_call_of(b.list, b.kernel, &b.a, &set, out);
        check_ok(op->run(&call, op));
        for (int64_t i = 0; i < oc_length(op, dim, set.n); i++) assert_true(out[i] == 0.0);
      }
      check_ok(sph_viscosity_bulk(b.list, b.kernel, &b.a, &k, more, out));
      for (int64_t i = 0; i < set.n; i++) assert_true(more[i] == 0.0);
      end(&b);
    }
}

/* Receding particles feel no artificial viscosity, bulk viscosity needs div v < 0. */
static void test_expansion(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) {
    bench b = begin(dim, SPH_KERNEL_CUBIC_SPLINE, SPH_H_MAX, 1.2, 7);
    sph_bulk_viscosity k = oc_bulk(15);
    memcpy(set.v, set.x, sizeof set.v);
    check_ok(sph_viscosity_monaghan(b.list, b.kernel, &b.a, 1.0, 2.0, out));
    for (int64_t i = 0; i < set.n * dim; i++) assert_true(out[i] == 0.0);
    check_ok(sph_viscosity_bulk(b.list, b.kernel, &b.a, &k, more, out));
    for (int64_t i = 0; i < set.n * dim; i++) assert_true(out[i] == 0.0 && more[i / dim] == 0.0);
    end(&b);
  }
}

/* --- invariance --------------------------------------------------------------------------------
 */

/* Velocities on a grid of 2^-20, so that the shift is exact and the bits must stay. */
static void test_galilean(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) {
    bench b = begin(dim, SPH_KERNEL_CUBIC_SPLINE, SPH_H_ARITHMETIC, 1.2, 7);
    b.a.gradient_matrix = set.matrix;
    for (int64_t i = 0; i < set.n * dim; i++) set.v[i] = nearbyint(set.v[i] * 0x1p20) * 0x1p-20;
    for (int k = 0; k < OC_CASES; k++) {
      oc_call call = oc_call_of(b.list, b.kernel, &b.a, &set, out);
      check_ok(oc_cases[k].run(&call, &oc_cases[k]));
      for (int64_t i = 0; i < set.n * dim; i++) set.v[i] += 1024.0;
      call.out = more;
      check_ok(oc_cases[k].run(&call, &oc_cases[k]));
      for (int64_t i = 0; i < set.n * dim; i++) set.v[i] -= 1024.0;
      assert_memory_equal(out, more, (size_t)oc_length(&oc_cases[k], dim, set.n) * sizeof *out);
    }
    end(&b);
  }
}

/* Renumbering the axes renumbers the results. */
static void test_axes(void **state) {
  (void)state;
  static double x[3 * OC_MAX], v[3 * OC_MAX], first[3 * OC_MAX];
  for (int32_t dim = 2; dim <= 3; dim++) {
    bench b = begin(dim, SPH_KERNEL_CUBIC_SPLINE, SPH_H_ARITHMETIC, 1.2, 7);
    memcpy(x, set.x, sizeof x);
    memcpy(v, set.v, sizeof v);
    check_ok(sph_viscosity_monaghan(b.list, b.kernel, &b.a, 1.0, 2.0, first));
    for (int64_t k = 0; k < set.n * dim; k++) {
      int64_t from = k / dim * dim + (k + 1) % dim;
      set.x[k] = x[dim == 2 ? from : k / 3 * 3 + (k % 3 + 1) % 3];
      set.v[k] = v[dim == 2 ? from : k / 3 * 3 + (k % 3 + 1) % 3];
    }
    check_ok(sph_neighbors_build_arrays(b.list, dim, set.n, set.x, set.h, 0.0));
    check_ok(sph_viscosity_monaghan(b.list, b.kernel, &b.a, 1.0, 2.0, out));
    for (int64_t k = 0; k < set.n * dim; k++)
      check_close(out[k], first[k / dim * dim + (k % dim + 1) % dim], 1e-11);
    end(&b);
  }
}

/* The four methods find the same pairs, so the operators agree up to the order of the sums. */
static void test_methods(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) {
    bench b = begin(dim, SPH_KERNEL_CUBIC_SPLINE, SPH_H_MAX, 1.2, 7 | OC_WRAP);
    for (int32_t method = 1; method <= 4; method++) {
      sph_neighbors_options o;
      sph_neighbors *list = NULL;
      sph_neighbors_options_init(&o);
      o.method = method;
      o.h_rule = SPH_H_MAX;
      o.skin = method == SPH_NEIGHBORS_VERLET ? 0.4 : 0.0;
      o.support = 2.5; /* wider than the kernel */
      o.periodic[0] = 1;
      o.box_hi[0] = set.edge;
      check_ok(sph_neighbors_create(b.ctx, &o, &list));
      check_ok(sph_neighbors_build_arrays(list, dim, set.n, set.x, set.h, 0.0));
      for (int k = 0; k < OC_CASES; k++) {
        b.a.gradient_matrix = set.matrix;
        oc_call call = oc_call_of(b.list, b.kernel, &b.a, &set, out);
        check_ok(oc_cases[k].run(&call, &oc_cases[k]));
        call.list = list;
        call.out = more;
        check_ok(oc_cases[k].run(&call, &oc_cases[k]));
        for (int64_t i = 0; i < oc_length(&oc_cases[k], dim, set.n); i++)
          check_close(more[i], out[i], 1e-11);
      }
      sph_neighbors_destroy(list);
    }
    end(&b);
  }
}

/* --- odd places --------------------------------------------------------------------------------
 */

static void expect_finite(int64_t n, const oc_case *op) {
  for (int64_t k = 0; k < n; k++)
    if (!isfinite(out[k]))
      fail_msg("%s form %d, %d-D: value %lld is %g", op->name, (int)op->form, (int)set.dim,
               (long long)k, out[k]);
}

static void test_coincident(void **state) {
  (void)state;
  for (int32_t isa = SPH_ISA_PORTABLE; isa <= SPH_ISA_AVX512; isa++)
    for (int32_t dim = 1; dim <= 3; dim++)
      for (int32_t type = 1; sph_isa_available(isa) && type <= OC_KERNELS; type++) {
        sph_context *ctx = oc_context(isa, 1);
        sph_kernel *kernel = oc_kernel(ctx, type, dim);
        sph_operands a;
        oc_make(&set, dim, dim == 1 ? 9 : dim == 2 ? 3 : 2, 1.5, 7, 61);
        memcpy(set.x + dim, set.x, sizeof(double) * (size_t)dim); /* 0 and 1 in one place */
        for (int k = 0; k < dim; k++) set.x[3 * dim + k] = set.x[2 * dim + k] + 1e-160;
        sph_neighbors *list = oc_list(ctx, &set, kernel, SPH_H_ARITHMETIC);
        oc_operands(&set, 1, &a);
        for (int k = 0; k < OC_CASES; k++) {
          oc_call call = oc_call_of(list, kernel, &a, &set, out);
          check_ok(oc_cases[k].run(&call, &oc_cases[k]));
          expect_finite(oc_length(&oc_cases[k], dim, set.n), &oc_cases[k]);
        }
        /* the gradient between the two is zero: the pair alone gives no force */
        a.n = 2;
        check_ok(sph_neighbors_build_arrays(list, dim, 2, set.x, set.h, 0.0));
        check_ok(sph_pressure_gradient(list, kernel, &a, SPH_PRESSURE_MASS, out));
        for (int k = 0; k < 2 * dim; k++) assert_true(out[k] == 0.0);
        check_ok(sph_density_summation(list, kernel, &a, out));
        double h = 0.5 * (set.h[0] + set.h[1]);
        check_rel(out[0],
                  set.m[0] * sph_kernel_w(kernel, 0.0, set.h[0]) +
                      set.m[1] * sph_kernel_w(kernel, 0.0, h),
                  1e-13);
        sph_neighbors_destroy(list);
        sph_kernel_destroy(kernel);
        sph_context_destroy(ctx);
      }
}

/* One particle at 1e30: alone there, and the others as without it. */
static void test_far_particle(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) {
    bench b = begin(dim, SPH_KERNEL_CUBIC_SPLINE, SPH_H_ARITHMETIC, 1.2, 7);
    int64_t last = set.n - 1;
    b.a.gradient_matrix = set.matrix;
    set.x[last * dim] = 1e30;
    for (int k = 0; k < OC_CASES; k++) {
      int64_t length = oc_length(&oc_cases[k], dim, set.n);
      b.a.n = set.n;
      check_ok(sph_neighbors_build_arrays(b.list, dim, set.n, set.x, set.h, 0.0));
      oc_call call = oc_call_of(b.list, b.kernel, &b.a, &set, out);
      check_ok(oc_cases[k].run(&call, &oc_cases[k]));
      expect_finite(length, &oc_cases[k]);
      b.a.n = last;
      check_ok(sph_neighbors_build_arrays(b.list, dim, last, set.x, set.h, 0.0));
      call.out = more;
      check_ok(oc_cases[k].run(&call, &oc_cases[k]));
      for (int64_t i = 0; i < oc_length(&oc_cases[k], dim, last); i++)
        check_close(more[i], out[i], 1e-11);
    }
    end(&b);
  }
}

/* Particles without neighbours: only the sums that count the particle itself remain. */
static void test_lonely(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) {
    bench b = begin(dim, SPH_KERNEL_CUBIC_SPLINE, SPH_H_ARITHMETIC, 1.2, 7);
    int64_t fallbacks = 0;
    double w0 = sph_kernel_w(b.kernel, 0.0, set.h[0]);
    b.a.n = 1;
    b.a.gradient_matrix = set.matrix;
    check_ok(sph_neighbors_build_arrays(b.list, dim, 1, set.x, set.h, 0.0));
    for (int k = 0; k < OC_CASES; k++) {
      const oc_case *op = &oc_cases[k];
      oc_call call = oc_call_of(b.list, b.kernel, &b.a, &set, out);
      check_ok(op->run(&call, op));
      double want = 0.0;
      if (strcmp(op->name, "density") == 0) want = set.m[0] * w0;
      if (strcmp(op->name, "shepard") == 0) want = set.m[0] / set.rho[0] * w0;
      if (strncmp(op->name, "interpolate", 11) == 0) continue;
      for (int64_t i = 0; i < oc_length(op, dim, 1); i++) check_rel(out[i], want, 1e-14);
    }
    check_ok(sph_interpolate(b.list, b.kernel, &b.a, 1, 6, set.f, out));
    for (int k = 0; k < 6; k++) check_rel(out[k], set.f[k], 1e-14);
    check_ok(sph_gradient_matrix(b.list, b.kernel, &b.a, out, more, &fallbacks));
    assert_int_equal(fallbacks, 1);
    for (int k = 0; k < dim * dim; k++) {
      assert_true(out[k] == (k % (dim + 1) == 0 ? 1.0 : 0.0));
      assert_true(more[k] == 0.0);
    }
    end(&b);
  }
}

/* Particles on a line in 2-D and 3-D, on a plane in 3-D: the identity is stored and counted. */
static void test_fallbacks(void **state) {
  (void)state;
  for (int32_t dim = 2; dim <= 3; dim++)
    for (int32_t flat = 1; flat < dim; flat++) {
      bench b = begin(dim, SPH_KERNEL_CUBIC_SPLINE, SPH_H_ARITHMETIC, 1.2, 0);
      int64_t fallbacks = 0;
      for (int64_t i = 0; i < set.n; i++)
        for (int32_t a = dim - flat; a < dim; a++) set.x[i * dim + a] = 1.0;
      check_ok(sph_neighbors_build_arrays(b.list, dim, set.n, set.x, set.h, 0.0));
      check_ok(sph_gradient_matrix(b.list, b.kernel, &b.a, out, NULL, &fallbacks));
      assert_int_equal(fallbacks, set.n);
      for (int64_t k = 0; k < set.n * dim * dim; k++)
        assert_true(out[k] == (k % (dim * dim) % (dim + 1) == 0 ? 1.0 : 0.0));
      end(&b);
    }
}

/* Neighbours on two axes with volumes 1 and e: B_0 is proportional to diag(1, e), of condition
 * number e + 1/e; beyond 1000 the identity is stored. */
static void test_condition_limit(void **state) {
  (void)state;
  const double x[6] = {0, 0, 1, 0, 0, 1};
  sph_context *ctx = oc_context(SPH_ISA_AUTO, 1);
  sph_kernel *kernel = oc_kernel(ctx, SPH_KERNEL_CUBIC_SPLINE, 2);
  sph_neighbors *list = NULL;
  check_ok(sph_neighbors_create(ctx, NULL, &list));
  check_ok(sph_neighbors_build_arrays(list, 2, 3, x, NULL, 1.0));
  for (int beyond = 0; beyond < 2; beyond++) {
    const double m[3] = {1.0, 1.0, beyond ? 1.0 / 1000.5 : 1.0 / 999.5};
    double inverse[12], matrix[12], leg = -sph_kernel_dwdr(kernel, 1.0, 1.0);
    sph_operands a;
    sph_operands_init(&a);
    a.dim = 2;
    a.n = 3;
    a.rows = 1;
    a.x = x;
    a.m = m;
    a.h0 = a.rho0 = 1.0;
    int64_t fallbacks = -1;
    check_ok(sph_gradient_matrix(list, kernel, &a, inverse, matrix, &fallbacks));
    assert_int_equal(fallbacks, beyond);
    check_rel(matrix[0], leg, 1e-14);
    check_rel(matrix[3], m[2] * leg, 1e-14);
    check_rel(inverse[0], beyond ? 1.0 : 1.0 / leg, 1e-14);
    check_rel(inverse[3], beyond ? 1.0 : 1.0 / (m[2] * leg), 1e-14);
    assert_true(inverse[1] == 0.0 && inverse[2] == 0.0);
  }
  sph_neighbors_destroy(list);
  sph_kernel_destroy(kernel);
  sph_context_destroy(ctx);
}

/* --- order -------------------------------------------------------------------------------------
 */

/* Error of the corrected gradient of sin(x) on a periodic lattice of n particles, h = 1.5 spacings.
 */
static double sine_error(int64_t n) {
  const double period = 2.0 * acos(-1.0), spacing = period / (double)n;
  sph_context *ctx = oc_context(SPH_ISA_AUTO, 1);
  sph_kernel *kernel = oc_kernel(ctx, SPH_KERNEL_CUBIC_SPLINE, 1);
  sph_neighbors_options o;
  sph_neighbors *list = NULL;
  sph_operands a;
  double largest = 0.0;
  sph_neighbors_options_init(&o);
  o.periodic[0] = 1;
  o.box_hi[0] = period;
  check_ok(sph_neighbors_create(ctx, &o, &list));
  for (int64_t i = 0; i < n; i++) {
    set.x[i] = (double)i * spacing;
    set.f[i] = sin(set.x[i]);
  }
  sph_operands_init(&a);
  a.dim = 1;
  a.n = n;
  a.x = set.x;
  a.h0 = 1.5 * spacing;
  a.m0 = spacing;
  a.rho0 = 1.0;
  check_ok(sph_neighbors_build_arrays(list, 1, n, set.x, NULL, a.h0));
  check_ok(sph_gradient_matrix(list, kernel, &a, set.matrix, NULL, NULL));
  a.gradient_matrix = set.matrix;
  check_ok(sph_gradient(list, kernel, &a, SPH_GRADIENT_DIFFERENCE, 1, set.f, out));
  for (int64_t i = 0; i < n; i++) largest = fmax(largest, fabs(out[i] - cos(set.x[i])));
  sph_neighbors_destroy(list);
  sph_kernel_destroy(kernel);
  sph_context_destroy(ctx);
  return largest;
}

static void test_order(void **state) {
  (void)state;
  double coarse = sine_error(40), middle = sine_error(80), fine = sine_error(160);
  check_close(log2(coarse / middle), 2.0, 0.02);
  check_close(log2(middle / fine), 2.0, 0.01);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_momentum),
    cmocka_unit_test(test_antisymmetric_bits),
    cmocka_unit_test(test_energy),
    cmocka_unit_test(test_viscosity_dissipates),
    cmocka_unit_test(test_linear),
    cmocka_unit_test(test_constants),
    cmocka_unit_test(test_expansion),
    cmocka_unit_test(test_galilean),
    cmocka_unit_test(test_axes),
    cmocka_unit_test(test_methods),
    cmocka_unit_test(test_coincident),
    cmocka_unit_test(test_far_particle),
    cmocka_unit_test(test_lonely),
    cmocka_unit_test(test_fallbacks),
    cmocka_unit_test(test_condition_limit),
    cmocka_unit_test(test_order),
};
SPH_TEST_MAIN(tests)
