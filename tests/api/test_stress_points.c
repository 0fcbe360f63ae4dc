/* Stress points: exact for linear fields also at boundaries, equal to plain formulas written out
 * for a bar, the collocated scheme at r_s = 0, waves, stability under tension, bad input. */
#include "../ghost_help.h"
#include "../oom.h"

typedef struct points_case {
  rh_system s;
  sph_stress_points *p;
  sph_material *law;
} points_case;

/* The stress rate shows the symmetric part of the velocity gradient. */
static int32_t show_strain(void *user, const sph_material_block *b, double *out) {
  const int d = b->dim, c = d * (d + 1) / 2;
  (void)user;
  for (int64_t i = 0; i < b->n; i++)
    for (int a = 0; a < d; a++)
      for (int e = a; e < d; e++)
        out[i * c + rh_sym(d, a, e)] = 0.5 * (b->velocity_gradient[i * d * d + a * d + e] +
                                              b->velocity_gradient[i * d * d + e * d + a]);
  return 0;
}

static sph_material *make_law(sph_context *ctx,
                              int32_t (*fn)(void *, const sph_material_block *, double *)) {
  sph_material *m = NULL;
  sph_material_functions f;
  sph_material_functions_init(&f);
  f.stress_rate = fn;
  check_ok(sph_material_create(ctx, &f, NULL, &m));
  return m;
}

static points_case make_case(sph_context *ctx, int32_t dim, int64_t side, uint32_t flavour,
                             const sph_stress_points_options *o) {
  points_case c = {.s = rh_make(ctx, dim, side, flavour, (uint64_t)(41 + dim))};
  check_ok(sph_stress_points_create(ctx, c.s.kernel, c.s.list, o, &c.p));
  c.law = make_law(ctx, show_strain);
  check_ok(sph_stress_points_set_material(c.p, 0, c.law));
  check_ok(sph_stress_points_place(c.p, c.s.set));
  return c;
}

static void free_case(points_case *c) {
  sph_stress_points_destroy(c->p);
  sph_material_destroy(c->law);
  rh_free(&c->s);
}

typedef struct points_rates {
  double *x, *v, *rho, *offsets, *stresses;
  sph_rate list[5];
} points_rates;

static points_rates make_rates(const points_case *c) {
  const int64_t n = c->s.rows, np = sph_stress_points_count(c->p);
  const int32_t d = c->s.dim;
  points_rates r = {rh_array(n * d),
                    rh_array(n * d),
                    rh_array(n),
                    rh_array(np * d),
                    rh_array(np * d * (d + 1) / 2),
                    {{0, NULL}}};
  const sph_rate list[5] = {{-1, r.offsets},
                            {SPH_FIELD_X, r.x},
                            {-3, r.stresses},
                            {SPH_FIELD_V, r.v},
                            {SPH_FIELD_RHO, r.rho}};
  memcpy(r.list, list, sizeof list);
  return r;
}

static void free_rates(points_rates *r) {
  free(r->x);
  free(r->v);
  free(r->rho);
  free(r->offsets);
  free(r->stresses);
}

/* --- linear fields ------------------------------------------------------------------------ */

