#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# What an editor marks wrongly in diagram files, and mistakes that it does not mark.
set -euo pipefail
tests/editor/run.sh "$OCA_BUILD/tools/simulator" > "$OCA_WORK/editor" 2>&1 || true
tail -5 "$OCA_WORK/editor" >&2
awk '/ failures$/ { print $(NF - 1); found = 1 } END { exit !found }' "$OCA_WORK/editor"
