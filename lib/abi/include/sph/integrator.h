/* Time integrators over any bound fields and any right-hand side: d U / dt = F(t, U).
 *
 * Bind the fields to advance (of a particle set, or plain arrays), give a right-hand side, step.
 * A step that fails leaves the fields as they were, to the bit.
 *
 *   sph_integrator_options_init(&o);  o.method = SPH_INTEGRATOR_RK4;
 *   sph_integrator_create(ctx, &o, &it);
 *   sph_integrator_bind_field(it, SPH_FIELD_V);  sph_integrator_bind_field(it, SPH_FIELD_SIGMA);
 *   sph_integrator_set_rhs(it, rhs, list);                  or sph_integrator_set_function()
 *   sph_integrator_step(it, set, t, dt, NULL);
 *
 * "He" = L. He, PhD thesis, Durham 2015; "He & Seaid" = Acta Mech. 227 (2016). Their errata stand
 * beside the formulas.
 *
 * Cost and limits. Evaluations = calls of the right-hand side in a step. Real and imaginary:
 * largest |dt lambda| on the negative real and on the imaginary axis. The CFL numbers c dt / dp
 * hold for a 1-D elastic bar (linear analysis; cubic spline, h = 1.5 dp), where without viscosity
 * the eigenvalues are +-i c kappa with max kappa dp = 0.697 (0.862 for h = 1.2 dp, 1.0 for h = dp),
 * and where a Monaghan viscosity alpha adds real ones down to -1.76 alpha c / dp (2-D: -1.28 alpha
 * c / dp).
 *
 *   method     order  evaluations   real    imaginary   CFL, alpha = 0   CFL, alpha = 2.5
 *   Euler        1        1         2       0           none             0.45
 *   PC2, Heun    2        2         2       0 (weak)    none (weak)      0.45
 *   SSPRK3       3        3         2.51    1.73        2.48             0.57
 *   RK4, 3/8     4        4         2.785   2.828       4.06             0.63
 *   leapfrog     2        2 or 3    2, 3.09 2           2.87             -
 *   predicted    2        1         1       0 (weak)    none (weak)      -
 *   RKC          2        s         0.653 (s^2 - 1)   0 (weak)   see below   6.1
 *
 * "Predicted" is the leapfrog with predicted values; where the force depends on X alone its
 * imaginary limit is 2. The published viscosity acts on approaching pairs only, which hides the
 * limits: the runs of He (250 particles) blow up at CFL 1.0 (Euler), 0.9 (PC2), 1.4 (RK4), after
 * growing oscillation from 0.7 on. "Weak": |P(i y)| = 1 + k y^4 (PC2, Heun: k = 1/8; predicted:
 * 1/4). */
#ifndef SPH_INTEGRATOR_H
#define SPH_INTEGRATOR_H

#include <sph/operators.h>
#include <sph/rhs.h>

