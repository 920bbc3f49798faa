// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/foresight/links_ahead.h"

#include <utility>

#include "oca/diagrams/foresight/time_steps.h"
#include "oca/models/robot/kinematics.h"

namespace oca::foresight {

LinksAhead::LinksAhead(std::shared_ptr<const robot::RobotModel> model, Positions positions)
    : model_(std::move(model)),
      positions_(std::move(positions)),
      X_WL_(robot::LinkPoses(*model_, PositionsAt(0.0))) {}

Eigen::VectorXd LinksAhead::PositionsAt(double time) const {
  return model_->num_positions() == 0 ? Eigen::VectorXd(0) : positions_(time);
}

const Eigen::Isometry3d& LinksAhead::X_WL(int link, double time) {
  if (time != time_) {
    robot::ForwardKinematics(*model_, PositionsAt(time), X_WL_);
    time_ = time;
  }
  return X_WL_[static_cast<std::size_t>(link)];
}

bool LinksAhead::Stands(double duration) {
  if (model_->num_positions() == 0) return true;
  const Eigen::VectorXd first = positions_(0.0);
  const TimeSteps steps(duration);
  for (long k = 1; k < steps.size(); ++k) {
    if (positions_(steps[k]) != first) return false;
  }
  return true;
}

std::vector<planning::BandBody> BodiesOf(const std::shared_ptr<LinksAhead>& links,
                                         const robot::LinkCollider& link, models::Name name,
                                         bool stands) {
  std::vector<planning::BandBody> bodies;
  for (const auto& element : link.elements) {
    const auto pose = [links, number = link.number, X_LC = element.X_LC](double time) {
      return Eigen::Isometry3d(links->X_WL(number, time) * X_LC);
    };
    bodies.push_back({name, element.collider, pose, stands});
  }
  return bodies;
}

}  // namespace oca::foresight
