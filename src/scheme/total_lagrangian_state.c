/* Checkpoints of the total-Lagrangian scheme. */
#include "checkpoint.h"
#include "total_lagrangian_impl.h"

#include <string.h>

/* What the leapfrog knows about the acceleration that it carries over, and the ledger. */
typedef struct book {
  double t, slack, potential;
  int64_t known, begun;
  sphi_moments start, integral[SPHI_TL_SOURCES];
} book;

static const int32_t kept[] = {SPH_FIELD_X, SPH_FIELD_V,   SPH_FIELD_X0, SPH_FIELD_H,
                               SPH_FIELD_M, SPH_FIELD_RHO, SPH_FIELD_C};
enum { KEPT = sizeof kept / sizeof *kept };

static book book_of(const sph_total_lagrangian *tl, const sph_particles *set) {
  const sphi_tl_ledger *l = &tl->ledger;
  book b;
  memset(&b, 0, sizeof b); /* padding, too */
  b.t = tl->t;
  b.slack = tl->slack;
  b.potential = l->potential;
  b.known = sphi_tl_remembered(tl, set, tl->t);
  b.begun = l->begun;
  b.start = l->start;
  memcpy(b.integral, l->integral, sizeof b.integral);
  return b;
}

/* An array of accelerations that may not have been evaluated yet. */
static sph_status add_accelerations(sphi_checkpoint *c, sphi_buffer *buffer, size_t count,
                                    int64_t known) {
  const size_t n = (size_t)sph_particles_real_count(c->set) * (size_t)sph_particles_dim(c->set);
  const size_t bytes = sphi_mul(sphi_mul(n, count), sizeof(double));
  sph_status s = sphi_buffer_reserve(c->ctx, buffer, bytes);
  if (s) return s;
  if (!known) memset(buffer->ptr, 0, bytes);
  sphi_checkpoint_add(c, buffer->ptr, bytes);
  return SPH_OK;
}

static sph_status pieces_of(sph_total_lagrangian *tl, sph_particles *set, book *b,
                            sphi_checkpoint *c) {
  sph_status s = SPH_OK;
  *b = book_of(tl, set);
  *c = (sphi_checkpoint){.ctx = tl->base.ctx,
                         .name = "total_lagrangian",
                         .kind = SPHI_MAGIC_TOTAL_LAGRANGIAN,
                         .set = set,
                         .integrator = tl->integrator};
  sphi_checkpoint_add(c, b, sizeof *b);
  if (!tl->integrator) s = add_accelerations(c, &tl->rates, 1, b->known);
  if (!s && tl->options.audit)
    s = add_accelerations(c, &tl->ledger.parts, SPHI_TL_SOURCES, b->known);
  for (int k = 0; !s && k < KEPT; ++k) s = sphi_checkpoint_field(c, kept[k]);
  return s;
}

sph_status sph_total_lagrangian_state_size(sph_total_lagrangian *tl, sph_particles *set,
                                           size_t *bytes) {
  sphi_checkpoint c;
  book b;
  sph_status s = sphi_tl_check_started(tl, set);
  if (!s) s = pieces_of(tl, set, &b, &c);
  return s ? s : sphi_checkpoint_size(&c, bytes);
}

sph_status sph_total_lagrangian_save(sph_total_lagrangian *tl, sph_particles *set, void *buffer,
                                     size_t bytes) {
  sphi_checkpoint c;
  book b;
  sph_status s = sphi_tl_check_started(tl, set);
  if (!s) s = pieces_of(tl, set, &b, &c);
  return s ? s : sphi_checkpoint_write(&c, buffer, bytes);
}

static void take_up(sph_total_lagrangian *tl, const sph_particles *set, const book *b) {
  sphi_tl_ledger *l = &tl->ledger;
  if (b->known) sphi_tl_remember(tl, set, b->t, 0.0);
  tl->t = b->t;
  tl->slack = b->slack;
  l->potential = b->potential;
  l->begun = (int32_t)b->begun;
  l->start = b->start;
  memcpy(l->integral, b->integral, sizeof b->integral);
  tl->started = set;
}

sph_status sph_total_lagrangian_restore(sph_total_lagrangian *tl, sph_particles *set,
                                        const void *buffer, size_t bytes) {
  sphi_checkpoint c;
  book b;
  sph_status s = sphi_tl_check_set(tl, set);
  if (s) return s;
  tl->set = tl->started = NULL;
  s = pieces_of(tl, set, &b, &c);
  if (!s) s = sphi_checkpoint_read(&c, buffer, bytes);
  for (int k = 0; !s && k < KEPT; ++k) s = sph_particles_touch(set, kept[k]);
  if (!s) s = sphi_tl_build_list(tl, set);
  if (!s) take_up(tl, set, &b);
  return s;
}
