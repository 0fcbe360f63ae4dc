/* Output that cannot be: bad arguments, disks that are full, folders that are missing, memory that
 * is refused. The files of before stay, and no partial ones. */
#include "../io_help.h"
#include "../oom.h"

#include <errno.h>
#include <signal.h>
#include <sys/resource.h>

/* --- arguments --------------------------------------------------------------------------- */

static void test_arguments(void **state) {
  (void)state;
  static const char *const paths[] = {"", "a", "a.vtp", ".pvd", "x/.pvd", "a.pvd/", "a.PVD"};
  static const int32_t columns[] = {INT32_MIN, -1, 0, 2049, INT32_MAX};
  static const double times[] = {NAN, INFINITY, -INFINITY};
  static const int32_t fields[] = {-1, SPH_FIELD_E, 40, 66, INT32_MAX};
  static const char *const holes[] = {"t", NULL};
  io_setup s = io_open(rh_context(1));
  sph_output_options o;
  sph_series *series;
  sph_history *history;
  for (size_t k = 0; k < sizeof paths / sizeof *paths; k++)
    check_status(sph_series_create(s.ctx, paths[k], &series), SPH_ERR_ARG);
  check_status(sph_series_create(s.ctx, NULL, &series), SPH_ERR_ARG);
  for (size_t k = 0; k < sizeof columns / sizeof *columns; k++)
    check_status(sph_history_create(s.ctx, io_path("x"), columns[k], io_names, &history),
                 SPH_ERR_ARG);
  io_refused(&s, sph_history_create(s.ctx, io_path("x"), 2, holes, &history), SPH_ERR_ARG,
             "names[1]");
  for (size_t k = 0; k < sizeof times / sizeof *times; k++) {
    check_status(sph_series_write(s.series, s.set, times[k], NULL), SPH_ERR_ARG);
    check_status(sph_series_add(s.series, times[k], "a.vtp"), SPH_ERR_ARG);
  }
  for (size_t k = 0; k < sizeof fields / sizeof *fields; k++) {
    sph_output_options_init(&o);
    o.fields = &fields[k];
    o.field_count = 1;
    io_refused(&s, sph_vtp_write(s.set, io_path("x"), &o), SPH_ERR_ARG, "fields[0]");
    io_refused(&s, sph_csv_write(s.set, io_path("x"), &o), SPH_ERR_ARG, "fields[0]");
    io_refused(&s, sph_series_write(s.series, s.set, 0.0, &o), SPH_ERR_ARG, "fields[0]");
    o.fields = NULL;
    io_refused(&s, sph_vtp_write(s.set, io_path("x"), &o), SPH_ERR_ARG, "NULL");
    o.field_count = -1;
    io_refused(&s, sph_csv_write(s.set, io_path("x"), &o), SPH_ERR_ARG, "-1");
  }
  assert_int_equal(sph_series_count(s.series), 0);
  assert_int_equal(io_files(""), 1);
  io_close(&s);
}

static void test_options(void **state) {
  (void)state;
  io_setup s = io_open(rh_context(1));
  struct {
    sph_output_options o;
    unsigned char more[16];
  } newer;
  memset(&newer, 0xaa, sizeof newer);
  sph_output_options_init_sized(&newer.o, sizeof newer);
  assert_true(newer.o.ghosts == 1 && newer.o.single == 0 && isnan(newer.o.time));
  assert_true(newer.o.size == sizeof newer && newer.more[15] == 0);
  check_ok(sph_vtp_write(s.set, io_path("x"), &newer.o));
  newer.more[3] = 1;
  check_status(sph_vtp_write(s.set, io_path("x"), &newer.o), SPH_ERR_VERSION);
  check_status(sph_csv_write(s.set, io_path("x"), &newer.o), SPH_ERR_VERSION);
  check_status(sph_series_write(s.series, s.set, 0.0, &newer.o), SPH_ERR_VERSION);
  io_close(&s);
}

/* --- the system refuses ------------------------------------------------------------------ */

