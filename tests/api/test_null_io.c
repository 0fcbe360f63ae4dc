/* The output with handles that are NULL or of another kind, and with each required pointer NULL. */
#include "../io_help.h"

static void test_null(void **state) {
  (void)state;
  io_setup s = io_open(rh_context(1));
  double v[2] = {0.0, 0.0};
  sph_series *series = (sph_series *)v;
  sph_history *history = (sph_history *)v;
  check_status(sph_vtp_write(NULL, "x.vtp", NULL), SPH_ERR_ARG);
  check_status(sph_csv_write(NULL, "x.csv", NULL), SPH_ERR_ARG);
  io_refused(&s, sph_vtp_write(s.set, NULL, NULL), SPH_ERR_ARG, "NULL");
  io_refused(&s, sph_csv_write(s.set, "", NULL), SPH_ERR_ARG, "empty");
  check_status(sph_series_create(NULL, "a.pvd", &series), SPH_ERR_ARG);
  assert_null(series);
  check_status(sph_series_create(s.ctx, "a.pvd", NULL), SPH_ERR_ARG);
  check_status(sph_series_write(NULL, s.set, 0.0, NULL), SPH_ERR_ARG);
  check_status(sph_series_write(s.series, NULL, 0.0, NULL), SPH_ERR_ARG);
  check_status(sph_series_add(NULL, 0.0, "a"), SPH_ERR_ARG);
  io_refused(&s, sph_series_add(s.series, 0.0, NULL), SPH_ERR_ARG, "NULL");
  io_refused(&s, sph_series_add(s.series, 0.0, ""), SPH_ERR_ARG, "empty");
  assert_int_equal(sph_series_count(NULL), -1);
  check_status(sph_history_create(NULL, "a", 2, io_names, &history), SPH_ERR_ARG);
  assert_null(history);
  check_status(sph_history_create(s.ctx, io_path("a"), 2, io_names, NULL), SPH_ERR_ARG);
  io_refused(&s, sph_history_create(s.ctx, NULL, 2, io_names, &history), SPH_ERR_ARG, "NULL");
  io_refused(&s, sph_history_create(s.ctx, "a", 2, NULL, &history), SPH_ERR_ARG, "names is NULL");
  check_status(sph_history_add(NULL, v), SPH_ERR_ARG);
  io_refused(&s, sph_history_add(s.history, NULL), SPH_ERR_ARG, "NULL");
  check_status(sph_history_flush(NULL), SPH_ERR_ARG);
  sph_series_destroy(NULL);
  sph_history_destroy(NULL);
  sph_output_options_init_sized(NULL, 8);
  sph_progress_line_init_sized(NULL, stderr, 8);
  assert_int_equal(sph_progress_terminal(NULL, 0.5, NULL), 0);
  assert_int_equal(io_files(""), 1); /* the history */
  io_close(&s);
}

static void test_handles(void **state) {
  (void)state;
  io_setup s = io_open(rh_context(1));
  void *other[] = {s.ctx, s.set, s.series, s.history};
  double v[2] = {0.0, 0.0};
  for (int k = 0; k < 4; k++) {
    sph_series *series;
    sph_history *history;
    void *h = other[k];
    if (h != (void *)s.ctx) {
      check_status(sph_series_create(h, "a.pvd", &series), SPH_ERR_HANDLE);
      check_status(sph_history_create(h, "a", 2, io_names, &history), SPH_ERR_HANDLE);
    }
    if (h != (void *)s.set) {
      check_status(sph_vtp_write(h, "x", NULL), SPH_ERR_HANDLE);
      check_status(sph_csv_write(h, "x", NULL), SPH_ERR_HANDLE);
      check_status(sph_series_write(s.series, h, 0.0, NULL), SPH_ERR_HANDLE);
    }
    if (h != (void *)s.series) {
      check_status(sph_series_write(h, s.set, 0.0, NULL), SPH_ERR_HANDLE);
      check_status(sph_series_add(h, 0.0, "a"), SPH_ERR_HANDLE);
      assert_int_equal(sph_series_count(h), -1);
      sph_series_destroy(h);
    }
    if (h != (void *)s.history) {
      check_status(sph_history_add(h, v), SPH_ERR_HANDLE);
      check_status(sph_history_flush(h), SPH_ERR_HANDLE);
      sph_history_destroy(h);
    }
  }
  io_close(&s);
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(test_null),
                                          cmocka_unit_test(test_handles)};
SPH_TEST_MAIN(tests)
