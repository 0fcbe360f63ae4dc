/* Particle layouts: where to put particles, and how much volume each stands for.
 *
 * Points come as host arrays, n * dim doubles, particle-major; copy them into SPH_FIELD_X or lend
 * the array. Every layout is deterministic: the same options give the same bits, in the same order.
 *
 *   sph_layout_lattice(ctx, &lattice, 0, NULL, &n);      how many
 *   sph_layout_lattice(ctx, &lattice, n, x, &n);         write them
 *   sph_layout_volumes(ctx, &region, n, x, volume);      m = rho V, h = 1.5 V^(1/dim)
 *
 * "He" = L. He, PhD thesis, Durham 2015; "He & Seaid" = Acta Mech. 227 (2016). They name three
 * layouts about a hole, squared, radial and equally radial, by their pictures alone, and give every
 * particle the mass rho A / N; the area of its Voronoi cell, which He suggests, is the better one:
 * it counts half cells on a face as half. */
#ifndef SPH_LAYOUT_H
#define SPH_LAYOUT_H

#include <sph/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Whether a point belongs to a host's region: nonzero inside. Pure: the answer depends on the
 * point alone. sph_layout_volumes() calls it on several threads at once. */
typedef int32_t (*sph_inside_fn)(void *user, const double *point);

/* Lattices of spacing s in the box [lo, hi]. The number of cells along each axis is the nearest
 * whole number, at least 1, and the lattice is stretched to fit; it is exact where the sides are
 * multiples of the steps
 *
 *   CARTESIAN   s along each axis
 *   HEXAGONAL   1-D as Cartesian; 2-D triangles: s, sqrt(3)/2 s; 3-D hexagonal close packing
 *               (layers ABAB, twelve neighbours at s): s, sqrt(3)/2 s, sqrt(2/3) s
 *
 * CENTRED puts particles at the middles of equal cells that fill the box, so that all have the same
 * volume, and the lattice goes on through periodic faces (HEXAGONAL: when the number of rows, and
 * in 3-D of layers, is even). FACES puts the outermost rows on the faces. A Cartesian lattice is
 * then symmetric about the middle of the box; a hexagonal one with FACES in x, and in y where the
 * number of row steps is even; with CENTRED under a half turn where the number of rows is even. To
 * the bit where the middle is at 0, else to rounding. */
enum { SPH_LATTICE_CARTESIAN = 1, SPH_LATTICE_HEXAGONAL = 2 };
enum { SPH_LATTICE_CENTRED = 1, SPH_LATTICE_FACES = 2 };

typedef struct sph_lattice_options {
  size_t size;          /* set by sph_lattice_options_init() */
  int32_t dim;          /* 1, 2 or 3; must be given */
  int32_t kind;         /* SPH_LATTICE_CARTESIAN (default) or _HEXAGONAL */
  int32_t anchor;       /* SPH_LATTICE_CENTRED (default) or _FACES */
  double spacing;       /* s > 0, a length; must be given */
  double lo[3], hi[3];  /* the box, the first dim entries; lo < hi; default [0, 1] */
  sph_inside_fn inside; /* NULL (default): all points; else only those inside are kept */
  void *inside_user;
} sph_lattice_options;

/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_lattice_options_init_sized(sph_lattice_options *options, size_t size);
#define sph_lattice_options_init(o) sph_lattice_options_init_sized((o), sizeof(sph_lattice_options))

/* Points of a lattice, x running fastest, then y. x: room for `capacity` points, the host's; NULL
 * with capacity 0 only counts. *n receives their number. O(points of the box).
 *
 * SPH_ERR_ARG: dim, kind, anchor or spacing out of range, a box that is empty or not finite,
 * capacity negative, x NULL with a capacity, n NULL. SPH_ERR_LIMIT: more than 2^31 - 64 points in
 * the box, or more than capacity (the sentence says how many); x and *n are untouched then.
 * SPH_ERR_VERSION. Since 0.1. */
SPH_API sph_status sph_layout_lattice(sph_context *ctx, const sph_lattice_options *options,
                                      int64_t capacity, double *x, int64_t *n);

