/* Frozen row loops for any architecture. */
#include "frozen_rows.inc"

const sphi_frozen_loops sphi_frozen_portable = FROZEN_TABLE;
