/* Built-in profiles. Every w is written exactly as in sph/kernel.h; the constants beside it make
 * alpha_d * integral of w(|q|) over d-dimensional space equal to 1.
 *
 * Constants of the polynomial kernels are exact (rational, over pi for d > 1). Variances are
 * sigma^2 = (1/d) int |q|^2 W, so that a smoothed field is f + (sigma^2 / 2) lap f + O(h^4). */
#include "profile.h"

#include <math.h>

#define SPHI_PI 3.14159265358979323846
#define SPHI_GAUSSIAN_CUT 3.0

/* ---- constants -------------------------------------------------------------------------- */

typedef struct family {
  const char *name;
  double support;
  double alpha[3];
  double variance[3];
} family;

/* Indexed by SPH_KERNEL_*. The two Gaussians depend on where they are cut: gaussian_constants().
 *
 * Mollifier: alpha and variance by tanh-sinh quadrature in 113-bit arithmetic, two step widths
 * agreeing to 25 digits. (Zisis 2017, 2.4, prints 4.826 and 5.08 for d = 2, 3: wrong by 2.25 and
 * 2.24; his 2.2523 for d = 1 is right.) */
static const family families[] = {
    [SPH_KERNEL_CUBIC_SPLINE] = {"cubic_spline",
                                 2.0,
                                 {1.0, 15.0 / (7.0 * SPHI_PI), 3.0 / (2.0 * SPHI_PI)},
                                 {1.0 / 3.0, 31.0 / 98.0, 3.0 / 10.0}},
    [SPH_KERNEL_QUARTIC_SPLINE] = {"quartic_spline",
                                   2.5,
                                   {1.0 / 24.0, 96.0 / (1199.0 * SPHI_PI), 1.0 / (20.0 * SPHI_PI)},
                                   {5.0 / 12.0, 9759.0 / 24416.0, 23.0 / 60.0}},
    [SPH_KERNEL_QUINTIC_SPLINE] = {"quintic_spline",
                                   3.0,
                                   {1.0 / 120.0, 7.0 / (478.0 * SPHI_PI), 1.0 / (120.0 * SPHI_PI)},
                                   {1.0 / 2.0, 2771.0 / 5736.0, 7.0 / 15.0}},
    [SPH_KERNEL_QUADRATIC] = {"quadratic",
                              1.0,
                              {3.0 / 4.0, 2.0 / SPHI_PI, 15.0 / (8.0 * SPHI_PI)},
                              {1.0 / 5.0, 1.0 / 6.0, 1.0 / 7.0}},
    [SPH_KERNEL_JOHNSON] = {"johnson",
                            2.0,
                            {1.0, 2.0 / SPHI_PI, 5.0 / (4.0 * SPHI_PI)},
                            {2.0 / 5.0, 2.0 / 5.0, 8.0 / 21.0}},
    [SPH_KERNEL_LUCY] = {"lucy",
                         1.0,
                         {5.0 / 4.0, 5.0 / SPHI_PI, 105.0 / (16.0 * SPHI_PI)},
                         {2.0 / 21.0, 5.0 / 56.0, 1.0 / 12.0}},
    [SPH_KERNEL_NEW_QUARTIC] = {"new_quartic",
                                2.0,
                                {1.0, 15.0 / (7.0 * SPHI_PI), 315.0 / (208.0 * SPHI_PI)},
                                {104.0 / 315.0, 15.0 / 49.0, 11.0 / 39.0}},
    [SPH_KERNEL_GAUSSIAN] = {"gaussian", SPHI_GAUSSIAN_CUT, {0, 0, 0}, {0, 0, 0}},
    [SPH_KERNEL_SUPER_GAUSSIAN] = {"super_gaussian", SPHI_GAUSSIAN_CUT, {0, 0, 0}, {0, 0, 0}},
    [SPH_KERNEL_WENDLAND_C2] = {"wendland_c2",
                                2.0,
                                {5.0 / 8.0, 7.0 / (4.0 * SPHI_PI), 21.0 / (16.0 * SPHI_PI)},
                                {8.0 / 21.0, 5.0 / 18.0, 4.0 / 15.0}},
    [SPH_KERNEL_WENDLAND_C4] = {"wendland_c4",
                                2.0,
                                {3.0 / 4.0, 9.0 / (4.0 * SPHI_PI), 495.0 / (256.0 * SPHI_PI)},
                                {4.0 / 15.0, 7.0 / 33.0, 8.0 / 39.0}},
    [SPH_KERNEL_WENDLAND_C6] = {"wendland_c6",
                                2.0,
                                {55.0 / 64.0, 39.0 / (14.0 * SPHI_PI), 1365.0 / (512.0 * SPHI_PI)},
                                {8.0 / 39.0, 6.0 / 35.0, 1.0 / 6.0}},
    [SPH_KERNEL_MOLLIFIER] = {"mollifier",
                              1.0,
                              {2.252283621043581010, 2.143565775792236601, 2.267116739608326458},
                              {0.158113636263798230, 0.130655601710279323, 0.111695653990867304}},
};

