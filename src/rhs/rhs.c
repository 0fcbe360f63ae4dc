/* Composed right-hand side: creation, terms, materials, hooks. */
#include "rhs_impl.h"

#include <math.h>
#include <string.h>

void sph_rhs_options_init_sized(sph_rhs_options *options, size_t size) {
  sph_rhs_options defaults = {
      .size = sizeof defaults, .position_field = SPH_FIELD_X, .update_list = 1};
  if (!options || size < sizeof(size_t)) return;
  memset(options, 0, size);
  memcpy(options, &defaults, size < sizeof defaults ? size : sizeof defaults);
  options->size = size;
}

void sph_term_init_sized(sph_term *term, size_t size) {
  sph_term defaults = {.size = sizeof defaults, .power = 4};
  if (!term || size < sizeof(size_t)) return;
  memset(term, 0, size);
  memcpy(term, &defaults, size < sizeof defaults ? size : sizeof defaults);
  term->size = size;
}

static sph_status read_options(sph_context *ctx, const sph_rhs_options *options,
                               sph_rhs_options *own) {
  sph_rhs_options_init(own);
  sph_status s = sphi_options_read(ctx, own, sizeof *own, options);
  if (s) return s;
  if (own->position_field != SPH_FIELD_X && own->position_field != SPH_FIELD_X0)
    return sphi_fail(ctx, SPH_ERR_ARG, "sph_rhs_create: position_field %d is neither X nor X0",
                     own->position_field);
  return SPH_OK;
}

sph_status sph_rhs_create(sph_context *ctx, sph_kernel *kernel, const sph_rhs_options *options,
                          sph_rhs **out) {
  sph_rhs_options own;
  if (!out) return SPH_ERR_ARG;
  *out = NULL;
  sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (!s) s = sphi_check_handle(ctx, kernel, SPHI_MAGIC_KERNEL, "kernel");
  if (!s) s = read_options(ctx, options, &own);
  if (s) return s;
  sph_rhs *rhs = sphi_calloc(ctx, sizeof *rhs);
  if (!rhs) return SPH_ERR_NOMEM;
  rhs->base.magic = SPHI_MAGIC_RHS;
  rhs->base.ctx = ctx;
  rhs->kernel = kernel;
  rhs->options = own;
  sphi_context_retain(ctx);
  sphi_kernel_retain(kernel);
  *out = rhs;
  return SPH_OK;
}

void sph_rhs_destroy(sph_rhs *rhs) {
  if (sphi_check_handle(NULL, rhs, SPHI_MAGIC_RHS, "rhs")) return;
  sph_context *ctx = rhs->base.ctx;
  for (int32_t p = 0; p < SPHI_PHASES; ++p)
    if (rhs->materials[p]) sphi_material_release(rhs->materials[p]);
  for (int32_t k = 0; k < SPHI_RHS_SCRATCH; ++k) sphi_buffer_free(ctx, &rhs->scratch[k]);
  sphi_kernel_release(rhs->kernel);
  rhs->base.magic = 0;
  sphi_free(ctx, rhs, sizeof *rhs);
  sphi_context_release(ctx);
}

/* Largest form of a kind; 0 where it has none. */
static int32_t last_form(int32_t kind) {
  switch (kind) {
  case SPH_TERM_CONTINUITY:
    return SPH_CONTINUITY_NUMBER;
  case SPH_TERM_PRESSURE:
    return SPH_PRESSURE_DIFFERENCE;
  case SPH_TERM_STRESS:
    return SPH_STRESS_CONSERVATIVE;
  case SPH_TERM_STRESS_RATE:
    return SPH_STRESS_RATE_LAGRANGIAN;
  case SPH_TERM_MONAGHAN:
    return SPH_MONAGHAN_CURRENT;
  case SPH_TERM_FIRST_PIOLA:
    return SPH_PIOLA_SUMMED;
  case SPH_TERM_HOURGLASS:
    return SPH_HOURGLASS_CENTRAL;
  case SPH_TERM_SMOOTHED:
    return SPH_SMOOTHING_NUMBER;
  default:
    return 0;
  }
}

static int can_be_corrected(const sph_term *t) {
  if (t->kind == SPH_TERM_STRESS) return t->form != SPH_STRESS_CONSERVATIVE;
  if (t->kind == SPH_TERM_FIRST_PIOLA) return t->form == SPH_PIOLA_SUMMED;
  if (sphi_term_frozen(t)) return 0;
  return t->kind == SPH_TERM_CONTINUITY || t->kind == SPH_TERM_PRESSURE ||
         t->kind == SPH_TERM_STRESS_RATE || t->kind == SPH_TERM_MONAGHAN ||
         t->kind == SPH_TERM_BULK_VISCOSITY || t->kind == SPH_TERM_ARTIFICIAL_STRESS;
}

/* W(dp) divides: dp must lie within the support. */
static int has_spacing(const sph_kernel *kernel, double ratio) {
  double w = 0.0, dw;
  if (ratio > 0.0 && ratio < kernel->support) sphi_kernel_profile(kernel, ratio, &w, &dw);
  return w != 0.0;
}

