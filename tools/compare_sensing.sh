#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# What each method makes of things that nobody announced, seen exactly, by a camera with a tracker,
# and by a camera alone: the table of docs/explanation/unannounced.md.
# Usage: tools/compare_sensing.sh [--samples N] [--seed S] [--methods A,B] [--sensing A,B] [FAMILY...]
# Prints a row a family: of the scenarios that foresight clears, the share that is clear at every
# time. What a sweep has left in build/sensing (OUT=...) is not run again.
set -euo pipefail
cd "$(dirname "$0")/.."
samples=20 seed=3016 methods=recommended,safety_filter sensing=truth,camera,poses
families=()
while [ $# -gt 0 ]; do
  case $1 in
    --samples) samples=$2; shift 2 ;;
    --seed) seed=$2; shift 2 ;;
    --methods) methods=$2; shift 2 ;;
    --sensing) sensing=$2; shift 2 ;;
    --*) echo "compare_sensing.sh: got '$1'; expected --samples N, --seed S, --methods, --sensing or families" >&2; exit 64 ;;
    *) families+=("$1"); shift ;;
  esac
done
[ ${#families[@]} -gt 0 ] || families=(random_moving random_turning random_circling random_accelerating random_oscillating
  random_stopping random_feint random_hand random_falling random_jaws random_behind)
out=${OUT:-build/sensing}
simulator=${SIMULATOR:-build/release/tools/simulator}

# That some runs fail, miss what their file expects or find no clear motion is what it is for.
simulate() {
  local status=0
  "$simulator" "$@" || status=$?
  [ "$status" -eq 0 ] || [ "$status" -eq 3 ] || [ "$status" -eq 1 ] || exit "$status"
}

echo "| family | foresight clears | too late at first sight | $(for m in ${methods//,/ }; do for s in ${sensing//,/ }; do printf '%s, %s | ' "$m" "$s"; done; done)"
echo "|---|---|---|$(for _ in ${methods//,/ }; do for _ in ${sensing//,/ }; do printf -- '---|'; done; done)"
for family in "${families[@]}"; do
  file=diagrams/scenarios/$family.yaml folder=$out/$family
  simulate sweep "$file" --samples "$samples" --seed "$seed" -o "$folder" -j "${JOBS:-1}" \
    --vary "parameters.avoidance=$methods" --vary "parameters.sensing=$sensing" > /dev/null 2>&1
  plans=$folder/foresight.jsonl
  touch "$plans"
  for one in $(grep '"combination":0,' "$folder/results.jsonl" | sed 's/.*"seed":\([0-9]*\).*/\1/'); do
    grep -q "\"seed\":$one," "$plans" || simulate plan "$file" -s "simulator.seed=$one" >> "$plans"
  done
  awk -v family="$family" -v methods="$methods" -v sensing="$sensing" '
    function number(key) { return match($0, "\"" key "\":-?[0-9.e-]+") ? substr($0, RSTART + length(key) + 3, RLENGTH - length(key) - 3) : "" }
    function text(key) { return match($0, "\"" key "\":\"[^\"]*") ? substr($0, RSTART + length(key) + 4, RLENGTH - length(key) - 4) : "" }
    FNR == NR { ++all; clears[number("seed")] = /"clear":true/; clearable += /"clear":true/; late += /"too_late":true/; next }
    /"outcome"/ && clears[number("seed")] {
      clear = /"outcome":"finished"/ && (/"min_distance":null/ || number("certified_min_distance") + 0 > 0)
      both[text("parameters.avoidance"), text("parameters.sensing")] += clear
    }
    END {
      printf "| `%s` | %d of %d | %d |", family, clearable, all, late
      n = split(methods, m, ","); k = split(sensing, s, ",")
      for (i = 1; i <= n; i++) for (j = 1; j <= k; j++) printf " %.0f %% |", clearable ? 100 * both[m[i], s[j]] / clearable : 0
      printf "\n"
    }' "$plans" "$folder/results.jsonl"
done
