/* One build of a neighbour structure: the spatial order, and what finds candidates in it.
 *
 * A layout puts the particles in sweep order and can say, for a block of consecutive particles
 * (a group: one cell, or one leaf of the tree), which ranges of sweep positions may hold their
 * neighbours. What is done with the candidates is the same for every method (fill.c), and one
 * test decides, with the same arithmetic everywhere, so all methods find the same pairs. */
#ifndef SPHI_LAYOUT_H
#define SPHI_LAYOUT_H

#include "neighbors_impl.h"

enum {
  SPHI_POSITION_PADDING = 16, /* readable doubles after the last coordinate */
  SPHI_LEVELS = 12,           /* of the tree; 8^11 leaves are more than particles */
  SPHI_LEAF = 16,             /* most particles in a leaf of the tree */
  SPHI_BLOCK = 64,            /* most rows of a group that is cut from something larger */
  SPHI_MAX_RANGES = 64        /* candidate ranges handed out at a time; at least 27 */
};

/* Sweep positions [begin, end). */
typedef struct sphi_range {
  uint32_t begin, end;
} sphi_range;

/* The pair test. Each particle has one number s, from which the cutoff of a pair follows
 * symmetrically to the last bit; see sphi_reach(). */
typedef struct sphi_rule {
  double period[3], inverse[3]; /* box length and its inverse; 0 on open axes */
  double skin;                  /* 0 but for VERLET */
  double cut;                   /* cutoff (skin included) when uniform, else the largest one */
  double support;
  int32_t h_rule;
  int32_t uniform;  /* every particle has the same cutoff */
  int32_t periodic; /* some axis wraps */
  int32_t far;      /* positions lie so many boxes outside that wrapping costs digits */
  int32_t dim;
} sphi_rule;

typedef struct sphi_cells {
  int32_t count[3];     /* cells an axis */
  double lo[3], inv[3]; /* cell = clamp((x - lo) * inv); periodic axes wrap first */
  double wrap[3];       /* inverse box length of periodic axes, 0 otherwise */
  uint32_t *table[3];   /* cell number = table[0][ix] + table[1][iy] + table[2][iz] */
  uint32_t total;       /* cell numbers, those of tile padding included */
  int32_t tile[2];      /* cells of a tile in x and y */
  uint32_t *first;      /* total + 1: first sweep position of a cell */
} sphi_cells;

/* Eight boxes, as centre and half width, so that distances on a circle are simple. */
typedef struct sphi_boxes {
  double center[3][8], half[3][8];
  double s[8]; /* bound of the s of their particles, see sphi_rule_bound() */
} sphi_boxes;

typedef struct sphi_tree {
  sphi_boxes *level[SPHI_LEVELS]; /* 0: leaves; box k of a level holds eight of the one below */
  uint32_t boxes[SPHI_LEVELS];    /* how many there are */
  int levels;
  uint32_t *leaf; /* leaf_count + 1: first sweep position of each leaf */
  uint32_t leaf_count;
} sphi_tree;

typedef struct sphi_layout {
  int32_t method; /* 0: nothing built */
  int32_t dim;
  int64_t n;
  double h_uniform, h_max;
  sphi_rule rule;
  uint32_t *order;
  int64_t *start;
  double *x[3]; /* sweep order, padded */
  double *s;    /* sweep order; NULL when uniform */
  sphi_cells cells;
  sphi_tree tree;
  sphi_buffer b_order, b_start, b_x, b_s, b_table, b_first, b_nodes, b_leaf;
} sphi_layout;

/* What a build reads. */
typedef struct sphi_input {
  int32_t dim;
  int64_t n;
  const double *x, *h; /* h NULL: h0 */
  double h0;
  double lo[3], hi[3], h_min, h_max; /* found by sphi_input_scan() */
} sphi_input;

/* Buffers that a build needs for a while and that are kept for the next. */
typedef struct sphi_scratch {
  sphi_buffer key, histogram, sample, record, part;
} sphi_scratch;

/* Storage of pairs and the buffers to fill it with (fill.c). */
typedef struct sphi_pairs {
  sphi_buffer b_candidates, b_slots, b_rows, b_pair;
  int64_t candidate_capacity; /* a worker */
  int64_t slot_capacity;      /* a slot */
} sphi_pairs;

struct sphi_neighbors_private {
  sphi_layout layout[2]; /* [0] is the present one, [1] the next */
  sphi_scratch scratch;
  sphi_pairs pairs;
  sphi_buffer b_now;                /* VERLET: positions of the last update, sweep order */
  double *now[3];                   /* where they are: layout[0].x unless the list was reused */
  double moved;                     /* largest displacement since the build; 0 after a build */
  sphi_buffer b_offsets, b_indices; /* public rows */
  int32_t rows_valid;
  const void *set; /* identity only, never followed */
  uint64_t generation, revision_x, revision_h;
};

