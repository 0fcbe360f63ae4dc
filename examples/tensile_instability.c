/* Tensile instability: stretched particles clump although the body should stand still. Three cures.
 *
 * Equations   dv_i/dt = sum_j m_j (sigma_i/rho_i^2 + sigma_j/rho_j^2 [+ f^4 (R_i + R_j)]) g_ij,
 *             dx_i/dt = v_i, Hooke's law in rate form (plane stress; bar: uniaxial stress) with the
 *             Jaumann rate, rho constant, uncorrected gradients, no viscosity. The summed form: in
 *             the difference form a uniform stress exerts no force and nothing happens.
 * Set-up      Magnesium (E = 45 GPa, nu = .35, rho = 1738) under a uniform stress of +-3 GPa in all
 *             directions, cubic spline, h = 1.2 dp, dp = .01 m; one particle gets 1e-7 m/s. Plate
 *             of .5 m, particles within .03 m of its edges held; bar: 64 particles, periodic. RK4,
 *             c dt/dp = .25, 1 ms.
 * Theory      Swegle, He 2015 (3.18): unstable where W''(r) sigma > 0 at the neighbours' distance;
 *             cubic spline: tension for h < 1.5 dp. Growth rates: linear analysis of the lattice.
 * Cures       artificial stress (epsilon .3, n = 4), He 2015 (3.22); stress points
 *             (stress_points.h); pairs and kernels of the initial configuration (total Lagrangian
 *             as printed, He 2015 (3.27), (3.28), and in full).
 * Reference   He 2015, 3.5.1, figs. 3.3, 3.4, without figures; times for the bar: an independent
 *             program.
 * Expected    compression: below 1e-6 m/s at 1 ms. Tension: above 1e-3 m/s before .1 ms, and
 *             clumps; cured: below 1e-6 m/s. But: on a square lattice the artificial stress only
 *             slows the instability down. It acts on the four nearest neighbours and leaves the
 *             diagonal ones, at q = 1.18, where W'' > 0, to push rows of particles past each other,
 *             at 9.6e4/s for any epsilon about .3 (2.2e5/s without). With h = 1.6 dp, says linear
 *             analysis, nothing grows at epsilon .2 or .3 (7e4/s without), and so it is; in a
 *             triangular lattice all six neighbours are near, and it cures at h = 1.2 dp, too.
 *
 *   tensile_instability            the table
 *   tensile_instability validate   one RESULT line a figure; long: stress points in the full plate
 */
#include "common.h"

#include <string.h>

static const double young = 45e9, poisson = 0.35, density = 1738.0, dp = 0.01, end_time = 1e-3;

enum { BAR = 1, SQUARE, TRIANGULAR }; /* lattices */
enum { NONE, ARTIFICIAL, POINTS, POINTS_DIFFERENCE, INITIAL, LAGRANGIAN };

typedef struct body {
  int lattice;
  int side;         /* particles along the x axis */
  double stress, h; /* h in units of dp */
  int cure;
} body;

typedef struct outcome {
  double speed;    /* largest at the end */
  double exceeds;  /* first time above 1e-3 m/s; NaN: never */
  double growth;   /* rate between 1e-5 and 1e-3 m/s */
  double distance; /* of the closest pair at the end, in units of dp */
} outcome;

/* ---- set-up ------------------------------------------------------------------------------ */

static int dim_of(const body *b) { return b->lattice == BAR ? 1 : 2; }

/* Distance of the rows in units of dp, and their number. */
static double row_distance(const body *b) { return b->lattice == TRIANGULAR ? sqrt(0.75) : 1.0; }

static int64_t total(const body *b) {
  return b->lattice == BAR ? b->side : b->side * lround(b->side / row_distance(b));
}

static double volume(const body *b) { return b->lattice == BAR ? dp : dp * dp * row_distance(b); }

