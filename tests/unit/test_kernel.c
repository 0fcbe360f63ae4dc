/* Built-in kernels against what can be known of them without the code: exact fractions, integrals
 * by another quadrature, differences, published constants, Fourier transforms, lattice sums. */
#include "../check.h"

#include "kernel/profile.h"

#include <sph/context.h>
#include <sph/kernel.h>

#define PI 3.14159265358979323846

enum { FIRST = SPH_KERNEL_CUBIC_SPLINE, LAST = SPH_KERNEL_MOLLIFIER };

static sph_context *context;

static sph_kernel *make(int32_t type, int32_t dim) {
  sph_kernel *kernel = NULL;
  if (context == NULL) check_ok(sph_context_create(NULL, &context));
  check_ok(sph_kernel_create(context, type, dim, &kernel));
  return kernel;
}

typedef void (*kernel_check)(const sph_kernel *kernel);

static void for_each(kernel_check check) {
  for (int32_t type = FIRST; type <= LAST; ++type)
    for (int32_t dim = 1; dim <= 3; ++dim) {
      sph_kernel *kernel = make(type, dim);
      check(kernel);
      sph_kernel_destroy(kernel);
    }
}

static int is_cut(const sph_kernel *kernel) {
  const int32_t type = sph_kernel_type(kernel);
  return type == SPH_KERNEL_GAUSSIAN || type == SPH_KERNEL_SUPER_GAUSSIAN;
}

/* ---- quadrature: composite ten-point Gauss, knots at multiples of the support / 60 ---------- */

typedef double (*radial_fn)(const sph_kernel *kernel, double q, double k);

static double radial_integral(const sph_kernel *kernel, radial_fn f, double k) {
  static const double node[5] = {0.14887433898163121089, 0.43339539412924719080,
                                 0.67940956829902440623, 0.86506336668898451073,
                                 0.97390652851717172008};
  static const double weight[5] = {0.29552422471475287017, 0.26926671930999635509,
                                   0.21908636251598204400, 0.14945134915058059315,
                                   0.06667134430868813759};
  const double half = 0.5 * sph_kernel_support(kernel) / 60.0; /* every knot is a panel edge */
  double sum = 0.0;
  for (int i = 0; i < 60; ++i)
    for (int n = 0; n < 5; ++n)
      sum += weight[n] * (f(kernel, half * (2 * i + 1 + node[n]), k) +
                          f(kernel, half * (2 * i + 1 - node[n]), k));
  return sum * half;
}

static double shell(const sph_kernel *kernel, double q) {
  const int32_t dim = sph_kernel_dim(kernel);
  return dim == 1 ? 2.0 : dim == 2 ? 2.0 * PI * q : 4.0 * PI * q * q;
}

static double volume_term(const sph_kernel *kernel, double q, double k) {
  (void)k;
  return shell(kernel, q) * sph_kernel_w(kernel, q, 1.0);
}

static double slope_term(const sph_kernel *kernel, double q, double k) {
  (void)k;
  return shell(kernel, q) * q * sph_kernel_dwdr(kernel, q, 1.0);
}

static double second_term(const sph_kernel *kernel, double q, double k) {
  return q * q * volume_term(kernel, q, k);
}

static void check_integrals(const sph_kernel *kernel) {
  const double dim = sph_kernel_dim(kernel), edge = sph_kernel_support(kernel);
  check_close(radial_integral(kernel, volume_term, 0), 1.0, 1e-12);
  const double variance = radial_integral(kernel, second_term, 0) / dim;
  check_close(sph_kernel_deviation(kernel), sqrt(variance), 1e-12);
  /* by parts: int r W' = -d + (what is left at the edge, where a Gaussian is cut) */
  const double inside = nextafter(edge, 0.0);
  const double cut = shell(kernel, edge) * edge * sph_kernel_w(kernel, inside, 1.0);
  check_close(radial_integral(kernel, slope_term, 0), cut - dim, 1e-11);
}

static void test_integrals(void **state) {
  (void)state;
  for_each(check_integrals);
}

/* ---- exact values --------------------------------------------------------------------------- */

typedef struct exact {
  int32_t type, dim; /* dim 0: the same in every dimension */
  double q, w;
} exact;

