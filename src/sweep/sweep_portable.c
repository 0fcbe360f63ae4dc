/* Row loops for any machine. */
#include "rows.inc"

#include "artificial.inc"
#include "instances.inc"

sphi_rows_fn sphi_rows_portable(sphi_spec *spec, int32_t dim) { return find_rows(spec, dim); }
const sphi_artificial_fn sphi_artificial_portable = artificial;
