/* Whether a list still holds for positions that a host hands to an operator. */
#include "layout.h"

#include <math.h>
#include <string.h>

enum { GRAIN = 8192 };

typedef struct fresh_job {
  const sphi_layout *layout;
  const double *x, *h;
  double h0;
  int64_t stale; /* lowest host index that moved too far */
} fresh_job;

static int same_h(const fresh_job *j, int64_t k) {
  const sphi_layout *l = j->layout;
  double h = j->h ? j->h[l->order[k]] : j->h0;
  return l->s ? sphi_rule_s(&l->rule, h) == l->s[k] : h == l->h_uniform;
}

/* Two particles may approach each other, so each has half the skin. Written so that NaN is stale.
 */
static void fresh_range(void *job, int64_t lo, int64_t hi, int32_t worker) {
  fresh_job *j = job;
  const sphi_layout *l = j->layout;
  double limit = 0.25 * l->rule.skin * l->rule.skin;
  (void)worker;
  for (int64_t k = lo; k < hi; ++k) {
    double moved = 0.0;
    for (int a = 0; a < l->dim; ++a) {
      double d = j->x[(int64_t)l->order[k] * l->dim + a] - l->x[a][k];
      moved += d * d;
    }
    if (!(moved <= limit) || !same_h(j, k)) sphi_lowest(&j->stale, l->order[k]);
  }
}

sph_status sphi_neighbors_fresh(const sph_neighbors *list, const double *x, const double *h,
                                double h0) {
  fresh_job job = {&list->priv->layout[0], x, h, h0, INT64_MAX};
  sphi_parallel(list->base.ctx, list->n, GRAIN, fresh_range, &job);
  if (job.stale == INT64_MAX) return SPH_OK;
  return sphi_fail(list->base.ctx, SPH_ERR_STALE,
                   "particle %lld moved further since the list was built than half its skin of %g, "
                   "or its h changed",
                   (long long)job.stale, list->priv->layout[0].rule.skin);
}
