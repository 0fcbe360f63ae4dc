/* The handle of the scheme for shocks, and what its files share. */
#ifndef SPHI_SHOCKS_IMPL_H
#define SPHI_SHOCKS_IMPL_H

#include "moments.h"

#include <sph/shocks.h>

enum { SPHI_MAGIC_SHOCKS = 0x53504853, SPHI_SHOCK_PHASES = 256, SPHI_SHOCK_RATES = 32 };

/* Entries of the array of integrals; impulses take three each. The four groups follow each other
 * in both halves alike. */
enum {
  SPHI_SHOCK_BODY,
  SPHI_SHOCK_WALLS,
  SPHI_SHOCK_HOOKS,
  SPHI_SHOCK_FORM,
  SPHI_SHOCK_POWERS,
  SPHI_SHOCK_IMPULSES = SPHI_SHOCK_POWERS,
  SPHI_SHOCK_INTEGRALS = SPHI_SHOCK_IMPULSES + 3 * SPHI_SHOCK_POWERS
};

/* Rates of momentum and of energy, m (v.a + de/dt). */
typedef struct sphi_gain {
  double power, linear[3];
} sphi_gain;

/* What begins at start, and a checkpoint keeps. */
typedef struct sphi_shock_book {
  double time, total; /* total: kinetic + internal energy at the start */
  double linear[3];   /* momentum at the start */
  double smallest_h;  /* at the start, of which the skin of the list is made */
  double integral[SPHI_SHOCK_INTEGRALS];
  int64_t steps, retries, unsolved;
  int64_t solved; /* in a checkpoint: H and RHO belong to the positions */
} sphi_shock_book;

/* Revisions at which H and RHO of INTEGRAL were solved for. */
typedef struct sphi_shock_solved {
  uint64_t x, m, generation;
} sphi_shock_solved;

struct sph_shocks {
  sphi_object base;
  sph_shocks_options options;
  sph_dissipation dissipation;
  sph_particles *set; /* the host's */
  sph_kernel *kernel;
  sph_rhs *rhs;
  sph_neighbors *list;        /* from start on */
  sph_integrator *integrator; /* from start on */
  sph_ghosts *ghosts;         /* the host's; NULL: none */
  sph_rhs_hook prepare, finish;
  void *prepare_user, *finish_user;
  uint8_t has_law[SPHI_SHOCK_PHASES];
  int32_t strength;     /* some phase has one */
  int32_t strain_field; /* plastic strain, where there is strength */
  int32_t started;
  int32_t ledger_item; /* as the integrator names the array of integrals */
  sphi_shock_book book;
  sphi_gain pairs, held, after; /* before walls are held, after it, after the host's hook */
  sphi_shock_solved solved;
  sphi_buffer lengths; /* h as it follows from rho */
  sphi_buffer drho;    /* of the last evaluation; DIFFERENTIAL */
  sphi_buffer strain;  /* plastic strain of the step in hand, and of its other copies */
};

/* ---- shocks.c ---------------------------------------------------------------------------- */

/* The handle, and where asked for that it was started. */
sph_status sphi_shocks_check(const sph_shocks *shocks, int32_t started);

/* ---- shocks_evaluate.c ------------------------------------------------------------------- */

/* The integrator's right-hand side and filter; the finish hook of the scheme's sph_rhs. */
int32_t sphi_shocks_evaluate(void *user, double t, sph_particles *set, const sph_rate *rates,
                             int32_t count);
int32_t sphi_shocks_filter(void *user, double t, sph_particles *set, int32_t copy,
                           const sph_rate *values, int32_t count);
int32_t sphi_shocks_finish(void *user, double t, sph_particles *set, const sph_rate *rates,
                           int32_t count);
/* RHO (INTEGRAL), H, P, C, ghosts and list of the present state; and with them OMEGA. */
sph_status sphi_shocks_neighbors(sph_shocks *shocks, double t, const sph_rate *rates,
                                 int32_t count);
sph_status sphi_shocks_fill(sph_shocks *shocks, double t, const sph_rate *rates, int32_t count);
/* Whether H and RHO of INTEGRAL belong to the present positions; and that they do. */
int sphi_shocks_is_solved(const sph_shocks *shocks);
void sphi_shocks_set_solved(sph_shocks *shocks);
/* After a good step: the plastic strain that its filter made. */
sph_status sphi_shocks_keep_strain(sph_shocks *shocks);
/* h = eta (m/rho)^(1/d) of the real particles. */
sph_status sphi_shocks_lengths(sph_shocks *shocks);

/* ---- shocks_start.c ---------------------------------------------------------------------- */

/* The list; and with it the integrator, bound. */
sph_status sphi_shocks_make_list(sph_shocks *shocks, double smallest_h);
sph_status sphi_shocks_make_parts(sph_shocks *shocks, double smallest_h);
void sphi_shocks_drop_parts(sph_shocks *shocks);
/* Fields and buffers that an evaluation needs; whether M, RHO and the phases are as they must. */
sph_status sphi_shocks_make_fields(sph_shocks *shocks);
sph_status sphi_shocks_check_fields(sph_shocks *shocks);

/* ---- shocks_ledger.c --------------------------------------------------------------------- */

/* Rates of book.integral from the three gains of an evaluation. */
void sphi_shocks_powers(const sph_shocks *shocks, double *rates);
sphi_gain sphi_shocks_gain(const sph_shocks *shocks, const double *dv, const double *de);
void sphi_shocks_open_book(sph_shocks *shocks, double t);

#endif
