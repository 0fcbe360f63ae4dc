/* One h and one W for a pair of particles with different ones, He (6.4) to (6.9). */
#include <sph/adapt.h>
#include <sph/kernel.h>

#include <math.h>

double sph_pair_h(int32_t rule, double h_i, double h_j) {
  if (!isfinite(h_i) || !isfinite(h_j) || h_i <= 0.0 || h_j <= 0.0) return NAN;
  switch (rule) {
  case SPH_H_ARITHMETIC:
    return 0.5 * (h_i + h_j);
  case SPH_H_HARMONIC:
    return 2.0 * h_i * h_j / (h_i + h_j);
  case SPH_H_MAX:
  case SPH_H_AVERAGE:
    return h_i > h_j ? h_i : h_j;
  case SPH_H_MIN:
    return h_i < h_j ? h_i : h_j;
  default:
    return NAN;
  }
}

typedef double (*profile)(const sph_kernel *kernel, double r, double h);

static double of_pair(profile f, const sph_kernel *kernel, int32_t rule, double r, double h_i,
                      double h_j) {
  const double h = sph_pair_h(rule, h_i, h_j);
  if (rule != SPH_H_AVERAGE || isnan(h)) return f(kernel, r, h);
  return 0.5 * (f(kernel, r, h_i) + f(kernel, r, h_j));
}

double sph_pair_w(const sph_kernel *kernel, int32_t rule, double r, double h_i, double h_j) {
  return of_pair(sph_kernel_w, kernel, rule, r, h_i, h_j);
}

double sph_pair_dwdr(const sph_kernel *kernel, int32_t rule, double r, double h_i, double h_j) {
  return of_pair(sph_kernel_dwdr, kernel, rule, r, h_i, h_j);
}
