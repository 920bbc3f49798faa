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
  for (const LinkBall& ball : balls_) {
    double& most = travel[static_cast<std::size_t>(ball.link)];
    most = std::max(most, TravelFrom(0, ball, X_WL, path));
  }
}

void TravelBound::CalcApproach(std::span<const Eigen::Isometry3d> X_WL,
                               const Eigen::Ref<const Eigen::VectorXd>& path,
                               std::span<const std::pair<int, int>> pairs,
                               std::span<double> approach) const {
  assert(std::ssize(X_WL) == model_->num_links());
  assert(approach.size() == pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const int carrier = CarrierOf(pairs[i].first, pairs[i].second);
    approach[i] = 0.0;
    for (const int link : {pairs[i].first, pairs[i].second}) {
      double most = 0.0;
      for (const LinkBall& ball : balls_) {
        if (ball.link == link) most = std::max(most, TravelFrom(carrier, ball, X_WL, path));
      }
      approach[i] += most;
    }
  }
}

/// Links are numbered parents first.
int TravelBound::CarrierOf(int link, int other) const {
  while (link != other) {
    int& higher = link > other ? link : other;
    higher = model_->steps()[static_cast<std::size_t>(higher - 1)].parent_link;
  }
  return link;
}

double TravelBound::TravelFrom(int carrier, const LinkBall& ball,
                               std::span<const Eigen::Isometry3d> X_WL,
                               const Eigen::Ref<const Eigen::VectorXd>& path) const {
  const Eigen::Vector3d centre = X_WL[static_cast<std::size_t>(ball.link)] * ball.centre;
  double sum = 0.0;
  for (int link = ball.link; link > carrier;) {
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

double LeastDistanceBetween(double before, double after, double travel) {
  return std::min({before, after, 0.5 * (before + after - travel)});
}

}  // namespace oca::robot
