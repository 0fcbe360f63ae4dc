/* Row loops for AVX2 and FMA; portable ones where the build is for another architecture. */
#if defined(__x86_64__)
#define SPHI_SIMD_AVX2
#endif
#include "rows.inc"

#include "artificial.inc"
#include "instances.inc"

sphi_rows_fn sphi_rows_avx2(sphi_spec *spec, int32_t dim) { return find_rows(spec, dim); }
const sphi_artificial_fn sphi_artificial_avx2 = artificial;
