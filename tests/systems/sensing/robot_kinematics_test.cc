// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/robot_kinematics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/kinematics.h"
#include "oca/systems/basics/constant.h"
#include "tests/systems/system_bench.h"
#include "tests/systems/test_models.h"

namespace oca::systems {
namespace robot_kinematics_test {

TEST(RobotKinematicsTest, PlacesTheLinksOfAPlanarArmByHand) {
  SystemBench<RobotKinematics> bench(RobotKinematics::Params{}, TestModels("planar2"));
  // Upper arm 0.5 m along y, forearm 0.4 m back along x.
  bench->position.Fix(bench.context(), Eigen::Vector2d(std::acos(0.0), std::acos(0.0)));
  const LinkPoses& links = bench->links.Eval(bench.context());
  const int elbow = links.Find(models::Name("planar2_link_2"));
  const int tip = links.Find(models::Name("planar2_tip"));
  ASSERT_GE(elbow, 0);
  ASSERT_GE(tip, 0);
  EXPECT_NEAR((links.poses[elbow].translation() - Eigen::Vector3d(0.0, 0.5, 0.0)).norm(), 0, 1e-15);
  EXPECT_NEAR((links.poses[tip].translation() - Eigen::Vector3d(-0.4, 0.5, 0.0)).norm(), 0, 1e-15);
}

TEST(RobotKinematicsTest, SaysWhichBodyCarriesEachLink) {
  SystemBench<RobotKinematics> bench(RobotKinematics::Params{}, TestModels("planar2"));
  bench->position.Fix(bench.context(), Eigen::Vector2d::Zero());
  const LinkPoses& links = bench->links.Eval(bench.context());
  EXPECT_EQ(links.bodies, (std::vector<int>{-1, 1, 2, 2}));
}

TEST(RobotKinematicsTest, FollowsThePositionFromTickToTick) {
  SystemBench<RobotKinematics> bench(RobotKinematics::Params{.model = "lwr4"}, TestModels("lwr4"));
  const auto model = LoadTestModel("lwr4");
  for (const double angle : {0.0, 0.3, -0.7}) {
    const Eigen::VectorXd q = Eigen::VectorXd::Constant(7, angle);
    bench->position.Fix(bench.context(), q);
    const LinkPoses& links = bench->links.Eval(bench.context());
    const auto expected = robot::LinkPoses(*model, q);
    ASSERT_EQ(links.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_TRUE(links.poses[i].isApprox(expected[i], 1e-15));
    }
  }
}

TEST(RobotKinematicsTest, RefusesAModelThatDoesNotExistOrCannotMove) {
  EXPECT_THROW(RobotKinematics(RobotKinematics::Params{.model = "lwr5"}, TestModels("lwr4")),
               ConfigError);
  EXPECT_THROW(RobotKinematics(RobotKinematics::Params{}, TestModels("table_frame")), ConfigError);
}

TEST(RobotKinematicsTest, RefusesAStartThatIsNoStateOfTheRobot) {
  DiagramBuilder builder;
  const auto& q = builder.Add<Constant>(
      "q", Constant::Params{Eigen::VectorXd(Eigen::Vector2d(0.0, 1e9)), "rad"});
  const auto& kinematics =
      builder.Add<RobotKinematics>("kinematics", RobotKinematics::Params{}, TestModels("planar2"));
  builder.Connect(q.value, kinematics.position);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  try {
    simulator.Initialize();
    FAIL() << "accepted";
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("kinematics"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("2 pi rad or 10 m beyond its limits"),
              std::string::npos)
        << error.what();
  }
}

TEST(RobotKinematicsTest, RefusesAPositionOfAnotherLength) {
  SystemBench<RobotKinematics> bench(RobotKinematics::Params{}, TestModels("planar2"));
  EXPECT_THROW(bench->position.Fix(bench.context(), Eigen::Vector3d::Zero()), ConfigError);
}

TEST(RobotKinematicsTest, KnowsTheVelocitiesOfItsLinksIfThoseOfTheJointsComeIn) {
  SystemBench<RobotKinematics> still(RobotKinematics::Params{}, TestModels("planar2"));
  still->position.Fix(still.context(), Eigen::Vector2d::Zero());
  EXPECT_TRUE(still->links.Eval(still.context()).velocities.empty());

  DiagramBuilder builder;
  const auto& kinematics =
      builder.Add<RobotKinematics>("kinematics", RobotKinematics::Params{}, TestModels("planar2"));
  builder.ExportInput("position", kinematics.position);
  builder.ExportInput("velocity", kinematics.velocity);
  const auto diagram = builder.Build();
  Context context = diagram->MakeContext();
  diagram->GetInput<Vector>("position").Fix(context, Eigen::Vector2d::Zero());
  diagram->GetInput<Vector>("velocity").Fix(context, Eigen::Vector2d(2.0, -1.0));
  const LinkPoses& links = kinematics.links.Eval(context);
  ASSERT_EQ(links.velocities.size(), links.size());
  const int tip = links.Find(models::Name("planar2_tip"));
  // Joint 1 moves the elbow at 2 rad/s * 0.5 m; from there on 1 rad/s is left.
  EXPECT_NEAR((links.velocities[tip].linear - Eigen::Vector3d(0.0, 1.4, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((links.velocities[tip].angular - Eigen::Vector3d(0.0, 0.0, 1.0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((links.VelocityAt(tip, {0.9, 0.1, 0.0}) - Eigen::Vector3d(-0.1, 1.4, 0.0)).norm(),
              0.0, 1e-15);
}

}  // namespace robot_kinematics_test
}  // namespace oca::systems
