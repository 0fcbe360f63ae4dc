/* A ready scheme: total-Lagrangian elasticity of bodies that deform a lot and do not break.
 *
 *   F_i = sum V_j (x_j - x_i) (x) B_i^-1 g_ij,   P_i = d psi / d F (F_i),
 *   dv_i/dt = (1/rho_i) sum V_j (P_i B_i^-1 + P_j B_j^-1) g_ij + hourglass control + viscosity + g,
 *   dx_i/dt = v_i,
 * all kernels in the reference configuration, so that no pair is ever lost or found, and there is
 * no tensile instability. The default forms derive from an energy: momentum is kept to rounding,
 * angular momentum and energy as well as the integrator keeps them. Formulas, forms and sources
 * stand at the operators (operators.h) and terms (rhs.h).
 *
 * The scheme is made of public pieces only, one file, to be read and copied: a kernel, a list, a
 * right-hand side, an integrator. Two of them are handed out, for hooks (clamped and driven
 * particles, loads), further terms, more materials:
 *
 *   sph_total_lagrangian_create(ctx, &options, rubber, &tl);
 *   (fill X, M, RHO of a set)
 *   sph_total_lagrangian_start(tl, set);
 *   sph_rhs_set_finish(sph_total_lagrangian_rhs(tl), clamp, NULL);
 *   sph_total_lagrangian_time_step(tl, set, &dt);
 *   sph_total_lagrangian_step(tl, set, t, dt);
 *
 * Two bodies that meet need a force between them in the current configuration: see
 * examples/rubber_rings.c. */
#ifndef SPH_TOTAL_LAGRANGIAN_H
#define SPH_TOTAL_LAGRANGIAN_H

#include <sph/kernel.h>
#include <sph/rhs.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_total_lagrangian_options {
  size_t size;    /* set by sph_total_lagrangian_options_init() */
  int32_t dim;    /* 1, 2 or 3; must be given */
  int32_t kernel; /* SPH_KERNEL_*; default WENDLAND_C2 */
  /* h / spacing, > 0; default 1. On regular lattices 0.8 is more accurate: a layer as thick as the
   * support is too soft at surfaces. Larger ratios suit disorder. */
  double h_ratio;
  int32_t form;           /* SPH_PIOLA_*; default CONSERVATIVE. SUMMED is corrected */
  int32_t hourglass_form; /* SPH_HOURGLASS_*; default VARIATIONAL */
  double hourglass;       /* its alpha, >= 0; 0: no control; default 0.1 */
  double alpha, beta;     /* Monaghan's viscosity in the current geometry, >= 0; default 0 */
  double gravity[3];      /* force per mass; default 0 */
  double cfl;             /* of sph_total_lagrangian_time_step(), > 0; default 0.5 */
  /* SPH_INTEGRATOR_*; default LEAPFROG, which is the scheme's own here: it keeps the last
   * acceleration, so that a step takes one evaluation. BUTCHER and RKC, which need options of their
   * own, are for hosts that step the right-hand side themselves. */
  int32_t integrator;
  int32_t
      audit; /* nonzero: keep the ledger below; about twice the cost, LEAPFROG alone. Default 0 */
} sph_total_lagrangian_options;

/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_total_lagrangian_options_init_sized(sph_total_lagrangian_options *options,
                                                     size_t size);
#define sph_total_lagrangian_options_init(o) \
  sph_total_lagrangian_options_init_sized((o), sizeof(sph_total_lagrangian_options))

/* Create. `material` is that of phase 0, retained; it must have a first Piola-Kirchhoff stress and
 * a sound speed. Other phases: sph_rhs_set_material() on the right-hand side. *out is NULL on
 * failure. SPH_ERR_ARG: options out of range or not finite, the material NULL. SPH_ERR_UNSUPPORTED:
 * an integrator the scheme does not run, `audit` with another one than LEAPFROG. SPH_ERR_VERSION,
 * SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_total_lagrangian_create(sph_context *ctx,
                                               const sph_total_lagrangian_options *options,
                                               sph_material *material, sph_total_lagrangian **out);

/* Destroy. NULL is allowed. Since 0.1. */
SPH_API void sph_total_lagrangian_destroy(sph_total_lagrangian *tl);

