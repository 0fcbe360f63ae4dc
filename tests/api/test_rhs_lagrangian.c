/* Total-Lagrangian terms of the composed right-hand side: each against its operator or a plain
 * reference, what is kept of the frozen configuration, the stress-rate way, refusals, memory. */
#include "../lagrangian_help.h"
#include "../oom.h"

static const double shear_map[3][9] = {
    {1.2}, {1.1, 0.2, -0.1, 0.95}, {1.1, 0.1, -0.05, 0.1, 0.9, 0.08, -0.1, 0.05, 1.05}};

static sph_material *rubber(sph_context *ctx, int32_t dim) {
  sph_hyperelastic_options o;
  sph_material *m = NULL;
  sph_hyperelastic_options_init(&o);
  o.young = 2.0;
  o.poisson = 0.3;
  o.density = 1.1;
  o.reduction = dim == 1 ? SPH_UNIAXIAL_STRESS : dim == 2 ? SPH_PLANE_STRAIN : SPH_SOLID;
  check_ok(sph_material_create_hyperelastic(ctx, &o, &m));
  return m;
}

static sph_material *hooke(sph_context *ctx, int32_t dim) {
  sph_hooke_options o;
  sph_material *m = NULL;
  sph_hooke_options_init(&o);
  o.young = 2.0;
  o.poisson = 0.3;
  o.density = 1.1;
  o.reduction = dim == 1 ? SPH_UNIAXIAL_STRESS : dim == 2 ? SPH_PLANE_STRAIN : SPH_SOLID;
  check_ok(sph_material_create_hooke(ctx, &o, &m));
  return m;
}

static sph_rhs *frozen_rhs(const rh_system *s, sph_material *material) {
  sph_rhs *rhs = NULL;
  sph_rhs_options o;
  sph_rhs_options_init(&o);
  o.position_field = SPH_FIELD_X0;
  check_ok(sph_rhs_create(s->ctx, s->kernel, &o, &rhs));
  check_ok(sph_rhs_set_material(rhs, 0, material));
  return rhs;
}

static void add(sph_rhs *rhs, int32_t kind, int32_t form, int32_t corrected, double alpha,
                double beta) {
  sph_term t;
  sph_term_init(&t);
  t.kind = kind;
  t.form = form;
  t.corrected = corrected;
  t.alpha = alpha;
  t.beta = beta;
  check_ok(sph_rhs_add(rhs, &t));
}

/* A deformed body whose set has X0, and current positions in X. */
static lg_body deformed(sph_context *ctx, int32_t d, uint32_t flavour) {
  lg_body b = lg_make(ctx, d, flavour, SPH_H_ARITHMETIC, 21 + (uint64_t)d);
  lg_deform(&b, shear_map[d - 1], 0.3);
  lg_shake(&b, 0.03);
  memcpy(rh_field(&b.s, SPH_FIELD_X0), b.X, (size_t)(b.s.n * d) * sizeof *b.X);
  memcpy(rh_field(&b.s, SPH_FIELD_X), b.x, (size_t)(b.s.n * d) * sizeof *b.x);
  check_ok(sph_particles_touch(b.s.set, SPH_FIELD_X0));
  check_ok(sph_particles_touch(b.s.set, SPH_FIELD_X));
  return b;
}

static double *rates(const lg_body *b, sph_rhs *rhs, int32_t field) {
  return rh_rates(&b->s, rhs, field);
}

static void same(const double *got, const double *want, int64_t n, double tol) {
  double size = rh_largest(want, n);
  assert_true(size > 1e-6);
  for (int64_t k = 0; k < n; k++) check_close(got[k], want[k], tol * size);
}

/* ---- terms ---------------------------------------------------------------------------------- */

