/* Total-Lagrangian operators: exact values, plain references over all pairs, what is conserved,
 * energies, sets of instructions, threads, refusals. */
#include "../lagrangian_help.h"
#include "../oom.h"

static const int32_t rules[] = {SPH_H_ARITHMETIC, SPH_H_HARMONIC, SPH_H_MAX, SPH_H_MIN,
                                SPH_H_AVERAGE};

/* Stretch, shear and, in 3-D, all of it. */
static const double affine[3][9] = {
    {1.7}, {1.3, 0.4, -0.2, 0.9}, {1.2, 0.3, -0.1, 0.2, 0.8, 0.15, -0.3, 0.1, 1.1}};

static void gradient(lg_body *b) {
  check_ok(sph_deformation_gradient(b->s.list, b->s.kernel, &b->a, b->x, b->F));
}

static void random_stress(lg_body *b) {
  for (int64_t k = 0; k < b->s.n * b->s.dim * b->s.dim; k++) b->P[k] = rh_random(-2.0, 2.0);
}

/* ---- deformation gradient ------------------------------------------------------------------- */

static void test_linear_exact(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t d = 1; d <= 3; d++)
    for (uint32_t f = 0; f < 2; f++) {
      lg_body b = lg_make(ctx, d, f ? RH_VARY_ALL : 0, SPH_H_ARITHMETIC, 5 + f);
      lg_deform(&b, affine[d - 1], 3.0);
      gradient(&b);
      for (int64_t i = 0; i < b.s.n; i++)
        for (int k = 0; k < d * d; k++) check_close(b.F[i * d * d + k], affine[d - 1][k], 1e-13);
      lg_free(&b);
    }
  sph_context_destroy(ctx);
}

static void check_gradient(const lg_body *b) {
  int dd = b->s.dim * b->s.dim;
  double want[9], bound[9];
  for (int64_t i = 0; i < b->s.n; i++) {
    lg_gradient(b, i, want, bound);
    for (int k = 0; k < dd; k++) check_close(b->F[i * dd + k], want[k], 1e-13 * (bound[k] + 1.0));
  }
}

static void test_gradient_reference(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t d = 1; d <= 3; d++)
    for (int r = 0; r < 5; r++) {
      lg_body b = lg_make(ctx, d, RH_VARY_ALL | (r % 2 ? RH_WRAP : 0), rules[r], 11 + (uint64_t)r);
      lg_deform(&b, affine[d - 1], 0.0);
      if (r % 2) memcpy(b.x, b.X, (size_t)(b.s.n * d) * sizeof *b.x);
      lg_shake(&b, 0.3);
      gradient(&b);
      check_gradient(&b);
      lg_free(&b);
    }
  sph_context_destroy(ctx);
}

/* A small deformation does not drown in the size of the positions. */
static void test_small_strain(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  lg_body b = lg_make(ctx, 2, 0, SPH_H_ARITHMETIC, 8);
  for (int64_t i = 0; i < b.s.n; i++) b.x[2 * i] = b.X[2 * i] * (1.0 + 0x1p-30);
  gradient(&b);
  for (int64_t i = 0; i < b.s.n; i++) check_rel(b.F[4 * i] - 1.0, 0x1p-30, 1e-5);
  memcpy(b.x, b.X, (size_t)(b.s.n * 2) * sizeof *b.x);
  gradient(&b);
  for (int64_t k = 0; k < b.s.n * 4; k++) assert_true(b.F[k] == (k % 4 == 0 || k % 4 == 3));
  lg_free(&b);
  sph_context_destroy(ctx);
}

