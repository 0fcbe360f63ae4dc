/* What the loops of smoothed.h see, and the table of them that each instruction set has. */
#ifndef SPHI_SMOOTHED_RUN_H
#define SPHI_SMOOTHED_RUN_H

#include "smoothed.h"

/* Offsets in a record, in doubles; -1 where a field is not packed. */
typedef struct sphi_smoothed_record {
  int x, v, hi, b, q, m, rho, c, p, e, vol, t;
  int quads; /* record length / 4 */
} sphi_smoothed_record;

typedef struct sphi_smoothed_sweep {
  const sphi_smoothed *s;
  const struct sph_neighbors *list;
  sphi_smoothed_record layout;
  double *records;         /* in sweep order */
  double *density, *omega; /* of a gather */
  double floor;
  double period[3], inverse_period[3];
} sphi_smoothed_sweep;

typedef void (*sphi_smoothed_fn)(const sphi_smoothed_sweep *run, int64_t lo, int64_t hi);

/* Loops by dimension - 1. `fluid`, `gas` and `solid` are instances of `forces` for PRESSURE alone,
 * with DISSIPATION, and with STRESS too. */
typedef struct sphi_smoothed_loops {
  sphi_smoothed_fn gather[3], fluid[3], gas[3], solid[3], forces[3];
} sphi_smoothed_loops;

extern const sphi_smoothed_loops sphi_smoothed_portable, sphi_smoothed_avx2, sphi_smoothed_avx512;

enum {
  SPHI_SMOOTHED_FLUID = SPHI_SMOOTHED_PRESSURE,
  SPHI_SMOOTHED_GAS = SPHI_SMOOTHED_PRESSURE | SPHI_SMOOTHED_DISSIPATION,
  SPHI_SMOOTHED_SOLID = SPHI_SMOOTHED_GAS | SPHI_SMOOTHED_STRESS
};

#define SPHI_SMOOTHED_INLINE static inline __attribute__((always_inline, unused))
#define SPHI_SMOOTHED_PLACE(member, wanted, count) \
  do {                                             \
    y.member = (wanted) ? at : -1;                 \
    at += (wanted) ? (count) : 0;                  \
  } while (0)

/* The record of a set of terms; folds to constants in the instances. */
SPHI_SMOOTHED_INLINE sphi_smoothed_record sphi_smoothed_record_of(uint32_t terms, int dim) {
  sphi_smoothed_record y;
  int at = 0;
  const int pressure = (terms & SPHI_SMOOTHED_PRESSURE) != 0;
  const int stress = (terms & SPHI_SMOOTHED_STRESS) != 0;
  const int loss = (terms & SPHI_SMOOTHED_DISSIPATION) != 0;
  SPHI_SMOOTHED_PLACE(x, 1, dim);
  SPHI_SMOOTHED_PLACE(v, 1, dim);
  SPHI_SMOOTHED_PLACE(hi, 1, 1);
  SPHI_SMOOTHED_PLACE(b, pressure, 1);
  SPHI_SMOOTHED_PLACE(q, pressure, 1);
  SPHI_SMOOTHED_PLACE(m, loss, 1);
  SPHI_SMOOTHED_PLACE(rho, loss, 1);
  SPHI_SMOOTHED_PLACE(c, loss, 1);
  SPHI_SMOOTHED_PLACE(p, loss, 1);
  SPHI_SMOOTHED_PLACE(e, loss, 1);
  SPHI_SMOOTHED_PLACE(vol, stress, 1);
  SPHI_SMOOTHED_PLACE(t, stress, dim * (dim + 1) / 2);
  y.quads = (at + 3) / 4;
  return y;
}

/* The record of a gather: x, b. */
SPHI_SMOOTHED_INLINE sphi_smoothed_record sphi_smoothed_gather_record(int dim) {
  sphi_smoothed_record y = {0, -1, -1, dim, -1, -1, -1, -1, -1, -1, -1, -1, 1};
  return y;
}

#undef SPHI_SMOOTHED_PLACE

SPHI_SMOOTHED_INLINE double sphi_scalar_at(const double *array, double uniform, int64_t i) {
  return array ? array[i] : uniform;
}

/* a_i of a smoothing. */
SPHI_SMOOTHED_INLINE double sphi_smoothed_a(int32_t smoothing, double m, double rho) {
  return smoothing == SPH_SMOOTHING_MASS ? 1.0 : smoothing == SPH_SMOOTHING_VOLUME ? rho : m;
}
/* b_j of a smoothing. */
SPHI_SMOOTHED_INLINE double sphi_smoothed_b(int32_t smoothing, double m, double rho) {
  return smoothing == SPH_SMOOTHING_MASS ? m : smoothing == SPH_SMOOTHING_VOLUME ? m / rho : 1.0;
}

#endif