/* F, P and force of a right-hand side against the operators one after the other. */
static void check_term(lg_body *b, sph_material *m, int32_t form, int32_t corrected, int32_t spring,
                       double alpha) {
  int d = b->s.dim;
  int64_t n = b->s.n, rows = b->rows;
  double *want = rh_array(n * d), *more = rh_array(n * d);
  sph_operands a = b->a, plain;
  sph_rhs *rhs = frozen_rhs(&b->s, m);
  check_ok(sph_deformation_gradient(b->s.list, b->s.kernel, &a, b->x, b->F));
  check_ok(sph_material_first_piola(m, d, n, b->F, b->P, NULL));
  a.rows = rows;
  plain = a;
  if (!corrected && form == SPH_PIOLA_SUMMED) plain.gradient_matrix = NULL;
  check_ok(sph_piola_divergence(b->s.list, b->s.kernel, &plain, form, b->P, want));
  add(rhs, SPH_TERM_FIRST_PIOLA, form, corrected, 0.0, 0.0);
  if (spring) {
    add(rhs, SPH_TERM_HOURGLASS, spring, 0, alpha, 0.0);
    check_ok(
        sph_hourglass_force(b->s.list, b->s.kernel, &a, spring, alpha, b->x, b->F, more, NULL));
    for (int64_t k = 0; k < rows * d; k++) want[k] += more[k];
  }
  double *got = rates(b, rhs, SPH_FIELD_V);
  same(got, want, rows * d, 1e-13);
  assert_memory_equal(rh_field(&b->s, SPH_FIELD_F), b->F, (size_t)(n * d * d) * sizeof *b->F);
  assert_memory_equal(rh_field(&b->s, SPH_FIELD_PK), b->P, (size_t)(n * d * d) * sizeof *b->P);
  free(got);
  free(want);
  free(more);
  sph_rhs_destroy(rhs);
}

static void test_terms(void **state) {
  (void)state;
  static const uint32_t flavours[4] = {0, RH_VARY_M, RH_VARY_ALL, RH_VARY_ALL | RH_GHOSTS};
  sph_context *ctx = rh_context(1);
  for (int32_t d = 1; d <= 3; d++)
    for (int f = 0; f < 4; f++) {
      sph_material *m = rubber(ctx, d);
      lg_body b = deformed(ctx, d, flavours[f]);
      for (int32_t spring = 0; spring <= 2; spring++) {
        check_term(&b, m, SPH_PIOLA_CONSERVATIVE, 0, spring, 0.4);
        check_term(&b, m, SPH_PIOLA_SUMMED, 0, spring, 0.4);
        check_term(&b, m, SPH_PIOLA_SUMMED, 1, spring, 0.4);
      }
      lg_free(&b);
      sph_material_destroy(m);
    }
  sph_context_destroy(ctx);
}

/* Uniform density and sound speed: the loops made for them give what the general ones give. */
static void test_uniform(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t d = 1; d <= 3; d++) {
    sph_material *m = rubber(ctx, d);
    lg_body b = deformed(ctx, d, 0);
    rh_fill(&b.s, SPH_FIELD_RHO, 1.3, 1.3, 0);
    check_ok(sph_gradient_matrix(b.s.list, b.s.kernel, &b.a, b.matrix, NULL, NULL));
    check_term(&b, m, SPH_PIOLA_CONSERVATIVE, 0, SPH_HOURGLASS_VARIATIONAL, 0.4);
    lg_free(&b);
    sph_material_destroy(m);
  }
  sph_context_destroy(ctx);
}

/* Viscosity in the current geometry: the plain sum; no force in a rigid motion; it only dissipates.
 */
