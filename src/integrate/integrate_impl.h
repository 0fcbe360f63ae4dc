/* The integrator handle and what its files share.
 *
 * A state is the list of bound items. A vector is a flat copy of a state: item k starts at
 * item[k].offset. Where a function takes a vector, NULL stands for the state in place. */
#ifndef SPHI_INTEGRATE_IMPL_H
#define SPHI_INTEGRATE_IMPL_H

#include "../core/core.h"

#include <sph/integrator.h>
#include <sph/particles.h>

enum {
  SPHI_ITEMS_MAX = 32,
  SPHI_STAGES_MAX = 32,                 /* of a tableau */
  SPHI_TERMS_MAX = SPHI_STAGES_MAX + 4, /* vectors in one combination */
  SPHI_STATE_GRAIN = 8192,              /* doubles that pay a thread */
  SPHI_REDUCE_CHUNKS = 64               /* fixed, so that sums do not depend on threads */
};

/* A bound field or array. */
typedef struct sphi_item {
  int32_t field;   /* >= 0: of the set; -1 - k: array, k the index of the item */
  double *y;       /* where it lives now */
  int64_t n;       /* doubles */
  int64_t offset;  /* in a vector; a multiple of 8 doubles */
  int64_t saved_n; /* of sph_integrator_save() */
  double scale;    /* size of the item in the norm of the power iteration */
} sphi_item;

/* An explicit tableau; a is s * s, row-major. */
typedef struct sphi_tableau {
  int32_t s;
  const double *a, *b, *c;
  const double *b_low; /* NULL: no estimate */
  int32_t low_order;   /* order of the weaker of b and b_low */
} sphi_tableau;

/* Dominant eigenvalue of the Jacobian as last estimated. */
typedef struct sphi_eigen {
  double re, im;   /* im >= 0, standing for the pair */
  double residual; /* of the two-dimensional invariant space, relative; small = believable */
} sphi_eigen;

/* What survives a step and decides the next one; saved and restored as a whole. */
typedef struct sphi_memory {
  int64_t steps;        /* successful ones */
  int64_t estimated_at; /* value of steps at the last estimate; -1: none */
  int32_t has_vector;   /* the eigenvector in VEC_EIGEN is of this layout */
  sphi_eigen eigen;
  double growth; /* amplification of that mode in one step; NaN: not looked at */
} sphi_memory;

/* What a multistep method keeps of earlier steps (history.c), laid out as of `count` particles. */
typedef struct sphi_history {
  const sph_particles *set; /* whose; NULL: arrays alone */
  int64_t count;            /* real particles; -1: nothing is kept */
  sphi_buffer difference;   /* a vector */
  sphi_buffer last_step;    /* of each real particle, dt; 0: it was not there */
  sphi_buffer ids;
  double array_step; /* the last dt, for plain arrays; 0: none yet */
} sphi_history;

struct sph_integrator {
  sphi_object base;
  sph_integrator_options options; /* the butcher_ pointers are cleared: see tableau */
  sphi_tableau tableau;           /* tableau methods only */
  double *tableau_values;
  size_t tableau_bytes;
  double *rkc_values; /* mu, nu, mu_t, gamma_t, c: five rows of max_stages + 1 */
  size_t rkc_bytes;
  int32_t rkc_stages; /* that rkc_values holds; 0: none */

  sphi_item item[SPHI_ITEMS_MAX];
  int32_t items;
  int32_t fields; /* how many of them are fields */

  sph_rhs_fn fn;
  void *user;
  sph_rhs *rhs;
  sph_neighbors *list;
  sph_filter_fn filter; /* NULL: none */
  void *filter_user;

  /* Layout of the step in hand. */
  int64_t stride; /* doubles in a vector */
  int64_t real_count;
  uint64_t generation;
  sphi_buffer vectors; /* vector_count of them */
  sphi_buffer ids;     /* of the real particles at the begin of the step */
  sphi_buffer saved;
  int32_t has_saved;
  int64_t evaluations; /* of the step in hand */
  int32_t busy;        /* a step is in hand: the right-hand side must not start another */

  sphi_memory memory;
  sphi_memory saved_memory;
  sphi_history history;
  double saved_array_step;
  int32_t warned;
};

/* Vectors of a step. RATE is the first of as many as the method has stages. */
enum { SPHI_VEC_START = 0, SPHI_VEC_RATE = 1 };
int32_t sphi_vector_count(const sph_integrator *it);
double *sphi_vector(const sph_integrator *it, int32_t index);
/* Vectors of the power iteration, after those of the method. */
double *sphi_vector_eigen(const sph_integrator *it);
double *sphi_vector_previous(const sph_integrator *it);
double *sphi_vector_probe(const sph_integrator *it);
int32_t sphi_estimates(const sph_integrator *it); /* whether the method ever iterates */

/* ---- state.c ----------------------------------------------------------------------------- */

