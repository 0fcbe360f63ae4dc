/* The search loops in the compiler's own vectors of four floats, for every machine. */
#include "search.h"

#include <string.h>

#define W 4
#define ALL 0xfu
#define ROWS_AT_ONCE 1
#define SEARCH sphi_search_portable
typedef float vf __attribute__((vector_size(16)));
typedef int32_t vi __attribute__((vector_size(16)));
typedef vi vm; /* all bits of a lane */
typedef double vd __attribute__((vector_size(16)));

static inline vf vf_set(float x) { return (vf){x, x, x, x}; }
static inline vf vf_load(const float *p) {
  vf v;
  memcpy(&v, p, sizeof v);
  return v;
}
static inline vf vf_add(vf a, vf b) { return a + b; }
static inline vf vf_sub(vf a, vf b) { return a - b; }
static inline vf vf_mul(vf a, vf b) { return a * b; }
static inline vf vf_div(vf a, vf b) { return a / b; }
static inline vf vf_fma(vf a, vf b, vf c) { return a * b + c; }
static inline vf vf_min(vf a, vf b) {
  vi m = a < b;
  return (vf)(((vi)a & m) | ((vi)b & ~m));
}
static inline vf vf_max(vf a, vf b) {
  vi m = a > b;
  return (vf)(((vi)a & m) | ((vi)b & ~m));
}
static inline vf vf_abs(vf a) { return (vf)((vi)a & 0x7fffffff); }
static inline vm vf_less(vf a, vf b) { return a < b; }
static inline vm vm_none(void) { return (vm){0, 0, 0, 0}; }
static inline vm vm_or(vm a, vm b) { return a | b; }
static inline vm vm_xor(vm a, vm b) { return a ^ b; }
static inline uint32_t vm_bits(vm a) {
  vi m = a & (vi){1, 2, 4, 8};
  return (uint32_t)(m[0] | m[1] | m[2] | m[3]);
}

static inline vd vd_load(const double *p) {
  vd v;
  memcpy(&v, p, sizeof v);
  return v;
}

static inline vf join(vd a, vd b) {
  return (vf){(float)a[0], (float)a[1], (float)b[0], (float)b[1]};
}

static inline vf vf_relative(const double *x, double center) {
  vd c = {center, center};
  return join(vd_load(x) - c, vd_load(x + 2) - c);
}

static inline vd wrapped(vd d, double period, double inverse) {
  const double magic = 6755399441055744.0;
  vd m = {magic, magic}, p = {period, period}, i = {inverse, inverse};
  return d - p * ((d * i + m) - m);
}

static inline vf vf_relative_wrapped(const double *x, double center, double period,
                                     double inverse) {
  vd c = {center, center};
  return join(wrapped(vd_load(x) - c, period, inverse), wrapped(vd_load(x + 2) - c, period, inverse));
}

static inline void put_floats(float *p, vf v, uint32_t keep) {
  for (int l = 0; l < W; l++) {
    *p = v[l];
    p += keep >> l & 1u;
  }
}

/* first, first + 1, ... of the lanes kept */
static inline void put_counted(uint32_t *p, uint32_t first, uint32_t keep) {
  for (uint32_t l = 0; l < W; l++) {
    *p = first + l;
    p += keep >> l & 1u;
  }
}

static inline uint32_t *put_indices(uint32_t *p, const uint32_t *from, uint32_t keep) {
  for (int l = 0; l < W; l++) {
    *p = from[l];
    p += keep >> l & 1u;
  }
  return p;
}

static inline void copy_indices(uint32_t *to, const uint32_t *from) {
  memcpy(to, from, W * sizeof *to);
}

#include "search.inc"
