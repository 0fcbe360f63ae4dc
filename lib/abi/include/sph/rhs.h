/* Composed right-hand side: a list of terms, evaluated in as few passes over the pairs as
 * possible, with the same code as the operators of operators.h.
 *
 *   sph_rhs_create(ctx, kernel, NULL, &rhs);
 *   sph_rhs_add(rhs, &stress);  sph_rhs_add(rhs, &viscosity);
 *   sph_rhs_set_material(rhs, 0, hooke);
 *   sph_rhs_evaluate(rhs, set, list, t, rates, 3);
 */
#ifndef SPH_RHS_H
#define SPH_RHS_H

#include <sph/base.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
  SPH_TERM_CONTINUITY = 1,       /* -> rate of RHO; form SPH_CONTINUITY_* */
  SPH_TERM_PRESSURE = 2,         /* -> rate of V; form SPH_PRESSURE_* */
  SPH_TERM_STRESS = 3,           /* -> rate of V; form SPH_STRESS_* */
  SPH_TERM_STRESS_RATE = 4,      /* -> rate of SIGMA: velocity gradient, then the phase's material */
  SPH_TERM_MONAGHAN = 5,         /* -> rate of V; alpha, beta */
  SPH_TERM_BULK_VISCOSITY = 6,   /* -> rate of V; neumann, linear, spacing, alpha, beta (Hernquist-Katz) */
  SPH_TERM_XSPH = 7,             /* -> added to the rate of X; epsilon */
  SPH_TERM_BODY_FORCE = 8,       /* -> rate of V; vector */
  SPH_TERM_MOTION = 9,           /* -> rate of X = V */
  SPH_TERM_ARTIFICIAL_STRESS = 10 /* -> rate of V; epsilon, power, spacing_ratio (He 3.22) */
};

typedef struct sph_term {
  size_t size;        /* set by sph_term_init() */
  int32_t kind;       /* SPH_TERM_* */
  int32_t form;       /* of the kind; 0 = the first one */
  int32_t corrected;  /* nonzero: gradients with the kernel-gradient matrix of the row particle */
  double alpha, beta; /* viscosities */
  double epsilon;     /* XSPH */
  double neumann, linear, spacing;
  double vector[3];   /* body force per mass */
  int32_t power;      /* artificial stress: n of (W / W(dp))^n, 1..16; default 4 */
  double spacing_ratio; /* artificial stress: dp / h, so that W(dp) follows each pair's h */
} sph_term;
SPH_API void sph_term_init_sized(sph_term *term, size_t size);
#define sph_term_init(t) sph_term_init_sized((t), sizeof(sph_term))

/* A block of pairs of one particle i, for a host's own term. Arrays have `count` entries (times dim for dx). */
typedef struct sph_pair_block {
  size_t size;
  int32_t dim;
  int32_t count;
  int64_t i;             /* host index */
  const int32_t *j;      /* host indices */
  const double *dx;      /* x_i - x_j, count * dim */
  const double *r;
  const double *w;       /* W_ij */
  const double *f;       /* (dW/dr)/r, so that grad_i W_ij = f * dx */
} sph_pair_block;

/* Add the block's contribution to out (the components of the term's field, for particle i). Runs on several threads at
 * once for different i; blocks of one i come in a fixed order. Read the set through `user`. */
typedef void (*sph_pair_fn)(void *user, const sph_pair_block *block, double *out);

/* Called before the pair loops (to set ghosts, held values, pressure) and after them (to overwrite
 * rates of driven particles). t is the stage's time. 0: go on; positive: SPH_RETRY; negative: SPH_ERR_CALLBACK. A prepare hook that moves particles calls
 * sph_particles_touch(); the list is updated after it. */
struct sph_rate;
typedef int32_t (*sph_rhs_hook)(void *user, double t, sph_particles *set,
                                const struct sph_rate *rates, int32_t count);

typedef struct sph_rhs_options {
  size_t size;          /* set by sph_rhs_options_init() */
  int32_t position_field; /* geometry of the pairs; SPH_FIELD_X (default), or SPH_FIELD_X0 for a frozen configuration */
  int32_t update_list;  /* nonzero: sph_neighbors_update() before each evaluation; default 1 */
} sph_rhs_options;
SPH_API void sph_rhs_options_init_sized(sph_rhs_options *options, size_t size);
#define sph_rhs_options_init(o) sph_rhs_options_init_sized((o), sizeof(sph_rhs_options))

/* An array that receives the rate of a field: real_count * components doubles. */
typedef struct sph_rate {
  int32_t field;
  double *values;
} sph_rate;

/* Create an empty right-hand side. The kernel is retained. options may be NULL. Since 0.1. */
SPH_API sph_status sph_rhs_create(sph_context *ctx, sph_kernel *kernel,
                                  const sph_rhs_options *options, sph_rhs **out);
/* Destroy. NULL is allowed. Since 0.1. */
SPH_API void sph_rhs_destroy(sph_rhs *rhs);

/* Append a term; copied. Each kind may come once. SPH_ERR_ARG: unknown kind or form, parameters not finite, twice the same
 * kind, `corrected` on a form that has none. Since 0.1. */
SPH_API sph_status sph_rhs_add(sph_rhs *rhs, const sph_term *term);

/* Append a host's own term that adds to the rate of `field`. SPH_ERR_ARG: fn NULL. Since 0.1. */
SPH_API sph_status sph_rhs_add_host(sph_rhs *rhs, int32_t field, sph_pair_fn fn, void *user);

/* Material of a phase (0..255), retained; NULL removes it. Where it has a pressure law, P is set from it before the pair loops. Since 0.1. */
SPH_API sph_status sph_rhs_set_material(sph_rhs *rhs, int32_t phase, sph_material *material);

/* Hooks, NULL for none. Since 0.1. */
SPH_API sph_status sph_rhs_set_prepare(sph_rhs *rhs, sph_rhs_hook fn, void *user);
SPH_API sph_status sph_rhs_set_finish(sph_rhs *rhs, sph_rhs_hook fn, void *user);

/* Evaluate: every array in rates[0..count) is overwritten with the rate of its field (zero where no term adds to it) for the real particles. Terms whose
 * field is not asked for are skipped. `list` is updated first when the options say so.
 *
 * SPH_ERR_ARG: a rate array NULL or a field twice, or a field that the terms need does not exist in the set (named); SPH_ERR_STATE: SPH_TERM_STRESS_RATE for a phase without material; SPH_ERR_STALE;
 * SPH_RETRY, SPH_ERR_CALLBACK from hooks and materials; SPH_ERR_NOMEM; what sph_neighbors_update() answers.
 * After a failure the rate arrays are undefined, the set is as the hooks left it. A steady call allocates nothing. Since 0.1. */
SPH_API sph_status sph_rhs_evaluate(sph_rhs *rhs, sph_particles *set, sph_neighbors *list,
                                    double t, const sph_rate *rates, int32_t count);

#ifdef __cplusplus
}
#endif
#endif
