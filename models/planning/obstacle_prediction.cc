// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/obstacle_prediction.h"

#include <algorithm>

namespace oca::planning {
namespace {

constexpr double kSameSpeed = 1e-6;     // m/s, rad/s: stands
constexpr double kSamePlace = 1e-4;     // m, of an obstacle that stands
constexpr double kForeseen = 0.005;     // m; that what was foreseen may be wrong by,
constexpr double kForeseenSpan = 0.3;   // s; after so long too
constexpr double kForeseenLever = 0.5;  // m; at which a turn counts

}  // namespace

bool Stands(const geometry::Obstacle& obstacle) {
  return obstacle.linear.norm() < kSameSpeed && obstacle.angular.norm() < kSameSpeed;
}

bool SameStanding(const std::vector<geometry::Obstacle>& seen,
                  const std::vector<geometry::Obstacle>& now) {
  return std::equal(seen.begin(), seen.end(), now.begin(), now.end(),
                    [](const geometry::Obstacle& a, const geometry::Obstacle& b) {
                      return a.body == b.body && Stands(b) && Stands(a) &&
                             (a.X_WO.matrix() - b.X_WO.matrix()).cwiseAbs().maxCoeff() < kSamePlace;
                    });
}

Eigen::Isometry3d Foreseen(const geometry::Obstacle& obstacle, double ahead) {
  Eigen::Isometry3d X = obstacle.X_WO;
  X.translation() += ahead * obstacle.linear;
  const double angle = ahead * obstacle.angular.norm();
  if (angle > 0.0) {
    X.linear() = Eigen::AngleAxisd(angle, obstacle.angular.normalized()) * X.linear();
  }
  return X;
}

bool AsForeseen(const std::vector<geometry::Obstacle>& seen,
                const std::vector<geometry::Obstacle>& now, double since) {
  return std::equal(seen.begin(), seen.end(), now.begin(), now.end(),
                    [&](const geometry::Obstacle& then, const geometry::Obstacle& here) {
                      const Eigen::Isometry3d X = Foreseen(then, since);
                      const double away = (X.translation() - here.X_WO.translation()).norm() +
                                          (X.linear() - here.X_WO.linear()).norm() * kForeseenLever;
                      const double faster = (then.linear - here.linear).norm() +
                                            (then.angular - here.angular).norm() * kForeseenLever;
                      return then.body == here.body && away + kForeseenSpan * faster < kForeseen;
                    });
}

}  // namespace oca::planning
