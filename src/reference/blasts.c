/* Exact solutions with radial symmetry: the implosion of Noh, the blast of Sedov, and the vortex of
 * Gresho, which stands still. */
#include "reference_impl.h"

#include <math.h>

/* ---- arguments --------------------------------------------------------------------------- */

static sph_status positive(sph_context *ctx, const char *what, double value) {
  if (value > 0.0 && isfinite(value)) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_ARG, "%s = %g must be positive and finite", what, value);
}

static sph_status check_gas(sph_context *ctx, int32_t dim, double gamma, double density) {
  if (dim < 1 || dim > 3) return sphi_fail(ctx, SPH_ERR_ARG, "dim = %d is outside 1..3", (int)dim);
  if (!(gamma > 1.0) || !isfinite(gamma))
    return sphi_fail(ctx, SPH_ERR_ARG, "gamma = %g must be finite and above 1", gamma);
  return positive(ctx, "density", density);
}

static sph_status check_radii(sph_context *ctx, int64_t n, const double *r) {
  if (n < 0) return sphi_fail(ctx, SPH_ERR_ARG, "n = %lld is negative", (long long)n);
  if (n > 0 && !r) return sphi_fail(ctx, SPH_ERR_ARG, "r is NULL");
  for (int64_t i = 0; i < n; ++i)
    if (!(r[i] >= 0.0) || !isfinite(r[i]))
      return sphi_fail(ctx, SPH_ERR_ARG, "r[%lld] = %g is negative or not finite", (long long)i,
                       r[i]);
  return SPH_OK;
}

typedef struct gas_state {
  double rho, v, p, e;
} gas_state;

typedef struct outputs {
  double *rho, *v, *p, *e;
} outputs;

static void store(const outputs *out, int64_t i, const gas_state *s) {
  if (out->rho) out->rho[i] = s->rho;
  if (out->v) out->v[i] = s->v;
  if (out->p) out->p[i] = s->p;
  if (out->e) out->e[i] = s->e;
}

/* ---- Noh --------------------------------------------------------------------------------- */

static const sph_noh_options noh_defaults = {.gamma = 5.0 / 3.0, .density = 1.0, .speed = 1.0};

void sph_noh_options_init_sized(sph_noh_options *options, size_t size) {
  sphi_options_init(options, size, &noh_defaults, sizeof noh_defaults);
}

static gas_state noh_at(const sph_noh_options *o, double t, double r) {
  if (r < 0.5 * (o->gamma - 1.0) * o->speed * t) {
    const double rho = o->density * pow((o->gamma + 1.0) / (o->gamma - 1.0), o->dim);
    const double e = 0.5 * o->speed * o->speed;
    return (gas_state){rho, 0.0, (o->gamma - 1.0) * rho * e, e};
  }
  if (r == 0.0) return (gas_state){.rho = o->density}; /* t = 0 */
  return (gas_state){.rho = o->density * pow(1.0 + o->speed * t / r, o->dim - 1), .v = -o->speed};
}

sph_status sph_noh_solution(sph_context *ctx, const sph_noh_options *options, double t, int64_t n,
                            const double *r, double *rho, double *v, double *p, double *e) {
  sph_noh_options o = noh_defaults;
  const outputs out = {rho, v, p, e};
  sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (s != SPH_OK) return s;
  if (!options) return sphi_fail(ctx, SPH_ERR_ARG, "options is NULL");
  s = sphi_options_read(ctx, &o, sizeof o, options);
  if (s == SPH_OK) s = check_gas(ctx, o.dim, o.gamma, o.density);
  if (s == SPH_OK) s = positive(ctx, "speed", o.speed);
  if (s == SPH_OK && (!(t >= 0.0) || !isfinite(t)))
    s = sphi_fail(ctx, SPH_ERR_ARG, "t = %g is negative or not finite", t);
  if (s == SPH_OK) s = check_radii(ctx, n, r);
  if (s != SPH_OK) return s;
  for (int64_t i = 0; i < n; ++i) {
    const gas_state state = noh_at(&o, t, r[i]);
    store(&out, i, &state);
  }
  return SPH_OK;
}

/* ---- Sedov ------------------------------------------------------------------------------- */

static const sph_sedov_options sedov_defaults = {.gamma = 1.4, .density = 1.0, .energy = 1.0};

void sph_sedov_options_init_sized(sph_sedov_options *options, size_t size) {
  sphi_options_init(options, size, &sedov_defaults, sizeof sedov_defaults);
}

/* The exponents of Kamm and Timmes for a uniform density (omega = 0), with a_5 of x_4. */
typedef struct profile {
  double dim, gamma, a0, a1, a2, a3, a4, a5;
} profile;

