/* References: exact solutions to measure a code against, and the distance between two sets of
 * particles.
 *
 *   Riemann problems   two materials of one or of different laws, sph_riemann_solve()
 *   Noh, Sedov         implosion and blast, planar, cylindrical and spherical
 *   Gresho             a standing vortex
 *   Wasserstein        W1 between two clouds of masses, in 1-D, 2-D and 3-D
 *
 * Nothing is kept between calls; arrays are the host's and may not overlap. A context is asked for
 * memory (where a function says so), and for the sentence of a failure.
 *
 * "Zisis" = I. Zisis, PhD thesis, Eindhoven 2017; "Toro" = E. Toro, Riemann Solvers and Numerical
 * Methods for Fluid Dynamics, 3rd ed. 2009. */
#ifndef SPH_REFERENCE_H
#define SPH_REFERENCE_H

#include <sph/base.h>
#include <sph/eos.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Riemann problems -------------------------------------------------------------------- */

/* Laws, with the constants of sph_riemann_side that they read:
 *
 *   GAS              gamma > 1, reference_pressure >= 0: ideal and stiffened gas, Zisis (5.3)
 *   BAROTROPIC       density, sound_speed > 0, gamma >= 1, background: p = background + B
 *                    ((rho/rho0)^gamma - 1), B = rho0 c0^2/gamma; gamma = 1 is the linear law
 *                    (5.1). p of the state is not read, it follows from rho. The energy is that
 *                    of compression from rho0, the integral of p/rho^2, also behind shocks
 *   MIE_GRUNEISEN    density, sound_speed > 0, slope >= 0, gruneisen > 0, curve: the law of
 *                    sph_material_create_mie_gruneisen() without cut-off and floor; curve
 *                    SPH_COLD_CUBIC is the "isentropic" law (5.4)
 *   VOID             nothing there: the other side has a free surface, or a piston, under the
 *                    pressure p. rho and v are not read */
enum {
  SPH_RIEMANN_GAS = 1,
  SPH_RIEMANN_BAROTROPIC = 2,
  SPH_RIEMANN_MIE_GRUNEISEN = 3,
  SPH_RIEMANN_VOID = 4
};

/* One side: its state and its law. */
typedef struct sph_riemann_side {
  size_t size;               /* set by sph_riemann_side_init() */
  int32_t law;               /* SPH_RIEMANN_*; default GAS */
  double rho, v, p;          /* density > 0, velocity, pressure; rho must be given, the rest 0 */
  double gamma;              /* default 1.4 */
  double reference_pressure; /* P_ref; default 0 */
  double density;            /* rho0 */
  double sound_speed;        /* c0 */
  double background;         /* default 0 */
  double slope;              /* S; default 0 */
  double gruneisen;          /* Gamma, for SPH_COLD_CUBIC B0 */
  int32_t curve;             /* SPH_HUGONIOT_CUBIC (default), SPH_HUGONIOT, SPH_COLD_CUBIC */
} sph_riemann_side;

/* Fill *side with the defaults. Since 0.1. */
SPH_API void sph_riemann_side_init_sized(sph_riemann_side *side, size_t size);
#define sph_riemann_side_init(s) sph_riemann_side_init_sized((s), sizeof(sph_riemann_side))

/* The wave of one side. NONE: the material is undisturbed, or there is no material. */
enum { SPH_WAVE_NONE = 0, SPH_WAVE_SHOCK = 1, SPH_WAVE_FAN = 2 };

/* The solution; in arrays [0] is left, [1] right. Speeds are those of x/t. */
typedef struct sph_riemann_solution {
  size_t size;     /* set by sph_riemann_solution_init() */
  double p;        /* pressure between the waves; of the void when there is one */
  double v[2];     /* velocity there; the two are the same unless a void opened */
  double rho[2];   /* density on either side of the contact, */
  double e[2];     /* specific internal energy, */
  double c[2];     /* and speed of sound; all 0 on the side of a void */
  double head[2];  /* speed of the front that meets the undisturbed material */
  double tail[2];  /* of the other end of a fan; for a shock the same as head */
  int32_t wave[2]; /* SPH_WAVE_* */
  int32_t gap;     /* 1: a void lies between v[0] and v[1] */
} sph_riemann_solution;

/* Clear *solution and set its size. Since 0.1. */
SPH_API void sph_riemann_solution_init_sized(sph_riemann_solution *solution, size_t size);
#define sph_riemann_solution_init(s) \
  sph_riemann_solution_init_sized((s), sizeof(sph_riemann_solution))

