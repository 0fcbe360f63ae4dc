/* Checkpoints of the schemes for solids: a run that is taken up by another scheme on another set
 * goes on bit for bit; what is damaged or of another run is refused. (Shocks: test_shocks_state.)
 */
#include "../solid_help.h"

#include "../oom.h"

static void *room(size_t bytes) {
  void *buffer = malloc(bytes);
  assert_non_null(buffer);
  return buffer;
}

static void same(sph_particles *a, sph_particles *b, int32_t field) {
  const size_t bytes = (size_t)(sph_particles_count(a) * sph_particles_components(a, field)) * 8;
  assert_memory_equal(sph_particles_field_const(a, field), sph_particles_field_const(b, field),
                      bytes);
}

/* ---- elastodynamics ---------------------------------------------------------------------- */

static const int64_t sides[4][3] = {{0}, {40}, {9, 8}, {5, 4, 6}};

static void elastic_steps(solid *s, int count) {
  for (int k = 0; k < count; k++) {
    double dt;
    check_ok(sph_elastodynamics_stable_dt(s->scheme, &dt));
    check_ok(sph_elastodynamics_step(s->scheme, dt, NULL));
  }
}

static void check_elastic(int32_t dim, const sph_elastodynamics_options *o) {
  sph_context *first = rh_context(1), *second = rh_context(2);
  solid a = so_block(first, dim, sides[dim], 0.1), b = so_block(second, dim, sides[dim], 0.3);
  size_t bytes;
  so_stir(&a, 0.01);
  so_start(&a, o);
  elastic_steps(&a, 4);
  check_ok(sph_elastodynamics_state_size(a.scheme, &bytes));
  void *buffer = room(bytes);
  check_ok(sph_elastodynamics_save(a.scheme, buffer, bytes));
  elastic_steps(&a, 4);
  check_ok(sph_elastodynamics_create(second, b.set, o, &b.scheme));
  check_ok(sph_elastodynamics_set_material(b.scheme, 0, b.hooke));
  check_ok(sph_elastodynamics_restore(b.scheme, buffer, bytes));
  elastic_steps(&b, 4);
  static const int32_t fields[] = {SPH_FIELD_X, SPH_FIELD_V,   SPH_FIELD_SIGMA,
                                   SPH_FIELD_H, SPH_FIELD_RHO, SPH_FIELD_C};
  for (int k = 0; k < 6; k++) same(a.set, b.set, fields[k]);
  const sph_elastodynamics_ledger la = so_ledger(&a), lb = so_ledger(&b);
  assert_memory_equal(&la, &lb, sizeof la);
  free(buffer);
  so_free(&a);
  so_free(&b);
  sph_context_destroy(first);
  sph_context_destroy(second);
}

static void test_elastic(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int32_t law = SPH_H_LAW_CONSTANT; law <= SPH_H_LAW_SPACING; law++)
      for (int32_t rule = SPH_STAGES_CFL; rule <= SPH_STAGES_POWER; rule += 2) {
        sph_elastodynamics_options o = so_options(dim);
        o.h_law = law;
        o.density = SPH_DENSITY_CONTINUITY;
        o.stage_rule = rule;
        o.audit = rule == SPH_STAGES_CFL;
        o.position_field = law == SPH_H_LAW_CONSTANT ? SPH_FIELD_X0 : SPH_FIELD_X;
        check_elastic(dim, &o);
      }
}

static void refused(sph_context *ctx, sph_status got, const char *words) {
  check_status(got, SPH_ERR_ARG);
  if (strstr(sph_context_last_error(ctx), words) == NULL)
    fail_msg("\"%s\" is not in \"%s\"", words, sph_context_last_error(ctx));
}