static profile profile_of(double dim, double gamma) {
  profile s = {.dim = dim, .gamma = gamma};
  const double j2 = dim + 2.0, w = 2.0 * (gamma - 1.0) + dim;
  s.a0 = 2.0 / j2;
  s.a2 = -(gamma - 1.0) / w;
  s.a1 = j2 * gamma / (2.0 + dim * (gamma - 1.0)) *
         (2.0 * dim * (2.0 - gamma) / (gamma * j2 * j2) - s.a2);
  s.a3 = dim / w;
  s.a4 = j2 / (2.0 - gamma) * s.a1;
  s.a5 = -2.0 / (2.0 - gamma);
  return s;
}

/* The profile by the parameter x_2, 0 at the centre and 1 at the shock, all others linear in it.
 * r/R, v, rho, p are in units of what they are at the shock. */
typedef struct point {
  double log_radius, slope; /* slope: d ln(r/R)/d ln x_2 */
  double v, rho, p;
} point;

static point point_at(const profile *s, double log_x2) {
  const double j2 = s->dim + 2.0, gamma = s->gamma, b = (gamma + 1.0) / (gamma - 1.0);
  const double x2 = exp(log_x2), c = 0.5 * j2 * gamma, value = (1.0 + x2 / b) / c;
  const double x1 = 0.25 * j2 * (gamma + 1.0) * value;
  const double width = 2.0 + s->dim * (gamma - 1.0), full = j2 * (gamma + 1.0);
  const double d = full / (full - 2.0 * width);
  const double x3 = d * (1.0 - 0.5 * width * value), x4 = b * (1.0 - c * value / gamma);
  const double dvalue = x2 / (b * c); /* d value/d ln x_2 */
  point at;
  at.log_radius = -s->a0 * log(x1) - s->a2 * log_x2 - s->a1 * log(x3);
  at.slope = -s->a0 * dvalue / value - s->a2 + s->a1 * d * 0.5 * width * dvalue / x3;
  at.v = x1 * exp(at.log_radius);
  at.rho = exp(s->a3 * log_x2 + s->a4 * log(x3) + s->a5 * log(x4));
  at.p = exp(s->a0 * s->dim * log(x1) + (s->a4 - 2.0 * s->a1) * log(x3) + (1.0 + s->a5) * log(x4));
  return at;
}

/* Energy within the blast for R = t = rho_0 = 1, by double exponential quadrature over q with
 * x_2 = q^(1/k): then r^dim grows as q at the centre, and the integrand is bounded there.
 * H. Takahasi, M. Mori, Publ. RIMS 9 (1974) 721-741. */
static double blast_energy(const profile *s) {
  const double area[] = {0.0, 2.0, 6.283185307179586477, 12.566370614359172954};
  const double jump = 4.0 / ((s->dim + 2.0) * (s->gamma + 1.0)), k = -s->dim * s->a2; /* v_2 */
  const double step = 0x1p-6;
  double sum = 0.0;
  for (int i = -256; i <= 256; ++i) {
    const double u = i * step, g = 1.5707963267948966192 * sinh(u);
    /* q = 1/(1 + exp(-2 g)), and dq/du without cancellation */
    const double log_q = -log1p(exp(-2.0 * g)), cosh_g = cosh(g);
    const double weight = 0.5 * 1.5707963267948966192 * cosh(u) / (cosh_g * cosh_g);
    if (!(weight > 0.0)) continue;
    const point at = point_at(s, log_q / k);
    const double rho2 = (s->gamma + 1.0) / (s->gamma - 1.0);
    const double p2 = 2.0 * 4.0 / ((s->dim + 2.0) * (s->dim + 2.0)) / (s->gamma + 1.0);
    const double density =
        0.5 * rho2 * at.rho * jump * jump * at.v * at.v + p2 * at.p / (s->gamma - 1.0);
    /* r^(dim - 1) dr = r^dim d ln r */
    sum += weight * density * exp(s->dim * at.log_radius - log_q) * at.slope / k;
  }
  return area[(int)s->dim] * sum * step;
}

typedef struct wanted {
  const profile *s;
  double log_radius;
} wanted;

static double radius_miss(const void *user, double log_x2) {
  const wanted *w = user;
  return point_at(w->s, log_x2).log_radius - w->log_radius;
}

/* ln x_2 at a radius within the shock: near the centre ln(r/R) is linear in it, above everywhere
 * between that line less a constant and the line itself. */
static point point_of_radius(const profile *s, double log_radius) {
  const wanted w = {s, log_radius};
  double lo = log_radius / -s->a2 - 1.0;
  while (radius_miss(&w, lo) > 0.0) lo *= 2.0;
  return point_at(s, sphi_root(radius_miss, &w, lo, 0.0));
}

typedef struct blast {
  profile s;
  double density, radius, speed; /* of the shock */
} blast;

