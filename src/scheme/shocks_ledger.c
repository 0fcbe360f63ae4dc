/* Balances of the scheme for shocks: sums of the state, and powers that the integrator adds up. */
#include "shocks_impl.h"

#include <math.h>
#include <string.h>

void sph_shocks_ledger_init_sized(sph_shocks_ledger *ledger, size_t size) {
  const sph_shocks_ledger empty = {.size = sizeof empty};
  sphi_options_init(ledger, size, &empty, sizeof empty);
}

/* ---- powers ------------------------------------------------------------------------------ */

static const double *field_of(const sph_shocks *shocks, int32_t field) {
  return sph_particles_field_const(shocks->set, field);
}

sphi_gain sphi_shocks_gain(const sph_shocks *shocks, const double *dv, const double *de) {
  const sphi_moments m = sphi_moments_of(shocks->base.ctx, shocks->set, dv);
  sphi_gain gain = {.power = m.power + sphi_mass_times(shocks->base.ctx, shocks->set, de)};
  memcpy(gain.linear, m.linear, sizeof gain.linear);
  return gain;
}

static sphi_gain body_gain(const sph_shocks *shocks) {
  const double *g = shocks->options.body_force;
  sphi_gain gain = {0};
  if (g[0] == 0.0 && g[1] == 0.0 && g[2] == 0.0) return gain;
  const double mass = sphi_mass_times(shocks->base.ctx, shocks->set, NULL);
  const sphi_moments v =
      sphi_moments_of(shocks->base.ctx, shocks->set, field_of(shocks, SPH_FIELD_V));
  for (int32_t a = 0; a < shocks->options.dim; ++a) {
    gain.power += g[a] * v.linear[a];
    gain.linear[a] = mass * g[a];
  }
  return gain;
}

/* rates of one entry: what `to` has more than `from`. */
static void set_rates(double *rates, int32_t entry, const sphi_gain *to, const sphi_gain *from) {
  rates[entry] = to->power - from->power;
  for (int a = 0; a < 3; ++a)
    rates[SPHI_SHOCK_IMPULSES + 3 * entry + a] = to->linear[a] - from->linear[a];
}

void sphi_shocks_powers(const sph_shocks *shocks, double *rates) {
  const sphi_gain none = {0}, body = body_gain(shocks);
  set_rates(rates, SPHI_SHOCK_BODY, &body, &none);
  set_rates(rates, SPHI_SHOCK_FORM, &shocks->pairs, &body);
  set_rates(rates, SPHI_SHOCK_WALLS, &shocks->held, &shocks->pairs);
  set_rates(rates, SPHI_SHOCK_HOOKS, &shocks->after, &shocks->held);
}

/* ---- the ledger -------------------------------------------------------------------------- */

/* Sums of the present state. */
static void sum_state(const sph_shocks *shocks, sph_shocks_ledger *l) {
  sph_context *ctx = shocks->base.ctx;
  const sphi_moments now = sphi_moments_of(ctx, shocks->set, field_of(shocks, SPH_FIELD_V));
  l->mass = sphi_mass_times(ctx, shocks->set, NULL);
  l->kinetic = 0.5 * now.power;
  l->internal = sphi_mass_times(ctx, shocks->set, field_of(shocks, SPH_FIELD_E));
  l->total = l->kinetic + l->internal;
  memcpy(l->momentum, now.linear, sizeof l->momentum);
  memcpy(l->angular_momentum, now.angular, sizeof l->angular_momentum);
}

void sphi_shocks_open_book(sph_shocks *shocks, double t) {
  sph_shocks_ledger l;
  sum_state(shocks, &l);
  shocks->book = (sphi_shock_book){.time = t, .total = l.total};
  memcpy(shocks->book.linear, l.momentum, sizeof l.momentum);
}

static void read_integrals(const double *q, sph_shocks_ledger *l) {
  double *const powers[] = {&l->body, &l->walls, &l->hooks, &l->form};
  double *const impulses[] = {l->impulse_body, l->impulse_walls, l->impulse_hooks, l->impulse_form};
  for (int k = 0; k < SPHI_SHOCK_POWERS; ++k) {
    *powers[k] = q ? q[k] : NAN;
    for (int a = 0; a < 3; ++a) impulses[k][a] = q ? q[SPHI_SHOCK_IMPULSES + 3 * k + a] : NAN;
  }
}

static void close_balances(const sphi_shock_book *book, sph_shocks_ledger *l) {
  l->energy_error = l->total - book->total - l->body - l->walls - l->hooks - l->form;
  l->momentum_error = 0.0;
  for (int a = 0; a < 3; ++a) {
    const double left = l->momentum[a] - book->linear[a] - l->impulse_body[a] -
                        l->impulse_walls[a] - l->impulse_hooks[a] - l->impulse_form[a];
    if (!(fabs(left) <= l->momentum_error)) l->momentum_error = fabs(left);
  }
}

static int64_t count_floored(const sph_shocks *shocks) {
  const double *omega = field_of(shocks, SPH_FIELD_OMEGA);
  int64_t count = 0;
  if (!shocks->options.adaptive || shocks->options.omega_floor == 0.0) return 0;
  for (int64_t i = 0; i < sph_particles_real_count(shocks->set); ++i)
    count += omega[i] == shocks->options.omega_floor;
  return count;
}

sph_status sph_shocks_balance(const sph_shocks *shocks, sph_shocks_ledger *ledger) {
  sph_shocks_ledger own = {.size = sizeof own};
  sph_status s = sphi_shocks_check(shocks, 0);
  if (s) return s;
  if (!ledger || ledger->size < sizeof(size_t))
    return sphi_fail(shocks->base.ctx, SPH_ERR_ARG, "shocks: the ledger is %s",
                     ledger ? "not initialised" : "NULL");
  s = sphi_shocks_check(shocks, 1);
  if (s) return s;
  own.time = shocks->book.time;
  own.steps = shocks->book.steps;
  own.retries = shocks->book.retries;
  own.unsolved = shocks->book.unsolved;
  own.floored = count_floored(shocks);
  sum_state(shocks, &own);
  read_integrals(shocks->options.audit ? shocks->book.integral : NULL, &own);
  close_balances(&shocks->book, &own);
  const size_t size = ledger->size;
  sphi_options_init(ledger, size, &own, sizeof own);
  return SPH_OK;
}
