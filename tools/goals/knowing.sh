#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# How many files know something by name, tests, documentation and models left out: what a new one of its
# kind touches. Names them on standard error, and fails if nobody does. Usage: knowing.sh REGEX
set -euo pipefail
git grep -liE "$1" -- ':!tests' ':!docs' ':!*.md' ':!models/robots' ':!tools/bench' ':!tools/goals' |
  tee /dev/stderr | wc -l
