/* Output: particle files that ParaView opens, comma-separated values, a progress line.
 *
 * The library touches a file only in these calls, and only the file that the host names. Snapshots
 * (.vtp, .pvd, .csv) are written under the name with ".part" appended and renamed when they are
 * complete: a reader never sees half a file, a failed call leaves the file that was there before,
 * and no partial one. A path that is not a regular file (a device, a pipe) is written in place.
 * Files are not synced to the disk.
 *
 * Numbers in text are the shortest of 15 or 17 digits that read back to the same double, with a
 * decimal point whatever the host's locale says, and nan, inf, -inf. */
#ifndef SPH_IO_H
#define SPH_IO_H

#include <sph/base.h>
#include <sph/particles.h>

#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_series sph_series;
typedef struct sph_history sph_history;

typedef struct sph_output_options {
  size_t size;           /* set by sph_output_options_init() */
  int32_t ghosts;        /* nonzero: ghosts too, after the real particles; default 1 */
  int32_t single;        /* .vtp: nonzero writes 4-byte numbers, positions too; default 0 */
  const int32_t *fields; /* ids of the fields to write besides X; NULL (default): all that exist */
  int32_t field_count;   /* of `fields` */
  double time;           /* .vtp: written as TimeValue unless it is NaN (default) */
} sph_output_options;

/* Fill *options with the defaults. Since 0.1. */
SPH_API void sph_output_options_init_sized(sph_output_options *options, size_t size);
#define sph_output_options_init(o) sph_output_options_init_sized((o), sizeof(sph_output_options))

/* Write a set as VTK XML PolyData (.vtp): one vertex cell a particle, all arrays appended in raw
 * binary behind 64-bit sizes, in the byte order of this machine, which the file declares.
 *
 * Point arrays bear the names of the fields. Vectors are padded to 3 components and tensors to 9
 * (row-major) in 1-D and 2-D; what is padded is 0, also where the material has a stress across the
 * plane. Packed symmetric tensors are written in full. The host's own fields are written as they
 * are. With them `id` (Int64, -1 for ghosts), `role` and `phase` (Int32), unless a host's field has
 * that name.
 *
 * SPH_ERR_ARG: path NULL or empty, a field of `fields` unknown or never created (named), `fields`
 * NULL with a count, a negative count. SPH_ERR_IO: the sentence has the system's words and the
 * path. SPH_ERR_CALLBACK: the progress hook asked to stop. SPH_ERR_VERSION, SPH_ERR_NOMEM. The set
 * is not changed. O(bytes); 64 KiB of scratch, given back. Format: VTK File Formats, section "XML
 * File Formats". Since 0.1. */
SPH_API sph_status sph_vtp_write(const sph_particles *set, const char *path,
                                 const sph_output_options *options);

/* Write a set as comma-separated values with one line of names: id, role, phase, then the fields,
 * in the order of `fields` (X first). A field of several components has a column for each: vectors
 * end in _x _y _z, symmetric tensors in _xx _yy .. as they are packed, others in _0 _1 ... Names
 * with commas, quotes or line ends are quoted (RFC 4180). Lines end with a line feed.
 * Errors as sph_vtp_write(); `single` and `time` are not looked at. Since 0.1. */
SPH_API sph_status sph_csv_write(const sph_particles *set, const char *path,
                                 const sph_output_options *options);

/* A time series for ParaView: a .pvd file that lists .vtp files with their times. Nothing is
 * written yet. *out is NULL on failure. SPH_ERR_ARG: path NULL or not ending in ".pvd".
 * SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_series_create(sph_context *ctx, const char *path, sph_series **out);

/* Destroy; the files stay. NULL is allowed. Since 0.1. */
SPH_API void sph_series_destroy(sph_series *series);

/* Files listed so far; -1 for NULL. Since 0.1. */
SPH_API int64_t sph_series_count(const sph_series *series);

