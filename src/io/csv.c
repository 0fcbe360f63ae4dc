/* Comma-separated values: snapshots of a set, and time histories that grow row by row. */
#include "io_impl.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* ---- snapshots --------------------------------------------------------------------------- */

static const char *suffix_of(const sphi_selection *s, int32_t field, int32_t c, char number[16]) {
  static const char *const vector[] = {"_x", "_y", "_z"};
  static const char *const packed[3][6] = {
      {"_xx"}, {"_xx", "_yy", "_xy"}, {"_xx", "_yy", "_zz", "_xy", "_xz", "_yz"}};
  static const char *const full[] = {"_xx", "_xy", "_xz", "_yx", "_yy", "_yz", "_zx", "_zy", "_zz"};
  switch (sphi_field_shape(s->set, field)) {
  case SPHI_SHAPE_VECTOR:
    return vector[c];
  case SPHI_SHAPE_SYMMETRIC:
    return packed[s->dim - 1][c];
  case SPHI_SHAPE_MATRIX:
    return full[c / s->dim * 3 + c % s->dim];
  default:
    (void)snprintf(number, 16, "_%d", (int)c);
    return sph_particles_components(s->set, field) > 1 ? number : "";
  }
}

static void write_names(const sphi_selection *s, sphi_file *f) {
  sphi_file_text(f, "id,role,phase");
  for (int32_t k = 0; k < s->count; ++k)
    for (int32_t c = 0; c < sph_particles_components(s->set, s->field[k]); ++c) {
      char name[64], number[16];
      (void)snprintf(name, sizeof name, "%s%s", sphi_field_name(s->set, s->field[k]),
                     suffix_of(s, s->field[k], c, number));
      sphi_file_text(f, ",");
      sphi_file_cell(f, name);
    }
  sphi_file_text(f, "\n");
}

static void write_particle(const sphi_selection *s, sphi_file *f, int64_t i) {
  sphi_file_integer(f, sph_particles_ids(s->set)[i]);
  sphi_file_text(f, ",");
  sphi_file_integer(f, sphi_particles_roles(s->set)[i]);
  sphi_file_text(f, ",");
  sphi_file_integer(f, sphi_particles_phases(s->set)[i]);
  for (int32_t k = 0; k < s->count; ++k) {
    int32_t n = sph_particles_components(s->set, s->field[k]);
    const double *v = sph_particles_field_const(s->set, s->field[k]) + i * n;
    for (int32_t c = 0; c < n; ++c) {
      sphi_file_text(f, ",");
      sphi_file_number(f, v[c]);
    }
  }
  sphi_file_text(f, "\n");
}

sph_status sph_csv_write(const sph_particles *set, const char *path,
                         const sph_output_options *options) {
  enum { REPORT = 1 << 14 };
  sphi_selection s;
  sphi_file f;
  sph_status status = sphi_select(&s, set, options, "sph_csv_write");
  if (status != SPH_OK) return status;
  status = sphi_file_open(&f, sphi_particles_context(set), path, 0, "sph_csv_write");
  if (status != SPH_OK) return status;
  write_names(&s, &f);
  for (int64_t i = 0; i < s.n && f.status == SPH_OK && status == SPH_OK; ++i) {
    write_particle(&s, &f, i);
    if (i % REPORT == REPORT - 1)
      status = sphi_progress(f.ctx, (double)(i + 1) / (double)s.n, "writing");
  }
  return sphi_file_close(&f, status);
}

/* ---- histories --------------------------------------------------------------------------- */

/* A row always fits into the buffer: no part of one is ever refused. */
enum { NUMBER_AND_COMMA = 32, MOST_COLUMNS = SPHI_FILE_BUFFER / NUMBER_AND_COMMA };

struct sph_history {
  sphi_object base;
  sphi_file file;
  int32_t columns;
  size_t path_bytes;
};

static sph_status check_names(sph_context *ctx, int32_t columns, const char *const *names) {
  if (columns < 1 || columns > MOST_COLUMNS)
    return sphi_fail(ctx, SPH_ERR_ARG, "sph_history_create: %d columns, not 1 to %d", (int)columns,
                     MOST_COLUMNS);
  if (names == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "sph_history_create: names is NULL");
  for (int32_t c = 0; c < columns; ++c)
    if (names[c] == NULL)
      return sphi_fail(ctx, SPH_ERR_ARG, "sph_history_create: names[%d] is NULL", (int)c);
  return SPH_OK;
}

