// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "oca/framework/dataflow/per_component.h"
#include "oca/framework/dataflow/signal.h"

namespace oca::systems {

/// The last samples of a vector, a ring; state of Delay.
class DelayLine {
 public:
  /// Makes room for `steps` samples of `size` components, all `initial`.
  void Fill(std::size_t steps, Eigen::Index size, const PerComponent& initial);
  /// Replaces the oldest sample.
  void Push(const Eigen::Ref<const Eigen::VectorXd>& sample);
  bool empty() const { return values_.empty(); }
  VectorView oldest() const { return {values_.data() + next_ * size_, size_}; }
  const std::vector<double>& values() const { return values_; }

 private:
  std::vector<double> values_;  // steps x n, a sample a row
  Eigen::Index size_{0};        // n
  Eigen::Index next_{0};        // the row of the oldest sample
};

}  // namespace oca::systems

namespace oca {

template <>
struct Signal<systems::DelayLine> {
  static constexpr const char* kName = "DelayLine";
  static Fault Check(const systems::DelayLine& line, Look look);
};

}  // namespace oca
