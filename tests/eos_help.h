/* Equations of state for tests: makers, and evaluation of single states. */
#ifndef SPH_TESTS_EOS_HELP_H
#define SPH_TESTS_EOS_HELP_H

#include "material_help.h"

static CHECK_UNUSED sph_material *gas(sph_context *ctx, double gamma, double reference,
                                      double capacity) {
  sph_gas_options o;
  sph_material *m = NULL;
  sph_gas_options_init(&o);
  o.gamma = gamma;
  o.reference_pressure = reference;
  o.heat_capacity = capacity;
  check_ok(sph_material_create_gas(ctx, &o, &m));
  return m;
}

static CHECK_UNUSED sph_material *barotropic(sph_context *ctx, double gamma, double background) {
  sph_barotropic_options o;
  sph_material *m = NULL;
  sph_barotropic_options_init(&o);
  o.density = 1000;
  o.sound_speed = 30;
  o.gamma = gamma;
  o.background = background;
  check_ok(sph_material_create_barotropic(ctx, &o, &m));
  return m;
}

static CHECK_UNUSED sph_material *gruneisen(sph_context *ctx, int32_t which, int32_t curve,
                                            double floor) {
  sph_mie_gruneisen_options o;
  sph_material *m = NULL;
  sph_mie_gruneisen_options_init(&o);
  check_ok(sph_mie_gruneisen_constants(which, &o, NULL));
  o.curve = curve;
  o.sound_floor = floor;
  check_ok(sph_material_create_mie_gruneisen(ctx, &o, &m));
  return m;
}

static CHECK_UNUSED sph_material *tillotson(sph_context *ctx, int32_t which, double floor) {
  sph_tillotson_options o;
  sph_material *m = NULL;
  sph_tillotson_options_init(&o);
  check_ok(sph_tillotson_constants(which, &o));
  o.sound_floor = floor;
  check_ok(sph_material_create_tillotson(ctx, &o, &m));
  return m;
}

static CHECK_UNUSED sph_material_block block(int64_t n, const double *rho, const double *e) {
  sph_material_block b;
  sph_material_block_init(&b);
  b.dim = 1;
  b.n = n;
  b.rho = rho;
  b.e = e;
  return b;
}

static CHECK_UNUSED double pressure(const sph_material *m, double rho, double e) {
  sph_material_block b = block(1, &rho, &e);
  double p;
  check_ok(sph_material_pressure(m, &b, &p));
  return p;
}

static CHECK_UNUSED double sound(const sph_material *m, double rho, double e) {
  sph_material_block b = block(1, &rho, &e);
  double c;
  check_ok(sph_material_sound_speed(m, &b, &c));
  return c;
}

static CHECK_UNUSED double energy(const sph_material *m, double rho, double p) {
  sph_material_block b = block(1, &rho, NULL);
  double e;
  b.p = &p;
  check_ok(sph_material_energy(m, &b, &e));
  return e;
}

static CHECK_UNUSED void derivatives(const sph_material *m, double rho, double e, double *dp_drho,
                                     double *dp_de) {
  sph_material_block b = block(1, &rho, &e);
  check_ok(sph_material_pressure_derivatives(m, &b, dp_drho, dp_de));
}

#endif
