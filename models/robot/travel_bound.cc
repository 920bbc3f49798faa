// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/travel_bound.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "oca/models/geometry/collider.h"

namespace oca::robot {

TravelBound::TravelBound(const RobotModel& model) : model_(&model) {
  for (int link = 0; link < model.num_links(); ++link) {
    for (const CollisionElement& element : model.links()[link].collisions) {
      const geometry::Collider collider(element.shape, element.source);
      balls_.push_back({link, element.X_LC * collider.centre(), collider.bounding_radius()});
    }
  }
}

void TravelBound::Calc(std::span<const Eigen::Isometry3d> X_WL,
                       const Eigen::Ref<const Eigen::VectorXd>& path,
                       std::span<double> travel) const {
  assert(std::ssize(X_WL) == model_->num_links());
  assert(std::ssize(travel) == model_->num_links());
  assert(path.size() == model_->num_positions());
  std::fill(travel.begin(), travel.end(), 0.0);
  for (const Ball& ball : balls_) {
    double& most = travel[static_cast<std::size_t>(ball.link)];
    most = std::max(most, TravelOf(ball, 0, X_WL, path));
  }
}

double TravelBound::TravelOf(const Ball& ball, int root, std::span<const Eigen::Isometry3d> X_WL,
                             const Eigen::Ref<const Eigen::VectorXd>& path) const {
  const Eigen::Vector3d centre = X_WL[static_cast<std::size_t>(ball.link)] * ball.centre;
  double sum = 0.0;
  for (int link = ball.link; link > root;) {
    const KinematicStep& step = model_->steps()[static_cast<std::size_t>(link - 1)];
    if (step.column >= 0) {
      const double moved = std::abs(step.multiplier) * path[step.column];
      if (step.type == JointType::kPrismatic) {
        sum += moved;
      } else {
        const Eigen::Isometry3d& X = X_WL[static_cast<std::size_t>(link)];
        const Eigen::Vector3d axis = X.linear() * step.axis;
        const double arm = axis.cross(centre - X.translation()).norm() + ball.radius;
        sum += moved * (arm + sum);
      }
    }
    link = step.parent_link;
  }
  return sum;
}

double TravelBound::Between(std::span<const Eigen::Isometry3d> X_WL,
                            const Eigen::Ref<const Eigen::VectorXd>& path, int link,
                            int other) const {
  int root = link;
  for (int last = other; root != last;) {  // parents come before their children
    int& later = root > last ? root : last;
    later = model_->steps()[static_cast<std::size_t>(later - 1)].parent_link;
  }
  double travel[2] = {0.0, 0.0};
  for (const Ball& ball : balls_) {
    if (ball.link != link && ball.link != other) continue;
    double& most = travel[ball.link == link ? 0 : 1];
    most = std::max(most, TravelOf(ball, root, X_WL, path));
  }
  return travel[0] + travel[1];
}

double LeastDistanceBetween(double before, double after, double travel) {
  return std::min({before, after, 0.5 * (before + after - travel)});
}

}  // namespace oca::robot
