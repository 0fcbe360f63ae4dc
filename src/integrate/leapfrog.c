/* Kick-drift-kick leapfrog.
 *
 * V is kicked; everything else that is bound (X, density, energy, stress ..) drifts, for a stress
 * and a density stand to the velocity as a position does. With q = all but V:
 *
 *   v_h = v + dt/2 a(t, q, v)
 *   q_h = q + dt/2 q'(t, q, v)
 *   q1  = q + dt q'(t + dt/2, q_h, v_h)
 *   v_p = v + dt/2 (a + a_h)                      what the last force may need of the velocity
 *   v1  = v_h + dt/2 a(t + dt, q1, v_p)
 *
 * When X and V alone are bound the middle evaluation is spared: then q' = v + w, w = 0 but for
 * XSPH, and the drift is dt v_h + dt/2 (w + w1) with the trapezoidal rule for w. */
#include "integrate_impl.h"

enum {
  F0 = SPHI_VEC_RATE,
  FH = SPHI_VEC_RATE + 1, /* middle */
  F1 = SPHI_VEC_RATE + 2  /* end */
};

typedef struct piece_terms {
  int32_t count;
  const double *vector[4];
  double factor[4];
} piece_terms;

typedef struct piece_job {
  double *out;
  piece_terms terms;
} piece_job;

static void piece_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  const piece_job *p = job;
  (void)worker;
  for (int64_t i = begin; i < end; ++i) {
    double sum = p->terms.vector[0][i];
    for (int32_t m = 1; m < p->terms.count; ++m) sum += p->terms.factor[m] * p->terms.vector[m][i];
    p->out[i] = sum;
  }
}

/* item = start of the item + sum factor * rate of the item */
static void write_piece(sphi_step *step, int32_t k, int32_t count, const int32_t *rate,
                        const double *factor) {
  sph_integrator *it = step->it;
  int64_t at = it->item[k].offset;
  piece_job job = {it->item[k].y, {1 + count, {sphi_vector(it, SPHI_VEC_START) + at}, {1.0}}};
  for (int32_t m = 0; m < count; ++m) {
    job.terms.vector[1 + m] = sphi_vector(it, rate[m]) + at;
    job.terms.factor[1 + m] = factor[m];
  }
  if (it->item[k].n > 0)
    sphi_parallel(it->base.ctx, it->item[k].n, SPHI_STATE_GRAIN, piece_range, &job);
}

/* The stage that stands in place, and its rate. */
static sph_status finish_and_evaluate(sphi_step *step, double t, int32_t rate) {
  sph_status status = sphi_finish_stage(step, t, SPH_COPY_STAGE);
  return status == SPH_OK ? sphi_evaluate(step->it, step->set, t, sphi_vector(step->it, rate))
                          : status;
}

/* ---- with other fields: three evaluations ------------------------------------------------ */

/* V by one list of kicks, all others by another. */
static void write_split(sphi_step *step, int32_t kicks, const int32_t *kick,
                        const double *kick_factor, int32_t drift, double drift_factor) {
  sph_integrator *it = step->it;
  for (int32_t k = 0; k < it->items; ++k) {
    if (it->item[k].field == SPH_FIELD_V)
      write_piece(step, k, kicks, kick, kick_factor);
    else
      write_piece(step, k, 1, &drift, &drift_factor);
  }
}

static sph_status step_all(sphi_step *step) {
  static const int32_t predict[] = {F0, FH}, correct[] = {F0, F1};
  const double half[] = {0.5 * step->dt, 0.5 * step->dt};
  const double middle = step->t + 0.5 * step->dt, end = step->t + step->dt;
  step->info->stages = 3;
  write_split(step, 1, predict, half, F0, 0.5 * step->dt);
  sph_status status = finish_and_evaluate(step, middle, FH);
  if (status != SPH_OK) return status;
  write_split(step, 2, predict, half, FH, step->dt);
  status = finish_and_evaluate(step, end, F1);
  if (status != SPH_OK) return status;
  write_split(step, 2, correct, half, FH, step->dt);
  return sphi_finish_stage(step, end, SPH_COPY_RESULT);
}

/* ---- X and V alone: two evaluations ------------------------------------------------------ */

typedef struct drift_job {
  double *x;
  const double *x0, *v0, *a0, *dx0, *dx1; /* dx1 NULL in the prediction */
  double dt;
} drift_job;

/* x + dt (v + dt/2 a) + what the rate of X has beyond v, which is exactly 0 without XSPH. The
 * velocity of dx1 is the predicted one. */
static void drift_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  const drift_job *d = job;
  (void)worker;
  for (int64_t i = begin; i < end; ++i) {
    double half = d->v0[i] + 0.5 * d->dt * d->a0[i];
    double w = d->dx0[i] - d->v0[i];
    if (d->dx1) w = 0.5 * (w + (d->dx1[i] - (d->v0[i] + d->dt * d->a0[i])));
    d->x[i] = d->x0[i] + d->dt * (half + w);
  }
}

static void drift(sphi_step *step, int32_t final) {
  sph_integrator *it = step->it;
  const sphi_item *x = sphi_item_of(it, SPH_FIELD_X), *v = sphi_item_of(it, SPH_FIELD_V);
  const double *start = sphi_vector(it, SPHI_VEC_START);
  const double *rate = sphi_vector(it, F0);
  drift_job job = {x->y,
                   start + x->offset,
                   start + v->offset,
                   rate + v->offset,
                   rate + x->offset,
                   final ? sphi_vector(it, F1) + x->offset : NULL,
                   step->dt};
  if (x->n > 0) sphi_parallel(it->base.ctx, x->n, SPHI_STATE_GRAIN, drift_range, &job);
}

static sph_status step_motion(sphi_step *step) {
  static const int32_t rates[] = {F0, F1};
  const int32_t v = (int32_t)(sphi_item_of(step->it, SPH_FIELD_V) - step->it->item);
  const double half[] = {0.5 * step->dt, 0.5 * step->dt}, end = step->t + step->dt;
  step->info->stages = 2;
  drift(step, 0);
  write_piece(step, v, 1, rates, &step->dt);
  sph_status status = finish_and_evaluate(step, end, F1);
  if (status != SPH_OK) return status;
  write_piece(step, v, 2, rates, half);
  drift(step, 1);
  return sphi_finish_stage(step, end, SPH_COPY_RESULT);
}

sph_status sphi_leapfrog_step(sphi_step *step) {
  sph_integrator *it = step->it;
  sph_status status = sphi_evaluate(it, step->set, step->t, sphi_vector(it, F0));
  if (status != SPH_OK) return status;
  return it->items == 2 ? step_motion(step) : step_all(step);
}
