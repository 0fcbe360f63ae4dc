#!/bin/bash
# run_validation.sh ARGUMENT FOLDER PROGRAM...: run validation cases, JOBS (at most 2) at a time,
# keep their output in FOLDER, print the table published | measured | verdict of their RESULT lines
# and end with `N passed, N failed`. A case that crashes or prints no RESULT is a failure, and so is
# a second line with the same case, quantity and keys; a line with verdict=report is neither.
set -uo pipefail
argument=$1 dir=$2
shift 2
if [ $# -eq 0 ]; then
  echo 'no such case'
  echo '0 passed, 1 failed'
  exit 1
fi
jobs=${JOBS:-2}
[ "$jobs" -gt 2 ] && jobs=2
mkdir -p "$dir"

run_one() {
  local program=$1 argument=$2 dir=$3 name start=$SECONDS rc=0
  name=$(basename "$program")
  timeout "${TIMEOUT:-3600}" "$program" "$argument" > "$dir/$name.out" 2> "$dir/$name.err" || rc=$?
  echo "$rc" > "$dir/$name.rc"
  echo "ran $name in $((SECONDS - start)) s"
}
export -f run_one
for program in "$@"; do
  printf '%s\0%s\0%s\0' "$program" "$argument" "$dir"
done | xargs -0 -r -n 3 -P "$jobs" bash -c 'run_one "$@"' run_one
echo

files=()
broken=0
for program in "$@"; do
  name=$(basename "$program")
  rc=$(cat "$dir/$name.rc" 2>/dev/null || echo none)
  failing=$(grep -ac '^RESULT .*verdict=fail' "$dir/$name.out")
  # A case may exit nonzero because an entry fails; that is counted once, as the entry.
  if ! grep -aq '^RESULT ' "$dir/$name.out"; then
    echo "$name printed no RESULT (exit status $rc)"
    broken=$((broken + 1))
  elif [ "$rc" != 0 ] && { [ "$failing" -eq 0 ] || [ "$rc" -ge 124 ]; }; then
    echo "$name ended with exit status $rc"
    broken=$((broken + 1))
  else
    files+=("$dir/$name.out")
    continue
  fi
  tail -n 5 "$dir/$name.out" "$dir/$name.err"
  files+=("$dir/$name.out")
done

cat "${files[@]}" | grep -a '^RESULT ' | awk -v broken="$broken" '
  # Split at blanks, but not inside quotes.
  function parse(line,    n, c, i, quoted, word) {
    split("", value); order = ""; quoted = 0; word = ""
    line = substr(line, 8) " "
    n = length(line)
    for (i = 1; i <= n; ++i) {
      c = substr(line, i, 1)
      if (c == "\"") { quoted = !quoted; continue }
      if (c != " " || quoted) { word = word c; continue }
      if (word != "") take(word)
      word = ""
    }
  }
  function take(word,    at, key) {
    at = index(word, "=")
    if (at == 0) return
    key = substr(word, 1, at - 1)
    value[key] = substr(word, at + 1)
    if (key !~ /^(case|measured|reference|source|tolerance|verdict|reason)$/)
      order = order (order == "" ? "" : " ") (key == "quantity" ? value[key] : word)
  }
  BEGIN { printf "%-22s %-58s | %14s | %14s | %s\n", "case", "entry", "published", "measured", "verdict" }
  {
    parse($0)
    if (seen[value["case"] " " order]++) value["verdict"] = "keys of an entry above"
    if (value["verdict"] == "pass") ++passed
    else if (value["verdict"] != "report") { ++failed; value["verdict"] = "FAIL (" value["verdict"] ")" }
    else ++reported
    printf "%-22s %-58s | %14s | %14s | %s%s\n", value["case"], order, value["reference"],
      value["measured"], value["verdict"], value["reason"] == "" ? "" : ": " value["reason"]
  }
  END {
    if (reported) printf "%d entries only reported\n", reported
    printf "%d passed, %d failed\n", passed, failed + broken
    exit failed + broken > 0
  }'
