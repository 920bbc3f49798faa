// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"

namespace oca::systems {

/// Adds and subtracts vectors: out = sum_i signs_i in_i.
///
/// Give `signs`, a list of +1 and -1, one an input; or `inputs`, their number, all counted +1; or
/// neither for two inputs counted +1.
///
/// in    in0, in1, ...  n  u   at most kMostInputs
/// out   out            n  u
/// state -
/// throws ConfigError if both signs and inputs are given, a sign is not +1 or -1, or there are
///        not 1 to kMostInputs inputs
class Sum final : public System {
 public:
  static constexpr int kMostInputs = 8;
  static constexpr SystemDoc kDoc{"adds and subtracts vectors", "out = sum_i signs_i in_i", ""};
  struct Params {
    Eigen::VectorXd signs{};
    int inputs{0};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.signs = Eigen::Vector2d(1.0, -1.0)}; }

  explicit Sum(const Params& params);

 private:
  const Eigen::VectorXd signs_;
  const Size size_;
  const Unit unit_;

  std::vector<Input<Vector>> DeclareInputs();
  template <std::size_t... kIndices>
  Output<Vector> DeclareSumOf(std::index_sequence<kIndices...>);
  /// The sum of as many inputs as there are signs.
  template <std::size_t kCount>
  Output<Vector> DeclareSum();
  template <class... Views>
  void CalcOut(Views... inputs, MutableVectorView sum) const;

 public:
  const std::vector<Input<Vector>> in;  ///< in0, in1, ...
  const Output<Vector> out;
};

}  // namespace oca::systems
