#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# How many tests fail, of those whose name matches. Usage: tests.sh REGEX
set -euo pipefail
ctest --test-dir "$OCA_BUILD" -R "$1" --no-tests=error -j "$(nproc)" > "$OCA_WORK/ctest" 2>&1 || true
awk '/tests passed, [0-9]+ tests failed out of/ { failed = $4; found = 1 }
     END { if (found) print failed; exit !found }' "$OCA_WORK/ctest"
