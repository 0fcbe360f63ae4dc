/* Four doubles a vector: AVX2 and FMA. See simd.h for what each name means. */
#ifndef SPHI_SIMD_AVX2_H
#define SPHI_SIMD_AVX2_H

#include <immintrin.h>

enum { VW = 4 };
typedef __m256d vd;
typedef __m256d vm;

SPHI_INLINE vd v_set(double a) { return _mm256_set1_pd(a); }
SPHI_INLINE vd v_fma(vd a, vd b, vd c) { return _mm256_fmadd_pd(a, b, c); }
SPHI_INLINE vd v_fnma(vd a, vd b, vd c) { return _mm256_fnmadd_pd(a, b, c); }
SPHI_INLINE vd v_max(vd a, vd b) { return _mm256_max_pd(a, b); }
SPHI_INLINE vd v_min(vd a, vd b) { return _mm256_min_pd(a, b); }
SPHI_INLINE vd v_round(vd a) {
  return _mm256_round_pd(a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
SPHI_INLINE vd v_sqrt(vd a) { return _mm256_sqrt_pd(a); }
SPHI_INLINE vd v_scale2(vd a, vd k) {
  /* k + 1023 as an integer in the low mantissa bits, then moved into the exponent */
  __m256i e = _mm256_castpd_si256(k + _mm256_set1_pd(1023.0 + 4503599627370496.0));
  return a * _mm256_castsi256_pd(_mm256_slli_epi64(e, 52));
}
SPHI_INLINE vd v_rcp(vd x) { return v_set(1.0) / x; }
SPHI_INLINE vd v_length(vd r2, vd *inverse) {
  vd r = v_sqrt(r2);
  *inverse = v_set(1.0) / r;
  return r;
}

SPHI_INLINE vm v_lt(vd a, vd b) { return _mm256_cmp_pd(a, b, _CMP_LT_OQ); }
SPHI_INLINE vm v_first(int64_t n) {
  return _mm256_cmp_pd(_mm256_setr_pd(0.0, 1.0, 2.0, 3.0), _mm256_set1_pd((double)n), _CMP_LT_OQ);
}
SPHI_INLINE vd v_keep(vm m, vd a) { return _mm256_and_pd(m, a); }
SPHI_INLINE vd v_select(vm m, vd a, vd b) { return _mm256_blendv_pd(b, a, m); }
SPHI_INLINE int v_any(vm m) { return _mm256_movemask_pd(m) != 0; }

SPHI_INLINE double v_sum(vd a) {
  __m128d t = _mm_add_pd(_mm256_castpd256_pd128(a), _mm256_extractf128_pd(a, 1));
  return _mm_cvtsd_f64(_mm_add_sd(t, _mm_unpackhi_pd(t, t)));
}

SPHI_INLINE void v_load4(const double *base, const int64_t *at, vd out[4]) {
  __m256d a0 = _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_load_pd(base + at[0])),
                                    _mm_load_pd(base + at[2]), 1);
  __m256d a1 = _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_load_pd(base + at[1])),
                                    _mm_load_pd(base + at[3]), 1);
  __m256d b0 = _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_load_pd(base + at[0] + 2)),
                                    _mm_load_pd(base + at[2] + 2), 1);
  __m256d b1 = _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_load_pd(base + at[1] + 2)),
                                    _mm_load_pd(base + at[3] + 2), 1);
  out[0] = _mm256_unpacklo_pd(a0, a1);
  out[1] = _mm256_unpackhi_pd(a0, a1);
  out[2] = _mm256_unpacklo_pd(b0, b1);
  out[3] = _mm256_unpackhi_pd(b0, b1);
}

SPHI_INLINE void v_offsets(const uint32_t *p, int64_t n, uint32_t self, int64_t stride,
                           int64_t at[4]) {
  if (n >= VW) {
    at[0] = (int64_t)p[0] * stride;
    at[1] = (int64_t)p[1] * stride;
    at[2] = (int64_t)p[2] * stride;
    at[3] = (int64_t)p[3] * stride;
  } else {
    at[0] = (int64_t)(n > 0 ? p[0] : self) * stride;
    at[1] = (int64_t)(n > 1 ? p[1] : self) * stride;
    at[2] = (int64_t)(n > 2 ? p[2] : self) * stride;
    at[3] = (int64_t)(n > 3 ? p[3] : self) * stride;
  }
}

SPHI_INLINE void v_store(double *p, vd a) { _mm256_storeu_pd(p, a); }
SPHI_INLINE vd v_load(const double *p) { return _mm256_loadu_pd(p); }

#endif
