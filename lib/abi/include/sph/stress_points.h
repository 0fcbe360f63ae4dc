/* Stress points: stresses live on points beside the particles, which takes away the odd-even mode
 * and with it the tensile instability of collocated particles.
 *
 * Dyka & Ingel (Comput. Struct. 57 (1995)), Randles & Libersky; He = L. He, PhD thesis, Durham
 * 2015, (3.19), which gives the idea but no formulas, and calls r_s/dp = 0.5 the standard scheme:
 * with r_s measured from the particle, as in his list of symbols, that is r_s = 0, and 0.5 is the
 * fully staggered grid. What is done here, exact for linear velocities and linear stresses
 * anywhere, next to free surfaces too (forms DIFFERENCE, corrected):
 *
 *   points      2^dim of each particle i, at x_p = x_i + d_p, d_p = (+-r_s, +-r_s, +-r_s) at first;
 *               V_p = V_i / 2^dim, m_p = m_i / 2^dim, rho_p = rho_i, h_p = h_i
 *   particles   L_i = sum_j V_j (v_j - v_i) (x) g~_ij      over particles
 *   points      v_p = v_i + L_i d_p, so that d(d_p)/dt = L_i d_p: points stay with their particle
 *               L_p = sum_j V_j (v_j - v_p) (x) g~_pj      over particles
 *               d sigma_p/dt: the material's law on L_p, sigma_p
 *   particles   sigma_i = mean of the particle's own points (exact for linear stresses, as their
 * d_p always add up to zero) DIFFERENCE  dv_i/dt = sum_p m_p (sigma_p - sigma_i) / (rho_i rho_p)
 * g~_ip SUMMED      dv_i/dt = sum_p m_p (sigma_i/rho_i^2 + sigma_p/rho_p^2) g~_ip over points
 *   dx_i/dt = v_i,  d rho_i/dt = -rho_i tr L_i  (if asked for)
 *
 * with g~ corrected by the matrices of the row (correction.h), made from particles where the sum
 * is over particles and from points where it is over points. Shepard means for v_p and sigma_i,
 * which are also in use, lose the exactness at boundaries and let points drift from particles.
 * Neither form conserves momentum to rounding: a point has no velocity of its own that could take
 * up the reaction.
 *
 * Ghosts of the set take part in L_i and L_p; they have no points. */
#ifndef SPH_STRESS_POINTS_H
#define SPH_STRESS_POINTS_H

#include <sph/integrator.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_stress_points sph_stress_points;

typedef struct sph_stress_points_options {
  size_t size;          /* set by sph_stress_points_options_init() */
  double offset;        /* r_s in units of (m/rho)^(1/dim), 0 .. 0.5; default 0.5 */
  int32_t form;         /* SPH_STRESS_DIFFERENCE (default) or SPH_STRESS_SUMMED */
  int32_t corrected;    /* nonzero (default 1): corrected gradients */
  sph_rhs_hook prepare; /* before the sums, may be NULL: ghosts (sph_ghosts_prepare()) */
  void *prepare_user;
  sph_rhs_hook finish; /* after the sums, may be NULL: held particles (sph_hold_finish()), forces */
  void *finish_user;
} sph_stress_points_options;

/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_stress_points_options_init_sized(sph_stress_points_options *options, size_t size);
#define sph_stress_points_options_init(o) \
  sph_stress_points_options_init_sized((o), sizeof(sph_stress_points_options))

/* Create a handle without points. The kernel is retained; `list` stays the host's, must outlive the
 * handle and serves it alone: particles and points go into it together. options may be NULL. *out
 * is NULL on failure. SPH_ERR_ARG: offset outside 0 .. 0.5, another form. SPH_ERR_VERSION,
 * SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_stress_points_create(sph_context *ctx, sph_kernel *kernel,
                                            sph_neighbors *list,
                                            const sph_stress_points_options *options,
                                            sph_stress_points **out);

/* Destroy. NULL is allowed. Since 0.1. */
SPH_API void sph_stress_points_destroy(sph_stress_points *points);

/* Material of the points of particles of a phase (0..255), retained; NULL removes it.
 * SPH_ERR_ARG: another phase. Since 0.1. */
SPH_API sph_status sph_stress_points_set_material(sph_stress_points *points, int32_t phase,
                                                  sph_material *material);

/* Make the points of the real particles of `set` from X, M and RHO; their stress is that of their
 * particle, 0 where SIGMA does not exist. To be called again when particles are added or removed.
 * Points that were there are replaced; arrays may move.
 * SPH_ERR_ARG: no M or RHO, another dimension than the kernel's; a mass or density not positive and
 * finite, named. SPH_ERR_LIMIT: more than 2^31 - 64 particles and points. SPH_ERR_NOMEM. The points
 * are as before then. O(n). Since 0.1. */
SPH_API sph_status sph_stress_points_place(sph_stress_points *points, const sph_particles *set);

/* Points, 2^dim a real particle, those of particle i from i 2^dim on; 0 for NULL. Since 0.1. */
SPH_API int64_t sph_stress_points_count(const sph_stress_points *points);

/* d_p, count * dim, and sigma_p, count packed symmetric: the state of the points, writable. Valid
 * until points are placed again; NULL for NULL. Since 0.1. */
SPH_API double *sph_stress_points_offsets(sph_stress_points *points);
/* sigma_p, as above. Since 0.1. */
SPH_API double *sph_stress_points_stresses(sph_stress_points *points);

/* Write the mean stress of each real particle's points into field SIGMA of `set`, for output. SIGMA
 * is made where it does not exist. SPH_ERR_STATE: the points are not those of this set's particles.
 * SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_stress_points_average(sph_stress_points *points, sph_particles *set);

/* Rates of everything, as a right-hand side for sph_integrator_set_function() (user: the handle).
 * rates may hold X, V, RHO of the set; of plain arrays (negative fields) the first is taken for the
 * offsets and the second for the stresses. Fields V, M, RHO, H must exist.
 *
 * The answer is 0, positive from hooks and materials, or a status: SPH_ERR_ARG: another rate, a
 * missing field; SPH_ERR_STATE: the points are not those of this set's particles, a phase without a
 * stress law; what the operators and sph_neighbors_update_arrays() answer. Three sweeps over the
 * particles and points together, five when corrected. A steady call allocates nothing. Since 0.1.
 */
SPH_API int32_t sph_stress_points_rates(void *points, double t, sph_particles *set,
                                        const sph_rate *rates, int32_t count);

/* Bind V and X, the offsets and the stresses to an integrator, and set the function above. After
 * sph_stress_points_place() only, and again after another. SPH_ERR_STATE: no points;
 * SPH_ERR_UNSUPPORTED: leapfrog takes no arrays; what binding answers. On failure some may be
 * bound. Since 0.1. */
SPH_API sph_status sph_stress_points_bind(sph_stress_points *points, sph_integrator *it);

#ifdef __cplusplus
}
#endif
#endif
