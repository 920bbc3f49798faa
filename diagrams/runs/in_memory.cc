// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/in_memory.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "oca/framework/dataflow/error.h"

namespace oca::runs {

InMemory::InMemory(std::vector<std::string> signals, const Period& period)
    : signals_(std::move(signals)), period_(period) {}

void InMemory::Begin(const RunStart& run) {
  if (!run.continued) logs_.clear();
  std::vector<OutputHandle> outputs;
  for (const std::string& signal : signals_) {
    outputs.push_back(run.loaded.diagram->FindOutput(signal));
  }
  logs_.push_back(std::make_unique<SignalLog>(run.simulator, std::move(outputs), period_));
}

const SignalLog& InMemory::first() const {
  if (!logs_.empty()) return *logs_.front();
  throw ConfigError("series: run; got none yet; expected one that has this as an output");
}

/// What each log has, one below the other.
template <class Part>
Eigen::MatrixXd InMemory::Stack(const Part& part) const {
  Eigen::MatrixXd all = part(first());
  for (std::size_t i = 1; i < logs_.size(); ++i) {
    const Eigen::MatrixXd more = part(*logs_[i]);
    all.conservativeResize(all.rows() + more.rows(), Eigen::NoChange);
    all.bottomRows(more.rows()) = more;
  }
  return all;
}

Eigen::VectorXd InMemory::times() const {
  return Stack([](const SignalLog& log) -> Eigen::MatrixXd { return log.times(); });
}

Eigen::MatrixXd InMemory::Matrix() const {
  return Stack([](const SignalLog& log) { return log.Matrix(); });
}

Eigen::MatrixXd InMemory::Matrix(const std::string& signal) const {
  const auto found = std::find(signals_.begin(), signals_.end(), signal);
  if (found == signals_.end()) {
    throw ConfigError(fmt::format("series: signal; got '{}'; expected one of {}", signal,
                                  fmt::join(signals_, ", ")));
  }
  const auto number = static_cast<int>(found - signals_.begin());
  return Stack([number](const SignalLog& log) { return log.Matrix(number); });
}

const std::vector<std::string>& InMemory::names() const { return first().names(); }
const std::vector<std::string>& InMemory::units() const { return first().units(); }

}  // namespace oca::runs
