#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# How many lines of C++ name a system's type as a string, outside systems/, the catalogue's rows and tests.
# `Diagram` is no system's, but the file format's word for another file.
set -euo pipefail
names=$("$OCA_BUILD/tools/simulator" list | awk '$1 != "Diagram:" && $1 != "Diagram" { printf "%s%s", separator, $1; separator = "|" }')
exec "$(dirname "$0")/matches.sh" "\"($names)\"" ':!systems' ':!*catalogue*.cc'
