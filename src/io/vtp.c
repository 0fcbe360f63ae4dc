/* VTK XML PolyData. The header names every array and where it begins in the appended data, so the
 * sizes are settled first; then the arrays follow, each behind its size in bytes. */
#include "io_impl.h"

#include <math.h>
#include <string.h>

enum { BLOCK = 1024, WIDEST = 64, ARRAYS = SPHI_FIELD_IDS + 5 };

typedef enum source { FIELD, IDS, ROLES, PHASES, CONNECTIVITY, OFFSETS } source;

typedef struct array {
  const char *name;
  source from;
  int32_t field; /* FIELD */
  int32_t width; /* components in the file */
  int32_t bytes; /* of a component */
} array;

typedef struct vtp {
  sphi_selection s;
  sphi_file file;
  array list[ARRAYS]; /* point data, then points, connectivity, offsets */
  int32_t count;
  uint64_t next; /* offset of the next array */
} vtp;

/* ---- what there is ----------------------------------------------------------------------- */

static int32_t width_of(const sphi_selection *s, int32_t field) {
  switch (sphi_field_shape(s->set, field)) {
  case SPHI_SHAPE_VECTOR:
    return 3;
  case SPHI_SHAPE_SYMMETRIC:
  case SPHI_SHAPE_MATRIX:
    return 9;
  default:
    return sph_particles_components(s->set, field);
  }
}

static void add_array(vtp *v, const char *name, source from, int32_t width, int32_t bytes) {
  v->list[v->count++] = (array){name, from, -1, width, bytes};
}

static void add_field(vtp *v, const char *name, int32_t field) {
  int32_t bytes = v->s.options.single ? (int32_t)sizeof(float) : (int32_t)sizeof(double);
  v->list[v->count++] = (array){name, FIELD, field, width_of(&v->s, field), bytes};
}

/* A host's field of the same name takes the place of ours. */
static void add_marks(vtp *v) {
  static const struct {
    const char *name;
    source from;
    int32_t bytes;
  } marks[] = {{"id", IDS, 8}, {"role", ROLES, 4}, {"phase", PHASES, 4}};
  for (size_t k = 0; k < sizeof marks / sizeof *marks; ++k)
    if (sph_particles_find_field(v->s.set, marks[k].name) < 0)
      add_array(v, marks[k].name, marks[k].from, 1, marks[k].bytes);
}

static void list_arrays(vtp *v) {
  for (int32_t k = 1; k < v->s.count; ++k)
    add_field(v, sphi_field_name(v->s.set, v->s.field[k]), v->s.field[k]);
  add_marks(v);
  add_field(v, "Points", SPH_FIELD_X);
  add_array(v, "connectivity", CONNECTIVITY, 1, 8);
  add_array(v, "offsets", OFFSETS, 1, 8);
}

/* ---- header ------------------------------------------------------------------------------ */

static uint64_t bytes_of(const vtp *v, const array *a) {
  return (uint64_t)v->s.n * (uint64_t)a->width * (uint64_t)a->bytes;
}

static const char *type_of(const array *a) {
  if (a->from == FIELD) return a->bytes == 4 ? "Float32" : "Float64";
  return a->bytes == 4 ? "Int32" : "Int64";
}

static void declare(vtp *v, const array *a) {
  sphi_file *f = &v->file;
  sphi_file_text(f, "        <DataArray");
  sphi_file_attribute(f, "type", type_of(a));
  sphi_file_attribute(f, "Name", a->name);
  sphi_file_text(f, " NumberOfComponents=\"");
  sphi_file_integer(f, a->width);
  sphi_file_text(f, "\" format=\"appended\" offset=\"");
  sphi_file_integer(f, (int64_t)v->next);
  sphi_file_text(f, "\"/>\n");
  v->next += sizeof(uint64_t) + bytes_of(v, a);
}

static const char *byte_order(void) {
  const uint16_t one = 1;
  unsigned char first;
  memcpy(&first, &one, 1);
  return first == 1 ? "LittleEndian" : "BigEndian";
}

static void write_time(vtp *v) {
  if (isnan(v->s.options.time)) return;
  sphi_file_text(&v->file, "    <FieldData>\n      <DataArray type=\"Float64\" Name=\"TimeValue\" "
                           "NumberOfTuples=\"1\" format=\"ascii\">");
  sphi_file_number(&v->file, v->s.options.time);
  sphi_file_text(&v->file, "</DataArray>\n    </FieldData>\n");
}

static void open_piece(vtp *v) {
  sphi_file *f = &v->file;
  sphi_file_text(f, "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\"");
  sphi_file_attribute(f, "byte_order", byte_order());
  sphi_file_text(f, " header_type=\"UInt64\">\n  <PolyData>\n");
  write_time(v);
  sphi_file_text(f, "    <Piece NumberOfPoints=\"");
  sphi_file_integer(f, v->s.n);
  sphi_file_text(f, "\" NumberOfVerts=\"");
  sphi_file_integer(f, v->s.n);
  sphi_file_text(f, "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n");
}