/* The two waves and the state between them of the Riemann problem at x = 0, t = 0.
 *
 * The pressure is the root of f_L(p) + f_R(p) + v_R - v_L = 0, f the change of velocity in a wave
 * that leads to p: a shock upwards, an isentrope downwards (Toro 4.2 and 4.3; the laws of Zisis in
 * each side's own constants). The root is bracketed and found to rounding: relative 1e-14 of
 * rho c^2. Zisis (1.22) to (1.27) takes the jump relations for expansions as well; this does not.
 *
 * A void opens when even the lowest pressure that both materials can take does not keep them
 * together: -P_ref for a gas, background - B for a barotropic law of gamma > 1 (a linear one thins
 * out without end), and for Mie-Grueneisen the tension where the speed of sound becomes 0 along the
 * isentrope or, as with SPH_HUGONIOT and _CUBIC it may never, where the density has fallen to a
 * tenth (of rho0 or rho, the smaller). The larger of the two is the pressure of the void and p
 * of the solution; a material that could bear less ends there with a free surface. With P_ref = 0
 * this is Toro 4.6.
 *
 * Laws are taken as convex: compressions are shocks, expansions are fans. (In strong tension
 * Mie-Grueneisen may not be; an expansion there is refused.) Closed forms for GAS
 * and BAROTROPIC, about 20 evaluations; for MIE_GRUNEISEN isentropes are integrated by
 * extrapolation to 1e-14, a few milliseconds. ctx takes the sentence of a failure. *solution must
 * be initialised; nothing in it changes on failure.
 *
 * SPH_ERR_ARG: ctx, a side or solution NULL, an unknown law or curve, a constant or a state out of
 * range or not finite (a density that is not positive; p < -P_ref), two voids.
 * SPH_ERR_NUMERIC: a state of Mie-Grueneisen where c^2 <= 0 or that lies beyond the curve; a
 * compression that the law cannot reach: rho >= rho_1 (1 + 2/Gamma) unless from rest at rho0, where
 * the Hugoniot is the curve itself, for COLD_CUBIC 1/rho <= 1/rho_1 - 2/(Gamma rho0), with
 * SPH_HUGONIOT also 1 - rho0/rho >= 1/S; a pressure that overflows. SPH_ERR_UNSUPPORTED: an
 * expansion of Mie-Grueneisen along which the law is not convex. SPH_ERR_VERSION. Since 0.1. */
SPH_API sph_status sph_riemann_solve(sph_context *ctx, const sph_riemann_side *left,
                                     const sph_riemann_side *right, sph_riemann_solution *solution);

/* The state along the rays x/t = speed[k], from a solution of sph_riemann_solve() for the same
 * sides. speed: n, in any order, finite. rho, v, p, e: n each; any may be NULL. At a jump the state
 * on the right of it is taken. In a void rho = e = 0 and v = x/t (NaN beyond a side that is void
 * from the start, where nothing moves). O(n); Mie-Grueneisen integrates anew for each point of a
 * fan.
 * SPH_ERR_ARG: what sph_riemann_solve() says of the sides, n < 0, speed NULL with n > 0 or not
 * finite (named). SPH_ERR_NUMERIC, SPH_ERR_VERSION as there. Since 0.1. */
SPH_API sph_status sph_riemann_sample(sph_context *ctx, const sph_riemann_side *left,
                                      const sph_riemann_side *right,
                                      const sph_riemann_solution *solution, int64_t n,
                                      const double *speed, double *rho, double *v, double *p,
                                      double *e);

/* ---- implosion and blast ----------------------------------------------------------------- */

typedef struct sph_noh_options {
  size_t size;    /* set by sph_noh_options_init() */
  int32_t dim;    /* 1 planar, 2 cylindrical, 3 spherical; must be given */
  double gamma;   /* > 1; default 5/3 */
  double density; /* rho_0 > 0 at t = 0; default 1 */
  double speed;   /* u_0 > 0, towards the centre; default 1 */
} sph_noh_options;
/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_noh_options_init_sized(sph_noh_options *options, size_t size);
#define sph_noh_options_init(o) sph_noh_options_init_sized((o), sizeof(sph_noh_options))

/* Cold ideal gas that falls on a plane, an axis or a point: the shock stands at r = D t,
 *
 *   D = (gamma - 1) u_0/2
 *   inside   rho = rho_0 ((gamma + 1)/(gamma - 1))^dim, v = 0, e = u_0^2/2
 *   outside  rho = rho_0 (1 + u_0 t/r)^(dim - 1), v = -u_0, e = 0
 *
 * W. Noh, J. Comput. Phys. 72 (1987) 78-120. r: n distances from the centre, >= 0; v is along r
 * (0 at r = 0); p = (gamma - 1) rho e. rho, v, p, e: n each; any may be NULL.
 * SPH_ERR_ARG: options out of range, t < 0 or not finite, n < 0, r NULL with n > 0, negative or not
 * finite (named). SPH_ERR_VERSION. Since 0.1. */
SPH_API sph_status sph_noh_solution(sph_context *ctx, const sph_noh_options *options, double t,
                                    int64_t n, const double *r, double *rho, double *v, double *p,
                                    double *e);

