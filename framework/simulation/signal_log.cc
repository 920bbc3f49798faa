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
  begin_.push_back(1);
  for (const OutputHandle& output : outputs_) {
    const int size = simulator.diagram().SizeOf(output);
    if (&TypeOfPort(output) != &kVectorType) {
      throw WiringError(
          {fmt::format("signal log: output '{}'; got a {}; expected a Vector",
                       output.system->outputs()[output.index].name, TypeOfPort(output).name)});
    }
    begin_.push_back(begin_.back() + size);
  }
  data_.resize(static_cast<std::size_t>(begin_.back()) * static_cast<std::size_t>(capacity));
  simulator.AddPublish(period, [this](const Context& context) { Sample(context); });
}

void SignalLog::Sample(const Context& context) {
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
  return static_cast<int>(std::min<std::int64_t>(written_, capacity_));
}

const double* SignalLog::Row(int row) const {
  assert(row >= 0 && row < rows());
  const std::int64_t at = (overwritten() + row) % capacity_;
  return data_.data() + at * begin_.back();
}

VectorView SignalLog::values(int row, int signal) const {
  const auto i = static_cast<std::size_t>(signal);
  assert(i < outputs_.size());
  return {Row(row) + begin_[i], begin_[i + 1] - begin_[i]};
}

}  // namespace oca
