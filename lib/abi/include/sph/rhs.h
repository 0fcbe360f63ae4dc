/* Composed right-hand side: a list of terms, evaluated in as few passes over the pairs as
 * possible, with the same code as the operators of operators.h.
 *
 *   sph_rhs_create(ctx, kernel, NULL, &rhs);
 *   sph_rhs_add(rhs, &stress);  sph_rhs_add(rhs, &viscosity);
 *   sph_rhs_set_material(rhs, 0, hooke);
 *   sph_rhs_evaluate(rhs, set, list, t, rates, 3);
 *
 * The formulas and their sources stand at the operators of the same name. All built-in terms take
 * one sweep, those of variable smoothing lengths one of their own; kernel-gradient matrices, when
 * any term is corrected, and the divergence for the bulk viscosity take one more each. */
#ifndef SPH_RHS_H
#define SPH_RHS_H

#include <sph/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Kinds of terms, and the field whose rate each adds to. "c": can be `corrected`. */
enum {
  SPH_TERM_CONTINUITY = 1,     /* c; RHO; form SPH_CONTINUITY_* */
  SPH_TERM_PRESSURE = 2,       /* c; V; form SPH_PRESSURE_* */
  SPH_TERM_STRESS = 3,         /* c; V; form SPH_STRESS_*. CONSERVATIVE is corrected as it is */
  SPH_TERM_STRESS_RATE = 4,    /* c; SIGMA: velocity gradient, then the phase's material; form
                                * SPH_STRESS_RATE_* */
  SPH_TERM_MONAGHAN = 5,       /* c; V; alpha, beta; form SPH_MONAGHAN_* */
  SPH_TERM_BULK_VISCOSITY = 6, /* c; V; neumann, linear, spacing; Hernquist-Katz: alpha, beta */
  SPH_TERM_XSPH = 7,           /* X; epsilon */
  SPH_TERM_BODY_FORCE = 8,     /* V; vector */
  SPH_TERM_MOTION = 9,         /* X: the velocity */
  /* c; V: sum m_j (W_ij / W(dp))^n (R_i + R_j) g~_ij, He 2015 (3.22), R by
   * sph_artificial_stress(); epsilon, power (n), spacing_ratio. */
  SPH_TERM_ARTIFICIAL_STRESS = 10,
  /* c where SUMMED; V; form SPH_PIOLA_*: F from X and X0, P from the phase's material (or from
   * SIGMA, see below), then the divergence of P. */
  SPH_TERM_FIRST_PIOLA = 11,
  SPH_TERM_HOURGLASS = 12, /* V; form SPH_HOURGLASS_*; alpha, and E_i = rho_i c_i^2 */
  /* Variable smoothing lengths (smoothing.h); one sweep for all of them, beside that of the terms
   * above. The list's rule must be SPH_H_MAX or SPH_H_AVERAGE where h differs. */
  SPH_TERM_SMOOTHED = 13, /* RHO, V, E, whichever are asked for: sph_smoothed_pressure(); form
                           * SPH_SMOOTHING_*; the field OMEGA where the set has it, else 1 */
  SPH_TERM_SMOOTHED_STRESS = 14, /* V, E: sph_smoothed_stress(), SIGMA being the deviator.
                                  * SPH_TERM_STRESS_RATE then takes its velocity gradient, by h_i,
                                  * unless it is corrected; phases whose materials have no stress
                                  * rate are fluids, their rate is 0 */
  SPH_TERM_DISSIPATION = 15      /* RHO, V, E: sph_smoothed_dissipation(); dissipation */
};

