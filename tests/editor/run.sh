#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Has the language server of VS Code's YAML extension judge diagram files. Usage: run.sh SIMULATOR
set -euo pipefail
simulator=$(realpath "$1")
cd "$(dirname "$0")"
npm ci --no-audit --no-fund --silent

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$simulator" schema > "$folder/diagram.schema.json"
if ! cmp -s "$folder/diagram.schema.json" ../../diagrams/diagram.schema.json; then
  echo "diagrams/diagram.schema.json: not what $simulator says; expected the build to write it" >&2
  exit 1
fi
node check_editor.mjs ../.. "$folder/diagram.schema.json"
