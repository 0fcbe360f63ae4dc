/* Is the step still in the stable range of its method?
 *
 * RKC is stable along the negative real axis up to beta(s), but on the imaginary axis
 * |P_s(i y)| = 1 + k y^4 > 1 for every s. The dominant eigenvalue of the right-hand side, looked at
 * now and then, tells which one it is. */
#include "integrate_impl.h"

#include <math.h>

static const double tolerated_growth = 1.001; /* of one step, beyond that of the exact solution */
static const double believable = 0.3;         /* residual above which no judgement is passed */
enum { WATCH_ITERATIONS = 20, WATCH_SECOND = 10, STAGES_MORE = 8 };

static double amplification(const sph_integrator *it, int32_t stages, double re, double im) {
  return it->options.method == SPH_INTEGRATOR_RKC
             ? sph_rkc_amplification(stages, re, im)
             : sphi_butcher_amplification(&it->tableau, re, im);
}

static void warn_real(const sphi_step *step, int32_t stages, double radius, double growth) {
  sph_context *ctx = step->it->base.ctx;
  if (step->it->options.method == SPH_INTEGRATOR_RKC)
    sphi_log(ctx, SPH_LOG_WARNING,
             "RKC with %d stages at t = %.6g: dt * spectral radius = %.6g against a stability "
             "interval of %.6g; errors grow by %.4g a step. More stages or a smaller step",
             (int)stages, step->t, step->dt * radius, sph_rkc_beta(stages), growth);
  else
    sphi_log(ctx, SPH_LOG_WARNING,
             "at t = %.6g: dt * spectral radius = %.6g is outside the stable range; errors grow by "
             "%.4g a step. A smaller step, or RKC",
             step->t, step->dt * radius, growth);
}

static void warn_wave(const sphi_step *step, int32_t stages, const sphi_eigen *eigen,
                      double growth) {
  sph_context *ctx = step->it->base.ctx;
  if (step->it->options.method == SPH_INTEGRATOR_RKC)
    sphi_log(ctx, SPH_LOG_WARNING,
             "RKC with %d stages at t = %.6g: the dominant eigenvalue (%.6g, +-%.6g i) is a wave, "
             "which the method amplifies by %.4g a step (no stability on the imaginary axis). RK4, "
             "a smaller step (CFL <= 0.5), or more viscosity",
             (int)stages, step->t, eigen->re, eigen->im, growth);
  else
    sphi_log(ctx, SPH_LOG_WARNING,
             "at t = %.6g: the dominant eigenvalue (%.6g, +-%.6g i) is a wave, which the method "
             "amplifies by %.4g a step. A smaller step, or RK4",
             step->t, eigen->re, eigen->im, growth);
}

/* A mode that grows in truth (re > 0) may grow in the step. */
static int32_t grows_too_much(const sphi_step *step, const sphi_eigen *eigen, double growth) {
  double exact = eigen->re * step->dt > 0.0 ? exp(eigen->re * step->dt) : 1.0;
  return eigen->residual <= believable && growth > tolerated_growth * exact;
}

void sphi_stability_judge(sphi_step *step, int32_t stages) {
  sph_integrator *it = step->it;
  const sphi_eigen *eigen = &it->memory.eigen;
  double growth = amplification(it, stages, step->dt * eigen->re, step->dt * eigen->im);
  it->memory.growth = growth;
  if (it->warned || !grows_too_much(step, eigen, growth)) return;
  it->warned = 1;
  if (eigen->im > fabs(eigen->re))
    warn_wave(step, stages, eigen, growth);
  else
    warn_real(step, stages, sphi_eigen_radius(eigen), growth);
}

/* The radius counts real modes. A damped wave, off the axis, may need a few stages more; a pure one
 * is beyond help. */
int32_t sphi_stability_stages(const sphi_step *step, int32_t stages) {
  const sph_integrator *it = step->it;
  const sphi_eigen *eigen = &it->memory.eigen;
  double re = step->dt * eigen->re, im = step->dt * eigen->im;
  if (re >= 0.0 || im == 0.0 || eigen->residual > believable) return stages;
  for (int32_t s = stages; s <= stages + STAGES_MORE && s <= it->options.max_stages; ++s)
    if (sph_rkc_amplification(s, re, im) <= 1.0) return s;
  return stages;
}

/* In the first step, a little later, as a run often starts at rest, and then at the interval. */
static int32_t watch_is_due(const sph_integrator *it) {
  const sphi_memory *m = &it->memory;
  int64_t interval = it->options.stability_check_interval;
  if (interval <= 0) return 0;
  if (m->estimated_at < 0) return 1;
  if (m->estimated_at == 0 && interval > WATCH_SECOND) interval = WATCH_SECOND;
  return m->steps - m->estimated_at >= interval;
}

sph_status sphi_stability_watch(sphi_step *step, const double *f0, int32_t stages) {
  sph_integrator *it = step->it;
  int32_t most = it->options.power_iterations;
  sphi_eigen eigen;
  if (!watch_is_due(it)) return SPH_OK;
  sph_status status =
      sphi_power_estimate(step, f0, most < WATCH_ITERATIONS ? most : WATCH_ITERATIONS, &eigen);
  if (status != SPH_OK) return status;
  sphi_restore_start(step);
  it->memory.estimated_at = it->memory.steps;
  it->memory.eigen = eigen;
  it->memory.growth = NAN;
  if (isfinite(sphi_eigen_radius(&eigen))) sphi_stability_judge(step, stages);
  return SPH_OK;
}
