/* The integrator handle: options, creation, binding. */
#include "integrate_impl.h"

#include <math.h>
#include <string.h>

/* ---- options ----------------------------------------------------------------------------- */

static sph_integrator_options default_options(void) {
  sph_integrator_options o;
  memset(&o, 0, sizeof o);
  o.size = sizeof o;
  o.method = SPH_INTEGRATOR_RK4;
  o.rkc_b1 = SPH_RKC_B1_INVERSE_W0;
  o.stage_rule = SPH_STAGES_POWER;
  o.stages = 2;
  o.max_stages = 100;
  o.power_safety = 1.1;
  o.power_iterations = 50;
  o.power_interval = 25;
  o.rtol = 1e-3;
  o.atol = 1e-6;
  o.check_finite = 1;
  o.stability_check_interval = -1;
  return o;
}

void sph_integrator_options_init_sized(sph_integrator_options *options, size_t size) {
  sph_integrator_options defaults = default_options();
  sphi_options_init(options, size, &defaults, sizeof defaults);
}

static sph_step_info default_info(void) {
  sph_step_info info;
  memset(&info, 0, sizeof info);
  info.size = sizeof info;
  info.error = NAN;
  info.radius = NAN;
  info.suggested_dt = NAN;
  info.eigen_re = NAN;
  info.eigen_im = NAN;
  info.growth = NAN;
  return info;
}

void sph_step_info_init_sized(sph_step_info *info, size_t size) {
  sph_step_info defaults = default_info();
  sphi_options_init(info, size, &defaults, sizeof defaults);
}

/* ---- checks ------------------------------------------------------------------------------ */

static int32_t positive(double x) { return isfinite(x) && x > 0.0; }
static int32_t not_negative(double x) { return isfinite(x) && x >= 0.0; }

static sph_status check_common(sph_context *ctx, const sph_integrator_options *o) {
  if (o->method < SPH_INTEGRATOR_EULER || o->method > SPH_INTEGRATOR_LEAPFROG_PREDICTED)
    return sphi_fail(ctx, SPH_ERR_ARG, "method %d is unknown", (int)o->method);
  if (!not_negative(o->rtol) || !not_negative(o->atol) || o->rtol + o->atol == 0.0)
    return sphi_fail(ctx, SPH_ERR_ARG,
                     "rtol = %g and atol = %g must be finite, >= 0 and not both 0", o->rtol,
                     o->atol);
  if (o->power_iterations < 1 || o->power_iterations > 1000)
    return sphi_fail(ctx, SPH_ERR_ARG, "power_iterations = %d is outside 1..1000",
                     (int)o->power_iterations);
  if (o->stability_check_interval < -1)
    return sphi_fail(ctx, SPH_ERR_ARG, "stability_check_interval = %d is below -1",
                     (int)o->stability_check_interval);
  return SPH_OK;
}

static sph_status check_rkc(sph_context *ctx, const sph_integrator_options *o) {
  if (o->rkc_b1 != SPH_RKC_B1_INVERSE_W0 && o->rkc_b1 != SPH_RKC_B1_EQUAL_B2)
    return sphi_fail(ctx, SPH_ERR_ARG, "rkc_b1 = %d is unknown", (int)o->rkc_b1);
  if (o->max_stages < 2 || o->max_stages > 1000)
    return sphi_fail(ctx, SPH_ERR_ARG, "max_stages = %d is outside 2..1000", (int)o->max_stages);
  switch (o->stage_rule) {
  case SPH_STAGES_FIXED:
    if (o->stages >= 2 && o->stages <= o->max_stages) return SPH_OK;
    return sphi_fail(ctx, SPH_ERR_ARG, "stages = %d is outside 2..max_stages = %d", (int)o->stages,
                     (int)o->max_stages);
  case SPH_STAGES_CFL:
    if (not_negative(o->wave_speed) && positive(o->spacing)) return SPH_OK;
    return sphi_fail(ctx, SPH_ERR_ARG, "wave_speed = %g must be >= 0 and spacing = %g > 0",
                     o->wave_speed, o->spacing);
  case SPH_STAGES_RADIUS:
    if (o->radius) return SPH_OK;
    return sphi_fail(ctx, SPH_ERR_ARG, "the stage rule RADIUS needs the callback `radius`");
  case SPH_STAGES_POWER:
    if (isfinite(o->power_safety) && o->power_safety >= 1.0 && o->power_interval >= 1)
      return SPH_OK;
    return sphi_fail(ctx, SPH_ERR_ARG,
                     "power_safety = %g must be >= 1 and power_interval = %d >= 1", o->power_safety,
                     (int)o->power_interval);
  default:
    return sphi_fail(ctx, SPH_ERR_ARG, "stage_rule = %d is unknown", (int)o->stage_rule);
  }
}

