/* Speed of the pair sums of compressible flow, through the public calls: number smoothing with the
 * Gaussian, h = 1.2 spacings and different from particle to particle, masses that differ; packing
 * and unpacking included, the list built before and reused. Arguments: bench_args.h; case
 * shock_rhs, form=fluid (pressure), gas (and dissipation), solid (and deviator), omega (the gather
 * before).
 *
 * Beside it the same sums as a plain C loop, one pair at a time, over the same rows: two calls of
 * exp(), one square root, as few divisions as the formulas allow, what belongs to one particle
 * computed once. */
#include "bench.h"

#include "bench_args.h"
#include "bench_cases.h"

enum { FLUID, GAS, SOLID, OMEGA, FORMS };
static const char *const form_name[FORMS] = {"fluid", "gas", "solid", "omega"};

static bench_args args;

/* Everything that one size needs; results: of the library, and of the plain loop. */
typedef struct shocks {
  sph_context *ctx;
  sph_kernel *kernel;
  sph_particles *set;
  sph_neighbors *list;
  sph_rhs *rhs[OMEGA];
  sph_operands a;
  sph_dissipation loss;
  int32_t dim;
  int form;
  int64_t n, rows;
  const int64_t *offsets;
  const int32_t *indices;
  double *drho, *dvdt, *dedt, *omega, *plain[4], *per_h, *norm, *q, *vol;
} shocks;

static double *fill(shocks *s, int32_t field, double lo, double hi) {
  double *a = NULL;
  BENCH_OK(sph_particles_field(s->set, field, &a), s->ctx);
  for (int64_t k = 0; k < s->n * sph_particles_components(s->set, field); k++)
    a[k] = bench_random(lo, hi);
  BENCH_OK(sph_particles_touch(s->set, field), s->ctx);
  return a;
}

static void place(shocks *s, int64_t side) {
  double *x = fill(s, SPH_FIELD_X, 0.2, 0.8);
  for (int64_t i = 0; i < s->n; i++)
    for (int64_t a = 0, k = i; a < s->dim; a++, k /= side) x[i * s->dim + a] += (double)(k % side);
  BENCH_OK(sph_particles_touch(s->set, SPH_FIELD_X), s->ctx);
  BENCH_OK(sph_particles_sort(s->set, 4.0, NULL), s->ctx);
}

static void make_set(shocks *s, int64_t n) {
  sph_particles_options o;
  int64_t side = bench_side(n, s->dim);
  bench_seed = 11;
  s->n = s->dim == 1 ? side : s->dim == 2 ? side * side : side * side * side;
  sph_particles_options_init(&o);
  o.dim = s->dim;
  BENCH_OK(sph_particles_create(s->ctx, &o, &s->set), s->ctx);
  BENCH_OK(sph_particles_add(s->set, s->n, NULL), s->ctx);
  place(s, side);
  fill(s, SPH_FIELD_V, -1.0, 1.0);
  fill(s, SPH_FIELD_M, 0.9, 1.1);
  fill(s, SPH_FIELD_RHO, 0.9, 1.1);
  fill(s, SPH_FIELD_H, 1.15, 1.25);
  fill(s, SPH_FIELD_P, 0.5, 2.0);
  fill(s, SPH_FIELD_C, 1.0, 1.5);
  fill(s, SPH_FIELD_E, 1.0, 2.0);
  fill(s, SPH_FIELD_OMEGA, 0.9, 1.1);
  fill(s, SPH_FIELD_SIGMA, -0.5, 0.5);
}

static void make_list(shocks *s) {
  sph_neighbors_options o;
  sph_neighbors_options_init(&o);
  o.h_rule = SPH_H_MAX;
  o.support = sph_kernel_support(s->kernel);
  BENCH_OK(sph_neighbors_create(s->ctx, &o, &s->list), s->ctx);
  BENCH_OK(sph_neighbors_build(s->list, s->set), s->ctx);
  BENCH_OK(sph_neighbors_rows(s->list, &s->offsets, &s->indices), s->ctx);
}

