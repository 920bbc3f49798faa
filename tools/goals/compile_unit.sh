#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# CPU seconds of compiling a source, the least of three. Usage: compile_unit.sh FLAG... SOURCE
set -euo pipefail
eigen=$(pkg-config --variable=prefix eigen3)/include/eigen3
for _ in 1 2 3; do
  { TIMEFORMAT='%U %S'; time c++ -std=c++20 "${@:1:$#-1}" -isystem "$eigen" -c "${*: -1}" -o /dev/null; } 2>&1
done | awk 'NF != 2 { print > "/dev/stderr"; failed = 1; exit }
            { time = $1 + $2; if (NR == 1 || time < least) least = time }
            END { if (!failed) printf "%.2f\n", least; exit failed }'
