// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/models/robot/jacobian_mapping.h"
#include "oca/systems/signals/model_set.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// Maps wrenches on the links of a robot to an offset of its joint positions:
///
///     transpose       delta = alpha J^T w
///     pseudo_inverse  delta = alpha (J^T J)^-1 J^T w
///     damped          delta = alpha (J^T J + damping^2 I)^-1 J^T w
///
/// J stacks the Jacobians of all bodies, 42 x 7 for an arm of seven joints, and w their wrenches;
/// a body without a wrench contributes zeros ("do not move"), which makes the pseudo-inverse's
/// deltas smaller than the transpose's. A wrench (N, Nm) is used as a displacement; alpha absorbs
/// the unit.
///
/// in    wrenches  WrenchSet   N, Nm  world axes, about any origin; several on a link add up
/// in    links     LinkPoses
/// out   delta        n  rad, m
/// out   regularised  1   1 where joints cannot be told apart in doubles (their columns of J lie
///                        within about 1e-6 rad, as of an arm of 1,000 km), so that the inverse had
///                        to be damped for it; else 0
/// state -
/// throws ConfigError if there is no such model, alpha is not finite, damping is negative or, in
///        method damped, 0; while running if a wrench or a pose is of no link of the model
/// source report eq. (2.9), (2.12), (3.4); docs/theory.md
class JacobianMapping final : public System {
 public:
  static constexpr SystemDoc kDoc{
      "maps wrenches on links to an offset of the joint positions",
      "delta = alpha J^T w | alpha (J^T J)^-1 J^T w | alpha (J^T J + damping^2 I)^-1 J^T w",
      "Jain, Sixt, Exner 2016, eq. (2.9), (2.12), section 3.4"};
  enum class Method { kTranspose, kPseudoInverse, kDamped };
  friend std::span<const char* const> EnumNames(Method) {
    static constexpr std::array kNames{"transpose", "pseudo_inverse", "damped"};
    return kNames;
  }
  struct Params {
    std::string model{};
    double alpha{1.0};
    Method method{Method::kPseudoInverse};
    double damping{0.1};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {}; }

  JacobianMapping(const Params& params, const ModelSet& models);

 private:
  const Params params_;
  const std::shared_ptr<const robot::RobotModel> model_;
  const robot::MappingSettings settings_;
  struct Solution;
  void CalcSolution(const WrenchSet& wrench_set, const LinkPoses& poses, Solution& result) const;

 public:
  const Input<WrenchSet> wrenches;
  const Input<LinkPoses> links;

 private:
  const Cached<Solution> solution_;

 public:
  const Output<Vector> delta;
  const Output<Vector> regularised;
};

/// What the mathematics needs of the parameters. throws ConfigError as JacobianMapping does
robot::MappingSettings MappingSettingsOf(const JacobianMapping::Params& params);

}  // namespace oca::systems
