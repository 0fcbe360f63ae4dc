/* One vocabulary of vector operations, three instruction sets. A source file defines
 * SPHI_SIMD_AVX512 or SPHI_SIMD_AVX2 before including this; the portable set otherwise.
 *
 *   vd, vm      vector of VW doubles, mask of VW lanes; + - * / work on vd
 *   v_fma       a b + c (fused where the instruction set has it), v_fnma  c - a b
 *   v_rcp       1 / x, v_length  r and 1/r from r^2, both good to 2 units in the last place
 *   v_keep      lanes of the mask, 0 elsewhere; v_select; v_first  mask of the first n lanes
 *   v_load4     four doubles of VW records, transposed (the array-of-structures load)
 *   v_offsets   where those records start; lanes beyond a row's end name the particle itself
 *   v_sum       sum of the lanes in a fixed order */
#ifndef SPHI_SIMD_H
#define SPHI_SIMD_H

#include <stdint.h>

#define SPHI_INLINE static inline __attribute__((always_inline, unused))

#if defined(SPHI_SIMD_AVX512)
#include "simd_avx512.h"
#elif defined(SPHI_SIMD_AVX2)
#include "simd_avx2.h"
#else
#include "simd_portable.h"
#endif

/* exp(x) for -700 < x <= 0, relative error below 4e-16: Cody-Waite reduction and the Taylor
 * polynomial of degree 13 on |x| <= ln(2)/2. */
SPHI_INLINE vd v_exp(vd x) {
  vd k = v_round(x * v_set(1.4426950408889634));
  vd r = v_fnma(k, v_set(6.93147180369123816490e-01), x);
  r = v_fnma(k, v_set(1.90821492927058770002e-10), r);
  vd p = v_set(1.0 / 6227020800.0);
  p = v_fma(p, r, v_set(1.0 / 479001600.0));
  p = v_fma(p, r, v_set(1.0 / 39916800.0));
  p = v_fma(p, r, v_set(1.0 / 3628800.0));
  p = v_fma(p, r, v_set(1.0 / 362880.0));
  p = v_fma(p, r, v_set(1.0 / 40320.0));
  p = v_fma(p, r, v_set(1.0 / 5040.0));
  p = v_fma(p, r, v_set(1.0 / 720.0));
  p = v_fma(p, r, v_set(1.0 / 120.0));
  p = v_fma(p, r, v_set(1.0 / 24.0));
  p = v_fma(p, r, v_set(1.0 / 6.0));
  p = v_fma(p, r, v_set(0.5));
  p = v_fma(p, r, v_set(1.0));
  p = v_fma(p, r, v_set(1.0));
  return v_scale2(p, k);
}

#endif
