/* A square plate with nine circular holes is compressed by a fifth.
 *
 * Equations   dv/dt = Div P / rho,   P = d psi / dF of a neo-Hookean law (plane stress), dx/dt = v,
 *             total-Lagrangian with hourglass control and Monaghan's viscosity, as particles:
 *             plate.h. (He uses updated kernels: see validate.)
 * Set-up      2 m x 2 m, magnesium, a hole of radius .3 m in the middle (no. 5) and eight of .2 m
 *             with centres at 0 and +-.7 m, numbered by rows from 1 to 9. Top and bottom are driven
 *             at 10 m/s each towards the middle for .02 s, free to slide; the rest is free. A
 *             quarter with ghosts: rings about the middle, one more ring on the edge of each other
 *             hole. h = 1.3 dp, alpha = beta = 2.5, RKC at CFL 1.5 with 6 stages. Edges of holes
 *             that fold onto themselves push each other apart.
 * Reference   He 2015, 5.4: pictures alone, of 4616 particles. Stresses gather at holes 1, 3, 7, 9
 *             and 5, which deform most; 4 and 6 deform less, 2 and 8 very little; tension above and
 *             below hole 5.
 * Measure     relative change of the vertical diameter of each hole
 * Expected    that order: -.446 (1), -.562 (5), -.103 (6), -.074 (2) at dp = .025; -.445, -.577,
 *             -.102, -.062 at dp = .0124. Beyond a strain of .15 the columns beside hole 5 buckle,
 *             and hole 6, which had lost .19 of its height, opens again. Hole 5 closes to a slit,
 *             whose lips meet beside (.3, 0): without contact they pass through each other, and at
 *             dp = .0124 det F turns negative there at a strain of .197.
 *
 *   porous_plate             dp = .025, principal stresses at three times as CSV, with a picture
 *   porous_plate validate    the same, RESULT lines; long: dp = .0124, 4600 particles as well */
#include "plate.h"

static const double drive = 10.0, end_time = 0.02;

static const double nine[27] = {0.0,  0.0, 0.3, /* no. 5 first: the rings run about it */
                                -0.7, 0.7, 0.2, 0.0,  0.7,  0.2, 0.7, 0.7,  0.2, -0.7, 0.0,  0.2,
                                0.7,  0.0, 0.2, -0.7, -0.7, 0.2, 0.0, -0.7, 0.2, 0.7,  -0.7, 0.2};

typedef struct outcome {
  int completed;
  double corner, centre, side_hole, top_hole; /* change of the vertical diameter: 1, 5, 6, 2 */
  double strain, rim;                         /* mean; largest principal stress above hole 5 */
  int64_t particles, evaluations;
  double seconds;
} outcome;

typedef struct porous {
  plate p;
  int64_t rims, *rim; /* the particles on the edges of the holes */
} porous;

/* ---- contact ----------------------------------------------------------------------------- */

/* Neighbours at rest are held together and apart by the stress. Others meet where an edge folds:
 * then they push each other away from a potential k (d - r)^2 / 2, d = dp / 2, k = 0.3 E. A quarter
 * also meets its mirror images. There are few particles on edges: every pair is looked at. */
static void push_apart(const porous *o, int64_t i, int64_t j, int image, double *dvdt) {
  const double *x = o->p.x + 2 * i, *y = o->p.x + 2 * j, d = 0.5 * o->p.o.dp;
  const double *X = o->p.rest + 2 * i, *Y = o->p.rest + 2 * j;
  const double a = image & 1 ? -1.0 : 1.0, b = image & 2 ? -1.0 : 1.0;
  const double dx[2] = {x[0] - a * y[0], x[1] - b * y[1]};
  if (fabs(dx[0]) >= d || fabs(dx[1]) >= d) return;
  const double r = hypot(dx[0], dx[1]);
  if (r >= d || hypot(X[0] - a * Y[0], X[1] - b * Y[1]) < 2.0 * o->p.o.h_ratio * o->p.o.dp) return;
  for (int k = 0; k < 2; ++k) dvdt[2 * i + k] += 0.3 * young * (d - r) / (o->p.m[i] * r) * dx[k];
}

