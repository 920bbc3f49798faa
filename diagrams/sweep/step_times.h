// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>

namespace oca::sweep {

/// How long the steps of a run took, as a histogram with classes of 2 %, so that the times of many
/// runs add up. Times below 10 ns and above 100 s count as these.
class StepTimes {
 public:
  void Add(double seconds);
  void Add(const StepTimes& other);
  /// `count` steps of a class that another histogram lists.
  void AddClass(int number, std::int64_t count);
  void RaiseMax(double seconds);

  std::int64_t count() const { return count_; }
  double max() const { return max_; }
  /// To 1 %; 0 without a step.
  double Quantile(double q) const;
  /// Class -> number of steps in it.
  const std::map<int, std::int64_t>& classes() const { return classes_; }

 private:
  std::map<int, std::int64_t> classes_;
  std::int64_t count_{0};
  double max_{0.0};
};

}  // namespace oca::sweep
