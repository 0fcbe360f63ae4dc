/* A velocity pulse in an elastic bar splits in two; d'Alembert says how. E = rho = c = 1. */
#include <sph/sph.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { N = 400, STEPS = 100 };
static const double dp = 1.0 / N, end = 0.25;
static sph_context *ctx;

static double pulse(double x) { return 1e-4 * exp(-400.0 * (x - 0.5) * (x - 0.5)); }

static void need(sph_status status) {
  if (status == SPH_OK) return;
  fprintf(stderr, "%s: %s\n", sph_status_name(status), sph_context_last_error(ctx));
  exit(1);
}

int main(void) {
  static const int32_t fields[] = {SPH_FIELD_X, SPH_FIELD_V,   SPH_FIELD_SIGMA,
                                   SPH_FIELD_M, SPH_FIELD_RHO, SPH_FIELD_H};
  static const int32_t kinds[] = {SPH_TERM_MOTION, SPH_TERM_STRESS, SPH_TERM_STRESS_RATE};
  double *f[6], error = 0.0, norm = 0.0;
  sph_particles *set;
  sph_neighbors *list;
  sph_kernel *kernel;
  sph_material *hooke;
  sph_rhs *rhs;
  sph_integrator *rk4;

  sph_particles_options bar;
  sph_particles_options_init(&bar);
  bar.dim = 1;
  sph_hooke_options elastic;
  sph_hooke_options_init(&elastic);
  elastic.young = elastic.density = 1.0;
  need(sph_context_create(NULL, &ctx)); /* NULL: the defaults, here one thread, memory of libc */
  need(sph_particles_create(ctx, &bar, &set));
  need(sph_neighbors_create(ctx, NULL, &list)); /* cells; all within 2 h */
  need(sph_kernel_create(ctx, SPH_KERNEL_CUBIC_SPLINE, 1, &kernel));
  need(sph_material_create_hooke(ctx, &elastic, &hooke));
  need(sph_rhs_create(ctx, kernel, NULL, &rhs));
  need(sph_integrator_create(ctx, NULL, &rk4)); /* the classical Runge-Kutta method */

  need(sph_particles_add(set, N, NULL));
  for (int k = 0; k < 6; ++k) need(sph_particles_field(set, fields[k], &f[k])); /* zero-filled */
  for (int i = 0; i < N; ++i) {
    f[0][i] = (i + 0.5) * dp;
    f[1][i] = pulse(f[0][i]);
    f[3][i] = dp;
    f[4][i] = 1.0;
    f[5][i] = 1.5 * dp;
  }
  need(sph_rhs_set_material(rhs, 0, hooke)); /* phase 0: every particle */
  need(sph_integrator_set_rhs(rk4, rhs, list));
  for (int k = 0; k < 3; ++k) {
    sph_term term;
    sph_term_init(&term);
    term.kind = kinds[k];
    term.corrected = k > 0; /* gradients that are exact for linear fields */
    need(sph_rhs_add(rhs, &term));
    need(sph_integrator_bind_field(rk4, fields[k]));
  }
  for (int k = 0; k < STEPS; ++k)
    need(sph_integrator_step(rk4, set, k * end / STEPS, end / STEPS, NULL));

  for (int i = 0; i < N; ++i) {
    double x = (i + 0.5) * dp, exact = 0.5 * (pulse(x - end) + pulse(x + end));
    error += fabs(f[1][i] - exact);
    norm += fabs(exact);
  }
  printf("%d particles, %d steps: relative error %.4f\n", N, STEPS, error / norm);
  sph_integrator_destroy(rk4);
  sph_rhs_destroy(rhs);
  sph_material_destroy(hooke);
  sph_kernel_destroy(kernel);
  sph_neighbors_destroy(list);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
  return error / norm > 0.02;
}
