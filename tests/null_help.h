/* Every function with a handle that is NULL or of another kind, and with each required pointer
 * NULL: what the tests of this kind share. One valid object of each kind, and a check that goes
 * through a table of calls with all the others in place of the right one. */
#ifndef NULL_HELP_H
#define NULL_HELP_H

#include "rhs_help.h"

typedef enum kind {
  CONTEXT,
  PARTICLES,
  KERNEL,
  NEIGHBORS,
  MATERIAL,
  RHS,
  INTEGRATOR,
  GHOSTS,
  HOLD,
  POINTS,
  TOTAL_LAGRANGIAN,
  KINDS
} kind;

/* One valid object of each kind, and arrays that are large enough for every call. */
static struct {
  void *handle[KINDS];
  rh_system s;
  sph_material *material;
  sph_rhs *rhs;
  sph_integrator *it;
  sph_ghosts *ghosts;
  sph_hold *hold;
  sph_stress_points *points;
  sph_total_lagrangian *tl;
  sph_material *rubber;
  sph_total_lagrangian_options tl_options;
  sph_total_lagrangian_energies energies;
  sph_total_lagrangian_ledger ledger;
  sph_hyperelastic_options hyper;
  sph_wall wall;
  sph_operands a, frozen; /* the second one with a gradient matrix */
  sph_material_block block;
  sph_material_functions law;
  sph_hooke_options hooke;
  sph_bulk_viscosity bulk;
  sph_lattice_options lattice;
  sph_hole_layout_options holes;
  sph_region_options region;
  sph_term term;
  sph_rate rate;
  const int64_t *offsets;
  const int32_t *indices;
  double in[4096], out[4096];
  int32_t field, near[64];
  int64_t found;
  void *made;
} g;

static inline void kernel_fn(void *user, double q, double *w, double *dw) {
  (void)user;
  *w = 1.0 - q;
  *dw = -1.0;
}
static inline void loop_fn(void *job, int64_t begin, int64_t end, int32_t worker) {
  (void)job;
  (void)begin;
  (void)end;
  (void)worker;
}
static inline void pair_fn(void *user, const sph_pair_block *b, double *out) {
  (void)user;
  (void)b;
  (void)out;
}
static inline int32_t rhs_fn(void *user, double t, sph_particles *set, const sph_rate *rates,
                             int32_t count) {
  (void)user;
  (void)t;
  for (int32_t k = 0; k < count; k++) /* scalars and vectors of one dimension */
    for (int64_t i = 0; i < sph_particles_real_count(set); i++) rates[k].values[i] = 0.0;
  return 0;
}
static inline int32_t law_fn(void *user, const sph_material_block *b, double *out) {
  (void)user;
  for (int64_t i = 0; i < b->n; i++) out[i] = 0.0;
  return 0;
}

static inline sph_ghosts *make_ghosts(sph_context *ctx) {
  sph_ghosts *ghosts = NULL;
  sph_ghosts_options o;
  sph_ghosts_options_init(&o);
  o.dim = 1;
  check_ok(sph_ghosts_create(ctx, &o, &ghosts));
  sph_wall_init(&g.wall);
  g.wall.kind = SPH_WALL_SLIP;
  g.wall.normal[0] = 1.0;
  g.wall.point[0] = -100.0; /* far from all particles */
  check_ok(sph_ghosts_add_wall(ghosts, &g.wall, NULL));
  check_ok(sph_ghosts_update(ghosts, g.s.set, 0.0));
  return ghosts;
}

