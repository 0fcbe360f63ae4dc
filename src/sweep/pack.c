/* Packing: host arrays, in host order, into records in sweep order. Quantities that every pair
 * would otherwise recompute (m/rho, p/rho^2, sigma/rho^2) are made here, once per particle. */
#include "run.h"

static double value(const double *array, double uniform, int64_t i) {
  return array ? array[i] : uniform;
}

static double rho_of(const sph_operands *a, int64_t i) { return value(a->rho, a->rho0, i); }

/* The pressure in the shape that its form sums. */
static double pressure_of(const sphi_run *run, int64_t i) {
  const sph_operands *a = run->sweep->a;
  double p = value(a->p, a->p0, i), rho = rho_of(a, i);
  double vol = value(a->m, a->m0, i) / rho;
  switch (run->spec.pressure) {
    case SPH_PRESSURE_MASS: return p / (rho * rho);
    case SPH_PRESSURE_NUMBER: return p * vol * vol;
    default: return p;
  }
}

static void pack_stress(const sphi_run *run, int64_t i, double *rec) {
  const sph_operands *a = run->sweep->a;
  int n = sphi_sym(a->dim);
  double rho = rho_of(a, i);
  double scale = run->spec.stress == SPH_STRESS_DIFFERENCE ? 1.0 : 1.0 / (rho * rho);
  for (int c = 0; c < n; ++c) rec[run->layout.s + c] = scale * a->sigma[i * n + c];
}

/* sigma B^-1 / rho^2 of the conservative form. */
static void pack_corrected_stress(const sphi_run *run, int64_t i, double *rec) {
  static const int at[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  static const int at2[2][2] = {{0, 2}, {2, 1}};
  const sph_operands *a = run->sweep->a;
  int d = a->dim;
  double rho = rho_of(a, i);
  const double *s = a->sigma + i * sphi_sym(d), *b = a->gradient_matrix + i * d * d;
  for (int r = 0; r < d; ++r)
    for (int c = 0; c < d; ++c) {
      double sum = 0.0;
      for (int k = 0; k < d; ++k) sum += s[d == 2 ? at2[r][k] : at[r][k]] * b[k * d + c];
      rec[run->layout.t + r * d + c] = sum / (rho * rho);
    }
}

static void pack_field(const sphi_run *run, int64_t i, double *rec) {
  const sphi_sweep *s = run->sweep;
  for (int c = 0; c < SPHI_FIELD_WIDTH; ++c)
    rec[run->layout.f + c] = c < s->f_count ? s->f[i * s->f_stride + c] : 0.0;
}

static void pack_scalars(const sphi_run *run, int64_t i, double *rec) {
  const sphi_record *y = &run->layout;
  const sph_operands *a = run->sweep->a;
  if (y->rho >= 0) rec[y->rho] = rho_of(a, i);
  if (y->p >= 0) rec[y->p] = pressure_of(run, i);
  if (y->vol >= 0) rec[y->vol] = value(a->m, a->m0, i) / rho_of(a, i);
  if (y->m >= 0) rec[y->m] = value(a->m, a->m0, i);
  if (y->h >= 0) rec[y->h] = value(a->h, a->h0, i);
  if (y->c >= 0) rec[y->c] = value(a->c, a->c0, i);
  if (y->q >= 0) rec[y->q] = run->sweep->q[i] / (rho_of(a, i) * rho_of(a, i));
}

static void pack_one(const sphi_run *run, int64_t i, double *rec) {
  const sphi_record *y = &run->layout;
  const sph_operands *a = run->sweep->a;
  int d = a->dim, n = sphi_sym(d);
  for (int c = 0; c < d; ++c) rec[y->x + c] = a->x[i * d + c];
  if (y->v >= 0)
    for (int c = 0; c < d; ++c) rec[y->v + c] = a->v[i * d + c];
  pack_scalars(run, i, rec);
  if (y->s >= 0) pack_stress(run, i, rec);
  if (y->t >= 0) pack_corrected_stress(run, i, rec);
  if (y->r >= 0)
    for (int c = 0; c < n; ++c) rec[y->r + c] = run->sweep->art[i * n + c];
  if (y->f >= 0) pack_field(run, i, rec);
}

void sphi_pack(const sphi_run *run, int64_t lo, int64_t hi) {
  int64_t stride = run->layout.quads * 4;
  for (int64_t k = lo; k < hi; ++k)
    pack_one(run, run->list->order[k], run->records + k * stride);
}
