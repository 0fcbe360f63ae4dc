/* Two doubles a vector, by the compiler's vector extension: any architecture. */
#ifndef SPHI_SIMD_PORTABLE_H
#define SPHI_SIMD_PORTABLE_H

enum { VW = 2 };
typedef double vd __attribute__((vector_size(16)));
typedef int64_t vm __attribute__((vector_size(16)));

SPHI_INLINE vd v_set(double a) { return (vd){a, a}; }
SPHI_INLINE vd v_fma(vd a, vd b, vd c) { return a * b + c; }
SPHI_INLINE vd v_fnma(vd a, vd b, vd c) { return c - a * b; }
SPHI_INLINE vm v_lt(vd a, vd b) { return (vm)(a < b); }
SPHI_INLINE vd v_keep(vm m, vd a) { return (vd)(m & (vm)a); }
SPHI_INLINE vd v_select(vm m, vd a, vd b) { return (vd)((m & (vm)a) | (~m & (vm)b)); }
SPHI_INLINE vd v_max(vd a, vd b) { return v_select(v_lt(b, a), a, b); }
SPHI_INLINE vd v_min(vd a, vd b) { return v_select(v_lt(a, b), a, b); }
/* Valid for |a| < 2^51, which is all that displacements in boxes and exponents need. */
SPHI_INLINE vd v_round(vd a) {
  const vd magic = {6755399441055744.0, 6755399441055744.0};
  return (a + magic) - magic;
}
SPHI_INLINE vd v_sqrt(vd a) { return (vd){__builtin_sqrt(a[0]), __builtin_sqrt(a[1])}; }
SPHI_INLINE vd v_scale2(vd a, vd k) {
  vm e = (vm)(k + (vd){1023.0 + 4503599627370496.0, 1023.0 + 4503599627370496.0});
  return a * (vd)(e << 52);
}
SPHI_INLINE vd v_rcp(vd x) { return v_set(1.0) / x; }
SPHI_INLINE vd v_length(vd r2, vd *inverse) {
  vd r = v_sqrt(r2);
  *inverse = v_set(1.0) / r;
  return r;
}
SPHI_INLINE vm v_first(int64_t n) { return (vm){n > 0 ? -1 : 0, n > 1 ? -1 : 0}; }
SPHI_INLINE int v_any(vm m) { return (m[0] | m[1]) != 0; }
SPHI_INLINE double v_sum(vd a) { return a[0] + a[1]; }

SPHI_INLINE void v_load4(const double *base, const int64_t *at, vd out[4]) {
  const vd *a = (const vd *)(const void *)(base + at[0]);
  const vd *b = (const vd *)(const void *)(base + at[1]);
  vd a0 = a[0], a1 = a[1], b0 = b[0], b1 = b[1];
  out[0] = (vd){a0[0], b0[0]};
  out[1] = (vd){a0[1], b0[1]};
  out[2] = (vd){a1[0], b1[0]};
  out[3] = (vd){a1[1], b1[1]};
}

SPHI_INLINE void v_offsets(const uint32_t *p, int64_t n, uint32_t self, int64_t stride,
                           int64_t at[2]) {
  at[0] = (int64_t)p[0] * stride;
  at[1] = (int64_t)(n > 1 ? p[1] : self) * stride;
}

SPHI_INLINE void v_store(double *p, vd a) {
  p[0] = a[0];
  p[1] = a[1];
}
SPHI_INLINE vd v_load(const double *p) { return (vd){p[0], p[1]}; }

#endif