/* A lone particle has no neighbours to say anything: F = 1. */
static void test_lone_particle(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  lg_body b = lg_make(ctx, 2, 0, SPH_H_ARITHMETIC, 8);
  b.X[0] = b.x[0] = 1e6;
  check_ok(sph_neighbors_build_arrays(b.s.list, 2, b.s.n, b.X, b.a.h, 0.0));
  check_ok(sph_gradient_matrix(b.s.list, b.s.kernel, &b.a, b.matrix, NULL, NULL));
  b.x[0] += 0.5;
  gradient(&b);
  assert_true(b.F[0] == 1.0 && b.F[1] == 0.0 && b.F[2] == 0.0 && b.F[3] == 1.0);
  lg_free(&b);
  sph_context_destroy(ctx);
}

/* ---- forces against plain sums -------------------------------------------------------------- */

static void check_force(const lg_body *b, const double *got, int64_t rows, lg_term term,
                        const void *data, const char *name) {
  int d = b->s.dim;
  double want[3], bound[3];
  for (int64_t i = 0; i < rows; i++) {
    lg_force(b, term, data, i, want, bound);
    for (int k = 0; k < d; k++)
      if (!(fabs(got[i * d + k] - want[k]) <= 1e-12 * (bound[k] + 1e-3)))
        fail_msg("%s, %d-D, particle %d: %.17g, not %.17g (bound %g)", name, d, (int)i,
                 got[i * d + k], want[k], bound[k]);
  }
}

static void check_all_forces(lg_body *b) {
  const double alpha = 0.6;
  int64_t rows = b->rows;
  double *out = rh_array(b->s.n * 3), *energy = rh_array(b->s.n);
  sph_operands a = b->a, plain = b->a;
  a.rows = plain.rows = rows;
  plain.gradient_matrix = NULL;
  check_ok(sph_piola_divergence(b->s.list, b->s.kernel, &a, SPH_PIOLA_CONSERVATIVE, b->P, out));
  check_force(b, out, rows, lg_conservative, NULL, "conservative");
  check_ok(sph_piola_divergence(b->s.list, b->s.kernel, &a, SPH_PIOLA_SUMMED, b->P, out));
  check_force(b, out, rows, lg_summed, b, "summed, corrected");
  check_ok(sph_piola_divergence(b->s.list, b->s.kernel, &plain, SPH_PIOLA_SUMMED, b->P, out));
  check_force(b, out, rows, lg_summed, NULL, "summed");
  for (int32_t form = 1; form <= 2; form++) {
    check_ok(sph_hourglass_force(b->s.list, b->s.kernel, &a, form, alpha, b->x, b->F, out, energy));
    check_force(b, out, rows, form == SPH_HOURGLASS_CENTRAL ? lg_central : lg_variational, &alpha,
                "hourglass control");
    for (int64_t i = 0; i < rows; i++)
      check_rel(energy[i], lg_spring_energy(b, form, alpha, i), 1e-11);
    check_ok(sph_hourglass_force(b->s.list, b->s.kernel, &a, form, alpha, b->x, b->F, out, NULL));
    check_force(b, out, rows, form == SPH_HOURGLASS_CENTRAL ? lg_central : lg_variational, &alpha,
                "hourglass control");
  }
  free(out);
  free(energy);
}

static void test_force_reference(void **state) {
  (void)state;
  static const uint32_t flavours[5] = {RH_VARY_ALL, RH_WRAP | RH_VARY_M, RH_GHOSTS | RH_VARY_ALL,
                                       RH_WRAP | RH_VARY_ALL, 0};
  sph_context *ctx = rh_context(1);
  for (int32_t d = 1; d <= 3; d++)
    for (int r = 0; r < 5; r++) {
      lg_body b = lg_make(ctx, d, flavours[r], rules[r], 31 + (uint64_t)r);
      if (!(flavours[r] & RH_WRAP)) lg_deform(&b, affine[d - 1], 0.2);
      lg_shake(&b, 0.1);
      gradient(&b);
      random_stress(&b);
      check_all_forces(&b);
      lg_free(&b);
    }
  sph_context_destroy(ctx);
}

/* ---- what is kept --------------------------------------------------------------------------- */

