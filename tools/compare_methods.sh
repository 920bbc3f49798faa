#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs every method of avoidance on the same random scenarios and writes tables and plots of
# docs/explanation/methods.md. Usage: tools/compare_methods.sh [--samples N] [--seed S] [FAMILY...]
# Without options: the samples and the seed that the page states, all families. What a sweep has
# left in build/methods is not run again; other numbers need a folder of their own (OUT=...).
# FORESIGHT=N: so many moving scenarios are also given to an optimiser that knows the whole script.
set -euo pipefail
cd "$(dirname "$0")/.."
declare -A samples=([random_static]=1000 [random_clutter]=300 [random_moving]=200)
seed=2016
families=()
while [ $# -gt 0 ]; do
  case $1 in
    --samples) for family in "${!samples[@]}"; do samples[$family]=$2; done; shift 2 ;;
    --seed) seed=$2; shift 2 ;;
    --*) echo "compare_methods.sh: got '$1'; expected --samples N, --seed S or families" >&2; exit 64 ;;
    *) families+=("$1"); shift ;;
  esac
done
[ ${#families[@]} -gt 0 ] || families=(random_static random_clutter random_moving)
out=${OUT:-build/methods}
page=docs/explanation/methods.md
simulator=build/release/tools/simulator
[ -x "$simulator" ] || tools/setup.sh release simulator

# The part of the page between <!-- NAME --> and <!-- end --> becomes standard input.
splice() {
  local part
  part=$(mktemp)
  cat > "$part"
  awk -v name="<!-- $1 -->" -v part="$part" '
    $0 == name { print; while ((getline line < part) > 0) print line; skip = 1 }
    $0 == "<!-- end -->" { skip = 0 }
    !skip && $0 != name' "$page" > "$page.new"
  mv "$page.new" "$page"
  rm "$part"
}

# That some runs fail, miss what their file expects or find no clear motion (exit status 1, 3) is
# what it is for.
simulate() {
  local status=0
  "$simulator" "$@" || status=$?
  [ "$status" -eq 0 ] || [ "$status" -eq 3 ] || [ "$status" -eq 1 ] || exit "$status"
}

# Which of the first scenarios of a family foresight clears, and which of those each method does.
foresight() {
  local results=$out/$1/results.jsonl plans=$out/$1/foresight.jsonl seed
  touch "$plans"
  for seed in $(grep '"combination":0,' "$results" | head -n "$2" | sed 's/.*"seed":\([0-9]*\).*/\1/'); do
    grep -q "\"seed\":$seed," "$plans" || simulate plan "diagrams/scenarios/$1.yaml" -s "simulator.seed=$seed" -s parameters.avoidance=recommended >> "$plans"
  done
  awk '
    function number(key) { return match($0, "\"" key "\":-?[0-9.e-]+") ? substr($0, RSTART + length(key) + 3, RLENGTH - length(key) - 3) : "" }
    FNR == NR { all++; seed[number("seed")] = /"clear":true/; clearable += /"clear":true/; next }
    /"outcome"/ && number("seed") in seed {
      name = $0; sub(/.*"parameters.avoidance":"/, "", name); sub(/".*/, "", name)
      if (!(name in known)) { known[name] = 1; order[++methods] = name }
      clear = /"outcome":"finished"/ && (/"min_distance":null/ || number("min_distance") + 0 > 0)
      if (seed[number("seed")]) of_clearable[name] += clear; else others[name] += clear
    }
    END {
      printf "Foresight clears %d of the first %d scenarios.\n\n| method | of those, free of contact | of the other %d |\n|---|---|---|\n", clearable, all, all - clearable
      for (i = 1; i <= methods; i++) printf "| %s | %d of %d | %d |\n", order[i], of_clearable[order[i]], clearable, others[order[i]]
    }' "$plans" "$results"
}

methods=$(cd diagrams/parts && ls avoidance_*.yaml | sed 's/avoidance_\(.*\)\.yaml/\1/' | paste -sd,)
for family in "${families[@]}"; do
  file=diagrams/scenarios/$family.yaml
  echo "$family: ${samples[$family]} scenarios, seed $seed, methods $methods" >&2
  simulate sweep "$file" --samples "${samples[$family]}" --seed "$seed" -o "$out/$family" \
    --vary "parameters.avoidance=$methods" > /dev/null
  simulate merge "$out/$family" --markdown | splice "$family"
  "$simulator" plot --figure method-comparison "$out/$family" -o "docs/pictures/methods-$family.svg"
  [ "$family" != random_moving ] || foresight "$family" "${FORESIGHT:-200}" | splice foresight
  [ "$family" = random_static ] || continue
  simulate sweep "$file" --samples "${samples[$family]}" --seed "$seed" -o "$out/mapping" \
    -s parameters.avoidance=report \
    --vary parameters.jacobian_transpose_method_classic=false,true > /dev/null
  simulate merge "$out/mapping" --markdown | splice mapping
done
