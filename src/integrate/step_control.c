/* Step control: error norm, and the step that the error suggests. */
#include "integrate_impl.h"

#include <math.h>

/* ---- error norm -------------------------------------------------------------------------- */

/* Maximum norms, item by item: entries that pass through zero do not stop the run, and fields of
 * different units do not mix. */
double sphi_error_norm(sph_integrator *it, const double *error) {
  double largest = 0.0;
  for (int32_t k = 0; k < it->items; ++k) {
    double size =
        fmax(sphi_state_max(it, k, NULL), sphi_state_max(it, k, sphi_vector(it, SPHI_VEC_START)));
    double e = sphi_state_max(it, k, error);
    double tolerance = it->options.atol + it->options.rtol * size;
    double ratio = e == 0.0 ? 0.0 : e / tolerance; /* 0 / 0 where atol = 0 and y = 0 */
    if (!(ratio <= largest)) largest = ratio;
  }
  return largest;
}

double sphi_suggest(double dt, double error, int32_t order) {
  double factor = 0.8 * pow(error, -1.0 / (order + 1.0)); /* error 0 gives infinity */
  if (!(factor >= 0.1)) factor = 0.1;
  return dt * (factor < 5.0 ? factor : 5.0);
}
