#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# CPU seconds of compiling the named headers alone, the least of three. Usage: compile.sh FLAG... HEADER...
set -euo pipefail
flags=()
while [[ ${1:-} == -* ]]; do flags+=("$1"); shift; done
printf '#include %s\n' "$@" > "$OCA_WORK/only.cc"
exec "$(dirname "$0")/compile_unit.sh" "${flags[@]}" "$OCA_WORK/only.cc"
