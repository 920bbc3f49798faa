// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/avoidance_velocity.h"

#include <gtest/gtest.h>

#include "oca/models/error.h"
#include "tests/models/robot/law_scene.h"

namespace oca::robot::test {
namespace avoidance_velocity_test {

TEST(AvoidanceVelocityTest, ARowIsTheSlopeOfTheDistance) {
  const RobotModel model = LoadUrdf(OCA_SOURCE_DIR "/models/robots/planar2/planar2.urdf");
  const auto X_WL = LinkPoses(model, Eigen::Vector2d::Zero());
  const auto row = DistanceRow(model, X_WL, Above("planar2_link_2", 0.9, 0.1));
  EXPECT_NEAR((Eigen::VectorXd(row) - Eigen::Vector2d(-0.9, -0.4)).norm(), 0.0, 1e-15);
  EXPECT_THROW(DistanceRow(model, X_WL, Above("nose", 0.9, 0.1)), models::ModelError);
}

TEST(AvoidanceVelocityTest, BetweenTwoLinksTheJointsThatCarryBothDoNotCount) {
  const RobotModel model = LoadUrdf(OCA_SOURCE_DIR "/models/robots/planar2/planar2.urdf");
  const auto X_WL = LinkPoses(model, Eigen::Vector2d::Zero());
  Proximity own = Above("planar2_link_2", 0.9, 0.1);
  own.own_link = models::Name("planar2_link_1");
  EXPECT_NEAR(DistanceRow(model, X_WL, own)[0], 0.0, 1e-15);
  EXPECT_NEAR(DistanceRow(model, X_WL, own)[1], -0.4, 1e-15);
}

}  // namespace avoidance_velocity_test
}  // namespace oca::robot::test