/* Total-Lagrangian elasticity. With position_field X0 all pairs are those of X0: RHO, H, M (and the
 * volumes M / RHO) are of the reference configuration, and what depends on it alone, gradient
 * matrices and weights of pairs, is computed once and kept as long as neither the fields X0, H, M,
 * RHO, C change (call sph_particles_touch() when the host writes them) nor the list or the set.
 *
 * Two ways:
 *   - as printed in He 2015 (3.27), (3.28): SPH_TERM_STRESS and SPH_TERM_STRESS_RATE, with the
 *     Cauchy stress and velocity gradients by X0. Right for small deformations and small rotations
 *     only;
 *   - in full: SPH_TERM_FIRST_PIOLA, with or without SPH_TERM_HOURGLASS. Fields X, X0, M, RHO, H;
 *     C with hourglass control. An evaluation writes the fields F and PK (created where missing)
 *     of all particles, ghosts included, so that the host can read them, and
 *     sph_rhs_strain_energy() gives the energy. With SPH_TERM_STRESS_RATE in the form LAGRANGIAN
 *     among the terms, P = J sigma F^-T instead: for materials that have a rate of the Cauchy
 *     stress, which is then integrated.
 * The full form takes two sweeps over kept weights (one more for the form LAGRANGIAN). */

/* Forms of SPH_TERM_STRESS_RATE. */
enum {
  SPH_STRESS_RATE_SPATIAL = 1,   /* velocity gradient by the positions of the pairs */
  SPH_STRESS_RATE_LAGRANGIAN = 2 /* L = F' F^-1 with F' = sum V_j (v_j - v_i) (x) g~_ij, where
                                  * position_field is X0 */
};

/* Forms of SPH_TERM_MONAGHAN. */
enum {
  SPH_MONAGHAN_LIST = 1, /* in the geometry of the pairs */
  /* With position_field X0: Pi_ij from current x_ij and v_ij, h_ij the arithmetic mean, and
   * dv_i/dt = -sum m_j Pi_ij (dW/dr)(X_ij) x_ij/|x_ij|: the weight of the reference along the line
   * of today. Central and dissipative, zero in a rigid motion, which the form LIST is not there. */
  SPH_MONAGHAN_CURRENT = 2
};

typedef struct sph_term {
  size_t size;          /* set by sph_term_init() */
  int32_t kind;         /* SPH_TERM_*; must be given */
  int32_t form;         /* of the kind; 0 (default) = the first one */
  int32_t corrected;    /* nonzero: g~ with the matrix of the row's particle; default 0 */
  double alpha, beta;   /* viscosities; alpha also hourglass control, >= 0; default 0, as all
                         * numbers below but power */
  double epsilon;       /* XSPH, artificial stress */
  double neumann;       /* bulk viscosity: a_1 */
  double linear;        /* bulk viscosity: a_2 */
  double spacing;       /* dx of these two, a length; > 0 where one of them is not 0 */
  double vector[3];     /* body force per mass; the first dim entries */
  int32_t power;        /* artificial stress: n, 1..16; default 4 */
  double spacing_ratio; /* artificial stress: dp / h, so that W(dp) follows each pair's h */
  const struct sph_dissipation *dissipation; /* its options, copied; default NULL: its defaults */
} sph_term;

/* Fill *term with the defaults. Since 0.1. */
SPH_API void sph_term_init_sized(sph_term *term, size_t size);
#define sph_term_init(t) sph_term_init_sized((t), sizeof(sph_term))

/* A block of pairs of one particle i within the support, for a host's own term; the library's,
 * valid during the call. Arrays have `count` entries (dx: times dim). */
typedef struct sph_pair_block {
  size_t size;
  int32_t dim;
  int32_t count;    /* 1..64 */
  int64_t i;        /* host index */
  const int32_t *j; /* host indices */
  const double *dx; /* x_i - x_j, the nearest image */
  const double *r;  /* |dx| */
  const double *w;  /* W_ij */
  const double *f;  /* (dW/dr)/r, 0 at r = 0, so that grad_i W_ij = f * dx */
} sph_pair_block;

/* A host term may also add to the velocity gradient L of SPH_TERM_STRESS_RATE, before the materials
 * read it: give this in place of a field; out then has dim * dim components, row-major. Where no
 * stress rate is asked for, the term is skipped. */
