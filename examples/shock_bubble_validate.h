/* Part of shock_bubble.c: planar theory, the history of the interface, speeds, the vortices. */
#ifndef EXAMPLES_SHOCK_BUBBLE_VALIDATE_H
#define EXAMPLES_SHOCK_BUBBLE_VALIDATE_H

#define THESIS "Zisis 2017 section 5.5"
#define VOLUMES "finite volumes, 2000 cells a unit"
#define MEASURED "Haas and Sturtevant 1987, V_R"
#define PLANAR "planar theory"

/* Finite volumes: us after the impact, mm from the centre, P. */
typedef struct row {
  double us, upstream, downstream, height, p;
} row;

static const row rows[] = {{55.6, 20.5, -25.0, 24.8, 1.80},   {114.0, 16.2, -25.0, 22.8, 1.88},
                           {172.0, 12.4, -25.0, 22.3, 2.28},  {231.0, 8.8, -28.3, 23.3, 2.28},
                           {289.0, 5.2, -33.4, 24.8, 1.87},   {405.0, -3.3, -41.1, 27.8, 2.03},
                           {580.0, -18.0, -51.0, 30.8, 1.81}, {813.0, -38.8, -64.6, 33.3, 1.85},
                           {989.0, -54.2, -76.6, 35.3, 1.69}};
enum { ROWS = sizeof rows / sizeof *rows, EARLY = 6 };

static const char *keys_of(char keys[120], const plane *s, const char *quantity, double us) {
  snprintf(keys, 120, "case=shock_bubble quantity=%s n=%lld us=%g", quantity, (long long)s->n, us);
  return keys;
}

/* The shock meets R22 in one dimension. */
static int validate_theory(void) {
  sph_context *ctx;
  sph_riemann_side left, right;
  sph_riemann_solution solution;
  need(NULL, sph_context_create(NULL, &ctx));
  sph_riemann_side_init(&left);
  sph_riemann_side_init(&right);
  sph_riemann_solution_init(&solution);
  left.rho = r22.rho, left.p = r22.p, left.gamma = r22.gamma;
  right.rho = shocked.rho, right.v = shocked.u, right.p = shocked.p, right.gamma = shocked.gamma;
  need(ctx, sph_riemann_solve(ctx, &left, &right, &solution));
  sph_context_destroy(ctx);
  int failed =
      result_line("case=shock_bubble quantity=planar_p", solution.p, 1.75469, PLANAR, 1e-5, 0);
  failed += result_line("case=shock_bubble quantity=planar_refracted_shock",
                        -unit_speed * solution.head[0], 236.4, PLANAR, 0.05, 0);
  failed += result_line("case=shock_bubble quantity=planar_interface", -unit_speed * solution.v[0],
                        85.1, PLANAR, 0.05, 0);
  return failed + result_line("case=shock_bubble quantity=planar_reflected_shock",
                              unit_speed * solution.head[1], 269.9, PLANAR, 0.05, 0);
}

/* What the lattice makes of the circle: its extents at the start, which is where 25 mm is due. */
typedef struct extents {
  double upstream, downstream, height;
} extents;

static extents measure(const plane *s) {
  return (extents){interface(s, 1.0), interface(s, -1.0), bubble_height(s)};
}

/* Up to 405 us within 1.5 mm, where the spacing is below 1 mm; later the source's own comparison is
 * by eye. */
static int check_row(const plane *s, const row *r, const extents *start, int held) {
  const extents now = measure(s);
  const double circle = 1e3 * radius, known[] = {r->upstream, r->downstream, r->height};
  const double measured[] = {now.upstream - start->upstream + circle,
                             now.downstream - start->downstream - circle,
                             now.height - start->height + circle};
  static const char *const names[] = {"upstream_mm", "downstream_mm", "half_height_mm"};
  char keys[120];
  int failed = 0;
  for (int k = 0; k < 3; ++k) {
    keys_of(keys, s, names[k], r->us);
    if (held && (k < 2 || r->us < 300.0))
      failed += result_line(keys, measured[k], known[k], VOLUMES, 1.5, 0);
    else
      result_report(
          keys, measured[k], known[k], VOLUMES,
          "held where the spacing is below 1 mm, up to 405 us; the height up to 289, while "
          "the bubble does not overhang");
  }
  result_report(keys_of(keys, s, "p_max", r->us), highest_pressure(s), r->p, VOLUMES,
                "a peak of focused waves, which the spacing limits");
  return failed;
}

/* Speeds in m/s between the first two or three rows. */
typedef struct fronts {
  double refracted[3], wall[3], upstream[3];
} fronts;

static void take_fronts(const plane *s, int k, fronts *f) {
  f->refracted[k] = front(s, 0, 0.5 * (1.0 + 1.75469));
  f->wall[k] = front(s, 1, 0.5 * (1.0 + shocked.p));
  f->upstream[k] = interface(s, 1.0);
}

static double speed_of(const double *mm, int to) {
  return -1e3 * (mm[to] - mm[0]) / (rows[to].us - rows[0].us);
}

static int check_fronts(const plane *s, const fronts *f) {
  char keys[120];
  int failed = 0;
  keys_of(keys, s, "refracted_shock", 172.0);
  if (s->dp < 1e-3)
    failed += result_line(keys, speed_of(f->refracted, 2), 240.0, MEASURED, 0.05, 1);
  else
    result_report(keys, speed_of(f->refracted, 2), 240.0, MEASURED,
                  "held where the spacing is below 1 mm");
  failed += result_line(keys_of(keys, s, "refracted_shock_volumes", 172.0),
                        speed_of(f->refracted, 2), 244.0, VOLUMES, 0.05, 1);
  failed += result_line(keys_of(keys, s, "shock_at_wall", 114.0), speed_of(f->wall, 1), 414.0,
                        VOLUMES, 0.05, 1);
  result_report(keys_of(keys, s, "upstream_interface", 114.0), speed_of(f->upstream, 1), 81.0,
                VOLUMES, "its places are held above");
  return failed;
}

static int check_end(plane *s) {
  char keys[120];
  run_to(s, 1020.0);
  int failed =
      result_bound(keys_of(keys, s, "vortex_speed", 1020.0), vortex_speed(s), 1, 10.0, THESIS);
  failed += result_bound(keys_of(keys, s, "thickness_on_axis_mm", 1020.0),
                         interface(s, 1.0) - interface(s, -1.0), -1, 30.0, VOLUMES);
  result_report(keys_of(keys, s, "energy_error", 1020.0), plane_drift(s), NAN, "steps",
                "of the whole energy; the moving end does work, which the ledger counts");
  result_report(keys_of(keys, s, "particle_steps_per_second", 1020.0), plane_speed(s), NAN,
                "one thread", "a speed");
  return failed;
}

static int validate_size(int lines) {
  fronts f;
  plane s;
  int failed = 0;
  bubble_create(&s, lines);
  const extents start = measure(&s);
  for (int k = 0; k < ROWS; ++k) {
    run_to(&s, rows[k].us);
    failed += check_row(&s, &rows[k], &start, k < EARLY && s.dp < 1e-3);
    if (k < 3) take_fronts(&s, k, &f);
    if (k == 2) failed += check_fronts(&s, &f);
  }
  failed += check_end(&s);
  plane_destroy(&s);
  return failed;
}

static int validate(int full) {
  int failed = validate_theory();
  failed += validate_size(32);
  return failed + (full ? validate_size(45) : 0);
}

#endif
