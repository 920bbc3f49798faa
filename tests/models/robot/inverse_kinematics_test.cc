// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/inverse_kinematics.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>

#include "oca/models/error.h"
#include "oca/models/robot/clearance.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/pose_error.h"
#include "oca/models/robot/urdf.h"
#include "tests/models/robot/random_robot.h"
#include "tests/sanitized.h"

namespace oca::robot::test {
namespace inverse_kinematics_test {

constexpr double kPi = std::numbers::pi;

constexpr int kManyPoses = kSanitized ? 300 : 10000;  // each takes milliseconds

RobotModel Arm(const std::string& name) {
  return LoadUrdf(ProductFile("robots/" + name + "/" + name + ".urdf"));
}

Eigen::Isometry3d TipPose(const RobotModel& model, const Eigen::VectorXd& q) {
  return LinkPoses(model, q)[TipLink(model)];
}

PostureSolution SolveTip(const RobotModel& model, const Eigen::Isometry3d& X_WG,
                         const Eigen::VectorXd& start,
                         const InverseKinematicsSettings& settings = {}) {
  return SolveInverseKinematics(model, TipLink(model), X_WG, start, settings);
}

void ExpectWithinLimits(const RobotModel& model, const Eigen::VectorXd& q) {
  EXPECT_TRUE((q.array() >= model.lower_limits().array()).all()) << q.transpose();
  EXPECT_TRUE((q.array() <= model.upper_limits().array()).all()) << q.transpose();
}

Eigen::VectorXd PostureWithin(const RobotModel& model, Random& random) {
  Eigen::VectorXd q(model.num_positions());
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    q[j] = Uniform(random, model.lower_limits()[j], model.upper_limits()[j]);
  }
  return q;
}

Eigen::VectorXd Bent() {
  return (Eigen::VectorXd(7) << 0.3, 0.8, -0.2, -1.2, 0.4, 0.9, -0.5).finished();
}

class ArmTest : public testing::TestWithParam<const char*> {};

TEST_P(ArmTest, ReachesWhatItReachedBefore) {
  const RobotModel model = Arm(GetParam());
  Random random(3);
  const Eigen::VectorXd start = Eigen::VectorXd::Constant(model.num_positions(), 0.3);
  const int poses = std::string(GetParam()) == "lwr4" ? kManyPoses : 300;
  int reached = 0;
  for (int trial = 0; trial < poses; ++trial) {
    const Eigen::Isometry3d X_WG = TipPose(model, PostureWithin(model, random));
    const PostureSolution found = SolveTip(model, X_WG, start);
    ExpectWithinLimits(model, found.q);
    const Vector6 error = PoseError(TipPose(model, found.q), X_WG);
    EXPECT_NEAR(found.position_error, error.head<3>().norm(), 1e-12);
    EXPECT_NEAR(found.rotation_error, error.tail<3>().norm(), 1e-12);
    EXPECT_NEAR(found.change, (found.q - start).norm(), 1e-12);
    EXPECT_EQ(found.reached, found.position_error <= 1e-6 && found.rotation_error <= 1e-6);
    if (found.reached) ++reached;
  }
  EXPECT_GE(reached, 0.99 * poses);
}

TEST_P(ArmTest, ReachesPosesAtItsLimits) {
  const RobotModel model = Arm(GetParam());
  Random random(4);
  for (int trial = 0; trial < 50; ++trial) {
    Eigen::VectorXd q = PostureWithin(model, random);
    for (Eigen::Index j = trial % 2; j < q.size(); j += 2) {
      q[j] = trial % 3 == 0 ? model.lower_limits()[j] : model.upper_limits()[j];
    }
    const PostureSolution found =
        SolveTip(model, TipPose(model, q), Eigen::VectorXd::Zero(q.size()));
    EXPECT_TRUE(found.reached) << trial;
    ExpectWithinLimits(model, found.q);
  }
}

TEST_P(ArmTest, ReachesTheStretchedArm) {
  const RobotModel model = Arm(GetParam());
  const Eigen::VectorXd stretched = Eigen::VectorXd::Zero(model.num_positions());
  const Eigen::VectorXd start = Eigen::VectorXd::Constant(model.num_positions(), 0.5);
  EXPECT_TRUE(SolveTip(model, TipPose(model, stretched), start).reached);
}

TEST_P(ArmTest, StaysWhereItIsAtTheGoal) {
  const RobotModel model = Arm(GetParam());
  Random random(5);
  const Eigen::VectorXd q = PostureWithin(model, random);
  const PostureSolution found = SolveTip(model, TipPose(model, q), q);
  EXPECT_TRUE(found.reached);
  EXPECT_EQ(found.starts, 1);
  EXPECT_LT(found.change, 1e-9);
}

TEST_P(ArmTest, GivesTheSameAnswerTwiceAndAnotherForAnotherSeed) {
  const RobotModel model = Arm(GetParam());
  Random random(6);
  const Eigen::VectorXd start = PostureWithin(model, random);
  const Eigen::Isometry3d X_WG = TipPose(model, PostureWithin(model, random));
  Eigen::Isometry3d X_WF = X_WG;  // out of reach, so that all starts are tried
  X_WF.translation() *= 10.0;
  InverseKinematicsSettings settings;
  for (const Eigen::Isometry3d& goal : {X_WG, X_WF}) {
    const Eigen::VectorXd q = SolveTip(model, goal, start, settings).q;
    EXPECT_EQ(SolveTip(model, goal, start, settings).q, q);
  }
  const Eigen::VectorXd q = SolveTip(model, X_WF, start, settings).q;
  settings.seed = 1;
  EXPECT_NE(SolveTip(model, X_WF, start, settings).q, q);
}

TEST_P(ArmTest, TellsHowFarAGoalIsOutOfReach) {
  const RobotModel model = Arm(GetParam());
  const Eigen::VectorXd start = Eigen::VectorXd::Constant(model.num_positions(), 0.3);
  Eigen::Isometry3d X_WG = TipPose(model, start);
  X_WG.translation() = Eigen::Vector3d(0.0, 0.0, 50.0);
  const PostureSolution found = SolveTip(model, X_WG, start);
  EXPECT_FALSE(found.reached);
  EXPECT_EQ(found.starts, 200);
  ExpectWithinLimits(model, found.q);
  EXPECT_GT(found.position_error, 48.0);
  EXPECT_LT(found.position_error, 50.0);
}

INSTANTIATE_TEST_SUITE_P(Arms, ArmTest, testing::Values("lwr4", "iiwa14", "ur5e"),
                         [](const auto& instance) { return std::string(instance.param); });

/// Yaw, then `pitches` pitching joints 0.3 m apart and a roll of the wrist.
RobotModel PitchingArm(int pitches) {
  std::string urdf = "<robot name='few'><link name='l0'/>";
  for (int i = 1; i <= pitches + 2; ++i) {
    const char* const axis = i == 1 ? "0 0 1" : i == pitches + 2 ? "1 0 0" : "0 1 0";
    urdf += "<link name='l" + std::to_string(i) + "'/><joint name='j" + std::to_string(i) +
            "' type='revolute'><parent link='l" + std::to_string(i - 1) + "'/><child link='l" +
            std::to_string(i) + "'/><origin xyz='" + (i > 2 ? "0.3" : "0") +
            " 0 0.1'/><axis xyz='" + axis +
            "'/><limit lower='-2.5' upper='2.5' velocity='1' effort='1'/></joint>";
  }
  return ParseUrdf(urdf + "</robot>", "few.urdf");
}

TEST(InverseKinematicsTest, ArmsOfFourAndFiveJointsReachPointsTurnedHowever) {
  for (const int pitches : {2, 3}) {
    const RobotModel arm = PitchingArm(pitches);
    Random random(7);
    InverseKinematicsSettings settings;
    settings.turns_freely = true;
    int poses_reached = 0;
    for (int i = 0; i < 300; ++i) {
      Eigen::Isometry3d goal = TipPose(arm, PostureWithin(arm, random));
      goal.linear() = RandomPose(random).linear();
      const Eigen::VectorXd start = PostureWithin(arm, random);
      const PostureSolution found = SolveTip(arm, goal, start, settings);
      ASSERT_TRUE(found.reached) << pitches << " " << i;
      EXPECT_LT((TipPose(arm, found.q).translation() - goal.translation()).norm(), 1e-6);
      EXPECT_EQ(found.rotation_error, 0.0);
      ExpectWithinLimits(arm, found.q);
      poses_reached += static_cast<int>(
          SolveTip(arm, goal, start, {.starts = 3}).reached);  // such an arm has no such pose
    }
    EXPECT_EQ(poses_reached, 0);
  }
}

TEST(InverseKinematicsTest, TheToleranceDecidesFromBothSides) {
  const RobotModel model = Arm("planar2");
  Eigen::Isometry3d X_WG = TipPose(model, Eigen::Vector2d(0.4, 0.8));
  X_WG.linear() = X_WG.linear() * Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitX());
  InverseKinematicsSettings settings;  // the arm cannot leave its plane
  settings.rotation_tolerance = 0.0101;
  EXPECT_TRUE(SolveTip(model, X_WG, Eigen::Vector2d(0.1, 0.1), settings).reached);
  settings.rotation_tolerance = 0.0099;
  const PostureSolution found = SolveTip(model, X_WG, Eigen::Vector2d(0.1, 0.1), settings);
  EXPECT_FALSE(found.reached);
  EXPECT_NEAR(found.rotation_error, 0.01, 1e-6);
}

