// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/in_memory.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "oca/framework/dataflow/error.h"

namespace oca::runs {

InMemory::InMemory(std::vector<std::string> signals, const Period& period)
    : signals_(std::move(signals)), period_(period) {}

void InMemory::Prepare(const RunStart& run) {
  if (!period_.positive()) {
    throw ConfigError(
        fmt::format("series: period; got {} s; expected more than 0", period_.seconds()));
  }
  for (const std::string& signal : signals_) {
    try {
      run.loaded.diagram->GetOutput<Vector>(signal);
    } catch (const Error& error) {
      throw ConfigError(fmt::format("series: {}: {}", signal, error.what()));
    }
  }
}

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

/// What each log has, one below the other; without a row whose time the log before it has.
template <class Part>
Eigen::MatrixXd InMemory::Stack(const Part& part) const {
  Eigen::MatrixXd all = part(first());
  double last = first().rows() > 0 ? first().time(first().rows() - 1) : -1.0;
  for (std::size_t i = 1; i < logs_.size(); ++i) {
    const SignalLog& log = *logs_[i];
    if (log.rows() == 0) continue;
    const Eigen::Index more = log.rows() - (log.time(0) == last ? 1 : 0);
    all.conservativeResize(all.rows() + more, Eigen::NoChange);
    all.bottomRows(more) = part(log).bottomRows(more);
    last = log.time(log.rows() - 1);
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