/* Layouts of a rectangle with circular holes, 2-D.
 *
 *   EQUALLY_RADIAL  rings about hole 0 at the radii r + (k + offset) s; on each the multiple of
 *                   four points whose distance is nearest to s, counted along the ring
 *   RADIAL          rays from hole 0 to the rectangle, equally many points on each, at radii that
 *                   grow by a constant factor along the ray, so that cells are about square: fine
 *                   at the hole, coarse outside, as many as spacing s would give without other
 * holes SQUARED         a Cartesian lattice through the corner lo
 *
 * Of these the points within the closed rectangle and outside every hole stay. Then `edge_rings`
 * rings follow on every other hole (for SQUARED on every hole, hole 0 as well), the first at
 * offset * s from its edge, and, as far as `faces` says, a row of particles on each face, corners
 * included. Where they come closer than clearance * s to each other or to the points above, the
 * later named stays: rows on faces before rings, rings before the rest.
 *
 * A quarter of a symmetric plate is the rectangle whose corner is the centre of hole 0, with
 * `faces` of the two outer sides: phase 0 puts particles on the planes of symmetry, phase 0.5 half
 * a step beside them. Layouts are symmetric to the bit about the centre of hole 0 at (0, 0) as far
 * as rectangle and holes are; elsewhere to rounding. */
enum { SPH_HOLES_EQUALLY_RADIAL = 1, SPH_HOLES_RADIAL = 2, SPH_HOLES_SQUARED = 3 };
enum { SPH_FACE_X_LO = 1, SPH_FACE_X_HI = 2, SPH_FACE_Y_LO = 4, SPH_FACE_Y_HI = 8 };

typedef struct sph_hole_layout_options {
  size_t size;         /* set by sph_hole_layout_options_init() */
  int32_t kind;        /* SPH_HOLES_*; default EQUALLY_RADIAL */
  int32_t holes;       /* how many, at least 1; must be given */
  const double *hole;  /* holes * 3: centre x, centre y, radius > 0; must be given */
  double spacing;      /* s > 0, a length; must be given */
  double lo[2], hi[2]; /* the rectangle; lo < hi; default [0, 1] */
  int32_t faces;       /* SPH_FACE_* or-ed: rows of particles on these; default all four */
  int32_t edge_rings;  /* on the other holes, 0..100; default 1 */
  double offset;       /* of the first ring from its hole's edge, in s, 0..1; default 0 */
  double phase;        /* 0 (default): a point on each half axis of a ring; 0.5: half a step on.
                        * In steps along the ring; only these two */
  double clearance;    /* 0..1, in s; default 0.6 */
} sph_hole_layout_options;

/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_hole_layout_options_init_sized(sph_hole_layout_options *options, size_t size);
#define sph_hole_layout_options_init(o) \
  sph_hole_layout_options_init_sized((o), sizeof(sph_hole_layout_options))

/* Points of a layout about holes; x, capacity and n as for sph_layout_lattice(). O(points * (holes
 * + face rows near them)).
 *
 * SPH_ERR_ARG: an option out of range or not finite, holes that overlap (named), for RADIAL a hole
 * 0 without room for a ray, what sph_layout_lattice() says of its arguments. SPH_ERR_LIMIT: as
 * there. SPH_ERR_VERSION. Since 0.1. */
SPH_API sph_status sph_layout_holes(sph_context *ctx, const sph_hole_layout_options *options,
                                    int64_t capacity, double *x, int64_t *n);

/* Move every coordinate by a random number, uniform in [-amplitude, amplitude]. The number depends
 * on the seed, the index of the point and the axis alone: same seed, same points. A point that
 * would leave a region (`inside`, NULL: none) stays where it is. x: n * dim, in place. O(n).
 * SPH_ERR_ARG: dim outside 1..3, n negative, x NULL with n > 0, amplitude negative or not finite.
 * Since 0.1. */
SPH_API sph_status sph_layout_jitter(sph_context *ctx, int32_t dim, double amplitude, uint64_t seed,
                                     sph_inside_fn inside, void *inside_user, int64_t n, double *x);

/* The region that the particles share: a box, less disjoint circular holes (2-D), less what is not
 * `inside`. Holes may be cut by the faces of the box. */
typedef struct sph_region_options {
  size_t size;          /* set by sph_region_options_init() */
  int32_t dim;          /* 1, 2 or 3; must be given */
  double lo[3], hi[3];  /* the box, the first dim entries; lo < hi; default [0, 1] */
  int32_t holes;        /* 2-D: how many; default 0 */
  const double *hole;   /* holes * 3: centre x, centre y, radius > 0 */
  sph_inside_fn inside; /* NULL (default): all of the box less the holes */
  void *inside_user;
  int32_t levels; /* of halving for `inside`, 0..12; default 5 */
} sph_region_options;