static const exact exacts[] = {
    {SPH_KERNEL_CUBIC_SPLINE, 0, 0.0, 2.0 / 3.0},
    {SPH_KERNEL_CUBIC_SPLINE, 0, 0.5, 23.0 / 48.0},
    {SPH_KERNEL_CUBIC_SPLINE, 0, 1.0, 1.0 / 6.0},
    {SPH_KERNEL_CUBIC_SPLINE, 0, 1.5, 1.0 / 48.0},
    {SPH_KERNEL_QUARTIC_SPLINE, 0, 0.0, 115.0 / 8.0},
    {SPH_KERNEL_QUARTIC_SPLINE, 0, 0.5, 11.0},
    {SPH_KERNEL_QUARTIC_SPLINE, 0, 1.5, 1.0},
    {SPH_KERNEL_QUINTIC_SPLINE, 0, 0.0, 66.0},
    {SPH_KERNEL_QUINTIC_SPLINE, 0, 0.5, 841.0 / 16.0},
    {SPH_KERNEL_QUINTIC_SPLINE, 0, 1.0, 26.0},
    {SPH_KERNEL_QUINTIC_SPLINE, 0, 2.0, 1.0},
    {SPH_KERNEL_QUADRATIC, 0, 0.5, 3.0 / 4.0},
    {SPH_KERNEL_JOHNSON, 0, 0.0, 3.0 / 4.0},
    {SPH_KERNEL_JOHNSON, 0, 0.5, 27.0 / 64.0},
    {SPH_KERNEL_LUCY, 0, 0.5, 5.0 / 16.0},
    {SPH_KERNEL_NEW_QUARTIC, 0, 0.0, 2.0 / 3.0},
    {SPH_KERNEL_NEW_QUARTIC, 0, 0.5, 243.0 / 512.0},
    {SPH_KERNEL_NEW_QUARTIC, 0, 1.0, 17.0 / 96.0},
    {SPH_KERNEL_GAUSSIAN, 0, 0.5, 0.77880078307140486825},
    {SPH_KERNEL_SUPER_GAUSSIAN, 1, 0.5, 1.25 * 0.77880078307140486825},
    {SPH_KERNEL_SUPER_GAUSSIAN, 2, 0.5, 1.75 * 0.77880078307140486825},
    {SPH_KERNEL_SUPER_GAUSSIAN, 3, 0.5, 2.25 * 0.77880078307140486825},
    {SPH_KERNEL_WENDLAND_C2, 1, 0.5, 189.0 / 256.0},
    {SPH_KERNEL_WENDLAND_C2, 2, 0.5, 81.0 / 128.0},
    {SPH_KERNEL_WENDLAND_C2, 3, 1.0, 3.0 / 16.0},
    {SPH_KERNEL_WENDLAND_C4, 1, 1.0, 11.0 / 64.0},
    {SPH_KERNEL_WENDLAND_C4, 2, 1.0, 83.0 / 768.0},
    {SPH_KERNEL_WENDLAND_C4, 3, 1.0, 83.0 / 768.0},
    {SPH_KERNEL_WENDLAND_C6, 1, 1.0, 95.0 / 1024.0},
    {SPH_KERNEL_WENDLAND_C6, 2, 1.0, 61.0 / 1024.0},
    {SPH_KERNEL_WENDLAND_C6, 3, 1.0, 61.0 / 1024.0},
    {SPH_KERNEL_MOLLIFIER, 0, 0.0, 0.36787944117144232160},
    {SPH_KERNEL_MOLLIFIER, 0, 0.5, 0.26359713811572677},
};

static void test_exact_values(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof exacts / sizeof exacts[0]; ++i)
    for (int32_t dim = 1; dim <= 3; ++dim) {
      if (exacts[i].dim != 0 && exacts[i].dim != dim) continue;
      sph_kernel *kernel = make(exacts[i].type, dim);
      double w, dw;
      sphi_kernel_profile(kernel, exacts[i].q, &w, &dw);
      check_rel(w, exacts[i].w, 4e-16);
      const double h = 0.7;
      check_rel(sph_kernel_w(kernel, exacts[i].q * h, h),
                sph_kernel_alpha(kernel) * exacts[i].w / pow(h, dim), 1e-14);
      sph_kernel_destroy(kernel);
    }
}

/* Normalisations as published (corrected where they must be), to the digits printed. */
typedef struct published {
  int32_t type;
  double alpha[3], tolerance;
} published;

