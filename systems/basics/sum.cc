// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/sum.h"

#include <fmt/format.h>

#include <string>

#include "oca/framework/dataflow/error.h"

namespace oca::systems {
namespace {

template <std::size_t>
using ViewAt = VectorView;

Eigen::VectorXd SignsOf(const Sum::Params& params) {
  Validated(params);
  // Neither given: two inputs, the common case.
  const Eigen::Index unsigned_count = params.inputs == 0 ? 2 : params.inputs;
  const Eigen::Index count = params.signs.size() > 0 ? params.signs.size() : unsigned_count;
  if (params.signs.size() > 0 && params.inputs != 0) {
    throw ConfigError("inputs: given twice; got signs too; expected one of the two");
  }
  if (count < 1 || count > Sum::kMostInputs) {
    throw ConfigError(fmt::format("{}: number of inputs; got {}; expected 1 to {}",
                                  params.signs.size() > 0 ? "signs" : "inputs", count,
                                  Sum::kMostInputs));
  }
  for (Eigen::Index i = 0; i < params.signs.size(); ++i) {
    if (params.signs[i] == 1.0 || params.signs[i] == -1.0) continue;
    throw ConfigError(
        fmt::format("signs[{}]: no sign; got {}; expected +1 or -1", i, params.signs[i]));
  }
  return params.signs.size() > 0 ? params.signs : Eigen::VectorXd::Ones(count);
}

}  // namespace

void Sum::Params::Describe(Fields<Params>& fields) {
  fields.Add("signs", &Params::signs, "", "+1 or -1 for each input").AtLeast(-1.0).AtMost(1.0);
  fields
      .Add("inputs", &Params::inputs, "",
           "number of inputs, all counted +1, instead of signs; 0: two")
      .AtLeast(0)
      .AtMost(kMostInputs);
}

Sum::Sum(const Params& params)
    : signs_(SignsOf(params)),
      size_(DeclareSize()),
      unit_(DeclareUnit()),
      in(DeclareInputs()),
      out(DeclareSum<kMostInputs>()) {}

std::vector<Input<Vector>> Sum::DeclareInputs() {
  std::vector<Input<Vector>> inputs;
  for (Eigen::Index i = 0; i < signs_.size(); ++i) {
    inputs.push_back(DeclareInput<Vector>("in" + std::to_string(i), {size_, unit_}));
  }
  return inputs;
}

template <std::size_t... kIndices>
Output<Vector> Sum::DeclareSumOf(std::index_sequence<kIndices...>) {
  return DeclareOutput<Vector, &Sum::CalcOut<ViewAt<kIndices>...>>("out", {size_, unit_},
                                                                   in[kIndices]...);
}

template <std::size_t kCount>
Output<Vector> Sum::DeclareSum() {
  if constexpr (kCount > 1) {
    if (in.size() < kCount) return DeclareSum<kCount - 1>();
  }
  return DeclareSumOf(std::make_index_sequence<kCount>());
}

template <class... Views>
void Sum::CalcOut(Views... inputs, MutableVectorView sum) const {
  sum.setZero();
  Eigen::Index i = 0;
  ((sum += signs_[i++] * inputs), ...);
}

}  // namespace oca::systems