static void make_rhs(shocks *s) {
  static const int32_t kinds[] = {SPH_TERM_SMOOTHED, SPH_TERM_DISSIPATION,
                                  SPH_TERM_SMOOTHED_STRESS};
  for (int form = 0; form < OMEGA; form++) {
    BENCH_OK(sph_rhs_create(s->ctx, s->kernel, NULL, &s->rhs[form]), s->ctx);
    for (int k = 0; k <= form; k++) {
      sph_term t;
      sph_term_init(&t);
      t.kind = kinds[k];
      t.form = k == 0 ? SPH_SMOOTHING_NUMBER : 0;
      BENCH_OK(sph_rhs_add(s->rhs[form], &t), s->ctx);
    }
  }
}

static void shocks_open(shocks *s, int32_t dim, int64_t n, int32_t threads, int32_t isa) {
  sph_context_options o;
  memset(s, 0, sizeof *s);
  s->dim = dim;
  sph_context_options_init(&o);
  o.threads = threads;
  o.isa = isa;
  bench_pin(threads);
  BENCH_OK(sph_context_create(&o, &s->ctx), NULL);
  BENCH_OK(sph_kernel_create(s->ctx, SPH_KERNEL_GAUSSIAN, dim, &s->kernel), s->ctx);
  make_set(s, n);
  make_list(s);
  make_rhs(s);
  sph_operands_init(&s->a);
  BENCH_OK(sph_operands_from_set(s->set, &s->a), s->ctx);
  sph_dissipation_init(&s->loss);
  double **scalars[] = {&s->drho, &s->dedt, &s->omega,    &s->per_h,    &s->norm,
                        &s->q,    &s->vol,  &s->plain[0], &s->plain[2], &s->plain[3]};
  for (size_t k = 0; k < sizeof scalars / sizeof *scalars; k++)
    *scalars[k] = bench_alloc(s->n, sizeof(double));
  s->dvdt = bench_alloc(s->n * dim, sizeof(double));
  s->plain[1] = bench_alloc(s->n * dim, sizeof(double));
}

static void shocks_close(shocks *s) {
  double *arrays[] = {s->drho, s->dedt, s->omega,    s->per_h,    s->norm,     s->q,
                      s->vol,  s->dvdt, s->plain[0], s->plain[1], s->plain[2], s->plain[3]};
  for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) free(arrays[k]);
  for (int k = 0; k < OMEGA; k++) sph_rhs_destroy(s->rhs[k]);
  sph_neighbors_destroy(s->list);
  sph_kernel_destroy(s->kernel);
  sph_particles_destroy(s->set);
  sph_context_destroy(s->ctx);
}

static void run_library(void *user) {
  shocks *s = user;
  const sph_rate rates[] = {
      {SPH_FIELD_RHO, s->drho}, {SPH_FIELD_V, s->dvdt}, {SPH_FIELD_E, s->dedt}};
  if (s->form == OMEGA)
    BENCH_OK(sph_grad_h(s->list, s->kernel, &s->a, SPH_SMOOTHING_NUMBER, 0.2, s->omega), s->ctx);
  else
    BENCH_OK(sph_rhs_evaluate(s->rhs[s->form], s->set, s->list, 0.0, rates, 3), s->ctx);
}

/* --- the plain loop ----------------------------------------------------------------------- */

#define PLAIN static inline __attribute__((always_inline))

PLAIN double slope_of(double r2, double per_h, double norm) {
  double q2 = r2 * per_h * per_h;
  return q2 < 9.0 ? -2.0 * norm * exp(-q2) : 0.0;
}

typedef struct row {
  double drho, flux, heat, work, a[3], k[3];
} row;

PLAIN void plain_losses(const shocks *s, int64_t i, int64_t j, int dim, double r2, double vx,
                        const double *dx, double slope, row *t) {
  const sph_operands *a = &s->a;
  const sph_dissipation *z = &s->loss;
  if (vx >= 0.0 || r2 == 0.0) return;
  double r = sqrt(r2), u = vx / r, k = a->m[j] * slope / (a->rho[i] + a->rho[j]);
  double c = 0.5 * (a->c[i] + a->c[j]), viscous = z->viscosity * (c - 0.5 * z->viscosity_b * u) * u;
  double conducted = z->conductivity * (c - 0.5 * z->conductivity_b * u) * (a->e[i] - a->e[j]);
  t->flux += k * r * z->mass_flux * (a->p[i] - a->p[j]) / (c - 0.5 * z->mass_flux_b * u);
  t->heat += k * r * (conducted - 0.5 * viscous * u);
  for (int b = 0; b < dim; b++) t->a[b] += k * viscous * dx[b];
}

