/* Pair sums over a frozen configuration, for total-Lagrangian terms.
 *
 * The geometry never changes, so what the kernel says of a pair is computed once and kept: one
 * double a stored pair, in the order of the list's rows. No kernel, no rule for unequal h and no
 * square root stands in the sums that follow. Positions enter as displacements u = x - X, so that
 * small strains do not cancel.
 *
 * Notation: X_ij = X_i - X_j; g_ij = slope_ij X_ij the kernel gradient; V = m / rho in the frozen
 * configuration. */
#ifndef SPHI_FROZEN_H
#define SPHI_FROZEN_H

#include "../kernel/kernel_impl.h"
#include "../neighbors/neighbors_impl.h"

#include <sph/operators.h>

/* What is kept of a configuration. */
typedef struct sphi_frozen {
  const struct sph_neighbors *list;
  const struct sph_kernel *kernel;
  const sph_operands *a; /* x: X; m, rho, h, c of the configuration; gradient_matrix of all n */
  double *slope;         /* V_j slope_ij of every pair */
  double *value;         /* V_j W_ij / X_ij^2, or NULL */
  double stiffness;      /* rho c^2 where it is uniform, else -1; set with the weights */
} sphi_frozen;

/* Sums of one force. */
enum {
  SPHI_FROZEN_PIOLA = 1,             /* V_j (P_i B_i^-1 + P_j B_j^-1) g_ij */
  SPHI_FROZEN_PIOLA_ROW = 2,         /* V_j (P_i + P_j) g_ij, or with the matrix of the row */
  SPHI_FROZEN_HOURGLASS = 4,         /* from the energy of the deviations from F */
  SPHI_FROZEN_HOURGLASS_CENTRAL = 8, /* along the pair */
  SPHI_FROZEN_VISCOSITY = 16,        /* Monaghan's, in the current geometry */
  SPHI_FROZEN_ENERGY = 32            /* of the hourglass springs, per particle */
};

typedef struct sphi_frozen_force {
  uint32_t terms;
  int32_t corrected;   /* of PIOLA_ROW */
  const double *x;     /* current positions */
  const double *v;     /* VISCOSITY */
  const double *F, *P; /* HOURGLASS: F; PIOLA: P */
  double hourglass;    /* coefficient */
  double alpha, beta;  /* of the viscosity */
  double *dvdt;        /* added to, rows < a->rows */
  double *energy;      /* set */
} sphi_frozen_force;

/* Doubles that `slope` and `value` need. */
int64_t sphi_frozen_pairs(const struct sph_neighbors *list);
/* Most doubles of scratch that any call below needs. */
int64_t sphi_frozen_scratch(int32_t dim, int64_t n);

/* Fill slope, value where it is not NULL, and stiffness. */
void sphi_frozen_weights(sphi_frozen *z, double *scratch);

/* sum_j V_j (f_j - f_i) (x) B_i^-1 g_ij with f = `f` - `minus` (NULL: 0), plus the identity where
 * that is asked for, of the particles i < rows. out: rows * dim * dim. */
void sphi_frozen_gradient(const sphi_frozen *z, const double *f, const double *minus, int identity,
                          int64_t rows, double *scratch, double *out);

/* Add the accelerations of a force. */
void sphi_frozen_add_force(const sphi_frozen *z, const sphi_frozen_force *force, double *scratch);

#endif