static void test_viscosity(void **state) {
  (void)state;
  const double ab[2] = {0.8, 1.7};
  sph_context *ctx = rh_context(1);
  for (int32_t d = 1; d <= 3; d++) {
    lg_body b = deformed(ctx, d, RH_VARY_ALL);
    sph_rhs *rhs = frozen_rhs(&b.s, NULL);
    double want[3], bound[3], power = 0.0, R[9];
    add(rhs, SPH_TERM_MONAGHAN, SPH_MONAGHAN_CURRENT, 0, ab[0], ab[1]);
    double *got = rates(&b, rhs, SPH_FIELD_V), *v = rh_field(&b.s, SPH_FIELD_V);
    for (int64_t i = 0; i < b.s.n; i++) {
      lg_force(&b, lg_viscosity, ab, i, want, bound);
      for (int k = 0; k < d; k++) {
        check_close(got[i * d + k], want[k], 1e-12 * (bound[k] + 1e-6));
        power += b.a.m[i] * got[i * d + k] * v[i * d + k];
      }
    }
    assert_true(power < 0.0);
    free(got);
    lg_rotation(d, 1.3, R);
    lg_deform(&b, R, 0.0);
    double *x = rh_field(&b.s, SPH_FIELD_X);
    memcpy(x, b.x, (size_t)(b.s.n * d) * sizeof *x);
    for (int64_t i = 0; i < b.s.n; i++) { /* w x + c, w about z */
      for (int k = 0; k < d; k++) v[i * d + k] = 0.7;
      if (d == 1) continue;
      v[i * d] -= 2.0 * x[i * d + 1];
      v[i * d + 1] += 2.0 * x[i * d];
    }
    got = rates(&b, rhs, SPH_FIELD_V);
    for (int64_t k = 0; k < b.s.n * d; k++) check_close(got[k], 0.0, 1e-12);
    free(got);
    sph_rhs_destroy(rhs);
    lg_free(&b);
  }
  sph_context_destroy(ctx);
}

/* ---- the stress-rate way -------------------------------------------------------------------- */

/* L = F' F^-1 and P = J sigma F^-T, from dense formulas on the operators' results. */
static void inverse(int d, const double *F, double *inv, double *J) {
  if (d == 1) {
    inv[0] = 1.0 / F[0];
    *J = F[0];
    return;
  }
  double a[3][6] = {{0}};
  *J = 1.0;
  for (int r = 0; r < d; r++)
    for (int c = 0; c < d; c++) {
      a[r][c] = F[r * d + c];
      a[r][d + c] = r == c;
    }
  for (int p = 0; p < d; p++) { /* Gauss-Jordan; the maps here need no pivoting */
    double pivot = a[p][p];
    *J *= pivot;
    for (int c = 0; c < 2 * d; c++) a[p][c] /= pivot;
    for (int r = 0; r < d; r++)
      for (int c = 2 * d - 1; r != p && c >= 0; c--) a[r][c] -= a[r][p] * a[p][c];
  }
  for (int r = 0; r < d; r++)
    for (int c = 0; c < d; c++) inv[r * d + c] = a[r][d + c];
}

static void test_stress_rate(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t d = 1; d <= 3; d++) {
    sph_material *m = hooke(ctx, d);
    lg_body b = deformed(ctx, d, RH_VARY_ALL);
    int64_t n = b.s.n;
    int c = d * (d + 1) / 2, dd = d * d;
    const double *sigma = rh_field(&b.s, SPH_FIELD_SIGMA), *v = rh_field(&b.s, SPH_FIELD_V);
    double *rate = rh_array(n * dd), *L = rh_array(n * dd), *want = rh_array(n * 6), inv[9], J;
    check_ok(sph_deformation_gradient(b.s.list, b.s.kernel, &b.a, b.x, b.F));
    check_ok(sph_gradient(b.s.list, b.s.kernel, &b.a, SPH_GRADIENT_DIFFERENCE, d, v, rate));
    for (int64_t i = 0; i < n; i++) {
      inverse(d, b.F + i * dd, inv, &J);
      for (int r = 0; r < d; r++)
        for (int s = 0; s < d; s++) {
          b.P[i * dd + r * d + s] = L[i * dd + r * d + s] = 0.0;
          for (int k = 0; k < d; k++) {
            L[i * dd + r * d + s] += rate[i * dd + r * d + k] * inv[k * d + s];
            b.P[i * dd + r * d + s] += J * sigma[i * c + rh_sym(d, r, k)] * inv[s * d + k];
          }
        }
    }
    sph_material_block block;
    sph_material_block_init(&block);
    block.dim = d;
    block.n = n;
    block.velocity_gradient = L;
    block.sigma = sigma;
    block.rho = b.a.rho;
    check_ok(sph_material_stress_rate(m, &block, want));
    sph_rhs *rhs = frozen_rhs(&b.s, m);
    add(rhs, SPH_TERM_FIRST_PIOLA, 0, 0, 0.0, 0.0);
    add(rhs, SPH_TERM_STRESS_RATE, SPH_STRESS_RATE_LAGRANGIAN, 0, 0.0, 0.0);
    double *got = rates(&b, rhs, SPH_FIELD_SIGMA);
    same(got, want, n * c, 1e-12);
    free(got);
    got = rates(&b, rhs, SPH_FIELD_V);
    check_ok(sph_piola_divergence(b.s.list, b.s.kernel, &b.a, 1, b.P, want));
    same(got, want, n * d, 1e-12);
    free(got);
    free(rate);
    free(L);
    free(want);
    sph_rhs_destroy(rhs);
    lg_free(&b);
    sph_material_destroy(m);
  }
  sph_context_destroy(ctx);
}

