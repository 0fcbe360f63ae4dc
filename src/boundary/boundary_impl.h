/* The handles of the boundaries: walls with the images behind them, and held values. */
#ifndef SPHI_BOUNDARY_IMPL_H
#define SPHI_BOUNDARY_IMPL_H

#include "../core/core.h"
#include "../particles/particles_impl.h"

#include <sph/boundary.h>

enum { SPHI_MAGIC_GHOSTS = 0x53504841, SPHI_MAGIC_HOLD = 0x53504842, SPHI_MAX_WALLS = 32 };

typedef struct sphi_plane {
  double point[3], normal[3];
} sphi_plane;

struct sph_ghosts {
  sphi_object base;
  sph_ghosts_options options;
  int32_t walls;
  sph_wall wall[SPHI_MAX_WALLS];        /* as last set or moved */
  sphi_plane reference[SPHI_MAX_WALLS]; /* as added: where X0 is mirrored */
  int8_t mirror[SPHI_FIELD_IDS];        /* SPH_MIRROR_* */
  uint64_t changes;                     /* of walls and mirrors */

  /* The images of the last update. */
  const sph_particles *set; /* told apart by identity; followed by pair functions only */
  uint64_t generation;      /* of the set when the update ended */
  uint64_t made_changes;
  int64_t count, real_count;
  double made_reach;                 /* skin included */
  sphi_plane made[SPHI_MAX_WALLS];   /* the planes then */
  sphi_buffer owner, mask;           /* int64_t, uint32_t: count */
  sphi_buffer seen;                  /* positions of the real particles then */
  sphi_buffer next_owner, next_mask; /* of the update in progress */
  sphi_buffer parts;                 /* partial results, one a chunk of particles */

  /* What the pair functions read; valid during an evaluation. */
  const double *x, *v, *m, *rho, *sigma;
  double time;
};

/* The plane by which distances of the position field are judged. */
static inline sphi_plane sphi_wall_plane(const sph_ghosts *g, const sph_wall *walls, int32_t w) {
  if (g->options.position_field == SPH_FIELD_X0) return g->reference[w];
  sphi_plane p;
  for (int a = 0; a < 3; ++a) {
    p.point[a] = walls[w].point[a];
    p.normal[a] = walls[w].normal[a];
  }
  return p;
}

static inline double sphi_dot(int32_t dim, const double *a, const double *b) {
  double sum = a[0] * b[0];
  for (int32_t k = 1; k < dim; ++k) sum += a[k] * b[k];
  return sum;
}

static inline double sphi_plane_distance(const sphi_plane *p, int32_t dim, const double *x) {
  double sum = (x[0] - p->point[0]) * p->normal[0];
  for (int32_t k = 1; k < dim; ++k) sum += (x[k] - p->point[k]) * p->normal[k];
  return sum;
}

/* --- walls.c --- */
/* The walls at time t into next[walls], the callbacks' answers included. */
sph_status sphi_walls_at(const sph_ghosts *g, double t, sph_wall *next);

/* --- images.c --- */
/* Whether the images of the last update serve for the present positions. */
int sphi_images_serve(sph_ghosts *g, const sph_particles *set, const sph_wall *next);
sph_status sphi_images_update(sph_ghosts *g, sph_particles *set, double t, const sph_wall *next);

/* --- mirror.c --- */
/* Whether every field of the set can be mirrored as chosen. */
sph_status sphi_mirror_check(const sph_ghosts *g, const sph_particles *set);
/* Lowest ghost whose owner is not in front of one of its walls; -1 when there is none. */
int64_t sphi_mirror_behind(sph_ghosts *g, const sph_particles *set, const sph_wall *next);
/* Write all fields of the ghosts and take over the walls. */
sph_status sphi_mirror_write(sph_ghosts *g, sph_particles *set, double t, const sph_wall *next);

/* --- stress.c --- */
/* A packed symmetric tensor as a full one, and back. */
void sphi_sym_unpack(int32_t dim, const double *packed, double s[3][3]);
void sphi_sym_pack(int32_t dim, double s[3][3], double *packed);
/* s += A(c) = c n^T + n c^T - (c.n) n n^T: the traction s n changes by c. */
void sphi_change_traction(double s[3][3], const double *n, const double *c);

#endif
