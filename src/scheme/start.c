/* The start of a run: fields that follow from options and materials, list, integrator; the step. */
#include "scheme_impl.h"

#include <math.h>
#include <string.h>

static int positive(double x) { return isfinite(x) && x > 0.0; }

/* ---- what depends on the spacing --------------------------------------------------------- */

static sph_status make_list(sph_elastodynamics *solid, double spacing) {
  const sph_elastodynamics_options *o = &solid->options;
  sph_neighbors_options list;
  sph_neighbors_options_init(&list);
  list.method = o->neighbors;
  list.h_rule = o->h_rule;
  list.support = sph_kernel_support(solid->kernel);
  list.skin = o->skin * spacing;
  memcpy(list.periodic, o->periodic, sizeof list.periodic);
  memcpy(list.box_lo, o->box_lo, sizeof list.box_lo);
  memcpy(list.box_hi, o->box_hi, sizeof list.box_hi);
  return sph_neighbors_create(solid->base.ctx, &list, &solid->list);
}

static sph_status bind(sph_elastodynamics *solid) {
  sph_integrator *it = solid->integrator;
  sph_status s = sph_integrator_bind_field(it, SPH_FIELD_X);
  if (!s) s = sph_integrator_bind_field(it, SPH_FIELD_V);
  if (!s) s = sph_integrator_bind_field(it, SPH_FIELD_SIGMA);
  int32_t items = 3;
  if (!s && solid->options.density == SPH_DENSITY_CONTINUITY) {
    s = sph_integrator_bind_field(it, SPH_FIELD_RHO);
    ++items;
  }
  if (!s && solid->options.h_law == SPH_H_LAW_RATE) {
    s = sph_integrator_bind_field(it, SPH_FIELD_H);
    ++items;
  }
  solid->ledger_item = solid->options.audit ? -1 - items : 0; /* 0 is no array's */
  if (!s && solid->options.audit)
    s = sph_integrator_bind_array(it, solid->integral, SPHI_INTEGRALS);
  return s ? s : sph_integrator_set_function(it, sphi_scheme_evaluate, solid);
}

static sph_status make_integrator(sph_elastodynamics *solid, double spacing, double speed) {
  const sph_elastodynamics_options *o = &solid->options;
  sph_integrator_options integrator;
  sph_integrator_options_init(&integrator);
  integrator.method = o->integrator;
  integrator.stage_rule = o->stage_rule;
  integrator.stages = o->stages;
  integrator.wave_speed = speed;
  integrator.spacing = spacing;
  sph_status s = sph_integrator_create(solid->base.ctx, &integrator, &solid->integrator);
  return s ? s : bind(solid);
}

void sphi_scheme_drop_parts(sph_elastodynamics *solid) {
  sph_integrator_destroy(solid->integrator);
  sph_neighbors_destroy(solid->list);
  solid->integrator = NULL;
  solid->list = NULL;
  solid->started = 0;
}

sph_status sphi_scheme_make_parts(sph_elastodynamics *solid, double spacing, double speed) {
  sphi_scheme_drop_parts(solid);
  sph_status s = make_list(solid, spacing);
  return s ? s : make_integrator(solid, spacing, speed);
}

/* ---- start ------------------------------------------------------------------------------- */

static sph_status fill_spacing(sph_elastodynamics *solid) {
  double *spacing;
  sph_status s = sph_particles_field(solid->set, SPH_FIELD_SPACING, &spacing);
  if (s || solid->options.spacing == 0.0) return s;
  for (int64_t i = 0; i < sph_particles_count(solid->set); ++i) spacing[i] = solid->options.spacing;
  return sph_particles_touch(solid->set, SPH_FIELD_SPACING);
}

static sph_status check_positive(sph_elastodynamics *solid, int32_t field, const char *name) {
  double *f;
  sph_status s = sph_particles_field(solid->set, field, &f);
  for (int64_t i = 0; !s && i < sph_particles_real_count(solid->set); ++i)
    if (!positive(f[i]))
      s = sphi_fail(solid->base.ctx, SPH_ERR_NUMERIC, "elastodynamics: %s of particle %lld is %g",
                    name, (long long)i, f[i]);
  return s;
}

/* C of every particle, and the largest. */
static sph_status fill_speed(sph_elastodynamics *solid, double *largest) {
  double *c;
  const int32_t *phase = sph_particles_phases(solid->set);
  sph_status s = sph_particles_field(solid->set, SPH_FIELD_C, &c);
  *largest = 0.0;
  for (int64_t i = 0; !s && i < sph_particles_real_count(solid->set); ++i) {
    if (phase[i] < 0 || phase[i] >= SPHI_MATERIALS || solid->speed[phase[i]] == 0.0)
      return sphi_fail(solid->base.ctx, SPH_ERR_STATE,
                       "elastodynamics: phase %d of particle %lld has no material", (int)phase[i],
                       (long long)i);
    c[i] = solid->speed[phase[i]];
    *largest = fmax(*largest, c[i]);
  }
  return s;
}

/* The corrected gradient of a surface particle is B^-1 times that of its few neighbours. */
static sph_status raise_speed(sph_elastodynamics *solid) {
  const size_t dim = (size_t)solid->options.dim;
  const size_t n = (size_t)sph_particles_real_count(solid->set);
  sph_operands a;
  double *c;
  if (!solid->options.surface_damping || !solid->options.corrected) return SPH_OK;
  sph_operands_init(&a);
  sph_status s = sphi_buffer_reserve(solid->base.ctx, &solid->scratch,
                                     sphi_mul(n, (2 * dim * dim + dim) * sizeof(double)));
  if (!s) s = sph_particles_field(solid->set, SPH_FIELD_C, &c);
  if (!s) s = sph_neighbors_build(solid->list, solid->set);
  if (!s) s = sph_operands_from_set(solid->set, &a);
  double *matrix = solid->scratch.ptr;
  if (!s) s = sph_gradient_matrix(solid->list, solid->kernel, &a, matrix, NULL, NULL);
  for (size_t i = 0; !s && i < n; ++i) {
    double trace = 0.0;
    for (size_t k = 0; k < dim; ++k) trace += matrix[i * dim * dim + k * (dim + 1)];
    c[i] *= fmax(1.0, trace / (double)dim);
  }
  return s;
}