static sph_status check_weights(sph_context *ctx, const double *b, int32_t s, const char *name) {
  double sum = 0.0;
  for (int32_t i = 0; i < s; ++i) sum += b[i];
  if (isfinite(sum) && fabs(sum - 1.0) <= 1e-12) return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_ARG, "%s sums to %.17g, not to 1", name, sum);
}

static sph_status check_explicit(sph_context *ctx, const double *a, int32_t s) {
  for (int32_t i = 0; i < s; ++i)
    for (int32_t j = 0; j < s; ++j) {
      double v = a[i * s + j];
      if (isfinite(v) && (j < i || v == 0.0)) continue;
      return sphi_fail(ctx, SPH_ERR_ARG,
                       "butcher_a[%d][%d] = %g: an explicit tableau is finite and strictly lower "
                       "triangular",
                       (int)i, (int)j, v);
    }
  return SPH_OK;
}

static sph_status check_tableau(sph_context *ctx, const sph_integrator_options *o) {
  int32_t s = o->butcher_stages;
  if (s < 1 || s > SPHI_STAGES_MAX)
    return sphi_fail(ctx, SPH_ERR_ARG, "butcher_stages = %d is outside 1..%d", (int)s,
                     (int)SPHI_STAGES_MAX);
  if (!o->butcher_a || !o->butcher_b)
    return sphi_fail(ctx, SPH_ERR_ARG, "butcher_a or butcher_b is NULL");
  sph_status status = check_explicit(ctx, o->butcher_a, s);
  if (status == SPH_OK) status = check_weights(ctx, o->butcher_b, s, "butcher_b");
  if (status == SPH_OK && o->butcher_b_low)
    status = check_weights(ctx, o->butcher_b_low, s, "butcher_b_low");
  return status;
}

static sph_status check_options(sph_context *ctx, const sph_integrator_options *o) {
  sph_status status = check_common(ctx, o);
  if (status != SPH_OK) return status;
  if (o->method == SPH_INTEGRATOR_RKC) return check_rkc(ctx, o);
  if (o->method == SPH_INTEGRATOR_BUTCHER) return check_tableau(ctx, o);
  return SPH_OK;
}

/* ---- creation ---------------------------------------------------------------------------- */

/* One block: a, b, c = row sums of a (T 4.16), b_low. */
static sph_status own_tableau(sph_integrator *it) {
  const sph_integrator_options *o = &it->options;
  size_t s = (size_t)o->butcher_stages;
  size_t bytes = (s * s + 3 * s) * sizeof(double);
  double *a = sphi_calloc(it->base.ctx, bytes);
  if (!a) return SPH_ERR_NOMEM;
  double *b = a + s * s, *c = b + s, *low = c + s;
  memcpy(a, o->butcher_a, s * s * sizeof *a);
  memcpy(b, o->butcher_b, s * sizeof *b);
  if (o->butcher_b_low) memcpy(low, o->butcher_b_low, s * sizeof *low);
  for (size_t i = 0; i < s; ++i)
    for (size_t j = 0; j < i; ++j) c[i] += a[i * s + j];
  it->tableau_values = a;
  it->tableau_bytes = bytes;
  it->tableau = (sphi_tableau){(int32_t)s, a, b, c, o->butcher_b_low ? low : NULL, 0};
  return SPH_OK;
}

static void rank_tableau(sphi_tableau *tableau) {
  int32_t order = sphi_butcher_order(tableau, tableau->b);
  int32_t low = tableau->b_low ? sphi_butcher_order(tableau, tableau->b_low) : order;
  tableau->low_order = low < order ? low : order;
}

static sph_status prepare_tableau(sph_integrator *it) {
  if (it->options.method == SPH_INTEGRATOR_BUTCHER) {
    sph_status status = own_tableau(it);
    if (status != SPH_OK) return status;
  } else if (!sphi_butcher_builtin(it->options.method, &it->tableau)) {
    return SPH_OK;
  }
  rank_tableau(&it->tableau);
  return SPH_OK;
}

