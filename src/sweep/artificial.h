/* Artificial stress from a stress state, many particles at a time. */
#ifndef SPHI_ARTIFICIAL_H
#define SPHI_ARTIFICIAL_H

#include <stdint.h>

/* R = -epsilon / rho^2 times the tensile part of sigma, n packed symmetric tensors each; `out` may
 * be sigma. rho NULL: rho0 everywhere. */
typedef void (*sphi_artificial_fn)(int32_t dim, int64_t n, const double *sigma, const double *rho,
                                   double rho0, double epsilon, double *out);

/* By instruction set, SPH_ISA_*. */
sphi_artificial_fn sphi_artificial(int32_t isa);

extern const sphi_artificial_fn sphi_artificial_portable, sphi_artificial_avx2,
    sphi_artificial_avx512;

#endif
