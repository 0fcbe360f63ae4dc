#!/bin/bash
# bench_table.sh [FILE...]: the table of README's "Speed" from BENCH lines, so that no number is
# typed by hand:
#   make bench | tee bench.txt && tests/tools/bench_table.sh bench.txt
# Medians; a case that stands there more than once is taken from its first line.
cat "$@" | awk '
  function key(name) { return name in v ? v[name] : "" }
  function round(x, digits) { return x == "" ? "" : sprintf("%." digits "f", x) }
  function title(text) {
    text = key("case")
    if (key("form") == "cured") text = text ", corrected, artificial stress"
    if (key("h_ratio") != "" && key("h_ratio") != 1) text = text ", h varies " key("h_ratio") "-fold"
    if (text ~ /^step/) text = text ", " key("scheme")
    return text
  }
  function rate() { return text_is_step ? key("particle_steps_per_s") * 1e-6 : key("mpairs_per_s") }
  $1 == "BENCH" {
    delete v
    for (k = 2; k <= NF; k++) {
      at = index($k, "=")
      v[substr($k, 1, at - 1)] = substr($k, at + 1)
    }
    if (key("mpairs_per_s") == "" || key("order") == "shuffled" || key("masses_and_h") == "vary" ||
        key("parallel") == "host")
      next
    text_is_step = key("case") ~ /^step/
    if (best == "") best = key("isa") # the best instruction set is measured first
    if (key("isa") != best) next
    if (key("case") !~ /^(list|step)/ && key("scalar_mpairs_per_s") == "") next # sizes only
    id = title() "|" key("dim") "|" key("n") "|" round(key("neighbours"), 0)
    if (!(id in seen)) {
      order[++count] = id
      seen[id] = 1
      step[id] = text_is_step
    }
    threads = key("threads") == 1 ? 1 : 2
    if (!((id, threads) in speed)) speed[id, threads] = rate()
    if (scalar[id] == "") scalar[id] = key("scalar_mpairs_per_s")
    if (bytes[id] == "") bytes[id] = key("bytes_per_particle")
  }
  function head(unit) {
    print "| case | dim | particles | neighbours | plain loop | 1 thread | 2 threads | bytes a particle |"
    print "|---|---|---|---|---|---|---|---|"
  }
  function row(id, digits, part) {
    split(id, part, "|")
    printf "| %s | %s | %s | %s | %s | %s | %s | %s |\n", part[1], part[2], part[3], part[4],
           round(scalar[id], 0), round(speed[id, 1], digits), round(speed[id, 2], digits), bytes[id]
  }
  END {
    print "Million pairs a second:\n"
    head()
    for (k = 1; k <= count; k++) if (!step[order[k]]) row(order[k], 0)
    print "\nMillion particle-steps a second, whole steps:\n"
    head()
    for (k = 1; k <= count; k++) if (step[order[k]]) row(order[k], 2)
  }'
