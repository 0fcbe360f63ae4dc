/* How much of a cell lies in the region: discs in closed form, a host's test by halving. */
#include "cell.h"

#include <math.h>

static double cross(const double *a, const double *b) { return a[0] * b[1] - a[1] * b[0]; }
static double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1]; }

double sphi_polygon_area(const sphi_polygon *polygon) {
  double twice = 0.0;
  for (int64_t k = 0; k < polygon->n; ++k)
    twice += cross(polygon->p[k], polygon->p[k + 1 < polygon->n ? k + 1 : 0]);
  return 0.5 * twice;
}

/* ---- discs ------------------------------------------------------------------------------- */

static double sector(const double *a, const double *b, double radius) {
  return 0.5 * radius * radius * atan2(cross(a, b), dot(a, b));
}

/* Signed area of the triangle (0, a, b) within the disc about 0. The line a + t (b - a) is in the
 * disc for t0 < t < t1. */
static double triangle_in_disc(const double *a, const double *b, double radius) {
  const double along[2] = {b[0] - a[0], b[1] - a[1]};
  const double length2 = dot(along, along);
  if (length2 == 0.0) return 0.0;
  const double middle = -dot(a, along) / length2, height = cross(a, b);
  const double root = radius * radius * length2 - height * height;
  if (root <= 0.0) return sector(a, b, radius);
  const double half = sqrt(root) / length2;
  const double t0 = fmax(0.0, middle - half), t1 = fmin(1.0, middle + half);
  if (t0 >= t1) return sector(a, b, radius);
  const double enter[2] = {a[0] + t0 * along[0], a[1] + t0 * along[1]};
  const double leave[2] = {a[0] + t1 * along[0], a[1] + t1 * along[1]};
  double area = 0.5 * height * (t1 - t0);
  if (t0 > 0.0) area += sector(a, enter, radius);
  if (t1 < 1.0) area += sector(leave, b, radius);
  return area;
}

double sphi_polygon_in_disc(const sphi_polygon *polygon, const double *centre, double radius) {
  double area = 0.0;
  for (int64_t k = 0; k < polygon->n; ++k) {
    const double *p = polygon->p[k], *q = polygon->p[k + 1 < polygon->n ? k + 1 : 0];
    const double a[2] = {p[0] - centre[0], p[1] - centre[1]};
    const double b[2] = {q[0] - centre[0], q[1] - centre[1]};
    area += triangle_in_disc(a, b, radius);
  }
  return area;
}

/* ---- moments ----------------------------------------------------------------------------- */

void sphi_add_segment(sphi_moments *moments, double lo, double hi) {
  moments->volume += hi - lo;
  moments->first[0] += 0.5 * (hi * hi - lo * lo);
  moments->second += (hi * hi * hi - lo * lo * lo) / 3.0;
}

/* int |y|^2 = A/6 (a^2 + b^2 + c^2 + a.b + b.c + c.a). */
void sphi_add_triangle(sphi_moments *moments, const double *a, const double *b, const double *c) {
  const double u[2] = {b[0] - a[0], b[1] - a[1]}, v[2] = {c[0] - a[0], c[1] - a[1]};
  const double area = 0.5 * cross(u, v);
  moments->volume += area;
  for (int k = 0; k < 2; ++k) moments->first[k] += area / 3.0 * (a[k] + b[k] + c[k]);
  moments->second +=
      area / 6.0 * (dot(a, a) + dot(b, b) + dot(c, c) + dot(a, b) + dot(b, c) + dot(c, a));
}

/* int |y|^2 = V/20 (a^2 + b^2 + c^2 + d^2 + (a + b + c + d)^2). */
static void add_tetrahedron(sphi_moments *moments, const double *a, const double *b,
                            const double *c, const double *d) {
  double u[3], v[3], w[3], squares = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double sum = a[k] + b[k] + c[k] + d[k];
    u[k] = b[k] - a[k];
    v[k] = c[k] - a[k];
    w[k] = d[k] - a[k];
    squares += a[k] * a[k] + b[k] * b[k] + c[k] * c[k] + d[k] * d[k] + sum * sum;
  }
  const double volume =
      fabs(u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
           u[2] * (v[0] * w[1] - v[1] * w[0])) /
      6.0;
  moments->volume += volume;
  for (int k = 0; k < 3; ++k) moments->first[k] += volume / 4.0 * (a[k] + b[k] + c[k] + d[k]);
  moments->second += volume / 20.0 * squares;
}

/* ---- a host's test ----------------------------------------------------------------------- */

typedef struct corner {
  double p[3]; /* relative to the particle; 0 beyond the dimension */
  int inside;
} corner;

typedef struct halving {
  const sph_region_options *region;
  const double *x;
  sphi_moments *sum;
  int always, last; /* levels */
} halving;