/* The right-hand side and the list, owned by the scheme; NULL for NULL. After changing terms, hooks
 * or materials between steps call sph_particles_touch(set, SPH_FIELD_X): the kept acceleration is
 * then computed anew. Since 0.1. */
SPH_API sph_rhs *sph_total_lagrangian_rhs(sph_total_lagrangian *tl);
/* See above. Since 0.1. */
SPH_API sph_neighbors *sph_total_lagrangian_list(sph_total_lagrangian *tl);

/* Take the present state of a set as the reference configuration. Read: X, M and RHO (both
 * positive, of all particles). Written: X0 = X; H = h_ratio times the field SPACING where the set
 * has it and it is positive, else times (M / RHO)^(1/dim); C, the sound speed of the material of
 * phase 0, where the set has no C yet (a host with several materials fills C itself, for hourglass
 * control and viscosity). V comes to be, zero, where it is missing. The list is built. Keep X0, H,
 * M, RHO and C as they are from here on, or start again.
 *
 * SPH_ERR_ARG: a dimension that does not fit, M or RHO missing or not positive and finite (the
 * particle is named). What sph_neighbors_build_arrays() and the material answer. Fields written
 * before the failure stay written. O(n + pairs). Since 0.1. */
SPH_API sph_status sph_total_lagrangian_start(sph_total_lagrangian *tl, sph_particles *set);

/* cfl * min dp_i / c_i over the real particles, dp = H / h_ratio, c the field C: sound speeds at
 * rest. Leapfrog is stable up to about cfl = 1 for the default kernel, h_ratio 0.8 to 1.2 and
 * hourglass control 0.1; where stretches exceed some tens of per cent, or hourglass control 0.5,
 * take less. SPH_ERR_STATE: not started. SPH_ERR_NUMERIC: an empty set, or all speeds 0. O(n).
 * Since 0.1. */
SPH_API sph_status sph_total_lagrangian_time_step(sph_total_lagrangian *tl,
                                                  const sph_particles *set, double *dt);

/* Advance X and V of the real particles from t to t + dt. Leapfrog: v_h = v + dt/2 a, x += dt v_h,
 * v = v_h + dt/2 a(x, v_h); the acceleration at the end serves the next step where t, X and V are
 * as this one left them (sph_particles_touch() when the host writes X or V). Reversible, and
 * without viscosity symplectic.
 *
 * SPH_ERR_ARG: t not finite, dt 0 or not finite. SPH_ERR_STATE: not started. What
 * sph_rhs_evaluate() and sph_integrator_step() answer; SPH_ERR_NUMERIC also when the result is not
 * finite. X and V are as before then, to the bit. A steady step allocates nothing. Since 0.1. */
SPH_API sph_status sph_total_lagrangian_step(sph_total_lagrangian *tl, sph_particles *set, double t,
                                             double dt);

/* Checkpoints: the state of a run in a buffer of the host's, after which it continues bit for bit,
 * in the same process or in another one. It holds X, V, X0, H, M, RHO, C of the
 * real particles, and the acceleration that the leapfrog carries over, and what the integrator
 * keeps of earlier steps. Roles, phases, ghosts, hooks and fields of the host's own are not in it:
 * create with the same options and materials, fill roles and phases of a set with as many particles
 * in the same order, and restore instead of starting. Numbers are written as this machine has them;
 * a sum over all bytes guards them.
 *
 * *bytes receives the size. SPH_ERR_ARG: bytes NULL. SPH_ERR_STATE: not started; SPH_ERR_NOMEM.
 * Since 0.1. */
SPH_API sph_status sph_total_lagrangian_state_size(sph_total_lagrangian *tl, sph_particles *set,
                                                   size_t *bytes);
