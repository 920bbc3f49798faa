// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/pose_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "oca/models/robot/kinematics.h"
#include "tests/models/robot/random_robot.h"

namespace oca::robot::test {
namespace pose_error_test {

constexpr double kPi = std::numbers::pi;

TEST(PoseErrorTest, IsZeroAtTheGoalAndTheTurnElsewhere) {
  Random random(1);
  const Eigen::Isometry3d X_WG = RandomPose(random);
  EXPECT_LT(PoseError(X_WG, X_WG).norm(), 1e-15);
  for (const double angle : {1e-9, 0.1, 3.0, kPi - 1e-7}) {
    Eigen::Isometry3d X_WL = X_WG;
    const Eigen::Vector3d axis = RandomUnitVector(random);
    X_WL.linear() = Eigen::AngleAxisd(angle, axis) * X_WG.linear();
    X_WL.translation() += Eigen::Vector3d(1.0, 2.0, 3.0);
    const Vector6 error = PoseError(X_WL, X_WG);
    EXPECT_LT((error.head<3>() - Eigen::Vector3d(1.0, 2.0, 3.0)).norm(), 1e-14);
    EXPECT_LT((error.tail<3>() - angle * axis).norm(), 1e-8 * angle + 1e-15) << angle;
  }
}

TEST(PoseErrorTest, HasTheDerivativeThatDifferencesShow) {
  Random random(2);
  constexpr double kStep = 1e-6;
  for (int trial = 0; trial < 20; ++trial) {
    const RobotModel model = RandomRobot(random, 7, trial % 2 == 0);
    const int link = model.num_links() - 1;
    const Eigen::VectorXd q = RandomPositions(model, random);
    const auto X_WL = LinkPoses(model, q);
    Eigen::Isometry3d X_WG = RandomPose(random);
    if (trial < 4) X_WG = X_WL[link];  // at the goal itself
    Eigen::MatrixXd J(6, q.size());
    PoseErrorJacobian(model, X_WL, link, X_WG, J);
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(q.size(), j);
      const Vector6 difference = PoseError(LinkPoses(model, q + step)[link], X_WG) -
                                 PoseError(LinkPoses(model, q - step)[link], X_WG);
      if (difference.norm() > 1.0) continue;  // over the half turn, where the error jumps
      EXPECT_LT((difference / (2.0 * kStep) - J.col(j)).norm(), 1e-6 * (1.0 + J.col(j).norm()));
    }
  }
}

}  // namespace pose_error_test
}  // namespace oca::robot::test
