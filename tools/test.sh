#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Sets up a fresh Debian 12 machine and runs all tests as users build them, then those that read
# foreign files once more: robots and meshes under the address and undefined-behaviour sanitizers,
# diagrams under valgrind, which needs no second build. `ctest --preset debug` runs everything under
# the sanitizers.
set -euo pipefail
cd "$(dirname "$0")/.."
jobs=$(nproc)

EXTRA_PACKAGES="chromium fonts-dejavu-core libc6-dbg valgrind" tools/setup.sh release
ctest --preset release -j "$jobs"

echo "Inputs from outside that once went wrong"
tests/cases/run.sh

hostile=(robot_test geometry_test)
tools/setup.sh debug "${hostile[@]}"
for test in "${hostile[@]}"; do
  echo "$test under sanitizers"
  # Not the million pairs, which take minutes there.
  "$(find build/debug/tests -type f -name "$test")" --gtest_brief=1 \
    --gtest_filter='-Shares/*:Scales/*:DistanceInvariance*:DistanceEnumeration*:DistanceProof*'
done

for test in files_test loading_test; do
  echo "$test under valgrind"
  # Not all diagrams again and again, which take minutes there.
  valgrind -q --error-exitcode=1 \
    "$(find build/release/tests -type f -name "$test")" --gtest_brief=1 --gtest_filter='-*EveryBlueprintTest*:*FileNested*'
done

if command -v chromium > /dev/null && [ -f build/release/tools/viewer/viewer.html ]; then
  echo "The page in a real browser"
  OCA_VIEWER=build/release/tools/viewer/viewer.html \
    node tools/viewer/test/run.mjs build/release/tools/simulator
else
  echo "The page is not tested: no chromium, or no Node to build it."
fi

if command -v npm > /dev/null; then
  echo "Records, by readers of others; diagrams, in an editor"
  tests/record_node/run.sh build/release/tools/simulator
  tests/editor/run.sh build/release/tools/simulator
else
  echo "Records are not read by others, diagrams by no editor: no npm."
fi
