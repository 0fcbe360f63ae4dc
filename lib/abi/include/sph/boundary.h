/* Boundaries: ghost particles behind plane walls, and particles that are held or driven.
 *
 * A ghost is the mirror image of a real particle behind a wall. A sph_ghosts handle holds the walls
 * and makes the ghosts of a particle set: "update" finds out which particles need images, "refresh"
 * writes the fields of the images that are there. As the prepare hook of a composed right-hand side
 * it does what is needed in every stage:
 *
 *   sph_ghosts_create(ctx, &options, &ghosts);
 *   sph_wall_init(&wall);  wall.kind = SPH_WALL_SLIP;  wall.normal[1] = 1.0;
 *   sph_ghosts_add_wall(ghosts, &wall, NULL);
 *   sph_rhs_set_prepare(rhs, sph_ghosts_prepare, ghosts);
 *
 * A wall is a plane: a point on it and its normal n, which points into the body. The body is what
 * lies in front of all walls; a free surface is simply no wall. At a distance d = n.(x - point) the
 * image of x is x - 2 d n. r: the real particle; g: its image; b: the wall; Q = I - 2 n n^T:
 *
 *   kind       velocity v_g                             stress sigma_g
 *   SLIP       v_r - 2 [(v_r - v_b).n] n                Q sigma_r Q + A(-2 d rho [(a_b - g).n] n)
 *   NO_SLIP    (1 - beta) v_r + beta v_b,               sigma_r + A(-2 d rho (a_b - g))
 *              beta = min(beta_max, 1 + d_g/d_r)
 *   PAIRWISE   by pairs, see sph_no_slip_gradient()     by pairs
 *   TRACTION   v_r - 2 d dv/dn                          sigma_r + A(2 (-t - sigma_r n))
 *   VELOCITY   2 v_b - v_r                              sigma_r + A(-2 d rho (a_b - g))
 *
 * Here A(c) = c n^T + n c^T - (c.n) n n^T changes the traction sigma n by c and leaves the stress
 * within the wall alone; rho is that of r; g the options' gravity; t the force per area on the body
 * (a pressure p is t = p n). At equal distances d_g = d_r, so that beta = min(beta_max, 2) for
 * mirror images: 2 reproduces linear fields, 1.5 is He's bound. At a TRACTION wall
 *
 *   dv_n/dn = (w_n - (M - 2 G) D_t) / M,   dv_t/dn = w_t/G - grad_t v_n,   w = -dt/dt,
 *
 * n along and t across the normal, D_t the divergence of the velocity within the wall, M and G the
 * wall's moduli; each line is 0 where its modulus is 0. D_t and grad_t v_n are taken from the
 * velocity gradient of r where the options name a field with it, else they are 0.
 *
 * Sources: He = L. He, PhD thesis, Durham 2015: NO_SLIP (3.10), where (3.10b) prints -beta v_b (a
 * linear field then becomes -7.5 where 0.5 is due: (3.10a) gives the plus), stress (3.11); SLIP
 * (3.12), generalised from walls along the axes. He does not say how a traction or a velocity is
 * imposed. The terms in d are Taylor expansions about the wall: rho (a_b - g) = d(sigma n)/dn from
 * the momentum balance without derivatives of the stress along the wall, dv/dn from Hooke's law,
 * d sigma_nn/dt = M dv_n/dn + (M - 2 G) D_t and d sigma_nt/dt = G (dv_t/dn + grad_t v_n) (1-D: M =
 * E). They raise the order of convergence of waves from 1 to 2, at TRACTION walls in 2-D and 3-D
 * with the velocity gradient, unless nothing varies along the wall. The SLIP wall of a body without
 * forces has that order anyway.
 *
 * All fields of the set are mirrored: X about the wall as it is, X0 about the wall as it was added,
 * V and SIGMA as above, A as a vector (Q A); pressure P_r + 2 d rho (a_b - g).n, at TRACTION walls
 * 2 t.n - P_r; others, the host's fields too, are copied, with the phase. sph_ghosts_set_mirror()
 * changes that. Images about several walls at right angles (edges, corners) pass through one wall
 * after the other, in the order in which they were added; where velocities and accelerations of the
 * walls agree at the corner any order gives the same.
 *
 * In a frozen configuration (position_field X0) X is X0_g + u_g instead, with the displacement u as
 * the velocity: Q u + 2 (u_b.n) n at SLIP walls, 2 u_b - u at those that stick, u at TRACTION
 * walls, u_b being how far the wall's point has moved since it was added. The full total-Lagrangian
 * form (rhs.h) makes F and PK of the ghosts itself, from X: SLIP and sticking walls act on it as
 * they should, TRACTION walls do not. */