/* Write it. SPH_ERR_ARG: buffer NULL, not aligned as doubles are, or shorter than the size. Others
 * as above. Since 0.1. */
SPH_API sph_status sph_total_lagrangian_save(sph_total_lagrangian *tl, sph_particles *set,
                                             void *buffer, size_t bytes);
/* Take it up. SPH_ERR_ARG: buffer as above; not such a state, damaged, or of other options or
 * another set: nothing has changed then but that the scheme must be started or restored again. What
 * sph_neighbors_build_arrays() answers. Since 0.1. */
SPH_API sph_status sph_total_lagrangian_restore(sph_total_lagrangian *tl, sph_particles *set,
                                                const void *buffer, size_t bytes);

/* Energies of the real particles, each a sum over them in order; add the potential of what the host
 * applies. */
typedef struct sph_total_lagrangian_energies {
  size_t size;      /* set by the caller, sizeof the struct */
  double kinetic;   /* sum m v^2 / 2 */
  double strain;    /* sum V psi(F) */
  double hourglass; /* of the springs; for the form CENTRAL they are no potential */
  double gravity;   /* -sum m g.x */
} sph_total_lagrangian_energies;

/* Energies at (t, set), evaluating where the kept acceleration does not hold. Three sweeps more
 * with hourglass control. SPH_ERR_ARG: size too small. SPH_ERR_STATE: not started. Otherwise as for
 * the step. *energies is untouched then. Since 0.1. */
SPH_API sph_status sph_total_lagrangian_energy(sph_total_lagrangian *tl, sph_particles *set,
                                               double t, sph_total_lagrangian_energies *energies);

/* Balances. The sums of the present state run over the real particles. What is added up since the
 * first step after sph_total_lagrangian_start() is NaN before it and without `audit`: the work of
 * gravity and of hooks (with the host's terms), what the viscosity takes, the impulses and moments
 * of each. form: stress, hourglass control and viscosity, whose impulse is rounding where the form
 * keeps momentum, and so is its moment with the defaults. The kicks of the leapfrog are exact in
 * all of these, so that
 *
 *   kinetic + strain + hourglass - (the same at the start) + viscous - gravity - hooks
 *                                            = energy_error, of the time steps alone (where the
 *                                              forms derive from an energy)
 *   momentum - momentum(start) - impulse_gravity - impulse_hooks - impulse_form
 *                                            = momentum_error, rounding
 *
 * and likewise with the angular momentum about the origin: z in 2-D, none in 1-D. What the host
 * writes into X or V between steps is in none of the sums and shows in the errors. */
typedef struct sph_total_lagrangian_ledger {
  size_t size; /* set by sph_total_lagrangian_ledger_init() */
  double time, mass, kinetic, strain, hourglass;
  double momentum[3], angular_momentum[3]; /* 2-D: angular_momentum[2] */
  double viscous, gravity, hooks;
  double impulse_gravity[3], impulse_hooks[3], impulse_form[3];
  double moment_gravity[3], moment_hooks[3], moment_form[3];
  double energy_error, momentum_error, angular_momentum_error; /* the latter: largest components */
} sph_total_lagrangian_ledger;

/* Fill *ledger with zeros. Since 0.1. */
SPH_API void sph_total_lagrangian_ledger_init_sized(sph_total_lagrangian_ledger *ledger,
                                                    size_t size);
#define sph_total_lagrangian_ledger_init(l) \
  sph_total_lagrangian_ledger_init_sized((l), sizeof(sph_total_lagrangian_ledger))

/* The ledger at (t, set). Cost and errors as of sph_total_lagrangian_energy(); SPH_ERR_ARG also:
 * *ledger not initialised, and it is untouched after a failure. Since 0.1. */
SPH_API sph_status sph_total_lagrangian_balance(sph_total_lagrangian *tl, sph_particles *set,
                                                double t, sph_total_lagrangian_ledger *ledger);

#ifdef __cplusplus
}
#endif
#endif
