/* Balances of the total-Lagrangian scheme. The leapfrog changes V in kicks by dt a, in which every
 * sum is exact: with the velocities v and v' before and after, a part u of the acceleration adds
 *
 *   dt sum m u.(v + v')/2   to the kinetic energy,
 *   dt sum m u              to the momentum,
 *   dt sum m x cross u      to the angular momentum
 *
 * (between kicks X moves along V, which changes none of them). So each half of a kick is added by
 * what it would be with its own v. */
#include "total_lagrangian_impl.h"

#include <math.h>
#include <string.h>

void sph_total_lagrangian_ledger_init_sized(sph_total_lagrangian_ledger *ledger, size_t size) {
  const sph_total_lagrangian_ledger empty = {.size = sizeof empty};
  sphi_options_init(ledger, size, &empty, sizeof empty);
}

sph_status sphi_tl_ledger_create(sph_total_lagrangian *tl) {
  const sph_total_lagrangian_options *o = &tl->options;
  sph_rhs_options options;
  if (o->alpha == 0.0 && o->beta == 0.0) return SPH_OK;
  sph_rhs_options_init(&options);
  options.position_field = SPH_FIELD_X0;
  sph_status s = sph_rhs_create(tl->base.ctx, tl->kernel, &options, &tl->ledger.viscosity);
  return s ? s : sphi_tl_add_viscosity(tl->ledger.viscosity, o);
}

void sphi_tl_ledger_destroy(sph_total_lagrangian *tl) {
  sph_rhs_destroy(tl->ledger.viscosity);
  sphi_buffer_free(tl->base.ctx, &tl->ledger.parts);
}

/* ---- the parts of an acceleration -------------------------------------------------------- */

static double *part_of(const sph_total_lagrangian *tl, const sph_particles *set, int source) {
  const size_t size = (size_t)sph_particles_real_count(set) * (size_t)tl->options.dim;
  return (double *)tl->ledger.parts.ptr + (size_t)source * size;
}

/* By the operators, from the fields F and PK that the evaluation has left. `force`: scratch. */
static sph_status split_form(sph_total_lagrangian *tl, sph_particles *set, double *matrix,
                             double *force, double *out) {
  const sph_total_lagrangian_options *o = &tl->options;
  const double *x = sph_particles_field_const(set, SPH_FIELD_X);
  sph_operands a;
  sph_status s = sph_operands_from_set(set, &a);
  if (s) return s;
  a.x = sph_particles_field_const(set, SPH_FIELD_X0);
  a.rows = a.n;
  s = sph_gradient_matrix(tl->list, tl->kernel, &a, matrix, NULL, NULL);
  a.rows = sph_particles_real_count(set);
  a.gradient_matrix = matrix;
  if (!s)
    s = sph_piola_divergence(tl->list, tl->kernel, &a, o->form,
                             sph_particles_field_const(set, SPH_FIELD_PK), out);
  if (s || o->hourglass == 0.0) return s;
  s = sph_hourglass_force(tl->list, tl->kernel, &a, o->hourglass_form, o->hourglass, x,
                          sph_particles_field_const(set, SPH_FIELD_F), force, NULL);
  for (int64_t k = 0; !s && k < a.rows * o->dim; ++k) out[k] += force[k];
  return s;
}

static sph_status split_viscosity(sph_total_lagrangian *tl, sph_particles *set, double t,
                                  double *out, size_t size) {
  const sph_rate rate = {SPH_FIELD_V, out};
  memset(out, 0, size * sizeof *out);
  if (!tl->ledger.viscosity) return SPH_OK;
  return sph_rhs_evaluate(tl->ledger.viscosity, set, tl->list, t, &rate, 1);
}

sph_status sphi_tl_ledger_split(sph_total_lagrangian *tl, sph_particles *set, double t) {
  const size_t dim = (size_t)tl->options.dim, n = (size_t)sph_particles_count(set);
  const size_t size = (size_t)sph_particles_real_count(set) * dim;
  sph_context *ctx = tl->base.ctx;
  sph_status s =
      sphi_buffer_reserve(ctx, &tl->ledger.parts, sphi_mul(size, SPHI_TL_SOURCES * sizeof(double)));
  if (!s)
    s = sphi_buffer_reserve(ctx, &tl->scratch, sphi_mul(n, (dim * dim + dim) * sizeof(double)));
  if (s) return s;
  double *matrix = tl->scratch.ptr, *force = matrix + n * dim * dim;
  double *form = part_of(tl, set, SPHI_TL_FORM), *viscous = part_of(tl, set, SPHI_TL_VISCOUS);
  double *gravity = part_of(tl, set, SPHI_TL_GRAVITY), *hooks = part_of(tl, set, SPHI_TL_HOOKS);
  const double *total = tl->rates.ptr;
  s = split_form(tl, set, matrix, force, form);
  if (!s) s = split_viscosity(tl, set, t, viscous, size);
  for (size_t k = 0; !s && k < size; ++k) {
    gravity[k] = tl->options.gravity[k % dim];
    hooks[k] = total[k] - form[k] - viscous[k] - gravity[k];
  }
  return s;
}

/* ---- adding up --------------------------------------------------------------------------- */