/* Both Gaussians are cut at R = 3 and renormalised. With J_k = int_0^R q^k exp(-q^2) dq and the
 * recurrence J_{k+2} = (k+1)/2 J_k - R^{k+1} exp(-R^2)/2,
 *   Gaussian:       integral S_d J_{d-1},        sigma^2 = 1/2 - R^d exp(-R^2) / (2 d J_{d-1});
 *   super-Gaussian: integral S_d (J_{d-1} + c),  sigma^2 = R^2 c / (d (J_{d-1} + c)),
 *                   c = R^d exp(-R^2) / 2,
 * S_d = 2, 2 pi, 4 pi. Uncut, the super-Gaussian has no second moment: it is of fourth order. */
static void gaussian_constants(int32_t dim, int super, double *alpha, double *variance) {
  const double r = SPHI_GAUSSIAN_CUT;
  const double e = exp(-r * r);
  const double first = 0.5 * sqrt(SPHI_PI) * erf(r);
  const double j[3] = {first, 0.5 * (1.0 - e), 0.5 * (first - r * e)};
  const double sphere[3] = {2.0, 2.0 * SPHI_PI, 4.0 * SPHI_PI};
  const double c = 0.5 * pow(r, dim) * e;
  const double radial = j[dim - 1] + (super ? c : 0.0);
  *alpha = 1.0 / (sphere[dim - 1] * radial);
  *variance = super ? r * r * c / (dim * radial) : 0.5 - c / (dim * radial);
}

int sphi_kernel_lookup(int32_t type, int32_t dim, sphi_kernel_constants *out) {
  const int32_t count = (int32_t)(sizeof families / sizeof families[0]);
  if (type < 1 || type >= count || dim < 1 || dim > 3) return 0;
  const family *f = &families[type];
  out->name = f->name;
  out->support = f->support;
  out->alpha = f->alpha[dim - 1];
  out->variance = f->variance[dim - 1];
  if (type == SPH_KERNEL_GAUSSIAN || type == SPH_KERNEL_SUPER_GAUSSIAN)
    gaussian_constants(dim, type == SPH_KERNEL_SUPER_GAUSSIAN, &out->alpha, &out->variance);
  return 1;
}

/* ---- profiles, each valid for 0 <= q < support ------------------------------------------- */

static inline sphi_profile cubic_spline(double q) {
  if (q < 1.0)
    return (sphi_profile){2.0 / 3.0 - q * q * (1.0 - 0.5 * q), q * (1.5 * q - 2.0), 3.0 * q - 2.0};
  const double a = 2.0 - q;
  return (sphi_profile){a * a * a / 6.0, -0.5 * a * a, a};
}

/* Sun 2013 (6.1.7), whose first branch misplaces signs: printed, it integrates to 65/96. */
static inline sphi_profile quartic_spline(double q) {
  if (q < 0.5) /* multiplied out: the powers would cancel to O(q) in w' */
    return (sphi_profile){14.375 + q * q * (6.0 * q * q - 15.0), q * (24.0 * q * q - 30.0),
                          72.0 * q * q - 30.0};
  const double a = 2.5 - q;
  const double b = q < 1.5 ? 1.5 - q : 0.0;
  const double a2 = a * a, b2 = b * b;
  return (sphi_profile){a2 * a2 - 5.0 * b2 * b2, -4.0 * a2 * a + 20.0 * b2 * b,
                        12.0 * a2 - 60.0 * b2};
}

static inline sphi_profile quintic_spline(double q) {
  const double s = q * q;
  if (q < 1.0) /* multiplied out, as above */
    return (sphi_profile){66.0 + s * (s * (30.0 - 10.0 * q) - 60.0),
                          q * (s * (120.0 - 50.0 * q) - 120.0), s * (360.0 - 200.0 * q) - 120.0};
  const double a = 3.0 - q;
  const double b = q < 2.0 ? 2.0 - q : 0.0;
  const double a2 = a * a, b2 = b * b;
  return (sphi_profile){a2 * a2 * a - 6.0 * b2 * b2 * b, -5.0 * a2 * a2 + 30.0 * b2 * b2,
                        20.0 * a2 * a - 120.0 * b2 * b};
}

