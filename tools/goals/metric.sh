#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A metric of a run. Usage: metric.sh METRIC FILE [OPTION of simulator run...]
set -euo pipefail
metric=$1; shift
# Status 3, an expectation that is not met, is for the file's own.
{ "$OCA_BUILD/tools/simulator" run "$@" --json --no-progress 2>/dev/null || [ $? -eq 3 ]; } |
  node -e 'console.log(JSON.parse(require("fs").readFileSync(0, "utf8")).metrics[process.argv[1]])' "$metric"
