#!/bin/bash
# check_symbols.sh LIBRARY: the exported names are those of lib/abi/symbols.txt and of the public
# headers, all start with sph_, and nothing but libc and libm is needed.
set -uo pipefail
cd "$(dirname "$0")/../.."
export LC_ALL=C
so=$1 bad=0
exported=$(nm -D --defined-only "$so" | awk '$2 != "A" { sub(/@.*/, "", $3); print $3 }' | sort -u)

compare() { # WHAT LIST
  local lost added
  lost=$(comm -13 <(echo "$exported") <(echo "$2"))
  added=$(comm -23 <(echo "$exported") <(echo "$2"))
  [ -z "$lost" ] || { echo "in $1, not exported:" $lost; bad=1; }
  [ -z "$added" ] || { echo "exported, not in $1:" $added; bad=1; }
}
compare lib/abi/symbols.txt "$(cat lib/abi/symbols.txt)"
compare 'the public headers' "$(tests/tools/header_symbols.sh)"

foreign=$(echo "$exported" | grep -v '^sph_')
[ -z "$foreign" ] || { echo "without the prefix sph_:" $foreign; bad=1; }
needed=$(readelf -d "$so" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')
other=$(echo "$needed" | grep -vE '^(libc\.so\.|libm\.so\.|ld-linux)')
[ -z "$other" ] || { echo "needs more than libc and libm:" $other; bad=1; }
[ "$bad" -eq 0 ] && echo "check-symbols: $(echo "$exported" | wc -l) symbols are fine"
exit "$bad"
