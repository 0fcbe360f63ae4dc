/* A quarter of a symmetric body between two planes of symmetry moves as the quarter of the whole
 * body does: every term, to rounding. */
#include "../ghost_help.h"

enum { SIDE = 7 };

/* Copy particle i of the quarter to its image about the planes in `mask` (bit a: axis a), as a real
 * particle `to` of the whole. */
static void copy_image(const rh_system *q, int64_t i, uint32_t mask, const rh_system *whole,
                       int64_t to) {
  static const int32_t scalars[] = {SPH_FIELD_M, SPH_FIELD_RHO, SPH_FIELD_H, SPH_FIELD_P,
                                    SPH_FIELD_C};
  static const int32_t vectors[] = {SPH_FIELD_X, SPH_FIELD_V, SPH_FIELD_X0};
  const int32_t d = q->dim, comps = d * (d + 1) / 2;
  for (int k = 0; k < 5; k++) rh_field(whole, scalars[k])[to] = gh_const(q, scalars[k])[i];
  for (int k = 0; k < 3; k++)
    for (int a = 0; a < d; a++)
      rh_field(whole, vectors[k])[to * d + a] =
          (mask >> a & 1 ? -1.0 : 1.0) * gh_const(q, vectors[k])[i * d + a];
  for (int a = 0; a < d; a++)
    for (int b = a; b < d; b++) {
      const int c = rh_sym(d, a, b);
      const double sign = (mask >> a & 1) != (mask >> b & 1) ? -1.0 : 1.0;
      rh_field(whole, SPH_FIELD_SIGMA)[to * comps + c] =
          sign * gh_const(q, SPH_FIELD_SIGMA)[i * comps + c];
    }
}

/* The whole body: particle i of the quarter is particle i of it. */
static rh_system make_whole(const rh_system *q) {
  rh_system w = {.ctx = q->ctx, .dim = q->dim, .n = 4 * q->rows, .rows = 4 * q->rows};
  sph_particles_options o;
  sph_particles_options_init(&o);
  o.dim = q->dim;
  check_ok(sph_particles_create(q->ctx, &o, &w.set));
  check_ok(sph_particles_add(w.set, w.n, NULL));
  check_ok(sph_kernel_create(q->ctx, SPH_KERNEL_CUBIC_SPLINE, q->dim, &w.kernel));
  check_ok(sph_neighbors_create(q->ctx, NULL, &w.list));
  for (uint32_t mask = 0; mask < 4; mask++)
    for (int64_t i = 0; i < q->rows; i++) copy_image(q, i, mask, &w, mask * q->rows + i);
  return w;
}

/* Displaced by up to a tenth of the spacing from X0, which is what it was. */
static rh_system make_quarter(sph_context *ctx, int32_t dim) {
  rh_system q = rh_make(ctx, dim, SIDE, RH_VARY_ALL, (uint64_t)(60 + dim));
  double *x0 = rh_field(&q, SPH_FIELD_X0), *x = rh_field(&q, SPH_FIELD_X);
  for (int64_t k = 0; k < q.rows * dim; k++) {
    x0[k] = x[k];
    x[k] += rh_random(-0.1, 0.1);
  }
  check_ok(sph_particles_touch(q.set, SPH_FIELD_X));
  return q;
}

static sph_ghosts *two_planes(const rh_system *q, int32_t position_field, double reach) {
  sph_ghosts *g = NULL;
  sph_ghosts_options o;
  const gh_frame frame = gh_identity();
  sph_ghosts_options_init(&o);
  o.dim = q->dim;
  o.position_field = position_field;
  o.reach = reach * rh_largest(gh_const(q, SPH_FIELD_H), q->rows);
  check_ok(sph_ghosts_create(q->ctx, &o, &g));
  for (int face = 0; face < 4; face += 2) {
    const sph_wall w = gh_wall(&frame, q->dim, SIDE, face, SPH_WALL_SLIP);
    gh_add(g, &w);
  }
  return g;
}

static sph_rhs *make_rhs(const rh_system *s, const sph_term *t, int32_t position_field) {
  sph_rhs *rhs = NULL;
  sph_rhs_options o;
  sph_material *m = NULL;
  sph_hooke_options h;
  sph_rhs_options_init(&o);
  o.position_field = position_field;
  check_ok(sph_rhs_create(s->ctx, s->kernel, &o, &rhs));
  check_ok(sph_rhs_add(rhs, t));
  sph_hooke_options_init(&h);
  h.young = h.density = 1.0;
  h.poisson = 0.3;
  h.reduction = s->dim == 2 ? SPH_PLANE_STRAIN : SPH_SOLID;
  check_ok(sph_material_create_hooke(s->ctx, &h, &m));
  check_ok(sph_rhs_set_material(rhs, 0, m));
  sph_material_destroy(m);
  return rhs;
}