enum { SPH_TARGET_VELOCITY_GRADIENT = 65536 };

/* Add the block's contribution to out (the components of the term's field, for particle i). Runs on
 * several threads at once for different i; blocks of one i come in a fixed order. Read the set
 * through `user`. */
typedef void (*sph_pair_fn)(void *user, const sph_pair_block *block, double *out);

/* Called before the pair loops (to set ghosts, held values, pressure) and after them (to overwrite
 * rates of driven particles). t is the stage's time. The rates hold garbage before the loops. 0: go
 * on; positive: SPH_RETRY; negative: SPH_ERR_CALLBACK. A prepare hook that moves particles calls
 * sph_particles_touch(); the list is updated after it. It may add and remove ghosts, not real
 * particles. */
struct sph_rate;
typedef int32_t (*sph_rhs_hook)(void *user, double t, sph_particles *set,
                                const struct sph_rate *rates, int32_t count);

typedef struct sph_rhs_options {
  size_t size;            /* set by sph_rhs_options_init() */
  int32_t position_field; /* geometry of the pairs: SPH_FIELD_X (default), or SPH_FIELD_X0 for a
                           * frozen configuration. It is remembered by address and counters: after
                           * destroying a set or list make a new right-hand side */
  int32_t update_list;    /* nonzero: sph_neighbors_update() before each evaluation; default 1 */
} sph_rhs_options;

/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_rhs_options_init_sized(sph_rhs_options *options, size_t size);
#define sph_rhs_options_init(o) sph_rhs_options_init_sized((o), sizeof(sph_rhs_options))

/* An array, the host's, that receives the rate of a field: real_count * components doubles. */
typedef struct sph_rate {
  int32_t field;
  double *values;
} sph_rate;

/* Create an empty right-hand side. The kernel is retained. options may be NULL. *out is NULL on
 * failure. SPH_ERR_ARG: position_field neither X nor X0. SPH_ERR_VERSION, SPH_ERR_NOMEM.
 * Since 0.1. */
SPH_API sph_status sph_rhs_create(sph_context *ctx, sph_kernel *kernel,
                                  const sph_rhs_options *options, sph_rhs **out);

/* Destroy; kernel and materials are given up. NULL is allowed. Since 0.1. */
SPH_API void sph_rhs_destroy(sph_rhs *rhs);

/* Append a term; copied. Each kind may come once. SPH_ERR_ARG: unknown kind or form, a parameter
 * not finite or out of range, twice the same kind, `corrected` on a term that cannot be, a
 * total-Lagrangian term or form without position_field X0. SPH_ERR_VERSION. The list of terms is as
 * before then. Since 0.1. */
SPH_API sph_status sph_rhs_add(sph_rhs *rhs, const sph_term *term);

/* Append a host's own term that adds to the rate of `field`, which the set must have when it is
 * evaluated, or to SPH_TARGET_VELOCITY_GRADIENT; fn and user must stay valid as long as rhs. Costs
 * one more pass over the pairs, in scalar code. SPH_ERR_ARG: fn NULL, field negative.
 * SPH_ERR_LIMIT: more than 16. Since 0.1. */
SPH_API sph_status sph_rhs_add_host(sph_rhs *rhs, int32_t field, sph_pair_fn fn, void *user);

/* Material of a phase (0..255), retained; NULL removes it. Where it has a pressure law, P of the
 * real particles is set from it before the pair loops, and before the prepare hook if there is one,
 * so that ghosts can mirror it. SPH_ERR_ARG: another phase. Since 0.1. */
SPH_API sph_status sph_rhs_set_material(sph_rhs *rhs, int32_t phase, sph_material *material);

/* The hook before the pair loops; NULL for none. The last one set counts. fn and user must stay
 * valid as long as rhs. Since 0.1. */