PLAIN void plain_stress(const shocks *s, int64_t i, int64_t j, int dim, const double *dx,
                        const double *dv, double gi, double gj, row *t) {
  static const int at[4][3][3] = {
      {{0}}, {{0}}, {{0, 2}, {2, 1}}, {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}}};
  const int n = dim * (dim + 1) / 2;
  const double *ti = s->a.sigma + i * n, *tj = s->a.sigma + j * n, per = 1.0 / s->a.rho[i];
  for (int a = 0; a < dim; a++) {
    double xi = 0.0, xj = 0.0;
    for (int b = 0; b < dim; b++) {
      xi += ti[at[dim][a][b]] * dx[b];
      xj += tj[at[dim][a][b]] * dx[b];
    }
    t->a[a] += per * s->vol[j] * (gi * xi + gj * xj);
    t->work -= per * s->vol[j] * gi * dv[a] * xi;
  }
}

PLAIN void plain_pair(const shocks *s, int form, int dim, int64_t i, int64_t j, row *t) {
  const sph_operands *a = &s->a;
  double dx[3], dv[3], r2 = 0.0, vx = 0.0;
  for (int b = 0; b < dim; b++) {
    dx[b] = a->x[i * dim + b] - a->x[j * dim + b];
    dv[b] = a->v[i * dim + b] - a->v[j * dim + b];
    r2 += dx[b] * dx[b];
    vx += dv[b] * dx[b];
  }
  double gi = slope_of(r2, s->per_h[i], s->norm[i]), gj = slope_of(r2, s->per_h[j], s->norm[j]);
  double force = (s->q[i] * gi + s->q[j] * gj) / a->m[i];
  t->drho += gi * vx;
  for (int b = 0; b < dim; b++) t->a[b] -= force * dx[b];
  if (form >= GAS) plain_losses(s, i, j, dim, r2, vx, dx, gi + gj, t);
  if (form >= SOLID) plain_stress(s, i, j, dim, dx, dv, gi, gj, t);
}

PLAIN void plain_row(const shocks *s, int form, int dim, int64_t i) {
  const sph_operands *a = &s->a;
  row t = {0.0, 0.0, 0.0, 0.0, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  for (int64_t k = s->offsets[i]; k < s->offsets[i + 1]; k++)
    plain_pair(s, form, dim, i, s->indices[k], &t);
  double rate = a->m[i] / a->omega[i] * t.drho;
  double most = s->loss.flux_limit * a->rho[i] * a->c[i] / a->h[i];
  s->plain[0][i] = rate + fmin(fmax(t.flux, -most), most);
  for (int b = 0; b < dim; b++) s->plain[1][i * dim + b] = t.a[b];
  s->plain[2][i] = a->p[i] / (a->rho[i] * a->rho[i]) * rate + t.heat + t.work;
}

PLAIN void plain_omega(const shocks *s, int dim, int64_t i) {
  const sph_operands *a = &s->a;
  double per_h2 = s->per_h[i] * s->per_h[i], sum = dim;
  for (int64_t k = s->offsets[i]; k < s->offsets[i + 1]; k++) {
    double r2 = 0.0;
    for (int b = 0; b < dim; b++) {
      double dx = a->x[i * dim + b] - a->x[s->indices[k] * dim + b];
      r2 += dx * dx;
    }
    double q2 = r2 * per_h2;
    if (q2 < 9.0) sum += (dim - 2.0 * q2) * exp(-q2);
  }
  double omega = 1.0 - a->m[i] * s->norm[i] / per_h2 * sum / (dim * a->rho[i]);
  s->plain[3][i] = fmax(omega, 0.2);
}

PLAIN void plain_rows(const shocks *s, int form, int dim) {
  for (int64_t i = 0; i < s->rows; i++)
    if (form == OMEGA)
      plain_omega(s, dim, i);
    else
      plain_row(s, form, dim, i);
}

#define PLAIN_FORMS(dim)                    \
  static void plain##dim(const shocks *s) { \
    switch (s->form) {                      \
    case FLUID:                             \
      plain_rows(s, FLUID, dim);            \
      break;                                \
    case GAS:                               \
      plain_rows(s, GAS, dim);              \
      break;                                \
    case SOLID:                             \
      plain_rows(s, SOLID, dim);            \
      break;                                \
    default:                                \
      plain_rows(s, OMEGA, dim);            \
      break;                                \
    }                                       \
  }
