// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "oca/framework/dataflow/params.h"
#include "oca/models/random.h"

namespace oca::sampling {

/// Two numbers, the lower one first, between which something lies.
struct Interval {
  double lower{0.0};
  double upper{0.0};
  double Draw(models::Random& random) const { return random.Uniform(lower, upper); }
};

/// The two numbers of a parameter; a problem at `value` if they are no such pair, or below `least`.
Interval ReadInterval(const Eigen::VectorXd& pair, double least, const Value& value,
                      const std::string& where, Problems& problems);

/// What a number is drawn from: an entry of `sampling.draw`.
///
///     {uniform: [0.4, 1.0]}              all of [0.4, 1.0)
///     {uniform: [0.4, 1.0], step: 0.05}  0.4, 0.45, ..., both ends included
///     {integers: [2, 20]}                2, 3, ..., 20
///     {choose: [0.1, 0.5, 2]}            one of these
struct DistributionParams {
  std::optional<Eigen::VectorXd> uniform{};
  std::optional<double> step{};
  std::optional<Eigen::VectorXd> integers{};
  std::optional<Eigen::VectorXd> choose{};
  static void Describe(Fields<DistributionParams>& fields);
};

class Distribution {
 public:
  /// Problems at `value`: not one kind, no interval, a step that does not fit.
  Distribution(const Value& value, const std::string& where, Problems& problems);

  /// A number at `location`: a double, of `integers` an integer. Grid points are rounded to 1e-12,
  /// so that they print as they are meant.
  Value Draw(models::Random& random, const Location& location) const;

 private:
  DistributionParams params_;
  Interval interval_{};
};

}  // namespace oca::sampling
