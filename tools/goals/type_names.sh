#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# How many lines of C++ name a system's type in a string, outside systems/, the catalogue's rows and tests.
# `Diagram` is no system's, but the file format's word for another file. What drafts write is YAML, which
# names types as every file does.
set -euo pipefail
names=$("$OCA_BUILD/tools/simulator" list | awk '$1 != "Diagram:" && $1 != "Diagram" { printf "%s%s", separator, $1; separator = "|" }')
exec "$(dirname "$0")/matches.sh" "\"([^\"]*[^A-Za-z_\"])?($names)([^A-Za-z_\"][^\"]*)?\"" \
  ':!systems' ':!*catalogue*.cc' ':!diagrams/drafts/*draft_text.cc'