int sphi_in_region(const sph_region_options *region, const double *at) {
  for (int32_t k = 0; k < region->holes; ++k) {
    const double *hole = sphi_hole(region->hole, k);
    const double d[2] = {at[0] - hole[0], at[1] - hole[1]};
    if (dot(d, d) < hole[2] * hole[2]) return 0;
  }
  return region->inside == NULL || region->inside(region->inside_user, at) != 0;
}

static corner look(const halving *h, double px, double py, double pz) {
  const corner c = {{px, py, pz}, 0};
  double at[3] = {0.0, 0.0, 0.0};
  for (int32_t a = 0; a < h->region->dim; ++a) at[a] = h->x[a] + c.p[a];
  return (corner){{px, py, pz}, sphi_in_region(h->region, at)};
}

/* The point a + t (b - a). */
static corner along(const halving *h, const corner *a, const corner *b, double t) {
  return look(h, a->p[0] + t * (b->p[0] - a->p[0]), a->p[1] + t * (b->p[1] - a->p[1]),
              a->p[2] + t * (b->p[2] - a->p[2]));
}

static corner between(const halving *h, const corner *a, const corner *b) {
  return look(h, 0.5 * (a->p[0] + b->p[0]), 0.5 * (a->p[1] + b->p[1]), 0.5 * (a->p[2] + b->p[2]));
}

/* The point of the edge from a to b, of which one is inside, where the region ends. */
static corner crossing(const halving *h, const corner *a, const corner *b) {
  double lo = 0.0, hi = 1.0;
  for (int k = 0; k < 30; ++k) {
    const double t = 0.5 * (lo + hi);
    const corner at = along(h, a, b, t);
    *(at.inside == a->inside ? &lo : &hi) = t;
  }
  return along(h, a, b, 0.5 * (lo + hi));
}

/* Corners alone do not tell about the middle of what is large: pieces larger than a quarter of the
 * spacing always split. Cells that reach far beyond the region need more levels than others. */
static void set_levels(halving *h, const sphi_measure *how, double size) {
  enum { ALWAYS = 2, MOST = 20 };
  int more = 0;
  for (; more < MOST && size > 2.0 * how->spacing; size *= 0.5) ++more;
  h->always = ALWAYS + more;
  h->last = how->levels + more;
}

static void segment(const halving *h, const corner *a, const corner *b, int level) {
  const int last = level >= h->last;
  if (a->inside == b->inside && (last || level >= h->always)) {
    if (a->inside) sphi_add_segment(h->sum, a->p[0], b->p[0]);
  } else if (last) {
    const corner end = crossing(h, a, b);
    sphi_add_segment(h->sum, a->inside ? a->p[0] : end.p[0], a->inside ? end.p[0] : b->p[0]);
  } else {
    const corner middle = between(h, a, b);
    segment(h, a, &middle, level + 1);
    segment(h, &middle, b, level + 1);
  }
}

void sphi_segment_inside(const sphi_measure *how, double x, double lo, double hi,
                         sphi_moments *moments) {
  halving h = {how->region, &x, moments, 0, 0};
  const corner a = look(&h, lo, 0.0, 0.0), b = look(&h, hi, 0.0, 0.0);
  set_levels(&h, how, hi - lo);
  segment(&h, &a, &b, 0);
}

/* A triangle of which one corner differs from the other two, cut straight. */
static void cut_triangle(const halving *h, const corner *c) {
  int odd = 0;
  while (c[(odd + 1) % 3].inside != c[(odd + 2) % 3].inside) ++odd;
  const corner *top = &c[odd], *left = &c[(odd + 1) % 3], *right = &c[(odd + 2) % 3];
  const corner a = crossing(h, top, left), b = crossing(h, top, right);
  if (top->inside) {
    sphi_add_triangle(h->sum, top->p, a.p, b.p);
  } else {
    sphi_add_triangle(h->sum, a.p, left->p, right->p);
    sphi_add_triangle(h->sum, a.p, right->p, b.p);
  }
}

static void triangle(const halving *h, const corner *c, int level) {
  const int all = c[0].inside == c[1].inside && c[1].inside == c[2].inside;
  const int last = level >= h->last;
  if (all && (last || level >= h->always)) {
    if (c[0].inside) sphi_add_triangle(h->sum, c[0].p, c[1].p, c[2].p);
    return;
  }
  if (last) {
    cut_triangle(h, c);
    return;
  }
  const corner m[3] = {between(h, &c[1], &c[2]), between(h, &c[2], &c[0]),
                       between(h, &c[0], &c[1])};
  const corner part[4][3] = {
      {c[0], m[2], m[1]}, {c[1], m[0], m[2]}, {c[2], m[1], m[0]}, {m[0], m[1], m[2]}};
  for (int k = 0; k < 4; ++k) triangle(h, part[k], level + 1);
}

static double length(const double *a, const double *b) { return hypot(b[0] - a[0], b[1] - a[1]); }

