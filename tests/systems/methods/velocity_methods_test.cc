// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/velocity_methods.h"

#include <gtest/gtest.h>

#include "oca/framework/dataflow/error.h"
#include "oca/models/error.h"
#include "tests/systems/method_scene.h"

namespace oca::systems {
namespace velocity_methods_test {

TEST(VelocityMethodsTest, TheLastLinkIsTheTipUnlessOneIsNamed) {
  const auto model = LoadTestModel("planar2");
  EXPECT_EQ(model->links()[TipNumber(*model, "")].name.text(), "planar2_tip");
  EXPECT_EQ(model->links()[TipNumber(*model, "planar2_link_1")].name.text(), "planar2_link_1");
  EXPECT_THROW(TipNumber(*model, "nose"), ConfigError);
}

TEST(VelocityMethodsTest, ARowIsTheSlopeOfTheDistance) {
  const auto model = LoadTestModel("planar2");
  const LinkPoses poses = PosesOf(*model, Eigen::Vector2d::Zero());
  const auto row = RowOf(*model, poses.poses, Above("planar2_link_2", 0.9, 0.1));
  EXPECT_NEAR((Eigen::VectorXd(row) - Eigen::Vector2d(-0.9, -0.4)).norm(), 0.0, 1e-15);
  EXPECT_THROW(RowOf(*model, poses.poses, Above("nose", 0.9, 0.1)), models::ModelError);
}

TEST(VelocityMethodsTest, BetweenTwoLinksTheJointsThatCarryBothDoNotCount) {
  const auto model = LoadTestModel("planar2");
  const LinkPoses poses = PosesOf(*model, Eigen::Vector2d::Zero());
  Proximity own = Above("planar2_link_2", 0.9, 0.1);
  own.own_link = models::Name("planar2_link_1");
  EXPECT_NEAR(RowOf(*model, poses.poses, own)[0], 0.0, 1e-15);
  EXPECT_NEAR(RowOf(*model, poses.poses, own)[1], -0.4, 1e-15);
}

}  // namespace velocity_methods_test
}  // namespace oca::systems