static void add_contact(const porous *o, double *dvdt) {
  for (int64_t k = 0; k < o->rims; ++k)
    for (int64_t l = 0; l < o->rims; ++l)
      for (int image = 0; image < (o->p.o.whole ? 1 : 4); ++image)
        push_apart(o, o->rim[k], o->rim[l], image, dvdt);
}

static int is_on_rim(const double *x) {
  for (int h = 0; h < 9; ++h)
    if (fabs(hypot(x[0] - nine[3 * h], x[1] - nine[3 * h + 1]) - nine[3 * h + 2]) < 1e-9) return 1;
  return 0;
}

static void find_rims(porous *o) {
  o->rim = malloc((size_t)o->p.n * sizeof *o->rim);
  if (!o->rim) exit(2);
  for (int64_t i = 0; i < o->p.n; ++i)
    if (is_on_rim(o->p.rest + 2 * i)) o->rim[o->rims++] = i;
}

/* ---- loading ----------------------------------------------------------------------------- */

/* Finish hook: the rows at top and bottom move at the given velocity, which never changes. */
static int32_t drive_rows(void *user, double t, sph_particles *set, const sph_rate *rates,
                          int32_t count) {
  const porous *o = user;
  const plate *p = &o->p;
  (void)t;
  (void)set;
  for (int32_t k = 0; k < count; ++k) {
    if (rates[k].field != SPH_FIELD_V) continue;
    if (p->o.motion == PLATE_TOTAL) add_contact(o, rates[k].values);
    if (!p->o.whole) keep_planes(p, rates[k].values);
    for (int64_t i = 0; i < p->n; ++i)
      if (fabs(p->rest[2 * i + 1]) == side) rates[k].values[2 * i + 1] = 0.0;
  }
  return 0;
}

static const plate_options total = {.holes = 9,
                                    .hole = nine,
                                    .layout = SPH_HOLES_EQUALLY_RADIAL,
                                    .dp = 0.025,
                                    .h_ratio = 1.3,
                                    .viscosity = 2.5,
                                    .hourglass = 0.1,
                                    .motion = PLATE_TOTAL,
                                    .scheme = SPH_INTEGRATOR_RKC,
                                    .cfl = 1.5,
                                    .stages = 6};

static void porous_create(porous *o, const plate_options *options) {
  plate *p = &o->p;
  *o = (porous){.rims = 0};
  plate_create(p, options);
  find_rims(o);
  need(p->ctx, sph_rhs_set_finish(p->rhs, drive_rows, o));
  for (int64_t i = 0; i < p->n; ++i)
    if (fabs(p->rest[2 * i + 1]) == side) p->v[2 * i + 1] = -drive * p->rest[2 * i + 1] / side;
}

static void porous_destroy(porous *o) {
  plate_destroy(&o->p);
  free(o->rim);
}

/* ---- measures ---------------------------------------------------------------------------- */

/* The particle that stood nearest to a point. */
static int64_t nearest(const plate *p, double x, double y) {
  int64_t best = 0;
  double least = INFINITY;
  for (int64_t i = 0; i < p->n; ++i) {
    const double r = hypot(p->rest[2 * i] - x, p->rest[2 * i + 1] - y);
    if (r < least) {
      least = r;
      best = i;
    }
  }
  return best;
}

/* Relative change of the vertical diameter of a hole. One cut by y = 0 has its half there. */
static double diameter_change(const plate *p, double x, double y, double radius) {
  const int64_t top = nearest(p, x, y + radius);
  const double up = p->x[2 * top + 1] - p->rest[2 * top + 1];
  if (y == 0.0 && !p->o.whole) return up / radius;
  const int64_t bottom = nearest(p, x, y - radius);
  return (up - (p->x[2 * bottom + 1] - p->rest[2 * bottom + 1])) / (2.0 * radius);
}

static void principal(const double *s, double *larger, double *smaller) {
  const double mean = 0.5 * (s[0] + s[1]), radius = hypot(0.5 * (s[0] - s[1]), s[2]);
  *larger = mean + radius;
  *smaller = mean - radius;
}