/* |sum m a| and |sum m x ^ a| by the sum of their absolute contributions. */
static void check_balance(const lg_body *b, const double *dvdt, double linear, double angular) {
  int d = b->s.dim;
  double sum[3] = {0}, turn[3] = {0}, size = 0.0, lever = 0.0;
  for (int64_t i = 0; i < b->s.n; i++)
    for (int k = 0; k < d; k++) {
      int l = (k + 1) % d;
      double f = b->a.m[i] * dvdt[i * d + k], g = b->a.m[i] * dvdt[i * d + l];
      sum[k] += f;
      size += fabs(f);
      if (d == 1 || (d == 2 && k == 1)) continue;
      turn[k] += b->x[i * d + k] * g - b->x[i * d + l] * f;
      lever += fabs(b->x[i * d + k] * g) + fabs(b->x[i * d + l] * f);
    }
  for (int k = 0; k < 3; k++) {
    assert_true(fabs(sum[k]) <= linear * size);
    assert_true(fabs(turn[k]) <= angular * lever);
  }
}

/* P = dpsi/dF of psi = mu/2 tr(C) - mu ln J + lambda/2 ln(J)^2, for which P F^T is symmetric. */
static double neo_hooke(int d, const double *F, double *P) {
  const double mu = 0.7, lambda = 1.1;
  double adj[9], J, tr = 0.0;
  if (d == 1) {
    adj[0] = 1.0;
    J = F[0];
  } else if (d == 2) {
    adj[0] = F[3];
    adj[1] = -F[1];
    adj[2] = -F[2];
    adj[3] = F[0];
    J = F[0] * F[3] - F[1] * F[2];
  } else {
    for (int r = 0; r < 3; r++)
      for (int c = 0; c < 3; c++) {
        int r1 = (c + 1) % 3, r2 = (c + 2) % 3, c1 = (r + 1) % 3, c2 = (r + 2) % 3;
        adj[r * 3 + c] = F[r1 * 3 + c1] * F[r2 * 3 + c2] - F[r1 * 3 + c2] * F[r2 * 3 + c1];
      }
    J = F[0] * adj[0] + F[1] * adj[3] + F[2] * adj[6];
  }
  for (int r = 0; r < d; r++)
    for (int c = 0; c < d; c++) {
      P[r * d + c] = mu * F[r * d + c] + (lambda * log(J) - mu) * adj[c * d + r] / J;
      tr += F[r * d + c] * F[r * d + c];
    }
  return 0.5 * mu * (tr - d) - mu * log(J) + 0.5 * lambda * log(J) * log(J);
}

/* Stresses of the deformation; the energy sum V psi. */
static double stress(lg_body *b) {
  int dd = b->s.dim * b->s.dim;
  double energy = 0.0;
  gradient(b);
  for (int64_t i = 0; i < b->s.n; i++)
    energy += b->a.m[i] / b->a.rho[i] * neo_hooke(b->s.dim, b->F + i * dd, b->P + i * dd);
  return energy;
}

static void test_balances(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t d = 1; d <= 3; d++) {
    lg_body b = lg_make(ctx, d, RH_VARY_ALL, SPH_H_ARITHMETIC, 77);
    double *out = rh_array(b.s.n * d);
    lg_deform(&b, affine[d - 1], 0.0);
    lg_shake(&b, 0.05);
    stress(&b);
    check_ok(sph_piola_divergence(b.s.list, b.s.kernel, &b.a, 1, b.P, out));
    check_balance(&b, out, 1e-15, 1e-12);
    for (int32_t form = 1; form <= 2; form++) {
      check_ok(sph_hourglass_force(b.s.list, b.s.kernel, &b.a, form, 0.5, b.x, b.F, out, NULL));
      check_balance(&b, out, 1e-15, 1e-12);
    }
    free(out);
    lg_free(&b);
  }
  sph_context_destroy(ctx);
}

