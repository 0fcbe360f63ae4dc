/* One evaluation for shocks: fields that follow from the state, rates, held walls; and the filter
 * of the integrator, which returns stresses and judges the result. */
#include "shocks_impl.h"

#include <math.h>
#include <string.h>

enum { GRAIN = 4096, ROUNDS = 4 };

static double *rate_of(const sph_rate *rates, int32_t count, int32_t field) {
  for (int32_t k = 0; k < count; ++k)
    if (rates[k].field == field) return rates[k].values;
  return NULL;
}

static int64_t real_count(const sph_shocks *shocks) {
  return sph_particles_real_count(shocks->set);
}

/* ---- h and rho --------------------------------------------------------------------------- */

typedef struct density_job {
  const double *rho;
  int64_t failed;
} density_job;

static void density_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  density_job *j = job;
  (void)worker;
  for (int64_t i = lo; i < hi; ++i)
    if (!(j->rho[i] > 0.0 && isfinite(j->rho[i]))) sphi_lowest(&j->failed, i);
}

static sph_status check_density(sph_shocks *shocks, double t) {
  density_job j = {sph_particles_field_const(shocks->set, SPH_FIELD_RHO), INT64_MAX};
  sphi_parallel(shocks->base.ctx, real_count(shocks), GRAIN, density_range, &j);
  if (j.failed == INT64_MAX) return SPH_OK;
  return sphi_fail(shocks->base.ctx, SPH_ERR_NUMERIC,
                   "shocks: density %g of particle %lld at t = %g in step %lld", j.rho[j.failed],
                   (long long)j.failed, t, (long long)shocks->book.steps + 1);
}

/* Only a change is told, so that a list that was built for these lengths serves. */
sph_status sphi_shocks_lengths(sph_shocks *shocks) {
  const size_t bytes = sphi_mul((size_t)real_count(shocks), sizeof(double));
  double *h;
  sph_status s = sph_particles_field(shocks->set, SPH_FIELD_H, &h);
  if (!s) s = sphi_buffer_reserve(shocks->base.ctx, &shocks->lengths, bytes);
  if (!s)
    s = sph_h_from_mass(shocks->base.ctx, shocks->options.dim, real_count(shocks),
                        shocks->options.eta, sph_particles_field_const(shocks->set, SPH_FIELD_M),
                        sph_particles_field_const(shocks->set, SPH_FIELD_RHO), shocks->lengths.ptr);
  if (s || memcmp(h, shocks->lengths.ptr, bytes) == 0) return s;
  memcpy(h, shocks->lengths.ptr, bytes);
  return sph_particles_touch(shocks->set, SPH_FIELD_H);
}

/* P and C by the equations of state. */
static sph_status fill_laws(sph_shocks *shocks) {
  sph_status s = sph_rhs_fill(shocks->rhs, shocks->set, SPH_FIELD_P);
  return s ? s : sph_rhs_fill(shocks->rhs, shocks->set, SPH_FIELD_C);
}

/* H, P, C of DIFFERENTIAL: one particle at a time. */
static sph_status fill_pointwise(sph_shocks *shocks, double t) {
  sph_status s = check_density(shocks, t);
  if (!s && shocks->options.adaptive) s = sphi_shocks_lengths(shocks);
  return s ? s : fill_laws(shocks);
}

/* ---- neighbours -------------------------------------------------------------------------- */

static sph_status call_hook(sph_shocks *shocks, sph_rhs_hook fn, void *user, double t,
                            const sph_rate *rates, int32_t count) {
  if (!fn) return SPH_OK;
  const int32_t answer = fn(user, t, shocks->set, rates, count);
  if (answer == 0) return SPH_OK;
  if (answer > 0) return SPH_RETRY;
  return sphi_fail(shocks->base.ctx, SPH_ERR_CALLBACK, "the prepare hook answered %d at t = %g",
                   (int)answer, t);
}

static sph_status make_ghosts(sph_shocks *shocks, double t) {
  return shocks->ghosts ? sph_ghosts_prepare(shocks->ghosts, t, shocks->set, NULL, 0) : SPH_OK;
}

/* Before the first omega there is none to mirror. */
static void mirror_omega(const sph_shocks *shocks, double *omega) {
  const int64_t real = real_count(shocks), all = sph_particles_count(shocks->set);
  const int64_t *owner = shocks->ghosts ? sph_ghosts_owners(shocks->ghosts) : NULL;
  for (int64_t i = real; i < all; ++i) {
    if (owner)
      omega[i] = omega[owner[i - real]];
    else if (!(omega[i] > 0.0))
      omega[i] = 1.0;
  }
}

