// SPDX-License-Identifier: BSD-3-Clause
// The other models of the product, against the facts they were written from.
#include <gtest/gtest.h>

#include <numbers>

#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/urdf.h"
#include "tests/models/robot/random_robot.h"

namespace oca::robot::test {
namespace product_models_test {

constexpr double kDegree = std::numbers::pi / 180.0;

RobotModel Load(const std::string& name) {
  LoadOptions options;
  options.srdf = ProductFile(name + ".srdf");
  return LoadUrdf(ProductFile(name + ".urdf"), options);
}

TEST(PlanarTest, TipsReachTheSumOfTheirLinks) {
  for (const auto& [name, reach] : {std::pair("planar2", 0.9), std::pair("planar3", 1.2)}) {
    const RobotModel model = Load(std::string("robots/") + name + "/" + name);
    const auto X_WL = LinkPoses(model, Eigen::VectorXd::Zero(model.num_positions()));
    EXPECT_LT((X_WL.back().translation() - Eigen::Vector3d(reach, 0, 0)).norm(), 1e-15);
    for (const int body : model.bodies()) {
      ASSERT_EQ(model.links()[body].collisions.size(), 1u);
      const CollisionElement& element = model.links()[body].collisions[0];
      ASSERT_TRUE(std::holds_alternative<geometry::Capsule>(element.shape));
      EXPECT_LT((element.X_LC.linear().col(2) - Eigen::Vector3d::UnitX()).norm(), 1e-15);
    }
    EXPECT_TRUE(model.collision_disabled(1, 2));
  }
}

TEST(WorldTest, TableAndPillarAreFixedBoxes) {
  const RobotModel world = LoadUrdf(ProductFile("worlds/table_frame/table_frame.urdf"));
  EXPECT_EQ(world.num_positions(), 0);
  const auto X_WL = LinkPoses(world, Eigen::VectorXd(0));
  const auto expect_box = [&](const char* name, const Eigen::Vector3d& size,
                              const Eigen::Vector3d& centre) {
    const int link = world.FindLink(name);
    EXPECT_EQ(world.body(link), -1);
    EXPECT_EQ(std::get<geometry::Box>(world.links()[link].collisions[0].shape).size, size);
    EXPECT_EQ(X_WL[link].translation(), centre);
  };
  expect_box("table", {1.6, 1.6, 0.05}, {0, 0, 0.725});
  expect_box("pillar", {0.1, 0.1, 2.0}, {-0.45, -0.45, 1.0});
}

TEST(DualArmTest, TwoArmsStandSideBySide) {
  const RobotModel model = Load("robots/lwr4_dual/lwr4_dual");
  EXPECT_EQ(model.num_positions(), 14);
  EXPECT_EQ(model.FindPosition("left_lwr4_joint_1"), 0);
  EXPECT_EQ(model.FindPosition("right_lwr4_joint_1"), 7);
  const auto X_WL = LinkPoses(model, Eigen::VectorXd::Zero(14));
  EXPECT_LT((X_WL[model.FindLink("left_lwr4_flange")].translation() -
             Eigen::Vector3d(0, 0.45, 0.85 + 1.1785))
                .norm(),
            1e-15);
  EXPECT_LT((X_WL[model.FindLink("right_lwr4_flange")].translation() -
             Eigen::Vector3d(0, -0.45, 0.85 + 1.1785))
                .norm(),
            1e-15);
  EXPECT_FALSE(model.collision_disabled(model.FindLink("left_lwr4_link_6"),
                                        model.FindLink("right_lwr4_link_6")));
}

TEST(Iiwa14Test, LengthsAxesAndLimitsAreThePublishedOnes) {
  const RobotModel model = Load("robots/iiwa14/iiwa14");
  ASSERT_EQ(model.num_positions(), 7);
  const auto X_WL = LinkPoses(model, Eigen::VectorXd::Zero(7));
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  const std::vector<Eigen::Vector3d> axes{z, y, z, -y, z, y, z};
  const double position[] = {170, 120, 170, 120, 170, 120, 175};
  const double velocity[] = {85, 85, 100, 75, 130, 135, 135};
  for (int j = 0; j < 7; ++j) {
    EXPECT_EQ(X_WL[j + 1].linear() * model.joints()[j].axis, axes[j]) << j;
    EXPECT_NEAR(model.upper_limits()[j], position[j] * kDegree, 1e-15);
    EXPECT_NEAR(model.velocity_limits()[j], velocity[j] * kDegree, 1e-15);
  }
  // Shoulder, elbow, wrist, flange.
  const auto height = [&](int joint) { return X_WL[joint].translation().z(); };
  EXPECT_NEAR(height(2), 0.360, 1e-15);
  EXPECT_NEAR(height(4) - height(2), 0.420, 1e-15);
  EXPECT_NEAR(height(6) - height(4), 0.400, 1e-15);
  EXPECT_NEAR(X_WL[model.FindLink("iiwa14_flange")].translation().z(), 1.306, 1e-15);
}

// The frames of Denavit and Hartenberg, multiplied out: Rz(q) Tz(d) Tx(a) Rx(alpha) a joint.
TEST(Ur5eTest, FlangeIsWhereThePublishedParametersPutIt) {
  const RobotModel model = Load("robots/ur5e/ur5e");
  ASSERT_EQ(model.num_positions(), 6);
  const double right = std::numbers::pi / 2;
  const double a[] = {0, -0.425, -0.3922, 0, 0, 0};
  const double d[] = {0.1625, 0, 0, 0.1333, 0.0997, 0.0996};
  const double alpha[] = {right, 0, 0, right, -right, 0};
  Random random(72);
  for (int i = 0; i < 100; ++i) {
    const Eigen::VectorXd q = RandomPositions(model, random);
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    for (int j = 0; j < 6; ++j) {
      X.rotate(Eigen::AngleAxisd(q[j], Eigen::Vector3d::UnitZ()));
      X.translate(Eigen::Vector3d(a[j], 0.0, d[j]));
      X.rotate(Eigen::AngleAxisd(alpha[j], Eigen::Vector3d::UnitX()));
    }
    const auto X_WL = LinkPoses(model, q);
    EXPECT_TRUE(X_WL[model.FindLink("ur5e_flange")].isApprox(X, 1e-13));
  }
  EXPECT_NEAR(model.upper_limits()[5], 2.0 * std::numbers::pi, 1e-15);
  EXPECT_NEAR(model.velocity_limits()[0], std::numbers::pi, 1e-15);
}

}  // namespace product_models_test
}  // namespace oca::robot::test
