/* One of everything, for the table of every function (everywhere.h). */
#ifndef SPH_TESTS_EVERYWHERE_WORLD_H
#define SPH_TESTS_EVERYWHERE_WORLD_H

#include "rhs_help.h"

#include <ctype.h>

enum { EW_OUT = 1 << 15, EW_FIELDS = 12 };

typedef struct everywhere {
  sph_context *ctx; /* the caller's */
  int32_t dim;
  int64_t n, rows;
  sph_particles *set;
  sph_kernel *kernel;
  sph_neighbors *list;
  sph_material *hooke;
  sph_rhs *rhs;
  sph_integrator *it, *saved;
  sph_operands a;
  sph_ghosts *ghosts; /* one wall, far away */
  double *points;     /* n * dim positions near the particles */
  double *ones;       /* n * dim * dim identities */
  double out[EW_OUT], more[EW_OUT];
  int64_t number; /* integer results */
  int made;       /* whether a create function made something */
} everywhere;

static CHECK_UNUSED int32_t ew_law(void *user, const sph_material_block *b, double *p) {
  (void)user;
  for (int64_t i = 0; i < b->n; i++) p[i] = 2.0 * (b->rho[i] - 1.0);
  return 0;
}
static CHECK_UNUSED void ew_profile(void *user, double q, double *w, double *dw) {
  (void)user; /* (3/4) (1 - q^2) in 1-D */
  *w = 0.75 * (1.0 - q * q);
  *dw = -1.5 * q;
}
static CHECK_UNUSED void ew_pair(void *user, const sph_pair_block *b, double *out) {
  (void)user;
  for (int32_t k = 0; k < b->count; k++) out[0] += b->w[k] * b->dx[k * b->dim];
}
static CHECK_UNUSED int32_t ew_hook(void *user, double t, sph_particles *set,
                                    const struct sph_rate *rates, int32_t count) {
  (void)user, (void)t, (void)set, (void)rates, (void)count;
  return 0;
}
static CHECK_UNUSED int32_t ew_decay(void *user, double t, sph_particles *set,
                                     const sph_rate *rates, int32_t count) {
  (void)user, (void)t, (void)count;
  int64_t n = sph_particles_real_count(set) * sph_particles_dim(set);
  const double *v = sph_particles_field_const(set, SPH_FIELD_V);
  for (int64_t i = 0; i < n; i++) rates[0].values[i] = -v[i];
  return 0;
}
static CHECK_UNUSED void ew_ones(void *job, int64_t begin, int64_t end, int32_t worker) {
  everywhere *w = (everywhere *)job;
  (void)worker;
  for (int64_t i = begin; i < end; i++) w->out[i] = 1.0;
}

/* --- the world --------------------------------------------------------------------------- */

static CHECK_UNUSED void ew_add_terms(everywhere *w) {
  for (int32_t kind = 1; kind <= SPH_TERM_ARTIFICIAL_STRESS; kind++) {
    int plain = kind == SPH_TERM_XSPH || kind == SPH_TERM_BODY_FORCE || kind == SPH_TERM_MOTION;
    sph_term t = rh_term(kind, 0, !plain);
    check_ok(sph_rhs_add(w->rhs, &t));
  }
  check_ok(sph_rhs_add_host(w->rhs, SPH_FIELD_V, ew_pair, NULL));
  check_ok(sph_rhs_set_material(w->rhs, 0, w->hooke));
}

static CHECK_UNUSED void ew_make_laws(everywhere *w) {
  sph_hooke_options h;
  sph_hooke_options_init(&h);
  h.young = 3.0;
  h.poisson = 0.25;
  h.density = 1.0;
  h.reduction = w->dim == 1 ? SPH_UNIAXIAL_STRESS : w->dim == 2 ? SPH_PLANE_STRAIN : SPH_SOLID;
  check_ok(sph_material_create_hooke(w->ctx, &h, &w->hooke));
  check_ok(sph_rhs_create(w->ctx, w->kernel, NULL, &w->rhs));
  ew_add_terms(w);
}

static CHECK_UNUSED sph_integrator *ew_integrator(everywhere *w) {
  sph_integrator_options o;
  sph_integrator *it = NULL;
  sph_integrator_options_init(&o);
  o.method = SPH_INTEGRATOR_RKC;
  check_ok(sph_integrator_create(w->ctx, &o, &it));
  check_ok(sph_integrator_bind_field(it, SPH_FIELD_V));
  check_ok(sph_integrator_set_function(it, ew_decay, NULL));
  return it;
}

