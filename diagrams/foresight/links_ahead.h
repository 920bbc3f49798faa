// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "oca/diagrams/foresight/motion_ahead.h"
#include "oca/models/planning/band_optimizer.h"
#include "oca/models/robot/link_colliders.h"
#include "oca/models/robot/robot_model.h"

namespace oca::foresight {

/// The links of another robot, or of a frame, along positions that are known for every time (s), in
/// any order. It holds one time: one a thread.
class LinksAhead {
 public:
  /// `positions`: as many numbers as the model has; a model without joints is not asked for them.
  LinksAhead(std::shared_ptr<const robot::RobotModel> model, Positions positions);

  const robot::RobotModel& model() const { return *model_; }
  /// Pose in the world of a link by its number; valid until the next look.
  const Eigen::Isometry3d& X_WL(int link, double time);
  /// Whether no link moves from 0 to `duration`, s, looked at as TimeSteps are.
  bool Stands(double duration);

 private:
  Eigen::VectorXd PositionsAt(double time) const;

  const std::shared_ptr<const robot::RobotModel> model_;
  const Positions positions_;
  double time_{0.0};
  std::vector<Eigen::Isometry3d> X_WL_;
};

/// The solids of a link of `links`, all under `name`; they keep it alive and look at it.
std::vector<planning::BandBody> BodiesOf(const std::shared_ptr<LinksAhead>& links,
                                         const robot::LinkCollider& link, models::Name name,
                                         bool stands);

}  // namespace oca::foresight
