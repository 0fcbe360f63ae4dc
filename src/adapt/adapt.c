/* sph_adapt_smoothing(): rounds over all particles. In each the list is built for the lengths that
 * the particles may need, those that are still under way are solved as far as their reach goes, and
 * get a longer one if it did not do. Nothing of the set is written before all is known. */
#include "adapt_impl.h"

#include "../particles/particles_impl.h"

#include <sph/smoothing.h>

#include <math.h>
#include <string.h>

enum { GRAIN = 64 };

static const double first_slack = 1.1, later_slack = 1.3; /* reach over h */

/* ---- options ----------------------------------------------------------------------------- */

void sph_adapt_options_init_sized(sph_adapt_options *options, size_t size) {
  const sph_adapt_options defaults = {.size = sizeof defaults,
                                      .smoothing = SPH_SMOOTHING_NUMBER,
                                      .eta = 1.2,
                                      .tolerance = 1e-10,
                                      .max_evaluations = 200,
                                      .density = 1};
  sphi_options_init(options, size, &defaults, sizeof defaults);
}

void sph_adapt_result_init_sized(sph_adapt_result *result, size_t size) {
  const sph_adapt_result defaults = {.size = sizeof defaults, .first_kept = -1};
  sphi_options_init(result, size, &defaults, sizeof defaults);
}

static int32_t positive(double x) { return isfinite(x) && x > 0.0; }

static sph_status check_options(sph_context *ctx, const sph_adapt_options *o) {
  if (o->smoothing != SPH_SMOOTHING_MASS && o->smoothing != SPH_SMOOTHING_NUMBER)
    return sphi_fail(ctx, SPH_ERR_ARG,
                     "sph_adapt_smoothing: smoothing = %d: only mass and number have a sum",
                     (int)o->smoothing);
  if (!positive(o->eta) || !positive(o->tolerance) || o->max_evaluations < 1)
    return sphi_fail(ctx, SPH_ERR_ARG,
                     "sph_adapt_smoothing: eta = %g and tolerance = %g must be positive and "
                     "finite, max_evaluations = %d at least 1",
                     o->eta, o->tolerance, (int)o->max_evaluations);
  if (!isfinite(o->h_min) || o->h_min < 0.0 || !isfinite(o->h_max) || o->h_max < 0.0 ||
      (o->h_max > 0.0 && o->h_max < o->h_min))
    return sphi_fail(ctx, SPH_ERR_ARG, "sph_adapt_smoothing: h_min = %g, h_max = %g", o->h_min,
                     o->h_max);
  return SPH_OK;
}

/* ---- what is needed ---------------------------------------------------------------------- */

/* One call. */
typedef struct adaptation {
  sphi_adapt_job job;
  sph_adapt_options options;
  sph_adapt_result result;
  sph_context *ctx;
  sph_neighbors *list;
  sph_particles *set;
  double *h, *rho; /* of the set */
  double *reach;   /* n: what the list is built for */
  sphi_buffer b_particle, b_reach, b_old;
} adaptation;

static sph_status check_list(const adaptation *c, const sph_kernel *kernel) {
  const sph_neighbors_options *o = &c->list->options;
  if (kernel->dim != sph_particles_dim(c->set))
    return sphi_fail(c->ctx, SPH_ERR_ARG, "sph_adapt_smoothing: the set is %d-D, the kernel %d-D",
                     (int)sph_particles_dim(c->set), (int)kernel->dim);
  if (o->support < kernel->support * (1.0 - 1e-12))
    return sphi_fail(c->ctx, SPH_ERR_ARG,
                     "sph_adapt_smoothing: the list reaches %g h, the kernel %g h", o->support,
                     kernel->support);
  if (o->h_rule != SPH_H_MAX && o->h_rule != SPH_H_AVERAGE)
    return sphi_fail(c->ctx, SPH_ERR_ARG,
                     "sph_adapt_smoothing: sums with h_i need a list of the rule SPH_H_MAX or "
                     "SPH_H_AVERAGE, not %d",
                     (int)o->h_rule);
  return SPH_OK;
}

