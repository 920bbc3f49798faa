#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Has clang-tidy judge the sources by .clang-tidy, as many at a time as there are processors; nothing
# is built. Usage: tools/tidy.sh [REGEX]
#   REGEX  of sources, such as ^framework/; all of the product without it
# Prints each finding once, and how many there are; exit status 1 if there is any.
set -euo pipefail
cd "$(dirname "$0")/.."
filter=${1:-.}
EXTRA_PACKAGES="clang clang-tidy" tools/setup.sh --packages
cmake --preset tidy > /dev/null

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Sources in the tree, and the batches of them that the build compiles as one; not the headers alone.
awk -F'"' -v tree="$PWD/" '$2 == "file" { sub(tree, "", $4); print $4 }' build/tidy/compile_commands.json |
  grep -v verify_interface_header_sets | sed "s|^build/tidy/||" | grep -E "$filter" > "$work/sources" ||
  { echo "tools/tidy.sh: no source matches $filter" >&2; exit 64; }
sed "s|^.*/CMakeFiles/|build/tidy/&|" "$work/sources" |
  xargs -P "$(nproc)" -I{} sh -c 'clang-tidy -p build/tidy --quiet "{}" 2>> "$0/messages" || touch "$0/failed"' "$work" \
  > "$work/findings"
sed "s|$PWD/||" "$work/findings" | awk '
  /: (warning|error): / { finding = $0; new = !seen[finding]++; count += new }
  new { print }
  END { print count + 0, "findings"; exit count > 0 }'
if [ -e "$work/failed" ]; then  # and yet no finding
  grep -v ' warnings generated' "$work/messages" >&2
  exit 1
fi
