// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/output_files.h"
#include "oca/diagrams/runs/run_result.h"
#include "oca/framework/dataflow/log.h"
#include "oca/framework/simulation/simulator.h"

namespace oca::runs {

/// A run that is about to begin, or to go on with another diagram.
struct RunStart {
  const loading::LoadedDiagram& loaded;
  Simulator& simulator;  ///< not initialized yet, so that publishes can be added
  bool paced;            ///< by the wall clock, which nobody may hold up
  double duration;       ///< s, to the end of the run
  bool continued;        ///< the run began with another diagram; states and time go on
};

/// Something that is made of a run: a record, a report, tables, matrices. An output is given to a
/// run by RunOptions, outlives it, and may be given to a second one, whose it then is.
class RunOutput {
 public:
  virtual ~RunOutput() = default;
  /// The files that it is going to write.
  virtual std::vector<OutputFile> Files(const loading::LoadedDiagram& /*loaded*/) const {
    return {};
  }
  /// Before any output of the run begins: nothing is written yet. throws ConfigError if this output
  /// cannot be made.
  virtual void Prepare(const RunStart& /*run*/) {}
  /// Before the first step. What was there before is replaced from now on.
  virtual void Begin(const RunStart& run) = 0;
  /// The diagram of Begin is about to go; the next Begin has the one that takes its place.
  virtual void Pause() {}
  /// What the diagram is warned of from now on.
  virtual void SetWarnings(const std::vector<std::string>& /*warnings*/) {}
  /// After the last step; a run that failed ends in its last state before that.
  /// throws Error if it could not be written to the end.
  virtual void End(const RunResult& result) = 0;
  /// Takes what systems log too, from kInfo on; nullptr if it does not.
  virtual Log* log() { return nullptr; }
};

}  // namespace oca::runs
