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

using ::testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

std::shared_ptr<const robot::RobotModel> Robot(const std::string& name) {
  const std::string file = OCA_SOURCE_DIR "/models/robots/" + name + "/" + name;
  robot::LoadOptions options;
  options.srdf = file + ".srdf";
  return std::make_shared<const robot::RobotModel>(robot::LoadUrdf(file + ".urdf", options));
}

/// Of the arm of links 0.5 and 0.4 m long: the upper arm along x, the forearm along y.
PoseGoalParams Corner() {
  PoseGoalParams goal;
  goal.pose = PoseParams{.xyz = {0.5, 0.4, 0.0}, .rpy = Eigen::Vector3d(0.0, 0.0, kPi / 2.0)};
  goal.time = 3.0;
  return goal;
}

motion::KeyPoint At(double time, const Eigen::VectorXd& position) {
  return {.time = time, .position = position};
}

std::string RefusalOf(const PoseGoalParams& goal, const motion::KeyPoint& before,
                      const std::shared_ptr<const robot::RobotModel>& model) {
  try {
    KeyPointAt(goal, before, model);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(PoseGoalTest, IsWhatItsParametersSay) {
  const auto arm = Robot("planar2");
  const motion::KeyPoint before = At(1.0, Eigen::Vector2d(0.3, 0.3));
  const motion::KeyPoint point = KeyPointAt(Corner(), before, arm);
  EXPECT_LT((point.position - Eigen::Vector2d(0.0, kPi / 2.0)).norm(), 1e-5);
  EXPECT_EQ(point.time, 3.0);
  PoseGoalParams goal = Corner();
  goal.link = "planar2_tpi";
  EXPECT_THAT(RefusalOf(goal, before, arm), HasSubstr("planar2_tip"));
}

TEST(PoseGoalTest, APointIsReachedTurnedHowever) {
  const auto arm = Robot("planar2");
  PoseGoalParams goal;
  goal.point = Eigen::Vector3d(0.5, 0.4, 0.0);
  const motion::KeyPoint before = At(1.0, Eigen::Vector2d(0.3, 0.3));
  // Two postures reach it, with the elbow to either side; the one nearer to the start is a corner.
  EXPECT_LT((KeyPointAt(goal, before, arm).position - Eigen::Vector2d(0.0, kPi / 2.0)).norm(),
            1e-5);
  goal.point = Eigen::Vector3d(0.5, 0.8, 0.0);  // 0.943 m away; the arm is 0.9 m long
  EXPECT_THAT(RefusalOf(goal, before, arm),
              HasSubstr("goal.point: out of reach; got one that planar2_tip misses by at least "
                        "0.0434 m; expected"));
  goal.pose = PoseParams{};
  EXPECT_THAT(RefusalOf(goal, before, arm), HasSubstr("got both pose and point"));
  EXPECT_THAT(RefusalOf({}, before, arm), HasSubstr("got neither pose nor point"));
}

TEST(PoseGoalTest, KeepsTheClearanceFromWhatIsThereThen) {
  const auto arm = Robot("lwr4");
  const Eigen::VectorXd bent =
      (Eigen::VectorXd(7) << 0.3, 0.8, -0.2, -1.2, 0.4, 0.9, -0.5).finished();
  const auto X_WL = robot::LinkPoses(*arm, bent);
  PoseGoalParams goal;
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

TEST(PoseGoalTest, IsRefusedWithAConfigError) {
  const auto arm = Robot("planar2");
  EXPECT_THAT(RefusalOf(Corner(), At(3.0, Eigen::Vector2d(0.3, 0.3)), arm),
              HasSubstr("goal.time: not later"));
  PoseGoalParams goal = Corner();
  goal.pose->xyz.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(RefusalOf(goal, At(0.0, Eigen::Vector2d(0.3, 0.3)), arm), HasSubstr("goal.pose"));
}

}  // namespace pose_goal_test
}  // namespace oca::systems
