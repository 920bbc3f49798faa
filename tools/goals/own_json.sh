#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# How many lines parse JSON that our own code wrote just before. Left out are readers of what comes from
# outside the program: inputs of eval and live clients, records, results of sweeps; and
# the members of a signal: of its type, which may be another program's, only the JSON is known.
set -euo pipefail
exec "$(dirname "$0")/matches.sh" 'json::parse\(' ':!*/json_reader.cc' ':!*/evaluator.cc' \
  ':!*/live_client.h' ':!*/comparison.cc' ':!*/csv_export.cc' ':!*/run_metadata.cc' ':!*/series.cc' \
  ':!*/campaign.cc' ':!*/sample_row.cc' ':!*/signal.cc' ':!*/signal_shape.cc'
