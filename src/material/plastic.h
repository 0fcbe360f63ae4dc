/* Return mappings of the yield criterion of von Mises. Pure. */
#ifndef SPHI_PLASTIC_H
#define SPHI_PLASTIC_H

#include <sph/material.h>

typedef struct sphi_plastic {
  double yield, hardening;
  double shear, young, poisson; /* young and poisson for plane and uniaxial stress */
} sphi_plastic;

/* A block of n stresses in place, as sph_material_plastic_return() says. `across`,
 * `plastic_strain` and `plastic_work` as there, NULL where the law does not need them. */
void sphi_plastic_return(const sphi_plastic *p, int32_t reduction, int64_t n, double *sigma,
                         double *across, double *plastic_strain, double *plastic_work);
/* The same for deviators with trace zero, whose components across follow from that. */
void sphi_plastic_return_deviator(const sphi_plastic *p, int32_t dim, int64_t n, double *deviator,
                                  double *plastic_strain, double *plastic_work);
/* S:S of the 3x3 deviator that these components stand for. */
double sphi_deviator_square(int32_t dim, const double *s);

#endif
