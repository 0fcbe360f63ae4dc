/* The search loops in the compiler's own vectors, for every machine. Vectors are wider than most
 * machines' registers, so that a mask has enough bits to be worth scanning. */
#include "search.h"

#include <string.h>

#define W 16
#define ALL 0xffffu
#define ROWS_AT_ONCE 1
#define VD 2
#define SEARCH sphi_search_portable
typedef float v4 __attribute__((vector_size(16)));
typedef int32_t i4 __attribute__((vector_size(16)));
typedef double d2 __attribute__((vector_size(16)));
typedef struct vf {
  v4 a, b, c, d;
} vf;
typedef struct vm {
  i4 a, b, c, d; /* all bits of a lane */
} vm;

#define EACH(type, expression_a, expression_b, expression_c, expression_d) \
  (type) { expression_a, expression_b, expression_c, expression_d }
#define BINARY(type, op, x, y) \
  EACH(type, (x).a op(y).a, (x).b op(y).b, (x).c op(y).c, (x).d op(y).d)
#define CALL2(f, x, y) EACH(vf, f((x).a, (y).a), f((x).b, (y).b), f((x).c, (y).c), f((x).d, (y).d))

static inline v4 load4(const float *p) {
  v4 v;
  memcpy(&v, p, sizeof v);
  return v;
}
static inline v4 set4(float x) { return (v4){x, x, x, x}; }
static inline v4 min4(v4 x, v4 y) {
  i4 m = x < y;
  return (v4)(((i4)x & m) | ((i4)y & ~m));
}
static inline v4 max4(v4 x, v4 y) {
  i4 m = x > y;
  return (v4)(((i4)x & m) | ((i4)y & ~m));
}
static inline v4 abs4(v4 x) { return (v4)((i4)x & 0x7fffffff); }

static inline vf vf_set(float x) { return EACH(vf, set4(x), set4(x), set4(x), set4(x)); }
static inline vf vf_load(const float *p) {
  return EACH(vf, load4(p), load4(p + 4), load4(p + 8), load4(p + 12));
}
static inline vf vf_add(vf x, vf y) { return BINARY(vf, +, x, y); }
static inline vf vf_sub(vf x, vf y) { return BINARY(vf, -, x, y); }
static inline vf vf_mul(vf x, vf y) { return BINARY(vf, *, x, y); }
static inline vf vf_div(vf x, vf y) { return BINARY(vf, /, x, y); }
static inline vf vf_fma(vf x, vf y, vf z) { return vf_add(vf_mul(x, y), z); }
static inline vf vf_min(vf x, vf y) { return CALL2(min4, x, y); }
static inline vf vf_max(vf x, vf y) { return CALL2(max4, x, y); }
static inline vf vf_abs(vf x) { return EACH(vf, abs4(x.a), abs4(x.b), abs4(x.c), abs4(x.d)); }
static inline vm vf_less(vf x, vf y) { return BINARY(vm, <, x, y); }
static inline vm vm_none(void) {
  i4 z = {0, 0, 0, 0};
  return EACH(vm, z, z, z, z);
}
static inline vm vm_or(vm x, vm y) { return BINARY(vm, |, x, y); }
static inline vm vm_xor(vm x, vm y) { return BINARY(vm, ^, x, y); }

/* One bit a lane, in the order of lanes. */
static inline uint32_t vm_bits(vm m) {
  i4 bits = (m.a & (i4){1, 2, 4, 8}) | (m.b & (i4){1 << 4, 2 << 4, 4 << 4, 8 << 4}) |
            (m.c & (i4){1 << 8, 2 << 8, 4 << 8, 8 << 8}) |
            (m.d & (i4){1 << 12, 2 << 12, 4 << 12, 8 << 12});
  return (uint32_t)(bits[0] | bits[1] | bits[2] | bits[3]);
}

static inline v4 narrow(d2 x, d2 y) {
  return (v4){(float)x[0], (float)x[1], (float)y[0], (float)y[1]};
}
static inline d2 relative2(const double *x, double center) {
  d2 v;
  memcpy(&v, x, sizeof v);
  return v - (d2){center, center};
}
static inline v4 relative4(const double *x, double center) {
  return narrow(relative2(x, center), relative2(x + 2, center));
}
static inline vf vf_relative(const double *x, double c) {
  return EACH(vf, relative4(x, c), relative4(x + 4, c), relative4(x + 8, c), relative4(x + 12, c));
}

static inline d2 wrapped2(d2 d, double period, double inverse) {
  const double magic = 6755399441055744.0;
  d2 m = {magic, magic}, p = {period, period}, i = {inverse, inverse};
  return d - p * ((d * i + m) - m);
}
static inline v4 wrapped4(const double *x, double center, double period, double inverse) {
  return narrow(wrapped2(relative2(x, center), period, inverse),
                wrapped2(relative2(x + 2, center), period, inverse));
}
static inline vf vf_relative_wrapped(const double *x, double c, double period, double inverse) {
  return EACH(vf, wrapped4(x, c, period, inverse), wrapped4(x + 4, c, period, inverse),
              wrapped4(x + 8, c, period, inverse), wrapped4(x + 12, c, period, inverse));
}

static inline int64_t put_candidates(const sphi_candidates *c, int64_t at, int dim, int uniform,
                                     vf x, vf y, vf z, vf s, uint32_t first, uint32_t keep) {
  float lanes[4][W];
  int64_t begin = at;
  memcpy(lanes[0], &x, sizeof x);
  if (dim > 1) memcpy(lanes[1], &y, sizeof y);
  if (dim > 2) memcpy(lanes[2], &z, sizeof z);
  if (!uniform) memcpy(lanes[3], &s, sizeof s);
  for (; keep != 0; keep &= keep - 1, at++) {
    int lane = __builtin_ctz(keep);
    c->x[0][at] = lanes[0][lane];
    if (dim > 1) c->x[1][at] = lanes[1][lane];
    if (dim > 2) c->x[2][at] = lanes[2][lane];
    if (!uniform) c->s[at] = lanes[3][lane];
    c->index[at] = first + (uint32_t)lane;
  }
  return at - begin;
}

static inline uint32_t *put_indices(uint32_t *p, const uint32_t *from, uint32_t keep) {
  for (; keep != 0; keep &= keep - 1) *p++ = from[__builtin_ctz(keep)];
  return p;
}

static inline void copy_indices(uint32_t *to, const uint32_t *from) {
  memcpy(to, from, W * sizeof *to);
}

/* Lanes are collected for 64 candidates and then written: fewer loops, each of them longer. */
static inline void emit(uint32_t **out, uint64_t *waiting, const uint32_t *index, int64_t q,
                        uint32_t keep) {
  uint64_t bits = *waiting | (uint64_t)keep << (q & 48);
  *waiting = bits;
  if ((q & 48) != 48) return;
  uint32_t *p = *out;
  for (; bits != 0; bits &= bits - 1) *p++ = index[(q & ~INT64_C(63)) + __builtin_ctzll(bits)];
  *out = p;
  *waiting = 0;
}

static inline void emit_rest(uint32_t **out, uint64_t *waiting, const uint32_t *index,
                             int64_t count) {
  uint32_t *p = *out;
  for (uint64_t bits = *waiting; bits != 0; bits &= bits - 1)
    *p++ = index[(count - 1) / 64 * 64 + __builtin_ctzll(bits)];
  *out = p;
}

#define vd_bits(mask) ((uint32_t)(((mask)[0] & 1) | ((mask)[1] & 2)))

#include "search.inc"
