#!/bin/bash
# run_tests.sh ARGUMENTS PROGRAM...: run test programs, JOBS at a time, under $WRAP if set, and end
# with the sum line `N passed, N failed`. A program that crashes, hangs or prints no closing line
# counts as one more failure.
set -uo pipefail
args=$1
shift
jobs=${JOBS:-2}
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT

run_one() {
  local program=$1 log=$2 start=$SECONDS rc=0
  # shellcheck disable=SC2086
  timeout "${TIMEOUT:-600}" ${WRAP:-} "$program" $args > "$log.out" 2>&1 || rc=$?
  local line
  line=$(grep -aE '^[0-9]+ passed, [0-9]+ failed$' "$log.out" | tail -n 1)
  local passed=0 failed=0
  if [ -n "$line" ]; then
    passed=${line%% *}
    failed=${line#*, }
    failed=${failed%% *}
  fi
  local note=
  if [ "$rc" -ne 0 ] && [ "$failed" -eq 0 ]; then
    failed=1
    note=" (exit status $rc)"
  elif [ -z "$line" ]; then
    failed=1
    note=" (no closing line)"
  fi
  echo "$passed $failed" > "$log.sum"
  {
    if [ "$failed" -ne 0 ]; then
      echo "--- $program"
      cat "$log.out"
    fi
    printf '%-44s %4d passed, %d failed, %d s%s\n' "$program" "$passed" "$failed" \
      $((SECONDS - start)) "$note"
  } > "$log.text"
  cat "$log.text"
}
export -f run_one
export args

i=0
for program in "$@"; do
  i=$((i + 1))
  printf '%s\0%s\0' "$program" "$dir/$i"
done | xargs -0 -r -n 2 -P "$jobs" bash -c 'run_one "$@"' run_one

if [ $# -eq 0 ]; then
  echo 'no test programs'
  echo '0 passed, 1 failed'
  exit 1
fi
cat "$dir"/*.sum 2>/dev/null |
  awk '{ p += $1; f += $2 } END { printf "%d passed, %d failed\n", p, f; exit f > 0 }'
