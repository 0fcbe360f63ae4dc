/* Comma-separated values, histories, and the progress line. */
#include "../io_help.h"

#include <fcntl.h>
#include <time.h>

/* --- a small reader ---------------------------------------------------------------------- */

/* The next cell of RFC 4180 text; moves on, past the separator. Answers that: ',' or '\n'. */
static char next_cell(const char **at, char *cell, size_t room) {
  size_t n = 0;
  int quoted = **at == '"';
  if (quoted) ++*at;
  for (;; ++*at) {
    char c = **at;
    assert_true(c != '\0' && n + 1 < room);
    if (quoted && c == '"' && (*at)[1] == '"')
      ++*at;
    else if (quoted && c == '"') {
      ++*at;
      break;
    } else if (!quoted && (c == ',' || c == '\n'))
      break;
    cell[n++] = c;
  }
  cell[n] = '\0';
  char separator = *(*at)++;
  assert_true(separator == ',' || separator == '\n');
  return separator;
}

static void expect_names(const char **at, const char *const *names, int count) {
  char cell[128];
  for (int k = 0; k < count; k++) {
    char separator = next_cell(at, cell, sizeof cell);
    assert_string_equal(cell, names[k]);
    assert_int_equal(separator, k + 1 < count ? ',' : '\n');
  }
}

/* Numbers come back to the bit. */
static void expect_number(const char **at, double want, char separator) {
  char cell[128], *end;
  assert_int_equal(next_cell(at, cell, sizeof cell), separator);
  double got = strtod(cell, &end);
  if (*end != '\0' || memcmp(&got, &want, sizeof got) != 0)
    if (!(isnan(got) && isnan(want))) fail_msg("'%s' is not %.17g", cell, want);
}

/* --- snapshots --------------------------------------------------------------------------- */

/* Of the fields X, V, RHO, SIGMA, F and the two of the host's own. */
static const char *const heads[3][40] = {
    {"id", "role", "phase", "x_x", "v_x", "rho", "sigma_xx", "F_xx", "a<b>&\"c\"_0", "a<b>&\"c\"_1",
     "temperature, K"},
    {"id", "role", "phase", "x_x", "x_y", "v_x", "v_y", "rho", "sigma_xx", "sigma_yy", "sigma_xy",
     "F_xx", "F_xy", "F_yx", "F_yy", "a<b>&\"c\"_0", "a<b>&\"c\"_1", "temperature, K"},
    {"id",       "role",         "phase",        "x_x",           "x_y",      "x_z",
     "v_x",      "v_y",          "v_z",          "rho",           "sigma_xx", "sigma_yy",
     "sigma_zz", "sigma_xy",     "sigma_xz",     "sigma_yz",      "F_xx",     "F_xy",
     "F_xz",     "F_yx",         "F_yy",         "F_yz",          "F_zx",     "F_zy",
     "F_zz",     "a<b>&\"c\"_0", "a<b>&\"c\"_1", "temperature, K"}};

static const int32_t chosen[] = {
    SPH_FIELD_X, SPH_FIELD_V, SPH_FIELD_RHO, SPH_FIELD_SIGMA, SPH_FIELD_F, 64, 65};
enum { CHOSEN = sizeof chosen / sizeof *chosen };

static void test_snapshot(void **state) {
  (void)state;
  io_open_folder();
  for (int32_t dim = 1; dim <= 3; dim++) {
    sph_context *ctx = rh_context(1);
    sph_particles *set = io_set(ctx, dim, 300, 20);
    sph_output_options o;
    sph_output_options_init(&o);
    o.fields = chosen;
    o.field_count = CHOSEN;
    check_ok(sph_csv_write(set, io_path("a.csv"), &o));
    char *text = io_read("a.csv", NULL);
    const char *at = text;
    int count = 0;
    while (count < 40 && heads[dim - 1][count]) count++;
    expect_names(&at, heads[dim - 1], count);
    for (int64_t i = 0; i < 300; i++) {
      int column = 3;
      expect_number(&at, (double)sph_particles_ids(set)[i], ',');
      expect_number(&at, sph_particles_roles(set)[i], ',');
      expect_number(&at, sph_particles_phases(set)[i], ',');
      for (int k = 0; k < CHOSEN; k++) {
        const double *v = sph_particles_field_const(set, chosen[k]);
        int32_t n = sph_particles_components(set, chosen[k]);
        for (int32_t c = 0; c < n; c++)
          expect_number(&at, v[i * n + c], ++column < count ? ',' : '\n');
      }
    }
    assert_int_equal(*at, '\0');
    free(text);
    sph_particles_destroy(set);
    sph_context_destroy(ctx);
  }
  io_close_folder();
}