static inline sphi_profile quadratic(double q) {
  return (sphi_profile){(1.0 - q) * (1.0 + q), -2.0 * q, -2.0};
}

/* (3/16)(2 - q)^2: the slope at 0 is -3/4, so the gradient is discontinuous there. */
static inline sphi_profile johnson(double q) {
  const double a = 2.0 - q;
  return (sphi_profile){0.1875 * a * a, -0.375 * a, 0.375};
}

static inline sphi_profile lucy(double q) {
  const double a = 1.0 - q;
  return (sphi_profile){(1.0 + 3.0 * q) * a * a * a, -12.0 * q * a * a,
                        -12.0 * a * (1.0 - 3.0 * q)};
}

/* 2/3 - 9q^2/8 + 19q^3/24 - 5q^4/32 = -(q - 2)^2 (15q^2 - 16q - 16) / 96: the factors keep the
 * sign right near the edge, where it is negative. */
static inline sphi_profile new_quartic(double q) {
  const double a = 2.0 - q;
  return (sphi_profile){a * a * (16.0 + q * (16.0 - 15.0 * q)) / 96.0,
                        q * (-2.25 + q * (2.375 - 0.625 * q)), -2.25 + q * (4.75 - 1.875 * q)};
}

static inline sphi_profile gaussian(double q) {
  const double e = exp(-q * q);
  return (sphi_profile){e, -2.0 * q * e, (4.0 * q * q - 2.0) * e};
}

/* With k = 1 + d/2: w = (k - q^2) e, w' = -2q (k + 1 - q^2) e. Sun 2013 (6.1.5) prints the 1-D
 * polynomial 3/2 - q^2 only, whose 3-D integral is zero. */
static inline sphi_profile super_gaussian(double q, int32_t dim) {
  const double k = 1.0 + 0.5 * dim;
  const double s = q * q;
  const double e = exp(-s);
  return (sphi_profile){(k - s) * e, -2.0 * q * (k + 1.0 - s) * e,
                        (-2.0 * (k + 1.0) + s * (4.0 * k + 10.0 - 4.0 * s)) * e};
}

/* Wendland functions, u = q/2; the index follows l = floor(d/2) + k + 1, so that 1-D has its own
 * family. Derivatives are taken in u first: d/dq = (1/2) d/du. */
static inline sphi_profile wendland_c2(double q, int32_t dim) {
  const double a = 1.0 - 0.5 * q;
  if (dim == 1)
    return (sphi_profile){a * a * a * (1.0 + 1.5 * q), -3.0 * q * a * a, 3.0 * a * (1.5 * q - 1.0)};
  const double a3 = a * a * a;
  return (sphi_profile){a3 * a * (1.0 + 2.0 * q), -5.0 * q * a3, -5.0 * a * a * (1.0 - 2.0 * q)};
}

static inline sphi_profile wendland_c4(double q, int32_t dim) {
  const double u = 0.5 * q, a = 1.0 - u;
  const double a2 = a * a, a4 = a2 * a2;
  if (dim == 1) /* (1-u)^5 (1+5u+8u^2); d/du = -14 u (1-u)^4 (1+4u) */
    return (sphi_profile){a4 * a * (1.0 + u * (5.0 + 8.0 * u)), -7.0 * u * a4 * (1.0 + 4.0 * u),
                          -3.5 * a2 * a * (1.0 + u * (3.0 - 24.0 * u))};
  /* (1-u)^6 (1+6u+35u^2/3); d/du = -(56/3) u (1-u)^5 (1+5u) */
  return (sphi_profile){a4 * a2 * (1.0 + u * (6.0 + 35.0 / 3.0 * u)),
                        -28.0 / 3.0 * u * a4 * a * (1.0 + 5.0 * u),
                        -14.0 / 3.0 * a4 * (1.0 + u * (4.0 - 35.0 * u))};
}

