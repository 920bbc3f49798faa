// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/pose_goal.h"

#include <gmock/gmock.h>

#include <numbers>

#include "oca/models/error.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/urdf.h"

namespace oca::planning {
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
  goal.X_WG.translation() = Eigen::Vector3d(0.5, 0.4, 0.0);
  goal.X_WG.linear() = Eigen::AngleAxisd(kPi / 2.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  goal.time = 3.0;
  return goal;
}

motion::KeyPoint At(double time, const Eigen::VectorXd& position) {
  return {.time = time, .position = position};
}

std::string RefusalOf(const PoseGoal& goal, const motion::KeyPoint& before,
                      const std::shared_ptr<const robot::RobotModel>& model) {
  try {
    KeyPointAt(goal, before, model);
  } catch (const models::ModelError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(PoseGoalTest, FindsTheJointsOfAPoseByHand) {
  const motion::KeyPoint point =
      KeyPointAt(Corner(), At(1.0, Eigen::Vector2d(0.3, 0.3)), Robot("planar2"));
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
  const motion::KeyPoint far =
      KeyPointAt(goal, At(1.0, Eigen::Vector2d(0.3, 0.3)), Robot("planar2"));
  EXPECT_NEAR(far.time, 1.0 + (kPi / 2.0 - 0.3) / 0.5, 1e-5);
  const motion::KeyPoint near =
      KeyPointAt(goal, At(1.0, Eigen::Vector2d(0.0, 1.5)), Robot("planar2"));
  EXPECT_EQ(near.time, 2.0);
}

TEST(PoseGoalTest, TellsHowFarTheGoalIsOutOfReach) {
  PoseGoal goal;
  goal.time = 3.0;
  const motion::KeyPoint before = At(0.0, Eigen::Vector2d(0.3, 0.3));
  goal.X_WG.translation() =
      Eigen::Vector3d(0.9, 0.0, 0.0);  // the arm stretched, to the last micrometre
  EXPECT_EQ(RefusalOf(goal, before, Robot("planar2")), "accepted");
  goal.X_WG.translation() = Eigen::Vector3d(1.1, 0.0, 0.0);
  EXPECT_THAT(RefusalOf(goal, before, Robot("planar2")),
              AllOf(HasSubstr("goal.pose: out of reach"), HasSubstr("planar2_tip"),
                    HasSubstr("at least 0.2 m")));
}

TEST(PoseGoalTest, KeepsTheClearanceFromWhatIsThereAtItsTime) {
  const auto arm = Robot("lwr4");
  const Eigen::VectorXd bent =
      (Eigen::VectorXd(7) << 0.3, 0.8, -0.2, -1.2, 0.4, 0.9, -0.5).finished();
  const auto X_WL = robot::LinkPoses(*arm, bent);
  robot::PlacedBody ball{geometry::MakeCollider(geometry::Sphere{0.05}, "ball"),
                         Eigen::Isometry3d::Identity()};
  const int elbow = arm->FindLink("lwr4_link_4");
  ball.X_WO.translation() = X_WL[elbow].translation() + Eigen::Vector3d(0, 0.16, 0);
  PoseGoal goal;
  goal.X_WG = X_WL.back();
  goal.time = 3.0;
  goal.clearance = 0.1;
  goal.bodies = [&](double time) {
    return time < 3.5 ? std::vector{ball} : std::vector<robot::PlacedBody>();
  };
  robot::Clearance surroundings(arm, true, {ball});
  surroundings.MoveTo(KeyPointAt(goal, At(0.0, bent), arm).position);
  EXPECT_GE(surroundings.Nearest().distance, 0.1 - 1e-4);

  goal.time = 3.5;  // gone: the arm may stay
  EXPECT_LT((KeyPointAt(goal, At(0.0, bent), arm).position - bent).norm(), 1e-6);
}

TEST(PoseGoalTest, KeepsClearWhereOwnLinksStandNearerThanThat) {
  const auto arm = Robot("ur5e");
  const Eigen::VectorXd bent = (Eigen::VectorXd(6) << 0.3, -1.2, 1.4, -1.0, -1.5, 0.2).finished();
  PoseGoal goal;
  goal.X_WG = robot::LinkPoses(*arm, bent)[static_cast<std::size_t>(arm->FindLink("ur5e_flange"))];
  goal.link = "ur5e_flange";
  goal.time = 3.0;
  goal.clearance = 0.05;
  robot::Clearance own(arm, true);
  own.MoveTo(bent);
  ASSERT_LT(own.Nearest().distance, 0.03);  // by design, in every posture
  robot::PlacedBody ball{geometry::MakeCollider(geometry::Sphere{0.05}, "ball"),
                         Eigen::Isometry3d::Identity()};
  ball.X_WO.translation() = own.X_WL()[static_cast<std::size_t>(arm->FindLink("ur5e_link_3"))] *
                            Eigen::Vector3d(0.0, 0.0, 0.5);
  robot::Clearance beside(arm, false, {ball});
  beside.MoveTo(bent);
  const robot::NearPair nearest = beside.Nearest();
  ball.X_WO.translation() += (nearest.distance - 0.03) * nearest.normal;
  goal.bodies = [&](double) { return std::vector{ball}; };
  beside.SetBodies({ball});
  beside.MoveTo(bent);
  ASSERT_LT(beside.Nearest().distance, 0.05);
  beside.MoveTo(KeyPointAt(goal, At(0.0, bent), arm).position);
  EXPECT_GE(beside.Nearest().distance, 0.05 - 1e-4);
}

TEST(PoseGoalTest, RefusesWhatItCannotStartFromOrName) {
  const auto arm = Robot("planar2");
  const motion::KeyPoint before = At(3.0, Eigen::Vector2d(0.3, 0.3));
  EXPECT_THAT(RefusalOf(Corner(), before, arm), HasSubstr("goal.time: not later"));
  PoseGoal goal = Corner();
  goal.time = 3.1;
  EXPECT_EQ(RefusalOf(goal, before, arm), "accepted");
  EXPECT_THAT(RefusalOf(goal, At(0.0, Eigen::Vector3d::Zero()), arm), HasSubstr("got 3 numbers"));
  goal.link = "planar2_tpi";
  EXPECT_THAT(RefusalOf(goal, before, arm), HasSubstr("planar2_tip"));
  goal = Corner();
  goal.clearance = -0.1;
  EXPECT_THAT(RefusalOf(goal, At(0.0, before.position), arm), HasSubstr("clearance"));
}

}  // namespace pose_goal_test
}  // namespace oca::planning