static sph_status check_values(const adaptation *c, const double *m) {
  for (int64_t i = 0; i < c->job.rows; ++i)
    if (!positive(c->h[i]))
      return sphi_fail(c->ctx, SPH_ERR_NUMERIC, "sph_adapt_smoothing: particle %lld has h = %g",
                       (long long)i, c->h[i]);
  for (int64_t i = 0; i < c->job.n; ++i)
    if (!positive(m[i]))
      return sphi_fail(c->ctx, SPH_ERR_NUMERIC, "sph_adapt_smoothing: particle %lld has m = %g",
                       (long long)i, m[i]);
  return SPH_OK;
}

static sph_status find_fields(adaptation *c, const double **m) {
  const int64_t n = c->job.n;
  c->job.x = sph_particles_field_const(c->set, SPH_FIELD_X);
  *m = sph_particles_field_const(c->set, SPH_FIELD_M);
  if (!sph_particles_field_const(c->set, SPH_FIELD_H) || !*m || !c->job.x)
    return n == 0 ? SPH_OK
                  : sphi_fail(c->ctx, SPH_ERR_ARG,
                              "sph_adapt_smoothing: the set needs the fields x, m and h");
  sph_status s = sph_particles_field(c->set, SPH_FIELD_H, &c->h);
  return s ? s : check_values(c, *m);
}

/* ---- the job ----------------------------------------------------------------------------- */

/* The largest h for which the list can be built. */
static double box_limit(const adaptation *c) {
  const sph_neighbors *list = c->list;
  double limit = INFINITY;
  for (int32_t a = 0; a < c->job.dim; ++a)
    if (list->period[a] > 0.0)
      limit = fmin(limit, (0.5 * list->period[a] - list->options.skin) / list->options.support);
  return limit * (1.0 - 1e-12);
}

static sph_status set_up(adaptation *c, const sph_kernel *kernel, const double *m) {
  sphi_adapt_job *job = &c->job;
  const sph_adapt_options *o = &c->options;
  job->list = c->list;
  job->kernel = kernel;
  job->m = o->smoothing == SPH_SMOOTHING_MASS ? m : NULL;
  job->target = pow(o->eta, job->dim);
  job->own = sph_kernel_w(kernel, 0.0, 1.0);
  job->total = (double)job->n;
  if (job->m) job->total = 0.0;
  for (int64_t i = 0; job->m && i < job->n; ++i) job->total += m[i];
  job->tolerance = o->tolerance;
  job->max_evaluations = o->max_evaluations;
  job->h_min = o->h_min;
  job->h_max = o->h_max > 0.0 ? o->h_max : INFINITY;
  job->box_h = box_limit(c);
  job->periodic = isfinite(job->box_h);
  if (job->own < job->target) return SPH_OK;
  return sphi_fail(c->ctx, SPH_ERR_ARG,
                   "sph_adapt_smoothing: eta = %g, eta^%d = %g, but a particle alone has n h^%d = "
                   "%g with this kernel",
                   o->eta, (int)job->dim, job->target, (int)job->dim, job->own);
}

/* Edge of a cube that holds one particle, if they filled the box about them evenly; 0 where that
 * box has no volume. */
static double mean_spacing(const sphi_adapt_job *job) {
  double volume = 1.0;
  for (int32_t a = 0; a < job->dim; ++a) {
    double lo = INFINITY, hi = -INFINITY;
    for (int64_t i = 0; i < job->n; ++i) {
      lo = fmin(lo, job->x[i * job->dim + a]);
      hi = fmax(hi, job->x[i * job->dim + a]);
    }
    if (job->list->period[a] > 0.0) hi = lo + job->list->period[a];
    volume *= hi - lo;
  }
  return volume > 0.0 && isfinite(volume) ? pow(volume / (double)job->n, 1.0 / job->dim) : 0.0;
}

/* Lengths that are far too long throughout would make a list of all pairs. Where they ask for many
 * times the neighbours that an even cloud has, start from the even cloud's; a few long ones, of
 * debris, are left alone. */
static double start_limit(const adaptation *c) {
  enum { MANY = 64 };
  const sphi_adapt_job *job = &c->job;
  const double even = c->options.eta * mean_spacing(job);
  double excess = 0.0;
  if (even == 0.0) return job->box_h;
  for (int64_t i = 0; i < job->rows; ++i)
    excess += fmin(pow(c->h[i] / even, job->dim), (double)job->n);
  return excess > MANY * (double)job->rows ? fmin(even, job->box_h) : job->box_h;
}

