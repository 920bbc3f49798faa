#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# How many C++ functions have more lines than allowed, bodies of tests included; names them on standard error.
# Usage: long_functions.sh LINES. What is named Describe is a list of parameters, and may be long.
set -euo pipefail
git ls-files '*.cc' '*.h' |
  ctags -L - --languages=C++ --langmap=C++:.cc.h --kinds-C++=f --fields=+ne -o - |
  awk -F'\t' -v most="$1" '
    /^!/ { next }
    {
      first = last = 0
      for (i = 4; i <= NF; ++i) {
        if ($i ~ /^line:/) first = substr($i, 6)
        if ($i ~ /^end:/) last = substr($i, 5)
      }
      ++functions
      if (last - first + 1 > most && $1 != "Describe") { print last - first + 1, $2, $1 > "/dev/stderr"; ++count }
    }
    END { if (functions < 100) exit 1; print count + 0 }'