/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_region_options_init_sized(sph_region_options *options, size_t size);
#define sph_region_options_init(o) sph_region_options_init_sized((o), sizeof(sph_region_options))

/* Length, area or volume of each particle's Voronoi cell within the region: of all that lies nearer
 * to it than to any other particle. The cell is the box cut by the half-planes towards the
 * neighbours, nearest first, until none that is left could reach it. volumes: n, the host's.
 *
 * They add up to the measure of the region. A box, and a box with circular holes: exact, the sum to
 * 1e-12 relative. With `inside` the cells are halved `levels` times (long ones more, down to the
 * mean spacing s first) and what is left is cut straight between the points where its edges cross
 * the boundary (found by bisection, to 1e-9 of an edge): for a smooth boundary of radius R the sum
 * errs by about L (s / 2^levels)^2 / (12 R), L its length; in 3-D likewise with its area, and each
 * level costs four times the one before: take 1 to 3. Parts of the region thinner than s / 4 may be
 * missed. What is nearest to a particle is its own even across a hole or a slit.
 *
 * For particles on a plane of symmetry, of which the model has one side, double the volume.
 *
 * O(n) cells; the worst case, many particles equally far from one, is O(n^2). About 200 bytes a
 * particle and 84 bytes a worker for each candidate of a cell (256 or more), given back. On the
 * context's threads, same bits for any number of them.
 * SPH_ERR_ARG: an option out of range, not finite or not for this dim, holes that overlap (named),
 * n negative, an array NULL with n > 0, a particle not finite, outside the box, or at the same
 * place as another (the first is named). SPH_ERR_VERSION,
 * SPH_ERR_NOMEM. volumes are untouched then. Since 0.1. */
SPH_API sph_status sph_layout_volumes(sph_context *ctx, const sph_region_options *options,
                                      int64_t n, const double *x, double *volumes);

/* ---- centroidal layouts -------------------------------------------------------------------- */

typedef struct sph_relax_options {
  size_t size;        /* set by sph_relax_options_init() */
  int32_t iterations; /* at most so many, >= 0; default 100 */
  double tolerance;   /* it ends when no particle moves farther, in mean spacings, >= 0; default
                       * 1e-3 */
  double relaxation;  /* how far a particle goes, in distances to its centroid, 0 < w < 2; default
                       * 1.5 */
} sph_relax_options;
/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_relax_options_init_sized(sph_relax_options *options, size_t size);
#define sph_relax_options_init(o) sph_relax_options_init_sized((o), sizeof(sph_relax_options))

typedef struct sph_relax_result {
  size_t size;
  int32_t iterations; /* done */
  double moved;       /* farthest way of a particle in the last one */
  double energy;      /* sum_i int over cell i of |y - x_i|^2 dy, as it is now */
  double smallest;    /* least and largest volume of a cell, as they are now */
  double largest;
} sph_relax_result;
/* Fill *result with zeros. Since 0.1. */
SPH_API void sph_relax_result_init_sized(sph_relax_result *result, size_t size);
#define sph_relax_result_init(r) sph_relax_result_init_sized((r), sizeof(sph_relax_result))

/* Move particles until each is the centroid of its Voronoi cell within the region (Lloyd's method,
 * over-relaxed; Du, Faber, Gunzburger, SIAM Review 41 (1999) 637): even spacing that follows any
 * boundary, half a spacing away from it. Cells become about equal, hexagons in 2-D; not exactly,
 * nor is the layout found the best there is. Zisis (section 4.4) names this layout for arbitrary
 * shapes and does not describe it.
 *
 * x: n * dim, in place, all of them within the region. volumes: NULL,
 * or n, receives the volumes of the cells as sph_layout_volumes() gives them. options NULL:
 * defaults. result: NULL, or initialised. The energy falls in every iteration, but for what halving
 * misses where `inside` or holes cut cells (`levels`). A particle that would leave the region goes
 * half of the way, and so on. Each iteration costs about one sph_layout_volumes().
 *
 * Errors as sph_layout_volumes(), also SPH_ERR_ARG for a particle that is not in the region (it is
 * named). x, volumes and *result are as before then. On the context's threads, same bits for any
 * number of them. Since 0.1. */
