/* Equations of state: pressure, sound speed, temperature and their derivatives from density and
 * specific internal energy.
 *
 * One interface for all of them and for the host's own (sph_material_create()): the properties
 * pressure, sound_speed, pressure_derivatives, energy and temperature of a material, for 1-D, 2-D
 * and 3-D. They read rho and e of the block; barotropic fluids read rho only; the energy reads rho
 * and p. The sound speed is always c^2 = dp/drho + (p/rho^2) dp/de, Zisis (1.16).
 *
 * States outside a law are SPH_ERR_NUMERIC with a sentence that names the first particle, outputs
 * untouched: a density that is not positive and finite (vacuum included), an energy or pressure
 * that is not finite, and what stands at each law. Nothing is clipped but by minimum_pressure and
 * sound_floor, where a law has them.
 *
 * Source unless said otherwise: I. Zisis, PhD thesis, Eindhoven 2017 ("Zisis"). Misprints there,
 * right here: (1.15) adds gamma P_ref instead of subtracting it; (1.17) and (1.18) have a wrong
 * sign and count the Hugoniot energy twice, (6.10) is right. */
#ifndef SPH_EOS_H
#define SPH_EOS_H

#include <sph/material.h>
#include <sph/plasticity.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- properties ---- */

/* dp/drho at constant e and dp/de at constant rho. dp_drho, dp_de: n; either may be NULL, not both.
 * The sound speed is c^2 = dp/drho + p/rho^2 dp/de. Errors as for sph_material_pressure().
 * Since 0.1. */
SPH_API sph_status sph_material_pressure_derivatives(const sph_material *material,
                                                     const sph_material_block *block,
                                                     double *dp_drho, double *dp_de);
/* Specific internal energy from density and pressure (rho and p of the block). e: n. Errors as for
 * sph_material_pressure(). Since 0.1. */
SPH_API sph_status sph_material_energy(const sph_material *material,
                                       const sph_material_block *block, double *e);
/* Temperature from density and energy. temperature: n. Errors as for sph_material_pressure().
 * Since 0.1. */
SPH_API sph_status sph_material_temperature(const sph_material *material,
                                            const sph_material_block *block, double *temperature);

/* ---- gases ---- */

typedef struct sph_gas_options {
  size_t size;               /* set by sph_gas_options_init() */
  double gamma;              /* ratio of specific heats > 1; default 1.4 */
  double reference_pressure; /* P_ref >= 0; default 0: ideal gas */
  double heat_capacity;      /* c_v > 0, for temperatures; default 0: none */
} sph_gas_options;
/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_gas_options_init_sized(sph_gas_options *options, size_t size);
#define sph_gas_options_init(o) sph_gas_options_init_sized((o), sizeof(sph_gas_options))

/* Ideal and stiffened gas, Zisis (1.14), (5.3):
 *
 *   p = (gamma - 1) rho e - gamma P_ref,   c^2 = gamma (p + P_ref)/rho,
 *   e = (p + gamma P_ref)/((gamma - 1) rho),   T = (e - P_ref/rho)/c_v
 *
 * Out of range: p + P_ref < 0, that is e < P_ref/rho; for an ideal gas e < 0. A cold gas, p =
 * -P_ref with c = 0, is in range. Temperature: only with a heat capacity. *out is NULL on failure.
 * SPH_ERR_ARG: constants out of range. SPH_ERR_VERSION, SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_material_create_gas(sph_context *ctx, const sph_gas_options *options,
                                           sph_material **out);

/* ---- barotropic fluids ---- */

typedef struct sph_barotropic_options {
  size_t size;        /* set by sph_barotropic_options_init() */
  double density;     /* rho0 > 0; must be given */
  double sound_speed; /* c0 > 0, at rho0; must be given */
  double gamma;       /* exponent >= 1; default 7 */
  double background;  /* pressure at rho0; default 0 */
} sph_barotropic_options;
/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_barotropic_options_init_sized(sph_barotropic_options *options, size_t size);
#define sph_barotropic_options_init(o) \
  sph_barotropic_options_init_sized((o), sizeof(sph_barotropic_options))

/* Pressure from density alone, the equation of Tait (Cole, Underwater Explosions, 1948):
 *
 *   p = background + B ((rho/rho0)^gamma - 1),   B = rho0 c0^2/gamma,
 *   c^2 = c0^2 (rho/rho0)^(gamma - 1)
 *
 * gamma = 7 for water (with background 0 it is Zisis, section 4.5.1); gamma = 1 is the linear law
 * p = c0^2 (rho - rho0) of (1.13), (5.1); background = B gives the polytrope p = B (rho/rho0)^gamma
 * of (4.43). dp/de is 0. There is no temperature. The energy is that of compression from rho0, the
 * integral of p/rho^2, and does not read p.
 * Errors as for sph_material_create_gas(). Since 0.1. */
