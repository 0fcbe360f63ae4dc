/* Constants of materials from the literature, in SI units. */
#include "material_impl.h"

#include <sph/eos.h>
#include <stddef.h>

/* Zisis 2017, table 6.1. The yield stress of the last follows from its rule (eos.h). */
static const struct {
  double density, sound_speed, slope, gruneisen, shear, yield;
} gruneisen[] = {[SPH_ALUMINIUM_1000] = {2710, 5300, 1.500, 1.7, 25.0e9, 0.550e9},
                 [SPH_ALUMINIUM_2024] = {2785, 5330, 1.338, 2.0, 27.1e9, 0.265e9},
                 [SPH_LEAD] = {11360, 2030, 1.470, 2.6, 8.6e9, 0.090e9},
                 [SPH_COPPER] = {8930, 3900, 1.500, 2.0, 46.0e9, 0.045e9},
                 [SPH_EPOXY] = {2280, 2930, 1.630, 1.0, 0.6e9, 0.050e9},
                 [SPH_HOMOGENISED] = {2659, 4730, 1.411, 1.75, 20.5e9, 0.211e9}};

/* Melosh 1989, table AII.3; Benz, Asphaug 1999, table II. */
static const sph_tillotson_options tillotson[] = {
    [SPH_TILLOTSON_ALUMINIUM] = {0, 2700, 0.5, 1.63, 75.2e9, 65.0e9, 5, 5, 5.0e6, 3.00e6, 13.9e6, 0,
                                 0},
    [SPH_TILLOTSON_IRON] = {0, 7800, 0.5, 1.5, 128e9, 105e9, 5, 5, 9.5e6, 2.40e6, 8.67e6, 0, 0},
    [SPH_TILLOTSON_BASALT] = {0, 2700, 0.5, 1.5, 26.7e9, 26.7e9, 5, 5, 487e6, 4.72e6, 18.2e6, 0, 0},
    [SPH_TILLOTSON_ICE] = {0, 917, 0.3, 0.1, 9.47e9, 9.47e9, 10, 5, 10e6, 0.773e6, 3.04e6, 0, 0},
    [SPH_TILLOTSON_GRANITE] = {0, 2680, 0.5, 1.3, 18.0e9, 18.0e9, 5, 5, 16e6, 3.50e6, 18.0e6, 0,
                               0}};

sph_status sph_mie_gruneisen_constants(int32_t material, sph_mie_gruneisen_options *eos,
                                       sph_strength_options *strength) {
  if (material < SPH_ALUMINIUM_1000 || material > SPH_HOMOGENISED) return SPH_ERR_ARG;
  if (eos == NULL && strength == NULL) return SPH_ERR_ARG;
  if (eos != NULL && eos->size < offsetof(sph_mie_gruneisen_options, curve)) return SPH_ERR_ARG;
  if (strength != NULL && strength->size < offsetof(sph_strength_options, hardening))
    return SPH_ERR_ARG;
  if (eos != NULL) {
    eos->density = gruneisen[material].density;
    eos->sound_speed = gruneisen[material].sound_speed;
    eos->slope = gruneisen[material].slope;
    eos->gruneisen = gruneisen[material].gruneisen;
  }
  if (strength != NULL) {
    strength->shear = gruneisen[material].shear;
    strength->yield = gruneisen[material].yield;
  }
  return SPH_OK;
}

sph_status sph_tillotson_constants(int32_t material, sph_tillotson_options *eos) {
  if (material < SPH_TILLOTSON_ALUMINIUM || material > SPH_TILLOTSON_GRANITE) return SPH_ERR_ARG;
  if (eos == NULL || eos->size < offsetof(sph_tillotson_options, minimum_pressure))
    return SPH_ERR_ARG;
  const sph_tillotson_options *t = &tillotson[material];
  eos->density = t->density;
  eos->a = t->a;
  eos->b = t->b;
  eos->A = t->A;
  eos->B = t->B;
  eos->alpha = t->alpha;
  eos->beta = t->beta;
  eos->e0 = t->e0;
  eos->e_iv = t->e_iv;
  eos->e_cv = t->e_cv;
  return SPH_OK;
}
