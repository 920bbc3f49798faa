#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Records runs and has readers that OCA did not write judge them. Usage: run.sh SIMULATOR
set -euo pipefail
simulator=$(realpath "$1")
cd "$(dirname "$0")"
npm ci --no-audit --no-fund --silent

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for compression in none lz4 zstd; do
  "$simulator" run ../../diagrams/static_test.yaml --record "$folder/$compression.mcap" \
    --record-compression "$compression" > /dev/null
done
for diagram in dual_arm dynamic_test; do
  "$simulator" run "../../diagrams/$diagram.yaml" --record "$folder/$diagram.mcap" > /dev/null
done
node check_record.mjs "$folder"/*.mcap
