// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/model_links.h"

#include <gmock/gmock.h>

#include <numbers>

#include "oca/models/robot/robot_model.h"

namespace oca::systems {
namespace model_links_test {

using testing::ElementsAre;
using testing::HasSubstr;

robot::Joint JointOf(const char* name, robot::JointType type, double lower, double upper) {
  robot::Joint joint;
  joint.name = models::Name(name);
  joint.type = type;
  joint.lower_limit = lower;
  joint.upper_limit = upper;
  return joint;
}

/// An angle, a slider, a wheel without limits and a slider whose range is absurd.
robot::RobotModel Mixed() {
  std::vector<robot::Joint> joints{
      JointOf("turn", robot::JointType::kRevolute, -1.0, 2.0),
      JointOf("slide", robot::JointType::kPrismatic, 0.5, 0.75),
      JointOf("wheel", robot::JointType::kContinuous, -robot::kUnlimited, robot::kUnlimited),
      JointOf("far", robot::JointType::kPrismatic, -1e9, 1e9)};
  std::vector<robot::Link> links(5);
  const char* const names[] = {"base", "a", "b", "c", "d"};
  for (int i = 0; i < 5; ++i) links[i].name = models::Name(names[i]);
  for (int i = 0; i < 4; ++i) {
    joints[i].parent_link = i;
    joints[i].child_link = i + 1;
  }
  return robot::RobotModel(models::Name("mixed"), links, joints);
}

TEST(ModelLinksTest, APositionCanBeSomewhatBeyondTheLimitsAndNoFarther) {
  const PortSpec spec = PositionSpec(Mixed());
  ASSERT_NE(spec.plausible, nullptr);
  const double turn = 2.0 * std::numbers::pi;
  EXPECT_EQ(spec.plausible->lower, Eigen::Vector4d(-1.0 - turn, -9.5, -1e6, -1e6));
  EXPECT_EQ(spec.plausible->upper, Eigen::Vector4d(2.0 + turn, 10.75, 1e6, 1e6));
  EXPECT_THAT(spec.plausible->names,
              ElementsAre("joint 'turn'", "joint 'slide'", "joint 'wheel'", "joint 'far'"));
}

TEST(ModelLinksTest, TheFirstJointThatCannotBeThereIsNamedOnBothSidesOfTheBound) {
  const PortSpec spec = PositionSpec(Mixed());
  Eigen::Vector4d q(8.28, 10.75, -1e6, 1e6);
  EXPECT_TRUE(spec.plausible->Check(q.data()).ok());
  q[0] = 8.29;
  EXPECT_THAT(spec.plausible->Check(q.data()).text(), HasSubstr("joint 'turn'; got 8.29"));
  q[0] = 0.0;
  q[1] = 10.76;
  EXPECT_THAT(spec.plausible->Check(q.data()).text(), HasSubstr("joint 'slide'; got 10.76"));
  q[1] = 0.5;
  q[2] = -1.1e6;
  EXPECT_THAT(spec.plausible->Check(q.data()).text(),
              HasSubstr("joint 'wheel'; got -1.1e+06; expected -1e+06 to 1e+06"));
}

TEST(ModelLinksTest, DifferencesAndRatesOfPositionsCanBeAnything) {
  EXPECT_EQ(DeltaSpec(Mixed()).plausible, nullptr);
  EXPECT_EQ(RateSpec(Mixed()).plausible, nullptr);
  EXPECT_EQ(DeltaSpec(Mixed()).size.number(), 4);
}

}  // namespace model_links_test
}  // namespace oca::systems
