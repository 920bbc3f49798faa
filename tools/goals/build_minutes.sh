#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# CPU minutes of building a target from nothing, without the compiler's cache.
# Usage: build_minutes.sh TARGET [CMAKE OPTION]...
set -euo pipefail
folder=build/from_nothing
rm -rf "$folder"
export CCACHE_DISABLE=1
cmake --preset release -B "$folder" "${@:2}" > "$OCA_WORK/build" 2>&1
{ TIMEFORMAT='%U %S'; time cmake --build "$folder" --target "$1" >> "$OCA_WORK/build" 2>&1; } 2> "$OCA_WORK/time" ||
  { tail -5 "$OCA_WORK/build" >&2; exit 1; }
rm -rf "$folder"
awk 'END { printf "%.1f\n", ($1 + $2) / 60 }' "$OCA_WORK/time"
