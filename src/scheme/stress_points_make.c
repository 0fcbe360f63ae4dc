/* Stress points: life of the handle, placing, binding to an integrator. */
#include "stress_points_impl.h"

#include <math.h>
#include <string.h>

void sph_stress_points_options_init_sized(sph_stress_points_options *options, size_t size) {
  const sph_stress_points_options defaults = {
      .size = sizeof defaults, .offset = 0.5, .form = SPH_STRESS_DIFFERENCE, .corrected = 1};
  sphi_options_init(options, size, &defaults, sizeof defaults);
}

static sph_status check_options(sph_context *ctx, const sph_stress_points_options *o) {
  if (!(o->offset >= 0.0 && o->offset <= 0.5))
    return sphi_fail(ctx, SPH_ERR_ARG, "stress points: offset %g is not within 0 .. 0.5",
                     o->offset);
  if (o->form != SPH_STRESS_SUMMED && o->form != SPH_STRESS_DIFFERENCE)
    return sphi_fail(ctx, SPH_ERR_ARG, "stress points: form %d", o->form);
  return SPH_OK;
}

sph_status sph_stress_points_create(sph_context *ctx, sph_kernel *kernel, sph_neighbors *list,
                                    const sph_stress_points_options *options,
                                    sph_stress_points **out) {
  sph_stress_points_options own;
  if (out) *out = NULL;
  sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (!s) s = sphi_check_handle(ctx, kernel, SPHI_MAGIC_KERNEL, "kernel");
  if (!s) s = sphi_check_handle(ctx, list, SPHI_MAGIC_NEIGHBORS, "list");
  if (s) return s;
  if (!out) return sphi_fail(ctx, SPH_ERR_ARG, "stress points: out is NULL");
  sph_stress_points_options_init(&own);
  s = sphi_options_read(ctx, &own, sizeof own, options);
  if (!s) s = check_options(ctx, &own);
  if (s) return s;
  sph_stress_points *p = sphi_calloc(ctx, sizeof *p);
  if (!p) return SPH_ERR_NOMEM;
  p->base.magic = SPHI_MAGIC_STRESS_POINTS;
  p->base.ctx = ctx;
  p->options = own;
  p->kernel = kernel;
  p->list = list;
  sphi_context_retain(ctx);
  sphi_kernel_retain(kernel);
  *out = p;
  return SPH_OK;
}

static int is_points(const sph_stress_points *p) {
  return sphi_check_handle(NULL, p, SPHI_MAGIC_STRESS_POINTS, "points") == SPH_OK;
}

static void free_points(sph_stress_points *p) {
  sphi_free(p->base.ctx, p->offsets, p->offset_bytes);
  sphi_free(p->base.ctx, p->stresses, p->stress_bytes);
}

void sph_stress_points_destroy(sph_stress_points *p) {
  if (!is_points(p)) return;
  sph_context *ctx = p->base.ctx;
  for (int k = 0; k < SPHI_POINT_PHASES; ++k)
    if (p->materials[k]) sphi_material_release(p->materials[k]);
  free_points(p);
  sphi_buffer_free(ctx, &p->scratch);
  sphi_kernel_release(p->kernel);
  p->base.magic = 0;
  sphi_free(ctx, p, sizeof *p);
  sphi_context_release(ctx);
}

sph_status sph_stress_points_set_material(sph_stress_points *p, int32_t phase,
                                          sph_material *material) {
  sph_status s = sphi_check_handle(NULL, p, SPHI_MAGIC_STRESS_POINTS, "points");
  if (s) return s;
  if (phase < 0 || phase >= SPHI_POINT_PHASES)
    return sphi_fail(p->base.ctx, SPH_ERR_ARG, "stress points: phase %d", phase);
  if (material) {
    s = sphi_check_handle(p->base.ctx, material, SPHI_MAGIC_MATERIAL, "material");
    if (s) return s;
    sphi_material_retain(material);
  }
  if (p->materials[phase]) sphi_material_release(p->materials[phase]);
  p->materials[phase] = material;
  return SPH_OK;
}

int64_t sph_stress_points_count(const sph_stress_points *p) { return is_points(p) ? p->count : 0; }

double *sph_stress_points_offsets(sph_stress_points *p) { return is_points(p) ? p->offsets : NULL; }

double *sph_stress_points_stresses(sph_stress_points *p) {
  return is_points(p) ? p->stresses : NULL;
}

/* --- placing ------------------------------------------------------------------------------ */

