/* Two rubber rings collide and bounce.
 *
 * Equations   total-Lagrangian elasticity, include/sph/total_lagrangian.h, neo-Hookean, plane
 *             strain, leapfrog. Its pairs are those of the reference configuration, so the rings
 *             would pass through each other: between them acts a contact force in the current
 *             configuration, from the potential k (d - r)^2 / 2 for particles of different rings
 *             nearer than d, the spacing, with k the bulk modulus (per unit thickness). It is a
 *             host's own pair term of a second right-hand side, with a list that follows X.
 * Set-up      after J. P. Gray, J. J. Monaghan, R. P. Swift, Comput. Methods Appl. Mech. Engrg. 190
 *             (2001) 6641: radii 3 and 4, density and bulk sound speed 1, G / K = 0.22 (their
 *             nu = 0.4), so units of length, density and speed are arbitrary. The rings approach
 *             with 0.059 each. Concentric layers of particles, each with the area of its share.
 * Reference   conservation: momentum to rounding; kinetic + strain + hourglass + contact energy as
 *             the leapfrog keeps it. No numerical fracture: neighbours at rest stay within twice
 *             their distance, det F > 0 (the law refuses it else), and the rings separate.
 * Expected    momentum 1e-12, energy 1e-3; a rebound slower than the approach, for the rings keep
 *             on swinging.
 *
 *   rubber_rings            history as CSV, four pictures in one with gnuplot
 *   rubber_rings validate   8 layers
 *   rubber_rings long       16 layers as well */
#include "common.h"

#include <string.h>

static const double inner = 3.0, outer = 4.0, gap = 0.5, speed = 0.059, pi = 3.14159265358979323846;
static const double bulk = 1.0, shear = 0.22, density = 1.0, duration = 200.0;

typedef struct rings {
  double dp;
  sph_context *ctx;
  sph_kernel *kernel;
  sph_particles *set;
  sph_total_lagrangian *tl;
  sph_neighbors *near; /* in the current configuration */
  sph_rhs *contact;
  double *push; /* accelerations of the contact */
} rings;

/* ---- contact ----------------------------------------------------------------------------- */

/* Pair term: dv_i/dt = (1/m_i) k (d - r) x_ij / r between rings. */
static void contact_pairs(void *user, const sph_pair_block *b, double *out) {
  const rings *s = user;
  const int32_t *ring = sph_particles_phases(s->set);
  const double *m = sph_particles_field_const(s->set, SPH_FIELD_M);
  for (int32_t k = 0; k < b->count; ++k) {
    if (ring[b->i] == ring[b->j[k]] || b->r[k] >= s->dp) continue;
    const double f = bulk * (s->dp - b->r[k]) / (b->r[k] * m[b->i]);
    out[0] += f * b->dx[2 * k];
    out[1] += f * b->dx[2 * k + 1];
  }
}

/* Finish hook of the scheme's right-hand side: add the contact to the accelerations. */
static int32_t add_contact(void *user, double t, sph_particles *set, const sph_rate *rates,
                           int32_t count) {
  rings *s = user;
  const sph_rate push = {SPH_FIELD_V, s->push};
  const sph_status status = sph_rhs_evaluate(s->contact, set, s->near, t, &push, 1);
  for (int32_t k = 0; status == SPH_OK && k < count; ++k)
    for (int64_t i = 0; i < 2 * sph_particles_count(set); ++i) rates[k].values[i] += s->push[i];
  return status;
}

/* ---- set-up ------------------------------------------------------------------------------ */

static void add_ring(rings *s, int32_t ring, int layers) {
  const double side = ring == 0 ? -1.0 : 1.0;
  for (int l = 0; l < layers; ++l) {
    const double r = inner + ((double)l + 0.5) * s->dp;
    const int64_t around = (int64_t)(2.0 * pi * r / s->dp + 0.5);
    int64_t first;
    need(s->ctx, sph_particles_add(s->set, around, &first));
    double *x = field(s->ctx, s->set, SPH_FIELD_X), *v = field(s->ctx, s->set, SPH_FIELD_V);
    double *m = field(s->ctx, s->set, SPH_FIELD_M), *rho = field(s->ctx, s->set, SPH_FIELD_RHO);
    for (int64_t i = first; i < first + around; ++i) {
      const double angle = 2.0 * pi * ((double)(i - first) + 0.5) / (double)around;
      x[2 * i] = side * (outer + 0.5 * gap + r * cos(angle));
      x[2 * i + 1] = r * sin(angle);
      v[2 * i] = -side * speed;
      m[i] = density * 2.0 * pi * r * s->dp / (double)around;
      rho[i] = density;
      sph_particles_phases(s->set)[i] = ring;
    }
  }
}

static void make_particles(rings *s, int layers) {
  sph_particles_options options;
  sph_particles_options_init(&options);
  options.dim = 2;
  need(s->ctx, sph_particles_create(s->ctx, &options, &s->set));
  for (int32_t ring = 0; ring < 2; ++ring) add_ring(s, ring, layers);
}