static void rates_of(const rh_system *s, sph_rhs *rhs, const sph_term *t, double *out) {
  const sph_rate rate = {rh_target(t->kind), out};
  if (sph_rhs_evaluate(rhs, s->set, s->list, 0.0, &rate, 1) != SPH_OK)
    fail_msg("term %d form %d: %s", t->kind, t->form, sph_context_last_error(s->ctx));
}

/* `reach` in units of h: twice the support where the term computes something of the ghosts
 * themselves from their neighbours. */
static void check_term(int32_t dim, int32_t kind, int32_t form, int32_t corrected,
                       int32_t position_field, double reach) {
  sph_context *ctx = rh_context(1);
  rh_system q = make_quarter(ctx, dim), whole = make_whole(&q);
  const sph_term t = rh_term(kind, form, corrected);
  const int64_t comps = sph_particles_components(q.set, rh_target(kind));
  double *part = rh_array(q.rows * comps), *all = rh_array(whole.rows * comps);
  sph_ghosts *g = two_planes(&q, position_field, reach);
  sph_rhs *rhs = make_rhs(&q, &t, position_field), *other = make_rhs(&whole, &t, position_field);
  check_ok(sph_rhs_set_prepare(rhs, sph_ghosts_prepare, g));
  rates_of(&q, rhs, &t, part);
  rates_of(&whole, other, &t, all);
  const double size = rh_largest(all, q.rows * comps);
  assert_true(size > 0.0);
  for (int64_t k = 0; k < q.rows * comps; k++)
    if (!(fabs(part[k] - all[k]) <= 1e-12 * size))
      fail_msg("%d-D term %d form %d corrected %d: %.17g, whole body %.17g", dim, kind, form,
               corrected, part[k], all[k]);
  sph_rhs_destroy(other);
  sph_rhs_destroy(rhs);
  sph_ghosts_destroy(g);
  free(all);
  free(part);
  rh_free(&whole);
  rh_free(&q);
  sph_context_destroy(ctx);
}

/* In the present and in the frozen configuration, plain and corrected. */
static void test_terms(void **state) {
  (void)state;
  static const struct {
    int32_t kind, form;
  } terms[] = {{SPH_TERM_CONTINUITY, SPH_CONTINUITY_VOLUME},
               {SPH_TERM_PRESSURE, SPH_PRESSURE_MASS},
               {SPH_TERM_STRESS, SPH_STRESS_SUMMED},
               {SPH_TERM_STRESS, SPH_STRESS_DIFFERENCE},
               {SPH_TERM_STRESS_RATE, 0},
               {SPH_TERM_MONAGHAN, 0},
               {SPH_TERM_ARTIFICIAL_STRESS, 0}};
  for (int32_t dim = 2; dim <= 3; dim++)
    for (size_t k = 0; k < sizeof terms / sizeof *terms; k++)
      for (int32_t corrected = 0; corrected < 2; corrected++)
        for (int frozen = 0; frozen < 2; frozen++)
          check_term(dim, terms[k].kind, terms[k].form, corrected,
                     frozen ? SPH_FIELD_X0 : SPH_FIELD_X, 2.0);
}

/* What these read of a ghost is made from the ghost's own neighbours: gradient matrices, F. */
static void test_twice_the_reach(void **state) {
  (void)state;
  for (int32_t dim = 2; dim <= 3; dim++) {
    check_term(dim, SPH_TERM_STRESS, SPH_STRESS_CONSERVATIVE, 0, SPH_FIELD_X, 4.0);
    check_term(dim, SPH_TERM_FIRST_PIOLA, SPH_PIOLA_CONSERVATIVE, 0, SPH_FIELD_X0, 4.0);
    check_term(dim, SPH_TERM_FIRST_PIOLA, SPH_PIOLA_SUMMED, 1, SPH_FIELD_X0, 4.0);
    check_term(dim, SPH_TERM_HOURGLASS, 0, 0, SPH_FIELD_X0, 4.0);
  }
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(test_terms),
                                          cmocka_unit_test(test_twice_the_reach)};
SPH_TEST_MAIN(tests)