#ifndef SPH_BOUNDARY_H
#define SPH_BOUNDARY_H

#include <sph/rhs.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_ghosts sph_ghosts;
typedef struct sph_hold sph_hold;

/* ---- Walls ------------------------------------------------------------------------------- */

enum {
  SPH_WALL_SLIP = 1,     /* slip, or a plane of symmetry */
  SPH_WALL_NO_SLIP = 2,  /* sticks, by mirror images */
  SPH_WALL_PAIRWISE = 3, /* sticks, by pairs */
  SPH_WALL_TRACTION = 4, /* given force per area; t = 0: a free surface with images */
  SPH_WALL_VELOCITY = 5  /* sticks to a moving wall, second order; NO_SLIP with beta 2 */
};

/* What a wall imposes at a place of it. Vectors; the first dim entries count. */
typedef struct sph_wall_data {
  double velocity[3];      /* v_b */
  double acceleration[3];  /* a_b = dv_b/dt */
  double traction[3];      /* t, force per area on the body */
  double traction_rate[3]; /* dt/dt */
} sph_wall_data;

/* Values that vary along a wall: *data holds the wall's own on entry. `x` is the foot of the
 * perpendicular from the real particle, dim entries. Called once an image and wall in every update
 * and refresh, on several threads at once. */
typedef void (*sph_wall_data_fn)(void *user, double t, const double *x, sph_wall_data *data);

struct sph_wall;
/* The wall at time t: may write point, normal and data of *wall, which holds what it was last.
 * Called once in every update and refresh, on the calling thread. 0: go on; positive: SPH_RETRY;
 * negative: SPH_ERR_CALLBACK. */
typedef int32_t (*sph_wall_fn)(void *user, double t, struct sph_wall *wall);

typedef struct sph_wall {
  size_t size;        /* set by sph_wall_init() */
  int32_t kind;       /* SPH_WALL_*; must be given */
  int32_t phase;      /* mirrors particles of this phase only; default -1: all */
  double point[3];    /* a point of the plane; default 0 */
  double normal[3];   /* into the body; any length but 0, is made a unit vector */
  sph_wall_data data; /* default 0 */
  double beta_max;    /* NO_SLIP, PAIRWISE: >= 1, may be infinite; default 1.5 */
  double modulus;     /* TRACTION: M, of d sigma_nn/dt = M dv_n/dn: Young's modulus in 1-D, lambda +
                       * 2 G for plane waves in 2-D and 3-D; 0 (default): v_g,n = v_r,n */
  double shear_modulus; /* TRACTION: G; 0 (default): v_g,t = v_r,t */
  sph_wall_fn move;     /* NULL: it stays as it is set */
  void *move_user;
  sph_wall_data_fn vary; /* NULL: `data` all along the wall */
  void *vary_user;
} sph_wall;

/* Fill *wall with the defaults. Since 0.1. */
SPH_API void sph_wall_init_sized(sph_wall *wall, size_t size);
#define sph_wall_init(w) sph_wall_init_sized((w), sizeof(sph_wall))

/* ---- Ghosts ------------------------------------------------------------------------------ */

/* A particle behind a wall (d < 0). */
enum {
  SPH_ESCAPE_FAIL = 1,  /* SPH_ERR_STATE, naming particle and wall */
  SPH_ESCAPE_RETRY = 2, /* SPH_RETRY: a smaller step is asked for */
  SPH_ESCAPE_IGNORE = 3 /* it has no image about this wall (a two-sided wall, a lost particle) */
};

