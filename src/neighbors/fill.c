/* Filling the pair list, in waves.
 *
 * Rows are of unknown length and must lie one after the other, on any number of threads. So
 * chunks of rows are searched in parallel into slots of scratch memory, which stay in the
 * cache; then their places are known, and the next wave begins by copying them there. The list
 * depends on neither the cut into chunks nor the number of threads.
 *
 * Chunks are cut so that slots will do if rows get no longer than the longest lately. A slot or a
 * candidate buffer that is too small all the same ends its chunk early: rows done so far count,
 * what follows is searched again. The pair array itself starts from an estimate (a sample of
 * groups) and grows when that was too low. */
#include "search.h"

#include <math.h>
#include <string.h>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

enum {
  CHUNK = 1024,   /* most rows of a chunk */
  SLOTS_EACH = 4, /* slots a worker: for balance */
  ROOM = 256,     /* pairs that a slot has at first for each row of a chunk */
  FIRST_CANDIDATES = 4096,
  ARRAYS = 8,    /* of candidates: see sphi_candidates */
  SKEW = 80,     /* so that candidate arrays do not start at the same cache sets */
  SAMPLES = 384, /* most samples, of so many rows, one for so many of all rows */
  SAMPLE_ROWS = 8,
  SAMPLE_EVERY = 256,
  KEEP_GRAIN = 1 << 16,
  LARGE_LIST = 1 << 25 /* bytes; larger than what caches keep */
};

static const int64_t large_slot = (int64_t)1 << 22; /* pairs */
/* Chunks are meant to fill this part of a slot: rows may get three times longer from one wave to
 * the next. What is not used of a slot is never touched. */
static const double part_of_slot = 1.0 / 3.0;

typedef struct slot {
  int64_t begin, end, done; /* rows: asked for, and first one not done */
  int64_t count;            /* pairs found */
  int64_t place;            /* where they go; -1: nothing to copy */
  int64_t need_candidates, need_pairs;
  int64_t ready, ready_end; /* rows that wait for copying */
  int64_t ready_count;
  char pad[48];
} slot;

typedef struct fill {
  sph_neighbors *list;
  sph_context *ctx;
  sphi_layout *l;
  sphi_pairs *p;
  const sphi_search *search;
  slot *slots;
  int64_t slot_count;
  int64_t next;  /* first row that is not yet placed */
  int64_t total; /* pairs placed */
  int64_t most;  /* rows of a chunk, at most: for the balance of small sets */
  double recent; /* pairs of a row: the mean of the chunk with the longest rows of the last wave */
  int64_t samples;
  float sample[SAMPLES]; /* pairs of a row, here and there */
} fill;

/* --- one chunk --- */

static sphi_candidates candidates_of(const fill *f, int32_t worker) {
  size_t stride = (size_t)f->p->candidate_capacity + SPHI_CANDIDATE_PADDING + SKEW;
  float *base = (float *)f->p->b_candidates.ptr + ARRAYS * stride * (size_t)worker;
  sphi_candidates c;
  for (size_t a = 0; a < 3; a++) c.x[a] = base + a * stride;
  c.s = base + 3 * stride;
  c.index = (uint32_t *)(void *)(base + 4 * stride);
  for (size_t r = 0; r < 3; r++) c.row[r] = (uint32_t *)(void *)(base + (5 + r) * stride);
  c.count = 0;
  c.capacity = f->p->candidate_capacity;
  return c;
}

static uint32_t *slot_memory(const fill *f, int64_t s) {
  return (uint32_t *)f->p->b_slots.ptr + s * (f->p->slot_capacity + SPHI_CANDIDATE_PADDING);
}

/* The cell or leaf that holds a row; 0 for all pairs. */
static uint32_t home_of(const sphi_layout *l, int64_t row) {
  if (l->method == SPH_NEIGHBORS_TREE) return sphi_tree_leaf_at(&l->tree, (uint32_t)row);
  if (l->method == SPH_NEIGHBORS_ALL_PAIRS) return 0;
  return sphi_cells_at(&l->cells, (uint32_t)row);
}

/* End of the group that begins at a row, which may lie beyond the present home. */
static int64_t group_end(const sphi_layout *l, int64_t row, int64_t end, uint32_t *home) {
  int64_t stop = row + SPHI_BLOCK;
  if (l->method != SPH_NEIGHBORS_ALL_PAIRS) {
    const uint32_t *first = l->method == SPH_NEIGHBORS_TREE ? l->tree.leaf : l->cells.first;
    while (first[*home + 1] <= row) ++*home;
    stop = first[*home + 1];
  }
  return stop < end ? stop : end;
}