/* --- input.c: validation and the pair rule --- */
sph_status sphi_input_scan(sph_context *ctx, sphi_input *in, sphi_scratch *tmp);
void sphi_rule_set(sphi_rule *r, const sph_neighbors *list, const sphi_input *in);
/* s of a particle with smoothing length h. */
double sphi_rule_s(const sphi_rule *r, double h);
/* The s that gives the largest cutoffs: harmonic keeps inverses, so there it is the smaller. */
static inline double sphi_rule_bound(const sphi_rule *r, double a, double b) {
  int smaller = r->h_rule == SPH_H_HARMONIC;
  return (a < b) == smaller ? a : b;
}

/* --- layout.c: memory, positions in sweep order --- */
sph_status sphi_layout_reserve(sph_context *ctx, sphi_layout *l, const sphi_input *in);
void sphi_layout_free(sph_context *ctx, sphi_layout *l);
sph_status sphi_layout_build(const sph_neighbors *list, sphi_layout *l, const sphi_input *in,
                             sphi_scratch *tmp);

/* --- fill.c: pairs of a layout into list->pair and layout->start --- */
sph_status sphi_fill(sph_neighbors *list, sphi_layout *l);
/* Once more for a layout that was filled before: slower, needs no memory, cannot fail. */
void sphi_fill_again(sph_neighbors *list, sphi_layout *l);
void sphi_pairs_free(sph_context *ctx, sphi_pairs *p);

/* --- cells.c --- */
sph_status sphi_cells_build(sph_context *ctx, sphi_layout *l, const sphi_input *in,
                            const sph_neighbors_options *o, sphi_scratch *tmp);
uint32_t sphi_cells_at(const sphi_cells *c, uint32_t position);
/* Ranges of the cell and those around it, ascending, disjoint; at most 27. */
int sphi_cells_ranges(const sphi_cells *c, int32_t dim, uint32_t cell, sphi_range *out);
int sphi_cells_index(const sphi_cells *c, int axis, double x);

/* --- tree.c --- */
sph_status sphi_tree_build(sph_context *ctx, sphi_layout *l, const sphi_input *in,
                           sphi_scratch *tmp);
uint32_t sphi_tree_leaf_at(const sphi_tree *t, uint32_t position);
#define SPHI_REACH_MARGIN 1.000001 /* for rounding of boxes and distances */

/* A walk over the leaves within reach of a box: ranges until there are none. A radius >= 0 is
 * the reach; else it follows from s and the rule. */
typedef struct sphi_walk sphi_walk;
/* Lanes of eight boxes that are within reach: bits 0 to 7. */
typedef uint32_t (*sphi_boxes_fn)(const sphi_walk *w, const sphi_boxes *b);

struct sphi_walk {
  const sphi_tree *tree;
  sphi_boxes_fn near;
  const sphi_rule *rule;
  double center[3], half[3], s;
  double limit; /* square of the reach; negative: by the rule */
  int at;       /* level */
  uint32_t block[SPHI_LEVELS], mask[SPHI_LEVELS];
};

void sphi_walk_begin(sphi_walk *w, const sphi_tree *t, const sphi_rule *rule, sphi_boxes_fn near,
                     const double center[3], const double half[3], double s, double radius);
int sphi_walk_ranges(sphi_walk *w, sphi_range *out);

/* --- the pair test: the same operations in the same order wherever pairs are decided --- */

/* Adding and subtracting 1.5 * 2^52 rounds to the nearest integer, in one way on every machine;
 * arguments are below 2^51 because positions are checked to lie within 1e9 boxes. */
static inline double sphi_wrap(double d, double period, double inverse) {
  const double magic = 6755399441055744.0;
  double turns = (d * inverse + magic) - magic;
  return d - period * turns;
}

static inline double sphi_reach(const sphi_rule *r, double a, double b) {
  switch (r->h_rule) {
  case SPH_H_ARITHMETIC:
    return a + b;
  case SPH_H_HARMONIC:
    return 2.0 / (a + b);
  case SPH_H_MIN:
    return a < b ? a : b;
  default:
    return a > b ? a : b;
  }
}

static inline double sphi_distance2(const sphi_rule *r, const double *const x[3], int64_t i,
                                    int64_t j) {
  double sum = 0.0;
  for (int a = 0; a < r->dim; a++) {
    double d = x[a][i] - x[a][j];
    if (r->period[a] > 0.0) d = sphi_wrap(d, r->period[a], r->inverse[a]);
    sum = a == 0 ? d * d : sum + d * d;
  }
  return sum;
}

static inline int sphi_is_pair(const sphi_layout *l, int64_t i, int64_t j) {
  const double *const x[3] = {l->x[0], l->x[1], l->x[2]};
  double cut = l->rule.cut;
  if (!l->rule.uniform) cut = sphi_reach(&l->rule, l->s[i], l->s[j]) + l->rule.skin;
  return i != j && sphi_distance2(&l->rule, x, i, j) < cut * cut;
}

#endif
