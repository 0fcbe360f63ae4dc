/* The start of a run with shocks: fields, list, integrator, first evaluation. */
#include "shocks_impl.h"

#include <math.h>
#include <string.h>

/* ---- list and integrator ----------------------------------------------------------------- */

sph_status sphi_shocks_make_list(sph_shocks *shocks, double smallest_h) {
  const sph_shocks_options *o = &shocks->options;
  sph_neighbors_options list;
  sph_neighbors_destroy(shocks->list);
  shocks->list = NULL;
  sph_neighbors_options_init(&list);
  list.method = o->neighbors;
  list.h_rule = SPH_H_MAX; /* forces reach as far as the larger of the two */
  list.support = sph_kernel_support(shocks->kernel);
  list.skin = o->skin * smallest_h;
  list.max_pairs = o->max_pairs;
  memcpy(list.periodic, o->periodic, sizeof list.periodic);
  memcpy(list.box_lo, o->box_lo, sizeof list.box_lo);
  memcpy(list.box_hi, o->box_hi, sizeof list.box_hi);
  return sph_neighbors_create(shocks->base.ctx, &list, &shocks->list);
}

static sph_status bind(sph_shocks *shocks) {
  sph_integrator *it = shocks->integrator;
  const int32_t fields[] = {SPH_FIELD_X, SPH_FIELD_V, SPH_FIELD_E,
                            shocks->options.density == SPH_SHOCKS_DIFFERENTIAL ? SPH_FIELD_RHO : -1,
                            shocks->strength ? SPH_FIELD_SIGMA : -1};
  int32_t items = 0;
  sph_status s = SPH_OK;
  for (int k = 0; !s && k < 5; ++k)
    if (fields[k] >= 0) {
      s = sph_integrator_bind_field(it, fields[k]);
      ++items;
    }
  shocks->ledger_item = shocks->options.audit ? -1 - items : 0; /* 0 is no array's */
  if (!s && shocks->options.audit)
    s = sph_integrator_bind_array(it, shocks->book.integral, SPHI_SHOCK_INTEGRALS);
  if (!s) s = sph_integrator_set_function(it, sphi_shocks_evaluate, shocks);
  return s ? s : sph_integrator_set_filter(it, sphi_shocks_filter, shocks);
}

static sph_status make_integrator(sph_shocks *shocks) {
  sph_integrator_options integrator;
  sph_integrator_options_init(&integrator);
  integrator.method = shocks->options.integrator;
  sph_status s = sph_integrator_create(shocks->base.ctx, &integrator, &shocks->integrator);
  return s ? s : bind(shocks);
}

void sphi_shocks_drop_parts(sph_shocks *shocks) {
  sph_integrator_destroy(shocks->integrator);
  sph_neighbors_destroy(shocks->list);
  shocks->integrator = NULL;
  shocks->list = NULL;
  shocks->started = 0;
}

sph_status sphi_shocks_make_parts(sph_shocks *shocks, double smallest_h) {
  sphi_shocks_drop_parts(shocks);
  sph_status s = sphi_shocks_make_list(shocks, smallest_h);
  return s ? s : make_integrator(shocks);
}

/* ---- fields ------------------------------------------------------------------------------ */

static sph_status check_positive(sph_shocks *shocks, int32_t field, const char *name) {
  const double *f = sph_particles_field_const(shocks->set, field);
  for (int64_t i = 0; i < sph_particles_real_count(shocks->set); ++i)
    if (!(isfinite(f[i]) && f[i] > 0.0))
      return sphi_fail(shocks->base.ctx, SPH_ERR_NUMERIC, "shocks: %s of particle %lld is %g", name,
                       (long long)i, f[i]);
  return SPH_OK;
}

static sph_status check_phases(sph_shocks *shocks) {
  const int32_t *phase = sph_particles_phases(shocks->set);
  for (int64_t i = 0; i < sph_particles_real_count(shocks->set); ++i)
    if (phase[i] < 0 || phase[i] >= SPHI_SHOCK_PHASES || !shocks->has_law[phase[i]])
      return sphi_fail(shocks->base.ctx, SPH_ERR_STATE,
                       "shocks: phase %d of particle %lld has no material", (int)phase[i],
                       (long long)i);
  return SPH_OK;
}

