/* Text of files: what a locale makes of a decimal point, and the round trip of numbers. */
#include "check.h"

#include <locale.h>
#include <stdlib.h>

#include "../../src/io/text.c"

/* The source itself is taken in, for no locale with another point need be installed. */
static void test_points_of_locales(void **state) {
  (void)state;
  static const struct {
    const char *before, *after;
  } cases[] = {{"0.1", "0.1"},
               {"0,1", "0.1"},
               {"-1,5e-300", "-1.5e-300"},
               {"3\xd9\xab"
                "25",
                "3.25"}, /* U+066B, two bytes */
               {"1e+22", "1e+22"},
               {"7", "7"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    char text[SPHI_NUMBER_TEXT];
    strcpy(text, cases[k].before);
    assert_int_equal(mend_point(text), strlen(cases[k].after));
    assert_string_equal(text, cases[k].after);
  }
}

/* In every locale that is installed here; the reader is that of C. */
static void test_round_trip(void **state) {
  (void)state;
  static const char *const locales[] = {"C", "", "de_DE.UTF-8", "de_DE", "fr_FR.UTF-8", "ar_EG"};
  uint64_t bits = 1;
  for (size_t l = 0; l < sizeof locales / sizeof *locales; l++) {
    if (!setlocale(LC_ALL, locales[l])) continue;
    for (int k = 0; k < 20000; k++) {
      char text[SPHI_NUMBER_TEXT];
      double value, back;
      bits = bits * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
      memcpy(&value, &bits, sizeof value);
      size_t length = sphi_number(text, value);
      assert_true(length < 26 && strlen(text) == length);
      setlocale(LC_NUMERIC, "C");
      back = strtod(text, NULL);
      setlocale(LC_NUMERIC, locales[l]);
      assert_true(back == value || (isnan(back) && isnan(value)));
    }
  }
  setlocale(LC_ALL, "C");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_points_of_locales),
    cmocka_unit_test(test_round_trip),
};
SPH_TEST_MAIN(tests)
