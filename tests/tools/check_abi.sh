#!/bin/bash
# check_abi.sh check|record LIBRARY: compare the library with the recorded ABI, or record it.
# The baseline of a release is lib/abi/libsph-VERSION.abi with its headers in lib/abi/include/.
set -uo pipefail
cd "$(dirname "$0")/../.."
mode=$1 so=$2
# Without debug information abidiff sees no types and passes everything.
if ! readelf -S "$so" | grep -q '\.debug_info'; then
  echo "$so has no debug information: build with -g"
  exit 1
fi
version=$(awk '/define SPH_VERSION_(MAJOR|MINOR|PATCH) / { v = v (v == "" ? "" : ".") $3 } END { print v }' \
  include/sph/base.h)

if [ "$mode" = record ]; then
  rm -rf lib/abi/include lib/abi/libsph-*.abi
  mkdir -p lib/abi/include
  cp -r include/sph lib/abi/include/
  abidw --no-corpus-path --no-comp-dir-path --headers-dir include \
    --out-file "lib/abi/libsph-$version.abi" "$so" || exit 1
  echo "recorded lib/abi/libsph-$version.abi"
  exit 0
fi

baseline=$(ls lib/abi/libsph-*.abi 2>/dev/null | tail -n 1)
if [ -z "$baseline" ]; then
  echo 'no baseline is recorded yet: make record-abi'
  exit 0
fi
abidiff --no-added-syms --headers-dir1 lib/abi/include --headers-dir2 include \
  --suppressions lib/abi/abi.supp "$baseline" "$so" || exit 1
echo "check-abi: compatible with $(basename "$baseline")"