PLAIN_FORMS(1)
PLAIN_FORMS(2)
PLAIN_FORMS(3)

static void run_plain(void *user) {
  shocks *s = user;
  const sph_operands *a = &s->a;
  double w0 = sph_kernel_w(s->kernel, 0.0, 1.0); /* alpha */
  for (int64_t i = 0; i < s->n; i++) {
    double m = a->m[i], rho = a->rho[i];
    s->per_h[i] = 1.0 / a->h[i];
    s->norm[i] = w0 * pow(s->per_h[i], s->dim + 2);
    s->q[i] = m * m * a->p[i] / (a->omega[i] * rho * rho);
    s->vol[i] = m / rho;
  }
  s->dim == 1 ? plain1(s) : s->dim == 2 ? plain2(s) : plain3(s);
}

/* --- measuring ------------------------------------------------------------------------------ */

static double difference(const double *a, const double *b, int64_t n) {
  double most = 0.0, size = 0.0;
  for (int64_t i = 0; i < n; i++) {
    most = fmax(most, fabs(a[i] - b[i]));
    size = fmax(size, fabs(b[i]));
  }
  return most / size;
}

/* Whether both compute the same. */
static void compare(shocks *s) {
  double d;
  s->rows = s->n;
  run_library(s);
  run_plain(s);
  if (s->form == OMEGA)
    d = difference(s->omega, s->plain[3], s->n);
  else
    d = fmax(difference(s->drho, s->plain[0], s->n),
             fmax(difference(s->dvdt, s->plain[1], s->n * s->dim),
                  difference(s->dedt, s->plain[2], s->n)));
  if (d < 1e-10) return;
  printf("failed: shock_rhs %s differs from the plain loop by %g\n", form_name[s->form], d);
  exit(1);
}

/* Pairs per second of the plain loop, by a quarter of the rows. */
static double plain_rate(shocks *s) {
  s->rows = s->n / 4;
  double pairs = (double)(s->offsets[s->rows] - s->offsets[0]);
  return pairs / bench_measure(run_plain, s, args.repetitions).wall;
}

static void run(int32_t dim, int64_t n, int32_t threads, int32_t isa, double *plain) {
  shocks s;
  shocks_open(&s, dim, n, threads, isa);
  for (s.form = 0; s.form < FORMS; s.form++) {
    if (!bench_wants_form(&args, form_name[s.form])) continue;
    if (plain[s.form] == 0.0 && !args.bare) {
      compare(&s);
      plain[s.form] = plain_rate(&s);
    }
    bench_line line = {.name = "shock_rhs",
                       .dim = dim,
                       .n = s.n,
                       .threads = threads,
                       .isa = isa,
                       .pairs = (double)sph_neighbors_pairs(s.list),
                       .time = bench_measure(run_library, &s, args.repetitions),
                       .scalar_rate = plain[s.form]};
    bench_print(&line, "form=%s kernel=gaussian", form_name[s.form]);
  }
  shocks_close(&s);
}

int main(int argc, char **argv) {
  static const int64_t size[4] = {0, 200000, 100000, 30000};
  args = bench_read_args(argc, argv);
  if (!bench_wants(&args, "shock_rhs")) return 0;
  for (int32_t dim = 3; dim >= 1; dim--) {
    double plain[FORMS] = {0.0};
    int64_t n = args.n ? args.n : size[dim];
    if (!bench_wants_dim(&args, dim)) continue;
    int32_t best = args.isa ? args.isa : bench_best_isa();
    run(dim, n, 1, best, plain);
    for (int32_t isa = best - 1;
         isa >= SPH_ISA_PORTABLE && !args.isa && bench_wants_variants(&args); isa--)
      if (sph_isa_available(isa)) run(dim, n, 1, isa, plain);
    if (bench_wants_threads(&args)) run(dim, n, bench_threads(&args), best, plain);
  }
  return 0;
}
