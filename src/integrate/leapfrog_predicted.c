/* The leapfrog with predicted values of Zisis (4.29) to (4.34): one evaluation a step.
 *
 * y = all that is bound but X. What an integrator must keep from one step to the next is y^(k-1/2);
 * the history holds it as the difference y^k - y^(k-1/2), so that what a host adds to y between two
 * steps is added to both. While |y^k - y^(k-1/2)| < |y^k| / 2 the half-step value comes back to the
 * bit. A particle without history has the difference 0 and the last step 0, which makes the general
 * formula the source's start y^(1/2) = y^0 + f^0 dt/2. */
#include "integrate_impl.h"

enum { F = SPHI_VEC_RATE, HALF = SPHI_VEC_RATE + 1 };

typedef struct kick_job {
  double *half, *y;
  const double *y0, *f;
  const double *difference; /* y^k - y^(k-1/2) */
  const double *last_step;  /* of each particle; NULL: array_step for all */
  int64_t components;
  double array_step, dt;
} kick_job;

/* y^(k+1/2) = y^(k-1/2) + f^k (dt^(k-1) + dt^k) / 2 */
static void kick_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  const kick_job *k = job;
  (void)worker;
  for (int64_t i = begin; i < end; ++i) {
    double last = k->last_step ? k->last_step[i / k->components] : k->array_step;
    k->half[i] = k->y0[i] - k->difference[i] + 0.5 * (last + k->dt) * k->f[i];
  }
}

/* y^(k+1) = y^(k+1/2) + f^k dt^k / 2 */
static void predict_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  const kick_job *k = job;
  (void)worker;
  for (int64_t i = begin; i < end; ++i) k->y[i] = k->half[i] + 0.5 * k->dt * k->f[i];
}

static void each_item(sphi_step *step, sph_loop_fn loop) {
  sph_integrator *it = step->it;
  const sphi_history *h = &it->history;
  for (int32_t k = 0; k < it->items; ++k) {
    const sphi_item *item = &it->item[k];
    if (item->n == 0 || item->field == SPH_FIELD_X) continue;
    kick_job job = {.half = sphi_vector(it, HALF) + item->offset,
                    .y = item->y,
                    .y0 = sphi_vector(it, SPHI_VEC_START) + item->offset,
                    .f = sphi_vector(it, F) + item->offset,
                    .difference = (const double *)h->difference.ptr + item->offset,
                    .last_step = item->field >= 0 ? h->last_step.ptr : NULL,
                    .components = item->field >= 0 ? item->n / it->real_count : 1,
                    .array_step = h->array_step,
                    .dt = step->dt};
    sphi_parallel(it->base.ctx, item->n, SPHI_STATE_GRAIN, loop, &job);
  }
}

typedef struct drift_job {
  double *x, *next;
  const double *x0, *rate, *v0, *half;
  const double *difference, *last_step;
  int64_t components;
  double dt;
} drift_job;

/* x^(k+1) = x^k + v^(k+1/2) dt. What the rate of X has beyond v^k, exactly 0 without XSPH, is
 * integrated like y; w^k dt/2 is its difference. */
static void drift_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  const drift_job *d = job;
  (void)worker;
  for (int64_t i = begin; i < end; ++i) {
    const double w = d->rate[i] - d->v0[i], last = d->last_step[i / d->components];
    const double other = 0.5 * (last + d->dt) * w - d->difference[i];
    d->next[i] = 0.5 * d->dt * w;
    d->x[i] = d->x0[i] + d->dt * d->half[i] + (other + d->next[i]);
  }
}

/* The slot of X among the half-step values receives its next difference. */
static void drift(sphi_step *step) {
  sph_integrator *it = step->it;
  const sphi_item *x = sphi_item_of(it, SPH_FIELD_X), *v = sphi_item_of(it, SPH_FIELD_V);
  if (!x || x->n == 0) return;
  const double *start = sphi_vector(it, SPHI_VEC_START);
  drift_job job = {.x = x->y,
                   .next = sphi_vector(it, HALF) + x->offset,
                   .x0 = start + x->offset,
                   .rate = sphi_vector(it, F) + x->offset,
                   .v0 = start + v->offset,
                   .half = sphi_vector(it, HALF) + v->offset,
                   .difference = (const double *)it->history.difference.ptr + x->offset,
                   .last_step = it->history.last_step.ptr,
                   .components = x->n / it->real_count,
                   .dt = step->dt};
  sphi_parallel(it->base.ctx, x->n, SPHI_STATE_GRAIN, drift_range, &job);
}

sph_status sphi_leapfrog_predicted_step(sphi_step *step) {
  sph_integrator *it = step->it;
  const double end = step->t + step->dt;
  sph_status status = sphi_evaluate(it, step->set, step->t, sphi_vector(it, F));
  if (status != SPH_OK) return status;
  each_item(step, kick_range);
  status = sphi_filter_half(step, step->t + 0.5 * step->dt, sphi_vector(it, HALF));
  if (status != SPH_OK) return status;
  drift(step);
  each_item(step, predict_range);
  step->info->stages = 1;
  return sphi_finish_stage(step, end, SPH_COPY_RESULT);
}

/* ---- what stays for the next step -------------------------------------------------------- */

typedef struct keep_job {
  double *difference;
  const double *y, *half;
} keep_job;

static void keep_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  const keep_job *k = job;
  (void)worker;
  for (int64_t i = begin; i < end; ++i) k->difference[i] = k->y ? k->y[i] - k->half[i] : k->half[i];
}

void sphi_leapfrog_predicted_keep(sphi_step *step) {
  sph_integrator *it = step->it;
  for (int32_t k = 0; k < it->items; ++k) {
    const sphi_item *item = &it->item[k];
    keep_job job = {(double *)it->history.difference.ptr + item->offset,
                    item->field == SPH_FIELD_X ? NULL : item->y,
                    sphi_vector(it, HALF) + item->offset};
    if (item->n > 0) sphi_parallel(it->base.ctx, item->n, SPHI_STATE_GRAIN, keep_range, &job);
  }
  sphi_history_stamp(it, step->dt);
}