/* --- histories --------------------------------------------------------------------------- */

static double odd_number(int k) {
  static const double odd[] = {NAN, INFINITY, -INFINITY, 0.0, 5e-324, 1.7976931348623157e308};
  return k % 11 < 6 ? odd[k % 11] : rh_random(-1.0, 1.0) * pow(10.0, k % 600 - 300);
}

static void test_history(void **state) {
  (void)state;
  enum { ROWS = 5000, COLUMNS = 5 };
  static const char *const names[] = {"t", "kinetic, J", "say \"E\"", "", "two\nlines"};
  sph_context *ctx = rh_context(1);
  sph_history *h = NULL;
  double values[COLUMNS];
  io_open_folder();
  check_ok(sph_history_create(ctx, io_path("h.csv"), COLUMNS, names, &h));
  char *text = io_read("h.csv", NULL);
  const char *at = text;
  expect_names(&at, names, COLUMNS); /* there at once */
  free(text);
  rh_seed = 3;
  for (int r = 0; r < ROWS; r++) {
    for (int c = 0; c < COLUMNS; c++) values[c] = odd_number(r * COLUMNS + c);
    check_ok(sph_history_add(h, values));
  }
  check_ok(sph_history_flush(h));
  text = io_read("h.csv", NULL);
  at = text;
  expect_names(&at, names, COLUMNS);
  rh_seed = 3;
  for (int k = 0; k < ROWS * COLUMNS; k++)
    expect_number(&at, odd_number(k), k % COLUMNS == COLUMNS - 1 ? '\n' : ',');
  assert_int_equal(*at, '\0');
  free(text);
  sph_history_destroy(h);
  sph_context_destroy(ctx);
  io_close_folder();
}

/* What was not flushed is written when the history goes; a row as wide as it can be fits. */
static void test_wide_history(void **state) {
  (void)state;
  enum { COLUMNS = 2048 };
  static const char *names[COLUMNS];
  static double values[COLUMNS];
  sph_context *ctx = rh_context(1);
  sph_history *h = NULL;
  size_t bytes;
  for (int c = 0; c < COLUMNS; c++) names[c] = "n", values[c] = -1.2345678901234567e-300;
  io_open_folder();
  check_ok(sph_history_create(ctx, io_path("h.csv"), COLUMNS, names, &h));
  for (int r = 0; r < 3; r++) check_ok(sph_history_add(h, values));
  sph_history_destroy(h);
  char *text = io_read("h.csv", &bytes);
  assert_int_equal(bytes, 2 * COLUMNS + 3 * COLUMNS * strlen("-1.2345678901234567e-300,"));
  free(text);
  sph_context_destroy(ctx);
  io_close_folder();
}

/* The shortest digits that read back the same, of 15 or 17. */
static void test_digits(void **state) {
  (void)state;
  static const struct {
    double value;
    const char *text;
  } cases[] = {{0.1, "0.1"},    {1.0 / 3.0, "0.33333333333333331"},
               {1e22, "1e+22"}, {-2.5, "-2.5"},
               {NAN, "nan"},    {-INFINITY, "-inf"},
               {-0.0, "-0"}};
  static const char *const name = "v";
  sph_context *ctx = rh_context(1);
  sph_history *h = NULL;
  io_open_folder();
  check_ok(sph_history_create(ctx, io_path("h.csv"), 1, &name, &h));
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
    check_ok(sph_history_add(h, &cases[k].value));
  sph_history_destroy(h);
  char *text = io_read("h.csv", NULL), cell[64];
  const char *at = text;
  (void)next_cell(&at, cell, sizeof cell);
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    (void)next_cell(&at, cell, sizeof cell);
    assert_string_equal(cell, cases[k].text);
  }
  free(text);
  sph_context_destroy(ctx);
  io_close_folder();
}

/* --- the progress line ------------------------------------------------------------------- */

/* A terminal: what is written to the stream is read from the other side. */
typedef struct terminal {
  int master;
  FILE *file;
} terminal;

static terminal open_terminal(void) {
  terminal t = {posix_openpt(O_RDWR | O_NOCTTY), NULL};
  if (t.master < 0 || grantpt(t.master) != 0 || unlockpt(t.master) != 0) skip();
  t.file = fopen(ptsname(t.master), "r+");
  if (!t.file) skip();
  assert_int_equal(fcntl(t.master, F_SETFL, O_NONBLOCK), 0);
  return t;
}

