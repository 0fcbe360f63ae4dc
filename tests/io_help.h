/* What the tests of the output share: a scratch folder, whole files, and a small reader of .vtp
 * files that knows nothing of the writer. */
#ifndef SPH_TESTS_IO_HELP_H
#define SPH_TESTS_IO_HELP_H

#include "rhs_help.h"

#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

static CHECK_UNUSED char io_folder[64], io_path_text[512];

static CHECK_UNUSED void io_open_folder(void) {
  strcpy(io_folder, P_tmpdir "/sph_io_XXXXXX");
  assert_non_null(mkdtemp(io_folder));
}
/* NAME in the folder; valid until the next call. */
static CHECK_UNUSED const char *io_path(const char *name) {
  (void)snprintf(io_path_text, sizeof io_path_text, "%s/%s", io_folder, name);
  return io_path_text;
}
/* Files in the folder whose names contain `part` ("" = all). */
static CHECK_UNUSED int io_files(const char *part) {
  DIR *dir = opendir(io_folder);
  int count = 0;
  assert_non_null(dir);
  for (struct dirent *d = readdir(dir); d != NULL; d = readdir(dir))
    count += d->d_name[0] != '.' && strstr(d->d_name, part) != NULL;
  (void)closedir(dir);
  return count;
}
static CHECK_UNUSED void io_close_folder(void) {
  DIR *dir = opendir(io_folder);
  assert_non_null(dir);
  for (struct dirent *d = readdir(dir); d != NULL; d = readdir(dir))
    if (d->d_name[0] != '.') (void)unlink(io_path(d->d_name));
  (void)closedir(dir);
  assert_int_equal(rmdir(io_folder), 0);
}
static CHECK_UNUSED int io_exists(const char *name) {
  struct stat info;
  return stat(io_path(name), &info) == 0;
}

/* A whole file with a NUL behind it; free() it. */
static CHECK_UNUSED char *io_read(const char *name, size_t *bytes) {
  FILE *file = fopen(io_path(name), "rb");
  struct stat info;
  if (!file) fail_msg("%s cannot be read", io_path(name));
  assert_int_equal(fstat(fileno(file), &info), 0);
  char *text = (char *)calloc(1, (size_t)info.st_size + 1);
  assert_non_null(text);
  assert_int_equal(fread(text, 1, (size_t)info.st_size, file), info.st_size);
  (void)fclose(file);
  if (bytes) *bytes = (size_t)info.st_size;
  return text;
}

/* --- .vtp -------------------------------------------------------------------------------- */

typedef struct vtp_array {
  char name[128], type[16];
  int32_t components;
  const char *data;
  uint64_t bytes;
} vtp_array;

typedef struct vtp_file {
  char *text;
  size_t bytes;
  int64_t points, verts;
  double time; /* NaN: none */
  int count;
  vtp_array array[160];
} vtp_file;

/* Value of an attribute within [at, end), with the entities undone. */
static CHECK_UNUSED void vtp_attribute(const char *at, const char *end, const char *name, char *out,
                                       size_t room) {
  static const char *const entity[][2] = {
      {"&amp;", "&"}, {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}};
  char key[40];
  size_t n = 0;
  (void)snprintf(key, sizeof key, " %s=\"", name);
  const char *p = strstr(at, key);
  if (!p || p >= end) fail_msg("there is no attribute %s in %.80s", name, at);
  for (p += strlen(key); *p != '"'; n++) {
    assert_true(p < end && n + 1 < room);
    out[n] = *p;
    size_t step = 1;
    for (size_t k = 0; k < sizeof entity / sizeof *entity; k++)
      if (strncmp(p, entity[k][0], strlen(entity[k][0])) == 0) {
        out[n] = entity[k][1][0];
        step = strlen(entity[k][0]);
      }
    p += step;
  }
  out[n] = '\0';
}

static CHECK_UNUSED int64_t vtp_integer(const char *at, const char *end, const char *name) {
  char text[32], *stop;
  vtp_attribute(at, end, name, text, sizeof text);
  long long value = strtoll(text, &stop, 10);
  assert_true(*stop == '\0' && stop != text);
  return value;
}

/* Size of one component by the name of the type. */
static CHECK_UNUSED uint64_t vtp_size(const vtp_array *a) {
  if (strcmp(a->type, "Float64") == 0 || strcmp(a->type, "Int64") == 0) return 8;
  if (strcmp(a->type, "Float32") == 0 || strcmp(a->type, "Int32") == 0) return 4;
  fail_msg("array %s has type %s", a->name, a->type);
  return 0;
}

static CHECK_UNUSED void vtp_read_header(vtp_file *v, const char *head_end) {
  char order[16], header[16];
  const uint16_t one = 1;
  const char *piece = strstr(v->text, "<Piece"), *time = strstr(v->text, "Name=\"TimeValue\"");
  assert_true(strncmp(v->text, "<?xml", 5) == 0 && piece != NULL && piece < head_end);
  vtp_attribute(v->text, head_end, "byte_order", order, sizeof order);
  vtp_attribute(v->text, head_end, "header_type", header, sizeof header);
  assert_string_equal(order, *(const char *)&one ? "LittleEndian" : "BigEndian");
  assert_string_equal(header, "UInt64");
  v->points = vtp_integer(piece, head_end, "NumberOfPoints");
  v->verts = vtp_integer(piece, head_end, "NumberOfVerts");
  v->time = time ? strtod(strchr(time, '>') + 1, NULL) : NAN;
}

