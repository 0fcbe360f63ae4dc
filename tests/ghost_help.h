/* What the tests of ghost particles share: a jittered lattice in a box with walls on its faces. */
#ifndef SPH_TESTS_GHOST_HELP_H
#define SPH_TESTS_GHOST_HELP_H

#include "rhs_help.h"

/* A rotation of space, or the identity in 1-D: rows are the axes of the box. */
typedef struct gh_frame {
  double e[3][3], origin[3];
} gh_frame;

static CHECK_UNUSED gh_frame gh_identity(void) {
  const gh_frame f = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}, {0.0, 0.0, 0.0}};
  return f;
}

/* A random direction by rejection, then Gram-Schmidt. */
static CHECK_UNUSED gh_frame gh_random_frame(int32_t dim) {
  gh_frame f = gh_identity();
  for (int a = 0; a < dim; a++) f.origin[a] = rh_random(-2.0, 2.0);
  for (int k = 0; dim > 1 && k < dim;) {
    double length = 0.0;
    for (int a = 0; a < dim; a++) f.e[k][a] = rh_random(-1.0, 1.0);
    for (int l = 0; l < k; l++) {
      double dot = 0.0;
      for (int a = 0; a < dim; a++) dot += f.e[k][a] * f.e[l][a];
      for (int a = 0; a < dim; a++) f.e[k][a] -= dot * f.e[l][a];
    }
    for (int a = 0; a < dim; a++) length += f.e[k][a] * f.e[k][a];
    if (length < 0.1) continue;
    for (int a = 0; a < dim; a++) f.e[k][a] /= sqrt(length);
    k++;
  }
  return f;
}

/* Box coordinates to space, and a symmetric packed tensor likewise. */
static CHECK_UNUSED void gh_vector(const gh_frame *f, int32_t dim, const double *u, double *out) {
  for (int a = 0; a < dim; a++) {
    out[a] = 0.0;
    for (int k = 0; k < dim; k++) out[a] += u[k] * f->e[k][a];
  }
}

static CHECK_UNUSED void gh_point(const gh_frame *f, int32_t dim, const double *u, double *out) {
  gh_vector(f, dim, u, out);
  for (int a = 0; a < dim; a++) out[a] += f->origin[a];
}

static CHECK_UNUSED void gh_tensor(const gh_frame *f, int32_t dim, const double *s, double *out) {
  for (int a = 0; a < dim; a++)
    for (int b = a; b < dim; b++) {
      double sum = 0.0;
      for (int k = 0; k < dim; k++)
        for (int l = 0; l < dim; l++) sum += s[rh_sym(dim, k, l)] * f->e[k][a] * f->e[l][b];
      out[rh_sym(dim, a, b)] = sum;
    }
}

/* Turn every position, velocity and stress of the set. */
static CHECK_UNUSED void gh_turn(const rh_system *s, const gh_frame *f) {
  double *x = rh_field(s, SPH_FIELD_X), *v = rh_field(s, SPH_FIELD_V);
  double *sigma = rh_field(s, SPH_FIELD_SIGMA), old[6];
  const int32_t d = s->dim, c = d * (d + 1) / 2;
  for (int64_t i = 0; i < s->rows; i++) {
    memcpy(old, x + i * d, (size_t)d * sizeof *old);
    gh_point(f, d, old, x + i * d);
    memcpy(old, v + i * d, (size_t)d * sizeof *old);
    gh_vector(f, d, old, v + i * d);
    memcpy(old, sigma + i * c, (size_t)c * sizeof *old);
    gh_tensor(f, d, old, sigma + i * c);
  }
  check_ok(sph_particles_touch(s->set, SPH_FIELD_X));
}

static CHECK_UNUSED sph_ghosts *gh_ghosts(const rh_system *s, double skin) {
  sph_ghosts *g = NULL;
  sph_ghosts_options o;
  sph_ghosts_options_init(&o);
  o.dim = s->dim;
  o.skin = skin;
  check_ok(sph_ghosts_create(s->ctx, &o, &g));
  return g;
}

/* The wall on one face of the box [0, edge)^dim: faces 0, 1 at the two ends of axis 0, and so on.
 * Its vectors are given in the box's frame. */
static CHECK_UNUSED sph_wall gh_wall(const gh_frame *f, int32_t dim, double edge, int face,
                                     int32_t kind) {
  sph_wall w;
  double point[3] = {0.0, 0.0, 0.0}, normal[3] = {0.0, 0.0, 0.0};
  sph_wall_init(&w);
  w.kind = kind;
  point[face / 2] = face % 2 ? edge : 0.0;
  normal[face / 2] = face % 2 ? -1.0 : 1.0;
  gh_point(f, dim, point, w.point);
  gh_vector(f, dim, normal, w.normal);
  return w;
}

static CHECK_UNUSED void gh_add(sph_ghosts *g, const sph_wall *w) {
  check_ok(sph_ghosts_add_wall(g, w, NULL));
}

/* Walls of one kind all around. */
static CHECK_UNUSED void gh_box(sph_ghosts *g, const gh_frame *f, int32_t dim, double edge,
                                int32_t kind) {
  for (int face = 0; face < 2 * dim; face++) {
    const sph_wall w = gh_wall(f, dim, edge, face, kind);
    gh_add(g, &w);
  }
}

static CHECK_UNUSED const double *gh_const(const rh_system *s, int32_t field) {
  const double *a = sph_particles_field_const(s->set, field);
  assert_non_null(a);
  return a;
}

#endif