/* What came since the last call; "" when nothing did. */
static const char *heard(terminal *t) {
  static char text[4096];
  ssize_t n = read(t->master, text, sizeof text - 1);
  text[n > 0 ? n : 0] = '\0';
  return text;
}

static void wait_for(double seconds) {
  struct timespec t = {0, (long)(seconds * 1e9)};
  (void)nanosleep(&t, NULL);
}

static void test_progress(void **state) {
  (void)state;
  terminal t = open_terminal();
  sph_progress_line line;
  sph_progress_line_init(&line, t.file);
  assert_true(line.delay == 2.0 && line.interval > 0.0 && line.interval <= 1.0);
  line.delay = 0.05;
  line.interval = 0.05;
  for (int k = 0; k < 100; k++)
    assert_int_equal(sph_progress_terminal(&line, 0.001 * k, "steps"), 0);
  assert_string_equal(heard(&t), ""); /* too early */
  wait_for(0.06);
  for (int k = 0; k < 100; k++) (void)sph_progress_terminal(&line, 0.25, "steps");
  const char *text = heard(&t);
  assert_non_null(strstr(text, "steps  25.0 %"));
  assert_ptr_equal(strstr(text, "steps"), strstr(text, "25.0 %") - 7);
  assert_null(strstr(strstr(text, "25.0 %") + 1, "25.0 %")); /* once within the interval */
  wait_for(0.06);
  (void)sph_progress_terminal(&line, 0.5, "steps");
  assert_non_null(strstr(heard(&t), "50.0 %"));
  (void)sph_progress_terminal(&line, 1.0, "steps");
  assert_string_equal(heard(&t), "\r\033[K");
  (void)sph_progress_terminal(&line, 1.0, "steps");
  assert_string_equal(heard(&t), "");               /* cleared once */
  (void)sph_progress_terminal(&line, 0.1, "steps"); /* a new run waits again */
  (void)sph_progress_terminal(&line, 0.2, "neighbours");
  assert_string_equal(heard(&t), "");
  wait_for(0.06);
  (void)sph_progress_terminal(&line, 0.1, "neighbours"); /* fell: new work, its clock begins */
  assert_string_equal(heard(&t), "");
  (void)fclose(t.file);
  (void)close(t.master);
}

/* No terminal, no line, nonsense: silence. */
static void test_silent_progress(void **state) {
  (void)state;
  sph_progress_line line;
  size_t bytes;
  io_open_folder();
  FILE *file = fopen(io_path("log"), "w");
  assert_non_null(file);
  sph_progress_line_init(&line, file);
  line.delay = 0.0;
  for (int k = 0; k <= 10; k++) assert_int_equal(sph_progress_terminal(&line, 0.1 * k, "steps"), 0);
  (void)fclose(file);
  free(io_read("log", &bytes));
  assert_int_equal(bytes, 0);
  sph_progress_line_init(&line, NULL);
  assert_int_equal(sph_progress_terminal(&line, 0.5, "steps"), 0);
  assert_int_equal(sph_progress_terminal(NULL, 0.5, "steps"), 0);
  assert_int_equal(sph_progress_terminal(&line, NAN, NULL), 0);
  io_close_folder();
}

/* As the hook of a context: builds of a list go through it, and are not stopped. */
static void test_progress_hook(void **state) {
  (void)state;
  terminal t = open_terminal();
  sph_progress_line line;
  sph_context_options o;
  sph_context *ctx = NULL;
  sph_progress_line_init(&line, t.file);
  line.delay = 0.0;
  line.interval = 0.0;
  sph_context_options_init(&o);
  o.progress = sph_progress_terminal;
  o.progress_user = &line;
  check_ok(sph_context_create(&o, &ctx));
  rh_system s = rh_make(ctx, 2, 60, 0, 3);
  assert_non_null(strstr(heard(&t), "neighbours"));
  rh_free(&s);
  sph_context_destroy(ctx);
  (void)fclose(t.file);
  (void)close(t.master);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_snapshot),      cmocka_unit_test(test_history),
    cmocka_unit_test(test_wide_history),  cmocka_unit_test(test_digits),
    cmocka_unit_test(test_progress),      cmocka_unit_test(test_silent_progress),
    cmocka_unit_test(test_progress_hook),
};
SPH_TEST_MAIN(tests)
