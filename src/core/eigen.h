/* Eigenvalues and eigenvectors of small symmetric matrices. Pure. */
#ifndef SPHI_EIGEN_H
#define SPHI_EIGEN_H

#include <stdint.h>

/* values: dim, descending. vectors: NULL, or dim * dim: vector k at vectors + k * dim, of unit
 * length, orthogonal and right-handed to rounding whatever the matrix. The matrix is packed as
 * base.h says. Errors are a few roundings of its largest entry, at any scale that doubles have.
 * What is not finite gives NaN in all outputs. */
void sphi_eigen_symmetric(int32_t dim, const double *packed, double *values, double *vectors);

#endif
