/* Host pair terms: continuity and pressure reproduced by callbacks, what the blocks hold, and that
 * neither depends on threads. */
#include "../rhs_help.h"

/* What a host's callback reads. */
typedef struct host_model {
  int32_t dim, h_rule;
  const double *x, *v, *m, *rho, *p, *h;
  const sph_kernel *kernel;
  double period;
  int64_t n;
  int64_t pairs[4096];  /* by i */
  int64_t blocks[4096]; /* by i */
  int32_t wrong;
} host_model;

static void continuity_pairs(void *user, const sph_pair_block *b, double *out) {
  const host_model *h = (const host_model *)user;
  for (int32_t k = 0; k < b->count; k++) {
    double sum = 0.0;
    for (int a = 0; a < b->dim; a++)
      sum += (h->v[b->i * b->dim + a] - h->v[(int64_t)b->j[k] * b->dim + a]) * b->f[k] *
             b->dx[k * b->dim + a];
    out[0] += h->m[b->j[k]] * sum;
  }
}

static void pressure_pairs(void *user, const sph_pair_block *b, double *out) {
  const host_model *h = (const host_model *)user;
  double mine = h->p[b->i] / (h->rho[b->i] * h->rho[b->i]);
  for (int32_t k = 0; k < b->count; k++) {
    int64_t j = b->j[k];
    double q = h->m[j] * (mine + h->p[j] / (h->rho[j] * h->rho[j]));
    for (int a = 0; a < b->dim; a++) out[a] -= q * b->f[k] * b->dx[k * b->dim + a];
  }
}

static host_model model_of(const rh_system *s) {
  host_model h = {.dim = s->dim, .n = s->n, .h_rule = SPH_H_ARITHMETIC, .kernel = s->kernel};
  h.x = rh_field(s, SPH_FIELD_X);
  h.v = rh_field(s, SPH_FIELD_V);
  h.m = rh_field(s, SPH_FIELD_M);
  h.rho = rh_field(s, SPH_FIELD_RHO);
  h.p = rh_field(s, SPH_FIELD_P);
  h.h = rh_field(s, SPH_FIELD_H);
  return h;
}

static void check_against(const rh_system *s, int32_t field, sph_pair_fn fn, const sph_term *t) {
  static host_model h;
  h = model_of(s);
  sph_rhs *rhs = rh_rhs(s);
  check_ok(sph_rhs_add_host(rhs, field, fn, &h));
  int64_t n = s->rows * sph_particles_components(s->set, field);
  double *want = rh_array(n), *got = rh_rates(s, rhs, field);
  rh_operator(s, t, want);
  double size = rh_largest(want, n);
  assert_true(size > 0.01);
  for (int64_t k = 0; k < n; k++) check_close(got[k], want[k], 1e-13 * size);
  free(want);
  free(got);
  sph_rhs_destroy(rhs);
}

static void test_reproduces_operators(void **state) {
  (void)state;
  static const uint32_t flavours[] = {0, RH_VARY_ALL, RH_VARY_ALL | RH_GHOSTS, RH_WRAP};
  sph_context *ctx = rh_context(1);
  sph_term c = rh_term(SPH_TERM_CONTINUITY, 0, 0), p = rh_term(SPH_TERM_PRESSURE, 0, 0);
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int f = 0; f < 4; f++) {
      rh_system s = rh_make(ctx, dim, rh_side(dim), flavours[f], 15);
      check_against(&s, SPH_FIELD_RHO, continuity_pairs, &c);
      check_against(&s, SPH_FIELD_V, pressure_pairs, &p);
      rh_free(&s);
    }
  sph_context_destroy(ctx);
}

/* Beside the library's own term the host's adds: twice the rate. */
static void test_adds_to_terms(void **state) {
  (void)state;
  static host_model h;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 2, 12, RH_VARY_M, 16);
  sph_term t = rh_term(SPH_TERM_CONTINUITY, 0, 0);
  sph_rhs *rhs = rh_rhs(&s);
  h = model_of(&s);
  check_ok(sph_rhs_add(rhs, &t));
  check_ok(sph_rhs_add_host(rhs, SPH_FIELD_RHO, continuity_pairs, &h));
  check_ok(sph_rhs_add_host(rhs, SPH_FIELD_RHO, continuity_pairs, &h)); /* may come twice */
  double *want = rh_array(s.rows), *got = rh_rates(&s, rhs, SPH_FIELD_RHO);
  rh_operator(&s, &t, want);
  double size = rh_largest(want, s.rows);
  for (int64_t i = 0; i < s.rows; i++) check_close(got[i], 3.0 * want[i], 3e-13 * size);
  free(want);
  free(got);
  sph_rhs_destroy(rhs);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* --- what a block says ------------------------------------------------------------------- */

