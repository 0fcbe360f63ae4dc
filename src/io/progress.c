/* A progress line on a terminal, for hosts that want one. */
#include "io_impl.h"

#include <math.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

void sph_progress_line_init_sized(sph_progress_line *line, FILE *file, size_t size) {
  sph_progress_line defaults;
  memset(&defaults, 0, sizeof defaults);
  defaults.size = sizeof defaults;
  defaults.file = file;
  defaults.delay = 2.0;
  defaults.interval = 0.25;
  defaults.shown = NAN;
  sphi_options_init(line, size, &defaults, sizeof defaults);
}

static double seconds_now(void) {
  struct timespec t;
  if (clock_gettime(CLOCK_MONOTONIC, &t) != 0) return NAN;
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void begin(sph_progress_line *line, const char *what, double now) {
  (void)snprintf(line->what, sizeof line->what, "%s", what);
  line->begun = now;
}

static int is_new_work(const sph_progress_line *line, double fraction, const char *what) {
  return line->what[0] == '\0' || fraction < line->fraction ||
         strncmp(line->what, what, sizeof line->what - 1) != 0;
}

/* To the left edge and clear: what stands there may be longer than what comes. */
static void show(sph_progress_line *line, double now) {
  double spent = now - line->begun, f = line->fraction;
  (void)fprintf(line->file, "\r\033[K%s %5.1f %%, %.0f s", line->what, 100.0 * f, spent);
  if (f > 0.0) (void)fprintf(line->file, ", about %.0f s to go", spent * (1.0 - f) / f);
  (void)fflush(line->file);
  line->shown = now;
}

static void clear(sph_progress_line *line) {
  line->what[0] = '\0';
  if (isnan(line->shown)) return;
  (void)fputs("\r\033[K", line->file);
  (void)fflush(line->file);
  line->shown = NAN;
}

int32_t sph_progress_terminal(void *user, double fraction, const char *what) {
  sph_progress_line *line = user;
  if (line == NULL || line->file == NULL || isnan(fraction) || !isatty(fileno(line->file)))
    return 0;
  double now = seconds_now();
  if (what == NULL || what[0] == '\0') what = "working";
  if (is_new_work(line, fraction, what)) begin(line, what, now);
  line->fraction = fraction;
  if (fraction >= 1.0)
    clear(line);
  else if (now - line->begun >= line->delay && !(now - line->shown < line->interval))
    show(line, now);
  return 0;
}