/* Find the arrays of the bound items and lay out the vectors; errors name the item. */
sph_status sphi_state_layout(sph_integrator *it, sph_particles *set);
/* After a right-hand side: ghosts may have come and gone, real particles may not. */
sph_status sphi_state_follow(sph_integrator *it, sph_particles *set);
const sphi_item *sphi_item_of(const sph_integrator *it, int32_t field); /* NULL: not bound */
void sphi_state_touch(const sph_integrator *it, sph_particles *set);
void sphi_state_copy(sph_integrator *it, double *to, const double *from);

typedef struct sphi_combination {
  int32_t count;
  double factor[SPHI_TERMS_MAX];
  const double *vector[SPHI_TERMS_MAX];
} sphi_combination;
/* Append a term; one with factor 0 is dropped, so that 0 * NaN does not spread. */
void sphi_combination_add(sphi_combination *c, double factor, const double *vector);
/* out = sum factor * vector, in the order of the terms; out may be one of them. */
void sphi_state_combine(sph_integrator *it, double *out, const sphi_combination *c);

/* Sums out[0..2] in a fixed order and the maximum out[3] over [0, n). */
typedef void (*sphi_reduce_fn)(void *job, int64_t begin, int64_t end, double out[4]);
void sphi_reduce(sph_context *ctx, int64_t n, sphi_reduce_fn fn, void *job, double out[4]);
/* Largest |v| of item k; infinity when one is not finite. */
double sphi_state_max(sph_integrator *it, int32_t k, const double *vector);
/* SPH_ERR_NUMERIC naming the first entry that is not finite. */
sph_status sphi_state_check_finite(sph_integrator *it, const sph_particles *set);

/* ---- step.c ------------------------------------------------------------------------------ */

/* F(t, state) into `rate`. */
sph_status sphi_evaluate(sph_integrator *it, sph_particles *set, double t, double *rate);

/* One step in hand: what every method gets and answers. */
typedef struct sphi_step {
  sph_integrator *it;
  sph_particles *set;
  double t, dt;
  sph_step_info *info; /* never NULL; written back when the host gave one */
  int32_t has_info;    /* whether the host did */
} sphi_step;

/* A copy of the state stands in place, for time t: filter it, tell the set. */
sph_status sphi_finish_stage(const sphi_step *step, double t, int32_t copy);
/* Put a stage into the state: combine in place, then finish it. */
sph_status sphi_write_stage(const sphi_step *step, const sphi_combination *c, double t,
                            int32_t copy);
/* Filter half-step values that lie in a vector; X is not among them. */
sph_status sphi_filter_half(const sphi_step *step, double t, double *vector);
/* Put the begin of the step back, to the bit. */
void sphi_restore_start(const sphi_step *step);

/* ---- methods ----------------------------------------------------------------------------- */
sph_status sphi_butcher_step(sphi_step *step);
sph_status sphi_leapfrog_step(sphi_step *step);
sph_status sphi_leapfrog_predicted_step(sphi_step *step);
/* The step is accepted: keep what the next one needs of it. */
void sphi_leapfrog_predicted_keep(sphi_step *step);
sph_status sphi_rkc_step(sphi_step *step);

/* Built-in tableau of a method; 0 when it has none. */
int32_t sphi_butcher_builtin(int32_t method, sphi_tableau *tableau);
/* Order 0..4 that the weights b reach, by the order conditions to 1e-10. */
int32_t sphi_butcher_order(const sphi_tableau *tableau, const double *b);
/* |P(z)| of the stability polynomial. */
double sphi_butcher_amplification(const sphi_tableau *tableau, double re, double im);

/* ---- history.c --------------------------------------------------------------------------- */

/* Bring the history to the layout and the particles of the step in hand; what is new gets
 * difference 0 and last step 0. On failure it is as before. */
sph_status sphi_history_follow(sph_integrator *it, const sph_particles *set);
void sphi_history_stamp(sph_integrator *it, double dt); /* the last step of all was dt */
void sphi_history_forget(sph_integrator *it);
void sphi_history_free(sph_integrator *it);

/* ---- power.c, stability.c ---------------------------------------------------------------- */

/* Dominant eigenvalue of dF/dU at (t, start). VEC_START and `f0` = F(t, start) are given; the
 * state is left perturbed. */
sph_status sphi_power_estimate(sphi_step *step, const double *f0, int32_t iterations,
                               sphi_eigen *eigen);
double sphi_eigen_radius(const sphi_eigen *eigen);

/* Estimate when it is due, put the state back, and warn when one step of `stages` stages amplifies
 * the dominant mode. */
sph_status sphi_stability_watch(sphi_step *step, const double *f0, int32_t stages);
/* `stages`, or up to eight more where those stop the growth of the dominant mode (RKC). */
int32_t sphi_stability_stages(const sphi_step *step, int32_t stages);
/* Judge memory.eigen for this step: sets memory.growth, warns once. */
void sphi_stability_judge(sphi_step *step, int32_t stages);

/* ---- step_control.c ---------------------------------------------------------------------- */

/* max over the items of |error| / (atol + rtol |y|), maximum norms of each item. */
double sphi_error_norm(sph_integrator *it, const double *error);
/* dt times a factor within 0.1 .. 5 from an error that falls as dt^(order + 1). */
double sphi_suggest(double dt, double error, int32_t order);

#endif
