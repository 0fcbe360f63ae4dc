/* Operators with one h a particle against plain references: every smoothing, dimension, kernel,
 * choice of the dissipation, instruction set; and the composed right-hand side against them. */
#include "../smoothed_help.h"

static sm_particles set;
static sm_out want;
static double got[SM_OUTPUTS][9 * OC_MAX];

typedef struct machine {
  sph_context *ctx;
  sph_kernel *kernel;
  sph_neighbors *list;
} machine;

static machine make_machine(int32_t isa, int32_t type) {
  machine m = {0};
  m.ctx = oc_context(isa, 1);
  m.kernel = oc_kernel(m.ctx, type, set.s.dim);
  set.kernel = m.kernel;
  m.list = sm_list(m.ctx, &set);
  return m;
}

static void free_machine(machine *m) {
  sph_neighbors_destroy(m->list);
  sph_kernel_destroy(m->kernel);
  sph_context_destroy(m->ctx);
}

static double largest(const double *a, int64_t n) {
  double most = 0.0;
  for (int64_t k = 0; k < n; k++) most = fmax(most, a[k]);
  return most;
}

/* In the tails of kernels such as exp(1/(q^2 - 1)) the last digit of q decides: what is 1e-15 of
 * the largest contribution is not looked at. */
static void expect(int what, int64_t length, const char *name, int32_t isa) {
  double least = 1e-15 * largest(want.bound[what], length);
  for (int64_t k = 0; k < length; k++)
    if (!(fabs(got[what][k] - want.value[what][k]) <= 1e-12 * (want.bound[what][k] + least)))
      fail_msg("%s, %d-D, %s, output %d: value %lld is %.17g, expected %.17g, bound %.3g", name,
               (int)set.s.dim, sph_isa_name(isa), what, (long long)k, got[what][k],
               want.value[what][k], want.bound[what][k]);
  assert_true(got[what][length] == 4.25); /* nothing behind the results */
}

static void mark(void) {
  for (int k = 0; k < SM_OUTPUTS; k++)
    for (int64_t i = 0; i < 9 * OC_MAX; i++) got[k][i] = 4.25;
}

/* --- gathers ------------------------------------------------------------------------------- */

static void check_gathers(const machine *m, int32_t isa, int32_t smoothing, const char *name) {
  sph_operands a;
  const int64_t n = set.s.n;
  sm_operands(&set, &a);
  mark();
  if (smoothing != SPH_SMOOTHING_VOLUME) {
    sm_density(&set, smoothing, want.value[SM_RHO]);
    memcpy(want.bound[SM_RHO], want.value[SM_RHO], (size_t)n * sizeof(double));
    check_ok(sph_smoothed_density(m->list, m->kernel, &a, smoothing, got[SM_RHO]));
    expect(SM_RHO, n, name, isa);
  }
  sm_omega(&set, smoothing, want.value[SM_E], want.bound[SM_E]);
  check_ok(sph_grad_h(m->list, m->kernel, &a, smoothing, 0.0, got[SM_E]));
  expect(SM_E, n, name, isa);
  check_ok(sph_grad_h(m->list, m->kernel, &a, smoothing, 0.9, got[SM_E]));
  for (int64_t i = 0; i < n; i++) want.value[SM_E][i] = fmax(want.value[SM_E][i], 0.9);
  expect(SM_E, n, name, isa);
}

/* --- forces -------------------------------------------------------------------------------- */

static void check_pressure(const machine *m, int32_t isa, int32_t smoothing, const char *name) {
  sph_operands a;
  sm_operands(&set, &a);
  sm_clear(&want);
  sm_each_pair(&set, sm_pressure_pair, &smoothing, &want);
  mark();
  check_ok(
      sph_smoothed_pressure(m->list, m->kernel, &a, smoothing, got[SM_RHO], got[SM_V], got[SM_E]));
  expect(SM_RHO, set.s.n, name, isa);
  expect(SM_V, set.s.n * set.s.dim, name, isa);
  expect(SM_E, set.s.n, name, isa);
}

static void check_stress(const machine *m, int32_t isa, const char *name) {
  sph_operands a;
  sm_operands(&set, &a);
  sm_clear(&want);
  sm_each_pair(&set, sm_stress_pair, NULL, &want);
  mark();
  check_ok(sph_smoothed_stress(m->list, m->kernel, &a, got[SM_V], got[SM_E], got[SM_L]));
  expect(SM_V, set.s.n * set.s.dim, name, isa);
  expect(SM_E, set.s.n, name, isa);
  expect(SM_L, set.s.n * set.s.dim * set.s.dim, name, isa);
}

