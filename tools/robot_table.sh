#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Which arms get past a ball, clear of it and of themselves: a table robot x method for all URDF and
# xacro files below a folder. Usage: tools/robot_table.sh [--seed N] [--methods A,B,...] FOLDER
#
# The task of a robot is the first that `simulator new --tries 1` makes with this seed, whether
# anybody evades it or not; a file NAME.srdf beside a robot is its SRDF.
#
#   yes, time 1.20, 0.045 m   within 0.01 of the goal in the end and never in contact; the time to
#                             the goal as a share of that without avoidance; least distance of all,
#                             own links too
#
# The last line counts robots that arrived clear in at most twice the time, of those with a task. Exit status 0 however
# many arrive.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
simulator=${SIMULATOR:-$root/build/release/tools/simulator}
seed=1
methods=report,safety_filter,recommended
folder=
while [ $# -gt 0 ]; do
  case $1 in
    --seed) seed=$2; shift 2 ;;
    --methods) methods=$2; shift 2 ;;
    -*) echo "robot_table.sh: got '$1'; expected --seed N, --methods A,B or a folder" >&2; exit 64 ;;
    *) folder=$1; shift ;;
  esac
done
[ -d "$folder" ] || { echo "robot_table.sh: got '$folder'; expected a folder of robots" >&2; exit 64; }
[ -x "$simulator" ] || "$root/tools/setup.sh" release simulator
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
IFS=, read -ra methods <<< "$methods"

# Of the last run; nothing if it has none, or failed.
number() { sed -n "s/.*\"$1\": *\([-0-9.e]*\).*/\1/p" "$work/result" | head -n 1; }
run() { "$simulator" run "$@" --json --no-progress > "$work/result" 2> "$work/err" || true; }

printf '%-28s' robot
printf '  %-34s' "${methods[@]}"
echo
declare -A good
robots=0 without=0
while read -r robot; do
  name=$(basename "$robot")
  name=${name%%.*}
  srdf=()
  [ ! -e "${robot%.*}.srdf" ] || srdf=(--srdf "${robot%.*}.srdf")
  "$simulator" new "$robot" "${srdf[@]}" --seed "$seed" --tries 1 -o "$work/$robots" > "$work/new" 2>&1 || true
  # A robot without a task leaves no folder.
  diagram=$(find "$work/$robots" -name '*.yaml' ! -name '*_limits.yaml' 2> /dev/null | head -n 1) || true
  if [ -z "$diagram" ]; then
    without=$((without + 1))
    printf '%-28s  no task: %s\n' "$name" "$(tail -n 1 "$work/new" | head -c 150)"
    continue
  fi
  robots=$((robots + 1))
  run "$diagram" -s parameters.avoid=false
  free=$(number time_to_goal)
  printf '%-28s' "$name"
  for method in "${methods[@]}"; do
    extra=()
    [ "$method" != report ] || extra=(-s parameters.relaxation_time=0.4)
    run "$diagram" -s "parameters.avoidance=$method" "${extra[@]}"
    verdict=$(awk -v d="$(number min_distance)" -v e="$(number final_error)" -v t="$(number time_to_goal)" \
      -v free="$free" '
      BEGIN {
        if (e == "") print "no: failed"
        else if (d != "" && d + 0 <= 0) printf "no: contact, %.3f m\n", d
        else if (e > 0.01 || t == "") printf "no: %.2f off at %.3f m\n", e, d
        else if (free + 0 <= 0) printf "yes, %.3f m, never without\n", d
        else printf("yes, time %.2f, %.3f m%s\n", t / free, d, (t > 2 * free) ? ", late" : "")
      }')
    printf '  %-34s' "$verdict"
    case $verdict in *late) ;; yes*) good[$method]=$((${good[$method]:-0} + 1)) ;; esac
  done
  echo
done < <(find -L "$(cd "$folder" && pwd)" \( -name '*.urdf' -o -name '*.urdf.xacro' \) | sort)
[ "$without" -eq 0 ] || echo "$without without a task"
printf '%-28s' "of $robots"
for method in "${methods[@]}"; do
  printf '  %-34s' "$(awk -v n="${good[$method]:-0}" -v all="$robots" 'BEGIN { printf "%d, %.0f %%", n, all ? 100 * n / all : 0 }')"
done
echo