static void test_alpha(void **state) {
  (void)state;
  static const published rows[] = {
      {SPH_KERNEL_CUBIC_SPLINE, {1.0, 15.0 / (7.0 * PI), 1.5 / PI}, 1e-15},
      {SPH_KERNEL_QUARTIC_SPLINE, {1.0 / 24, 96.0 / (1199 * PI), 1.0 / (20 * PI)}, 1e-15},
      {SPH_KERNEL_QUINTIC_SPLINE, {1.0 / 120, 7.0 / (478 * PI), 1.0 / (120 * PI)}, 1e-15},
      {SPH_KERNEL_WENDLAND_C2, {5.0 / 8, 7.0 * 16 / (64 * PI), 21.0 * 16 / (256 * PI)}, 1e-15},
      {SPH_KERNEL_WENDLAND_C4, {1.5 / 2, 9.0 / (4 * PI), 495.0 / (32 * 8 * PI)}, 1e-15},
      {SPH_KERNEL_WENDLAND_C6, {55.0 / 64, 78.0 / (28 * PI), 1365.0 / (512 * PI)}, 1e-15},
      {SPH_KERNEL_MOLLIFIER, {2.252284, 2.143566, 2.267117}, 5e-7},
      {SPH_KERNEL_GAUSSIAN, {1.692606 / 3, 2.865143 / 9, 4.850986 / 27}, 2e-7},
  };
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i)
    for (int32_t dim = 1; dim <= 3; ++dim) {
      sph_kernel *kernel = make(rows[i].type, dim);
      check_close(sph_kernel_alpha(kernel), rows[i].alpha[dim - 1], rows[i].tolerance);
      sph_kernel_destroy(kernel);
    }
}

/* ---- derivatives ---------------------------------------------------------------------------- */

/* Distance to the nearest knot or end in units of h: differences must not straddle one. */
static double clearance(const sph_kernel *kernel, double q) {
  static const double knots[] = {0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0};
  double least = fabs(q - sph_kernel_support(kernel));
  for (size_t i = 0; i < sizeof knots / sizeof knots[0]; ++i)
    least = fmin(least, fabs(q - knots[i]));
  return least;
}

typedef double (*value_fn)(const sph_kernel *kernel, double r, double h);

static double difference_r(value_fn f, const sph_kernel *kernel, double r, double h, double s) {
  return (8.0 * (f(kernel, r + s, h) - f(kernel, r - s, h)) -
          (f(kernel, r + 2 * s, h) - f(kernel, r - 2 * s, h))) /
         (12.0 * s);
}

static double difference_h(const sph_kernel *kernel, double r, double h, double s) {
  return (8.0 * (sph_kernel_w(kernel, r, h + s) - sph_kernel_w(kernel, r, h - s)) -
          (sph_kernel_w(kernel, r, h + 2 * s) - sph_kernel_w(kernel, r, h - 2 * s))) /
         (12.0 * s);
}

static void check_derivatives(const sph_kernel *kernel) {
  const double h = 1.3, s = 4e-4;
  const double scale = sph_kernel_w(kernel, 0.0, h);
  const int mollifier = sph_kernel_type(kernel) == SPH_KERNEL_MOLLIFIER;
  for (int i = 1; i < 300; ++i) {
    const double q = sph_kernel_support(kernel) * i / 300.0, r = q * h;
    if (clearance(kernel, q) < 3.0 * s) continue;
    if (mollifier && q > 0.9) continue; /* its fifth derivative exceeds 1e6 there */
    const double tolerance = scale * (mollifier ? 1e-6 : 2e-9);
    check_close(sph_kernel_dwdr(kernel, r, h), difference_r(sph_kernel_w, kernel, r, h, s),
                tolerance);
    check_close(sph_kernel_d2wdr2(kernel, r, h), difference_r(sph_kernel_dwdr, kernel, r, h, s),
                10 * tolerance);
    check_close(sph_kernel_dwdh(kernel, r, h), difference_h(kernel, r, h, s), 4 * tolerance);
  }
}

static void test_derivatives(void **state) {
  (void)state;
  for_each(check_derivatives);
}

/* ---- origin, knots, edge, sign -------------------------------------------------------------- */

static void check_origin(const sph_kernel *kernel) {
  const double h = 0.4, dim = sph_kernel_dim(kernel);
  const double w0 = sph_kernel_w(kernel, 0.0, h);
  assert_true(w0 > 0.0);
  check_close(sph_kernel_dwdr(kernel, 0.0, h), 0.0, 0.0);
  check_rel(sph_kernel_dwdh(kernel, 0.0, h), -dim * w0 / h, 1e-15);
  if (sph_kernel_type(kernel) != SPH_KERNEL_JOHNSON)
    check_rel(sph_kernel_dwdr(kernel, 1e-12, h), 1e-12 * sph_kernel_d2wdr2(kernel, 0.0, h), 1e-11);
  else /* the cusp: slope -3/4 at any distance, zero only at the centre */
    check_rel(sph_kernel_dwdr(kernel, 1e-12, 1.0), -0.75 * sph_kernel_alpha(kernel), 1e-10);
}