static sph_status prepare_rkc(sph_integrator *it) {
  if (it->options.method != SPH_INTEGRATOR_RKC) return SPH_OK;
  it->rkc_bytes = 5 * ((size_t)it->options.max_stages + 1) * sizeof(double);
  it->rkc_values = sphi_calloc(it->base.ctx, it->rkc_bytes);
  return it->rkc_values ? SPH_OK : SPH_ERR_NOMEM;
}

/* -1 stands for: RKC every 100 steps, whose name promises a stability it does not have on the
 * imaginary axis; the others never, whose limits are common knowledge. */
static void settle_interval(sph_integrator_options *o) {
  if (o->method == SPH_INTEGRATOR_LEAPFROG || o->method == SPH_INTEGRATOR_LEAPFROG_PREDICTED)
    o->stability_check_interval = 0;
  if (o->stability_check_interval < 0)
    o->stability_check_interval = o->method == SPH_INTEGRATOR_RKC ? 100 : 0;
}

static sph_status fill_handle(sph_integrator *it) {
  it->memory.estimated_at = -1;
  it->memory.growth = NAN;
  it->memory.eigen = (sphi_eigen){NAN, NAN, NAN};
  sphi_history_forget(it);
  sph_status status = prepare_tableau(it);
  if (status == SPH_OK) status = prepare_rkc(it);
  settle_interval(&it->options);
  it->options.butcher_a = NULL; /* the host's, not ours beyond this call */
  it->options.butcher_b = NULL;
  it->options.butcher_b_low = NULL;
  return status;
}

sph_status sph_integrator_create(sph_context *ctx, const sph_integrator_options *options,
                                 sph_integrator **out) {
  if (!out) return SPH_ERR_ARG;
  *out = NULL;
  sph_status status = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (status != SPH_OK) return status;
  sph_integrator_options o = default_options();
  status = sphi_options_read(ctx, &o, sizeof o, options);
  if (status == SPH_OK) status = check_options(ctx, &o);
  if (status != SPH_OK) return status;
  sph_integrator *it = sphi_calloc(ctx, sizeof *it);
  if (!it) return SPH_ERR_NOMEM;
  it->base.magic = SPHI_MAGIC_INTEGRATOR;
  it->base.ctx = ctx;
  sphi_context_retain(ctx);
  it->options = o;
  status = fill_handle(it);
  if (status == SPH_OK)
    *out = it;
  else
    sph_integrator_destroy(it);
  return status;
}

void sph_integrator_destroy(sph_integrator *it) {
  if (sphi_check_handle(NULL, it, SPHI_MAGIC_INTEGRATOR, "integrator") != SPH_OK) return;
  sph_context *ctx = it->base.ctx;
  sphi_free(ctx, it->tableau_values, it->tableau_bytes);
  sphi_free(ctx, it->rkc_values, it->rkc_bytes);
  sphi_buffer_free(ctx, &it->vectors);
  sphi_buffer_free(ctx, &it->ids);
  sphi_buffer_free(ctx, &it->saved);
  sphi_history_free(it);
  it->base.magic = 0;
  sphi_free(ctx, it, sizeof *it);
  sphi_context_release(ctx);
}

/* ---- binding ----------------------------------------------------------------------------- */

static sph_status check_room(const sph_integrator *it) {
  if (it->busy)
    return sphi_fail(it->base.ctx, SPH_ERR_STATE, "nothing can be bound while a step is running");
  if (it->items < SPHI_ITEMS_MAX) return SPH_OK;
  return sphi_fail(it->base.ctx, SPH_ERR_LIMIT, "more than %d items bound", (int)SPHI_ITEMS_MAX);
}

static void append(sph_integrator *it, int32_t field, double *y, int64_t n) {
  sphi_item *item = &it->item[it->items];
  *item = (sphi_item){field, y, n, 0, -1, 0.0};
  it->items += 1;
  it->has_saved = 0;
  it->memory.has_vector = 0;
  sphi_history_forget(it);
}