static double pair_h(int32_t rule, double a, double b) {
  if (rule == SPH_H_HARMONIC) return 2.0 / (1.0 / a + 1.0 / b);
  if (rule == SPH_H_MAX) return fmax(a, b);
  if (rule == SPH_H_MIN) return fmin(a, b);
  return 0.5 * (a + b);
}

static int same(double a, double b) { return fabs(a - b) <= 1e-13 * (fabs(a) + fabs(b) + 1e-3); }

static void look_at_pair(host_model *h, const sph_pair_block *b, int32_t k) {
  int64_t i = b->i, j = b->j[k];
  double r = 0.0, w, slope;
  if (j < 0 || j >= h->n || j == i) {
    h->wrong |= 1;
    return;
  }
  for (int a = 0; a < b->dim; a++) {
    double dx = h->x[i * b->dim + a] - h->x[j * b->dim + a];
    if (h->period > 0.0) dx -= h->period * round(dx / h->period);
    if (!same(dx, b->dx[k * b->dim + a])) h->wrong |= 2;
    r += dx * dx;
  }
  r = sqrt(r);
  if (!same(r, b->r[k])) h->wrong |= 4;
  w = sph_kernel_w(h->kernel, r, pair_h(h->h_rule, h->h[i], h->h[j]));
  slope = sph_kernel_dwdr(h->kernel, r, pair_h(h->h_rule, h->h[i], h->h[j]));
  if (h->h_rule == SPH_H_AVERAGE) {
    w = 0.5 * (sph_kernel_w(h->kernel, r, h->h[i]) + sph_kernel_w(h->kernel, r, h->h[j]));
    slope = 0.5 * (sph_kernel_dwdr(h->kernel, r, h->h[i]) + sph_kernel_dwdr(h->kernel, r, h->h[j]));
  }
  if (!same(w, b->w[k])) h->wrong |= 8;
  if (!same(slope, b->f[k] * r)) h->wrong |= 16;
}

static void look(void *user, const sph_pair_block *b, double *out) {
  host_model *h = (host_model *)user;
  (void)out;
  if (b->size != sizeof *b || b->dim != h->dim || b->count < 1 || b->i < 0 || b->i >= h->n)
    h->wrong |= 32;
  else {
    for (int32_t k = 0; k < b->count; k++) look_at_pair(h, b, k);
    h->pairs[b->i] += b->count;
    h->blocks[b->i] += 1;
  }
}

/* Every pair of the list is handed over once, with its geometry and its kernel. */
static void check_blocks(sph_context *ctx, int32_t dim, int32_t rule, uint32_t flavour) {
  static host_model h;
  rh_system s = rh_make(ctx, dim, rh_side(dim), flavour, 17);
  sph_neighbors_options o;
  sph_neighbors_options_init(&o);
  o.h_rule = rule;
  for (int a = 0; a < dim; a++) {
    o.periodic[a] = (flavour & RH_WRAP) != 0;
    o.box_hi[a] = (double)rh_side(dim);
  }
  sph_neighbors_destroy(s.list);
  s.list = NULL;
  check_ok(sph_neighbors_create(ctx, &o, &s.list));
  h = model_of(&s);
  h.h_rule = rule;
  h.period = flavour & RH_WRAP ? (double)rh_side(dim) : 0.0;
  sph_rhs *rhs = rh_rhs(&s);
  check_ok(sph_rhs_add_host(rhs, SPH_FIELD_E, look, &h));
  free(rh_rates(&s, rhs, SPH_FIELD_E));
  assert_int_equal(h.wrong, 0);
  const int64_t *offsets;
  const int32_t *indices;
  check_ok(sph_neighbors_rows(s.list, &offsets, &indices));
  for (int64_t i = 0; i < s.n; i++)
    assert_int_equal(h.pairs[i], i < s.rows ? offsets[i + 1] - offsets[i] : 0);
  sph_rhs_destroy(rhs);
  rh_free(&s);
}

static void test_blocks(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  for (int32_t rule = SPH_H_ARITHMETIC; rule <= SPH_H_AVERAGE; rule++)
    for (int32_t dim = 1; dim <= 3; dim++) {
      check_blocks(ctx, dim, rule, RH_VARY_H);
      check_blocks(ctx, dim, rule, RH_VARY_H | RH_WRAP);
      check_blocks(ctx, dim, rule, RH_GHOSTS);
    }
  sph_context_destroy(ctx);
}