static inline sphi_profile wendland_c6(double q, int32_t dim) {
  const double u = 0.5 * q, a = 1.0 - u;
  const double a2 = a * a, a4 = a2 * a2;
  if (dim == 1) /* (1-u)^7 (1+7u+19u^2+21u^3); d/du = -6 u (1-u)^6 (3+18u+35u^2) */
    return (sphi_profile){a4 * a2 * a * (1.0 + u * (7.0 + u * (19.0 + 21.0 * u))),
                          -3.0 * u * a4 * a2 * (3.0 + u * (18.0 + 35.0 * u)),
                          -4.5 * a4 * a * (1.0 + u * (5.0 + u * (-13.0 - 105.0 * u)))};
  /* (1-u)^8 (1+8u+25u^2+32u^3); d/du = -22 u (1-u)^7 (1+7u+16u^2) */
  return (sphi_profile){a4 * a4 * (1.0 + u * (8.0 + u * (25.0 + 32.0 * u))),
                        -11.0 * u * a4 * a2 * a * (1.0 + u * (7.0 + 16.0 * u)),
                        -5.5 * a4 * a2 * (1.0 + u * (6.0 + u * (-15.0 - 160.0 * u)))};
}

/* w = exp(1/(q^2-1)); with p = 1/(q^2-1): w' = -2q p^2 w, w'' = p^2 (4q^2 p^2 + 8q^2 p - 2) w.
 * All vanish at the edge faster than any power; below exp(-700) they are 0, where p^4 w would
 * otherwise meet 0 * infinity. */
static inline sphi_profile mollifier(double q) {
  const double p = -1.0 / ((1.0 - q) * (1.0 + q));
  if (!(p > -700.0)) return (sphi_profile){0.0, 0.0, 0.0};
  const double w = exp(p);
  const double s = q * q;
  return (sphi_profile){w, -2.0 * q * p * p * w, p * p * (4.0 * s * p * (p + 2.0) - 2.0) * w};
}

/* ---- dispatch ---------------------------------------------------------------------------- */

static inline sphi_profile builtin(int32_t type, int32_t dim, double q) {
  switch (type) {
  case SPH_KERNEL_CUBIC_SPLINE:
    return cubic_spline(q);
  case SPH_KERNEL_QUARTIC_SPLINE:
    return quartic_spline(q);
  case SPH_KERNEL_QUINTIC_SPLINE:
    return quintic_spline(q);
  case SPH_KERNEL_QUADRATIC:
    return quadratic(q);
  case SPH_KERNEL_JOHNSON:
    return johnson(q);
  case SPH_KERNEL_LUCY:
    return lucy(q);
  case SPH_KERNEL_NEW_QUARTIC:
    return new_quartic(q);
  case SPH_KERNEL_GAUSSIAN:
    return gaussian(q);
  case SPH_KERNEL_SUPER_GAUSSIAN:
    return super_gaussian(q, dim);
  case SPH_KERNEL_WENDLAND_C2:
    return wendland_c2(q, dim);
  case SPH_KERNEL_WENDLAND_C4:
    return wendland_c4(q, dim);
  case SPH_KERNEL_WENDLAND_C6:
    return wendland_c6(q, dim);
  case SPH_KERNEL_MOLLIFIER:
    return mollifier(q);
  default:
    return (sphi_profile){0.0, 0.0, 0.0};
  }
}

void sphi_kernel_profile(const struct sph_kernel *kernel, double q, double *w, double *dw) {
  *w = 0.0;
  *dw = 0.0;
  if (!(q < kernel->support)) return;
  if (kernel->type == 0) {
    kernel->fn(kernel->user, q, w, dw);
    return;
  }
  const sphi_profile p = builtin(kernel->type, kernel->dim, q);
  *w = p.w;
  *dw = p.dw;
}

/* Second derivative of a callback by a central difference of its dw. The points stay inside
 * (0, support), so neither a cusp at 0 nor a cut at the edge enters. */
static sphi_profile callback_profile(const struct sph_kernel *kernel, double q) {
  const double step = 6.0e-6 * kernel->support; /* about cbrt(epsilon): balances both errors */
  const double centre = fmin(fmax(q, step), kernel->support - 2.0 * step);
  sphi_profile p;
  double unused, below, above;
  kernel->fn(kernel->user, q, &p.w, &p.dw);
  kernel->fn(kernel->user, centre - step, &unused, &below);
  kernel->fn(kernel->user, centre + step, &unused, &above);
  p.d2w = (above - below) / (2.0 * step);
  return p;
}

sphi_profile sphi_kernel_profile2(const struct sph_kernel *kernel, double q) {
  if (!(q < kernel->support)) return (sphi_profile){0.0, 0.0, 0.0};
  if (kernel->type != 0) return builtin(kernel->type, kernel->dim, q);
  if (kernel->table_n > 0) return sphi_kernel_table_profile(kernel, q);
  return callback_profile(kernel, q);
}
