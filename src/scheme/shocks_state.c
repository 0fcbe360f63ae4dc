/* Checkpoints of the scheme for shocks. */
#include "checkpoint.h"
#include "shocks_impl.h"

/* The books, the rate that limits the next step, and the fields that no integrator holds. */
static sph_status pieces_of(sph_shocks *shocks, sphi_checkpoint *c) {
  const size_t n = (size_t)sph_particles_real_count(shocks->set);
  *c = (sphi_checkpoint){.ctx = shocks->base.ctx,
                         .name = "shocks",
                         .kind = SPHI_MAGIC_SHOCKS,
                         .set = shocks->set,
                         .integrator = shocks->integrator};
  sphi_checkpoint_add(c, &shocks->book, sizeof shocks->book);
  sphi_checkpoint_add(c, shocks->drho.ptr, sphi_mul(n, sizeof(double)));
  sph_status s = sphi_checkpoint_field(c, SPH_FIELD_M);
  if (!s) s = sphi_checkpoint_field(c, SPH_FIELD_H);
  if (!s) s = sphi_checkpoint_field(c, SPH_FIELD_RHO);
  if (!s && shocks->strength) s = sphi_checkpoint_field(c, shocks->strain_field);
  return s;
}

sph_status sph_shocks_state_size(sph_shocks *shocks, size_t *bytes) {
  sphi_checkpoint c;
  sph_status s = sphi_shocks_check(shocks, 1);
  if (!s) s = pieces_of(shocks, &c);
  return s ? s : sphi_checkpoint_size(&c, bytes);
}

sph_status sph_shocks_save(sph_shocks *shocks, void *buffer, size_t bytes) {
  sphi_checkpoint c;
  sph_status s = sphi_shocks_check(shocks, 1);
  if (s) return s;
  shocks->book.solved = sphi_shocks_is_solved(shocks);
  s = pieces_of(shocks, &c);
  if (!s) s = sphi_checkpoint_write(&c, buffer, bytes);
  return s ? s : sphi_checkpoint_forget_list(shocks->list, shocks->options.dim);
}

static sph_status read_state(sph_shocks *shocks, const void *buffer, size_t bytes) {
  static const int32_t fields[] = {SPH_FIELD_M, SPH_FIELD_H, SPH_FIELD_RHO};
  sphi_checkpoint c;
  sph_status s = sphi_shocks_make_parts(shocks, 1.0);
  if (!s) s = pieces_of(shocks, &c);
  if (!s) s = sphi_checkpoint_read(&c, buffer, bytes);
  for (int32_t k = 0; !s && k < 3; ++k) s = sph_particles_touch(shocks->set, fields[k]);
  return s ? s : sphi_shocks_make_list(shocks, shocks->book.smallest_h);
}

sph_status sph_shocks_restore(sph_shocks *shocks, const void *buffer, size_t bytes) {
  sph_status s = sphi_shocks_check(shocks, 0);
  if (s) return s;
  shocks->started = 0;
  s = sphi_shocks_make_fields(shocks);
  if (!s) s = read_state(shocks, buffer, bytes);
  if (!s) s = sphi_shocks_check_fields(shocks);
  if (!s && shocks->book.solved) sphi_shocks_set_solved(shocks);
  if (!s) s = sphi_shocks_fill(shocks, shocks->book.time, NULL, 0);
  if (!s) s = sphi_checkpoint_forget_list(shocks->list, shocks->options.dim);
  shocks->started = !s;
  return s;
}