/* Place of particle i; rows of the triangular lattice are shifted by turns. */
static void place(const body *b, int64_t i, double *x) {
  const int64_t row = b->lattice == BAR ? 0 : i / b->side;
  const double shift = b->lattice == TRIANGULAR ? (row % 2 ? 0.75 : 0.25) : 0.5;
  x[0] = ((double)(i % b->side) + shift) * dp;
  if (b->lattice != BAR) x[1] = ((double)row + 0.5) * dp * row_distance(b);
}

static sph_particles *make_particles(sph_context *ctx, const body *b) {
  sph_particles *set;
  sph_particles_options options;
  const int dim = dim_of(b);
  sph_particles_options_init(&options);
  options.dim = dim;
  need(ctx, sph_particles_create(ctx, &options, &set));
  need(ctx, sph_particles_add(set, total(b), NULL));
  double *x = field(ctx, set, SPH_FIELD_X), *rest = field(ctx, set, SPH_FIELD_X0);
  double *m = field(ctx, set, SPH_FIELD_M), *rho = field(ctx, set, SPH_FIELD_RHO);
  double *h = field(ctx, set, SPH_FIELD_H), *sigma = field(ctx, set, SPH_FIELD_SIGMA);
  for (int64_t i = 0; i < total(b); ++i) {
    place(b, i, x + i * dim);
    place(b, i, rest + i * dim);
    for (int a = 0; a < dim; ++a) sigma[i * sph_sym_components(dim) + a] = b->stress;
    m[i] = density * volume(b);
    rho[i] = density;
    h[i] = b->h * dp;
  }
  const int64_t row = dim == 1 ? 0 : total(b) / b->side / 2; /* the middle */
  field(ctx, set, SPH_FIELD_V)[(row * b->side + b->side / 2) * dim] = 1e-7;
  return set;
}

static sph_neighbors *make_list(sph_context *ctx, const body *b) {
  sph_neighbors *list;
  sph_neighbors_options options;
  sph_neighbors_options_init(&options);
  options.method = SPH_NEIGHBORS_VERLET;
  options.skin = 0.2 * dp;
  options.periodic[0] = b->lattice == BAR;
  options.box_hi[0] = b->side * dp;
  need(ctx, sph_neighbors_create(ctx, &options, &list));
  return list;
}

/* The edges of the plate: their velocity is 0 and stays so. */
static sph_hold *make_hold(sph_context *ctx, const body *b) {
  const double near = 3.0 * dp, width = b->side * dp;
  sph_hold *hold;
  need(ctx, sph_hold_create(ctx, &hold));
  for (int64_t i = 0; b->lattice != BAR && i < total(b); ++i) {
    double x[2];
    place(b, i, x);
    if (fmin(x[0], width - x[0]) < near || fmin(x[1], width - x[1]) < near)
      need(ctx, sph_hold_field(hold, SPH_FIELD_V, 1, &i, 0, UINT64_MAX, NULL, NULL, NULL));
  }
  return hold;
}

static sph_material *make_material(sph_context *ctx, const body *b) {
  sph_material *hooke;
  sph_hooke_options elastic;
  sph_hooke_options_init(&elastic);
  elastic.young = young;
  elastic.poisson = poisson;
  elastic.density = density;
  elastic.reduction = b->lattice == BAR ? SPH_UNIAXIAL_STRESS : SPH_PLANE_STRESS;
  need(ctx, sph_material_create_hooke(ctx, &elastic, &hooke));
  return hooke;
}

