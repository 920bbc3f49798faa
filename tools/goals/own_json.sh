#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# How many lines parse JSON that our own code wrote just before. Left out are the reader itself
# (dataflow/json_text) and those of what comes from outside the program: inputs of eval, which signals
# read themselves (systems/signals, and those of others by JsonMembers), live clients, records, results of sweeps; and the members of a
# signal: of its type, which may be another program's, only the JSON is known (docs/architecture.md).
set -euo pipefail
exec "$(dirname "$0")/matches.sh" '[jJ]son::parse\(|ReadJsonTree\(' ':!framework/dataflow/json_text.*' \
  ':!framework/dataflow/json_object.cc' ':!framework/dataflow/signal.cc' ':!framework/dataflow/signal_shape.cc' ':!systems/signals' \
  ':!diagrams/files/json_reader.cc' ':!diagrams/runs/evaluator.cc' ':!diagrams/live/client_request.cc' \
  ':!diagrams/record/message_json.cc' ':!diagrams/record/run_metadata.cc' \
  ':!diagrams/sweep/campaign.cc' ':!diagrams/sweep/sample_row.cc'
