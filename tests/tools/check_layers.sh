#!/bin/bash
# No file of src/ includes upward: its own folder, lower rows and public headers only. Examples and
# the tests of the public interface use public headers only.
set -uo pipefail
cd "$(dirname "$0")/../.."
bad=0
find src -name '*.[ch]' -o -name '*.inc' | sort | xargs -r awk '
  BEGIN {
    split("core|kernel material reference|particles|neighbors layout|sweep|operators boundary|rhs poisson body|" \
          "integrate adapt|scheme io halo", rows, "|")
    for (r in rows) { n = split(rows[r], names, " "); for (k = 1; k <= n; ++k) row[names[k]] = r + 0 }
  }
  function complain(text) { printf "%s:%d: %s\n", FILENAME, FNR, text; bad = 1 }
  FNR == 1 {
    split(FILENAME, part, "/")
    own = part[2]
    if (!(own in row)) complain("folder " own " has no row in the layer table")
  }
  /^[ \t]*#[ \t]*include[ \t]*"/ {
    split($0, quoted, "\"")
    path = quoted[2]
    if (path !~ /\//) next
    if (split(path, step, "/") != 3 || step[1] != "..") { complain("strange include " path); next }
    if (step[2] == own) next
    if (!(step[2] in row)) complain("unknown folder in " path)
    else if (row[step[2]] >= row[own]) complain(own " must not include " path)
  }
  END { exit bad }' || bad=1
folders=$(cd src && echo */ | tr ' ' '|')
if grep -nE "#[ \t]*include[ \t]*\"(\.\./)*(src/|$folders)" \
  -r examples tests/api tests/validation tests/bench --include="*.c" --include="*.h" 2>/dev/null; then
  echo 'only public headers are allowed here'
  bad=1
fi
[ "$bad" -eq 0 ] && echo 'check-layers: fine'
exit "$bad"