static sph_rhs *make_rhs(sph_context *ctx, sph_kernel *kernel, sph_material *hooke, const body *b,
                         sph_hold *hold) {
  const int32_t kinds[] = {b->cure == LAGRANGIAN ? SPH_TERM_FIRST_PIOLA : SPH_TERM_STRESS,
                           SPH_TERM_STRESS_RATE, SPH_TERM_MOTION, SPH_TERM_ARTIFICIAL_STRESS};
  sph_rhs *rhs;
  sph_rhs_options options;
  sph_rhs_options_init(&options);
  if (b->cure == INITIAL || b->cure == LAGRANGIAN) options.position_field = SPH_FIELD_X0;
  need(ctx, sph_rhs_create(ctx, kernel, &options, &rhs));
  for (int k = 0; k < (b->cure == ARTIFICIAL ? 4 : 3); ++k) {
    sph_term term;
    sph_term_init(&term);
    term.kind = kinds[k];
    if (kinds[k] == SPH_TERM_FIRST_PIOLA) term.form = SPH_PIOLA_SUMMED;
    if (b->cure == LAGRANGIAN && kinds[k] == SPH_TERM_STRESS_RATE)
      term.form = SPH_STRESS_RATE_LAGRANGIAN;
    if (k == 3) {
      term.epsilon = 0.3;
      term.spacing_ratio = 1.0 / b->h;
    }
    need(ctx, sph_rhs_add(rhs, &term));
  }
  need(ctx, sph_rhs_set_material(rhs, 0, hooke));
  need(ctx, sph_rhs_set_finish(rhs, sph_hold_finish, hold));
  return rhs;
}

static sph_stress_points *make_points(sph_context *ctx, sph_kernel *kernel, sph_neighbors *list,
                                      sph_material *hooke, const body *b, sph_hold *hold) {
  sph_stress_points *points;
  sph_stress_points_options options;
  sph_stress_points_options_init(&options);
  options.form = b->cure == POINTS ? SPH_STRESS_SUMMED : SPH_STRESS_DIFFERENCE;
  options.corrected = 0;
  options.finish = sph_hold_finish;
  options.finish_user = hold;
  need(ctx, sph_stress_points_create(ctx, kernel, list, &options, &points));
  need(ctx, sph_stress_points_set_material(points, 0, hooke));
  return points;
}

/* ---- running ----------------------------------------------------------------------------- */

static double largest_speed(const sph_particles *set, int dim) {
  const double *v = sph_particles_field_const(set, SPH_FIELD_V);
  double most = 0.0;
  for (int64_t k = 0; k < sph_particles_count(set) * dim; ++k) most = fmax(most, fabs(v[k]));
  return most;
}

static double closest(const sph_particles *set, const body *b) {
  const double *x = sph_particles_field_const(set, SPH_FIELD_X), box = b->side * dp;
  const int dim = dim_of(b);
  double least = INFINITY;
  for (int64_t i = 0; i < total(b); ++i)
    for (int64_t j = 0; j < i; ++j) {
      double d = x[i * dim] - x[j * dim];
      if (dim == 1) d -= box * nearbyint(d / box);
      least = fmin(least, dim == 1 ? fabs(d) : hypot(d, x[2 * i + 1] - x[2 * j + 1]));
    }
  return least / dp;
}

/* Until the end, or until the closest particles have lost half of their distance. The packet of
 * waves that starts at one particle grows as exp(growth t) / t^(dim/2), for it spreads. */
static outcome advance(sph_context *ctx, sph_integrator *it, sph_particles *set, const body *b) {
  const double dt = 0.25 * dp / sqrt(young / density);
  outcome o = {0.0, NAN, NAN, 1.0};
  double low = 0.0, low_time = 0.0;
  for (int64_t k = 1; (double)(k - 1) * dt < end_time; ++k) {
    need(ctx, sph_integrator_step(it, set, (double)(k - 1) * dt, dt, NULL));
    o.speed = largest_speed(set, dim_of(b));
    if (low == 0.0 && o.speed > 1e-5) {
      low = o.speed;
      low_time = (double)k * dt;
    }
    if (isnan(o.exceeds) && o.speed > 1e-3) {
      o.exceeds = (double)k * dt;
      o.growth = (log(o.speed / low) + 0.5 * dim_of(b) * log(o.exceeds / low_time)) /
                 (o.exceeds - low_time);
    }
    if (o.speed > 1.0 && k % 10 == 0 && closest(set, b) < 0.5) break;
  }
  o.distance = closest(set, b);
  return o;
}

