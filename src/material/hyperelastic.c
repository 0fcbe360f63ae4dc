/* Hyperelastic laws: St. Venant-Kirchhoff and compressible neo-Hookean.
 *
 * H = F - I carries the strains, so that nothing is lost to the 1 when they are small. */
#include "../core/eigen.h"
#include "elastic_impl.h"

#include <math.h>
#include <stdio.h>

typedef struct hyper {
  sph_context *ctx;
  int32_t law, dim;
  int32_t free;      /* directions across that are free of stress: 0, 1 or 2 */
  double lambda, mu; /* of the solid */
  double reduced;    /* lambda of St. Venant-Kirchhoff, the strains across eliminated */
  double narrowing;  /* minus the strain across for unit trace of the others, the same law */
  double stiff, density;
} hyper;

/* One particle: det F of what is stored, its logarithm, and that of the stretch across. */
typedef struct stretch {
  double det, log_det, across;
} stretch;

enum { FINE = 0, NOT_POSITIVE, NO_THICKNESS };

void sph_hyperelastic_options_init_sized(sph_hyperelastic_options *options, size_t size) {
  const sph_hyperelastic_options defaults = {
      .size = sizeof defaults, .law = SPH_NEO_HOOKEAN, .reduction = SPH_SOLID};
  sphi_material_init_sized(options, size, &defaults, sizeof defaults);
}

/* ---- small matrices, d = 1, 2, 3 ---- */

static void minus_identity(int32_t d, const double *f, double *h) {
  for (int32_t k = 0; k < d * d; k++) h[k] = f[k] - (k % (d + 1) == 0);
}

static double trace(int32_t d, const double *a) {
  double sum = 0;
  for (int32_t k = 0; k < d; k++) sum += a[k * (d + 1)];
  return sum;
}

/* det F times the transposed inverse of F */
static void cofactors(int32_t d, const double *f, double *c) {
  if (d == 1) {
    c[0] = 1;
  } else if (d == 2) {
    c[0] = f[3], c[1] = -f[2], c[2] = -f[1], c[3] = f[0];
  } else {
    c[0] = f[4] * f[8] - f[5] * f[7], c[1] = f[5] * f[6] - f[3] * f[8];
    c[2] = f[3] * f[7] - f[4] * f[6], c[3] = f[2] * f[7] - f[1] * f[8];
    c[4] = f[0] * f[8] - f[2] * f[6], c[5] = f[1] * f[6] - f[0] * f[7];
    c[6] = f[1] * f[5] - f[2] * f[4], c[7] = f[2] * f[3] - f[0] * f[5];
    c[8] = f[0] * f[4] - f[1] * f[3];
  }
}

/* det(I + H) - 1 - tr H: the other invariants of H */
static double det_minus_trace(int32_t d, const double *h) {
  double c[9];
  if (d == 1) return 0;
  if (d == 2) return h[0] * h[3] - h[1] * h[2];
  cofactors(3, h, c);
  return trace(3, c) + (h[0] * c[0] + h[1] * c[1] + h[2] * c[2]);
}

/* G = (H + H^T + H^T H)/2 */
static void green(int32_t d, const double *h, double *g) {
  for (int32_t a = 0; a < d; a++)
    for (int32_t b = 0; b < d; b++) {
      double sum = h[a * d + b] + h[b * d + a];
      for (int32_t k = 0; k < d; k++) sum += h[k * d + a] * h[k * d + b];
      g[a * d + b] = 0.5 * sum;
    }
}

/* ---- the stretch across ---- */

/* y = ln t with mu (t^2 - 1) + lambda (k y + l) = 0, l = ln det F. The left side is convex in y,
 * so Newton's method from a point right of the root where it rises descends to the root and never
 * passes it. lambda < 0 has a lowest such point, and no root when the value there is positive. */
static int neo_hookean_across(const hyper *law, double l, double *y) {
  enum { STEPS = 200 };
  const double mu = law->mu, lambda = law->lambda, k = law->free;
  double at = 0;
  if (lambda >= 0 && l < 0) at = 0.5 * log1p(-lambda * l / mu);
  if (lambda < 0 && l > 0) at = -lambda * l / (2 * mu + k * lambda);
  for (int step = 0; step < STEPS; step++) {
    double stretch2 = exp(2 * at), value = mu * expm1(2 * at) + lambda * (k * at + l);
    double slope = 2 * mu * stretch2 + k * lambda, change = value / slope;
    if (!(slope > 0) || !isfinite(change)) return NO_THICKNESS;
    *y = at - change;
    /* The error left is the square of this; below, rounding decides the sign. */
    if (!(change > 1e-9 * fabs(*y))) return FINE;
    at = *y;
  }
  return lambda < 0 ? NO_THICKNESS : FINE;
}

