#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Sets up a fresh Debian 12 machine and runs all tests: everything as users build it, then what
# reads foreign files once more under the address and undefined-behaviour sanitizers.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/setup.sh release
ctest --preset release -j "$(nproc)" --output-on-failure
