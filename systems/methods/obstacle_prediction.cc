// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/obstacle_prediction.h"

#include <algorithm>

namespace oca::systems {
namespace {

constexpr double kSameSpeed = 1e-6;     // m/s, rad/s: stands
constexpr double kSamePlace = 1e-4;     // m, of an obstacle that stands
constexpr double kForeseen = 0.005;     // m; that what was foreseen may be wrong by,
constexpr double kForeseenSpan = 0.3;   // s; after so long too
constexpr double kForeseenLever = 0.5;  // m; at which a turn counts

}  // namespace

bool Stands(const Obstacle& obstacle) {
  return obstacle.linear.norm() < kSameSpeed && obstacle.angular.norm() < kSameSpeed;
}

bool SameStanding(const std::vector<Obstacle>& seen, const std::vector<Obstacle>& now) {
  return std::equal(seen.begin(), seen.end(), now.begin(), now.end(),
                    [](const Obstacle& a, const Obstacle& b) {
                      return a.body == b.body && Stands(b) && Stands(a) &&
                             (a.X_WO.matrix() - b.X_WO.matrix()).cwiseAbs().maxCoeff() < kSamePlace;
                    });
}

Eigen::Isometry3d Foreseen(const Obstacle& obstacle, double ahead) {
  Eigen::Isometry3d X = obstacle.X_WO;
  X.translation() += ahead * obstacle.linear;
  const double angle = ahead * obstacle.angular.norm();
  if (angle > 0.0) {
    X.linear() = Eigen::AngleAxisd(angle, obstacle.angular.normalized()) * X.linear();
  }
  return X;
}

bool AsForeseen(const std::vector<Obstacle>& seen, const std::vector<Obstacle>& now, double since) {
  return std::equal(seen.begin(), seen.end(), now.begin(), now.end(),
                    [&](const Obstacle& then, const Obstacle& here) {
                      const Eigen::Isometry3d X = Foreseen(then, since);
                      const double away = (X.translation() - here.X_WO.translation()).norm() +
                                          (X.linear() - here.X_WO.linear()).norm() * kForeseenLever;
                      const double faster = (then.linear - here.linear).norm() +
                                            (then.angular - here.angular).norm() * kForeseenLever;
                      return then.body == here.body && away + kForeseenSpan * faster < kForeseen;
                    });
}

}  // namespace oca::systems
