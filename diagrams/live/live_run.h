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
#include "oca/diagrams/loading/loader.h"
#include "oca/framework/dataflow/log.h"

namespace oca::live {

struct LiveRunOptions {
  std::filesystem::path file{};
  files::Catalogue catalogue{files::Catalogue::Standard()};  ///< types of its systems
  std::vector<files::Override> overrides{};
  std::optional<double> duration{};  ///< s; without one the run goes on until it is interrupted
  double realtime_factor{1.0};       ///< simulated seconds a second
  std::string version{};             ///< of the program
  Log* log{nullptr};
  /// Receive the run too, as one: files that keep it. Must outlive it; End is the caller's.
  std::vector<record::RecordSink*> sinks{};
  /// Asked after every step.
  std::function<bool()> interrupted{};
  /// Told why a change was refused.
  std::function<void(const std::string& why)> refused{};
  /// Told what the diagram is warned of: at first, and after a change what is new.
  std::function<void(const std::string& warning)> warned{};
};

struct LiveRunResult {
  double duration;  ///< s, that was simulated
  int changes;      ///< of parameters and places, that took effect
  std::string failure{};
};

/// Runs a diagram in step with the wall clock for whoever looks at `server`. An obstacle that is
/// moved is so at the next tick, by the input `offsets` of its source. A change of a parameter
/// builds the diagram anew, of files as they were read first, on a thread of its own, and the run
/// goes on with it from the state it has at the next tick after that. One that the diagram refuses is undone, and all clients are
/// told why. throws ConfigError if the file cannot be loaded.
LiveRunResult RunLive(const LiveRunOptions& options, LiveServer& server);

}  // namespace oca::live