static double potential_of(const sph_total_lagrangian_energies *e) {
  return e->strain + e->hourglass;
}

sph_status sphi_tl_ledger_begin(sph_total_lagrangian *tl, sph_particles *set) {
  sph_total_lagrangian_energies e = {.size = sizeof e};
  if (tl->ledger.begun) return SPH_OK;
  sph_status s = sph_total_lagrangian_energy(tl, set, tl->t, &e);
  if (s) return s;
  memset(tl->ledger.integral, 0, sizeof tl->ledger.integral);
  tl->ledger.start =
      sphi_moments_of(tl->base.ctx, set, sph_particles_field_const(set, SPH_FIELD_V));
  tl->ledger.potential = potential_of(&e);
  tl->ledger.begun = 1;
  return SPH_OK;
}

void sphi_tl_ledger_kick(sph_total_lagrangian *tl, const sph_particles *set, double dt) {
  if (!tl->options.audit) return;
  for (int k = 0; k < SPHI_TL_SOURCES; ++k) {
    const sphi_moments sum = sphi_moments_of(tl->base.ctx, set, part_of(tl, set, k));
    sphi_moments *integral = &tl->ledger.integral[k];
    integral->power += 0.5 * dt * sum.power;
    for (int a = 0; a < 3; ++a) {
      integral->linear[a] += 0.5 * dt * sum.linear[a];
      integral->angular[a] += 0.5 * dt * sum.angular[a];
    }
  }
}

/* ---- the ledger -------------------------------------------------------------------------- */

static void largest(double *most, double x) {
  if (!(fabs(x) <= *most)) *most = fabs(x);
}

static void read_integrals(const sphi_tl_ledger *own, sph_total_lagrangian_ledger *l) {
  const sphi_moments *q = own->integral;
  l->viscous = -q[SPHI_TL_VISCOUS].power;
  l->gravity = q[SPHI_TL_GRAVITY].power;
  l->hooks = q[SPHI_TL_HOOKS].power;
  l->energy_error = l->kinetic - 0.5 * own->start.power + l->strain + l->hourglass -
                    own->potential + l->viscous - l->gravity - l->hooks;
  for (int a = 0; a < 3; ++a) {
    l->impulse_gravity[a] = q[SPHI_TL_GRAVITY].linear[a];
    l->impulse_hooks[a] = q[SPHI_TL_HOOKS].linear[a];
    l->impulse_form[a] = q[SPHI_TL_FORM].linear[a] + q[SPHI_TL_VISCOUS].linear[a];
    l->moment_gravity[a] = q[SPHI_TL_GRAVITY].angular[a];
    l->moment_hooks[a] = q[SPHI_TL_HOOKS].angular[a];
    l->moment_form[a] = q[SPHI_TL_FORM].angular[a] + q[SPHI_TL_VISCOUS].angular[a];
    largest(&l->momentum_error, l->momentum[a] - own->start.linear[a] - l->impulse_gravity[a] -
                                    l->impulse_hooks[a] - l->impulse_form[a]);
    largest(&l->angular_momentum_error, l->angular_momentum[a] - own->start.angular[a] -
                                            l->moment_gravity[a] - l->moment_hooks[a] -
                                            l->moment_form[a]);
  }
}

static void not_audited(sph_total_lagrangian_ledger *l) {
  l->viscous = l->gravity = l->hooks = NAN;
  l->energy_error = l->momentum_error = l->angular_momentum_error = NAN;
  for (int a = 0; a < 3; ++a) {
    l->impulse_gravity[a] = l->impulse_hooks[a] = l->impulse_form[a] = NAN;
    l->moment_gravity[a] = l->moment_hooks[a] = l->moment_form[a] = NAN;
  }
}

sph_status sph_total_lagrangian_balance(sph_total_lagrangian *tl, sph_particles *set, double t,
                                        sph_total_lagrangian_ledger *ledger) {
  sph_total_lagrangian_energies e = {.size = sizeof e};
  sph_total_lagrangian_ledger own = {.size = sizeof own, .time = t};
  sph_status s = sphi_tl_check_started(tl, set);
  if (s) return s;
  if (!ledger || ledger->size < sizeof(size_t))
    return sphi_fail(tl->base.ctx, SPH_ERR_ARG, "total_lagrangian: the ledger is %s",
                     ledger ? "not initialised" : "NULL");
  s = sph_total_lagrangian_energy(tl, set, t, &e);
  if (s) return s;
  const sphi_moments now =
      sphi_moments_of(tl->base.ctx, set, sph_particles_field_const(set, SPH_FIELD_V));
  own.mass = sphi_mass_times(tl->base.ctx, set, NULL);
  own.kinetic = e.kinetic;
  own.strain = e.strain;
  own.hourglass = e.hourglass;
  memcpy(own.momentum, now.linear, sizeof own.momentum);
  memcpy(own.angular_momentum, now.angular, sizeof own.angular_momentum);
  if (tl->options.audit && tl->ledger.begun)
    read_integrals(&tl->ledger, &own);
  else
    not_audited(&own);
  const size_t size = ledger->size;
  sphi_options_init(ledger, size, &own, sizeof own);
  return SPH_OK;
}