TEST(InverseKinematicsTest, TakesThePostureNearestToTheStart) {
  const RobotModel model = Arm("lwr4");
  const Eigen::Isometry3d X_WG = TipPose(model, Bent());
  const Eigen::VectorXd start =
      Bent() + (Eigen::VectorXd(7) << 0.2, -0.1, 0.3, 0.1, -0.3, 0.1, 0.2).finished();
  const PostureSolution found = SolveTip(model, X_WG, start);
  ASSERT_TRUE(found.reached);
  EXPECT_LT(found.change, (Bent() - start).norm());
  // Nearest: the way to the start is across the one motion that keeps the tip.
  const int tip = TipLink(model);
  Eigen::MatrixXd J(6, 7);
  LinkJacobian(model, LinkPoses(model, found.q), tip, J);
  const Eigen::VectorXd still = J.fullPivLu().kernel().col(0).normalized();
  EXPECT_LT(std::fabs(still.dot(start - found.q)), 1e-4);
}

TEST(InverseKinematicsTest, MoreSolutionsAreNoFartherFromTheStart) {
  const RobotModel model = Arm("ur5e");
  Random random(8);
  double change_of_one = 0.0;
  double change_of_many = 0.0;
  for (int trial = 0; trial < 30; ++trial) {
    const Eigen::VectorXd start = 0.5 * PostureWithin(model, random);
    const Eigen::Isometry3d X_WG = TipPose(model, PostureWithin(model, random));
    InverseKinematicsSettings settings;
    const PostureSolution one = SolveTip(model, X_WG, start, settings);
    settings.solutions = 16;
    const PostureSolution many = SolveTip(model, X_WG, start, settings);
    ASSERT_TRUE(one.reached && many.reached);
    EXPECT_LE(many.change, one.change);
    // No joint is a whole turn farther from the start than it could be.
    EXPECT_LE((many.q - start).cwiseAbs().maxCoeff(), kPi + 1e-9);
    change_of_one += one.change;
    change_of_many += many.change;
  }
  EXPECT_LT(change_of_many, 0.95 * change_of_one);
}

