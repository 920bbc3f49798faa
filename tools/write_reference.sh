#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Writes the pages of docs/reference that the simulator makes: systems, keys of a diagram file,
# command line. Usage: tools/write_reference.sh [FOLDER] (default: docs/reference); SIMULATOR names
# another executable than that of the release build.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
folder=$(realpath -m "${1:-$root/docs/reference}")
simulator=${SIMULATOR:-$root/build/release/tools/simulator}
export COLUMNS=80 NO_COLOR=1
mkdir -p "$folder"

"$simulator" docs systems > "$folder/systems.md"
"$simulator" docs diagram_file > "$folder/diagram_file.md"

help() { # COMMAND...
  printf '\n## %s\n\n```\n' "$*"
  "$simulator" "$@" --help | sed -e 's/[[:space:]]*$//' -e '/^$/N;/^\n$/D' | sed -e '${/^$/d}'
  printf '```\n'
}
{
  cat << 'END'
# Command line

<!-- Made by tools/write_reference.sh from the commands' own help; do not edit. -->

Results go to standard output, progress and warnings to standard error; with `--json` standard output
has one JSON object and nothing else. `NO_COLOR`, `TERM=dumb` or no terminal: no colour, no progress
bar. A command or option that is not known gets the nearest that is.

| exit status | |
|---|---|
| 0 | fine |
| 1 | the run failed, or a run of a sweep did not finish; `compare`: the records differ |
| 2 | bad diagram, model or record |
| 3 | an expectation was not met, or the arm touched what no `expect` allows it to; `plan`: no clear motion was found |
| 64 | usage |
| 130 | interrupted; what was recorded up to there is complete |
END
  commands=$("$simulator" --help | sed -n '/^Subcommands:/,$p' | awk 'NR > 1 && /^  [a-z]/ { print $1 }')
  for command in $commands; do
    help "$command"
    inner=$("$simulator" "$command" --help | sed -n '/^Subcommands:/,$p' | awk 'NR > 1 && /^  [a-z]/ { print $1 }')
    for second in $inner; do help "$command" "$second"; done
  done
} > "$folder/command_line.md"
