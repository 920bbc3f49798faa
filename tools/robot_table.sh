#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Which arms get past a box, clear of it and of themselves: a table robot x method for all URDF and
# xacro files below a folder. Usage: tools/robot_table.sh [--seed N] [--methods A,B,...] FOLDER
#
# A robot's SRDF is the file of its name beside it, else what `robot check-collisions` writes. From a
# random posture near the middle of its ranges the first joint turns by up to 2 rad and the others by
# up to 0.4; nothing but the arm itself is certain to be clear of that. A random box stands in the way
# (section `sampling` of a diagram file), with 0.15 of the reach between it and both ends, which is
# what the fields of `report` reach. Sliders of less than 0.2 m, fingers, stay where they are.
#
#   arrived   within 0.01 of the goal in the end, never in contact: yes, or what went wrong
#   time      to the goal, as a share of the time without avoidance
#
# The last line counts robots that arrived clear in at most twice the time, of all that could be
# drawn. ROBOT_TABLE_KEEP=DIR keeps the diagram files. Exit status 0 however many arrive.
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
work=${ROBOT_TABLE_KEEP:-$(mktemp -d)}
mkdir -p "$work"
[ -n "${ROBOT_TABLE_KEEP:-}" ] || trap 'rm -rf "$work"' EXIT
IFS=, read -ra methods <<< "$methods"

# A line a joint that a position belongs to: type, lower and upper limit; last the reach, m.
joints() {
  tr '\n' ' ' < "$1" | sed 's/<!--/\n<!--/g; s/-->/-->\n/g' | grep -v '^<!--' | tr '\n' ' ' | sed 's/<joint/\n<joint/g; s/<\/joint>/\n/g' | awk '
    function attribute(name, otherwise) {
      return match($0, "[ \"]" name " *= *\"[^\"]*\"") ? gensub_(substr($0, RSTART, RLENGTH)) : otherwise
    }
    function gensub_(text) { sub(/^[^=]*= *"/, "", text); sub(/"$/, "", text); return text }
    /^<joint/ && / type *=/ {
      type = attribute("type", "")
      if (match($0, /xyz *= *"[^"]*"/)) {
        split(gensub_(substr($0, RSTART, RLENGTH)), at, " ")
        if ($0 ~ /<origin[^>]*xyz/) reach += sqrt(at[1] ^ 2 + at[2] ^ 2 + at[3] ^ 2)
      }
      if (type !~ /^(revolute|continuous|prismatic)$/ || /<mimic/) next
      limits = match($0, /<limit[^>]*>/) ? substr($0, RSTART, RLENGTH) : ""
      $0 = limits
      if (type == "continuous") print type, -3.1, 3.1
      else print type, attribute("lower", 0), attribute("upper", 0)
    }
    END { print "reach", reach }'
}

# The diagram of a robot: joints on standard input, its files, a number that the postures follow from.
diagram() {
  awk -v urdf="$1" -v srdf="$2" -v draw="$3" -v root="$root" '
    # The same everywhere, unlike rand().
    function unit() { state = (state * 16807) % 2147483647; return state / 2147483647 }
    function within(x, low, high) { return x < low ? low : x > high ? high : x }
    BEGIN { state = 1 + draw * 7919; for (i = 0; i < 8; ++i) unit() }
    $1 == "reach" { reach = $2; next }
    {
      ++n
      middle = within(0, $2 + 0.3 * ($3 - $2), $3 - 0.3 * ($3 - $2))
      half = within(0.25 * ($3 - $2), 0, 0.8)
      if ($1 == "prismatic" && $3 - $2 < 0.2) { from[n] = to[n] = 0.5 * ($2 + $3); next }
      from[n] = middle + half * (2 * unit() - 1)
      way = $1 == "prismatic" ? 0.1 : first++ ? 0.4 * (2 * unit() - 1) : (1.2 + 0.8 * unit())
      if (first == 1 && $1 != "prismatic" && !turned++) from[n] = within(-0.5 * way, $2 + 0.05, $3 - 0.05)
      to[n] = within(from[n] + way, $2 + 0.05 * ($3 - $2), $3 - 0.05 * ($3 - $2))
    }
    function list(x, text, i) {
      for (i = 1; i <= n; ++i) text = text (i > 1 ? ", " : "") sprintf("%.4f", x[i])
      return "[" text "]"
    }
    END {
      print "name: robot"
      print "include: [\"" root "/diagrams/parts/avoidance.yaml\"]"
      near = 0.15 * (reach < 2 ? reach : 2)
      print "parameters: {self_collision: true}"
      print "simulator: {duration: 20, seed: " draw "}"
      print "models:\n  arm: {urdf: " urdf ", srdf: " srdf "}"
      print "systems:\n  obstacles: {type: ObstacleSource}"
      print "  spline:\n    type: SplineGenerator\n    period: ${1 / rate}\n    key_points:"
      print "      - {time: 0.5, position: " list(from) "}"
      print "      - {time: 8.5, position: " list(to) "}"
      print "  plant: {initial_position: " list(from) "}"
      print "#box sampling:\n#box   tries: 3000"
      printf "#box   obstacles: {count: [1, 1], shapes: [box], extent: [%.3f, %.3f], shell: {centre: [0, 0, %.3f], radius: [%.3f, %.3f]}}\n", 0.08 * reach, 0.16 * reach, 0.3 * reach, 0.4 * reach, 0.7 * reach
      printf "#box   accept: {home_distance: {at_least: %.3f}, goal_distance: {at_least: %.3f}, foot_distance: {at_least: %.3f}, requested_distance: {at_most: -0.01}}\n", near, near, 0.06 * reach
      printf "#reach %.3f\n", near
    }'
}

