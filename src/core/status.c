/* Version, status texts and the size of packed tensors. */
#include "core_impl.h"

#define STRING(x) #x
#define EXPANDED(x) STRING(x)

const char *sph_status_text(sph_status status) {
#define STATUS_CASE(name, value, text) \
  case name:                           \
    return text;
  switch (status) { SPH_STATUS_LIST(STATUS_CASE) }
#undef STATUS_CASE
  return "unknown status";
}

const char *sph_status_name(sph_status status) {
#define STATUS_CASE(name, value, text) \
  case name:                           \
    return #name;
  switch (status) { SPH_STATUS_LIST(STATUS_CASE) }
#undef STATUS_CASE
  return "unknown";
}

const char *sph_version_string(void) {
  return EXPANDED(SPH_VERSION_MAJOR) "." EXPANDED(SPH_VERSION_MINOR) "." EXPANDED(
      SPH_VERSION_PATCH);
}

void sph_version(int32_t *major, int32_t *minor, int32_t *patch) {
  if (major) *major = SPH_VERSION_MAJOR;
  if (minor) *minor = SPH_VERSION_MINOR;
  if (patch) *patch = SPH_VERSION_PATCH;
}

int32_t sph_sym_components(int32_t dim) { return dim >= 1 && dim <= 3 ? dim * (dim + 1) / 2 : 0; }
