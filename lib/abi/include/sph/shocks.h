/* Shocks through gases, liquids and solids, with jumps of density and of material: a ready scheme,
 * composed of public pieces.
 *
 *   d rho/dt = the smoothed rate + mass flux           (or rho by summation)
 *   dv/dt    = pressure + deviator + viscosity + body force
 *   de/dt    = their work + heating + conduction
 *   dS/dt    = the material's rate, for materials with strength; then S returned to its yield
 * stress dx/dt    = v,   h = eta (m/rho)^(1/d),   p and c by the equation of state
 *
 * Zisis = I. Zisis, PhD thesis, Eindhoven 2017, chapters 4 to 6. Formulas, errata and costs stand
 * at the pieces: smoothing.h (sums, dissipation), adapt.h (h by summation), integrator.h
 * (leapfrog), eos.h, plasticity.h (strength). src/scheme/shocks.c is meant to be read and copied.
 *
 *   sph_shocks_options_init(&o);  o.dim = 2;
 *   sph_shocks_create(ctx, set, &o, &shocks);            set: X, V, M, RHO, E filled
 *   sph_shocks_set_material(shocks, 0, gas);
 *   sph_shocks_start(shocks, 0.0);
 *   sph_shocks_run(shocks, t_end, NULL, NULL);
 *
 * Energies from pressures: sph_material_energy(). Densities and masses are exact at the start, no
 * sum smears them: give each particle the rho of its place, m = rho times its volume.
 *
 * Boundaries. Free surfaces need nothing. Particles of the role SPH_ROLE_WALL take part in every
 * sum, but keep V, RHO, E and SIGMA, so that a layer of them is a reservoir; they move with V,
 * which is zero for a rigid frame and not for an inflow or a piston. Plane walls: hand a sph_ghosts
 * over with sph_shocks_set_ghosts(). A particle without neighbours flies on ballistically.
 *
 * What is kept: mass always; momentum, and kinetic + internal energy, to the rounding of each
 * evaluation, by any smoothing, with any masses and lengths; so what the ledger shows is the error
 * of the time steps alone, about 1e-8 to 1e-5 at the default cfl. Angular momentum is kept as well
 * but by the deviator, whose forces are not central.
 *
 * Bad states. A density that comes out zero, negative or not finite within a step, or a state
 * outside the range of its material, is SPH_ERR_NUMERIC with a sentence that names particle and
 * values; the state is then as before the step. A smaller step may help: run tries up to 20
 * halvings, and ends in the state after the last good step if none does. Nothing is clipped but
 * omega by its floor (counted in the ledger), the mass flux by its limit (smoothing.h) and what a
 * material clips itself (eos.h).
 */
#ifndef SPH_SHOCKS_H
#define SPH_SHOCKS_H

#include <sph/adapt.h>
#include <sph/boundary.h>
#include <sph/integrator.h>
#include <sph/kernel.h>
#include <sph/material.h>
#include <sph/neighbors.h>
#include <sph/smoothing.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_shocks sph_shocks;

/* Density. */
enum {
  SPH_SHOCKS_DIFFERENTIAL = 1, /* RHO is integrated from its exact values: no error at surfaces and
                                * contacts, no solve. What the source runs */
  /* RHO is the sum, solved with h in every evaluation (adapt.h), of walls too: make their layers
   * two supports thick. Not with VOLUME, which has no sum; without mass flux, which acts on a rate,
   * so that NUMBER keeps a spike of P at a contact of unequal masses (58 per cent in the tube of
   * Sod with equal spacing; MASS 21). The host's RHO is the first guess, and gives way */
  SPH_SHOCKS_INTEGRAL = 2
};

