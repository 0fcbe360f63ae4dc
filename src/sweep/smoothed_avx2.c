/* Loops with two smoothing lengths a pair, for AVX2; portable ones where the build is for another
 * architecture. */
#if defined(__x86_64__)
#define SPHI_SIMD_AVX2
#endif
#include "smoothed_rows.inc"

const sphi_smoothed_loops sphi_smoothed_avx2 = SMOOTHED_TABLE;