TEST(InverseKinematicsTest, LeavesJointsThatDoNotCarryTheLink) {
  const RobotModel model = Arm("lwr4_dual");
  Random random(9);
  const Eigen::VectorXd start = PostureWithin(model, random);
  const int link = model.FindLink("right_lwr4_flange");
  const Eigen::Isometry3d X_WG = LinkPoses(model, PostureWithin(model, random))[link];
  const PostureSolution found = SolveInverseKinematics(model, link, X_WG, start);
  ASSERT_TRUE(found.reached);
  EXPECT_EQ(found.q.head<7>(), start.head<7>());
}

// Each link 1 m long; the second turns at half the rate of the first, the third at half of that.
RobotModel Curl() {
  std::vector<Link> links(4);
  std::vector<Joint> joints(3);
  for (int i = 0; i < 4; ++i) links[i].name = models::Name("link_" + std::to_string(i));
  for (int j = 0; j < 3; ++j) {
    joints[j].name = models::Name("joint_" + std::to_string(j));
    joints[j].type = JointType::kRevolute;
    joints[j].parent_link = j;
    joints[j].child_link = j + 1;
    joints[j].axis = Eigen::Vector3d::UnitZ();
    if (j > 0) joints[j].X_PJ.translation().x() = 1.0;
    if (j > 0) joints[j].mimic = Mimic{j - 1, 0.5, 0.0};
    joints[j].lower_limit = -12.0;
    joints[j].upper_limit = 12.0;
  }
  return {models::Name("curl"), std::move(links), std::move(joints)};
}

