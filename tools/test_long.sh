#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# What takes too long for tools/test.sh. Usage: tools/test_long.sh [OPTION]... [SECTION...]
#   headers    each public header is compiled alone
#   clang      Clang builds everything without a warning, and its build passes all tests under address
#              and undefined-behaviour sanitizers
#   tidy       clang-tidy finds nothing (tools/tidy.sh)
#   tsan       the tests that use threads under the thread sanitizer
#   fuzz       readers are fuzzed (tools/fuzz.sh)
#   campaigns  the recommended method stays clear in random scenarios, and other methods end
#   bench      the benchmarks build, and each row of them runs
#   package    what is installed serves a program outside the tree
#   coverage   how many lines the tests run (tools/coverage.sh), for the reader
# All sections without names, in this order.
#   --fuzz-seconds N  for each reader (30)
#   --samples N       of each campaign (20)
# Prints a line a section: pass or FAIL, its seconds, and where its log is; exit status 1 if one fails.
set -uo pipefail
cd "$(dirname "$0")/.."
sections=(headers clang tidy tsan fuzz campaigns bench package coverage)
fuzz_seconds=30 samples=20
usage() { sed -n 's/^# \?//p' "$0" | sed -n 3,18p >&2; exit "$1"; }
chosen=()
while [ $# -gt 0 ]; do
  case $1 in
    --fuzz-seconds) fuzz_seconds=${2:-}; shift ;;
    --samples) samples=${2:-}; shift ;;
    --help) usage 0 ;;
    *) [[ " ${sections[*]} " == *" $1 "* ]] || usage 64; chosen+=("$1") ;;
  esac
  shift
done
[[ $fuzz_seconds =~ ^[1-9][0-9]*$ && $samples =~ ^[1-9][0-9]*$ ]] || usage 64
[ ${#chosen[@]} -gt 0 ] || chosen=("${sections[@]}")
logs=build/test_long
mkdir -p "$logs"
jobs=$(nproc)

headers() {
  EXTRA_PACKAGES=clang tools/setup.sh clang all_verify_interface_header_sets
}

clang() {
  EXTRA_PACKAGES=clang tools/setup.sh clang
  ctest --preset clang -j "$jobs"
}

tidy() { tools/tidy.sh; }

tsan() {
  local tests=(dataflow_test simulation_test live_test record_test sweep_test)
  tools/setup.sh tsan "${tests[@]}"
  for test in "${tests[@]}"; do
    TSAN_OPTIONS="halt_on_error=1 second_deadlock_stack=1" \
      "$(find build/tsan/tests -type f -name "$test")" --gtest_brief=1
  done
}

fuzz() { tools/fuzz.sh --seconds "$fuzz_seconds"; }

campaigns() {
  tools/setup.sh release simulator
  local results
  results=$(mktemp -d)
  for family in static clutter moving; do
    build/release/tools/simulator sweep "diagrams/scenarios/random_$family.yaml" --samples "$samples" --seed 12 \
      --vary parameters.avoidance=report,safety_filter,recommended -o "$results/$family" --json --no-progress \
      > "$results/$family.json" || true  # status 3: somewhere an expectation is not met
    node -e '
      const [file, family] = process.argv.slice(1);
      for (const row of JSON.parse(require("fs").readFileSync(file)).combinations) {
        const method = row.set["parameters.avoidance"];
        console.log(family, method, `${row.clear.count} of ${row.runs} clear,`, `${row.unfinished} unfinished`);
        if (row.unfinished > 0) process.exitCode = 1;
        if (method === "recommended" && family !== "moving" && row.clear.count < row.runs) process.exitCode = 1;
      }' "$results/$family.json" "$family"
  done
  rm -rf "$results"
}

bench() {
  tools/setup.sh --packages
  cmake --preset bench
  cmake --build --preset bench --target oca_bench
  build/bench/tools/bench/oca_bench --benchmark_min_time=0.001
}

package() {
  tools/setup.sh release
  cmake -DBUILD="$PWD/build/release" -DSOURCE="$PWD" -DWORK="$PWD/build/test_long/package" -P tests/consumer/run.cmake
}

coverage() { tools/coverage.sh; }

failed=0
for section in "${chosen[@]}"; do
  start=$SECONDS
  (set -e; "$section") > "$logs/$section.log" 2>&1  # not within an `if`, where set -e is without effect
  if [ $? -eq 0 ]; then verdict=pass; else verdict=FAIL failed=1; fi
  [ $verdict = pass ] || tail -n 30 "$logs/$section.log" | sed 's/^/        /'
  printf '%s  %-9s  %5d s  %s\n' "$verdict" "$section" $((SECONDS - start)) "$logs/$section.log"
done
exit $failed
