#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Whether two builds of the simulator compute the same: runs every shipped diagram, the report's test
# and three random scenarios with every method, by both, and compares all signals bit for bit, what
# is said of the motion too. For changes that must not change behaviour.
# Usage: tools/compare_traces.sh OLD_SIMULATOR NEW_SIMULATOR [TABLE [OLD_DIAGRAMS]]
#   TABLE  of signals, a line each: `OLD NEW` (renamed), `OLD -` (removed), `- NEW` (added); `*`
#          stands for any system, but in NEW of one that is renamed
#   OLD_DIAGRAMS  the folder diagrams/ of the old build, where files are written in another way, as
#          `git archive COMMIT diagrams | tar x -C FOLDER` gives it
# Prints each difference; exit status 1 if there is any.
set -euo pipefail
cd "$(dirname "$0")/.."
old=$1 new=$2 table=${3:-/dev/null} old_diagrams=${4:-diagrams}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

trace() { # SIMULATOR FOLDER FILE ARGUMENT...
  local simulator=$1 folder=$2
  shift 2
  local status=0
  "$simulator" run "$@" --no-progress --json --csv "$folder" -s 'record.signals={"*": 100}' \
    > "$folder.json" 2> "$folder.err" || status=$?
  echo "$status" > "$folder.status"
}

cases=()
for file in diagrams/*.yaml diagrams/scenarios/*.yaml diagrams/verification/*.yaml; do
  cases+=("$file --duration=8")
done
for method in diagrams/parts/avoidance_*.yaml; do
  method=$(basename "$method" .yaml)
  for scenario in static_test scenarios/random_static scenarios/random_clutter scenarios/random_moving; do
    cases+=("diagrams/$scenario.yaml --duration=6 -s parameters.avoidance=${method#avoidance_} --seed=4711")
  done
done

different=0
for case in "${cases[@]}"; do
  read -ra words <<< "$case"
  rm -rf "$work"/{old,new}*
  mkdir "$work/old" "$work/new"
  trace "$old" "$work/old" "$old_diagrams/${words[0]#diagrams/}" "${words[@]:1}" &
  trace "$new" "$work/new" "${words[@]}"
  wait
  awk '{ print $1, $2 }' "$table" | while read -r from to; do
    if [ "$from" = - ]; then
      for path in "$work/new/"*.*; do
        name=$(basename "${path%.*}")
        if [[ $name == $to ]]; then rm "$path"; fi
      done
      continue
    fi
    for path in "$work/old/"*.*; do
      name=$(basename "${path%.*}")
      [[ $name == $from ]] || continue
      if [ "$to" = - ]; then rm "$path"; else mv "$path" "$work/old/$to.${path##*.}"; fi
    done
  done
  node -e '
    const [old, now] = process.argv.slice(1).map((file) => {
      const text = require("fs").readFileSync(file, "utf8");
      if (!text.startsWith("{")) return text;
      const all = JSON.parse(text);
      // Names of expectations change with those of signals, and their order with that.
      all.expectations = (all.expectations ?? []).map(({ name, ...rest }) => JSON.stringify(rest)).sort();
      for (const key of ["file", "statistics", "wall_seconds", "realtime_factor", "profile", "steps", "evaluations"]) delete all[key];
      return JSON.stringify(all);
    });
    if (old !== now) { console.log(old.slice(0, 2000)); console.log(now.slice(0, 2000)); process.exit(1); }
  ' "$work/old.json" "$work/new.json" > "$work/said" || { echo "$case: another summary"; cat "$work/said"; different=1; }
  cmp -s "$work/old.status" "$work/new.status" ||
    { echo "$case: exit status $(cat "$work/old.status"), now $(cat "$work/new.status")"; different=1; }
  # Both trees have their own copies of what came with them.
  sed -i -E 's|"file":"[^"]*/(models/)|"file":"\1|g' "$work"/{old,new}/*.jsonl 2> /dev/null || true
  diff -rq "$work/old" "$work/new" > "$work/difference" || { sed "s|$work/||g; s|^|$case: |" "$work/difference"; different=1; }
  echo "$case: $(ls "$work/new" | wc -l) signals"
done
exit "$different"