/* v = A x and sigma = S0 + S1.x on a jittered lattice with free edges, unequal masses and h. */
static void check_linear(int32_t dim, double offset) {
  sph_context *ctx = rh_context(1);
  sph_stress_points_options o;
  sph_stress_points_options_init(&o);
  o.offset = offset;
  points_case c = make_case(ctx, dim, dim == 1 ? 40 : dim == 2 ? 9 : 5, RH_VARY_H | RH_VARY_M, &o);
  points_rates r = make_rates(&c);
  const int32_t comps = dim * (dim + 1) / 2, fan = 1 << dim;
  double A[9], S0[6], S1[18], trace = 0.0;
  for (int k = 0; k < 9; k++) A[k] = rh_random(-1.0, 1.0);
  for (int k = 0; k < 6; k++) S0[k] = rh_random(-1.0, 1.0);
  for (int k = 0; k < 18; k++) S1[k] = rh_random(-1.0, 1.0);
  for (int a = 0; a < dim; a++) trace += A[a * dim + a];
  const double *x = gh_const(&c.s, SPH_FIELD_X), *rho = gh_const(&c.s, SPH_FIELD_RHO);
  double *v = rh_field(&c.s, SPH_FIELD_V), *d = sph_stress_points_offsets(c.p);
  double *sigma = sph_stress_points_stresses(c.p);
  for (int64_t i = 0; i < c.s.rows; i++)
    for (int a = 0; a < dim; a++) {
      v[i * dim + a] = 0.0;
      for (int b = 0; b < dim; b++) v[i * dim + a] += A[a * dim + b] * x[i * dim + b];
    }
  for (int64_t q = 0; q < c.s.rows * fan; q++)
    for (int k = 0; k < comps; k++) {
      sigma[q * comps + k] = S0[k];
      for (int b = 0; b < dim; b++)
        sigma[q * comps + k] += S1[k * dim + b] * (x[q / fan * dim + b] + d[q * dim + b]);
    }
  assert_int_equal(sph_stress_points_rates(c.p, 0.0, c.s.set, r.list, 5), 0);
  for (int64_t q = 0; q < c.s.rows * fan; q++)
    for (int a = 0; a < dim; a++) {
      double want = 0.0;
      for (int b = 0; b < dim; b++) want += A[a * dim + b] * d[q * dim + b];
      check_close(r.offsets[q * dim + a], want, 1e-11);
      for (int b = a; b < dim; b++)
        check_close(r.stresses[q * comps + rh_sym(dim, a, b)],
                    0.5 * (A[a * dim + b] + A[b * dim + a]), 1e-11);
    }
  for (int64_t i = 0; i < c.s.rows; i++) {
    for (int a = 0; a < dim; a++) {
      double want = 0.0;
      for (int b = 0; b < dim; b++) want += S1[rh_sym(dim, a, b) * dim + b] / rho[i];
      check_close(r.v[i * dim + a], want, 1e-10);
      assert_true(r.x[i * dim + a] == v[i * dim + a]);
    }
    check_rel(r.rho[i], -rho[i] * trace, 1e-10);
  }
  free_rates(&r);
  free_case(&c);
  sph_context_destroy(ctx);
}

static void test_linear(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) {
    check_linear(dim, 0.5);
    check_linear(dim, 0.21);
  }
}

/* --- the formulas written out --------------------------------------------------------------- */

enum { BAR = 24 };

/* Periodic bar of unit spacing, every formula of the header by brute force, uncorrected. */
static void check_bar(int32_t form, double offset) {
  sph_context *ctx = rh_context(1);
  sph_stress_points_options o;
  sph_stress_points_options_init(&o);
  o.offset = offset;
  o.form = form;
  o.corrected = 0;
  points_case c = make_case(ctx, 1, BAR, RH_WRAP, &o);
  points_rates r = make_rates(&c);
  double *sigma = sph_stress_points_stresses(c.p), *d = sph_stress_points_offsets(c.p);
  const double *x = gh_const(&c.s, SPH_FIELD_X), *v = gh_const(&c.s, SPH_FIELD_V);
  const double *m = gh_const(&c.s, SPH_FIELD_M), *rho = gh_const(&c.s, SPH_FIELD_RHO);
  const double h = gh_const(&c.s, SPH_FIELD_H)[0];
  double L[BAR];
  for (int k = 0; k < 2 * BAR; k++) {
    sigma[k] = rh_random(-1.0, 1.0);
    check_close(fabs(d[k]), offset * m[k / 2] / rho[k / 2], 1e-15);
  }
  assert_int_equal(sph_stress_points_rates(c.p, 0.0, c.s.set, r.list, 5), 0);
#define GRAD(a, b)                                                                      \
  (sph_kernel_dwdr(c.s.kernel, fabs((a) - (b)-BAR * nearbyint(((a) - (b)) / BAR)), h) * \
   ((a) - (b)-BAR * nearbyint(((a) - (b)) / BAR) > 0.0 ? 1.0 : -1.0))
  for (int i = 0; i < BAR; i++) {
    L[i] = 0.0;
    for (int j = 0; j < BAR; j++)
      if (j != i) L[i] += m[j] / rho[j] * (v[j] - v[i]) * GRAD(x[i], x[j]);
    check_close(r.rho[i], -rho[i] * L[i], 1e-12);
  }
  for (int p = 0; p < 2 * BAR; p++) {
    const double vp = v[p / 2] + L[p / 2] * d[p], xp = x[p / 2] + d[p];
    double Lp = 0.0;
    for (int j = 0; j < BAR; j++)
      if (x[j] != xp) Lp += m[j] / rho[j] * (v[j] - vp) * GRAD(xp, x[j]);
    check_close(r.stresses[p], Lp, 1e-12);
  }
  for (int i = 0; i < BAR; i++) {
    const double own = 0.5 * (sigma[2 * i] + sigma[2 * i + 1]);
    double a = 0.0;
    for (int p = 0; p < 2 * BAR; p++) {
      const double xp = x[p / 2] + d[p], rp = rho[p / 2], mp = 0.5 * m[p / 2];
      const double force = form == SPH_STRESS_SUMMED
                               ? own / (rho[i] * rho[i]) + sigma[p] / (rp * rp)
                               : (sigma[p] - own) / (rho[i] * rp);
      if (xp != x[i]) a += mp * force * GRAD(x[i], xp);
    }
    check_close(r.v[i], a, 1e-12);
  }
#undef GRAD
  free_rates(&r);
  free_case(&c);
  sph_context_destroy(ctx);
}

