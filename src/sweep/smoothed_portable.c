/* Loops with two smoothing lengths a pair, for any architecture. */
#include "smoothed_rows.inc"

const sphi_smoothed_loops sphi_smoothed_portable = SMOOTHED_TABLE;
