/* A finite-volume solver to compare with: the Euler equations of an ideal gas in one quarter of a
 * square, [0, L]^2, planes of symmetry at x = 0 and y = 0, outflow at L.
 *
 * MUSCL-Hancock with limited slopes (monotonised central), HLLC fluxes, x and y by turns (xy, yx),
 * second order where the flow is smooth: E. Toro, Riemann Solvers and Numerical Methods for Fluid
 * Dynamics, 3rd ed. 2009, 10.4, 14.4, 16.2. Nothing in it is needed to use the library. */
#ifndef EXAMPLES_EULER_PLANE_H
#define EXAMPLES_EULER_PLANE_H

#include <math.h>
#include <stdlib.h>

/* Density, velocity along the sweep and across, pressure; or their conserved counterparts. */
typedef struct euler_cell {
  double q[4];
} euler_cell;

typedef struct euler {
  int n; /* cells on a side */
  double dx, gamma, t;
  euler_cell *cell; /* primitive: rho, u, v, p; x runs fastest */
  euler_cell *line; /* n + 4, a row with two cells beyond each end */
  euler_cell *lo, *hi, *flux;
} euler;

static inline void euler_create(euler *g, int n, double length, double gamma) {
  const size_t cells = (size_t)n * (size_t)n, row = (size_t)n + 4;
  *g = (euler){.n = n, .dx = length / n, .gamma = gamma};
  g->cell = malloc(cells * sizeof *g->cell);
  g->line = malloc(4 * row * sizeof *g->line);
  if (!g->cell || !g->line) exit(2);
  g->lo = g->line + row;
  g->hi = g->lo + row;
  g->flux = g->hi + row;
}

static inline void euler_destroy(euler *g) {
  free(g->cell);
  free(g->line);
}

static inline euler_cell euler_conserved(const euler *g, euler_cell w) {
  const double *q = w.q;
  return (euler_cell){{q[0], q[0] * q[1], q[0] * q[2],
                       q[3] / (g->gamma - 1.0) + 0.5 * q[0] * (q[1] * q[1] + q[2] * q[2])}};
}

static inline euler_cell euler_primitive(const euler *g, euler_cell c) {
  const double u = c.q[1] / c.q[0], v = c.q[2] / c.q[0];
  return (euler_cell){
      {c.q[0], u, v, (g->gamma - 1.0) * (c.q[3] - 0.5 * (c.q[1] * u + c.q[2] * v))}};
}

static inline euler_cell euler_flux(const euler *g, euler_cell w) {
  const euler_cell c = euler_conserved(g, w);
  const double u = w.q[1], p = w.q[3];
  return (euler_cell){{c.q[1], c.q[1] * u + p, c.q[2] * u, (c.q[3] + p) * u}};
}

/* HLLC with the speeds of Davis, Toro (10.48), (10.37) to (10.39). */
static inline euler_cell euler_hllc(const euler *g, euler_cell l, euler_cell r) {
  const double cl = sqrt(g->gamma * l.q[3] / l.q[0]), cr = sqrt(g->gamma * r.q[3] / r.q[0]);
  const double sl = fmin(l.q[1] - cl, r.q[1] - cr), sr = fmax(l.q[1] + cl, r.q[1] + cr);
  const double ml = l.q[0] * (sl - l.q[1]), mr = r.q[0] * (sr - r.q[1]);
  const double middle = (r.q[3] - l.q[3] + ml * l.q[1] - mr * r.q[1]) / (ml - mr);
  const int left = middle >= 0.0;
  const euler_cell w = left ? l : r;
  const double s = left ? sl : sr, mass = left ? ml : mr;
  euler_cell f = euler_flux(g, w);
  if (left ? sl >= 0.0 : sr <= 0.0) return f;
  const euler_cell c = euler_conserved(g, w);
  const double rho = mass / (s - middle);
  const double energy = c.q[3] / w.q[0] + (middle - w.q[1]) * (middle + w.q[3] / mass);
  const double star[4] = {rho, rho * middle, rho * w.q[2], rho * energy};
  for (int k = 0; k < 4; ++k) f.q[k] += s * (star[k] - c.q[k]);
  return f;
}