static int venant_across(const hyper *law, const double *h, double *y) {
  double g[9];
  green(law->dim, h, g);
  double twice = -2 * law->narrowing * trace(law->dim, g); /* t^2 - 1 */
  if (!(twice > -1)) return NO_THICKNESS;
  *y = 0.5 * log1p(twice);
  return FINE;
}

/* ln det F: near 1 from the invariants of H, where det F has lost them */
static double log_det_of(int32_t d, const double *h, double det) {
  double det1 = trace(d, h) + det_minus_trace(d, h);
  return fabs(det1) < 0.5 ? log1p(det1) : log(det);
}

static int stretch_of(const hyper *law, const double *f, stretch *s) {
  const int32_t d = law->dim;
  double h[9] = {0}, c[9];
  minus_identity(d, f, h);
  cofactors(d, f, c);
  *s = (stretch){.det = 0};
  for (int32_t k = 0; k < d; k++) s->det += f[k] * c[k];
  if (!(s->det > 0) || !isfinite(s->det)) return NOT_POSITIVE;
  s->log_det = log_det_of(d, h, s->det);
  if (law->free == 0) return FINE;
  if (law->law == SPH_NEO_HOOKEAN) return neo_hookean_across(law, s->log_det, &s->across);
  return venant_across(law, h, &s->across);
}

/* ---- the laws, for one particle ---- */

/* P = F (lambda tr(G) I + 2 mu G); returns psi */
static double venant(const hyper *law, int32_t d, const double *f, double *p) {
  double h[9] = {0}, g[9], copy[9], square = 0;
  minus_identity(d, f, h);
  green(d, h, g);
  const double tr = trace(d, g), spherical = law->reduced * tr;
  for (int32_t k = 0; k < d * d; k++) {
    square += g[k] * g[k];
    copy[k] = f[k]; /* so that p may be f */
  }
  for (int32_t a = 0; a < d; a++)
    for (int32_t b = 0; b < d; b++) {
      double sum = spherical * copy[a * d + b];
      for (int32_t k = 0; k < d; k++) sum += 2 * law->mu * copy[a * d + k] * g[k * d + b];
      p[a * d + b] = sum;
    }
  return 0.5 * spherical * tr + law->mu * square;
}

/* x - ln(1 + x), also where the two nearly agree: with y = x/(2 + x), ln(1 + x) = 2 artanh y. */
static double log_rest(double x, double log_1px) {
  if (fabs(x) > 0.1) return x - log_1px;
  const double y = x / (2 + x), y2 = y * y;
  const double odd = y2 * y * (1.0 / 3 + y2 * (0.2 + y2 * (1.0 / 7 + y2 * (1.0 / 9 + y2 / 11))));
  return 2 * (y2 / (1 - y) - odd);
}

/* Of the neo-Hookean law, (F:F - 3)/2 - ln J: every part is of second order in the strains. */
static double shape_energy(const hyper *law, int32_t d, const double *h, const stretch *s) {
  const double others = det_minus_trace(d, h), across = expm1(2 * s->across);
  double square = 0;
  for (int32_t k = 0; k < d * d; k++) square += h[k] * h[k];
  return 0.5 * square - others + log_rest(trace(d, h) + others, s->log_det) +
         0.5 * law->free * log_rest(across, 2 * s->across);
}

/* P = mu (F - F^-T) + lambda ln J F^-T; returns psi */
static double neo_hookean(const hyper *law, int32_t d, const double *f, double *p) {
  double h[9] = {0}, c[9];
  stretch s;
  (void)stretch_of(law, f, &s);
  minus_identity(d, f, h);
  cofactors(d, f, c);
  const double mu = law->mu, log_j = s.log_det + law->free * s.across;
  const double inverse = (law->lambda * log_j - mu) / s.det;
  for (int32_t k = 0; k < d * d; k++) p[k] = mu * f[k] + inverse * c[k];
  return mu * shape_energy(law, d, h, &s) + 0.5 * law->lambda * log_j * log_j;
}

static double first_piola(const hyper *law, int32_t d, const double *f, double *p) {
  return law->law == SPH_NEO_HOOKEAN ? neo_hookean(law, d, f, p) : venant(law, d, f, p);
}

