#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# How many sources have more lines than allowed; names them on standard error. Usage: long_files.sh LINES
set -euo pipefail
git ls-files -z '*.cc' '*.h' '*.ts' '*.mjs' '*.sh' | xargs -0 wc -l |
  awk -v most="$1" '$2 != "total" && $1 > most { print $1, $2 > "/dev/stderr"; ++count }
                    END { print count + 0 }'
