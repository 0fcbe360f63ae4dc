/* Checkpoints of the schemes for solids with a handle that is NULL or of another kind, and without
 * buffer. (Shocks: test_null_shocks.) */
#include "../solid_help.h"

static void refuse(sph_status got, sph_status want) { check_status(got, want); }

static void test_elastic(void **state) {
  (void)state;
  static const int64_t side[2] = {5, 4};
  sph_context *ctx = rh_context(1);
  solid s = so_block(ctx, 2, side, 0.0);
  sph_elastodynamics_options o = so_options(2);
  double buffer[2048];
  size_t bytes;
  so_start(&s, &o);
  void *wrong[] = {NULL, ctx, s.set, s.hooke};
  for (int k = 0; k < 4; k++) {
    const sph_status want = k == 0 ? SPH_ERR_ARG : SPH_ERR_HANDLE;
    refuse(sph_elastodynamics_state_size(wrong[k], &bytes), want);
    refuse(sph_elastodynamics_save(wrong[k], buffer, sizeof buffer), want);
    refuse(sph_elastodynamics_restore(wrong[k], buffer, sizeof buffer), want);
  }
  refuse(sph_elastodynamics_state_size(s.scheme, NULL), SPH_ERR_ARG);
  refuse(sph_elastodynamics_save(s.scheme, NULL, sizeof buffer), SPH_ERR_ARG);
  check_ok(sph_elastodynamics_save(s.scheme, buffer, sizeof buffer)); /* still alive */
  refuse(sph_elastodynamics_restore(s.scheme, NULL, sizeof buffer), SPH_ERR_ARG);
  check_ok(sph_elastodynamics_restore(s.scheme, buffer, sizeof buffer));
  so_free(&s);
  sph_context_destroy(ctx);
}

static void test_total_lagrangian(void **state) {
  (void)state;
  static const int64_t side[2] = {5, 4};
  sph_context *ctx = rh_context(1);
  solid s = so_block(ctx, 2, side, 0.0);
  sph_total_lagrangian_options o;
  sph_hyperelastic_options h;
  sph_material *law = NULL;
  sph_total_lagrangian *tl = NULL;
  double buffer[2048];
  size_t bytes;
  sph_hyperelastic_options_init(&h);
  h.young = h.density = 1.0;
  h.reduction = SPH_PLANE_STRAIN;
  check_ok(sph_material_create_hyperelastic(ctx, &h, &law));
  sph_total_lagrangian_options_init(&o);
  o.dim = 2;
  check_ok(sph_total_lagrangian_create(ctx, &o, law, &tl));
  refuse(sph_total_lagrangian_state_size(tl, s.set, &bytes), SPH_ERR_STATE);
  check_ok(sph_total_lagrangian_start(tl, s.set));
  void *wrong[] = {NULL, ctx, law};
  for (int k = 0; k < 3; k++) {
    const sph_status want = k == 0 ? SPH_ERR_ARG : SPH_ERR_HANDLE;
    refuse(sph_total_lagrangian_state_size(wrong[k], s.set, &bytes), want);
    refuse(sph_total_lagrangian_state_size(tl, wrong[k], &bytes), want);
    refuse(sph_total_lagrangian_save(wrong[k], s.set, buffer, sizeof buffer), want);
    refuse(sph_total_lagrangian_save(tl, wrong[k], buffer, sizeof buffer), want);
    refuse(sph_total_lagrangian_restore(wrong[k], s.set, buffer, sizeof buffer), want);
    refuse(sph_total_lagrangian_restore(tl, wrong[k], buffer, sizeof buffer), want);
  }
  refuse(sph_total_lagrangian_state_size(tl, s.set, NULL), SPH_ERR_ARG);
  refuse(sph_total_lagrangian_save(tl, s.set, NULL, sizeof buffer), SPH_ERR_ARG);
  check_ok(sph_total_lagrangian_save(tl, s.set, buffer, sizeof buffer)); /* still alive */
  refuse(sph_total_lagrangian_restore(tl, s.set, NULL, sizeof buffer), SPH_ERR_ARG);
  check_ok(sph_total_lagrangian_restore(tl, s.set, buffer, sizeof buffer));
  sph_total_lagrangian_destroy(tl);
  sph_material_destroy(law);
  so_free(&s);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_elastic),
    cmocka_unit_test(test_total_lagrangian),
};
SPH_TEST_MAIN(tests)
