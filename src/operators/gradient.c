/* Gradients of velocity and of any field. A field of many components is swept a few at a time. */
#include "operators_impl.h"

sph_status sph_velocity_gradient(sph_neighbors *list, const sph_kernel *kernel,
                                 const sph_operands *a, double *L) {
  sph_operands own;
  sph_status s = sphi_operator_begin(list, kernel, a, SPHI_NEED_V | SPHI_NEED_M | SPHI_NEED_RHO, L,
                                     "sph_velocity_gradient", &own);
  if (s) return s;
  sphi_sweep sweep = sphi_sweep_of(kernel, &own, SPHI_GRADV);
  sweep.gradv = L;
  return sphi_sweep_run(list, &sweep);
}

static sph_status check_gradient(sph_context *ctx, int32_t variant, int32_t components,
                                 const double *f) {
  if (variant < SPH_GRADIENT_PLAIN || variant > SPH_GRADIENT_SUM)
    return sphi_fail(ctx, SPH_ERR_ARG, "sph_gradient: unknown variant %d", variant);
  if (components < 1) return sphi_fail(ctx, SPH_ERR_ARG, "sph_gradient: %d components", components);
  return f ? SPH_OK : sphi_fail(ctx, SPH_ERR_ARG, "sph_gradient: f is NULL");
}

sph_status sph_gradient(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *a,
                        int32_t variant, int32_t components, const double *f, double *grad) {
  sph_operands own;
  sph_status s =
      sphi_operator_begin(list, kernel, a, SPHI_NEED_M | SPHI_NEED_RHO, grad, "sph_gradient", &own);
  if (!s) s = check_gradient(list->base.ctx, variant, components, f);
  if (s) return s;
  sphi_sweep sweep = sphi_sweep_of(kernel, &own, SPHI_GRADF);
  sweep.variant = variant;
  sweep.f_stride = components;
  sweep.gradf_stride = (int64_t)components * own.dim;
  for (int32_t c = 0; !s && c < components; c += SPHI_FIELD_WIDTH) {
    sweep.f = f + c;
    sweep.f_count = components - c < SPHI_FIELD_WIDTH ? components - c : SPHI_FIELD_WIDTH;
    sweep.gradf = grad + (int64_t)c * own.dim;
    s = sphi_sweep_run(list, &sweep);
  }
  return s;
}
