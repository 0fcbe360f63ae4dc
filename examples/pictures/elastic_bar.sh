#!/bin/sh
# elastic_bar.sh FOLDER: the velocity profiles that the example elastic_bar wrote to FOLDER (make
# demo: build/demo), as an SVG picture on the standard output.
set -eu
dir=${1:-build/demo}
awk -F, '
  function px(x) { return 70 + 620 * x }
  function py(v) { return 290 - 230 * v }
  function text(x, y, anchor, s) {
    printf "<text x=\"%g\" y=\"%g\" text-anchor=\"%s\">%s</text>\n", x, y, anchor, s
  }
  function line(x1, y1, x2, y2, style) {
    printf "<line x1=\"%g\" y1=\"%g\" x2=\"%g\" y2=\"%g\" %s/>\n", x1, y1, x2, y2, style
  }
  function curve(points, k) {
    printf "<polyline fill=\"none\" %s points=\"%s\"/>\n", style[k], points
  }
  FNR == 1 { ++file; next }
  {
    if (file == 1) exact = exact sprintf("%.1f,%.1f ", px($1), py($3))
    run[file] = run[file] sprintf("%.1f,%.1f ", px($1), py($2))
  }
  END {
    style[0] = "stroke=\"#000\" stroke-width=\"1\""
    style[1] = "stroke=\"#0072b2\" stroke-width=\"2\""
    style[2] = "stroke=\"#e69f00\" stroke-width=\"2\" stroke-dasharray=\"6 5\""
    style[3] = "stroke=\"#009e73\" stroke-width=\"2\""
    name[0] = "exact"
    name[1] = "RKC, CFL 2.5"
    name[2] = "RK4, CFL 0.6"
    name[3] = "RKC, CFL 1.2, viscosity 0.5"
    print "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 720 350\"" \
          " font-family=\"sans-serif\" font-size=\"13\">"
    print "<rect width=\"720\" height=\"350\" fill=\"#fff\"/>"
    grid = "stroke=\"#ddd\""
    for (k = 0; k <= 5; ++k) {
      line(px(k / 5), py(1.1), px(k / 5), py(-0.05), grid)
      text(px(k / 5), py(-0.05) + 18, "middle", sprintf("%.1f", k / 5))
    }
    for (k = 0; k <= 4; ++k) {
      line(px(0), py(k / 4), px(1), py(k / 4), grid)
      text(px(0) - 8, py(k / 4) + 4, "end", sprintf("%.2f", k / 4))
    }
    curve(exact, 0)
    for (k = 1; k <= file; ++k) curve(run[k], k)
    for (k = 0; k <= file; ++k) {
      line(90, 170 + 22 * k, 125, 170 + 22 * k, style[k])
      text(133, 174 + 22 * k, "start", name[k])
    }
    text(380, 341, "middle", "x / m")
    text(70, 22, "start", "velocity / (m/s) at t = 0.12 ms, 250 particles")
    print "</svg>"
  }' "$dir/rkc.csv" "$dir/rk4.csv" "$dir/rkc_sharp.csv"
