/* The rate form of isotropic linear elasticity, with the Jaumann rate.
 *
 * In every reduction the rate of the stored components is
 *     sigma'_aa = stiff * L_aa + cross * (sum of the other L_bb),   sigma'_ab = G (L_ab + L_ba)
 * and only `stiff` and `cross` differ. */
#include "elastic_impl.h"

static void rate_1d(const sphi_moduli *m, const sph_material_block *b, double *rate) {
  for (int64_t i = 0; i < b->n; i++) rate[i] = m->stiff * b->velocity_gradient[i];
}

static void elastic_2d(const sphi_moduli *m, const double l[4], double r[3]) {
  r[0] = m->stiff * l[0] + m->cross * l[3];
  r[1] = m->stiff * l[3] + m->cross * l[0];
  r[2] = m->shear * (l[1] + l[2]);
}

/* r += omega s - s omega */
static void rotate_2d(const double l[4], const double s[3], double r[3]) {
  const double w = 0.5 * (l[1] - l[2]);
  r[0] += 2 * w * s[2];
  r[1] -= 2 * w * s[2];
  r[2] += w * (s[1] - s[0]);
}

static void rate_2d(const sphi_moduli *m, int32_t jaumann, const sph_material_block *b,
                    double *rate) {
  for (int64_t i = 0; i < b->n; i++) {
    double r[3]; /* so that `rate` may be the array of the stress */
    elastic_2d(m, b->velocity_gradient + 4 * i, r);
    if (jaumann) rotate_2d(b->velocity_gradient + 4 * i, b->sigma + 3 * i, r);
    for (int32_t c = 0; c < 3; c++) rate[3 * i + c] = r[c];
  }
}

static void elastic_3d(const sphi_moduli *m, const double l[9], double r[6]) {
  r[0] = m->stiff * l[0] + m->cross * (l[4] + l[8]);
  r[1] = m->stiff * l[4] + m->cross * (l[0] + l[8]);
  r[2] = m->stiff * l[8] + m->cross * (l[0] + l[4]);
  r[3] = m->shear * (l[1] + l[3]);
  r[4] = m->shear * (l[2] + l[6]);
  r[5] = m->shear * (l[5] + l[7]);
}

/* r += omega s - s omega, written out for s = {xx, yy, zz, xy, xz, yz} */
static void rotate_3d(const double l[9], const double s[6], double r[6]) {
  const double xy = 0.5 * (l[1] - l[3]), xz = 0.5 * (l[2] - l[6]), yz = 0.5 * (l[5] - l[7]);
  r[0] += 2 * (xy * s[3] + xz * s[4]);
  r[1] += 2 * (yz * s[5] - xy * s[3]);
  r[2] -= 2 * (xz * s[4] + yz * s[5]);
  r[3] += xy * (s[1] - s[0]) + xz * s[5] + yz * s[4];
  r[4] += xz * (s[2] - s[0]) + xy * s[5] - yz * s[3];
  r[5] += yz * (s[2] - s[1]) - xy * s[4] - xz * s[3];
}

static void rate_3d(const sphi_moduli *m, int32_t jaumann, const sph_material_block *b,
                    double *rate) {
  for (int64_t i = 0; i < b->n; i++) {
    double r[6]; /* so that `rate` may be the array of the stress */
    elastic_3d(m, b->velocity_gradient + 9 * i, r);
    if (jaumann) rotate_3d(b->velocity_gradient + 9 * i, b->sigma + 6 * i, r);
    for (int32_t c = 0; c < 6; c++) rate[6 * i + c] = r[c];
  }
}

void sphi_elastic_rate(const sphi_moduli *m, int32_t jaumann, const sph_material_block *b,
                       double *rate) {
  if (b->dim == 1)
    rate_1d(m, b, rate);
  else if (b->dim == 2)
    rate_2d(m, jaumann, b, rate);
  else
    rate_3d(m, jaumann, b, rate);
}

void sphi_elastic_rate_across(const sphi_moduli *m, const sph_material_block *b, double *rate) {
  const int32_t d = b->dim;
  for (int64_t i = 0; i < b->n; i++) {
    const double *l = b->velocity_gradient + i * d * d;
    rate[i] = m->across * (d == 1 ? l[0] : l[0] + l[3]);
  }
}
