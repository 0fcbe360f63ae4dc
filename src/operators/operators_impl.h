/* Shared by the operators: argument checks, and the sweeps that the composed right-hand side also
 * runs. */
#ifndef SPHI_OPERATORS_IMPL_H
#define SPHI_OPERATORS_IMPL_H

#include "../sweep/smoothed.h"
#include "../sweep/sweep.h"

#include <sph/correction.h>
#include <sph/operators.h>

/* Arrays an operator needs, besides x. */
enum {
  SPHI_NEED_V = 1 << 0,
  SPHI_NEED_M = 1 << 1,
  SPHI_NEED_RHO = 1 << 2,
  SPHI_NEED_P = 1 << 3, /* may be the uniform p0, also 0 */
  SPHI_NEED_C = 1 << 4,
  SPHI_NEED_SIGMA = 1 << 5,
  SPHI_NEED_MATRIX = 1 << 6
};

/* Check handles, sizes and needed arrays, and copy the caller's operands over *own, with `rows`
 * filled in. `name` is the operator's, for the sentence. */
sph_status sphi_operator_begin(sph_neighbors *list, const sph_kernel *kernel, const sph_operands *a,
                               uint32_t needs, const void *output, const char *name,
                               sph_operands *own);

/* A sweep with one set of terms, corrected where the operands have a matrix. */
sphi_sweep sphi_sweep_of(const sph_kernel *kernel, const sph_operands *own, uint32_t terms);

/* The viscous pressure of one particle from its velocity divergence, He 2015 (3.14) to (3.17). */
double sphi_bulk_pressure(const sph_bulk_viscosity *o, double div, double h, double rho, double c);

/* B^-1 of every row, by a sweep and a pointwise inverse. */
sph_status sphi_gradient_matrices(sph_neighbors *list, const sph_kernel *kernel,
                                  const sph_operands *own, double *inverse, int64_t *fallbacks);

/* q of every row < rows, 0 for the rest up to n; `gradv` is scratch for rows * dim * dim. */
sph_status sphi_bulk_pressures(sph_neighbors *list, const sph_kernel *kernel,
                               const sph_operands *own, const sph_bulk_viscosity *o, double *gradv,
                               double *q);

/* SPH_ERR_ARG where h differs and the list lacks pairs within the larger one. */
sph_status sphi_check_both_h(const sph_neighbors *list, const char *name);

/* Options (NULL: the defaults) over *own, checked. */
sph_status sphi_dissipation_read(sph_context *ctx, const sph_dissipation *options, const char *name,
                                 sph_dissipation *own);

#endif
