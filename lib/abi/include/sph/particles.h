/* Particle set: fields as separate arrays, roles, phases, ids.
 *
 * A set has `count` particles in 1, 2 or 3 dimensions: first the real ones (roles REAL, WALL,
 * BODY), then the ghosts. Fields are arrays of count * components doubles in host order. The
 * library never changes the order of particles unless sph_particles_sort() or _remove() is
 * called. A set holds at most 2^31 - 64 particles.
 *
 * Arrays of the set's own are 64-byte aligned and have room for a common capacity, which grows
 * by half when it is exceeded. They move only then; removing, sorting and clearing keep every
 * address. Arrays lent by the host need the alignment of a double and never move.
 *
 * Two counters say what changed. The generation grows whenever particles are added, removed or
 * reordered, or an array moves (growth, lending); creating a field does not move any and leaves
 * it. The revision of a field grows when the library writes it (creation, adding, removing,
 * sorting, lending) and when the host says so with sph_particles_touch(): call it after writing
 * positions or smoothing lengths directly. It is 0 before the field exists. */
#ifndef SPH_PARTICLES_H
#define SPH_PARTICLES_H

#include <sph/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Built-in fields. X always exists; the others come to be, zero-filled, at first request. Ids
 * from 64 on are the host's, handed out by sph_particles_add_field(). */
enum {
  SPH_FIELD_X = 0,        /* position, dim */
  SPH_FIELD_V = 1,        /* velocity, dim */
  SPH_FIELD_M = 2,        /* mass, 1 */
  SPH_FIELD_RHO = 3,      /* density, 1 */
  SPH_FIELD_H = 4,        /* smoothing length, 1 */
  SPH_FIELD_P = 5,        /* pressure, 1 */
  SPH_FIELD_C = 6,        /* sound speed, 1 */
  SPH_FIELD_E = 7,        /* specific internal energy, 1 */
  SPH_FIELD_SIGMA = 8,    /* Cauchy stress, packed symmetric */
  SPH_FIELD_X0 = 9,       /* reference position, dim */
  SPH_FIELD_A = 10,       /* acceleration, dim */
  SPH_FIELD_SPACING = 11, /* initial particle spacing, 1 */
  SPH_FIELD_F = 12,       /* deformation gradient dx/dX, dim * dim, row-major */
  SPH_FIELD_PK = 13,      /* first Piola-Kirchhoff stress, dim * dim, row-major */
  SPH_FIELD_OMEGA = 14    /* factor of a variable smoothing length (smoothing.h), 1 */
};

enum { SPH_ROLE_REAL = 0, SPH_ROLE_GHOST = 1, SPH_ROLE_WALL = 2, SPH_ROLE_BODY = 3 };

typedef struct sph_particles_options {
  size_t size;      /* set by sph_particles_options_init() */
  int32_t dim;      /* 1, 2 or 3; default 3 */
  int64_t capacity; /* particles to reserve room for; default 0 */
} sph_particles_options;

/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_particles_options_init_sized(sph_particles_options *options, size_t size);
#define sph_particles_options_init(options) \
  sph_particles_options_init_sized((options), sizeof(sph_particles_options))

/* Create an empty set. options NULL: 3-D, no capacity. *out is NULL on failure.
 * SPH_ERR_ARG: dim outside 1..3, capacity negative. SPH_ERR_LIMIT: capacity above 2^31 - 64.
 * SPH_ERR_VERSION, SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_particles_create(sph_context *ctx, const sph_particles_options *options,
                                        sph_particles **out);

/* Destroy a set; lent arrays stay the host's. NULL is allowed. Since 0.1. */
SPH_API void sph_particles_destroy(sph_particles *set);

/* Dimension; 0 for NULL. Since 0.1. */
SPH_API int32_t sph_particles_dim(const sph_particles *set);
/* All particles, ghosts included; 0 for NULL. Since 0.1. */
SPH_API int64_t sph_particles_count(const sph_particles *set);
/* Particles before the first ghost; 0 for NULL. Since 0.1. */
SPH_API int64_t sph_particles_real_count(const sph_particles *set);
/* Generation (see above); 0 for NULL. Since 0.1. */
SPH_API uint64_t sph_particles_generation(const sph_particles *set);

/* Make room for `capacity` particles in all, so that adding up to it allocates nothing and moves
 * nothing. Never shrinks. While it grows, old and new arrays exist side by side.
 * SPH_ERR_ARG: capacity negative. SPH_ERR_LIMIT: above 2^31 - 64, or a lent array is shorter.
 * SPH_ERR_NOMEM. The set is as before then. Since 0.1. */
SPH_API sph_status sph_particles_reserve(sph_particles *set, int64_t capacity);

/* Append n real particles with role REAL, phase 0 and new ids; own fields are zero-filled, lent
 * arrays are left as the host filled them. *first (may be NULL) receives the index of the first,
 * which is the old count. Amortised O(n). n = 0 changes nothing.
 * SPH_ERR_ARG: n < 0. SPH_ERR_STATE: the set holds ghosts (clear them first). SPH_ERR_LIMIT: a
 * lent array or 2^31 - 64 would be exceeded. SPH_ERR_NOMEM. The set is as before then.
 * Since 0.1. */
