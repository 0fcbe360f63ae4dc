/* Equations of state: loops over particles, ranges, the handle. */
#include "eos_impl.h"

#include <math.h>
#include <stdio.h>

static double energy_of(const sphi_eos *law, const sph_material_block *b, int64_t i) {
  return law->barotropic ? 0 : b->e[i];
}

/* With the tension cut-off: below it nothing changes any more. */
static sphi_eos_state state_of(const sphi_eos *law, const sph_material_block *b, int64_t i) {
  const sphi_eos_state s = law->state(law, b->rho[i], energy_of(law, b, i));
  if (s.p < law->minimum_pressure) return (sphi_eos_state){.p = law->minimum_pressure};
  return s;
}

static int32_t eos_pressure(void *user, const sph_material_block *b, double *p) {
  for (int64_t i = 0; i < b->n; i++) p[i] = state_of(user, b, i).p;
  return 0;
}

/* c^2 = dp/drho + p/rho^2 dp/de, not below the floor */
static int32_t eos_sound_speed(void *user, const sph_material_block *b, double *c) {
  const sphi_eos *law = user;
  for (int64_t i = 0; i < b->n; i++) {
    const sphi_eos_state s = state_of(law, b, i);
    c[i] = sqrt(fmax(s.dp_drho + s.p / b->rho[i] * (s.dp_de / b->rho[i]), law->floor2));
  }
  return 0;
}

static int32_t eos_derivatives(void *user, const sph_material_block *b, double *dp_drho,
                               double *dp_de) {
  for (int64_t i = 0; i < b->n; i++) {
    const sphi_eos_state s = state_of(user, b, i);
    if (dp_drho != NULL) dp_drho[i] = s.dp_drho;
    if (dp_de != NULL) dp_de[i] = s.dp_de;
  }
  return 0;
}

static int32_t eos_energy(void *user, const sph_material_block *b, double *e) {
  const sphi_eos *law = user;
  for (int64_t i = 0; i < b->n; i++)
    e[i] = law->energy(law, b->rho[i], law->barotropic ? 0 : b->p[i]);
  return 0;
}

static int32_t eos_temperature(void *user, const sph_material_block *b, double *temperature) {
  const sphi_eos *law = user;
  for (int64_t i = 0; i < b->n; i++) temperature[i] = law->temperature(law, b->rho[i], b->e[i]);
  return 0;
}

/* ---- ranges ---- */

static void say(char *text, size_t room, const char *what, double value, const char *should) {
  if (text != NULL) (void)snprintf(text, room, "%s %g is not %s", what, value, should);
}

static int refuses(const sphi_eos *law, int32_t property, const sph_material_block *b, int64_t i,
                   char *text, size_t room) {
  const double rho = b->rho[i];
  const int inverse = property == SPHI_MATERIAL_ENERGY;
  if (!(rho > 0) || !isfinite(rho)) {
    say(text, room, "density", rho, "positive and finite");
    return 1;
  }
  const double other = law->barotropic ? 0 : inverse ? b->p[i] : b->e[i];
  if (!isfinite(other)) {
    say(text, room, inverse ? "pressure" : "energy", other, "finite");
    return 1;
  }
  if (inverse)
    return law->refuse_pressure != NULL && law->refuse_pressure(law, rho, other, text, room);
  return law->refuse != NULL && law->refuse(law, rho, other, text, room);
}

static int64_t eos_examine(const void *user, int32_t property, const sph_material_block *b,
                           char *text, size_t room) {
  for (int64_t i = 0; i < b->n; i++)
    if (refuses(user, property, b, i, text, room)) return i;
  return -1;
}

/* ---- the handle ---- */

static void eos_destroy(void *user) {
  sphi_eos *law = user;
  sphi_free(law->ctx, law, sizeof *law);
}

static void set_needs(sph_material *m, const sphi_eos *law) {
  const uint32_t direct = SPHI_NEEDS_RHO | (law->barotropic ? 0u : (uint32_t)SPHI_NEEDS_E);
  m->examine = eos_examine;
  m->needs[SPHI_MATERIAL_PRESSURE] = direct;
  m->needs[SPHI_MATERIAL_SOUND_SPEED] = direct;
  m->needs[SPHI_MATERIAL_PRESSURE_DERIVATIVES] = direct;
  m->needs[SPHI_MATERIAL_TEMPERATURE] = direct;
  m->needs[SPHI_MATERIAL_ENERGY] = SPHI_NEEDS_RHO | (law->barotropic ? 0u : (uint32_t)SPHI_NEEDS_P);
}

sph_status sphi_eos_make(sph_context *ctx, const sphi_eos *law, sph_material **out) {
  sphi_eos *copy = sphi_calloc(ctx, sizeof *copy);
  if (copy == NULL) return SPH_ERR_NOMEM;
  *copy = *law;
  copy->ctx = ctx;
  const sph_material_functions f = {.size = sizeof f,
                                    .pressure = eos_pressure,
                                    .sound_speed = eos_sound_speed,
                                    .pressure_derivatives = eos_derivatives,
                                    .energy = eos_energy,
                                    .temperature =
                                        law->temperature != NULL ? eos_temperature : NULL,
                                    .destroy = eos_destroy};
  sph_status status = sphi_material_make(ctx, &f, copy, out);
  if (status != SPH_OK) {
    eos_destroy(copy);
    return status;
  }
  set_needs(*out, copy);
  return SPH_OK;
}

sph_status sphi_eos_not_negative(sph_context *ctx, const char *law, const char *name,
                                 double value) {
  if (value >= 0 && isfinite(value)) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_ARG, "%s: %s = %g is negative or not finite", law, name, value);
}

sph_status sphi_eos_check_limits(sph_context *ctx, const char *law, double minimum_pressure,
                                 double sound_floor) {
  if (!(minimum_pressure < INFINITY))
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: minimum_pressure = %g", law, minimum_pressure);
  if (!(sound_floor >= 0 && sound_floor <= 1))
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: sound_floor = %g is outside [0, 1]", law, sound_floor);
  return SPH_OK;
}
