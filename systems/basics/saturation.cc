// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/saturation.h"

#include <algorithm>
#include <limits>

#include "oca/systems/basics/require.h"
#include "oca/systems/signals/roles.h"

namespace oca::systems {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

const Saturation::Params& Checked(const Saturation::Params& params) {
  Validated(params);
  if (params.lower && params.upper) {
    RequireOrdered("lower", *params.lower, "upper", *params.upper);
  }
  return params;
}

}  // namespace

void Saturation::Params::Describe(Fields<Params>& fields) {
  fields.Add("lower", &Params::lower, "", "smallest output; absent: none");
  fields.Add("upper", &Params::upper, "", "largest output; absent: none");
}

Saturation::Saturation(const Params& params)
    : lower_(Checked(params).lower.value_or(-kUnbounded)),
      upper_(params.upper.value_or(kUnbounded)),
      size_(DeclareSize({{"lower", &lower_}, {"upper", &upper_}})),
      unit_(DeclareUnit()),
      in(DeclareInput<Vector>("in", {size_, unit_})),
      out(DeclareOutput<Vector, &Saturation::CalcOut>("out", {size_, unit_}, in)) {
  const auto declare = [this](Limits::Shown shown, const std::optional<PerComponent>& bound) {
    if (!bound) return;
    const Eigen::VectorXd& values = bound->values();
    DeclareRole(Limits{.shown = shown,
                       .signal = in,
                       .bound = {values.begin(), values.end()},
                       .how = "cut to its bound"});
  };
  declare(Limits::Shown::kBelow, params.lower);
  declare(Limits::Shown::kAbove, params.upper);
}

void Saturation::CalcOut(VectorView in_value, MutableVectorView out_value) const {
  for (Eigen::Index i = 0; i < in_value.size(); ++i) {
    out_value[i] = std::clamp(in_value[i], lower_[i], upper_[i]);
  }
}

}  // namespace oca::systems
