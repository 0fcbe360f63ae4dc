/* Wasserstein distance: arguments, masses in whole units, order along a curve, and the line. */
#include "reference_impl.h"

#include <math.h>
#include <string.h>

/* One of the two measures as the host gave it, and as it is worked on. */
typedef struct measure {
  const char *name;
  int64_t n;
  const double *x, *mass; /* mass NULL: all equal */
  double total;
  int equal;       /* all masses are the same */
  int64_t kept;    /* points of at least one unit, in order: */
  double *at;      /* kept * dim, scaled to the unit cube */
  int64_t *units;  /* kept */
  uint64_t *order; /* scratch of the sort: 4 n */
} measure;

/* ---- arguments --------------------------------------------------------------------------- */

enum { LARGEST = (1 << 30) - 1 };

static sph_status check_points(sph_context *ctx, const measure *a, int32_t dim) {
  if (a->n < 1)
    return sphi_fail(ctx, SPH_ERR_ARG, "n%s = %lld is below 1", a->name, (long long)a->n);
  if (a->n > LARGEST)
    return sphi_fail(ctx, SPH_ERR_LIMIT, "n%s = %lld is above 2^30 - 1", a->name, (long long)a->n);
  if (!a->x) return sphi_fail(ctx, SPH_ERR_ARG, "%s is NULL", a->name);
  for (int64_t k = 0; k < a->n * dim; ++k)
    if (!isfinite(a->x[k]))
      return sphi_fail(ctx, SPH_ERR_ARG, "%s: position %lld has the coordinate %g", a->name,
                       (long long)(k / dim), a->x[k]);
  return SPH_OK;
}

static sph_status check_masses(sph_context *ctx, measure *a) {
  double rest = 0.0;
  a->equal = 1;
  a->total = a->mass ? 0.0 : (double)a->n;
  for (int64_t k = 0; a->mass && k < a->n; ++k) {
    const double m = a->mass[k], next = a->total + m;
    if (!(m >= 0.0) || !isfinite(m))
      return sphi_fail(ctx, SPH_ERR_ARG, "m%s[%lld] = %g is negative or not finite", a->name,
                       (long long)k, m);
    rest += a->total >= m ? (a->total - next) + m : (m - next) + a->total;
    a->total = next;
    a->equal = a->equal && m == a->mass[0];
  }
  a->total += rest;
  if (a->total > 0.0 && isfinite(a->total)) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_ARG, "the masses m%s have the total %g", a->name, a->total);
}

static sph_status check_totals(sph_context *ctx, const measure *a, const measure *b) {
  const double larger = fmax(a->total, b->total);
  if (!a->mass || !b->mass || fabs(a->total - b->total) <= 1e-10 * larger) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_ARG, "the total masses %.17g and %.17g differ", a->total, b->total);
}

/* ---- whole units ------------------------------------------------------------------------- */

static int64_t common_divisor(int64_t a, int64_t b) {
  while (b != 0) {
    const int64_t rest = a % b;
    a = b;
    b = rest;
  }
  return a;
}

#define UNITS 0x1p50 /* in all, where masses are of different size */

/* Shares of the total by rounding the running sum: none errs by more than a unit, nor does any sum
 * of consecutive ones. `whole` > 0: all masses are so many units. */
static void count_units(const measure *a, int64_t whole, int64_t *units) {
  double sum = 0.0, rest = 0.0;
  int64_t before = 0;
  for (int64_t k = 0; k < a->n; ++k) {
    if (whole > 0) {
      units[k] = whole;
      continue;
    }
    const double m = a->mass ? a->mass[k] : 1.0, next = sum + m;
    rest += sum >= m ? (sum - next) + m : (m - next) + sum;
    sum = next;
    const double share = k + 1 < a->n ? fmin((sum + rest) / a->total, 1.0) : 1.0;
    const int64_t upto = llround(share * UNITS);
    units[k] = upto > before ? upto - before : 0;
    before += units[k];
  }
}

