/* Composed right-hand side: what must be kept. Mass, momentum and energy balances of the terms,
 * and the balance of a driven elastic body. */
#include "../rhs_help.h"

static sph_rhs *rhs_of(const rh_system *s, const sph_term *terms, int count) {
  sph_rhs *rhs = rh_rhs(s);
  for (int k = 0; k < count; k++) check_ok(sph_rhs_add(rhs, &terms[k]));
  return rhs;
}

/* sum m_i a_i, and the sum of the sizes that it is made of. */
static double momentum(const rh_system *s, const double *a, int c, double *size) {
  const double *m = rh_field(s, SPH_FIELD_M);
  double sum = 0.0;
  *size = 0.0;
  for (int64_t i = 0; i < s->rows; i++) {
    sum += m[i] * a[i * s->dim + c];
    *size += fabs(m[i] * a[i * s->dim + c]);
  }
  return sum;
}

static void check_momentum(const rh_system *s, const sph_term *terms, int count) {
  sph_rhs *rhs = rhs_of(s, terms, count);
  double *a = rh_rates(s, rhs, SPH_FIELD_V), size;
  for (int c = 0; c < s->dim; c++) {
    double total = momentum(s, a, c, &size);
    assert_true(size > 0.1);
    check_close(total, 0.0, 1e-14 * size * (double)s->rows);
  }
  free(a);
  sph_rhs_destroy(rhs);
}

/* Uncorrected, or with the conservative correction: every pair force is antisymmetric. The
 * difference forms are left out: they do not conserve, and say so. */
static void test_momentum(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int vary = 0; vary < 2; vary++)
      for (int wrap = 0; wrap < 2; wrap++) {
        uint32_t flavour = (vary ? RH_VARY_ALL : 0) | (wrap ? RH_WRAP : 0);
        rh_system s = rh_make(ctx, dim, rh_side(dim), flavour, 21);
        sph_term elastic[3] = {rh_term(SPH_TERM_STRESS, SPH_STRESS_SUMMED, 0),
                               rh_term(SPH_TERM_MONAGHAN, 0, 0),
                               rh_term(SPH_TERM_ARTIFICIAL_STRESS, 0, 0)};
        sph_term kept = rh_term(SPH_TERM_STRESS, SPH_STRESS_CONSERVATIVE, 0);
        sph_term bulk[2] = {rh_term(SPH_TERM_BULK_VISCOSITY, 0, 0), kept};
        check_momentum(&s, elastic, 3);
        for (int k = 0; k < 3; k++) check_momentum(&s, elastic + k, 1);
        check_momentum(&s, &kept, 1);
        check_momentum(&s, bulk, 2);
        for (int32_t form = SPH_PRESSURE_MASS; form <= SPH_PRESSURE_NUMBER; form++) {
          sph_term wcsph[2] = {rh_term(SPH_TERM_PRESSURE, form, 0),
                               rh_term(SPH_TERM_MONAGHAN, 0, 0)};
          check_momentum(&s, wcsph, 2);
        }
        rh_free(&s);
      }
  sph_context_destroy(ctx);
}

/* Central forces keep the angular momentum: pressure and Monaghan's viscosity, not the stress. */
static void test_angular_momentum(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t form = SPH_PRESSURE_MASS; form <= SPH_PRESSURE_NUMBER; form++) {
    rh_system s = rh_make(ctx, 3, 6, RH_VARY_ALL, 22);
    sph_term terms[3] = {rh_term(SPH_TERM_PRESSURE, form, 0), rh_term(SPH_TERM_MONAGHAN, 0, 0),
                         rh_term(SPH_TERM_BULK_VISCOSITY, 0, 0)};
    sph_rhs *rhs = rhs_of(&s, terms, 3);
    double *a = rh_rates(&s, rhs, SPH_FIELD_V), sum = 0.0, size = 0.0;
    const double *x = rh_field(&s, SPH_FIELD_X), *m = rh_field(&s, SPH_FIELD_M);
    for (int64_t i = 0; i < s.n; i++) {
      double t = m[i] * (x[i * 3] * a[i * 3 + 1] - x[i * 3 + 1] * a[i * 3]);
      sum += t;
      size += fabs(t);
    }
    check_close(sum, 0.0, 1e-12 * size);
    free(a);
    sph_rhs_destroy(rhs);
    rh_free(&s);
  }
  sph_context_destroy(ctx);
}

