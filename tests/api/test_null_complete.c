/* Reads the headers and the tests with NULL, test_null_*.c, and names each public function that is
 * missing in them. */
#include "check.h"

#include <ctype.h>
#include <glob.h>
#include <stdlib.h>

enum { TEXT_ROOM = 1 << 20 };

/* Append a file to a text; 0 when it cannot be read. */
static int append_file(char *text, const char *path) {
  size_t used = strlen(text);
  FILE *f = fopen(path, "rb");
  if (!f) return 0;
  size_t n = fread(text + used, 1, TEXT_ROOM - 1 - used, f);
  assert_true(n > 0 && used + n < TEXT_ROOM - 1);
  (void)fclose(f);
  return 1;
}

/* The tests of this kind, one file a subject. */
static char *read_tests(void) {
  glob_t found;
  char *text = (char *)calloc(1, TEXT_ROOM);
  assert_non_null(text);
  if (glob("tests/api/test_null_*.c", 0, NULL, &found) == 0) {
    for (size_t k = 0; k < found.gl_pathc; ++k) assert_true(append_file(text, found.gl_pathv[k]));
    globfree(&found);
  }
  return text;
}

/* The name before the first parenthesis after SPH_API; 0 at a #define. */
static int name_of(const char *declaration, char *name, size_t room) {
  size_t end = strcspn(declaration, "(;\n"), begin = end, length;
  if (declaration[end] != '(') return 0;
  while (begin > 0 &&
         (isalnum((unsigned char)declaration[begin - 1]) || declaration[begin - 1] == '_'))
    begin--;
  length = end - begin;
  if (length < 5 || length >= room || strncmp(declaration + begin, "sph_", 4) != 0) return 0;
  memcpy(name, declaration + begin, length);
  name[length] = '\0';
  return 1;
}

/* Whether a text has the name as a whole word. */
static int has_word(const char *text, const char *name) {
  size_t length = strlen(name);
  for (const char *at = strstr(text, name); at; at = strstr(at + length, name))
    if (!isalnum((unsigned char)at[length]) && at[length] != '_') return 1;
  return 0;
}

static int missing_of(const char *path, const char *tested) {
  int missing = 0;
  char name[128], *header = (char *)calloc(1, TEXT_ROOM);
  assert_non_null(header);
  assert_true(append_file(header, path));
  for (const char *at = strstr(header, "SPH_API "); at; at = strstr(at + 8, "SPH_API "))
    if (name_of(at + 8, name, sizeof name) && !has_word(tested, name)) {
      print_error("%s is not tested with NULL\n", name);
      missing++;
    }
  free(header);
  return missing;
}

/* Run from the top of the tree, as the Makefile does; elsewhere there is nothing to read. */
static void test_complete(void **state) {
  (void)state;
  glob_t headers;
  char *tested = read_tests();
  int missing = 0;
  if (!*tested || glob("include/sph/*.h", 0, NULL, &headers) != 0) {
    free(tested);
    skip();
  }
  for (size_t k = 0; k < headers.gl_pathc; ++k)
    if (!strstr(headers.gl_pathv[k], "/base.h")) missing += missing_of(headers.gl_pathv[k], tested);
  globfree(&headers);
  free(tested);
  assert_int_equal(missing, 0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_complete),
};
SPH_TEST_MAIN(tests)