static gas_state sedov_at(const blast *b, double r) {
  const double gamma = b->s.gamma;
  if (r >= b->radius) return (gas_state){.rho = b->density};
  const point at = r > 0.0 ? point_of_radius(&b->s, log(r / b->radius)) : point_at(&b->s, -1e300);
  gas_state out = {.rho = b->density * (gamma + 1.0) / (gamma - 1.0) * at.rho,
                   .v = 2.0 / (gamma + 1.0) * b->speed * at.v,
                   .p = 2.0 / (gamma + 1.0) * b->density * b->speed * b->speed * at.p};
  out.e = out.p / out.rho / (gamma - 1.0);
  return out;
}

static sph_status check_sedov(sph_context *ctx, const sph_sedov_options *o, double t) {
  sph_status s = check_gas(ctx, o->dim, o->gamma, o->density);
  if (s == SPH_OK) s = positive(ctx, "energy", o->energy);
  if (s == SPH_OK) s = positive(ctx, "t", t);
  if (s != SPH_OK) return s;
  if (fabs(o->gamma - 2.0) < 1e-6)
    return sphi_fail(ctx, SPH_ERR_UNSUPPORTED, "gamma = %.9g: the closed form is singular at 2",
                     o->gamma);
  if (o->dim == 3 && o->gamma >= 7.0)
    return sphi_fail(ctx, SPH_ERR_UNSUPPORTED, "gamma = %g: a hollow forms from 7 on", o->gamma);
  return SPH_OK;
}

sph_status sph_sedov_solution(sph_context *ctx, const sph_sedov_options *options, double t,
                              int64_t n, const double *r, double *radius, double *rho, double *v,
                              double *p, double *e) {
  sph_sedov_options o = sedov_defaults;
  const outputs out = {rho, v, p, e};
  sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (s != SPH_OK) return s;
  if (!options) return sphi_fail(ctx, SPH_ERR_ARG, "options is NULL");
  s = sphi_options_read(ctx, &o, sizeof o, options);
  if (s == SPH_OK) s = check_sedov(ctx, &o, t);
  if (s == SPH_OK) s = check_radii(ctx, n, r);
  if (s != SPH_OK) return s;
  blast b = {.s = profile_of(o.dim, o.gamma), .density = o.density};
  b.radius = pow(o.energy / o.density * t * t / blast_energy(&b.s), 1.0 / (o.dim + 2));
  b.speed = 2.0 * b.radius / ((o.dim + 2) * t);
  if (!(b.radius > 0.0) || !isfinite(b.radius) || !isfinite(b.speed))
    return sphi_fail(ctx, SPH_ERR_NUMERIC, "the radius %g of the blast overflows", b.radius);
  if (radius) *radius = b.radius;
  for (int64_t i = 0; i < n; ++i) {
    const gas_state state = sedov_at(&b, r[i]);
    store(&out, i, &state);
  }
  return SPH_OK;
}

/* ---- Gresho ------------------------------------------------------------------------------ */

static const sph_gresho_options gresho_defaults = {
    .density = 1.0, .speed = 1.0, .radius = 0.2, .pressure = 5.0};

void sph_gresho_options_init_sized(sph_gresho_options *options, size_t size) {
  sphi_options_init(options, size, &gresho_defaults, sizeof gresho_defaults);
}

static gas_state gresho_at(const sph_gresho_options *o, double r) {
  const double s = r / o->radius, scale = o->density * o->speed * o->speed;
  gas_state at = {.p = o->pressure};
  if (s <= 1.0) {
    at.v = o->speed * s;
    at.p += scale * 0.5 * s * s;
  } else if (s <= 2.0) {
    at.v = o->speed * (2.0 - s);
    at.p += scale * (0.5 * s * s - 4.0 * s + 4.0 * log(s) + 4.0);
  } else {
    at.p += scale * (4.0 * 0.69314718055994530942 - 2.0);
  }
  return at;
}

static sph_status check_gresho(sph_context *ctx, const sph_gresho_options *o) {
  sph_status s = positive(ctx, "density", o->density);
  if (s == SPH_OK) s = positive(ctx, "speed", o->speed);
  if (s == SPH_OK) s = positive(ctx, "radius", o->radius);
  if (s != SPH_OK || (o->pressure >= 0.0 && isfinite(o->pressure))) return s;
  return sphi_fail(ctx, SPH_ERR_ARG, "pressure = %g is negative or not finite", o->pressure);
}

sph_status sph_gresho_solution(sph_context *ctx, const sph_gresho_options *options, int64_t n,
                               const double *r, double *v, double *p) {
  sph_gresho_options o = gresho_defaults;
  const outputs out = {NULL, v, p, NULL};
  sph_status s = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (s != SPH_OK) return s;
  s = sphi_options_read(ctx, &o, sizeof o, options);
  if (s == SPH_OK) s = check_gresho(ctx, &o);
  if (s == SPH_OK) s = check_radii(ctx, n, r);
  if (s != SPH_OK) return s;
  for (int64_t i = 0; i < n; ++i) {
    const gas_state state = gresho_at(&o, r[i]);
    store(&out, i, &state);
  }
  return SPH_OK;
}