static sph_status fill_omega(sph_shocks *shocks) {
  sph_operands a;
  double *omega;
  sph_operands_init(&a);
  sph_status s = sph_particles_field(shocks->set, SPH_FIELD_OMEGA, &omega);
  if (!s) s = sph_operands_from_set(shocks->set, &a);
  if (s) return s;
  if (shocks->options.adaptive)
    s = sph_grad_h(shocks->list, shocks->kernel, &a, shocks->options.smoothing,
                   shocks->options.omega_floor, omega);
  else
    for (int64_t i = 0; i < a.n; ++i) omega[i] = 1.0;
  if (s) return s;
  mirror_omega(shocks, omega);
  return sph_particles_touch(shocks->set, SPH_FIELD_OMEGA);
}

/* ---- densities by summation -------------------------------------------------------------- */

int sphi_shocks_is_solved(const sph_shocks *shocks) {
  const sphi_shock_solved *at = &shocks->solved;
  return at->x == sph_particles_revision(shocks->set, SPH_FIELD_X) &&
         at->m == sph_particles_revision(shocks->set, SPH_FIELD_M) &&
         at->generation == sph_particles_generation(shocks->set);
}

void sphi_shocks_set_solved(sph_shocks *shocks) {
  shocks->solved = (sphi_shock_solved){sph_particles_revision(shocks->set, SPH_FIELD_X),
                                       sph_particles_revision(shocks->set, SPH_FIELD_M),
                                       sph_particles_generation(shocks->set)};
}

static sph_status solve_once(sph_shocks *shocks, int64_t *kept) {
  sph_adapt_options o;
  sph_adapt_result result;
  sph_adapt_options_init(&o);
  sph_adapt_result_init(&result);
  o.smoothing = shocks->options.smoothing;
  o.eta = shocks->options.eta;
  o.keep = shocks->options.keep_unsolved;
  sph_status s = sph_adapt_smoothing(shocks->list, shocks->kernel, shocks->set, &o, &result);
  *kept = result.kept;
  return s;
}

/* H and RHO together; again where the lengths outgrow the layer of ghosts. */
static sph_status solve(sph_shocks *shocks, double t) {
  sph_status s = SPH_OK;
  int64_t kept = 0;
  for (int round = 0; !s && round < ROUNDS; ++round) {
    const uint64_t generation = sph_particles_generation(shocks->set);
    s = solve_once(shocks, &kept);
    if (!s) s = fill_laws(shocks);
    if (!s) s = make_ghosts(shocks, t);
    if (generation == sph_particles_generation(shocks->set)) break;
  }
  shocks->book.unsolved += kept;
  if (!s) sphi_shocks_set_solved(shocks);
  return s;
}

/* ---- before the rates -------------------------------------------------------------------- */

static int integral(const sph_shocks *shocks) {
  return shocks->options.density == SPH_SHOCKS_INTEGRAL;
}

sph_status sphi_shocks_neighbors(sph_shocks *shocks, double t, const sph_rate *rates,
                                 int32_t count) {
  sph_status s = integral(shocks) ? fill_laws(shocks) : fill_pointwise(shocks, t);
  if (!s) s = call_hook(shocks, shocks->prepare, shocks->prepare_user, t, rates, count);
  if (!s) s = make_ghosts(shocks, t);
  if (!s && integral(shocks) && !sphi_shocks_is_solved(shocks)) s = solve(shocks, t);
  return s ? s : sph_neighbors_update(shocks->list, shocks->set, NULL);
}

sph_status sphi_shocks_fill(sph_shocks *shocks, double t, const sph_rate *rates, int32_t count) {
  sph_status s = sphi_shocks_neighbors(shocks, t, rates, count);
  return s ? s : fill_omega(shocks);
}

/* ---- rates ------------------------------------------------------------------------------- */

static void clear(double *rate, int64_t i, int32_t components) {
  for (int32_t c = 0; rate && c < components; ++c) rate[i * components + c] = 0.0;
}

/* A wall keeps what it has; its velocity moves it. */
static void hold_walls(sph_shocks *shocks, const sph_rate *rates, int32_t count) {
  static const int32_t fields[] = {SPH_FIELD_V, SPH_FIELD_RHO, SPH_FIELD_E, SPH_FIELD_SIGMA};
  const int32_t *role = sph_particles_roles(shocks->set);
  for (int k = 0; k < 4; ++k) {
    double *rate = rate_of(rates, count, fields[k]);
    const int32_t components = sph_particles_components(shocks->set, fields[k]);
    for (int64_t i = 0; rate && i < real_count(shocks); ++i)
      if (role[i] == SPH_ROLE_WALL) clear(rate, i, components);
  }
}

