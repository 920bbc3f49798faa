#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A figure of the recommended method over a family of scenarios, on seeds that nothing was tuned on; shares in
# per cent. Usage: campaign.sh FAMILY SAMPLES KEY.MEMBER
set -euo pipefail
results=$OCA_WORK/$1.json
if [ ! -s "$results" ]; then
  "$OCA_BUILD/tools/simulator" sweep "diagrams/scenarios/$1.yaml" --samples "$2" --seed 2016 \
    -s parameters.avoidance=recommended -o "$OCA_WORK/$1" --json --no-progress > "$results" 2>/dev/null || true
fi
node -e '
  const {runs, combinations: [all]} = JSON.parse(require("fs").readFileSync(process.argv[1]));
  const [samples, [key, member]] = [Number(process.argv[2]), process.argv[3].split(".")];
  if (runs !== samples) throw new Error(`${runs} runs of ${samples}`);
  console.log(member === "share" ? 100 * all[key][member] : all[key][member]);' "$results" "$2" "$3"
