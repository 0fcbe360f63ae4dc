/* Equations of state: pressure, sound speed, temperature and their derivatives. */
#ifndef SPH_EOS_H
#define SPH_EOS_H

#include <sph/material.h>
#include <sph/plasticity.h>

#ifdef __cplusplus
extern "C" {
#endif

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

#ifdef __cplusplus
}
#endif
#endif
