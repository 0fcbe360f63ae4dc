/* The search loops in 512-bit vectors. Compressing to memory is slow on some machines, so
 * vectors are compressed in a register and stored whole; what is written beyond the kept lanes
 * is overwritten by the next store. */
#if defined(__x86_64__)
#if !defined(__AVX512F__) || !defined(__AVX512DQ__)
#error "compile this file with AVX-512"
#endif
#include "search.h"

#include <immintrin.h>

#define W 16
#define ALL 0xffffu
#define VD 8
#define SEARCH sphi_search_avx512
#define ROWS_AT_ONCE 4
typedef __m512 vf;
typedef __mmask16 vm;

static inline vf vf_set(float x) { return _mm512_set1_ps(x); }
static inline vf vf_load(const float *p) { return _mm512_loadu_ps(p); }
static inline vf vf_add(vf a, vf b) { return _mm512_add_ps(a, b); }
static inline vf vf_sub(vf a, vf b) { return _mm512_sub_ps(a, b); }
static inline vf vf_mul(vf a, vf b) { return _mm512_mul_ps(a, b); }
static inline vf vf_div(vf a, vf b) { return _mm512_div_ps(a, b); }
static inline vf vf_fma(vf a, vf b, vf c) { return _mm512_fmadd_ps(a, b, c); }
static inline vf vf_min(vf a, vf b) { return _mm512_min_ps(a, b); }
static inline vf vf_max(vf a, vf b) { return _mm512_max_ps(a, b); }
static inline vf vf_abs(vf a) { return _mm512_abs_ps(a); }
static inline vm vf_less(vf a, vf b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
static inline vm vm_none(void) { return 0; }
static inline vm vm_or(vm a, vm b) { return _kor_mask16(a, b); }
static inline vm vm_xor(vm a, vm b) { return _kxor_mask16(a, b); }
static inline uint32_t vm_bits(vm a) { return _cvtmask16_u32(a); }

static inline vf join(__m512d a, __m512d b) {
  return _mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(a)), _mm512_cvtpd_ps(b), 1);
}

static inline vf vf_relative(const double *x, double center) {
  __m512d c = _mm512_set1_pd(center);
  return join(_mm512_sub_pd(_mm512_loadu_pd(x), c), _mm512_sub_pd(_mm512_loadu_pd(x + 8), c));
}

static inline __m512d wrapped(__m512d d, double period, double inverse) {
  const __m512d magic = _mm512_set1_pd(6755399441055744.0);
  __m512d turns = _mm512_add_pd(_mm512_mul_pd(d, _mm512_set1_pd(inverse)), magic);
  return _mm512_sub_pd(d, _mm512_mul_pd(_mm512_set1_pd(period), _mm512_sub_pd(turns, magic)));
}

static inline vf vf_relative_wrapped(const double *x, double center, double period,
                                     double inverse) {
  __m512d c = _mm512_set1_pd(center);
  return join(wrapped(_mm512_sub_pd(_mm512_loadu_pd(x), c), period, inverse),
              wrapped(_mm512_sub_pd(_mm512_loadu_pd(x + 8), c), period, inverse));
}

static inline void put_floats(float *p, vf v, uint32_t keep) {
  _mm512_storeu_ps(p, _mm512_maskz_compress_ps((__mmask16)keep, v));
}

/* first, first + 1, ... of the lanes kept */
static inline void put_counted(uint32_t *p, uint32_t first, uint32_t keep) {
  __m512i v =
      _mm512_add_epi32(_mm512_set1_epi32((int)first),
                       _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15));
  _mm512_storeu_si512(p, _mm512_maskz_compress_epi32((__mmask16)keep, v));
}

static inline uint32_t *put_indices(uint32_t *p, const uint32_t *from, uint32_t keep) {
  __m512i v = _mm512_loadu_si512(from);
  _mm512_storeu_si512(p, _mm512_maskz_compress_epi32((__mmask16)keep, v));
  return p + __builtin_popcount(keep);
}

static inline void copy_indices(uint32_t *to, const uint32_t *from) {
  _mm512_storeu_si512(to, _mm512_loadu_si512(from));
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

#define vd_bits(mask) ((uint32_t)_mm512_movepi64_mask((__m512i)(mask)))

#include "search.inc"
#else
typedef int sphi_neighbors_avx512_unused;
#endif
