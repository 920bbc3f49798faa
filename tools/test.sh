#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Sets up a fresh Debian 12 machine and runs all tests as users build them, then those that read
# foreign files once more under valgrind, and the page in a browser.
set -euo pipefail
cd "$(dirname "$0")/.."
jobs=$(nproc)

EXTRA_PACKAGES="chromium fonts-dejavu-core libc6-dbg valgrind" tools/setup.sh release
ctest --preset release -j "$jobs"

echo "Inputs from outside that once went wrong"
tests/cases/run.sh

# All under sanitizers takes a build of its own: tools/test_long.sh clang, or `ctest --preset debug`.
echo "What reads files, under valgrind"
under_valgrind() { # TEST FILTER: not what computes for minutes there
  OCA_FUZZ_INPUTS=20 valgrind -q --error-exitcode=1 \
    "$(find build/release/tests -type f -name "$1")" --gtest_brief=1 --gtest_filter="$2"
}
running=()
under_valgrind files_test '*' & running+=($!)
under_valgrind loading_test '-*EveryBlueprintTest*:*FileNested*' & running+=($!)
under_valgrind fuzz_replay_test '*' & running+=($!)
under_valgrind robot_test 'Urdf*:Srdf*:Xacro*:Xml*:Mesh*:JointLimitsFile*:HoldJoints*:Posture*:Inertia*:FuseCapsules*' & running+=($!)
under_valgrind geometry_test 'Mesh*:StlFile*:ObjFile*:ColladaFile*:Octree*:PlyFile*:PointCloud*:Lzf*:Collider*:ConvexHull*:Decomposition*:CoarseMesh*' & running+=($!)
for process in "${running[@]}"; do wait "$process"; done

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
