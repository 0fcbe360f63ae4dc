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

static double *saved_state(const sph_integrator *it) { return it->saved.ptr; }
static double *saved_eigen(const sph_integrator *it) {
  return (double *)it->saved.ptr + it->stride;
}

static void copy(void *to, const void *from, int64_t doubles) {
  if (doubles > 0) memcpy(to, from, (size_t)doubles * sizeof(double));
}

static void save_history(sph_integrator *it) {
  double *to = saved_eigen(it);
  if (!keeps_history(it)) return;
  copy(to, it->history.difference.ptr, it->stride);
  copy(to + it->stride, it->history.last_step.ptr, it->real_count);
  it->saved_array_step = it->history.array_step;
}

static void restore_history(sph_integrator *it) {
  const double *from = saved_eigen(it);
  if (!keeps_history(it)) return;
  copy(it->history.difference.ptr, from, it->stride);
  copy(it->history.last_step.ptr, from + it->stride, it->real_count);
  it->history.array_step = it->saved_array_step;
}

sph_status sph_integrator_save(sph_integrator *it, sph_particles *set) {
  sph_status status = check(it, set);
  if (status == SPH_OK) status = sphi_state_layout(it, set);
  if (status != SPH_OK) return status;
  const size_t bytes = sphi_mul(saved_doubles(it), sizeof(double));
  status = sphi_buffer_reserve(it->base.ctx, &it->saved, bytes);
  if (status != SPH_OK) return status;
  sphi_state_copy(it, saved_state(it), NULL);
  if (it->memory.has_vector) sphi_state_copy(it, saved_eigen(it), sphi_vector_eigen(it));
  save_history(it);
  for (int32_t k = 0; k < it->items; ++k) it->item[k].saved_n = it->item[k].n;
  it->saved_memory = it->memory;
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
  sphi_state_copy(it, NULL, saved_state(it));
  if (it->saved_memory.has_vector) sphi_state_copy(it, sphi_vector_eigen(it), saved_eigen(it));
  restore_history(it);
  it->memory = it->saved_memory;
  sphi_state_touch(it, set);
  return SPH_OK;
}
