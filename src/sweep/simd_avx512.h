/* Eight doubles a vector: AVX-512 F, DQ, VL, BW. See simd.h for what each name means. */
#ifndef SPHI_SIMD_AVX512_H
#define SPHI_SIMD_AVX512_H

#include <immintrin.h>

enum { VW = 8 };
typedef __m512d vd;
typedef __mmask8 vm;

SPHI_INLINE vd v_set(double a) { return _mm512_set1_pd(a); }
SPHI_INLINE vd v_fma(vd a, vd b, vd c) { return _mm512_fmadd_pd(a, b, c); }
SPHI_INLINE vd v_fnma(vd a, vd b, vd c) { return _mm512_fnmadd_pd(a, b, c); }
SPHI_INLINE vd v_max(vd a, vd b) { return _mm512_max_pd(a, b); }
SPHI_INLINE vd v_min(vd a, vd b) { return _mm512_min_pd(a, b); }
SPHI_INLINE vd v_round(vd a) {
  return _mm512_roundscale_pd(a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
SPHI_INLINE vd v_sqrt(vd a) { return _mm512_sqrt_pd(a); }
/* 2^k for integral k in the range of exponents. */
SPHI_INLINE vd v_scale2(vd a, vd k) { return _mm512_scalef_pd(a, k); }

/* 14 bits and one step of fourth order, or two of Newton: 56 bits at about half the cost of a
 * division. */
SPHI_INLINE vd v_rsqrt(vd x) {
  vd y = _mm512_rsqrt14_pd(x);
  vd e = v_fnma(x * y, y, v_set(1.0));
  vd p = v_fma(v_fma(e, v_set(0.3125), v_set(0.375)), e, v_set(0.5));
  return v_fma(y * e, p, y);
}
SPHI_INLINE vd v_rcp(vd x) {
  vd y = _mm512_rcp14_pd(x);
  y = v_fma(y, v_fnma(x, y, v_set(1.0)), y);
  return v_fma(y, v_fnma(x, y, v_set(1.0)), y);
}
/* r and 1/r from r^2 > 0. */
SPHI_INLINE vd v_length(vd r2, vd *inverse) {
  *inverse = v_rsqrt(r2);
  return r2 * *inverse;
}

SPHI_INLINE vm v_lt(vd a, vd b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
SPHI_INLINE vm v_first(int64_t n) { return (vm)(n >= 8 ? 0xffu : (1u << n) - 1u); }
SPHI_INLINE vd v_keep(vm m, vd a) { return _mm512_maskz_mov_pd(m, a); }
SPHI_INLINE vd v_select(vm m, vd a, vd b) { return _mm512_mask_mov_pd(b, m, a); }
SPHI_INLINE int v_any(vm m) { return m != 0; }

SPHI_INLINE double v_sum(vd a) {
  __m256d s = _mm256_add_pd(_mm512_castpd512_pd256(a), _mm512_extractf64x4_pd(a, 1));
  __m128d t = _mm_add_pd(_mm256_castpd256_pd128(s), _mm256_extractf128_pd(s, 1));
  return _mm_cvtsd_f64(_mm_add_sd(t, _mm_unpackhi_pd(t, t)));
}

SPHI_INLINE __m512d sphi_two_rows(const double *lo, const double *hi) {
  return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_load_pd(lo)), _mm256_load_pd(hi), 1);
}

/* Four consecutive doubles of eight records, transposed: out[c] holds component c of every record.
 * Rows 0 and 2, 1 and 3 ... share a register so that the lanes come out in order. */
SPHI_INLINE void v_load4(const double *base, const int64_t *at, vd out[4]) {
  __m512d a0 = sphi_two_rows(base + at[0], base + at[2]);
  __m512d a1 = sphi_two_rows(base + at[1], base + at[3]);
  __m512d a2 = sphi_two_rows(base + at[4], base + at[6]);
  __m512d a3 = sphi_two_rows(base + at[5], base + at[7]);
  __m512d t0 = _mm512_unpacklo_pd(a0, a1), t1 = _mm512_unpackhi_pd(a0, a1);
  __m512d t2 = _mm512_unpacklo_pd(a2, a3), t3 = _mm512_unpackhi_pd(a2, a3);
  out[0] = _mm512_shuffle_f64x2(t0, t2, 0x88);
  out[1] = _mm512_shuffle_f64x2(t1, t3, 0x88);
  out[2] = _mm512_shuffle_f64x2(t0, t2, 0xdd);
  out[3] = _mm512_shuffle_f64x2(t1, t3, 0xdd);
}

/* Offsets (in doubles) of the records that a row's next lanes name. */
SPHI_INLINE void v_offsets(const uint32_t *p, int64_t n, uint32_t self, int64_t stride,
                           int64_t at[8]) {
  if (n >= VW) {
    at[0] = (int64_t)p[0] * stride;
    at[1] = (int64_t)p[1] * stride;
    at[2] = (int64_t)p[2] * stride;
    at[3] = (int64_t)p[3] * stride;
    at[4] = (int64_t)p[4] * stride;
    at[5] = (int64_t)p[5] * stride;
    at[6] = (int64_t)p[6] * stride;
    at[7] = (int64_t)p[7] * stride;
  } else {
    at[0] = (int64_t)(n > 0 ? p[0] : self) * stride;
    at[1] = (int64_t)(n > 1 ? p[1] : self) * stride;
    at[2] = (int64_t)(n > 2 ? p[2] : self) * stride;
    at[3] = (int64_t)(n > 3 ? p[3] : self) * stride;
    at[4] = (int64_t)(n > 4 ? p[4] : self) * stride;
    at[5] = (int64_t)(n > 5 ? p[5] : self) * stride;
    at[6] = (int64_t)(n > 6 ? p[6] : self) * stride;
    at[7] = (int64_t)(n > 7 ? p[7] : self) * stride;
  }
}

SPHI_INLINE void v_store(double *p, vd a) { _mm512_storeu_pd(p, a); }
SPHI_INLINE vd v_load(const double *p) { return _mm512_loadu_pd(p); }

#endif
