/* What the row loops see: one sweep made ready, with its record layout and broadcast constants. */
#ifndef SPHI_RUN_H
#define SPHI_RUN_H

#include "artificial.h"
#include "sweep.h"

/* Offsets in a record, in doubles; -1 where a field is not packed. */
typedef struct sphi_record {
  int x, v, m, rho, vol, c, h, p, q, s, t, r, f;
  int quads; /* record length / 4 */
} sphi_record;

/* Host arrays that are read or written a particle at a time. Where the host's order is not spatial
 * every access misses the caches, so the lines are asked for some particles ahead. */
enum { SPHI_MAX_STREAMS = 16 };
typedef struct sphi_streams {
  struct {
    const char *base;
    int64_t stride; /* bytes a particle */
  } at[SPHI_MAX_STREAMS];
  int count;
} sphi_streams;

typedef struct sphi_run {
  const sphi_sweep *sweep;
  const struct sph_neighbors *list;
  sphi_spec spec;
  sphi_record layout;
  sphi_streams in, out;
  double *records; /* layout.quads * 4 doubles a particle, in sweep order */
  int64_t rows;    /* host indices from here on get no results */
  int32_t h_rule;
  int32_t wrap;
  double period[3], inverse_period[3];
  double m0, h0, c0;
} sphi_run;

typedef void (*sphi_rows_fn)(const sphi_run *run, int64_t lo, int64_t hi);

/* Best instance of the loop for a spec and dimension; may clear bits of spec->uniform, which the
 * records must then hold. */
sphi_rows_fn sphi_rows_portable(sphi_spec *spec, int32_t dim);
sphi_rows_fn sphi_rows_avx2(sphi_spec *spec, int32_t dim);
sphi_rows_fn sphi_rows_avx512(sphi_spec *spec, int32_t dim);

/* Which arrays the records are made of, and which the rows write. */
void sphi_streams_of(sphi_run *run);

/* Fill the records [lo, hi) from the host arrays. */
void sphi_pack(const sphi_run *run, int64_t lo, int64_t hi);

#define SPHI_RUN_INLINE static inline __attribute__((always_inline, unused))

/* Which weight a form multiplies with. */
enum { SPHI_WEIGHT_ONE = 0, SPHI_WEIGHT_M = 1, SPHI_WEIGHT_VOL = 2 };

SPHI_RUN_INLINE int sphi_weight_continuity(int form) {
  return form == SPH_CONTINUITY_MASS     ? SPHI_WEIGHT_M
         : form == SPH_CONTINUITY_VOLUME ? SPHI_WEIGHT_VOL
                                         : SPHI_WEIGHT_ONE;
}
SPHI_RUN_INLINE int sphi_weight_pressure(int form) {
  return form == SPH_PRESSURE_MASS     ? SPHI_WEIGHT_M
         : form == SPH_PRESSURE_NUMBER ? SPHI_WEIGHT_ONE
                                       : SPHI_WEIGHT_VOL;
}
SPHI_RUN_INLINE int sphi_weight_stress(int form) {
  return form == SPH_STRESS_DIFFERENCE ? SPHI_WEIGHT_VOL : SPHI_WEIGHT_M;
}

