/* Materials from within: Hooke's law against an independent derivation with full 3x3 tensors, in
 * which the strain rates across are found by elimination and not by the formulas of the library;
 * rotation; symmetry; what other layers ask of a material. */
#include "../../src/material/material_impl.h"
#include "../check.h"
#include "../oom.h"

#include <sph/elastic.h>

static uint64_t random_state = 7;
static double random_signed(void) { /* splitmix64, in (-1, 1) */
  uint64_t z = (random_state += UINT64_C(0x9e3779b97f4a7c15));
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  z ^= z >> 31;
  return (double)(z >> 11) * 0x1p-52 - 1;
}

static sph_material *make_hooke(sph_context *ctx, int32_t reduction, double young, double nu,
                                int32_t jaumann) {
  sph_hooke_options o;
  sph_material *material = NULL;
  sph_hooke_options_init(&o);
  o.young = young;
  o.poisson = nu;
  o.density = 2.0;
  o.reduction = reduction;
  o.jaumann = jaumann;
  check_ok(sph_material_create_hooke(ctx, &o, &material));
  return material;
}

static sph_context *make_context(void) {
  sph_context *ctx = NULL;
  check_ok(sph_context_create(NULL, &ctx));
  return ctx;
}

static void rate(const sph_material *material, int32_t dim, int64_t n, const double *l,
                 const double *s, double *out) {
  sph_material_block b;
  sph_material_block_init(&b);
  b.dim = dim;
  b.n = n;
  b.velocity_gradient = l;
  b.sigma = s;
  check_ok(sph_material_stress_rate(material, &b, out));
}

/* ---- the oracle: full tensors ---- */

typedef double tensor[3][3];
static const int row_of[] = {0, 1, 2, 0, 0, 1}, column_of[] = {0, 1, 2, 1, 2, 2};
/* the packed components of each dimension, as indices into the two lists above */
static const int packed[4][6] = {{0}, {0}, {0, 1, 3}, {0, 1, 2, 3, 4, 5}};

static int32_t reduction_dim(int32_t reduction) {
  return reduction <= SPH_UNIAXIAL_STRAIN ? 1 : reduction <= SPH_PLANE_STRAIN ? 2 : 3;
}

static double trace(tensor a) { return a[0][0] + a[1][1] + a[2][2]; }

/* 2G D' + K tr(D) I */
static void isotropic(tensor d, double young, double nu, tensor out) {
  double g = young / (2 * (1 + nu)), k = young / (3 * (1 - 2 * nu)), tr = trace(d);
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++)
      out[a][b] = 2 * g * (d[a][b] - (a == b ? tr / 3 : 0)) + (a == b ? k * tr : 0);
}

/* Choose D across the dimension so that the stress rates there vanish: solve the (at most 2x2,
 * by symmetry one unknown) linear condition from two evaluations of the full law. */
static void eliminate(tensor d, int32_t reduction, double young, double nu) {
  tensor zero, one;
  int from = reduction == SPH_UNIAXIAL_STRESS ? 1 : 2;
  if (reduction != SPH_UNIAXIAL_STRESS && reduction != SPH_PLANE_STRESS) return;
  for (int a = from; a < 3; a++) d[a][a] = 0;
  isotropic(d, young, nu, zero);
  for (int a = from; a < 3; a++) d[a][a] = 1;
  isotropic(d, young, nu, one);
  for (int a = from; a < 3; a++) d[a][a] = -zero[2][2] / (one[2][2] - zero[2][2]);
}

/* out += omega s - s omega by the matrix products */
static void add_rotation(tensor l, tensor s, tensor out) {
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++)
      for (int c = 0; c < 3; c++)
        out[a][b] += 0.5 * (l[a][c] - l[c][a]) * s[c][b] - s[a][c] * 0.5 * (l[c][b] - l[b][c]);
}

