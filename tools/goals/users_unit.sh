#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# CPU seconds of the slowest unit of a program that uses the library: the consumer, the examples.
set -euo pipefail
includes=(-I.)
[ -d "$OCA_BUILD/include" ] && includes+=("-I$OCA_BUILD/include")
shopt -s nullglob
for source in tests/consumer/*.cc tools/examples/*.cc; do
  seconds=$("$(dirname "$0")/compile_unit.sh" -O2 -DFMT_SHARED "${includes[@]}" "$source")
  echo "$source $seconds" >&2
  echo "$seconds"
done | sort -n | tail -1