/* More neighbours than one block holds: all arrive. Coincident particles: f = 0, W = W(0). */
static void test_crowd(void **state) {
  (void)state;
  static host_model h;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 3, 6, 0, 18);
  double *x = rh_field(&s, SPH_FIELD_X);
  for (int64_t k = 0; k < s.n * 3; k++) x[k] *= 0.05;
  for (int k = 0; k < 3; k++) x[3 + k] = x[k];
  check_ok(sph_particles_touch(s.set, SPH_FIELD_X));
  h = model_of(&s);
  sph_rhs *rhs = rh_rhs(&s);
  check_ok(sph_rhs_add_host(rhs, SPH_FIELD_E, look, &h));
  free(rh_rates(&s, rhs, SPH_FIELD_E));
  assert_int_equal(h.wrong, 0);
  for (int64_t i = 0; i < s.n; i++) {
    assert_int_equal(h.pairs[i], s.n - 1);
    assert_true(h.blocks[i] > 1);
  }
  sph_rhs_destroy(rhs);
  rh_free(&s);
  sph_context_destroy(ctx);
}

/* --- threads ----------------------------------------------------------------------------- */

/* A number that depends on the order and the cut of the blocks. */
static void order_dependent(void *user, const sph_pair_block *b, double *out) {
  (void)user;
  for (int32_t k = 0; k < b->count; k++)
    out[0] = 0.37 * out[0] + (double)(b->j[k] + 1) * b->w[k] + 1e-3 * (double)k;
  out[0] += 1e-2 * (double)b->count;
}

static double *order_with(int32_t threads, int64_t *n) {
  sph_context *ctx = rh_context(threads);
  rh_system s = rh_make(ctx, 2, 60, RH_VARY_H, 19);
  int32_t field;
  check_ok(sph_particles_add_field(s.set, "order", 1, &field));
  sph_rhs *rhs = rh_rhs(&s);
  check_ok(sph_rhs_add_host(rhs, field, order_dependent, NULL));
  double *a = rh_rates(&s, rhs, field);
  *n = s.rows;
  sph_rhs_destroy(rhs);
  rh_free(&s);
  sph_context_destroy(ctx);
  return a;
}

static void test_fixed_order(void **state) {
  (void)state;
  static const int32_t threads[] = {2, 3, 8};
  int64_t n;
  double *one = order_with(1, &n);
  for (int k = 0; k < 3; k++) {
    double *many = order_with(threads[k], &n);
    assert_memory_equal(many, one, (size_t)n * sizeof *one);
    free(many);
  }
  free(one);
}

/* --- refusals ---------------------------------------------------------------------------- */

static void nothing(void *user, const sph_pair_block *b, double *out) {
  (void)b;
  (void)out;
  ++*(int64_t *)user;
}

static void test_refusals(void **state) {
  (void)state;
  int64_t calls = 0;
  sph_context *ctx = rh_context(1);
  rh_system s = rh_make(ctx, 1, 30, 0, 20);
  sph_rhs *rhs = rh_rhs(&s);
  check_status(sph_rhs_add_host(NULL, SPH_FIELD_V, nothing, &calls), SPH_ERR_ARG);
  check_status(sph_rhs_add_host((sph_rhs *)s.set, SPH_FIELD_V, nothing, &calls), SPH_ERR_HANDLE);
  check_status(sph_rhs_add_host(rhs, SPH_FIELD_V, NULL, &calls), SPH_ERR_ARG);
  check_status(sph_rhs_add_host(rhs, -1, nothing, &calls), SPH_ERR_ARG);
  /* a field that the set does not have, and one that is not asked for: never called */
  check_ok(sph_rhs_add_host(rhs, 100, nothing, &calls));
  check_ok(sph_rhs_add_host(rhs, SPH_FIELD_V, nothing, &calls));
  free(rh_rates(&s, rhs, SPH_FIELD_RHO));
  assert_int_equal(calls, 0);
  free(rh_rates(&s, rhs, SPH_FIELD_V));
  assert_int_equal(calls, 30);
  sph_status status = SPH_OK;
  int added = 2;
  for (; status == SPH_OK && added < 1000; added++)
    status = sph_rhs_add_host(rhs, SPH_FIELD_V, nothing, &calls);
  check_status(status, SPH_ERR_LIMIT);
  assert_true(added > 8);
  free(rh_rates(&s, rhs, SPH_FIELD_V)); /* still fine */
  sph_rhs_destroy(rhs);
  rh_free(&s);
  sph_context_destroy(ctx);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_reproduces_operators),
    cmocka_unit_test(test_adds_to_terms),
    cmocka_unit_test(test_blocks),
    cmocka_unit_test(test_crowd),
    cmocka_unit_test(test_fixed_order),
    cmocka_unit_test(test_refusals),
};
SPH_TEST_MAIN(tests)