static sph_status start(adaptation *c) {
  sph_status s = sphi_buffer_reserve(c->ctx, &c->b_particle,
                                     sphi_mul((size_t)c->job.rows, sizeof *c->job.particle));
  if (!s) s = sphi_buffer_reserve(c->ctx, &c->b_reach, sphi_mul((size_t)c->job.n, sizeof(double)));
  if (s) return s;
  const double limit = start_limit(c);
  c->job.particle = c->b_particle.ptr;
  c->reach = c->b_reach.ptr;
  for (int64_t i = 0; i < c->job.rows; ++i)
    c->job.particle[i] =
        (sphi_adapt_particle){.h = fmin(fmax(c->h[i], c->job.h_min), fmin(c->job.h_max, limit)),
                              .high = INFINITY,
                              .last_miss = INFINITY};
  return SPH_OK;
}

/* ---- rounds ------------------------------------------------------------------------------ */

static int32_t is_active(const sphi_adapt_particle *p) { return p->state == SPHI_ADAPT_ACTIVE; }

/* Reaches of those under way; all others, ghosts too, get a short one and so no rows of their own.
 * Returns how many are under way. */
static int64_t set_reaches(adaptation *c, double slack) {
  int64_t active = 0;
  double least = INFINITY;
  for (int64_t i = 0; i < c->job.rows; ++i) {
    sphi_adapt_particle *p = &c->job.particle[i];
    if (!is_active(p)) continue;
    p->reach = fmin(slack * p->h, c->job.box_h);
    least = fmin(least, p->reach);
    active += 1;
  }
  for (int64_t i = 0; i < c->job.n; ++i) {
    const int32_t mine = i < c->job.rows && is_active(&c->job.particle[i]);
    c->reach[i] = mine ? c->job.particle[i].reach : least;
  }
  return active;
}

static void solve_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  const sphi_adapt_job *j = job;
  (void)worker;
  for (int64_t k = begin; k < end; ++k) {
    const int64_t i = j->list->order[k];
    if (i < j->rows && is_active(&j->particle[i])) sphi_adapt_solve(j, k);
  }
}

/* Ends: an active particle spends at least one of its evaluations in every second round. */
static sph_status run_rounds(adaptation *c) {
  for (double slack = first_slack; set_reaches(c, slack) > 0; slack = later_slack) {
    sph_status s =
        sph_neighbors_build_arrays(c->list, c->job.dim, c->job.n, c->job.x, c->reach, 0.0);
    if (s) return s;
    c->result.builds += 1;
    sphi_parallel(c->ctx, c->job.n, GRAIN, solve_range, &c->job);
  }
  return SPH_OK;
}

/* ---- the end ----------------------------------------------------------------------------- */

static const char *reason(int32_t state) {
  switch (state) {
  case SPHI_ADAPT_COINCIDENT:
    return "too many particles at its place";
  case SPHI_ADAPT_ALONE:
    return "too few particles in all";
  case SPHI_ADAPT_BOX:
    return "the periodic box is too narrow";
  default:
    return "max_evaluations are spent";
  }
}

static int32_t failed(const sphi_adapt_particle *p) { return p->state >= SPHI_ADAPT_COINCIDENT; }

static sph_status count(adaptation *c) {
  for (int64_t i = 0; i < c->job.rows; ++i) {
    const sphi_adapt_particle *p = &c->job.particle[i];
    c->result.evaluations += p->evaluations;
    if (p->evaluations > c->result.most_evaluations) c->result.most_evaluations = p->evaluations;
    c->result.bounded += p->state == SPHI_ADAPT_BOUNDED;
    c->result.jumps += p->state == SPHI_ADAPT_JUMP;
    if (!failed(p)) continue;
    if (!c->options.keep)
      return sphi_fail(c->ctx, SPH_ERR_NUMERIC,
                       "sph_adapt_smoothing: no h for particle %lld: %s; last h = %g, where n "
                       "h^%d = %g, not %g",
                       (long long)i, reason(p->state), p->h, (int)c->job.dim, p->sum,
                       c->job.target);
    if (c->result.kept++ == 0) c->result.first_kept = i;
  }
  return SPH_OK;
}

