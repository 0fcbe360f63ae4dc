/* Resolution that varies: laws for the smoothing length, lengths that fit the density, and the one
 * h and W of a pair.
 *
 * "He" = L. He, PhD thesis, Durham 2015, chapter 6; "Zisis" = I. Zisis, PhD thesis, TU Eindhoven
 * 2017. d is the dimension.
 *
 * Laws. All keep the number of neighbours roughly constant:
 *
 *   density   h_i = h_i0 (rho_i0 / rho_i)^(1/d)                         He (6.1)
 *   rate      dh_i/dt = -(h_i / (d rho_i)) d rho_i/dt                   He (6.2), its derivative
 *   spacing   h_i = a dp_i, with a in 0.8 .. 1.8, usually 1.5           He (6.3)
 *   mass      h_i = eta (m_i / rho_i)^(1/d), with eta 1.2 .. 1.5        Zisis (4.2)
 *   number    h_i = eta n_i^(-1/d), n_i = sum_j W(r_ij, h_i)            Zisis (4.1)
 *
 * The mass law is explicit where rho is evolved, and its change the factor omega of smoothing.h.
 * The last one, and the mass law where rho is itself a sum with h_i, are equations for h_i: see
 * sph_adapt_smoothing(). The two are the same where rho_i = m_i n_i (number smoothing).
 *
 * Pairs. With unequal h a pair needs one value that is the same from both sides, or forces are not
 * opposite: SPH_H_* of neighbors.h, He (6.4) to (6.9). He calls the harmonic mean geometric. */
#ifndef SPH_ADAPT_H
#define SPH_ADAPT_H

#include <sph/base.h>
#include <sph/neighbors.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The arrays below have n doubles each and are the host's; outputs may be the input of the same
 * index (h may be h0) and are untouched after a failure. O(n), on the context's threads, with the
 * same bits for any number of them. All answer
 *   SPH_ERR_ARG      n < 0, dim outside 1..3, an array NULL while n > 0;
 *   SPH_ERR_NUMERIC  an input that must be positive and finite is not: the sentence names the
 *                    lowest such index and its values. */

/* Density law: h from its reference h0 at the density rho0, which all must be positive.
 * Since 0.1. */
SPH_API sph_status sph_h_from_density(sph_context *ctx, int32_t dim, int64_t n, const double *h0,
                                      const double *rho0, const double *rho, double *h);

/* Rate law: dh from h and rho, positive, and drho = d rho/dt, finite. Integrated beside rho it
 * gives the density law, up to the error of the integrator. Since 0.1. */
SPH_API sph_status sph_h_rate(sph_context *ctx, int32_t dim, int64_t n, const double *h,
                              const double *rho, const double *drho, double *dh);

/* Spacing law: h = ratio * spacing, both positive. SPH_ERR_ARG also: ratio not positive and finite.
 * Since 0.1. */
SPH_API sph_status sph_h_from_spacing(sph_context *ctx, int64_t n, double ratio,
                                      const double *spacing, double *h);

/* Mass law: h = eta (m / rho)^(1/d), m and rho positive; h may be either. SPH_ERR_ARG also: eta not
 * positive and finite. Since 0.1. */
SPH_API sph_status sph_h_from_mass(sph_context *ctx, int32_t dim, int64_t n, double eta,
                                   const double *m, const double *rho, double *h);

/* ---- lengths that fit the density --------------------------------------------------------- */

typedef struct sph_adapt_options {
  size_t size;             /* set by sph_adapt_options_init() */
  int32_t smoothing;       /* what n_i is: SPH_SMOOTHING_NUMBER (default), sum_j W(r_ij, h_i), or
                            * _MASS, sum_j (m_j / m_i) W(r_ij, h_i); i included. See smoothing.h */
  double eta;              /* > 0; default 1.2 */
  double tolerance;        /* of n h^d / eta^d - 1, > 0; default 1e-10 */
  int32_t max_evaluations; /* of the sum, for one particle, >= 1; default 200 */
  int32_t keep;            /* a particle for which there is no h: 0 (default) an error that names
                            * it, nonzero it keeps the one it has and is counted */
  double h_min, h_max;     /* bounds of h, lengths >= 0; 0 (default): none. Where the root lies
                            * beyond, h is the bound, and is counted */
  int32_t density;         /* nonzero (default): write RHO = m n, too */
} sph_adapt_options;
/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_adapt_options_init_sized(sph_adapt_options *options, size_t size);
#define sph_adapt_options_init(o) sph_adapt_options_init_sized((o), sizeof(sph_adapt_options))