SPH_API sph_status sph_layout_relax(sph_context *ctx, const sph_region_options *region,
                                    const sph_relax_options *options, int64_t n, double *x,
                                    double *volumes, sph_relax_result *result);

/* ---- several materials --------------------------------------------------------------------- */

/* What stands at a point: a phase 0 .. phases - 1, or a negative number for nothing. Pure, and
 * called on several threads at once. */
typedef int32_t (*sph_phase_fn)(void *user, const double *point);

/* How a phase is filled: with a lattice SPH_LATTICE_* of its own, or
 *   RELAXED   by sph_layout_relax() from a hexagonal lattice, of which as many particles are
 *             dropped or added as the volume of the phase asks for */
enum { SPH_LAYOUT_RELAXED = 3 };

/* What particles of different phases have in common, Zisis section 4.4 (a) and (b):
 *   MASS      spacing D_L in the phase of the lowest density rho_L, D_L (rho_L / rho)^(1/d) in the
 *             others. The resolution of all is that of the lightest (misprinted in the source's
 *             epitome). Better at contacts
 *   SPACING   the same spacing everywhere, so that masses are as densities. Generic and cheap; take
 *             number smoothing with it */
enum { SPH_EQUAL_MASS = 1, SPH_EQUAL_SPACING = 2 };

typedef struct sph_material_layout_options {
  size_t size;           /* set by sph_material_layout_options_init() */
  int32_t dim;           /* 1, 2 or 3; must be given */
  int32_t kind;          /* SPH_LATTICE_CARTESIAN (default), _HEXAGONAL or SPH_LAYOUT_RELAXED */
  int32_t equal;         /* SPH_EQUAL_MASS (default) or _SPACING */
  double spacing;        /* > 0, a length: D_L, or that of all; must be given. A particle stands for
                          * spacing^dim (hexagonal lattices: as sph_layout_lattice() has it) */
  double lo[3], hi[3];   /* the box; lo < hi; default [0, 1] */
  int32_t phases;        /* 1..256; default 1 */
  const double *density; /* phases, > 0; NULL: all 1 */
  const double *boxes;   /* NULL: the box for every phase; else phases * 2 * dim: lo, hi of a box
                          * about each, on whose faces its lattice begins with half a spacing. What
                          * lies outside stays empty. A phase in several parts whose lattices should
                          * fit their edges is better made several phases */
  sph_phase_fn phase;    /* NULL: each phase fills its own box (without boxes: the one phase all) */
  void *phase_user;
  int32_t levels;                 /* of halving, RELAXED: as in sph_region_options; default 3 */
  const sph_relax_options *relax; /* RELAXED; NULL: its defaults */
} sph_material_layout_options;
/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_material_layout_options_init_sized(sph_material_layout_options *options,
                                                    size_t size);
#define sph_material_layout_options_init(o) \
  sph_material_layout_options_init_sized((o), sizeof(sph_material_layout_options))

/* Particles of several materials, phase by phase. x: capacity * dim, phase and volume: capacity
 * each, the host's; all three NULL with capacity 0 only counts (RELAXED: measures the phases, but
 * does not relax). *n receives their number. The mass of a particle is density * volume.
 *
 * volume, for lattices: the cell of the lattice, also for particles at an edge of the phase, so
 * that masses are exactly equal where the lattices fit their boxes; the sum is that of the phase
 * where it fills its box. For RELAXED: the Voronoi cell within the phase, whose sum is the volume
 * of the phase (to the halving, and but for what lies more than two spacings from its particles);
 * with MASS give each the mean of its phase where all masses must be equal: they then differ
 * between phases by the rounding of counts, 1 / (2 n) relative at most.
 *
 * SPH_ERR_ARG: an option out of range or not finite (named), phases without `phase` and boxes,
 * capacity negative, an array NULL, a phase beyond `phases` (named). SPH_ERR_LIMIT: more than
 * capacity, or 2^31 - 64. SPH_ERR_VERSION,
 * SPH_ERR_NOMEM. Outputs are untouched then. O(points of the lattices), RELAXED as above. Same bits
 * for any number of threads. Since 0.1. */
SPH_API sph_status sph_layout_materials(sph_context *ctx,
                                        const sph_material_layout_options *options,
                                        int64_t capacity, double *x, int32_t *phase, double *volume,
                                        int64_t *n);

#ifdef __cplusplus
}
#endif
#endif
