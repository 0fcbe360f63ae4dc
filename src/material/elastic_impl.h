/* What elastic and elastoplastic laws share: reductions and their moduli. */
#ifndef SPHI_ELASTIC_IMPL_H
#define SPHI_ELASTIC_IMPL_H

#include "material_impl.h"

#include <sph/elastic.h>

/* In every reduction a stress along an axis is stiff * (strain there) + cross * (sum of the other
 * strains of the reduction), a shear stress 2 * shear * (shear strain). */
typedef struct sphi_moduli {
  double stiff, cross, shear;
  double across; /* stress across per trace of the strain: lambda, or 0 where it is free */
} sphi_moduli;

sphi_moduli sphi_moduli_of(double young, double poisson, int32_t reduction);
/* Stress rates of a block from its velocity gradients; with `jaumann` those of the rotating frame,
 * which also read its stresses (2-D, 3-D). `rate` may be the array of the stresses. */
void sphi_elastic_rate(const sphi_moduli *m, int32_t jaumann, const sph_material_block *b,
                       double *rate);
/* Of the stress across, in 1-D and 2-D. */
void sphi_elastic_rate_across(const sphi_moduli *m, const sph_material_block *b, double *rate);
/* 1, 2 or 3; 0 for an unknown reduction. */
int32_t sphi_reduction_dim(int32_t reduction);
/* SPH_OK, or SPH_ERR_ARG with a sentence that begins with `law`. */
sph_status sphi_elastic_check(sph_context *ctx, const char *law, double young, double poisson,
                              double density, int32_t reduction);

#endif