typedef struct sph_adapt_result {
  size_t size;
  int64_t evaluations;      /* of sums of one particle, in all */
  int32_t most_evaluations; /* for one particle */
  int32_t builds;           /* of the list, the last one with the new h included */
  int64_t kept;             /* particles that kept their h for want of a better one */
  int64_t first_kept;       /* the lowest of them; -1: none */
  int64_t bounded;          /* particles at h_min or h_max */
  int64_t jumps;            /* particles whose sum jumps across eta^d, see below */
} sph_adapt_result;
/* Fill *result with zeros (first_kept -1). Since 0.1. */
SPH_API void sph_adapt_result_init_sized(sph_adapt_result *result, size_t size);
#define sph_adapt_result_init(r) sph_adapt_result_init_sized((r), sizeof(sph_adapt_result))

/* Solve n_i h_i^d = eta^d for h_i of every real particle of `set`, positions and masses given:
 * Zisis (4.3) and (4.8), where the exponent is printed as 1/3. With S(h) = h^d n(h), which rises
 * with h, the root of S(h) = eta^d is found by Newton's rule in h^d, within a bracket that is
 * halved where Newton does not gain; the source names no solver, and plain Newton diverges from far
 * away. From the h of a neighbouring time it takes 2 to 4 sums, from a hundredth or a hundredfold
 * of it about 10.
 *
 * Reads X, M, H (where to start), writes H and, as `density` says, RHO = m n of the real particles,
 * and touches them. Ghosts and held particles take part in the sums; their own h is left: refresh
 * ghosts afterwards, and where theirs reach less far than the new h, repeat. The list serves the
 * search (method, periodic axes, support, limits) and is built for the new lengths at the end; in
 * between it is built for 1.1 h, and again for those particles whose h outgrows it. Its rule must
 * be MAX or AVERAGE. Where h differs widely, use the method TREE.
 *
 * There is one root unless
 *   - particles at one place add up to S(0) >= eta^d already (which one alone must not do);
 *   - all particles together are too few: S(infinity) <= eta^d (cubic spline: fewer
 *     than 2, 4, 6 in 1-D, 2-D, 3-D);
 *   - it exceeds what fits twice into a periodic box;
 *   - the kernel rises somewhere (super-Gaussian, new quartic): then one of several is found;
 *   - the kernel is cut (Gaussian): S jumps when a neighbour enters, and about 1 particle in 1000
 *     finds eta^d within such a jump. It gets the h of the jump, n h^d is off by up to its size
 *     (3e-5 relative, 2-D; on lattices times the neighbours at one distance), and it is counted.
 *
 * options NULL: defaults. result may be NULL, else initialised. SPH_ERR_ARG: options out of range,
 * VOLUME smoothing, which has no sum, eta^d not above h^d W(0), dimensions that differ, a list that
 * reaches less far than the kernel or of another rule, a field missing. SPH_ERR_NUMERIC: h or m of
 * a particle not positive and finite; no h for a particle (the lowest is named, with the reason),
 * unless `keep`. SPH_ERR_LIMIT, SPH_ERR_NOMEM, SPH_ERR_CALLBACK from the list; SPH_ERR_VERSION.
 * The set and *result are as before then, but the list may be built for other lengths: build it.
 *
 * O(pairs) for each sum of all particles; 80 bytes a particle, given back. On the context's
 * threads, same bits for any number of them. Since 0.1. */
SPH_API sph_status sph_adapt_smoothing(sph_neighbors *list, const sph_kernel *kernel,
                                       sph_particles *set, const sph_adapt_options *options,
                                       sph_adapt_result *result);

/* ---- pairs -------------------------------------------------------------------------------- */

/* h of a pair by a rule SPH_H_*; the same bits when i and j change places. AVERAGE has no one h:
 * the larger one, which its cutoff is made of. NaN for an unknown rule, or when one of the two is
 * not positive and finite. Since 0.1. */
SPH_API double sph_pair_h(int32_t rule, double h_i, double h_j);

/* W_ij at the distance r: W(r, h_ij), He (6.8), or for AVERAGE [W(r, h_i) + W(r, h_j)] / 2, He
 * (6.9). NaN as above, and for what sph_kernel_w() calls so. Since 0.1. */
SPH_API double sph_pair_w(const sph_kernel *kernel, int32_t rule, double r, double h_i, double h_j);

/* dW_ij/dr, likewise. Since 0.1. */
SPH_API double sph_pair_dwdr(const sph_kernel *kernel, int32_t rule, double r, double h_i,
                             double h_j);

#ifdef __cplusplus
}
#endif
#endif