static void test_bar(void **state) {
  (void)state;
  for (int32_t form = SPH_STRESS_SUMMED; form <= SPH_STRESS_DIFFERENCE; form++)
    for (double offset = 0.0; offset <= 0.5; offset += 0.125) check_bar(form, offset);
}

/* r_s = 0 is the collocated scheme: the same acceleration as the operator's, and each point has the
 * velocity gradient of its particle. */
static void test_collocated(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) {
    sph_context *ctx = rh_context(1);
    sph_stress_points_options o;
    sph_stress_points_options_init(&o);
    o.offset = 0.0;
    points_case c = make_case(ctx, dim, dim == 1 ? 30 : dim == 2 ? 9 : 6, RH_VARY_M, &o);
    points_rates r = make_rates(&c);
    double *matrix = rh_array(9 * c.s.n), *want = rh_array(3 * c.s.n), *L = rh_array(9 * c.s.n);
    assert_int_equal(sph_stress_points_rates(c.p, 0.0, c.s.set, r.list, 5), 0);
    check_ok(sph_neighbors_build(c.s.list, c.s.set));
    const sph_operands a = rh_operands(&c.s, matrix);
    check_ok(sph_stress_divergence(c.s.list, c.s.kernel, &a, SPH_STRESS_DIFFERENCE, want));
    check_ok(sph_velocity_gradient(c.s.list, c.s.kernel, &a, L));
    const int fan = 1 << dim, comps = dim * (dim + 1) / 2;
    for (int64_t k = 0; k < c.s.rows * dim; k++) check_close(r.v[k], want[k], 1e-10);
    for (int64_t q = 0; q < c.s.rows * fan; q++)
      check_close(r.stresses[q * comps], L[q / fan * dim * dim], 1e-11);
    free(L);
    free(want);
    free(matrix);
    free_rates(&r);
    free_case(&c);
    sph_context_destroy(ctx);
  }
}

/* --- in time ---------------------------------------------------------------------------------- */

static int32_t unit_young(void *user, const sph_material_block *b, double *out) {
  (void)user;
  for (int64_t i = 0; i < b->n; i++) out[i] = b->velocity_gradient[i];
  return 0;
}

/* A periodic bar of length 1 and n particles with a sine wave v = a sin(2 pi (x - t)), sigma = -v
 * (E = rho = 1), or with a uniform stress and one particle pushed. */
static points_case make_bar(sph_context *ctx, int n, const sph_stress_points_options *o,
                            double stress) {
  points_case c = {.s = {.ctx = ctx, .dim = 1, .n = n, .rows = n}};
  sph_particles_options po;
  sph_neighbors_options no;
  sph_particles_options_init(&po);
  po.dim = 1;
  sph_neighbors_options_init(&no);
  no.periodic[0] = 1;
  no.box_hi[0] = 1.0;
  check_ok(sph_particles_create(ctx, &po, &c.s.set));
  check_ok(sph_particles_add(c.s.set, n, NULL));
  check_ok(sph_kernel_create(ctx, SPH_KERNEL_CUBIC_SPLINE, 1, &c.s.kernel));
  check_ok(sph_neighbors_create(ctx, &no, &c.s.list));
  for (int i = 0; i < n; i++) {
    const double x = (i + 0.5) / n;
    rh_field(&c.s, SPH_FIELD_X)[i] = x;
    rh_field(&c.s, SPH_FIELD_V)[i] =
        stress != 0.0 ? (i == n / 2 ? 1e-9 : 0.0) : 1e-6 * sin(6.283185307179586 * x);
    rh_field(&c.s, SPH_FIELD_M)[i] = 1.0 / n;
    rh_field(&c.s, SPH_FIELD_RHO)[i] = 1.0;
    rh_field(&c.s, SPH_FIELD_H)[i] = 1.2 / n;
  }
  check_ok(sph_particles_touch(c.s.set, SPH_FIELD_X));
  check_ok(sph_stress_points_create(ctx, c.s.kernel, c.s.list, o, &c.p));
  c.law = make_law(ctx, unit_young);
  check_ok(sph_stress_points_set_material(c.p, 0, c.law));
  check_ok(sph_stress_points_place(c.p, c.s.set));
  for (int p = 0; p < 2 * n; p++) {
    const double x = rh_field(&c.s, SPH_FIELD_X)[p / 2] + sph_stress_points_offsets(c.p)[p];
    sph_stress_points_stresses(c.p)[p] =
        stress != 0.0 ? stress : -1e-6 * sin(6.283185307179586 * x);
  }
  return c;
}

