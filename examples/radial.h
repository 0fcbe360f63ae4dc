/* What the examples of shocks that are round share: a ball (1-D: an interval, 2-D: a disc)
 * about the origin, cut out of a lattice whose points lie at cell centres, its run by the
 * scheme of shocks.h, and its error against a solution that depends on the radius alone.
 *
 * L1 is the mean of |rho - exact| over r < r_max: rings of equal width count by their width, each
 * with the mean error of its particles. */
#ifndef EXAMPLES_RADIAL_H
#define EXAMPLES_RADIAL_H

#include "common.h"

#include <string.h>
#include <time.h>

enum { RADIAL_RINGS = 40, RADIAL_KEYS = 160 };

typedef struct radial_setup {
  const char *name;
  int32_t dim;
  double radius;
  int across; /* particles along a length of 2 */
  double gamma, end;
  sph_dissipation loss;
} radial_setup;

typedef struct radial {
  radial_setup setup;
  sph_context *ctx;
  sph_particles *set;
  sph_shocks *shocks;
  int64_t n;
  double *x, *v, *m, *rho, *e, *r; /* r: filled at the end */
  sph_shocks_ledger ledger;        /* at the end */
  double energy_start, seconds;
} radial;

static inline radial_setup radial_defaults(const char *name, int32_t dim, int across) {
  radial_setup s;
  memset(&s, 0, sizeof s);
  s.name = name;
  s.dim = dim;
  s.across = across;
  s.radius = 1.0;
  sph_dissipation_init(&s.loss);
  return s;
}

static inline double radial_distance(const radial *a, int64_t i) {
  double sum = 0.0;
  for (int32_t k = 0; k < a->setup.dim; ++k)
    sum += a->x[i * a->setup.dim + k] * a->x[i * a->setup.dim + k];
  return sqrt(sum);
}

static inline int32_t radial_inside(void *setup, const double *x) {
  const radial_setup *s = (const radial_setup *)setup;
  double sum = 0.0;
  for (int32_t k = 0; k < s->dim; ++k) sum += x[k] * x[k];
  return sum < s->radius * s->radius;
}

static inline void radial_place(radial *a) {
  const int32_t dim = a->setup.dim;
  sph_lattice_options o;
  sph_lattice_options_init(&o);
  o.dim = dim;
  o.spacing = 2.0 / a->setup.across;
  for (int32_t k = 0; k < dim; ++k) o.lo[k] = -a->setup.radius, o.hi[k] = a->setup.radius;
  o.inside = radial_inside;
  o.inside_user = &a->setup;
  need(a->ctx, sph_layout_lattice(a->ctx, &o, 0, NULL, &a->n));
  need(a->ctx, sph_particles_add(a->set, a->n, NULL));
  need(a->ctx, sph_layout_lattice(a->ctx, &o, a->n, field(a->ctx, a->set, SPH_FIELD_X), &a->n));
}

/* Density 1, at rest, no energy; velocities and energies are the caller's, who then starts. */
static inline void radial_create(radial *a, const radial_setup *setup) {
  sph_particles_options options;
  sph_shocks_options o;
  sph_gas_options gas;
  sph_material *law;
  memset(a, 0, sizeof *a);
  a->setup = *setup;
  need(NULL, sph_context_create(NULL, &a->ctx));
  sph_particles_options_init(&options);
  options.dim = setup->dim;
  need(a->ctx, sph_particles_create(a->ctx, &options, &a->set));
  radial_place(a);
  a->x = field(a->ctx, a->set, SPH_FIELD_X);
  a->v = field(a->ctx, a->set, SPH_FIELD_V);
  a->m = field(a->ctx, a->set, SPH_FIELD_M);
  a->rho = field(a->ctx, a->set, SPH_FIELD_RHO);
  a->e = field(a->ctx, a->set, SPH_FIELD_E);
  for (int64_t i = 0; i < a->n; ++i) {
    a->m[i] = pow(2.0 / setup->across, setup->dim);
    a->rho[i] = 1.0;
  }
  sph_shocks_options_init(&o);
  o.dim = setup->dim;
  o.dissipation = &a->setup.loss;
  need(a->ctx, sph_shocks_create(a->ctx, a->set, &o, &a->shocks));
  sph_gas_options_init(&gas);
  gas.gamma = setup->gamma;
  need(a->ctx, sph_material_create_gas(a->ctx, &gas, &law));
  need(a->ctx, sph_shocks_set_material(a->shocks, 0, law));
  sph_material_destroy(law); /* the scheme keeps it */
}

