/* What the output files share: a file that appears when it is complete, and text. */
#ifndef SPHI_IO_IMPL_H
#define SPHI_IO_IMPL_H

#include "../particles/particles_impl.h"

#include <sph/io.h>

enum { SPHI_FILE_BUFFER = 1 << 16, SPHI_NUMBER_TEXT = 40 };

/* ---- file.c ------------------------------------------------------------------------------ */

/* A file being written. After a first failure writing does nothing, and closing reports it. */
typedef struct sphi_file {
  sph_context *ctx;
  const char *call; /* for sentences */
  const char *path; /* the caller's */
  char *part;       /* name until the file is complete; NULL: written in place */
  size_t part_bytes;
  int fd;      /* -1: closed */
  int created; /* there was no file of that name before */
  char *buffer;
  size_t used;
  sph_status status;
} sphi_file;

/* in_place: without the temporary name. SPH_ERR_ARG: path NULL or empty. */
sph_status sphi_file_open(sphi_file *f, sph_context *ctx, const char *path, int in_place,
                          const char *call);
void sphi_file_put(sphi_file *f, const void *data, size_t bytes);
void sphi_file_text(sphi_file *f, const char *text);
/* Whole buffer to the system. What was not written stays in the buffer. */
sph_status sphi_file_flush(sphi_file *f);
/* Complete the file, or remove it when `status` or one before is a failure, which is answered. */
sph_status sphi_file_close(sphi_file *f, sph_status status);

/* ---- text.c ------------------------------------------------------------------------------ */

/* A number that reads back the same; returns its length. */
size_t sphi_number(char text[SPHI_NUMBER_TEXT], double value);
/* An attribute of XML, quoted; characters that XML cannot hold become '_'. */
void sphi_file_attribute(sphi_file *f, const char *name, const char *value);
/* A cell of comma-separated values, quoted where needed; returns its length, writes when f is not
 * NULL. */
void sphi_file_cell(sphi_file *f, const char *text);
void sphi_file_number(sphi_file *f, double value);
void sphi_file_integer(sphi_file *f, int64_t value);

/* ---- select.c ---------------------------------------------------------------------------- */

/* What of a set is to be written. */
typedef struct sphi_selection {
  const sph_particles *set;
  int32_t dim;
  int64_t n;
  int32_t count;
  int32_t field[SPHI_FIELD_IDS]; /* X first */
  sph_output_options options;
} sphi_selection;

sph_status sphi_select(sphi_selection *s, const sph_particles *set,
                       const sph_output_options *options, const char *call);

#endif