SPHI_RUN_INLINE int sphi_needs_m(sphi_spec s) {
  return (s.terms & (SPHI_DENSITY | SPHI_MONAGHAN | SPHI_BULK | SPHI_XSPH | SPHI_ARTSTRESS)) ||
         ((s.terms & SPHI_CONTINUITY) && sphi_weight_continuity(s.continuity) == SPHI_WEIGHT_M) ||
         ((s.terms & SPHI_PRESSURE) && sphi_weight_pressure(s.pressure) == SPHI_WEIGHT_M) ||
         ((s.terms & SPHI_STRESS) && sphi_weight_stress(s.stress) == SPHI_WEIGHT_M);
}
SPHI_RUN_INLINE int sphi_needs_vol(sphi_spec s) {
  return (s.terms & (SPHI_GRADV | SPHI_MATRIX | SPHI_SHEPARD | SPHI_INTERP | SPHI_GRADF)) ||
         ((s.terms & SPHI_CONTINUITY) && sphi_weight_continuity(s.continuity) == SPHI_WEIGHT_VOL) ||
         ((s.terms & SPHI_PRESSURE) && sphi_weight_pressure(s.pressure) == SPHI_WEIGHT_VOL) ||
         ((s.terms & SPHI_STRESS) && sphi_weight_stress(s.stress) == SPHI_WEIGHT_VOL);
}
SPHI_RUN_INLINE int sphi_needs_v(sphi_spec s) {
  return (s.terms & (SPHI_CONTINUITY | SPHI_GRADV | SPHI_MONAGHAN | SPHI_XSPH)) != 0;
}
SPHI_RUN_INLINE int sphi_needs_w(sphi_spec s) {
  return (s.terms & (SPHI_DENSITY | SPHI_XSPH | SPHI_SHEPARD | SPHI_INTERP | SPHI_ARTSTRESS)) != 0;
}
SPHI_RUN_INLINE int sphi_needs_gradient(sphi_spec s) {
  return (s.terms & ~(uint32_t)(SPHI_DENSITY | SPHI_XSPH | SPHI_SHEPARD | SPHI_INTERP)) != 0;
}
SPHI_RUN_INLINE int sphi_sym(int dim) { return dim * (dim + 1) / 2; }

/* Ask for the lines of host index `i`; not where it follows `before`, for those are on their way.
 */
SPHI_RUN_INLINE void sphi_prefetch(const sphi_streams *s, int64_t before, int64_t i, int write) {
  if (i == before + 1) return;
  for (int k = 0; k < s->count; ++k) {
    const char *line = s->at[k].base + i * s->at[k].stride;
    if (write) {
      __builtin_prefetch(line, 1);
      if (s->at[k].stride > 8) __builtin_prefetch(line + s->at[k].stride - 1, 1);
    } else {
      __builtin_prefetch(line, 0);
      if (s->at[k].stride > 8) __builtin_prefetch(line + s->at[k].stride - 1, 0);
    }
  }
}

#define SPHI_PLACE(member, wanted, count) \
  do {                                    \
    y.member = (wanted) ? at : -1;        \
    at += (wanted) ? (count) : 0;         \
  } while (0)

/* The record of a spec; folds to constants in the compile-time instances. */
SPHI_RUN_INLINE sphi_record sphi_record_of(sphi_spec s, int dim) {
  sphi_record y;
  int at = 0;
  int stress = (s.terms & SPHI_STRESS) != 0;
  SPHI_PLACE(x, 1, dim);
  SPHI_PLACE(v, sphi_needs_v(s), dim);
  SPHI_PLACE(rho, (s.terms & (SPHI_MONAGHAN | SPHI_XSPH)) != 0, 1);
  SPHI_PLACE(p, (s.terms & SPHI_PRESSURE) != 0, 1);
  SPHI_PLACE(vol, sphi_needs_vol(s), 1);
  SPHI_PLACE(m, sphi_needs_m(s) && !(s.uniform & SPHI_UNIFORM_M), 1);
  SPHI_PLACE(h, !(s.uniform & SPHI_UNIFORM_H), 1);
  SPHI_PLACE(c, (s.terms & SPHI_MONAGHAN) && !(s.uniform & SPHI_UNIFORM_C), 1);
  SPHI_PLACE(q, (s.terms & SPHI_BULK) != 0, 1);
  SPHI_PLACE(s, stress && s.stress != SPH_STRESS_CONSERVATIVE, sphi_sym(dim));
  SPHI_PLACE(t, stress && s.stress == SPH_STRESS_CONSERVATIVE, dim * dim);
  SPHI_PLACE(r, (s.terms & SPHI_ARTSTRESS) != 0, sphi_sym(dim));
  SPHI_PLACE(f, (s.terms & (SPHI_INTERP | SPHI_GRADF)) != 0, SPHI_FIELD_WIDTH);
  y.quads = (at + 3) / 4;
  return y;
}

#undef SPHI_PLACE

#endif