static CHECK_UNUSED void ew_fill(everywhere *w) {
  rh_system s = {.ctx = w->ctx, .set = w->set, .dim = w->dim, .n = w->n, .rows = w->rows};
  int64_t side = 1;
  while ((w->dim == 1 ? side : w->dim == 2 ? side * side : side * side * side) < w->n) side++;
  rh_place(&s, side);
  rh_fill(&s, SPH_FIELD_V, -1.0, 1.0, 1);
  rh_fill(&s, SPH_FIELD_M, 0.8, 1.6, 1);
  rh_fill(&s, SPH_FIELD_RHO, 0.7, 1.9, 1);
  rh_fill(&s, SPH_FIELD_H, 1.1, 1.5, 1);
  rh_fill(&s, SPH_FIELD_P, -1.0, 2.0, 1);
  rh_fill(&s, SPH_FIELD_C, 1.0, 2.0, 1);
  rh_fill(&s, SPH_FIELD_SIGMA, -1.0, 1.0, 1);
}

static CHECK_UNUSED void ew_make_wall(everywhere *w) {
  sph_wall wall;
  sph_ghosts_options o;
  sph_wall_init(&wall);
  sph_ghosts_options_init(&o);
  o.dim = w->dim;
  wall.kind = SPH_WALL_SLIP;
  wall.point[0] = -1000.0;
  wall.normal[0] = 1.0;
  check_ok(sph_ghosts_create(w->ctx, &o, &w->ghosts));
  check_ok(sph_ghosts_add_wall(w->ghosts, &wall, NULL));
}

/* n particles, of which the last n - rows are ghosts, on a context of the caller's. Everything is
 * built, but nothing was evaluated or stepped yet: buffers are still to be allocated. */
static CHECK_UNUSED everywhere *ew_open(sph_context *ctx, int32_t dim, int64_t n, int64_t rows) {
  everywhere *w = (everywhere *)calloc(1, sizeof *w);
  sph_particles_options o;
  assert_non_null(w);
  w->ctx = ctx;
  w->dim = dim;
  w->n = n;
  w->rows = rows;
  rh_seed = 77;
  sph_particles_options_init(&o);
  o.dim = dim;
  check_ok(sph_particles_create(ctx, &o, &w->set));
  check_ok(sph_particles_add(w->set, rows, NULL));
  check_ok(sph_particles_add_ghosts(w->set, n - rows, NULL));
  ew_fill(w);
  check_ok(sph_kernel_create(ctx, SPH_KERNEL_CUBIC_SPLINE, dim, &w->kernel));
  check_ok(sph_neighbors_create(ctx, NULL, &w->list));
  check_ok(sph_neighbors_build(w->list, w->set));
  ew_make_laws(w);
  w->it = ew_integrator(w);
  w->saved = ew_integrator(w);
  check_ok(sph_integrator_save(w->saved, w->set));
  check_ok(sph_operands_from_set(w->set, &w->a));
  w->points = (double *)calloc((size_t)(n * dim) + 1, sizeof(double));
  assert_non_null(w->points);
  for (int64_t k = 0; k < n * dim; k++) w->points[k] = w->a.x[k] + 0.125;
  w->ones = (double *)calloc((size_t)(n * dim * dim) + 1, sizeof(double));
  assert_non_null(w->ones);
  for (int64_t k = 0; k < n * dim; k++) w->ones[k * dim + k % dim] = 1.0;
  ew_make_wall(w);
  for (int k = 0; k < EW_OUT; k++) w->out[k] = w->more[k] = -7.0;
  return w;
}

static CHECK_UNUSED void ew_close(everywhere *w) {
  sph_integrator_destroy(w->it);
  sph_integrator_destroy(w->saved);
  sph_rhs_destroy(w->rhs);
  sph_material_destroy(w->hooke);
  sph_neighbors_destroy(w->list);
  sph_kernel_destroy(w->kernel);
  sph_particles_destroy(w->set);
  sph_ghosts_destroy(w->ghosts);
  free(w->points);
  free(w->ones);
  free(w);
}

#endif
