// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sweep/step_times.h"

#include <algorithm>
#include <cmath>

namespace oca::sweep {
namespace {

constexpr double kLeast = 1e-8;  // s
constexpr double kMost = 1e2;    // s
const double kWidth = std::log(1.02);

}  // namespace

void StepTimes::Add(double seconds) {
  const double within = std::clamp(seconds, kLeast, kMost);
  AddClass(static_cast<int>(std::log(within / kLeast) / kWidth), 1);
  RaiseMax(seconds);
}

void StepTimes::Add(const StepTimes& other) {
  for (const auto& [number, count] : other.classes_) AddClass(number, count);
  RaiseMax(other.max_);
}

void StepTimes::AddClass(int number, std::int64_t count) {
  classes_[number] += count;
  count_ += count;
}

void StepTimes::RaiseMax(double seconds) { max_ = std::max(max_, seconds); }

double StepTimes::Quantile(double q) const {
  if (count_ == 0) return 0.0;
  const auto wanted = std::max(1.0, std::ceil(q * static_cast<double>(count_)));
  std::int64_t so_far = 0;
  for (const auto& [number, count] : classes_) {
    so_far += count;
    if (static_cast<double>(so_far) < wanted) continue;
    return std::min(max_, kLeast * std::exp((number + 0.5) * kWidth));
  }
  return max_;
}

}  // namespace oca::sweep