static void test_no_such_folder(void **state) {
  (void)state;
  io_setup s = io_open(rh_context(1));
  sph_history *history;
  sph_series *series;
  io_refused(&s, sph_vtp_write(s.set, io_path("no/x.vtp"), NULL), SPH_ERR_IO, strerror(ENOENT));
  io_refused(&s, sph_csv_write(s.set, io_path("no/x.csv"), NULL), SPH_ERR_IO, "no/x.csv");
  io_refused(&s, sph_csv_write(s.set, io_folder, NULL), SPH_ERR_IO, strerror(EISDIR));
  io_refused(&s, sph_history_create(s.ctx, io_path("no/h"), 2, io_names, &history), SPH_ERR_IO,
             strerror(ENOENT));
  assert_null(history);
  check_ok(sph_series_create(s.ctx, io_path("no/x.pvd"), &series));
  io_refused(&s, sph_series_write(series, s.set, 0.0, NULL), SPH_ERR_IO, strerror(ENOENT));
  io_refused(&s, sph_series_add(series, 0.0, "a.vtp"), SPH_ERR_IO, strerror(ENOENT));
  assert_int_equal(sph_series_count(series), 0);
  sph_series_destroy(series);
  assert_int_equal(io_files(""), 1);
  io_close(&s);
}

/* A device is written in place, and stays a device. */
static void test_full_device(void **state) {
  (void)state;
  struct stat before, after;
  io_setup s = io_open(rh_context(1));
  sph_history *history = NULL;
  if (stat("/dev/full", &before) != 0) skip();
  io_refused(&s, sph_vtp_write(s.set, "/dev/full", NULL), SPH_ERR_IO, strerror(ENOSPC));
  io_refused(&s, sph_csv_write(s.set, "/dev/full", NULL), SPH_ERR_IO, "/dev/full");
  io_refused(&s, sph_history_create(s.ctx, "/dev/full", 2, io_names, &history), SPH_ERR_IO,
             strerror(ENOSPC));
  assert_null(history);
  check_ok(sph_vtp_write(s.set, "/dev/null", NULL));
  assert_int_equal(stat("/dev/full", &after), 0);
  assert_true(S_ISCHR(after.st_mode) && before.st_ino == after.st_ino);
  assert_int_equal(access("/dev/full.part", F_OK), -1);
  io_close(&s);
}

