// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "oca/diagrams/files/catalogue.h"
#include "oca/systems/signals/model_set.h"

namespace oca::runs {

/// One system on its own. A line's inputs are held; `time` moves the clock there first. If the
/// system has discrete updates a line is one period, the tick after that of the line before:
/// computed outputs are shown as the updates of the line's tick read them, held ones as the period
/// leaves them.
class Evaluator {
 public:
  /// `row` must outlive it. throws ConfigError if the parameters are wrong.
  Evaluator(const files::CatalogueRow& row, const Value& params, systems::ModelSet models);
  ~Evaluator();
  Evaluator(const Evaluator&) = delete;
  Evaluator& operator=(const Evaluator&) = delete;

  /// A JSON object of inputs by port name, perhaps with `time` (s); answers with one of outputs.
  /// throws ConfigError, WiringError or SimulationError if the line makes no sense; everything is
  ///        as before then.
  std::string Serve(const std::string& line);

 private:
  class Bench;
  const std::unique_ptr<Bench> bench_;
};

}  // namespace oca::runs
