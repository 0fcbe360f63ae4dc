/* Checkpoints of the scheme for solids. */
#include "checkpoint.h"
#include "scheme_impl.h"

/* What a start leaves beside fields and integrator. */
typedef struct book {
  double time;
  sphi_moments start;
} book;

/* The fields that no integrator holds. */
static const int32_t kept[] = {SPH_FIELD_M, SPH_FIELD_RHO,     SPH_FIELD_H,
                               SPH_FIELD_C, SPH_FIELD_SPACING, SPH_FIELD_X0};
enum { KEPT = sizeof kept / sizeof *kept };

static sph_status pieces_of(sph_elastodynamics *solid, book *b, sphi_checkpoint *c) {
  sph_status s = SPH_OK;
  *c = (sphi_checkpoint){.ctx = solid->base.ctx,
                         .name = "elastodynamics",
                         .kind = SPHI_MAGIC_ELASTODYNAMICS,
                         .set = solid->set,
                         .integrator = solid->integrator};
  *b = (book){solid->time, solid->start};
  sphi_checkpoint_add(c, b, sizeof *b);
  for (int k = 0; !s && k < KEPT; ++k) s = sphi_checkpoint_field(c, kept[k]);
  if (s || solid->options.h_law != SPH_H_LAW_DENSITY) return s;
  s = sphi_checkpoint_field(c, solid->h0_field);
  return s ? s : sphi_checkpoint_field(c, solid->rho0_field);
}

sph_status sph_elastodynamics_state_size(sph_elastodynamics *solid, size_t *bytes) {
  sphi_checkpoint c;
  book b;
  sph_status s = sphi_scheme_check(solid, 1);
  if (!s) s = pieces_of(solid, &b, &c);
  return s ? s : sphi_checkpoint_size(&c, bytes);
}

sph_status sph_elastodynamics_save(sph_elastodynamics *solid, void *buffer, size_t bytes) {
  sphi_checkpoint c;
  book b;
  sph_status s = sphi_scheme_check(solid, 1);
  if (!s) s = pieces_of(solid, &b, &c);
  if (!s) s = sphi_checkpoint_write(&c, buffer, bytes);
  return s ? s : sphi_checkpoint_forget_list(solid->list, solid->options.dim);
}

/* Into fields, ledger and the parts there are. */
static sph_status read_state(sph_elastodynamics *solid, const void *buffer, size_t bytes) {
  sphi_checkpoint c;
  book b;
  sph_status s = pieces_of(solid, &b, &c);
  if (!s) s = sphi_checkpoint_read(&c, buffer, bytes);
  for (int k = 0; !s && k < KEPT; ++k) s = sph_particles_touch(solid->set, kept[k]);
  if (s) return s;
  solid->time = b.time;
  solid->start = b.start;
  solid->spacing_revision = sph_particles_revision(solid->set, SPH_FIELD_SPACING);
  return SPH_OK;
}

/* Twice: spacing and speed, which the parts are made of, are known after the first time. */
sph_status sph_elastodynamics_restore(sph_elastodynamics *solid, const void *buffer, size_t bytes) {
  double spacing, speed;
  sph_status s = sphi_scheme_check(solid, 0);
  if (s) return s;
  solid->started = 0;
  s = sphi_scheme_reference_fields(solid);
  if (!s) s = sphi_scheme_make_parts(solid, 1.0, 1.0);
  if (!s) s = read_state(solid, buffer, bytes);
  if (!s) s = sphi_scheme_extent(solid, &spacing, &speed);
  if (!s) s = sphi_scheme_make_parts(solid, spacing, speed);
  if (!s) s = read_state(solid, buffer, bytes);
  solid->started = !s;
  return s;
}