typedef struct sph_ghosts_options {
  size_t size;            /* set by sph_ghosts_options_init() */
  int32_t dim;            /* 1, 2 or 3; default 3 */
  int32_t position_field; /* by which distances are judged: SPH_FIELD_X (default), or SPH_FIELD_X0,
                           * with the walls as they were added, for a frozen configuration */
  /* reach = support * largest h: no pair is missed; default 2. Twice the kernel's support where a
   * term makes something of a ghost from the ghost's own neighbours: the CONSERVATIVE forms (its
   * gradient matrix) and the full total-Lagrangian form (its F) */
  double support;
  double reach;        /* > 0: this length instead; default 0 */
  double skin;         /* images are made for particles nearer than reach + skin, and serve until
                        * one has moved by skin, so that a Verlet list lives on; default 0 */
  int32_t periodic[3]; /* nonzero: the axis wraps around; walls must be parallel to it */
  int32_t escape;      /* SPH_ESCAPE_*; default FAIL */
  double gravity[3];   /* body force per mass that the particles feel; default 0 */
  /* A field of the host's (dim * dim components) with the velocity gradient L of the real
   * particles, for TRACTION walls; default -1: none. A value of the last step will do: what it is
   * late by is of second order. Images get -L Q at walls that stick, Q L Q at SLIP walls, L at
   * TRACTION walls. */
  int32_t gradient_field;
} sph_ghosts_options;

/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_ghosts_options_init_sized(sph_ghosts_options *options, size_t size);
#define sph_ghosts_options_init(o) sph_ghosts_options_init_sized((o), sizeof(sph_ghosts_options))

/* Create a handle without walls. options may be NULL. *out is NULL on failure.
 * SPH_ERR_ARG: dim outside 1..3, position_field neither X nor X0, support, reach, skin or gravity
 * negative (gravity: not finite), an unknown escape, gradient_field neither -1 nor 64..127.
 * SPH_ERR_VERSION, SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_ghosts_create(sph_context *ctx, const sph_ghosts_options *options,
                                     sph_ghosts **out);

/* Destroy; ghosts that a set holds stay there. NULL is allowed. Since 0.1. */
SPH_API void sph_ghosts_destroy(sph_ghosts *ghosts);

/* Add a wall, at most 32; copied. *index (may be NULL) receives its number, 0 upwards. Takes effect
 * with the next update.
 * SPH_ERR_ARG: unknown kind, normal of length 0 or with a part along a periodic axis, a number not
 * finite, beta_max < 1, a negative modulus, a wall that faces the same way as another one for the
 * same particles. SPH_ERR_LIMIT, SPH_ERR_VERSION. Since 0.1. */
SPH_API sph_status sph_ghosts_add_wall(sph_ghosts *ghosts, const sph_wall *wall, int32_t *index);

/* Replace a wall, for example to move it between steps; its place for X0 stays that of
 * sph_ghosts_add_wall(). Errors as there, and SPH_ERR_ARG: no such wall. Since 0.1. */
SPH_API sph_status sph_ghosts_set_wall(sph_ghosts *ghosts, int32_t index, const sph_wall *wall);

/* The wall as it was last set or moved; wall->size must be set, by sph_wall_init(). SPH_ERR_ARG: no
 * such wall. Since 0.1. */
SPH_API sph_status sph_ghosts_get_wall(const sph_ghosts *ghosts, int32_t index, sph_wall *wall);

/* How a field is mirrored. */
enum {
  SPH_MIRROR_COPY = 1,   /* the owner's value; default of the host's fields */
  SPH_MIRROR_VECTOR = 2, /* Q f; dim components */
  SPH_MIRROR_TENSOR = 3, /* Q f Q; packed symmetric */
  SPH_MIRROR_LEAVE = 4,  /* not written: the host does it, see sph_ghosts_owners() */
  SPH_MIRROR_WALL = 5,   /* by the kind of wall; only and the default of X, X0, V, SIGMA, P, A, M */
  SPH_MIRROR_MATRIX = 6  /* Q f Q; dim * dim, row-major; default of F, PK */
};