/* ---- order ------------------------------------------------------------------------------- */

typedef struct box {
  double lo[3], scale;
} box;

static sph_status find_box(sph_context *ctx, int32_t dim, const measure *a, const measure *b,
                           box *out) {
  out->scale = 0.0;
  for (int32_t d = 0; d < dim; ++d) {
    double lo = a->x[d], hi = a->x[d];
    for (int64_t i = 0; i < a->n + b->n; ++i) {
      const double x = i < a->n ? a->x[i * dim + d] : b->x[(i - a->n) * dim + d];
      lo = fmin(lo, x);
      hi = fmax(hi, x);
    }
    out->lo[d] = lo;
    out->scale = fmax(out->scale, hi - lo);
  }
  if (isfinite(out->scale)) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_NUMERIC, "the distance between the outermost points overflows");
}

static double scaled(const box *b, const double *x, int32_t d) {
  return b->scale > 0.0 ? (x[d] - b->lo[d]) / b->scale : 0.0;
}

/* On a line the coordinate itself, whose bits are in order for positive numbers; else the bits of
 * the coordinates in turn, the curve of Morton. */
static uint64_t key_of(const box *b, const double *x, int32_t dim) {
  uint64_t key = 0;
  if (dim == 1) {
    const double s = scaled(b, x, 0) + 0.0;
    memcpy(&key, &s, sizeof key);
    return key;
  }
  uint64_t cell[3];
  for (int32_t d = 0; d < dim; ++d) cell[d] = (uint64_t)(scaled(b, x, d) * 0xfffff);
  for (int bit = 19; bit >= 0; --bit)
    for (int32_t d = 0; d < dim; ++d) key = key << 1 | (cell[d] >> bit & 1);
  return key;
}

/* Radix sort of (key, index) pairs by the key, a byte at a time; stable. An even number of passes
 * leaves the result where it was. */
static void sort_pairs(int64_t n, uint64_t *pairs, uint64_t *spare) {
  for (int shift = 0; shift < 64; shift += 8) {
    int64_t start[257] = {0};
    for (int64_t i = 0; i < n; ++i) ++start[(pairs[2 * i] >> shift & 255) + 1];
    for (int k = 0; k < 256; ++k) start[k + 1] += start[k];
    for (int64_t i = 0; i < n; ++i) {
      const int64_t to = start[pairs[2 * i] >> shift & 255]++;
      spare[2 * to] = pairs[2 * i];
      spare[2 * to + 1] = pairs[2 * i + 1];
    }
    uint64_t *swap = pairs;
    pairs = spare;
    spare = swap;
  }
}

/* Points and units in order, without those of no unit. */
static void arrange(measure *a, int32_t dim, const box *b, int64_t whole) {
  uint64_t *pairs = a->order, *spare = a->order + 2 * a->n;
  for (int64_t i = 0; i < a->n; ++i) {
    pairs[2 * i] = key_of(b, a->x + i * dim, dim);
    pairs[2 * i + 1] = (uint64_t)i;
  }
  sort_pairs(a->n, pairs, spare);
  int64_t *units = (int64_t *)spare;
  count_units(a, whole, units);
  for (int64_t k = 0; k < a->n; ++k) {
    const int64_t i = (int64_t)pairs[2 * k + 1];
    if (units[i] == 0) continue;
    for (int32_t d = 0; d < dim; ++d) a->at[a->kept * dim + d] = scaled(b, a->x + i * dim, d);
    a->units[a->kept++] = units[i];
  }
}

/* ---- the line ---------------------------------------------------------------------------- */