sph_status sph_integrator_bind_field(sph_integrator *it, int32_t field) {
  sph_status status = sphi_check_handle(NULL, it, SPHI_MAGIC_INTEGRATOR, "integrator");
  if (status != SPH_OK) return status;
  sph_context *ctx = it->base.ctx;
  if (field < 0) return sphi_fail(ctx, SPH_ERR_ARG, "field %d is negative", (int)field);
  for (int32_t k = 0; k < it->items; ++k)
    if (it->item[k].field == field)
      return sphi_fail(ctx, SPH_ERR_ARG, "field %d is bound already", (int)field);
  status = check_room(it);
  if (status != SPH_OK) return status;
  append(it, field, NULL, 0);
  it->fields += 1;
  return SPH_OK;
}

/* Addresses as numbers: pointers into different arrays must not be compared. */
static int32_t overlaps(const sphi_item *item, const double *values, int64_t n) {
  uintptr_t a = (uintptr_t)item->y, b = (uintptr_t)values;
  if (item->field >= 0) return 0;
  return a == b ||
         (a < b + (uintptr_t)n * sizeof(double) && b < a + (uintptr_t)item->n * sizeof(double));
}

sph_status sph_integrator_bind_array(sph_integrator *it, double *values, int64_t n) {
  sph_status status = sphi_check_handle(NULL, it, SPHI_MAGIC_INTEGRATOR, "integrator");
  if (status != SPH_OK) return status;
  sph_context *ctx = it->base.ctx;
  if (!values || n < 0 || n > INT64_MAX / 64)
    return sphi_fail(ctx, SPH_ERR_ARG, "array is %s, n = %lld", values ? "given" : "NULL",
                     (long long)n);
  if (it->options.method == SPH_INTEGRATOR_LEAPFROG)
    return sphi_fail(ctx, SPH_ERR_UNSUPPORTED, "leapfrog advances fields of a set, not arrays");
  for (int32_t k = 0; k < it->items; ++k)
    if (overlaps(&it->item[k], values, n))
      return sphi_fail(ctx, SPH_ERR_ARG, "the array overlaps item %d, bound already", (int)k);
  status = check_room(it);
  if (status == SPH_OK) append(it, -1 - it->items, values, n);
  return status;
}

sph_status sph_integrator_set_function(sph_integrator *it, sph_rhs_fn fn, void *user) {
  sph_status status = sphi_check_handle(NULL, it, SPHI_MAGIC_INTEGRATOR, "integrator");
  if (status != SPH_OK) return status;
  if (!fn) return sphi_fail(it->base.ctx, SPH_ERR_ARG, "the right-hand side is NULL");
  it->fn = fn;
  it->user = user;
  it->rhs = NULL;
  it->list = NULL;
  return SPH_OK;
}

sph_status sph_integrator_set_rhs(sph_integrator *it, sph_rhs *rhs, sph_neighbors *list) {
  sph_status status = sphi_check_handle(NULL, it, SPHI_MAGIC_INTEGRATOR, "integrator");
  if (status != SPH_OK) return status;
  status = sphi_check_handle(it->base.ctx, rhs, SPHI_MAGIC_RHS, "rhs");
  if (status == SPH_OK)
    status = sphi_check_handle(it->base.ctx, list, SPHI_MAGIC_NEIGHBORS, "list");
  if (status != SPH_OK) return status;
  it->fn = NULL;
  it->user = NULL;
  it->rhs = rhs;
  it->list = list;
  return SPH_OK;
}

sph_status sph_integrator_set_filter(sph_integrator *it, sph_filter_fn fn, void *user) {
  sph_status status = sphi_check_handle(NULL, it, SPHI_MAGIC_INTEGRATOR, "integrator");
  if (status != SPH_OK) return status;
  if (it->busy)
    return sphi_fail(it->base.ctx, SPH_ERR_STATE, "a step of this integrator is running");
  it->filter = fn;
  it->filter_user = user;
  return SPH_OK;
}

sph_status sph_integrator_restart(sph_integrator *it) {
  sph_status status = sphi_check_handle(NULL, it, SPHI_MAGIC_INTEGRATOR, "integrator");
  if (status != SPH_OK) return status;
  if (it->busy)
    return sphi_fail(it->base.ctx, SPH_ERR_STATE, "a step of this integrator is running");
  it->memory.steps = 0;
  it->memory.estimated_at = -1;
  it->memory.has_vector = 0;
  sphi_history_forget(it);
  return SPH_OK;
}
