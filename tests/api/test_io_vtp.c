/* Particle files for ParaView, read back by a reader of our own, and by VTK's where it is. */
#include "../io_help.h"

/* --- arrays ------------------------------------------------------------------------------ */

static const double *values_of(const sph_particles *set, const char *name) {
  return sph_particles_field_const(set, sph_particles_find_field(set, name));
}

static void expect_entry_of(const vtp_array *a, int64_t i, int32_t c, double want) {
  int single = strcmp(a->type, "Float32") == 0;
  double got = vtp_value(a, i, c);
  if (got != (single ? (double)(float)want : want))
    fail_msg("%s[%d][%d] = %.17g, not %.17g", a->name, (int)i, (int)c, got, want);
}

static void expect_plain(const vtp_file *v, const sph_particles *set, const char *name) {
  const vtp_array *a = vtp_find(v, name);
  const double *values = values_of(set, name);
  if (!a) fail_msg("there is no array %s", name);
  int32_t n = sph_particles_components(set, sph_particles_find_field(set, name));
  assert_int_equal(a->components, n);
  for (int64_t i = 0; i < v->points; i++)
    for (int32_t c = 0; c < n; c++) expect_entry_of(a, i, c, values[i * n + c]);
}

static void expect_vector(const vtp_file *v, const sph_particles *set, const char *array,
                          const char *field) {
  const vtp_array *a = vtp_find(v, array);
  const double *values = values_of(set, field);
  int32_t d = sph_particles_dim(set);
  if (!a) fail_msg("there is no array %s", array);
  assert_int_equal(a->components, 3);
  for (int64_t i = 0; i < v->points; i++)
    for (int32_t c = 0; c < 3; c++) expect_entry_of(a, i, c, c < d ? values[i * d + c] : 0.0);
}

/* Rows and columns of the tensor by the packed order that base.h states, written out here. */
static double tensor(const double *s, int32_t dim, int r, int c) {
  if (r >= dim || c >= dim) return 0.0;
  if (dim == 1) return s[0];
  if (r == c) return s[r];
  if (dim == 2) return s[2];
  return r + c == 1 ? s[3] : r + c == 2 ? s[4] : s[5];
}

static void expect_sigma(const vtp_file *v, const sph_particles *set) {
  const vtp_array *a = vtp_find(v, "sigma");
  const double *values = values_of(set, "sigma");
  int32_t d = sph_particles_dim(set), n = sph_sym_components(d);
  assert_non_null(a);
  assert_int_equal(a->components, 9);
  for (int64_t i = 0; i < v->points; i++)
    for (int c = 0; c < 9; c++) expect_entry_of(a, i, c, tensor(values + i * n, d, c / 3, c % 3));
}

static void expect_matrix(const vtp_file *v, const sph_particles *set, const char *name) {
  const vtp_array *a = vtp_find(v, name);
  const double *values = values_of(set, name);
  int32_t d = sph_particles_dim(set);
  if (!a) fail_msg("there is no array %s", name);
  assert_int_equal(a->components, 9);
  for (int64_t i = 0; i < v->points; i++)
    for (int r = 0; r < 3; r++)
      for (int c = 0; c < 3; c++)
        expect_entry_of(a, i, 3 * r + c, r < d && c < d ? values[(i * d + r) * d + c] : 0.0);
}

static void expect_marks(const vtp_file *v, sph_particles *set) {
  const vtp_array *id = vtp_find(v, "id"), *role = vtp_find(v, "role"),
                  *phase = vtp_find(v, "phase");
  assert_true(id && role && phase);
  assert_string_equal(id->type, "Int64");
  assert_string_equal(role->type, "Int32");
  assert_string_equal(phase->type, "Int32");
  for (int64_t i = 0; i < v->points; i++) {
    expect_entry_of(id, i, 0, (double)sph_particles_ids(set)[i]);
    expect_entry_of(role, i, 0, sph_particles_roles(set)[i]);
    expect_entry_of(phase, i, 0, sph_particles_phases(set)[i]);
  }
}

static void expect_vertices(const vtp_file *v) {
  const vtp_array *to = vtp_find(v, "connectivity"), *end = vtp_find(v, "offsets");
  assert_true(to && end && v->verts == v->points);
  for (int64_t i = 0; i < v->points; i++) {
    expect_entry_of(to, i, 0, (double)i);
    expect_entry_of(end, i, 0, (double)(i + 1));
  }
}