static void test_elastic_refused(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  solid s = so_block(ctx, 2, sides[2], 0.1);
  sph_elastodynamics_options o = so_options(2);
  size_t bytes;
  so_start(&s, &o);
  check_ok(sph_elastodynamics_state_size(s.scheme, &bytes));
  unsigned char *buffer = room(bytes);
  refused(ctx, sph_elastodynamics_save(s.scheme, buffer, bytes - 1), "bytes");
  check_ok(sph_elastodynamics_save(s.scheme, buffer, bytes));
  buffer[bytes / 2] ^= 1;
  refused(ctx, sph_elastodynamics_restore(s.scheme, buffer, bytes), "damaged");
  check_status(sph_elastodynamics_step(s.scheme, 0.1, NULL), SPH_ERR_STATE);
  check_status(sph_elastodynamics_save(s.scheme, buffer, bytes), SPH_ERR_STATE);
  buffer[bytes / 2] ^= 1;
  buffer[0] ^= 1;
  refused(ctx, sph_elastodynamics_restore(s.scheme, buffer, bytes), "no state");
  buffer[0] ^= 1;
  check_ok(sph_elastodynamics_restore(s.scheme, buffer, bytes));
  elastic_steps(&s, 1);
  free(buffer);
  so_free(&s);
  sph_context_destroy(ctx);
}

/* ---- total Lagrangian -------------------------------------------------------------------- */

typedef struct rubber {
  sph_context *ctx;
  sph_material *law;
  sph_particles *set;
  sph_total_lagrangian *tl;
  double t;
} rubber;

static sph_status make_rubber(rubber *r, sph_context *ctx, const sph_total_lagrangian_options *o) {
  sph_hyperelastic_options h;
  *r = (rubber){.ctx = ctx};
  sph_hyperelastic_options_init(&h);
  h.young = 2.0;
  h.poisson = 0.3;
  h.density = 1.0;
  h.reduction = SPH_PLANE_STRAIN;
  sph_status s = sph_material_create_hyperelastic(ctx, &h, &r->law);
  if (!s) s = sph_total_lagrangian_create(ctx, o, r->law, &r->tl);
  return s;
}

static void free_rubber(rubber *r) {
  sph_total_lagrangian_destroy(r->tl);
  sph_material_destroy(r->law);
  sph_particles_destroy(r->set);
}

/* A square of 36 particles that flies and deforms, `shift` away. */
static void fill_rubber(rubber *r, double shift) {
  sph_particles_options o;
  double *x, *v, *m, *rho;
  sph_particles_options_init(&o);
  o.dim = 2;
  check_ok(sph_particles_create(r->ctx, &o, &r->set));
  check_ok(sph_particles_add(r->set, 36, NULL));
  check_ok(sph_particles_field(r->set, SPH_FIELD_X, &x));
  check_ok(sph_particles_field(r->set, SPH_FIELD_V, &v));
  check_ok(sph_particles_field(r->set, SPH_FIELD_M, &m));
  check_ok(sph_particles_field(r->set, SPH_FIELD_RHO, &rho));
  for (int i = 0; i < 36; i++) {
    x[2 * i] = i % 6 + shift;
    x[2 * i + 1] = i / 6;
    v[2 * i] = 0.1 * sin(x[2 * i + 1]);
    v[2 * i + 1] = 0.2 * cos(x[2 * i]);
    m[i] = rho[i] = 1.0;
  }
}

static void rubber_steps(rubber *r, int count) {
  for (int k = 0; k < count; k++, r->t += 0.1)
    check_ok(sph_total_lagrangian_step(r->tl, r->set, r->t, 0.1));
}