static inline void open_all(void) {
  memset(&g, 0, sizeof g);
  sph_context *ctx = rh_context(1);
  g.s = rh_make(ctx, 1, 32, 0, 1);
  for (int k = 0; k < 4096; k++) g.in[k] = 1.0;
  sph_material_functions_init(&g.law);
  g.law.stress_rate = g.law.pressure = g.law.sound_speed = law_fn;
  check_ok(sph_material_create(ctx, &g.law, NULL, &g.material));
  sph_hooke_options_init(&g.hooke);
  g.hooke.young = g.hooke.density = 1.0;
  g.rhs = rh_rhs(&g.s);
  check_ok(sph_integrator_create(ctx, NULL, &g.it));
  check_ok(sph_integrator_bind_field(g.it, SPH_FIELD_V));
  check_ok(sph_integrator_set_function(g.it, rhs_fn, NULL));
  check_ok(sph_operands_from_set(g.s.set, &g.a));
  sph_material_block_init(&g.block);
  g.block.dim = 1;
  g.block.n = 4;
  sph_bulk_viscosity_init(&g.bulk);
  sph_lattice_options_init(&g.lattice);
  g.lattice.dim = 1;
  g.lattice.spacing = 0.5;
  sph_hole_layout_options_init(&g.holes);
  g.holes.holes = 1;
  g.holes.hole = g.in; /* the centre (1, 1), the corner of the unit square, and the radius 1 */
  g.holes.spacing = 0.5;
  sph_region_options_init(&g.region);
  g.region.dim = 1;
  g.term = rh_term(SPH_TERM_STRESS, 0, 0);
  g.rate = (sph_rate){SPH_FIELD_V, g.out};
  g.ghosts = make_ghosts(ctx);
  check_ok(sph_hold_create(ctx, &g.hold));
  check_ok(sph_stress_points_create(ctx, g.s.kernel, g.s.list, NULL, &g.points));
  g.frozen = g.a;
  g.frozen.gradient_matrix = g.in;
  sph_hyperelastic_options_init(&g.hyper);
  g.hyper.young = g.hyper.density = 1.0;
  g.hyper.reduction = SPH_UNIAXIAL_STRESS;
  check_ok(sph_material_create_hyperelastic(ctx, &g.hyper, &g.rubber));
  sph_total_lagrangian_options_init(&g.tl_options);
  g.tl_options.dim = 1;
  check_ok(sph_total_lagrangian_create(ctx, &g.tl_options, g.rubber, &g.tl));
  g.energies.size = sizeof g.energies;
  sph_total_lagrangian_ledger_init(&g.ledger);
  void *all[KINDS] = {ctx,  g.s.set,  g.s.kernel, g.s.list, g.material, g.rhs,
                      g.it, g.ghosts, g.hold,     g.points, g.tl};
  memcpy(g.handle, all, sizeof all);
}

static inline void close_all(void) {
  sph_context *ctx = g.s.ctx;
  sph_total_lagrangian_destroy(g.tl);
  sph_material_destroy(g.rubber);
  sph_stress_points_destroy(g.points);
  sph_hold_destroy(g.hold);
  sph_ghosts_destroy(g.ghosts);
  sph_integrator_destroy(g.it);
  sph_rhs_destroy(g.rhs);
  sph_material_destroy(g.material);
  rh_free(&g.s);
  sph_context_destroy(ctx);
}

#define SET g.s.set
#define LIST g.s.list
#define W g.s.kernel
#define CTX g.s.ctx
#define MADE (void *)&g.made

/* ---- tables of calls --------------------------------------------------------------------- */

/* HANDLE_CALLS(X): name, kind of the handle h, call. Each call is SPH_ERR_ARG for NULL,
 * SPH_ERR_HANDLE for the other kinds. POINTER_CALLS(X): calls that are SPH_ERR_ARG. */
typedef struct handle_call {
  const char *text;
  kind k;
  sph_status (*call)(void *h);
} handle_call;

#define DEFINE_CALL(name, k, call) \
  static sph_status call_##name(void *h) { return call; }
#define LIST_CALL(name, k, call) {#call, k, call_##name},
#define REFUSED(call) expect(call, SPH_ERR_ARG, #call, -1);

static inline void expect(sph_status got, sph_status want, const char *text, int other) {
  if (got != want)
    fail_msg("%s with handle %d: %s, not %s", text, other, sph_status_name(got),
             sph_status_name(want));
}

static inline void check_handle_calls(const handle_call *calls, size_t count) {
  open_all();
  for (size_t c = 0; c < count; c++) {
    const handle_call *x = &calls[c];
    for (int other = 0; other < KINDS; other++) {
      if (other == (int)x->k) continue;
      g.made = NULL;
      expect(x->call(g.handle[other]), SPH_ERR_HANDLE, x->text, other);
      assert_null(g.made);
    }
    expect(x->call(NULL), SPH_ERR_ARG, x->text, -1);
    assert_null(g.made);
  }
  assert_int_equal(sph_particles_count(SET), 32); /* nothing of all that was done */
  close_all();
}

#endif