static void oracle(int32_t reduction, double young, double nu, int jaumann, const double *l,
                   const double *s, double *out) {
  int32_t dim = reduction_dim(reduction), comps = dim * (dim + 1) / 2;
  tensor full_l = {{0}}, full_s = {{0}}, d, r;
  for (int a = 0; a < dim; a++)
    for (int b = 0; b < dim; b++) full_l[a][b] = l[a * dim + b];
  for (int c = 0; c < comps && jaumann; c++) {
    int a = row_of[packed[dim][c]], b = column_of[packed[dim][c]];
    full_s[a][b] = full_s[b][a] = s[c];
  }
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) d[a][b] = 0.5 * (full_l[a][b] + full_l[b][a]);
  eliminate(d, reduction, young, nu);
  isotropic(d, young, nu, r);
  if (jaumann) add_rotation(full_l, full_s, r);
  for (int c = 0; c < comps; c++) out[c] = r[row_of[packed[dim][c]]][column_of[packed[dim][c]]];
}

static void check_against_oracle(sph_context *ctx, int32_t reduction, double nu, int jaumann) {
  enum { N = 50 };
  double l[N * 9], s[N * 6], got[N * 6], want[6];
  int32_t dim = reduction_dim(reduction), comps = dim * (dim + 1) / 2;
  sph_material *material = make_hooke(ctx, reduction, 3.7, nu, jaumann);
  for (int k = 0; k < N * 9; k++) l[k] = random_signed();
  for (int k = 0; k < N * 6; k++) s[k] = 2 * random_signed();
  rate(material, dim, N, l, s, got);
  for (int i = 0; i < N; i++) {
    oracle(reduction, 3.7, nu, jaumann, l + i * dim * dim, s + i * comps, want);
    for (int c = 0; c < comps; c++)
      check_close(got[i * comps + c], want[c], 1e-12 * (1 + 1 / (1 - 2 * nu)));
  }
  sph_material_destroy(material);
}

static void test_full_tensor_law(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  const double nus[] = {0, 0.3, 0.35, 0.49, -0.5};
  for (int32_t reduction = SPH_UNIAXIAL_STRESS; reduction <= SPH_SOLID; reduction++)
    for (int k = 0; k < 5; k++)
      for (int jaumann = 0; jaumann < 2; jaumann++)
        check_against_oracle(ctx, reduction, nus[k], jaumann);
  sph_context_destroy(ctx);
}

/* The total form is the same linear law of the strain as the rate form is of the strain rate; with
 * F, of the strain (F + F^T)/2 - I, and half its work is the energy. */
static void test_total_form(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  const double nus[] = {0, 0.3, -0.4};
  for (int32_t reduction = SPH_UNIAXIAL_STRESS; reduction <= SPH_SOLID; reduction++)
    for (int k = 0; k < 3; k++) {
      int32_t dim = reduction_dim(reduction), comps = dim * (dim + 1) / 2;
      sph_material *material = make_hooke(ctx, reduction, 3.7, nus[k], 1);
      double l[9], strain[6], got[6], want[6], f[9], p[9], cauchy[6], energy, work = 0;
      for (int c = 0; c < 9; c++) l[c] = random_signed();
      oracle(reduction, 3.7, nus[k], 0, l, NULL, want);
      for (int c = 0; c < comps; c++) {
        int a = row_of[packed[dim][c]], b = column_of[packed[dim][c]];
        strain[c] = 0.5 * (l[a * dim + b] + l[b * dim + a]);
        work += 0.5 * (a == b ? 1 : 2) * strain[c] * want[c];
      }
      sph_material_block b = {.size = sizeof b, .dim = dim, .n = 1, .strain = strain};
      check_ok(sph_material_small_strain_stress(material, &b, got));
      for (int c = 0; c < comps; c++) check_close(got[c], want[c], 1e-13);
      for (int c = 0; c < dim * dim; c++) f[c] = l[c] + (c % (dim + 1) == 0);
      check_ok(sph_material_cauchy_stress(material, dim, 1, f, cauchy));
      check_ok(sph_material_first_piola(material, dim, 1, f, p, &energy));
      check_close(energy, work, 1e-13);
      for (int c = 0; c < comps; c++) {
        int a = row_of[packed[dim][c]], e = column_of[packed[dim][c]];
        check_close(cauchy[c], want[c], 2e-13);
        assert_true(p[a * dim + e] == cauchy[c] && p[e * dim + a] == cauchy[c]);
      }
      check_ok(sph_material_small_strain_stress(material, &b, strain)); /* over the strain */
      assert_memory_equal(strain, got, sizeof *got * (size_t)comps);
      b.strain = NULL;
      check_status(sph_material_small_strain_stress(material, &b, got), SPH_ERR_ARG);
      sph_material_destroy(material);
    }
  sph_context_destroy(ctx);
}

