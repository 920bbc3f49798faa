#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Measures every goal that the issues name as a number, now, by the command of its row in
# tools/bench/goals.csv. Usage: tools/scoreboard.sh [--quick] [REGEX]
#   --quick  only what takes seconds and needs the release build alone
#   REGEX    of ids, such as ^size/; all without it
# Prints a row a goal: its id and issue, what is counted, the value, the bound, whether it is met, and
# the command (helpers are in tools/goals). A goal whose command fails or prints no number is not
# measured, never met. Exit status 1 if any is missed or not measured.
set -uo pipefail
cd "$(dirname "$0")/.."
quick=false
[ "${1:-}" = --quick ] && quick=true && shift
if [[ "${1:-}" == -* || $# -gt 1 ]]; then
  sed -n 's/^# \?//p' "$0" | sed -n 3,9p >&2
  [ "${1:-}" = --help ] && exit 0
  exit 64
fi
filter=${1:-.}

if [ -z "${OCA_BUILD:-}" ]; then
  EXTRA_PACKAGES=universal-ctags tools/setup.sh release $($quick && echo simulator viewer case_control_loop) || exit 1
fi
export OCA_BUILD=${OCA_BUILD:-$PWD/build/release}
OCA_WORK=$(mktemp -d) || exit 1
export OCA_WORK
trap 'rm -rf "$OCA_WORK"' EXIT
PATH=$PWD/tools/goals:$PATH
export LC_ALL=C

line='| %-30s | %-70s | %12s | %-12s | %-12s | %s\n'
# shellcheck disable=SC2059
show() { printf "$line" "$@"; }
show goal 'issue, what' measured bound '' command
show --- --- --: --- --- ---
met=0 missed=0 unmeasured=0
while IFS=';' read -r id issue bound unit fast what command _ <&3; do
  [[ -z $id || $id == \#* ]] && continue
  [[ $id =~ $filter ]] || continue
  $quick && [ "$fast" != q ] && continue
  [ -n "$command" ] || command="bench.sh $id"
  value=$(bash -o pipefail -c "$command" 2> "$OCA_WORK/error" < /dev/null)
  status=$?
  value=$(tail -n 1 <<< "$value" | tr -d ' ')
  if [ $status -ne 0 ] || ! [[ $value =~ ^-?[0-9]+(\.[0-9]*)?([eE][-+]?[0-9]+)?$ ]]; then
    verdict='not measured' value=-
    unmeasured=$((unmeasured + 1))
    command+=" | $(tail -n 1 "$OCA_WORK/error" | cut -c 1-100)"
  elif awk -v x="$value" -v bound="$bound" 'BEGIN {
      split(bound, word, " ")
      if (word[1] == "<=") exit !(x + 0 <= word[2] + 0)
      if (word[1] == ">=") exit !(x + 0 >= word[2] + 0)
      exit !(word[1] == "=" && x + 0 == word[2] + 0) }'; then
    verdict=met
    met=$((met + 1))
  else
    verdict=MISSED
    missed=$((missed + 1))
  fi
  [ "$value" = - ] || value=$(awk -v x="$value" 'BEGIN { printf "%.6g", x }')
  show "$id" "$issue, $what" "$value" "$bound $unit" "$verdict" "$command"
done 3< "${OCA_GOALS:-tools/bench/goals.csv}"
echo
echo "$met met, $missed missed, $unmeasured not measured"
[ $((missed + unmeasured)) -eq 0 ]
