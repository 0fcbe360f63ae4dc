/* Smoothing lengths that satisfy n h^d = eta^d: what the solver of one particle and the rounds over
 * all of them share. */
#ifndef SPHI_ADAPT_IMPL_H
#define SPHI_ADAPT_IMPL_H

#include "../kernel/kernel_impl.h"
#include "../neighbors/neighbors_impl.h"

#include <sph/adapt.h>

/* How far a particle has come. */
typedef enum sphi_adapt_state {
  SPHI_ADAPT_ACTIVE,     /* goes on, in this round or, with a longer reach, in the next */
  SPHI_ADAPT_SOLVED,     /* within the tolerance */
  SPHI_ADAPT_JUMP,       /* the sum jumps across eta^d here: a kernel that is cut */
  SPHI_ADAPT_BOUNDED,    /* the root lies beyond h_min or h_max */
  SPHI_ADAPT_COINCIDENT, /* particles at one place: the sum is too large for any h */
  SPHI_ADAPT_ALONE,      /* too few particles: the sum is too small for any h */
  SPHI_ADAPT_BOX,        /* the periodic box is too narrow for the h it takes */
  SPHI_ADAPT_SPENT       /* max_evaluations */
} sphi_adapt_state;

/* One particle. `sum` is S(h) = h^d sum_j w_ij W(r_ij, h) at the last h it was evaluated for. */
typedef struct sphi_adapt_particle {
  double h, low, high; /* root within [low, high]; high infinite: not bounded yet */
  double reach;        /* the list holds all within support * reach */
  double sum, last_miss;
  int32_t state, evaluations;
} sphi_adapt_particle;

typedef struct sphi_adapt_job {
  const sph_neighbors *list;
  const sph_kernel *kernel;
  int32_t dim;
  int64_t n, rows;
  const double *x, *m; /* m NULL: number, w_ij = 1; else w_ij = m_j / m_i */
  double target;       /* eta^d */
  double own;          /* h^d W(0, h): what a particle adds to its own sum */
  double total;        /* sum of all m, or n */
  double tolerance, h_min, h_max, box_h;
  int32_t periodic, max_evaluations;
  sphi_adapt_particle *particle;
} sphi_adapt_job;

/* S and h dS/dh of particle i, which stands at sweep position k. */
void sphi_adapt_sum(const sphi_adapt_job *job, int64_t k, double h, double *sum, double *slope);

/* Newton and bisection, as far as the reach allows. */
void sphi_adapt_solve(const sphi_adapt_job *job, int64_t k);

#endif