SPH_API sph_status sph_rhs_set_prepare(sph_rhs *rhs, sph_rhs_hook fn, void *user);

/* The hook after the pair loops; as above. Since 0.1. */
SPH_API sph_status sph_rhs_set_finish(sph_rhs *rhs, sph_rhs_hook fn, void *user);

/* Evaluate: every array in rates[0..count) is overwritten with the rate of its field (zero where no
 * term adds to it) for the real particles; ghosts act, but receive none. Terms whose field is not
 * asked for are skipped. `list` is updated first when the options say so.
 *
 * SPH_ERR_ARG: a rate array NULL, a field twice or unknown, a field that the terms need and that
 * the set lacks (named), a kernel or list that does not fit. SPH_ERR_STATE: SPH_TERM_STRESS_RATE
 * or SPH_TERM_FIRST_PIOLA for a phase whose material has no such law, a hook that changed the
 * number of real particles, a list never built and not to be updated. SPH_ERR_STALE: a list that is
 * not to be updated and holds no more. SPH_RETRY, SPH_ERR_CALLBACK: from hooks and materials.
 * SPH_ERR_NUMERIC: a particle outside the range of its material, such as det F <= 0 (it is
 * named). SPH_ERR_NOMEM; and what sph_neighbors_update() answers. After a failure the rate arrays
 * are undefined, the set is as the hooks left it.
 *
 * O(pairs). A steady call allocates nothing; rhs keeps what its terms need between sweeps: 8 dim^2
 * bytes a particle each for gradient matrices and for velocity gradients, and for total-Lagrangian
 * terms 8 bytes a stored pair (16 with CENTRAL) and at most 256 bytes a particle. Since 0.1. */
SPH_API sph_status sph_rhs_evaluate(sph_rhs *rhs, sph_particles *set, sph_neighbors *list, double t,
                                    const sph_rate *rates, int32_t count);

/* The laws by themselves, for schemes that need more than an evaluation gives: fill the field P or
 * C of the real particles with the pressures or sound speeds of their phases' materials; phases
 * without such a law are left alone. O(n), on the context's threads. SPH_ERR_ARG: another field, an
 * array that a law needs and that the set lacks. SPH_ERR_NUMERIC (the first particle is named),
 * SPH_RETRY, SPH_ERR_CALLBACK: from materials; the field is undefined then. Since 0.1. */
SPH_API sph_status sph_rhs_fill(sph_rhs *rhs, sph_particles *set, int32_t field);

/* Return the stresses of the real particles to the yield surfaces of their phases' materials, as
 * sph_material_plastic_return(): sigma, real_count packed symmetric, is the field or a copy of it;
 * plastic_strain, real_count, may be NULL without hardening. Phases without yield surface are left
 * alone. O(n), on the context's threads. SPH_ERR_ARG: sigma NULL, plastic_strain NULL where a law
 * hardens. SPH_ERR_UNSUPPORTED: a law that asks for the stress across the plane; SPH_RETRY,
 * SPH_ERR_CALLBACK: from materials. Since 0.1. */
SPH_API sph_status sph_rhs_plastic_return(sph_rhs *rhs, sph_particles *set, double *sigma,
                                          double *plastic_strain);

/* Strain energy per undeformed volume of the real particles, by the materials of their phases, from
 * the deformation gradients (field F) that the last evaluation with SPH_TERM_FIRST_PIOLA left; the
 * energy of a body is sum M / RHO times it. energy: real_count, the host's. Writes the field PK,
 * with the same values. O(n). SPH_ERR_ARG: energy NULL. SPH_ERR_STATE: no such evaluation, or a
 * phase without a law for P. SPH_RETRY, SPH_ERR_CALLBACK, SPH_ERR_NUMERIC: from materials; energy
 * is undefined then. Since 0.1. */
SPH_API sph_status sph_rhs_strain_energy(sph_rhs *rhs, sph_particles *set, double *energy);

#ifdef __cplusplus
}
#endif
#endif
