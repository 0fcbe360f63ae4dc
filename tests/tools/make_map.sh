#!/bin/bash
# make_map.sh ARCHIVE MAP LIST: write the version script and the sorted symbol list from the public
# headers. Functions that are declared but not yet in the archive are left out and named, because
# the linker refuses a listed symbol that does not exist.
set -euo pipefail
cd "$(dirname "$0")/../.."
export LC_ALL=C
archive=$1 map=$2 list=$3
declared=$(tests/tools/header_symbols.sh)
defined=$(nm --defined-only "$archive" 2>/dev/null | awk '$2 == "T" { print $3 }' | sort -u)
both=$(comm -12 <(echo "$declared") <(echo "$defined"))
missing=$(comm -23 <(echo "$declared") <(echo "$defined"))
{
  echo 'SPH_0.1 {'
  echo '  global:'
  echo "$both" | sed 's/.*/    &;/'
  echo '  local:'
  echo '    *;'
  echo '};'
} > "$map.new"
if cmp -s "$map.new" "$map"; then rm "$map.new"; else mv "$map.new" "$map"; fi
[ "$list" = /dev/null ] || echo "$both" > "$list"
if [ -n "$missing" ]; then
  echo "declared but not implemented: $(echo "$missing" | wc -l)"
  [ "$list" = /dev/null ] || echo "$missing" | sed 's/^/  /'
fi
