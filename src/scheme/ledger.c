/* Balances of the scheme: sums of the state, and powers that the integrator adds up. */
#include "scheme_impl.h"

#include <math.h>
#include <string.h>

void sph_elastodynamics_ledger_init_sized(sph_elastodynamics_ledger *ledger, size_t size) {
  const sph_elastodynamics_ledger empty = {.size = sizeof empty};
  sphi_options_init(ledger, size, &empty, sizeof empty);
}

static sphi_moments moments_of(const sph_elastodynamics *solid, const double *u) {
  return sphi_moments_of(solid->base.ctx, solid->set, u);
}

/* sigma : L, which is sigma : D. */
static double stress_power(int32_t dim, const double *s, const double *L) {
  if (dim == 1) return s[0] * L[0];
  if (dim == 2) return s[0] * L[0] + s[1] * L[3] + s[2] * (L[1] + L[2]);
  return s[0] * L[0] + s[1] * L[4] + s[2] * L[8] + s[3] * (L[1] + L[3]) + s[4] * (L[2] + L[6]) +
         s[5] * (L[5] + L[7]);
}

/* ---- powers ------------------------------------------------------------------------------ */

sph_status sphi_ledger_create(sph_elastodynamics *solid) {
  const sph_elastodynamics_options *o = &solid->options;
  const int wanted[2] = {o->alpha > 0.0 || o->beta > 0.0, o->artificial_stress > 0.0};
  sph_rhs_options options;
  sph_status s = SPH_OK;
  sph_rhs_options_init(&options);
  options.position_field = o->position_field;
  for (int k = 0; !s && k < 2; ++k)
    if (wanted[k]) s = sph_rhs_create(solid->base.ctx, solid->kernel, &options, &solid->damping[k]);
  if (!s && wanted[0]) s = sphi_scheme_viscosity(solid, solid->damping[0]);
  if (!s && wanted[1]) s = sphi_scheme_artificial_stress(solid, solid->damping[1]);
  return s;
}

/* sum V sigma:L with the gradients of the stress rate. */
static sph_status strain_power(sph_elastodynamics *solid, double *matrix, double *L, double *out) {
  const int32_t dim = solid->options.dim, components = sph_sym_components(dim);
  sph_operands a;
  sph_operands_init(&a);
  sph_status s = sph_operands_from_set(solid->set, &a);
  a.x = sph_particles_field_const(solid->set, solid->options.position_field);
  if (!s && solid->options.corrected) {
    s = sph_gradient_matrix(solid->list, solid->kernel, &a, matrix, NULL, NULL);
    a.gradient_matrix = matrix;
  }
  if (!s) s = sph_velocity_gradient(solid->list, solid->kernel, &a, L);
  for (int64_t i = 0; !s && i < a.rows; ++i)
    *out += a.m[i] / a.rho[i] * stress_power(dim, a.sigma + i * components, L + i * dim * dim);
  return s;
}

/* -sum m v.a of one damping term alone. */
static sph_status damping_power(sph_elastodynamics *solid, int k, double t, double *dv,
                                double *out) {
  const sph_rate rate = {SPH_FIELD_V, dv};
  if (!solid->damping[k]) return SPH_OK;
  sph_status s = sph_rhs_evaluate(solid->damping[k], solid->set, solid->list, t, &rate, 1);
  if (!s) *out = -moments_of(solid, dv).power;
  return s;
}

static void body_power(const sph_elastodynamics *solid, double *rates) {
  const double *v = sph_particles_field_const(solid->set, SPH_FIELD_V);
  const double mass = sphi_mass_times(solid->base.ctx, solid->set, NULL),
               *g = solid->options.body_force;
  const sphi_moments of_v = moments_of(solid, v);
  rates[SPHI_BODY] = 0.0;
  for (int32_t a = 0; a < solid->options.dim; ++a) {
    rates[SPHI_BODY] += g[a] * of_v.linear[a];
    rates[SPHI_IMPULSE_BODY + a] = mass * g[a];
  }
}

/* What is left of the sums before and after walls and hooks. */
static void balance_rates(const sph_elastodynamics *solid, double *r) {
  const sphi_moments *b = &solid->before, *a = &solid->after;
  r[SPHI_HOOKS] = a->power - b->power;
  r[SPHI_FORM] = b->power + r[SPHI_STRAIN] + r[SPHI_VISCOUS] + r[SPHI_ARTIFICIAL] - r[SPHI_BODY];
  for (int k = 0; k < 3; ++k) {
    r[SPHI_IMPULSE_HOOKS + k] = a->linear[k] - b->linear[k];
    r[SPHI_IMPULSE_FORM + k] = b->linear[k] - r[SPHI_IMPULSE_BODY + k];
    r[SPHI_MOMENT_HOOKS + k] = a->angular[k] - b->angular[k];
    r[SPHI_MOMENT_FORM + k] = b->angular[k];
  }
}

