/* A run: steps of a scheme until a given time. */
#include "moments.h"

#include <math.h>

enum { HALVINGS = 20 };

/* A step towards t_end, smaller when one is asked for. */
static sph_status advance(const sphi_march *m, double t_end, sph_step_info *info) {
  double dt, left = t_end - *m->time;
  sph_status s = m->stable_dt(m->scheme, &dt);
  if (s) return s;
  if (left < 2.0 * dt) dt = left > dt ? 0.5 * left : left;
  s = m->step(m->scheme, dt, info);
  for (int tries = 0; s && tries < HALVINGS && m->halve(m->scheme, s); ++tries)
    s = m->step(m->scheme, dt *= 0.5, info);
  if (!s && dt == left) *m->time = t_end;
  return s;
}

sph_status sphi_march_to(const sphi_march *m, double t_end) {
  const double begin = *m->time;
  sph_step_info info;
  sph_status s = SPH_OK;
  if (!isfinite(t_end) || t_end < begin)
    return sphi_fail(m->ctx, SPH_ERR_ARG, "%s: run from %g to %g", m->name, begin, t_end);
  sph_step_info_init(&info);
  while (!s && *m->time < t_end) {
    s = advance(m, t_end, &info);
    const int32_t answer = s ? 0 : m->after(m->scheme, &info);
    if (answer > 0) return SPH_OK;
    if (answer < 0)
      return sphi_fail(m->ctx, SPH_ERR_CALLBACK, "the host answered %d at t = %g", (int)answer,
                       *m->time);
    if (!s) s = sphi_progress(m->ctx, (*m->time - begin) / (t_end - begin), "running");
  }
  return s;
}