static void check_dissipation(const machine *m, int32_t isa, const sph_dissipation *z,
                              const char *name) {
  sph_operands a;
  sm_operands(&set, &a);
  sm_clear(&want);
  sm_each_pair(&set, sm_dissipation_pair, z, &want);
  sm_cut(&set, z->flux_limit, &want);
  mark();
  check_ok(sph_smoothed_dissipation(m->list, m->kernel, &a, z, got[SM_RHO], got[SM_V], got[SM_E]));
  expect(SM_RHO, set.s.n, name, isa);
  expect(SM_V, set.s.n * set.s.dim, name, isa);
  expect(SM_E, set.s.n, name, isa);
}

/* Bit k of `choice` takes the second of a choice's two. */
static sph_dissipation dissipation(unsigned choice) {
  sph_dissipation z;
  sph_dissipation_init(&z);
  z.viscosity = 1.1;
  z.viscosity_b = 1.9;
  z.conductivity = choice & 16 ? 0.0 : 0.3;
  z.conductivity_b = 1.7;
  z.mass_flux = choice & 32 ? 0.0 : 0.7;
  z.mass_flux_b = 2.3;
  z.signal = choice & 1 ? SPH_SIGNAL_GENERAL : SPH_SIGNAL_SOUND;
  z.conductivity_form = choice & 2 ? SPH_CONDUCTIVITY_PRESSURE : SPH_CONDUCTIVITY_SIGNAL;
  z.pairs = choice & 4 ? SPH_PAIRS_ALL : SPH_PAIRS_APPROACHING;
  z.flux_form = choice & 8 ? SPH_FLUX_POSITIVE : SPH_FLUX_SIGNED;
  z.flux_limit = choice & 64 ? 0.05 : 0.0;
  return z;
}

static void check_all(int32_t isa, int32_t type, const char *name) {
  if (!sph_isa_available(isa)) return;
  machine m = make_machine(isa, type);
  sph_dissipation z = dissipation((unsigned)(type + 64 * (set.s.dim % 2)));
  for (int32_t smoothing = 1; smoothing <= 3; smoothing++) {
    check_gathers(&m, isa, smoothing, name);
    check_pressure(&m, isa, smoothing, name);
  }
  check_stress(&m, isa, name);
  check_dissipation(&m, isa, &z, name);
  free_machine(&m);
}

static double support_of(int32_t type) {
  sph_context *ctx = oc_context(SPH_ISA_AUTO, 1);
  sph_kernel *kernel = oc_kernel(ctx, type, 1);
  double support = sph_kernel_support(kernel);
  sph_kernel_destroy(kernel);
  sph_context_destroy(ctx);
  return support;
}

static void test_every_kernel(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int32_t type = 1; type <= OC_KERNELS; type++) {
      sm_make(&set, dim, OC_VARY_M | OC_VARY_H | OC_VARY_C, support_of(type),
              (uint64_t)(100 * dim + type));
      for (int32_t isa = SPH_ISA_PORTABLE; isa <= SPH_ISA_AVX512; isa++)
        check_all(isa, type, sph_kernel_name(type));
    }
}

/* Equal masses, equal h (any rule will do), periodic boxes. */
static void test_every_flavour(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (uint32_t flavour = 0; flavour < 32; flavour += flavour < 8 ? 1 : 4) {
      sm_make(&set, dim, flavour, 3.0, flavour + 1);
      check_all(SPH_ISA_PORTABLE, SPH_KERNEL_GAUSSIAN, "flavour");
      check_all(SPH_ISA_AVX512, SPH_KERNEL_GAUSSIAN, "flavour");
    }
}

static void test_every_dissipation(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) {
    sm_make(&set, dim, OC_VARY_M | OC_VARY_H | OC_VARY_C, 3.0, 5);
    for (int32_t isa = SPH_ISA_PORTABLE; isa <= SPH_ISA_AVX512; isa++) {
      if (!sph_isa_available(isa)) continue;
      machine m = make_machine(isa, SPH_KERNEL_GAUSSIAN);
      for (unsigned choice = 0; choice < 128; choice += dim == 1 ? 1 : 9) {
        sph_dissipation z = dissipation(choice);
        check_dissipation(&m, isa, &z, "dissipation");
      }
      free_machine(&m);
    }
  }
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(test_every_kernel),
                                          cmocka_unit_test(test_every_flavour),
                                          cmocka_unit_test(test_every_dissipation)};
SPH_TEST_MAIN(tests)
