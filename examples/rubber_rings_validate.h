/* Part of rubber_rings.c: what is kept, momentum, angular momentum and energy, and that nothing
 * breaks. */
#ifndef EXAMPLES_RUBBER_RINGS_VALIDATE_H
#define EXAMPLES_RUBBER_RINGS_VALIDATE_H

static double contact_energy(const rings *s) {
  const int64_t *first;
  const int32_t *other, *ring = sph_particles_phases(s->set);
  const double *x = sph_particles_field_const(s->set, SPH_FIELD_X);
  double sum = 0.0;
  need(s->ctx, sph_neighbors_update(s->near, s->set, NULL));
  need(s->ctx, sph_neighbors_rows(s->near, &first, &other));
  for (int64_t i = 0; i < sph_particles_count(s->set); ++i)
    for (int64_t k = first[i]; k < first[i + 1]; ++k) {
      const int64_t j = other[k];
      const double r = hypot(x[2 * i] - x[2 * j], x[2 * i + 1] - x[2 * j + 1]);
      if (ring[i] != ring[j] && r < s->dp) sum += 0.25 * bulk * (s->dp - r) * (s->dp - r);
    }
  return sum; /* each pair twice */
}

typedef struct ledger {
  double kinetic, elastic, contact; /* elastic: strain and hourglass */
  double momentum, angular;         /* size of the first, by sum m |v| of the start */
} ledger;

static ledger measure(rings *s, double t) {
  sph_total_lagrangian_energies e = {.size = sizeof e};
  const double *x = field(s->ctx, s->set, SPH_FIELD_X), *v = field(s->ctx, s->set, SPH_FIELD_V);
  const double *m = field(s->ctx, s->set, SPH_FIELD_M);
  double px = 0.0, py = 0.0, turn = 0.0, mass = 0.0;
  need(s->ctx, sph_total_lagrangian_energy(s->tl, s->set, t, &e));
  for (int64_t i = 0; i < sph_particles_count(s->set); ++i) {
    px += m[i] * v[2 * i];
    py += m[i] * v[2 * i + 1];
    turn += m[i] * (x[2 * i] * v[2 * i + 1] - x[2 * i + 1] * v[2 * i]);
    mass += m[i];
  }
  return (ledger){.kinetic = e.kinetic,
                  .elastic = e.strain + e.hourglass,
                  .contact = contact_energy(s),
                  .momentum = hypot(px, py) / (mass * speed),
                  .angular = fabs(turn) / (mass * speed * outer)};
}

/* Largest stretch between neighbours of the reference configuration. */
static double largest_stretch(const rings *s) {
  const int64_t *first;
  const int32_t *other;
  const double *x = sph_particles_field_const(s->set, SPH_FIELD_X);
  const double *X = sph_particles_field_const(s->set, SPH_FIELD_X0);
  double most = 0.0;
  need(s->ctx, sph_neighbors_rows(sph_total_lagrangian_list(s->tl), &first, &other));
  for (int64_t i = 0; i < sph_particles_count(s->set); ++i)
    for (int64_t k = first[i]; k < first[i + 1]; ++k) {
      const int64_t j = other[k];
      const double r = hypot(x[2 * i] - x[2 * j], x[2 * i + 1] - x[2 * j + 1]);
      most = fmax(most, r / hypot(X[2 * i] - X[2 * j], X[2 * i + 1] - X[2 * j + 1]));
    }
  return most;
}

typedef struct outcome {
  double energy, momentum, angular, stretch, contact, velocity;
} outcome;

static outcome rings_run(rings *s) {
  outcome r = {.energy = 0.0};
  double dt;
  need(s->ctx, sph_total_lagrangian_time_step(s->tl, s->set, &dt));
  const int64_t steps = (int64_t)ceil(duration / dt);
  dt = duration / (double)steps;
  const ledger start = measure(s, 0.0);
  for (int64_t k = 1; k <= steps; ++k) {
    need(s->ctx, sph_total_lagrangian_step(s->tl, s->set, (double)(k - 1) * dt, dt));
    if (k % 50 != 0 && k != steps) continue;
    const ledger now = measure(s, (double)k * dt);
    const double total = now.kinetic + now.elastic + now.contact;
    r.energy = fmax(r.energy, fabs(total / start.kinetic - 1.0));
    r.momentum = fmax(r.momentum, now.momentum);
    r.angular = fmax(r.angular, now.angular);
    r.stretch = fmax(r.stretch, largest_stretch(s));
    r.contact = now.contact;
    r.velocity = right_velocity(s);
  }
  return r;
}

static int bound(const char *quantity, int layers, double measured, int side, double limit,
                 const char *source) {
  char keys[128];
  snprintf(keys, sizeof keys, "case=rubber_rings quantity=%s layers=%d", quantity, layers);
  return result_bound(keys, measured, side, limit, source);
}

static int validate_layers(int layers) {
  rings s;
  rings_create(&s, layers);
  const outcome r = rings_run(&s);
  rings_destroy(&s);
  char keys[128];
  int failed = bound("momentum", layers, r.momentum, -1, 1e-12, "antisymmetric forces");
  failed += bound("angular_momentum", layers, r.angular, -1, 1e-12, "central contact");
  failed += bound("energy_drift", layers, r.energy, -1, 1e-3, "leapfrog");
  failed += bound("largest_stretch", layers, r.stretch, -1, 2.0, "no numerical fracture");
  failed += bound("contact_energy_at_end", layers, r.contact, -1, 0.0, "the rings separate");
  failed += bound("rebound_velocity", layers, r.velocity / speed, 1, 0.1, "the rings bounce");
  snprintf(keys, sizeof keys, "case=rubber_rings quantity=restitution layers=%d", layers);
  result_report(keys, r.velocity / speed, 1.0, "rigid elastic bodies",
                "the rest swings on in the rings");
  return failed;
}

static int validate(int full) {
  const int failed = validate_layers(8);
  return full ? failed + validate_layers(16) : failed;
}

#endif
