/* One slot in memory for the bound fields, for hosts that repeat steps. What decides the stages of
 * the next step is saved with them, so that a repeated step has the same bits. */
#include "integrate_impl.h"

#include <string.h>

static sph_status check(sph_integrator *it, const sph_particles *set) {
  sph_status status = sphi_check_handle(NULL, it, SPHI_MAGIC_INTEGRATOR, "integrator");
  if (status != SPH_OK) return status;
  sph_context *ctx = it->base.ctx;
  if (it->busy) return sphi_fail(ctx, SPH_ERR_STATE, "a step of this integrator is running");
  if (it->items == 0) return sphi_fail(ctx, SPH_ERR_STATE, "nothing is bound");
  if (set) return sphi_check_handle(ctx, set, SPHI_MAGIC_PARTICLES, "set");
  if (it->fields == 0) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_ARG, "set is NULL, but fields are bound");
}

static int32_t keeps_history(const sph_integrator *it) {
  return it->options.method == SPH_INTEGRATOR_LEAPFROG_PREDICTED;
}

/* State; then the eigenvector, or the history: differences and last steps. */
static size_t saved_doubles(const sph_integrator *it) {
  if (keeps_history(it)) return sphi_mul((size_t)it->stride, 2) + (size_t)it->real_count;
  return sphi_mul((size_t)it->stride, sphi_estimates(it) ? 2 : 1);
}

static void copy(void *to, const void *from, int64_t doubles) {
  if (doubles > 0) memcpy(to, from, (size_t)doubles * sizeof(double));
}

/* Into and out of an array of saved_doubles(). */
static void save_into(sph_integrator *it, double *to) {
  double *second = to + it->stride;
  sphi_state_copy(it, to, NULL);
  if (it->memory.has_vector) sphi_state_copy(it, second, sphi_vector_eigen(it));
  if (!keeps_history(it)) return;
  copy(second, it->history.difference.ptr, it->stride);
  copy(second + it->stride, it->history.last_step.ptr, it->real_count);
}

static void restore_from(sph_integrator *it, const double *from, const sphi_memory *memory) {
  const double *second = from + it->stride;
  sphi_state_copy(it, NULL, from);
  if (memory->has_vector) sphi_state_copy(it, sphi_vector_eigen(it), second);
  it->memory = *memory;
  if (!keeps_history(it)) return;
  copy(it->history.difference.ptr, second, it->stride);
  copy(it->history.last_step.ptr, second + it->stride, it->real_count);
}

/* ---- the slot ---------------------------------------------------------------------------- */

sph_status sph_integrator_save(sph_integrator *it, sph_particles *set) {
  sph_status status = check(it, set);
  if (status == SPH_OK) status = sphi_state_layout(it, set);
  if (status != SPH_OK) return status;
  const size_t bytes = sphi_mul(saved_doubles(it), sizeof(double));
  status = sphi_buffer_reserve(it->base.ctx, &it->saved, bytes);
  if (status != SPH_OK) return status;
  save_into(it, it->saved.ptr);
  for (int32_t k = 0; k < it->items; ++k) it->item[k].saved_n = it->item[k].n;
  it->saved_memory = it->memory;
  it->saved_array_step = it->history.array_step;
  it->has_saved = 1;
  return SPH_OK;
}

static sph_status check_sizes(sph_integrator *it) {
  for (int32_t k = 0; k < it->items; ++k)
    if (it->item[k].saved_n != it->item[k].n)
      return sphi_fail(it->base.ctx, SPH_ERR_STATE,
                       "bound item %d has %lld values, %lld when it was saved", (int)k,
                       (long long)it->item[k].n, (long long)it->item[k].saved_n);
  return SPH_OK;
}

sph_status sph_integrator_restore(sph_integrator *it, sph_particles *set) {
  sph_status status = check(it, set);
  if (status != SPH_OK) return status;
  if (!it->has_saved) return sphi_fail(it->base.ctx, SPH_ERR_STATE, "nothing is saved");
  status = sphi_state_layout(it, set);
  if (status == SPH_OK) status = check_sizes(it);
  if (status != SPH_OK) return status;
  restore_from(it, it->saved.ptr, &it->saved_memory);
  it->history.array_step = it->saved_array_step;
  sphi_state_touch(it, set);
  return SPH_OK;
}