/* After the pair loops: walls, then the host's hook; and what each of them changed. */
int32_t sphi_shocks_finish(void *user, double t, sph_particles *set, const sph_rate *rates,
                           int32_t count) {
  sph_shocks *shocks = user;
  const double *dv = rate_of(rates, count, SPH_FIELD_V);
  const double *de = rate_of(rates, count, SPH_FIELD_E);
  const int32_t audit = shocks->options.audit && dv && de;
  if (audit) shocks->pairs = sphi_shocks_gain(shocks, dv, de);
  hold_walls(shocks, rates, count);
  if (audit) shocks->held = sphi_shocks_gain(shocks, dv, de);
  const int32_t answer =
      shocks->finish ? shocks->finish(shocks->finish_user, t, set, rates, count) : 0;
  if (audit) shocks->after = shocks->finish ? sphi_shocks_gain(shocks, dv, de) : shocks->held;
  return answer;
}

/* The rates of the fields stand first in `fields`; the array of integrals is the ledger's own. */
static sph_status split_rates(const sph_shocks *shocks, const sph_rate *rates, int32_t count,
                              sph_rate *fields, int32_t *n, double **integrals) {
  for (int32_t k = 0; k < count; ++k) {
    if (rates[k].field >= 0)
      fields[(*n)++] = rates[k];
    else if (rates[k].field == shocks->ledger_item)
      *integrals = rates[k].values;
    else
      return sphi_fail(shocks->base.ctx, SPH_ERR_STATE,
                       "shocks: no rates for the array bound as item %d", (int)k);
  }
  return SPH_OK;
}

static void keep_drho(sph_shocks *shocks, const double *drho) {
  if (drho) memcpy(shocks->drho.ptr, drho, (size_t)real_count(shocks) * sizeof *drho);
}

int32_t sphi_shocks_evaluate(void *user, double t, sph_particles *set, const sph_rate *rates,
                             int32_t count) {
  sph_shocks *shocks = user;
  sph_rate fields[SPHI_SHOCK_RATES];
  double *integrals = NULL;
  int32_t n = 0;
  sph_status s = split_rates(shocks, rates, count, fields, &n, &integrals);
  if (!s) s = sphi_shocks_fill(shocks, t, fields, n);
  if (!s) s = sph_rhs_evaluate(shocks->rhs, set, shocks->list, t, fields, n);
  if (s) return s;
  keep_drho(shocks, rate_of(fields, n, SPH_FIELD_RHO));
  if (integrals) sphi_shocks_powers(shocks, integrals);
  return SPH_OK;
}

/* ---- the filter -------------------------------------------------------------------------- */

static int predicted(const sph_shocks *shocks) {
  return shocks->options.integrator == SPH_INTEGRATOR_LEAPFROG_PREDICTED;
}

/* Every copy of the stress is returned, but plastic strain grows once a step: in the copy that the
 * integrator goes on from. */
static sph_status return_stress(sph_shocks *shocks, int32_t copy, double *sigma) {
  const size_t n = (size_t)real_count(shocks);
  const int32_t goes_on = copy == (predicted(shocks) ? SPH_COPY_HALF : SPH_COPY_RESULT);
  const double *strain = sph_particles_field_const(shocks->set, shocks->strain_field);
  sph_status s = sphi_buffer_reserve(shocks->base.ctx, &shocks->strain, sphi_mul(2 * n, 8));
  if (s) return s;
  double *next = shocks->strain.ptr, *aside = next + n;
  const double *from = predicted(shocks) && copy == SPH_COPY_RESULT ? next : strain;
  double *to = goes_on ? next : aside;
  memcpy(to, from, n * sizeof *to);
  return sph_rhs_plastic_return(shocks->rhs, shocks->set, sigma, to);
}

int32_t sphi_shocks_filter(void *user, double t, sph_particles *set, int32_t copy,
                           const sph_rate *values, int32_t count) {
  sph_shocks *shocks = user;
  double *sigma = rate_of(values, count, SPH_FIELD_SIGMA);
  (void)set;
  sph_status s = sigma ? return_stress(shocks, copy, sigma) : SPH_OK;
  if (s || copy != SPH_COPY_RESULT) return s;
  return integral(shocks) ? SPH_OK : fill_pointwise(shocks, t);
}

sph_status sphi_shocks_keep_strain(sph_shocks *shocks) {
  double *strain;
  if (!shocks->strength) return SPH_OK;
  sph_status s = sph_particles_field(shocks->set, shocks->strain_field, &strain);
  if (s) return s;
  memcpy(strain, shocks->strain.ptr, (size_t)real_count(shocks) * sizeof *strain);
  return sph_particles_touch(shocks->set, shocks->strain_field);
}
