/* A .pvd file: the list of .vtp files with their times. It is small, so it is written anew for each
 * file, and is complete after every call. */
#include "io_impl.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

typedef struct entry {
  double time;
  size_t name; /* where it begins in `names` */
} entry;

struct sph_series {
  sphi_object base;
  char *path;
  size_t path_bytes, stem; /* without ".pvd" */
  int64_t count;
  sphi_buffer entries, names;
  size_t names_used;
};

static sph_status check_path(sph_context *ctx, const char *path) {
  size_t n = path != NULL ? strlen(path) : 0;
  if (n > 4 && strcmp(path + n - 4, ".pvd") == 0 && path[n - 5] != '/') return SPH_OK;
  return sphi_fail(ctx, SPH_ERR_ARG, "sph_series_create: the path %s does not end in NAME.pvd",
                   path != NULL ? path : "NULL");
}

static sph_status keep_path(sph_series *s, const char *path) {
  s->path_bytes = strlen(path) + 1;
  s->path = sphi_alloc(s->base.ctx, s->path_bytes);
  if (s->path == NULL) return SPH_ERR_NOMEM;
  memcpy(s->path, path, s->path_bytes);
  s->stem = s->path_bytes - sizeof ".pvd";
  return SPH_OK;
}

sph_status sph_series_create(sph_context *ctx, const char *path, sph_series **out) {
  if (out != NULL) *out = NULL;
  sph_status status = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (status != SPH_OK) return status;
  if (out == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "sph_series_create: out is NULL");
  status = check_path(ctx, path);
  if (status != SPH_OK) return status;
  sph_series *s = sphi_calloc(ctx, sizeof *s);
  if (s == NULL) return SPH_ERR_NOMEM;
  s->base.ctx = ctx;
  if (keep_path(s, path) != SPH_OK) {
    sphi_free(ctx, s, sizeof *s);
    return SPH_ERR_NOMEM;
  }
  s->base.magic = SPHI_MAGIC_SERIES;
  sphi_context_retain(ctx);
  *out = s;
  return SPH_OK;
}

void sph_series_destroy(sph_series *s) {
  if (sphi_check_handle(NULL, s, SPHI_MAGIC_SERIES, "series") != SPH_OK) return;
  sph_context *ctx = s->base.ctx;
  sphi_buffer_free(ctx, &s->entries);
  sphi_buffer_free(ctx, &s->names);
  sphi_free(ctx, s->path, s->path_bytes);
  s->base.magic = 0;
  sphi_free(ctx, s, sizeof *s);
  sphi_context_release(ctx);
}

int64_t sph_series_count(const sph_series *s) {
  return sphi_check_handle(NULL, s, SPHI_MAGIC_SERIES, "series") == SPH_OK ? s->count : -1;
}

/* ---- the list ---------------------------------------------------------------------------- */

/* Room for `bytes` more after `used`, keeping what is there. */
static sph_status grow(sph_context *ctx, sphi_buffer *b, size_t used, size_t bytes) {
  sphi_buffer fresh = {NULL, 0};
  if (b->ptr != NULL && b->bytes - used >= bytes) return SPH_OK;
  sph_status status = sphi_buffer_reserve(ctx, &fresh, 2 * (used + bytes));
  if (status != SPH_OK) return status;
  if (used > 0) memcpy(fresh.ptr, b->ptr, used);
  sphi_buffer_free(ctx, b);
  *b = fresh;
  return SPH_OK;
}

static sph_status append(sph_series *s, double time, const char *name) {
  sph_context *ctx = s->base.ctx;
  size_t used = (size_t)s->count * sizeof(entry), length = strlen(name) + 1;
  sph_status status = grow(ctx, &s->entries, used, sizeof(entry));
  if (status == SPH_OK) status = grow(ctx, &s->names, s->names_used, length);
  if (status != SPH_OK) return status;
  ((entry *)s->entries.ptr)[s->count++] = (entry){time, s->names_used};
  memcpy((char *)s->names.ptr + s->names_used, name, length);
  s->names_used += length;
  return SPH_OK;
}

static void take_off(sph_series *s) {
  s->count -= 1;
  s->names_used = ((entry *)s->entries.ptr)[s->count].name;
}

static void write_entry(const sph_series *s, sphi_file *f, int64_t k) {
  const entry *e = (const entry *)s->entries.ptr + k;
  char time[SPHI_NUMBER_TEXT];
  (void)sphi_number(time, e->time);
  sphi_file_text(f, "    <DataSet");
  sphi_file_attribute(f, "timestep", time);
  sphi_file_attribute(f, "part", "0");
  sphi_file_attribute(f, "file", (const char *)s->names.ptr + e->name);
  sphi_file_text(f, "/>\n");
}

static sph_status write_list(const sph_series *s) {
  sphi_file f;
  sph_status status = sphi_file_open(&f, s->base.ctx, s->path, 0, "sph_series");
  if (status != SPH_OK) return status;
  sphi_file_text(&f, "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n"
                     "  <Collection>\n");
  for (int64_t k = 0; k < s->count; ++k) write_entry(s, &f, k);
  sphi_file_text(&f, "  </Collection>\n</VTKFile>\n");
  return sphi_file_close(&f, SPH_OK);
}

static sph_status add(sph_series *s, double time, const char *name) {
  sph_status status = append(s, time, name);
  if (status != SPH_OK) return status;
  status = write_list(s);
  if (status != SPH_OK) take_off(s);
  return status;
}

static sph_status check_time(const sph_series *s, double time) {
  sph_status status = sphi_check_handle(NULL, s, SPHI_MAGIC_SERIES, "series");
  if (status != SPH_OK || isfinite(time)) return status;
  return sphi_fail(s->base.ctx, SPH_ERR_ARG, "sph_series: time = %g is not finite", time);
}

sph_status sph_series_add(sph_series *s, double time, const char *file) {
  sph_status status = check_time(s, time);
  if (status != SPH_OK) return status;
  if (file == NULL || file[0] == '\0')
    return sphi_fail(s->base.ctx, SPH_ERR_ARG, "sph_series_add: the file is %s",
                     file != NULL ? "empty" : "NULL");
  return add(s, time, file);
}

/* ---- writing ----------------------------------------------------------------------------- */

static const char *base_name(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash != NULL ? slash + 1 : path;
}

/* Write under the name, then list it; a file that is not listed is removed. */
static sph_status write_named(sph_series *s, const char *name, const sph_particles *set,
                              double time, const sph_output_options *options) {
  sph_output_options o;
  sph_output_options_init(&o);
  sph_status status = sphi_options_read(s->base.ctx, &o, sizeof o, options);
  if (status != SPH_OK) return status;
  o.time = time;
  status = sph_vtp_write(set, name, &o);
  if (status != SPH_OK) return status;
  status = add(s, time, base_name(name));
  if (status != SPH_OK) (void)unlink(name);
  return status;
}

sph_status sph_series_write(sph_series *s, const sph_particles *set, double time,
                            const sph_output_options *options) {
  sph_status status = check_time(s, time);
  if (status == SPH_OK) status = sphi_check_handle(s->base.ctx, set, SPHI_MAGIC_PARTICLES, "set");
  if (status != SPH_OK) return status;
  size_t bytes = s->stem + sizeof "_9223372036854775807.vtp";
  char *name = sphi_alloc(s->base.ctx, bytes);
  if (name == NULL) return SPH_ERR_NOMEM;
  (void)snprintf(name, bytes, "%.*s_%06lld.vtp", (int)s->stem, s->path, (long long)s->count);
  status = write_named(s, name, set, time, options);
  sphi_free(s->base.ctx, name, bytes);
  return status;
}
