#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# How many of tests/cases fail.
set -euo pipefail
tests/cases/run.sh > "$OCA_WORK/cases" 2>&1 || true
awk '/^[0-9]+ passed, [0-9]+ failed$/ { print $3; found = 1 } END { exit !found }' "$OCA_WORK/cases"