static outcome run(const body *b) {
  sph_context *ctx;
  sph_kernel *kernel;
  sph_integrator *it;
  sph_rhs *rhs = NULL;
  sph_stress_points *points = NULL;
  need(NULL, sph_context_create(NULL, &ctx));
  need(ctx, sph_kernel_create(ctx, SPH_KERNEL_CUBIC_SPLINE, dim_of(b), &kernel));
  need(ctx, sph_integrator_create(ctx, NULL, &it)); /* RK4 */
  sph_particles *set = make_particles(ctx, b);
  sph_neighbors *list = make_list(ctx, b);
  sph_hold *hold = make_hold(ctx, b);
  sph_material *hooke = make_material(ctx, b);
  if (b->cure == POINTS || b->cure == POINTS_DIFFERENCE) {
    points = make_points(ctx, kernel, list, hooke, b, hold);
    need(ctx, sph_stress_points_place(points, set));
    need(ctx, sph_stress_points_bind(points, it));
  } else {
    rhs = make_rhs(ctx, kernel, hooke, b, hold);
    need(ctx, sph_integrator_bind_field(it, SPH_FIELD_V));
    need(ctx, sph_integrator_bind_field(it, SPH_FIELD_X));
    need(ctx, sph_integrator_bind_field(it, SPH_FIELD_SIGMA));
    need(ctx, sph_integrator_set_rhs(it, rhs, list));
  }
  const outcome o = advance(ctx, it, set, b);
  sph_integrator_destroy(it);
  sph_stress_points_destroy(points);
  sph_rhs_destroy(rhs);
  sph_material_destroy(hooke);
  sph_hold_destroy(hold);
  sph_neighbors_destroy(list);
  sph_particles_destroy(set);
  sph_kernel_destroy(kernel);
  sph_context_destroy(ctx);
  return o;
}

/* ---- table ------------------------------------------------------------------------------- */

static const char *const cures[] = {"none",
                                    "artificial_stress",
                                    "stress_points",
                                    "stress_points_difference",
                                    "initial_configuration",
                                    "total_lagrangian"};
static const char *const lattices[] = {"?", "bar", "square", "triangular"};

static int table(void) {
  static const body bodies[] = {
      {SQUARE, 50, -3e9, 1.2, NONE},          {SQUARE, 50, 3e9, 1.2, NONE},
      {SQUARE, 50, 3e9, 1.2, ARTIFICIAL},     {TRIANGULAR, 50, 3e9, 1.2, NONE},
      {TRIANGULAR, 50, 3e9, 1.2, ARTIFICIAL}, {SQUARE, 25, 3e9, 1.2, POINTS},
      {SQUARE, 50, 3e9, 1.2, INITIAL},        {SQUARE, 50, 3e9, 1.2, LAGRANGIAN}};
  printf("%-12s %10s  %-22s %12s %16s %14s\n", "lattice", "stress/GPa", "cure", "speed m/s",
         "1e-3 m/s at s", "closest/dp");
  for (size_t k = 0; k < sizeof bodies / sizeof *bodies; ++k) {
    const body *b = &bodies[k];
    const outcome o = run(b);
    printf("%-12s %10g  %-22s %12.3g %16.3g %14.3f\n", lattices[b->lattice], b->stress / 1e9,
           cures[b->cure], o.speed, o.exceeds, o.distance);
    fflush(stdout);
  }
  return 0;
}

/* Every figure of the case; nothing in there is needed to use the library. */
#include "tensile_instability_validate.h"

int main(int argc, char **argv) {
  const char *mode = argc > 1 ? argv[1] : "demo";
  return (strcmp(mode, "demo") == 0 ? table() : validate(strcmp(mode, "long") == 0)) != 0;
}
