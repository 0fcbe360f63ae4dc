/* The composed right-hand side: its handle, and one evaluation in progress. */
#ifndef SPHI_RHS_IMPL_H
#define SPHI_RHS_IMPL_H

#include "../material/material_impl.h"
#include "../operators/operators_impl.h"
#include "../particles/particles_impl.h"

#include <sph/rhs.h>

enum { SPHI_MAX_TERM = SPH_TERM_ARTIFICIAL_STRESS, SPHI_MAX_HOST_TERMS = 16, SPHI_PHASES = 256 };

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
  SPHI_RHS_SCRATCH
};

struct sph_rhs {
  sphi_object base;
  sph_kernel *kernel; /* retained */
  sph_rhs_options options;
  sph_term terms[SPHI_MAX_TERM + 1]; /* by kind; kind 0 = absent */
  sphi_host_term host[SPHI_MAX_HOST_TERMS];
  int32_t host_count;
  sph_material *materials[SPHI_PHASES]; /* retained, by phase */
  int32_t material_count;
  sph_rhs_hook prepare, finish;
  void *prepare_user, *finish_user;
  sphi_buffer scratch[SPHI_RHS_SCRATCH];
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
  int64_t rows;  /* real particles */
  uint32_t active; /* SPHI_* terms of the main sweep */
  sph_operands a;
} sphi_evaluation;

/* The rate array asked for a field, or NULL. */
double *sphi_rate_of(const sphi_evaluation *e, int32_t field);
/* Whether a term is in the list and its field's rate is asked for. */
int sphi_term_wanted(const sphi_evaluation *e, int32_t kind);
/* The field a kind of term adds to. */
int32_t sphi_term_field(int32_t kind);

/* Whether some material has a pressure law; P then need not exist before. */
int sphi_rhs_has_pressure_law(const sph_rhs *rhs);
sph_status sphi_rhs_pressures(sphi_evaluation *e);    /* P from the materials that have a law */
sph_status sphi_rhs_sweeps(sphi_evaluation *e);       /* every pair sum of the library's own terms */
sph_status sphi_rhs_host_terms(sphi_evaluation *e);   /* the host's pair sums */
sph_status sphi_rhs_stress_rates(sphi_evaluation *e); /* materials on the velocity gradients */
void sphi_rhs_pointwise(sphi_evaluation *e);          /* motion, XSPH, body force */

#endif
