/* Sums of a state: mass, momentum, angular momentum, power. */
#include "moments.h"

enum { CHUNKS = 64 };

typedef struct sum_job {
  int32_t dim;
  int64_t n;
  const double *m, *x, *v, *u, *s;
  sphi_moments part[CHUNKS];
} sum_job;

/* x cross u, both with dim components: z in 2-D, nothing in 1-D. */
static void add_moment(int32_t dim, double m, const double *x, const double *u, double out[3]) {
  if (dim >= 2) out[2] += m * (x[0] * u[1] - x[1] * u[0]);
  if (dim < 3) return;
  out[0] += m * (x[1] * u[2] - x[2] * u[1]);
  out[1] += m * (x[2] * u[0] - x[0] * u[2]);
}

static int64_t begin_of(const sum_job *j, int64_t chunk) { return j->n * chunk / CHUNKS; }

static void moments_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  sum_job *j = job;
  (void)worker;
  for (int64_t chunk = lo; chunk < hi; ++chunk) {
    sphi_moments sum = {0};
    const int64_t end = begin_of(j, chunk + 1);
    for (int64_t i = begin_of(j, chunk); i < end; ++i) {
      const int64_t at = i * j->dim;
      for (int32_t a = 0; a < j->dim; ++a) {
        sum.power += j->m[i] * j->v[at + a] * j->u[at + a];
        sum.linear[a] += j->m[i] * j->u[at + a];
      }
      add_moment(j->dim, j->m[i], j->x + at, j->u + at, sum.angular);
    }
    j->part[chunk] = sum;
  }
}

static sum_job job_of(const sph_particles *set) {
  return (sum_job){.dim = sph_particles_dim(set),
                   .n = sph_particles_real_count(set),
                   .m = sph_particles_field_const(set, SPH_FIELD_M),
                   .x = sph_particles_field_const(set, SPH_FIELD_X),
                   .v = sph_particles_field_const(set, SPH_FIELD_V)};
}

sphi_moments sphi_moments_of(sph_context *ctx, const sph_particles *set, const double *u) {
  sum_job job = job_of(set);
  sphi_moments sum = {0};
  job.u = u;
  sphi_parallel(ctx, CHUNKS, job.n < 4096 ? CHUNKS : 1, moments_range, &job);
  for (int32_t c = 0; c < CHUNKS; ++c) {
    sum.power += job.part[c].power;
    for (int a = 0; a < 3; ++a) {
      sum.linear[a] += job.part[c].linear[a];
      sum.angular[a] += job.part[c].angular[a];
    }
  }
  return sum;
}

static void mass_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  sum_job *j = job;
  (void)worker;
  for (int64_t chunk = lo; chunk < hi; ++chunk) {
    double sum = 0.0;
    const int64_t end = begin_of(j, chunk + 1);
    for (int64_t i = begin_of(j, chunk); i < end; ++i) sum += j->m[i] * (j->s ? j->s[i] : 1.0);
    j->part[chunk].power = sum;
  }
}

double sphi_mass_times(sph_context *ctx, const sph_particles *set, const double *s) {
  sum_job job = job_of(set);
  double sum = 0.0;
  job.s = s;
  sphi_parallel(ctx, CHUNKS, job.n < 4096 ? CHUNKS : 1, mass_range, &job);
  for (int32_t c = 0; c < CHUNKS; ++c) sum += job.part[c].power;
  return sum;
}