/* A body that was only turned and moved has no force. */
static void test_rigid_rotation(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t d = 2; d <= 3; d++) {
    lg_body b = lg_make(ctx, d, RH_VARY_ALL, SPH_H_ARITHMETIC, 78);
    double R[9], *out = rh_array(b.s.n * d);
    lg_rotation(d, 2.1, R);
    lg_deform(&b, R, -4.0);
    stress(&b);
    for (int64_t k = 0; k < b.s.n * d * d; k++) check_close(b.P[k], 0.0, 1e-12);
    check_ok(sph_piola_divergence(b.s.list, b.s.kernel, &b.a, 1, b.P, out));
    for (int64_t k = 0; k < b.s.n * d; k++) check_close(out[k], 0.0, 1e-11);
    for (int32_t form = 1; form <= 2; form++) {
      check_ok(sph_hourglass_force(b.s.list, b.s.kernel, &b.a, form, 0.5, b.x, b.F, out, NULL));
      for (int64_t k = 0; k < b.s.n * d; k++) check_close(out[k], 0.0, 1e-11);
    }
    free(out);
    lg_free(&b);
  }
  sph_context_destroy(ctx);
}

/* Uniform stress: no force on particles whose neighbours all have full support. */
static void test_patch(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t d = 1; d <= 3; d++) {
    lg_body b = lg_make(ctx, d, RH_WRAP, SPH_H_ARITHMETIC, 4);
    for (int64_t i = 0; i < b.s.n; i++) { /* a perfect lattice, without ends */
      for (int c = 0; c < d; c++) b.X[i * d + c] = floor(b.X[i * d + c]) + 0.5;
      for (int k = 0; k < d * d; k++) b.P[i * d * d + k] = affine[d - 1][k];
      ((double *)(uintptr_t)b.a.rho)[i] = 1.3;
    }
    double *out = rh_array(b.s.n * d);
    check_ok(sph_neighbors_build_arrays(b.s.list, d, b.s.n, b.X, b.a.h, 0.0));
    check_ok(sph_gradient_matrix(b.s.list, b.s.kernel, &b.a, b.matrix, NULL, NULL));
    check_ok(sph_piola_divergence(b.s.list, b.s.kernel, &b.a, 1, b.P, out));
    for (int64_t k = 0; k < b.s.n * d; k++) check_close(out[k], 0.0, 1e-13);
    free(out);
    lg_free(&b);
  }
  sph_context_destroy(ctx);
}

/* ---- energies ------------------------------------------------------------------------------- */

static double hourglass_energy(lg_body *b, double alpha, double *scratch) {
  double sum = 0.0, *energy = scratch + b->s.n * 3;
  gradient(b);
  check_ok(
      sph_hourglass_force(b->s.list, b->s.kernel, &b->a, 1, alpha, b->x, b->F, scratch, energy));
  for (int64_t i = 0; i < b->s.n; i++) sum += energy[i];
  return sum;
}

/* The force is minus the derivative of the energy by the position, by central differences with one
 * step of extrapolation. */
static void check_derivative(lg_body *b, int springs) {
  const double alpha = 0.8, step = 2e-3;
  int d = b->s.dim;
  double *out = rh_array(b->s.n * 4), *force = rh_array(b->s.n * 4), size = 0.0;
  if (springs)
    hourglass_energy(b, alpha, force);
  else
    stress(b);
  if (!springs) check_ok(sph_piola_divergence(b->s.list, b->s.kernel, &b->a, 1, b->P, force));
  for (int64_t k = 0; k < b->s.n * d; k++) size = fmax(size, fabs(force[k]));
  for (int trial = 0; trial < 12; trial++) {
    int64_t k = (int64_t)(rh_bits() % (uint64_t)(b->s.n * d));
    double at = b->x[k], slope[2];
    for (int h = 0; h < 2; h++) {
      double e[2], s = step / (h + 1);
      for (int side = 0; side < 2; side++) {
        b->x[k] = at + (side ? s : -s);
        e[side] = springs ? hourglass_energy(b, alpha, out) : stress(b);
      }
      slope[h] = (e[1] - e[0]) / (2.0 * s);
    }
    b->x[k] = at;
    check_close(b->a.m[k / d] * force[k], -(4.0 * slope[1] - slope[0]) / 3.0, 2e-8 * size);
  }
  assert_true(size > 1e-2);
  free(out);
  free(force);
}

