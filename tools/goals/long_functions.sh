#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# How many functions have more lines than allowed, those of C++, of scripts and of the page, bodies of tests
# included; names them on standard error. Usage: long_functions.sh LINES. What is named Describe is a list of
# parameters, and may be long.
set -euo pipefail
of_cpp() { # -> lines, file, name
  git ls-files '*.cc' '*.h' |
    ctags -L - --languages=C++ --langmap=C++:.cc.h --kinds-C++=f --fields=+ne -o - |
    awk -F'\t' '
      /^!/ { next }
      {
        first = last = 0
        for (i = 4; i <= NF; ++i) {
          if ($i ~ /^line:/) first = substr($i, 6)
          if ($i ~ /^end:/) last = substr($i, 5)
        }
        if ($1 != "Describe") print last - first + 1, $2, $1
      }'
}
# ctags knows no ends here: a function ends where a line of its indentation begins with a brace.
of_scripts() { # -> lines, file, line of its beginning
  git ls-files -z '*.mjs' '*.ts' | xargs -0 awk '
    FNR == 1 { depth = 0 }
    { indentation = match($0, /[^ ]/) }
    /^ *}/ {
      if (depth > 0 && indentation == at[depth]) { print FNR - first[depth] + 1, FILENAME, first[depth]; --depth }
    }
    /{$/ && (/[^a-z]function[ *]|^ *function[ *]|=> {$/ || /\)(: [^=]*)? {$/) && !/^ *(} )?(else|if|for|while|switch|catch)[^a-z]/ {
      at[++depth] = indentation; first[depth] = FNR
    }'
}
{ of_cpp; of_scripts; } |
  awk -v most="$1" '
    { ++functions[$2 ~ /\.(cc|h)$/] }
    $1 > most { print > "/dev/stderr"; ++count }
    END { if (functions[0] < 100 || functions[1] < 100) exit 1; print count + 0 }'
