#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The engine's benchmarks beside those of an older commit, both built here and run in turn: the worst ratio of
# least times, over rows that both have. Usage: engine_before.sh COMMIT
set -euo pipefail
before=build/before
[ -d "$before" ] || git clone -q . "$before"
git -C "$before" checkout -q "$1"
build() { # SOURCE
  (cd "$1" && cmake --preset release -DOCA_BENCHMARKS=ON > /dev/null && cmake --build --preset release --target oca_bench) \
    > "$OCA_WORK/before.log" 2>&1 || { tail -5 "$OCA_WORK/before.log" >&2; exit 1; }
}
build "$before"; build .
rm -f "$OCA_WORK"/before.*.json
for turn in 1 2 3 4 5; do
  for source in "$before" .; do
    "$source/build/release/tools/bench/oca_bench" --benchmark_filter='^engine/' --benchmark_min_time=0.05 \
      --benchmark_format=json 2>/dev/null > "$OCA_WORK/before.$([ "$source" = . ] && echo now || echo then).$turn.json"
  done
done
cmake --preset release -DOCA_BENCHMARKS=OFF > "$OCA_WORK/before.log"  # for whoever builds all there
node "$(dirname "$0")/bench_ratios.mjs" "$OCA_WORK"