/* The two plane reductions differ, and in the way that the trace with D_zz says. */
static void test_plane_reductions(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  const double l[] = {1, 0, 0, 0}, s[] = {0, 0, 0}, e = 10, nu = 0.25;
  double r[3];
  sph_material *stress = make_hooke(ctx, SPH_PLANE_STRESS, e, nu, 1);
  sph_material *strain = make_hooke(ctx, SPH_PLANE_STRAIN, e, nu, 1);
  rate(stress, 2, 1, l, s, r);
  check_rel(r[0], e / (1 - nu * nu), 1e-15);
  check_rel(r[1], nu * e / (1 - nu * nu), 1e-15);
  rate(strain, 2, 1, l, s, r);
  check_rel(r[0], 12, 1e-15); /* lambda = G = 4 */
  check_rel(r[1], 4, 1e-15);
  sph_material_destroy(stress);
  sph_material_destroy(strain);
  sph_context_destroy(ctx);
}

/* ---- rotation ---- */

static void spin_gradient(int32_t dim, const double axis[3], double *l) {
  if (dim == 2) {
    const double l2[4] = {0, -axis[2], axis[2], 0};
    memcpy(l, l2, sizeof l2);
  } else {
    const double l3[9] = {0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0};
    memcpy(l, l3, sizeof l3);
  }
}

/* One RK4 step of s' = rate(l, s). */
static void rk4_step(const sph_material *m, int32_t dim, const double *l, double dt, double *s) {
  const int comps = dim * (dim + 1) / 2;
  const double weight[] = {1, 2, 2, 1}, node[] = {0, 0.5, 0.5, 1};
  double k[6] = {0}, stage[6], sum[6] = {0};
  for (int n = 0; n < 4; n++) {
    for (int c = 0; c < comps; c++) stage[c] = s[c] + node[n] * dt * k[c];
    rate(m, dim, 1, l, stage, k);
    for (int c = 0; c < comps; c++) sum[c] += weight[n] * k[c];
  }
  for (int c = 0; c < comps; c++) s[c] += dt / 6 * sum[c];
}

/* R s R^T for a turn about the unit axis, by Rodrigues' formula. */
static void turned(int32_t dim, const double axis[3], double angle, const double *s, double *out) {
  const tensor k = {{0, -axis[2], axis[1]}, {axis[2], 0, -axis[0]}, {-axis[1], axis[0], 0}};
  tensor r, full = {{0}};
  const int comps = dim * (dim + 1) / 2;
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) {
      double kk = 0;
      for (int c = 0; c < 3; c++) kk += k[a][c] * k[c][b];
      r[a][b] = (a == b) + sin(angle) * k[a][b] + (1 - cos(angle)) * kk;
    }
  for (int c = 0; c < comps; c++) {
    int a = row_of[packed[dim][c]], b = column_of[packed[dim][c]];
    full[a][b] = full[b][a] = s[c];
  }
  for (int c = 0; c < comps; c++) {
    out[c] = 0;
    for (int p = 0; p < 3; p++)
      for (int q = 0; q < 3; q++)
        out[c] += r[row_of[packed[dim][c]]][p] * full[p][q] * r[column_of[packed[dim][c]]][q];
  }
}

static void check_turn(sph_context *ctx, int32_t reduction, const double axis[3], int steps,
                       double angle) {
  const int32_t dim = reduction_dim(reduction);
  const double start[6] = {1, -0.5, 0.3, 0.2, 0.7, -0.4};
  double s[6], want[6], l[9];
  sph_material *m = make_hooke(ctx, reduction, 5, 0.3, 1);
  memcpy(s, start, sizeof s);
  spin_gradient(dim, axis, l);
  for (int k = 0; k < steps; k++) rk4_step(m, dim, l, angle / steps, s);
  turned(dim, axis, angle, start, want);
  for (int c = 0; c < dim * (dim + 1) / 2; c++) check_close(s[c], want[c], 1e-8);
  sph_material_destroy(m);
}

