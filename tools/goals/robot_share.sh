#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The share of robots below a folder that get past a ball by the recommended method, %: see
# tools/robot_table.sh. Usage: robot_share.sh FOLDER
set -euo pipefail
SIMULATOR=$OCA_BUILD/tools/simulator tools/robot_table.sh --methods recommended "$1" > "$OCA_WORK/table"
awk '/^of [0-9]+ / { print $(NF - 1); found = 1 } END { exit !found }' "$OCA_WORK/table"