#ifdef __cplusplus
extern "C" {
#endif

/* With k_l = F(t + c_l dt, U + dt sum_{m < l} a_lm k_m), c_l = sum_m a_lm, U+ = U + dt sum b_l k_l
 * (He 4.15 and 4.16; the thesis prints dt twice). "Embedded" methods give an error estimate free
 * of charge. */
enum {
  SPH_INTEGRATOR_EULER = 1,    /* U+ = U + dt F(t, U); order 1 (He 4.2; 4.1 swaps the two times) */
  SPH_INTEGRATOR_PC2 = 2,      /* U_h = U + dt/2 F(U), U_c = U + dt/2 F(U_h), U+ = 2 U_c - U: the
                                * explicit midpoint rule, order 2 (He 4.5); embedded Euler. The
                                * XSPH smoothing of He 4.4 is a term of the right-hand side */
  SPH_INTEGRATOR_HEUN = 3,     /* U* = U + dt F(U), U+ = U + dt/2 (F(U) + F(U*)): explicit
                                * trapezoid = SSPRK(2,2), order 2 (He 4.12); embedded Euler */
  SPH_INTEGRATOR_SSPRK3 = 4,   /* U1 = U + dt F(U), U2 = 3/4 U + 1/4 (U1 + dt F(U1)), U+ = 1/3 U +
                                * 2/3 (U2 + dt F(U2)); order 3 (Shu & Osher); embedded Heun */
  SPH_INTEGRATOR_RK4 = 5,      /* classical, order 4 (He 4.13). He 4.3.1 calls it a convex
                                * combination of Euler steps and TVD: it is not, its SSP
                                * coefficient is 0 */
  SPH_INTEGRATOR_RK38 = 6,     /* 3/8 rule, order 4 (He table 4.2) */
  SPH_INTEGRATOR_BUTCHER = 7,  /* any explicit tableau of the host */
  SPH_INTEGRATOR_LEAPFROG = 8, /* kick-drift-kick, order 2; needs a V and an X field bound */
  SPH_INTEGRATOR_RKC = 9,      /* Runge-Kutta-Chebyshev, order 2, s >= 2 stages */
  SPH_INTEGRATOR_LEAPFROG_PREDICTED = 10 /* leapfrog with predicted values, order 2 */
};

/* Leapfrog. V is kicked, all other bound fields q (X, density, energy, stress) drift:
 *   v_h = v + dt/2 a(t, q, v);   q_h = q + dt/2 q'(t, q, v);   q+ = q + dt q'(t + dt/2, q_h, v_h);
 *   v+ = v_h + dt/2 a(t + dt, q+, v_p),   v_p = v + dt/2 (a + a_h).
 * Three evaluations; two when X and V alone are bound, for then q' = V is known and the middle one
 * is spared (XSPH, the rest of the rate of X, goes by the trapezoidal rule, and v_p = v + dt a).
 * With forces that do not depend on velocity it is symplectic and reversible. The last evaluation
 * is not carried over into the next step: nobody can promise that the host changes nothing between.
 * Stable for omega dt < 2. */

/* Leapfrog with predicted values: Zisis (I. Zisis, PhD thesis, TU Eindhoven 2017) 4.29 to 4.34.
 * With y = all that is bound but X, and f^k = F(t^k, x^k, y^k),
 *   y^(k+1/2) = y^(k-1/2) + f^k (dt^(k-1) + dt^k)/2,   at the start y^(1/2) = y^0 + f^0 dt^0/2;
 *   x^(k+1) = x^k + v^(k+1/2) dt^k;   y^(k+1) = y^(k+1/2) + f^k dt^k/2, the prediction.
 * (4.32 prints dt for the mean of the two steps, which holds for equal ones only.) What the rate of
 * X has beyond V (XSPH) is integrated like y. One evaluation a step, order 2 whatever the
 * sequence of steps. Where f depends on x alone this is the symplectic leapfrog, stable for omega
 * dt < 2. What depends on y goes by Adams and Bashforth's second formula: a damping lambda is
 * stable for lambda dt < 1, and a wave carried by y alone (density or stress against velocity, as
 * in all SPH of evolved density) grows by 1 + (omega dt)^4/4 a step, which a viscosity must make
 * up for.
 *
 * The half-step values live in the integrator, from step to step, by particle id: particles may be
 * added (they start like the first step), removed and sorted in between. What a host adds to y
 * between two steps goes to y^(k-1/2) as well. Values that jump, another set, or a time that does
 * not follow on: sph_integrator_restart(). A set of another address restarts by itself. Takes plain
 * arrays; V must be bound where X is. A step back over the last one, dt^k = -dt^(k-1), returns to
 * the state before it up to rounding where f depends on x alone. */

/* RKC (He 4.17; Verwer, Hundsdorfer, Sommeijer; rkc.f), F_k = F(t + c_k dt, Y_k):
 *
 *   Y_0 = U,  Y_1 = Y_0 + mu~_1 dt F_0,  U+ = Y_s, and for k = 2 .. s
 *   Y_k = mu_k Y_{k-1} + nu_k Y_{k-2} + (1 - mu_k - nu_k) Y_0
 *         + mu~_k dt F_{k-1} + gamma~_k dt F_0
 *
 *   w0 = 1 + eps / s^2,  eps = 2/13,  w1 = T_s'(w0) / T_s''(w0)
 *   b_k = T_k''(w0) / T_k'(w0)^2 for k >= 2,  b_0 = b_2,  b_1 by choice (below)
 *   mu~_1 = b_1 w1,  mu~_k = 2 w1 b_k / b_{k-1}
 *   mu_k = 2 w0 b_k / b_{k-1},  nu_k = -b_k / b_{k-2}
 *   gamma~_k = -(1 - b_{k-1} T_{k-1}(w0)) mu~_k
 *   c_1 = mu~_1,  c_k = w1 T_k''(w0) / T_k'(w0)
 *   P_s(z) = 1 - b_s T_s(w0) + b_s T_s(w0 + w1 z), the stability polynomial
 *
 * Errata: He & Seaid miss the minus in gamma~ (with a plus nothing converges for s >= 3), print
 * mu~ F and gamma~ F without dt, and start from a U~ that no longer exists. Both sources print
 * T_k(x) = cos(k arccos x), which does not exist at w0 > 1: the T_k and their derivatives come from
 * the recurrence T_k = 2 x T_{k-1} - T_{k-2}.
 *
 * Where RKC helps: where the spectrum lies along the negative real axis, that is where viscosity,
 * conduction or diffusion limits the step. The stable step grows as s^2, the cost as s: on the
 * negative real axis five stages go as far as RK4 goes with 4.5 times as many evaluations.
 *
 * Where it does not help: pure waves. On the imaginary axis |P_s(i y)| = 1 + k y^4 > 1 for every s
 * (k = .125, .062, .048, .043, .037, .035 for s = 2, 3, 4, 5, 10, 20), so that an inviscid wave
 * grows at every step: by 1.0019 at CFL 0.6, 1.0147 at 1.0, 1.024 at 1.2, 1.357 at 2.5 (cubic
 * spline, h = 1.5 dp). More stages or more damping lower k, never to 0. Use RK4 there, or
 * CFL <= 0.5.
 *
 * He & Seaid call RKC stable independently of CFL. It is not: with the published stage rule and a
 * viscosity alpha = .5, 1, 1.5, 2, 2.5 the limit is CFL 2.8, 3.9, 4.8, 5.4, 6.1, and at CFL 2.5
 * alpha must lie within 0.35 .. 3.77.
 *
 * The integrator looks at the dominant eigenvalue now and then (stability_check_interval), and
 * when a step amplifies that mode by more than 1.001 it says so through the log hook, level
 * WARNING, once in the life of a handle. It sees the mode of largest |lambda| only: a smaller one
 * that is amplified, which can happen a little inside the limits above, goes unnoticed. */

/* Choice of b_1 in RKC; both have the same stability polynomial. */
enum {
  SPH_RKC_B1_INVERSE_W0 = 1, /* He 2015: 1 / w0; c_1 = c_2, and s = 2 is Heun */
  SPH_RKC_B1_EQUAL_B2 = 2    /* He & Seaid 2016, rkc.f: b_2; c_1 = c_2 / T_2'(w0) */
};

/* How RKC chooses its stages. */
enum {
  SPH_STAGES_FIXED = 1,  /* `stages` */
  SPH_STAGES_CFL = 2,    /* s = 1 + floor(sqrt(1 + dt wave_speed / (0.131 spacing))), He 4.18. It
                          * assumes a spectral radius of 5 c / dp, which is the viscous one for
                          * alpha = 2.5, h = 1.5 dp (4.40 c / dp); not the wave's. Take another
                          * rule for other viscosities */
  SPH_STAGES_RADIUS = 3, /* s = 1 + floor(sqrt(1 + dt rho / 0.653)), rho from the host's
                          * callback; He & Seaid 26, with the dt they miss */
  SPH_STAGES_POWER = 4   /* the same, rho by power iteration on the right-hand side, times
                          * power_safety; up to eight stages more where those stop the growth of a
                          * damped wave. Viscosities that act on approaching pairs only show half of
                          * their radius at rest: give such a run a few small steps first.
                          * Only the largest mode counts: where wave and viscosity are of one size
                          * (alpha about 0.5 and below), take CFL, or RK4 */
};

/* d y/dt at time t. The bound fields of `set` (real particles) or the bound arrays hold the stage's
 * values; X, H and every other bound field are touched (sph_particles_touch()) when they were
 * written, so that neighbour lists notice. rates[k].values receives the rate of the k-th bound
 * item, in the order of binding; all of it must be written, it holds garbage before.
 *
 * Ghosts may be added and removed in here. The real particles must stay: another count or order
 * ends the step with SPH_ERR_STATE. Bound values should not be changed: to hold a value give it the
 * rate 0 (what is overwritten here lasts for this stage, and with RKC also takes part in the next).
 * Binding, stepping, saving and restoring the same integrator in here answer SPH_ERR_STATE; do not
 * destroy it, nor what the step uses.
 *
 * 0: fine; positive: the step is abandoned with SPH_RETRY; negative: SPH_ERR_CALLBACK (or, for a
 * status of the library, that status). */
typedef int32_t (*sph_rhs_fn)(void *user, double t, sph_particles *set, const sph_rate *rates,
                              int32_t count);

/* Spectral radius of the Jacobian at (t, set), >= 0; negative or not finite: SPH_ERR_CALLBACK. */
typedef double (*sph_radius_fn)(void *user, double t, sph_particles *set);

typedef struct sph_integrator_options {
  size_t size;                 /* set by sph_integrator_options_init() */
  int32_t method;              /* SPH_INTEGRATOR_*; default RK4 */
  int32_t butcher_stages;      /* BUTCHER: 1..32 */
  const double *butcher_a;     /* stages * stages row-major, strictly lower triangular; copied */
  const double *butcher_b;     /* stages, sum 1; copied */
  const double *butcher_b_low; /* NULL, or the embedded weights: gives an error estimate; copied */
  int32_t rkc_b1;              /* SPH_RKC_B1_*; default INVERSE_W0 */
  int32_t stage_rule;          /* SPH_STAGES_*; default POWER */
  int32_t stages;              /* FIXED: 2..max_stages; default 2 */
  int32_t max_stages;   /* bound, 2..1000; default 100; above it the step answers SPH_RETRY */
  double wave_speed;    /* CFL: >= 0 */
  double spacing;       /* CFL: the smallest particle spacing, > 0 */
  sph_radius_fn radius; /* RADIUS */
  void *radius_user;
  double power_safety; /* POWER: factor >= 1; default 1.1 */
  /* At most so many evaluations for one estimate, 1..1000; default 50. It ends when the radius
   * changes by less than 0.5 %, usually after 5 to 15; later estimates start from the last
   * direction and take 3 to 6. */
  int32_t power_iterations;
  int32_t power_interval; /* POWER: re-estimate after this many steps; default 25. At first after
                           * 1, 2, 4 .. steps, and in the step after one that ended in
                           * SPH_ERR_NUMERIC */
  double rtol, atol;      /* of the error estimate, >= 0, not both 0; defaults 1e-3, 1e-6 */
  int32_t check_finite;   /* nonzero: a step whose result is not finite fails (SPH_ERR_NUMERIC);
                             default 1 */
  /* Look at the dominant eigenvalue in the first step, 10 steps later, and again after each so
   * many, with at most 20 evaluations each time; 0: never; -1 (default): 100 for RKC, never for the
   * others. Leapfrog never looks; the rule POWER judges each of its steps by its own estimate, free
   * of charge. */
  int32_t stability_check_interval;
} sph_integrator_options;
/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_integrator_options_init_sized(sph_integrator_options *options, size_t size);
#define sph_integrator_options_init(o) \
  sph_integrator_options_init_sized((o), sizeof(sph_integrator_options))

/* Create. options NULL: RK4. The tableau is copied. *out is NULL on failure.
 * SPH_ERR_ARG: unknown method, a tableau that is not explicit or whose b does not sum to
 * 1 (1e-12), options out of range (the sentence names them; those of other methods are not looked
 * at). SPH_ERR_VERSION, SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_integrator_create(sph_context *ctx, const sph_integrator_options *options,
                                         sph_integrator **out);
/* Destroy. NULL is allowed. Since 0.1. */
SPH_API void sph_integrator_destroy(sph_integrator *it);

/* Bind a field of the set that later steps are given; its real particles are advanced. Whether the
 * set has it shows in the step; a built-in field that does not exist yet is then created.
 * SPH_ERR_ARG: bound twice, negative; SPH_ERR_LIMIT: more than 32 items; SPH_ERR_STATE: within a
 * step. Binding drops what was saved. Since 0.1. */
SPH_API sph_status sph_integrator_bind_field(sph_integrator *it, int32_t field);
/* Bind a plain array of n doubles (n >= 0), the host's, which must stay where it is; its entry in
 * the rates has field -1 - k for the k-th item bound (from 0). SPH_ERR_ARG: overlaps an array bound
 * before. SPH_ERR_UNSUPPORTED: leapfrog, which does not take arrays. SPH_ERR_LIMIT, SPH_ERR_STATE.
 * Since 0.1. */
SPH_API sph_status sph_integrator_bind_array(sph_integrator *it, double *values, int64_t n);

/* The right-hand side as a callback. The last one set, here or below, counts. Since 0.1. */
SPH_API sph_status sph_integrator_set_function(sph_integrator *it, sph_rhs_fn fn, void *user);
/* A composed right-hand side with its list; both stay the host's and must outlive the integrator's
 * use. It gives no rates for plain arrays: such a step answers SPH_ERR_STATE. Since 0.1. */
SPH_API sph_status sph_integrator_set_rhs(sph_integrator *it, sph_rhs *rhs, sph_neighbors *list);

/* Which copy of the state a filter is given. */
enum {
  SPH_COPY_STAGE = 1, /* in place, what the right-hand side sees next */
  SPH_COPY_HALF = 2,  /* y^(k+1/2) of LEAPFROG_PREDICTED, the integrator's own; X has no entry */
  SPH_COPY_RESULT = 3 /* in place, the end of the step */
};

/* Treat a copy of the bound values, in place: the return of stresses to a yield surface, a floor of
 * the energy. copy is SPH_COPY_*; values[k] belongs to the k-th bound item, over the real
 * particles; its array is the set's field itself but for HALF, where that of X is NULL. Answers and
 * prohibitions are those of sph_rhs_fn; ghosts must stay, too. */
typedef int32_t (*sph_filter_fn)(void *user, double t, sph_particles *set, int32_t copy,
                                 const sph_rate *values, int32_t count);

/* A filter for every copy of the state that later steps make: each stage and the result, and with
 * LEAPFROG_PREDICTED the half-step values, before X moves by them, and the result (Zisis's radial
 * return treats both). Tableaux and leapfrog combine rates, so that a filtered stage acts through
 * its rate alone; RKC's recurrence reads the filtered stages themselves. A state that the filter
 * leaves alone gives the same bits as without. fn NULL: none. fn and user must stay valid.
 * SPH_ERR_STATE: within a step. Since 0.1. */
SPH_API sph_status sph_integrator_set_filter(sph_integrator *it, sph_filter_fn fn, void *user);

/* Forget earlier steps: half-step values (the next step is a first one), the eigenvalue estimate of
 * RKC. Bound fields, right-hand side, filter and what was saved stay. SPH_ERR_STATE: within a step.
 * Since 0.1. */
SPH_API sph_status sph_integrator_restart(sph_integrator *it);

typedef struct sph_step_info {
  size_t size;
  int32_t stages;      /* right-hand sides of the step proper */
  int64_t evaluations; /* with those of the eigenvalue estimate and of the error estimate */
  double error;  /* max over the bound items of |error| / (atol + rtol |y|), maximum norms of each
                  * item, |y| the larger of before and after. NaN when the method has no
                  * estimate. A step is done whatever its error: to reject it, restore */
  double radius; /* spectral radius by which RKC chose its stages; NaN otherwise */
  double suggested_dt; /* dt * 0.8 error^(-1 / (q + 1)), within 0.1 .. 5 dt, q the lower of the two
                        * orders; NaN without an estimate */
  double eigen_re;     /* dominant eigenvalue as last estimated, 1 / time; NaN: never */
  double eigen_im;     /* >= 0, stands for the pair */
  double growth;       /* amplification of that mode by the step in which it was last judged; NaN:
                        * never */
  int32_t want_error;  /* in: nonzero asks RKC for its error estimate, one more evaluation;
                        * default 0. Tableaux with an embedded method give theirs anyway */
} sph_step_info;
/* Fill *info with the defaults: NaN and 0. Since 0.1. */
SPH_API void sph_step_info_init_sized(sph_step_info *info, size_t size);
#define sph_step_info_init(i) sph_step_info_init_sized((i), sizeof(sph_step_info))

/* Advance from t to t + dt. set may be NULL when only arrays are bound and the right-hand side is a
 * callback. dt finite and not 0; negative dt is allowed for all but RKC. info may be NULL.
 *
 * RKC's error estimate is 0.8 (U - U+) + 0.4 dt (F + F+) (Sommeijer, Shampine, Verwer, J. Comput.
 * Appl. Math. 88 (1998) 315-326): 0.8 times the trapezoidal defect. For linear problems it exceeds
 * the true local error by 1.2 (s = 2) to 1.8 (many stages). The power iteration differentiates
 * numerically: it moves no value by more than 1.5e-8 of the largest value of its field. It takes
 * complex pairs (waves) as well as real eigenvalues.
 *
 * SPH_RETRY: the right-hand side asked for a smaller step, or RKC would need more than max_stages
 * (info is then written: suggested_dt is the largest step that fits, stages what was asked for).
 * SPH_ERR_ARG: t or dt, no set though fields are bound, a bound field the set does not know.
 * SPH_ERR_STATE: nothing bound or no right-hand side, leapfrog without X and V, a step within a
 * step; the set's real particles changed during the step (when others were appended, the old ones
 * are put back; when they were removed or reordered, nothing can be). SPH_ERR_NUMERIC: the result
 * is not finite (first field and particle are named; the fields in the order of binding), or the
 * right-hand side is not in a power iteration. SPH_ERR_CALLBACK, and what the right-hand side
 * answers. SPH_ERR_NOMEM. In every such case the bound fields are as before the call, to the bit.
 *
 * Storage, kept: copies of the bound fields, one plus the stages of a tableau, four for both
 * leapfrogs and RKC, LEAPFROG_PREDICTED 16 bytes a particle besides; with eigenvalue estimates RKC
 * one more, tableaux three more. A steady step allocates nothing. The result has the same bits for
 * any number of threads. Since 0.1. */
SPH_API sph_status sph_integrator_step(sph_integrator *it, sph_particles *set, double t, double dt,
                                       sph_step_info *info);

/* Save the bound fields in memory, and put them back, for hosts that repeat steps. One slot; a
 * restored state can be restored again. Kept with it: what decides the stages of the next step, so
 * that a repeated step gives the same bits. Fields that are not bound are not saved. SPH_ERR_STATE:
 * nothing bound, nothing saved, or sizes changed since. SPH_ERR_NOMEM: the state saved before is
 * intact. Since 0.1. */
SPH_API sph_status sph_integrator_save(sph_integrator *it, sph_particles *set);
/* Put back what was saved; errors as above. Since 0.1. */
SPH_API sph_status sph_integrator_restore(sph_integrator *it, sph_particles *set);

/* The same in a buffer of the host's, for checkpoints that another process reads: what
 * sph_integrator_save() keeps, bound values included. It is put back into an integrator with the
 * same options and the same bindings, and a set with as many particles in the same order; the next
 * steps then have the same bits. Numbers are written as this machine has them. *bytes receives the
 * size. SPH_ERR_STATE: nothing bound; SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_integrator_state_size(sph_integrator *it, sph_particles *set, size_t *bytes);
/* Write it. SPH_ERR_ARG: buffer NULL, not aligned as doubles are, or shorter than the size; others
 * as above. Since 0.1. */
SPH_API sph_status sph_integrator_state_write(sph_integrator *it, sph_particles *set, void *buffer,
                                              size_t bytes);
/* Put it back. SPH_ERR_ARG also: not such a state, or of another method, bindings or number of
 * particles; nothing has changed then. Since 0.1. */
SPH_API sph_status sph_integrator_state_read(sph_integrator *it, sph_particles *set,
                                             const void *buffer, size_t bytes);

/* ---- Pure functions ---------------------------------------------------------------------- */

/* Coefficients of RKC with s stages (2..1000). Arrays have s + 1 entries, index = stage, unused
 * entries 0; any may be NULL. b1: SPH_RKC_B1_*. O(s). SPH_ERR_ARG otherwise. Since 0.1. */
SPH_API sph_status sph_rkc_coefficients(int32_t s, int32_t b1, double *mu, double *nu, double *mu_t,
                                        double *gamma_t, double *c);

/* Real stability interval beta(s) = (w0 + 1) / w1, about 0.653 (s^2 - 1), which is
 * 1.963, 5.230, 9.804, 15.685, 64.69 for s = 2, 3, 4, 5, 10 (|P| = 1 is first crossed a little
 * beyond: 2.000, 6.180, 9.851, 16.60, 64.74). NaN for s outside 2..1000. O(s). Since 0.1. */
SPH_API double sph_rkc_beta(int32_t s);

/* |P_s(z)| of the stability polynomial at z = re + i im: what one step does to a mode of
 * eigenvalue z / dt. NaN for s outside 2..1000. O(s). Since 0.1. */
SPH_API double sph_rkc_amplification(int32_t s, double re, double im);

/* Stages by the published formulas; the bracket in them is the integer part. dt, wave_speed, radius
 * finite and >= 0, spacing finite and > 0; -1 otherwise, or when the count exceeds 2^31 - 1. Never
 * 1. By CFL number: s = 2 below 0.393, 3 below 1.048, 4 below 1.965, 5 below 3.144, 6 below 4.585.
 * Since 0.1. */
SPH_API int32_t sph_rkc_stages_cfl(double dt, double wave_speed, double spacing);
/* By spectral radius: s = 1 + floor(sqrt(1 + dt radius / 0.653)), else as above. Since 0.1. */
SPH_API int32_t sph_rkc_stages_radius(double dt, double radius);

/* ---- Steps that a state allows ------------------------------------------------------------ */

/* Largest stable step: cfl * min over the real particles of h_i / (c_i + |v_i|). Fields H, C, V as
 * far as they exist; particles with speed 0 do not count. SPH_ERR_ARG without H or with cfl not
 * positive and finite; SPH_ERR_NUMERIC: h not positive, a value not finite (the first such particle
 * is named), no particle gives a finite step (all speeds 0, an empty set), or the step is too small
 * for a number (it is never 0). O(n). Since 0.1. */
SPH_API sph_status sph_cfl_step(const sph_particles *set, double cfl, double *dt);

/* The same by signals between neighbours, for shocks:
 *   dt = courant min_i h_i / (c_i + max_j |v_ij . r_ij|),
 * i over the rows, j over the neighbours within the list's cutoff, r_ij the unit vector. Zisis
 * (section 4.3) has |v_i| in place of the maximum, which a uniform motion shortens, and prints
 * min (v + c) / h, which is no time; he takes courant in 0.1 .. 0.3. Needs x, v, h and c (NULL: c0,
 * which may be 0) of the operands. Errors as above, also SPH_ERR_STATE and SPH_ERR_STALE of the
 * list; *dt is untouched then. SPH_ERR_NOMEM, SPH_ERR_VERSION. O(pairs), on the context's threads,
 * same bits for any number; memory that the list keeps, so that a repeated call allocates none.
 * Since 0.1. */
SPH_API sph_status sph_signal_step(sph_neighbors *list, const sph_operands *a, double courant,
                                   double *dt);

/* The step in which no density changes by more than the fraction `limit`: limit min_i rho_i /
 * |drho_i|, infinity where nothing changes. rho, drho = d rho/dt: n, the host's. Zisis saw too
 * low a density behind strong shocks where steps were long, and gives no rule; take limit = 0.1.
 * SPH_ERR_ARG: n < 0, an array or dt NULL, limit not positive and finite. SPH_ERR_NUMERIC: rho not
 * positive and finite, drho not finite (the first such particle is named), a step too small for a
 * number. O(n), threads as above. Since 0.1. */
SPH_API sph_status sph_density_step(sph_context *ctx, int64_t n, double limit, const double *rho,
                                    const double *drho, double *dt);

#ifdef __cplusplus
}
#endif
#endif
