// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/delay_line.h"

namespace oca::systems {

void DelayLine::Fill(std::size_t steps, Eigen::Index size, const PerComponent& initial) {
  size_ = size;
  next_ = 0;
  values_.clear();
  values_.reserve(steps * static_cast<std::size_t>(size));
  for (std::size_t step = 0; step < steps; ++step) {
    for (Eigen::Index i = 0; i < size; ++i) values_.push_back(initial[i]);
  }
}

void DelayLine::Push(const Eigen::Ref<const Eigen::VectorXd>& sample) {
  MutableVectorView(values_.data() + next_ * size_, size_) = sample;
  next_ = (next_ + 1) * size_ == static_cast<Eigen::Index>(values_.size()) ? 0 : next_ + 1;
}

}  // namespace oca::systems

namespace oca {

Fault Signal<systems::DelayLine>::Check(const systems::DelayLine& line, Look /*look*/) {
  return Fault::UnlessFinite(AllFinite(line.values().data(), line.values().size()));
}

}  // namespace oca