static void test_variational(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t d = 1; d <= 3; d++)
    for (int springs = 0; springs < 2; springs++) {
      lg_body b = lg_make(ctx, d, RH_VARY_ALL, SPH_H_ARITHMETIC, 15);
      lg_deform(&b, affine[d - 1], 0.0);
      lg_shake(&b, 0.1);
      check_derivative(&b, springs);
      lg_free(&b);
    }
  sph_context_destroy(ctx);
}

/* Every other particle displaced: F does not see it where the lattice is perfect, the springs do
 * and push back. */
static void test_checkerboard(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t d = 1; d <= 3; d++) {
    lg_body b = lg_make(ctx, d, RH_WRAP, SPH_H_ARITHMETIC, 4);
    double *out = rh_array(b.s.n * d), *side = rh_array(b.s.n);
    for (int64_t i = 0; i < b.s.n; i++) {
      double parity = 0.0;
      for (int c = 0; c < d; c++) {
        parity += floor(b.X[i * d + c]);
        b.X[i * d + c] = floor(b.X[i * d + c]) + 0.5;
      }
      side[i] = fmod(parity, 2.0) == 0.0 ? 1.0 : -1.0;
      ((double *)(uintptr_t)b.a.rho)[i] = 1.3;
      for (int c = 0; c < d; c++) b.x[i * d + c] = b.X[i * d + c];
      b.x[i * d] += 0.05 * side[i];
    }
    check_ok(sph_neighbors_build_arrays(b.s.list, d, b.s.n, b.X, b.a.h, 0.0));
    check_ok(sph_gradient_matrix(b.s.list, b.s.kernel, &b.a, b.matrix, NULL, NULL));
    gradient(&b);
    for (int64_t i = 0; i < b.s.n; i++)
      for (int k = 0; k < d * d; k++)
        check_close(b.F[i * d * d + k], k % (d + 1) == 0 ? 1.0 : 0.0, 1e-13);
    for (int32_t form = 1; form <= 2; form++) {
      check_ok(sph_hourglass_force(b.s.list, b.s.kernel, &b.a, form, 0.5, b.x, b.F, out, NULL));
      for (int64_t i = 0; i < b.s.n; i++) assert_true(out[i * d] * side[i] < -1e-3);
    }
    free(out);
    free(side);
    lg_free(&b);
  }
  sph_context_destroy(ctx);
}

/* ---- machines ------------------------------------------------------------------------------- */

/* Gradient, force and springs of one fixed problem. */
static double *everything(int32_t isa, int32_t threads, int32_t d, int64_t *count) {
  sph_context_options o;
  sph_context *ctx = NULL;
  sph_context_options_init(&o);
  o.isa = isa;
  o.threads = threads;
  if (sph_context_create(&o, &ctx) != SPH_OK) return NULL;
  lg_body b = lg_make(ctx, d, RH_VARY_ALL, SPH_H_ARITHMETIC, 15);
  int64_t n = b.s.n;
  double *out = rh_array(n * 19);
  *count = n * (d * d + 3 * d + 1);
  lg_deform(&b, affine[d - 1], 0.0);
  lg_shake(&b, 0.1);
  stress(&b);
  memcpy(out, b.F, (size_t)(n * d * d) * sizeof *out);
  double *at = out + n * d * d;
  check_ok(sph_piola_divergence(b.s.list, b.s.kernel, &b.a, 1, b.P, at));
  check_ok(sph_hourglass_force(b.s.list, b.s.kernel, &b.a, 1, 1.0, b.x, b.F, at + n * d, NULL));
  check_ok(sph_hourglass_force(b.s.list, b.s.kernel, &b.a, 2, 1.0, b.x, b.F, at + 2 * n * d,
                               at + 3 * n * d));
  lg_free(&b);
  sph_context_destroy(ctx);
  return out;
}

