/* Isotropic linear elasticity in rate form, with the Jaumann rate.
 *
 * In every reduction the rate of the stored components is
 *     sigma'_aa = stiff * L_aa + cross * (sum of the other L_bb),   sigma'_ab = G (L_ab + L_ba)
 * and only `stiff` and `cross` differ. */
#include "material_impl.h"

#include <math.h>

typedef struct hooke {
  sph_context *ctx;
  double stiff, cross, shear;
  double sound_speed;
  int32_t jaumann;
} hooke;

void sph_hooke_options_init_sized(sph_hooke_options *options, size_t size) {
  const sph_hooke_options defaults = {
      .size = sizeof defaults, .reduction = SPH_UNIAXIAL_STRESS, .jaumann = 1};
  sphi_material_init_sized(options, size, &defaults, sizeof defaults);
}

static int32_t reduction_dim(int32_t reduction) {
  switch (reduction) {
  case SPH_UNIAXIAL_STRESS:
  case SPH_UNIAXIAL_STRAIN:
    return 1;
  case SPH_PLANE_STRESS:
  case SPH_PLANE_STRAIN:
    return 2;
  case SPH_SOLID:
    return 3;
  default:
    return 0;
  }
}

static void set_moduli(hooke *law, const sph_hooke_options *o) {
  const double e = o->young, nu = o->poisson;
  law->shear = e / (2 * (1 + nu));
  if (o->reduction == SPH_UNIAXIAL_STRESS) {
    law->stiff = e;
    law->cross = 0;
  } else if (o->reduction == SPH_PLANE_STRESS) {
    law->stiff = e / ((1 - nu) * (1 + nu));
    law->cross = nu * law->stiff;
  } else { /* no strain across: lambda + 2 mu and lambda */
    law->cross = e * nu / ((1 + nu) * (1 - 2 * nu));
    law->stiff = law->cross + 2 * law->shear;
  }
  law->sound_speed = sqrt(law->stiff / o->density);
}

static void rate_1d(const hooke *law, const sph_material_block *b, double *rate) {
  for (int64_t i = 0; i < b->n; i++) rate[i] = law->stiff * b->velocity_gradient[i];
}

static void elastic_2d(const hooke *law, const double l[4], double r[3]) {
  r[0] = law->stiff * l[0] + law->cross * l[3];
  r[1] = law->stiff * l[3] + law->cross * l[0];
  r[2] = law->shear * (l[1] + l[2]);
}

/* r += omega s - s omega */
static void rotate_2d(const double l[4], const double s[3], double r[3]) {
  const double w = 0.5 * (l[1] - l[2]);
  r[0] += 2 * w * s[2];
  r[1] -= 2 * w * s[2];
  r[2] += w * (s[1] - s[0]);
}

static void rate_2d(const hooke *law, const sph_material_block *b, double *rate) {
  for (int64_t i = 0; i < b->n; i++) {
    double r[3]; /* so that `rate` may be the array of the stress */
    elastic_2d(law, b->velocity_gradient + 4 * i, r);
    if (law->jaumann) rotate_2d(b->velocity_gradient + 4 * i, b->sigma + 3 * i, r);
    for (int32_t c = 0; c < 3; c++) rate[3 * i + c] = r[c];
  }
}

static void elastic_3d(const hooke *law, const double l[9], double r[6]) {
  r[0] = law->stiff * l[0] + law->cross * (l[4] + l[8]);
  r[1] = law->stiff * l[4] + law->cross * (l[0] + l[8]);
  r[2] = law->stiff * l[8] + law->cross * (l[0] + l[4]);
  r[3] = law->shear * (l[1] + l[3]);
  r[4] = law->shear * (l[2] + l[6]);
  r[5] = law->shear * (l[5] + l[7]);
}

/* r += omega s - s omega, written out for s = {xx, yy, zz, xy, xz, yz} */
static void rotate_3d(const double l[9], const double s[6], double r[6]) {
  const double xy = 0.5 * (l[1] - l[3]), xz = 0.5 * (l[2] - l[6]), yz = 0.5 * (l[5] - l[7]);
  r[0] += 2 * (xy * s[3] + xz * s[4]);
  r[1] += 2 * (yz * s[5] - xy * s[3]);
  r[2] -= 2 * (xz * s[4] + yz * s[5]);
  r[3] += xy * (s[1] - s[0]) + xz * s[5] + yz * s[4];
  r[4] += xz * (s[2] - s[0]) + xy * s[5] - yz * s[3];
  r[5] += yz * (s[2] - s[1]) - xy * s[4] - xz * s[3];
}