/* The candidate ranges of a group, some at a time. */
typedef struct candidate_walk {
  const sphi_group *g;
  uint32_t home;
  int done;
  sphi_walk tree;
} candidate_walk;

static void begin_walk(candidate_walk *w, const sphi_search *search, const sphi_group *g,
                       uint32_t home) {
  const sphi_layout *l = g->l;
  w->g = g;
  w->home = home;
  w->done = 0;
  if (l->method == SPH_NEIGHBORS_TREE)
    sphi_walk_begin(&w->tree, &l->tree, &l->rule, search->boxes, g->center, g->half, g->s, -1.0);
}

/* 0 when there are no more. */
static int next_ranges(candidate_walk *w, sphi_range *out) {
  const sphi_layout *l = w->g->l;
  if (l->method == SPH_NEIGHBORS_TREE) return sphi_walk_ranges(&w->tree, out);
  if (w->done++ > 0) return 0;
  if (l->method != SPH_NEIGHBORS_ALL_PAIRS)
    return sphi_cells_ranges(&l->cells, l->dim, w->home, out);
  out[0] = (sphi_range){0, (uint32_t)l->n};
  return 1;
}

static int64_t length_of(const sphi_range *r, int count) {
  int64_t sum = 0;
  for (int k = 0; k < count; k++) sum += r[k].end - r[k].begin;
  return sum;
}

/* Gather the candidates of a group, walking with the best loops there are: 0, or the capacity that
 * would be needed so far. */
static int64_t gather(const sphi_search *best, const sphi_search *search, const sphi_group *g,
                      uint32_t home, sphi_candidates *c) {
  sphi_range ranges[SPHI_MAX_RANGES];
  candidate_walk walk;
  int n;
  c->count = 0;
  begin_walk(&walk, best, g, home);
  while ((n = next_ranges(&walk, ranges)) > 0) {
    int64_t most = c->count + length_of(ranges, n);
    if (most > c->capacity) return most;
    search->gather(g, ranges, n, c);
  }
  return 0;
}

static void search_chunk(const fill *f, slot *s, uint32_t *out, int32_t worker) {
  sphi_candidates c = candidates_of(f, worker);
  uint32_t home = home_of(f->l, s->begin);
  sphi_group g;
  s->done = s->begin;
  s->count = s->need_candidates = s->need_pairs = 0;
  while (s->done < s->end) {
    int64_t end = group_end(f->l, s->done, s->end, &home), done;
    sphi_group_set(&g, f->l, s->done, end);
    const sphi_search *search = g.single ? f->search : &sphi_search_exact;
    s->need_candidates = gather(f->search, search, &g, home, &c);
    if (s->need_candidates > 0) return;
    done = search->rows(&g, &c, out, f->p->slot_capacity, &s->count, f->l->start);
    s->done += done;
    if (s->done == end) continue;
    s->need_pairs = c.count + SPHI_CANDIDATE_PADDING;
    return;
  }
}

/* Past the caches: a list this long is not found there again, and so is not read before it is
 * overwritten. */
static void copy_past_caches(uint32_t *to, const uint32_t *from, int64_t count) {
#if defined(__SSE2__)
  int64_t k = 0;
  for (; k < count && ((uintptr_t)(to + k) & 63u) != 0; k++) to[k] = from[k];
  for (; k + 16 <= count; k += 16) {
    const __m128i *p = (const __m128i *)(const void *)(from + k);
    __m128i a = _mm_loadu_si128(p), b = _mm_loadu_si128(p + 1);
    __m128i c = _mm_loadu_si128(p + 2), d = _mm_loadu_si128(p + 3);
    __m128i *q = (__m128i *)(void *)(to + k);
    _mm_stream_si128(q, a);
    _mm_stream_si128(q + 1, b);
    _mm_stream_si128(q + 2, c);
    _mm_stream_si128(q + 3, d);
  }
  for (; k < count; k++) to[k] = from[k];
  _mm_sfence();
#else
  memcpy(to, from, (size_t)count * sizeof *to);
#endif
}

/* Put a finished chunk in its place. */
static void place_chunk(const fill *f, slot *s, const uint32_t *from) {
  if (f->p->b_pair.bytes > LARGE_LIST)
    copy_past_caches(f->list->pair + s->place, from, s->ready_count);
  else
    memcpy(f->list->pair + s->place, from, (size_t)s->ready_count * sizeof *from);
  for (int64_t i = s->ready; i < s->ready_end; i++) f->l->start[i] += s->place;
  s->place = -1;
}