static void check_rubber(const sph_total_lagrangian_options *o) {
  sph_context *ctx = rh_context(1);
  rubber a, b;
  size_t bytes;
  check_ok(make_rubber(&a, ctx, o));
  fill_rubber(&a, 0.0);
  check_ok(sph_total_lagrangian_start(a.tl, a.set));
  rubber_steps(&a, 5);
  check_ok(sph_total_lagrangian_state_size(a.tl, a.set, &bytes));
  unsigned char *buffer = room(bytes);
  check_ok(sph_total_lagrangian_save(a.tl, a.set, buffer, bytes));
  check_ok(make_rubber(&b, ctx, o));
  fill_rubber(&b, 7.0);
  b.t = a.t;
  buffer[bytes - 9] ^= 4;
  refused(ctx, sph_total_lagrangian_restore(b.tl, b.set, buffer, bytes), "damaged");
  check_status(sph_total_lagrangian_step(b.tl, b.set, 0.0, 0.1), SPH_ERR_STATE);
  buffer[bytes - 9] ^= 4;
  check_ok(sph_total_lagrangian_restore(b.tl, b.set, buffer, bytes));
  rubber_steps(&a, 6);
  rubber_steps(&b, 6);
  same(a.set, b.set, SPH_FIELD_X);
  same(a.set, b.set, SPH_FIELD_V);
  free(buffer);
  free_rubber(&a);
  free_rubber(&b);
  sph_context_destroy(ctx);
}

static sph_total_lagrangian_options rubber_options(int32_t integrator) {
  sph_total_lagrangian_options o;
  sph_total_lagrangian_options_init(&o);
  o.dim = 2;
  o.integrator = integrator;
  o.alpha = 0.5; /* so that the carried acceleration is not the one of the new velocity */
  return o;
}

static void test_rubber(void **state) {
  (void)state;
  static const int32_t methods[] = {SPH_INTEGRATOR_LEAPFROG, SPH_INTEGRATOR_RK4,
                                    SPH_INTEGRATOR_HEUN};
  for (int k = 0; k < 3; k++) {
    sph_total_lagrangian_options o = rubber_options(methods[k]);
    check_rubber(&o);
    o.audit = methods[k] == SPH_INTEGRATOR_LEAPFROG;
    check_rubber(&o);
  }
}

/* ---- failing memory ---------------------------------------------------------------------- */

static char space[1 << 16];

static sph_status elastic_scenario(sph_context *ctx, void *user) {
  sph_elastodynamics_options o = so_options(2);
  size_t bytes = 0;
  (void)user;
  o.h_law = SPH_H_LAW_DENSITY;
  o.density = SPH_DENSITY_CONTINUITY;
  oom_pause();
  solid s = so_block(ctx, 2, sides[2], 0.0);
  so_start(&s, &o);
  oom_resume();
  sph_status status = sph_elastodynamics_state_size(s.scheme, &bytes);
  if (!status) status = sph_elastodynamics_save(s.scheme, space, sizeof space);
  if (!status) status = sph_elastodynamics_restore(s.scheme, space, sizeof space);
  oom_pause();
  so_free(&s);
  oom_resume();
  return status;
}

static sph_status rubber_scenario(sph_context *ctx, void *user) {
  const sph_total_lagrangian_options o = rubber_options(SPH_INTEGRATOR_LEAPFROG);
  rubber r;
  size_t bytes = 0;
  (void)user;
  oom_pause();
  check_ok(make_rubber(&r, ctx, &o));
  fill_rubber(&r, 0.0);
  check_ok(sph_total_lagrangian_start(r.tl, r.set));
  oom_resume();
  sph_status s = sph_total_lagrangian_state_size(r.tl, r.set, &bytes);
  if (!s) s = sph_total_lagrangian_save(r.tl, r.set, space, sizeof space);
  if (!s) s = sph_total_lagrangian_restore(r.tl, r.set, space, sizeof space);
  oom_pause();
  free_rubber(&r);
  oom_resume();
  return s;
}

static void test_memory(void **state) {
  (void)state;
  oom_sweep(elastic_scenario, NULL);
  oom_sweep(rubber_scenario, NULL);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_elastic),
    cmocka_unit_test(test_elastic_refused),
    cmocka_unit_test(test_rubber),
    cmocka_unit_test(test_memory),
};
SPH_TEST_MAIN(tests)
