// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/simulation/signal_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/system.h"
#include "oca/framework/simulation/simulator.h"

namespace oca {

SignalLog::SignalLog(Simulator& simulator, std::vector<OutputHandle> outputs, const Period& period,
                     int capacity)
    : outputs_(std::move(outputs)), capacity_(capacity) {
  if (capacity < 1) {
    throw ConfigError(fmt::format("signal log: capacity; got {} rows; expected > 0", capacity));
  }
  Attach(simulator, period);
  data_.resize(static_cast<std::size_t>(begin_.back()) * static_cast<std::size_t>(capacity));
}

SignalLog::SignalLog(Simulator& simulator, std::vector<OutputHandle> outputs, const Period& period)
    : outputs_(std::move(outputs)) {
  Attach(simulator, period);
}

void SignalLog::Attach(Simulator& simulator, const Period& period) {
  const Diagram& diagram = simulator.diagram();
  begin_.push_back(1);
  for (const OutputHandle& output : outputs_) {
    const int size = diagram.SizeOf(output);
    if (&TypeOfPort(output) != &kVectorType) {
      throw WiringError(fmt::format("signal log: output '{}'; got a {}; expected a Vector",
                                    output.system->outputs()[output.index].name,
                                    TypeOfPort(output).name));
    }
    begin_.push_back(begin_.back() + size);
    for (int i = 0; i < size; ++i) {
      names_.push_back(fmt::format("{}[{}]", diagram.PathOf(output), i));
      units_.push_back(diagram.UnitOf(output).ToString());
    }
  }
  simulator.AddPublish(period, [this](const Context& context) { Sample(context); });
}

void SignalLog::Sample(const Context& context) {
  if (capacity_ == 0) data_.resize(data_.size() + static_cast<std::size_t>(begin_.back()));
  double* const row = data_.data() + static_cast<std::ptrdiff_t>(next_) * begin_.back();
  row[0] = context.time();
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const std::span<const double> values = EvalVector(outputs_[i], context);
    std::copy(values.begin(), values.end(), row + begin_[i]);
  }
  if (++next_ == capacity_) next_ = 0;
  ++written_;
}

int SignalLog::rows() const {
  return static_cast<int>(capacity_ == 0 ? written_ : std::min<std::int64_t>(written_, capacity_));
}

const double* SignalLog::Row(int row) const {
  assert(row >= 0 && row < rows());
  const std::int64_t at = capacity_ == 0 ? row : (overwritten() + row) % capacity_;
  return data_.data() + at * begin_.back();
}

VectorView SignalLog::values(int row, int signal) const {
  const auto i = static_cast<std::size_t>(signal);
  assert(i < outputs_.size());
  return {Row(row) + begin_[i], begin_[i + 1] - begin_[i]};
}

Eigen::VectorXd SignalLog::times() const { return Columns(0, 1); }

Eigen::MatrixXd SignalLog::Matrix() const { return Columns(1, begin_.back() - 1); }

Eigen::MatrixXd SignalLog::Matrix(int signal) const {
  const auto i = static_cast<std::size_t>(signal);
  assert(i < outputs_.size());
  return Columns(begin_[i], begin_[i + 1] - begin_[i]);
}

Eigen::MatrixXd SignalLog::Columns(int first, int count) const {
  Eigen::MatrixXd columns(rows(), count);
  for (int row = 0; row < rows(); ++row) {
    columns.row(row) = VectorView(Row(row) + first, count).transpose();
  }
  return columns;
}

}  // namespace oca