/* ---- a buffer of the host ---------------------------------------------------------------- */

/* Before the doubles. */
typedef struct state_head {
  uint64_t magic, bytes; /* of all */
  int64_t real_count, stride;
  int32_t method, items;
  int64_t n[SPHI_ITEMS_MAX];
  double array_step;
  sphi_memory memory;
} state_head;

static const uint64_t state_magic = UINT64_C(0x31746154736e5053);

static size_t state_bytes(const sph_integrator *it) {
  return sizeof(state_head) + sphi_mul(saved_doubles(it), sizeof(double));
}

static state_head head_of(const sph_integrator *it) {
  state_head head;
  memset(&head, 0, sizeof head); /* padding too */
  head.magic = state_magic;
  head.bytes = state_bytes(it);
  head.real_count = it->real_count;
  head.stride = it->stride;
  head.method = it->options.method;
  head.items = it->items;
  for (int32_t k = 0; k < it->items; ++k) head.n[k] = it->item[k].n;
  head.array_step = it->history.array_step;
  head.memory = it->memory;
  return head;
}

/* The layout of a call with a buffer, and whether that has room. */
static sph_status begin_buffer(sph_integrator *it, sph_particles *set, const void *buffer,
                               size_t bytes) {
  sph_status status = check(it, set);
  if (status == SPH_OK) status = sphi_state_layout(it, set);
  if (status != SPH_OK) return status;
  if (buffer == NULL || (uintptr_t)buffer % sizeof(double) != 0)
    return sphi_fail(it->base.ctx, SPH_ERR_ARG, "the buffer of the state is %s",
                     buffer ? "not aligned as doubles are" : "NULL");
  if (bytes >= state_bytes(it)) return SPH_OK;
  return sphi_fail(it->base.ctx, SPH_ERR_ARG, "the buffer has %zu bytes, the state %zu", bytes,
                   state_bytes(it));
}

sph_status sph_integrator_state_size(sph_integrator *it, sph_particles *set, size_t *bytes) {
  sph_status status = check(it, set);
  if (status == SPH_OK && bytes == NULL)
    status = sphi_fail(it->base.ctx, SPH_ERR_ARG, "bytes is NULL");
  if (status == SPH_OK) status = sphi_state_layout(it, set);
  if (status == SPH_OK) *bytes = state_bytes(it);
  return status;
}

sph_status sph_integrator_state_write(sph_integrator *it, sph_particles *set, void *buffer,
                                      size_t bytes) {
  sph_status status = begin_buffer(it, set, buffer, bytes);
  if (status != SPH_OK) return status;
  const state_head head = head_of(it);
  memset(buffer, 0, state_bytes(it)); /* between items, too */
  memcpy(buffer, &head, sizeof head);
  save_into(it, (double *)((char *)buffer + sizeof head));
  return SPH_OK;
}

static sph_status check_head(const sph_integrator *it, const state_head *head) {
  const state_head mine = head_of(it);
  if (head->magic != state_magic || (head->memory.has_vector && !sphi_estimates(it)))
    return sphi_fail(it->base.ctx, SPH_ERR_ARG, "the buffer holds no state of an integrator");
  if (head->bytes == mine.bytes && head->real_count == mine.real_count &&
      head->stride == mine.stride && head->method == mine.method && head->items == mine.items &&
      memcmp(head->n, mine.n, sizeof mine.n) == 0)
    return SPH_OK;
  return sphi_fail(it->base.ctx, SPH_ERR_ARG,
                   "the state is of method %d with %d items and %lld particles, not of method %d "
                   "with %d items and %lld particles",
                   (int)head->method, (int)head->items, (long long)head->real_count,
                   (int)mine.method, (int)mine.items, (long long)mine.real_count);
}

sph_status sph_integrator_state_read(sph_integrator *it, sph_particles *set, const void *buffer,
                                     size_t bytes) {
  state_head head;
  sph_status status = begin_buffer(it, set, buffer, bytes);
  if (status != SPH_OK) return status;
  memcpy(&head, buffer, sizeof head);
  status = check_head(it, &head);
  if (status != SPH_OK) return status;
  restore_from(it, (const double *)((const char *)buffer + sizeof head), &head.memory);
  it->history.array_step = head.array_step;
  sphi_state_touch(it, set);
  return SPH_OK;
}
