// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/live/live_run.h"

#include "oca/diagrams/live/live_changes.h"
#include "oca/diagrams/record/recording.h"

namespace oca::live {
namespace {

/// How long a run lasts that somebody looks at and no file ends, s.
constexpr double kLiveDuration = 1e6;

}  // namespace

LiveRunResult RunLive(const LiveRunOptions& options, LiveServer& server) {
  LiveChanges changes(options, server);
  record::RecorderOptions shown;
  shown.overrides = options.overrides;
  shown.attach_files = false;
  record::Recording show({&server}, shown);
  runs::RunOptions run;
  run.duration = options.duration.value_or(kLiveDuration);
  run.realtime_factor = options.realtime_factor;
  run.judge = false;
  run.log = options.log;
  if (options.interrupted) run.progress = [&](double) { return !options.interrupted(); };
  run.outputs = options.outputs;
  run.outputs.insert(run.outputs.begin(), &show);
  run.hook = &changes;
  const auto first = changes.loaded();
  LiveRunResult result;
  result.run = runs::Run(*first, run);
  result.changes = changes.count();
  if (result.run.failure) {
    server.Tell(StatusLevel::kError, "the run failed: " + result.run.failure->message);
  }
  return result;
}

}  // namespace oca::live