static void test_machines(void **state) {
  (void)state;
  static const int32_t isas[] = {SPH_ISA_AVX2, SPH_ISA_AVX512};
  for (int32_t d = 1; d <= 3; d++) {
    int64_t n = 0;
    double *plain = everything(SPH_ISA_PORTABLE, 1, d, &n), size = rh_largest(plain, n);
    double *three = everything(SPH_ISA_PORTABLE, 3, d, &n);
    assert_memory_equal(plain, three, (size_t)n * sizeof *plain);
    for (int k = 0; k < 2; k++) {
      double *one = everything(isas[k], 1, d, &n);
      if (!one) continue; /* this machine has no such set */
      double *more = everything(isas[k], 3, d, &n);
      assert_memory_equal(one, more, (size_t)n * sizeof *one);
      for (int64_t i = 0; i < n; i++) check_close(one[i], plain[i], 1e-13 * size);
      free(one);
      free(more);
    }
    free(plain);
    free(three);
  }
}

/* ---- refusals ------------------------------------------------------------------------------- */

static void test_errors(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  lg_body b = lg_make(ctx, 2, 0, SPH_H_ARITHMETIC, 4);
  sph_neighbors *l = b.s.list;
  sph_kernel *w = b.s.kernel;
  double *out = rh_array(b.s.n * 4), nan = NAN;
  sph_operands bare = b.a, silent = b.a;
  bare.gradient_matrix = NULL;
  silent.c = NULL;
  for (int64_t k = 0; k < b.s.n * 4; k++) out[k] = 7.0;
  check_status(sph_deformation_gradient(l, w, &b.a, NULL, out), SPH_ERR_ARG);
  check_status(sph_deformation_gradient(l, w, &bare, b.x, out), SPH_ERR_ARG);
  check_status(sph_deformation_gradient(l, w, NULL, b.x, out), SPH_ERR_ARG);
  check_status(sph_deformation_gradient(l, w, &b.a, b.x, NULL), SPH_ERR_ARG);
  check_status(sph_piola_divergence(l, w, &b.a, 0, b.P, out), SPH_ERR_ARG);
  check_status(sph_piola_divergence(l, w, &b.a, 3, b.P, out), SPH_ERR_ARG);
  check_status(sph_piola_divergence(l, w, &b.a, 1, NULL, out), SPH_ERR_ARG);
  check_status(sph_piola_divergence(l, w, &bare, 1, b.P, out), SPH_ERR_ARG);
  check_status(sph_hourglass_force(l, w, &b.a, 0, 0.1, b.x, b.F, out, NULL), SPH_ERR_ARG);
  check_status(sph_hourglass_force(l, w, &b.a, 3, 0.1, b.x, b.F, out, NULL), SPH_ERR_ARG);
  check_status(sph_hourglass_force(l, w, &b.a, 1, -0.1, b.x, b.F, out, NULL), SPH_ERR_ARG);
  check_status(sph_hourglass_force(l, w, &b.a, 1, nan, b.x, b.F, out, NULL), SPH_ERR_ARG);
  check_status(sph_hourglass_force(l, w, &b.a, 1, INFINITY, b.x, b.F, out, NULL), SPH_ERR_ARG);
  check_status(sph_hourglass_force(l, w, &b.a, 1, 0.1, NULL, b.F, out, NULL), SPH_ERR_ARG);
  check_status(sph_hourglass_force(l, w, &b.a, 1, 0.1, b.x, NULL, out, NULL), SPH_ERR_ARG);
  check_status(sph_hourglass_force(l, w, &silent, 1, 0.1, b.x, b.F, out, NULL), SPH_ERR_ARG);
  check_status(sph_hourglass_force(l, w, &bare, 1, 0.1, b.x, b.F, out, NULL), SPH_ERR_ARG);
  for (int64_t k = 0; k < b.s.n * 4; k++) assert_true(out[k] == 7.0);
  free(out);
  lg_free(&b);
  sph_context_destroy(ctx);
}

