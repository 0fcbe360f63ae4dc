/* Kernel approximation of a function and of its gradient on a line with two ends.
 *
 * Equations   g(x) = (x - 1/2)^5 on [0, 1], g' = 5 (x - 1/2)^4
 *   g  plain       sum_j V_j g_j W_ij                               He 2015 (2.26)
 *   g  Shepard     the same over sum_j V_j W_ij                     (2.31)
 *   g' plain       sum_j V_j g_j dW_ij                              (2.28)
 *   g' corrected   with dW~_ij = dW_ij / sum_k V_k (x_k - x_i) dW_ik:
 *                  sum V_j g_j dW~, sum V_j (g_j - g_i) dW~, sum V_j (g_j + g_i) dW~   (2.33)
 * Set-up      N equally spaced particles, both ends included, dx = 1/(N-1), every V_j = dx (at the
 *             ends too), h = dx, cubic spline. He prints dx = .025 for N = 21; it is .05.
 * Reference   He 2015, tables 2.1 (N = 21) and 2.2 (N = 41, 61, 81; its first row repeats 2.1).
 * Norms       L1 = sum|e| / sum|exact|, L2 = sqrt(sum e^2 / sum exact^2), over particles.
 * Expected    every published figure to +-1e-4, the last printed digit. */
#include "result.h"

#include <sph/sph.h>

#include <stdlib.h>

#define TOLERANCE 1e-4

enum { LARGEST = 81 };

typedef struct line {
  int64_t n;
  double dx, x[LARGEST], g[LARGEST], dg[LARGEST];
  double inverse[LARGEST]; /* the 1-D gradient correction */
  sph_kernel *kernel;
  sph_neighbors *list;
  sph_operands operands;
} line;

typedef struct errors {
  double l1, l2;
} errors;

static void need(sph_context *ctx, sph_status status) {
  if (status == SPH_OK) return;
  fprintf(stderr, "%s: %s\n", sph_status_name(status), sph_context_last_error(ctx));
  exit(2);
}

static void setup(sph_context *ctx, line *l, int64_t n) {
  l->n = n;
  l->dx = 1.0 / (double)(n - 1);
  for (int64_t i = 0; i < n; ++i) {
    const double s = (double)i * l->dx - 0.5;
    l->x[i] = (double)i * l->dx;
    l->g[i] = s * s * s * s * s;
    l->dg[i] = 5.0 * s * s * s * s;
  }
  need(ctx, sph_kernel_create(ctx, SPH_KERNEL_CUBIC_SPLINE, 1, &l->kernel));
  need(ctx, sph_neighbors_create(ctx, NULL, &l->list));
  need(ctx, sph_neighbors_build_arrays(l->list, 1, n, l->x, NULL, l->dx));
  sph_operands_init(&l->operands);
  l->operands.dim = 1;
  l->operands.n = n;
  l->operands.x = l->x;
  l->operands.h0 = l->dx;
  l->operands.m0 = l->dx; /* V_j = m / rho = dx */
  l->operands.rho0 = 1.0;
  need(ctx, sph_gradient_matrix(l->list, l->kernel, &l->operands, l->inverse, NULL, NULL));
}

static void teardown(line *l) {
  sph_neighbors_destroy(l->list);
  sph_kernel_destroy(l->kernel);
}

static errors compare(int64_t n, const double *u, const double *exact) {
  double e1 = 0.0, e2 = 0.0, s1 = 0.0, s2 = 0.0;
  for (int64_t i = 0; i < n; ++i) {
    const double e = u[i] - exact[i];
    e1 += fabs(e);
    e2 += e * e;
    s1 += fabs(exact[i]);
    s2 += exact[i] * exact[i];
  }
  return (errors){e1 / s1, sqrt(e2 / s2)};
}

static errors function_errors(sph_context *ctx, line *l, int32_t shepard) {
  double u[LARGEST];
  need(ctx, sph_interpolate(l->list, l->kernel, &l->operands, shepard, 1, l->g, u));
  return compare(l->n, u, l->g);
}

static errors gradient_errors(sph_context *ctx, line *l, int32_t variant, int corrected) {
  double u[LARGEST];
  sph_operands operands = l->operands;
  operands.gradient_matrix = corrected ? l->inverse : NULL;
  need(ctx, sph_gradient(l->list, l->kernel, &operands, variant, 1, l->g, u));
  return compare(l->n, u, l->dg);
}

static int judge(const char *quantity, int64_t n, errors measured, errors published,
                 const char *source) {
  char keys[160];
  snprintf(keys, sizeof keys, "case=kernel_approximation quantity=%s_L1 n=%d", quantity, (int)n);
  int failures = result_line(keys, measured.l1, published.l1, source, TOLERANCE, 0);
  snprintf(keys, sizeof keys, "case=kernel_approximation quantity=%s_L2 n=%d", quantity, (int)n);
  return failures + result_line(keys, measured.l2, published.l2, source, TOLERANCE, 0);
}

static int table_2_1(sph_context *ctx) {
  const char *source = "He 2015 table 2.1";
  line l;
  int failures = 0;
  setup(ctx, &l, 21);
  failures += judge("g_plain", 21, function_errors(ctx, &l, 0), (errors){0.1373, 0.1943}, source);
  failures += judge("g_shepard", 21, function_errors(ctx, &l, 1), (errors){0.0680, 0.0724}, source);
  failures += judge("dg_plain", 21, gradient_errors(ctx, &l, SPH_GRADIENT_PLAIN, 0),
                    (errors){0.6504, 1.2282}, source);
  failures += judge("dg_corrected_plain", 21, gradient_errors(ctx, &l, SPH_GRADIENT_PLAIN, 1),
                    (errors){0.8835, 1.6841}, source);
  failures +=
      judge("dg_corrected_difference", 21, gradient_errors(ctx, &l, SPH_GRADIENT_DIFFERENCE, 1),
            (errors){0.0940, 0.1410}, source);
  failures += judge("dg_corrected_sum", 21, gradient_errors(ctx, &l, SPH_GRADIENT_SUM, 1),
                    (errors){1.6730, 3.2283}, source);
  teardown(&l);
  return failures;
}

static int table_2_2(sph_context *ctx) {
  const char *source = "He 2015 table 2.2";
  static const struct {
    int64_t n;
    errors g, dg;
  } rows[] = {{41, {0.0215, 0.0306}, {0.0279, 0.0576}},
              {61, {0.0103, 0.0177}, {0.0131, 0.0329}},
              {81, {0.0060, 0.0119}, {0.0076, 0.0220}}};
  int failures = 0;
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
    line l;
    setup(ctx, &l, rows[i].n);
    failures += judge("g_shepard", l.n, function_errors(ctx, &l, 1), rows[i].g, source);
    failures += judge("dg_corrected_difference", l.n,
                      gradient_errors(ctx, &l, SPH_GRADIENT_DIFFERENCE, 1), rows[i].dg, source);
    teardown(&l);
  }
  return failures;
}

int main(void) {
  sph_context *ctx = NULL;
  if (sph_context_create(NULL, &ctx) != SPH_OK) return 2;
  const int failures = table_2_1(ctx) + table_2_2(ctx);
  sph_context_destroy(ctx);
  return failures != 0;
}