/* Files may not grow beyond `bytes`: a disk that fills up while it is written. */
static void limit_files(rlim_t bytes) {
  struct rlimit limit;
  (void)signal(SIGXFSZ, SIG_IGN);
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
  limit.rlim_cur = bytes < limit.rlim_max ? bytes : limit.rlim_max;
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

static void expect_same_file(const char *name, const char *text, size_t bytes) {
  size_t now;
  char *again = io_read(name, &now);
  assert_int_equal(now, bytes);
  assert_memory_equal(again, text, bytes);
  free(again);
}

static void test_disk_fills_up(void **state) {
  (void)state;
  io_setup s = io_open(rh_context(1));
  size_t vtp, csv, pvd;
  check_ok(sph_vtp_write(s.set, io_path("a.vtp"), NULL));
  check_ok(sph_csv_write(s.set, io_path("a.csv"), NULL));
  check_ok(sph_series_write(s.series, s.set, 1.0, NULL));
  char *a = io_read("a.vtp", &vtp), *b = io_read("a.csv", &csv), *c = io_read("run.pvd", &pvd);
  int files = io_files("");
  limit_files(20000); /* less than each of the first two */
  sph_status got[] = {sph_vtp_write(s.set, io_path("a.vtp"), NULL),
                      sph_csv_write(s.set, io_path("a.csv"), NULL),
                      sph_series_write(s.series, s.set, 2.0, NULL)};
  limit_files(100); /* less than the list */
  sph_status list = sph_series_add(s.series, 2.0, "b.vtp");
  limit_files(RLIM_INFINITY);
  for (int k = 0; k < 3; k++) check_status(got[k], SPH_ERR_IO);
  check_status(list, SPH_ERR_IO);
  expect_same_file("a.vtp", a, vtp);
  expect_same_file("a.csv", b, csv);
  expect_same_file("run.pvd", c, pvd);
  assert_int_equal(io_files(""), files);
  assert_int_equal(sph_series_count(s.series), 1);
  check_ok(sph_series_write(s.series, s.set, 2.0, NULL)); /* there is room again */
  assert_true(io_exists("run_000001.vtp"));
  free(a), free(b), free(c);
  io_close(&s);
}

/* No row is lost, and none comes twice. */
static void test_history_waits(void **state) {
  (void)state;
  io_setup s = io_open(rh_context(1));
  double row[2] = {0.0, 0.5};
  int taken = 0, failed = 0;
  limit_files(1001);
  for (int k = 0; k < 20000; k++) {
    row[0] = taken;
    sph_status status = sph_history_add(s.history, row);
    taken += status == SPH_OK;
    failed += status == SPH_ERR_IO;
    if (k % 5000 == 4999) failed += sph_history_flush(s.history) == SPH_ERR_IO;
  }
  limit_files(RLIM_INFINITY);
  assert_true(failed > 4 && taken > 1000 && taken < 20000);
  check_ok(sph_history_flush(s.history));
  char *text = io_read("h.csv", NULL), *at = strchr(text, '\n') + 1;
  for (int k = 0; k < taken; k++) {
    char want[32];
    int length = snprintf(want, sizeof want, "%d,0.5\n", k);
    if (strncmp(at, want, (size_t)length) != 0) fail_msg("row %d: %.20s", k, at);
    at += length;
  }
  assert_int_equal(*at, '\0');
  free(text);
  io_close(&s);
}

/* --- the host stops ---------------------------------------------------------------------- */

static int32_t stop(void *user, double fraction, const char *what) {
  int *calls = (int *)user;
  assert_true(fraction > 0.0 && fraction <= 1.0);
  return strcmp(what, "writing") == 0 && ++*calls == 3;
}

static void test_stopped(void **state) {
  (void)state;
  int calls = 0;
  sph_context_options o;
  sph_context *ctx = NULL;
  sph_context_options_init(&o);
  o.progress = stop;
  o.progress_user = &calls;
  check_ok(sph_context_create(&o, &ctx));
  io_setup s = io_open(ctx);
  check_status(sph_vtp_write(s.set, io_path("a.vtp"), NULL), SPH_ERR_CALLBACK);
  calls = 0;
  check_status(sph_series_write(s.series, s.set, 0.0, NULL), SPH_ERR_CALLBACK);
  assert_int_equal(io_files(""), 1);
  check_ok(sph_particles_add_ghosts(s.set, 60000, NULL));
  calls = 0;
  check_status(sph_csv_write(s.set, io_path("a.csv"), NULL), SPH_ERR_CALLBACK);
  assert_int_equal(io_files(""), 1);
  io_close(&s);
}

/* --- memory ------------------------------------------------------------------------------ */

/* A fresh folder each time: after a failure it is empty. */
static sph_status scenario(sph_context *ctx, void *user) {
  sph_particles *set;
  sph_series *series = NULL;
  sph_history *history = NULL;
  (void)user;
  oom_pause();
  set = io_set(ctx, 2, 30, 3);
  io_open_folder();
  oom_resume();
  sph_status status = sph_vtp_write(set, io_path("a.vtp"), NULL);
  if (status == SPH_OK) status = sph_csv_write(set, io_path("a.csv"), NULL);
  if (status == SPH_OK) status = sph_history_create(ctx, io_path("h.csv"), 2, io_names, &history);
  if (status == SPH_OK) status = sph_series_create(ctx, io_path("run.pvd"), &series);
  for (int k = 0; k < 5 && status == SPH_OK; k++) {
    status = sph_series_write(series, set, k, NULL);
    assert_int_equal(sph_series_count(series), k + (status == SPH_OK));
    assert_int_equal(io_files("run_"), k + (status == SPH_OK));
  }
  assert_int_equal(io_files(".part"), 0);
  assert_int_equal(io_files("h.csv"), history != NULL);
  sph_history_destroy(history);
  sph_series_destroy(series);
  sph_particles_destroy(set);
  io_close_folder();
  return status;
}

static void test_out_of_memory(void **state) {
  (void)state;
  oom_sweep(scenario, NULL);
}

/* Handles keep their context; adding rows allocates nothing. */
static void test_context_goes_first(void **state) {
  (void)state;
  double row[2] = {1.0, 2.0};
  sph_context *ctx = oom_context();
  io_setup s = io_open(ctx);
  int64_t before = oom.allocations;
  sph_particles_destroy(s.set);
  sph_context_destroy(ctx);
  for (int k = 0; k < 10000; k++) check_ok(sph_history_add(s.history, row));
  assert_int_equal(oom.allocations, before);
  sph_history_destroy(s.history);
  sph_series_destroy(s.series);
  oom_check_clean();
  io_close_folder();
}

static const struct CMUnitTest tests[] = {

    cmocka_unit_test(test_arguments),
    cmocka_unit_test(test_options),
    cmocka_unit_test(test_no_such_folder),
    cmocka_unit_test(test_full_device),
    cmocka_unit_test(test_disk_fills_up),
    cmocka_unit_test(test_history_waits),
    cmocka_unit_test(test_stopped),
    cmocka_unit_test(test_out_of_memory),
    cmocka_unit_test(test_context_goes_first),
};
SPH_TEST_MAIN(tests)