typedef struct sph_sedov_options {
  size_t size;    /* set by sph_sedov_options_init() */
  int32_t dim;    /* 1 planar, 2 cylindrical, 3 spherical; must be given */
  double gamma;   /* > 1, not 2; in 3-D below 7; default 1.4 */
  double density; /* rho_0 > 0; default 1 */
  double energy;  /* E > 0: of both sides of the plane, per area; per length of the axis; of the
                   * whole sphere; default 1 */
} sph_sedov_options;
/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_sedov_options_init_sized(sph_sedov_options *options, size_t size);
#define sph_sedov_options_init(o) sph_sedov_options_init_sized((o), sizeof(sph_sedov_options))

/* A point blast in a cold ideal gas at rest: shock at R = (E t^2/(alpha rho_0))^(1/(dim + 2)). The
 * profile is the closed form of L. Sedov, Similarity and Dimensional Methods in Mechanics, 1959,
 * in the notation of J. Kamm, F. Timmes, LA-UR-07-2849; its parameter is found by bracketed
 * Newton-like steps, and alpha, the energy of the profile, by double exponential quadrature, both
 * to 1e-13. *radius is R and may be NULL; the rest as for sph_noh_solution(). At r = 0 rho = 0 and
 * e is infinite, p is not.
 * SPH_ERR_UNSUPPORTED: |gamma - 2| < 1e-6, where the closed form is singular, or gamma >= 7 in 3-D,
 * where a hollow forms. SPH_ERR_ARG: as there; t must be positive. SPH_ERR_VERSION. Since 0.1. */
SPH_API sph_status sph_sedov_solution(sph_context *ctx, const sph_sedov_options *options, double t,
                                      int64_t n, const double *r, double *radius, double *rho,
                                      double *v, double *p, double *e);

typedef struct sph_gresho_options {
  size_t size;     /* set by sph_gresho_options_init() */
  double density;  /* > 0; default 1 */
  double speed;    /* u, the largest; > 0; default 1 */
  double radius;   /* a > 0, where the speed is largest; default 0.2 */
  double pressure; /* at the centre, >= 0; default 5 */
} sph_gresho_options;
/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_gresho_options_init_sized(sph_gresho_options *options, size_t size);
#define sph_gresho_options_init(o) sph_gresho_options_init_sized((o), sizeof(sph_gresho_options))

/* A vortex that stands still, 2-D: the pressure balances the centrifugal force, dp/dr = rho v^2/r.
 * With s = r/a
 *
 *   v/u = s up to 1, 2 - s up to 2, 0 beyond
 *   (p - p_0)/(rho u^2) = s^2/2; s^2/2 - 4 s + 4 ln s + 4; 4 ln 2 - 2
 *
 * P. Gresho, S. Chan, Int. J. Numer. Meth. Fluids 11 (1990) 621-659. r: n distances >= 0; v is
 * along the angle. v, p: n each; either may be NULL. Errors as for sph_noh_solution().
 * Since 0.1. */
SPH_API sph_status sph_gresho_solution(sph_context *ctx, const sph_gresho_options *options,
                                       int64_t n, const double *r, double *v, double *p);

/* ---- distance between measures ----------------------------------------------------------- */

/* The Wasserstein distance W1 = min sum pi_ij |x_i - y_j| of two sets of masses, both divided by
 * their total: the least mean path that carries one into the other, a length. Zisis (4.37) to
 * (4.39). x: nx * dim positions with masses mx (nx), or NULL: all equal; y, my likewise. Masses are
 * >= 0; the two totals agree to 1e-10 relative (when either is NULL there is nothing to compare).
 *
 * 1-D: the integral of |F_x - F_y|, F the share of mass up to a point; exact, O(n log n), n = nx +
 * ny. 2-D, 3-D: the transport problem by a primal network simplex on a strongly feasible tree,
 * which cannot cycle (W. Cunningham, Math. Program. 11 (1976) 105-116), begun along a space-filling
 * curve; all nx * ny arcs are priced, but none is stored. Exact: no entropy, no neglected arcs. The
 * cost grows as n^2 to n^2.5: 448 to 812 points of a lattice take about 0.02 s, 3228 to 7232 about
 * 4 s. The progress hook is called, with an estimate, and may stop it. Masses are counted in whole
 * units, exactly where all masses of either set are the same and else in 2^-50 of the total: error
 * of W1 about 1e-13 of the largest distance. About 100 bytes a point, given back. Same bits for any
 * number of threads: it runs on the calling one.
 *
 * SPH_ERR_ARG: dim outside 1..3, nx or ny < 1, x, y or distance NULL, a position or mass not finite
 * or a mass negative (named), a total that is 0, totals that differ. SPH_ERR_LIMIT: nx or ny above
 * 2^30 - 1. SPH_ERR_NOMEM, SPH_ERR_CALLBACK. Since 0.1. */
SPH_API sph_status sph_wasserstein_distance(sph_context *ctx, int32_t dim, int64_t nx,
                                            const double *x, const double *mx, int64_t ny,
                                            const double *y, const double *my, double *distance);

#ifdef __cplusplus
}
#endif
#endif