/* Choose for one field, built-in or the host's (its id). SPH_ERR_ARG: a field outside 0..127, an
 * unknown mirror, WALL for another field. Whether the components fit shows in the update.
 * Since 0.1. */
SPH_API sph_status sph_ghosts_set_mirror(sph_ghosts *ghosts, int32_t field, int32_t mirror);

/* Make the ghosts of `set` at time t: images of every real particle nearer than reach + skin to a
 * wall, or to an edge or corner of walls at right angles (one image for each set of walls), in the
 * order of their owners, then of the sets of walls. All ghosts of the set belong to the handle:
 * what was there is replaced. A particle on a wall (d below 1e-9 reach) is its own image and gets
 * none. Does not allocate in the set when the ghosts fit (sph_particles_reserve()); a set lent
 * arrays needs room for the ghosts in them. H must exist unless options.reach is given.
 *
 * SPH_ERR_ARG: another dimension, a missing field X0, H or gradient_field, a mirror that does not
 * fit the components. SPH_ERR_STATE: an escaped particle. SPH_ERR_UNSUPPORTED: a particle within
 * reach of the edge of two walls that are not at right angles, for which mirror images do not
 * close; two walls face to face that are closer than reach + skin. SPH_ERR_LIMIT: a lent array has
 * no room, or 2^31 - 64 particles. SPH_RETRY, SPH_ERR_CALLBACK: from walls; SPH_ERR_NOMEM. The
 * ghosts are as before then. O(n walls + ghosts fields), on the context's threads; the same bits
 * for any number of them. Since 0.1. */
SPH_API sph_status sph_ghosts_update(sph_ghosts *ghosts, sph_particles *set, double t);

/* Write the fields of the existing ghosts from their owners at time t: O(ghosts fields). X, X0 and
 * H are touched where they changed. SPH_ERR_STATE: no update since the set changed, or an escaped
 * owner (with IGNORE such a ghost gets the mass 0 until the next update). Others as above; the
 * ghosts are as before then. Since 0.1. */
SPH_API sph_status sph_ghosts_refresh(sph_ghosts *ghosts, sph_particles *set, double t);

/* A prepare hook (user: the sph_ghosts): refresh while the images serve, else update. The
 * answer is their status, which a right-hand side turns into SPH_RETRY or SPH_ERR_CALLBACK with
 * the sentence that says why. Since 0.1. */
SPH_API int32_t sph_ghosts_prepare(void *ghosts, double t, sph_particles *set,
                                   const sph_rate *rates, int32_t count);

/* Ghosts of the last update; -1 for NULL. Since 0.1. */
SPH_API int64_t sph_ghosts_count(const sph_ghosts *ghosts);

/* The real particle of each ghost: ghost k is particle real_count + k of the set. Valid until the
 * next update; NULL for NULL. Since 0.1. */
SPH_API const int64_t *sph_ghosts_owners(const sph_ghosts *ghosts);

/* The walls of each ghost: bit w is set where it is an image about wall w. Since 0.1. */
SPH_API const uint32_t *sph_ghosts_walls(const sph_ghosts *ghosts);

/* Put particles that escaped back between steps: mirrored to the front of the wall, with the part
 * of their velocity relative to it that points out of the body turned round; V is left alone where
 * it does not exist. *count (may be NULL) receives how many. Changes X, touched, and V; not the
 * ghosts. With position_field X0 nothing escapes. SPH_ERR_ARG as for the update. O(n walls).
 * Since 0.1. */
SPH_API sph_status sph_ghosts_recapture(sph_ghosts *ghosts, sph_particles *set, int64_t *count);

/* ---- No-slip by pairs -------------------------------------------------------------------- */

