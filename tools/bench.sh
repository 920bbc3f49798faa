#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds oca_bench as users do (release, -O2) and for this very processor (bench, -O3), runs both
# and prints one table. Usage: tools/bench.sh [--quick] [REGEX]
#   --quick  one short repetition of each row, no instruction counts
#   REGEX    of rows, such as ^engine/d14; all without it
# A time is the least of three repetitions, in ns of CPU an iteration (a block where the goal says
# so; of the clock in rows with threads). A floor is the row's bare arithmetic, measured in the same
# process as the release column; the ratio is release to floor. `met` judges engine rows and ratios
# of geometry rows by the release build, others by the bench build. A second table has the peers
# (Ceres, FCL, KDL) of rows, their time over ours in the process; a third how long single ticks take.
set -euo pipefail
cd "$(dirname "$0")/.."
quick=false
[ "${1:-}" = --quick ] && quick=true && shift
if [[ "${1:-}" == -* || $# -gt 1 ]]; then
  sed -n 's/^# \?//p' "$0" | sed -n 3,11p >&2
  [ "${1:-}" = --help ] && exit 0
  exit 64
fi
filter=${1:-.}

EXTRA_PACKAGES=$($quick || echo valgrind) tools/setup.sh bench oca_bench
cmake --preset release -DOCA_BENCHMARKS=ON >/dev/null
tools/setup.sh release oca_bench

work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
goals=tools/bench/goals.csv

run() { # BUILD -> $work/BUILD: name, ns, allocations, failed; p50, p99, p99.9, max in us
  local effort=(--benchmark_repetitions=3 --benchmark_min_time=0.05)
  $quick && effort=(--benchmark_repetitions=1 --benchmark_min_time=0.02)
  "build/$1/tools/bench/oca_bench" --benchmark_filter="$filter" "${effort[@]}" \
    --benchmark_format=json 2>/dev/null >"$work/$1.json" || true
  awk -F'": ' -v OFS=';' '
    function number(text) { sub(/,$/, "", text); return text + 0 }
    function finish(  time) {
      if (name != "" && kind == "iteration") {
        if (!(name in best)) order[++count] = name
        time = name ~ /real_time/ ? real : cpu
        if (unit == "us") time *= 1e3
        if (unit == "ms") time *= 1e6
        if (unit == "s") time *= 1e9
        if (blocks != "") time = blocks
        if (!(name in best) || time < best[name]) best[name] = time
        heap[name] = allocations; bad[name] += failed
        # Of repetitions the one with the least median; its own maximum, for all are of one kind.
        if (p50 != "" && (!(name in tail) || p50 < least[name])) {
          least[name] = p50; tail[name] = p50 OFS p99 OFS p999 OFS max
        }
      }
      name = allocations = blocks = p50 = p99 = p999 = max = ""; failed = 0
    }
    /^    \{/ { finish() }
    /^      "name"/ { name = $2; gsub(/[",]|\/iterations:1"/, "", name) }
    /^      "run_type"/ { kind = $2; gsub(/[",]/, "", kind) }
    /^      "cpu_time"/ { cpu = number($2) }
    /^      "real_time"/ { real = number($2) }
    /^      "time_unit"/ { unit = $2; gsub(/[",]/, "", unit) }
    /^      "allocations"/ { allocations = number($2) }
    /^      "per_block"/ { blocks = 1e9 * number($2) }
    /^      "p50_us"/ { p50 = number($2) }
    /^      "p99_us"/ { p99 = number($2) }
    /^      "p99.9_us"/ { p999 = number($2) }
    /^      "max_us"/ { max = number($2) }
    /^      "error_occurred": true/ { failed = 1 }
    END { finish(); for (i = 1; i <= count; ++i) { n = order[i]; print n, best[n], heap[n], bad[n], tail[n] } }
  ' "$work/$1.json" >"$work/$1"
}

instructions() { # ROW -> instructions an iteration, in the release build
  valgrind --tool=callgrind --callgrind-out-file="$work/callgrind" \
    build/release/tools/bench/oca_bench --benchmark_filter="^$1\$" --benchmark_min_time=0.01 \
    >/dev/null 2>&1 || return 0
  local last
  last=$(find "$work" -name 'callgrind.*' | sort -t. -k2n | tail -1)
  [ -n "$last" ] || return 0
  awk '/^desc: Trigger: Client Request:/ { iterations = $NF } /^(totals|summary):/ { total = $2 }
       END { if (iterations > 0) printf "%.0f", total / iterations }' "$last"
  rm -f "$work"/callgrind*
}

run release
run bench
: >"$work/counts"
missing=
if ! $quick; then
  if command -v valgrind >/dev/null; then
    while IFS=';' read -r row _ _ _ _ _ _ _ counted; do
      [ "$counted" = i ] && grep -q "^$row;" "$work/release" || continue
      echo "$row;$(instructions "$row")" >>"$work/counts"
    done <"$goals"
  else
    missing="Instructions were not counted: valgrind is not installed."
  fi
fi
if [[ engine/compile =~ $filter ]]; then
  compile() { # FLAG... HEADER... -> ns of CPU
    OCA_WORK=$work tools/goals/compile.sh "$@" | awk '{ printf "%.0f", 1e9 * $1 }'
  }
  product=('"oca/framework/dataflow/diagram.h"' '"oca/framework/simulation/simulator.h"')
  echo "engine/compile;$(compile -O2 -Ibuild/bench/include "${product[@]}");;0" >>"$work/release"
  echo "engine/compile/floor;$(compile -O2 '<Eigen/Core>' '<memory>' '<string>' '<vector>');;0" \
    >>"$work/release"
  echo "engine/compile;$(compile -O3 -march=native -Ibuild/bench/include "${product[@]}");;0" >>"$work/bench"
fi

echo "$(date +%F), $(awk -F': ' '/^model name/ { print $2; exit }' /proc/cpuinfo), $(nproc) cores, \
load $(cut -d' ' -f1 /proc/loadavg), $(c++ --version | head -1)"
echo
awk -F';' '
  function show(ns) {
    if (ns == "") return "-"
    if (ns >= 1e8) return sprintf("%.2f s", ns / 1e9)
    if (ns >= 1e6) return sprintf("%.2f ms", ns / 1e6)
    if (ns >= 1e5) return sprintf("%.0f us", ns / 1e3)
    return sprintf(ns < 100 ? "%.1f" : "%.0f", ns)
  }
  function or_dash(text) { return text == "" ? "-" : text }
  # Adds what a line of the table asks of a row: a bound, of its time or beside that of another row.
  function ask(row, operation, other, bound, unit,  text, word) {
    split(bound, word, " ")
    ++asked[row]; first[row, asked[row]] = operation; second[row, asked[row]] = other
    limit[row, asked[row]] = word[2] * (operation == "" && unit == "s" ? 1e9 : 1)
    if (operation == "") text = word[1] " " show(limit[row, asked[row]])
    else if (operation == "/") text = bound " x " (index(other, row "/") == 1 ? substr(other, length(row) + 2) : other)
    else text = word[1] " " other " + " word[2]
    goal[row] = goal[row] (goal[row] == "" ? "" : ", ") text
  }
  function verdict(row,  i, as_users, value, other, said) {
    for (i = 1; i <= asked[row]; ++i) {
      as_users = row ~ /^engine\// || row ~ /^geometry\// && first[row, i] == "/"
      value = as_users ? release[row] : bench[row]
      other = as_users ? release[second[row, i]] : bench[second[row, i]]
      if (value == "" || first[row, i] != "" && other == "") continue
      if (first[row, i] == "/") { if (value / other > limit[row, i]) return "missed" }
      else if (value - other > limit[row, i]) return "missed"
      said = "yes"
    }
    return said == "" ? "-" : said
  }
  FILENAME ~ /goals.csv$/ {
    if (/^#/ || split($1, word, " ") == 2) next
    if ($3 ~ /^<=/) ask(word[1], word[2], word[3], $3, $4)
    if ($8 != "") drake[word[1]] = $8
    next
  }
  FILENAME ~ /bench$/ { bench[$1] = $2; if ($5 != "") tail[$1] = $0; next }
  FILENAME ~ /counts$/ { count[$1] = $2; next }
  { if (!($1 in release)) order[++rows] = $1; release[$1] = $2; heap[$1] = $3; bad[$1] = $4 }
  END {
    line = "| %-44s | %-23s | %-20s | %8s | %8s | %-6s | %8s | %5s | %11s | %12s |\n"
    printf line, "row", "goal", "Drake v1.40", "release", "bench", "met", "floor", "ratio",
           "allocations", "instructions"
    printf line, "---", "---", "---", "--:", "--:", "---", "--:", "--:", "--:", "--:"
    for (i = 1; i <= rows; ++i) {
      row = order[i]
      if (row ~ /\/(floor|fcl|kdl|fcl_kdl|fcl_kdl_cull)$/) continue
      floor = release[row "/floor"]
      if (floor == "") { parent = row; sub(/\/[^\/]*$/, "", parent); floor = release[parent "/floor"] }
      printf line, row, or_dash(goal[row]), or_dash(drake[row]),
             (bad[row] ? "failed" : show(release[row])), show(bench[row]), verdict(row),
             show(floor), ((floor > 0) ? sprintf("%.1f", release[row] / floor) : "-"),
             (heap[row] == "" ? "-" : sprintf("%.3g", (heap[row] < 1e-3) ? 0 : heap[row])),
             or_dash(count[row])
    }
    line = "| %-44s | %8s | %8s | %8s | %9s |\n"
    for (i = 1; i <= rows; ++i) {
      row = order[i]; peer = row; sub(/.*\//, "", peer)
      own = peer; if (peer !~ /^(ceres|fcl|kdl|fcl_kdl|fcl_kdl_cull)$/) continue
      own = substr(row, 1, length(row) - length(peer) - 1)
      if (!(bench[own] > 0) && !(release[own] > 0)) continue
      if (!peers++) {
        printf "\n" line, "peer", "release", "to ours", "bench", "to ours"
        printf line, "---", "--:", "--:", "--:", "--:"
      }
      printf line, row, show(release[row]),
             ((release[own] > 0) ? sprintf("%.1f", release[row] / release[own]) : "-"),
             show(bench[row]), ((bench[own] > 0) ? sprintf("%.1f", bench[row] / bench[own]) : "-")
    }
    line = "| %-44s | %8s | %8s | %8s | %8s |\n"
    for (i = 1; i <= rows; ++i) {
      row = order[i]
      if (!(row in tail)) continue
      if (!tails++) {
        printf "\n" line, "bench build, us", "p50", "p99", "p99.9", "max"
        printf line, "---", "--:", "--:", "--:", "--:"
      }
      split(tail[row], part, ";")
      printf line, row, sprintf("%.1f", part[5]), sprintf("%.1f", part[6]),
             (part[7] == "" ? "-" : sprintf("%.1f", part[7])), sprintf("%.0f", part[8])
    }
  }
' "$goals" "$work/bench" "$work/counts" "$work/release"
[ -z "$missing" ] || { echo; echo "$missing"; }
