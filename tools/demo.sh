#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Sets up a fresh Debian 12 machine and shows a KUKA LWR 4 evading a box that lies across its path.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/setup.sh release simulator viewer
simulator=build/release/tools/simulator

echo "The request runs through the box; without avoidance:"
"$simulator" run diagrams/static_test.yaml -s parameters.avoid=false || [ $? -eq 3 ]
echo
echo "With the avoidance of the 2016 report (it evades, arrives, and chatters):"
report=()
[ -f build/release/tools/viewer/viewer.html ] && report=(--report build/demo/report.html)
mkdir -p build/demo
"$simulator" run diagrams/static_test.yaml --csv build/demo "${report[@]}"
echo
echo "The same with the recommended relaxation (no chatter):"
"$simulator" run diagrams/static_test.yaml -s parameters.relaxation_time=0.4
echo
echo "The recorded joints and deltas are in build/demo; next: README.md."
if [ ${#report[@]} -gt 0 ]; then
  echo "Open this report in a browser: $PWD/build/demo/report.html"
else
  echo "No report: the viewer page was not built (it needs npm and the network once)."
fi