SPH_API sph_status sph_particles_add(sph_particles *set, int64_t n, int64_t *first);

/* Append n ghosts (role GHOST, phase 0, id -1) after the particles and ghosts there are.
 * Otherwise as sph_particles_add(), without SPH_ERR_STATE. Since 0.1. */
SPH_API sph_status sph_particles_add_ghosts(sph_particles *set, int64_t n, int64_t *first);

/* Remove all ghosts; memory is kept. Fields are not written, so revisions stay. Since 0.1. */
SPH_API sph_status sph_particles_clear_ghosts(sph_particles *set);

/* Remove the n particles in `indices` (real or ghosts, any order, no duplicates); the others keep
 * their order, roles, phases and ids, and close up, in lent arrays too. O(count); one bit a
 * particle of scratch, kept. SPH_ERR_ARG: n < 0, an index out of range or twice, named in the
 * sentence; SPH_ERR_NOMEM. The set is as before then. Since 0.1. */
SPH_API sph_status sph_particles_remove(sph_particles *set, int64_t n, const int64_t *indices);

/* Reorder the real particles into spatial order: cells of edge `cell` from the origin, x fastest,
 * ties by index. `permutation` (may be NULL, else real_count entries) receives the old index of
 * each new one. This is the only call that reorders; addresses stay, lent arrays are reordered
 * in place. A set that is in order already is left alone, generation included. Positions beyond
 * 2^62 cells count as one cell. O(count); 32 bytes a particle of scratch, given back.
 * SPH_ERR_ARG: cell not positive and finite, or a position not finite (the first is named).
 * SPH_ERR_STATE: the set holds ghosts. SPH_ERR_NOMEM. The set is as before then. Since 0.1. */
SPH_API sph_status sph_particles_sort(sph_particles *set, double cell, int64_t *permutation);

/* Add a field of the host's own: `components` doubles a particle (1..64), zero-filled. The name
 * (1..31 characters, unique, also against the built-in ones) is copied. *field receives its id,
 * 64 and upwards in order of creation.
 * SPH_ERR_ARG, SPH_ERR_LIMIT (more than 64 host fields), SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_particles_add_field(sph_particles *set, const char *name, int32_t components,
                                           int32_t *field);

/* Id of a field by name (built-in ones are "x", "v", "m", "rho", "h", "p", "c", "e", "sigma", "x0",
 * "a", "spacing", "F", "PK", "omega"); -1 when there is none. Since 0.1. */
SPH_API int32_t sph_particles_find_field(const sph_particles *set, const char *name);

/* Components of a field; 0 when unknown. Since 0.1. */
SPH_API int32_t sph_particles_components(const sph_particles *set, int32_t field);

/* Array of a field, count * components doubles, writable. A built-in field is created on first
 * request. Valid until the set grows; never NULL on success, even for an empty set. *array is
 * NULL on failure.
 * SPH_ERR_ARG: unknown field. SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_particles_field(sph_particles *set, int32_t field, double **array);

/* As above for reading; NULL when the field is unknown or was never created. Since 0.1. */
SPH_API const double *sph_particles_field_const(const sph_particles *set, int32_t field);

/* Lend the host's own array (capacity * components doubles) to a field, without copying: the
 * library reads and writes it in place until the set is destroyed, another array is lent or the
 * array is taken back by lending NULL, upon which the field holds a copy of its own. Values the
 * field had before are dropped. The set cannot grow beyond `capacity` meanwhile. Lending NULL to
 * a field that has its own array does nothing; capacity is not read then.
 * SPH_ERR_ARG: unknown field, capacity below the present count, an array that overlaps another of
 * the set, its own or lent.
 * SPH_ERR_NOMEM (taking back; the array is still lent then). Since 0.1. */
SPH_API sph_status sph_particles_lend(sph_particles *set, int32_t field, double *array,
                                      int64_t capacity);

/* Say that the host wrote a field. Needed for X and H, so that lists know.
 * SPH_ERR_ARG: the field is unknown or was never created. Since 0.1. */
SPH_API sph_status sph_particles_touch(sph_particles *set, int32_t field);

/* Revision of a field (see above); 0 when unknown. Since 0.1. */
SPH_API uint64_t sph_particles_revision(const sph_particles *set, int32_t field);

/* Roles (SPH_ROLE_*), phases and ids, count entries each; writable but for ids. GHOST is given
 * by position and may not be written. Valid until the set grows; NULL for NULL. Ids count from 0
 * in order of creation. Since 0.1. */
SPH_API int32_t *sph_particles_roles(sph_particles *set);
/* Phase of each particle: which material it is made of. Since 0.1. */
SPH_API int32_t *sph_particles_phases(sph_particles *set);
/* Stable ids: unique in the life of the set, -1 for ghosts. Since 0.1. */
SPH_API const int64_t *sph_particles_ids(const sph_particles *set);

#ifdef __cplusplus
}
#endif
#endif