static void wave_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  const fill *f = job;
  for (int64_t k = begin; k < end; k++) {
    slot *s = &f->slots[k];
    uint32_t *memory = slot_memory(f, k);
    if (s->place >= 0) place_chunk(f, s, memory);
    if (s->begin < s->end) search_chunk(f, s, memory, worker);
  }
}

/* --- memory --- */

static sph_status reserve_buffers(fill *f, int64_t candidates, int64_t pairs) {
  sphi_pairs *p = f->p;
  size_t stride = (size_t)candidates + SPHI_CANDIDATE_PADDING + SKEW;
  size_t each = (size_t)pairs + SPHI_CANDIDATE_PADDING;
  size_t workers = (size_t)sphi_workers(f->ctx);
  sph_status s = sphi_buffer_reserve(f->ctx, &p->b_candidates,
                                     sphi_mul(workers * ARRAYS * sizeof(float), stride));
  if (s != SPH_OK) return s;
  p->candidate_capacity = candidates;
  s = sphi_buffer_reserve(f->ctx, &p->b_slots,
                          sphi_mul((size_t)f->slot_count * sizeof(uint32_t), each));
  if (s == SPH_OK) p->slot_capacity = pairs;
  return s;
}

static int64_t pair_capacity(const sphi_pairs *p) {
  return (int64_t)(p->b_pair.bytes / sizeof(uint32_t)) - SPHI_ROW_PADDING;
}

typedef struct keep_job {
  uint32_t *to;
  const uint32_t *from;
} keep_job;

static void keep_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  const keep_job *k = job;
  (void)worker;
  memcpy(k->to + begin, k->from + begin, (size_t)(end - begin) * sizeof *k->to);
}

/* Room for `need` pairs, keeping what is placed. The old array stays until the new one is there. */
static sph_status grow_pairs(fill *f, int64_t need, int64_t placed) {
  sphi_buffer old = f->p->b_pair, new = {NULL, 0};
  size_t bytes = sphi_mul((size_t)need + SPHI_ROW_PADDING, sizeof(uint32_t));
  sph_status s = sphi_buffer_reserve(f->ctx, &new, bytes);
  if (s != SPH_OK) return s;
  keep_job keep = {new.ptr, old.ptr};
  sphi_parallel(f->ctx, placed, KEEP_GRAIN, keep_body, &keep);
  f->p->b_pair = new;
  f->list->pair = new.ptr;
  sphi_buffer_free(f->ctx, &old);
  return SPH_OK;
}

void sphi_pairs_free(sph_context *ctx, sphi_pairs *p) {
  sphi_buffer_free(ctx, &p->b_candidates);
  sphi_buffer_free(ctx, &p->b_slots);
  sphi_buffer_free(ctx, &p->b_rows);
  sphi_buffer_free(ctx, &p->b_pair);
}

/* --- waves --- */

static void run_wave(fill *f) { sphi_parallel(f->ctx, f->slot_count, 1, wave_body, f); }

static void no_chunks(fill *f) {
  for (int64_t k = 0; k < f->slot_count; k++) f->slots[k].begin = f->slots[k].end = 0;
}

/* Copy what waits, without searching. */
static void flush(fill *f) {
  no_chunks(f);
  run_wave(f);
}

/* Rows that a chunk beginning here should have: as if all were as long as the longest of the last
 * wave and of the samples around. */
static int64_t rows_of_chunk(const fill *f, int64_t row) {
  int64_t at = (int64_t)((double)row * (double)f->samples / (double)f->l->n);
  double longest = fmax(f->recent, 1.0);
  for (int64_t k = at > 0 ? at - 1 : 0; k < f->samples && k <= at + 1; k++)
    longest = fmax(longest, (double)f->sample[k]);
  double rows = part_of_slot * (double)f->p->slot_capacity / longest;
  return rows < SPHI_BLOCK ? SPHI_BLOCK : rows > (double)f->most ? f->most : (int64_t)rows;
}

static void hand_out_chunks(fill *f) {
  int64_t row = f->next;
  no_chunks(f);
  for (int64_t k = 0; k < f->slot_count && row < f->l->n; k++) {
    int64_t rows = rows_of_chunk(f, row);
    f->slots[k].begin = row;
    row = f->l->n - row < rows ? f->l->n : row + rows;
    f->slots[k].end = row;
  }
}