static void write_header(vtp *v) {
  const array *last = v->list + v->count - 3;
  open_piece(v);
  sphi_file_text(&v->file, "      <PointData>\n");
  for (const array *a = v->list; a < last; ++a) declare(v, a);
  sphi_file_text(&v->file, "      </PointData>\n      <Points>\n");
  declare(v, last);
  sphi_file_text(&v->file, "      </Points>\n      <Verts>\n");
  declare(v, last + 1);
  declare(v, last + 2);
  sphi_file_text(&v->file, "      </Verts>\n    </Piece>\n  </PolyData>\n"
                           "  <AppendedData encoding=\"raw\">\n   _");
}

/* ---- data -------------------------------------------------------------------------------- */

/* One particle's field, padded. Packed order: {xx}, {xx, yy, xy}, {xx, yy, zz, xy, xz, yz}. */
static void widen(const sphi_selection *s, int32_t field, const double *from, int32_t width,
                  double *to) {
  static const int32_t packed[3][9] = {{0, -1, -1, -1, -1, -1, -1, -1, -1},
                                       {0, 2, -1, 2, 1, -1, -1, -1, -1},
                                       {0, 3, 4, 3, 1, 5, 4, 5, 2}};
  int32_t d = s->dim, n = sph_particles_components(s->set, field);
  sphi_shape shape = sphi_field_shape(s->set, field);
  for (int32_t c = 0; c < width; ++c) {
    int32_t at = c < n ? c : -1;
    if (shape == SPHI_SHAPE_SYMMETRIC) at = packed[d - 1][c];
    if (shape == SPHI_SHAPE_MATRIX) at = c / 3 < d && c % 3 < d ? c / 3 * d + c % 3 : -1;
    to[c] = at < 0 ? 0.0 : from[at];
  }
}

static void write_fields(vtp *v, const array *a, int64_t begin, int64_t end) {
  const double *values = sph_particles_field_const(v->s.set, a->field);
  int32_t n = sph_particles_components(v->s.set, a->field);
  for (int64_t i = begin; i < end; ++i) {
    double wide[WIDEST];
    float narrow[WIDEST];
    widen(&v->s, a->field, values + i * n, a->width, wide);
    for (int32_t c = 0; c < a->width; ++c) narrow[c] = (float)wide[c];
    const void *data = a->bytes == 4 ? (const void *)narrow : (const void *)wide;
    sphi_file_put(&v->file, data, (size_t)a->width * (size_t)a->bytes);
  }
}

static void write_counts(vtp *v, int64_t first, int64_t begin, int64_t end) {
  int64_t block[BLOCK];
  for (int64_t i = begin; i < end; ++i) block[i - begin] = first + i;
  sphi_file_put(&v->file, block, (size_t)(end - begin) * sizeof *block);
}

static void write_block(vtp *v, const array *a, int64_t begin, int64_t end) {
  size_t n = (size_t)(end - begin);
  switch (a->from) {
  case FIELD:
    write_fields(v, a, begin, end);
    return;
  case IDS:
    sphi_file_put(&v->file, sph_particles_ids(v->s.set) + begin, n * sizeof(int64_t));
    return;
  case ROLES:
    sphi_file_put(&v->file, sphi_particles_roles(v->s.set) + begin, n * sizeof(int32_t));
    return;
  case PHASES:
    sphi_file_put(&v->file, sphi_particles_phases(v->s.set) + begin, n * sizeof(int32_t));
    return;
  case CONNECTIVITY:
    write_counts(v, 0, begin, end);
    return;
  default:
    write_counts(v, 1, begin, end);
  }
}

static sph_status write_data(vtp *v) {
  sph_status status = SPH_OK;
  for (int32_t k = 0; k < v->count && status == SPH_OK; ++k) {
    uint64_t bytes = bytes_of(v, &v->list[k]);
    sphi_file_put(&v->file, &bytes, sizeof bytes);
    for (int64_t i = 0; i < v->s.n && v->file.status == SPH_OK; i += BLOCK)
      write_block(v, &v->list[k], i, i + BLOCK < v->s.n ? i + BLOCK : v->s.n);
    status = sphi_progress(v->file.ctx, (k + 1.0) / v->count, "writing");
  }
  return status;
}

sph_status sph_vtp_write(const sph_particles *set, const char *path,
                         const sph_output_options *options) {
  vtp v;
  memset(&v, 0, sizeof v);
  sph_status status = sphi_select(&v.s, set, options, "sph_vtp_write");
  if (status != SPH_OK) return status;
  status = sphi_file_open(&v.file, sphi_particles_context(set), path, 0, "sph_vtp_write");
  if (status != SPH_OK) return status;
  list_arrays(&v);
  write_header(&v);
  status = write_data(&v);
  sphi_file_text(&v.file, "\n  </AppendedData>\n</VTKFile>\n");
  return sphi_file_close(&v.file, status);
}