static void write_head(sphi_file *f, int32_t columns, const char *const *names) {
  for (int32_t c = 0; c < columns; ++c) {
    if (c > 0) sphi_file_text(f, ",");
    sphi_file_cell(f, names[c]);
  }
  sphi_file_text(f, "\n");
  (void)sphi_file_flush(f);
}

/* The path is kept for sentences. */
static sph_status keep_path(sph_history *h) {
  size_t bytes = strlen(h->file.path) + 1;
  char *copy = sphi_alloc(h->base.ctx, bytes);
  if (copy == NULL) return SPH_ERR_NOMEM;
  memcpy(copy, h->file.path, bytes);
  h->file.path = copy;
  h->path_bytes = bytes;
  return SPH_OK;
}

static sph_status begin_history(sph_history *h, const char *path, int32_t columns,
                                const char *const *names) {
  sph_status status =
      sphi_file_open(&h->file, h->base.ctx, path, 1, "sph_history"); /* in place: it grows */
  if (status != SPH_OK) return status;
  h->columns = columns;
  write_head(&h->file, columns, names);
  status = h->file.status == SPH_OK ? keep_path(h) : h->file.status;
  if (status == SPH_OK) return SPH_OK;
  status = sphi_file_close(&h->file, status);
  if (h->file.created) (void)unlink(path);
  return status;
}

sph_status sph_history_create(sph_context *ctx, const char *path, int32_t columns,
                              const char *const *names, sph_history **out) {
  if (out != NULL) *out = NULL;
  sph_status status = sphi_check_handle(NULL, ctx, SPHI_MAGIC_CONTEXT, "ctx");
  if (status != SPH_OK) return status;
  if (out == NULL) return sphi_fail(ctx, SPH_ERR_ARG, "sph_history_create: out is NULL");
  status = check_names(ctx, columns, names);
  if (status != SPH_OK) return status;
  sph_history *h = sphi_calloc(ctx, sizeof *h);
  if (h == NULL) return SPH_ERR_NOMEM;
  h->base.ctx = ctx;
  status = begin_history(h, path, columns, names);
  if (status != SPH_OK) {
    sphi_free(ctx, h, sizeof *h);
    return status;
  }
  h->base.magic = SPHI_MAGIC_HISTORY;
  sphi_context_retain(ctx);
  *out = h;
  return SPH_OK;
}

void sph_history_destroy(sph_history *h) {
  if (sphi_check_handle(NULL, h, SPHI_MAGIC_HISTORY, "history") != SPH_OK) return;
  sph_context *ctx = h->base.ctx;
  h->file.status = SPH_OK; /* one more try */
  (void)sphi_file_close(&h->file, SPH_OK);
  sphi_free(ctx, (void *)(uintptr_t)h->file.path, h->path_bytes);
  h->base.magic = 0;
  sphi_free(ctx, h, sizeof *h);
  sphi_context_release(ctx);
}

sph_status sph_history_flush(sph_history *h) {
  sph_status status = sphi_check_handle(NULL, h, SPHI_MAGIC_HISTORY, "history");
  if (status != SPH_OK) return status;
  h->file.status = SPH_OK; /* what failed before may go now */
  return sphi_file_flush(&h->file);
}

sph_status sph_history_add(sph_history *h, const double *values) {
  sph_status status = sphi_check_handle(NULL, h, SPHI_MAGIC_HISTORY, "history");
  if (status != SPH_OK) return status;
  if (values == NULL) return sphi_fail(h->base.ctx, SPH_ERR_ARG, "sph_history_add: values is NULL");
  size_t need = (size_t)h->columns * NUMBER_AND_COMMA;
  if (SPHI_FILE_BUFFER - h->file.used < need) status = sph_history_flush(h);
  if (SPHI_FILE_BUFFER - h->file.used < need) return status;
  h->file.status = SPH_OK;
  for (int32_t c = 0; c < h->columns; ++c) {
    if (c > 0) sphi_file_text(&h->file, ",");
    sphi_file_number(&h->file, values[c]);
  }
  sphi_file_text(&h->file, "\n");
  return SPH_OK;
}
