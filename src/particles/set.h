/* The particle set's own struct and the services that its source files share. */
#ifndef SPHI_PARTICLES_SET_H
#define SPHI_PARTICLES_SET_H

#include "particles_impl.h"

enum {
  SPHI_BUILTIN_FIELDS = 15, /* SPH_FIELD_X ... SPH_FIELD_OMEGA */
  SPHI_HOST_FIELD_BASE = 64,
  SPHI_HOST_FIELDS = 64,
  SPHI_FIELD_SLOTS = SPHI_BUILTIN_FIELDS + SPHI_HOST_FIELDS,
  SPHI_FIELD_NAME = 32,
  SPHI_MAX_COMPONENTS = 64
};

/* Indices of particles are 32-bit in neighbour lists; 64 short of the limit so that a block of
 * them can be rounded up without a check. */
#define SPHI_MAX_PARTICLES (INT64_C(0x7fffffff) - 63)

typedef struct sphi_field {
  char name[SPHI_FIELD_NAME];
  int32_t components; /* 0: the slot is free */
  double *values;     /* NULL: never created */
  int64_t lent;       /* particles the host's array holds; -1 when the array is our own */
  uint64_t revision;
} sphi_field;

struct sph_particles {
  sphi_object object;
  int32_t dim;
  int32_t host_fields;
  int64_t count, real_count;
  int64_t capacity; /* of every array that is our own */
  int64_t next_id;
  uint64_t generation;
  int32_t *roles, *phases;
  int64_t *ids;
  sphi_field fields[SPHI_FIELD_SLOTS];
  sphi_buffer marks; /* removal bitmap, kept: flows with an outlet remove in every step */
};

/* One array of the set, seen as records of `stride` bytes. */
typedef struct sphi_column {
  void *data;
  size_t stride;
} sphi_column;
enum { SPHI_MAX_COLUMNS = SPHI_FIELD_SLOTS + 3 };

/* Every array that moves with the particles, lent ones included; returns how many. */
int32_t sphi_set_columns(const sph_particles *set, sphi_column columns[SPHI_MAX_COLUMNS]);

/* NULL, with the sentence written, unless `set` is a particle set. */
sph_status sphi_set_check(const sph_particles *set);
/* The field's slot; NULL when the id is unknown. */
sphi_field *sphi_set_field(const sph_particles *set, int32_t field);
size_t sphi_field_bytes(const sphi_field *f, int64_t particles);
/* Allocate the zero-filled array of a field that has none. */
sph_status sphi_field_create(sph_particles *set, sphi_field *f);
/* Fill in the names and components of the built-in fields. */
void sphi_set_name_builtins(sph_particles *set);

/* First allocation of ids, roles and phases, and growth of everything. All or nothing. */
sph_status sphi_set_grow(sph_particles *set, int64_t capacity);
/* The library wrote every field. */
void sphi_set_touch_all(sph_particles *set);

#endif
