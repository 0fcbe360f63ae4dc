/* Kernel profiles on vectors: w(q) and g(q) = w'(q) / q, without normalisation, zero outside the
 * support. The switch stands inside the pair loop: it always goes the same way and costs less than
 * a copy of the loop per kernel. Formulas: kernel/profile.c, which the tests compare with. */
#ifndef SPHI_KERNEL_V_H
#define SPHI_KERNEL_V_H

#include "../kernel/kernel_impl.h"
#include "simd.h"

/* (a - q)+ */
SPHI_INLINE vd sphi_ramp(double a, vd q) { return v_max(v_set(a) - q, v_set(0.0)); }

SPHI_INLINE void sphi_kv_cubic(vd q, vd *w, vd *g) {
  vd qi = v_rcp(v_max(q, v_set(1e-150)));
  vd t = sphi_ramp(2.0, q);
  vm inner = v_lt(q, v_set(1.0));
  vd t2 = t * t;
  *w = v_select(inner, v_fma(q * q, v_fma(q, v_set(0.5), v_set(-1.0)), v_set(2.0 / 3.0)),
                t2 * t * v_set(1.0 / 6.0));
  *g = v_select(inner, v_fma(q, v_set(1.5), v_set(-2.0)), t2 * qi * v_set(-0.5));
}

SPHI_INLINE void sphi_kv_c2(vd q, int dim, vd *w, vd *g) {
  vd u = v_fma(q, v_set(-0.5), v_set(1.0));
  u = v_max(u, v_set(0.0));
  if (dim == 1) {
    *w = u * u * u * v_fma(q, v_set(1.5), v_set(1.0));
    *g = u * u * v_set(-3.0);
  } else {
    vd u3 = u * u * u;
    *w = u3 * u * v_fma(q, v_set(2.0), v_set(1.0));
    *g = u3 * v_set(-5.0);
  }
}

SPHI_INLINE void sphi_kv_c4(vd q, int dim, vd *w, vd *g) {
  vd x = q * v_set(0.5);
  vd u = sphi_ramp(1.0, x), u2 = u * u, u4 = u2 * u2;
  if (dim == 1) {
    *w = u4 * u * v_fma(v_fma(x, v_set(8.0), v_set(5.0)), x, v_set(1.0));
    *g = u4 * v_fma(x, v_set(-14.0), v_set(-3.5));
  } else {
    *w = u4 * u2 * v_fma(v_fma(x, v_set(35.0 / 3.0), v_set(6.0)), x, v_set(1.0));
    *g = u4 * u * v_fma(x, v_set(-70.0 / 3.0), v_set(-14.0 / 3.0));
  }
}

SPHI_INLINE void sphi_kv_c6(vd q, int dim, vd *w, vd *g) {
  vd x = q * v_set(0.5);
  vd u = sphi_ramp(1.0, x), u2 = u * u, u4 = u2 * u2, u6 = u4 * u2;
  if (dim == 1) {
    *w = u6 * u * v_fma(v_fma(v_fma(x, v_set(21.0), v_set(19.0)), x, v_set(7.0)), x, v_set(1.0));
    *g = u6 * v_fma(v_fma(x, v_set(-52.5), v_set(-27.0)), x, v_set(-4.5));
  } else {
    *w = u6 * u2 * v_fma(v_fma(v_fma(x, v_set(32.0), v_set(25.0)), x, v_set(8.0)), x, v_set(1.0));
    *g = u6 * u * v_fma(v_fma(x, v_set(-88.0), v_set(-38.5)), x, v_set(-5.5));
  }
}

SPHI_INLINE void sphi_kv_quintic(vd q, vd *w, vd *g) {
  vd qi = v_rcp(v_max(q, v_set(1e-150)));
  vd t3 = sphi_ramp(3.0, q), t2 = sphi_ramp(2.0, q), t1 = sphi_ramp(1.0, q);
  vd a = t3 * t3 * t3 * t3, b = t2 * t2 * t2 * t2, c = t1 * t1 * t1 * t1;
  *w = v_fma(c * t1, v_set(15.0), v_fma(b * t2, v_set(-6.0), a * t3));
  /* below q = 1 the three powers cancel to O(q): use the expanded polynomial there */
  vd inner = v_fma(v_fma(q, v_set(-50.0), v_set(120.0)) * q, q, v_set(-120.0));
  vd outer = v_fma(b, v_set(30.0), a * v_set(-5.0)) * qi;
  *g = v_select(v_lt(q, v_set(1.0)), inner, outer);
}

SPHI_INLINE void sphi_kv_gaussian(vd q, double support, vd *w, vd *g) {
  vd e = v_exp(v_max(q * q * v_set(-1.0), v_set(-50.0)));
  *w = v_keep(v_lt(q, v_set(support)), e);
  *g = *w * v_set(-2.0);
}

/* Any other profile, lane by lane. */
static __attribute__((noinline, unused)) void sphi_kv_lanes(const struct sph_kernel *kernel,
                                                            const double *q, double *w, double *g) {
  for (int l = 0; l < VW; ++l) {
    sphi_kernel_profile(kernel, q[l], &w[l], &g[l]);
    g[l] = q[l] > 0.0 ? g[l] / q[l] : 0.0;
  }
}

SPHI_INLINE void sphi_kv_other(const struct sph_kernel *kernel, vd q, vd *w, vd *g) {
  double lq[VW], lw[VW], lg[VW];
  v_store(lq, q);
  sphi_kv_lanes(kernel, lq, lw, lg);
  *w = v_load(lw);
  *g = v_load(lg);
}

/* w(q) and w'(q)/q. */
SPHI_INLINE void sphi_kv(const struct sph_kernel *kernel, int type, int dim, vd q, vd *w, vd *g) {
  switch (type) {
  case SPH_KERNEL_WENDLAND_C2:
    sphi_kv_c2(q, dim, w, g);
    break;
  case SPH_KERNEL_CUBIC_SPLINE:
    sphi_kv_cubic(q, w, g);
    break;
  case SPH_KERNEL_WENDLAND_C4:
    sphi_kv_c4(q, dim, w, g);
    break;
  case SPH_KERNEL_WENDLAND_C6:
    sphi_kv_c6(q, dim, w, g);
    break;
  case SPH_KERNEL_QUINTIC_SPLINE:
    sphi_kv_quintic(q, w, g);
    break;
  case SPH_KERNEL_GAUSSIAN:
    sphi_kv_gaussian(q, 3.0, w, g);
    break;
  default:
    sphi_kv_other(kernel, q, w, g);
    break;
  }
}

#endif
