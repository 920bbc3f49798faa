#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Megabytes of the report of a run of 60 s.
set -euo pipefail
stat -c %s "$("$(dirname "$0")/report.sh")" | awk '{ printf "%.2f\n", $1 / 1e6 }'
