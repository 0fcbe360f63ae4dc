#!/bin/bash
# bench_instructions.sh FOLDER: instructions a pair, counted by valgrind's callgrind, which knows no
# AVX-512, so for the sets up to AVX2. FOLDER holds the benchmarks. Two runs that differ by two calls
# are subtracted, so that only the calls themselves are counted, packing included.
set -euo pipefail
folder=$1
n=8000

count() { # PROGRAM FUNCTION REPETITIONS ARGUMENT...: instructions within the function
  local program=$1 function=$2 repetitions=$3
  shift 3
  valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect="$function" \
    "$folder/$program" "$@" repetitions="$repetitions" 2>&1 |
    tee "$log" | awk '/Collected/ { print $NF }'
}

measure() { # PROGRAM FUNCTION CASE ARGUMENT...
  local program=$1 function=$2 name=$3 few many
  shift 3
  few=$(count "$program" "$function" 1 only="$name" n="$n" dim=3 bare "$@")
  many=$(count "$program" "$function" 3 only="$name" n="$n" dim=3 bare "$@")
  grep -a "BENCH case=$name" "$log" | head -n 1 | awk -v few="$few" -v many="$many" '{
    for (k = 2; k <= NF; k++) { split($k, p, "="); v[p[1]] = p[2] }
    printf "BENCH case=instructions of=%s form=%s dim=%d n=%d isa=%s instructions_per_pair=%.2f\n",
           v["case"], v["form"], v["dim"], v["n"], v["isa"],
           (many - few) / 2 / (v["n"] * v["neighbours"])
  }'
}

log=$(mktemp)
trap 'rm -f "$log"' EXIT
measure bench_rhs sph_rhs_evaluate wcsph_rhs
measure bench_rhs sph_rhs_evaluate elastic_rhs form=plain
measure bench_rhs sph_rhs_evaluate elastic_rhs form=cured
measure bench_rhs sph_density_summation density
measure bench_rhs sph_gradient gradient
measure bench_neighbors sph_neighbors_build_arrays list_cells neighbours=74
measure bench_neighbors sph_neighbors_build_arrays list_tree neighbours=74
