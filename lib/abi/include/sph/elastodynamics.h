/* Elastodynamics, updated Lagrangian: a ready scheme for solids, composed of public pieces.
 *
 *   d rho/dt  = -rho div v                (or rho frozen)
 *   d sigma/dt = the material's rate      (Hooke: with the Jaumann rate by its own option)
 *   dv/dt     = (1/rho) div sigma + artificial viscosity + artificial stress + body force
 *   dx/dt     = v (+ XSPH)
 *
 * He = L. He, PhD thesis, Durham 2015, (3.7), (3.8), (3.22), (3.29). Formulas, errata and costs
 * stand at the terms in operators.h and rhs.h; the smoothing length in adapt.h. src/scheme/
 * elastodynamics.c is meant to be read and copied.
 *
 *   sph_elastodynamics_options_init(&o);  o.dim = 2;  o.spacing = dp;
 *   sph_elastodynamics_create(ctx, set, &o, &solid);     set: X, V, M, RHO filled, SIGMA 0
 *   sph_elastodynamics_set_material(solid, 0, hooke);
 *   sph_elastodynamics_start(solid, 0.0);
 *   sph_elastodynamics_run(solid, t_end, NULL, NULL);
 *
 * Walls. Particles of the role SPH_ROLE_WALL take part in every sum, but their velocity is held:
 * with V = 0 they are a clamp, else they drive. (Another acceleration: the finish hook.) Free
 * surfaces need nothing with the forms CONSERVATIVE and SUMMED; with DIFFERENCE the host holds the
 * stress of its surface particles in a hook. Ghosts come and go in the prepare hook.
 *
 * What the momentum forms keep, sums over all pairs (t: with `corrected`):
 *
 *   form           momentum     energy of stress and strain rate
 *   CONSERVATIVE   to rounding  to rounding where rho is the same everywhere: the force is minus
 *                               the transpose of the velocity gradient (t)
 *   SUMMED         no (t), to rounding otherwise   no (t); otherwise as above
 *   DIFFERENCE     no           no
 *
 * Viscosity and artificial stress keep momentum unless `corrected_damping`; with it the viscosity
 * is not even sure to dissipate, and feeds slow modes after some thousand steps. None of the stress
 * forms keeps the angular momentum to rounding, for sigma g is not along x_ij; the ledger tells how
 * much each adds. At free surfaces SUMMED with `corrected` can gain energy: see the example
 * oscillating_beam. */
#ifndef SPH_ELASTODYNAMICS_H
#define SPH_ELASTODYNAMICS_H

#include <sph/adapt.h>
#include <sph/integrator.h>
#include <sph/kernel.h>
#include <sph/material.h>
#include <sph/neighbors.h>
#include <sph/operators.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_elastodynamics sph_elastodynamics;

/* Density. */
enum {
  SPH_DENSITY_FROZEN = 1,    /* as He integrates: rho stays (his state vector has none) */
  SPH_DENSITY_CONTINUITY = 2 /* SPH_CONTINUITY_VOLUME, He (3.8a) */
};

/* Smoothing length, see adapt.h. */
enum {
  SPH_H_LAW_CONSTANT = 1, /* ratio * spacing at the start, then constant */
  SPH_H_LAW_DENSITY = 2,  /* (6.1) in every evaluation; needs CONTINUITY */
  SPH_H_LAW_RATE = 3,     /* (6.2): H is integrated; needs CONTINUITY */
  SPH_H_LAW_SPACING = 4   /* (6.3): ratio * SPACING, anew when the host touched that field */
};

typedef struct sph_elastodynamics_options {
  size_t size;               /* set by sph_elastodynamics_options_init() */
  int32_t dim;               /* 1, 2, 3: that of the set; must be given */
  int32_t kernel;            /* SPH_KERNEL_*; default CUBIC_SPLINE */
  double spacing;            /* dp > 0, written to SPACING; 0 (default): the host filled SPACING */
  double h_ratio;            /* h / dp; default 1.5 */
  int32_t h_law;             /* SPH_H_LAW_*; default CONSTANT */
  int32_t h_rule;            /* SPH_H_*; default ARITHMETIC */
  int32_t momentum;          /* SPH_STRESS_*; default CONSERVATIVE */
  int32_t corrected;         /* gradients of v and of stress; default 1 */
  int32_t corrected_damping; /* those of viscosity and artificial stress; default 0 */
  int32_t density;           /* SPH_DENSITY_*; default FROZEN */
  double alpha, beta;        /* Monaghan's viscosity >= 0, both 0: none; defaults 2.5 */
  double artificial_stress;  /* epsilon >= 0; 0: none; default 0.3. It softens tension: see term */
  int32_t artificial_power;  /* n; default 4 */
  double artificial_spacing; /* f = 1 at this distance, in dp, > 0; default 1. At 0.75 it acts on
                              * pairs that come too close, and softens tension by a third of that */
  double xsph;               /* epsilon >= 0; default 0 */
  double body_force[3];      /* per mass; default 0 */
  double wave_speed; /* > 0: of every phase, e.g. sqrt(E/rho) as in the sources; 0 (default): the
                      * material's, the true longitudinal one */
  int32_t surface_damping; /* default 1: field C, which the viscosity reads, is the wave speed times
                            * max(1, tr(B_i^-1) / dim) of the start. At free surfaces corrected
                            * gradients are stiffer by this factor while half of the neighbours
                            * that damp are missing; without it RKC becomes unstable there beyond
                            * CFL 1.5. 0: C is the wave speed */
  int32_t integrator;      /* SPH_INTEGRATOR_* but BUTCHER; default RKC */
  int32_t stage_rule;      /* of RKC: SPH_STAGES_* but RADIUS; default CFL */
  int32_t stages;          /* FIXED: 2..100 */
  double cfl;              /* of stable_dt() > 0; default 1. With alpha = 2.5, surface_damping and
                            * artificial stress, RKC by the rule CFL holds to 2.5 */
  int32_t neighbors;       /* SPH_NEIGHBORS_*; default VERLET */
  double skin;             /* VERLET: in units of the smallest spacing, >= 0; default 0.3 */
  int32_t periodic[3];     /* as in sph_neighbors_options, with the box below */
  double box_lo[3], box_hi[3];
  int32_t position_field; /* SPH_FIELD_X (default), or SPH_FIELD_X0: all pairs and gradients of
                           * the configuration at the start, the total Lagrangian form that He
                           * prints in (3.27): for small strains and rotations only */
  int32_t audit;          /* nonzero: integrate the ledger's powers with the state. About three
                           * times the cost. Not with LEAPFROG. Default 0 */
} sph_elastodynamics_options;