static void rate_3d(const hooke *law, const sph_material_block *b, double *rate) {
  for (int64_t i = 0; i < b->n; i++) {
    double r[6]; /* so that `rate` may be the array of the stress */
    elastic_3d(law, b->velocity_gradient + 9 * i, r);
    if (law->jaumann) rotate_3d(b->velocity_gradient + 9 * i, b->sigma + 6 * i, r);
    for (int32_t c = 0; c < 6; c++) rate[6 * i + c] = r[c];
  }
}

static int32_t hooke_stress_rate(void *user, const sph_material_block *b, double *rate) {
  const hooke *law = user;
  if (b->dim == 1)
    rate_1d(law, b, rate);
  else if (b->dim == 2)
    rate_2d(law, b, rate);
  else
    rate_3d(law, b, rate);
  return 0;
}

static int32_t hooke_sound_speed(void *user, const sph_material_block *b, double *c) {
  const hooke *law = user;
  for (int64_t i = 0; i < b->n; i++) c[i] = law->sound_speed;
  return 0;
}

static void hooke_destroy(void *user) {
  hooke *law = user;
  sphi_free(law->ctx, law, sizeof *law);
}

static sph_status check_options(sph_context *ctx, const sph_hooke_options *o) {
  if (!(o->young > 0) || !isfinite(o->young))
    return sphi_fail(ctx, SPH_ERR_ARG, "hooke: young = %g is not positive and finite", o->young);
  if (!(o->poisson > -1 && o->poisson < 0.5))
    return sphi_fail(ctx, SPH_ERR_ARG, "hooke: poisson = %g is outside (-1, 0.5)", o->poisson);
  if (!(o->density > 0) || !isfinite(o->density))
    return sphi_fail(ctx, SPH_ERR_ARG, "hooke: density = %g is not positive and finite",
                     o->density);
  if (reduction_dim(o->reduction) == 0)
    return sphi_fail(ctx, SPH_ERR_ARG, "hooke: unknown reduction %d", (int)o->reduction);
  return SPH_OK;
}

static sph_status make(sph_context *ctx, const sph_hooke_options *o, sph_material **out) {
  hooke *law = sphi_calloc(ctx, sizeof *law);
  if (law == NULL) return SPH_ERR_NOMEM;
  law->ctx = ctx;
  law->jaumann = o->jaumann != 0 && reduction_dim(o->reduction) > 1;
  set_moduli(law, o);
  const sph_material_functions f = {.size = sizeof f,
                                    .stress_rate = hooke_stress_rate,
                                    .sound_speed = hooke_sound_speed,
                                    .destroy = hooke_destroy};
  sph_status status = sphi_material_make(ctx, &f, law, out);
  if (status != SPH_OK) {
    sphi_free(ctx, law, sizeof *law);
    return status;
  }
  (*out)->dim = reduction_dim(o->reduction);
  (*out)->needs[SPHI_MATERIAL_STRESS_RATE] =
      SPHI_NEEDS_GRADIENT | (law->jaumann ? (uint32_t)SPHI_NEEDS_SIGMA : 0u);
  return SPH_OK;
}

sph_status sph_material_create_hooke(sph_context *ctx, const sph_hooke_options *options,
                                     sph_material **out) {
  if (out != NULL) *out = NULL;
  sph_status status = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (status != SPH_OK) return status;
  if (out == NULL || options == NULL)
    return sphi_fail(ctx, SPH_ERR_ARG, "hooke: %s is NULL", out == NULL ? "out" : "options");
  sph_hooke_options o = {.size = 0};
  sph_hooke_options_init(&o);
  status = sphi_options_read(ctx, &o, sizeof o, options);
  if (status == SPH_OK) status = check_options(ctx, &o);
  return status == SPH_OK ? make(ctx, &o, out) : status;
}
