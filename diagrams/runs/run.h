// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/run_output.h"
#include "oca/diagrams/runs/run_result.h"
#include "oca/framework/dataflow/log.h"

namespace oca::runs {

/// A run while it stands still between two steps.
class RunControl {
 public:
  virtual ~RunControl() = default;
  virtual Context& context() = 0;
  /// The run goes on with `next` from its time and its states.
  /// throws ConfigError or SimulationError if it cannot; nothing is changed then.
  virtual void Replace(std::shared_ptr<const loading::LoadedDiagram> next) = 0;
  /// What all outputs show the diagram to be warned of.
  virtual void SetWarnings(const std::vector<std::string>& warnings) = 0;
};

/// Changes a run while it goes on. All calls are on the run's thread.
class RunHook {
 public:
  virtual ~RunHook() = default;
  /// Before a diagram is initialized: fixes the inputs that nothing drives.
  virtual void Prepare(const loading::LoadedDiagram& loaded, Context& context) = 0;
  /// After each step: whether the run is to stand still for Change.
  virtual bool WantsChange() = 0;
  /// Nothing may leave it as an exception but what ends the run.
  virtual void Change(RunControl& run) = 0;
};

struct RunOptions {
  std::optional<double> duration{};         ///< s; instead of the file's
  std::optional<double> realtime_factor{};  ///< instead of the file's; 0 as fast as possible
  bool profile{false};                      ///< measure what each system takes
  bool judge{true};   ///< look at what the file expects; false: of a run that has no end of its own
  Log* log{nullptr};  ///< receives what systems log
  /// Called after each step with the time; returning false interrupts the run.
  std::function<bool(double time)> progress{};
  /// What is made of it, in this order: Csv, InMemory, record::Record, record::Report, ... Must
  /// outlive it.
  std::vector<RunOutput*> outputs{};
  /// Files that no output may replace, beside those that the diagram was made from.
  std::vector<InputFile> inputs{};
  RunHook* hook{nullptr};
};

/// What the diagram's judges say by now, one a system; empty if one cannot be computed.
/// throws WiringError if what a judge calls its metrics are none.
std::vector<Judgement> JudgementsOf(const loading::LoadedDiagram& loaded, const Context& context);
/// The same of some judges.
std::vector<Judgement> JudgementsOf(const files::NamedOutputs& judges, const Context& context);

/// Refuses outputs that would replace a file that the run is made from, or one another.
/// throws ConfigError naming the two
void CheckRunFiles(const loading::LoadedDiagram& loaded, const RunOptions& options);

/// Runs a loaded diagram from time 0. A contact that no expectation allows is an expectation that
/// was not met: `min_distance > 0` joins the others. A calculation that fails ends the run with
/// `failure`, and so is an output told of that could not be written to the end; what was recorded
/// and measured up to there is kept. throws ConfigError before anything is written as CheckRunFiles
/// does, if the duration or the realtime factor is out of bounds, if an output cannot be made or
/// the simulator's options are wrong.
RunResult Run(const loading::LoadedDiagram& loaded, const RunOptions& options);

}  // namespace oca::runs
