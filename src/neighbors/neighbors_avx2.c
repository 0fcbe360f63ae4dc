/* The search loops in 256-bit vectors; kept lanes are moved to the front by a table. */
#if defined(__x86_64__)
#if !defined(__AVX2__) || !defined(__FMA__)
#error "compile this file with AVX2 and FMA"
#endif
#include "search.h"

#include <immintrin.h>

#define W 8
#define ALL 0xffu
#define VD 4
#define SEARCH sphi_search_avx2
#define ROWS_AT_ONCE 2
typedef __m256 vf;
typedef __m256 vm; /* all bits of a lane */

#include "permute.inc"

static inline vf vf_set(float x) { return _mm256_set1_ps(x); }
static inline vf vf_load(const float *p) { return _mm256_loadu_ps(p); }
static inline vf vf_add(vf a, vf b) { return _mm256_add_ps(a, b); }
static inline vf vf_sub(vf a, vf b) { return _mm256_sub_ps(a, b); }
static inline vf vf_mul(vf a, vf b) { return _mm256_mul_ps(a, b); }
static inline vf vf_div(vf a, vf b) { return _mm256_div_ps(a, b); }
static inline vf vf_fma(vf a, vf b, vf c) { return _mm256_fmadd_ps(a, b, c); }
static inline vf vf_min(vf a, vf b) { return _mm256_min_ps(a, b); }
static inline vf vf_max(vf a, vf b) { return _mm256_max_ps(a, b); }
static inline vf vf_abs(vf a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a); }
static inline vm vf_less(vf a, vf b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
static inline vm vm_none(void) { return _mm256_setzero_ps(); }
static inline vm vm_or(vm a, vm b) { return _mm256_or_ps(a, b); }
static inline vm vm_xor(vm a, vm b) { return _mm256_xor_ps(a, b); }
static inline uint32_t vm_bits(vm a) { return (uint32_t)_mm256_movemask_ps(a); }

static inline vf join(__m256d a, __m256d b) {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm256_cvtpd_ps(a)), _mm256_cvtpd_ps(b), 1);
}

static inline vf vf_relative(const double *x, double center) {
  __m256d c = _mm256_set1_pd(center);
  return join(_mm256_sub_pd(_mm256_loadu_pd(x), c), _mm256_sub_pd(_mm256_loadu_pd(x + 4), c));
}

static inline __m256d wrapped(__m256d d, double period, double inverse) {
  const __m256d magic = _mm256_set1_pd(6755399441055744.0);
  __m256d turns = _mm256_add_pd(_mm256_mul_pd(d, _mm256_set1_pd(inverse)), magic);
  return _mm256_sub_pd(d, _mm256_mul_pd(_mm256_set1_pd(period), _mm256_sub_pd(turns, magic)));
}

static inline vf vf_relative_wrapped(const double *x, double center, double period,
                                     double inverse) {
  __m256d c = _mm256_set1_pd(center);
  return join(wrapped(_mm256_sub_pd(_mm256_loadu_pd(x), c), period, inverse),
              wrapped(_mm256_sub_pd(_mm256_loadu_pd(x + 4), c), period, inverse));
}

static inline __m256i to_front(__m256i v, uint32_t keep) {
  __m128i bytes = _mm_cvtsi64_si128((long long)permute[keep]);
  return _mm256_permutevar8x32_epi32(v, _mm256_cvtepu8_epi32(bytes));
}

static inline __m256i load_indices(const uint32_t *p) {
  return _mm256_loadu_si256((const __m256i *)(const void *)p);
}

static inline void store_indices(uint32_t *p, __m256i v) {
  _mm256_storeu_si256((__m256i *)(void *)p, v);
}

static inline void put_floats(float *p, vf v, uint32_t keep) {
  _mm256_storeu_si256((__m256i *)(void *)p, to_front(_mm256_castps_si256(v), keep));
}

/* first, first + 1, ... of the lanes kept */
static inline void put_counted(uint32_t *p, uint32_t first, uint32_t keep) {
  __m256i v =
      _mm256_add_epi32(_mm256_set1_epi32((int)first), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
  store_indices(p, to_front(v, keep));
}

static inline uint32_t *put_indices(uint32_t *p, const uint32_t *from, uint32_t keep) {
  store_indices(p, to_front(load_indices(from), keep));
  return p + __builtin_popcount(keep);
}

static inline void copy_indices(uint32_t *to, const uint32_t *from) {
  store_indices(to, load_indices(from));
}

static inline int64_t put_candidates(const sphi_candidates *c, int64_t at, int dim, int uniform,
                                     vf x, vf y, vf z, vf s, uint32_t first, uint32_t keep) {
  put_floats(c->x[0] + at, x, keep);
  if (dim > 1) put_floats(c->x[1] + at, y, keep);
  if (dim > 2) put_floats(c->x[2] + at, z, keep);
  if (!uniform) put_floats(c->s + at, s, keep);
  put_counted(c->index + at, first, keep);
  return __builtin_popcount(keep);
}

static inline void emit(uint32_t **out, uint64_t *waiting, const uint32_t *index, int64_t q,
                        uint32_t keep) {
  (void)waiting;
  *out = put_indices(*out, index + q, keep);
}

static inline void emit_rest(uint32_t **out, uint64_t *waiting, const uint32_t *index,
                             int64_t count) {
  (void)out;
  (void)waiting;
  (void)index;
  (void)count;
}

#define vd_bits(mask) ((uint32_t)_mm256_movemask_pd((__m256d)(mask)))

#include "search.inc"
#else
typedef int sphi_neighbors_avx2_unused;
#endif