/* He 2015 (3.10), (3.11) for a pair of a real particle i and a ghost j behind a PAIRWISE wall: i
 * sees the velocity v_j = (1 - beta) v_i + beta v_b, beta = min(beta_max, 1 + d_j/d_i), and the
 * stress, pressure and density of its own. A field that is linear in the distance is reproduced
 * exactly where beta_max does not act. Of several walls of a ghost the one counts that the line
 * from i to j meets first.
 *
 * These ghosts have mass 0, so that the library's terms do not see them; the functions below, added
 * with sph_rhs_add_host() and the handle as `user`, make their sums, with the owners' masses:
 *
 *   sph_no_slip_gradient     SPH_TARGET_VELOCITY_GRADIENT   sum V_j (v_j - v_i) (x) g_ij
 *   sph_no_slip_continuity   SPH_FIELD_RHO                  rho_i sum V_j (v_i - v_j).g_ij
 *   sph_no_slip_stress       SPH_FIELD_V                    sum m_j 2 sigma_i/rho_i^2 g_ij
 *   sph_no_slip_pressure     SPH_FIELD_V                    -sum m_j 2 p_i/rho_i^2 g_ij
 *
 * with V_j = m_j/rho_i. The last two belong to the summed forms; in difference forms the ghosts
 * exert no force. The gradients are plain: use the library's terms without `corrected`, for the
 * correction from real particles alone would count the wall twice. Since 0.1. */
SPH_API void sph_no_slip_gradient(void *ghosts, const sph_pair_block *block, double *out);
/* For SPH_FIELD_RHO, see above. Since 0.1. */
SPH_API void sph_no_slip_continuity(void *ghosts, const sph_pair_block *block, double *out);
/* For SPH_FIELD_V, from SIGMA, see above. Since 0.1. */
SPH_API void sph_no_slip_stress(void *ghosts, const sph_pair_block *block, double *out);
/* For SPH_FIELD_V, from P, see above. Since 0.1. */
SPH_API void sph_no_slip_pressure(void *ghosts, const sph_pair_block *block, double *out);

/* ---- Held and driven particles ----------------------------------------------------------- */

/* Rate of a held value of particle i: writes `components` numbers (of the field; a traction: dim).
 * On the calling thread. */
typedef void (*sph_hold_fn)(void *user, double t, int64_t i, double *rate);

/* A list of held values, whose rates the finish hook overwrites: particles of a clamp (V: rate 0),
 * of a driven row (V: the given acceleration), surface particles whose traction is given
 * (difference form of the stress, which has no natural traction condition). *out is NULL on
 * failure. SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_hold_create(sph_context *ctx, sph_hold **out);
/* Destroy. NULL is allowed. Since 0.1. */
SPH_API void sph_hold_destroy(sph_hold *hold);

/* Hold `field` of n particles (indices, copied; NULL: first, first + 1, ...; real ones, no longer
 * valid when the set is sorted or particles are removed): the rates of the components in the mask
 * `components` (bit c; all bits: the whole field) become what fn writes, 0 where fn is NULL. The
 * last of several entries for one value counts. *index (may be NULL) receives the entry's number.
 * SPH_ERR_ARG: field outside 0..127, n, first or an index negative, a mask of 0. SPH_ERR_NOMEM.
 * Since 0.1. */
SPH_API sph_status sph_hold_field(sph_hold *hold, int32_t field, int64_t n, const int64_t *indices,
                                  int64_t first, uint64_t components, sph_hold_fn fn, void *user,
                                  int32_t *index);

/* Hold the traction sigma m of n surface particles with outward normals m (`normals`: n * 3,
 * copied, unit vectors are made; the first dim entries count): the rate of SIGMA is changed by A(c)
 * (see the top) so that (d sigma/dt) m is what fn writes, 0 where fn is NULL; its components within
 * the surface are kept. SPH_ERR_ARG also: a normal of length 0 or not finite. Since 0.1. */
SPH_API sph_status sph_hold_traction(sph_hold *hold, int64_t n, const int64_t *indices,
                                     int64_t first, const double *normals, sph_hold_fn fn,
                                     void *user, int32_t *index);

/* Forget all entries. Since 0.1. */
SPH_API sph_status sph_hold_clear(sph_hold *hold);

/* A finish hook (user: the sph_hold). Entries whose field is not asked for do nothing. An index
 * beyond the real particles, or a mask beyond the field's components, is SPH_ERR_ARG. Serial,
 * O(held values). Since 0.1. */
SPH_API int32_t sph_hold_finish(void *hold, double t, sph_particles *set, const sph_rate *rates,
                                int32_t count);

#ifdef __cplusplus
}
#endif
#endif
