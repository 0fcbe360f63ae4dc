/* A root between brackets, T. Chandrupatla, Adv. Eng. Softw. 28 (1997) 145-149: inverse quadratic
 * interpolation where three points lie on a curve that is smooth enough for it, else halving. */
#include "reference_impl.h"

#include <float.h>
#include <math.h>

enum { STEPS = 2000 }; /* halving alone needs that many from the largest to the smallest number */

/* Where between a (0) and b (1) to look next, from a third point c. */
static double fraction(double a, double fa, double b, double fb, double c, double fc) {
  const double xi = (a - b) / (c - b), phi = (fa - fb) / (fc - fb);
  if (!(phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi)) return 0.5;
  return fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb);
}

double sphi_root(sphi_root_fn f, const void *user, double lo, double hi) {
  double a = lo, b = hi, fa = f(user, a), fb = f(user, b), t = 0.5;
  if (fa == 0.0) return a;
  if (fb == 0.0) return b;
  for (int k = 0; k < STEPS; ++k) {
    const double x = a + t * (b - a), fx = f(user, x);
    const int same = (fx > 0.0) == (fa > 0.0);
    const double c = same ? a : b, fc = same ? fa : fb;
    if (!same) {
      b = a;
      fb = fa;
    }
    a = x;
    fa = fx;
    if (fx == 0.0) return x;
    const double best = fabs(fa) < fabs(fb) ? a : b;
    const double least = (DBL_EPSILON * fabs(best) + DBL_MIN) / fabs(b - a);
    if (least > 0.5) return best;
    t = fmin(fmax(fraction(a, fa, b, fb, c, fc), least), 1.0 - least);
  }
  return a;
}
