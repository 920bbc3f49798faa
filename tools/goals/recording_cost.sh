#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Per cent of time that a record adds to 10 s of the static test at 1 kHz, on the whole program and of
# the clock: least of twelve each.
set -euo pipefail
run() {
  rm -f "$OCA_WORK/cost.mcap"
  { TIMEFORMAT=%R; time "$OCA_BUILD/tools/simulator" run diagrams/static_test.yaml -t 10 \
    -s parameters.rate=1000 --no-progress "$@" > /dev/null 2>&1 || [ $? -eq 3 ]; } 2>&1
}
for _ in 1 2 3 4 5 6 7 8 9 10 11 12; do
  echo "$(run) $(run --record "$OCA_WORK/cost.mcap")"
done | awk '$1 <= 0 || $2 <= 0 { failed = 1; exit }
            { if (NR == 1 || $1 < bare) bare = $1; if (NR == 1 || $2 < recorded) recorded = $2 }
            END { if (failed || !NR) exit 1; printf "%.1f\n", 100 * (recorded / bare - 1) }'