static void make_contact(rings *s) {
  sph_neighbors_options near;
  sph_neighbors_options_init(&near);
  near.method = SPH_NEIGHBORS_VERLET;
  near.skin = 0.5 * s->dp;
  need(s->ctx, sph_neighbors_create(s->ctx, &near, &s->near));
  need(s->ctx, sph_kernel_create(s->ctx, SPH_KERNEL_WENDLAND_C2, 2, &s->kernel));
  need(s->ctx, sph_rhs_create(s->ctx, s->kernel, NULL, &s->contact));
  need(s->ctx, sph_rhs_add_host(s->contact, SPH_FIELD_V, contact_pairs, s));
  need(s->ctx, sph_rhs_set_finish(sph_total_lagrangian_rhs(s->tl), add_contact, s));
  s->push = calloc((size_t)sph_particles_count(s->set), 2 * sizeof *s->push);
  if (!s->push) exit(2);
}

/* audit: with the scheme's ledger, which takes the contact as the work of a hook. */
static void rings_create(rings *s, int layers, int audit) {
  sph_material *rubber;
  sph_hyperelastic_options law;
  sph_hyperelastic_options_init(&law);
  law.young = 9.0 * bulk * shear / (3.0 * bulk + shear);
  law.poisson = (3.0 * bulk - 2.0 * shear) / (6.0 * bulk + 2.0 * shear);
  law.density = density;
  law.reduction = SPH_PLANE_STRAIN;
  sph_total_lagrangian_options options;
  sph_total_lagrangian_options_init(&options);
  options.dim = 2;
  options.audit = audit;
  *s = (rings){.dp = (outer - inner) / layers};
  need(NULL, sph_context_create(NULL, &s->ctx));
  need(s->ctx, sph_material_create_hyperelastic(s->ctx, &law, &rubber));
  need(s->ctx, sph_total_lagrangian_create(s->ctx, &options, rubber, &s->tl));
  need(s->ctx, sph_rhs_set_material(sph_total_lagrangian_rhs(s->tl), 1, rubber));
  sph_material_destroy(rubber); /* the scheme keeps it */
  make_particles(s, layers);
  need(s->ctx, sph_total_lagrangian_start(s->tl, s->set));
  make_contact(s);
}

static void rings_destroy(rings *s) {
  free(s->push);
  sph_rhs_destroy(s->contact);
  sph_kernel_destroy(s->kernel);
  sph_neighbors_destroy(s->near);
  sph_total_lagrangian_destroy(s->tl);
  sph_particles_destroy(s->set);
  sph_context_destroy(s->ctx);
}

/* ---- demo ----------------------------------------------------------------------------- */

static void write_positions(const rings *s, FILE *file) {
  const double *x = sph_particles_field_const(s->set, SPH_FIELD_X);
  for (int64_t i = 0; i < sph_particles_count(s->set); ++i)
    fprintf(file, "%.6g,%.6g,%d\n", x[2 * i], x[2 * i + 1], (int)sph_particles_phases(s->set)[i]);
  fprintf(file, "\n\n");
}

static const char picture[] =
    "set terminal pngcairo size 1000,600\nset output 'rubber_rings.png'\n"
    "set datafile separator ','\nset multiplot layout 2,2\nset size ratio -1\nunset key\n"
    "unset colorbox\n"
    "set palette defined (0 'navy', 1 'dark-orange')\nset xrange [-11:11]\nset yrange [-6:6]\n"
    "do for [k=0:3] { plot 'rubber_rings_x.csv' index k using 1:2:3 with points pt 7 ps 0.3 \\\n"
    "  palette }\n";

/* Velocity of the right ring's centre of mass, along x. */
static double right_velocity(const rings *s) {
  const int32_t *ring = sph_particles_phases(s->set);
  const double *v = sph_particles_field_const(s->set, SPH_FIELD_V);
  const double *m = sph_particles_field_const(s->set, SPH_FIELD_M);
  double momentum = 0.0, mass = 0.0;
  for (int64_t i = 0; i < sph_particles_count(s->set); ++i)
    if (ring[i] == 1) {
      momentum += m[i] * v[2 * i];
      mass += m[i];
    }
  return momentum / mass;
}

static int demo(int layers) {
  rings s;
  double dt;
  FILE *positions = open_output("rubber_rings_x.csv"), *csv = open_output("rubber_rings.csv");
  rings_create(&s, layers, 0);
  need(s.ctx, sph_total_lagrangian_time_step(s.tl, s.set, &dt));
  const int64_t steps = (int64_t)ceil(duration / dt);
  fprintf(csv, "t,v\n");
  for (int64_t k = 1; k <= steps; ++k) {
    need(s.ctx, sph_total_lagrangian_step(s.tl, s.set, (double)(k - 1) * dt, dt));
    if (k % (steps / 4) == steps / 8) write_positions(&s, positions);
    if (k % 50 == 0) fprintf(csv, "%.6g,%.6g\n", (double)k * dt, right_velocity(&s));
  }
  printf("rebound at %.3f of the approach\n", right_velocity(&s) / speed);
  rings_destroy(&s);
  fclose(positions);
  fclose(csv);
  draw("rubber_rings.gp", picture);
  return 0;
}

/* Conservation, and that nothing breaks; nothing in there is needed to use the library. */
#include "rubber_rings_validate.h"

int main(int argc, char **argv) {
  const char *mode = argc > 1 ? argv[1] : "demo";
  return (strcmp(mode, "demo") == 0 ? demo(8) : validate(strcmp(mode, "long") == 0)) != 0;
}