/* A fan of triangles from the particle, which lies in its cell. */
void sphi_polygon_inside(const sphi_measure *how, const double *x, const sphi_polygon *polygon,
                         sphi_moments *moments) {
  const double zero[2] = {0.0, 0.0};
  halving h = {how->region, x, moments, 0, 0};
  for (int64_t k = 0; k < polygon->n; ++k) {
    const double *p = polygon->p[k], *q = polygon->p[k + 1 < polygon->n ? k + 1 : 0];
    const corner fan[3] = {look(&h, 0.0, 0.0, 0.0), look(&h, p[0], p[1], 0.0),
                           look(&h, q[0], q[1], 0.0)};
    set_levels(&h, how, fmax(length(p, q), fmax(length(zero, p), length(zero, q))));
    triangle(&h, fan, 0);
  }
}

/* ---- tetrahedra -------------------------------------------------------------------------- */

/* Part of a tetrahedron of which the corners 0 .. n - 1 are inside and the others are not, cut
 * straight: at the one corner, without the other corner, or a wedge. */
static void cut_tetrahedron(const halving *h, const corner *c, int n) {
  if (n == 2) { /* ends a: 0, on 02, on 03; b: 1, on 12, on 13 */
    const corner a1 = crossing(h, &c[0], &c[2]), a2 = crossing(h, &c[0], &c[3]);
    const corner b1 = crossing(h, &c[1], &c[2]), b2 = crossing(h, &c[1], &c[3]);
    add_tetrahedron(h->sum, c[0].p, a1.p, a2.p, b2.p);
    add_tetrahedron(h->sum, c[0].p, a1.p, b1.p, b2.p);
    add_tetrahedron(h->sum, c[0].p, c[1].p, b1.p, b2.p);
    return;
  }
  const corner *odd = n == 1 ? &c[0] : &c[3], *rest = n == 1 ? c + 1 : c;
  const corner e0 = crossing(h, odd, &rest[0]), e1 = crossing(h, odd, &rest[1]);
  const corner e2 = crossing(h, odd, &rest[2]);
  if (n == 1) {
    add_tetrahedron(h->sum, odd->p, e0.p, e1.p, e2.p);
    return;
  }
  add_tetrahedron(h->sum, rest[0].p, rest[1].p, rest[2].p, e2.p); /* a wedge again */
  add_tetrahedron(h->sum, rest[0].p, rest[1].p, e1.p, e2.p);
  add_tetrahedron(h->sum, rest[0].p, e0.p, e1.p, e2.p);
}

static void tetrahedron(const halving *h, const corner *c, int level);

/* Four at the corners, and the octahedron between the middles in four about its diagonal 02-13. */
static void split_tetrahedron(const halving *h, const corner *c, int level) {
  const corner m01 = between(h, &c[0], &c[1]), m02 = between(h, &c[0], &c[2]);
  const corner m03 = between(h, &c[0], &c[3]), m12 = between(h, &c[1], &c[2]);
  const corner m13 = between(h, &c[1], &c[3]), m23 = between(h, &c[2], &c[3]);
  const corner part[8][4] = {{c[0], m01, m02, m03}, {m01, c[1], m12, m13}, {m02, m12, c[2], m23},
                             {m03, m13, m23, c[3]}, {m02, m13, m01, m12},  {m02, m13, m12, m23},
                             {m02, m13, m23, m03},  {m02, m13, m03, m01}};
  for (int k = 0; k < 8; ++k) tetrahedron(h, part[k], level + 1);
}

static void tetrahedron(const halving *h, const corner *c, int level) {
  const int last = level >= h->last;
  corner sorted[4];
  int n = 0, out = 4;
  for (int k = 0; k < 4; ++k) sorted[c[k].inside ? n++ : --out] = c[k];
  if ((n == 0 || n == 4) && (last || level >= h->always)) {
    if (n == 4) add_tetrahedron(h->sum, c[0].p, c[1].p, c[2].p, c[3].p);
  } else if (last) {
    cut_tetrahedron(h, sorted, n);
  } else {
    split_tetrahedron(h, c, level);
  }
}

static double length3(const double *a, const double *b) { return hypot(length(a, b), b[2] - a[2]); }

void sphi_tetrahedron_inside(const sphi_measure *how, const double *x, const double *a,
                             const double *b, const double *c, sphi_moments *moments) {
  const double zero[3] = {0.0, 0.0, 0.0};
  halving h = {how->region, x, moments, 0, 0};
  const corner corners[4] = {look(&h, 0.0, 0.0, 0.0), look(&h, a[0], a[1], a[2]),
                             look(&h, b[0], b[1], b[2]), look(&h, c[0], c[1], c[2])};
  double size = fmax(length3(zero, a), fmax(length3(zero, b), length3(zero, c)));
  size = fmax(size, fmax(length3(a, b), fmax(length3(b, c), length3(c, a))));
  set_levels(&h, how, size);
  tetrahedron(&h, corners, 0);
}