static void integrate(points_case *c, double end, int steps) {
  sph_integrator *it = NULL;
  check_ok(sph_integrator_create(c->s.ctx, NULL, &it));
  check_ok(sph_stress_points_bind(c->p, it));
  for (int k = 0; k < steps; k++)
    check_ok(sph_integrator_step(it, c->s.set, k * end / steps, end / steps, NULL));
  sph_integrator_destroy(it);
}

/* Error of the velocity after one period. */
static double wave_error(int n, double offset, int32_t form) {
  sph_context *ctx = rh_context(1);
  sph_stress_points_options o;
  double e2 = 0.0;
  sph_stress_points_options_init(&o);
  o.offset = offset;
  o.form = form;
  points_case c = make_bar(ctx, n, &o, 0.0);
  integrate(&c, 1.0, 2 * n);
  for (int i = 0; i < n; i++) {
    const double wanted = 1e-6 * sin(6.283185307179586 * (i + 0.5) / n);
    const double e = gh_const(&c.s, SPH_FIELD_V)[i] - wanted;
    e2 += e * e / (0.5e-12 * n);
  }
  check_ok(sph_stress_points_average(c.p, c.s.set));
  check_close(gh_const(&c.s, SPH_FIELD_SIGMA)[0],
              0.5 * (sph_stress_points_stresses(c.p)[0] + sph_stress_points_stresses(c.p)[1]),
              1e-20);
  free_case(&c);
  sph_context_destroy(ctx);
  return sqrt(e2);
}

static void test_wave(void **state) {
  (void)state;
  for (int32_t form = SPH_STRESS_SUMMED; form <= SPH_STRESS_DIFFERENCE; form++) {
    const double coarse = wave_error(20, 0.5, form), fine = wave_error(80, 0.5, form);
    const double rate = log(coarse / fine) / log(4.0);
    if (!(fine < 0.02 && rate > 1.9)) fail_msg("errors %g, %g, rate %g", coarse, fine, rate);
  }
  /* the staggered grid disperses less than the collocated one */
  assert_true(wave_error(40, 0.5, SPH_STRESS_DIFFERENCE) <
              wave_error(40, 0.0, SPH_STRESS_DIFFERENCE));
}

/* Under tension the collocated sum clumps, the staggered one does not. */
static void test_tension(void **state) {
  (void)state;
  for (int staggered = 0; staggered < 2; staggered++) {
    sph_context *ctx = rh_context(1);
    sph_stress_points_options o;
    sph_stress_points_options_init(&o);
    o.offset = staggered ? 0.5 : 0.0;
    o.form = SPH_STRESS_SUMMED;
    o.corrected = 0;
    points_case c = make_bar(ctx, 64, &o, 0.1);
    integrate(&c, 0.5, 200);
    const double most = rh_largest(gh_const(&c.s, SPH_FIELD_V), 64);
    if (staggered ? most > 1e-9 : most < 1e-6) fail_msg("staggered %d: %g", staggered, most);
    free_case(&c);
    sph_context_destroy(ctx);
  }
}

/* --- hooks, threads, phases --------------------------------------------------------------------
 */

