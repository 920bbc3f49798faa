#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Writes the report of a run of 60 s, once a scoreboard, and prints its name.
set -euo pipefail
report=$OCA_WORK/report.html
[ -s "$report" ] || "$OCA_BUILD/tools/simulator" run diagrams/static_test.yaml -t 60 --report "$report" \
  --no-progress > "$OCA_WORK/report.log" 2>&1 || [ $? -eq 3 ]
[ -s "$report" ] && echo "$report"