typedef struct sph_shocks_options {
  size_t size;       /* set by sph_shocks_options_init() */
  int32_t dim;       /* 1, 2, 3: that of the set; must be given */
  int32_t kernel;    /* SPH_KERNEL_*; default GAUSSIAN, whose support is 3 h */
  int32_t smoothing; /* SPH_SMOOTHING_*; default NUMBER, the one for unequal masses */
  int32_t density;   /* SPH_SHOCKS_*; default DIFFERENTIAL */
  double eta; /* h = eta (m/rho)^(1/d), > 0; default 1.2, for the Gaussian. The same resolution
               * with another kernel: sph_kernel_equal_h() */
  int32_t adaptive;      /* default 1: h follows rho, with the factor omega. 0: H stays as the host
                          * filled it (0: eta (m/rho)^(1/d) of the start), omega is 1 */
  double omega_floor;    /* >= 0; default 0.2. Forces between neighbours grow as 1/omega^2: where a
                          * solid tears, particles clump, and clumps with omega below about 0.26 were
                          * seen to vibrate unstably at cfl 0.25; 0.5 is safe there */
  int32_t keep_unsolved; /* INTEGRAL: nonzero: a particle whose h is not found keeps the one it had
                          * and is counted in the ledger. 0 (default): the step fails */
  const sph_dissipation *dissipation; /* copied. NULL (default): the defaults there, in which
                                       * INTEGRAL takes no mass flux */
  double body_force[3];               /* per mass; default 0 */
  int32_t integrator;   /* SPH_INTEGRATOR_* but BUTCHER and RKC; default LEAPFROG_PREDICTED, that
                         * of the source, one evaluation a step */
  double cfl;           /* of stable_dt() > 0; default 0.25 */
  double density_limit; /* largest |d rho|/rho of a step, > 0, may be infinite; default 0.1 */
  int32_t neighbors;    /* SPH_NEIGHBORS_*; default CELLS. TREE where h differs by more than about
                         * five, VERLET where h is fixed */
  double skin;          /* VERLET: in units of the smallest h, >= 0; default 0.2 */
  int64_t max_pairs;    /* as in sph_neighbors_options: an end to runs in which particles clump;
                         * default 0, none */
  int32_t periodic[3];  /* as in sph_neighbors_options, with the box below */
  double box_lo[3], box_hi[3];
  int32_t audit; /* nonzero (default): integrate the ledger's powers with the state, some
                  * per cent of the cost. Not with LEAPFROG */
} sph_shocks_options;

/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_shocks_options_init_sized(sph_shocks_options *options, size_t size);
#define sph_shocks_options_init(o) sph_shocks_options_init_sized((o), sizeof(sph_shocks_options))

/* Create for a set, which stays the host's and must outlive the scheme. *out is NULL on failure.
 * SPH_ERR_ARG: options NULL or out of range (the sentence names it), a set of another dimension,
 * INTEGRAL with a mass flux or with adaptive 0. SPH_ERR_UNSUPPORTED: INTEGRAL with VOLUME, BUTCHER
 * and RKC (set up an integrator of your own with the parts below), `audit` with LEAPFROG.
 * SPH_ERR_VERSION, SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_shocks_create(sph_context *ctx, sph_particles *set,
                                     const sph_shocks_options *options, sph_shocks **out);
/* Destroy, with all parts. NULL is allowed. Since 0.1. */
SPH_API void sph_shocks_destroy(sph_shocks *shocks);

/* Material of a phase (0..255), retained: pressure and sound speed are read. Where one phase has
 * strength (a stress rate, as from sph_material_create_strength()), SIGMA, the deviator, is
 * integrated; it is zero, and stays so, in phases without. Its return to the yield stress is done
 * on every copy of SIGMA that the integrator keeps, and the plastic strain of hardening laws is the
 * set's field "plastic_strain". Before start. SPH_ERR_ARG: phase. SPH_ERR_UNSUPPORTED: no pressure
 * or no sound speed. SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_shocks_set_material(sph_shocks *shocks, int32_t phase,
                                           sph_material *material);

/* Plane walls: the scheme updates or refreshes these ghosts in every evaluation, when H, P and C
 * are known, and gives them their owners' omega. The handle stays the host's and must outlive the
 * scheme; its support must be the kernel's. NULL: none. SPH_ERR_ARG: another dimension.
 * Since 0.1. */
SPH_API sph_status sph_shocks_set_ghosts(sph_shocks *shocks, sph_ghosts *ghosts);