/* sum m v.a + sum m p / rho^2 drho/dt = 0 to rounding when continuity and pressure have the same
 * form: the force is minus the transpose of the density rate, weighted with m p / rho^2. */
static double energy_residual(const rh_system *s, int32_t continuity, int32_t pressure,
                              double *size) {
  sph_term terms[2] = {rh_term(SPH_TERM_CONTINUITY, continuity, 0),
                       rh_term(SPH_TERM_PRESSURE, pressure, 0)};
  sph_rhs *rhs = rhs_of(s, terms, 2);
  double *a = rh_array(s->rows * s->dim), *drho = rh_array(s->rows), sum = 0.0;
  sph_rate rates[2] = {{SPH_FIELD_V, a}, {SPH_FIELD_RHO, drho}};
  const double *m = rh_field(s, SPH_FIELD_M), *v = rh_field(s, SPH_FIELD_V);
  const double *p = rh_field(s, SPH_FIELD_P), *rho = rh_field(s, SPH_FIELD_RHO);
  check_ok(sph_rhs_evaluate(rhs, s->set, s->list, 0.0, rates, 2));
  *size = 0.0;
  for (int64_t i = 0; i < s->rows; i++) {
    double work = m[i] * p[i] / (rho[i] * rho[i]) * drho[i];
    sum += work;
    *size += fabs(work);
    for (int c = 0; c < s->dim; c++) {
      double t = m[i] * v[i * s->dim + c] * a[i * s->dim + c];
      sum += t;
      *size += fabs(t);
    }
  }
  free(a);
  free(drho);
  sph_rhs_destroy(rhs);
  return sum;
}

static void test_energy(void **state) {
  (void)state;
  static const int32_t pairs[3][2] = {{SPH_CONTINUITY_MASS, SPH_PRESSURE_MASS},
                                      {SPH_CONTINUITY_VOLUME, SPH_PRESSURE_VOLUME},
                                      {SPH_CONTINUITY_NUMBER, SPH_PRESSURE_NUMBER}};
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int f = 0; f < 4; f++) {
      static const uint32_t flavours[] = {0, RH_VARY_M, RH_VARY_ALL, RH_VARY_ALL | RH_WRAP};
      rh_system s = rh_make(ctx, dim, rh_side(dim), flavours[f], 23);
      double size;
      for (int k = 0; k < 3; k++) {
        double sum = energy_residual(&s, pairs[k][0], pairs[k][1], &size);
        assert_true(size > 1.0);
        check_close(sum, 0.0, 1e-13 * size);
      }
      /* a mixed pair does not balance: the check above sees something */
      if (flavours[f] & RH_VARY_M)
        assert_true(fabs(energy_residual(&s, SPH_CONTINUITY_MASS, SPH_PRESSURE_NUMBER, &size)) >
                    1e-6 * size);
      rh_free(&s);
    }
  sph_context_destroy(ctx);
}

/* Equal masses: the mass and the number form are one. */
static void test_equal_masses(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, 12, 0, 24);
  for (int k = 0; k < 2; k++) {
    int32_t field = k ? SPH_FIELD_V : SPH_FIELD_RHO;
    sph_term mass = rh_term(k ? SPH_TERM_PRESSURE : SPH_TERM_CONTINUITY, 1, 0);
    sph_term number = rh_term(mass.kind, 3, 0);
    sph_rhs *a = rhs_of(&s, &mass, 1), *b = rhs_of(&s, &number, 1);
    int64_t n = s.rows * (k ? 2 : 1);
    double *x = rh_rates(&s, a, field), *y = rh_rates(&s, b, field), size = rh_largest(x, n);
    for (int64_t i = 0; i < n; i++) check_close(x[i], y[i], 1e-13 * size);
    free(x);
    free(y);
    sph_rhs_destroy(a);
    sph_rhs_destroy(b);
  }
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* Viscosities take energy out: sum m v.a <= 0. For Monaghan's that holds pair by pair. */
static void test_dissipation(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++)
    for (uint64_t seed = 0; seed < 5; seed++) {
      rh_system s = rh_make(ctx, dim, rh_side(dim), RH_VARY_ALL, 100 + seed);
      sph_term t = rh_term(SPH_TERM_MONAGHAN, 0, 0);
      sph_rhs *rhs = rhs_of(&s, &t, 1);
      double *a = rh_rates(&s, rhs, SPH_FIELD_V), power = 0.0;
      const double *m = rh_field(&s, SPH_FIELD_M), *v = rh_field(&s, SPH_FIELD_V);
      for (int64_t k = 0; k < s.rows * dim; k++) power += m[k / dim] * v[k] * a[k];
      assert_true(power < 0.0);
      free(a);
      sph_rhs_destroy(rhs);
      rh_free(&s);
    }
  sph_context_destroy(ctx);
}

