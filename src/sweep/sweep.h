/* The one pair loop. A sweep names the terms it wants, points at host arrays, and is run over a
 * neighbour list; operators and composed right-hand sides are both made of sweeps.
 *
 * What a term reads of a particle is packed into one record, a few cache lines, in the list's
 * spatial order; rows then run over full neighbour lists with SIMD across neighbours and write only
 * what belongs to their particle. So no atomics, and the order of every sum is fixed. */
#ifndef SPHI_SWEEP_H
#define SPHI_SWEEP_H

#include "../kernel/kernel_impl.h"
#include "../neighbors/neighbors_impl.h"

#include <sph/operators.h>

/* Terms of a sweep; see operators.h for the formulas. */
enum {
  SPHI_DENSITY = 1 << 0,
  SPHI_CONTINUITY = 1 << 1,
  SPHI_GRADV = 1 << 2, /* velocity gradient */
  SPHI_STRESS = 1 << 3,
  SPHI_PRESSURE = 1 << 4,
  SPHI_MONAGHAN = 1 << 5,
  SPHI_BULK = 1 << 6, /* viscous pressures */
  SPHI_XSPH = 1 << 7,
  SPHI_MATRIX = 1 << 8, /* kernel-gradient matrix B; corrected terms beside it use its inverse */
  SPHI_SHEPARD = 1 << 9,
  SPHI_INTERP = 1 << 10,
  SPHI_GRADF = 1 << 11,    /* gradient of a field */
  SPHI_ARTSTRESS = 1 << 12 /* artificial stress f^n (R_i + R_j) */
};

/* Terms that add to dvdt. */
enum { SPHI_ALL_FORCES = SPHI_STRESS | SPHI_PRESSURE | SPHI_MONAGHAN | SPHI_BULK | SPHI_ARTSTRESS };

enum { SPHI_FIELD_WIDTH = 4 }; /* components of a field that one sweep takes */

/* Arrays that are one value everywhere are not packed. */
enum { SPHI_UNIFORM_M = 1, SPHI_UNIFORM_H = 2, SPHI_UNIFORM_C = 4 };

/* What the compile-time instances of the loop are made for. */
typedef struct sphi_spec {
  uint32_t terms;
  uint32_t corrected; /* terms whose gradients use the row's matrix: that of SPHI_MATRIX if it is
                       * among the terms, else the operands' gradient_matrix */
  int32_t continuity, pressure, stress; /* forms, SPH_*_* */
  uint32_t uniform;
  int32_t width; /* components of the field that SPHI_GRADF sums: 1..SPHI_FIELD_WIDTH */
} sphi_spec;

typedef struct sphi_sweep {
  sphi_spec spec;
  const struct sph_kernel *kernel;
  const sph_operands *a;
  double alpha, beta; /* Monaghan */
  const double *q;    /* viscous pressures */
  const double *art;  /* artificial stress, packed symmetric */
  double art_scale;   /* 1 / w(q) at the initial spacing */
  int32_t art_power;
  const double *f; /* field; `f_stride` doubles a particle, f_count <= SPHI_FIELD_WIDTH used */
  int64_t f_stride;
  int32_t f_count;
  int32_t variant; /* SPH_GRADIENT_* */
  /* outputs, host order */
  double *density, *drho, *gradv, *dvdt, *xsph, *matrix, *shepard;
  double *interp; /* interp_stride doubles a particle */
  int64_t interp_stride;
  double *gradf; /* gradf_stride doubles a particle */
  int64_t gradf_stride;
} sphi_sweep;

/* Run a sweep over the list. Inputs were checked by the caller as far as pointers go; here: list
 * built, sizes, staleness. SPH_OK, SPH_ERR_STATE, SPH_ERR_ARG, SPH_ERR_STALE, SPH_ERR_NOMEM. */
sph_status sphi_sweep_run(sph_neighbors *list, const sphi_sweep *sweep);

#endif