/* New lengths into the set and the list after them; the old ones back when that cannot be. */
static sph_status write_lengths(adaptation *c) {
  const size_t bytes = sphi_mul((size_t)c->job.rows, sizeof(double));
  sph_status s = sphi_buffer_reserve(c->ctx, &c->b_old, bytes);
  if (s) return s;
  memcpy(c->b_old.ptr, c->h, bytes);
  for (int64_t i = 0; i < c->job.rows; ++i)
    if (!failed(&c->job.particle[i])) c->h[i] = c->job.particle[i].h;
  (void)sph_particles_touch(c->set, SPH_FIELD_H);
  s = sph_neighbors_build(c->list, c->set);
  if (!s) {
    c->result.builds += 1;
    return SPH_OK;
  }
  memcpy(c->h, c->b_old.ptr, bytes);
  (void)sph_particles_touch(c->set, SPH_FIELD_H);
  return s;
}

static void density_range(void *job, int64_t begin, int64_t end, int32_t worker) {
  const adaptation *c = job;
  const double *m = sph_particles_field_const(c->set, SPH_FIELD_M);
  (void)worker;
  for (int64_t k = begin; k < end; ++k) {
    const int64_t i = c->list->order[k];
    if (i >= c->job.rows) continue;
    double sum = c->job.particle[i].sum, slope;
    if (failed(&c->job.particle[i])) sphi_adapt_sum(&c->job, k, c->h[i], &sum, &slope);
    c->rho[i] = m[i] * sum / pow(c->h[i], c->job.dim);
  }
}

static sph_status finish(adaptation *c) {
  sph_status s = count(c);
  if (!s && c->options.density) s = sph_particles_field(c->set, SPH_FIELD_RHO, &c->rho);
  if (!s) s = write_lengths(c);
  if (s || !c->rho) return s;
  sphi_parallel(c->ctx, c->job.n, GRAIN, density_range, c);
  return sph_particles_touch(c->set, SPH_FIELD_RHO);
}

/* ---- the call ---------------------------------------------------------------------------- */

static sph_status begin(adaptation *c, const sph_kernel *kernel, const sph_adapt_options *options,
                        const sph_adapt_result *result) {
  const double *m = NULL;
  sph_adapt_options_init(&c->options);
  sph_adapt_result_init(&c->result);
  sph_status s = sphi_options_read(c->ctx, &c->options, sizeof c->options, options);
  if (!s) s = check_options(c->ctx, &c->options);
  if (!s && result) s = sphi_options_read(c->ctx, &c->result, sizeof c->result, result);
  if (!s) s = check_list(c, kernel);
  if (s) return s;
  sph_adapt_result_init(&c->result);
  c->job.dim = kernel->dim;
  c->job.n = sph_particles_count(c->set);
  c->job.rows = sph_particles_real_count(c->set);
  s = find_fields(c, &m);
  return s ? s : set_up(c, kernel, m);
}

static void answer(const adaptation *c, sph_adapt_result *result) {
  if (!result) return;
  const size_t size = result->size;
  memcpy(result, &c->result, size < sizeof c->result ? size : sizeof c->result);
  result->size = size;
}

sph_status sph_adapt_smoothing(sph_neighbors *list, const sph_kernel *kernel, sph_particles *set,
                               const sph_adapt_options *options, sph_adapt_result *result) {
  sph_status s = sphi_check_handle(NULL, list, SPHI_MAGIC_NEIGHBORS, "list");
  if (s) return s;
  adaptation c = {.ctx = list->base.ctx, .list = list, .set = set};
  s = sphi_check_handle(c.ctx, kernel, SPHI_MAGIC_KERNEL, "kernel");
  if (!s) s = sphi_check_handle(c.ctx, set, SPHI_MAGIC_PARTICLES, "set");
  if (!s) s = begin(&c, kernel, options, result);
  if (s) return s;
  if (c.job.rows > 0) {
    s = start(&c);
    if (!s) s = run_rounds(&c);
    if (!s) s = finish(&c);
    sphi_buffer_free(c.ctx, &c.b_particle);
    sphi_buffer_free(c.ctx, &c.b_reach);
    sphi_buffer_free(c.ctx, &c.b_old);
  }
  if (!s) answer(&c, result);
  return s;
}
