#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# How many lines of C++ know a system's type by name, outside systems/, the catalogue's rows and tests: in
# a string, or as a class, which programs of one diagram and of one block's speed may (tools/examples,
# tools/bench). `Diagram` is no system's, but the file format's word for another file.
# Left out, but listed: templates of diagram files, which name types as diagrams do.
set -euo pipefail
names=$("$OCA_BUILD/tools/simulator" list | awk '$1 != "Diagram:" && $1 != "Diagram" { printf "%s%s", separator, $1; separator = "|" }')
matches=$(dirname "$0")/matches.sh
strings=$("$matches" "\"([^\"]*[^A-Za-z_\"])?($names)([^A-Za-z_\"][^\"]*)?\"" ':!systems' ':!*catalogue*.cc')
classes=$("$matches" "^([^/]|/[^/])*systems::($names)\b" ':!systems' ':!*catalogue*.cc' ':!tools/examples' ':!tools/bench')
git grep -nE "type: ($names)\b" -- '*.yaml.in' | sed 's/^/left out: /' >&2 || true
echo $((strings + classes))
