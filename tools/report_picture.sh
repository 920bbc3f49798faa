#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes docs/pictures/report.png, the picture of a report in the README. Needs chromium.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/setup.sh release simulator viewer
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
build/release/tools/simulator run diagrams/static_test.yaml -s parameters.relaxation_time=0.4 \
  --report "$folder/report.html" --no-progress > /dev/null
node tools/viewer/test/screenshot.mjs "$folder/report.html" docs/pictures/report.png 1440x900 light 0 6.5
