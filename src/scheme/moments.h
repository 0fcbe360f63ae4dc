/* What the ready schemes share: sums of a state, and runs of many steps. */
#ifndef SPHI_MOMENTS_H
#define SPHI_MOMENTS_H

#include "../core/core.h"

#include <sph/integrator.h>
#include <sph/particles.h>

/* ---- moments.c --------------------------------------------------------------------------- */

/* Weighted sums of an acceleration (or velocity) u: m v.u, m u, m x cross u. */
typedef struct sphi_moments {
  double power, linear[3], angular[3];
} sphi_moments;

/* Over the real particles, in chunks of a fixed number, so that bits do not depend on threads. */
sphi_moments sphi_moments_of(sph_context *ctx, const sph_particles *set, const double *u);
/* Sum of m s; s NULL: of m. */
double sphi_mass_times(sph_context *ctx, const sph_particles *set, const double *s);

/* ---- march.c ----------------------------------------------------------------------------- */

/* A scheme as a run sees it. */
typedef struct sphi_march {
  sph_context *ctx;
  const char *name;
  void *scheme;
  double *time; /* the scheme's, advanced by `step` */
  sph_status (*stable_dt)(void *scheme, double *dt);
  sph_status (*step)(void *scheme, double dt, sph_step_info *info);
  /* The host's after a step: 0 goes on, positive ends the run, negative fails it. */
  int32_t (*after)(void *scheme, const sph_step_info *info);
  /* Whether a step that failed like this may be tried with half; it counts what it grants. */
  int32_t (*halve)(void *scheme, sph_status status);
} sphi_march;

/* Steps until t_end, the last two alike, so that it is met exactly; a step is halved up to 20
 * times. SPH_ERR_ARG: t_end not finite or before the present time. */
sph_status sphi_march_to(const sphi_march *march, double t_end);

#endif