static void test_rigid_rotation(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  const double z[3] = {0, 0, 1}, oblique[3] = {2.0 / 3, -1.0 / 3, 2.0 / 3};
  const double angles[] = {0.5, 2.0, 6.283185307179586};
  for (int k = 0; k < 3; k++) {
    check_turn(ctx, SPH_PLANE_STRESS, z, 1000, angles[k]);
    check_turn(ctx, SPH_PLANE_STRAIN, z, 1000, -angles[k]);
    check_turn(ctx, SPH_SOLID, z, 1000, angles[k]);
    check_turn(ctx, SPH_SOLID, oblique, 1000, angles[k]);
  }
  sph_context_destroy(ctx);
}

/* Principal stresses in 2-D after a full turn, stretched not at all. */
static void test_principal_stresses(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material *m = make_hooke(ctx, SPH_PLANE_STRESS, 5, 0.3, 1);
  const double l[4] = {0, -1, 1, 0};
  double s[3] = {3, -1, 0.5};
  const double mean = 0.5 * (s[0] + s[1]), radius = hypot(0.5 * (s[0] - s[1]), s[2]);
  for (int k = 0; k < 400; k++) {
    rk4_step(m, 2, l, 6.283185307179586 / 400, s);
    check_close(0.5 * (s[0] + s[1]), mean, 1e-6);
    check_close(hypot(0.5 * (s[0] - s[1]), s[2]), radius, 1e-6);
  }
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

static void test_without_jaumann_spin_is_nothing(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  const double l[4] = {0, -3, 3, 0}, l3[9] = {0, -1, 2, 1, 0, -3, -2, 3, 0};
  double r[6];
  sph_material *flat = make_hooke(ctx, SPH_PLANE_STRAIN, 5, 0.3, 0);
  sph_material *solid = make_hooke(ctx, SPH_SOLID, 5, 0.3, 0);
  rate(flat, 2, 1, l, NULL, r); /* and the stress is not read */
  for (int c = 0; c < 3; c++) assert_true(r[c] == 0);
  rate(solid, 3, 1, l3, NULL, r);
  for (int c = 0; c < 6; c++) assert_true(r[c] == 0);
  sph_material_destroy(flat);
  sph_material_destroy(solid);
  sph_context_destroy(ctx);
}

/* ---- properties ---- */

static void test_linear_in_the_gradient(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int32_t reduction = SPH_UNIAXIAL_STRESS; reduction <= SPH_SOLID; reduction++) {
    const int32_t dim = reduction_dim(reduction), comps = dim * (dim + 1) / 2;
    sph_material *m = make_hooke(ctx, reduction, 5, 0.3, 1);
    double a[9], b[9], sum[9], s[6], ra[6], rb[6], rs[6];
    for (int k = 0; k < 9; k++) {
      a[k] = random_signed();
      b[k] = random_signed();
      sum[k] = 3 * a[k] - 0.5 * b[k];
    }
    for (int k = 0; k < 6; k++) s[k] = random_signed();
    rate(m, dim, 1, a, s, ra);
    rate(m, dim, 1, b, s, rb);
    rate(m, dim, 1, sum, s, rs);
    for (int c = 0; c < comps; c++) check_close(rs[c], 3 * ra[c] - 0.5 * rb[c], 1e-13);
    sph_material_destroy(m);
  }
  sph_context_destroy(ctx);
}

