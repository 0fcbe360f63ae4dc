/* Checkpoints of ready schemes: pieces of memory and the state of an integrator, in one buffer. */
#ifndef SPHI_CHECKPOINT_H
#define SPHI_CHECKPOINT_H

#include "../core/core.h"

#include <sph/integrator.h>
#include <sph/neighbors.h>
#include <sph/particles.h>

enum { SPHI_PIECES = 12 };

typedef struct sphi_piece {
  void *data;
  size_t bytes;
} sphi_piece;

/* What is written, in this order, behind a head that says what it is of; and read again. */
typedef struct sphi_checkpoint {
  sph_context *ctx;
  const char *name; /* of the scheme, for sentences */
  uint32_t kind;    /* its magic */
  sph_particles *set;
  sphi_piece piece[SPHI_PIECES];
  int32_t pieces;
  sph_integrator *integrator; /* NULL: none */
} sphi_checkpoint;

/* Append memory, or a field of the real particles, which is created where it is missing. */
void sphi_checkpoint_add(sphi_checkpoint *c, void *data, size_t bytes);
sph_status sphi_checkpoint_field(sphi_checkpoint *c, int32_t field);

/* Let a list be built at its next update. What a kept Verlet list holds depends on when it was
 * built, and with it the rounding of sums: the run that is saved and the one that is restored both
 * begin with a new one. */
sph_status sphi_checkpoint_forget_list(sph_neighbors *list, int32_t dim);

sph_status sphi_checkpoint_size(const sphi_checkpoint *c, size_t *bytes);
sph_status sphi_checkpoint_write(const sphi_checkpoint *c, void *buffer, size_t bytes);
/* Everything is checked, the sum over all bytes too, before the first piece is written:
 * SPH_ERR_ARG, and nothing has changed. */
sph_status sphi_checkpoint_read(const sphi_checkpoint *c, const void *buffer, size_t bytes);

#endif