TEST(InverseKinematicsTest, FollowsAChainOfMimics) {
  const RobotModel model = Curl();
  for (const double q : {0.3, -2.0, 7.0, -11.5}) {  // a turn of the first is no turn of the others
    const Eigen::VectorXd there = Eigen::VectorXd::Constant(1, q);
    const auto found = SolveTip(model, TipPose(model, there), Eigen::VectorXd::Zero(1));
    ASSERT_TRUE(found.reached) << q;
    EXPECT_NEAR(found.q[0], q, 1e-5);
  }
}

TEST(InverseKinematicsTest, StaysWithinWhatAMimicLeaves) {
  auto joints = Curl().joints();
  joints[2].upper_limit = 0.5;  // so 2 rad for the first
  const RobotModel model(models::Name("curl"), Curl().links(), joints);
  const auto goal = TipPose(Curl(), Eigen::VectorXd::Constant(1, 2.5));
  const auto found = SolveTip(model, goal, Eigen::VectorXd::Zero(1));
  EXPECT_FALSE(found.reached);
  EXPECT_LE(found.q[0], 2.0);
}

TEST(InverseKinematicsTest, IsNotLedAstrayByARangeThatNobodyMeasured) {
  for (const double wide : {1e9, 1e308}) {
    auto joints = Curl().joints();
    joints[0].type = JointType::kPrismatic;
    for (auto& joint : joints) {
      joint.lower_limit = -wide;
      joint.upper_limit = wide;
      joint.mimic.reset();
    }
    const RobotModel model(models::Name("crane"), Curl().links(), joints);
    const auto goal = TipPose(model, Eigen::Vector3d(2.5, 1.0, -2.0));
    const auto found = SolveTip(model, goal, Eigen::Vector3d(0.0, -1.0, -1.0));
    EXPECT_TRUE(found.reached) << wide;
    EXPECT_LT(found.q.cwiseAbs().maxCoeff(), 10.0);
  }
}

TEST(InverseKinematicsTest, KeepsAwayFromAnObstacleIfItCan) {
  const auto model = std::make_shared<const RobotModel>(Arm("lwr4"));
  const int tip = TipLink(*model);
  const auto X_WL = LinkPoses(*model, Bent());
  // A ball beside the elbow, which the redundant joint can turn away.
  const Eigen::Vector3d elbow = X_WL[model->FindLink("lwr4_link_4")].translation();
  PlacedBody ball{geometry::MakeCollider(geometry::Sphere{0.05}, "ball"),
                  Eigen::Isometry3d::Identity()};
  ball.X_WO.translation() = elbow + Eigen::Vector3d(0.0, 0.16, 0.0);
  Clearance surroundings(model, false, {ball});
  surroundings.MoveTo(Bent());
  ASSERT_LT(surroundings.Nearest().distance, 0.05);
  InverseKinematicsSettings settings;
  settings.clearance = 0.1;
  const PostureSolution found =
      SolveInverseKinematics(*model, tip, X_WL[tip], Bent(), settings, &surroundings);
  ASSERT_TRUE(found.reached);
  surroundings.MoveTo(found.q);
  EXPECT_GE(surroundings.Nearest().distance, 0.1 - 1e-4);
  EXPECT_NEAR(found.clearance, std::min(surroundings.Nearest().distance, 0.1), 1e-12);
  // No more than it must: the obstacle is what keeps it from the start.
  EXPECT_LT(surroundings.Nearest().distance, 0.11);
}

TEST(InverseKinematicsTest, ThePoseCountsMoreThanTheClearance) {
  const auto model = std::make_shared<const RobotModel>(Arm("lwr4"));
  const int tip = TipLink(*model);
  const auto X_WL = LinkPoses(*model, Bent());
  const PlacedBody ball{geometry::MakeCollider(geometry::Sphere{0.05}, "ball"), X_WL[tip]};
  Clearance surroundings(model, false, {ball});
  InverseKinematicsSettings settings;
  settings.clearance = 0.1;
  const PostureSolution found =
      SolveInverseKinematics(*model, tip, X_WL[tip], Bent(), settings, &surroundings);
  EXPECT_TRUE(found.reached);
  EXPECT_LT(found.clearance, 0.0);
}

}  // namespace inverse_kinematics_test
}  // namespace oca::robot::test
