/* Text in files: numbers that read back the same in every locale, XML and comma-separated cells. */
#include "io_impl.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int is_number_character(char c) {
  return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == 'e';
}

/* What the locale wrote for the decimal point, of any length, becomes a point. */
static size_t mend_point(char *text) {
  size_t to = 0;
  for (size_t from = 0; text[from] != '\0'; ++from) {
    if (is_number_character(text[from]))
      text[to++] = text[from];
    else if (to > 0 && text[to - 1] != '.')
      text[to++] = '.';
  }
  text[to] = '\0';
  return to;
}

size_t sphi_number(char text[SPHI_NUMBER_TEXT], double value) {
  if (!isfinite(value)) {
    strcpy(text, isnan(value) ? "nan" : value > 0.0 ? "inf" : "-inf");
    return strlen(text);
  }
  (void)snprintf(text, SPHI_NUMBER_TEXT, "%.15g", value);
  if (strtod(text, NULL) != value) (void)snprintf(text, SPHI_NUMBER_TEXT, "%.17g", value);
  return mend_point(text);
}

void sphi_file_number(sphi_file *f, double value) {
  char text[SPHI_NUMBER_TEXT];
  sphi_file_put(f, text, sphi_number(text, value));
}

void sphi_file_integer(sphi_file *f, int64_t value) {
  char text[SPHI_NUMBER_TEXT];
  (void)snprintf(text, sizeof text, "%lld", (long long)value);
  sphi_file_text(f, text);
}

static void put_escaped(sphi_file *f, char c) {
  switch (c) {
  case '&':
    sphi_file_text(f, "&amp;");
    return;
  case '<':
    sphi_file_text(f, "&lt;");
    return;
  case '>':
    sphi_file_text(f, "&gt;");
    return;
  case '"':
    sphi_file_text(f, "&quot;");
    return;
  default:
    if (c == 127 || (c >= 0 && c < 32)) c = '_'; /* control characters; char may be signed */
    sphi_file_put(f, &c, 1);
  }
}

void sphi_file_attribute(sphi_file *f, const char *name, const char *value) {
  sphi_file_text(f, " ");
  sphi_file_text(f, name);
  sphi_file_text(f, "=\"");
  for (; *value != '\0'; ++value) put_escaped(f, *value);
  sphi_file_text(f, "\"");
}

void sphi_file_cell(sphi_file *f, const char *text) {
  int quoted = strpbrk(text, ",\"\r\n") != NULL;
  if (quoted) sphi_file_text(f, "\"");
  for (; *text != '\0'; ++text) {
    if (*text == '"') sphi_file_text(f, "\"");
    sphi_file_put(f, text, 1);
  }
  if (quoted) sphi_file_text(f, "\"");
}