static sph_status check_numbers(sph_context *ctx, const sph_kernel *kernel, const sph_term *t) {
  if (!isfinite(t->alpha) || !isfinite(t->beta) || !isfinite(t->epsilon) || !isfinite(t->neumann) ||
      !isfinite(t->linear) || !isfinite(t->spacing) || !isfinite(t->vector[0]) ||
      !isfinite(t->vector[1]) || !isfinite(t->vector[2]))
    return sphi_fail(ctx, SPH_ERR_ARG, "sph_rhs_add: a parameter of term %d is not finite",
                     t->kind);
  if (t->kind == SPH_TERM_HOURGLASS && t->alpha < 0.0)
    return sphi_fail(ctx, SPH_ERR_ARG, "sph_rhs_add: hourglass control with alpha %g", t->alpha);
  if (t->kind == SPH_TERM_BULK_VISCOSITY && (t->neumann != 0.0 || t->linear != 0.0) &&
      !(t->spacing > 0.0))
    return sphi_fail(ctx, SPH_ERR_ARG, "sph_rhs_add: bulk viscosity with spacing %g", t->spacing);
  if (t->kind == SPH_TERM_ARTIFICIAL_STRESS &&
      (!has_spacing(kernel, t->spacing_ratio) || t->power < 1 || t->power > 16))
    return sphi_fail(ctx, SPH_ERR_ARG,
                     "sph_rhs_add: artificial stress, spacing_ratio %g (support %g), power %d",
                     t->spacing_ratio, kernel->support, t->power);
  return SPH_OK;
}

static sph_status check_term(sph_rhs *rhs, sph_term *t) {
  sph_context *ctx = rhs->base.ctx;
  if (t->kind < 1 || t->kind > SPHI_MAX_TERM)
    return sphi_fail(ctx, SPH_ERR_ARG, "sph_rhs_add: unknown kind %d", t->kind);
  if (rhs->terms[t->kind].kind)
    return sphi_fail(ctx, SPH_ERR_ARG, "sph_rhs_add: kind %d is there already", t->kind);
  if (t->form < 0 || t->form > last_form(t->kind))
    return sphi_fail(ctx, SPH_ERR_ARG, "sph_rhs_add: kind %d has no form %d", t->kind, t->form);
  if (t->form == 0) t->form = 1;
  if (t->corrected && !can_be_corrected(t))
    return sphi_fail(ctx, SPH_ERR_ARG, "sph_rhs_add: kind %d, form %d has no corrected gradient",
                     t->kind, t->form);
  if (sphi_term_frozen(t) && rhs->options.position_field != SPH_FIELD_X0)
    return sphi_fail(ctx, SPH_ERR_ARG,
                     "sph_rhs_add: kind %d, form %d needs a right-hand side with position_field X0",
                     t->kind, t->form);
  return check_numbers(ctx, rhs->kernel, t);
}

sph_status sph_rhs_add(sph_rhs *rhs, const sph_term *term) {
  sph_term own;
  sph_dissipation dissipation;
  sph_status s = sphi_check_handle(NULL, rhs, SPHI_MAGIC_RHS, "rhs");
  if (s) return s;
  if (!term) return sphi_fail(rhs->base.ctx, SPH_ERR_ARG, "sph_rhs_add: the term is NULL");
  sph_term_init(&own);
  s = sphi_options_read(rhs->base.ctx, &own, sizeof own, term);
  if (!s) s = check_term(rhs, &own);
  if (!s && own.kind == SPH_TERM_DISSIPATION)
    s = sphi_dissipation_read(rhs->base.ctx, own.dissipation, "sph_rhs_add", &dissipation);
  if (s) return s;
  if (own.kind == SPH_TERM_DISSIPATION) rhs->dissipation = dissipation;
  own.dissipation = NULL; /* the host's */
  rhs->terms[own.kind] = own;
  return SPH_OK;
}

sph_status sph_rhs_add_host(sph_rhs *rhs, int32_t field, sph_pair_fn fn, void *user) {
  sph_status s = sphi_check_handle(NULL, rhs, SPHI_MAGIC_RHS, "rhs");
  if (s) return s;
  if (!fn) return sphi_fail(rhs->base.ctx, SPH_ERR_ARG, "sph_rhs_add_host: fn is NULL");
  if (field < 0) return sphi_fail(rhs->base.ctx, SPH_ERR_ARG, "sph_rhs_add_host: field %d", field);
  if (rhs->host_count == SPHI_MAX_HOST_TERMS)
    return sphi_fail(rhs->base.ctx, SPH_ERR_LIMIT, "sph_rhs_add_host: more than %d host terms",
                     SPHI_MAX_HOST_TERMS);
  rhs->host[rhs->host_count++] = (sphi_host_term){field, fn, user};
  return SPH_OK;
}

sph_status sph_rhs_set_material(sph_rhs *rhs, int32_t phase, sph_material *material) {
  sph_status s = sphi_check_handle(NULL, rhs, SPHI_MAGIC_RHS, "rhs");
  if (s) return s;
  if (phase < 0 || phase >= SPHI_PHASES)
    return sphi_fail(rhs->base.ctx, SPH_ERR_ARG, "sph_rhs_set_material: phase %d", phase);
  if (material) {
    s = sphi_check_handle(rhs->base.ctx, material, SPHI_MAGIC_MATERIAL, "material");
    if (s) return s;
    sphi_material_retain(material);
  }
  if (rhs->materials[phase]) sphi_material_release(rhs->materials[phase]);
  rhs->material_count += (material != NULL) - (rhs->materials[phase] != NULL);
  rhs->materials[phase] = material;
  return SPH_OK;
}

sph_status sph_rhs_set_prepare(sph_rhs *rhs, sph_rhs_hook fn, void *user) {
  sph_status s = sphi_check_handle(NULL, rhs, SPHI_MAGIC_RHS, "rhs");
  if (s) return s;
  rhs->prepare = fn;
  rhs->prepare_user = user;
  return SPH_OK;
}

sph_status sph_rhs_set_finish(sph_rhs *rhs, sph_rhs_hook fn, void *user) {
  sph_status s = sphi_check_handle(NULL, rhs, SPHI_MAGIC_RHS, "rhs");
  if (s) return s;
  rhs->finish = fn;
  rhs->finish_user = user;
  return SPH_OK;
}
