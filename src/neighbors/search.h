/* Finding the pairs of a group: gather candidates, test every row against them.
 *
 * Candidates are copied, relative to the centre of the group, into
 * single-precision arrays; those too far from the box of the group are dropped. A row is then
 * tested in single precision against two bounds: below the lower one a candidate certainly is a
 * neighbour, above the upper one it certainly is none, and the few in between are decided by
 * the exact test in double precision. So the result is that of the exact test, at twice the
 * lanes and half the bytes. */
#ifndef SPHI_SEARCH_H
#define SPHI_SEARCH_H

#include "layout.h"

enum { SPHI_CANDIDATE_PADDING = 16 };

typedef struct sphi_candidates {
  float *x[3], *s;
  uint32_t *index;  /* sweep positions, ascending */
  uint32_t *row[3]; /* room for as many indices: rows that are found at the same time */
  int64_t count;
  int64_t capacity; /* SPHI_CANDIDATE_PADDING more can be written */
} sphi_candidates;

typedef struct sphi_group {
  const sphi_layout *l;
  int64_t begin, end;        /* rows */
  double center[3], half[3]; /* box of the rows */
  double s;                  /* bound of their s */
  int single;                /* 0: only the exact test is possible */
  int narrow;                /* a periodic box so narrow that each row has images of its own */
  float period[3];           /* 0 on open axes */
  float box[3];              /* half widths, rounded up */
  float low, high;           /* uniform: bounds of the squared distance */
  float doubt_linear, doubt_constant;
  float skin, s_group;
} sphi_group;

/* Error of a squared distance near a cutoff c, where no coordinate exceeds S = half width + reach
 * and so each is rounded to S * 2^-25, and differences likewise: at most 4.2e-7 S c + 6e-7 c^2;
 * where images are chosen in single precision, twice the first term. Taken as twice that. */
#define SPHI_DOUBT_LINEAR 1.7e-6
#define SPHI_DOUBT_SQUARE 1.5e-6f
#define SPHI_DOUBT_CONSTANT 1e-12

void sphi_group_set(sphi_group *g, const sphi_layout *l, int64_t begin, int64_t end);

/* Keep those of `doubtful` that are pairs of row i: lanes refer to index[lane]. */
uint32_t sphi_exact_lanes(const sphi_layout *l, int64_t i, const uint32_t *index,
                          uint32_t doubtful);

/* Append the candidates of some ranges; the caller has made sure that all would fit. */
typedef void (*sphi_gather_fn)(const sphi_group *g, const sphi_range *r, int count,
                               sphi_candidates *c);
/* Rows of the group into out[0 .. capacity): start[i] = base + its offset there, for as many rows
 * as surely fit. Returns the rows done; *used grows. */
typedef int64_t (*sphi_rows_fn)(const sphi_group *g, sphi_candidates *c, uint32_t *out,
                                int64_t capacity, int64_t *used, int64_t *start);

typedef struct sphi_search {
  sphi_gather_fn gather;
  sphi_rows_fn rows;
  sphi_boxes_fn boxes;
} sphi_search;

/* The loops for the instruction set of a context. */
const sphi_search *sphi_search_of(const sph_context *ctx);

/* For groups that single precision cannot serve (single 0). */
extern const sphi_search sphi_search_exact;
extern const sphi_search sphi_search_portable;
#if defined(__x86_64__)
extern const sphi_search sphi_search_avx2;
extern const sphi_search sphi_search_avx512;
#endif

#endif