/* The host's hooks, as in rhs.h. Prepare runs when H, P and C of the real particles are known,
 * before ghosts, list and omega; a host that makes ghosts of its own does it here, and fills their
 * OMEGA (one that is not positive becomes 1). Finish runs after the pair loops, when walls are held
 * already. NULL for none; must outlive the scheme. Since 0.1. */
SPH_API sph_status sph_shocks_set_prepare(sph_shocks *shocks, sph_rhs_hook fn, void *user);
/* As above, after the pair loops. Since 0.1. */
SPH_API sph_status sph_shocks_set_finish(sph_shocks *shocks, sph_rhs_hook fn, void *user);

/* Begin at time t, from what the set holds: X, V, M, RHO, E (and SIGMA, for strength). List and
 * integrator are made anew, the ledger begins, and one evaluation fills H, P, C, OMEGA. Call it
 * again after changing the number of particles. SPH_ERR_ARG: t not finite. SPH_ERR_STATE: no real
 * particles, a phase without material. SPH_ERR_NUMERIC: M or RHO not positive and finite, E not in
 * the range of the material (the first is named), and what an evaluation answers. SPH_ERR_NOMEM.
 * The scheme cannot step after a failure. Since 0.1. */
SPH_API sph_status sph_shocks_start(sph_shocks *shocks, double t);

/* Fill the fields that follow from the state, at its time: RHO (INTEGRAL), H, P, C, OMEGA and
 * ghosts. A step leaves them as its last evaluation made them, but for H, P and C of DIFFERENTIAL,
 * which are the state's; run calls this at its end. The cost of a density sum. Errors as for a
 * step; the integrated fields are as before. Since 0.1. */
SPH_API sph_status sph_shocks_update(sph_shocks *shocks);

/* The smaller of cfl * min h_i/(c_i + max_j |v_ij.r_ij|), over the neighbours j, so that it does
 * not depend on the frame of reference, and density_limit * min rho_i/|d rho_i/dt| of the last
 * evaluation (DIFFERENTIAL). It runs the prepare hook, updates ghosts and list, and with INTEGRAL
 * solves, which the next evaluation then need not. O(pairs). SPH_ERR_STATE: not started;
 * SPH_ERR_NUMERIC: no finite positive step comes out. Since 0.1. */
SPH_API sph_status sph_shocks_stable_dt(sph_shocks *shocks, double *dt);

/* One step; then the return to the yield stress. info may be NULL. SPH_ERR_NUMERIC: a bad state,
 * see above; SPH_RETRY: a hook, ghosts or material asked for a smaller step; SPH_ERR_STATE: not
 * started; and what sph_integrator_step() answers; time, fields and ledger are as before then.
 * Since 0.1. */
SPH_API sph_status sph_shocks_step(sph_shocks *shocks, double dt, sph_step_info *info);

/* After each step of a run, with what the integrator told. 0: go on; positive: end here with
 * SPH_OK; negative: SPH_ERR_CALLBACK. */
typedef int32_t (*sph_shocks_fn)(void *user, sph_shocks *shocks, const sph_step_info *info);

/* Steps of stable_dt() until t_end, the last two shortened alike so that it is met exactly; then
 * sph_shocks_update(). A step that asks for a smaller one, or meets a state out of range, is tried
 * with half, up to 20 times; the ledger counts. after may be NULL. The context's progress hook is
 * called after every step. SPH_ERR_ARG: t_end not finite or before the present time;
 * SPH_ERR_CALLBACK: one of the hooks; and what a step answers; the state is that after the last
 * good step. Since 0.1. */
SPH_API sph_status sph_shocks_run(sph_shocks *shocks, double t_end, sph_shocks_fn after,
                                  void *user);

/* Time of the state; NaN before start and for NULL. Since 0.1. */
SPH_API double sph_shocks_time(const sph_shocks *shocks);

/* The parts, the scheme's: add a term, bind a field, query the list. Their hooks are taken: use the
 * scheme's. list and integrator are made by start, and NULL before. NULL for NULL. Since 0.1. */
