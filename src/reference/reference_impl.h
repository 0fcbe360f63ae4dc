/* What the references share: a bracketed root, and the waves of a Riemann problem. */
#ifndef SPHI_REFERENCE_IMPL_H
#define SPHI_REFERENCE_IMPL_H

#include "../core/core.h"

#include <sph/reference.h>

/* Root of f in [lo, hi], of which f has different signs, to the last bits of the root. */
typedef double (*sphi_root_fn)(const void *user, double x);
double sphi_root(sphi_root_fn f, const void *user, double lo, double hi);

/* ---- Riemann problems ---- */

/* The state that one wave leads to. Seen from its own side, so that left and right are the same:
 * the wave moves into the material at `front` > 0, and the material behind it is faster by `gain`
 * in that direction (negative after an expansion). */
typedef struct sphi_wave {
  double p, rho, e, c, gain;
  double front; /* of a shock; of a fan the speed of sound ahead */
} sphi_wave;

typedef struct sphi_side sphi_side;

typedef struct sphi_riemann_law {
  /* Completes side->start and side->lowest; SPH_OK or a failure with its sentence. */
  sph_status (*prepare)(sph_context *ctx, sphi_side *side, const char *name);
  /* To the pressure p >= side->lowest; p NaN when the law cannot reach it. */
  sphi_wave (*wave)(const sphi_side *side, double p);
  /* Within a fan, where gain + c = speed. */
  sphi_wave (*fan)(const sphi_side *side, double speed);
  /* Whether gain + c falls all the way to a wave behind a fan; NULL: always. */
  int (*convex)(const sphi_side *side, const sphi_wave *behind);
} sphi_riemann_law;

struct sphi_side {
  sph_riemann_side given;
  const sphi_riemann_law *law; /* NULL: void */
  sphi_wave start;             /* the undisturbed state, gain 0 */
  double lowest;               /* pressure that the material can be expanded to */
  double slowest;              /* Mie-Grueneisen: ln rho there */
};

/* SPH_OK, or SPH_ERR_ARG with a sentence unless value > least (or >=, with `closed`), finite. */
sph_status sphi_riemann_above(sph_context *ctx, const char *side, const char *what, double value,
                              double least, int closed);

extern const sphi_riemann_law sphi_riemann_gas, sphi_riemann_barotropic, sphi_riemann_mie_gruneisen;

/* ---- transport ---- */

/* n masses in whole units, all positive, at points of dim coordinates in [0, 1]. The totals of the
 * two sets are the same. *cost receives the least sum of units times distance. The better the order
 * of one set follows that of the other, the sooner it is found. */
typedef struct sphi_masses {
  int64_t n;
  const double *x;
  const int64_t *units;
} sphi_masses;
sph_status sphi_transport(sph_context *ctx, int32_t dim, const sphi_masses *from,
                          const sphi_masses *to, double *cost);

#endif
