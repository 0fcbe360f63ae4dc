#!/bin/bash
# check_headers.sh HEADER...: each public header compiles alone as C11 and as C++11.
set -uo pipefail
warn='-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -fsyntax-only -Iinclude'
bad=0
cxx=${CXX:-c++}
if ! command -v "$cxx" > /dev/null; then
  echo "$cxx is missing: install the Debian package g++"
  exit 1
fi
for header in "$@"; do
  name=${header#include/}
  # shellcheck disable=SC2086
  for mode in "${CC:-cc} -std=c11 -x c" "$cxx -std=c++11 -x c++"; do
    if ! echo "#include <$name>" | $mode $warn -; then
      echo "$name fails with: $mode"
      bad=$((bad + 1))
    fi
  done
done
[ "$bad" -eq 0 ] && echo "check-headers: $# headers are fine"
exit $((bad > 0))