/* As printed: the terms of the current configuration, evaluated on X0. */
static void test_as_printed(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t d = 1; d <= 3; d++) {
    sph_material *m = hooke(ctx, d);
    lg_body b = deformed(ctx, d, RH_VARY_ALL);
    double *want = rh_array(b.s.n * 6), *L = rh_array(b.s.n * 9);
    sph_rhs *rhs = frozen_rhs(&b.s, m);
    add(rhs, SPH_TERM_STRESS, SPH_STRESS_CONSERVATIVE, 0, 0.0, 0.0);
    add(rhs, SPH_TERM_STRESS_RATE, 0, 1, 0.0, 0.0);
    check_ok(sph_stress_divergence(b.s.list, b.s.kernel, &b.a, SPH_STRESS_CONSERVATIVE, want));
    for (int twice = 0; twice < 2; twice++) { /* with matrices made, and kept */
      double *got = rates(&b, rhs, SPH_FIELD_V);
      same(got, want, b.s.n * d, 1e-13);
      free(got);
    }
    sph_material_block block;
    sph_material_block_init(&block);
    block.dim = d;
    block.n = b.s.n;
    block.velocity_gradient = L;
    block.sigma = b.a.sigma;
    check_ok(sph_velocity_gradient(b.s.list, b.s.kernel, &b.a, L));
    check_ok(sph_material_stress_rate(m, &block, want));
    double *got = rates(&b, rhs, SPH_FIELD_SIGMA);
    same(got, want, b.s.n * (d * (d + 1) / 2), 1e-13);
    free(got);
    free(want);
    free(L);
    sph_rhs_destroy(rhs);
    lg_free(&b);
    sph_material_destroy(m);
  }
  sph_context_destroy(ctx);
}

/* ---- what is kept --------------------------------------------------------------------------- */