/* Write the set at `time` beside the .pvd, as NAME_000000.vtp, NAME_000001.vtp ... for NAME.pvd,
 * and list it. The .pvd is complete after every call; the first call replaces one that was there.
 * options: as sph_vtp_write(), its time aside; may be NULL.
 * SPH_ERR_ARG: time not finite. Otherwise as sph_vtp_write(). After a failure the file is not
 * listed, nor there. Since 0.1. */
SPH_API sph_status sph_series_write(sph_series *series, const sph_particles *set, double time,
                                    const sph_output_options *options);

/* List a file that the host wrote (or that an earlier run left), by its name relative to the .pvd.
 * The number of the next file grows too. SPH_ERR_ARG: time not finite, file NULL or empty.
 * SPH_ERR_IO, SPH_ERR_NOMEM: the series is as before. O(files). Since 0.1. */
SPH_API sph_status sph_series_add(sph_series *series, double time, const char *file);

/* A time history: rows of `columns` >= 1 numbers under a line of names, comma-separated. The file
 * is made, or emptied, at once, and holds the names. `names` is not kept. *out is NULL on failure,
 * and no file is left that was not there before.
 * SPH_ERR_ARG: path NULL or empty, columns outside 1..2048, names or one of them NULL.
 * SPH_ERR_IO, SPH_ERR_NOMEM. Since 0.1. */
SPH_API sph_status sph_history_create(sph_context *ctx, const char *path, int32_t columns,
                                      const char *const *names, sph_history **out);

/* Flush and close; what cannot be written then is lost without a word, so flush before. NULL is
 * allowed. Since 0.1. */
SPH_API void sph_history_destroy(sph_history *history);

/* Append a row: `columns` numbers, of any value. Rows collect in memory (64 KiB) and are written
 * when that is full, or by sph_history_flush(). Allocates nothing.
 * SPH_ERR_ARG: values NULL. SPH_ERR_IO: memory is full and cannot be written; the row is not taken,
 * earlier ones are kept and written by a later call when that is possible again. Since 0.1. */
SPH_API sph_status sph_history_add(sph_history *history, const double *values);

/* Write what has collected, so that other programs see it. SPH_ERR_IO as above. Since 0.1. */
SPH_API sph_status sph_history_flush(sph_history *history);

/* A progress line for a terminal, as a progress hook (context.h) or called by the host from its own
 * loop over steps:
 *
 *   sph_progress_line line;
 *   sph_progress_line_init(&line, stderr);
 *   options.progress = sph_progress_terminal;  options.progress_user = &line;    or, in a loop,
 *   sph_progress_terminal(&line, (k + 1.0) / steps, "steps");
 *
 * Nothing is shown unless the stream is a terminal and the work has gone on for `delay` seconds;
 * then at most every `interval` seconds. A fraction of 1 or more clears the line. Work begins anew
 * when `what` changes or the fraction falls; so take one line for the context and another for the
 * loop around it. */
typedef struct sph_progress_line {
  size_t size;     /* set by sph_progress_line_init() */
  FILE *file;      /* the host's stream */
  double delay;    /* seconds; default 2 */
  double interval; /* seconds; default 0.25 */
  /* The library's: */
  double begun, shown; /* monotonic seconds; shown NaN: nothing stands on the line */
  double fraction;
  char what[40];
} sph_progress_line;

/* Fill *line with the defaults. Since 0.1. */
SPH_API void sph_progress_line_init_sized(sph_progress_line *line, FILE *file, size_t size);
#define sph_progress_line_init(l, file) \
  sph_progress_line_init_sized((l), (file), sizeof(sph_progress_line))

/* The hook; `user` is a sph_progress_line. Answers 0: never stops anything. A NULL line, one whose
 * file is NULL, and a fraction that is NaN show nothing. Since 0.1. */
SPH_API int32_t sph_progress_terminal(void *user, double fraction, const char *what);

#ifdef __cplusplus
}
#endif
#endif