static int32_t hyper_first_piola(void *user, const sph_material_block *b, double *p,
                                 double *energy) {
  const hyper *law = user;
  const int32_t d = law->dim;
  for (int64_t i = 0; i < b->n; i++) {
    double psi = first_piola(law, d, b->deformation_gradient + i * d * d, p + i * d * d);
    if (energy != NULL) energy[i] = psi;
  }
  return 0;
}

/* sigma = P F^T / J */
static void cauchy(const hyper *law, int32_t d, const double *f, double *sigma) {
  static const int32_t row[] = {0, 1, 2, 0, 0, 1}, column[] = {0, 1, 2, 1, 2, 2};
  static const int32_t packed[4][6] = {{0}, {0}, {0, 1, 3}, {0, 1, 2, 3, 4, 5}};
  double p[9];
  stretch s;
  (void)stretch_of(law, f, &s);
  (void)first_piola(law, d, f, p);
  const double jacobian = s.det * exp(law->free * s.across);
  for (int32_t k = 0; k < d * (d + 1) / 2; k++) {
    double sum = 0;
    for (int32_t c = 0; c < d; c++)
      sum += p[row[packed[d][k]] * d + c] * f[column[packed[d][k]] * d + c];
    sigma[k] = sum / jacobian;
  }
}

static int32_t hyper_cauchy(void *user, const sph_material_block *b, double *sigma) {
  const hyper *law = user;
  const int32_t d = law->dim;
  for (int64_t i = 0; i < b->n; i++)
    cauchy(law, d, b->deformation_gradient + i * d * d, sigma + i * (d * (d + 1) / 2));
  return 0;
}

/* ---- wave speeds ---- */

/* Squared principal stretches: of C = F^T F. */
static void principal(int32_t d, const double *f, double *squares) {
  static const int32_t row[] = {0, 1, 2, 0, 0, 1}, column[] = {0, 1, 2, 1, 2, 2};
  static const int32_t packed[4][6] = {{0}, {0}, {0, 1, 3}, {0, 1, 2, 3, 4, 5}};
  double c[6] = {0};
  for (int32_t k = 0; k < d * (d + 1) / 2; k++)
    for (int32_t a = 0; a < d; a++)
      c[k] += f[a * d + row[packed[d][k]]] * f[a * d + column[packed[d][k]]];
  sphi_eigen_symmetric(d, c, squares, NULL);
}

/* rho c^2 of longitudinal waves: d^2 psi/d l^2, less what the free stretches across relieve */
static double neo_hookean_modulus(const hyper *law, double square, const stretch *s) {
  const double k = law->free, mu = law->mu, lambda = law->lambda;
  const double log_j = s->log_det + k * s->across, t2 = exp(2 * s->across);
  const double rest = mu - lambda * log_j, direct = mu + (rest + lambda) / square;
  if (law->free == 0) return direct;
  const double mixed2 = k * k * lambda * lambda / (square * t2);
  return direct - mixed2 / (k * (mu + (rest + k * lambda) / t2));
}

typedef struct modulus {
  double longitudinal, shear;
} modulus;

static modulus neo_hookean_waves(const hyper *law, const double *squares, const stretch *s) {
  modulus m = {0, law->mu};
  for (int32_t i = 0; i < law->dim; i++)
    m.longitudinal = fmax(m.longitudinal, neo_hookean_modulus(law, squares[i], s));
  return m;
}

static modulus venant_waves(const hyper *law, const double *squares) {
  modulus m = {0, law->dim == 1 ? law->mu : 0};
  const double mu = law->mu;
  double twice_trace = 0;
  for (int32_t i = 0; i < law->dim; i++) twice_trace += squares[i] - 1;
  const double spherical = 0.5 * law->reduced * twice_trace;
  for (int32_t i = 0; i < law->dim; i++) {
    double stress = spherical + mu * (squares[i] - 1);
    m.longitudinal = fmax(m.longitudinal, stress + squares[i] * (law->reduced + 2 * mu));
    for (int32_t j = 0; j < i; j++)
      m.shear = fmax(m.shear, spherical - mu + mu * (squares[i] + squares[j]));
  }
  return m;
}

static modulus waves(const hyper *law, const double *f) {
  double squares[3];
  stretch s;
  if (f == NULL) return (modulus){law->stiff, law->mu};
  (void)stretch_of(law, f, &s);
  principal(law->dim, f, squares);
  return law->law == SPH_NEO_HOOKEAN ? neo_hookean_waves(law, squares, &s)
                                     : venant_waves(law, squares);
}