/* The arrays lie one behind the other, each behind its size, and the end follows the last. */
static CHECK_UNUSED vtp_file vtp_open(const char *name) {
  vtp_file v = {0};
  v.text = io_read(name, &v.bytes);
  const char *appended = strstr(v.text, "<AppendedData encoding=\"raw\">");
  assert_non_null(appended);
  const char *data = strchr(appended, '_') + 1, *next = data;
  vtp_read_header(&v, appended);
  for (const char *at = strstr(v.text, "<Piece"); (at = strstr(at, "<DataArray")) != NULL; at++) {
    if (at > appended) break;
    vtp_array *a = &v.array[v.count++];
    const char *end = strchr(at, '>');
    vtp_attribute(at, end, "Name", a->name, sizeof a->name);
    vtp_attribute(at, end, "type", a->type, sizeof a->type);
    a->components = (int32_t)vtp_integer(at, end, "NumberOfComponents");
    assert_ptr_equal(data + vtp_integer(at, end, "offset"), next);
    memcpy(&a->bytes, next, sizeof a->bytes);
    a->data = next + sizeof a->bytes;
    assert_int_equal(a->bytes, (uint64_t)v.points * (uint64_t)a->components * vtp_size(a));
    next = a->data + a->bytes;
    assert_true(next < v.text + v.bytes);
  }
  assert_true(strncmp(next, "\n  </AppendedData>\n</VTKFile>\n", v.bytes) == 0);
  return v;
}

static CHECK_UNUSED const vtp_array *vtp_find(const vtp_file *v, const char *name) {
  const vtp_array *found = NULL;
  for (int k = 0; k < v->count; k++)
    if (strcmp(v->array[k].name, name) == 0) {
      if (found) fail_msg("array %s comes twice", name);
      found = &v->array[k];
    }
  return found;
}

/* Component c of particle i, whatever the type. */
static CHECK_UNUSED double vtp_value(const vtp_array *a, int64_t i, int32_t c) {
  double d;
  float f;
  int64_t l;
  int32_t k;
  const char *at = a->data + ((uint64_t)i * (uint64_t)a->components + (uint64_t)c) * vtp_size(a);
  memcpy(&d, at, vtp_size(a) == 8 ? 8 : 4);
  memcpy(&f, at, 4);
  memcpy(&l, at, vtp_size(a) == 8 ? 8 : 4);
  memcpy(&k, at, 4);
  if (strcmp(a->type, "Float64") == 0) return d;
  if (strcmp(a->type, "Float32") == 0) return f;
  return strcmp(a->type, "Int64") == 0 ? (double)l : (double)k;
}

/* --- a set with everything --------------------------------------------------------------- */

static CHECK_UNUSED sph_particles *io_set(sph_context *ctx, int32_t dim, int64_t n,
                                          int64_t ghosts) {
  sph_particles_options o;
  sph_particles *set = NULL;
  sph_particles_options_init(&o);
  o.dim = dim;
  check_ok(sph_particles_create(ctx, &o, &set));
  check_ok(sph_particles_add(set, n - ghosts, NULL));
  check_ok(sph_particles_add_ghosts(set, ghosts, NULL));
  int32_t id;
  check_ok(sph_particles_add_field(set, "a<b>&\"c\"", 2, &id));
  check_ok(sph_particles_add_field(set, "temperature, K", 1, &id));
  rh_seed = 5;
  for (int32_t f = 0; f < 66; f++) {
    double *v;
    if (sph_particles_components(set, f) == 0 || f == SPH_FIELD_E) continue; /* one is missing */
    check_ok(sph_particles_field(set, f, &v));
    for (int64_t k = 0; k < n * sph_particles_components(set, f); k++)
      v[k] = rh_random(-1.0, 1.0) * (k % 7 == 0 ? 1e-200 : 1.0);
  }
  for (int64_t i = 0; i < n - ghosts; i++) {
    sph_particles_phases(set)[i] = (int32_t)(i % 3);
    sph_particles_roles(set)[i] = i % 5 == 0 ? SPH_ROLE_WALL : SPH_ROLE_REAL;
  }
  return set;
}

/* One of each handle in a folder, which then holds the file of the history. */
typedef struct io_setup {
  sph_context *ctx;
  sph_particles *set;
  sph_series *series;
  sph_history *history;
} io_setup;

static CHECK_UNUSED const char *const io_names[] = {"t", "e"};

static CHECK_UNUSED io_setup io_open(sph_context *ctx) {
  io_setup s = {.ctx = ctx, .set = io_set(ctx, 2, 400, 40)};
  io_open_folder();
  check_ok(sph_series_create(ctx, io_path("run.pvd"), &s.series));
  check_ok(sph_history_create(ctx, io_path("h.csv"), 2, io_names, &s.history));
  return s;
}
static CHECK_UNUSED void io_close(io_setup *s) {
  sph_history_destroy(s->history);
  sph_series_destroy(s->series);
  sph_particles_destroy(s->set);
  sph_context_destroy(s->ctx);
  io_close_folder();
}

static CHECK_UNUSED void io_refused(const io_setup *s, sph_status got, sph_status want,
                                    const char *sentence) {
  check_status(got, want);
  if (!strstr(sph_context_last_error(s->ctx), sentence))
    fail_msg("'%s' does not say '%s'", sph_context_last_error(s->ctx), sentence);
}

#endif