static void check_edge(const sph_kernel *kernel) {
  const double h = 2.5, edge = sph_kernel_support(kernel) * h;
  const double beyond[] = {edge, nextafter(edge, 1e9), 2 * edge, 1e300, INFINITY};
  for (size_t i = 0; i < sizeof beyond / sizeof beyond[0]; ++i) {
    check_close(sph_kernel_w(kernel, beyond[i], h), 0.0, 0.0);
    check_close(sph_kernel_dwdr(kernel, beyond[i], h), 0.0, 0.0);
    check_close(sph_kernel_d2wdr2(kernel, beyond[i], h), 0.0, 0.0);
    check_close(sph_kernel_dwdh(kernel, beyond[i], h), 0.0, 0.0);
  }
  if (is_cut(kernel)) return;
  const double near = nextafter(edge, 0.0);
  check_close(sph_kernel_w(kernel, near, h), 0.0, 1e-14);
}

/* Orders of the derivatives that are continuous at every knot; the edge has its own. */
static void check_knots(const sph_kernel *kernel) {
  static const double knots[] = {0.5, 1.0, 1.5, 2.0, 2.5};
  const double e = 1e-9, scale = 40.0 * sph_kernel_w(kernel, 0.0, 1.0);
  for (size_t i = 0; i < sizeof knots / sizeof knots[0]; ++i) {
    const double q = knots[i];
    if (q >= sph_kernel_support(kernel)) continue;
    check_close(sph_kernel_w(kernel, q - e, 1.0), sph_kernel_w(kernel, q + e, 1.0), scale * e);
    check_close(sph_kernel_dwdr(kernel, q - e, 1.0), sph_kernel_dwdr(kernel, q + e, 1.0),
                scale * e);
    check_close(sph_kernel_d2wdr2(kernel, q - e, 1.0), sph_kernel_d2wdr2(kernel, q + e, 1.0),
                scale * e);
  }
}

/* Decreasing and not negative, but for the two kernels that are known not to be. */
static void check_sign(const sph_kernel *kernel) {
  const int32_t type = sph_kernel_type(kernel);
  const double edge = sph_kernel_support(kernel);
  const double root = sqrt(1.0 + 0.5 * sph_kernel_dim(kernel));
  for (int i = 1; i < 4000; ++i) {
    const double q = edge * i / 4000.0;
    const double w = sph_kernel_w(kernel, q, 1.0);
    if (type == SPH_KERNEL_SUPER_GAUSSIAN) {
      assert_true(q < root ? w > 0.0 : w < 0.0);
    } else if (type == SPH_KERNEL_NEW_QUARTIC) {
      assert_true(q < 1.6956 ? w > 0.0 : q < 1.6958 || w < 0.0);
      assert_true(q < 1.8 - 1e-9 ? sph_kernel_dwdr(kernel, q, 1.0) < 0.0
                                 : q < 1.8 + 1e-9 || sph_kernel_dwdr(kernel, q, 1.0) > 0.0);
    } else {
      assert_true(w > 0.0 || (type == SPH_KERNEL_MOLLIFIER && q > 0.999));
      assert_true(sph_kernel_dwdr(kernel, q, 1.0) < 0.0 || w < 1e-300);
    }
  }
}

static void test_origin_edge_knots_sign(void **state) {
  (void)state;
  for_each(check_origin);
  for_each(check_edge);
  for_each(check_knots);
  for_each(check_sign);
}

/* The published slopes at the edge, and the minimum of the new quartic. */
static void test_edge_facts(void **state) {
  (void)state;
  double w, dw;
  sph_kernel *kernel = make(SPH_KERNEL_QUADRATIC, 1);
  check_close(sph_kernel_dwdr(kernel, nextafter(1.0, 0.0), 1.0), -1.5, 1e-15);
  sph_kernel_destroy(kernel);
  kernel = make(SPH_KERNEL_NEW_QUARTIC, 1);
  check_close(sph_kernel_d2wdr2(kernel, nextafter(2.0, 0.0), 1.0), -0.25, 1e-14);
  sphi_kernel_profile(kernel, 1.8, &w, &dw);
  check_close(w, -0.00158, 5e-6);
  check_close(dw, 0.0, 1e-15);
  sphi_kernel_profile(kernel, (8.0 + sqrt(304.0)) / 15.0, &w, &dw);
  check_close(w, 0.0, 1e-16);
  sph_kernel_destroy(kernel);
}