/* Room for `need` pairs up to row `next`; nothing waits for copying now. */
static sph_status make_room(fill *f, int64_t need, int64_t next) {
  int64_t most = f->list->options.max_pairs;
  if (most > 0 && need > most)
    return sphi_fail(f->ctx, SPH_ERR_LIMIT, "the particles have more than max_pairs = %lld pairs",
                     (long long)most);
  if (need <= pair_capacity(f->p)) return SPH_OK;
  double expected = 1.05 * (double)need * (double)f->l->n / (double)next;
  int64_t more = need + need / 8;
  if (expected < 2.0 * (double)need) more = (int64_t)expected;
  return grow_pairs(f, more + 4096, f->total);
}

/* Chunks of the wave that count: all up to the first one that ended early. */
static int64_t usable_slots(const fill *f, int64_t *pairs, int64_t *next) {
  int64_t k = 0;
  *pairs = f->total;
  *next = f->next;
  for (; k < f->slot_count && f->slots[k].begin < f->slots[k].end; k++) {
    *pairs += f->slots[k].count;
    *next = f->slots[k].done;
    if (f->slots[k].done < f->slots[k].end) return k + 1;
  }
  return k;
}

static sph_status assign_places(fill *f) {
  int64_t pairs, next, usable = usable_slots(f, &pairs, &next);
  sph_status status = make_room(f, pairs, next);
  if (status != SPH_OK) return status;
  for (int64_t k = 0; k < usable; k++) {
    slot *s = &f->slots[k];
    s->ready = s->begin;
    s->ready_end = s->done;
    s->ready_count = s->count;
    s->place = f->total;
    f->total += s->count;
  }
  f->next = next;
  return SPH_OK;
}

static double row_length(const slot *s) {
  return s->done > s->begin ? (double)s->count / (double)(s->done - s->begin) : 0.0;
}

static double longest_rows(const fill *f) {
  double longest = 0.0;
  for (int64_t k = 0; k < f->slot_count && f->slots[k].begin < f->slots[k].end; k++)
    longest = fmax(longest, row_length(&f->slots[k]));
  return longest;
}

/* After a wave: larger buffers where a chunk ended early. */
static sph_status adapt(fill *f) {
  sphi_pairs *p = f->p;
  int64_t candidates = p->candidate_capacity, pairs = p->slot_capacity;
  f->recent = longest_rows(f);
  for (int64_t k = 0; k < f->slot_count; k++) {
    const slot *s = &f->slots[k];
    if (s->done >= s->end) continue;
    int64_t done = s->done - s->begin;
    if (s->need_candidates > candidates) candidates = s->need_candidates + s->need_candidates / 2;
    if (done == 0 && s->need_pairs > pairs) pairs = 2 * s->need_pairs;
    if (done < SPHI_BLOCK && s->need_pairs > 0 && 2 * p->slot_capacity <= large_slot)
      pairs = pairs > 2 * p->slot_capacity ? pairs : 2 * p->slot_capacity;
  }
  if (candidates == p->candidate_capacity && pairs == p->slot_capacity) return SPH_OK;
  flush(f);
  return reserve_buffers(f, candidates, pairs);
}

static sph_status run_waves(fill *f) {
  sph_status s = SPH_OK;
  while (f->next < f->l->n && s == SPH_OK) {
    hand_out_chunks(f);
    run_wave(f);
    s = assign_places(f);
    if (s == SPH_OK) s = adapt(f);
    if (s == SPH_OK) s = sphi_progress(f->ctx, (double)f->next / (double)f->l->n, "neighbours");
  }
  if (s == SPH_OK) flush(f);
  return s;
}

/* --- the estimate --- */

static void sample_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  fill *f = job;
  int64_t n = f->l->n;
  for (int64_t k = begin; k < end; k++) {
    slot s;
    memset(&s, 0, sizeof s);
    s.begin = (int64_t)((double)n * ((double)k + 0.5) / (double)f->samples);
    s.end = s.begin + SAMPLE_ROWS < n ? s.begin + SAMPLE_ROWS : n;
    search_chunk(f, &s, slot_memory(f, worker), worker);
    f->sample[k] = (float)row_length(&s);
  }
}

/* Pairs of a few rows here and there, extrapolated; on the safe side, by the standard error of
 * the mean. */