static void test_hooks(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_stress_points_options o;
  sph_hold *hold = NULL;
  check_ok(sph_hold_create(ctx, &hold));
  check_ok(sph_hold_field(hold, SPH_FIELD_V, 5, NULL, 0, UINT64_MAX, NULL, NULL, NULL));
  rh_system s = rh_make(ctx, 2, 9, 0, 3);
  const gh_frame frame = gh_identity();
  sph_ghosts *g = gh_ghosts(&s, 0.0);
  gh_box(g, &frame, 2, 9, SPH_WALL_SLIP);
  sph_stress_points_options_init(&o);
  o.prepare = sph_ghosts_prepare;
  o.prepare_user = g;
  o.finish = sph_hold_finish;
  o.finish_user = hold;
  points_case c = make_case(ctx, 2, 9, 0, &o);
  points_rates r = make_rates(&c);
  assert_int_equal(sph_stress_points_rates(c.p, 0.0, c.s.set, r.list, 5), 0);
  assert_true(sph_particles_count(c.s.set) > c.s.rows);
  for (int k = 0; k < 10; k++) assert_true(r.v[k] == 0.0);
  assert_true(r.v[10] != 0.0);
  check_ok(sph_hold_field(hold, SPH_FIELD_V, 1, NULL, 5000, 1, NULL, NULL, NULL));
  assert_int_equal(sph_stress_points_rates(c.p, 0.0, c.s.set, r.list, 5), SPH_ERR_ARG);
  free_rates(&r);
  free_case(&c);
  sph_ghosts_destroy(g);
  rh_free(&s);
  sph_hold_destroy(hold);
  sph_context_destroy(ctx);
}

static void test_threads(void **state) {
  (void)state;
  double *first = NULL;
  for (int32_t threads = 1; threads <= 5; threads += 2) {
    sph_context *ctx = rh_context(threads);
    points_case c = make_case(ctx, 3, 8, RH_VARY_ALL, NULL);
    points_rates r = make_rates(&c);
    assert_int_equal(sph_stress_points_rates(c.p, 0.0, c.s.set, r.list, 5), 0);
    const int64_t n = 3 * c.s.rows;
    if (!first) {
      first = rh_array(n);
      memcpy(first, r.v, (size_t)n * sizeof *first);
    }
    assert_memory_equal(first, r.v, (size_t)n * sizeof *first);
    free_rates(&r);
    free_case(&c);
    sph_context_destroy(ctx);
  }
  free(first);
}

static int32_t refuse(void *user, const sph_material_block *b, double *out) {
  (void)user;
  (void)b;
  (void)out;
  return -7;
}