/* ---- standard deviation --------------------------------------------------------------------- */

/* s_d of Zisis 2017 (recomputed), variance over the squared support radius; the last column is
 * the support over the h of the Gaussian that resolves the same. */
typedef struct resolution {
  int32_t type;
  double s[3], ratio[3];
} resolution;

static const resolution resolutions[] = {
    {SPH_KERNEL_MOLLIFIER, {.158114, .130656, .111696}, {1.778, 1.956, 2.116}},
    {SPH_KERNEL_CUBIC_SPLINE, {1. / 12, 31. / 392, 3. / 40}, {2.449, 2.515, 2.582}},
    {SPH_KERNEL_QUINTIC_SPLINE, {1. / 18, .053677, 7. / 135}, {3.000, 3.052, 3.105}},
    {SPH_KERNEL_WENDLAND_C2, {2. / 21, 5. / 72, 1. / 15}, {2.291, 2.683, 2.739}},
    {SPH_KERNEL_WENDLAND_C4, {1. / 15, 7. / 132, 2. / 39}, {2.739, 3.071, 3.123}},
    {SPH_KERNEL_WENDLAND_C6, {2. / 39, 3. / 70, 1. / 24}, {3.123, 3.416, 3.464}},
};

static void test_resolution(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof resolutions / sizeof resolutions[0]; ++i)
    for (int32_t dim = 1; dim <= 3; ++dim) {
      sph_kernel *kernel = make(resolutions[i].type, dim);
      sph_kernel *gaussian = make(SPH_KERNEL_GAUSSIAN, dim);
      const double support = sph_kernel_support(kernel), sigma = sph_kernel_deviation(kernel);
      check_close(sigma * sigma / (support * support), resolutions[i].s[dim - 1], 6e-7);
      /* The table's Gaussian is not cut: its deviation is 1/sqrt(2), ours a little less. */
      const double h_gaussian = 0.2 * sqrt(0.5) / sph_kernel_deviation(gaussian);
      const double h = sph_kernel_equal_h(kernel, gaussian, h_gaussian);
      check_close(support * h / 0.2, resolutions[i].ratio[dim - 1], 6e-4);
      check_rel(h * sigma, h_gaussian * sph_kernel_deviation(gaussian), 1e-15);
      sph_kernel_destroy(kernel);
      sph_kernel_destroy(gaussian);
    }
}

/* What the cut costs: the integral of the uncut constant (Sun 2013: .99998 .99988 .99956). */
static void test_gaussian_cut(void **state) {
  (void)state;
  static const double kept[2][3] = {{.99998, .99988, .99956}, {1.00019, 1.00099, 1.00332}};
  for (int32_t dim = 1; dim <= 3; ++dim)
    for (int i = 0; i < 2; ++i) {
      sph_kernel *kernel = make(SPH_KERNEL_GAUSSIAN + i, dim);
      check_close(pow(PI, -0.5 * dim) / sph_kernel_alpha(kernel), kept[i][dim - 1], 6e-6);
      const double sigma = sph_kernel_deviation(kernel);
      assert_true(i == 0 ? fabs(sigma * sigma - 0.5) < 2e-3 : sigma * sigma < 0.02);
      sph_kernel_destroy(kernel);
    }
}

/* ---- Fourier transforms --------------------------------------------------------------------- */

static double bessel_j0(double x) {
  double sum = 0.0;
  for (int i = 0; i < 64; ++i) sum += cos(x * sin(PI * (i + 0.5) / 64));
  return sum / 64;
}

static double fourier_term(const sph_kernel *kernel, double q, double k) {
  const int32_t dim = sph_kernel_dim(kernel);
  const double x = k * q;
  const double wave = dim == 1 ? cos(x) : dim == 2 ? bessel_j0(x) : sin(x) / x;
  return wave * volume_term(kernel, q, 0);
}

/* F(k) with kH given, H the support radius. */
static double fourier(const sph_kernel *kernel, double kh) {
  return radial_integral(kernel, fourier_term, kh / sph_kernel_support(kernel));
}