/* A cyclic exchange of the axes exchanges the components of the result, to the last bits. */
static void test_axes_are_alike(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material *m = make_hooke(ctx, SPH_SOLID, 5, 0.3, 1);
  /* new axis a is the old axis (a + 1) % 3; packed: xx<-yy, yy<-zz, zz<-xx, xy<-yz, ... */
  const int source[6] = {1, 2, 0, 5, 3, 4};
  double l[9], turned_l[9], s[6], turned_s[6], r[6], turned_r[6];
  for (int k = 0; k < 9; k++) l[k] = random_signed();
  for (int k = 0; k < 6; k++) s[k] = random_signed();
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) turned_l[a * 3 + b] = l[(a + 1) % 3 * 3 + (b + 1) % 3];
  for (int c = 0; c < 6; c++) turned_s[c] = s[source[c]];
  rate(m, 3, 1, l, s, r);
  rate(m, 3, 1, turned_l, turned_s, turned_r);
  for (int c = 0; c < 6; c++) check_close(turned_r[c], r[source[c]], 1e-14);
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

/* A 2-D solid is the plane-strain law, component by component. */
static void test_plane_strain_is_a_slice_of_the_solid(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material *flat = make_hooke(ctx, SPH_PLANE_STRAIN, 5, 0.3, 1);
  sph_material *solid = make_hooke(ctx, SPH_SOLID, 5, 0.3, 1);
  const double l[4] = {0.3, 0.7, -0.2, 0.5}, s[3] = {1, 2, 3};
  const double l3[9] = {0.3, 0.7, 0, -0.2, 0.5, 0, 0, 0, 0}, s3[6] = {1, 2, 9, 3, 0, 0};
  double r[3], r3[6];
  rate(flat, 2, 1, l, s, r);
  rate(solid, 3, 1, l3, s3, r3);
  check_close(r[0], r3[0], 1e-15);
  check_close(r[1], r3[1], 1e-15);
  check_close(r[2], r3[3], 1e-15);
  check_close(r3[2], 0.3 * (r[0] + r[1] - 0.0), 1e-14); /* zz = nu (xx + yy); spin cancels */
  sph_material_destroy(flat);
  sph_material_destroy(solid);
  sph_context_destroy(ctx);
}

static void test_rate_over_the_stress(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  for (int32_t reduction = SPH_UNIAXIAL_STRESS; reduction <= SPH_SOLID; reduction++) {
    const int32_t dim = reduction_dim(reduction), comps = dim * (dim + 1) / 2;
    double l[27], s[18], apart[18];
    sph_material *m = make_hooke(ctx, reduction, 5, 0.3, 1);
    for (int k = 0; k < 27; k++) l[k] = random_signed();
    for (int k = 0; k < 18; k++) s[k] = random_signed();
    rate(m, dim, 3, l, s, apart);
    rate(m, dim, 3, l, s, s); /* the output may be the stress array */
    assert_memory_equal(s, apart, (size_t)(3 * comps) * sizeof(double));
    sph_material_destroy(m);
  }
  sph_context_destroy(ctx);
}