static sph_status check_set(const sph_stress_points *p, const sph_particles *set) {
  sph_context *ctx = p->base.ctx;
  const double *m = sph_particles_field_const(set, SPH_FIELD_M);
  const double *rho = sph_particles_field_const(set, SPH_FIELD_RHO);
  const int32_t dim = sph_particles_dim(set);
  if (dim != p->kernel->dim)
    return sphi_fail(ctx, SPH_ERR_ARG, "stress points: the set is %d-D, the kernel %d-D", dim,
                     p->kernel->dim);
  if (!m || !rho)
    return sphi_fail(ctx, SPH_ERR_ARG, "stress points: the set has no field %s", m ? "rho" : "m");
  for (int64_t i = 0; i < sph_particles_real_count(set); ++i)
    if (!(m[i] > 0.0) || !(rho[i] > 0.0) || !isfinite(m[i]) || !isfinite(rho[i]))
      return sphi_fail(ctx, SPH_ERR_ARG, "stress points: particle %lld has mass %g, density %g",
                       (long long)i, m[i], rho[i]);
  if ((sph_particles_real_count(set) << dim) + sph_particles_count(set) > INT32_MAX - 64)
    return sphi_fail(ctx, SPH_ERR_LIMIT, "stress points: %lld particles are too many",
                     (long long)sph_particles_real_count(set));
  return SPH_OK;
}

/* Point k of a particle lies on the side of axis a that bit a of k says. */
static void place_points(sph_stress_points *p, const sph_particles *set) {
  const int32_t dim = p->dim, c = sph_sym_components(dim), fan = 1 << dim;
  const double *m = sph_particles_field_const(set, SPH_FIELD_M);
  const double *rho = sph_particles_field_const(set, SPH_FIELD_RHO);
  const double *sigma = sph_particles_field_const(set, SPH_FIELD_SIGMA);
  for (int64_t q = 0; q < p->count; ++q) {
    const int64_t i = q / fan;
    const double r = p->options.offset * pow(m[i] / rho[i], 1.0 / dim);
    for (int32_t a = 0; a < dim; ++a) p->offsets[q * dim + a] = q >> a & 1 ? r : -r;
    for (int32_t k = 0; k < c; ++k) p->stresses[q * c + k] = sigma ? sigma[i * c + k] : 0.0;
  }
}

sph_status sph_stress_points_place(sph_stress_points *p, const sph_particles *set) {
  sph_status s = sphi_check_handle(NULL, p, SPHI_MAGIC_STRESS_POINTS, "points");
  if (!s) s = sphi_check_handle(p->base.ctx, set, SPHI_MAGIC_PARTICLES, "set");
  if (!s) s = check_set(p, set);
  if (s) return s;
  const int32_t dim = sph_particles_dim(set);
  const int64_t count = sph_particles_real_count(set) << dim;
  const size_t offset_bytes = sphi_mul((size_t)(count * dim), sizeof(double));
  const size_t stress_bytes = sphi_mul((size_t)(count * sph_sym_components(dim)), sizeof(double));
  double *offsets = sphi_alloc(p->base.ctx, offset_bytes);
  if (!offsets) return SPH_ERR_NOMEM;
  double *stresses = sphi_alloc(p->base.ctx, stress_bytes);
  if (!stresses) {
    sphi_free(p->base.ctx, offsets, offset_bytes);
    return SPH_ERR_NOMEM;
  }
  free_points(p);
  p->offsets = offsets;
  p->stresses = stresses;
  p->offset_bytes = offset_bytes;
  p->stress_bytes = stress_bytes;
  p->dim = dim;
  p->count = count;
  place_points(p, set);
  return SPH_OK;
}

/* --- integrating -------------------------------------------------------------------------- */

sph_status sph_stress_points_bind(sph_stress_points *p, sph_integrator *it) {
  sph_status s = sphi_check_handle(NULL, p, SPHI_MAGIC_STRESS_POINTS, "points");
  if (!s) s = sphi_check_handle(p->base.ctx, it, SPHI_MAGIC_INTEGRATOR, "it");
  if (s) return s;
  if (p->dim == 0) return sphi_fail(p->base.ctx, SPH_ERR_STATE, "stress points: none are placed");
  s = sph_integrator_bind_array(it, p->offsets, p->count * p->dim);
  if (!s) s = sph_integrator_bind_array(it, p->stresses, p->count * sph_sym_components(p->dim));
  if (!s) s = sph_integrator_bind_field(it, SPH_FIELD_V);
  if (!s) s = sph_integrator_bind_field(it, SPH_FIELD_X);
  return s ? s : sph_integrator_set_function(it, sph_stress_points_rates, p);
}