number() { grep -o "\"$1\": *[-0-9.e]*" "$2" | head -n 1 | sed 's/.*: *//'; }
run() { timeout 300 "$simulator" run "$@" --json --no-progress 2> "$work/err" > "$work/result"; }

# Draws a task for a robot into $work/NAME.yaml; false if there is none.
task() {
  local name=$1 urdf=$2 srdf=$3 try
  joints "$urdf" > "$work/joints"
  for try in $(seq 0 29); do
    diagram "$urdf" "$srdf" $((seed * 100 + try)) < "$work/joints" > "$work/$name.yaml"
    run "$work/$name.yaml" -s parameters.avoid=false || true
    [ -s "$work/result" ] || return 1
    # Without a box the least distance is that to itself.
    awk -v d="$(number min_distance "$work/result")" 'BEGIN { exit !(d == "" || d > 0.001) }' || continue
    sed -i 's/^#box //' "$work/$name.yaml"
    run "$work/$name.yaml" -s parameters.avoid=false || true
    [ -n "$(number final_error "$work/result")" ] && return 0
  done
  return 1
}

printf '%-28s' robot
printf '  %-34s' "${methods[@]}"
echo
declare -A good
robots=0
while read -r urdf; do
  name=$(basename "${urdf%.*}")
  srdf=${urdf%.*}.srdf
  if [ ! -e "$srdf" ]; then
    srdf=$work/$name.srdf
    "$simulator" robot check-collisions "$urdf" --write-srdf "$srdf" > /dev/null 2>&1 || srdf=
  fi
  if [ -z "$srdf" ] || ! task "$name" "$urdf" "$srdf"; then
    printf '%-28s  no task: %s\n' "$name" "$(head -c 150 "$work/err" | head -n 1)"
    continue
  fi
  robots=$((robots + 1))
  free=$(number time_to_goal "$work/result")
  printf '%-28s' "$name"
  for method in "${methods[@]}"; do
    extra=()
    [ "$method" != report ] || extra=(-s parameters.relaxation_time=0.4
      -s "parameters.max_distance=$(sed -n 's/^#reach //p' "$work/$name.yaml")")
    run "$work/$name.yaml" -s "parameters.avoidance=$method" "${extra[@]}" || true
    verdict=$(awk -v d="$(number min_distance "$work/result")" -v e="$(number final_error "$work/result")" \
      -v t="$(number time_to_goal "$work/result")" -v free="${free:-8}" '
      BEGIN {
        if (e == "") print "no: failed"
        else if (d != "" && d + 0 <= 0) printf "no: contact, %.3f m\n", d
        else if (e > 0.01 || t == "") printf "no: %.2f off at %.3f m\n", e, d
        else printf("yes, time %.2f, %.3f m%s\n", t / free, d, (t > 2 * free) ? ", late" : "")
      }')
    printf '  %-34s' "$verdict"
    case $verdict in *late) ;; yes*) good[$method]=$((${good[$method]:-0} + 1)) ;; esac
  done
  echo
done < <(find -L "$(cd "$folder" && pwd)" -name '*.urdf' | sort)
printf '%-28s' "of $robots"
for method in "${methods[@]}"; do
  printf '  %-34s' "$(awk -v n="${good[$method]:-0}" -v all="$robots" 'BEGIN { printf "%d, %.0f %%", n, all ? 100 * n / all : 0 }')"
done
echo