static void test_nan_stays_with_its_particle(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material *m = make_hooke(ctx, SPH_PLANE_STRESS, 5, 0.3, 1);
  double l[12] = {0}, s[9] = {0}, r[9];
  l[4] = NAN;
  rate(m, 2, 3, l, s, r);
  assert_true(isnan(r[3]));
  for (int c = 0; c < 9; c++) assert_true(c / 3 == 1 || r[c] == 0);
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

/* ---- what other layers use ---- */

static int32_t answer(void *user, const sph_material_block *b, double *out) {
  (void)b;
  (void)out;
  return *(const int32_t *)user;
}
static int destroyed;
static void count_destroy(void *user) {
  (void)user;
  destroyed++;
}

static void test_references(void **state) {
  (void)state;
  sph_context *ctx = oom_context();
  sph_material_functions f;
  sph_material *m = NULL;
  int32_t value = 0;
  sph_material_functions_init(&f);
  f.pressure = answer;
  f.destroy = count_destroy;
  destroyed = 0;
  check_ok(sph_material_create(ctx, &f, &value, &m));
  sph_context_destroy(ctx); /* the material holds on to it */
  sphi_material_retain(m);
  sphi_material_retain(NULL);
  sph_material_destroy(m);
  assert_int_equal(destroyed, 0);
  assert_int_equal(sphi_material_has(m, SPHI_MATERIAL_PRESSURE), 1);
  sphi_material_release(m);
  sphi_material_release(NULL);
  assert_int_equal(destroyed, 1);
  oom_check_clean();
}

static void test_questions(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material *hooke = make_hooke(ctx, SPH_PLANE_STRAIN, 1, 0.3, 1);
  sph_material *plain = make_hooke(ctx, SPH_UNIAXIAL_STRAIN, 1, 0.3, 1);
  assert_int_equal(sphi_material_has(hooke, SPHI_MATERIAL_STRESS_RATE), 1);
  assert_int_equal(sphi_material_has(hooke, SPHI_MATERIAL_PRESSURE), 0);
  assert_int_equal(sphi_material_has(hooke, SPHI_MATERIAL_SOUND_SPEED), 1);
  assert_int_equal(sphi_material_has(hooke, 99), 0);
  assert_int_equal(sphi_material_has(NULL, SPHI_MATERIAL_PRESSURE), 0);
  assert_int_equal(sphi_material_dim(hooke), 2);
  assert_int_equal(sphi_material_dim(plain), 1);
  assert_int_equal(sphi_material_needs(hooke, SPHI_MATERIAL_STRESS_RATE),
                   SPHI_NEEDS_GRADIENT | SPHI_NEEDS_SIGMA);
  assert_int_equal(sphi_material_needs(plain, SPHI_MATERIAL_STRESS_RATE), SPHI_NEEDS_GRADIENT);
  assert_int_equal(sphi_material_needs(hooke, SPHI_MATERIAL_SOUND_SPEED), 0);
  sph_material_destroy(hooke);
  sph_material_destroy(plain);
  sph_context_destroy(ctx);
}

/* The calls for worker threads answer a status and leave the last error alone. */
static void test_quiet_calls(void **state) {
  (void)state;
  sph_context *ctx = make_context();
  sph_material_functions f;
  sph_material *m = NULL;
  sph_material_block b;
  int32_t value = 0;
  double out[1];
  sph_material_functions_init(&f);
  f.stress_rate = f.pressure = f.sound_speed = answer;
  check_ok(sph_material_create(ctx, &f, &value, &m));
  sph_material_block_init(&b);
  b.dim = 1;
  b.n = 1;
  const int32_t values[] = {0, 1, 1000, -1, INT32_MIN};
  const sph_status want[] = {SPH_OK, SPH_RETRY, SPH_RETRY, SPH_ERR_CALLBACK, SPH_ERR_CALLBACK};
  for (int k = 0; k < 5; k++) {
    value = values[k];
    check_status(sphi_material_stress_rate_quiet(m, &b, out), want[k]);
    check_status(sphi_material_pressure_quiet(m, &b, out), want[k]);
    check_status(sphi_material_sound_speed_quiet(m, &b, out), want[k]);
  }
  assert_string_equal(sph_context_last_error(ctx), "");
  check_status(sphi_material_fail(m, SPHI_MATERIAL_PRESSURE, SPH_RETRY), SPH_RETRY);
  assert_string_equal(sph_context_last_error(ctx), "");
  check_status(sphi_material_fail(m, SPHI_MATERIAL_PRESSURE, SPH_ERR_CALLBACK), SPH_ERR_CALLBACK);
  assert_non_null(strstr(sph_context_last_error(ctx), "pressure"));
  sph_material_destroy(m);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_full_tensor_law),
    cmocka_unit_test(test_total_form),
    cmocka_unit_test(test_plane_reductions),
    cmocka_unit_test(test_rigid_rotation),
    cmocka_unit_test(test_principal_stresses),
    cmocka_unit_test(test_without_jaumann_spin_is_nothing),
    cmocka_unit_test(test_linear_in_the_gradient),
    cmocka_unit_test(test_axes_are_alike),
    cmocka_unit_test(test_plane_strain_is_a_slice_of_the_solid),
    cmocka_unit_test(test_rate_over_the_stress),
    cmocka_unit_test(test_nan_stays_with_its_particle),
    cmocka_unit_test(test_references),
    cmocka_unit_test(test_questions),
    cmocka_unit_test(test_quiet_calls),
};
SPH_TEST_MAIN(tests)