/* A NaN reaches the neighbours and nobody else. */
static void test_nan(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  lg_body b = lg_make(ctx, 2, 0, SPH_H_ARITHMETIC, 4);
  const int64_t *first;
  const int32_t *near;
  const int64_t bad = b.s.n / 2;
  b.x[2 * bad] = NAN;
  gradient(&b);
  check_ok(sph_neighbors_rows(b.s.list, &first, &near));
  for (int64_t i = 0; i < b.s.n; i++) {
    int touched = i == bad;
    for (int64_t k = first[i]; k < first[i + 1]; k++) touched |= near[k] == bad;
    assert_int_equal(isnan(b.F[4 * i]) != 0, touched);
  }
  lg_free(&b);
  sph_context_destroy(ctx);
}

static void test_empty(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_kernel *w;
  sph_neighbors *l;
  sph_operands a;
  double out[4], none[4] = {0};
  check_ok(sph_kernel_create(ctx, SPH_KERNEL_CUBIC_SPLINE, 2, &w));
  check_ok(sph_neighbors_create(ctx, NULL, &l));
  check_ok(sph_neighbors_build_arrays(l, 2, 0, none, NULL, 1.0));
  sph_operands_init(&a);
  a.dim = 2;
  check_ok(sph_deformation_gradient(l, w, &a, none, out));
  check_ok(sph_piola_divergence(l, w, &a, 1, none, out));
  check_ok(sph_hourglass_force(l, w, &a, 2, 0.1, none, none, out, NULL));
  sph_neighbors_destroy(l);
  sph_kernel_destroy(w);
  sph_context_destroy(ctx);
}

/* Outputs are untouched when memory is refused, and the list serves the next call. */
static sph_status starved(sph_context *ctx, void *user) {
  const lg_body *b = user;
  double out[4];
  sph_neighbors *l = NULL;
  sph_kernel *w = NULL;
  oom_pause();
  check_ok(sph_kernel_create(ctx, SPH_KERNEL_CUBIC_SPLINE, 2, &w));
  check_ok(sph_neighbors_create(ctx, NULL, &l));
  check_ok(sph_neighbors_build_arrays(l, 2, b->s.n, b->X, b->a.h, 0.0));
  oom_resume();
  sph_operands a = b->a;
  a.rows = 1;
  out[0] = 7.0;
  sph_status s = sph_deformation_gradient(l, w, &a, b->x, out);
  if (!s) {
    out[0] = 7.0;
    s = sph_piola_divergence(l, w, &a, 1, b->P, out);
  }
  if (!s) {
    out[0] = 7.0;
    s = sph_hourglass_force(l, w, &a, 2, 0.5, b->x, b->F, out, NULL);
  }
  if (s) assert_true(out[0] == 7.0);
  sph_neighbors_destroy(l);
  sph_kernel_destroy(w);
  return s;
}

static void test_memory(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  lg_body b = lg_make(ctx, 2, 0, SPH_H_ARITHMETIC, 4);
  stress(&b);
  oom_sweep(starved, &b);
  lg_free(&b);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_linear_exact),
    cmocka_unit_test(test_gradient_reference),
    cmocka_unit_test(test_small_strain),
    cmocka_unit_test(test_lone_particle),
    cmocka_unit_test(test_force_reference),
    cmocka_unit_test(test_balances),
    cmocka_unit_test(test_rigid_rotation),
    cmocka_unit_test(test_patch),
    cmocka_unit_test(test_variational),
    cmocka_unit_test(test_checkerboard),
    cmocka_unit_test(test_machines),
    cmocka_unit_test(test_errors),
    cmocka_unit_test(test_nan),
    cmocka_unit_test(test_empty),
    cmocka_unit_test(test_memory),
};
SPH_TEST_MAIN(tests)
