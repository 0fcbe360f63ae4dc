/* Part of noh.c: the figures of every run, and their bounds. */
#ifndef EXAMPLES_NOH_VALIDATE_H
#define EXAMPLES_NOH_VALIDATE_H

#include "radial_validate.h"

#define NOH "Noh 1987, exact"

typedef struct figures {
  double l1, behind; /* error of the density; its mean between 0.4 and 0.8 of the shock's radius */
} figures;

/* A run with its energy bounded; the rest is the caller's. */
static int validate_run(int32_t dim, int across, figures *f) {
  outcome o = run(noh(dim, across));
  f->l1 = o.l1;
  f->behind = radial_mean(&o.a, 0.4 * front, 0.8 * front);
  radial_report(&o.a, "L1_rho", f->l1, 0.0, NOH, "bounded below");
  radial_report(&o.a, "rho_behind_shock", f->behind, pow(4.0, dim), NOH, "bounded below");
  const int failed = radial_check_energy(&o.a);
  end(&o);
  return failed;
}

/* 100 particles a unit length; over [0, 1] as grids of 100 cells measure it. */
static int validate_planar(void) {
  figures coarse, f, fine;
  int failed =
      validate_run(1, 100, &coarse) + validate_run(1, 200, &f) + validate_run(1, 400, &fine);
  failed += result_bound("case=noh quantity=planar_L1_rho_100_a_unit", f.l1, -1, 0.05, NOH);
  failed += result_line("case=noh quantity=planar_rho_behind_shock", f.behind, 4.0, NOH, 0.01, 1);
  return failed + result_bound("case=noh quantity=planar_L1_rho_halved_spacing", f.l1 / fine.l1, 1,
                               1.7, "of first order it would be 2");
}

static int validate_cylindrical(void) {
  figures coarse, fine;
  int failed = validate_run(2, 50, &coarse) + validate_run(2, 100, &fine);
  failed += result_line("case=noh quantity=cylindrical_rho_behind_shock", fine.behind, 16.0, NOH,
                        0.10, 1);
  return failed + result_bound("case=noh quantity=cylindrical_L1_rho_halved_spacing",
                               coarse.l1 / fine.l1, 1, 1.7, "of first order it would be 2");
}

/* 64 times the density needs 4 spacings of the start in each behind the shock: these runs show the
 * way there, a quarter, a half. */
static int validate_spherical(int full) {
  figures coarse, fine, finest;
  int failed = validate_run(3, 20, &coarse) + validate_run(3, 28, &fine);
  failed += result_bound("case=noh quantity=spherical_rho_grows_towards_64 across=28",
                         fine.behind / coarse.behind, 1, 1.15, NOH);
  if (!full) return failed;
  failed += validate_run(3, 40, &finest);
  return failed + result_bound("case=noh quantity=spherical_rho_grows_towards_64 across=40",
                               finest.behind / fine.behind, 1, 1.15, NOH);
}

static int validate(int full) {
  return validate_planar() + validate_cylindrical() + validate_spherical(full);
}

#endif
