// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/systems/signals/model_set.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// Poses of all links of a robot from the positions of its joints: X_WL = X_WB X_B1(q) ...
/// Everything else that follows from a configuration (screws, Jacobians) follows from the poses.
/// With `velocity` connected the links carry their velocities too: J(q) velocity. Robots that keep
/// away from this one need them.
///
/// in    position  n  rad, m      one a joint that has a position
/// in    velocity  n  rad/s, m/s  optional
/// out   links     LinkPoses      all links, parents first
/// state -
/// throws ConfigError if there is no such model or it has no movable joint; at the start of a run
///        if `position` is no state of the robot: see robot::ImpossibleState
class RobotKinematics final : public System {
 public:
  static constexpr SystemDoc kDoc{"computes the poses of a robot's links",
                                  "X_WL = X_WP X_PJ exp(axis q), from the base to the tips", ""};
  struct Params {
    std::string model{};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {}; }

  RobotKinematics(const Params& params, const ModelSet& models);

 private:
  const std::shared_ptr<const robot::RobotModel> model_;
  void CheckStart(VectorView q) const;
  void CalcLinks(VectorView q, std::optional<VectorView> qdot, LinkPoses& poses) const;

 public:
  const Input<Vector> position;
  const OptionalInput<Vector> velocity;
  const Output<LinkPoses> links;
};

}  // namespace oca::systems