static void expect_all(const vtp_file *v, sph_particles *set) {
  static const char *const plain[] = {"m", "rho",     "h",          "p",
                                      "c", "spacing", "a<b>&\"c\"", "temperature, K"};
  static const char *const vectors[] = {"v", "x0", "a"};
  for (size_t k = 0; k < sizeof plain / sizeof *plain; k++) expect_plain(v, set, plain[k]);
  for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++)
    expect_vector(v, set, vectors[k], vectors[k]);
  expect_vector(v, set, "Points", "x");
  expect_sigma(v, set);
  expect_matrix(v, set, "F");
  expect_matrix(v, set, "PK");
  expect_marks(v, set);
  expect_vertices(v);
  assert_null(vtp_find(v, "e")); /* never created */
  assert_null(vtp_find(v, "x")); /* it is the points */
}

/* 3000 particles are more than a buffer; 1 and 0 are a file too. */
static void test_every_array(void **state) {
  (void)state;
  static const int64_t sizes[] = {3000, 1, 0};
  io_open_folder();
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int single = 0; single < 2; single++)
      for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        sph_context *ctx = rh_context(1);
        sph_particles *set = io_set(ctx, dim, sizes[k], sizes[k] / 10);
        sph_output_options o;
        sph_output_options_init(&o);
        o.single = single;
        check_ok(sph_vtp_write(set, io_path("a.vtp"), &o));
        vtp_file v = vtp_open("a.vtp");
        assert_int_equal(v.points, sizes[k]);
        assert_true(isnan(v.time));
        expect_all(&v, set);
        assert_string_equal(vtp_find(&v, "Points")->type, single ? "Float32" : "Float64");
        free(v.text);
        sph_particles_destroy(set);
        sph_context_destroy(ctx);
      }
  assert_int_equal(io_files(""), 1);
  io_close_folder();
}

static void test_choice(void **state) {
  (void)state;
  static const int32_t fields[] = {SPH_FIELD_RHO, SPH_FIELD_X, SPH_FIELD_V, SPH_FIELD_RHO};
  sph_context *ctx = rh_context(1);
  sph_particles *set = io_set(ctx, 2, 50, 10);
  sph_output_options o;
  int32_t id;
  io_open_folder();
  sph_output_options_init(&o);
  o.fields = fields;
  o.field_count = 4;
  o.ghosts = 0;
  o.time = 0.1;
  check_ok(sph_particles_add_field(set, "role", 1, &id)); /* takes the place of ours */
  check_ok(sph_vtp_write(set, io_path("a.vtp"), &o));
  vtp_file v = vtp_open("a.vtp");
  assert_int_equal(v.points, 40);
  assert_int_equal(v.count, 7); /* rho, v, id, phase, Points, connectivity, offsets */
  assert_true(v.time == 0.1);
  expect_plain(&v, set, "rho");
  expect_vector(&v, set, "v", "v");
  free(v.text);
  o.field_count = 0; /* given, and none */
  check_ok(sph_vtp_write(set, io_path("a.vtp"), &o));
  v = vtp_open("a.vtp");
  assert_int_equal(v.count, 5);
  free(v.text);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
  io_close_folder();
}

/* Values that are not finite go through as they are. */
static void test_not_finite(void **state) {
  (void)state;
  static const double odd[] = {NAN, INFINITY, -INFINITY, -0.0, 5e-324};
  sph_context *ctx = rh_context(1);
  sph_particles *set = io_set(ctx, 1, 5, 0);
  double *v;
  io_open_folder();
  check_ok(sph_particles_field(set, SPH_FIELD_RHO, &v));
  memcpy(v, odd, sizeof odd);
  check_ok(sph_vtp_write(set, io_path("a.vtp"), NULL));
  vtp_file file = vtp_open("a.vtp");
  assert_memory_equal(vtp_find(&file, "rho")->data, odd, sizeof odd);
  free(file.text);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
  io_close_folder();
}

/* --- series ------------------------------------------------------------------------------ */