SPH_API sph_rhs *sph_shocks_rhs(sph_shocks *shocks);
/* As above. Since 0.1. */
SPH_API sph_neighbors *sph_shocks_list(sph_shocks *shocks);
/* As above. Since 0.1. */
SPH_API sph_integrator *sph_shocks_integrator(sph_shocks *shocks);
/* As above. Since 0.1. */
SPH_API sph_kernel *sph_shocks_kernel(sph_shocks *shocks);

/* Checkpoints: the state of a run in a buffer of the host's, after which it continues bit for bit,
 * in the same process or in another one. It holds X, V, M, RHO, E, H, SIGMA and plastic strain of
 * the real particles, time, ledger and what the integrator keeps of earlier steps. Roles, phases,
 * ghosts, hooks and fields of the host's own are not in it: create with the same options and
 * materials for a set with as many particles, roles and phases in the same order, and restore
 * instead of starting. Numbers are written as this machine has them; a sum over all bytes guards
 * them.
 *
 * *bytes receives the size. SPH_ERR_ARG: bytes NULL. SPH_ERR_STATE: not started; SPH_ERR_NOMEM.
 * Since 0.1. */
SPH_API sph_status sph_shocks_state_size(sph_shocks *shocks, size_t *bytes);
/* Write it. The list is built anew by the next step, as in a restored run. SPH_ERR_ARG: buffer
 * NULL, not aligned as doubles are, or shorter than the size. Others as above. Since 0.1. */
SPH_API sph_status sph_shocks_save(sph_shocks *shocks, void *buffer, size_t bytes);
/* Take it up. SPH_ERR_ARG: buffer as above; not such a state, damaged, or of other options or
 * another set: nothing has changed then but that the scheme must be started or restored again. What
 * sph_shocks_start() answers. Since 0.1. */
SPH_API sph_status sph_shocks_restore(sph_shocks *shocks, const void *buffer, size_t bytes);

/* Balances. The sums of the present state run over the real particles, walls included. What is
 * integrated since start is advanced by the integrator beside the fields; without `audit` it is
 * NaN. Integrals: m v.g of the body force; walls: m (v.a + de/dt) that holding walls took away or
 * gave, with the sign of a gain of the sums; hooks: likewise, what the host's finish hook changed;
 * form: m (v.a + de/dt) of all pairs, what ghosts and terms of the host put in, rounding otherwise.
 * They leave
 *
 *   total - total(start) - body - walls - hooks - form          = energy_error, of the time steps
 *   momentum - momentum(start) - impulse_body - ..walls - ..hooks - ..form
 *                                                               = momentum_error, rounding
 *
 * total = kinetic + internal, internal the sum of m e, which holds elastic and plastic work too.
 * Angular momentum about the origin: z in 2-D, none in 1-D. Ghosts at SLIP walls at rest leave
 * total alone. */
typedef struct sph_shocks_ledger {
  size_t size; /* set by sph_shocks_ledger_init() */
  double time, mass, kinetic, internal, total;
  double momentum[3], angular_momentum[3]; /* 2-D: angular_momentum[2] */
  double body, walls, hooks, form;
  double impulse_body[3], impulse_walls[3], impulse_hooks[3], impulse_form[3];
  double energy_error, momentum_error; /* the latter: largest component */
  int64_t steps;                       /* since start */
  int64_t retries;                     /* smaller steps that were needed */
  int64_t unsolved; /* INTEGRAL, keep_unsolved: particles that kept h, summed over evaluations */
  int64_t floored;  /* particles whose omega was raised to its floor in the last evaluation */
} sph_shocks_ledger;

/* Fill *ledger with zeros. Since 0.1. */
SPH_API void sph_shocks_ledger_init_sized(sph_shocks_ledger *ledger, size_t size);
#define sph_shocks_ledger_init(l) sph_shocks_ledger_init_sized((l), sizeof(sph_shocks_ledger))

/* The ledger now. O(n). SPH_ERR_ARG: not initialised; SPH_ERR_STATE: not started. Since 0.1. */
SPH_API sph_status sph_shocks_balance(const sph_shocks *shocks, sph_shocks_ledger *ledger);

#ifdef __cplusplus
}
#endif
#endif