/* The lengths that the host filled, with adaptive 0, stay. */
static sph_status fill_lengths(sph_shocks *shocks) {
  const int64_t n = sph_particles_real_count(shocks->set);
  const size_t bytes = (size_t)n * sizeof(double);
  double *h, *given = shocks->drho.ptr; /* which holds nothing yet */
  if (shocks->options.adaptive) return sphi_shocks_lengths(shocks);
  sph_status s = sph_particles_field(shocks->set, SPH_FIELD_H, &h);
  if (s) return s;
  memcpy(given, h, bytes);
  s = sphi_shocks_lengths(shocks);
  for (int64_t i = 0; !s && i < n; ++i)
    if (given[i] != 0.0) h[i] = given[i];
  return s ? s : sph_particles_touch(shocks->set, SPH_FIELD_H);
}

sph_status sphi_shocks_make_fields(sph_shocks *shocks) {
  static const int32_t fields[] = {SPH_FIELD_V, SPH_FIELD_E, SPH_FIELD_M, SPH_FIELD_RHO,
                                   SPH_FIELD_H, SPH_FIELD_P, SPH_FIELD_C, SPH_FIELD_OMEGA};
  const size_t n = (size_t)sph_particles_real_count(shocks->set);
  double *ignored;
  sph_status s = SPH_OK;
  for (int k = 0; !s && k < 8; ++k) s = sph_particles_field(shocks->set, fields[k], &ignored);
  return s ? s : sphi_buffer_reserve(shocks->base.ctx, &shocks->drho, sphi_mul(n, sizeof(double)));
}

sph_status sphi_shocks_check_fields(sph_shocks *shocks) {
  sph_status s = check_positive(shocks, SPH_FIELD_M, "mass");
  if (!s) s = check_positive(shocks, SPH_FIELD_RHO, "density");
  return s ? s : check_phases(shocks);
}

static double smallest_h(const sph_shocks *shocks) {
  const double *f = sph_particles_field_const(shocks->set, SPH_FIELD_H);
  double least = INFINITY;
  for (int64_t i = 0; i < sph_particles_real_count(shocks->set); ++i) least = fmin(least, f[i]);
  return least;
}

/* ---- start ------------------------------------------------------------------------------- */

/* The rate of the density, for the first step's length; it runs the hooks as every evaluation. */
static sph_status first_rates(sph_shocks *shocks, double t) {
  const sph_rate rate = {SPH_FIELD_RHO, shocks->drho.ptr};
  sph_status s = sphi_shocks_fill(shocks, t, &rate, 1);
  if (s || shocks->options.density != SPH_SHOCKS_DIFFERENTIAL) return s;
  return sph_rhs_evaluate(shocks->rhs, shocks->set, shocks->list, t, &rate, 1);
}

sph_status sphi_shocks_begin(sph_shocks *shocks, double t) {
  shocks->started = 0;
  shocks->solved = (sphi_shock_solved){0, 0, 0};
  if (!isfinite(t)) return sphi_fail(shocks->base.ctx, SPH_ERR_ARG, "shocks: time %g", t);
  if (sph_particles_real_count(shocks->set) == 0)
    return sphi_fail(shocks->base.ctx, SPH_ERR_STATE, "shocks: the set is empty");
  sph_status s = sphi_shocks_make_fields(shocks);
  if (!s) s = sphi_shocks_check_fields(shocks);
  if (!s) s = fill_lengths(shocks);
  if (!s) s = check_positive(shocks, SPH_FIELD_H, "smoothing length");
  if (!s) s = sphi_shocks_make_parts(shocks, smallest_h(shocks));
  return s ? s : first_rates(shocks, t);
}

sph_status sph_shocks_start(sph_shocks *shocks, double t) {
  sph_status s = sphi_shocks_check(shocks, 0);
  if (!s) s = sphi_shocks_begin(shocks, t);
  if (s) return s;
  sphi_shocks_open_book(shocks, t);
  shocks->book.smallest_h = smallest_h(shocks);
  shocks->started = 1;
  return SPH_OK;
}
