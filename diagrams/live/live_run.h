// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "oca/diagrams/files/document.h"
#include "oca/diagrams/live/live_parameters.h"
#include "oca/diagrams/live/live_server.h"
#include "oca/diagrams/runs/run.h"
#include "oca/framework/dataflow/log.h"

namespace oca::live {

struct LiveRunOptions {
  std::filesystem::path file{};
  files::Catalogue catalogue{files::Catalogue::Standard()};  ///< types of its systems
  std::vector<files::Override> overrides{};
  std::optional<double> duration{};  ///< s; without one the run goes on until it is interrupted
  double realtime_factor{1.0};       ///< simulated seconds a second
  Log* log{nullptr};
  /// What is made of the run besides, as one, whatever is changed. Must outlive it.
  std::vector<runs::RunOutput*> outputs{};
  /// Asked after every step.
  std::function<bool()> interrupted{};
  /// Told why a change was refused.
  std::function<void(const std::string& why)> refused{};
  /// Told what the diagram is warned of: at first, and after a change what is new.
  std::function<void(const std::string& warning)> warned{};
};

struct LiveRunResult {
  runs::RunResult run;  ///< without expectations: nobody knows when it ends
  int changes{0};       ///< of parameters and places, that took effect
};

/// Runs a diagram in step with the wall clock for whoever looks at `server`: runs::Run, with a hook
/// for what clients change. An obstacle that is moved is so at the next tick, by the input
/// `offsets` of its source. A change of a parameter makes the diagram anew, on a thread of its own,
/// and the run goes on with it from the state it has at the next tick after that. One that the
/// diagram refuses is undone, and all clients are told why. throws ConfigError if the file cannot
/// be loaded, and as runs::Run does.
LiveRunResult RunLive(const LiveRunOptions& options, LiveServer& server);

}  // namespace oca::live
