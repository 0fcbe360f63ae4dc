/* Equations of state from within: a law is a function of one density and energy; the loops, the
 * checks and the handle are the same for all. */
#ifndef SPHI_EOS_IMPL_H
#define SPHI_EOS_IMPL_H

#include "material_impl.h"

#include <sph/eos.h>

typedef struct sphi_eos_state {
  double p, dp_drho, dp_de;
} sphi_eos_state;

typedef struct sphi_eos sphi_eos;
struct sphi_eos {
  sphi_eos_state (*state)(const sphi_eos *law, double rho, double e);
  double (*energy)(const sphi_eos *law, double rho, double p);
  double (*temperature)(const sphi_eos *law, double rho, double e); /* NULL: none */
  /* 0 when (rho, e) is in range, else nonzero, with a sentence in `text` unless that is NULL. */
  int (*refuse)(const sphi_eos *law, double rho, double e, char *text, size_t room);
  /* The same of (rho, p), before energy(). Either may be NULL. */
  int (*refuse_pressure)(const sphi_eos *law, double rho, double p, char *text, size_t room);
  sph_context *ctx;
  double minimum_pressure, floor2; /* c^2 is at least floor2 */
  int32_t barotropic;              /* no energy is read */
  union {
    struct {
      double gamma, reference_pressure, heat_capacity;
    } gas;
    struct {
      double density, modulus, gamma, background;
    } barotropic;
    struct {
      double density, a, b, c, slope, gruneisen; /* the cubic; a = rho0 c0^2 */
      int32_t curve;
    } gruneisen;
    sph_tillotson_options tillotson;
  } of;
};

/* The handle of a law, which is copied. */
sph_status sphi_eos_make(sph_context *ctx, const sphi_eos *law, sph_material **out);
/* SPH_OK, or SPH_ERR_ARG with a sentence when a constant is negative or not finite. */
sph_status sphi_eos_not_negative(sph_context *ctx, const char *law, const char *name, double value);
/* Those of the cut-off and the floor, as Mie-Grueneisen and Tillotson have them. */
sph_status sphi_eos_check_limits(sph_context *ctx, const char *law, double minimum_pressure,
                                 double sound_floor);

#endif
