// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/robot_model.h"

#include <gmock/gmock.h>

#include <cmath>

#include "oca/models/error.h"
#include "oca/models/robot/kinematics.h"
#include "tests/models/robot/random_robot.h"

namespace oca::robot::test {
namespace robot_model_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

// base - (lift, prismatic) - arm - (fixed) - plate - (turn, continuous) - hand, and
// base - (fixed) - shelf.
std::vector<Link> Links() {
  std::vector<Link> links(5);
  const char* names[] = {"base", "arm", "plate", "hand", "shelf"};
  for (int i = 0; i < 5; ++i) links[i].name = models::Name(names[i]);
  return links;
}

std::vector<Joint> Joints() {
  std::vector<Joint> joints(4);
  const char* names[] = {"lift", "screws", "turn", "bolts"};
  const int parents[] = {0, 1, 2, 0};
  for (int j = 0; j < 4; ++j) {
    joints[j].name = models::Name(names[j]);
    joints[j].parent_link = parents[j];
    joints[j].child_link = j + 1;
  }
  joints[0].type = JointType::kPrismatic;
  joints[0].lower_limit = 0.0;
  joints[0].upper_limit = 0.5;
  joints[2].type = JointType::kContinuous;
  joints[2].velocity_limit = 3.0;
  return joints;
}

RobotModel Lift(std::vector<std::pair<int, int>> disabled = {}) {
  return {models::Name("lift"), Links(), Joints(), Eigen::Isometry3d::Identity(),
          std::move(disabled)};
}

TEST(RobotModelTest, NumbersPositionsInTheOrderOfTheirJoints) {
  const RobotModel model = Lift();
  EXPECT_EQ(model.num_positions(), 2);
  EXPECT_THAT(model.position_names(), ElementsAre(models::Name("lift"), models::Name("turn")));
  EXPECT_EQ(model.joints()[1].position_index, -1);
  EXPECT_EQ(model.joints()[2].position_index, 1);
  EXPECT_EQ(model.FindPosition("turn"), 1);
}

TEST(RobotModelTest, LimitsThatAreAbsentAreInfinite) {
  const RobotModel model = Lift();
  EXPECT_EQ(model.upper_limits(), Eigen::Vector2d(0.5, kUnlimited));
  EXPECT_EQ(model.lower_limits(), Eigen::Vector2d(0.0, -kUnlimited));
  EXPECT_EQ(model.velocity_limits(), Eigen::Vector2d(kUnlimited, 3.0));
  EXPECT_EQ(model.acceleration_limits(), Eigen::Vector2d(kUnlimited, kUnlimited));
}

TEST(RobotModelTest, LinkBelongsToTheLastMovableJointBeforeIt) {
  const RobotModel model = Lift();
  EXPECT_EQ(model.body(model.FindLink("base")), -1);
  EXPECT_EQ(model.body(model.FindLink("shelf")), -1);
  EXPECT_EQ(model.body(model.FindLink("arm")), model.FindLink("arm"));
  EXPECT_EQ(model.body(model.FindLink("plate")), model.FindLink("arm"));
  EXPECT_EQ(model.body(model.FindLink("hand")), model.FindLink("hand"));
  EXPECT_THAT(model.bodies(), ElementsAre(1, 3));
  EXPECT_EQ(model.body_index(model.FindLink("plate")), 0);
}

TEST(RobotModelTest, UnitTellsAnglesFromLengths) {
  EXPECT_EQ(Lift().position_unit(), "mixed");
  auto joints = Joints();
  joints[0].type = JointType::kRevolute;
  EXPECT_EQ(RobotModel(models::Name("r"), Links(), joints).position_unit(), "rad");
  joints[0].type = joints[2].type = JointType::kPrismatic;
  EXPECT_EQ(RobotModel(models::Name("r"), Links(), joints).position_unit(), "m");
}

TEST(RobotModelTest, DisabledPairsHaveNoOrder) {
  const RobotModel model = Lift({{3, 0}, {0, 3}, {1, 2}});
  EXPECT_THAT(model.disabled_pairs(), ElementsAre(std::pair(0, 3), std::pair(1, 2)));
  EXPECT_TRUE(model.collision_disabled(0, 3));
  EXPECT_TRUE(model.collision_disabled(3, 0));
  EXPECT_TRUE(model.collision_disabled(2, 2));
  EXPECT_FALSE(model.collision_disabled(0, 1));
}

TEST(RobotModelTest, AdjacentLinksHaveAtMostOneMovableJointBetween) {
  const RobotModel model = Lift();
  EXPECT_TRUE(model.adjacent(0, 4));   // both fixed to the base
  EXPECT_TRUE(model.adjacent(1, 4));   // lift between
  EXPECT_TRUE(model.adjacent(2, 3));   // turn between
  EXPECT_FALSE(model.adjacent(0, 3));  // lift and turn between
}

TEST(RobotModelTest, MimicOfAMimicFollowsTheFirst) {
  auto joints = Joints();
  joints[1].type = JointType::kRevolute;
  joints[1].mimic = Mimic{2, 2.0, 1.0};
  joints[2].mimic = Mimic{0, 3.0, -0.5};
  const RobotModel model(models::Name("r"), Links(), joints);
  EXPECT_EQ(model.num_positions(), 1);
  EXPECT_EQ(model.steps()[1].column, 0);
  EXPECT_EQ(model.steps()[1].multiplier, 6.0);  // 2 (3 q - 0.5) + 1
  EXPECT_EQ(model.steps()[1].offset, 0.0);
}

TEST(RobotModelTest, UnknownNamesAreAnsweredWithTheNearest) {
  const RobotModel model = Lift();
  EXPECT_THAT([&] { model.FindLink("hnad"); },
              ThrowsMessage<models::ModelError>(HasSubstr("'hand'")));
  EXPECT_THAT([&] { model.FindJoint("trun"); },
              ThrowsMessage<models::ModelError>(HasSubstr("'turn'")));
  EXPECT_THAT([&] { model.FindPosition("screws"); },
              ThrowsMessage<models::ModelError>(HasSubstr("which is fixed")));
}

void ExpectRefused(const char* reason, const std::function<void(std::vector<Joint>&)>& spoil) {
  auto joints = Joints();
  spoil(joints);
  EXPECT_THAT([&] { RobotModel(models::Name("r"), Links(), joints); },
              ThrowsMessage<models::ModelError>(HasSubstr(reason)));
}

TEST(RobotModelTest, RefusesWhatIsNoTree) {
  ExpectRefused("one less than links", [](auto& joints) { joints.pop_back(); });
  ExpectRefused("parents first", [](auto& joints) { joints[1].parent_link = 3; });
  ExpectRefused("parents first", [](auto& joints) { joints[1].parent_link = -1; });
  ExpectRefused("parents first", [](auto& joints) { joints[1].child_link = 1; });
  EXPECT_THAT([] { RobotModel(models::Name("r"), {}, {}); },
              ThrowsMessage<models::ModelError>(HasSubstr("at least one")));
}

TEST(RobotModelTest, RefusesJointsThatCannotBeComputed) {
  ExpectRefused("unit vector", [](auto& joints) { joints[0].axis.setZero(); });
  ExpectRefused("unit vector", [](auto& joints) { joints[0].axis.x() = std::nan(""); });
  ExpectRefused("lower <= upper", [](auto& joints) { joints[0].lower_limit = 0.6; });
  ExpectRefused("lower <= upper", [](auto& joints) { joints[0].lower_limit = std::nan(""); });
  ExpectRefused("expected >= 0", [](auto& joints) { joints[0].velocity_limit = -1.0; });
  ExpectRefused("expected > 0", [](auto& joints) { joints[0].jerk_limit = 0.0; });
  ExpectRefused("not finite", [](auto& joints) { joints[1].X_PJ(0, 3) = std::nan(""); });
  ExpectRefused("no rotation", [](auto& joints) { joints[1].X_PJ(0, 0) = 2.0; });
}

TEST(RobotModelTest, RefusesMimicRulesThatLeadNowhere) {
  ExpectRefused("an unknown joint", [](auto& joints) { joints[0].mimic = Mimic{9, 1.0, 0.0}; });
  ExpectRefused("a fixed joint", [](auto& joints) { joints[0].mimic = Mimic{1, 1.0, 0.0}; });
  ExpectRefused("one of a fixed joint", [](auto& joints) { joints[1].mimic = Mimic{0, 1, 0}; });
  ExpectRefused("a loop", [](auto& joints) { joints[0].mimic = Mimic{0, 1.0, 0.0}; });
  ExpectRefused("not finite", [](auto& joints) { joints[0].mimic = Mimic{2, std::nan(""), 0.0}; });
}

TEST(RobotModelTest, RefusesDisabledPairsOfNoLink) {
  EXPECT_NO_THROW(Lift({{0, 4}}));
  EXPECT_THROW(Lift({{0, 5}}), models::ModelError);
  EXPECT_THROW(Lift({{-1, 0}}), models::ModelError);
}

RobotModel WithInertia(double mass, const Eigen::Matrix3d& I,
                       const Eigen::Vector3d& p = Eigen::Vector3d::Zero()) {
  auto links = Links();
  links[1].inertia = {mass, p, I};
  return {models::Name("lift"), std::move(links), Joints()};
}

TEST(RobotModelTest, InertiasAreKeptAsTheyAreIfTheyAreNumbers) {
  const Eigen::Matrix3d ball = 0.01 * Eigen::Matrix3d::Identity();
  EXPECT_EQ(WithInertia(2.0, ball).links()[1].inertia.mass, 2.0);
  EXPECT_EQ(WithInertia(2.0, ball).links()[1].inertia.I_C, ball);
  EXPECT_THAT([&] { WithInertia(-1.0, ball); },
              ThrowsMessage<models::ModelError>(HasSubstr("'arm': mass; got -1 kg")));
  EXPECT_THAT([&] { WithInertia(std::nan(""), ball); },
              ThrowsMessage<models::ModelError>(HasSubstr("not finite")));
  EXPECT_THAT(
      [&] {
        WithInertia(1.0, ball, {0.0, kUnlimited, 0.0});
      },
      ThrowsMessage<models::ModelError>(HasSubstr("not finite")));
}

}  // namespace robot_model_test
}  // namespace oca::robot::test