SPH_API sph_status sph_material_create_barotropic(sph_context *ctx,
                                                  const sph_barotropic_options *options,
                                                  sph_material **out);

/* ---- Mie-Grueneisen ---- */

/* The curve that the thermal pressure is added to; u = rho/rho0 - 1, A = rho0 c0^2, S the slope.
 *
 *   HUGONIOT_CUBIC  p_H = A u + B u^2 + C u^3 for u > 0, A u for u <= 0, with B = A (1 + 2(S-1)),
 *                   C = A (2(S-1) + 3(S-1)^2): Zisis (6.10) to (6.13), the Taylor polynomial of the
 *                   next. It falls behind at high compression: at u = 0.485 of aluminium 78.7
 *                   instead of 81.4 GPa.
 *   HUGONIOT        p_H = A eta/(1 - S eta)^2, eta = u/(1 + u), for u > 0: exactly the linear
 *                   relation U_s = c0 + S u_p between shock and particle speed. A u for u <= 0.
 *   COLD_CUBIC      the cubic as a cold curve on both sides, p = A u + B u^2 + C u^3 + Gamma rho0
 * e: Zisis (5.4), (5.5). */
enum { SPH_HUGONIOT_CUBIC = 1, SPH_HUGONIOT = 2, SPH_COLD_CUBIC = 3 };

typedef struct sph_mie_gruneisen_options {
  size_t size;             /* set by sph_mie_gruneisen_options_init() */
  double density;          /* rho0 > 0; must be given */
  double sound_speed;      /* c0 > 0: U_s of a weak shock; must be given */
  double slope;            /* S >= 0; must be given, 0 is its default */
  double gruneisen;        /* Gamma > 0, for COLD_CUBIC B0; must be given */
  int32_t curve;           /* SPH_HUGONIOT_CUBIC, SPH_HUGONIOT, SPH_COLD_CUBIC; default the first */
  double minimum_pressure; /* tension cut-off, p = max(p, this); default -INFINITY */
  double sound_floor;      /* c >= this times c0, from 0 to 1; default 0.1 */
} sph_mie_gruneisen_options;
/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_mie_gruneisen_options_init_sized(sph_mie_gruneisen_options *options, size_t size);
#define sph_mie_gruneisen_options_init(o) \
  sph_mie_gruneisen_options_init_sized((o), sizeof(sph_mie_gruneisen_options))

/* p = (1 - Gamma u/2) p_H(u) + Gamma rho e, which is p_H + Gamma rho (e - e_H) with the energy e_H
 * = p_H eta/(2 rho0) of the Hugoniot from rest; COLD_CUBIC as above. Under strong tension c^2 would
 * turn negative: sound_floor keeps it; with floor 0 such a c is 0. Below minimum_pressure both
 * derivatives are 0, and c is the floor. The source has no cut-off. No temperature.
 *
 * Out of range: with HUGONIOT, a compression of eta >= 1/S, which no shock reaches.
 * Errors as for sph_material_create_gas(). Since 0.1. */
SPH_API sph_status sph_material_create_mie_gruneisen(sph_context *ctx,
                                                     const sph_mie_gruneisen_options *options,
                                                     sph_material **out);

/* ---- Tillotson ---- */

typedef struct sph_tillotson_options {
  size_t size;             /* set by sph_tillotson_options_init() */
  double density;          /* rho0 > 0; must be given, as all down to e_cv */
  double a, b;             /* > 0; a + b is the Grueneisen coefficient at rest */
  double A, B;             /* bulk modulus > 0, and the square term >= 0 */
  double alpha, beta;      /* decay of the expanded state, >= 0 */
  double e0;               /* > 0 */
  double e_iv, e_cv;       /* energies of incipient and complete vaporisation, 0 < e_iv < e_cv */
  double minimum_pressure; /* tension cut-off, p = max(p, this); default -INFINITY */
  double sound_floor;      /* c >= this times sqrt(A/rho0), from 0 to 1; default 0.1 */
} sph_tillotson_options;
/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_tillotson_options_init_sized(sph_tillotson_options *options, size_t size);
#define sph_tillotson_options_init(o) \
  sph_tillotson_options_init_sized((o), sizeof(sph_tillotson_options))

