/* Neighbour structures: who interacts with whom.
 *
 * One handle, four methods, one result: j is a neighbour of i when j != i and r_ij < cutoff_ij,
 * strictly, where cutoff_ij = support * h_ij and h_ij follows the rule for unequal h:
 *   ARITHMETIC (h_i + h_j) / 2, HARMONIC 2 h_i h_j / (h_i + h_j), MAX, MIN,
 *   AVERAGE (the kernel is averaged, [W(h_i) + W(h_j)] / 2): cutoff of MAX.
 * The rule also tells operators which h a pair has. (He 2015, eqs. 6.4 to 6.9; his "geometric mean"
 * is the harmonic one.)
 *
 * Every method finds the same pairs. A structure serves one particle set (or one pair of arrays) at
 * a time and belongs to the context that made it. */
#ifndef SPH_NEIGHBORS_H
#define SPH_NEIGHBORS_H

#include <sph/base.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
  SPH_NEIGHBORS_ALL_PAIRS = 1, /* every pair is tested: O(n^2); small sets and tests */
  SPH_NEIGHBORS_CELLS = 2,     /* cell list, cells of the largest cutoff: O(n), near-uniform h */
  SPH_NEIGHBORS_VERLET = 3, /* cells with a skin, reused while particles move less than it allows */
  SPH_NEIGHBORS_TREE = 4    /* for very unequal h: O(n log n) */
};

enum { SPH_H_ARITHMETIC = 1, SPH_H_HARMONIC = 2, SPH_H_MAX = 3, SPH_H_MIN = 4, SPH_H_AVERAGE = 5 };

typedef struct sph_neighbors_options {
  size_t size;         /* set by sph_neighbors_options_init() */
  int32_t method;      /* SPH_NEIGHBORS_*; default CELLS */
  int32_t h_rule;      /* SPH_H_*; default ARITHMETIC */
  double support;      /* cutoff in units of h, > 0; default 2. Use sph_kernel_support() */
  double skin;         /* VERLET: extra list radius, a length >= 0; default 0 */
  int32_t periodic[3]; /* nonzero: this axis wraps around */
  double box_lo[3];    /* of periodic axes: the box is [lo, hi); at least two cutoffs wide */
  double box_hi[3];
  int64_t max_pairs; /* refuse to store more (SPH_ERR_LIMIT); 0 = as memory allows */
} sph_neighbors_options;

/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_neighbors_options_init_sized(sph_neighbors_options *options, size_t size);
#define sph_neighbors_options_init(options) \
  sph_neighbors_options_init_sized((options), sizeof(sph_neighbors_options))

/* Create an empty structure. options may be NULL. *out is NULL on failure.
 * SPH_ERR_ARG: unknown method or rule, support or skin negative or not finite, hi <= lo on a
 * periodic axis, max_pairs < 0. SPH_ERR_VERSION, SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_neighbors_create(sph_context *ctx, const sph_neighbors_options *options,
                                        sph_neighbors **out);

/* Destroy. NULL is allowed. Since 0.1. */
SPH_API void sph_neighbors_destroy(sph_neighbors *list);

/* Find the pairs of a set from SPH_FIELD_X and SPH_FIELD_H (ghosts included). The set is read,
 * not kept; the list goes stale when the set's generation or the revision of X or H changes. In a
 * periodic axis positions may lie outside the box, by up to 1e9 boxes; distances wrap.
 *
 * A particle far away (1e30) costs nothing special: the number of cells is bounded by that of
 * particles.
 * Coincident particles are neighbours like any others. Many particles within one cutoff have
 * n^2 pairs: set max_pairs where that may happen. Memory: about 4 bytes a pair and direction and
 * 100 bytes a particle (Verlet 130, tree 160); a rebuild of a similar set allocates nothing.
 * Order, pairs and bits do not depend on the number of threads or on the instruction set.
 *
 * SPH_ERR_ARG: a position not finite or h not positive and finite (the first such particle is
 * named). SPH_ERR_LIMIT: more than 2^31 - 64 particles, a box narrower than two cutoffs (skin
 * included), a position further outside than 1e9 boxes, more than max_pairs. SPH_ERR_CALLBACK:
 * the progress hook asked to stop. SPH_ERR_NOMEM. On failure the previous list is intact.
 * Since 0.1. */
SPH_API sph_status sph_neighbors_build(sph_neighbors *list, const sph_particles *set);

/* The same for a host's own arrays: x is n * dim, h is n doubles or NULL for h0 everywhere. The
 * arrays are not kept. SPH_ERR_ARG also: n < 0, dim outside 1..3. Since 0.1. */
SPH_API sph_status sph_neighbors_build_arrays(sph_neighbors *list, int32_t dim, int64_t n,
                                              const double *x, const double *h, double h0);

/* Build if needed: nothing when no revision changed; for VERLET nothing while twice the largest
 * displacement since the last build is at most the skin (He 2015 gives no rule; Sun 2013 prints it
 * without the factor 2, but two particles may approach each other) and h is unchanged; else a
 * build. A list that is kept takes over the new positions. *rebuilt (may be NULL) tells. Sets are
 * told apart by address and counters: after destroying a set, build. Since 0.1. */
SPH_API sph_status sph_neighbors_update(sph_neighbors *list, const sph_particles *set,
                                        int32_t *rebuilt);

/* As sph_neighbors_update() for arrays, compared by displacement. Since 0.1. */
SPH_API sph_status sph_neighbors_update_arrays(sph_neighbors *list, int32_t dim, int64_t n,
                                               const double *x, const double *h, double h0,
                                               int32_t *rebuilt);

/* Particles of the last build; -1 for NULL. Since 0.1. */
SPH_API int64_t sph_neighbors_count(const sph_neighbors *list);
/* Pairs of the last build, once per direction, skin included; -1 for NULL. Since 0.1. */
SPH_API int64_t sph_neighbors_pairs(const sph_neighbors *list);
/* Number of builds so far; -1 for NULL. Since 0.1. */
SPH_API int64_t sph_neighbors_builds(const sph_neighbors *list);

/* The pairs as compressed rows in host order, for hosts that write their own loop: neighbours of
 * i are indices[offsets[i]] ... indices[offsets[i + 1] - 1], ascending, within the cutoff at the
 * positions of the last build or update. Owned by the list, valid until its next change. Built on
 * the first call after a change: O(pairs). SPH_ERR_STATE: never built. SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_neighbors_rows(sph_neighbors *list, const int64_t **offsets,
                                      const int32_t **indices);

/* Particles within `radius` of one arbitrary point (r < radius), ascending, at the positions of
 * the last build or update: at most `capacity` indices are written, *found receives how many there
 * are. capacity 0 with indices NULL only counts. SPH_ERR_ARG: point not finite, radius not
 * positive. SPH_ERR_STATE: never built. Since 0.1. */
SPH_API sph_status sph_neighbors_query(const sph_neighbors *list, const double *point,
                                       double radius, int64_t capacity, int32_t *indices,
                                       int64_t *found);

#ifdef __cplusplus
}
#endif
#endif
