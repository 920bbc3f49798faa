#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# How many lines of C++ sources match, tests left out. Usage: matches.sh REGEX [PATHSPEC...]
set -euo pipefail
regex=$1; shift
{ git grep -nE "$regex" -- '*.cc' '*.h' ':!tests' "$@" || [ $? -eq 1 ]; } | tee /dev/stderr | wc -l