static inline void radial_destroy(radial *a) {
  free(a->r);
  sph_shocks_destroy(a->shocks);
  sph_particles_destroy(a->set);
  sph_context_destroy(a->ctx);
}

/* From time 0 to the end. */
static inline void radial_run(radial *a) {
  const clock_t begin = clock();
  need(a->ctx, sph_shocks_start(a->shocks, 0.0));
  sph_shocks_ledger_init(&a->ledger);
  need(a->ctx, sph_shocks_balance(a->shocks, &a->ledger));
  a->energy_start = a->ledger.total;
  need(a->ctx, sph_shocks_run(a->shocks, a->setup.end, NULL, NULL));
  need(a->ctx, sph_shocks_balance(a->shocks, &a->ledger));
  a->seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
  a->r = malloc((size_t)a->n * sizeof *a->r);
  if (!a->r) exit(2);
  for (int64_t i = 0; i < a->n; ++i) a->r[i] = radial_distance(a, i);
}

/* ---- figures ----------------------------------------------------------------------------- */

static inline double radial_l1(const radial *a, const double *exact, double r_max) {
  double sum[RADIAL_RINGS] = {0.0}, total = 0.0;
  int64_t count[RADIAL_RINGS] = {0}, rings = 0;
  for (int64_t i = 0; i < a->n; ++i) {
    const double ring = a->r[i] / r_max * RADIAL_RINGS;
    if (ring >= RADIAL_RINGS) continue;
    sum[(int)ring] += fabs(a->rho[i] - exact[i]);
    ++count[(int)ring];
  }
  for (int k = 0; k < RADIAL_RINGS; ++k)
    if (count[k] > 0) total += sum[k] / (double)count[k], ++rings;
  return total / (double)rings;
}

/* Mean density in r0 <= r < r1, by particles. */
static inline double radial_mean(const radial *a, double r0, double r1) {
  double sum = 0.0;
  int64_t count = 0;
  for (int64_t i = 0; i < a->n; ++i)
    if (a->r[i] >= r0 && a->r[i] < r1) sum += a->rho[i], ++count;
  return sum / (double)count;
}

/* Where the mean density of thin rings falls, from outside, first half way from 1 to its peak. */
static inline double radial_front(const radial *a) {
  const double width = 2.0 / a->setup.across;
  double peak = 1.0, outer = 1.0;
  for (double r = 0.0; r < a->setup.radius; r += width)
    peak = fmax(peak, radial_mean(a, r, r + width));
  for (double r = a->setup.radius - 2.0 * width; r > 0.0; r -= width) {
    const double mean = radial_mean(a, r, r + width), half = 0.5 * (peak + 1.0);
    if (mean >= half) return r + width * (0.5 + (mean - half) / (mean - outer));
    outer = mean;
  }
  return NAN;
}

static inline const char *radial_keys(char keys[RADIAL_KEYS], const radial *a,
                                      const char *quantity) {
  snprintf(keys, RADIAL_KEYS, "case=%s quantity=%s dim=%d across=%d n=%lld", a->setup.name,
           quantity, (int)a->setup.dim, a->setup.across, (long long)a->n);
  return keys;
}

/* Every particle's radius, density and energy with the exact density as CSV. */
static inline void radial_write(const radial *a, const char *path, const double *exact) {
  FILE *file = open_output(path);
  fprintf(file, "r,rho,e,rho_exact\n");
  for (int64_t i = 0; i < a->n; ++i)
    fprintf(file, "%.9g,%.9g,%.9g,%.9g\n", a->r[i], a->rho[i], a->e[i], exact[i]);
  fclose(file);
  printf("  wrote %s\n", path);
}

#endif
