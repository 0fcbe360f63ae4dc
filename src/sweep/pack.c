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
  case SPH_PRESSURE_MASS:
    return p / (rho * rho);
  case SPH_PRESSURE_NUMBER:
    return p * vol * vol;
  default:
    return p;
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

static void add_stream(sphi_streams *s, const double *base, int64_t doubles) {
  if (!base || s->count == SPHI_MAX_STREAMS) return;
  s->at[s->count].base = (const char *)base;
  s->at[s->count++].stride = doubles * (int64_t)sizeof(double);
}

static void add_inputs(sphi_run *run) {
  const sphi_record *y = &run->layout;
  const sphi_sweep *sw = run->sweep;
  const sph_operands *a = sw->a;
  int d = a->dim, sym = sphi_sym(d);
  int stress = y->s >= 0 || y->t >= 0;
  add_stream(&run->in, a->x, d);
  if (y->v >= 0) add_stream(&run->in, a->v, d);
  if (y->rho >= 0 || y->vol >= 0 || y->p >= 0 || stress) add_stream(&run->in, a->rho, 1);
  if (y->m >= 0 || y->vol >= 0) add_stream(&run->in, a->m, 1);
  if (y->p >= 0) add_stream(&run->in, a->p, 1);
  if (y->h >= 0) add_stream(&run->in, a->h, 1);
  if (y->c >= 0) add_stream(&run->in, a->c, 1);
  if (y->q >= 0) add_stream(&run->in, sw->q, 1);
  if (stress) add_stream(&run->in, a->sigma, sym);
  if (y->t >= 0) add_stream(&run->in, a->gradient_matrix, d * d);
  if (y->r >= 0) add_stream(&run->in, sw->art, sym);
  if (y->f >= 0) add_stream(&run->in, sw->f, sw->f_stride);
}

static void add_outputs(sphi_run *run) {
  const uint32_t terms = run->spec.terms;
  const sphi_sweep *sw = run->sweep;
  int d = sw->a->dim;
  if (terms & SPHI_DENSITY) add_stream(&run->out, sw->density, 1);
  if (terms & SPHI_CONTINUITY) add_stream(&run->out, sw->drho, 1);
  if (terms & SPHI_GRADV) add_stream(&run->out, sw->gradv, d * d);
  if (terms & SPHI_ALL_FORCES) add_stream(&run->out, sw->dvdt, d);
  if (terms & SPHI_XSPH) add_stream(&run->out, sw->xsph, d);
  if (terms & SPHI_MATRIX) add_stream(&run->out, sw->matrix, d * d);
  if (terms & SPHI_SHEPARD) add_stream(&run->out, sw->shepard, 1);
  if (terms & SPHI_INTERP) add_stream(&run->out, sw->interp, sw->interp_stride);
  if (terms & SPHI_GRADF) add_stream(&run->out, sw->gradf, sw->gradf_stride);
}

void sphi_streams_of(sphi_run *run) {
  run->in.count = run->out.count = 0;
  add_inputs(run);
  add_outputs(run);
}

/* Far enough for the memory's latency at the pace of packing. */
enum { AHEAD = 24 };

void sphi_pack(const sphi_run *run, int64_t lo, int64_t hi) {
  const uint32_t *order = run->list->order;
  int64_t stride = run->layout.quads * 4;
  for (int64_t k = lo; k < hi; ++k) {
    if (k + AHEAD < hi) sphi_prefetch(&run->in, order[k + AHEAD - 1], order[k + AHEAD], 0);
    pack_one(run, order[k], run->records + k * stride);
  }
}
