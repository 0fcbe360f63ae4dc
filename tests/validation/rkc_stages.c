/* Stage counts of Runge-Kutta-Chebyshev against every published one.
 *
 * Equation    s = 1 + floor(sqrt(1 + CFL / 0.131)), CFL = c dt / dp (He 2015, 4.18).
 * Parameters  bar of magnesium: L = 1 m, c = sqrt(E / rho), E = 45e9 Pa, rho = 1738 kg/m^3; N
 *             particles at distance dp = L / N.
 * Reference   He 2015: table 5.1 (stages 3, 3, 4, 5 at CFL 0.6, 1.0, 1.2, 2.5) and the curves of
 * fig. 6.5, for which no numbers are printed: what 4.18 gives. He & Seaid 2016, table 1: dt is
 *             printed a hundred times too large; 0.118, 0.236, 0.472 microseconds agree with its
 *             stage counts but for one: N = 750, 0.118 us, printed 2, by the formula (CFL 0.450) 3.
 * Expected    equal. */
#include "result.h"

#include <sph/integrator.h>

static double wave_speed(void) { return sqrt(45e9 / 1738.0); }

typedef struct point {
  double dt; /* microseconds */
  double dp; /* mm */
  int stages;
} point;

/* ---- fig. 6.5 ---------------------------------------------------------------------------- */

static const point curves[] = {
    {.157, 10, 2}, {.157, 4, 2}, {.157, 2, 3},  {.157, 1, 3}, {.236, 10, 2}, {.236, 4, 2},
    {.236, 2, 3},  {.236, 1, 4}, {.393, 10, 2}, {.393, 4, 3}, {.393, 2, 3},  {.393, 1, 5},
    {1.0, 10, 3},  {1.0, 4, 4},  {1.0, 2, 5},   {2.0, 10, 3}, {2.0, 4, 5},   {2.0, 2, 7}};

static int check_curves(void) {
  int failures = 0;
  for (size_t k = 0; k < sizeof curves / sizeof curves[0]; ++k) {
    const point *p = &curves[k];
    char keys[128];
    int32_t s = sph_rkc_stages_cfl(p->dt * 1e-6, wave_speed(), p->dp * 1e-3);
    snprintf(keys, sizeof keys, "case=rkc_stages quantity=stages dt=%gus dp=%gmm", p->dt, p->dp);
    failures += result_line(keys, (double)s, p->stages, "He 2015 fig. 6.5, eq. 4.18", 0.0, 0);
  }
  return failures;
}

/* ---- table 5.1 --------------------------------------------------------------------------- */

static int check_cfl_table(void) {
  static const double cfl[] = {0.6, 1.0, 1.2, 2.5};
  static const int stages[] = {3, 3, 4, 5};
  int failures = 0;
  for (int k = 0; k < 4; ++k) {
    char keys[128];
    double dp = 1.0 / 250.0, dt = cfl[k] * dp / wave_speed();
    snprintf(keys, sizeof keys, "case=rkc_stages quantity=stages n=250 cfl=%g", cfl[k]);
    failures += result_line(keys, sph_rkc_stages_cfl(dt, wave_speed(), dp), stages[k],
                            "He 2015 table 5.1", 0.0, 0);
  }
  return failures;
}

/* ---- He & Seaid, table 1 ----------------------------------------------------------------- */

static const struct {
  int n, stages[3];
} table1[] = {{250, {2, 2, 3}}, {500, {2, 3, 4}}, {750, {2, 3, 4}}, {1000, {3, 4, 5}}};

/* The one misprint stands beside, and the formula decides. */
static int check_entry(int n, double dt, int printed) {
  char keys[128];
  int32_t s = sph_rkc_stages_cfl(dt * 1e-6, wave_speed(), 1.0 / n);
  snprintf(keys, sizeof keys, "case=rkc_stages quantity=stages n=%d dt=%gus", n, dt);
  if (n != 750 || dt != 0.118)
    return result_line(keys, s, printed, "He & Seaid 2016 table 1", 0.0, 0);
  result_report(keys, s, printed, "He & Seaid 2016 table 1", "misprint: CFL 0.450 is above 0.393");
  snprintf(keys, sizeof keys, "case=rkc_stages quantity=stages_by_formula n=%d dt=%gus", n, dt);
  return result_line(keys, s, 3, "He 2015 eq. 4.18", 0.0, 0);
}

static int check_paper_table(void) {
  static const double dt[] = {0.118, 0.236, 0.472};
  int failures = 0;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 3; ++column)
      failures += check_entry(table1[row].n, dt[column], table1[row].stages[column]);
  return failures;
}

/* ---- upper ends -------------------------------------------------------------------------- */

/* s = k for CFL in [0.131 ((k-1)^2 - 1), 0.131 (k^2 - 1)): one step below the end, one above. */
static int check_interval_ends(void) {
  static const double end[] = {.393, 1.048, 1.965, 3.144, 4.585, 6.288, 8.253, 10.48, 12.969};
  int failures = 0;
  for (int k = 0; k < 9; ++k)
    for (int above = 0; above < 2; ++above) {
      char keys[128];
      double cfl = end[k] * (above ? 1.0 + 1e-9 : 1.0 - 1e-9);
      snprintf(keys, sizeof keys, "case=rkc_stages quantity=stages cfl=%.10g", cfl);
      failures += result_line(keys, sph_rkc_stages_cfl(cfl, 1.0, 1.0), 2 + k + above,
                              "He 2015 eq. 4.18, interval ends", 0.0, 0);
    }
  return failures;
}

int main(void) {
  int failures = check_curves();
  failures += check_cfl_table();
  failures += check_paper_table();
  failures += check_interval_ends();
  return failures != 0;
}