/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_elastodynamics_options_init_sized(sph_elastodynamics_options *options,
                                                   size_t size);
#define sph_elastodynamics_options_init(o) \
  sph_elastodynamics_options_init_sized((o), sizeof(sph_elastodynamics_options))

/* Create for a set, which stays the host's and must outlive the scheme. *out is NULL on failure.
 * SPH_ERR_ARG: options NULL or out of range (the sentence names it), a law of h that needs the
 * continuity, a set of another dimension. SPH_ERR_UNSUPPORTED: BUTCHER, RADIUS (set up an
 * integrator of your own with the parts below), `audit` with LEAPFROG. SPH_ERR_VERSION,
 * SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_elastodynamics_create(sph_context *ctx, sph_particles *set,
                                             const sph_elastodynamics_options *options,
                                             sph_elastodynamics **out);
/* Destroy, with all parts. NULL is allowed. Since 0.1. */
SPH_API void sph_elastodynamics_destroy(sph_elastodynamics *solid);

/* Material of a phase (0..255), retained. Its stress rate is used, and its sound speed for field C
 * unless `wave_speed` is given. Before start. SPH_ERR_ARG: phase, and where the law wants arrays to
 * tell its sound speed (then give `wave_speed`); SPH_ERR_UNSUPPORTED: it has no sound speed.
 * Since 0.1. */
SPH_API sph_status sph_elastodynamics_set_material(sph_elastodynamics *solid, int32_t phase,
                                                   sph_material *material);

/* The host's hooks, as in rhs.h: before the pair loops (ghosts, held stresses), and after them,
 * when walls are held already. NULL for none; must outlive the scheme. Since 0.1. */
SPH_API sph_status sph_elastodynamics_set_prepare(sph_elastodynamics *solid, sph_rhs_hook fn,
                                                  void *user);
/* As above, after the pair loops. Since 0.1. */
SPH_API sph_status sph_elastodynamics_set_finish(sph_elastodynamics *solid, sph_rhs_hook fn,
                                                 void *user);

/* Begin at time t, from what the set holds: SPACING, H and C are filled as the options say, X0 = X;
 * list and integrator are made anew, bound to X, V, SIGMA (RHO, H), and the ledger begins. Call it
 * again after changing the number of particles. SPH_ERR_ARG: t not finite. SPH_ERR_STATE: no real
 * particles, a phase without material. SPH_ERR_NUMERIC: M, RHO or SPACING not positive and finite
 * (the first is named). SPH_ERR_NOMEM. The scheme cannot step after a failure. Since 0.1. */
SPH_API sph_status sph_elastodynamics_start(sph_elastodynamics *solid, double t);

/* cfl * min h_i / (h_ratio (c + |v_i|)) with the wave speed c of the phase, that is cfl dp / c for
 * slow particles. O(n). SPH_ERR_STATE: not started; SPH_ERR_NUMERIC: no finite positive step comes
 * out. Since 0.1. */
SPH_API sph_status sph_elastodynamics_stable_dt(const sph_elastodynamics *solid, double *dt);

/* One step. info may be NULL. SPH_ERR_STATE: not started; and what sph_integrator_step() answers;
 * time, fields and ledger are as before then. Since 0.1. */
SPH_API sph_status sph_elastodynamics_step(sph_elastodynamics *solid, double dt,
                                           sph_step_info *info);

/* After each step of a run, with what the integrator told. 0: go on; positive: end here with
 * SPH_OK; negative: SPH_ERR_CALLBACK. */
typedef int32_t (*sph_elastodynamics_fn)(void *user, sph_elastodynamics *solid,
                                         const sph_step_info *info);