static const double *gradient_of(const sph_material_block *b, int64_t i) {
  return b->deformation_gradient != NULL ? b->deformation_gradient + i * b->dim * b->dim : NULL;
}

static int32_t hyper_sound_speed(void *user, const sph_material_block *b, double *c) {
  const hyper *law = user;
  for (int64_t i = 0; i < b->n; i++) {
    const modulus m = waves(law, gradient_of(b, i));
    const double shear = law->dim > 1 ? m.shear : 0;
    c[i] = sqrt(fmax(m.longitudinal, shear) / law->density);
  }
  return 0;
}

static int32_t hyper_shear_speed(void *user, const sph_material_block *b, double *c) {
  const hyper *law = user;
  for (int64_t i = 0; i < b->n; i++)
    c[i] = sqrt(waves(law, gradient_of(b, i)).shear / law->density);
  return 0;
}

/* ---- the handle ---- */

static int64_t hyper_examine(const void *user, int32_t property, const sph_material_block *b,
                             char *text, size_t room) {
  const hyper *law = user;
  const int32_t d = law->dim;
  (void)property; /* all read F, the wave speeds if they are given it */
  if (b->deformation_gradient == NULL) return -1;
  for (int64_t i = 0; i < b->n; i++) {
    stretch s;
    int wrong = stretch_of(law, b->deformation_gradient + i * d * d, &s);
    if (wrong == FINE) continue;
    if (text != NULL)
      (void)snprintf(text, room,
                     wrong == NOT_POSITIVE ? "det F = %g is not positive and finite"
                                           : "no thickness is free of stress, det F = %g",
                     s.det);
    return i;
  }
  return -1;
}

static void hyper_destroy(void *user) {
  hyper *law = user;
  sphi_free(law->ctx, law, sizeof *law);
}

static void set_constants(hyper *law, const sph_hyperelastic_options *o) {
  const sphi_moduli solid = sphi_moduli_of(o->young, o->poisson, SPH_SOLID);
  const sphi_moduli mine = sphi_moduli_of(o->young, o->poisson, o->reduction);
  law->law = o->law;
  law->dim = sphi_reduction_dim(o->reduction);
  law->lambda = solid.cross;
  law->mu = solid.shear;
  law->reduced = mine.stiff - 2 * mine.shear;
  law->stiff = mine.stiff;
  law->density = o->density;
  if (o->reduction == SPH_PLANE_STRESS) {
    law->free = 1;
    law->narrowing = o->poisson / (1 - o->poisson);
  } else if (o->reduction == SPH_UNIAXIAL_STRESS) {
    law->free = 2;
    law->narrowing = o->poisson;
  }
}

static sph_status make(sph_context *ctx, const sph_hyperelastic_options *o, sph_material **out) {
  hyper *law = sphi_calloc(ctx, sizeof *law);
  if (law == NULL) return SPH_ERR_NOMEM;
  law->ctx = ctx;
  set_constants(law, o);
  const sph_material_functions f = {.size = sizeof f,
                                    .sound_speed = hyper_sound_speed,
                                    .shear_speed = hyper_shear_speed,
                                    .first_piola = hyper_first_piola,
                                    .cauchy_stress = hyper_cauchy,
                                    .destroy = hyper_destroy};
  sph_status status = sphi_material_make(ctx, &f, law, out);
  if (status != SPH_OK) {
    sphi_free(ctx, law, sizeof *law);
    return status;
  }
  (*out)->dim = law->dim;
  (*out)->examine = hyper_examine;
  (*out)->needs[SPHI_MATERIAL_FIRST_PIOLA] = SPHI_NEEDS_F;
  (*out)->needs[SPHI_MATERIAL_CAUCHY_STRESS] = SPHI_NEEDS_F;
  return SPH_OK;
}

sph_status sph_material_create_hyperelastic(sph_context *ctx,
                                            const sph_hyperelastic_options *options,
                                            sph_material **out) {
  sph_hyperelastic_options o = {.size = 0};
  sph_hyperelastic_options_init(&o);
  sph_status status = sphi_material_begin(ctx, "hyperelastic", &o, sizeof o, options, out);
  if (status != SPH_OK) return status;
  if (o.law != SPH_ST_VENANT_KIRCHHOFF && o.law != SPH_NEO_HOOKEAN)
    return sphi_fail(ctx, SPH_ERR_ARG, "hyperelastic: unknown law %d", (int)o.law);
  status = sphi_elastic_check(ctx, "hyperelastic", o.young, o.poisson, o.density, o.reduction);
  return status == SPH_OK ? make(ctx, &o, out) : status;
}
