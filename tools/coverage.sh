#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Which share of the lines the tests run, a folder a row. Usage: tools/coverage.sh [TARGET...]
#   TARGET  test programs to build and run; without any the whole suite
set -euo pipefail
cd "$(dirname "$0")/.."
tools/setup.sh coverage "$@"
find build/coverage -name '*.gcda' -delete
if [ $# -gt 0 ]; then
  for target in "$@"; do
    "$(find build/coverage/tests -type f -name "$target")" --gtest_brief=1 >&2
  done
else
  ctest --preset coverage -j "$(nproc)" >&2
fi
node tools/coverage.mjs build/coverage
