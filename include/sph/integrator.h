/* Time integrators over any bound fields and any right-hand side.
 *
 * Bind the fields to advance (of a particle set, or plain arrays), give a right-hand side, step.
 * A step that fails leaves the fields as they were. */
#ifndef SPH_INTEGRATOR_H
#define SPH_INTEGRATOR_H

#include <sph/rhs.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
  SPH_INTEGRATOR_EULER = 1,    /* forward Euler, order 1 (He 4.2) */
  SPH_INTEGRATOR_PC2 = 2,      /* predictor-corrector = explicit midpoint, order 2 (He 4.5) */
  SPH_INTEGRATOR_HEUN = 3,     /* explicit trapezoid = SSPRK(2,2), order 2 (He 4.12) */
  SPH_INTEGRATOR_SSPRK3 = 4,   /* SSPRK(3,3), order 3 */
  SPH_INTEGRATOR_RK4 = 5,      /* classical, order 4 (He 4.13; not SSP, whatever He 4.3.1 says) */
  SPH_INTEGRATOR_RK38 = 6,     /* 3/8 rule, order 4 (He table 4.2) */
  SPH_INTEGRATOR_BUTCHER = 7,  /* any explicit tableau of the host */
  SPH_INTEGRATOR_LEAPFROG = 8, /* kick-drift-kick, order 2; needs a V and an X field bound */
  SPH_INTEGRATOR_RKC = 9       /* Runge-Kutta-Chebyshev, order 2, s >= 2 stages */
};

/* RKC helps where the spectrum lies along the negative real axis: viscous or diffusive terms, for
 * which the stable step grows as s^2 while the cost grows as s. It does NOT help pure waves: on the imaginary axis |P_s(iy)| = 1 + k y^4 > 1
 * for every s, so an inviscid wave grows a little each step (per step at CFL 0.6: 1.0019, at CFL 2.5: 1.357, cubic spline, h = 1.5 dp); use RK4 there, or CFL <= 0.5. The claim of
 * He & Seaid that RKC is stable independently of CFL is false: with their viscosity alpha = 2.5 the limit is
 * CFL 6.1, and at CFL 2.5 alpha must lie within 0.35 .. 3.77. */

/* Choice of b_1 in RKC; both have the same stability polynomial. */
enum { SPH_RKC_B1_INVERSE_W0 = 1 /* He 2015: 1 / w0 */, SPH_RKC_B1_EQUAL_B2 = 2 /* He & Seaid 2016: b_2 */ };

/* How RKC chooses its stages. */
enum {
  SPH_STAGES_FIXED = 1,    /* `stages` */
  SPH_STAGES_CFL = 2,      /* s = 1 + floor(sqrt(1 + dt wave_speed / (0.131 spacing))), He 4.18 */
  SPH_STAGES_RADIUS = 3,   /* s = 1 + floor(sqrt(1 + dt rho / 0.653)), rho from the host's callback; He & Seaid 26, with the dt they miss */
  SPH_STAGES_POWER = 4     /* the same, rho by power iteration on the right-hand side, times power_safety */
};

/* d y/dt at time t. The bound fields of `set` (or the bound arrays) hold the stage's values; rates[k] receives the rate of the k-th bound item, in
 * the order of binding. 0: fine; positive: the step is abandoned with SPH_RETRY; negative: SPH_ERR_CALLBACK (or, for a
 * status of the library, that status). */
typedef int32_t (*sph_rhs_fn)(void *user, double t, sph_particles *set, const sph_rate *rates,
                              int32_t count);

/* Spectral radius of the Jacobian at (t, set), >= 0; negative or not finite: SPH_ERR_CALLBACK. */
typedef double (*sph_radius_fn)(void *user, double t, sph_particles *set);

typedef struct sph_integrator_options {
  size_t size;           /* set by sph_integrator_options_init() */
  int32_t method;        /* SPH_INTEGRATOR_*; default RK4 */
  int32_t butcher_stages;    /* BUTCHER: 1..32 */
  const double *butcher_a;   /* stages * stages row-major, strictly lower triangular; copied */
  const double *butcher_b;   /* stages, sum 1; copied */
  const double *butcher_b_low; /* NULL, or the embedded weights: gives an error estimate */
  int32_t rkc_b1;        /* SPH_RKC_B1_*; default INVERSE_W0 */
  int32_t stage_rule;    /* SPH_STAGES_*; default POWER */
  int32_t stages;        /* FIXED: 2..max_stages */
  int32_t max_stages;    /* bound, 2..1000; default 100; above it the step answers SPH_RETRY */
  double wave_speed;     /* CFL */
  double spacing;        /* CFL: the smallest particle spacing */
  sph_radius_fn radius;  /* RADIUS */
  void *radius_user;
  double power_safety;   /* POWER: factor >= 1; default 1.1 */
  int32_t power_iterations; /* POWER: at most, 1..1000; default 50 */
  int32_t power_interval; /* POWER: re-estimate after this many steps; default 25 */
  double rtol, atol;     /* of the error estimate; defaults 1e-3, 1e-6 */
  int32_t check_finite;  /* nonzero: a step whose result is not finite fails (SPH_ERR_NUMERIC); default 1 */
} sph_integrator_options;
SPH_API void sph_integrator_options_init_sized(sph_integrator_options *options, size_t size);
#define sph_integrator_options_init(o)                                                       \
  sph_integrator_options_init_sized((o), sizeof(sph_integrator_options))

