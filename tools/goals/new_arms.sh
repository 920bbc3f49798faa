#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# How many robots below a folder `simulator new` makes no first motion for that is in contact without
# avoidance and clear with it. Usage: new_arms.sh FOLDER
set -euo pipefail
failed=0 robots=0
while read -r robot; do
  robots=$((robots + 1))
  "$OCA_BUILD/tools/simulator" new "$robot" -o "$OCA_WORK/$(basename "$robot")" > "$OCA_WORK/new" 2>&1 ||
    failed=$((failed + 1))
done < <(find "$1" -name '*.urdf' | sort)
[ $robots -gt 0 ] || { echo "$1: no robot" >&2; exit 1; }
echo "$failed"
