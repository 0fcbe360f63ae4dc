/* Isotropic linear elasticity in rate form, with the Jaumann rate, and in total form. */
#include "elastic_impl.h"

#include <math.h>

typedef struct hooke {
  sph_context *ctx;
  sphi_moduli moduli;
  double density;
  int32_t jaumann;
} hooke;

void sph_hooke_options_init_sized(sph_hooke_options *options, size_t size) {
  const sph_hooke_options defaults = {
      .size = sizeof defaults, .reduction = SPH_UNIAXIAL_STRESS, .jaumann = 1};
  sphi_material_init_sized(options, size, &defaults, sizeof defaults);
}

static int32_t hooke_stress_rate(void *user, const sph_material_block *b, double *rate) {
  const hooke *law = user;
  sphi_elastic_rate(&law->moduli, law->jaumann, b, rate);
  return 0;
}

static int32_t hooke_rate_across(void *user, const sph_material_block *b, double *rate) {
  const hooke *law = user;
  sphi_elastic_rate_across(&law->moduli, b, rate);
  return 0;
}

static int32_t hooke_sound_speed(void *user, const sph_material_block *b, double *c) {
  const hooke *law = user;
  for (int64_t i = 0; i < b->n; i++) c[i] = sqrt(law->moduli.stiff / law->density);
  return 0;
}

static int32_t hooke_shear_speed(void *user, const sph_material_block *b, double *c) {
  const hooke *law = user;
  for (int64_t i = 0; i < b->n; i++) c[i] = sqrt(law->moduli.shear / law->density);
  return 0;
}

/* ---- total form for small strains ---- */

/* sigma = stiff, cross and 2G on the packed strain of one particle; `sigma` may be `strain` */
static void total(const sphi_moduli *m, int32_t d, const double *strain, double *sigma) {
  double trace = 0;
  for (int32_t a = 0; a < d; a++) trace += strain[a];
  for (int32_t c = 0; c < d * (d + 1) / 2; c++)
    sigma[c] =
        c < d ? m->stiff * strain[c] + m->cross * (trace - strain[c]) : 2 * m->shear * strain[c];
}

static int32_t hooke_small_strain_stress(void *user, const sph_material_block *b, double *sigma) {
  const hooke *law = user;
  const int32_t comps = b->dim * (b->dim + 1) / 2;
  for (int64_t i = 0; i < b->n; i++)
    total(&law->moduli, b->dim, b->strain + i * comps, sigma + i * comps);
  return 0;
}

/* (F + F^T)/2 - I, packed */
static void small_strain(int32_t d, const double *f, double *strain) {
  for (int32_t a = 0; a < d; a++) strain[a] = f[a * (d + 1)] - 1;
  if (d == 2) strain[2] = 0.5 * (f[1] + f[2]);
  if (d < 3) return;
  strain[3] = 0.5 * (f[1] + f[3]);
  strain[4] = 0.5 * (f[2] + f[6]);
  strain[5] = 0.5 * (f[5] + f[7]);
}

static int32_t hooke_cauchy(void *user, const sph_material_block *b, double *sigma) {
  const hooke *law = user;
  const int32_t d = b->dim, comps = d * (d + 1) / 2;
  for (int64_t i = 0; i < b->n; i++) {
    double strain[6];
    small_strain(d, b->deformation_gradient + i * d * d, strain);
    total(&law->moduli, d, strain, sigma + i * comps);
  }
  return 0;
}

static int32_t hooke_first_piola(void *user, const sph_material_block *b, double *p,
                                 double *energy) {
  static const int32_t at[4][9] = {{0}, {0}, {0, 2, 2, 1}, {0, 3, 4, 3, 1, 5, 4, 5, 2}};
  const hooke *law = user;
  const int32_t d = b->dim;
  for (int64_t i = 0; i < b->n; i++) {
    double strain[6], s[6], psi = 0;
    small_strain(d, b->deformation_gradient + i * d * d, strain);
    total(&law->moduli, d, strain, s);
    for (int32_t k = 0; k < d * d; k++) {
      p[i * d * d + k] = s[at[d][k]];
      psi += 0.5 * s[at[d][k]] * strain[at[d][k]];
    }
    if (energy != NULL) energy[i] = psi;
  }
  return 0;
}

static void hooke_destroy(void *user) {
  hooke *law = user;
  sphi_free(law->ctx, law, sizeof *law);
}

static sph_status make(sph_context *ctx, const sph_hooke_options *o, sph_material **out) {
  hooke *law = sphi_calloc(ctx, sizeof *law);
  if (law == NULL) return SPH_ERR_NOMEM;
  law->ctx = ctx;
  law->jaumann = o->jaumann != 0 && sphi_reduction_dim(o->reduction) > 1;
  law->moduli = sphi_moduli_of(o->young, o->poisson, o->reduction);
  law->density = o->density;
  const sph_material_functions f = {.size = sizeof f,
                                    .stress_rate = hooke_stress_rate,
                                    .sound_speed = hooke_sound_speed,
                                    .shear_speed = hooke_shear_speed,
                                    .stress_rate_across =
                                        o->reduction == SPH_SOLID ? NULL : hooke_rate_across,
                                    .small_strain_stress = hooke_small_strain_stress,
                                    .first_piola = hooke_first_piola,
                                    .cauchy_stress = hooke_cauchy,
                                    .destroy = hooke_destroy};
  sph_status status = sphi_material_make(ctx, &f, law, out);
  if (status != SPH_OK) {
    sphi_free(ctx, law, sizeof *law);
    return status;
  }
  (*out)->dim = sphi_reduction_dim(o->reduction);
  (*out)->needs[SPHI_MATERIAL_STRESS_RATE] =
      SPHI_NEEDS_GRADIENT | (law->jaumann ? (uint32_t)SPHI_NEEDS_SIGMA : 0u);
  (*out)->needs[SPHI_MATERIAL_STRESS_RATE_ACROSS] = SPHI_NEEDS_GRADIENT;
  (*out)->needs[SPHI_MATERIAL_SMALL_STRAIN_STRESS] = SPHI_NEEDS_STRAIN;
  (*out)->needs[SPHI_MATERIAL_FIRST_PIOLA] = SPHI_NEEDS_F;
  (*out)->needs[SPHI_MATERIAL_CAUCHY_STRESS] = SPHI_NEEDS_F;
  return SPH_OK;
}

sph_status sph_material_create_hooke(sph_context *ctx, const sph_hooke_options *options,
                                     sph_material **out) {
  sph_hooke_options o = {.size = 0};
  sph_hooke_options_init(&o);
  sph_status status = sphi_material_begin(ctx, "hooke", &o, sizeof o, options, out);
  if (status == SPH_OK)
    status = sphi_elastic_check(ctx, "hooke", o.young, o.poisson, o.density, o.reduction);
  return status == SPH_OK ? make(ctx, &o, out) : status;
}