sph_status sphi_ledger_rates(sph_elastodynamics *solid, double t, double *rates) {
  const size_t n = (size_t)sph_particles_real_count(solid->set), dim = (size_t)solid->options.dim;
  memset(rates, 0, SPHI_INTEGRALS * sizeof *rates);
  sph_status s = sphi_buffer_reserve(solid->base.ctx, &solid->scratch,
                                     sphi_mul(n, (2 * dim * dim + dim) * sizeof(double)));
  if (s) return s;
  double *matrix = solid->scratch.ptr, *L = matrix + n * dim * dim, *dv = L + n * dim * dim;
  s = strain_power(solid, matrix, L, &rates[SPHI_STRAIN]);
  if (!s) s = damping_power(solid, 0, t, dv, &rates[SPHI_VISCOUS]);
  if (!s) s = damping_power(solid, 1, t, dv, &rates[SPHI_ARTIFICIAL]);
  if (s) return s;
  body_power(solid, rates);
  balance_rates(solid, rates);
  return SPH_OK;
}

/* ---- the ledger -------------------------------------------------------------------------- */

void sphi_ledger_start(sph_elastodynamics *solid) {
  memset(solid->integral, 0, sizeof solid->integral);
  solid->start = moments_of(solid, sph_particles_field_const(solid->set, SPH_FIELD_V));
}

static void read_integrals(const sph_elastodynamics *solid, sph_elastodynamics_ledger *l) {
  const double *q = solid->integral;
  l->strain = q[SPHI_STRAIN];
  l->viscous = q[SPHI_VISCOUS];
  l->artificial = q[SPHI_ARTIFICIAL];
  l->body = q[SPHI_BODY];
  l->hooks = q[SPHI_HOOKS];
  l->form = q[SPHI_FORM];
  memcpy(l->impulse_body, q + SPHI_IMPULSE_BODY, sizeof l->impulse_body);
  memcpy(l->impulse_hooks, q + SPHI_IMPULSE_HOOKS, sizeof l->impulse_hooks);
  memcpy(l->impulse_form, q + SPHI_IMPULSE_FORM, sizeof l->impulse_form);
  memcpy(l->moment_hooks, q + SPHI_MOMENT_HOOKS, sizeof l->moment_hooks);
  memcpy(l->moment_form, q + SPHI_MOMENT_FORM, sizeof l->moment_form);
}

static void close_balances(const sph_elastodynamics *solid, sph_elastodynamics_ledger *l) {
  l->energy_error = l->kinetic - 0.5 * solid->start.power + l->strain + l->viscous + l->artificial -
                    l->body - l->hooks - l->form;
  l->momentum_error = 0.0;
  for (int a = 0; a < 3; ++a) {
    const double left = l->momentum[a] - solid->start.linear[a] - l->impulse_body[a] -
                        l->impulse_hooks[a] - l->impulse_form[a];
    if (!(fabs(left) <= l->momentum_error)) l->momentum_error = fabs(left);
  }
}

static void not_audited(sph_elastodynamics_ledger *l) {
  l->strain = l->viscous = l->artificial = l->body = l->hooks = l->form = NAN;
  l->energy_error = l->momentum_error = NAN;
  for (int a = 0; a < 3; ++a) {
    l->impulse_body[a] = l->impulse_hooks[a] = l->impulse_form[a] = NAN;
    l->moment_hooks[a] = l->moment_form[a] = NAN;
  }
}

sph_status sph_elastodynamics_balance(const sph_elastodynamics *solid,
                                      sph_elastodynamics_ledger *ledger) {
  sph_elastodynamics_ledger own = {.size = sizeof own};
  sph_status s = sphi_scheme_check(solid, 0);
  if (s) return s;
  if (!ledger || ledger->size < sizeof(size_t))
    return sphi_fail(solid->base.ctx, SPH_ERR_ARG, "elastodynamics: the ledger is %s",
                     ledger ? "not initialised" : "NULL");
  s = sphi_scheme_check(solid, 1);
  if (s) return s;
  const sphi_moments now = moments_of(solid, sph_particles_field_const(solid->set, SPH_FIELD_V));
  own.time = solid->time;
  own.mass = sphi_mass_times(solid->base.ctx, solid->set, NULL);
  own.kinetic = 0.5 * now.power;
  memcpy(own.momentum, now.linear, sizeof own.momentum);
  memcpy(own.angular_momentum, now.angular, sizeof own.angular_momentum);
  if (solid->options.audit) {
    read_integrals(solid, &own);
    close_balances(solid, &own);
  } else {
    not_audited(&own);
  }
  const size_t size = ledger->size;
  sphi_options_init(ledger, size, &own, sizeof own);
  return SPH_OK;
}