/* Every field of the reference, touched, is seen, and a new list as well. */
static void test_kept(void **state) {
  (void)state;
  static const int32_t fields[] = {SPH_FIELD_X0, SPH_FIELD_M, SPH_FIELD_RHO, SPH_FIELD_C,
                                   SPH_FIELD_H};
  sph_context *ctx = rh_context(1);
  sph_material *m = rubber(ctx, 2);
  lg_body b = deformed(ctx, 2, 0);
  sph_rhs *kept = frozen_rhs(&b.s, m);
  add(kept, SPH_TERM_FIRST_PIOLA, 0, 0, 0.0, 0.0);
  add(kept, SPH_TERM_HOURGLASS, SPH_HOURGLASS_CENTRAL, 0, 0.5, 0.0);
  double *before = rates(&b, kept, SPH_FIELD_V);
  for (int f = 0; f < 5; f++) {
    double *values = rh_field(&b.s, fields[f]);
    for (int64_t i = 0; i < b.s.n; i++) values[i] *= 1.0 + 1e-3 * (double)(i % 7);
    check_ok(sph_particles_touch(b.s.set, fields[f]));
    sph_rhs *fresh = frozen_rhs(&b.s, m);
    add(fresh, SPH_TERM_FIRST_PIOLA, 0, 0, 0.0, 0.0);
    add(fresh, SPH_TERM_HOURGLASS, SPH_HOURGLASS_CENTRAL, 0, 0.5, 0.0);
    double *got = rates(&b, kept, SPH_FIELD_V), *want = rates(&b, fresh, SPH_FIELD_V);
    assert_memory_equal(got, want, (size_t)(b.s.n * 2) * sizeof *got);
    assert_memory_not_equal(got, before, (size_t)(b.s.n * 2) * sizeof *got);
    free(before);
    free(want);
    before = got;
    sph_rhs_destroy(fresh);
  }
  check_ok(sph_neighbors_build(b.s.list, b.s.set)); /* of X, which is another order of pairs */
  double *again = rates(&b, kept, SPH_FIELD_V);
  assert_memory_equal(again, before, (size_t)(b.s.n * 2) * sizeof *again);
  free(again);
  free(before);
  sph_rhs_destroy(kept);
  lg_free(&b);
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

/* X moves far: neither list nor matrices are made again, nor is memory asked for. */
static void test_steady(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_material *m = rubber(ctx, 2);
  lg_body b = deformed(ctx, 2, RH_VARY_ALL);
  sph_rhs *rhs = frozen_rhs(&b.s, m);
  double *out = rh_array(b.s.n * 2), *x = rh_field(&b.s, SPH_FIELD_X);
  sph_rate rate = {SPH_FIELD_V, out};
  int64_t made, now, builds;
  add(rhs, SPH_TERM_FIRST_PIOLA, 0, 0, 0.0, 0.0);
  check_ok(sph_rhs_evaluate(rhs, b.s.set, b.s.list, 0.0, &rate, 1));
  builds = sph_neighbors_builds(b.s.list);
  check_ok(sph_context_memory(ctx, NULL, NULL, &made));
  for (int64_t k = 0; k < b.s.n * 2; k++) x[k] = 1.5 * x[k] + 100.0;
  check_ok(sph_particles_touch(b.s.set, SPH_FIELD_X));
  check_ok(sph_rhs_evaluate(rhs, b.s.set, b.s.list, 0.0, &rate, 1));
  check_ok(sph_context_memory(ctx, NULL, NULL, &now));
  assert_int_equal(now, made);
  assert_int_equal(sph_neighbors_builds(b.s.list), builds);
  free(out);
  sph_rhs_destroy(rhs);
  lg_free(&b);
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

/* ---- energy --------------------------------------------------------------------------------- */

static void test_strain_energy(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_material *m = rubber(ctx, 3);
  lg_body b = deformed(ctx, 3, RH_GHOSTS);
  sph_rhs *rhs = frozen_rhs(&b.s, m);
  double *got = rh_array(b.s.n), *want = rh_array(b.s.n);
  add(rhs, SPH_TERM_FIRST_PIOLA, 0, 0, 0.0, 0.0);
  check_status(sph_rhs_strain_energy(rhs, b.s.set, got), SPH_ERR_STATE);
  free(rates(&b, rhs, SPH_FIELD_V));
  check_status(sph_rhs_strain_energy(rhs, b.s.set, NULL), SPH_ERR_ARG);
  check_ok(sph_rhs_strain_energy(rhs, b.s.set, got));
  check_ok(sph_material_first_piola(m, 3, b.rows, rh_field(&b.s, SPH_FIELD_F), b.P, want));
  assert_memory_equal(got, want, (size_t)b.rows * sizeof *got);
  check_ok(sph_rhs_set_material(rhs, 0, NULL));
  check_status(sph_rhs_strain_energy(rhs, b.s.set, got), SPH_ERR_STATE);
  free(got);
  free(want);
  sph_rhs_destroy(rhs);
  lg_free(&b);
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

/* ---- refusals ------------------------------------------------------------------------------- */

static void expect(sph_context *ctx, sph_status got, sph_status want, const char *word) {
  check_status(got, want);
  assert_non_null(strstr(sph_context_last_error(ctx), word));
}

static void test_refusals(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  lg_body b = deformed(ctx, 2, 0);
  sph_rhs *moving = rh_rhs(&b.s), *frozen = frozen_rhs(&b.s, NULL);
  double *out = rh_array(b.s.n * 4);
  sph_rate rate = {SPH_FIELD_V, out};
  sph_term t = rh_term(SPH_TERM_FIRST_PIOLA, 0, 0);
  expect(ctx, sph_rhs_add(moving, &t), SPH_ERR_ARG, "X0");
  t = rh_term(SPH_TERM_HOURGLASS, 0, 0);
  expect(ctx, sph_rhs_add(moving, &t), SPH_ERR_ARG, "X0");
  t = rh_term(SPH_TERM_MONAGHAN, SPH_MONAGHAN_CURRENT, 0);
  expect(ctx, sph_rhs_add(moving, &t), SPH_ERR_ARG, "X0");
  t = rh_term(SPH_TERM_STRESS_RATE, SPH_STRESS_RATE_LAGRANGIAN, 0);
  expect(ctx, sph_rhs_add(moving, &t), SPH_ERR_ARG, "X0");
  for (int32_t form = 1; form <= 3; form++) {
    t = rh_term(SPH_TERM_FIRST_PIOLA, form, 1);
    if (form != 2) check_status(sph_rhs_add(frozen, &t), SPH_ERR_ARG);
    t = rh_term(SPH_TERM_HOURGLASS, form, 1);
    check_status(sph_rhs_add(frozen, &t), SPH_ERR_ARG);
  }
  t = rh_term(SPH_TERM_HOURGLASS, 1, 0);
  t.alpha = -1.0;
  expect(ctx, sph_rhs_add(frozen, &t), SPH_ERR_ARG, "hourglass");
  t.alpha = NAN;
  expect(ctx, sph_rhs_add(frozen, &t), SPH_ERR_ARG, "finite");
  t = rh_term(SPH_TERM_FIRST_PIOLA, 0, 0);
  check_ok(sph_rhs_add(frozen, &t));
  expect(ctx, sph_rhs_evaluate(frozen, b.s.set, b.s.list, 0.0, &rate, 1), SPH_ERR_STATE,
         "first Piola-Kirchhoff");
  sph_material *m = rubber(ctx, 2);
  check_ok(sph_rhs_set_material(frozen, 0, m));
  double *x = rh_field(&b.s, SPH_FIELD_X); /* a particle turned inside out is named */
  memcpy(x, b.X, (size_t)(b.s.n * 2) * sizeof *x);
  x[2 * 40] += 50.0;
  expect(ctx, sph_rhs_evaluate(frozen, b.s.set, b.s.list, 0.0, &rate, 1), SPH_ERR_NUMERIC,
         "particle");
  x[2 * 40] = NAN;
  check_status(sph_rhs_evaluate(frozen, b.s.set, b.s.list, 0.0, &rate, 1), SPH_ERR_NUMERIC);
  sph_material_destroy(m);
  free(out);
  sph_rhs_destroy(frozen);
  sph_rhs_destroy(moving);
  lg_free(&b);
  sph_context_destroy(ctx);
}

/* A set without X0, or without C for the springs. */
static void test_missing_fields(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_particles *set;
  sph_particles_options o;
  rh_system s = rh_make(ctx, 2, 4, 0, 1);
  sph_rhs *rhs = frozen_rhs(&s, NULL);
  double out[8], *array;
  sph_rate rate = {SPH_FIELD_V, out};
  sph_particles_options_init(&o);
  o.dim = 2;
  check_ok(sph_particles_create(ctx, &o, &set));
  check_ok(sph_particles_add(set, 4, NULL));
  add(rhs, SPH_TERM_HOURGLASS, 0, 0, 0.1, 0.0);
  static const struct {
    int32_t field;
    const char *name;
  } needed[] = {{SPH_FIELD_X0, "x0"},
                {SPH_FIELD_H, "h"},
                {SPH_FIELD_M, "m"},
                {SPH_FIELD_RHO, "rho"},
                {SPH_FIELD_C, "c"}};
  for (int k = 0; k < 5; k++) {
    expect(ctx, sph_rhs_evaluate(rhs, set, s.list, 0.0, &rate, 1), SPH_ERR_ARG, needed[k].name);
    check_ok(sph_particles_field(set, needed[k].field, &array));
    for (int i = 0; i < (k ? 4 : 8); i++) array[i] = k ? 1.0 : (double)i;
  }
  check_ok(sph_rhs_evaluate(rhs, set, s.list, 0.0, &rate, 1));
  sph_rhs_destroy(rhs);
  sph_particles_destroy(set);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* Each allocation refused in turn; what was kept of the configuration stays sound. */
static sph_status starved(sph_context *ctx, void *user) {
  sph_particles *set = NULL;
  sph_neighbors *list = NULL;
  sph_kernel *kernel = NULL;
  double out[128], *a;
  sph_rate rate = {SPH_FIELD_V, out};
  sph_particles_options o;
  (void)user;
  oom_pause();
  sph_particles_options_init(&o);
  o.dim = 2;
  check_ok(sph_particles_create(ctx, &o, &set));
  check_ok(sph_particles_add(set, 64, NULL));
  for (int32_t f = 0; f <= SPH_FIELD_X0; f++) {
    check_ok(sph_particles_field(set, f, &a));
    int64_t c = sph_particles_components(set, f);
    for (int64_t k = 0; k < 64 * c; k++) a[k] = f == SPH_FIELD_H ? 1.3 : 1.0;
    if (f == SPH_FIELD_X || f == SPH_FIELD_X0)
      for (int64_t i = 0; i < 64; i++) {
        a[2 * i] = (double)(i % 8);
        a[2 * i + 1] = (double)(i / 8);
      }
  }
  check_ok(sph_neighbors_create(ctx, NULL, &list));
  check_ok(sph_kernel_create(ctx, SPH_KERNEL_CUBIC_SPLINE, 2, &kernel));
  rh_system s = {.ctx = ctx, .kernel = kernel};
  sph_material *m = rubber(ctx, 2);
  sph_rhs *rhs = frozen_rhs(&s, m);
  add(rhs, SPH_TERM_FIRST_PIOLA, 0, 0, 0.0, 0.0);
  add(rhs, SPH_TERM_HOURGLASS, SPH_HOURGLASS_CENTRAL, 0, 0.5, 0.0);
  oom_resume();
  sph_status status = sph_rhs_evaluate(rhs, set, list, 0.0, &rate, 1);
  oom_pause();
  int64_t countdown = oom.countdown;
  oom.countdown = -1;
  check_ok(sph_rhs_evaluate(rhs, set, list, 0.0, &rate, 1)); /* as if nothing had been */
  for (int k = 0; k < 128; k++) check_close(out[k], 0.0, 1e-12);
  oom.countdown = countdown;
  sph_rhs_destroy(rhs);
  sph_material_destroy(m);
  sph_kernel_destroy(kernel);
  sph_neighbors_destroy(list);
  sph_particles_destroy(set);
  oom_resume();
  return status;
}

static void test_memory(void **state) {
  (void)state;
  oom_sweep(starved, NULL);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_terms),      cmocka_unit_test(test_uniform),
    cmocka_unit_test(test_viscosity),  cmocka_unit_test(test_stress_rate),
    cmocka_unit_test(test_as_printed), cmocka_unit_test(test_kept),
    cmocka_unit_test(test_steady),     cmocka_unit_test(test_strain_energy),
    cmocka_unit_test(test_refusals),   cmocka_unit_test(test_missing_fields),
    cmocka_unit_test(test_memory),
};
SPH_TEST_MAIN(tests)
