#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# How many files know something by name, tests, documentation and models left out: what a new one of its
# kind touches. Names them on standard error. Usage: knowing.sh REGEX
set -euo pipefail
{ git grep -liE "$1" -- ':!tests' ':!docs' ':!*.md' ':!models/robots' ':!tools/bench' ':!tools/goals' || [ $? -eq 1 ]; } |
  tee /dev/stderr | wc -l
