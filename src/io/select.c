/* Which particles and fields go into a file. */
#include "io_impl.h"

#include <math.h>
#include <string.h>

void sph_output_options_init_sized(sph_output_options *options, size_t size) {
  sph_output_options defaults;
  memset(&defaults, 0, sizeof defaults);
  defaults.size = sizeof defaults;
  defaults.ghosts = 1;
  defaults.time = NAN;
  sphi_options_init(options, size, &defaults, sizeof defaults);
}

static void add(sphi_selection *s, int32_t field) {
  for (int32_t k = 0; k < s->count; ++k)
    if (s->field[k] == field) return;
  s->field[s->count++] = field;
}

static void select_all(sphi_selection *s) {
  for (int32_t f = 0; f < SPHI_FIELD_IDS; ++f)
    if (sph_particles_field_const(s->set, f) != NULL) add(s, f);
}

static sph_status select_given(sphi_selection *s, const char *call) {
  const sph_output_options *o = &s->options;
  for (int32_t k = 0; k < o->field_count; ++k) {
    if (sph_particles_field_const(s->set, o->fields[k]) == NULL)
      return sphi_fail(sphi_particles_context(s->set), SPH_ERR_ARG,
                       "%s: fields[%d] = %d (%s) does not exist in the set", call, (int)k,
                       (int)o->fields[k], sphi_field_name(s->set, o->fields[k]));
    add(s, o->fields[k]);
  }
  return SPH_OK;
}

sph_status sphi_select(sphi_selection *s, const sph_particles *set,
                       const sph_output_options *options, const char *call) {
  sph_status status = sphi_check_handle(NULL, set, SPHI_MAGIC_PARTICLES, "set");
  if (status != SPH_OK) return status;
  sph_context *ctx = sphi_particles_context(set);
  memset(s, 0, sizeof *s);
  sph_output_options_init(&s->options);
  status = sphi_options_read(ctx, &s->options, sizeof s->options, options);
  if (status != SPH_OK) return status;
  if (s->options.field_count < 0 || (s->options.field_count > 0 && s->options.fields == NULL))
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: fields is %s, field_count = %d", call,
                     s->options.fields ? "given" : "NULL", (int)s->options.field_count);
  s->set = set;
  s->dim = sph_particles_dim(set);
  s->n = s->options.ghosts ? sph_particles_count(set) : sph_particles_real_count(set);
  add(s, SPH_FIELD_X);
  if (s->options.fields != NULL) return select_given(s, call);
  select_all(s);
  return SPH_OK;
}