/* The integral of |F_a - F_b| over points in order, in units. */
static double line_cost(const measure *a, const measure *b) {
  double sum = 0.0, rest = 0.0, last = 0.0;
  int64_t i = 0, j = 0, ahead = 0;
  while (i < a->kept || j < b->kept) {
    const int first = j == b->kept || (i < a->kept && a->at[i] <= b->at[j]);
    const double x = first ? a->at[i] : b->at[j];
    const double term = fabs((double)ahead) * (x - last), next = sum + term;
    rest += sum >= term ? (sum - next) + term : (term - next) + sum;
    sum = next;
    last = x;
    ahead += first ? a->units[i++] : -b->units[j++];
  }
  return sum + rest;
}

/* ---- both together ----------------------------------------------------------------------- */

static sph_status take(sph_context *ctx, measure *a, int32_t dim) {
  const size_t n = (size_t)a->n;
  a->at = sphi_alloc(ctx, sphi_mul(n * (size_t)dim, sizeof *a->at));
  if (a->at) a->units = sphi_alloc(ctx, sphi_mul(n, sizeof *a->units));
  if (a->units) a->order = sphi_alloc(ctx, sphi_mul(4 * n, sizeof *a->order));
  return a->order ? SPH_OK : SPH_ERR_NOMEM;
}

static void give_order(sph_context *ctx, measure *a) {
  sphi_free(ctx, a->order, sphi_mul(4 * (size_t)a->n, sizeof *a->order));
  a->order = NULL;
}

static void give(sph_context *ctx, measure *a, int32_t dim) {
  const size_t n = (size_t)a->n;
  give_order(ctx, a);
  sphi_free(ctx, a->units, sphi_mul(n, sizeof *a->units));
  sphi_free(ctx, a->at, sphi_mul(n * (size_t)dim, sizeof *a->at));
}

static sph_status work(sph_context *ctx, int32_t dim, measure *a, measure *b, const box *frame,
                       double *distance) {
  const int equal = a->equal && b->equal;
  const int64_t divisor = common_divisor(a->n, b->n);
  const double total = equal ? (double)(a->n / divisor) * (double)b->n : UNITS;
  double cost = 0.0;
  arrange(a, dim, frame, equal ? b->n / divisor : 0);
  arrange(b, dim, frame, equal ? a->n / divisor : 0);
  give_order(ctx, a);
  give_order(ctx, b);
  if (dim == 1) {
    cost = line_cost(a, b);
  } else {
    const sphi_masses from = {a->kept, a->at, a->units}, to = {b->kept, b->at, b->units};
    const sph_status s = sphi_transport(ctx, dim, &from, &to, &cost);
    if (s != SPH_OK) return s;
  }
  *distance = cost / total * frame->scale;
  return SPH_OK;
}

sph_status sph_wasserstein_distance(sph_context *ctx, int32_t dim, int64_t nx, const double *x,
                                    const double *mx, int64_t ny, const double *y, const double *my,
                                    double *distance) {
  measure a = {.name = "x", .n = nx, .x = x, .mass = mx};
  measure b = {.name = "y", .n = ny, .x = y, .mass = my};
  box frame;
  sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (s != SPH_OK) return s;
  if (dim < 1 || dim > 3) return sphi_fail(ctx, SPH_ERR_ARG, "dim = %d is outside 1..3", (int)dim);
  if (!distance) return sphi_fail(ctx, SPH_ERR_ARG, "distance is NULL");
  s = check_points(ctx, &a, dim);
  if (s == SPH_OK) s = check_points(ctx, &b, dim);
  if (s == SPH_OK) s = check_masses(ctx, &a);
  if (s == SPH_OK) s = check_masses(ctx, &b);
  if (s == SPH_OK) s = check_totals(ctx, &a, &b);
  if (s == SPH_OK) s = find_box(ctx, dim, &a, &b, &frame);
  if (s != SPH_OK) return s;
  s = take(ctx, &a, dim);
  if (s == SPH_OK) s = take(ctx, &b, dim);
  if (s == SPH_OK) s = work(ctx, dim, &a, &b, &frame, distance);
  give(ctx, &a, dim);
  give(ctx, &b, dim);
  return s;
}
