/* The handle of the scheme, and its ledger. */
#ifndef SPHI_SCHEME_IMPL_H
#define SPHI_SCHEME_IMPL_H

#include "moments.h"

#include <sph/correction.h>
#include <sph/elastodynamics.h>
#include <sph/particles.h>

enum { SPHI_MAGIC_ELASTODYNAMICS = 0x53504564, SPHI_MATERIALS = 256 };

/* Entries of the array of integrals. Impulses and moments take three each. */
enum {
  SPHI_STRAIN,
  SPHI_VISCOUS,
  SPHI_ARTIFICIAL,
  SPHI_BODY,
  SPHI_HOOKS,
  SPHI_FORM,
  SPHI_IMPULSE_BODY,
  SPHI_IMPULSE_HOOKS = SPHI_IMPULSE_BODY + 3,
  SPHI_IMPULSE_FORM = SPHI_IMPULSE_HOOKS + 3,
  SPHI_MOMENT_HOOKS = SPHI_IMPULSE_FORM + 3,
  SPHI_MOMENT_FORM = SPHI_MOMENT_HOOKS + 3,
  SPHI_INTEGRALS = SPHI_MOMENT_FORM + 3
};

struct sph_elastodynamics {
  sphi_object base;
  sph_elastodynamics_options options;
  sph_particles *set; /* the host's */
  sph_kernel *kernel;
  sph_rhs *rhs;
  sph_neighbors *list;          /* from start on */
  sph_integrator *integrator;   /* from start on */
  double speed[SPHI_MATERIALS]; /* of the phases; 0: no material */
  sph_rhs_hook finish;
  void *finish_user;
  double time;
  int32_t started;
  int32_t h0_field, rho0_field; /* references of the law DENSITY */
  int32_t ledger_item;          /* as the integrator names the array of integrals */
  uint64_t spacing_revision;    /* of which H was made */

  /* Ledger. */
  sph_rhs *damping[2]; /* viscosity, artificial stress, alone; NULL: the scheme has none */
  sphi_buffer scratch; /* accelerations, velocity gradients and gradient matrices */
  double integral[SPHI_INTEGRALS];
  sphi_moments start;         /* of the velocity at the start */
  sphi_moments before, after; /* of the accelerations before and after walls and hooks */
};

/* ---- ledger.c ---------------------------------------------------------------------------- */

/* The right-hand sides of single terms that the powers are taken from. */
sph_status sphi_ledger_create(sph_elastodynamics *solid);
void sphi_ledger_start(sph_elastodynamics *solid);
/* Rates of solid->integral at the state of an evaluation that has just been done. */
sph_status sphi_ledger_rates(sph_elastodynamics *solid, double t, double *rates);

/* ---- start.c ----------------------------------------------------------------------------- */

/* List and integrator for this smallest spacing and largest wave speed. */
sph_status sphi_scheme_make_parts(sph_elastodynamics *solid, double spacing, double speed);
/* What they are made of: smallest spacing, and largest wave speed, with which C is filled. */
sph_status sphi_scheme_extent(sph_elastodynamics *solid, double *spacing, double *speed);
/* The set's fields for the references of the law DENSITY, where that is chosen. */
sph_status sphi_scheme_reference_fields(sph_elastodynamics *solid);
void sphi_scheme_drop_parts(sph_elastodynamics *solid);

/* ---- elastodynamics.c -------------------------------------------------------------------- */

/* The handle, and where asked for that it was started. */
sph_status sphi_scheme_check(const sph_elastodynamics *solid, int32_t started);
/* Add the term to a right-hand side, unless the options switch it off. */
sph_status sphi_scheme_viscosity(const sph_elastodynamics *solid, sph_rhs *rhs);
sph_status sphi_scheme_artificial_stress(const sph_elastodynamics *solid, sph_rhs *rhs);
sph_status sphi_scheme_h_from_spacing(sph_elastodynamics *solid);
/* The integrator's right-hand side. */
int32_t sphi_scheme_evaluate(void *user, double t, sph_particles *set, const sph_rate *rates,
                             int32_t count);

#endif
