/* A step of stresses with the exact rotation of the frame. */
#include "material_impl.h"
#include "rotation.h"

#include <math.h>
#include <sph/elastic.h>
#include <string.h>

enum { CHUNK = 64, TENSOR = 9, PACKED = 6 };

/* Particles [at, at + n) of the caller's block, and room for what the step computes of them. */
typedef struct step {
  const sph_material *material;
  double dt;
  int32_t rotation;
  sph_material_block block; /* velocity_gradient: the strain rate; sigma: turned by half */
  double strain_rate[CHUNK * TENSOR], turned[CHUNK * PACKED], rate[CHUNK * PACKED];
  sphi_rotation half[CHUNK];
} step;

static const double *shifted(const double *array, int64_t at) {
  return array != NULL ? array + at : NULL;
}

/* With the symmetric part of L in place of L a law has no spin to rotate with. */
static void symmetric_part(int32_t d, const double *l, double *out) {
  for (int32_t a = 0; a < d; a++)
    for (int32_t b = 0; b < d; b++) out[a * d + b] = 0.5 * (l[a * d + b] + l[b * d + a]);
}

static void begin(step *s, const sph_material_block *b, int64_t at, int64_t n,
                  const double *sigma) {
  const int32_t d = b->dim, comps = d * (d + 1) / 2;
  s->block = *b;
  s->block.n = n;
  s->block.velocity_gradient = s->strain_rate;
  s->block.sigma = s->turned;
  s->block.rho = shifted(b->rho, at);
  s->block.e = shifted(b->e, at);
  s->block.deformation_gradient = shifted(b->deformation_gradient, at * d * d);
  s->block.strain = shifted(b->strain, at * comps);
  s->block.p = shifted(b->p, at);
  memcpy(s->turned, sigma + at * comps, sizeof *sigma * (size_t)(n * comps));
  for (int64_t i = 0; i < n; i++) {
    const double *l = b->velocity_gradient + (at + i) * d * d;
    symmetric_part(d, l, s->strain_rate + i * d * d);
    if (d == 1) continue;
    s->half[i] = sphi_rotation_half(sphi_rotation_of(d, l, s->dt, s->rotation));
    sphi_rotate(d, s->half[i], s->turned + i * comps);
  }
}

static sph_status advance(step *s, double *sigma, double *across) {
  const int32_t d = s->block.dim, comps = d * (d + 1) / 2;
  const int64_t n = s->block.n;
  double aside[CHUNK];
  sph_status status = sphi_material_stress_rate_quiet(s->material, &s->block, s->rate);
  if (status == SPH_OK && across != NULL)
    status = sphi_material_evaluate_quiet(s->material, SPHI_MATERIAL_STRESS_RATE_ACROSS, &s->block,
                                          aside);
  if (status != SPH_OK) return status;
  for (int64_t i = 0; i < n; i++) {
    double *stress = sigma + i * comps;
    for (int32_t c = 0; c < comps; c++)
      stress[c] = s->turned[i * comps + c] + s->dt * s->rate[i * comps + c];
    sphi_rotate(d, s->half[i], stress);
    if (across != NULL) across[i] += s->dt * aside[i];
  }
  return SPH_OK;
}

static sph_status check(const sph_material *m, const sph_material_block *b, double dt,
                        int32_t rotation, const double *sigma, const double *across) {
  sph_context *ctx = m->object.ctx;
  if (sigma == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "stress_update: sigma is NULL");
  sph_status status = sphi_material_check_block(m, SPHI_MATERIAL_STRESS_RATE, b);
  if (status == SPH_OK && across != NULL)
    status = sphi_material_check_block(m, SPHI_MATERIAL_STRESS_RATE_ACROSS, b);
  if (status != SPH_OK) return status;
  if (b->n > 0 && b->velocity_gradient == NULL)
    return sphi_fail(ctx, SPH_ERR_ARG, "stress_update: velocity_gradient is NULL");
  if (!isfinite(dt)) return sphi_fail(ctx, SPH_ERR_ARG, "stress_update: dt = %g", dt);
  if (rotation != SPH_ROTATION_EXPONENTIAL && rotation != SPH_ROTATION_CAYLEY)
    return sphi_fail(ctx, SPH_ERR_ARG, "stress_update: unknown rotation %d", (int)rotation);
  return SPH_OK;
}

sph_status sph_material_stress_update(const sph_material *material, const sph_material_block *block,
                                      double dt, int32_t rotation, double *sigma, double *across) {
  sph_status status = sphi_check_handle(NULL, material, SPHI_MAGIC_MATERIAL, "material");
  if (status != SPH_OK) return status;
  sph_context *ctx = material->object.ctx;
  if (block == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "stress_update: the block is NULL");
  sph_material_block b = {.size = sizeof b};
  status = sphi_options_read(ctx, &b, sizeof b, block);
  if (status != SPH_OK) return status;
  b.sigma = sigma;
  status = check(material, &b, dt, rotation, sigma, across);
  if (status != SPH_OK) return status;
  step s = {.material = material, .dt = dt, .rotation = rotation};
  const int32_t comps = b.dim * (b.dim + 1) / 2;
  for (int64_t at = 0; at < b.n && status == SPH_OK; at += CHUNK) {
    begin(&s, &b, at, b.n - at < CHUNK ? b.n - at : CHUNK, sigma);
    status = advance(&s, sigma + at * comps, across != NULL ? across + at : NULL);
    if (status != SPH_OK)
      return sphi_material_explain(material, SPHI_MATERIAL_STRESS_RATE, &s.block, at, status);
  }
  return SPH_OK;
}