static double estimate(fill *f) {
  double sum = 0.0, squares = 0.0;
  f->samples = f->l->n / SAMPLE_EVERY + 1;
  if (f->samples > SAMPLES) f->samples = SAMPLES;
  /* each worker needs a slot */
  int64_t grain = f->slot_count < sphi_workers(f->ctx) ? SAMPLES : 1;
  sphi_parallel(f->ctx, f->samples, grain, sample_body, f);
  for (int64_t k = 0; k < f->samples; k++) sum += (double)f->sample[k];
  double mean = sum / (double)f->samples;
  for (int64_t k = 0; k < f->samples; k++)
    squares += ((double)f->sample[k] - mean) * ((double)f->sample[k] - mean);
  return (mean + sqrt(squares) / (double)f->samples) * (double)f->l->n;
}

/* Begin with an array that will probably do; a little short is left to growth. */
static sph_status begin_pairs(fill *f) {
  double expected = estimate(f);
  double most = (double)f->list->options.max_pairs;
  if (most > 0.0 && expected > most) expected = most;
  if (expected <= 1.02 * (double)pair_capacity(f->p) && f->p->b_pair.ptr != NULL) return SPH_OK;
  if (expected > 4e18) expected = 4e18;
  return grow_pairs(f, (int64_t)(1.02 * expected) + 4096, 0);
}

static void finish(fill *f) {
  f->l->start[f->l->n] = f->total;
  memset(f->list->pair + f->total, 0, SPHI_ROW_PADDING * sizeof(uint32_t));
}

static sph_status set_up(fill *f) {
  int64_t workers = sphi_workers(f->ctx), blocks = f->l->n / SPHI_BLOCK + 1;
  f->slot_count = workers == 1 ? 1 : workers * SLOTS_EACH < blocks ? workers * SLOTS_EACH : blocks;
  f->most = f->l->n / f->slot_count;
  f->most = f->most < SPHI_BLOCK ? SPHI_BLOCK : f->most > CHUNK ? CHUNK : f->most;
  int64_t candidates = f->p->candidate_capacity, pairs = f->p->slot_capacity;
  if (candidates == 0) candidates = FIRST_CANDIDATES;
  if (pairs < ROOM * f->most) pairs = ROOM * f->most;
  sph_status s = sphi_buffer_reserve(f->ctx, &f->p->b_rows, (size_t)f->slot_count * sizeof(slot));
  if (s == SPH_OK) s = reserve_buffers(f, candidates, pairs);
  if (s != SPH_OK) return s;
  f->slots = f->p->b_rows.ptr;
  memset(f->slots, 0, (size_t)f->slot_count * sizeof(slot));
  for (int64_t k = 0; k < f->slot_count; k++) f->slots[k].place = -1;
  return SPH_OK;
}

sph_status sphi_fill(sph_neighbors *list, sphi_layout *l) {
  sph_context *ctx = list->base.ctx;
  fill f = {
      .list = list, .ctx = ctx, .l = l, .p = &list->priv->pairs, .search = sphi_search_of(ctx)};
  sph_status s = set_up(&f);
  if (s == SPH_OK && l->n > 0) s = begin_pairs(&f);
  if (s == SPH_OK && f.p->b_pair.ptr == NULL) s = grow_pairs(&f, 0, 0);
  if (s == SPH_OK) s = run_waves(&f);
  if (s == SPH_OK) finish(&f);
  return s;
}

/* --- after a failure --- */

/* The row lengths of the old layout are known, so each row goes straight to its place. */
static void restore_body(void *job, int64_t begin, int64_t end, int32_t worker) {
  const fill *f = job;
  sphi_range ranges[SPHI_MAX_RANGES];
  (void)worker;
  for (int64_t i = begin; i < end; i++) {
    sphi_group g;
    candidate_walk walk;
    int64_t at = f->l->start[i];
    int n;
    sphi_group_set(&g, f->l, i, i + 1);
    begin_walk(&walk, f->search, &g, home_of(f->l, i));
    while ((n = next_ranges(&walk, ranges)) > 0)
      for (int k = 0; k < n; k++)
        for (uint32_t j = ranges[k].begin; j < ranges[k].end; j++)
          if (sphi_is_pair(f->l, i, j)) f->list->pair[at++] = j;
  }
}

void sphi_fill_again(sph_neighbors *list, sphi_layout *l) {
  fill f = {.list = list,
            .ctx = list->base.ctx,
            .l = l,
            .total = l->start[l->n],
            .search = sphi_search_of(list->base.ctx)};
  sphi_parallel(f.ctx, l->n, SPHI_BLOCK, restore_body, &f);
  finish(&f);
}
