#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Seconds until a browser shows the report of a run of 60 s.
set -euo pipefail
report=$("$(dirname "$0")/report.sh")
(cd tools/viewer && node test/screenshot.mjs "$report" "$OCA_WORK/report.png") |
  awk '/open after [0-9.]+ ms/ { printf "%.2f\n", $(NF - 1) / 1000; found = 1 } END { exit !found }'