/* Create. SPH_ERR_ARG: unknown method, a tableau that is not explicit or whose b does not sum to
 * 1 (1e-12), options out of range (the sentence names them). Since 0.1. */
SPH_API sph_status sph_integrator_create(sph_context *ctx, const sph_integrator_options *options,
                                         sph_integrator **out);
/* Destroy. NULL is allowed. Since 0.1. */
SPH_API void sph_integrator_destroy(sph_integrator *it);

/* Bind a field of the set that later steps are given; its real particles are advanced. SPH_ERR_ARG: bound twice; SPH_ERR_LIMIT: more
 * than 32 items. Since 0.1. */
SPH_API sph_status sph_integrator_bind_field(sph_integrator *it, int32_t field);
/* Bind a plain array of n doubles, the host's; its entry in the rates has field -1 - k for the k-th item bound.
 * Leapfrog does not take arrays. Since 0.1. */
SPH_API sph_status sph_integrator_bind_array(sph_integrator *it, double *values, int64_t n);

/* The right-hand side: a callback, or a composed one with its list (set and list stay the host's and must outlive the integrator's use). Since 0.1. */
SPH_API sph_status sph_integrator_set_function(sph_integrator *it, sph_rhs_fn fn, void *user);
SPH_API sph_status sph_integrator_set_rhs(sph_integrator *it, sph_rhs *rhs, sph_neighbors *list);

typedef struct sph_step_info {
  size_t size;
  int32_t stages;       /* right-hand sides of the step proper */
  int64_t evaluations;  /* with those of the power iteration */
  double error;         /* max over fields of |error| / (atol + rtol |y|); NaN when the method has no estimate */
  double radius;        /* spectral radius used by RKC; NaN otherwise */
  double suggested_dt;  /* from the error estimate; NaN without one */
} sph_step_info;
SPH_API void sph_step_info_init_sized(sph_step_info *info, size_t size);
#define sph_step_info_init(i) sph_step_info_init_sized((i), sizeof(sph_step_info))

/* Advance from t to t + dt. set may be NULL when only arrays are bound and the right-hand side is a
 * callback. dt finite and not 0; negative dt is allowed for all but RKC. info may be NULL.
 *
 * SPH_RETRY: the right-hand side asked for a smaller step, or RKC would need more than max_stages.
 * SPH_ERR_STATE: nothing bound or no right-hand side; the set's particles changed during the step. SPH_ERR_NUMERIC: the result is not finite
 * (first field and particle are named). SPH_ERR_CALLBACK, and what the right-hand side answers. In every such case the bound fields are
 * as before the call, to the bit. Storage: two to six copies of the bound fields, kept. A steady step allocates nothing.
 * RKC: Verwer, Sommeijer, Shampine; He 2015 (4.17), with the minus sign in gamma~ that He & Seaid miss. Since 0.1. */
SPH_API sph_status sph_integrator_step(sph_integrator *it, sph_particles *set, double t, double dt,
                                       sph_step_info *info);

/* Save the bound fields in memory, and put them back, for hosts that repeat steps. One slot.
 * SPH_ERR_STATE: nothing saved, or sizes changed since. Since 0.1. */
SPH_API sph_status sph_integrator_save(sph_integrator *it, sph_particles *set);
SPH_API sph_status sph_integrator_restore(sph_integrator *it, sph_particles *set);

/* ---- Pure functions ---------------------------------------------------------------------- */

/* Coefficients of RKC with s stages (2..1000). Arrays have s + 1 entries, index = stage, unused entries 0; any may be
 * NULL. b1: SPH_RKC_B1_*. SPH_ERR_ARG otherwise. Since 0.1. */
SPH_API sph_status sph_rkc_coefficients(int32_t s, int32_t b1, double *mu, double *nu,
                                        double *mu_t, double *gamma_t, double *c);

/* Real stability interval beta(s) = (w0 + 1) / w1, about 0.653 (s^2 - 1). NaN for s < 2. Since 0.1. */
SPH_API double sph_rkc_beta(int32_t s);

/* |P_s(z)| of the stability polynomial at z = re + i im. NaN for s < 2. Since 0.1. */
SPH_API double sph_rkc_amplification(int32_t s, double re, double im);

/* Stages by the published formulas; -1 for arguments that are not finite and >= 0 (spacing > 0), or when the count exceeds 2^31 - 1. Since 0.1. */
SPH_API int32_t sph_rkc_stages_cfl(double dt, double wave_speed, double spacing);
SPH_API int32_t sph_rkc_stages_radius(double dt, double radius);

/* Largest stable step: cfl * min over the real particles of h_i / (c_i + |v_i|). Fields H, C, V as far as they exist;
 * SPH_ERR_ARG without H or with cfl not positive; SPH_ERR_NUMERIC: no particle gives a finite step (all speeds 0). Since 0.1. */
SPH_API sph_status sph_cfl_step(const sph_particles *set, double cfl, double *dt);

#ifdef __cplusplus
}
#endif
#endif
