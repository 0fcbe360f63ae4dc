#!/bin/bash
# check_readme.sh PROGRAM: the first C program in README.md is examples/first_steps.c to the letter,
# PROGRAM (built from it) prints the line that the README quotes, and what the README links to is
# there.
set -uo pipefail
cd "$(dirname "$0")/../.."
bad=0
awk '/^```/ { if (inside) exit; inside = $0 == "```c"; next } inside' README.md |
  diff - examples/first_steps.c || { echo 'README.md and examples/first_steps.c differ'; bad=1; }
line=$("$1") || { echo "$1 failed: $line"; bad=1; }
grep -qFx -- "$line" README.md || { echo "not in README.md: $line"; bad=1; }
for path in $(grep -oE '\]\([^)#]+' README.md | cut -c 3- | grep -v '://'); do
  [ -e "$path" ] || { echo "README.md links to $path, which does not exist"; bad=1; }
done
[ "$bad" -eq 0 ] && echo 'check-readme: fine'
exit "$bad"
