/* The handle of the total-Lagrangian scheme, and its ledger. */
#ifndef SPHI_TOTAL_LAGRANGIAN_IMPL_H
#define SPHI_TOTAL_LAGRANGIAN_IMPL_H

#include "moments.h"

#include <sph/correction.h>
#include <sph/operators.h>
#include <sph/total_lagrangian.h>

/* What accelerates: stress and hourglass control, viscosity, gravity, and the rest, which is the
 * host's terms and hooks. */
enum { SPHI_TL_FORM, SPHI_TL_VISCOUS, SPHI_TL_GRAVITY, SPHI_TL_HOOKS, SPHI_TL_SOURCES };

typedef struct sphi_tl_ledger {
  sph_rhs *viscosity; /* that term alone; NULL: the scheme has none */
  sphi_buffer parts;  /* accelerations by source, of the acceleration that is kept */
  int32_t begun;      /* whether a step has been taken since the start */
  sphi_moments start; /* of the velocity then */
  double potential;   /* strain and hourglass control then */
  sphi_moments integral[SPHI_TL_SOURCES];
} sphi_tl_ledger;

struct sph_total_lagrangian {
  sphi_object base;
  sph_total_lagrangian_options options;
  sph_kernel *kernel;
  sph_neighbors *list;
  sph_rhs *rhs;
  sph_integrator *integrator; /* NULL: the leapfrog of the scheme */
  sph_material *material;     /* of phase 0; the right-hand side keeps it alive */
  sphi_buffer rates, saved, scratch;
  /* What the acceleration in `rates` belongs to; set NULL: to nothing. */
  const sph_particles *set;
  uint64_t generation, revision_x, revision_v;
  double t, slack;              /* times may differ by rounding */
  const sph_particles *started; /* identity only */
  sphi_tl_ledger ledger;
};

/* ---- total_lagrangian.c ------------------------------------------------------------------ */

/* The handle, the set and its dimension. */
sph_status sphi_tl_check_set(sph_total_lagrangian *tl, const sph_particles *set);
/* The list of the reference configuration. */
sph_status sphi_tl_build_list(sph_total_lagrangian *tl, const sph_particles *set);
/* That `rates` belongs to (t, set), reached by a step of dt; and whether it does. */
void sphi_tl_remember(sph_total_lagrangian *tl, const sph_particles *set, double t, double dt);
int sphi_tl_remembered(const sph_total_lagrangian *tl, const sph_particles *set, double t);
/* The handle, the set, and that the scheme was started with it. */
sph_status sphi_tl_check_started(sph_total_lagrangian *tl, const sph_particles *set);
sph_status sphi_tl_add_viscosity(sph_rhs *rhs, const sph_total_lagrangian_options *o);
/* Evaluate at (t, set), unless what is kept holds. */
sph_status sphi_tl_accelerate_once(sph_total_lagrangian *tl, sph_particles *set, double t);

/* ---- total_lagrangian_ledger.c: nothing of it happens without `audit` -------------------- */

sph_status sphi_tl_ledger_create(sph_total_lagrangian *tl);
void sphi_tl_ledger_destroy(sph_total_lagrangian *tl);
/* Split the acceleration in `rates` that has just been evaluated. */
sph_status sphi_tl_ledger_split(sph_total_lagrangian *tl, sph_particles *set, double t);
/* The state a ledger begins with, before the first step. */
sph_status sphi_tl_ledger_begin(sph_total_lagrangian *tl, sph_particles *set);
/* Called before and after V has changed by dt times the acceleration: each adds half of it. */
void sphi_tl_ledger_kick(sph_total_lagrangian *tl, const sph_particles *set, double dt);

#endif