static void measure(plate *p, outcome *r) {
  const int64_t top = nearest(p, 0.0, side), rim = nearest(p, 0.0, 0.3);
  double smaller;
  r->corner = diameter_change(p, 0.7, 0.7, 0.2);
  r->centre = diameter_change(p, 0.0, 0.0, 0.3);
  r->side_hole = diameter_change(p, 0.7, 0.0, 0.2);
  r->top_hole = diameter_change(p, 0.0, 0.7, 0.2);
  find_stress(p);
  r->strain = (p->rest[2 * top + 1] - p->x[2 * top + 1]) / side;
  principal(p->sigma + 3 * rim, &r->rim, &smaller);
}

/* ---- running ----------------------------------------------------------------------------- */

static void write_field(plate *p, int number) {
  char path[64];
  snprintf(path, sizeof path, "porous_%d.csv", number);
  FILE *file = open_output(path);
  find_stress(p);
  fprintf(file, "x,y,s_1,s_2\n");
  for (int64_t i = 0; i < p->n; ++i) {
    double larger, smaller;
    principal(p->sigma + 3 * i, &larger, &smaller);
    for (int mirrored = 0; mirrored < (p->o.whole ? 1 : 4); ++mirrored)
      fprintf(file, "%.6g,%.6g,%.6g,%.6g\n", (mirrored & 1 ? -1 : 1) * p->x[2 * i],
              (mirrored & 2 ? -1 : 1) * p->x[2 * i + 1], larger / 1e9, smaller / 1e9);
  }
  fclose(file);
  printf("  wrote %s\n", path);
}

/* In three parts of equal length, after each of which the field may be written. */
static outcome run(plate *p, double until, int files) {
  outcome r = {.completed = 0, .particles = p->n};
  sph_step_info info;
  sph_step_info_init(&info);
  const int64_t part = (int64_t)ceil(until / 3.0 / p->dt);
  const double dt = until / 3.0 / (double)part;
  const clock_t start = clock();
  for (int64_t k = 0; k < 3 * part; ++k) {
    if (sph_integrator_step(p->integrator, p->set, (double)k * dt, dt, &info) != SPH_OK) return r;
    r.strain = drive * (double)(k + 1) * dt / side;
    r.evaluations += info.evaluations;
    if (files && (k + 1) % part == 0) write_field(p, (int)((k + 1) / part));
  }
  r.seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
  r.completed = 1;
  measure(p, &r);
  return r;
}

static outcome run_once(const plate_options *o, int files) {
  porous all;
  porous_create(&all, o);
  const outcome r = run(&all.p, end_time, files);
  porous_destroy(&all);
  return r;
}

/* ---- demo -------------------------------------------------------------------------------- */

static const char picture[] =
    "set terminal pngcairo noenhanced size 1500,1000\nset output 'porous_plate.png'\n"
    "set datafile separator ','\nset multiplot layout 2,3\nset size ratio -1\nset key off\n"
    "set xrange [-1.3:1.3]\nset yrange [-1.1:1.1]\nset palette rgb 33,13,10\n"
    "do for [c=3:4] { do for [k=1:3] {\n"
    "  set title sprintf('s_%d / GPa at %.5f s', c - 2, k * .02 / 3)\n"
    "  if (c == 3) { set cbrange [-5:5] } else { set cbrange [-25:0] }\n"
    "  plot sprintf('porous_%d.csv', k) skip 1 using 1:2:c with points pt 7 ps .35 palette\n"
    "} }\n";

static int demo(void) {
  const outcome r = run_once(&total, 1);
  printf("Porous plate, %lld particles in a quarter, %lld evaluations, %.1f s\n\n"
         "mean strain %.3f; change of the vertical diameter of hole 1 %.3f, 5 %.3f, 6 %.3f, 2 %.3f;"
         "\ns_1 above hole 5: %.2f GPa\n",
         (long long)r.particles, (long long)r.evaluations, r.seconds, r.strain, r.corner, r.centre,
         r.side_hole, r.top_hole, r.rim / 1e9);
  draw("porous_plate.gp", picture);
  return !r.completed;
}

/* The published ranking; nothing in there is needed to use the library. */
#include "porous_plate_validate.h"

int main(int argc, char **argv) {
  if (argc < 2 || strcmp(argv[1], "demo") == 0) return demo() != 0;
  return validate(strcmp(argv[1], "long") == 0) != 0;
}