/* Steps of stable_dt() until t_end, the last two shortened alike so that it is met exactly. A step
 * that asks for a smaller one is tried with half, up to 20 times. after may be NULL. The context's
 * progress hook is called after every step. SPH_ERR_ARG: t_end not finite or before the present
 * time; SPH_ERR_CALLBACK: one of the hooks; and what a step answers; the state is that after the
 * last good step. Since 0.1. */
SPH_API sph_status sph_elastodynamics_run(sph_elastodynamics *solid, double t_end,
                                          sph_elastodynamics_fn after, void *user);

/* Time of the state; NaN before start and for NULL. Since 0.1. */
SPH_API double sph_elastodynamics_time(const sph_elastodynamics *solid);

/* The parts, the scheme's: add a term, bind a field, query the list. Those of the hooks are taken:
 * use the scheme's. list and integrator are made by start, and NULL before. NULL for NULL.
 * Since 0.1. */
SPH_API sph_rhs *sph_elastodynamics_rhs(sph_elastodynamics *solid);
/* As above. Since 0.1. */
SPH_API sph_neighbors *sph_elastodynamics_list(sph_elastodynamics *solid);
/* As above. Since 0.1. */
SPH_API sph_integrator *sph_elastodynamics_integrator(sph_elastodynamics *solid);
/* As above. Since 0.1. */
SPH_API sph_kernel *sph_elastodynamics_kernel(sph_elastodynamics *solid);

/* Checkpoints: the state of a run in a buffer of the host's, after which it continues bit for bit,
 * in the same process or in another one. It holds all built-in fields that
 * the scheme reads, of the real particles, time, ledger, and what the integrator keeps of earlier
 * steps. Roles, phases, ghosts, hooks and fields of the host's own are not in it: create with the
 * same options and materials for a set with as many particles, roles and phases in the same order,
 * and restore instead of starting. Numbers are written as this machine has them; a sum over all
 * bytes guards them.
 *
 * *bytes receives the size. SPH_ERR_ARG: bytes NULL. SPH_ERR_STATE: not started; SPH_ERR_NOMEM.
 * Since 0.1. */
SPH_API sph_status sph_elastodynamics_state_size(sph_elastodynamics *solid, size_t *bytes);
/* Write it. The list is built anew by the next step, as in a restored run. SPH_ERR_ARG: buffer
 * NULL, not aligned as doubles are, or shorter than the size. Others as above. Since 0.1. */
SPH_API sph_status sph_elastodynamics_save(sph_elastodynamics *solid, void *buffer, size_t bytes);
/* Take it up. SPH_ERR_ARG: buffer as above; not such a state, damaged, or of other options or
 * another set: nothing has changed then but that the scheme must be started or restored again.
 * SPH_ERR_STATE: a phase without material; SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_elastodynamics_restore(sph_elastodynamics *solid, const void *buffer,
                                              size_t bytes);

/* Balances. The sums of the present state run over the real particles, walls included. What is
 * integrated since start is advanced by the integrator beside the fields, stage by stage; without
 * `audit` it is NaN. Integrals: sigma:D over volume m/rho; -m v.a of viscosity and artificial
 * stress (energy they take; that of the stress is given back when tension ends); m v.g of the body
 * force; hooks: m v.(a_after - a_before), what walls and the host's finish hook put in; form: what
 * stress force and strain rate do not balance between themselves, ghosts, terms that the host added
 * included. They leave
 *
 *   kinetic - kinetic(start) + strain + viscous + artificial - body - hooks - form
 *                                        = energy_error, of the time steps alone
 *   momentum - momentum(start) - impulse_body - impulse_hooks - impulse_form
 *                                        = momentum_error, rounding
 *
 * impulse_form is rounding itself where the form keeps momentum. Angular momentum about the
 * origin: z in 2-D, none in 1-D; moment_form is what pairs and body force add, moment_hooks what
 * walls and hooks do. */
typedef struct sph_elastodynamics_ledger {
  size_t size; /* set by sph_elastodynamics_ledger_init() */
  double time, mass, kinetic;
  double momentum[3], angular_momentum[3]; /* 2-D: angular_momentum[2] */
  double strain, viscous, artificial, body, hooks, form;
  double impulse_body[3], impulse_hooks[3], impulse_form[3];
  double moment_hooks[3], moment_form[3];
  double energy_error, momentum_error; /* the latter: largest component */
} sph_elastodynamics_ledger;

/* Fill *ledger with zeros. Since 0.1. */
SPH_API void sph_elastodynamics_ledger_init_sized(sph_elastodynamics_ledger *ledger, size_t size);
#define sph_elastodynamics_ledger_init(l) \
  sph_elastodynamics_ledger_init_sized((l), sizeof(sph_elastodynamics_ledger))

/* The ledger now. O(n). SPH_ERR_ARG: not initialised; SPH_ERR_STATE: not started. Since 0.1. */
SPH_API sph_status sph_elastodynamics_balance(const sph_elastodynamics *solid,
                                              sph_elastodynamics_ledger *ledger);

#ifdef __cplusplus
}
#endif
#endif
