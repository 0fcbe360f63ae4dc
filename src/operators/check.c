/* What every operator checks before it touches anything. */
#include "operators_impl.h"

#include "../particles/particles_impl.h"

#include <math.h>
#include <string.h>

void sph_operands_init_sized(sph_operands *operands, size_t size) {
  if (!operands || size < sizeof(size_t)) return;
  sph_operands defaults = {.size = sizeof defaults, .rows = -1};
  memset(operands, 0, size);
  memcpy(operands, &defaults, size < sizeof defaults ? size : sizeof defaults);
  operands->size = size;
}

static sph_status check_handles(sph_neighbors *list, const sph_kernel *kernel,
                                const sph_operands *a, const void *output, const char *name) {
  sph_status status = sphi_check_handle(NULL, list, SPHI_MAGIC_NEIGHBORS, "list");
  if (status) return status;
  status = sphi_check_handle(list->base.ctx, kernel, SPHI_MAGIC_KERNEL, "kernel");
  if (status) return status;
  if (!a) return sphi_fail(list->base.ctx, SPH_ERR_ARG, "%s: the operands are NULL", name);
  if (!output) return sphi_fail(list->base.ctx, SPH_ERR_ARG, "%s: the output is NULL", name);
  return SPH_OK;
}

static sph_status check_sizes(sph_neighbors *list, const sph_kernel *kernel, sph_operands *a,
                              const char *name) {
  sph_context *ctx = list->base.ctx;
  if (a->dim != kernel->dim)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: operands are %d-D, the kernel is %d-D", name, a->dim,
                     kernel->dim);
  if (a->n < 0 || a->rows < -1 || a->rows > a->n)
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: n = %lld, rows = %lld", name, (long long)a->n,
                     (long long)a->rows);
  if (a->rows == -1) a->rows = a->n;
  if (list->options.support < kernel->support * (1.0 - 1e-12))
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: the list reaches %g h, the kernel %g h", name,
                     list->options.support, kernel->support);
  return sphi_neighbors_check(list, a->dim, a->n);
}

static sph_status check_scalar(sph_context *ctx, const double *array, double uniform,
                               const char *what, const char *name) {
  if (array || (isfinite(uniform) && uniform > 0.0)) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_ARG, "%s: %s is NULL and its uniform value is %g", name, what,
                   uniform);
}

static sph_status check_array(sph_context *ctx, const double *array, const char *what,
                              const char *name) {
  return array ? SPH_OK : sphi_fail(ctx, SPH_ERR_ARG, "%s: %s is NULL", name, what);
}

static sph_status check_needs(sph_context *ctx, const sph_operands *a, uint32_t needs,
                              const char *name) {
  sph_status s = check_array(ctx, a->x, "x", name);
  if (!s) s = check_scalar(ctx, a->h, a->h0, "h", name);
  if (!s && (needs & SPHI_NEED_V)) s = check_array(ctx, a->v, "v", name);
  if (!s && (needs & SPHI_NEED_M)) s = check_scalar(ctx, a->m, a->m0, "m", name);
  if (!s && (needs & SPHI_NEED_RHO)) s = check_scalar(ctx, a->rho, a->rho0, "rho", name);
  if (!s && (needs & SPHI_NEED_C)) s = check_scalar(ctx, a->c, a->c0, "c", name);
  if (!s && (needs & SPHI_NEED_SIGMA)) s = check_array(ctx, a->sigma, "sigma", name);
  if (!s && (needs & SPHI_NEED_MATRIX))
    s = check_array(ctx, a->gradient_matrix, "gradient_matrix", name);
  return s;
}

sph_status sphi_operator_begin(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *a,
                               uint32_t needs, const void *output, const char *name,
                               sph_operands *own) {
  sph_status s = check_handles(list, kernel, a, output, name);
  if (s) return s;
  sph_operands_init(own);
  s = sphi_options_read(list->base.ctx, own, sizeof *own, a);
  if (!s) s = check_sizes(list, kernel, own, name);
  if (!s && own->n > 0) s = check_needs(list->base.ctx, own, needs, name);
  if (!s && own->n > 0) s = sphi_neighbors_fresh(list, own->x, own->h, own->h0);
  return s;
}

sphi_sweep sphi_sweep_of(const sph_kernel *kernel, const sph_operands *own, uint32_t terms) {
  sphi_sweep s;
  memset(&s, 0, sizeof s);
  s.kernel = kernel;
  s.a = own;
  s.spec.terms = terms;
  s.spec.corrected = own->gradient_matrix ? terms : 0;
  s.spec.continuity = SPH_CONTINUITY_MASS;
  s.spec.pressure = SPH_PRESSURE_MASS;
  s.spec.stress = SPH_STRESS_SUMMED;
  return s;
}

sph_status sph_operands_from_set(sph_particles *set, sph_operands *operands) {
  sph_status status = sphi_check_handle(NULL, set, SPHI_MAGIC_PARTICLES, "set");
  if (status) return status;
  if (!operands)
    return sphi_fail(sphi_particles_context(set), SPH_ERR_ARG, "the operands are NULL");
  sph_operands_init(operands);
  operands->dim = sph_particles_dim(set);
  operands->n = sph_particles_count(set);
  operands->rows = sph_particles_real_count(set);
  operands->x = sph_particles_field_const(set, SPH_FIELD_X);
  operands->v = sph_particles_field_const(set, SPH_FIELD_V);
  operands->m = sph_particles_field_const(set, SPH_FIELD_M);
  operands->rho = sph_particles_field_const(set, SPH_FIELD_RHO);
  operands->h = sph_particles_field_const(set, SPH_FIELD_H);
  operands->p = sph_particles_field_const(set, SPH_FIELD_P);
  operands->c = sph_particles_field_const(set, SPH_FIELD_C);
  operands->sigma = sph_particles_field_const(set, SPH_FIELD_SIGMA);
  operands->e = sph_particles_field_const(set, SPH_FIELD_E);
  operands->omega = sph_particles_field_const(set, SPH_FIELD_OMEGA);
  return SPH_OK;
}