static void test_fourier_positive(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; ++dim)
    for (int32_t type = SPH_KERNEL_WENDLAND_C2; type <= SPH_KERNEL_WENDLAND_C6; ++type) {
      sph_kernel *kernel = make(type, dim);
      for (double kh = 0.5; kh <= 60.0; kh += 0.5) assert_true(fourier(kernel, kh) > 0.0);
      sph_kernel_destroy(kernel);
    }
  /* The Gaussian's differs from the uncut one by as much as the cut costs (1e-4, 4e-4, 2e-3 of
   * the integral), of which negative ripples of 1e-5 are left. */
  static const double cost[3] = {1e-4, 4e-4, 2e-3};
  for (int32_t dim = 1; dim <= 3; ++dim) {
    sph_kernel *kernel = make(SPH_KERNEL_GAUSSIAN, dim);
    for (double kh = 0.5; kh <= 60.0; kh += 0.5) {
      const double transform = fourier(kernel, kh);
      check_close(transform, exp(-kh * kh / 36.0), cost[dim - 1]);
      assert_true(transform > -1.5e-5);
    }
    sph_kernel_destroy(kernel);
  }
}

/* First zero and least value of the spline transforms; 1-D ones are powers of a sinc. */
static void check_spline(int32_t type, int32_t dim, double zero, double least, double digit) {
  sph_kernel *kernel = make(type, dim);
  double lowest = 0.0;
  for (double kh = 0.5; kh < zero - 0.02; kh += 0.25) assert_true(fourier(kernel, kh) > 0.0);
  assert_true(fourier(kernel, zero + 0.02) < 0.0);
  for (double kh = zero; kh < zero + 6.0; kh += 0.05) lowest = fmin(lowest, fourier(kernel, kh));
  check_close(lowest, least, digit);
  sph_kernel_destroy(kernel);
}

static void test_fourier_splines(void **state) {
  (void)state;
  sph_kernel *m4 = make(SPH_KERNEL_CUBIC_SPLINE, 1), *m6 = make(SPH_KERNEL_QUINTIC_SPLINE, 1);
  for (double kh = 0.5; kh < 60.0; kh += 0.7) {
    check_close(fourier(m4, kh), pow(sin(kh / 4) / (kh / 4), 4), 1e-13);
    check_close(fourier(m6, kh), pow(sin(kh / 6) / (kh / 6), 6), 1e-13);
  }
  sph_kernel_destroy(m4);
  sph_kernel_destroy(m6);
  check_spline(SPH_KERNEL_CUBIC_SPLINE, 2, 11.39, -6.4e-4, 5e-6);
  check_spline(SPH_KERNEL_CUBIC_SPLINE, 3, 12.57, -6.0e-4, 5e-6);
  check_spline(SPH_KERNEL_QUINTIC_SPLINE, 2, 16.75, -2.5e-5, 5e-7);
  check_spline(SPH_KERNEL_QUINTIC_SPLINE, 3, 18.95, -2.2e-5, 5e-7);
}

/* ---- internals ------------------------------------------------------------------------------ */

/* The profile that pair loops use and the one with a second derivative are the same bits. */
static void check_profiles_agree(const sph_kernel *kernel) {
  for (int i = 0; i <= 1000; ++i) {
    const double q = 1.01 * sph_kernel_support(kernel) * i / 1000.0;
    double w, dw;
    sphi_kernel_profile(kernel, q, &w, &dw);
    const sphi_profile p = sphi_kernel_profile2(kernel, q);
    assert_true(w == p.w && dw == p.dw && isfinite(p.d2w));
  }
}

static void test_profiles_agree(void **state) {
  (void)state;
  for_each(check_profiles_agree);
}

static void test_references(void **state) {
  (void)state;
  sph_kernel *kernel = make(SPH_KERNEL_LUCY, 2);
  sphi_kernel_retain(kernel);
  sph_kernel_destroy(kernel); /* the host's reference goes, the other stays */
  check_close(sph_kernel_support(kernel), 1.0, 0.0);
  sphi_kernel_release(kernel);
}

static void test_release_context(void **state) {
  (void)state;
  sph_context_destroy(context);
  context = NULL;
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_integrals),
    cmocka_unit_test(test_exact_values),
    cmocka_unit_test(test_alpha),
    cmocka_unit_test(test_derivatives),
    cmocka_unit_test(test_origin_edge_knots_sign),
    cmocka_unit_test(test_edge_facts),
    cmocka_unit_test(test_resolution),
    cmocka_unit_test(test_gaussian_cut),
    cmocka_unit_test(test_fourier_positive),
    cmocka_unit_test(test_fourier_splines),
    cmocka_unit_test(test_profiles_agree),
    cmocka_unit_test(test_references),
    cmocka_unit_test(test_release_context),
};

SPH_TEST_MAIN(tests)
