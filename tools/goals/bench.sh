#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Rows of oca_bench: least CPU ns of three repetitions (a block where the goal says so; of the clock in rows with
# threads), engine and file rows and ratios of geometry rows in the release build, others in that for this processor.
# Usage: bench.sh ROW | ROW:COUNTER... (their sum) | ROW / ROW | ROW - ROW
set -euo pipefail
row=$1
build=bench
[[ $row == engine/* || $row == files/* || ($row == geometry/* && ${2:-} == /) ]] && build=release
results=$OCA_WORK/$build.json
if [ ! -s "$results" ]; then  # all rows at once, for the rows to come
  { cmake --preset "$build" -DOCA_BENCHMARKS=ON && cmake --build --preset "$build" --target oca_bench; } \
    > "$OCA_WORK/bench.log" 2>&1 || { tail -5 "$OCA_WORK/bench.log" >&2; exit 1; }
  "build/$build/tools/bench/oca_bench" --benchmark_filter="${OCA_BENCH_FILTER:-.}" --benchmark_repetitions=3 \
    --benchmark_min_time=0.05 --benchmark_format=json > "$results.part" 2>/dev/null
  mv "$results.part" "$results"
  if [ "$build" = release ]; then  # for whoever builds all there
    cmake --preset release -DOCA_BENCHMARKS=OFF > "$OCA_WORK/bench.log" 2>&1
  fi
fi
exec node "$(dirname "$0")/bench_row.mjs" "$results" "$@"
