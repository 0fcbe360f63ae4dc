/* What the frozen row loops see, and the table of them that each instruction set has. */
#ifndef SPHI_FROZEN_RUN_H
#define SPHI_FROZEN_RUN_H

#include "frozen.h"

/* Offsets in a record, in doubles; -1 where a field is not packed. */
typedef struct sphi_frozen_record {
  int x0, u, t, g, v, e, rho, c, h, vol;
  int quads; /* record length / 4 */
} sphi_frozen_record;

typedef struct sphi_frozen_run {
  const sphi_frozen *z;
  const sphi_frozen_force *force;
  sphi_frozen_record layout;
  const double *f, *minus; /* of the gradient */
  double *records;         /* in sweep order */
  double *out;
  int64_t rows;
  int32_t identity;
  double period[3], inverse_period[3];
  double e0; /* where the stiffness is uniform: of the hourglass springs */
} sphi_frozen_run;

typedef void (*sphi_frozen_fn)(const sphi_frozen_run *run, int64_t lo, int64_t hi);

/* Loops by dimension - 1. `piola` and `controlled` are instances of `force` for PIOLA alone, and
 * with HOURGLASS and uniform stiffness. */
typedef struct sphi_frozen_loops {
  sphi_frozen_fn weights[3], gradient[3], piola[3], controlled[3], force[3];
} sphi_frozen_loops;

extern const sphi_frozen_loops sphi_frozen_portable, sphi_frozen_avx2, sphi_frozen_avx512;

#define SPHI_FROZEN_INLINE static inline __attribute__((always_inline, unused))
#define SPHI_FROZEN_PLACE(member, wanted, count) \
  do {                                           \
    y.member = (wanted) ? at : -1;               \
    at += (wanted) ? (count) : 0;                \
  } while (0)

/* The record of a force; folds to constants in the instances. */
SPHI_FROZEN_INLINE sphi_frozen_record sphi_frozen_record_of(uint32_t terms, int uniform_e,
                                                            int dim) {
  sphi_frozen_record y = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, 0};
  int at = 0;
  const int springs = (terms & (SPHI_FROZEN_HOURGLASS | SPHI_FROZEN_HOURGLASS_CENTRAL)) != 0;
  const int viscous = (terms & SPHI_FROZEN_VISCOSITY) != 0;
  /* the springs' part in F rides on the stress where both multiply g_ij */
  const int rides = (terms & SPHI_FROZEN_HOURGLASS) && !(terms & SPHI_FROZEN_PIOLA_ROW);
  SPHI_FROZEN_PLACE(x0, 1, dim);
  SPHI_FROZEN_PLACE(u, springs || viscous, dim);
  SPHI_FROZEN_PLACE(t, (terms & (SPHI_FROZEN_PIOLA | SPHI_FROZEN_PIOLA_ROW)) || rides, dim * dim);
  SPHI_FROZEN_PLACE(g, springs && !rides, dim * dim);
  SPHI_FROZEN_PLACE(v, viscous, dim);
  SPHI_FROZEN_PLACE(e, springs && !uniform_e, 1);
  SPHI_FROZEN_PLACE(rho, viscous, 1);
  SPHI_FROZEN_PLACE(c, viscous, 1);
  SPHI_FROZEN_PLACE(h, viscous, 1);
  y.quads = (at + 3) / 4;
  return y;
}

/* The record of a gradient: X, f. */
SPHI_FROZEN_INLINE sphi_frozen_record sphi_frozen_gradient_record(int dim) {
  sphi_frozen_record y = {0, dim, -1, -1, -1, -1, -1, -1, -1, -1, (2 * dim + 3) / 4};
  return y;
}

/* The record of the weights: X, V, h. */
SPHI_FROZEN_INLINE sphi_frozen_record sphi_frozen_weight_record(int dim) {
  sphi_frozen_record y = {0, -1, -1, -1, -1, -1, -1, -1, dim, dim + 1, (dim + 5) / 4};
  return y;
}

#undef SPHI_FROZEN_PLACE

#endif
