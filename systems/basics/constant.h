// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"

namespace oca::systems {

/// A vector that never changes: value = value.
///
/// in    -
/// out   value  n  `unit`
/// state -
/// throws ConfigError if a number is not finite or the list is empty
class Constant final : public System {
 public:
  static constexpr SystemDoc kDoc{"a vector that never changes", "value = value", ""};
  struct Params {
    PerComponent value{0.0};
    std::string unit{};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.value = Eigen::VectorXd(Eigen::Vector2d(1.0, -2.0))}; }

  explicit Constant(const Params& params);

 private:
  const Params params_;
  void CalcValue(MutableVectorView out) const;

 public:
  const Output<Vector> value;
};

}  // namespace oca::systems
