#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs all planning scenes of a folder, as MoveIt writes them, through the closed loop and through
# `simulator plan`, and prints what became of them, family by family.
# Usage: tools/benchmark_scenes.sh [OPTION]... FOLDER ROBOT
#
#   FOLDER              FAMILY/sceneNNNN.yaml with FAMILY/requestNNNN.yaml, or the pairs without a family
#   ROBOT               URDF or xacro; a file beside it named .srdf is its SRDF
#   --srdf FILE         another one
#   --family NAME       this family alone; may be given again
#   --samples N         problems of each family, spread evenly; all without it
#   --seed S            draws them instead
#   --jobs N            processes at a time (1)
#   --set PATH=VALUE    as `simulator run -s`; may be given again
#   --duration SECONDS  when a run is judged (20)
#   --intruder SEED     a ball (radius 0.1 m, up to 1.6 m/s) flies at the arm besides, another one for each
#                       problem; the last table says what is clear of what foresight clears
#   --no-plan           without `simulator plan`
#   --reference         path over the least of ten searches of 1 s, seeds 0 to 9: 10 s a problem
#   -o DIR              folder of results (build/scenes); what it has of the same settings is not run again
#
# clear      certified at every time; arrived: at most 0.01 off the goal in each joint, and slower
#            than 0.01/s. Both with Wilson's 95 % interval; a run that failed is neither
# to goal    median and 95 % quantile of those that arrived, s
# path       median of the length (2-norm of the joints), and over the reference's
# plan ms    what the slowest 50 calls a second of system `band` took; of `plan` its search
# stuck      runs that stood still off the goal for 2 s
#
# Exit status 0 however many arrive; 2 if FOLDER has no problem or the robot cannot be read.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
case ${1:-} in
  -h | --help) sed -n 's/^# \?//p' "$0" | sed -n '2,$p'; exit 0 ;;
esac
export SIMULATOR=${SIMULATOR:-$root/build/release/tools/simulator}
[ -x "$SIMULATOR" ] || "$root/tools/setup.sh" release simulator
exec node "$root/tools/benchmark_scenes.mjs" "$@"