/* The k-th entry of a .pvd: its time, and its file, which is there. */
static void expect_entry(const char *text, int k, double time, const char *name, int exists) {
  char value[64];
  const char *at = text;
  for (int j = 0; j <= k; j++) {
    at = strstr(at + 1, "<DataSet");
    assert_non_null(at);
  }
  const char *end = strchr(at, '>');
  vtp_attribute(at, end, "timestep", value, sizeof value);
  assert_true(strtod(value, NULL) == time);
  vtp_attribute(at, end, "file", value, sizeof value);
  assert_string_equal(value, name);
  if (exists) assert_true(io_exists(value));
}

static int count_of(const char *text, const char *word) {
  int count = 0;
  for (const char *at = strstr(text, word); at; at = strstr(at + 1, word)) count++;
  return count;
}

static void expect_series(int count) {
  char name[32], *text = io_read("run.pvd", NULL);
  assert_true(strncmp(text, "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\"", 48) == 0);
  assert_int_equal(count_of(text, "<DataSet"), count);
  for (int k = 0; k < count; k++) {
    (void)snprintf(name, sizeof name, "run_%06d.vtp", k);
    expect_entry(text, k, 0.1 * k, name, 1);
  }
  assert_non_null(strstr(text, "  </Collection>\n</VTKFile>\n"));
  free(text);
}

static void test_series(void **state) {
  (void)state;
  sph_context *ctx = rh_context(1);
  sph_particles *set = io_set(ctx, 2, 20, 2);
  sph_series *series = NULL;
  io_open_folder();
  check_ok(sph_series_create(ctx, io_path("run.pvd"), &series));
  assert_int_equal(io_files(""), 0);
  for (int k = 0; k < 30; k++) {
    check_ok(sph_series_write(series, set, 0.1 * k, NULL));
    assert_int_equal(sph_series_count(series), k + 1);
    expect_series(k + 1);
    assert_int_equal(io_files(""), k + 2);
  }
  vtp_file v = vtp_open("run_000007.vtp");
  assert_true(v.time == 0.1 * 7);
  free(v.text);
  check_ok(sph_series_add(series, -1.5, "other & more.vtp"));
  char *text = io_read("run.pvd", NULL);
  expect_entry(text, 30, -1.5, "other & more.vtp", 0);
  free(text);
  sph_series_destroy(series);
  sph_particles_destroy(set);
  sph_context_destroy(ctx);
  io_close_folder();
}

/* --- VTK's own reader -------------------------------------------------------------------- */

/* Debian's packages belong to Debian's Python, which need not be the first one. */
static const char *python_with_vtk(void) {
  static const char *const names[] = {"python3", "/usr/bin/python3"};
  for (int k = 0; k < 2; k++) {
    char command[128];
    (void)snprintf(command, sizeof command, "%s -c 'import vtkmodules.vtkIOXML' 2> /dev/null",
                   names[k]);
    if (system(command) == 0) return names[k];
  }
  return NULL;
}

/* The script compares every array with the comma-separated values of the same set. */
static void test_vtk_reads_it(void **state) {
  (void)state;
  const char *python = python_with_vtk();
  if (python == NULL) {
    print_message("VTK's reader is not tried: install the Debian package python3-vtk9\n");
    skip();
  }
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int single = 0; single < 2; single++) {
      sph_context *ctx = rh_context(1);
      sph_particles *set = io_set(ctx, dim, 500, 50);
      sph_output_options o;
      char command[512];
      io_open_folder();
      sph_output_options_init(&o);
      o.single = single;
      o.time = 2.5;
      check_ok(sph_vtp_write(set, io_path("a.vtp"), &o));
      check_ok(sph_csv_write(set, io_path("a.csv"), NULL));
      (void)snprintf(command, sizeof command, "%s tests/tools/read_vtp.py %s/a.vtp %s/a.csv %d 2.5",
                     python, io_folder, io_folder, (int)dim);
      assert_int_equal(system(command), 0);
      io_close_folder();
      sph_particles_destroy(set);
      sph_context_destroy(ctx);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_every_array),  cmocka_unit_test(test_choice),
    cmocka_unit_test(test_not_finite),   cmocka_unit_test(test_series),
    cmocka_unit_test(test_vtk_reads_it),
};
SPH_TEST_MAIN(tests)
