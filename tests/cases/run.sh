#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs small inputs from outside that once went wrong: tests/cases/run.sh [NAME...], all without
# names. Prints a line a case, what a failed one printed, and the count; exit status 1 if one fails.
#
# A case is a folder with its inputs and a run.sh, which is run by `bash -eu` in an empty folder of
# its own and passes with status 0. It is given
#   CASE        its folder
#   SIMULATOR   the executable (default: that of the release build)
#   OCA_SOURCE  the source tree
#   OCA_BUILD   the build folder
set -uo pipefail
cd "$(dirname "$0")"
export OCA_SOURCE=${OCA_SOURCE:-$(realpath ../..)}
export OCA_BUILD=${OCA_BUILD:-$OCA_SOURCE/build/release}
export SIMULATOR=${SIMULATOR:-$OCA_BUILD/tools/simulator}
[ -x "$SIMULATOR" ] || { echo "no simulator at $SIMULATOR; build it: tools/setup.sh release simulator" >&2; exit 2; }

[ $# -gt 0 ] || set -- */
passed=0 failed=0
for name in "${@%/}"; do
  export CASE=$PWD/$name
  [ -f "$CASE/run.sh" ] || { echo "no such case: $name" >&2; exit 2; }
  work=$(mktemp -d)
  if (cd "$work" && timeout 300 bash -eu "$CASE/run.sh" < /dev/null > "$work/.output" 2>&1); then
    echo "pass  $name"
    passed=$((passed + 1))
  else
    echo "FAIL  $name"
    sed 's/^/        /' "$work/.output"
    failed=$((failed + 1))
  fi
  rm -rf "$work"
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
