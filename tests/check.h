/* The test harness: cmocka where it is installed, a small stand-in with the same macros where it
 * is not. */
