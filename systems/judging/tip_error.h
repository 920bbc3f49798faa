// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/systems/sensing/pose_params.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// How far a link is from a pose that it shall have:
///
///     position_error = |p_WL - p_WG|,   rotation_error = |log(R_WL R_WG^T)|
///
/// in    links           LinkPoses
/// out   position        3  m    of the link's origin, world axes
///       position_error  1  m
///       rotation_error  1  rad  at most pi
/// state -
/// throws ConfigError if link is empty or the pose wrong; while running if no pose of the link
///        comes in
/// source models/robot/pose_error.h
class TipError final : public System {
 public:
  static constexpr SystemDoc kDoc{"measures how far a link is from a pose",
                                  "position_error = |p - p_goal|, rotation_error = "
                                  "|log(R R_goal^T)|",
                                  "Sola, Deray, Atchuthan 2018, A micro Lie theory"};
  struct Params {
    std::string link{};
    PoseParams pose{};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example();

  explicit TipError(const Params& params);

 private:
  const models::Name link_;
  const Eigen::Isometry3d X_WG_;
  const Eigen::Isometry3d& PoseOf(const LinkPoses& poses) const;
  void CalcPosition(const LinkPoses& poses, MutableVectorView out) const;
  void CalcPositionError(const LinkPoses& poses, MutableVectorView out) const;
  void CalcRotationError(const LinkPoses& poses, MutableVectorView out) const;

 public:
  const Input<LinkPoses> links;
  const Output<Vector> position;
  const Output<Vector> position_error;
  const Output<Vector> rotation_error;
};

}  // namespace oca::systems
