#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Has clang-tidy judge the sources by .clang-tidy, as many at a time as there are processors; nothing
# is built. Usage: tools/tidy.sh [REGEX]
#   REGEX  of sources, such as ^framework/; all of the product without it
# Prints each finding once, and how many there are; exit status 1 if there is any.
#
# Two passes: what looks at syntax reads the batches that the build compiles as one; the analyzer,
# which follows paths through the functions of the source itself and not of what it includes, reads
# sources one by one; of leaks it sees only what Eigen and FCL own.
set -euo pipefail
cd "$(dirname "$0")/.."
filter=${1:-.}
EXTRA_PACKAGES="clang clang-tidy" tools/setup.sh --packages
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

pass() { # PRESET CHECKS: appends to $work/findings
  cmake --preset "$1" > /dev/null
  # Batches lie in the build tree; each public header alone is for another check.
  awk -F'"' -v tree="$PWD/" '$2 == "file" { sub(tree, "", $4); print $4 }' "build/$1/compile_commands.json" |
    grep -v verify_interface_header_sets | sed "s|^build/$1/||" | { grep -E "$filter" || true; } |
    sed "s|^.*/CMakeFiles/|build/$1/&|" > "$work/sources"
  if [ ! -s "$work/sources" ]; then
    echo "tools/tidy.sh: no source matches $filter" >&2
    exit 64
  fi
  xargs -P "$(nproc)" -a "$work/sources" -I{} \
    sh -c 'clang-tidy -p "build/$1" --quiet --checks="$2" "{}" 2>> "$0/messages" || touch "$0/failed"' \
    "$work" "$1" "$2" >> "$work/findings"
}

pass tidy '-clang-analyzer-*'
pass tidy_single '-*,clang-analyzer-*,-clang-analyzer-unix.Malloc,-clang-analyzer-cplusplus.NewDeleteLeaks'
sed "s|$PWD/||" "$work/findings" | awk '
  /: (warning|error): / {
    finding = $0
    new = !seen[finding]++
    # Not of the libraries that headers bring, and loops of benchmarks that count but name nothing.
    if (/^\/usr\// || /Value stored to .(_|found). during its initialization/) new = 0
    count += new
  }
  new { print }
  END { print count + 0, "findings"; exit count > 0 }'
if [ -e "$work/failed" ]; then  # and yet no finding
  grep -v ' warnings generated' "$work/messages" >&2
  exit 1
fi
