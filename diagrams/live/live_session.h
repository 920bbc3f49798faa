// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/record/run_recorder.h"
#include "oca/diagrams/runs/run.h"
#include "oca/framework/simulation/simulator.h"

namespace oca::live {

/// How long a run lasts that somebody looks at and no file ends, s.
inline constexpr double kLiveDuration = 1e6;

/// Where obstacles were moved to from where the file has them, m, by the names of their positions.
using Moves = std::map<std::string, Eigen::Vector3d>;

/// A diagram while it runs, with what shows it; a change of parameters makes the next one of it.
class LiveSession {
 public:
  LiveSession(loading::LoadedDiagram loaded, record::RecorderOptions options,
              std::vector<record::RecordSink*> sinks, double realtime_factor, Log* log);
  ~LiveSession() { End({}); }
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;

  void Start(Simulator::Monitor monitor);
  /// Takes over time and states. throws ConfigError or SimulationError if it cannot go on from
  /// them.
  void Adopt(const LiveSession& previous);
  /// As Start, where another session is now; that one must have ended.
  void StartFrom(const LiveSession& previous, Simulator::Monitor monitor);
  /// No more is recorded. `result` says how the run ended; none of a run that goes on has metrics.
  void End(runs::RunResult result);
  /// Puts obstacles where they were moved to, and all others where the file has them.
  void Place(const Moves& moves);
  /// What the diagram is warned of from now on.
  void SetWarnings(const std::vector<std::string>& warnings) { recorder_.SetWarnings(warnings); }

  Simulator& simulator() { return simulator_; }
  const loading::LoadedDiagram& loaded() const { return *loaded_; }
  const std::shared_ptr<const loading::LoadedDiagram>& shared_diagram() const { return loaded_; }

 private:
  void AdoptFrom(const LiveSession& previous, const Context& from, Context& to) const;

  std::shared_ptr<const loading::LoadedDiagram> loaded_;
  record::RunRecorder recorder_;
  Simulator simulator_;
  bool attached_{false};
};

}  // namespace oca::live
