/* Total-Lagrangian operators: deformation gradient, divergence of the first Piola-Kirchhoff stress,
 * hourglass control. */
#include "operators_impl.h"

#include "../sweep/frozen.h"

#include <math.h>
#include <string.h>

enum { SCRATCH_RECORDS = 0, SCRATCH_SLOPE = 4, SCRATCH_VALUE = 5 };

static sph_status reserve(sph_neighbors *list, int slot, int64_t doubles) {
  return sphi_buffer_reserve(list->base.ctx, &list->scratch[slot],
                             sphi_mul((size_t)doubles, sizeof(double)));
}

/* The pairs of the configuration, weighted; scratch for the sums in list->scratch[0]. */
static sph_status freeze(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *own,
                         int with_value, sphi_frozen *z) {
  sph_status s = reserve(list, SCRATCH_RECORDS, sphi_frozen_scratch(own->dim, own->n));
  if (!s) s = reserve(list, SCRATCH_SLOPE, sphi_frozen_pairs(list));
  if (!s && with_value) s = reserve(list, SCRATCH_VALUE, sphi_frozen_pairs(list));
  if (s) return s;
  *z = (sphi_frozen){.list = list,
                     .kernel = kernel,
                     .a = own,
                     .slope = list->scratch[SCRATCH_SLOPE].ptr,
                     .value = with_value ? list->scratch[SCRATCH_VALUE].ptr : NULL};
  sphi_frozen_weights(z, list->scratch[SCRATCH_RECORDS].ptr);
  return SPH_OK;
}

static sph_status check_extra(sph_neighbors *list, const sph_operands *own, const double *array,
                              const char *what, const char *name) {
  if (array || own->n == 0) return SPH_OK;
  return sphi_fail(list->base.ctx, SPH_ERR_ARG, "%s: %s is NULL", name, what);
}

sph_status sph_deformation_gradient(sph_neighbors *list, const sph_kernel *kernel,
                                    const sph_operands *a, const double *x, double *F) {
  static const char name[] = "sph_deformation_gradient";
  uint32_t needs = SPHI_NEED_M | SPHI_NEED_RHO | SPHI_NEED_MATRIX;
  sph_operands own;
  sphi_frozen z;
  sph_status s = sphi_operator_begin(list, kernel, a, needs, F, name, &own);
  if (!s) s = check_extra(list, &own, x, "x", name);
  if (s || own.n == 0) return s;
  s = freeze(list, kernel, &own, 0, &z);
  if (s) return s;
  sphi_frozen_gradient(&z, x, own.x, 1, own.rows, list->scratch[SCRATCH_RECORDS].ptr, F);
  return SPH_OK;
}

static sph_status run_force(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *own,
                            const sphi_frozen_force *force) {
  sphi_frozen z;
  int central = (force->terms & SPHI_FROZEN_HOURGLASS_CENTRAL) != 0;
  sph_status s = freeze(list, kernel, own, central, &z);
  if (s) return s;
  memset(force->dvdt, 0, (size_t)(own->rows * own->dim) * sizeof *force->dvdt);
  sphi_frozen_add_force(&z, force, list->scratch[SCRATCH_RECORDS].ptr);
  return SPH_OK;
}

sph_status sph_piola_divergence(sph_neighbors *list, const sph_kernel *kernel,
                                const sph_operands *a, int32_t form, const double *P,
                                double *dvdt) {
  static const char name[] = "sph_piola_divergence";
  sph_operands own;
  sph_status s =
      sphi_operator_begin(list, kernel, a, SPHI_NEED_M | SPHI_NEED_RHO, dvdt, name, &own);
  if (!s && (form < SPH_PIOLA_CONSERVATIVE || form > SPH_PIOLA_SUMMED))
    s = sphi_fail(list->base.ctx, SPH_ERR_ARG, "%s: unknown form %d", name, form);
  if (!s && form == SPH_PIOLA_CONSERVATIVE)
    s = check_extra(list, &own, own.gradient_matrix, "gradient_matrix", name);
  if (!s) s = check_extra(list, &own, P, "P", name);
  if (s || own.n == 0) return s;
  sphi_frozen_force force = {.terms = form == SPH_PIOLA_SUMMED ? SPHI_FROZEN_PIOLA_ROW
                                                               : SPHI_FROZEN_PIOLA,
                             .corrected = own.gradient_matrix != NULL,
                             .P = P,
                             .dvdt = dvdt};
  return run_force(list, kernel, &own, &force);
}

sph_status sph_hourglass_force(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *a,
                               int32_t form, double alpha, const double *x, const double *F,
                               double *dvdt, double *energy) {
  static const char name[] = "sph_hourglass_force";
  uint32_t needs = SPHI_NEED_M | SPHI_NEED_RHO | SPHI_NEED_C | SPHI_NEED_MATRIX;
  sph_operands own;
  sph_status s = sphi_operator_begin(list, kernel, a, needs, dvdt, name, &own);
  if (!s && (form < SPH_HOURGLASS_VARIATIONAL || form > SPH_HOURGLASS_CENTRAL))
    s = sphi_fail(list->base.ctx, SPH_ERR_ARG, "%s: unknown form %d", name, form);
  if (!s && !(isfinite(alpha) && alpha >= 0.0))
    s = sphi_fail(list->base.ctx, SPH_ERR_ARG, "%s: alpha %g", name, alpha);
  if (!s) s = check_extra(list, &own, x, "x", name);
  if (!s) s = check_extra(list, &own, F, "F", name);
  if (s || own.n == 0) return s;
  sphi_frozen_force force = {.terms = form == SPH_HOURGLASS_CENTRAL ? SPHI_FROZEN_HOURGLASS_CENTRAL
                                                                    : SPHI_FROZEN_HOURGLASS,
                             .x = x,
                             .F = F,
                             .hourglass = alpha,
                             .dvdt = dvdt,
                             .energy = energy};
  if (energy) force.terms |= SPHI_FROZEN_ENERGY;
  return run_force(list, kernel, &own, &force);
}