/* A body at rest under uniform stress in a periodic lattice feels nothing; one that moves as a
 * whole has no strain rate and no viscosity. */
static void test_rest(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++) {
    int64_t side = rh_side(dim);
    rh_system s = rh_make(ctx, dim, side, RH_WRAP, 25);
    sph_term terms[4] = {rh_term(SPH_TERM_STRESS, 0, 0), rh_term(SPH_TERM_MONAGHAN, 0, 0),
                         rh_term(SPH_TERM_CONTINUITY, 0, 0), rh_term(SPH_TERM_XSPH, 0, 0)};
    sph_rhs *rhs = rhs_of(&s, terms, 4);
    double *x = rh_field(&s, SPH_FIELD_X), *v = rh_field(&s, SPH_FIELD_V);
    double *sigma = rh_field(&s, SPH_FIELD_SIGMA);
    int32_t c = sph_sym_components(dim);
    for (int64_t i = 0; i < s.n; i++) {
      for (int64_t a = 0, k = i; a < dim; a++, k /= side) {
        x[i * dim + a] = (double)(k % side) + 0.5;
        v[i * dim + a] = 3.0 - (double)a;
      }
      for (int k = 0; k < c; k++) sigma[i * c + k] = 1.0 + 0.5 * k;
    }
    rh_fill(&s, SPH_FIELD_RHO, 1.0, 1.0, 0);
    check_ok(sph_particles_touch(s.set, SPH_FIELD_X));
    double *dv = rh_array(s.n * dim), *drho = rh_array(s.n), *dx = rh_array(s.n * dim);
    sph_rate rates[3] = {{SPH_FIELD_V, dv}, {SPH_FIELD_RHO, drho}, {SPH_FIELD_X, dx}};
    check_ok(sph_rhs_evaluate(rhs, s.set, s.list, 0.0, rates, 3));
    for (int64_t k = 0; k < s.n * dim; k++) {
      check_close(dv[k], 0.0, 1e-13);
      assert_true(dx[k] == 0.0 && drho[k / dim] == 0.0);
    }
    free(dv);
    free(drho);
    free(dx);
    sph_rhs_destroy(rhs);
    rh_free(&s);
  }
  sph_context_destroy(ctx);
}

/* Corrected, the difference form takes a linear stress exactly, up to the edge of the body. */
static void test_linear_stress(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t dim = 1; dim <= 3; dim++) {
    rh_system s = rh_make(ctx, dim, rh_side(dim), RH_VARY_M, 26);
    sph_term t = rh_term(SPH_TERM_STRESS, SPH_STRESS_DIFFERENCE, 1);
    sph_rhs *rhs = rhs_of(&s, &t, 1);
    const double *x = rh_field(&s, SPH_FIELD_X), *rho = rh_field(&s, SPH_FIELD_RHO);
    double *sigma = rh_field(&s, SPH_FIELD_SIGMA);
    int32_t c = sph_sym_components(dim);
    /* sigma_k = k + sum_b (1 + k + 2 b) x_b */
    for (int64_t i = 0; i < s.n; i++)
      for (int k = 0; k < c; k++) {
        sigma[i * c + k] = (double)k;
        for (int b = 0; b < dim; b++) sigma[i * c + k] += (1.0 + k + 2.0 * b) * x[i * dim + b];
      }
    double *a = rh_rates(&s, rhs, SPH_FIELD_V);
    for (int64_t i = 0; i < s.n; i++)
      for (int k = 0; k < dim; k++) {
        double want = 0.0;
        for (int b = 0; b < dim; b++) want += 1.0 + rh_sym(dim, k, b) + 2.0 * b;
        check_rel(a[i * dim + k], want / rho[i], 1e-10);
      }
    free(a);
    sph_rhs_destroy(rhs);
    rh_free(&s);
  }
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_momentum),      cmocka_unit_test(test_angular_momentum),
    cmocka_unit_test(test_energy),        cmocka_unit_test(test_equal_masses),
    cmocka_unit_test(test_dissipation),   cmocka_unit_test(test_rest),
    cmocka_unit_test(test_linear_stress),
};
SPH_TEST_MAIN(tests)
