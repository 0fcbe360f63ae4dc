/* Files that appear when they are complete: written under another name, then renamed. */
#define _FILE_OFFSET_BITS 64

#include "io_impl.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Keep the first failure, with the system's words for it. */
static sph_status fail(sphi_file *f, const char *what, int number) {
  char words[128];
  if (f->status != SPH_OK) return f->status;
  if (strerror_r(number, words, sizeof words) != 0) words[0] = '\0';
  f->status =
      sphi_fail(f->ctx, SPH_ERR_IO, "%s: cannot %s (%s): %s", f->call, what, words, f->path);
  return f->status;
}

/* Devices and pipes are written in place: nothing may be renamed over them. */
static int is_replaceable(sphi_file *f) {
  struct stat info;
  if (stat(f->path, &info) != 0) {
    f->created = 1; /* or it cannot be reached, which opening will say */
    return 1;
  }
  return S_ISREG(info.st_mode);
}

static sph_status name_part(sphi_file *f) {
  size_t length = strlen(f->path);
  f->part_bytes = length + sizeof ".part";
  f->part = sphi_alloc(f->ctx, f->part_bytes);
  if (f->part == NULL) return SPH_ERR_NOMEM;
  memcpy(f->part, f->path, length);
  memcpy(f->part + length, ".part", sizeof ".part");
  return SPH_OK;
}

static void forget(sphi_file *f) {
  sphi_free(f->ctx, f->part, f->part_bytes);
  sphi_free(f->ctx, f->buffer, SPHI_FILE_BUFFER);
  f->part = NULL;
  f->buffer = NULL;
}

static int open_again(const char *path) {
  int fd;
  do fd = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  while (fd < 0 && errno == EINTR);
  return fd;
}

sph_status sphi_file_open(sphi_file *f, sph_context *ctx, const char *path, int in_place,
                          const char *call) {
  memset(f, 0, sizeof *f);
  f->ctx = ctx;
  f->call = call;
  f->path = path;
  f->fd = -1;
  if (path == NULL || path[0] == '\0')
    return sphi_fail(ctx, SPH_ERR_ARG, "%s: the path is %s", call, path ? "empty" : "NULL");
  int replaceable = is_replaceable(f);
  f->buffer = sphi_alloc(ctx, SPHI_FILE_BUFFER);
  f->status = f->buffer == NULL ? SPH_ERR_NOMEM : SPH_OK;
  if (f->status == SPH_OK && replaceable && !in_place) f->status = name_part(f);
  if (f->status == SPH_OK) {
    f->fd = open_again(f->part != NULL ? f->part : path);
    if (f->fd < 0) fail(f, "open the file", errno);
  }
  if (f->status != SPH_OK) forget(f);
  return f->status;
}

/* As much as the system takes; what is left moves to the front of the buffer. */
sph_status sphi_file_flush(sphi_file *f) {
  size_t done = 0;
  int error = 0;
  if (f->status != SPH_OK) return f->status;
  while (done < f->used && error == 0) {
    ssize_t n = write(f->fd, f->buffer + done, f->used - done);
    if (n > 0)
      done += (size_t)n;
    else if (n == 0)
      error = ENOSPC;
    else if (errno != EINTR)
      error = errno;
  }
  f->used -= done;
  memmove(f->buffer, f->buffer + done, f->used);
  return error == 0 ? SPH_OK : fail(f, "write", error);
}

void sphi_file_put(sphi_file *f, const void *data, size_t bytes) {
  const char *from = data;
  while (bytes > 0 && f->status == SPH_OK) {
    size_t room = SPHI_FILE_BUFFER - f->used, now = bytes < room ? bytes : room;
    memcpy(f->buffer + f->used, from, now);
    f->used += now;
    from += now;
    bytes -= now;
    if (f->used == SPHI_FILE_BUFFER) (void)sphi_file_flush(f);
  }
}

void sphi_file_text(sphi_file *f, const char *text) { sphi_file_put(f, text, strlen(text)); }

/* Not close() again after EINTR: on Linux the descriptor is gone by then. */
static void close_descriptor(sphi_file *f) {
  int fd = f->fd;
  f->fd = -1;
  if (close(fd) != 0 && errno != EINTR) fail(f, "close the file", errno);
}

sph_status sphi_file_close(sphi_file *f, sph_status status) {
  if (status != SPH_OK && f->status == SPH_OK) f->status = status;
  if (f->fd < 0) return f->status;
  (void)sphi_file_flush(f);
  close_descriptor(f);
  if (f->part != NULL && f->status == SPH_OK && rename(f->part, f->path) != 0)
    fail(f, "rename the file that is complete", errno);
  if (f->part != NULL && f->status != SPH_OK) (void)unlink(f->part);
  forget(f);
  return f->status;
}
