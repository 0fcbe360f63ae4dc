#!/bin/bash
# Print the functions that the public headers export, sorted: every declaration that the
# preprocessor leaves with default visibility.
set -euo pipefail
cd "$(dirname "$0")/../.."
export LC_ALL=C
for header in include/sph/*.h; do
  echo "#include \"$header\""
done | ${CC:-cc} -std=c11 -Iinclude -I. -E -P -x c - | tr '\n' ' ' | tr ';' '\n' |
  grep -F 'visibility("default")' |
  sed -e 's/.*visibility("default"))) *)*//' |
  sed -nE 's/^[^(]*[ *](sph[a-z0-9_]*) *\(.*/\1/p' | sort -u
