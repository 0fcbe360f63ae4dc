/* Operators with one h a particle, with handles that are NULL or of another kind, and with each
 * required pointer NULL. */
#include "../smoothed_help.h"

static sm_particles set;
static double out[9 * OC_MAX];

typedef struct setup {
  sph_context *ctx;
  sph_kernel *kernel;
  sph_neighbors *list;
  sph_operands a;
} setup;

static setup open_setup(void) {
  setup s = {0};
  sm_make(&set, 2, OC_VARY_M | OC_VARY_H, 3.0, 1);
  s.ctx = oc_context(SPH_ISA_AUTO, 1);
  s.kernel = oc_kernel(s.ctx, SPH_KERNEL_GAUSSIAN, 2);
  set.kernel = s.kernel;
  s.list = sm_list(s.ctx, &set);
  sm_operands(&set, &s.a);
  return s;
}

static void close_setup(setup *s) {
  sph_neighbors_destroy(s->list);
  sph_kernel_destroy(s->kernel);
  sph_context_destroy(s->ctx);
}

/* Every operator with these handles and operands; `with`: whether it gets an output. */
static void all(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *a, int with,
                sph_status want) {
  double *o = with ? out : NULL;
  check_status(sph_smoothed_density(list, kernel, a, SPH_SMOOTHING_MASS, o), want);
  check_status(sph_grad_h(list, kernel, a, SPH_SMOOTHING_MASS, 0.0, o), want);
  check_status(sph_smoothed_pressure(list, kernel, a, SPH_SMOOTHING_MASS, o, NULL, NULL), want);
  check_status(sph_smoothed_stress(list, kernel, a, o, NULL, NULL), want);
  check_status(sph_smoothed_dissipation(list, kernel, a, NULL, o, NULL, NULL), want);
}

static void test_pointers(void **state) {
  (void)state;
  setup s = open_setup();
  all(s.list, s.kernel, &s.a, 1, SPH_OK);
  all(NULL, s.kernel, &s.a, 1, SPH_ERR_ARG);
  all(s.list, NULL, &s.a, 1, SPH_ERR_ARG);
  all(s.list, s.kernel, NULL, 1, SPH_ERR_ARG);
  all(s.list, s.kernel, &s.a, 0, SPH_ERR_ARG);
  assert_non_null(strstr(sph_context_last_error(s.ctx), "output is NULL"));
  close_setup(&s);
}

static void test_handles(void **state) {
  (void)state;
  setup s = open_setup();
  sph_particles *particles = NULL;
  check_ok(sph_particles_create(s.ctx, NULL, &particles));
  void *const other[] = {s.ctx, s.kernel, s.list, particles};
  for (int k = 0; k < 4; k++) {
    if (other[k] != (void *)s.list)
      all((sph_neighbors *)other[k], s.kernel, &s.a, 1, SPH_ERR_HANDLE);
    if (other[k] != (void *)s.kernel)
      all(s.list, (const sph_kernel *)other[k], &s.a, 1, SPH_ERR_HANDLE);
  }
  sph_particles_destroy(particles);
  close_setup(&s);
}

static void test_init(void **state) {
  (void)state;
  struct {
    sph_dissipation z;
    unsigned char behind[16];
  } o;
  sph_dissipation_init_sized(NULL, sizeof o.z);
  memset(&o, 0xaa, sizeof o);
  sph_dissipation_init(&o.z);
  assert_int_equal(o.z.size, sizeof o.z);
  assert_true(o.z.viscosity == 1.0 && o.z.conductivity == 0.1 && o.z.mass_flux == 0.5);
  assert_true(o.z.viscosity_b == 2.0 && o.z.conductivity_b == 2.0 && o.z.mass_flux_b == 2.0);
  assert_true(o.z.flux_limit == 0.1);
  assert_int_equal(o.z.signal, SPH_SIGNAL_SOUND);
  assert_int_equal(o.z.conductivity_form, SPH_CONDUCTIVITY_SIGNAL);
  assert_int_equal(o.z.pairs, SPH_PAIRS_APPROACHING);
  assert_int_equal(o.z.flux_form, SPH_FLUX_SIGNED);
  for (int k = 0; k < 16; k++) assert_true(o.behind[k] == 0xaa);
  sph_dissipation_init_sized(&o.z, sizeof o);
  for (int k = 0; k < 16; k++) assert_true(o.behind[k] == 0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_pointers), cmocka_unit_test(test_handles), cmocka_unit_test(test_init)};
SPH_TEST_MAIN(tests)
