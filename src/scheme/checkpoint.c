/* Checkpoints: a head, the pieces, the state of the integrator; each begins at a multiple of 8. */
#include "checkpoint.h"

#include <string.h>

typedef struct head {
  uint64_t magic, bytes, sum; /* sum: over all that follows the head */
  uint64_t kind;
  int64_t dim, real_count;
  uint64_t piece[SPHI_PIECES];
} head;

static const uint64_t magic = UINT64_C(0x3170636865687053);

static size_t rounded(size_t bytes) { return (bytes + 7) / 8 * 8; }

void sphi_checkpoint_add(sphi_checkpoint *c, void *data, size_t bytes) {
  c->piece[c->pieces++] = (sphi_piece){data, bytes};
}

sph_status sphi_checkpoint_field(sphi_checkpoint *c, int32_t field) {
  double *data;
  sph_status s = sph_particles_field(c->set, field, &data);
  if (s) return s;
  const size_t doubles = sphi_mul((size_t)sph_particles_real_count(c->set),
                                  (size_t)sph_particles_components(c->set, field));
  sphi_checkpoint_add(c, data, sphi_mul(doubles, sizeof *data));
  return SPH_OK;
}

sph_status sphi_checkpoint_forget_list(sph_neighbors *list, int32_t dim) {
  const double nothing = 0.0;
  return sph_neighbors_build_arrays(list, dim, 0, &nothing, NULL, 1.0);
}

/* Fowler, Noll, Vo, in words of 8 bytes. */
static uint64_t sum_of(const char *data, size_t bytes) {
  uint64_t sum = UINT64_C(0xcbf29ce484222325);
  for (size_t at = 0; at + 8 <= bytes; at += 8) {
    uint64_t word;
    memcpy(&word, data + at, 8);
    sum = (sum ^ word) * UINT64_C(0x100000001b3);
    sum ^= sum >> 32; /* or the top bits of a word would not reach the others */
  }
  return sum;
}

static size_t pieces_bytes(const sphi_checkpoint *c) {
  size_t bytes = sizeof(head);
  for (int32_t k = 0; k < c->pieces; ++k) bytes += rounded(c->piece[k].bytes);
  return bytes;
}

sph_status sphi_checkpoint_size(const sphi_checkpoint *c, size_t *bytes) {
  size_t state = 0;
  sph_status s = SPH_OK;
  if (!bytes) return sphi_fail(c->ctx, SPH_ERR_ARG, "%s: bytes is NULL", c->name);
  if (c->integrator) s = sph_integrator_state_size(c->integrator, c->set, &state);
  if (!s) *bytes = pieces_bytes(c) + rounded(state);
  return s;
}

static sph_status check_buffer(const sphi_checkpoint *c, const void *buffer, size_t bytes,
                               size_t *size) {
  sph_status s = sphi_checkpoint_size(c, size);
  if (s) return s;
  if (!buffer || (uintptr_t)buffer % 8 != 0)
    return sphi_fail(c->ctx, SPH_ERR_ARG, "%s: the buffer is %s", c->name,
                     buffer ? "not aligned as doubles are" : "NULL");
  if (bytes >= *size) return SPH_OK;
  return sphi_fail(c->ctx, SPH_ERR_ARG, "%s: the buffer has %zu bytes, the state %zu", c->name,
                   bytes, *size);
}

static head head_of(const sphi_checkpoint *c, size_t bytes) {
  head h = {.magic = magic, .bytes = bytes, .kind = c->kind};
  h.dim = sph_particles_dim(c->set);
  h.real_count = sph_particles_real_count(c->set);
  for (int32_t k = 0; k < c->pieces; ++k) h.piece[k] = c->piece[k].bytes;
  return h;
}

sph_status sphi_checkpoint_write(const sphi_checkpoint *c, void *buffer, size_t bytes) {
  size_t size, at = sizeof(head);
  char *to = buffer;
  sph_status s = check_buffer(c, buffer, bytes, &size);
  if (s) return s;
  memset(to, 0, size);
  for (int32_t k = 0; k < c->pieces; at += rounded(c->piece[k++].bytes))
    if (c->piece[k].bytes > 0) memcpy(to + at, c->piece[k].data, c->piece[k].bytes);
  if (c->integrator) s = sph_integrator_state_write(c->integrator, c->set, to + at, size - at);
  if (s) return s;
  head h = head_of(c, size);
  h.sum = sum_of(to + sizeof h, size - sizeof h);
  memcpy(to, &h, sizeof h);
  return SPH_OK;
}

static sph_status check_content(const sphi_checkpoint *c, const char *from, size_t size) {
  head h;
  const head mine = head_of(c, size);
  memcpy(&h, from, sizeof h);
  if (h.magic != magic || h.kind != mine.kind)
    return sphi_fail(c->ctx, SPH_ERR_ARG, "%s: the buffer holds no state of this scheme", c->name);
  if (h.bytes != mine.bytes || h.dim != mine.dim || h.real_count != mine.real_count ||
      memcmp(h.piece, mine.piece, sizeof mine.piece) != 0)
    return sphi_fail(c->ctx, SPH_ERR_ARG,
                     "%s: the state is of other options or another set: %lld particles, %lld-D",
                     c->name, (long long)h.real_count, (long long)h.dim);
  if (h.sum == sum_of(from + sizeof h, size - sizeof h)) return SPH_OK;
  return sphi_fail(c->ctx, SPH_ERR_ARG, "%s: the state is damaged, its sum does not match",
                   c->name);
}

sph_status sphi_checkpoint_read(const sphi_checkpoint *c, const void *buffer, size_t bytes) {
  size_t size, at = pieces_bytes(c);
  const char *from = buffer;
  sph_status s = check_buffer(c, buffer, bytes, &size);
  if (!s) s = check_content(c, from, size);
  if (!s && c->integrator)
    s = sph_integrator_state_read(c->integrator, c->set, from + at, size - at);
  if (s) return s;
  at = sizeof(head);
  for (int32_t k = 0; k < c->pieces; at += rounded(c->piece[k++].bytes))
    if (c->piece[k].bytes > 0) memcpy(c->piece[k].data, from + at, c->piece[k].bytes);
  return SPH_OK;
}