static void test_errors(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_stress_points_options o;
  sph_stress_points *bad = NULL;
  points_case c = make_case(ctx, 2, 6, 0, NULL);
  points_rates r = make_rates(&c);
#define REFUSE(change, wanted)                                                         \
  sph_stress_points_options_init(&o);                                                  \
  change;                                                                              \
  check_status(sph_stress_points_create(ctx, c.s.kernel, c.s.list, &o, &bad), wanted); \
  assert_null(bad);
  REFUSE(o.offset = 0.51, SPH_ERR_ARG)
  REFUSE(o.offset = -0.1, SPH_ERR_ARG)
  REFUSE(o.offset = NAN, SPH_ERR_ARG)
  REFUSE(o.form = SPH_STRESS_CONSERVATIVE, SPH_ERR_ARG)
  REFUSE(o.form = 0, SPH_ERR_ARG)
  REFUSE(o.size = 2, SPH_ERR_ARG)
#undef REFUSE
  const sph_rate other = {SPH_FIELD_E, r.rho}, null = {SPH_FIELD_V, NULL};
  const sph_rate three[3] = {{-1, r.offsets}, {-2, r.stresses}, {-3, r.v}};
  assert_int_equal(sph_stress_points_rates(c.p, 0.0, c.s.set, &other, 1), SPH_ERR_ARG);
  assert_int_equal(sph_stress_points_rates(c.p, 0.0, c.s.set, &null, 1), SPH_ERR_ARG);
  assert_int_equal(sph_stress_points_rates(c.p, 0.0, c.s.set, three, 3), SPH_ERR_ARG);
  check_status(sph_stress_points_set_material(c.p, 256, c.law), SPH_ERR_ARG);
  check_status(sph_stress_points_set_material(c.p, -1, c.law), SPH_ERR_ARG);
  sph_particles_phases(c.s.set)[7] = 3; /* a phase without a law; then one that fails */
  assert_int_equal(sph_stress_points_rates(c.p, 0.0, c.s.set, r.list, 5), SPH_ERR_STATE);
  assert_non_null(strstr(sph_context_last_error(ctx), "particle 7 has phase 3"));
  sph_material *failing = make_law(ctx, refuse);
  check_ok(sph_stress_points_set_material(c.p, 3, failing));
  sph_material_destroy(failing);
  assert_int_equal(sph_stress_points_rates(c.p, 0.0, c.s.set, r.list, 5), SPH_ERR_CALLBACK);
  assert_int_equal(sph_stress_points_rates(c.p, 0.0, c.s.set, r.list, 2), 0); /* no stresses */
  check_ok(sph_stress_points_set_material(c.p, 3, NULL));
  sph_particles_phases(c.s.set)[7] = 0;
  /* masses and densities; the points there are stay */
  double *offsets = sph_stress_points_offsets(c.p), *m = rh_field(&c.s, SPH_FIELD_M), kept = m[4];
  m[4] = 0.0;
  check_status(sph_stress_points_place(c.p, c.s.set), SPH_ERR_ARG);
  assert_non_null(strstr(sph_context_last_error(ctx), "particle 4"));
  m[4] = kept;
  assert_ptr_equal(offsets, sph_stress_points_offsets(c.p));
  rh_system line = rh_make(ctx, 1, 6, 0, 1);
  check_status(sph_stress_points_place(c.p, line.set), SPH_ERR_ARG);
  rh_free(&line);
  /* other particles than those that the points were made for */
  check_ok(sph_particles_add(c.s.set, 1, NULL));
  assert_int_equal(sph_stress_points_rates(c.p, 0.0, c.s.set, r.list, 5), SPH_ERR_STATE);
  check_status(sph_stress_points_average(c.p, c.s.set), SPH_ERR_STATE);
  /* leapfrog takes no arrays; nothing placed yet */
  sph_integrator_options io;
  sph_integrator *it = NULL;
  sph_integrator_options_init(&io);
  io.method = SPH_INTEGRATOR_LEAPFROG;
  check_ok(sph_integrator_create(ctx, &io, &it));
  check_status(sph_stress_points_bind(c.p, it), SPH_ERR_UNSUPPORTED);
  check_ok(sph_stress_points_create(ctx, c.s.kernel, c.s.list, NULL, &bad));
  check_status(sph_stress_points_bind(bad, it), SPH_ERR_STATE);
  sph_stress_points_destroy(bad);
  sph_integrator_destroy(it);
  free_rates(&r);
  free_case(&c);
  sph_context_destroy(ctx);
}

static sph_status out_of_memory(sph_context *ctx, void *user) {
  (void)user;
  oom_pause();
  rh_system s = rh_make(ctx, 2, 6, 0, 2);
  sph_material *law = make_law(ctx, show_strain);
  double *rates = rh_array(3 * 4 * s.rows);
  oom_resume();
  sph_stress_points *p = NULL;
  sph_status status = sph_stress_points_create(ctx, s.kernel, s.list, NULL, &p);
  if (!status) status = sph_stress_points_set_material(p, 0, law);
  if (!status) status = sph_stress_points_place(p, s.set);
  const sph_rate rate = {SPH_FIELD_V, rates};
  for (int k = 0; k < 2 && !status; k++) /* the list takes what it needs to compare with */
    status = sph_stress_points_rates(p, 0.0, s.set, &rate, 1);
  int64_t before = 0, after = 0;
  if (!status) check_ok(sph_context_memory(ctx, NULL, NULL, &before));
  if (!status) check_ok(sph_stress_points_rates(p, 0.0, s.set, &rate, 1));
  if (!status) check_ok(sph_context_memory(ctx, NULL, NULL, &after));
  assert_int_equal(before, after); /* a steady call allocates nothing */
  sph_stress_points_destroy(p);
  free(rates);
  sph_material_destroy(law);
  rh_free(&s);
  return status;
}

static void test_memory(void **state) {
  (void)state;
  oom_sweep(out_of_memory, NULL);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_linear),     cmocka_unit_test(test_bar),
    cmocka_unit_test(test_collocated), cmocka_unit_test(test_wave),
    cmocka_unit_test(test_tension),    cmocka_unit_test(test_hooks),
    cmocka_unit_test(test_threads),    cmocka_unit_test(test_errors),
    cmocka_unit_test(test_memory),
};
SPH_TEST_MAIN(tests)
