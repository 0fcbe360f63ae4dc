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

static sph_total_lagrangian_ledger balance(const rings *s, double t) {
  sph_total_lagrangian_ledger l;
  sph_total_lagrangian_ledger_init(&l);
  need(s->ctx, sph_total_lagrangian_balance(s->tl, s->set, t, &l));
  return l;
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
  double steps, contact_work; /* of the ledger: energy error, and how far the work of the contact is
                               * from its potential, over the kinetic energy of the start */
  double sums;                /* momentum that the ledger does not account for */
} outcome;

/* The step is that of the scheme over `finer`. */
static outcome rings_run(rings *s, int finer) {
  outcome r = {.energy = 0.0};
  double dt;
  need(s->ctx, sph_total_lagrangian_time_step(s->tl, s->set, &dt));
  const int64_t steps = (int64_t)ceil(duration / dt) * finer;
  dt = duration / (double)steps;
  const sph_total_lagrangian_ledger start = balance(s, 0.0);
  const double momentum = start.mass * speed;
  for (int64_t k = 1; k <= steps; ++k) {
    need(s->ctx, sph_total_lagrangian_step(s->tl, s->set, (double)(k - 1) * dt, dt));
    if (k % (50 * finer) != 0 && k != steps) continue;
    const sph_total_lagrangian_ledger now = balance(s, (double)k * dt);
    const double contact = contact_energy(s);
    const double total = now.kinetic + now.strain + now.hourglass + contact;
    r.energy = fmax(r.energy, fabs(total / start.kinetic - 1.0));
    r.momentum = fmax(r.momentum, hypot(now.momentum[0], now.momentum[1]) / momentum);
    r.angular = fmax(r.angular, fabs(now.angular_momentum[2]) / (momentum * outer));
    r.stretch = fmax(r.stretch, largest_stretch(s));
    r.steps = fmax(r.steps, fabs(now.energy_error) / start.kinetic);
    r.contact_work = fmax(r.contact_work, fabs(now.hooks + contact) / start.kinetic);
    r.sums = fmax(r.sums, now.momentum_error / momentum);
    r.contact = contact;
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

static outcome run_once(int layers, int finer, int audit) {
  rings s;
  rings_create(&s, layers, audit);
  const outcome r = rings_run(&s, finer);
  rings_destroy(&s);
  return r;
}

/* What the steps leave open in the ledger, and of the work of the contact, is of second order. */
static int validate_ledger(int layers, const outcome *r) {
  const outcome fine = run_once(layers, 2, 1);
  int failed = bound("ledger_momentum_error", layers, r->sums, -1, 1e-12, "kicks are exact");
  failed += bound("ledger_energy_error_rate", layers, log2(r->steps / fine.steps), 1, 1.8,
                  "second order in dt");
  return failed + bound("contact_work_and_potential_rate", layers,
                        log2(r->contact_work / fine.contact_work), 1, 1.8, "second order in dt");
}

static int validate_layers(int layers) {
  const int audit = layers == 8; /* the ledger triples the cost */
  const outcome r = run_once(layers, 1, audit);
  char keys[128];
  int failed = bound("momentum", layers, r.momentum, -1, 1e-12, "antisymmetric forces");
  failed += bound("angular_momentum", layers, r.angular, -1, 1e-12, "central contact");
  failed += bound("energy_drift", layers, r.energy, -1, 1e-3, "leapfrog");
  if (audit) failed += validate_ledger(layers, &r);
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