static sph_status copy_field(sph_particles *set, int32_t from, int32_t to) {
  double *a, *b;
  sph_status s = sph_particles_field(set, from, &a);
  if (!s) s = sph_particles_field(set, to, &b);
  if (s) return s;
  const size_t components = (size_t)sph_particles_components(set, from);
  memcpy(b, a, (size_t)sph_particles_count(set) * components * sizeof *a);
  return sph_particles_touch(set, to);
}

/* A field of the set's by this name, from an earlier start if there was one. */
static sph_status named_field(sph_particles *set, const char *name, int32_t *field) {
  *field = sph_particles_find_field(set, name);
  return *field < 0 ? sph_particles_add_field(set, name, 1, field) : SPH_OK;
}

sph_status sphi_scheme_reference_fields(sph_elastodynamics *solid) {
  if (solid->options.h_law != SPH_H_LAW_DENSITY) return SPH_OK;
  sph_status s = named_field(solid->set, "h_reference", &solid->h0_field);
  return s ? s : named_field(solid->set, "rho_reference", &solid->rho0_field);
}

static double smallest(const sph_elastodynamics *solid, int32_t field) {
  const double *f = sph_particles_field_const(solid->set, field);
  double least = INFINITY;
  for (int64_t i = 0; i < sph_particles_real_count(solid->set); ++i) least = fmin(least, f[i]);
  return least;
}

static sph_status fill_fields(sph_elastodynamics *solid, double *speed) {
  double *ignored;
  sph_particles *set = solid->set;
  sph_status s = fill_spacing(solid);
  if (!s) s = check_positive(solid, SPH_FIELD_SPACING, "spacing");
  if (!s) s = check_positive(solid, SPH_FIELD_M, "mass");
  if (!s) s = check_positive(solid, SPH_FIELD_RHO, "density");
  if (!s) s = sph_particles_field(set, SPH_FIELD_V, &ignored);
  if (!s) s = sph_particles_field(set, SPH_FIELD_SIGMA, &ignored);
  if (!s) s = fill_speed(solid, speed);
  if (!s) s = sphi_scheme_h_from_spacing(solid);
  if (!s) s = copy_field(set, SPH_FIELD_X, SPH_FIELD_X0);
  if (s || solid->options.h_law != SPH_H_LAW_DENSITY) return s;
  s = sphi_scheme_reference_fields(solid);
  if (!s) s = copy_field(set, SPH_FIELD_H, solid->h0_field);
  return s ? s : copy_field(set, SPH_FIELD_RHO, solid->rho0_field);
}

sph_status sphi_scheme_extent(sph_elastodynamics *solid, double *spacing, double *speed) {
  *spacing = smallest(solid, SPH_FIELD_SPACING);
  return fill_speed(solid, speed);
}

sph_status sph_elastodynamics_start(sph_elastodynamics *solid, double t) {
  double speed;
  sph_status s = sphi_scheme_check(solid, 0);
  if (s) return s;
  if (!isfinite(t)) return sphi_fail(solid->base.ctx, SPH_ERR_ARG, "elastodynamics: time %g", t);
  if (sph_particles_real_count(solid->set) == 0)
    return sphi_fail(solid->base.ctx, SPH_ERR_STATE, "elastodynamics: the set is empty");
  solid->started = 0;
  s = fill_fields(solid, &speed);
  if (!s) s = sphi_scheme_make_parts(solid, smallest(solid, SPH_FIELD_SPACING), speed);
  if (!s) s = raise_speed(solid);
  if (s) return s;
  solid->time = t;
  solid->started = 1;
  sphi_ledger_start(solid);
  return SPH_OK;
}

static double speed_of(const sph_elastodynamics *solid, const double *v, int64_t i, int32_t phase) {
  double square = 0.0;
  for (int32_t a = 0; a < solid->options.dim; ++a)
    square += v[i * solid->options.dim + a] * v[i * solid->options.dim + a];
  return solid->speed[phase] + sqrt(square);
}

sph_status sph_elastodynamics_stable_dt(const sph_elastodynamics *solid, double *dt) {
  sph_status s = sphi_scheme_check(solid, 1);
  if (s) return s;
  if (!dt) return sphi_fail(solid->base.ctx, SPH_ERR_ARG, "elastodynamics: dt is NULL");
  const double *h = sph_particles_field_const(solid->set, SPH_FIELD_H);
  const double *v = sph_particles_field_const(solid->set, SPH_FIELD_V);
  const int32_t *phase = sph_particles_phases(solid->set);
  double least = INFINITY;
  for (int64_t i = 0; i < sph_particles_real_count(solid->set); ++i) {
    const double time = h[i] / speed_of(solid, v, i, phase[i]);
    if (!(time >= least)) least = time; /* a NaN stays */
  }
  least *= solid->options.cfl / solid->options.h_ratio;
  if (!positive(least))
    return sphi_fail(solid->base.ctx, SPH_ERR_NUMERIC, "elastodynamics: stable step %g", least);
  *dt = least;
  return SPH_OK;
}
