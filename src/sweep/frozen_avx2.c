/* Frozen row loops for AVX2; portable ones where the build is for another architecture. */
#if defined(__x86_64__)
#define SPHI_SIMD_AVX2
#endif
#include "frozen_rows.inc"

const sphi_frozen_loops sphi_frozen_avx2 = FROZEN_TABLE;