/* Monotonised central. */
static inline double euler_slope(double a, double b) {
  if (a * b <= 0.0) return 0.0;
  return copysign(fmin(0.5 * fabs(a + b), 2.0 * fmin(fabs(a), fabs(b))), a);
}

/* Values at both faces of a cell of the line, half a step on. */
static inline void euler_faces(const euler *g, int i, double dt) {
  euler_cell lo = g->line[i], hi = g->line[i];
  for (int k = 0; k < 4; ++k) {
    const double s =
        euler_slope(g->line[i].q[k] - g->line[i - 1].q[k], g->line[i + 1].q[k] - g->line[i].q[k]);
    lo.q[k] -= 0.5 * s;
    hi.q[k] += 0.5 * s;
  }
  const euler_cell fl = euler_flux(g, lo), fh = euler_flux(g, hi);
  lo = euler_conserved(g, lo);
  hi = euler_conserved(g, hi);
  for (int k = 0; k < 4; ++k) {
    const double change = 0.5 * dt / g->dx * (fl.q[k] - fh.q[k]);
    lo.q[k] += change;
    hi.q[k] += change;
  }
  g->lo[i] = euler_primitive(g, lo);
  g->hi[i] = euler_primitive(g, hi);
}

/* One step of the line, whose cells are 2 to n + 1. */
static inline void euler_line(const euler *g, double dt) {
  euler_cell *w = g->line;
  const int n = g->n;
  for (int k = 0; k < 2; ++k) {
    w[1 - k] = w[2 + k]; /* mirrored */
    w[1 - k].q[1] = -w[1 - k].q[1];
    w[n + 2 + k] = w[n + 1];
  }
  for (int i = 1; i < n + 3; ++i) euler_faces(g, i, dt);
  for (int i = 1; i < n + 2; ++i) g->flux[i] = euler_hllc(g, g->hi[i], g->lo[i + 1]);
  for (int i = 2; i < n + 2; ++i) {
    euler_cell c = euler_conserved(g, w[i]);
    for (int k = 0; k < 4; ++k) c.q[k] += dt / g->dx * (g->flux[i - 1].q[k] - g->flux[i].q[k]);
    w[i] = euler_primitive(g, c);
  }
}

static inline euler_cell euler_turn(euler_cell w) {
  return (euler_cell){{w.q[0], w.q[2], w.q[1], w.q[3]}};
}

static inline void euler_sweep(euler *g, int axis, double dt) {
  const size_t n = (size_t)g->n, along = axis == 0 ? 1 : n, across = axis == 0 ? n : 1;
  for (size_t j = 0; j < n; ++j) {
    euler_cell *row = g->cell + j * across;
    for (size_t i = 0; i < n; ++i)
      g->line[i + 2] = axis == 0 ? row[i * along] : euler_turn(row[i * along]);
    euler_line(g, dt);
    for (size_t i = 0; i < n; ++i)
      row[i * along] = axis == 0 ? g->line[i + 2] : euler_turn(g->line[i + 2]);
  }
}

static inline double euler_fastest(const euler *g) {
  double most = 0.0;
  for (int k = 0; k < g->n * g->n; ++k) {
    const double *q = g->cell[k].q;
    most = fmax(most, fmax(fabs(q[1]), fabs(q[2])) + sqrt(g->gamma * q[3] / q[0]));
  }
  return most;
}

/* Up to time t, by a Courant number of 0.45. */
static inline void euler_run(euler *g, double t) {
  for (int turn = 0; g->t < t; turn = !turn) {
    const double dt = fmin(0.45 * g->dx / euler_fastest(g), t - g->t);
    euler_sweep(g, turn, dt);
    euler_sweep(g, !turn, dt);
    g->t += dt;
  }
}

#endif
