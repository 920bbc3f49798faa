// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/commands/pose_goal.h"

#include <gmock/gmock.h>

#include <limits>
#include <numbers>

#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/clearance.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/urdf.h"

namespace oca::systems {
namespace pose_goal_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

std::shared_ptr<const robot::RobotModel> Robot(const std::string& name) {
  const std::string file = OCA_SOURCE_DIR "/models/robots/" + name + "/" + name;
  robot::LoadOptions options;
  options.srdf = file + ".srdf";
  return std::make_shared<const robot::RobotModel>(robot::LoadUrdf(file + ".urdf", options));
}

/// Of the arm of links 0.5 and 0.4 m long: the upper arm along x, the forearm along y.
PoseGoal Corner() {
  PoseGoal goal;
  goal.pose.xyz = {0.5, 0.4, 0.0};
  goal.pose.rpy = Eigen::Vector3d(0.0, 0.0, kPi / 2.0);
  goal.time = 3.0;
  return goal;
}

KeyPoint At(double time, const Eigen::VectorXd& position) {
  return {.time = time, .position = position};
}

std::string RefusalOf(const PoseGoal& goal, const KeyPoint& before,
                      const std::shared_ptr<const robot::RobotModel>& model) {
  try {
    KeyPointAt(goal, before, model);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(PoseGoalTest, FindsTheJointsOfAPoseByHand) {
  const KeyPoint point = KeyPointAt(Corner(), At(1.0, Eigen::Vector2d(0.3, 0.3)), Robot("planar2"));
  EXPECT_LT((point.position - Eigen::Vector2d(0.0, kPi / 2.0)).norm(), 1e-5);
  EXPECT_EQ(point.time, 3.0);
  EXPECT_FALSE(point.velocity.has_value());
}

TEST(PoseGoalTest, KeepsNoClearanceOfARobotThatDistancesDoNotSee) {
  const auto planar = Robot("planar2");
  std::vector<robot::Link> links = planar->links();
  for (robot::Link& link : links) link.collisions.clear();
  const auto blind =
      std::make_shared<const robot::RobotModel>(planar->name(), links, planar->joints());
  PoseGoal goal = Corner();
  EXPECT_EQ(RefusalOf(goal, At(1.0, Eigen::Vector2d::Zero()), blind), "accepted");
  goal.clearance = 0.05;
  EXPECT_THAT(RefusalOf(goal, At(1.0, Eigen::Vector2d::Zero()), blind),
              HasSubstr("goal.clearance: got 0.05 m; expected a robot that distances see"));
}

TEST(PoseGoalTest, ArrivesWithAQuarterOfTheSpeedLimitIfNoTimeIsGiven) {
  PoseGoal goal = Corner();
  goal.time.reset();  // joint 2 has to turn by pi / 2 - 0.3 and may turn with 2 rad/s
  const KeyPoint far = KeyPointAt(goal, At(1.0, Eigen::Vector2d(0.3, 0.3)), Robot("planar2"));
  EXPECT_NEAR(far.time, 1.0 + (kPi / 2.0 - 0.3) / 0.5, 1e-5);
  const KeyPoint near = KeyPointAt(goal, At(1.0, Eigen::Vector2d(0.0, 1.5)), Robot("planar2"));
  EXPECT_EQ(near.time, 2.0);
}

TEST(PoseGoalTest, TellsHowFarTheGoalIsOutOfReach) {
  PoseGoal goal;
  goal.time = 3.0;
  const KeyPoint before = At(0.0, Eigen::Vector2d(0.3, 0.3));
  goal.pose.xyz = {0.9, 0.0, 0.0};  // the arm stretched, to the last micrometre
  EXPECT_EQ(RefusalOf(goal, before, Robot("planar2")), "accepted");
  goal.pose.xyz = {1.1, 0.0, 0.0};
  EXPECT_THAT(RefusalOf(goal, before, Robot("planar2")),
              AllOf(HasSubstr("goal.pose: out of reach"), HasSubstr("planar2_tip"),
                    HasSubstr("at least 0.2 m")));
}

TEST(PoseGoalTest, KeepsTheClearanceFromWhatIsThereThen) {
  const auto arm = Robot("lwr4");
  const Eigen::VectorXd bent =
      (Eigen::VectorXd(7) << 0.3, 0.8, -0.2, -1.2, 0.4, 0.9, -0.5).finished();
  const auto X_WL = robot::LinkPoses(*arm, bent);
  PoseGoal goal;
  goal.pose = PoseParamsOf(X_WL.back());
  goal.time = 3.0;
  goal.clearance = 0.1;
  ObstacleSource::ObstacleParams ball;
  ball.id = "ball";
  ball.shape.radius = 0.05;
  ball.pose.emplace();
  ball.pose->xyz = X_WL[arm->FindLink("lwr4_link_4")].translation() + Eigen::Vector3d(0, 0.16, 0);
  ball.appear = 2.0;
  goal.around.emplace_back().obstacles.push_back(ball);
  robot::PlacedBody body{geometry::MakeCollider(geometry::Sphere{0.05}, "ball"),
                         Eigen::Isometry3d::Identity()};
  body.X_WO.translation() = ball.pose->xyz;
  robot::Clearance surroundings(arm, true, {body});
  surroundings.MoveTo(KeyPointAt(goal, At(0.0, bent), arm).position);
  EXPECT_GE(surroundings.Nearest().distance, 0.1 - 1e-4);

  goal.around[0].obstacles[0].appear = 3.5;  // not yet there: the arm may stay
  EXPECT_LT((KeyPointAt(goal, At(0.0, bent), arm).position - bent).norm(), 1e-6);
}

TEST(PoseGoalTest, RefusesWhatItCannotStartFromOrName) {
  const auto arm = Robot("planar2");
  const KeyPoint before = At(3.0, Eigen::Vector2d(0.3, 0.3));
  EXPECT_THAT(RefusalOf(Corner(), before, arm), HasSubstr("goal.time: not later"));
  PoseGoal goal = Corner();
  goal.time = 3.1;
  EXPECT_EQ(RefusalOf(goal, before, arm), "accepted");
  EXPECT_THAT(RefusalOf(goal, At(0.0, Eigen::Vector3d::Zero()), arm), HasSubstr("got 3 numbers"));
  goal.link = "planar2_tpi";
  EXPECT_THAT(RefusalOf(goal, before, arm), HasSubstr("planar2_tip"));
  goal = Corner();
  goal.time = 3.1;
  goal.pose.xyz.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(RefusalOf(goal, before, arm), HasSubstr("goal.pose"));
  goal = Corner();
  goal.clearance = -0.1;
  EXPECT_THAT(RefusalOf(goal, At(0.0, before.position), arm), HasSubstr("clearance"));
}

}  // namespace pose_goal_test
}  // namespace oca::systems
