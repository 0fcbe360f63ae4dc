/* The composed right-hand side: its handle, and one evaluation in progress. */
#ifndef SPHI_RHS_IMPL_H
#define SPHI_RHS_IMPL_H

#include "../material/material_impl.h"
#include "../operators/operators_impl.h"
#include "../particles/particles_impl.h"
#include "../sweep/frozen.h"

#include <sph/rhs.h>

enum { SPHI_MAX_TERM = SPH_TERM_DISSIPATION, SPHI_MAX_HOST_TERMS = 16, SPHI_PHASES = 256 };

typedef struct sphi_host_term {
  int32_t field;
  sph_pair_fn fn;
  void *user;
} sphi_host_term;

/* Scratch, kept between evaluations. */
enum {
  SPHI_RHS_GRADV,
  SPHI_RHS_MATRIX,
  SPHI_RHS_Q,
  SPHI_RHS_ART,
  SPHI_RHS_XSPH,
  SPHI_RHS_SLOPE,
  SPHI_RHS_VALUE,
  SPHI_RHS_RECORDS,
  SPHI_RHS_SCRATCH
};

/* The frozen configuration that scratch belongs to, where the position field is X0. */
typedef struct sphi_frozen_key {
  const void *set, *list, *pair;
  uint64_t generation, revision[5]; /* of X0, H, M, RHO, C */
  int64_t builds;
} sphi_frozen_key;

/* What is there of it. */
enum { SPHI_FROZEN_HAS_MATRIX = 1, SPHI_FROZEN_HAS_SLOPE = 2, SPHI_FROZEN_HAS_VALUE = 4 };

struct sph_rhs {
  sphi_object base;
  sph_kernel *kernel; /* retained */
  sph_rhs_options options;
  sph_term terms[SPHI_MAX_TERM + 1]; /* by kind; kind 0 = absent */
  sph_dissipation dissipation;       /* of SPH_TERM_DISSIPATION */
  sphi_host_term host[SPHI_MAX_HOST_TERMS];
  int32_t host_count;
  sph_material *materials[SPHI_PHASES]; /* retained, by phase */
  int32_t material_count;
  sph_rhs_hook prepare, finish;
  void *prepare_user, *finish_user;
  sphi_buffer scratch[SPHI_RHS_SCRATCH];
  sphi_frozen_key frozen_key;
  uint32_t frozen_has; /* SPHI_FROZEN_HAS_* */
  double frozen_stiffness;
};

/* One evaluation. */
typedef struct sphi_evaluation {
  sph_rhs *rhs;
  sph_particles *set;
  sph_neighbors *list;
  double t;
  const sph_rate *rates;
  int32_t count;
  int32_t dim;
  int64_t rows;    /* real particles */
  uint32_t active; /* SPHI_* terms of the main sweep */
  sph_operands a;  /* x is the position field */
  double *F, *P;   /* fields of the set, where a total-Lagrangian term is wanted */
} sphi_evaluation;

/* The rate array asked for a field, or NULL. */
double *sphi_rate_of(const sphi_evaluation *e, int32_t field);
/* Whether a term is in the list and the rate of a field that it adds to is asked for. */
int sphi_term_wanted(const sphi_evaluation *e, int32_t kind);

/* Whether a term is wanted and has this form. */
int sphi_form_wanted(const sphi_evaluation *e, int32_t kind, int32_t form);

/* --- frozen.c: what is kept of a frozen configuration, and the terms on it --- */
/* Whether a term needs position_field X0. */
int sphi_term_frozen(const sph_term *term);
/* Whether all that was computed for the configuration still holds; 0 when positions are current. */
int sphi_frozen_unchanged(const sphi_evaluation *e);
/* Remember the configuration, with nothing computed of it. After the list was updated. */
void sphi_frozen_remember(sphi_evaluation *e);
/* Fields, laws and positions that the frozen terms need. */
sph_status sphi_frozen_check(sphi_evaluation *e);
/* Deformation gradients, stresses, forces, velocity gradients. After the sweeps. */
sph_status sphi_rhs_frozen_terms(sphi_evaluation *e);
/* B^-1 of every particle into e->a.gradient_matrix, unless it is known (pairs.c). */
sph_status sphi_rhs_matrices(sphi_evaluation *e);
/* P of all particles from F by the materials (pointwise.c). */
sph_status sphi_rhs_first_piola(sphi_evaluation *e);

/* --- smoothed.c: terms with two smoothing lengths a pair --- */
/* Fields that they need, and a list that reaches far enough. */
sph_status sphi_smoothed_check(sphi_evaluation *e);
/* Whether they make the velocity gradient that the materials read. */
int sphi_smoothed_makes_gradient(const sphi_evaluation *e);
/* Their sums, added to the rates. After the sweeps. */
sph_status sphi_rhs_smoothed_terms(sphi_evaluation *e);

/* Whether some material has a pressure law; P then need not exist before. */
int sphi_rhs_has_pressure_law(const sph_rhs *rhs);
sph_status sphi_rhs_pressures(sphi_evaluation *e);  /* P from the materials that have a law */
sph_status sphi_rhs_sweeps(sphi_evaluation *e);     /* every pair sum of the library's own terms */
sph_status sphi_rhs_host_terms(sphi_evaluation *e); /* the host's pair sums */
sph_status sphi_rhs_stress_rates(sphi_evaluation *e); /* materials on the velocity gradients */
void sphi_rhs_pointwise(sphi_evaluation *e);          /* motion, XSPH, body force */

#endif
