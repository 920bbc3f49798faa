#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Minutes that tools/test.sh takes in a fresh clone of the last commit, without the compiler's cache.
set -euo pipefail
folder=build/cold_test
rm -rf "$folder"
git clone -q . "$folder"
start=$(date +%s)
(cd "$folder" && CCACHE_DISABLE=1 tools/test.sh) > "$OCA_WORK/cold_test" 2>&1 ||
  { tail -5 "$OCA_WORK/cold_test" >&2; exit 1; }
end=$(date +%s)
rm -rf "$folder"
awk -v seconds=$((end - start)) 'BEGIN { printf "%.1f\n", seconds / 60 }'