/* For impacts that melt and vaporise. With eta = rho/rho0, u = eta - 1, w = 1 + e/(e0 eta^2):
 *
 *   p1 = (a + b/w) rho e + A u + B u^2                      compressed, or e <= e_iv (tension)
 *   p2 = a rho e + [b rho e/w + A u exp(-beta (1/eta - 1))] exp(-alpha (1/eta - 1)^2)
 *                                                           expanded and e >= e_cv (vapour)
 *   between, expanded: ((e - e_iv) p2 + (e_cv - e) p1)/(e_cv - e_iv)
 *
 * p is continuous everywhere; its derivatives, and c, jump at e_iv, e_cv and, for u = 0 and e >
 * e_iv, at rho0. Cold matter drawn out to nothing keeps the tension B - A, a property of the law:
 * use minimum_pressure. Partly vaporised states may be unstable, c^2 < 0, before the floor. The
 * floor of c and the cut-off are as for
 * sph_material_create_mie_gruneisen(). The energy from rho and p is in closed form in p1 and p2, by
 * bisection between; where several energies give p, the lowest of those in the order p1, p2,
 * between. No temperature.
 *
 * Out of range: w <= 0, energies below -e0 eta^2.
 * Source: J. Tillotson, Metallic Equations of State for Hypervelocity Impact, GA-3216, 1962; J.
 * Melosh, Impact Cratering, 1989, appendix II; W. Benz, E. Asphaug, Icarus 142 (1999) 5-20.
 * Errors as for sph_material_create_gas(). Since 0.1. */
SPH_API sph_status sph_material_create_tillotson(sph_context *ctx,
                                                 const sph_tillotson_options *options,
                                                 sph_material **out);

/* ---- constants of materials, SI units ---- */

/* Zisis, table 6.1, where rho0 is in kg/m^3, c0 in m/s, G and the yield stress in GPa:
 *
 *                                   rho0    c0    S     Gamma  G     yield
 *   ALUMINIUM_1000  Al 1000         2710   5300   1.500  1.7   25.0  0.550
 *   ALUMINIUM_2024  Al 2024         2785   5330   1.338  2.0   27.1  0.265
 *   LEAD                           11360   2030   1.470  2.6    8.6  0.090
 *   COPPER                          8930   3900   1.500  2.0   46.0  0.045
 *   EPOXY           Stycast 2850    2280   2930   1.630  1.0    0.6  0.050
 *   HOMOGENISED                     2659   4730   1.411  1.75  20.5  0.211
 *
 * HOMOGENISED is 0.75 Al 2024 + 0.25 epoxy by volume, in every entry; the table prints a yield
 * stress of 0.238, which that rule does not give. */
enum {
  SPH_ALUMINIUM_1000 = 1,
  SPH_ALUMINIUM_2024 = 2,
  SPH_LEAD = 3,
  SPH_COPPER = 4,
  SPH_EPOXY = 5,
  SPH_HOMOGENISED = 6
};

/* Write the constants of a material above into options that were initialised; what is no constant
 * of the material (curve, cut-off, floor, switches) stays. One of the two may be NULL.
 * SPH_ERR_ARG: an unknown material, options without their size; then nothing is written.
 * Since 0.1. */
SPH_API sph_status sph_mie_gruneisen_constants(int32_t material, sph_mie_gruneisen_options *eos,
                                               sph_strength_options *strength);

/* Constants for the equation of Tillotson; A, B in GPa, energies in MJ/kg:
 *
 *                         rho0   a     b     A     B     alpha beta  e0    e_iv   e_cv
 *   TILLOTSON_ALUMINIUM   2700   0.50  1.63  75.2  65.0    5    5    5.0   3.00   13.9
 *   TILLOTSON_IRON        7800   0.50  1.50  128   105     5    5    9.5   2.40   8.67
 *   TILLOTSON_BASALT      2700   0.50  1.50  26.7  26.7    5    5    487   4.72   18.2
 *   TILLOTSON_ICE          917   0.30  0.10  9.47  9.47   10    5    10    0.773  3.04
 *   TILLOTSON_GRANITE     2680   0.50  1.30  18.0  18.0    5    5    16    3.50   18.0
 *
 * Aluminium, iron and granite: Melosh 1989, table AII.3. Basalt and ice: Benz, Asphaug 1999, table
 * II. */
enum {
  SPH_TILLOTSON_ALUMINIUM = 1,
  SPH_TILLOTSON_IRON = 2,
  SPH_TILLOTSON_BASALT = 3,
  SPH_TILLOTSON_ICE = 4,
  SPH_TILLOTSON_GRANITE = 5
};

/* As sph_mie_gruneisen_constants(). Since 0.1. */
SPH_API sph_status sph_tillotson_constants(int32_t material, sph_tillotson_options *eos);

#ifdef __cplusplus
}
#endif
#endif
